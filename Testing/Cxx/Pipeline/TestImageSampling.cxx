// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/Triangles.h"

#include "Pipeline/ImageSampling.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace homeomorphism;
using homeomorphism_test::Random;

namespace
{

/// An image of a function of its points as doubles and, rounded, as bytes, and cell numbers.
template <typename Function>
void FillImage(vtkImageData* image, Function&& function)
{
  vtkNew<vtkDoubleArray> values;
  values->SetName("Value");
  vtkNew<vtkUnsignedCharArray> bytes;
  bytes->SetName("Byte");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    double point[3];
    image->GetPoint(i, point);
    values->InsertNextValue(function(point));
    bytes->InsertNextValue(
      static_cast<unsigned char>(std::clamp(std::lround(function(point)), 0L, 255L)));
  }
  image->GetPointData()->AddArray(values);
  image->GetPointData()->AddArray(bytes);
  vtkNew<vtkDoubleArray> cells;
  cells->SetName("Cell");
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    cells->InsertNextValue(static_cast<double>(i));
  }
  image->GetCellData()->AddArray(cells);
}

double GetValue(vtkPointData* data, const char* name, vtkIdType i)
{
  return data->GetArray(name)->GetTuple1(i);
}

} // namespace

// A function that is linear in each direction is interpolated exactly, integers are rounded to
// nearest, and cells are those of VTK.
TEST(ImageSampling, InterpolatesLinearly)
{
  vtkNew<vtkImageData> image;
  image->SetExtent(2, 9, -3, 4, 0, 5);
  image->SetOrigin(0.5, -1.0, 2.0);
  image->SetSpacing(0.25, 0.5, 2.0);
  const auto function = [](const double p[3]) {
    return 100.0 + 3.0 * p[0] - 2.0 * p[1] + p[2] + 0.5 * p[0] * p[1];
  };
  FillImage(image, function);
  ASSERT_TRUE(ImageSampling::CanSample(image));

  constexpr int count = ImageSampling::Capacity;
  vtkNew<vtkPointData> output;
  const ImageSampling sampling(image, output, count);
  Random random(41);
  double bounds[6];
  image->GetBounds(bounds);
  double points[count][3];
  bool wanted[count];
  for (int i = 0; i < count; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      points[i][axis] = random.Uniform(bounds[2 * axis], bounds[2 * axis + 1]);
    }
    wanted[i] = i % 5 != 0;
  }
  points[1][0] = bounds[1] + 1.0;
  vtkNew<vtkUnsignedCharArray> mask;
  mask->SetNumberOfTuples(count);
  mask->FillValue(0);
  sampling.Sample(points, wanted, count, 0, mask);
  for (int i = 0; i < count; ++i)
  {
    const bool expected = wanted[i] && i != 1;
    EXPECT_EQ(mask->GetValue(i), expected ? 1 : 0);
    if (!expected)
    {
      EXPECT_TRUE(std::isnan(GetValue(output, "Value", i)));
      continue;
    }
    const double exact = function(points[i]);
    EXPECT_NEAR(GetValue(output, "Value", i), exact, 1e-13 * std::abs(exact));
    EXPECT_LE(std::abs(GetValue(output, "Byte", i) - exact), 1.0);
    int subId;
    double parametric[3];
    double weights[8];
    EXPECT_EQ(GetValue(output, "Cell", i),
      static_cast<double>(
        image->FindCell(points[i], nullptr, -1, 0.0, subId, parametric, weights)));
  }
}

TEST(ImageSampling, RefusesUnnamedArrays)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 1);
  FillImage(image, [](const double*) { return 1.0; });
  EXPECT_TRUE(ImageSampling::CanSample(image));
  image->GetPointData()->GetArray(0)->SetName(nullptr);
  EXPECT_FALSE(ImageSampling::CanSample(image));
}
