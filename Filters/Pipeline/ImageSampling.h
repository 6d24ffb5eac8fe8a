// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ImageSampling.h
/// What an image has at points that are not its own.

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

/// Array of the same type and name with @a tuples tuples, all NaN or 0.
vtkSmartPointer<vtkDataArray> NewEmptyLike(vtkDataArray* array, vtkIdType tuples);

/// Fills arrays with the values of an image: of its point arrays interpolated linearly in each
/// direction (rounded to the nearest number in arrays of integers), of its cell arrays those of the
/// cell that a point is in. A point outside by rounding counts as on the border. Different ranges
/// may be sampled in parallel.
class ImageSampling
{
public:
  /// How many points are dealt with at a time.
  static constexpr int Capacity = 256;

  /// Whether the image has a value everywhere: nothing is hidden, and all arrays are of numbers and
  /// have names and the right size.
  static bool CanSample(vtkImageData* image);

  /// Adds an array for each of the image's to @a output, NaN or 0, in the same roles.
  ImageSampling(vtkImageData* image, vtkDataSetAttributes* output, vtkIdType count);

  /// Sets tuples @a first to @a first + @a count of the arrays, at most Capacity, from what the
  /// image has at
  /// @a points where @a wanted says so and there is something; @a mask tells where.
  void Sample(const double (*points)[3], const bool* wanted, int count, vtkIdType first,
    vtkUnsignedCharArray* mask) const;

private:
  /// The image's points around a place, with weights, and the cell that it is in.
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
  /// Number of points of a stencil: 2 for each direction in which there is more than one.
  int StencilSize = 1;
};

} // namespace homeomorphism

#endif
