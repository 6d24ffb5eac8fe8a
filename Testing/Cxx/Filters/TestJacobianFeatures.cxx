// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The verdicts of the filter agree with the theorems for every kind of feature, and with the
// numbers of Documentation/differentiability.md.

#include "Fixtures/FilterRuns.h"
#include "Fixtures/MeasuredMaps.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkJacobianContinuity.h"
#include "vtkPointData.h"
#include "vtkSMPTools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace
{

using namespace fixtures;
using fixtures::Moved;
using Continuity = vtkJacobianContinuity;

void AskForEverything(Continuity* filter)
{
  filter->BoundaryEdgesOn();
  filter->SpokesOn();
  filter->WingSegmentsOn();
  filter->CenterSegmentsOn();
  filter->StripBordersOn();
  filter->CentroidsOn();
  filter->VerticesOn();
}

vtkSmartPointer<Continuity> MeasureEverything(
  vtkPolyData* source, vtkPolyData* target, int coordinateSystem)
{
  auto filter = vtkSmartPointer<Continuity>::New();
  filter->SetSourceData(source);
  filter->SetTargetData(target);
  filter->SetCoordinateSystem(coordinateSystem);
  AskForEverything(filter);
  filter->Update();
  return filter;
}

double CellValue(Continuity* filter, const char* name, vtkIdType cell)
{
  return filter->GetOutput()->GetCellData()->GetArray(name)->GetTuple1(cell);
}

/// The numbers of features of a type with each verdict.
std::array<vtkIdType, 3> Count(Continuity* filter, int featureType)
{
  return { filter->GetNumberOfFeatures(featureType, Continuity::DIFFERENTIABLE),
    filter->GetNumberOfFeatures(featureType, Continuity::CREASE),
    filter->GetNumberOfFeatures(featureType, Continuity::UNDECIDED) };
}

/// Cells of a type.
std::vector<vtkIdType> CellsOf(Continuity* filter, int featureType)
{
  std::vector<vtkIdType> cells;
  for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfCells(); ++i)
  {
    if (CellValue(filter, "FeatureType", i) == featureType)
    {
      cells.push_back(i);
    }
  }
  return cells;
}

void ExpectAllDifferentiable(Continuity* filter)
{
  for (int type = 0; type <= Continuity::VERTEX; ++type)
  {
    SCOPED_TRACE("places of type " + std::to_string(type));
    EXPECT_EQ(Count(filter, type)[Continuity::CREASE], 0);
    if (type != Continuity::BOUNDARY_EDGE)
    {
      EXPECT_GT(Count(filter, type)[Continuity::DIFFERENTIABLE], 0);
    }
    EXPECT_EQ(Count(filter, type)[Continuity::UNDECIDED], 0);
  }
}

// --- Features ------------------------------------------------------------------------------------

TEST(JacobianFeatures, AllFeaturesAreListed)
{
  const MeshPair pair = MakePlanarPair(6, 5, 0.15);
  const auto filter = MeasureEverything(pair.Source, pair.Target, Continuity::SMOOTH);
  const vtkIdType triangles = pair.Source->GetNumberOfCells();
  const auto boundary = static_cast<std::size_t>(filter->GetNumberOfBoundaryEdges());
  EXPECT_EQ(boundary, 24u);
  const auto interior = (3u * triangles - boundary) / 2u;
  EXPECT_EQ(CellsOf(filter, Continuity::EDGE).size(), interior);
  EXPECT_EQ(CellsOf(filter, Continuity::BOUNDARY_EDGE).size(), boundary);
  EXPECT_EQ(CellsOf(filter, Continuity::SPOKE).size(), 3u * triangles);
  EXPECT_EQ(CellsOf(filter, Continuity::WING_SEGMENT).size(), 6u * triangles);
  EXPECT_EQ(CellsOf(filter, Continuity::CENTER_SEGMENT).size(), 3u * triangles);
  EXPECT_EQ(CellsOf(filter, Continuity::STRIP_BORDER).size(), 2u * interior);
  EXPECT_EQ(CellsOf(filter, Continuity::TRIANGLE_CENTER).size(), 1u * triangles);
  EXPECT_EQ(CellsOf(filter, Continuity::VERTEX).size(), 49u);
  // The cells have the dimension of their feature; points come first.
  vtkPolyData* output = filter->GetOutput();
  for (vtkIdType i = 0; i < output->GetNumberOfCells(); ++i)
  {
    const auto type = static_cast<int>(CellValue(filter, "FeatureType", i));
    const bool point = type == Continuity::TRIANGLE_CENTER || type == Continuity::VERTEX;
    EXPECT_EQ(output->GetCellType(i),
      point                                 ? VTK_VERTEX
        : type == Continuity::BOUNDARY_EDGE ? VTK_LINE
                                            : VTK_POLY_LINE);
  }
}

TEST(JacobianFeatures, BoundaryEdgesHaveNoJump)
{
  const MeshPair pair = MakePlanarPair(4, 5, 0.15);
  const auto filter = MeasureEverything(pair.Source, pair.Target, Continuity::LINEAR);
  for (const vtkIdType cell : CellsOf(filter, Continuity::BOUNDARY_EDGE))
  {
    EXPECT_EQ(CellValue(filter, "Verdict", cell), Continuity::NOTHING_TO_COMPARE);
    EXPECT_TRUE(std::isnan(CellValue(filter, "JacobianJump", cell)));
    EXPECT_TRUE(std::isnan(CellValue(filter, "JacobianJumpExact", cell)));
    double triangles[2];
    filter->GetOutput()->GetCellData()->GetArray("EdgeTriangles")->GetTuple(cell, triangles);
    EXPECT_GE(triangles[0], 0.0);
    EXPECT_EQ(triangles[1], -1.0);
    double bounds[6];
    filter->GetOutput()->GetCellBounds(cell, bounds);
    const bool onSquare = (bounds[0] == bounds[1] && (bounds[0] == 0.0 || bounds[0] == 4.0)) ||
      (bounds[2] == bounds[3] && (bounds[2] == 0.0 || bounds[2] == 4.0));
    EXPECT_TRUE(onSquare);
  }
}

TEST(JacobianFeatures, ALoneTriangleHasNoJump)
{
  const auto triangle = MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } });
  vtkNew<Continuity> filter;
  filter->SetSourceData(triangle);
  filter->SetTargetData(triangle);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  auto* colored = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  EXPECT_TRUE(std::isnan(colored->GetCellData()->GetArray("JacobianJump")->GetTuple1(0)));
  EXPECT_TRUE(std::isnan(colored->GetPointData()->GetArray("JacobianJump")->GetTuple1(0)));
}

TEST(JacobianFeatures, LinesHaveTheirPositions)
{
  // The centroid is (1, 1). Its feet are (1, 0), (0, 1) and (1.5, 1.5).
  const auto triangle = MakeMesh({ { 0, 0, 0 }, { 3, 0, 0 }, { 0, 3, 0 } }, { { 0, 1, 2 } });
  const auto filter = MeasureEverything(triangle, triangle, Continuity::CONTOUR);
  const auto ends = [&filter](vtkIdType cell) {
    vtkIdType count;
    const vtkIdType* ids;
    filter->GetOutput()->GetCellPoints(cell, count, ids);
    const auto rounded = [&filter](vtkIdType id) {
      double p[3];
      filter->GetOutput()->GetPoint(id, p);
      return std::pair<double, double>{ std::round(1e9 * p[0]) / 1e9,
        std::round(1e9 * p[1]) / 1e9 };
    };
    return std::make_pair(rounded(ids[0]), rounded(ids[count - 1]));
  };
  using Ends = std::set<std::pair<std::pair<double, double>, std::pair<double, double>>>;
  const auto all = [&](int type) {
    Ends result;
    for (const vtkIdType cell : CellsOf(filter, type))
    {
      result.insert(ends(cell));
    }
    return result;
  };
  EXPECT_EQ(all(Continuity::SPOKE),
    (Ends{ { { 1, 1 }, { 0, 0 } }, { { 1, 1 }, { 3, 0 } }, { { 1, 1 }, { 0, 3 } } }));
  EXPECT_EQ(all(Continuity::CENTER_SEGMENT),
    (Ends{ { { 1, 1 }, { 1, 0 } }, { { 1, 1 }, { 0, 1 } }, { { 1, 1 }, { 1.5, 1.5 } } }));
  EXPECT_EQ(all(Continuity::WING_SEGMENT),
    (Ends{ { { 1, 0.5 }, { 0, 0 } }, { { 1, 0.5 }, { 3, 0 } }, { { 0.5, 1 }, { 0, 0 } },
      { { 0.5, 1 }, { 0, 3 } }, { { 1.25, 1.25 }, { 3, 0 } }, { { 1.25, 1.25 }, { 0, 3 } } }));
  EXPECT_TRUE(all(Continuity::STRIP_BORDER).empty());
}

TEST(JacobianFeatures, ATriangleWithoutAFootHasNoSegment)
{
  // The foot on the first edge is outside it.
  const auto triangle = MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 4, 1, 0 } }, { { 0, 1, 2 } });
  vtkNew<Continuity> filter;
  filter->SetSourceData(triangle);
  filter->SetTargetData(triangle);
  filter->SetCoordinateSystem(Continuity::CONTOUR);
  filter->SetDiscordantTriangles(Continuity::USE_LINEAR);
  AskForEverything(filter);
  filter->Update();
  const std::size_t feet = CellsOf(filter, Continuity::CENTER_SEGMENT).size();
  EXPECT_LT(feet, 3u);
  EXPECT_EQ(CellsOf(filter, Continuity::WING_SEGMENT).size(), 2 * feet);
  EXPECT_EQ(CellsOf(filter, Continuity::SPOKE).size(), 3u);
  filter->SetCenterPoint(Continuity::INCENTER);
  filter->Update();
  EXPECT_EQ(CellsOf(filter, Continuity::CENTER_SEGMENT).size(), 3u);
}

// --- Verdicts ------------------------------------------------------------------------------------

TEST(JacobianFeatures, SimilarPairsAreDifferentiableEverywhere)
{
  const auto source = MakeMesh(GridPoints(8, 4, 0.15), GridTriangles(8));
  const auto turned = Moved(source, [](const Point& p) -> Point {
    return { 3.0 * p[0] - 4.0 * p[1] + 1.0, 4.0 * p[0] + 3.0 * p[1], 0.0 };
  });
  for (int system = 0; system < 3; ++system)
  {
    SCOPED_TRACE("system " + std::to_string(system));
    ExpectAllDifferentiable(MeasureEverything(source, turned, system));
  }
}

TEST(JacobianFeatures, AffinePairsAreDifferentiableInLinearAndSmoothOnly)
{
  const auto source = MakeMesh(GridPoints(8, 4, 0.15), GridTriangles(8));
  const auto stretched = Moved(source, [](const Point& p) -> Point {
    return { 1.3 * p[0] + 0.2 * p[1], 0.1 * p[0] + 0.9 * p[1], 0.0 };
  });
  ExpectAllDifferentiable(MeasureEverything(source, stretched, Continuity::LINEAR));
  ExpectAllDifferentiable(MeasureEverything(source, stretched, Continuity::SMOOTH));
  const auto contour = MeasureEverything(source, stretched, Continuity::CONTOUR);
  for (const int type :
    { Continuity::EDGE, Continuity::SPOKE, Continuity::TRIANGLE_CENTER, Continuity::VERTEX })
  {
    EXPECT_EQ(Count(contour, type)[Continuity::DIFFERENTIABLE], 0) << "type " << type;
  }
}

TEST(JacobianFeatures, AnyTransformIsMeasuredAtAllFeatures)
{
  const MeshPair pair = MakePlanarPair(8, 9, 0.15);
  vtkNew<Continuity> filter;
  filter->SetSourceData(pair.Source);
  filter->SetTransform(MakeThinPlateSpline(pair, 7));
  AskForEverything(filter);
  filter->Update();
  ExpectAllDifferentiable(filter);

  // A crease along a line of the grid, hence at the points on it.
  vtkNew<PiecewiseMap> pieces;
  pieces->Amount = 0.2;
  filter->SetSourceData(RegularGrid(9));
  filter->SetTransform(pieces);
  filter->Update();
  EXPECT_EQ(Count(filter, Continuity::EDGE)[Continuity::CREASE], 9);
  // Also at the ends of the line, where half of the directions are inside.
  EXPECT_EQ(Count(filter, Continuity::VERTEX)[Continuity::CREASE], 10);
  for (const int type : { Continuity::SPOKE, Continuity::WING_SEGMENT, Continuity::CENTER_SEGMENT,
         Continuity::STRIP_BORDER, Continuity::TRIANGLE_CENTER })
  {
    EXPECT_EQ(Count(filter, type)[Continuity::CREASE], 0) << "type " << type;
  }
}

TEST(JacobianFeatures, ContourIsOnceDifferentiableAcrossWingSegmentsOnly)
{
  const MeshPair pair = MakePlanarPair(6, 5, 0.15);
  vtkNew<Continuity> filter;
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->SetCoordinateSystem(Continuity::CONTOUR);
  filter->WingSegmentsOn();
  filter->SecondDerivativesOn();
  filter->Update();
  vtkIdType creases = 0;
  const auto wings = CellsOf(filter, Continuity::WING_SEGMENT);
  for (const vtkIdType cell : wings)
  {
    EXPECT_NE(CellValue(filter, "Verdict", cell), Continuity::CREASE);
    creases += CellValue(filter, "SecondDerivativeVerdict", cell) == Continuity::CREASE;
  }
  // Except in the two triangles that are the same in both meshes.
  EXPECT_GT(creases, 0.9 * static_cast<double>(wings.size()));
}

TEST(JacobianFeatures, SmoothIsTwiceDifferentiableWithinTriangles)
{
  const MeshPair pair = MakePlanarPair(6, 5);
  vtkNew<Continuity> filter;
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->StripBordersOn();
  filter->SpokesOn();
  filter->SecondDerivativesOn();
  filter->Update();
  vtkIdType decided = 0;
  for (vtkIdType cell = 0; cell < filter->GetOutput()->GetNumberOfCells(); ++cell)
  {
    EXPECT_NE(CellValue(filter, "Verdict", cell), Continuity::CREASE);
    EXPECT_NE(CellValue(filter, "SecondDerivativeVerdict", cell), Continuity::CREASE);
    decided += CellValue(filter, "Verdict", cell) == Continuity::DIFFERENTIABLE;
  }
  EXPECT_GE(100 * decided, 98 * filter->GetOutput()->GetNumberOfCells());
}

TEST(JacobianFeatures, VerticesOfSurfacesAreNotMeasured)
{
  const MeshPair pair = MakeClosedPair(1, 3);
  vtkNew<Continuity> filter;
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->VerticesOn();
  filter->CentroidsOn();
  filter->SpokesOn();
  filter->Update();
  const auto vertices = CellsOf(filter, Continuity::VERTEX);
  EXPECT_EQ(vertices.size(), static_cast<std::size_t>(pair.Source->GetNumberOfPoints()));
  for (const vtkIdType cell : vertices)
  {
    EXPECT_EQ(CellValue(filter, "Verdict", cell), Continuity::NOTHING_TO_COMPARE);
    EXPECT_TRUE(std::isnan(CellValue(filter, "JacobianJump", cell)));
  }
  EXPECT_EQ(Count(filter, Continuity::TRIANGLE_CENTER)[Continuity::DIFFERENTIABLE],
    pair.Source->GetNumberOfCells());
  EXPECT_EQ(Count(filter, Continuity::SPOKE)[Continuity::DIFFERENTIABLE],
    3 * pair.Source->GetNumberOfCells());
}

TEST(JacobianFeatures, ResultsDoNotDependOnThreads)
{
  const MeshPair pair = MakePlanarPair(8, 5, 0.15);
  const auto values = [&pair](int threads) {
    std::vector<double> result;
    vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads }, [&]() {
      const auto filter = MeasureEverything(pair.Source, pair.Target, Continuity::CONTOUR);
      vtkDataArray* jump = filter->GetOutput()->GetPointData()->GetArray("JacobianJump");
      for (vtkIdType i = 0; i < jump->GetNumberOfTuples(); ++i)
      {
        result.push_back(std::isnan(jump->GetTuple1(i)) ? -1.0 : jump->GetTuple1(i));
      }
    });
    return result;
  };
  EXPECT_EQ(values(1), values(2));
}

// --- The second output of vtkDifferentiableHomeomorphism -----------------------------------------

TEST(JacobianFeatures, TheHomeomorphismFilterMeasuresTheSame)
{
  const MeshPair pair = MakePlanarPair(5, 2, 0.15);
  for (const bool inverse : { false, true })
  {
    vtkNew<vtkDifferentiableHomeomorphism> map;
    map->SetSourceData(pair.Source);
    map->SetTargetData(pair.Target);
    map->SetCoordinateSystemToContour();
    map->SetInverse(inverse);
    map->Update();
    auto* measured = vtkPolyData::SafeDownCast(map->GetOutputDataObject(1));
    EXPECT_EQ(measured->GetNumberOfCells(), 0);

    map->MeasureContinuityOn();
    map->GetJacobianContinuity()->SpokesOn();
    double lastProgress = 0.0;
    bool backwards = false;
    vtkNew<vtkCallbackCommand> progress;
    std::pair<double*, bool*> seen{ &lastProgress, &backwards };
    progress->SetClientData(&seen);
    progress->SetCallback([](vtkObject* caller, unsigned long, void* client, void*) {
      auto& state = *static_cast<std::pair<double*, bool*>*>(client);
      const double now = vtkAlgorithm::SafeDownCast(caller)->GetProgress();
      *state.second = *state.second || now < *state.first;
      *state.first = now;
    });
    map->AddObserver(vtkCommand::ProgressEvent, progress);
    map->Update();
    EXPECT_FALSE(backwards);
    EXPECT_EQ(lastProgress, 1.0);

    vtkNew<Continuity> alone;
    alone->SetSourceData(inverse ? pair.Target : pair.Source);
    alone->SetTargetData(inverse ? pair.Source : pair.Target);
    alone->SetCoordinateSystem(Continuity::CONTOUR);
    alone->SpokesOn();
    alone->Update();
    ASSERT_EQ(measured->GetNumberOfCells(), alone->GetOutput()->GetNumberOfCells());
    for (vtkIdType i = 0; i < measured->GetNumberOfCells(); ++i)
    {
      EXPECT_EQ(measured->GetCellData()->GetArray("JacobianJump")->GetTuple1(i),
        CellValue(alone, "JacobianJump", i));
    }
    EXPECT_EQ(map->GetJacobianContinuity()->GetNumberOfCreases(), alone->GetNumberOfCreases());

    // New data does not repeat the measurement. An option of the inner filter does.
    const vtkMTimeType before = map->GetJacobianContinuity()->GetOutput()->GetMTime();
    map->SetDataObject(fixtures::MakeCloud({ { 1.0, 1.0, 0.0 } }));
    map->Update();
    EXPECT_EQ(map->GetJacobianContinuity()->GetOutput()->GetMTime(), before);
    EXPECT_EQ(map->GetNumberOfMeshBuilds(), 1);
    map->GetJacobianContinuity()->SpokesOff();
    map->Update();
    EXPECT_LT(map->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL),
      alone->GetOutput()->GetNumberOfCells());
  }
}

TEST(JacobianFeatures, AnAbortedMeasurementIsRepeated)
{
  const MeshPair pair = MakePlanarPair(40, 2);
  const auto map = fixtures::MakeFilter(fixtures::Smooth, pair);
  map->MeasureContinuityOn();
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    auto* algorithm = vtkAlgorithm::SafeDownCast(caller);
    algorithm->SetAbortExecute(algorithm->GetProgress() > 0.2);
  });
  const unsigned long observer = map->AddObserver(vtkCommand::ProgressEvent, abort);
  map->Update();
  EXPECT_EQ(map->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL), 0);
  map->RemoveObserver(observer);
  map->SetAbortExecute(0);
  map->Modified();
  map->Update();
  EXPECT_EQ(map->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL), 3 * 1600 - 80);
}

TEST(JacobianFeatures, TheHomeomorphismIsNotComputedTwice)
{
  const MeshPair pair = MakePlanarPair(3, 2);
  const auto map = fixtures::MakeFilter(fixtures::Smooth, pair);
  map->MeasureContinuityOn();
  map->Update();
  const vtkMTimeType output = map->GetOutputDataObject(0)->GetMTime();
  map->Update();
  EXPECT_EQ(map->GetOutputDataObject(0)->GetMTime(), output);
}

} // namespace
