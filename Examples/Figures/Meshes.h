// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Meshes.h
/// What the figures ask of the library, in terms of the drawings' points and curves.

#ifndef Meshes_h
#define Meshes_h

#include "Drawing.h"

#include "vtkHomeomorphismTransform.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTriangularCoordinates.h"

#include <array>
#include <string>
#include <vector>

using TriangleIds = std::array<vtkIdType, 3>;

extern const std::array<std::string, 3> systemNames;

vtkSmartPointer<vtkPolyData> MakeMesh(
  const Curve& points, const std::vector<TriangleIds>& triangles);

Curve GetTriangle(vtkPolyData* mesh, vtkIdType triangle);

/// Triangular coordinates of a mesh, with lines. Discordant triangles have Linear lines in the
/// Contour system. Throws std::runtime_error if the mesh is refused.
vtkSmartPointer<vtkTriangularCoordinates> MakeCoordinates(
  vtkPolyData* mesh, int coordinateSystem, int contours, int rings, int centerPoint = 0);

/// Those lines of one type (vtkTriangularCoordinates::LineTypes), in one triangle or in all (-1).
vtkSmartPointer<vtkPolyData> SelectLines(
  vtkTriangularCoordinates* coordinates, int lineType, vtkIdType triangle = -1);

bool IsConcordant(vtkTriangularCoordinates* coordinates, vtkIdType triangle);

/// The map between two planar meshes. Throws std::runtime_error if they are refused, or in the
/// Contour system if a triangle is discordant.
vtkSmartPointer<vtkHomeomorphismTransform> MakeMap(
  vtkPolyData* source, vtkPolyData* target, int coordinateSystem);

/// The image of a curve. Throws std::runtime_error if a point of it is outside.
Curve MapCurve(vtkHomeomorphismTransform* map, const Curve& curve);

/// A straight line in many pieces.
Curve Divide(const Point& from, const Point& to, int pieces);

/// The edges that one triangle only has.
std::vector<Curve> BoundaryEdges(vtkPolyData* mesh);

/// The pieces of a straight line that are inside a mesh, each with its crossings of edges in
/// between.
std::vector<Curve> CrossMesh(vtkPolyData* mesh, const Point& from, const Point& to);

#endif
