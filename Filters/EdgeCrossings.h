// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file EdgeCrossings.h
/// The interior edges of a triangulation, as places where a map may not be differentiable.

#ifndef homeomorphism_EdgeCrossings_h
#define homeomorphism_EdgeCrossings_h

#include "Mesh/Homeomorphism.h"
#include "Mesh/JacobianJump.h"

#include "vtkType.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// An edge with a triangle on either side.
struct InteriorEdge
{
  std::array<TriangleIndex, 2> Triangles;
  std::array<vtkIdType, 2> Cells;
  /// Its ends, as point ids and positions in the source.
  std::array<std::int32_t, 2> Points;
  Vector3 Start;
  Vector3 End;
  /// The corners opposite the edge.
  std::array<std::int32_t, 2> Apexes;
};

/// The interior edges of a map's source, each once, in the order of their first triangle.
class EdgeCrossings
{
public:
  /// Refers to the map. Its target need not exist.
  explicit EdgeCrossings(const Homeomorphism& map);

  vtkIdType GetNumberOfEdges() const { return static_cast<vtkIdType>(this->Edges.size()); }
  vtkIdType GetNumberOfBoundaryEdges() const { return this->NumberOfBoundaryEdges; }
  const InteriorEdge& GetEdge(vtkIdType edge) const { return this->Edges[edge]; }

  /// The crossing at a proportion of the edge's length. The image's axes follow from the target, if
  /// there is one, or from the map's values.
  LineCrossing GetCrossing(vtkIdType edge, double proportion, const MapUnderTest& evaluate) const;

  /// The jump at a crossing of the edge by the map's closed form.
  JacobianJump GetExactJump(vtkIdType edge, const LineCrossing& crossing) const;

private:
  Vector3 GetPosition(Side side, std::int32_t point) const;

  const Homeomorphism& Map;
  std::vector<InteriorEdge> Edges;
  vtkIdType NumberOfBoundaryEdges = 0;
};

} // namespace homeomorphism

#endif
