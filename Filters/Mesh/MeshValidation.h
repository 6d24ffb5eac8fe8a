// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshValidation.h
/// The tests for defects of meshes and pairs of meshes. Each function finds the triangles that have
/// one kind of defect. TriangulationPair refuses the meshes or masks the triangles.

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

/// Cell id of the first polygon of a mesh. Vertices and lines have smaller ids than polygons.
vtkIdType FirstPolygon(vtkPolyData* mesh);

/// Reads the polygons of a vtkPolyData as triangles; vertices and lines are not part of the
/// triangulation. Reports polygons and strips that are not triangles, ids of points that do not
/// exist, and more triangles or points than can be numbered.
LargeArray<Triangulation::Corners> ReadTriangles(
  vtkPolyData* mesh, MeshDiagnostic::Mesh where, MeshDiagnostics& diagnostics);

/// Reports differences between source and target: different numbers of points or triangles, and
/// triangles that do not have the same three points, in any order.
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

/// For two planar meshes, the triangles that change their orientation although most do not, or that
/// keep it although most change it.
TriangleList FindFlipped(
  const Triangulation& triangulation, const MeshGeometry& source, const MeshGeometry& target);

/// Triangles of a planar mesh whose interiors meet those of others.
struct Overlaps
{
  /// Triangles that overlap by more than the rounding of the coordinates.
  TriangleList Triangles;
  /// Triangles that overlap only by the rounding of the coordinates.
  TriangleList WithinRounding;
  /// The depth of the deepest overlap found beyond the rounding, in normalized coordinates.
  double Depth = 0.0;
};

/// Finds overlaps by exact predicates. The adjacency of @a triangulation and @a location must have
/// been computed with the masked triangles. Takes O(n log n) time if there are no overlaps;
/// @a location is used only if there are some.
///
/// The depth of an overlap is the shortest distance by which one triangle must be moved to remove
/// it. Coordinates are rounded, so triangles that should touch may overlap by
/// MeshGeometry::GetRounding(). Such an overlap is ignored if its depth is also at most a quarter
/// of the heights of both triangles, and if the two are not adjacent: the overlap of adjacent
/// triangles is a fold.
Overlaps FindOverlapping(
  const Triangulation& triangulation, const MeshGeometry& geometry, const PointLocation& location);

} // namespace homeomorphism

#endif
