// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkIsomorphicTriangulation.h"

#include "Mesh/TriangulationPair.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDifferentiableHomeomorphism.h"
#include "vtkExecutive.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace
{

using Point = std::array<double, 3>;
using Filter = vtkIsomorphicTriangulation;

/// Corresponding points of a lattice that a map bends a little.
std::vector<Point> Lattice(const std::function<Point(double, double)>& map)
{
  std::vector<Point> points;
  for (int i = 0; i < 5; ++i)
  {
    for (int k = 0; k < 5; ++k)
    {
      points.push_back(map(i + 0.1 * k, k - 0.13 * i));
    }
  }
  return points;
}

Point Bent(double x, double y)
{
  return { x + 0.2 * std::sin(y), y + 0.2 * std::sin(x), 0.0 };
}

struct Cells
{
  std::vector<std::vector<vtkIdType>> Lines;
  std::vector<std::vector<vtkIdType>> Polygons;
};

vtkSmartPointer<vtkPolyData> Figure(
  const std::vector<Point>& positions, const Cells& cells, int type)
{
  auto figure = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(type);
  for (const Point& p : positions)
  {
    points->InsertNextPoint(p.data());
  }
  figure->SetPoints(points);
  vtkNew<vtkCellArray> lines;
  for (const auto& ids : cells.Lines)
  {
    lines->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }
  figure->SetLines(lines);
  vtkNew<vtkCellArray> polygons;
  for (const auto& ids : cells.Polygons)
  {
    polygons->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }
  figure->SetPolys(polygons);
  return figure;
}

/// A filter with its inputs that keeps its messages to itself.
struct PairRun
{
  PairRun(const std::vector<Point>& source, const std::vector<Point>& target,
    const Cells& cells = {}, const Cells* targetCells = nullptr, int type = VTK_DOUBLE)
    : Source(Figure(source, cells, type))
    , Target(Figure(target, targetCells ? *targetCells : cells, type))
  {
    this->Pair->SetSourceData(this->Source);
    this->Pair->SetTargetData(this->Target);
    this->Pair->AddObserver(vtkCommand::ErrorEvent, this, &PairRun::Count);
    this->Pair->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, this, &PairRun::Ignore);
  }

  void Count(vtkObject*, unsigned long, void*) { ++this->Errors; }
  void Ignore(vtkObject*, unsigned long, void*) {}

  /// The kind of the first problem.
  int Refusal()
  {
    this->Pair->Update();
    EXPECT_EQ(1, this->Errors);
    EXPECT_EQ(0, this->Pair->GetOutput()->GetNumberOfCells());
    EXPECT_LT(0, this->Pair->GetNumberOfProblems());
    if (this->Pair->GetNumberOfProblems() == 0)
    {
      return -1;
    }
    EXPECT_FALSE(this->Pair->GetProblemMessage(0).empty());
    return this->Pair->GetProblemKind(0);
  }

  std::vector<vtkIdType> Points(int problem = 0)
  {
    vtkNew<vtkIdList> ids;
    this->Pair->GetProblemPoints(problem, ids);
    return { ids->begin(), ids->end() };
  }

  vtkSmartPointer<vtkPolyData> Source;
  vtkSmartPointer<vtkPolyData> Target;
  vtkNew<vtkIsomorphicTriangulation> Pair;
  int Errors = 0;
};

const std::vector<Point> Square{ { 0, 0, 0 }, { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 }, { 1, 1, 0 },
  { 3, 1, 0 }, { 2, 3, 0 } };
const Cells Outline{ {}, { { 0, 1, 2, 3 } } };

Cells With(const std::vector<std::vector<vtkIdType>>& lines)
{
  return { lines, Outline.Polygons };
}

using Ids = std::vector<vtkIdType>;

TEST(IsomorphicTriangulationFilter, MakesPairsThatOtherFiltersTake)
{
  PairRun run(Lattice([](double x, double y) {
    return Point{ x, y, 0.0 };
  }),
    Lattice(Bent), {}, nullptr, VTK_FLOAT);
  vtkNew<vtkDifferentiableHomeomorphism> map;
  map->SetDataObject(run.Source);
  map->SetSourceConnection(run.Pair->GetOutputPort(0));
  map->SetTargetConnection(run.Pair->GetOutputPort(1));
  map->Update();
  EXPECT_EQ(0, run.Errors);
  EXPECT_EQ(0, run.Pair->GetNumberOfAddedPoints());
  // The map takes landmarks to landmarks.
  vtkPolyData* mapped = vtkPolyData::SafeDownCast(map->GetOutput());
  ASSERT_NE(nullptr, mapped);
  ASSERT_EQ(25, mapped->GetNumberOfPoints());
  for (vtkIdType i = 0; i < 25; ++i)
  {
    Point expected;
    Point found;
    run.Target->GetPoint(i, expected.data());
    mapped->GetPoint(i, found.data());
    EXPECT_NEAR(expected[0], found[0], 1e-6) << i;
    EXPECT_NEAR(expected[1], found[1], 1e-6) << i;
  }
  vtkPolyData* source = run.Pair->GetOutput();
  EXPECT_EQ(VTK_DOUBLE, source->GetPoints()->GetDataType());
  EXPECT_EQ(run.Pair->GetTargetOutput()->GetNumberOfCells(), source->GetNumberOfCells());
  vtkDataArray* ids = source->GetPointData()->GetArray("OriginalPointId");
  vtkDataArray* residuals = source->GetPointData()->GetArray("LandmarkResidual");
  ASSERT_NE(nullptr, ids);
  ASSERT_NE(nullptr, residuals);
  EXPECT_EQ(24, ids->GetTuple1(24));
  EXPECT_EQ(-1, ids->GetTuple1(25));
  EXPECT_TRUE(std::isnan(residuals->GetTuple1(25)));
  vtkDataArray* angles = source->GetCellData()->GetArray("MinimumAngle");
  ASSERT_NE(nullptr, angles);
  ASSERT_NE(nullptr, source->GetCellData()->GetArray("Distortion"));
  EXPECT_NEAR(std::min(run.Pair->GetSmallestAngles()[0], run.Pair->GetSmallestAngles()[1]),
    angles->GetRange()[0], 1e-12);
  EXPECT_NEAR(run.Pair->GetLargestDistortion(),
    source->GetCellData()->GetArray("Distortion")->GetRange()[1], 1e-12);
}

TEST(IsomorphicTriangulationFilter, FiguresInAnyPlanes)
{
  // The source stands upright, the target is tilted.
  PairRun run(Lattice([](double x, double y) {
    return Point{ 7.0, x, y };
  }),
    Lattice([](double x, double y) {
      const Point p = Bent(x, y);
      return Point{ 5.0 + 0.6 * p[0], 3.0 - p[1], 0.8 * p[0] };
    }));
  run.Pair->Update();
  EXPECT_EQ(0, run.Errors);
  homeomorphism::MeshDiagnostics problems;
  EXPECT_NE(nullptr,
    homeomorphism::TriangulationPair::Read(
      run.Pair->GetOutput(), run.Pair->GetTargetOutput(), false, problems));
  EXPECT_TRUE(problems.empty());
}

TEST(IsomorphicTriangulationFilter, SegmentsOfLoopsAndLines)
{
  // The outline as single line cells; one line is a constraint.
  const Cells cells{ { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 6 } }, {} };
  PairRun run(Square, Square, cells);
  run.Pair->Update();
  EXPECT_EQ(0, run.Errors);
  EXPECT_EQ(7, run.Pair->GetOutput()->GetNumberOfPoints());
  EXPECT_EQ(1, run.Pair->GetSourceSegments()->GetNumberOfLines());
  EXPECT_EQ(1, run.Pair->GetTargetSegments()->GetNumberOfLines());
}

TEST(IsomorphicTriangulationFilter, SuspiciousLandmarksAreListed)
{
  std::vector<Point> target = Lattice(Bent);
  target[12][0] += 0.7;
  PairRun run(Lattice([](double x, double y) { return Point{ x, y, 0.0 }; }), target);
  run.Pair->Update();
  vtkNew<vtkIdList> worst;
  run.Pair->GetSuspiciousLandmarks(worst);
  ASSERT_EQ(10, worst->GetNumberOfIds());
  EXPECT_EQ(12, worst->GetId(0));
}

TEST(IsomorphicTriangulationFilter, FramesOfImages)
{
  PairRun run(Lattice([](double x, double y) { return Point{ x, 10.0 - y, 0.0 }; }), Lattice(Bent));
  run.Pair->SetSourceFrame(-2, 8, 0, 20);
  run.Pair->SetTargetFrame(-3, 9, -9, 11);
  run.Pair->Update();
  EXPECT_EQ(0, run.Errors);
  EXPECT_TRUE(run.Pair->GetMirrored());
  const double* bounds = run.Pair->GetTargetOutput()->GetBounds();
  EXPECT_EQ(-9, bounds[2]);
  EXPECT_EQ(11, bounds[3]);
}

TEST(IsomorphicTriangulationRefusals, Empty)
{
  EXPECT_EQ(Filter::EMPTY, PairRun({}, {}).Refusal());
}

TEST(IsomorphicTriangulationRefusals, DifferentPoints)
{
  std::vector<Point> target = Square;
  target.pop_back();
  EXPECT_EQ(Filter::POINT_COUNTS_DIFFER, PairRun(Square, target).Refusal());
}

TEST(IsomorphicTriangulationRefusals, DifferentCells)
{
  const Cells other = With({ { 4, 6 } });
  EXPECT_EQ(Filter::CELLS_DIFFER, PairRun(Square, Square, Outline, &other).Refusal());
}

TEST(IsomorphicTriangulationRefusals, NotFinite)
{
  std::vector<Point> target = Square;
  target[5][1] = std::numeric_limits<double>::quiet_NaN();
  PairRun run(Square, target, Outline);
  EXPECT_EQ(Filter::NOT_FINITE, run.Refusal());
  EXPECT_EQ(1, run.Pair->GetProblemDomain(0));
  EXPECT_EQ(Ids{ 5 }, run.Points());
}

TEST(IsomorphicTriangulationRefusals, NotPlanar)
{
  std::vector<Point> source = Square;
  source[6][2] = 1.0;
  source[4][2] = -1.0;
  PairRun run(source, Square, Outline);
  EXPECT_EQ(Filter::NOT_PLANAR, run.Refusal());
  EXPECT_EQ(0, run.Pair->GetProblemDomain(0));
}

TEST(IsomorphicTriangulationRefusals, Coincident)
{
  std::vector<Point> target = Square;
  target[6] = target[4];
  PairRun run(Square, target, Outline);
  EXPECT_EQ(Filter::COINCIDENT, run.Refusal());
  EXPECT_EQ(1, run.Pair->GetProblemDomain(0));
  EXPECT_EQ((Ids{ 4, 6 }), run.Points());
}

TEST(IsomorphicTriangulationRefusals, CrossingAndLeftOut)
{
  std::vector<Point> target = Square;
  target[6] = { 3, 2.5, 0 };
  std::vector<Point> source = Square;
  source[6] = { 0.5, 3, 0 };
  PairRun run(source, target, With({ { 4, 5 }, { 6, 0 } }));
  EXPECT_EQ(Filter::CROSSING, run.Refusal());
  EXPECT_EQ(1, run.Pair->GetProblemDomain(0));
  EXPECT_EQ((Ids{ 0, 6, 4, 5 }), run.Points());
  EXPECT_EQ(1, run.Pair->GetProblemCell(0));
  run.Pair->LeaveOutConflictingSegmentsOn();
  run.Pair->Update();
  EXPECT_EQ(0, run.Pair->GetNumberOfProblems());
  ASSERT_EQ(1, run.Pair->GetNumberOfLeftOutSegments());
  EXPECT_EQ(1, run.Pair->GetLeftOutCell(0));
  EXPECT_FALSE(run.Pair->GetLeftOutMessage(0).empty());
}

TEST(IsomorphicTriangulationRefusals, PointOnSegment)
{
  std::vector<Point> target = Square;
  target[6] = { 2, 1, 0 };
  PairRun run(Square, target, With({ { 4, 5 } }));
  EXPECT_EQ(Filter::POINT_ON_SEGMENT, run.Refusal());
  EXPECT_EQ(1, run.Pair->GetProblemDomain(0));
  EXPECT_EQ((Ids{ 6, 4, 5 }), run.Points());
}

TEST(IsomorphicTriangulationRefusals, CyclicOrder)
{
  std::vector<Point> source = Square;
  source.push_back({ 2, 1.5, 0 });
  std::vector<Point> target = source;
  std::swap(target[4], target[5]);
  PairRun run(source, target, With({ { 7, 4 }, { 7, 5 }, { 7, 6 } }));
  EXPECT_EQ(Filter::CYCLIC_ORDER, run.Refusal());
  EXPECT_EQ(Ids{ 7 }, run.Points());
}

TEST(IsomorphicTriangulationRefusals, OtherFace)
{
  // A loop of constraint segments: a dangling segment keeps it from being a hole.
  std::vector<Point> source = Square;
  source.push_back({ 2, 2, 0 });
  std::vector<Point> target = Square;
  target.push_back({ 0.5, 3, 0 });
  PairRun run(source, target, With({ { 4, 5 }, { 5, 6 }, { 6, 4 }, { 4, 0 } }));
  EXPECT_EQ(Filter::OTHER_FACE, run.Refusal());
  EXPECT_EQ(-1, run.Pair->GetProblemDomain(0));
}

TEST(IsomorphicTriangulationRefusals, OutlineAgainstHole)
{
  std::vector<Point> target = Square;
  for (const std::size_t i : { 4, 5, 6 })
  {
    target[i][0] += 10.0;
  }
  PairRun run(Square, target, { {}, { { 0, 1, 2, 3 }, { 4, 5, 6 } } });
  EXPECT_EQ(Filter::OUTLINE_AGAINST_HOLE, run.Refusal());
  EXPECT_LE(0, run.Pair->GetProblemCell(0));
}

TEST(IsomorphicTriangulationRefusals, LoopSense)
{
  std::vector<Point> target = Square;
  std::swap(target[4], target[5]);
  PairRun run(Square, target, { {}, { { 0, 1, 2, 3 }, { 4, 5, 6 } } });
  EXPECT_EQ(Filter::LOOP_SENSE, run.Refusal());
  EXPECT_EQ(1, run.Pair->GetProblemCell(0));
}

TEST(IsomorphicTriangulationRefusals, OutsideDomain)
{
  std::vector<Point> points = Square;
  points.push_back({ 9, 9, 0 });
  PairRun run(points, points, Outline);
  EXPECT_EQ(Filter::OUTSIDE_DOMAIN, run.Refusal());
  EXPECT_EQ(Ids{ 7 }, run.Points());
}

TEST(IsomorphicTriangulationRefusals, Collinear)
{
  const std::vector<Point> line{ { 0, 0, 0 }, { 1, 1, 0 }, { 3, 3, 0 } };
  PairRun run(line, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } });
  EXPECT_EQ(Filter::COLLINEAR, run.Refusal());
  EXPECT_EQ(0, run.Pair->GetProblemDomain(0));
}

TEST(IsomorphicTriangulationRefusals, OneFrameOnly)
{
  PairRun run(Square, Square);
  run.Pair->SetSourceFrame(-1, 9, -1, 9);
  EXPECT_EQ(Filter::BAD_FRAME, run.Refusal());
  EXPECT_EQ(1, run.Pair->GetProblemDomain(0));
}

TEST(IsomorphicTriangulationRefusals, HullsDiffer)
{
  std::vector<Point> target = Square;
  target[6] = { 2, 5, 0 };
  PairRun run(Square, target);
  run.Pair->SetDomain(Filter::CONVEX_HULL);
  EXPECT_EQ(Filter::HULLS_DIFFER, run.Refusal());
  EXPECT_EQ(Ids{ 6 }, run.Points());
}

TEST(IsomorphicTriangulationRefusals, PointLimit)
{
  // A comb, and the same comb with its corners numbered from another one.
  std::vector<Point> comb{ { 0, 0, 0 }, { 4, 0, 0 } };
  for (int i = 4; i-- > 0;)
  {
    comb.push_back({ i + 1.0, 10.0, 0.0 });
    comb.push_back({ i + 0.5, i > 0 ? 0.5 : 1.0, 0.0 });
  }
  std::vector<Point> turned = comb;
  std::rotate(turned.begin(), turned.begin() + 2, turned.end());
  PairRun run(comb, turned, { {}, { { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 } } });
  run.Pair->SetMaximumNumberOfAddedPoints(0);
  EXPECT_EQ(Filter::POINT_LIMIT, run.Refusal());
  EXPECT_LT(0, run.Pair->GetProblemCount(0));
  run.Pair->SetMaximumNumberOfAddedPoints(-1);
  run.Pair->Update();
  EXPECT_EQ(0, run.Pair->GetNumberOfProblems());
  EXPECT_LT(0, run.Pair->GetNumberOfAddedPoints());
}

} // namespace
