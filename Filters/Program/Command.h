// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Command.h
/// The subcommands, and the options that several of them have.

#ifndef dhm_Command_h
#define dhm_Command_h

#include "MeshPair.h"

#include "vtkDifferentiableHomeomorphism.h"

#include <string>
#include <vector>

class vtkAlgorithm;

namespace CLI
{
class App;
class Validator;
}

namespace dhm
{

/// @name The subcommands
/// Each adds itself to the program. When it is called on, it does its work, and throws Failure if
/// it cannot.
///@{
void AddCheck(CLI::App& program);
void AddMap(CLI::App& program);
void AddCoordinates(CLI::App& program);
void AddWarp(CLI::App& program);
void AddMorph(CLI::App& program);
void AddFigure(CLI::App& program);
void AddRefine(CLI::App& program);
void AddConvert(CLI::App& program);
///@}

/// The names of the coordinate systems, by their numbers in VTK's classes.
extern const char* const SystemNames[3];

/// How the map is made from the meshes.
struct MapOptions
{
  int System = vtkDifferentiableHomeomorphism::SMOOTH;
  bool Incenter = false;
  bool LinearWhereDiscordant = false;
  bool MaskInvalid = false;
  double Tolerance = 0.0;

  /// Adds `--system` and the like; `--mask-invalid` only if invalid triangles can be left out.
  void AddTo(CLI::App& command, bool canMask = true);

  /// Sets them in a filter or transform of the module.
  template <typename Filter>
  void ApplyTo(Filter* filter) const
  {
    filter->SetCoordinateSystem(this->System);
    filter->SetCenterPoint(this->Incenter ? Filter::INCENTER : Filter::CENTROID);
    filter->SetDiscordantTriangles(
      this->LinearWhereDiscordant ? Filter::USE_LINEAR : Filter::REFUSE);
    filter->SetMaskInvalidTriangles(this->MaskInvalid);
    filter->SetTolerance(this->Tolerance);
  }
};

/// The files that a command reads: one or two of a pair of meshes, then others. Which is which
/// follows from their number.
struct InputFiles
{
  std::vector<std::string> Files;
  MeshPairOptions Pair;
  std::string WorkingSize;
  /// What the files are called in texts.
  std::string Names;

  /// Adds the positional arguments, called @a names in texts, and the options for reading them.
  void AddTo(
    CLI::App& command, const std::string& names, int others, const std::string& description);

  /// The pair, if the last @a others files are not its.
  MeshPair ReadPair(std::size_t others) const;
};

/// Where the result goes.
struct OutputOptions
{
  std::string Name;
  std::string Format;
  bool Replace = false;

  /// Adds `--output`, `--force`, and for standard output `--output-format` with a default.
  void AddTo(CLI::App& command, const std::string& description, const std::string& defaultFormat);
};

/// What a warped image is to be like.
struct PictureOptions
{
  /// See ReadSize and ReadBackground.
  std::string Size;
  std::string Background;

  /// Adds `--size`, which @a sizeDescription describes, and `--background`.
  void AddTo(CLI::App& command, const std::string& sizeDescription);
};

/// Runs a filter with a progress bar. Throws Failure with its errors; shows its warnings, if
/// wanted.
void Run(vtkAlgorithm* filter, const std::string& what, bool showWarnings = true);

/// @name Checks of numbers on the command line
/// What is no finite number in the range is wrong usage. (CLI11's own take nan for one.)
///@{
CLI::Validator PositiveNumber();
CLI::Validator NonNegativeNumber();
CLI::Validator NumberFrom(double least, double largest);
///@}

/// A message of the module's classes, with the program's options in the place of their setters.
std::string NameOptions(std::string message);

/// "1 point is", "2 points are".
std::string Count(
  vtkIdType count, const std::string& what, const std::string& one, const std::string& several);

} // namespace dhm

#endif
