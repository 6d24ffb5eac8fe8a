// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// A filter that is aborted stops before its work is done, without an error; what it has not done is
// marked, and the next update does it. Progress rises to one.

#include "Fixtures/FilterRuns.h"

#include "vtkJacobianContinuity.h"
#include "vtkResampleThroughHomeomorphism.h"
#include "vtkTriangularCoordinates.h"

namespace
{

using namespace fixtures;

/// Records the progress of an algorithm, and aborts it when that reaches a limit.
class Observer
{
public:
  explicit Observer(vtkAlgorithm* algorithm, double limit = 2.0)
    : Algorithm(algorithm)
    , Limit(limit)
    , Tag(algorithm->AddObserver(vtkCommand::ProgressEvent, this, &Observer::Look))
  {
  }
  ~Observer()
  {
    this->Algorithm->RemoveObserver(this->Tag);
    // The executive does it before VTK 9.3 only.
    this->Algorithm->AbortExecuteOff();
  }
  Observer(const Observer&) = delete;
  void operator=(const Observer&) = delete;

  const std::vector<double>& GetProgress() const { return this->Progress; }

private:
  void Look()
  {
    this->Progress.push_back(this->Algorithm->GetProgress());
    if (this->Progress.back() >= this->Limit)
    {
      this->Algorithm->AbortExecuteOn();
    }
  }

  vtkAlgorithm* Algorithm;
  double Limit;
  unsigned long Tag;
  std::vector<double> Progress;
};

void UpdateAndAbort(vtkHomeomorphismAlgorithm* algorithm, double progress)
{
  Messages messages(algorithm);
  const Observer observer(algorithm, progress);
  algorithm->Modified();
  algorithm->Update();
  EXPECT_EQ(messages.Error(), "");
  EXPECT_EQ(algorithm->GetErrorCode(),
    static_cast<unsigned long>(vtkHomeomorphismAlgorithm::UPDATE_ABORTED));
}

/// An image inside the square of the pairs below, with more points than one block.
vtkSmartPointer<vtkImageData> MakeLargeImage()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(420, 420, 1);
  image->SetOrigin(0.1, 0.1, 0.0);
  image->SetSpacing(7.8 / 419.0, 7.8 / 419.0, 1.0);
  image->GetPointData()->SetScalars(RandomArray("Brightness", 1, image->GetNumberOfPoints(), 3));
  return image;
}

bool IsValid(vtkDataSet* data, vtkIdType i)
{
  return PointArray(data, "vtkValidPointMask")->GetComponent(i, 0) != 0.0;
}

vtkIdType CountValid(vtkDataSet* data)
{
  vtkIdType count = 0;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    count += IsValid(data, i);
  }
  return count;
}

TEST(Abort, Homeomorphism)
{
  const MeshPair pair = MakePlanarPair(8, 41);
  const auto image = MakeLargeImage();
  image->GetPointData()->SetVectors(RandomArray("Vectors", 3, image->GetNumberOfPoints(), 61));
  image->GetCellData()->SetVectors(RandomArray("Flux", 3, image->GetNumberOfCells(), 62));
  for (const System& system : { Contour, Smooth })
  {
    const auto complete = MakeFilter(system, pair, image);
    vtkPointSet* whole = Output(complete);
    const auto filter = MakeFilter(system, pair, image);
    for (const double progress : { 0.1, 0.5 })
    {
      UpdateAndAbort(filter, progress);
      auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
      if (!KeepsAbortedOutput(output, image->GetNumberOfPoints()))
      {
        continue;
      }
      EXPECT_EQ(CountValid(output) > 0, progress > 0.3) << "the mesh is read first";
      EXPECT_LT(CountValid(output), image->GetNumberOfPoints());
      EXPECT_EQ(
        filter->GetNumberOfOutsidePoints(), image->GetNumberOfPoints() - CountValid(output));
      for (vtkIdType i = 0; i < output->GetNumberOfPoints(); i += 7)
      {
        const bool isDone = IsValid(output, i);
        ASSERT_EQ(PointOf(output, i), isDone ? PointOf(whole, i) : PointOf(image, i));
        ASSERT_EQ(std::isnan(PointArray(output, "Vectors")->GetComponent(i, 0)), !isDone);
        ASSERT_EQ(PointArray(output, "vtkGhostType")->GetComponent(i, 0) != 0.0, !isDone);
      }
    }
    filter->Modified();
    EXPECT_EQ(CountDifferentPoints(Output(filter), whole), 0);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    EXPECT_EQ(filter->GetErrorCode(), 0u);
    EXPECT_EQ(CountDifferentValues(
                Output(filter)->GetCellData()->GetVectors(), whole->GetCellData()->GetVectors()),
      0);
  }
}

TEST(Abort, Coordinates)
{
  const auto image = MakeLargeImage();
  const MeshPair pair = MakePlanarPair(40, 42);
  vtkNew<vtkTriangularCoordinates> filter;
  filter->SetInputData(Resized(pair.Source, 0.2));
  filter->SetDataObject(image);
  // Lines are made first, then points are located.
  UpdateAndAbort(filter, 0.05);
  const vtkIdType lines = filter->GetLines()->GetNumberOfCells();
  filter->GenerateLinesOff();
  UpdateAndAbort(filter, 0.5);
  auto* output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  if (KeepsAbortedOutput(output, image->GetNumberOfPoints()))
  {
    EXPECT_GT(CountValid(output), 0);
    EXPECT_LT(CountValid(output), image->GetNumberOfPoints());
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), image->GetNumberOfPoints() - CountValid(output));
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); i += 7)
    {
      ASSERT_EQ(PointArray(output, "TriangleId")->GetComponent(i, 0) >= 0, IsValid(output, i));
      ASSERT_EQ(std::isnan(PointArray(output, "ContourParameter")->GetComponent(i, 0)),
        !IsValid(output, i));
    }
  }
  filter->GenerateLinesOn();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
  EXPECT_LT(lines, filter->GetLines()->GetNumberOfCells());
}

TEST(Abort, Continuity)
{
  const MeshPair pair = MakePlanarPair(50, 44);
  const auto continuity = MakeAlgorithm<vtkJacobianContinuity>(pair);
  UpdateAndAbort(continuity, 0.2);
  // A part must not look like the whole.
  EXPECT_EQ(continuity->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_EQ(continuity->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(continuity->GetLargestJump(), 0.0);
  const auto filter = MakeFilter(Smooth, pair);
  filter->MeasureContinuityOn();
  UpdateAndAbort(filter, 0.2);
  EXPECT_EQ(filter->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL), 0);
  auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  KeepsAbortedOutput(output, pair.Source->GetNumberOfPoints());
  EXPECT_EQ(output->GetNumberOfPoints() > 0 ? CountValid(output) : 0, 0);
}

TEST(Abort, Resample)
{
  const MeshPair pair = MakePlanarPair(8, 46);
  const auto filter = MakeAlgorithm<vtkResampleThroughHomeomorphism>(pair);
  filter->SetDataObject(MakeLargeImage());
  filter->SetSamplingDimensions(500, 500);
  for (const double progress : { 0.1, 0.3 })
  {
    UpdateAndAbort(filter, progress);
    vtkDataSet* output = filter->GetOutput();
    vtkDataArray* brightness = PointArray(output, "Brightness");
    for (vtkIdType i = 0; brightness && i < output->GetNumberOfPoints(); ++i)
    {
      ASSERT_EQ(std::isnan(brightness->GetTuple1(i)), !IsValid(output, i));
    }
    EXPECT_LT(brightness ? CountValid(output) : 0, 200000);
  }
  filter->Modified();
  filter->Update();
  EXPECT_GT(CountValid(filter->GetOutput()), 200000);
}

TEST(Abort, ProgressRisesToOne)
{
  const MeshPair pair = MakePlanarPair(8, 47);
  const auto image = MakeLargeImage();
  vtkNew<vtkMultiBlockDataSet> tree;
  tree->SetBlock(0, image);
  tree->SetBlock(1, image);
  vtkNew<vtkTriangularCoordinates> coordinates;
  coordinates->SetInputData(0, pair.Source);
  const auto map = MakeFilter(Smooth, pair);
  for (vtkHomeomorphismAlgorithm* filter :
    std::initializer_list<vtkHomeomorphismAlgorithm*>{ map, coordinates })
  {
    for (vtkDataObject* data : std::initializer_list<vtkDataObject*>{ image, tree })
    {
      filter->SetDataObject(data);
      const Observer observer(filter);
      filter->Update();
      const std::vector<double>& progress = observer.GetProgress();
      ASSERT_GT(progress.size(), 4u);
      EXPECT_GE(progress.front(), 0.0);
      EXPECT_EQ(progress.back(), 1.0);
      EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end())) << data->GetClassName();
    }
  }
}

} // namespace
