// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PointBlocks.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"
#include "vtkDataSet.h"
#include "vtkImageData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <limits>
#include <type_traits>

namespace homeomorphism
{

namespace
{

/// The number of doubles in a cache line.
constexpr int DoublesInLine = 64 / sizeof(double);

} // namespace

double PrecisionOfType(int dataType)
{
  return 0.5 *
    (dataType == VTK_FLOAT ? static_cast<double>(std::numeric_limits<float>::epsilon())
                           : std::numeric_limits<double>::epsilon());
}

double PrecisionOfPoints(vtkDataSet* data)
{
  auto* points = vtkPointSet::SafeDownCast(data);
  return PrecisionOfType(
    points && points->GetPoints() ? points->GetPoints()->GetDataType() : VTK_DOUBLE);
}

void ReadPoints(vtkDataArray* array, vtkIdType first, PointBlock& block)
{
  if (auto* doubles = vtkAOSDataArrayTemplate<double>::FastDownCast(array))
  {
    const double* values = doubles->GetPointer(3 * first);
    block.Points = reinterpret_cast<const double(*)[3]>(values);
    // Prefetch the next block, to hide memory latency.
    const vtkIdType end =
      std::min(6 * vtkIdType(block.Count), doubles->GetNumberOfValues() - 3 * first);
    for (vtkIdType i = 3 * vtkIdType(block.Count); i < end; i += DoublesInLine)
    {
      Prefetch(values + i);
    }
    return;
  }
  block.Points = block.PointBuffer;
  double* coordinates = &block.PointBuffer[0][0];
  const auto read = [first, coordinates, &block](auto* typed) {
    const auto values = vtk::DataArrayValueRange<3>(typed, 3 * first, 3 * (first + block.Count));
    std::transform(values.begin(), values.end(), coordinates,
      [](auto value) { return static_cast<double>(value); });
  };
  if (!vtkArrayDispatch::DispatchByValueType<vtkArrayDispatch::Reals>::Execute(array, read))
  {
    read(array);
  }
}

void ReadPoints(vtkDataSet* data, vtkIdType first, PointBlock& block)
{
  auto* pointSet = vtkPointSet::SafeDownCast(data);
  if (pointSet && pointSet->GetPoints())
  {
    ReadPoints(pointSet->GetPoints()->GetData(), first, block);
    return;
  }
  block.Points = block.PointBuffer;
  auto* image = vtkImageData::SafeDownCast(data);
  if (image && !HasPointArray(image))
  {
    // Equivalent to GetPoint, but finds each row only once.
    const int* extent = image->GetExtent();
    const int* dimensions = image->GetDimensions();
    const vtkIdType row = first / dimensions[0];
    int index[3] = { static_cast<int>(first % dimensions[0]), static_cast<int>(row % dimensions[1]),
      static_cast<int>(row / dimensions[1]) };
    for (int i = 0; i < block.Count; ++i)
    {
      image->TransformIndexToPhysicalPoint(
        extent[0] + index[0], extent[2] + index[1], extent[4] + index[2], block.PointBuffer[i]);
      if (++index[0] == dimensions[0])
      {
        index[0] = 0;
        if (++index[1] == dimensions[1])
        {
          index[1] = 0;
          ++index[2];
        }
      }
    }
    return;
  }
  for (int i = 0; i < block.Count; ++i)
  {
    data->GetPoint(first + i, block.PointBuffer[i]);
  }
}

void SetImages(vtkDataArray* array, vtkIdType first, vtkIdType end, PointBlock& block)
{
  auto* doubles = vtkAOSDataArrayTemplate<double>::FastDownCast(array);
  if (!doubles || first + PointBlock::Size > end)
  {
    block.Images = block.ImageBuffer;
    return;
  }
  double* values = doubles->GetPointer(3 * first);
  block.Images = reinterpret_cast<double(*)[3]>(values);
  for (int i = 0; i < 3 * block.Count; i += DoublesInLine)
  {
    PrefetchToWrite(values + i);
  }
}

void WritePoints(const double (*points)[3], int count, vtkIdType first, vtkDataArray* array)
{
  const double* coordinates = &points[0][0];
  if (auto* doubles = vtkAOSDataArrayTemplate<double>::FastDownCast(array))
  {
    double* values = doubles->GetPointer(3 * first);
    if (values != coordinates)
    {
      std::copy_n(coordinates, 3 * count, values);
    }
    return;
  }
  const auto write = [first, coordinates, count](auto* typed) {
    using Value = vtk::GetAPIType<std::remove_pointer_t<decltype(typed)>>;
    auto values = vtk::DataArrayValueRange<3>(typed, 3 * first, 3 * (first + count));
    std::transform(coordinates, coordinates + 3 * count, values.begin(),
      [](double value) { return static_cast<Value>(value); });
  };
  if (!vtkArrayDispatch::DispatchByValueType<vtkArrayDispatch::Reals>::Execute(array, write))
  {
    write(array);
  }
}

} // namespace homeomorphism
