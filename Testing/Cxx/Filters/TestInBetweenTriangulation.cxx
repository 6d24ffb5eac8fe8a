// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Meshes between a source and a target: positions of points, and agreement of the reported folds
// with exact tests of the frames.

#include "Fixtures/FilterRuns.h"

#include "vtkInBetweenTriangulation.h"

namespace
{

using namespace fixtures;

vtkSmartPointer<vtkInBetweenTriangulation> MakeFilter(
  const MeshPair& pair, int path = vtkInBetweenTriangulation::FEWEST_FOLDS)
{
  auto filter = MakeAlgorithm<vtkInBetweenTriangulation>(pair);
  filter->SetPath(path);
  return filter;
}

/// The mesh rotated about the origin, scaled and translated.
vtkSmartPointer<vtkPolyData> Moved(
  vtkPolyData* mesh, double degrees, double factor, const Point& shift)
{
  const Matrix turn = Rotation({ 0, 0, 1 }, vtkMath::RadiansFromDegrees(degrees));
  return fixtures::Moved(mesh, [&](const Point& p) { return factor * (turn * p) + shift; });
}

double LargestDistance(vtkPolyData* a, vtkPolyData* b)
{
  double largest = 0.0;
  for (vtkIdType i = 0; i < a->GetNumberOfPoints(); ++i)
  {
    largest = std::max(largest, Distance(PointOf(a, i), PointOf(b, i)));
  }
  return largest;
}

/// Twice the signed area in the plane.
double AreaOf(vtkPolyData* mesh, vtkIdType triangle)
{
  const auto p = CornersOf(mesh, triangle);
  return Cross(p[1] - p[0], p[2] - p[0])[2];
}

/// The straight path rotates the mesh by almost 180 degrees: triangles of different shape fold near
/// the middle.
MeshPair FoldingPair()
{
  MeshPair pair = MakePlanarPair(4, 19);
  pair.Target = Moved(pair.Target, 172.0, 1.0, { 0.0, 0.0, 0.0 });
  return pair;
}

TEST(InBetweenTriangulation, IsExactlySourceAtZeroAndTargetAtOne)
{
  for (const int path :
    { vtkInBetweenTriangulation::STRAIGHT, vtkInBetweenTriangulation::ROTATING })
  {
    MeshPair pair = MakePlanarPair(5, 3);
    pair.Target = Moved(pair.Target, 100.0, 0.3, { 1000.0, -7.0, 0.0 });
    const auto filter = MakeFilter(pair, path);
    filter->SetTime(0.0);
    filter->Update();
    EXPECT_EQ(LargestDistance(filter->GetOutput(), pair.Source), 0.0);
    filter->SetTime(1.0);
    filter->Update();
    EXPECT_EQ(LargestDistance(filter->GetOutput(), pair.Target), 0.0);
    EXPECT_EQ(filter->GetNumberOfFoldedTriangles(), 0);
  }
}

TEST(InBetweenTriangulation, MovesStraightWhereNothingFolds)
{
  const MeshPair pair = MakePlanarPair(5, 7, 0.2);
  const auto filter = MakeFilter(pair);
  filter->SetTime(0.25);
  filter->Update();
  EXPECT_EQ(filter->GetUsedPath(), vtkInBetweenTriangulation::STRAIGHT);
  EXPECT_EQ(filter->GetNumberOfFoldingTriangles(), 0);
  EXPECT_EQ(filter->GetFirstFoldingTriangle(), -1);
  for (vtkIdType i = 0; i < pair.Source->GetNumberOfPoints(); ++i)
  {
    const Point expected = 0.75 * PointOf(pair.Source, i) + 0.25 * PointOf(pair.Target, i);
    EXPECT_LE(Distance(PointOf(filter->GetOutput(), i), expected), 10 * Ulp);
  }
}

TEST(InBetweenTriangulation, ASimilarityRotatesAtAConstantRateWithoutFolds)
{
  const vtkSmartPointer<vtkPolyData> source = MakePlanarPair(6, 11).Source;
  for (const double degrees : { 30.0, 135.0, -179.0 })
  {
    const MeshPair pair{ source, Moved(source, degrees, 0.25, { 40.0, -3.0, 0.0 }) };
    const auto filter = MakeFilter(pair, vtkInBetweenTriangulation::ROTATING);
    for (const double t : { 0.1, 0.5, 0.9 })
    {
      filter->SetTime(t);
      filter->Update();
      EXPECT_EQ(filter->GetNumberOfFoldingTriangles(), 0);
      EXPECT_NEAR(filter->GetRotationAngle(), degrees, 1e-9);
      EXPECT_NEAR(filter->GetScaleFactor(), 0.25, 1e-12);
      // Every edge has rotated by the same angle and scaled by the same factor.
      const Matrix turn = Rotation({ 0, 0, 1 }, vtkMath::RadiansFromDegrees(t * degrees));
      for (vtkIdType i = 1; i < source->GetNumberOfPoints(); ++i)
      {
        const Point edge = PointOf(source, i) - PointOf(source, 0);
        const Point moved = PointOf(filter->GetOutput(), i) - PointOf(filter->GetOutput(), 0);
        EXPECT_LE(Distance(moved, std::pow(0.25, t) * (turn * edge)), 1e-12);
      }
    }
  }
}

TEST(InBetweenTriangulation, ARotationIsFoundWhereTheStraightPathFolds)
{
  MeshPair pair = MakePlanarPair(6, 13, 0.2);
  pair.Target = Moved(pair.Target, 175.0, 1.0, { 0.0, 0.0, 0.0 });
  const auto straight = MakeFilter(pair, vtkInBetweenTriangulation::STRAIGHT);
  straight->Update();
  EXPECT_GT(straight->GetNumberOfFoldingTriangles(), 0);
  const auto filter = MakeFilter(pair);
  for (int i = 0; i <= 20; ++i)
  {
    filter->SetTime(i / 20.0);
    filter->Update();
    EXPECT_EQ(filter->GetUsedPath(), vtkInBetweenTriangulation::ROTATING);
    EXPECT_EQ(filter->GetNumberOfFoldingTriangles(), 0);
    EXPECT_EQ(filter->GetNumberOfFoldedTriangles(), 0);
  }
}

TEST(InBetweenTriangulation, ReportsExactlyTheTimesAtWhichFramesFold)
{
  const MeshPair pair = FoldingPair();
  const auto filter = MakeFilter(pair, vtkInBetweenTriangulation::STRAIGHT);
  filter->Update();
  ASSERT_GT(filter->GetNumberOfFoldingTriangles(), 0);
  EXPECT_GT(filter->GetFirstFoldTime(), 0.0);
  EXPECT_LT(filter->GetLastFoldTime(), 1.0);
  std::vector<bool> everFolded(static_cast<std::size_t>(pair.Source->GetNumberOfCells()), false);
  for (int i = 0; i <= 1000; ++i)
  {
    const double t = i / 1000.0;
    filter->SetTime(t);
    filter->Update();
    vtkDataArray* folded = filter->GetOutput()->GetCellData()->GetArray("Folded");
    vtkIdType count = 0;
    for (vtkIdType c = 0; c < pair.Source->GetNumberOfCells(); ++c)
    {
      const bool turned = AreaOf(pair.Source, c) * AreaOf(filter->GetOutput(), c) <= 0.0;
      EXPECT_EQ(folded->GetTuple1(c) != 0.0, turned);
      count += turned;
      everFolded[static_cast<std::size_t>(c)] = everFolded[static_cast<std::size_t>(c)] || turned;
    }
    EXPECT_EQ(filter->GetNumberOfFoldedTriangles(), count);
    if (count > 0)
    {
      EXPECT_GE(t, filter->GetFirstFoldTime());
      EXPECT_LE(t, filter->GetLastFoldTime());
    }
  }
  const auto seen = std::count(everFolded.begin(), everFolded.end(), true);
  EXPECT_GT(seen, 0);
  EXPECT_LE(seen, filter->GetNumberOfFoldingTriangles());
  // Just after the reported time the reported triangle is folded; just before it is not.
  const double begin = filter->GetFirstFoldTime();
  const vtkIdType first = filter->GetFirstFoldingTriangle();
  for (const double step : { -1e-9, 1e-9 })
  {
    filter->SetTime(begin + step);
    filter->Update();
    EXPECT_EQ(
      filter->GetOutput()->GetCellData()->GetArray("Folded")->GetTuple1(first) != 0.0, step > 0.0);
  }
}

TEST(InBetweenTriangulation, AllTrianglesOfAMirrorImageFold)
{
  MeshPair pair = MakePlanarPair(3, 17, 0.2);
  pair.Target = fixtures::Moved(pair.Target, [](const Point& p) -> Point {
    return { -p[0], p[1], p[2] };
  });
  const auto filter = MakeFilter(pair);
  filter->Update();
  EXPECT_TRUE(filter->GetMirrored());
  EXPECT_EQ(filter->GetNumberOfFoldingTriangles(), pair.Source->GetNumberOfCells());
}

TEST(InBetweenTriangulation, DoesNotDependOnUnits)
{
  const MeshPair pair = FoldingPair();
  const auto filter = MakeFilter(pair, vtkInBetweenTriangulation::STRAIGHT);
  filter->Update();
  for (const double unit : { 0x1p-600, 0x1p600 })
  {
    const MeshPair scaled{ Moved(pair.Source, 0.0, unit, { 0, 0, 0 }),
      Moved(pair.Target, 0.0, unit, { 0, 0, 0 }) };
    const auto other = MakeFilter(scaled, vtkInBetweenTriangulation::STRAIGHT);
    other->Update();
    EXPECT_EQ(other->GetNumberOfFoldingTriangles(), filter->GetNumberOfFoldingTriangles());
    EXPECT_EQ(other->GetFirstFoldTime(), filter->GetFirstFoldTime());
  }
}

TEST(InBetweenTriangulation, SurfacesMoveStraightAndReportNoFolds)
{
  const MeshPair pair = MakeClosedPair(2, 5);
  const auto filter = MakeFilter(pair);
  filter->Update();
  EXPECT_FALSE(filter->GetPlanar());
  EXPECT_EQ(filter->GetNumberOfFoldingTriangles(), 0);
  EXPECT_LE(Distance(PointOf(filter->GetOutput(), 9),
              0.5 * (PointOf(pair.Source, 9) + PointOf(pair.Target, 9))),
    4 * Ulp);
}

} // namespace
