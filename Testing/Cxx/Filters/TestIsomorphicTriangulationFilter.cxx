// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/FilterRuns.h"

#include "vtkIsomorphicTriangulation.h"

#include "vtkTypeInt64Array.h"

namespace
{

using namespace fixtures;
using Filter = vtkIsomorphicTriangulation;

/// Corresponding points of a lattice that a map bends a little.
std::vector<Point> Lattice(const std::function<Point(double, double)>& map)
{
  std::vector<Point> points;
  for (int i = 0; i < 25; ++i)
  {
    points.push_back(map(i / 5 + 0.1 * (i % 5), i % 5 - 0.13 * (i / 5)));
  }
  return points;
}

Point Flat(double x, double y)
{
  return { x, y, 0.0 };
}

Point Bent(double x, double y)
{
  return { x + 0.2 * std::sin(y), y + 0.2 * std::sin(x), 0.0 };
}

using Ids = std::vector<vtkIdType>;

struct Cells
{
  std::vector<Ids> Lines;
  std::vector<Ids> Polygons;
};

vtkSmartPointer<vtkPolyData> Figure(
  const std::vector<Point>& positions, const Cells& cells, int type)
{
  const auto figure = MakeCloud(positions, type);
  figure->SetLines(MakePolygons(cells.Lines));
  figure->SetPolys(MakePolygons(cells.Polygons));
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
  }

  /// The source's triangulation.
  vtkPolyData* Mesh()
  {
    this->Pair->Update();
    EXPECT_EQ(this->Log.Error(), "");
    EXPECT_EQ(this->Pair->GetNumberOfProblems(), 0);
    return this->Pair->GetOutput();
  }

  /// The kind of the first problem.
  int Refusal()
  {
    this->Pair->Update();
    EXPECT_TRUE(this->Log.HasError());
    this->Log.Clear();
    EXPECT_EQ(0, this->Pair->GetOutput()->GetNumberOfCells());
    EXPECT_FALSE(this->Pair->GetProblemMessage(0).empty());
    return this->Pair->GetNumberOfProblems() > 0 ? this->Pair->GetProblemKind(0) : -1;
  }

  Ids Points(int problem = 0)
  {
    vtkNew<vtkIdList> ids;
    this->Pair->GetProblemPoints(problem, ids);
    return { ids->begin(), ids->end() };
  }

  vtkSmartPointer<vtkPolyData> Source;
  vtkSmartPointer<vtkPolyData> Target;
  vtkNew<Filter> Pair;
  Messages Log{ Pair };
};

const std::vector<Point> Square{ { 0, 0, 0 }, { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 }, { 1, 1, 0 },
  { 3, 1, 0 }, { 2, 3, 0 } };
const Cells Outline{ {}, { { 0, 1, 2, 3 } } };

Cells With(const std::vector<Ids>& lines)
{
  return { lines, Outline.Polygons };
}

TEST(IsomorphicTriangulationFilter, MakesPairsThatOtherFiltersTake)
{
  const auto upright = [](double x, double y) { return Point{ 7.0, x, y }; };
  const auto tilted = [](double x, double y) {
    const Point p = Bent(x, y);
    return Point{ 5.0 + 0.6 * p[0], 3.0 - p[1], 0.8 * p[0] };
  };
  PairRun flat(Lattice(Flat), Lattice(Bent), {}, nullptr, VTK_FLOAT);
  PairRun inSpace(Lattice(upright), Lattice(tilted));
  for (PairRun* run : { &flat, &inSpace })
  {
    vtkPolyData* source = run->Mesh();
    // The map takes landmarks to landmarks.
    vtkNew<vtkDifferentiableHomeomorphism> map;
    map->SetDataObject(run->Source);
    map->SetSourceConnection(run->Pair->GetOutputPort(0));
    map->SetTargetConnection(run->Pair->GetOutputPort(1));
    EXPECT_LT(LargestDistance(Output(map.Get()), run->Target), 1e-6);
    EXPECT_EQ(map->GetNumberOfOutsidePoints(), 0);
    EXPECT_EQ(VTK_DOUBLE, source->GetPoints()->GetDataType());
    EXPECT_EQ(run->Pair->GetTargetOutput()->GetNumberOfCells(), source->GetNumberOfCells());
    EXPECT_EQ(0, run->Pair->GetNumberOfAddedPoints());
    EXPECT_EQ(24, PointValue(source, "OriginalPointId", 24));
    EXPECT_EQ(-1, PointValue(source, "OriginalPointId", 25));
    EXPECT_TRUE(std::isnan(PointValue(source, "LandmarkResidual", 25)));
    const double* angles = run->Pair->GetSmallestAngles();
    EXPECT_NEAR(
      std::min(angles[0], angles[1]), CellArray(source, "MinimumAngle")->GetRange()[0], 1e-12);
    EXPECT_NEAR(
      run->Pair->GetLargestDistortion(), CellArray(source, "Distortion")->GetRange()[1], 1e-12);
  }
}

TEST(IsomorphicTriangulationFilter, SegmentsOfLoopsAndLines)
{
  // The outline as single line cells; one line is a constraint.
  PairRun run(Square, Square, { { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 6 } }, {} });
  EXPECT_EQ(7, run.Mesh()->GetNumberOfPoints());
  EXPECT_EQ(1, run.Pair->GetSourceSegments()->GetNumberOfLines());
  EXPECT_EQ(1, run.Pair->GetTargetSegments()->GetNumberOfLines());
}

TEST(IsomorphicTriangulationFilter, SuspiciousLandmarksAreListed)
{
  std::vector<Point> target = Lattice(Bent);
  target[12][0] += 0.7;
  PairRun run(Lattice(Flat), target);
  run.Mesh();
  vtkNew<vtkIdList> worst;
  run.Pair->GetSuspiciousLandmarks(worst);
  ASSERT_EQ(10, worst->GetNumberOfIds());
  EXPECT_EQ(12, worst->GetId(0));
}

TEST(IsomorphicTriangulationFilter, UnitsDoNotMatter)
{
  // Flat figures, which frames surround, and tilted ones.
  for (const double tilt : { 0.0, 0.8 })
  {
    const auto make = [tilt](double sourceUnit, double targetUnit) {
      auto run = std::make_unique<PairRun>(Lattice([=](double x, double y) {
        return Point{ sourceUnit * x, sourceUnit * y, sourceUnit * tilt * x };
      }),
        Lattice([=](double x, double y) { return targetUnit * Bent(x, y); }));
      if (tilt == 0.0)
      {
        run->Pair->SetSourceFrame(-2 * sourceUnit, 8 * sourceUnit, -3 * sourceUnit, 9 * sourceUnit);
        run->Pair->SetTargetFrame(
          -3 * targetUnit, 9 * targetUnit, -9 * targetUnit, 11 * targetUnit);
      }
      EXPECT_GT(run->Mesh()->GetNumberOfCells(), 0);
      return run;
    };
    const auto plain = make(1.0, 1.0);
    for (const double unit : { 0x1p-1000, 0x1p1000 })
    {
      const auto scaled = make(unit, 0x1p600);
      EXPECT_EQ(0, CountDifferentCells(plain->Pair->GetOutput(), scaled->Pair->GetOutput()));
      for (const int port : { 0, 1 })
      {
        const auto expected = Resized(plain->Pair->GetOutput(port), port == 0 ? unit : 0x1p600);
        EXPECT_EQ(0, CountDifferentPoints(expected, scaled->Pair->GetOutput(port)));
      }
      vtkDataArray* expected = PointArray(plain->Pair->GetTargetOutput(), "LandmarkResidual");
      vtkDataArray* residuals = PointArray(scaled->Pair->GetTargetOutput(), "LandmarkResidual");
      for (vtkIdType i = 0; i < expected->GetNumberOfTuples(); ++i)
      {
        EXPECT_TRUE(SameBits(residuals->GetTuple1(i), 0x1p600 * expected->GetTuple1(i)));
      }
    }
  }
}

TEST(IsomorphicTriangulationFilter, FramesOfImages)
{
  PairRun run(Lattice([](double x, double y) { return Point{ x, 10.0 - y, 0.0 }; }), Lattice(Bent));
  // One frame alone is refused.
  run.Pair->SetSourceFrame(-2, 8, 0, 20);
  EXPECT_EQ(Filter::BAD_FRAME, run.Refusal());
  EXPECT_EQ(1, run.Pair->GetProblemDomain(0));
  run.Pair->SetTargetFrame(-3, 9, -9, 11);
  run.Mesh();
  EXPECT_TRUE(run.Pair->GetMirrored());
  const double* bounds = run.Pair->GetTargetOutput()->GetBounds();
  EXPECT_EQ(-9, bounds[2]);
  EXPECT_EQ(11, bounds[3]);
}

/// The square with a point moved.
std::vector<Point> With(std::size_t id, const Point& position)
{
  std::vector<Point> points = Square;
  points[id] = position;
  return points;
}

// Of figures that the construction refuses, see TestIsomorphicTriangulation, the filter numbers
// domains, points and cells; the others it refuses itself.
TEST(IsomorphicTriangulationRefusals, NameWhatIsWrong)
{
  struct Case
  {
    int Kind;
    int Domain;
    Ids Points;
    int Cell;
    std::vector<Point> Source;
    std::vector<Point> Target;
    Cells OfSource;
    Cells OfTarget;
  };
  const Cells holed{ {}, { { 0, 1, 2, 3 }, { 4, 5, 6 } } };
  const std::vector<Point> fewer(Square.begin(), Square.end() - 1);
  std::vector<Point> swapped = Square;
  std::swap(swapped[4], swapped[5]);
  const std::vector<Case> cases{ { Filter::EMPTY, -1, {}, -1, {}, {}, {}, {} },
    { Filter::POINT_COUNTS_DIFFER, -1, {}, -1, Square, fewer, {}, {} },
    { Filter::CELLS_DIFFER, -1, {}, -1, Square, Square, Outline, With({ { 4, 6 } }) },
    { Filter::NOT_FINITE, 1, { 5 }, -1, Square, With(5, { 3, NotANumber, 0 }), Outline, Outline },
    { Filter::NOT_PLANAR, 0, {}, -1, With(6, { 2, 3, 1 }), Square, Outline, Outline },
    { Filter::LOOP_SENSE, -1, {}, 1, Square, swapped, holed, holed } };
  for (const Case& one : cases)
  {
    SCOPED_TRACE(one.Kind);
    PairRun run(one.Source, one.Target, one.OfSource, &one.OfTarget);
    EXPECT_EQ(one.Kind, run.Refusal());
    EXPECT_TRUE(one.Domain < 0 || run.Pair->GetProblemDomain(0) == one.Domain);
    EXPECT_TRUE(one.Points.empty() || run.Points() == one.Points);
    EXPECT_TRUE(one.Cell < 0 || run.Pair->GetProblemCell(0) == one.Cell);
  }
}

TEST(IsomorphicTriangulationRefusals, CrossingAndLeftOut)
{
  PairRun run(With(6, { 0.5, 3, 0 }), With(6, { 3, 2.5, 0 }), With({ { 4, 5 }, { 6, 0 } }));
  EXPECT_EQ(Filter::CROSSING, run.Refusal());
  EXPECT_EQ(1, run.Pair->GetProblemDomain(0));
  EXPECT_EQ((Ids{ 0, 6, 4, 5 }), run.Points());
  EXPECT_EQ(1, run.Pair->GetProblemCell(0));
  run.Pair->LeaveOutConflictingSegmentsOn();
  run.Mesh();
  ASSERT_EQ(1, run.Pair->GetNumberOfLeftOutSegments());
  EXPECT_EQ(1, run.Pair->GetLeftOutCell(0));
  EXPECT_FALSE(run.Pair->GetLeftOutMessage(0).empty());
}

TEST(IsomorphicTriangulationRefusals, PointLimit)
{
  // Two quadrangles without a common diagonal.
  PairRun run({ { 0, 0, 0 }, { 4, 0, 0 }, { 1, 1, 0 }, { 0, 4, 0 } },
    { { 4, 0, 0 }, { 1, 1, 0 }, { 0, 4, 0 }, { 0, 0, 0 } }, Outline);
  run.Pair->SetMaximumNumberOfAddedPoints(0);
  EXPECT_EQ(Filter::POINT_LIMIT, run.Refusal());
  EXPECT_EQ(1, run.Pair->GetProblemCount(0));
  run.Pair->SetMaximumNumberOfAddedPoints(-1);
  run.Mesh();
  EXPECT_EQ(1, run.Pair->GetNumberOfAddedPoints());
}

TEST(IsomorphicTriangulationRefusals, NumbersOutOfRange)
{
  PairRun run(Square, With(5, { 3, NotANumber, 0 }), Outline);
  EXPECT_EQ(Filter::NOT_FINITE, run.Refusal());
  for (const int number : { -1, 1, VTK_INT_MAX })
  {
    EXPECT_EQ(-1, run.Pair->GetProblemKind(number));
    EXPECT_TRUE(run.Log.HasError());
    run.Log.Clear();
    EXPECT_EQ(-1, run.Pair->GetProblemDomain(number));
    EXPECT_EQ(-1, run.Pair->GetProblemCell(number));
    EXPECT_EQ(0, run.Pair->GetProblemCount(number));
    EXPECT_EQ("", run.Pair->GetProblemMessage(number));
    EXPECT_EQ(Ids{}, run.Points(number));
    EXPECT_EQ(-1, run.Pair->GetLeftOutCell(number));
    EXPECT_EQ("", run.Pair->GetLeftOutMessage(number));
  }
}

TEST(IsomorphicTriangulationRefusals, CorruptCells)
{
  // The lowest 32 bits of the last one name a point.
  for (const vtkIdType noPoint : { vtkIdType(7), vtkIdType(-1), (vtkIdType(1) << 44) + 3 })
  {
    const Cells line = With({ { 4, noPoint } });
    const Cells loop{ {}, { { 0, 1, 2, noPoint } } };
    const Cells edges{ { { 0, 1 }, { 1, 2 }, { 2, noPoint }, { noPoint, 0 } }, {} };
    for (const Cells& cells : { line, loop, edges })
    {
      PairRun run(Square, Square, cells);
      EXPECT_EQ(Filter::BAD_CELL, run.Refusal()) << noPoint;
    }
  }
  for (const bool ofLines : { false, true })
  {
    PairRun run(Square, Square, With({ { 4, 6 } }));
    vtkNew<vtkCellArray> cells;
    cells->SetData(RandomArray<vtkTypeInt64Array>("Offsets", 1, 3, 1),
      RandomArray<vtkTypeInt64Array>("Points", 1, 3, 2));
    ofLines ? run.Target->SetLines(cells) : run.Target->SetPolys(cells);
    EXPECT_EQ(Filter::BAD_CELL, run.Refusal());
    EXPECT_EQ(1, run.Pair->GetProblemDomain(0));
  }
}

} // namespace
