// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// An aborted filter stops early, without an error; points that were not processed are marked, and
// the next update processes them. Progress rises to one.

#include "Fixtures/FilterRuns.h"

#include "vtkResampleThroughHomeomorphism.h"

namespace
{

using namespace fixtures;

/// Whether the executive empties the outputs of an aborted algorithm, as since VTK 9.3.
template <typename Algorithm, typename = void>
constexpr bool EmptiesOutputs = false;
template <typename Algorithm>
constexpr bool EmptiesOutputs<Algorithm, decltype(void(Algorithm::ABORTED()))> = true;

/// Updates an algorithm and aborts it at some progress, which is recorded.
std::vector<double> UpdateAndAbort(vtkHomeomorphismAlgorithm* algorithm, double limit)
{
  struct Observer
  {
    vtkAlgorithm* Algorithm;
    double Limit;
    std::vector<double> Progress;
    void Look()
    {
      this->Progress.push_back(this->Algorithm->GetProgress());
      if (this->Progress.back() >= this->Limit)
      {
        this->Algorithm->AbortExecuteOn();
      }
    }
  } observer{ algorithm, limit, {} };
  Messages messages(algorithm);
  const auto tag = algorithm->AddObserver(vtkCommand::ProgressEvent, &observer, &Observer::Look);
  algorithm->Modified();
  algorithm->Update();
  algorithm->RemoveObserver(tag);
  // The executive does it before VTK 9.3 only.
  algorithm->AbortExecuteOff();
  EXPECT_EQ(messages.Error(), "");
  EXPECT_EQ(algorithm->GetErrorCode(),
    limit > 1.0 ? 0u : static_cast<unsigned long>(vtkHomeomorphismAlgorithm::UPDATE_ABORTED));
  return observer.Progress;
}

/// An image inside the square of the pairs below, with more points than one block.
vtkSmartPointer<vtkImageData> MakeLargeImage()
{
  auto image =
    MakeImage({ 0, 419, 0, 419, 0, 0 }, { 0.1, 0.1, 0.0 }, { 7.8 / 419.0, 7.8 / 419.0, 1.0 });
  image->GetPointData()->SetScalars(RandomArray("Brightness", 1, image->GetNumberOfPoints(), 3));
  image->GetPointData()->SetVectors(RandomArray("Vectors", 3, image->GetNumberOfPoints(), 61));
  image->GetCellData()->SetVectors(RandomArray("Flux", 3, image->GetNumberOfCells(), 62));
  return image;
}

vtkIdType CountValid(vtkDataSet* data)
{
  return data->GetNumberOfPoints() - CountOutside(data);
}

/// Some of the work is done: these points have the positions and the numbers of the array that they
/// have in the whole. The others have no number, and the positions of the input. Then all of it is
/// done, as before.
void ExpectPartAndWhole(vtkHomeomorphismAlgorithm* filter, const char* name,
  const std::vector<double>& limits, vtkDataSet* input)
{
  const auto whole = CopyOf(static_cast<vtkDataSet*>(Output(filter)));
  const vtkIdType outside = filter->GetNumberOfOutsidePoints();
  for (const double limit : limits)
  {
    SCOPED_TRACE(name + std::string(", aborted at ") + std::to_string(limit));
    UpdateAndAbort(filter, limit);
    vtkDataSet* part = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    if (EmptiesOutputs<vtkAlgorithm>)
    {
      EXPECT_EQ(part->GetNumberOfPoints(), 0);
      continue;
    }
    ASSERT_EQ(part->GetNumberOfPoints(), whole->GetNumberOfPoints());
    // The mesh is read first.
    EXPECT_EQ(CountValid(part) > 0, limit > 0.3);
    EXPECT_LT(CountValid(part), CountValid(whole));
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), CountOutside(part));
    for (vtkIdType i = 0; i < part->GetNumberOfPoints(); i += 7)
    {
      const bool isDone = IsValid(part, i);
      ASSERT_TRUE(isDone || std::isnan(PointValue(part, name, i)));
      ASSERT_TRUE(!isDone || SameBits(PointValue(part, name, i), PointValue(whole, name, i)));
      ASSERT_EQ(PointOf(part, i), PointOf(isDone ? whole.Get() : input, i));
    }
  }
  filter->Modified();
  ExpectSame(Output(filter), whole, { name });
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), outside);
  EXPECT_EQ(filter->GetErrorCode(), 0u);
}

TEST(Abort, PartsAreMarkedAndFinishedLater)
{
  const auto image = MakeLargeImage();
  const MeshPair pair = MakePlanarPair(8, 41);
  for (const System& system : { Contour, Smooth })
  {
    ExpectPartAndWhole(MakeFilter(system, pair, image), "Vectors", { 0.1, 0.5 }, image);
  }
  ExpectPartAndWhole(
    MakeCoordinates(Smooth, pair.Source, image), "ContourParameter", { 0.5 }, image);
  // Vectors would be transformed in a second step.
  image->GetPointData()->RemoveArray("Vectors");
  const auto resample = MakeAlgorithm<vtkResampleThroughHomeomorphism>(pair);
  resample->SetDataObject(image);
  resample->SetSamplingDimensions(500, 500);
  vtkNew<vtkImageData> grid;
  grid->CopyStructure(vtkImageData::SafeDownCast(Output(resample.Get())));
  ExpectPartAndWhole(resample, "Brightness", { 0.1 }, grid);
}

TEST(Abort, LinesAndMeasurementsAreParts)
{
  const MeshPair pair = MakePlanarPair(50, 44);
  const auto coordinates = MakeCoordinates(Smooth, pair.Source);
  coordinates->GenerateLinesOn();
  UpdateAndAbort(coordinates, 0.05);
  const vtkIdType lines = coordinates->GetLines()->GetNumberOfCells();
  UpdateAndAbort(coordinates, 2.0);
  EXPECT_LT(lines, coordinates->GetLines()->GetNumberOfCells());

  // A part of the measurements must not look like the whole.
  const auto continuity = MakeAlgorithm<vtkJacobianContinuity>(pair);
  UpdateAndAbort(continuity, 0.2);
  EXPECT_EQ(continuity->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_EQ(continuity->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(continuity->GetLargestJump(), 0.0);
  const auto filter = MakeFilter(Smooth, pair);
  filter->MeasureContinuityOn();
  UpdateAndAbort(filter, 0.2);
  EXPECT_EQ(filter->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL), 0);
  auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(output->GetNumberOfPoints() > 0 ? CountValid(output) : 0, 0);
}

TEST(Abort, ProgressRisesToOne)
{
  const MeshPair pair = MakePlanarPair(8, 47);
  const auto image = MakeLargeImage();
  vtkNew<vtkMultiBlockDataSet> tree;
  tree->SetBlock(0, image);
  tree->SetBlock(1, image);
  const auto coordinates = MakeCoordinates(Smooth, pair.Source);
  const auto map = MakeFilter(Smooth, pair);
  map->MeasureContinuityOn();
  for (vtkHomeomorphismAlgorithm* filter :
    std::initializer_list<vtkHomeomorphismAlgorithm*>{ map, coordinates })
  {
    for (vtkDataObject* data : std::initializer_list<vtkDataObject*>{ image, tree })
    {
      filter->SetDataObject(data);
      const std::vector<double> progress = UpdateAndAbort(filter, 2.0);
      ASSERT_GT(progress.size(), 4u);
      EXPECT_GE(progress.front(), 0.0);
      EXPECT_EQ(progress.back(), 1.0);
      EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end())) << data->GetClassName();
    }
  }
}

} // namespace
