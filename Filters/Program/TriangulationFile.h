// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TriangulationFile.h
/// PROJ's triangulation files (JSON, "tinshift"), the format in which national coordinate shifts
/// are published: https://proj.org/en/stable/specifications/triangulation.html

#ifndef dhm_TriangulationFile_h
#define dhm_TriangulationFile_h

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <nlohmann/json.hpp>

#include <array>
#include <iosfwd>
#include <string>

namespace dhm
{

/// What such a file says.
struct TriangulationFile
{
  /// The file without its vertices and triangles, members in the file's order.
  nlohmann::ordered_json Metadata;
  /// Source and target, which share their cells; z is 0.
  std::array<vtkSmartPointer<vtkPolyData>, 2> Meshes;
  /// Whether heights are to be shifted too, which is not done here.
  bool ShiftsHeights = false;
};

/// Reads a triangulation file of format 1.x that shifts horizontal coordinates. Throws Failure,
/// naming the line where the text is no JSON and the member where it is no triangulation file.
TriangulationFile ReadTriangulationFile(std::istream& file, const std::string& fileName);

/// Writes planar meshes (z is left out) with metadata as in TriangulationFile; what the format
/// requires of it and is missing is added. One vertex and one triangle to a line; the numbers are
/// the shortest that are read as the same.
void WriteTriangulationFile(const nlohmann::ordered_json& metadata, vtkPolyData* source,
  vtkPolyData* target, std::ostream& file);

} // namespace dhm

#endif
