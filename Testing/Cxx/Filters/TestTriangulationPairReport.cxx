// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The report's numbers agree with closed forms and with what the other filters find.

#include "Fixtures/FilterRuns.h"

#include "vtkJacobianContinuity.h"
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
  EXPECT_FALSE(messages.HasError()) << messages.Error();
  EXPECT_FALSE(messages.HasWarning()) << messages.Warning();
  return report;
}

vtkDataArray* CellArray(vtkPolyData* mesh, const char* name)
{
  vtkDataArray* array = mesh->GetCellData()->GetArray(name);
  EXPECT_NE(array, nullptr) << name;
  return array;
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
  EXPECT_NEAR(report->GetStatistic("LargestDistortion"), 6.0, 1e-12);
  EXPECT_NEAR(report->GetStatistic("LargestStretch"), 3.0, 1e-12);
  EXPECT_NEAR(report->GetStatistic("SmallestStretch"), 0.5, 1e-12);
  EXPECT_NEAR(report->GetStatistic("SourceArea"), 25.0, 1e-12);
  EXPECT_NEAR(report->GetStatistic("TargetArea"), 37.5, 1e-12);
  // A lower bound, which leaves room for rounding.
  EXPECT_NEAR(report->GetStatistic("CubicCertificate"), 1.0, 2e-6);
  EXPECT_LE(report->GetStatistic("CubicCertificate"), 1.0);
  EXPECT_NEAR(report->GetStatistic("CubicBendingEnergy"), 0.0, 1e-20);
  EXPECT_EQ(report->GetStatistic("CubicExceptionalBoundaryVertices"), 0.0);
  for (const char* name : { "Linear", "Smooth", "Cubic" })
  {
    const std::string system = name;
    EXPECT_NEAR(report->GetStatistic((system + "SmallestDeterminant").c_str()), 1.5, 1e-11);
    EXPECT_NEAR(report->GetStatistic((system + "LargestDeterminant").c_str()), 1.5, 1e-11);
    EXPECT_NEAR(report->GetStatistic((system + "DeviationFromLinear").c_str()), 0.0, 1e-12);
    EXPECT_NEAR(report->GetStatistic((system + "SecondDifference").c_str()), 0.0, 1e-11);
    EXPECT_GT(report->GetStatistic((system + "SecondDifferenceSamples").c_str()), 10000.0);
    EXPECT_EQ(report->GetStatistic((system + "NotPositive").c_str()), 0.0);
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
  EXPECT_NEAR(report->GetStatistic("SourceSmallestAngle"), 5.0, 1e-12);
  EXPECT_EQ(report->GetStatistic("SourceSmallestAngleCell"), 1.0);
  EXPECT_DOUBLE_EQ(report->GetStatistic("SourceShareOfAnglesBelow10"), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(report->GetStatistic("SourceShareOfAnglesBelow15"), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(report->GetStatistic("TargetShareOfAnglesBelow20"), 2.0 / 3.0);
  EXPECT_NEAR(report->GetStatistic("SourceLargestAreaRatio"), 1.0 / tan5, 1e-11);
  const auto angle = [&](vtkIdType cell) {
    return CellArray(report->GetOutput(), "SmallestAngle")->GetTuple1(cell);
  };
  EXPECT_NEAR(angle(0), 45.0, 1e-12);
  EXPECT_NEAR(angle(2), 12.0, 1e-12);
  EXPECT_NEAR(
    CellArray(report->GetOutput(), "AreaRatio")->GetTuple1(2), (tan17 - tan5) / tan5, 1e-12);
  EXPECT_EQ(report->GetStatistic("SourceDiscordantTriangles"), 0.0);

  // The foot of the centroid on the longer short edge is outside it.
  const auto slanted = MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 1.5, 0.1, 0 } }, { { 0, 1, 2 } });
  const auto discordant = Report({ slanted, slanted });
  EXPECT_EQ(discordant->GetStatistic("TargetDiscordantTriangles"), 1.0);
  EXPECT_EQ(CellArray(discordant->GetOutput(), "Concordant")->GetTuple1(0), 0.0);
  EXPECT_EQ(CellArray(discordant->GetOutput(), "Invalid")->GetTuple1(0), 0.0);
}

TEST(TriangulationPairReport, CountsAgreeWithTopology)
{
  const auto square = Report(MakePlanarPair(4, 7));
  EXPECT_EQ(square->GetStatistic("Components"), 1.0);
  EXPECT_EQ(square->GetStatistic("BoundaryLoops"), 1.0);
  EXPECT_EQ(square->GetStatistic("BoundaryEdges"), 16.0);
  EXPECT_EQ(square->GetStatistic("InteriorEdges"), 40.0);
  EXPECT_EQ(square->GetStatistic("SourceUnusedPoints"), 0.0);

  const auto closed = Report(MakeClosedPair(2, 5));
  EXPECT_EQ(closed->GetStatistic("BoundaryLoops"), 0.0);
  EXPECT_EQ(closed->GetStatistic("SourcePlanar"), 0.0);
  // Euler.
  EXPECT_EQ(closed->GetStatistic("SourcePoints") - closed->GetStatistic("InteriorEdges") +
      closed->GetStatistic("SourceTriangles"),
    2.0);
  EXPECT_TRUE(std::isnan(closed->GetStatistic("SmoothSecondDifference")));
  EXPECT_GT(closed->GetStatistic("SmoothSmallestDeterminant"), 0.0);

  // A ring of 8 triangles around a hole, one wound otherwise, and a point twice, unused.
  std::vector<Point> points;
  for (int k = 0; k < 8; ++k)
  {
    const double angle = vtkMath::Pi() / 4.0 * k;
    const double radius = k % 2 == 0 ? 1.0 : 2.0;
    points.push_back({ radius * std::cos(angle), radius * std::sin(angle), 0.0 });
  }
  points.push_back(points[3]);
  std::vector<Triangle> triangles;
  for (vtkIdType k = 0; k < 8; ++k)
  {
    triangles.push_back({ k, (k + 1) % 8, (k + 2) % 8 });
    if (k % 2 == 1)
    {
      std::swap(triangles.back()[0], triangles.back()[1]);
    }
  }
  std::swap(triangles[0][0], triangles[0][1]);
  const auto mesh = MakeMesh(points, triangles);
  const auto ring = Report({ mesh, mesh });
  EXPECT_EQ(ring->GetStatistic("BoundaryLoops"), 2.0);
  EXPECT_EQ(ring->GetStatistic("OppositeWindings"), 1.0);
  EXPECT_EQ(ring->GetStatistic("SourceUnusedPoints"), 1.0);
  EXPECT_EQ(ring->GetStatistic("TargetDuplicatePoints"), 1.0);
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
  for (const int system : { 0, 1 })
  {
    const auto map = MakeAlgorithm<vtkDifferentiableHomeomorphism>(pair);
    map->SetDataObject(MakeCloud({ point }));
    map->SetCoordinateSystem(system == 0 ? vtkDifferentiableHomeomorphism::LINEAR
                                         : vtkDifferentiableHomeomorphism::SMOOTH);
    map->ComputeTriangleIdOn();
    map->Update();
    auto* output = vtkPointSet::SafeDownCast(map->GetOutputDataObject(0));
    images[system] = PointOf(output, 0);
    EXPECT_EQ(PointArray(output, "TriangleId")->GetTuple1(0),
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
  const auto source = RegularGrid(4);
  const auto target = RegularGrid(4);
  for (vtkIdType i = 0; i < source->GetNumberOfPoints(); ++i)
  {
    const Point p = PointOf(source, i);
    source->GetPoints()->SetPoint(i, p[0] - 2.0, p[1], 0.0);
    target->GetPoints()->SetPoint(i, p[0] - 2.0, p[1] + a * std::abs(p[0] - 2.0), 0.0);
  }
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
  for (int system = 0; system < 3; ++system)
  {
    const auto continuity = MakeAlgorithm<vtkJacobianContinuity>(pair);
    continuity->SetCoordinateSystem(system);
    continuity->SetDiscordantTriangles(vtkJacobianContinuity::USE_LINEAR);
    continuity->Update();
    const std::string name = system == 0 ? "Linear" : system == 1 ? "Contour" : "Smooth";
    EXPECT_EQ(report->GetStatistic((name + "Creases").c_str()), continuity->GetNumberOfCreases());
    EXPECT_EQ(report->GetStatistic((name + "DifferentiableEdges").c_str()),
      continuity->GetNumberOfDifferentiableEdges());
    EXPECT_EQ(report->GetStatistic((name + "LargestJump").c_str()), continuity->GetLargestJump());
  }
  EXPECT_EQ(report->GetStatistic("SmoothCreases"), 0.0);
  EXPECT_GT(report->GetStatistic("LinearCreases"), 0.0);
  EXPECT_EQ(Report(pair)->GetStatistic("LinearCreases"), -1.0);
}

TEST(TriangulationPairReport, AMirrorImageIsMeasuredLikeItsOriginal)
{
  const MeshPair pair = MakePlanarPair(4, 17);
  const MeshPair mirrored{ pair.Source, Moved(pair.Target, [](const Point& p) -> Point {
                            return { -p[0], p[1], p[2] };
                          }) };
  const auto a = Report(pair);
  const auto b = Report(mirrored);
  EXPECT_EQ(a->GetStatistic("Mirrored"), 0.0);
  EXPECT_EQ(b->GetStatistic("Mirrored"), 1.0);
  for (const char* name : { "SmoothSmallestDeterminant", "SmoothSecondDifference",
         "SmoothDeviationFromLinear", "LargestDistortion" })
  {
    EXPECT_NEAR(a->GetStatistic(name), b->GetStatistic(name), 1e-12 * a->GetStatistic(name));
  }
}

TEST(TriangulationPairReport, DefectsAreDataAndNoErrors)
{
  // A triangle of the target is flipped by its inner vertex: it overlaps its neighbors.
  MeshPair pair = MakePlanarPair(4, 19, 0.0);
  pair.Target->GetPoints()->SetPoint(12, 3.2, 2.0, 0.0);
  const auto report = Report(pair, true);
  EXPECT_FALSE(report->GetValid());
  EXPECT_EQ(report->GetStatistic("Measured"), 1.0);
  ASSERT_GT(report->GetDefects()->GetNumberOfRows(), 0);
  const auto* kinds = vtkStringArray::SafeDownCast(report->GetDefects()->GetColumnByName("Kind"));
  ASSERT_NE(kinds, nullptr);
  vtkDataArray* invalid = CellArray(report->GetOutput(), "Invalid");
  double count = 0.0;
  for (vtkIdType c = 0; c < invalid->GetNumberOfTuples(); ++c)
  {
    count += invalid->GetTuple1(c);
    EXPECT_EQ(invalid->GetTuple1(c) != 0.0,
      std::isnan(CellArray(report->GetOutput(), "SmallestAngle")->GetTuple1(c)));
  }
  EXPECT_GT(count, 0.0);
  EXPECT_EQ(report->GetStatistic("InvalidTriangles"), count);

  const auto none = Report({ MakePlanarPair(3, 1).Source, MakePlanarPair(4, 1).Target });
  EXPECT_FALSE(none->GetValid());
  EXPECT_EQ(none->GetStatistic("Measured"), 0.0);
  EXPECT_EQ(none->GetStatistic("SourcePoints"), 16.0);
  EXPECT_EQ(none->GetDefects()->GetNumberOfRows(), 2);
  EXPECT_TRUE(std::isnan(none->GetStatistic("SmoothSecondDifference")));
  EXPECT_EQ(none->GetErrorCode(), 0u);
}

TEST(TriangulationPairReport, DoesNotDependOnThreadsOrUnits)
{
  const MeshPair pair = MakePlanarPair(4, 23);
  const auto report = Report(pair);
  vtkSMPTools::Initialize(1);
  const auto single = Report(pair);
  vtkSMPTools::Initialize();
  const double unit = 0x1p-50;
  const auto scaled = Report({ Resized(pair.Source, unit), Resized(pair.Target, unit) });
  vtkTable* table = report->GetStatistics();
  for (vtkIdType i = 0; i < table->GetNumberOfColumns(); ++i)
  {
    const char* name = table->GetColumnName(i);
    const double value = report->GetStatistic(name);
    EXPECT_TRUE(single->GetStatistic(name) == value || std::isnan(value)) << name;
  }
  for (const char* name : { "SmoothSecondDifference", "SourceSmallestAngle", "LargestDistortion",
         "ContourSmallestDeterminant" })
  {
    EXPECT_EQ(scaled->GetStatistic(name), report->GetStatistic(name)) << name;
  }
  EXPECT_EQ(scaled->GetStatistic("SmoothDeviationFromLinear"),
    unit * report->GetStatistic("SmoothDeviationFromLinear"));
}

} // namespace
