// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshValidation.h
/// The tests for defects of meshes and pairs of meshes. Each function finds one kind of defect
/// and the triangles that have it. TriangulationPair refuses the meshes or masks the
/// triangles.

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

/// Triangle indices, ascending and unique.
using TriangleList = std::vector<TriangleIndex>;

/// Cell id of the first polygon of a mesh. Vertices and lines have lower ids than polygons.
vtkIdType FirstPolygon(vtkPolyData* mesh);

/// Reads the polygons of a vtkPolyData as triangles; vertices and lines beside them are no part of
/// the triangulation. Reports polygons and strips that are not triangles, ids of points that do not
/// exist, and counts beyond what can be numbered.
LargeArray<Triangulation::Corners> ReadTriangles(
  vtkPolyData* mesh, MeshDiagnostic::Mesh where, MeshDiagnostics& diagnostics);

/// Reports differences between source and target: counts, and triangles that do not have the same
/// three points. The order of the three points is free.
void CompareConnectivity(vtkPolyData* source, vtkPolyData* target,
  const LargeArray<Triangulation::Corners>& sourceTriangles,
  const LargeArray<Triangulation::Corners>& targetTriangles, MeshDiagnostics& diagnostics);

/// The array that marks hidden elements and elements of other pieces (vtkGhostType), or null if
/// there is none with one value for each of @a tuples points or cells.
vtkUnsignedCharArray* GhostsOf(vtkDataSetAttributes* attributes, vtkIdType tuples);

/// The blanked triangles of a mesh: hidden cells and cells with hidden points (vtkGhostType).
TriangleList FindBlanked(vtkPolyData* mesh, const Triangulation& triangulation);

/// Triangles with a repeated corner.
TriangleList FindRepeatedCorners(const Triangulation& triangulation);

/// Triangles with a coordinate that is not finite.
TriangleList FindNotFinite(const Triangulation& triangulation, const MeshGeometry& geometry);

/// Degenerate triangles.
TriangleList FindDegenerate(const Triangulation& triangulation, const MeshGeometry& geometry);

/// For two planar meshes, the triangles that change their orientation if most do not, or keep it if
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
