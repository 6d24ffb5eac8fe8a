// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshGeometry.h
/// The geometry of a mesh: point coordinates, and the frames of its triangles.

#ifndef homeomorphism_MeshGeometry_h
#define homeomorphism_MeshGeometry_h

#include "Box.h"
#include "LargeArray.h"
#include "Triangulation.h"
#include "Vector3.h"

#include "Kernel/Geometry.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

class vtkPoints;

namespace homeomorphism
{

/// A point in the frame of a triangle: its position in the plane, and its distance from the plane.
struct FramePoint
{
  Vector2 InPlane;
  double Offset = 0.0;
};

/// Frame and shape of a triangle in the plane: the data that is needed to locate and map a point.
struct alignas(64) PlaneFrame
{
  Vector2 Origin;
  Vector2 Tangent;
  double Base = 1.0;
  double ApexX = 0.5;
  double Height = 1.0;
  std::int32_t Apex = 2;
  /// 1 if the apex is to the left of the tangent, -1 if to the right.
  std::int32_t Orientation = 1;

  TriangleShape Shape() const { return { this->Base, this->ApexX, this->Height, this->Apex }; }

  /// The unit vector from the longest edge towards the apex: the second axis of the frame.
  Vector2 GetInward() const
  {
    const double sense = this->Orientation;
    return { -sense * this->Tangent.y, sense * this->Tangent.x };
  }

  Vector2 VectorToFrame(const Vector2& vector) const
  {
    return { Dot(vector, this->Tangent), this->Orientation * Cross(this->Tangent, vector) };
  }
  Vector2 ToFrame(const Vector2& point) const { return this->VectorToFrame(point - this->Origin); }

  Vector2 FromFrame(const Vector2& point) const
  {
    const double y = this->Orientation * point.y;
    return { this->Origin.x + (point.x * this->Tangent.x - y * this->Tangent.y),
      this->Origin.y + (point.x * this->Tangent.y + y * this->Tangent.x) };
  }
};
static_assert(sizeof(PlaneFrame) == 64, "One line of a processor's cache");

/// Point coordinates of a triangulation, in a plane or as a surface in 3-space.
///
/// All computations use *normalized coordinates*: the coordinates of the input times a power of
/// two, Scale, so that the largest of them is close to 1. This multiplication is exact, so meshes
/// of any size are equivalent in floating-point arithmetic. In a plane, normalized coordinates are
/// two coordinates within the plane and the distance from it. If the plane is parallel to two axes,
/// they are the scaled coordinates of the input, without rounding.
class MeshGeometry
{
public:
  /// Reads the points used by the triangles of @a triangulation, whose corners must exist. If the
  /// points are planar, the normal of the plane points along the axis closest to it (the last of
  /// equally close ones) or, if @a companion is given and planar, makes less than a right angle
  /// with the normal of the companion.
  MeshGeometry(
    vtkPoints* points, const Triangulation& triangulation, const MeshGeometry* companion = nullptr);

  /// Computes the frames of the triangles. No unmasked triangle may be degenerate.
  void ComputeFrames(const Triangulation& triangulation);

  /// Whether the coordinates of all corners of unmasked triangles are finite.
  bool IsFinite() const { return this->Finite; }
  /// Whether all points lie in one plane, up to the rounding of their coordinates.
  bool IsPlanar() const { return this->Planar; }
  /// Whether the plane is parallel to the x and y axes and has the normal z, so that points are
  /// converted only by a scale and the plane's distance from the origin.
  bool IsHorizontal() const
  {
    return this->AxisParallel && this->AxisOrder[0] == 0 && this->AxisOrder[1] == 1;
  }
  /// Distance of a planar mesh's plane from the origin along its normal, in normalized coordinates.
  double GetPlaneDistance() const { return this->PlaneDistance; }
  /// Whether distances from the plane are unlimited and measured along its normal, as in both
  /// meshes of a planar pair. Otherwise each triangle has a normal of its own, given by its
  /// winding.
  bool IsColumnar() const { return this->Columnar; }
  void SetColumnar(bool columnar) { this->Columnar = columnar; }

  /// Normalized coordinates divided by input coordinates, a power of two.
  double GetScale() const { return this->Scale; }
  double GetInverseScale() const { return this->InverseScale; }
  /// Largest absolute normalized coordinate of a point, about 1.
  double GetLargestCoordinate() const { return this->LargestCoordinate; }
  /// Bounding box of the points of a planar mesh that are used by triangles, in its plane.
  const Box<2>& GetPlaneBounds() const { return this->PlaneBounds; }
  /// For a surface whose points lie within a millionth of its diagonal of a plane: the largest
  /// distance of a point from that plane, in normalized coordinates, if the plane passes between
  /// the points. 0 for all other meshes.
  double GetThickness() const { return this->Thickness; }
  /// Length of the diagonal of the bounding box of the points, in normalized coordinates.
  double GetDiagonal() const { return this->Diagonal; }
  /// The largest distance, in normalized coordinates, of a point that should lie on an edge from
  /// that edge, due to the rounding of coordinates: 8 u L + 16 v L, with L the largest coordinate,
  /// u the precision of the stored coordinates, and v that of double.
  ///
  /// A point a + t (b - a) of an edge from a to b, computed in the precision of the coordinates,
  /// has rounding errors of at most 2 u L (difference), 2 u L (product) and u L (sum) in each
  /// coordinate, together less than 8 u L in any direction of the plane. If a, b and the point have
  /// each been rounded instead, their distances add up to less than 4 u L. In a plane that is not
  /// parallel to two axes, the two coordinates in the plane are sums of three products, with errors
  /// of less than 6 v L each, in the point and in the edge. Distances are computed as doubles.
  ///
  /// It is also the distance from the mesh up to which a point with coordinates of this precision
  /// is located. @a precision is used if it is coarser than that of the mesh.
  double GetRounding(double precision = 0.0) const
  {
    return (8.0 * std::max(precision, this->CoordinatePrecision) +
             8.0 * std::numeric_limits<double>::epsilon()) *
      this->LargestCoordinate;
  }

  Vector3 ToNormalized(const double point[3]) const
  {
    if (this->AxisParallel)
    {
      return { point[this->AxisOrder[0]] * this->Scale, point[this->AxisOrder[1]] * this->Scale,
        this->NormalSign * (point[this->AxisOrder[2]] * this->Scale) - this->PlaneDistance };
    }
    const Vector3 p{ point[0] * this->Scale, point[1] * this->Scale, point[2] * this->Scale };
    return this->Planar ? this->ToTiltedPlane(p) : p;
  }

  /// Converts many points. Their normalized coordinates are in separate arrays.
  void ToNormalized(const double (*points)[3], int count, double* x, double* y, double* z) const
  {
    if (!this->IsHorizontal())
    {
      for (int i = 0; i < count; ++i)
      {
        const Vector3 point = this->ToNormalized(points[i]);
        x[i] = point[0];
        y[i] = point[1];
        z[i] = point[2];
      }
      return;
    }
    const double scale = this->Scale;
    const double distance = this->PlaneDistance;
    for (int i = 0; i < count; ++i)
    {
      x[i] = points[i][0] * scale;
      y[i] = points[i][1] * scale;
      z[i] = points[i][2] * scale - distance;
    }
  }
  void FromNormalized(
    const double* x, const double* y, const double* z, int count, double (*points)[3]) const
  {
    if (!this->IsHorizontal())
    {
      for (int i = 0; i < count; ++i)
      {
        this->FromNormalized({ x[i], y[i], z[i] }, points[i]);
      }
      return;
    }
    const double distance = this->PlaneDistance;
    const double inverseScale = this->InverseScale;
    HOMEOMORPHISM_SIMD
    for (int i = 0; i < count; ++i)
    {
      points[i][0] = x[i] * inverseScale;
      points[i][1] = y[i] * inverseScale;
      points[i][2] = (z[i] + distance) * inverseScale;
    }
  }

  void FromNormalized(const Vector3& normalized, double point[3]) const
  {
    if (this->AxisParallel)
    {
      const double height = this->NormalSign * (normalized[2] + this->PlaneDistance);
      point[this->AxisOrder[0]] = normalized[0] * this->InverseScale;
      point[this->AxisOrder[1]] = normalized[1] * this->InverseScale;
      point[this->AxisOrder[2]] = height * this->InverseScale;
      return;
    }
    const Vector3 p = this->Planar ? this->FromTiltedPlane(normalized) : normalized;
    for (int axis = 0; axis < 3; ++axis)
    {
      point[axis] = p[axis] * this->InverseScale;
    }
  }

  /// Whether a point equals a point of the mesh, bit for bit.
  bool IsMeshPoint(std::int32_t meshPoint, const double point[3]) const;

  /// The point at a distance from a point of the mesh, along the plane's normal; the mesh's own
  /// point, unrounded, if the distance is 0.
  void FromMeshPoint(std::int32_t meshPoint, double offset, double point[3]) const;

  /// Normalized coordinates of a point of the mesh. In a planar mesh, the third is the distance
  /// from the plane.
  Vector3 GetPoint(std::int32_t point) const
  {
    if (this->Planar)
    {
      const Vector2& p = this->PlanePoints[point];
      return { p.x, p.y, 0.0 };
    }
    return this->SpacePoints[point];
  }
  /// The vector from one point of the mesh to another, in the input's coordinates. It is a
  /// difference of stored coordinates, so it is accurate for points close to each other, even far
  /// from the origin.
  Vector3 GetVector(std::int32_t from, std::int32_t to) const;
  /// Normalized coordinates of a point of a planar mesh.
  const Vector2& GetPlanePoint(std::int32_t point) const { return this->PlanePoints[point]; }

  /// The exact orientation of a triangle of a planar mesh with respect to the normal of the plane:
  /// 1 if its corners are counterclockwise, -1 if clockwise, 0 if it is degenerate.
  int GetOrientation(const Triangulation::Corners& corners) const;
  /// The stored orientation of an unmasked triangle whose corners are finite.
  int GetOrientation(TriangleIndex triangle) const
  {
    return this->Orientations.empty() ? this->PlaneFrames[triangle].Orientation
                                      : this->Orientations[triangle];
  }
  /// Whether the triangle is degenerate: exactly in a plane parallel to two axes, otherwise up to
  /// the rounding of coordinates to double.
  bool IsDegenerate(const Triangulation& triangulation, TriangleIndex triangle) const;
  /// Whether the coordinates of all corners are finite.
  bool IsFinite(const Triangulation::Corners& corners) const;
  /// Whether the triangle is concordant (see IsConcordant), decided exactly.
  bool IsConcordant(const Triangulation::Corners& corners) const;
  /// The views of the triangle from its edges.
  EdgeViews GetViews(const Triangulation::Corners& corners) const;
  /// The view from the edge opposite corner @a edge; the same, bit for bit, as in GetViews.
  EdgeView GetView(const Triangulation::Corners& corners, int edge) const;

  TriangleShape GetShape(TriangleIndex triangle) const
  {
    return this->Planar ? this->PlaneFrames[triangle].Shape() : this->SpaceFrames[triangle].Shape;
  }

  /// The corner opposite the longest edge of a triangle.
  int GetApex(TriangleIndex triangle) const
  {
    return this->Planar ? this->PlaneFrames[triangle].Apex : this->SpaceFrames[triangle].Shape.Apex;
  }

  /// The frame of a triangle of a planar mesh.
  const PlaneFrame& GetPlaneFrame(TriangleIndex triangle) const
  {
    return this->PlaneFrames[triangle];
  }

  /// Prefetches a triangle's frame.
  void PrefetchFrame(TriangleIndex triangle) const
  {
    if (this->Planar)
    {
      Prefetch(&this->PlaneFrames[triangle]);
    }
    else
    {
      Prefetch(&this->SpaceFrames[triangle]);
    }
  }

  FramePoint ToFrame(TriangleIndex triangle, const Vector3& normalized) const;
  Vector3 FromFrame(TriangleIndex triangle, const FramePoint& point) const
  {
    if (!this->Planar)
    {
      return this->FromSpaceFrame(triangle, point);
    }
    const PlaneFrame& frame = this->PlaneFrames[triangle];
    const Vector2 inPlane = frame.FromFrame(point.InPlane);
    return { inPlane.x, inPlane.y,
      this->Columnar ? point.Offset : frame.Orientation * point.Offset };
  }

  /// The axes of the frame as unit vectors of the space of the input: along the longest edge, from
  /// it towards the apex, and the normal along which offsets are measured.
  std::array<Vector3, 3> GetAxes(TriangleIndex triangle) const;

  /// 1 if the axes of the frame are right-handed, -1 if left-handed.
  double GetHandedness(TriangleIndex triangle) const
  {
    return this->Columnar ? this->PlaneFrames[triangle].Orientation : 1.0;
  }

private:
  /// The frame of a triangle in 3-space.
  struct SpaceFrame
  {
    Vector3 Origin;
    Vector3 Tangent;
    Vector3 Inward;
    Vector3 Normal;
    TriangleShape Shape;
  };

  Vector3 FromSpaceFrame(TriangleIndex triangle, const FramePoint& point) const;
  Vector3 ToTiltedPlane(const Vector3& scaled) const;
  Vector3 FromTiltedPlane(const Vector3& normalized) const;
  /// The corner opposite the longest edge; the first one of equal ones.
  int FindApex(const Triangulation::Corners& corners) const;
  class MeshPoints;
  void FindPlane(
    const MeshPoints& points, const std::vector<std::uint8_t>& used, const MeshGeometry* companion);
  void FindThickness(
    const MeshPoints& points, const std::vector<std::uint8_t>& used, const Vector3& normal);
  void FindOrientations(const Triangulation& triangulation);
  void ComputePlaneFrames(
    const Triangulation& triangulation, TriangleIndex begin, TriangleIndex end);
  void ComputeSpaceFrame(TriangleIndex triangle, const Triangulation::Corners& corners);

  bool Finite = true;
  bool Planar = false;
  bool Columnar = false;
  /// Whether the plane is parallel to two axes, so that normalized coordinates are not rounded.
  bool AxisParallel = false;
  double Scale = 1.0;
  double InverseScale = 1.0;
  double LargestCoordinate = 0.0;
  double Diagonal = 0.0;
  double Thickness = 0.0;
  /// Relative rounding error of the stored coordinates: half an ulp of float or double.
  double CoordinatePrecision = 0.0;

  // The plane: axes U, V within it and the normal N, right-handed, and its distance from the
  // origin.
  std::array<Vector3, 3> PlaneAxes{};
  std::array<int, 3> AxisOrder{ 0, 1, 2 };
  double NormalSign = 1.0;
  double PlaneDistance = 0.0;

  LargeArray<Vector2> PlanePoints;
  Box<2> PlaneBounds;
  // For a surface, and for a plane that is not parallel to two axes: the coordinates of the input
  // times Scale.
  LargeArray<Vector3> SpacePoints;
  // For a planar mesh, until it has frames.
  LargeArray<std::int8_t> Orientations;
  LargeArray<PlaneFrame> PlaneFrames;
  LargeArray<SpaceFrame> SpaceFrames;
};

} // namespace homeomorphism

#endif
