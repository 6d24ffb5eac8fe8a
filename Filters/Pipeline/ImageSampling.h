// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ImageSampling.h
/// Interpolation of image data at arbitrary points.

#ifndef homeomorphism_ImageSampling_h
#define homeomorphism_ImageSampling_h

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <array>
#include <vector>

class vtkDataArray;
class vtkDataSetAttributes;
class vtkImageData;
class vtkUnsignedCharArray;

namespace homeomorphism
{

/// An array of the same type and name with @a tuples tuples, all NaN or 0.
vtkSmartPointer<vtkDataArray> NewEmptyLike(vtkDataArray* array, vtkIdType tuples);

/// Fills arrays with the values of an image. Point arrays are interpolated linearly in each
/// direction (rounded to the nearest integer in integer arrays); cell arrays have the value of the
/// cell that contains the point. A point that is outside only by rounding is moved to the border.
/// Different ranges may be sampled in parallel.
class ImageSampling
{
public:
  /// The number of points processed at a time.
  static constexpr int Capacity = 256;

  /// Whether the image has a value everywhere: no element is hidden, and all arrays are numeric,
  /// named and of the correct size.
  static bool CanSample(vtkImageData* image);

  /// Adds an array of @a count tuples of NaN or 0 to @a output for each array of the image, with
  /// the same role as active attribute.
  ImageSampling(vtkImageData* image, vtkDataSetAttributes* output, vtkIdType count);

  /// Sets tuples @a first to @a first + @a count - 1 of the arrays, at most Capacity, to the
  /// values of the image at those @a points that are @a wanted and inside it. @a mask marks these
  /// points.
  void Sample(const double (*points)[3], const bool* wanted, int count, vtkIdType first,
    vtkUnsignedCharArray* mask) const;

private:
  /// The points of the image around a position with their weights, and the cell that contains it.
  struct Stencil
  {
    vtkIdType Tuple;
    std::array<vtkIdType, 8> Points;
    std::array<double, 8> Weights;
    vtkIdType Cell;
  };

  struct Pair
  {
    vtkDataArray* From;
    vtkDataArray* To;
    bool OfCells;
  };

  bool MakeStencil(const double point[3], Stencil& stencil) const;

  std::vector<Pair> Arrays;
  std::array<double, 12> ToIndex;
  std::array<int, 3> Dimensions;
  std::array<double, 3> Tolerance;
  /// Number of points of a stencil: 2 for each direction with more than one point.
  int StencilSize = 1;
};

} // namespace homeomorphism

#endif
