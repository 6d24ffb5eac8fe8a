// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PointLocation.h
/// Finds the triangle that contains a point.

#ifndef homeomorphism_PointLocation_h
#define homeomorphism_PointLocation_h

#include "BoxTree.h"
#include "MeshGeometry.h"
#include "Triangulation.h"

#include "Kernel/Simd/Vectorize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <vector>

namespace homeomorphism
{

/// A point of a triangulation.
struct SurfacePoint
{
  /// -1 if the point is outside.
  TriangleIndex Triangle = -1;
  /// The point in the frame of the triangle, moved to the nearest point of the closed triangle.
  FramePoint Point;
  /// The corner of the triangle (0 to 2) that equals the point bit for bit, or -1.
  int Corner = -1;
};

/// The position of a point of the plane relative to a triangle, in floating point.
struct PlaneRelation
{
  Vector2 InPlane;
  /// Barycentric coordinates of the apex, the corner after it, and the corner before it.
  double Apex;
  double First;
  double Second;
  /// The least of the three times the height of the triangle, and a bound of its error.
  double Least;
  double Margin;

  HOMEOMORPHISM_ALWAYS_INLINE PlaneRelation(const PlaneFrame& frame, const Vector2& point)
  {
    const Vector2 d = point - frame.Origin;
    this->InPlane = { Dot(d, frame.Tangent), frame.Orientation * Cross(frame.Tangent, d) };
    // As in TriangleShape::ToBarycentric.
    this->Apex = this->InPlane.y / frame.Height;
    this->Second = (this->InPlane.x - frame.ApexX * this->Apex) / frame.Base;
    this->First = 1.0 - this->Apex - this->Second;
    double least = this->Apex < this->First ? this->Apex : this->First;
    least = least < this->Second ? least : this->Second;
    this->Least = least * frame.Height;
    // With u half an ulp of 1, the error of y is at most 5 u |d| (a rounded difference, a tangent
    // rounded twice, a product, a sum), hence that of the apex' coordinate, with the height's 8 u,
    // 13 u |d| / height; that of the second at most 30 u |d| / height (x, the apex' coordinate, and
    // 8 u base of the apex' position), since base > height; that of the first the sum, |d| being at
    // least the distance of the opposite edge, which is more than the height, where it is zero.
    // Products near the least normal number are not rounded relatively.
    constexpr double u = 0.5 * std::numeric_limits<double>::epsilon();
    this->Margin = 64.0 * u * (std::abs(d.x) + std::abs(d.y)) + 1e-290;
  }

  bool IsInside() const { return this->Least > this->Margin; }
  bool IsOutside() const { return this->Least < -this->Margin; }
};

/// Finds the triangle that contains a point. The result depends on the point alone: neither on the
/// hint nor on earlier points or other threads.
/// In a plane, exact predicates find every point of the closed domain, including edges and
/// vertices. If several triangles contain the point, the one with the lowest number is used. In
/// 3-space the nearest triangle is used, and the lowest number among equally near ones. A point
/// outside by no more than the tolerance is replaced by the nearest point of the domain.
///
/// In a plane the search walks from triangle to adjacent triangle. It starts from the hint if that
/// is near, otherwise from a triangle that a grid stores for the neighborhood of the point. A walk
/// that reaches the boundary or takes too long is replaced by a search of the box tree, which also
/// decides whether a point is outside.
class PointLocation
{
public:
  /// Keeps references to both arguments, which must outlive it. Masked triangles are not found.
  PointLocation(const Triangulation& triangulation, const MeshGeometry& geometry);

  /// Sets the triangles of a planar mesh, ascending, that overlap others by the rounding of their
  /// coordinates. Of several triangles that contain a point, the one with the lowest number counts.
  void SetOverlapping(const std::vector<TriangleIndex>& triangles);
  /// Whether a triangle overlaps others by the rounding of their coordinates.
  bool IsOverlapping(TriangleIndex triangle) const
  {
    return !this->Overlapping.empty() && this->Overlapping[triangle] != 0;
  }

  /// @a normalized is the point in normalized coordinates, @a tolerance a distance in them, and
  /// @a hint the triangle that probably contains the point, or -1. The geometry must have its
  /// frames.
  SurfacePoint Find(const Vector3& normalized, double tolerance, TriangleIndex hint) const;

  /// A triangle of a planar mesh that is probably near a point, or -1.
  TriangleIndex GetSeed(const Vector2& point) const
  {
    // Negated so that a NaN coordinate has no seed.
    const double x = (point.x - this->SeedOrigin.x) * this->SeedScale.x;
    const double y = (point.y - this->SeedOrigin.y) * this->SeedScale.y;
    return x >= 0.0 && y >= 0.0 && x < this->SeedColumns && y < this->SeedRows
      ? this->Seeds[static_cast<std::size_t>(y) * static_cast<std::size_t>(this->SeedColumns) +
          static_cast<std::size_t>(x)]
      : -1;
  }

  /// Calls visit(triangle) for the triangles of a planar domain whose boxes may intersect a box,
  /// until it returns false.
  template <typename Visit>
  void VisitNear(const Box<2>& box, Visit&& visit) const
  {
    this->GetPlaneTree().Search(box, visit);
  }

private:
  Box<2> PlaneBox(TriangleIndex triangle) const;
  std::vector<TriangleIndex> ListTriangles() const;
  void PlantSeeds();
  const BoxTree<2>& GetPlaneTree() const;
  int FindCorner(TriangleIndex triangle, const Vector3& normalized) const;
  SurfacePoint ToSurfacePoint(TriangleIndex triangle, const Vector3& normalized) const;
  SurfacePoint FindInPlane(const Vector3& normalized, double tolerance, TriangleIndex hint) const;
  TriangleIndex Walk(const Vector2& point, TriangleIndex start, SurfacePoint& location) const;
  TriangleIndex SearchPlane(const Vector2& point) const;
  SurfacePoint FindNearest(const Vector3& normalized, double tolerance, TriangleIndex hint) const;

  const Triangulation& Topology;
  const MeshGeometry& Geometry;
  BoxTree<3> SpaceTree;
  // For each triangle, or empty if there are none.
  std::vector<std::uint8_t> Overlapping;
  // Built on first use, by any thread. Often all points are inside and off the edges, or one
  // direction of the map is not used.
  mutable std::once_flag HasPlaneTree;
  mutable BoxTree<2> PlaneTree;

  // A grid over a planar domain. Each cell stores a triangle whose center is in it, or -1.
  LargeArray<TriangleIndex> Seeds;
  Vector2 SeedOrigin;
  Vector2 SeedScale;
  double SeedColumns = 0.0;
  double SeedRows = 0.0;
};

} // namespace homeomorphism

#endif
