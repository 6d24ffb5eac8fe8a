// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "DiagnosticMessages.h"

#include "Mesh/CubicMapOptions.h"
#include "Mesh/Triangulation.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <sstream>

namespace homeomorphism
{
namespace
{

/// The defect, to follow "1 triangle of the source (cell 5) " or "2 triangles of the source (cells
/// 5, 6) ".
std::string GetFault(const MeshDiagnostic& diagnostic, bool one)
{
  using Kind = MeshDiagnostic::Kind;
  const auto choose = [one](const char* singular, const char* plural) {
    return std::string(one ? singular : plural);
  };
  switch (diagnostic.What)
  {
    case Kind::NotTriangles:
      return choose("is not a triangle", "are not triangles");
    case Kind::TriangleStrips:
      return choose("is a triangle strip", "are triangle strips");
    case Kind::BadConnectivity:
      return choose("refers to points that do not exist", "refer to points that do not exist");
    case Kind::ConnectivityDiffers:
      return choose("has different points in the source and in the target",
        "have different points in the source and in the target");
    case Kind::RepeatedCorner:
      return choose("uses the same point twice", "use the same point twice");
    case Kind::NotFinite:
      return choose("has a coordinate that is not finite", "have coordinates that are not finite");
    case Kind::DegenerateTriangle:
      return choose("is degenerate (has zero area)", "are degenerate (have zero area)");
    case Kind::NonManifoldEdge:
      return choose("has a non-manifold edge (an edge of more than two triangles)",
        "have non-manifold edges (edges of more than two triangles)");
    case Kind::NonOrientable:
      return choose(
        "cannot be wound consistently with its neighbors: the surface is non-orientable",
        "cannot be wound consistently with their neighbors: the surface is non-orientable");
    case Kind::Flipped:
      return choose("is flipped between source and target relative to the other triangles",
        "are flipped between source and target relative to the other triangles");
    case Kind::Overlapping:
    {
      std::ostringstream text;
      text << choose("overlaps another triangle", "overlap other triangles") << ", by up to "
           << diagnostic.Size;
      return text.str();
    }
    case Kind::Discordant:
      return choose("is discordant", "are discordant") +
        ": the foot of a center segment is not inside its edge, so the Contour system is not "
        "defined there";
    default:
      return "";
  }
}

const char* GetAdvice(MeshDiagnostic::Remedy remedy)
{
  using Remedy = MeshDiagnostic::Remedy;
  switch (remedy)
  {
    case Remedy::UseSameMesh:
      return "Source and target must be the same mesh with different point coordinates.";
    case Remedy::SplitMeshes:
      return "Split the meshes.";
    case Remedy::Triangulate:
      return "Triangulate the source (vtkTriangleFilter) and give the target the source's cells, "
             "so that both are cut along the same diagonals.";
    case Remedy::ReadAgain:
      return "The mesh is corrupt: read or create it again.";
    case Remedy::UseSourceCells:
      return "Give the target the source's cells, and keep the order of its points.";
    case Remedy::RepairOrMask:
      return "Repair or remove them in both meshes, or leave them out (MaskInvalidTriangles).";
    case Remedy::CutOpen:
      return "Cut the surface open along a line of edges in both meshes.";
    case Remedy::MovePointsOrMask:
      return "Move their points so that all triangles keep their orientation (or all are "
             "mirrored), or leave them out (MaskInvalidTriangles).";
    case Remedy::UseOtherSystem:
      return "Use the Smooth system, which is defined in any triangle, or map them by the Linear "
             "system (DiscordantTriangles).";
    case Remedy::UseSmoothSystem:
      return "Use the Smooth system, which also maps surfaces.";
    case Remedy::RefineLess:
      return "Use a smaller FairnessRefinement, or local CubicBending.";
    case Remedy::FlattenOrUseTolerance:
      break;
  }
  return "Project it onto a plane, or use a Tolerance of";
}

/// The defect of a mesh as a whole.
std::string DescribeWhole(const MeshDiagnostic& diagnostic)
{
  using Kind = MeshDiagnostic::Kind;
  std::ostringstream text;
  const auto& [first, second] = diagnostic.Counts;
  switch (diagnostic.What)
  {
    case Kind::PointCountsDiffer:
      text << "The source has " << first << " points, the target " << second;
      break;
    case Kind::CellCountsDiffer:
      text << "The source has " << first << " triangles, the target " << second;
      break;
    case Kind::TooManyTriangles:
      text << "The " << GetName(diagnostic.Where) << " has " << first << " polygons and " << second
           << " points; it must have fewer than " << Triangulation::MaximumTriangles << " and "
           << std::numeric_limits<std::int32_t>::max();
      break;
    case Kind::NotPlanar:
      text << "The points of the " << GetName(diagnostic.Where)
           << " do not lie in a plane, but the Cubic system maps only planar meshes";
      break;
    case Kind::TooManyRefined:
      text << "FairnessRefinement divides the " << first << " triangles of the "
           << GetName(diagnostic.Where) << " into " << second
           << ", but the Cubic system with least bending maps at most "
           << CubicMapOptions::MostTriangles;
      break;
    default:
      text << "The points of the " << GetName(diagnostic.Where)
           << " do not lie in a plane, but within " << diagnostic.Size
           << " of one; the mesh is treated as a surface";
      break;
  }
  return text.str();
}

/// The message without the outcome and the remedy.
std::string DescribeDefect(const MeshDiagnostic& diagnostic)
{
  using Kind = MeshDiagnostic::Kind;
  if (diagnostic.Ids.empty())
  {
    return DescribeWhole(diagnostic);
  }
  const bool one = diagnostic.Ids.size() == 1;
  const bool cells =
    diagnostic.What == Kind::NotTriangles || diagnostic.What == Kind::TriangleStrips;
  return std::to_string(diagnostic.Ids.size()) + (cells ? " cell" : " triangle") +
    (one ? "" : "s") + " of the " + GetName(diagnostic.Where) + (one ? " (cell " : " (cells ") +
    ListIds(diagnostic.Ids) + ") " + GetFault(diagnostic, one);
}

} // namespace

std::string ListIds(const std::vector<vtkIdType>& ids)
{
  constexpr std::size_t most = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(ids.size(), most); ++i)
  {
    text += (i == 0 ? "" : ", ") + std::to_string(ids[i]);
  }
  return text + (ids.size() > most ? ", ..." : "");
}

const char* GetName(MeshDiagnostic::Kind kind)
{
  static constexpr std::array<const char*, MeshDiagnostic::NumberOfKinds> names{
    "PointCountsDiffer", "CellCountsDiffer", "TooManyTriangles", "NotTriangles", "TriangleStrips",
    "BadConnectivity", "ConnectivityDiffers", "RepeatedCorner", "NotFinite", "DegenerateTriangle",
    "NonManifoldEdge", "NonOrientable", "Flipped", "Overlapping", "Discordant", "NotPlanar",
    "TooManyRefined", "NearlyPlanar"
  };
  return names[static_cast<std::size_t>(kind)];
}

const char* GetName(MeshDiagnostic::Mesh mesh)
{
  static constexpr std::array<const char*, 4> names{ "source", "target", "pair", "triangulation" };
  return names[static_cast<std::size_t>(mesh)];
}

const char* GetName(MeshDiagnostic::Outcome outcome)
{
  static constexpr std::array<const char*, 4> names{ "refused", "masked", "mapped by Linear",
    "accepted" };
  return names[static_cast<std::size_t>(outcome)];
}

const char* GetName(MeshDiagnostic::Remedy remedy)
{
  static constexpr std::array<const char*, 12> names{ "UseSameMesh", "SplitMeshes", "Triangulate",
    "ReadAgain", "UseSourceCells", "RepairOrMask", "CutOpen", "MovePointsOrMask", "UseOtherSystem",
    "UseSmoothSystem", "RefineLess", "FlattenOrUseTolerance" };
  return names[static_cast<std::size_t>(remedy)];
}

std::string Describe(const MeshDiagnostic& diagnostic)
{
  using Outcome = MeshDiagnostic::Outcome;
  std::ostringstream text;
  text << DescribeDefect(diagnostic);
  switch (diagnostic.Result)
  {
    case Outcome::Refused:
      text << ". " << GetAdvice(diagnostic.GetRemedy());
      break;
    case Outcome::Masked:
      text << "; masked (MaskInvalidTriangles).";
      break;
    case Outcome::MappedByLinear:
      text << "; mapped by the Linear system (DiscordantTriangles).";
      break;
    case Outcome::Accepted:
      text << ". " << GetAdvice(diagnostic.GetRemedy()) << " " << diagnostic.Tolerance << ".";
      break;
  }
  return text.str();
}

std::string DescribeProblems(const MeshDiagnostics& diagnostics, MeshDiagnostic::Outcome outcome)
{
  std::string text;
  for (const MeshDiagnostic& diagnostic : diagnostics)
  {
    if (diagnostic.Result == outcome)
    {
      text += (text.empty() ? "" : "\n") + Describe(diagnostic);
    }
  }
  return text;
}

void ReportProblems(vtkObject* self, const MeshDiagnostics& diagnostics)
{
  const std::string errors = DescribeProblems(diagnostics, MeshDiagnostic::Outcome::Refused);
  const std::string warnings = DescribeProblems(diagnostics, MeshDiagnostic::Outcome::Masked);
  if (!errors.empty())
  {
    vtkErrorWithObjectMacro(self, << errors);
  }
  if (!warnings.empty())
  {
    vtkWarningWithObjectMacro(self, << warnings);
  }
  vtkDebugWithObjectMacro(
    self, << DescribeProblems(diagnostics, MeshDiagnostic::Outcome::MappedByLinear)
          << DescribeProblems(diagnostics, MeshDiagnostic::Outcome::Accepted));
}

void MakeTable(const MeshDiagnostics& diagnostics, vtkTable* table)
{
  table->Initialize();
  const auto addStrings = [&](const char* name, auto&& valueOf) {
    const vtkNew<vtkStringArray> column;
    column->SetName(name);
    for (const MeshDiagnostic& diagnostic : diagnostics)
    {
      column->InsertNextValue(valueOf(diagnostic));
    }
    table->AddColumn(column);
  };
  const auto addNumbers = [&](const char* name, auto&& valueOf) {
    const vtkNew<vtkIdTypeArray> column;
    column->SetName(name);
    for (const MeshDiagnostic& diagnostic : diagnostics)
    {
      column->InsertNextValue(valueOf(diagnostic));
    }
    table->AddColumn(column);
  };
  const auto addDoubles = [&](const char* name, int components, auto&& valueOf) {
    const vtkNew<vtkDoubleArray> column;
    column->SetName(name);
    column->SetNumberOfComponents(components);
    for (const MeshDiagnostic& diagnostic : diagnostics)
    {
      column->InsertNextTuple(valueOf(diagnostic));
    }
    table->AddColumn(column);
  };
  using Diagnostic = MeshDiagnostic;
  addStrings("Kind", [](const Diagnostic& d) { return GetName(d.What); });
  addStrings("Domain", [](const Diagnostic& d) { return GetName(d.Where); });
  addStrings("Outcome", [](const Diagnostic& d) { return GetName(d.Result); });
  addStrings("Remedy", [](const Diagnostic& d) { return GetName(d.GetRemedy()); });
  addNumbers("Count", [](const Diagnostic& d) { return static_cast<vtkIdType>(d.Ids.size()); });
  addNumbers("FirstCount", [](const Diagnostic& d) { return d.Counts[0]; });
  addNumbers("SecondCount", [](const Diagnostic& d) { return d.Counts[1]; });
  addDoubles("Size", 1, [](const Diagnostic& d) { return &d.Size; });
  addDoubles("Tolerance", 1, [](const Diagnostic& d) { return &d.Tolerance; });
  addDoubles("Position", 3, [](const Diagnostic& d) { return d.Position.data(); });
  vtkIdType first = 0;
  addNumbers("FirstId", [&first](const Diagnostic& d) {
    const vtkIdType own = first;
    first += static_cast<vtkIdType>(d.Ids.size());
    return own;
  });
  addStrings("Message", [](const Diagnostic& d) { return Describe(d); });
  addStrings("Defect", [](const Diagnostic& d) { return DescribeDefect(d); });

  const vtkNew<vtkIdTypeArray> ids;
  ids->SetName("Ids");
  for (const MeshDiagnostic& diagnostic : diagnostics)
  {
    for (const vtkIdType id : diagnostic.Ids)
    {
      ids->InsertNextValue(id);
    }
  }
  table->GetFieldData()->AddArray(ids);
}

} // namespace homeomorphism
