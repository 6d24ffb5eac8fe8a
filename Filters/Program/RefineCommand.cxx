// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Command.h"
#include "Console.h"
#include "Failure.h"
#include "MeshParts.h"
#include "Numbers.h"
#include "OutputFile.h"
#include "PairReport.h"
#include "Refinement.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>

namespace dhm
{
namespace
{

struct PairOutput
{
  OutputOptions Output;
  std::string TargetArray = "Target";
  std::string InputCrs;
  std::string OutputCrs;

  void AddTo(CLI::App& command, const std::string& description)
  {
    this->Output.AddTo(command, description, "json");
    command
      .add_option("--input-crs", this->InputCrs,
        "Coordinate reference system of the source, as a triangulation file says it: EPSG:2393")
      ->type_name("CRS")
      ->group("Results");
    command.add_option("--output-crs", this->OutputCrs, "The same of the target")
      ->type_name("CRS")
      ->group("Results");
  }

  void Describe(MeshPair& pair) const
  {
    if (!this->InputCrs.empty())
    {
      pair.Metadata["input_crs"] = this->InputCrs;
    }
    if (!this->OutputCrs.empty())
    {
      pair.Metadata["output_crs"] = this->OutputCrs;
    }
  }
};

void RequirePlane(const MeshPair& pair)
{
  for (std::size_t side = 0; side < 2; ++side)
  {
    if (!IsFlat(pair.Meshes[side]))
    {
      throw Failure(REFUSED, pair.Names[side] + " is not in a plane parallel to x and y.");
    }
  }
}

} // namespace

void AddRefine(CLI::App& program)
{
  struct Options
  {
    InputFiles Inputs;
    MapOptions Map;
    PairOutput Output;
    double Tolerance = 0.0;
    vtkIdType MostTriangles = 2000000;
  };
  CLI::App* command = program.add_subcommand("refine",
    "Make a finer pair whose piecewise linear map is close to the Smooth map, for PROJ and others");
  const auto options = std::make_shared<Options>();
  options->Inputs.AddTo(*command, "SOURCE [TARGET]", 0, "The pair, in a plane");
  options->Output.AddTo(*command,
    "The finer pair: .json (PROJ's triangulation file), .vtp, .vtk, or - for standard output");
  command
    ->add_option("-t,--within", options->Tolerance,
      "How far from the map the piecewise linear map may be anywhere, in the target's units")
    ->required()
    ->check(PositiveNumber())
    ->type_name("DISTANCE")
    ->group("Results");
  command
    ->add_option(
      "--most-triangles", options->MostTriangles, "Give up beyond this number (default: 2000000)")
    ->check(PositiveNumber())
    ->type_name("NUMBER")
    ->group("Results");
  options->Map.AddTo(*command, false);
  command->callback([options] {
    OutputFile output(
      options->Output.Output.Name, options->Output.Output.Format, options->Output.Output.Replace);
    CheckPairFormat(output.GetFormat());
    const MeshPair pair = options->Inputs.ReadPair(0);
    RequireMap(pair);
    RequirePlane(pair);
    Refinement refined = Refine(pair, options->Map, options->Tolerance, options->MostTriangles);
    Remark(std::to_string(pair.Source()->GetNumberOfPolys()) + " triangles became " +
      std::to_string(refined.Pair.Source()->GetNumberOfPolys()) + "; farthest from " +
      SystemNames[options->Map.System] + ": " + ToText(refined.Distance) + ", at " +
      std::to_string(refined.Samples) + " points.");
    options->Output.Describe(refined.Pair);
    // Whoever finds the file must see that it is not the published one.
    auto& description = refined.Pair.Metadata["description"];
    description =
      (description.is_string() ? description.get<std::string>() + ". " : std::string()) +
      "Refined by dhm: its piecewise linear map is within " + ToText(options->Tolerance) +
      " of the " + SystemNames[options->Map.System] + " map of the original triangulation";
    WritePair(refined.Pair, options->Output.TargetArray, output);
    // PROJ 9.1 reads no larger ones.
    constexpr std::uintmax_t mostBytes = 10 * 1024 * 1024;
    if (output.GetFormat() == "json" &&
      std::filesystem::file_size(output.GetTemporaryName()) > mostBytes)
    {
      Warn("PROJ reads no triangulation files of more than 10 MiB, which this is: ask for a larger "
           "distance.");
    }
    output.Commit();
  });
}

void AddConvert(CLI::App& program)
{
  struct Options
  {
    InputFiles Inputs;
    PairOutput Output;
    std::string TargetOutput;
  };
  CLI::App* command = program.add_subcommand("convert", "Write a pair in another format");
  const auto options = std::make_shared<Options>();
  options->Inputs.AddTo(*command, "SOURCE [TARGET]", 0, "The pair");
  options->Output.AddTo(*command,
    "The pair: .json (PROJ's triangulation file), .vtp or .vtk with the target's positions as a "
    "point array; with --target-output the source alone: .vtp .vtk .obj .off");
  command
    ->add_option("--target-output", options->TargetOutput, "Write the target to a file of its own")
    ->type_name("FILE")
    ->group("Files");
  command
    ->add_option("--output-array", options->Output.TargetArray,
      "Name of the point array with the target's positions (default: Target)")
    ->type_name("NAME")
    ->group("Results");
  command->callback([options] {
    const OutputOptions& names = options->Output.Output;
    if (options->TargetOutput == names.Name)
    {
      throw Failure(
        WRONG_USAGE, "Source and target cannot both go to " + names.Name + " (--target-output).");
    }
    OutputFile output(names.Name, names.Format, names.Replace);
    std::unique_ptr<OutputFile> target;
    if (!options->TargetOutput.empty())
    {
      target = std::make_unique<OutputFile>(options->TargetOutput, names.Format, names.Replace);
    }
    MeshPair pair = options->Inputs.ReadPair(0);
    options->Output.Describe(pair);
    if (target)
    {
      WriteMesh(pair.Source(), output);
      WriteMesh(pair.Target(), *target);
      output.Commit();
      target->Commit();
      return;
    }
    if (output.GetFormat() == "json")
    {
      // Nobody else will look.
      RequireMap(pair);
    }
    else if (output.GetFormat() == "obj" || output.GetFormat() == "off")
    {
      throw Failure(WRONG_USAGE,
        "A ." + output.GetFormat() +
          " file cannot hold both meshes: name another for the target (--target-output).");
    }
    WritePair(pair, options->Output.TargetArray, output);
    output.Commit();
  });
}

} // namespace dhm
