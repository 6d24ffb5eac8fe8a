// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The filters inside pipelines: data in pieces and extents, time steps, and aborts.

#include "Fixtures/FilterRuns.h"

#include "vtkJacobianContinuity.h"
#include "vtkResampleThroughHomeomorphism.h"
#include "vtkTriangularCoordinates.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDummyController.h"
#include "vtkElevationFilter.h"
#include "vtkGroupDataSetsFilter.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkPolyDataStreamer.h"
#include "vtkRTAnalyticSource.h"
#include "vtkSphereSource.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredGrid.h"
#include "vtkTimeSourceExample.h"
#include "vtkTransform.h"
#include "vtkTransformPolyDataFilter.h"
#include "vtkUnstructuredGrid.h"

#include <set>
#include <vector>

namespace
{

using namespace fixtures;
using Pipeline = vtkStreamingDemandDrivenPipeline;

/// Two triangulations of the square with corners (-12, -12) and (12, 12).
MeshPair MakeWidePair(std::uint64_t seed)
{
  MeshPair pair = MakePlanarPair(6, seed);
  const auto widen = [](const Point& p) -> Point {
    return { 4.0 * (p[0] - 3.0), 4.0 * (p[1] - 3.0), 0.0 };
  };
  return { Moved(pair.Source, widen), Moved(pair.Target, widen) };
}

/// Both filters, which share their pipeline behavior.
struct BothFilters
{
  BothFilters(const MeshPair& pair, vtkAlgorithmOutput* data)
    : Map(MakeFilter(Smooth, pair))
  {
    this->Map->SetDataConnection(data);
    this->Coordinates->SetInputData(0, pair.Source);
    this->Coordinates->SetDataConnection(data);
    this->Coordinates->GenerateLinesOff();
  }
  std::vector<vtkAlgorithm*> All() const { return { this->Map, this->Coordinates }; }

  const vtkSmartPointer<vtkDifferentiableHomeomorphism> Map;
  const vtkNew<vtkTriangularCoordinates> Coordinates;
};

vtkDataSet* DataOf(vtkAlgorithm* filter)
{
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
}

/// Only one of the two arrays exists, the one that the filter adds.
vtkDataArray* ResultOf(vtkAlgorithm* filter)
{
  vtkDataArray* result = PointArray(DataOf(filter), "EdgeParameter");
  return result ? result : vtkPointSet::SafeDownCast(DataOf(filter))->GetPoints()->GetData();
}

// --- Pieces and extents --------------------------------------------------------------------------

TEST(Pipelines, PiecesOfASurface)
{
  // A sphere over the planar domain, whose source makes pieces.
  const auto makeSphere = []() {
    auto sphere = vtkSmartPointer<vtkSphereSource>::New();
    sphere->SetRadius(9.0);
    sphere->SetThetaResolution(32);
    sphere->SetPhiResolution(17);
    return sphere;
  };
  const MeshPair pair = MakeWidePair(900);
  const auto sphere = makeSphere();
  const BothFilters filters(pair, sphere->GetOutputPort());
  const auto alone = makeSphere();
  const BothFilters wholes(pair, alone->GetOutputPort());
  for (const std::size_t which : { 0u, 1u })
  {
    vtkAlgorithm* filter = filters.All()[which];
    vtkIdType cells = 0;
    for (int piece = 0; piece < 3; ++piece)
    {
      ASSERT_TRUE(filter->UpdatePiece(piece, 3, 0));
      // The data is requested in pieces.
      EXPECT_EQ(sphere->GetOutputInformation(0)->Get(Pipeline::UPDATE_PIECE_NUMBER()), piece);
      EXPECT_EQ(sphere->GetOutputInformation(0)->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()), 3);
      vtkDataSet* output = DataOf(filter);
      EXPECT_LT(output->GetNumberOfCells(), 32 * 2 * 16 / 2);
      EXPECT_GT(output->GetNumberOfCells(), 0);
      cells += output->GetNumberOfCells();
      // The output for a piece equals that for the piece as a data set of its own.
      alone->UpdatePiece(piece, 3, 0);
      vtkNew<vtkPolyData> copy;
      copy->DeepCopy(alone->GetOutput());
      const auto expectedMap = MakeFilter(Smooth, pair, copy);
      vtkNew<vtkTriangularCoordinates> expectedCoordinates;
      expectedCoordinates->SetInputData(0, pair.Source);
      expectedCoordinates->SetDataObject(copy);
      vtkAlgorithm* expected =
        which == 0 ? static_cast<vtkAlgorithm*>(expectedMap) : expectedCoordinates;
      expected->Update();
      EXPECT_EQ(CountDifferentValues(ResultOf(filter), ResultOf(expected)), 0);
      EXPECT_EQ(CountDifferentCells(output, DataOf(expected)), 0);
    }
    vtkAlgorithm* whole = wholes.All()[which];
    whole->UpdatePiece(0, 1, 0);
    EXPECT_EQ(cells, DataOf(whole)->GetNumberOfCells());
    // Requesting the whole again gives the whole.
    filter->UpdatePiece(0, 1, 0);
    EXPECT_EQ(CountDifferentValues(ResultOf(filter), ResultOf(whole)), 0);
  }
  EXPECT_EQ(filters.Map->GetNumberOfMeshBuilds(), 1);

  // Followed by VTK's own streaming filter.
  vtkNew<vtkPolyDataStreamer> streamer;
  streamer->SetInputConnection(filters.Map->GetOutputPort());
  streamer->SetNumberOfStreamDivisions(4);
  streamer->Update();
  wholes.Map->UpdatePiece(0, 1, 0);
  EXPECT_EQ(DataOf(streamer)->GetNumberOfCells(), DataOf(wholes.Map)->GetNumberOfCells());
}

TEST(Pipelines, PiecesAndExtentsOfAnImage)
{
  const auto makeWavelet = []() {
    auto wavelet = vtkSmartPointer<vtkRTAnalyticSource>::New();
    wavelet->SetWholeExtent(-10, 11, -9, 10, 2, 4);
    return wavelet;
  };
  const MeshPair pair = MakeWidePair(910);
  const auto wavelet = makeWavelet();
  const auto alone = makeWavelet();
  const BothFilters filters(pair, wavelet->GetOutputPort());
  const BothFilters wholes(pair, alone->GetOutputPort());
  const auto extentOf = [](vtkDataSet* data) {
    auto* grid = vtkStructuredGrid::SafeDownCast(data);
    const int* extent = grid ? grid->GetExtent() : vtkImageData::SafeDownCast(data)->GetExtent();
    return std::array<int, 6>{ extent[0], extent[1], extent[2], extent[3], extent[4], extent[5] };
  };
  for (const std::size_t which : { 0u, 1u })
  {
    vtkAlgorithm* filter = filters.All()[which];
    vtkAlgorithm* whole = wholes.All()[which];
    whole->Update();
    vtkDataSet* all = DataOf(whole);
    const std::array<int, 6> wholeExtent{ -10, 11, -9, 10, 2, 4 };
    EXPECT_EQ(extentOf(all), wholeExtent);

    filter->UpdateInformation();
    vtkInformation* info = filter->GetOutputInformation(0);
    ASSERT_TRUE(info->Has(Pipeline::WHOLE_EXTENT()));
    EXPECT_TRUE(
      std::equal(wholeExtent.begin(), wholeExtent.end(), info->Get(Pipeline::WHOLE_EXTENT())));

    // Point i, j, k of a part must equal point i, j, k of the whole.
    const auto countDifferent = [&](vtkDataSet* part) {
      const std::array<int, 6> e = extentOf(part);
      vtkDataArray* results = ResultOf(filter);
      vtkDataArray* expected = ResultOf(whole);
      vtkIdType different = 0;
      vtkIdType index = 0;
      for (int k = e[4]; k <= e[5]; ++k)
      {
        for (int j = e[2]; j <= e[3]; ++j)
        {
          for (int i = e[0]; i <= e[1]; ++i, ++index)
          {
            const vtkIdType inWhole = (i + 10) + 22 * ((j + 9) + 20 * (k - 2));
            for (int component = 0; component < results->GetNumberOfComponents(); ++component)
            {
              different += !SameBits(results->GetComponent(index, component),
                expected->GetComponent(inWhole, component));
            }
            different += PointArray(part, "RTData")->GetComponent(index, 0) !=
              PointArray(all, "RTData")->GetComponent(inWhole, 0);
          }
        }
      }
      EXPECT_EQ(index, part->GetNumberOfPoints());
      return different;
    };

    // The whole, once made, would also serve for every piece.
    wavelet->Modified();
    vtkIdType cells = 0;
    for (int piece = 0; piece < 4; ++piece)
    {
      wavelet->Modified();
      ASSERT_TRUE(filter->UpdatePiece(piece, 4, 0));
      vtkDataSet* output = DataOf(filter);
      EXPECT_LT(output->GetNumberOfPoints(), all->GetNumberOfPoints() / 2);
      EXPECT_EQ(wavelet->GetOutput()->GetNumberOfPoints(), output->GetNumberOfPoints());
      EXPECT_EQ(countDifferent(output), 0);
      cells += output->GetNumberOfCells();
    }
    EXPECT_EQ(cells, all->GetNumberOfCells());

    const std::array<int, 6> partExtent{ -3, 4, 5, 10, 3, 4 };
    wavelet->Modified();
    ASSERT_TRUE(filter->UpdateExtent(partExtent.data()));
    EXPECT_EQ(extentOf(DataOf(filter)), partExtent);
    EXPECT_EQ(countDifferent(DataOf(filter)), 0);
    EXPECT_EQ(extentOf(wavelet->GetOutput()), partExtent);
  }
}

TEST(Pipelines, MeshesAreRequestedWhole)
{
  // Two spheres whose sources make pieces on request.
  const auto makeSphere = [](double radius) {
    auto sphere = vtkSmartPointer<vtkSphereSource>::New();
    sphere->SetRadius(radius);
    sphere->SetThetaResolution(24);
    sphere->SetPhiResolution(13);
    sphere->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    return sphere;
  };
  const auto source = makeSphere(1.0);
  const auto target = makeSphere(2.0);
  const auto data = makeSphere(1.0);
  vtkNew<vtkDifferentiableHomeomorphism> map;
  map->SetSourceConnection(source->GetOutputPort());
  map->SetTargetConnection(target->GetOutputPort());
  map->SetDataConnection(data->GetOutputPort());
  vtkNew<vtkTriangularCoordinates> coordinates;
  coordinates->SetInputConnection(0, source->GetOutputPort());
  coordinates->SetDataConnection(data->GetOutputPort());
  vtkIdType cells = 0;
  for (int piece = 0; piece < 3; ++piece)
  {
    ASSERT_TRUE(map->UpdatePiece(piece, 3, 0));
    ASSERT_TRUE(coordinates->UpdatePiece(piece, 3, 0));
    for (vtkSphereSource* mesh : { source.Get(), target.Get() })
    {
      EXPECT_EQ(mesh->GetOutputInformation(0)->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()), 1);
      EXPECT_EQ(mesh->GetOutput()->GetNumberOfCells(), 24 * 2 * 11);
    }
    EXPECT_EQ(data->GetOutputInformation(0)->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()), 3);
    vtkDataSet* output = DataOf(map);
    cells += output->GetNumberOfCells();
    EXPECT_EQ(map->GetNumberOfOutsidePoints(), 0);
    EXPECT_EQ(coordinates->GetNumberOfOutsidePoints(), 0);
    Worst worst;
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      worst.Take(Distance(PointOf(output, i), 2.0 * PointOf(data->GetOutput(), i)), 1e-14);
    }
    EXPECT_LE(worst.OverBound, 1.0);
  }
  EXPECT_EQ(cells, 24 * 2 * 11);
  EXPECT_EQ(map->GetNumberOfMeshBuilds(), 1);
}

TEST(Pipelines, OutputOfMeshesAloneIsPartOfTheFirstPiece)
{
  // All pieces together, for example of several processes, form one mesh.
  const MeshPair pair = MakeWidePair(915);
  const auto map = MakeFilter(Smooth, pair);
  for (const int piece : { 0, 1, 2, 0 })
  {
    const vtkIdType cells = piece == 0 ? pair.Source->GetNumberOfCells() : 0;
    map->UpdatePiece(piece, 3, 0);
    EXPECT_EQ(DataOf(map)->GetNumberOfCells(), cells);
    EXPECT_EQ(map->GetNumberOfOutsidePoints(), 0);
    vtkNew<vtkTriangularCoordinates> coordinates;
    coordinates->SetInputData(0, pair.Source);
    coordinates->UpdateInformation();
    for (const int port : { 0, 1, 2 })
    {
      vtkInformation* info = coordinates->GetOutputInformation(port);
      info->Set(Pipeline::UPDATE_PIECE_NUMBER(), piece);
      info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 3);
    }
    coordinates->Update();
    for (const int port : { 0, 1, 2 })
    {
      const vtkIdType made =
        vtkDataSet::SafeDownCast(coordinates->GetOutputDataObject(port))->GetNumberOfCells();
      EXPECT_EQ(made > 0, piece == 0) << port;
    }
  }

  // With data, the pieces are those of the data.
  const auto sphere = vtkSmartPointer<vtkSphereSource>::New();
  map->SetDataConnection(sphere->GetOutputPort());
  map->UpdatePiece(1, 2, 0);
  EXPECT_GT(DataOf(map)->GetNumberOfCells(), 0);
}

TEST(Pipelines, DataMadeFromAMeshIsPartOfTheFirstPiece)
{
  // One source of both mesh and data cannot be requested both whole and in pieces. The mesh is a
  // sphere mapped onto itself, whose source makes any piece.
  const auto counts = [](vtkAlgorithm* filter) {
    std::vector<vtkIdType> cells;
    for (const int piece : { 0, 1, 2, 0 })
    {
      EXPECT_TRUE(filter->UpdatePiece(piece, 3, 0));
      cells.push_back(DataOf(filter)->GetNumberOfCells());
    }
    return cells;
  };
  vtkNew<vtkSphereSource> mesh;
  vtkNew<vtkSphereSource> same;
  vtkNew<vtkElevationFilter> made;
  made->SetInputConnection(mesh->GetOutputPort());
  vtkNew<vtkSphereSource> other;
  mesh->Update();
  const vtkIdType whole = mesh->GetOutput()->GetNumberOfCells();
  const std::vector<vtkIdType> first{ whole, 0, 0, whole };
  for (vtkAlgorithm* data : { static_cast<vtkAlgorithm*>(mesh), static_cast<vtkAlgorithm*>(made),
         static_cast<vtkAlgorithm*>(other) })
  {
    SCOPED_TRACE(data->GetClassName());
    vtkNew<vtkDifferentiableHomeomorphism> map;
    map->SetSourceConnection(mesh->GetOutputPort());
    map->SetTargetConnection(same->GetOutputPort());
    map->SetDataConnection(data->GetOutputPort());
    vtkNew<vtkTriangularCoordinates> coordinates;
    coordinates->SetInputConnection(0, mesh->GetOutputPort());
    coordinates->SetDataConnection(data->GetOutputPort());
    coordinates->GenerateLinesOff();
    vtkNew<vtkResampleThroughHomeomorphism> resample;
    resample->SetSourceConnection(mesh->GetOutputPort());
    resample->SetTargetConnection(same->GetOutputPort());
    resample->SetGridConnection(data->GetOutputPort());
    for (vtkAlgorithm* filter : { static_cast<vtkAlgorithm*>(map),
           static_cast<vtkAlgorithm*>(coordinates), static_cast<vtkAlgorithm*>(resample) })
    {
      SCOPED_TRACE(filter->GetClassName());
      const std::vector<vtkIdType> cells = counts(filter);
      if (data != other)
      {
        EXPECT_EQ(cells, first);
        continue;
      }
      EXPECT_EQ(other->GetOutputInformation(0)->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()), 3);
      EXPECT_GT(cells[1], 0);
      EXPECT_GT(cells[2], 0);
      EXPECT_EQ(cells[0] + cells[1] + cells[2], whole);
    }
    EXPECT_EQ(map->GetNumberOfMeshBuilds(), 1);
    EXPECT_EQ(resample->GetNumberOfMeshBuilds(), 1);
  }

  // The output of a map of independent data with the same meshes comes in pieces nevertheless: the
  // first map requests its meshes whole, too.
  vtkNew<vtkDifferentiableHomeomorphism> forth;
  forth->SetSourceConnection(mesh->GetOutputPort());
  forth->SetTargetConnection(same->GetOutputPort());
  forth->SetDataConnection(other->GetOutputPort());
  vtkNew<vtkDifferentiableHomeomorphism> back;
  back->SetSourceConnection(mesh->GetOutputPort());
  back->SetTargetConnection(same->GetOutputPort());
  back->SetDataConnection(forth->GetOutputPort());
  back->InverseOn();
  const std::vector<vtkIdType> cells = counts(back);
  EXPECT_GT(cells[1], 0);
  EXPECT_EQ(cells[0] + cells[1] + cells[2], whole);
  EXPECT_EQ(back->GetNumberOfMeshBuilds(), 1);
}

TEST(Pipelines, MeasurementsArePartOfTheFirstPiece)
{
  const MeshPair pair = MakeWidePair(918);
  vtkNew<vtkJacobianContinuity> continuity;
  continuity->SetSourceData(pair.Source);
  continuity->SetTargetData(pair.Target);
  continuity->SetCoordinateSystem(vtkJacobianContinuity::LINEAR);
  continuity->Update();
  const vtkIdType edges = continuity->GetOutput()->GetNumberOfCells();
  ASSERT_GT(edges, 0);
  const auto map = MakeFilter(Linear, pair);
  map->MeasureContinuityOn();
  vtkJacobianContinuity* inner = map->GetJacobianContinuity();
  for (const int piece : { 1, 0, 2, 0 })
  {
    SCOPED_TRACE(piece);
    for (const int port : { 0, 1 })
    {
      continuity->UpdateInformation();
      vtkInformation* info = continuity->GetOutputInformation(port);
      info->Set(Pipeline::UPDATE_PIECE_NUMBER(), piece);
      info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 3);
    }
    continuity->Update(0);
    continuity->Update(1);
    const vtkIdType share = piece == 0 ? 1 : 0;
    EXPECT_EQ(continuity->GetOutput(0)->GetNumberOfCells(), share * edges);
    EXPECT_EQ(
      continuity->GetOutput(1)->GetNumberOfCells(), share * pair.Source->GetNumberOfCells());
    EXPECT_EQ(continuity->GetNumberOfCreases(), share * edges);
    EXPECT_EQ(continuity->GetLargestJump() > 0.0, piece == 0);

    map->UpdateInformation();
    vtkInformation* info = map->GetOutputInformation(1);
    info->Set(Pipeline::UPDATE_PIECE_NUMBER(), piece);
    info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 3);
    map->Update(1);
    auto* measured = vtkDataSet::SafeDownCast(map->GetOutputDataObject(1));
    EXPECT_EQ(measured->GetNumberOfCells(), share * edges);
  }
  // It was measured once for all pieces.
  EXPECT_EQ(inner->GetNumberOfCreases(), edges);
}

TEST(Pipelines, PointsOfOtherPiecesAreNotCounted)
{
  // Every other point outside belongs to another piece.
  const MeshPair pair = MakeWidePair(917);
  const auto cloud =
    MakeCloud({ { 0, 0, 0 }, { 99, 0, 0 }, { 98, 0, 0 }, { 97, 0, 0 }, { 1, 2, 0 } });
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (const int type : { 0, int(vtkDataSetAttributes::DUPLICATEPOINT), 0,
         int(vtkDataSetAttributes::HIDDENPOINT), int(vtkDataSetAttributes::DUPLICATEPOINT) })
  {
    ghosts->InsertNextValue(static_cast<unsigned char>(type));
  }
  cloud->GetPointData()->AddArray(ghosts);
  const auto map = MakeFilter(Smooth, pair, cloud);
  vtkNew<vtkTriangularCoordinates> coordinates;
  coordinates->SetInputData(0, pair.Source);
  coordinates->SetDataObject(cloud);
  vtkNew<vtkResampleThroughHomeomorphism> resample;
  resample->SetSourceData(pair.Source);
  resample->SetTargetData(pair.Target);
  resample->SetGridData(cloud);
  map->Update();
  coordinates->Update();
  resample->Update();
  // With one process, ReduceStatistics changes nothing, with a controller or without.
  vtkNew<vtkDummyController> controller;
  for (vtkMultiProcessController* reduced : { static_cast<vtkMultiProcessController*>(controller),
         static_cast<vtkMultiProcessController*>(nullptr) })
  {
    EXPECT_EQ(map->GetNumberOfOutsidePoints(), 2);
    EXPECT_EQ(coordinates->GetNumberOfOutsidePoints(), 2);
    EXPECT_EQ(resample->GetNumberOfOutsidePoints(), 2);
    map->ReduceStatistics(reduced);
    coordinates->ReduceStatistics(reduced);
    resample->ReduceStatistics(reduced);
  }
  EXPECT_EQ(map->GetNumberOfOutsidePoints(), 2);
  EXPECT_EQ(coordinates->GetNumberOfOutsidePoints(), 2);
  EXPECT_EQ(resample->GetNumberOfOutsidePoints(), 2);
  // All of them are marked and hidden.
  vtkDataArray* mask = PointArray(DataOf(map), "vtkValidPointMask");
  for (vtkIdType i = 0; i < 5; ++i)
  {
    EXPECT_EQ(mask->GetTuple1(i), i == 0 || i == 4 ? 1.0 : 0.0);
  }
}

TEST(Pipelines, MeshesMayComeFromFilters)
{
  // The target is the source moved by a pipeline, which then changes.
  const auto source = MakeClosedPair(2, 920).Source;
  vtkNew<vtkTransform> move;
  move->RotateX(40.0);
  move->Translate(1.0, 2.0, 3.0);
  vtkNew<vtkTransformPolyDataFilter> target;
  target->SetInputData(source);
  target->SetTransform(move);
  const auto cloud = MakeCloud(source, RandomSamples(source, 1000, 60));
  vtkNew<vtkDifferentiableHomeomorphism> map;
  map->SetSourceData(source);
  map->SetTargetConnection(target->GetOutputPort());
  map->SetDataObject(cloud);
  const auto worst = [&]() {
    map->Update();
    Worst result;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      Point expected = PointOf(cloud, i);
      move->TransformPoint(expected.data(), expected.data());
      result.Take(Distance(PointOf(DataOf(map), i), expected), 1e-14 * 8.0);
    }
    return result.OverBound;
  };
  EXPECT_LE(worst(), 1.0);
  EXPECT_EQ(map->GetNumberOfMeshBuilds(), 1);
  move->RotateY(20.0);
  EXPECT_LE(worst(), 1.0);
  EXPECT_EQ(map->GetNumberOfMeshBuilds(), 2);
}

// --- Time ----------------------------------------------------------------------------------------

TEST(Pipelines, TimeStepsOfTheData)
{
  const MeshPair pair = MakeWidePair(930);
  vtkNew<vtkTimeSourceExample> source;
  source->SetXAmplitude(3.0);
  source->SetYAmplitude(2.0);
  source->GrowingOn();
  source->UpdateInformation();
  vtkInformation* sourceInfo = source->GetOutputInformation(0);
  const int count = sourceInfo->Length(Pipeline::TIME_STEPS());
  ASSERT_GT(count, 3);
  const std::vector<double> steps(
    sourceInfo->Get(Pipeline::TIME_STEPS()), sourceInfo->Get(Pipeline::TIME_STEPS()) + count);
  const BothFilters filters(pair, source->GetOutputPort());
  vtkNew<vtkTimeSourceExample> alone;
  alone->SetXAmplitude(3.0);
  alone->SetYAmplitude(2.0);
  alone->GrowingOn();
  for (const std::size_t which : { 0u, 1u })
  {
    vtkAlgorithm* filter = filters.All()[which];
    filter->UpdateInformation();
    vtkInformation* info = filter->GetOutputInformation(0);
    ASSERT_EQ(info->Length(Pipeline::TIME_STEPS()), count);
    EXPECT_TRUE(std::equal(steps.begin(), steps.end(), info->Get(Pipeline::TIME_STEPS())));
    ASSERT_EQ(info->Length(Pipeline::TIME_RANGE()), 2);
    EXPECT_EQ(info->Get(Pipeline::TIME_RANGE())[1], sourceInfo->Get(Pipeline::TIME_RANGE())[1]);
    vtkIdType smallest = VTK_ID_MAX;
    vtkIdType largest = 0;
    for (const double time : steps)
    {
      ASSERT_TRUE(filter->UpdateTimeStep(time));
      alone->UpdateTimeStep(time);
      vtkDataSet* output = DataOf(filter);
      EXPECT_EQ(output->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
      vtkNew<vtkUnstructuredGrid> copy;
      copy->DeepCopy(alone->GetOutput());
      const auto expectedMap = MakeFilter(Smooth, pair, copy);
      vtkNew<vtkTriangularCoordinates> expectedCoordinates;
      expectedCoordinates->SetInputData(0, pair.Source);
      expectedCoordinates->SetDataObject(copy);
      vtkAlgorithm* expected =
        which == 0 ? static_cast<vtkAlgorithm*>(expectedMap) : expectedCoordinates;
      expected->Update();
      EXPECT_EQ(CountDifferentValues(ResultOf(filter), ResultOf(expected)), 0) << time;
      smallest = std::min(smallest, output->GetNumberOfCells());
      largest = std::max(largest, output->GetNumberOfCells());
    }
    EXPECT_LT(smallest, largest);
  }
  // The meshes are static.
  EXPECT_EQ(filters.Map->GetNumberOfMeshBuilds(), 1);
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

std::vector<double> TimesOf(vtkAlgorithm* filter, int port)
{
  vtkInformation* info = filter->GetOutputInformation(port);
  const double* times = info->Get(Pipeline::TIME_STEPS());
  return { times, times + info->Length(Pipeline::TIME_STEPS()) };
}

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
    vtkNew<vtkResampleThroughHomeomorphism> resample;
    resample->SetSourceData(pair.Source);
    resample->SetTargetData(pair.Target);
    resample->SetInputConnection(moving, mesh->GetOutputPort());
    vtkNew<vtkJacobianContinuity> continuity;
    continuity->SetSourceData(pair.Source);
    continuity->SetTargetData(pair.Target);
    continuity->SetInputConnection(moving, mesh->GetOutputPort());
    vtkIdType builds = 0;
    // Also backward in time, because only the last result is kept.
    for (const double time : { 0.0, 1.0, 2.5, 1.0 })
    {
      SCOPED_TRACE(time);
      map->UpdateInformation();
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
      EXPECT_EQ(
        CountDifferentValues(continuity->GetOutput()->GetCellData()->GetArray("JacobianJump"),
          measured->GetCellData()->GetArray("JacobianJump")),
        0);
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
    map->UpdateInformation();
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
    map->UpdateInformation();
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

/// A grid inside the square with more points than one block.
vtkSmartPointer<vtkImageData> MakeLargeImage()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(640, 640, 1);
  image->SetOrigin(-11.0, -11.0, 0.0);
  image->SetSpacing(22.0 / 639.0, 22.0 / 639.0, 1.0);
  return image;
}

// --- Aborting ------------------------------------------------------------------------------------

/// Requests an abort when the progress of an algorithm has reached some value.
class AbortAt
{
public:
  AbortAt(vtkAlgorithm* algorithm, double progress)
    : Algorithm(algorithm)
    , Progress(progress)
    , Tag(algorithm->AddObserver(vtkCommand::ProgressEvent, this, &AbortAt::Check))
  {
  }
  ~AbortAt()
  {
    this->Algorithm->RemoveObserver(this->Tag);
    // The executive does it before VTK 9.3 only.
    this->Algorithm->AbortExecuteOff();
  }
  AbortAt(const AbortAt&) = delete;
  void operator=(const AbortAt&) = delete;

private:
  void Check()
  {
    if (this->Algorithm->GetProgress() >= this->Progress)
    {
      this->Algorithm->AbortExecuteOn();
    }
  }
  vtkAlgorithm* Algorithm;
  double Progress;
  unsigned long Tag;
};

TEST(Pipelines, AnAbortedMapIsMarkedAsIncomplete)
{
  const MeshPair pair = MakeWidePair(940);
  const auto image = MakeLargeImage();
  image->GetPointData()->SetVectors(RandomArray("Vectors", 3, image->GetNumberOfPoints(), 61));
  image->GetCellData()->SetVectors(RandomArray("Flux", 3, image->GetNumberOfCells(), 62));
  const auto complete = MakeFilter(Smooth, pair, image);
  vtkPointSet* whole = Output(complete);
  EXPECT_EQ(complete->GetNumberOfOutsidePoints(), 0);

  const auto filter = MakeFilter(Smooth, pair, image);
  Messages messages(filter);
  {
    const AbortAt abort(filter, 0.4);
    filter->Update();
  }
  vtkPointSet* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_FALSE(messages.HasError());
  if (KeepsAbortedOutput(output, image->GetNumberOfPoints()))
  {
    vtkIdType mapped = 0;
    vtkIdType wrong = 0;
    vtkDataArray* ghosts = PointArray(output, vtkDataSetAttributes::GhostArrayName());
    ASSERT_TRUE(ghosts);
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      const bool isDone = PointArray(output, "vtkValidPointMask")->GetComponent(i, 0) != 0.0;
      mapped += isDone;
      wrong += PointOf(output, i) != (isDone ? PointOf(whole, i) : PointOf(image, i));
      wrong += std::isnan(PointArray(output, "Vectors")->GetComponent(i, 0)) == isDone;
      wrong += (ghosts->GetComponent(i, 0) != 0.0) == isDone;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(mapped, 0);
    EXPECT_LT(mapped, image->GetNumberOfPoints());
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), image->GetNumberOfPoints() - mapped);
  }

  // The next execution starts again.
  filter->Modified();
  EXPECT_EQ(CountDifferentPoints(Output(filter), whole), 0);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
  EXPECT_EQ(
    CountDifferentValues(PointArray(Output(filter), "Vectors"), PointArray(whole, "Vectors")), 0);
  EXPECT_EQ(CountDifferentValues(
              Output(filter)->GetCellData()->GetVectors(), whole->GetCellData()->GetVectors()),
    0);
}

TEST(Pipelines, AbortedCoordinatesAreMarkedAsIncomplete)
{
  const MeshPair pair = MakeWidePair(945);
  const auto image = MakeLargeImage();
  vtkNew<vtkTriangularCoordinates> filter;
  filter->SetInputData(0, pair.Source);
  filter->SetDataObject(image);
  {
    const AbortAt abort(filter, 0.4);
    filter->Update();
  }
  vtkDataSet* output = DataOf(filter);
  if (KeepsAbortedOutput(output, image->GetNumberOfPoints()))
  {
    const vtkIdType outside = filter->GetNumberOfOutsidePoints();
    EXPECT_GT(outside, 0);
    EXPECT_LT(outside, image->GetNumberOfPoints());
    vtkIdType wrong = 0;
    vtkIdType missing = 0;
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      const bool isDone = PointArray(output, "vtkValidPointMask")->GetComponent(i, 0) != 0.0;
      missing += !isDone;
      wrong += (PointArray(output, "TriangleId")->GetComponent(i, 0) >= 0) != isDone;
      wrong += std::isnan(PointArray(output, "ContourParameter")->GetComponent(i, 0)) == isDone;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(missing, outside);
  }
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
}

TEST(Pipelines, ProgressRisesToOne)
{
  const MeshPair pair = MakeWidePair(950);
  const auto image = MakeLargeImage();
  vtkNew<vtkMultiBlockDataSet> tree;
  tree->SetBlock(0, image);
  tree->SetBlock(1, image);
  vtkNew<vtkTriangularCoordinates> coordinates;
  coordinates->SetInputData(0, pair.Source);
  const auto map = MakeFilter(Smooth, pair);
  for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ map, coordinates })
  {
    for (vtkDataObject* data : std::initializer_list<vtkDataObject*>{ image, tree })
    {
      struct Record
      {
        void Add() { this->Values.push_back(this->Algorithm->GetProgress()); }
        vtkAlgorithm* Algorithm;
        std::vector<double> Values;
      } record{ filter, {} };
      filter->SetInputDataObject(filter == map ? 2 : 1, data);
      const unsigned long tag =
        filter->AddObserver(vtkCommand::ProgressEvent, &record, &Record::Add);
      filter->Update();
      filter->RemoveObserver(tag);
      ASSERT_GT(record.Values.size(), 4u);
      EXPECT_EQ(record.Values.back(), 1.0);
      EXPECT_GE(record.Values.front(), 0.0);
      EXPECT_TRUE(std::is_sorted(record.Values.begin(), record.Values.end()))
        << filter->GetClassName() << " " << data->GetClassName();
    }
  }
}

} // namespace
