// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file XmorphMesh.h
/// Reads the meshes of xmorph and gtkmorph: grids of quadrilaterals laid over two pictures by hand.

#ifndef XmorphMesh_h
#define XmorphMesh_h

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <iosfwd>
#include <string>
#include <vector>

/// A grid of points over a picture.
struct XmorphMesh
{
  int Columns = 0;
  int Rows = 0;
  /// Row by row, from the picture's top left.
  std::vector<std::array<double, 2>> Points;
};

/// Reads a mesh file ("M2", then the numbers of columns and rows, then a line "x y label" for each
/// point). Throws std::runtime_error, naming file and line, if it is not one.
XmorphMesh ReadXmorphMesh(const std::string& fileName);

/// The same from an open file; the name is for messages.
XmorphMesh ReadXmorphMesh(std::istream& file, const std::string& fileName);

/// Whether the mesh's rim runs along the borders of the picture: whether it is a rectangle from 0
/// to the last column and row.
bool FillsPicture(const XmorphMesh& mesh);

/// The right end and the bottom of the picture in the mesh's own units: of a mesh that fills it,
/// its largest coordinates.
std::array<double, 2> GetExtent(const XmorphMesh& mesh);

/// Lets y, which runs downwards from the picture's top, run upwards from @a bottom.
void TurnUpright(XmorphMesh& mesh, double bottom);

/// Moves the points from the mesh's own units, which end at its last column and row, to the pixels
/// of a picture of this size as VTK counts them, y upwards. Throws std::runtime_error if the mesh
/// has no extent.
void FitToPicture(XmorphMesh& mesh, int width, int height);

/// The two meshes cut into the same triangles. Each quadrilateral is cut along the diagonal that
/// leaves the larger smallest angle, over both meshes. Throws std::runtime_error if their sizes
/// differ.
std::array<vtkSmartPointer<vtkPolyData>, 2> CutIntoTriangles(
  const XmorphMesh& first, const XmorphMesh& second);

#endif
