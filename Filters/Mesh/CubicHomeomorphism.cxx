// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "CubicHomeomorphism.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace homeomorphism
{

CubicHomeomorphism::CubicHomeomorphism(const TriangulationPair& pair, CubicMapOptions options)
  : Pair(pair)
{
  const Triangulation& topology = pair.GetTriangulation();
  const MeshGeometry& source = pair.GetGeometry(Domain::Source);
  const MeshGeometry& target = pair.GetGeometry(Domain::Target);
  const TriangleIndex count = topology.GetNumberOfTriangles();
  PlanarPair planar;
  this->Numbers.assign(count, -1);
  std::int32_t greatest = -1;
  for (TriangleIndex t = 0; t < count; ++t)
  {
    const Triangulation::Corners& corners = topology.GetCorners(t);
    greatest = std::max({ greatest, corners[0], corners[1], corners[2] });
  }
  const auto points = static_cast<std::size_t>(greatest) + 1;
  planar.Source.reserve(points);
  planar.Target.reserve(points);
  planar.Triangles.reserve(static_cast<std::size_t>(count));
  this->Points.reserve(points);
  this->Triangles.reserve(static_cast<std::size_t>(count));
  this->Reversed.reserve(static_cast<std::size_t>(count));
  LargeVector<std::int32_t> numbers(points, -1);
  for (TriangleIndex t = 0; t < count; ++t)
  {
    if (topology.IsMasked(t))
    {
      continue;
    }
    // The target mirrors all triangles of a valid pair, or none.
    this->IsMirrored = source.GetOrientation(t) != target.GetOrientation(t);
    Triangulation::Corners corners = topology.GetCorners(t);
    const bool isReversed = source.GetOrientation(t) < 0;
    if (isReversed)
    {
      std::swap(corners[1], corners[2]);
    }
    for (std::int32_t& corner : corners)
    {
      std::int32_t& number = numbers[static_cast<std::size_t>(corner)];
      if (number < 0)
      {
        number = static_cast<std::int32_t>(planar.Source.size());
        this->Points.push_back(corner);
        planar.Source.push_back(source.GetPlanePoint(corner));
        const Vector2& image = target.GetPlanePoint(corner);
        planar.Target.push_back(this->IsMirrored ? Vector2{ -image.x, image.y } : image);
      }
      corner = number;
    }
    this->Numbers[t] = static_cast<std::int32_t>(planar.Triangles.size());
    this->Triangles.push_back(t);
    this->Reversed.push_back(isReversed);
    planar.Triangles.push_back(corners);
  }
  planar.Neighbors.resize(planar.Triangles.size());
  for (std::size_t n = 0; n < planar.Triangles.size(); ++n)
  {
    for (int k = 0; k < 3; ++k)
    {
      const TriangleIndex twin = topology.GetTwin(this->Triangles[n], k).Triangle;
      // Edge k is opposite corner k, and two corners may have been exchanged.
      const int edge = this->Reversed[n] && k > 0 ? 3 - k : k;
      planar.Neighbors[n][edge] = twin < 0 ? -1 : this->Numbers[twin];
    }
  }
  options.MaximumDeviation *= target.GetScale();
  this->Map = std::make_unique<CubicMap>(std::move(planar), options,
    [](std::int64_t size, const std::function<void(std::int64_t, std::int64_t)>& body) {
      vtkSMPTools::For(0, static_cast<vtkIdType>(size),
        [&body](vtkIdType begin, vtkIdType end) { body(begin, end); });
    });
}

namespace
{

HOMEOMORPHISM_FOR_WIDE_VECTORS
void SetRun(const PlaneFrame& frame, bool mirrored, const double* const l[3],
  const double* const inFrame[2], int begin, int end, CubicBatch& batch)
{
  const PlaneFrame f = frame;
  const double sign = mirrored ? -1.0 : 1.0;
  const double* l0 = l[0];
  const double* l1 = l[1];
  const double* l2 = l[2];
  const double* along = inFrame[0];
  const double* inward = inFrame[1];
  const int stop = begin + InWholeVectors(end - begin);
  HOMEOMORPHISM_SIMD
  for (int i = begin; i < stop; ++i)
  {
    batch.L[0][i] = l0[i];
    batch.L[1][i] = l1[i];
    batch.L[2][i] = l2[i];
    const Vector2 point = f.FromFrame({ along[i], inward[i] });
    batch.X[i] = sign * point.x;
    batch.Y[i] = point.y;
  }
}

} // namespace

void CubicHomeomorphism::SetPoints(Domain from, TriangleIndex triangle, int begin, int end,
  const double* const l[3], const double* const inFrame[2], CubicBatch& batch) const
{
  const std::int32_t number = this->Numbers[triangle];
  const bool isReversed = this->Reversed[number] != 0;
  const bool isMirrored = from == Domain::Target && this->IsMirrored;
  const double* const turned[3] = { l[0], l[isReversed ? 2 : 1], l[isReversed ? 1 : 2] };
  SetRun(this->Pair.GetGeometry(from).GetPlaneFrame(triangle), isMirrored, turned, inFrame, begin,
    end, batch);
  std::fill(batch.Triangles + begin, batch.Triangles + end, number);
}

void CubicHomeomorphism::MapPoints(Domain from, CubicBatch& batch, CubicTriangle& prepared) const
{
  if (from == Domain::Target)
  {
    this->Map->FindPreimages(batch, prepared);
    this->LeaveUncertified(batch);
    return;
  }
  this->LeaveUncertified(batch);
  this->Map->MapPoints(batch, prepared);
  for (int i = 0; this->IsMirrored && i < batch.Count; ++i)
  {
    batch.ImageX[i] = -batch.ImageX[i];
  }
}

// Removes the images of points in triangles that are not certified, where values have no meaning.
void CubicHomeomorphism::LeaveUncertified(CubicBatch& batch) const
{
  const int count = this->Map->GetStatistics().UncertifiedTriangles > 0 ? batch.Count : 0;
  for (int i = 0; i < count; ++i)
  {
    if (batch.Triangles[i] >= 0 && !this->Map->IsCertified(batch.Triangles[i]))
    {
      batch.Triangles[i] = -1;
      batch.ImageX[i] = batch.ImageY[i] = 0.0;
    }
  }
}

void CubicHomeomorphism::GetSourcePoints(Domain from, const TriangleIndex* triangles,
  const CubicBatch& batch, double* x, double* y, int* numbers) const
{
  const bool isSource = from == Domain::Source;
  std::copy_n(isSource ? batch.X : batch.ImageX, batch.Count, x);
  std::copy_n(isSource ? batch.Y : batch.ImageY, batch.Count, y);
  for (int i = 0; i < batch.Count; ++i)
  {
    // MapPoints leaves the triangle of a preimage, but the refined triangle of a point.
    numbers[i] = batch.Triangles[i] < 0 ? -1
      : isSource                        ? this->Numbers[triangles[i]]
                                        : batch.Triangles[i];
  }
}

CubicPoint CubicHomeomorphism::MapPoint(Domain from, TriangleIndex triangle, const Barycentric& l,
  const Vector2& inFrame, CubicTriangle& prepared) const
{
  int number = this->Numbers[triangle];
  const bool isReversed = this->Reversed[number] != 0;
  const Barycentric turned{ l[0], l[isReversed ? 2 : 1], l[isReversed ? 1 : 2] };
  Vector2 point = this->Pair.GetGeometry(from).GetPlaneFrame(triangle).FromFrame(inFrame);
  if (from == Domain::Source)
  {
    if (!this->Map->IsCertified(number))
    {
      return { -1, point, {} };
    }
    const Vector2 image = this->Map->MapPoint(number, turned, point, prepared);
    return { number, point, { this->IsMirrored ? -image.x : image.x, image.y } };
  }
  point.x = this->IsMirrored ? -point.x : point.x;
  Vector2 image;
  const bool exists = this->Map->FindPreimage(point, turned, number, image, prepared) &&
    this->Map->IsCertified(number);
  return { exists ? number : -1, image, image };
}

Matrix2 CubicHomeomorphism::Derive(
  Domain from, int number, const Vector2& point, CubicTriangle& prepared) const
{
  if (number < 0)
  {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return { { none, none }, { none, none } };
  }
  Matrix2 forward = this->Map->GetDerivative(number, point, prepared);
  if (this->IsMirrored)
  {
    forward.ImageOfX.x = -forward.ImageOfX.x;
    forward.ImageOfY.x = -forward.ImageOfY.x;
  }
  if (from == Domain::Target)
  {
    const double determinant = forward.Determinant();
    forward = (1.0 / determinant) *
      Matrix2{ { forward.ImageOfY.y, -forward.ImageOfX.y },
        { -forward.ImageOfY.x, forward.ImageOfX.x } };
  }
  return forward;
}

std::vector<std::int32_t> CubicHomeomorphism::GetExceptionalPoints(bool interior) const
{
  const CubicMapStatistics& statistics = this->Map->GetStatistics();
  std::vector<std::int32_t> points;
  for (std::int32_t point :
    interior ? statistics.ExceptionalInteriorPoints : statistics.ExceptionalBoundaryPoints)
  {
    points.push_back(this->Points[point]);
  }
  std::sort(points.begin(), points.end());
  return points;
}

} // namespace homeomorphism
