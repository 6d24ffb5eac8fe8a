// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Meshes between a source and a target: positions of points, and agreement of the reported folds
// with exact tests of the frames.

#include "Fixtures/FilterRuns.h"

#include "vtkInBetweenTriangulation.h"

namespace
{

using namespace fixtures;

using Filter = vtkInBetweenTriangulation;

/// A filter that was updated, halfway.
vtkSmartPointer<Filter> Between(const MeshPair& pair, int path = Filter::FEWEST_FOLDS)
{
  auto filter = MakeAlgorithm<Filter>(pair);
  filter->SetPath(path);
  filter->Update();
  return filter;
}

vtkPolyData* MeshAt(Filter* filter, double time)
{
  filter->SetTime(time);
  filter->Update();
  return filter->GetOutput();
}

/// The mesh rotated about the origin, scaled and translated.
vtkSmartPointer<vtkPolyData> Moved(
  vtkPolyData* mesh, double degrees, double factor, const Point& shift)
{
  const Matrix turn = Rotation({ 0, 0, 1 }, vtkMath::RadiansFromDegrees(degrees));
  return fixtures::Moved(mesh, [&](const Point& p) { return factor * (turn * p) + shift; });
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
  for (const int path : { Filter::STRAIGHT, Filter::ROTATING })
  {
    MeshPair pair = MakePlanarPair(5, 3);
    pair.Target = Moved(pair.Target, 100.0, 0.3, { 1000.0, -7.0, 0.0 });
    const auto filter = Between(pair, path);
    EXPECT_EQ(CountDifferentPoints(MeshAt(filter, 0.0), pair.Source), 0);
    EXPECT_EQ(CountDifferentPoints(MeshAt(filter, 1.0), pair.Target), 0);
    EXPECT_EQ(filter->GetNumberOfFoldedTriangles(), 0);
  }
}

TEST(InBetweenTriangulation, MovesStraightWhereNothingFoldsAndOnSurfaces)
{
  for (const MeshPair& pair : { MakePlanarPair(5, 7, 0.2), MakeClosedPair(2, 5) })
  {
    const auto filter = Between(pair);
    EXPECT_EQ(filter->GetPlanar(), pair.Source->GetBounds()[5] == 0.0);
    EXPECT_EQ(filter->GetUsedPath(), Filter::STRAIGHT);
    EXPECT_EQ(filter->GetNumberOfFoldingTriangles(), 0);
    EXPECT_EQ(filter->GetFirstFoldingTriangle(), -1);
    vtkPolyData* mesh = MeshAt(filter, 0.25);
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
    {
      const Point expected = 0.75 * PointOf(pair.Source, i) + 0.25 * PointOf(pair.Target, i);
      EXPECT_LE(Distance(PointOf(mesh, i), expected), 10 * Ulp);
    }
  }
}

TEST(InBetweenTriangulation, ASimilarityRotatesAtAConstantRateWithoutFolds)
{
  const vtkSmartPointer<vtkPolyData> source = MakePlanarPair(6, 11).Source;
  for (const double degrees : { 30.0, 135.0, -179.0 })
  {
    const MeshPair pair{ source, Moved(source, degrees, 0.25, { 40.0, -3.0, 0.0 }) };
    const auto filter = Between(pair, Filter::ROTATING);
    for (const double t : { 0.1, 0.5, 0.9 })
    {
      vtkPolyData* mesh = MeshAt(filter, t);
      EXPECT_EQ(filter->GetNumberOfFoldingTriangles(), 0);
      EXPECT_NEAR(filter->GetRotationAngle(), degrees, 1e-9);
      EXPECT_NEAR(filter->GetScaleFactor(), 0.25, 1e-12);
      // Every edge has rotated by the same angle and scaled by the same factor.
      const Matrix turn = Rotation({ 0, 0, 1 }, vtkMath::RadiansFromDegrees(t * degrees));
      for (vtkIdType i = 1; i < source->GetNumberOfPoints(); ++i)
      {
        const Point edge = PointOf(source, i) - PointOf(source, 0);
        const Point moved = PointOf(mesh, i) - PointOf(mesh, 0);
        EXPECT_LE(Distance(moved, std::pow(0.25, t) * (turn * edge)), 1e-12);
      }
    }
  }
}

TEST(InBetweenTriangulation, ARotationIsFoundWhereTheStraightPathFolds)
{
  const MeshPair pair = FoldingPair();
  EXPECT_GT(Between(pair, Filter::STRAIGHT)->GetNumberOfFoldingTriangles(), 0);
  const auto filter = Between(pair);
  for (int i = 0; i <= 20; ++i)
  {
    MeshAt(filter, i / 20.0);
    EXPECT_EQ(filter->GetUsedPath(), Filter::ROTATING);
    EXPECT_EQ(filter->GetNumberOfFoldingTriangles(), 0);
    EXPECT_EQ(filter->GetNumberOfFoldedTriangles(), 0);
  }
}

TEST(InBetweenTriangulation, ReportsExactlyTheTimesAtWhichFramesFold)
{
  const MeshPair pair = FoldingPair();
  const auto filter = Between(pair, Filter::STRAIGHT);
  ASSERT_GT(filter->GetNumberOfFoldingTriangles(), 0);
  EXPECT_GT(filter->GetFirstFoldTime(), 0.0);
  EXPECT_LT(filter->GetLastFoldTime(), 1.0);
  std::set<vtkIdType> everFolded;
  for (int i = 0; i <= 1000; ++i)
  {
    const double t = i / 1000.0;
    vtkPolyData* mesh = MeshAt(filter, t);
    vtkIdType count = 0;
    for (vtkIdType c = 0; c < pair.Source->GetNumberOfCells(); ++c)
    {
      const bool turned = NormalOf(pair.Source, c)[2] * NormalOf(mesh, c)[2] <= 0.0;
      EXPECT_EQ(CellValue(mesh, "Folded", c) != 0.0, turned);
      count += turned;
      everFolded.insert(turned ? c : -1);
    }
    EXPECT_EQ(filter->GetNumberOfFoldedTriangles(), count);
    EXPECT_TRUE(count == 0 || (filter->GetFirstFoldTime() <= t && t <= filter->GetLastFoldTime()));
  }
  everFolded.erase(-1);
  EXPECT_GT(everFolded.size(), 0u);
  EXPECT_LE(everFolded.size(), static_cast<std::size_t>(filter->GetNumberOfFoldingTriangles()));
  // Just after the reported time the reported triangle is folded; just before it is not.
  const double begin = filter->GetFirstFoldTime();
  const vtkIdType first = filter->GetFirstFoldingTriangle();
  for (const double step : { -1e-9, 1e-9 })
  {
    EXPECT_EQ(CellValue(MeshAt(filter, begin + step), "Folded", first) != 0.0, step > 0.0);
  }
}

TEST(InBetweenTriangulation, AllTrianglesOfAMirrorImageFold)
{
  MeshPair pair = MakePlanarPair(3, 17, 0.2);
  pair.Target = Mirrored(pair.Target);
  const auto filter = Between(pair);
  EXPECT_TRUE(filter->GetMirrored());
  EXPECT_EQ(filter->GetNumberOfFoldingTriangles(), pair.Source->GetNumberOfCells());
}

TEST(InBetweenTriangulation, DoesNotDependOnUnits)
{
  const MeshPair pair = FoldingPair();
  const auto filter = Between(pair, Filter::STRAIGHT);
  for (const double unit : { 0x1p-600, 0x1p600 })
  {
    const auto other = Between(Resized(pair, unit), Filter::STRAIGHT);
    EXPECT_EQ(other->GetNumberOfFoldingTriangles(), filter->GetNumberOfFoldingTriangles());
    EXPECT_EQ(other->GetFirstFoldTime(), filter->GetFirstFoldTime());
  }
}

} // namespace
