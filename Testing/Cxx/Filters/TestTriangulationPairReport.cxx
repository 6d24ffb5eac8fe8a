// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The numbers of the report agree with closed forms and with the results of the other filters.

#include "Fixtures/FilterRuns.h"

#include "vtkTriangulationPairReport.h"

#include "vtkSMPTools.h"
#include "vtkStringArray.h"

namespace
{

using namespace fixtures;

vtkSmartPointer<vtkTriangulationPairReport> Report(const MeshPair& pair, bool continuity = false)
{
  auto report = MakeAlgorithm<vtkTriangulationPairReport>(pair);
  report->SetMeasureContinuity(continuity);
  Messages messages(report);
  report->Update();
  EXPECT_EQ(messages.Error() + messages.Warning(), "");
  return report;
}

/// Statistics by name have these values.
void ExpectStatistics(vtkTriangulationPairReport* report,
  const std::vector<std::pair<const char*, double>>& expected, double tolerance = 0.0)
{
  for (const auto& [name, value] : expected)
  {
    EXPECT_NEAR(report->GetStatistic(name), value, tolerance) << name;
  }
}

TEST(TriangulationPairReport, AnAffinePairHasOneDistortionAndDoesNotBend)
{
  // Singular values 3 and 1/2.
  const Matrix affine = Rotation({ 0, 0, 1 }, 0.4) *
    (Matrix{ { { 3, 0, 0 }, { 0, 0.5, 0 }, { 0, 0, 1 } } } * Rotation({ 0, 0, 1 }, 0.9));
  const MeshPair grid = MakePlanarPair(5, 3);
  const MeshPair pair{ grid.Source, Tilted(grid.Source, affine, {}) };
  const auto report = Report(pair);
  EXPECT_TRUE(report->GetValid());
  ExpectStatistics(report,
    { { "LargestDistortion", 6.0 }, { "LargestStretch", 3.0 }, { "SmallestStretch", 0.5 },
      { "SourceArea", 25.0 }, { "TargetArea", 37.5 }, { "CubicBendingEnergy", 0.0 },
      { "CubicExceptionalBoundaryVertices", 0.0 } },
    1e-12);
  // A lower bound, which leaves room for rounding.
  EXPECT_NEAR(report->GetStatistic("CubicCertificate"), 1.0, 2e-6);
  EXPECT_LE(report->GetStatistic("CubicCertificate"), 1.0);
  for (const std::string system : { "Linear", "Smooth", "Cubic" })
  {
    const auto statistic = [&](const char* what) {
      return report->GetStatistic((system + what).c_str());
    };
    EXPECT_NEAR(statistic("SmallestDeterminant"), 1.5, 1e-11);
    EXPECT_NEAR(statistic("LargestDeterminant"), 1.5, 1e-11);
    EXPECT_NEAR(statistic("DeviationFromLinear"), 0.0, 1e-12);
    EXPECT_NEAR(statistic("SecondDifference"), 0.0, 1e-11);
    EXPECT_GT(statistic("SecondDifferenceSamples"), 10000.0);
    EXPECT_EQ(statistic("NotPositive"), 0.0);
  }
  for (const int bound : { 0, 1 })
  {
    EXPECT_NEAR(CellArray(report->GetTargetOutput(), "Determinant")->GetRange()[bound], 1.5, 1e-12);
    EXPECT_NEAR(CellArray(report->GetOutput(), "Distortion")->GetRange()[bound], 6.0, 1e-11);
  }
}

TEST(TriangulationPairReport, FindsAnglesAndAreaRatiosOfKnownTriangles)
{
  // A right isosceles triangle, on it a needle of 5 degrees, and on that one of 12.
  const double tan5 = std::tan(vtkMath::RadiansFromDegrees(5.0));
  const double tan17 = std::tan(vtkMath::RadiansFromDegrees(17.0));
  const auto mesh =
    MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, -1, 0 }, { 1, tan5, 0 }, { 1, tan17, 0 } },
      { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 4 } });
  const auto report = Report({ mesh, mesh });
  ExpectStatistics(report,
    { { "SourceSmallestAngle", 5.0 }, { "SourceSmallestAngleCell", 1.0 },
      { "SourceShareOfTrianglesBelow10Degrees", 1.0 / 3.0 },
      { "SourceShareOfTrianglesBelow15Degrees", 2.0 / 3.0 },
      { "TargetShareOfTrianglesBelow20Degrees", 2.0 / 3.0 },
      { "SourceLargestAreaRatio", 1.0 / tan5 }, { "SourceDiscordantTriangles", 0.0 } },
    1e-11);
  EXPECT_NEAR(CellValue(report->GetOutput(), "SmallestAngle", 0), 45.0, 1e-12);
  EXPECT_NEAR(CellValue(report->GetOutput(), "SmallestAngle", 2), 12.0, 1e-12);
  EXPECT_NEAR(CellValue(report->GetOutput(), "AreaRatio", 2), (tan17 - tan5) / tan5, 1e-12);

  // The foot of the centroid on the longer short edge is outside it.
  const auto slanted = MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 1.5, 0.1, 0 } }, { { 0, 1, 2 } });
  const auto discordant = Report({ slanted, slanted });
  EXPECT_EQ(discordant->GetStatistic("TargetDiscordantTriangles"), 1.0);
  EXPECT_EQ(CellValue(discordant->GetOutput(), "Concordant", 0), 0.0);
  EXPECT_EQ(CellValue(discordant->GetOutput(), "Invalid", 0), 0.0);
}

TEST(TriangulationPairReport, CountsAgreeWithTopology)
{
  const auto square = Report(MakePlanarPair(4, 7));
  ExpectStatistics(square,
    { { "Components", 1.0 }, { "BoundaryLoops", 1.0 }, { "BoundaryEdges", 16.0 },
      { "InteriorEdges", 40.0 }, { "SourceUnusedPoints", 0.0 } });

  const auto closed = Report(MakeClosedPair(2, 5));
  ExpectStatistics(closed, { { "BoundaryLoops", 0.0 }, { "SourcePlanar", 0.0 } });
  // Euler.
  EXPECT_EQ(closed->GetStatistic("SourcePoints") - closed->GetStatistic("InteriorEdges") +
      closed->GetStatistic("SourceTriangles"),
    2.0);
  EXPECT_TRUE(std::isnan(closed->GetStatistic("SmoothSecondDifference")));
  EXPECT_GT(closed->GetStatistic("SmoothSmallestDeterminant"), 0.0);

  // A ring of 8 triangles around a hole, one wound otherwise, and a point twice, unused.
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  for (vtkIdType k = 0; k < 8; ++k)
  {
    const double radius = k % 2 == 0 ? 1.0 : 2.0;
    points.push_back(
      Rotation({ 0, 0, 1 }, vtkMath::Pi() / 4.0 * static_cast<double>(k)) * Point{ radius, 0, 0 });
    triangles.push_back({ k, (k + 1 + k % 2) % 8, (k + 2 - k % 2) % 8 });
  }
  points.push_back(points[3]);
  std::swap(triangles[0][0], triangles[0][1]);
  const auto mesh = MakeMesh(points, triangles);
  const auto ring = Report({ mesh, mesh });
  ExpectStatistics(ring,
    { { "BoundaryLoops", 2.0 }, { "OppositeWindings", 1.0 }, { "SourceUnusedPoints", 1.0 },
      { "TargetDuplicatePoints", 1.0 } });
}

TEST(TriangulationPairReport, TheDeviationIsThatOfTheMapsAtTheReportedPoint)
{
  const MeshPair pair = MakePlanarPair(5, 11);
  const auto report = Report(pair);
  EXPECT_EQ(report->GetStatistic("LinearDeviationFromLinear"), 0.0);
  const Point point{ report->GetStatistic("SmoothDeviationFromLinearX"),
    report->GetStatistic("SmoothDeviationFromLinearY"),
    report->GetStatistic("SmoothDeviationFromLinearZ") };
  Point images[2];
  for (const System& system : { Linear, Smooth })
  {
    const auto map = MakeFilter(system, pair, MakeCloud({ point }));
    map->ComputeTriangleIdOn();
    images[system.CoordinateSystem == Linear.CoordinateSystem] = PointOf(Output(map), 0);
    EXPECT_EQ(PointValue(Output(map), "TriangleId", 0),
      report->GetStatistic("SmoothDeviationFromLinearCell"));
  }
  const double deviation = report->GetStatistic("SmoothDeviationFromLinear");
  EXPECT_GT(deviation, 0.0);
  EXPECT_NEAR(Distance(images[0], images[1]), deviation, 1e-13);
  EXPECT_EQ(CellArray(report->GetOutput(), "DeviationFromLinear")->GetRange()[1], deviation);
}

TEST(TriangulationPairReport, TheSecondDifferenceOfACreaseHasItsClosedForm)
{
  // (x, y) -> (x, y + a |x|) on [-2, 2] x [0, 4].
  constexpr double a = 0.7;
  const auto source = Moved(RegularGrid(4), [](const Point& p) { return p - Point{ 2.0, 0, 0 }; });
  const auto target = Moved(source, [](const Point& p) -> Point {
    return { p[0], p[1] + a * std::abs(p[0]), 0.0 };
  });
  const auto report = Report({ source, target });
  const double edge = report->GetStatistic("SourceMeanEdgeLength");
  EXPECT_NEAR(edge, (40.0 + 16.0 * std::sqrt(2.0)) / 56.0, 1e-14);
  const double targetEdge = report->GetStatistic("TargetMeanEdgeLength");
  const double h = 0.1 * edge;
  // Along x at distance x from the crease; the other directions have half of h in x.
  const auto second = [&](double x, double step) {
    return 2.0 * a * std::max(0.0, step - std::abs(x)) / (h * h);
  };
  double sum = 0.0;
  constexpr int steps = 200000;
  for (int i = 0; i < steps; ++i)
  {
    const double x = (2.0 - h) * (i + 0.5) / steps;
    const double xx = second(x, h);
    const double yy = 2.0 / 3.0 * (2.0 * second(x, 0.5 * h) - 0.5 * xx);
    sum += xx * xx + yy * yy;
  }
  const double expected = std::sqrt(sum / steps) * edge * edge / targetEdge;
  // Sampling.
  EXPECT_NEAR(report->GetStatistic("LinearSecondDifference"), expected, 0.02 * expected);
  // Not so at the ends of the domain, where the neighbors of points are outside.
  EXPECT_LT(report->GetStatistic("LinearSecondDifferenceSamples"), 50000.0);
}

TEST(TriangulationPairReport, ContinuityIsThatOfJacobianContinuity)
{
  const MeshPair pair = MakePlanarPair(3, 13);
  const auto report = Report(pair, true);
  for (const System& system : { Linear, Contour, Smooth })
  {
    const auto continuity = Measure(pair, system);
    const std::string name = system.Name;
    EXPECT_EQ(report->GetStatistic((name + "Creases").c_str()), continuity->GetNumberOfCreases());
    EXPECT_EQ(report->GetStatistic((name + "DifferentiableEdges").c_str()),
      continuity->GetNumberOfDifferentiableEdges());
    EXPECT_EQ(report->GetStatistic((name + "LargestJump").c_str()), continuity->GetLargestJump());
  }
  EXPECT_EQ(report->GetStatistic("SmoothCreases"), 0.0);
  EXPECT_GT(report->GetStatistic("LinearCreases"), 0.0);
  EXPECT_EQ(Report(pair)->GetStatistic("LinearCreases"), -1.0);
}

TEST(TriangulationPairReport, DefectsAreDataAndNoErrors)
{
  // A triangle of the target is flipped by its inner vertex: it overlaps its neighbors.
  MeshPair pair = MakePlanarPair(4, 19, 0.0);
  MovePoint(pair.Target, 12, { 3.2, 2.0, 0.0 });
  const auto report = Report(pair, true);
  EXPECT_FALSE(report->GetValid());
  EXPECT_EQ(report->GetStatistic("Measured"), 1.0);
  ASSERT_GT(report->GetDefects()->GetNumberOfRows(), 0);
  ASSERT_TRUE(vtkStringArray::SafeDownCast(report->GetDefects()->GetColumnByName("Kind")));
  double count = 0.0;
  for (vtkIdType c = 0; c < pair.Source->GetNumberOfCells(); ++c)
  {
    const double invalid = CellValue(report->GetOutput(), "Invalid", c);
    count += invalid;
    EXPECT_EQ(invalid != 0.0, std::isnan(CellValue(report->GetOutput(), "SmallestAngle", c)));
  }
  EXPECT_GT(count, 0.0);
  EXPECT_EQ(report->GetStatistic("InvalidTriangles"), count);

  const auto none = Report({ MakePlanarPair(3, 1).Source, MakePlanarPair(4, 1).Target });
  EXPECT_FALSE(none->GetValid());
  ExpectStatistics(none, { { "Measured", 0.0 }, { "SourcePoints", 16.0 } });
  EXPECT_EQ(none->GetDefects()->GetNumberOfRows(), 2);
  EXPECT_TRUE(std::isnan(none->GetStatistic("SmoothSecondDifference")));
  EXPECT_EQ(none->GetErrorCode(), 0u);
}

TEST(TriangulationPairReport, WhatCubicCannotNumberIsNotMeasured)
{
  // More triangles than it can number after refinement, almost all of them invalid.
  std::vector<Triangle> triangles = GridTriangles(1);
  triangles.resize(std::size_t(1) << 18, Triangle{ 0, 0, 0 });
  triangles.push_back({ 0, 0, 0 });
  const auto mesh = MakeMesh(GridPoints(1, 0, 0.0), triangles);
  const auto fine = MakeAlgorithm<vtkTriangulationPairReport>({ mesh, mesh });
  fine->SetMeasureContinuity(false);
  fine->SetFairnessRefinement(4);
  fine->Update();
  EXPECT_GT(fine->GetStatistic("SmoothSamples"), 0.0);
  EXPECT_TRUE(std::isnan(fine->GetStatistic("CubicCertificate")));
  EXPECT_EQ(fine->GetStatistic("CubicUncertifiedTriangles"), -1.0);
}

TEST(TriangulationPairReport, WhatCubicDoesNotCertifyHasNoImage)
{
  // Two neighbors in the middle of a grid are a rounding unit apart in the source.
  std::vector<Point> source = GridPoints(8, 0, 0.0);
  source[41][0] = std::nextafter(source[40][0], 8.0);
  const auto report = Report({ MakeMesh(source, GridTriangles(8)), RegularGrid(8) });
  EXPECT_GT(report->GetStatistic("CubicUncertifiedTriangles"), 0.0);
  EXPECT_GT(report->GetStatistic("CubicNotPositive"), 0.0);
  EXPECT_LT(report->GetStatistic("CubicDeviationFromLinear"), 1.0);
}

TEST(TriangulationPairReport, DoesNotDependOnThreadsUnitsOrReflections)
{
  const MeshPair pair = MakePlanarPair(4, 23);
  const auto report = Report(pair);
  vtkSMPTools::Initialize(1);
  const auto single = Report(pair);
  vtkSMPTools::Initialize();
  vtkTable* table = report->GetStatistics();
  for (vtkIdType i = 0; i < table->GetNumberOfColumns(); ++i)
  {
    const char* name = table->GetColumnName(i);
    const double value = report->GetStatistic(name);
    EXPECT_TRUE(single->GetStatistic(name) == value || std::isnan(value)) << name;
  }
  const double unit = 0x1p-50;
  const auto scaled = Report(Resized(pair, unit));
  const auto mirrored = Report({ pair.Source, Mirrored(pair.Target) });
  EXPECT_EQ(report->GetStatistic("Mirrored"), 0.0);
  EXPECT_EQ(mirrored->GetStatistic("Mirrored"), 1.0);
  for (const std::string name :
    { "SmoothSecondDifference", "SourceSmallestAngle", "LargestDistortion",
      "ContourSmallestDeterminant", "SmoothSmallestDeterminant", "SmoothDeviationFromLinear" })
  {
    const double value = report->GetStatistic(name.c_str());
    const double factor = name == "SmoothDeviationFromLinear" ? unit : 1.0;
    EXPECT_EQ(scaled->GetStatistic(name.c_str()), factor * value) << name;
    EXPECT_NEAR(mirrored->GetStatistic(name.c_str()), value, 1e-12 * value) << name;
  }
}

} // namespace
