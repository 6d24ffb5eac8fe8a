// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ImageWarp.h
/// Images through the map, and what becomes of the pixels that have no place in the domain.

#ifndef dhm_ImageWarp_h
#define dhm_ImageWarp_h

#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <optional>
#include <string>

class vtkDataArray;
class vtkPolyData;

namespace dhm
{

struct MapOptions;

/// The brightest, or the fully opaque, value of pixels of this type.
double Brightest(vtkDataArray* pixels);

/// What pixels outside the domain get: a color, red, green and blue from 0 to 1, or none, which is
/// transparent.
using Background = std::optional<std::array<double, 3>>;

/// Understands "transparent", "white", "black" and "#rrggbb". Throws Failure.
Background ReadBackground(const std::string& text);

/// The background of an image in a file of this format; white or transparent, as it can be, for an
/// empty text. Throws Failure if the format is none of images, or cannot be transparent.
Background ReadBackgroundFor(const std::string& format, const std::string& text);

/// Understands WIDTHxHEIGHT, both from 1 to 100000; two zeros for an empty text. Throws Failure.
std::array<int, 2> ReadSize(const std::string& text);

/// A grid of pixels like @a image's, or of another size if that is not zero.
vtkSmartPointer<vtkImageData> MakeGrid(vtkImageData* image, const std::array<int, 2>& size);

/// Throws Failure, naming both boxes, if no pixel of an image is over the mesh's box; warns if
/// hardly any is. The names are for the message.
void RequireOverlap(vtkImageData* image, const std::string& imageName, vtkPolyData* mesh,
  const std::string& meshName);

/// The image over the source's domain, seen on a grid over the target's (the other way round if @a
/// inverse); its point data are the image's pixels and `vtkValidPointMask`. Throws Failure.
vtkSmartPointer<vtkImageData> WarpImage(vtkImageData* image, vtkPolyData* source,
  vtkPolyData* target, vtkImageData* grid, bool inverse, const MapOptions& map,
  const std::string& what);

/// Of two warped images on the same grid: (1 - t) times the first and t times the second, where
/// both have values. Throws Failure if they are not of the same kind.
vtkSmartPointer<vtkImageData> Blend(vtkImageData* first, vtkImageData* second, double t);

/// Only the pixels, as a picture file takes them: those that `vtkValidPointMask` leaves out get the
/// background, or are transparent in an alpha component that is added if there is none.
vtkSmartPointer<vtkImageData> Finish(vtkImageData* warped, const Background& background);

} // namespace dhm

#endif
