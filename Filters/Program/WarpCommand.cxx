// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Command.h"
#include "DataFile.h"
#include "ImageWarp.h"
#include "InputFile.h"
#include "OutputFile.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace dhm
{

void AddWarp(CLI::App& program)
{
  struct Options
  {
    InputFiles Inputs;
    OutputOptions Output;
    MapOptions Map;
    std::string ImageFormat = "png";
    PictureOptions Picture;
    bool Inverse = false;
  };
  CLI::App* command =
    program.add_subcommand("warp", "Warp an image from the source's domain to the target's");
  const auto options = std::make_shared<Options>();
  options->Inputs.AddTo(*command, "SOURCE [TARGET] IMAGE", 1,
    "The pair, in pixels of the image (the first pixel's center, at the lower left, is (0, 0), y "
    "runs upwards) or, for xmorph's meshes, in their own units; and a .png .jpg .tif .ppm or .vti");
  options->Output.AddTo(
    *command, "The warped image: .png .jpg .tif .ppm .vti, or - for standard output", "png");
  command
    ->add_option("--image-format", options->ImageFormat,
      "What the image is if it comes from standard input, as an extension (default: png)")
    ->type_name("EXTENSION")
    ->group("Files");
  options->Map.AddTo(*command);
  command->add_flag("-i,--inverse", options->Inverse, "From the target's domain to the source's")
    ->group("Map");
  options->Picture.AddTo(*command, "Size of the result in pixels (default: the image's)");
  command->footer("Pixels are interpolated linearly. Each pixel of the result is looked up where "
                  "the exact inverse says.");
  command->callback([options] {
    const std::array<int, 2> size = ReadSize(options->Picture.Size);
    const std::string format = OutputFormatOf(options->Output.Name, options->Output.Format);
    const Background background = ReadBackgroundFor(format, options->Picture.Background);
    OutputFile output(options->Output.Name, options->Output.Format, options->Output.Replace);
    MeshPair pair = options->Inputs.ReadPair(1);
    const InputFile file(options->Inputs.Files.back(), options->ImageFormat);
    const auto image = ReadFrom(file, "--image-format", [&file] { return ReadImage(file); });
    const auto grid = MakeGrid(image, size);
    const int* from = image->GetDimensions();
    const int* to = grid->GetDimensions();
    const std::array<int, 2> sizes[2] = { { from[0], from[1] }, { to[0], to[1] } };
    FitToPictures(pair, sizes[options->Inverse], sizes[!options->Inverse]);
    const std::size_t side = options->Inverse ? 1 : 0;
    RequireOverlap(image, file.GetName(), pair.Meshes[side], pair.GetNameOf(side));
    RequireOverlap(grid, "the result", pair.Meshes[1 - side], pair.GetNameOf(1 - side));
    const auto warped = WorkWith(pair, [&] {
      return WarpImage(
        image, pair.Source(), pair.Target(), grid, options->Inverse, options->Map, "Warping");
    });
    WriteData(Finish(warped, background), output);
    output.Commit();
  });
}

} // namespace dhm
