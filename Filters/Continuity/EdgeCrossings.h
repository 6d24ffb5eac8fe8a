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

/// An edge and its two sides.
struct MeshEdge
{
  /// The second is -1 on the boundary, as is the second apex.
  std::array<TriangleIndex, 2> Triangles;
  /// Its ends.
  std::array<std::int32_t, 2> Points;
  /// The corners opposite the edge.
  std::array<std::int32_t, 2> Apexes;
};

/// The edges of a map's source, each once, in the order of their first triangle.
class EdgeCrossings
{
public:
  /// Refers to the map. Its target need not exist.
  explicit EdgeCrossings(const Homeomorphism& map);

  const std::vector<MeshEdge>& GetInteriorEdges() const { return this->InteriorEdges; }
  const std::vector<MeshEdge>& GetBoundaryEdges() const { return this->BoundaryEdges; }

  /// The crossing at a proportion of an interior edge's length. The image's axes follow from the
  /// target, if there is one, or from the map's values.
  LineCrossing GetCrossing(std::size_t edge, double proportion, const MapUnderTest& map) const;

  /// The jump at a crossing of the edge by the map's closed form.
  JacobianJump GetExactJump(std::size_t edge, const LineCrossing& crossing) const;

  Vector3 GetPosition(Domain domain, std::int32_t point) const;

private:
  const Homeomorphism& Map;
  std::vector<MeshEdge> InteriorEdges;
  std::vector<MeshEdge> BoundaryEdges;
};

} // namespace homeomorphism

#endif
