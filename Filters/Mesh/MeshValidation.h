// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshValidation.h
/// Everything for which a mesh or a pair of meshes is refused (or its triangles are masked). Each
/// function finds one kind of defect and says which triangles have it; TriangulationPair decides
/// what becomes of them.

#ifndef homeomorphism_MeshValidation_h
#define homeomorphism_MeshValidation_h

#include "MeshDiagnostic.h"
#include "MeshGeometry.h"
#include "PointLocation.h"
#include "Triangulation.h"

#include <vector>

class vtkDataSetAttributes;
class vtkPolyData;
class vtkUnsignedCharArray;

namespace homeomorphism
{

/// Numbers of triangles, ascending, without repetition.
using TriangleList = std::vector<TriangleIndex>;

/// Cell id of a mesh's first polygon: vertices and lines are numbered before polygons.
vtkIdType FirstPolygon(vtkPolyData* mesh);

/// Reads the polygons of a vtkPolyData as triangles; vertices and lines beside them are no part of
/// the triangulation. Reports polygons and strips that are not triangles, ids of points that do not
/// exist, and counts beyond what can be numbered.
LargeArray<Triangulation::Corners> ReadTriangles(
  vtkPolyData* mesh, MeshDiagnostic::Mesh where, MeshDiagnostics& diagnostics);

/// Reports what keeps source and target from being the same mesh: counts, and triangles that do not
/// have the same three points. The order of the three points is free.
void CompareConnectivity(vtkPolyData* source, vtkPolyData* target,
  const LargeArray<Triangulation::Corners>& sourceTriangles,
  const LargeArray<Triangulation::Corners>& targetTriangles, MeshDiagnostics& diagnostics);

/// The array of some attributes that marks what is hidden or belongs to another piece
/// (vtkGhostType); null if there is none that has one value for each of @a tuples points or cells.
vtkUnsignedCharArray* GhostsOf(vtkDataSetAttributes* attributes, vtkIdType tuples);

/// Triangles that the mesh itself blanks: hidden cells and cells with hidden points (vtkGhostType).
TriangleList FindBlanked(vtkPolyData* mesh, const Triangulation& triangulation);

/// Triangles that use a point twice.
TriangleList FindRepeatedCorners(const Triangulation& triangulation);

/// Triangles with a coordinate that is not finite.
TriangleList FindNotFinite(const Triangulation& triangulation, const MeshGeometry& geometry);

/// Triangles without area.
TriangleList FindDegenerate(const Triangulation& triangulation, const MeshGeometry& geometry);

/// Of two planar meshes, the triangles that change their orientation if most do not, or keep it if
/// most change it.
TriangleList FindFlipped(
  const Triangulation& triangulation, const MeshGeometry& source, const MeshGeometry& target);

/// Triangles of a planar mesh whose interiors meet those of others.
struct Overlaps
{
  /// Beyond the rounding of the coordinates.
  TriangleList Triangles;
  /// Only by the rounding of the coordinates.
  TriangleList WithinRounding;
  /// The depth of the deepest overlap found beyond the rounding, in normalized coordinates.
  double Depth = 0.0;
};

/// Finds overlaps by exact predicates. @a triangulation's adjacency and @a location must know which
/// triangles are masked. Takes n log n time if there are no overlaps; @a location is used only if
/// there are some.
///
/// The depth of an overlap is how far one triangle has to be moved until it ends. Coordinates are
/// rounded, so triangles that should touch may overlap by MeshGeometry::GetRounding(). Such an
/// overlap is none, if its depth is also at most a quarter of the heights of both triangles, and
/// the two are not adjacent: the overlap of adjacent triangles is a fold.
Overlaps FindOverlapping(
  const Triangulation& triangulation, const MeshGeometry& geometry, const PointLocation& location);

} // namespace homeomorphism

#endif
