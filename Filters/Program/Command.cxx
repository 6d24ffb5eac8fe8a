// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Command.h"

#include "Console.h"
#include "Failure.h"
#include "ImageWarp.h"
#include "Numbers.h"
#include "OutputFile.h"

#include "vtkAlgorithm.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace dhm
{

namespace
{

CLI::Validator NumberWhich(const std::string& expected, const std::function<bool(double)>& isRight)
{
  const auto check = [expected, isRight](const std::string& text) {
    const auto number = ToNumber(text);
    return number && std::isfinite(*number) && isRight(*number)
      ? std::string()
      : "expected " + expected + ", found \"" + text + "\"";
  };
  return CLI::Validator(check, "");
}

int ReadSystem(const std::string& name)
{
  for (int system = 0; system < 3; ++system)
  {
    if (CLI::detail::to_lower(SystemNames[system]) == CLI::detail::to_lower(name))
    {
      return system;
    }
  }
  throw CLI::ValidationError(
    "--system", "expected smooth, contour or linear, found \"" + name + "\"");
}

} // namespace

CLI::Validator PositiveNumber()
{
  return NumberWhich("a number greater than 0", [](double number) { return number > 0.0; });
}

CLI::Validator NonNegativeNumber()
{
  return NumberWhich("a number not less than 0", [](double number) { return number >= 0.0; });
}

CLI::Validator NumberFrom(double least, double largest)
{
  return NumberWhich("a number from " + ToText(least) + " to " + ToText(largest),
    [least, largest](double number) { return number >= least && number <= largest; });
}

const char* const SystemNames[3] = { "Linear", "Contour", "Smooth" };

void MapOptions::AddTo(CLI::App& command, bool canMask)
{
  command
    .add_option_function<std::string>(
      "-s,--system", [this](const std::string& name) { this->System = ReadSystem(name); },
      "Coordinate system: smooth (default; twice continuously differentiable except at the meshes' "
      "points), contour (the published construction) or linear (the piecewise linear map)")
    ->type_name("NAME")
    ->group("Map");
  command
    .add_flag("--incenter", this->Incenter,
      "Let Contour's contours start at the incenter, not the centroid")
    ->group("Map");
  command
    .add_flag("--linear-where-discordant", this->LinearWhereDiscordant,
      "Let Linear carry the triangles in which Contour does not exist, instead of refusing them")
    ->group("Map");
  if (canMask)
  {
    command
      .add_flag("--mask-invalid", this->MaskInvalid,
        "Leave invalid triangles out, as holes, instead of refusing the meshes")
      ->group("Map");
  }
  command
    .add_option("--tolerance", this->Tolerance,
      "How far outside a point may be and still be taken to the nearest point of the domain, as a "
      "proportion of the domain's diagonal (default: rounding only)")
    ->check(NonNegativeNumber())
    ->type_name("NUMBER")
    ->group("Map");
}

void InputFiles::AddTo(
  CLI::App& command, const std::string& names, int others, const std::string& description)
{
  this->Names = names;
  command.add_option("FILES", this->Files, description)
    ->expected(1 + others, 2 + others)
    ->required()
    ->type_name(names);
  command
    .add_option("--target-array", this->Pair.TargetArray,
      "Point array with the target's positions, where one mesh file has both (default: Target)")
    ->type_name("NAME")
    ->group("Files");
  command
    .add_option("--input-format", this->Pair.InputFormat,
      "What standard input (-) holds, as a file name's extension")
    ->type_name("EXTENSION")
    ->group("Files");
  command
    .add_option("--working-size", this->WorkingSize,
      "Of xmorph's meshes that do not fill their pictures: the size of its working picture "
      "(resulting_size in a session's file)")
    ->type_name("WIDTHxHEIGHT")
    ->group("Files");
}

MeshPair InputFiles::ReadPair(std::size_t others) const
{
  MeshPairOptions reading = this->Pair;
  reading.WorkingSize = ReadSize(this->WorkingSize);
  if (std::count(this->Files.begin(), this->Files.end(), "-") > 1)
  {
    throw Failure(WRONG_USAGE, "Only one of the files can come from standard input.");
  }
  const std::vector<std::string> files(
    this->Files.begin(), this->Files.end() - static_cast<std::ptrdiff_t>(others));
  try
  {
    return ReadMeshPair(files, reading);
  }
  catch (const Failure& failure)
  {
    if (failure.GetStatus() != WRONG_USAGE || others == 0)
    {
      throw;
    }
    // A file may be missing, or in the place of another.
    throw Failure(WRONG_USAGE,
      std::string(failure.what()) + " (The files are " + this->Names + ": " + this->Files.back() +
        " was taken for " + this->Names.substr(this->Names.rfind(' ') + 1) + ".)");
  }
}

void OutputOptions::AddTo(
  CLI::App& command, const std::string& description, const std::string& defaultFormat)
{
  this->Format = defaultFormat;
  command.add_option("-o,--output", this->Name, description)
    ->required()
    ->type_name("FILE")
    ->group("Files");
  command.add_flag("-f,--force", this->Replace, "Replace the output if it exists")->group("Files");
  command
    .add_option("--output-format", this->Format,
      "What to write to standard output (-), as a file name's extension (default: " +
        defaultFormat + ")")
    ->type_name("EXTENSION")
    ->group("Files");
}

void PictureOptions::AddTo(CLI::App& command, const std::string& sizeDescription)
{
  command.add_option("--size", this->Size, sizeDescription)
    ->type_name("WIDTHxHEIGHT")
    ->group("Results");
  command
    .add_option("--background", this->Background,
      "Color outside the domain: transparent (default, but white in .jpg and .ppm), white, black "
      "or #rrggbb")
    ->type_name("COLOUR")
    ->group("Results");
}

void Run(vtkAlgorithm* filter, const std::string& what, bool showWarnings)
{
  {
    ProgressBar bar(what);
    bar.Follow(filter);
    filter->Update();
  }
  const std::string errors = TakeErrors();
  if (!errors.empty())
  {
    throw Failure(REFUSED, NameOptions(errors));
  }
  const std::string warnings = TakeWarnings();
  if (!warnings.empty() && showWarnings)
  {
    Warn(NameOptions(warnings));
  }
}

std::string NameOptions(std::string message)
{
  const std::pair<const char*, const char*> names[] = { { "turn MaskInvalidTriangles on",
                                                          "use --mask-invalid" },
    { "MaskInvalidTriangles", "--mask-invalid" },
    { "DiscordantTriangles", "--linear-where-discordant" },
    { "Triangulate the source (vtkTriangleFilter)", "Triangulate the source" } };
  for (const auto& name : names)
  {
    const std::string setter = name.first;
    for (std::size_t at = message.find(setter); at != std::string::npos;
         at = message.find(setter, at))
    {
      message.replace(at, setter.size(), name.second);
      at += std::string(name.second).size();
    }
  }
  return message;
}

std::string Count(
  vtkIdType count, const std::string& what, const std::string& one, const std::string& several)
{
  return std::to_string(count) + " " + what + (count == 1 ? " " + one : "s " + several);
}

} // namespace dhm
