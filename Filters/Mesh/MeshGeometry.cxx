// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MeshGeometry.h"

#include "Kernel/ExactSign.h"
#include "Kernel/Simd/EdgeBatch.h"

#include "vtkDoubleArray.h"
#include "vtkPoints.h"
#include "vtkSMPTools.h"
#include "vtkType.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace homeomorphism
{
namespace
{

/// A dot product as if in doubled precision (Ogita, Rump and Oishi 2005).
double AccurateDot3(const Vector3& a, const Vector3& b)
{
  double sum = 0.0;
  double lost = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double product = a[axis] * b[axis];
    const double next = sum + product;
    const double share = next - sum;
    lost += std::fma(a[axis], b[axis], -product) + ((sum - (next - share)) + (product - share));
    sum = next;
  }
  return sum + lost;
}

double SpaceEdgeLength(const Vector3& start, const Vector3& end)
{
  const Vector3 d = Difference(end, start);
  const double scale = PowerOfTwoNear(Length(d));
  return scale * Length(Scaled(d, 1.0 / scale));
}

EdgeView ViewFromSpaceEdge(const Vector3& start, const Vector3& end, const Vector3& opposite)
{
  const double scale = PowerOfTwoNear(Length(Difference(end, start)));
  const Vector3 edge = Scaled(Difference(end, start), 1.0 / scale);
  const Vector3 other = Scaled(Difference(opposite, start), 1.0 / scale);
  const double length = Length(edge);
  return { scale * length, AccurateDot3(edge, other) / length / length,
    scale * Length(Cross3(edge, other)) / length };
}

TriangleShape MakeShape(const EdgeView& base, int apex)
{
  TriangleShape shape;
  shape.Apex = apex;
  shape.Base = base.Length;
  shape.ApexX = std::min(base.Length, std::max(0.0, base.Foot * base.Length));
  shape.Height = base.Height;
  return shape;
}

HOMEOMORPHISM_WITH_FMA
EdgeView PlaneView(const Vector2& start, const Vector2& end, const Vector2& opposite)
{
  return ViewFromEdge(start, end, opposite);
}

} // namespace

/// The points of a mesh times a power of two, without a copy.
class MeshGeometry::MeshPoints
{
public:
  explicit MeshPoints(vtkPoints* points)
    : Points(points)
  {
    auto* doubles = vtkArrayDownCast<vtkDoubleArray>(points->GetData());
    this->Doubles = doubles ? doubles->GetPointer(0) : nullptr;
  }

  void SetScale(double scale) { this->Scale = scale; }

  Vector3 operator[](vtkIdType i) const
  {
    Vector3 p;
    if (this->Doubles)
    {
      std::copy_n(this->Doubles + 3 * i, 3, p.begin());
    }
    else
    {
      this->Points->GetPoint(i, p.data());
    }
    return Scaled(p, this->Scale);
  }

private:
  vtkPoints* Points;
  const double* Doubles;
  double Scale = 1.0;
};

MeshGeometry::MeshGeometry(
  vtkPoints* points, const Triangulation& triangulation, const MeshGeometry* companion)
{
  const vtkIdType count = points->GetNumberOfPoints();
  std::vector<std::uint8_t> used(count, 0);
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    for (const std::int32_t corner : triangulation.GetCorners(t))
    {
      used[corner] = triangulation.IsMasked(t) ? used[corner] : 1;
    }
  }
  this->CoordinatePrecision = 0.5 *
    (points->GetDataType() == VTK_FLOAT ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                        : std::numeric_limits<double>::epsilon());

  // Points with non-finite coordinates affect neither the scale nor the plane. IsFinite finds the
  // triangles that use them.
  MeshPoints positions(points);
  double largest = 0.0;
  Vector3 least{ VTK_DOUBLE_MAX, VTK_DOUBLE_MAX, VTK_DOUBLE_MAX };
  Vector3 greatest{ -VTK_DOUBLE_MAX, -VTK_DOUBLE_MAX, -VTK_DOUBLE_MAX };
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (!used[i])
    {
      continue;
    }
    const Vector3 p = positions[i];
    if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])))
    {
      used[i] = 0;
      this->Finite = false;
      continue;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      least[axis] = std::min(least[axis], p[axis]);
      greatest[axis] = std::max(greatest[axis], p[axis]);
    }
  }
  for (int axis = 0; axis < 3 && least[0] <= greatest[0]; ++axis)
  {
    largest = std::max({ largest, std::abs(least[axis]), std::abs(greatest[axis]) });
  }
  if (largest > 0.0)
  {
    this->InverseScale = PowerOfTwoNear(largest);
    this->Scale = 1.0 / this->InverseScale;
  }
  positions.SetScale(this->Scale);
  this->LargestCoordinate = largest * this->Scale;
  this->Diagonal = largest > 0.0
    ? Length(Difference(Scaled(greatest, this->Scale), Scaled(least, this->Scale)))
    : 0.0;

  this->FindPlane(positions, used, companion);
  if (this->Planar)
  {
    this->PlanePoints = LargeArray<Vector2>(count);
    for (vtkIdType i = 0; i < count; ++i)
    {
      const Vector3 p = positions[i];
      const Vector3 normalized = this->AxisParallel
        ? Vector3{ p[this->AxisOrder[0]], p[this->AxisOrder[1]], p[this->AxisOrder[2]] }
        : this->ToTiltedPlane(p);
      this->PlanePoints[i] = { normalized[0], normalized[1] };
      if (used[i])
      {
        this->PlaneBounds.Add({ normalized[0], normalized[1] });
      }
      else if (!std::isfinite(normalized[2]))
      {
        // The third coordinate is not stored, but IsFinite must test it.
        this->PlanePoints[i].x = normalized[2];
      }
    }
    this->FindOrientations(triangulation);
  }
  if (!this->AxisParallel)
  {
    this->SpacePoints = LargeArray<Vector3>(count);
    for (vtkIdType i = 0; i < count; ++i)
    {
      this->SpacePoints[i] = positions[i];
    }
  }
}

void MeshGeometry::FindOrientations(const Triangulation& triangulation)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  this->Orientations = LargeArray<std::int8_t>(count);
  vtkSMPTools::For(0, count, [this, &triangulation](vtkIdType begin, vtkIdType end) {
    for (auto t = static_cast<TriangleIndex>(begin); t < end; ++t)
    {
      const Triangulation::Corners& corners = triangulation.GetCorners(t);
      const bool isSeen = !triangulation.IsMasked(t) && (this->Finite || this->IsFinite(corners));
      this->Orientations[t] = static_cast<std::int8_t>(isSeen ? this->GetOrientation(corners) : 0);
    }
  });
}

void MeshGeometry::FindPlane(
  const MeshPoints& points, const std::vector<std::uint8_t>& used, const MeshGeometry* companion)
{
  const auto isTurnedAway = [companion](const Vector3& normal) {
    // Except for planes that are perpendicular up to rounding, for which either orientation is
    // equally good.
    return companion && companion->Planar && Dot3(companion->PlaneAxes[2], normal) < -1e-6;
  };
  const auto first = std::find(used.begin(), used.end(), 1);
  if (first == used.end())
  {
    // No points: use the xy plane.
    this->Planar = this->AxisParallel = true;
    this->PlaneAxes = { { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } };
    return;
  }
  const Vector3 origin = points[first - used.begin()];

  // Test for planes parallel to two axes, z first, so that a collinear mesh counts as part of the
  // xy plane.
  for (const int normalAxis : { 2, 1, 0 })
  {
    bool constant = true;
    for (std::size_t i = 0; i < used.size() && constant; ++i)
    {
      constant = !used[i] || points[i][normalAxis] == origin[normalAxis];
    }
    if (constant)
    {
      this->Planar = this->AxisParallel = true;
      this->AxisOrder = { (normalAxis + 1) % 3, (normalAxis + 2) % 3, normalAxis };
      Vector3 axisNormal{};
      axisNormal[normalAxis] = 1.0;
      if (isTurnedAway(axisNormal))
      {
        std::swap(this->AxisOrder[0], this->AxisOrder[1]);
        this->NormalSign = -1.0;
      }
      for (int axis = 0; axis < 3; ++axis)
      {
        this->PlaneAxes[axis] = { 0.0, 0.0, 0.0 };
        this->PlaneAxes[axis][this->AxisOrder[axis]] = axis == 2 ? this->NormalSign : 1.0;
      }
      this->PlaneDistance = this->NormalSign * origin[normalAxis];
      return;
    }
  }

  // Otherwise use the first point, the point farthest from it, and the point farthest from their
  // line.
  Vector3 along{};
  double farthest = 0.0;
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    const Vector3 d = Difference(points[i], origin);
    if (used[i] && Length(d) > farthest)
    {
      farthest = Length(d);
      along = Scaled(d, 1.0 / farthest);
    }
  }
  Vector3 normal{};
  double widest = 0.0;
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    const Vector3 c = Cross3(along, Difference(points[i], origin));
    if (used[i] && Length(c) > widest)
    {
      widest = Length(c);
      normal = Scaled(c, 1.0 / widest);
    }
  }
  // Any other point is the first plus at most twice the vector to the second plus at most once the
  // vector to the third. Their rounding and its own therefore move it by a few times its rounding.
  const double spread = 32.0 * this->CoordinatePrecision * this->LargestCoordinate;
  if (!(widest > spread))
  {
    return;
  }
  // A mesh that is planar to a millionth of its size, but not to rounding, was probably meant to be
  // planar.
  constexpr double nearly = 1e-6;
  double largestDistance = 0.0;
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    const double distance = std::abs(Dot3(normal, Difference(points[i], origin)));
    largestDistance = used[i] ? std::max(largestDistance, distance) : largestDistance;
    if (largestDistance > std::max(spread, nearly * this->Diagonal))
    {
      return;
    }
  }
  if (largestDistance > spread)
  {
    this->FindThickness(points, used, normal);
    return;
  }
  this->Planar = true;
  int main = 0;
  for (const int axis : { 1, 2 })
  {
    // The factor keeps rounding from deciding between two equally close axes.
    main = std::abs(normal[axis]) >= (1.0 - 1e-6) * std::abs(normal[main]) ? axis : main;
  }
  const bool byCompanion =
    companion && companion->Planar && std::abs(Dot3(companion->PlaneAxes[2], normal)) > 1e-6;
  if (byCompanion ? isTurnedAway(normal) : normal[main] < 0.0)
  {
    normal = Scaled(normal, -1.0);
  }
  Vector3 helper{};
  helper[(main + 1) % 3] = 1.0;
  Vector3 v = Cross3(normal, helper);
  v = Scaled(v, 1.0 / Length(v));
  this->PlaneAxes = { Cross3(v, normal), v, normal };
  this->PlaneDistance = Dot3(normal, origin);
}

void MeshGeometry::FindThickness(
  const MeshPoints& points, const std::vector<std::uint8_t>& used, const Vector3& normal)
{
  const auto thicknessAlong = [&points, &used](const Vector3& direction) {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -least;
    for (std::size_t i = 0; i < used.size(); ++i)
    {
      const double height = Dot3(direction, points[i]);
      least = used[i] ? std::min(least, height) : least;
      greatest = used[i] ? std::max(greatest, height) : greatest;
    }
    return greatest - least;
  };
  this->Thickness = thicknessAlong(normal);
  // Prefer a plane parallel to two axes if there is one that is almost as near.
  for (int axis = 0; axis < 3; ++axis)
  {
    Vector3 direction{};
    direction[axis] = 1.0;
    const double thickness = thicknessAlong(direction);
    if (thickness <= 16.0 * this->Thickness)
    {
      this->Thickness = thickness;
      return;
    }
  }
}

Vector3 MeshGeometry::ToTiltedPlane(const Vector3& scaled) const
{
  return { Dot3(this->PlaneAxes[0], scaled), Dot3(this->PlaneAxes[1], scaled),
    Dot3(this->PlaneAxes[2], scaled) - this->PlaneDistance };
}

Vector3 MeshGeometry::FromTiltedPlane(const Vector3& normalized) const
{
  const double height = normalized[2] + this->PlaneDistance;
  Vector3 scaled;
  for (int axis = 0; axis < 3; ++axis)
  {
    scaled[axis] = normalized[0] * this->PlaneAxes[0][axis] +
      normalized[1] * this->PlaneAxes[1][axis] + height * this->PlaneAxes[2][axis];
  }
  return scaled;
}

bool MeshGeometry::IsMeshPoint(std::int32_t meshPoint, const double point[3]) const
{
  double position[3];
  this->FromMeshPoint(meshPoint, 0.0, position);
  return std::equal(position, position + 3, point);
}

void MeshGeometry::FromMeshPoint(std::int32_t meshPoint, double offset, double point[3]) const
{
  if (!this->Planar || this->AxisParallel)
  {
    Vector3 normalized = this->GetPoint(meshPoint);
    normalized[2] += this->Planar ? offset : 0.0;
    this->FromNormalized(normalized, point);
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    point[axis] =
      (this->SpacePoints[meshPoint][axis] + offset * this->PlaneAxes[2][axis]) * this->InverseScale;
  }
}

Vector3 MeshGeometry::GetVector(std::int32_t from, std::int32_t to) const
{
  if (!this->Planar)
  {
    return Scaled(Difference(this->SpacePoints[to], this->SpacePoints[from]), this->InverseScale);
  }
  const Vector2 d = this->PlanePoints[to] - this->PlanePoints[from];
  return Scaled(Sum(Scaled(this->PlaneAxes[0], d.x), d.y, this->PlaneAxes[1]), this->InverseScale);
}

int MeshGeometry::GetOrientation(const Triangulation::Corners& corners) const
{
  return Orientation(
    this->PlanePoints[corners[0]], this->PlanePoints[corners[1]], this->PlanePoints[corners[2]]);
}

bool MeshGeometry::IsDegenerate(const Triangulation& triangulation, TriangleIndex triangle) const
{
  if (this->AxisParallel)
  {
    return this->GetOrientation(triangle) == 0;
  }
  const Triangulation::Corners& corners = triangulation.GetCorners(triangle);
  const double least = 8.0 * std::numeric_limits<double>::epsilon() * this->LargestCoordinate;
  // Negated so that NaN, from an edge of zero length, counts as degenerate.
  return !(this->GetView(corners, this->FindApex(corners)).Height > least);
}

bool MeshGeometry::IsFinite(const Triangulation::Corners& corners) const
{
  return std::all_of(corners.begin(), corners.end(), [this](std::int32_t corner) {
    const Vector3 p = this->GetPoint(corner);
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  });
}

bool MeshGeometry::IsConcordant(const Triangulation::Corners& corners) const
{
  if (this->AxisParallel)
  {
    const Vector3 a = this->GetPoint(corners[0]);
    const Vector3 b = this->GetPoint(corners[1]);
    const Vector3 c = this->GetPoint(corners[2]);
    return homeomorphism::IsConcordant(a.data(), b.data(), c.data(), 2);
  }
  return homeomorphism::IsConcordant(this->SpacePoints[corners[0]].data(),
    this->SpacePoints[corners[1]].data(), this->SpacePoints[corners[2]].data(), 3);
}

EdgeViews MeshGeometry::GetViews(const Triangulation::Corners& corners) const
{
  return { this->GetView(corners, 0), this->GetView(corners, 1), this->GetView(corners, 2) };
}

EdgeView MeshGeometry::GetView(const Triangulation::Corners& corners, int edge) const
{
  const std::int32_t start = corners[NextCorner(edge)];
  const std::int32_t end = corners[PreviousCorner(edge)];
  return this->Planar
    ? PlaneView(this->PlanePoints[start], this->PlanePoints[end], this->PlanePoints[corners[edge]])
    : ViewFromSpaceEdge(
        this->SpacePoints[start], this->SpacePoints[end], this->SpacePoints[corners[edge]]);
}

int MeshGeometry::FindApex(const Triangulation::Corners& corners) const
{
  int apex = 0;
  double longest = -1.0;
  for (int k = 0; k < 3; ++k)
  {
    const std::int32_t start = corners[NextCorner(k)];
    const std::int32_t end = corners[PreviousCorner(k)];
    const double length = this->Planar
      ? EdgeLength(this->PlanePoints[start], this->PlanePoints[end])
      : SpaceEdgeLength(this->SpacePoints[start], this->SpacePoints[end]);
    if (length > longest)
    {
      longest = length;
      apex = k;
    }
  }
  return apex;
}

void MeshGeometry::ComputeFrames(const Triangulation& triangulation)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  if (this->Planar)
  {
    this->PlaneFrames = LargeArray<PlaneFrame>(count);
  }
  else
  {
    this->SpaceFrames = LargeArray<SpaceFrame>(count);
  }
  vtkSMPTools::For(0, count, [this, &triangulation](vtkIdType first, vtkIdType last) {
    const auto begin = static_cast<TriangleIndex>(first);
    const auto end = static_cast<TriangleIndex>(last);
    if (this->Planar)
    {
      for (TriangleIndex t = begin; t < end; t += EdgeBatchSize)
      {
        this->ComputePlaneFrames(triangulation, t, std::min(end, t + EdgeBatchSize));
      }
      return;
    }
    for (TriangleIndex t = begin; t < end; ++t)
    {
      this->SpaceFrames[t] = SpaceFrame{};
      if (!triangulation.IsMasked(t))
      {
        this->ComputeSpaceFrame(t, triangulation.GetCorners(t));
      }
    }
  });
  this->Orientations = {};
}

/// The frames of at most EdgeBatchSize triangles of a plane.
void MeshGeometry::ComputePlaneFrames(
  const Triangulation& triangulation, TriangleIndex begin, TriangleIndex end)
{
  PointBatch corners[3] = {};
  for (TriangleIndex t = begin; t < end; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      corners[k].Set(t - begin, this->PlanePoints[triangulation.GetCorners(t)[k]]);
    }
  }
  ViewBatch views[3];
  for (int k = 0; k < 3; ++k)
  {
    ViewFromEdges(
      corners[NextCorner(k)], corners[PreviousCorner(k)], corners[k], end - begin, views[k]);
  }
  for (TriangleIndex t = begin; t < end; ++t)
  {
    PlaneFrame& frame = this->PlaneFrames[t];
    if (triangulation.IsMasked(t))
    {
      frame = PlaneFrame{};
      continue;
    }
    const int i = t - begin;
    // The corner opposite the longest edge, the first one of equal edges.
    int apex = views[1].Length[i] > views[0].Length[i] ? 1 : 0;
    apex = views[2].Length[i] > views[apex].Length[i] ? 2 : apex;
    const TriangleShape shape =
      MakeShape({ views[apex].Length[i], views[apex].Foot[i], views[apex].Height[i] }, apex);
    const PointBatch& start = corners[NextCorner(apex)];
    const PointBatch& finish = corners[PreviousCorner(apex)];
    frame.Origin = { start.X[i], start.Y[i] };
    frame.Tangent = { (finish.X[i] - start.X[i]) / shape.Base,
      (finish.Y[i] - start.Y[i]) / shape.Base };
    frame.Base = shape.Base;
    frame.ApexX = shape.ApexX;
    frame.Height = shape.Height;
    frame.Apex = shape.Apex;
    frame.Orientation = this->GetOrientation(t);
  }
}

void MeshGeometry::ComputeSpaceFrame(TriangleIndex triangle, const Triangulation::Corners& corners)
{
  const int apex = this->FindApex(corners);
  const TriangleShape shape = MakeShape(this->GetView(corners, apex), apex);
  SpaceFrame& frame = this->SpaceFrames[triangle];
  frame.Shape = shape;
  frame.Origin = this->SpacePoints[corners[NextCorner(shape.Apex)]];
  frame.Tangent =
    Scaled(Difference(this->SpacePoints[corners[PreviousCorner(shape.Apex)]], frame.Origin),
      1.0 / shape.Base);
  const Vector3 toApex = Difference(this->SpacePoints[corners[shape.Apex]], frame.Origin);
  const Vector3 normal = Cross3(frame.Tangent, Scaled(toApex, 1.0 / PowerOfTwoNear(shape.Height)));
  frame.Normal = Scaled(normal, 1.0 / Length(normal));
  frame.Inward = Cross3(frame.Normal, frame.Tangent);
}

FramePoint MeshGeometry::ToFrame(TriangleIndex triangle, const Vector3& normalized) const
{
  if (this->Planar)
  {
    const PlaneFrame& frame = this->PlaneFrames[triangle];
    return { frame.ToFrame({ normalized[0], normalized[1] }),
      this->Columnar ? normalized[2] : frame.Orientation * normalized[2] };
  }
  const SpaceFrame& frame = this->SpaceFrames[triangle];
  const Vector3 d = Difference(normalized, frame.Origin);
  return { { Dot3(d, frame.Tangent), Dot3(d, frame.Inward) }, Dot3(d, frame.Normal) };
}

Vector3 MeshGeometry::FromSpaceFrame(TriangleIndex triangle, const FramePoint& point) const
{
  const SpaceFrame& frame = this->SpaceFrames[triangle];
  const double x = point.InPlane.x;
  const double y = point.InPlane.y;
  Vector3 result;
  for (int axis = 0; axis < 3; ++axis)
  {
    result[axis] = frame.Origin[axis] +
      (x * frame.Tangent[axis] + y * frame.Inward[axis] + point.Offset * frame.Normal[axis]);
  }
  return result;
}

std::array<Vector3, 3> MeshGeometry::GetAxes(TriangleIndex triangle) const
{
  if (!this->Planar)
  {
    const SpaceFrame& frame = this->SpaceFrames[triangle];
    return { frame.Tangent, frame.Inward, frame.Normal };
  }
  const PlaneFrame& frame = this->PlaneFrames[triangle];
  std::array<Vector3, 3> axes;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double u = this->PlaneAxes[0][axis];
    const double v = this->PlaneAxes[1][axis];
    axes[0][axis] = frame.Tangent.x * u + frame.Tangent.y * v;
    axes[1][axis] = frame.Orientation * (frame.Tangent.x * v - frame.Tangent.y * u);
    axes[2][axis] = (this->Columnar ? 1.0 : frame.Orientation) * this->PlaneAxes[2][axis];
  }
  return axes;
}

} // namespace homeomorphism
