// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Stars.h
/// Centroids and vertices of a triangulation, as points at which a map may not be differentiable.

#ifndef homeomorphism_Stars_h
#define homeomorphism_Stars_h

#include "Mesh/Homeomorphism.h"
#include "Mesh/JacobianJump.h"

#include <cstdint>
#include <vector>

namespace homeomorphism
{

/// The stars of a map's source: rays towards the corners around a centroid, along the edges around
/// a vertex, and a number of rays between each two of those.
class Stars
{
public:
  /// Refers to the map. Its target need not exist. @a center is the centre of the Contour system.
  Stars(const Homeomorphism& map, CenterPoint center, int raysBetween);

  Star GetAroundCenter(TriangleIndex triangle) const;

  /// In a plane.
  Star GetAroundVertex(std::int32_t point) const;

  /// Points from this number on have no triangles.
  std::int32_t GetNumberOfPoints() const
  {
    return static_cast<std::int32_t>(this->Offsets.size()) - 1;
  }

  /// A triangle at a point, -1 if there is none.
  TriangleIndex GetTriangleAt(std::int32_t point) const;

  /// By the map's closed form.
  JacobianJump GetExactJumpAtCenter(TriangleIndex triangle, const Star& star) const;

private:
  /// Adds rays in a triangle, from one direction of its frame to another, both included.
  template <typename ReachOf>
  void AddRays(Star& star, TriangleIndex triangle, const Vector2& from, const Vector2& to,
    ReachOf&& reachOf) const;

  const Homeomorphism& Map;
  CenterPoint Center;
  int RaysBetween;
  /// The triangles at point i are those numbered from Offsets[i] to Offsets[i + 1].
  std::vector<std::int32_t> Offsets;
  std::vector<TriangleIndex> Triangles;
};

} // namespace homeomorphism

#endif
