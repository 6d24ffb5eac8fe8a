// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PointLocation.h
/// Finds the triangle that contains a point.

#ifndef homeomorphism_PointLocation_h
#define homeomorphism_PointLocation_h

#include "BoxTree.h"
#include "MeshGeometry.h"
#include "PointBlock.h"
#include "Triangulation.h"

#include "Kernel/Simd/Vectorize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <vector>

namespace homeomorphism
{

/// The position of a point of the plane relative to a triangle, in floating point.
struct PlaneRelation
{
  Vector2 InPlane;
  /// Barycentric coordinates of the apex, the corner after it, and the corner before it.
  double Apex;
  double First;
  double Second;
  /// The smallest of the three times the height of the triangle, and a bound on its error.
  double Least;
  double Margin;

  PlaneRelation() = default;

  HOMEOMORPHISM_ALWAYS_INLINE PlaneRelation(const PlaneFrame& frame, const Vector2& point)
  {
    const Vector2 d = point - frame.Origin;
    this->InPlane = { Dot(d, frame.Tangent), frame.Orientation * Cross(frame.Tangent, d) };
    // The same formulas as in TriangleShape::ToBarycentric.
    this->Apex = this->InPlane.y / frame.Height;
    this->Second = (this->InPlane.x - frame.ApexX * this->Apex) / frame.Base;
    this->First = 1.0 - this->Apex - this->Second;
    double least = this->Apex < this->First ? this->Apex : this->First;
    least = least < this->Second ? least : this->Second;
    this->Least = least * frame.Height;
    // Let u be half an ulp of 1. The error of y is at most 5 u |d| (a rounded difference, a tangent
    // rounded twice, a product, a sum). With the height's 8 u, the error of the apex' coordinate is
    // at most 13 u |d| / height. That of the second coordinate is at most 30 u |d| / height (x, the
    // apex' coordinate, and 8 u base of the apex' position), because base > height. That of the
    // first is at most the sum of both, because |d|, where this coordinate is zero, is at least the
    // distance of the opposite edge, which is more than the height. Products near the least normal
    // number have absolute errors, which the constant covers.
    constexpr double u = 0.5 * std::numeric_limits<double>::epsilon();
    this->Margin = 64.0 * u * (std::abs(d.x) + std::abs(d.y)) + 1e-290;
  }

  bool IsInside() const { return this->Least > this->Margin; }
  bool IsOutside() const { return this->Least < -this->Margin; }
};

/// Finds the triangle that contains a point. The result depends only on the point, not on the hint,
/// on earlier points, or on other threads. Any number of threads may call the const functions.
///
/// In a plane, exact predicates locate every point of the closed domain, including points on edges
/// and vertices. If several triangles contain the point, the one with the smallest number is used.
/// In 3-space, the nearest triangle is used, and of equally near ones that with the smallest
/// number. A point outside the domain whose distance is at most the tolerance is replaced by the
/// nearest point of the domain.
///
/// In a plane, the search walks from triangle to adjacent triangle. It starts from the hint if that
/// is near, otherwise from a triangle that a grid stores for the cell of the point. If the walk
/// reaches the boundary or takes too many steps, a tree of boxes is searched instead, which also
/// decides whether the point is outside.
class PointLocation
{
public:
  /// Keeps references to both arguments, which must outlive it. Masked triangles are not found.
  PointLocation(const Triangulation& triangulation, const MeshGeometry& geometry);

  /// Finds triangles for the cells of the grid that have none yet. The geometry must have its
  /// frames.
  void FillSeeds();

  /// Sets the triangles of a planar mesh, ascending, that overlap others by the rounding of their
  /// coordinates. If several triangles contain a point, the one with the smallest number is used.
  void SetOverlapping(const std::vector<TriangleIndex>& triangles);
  /// Whether a triangle overlaps others by the rounding of their coordinates.
  bool IsOverlapping(TriangleIndex triangle) const
  {
    return !this->Overlapping.empty() && this->Overlapping[triangle] != 0;
  }

  /// Finds a point given in the input's coordinates. @a tolerance is a distance in normalized
  /// coordinates, @a hint the triangle that probably contains the point, or -1. The geometry must
  /// have its frames.
  SurfacePoint Find(const double point[3], double tolerance, TriangleIndex hint) const;

  /// Finds the points of a block. The results are the same, bit for bit, as those of Find. Returns
  /// the number of points outside.
  int FindBlock(PointBlock& block, double tolerance, LocationHint& hint) const;

  /// A triangle of a planar mesh that is probably near a point, or -1.
  TriangleIndex GetSeed(const Vector2& point) const
  {
    const TriangleIndex* seed = this->FindSeed(point);
    return seed ? *seed : -1;
  }

  /// Calls visit(triangle) for the triangles of a planar domain whose boxes may intersect a box,
  /// until it returns false.
  template <typename Visit>
  void VisitNear(const Box<2>& box, Visit&& visit) const
  {
    this->GetPlaneTree().Search(box, visit);
  }

private:
  /// A walk starts from the hint only if no barycentric coordinate of the point there is below
  /// this. From a triangle at a distance of many times its size, the walk from the seed is shorter.
  static constexpr double Farthest = -4.0;

  /// The largest distance from a plane at which points are located.
  double GetHighest(double tolerance) const
  {
    return this->Geometry.IsColumnar() ? std::numeric_limits<double>::max() : tolerance;
  }
  /// Whether a walk can find a point. Coordinates of the domain are close to 1; products of huge
  /// coordinates would overflow. False for NaN.
  bool MayWalk(const Vector3& normalized, double tolerance) const
  {
    constexpr double huge = 1e100;
    return this->Geometry.IsPlanar() && std::abs(normalized[0]) <= huge &&
      std::abs(normalized[1]) <= huge && std::abs(normalized[2]) <= this->GetHighest(tolerance);
  }
  /// The distance of a point from the plane of a planar mesh; 0 if distances are ignored.
  double GetOffset(const Vector3& normalized) const
  {
    return this->Geometry.IsColumnar() ? normalized[2] : 0.0;
  }

  /// The element of Seeds for a point, or null.
  const TriangleIndex* FindSeed(const Vector2& point) const
  {
    // A NaN coordinate has no seed.
    const double x = (point.x - this->SeedOrigin.x) * this->SeedScale.x;
    const double y = (point.y - this->SeedOrigin.y) * this->SeedScale.y;
    return x >= 0.0 && y >= 0.0 && x < this->SeedColumns && y < this->SeedRows
      ? &this->Seeds[static_cast<std::size_t>(y) * static_cast<std::size_t>(this->SeedColumns) +
          static_cast<std::size_t>(x)]
      : nullptr;
  }

  Box<2> PlaneBox(TriangleIndex triangle) const;
  std::vector<TriangleIndex> ListTriangles() const;
  Vector2 GetMeanExtent() const;
  void PlantSeeds();
  const BoxTree<2>& GetPlaneTree() const;
  int FindCorner(TriangleIndex triangle, const Vector3& normalized) const;
  SurfacePoint ToSurfacePoint(
    TriangleIndex triangle, const double point[3], const Vector3& normalized) const;
  SurfacePoint Find(
    const double point[3], const Vector3& normalized, double tolerance, TriangleIndex hint) const;
  TriangleIndex Walk(const Vector2& point, TriangleIndex start, double farthest, int& steps,
    PlaneRelation& relation) const;
  TriangleIndex LeaveTowards(
    TriangleIndex triangle, const PlaneFrame& frame, const PlaneRelation& relation) const;
  template <typename Search>
  void FindScattered(PointBlock& block, const double normalized[3][PointBlock::Size],
    double tolerance, Search&& search) const;
  void SetPoint(PointBlock& block, int i, TriangleIndex triangle, const PlaneRelation& relation,
    const Vector3& normalized) const;
  void SetPoint(PointBlock& block, int i, const SurfacePoint& found) const;
  TriangleIndex SearchPlane(const Vector2& point) const;
  SurfacePoint FindNearestInPlane(const Vector3& normalized, double tolerance) const;
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

  // A grid over a planar domain. Each cell stores a triangle whose center is in it or that contains
  // its middle, or -1.
  LargeArray<TriangleIndex> Seeds;
  Vector2 SeedOrigin;
  Vector2 SeedScale;
  double SeedColumns = 0.0;
  double SeedRows = 0.0;
  int LongestWalk = 64;
};

} // namespace homeomorphism

#endif
