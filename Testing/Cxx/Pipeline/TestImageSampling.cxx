// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/Triangles.h"

#include "Pipeline/ImageSampling.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace homeomorphism;
using homeomorphism_test::Random;

namespace
{

/// An image of a function of its points, of random floats and bytes, and of cell numbers.
template <typename Function>
void FillImage(vtkImageData* image, Function&& function)
{
  vtkNew<vtkDoubleArray> values;
  values->SetName("Value");
  vtkNew<vtkFloatArray> floats;
  floats->SetName("Float");
  vtkNew<vtkUnsignedCharArray> bytes;
  bytes->SetName("Byte");
  bytes->SetNumberOfComponents(3);
  Random random(42);
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    double point[3];
    image->GetPoint(i, point);
    values->InsertNextValue(function(point));
    floats->InsertNextValue(static_cast<float>(random.Uniform(-1.0, 1.0)));
    bytes->InsertNextTuple3(random.Below(256), random.Below(256), random.Below(256));
  }
  image->GetPointData()->AddArray(values);
  image->GetPointData()->AddArray(floats);
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

// A function that is linear in each direction is interpolated exactly, other data as by VTK's
// cells.
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
    const bool isSampled = wanted[i] && i != 1;
    EXPECT_EQ(mask->GetValue(i), isSampled ? 1 : 0);
    if (!isSampled)
    {
      EXPECT_TRUE(std::isnan(GetValue(output, "Value", i)));
      continue;
    }
    const double exact = function(points[i]);
    EXPECT_NEAR(GetValue(output, "Value", i), exact, 1e-13 * std::abs(exact));
    int subId;
    double parametric[3];
    double weights[8];
    const vtkIdType cell = image->FindCell(points[i], nullptr, -1, 0.0, subId, parametric, weights);
    EXPECT_EQ(GetValue(output, "Cell", i), static_cast<double>(cell));
    // As VTK's cells interpolate; integers are rounded to nearest.
    vtkNew<vtkIdList> ids;
    image->GetCellPoints(cell, ids);
    for (const auto& [name, rounding] :
      { std::pair<const char*, double>{ "Float", 1e-6 }, { "Byte", 0.5 + 1e-9 } })
    {
      vtkDataArray* corners = image->GetPointData()->GetArray(name);
      for (int c = 0; c < corners->GetNumberOfComponents(); ++c)
      {
        double expected = 0.0;
        for (vtkIdType k = 0; k < 8; ++k)
        {
          expected += weights[k] * corners->GetComponent(ids->GetId(k), c);
        }
        EXPECT_NEAR(output->GetArray(name)->GetComponent(i, c), expected, rounding) << name;
      }
    }
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
