// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TestHomeomorphismAlgorithm.cxx
/// Common properties of the filters: meshes shared by threads, and the warnings about blocks
/// without points and about points slightly off a surface.

#include "Fixtures/FilterRuns.h"

#include "vtkResampleThroughHomeomorphism.h"

#include <regex>
#include <thread>

namespace
{

using namespace fixtures;

TEST(HomeomorphismAlgorithm, ThreadsShareMeshes)
{
  const MeshPair pair = MakePlanarPair(12, 71);
  const Point point{ 5.3, 4.6, 0.0 };
  const auto reference = MakeTransform(Smooth, pair);
  const Point expected = Transformed(reference, point);
  // Each thread has a transform of its own, a copy of one that has been updated, and filters on
  // shallow copies of the meshes.
  const auto work = [&] {
    EXPECT_EQ(Transformed(MakeTransform(Smooth, pair), point), expected);
    vtkNew<vtkHomeomorphismTransform> transform;
    transform->DeepCopy(reference);
    EXPECT_EQ(Transformed(transform, point), expected);
    const MeshPair shallow{ vtkSmartPointer<vtkPolyData>::New(),
      vtkSmartPointer<vtkPolyData>::New() };
    shallow.Source->ShallowCopy(pair.Source);
    shallow.Target->ShallowCopy(pair.Target);
    const auto filter = MakeFilter(Smooth, shallow, MakeCloud({ point }));
    EXPECT_EQ(PointOf(Output(filter), 0), expected);
    const auto resample = MakeAlgorithm<vtkResampleThroughHomeomorphism>(shallow);
    resample->SetSamplingDimensions(8, 8);
    resample->Update();
    MakeCoordinates(Smooth, shallow.Source)->Update();
  };
  for (int repetition = 0; repetition < 8; ++repetition)
  {
    std::array<std::thread, 4> threads;
    std::generate(threads.begin(), threads.end(), [&work] { return std::thread(work); });
    std::for_each(threads.begin(), threads.end(), [](std::thread& thread) { thread.join(); });
  }
}

TEST(HomeomorphismAlgorithm, BlocksWithoutPointsAreLeftOut)
{
  const MeshPair pair = MakePlanarPair(4, 74);
  vtkNew<vtkTable> table;
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, pair.Source);
  blocks->SetBlock(1, table);
  const auto filter = MakeFilter(Smooth, pair, blocks);
  Messages messages(filter);
  filter->Update();
  EXPECT_FALSE(messages.HasError()) << messages.Error();
  EXPECT_TRUE(messages.HasWarning());
  EXPECT_EQ(filter->GetErrorCode(), 0u);
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_NE(output->GetBlock(0), nullptr);
  EXPECT_EQ(output->GetBlock(1), nullptr);
}

TEST(HomeomorphismAlgorithm, PointsThatMissASurfaceAreExplained)
{
  // Points of a curved surface, rounded to four decimals.
  const MeshPair pair = MakeClosedPair(3, 76);
  std::vector<Point> points;
  for (const Triangle& triangle : TrianglesOf(pair.Source))
  {
    points.push_back(PointIn(pair.Source, triangle, { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 }));
    for (double& coordinate : points.back())
    {
      coordinate = std::round(1e4 * coordinate) / 1e4;
    }
  }
  // The least tolerance, relative to the diagonal.
  const double least = LargestDistanceFrom(pair.Source, points) / pair.Source->GetLength();
  const auto filter = MakeFilter(Smooth, pair, MakeCloud(points));
  for (const double factor : { 0.0, 0.8, 1.1 })
  {
    filter->SetTolerance(factor * least);
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(filter->GetNumberOfOutsidePoints() > 0, factor < 1.0);
    EXPECT_EQ(messages.HasWarning(), factor < 1.0);
    if (factor == 0.0)
    {
      // A number of the warning is that tolerance, rounded up.
      const std::string words = messages.Warning();
      const std::regex number("[0-9][0-9.]*e-[0-9]+");
      EXPECT_TRUE(std::any_of(std::sregex_iterator(words.begin(), words.end(), number), {},
        [least](const std::smatch& match) {
          const double tolerance = std::stod(match.str());
          return tolerance >= least && tolerance <= 1.12 * least;
        }))
        << words;
    }
  }
}

} // namespace
