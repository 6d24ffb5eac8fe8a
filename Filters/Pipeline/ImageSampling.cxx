// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ImageSampling.h"

#include "vtkArrayDispatch.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace homeomorphism
{
namespace
{

/// Converts to the type of an array, to the nearest number if that is an integer type.
template <typename Value>
Value FromDouble(double value)
{
  if constexpr (std::is_integral<Value>::value)
  {
    // A mean of values is within the range of their type, but the largest integers of 64 bits are
    // rounded up to a double beyond it.
    constexpr Value largest = std::numeric_limits<Value>::max();
    const double rounded = value + (value < 0.0 ? -0.5 : 0.5);
    return rounded < static_cast<double>(largest) ? static_cast<Value>(rounded) : largest;
  }
  else
  {
    return static_cast<Value>(value);
  }
}

} // namespace

vtkSmartPointer<vtkDataArray> NewEmptyLike(vtkDataArray* array, vtkIdType tuples)
{
  auto result = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
  result->SetName(array->GetName());
  result->SetNumberOfComponents(array->GetNumberOfComponents());
  result->CopyComponentNames(array);
  result->SetNumberOfTuples(tuples);
  const bool real = array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
  result->Fill(real ? std::numeric_limits<double>::quiet_NaN() : 0.0);
  return result;
}

bool ImageSampling::CanSample(vtkImageData* image)
{
  const auto areSound = [](vtkDataSetAttributes* attributes, vtkIdType tuples) {
    if (attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()))
    {
      return false;
    }
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = attributes->GetArray(i);
      if (!array || !array->GetName() || array->GetNumberOfTuples() != tuples ||
        array->GetNumberOfComponents() < 1 || array->GetDataType() == VTK_BIT)
      {
        return false;
      }
    }
    return true;
  };
  const double* spacing = image->GetSpacing();
  return image->GetNumberOfPoints() > 0 &&
    std::all_of(spacing, spacing + 3, [](double s) { return s > 0.0 && std::isfinite(s); }) &&
    areSound(image->GetPointData(), image->GetNumberOfPoints()) &&
    areSound(image->GetCellData(), image->GetNumberOfCells());
}

ImageSampling::ImageSampling(vtkImageData* image, vtkDataSetAttributes* output, vtkIdType count)
{
  const auto add = [&](vtkDataSetAttributes* attributes, bool ofCells) {
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = attributes->GetArray(i);
      if (ofCells && output->GetArray(array->GetName()))
      {
        // A point array takes precedence over a cell array of the same name.
        continue;
      }
      const vtkSmartPointer<vtkDataArray> result = NewEmptyLike(array, count);
      const int index = output->AddArray(result);
      for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES && !ofCells; ++role)
      {
        if (attributes->GetAbstractAttribute(role) == array)
        {
          output->SetActiveAttribute(index, role);
        }
      }
      this->Arrays.push_back({ array, result, ofCells });
    }
  };
  add(image->GetPointData(), false);
  add(image->GetCellData(), true);

  std::copy_n(image->GetDimensions(), 3, this->Dimensions.begin());
  const int* extent = image->GetExtent();
  vtkMatrix4x4* matrix = image->GetPhysicalToIndexMatrix();
  double bounds[6];
  image->GetBounds(bounds);
  double largest = 0.0;
  for (const double bound : bounds)
  {
    largest = std::max(largest, std::abs(bound));
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    double scale = 0.0;
    for (int column = 0; column < 4; ++column)
    {
      this->ToIndex[4 * axis + column] = matrix->GetElement(axis, column);
      scale = std::max(scale, column < 3 ? std::abs(matrix->GetElement(axis, column)) : 0.0);
    }
    this->ToIndex[4 * axis + 3] -= extent[2 * axis];
    // A few rounding errors of the largest coordinate of the image.
    this->Tolerance[axis] =
      64.0 * std::numeric_limits<double>::epsilon() * (scale * largest + this->Dimensions[axis]);
    this->StencilSize *= this->Dimensions[axis] > 1 ? 2 : 1;
  }
}

bool ImageSampling::MakeStencil(const double point[3], Stencil& stencil) const
{
  std::array<vtkIdType, 3> lower;
  std::array<double, 3> fraction;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double* row = &this->ToIndex[4 * axis];
    const double index = row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
    const int last = this->Dimensions[axis] - 1;
    // Negated so that NaN is outside.
    if (!(index >= -this->Tolerance[axis] && index <= last + this->Tolerance[axis]))
    {
      return false;
    }
    const double inside = std::min(std::max(index, 0.0), static_cast<double>(last));
    lower[axis] =
      std::min(static_cast<vtkIdType>(inside), static_cast<vtkIdType>(std::max(0, last - 1)));
    fraction[axis] = inside - static_cast<double>(lower[axis]);
  }
  const vtkIdType rowStep = this->Dimensions[0];
  const vtkIdType sliceStep = rowStep * this->Dimensions[1];
  const vtkIdType first = lower[0] + lower[1] * rowStep + lower[2] * sliceStep;
  const std::array<vtkIdType, 3> steps{ 1, rowStep, sliceStep };
  stencil.Points[0] = first;
  stencil.Weights[0] = 1.0;
  int size = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->Dimensions[axis] == 1)
    {
      continue;
    }
    for (int i = 0; i < size; ++i)
    {
      stencil.Points[size + i] = stencil.Points[i] + steps[axis];
      stencil.Weights[size + i] = stencil.Weights[i] * fraction[axis];
      stencil.Weights[i] *= 1.0 - fraction[axis];
    }
    size *= 2;
  }
  const vtkIdType cellsInRow = std::max(1, this->Dimensions[0] - 1);
  const vtkIdType cellsInSlice = cellsInRow * std::max(1, this->Dimensions[1] - 1);
  stencil.Cell = lower[0] + lower[1] * cellsInRow + lower[2] * cellsInSlice;
  return true;
}

void ImageSampling::Sample(const double (*points)[3], const bool* wanted, int count,
  vtkIdType first, vtkUnsignedCharArray* mask) const
{
  std::array<Stencil, Capacity> stencils;
  int found = 0;
  for (int i = 0; i < count; ++i)
  {
    const bool isFound = wanted[i] && this->MakeStencil(points[i], stencils[found]);
    mask->SetValue(first + i, isFound ? 1 : 0);
    if (isFound)
    {
      stencils[found++].Tuple = first + i;
    }
  }
  const int size = this->StencilSize;
  for (const Pair& pair : this->Arrays)
  {
    const auto fill = [&](auto* from, auto* to) {
      using Value = vtk::GetAPIType<std::remove_pointer_t<decltype(to)>>;
      const auto values = vtk::DataArrayValueRange(from);
      auto results = vtk::DataArrayValueRange(to);
      const vtkIdType components = from->GetNumberOfComponents();
      for (int i = 0; i < found; ++i)
      {
        const Stencil& stencil = stencils[i];
        for (vtkIdType c = 0; c < components; ++c)
        {
          if (pair.OfCells)
          {
            results[stencil.Tuple * components + c] = values[stencil.Cell * components + c];
            continue;
          }
          double sum = 0.0;
          for (int k = 0; k < size; ++k)
          {
            // Skip zero weights, so that NaN values with zero weight do not affect the sum.
            if (stencil.Weights[k] != 0.0)
            {
              sum += stencil.Weights[k] *
                static_cast<double>(values[stencil.Points[k] * components + c]);
            }
          }
          results[stencil.Tuple * components + c] = FromDouble<Value>(sum);
        }
      }
    };
    if (!vtkArrayDispatch::Dispatch2SameValueType::Execute(pair.From, pair.To, fill))
    {
      fill(pair.From, pair.To);
    }
  }
}

} // namespace homeomorphism
