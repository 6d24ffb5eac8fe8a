// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file RayFans.h
/// Rays around centroids and vertices of a triangulation, at which a map may not be differentiable.

#ifndef homeomorphism_RayFans_h
#define homeomorphism_RayFans_h

#include "Continuity/JacobianJump.h"
#include "Mesh/Homeomorphism.h"

#include <cstdint>
#include <vector>

namespace homeomorphism
{

/// The ray fans of a map's source: around a centroid, rays towards the corners; around a vertex,
/// rays along the edges; and in both cases @a raysBetween rays between consecutive ones.
class RayFans
{
public:
  /// Keeps a reference to the map, whose target is optional. @a center is that of the Contour
  /// system.
  RayFans(const Homeomorphism& map, CenterPoint center, int raysBetween);

  RayFan GetAroundCenter(TriangleIndex triangle) const;

  /// The center of a triangle, in the input's coordinates.
  Vector3 GetCenter(TriangleIndex triangle) const;

  /// The fan around a vertex of a planar mesh.
  RayFan GetAroundVertex(std::int32_t point) const;

  /// The number of points. Points with this number or a larger one have no triangles.
  std::int32_t GetNumberOfPoints() const
  {
    return static_cast<std::int32_t>(this->Offsets.size()) - 1;
  }

  /// A triangle at a point, -1 if there is none.
  TriangleIndex GetTriangleAt(std::int32_t point) const;

  /// The jump at the center of a triangle, in closed form.
  JacobianJump GetExactJumpAtCenter(TriangleIndex triangle, const RayFan& fan) const;

private:
  /// The center of a triangle in its frame.
  Vector2 GetCenterInFrame(TriangleIndex triangle) const;

  /// Adds rays in a triangle, from one direction of its frame to another, both included.
  template <typename LengthOf>
  void AddRays(RayFan& fan, TriangleIndex triangle, const Vector2& from, const Vector2& to,
    LengthOf&& lengthOf) const;

  const Homeomorphism& Map;
  CenterPoint Center;
  int RaysBetween;
  /// The triangles at point i are those with the indices Offsets[i] to Offsets[i + 1] - 1.
  std::vector<std::int32_t> Offsets;
  std::vector<TriangleIndex> Triangles;
};

} // namespace homeomorphism

#endif
