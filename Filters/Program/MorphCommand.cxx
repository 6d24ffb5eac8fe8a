// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Command.h"
#include "Console.h"
#include "DataFile.h"
#include "Failure.h"
#include "ImageWarp.h"
#include "InBetween.h"
#include "InputFile.h"
#include "Numbers.h"
#include "OutputFile.h"
#include "PairReport.h"
#include "PointTable.h"

#include "vtkNew.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <regex>

namespace dhm
{
namespace
{

/// A name in which %d, or %03d and the like, stands for a number.
class FrameNames
{
public:
  explicit FrameNames(const std::string& pattern)
  {
    static const std::regex place("%0?([1-9]?)d");
    std::smatch found;
    if (!std::regex_search(pattern, found, place))
    {
      throw Failure(WRONG_USAGE,
        "The output's name must have a place for the frame's number, such as frame-%03d.png.");
    }
    this->Before = found.prefix();
    this->After = found.suffix();
    if (std::regex_search(this->After, place))
    {
      throw Failure(WRONG_USAGE,
        "The output's name has more than one place for the frame's number: " + pattern + ".");
    }
    this->Width = found[1].length() > 0 ? static_cast<std::size_t>(found[1].str()[0] - '0') : 1;
  }

  std::string Get(int frame) const
  {
    const std::string number = std::to_string(frame);
    const std::size_t missing = this->Width > number.size() ? this->Width - number.size() : 0;
    return this->Before + std::string(missing, '0') + number + this->After;
  }

private:
  std::string Before;
  std::string After;
  std::size_t Width;
};

struct Options
{
  InputFiles Inputs;
  MapOptions Map;
  std::string Output;
  bool Replace = false;
  std::string SourceImage;
  std::string TargetImage;
  std::string Data;
  int Frames = 11;
  PictureOptions Picture;
};

/// Refuses frames whose meshes are folded, and says at which times others would be.
void CheckFolds(const MeshPair& pair, int frames)
{
  const Folds folds = FindFolds(pair.Source(), pair.Target());
  if (folds.Mirrored)
  {
    throw Failure(REFUSED,
      "The target is a mirror image of the source: all triangles would be turned over on the way.");
  }
  if (folds.Triangles == 0)
  {
    return;
  }
  const std::string where = Count(folds.Triangles, "triangle", "is", "are") +
    " turned over on the way (the first to be so is cell " + std::to_string(folds.FirstCell) +
    ", from " + ToText(folds.Begin) + " on; the last ends at " + ToText(folds.End) + ")";
  for (int frame = 0; frame < frames; ++frame)
  {
    const double t = static_cast<double>(frame) / (frames - 1);
    if (t > 0.0 && t < 1.0 && IsFolded(pair.Source(), pair.Target(), t))
    {
      throw Failure(REFUSED,
        where + ", frame " + std::to_string(frame) + " (at " + ToText(t) +
          ") among them: points must move so that no triangle is turned over. Put a mesh in "
          "between and morph in two steps.");
    }
  }
  Warn(where + ", but at none of the frames.");
}

void Morph(const Options& options)
{
  const FrameNames names(options.Output);
  const std::string format = FormatOf(options.Output);
  const bool images = !options.SourceImage.empty() || !options.TargetImage.empty();
  if (images && !options.Data.empty())
  {
    throw Failure(WRONG_USAGE, "Morph either images or data (--data), not both.");
  }
  const Background background =
    images ? ReadBackgroundFor(format, options.Picture.Background) : Background();
  if (!images)
  {
    CheckOutputFormat(format);
  }
  if (!images && IsPicture(format))
  {
    throw Failure(WRONG_USAGE,
      "Meshes and data on their way are no pictures (." + format +
        "): give images (--source-image, --target-image), or write .vtp.");
  }
  if (PointTable::IsFormat(FormatOf(options.Data)))
  {
    throw Failure(WRONG_USAGE,
      options.Data +
        " is a point table, which has to become a .vtp before it is morphed: dhm coordinates "
        "SOURCE " +
        options.Data + " -o points.vtp makes one of it.");
  }
  if (!options.Replace)
  {
    // None is written if not all can be.
    for (int frame = 0; frame < options.Frames; ++frame)
    {
      if (std::filesystem::exists(names.Get(frame)))
      {
        throw Failure(
          FILE_TROUBLE, names.Get(frame) + " exists. Use --force to replace such frames.");
      }
    }
  }
  MeshPair pair = options.Inputs.ReadPair(0);
  std::array<vtkSmartPointer<vtkImageData>, 2> pictures;
  const std::string* const pictureNames[2] = { &options.SourceImage, &options.TargetImage };
  for (int side = 0; side < 2; ++side)
  {
    if (!pictureNames[side]->empty())
    {
      pictures[side] = ReadImage(InputFile(*pictureNames[side], "png"));
    }
  }
  vtkSmartPointer<vtkImageData> grid;
  if (images)
  {
    grid = MakeGrid(pictures[0] ? pictures[0] : pictures[1], ReadSize(options.Picture.Size));
    std::array<int, 2> sizes[2];
    for (int side = 0; side < 2; ++side)
    {
      const int* dimensions = (pictures[side] ? pictures[side] : grid)->GetDimensions();
      sizes[side] = { dimensions[0], dimensions[1] };
    }
    FitToPictures(pair, sizes[0], sizes[1]);
    for (std::size_t side = 0; side < 2; ++side)
    {
      if (pictures[side])
      {
        RequireOverlap(
          pictures[side], *pictureNames[side], pair.Meshes[side], pair.GetNameOf(side));
      }
    }
  }
  vtkSmartPointer<vtkDataObject> data = pair.Source();
  if (!options.Data.empty())
  {
    data = ReadData(InputFile(options.Data, "vtp"));
  }
  RequireMap(pair, options.Map);
  WorkWith(pair, [&] { CheckFolds(pair, options.Frames); });

  ProgressBar bar("Morphing", options.Frames);
  for (int frame = 0; frame < options.Frames; ++frame)
  {
    const double t = static_cast<double>(frame) / (options.Frames - 1);
    const auto between = InBetween(pair.Source(), pair.Target(), t);
    OutputFile output(names.Get(frame), "", options.Replace);
    if (images)
    {
      std::array<vtkSmartPointer<vtkImageData>, 2> warped;
      for (int side = 0; side < 2; ++side)
      {
        if (pictures[side])
        {
          warped[side] =
            WarpImage(pictures[side], pair.Meshes[side], between, grid, false, options.Map, "");
        }
      }
      const auto picture = warped[0] && warped[1] ? Blend(warped[0], warped[1], t)
        : warped[0]                               ? warped[0]
                                                  : warped[1];
      WriteData(Finish(picture, background), output);
    }
    else
    {
      vtkNew<vtkDifferentiableHomeomorphism> map;
      options.Map.ApplyTo(map.Get());
      map->SetSourceData(pair.Source());
      map->SetTargetData(between);
      map->SetDataObject(data);
      Run(map, "");
      WriteData(map->GetOutputDataObject(0), output);
    }
    output.Commit();
    bar.Advance();
  }
}

} // namespace

void AddMorph(CLI::App& program)
{
  CLI::App* command = program.add_subcommand("morph",
    "Make the frames in between: images or data on their way from the source to the target");
  const auto options = std::make_shared<Options>();
  options->Inputs.AddTo(*command, "SOURCE [TARGET]", 0, "The pair, as for dhm warp");
  command
    ->add_option("-o,--output", options->Output,
      "Name of the frames, with %d or %03d for the number: frame-%03d.png")
    ->required()
    ->type_name("FILES")
    ->group("Files");
  command->add_flag("-f,--force", options->Replace, "Replace the output if it exists")
    ->group("Files");
  command->add_option("--source-image", options->SourceImage, "Image over the source")
    ->type_name("FILE")
    ->group("Files");
  command
    ->add_option("--target-image", options->TargetImage,
      "Image over the target; with both, one fades into the other")
    ->type_name("FILE")
    ->group("Files");
  command
    ->add_option(
      "--data", options->Data, "Data over the source, instead of images (default: the source mesh)")
    ->type_name("FILE")
    ->group("Files");
  command
    ->add_option("-n,--frames", options->Frames,
      "Number of frames, the first and the last included (default: 11)")
    ->check(NumberFrom(2, 100000))
    ->type_name("NUMBER")
    ->group("Results");
  options->Picture.AddTo(*command, "Size of the frames in pixels (default: the source image's)");
  options->Map.AddTo(*command);
  command->footer("In frame t, from 0 to 1, each point of the meshes has gone the proportion t of "
                  "its way along a straight line. If a triangle would be turned over in a frame, "
                  "nothing is written (status 1).");
  command->callback([options] { Morph(*options); });
}

} // namespace dhm
