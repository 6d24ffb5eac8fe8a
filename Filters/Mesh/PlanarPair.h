// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PlanarPair.h
/// Two isomorphic triangulations of the plane as plain arrays, counterclockwise in both.

#ifndef homeomorphism_PlanarPair_h
#define homeomorphism_PlanarPair_h

#include "Kernel/CubicElement.h"
#include "Mesh/LargeArray.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace homeomorphism
{

/// A pair of plane triangulations. Corners are numbered 0 to 2; edge k is opposite corner k and
/// runs from NextCorner(k) to PreviousCorner(k). All triangles have positive areas in Source and in
/// Target, so neighbors traverse their common edge in opposite directions.
struct PlanarPair
{
  LargeVector<Vector2> Source;
  LargeVector<Vector2> Target;
  LargeVector<std::array<std::int32_t, 3>> Triangles;
  /// Element k: the triangle across edge k, -1 on the boundary.
  LargeVector<std::array<std::int32_t, 3>> Neighbors;

  int GetNumberOfTriangles() const { return static_cast<int>(this->Triangles.size()); }
  int GetNumberOfPoints() const { return static_cast<int>(this->Source.size()); }

  /// Fills Neighbors from Triangles. Edges of more than two triangles are treated as boundary
  /// edges.
  void FindNeighbors();

  /// The edge of @a neighbor that it shares with @a triangle.
  int GetSharedEdge(int neighbor, int triangle) const
  {
    const std::array<std::int32_t, 3>& across = this->Neighbors[neighbor];
    return across[0] == triangle ? 0 : (across[1] == triangle ? 1 : 2);
  }

  int GetCorner(int triangle, int point) const
  {
    const std::array<std::int32_t, 3>& corners = this->Triangles[triangle];
    return corners[0] == point ? 0 : (corners[1] == point ? 1 : 2);
  }

  /// The corners of a triangle relative to corner @a origin: differences of nearby coordinates are
  /// exact.
  static std::array<Vector2, 3> GetCorners(
    const LargeVector<Vector2>& points, const std::array<std::int32_t, 3>& corners, int origin = 0)
  {
    const Vector2 o = points[corners[origin]];
    return { points[corners[0]] - o, points[corners[1]] - o, points[corners[2]] - o };
  }

  std::array<Vector2, 3> GetSourceCorners(int triangle, int origin = 0) const
  {
    return GetCorners(this->Source, this->Triangles[triangle], origin);
  }

  std::array<Vector2, 3> GetTargetCorners(int triangle, int origin = 0) const
  {
    return GetCorners(this->Target, this->Triangles[triangle], origin);
  }

  /// The derivative of the piecewise linear map.
  Matrix2 GetAffine(int triangle) const
  {
    return AffineDerivative(this->GetSourceCorners(triangle), this->GetTargetCorners(triangle));
  }

  /// The distance by which rounding a point of a triangle, relative to corner 0, moves its image
  /// under a map with this derivative: the unit of the last place times the length of the triangle
  /// and the norm of the derivative.
  double GetRounding(int triangle, const Matrix2& derivative) const;

  /// The pair with each triangle divided into four at the midpoints of its edges: triangle 4 t + c
  /// has corner c of triangle t, and triangle 4 t + 3 is the middle one.
  PlanarPair Refine() const;

  /// Where several fans of triangles meet at a point, appends a copy of the point for each further
  /// fan, so that the triangles at every point are one fan. Returns the original points of the
  /// appended ones.
  std::vector<std::int32_t> SeparateParts();
};

/// The triangles around a point, counterclockwise; if the point is on the boundary, they begin
/// there.
struct PointFan
{
  std::vector<int> Triangles;
  bool Closed = true;
};

/// For each point, the first triangle of its fan, -1 for a point without triangles; and whether the
/// point has triangles outside that fan (boundaries touch there).
struct PointFans
{
  explicit PointFans(const PlanarPair& pair);

  PointFan Get(const PlanarPair& pair, int point) const;

  /// Calls visit(triangle, corner) with the fan's triangles. Returns whether it is closed.
  template <typename Visit>
  bool ForEach(const PlanarPair& pair, int point, Visit&& visit) const
  {
    const int first = this->First[point];
    for (int t = first; t >= 0;)
    {
      const int corner = pair.GetCorner(t, point);
      visit(t, corner);
      t = pair.Neighbors[t][NextCorner(corner)];
      if (t == first)
      {
        return true;
      }
    }
    return false;
  }

  LargeVector<std::int32_t> First;
  LargeVector<std::uint8_t> Touching;
};

} // namespace homeomorphism

#endif
