// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The filters inside pipelines: data in pieces and extents, and time steps.

#include "Fixtures/FilterRuns.h"

#include "vtkResampleThroughHomeomorphism.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDummyController.h"
#include "vtkElevationFilter.h"
#include "vtkGroupDataSetsFilter.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkPolyDataStreamer.h"
#include "vtkRTAnalyticSource.h"
#include "vtkSphereSource.h"
#include "vtkTimeSourceExample.h"
#include "vtkUnstructuredGrid.h"

namespace
{

using namespace fixtures;
using Pipeline = vtkStreamingDemandDrivenPipeline;

/// Two triangulations of the square with corners (-12, -12) and (12, 12).
MeshPair MakeWidePair(std::uint64_t seed)
{
  return Moved(MakePlanarPair(6, seed), [](const Point& p) {
    return 4.0 * (p - Point{ 3.0, 3.0, 0.0 });
  });
}

vtkDataSet* DataOf(vtkAlgorithm* filter)
{
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
}

/// What the map or the coordinates add to the data.
vtkDataArray* ResultOf(vtkAlgorithm* filter)
{
  vtkDataArray* result = PointArray(DataOf(filter), "EdgeParameter");
  return result ? result : vtkPointSet::SafeDownCast(DataOf(filter))->GetPoints()->GetData();
}

/// The map and the coordinates, the two filters that take data, share their pipeline behavior.
class PipelinesOfData : public ::testing::TestWithParam<bool>
{
protected:
  vtkSmartPointer<vtkHomeomorphismAlgorithm> Make(const MeshPair& pair)
  {
    if (GetParam())
    {
      return MakeFilter(Smooth, pair);
    }
    return MakeCoordinates(Smooth, pair.Source);
  }
  /// A filter whose data are the output of an algorithm.
  vtkSmartPointer<vtkHomeomorphismAlgorithm> Connect(const MeshPair& pair, vtkAlgorithm* data)
  {
    const auto filter = this->Make(pair);
    filter->SetDataConnection(data->GetOutputPort());
    return filter;
  }
  /// The filter has the result for a copy of the data that has no pipeline.
  void ExpectResultFor(vtkDataSet* data, vtkAlgorithm* filter, const MeshPair& pair)
  {
    const auto alone = this->Make(pair);
    alone->SetDataObject(CopyOf(data));
    alone->Update();
    EXPECT_TRUE(IsSame(ResultOf(filter), ResultOf(alone)));
    EXPECT_EQ(CountDifferentCells(DataOf(filter), DataOf(alone)), 0);
  }
};

INSTANTIATE_TEST_SUITE_P(All, PipelinesOfData, ::testing::Bool());

/// An algorithm whose meshes and data are outputs.
template <typename Algorithm>
vtkSmartPointer<Algorithm> Connected(vtkAlgorithm* source, vtkAlgorithm* target, vtkAlgorithm* data)
{
  auto algorithm = vtkSmartPointer<Algorithm>::New();
  algorithm->SetInputConnection(0, source->GetOutputPort());
  algorithm->SetInputConnection(1, target->GetOutputPort());
  algorithm->SetInputConnection(2, data->GetOutputPort());
  return algorithm;
}

int RequestedPieces(vtkAlgorithm* algorithm)
{
  return algorithm->GetOutputInformation(0)->Get(Pipeline::UPDATE_NUMBER_OF_PIECES());
}

TEST_P(PipelinesOfData, PiecesOfASurface)
{
  // A sphere over the planar domain, whose source makes pieces.
  const MeshPair pair = MakeWidePair(900);
  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkSphereSource> alone;
  for (vtkSphereSource* each : { sphere.Get(), alone.Get() })
  {
    each->SetRadius(9.0);
    each->SetThetaResolution(32);
    each->SetPhiResolution(17);
  }
  const auto filter = this->Connect(pair, sphere);
  alone->Update();
  const vtkIdType whole = alone->GetOutput()->GetNumberOfCells();
  vtkIdType cells = 0;
  for (int piece = 0; piece < 3; ++piece)
  {
    ASSERT_TRUE(filter->UpdatePiece(piece, 3, 0));
    // The data is requested in pieces.
    EXPECT_EQ(RequestedPieces(sphere), 3);
    cells += DataOf(filter)->GetNumberOfCells();
    EXPECT_GT(DataOf(filter)->GetNumberOfCells(), 0);
    // The output for a piece equals that for the piece as a data set of its own.
    alone->UpdatePiece(piece, 3, 0);
    this->ExpectResultFor(alone->GetOutput(), filter, pair);
  }
  EXPECT_EQ(cells, whole);
  // Requesting the whole again gives the whole, also through VTK's own streaming filter.
  filter->UpdatePiece(0, 1, 0);
  EXPECT_EQ(DataOf(filter)->GetNumberOfCells(), whole);
  vtkNew<vtkPolyDataStreamer> streamer;
  streamer->SetInputConnection(filter->GetOutputPort());
  streamer->SetNumberOfStreamDivisions(4);
  streamer->Update();
  EXPECT_EQ(DataOf(streamer)->GetNumberOfCells(), whole);
  EXPECT_EQ(filter->GetNumberOfMeshBuilds(), 1);
}

using Extent = std::array<int, 6>;

Extent ExtentOf(vtkDataSet* data)
{
  Extent extent;
  data->GetInformation()->Get(vtkDataObject::DATA_EXTENT(), extent.data());
  return extent;
}

TEST_P(PipelinesOfData, PiecesAndExtentsOfAnImage)
{
  Extent whole{ -10, 11, -9, 10, 2, 4 };
  const MeshPair pair = MakeWidePair(910);
  vtkNew<vtkRTAnalyticSource> wavelet;
  vtkNew<vtkRTAnalyticSource> alone;
  for (vtkRTAnalyticSource* each : { wavelet.Get(), alone.Get() })
  {
    each->SetWholeExtent(-10, 11, -9, 10, 2, 4);
  }
  const auto filter = this->Connect(pair, wavelet);
  filter->UpdateInformation();
  const int* announced = filter->GetOutputInformation(0)->Get(Pipeline::WHOLE_EXTENT());
  ASSERT_TRUE(announced && std::equal(whole.begin(), whole.end(), announced));

  // The output for a part equals that for the part as a data set of its own.
  const auto expectPart = [&]() {
    Extent extent = ExtentOf(DataOf(filter));
    EXPECT_EQ(ExtentOf(wavelet->GetOutput()), extent);
    alone->UpdateExtent(extent.data());
    this->ExpectResultFor(alone->GetOutput(), filter, pair);
    EXPECT_TRUE(
      IsSame(PointArray(DataOf(filter), "RTData"), PointArray(alone->GetOutput(), "RTData")));
  };
  vtkIdType cells = 0;
  for (int piece = 0; piece < 4; ++piece)
  {
    // The whole, once made, would also serve for every piece.
    wavelet->Modified();
    ASSERT_TRUE(filter->UpdatePiece(piece, 4, 0));
    EXPECT_LT(DataOf(filter)->GetNumberOfPoints(), 22 * 20 * 3 / 2);
    expectPart();
    cells += DataOf(filter)->GetNumberOfCells();
  }
  EXPECT_EQ(cells, 21 * 19 * 2);
  const Extent part{ -3, 4, 5, 10, 3, 4 };
  wavelet->Modified();
  ASSERT_TRUE(filter->UpdateExtent(part.data()));
  EXPECT_EQ(ExtentOf(DataOf(filter)), part);
  expectPart();
}

TEST(Pipelines, DataMadeFromAMeshIsPartOfTheFirstPiece)
{
  // One source of both mesh and data cannot be requested both whole and in pieces. The mesh is a
  // sphere mapped onto itself, whose source makes any piece.
  vtkNew<vtkSphereSource> mesh;
  vtkNew<vtkSphereSource> same;
  vtkNew<vtkElevationFilter> made;
  made->SetInputConnection(mesh->GetOutputPort());
  vtkNew<vtkSphereSource> other;
  mesh->Update();
  const vtkIdType whole = mesh->GetOutput()->GetNumberOfCells();
  // The output of a map of independent data with the same meshes comes in pieces: the map requests
  // its meshes whole, too.
  const auto forth = Connected<vtkDifferentiableHomeomorphism>(mesh, same, other);
  for (vtkAlgorithm* data : std::initializer_list<vtkAlgorithm*>{ mesh, made, other, forth })
  {
    SCOPED_TRACE(data->GetClassName());
    const auto map = Connected<vtkDifferentiableHomeomorphism>(mesh, same, data);
    const auto resample = Connected<vtkResampleThroughHomeomorphism>(mesh, same, mesh);
    resample->SetGridConnection(data->GetOutputPort());
    vtkNew<vtkTriangularCoordinates> coordinates;
    coordinates->SetInputConnection(0, mesh->GetOutputPort());
    coordinates->SetDataConnection(data->GetOutputPort());
    for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ map, coordinates, resample })
    {
      SCOPED_TRACE(filter->GetClassName());
      const bool inPieces = data == other || data == forth;
      vtkIdType cells = 0;
      for (const int piece : { 0, 1, 2 })
      {
        EXPECT_TRUE(filter->UpdatePiece(piece, 3, 0));
        EXPECT_EQ(DataOf(filter)->GetNumberOfCells() > 0, inPieces || piece == 0);
        cells += DataOf(filter)->GetNumberOfCells();
      }
      EXPECT_EQ(cells, whole);
      EXPECT_EQ(RequestedPieces(data), inPieces ? 3 : 1);
    }
    EXPECT_EQ(map->GetNumberOfMeshBuilds(), 1);
    EXPECT_EQ(resample->GetNumberOfMeshBuilds(), 1);
  }
}

TEST(Pipelines, MeasurementsArePartOfTheFirstPiece)
{
  const MeshPair pair = MakeWidePair(918);
  const auto continuity = Measure(pair, Linear);
  const vtkIdType edges = continuity->GetOutput()->GetNumberOfCells();
  ASSERT_GT(edges, 0);
  const auto map = MakeFilter(Linear, pair);
  map->MeasureContinuityOn();
  for (const int piece : { 1, 0, 2, 0 })
  {
    SCOPED_TRACE(piece);
    const vtkIdType share = piece == 0 ? 1 : 0;
    EXPECT_EQ(UpdatePiece(continuity, piece, 3, 1)->GetNumberOfCells(),
      share * pair.Source->GetNumberOfCells());
    EXPECT_EQ(UpdatePiece(continuity, piece, 3, 0)->GetNumberOfCells(), share * edges);
    EXPECT_EQ(continuity->GetNumberOfCreases(), share * edges);
    EXPECT_EQ(continuity->GetLargestJump() > 0.0, piece == 0);
    EXPECT_EQ(UpdatePiece(map, piece, 3, 1)->GetNumberOfCells(), share * edges);
  }
  // It was measured once for all pieces.
  EXPECT_EQ(map->GetJacobianContinuity()->GetNumberOfCreases(), edges);
}

TEST(Pipelines, PointsOfOtherPiecesAreNotCounted)
{
  // Two of the four points outside belong to another piece.
  const MeshPair pair = MakeWidePair(917);
  const auto cloud =
    MakeCloud({ { 0, 0, 0 }, { 99, 0, 0 }, { 98, 0, 0 }, { 97, 0, 0 }, { 96, 2, 0 } });
  cloud->GetPointData()->AddArray(MakeGhosts(5, { 1, 4 }, vtkDataSetAttributes::DUPLICATEPOINT));
  const auto map = MakeFilter(Smooth, pair, cloud);
  const auto coordinates = MakeCoordinates(Smooth, pair.Source, cloud);
  const auto resample = MakeAlgorithm<vtkResampleThroughHomeomorphism>(pair);
  resample->SetGridData(cloud);
  for (vtkHomeomorphismAlgorithm* filter :
    std::initializer_list<vtkHomeomorphismAlgorithm*>{ map, coordinates, resample })
  {
    filter->Update();
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 2);
    // With one process, ReduceStatistics changes nothing, with a controller or without.
    filter->ReduceStatistics(vtkNew<vtkDummyController>());
    filter->ReduceStatistics(nullptr);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 2);
  }
}

std::vector<double> TimesOf(vtkAlgorithm* filter, int port)
{
  filter->UpdateInformation();
  vtkInformation* info = filter->GetOutputInformation(port);
  const double* times = info->Get(Pipeline::TIME_STEPS());
  return { times, times + info->Length(Pipeline::TIME_STEPS()) };
}

TEST_P(PipelinesOfData, TimeStepsOfTheData)
{
  const MeshPair pair = MakeWidePair(930);
  vtkNew<vtkTimeSourceExample> source;
  vtkNew<vtkTimeSourceExample> alone;
  for (vtkTimeSourceExample* each : { source.Get(), alone.Get() })
  {
    each->SetXAmplitude(3.0);
    each->SetYAmplitude(2.0);
    each->GrowingOn();
  }
  const auto filter = this->Connect(pair, source);
  const std::vector<double> steps = TimesOf(source, 0);
  ASSERT_GT(steps.size(), 3u);
  EXPECT_EQ(TimesOf(filter, 0), steps);
  EXPECT_EQ(filter->GetOutputInformation(0)->Get(Pipeline::TIME_RANGE())[1], steps.back());
  std::set<vtkIdType> sizes;
  for (const double time : steps)
  {
    ASSERT_TRUE(filter->UpdateTimeStep(time));
    alone->UpdateTimeStep(time);
    EXPECT_EQ(DataOf(filter)->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
    this->ExpectResultFor(alone->GetOutput(), filter, pair);
    sizes.insert(DataOf(filter)->GetNumberOfCells());
  }
  EXPECT_GT(sizes.size(), 1u);
  // The meshes are static.
  EXPECT_EQ(filter->GetNumberOfMeshBuilds(), 1);
}

/// A mesh that depends on time: the points of @a base moved by the time, along x for points inside
/// the square of MakeWidePair.
class MovingMesh : public vtkPolyDataAlgorithm
{
public:
  static MovingMesh* New() { VTK_STANDARD_NEW_BODY(MovingMesh); }
  vtkTypeMacro(MovingMesh, vtkPolyDataAlgorithm);

  static vtkSmartPointer<vtkPolyData> At(vtkPolyData* base, double time)
  {
    return Moved(base, [time](const Point& p) -> Point {
      const bool inside = std::abs(p[0]) < 11.9 && std::abs(p[1]) < 11.9;
      return { p[0] + (inside ? 0.1 * time : 0.0), p[1], p[2] };
    });
  }

  vtkSmartPointer<vtkPolyData> Base;
  std::vector<double> Times;
  int Executions = 0;

protected:
  MovingMesh() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* info = outputs->GetInformationObject(0);
    const double range[2] = { this->Times.front(), this->Times.back() };
    info->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
    return 1;
  }
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    const double time = outputs->GetInformationObject(0)->Get(Pipeline::UPDATE_TIME_STEP());
    ++this->Executions;
    vtkPolyData* output = vtkPolyData::GetData(outputs);
    output->ShallowCopy(At(this->Base, time));
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    return 1;
  }
};

TEST(Pipelines, TimeStepsOfTheMeshes)
{
  // One mesh moves; the other one and the data are static.
  const MeshPair pair = MakeWidePair(935);
  const auto cloud = MakeCloud(pair.Source, RandomSamples(pair.Source, 500, 61));
  for (const int moving : { 0, 1 })
  {
    SCOPED_TRACE(moving);
    vtkNew<MovingMesh> mesh;
    mesh->Base = moving == 0 ? pair.Source : pair.Target;
    mesh->Times = { 0.0, 1.0, 2.5 };
    const auto map = MakeFilter(Smooth, pair, cloud);
    map->SetInputConnection(moving, mesh->GetOutputPort());
    map->MeasureContinuityOn();
    const auto resample = MakeAlgorithm<vtkResampleThroughHomeomorphism>(pair);
    resample->SetInputConnection(moving, mesh->GetOutputPort());
    const auto continuity = MakeAlgorithm<vtkJacobianContinuity>(pair);
    continuity->SetInputConnection(moving, mesh->GetOutputPort());
    vtkIdType builds = 0;
    // Also backward in time, because only the last result is kept.
    for (const double time : { 0.0, 1.0, 2.5, 1.0 })
    {
      SCOPED_TRACE(time);
      EXPECT_EQ(TimesOf(map, 0), mesh->Times);
      EXPECT_EQ(TimesOf(map, 1), mesh->Times);
      const auto moved = MovingMesh::At(mesh->Base, time);
      const MeshPair pairThen =
        moving == 0 ? MeshPair{ moved, pair.Target } : MeshPair{ pair.Source, moved };
      const auto expected = MakeFilter(Smooth, pairThen, cloud);
      expected->MeasureContinuityOn();
      expected->Update();
      ++builds;
      // A repeated request for the same time does nothing.
      for (int again = 0; again < 2; ++again)
      {
        ASSERT_TRUE(map->UpdateTimeStep(time));
        EXPECT_EQ(map->GetNumberOfMeshBuilds(), builds);
        EXPECT_EQ(DataOf(map)->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
        ASSERT_TRUE(resample->UpdateTimeStep(time));
        EXPECT_EQ(resample->GetNumberOfMeshBuilds(), builds);
      }
      EXPECT_EQ(CountDifferentPoints(DataOf(map), DataOf(expected)), 0);
      ASSERT_TRUE(continuity->UpdateTimeStep(time));
      EXPECT_EQ(TimesOf(continuity, 1), mesh->Times);
      auto* measured = vtkPolyData::SafeDownCast(expected->GetOutputDataObject(1));
      EXPECT_EQ(CountDifferentPoints(continuity->GetOutput(), measured), 0);
      EXPECT_TRUE(IsSame(
        CellArray(continuity->GetOutput(), "JacobianJump"), CellArray(measured, "JacobianJump")));
    }
    // Each filter executes once per time, and all for the same times.
    EXPECT_EQ(mesh->Executions, 4);
  }
}

TEST(Pipelines, TimeStepsOfAllInputs)
{
  // The data and the target have different times, and the data is a tree.
  const MeshPair pair = MakeWidePair(936);
  vtkNew<vtkTimeSourceExample> source;
  source->SetXAmplitude(3.0);
  source->SetYAmplitude(2.0);
  vtkNew<vtkSphereSource> sphere;
  for (const int type : { VTK_MULTIBLOCK_DATA_SET, VTK_PARTITIONED_DATA_SET_COLLECTION })
  {
    vtkNew<vtkGroupDataSetsFilter> group;
    group->SetOutputType(type);
    group->AddInputConnection(source->GetOutputPort());
    group->AddInputConnection(sphere->GetOutputPort());
    const auto map = MakeFilter(Smooth, pair);
    map->SetDataConnection(group->GetOutputPort());
    std::vector<double> expected = TimesOf(source, 0);
    EXPECT_EQ(TimesOf(map, 0), expected);
    const auto pointOf = [&]() {
      auto* tree = vtkCompositeDataSet::SafeDownCast(map->GetOutputDataObject(0));
      EXPECT_EQ(tree->GetDataObjectType(), type);
      const auto leaves = vtkSmartPointer<vtkCompositeDataIterator>::Take(tree->NewIterator());
      leaves->InitTraversal();
      return PointOf(vtkDataSet::SafeDownCast(leaves->GetCurrentDataObject()), 0);
    };
    std::set<Point> samples;
    for (const double time : expected)
    {
      ASSERT_TRUE(map->UpdateTimeStep(time));
      samples.insert(pointOf());
      EXPECT_EQ(map->GetNumberOfMeshBuilds(), 1);
    }
    EXPECT_GT(samples.size(), expected.size() / 2);

    vtkNew<MovingMesh> target;
    target->Base = pair.Target;
    target->Times = { expected[0], 0.5 * (expected[0] + expected[1]), expected.back() + 1.0 };
    map->SetTargetConnection(target->GetOutputPort());
    expected.insert(expected.begin() + 1, target->Times[1]);
    expected.push_back(target->Times[2]);
    EXPECT_EQ(TimesOf(map, 0), expected);
    EXPECT_EQ(TimesOf(map, 1), target->Times);
    EXPECT_EQ(map->GetOutputInformation(0)->Get(Pipeline::TIME_RANGE())[1], expected.back());
    map->UpdateTimeStep(target->Times[0]);
    const Point before = pointOf();
    map->UpdateTimeStep(target->Times[2]);
    EXPECT_GT(Distance(pointOf(), before), 0.1);
    EXPECT_EQ(map->GetNumberOfMeshBuilds(), 3);
  }
}

} // namespace
