// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Canvas.h"
#include "Command.h"
#include "Console.h"
#include "Failure.h"
#include "InputFile.h"
#include "OutputFile.h"
#include "PairPicture.h"
#include "PairReport.h"
#include "Pipeline/DiagnosticMessages.h"

#include <CLI/CLI.hpp>

#include <nlohmann/json.hpp>

#include <cstdarg>
#include <cstdio>
#include <iostream>
#include <memory>

namespace dhm
{
namespace
{

using Json = nlohmann::ordered_json;
using homeomorphism::ListIds;
using homeomorphism::MeshDiagnostic;

std::string Format(const char* format, ...) __attribute__((format(printf, 1, 2)));

std::string Format(const char* format, ...)
{
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

/// How invalid triangles are left out, which is nothing that a check would do.
const char* const leaveOut = ", or leave them out (--mask-invalid of dhm map, warp and others)";

// --- For machines

Json ToJson(const Extreme& extreme)
{
  return extreme.Cell < 0 ? Json() : Json{ { "value", extreme.Value }, { "cell", extreme.Cell } };
}

const char* NameOf(MeshDiagnostic::Kind kind)
{
  using Kind = MeshDiagnostic::Kind;
  switch (kind)
  {
    case Kind::PointCountsDiffer:
      return "point counts differ";
    case Kind::CellCountsDiffer:
      return "cell counts differ";
    case Kind::TooManyTriangles:
      return "too many triangles";
    case Kind::NotTriangles:
      return "not triangles";
    case Kind::TriangleStrips:
      return "triangle strips";
    case Kind::BadConnectivity:
      return "bad connectivity";
    case Kind::ConnectivityDiffers:
      return "connectivity differs";
    case Kind::RepeatedCorner:
      return "repeated corner";
    case Kind::NotFinite:
      return "not finite";
    case Kind::DegenerateTriangle:
      return "no area";
    case Kind::NonManifoldEdge:
      return "edge of many triangles";
    case Kind::NonOrientable:
      return "not orientable";
    case Kind::Flipped:
      return "flipped";
    case Kind::Overlapping:
      return "overlapping";
    case Kind::Discordant:
      return "discordant";
    case Kind::NearlyPlanar:
      return "nearly planar";
  }
  return "";
}

Json ToJson(const PairReport& report, const MeshPair& pair)
{
  Json json;
  json["valid"] = report.Valid;
  json["problems"] = Json::array();
  for (const MeshDiagnostic& problem : report.Problems)
  {
    json["problems"].push_back({ { "kind", NameOf(problem.What) },
      { "where", homeomorphism::GetName(problem.Where) }, { "count", problem.Ids.size() },
      { "first_cells", problem.Ids }, { "message", Describe(problem, leaveOut) } });
  }
  const char* const domains[2] = { "source", "target" };
  for (std::size_t side = 0; side < 2; ++side)
  {
    const MeshReport& mesh = report.Meshes[side];
    Json& object = json[domains[side]];
    object = { { "file", pair.Names[side] }, { "points", mesh.Points },
      { "triangles", mesh.Triangles }, { "unused_points", mesh.UnusedPoints },
      { "duplicate_points", mesh.DuplicatePoints }, { "first_duplicates", mesh.FirstDuplicates } };
    if (report.Measured)
    {
      object["planar"] = mesh.Planar;
      object["discordant_triangles"] = mesh.DiscordantTriangles.size();
      object["smallest_angle_degrees"] = ToJson(mesh.SmallestAngle);
      object["largest_area_ratio_across_an_edge"] = ToJson(mesh.LargestAreaRatio);
    }
  }
  if (!report.Measured)
  {
    return json;
  }
  json["mirrored"] = report.Mirrored;
  json["mended_windings"] = report.MendedWindings;
  json["reordered_triangles"] = report.ReorderedTriangles;
  json["components"] = report.Components;
  json["interior_edges"] = report.InteriorEdges;
  json["boundary_edges"] = report.BoundaryEdges;
  json["boundary_loops"] = report.BoundaryLoops;
  json["largest_stretch"] = ToJson(report.LargestStretch);
  json["smallest_stretch"] = ToJson(report.SmallestStretch);
  json["worst_distortion"] = ToJson(report.WorstDistortion);
  for (std::size_t system = 0; system < 3; ++system)
  {
    const SystemReport& measured = report.Systems[system];
    Json object;
    if (measured.Samples > 0)
    {
      object["samples"] = measured.Samples;
      object["smallest_determinant"] = ToJson(measured.SmallestDeterminant);
      object["largest_determinant"] = ToJson(measured.LargestDeterminant);
      object["not_positive"] = measured.NotPositive;
      object["largest_distance_from_linear"] = ToJson(measured.DistanceFromLinear);
    }
    if (measured.ContinuityMeasured)
    {
      object["differentiable_edges"] = measured.DifferentiableEdges;
      object["creases"] = measured.Creases;
      object["undecided_edges"] = measured.UndecidedEdges;
      object["largest_jump"] = measured.LargestJump;
    }
    json["systems"][SystemNames[system]] = object;
  }
  return json;
}

// --- For people

/// One line of the report, in columns.
void Row(const std::string& name, const std::vector<std::string>& columns)
{
  std::string line = Format("  %-38s ", name.c_str());
  for (const std::string& column : columns)
  {
    line += Format("%-22s ", column.c_str());
  }
  line.erase(line.find_last_not_of(' ') + 1);
  std::cout << line << "\n";
}

std::string AtCell(const char* format, const Extreme& extreme)
{
  return extreme.Cell < 0
    ? "none"
    : Format(format, extreme.Value) + " (cell " + std::to_string(extreme.Cell) + ")";
}

void PrintMeshes(const PairReport& report)
{
  const auto both = [&report](const std::string& name, auto&& text) {
    Row(name, { text(report.Meshes[0]), text(report.Meshes[1]) });
  };
  Row("", { "source", "target" });
  both("points", [](const MeshReport& mesh) { return std::to_string(mesh.Points); });
  both("triangles", [](const MeshReport& mesh) { return std::to_string(mesh.Triangles); });
  both("points that no triangle uses",
    [](const MeshReport& mesh) { return std::to_string(mesh.UnusedPoints); });
  both("duplicate points", [](const MeshReport& mesh) {
    return std::to_string(mesh.DuplicatePoints) +
      (mesh.DuplicatePoints > 0 ? " (" + ListIds(mesh.FirstDuplicates) + ")" : std::string());
  });
  if (!report.Measured)
  {
    return;
  }
  both("planar",
    [](const MeshReport& mesh) { return std::string(mesh.Planar ? "yes" : "no, a surface"); });
  both("concordant triangles", [](const MeshReport& mesh) {
    return Format("%.1f %%",
      100.0 *
        (1.0 -
          static_cast<double>(mesh.DiscordantTriangles.size()) /
            static_cast<double>(mesh.Triangles)));
  });
  both("smallest angle, degrees",
    [](const MeshReport& mesh) { return AtCell("%.3g", mesh.SmallestAngle); });
  both("largest area ratio across an edge",
    [](const MeshReport& mesh) { return AtCell("%.4g", mesh.LargestAreaRatio); });
}

void PrintPair(const PairReport& report)
{
  std::cout << "\n";
  Row("mirrored", { report.Mirrored ? "yes" : "no" });
  Row("windings mended", { std::to_string(report.MendedWindings) });
  Row("triangles listed in another order", { std::to_string(report.ReorderedTriangles) });
  Row("components", { std::to_string(report.Components) });
  Row("boundary loops", { std::to_string(report.BoundaryLoops) });
  Row("edges",
    { std::to_string(report.InteriorEdges) + " interior, " + std::to_string(report.BoundaryEdges) +
      " on the boundary" });
  Row("lengths change by factors of",
    { AtCell("%.6g", report.SmallestStretch) + " to " + AtCell("%.6g", report.LargestStretch) });
  Row("worst distortion (ratio of the two)", { AtCell("%.6g", report.WorstDistortion) });
}

void PrintSystems(const PairReport& report)
{
  // What was not measured has no columns.
  const bool hasColumns = report.Systems[0].Samples > 0 || report.Systems[0].ContinuityMeasured;
  if (!hasColumns)
  {
    return;
  }
  std::cout << "\n";
  Row("", { SystemNames[0], SystemNames[1], SystemNames[2] });
  const auto row = [&report](const std::string& name, auto&& text) {
    Row(name, { text(report.Systems[0]), text(report.Systems[1]), text(report.Systems[2]) });
  };
  if (report.Systems[0].Samples > 0)
  {
    row("det J, smallest",
      [](const SystemReport& system) { return AtCell("%.6g", system.SmallestDeterminant); });
    row("det J, largest",
      [](const SystemReport& system) { return AtCell("%.6g", system.LargestDeterminant); });
    row("points where det J has the wrong sign",
      [](const SystemReport& system) { return std::to_string(system.NotPositive); });
    row("farthest from Linear, target's units",
      [](const SystemReport& system) { return AtCell("%.4g", system.DistanceFromLinear); });
  }
  if (report.Systems[0].ContinuityMeasured)
  {
    row("edges: differentiable",
      [](const SystemReport& system) { return std::to_string(system.DifferentiableEdges); });
    row(
      "edges: creases", [](const SystemReport& system) { return std::to_string(system.Creases); });
    row("edges: undecided",
      [](const SystemReport& system) { return std::to_string(system.UndecidedEdges); });
    row("largest jump of J, relative",
      [](const SystemReport& system) { return Format("%.2g", system.LargestJump); });
  }
  if (report.Systems[0].Samples > 0)
  {
    std::cout << "\n  det J: at " << report.Systems[0].Samples << " points within the triangles.";
  }
  if (!report.Meshes[0].DiscordantTriangles.empty() ||
    !report.Meshes[1].DiscordantTriangles.empty())
  {
    std::cout << "\n  Discordant triangles are Linear's in the column Contour.";
  }
  std::cout << "\n";
}

/// All but what the map is like in the three systems.
void PrintAllOfMeshes(const PairReport& report, const MeshPair& pair)
{
  std::cout << pair.GetName() << ": " << (report.Valid ? "a valid pair" : "NOT a valid pair")
            << "\n";
  for (const MeshDiagnostic& problem : report.Problems)
  {
    std::cout << "  - " << Describe(problem, leaveOut) << "\n";
  }
  std::cout << "\n";
  PrintMeshes(report);
  if (report.Measured)
  {
    PrintPair(report);
  }
  // What follows may take long.
  std::cout.flush();
}

} // namespace

void AddCheck(CLI::App& program)
{
  struct Options
  {
    InputFiles Inputs;
    bool Machine = false;
    bool Quick = false;
    std::string Picture;
    bool Replace = false;
  };
  CLI::App* command =
    program.add_subcommand("check", "Tell whether two meshes define a map, and what it is like");
  const auto options = std::make_shared<Options>();
  options->Inputs.AddTo(*command, "SOURCE [TARGET]", 0, "The pair");
  command->add_flag("--json", options->Machine, "Write the report as JSON")->group("Results");
  command
    ->add_flag("--quick", options->Quick,
      "Look at the meshes only: do not measure determinants and continuity")
    ->group("Results");
  command
    ->add_option(
      "--picture", options->Picture, "Draw the pair with the offenders marked: .png .svg .pdf")
    ->type_name("FILE")
    ->group("Results");
  command->add_flag("-f,--force", options->Replace, "Replace the picture if it exists")
    ->group("Results");
  command->footer(
    "Exit status: 0 the pair defines a map, 1 it does not.\n"
    "Invalid triangles are left out of what is measured. Continuity: at each interior edge, "
    "whether the map's derivative is the same on both sides, as measured from the map's values. "
    "(Smooth is twice continuously differentiable except at the meshes' points, where edges end.)");
  command->callback([options] {
    std::unique_ptr<OutputFile> picture;
    if (!options->Picture.empty())
    {
      if (!Canvas::IsFormat(FormatOf(options->Picture)))
      {
        throw Failure(
          WRONG_USAGE, "Pictures are .png, .svg or .pdf: " + options->Picture + " is none.");
      }
      picture = std::make_unique<OutputFile>(options->Picture, "", options->Replace);
    }
    const MeshPair pair = options->Inputs.ReadPair(0);
    CheckExtent extent;
    extent.Determinants = extent.Continuity = !options->Quick;
    const PairReport report = CheckPair(pair, extent, [&](const PairReport& known) {
      if (!options->Machine)
      {
        PrintAllOfMeshes(known, pair);
      }
    });
    if (options->Machine)
    {
      std::cout << ToJson(report, pair).dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
    }
    else
    {
      PrintSystems(report);
    }
    if (IsUnwelded(report))
    {
      Warn("the triangles share hardly any points: in the source, " +
        Count(report.Meshes[0].DuplicatePoints, "point", "is in the place of another",
          "are in the places of others") +
        ", and " + Count(report.InteriorEdges, "edge", "joins", "join") +
        " two triangles. If they are to be one mesh, join such points, in both meshes alike: for "
        "example, write one file that has both (dhm convert -o both.vtp) and apply VTK's "
        "vtkCleanPolyData (ParaView's Clean) to that. Else each triangle is mapped by itself.");
    }
    if (!std::cout.flush())
    {
      throw Failure(FILE_TROUBLE, "Cannot write to standard output.");
    }
    if (picture)
    {
      DrawPair(pair, report, *picture);
      picture->Commit();
    }
    if (!report.Valid)
    {
      // The report has said why.
      throw Failure(REFUSED, pair.GetName() + ": not a valid pair.");
    }
  });
}

} // namespace dhm
