// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/FilterRuns.h"

#include "Pipeline/ImageSampling.h"

#include "vtkProbeFilter.h"
#include "vtkShortArray.h"

using namespace homeomorphism;
using namespace fixtures;

// A function that is linear in each direction is interpolated exactly, other data as by VTK.
TEST(ImageSampling, InterpolatesLinearly)
{
  const auto image = MakeImage({ 2, 9, -3, 4, 0, 5 }, { 0.5, -1.0, 2.0 }, { 0.25, 0.5, 2.0 });
  const auto function = [](const Point& p) {
    return 100.0 + 3.0 * p[0] - 2.0 * p[1] + p[2] + 0.5 * p[0] * p[1];
  };
  const vtkIdType size = image->GetNumberOfPoints();
  image->GetPointData()->AddArray(ValuesAt(image, "Value", function));
  image->GetPointData()->AddArray(RandomArray<vtkFloatArray>("Float", 1, size, 43));
  image->GetPointData()->AddArray(RandomArray<vtkShortArray>("Integer", 3, size, 44));
  image->GetCellData()->AddArray(RandomArray("Cell", 1, image->GetNumberOfCells(), 45));
  ASSERT_TRUE(ImageSampling::CanSample(image));

  constexpr int count = ImageSampling::Capacity;
  vtkNew<vtkPointData> output;
  const ImageSampling sampling(image, output, count);
  Random random(41);
  const double* bounds = image->GetBounds();
  double points[count][3];
  bool wanted[count];
  std::vector<Point> positions;
  for (int i = 0; i < count; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      points[i][axis] = random.Uniform(bounds[2 * axis], bounds[2 * axis + 1]);
    }
    points[i][0] += i == 1 ? bounds[1] : 0.0;
    positions.push_back({ points[i][0], points[i][1], points[i][2] });
    wanted[i] = i % 5 != 0;
  }
  const auto mask = MakeGhosts(count, {}, 0);
  sampling.Sample(points, wanted, count, 0, mask);
  vtkNew<vtkProbeFilter> probe;
  probe->SetInputData(MakeCloud(positions));
  probe->SetSourceData(image);
  probe->Update();
  for (int i = 0; i < count; ++i)
  {
    const bool isSampled = wanted[i] && i != 1;
    const double value = output->GetArray("Value")->GetComponent(i, 0);
    EXPECT_EQ(mask->GetValue(i), isSampled ? 1 : 0);
    EXPECT_NE(std::isnan(value), isSampled);
    if (isSampled)
    {
      const double exact = function(positions[static_cast<std::size_t>(i)]);
      EXPECT_NEAR(value, exact, 1e-13 * std::abs(exact));
      for (const char* name : { "Float", "Integer", "Cell" })
      {
        const Point expected = VectorOf(PointArray(probe->GetOutput(), name), i);
        EXPECT_LT(Distance(VectorOf(output->GetArray(name), i), expected), 1e-5) << name;
      }
    }
  }
}

TEST(ImageSampling, RefusesUnnamedArrays)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 1);
  image->GetPointData()->AddArray(RandomArray("Value", 1, 9, 46));
  EXPECT_TRUE(ImageSampling::CanSample(image));
  image->GetPointData()->GetArray(0)->SetName(nullptr);
  EXPECT_FALSE(ImageSampling::CanSample(image));
}
