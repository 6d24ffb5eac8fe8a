// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// An aborted filter stops within a second, and its output is valid and marked as
// incomplete.

#include "Fixtures/FilterRuns.h"

#include "vtkImageData.h"
#include "vtkJacobianContinuity.h"
#include "vtkResampleThroughHomeomorphism.h"
#include "vtkTriangularCoordinates.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>

namespace
{

using namespace fixtures;
using Clock = std::chrono::steady_clock;

/// Requests an abort when the progress of an algorithm exceeds a limit.
class Impatience
{
public:
  Impatience(vtkAlgorithm* algorithm, double progress)
    : Algorithm(algorithm)
    , Progress(progress)
    , Tag(algorithm->AddObserver(vtkCommand::ProgressEvent, this, &Impatience::Look))
  {
  }
  ~Impatience()
  {
    this->Algorithm->RemoveObserver(this->Tag);
    this->Algorithm->AbortExecuteOff();
  }
  Impatience(const Impatience&) = delete;
  void operator=(const Impatience&) = delete;

  bool HasAsked() const { return this->Asked; }
  /// Seconds since the request.
  double GetWait() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Time).count();
  }

private:
  void Look()
  {
    if (!this->Asked && this->Algorithm->GetProgress() >= this->Progress)
    {
      this->Asked = true;
      this->Time = Clock::now();
      this->Algorithm->AbortExecuteOn();
    }
  }

  vtkAlgorithm* Algorithm;
  double Progress;
  unsigned long Tag;
  bool Asked = false;
  Clock::time_point Time;
};

/// Updates, requests an abort at some progress, and expects the filter to stop soon and without
/// errors.
void UpdateImpatiently(vtkAlgorithm* algorithm, double progress)
{
  Messages messages(algorithm);
  const auto start = Clock::now();
  {
    const Impatience impatience(algorithm, progress);
    algorithm->Update();
    ASSERT_TRUE(impatience.HasAsked()) << "it was never so far";
    std::cout << algorithm->GetClassName() << ": asked after "
              << std::chrono::duration<double>(Clock::now() - start).count() - impatience.GetWait()
              << " s, ended " << impatience.GetWait() << " s later\n";
    EXPECT_LT(impatience.GetWait(), 1.0);
  }
  EXPECT_FALSE(messages.HasError()) << messages.Error();
}

vtkSmartPointer<vtkImageData> LargeImage(int n)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(n, n, 1);
  image->SetSpacing(8.0 / (n - 1), 8.0 / (n - 1), 1.0);
  return image;
}

vtkIdType CountValid(vtkDataSet* data)
{
  vtkDataArray* mask = PointArray(data, "vtkValidPointMask");
  vtkIdType count = 0;
  for (vtkIdType i = 0; mask && i < mask->GetNumberOfTuples(); ++i)
  {
    count += mask->GetComponent(i, 0) != 0.0;
  }
  return count;
}

TEST(Abort, Homeomorphism)
{
  const auto image = LargeImage(800);
  for (const System& system : { Contour, Smooth })
  {
    SCOPED_TRACE(system.Name);
    const auto filter = MakeFilter(system, MakePlanarPair(8, 41), image);
    filter->ComputeJacobianOn();
    for (const double progress : { 0.1, 0.5 })
    {
      filter->Modified();
      UpdateImpatiently(filter, progress);
      auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
      if (!KeepsAbortedOutput(output, image->GetNumberOfPoints()))
      {
        continue;
      }
      const vtkIdType valid = CountValid(output);
      EXPECT_LT(valid, image->GetNumberOfPoints());
      EXPECT_EQ(filter->GetNumberOfOutsidePoints(), image->GetNumberOfPoints() - valid);
      vtkDataArray* jacobian = PointArray(output, "Jacobian");
      vtkDataArray* mask = PointArray(output, "vtkValidPointMask");
      ASSERT_TRUE(jacobian);
      for (vtkIdType i = 0; i < output->GetNumberOfPoints(); i += 97)
      {
        ASSERT_EQ(std::isnan(jacobian->GetComponent(i, 0)), mask->GetComponent(i, 0) == 0.0);
      }
    }
    filter->Modified();
    EXPECT_EQ(CountValid(Output(filter)), image->GetNumberOfPoints());
  }
}

TEST(Abort, Coordinates)
{
  const MeshPair pair = MakePlanarPair(200, 42);
  vtkNew<vtkTriangularCoordinates> filter;
  filter->SetInputData(pair.Source);
  const auto image = LargeImage(800);
  filter->SetDataObject(image);
  filter->SetGenerateLines(false);
  UpdateImpatiently(filter, 0.5);
  auto* output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  if (!KeepsAbortedOutput(output, image->GetNumberOfPoints()))
  {
    return;
  }
  EXPECT_LT(CountValid(output), image->GetNumberOfPoints());
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), image->GetNumberOfPoints() - CountValid(output));
}

TEST(Abort, CoordinateLines)
{
  // Lines take longest and are made first.
  const MeshPair pair = MakePlanarPair(80, 43);
  vtkNew<vtkTriangularCoordinates> filter;
  filter->SetInputData(pair.Source);
  const auto image = LargeImage(300);
  filter->SetDataObject(image);
  UpdateImpatiently(filter, 0.05);
  const vtkIdType lines = filter->GetLines()->GetNumberOfCells();
  EXPECT_EQ(CountValid(vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0))), 0);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), image->GetNumberOfPoints());
  filter->Modified();
  filter->Update();
  EXPECT_LT(lines, filter->GetLines()->GetNumberOfCells());
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
}

TEST(Abort, Continuity)
{
  const MeshPair pair = MakePlanarPair(90, 44);
  vtkNew<vtkJacobianContinuity> filter;
  filter->SetInputDataObject(0, pair.Source);
  filter->SetInputDataObject(1, pair.Target);
  UpdateImpatiently(filter, 0.2);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(filter->GetLargestJump(), 0.0);
}

TEST(Abort, HomeomorphismThatMeasures)
{
  const MeshPair pair = MakePlanarPair(90, 45);
  const auto filter = MakeFilter(Smooth, pair);
  filter->MeasureContinuityOn();
  UpdateImpatiently(filter, 0.2);
  EXPECT_EQ(filter->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL), 0);
  auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  KeepsAbortedOutput(output, pair.Source->GetNumberOfPoints());
  EXPECT_EQ(CountValid(output), 0);
}

TEST(Abort, Resample)
{
  const MeshPair pair = MakePlanarPair(8, 46);
  const auto image = LargeImage(300);
  image->GetPointData()->SetScalars(RandomArray("Brightness", 1, image->GetNumberOfPoints(), 3));
  vtkNew<vtkResampleThroughHomeomorphism> filter;
  filter->SetInputDataObject(0, pair.Source);
  filter->SetInputDataObject(1, pair.Target);
  filter->SetInputDataObject(2, image);
  filter->SetSamplingDimensions(800, 800);
  for (const double progress : { 0.1, 0.3 })
  {
    SCOPED_TRACE(progress);
    filter->Modified();
    UpdateImpatiently(filter, progress);
    auto* output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    ASSERT_TRUE(output);
    EXPECT_LT(CountValid(output), 800 * 800);
    // Points that were not reached are marked as invalid.
    vtkDataArray* brightness = PointArray(output, "Brightness");
    for (vtkIdType i = 0; brightness && i < output->GetNumberOfPoints(); ++i)
    {
      ASSERT_EQ(std::isnan(brightness->GetTuple1(i)),
        PointArray(output, "vtkValidPointMask")->GetTuple1(i) == 0.0);
    }
  }
  filter->Modified();
  filter->Update();
  EXPECT_GT(CountValid(vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0))), 700 * 800);
}

} // namespace
