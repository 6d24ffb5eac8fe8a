// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file EdgeCrossings.h
/// The edges of a triangulation, across which a map may not be differentiable.

#ifndef homeomorphism_EdgeCrossings_h
#define homeomorphism_EdgeCrossings_h

#include "Continuity/JacobianJump.h"
#include "Mesh/Homeomorphism.h"

#include <array>
#include <cstdint>
#include <vector>

namespace homeomorphism
{

/// An edge and the triangles on its two sides.
struct MeshEdge
{
  /// The second triangle and apex are -1 on the boundary.
  std::array<TriangleIndex, 2> Triangles;
  /// The ends of the edge.
  std::array<std::int32_t, 2> Points;
  /// The corners opposite the edge.
  std::array<std::int32_t, 2> Apexes;
};

/// The edges of the source of a map, each one once, in the order of their first triangles.
class EdgeCrossings
{
public:
  /// Keeps a reference to the map. Its target is optional.
  explicit EdgeCrossings(const Homeomorphism& map);

  const std::vector<MeshEdge>& GetInteriorEdges() const { return this->InteriorEdges; }
  const std::vector<MeshEdge>& GetBoundaryEdges() const { return this->BoundaryEdges; }

  /// The crossing at a proportion of the length of an interior edge. The axes of the image follow
  /// from the target if there is one, otherwise from the values of the map.
  LineCrossing GetCrossing(std::size_t edge, double proportion, const MapUnderTest& map) const;

  /// The jump at a crossing of the edge, in closed form.
  JacobianJump GetExactJump(std::size_t edge, const LineCrossing& crossing) const;

  Vector3 GetPosition(Domain domain, std::int32_t point) const;

private:
  const Homeomorphism& Map;
  std::vector<MeshEdge> InteriorEdges;
  std::vector<MeshEdge> BoundaryEdges;
};

} // namespace homeomorphism

#endif
