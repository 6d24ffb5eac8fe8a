// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The filter finds creases exactly where they are.

#include "Fixtures/FilterRuns.h"
#include "Fixtures/MeasuredMaps.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkJacobianContinuity.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <set>
#include <utility>
#include <vector>

namespace
{

using namespace fixtures;

vtkSmartPointer<vtkJacobianContinuity> Measure(
  vtkPolyData* source, vtkPolyData* target, int coordinateSystem)
{
  auto filter = vtkSmartPointer<vtkJacobianContinuity>::New();
  filter->SetSourceData(source);
  filter->SetTargetData(target);
  filter->SetCoordinateSystem(coordinateSystem);
  filter->SetDiscordantTriangles(vtkJacobianContinuity::USE_LINEAR);
  filter->Update();
  return filter;
}

vtkSmartPointer<vtkJacobianContinuity> Measure(
  vtkPolyData* source, vtkAbstractTransform* transform, bool secondDerivatives = false)
{
  auto filter = vtkSmartPointer<vtkJacobianContinuity>::New();
  filter->SetSourceData(source);
  filter->SetTransform(transform);
  filter->SetSecondDerivatives(secondDerivatives);
  filter->Update();
  return filter;
}

vtkDataArray* EdgeArray(vtkJacobianContinuity* filter, const char* name)
{
  return filter->GetOutput()->GetCellData()->GetArray(name);
}

vtkDataArray* SampleArray(vtkJacobianContinuity* filter, const char* name)
{
  return filter->GetOutput()->GetPointData()->GetArray(name);
}

/// Every estimate is within its own bound of the closed form. Returns the median of bound over jump
/// where there is a jump.
double ExpectAgreementWithClosedForm(vtkJacobianContinuity* filter)
{
  vtkDataArray* jump = SampleArray(filter, "JacobianJump");
  vtkDataArray* error = SampleArray(filter, "JacobianJumpError");
  vtkDataArray* exact = SampleArray(filter, "JacobianJumpExact");
  std::vector<double> relative;
  vtkIdType beyond = 0;
  for (vtkIdType i = 0; i < jump->GetNumberOfTuples(); ++i)
  {
    if (std::isnan(jump->GetTuple1(i)))
    {
      continue;
    }
    const double difference = std::abs(jump->GetTuple1(i) - exact->GetTuple1(i));
    beyond += !(difference <= error->GetTuple1(i));
    if (exact->GetTuple1(i) > 1e-3)
    {
      relative.push_back(error->GetTuple1(i) / exact->GetTuple1(i));
    }
  }
  EXPECT_EQ(beyond, 0) << "samples whose estimate is off by more than its bound";
  if (relative.empty())
  {
    return 0.0;
  }
  std::nth_element(
    relative.begin(), relative.begin() + static_cast<long>(relative.size() / 2), relative.end());
  return relative[relative.size() / 2];
}

void ExpectVerdictsOfAllSystems(const MeshPair& pair)
{
  for (const int system : { vtkJacobianContinuity::LINEAR, vtkJacobianContinuity::CONTOUR,
         vtkJacobianContinuity::SMOOTH })
  {
    SCOPED_TRACE("system " + std::to_string(system));
    const auto filter = Measure(pair.Source, pair.Target, system);
    const vtkIdType edges = filter->GetOutput()->GetNumberOfCells();
    ASSERT_GT(edges, 0);
    EXPECT_LT(ExpectAgreementWithClosedForm(filter), 1e-6);
    vtkDataArray* exact = EdgeArray(filter, "JacobianJumpExact");
    vtkDataArray* verdict = EdgeArray(filter, "Verdict");
    vtkDataArray* order = EdgeArray(filter, "ConvergenceOrder");
    vtkIdType wrong = 0;
    for (vtkIdType i = 0; i < edges; ++i)
    {
      const int expected = exact->GetTuple1(i) > filter->GetResolution()
        ? vtkJacobianContinuity::CREASE
        : vtkJacobianContinuity::DIFFERENTIABLE;
      const auto found = static_cast<int>(verdict->GetTuple1(i));
      wrong += found != expected && found != vtkJacobianContinuity::UNDECIDED;
      if (found == vtkJacobianContinuity::CREASE)
      {
        EXPECT_NEAR(order->GetTuple1(i), 0.0, 0.3);
      }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_LE(filter->GetNumberOfUndecidedEdges(), edges / 100);
    EXPECT_EQ(filter->GetNumberOfDifferentiableEdges() + filter->GetNumberOfCreases() +
        filter->GetNumberOfUndecidedEdges(),
      edges);
    if (system == vtkJacobianContinuity::SMOOTH)
    {
      EXPECT_EQ(filter->GetNumberOfCreases(), 0);
    }
    else
    {
      EXPECT_EQ(filter->GetNumberOfDifferentiableEdges(), 0);
    }
    std::cout << "system " << system << ": " << edges << " edges, "
              << filter->GetNumberOfUndecidedEdges() << " undecided\n";
  }
}

TEST(JacobianContinuity, PlanarPairs)
{
  ExpectVerdictsOfAllSystems(MakePlanarPair(30, 3));
}

TEST(JacobianContinuity, ClosedSurfaces)
{
  ExpectVerdictsOfAllSystems(MakeClosedPair(3, 5));
}

TEST(JacobianContinuity, SimilarMeshesHaveNoJump)
{
  const std::vector<Point> points = GridPoints(10, 4, 0.2);
  std::vector<Point> turned = points;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    turned[i] = { 3.0 * points[i][0] - 4.0 * points[i][1] + 1.0,
      4.0 * points[i][0] + 3.0 * points[i][1], 0.0 };
  }
  for (int system = 0; system < 3; ++system)
  {
    const auto filter =
      Measure(MakeMesh(points, GridTriangles(10)), MakeMesh(turned, GridTriangles(10)), system);
    EXPECT_EQ(filter->GetNumberOfDifferentiableEdges(), filter->GetOutput()->GetNumberOfCells());
  }
}

TEST(JacobianContinuity, AHomeomorphismTransformIsMeasuredLikeAnyTransform)
{
  const MeshPair pair = MakePlanarPair(10, 6);
  vtkNew<vtkHomeomorphismTransform> transform;
  transform->SetSource(pair.Source);
  transform->SetTarget(pair.Target);
  for (int system = 0; system < 3; ++system)
  {
    transform->SetCoordinateSystem(system);
    transform->SetDiscordantTriangles(vtkHomeomorphismTransform::USE_LINEAR);
    const auto byTransform = Measure(pair.Source, transform);
    const auto byTarget = Measure(pair.Source, pair.Target, system);
    EXPECT_EQ(byTransform->GetNumberOfCreases(), byTarget->GetNumberOfCreases());
    ExpectAgreementWithClosedForm(byTransform);
    // On a copy of the mesh, only the values of the map are available.
    vtkNew<vtkPolyData> copy;
    copy->DeepCopy(pair.Source);
    const auto fromOutside = Measure(copy, transform);
    EXPECT_EQ(fromOutside->GetNumberOfCreases(), byTarget->GetNumberOfCreases());
    EXPECT_TRUE(std::isnan(EdgeArray(fromOutside, "JacobianJumpExact")->GetTuple1(0)));
  }
}

TEST(JacobianContinuity, ThinPlateSplinesAreDifferentiable)
{
  const MeshPair pair = MakePlanarPair(15, 9);
  const auto spline = MakeThinPlateSpline(pair, 11);
  const auto filter = Measure(pair.Source, spline);
  EXPECT_EQ(filter->GetNumberOfCreases(), 0);
  EXPECT_LE(filter->GetNumberOfUndecidedEdges(), filter->GetOutput()->GetNumberOfCells() / 100);
}

/// Exactly the edges on the line x = 7 of a grid of n x n squares should have the verdict.
void ExpectCreasesOnTheLineOnly(vtkJacobianContinuity* filter, const char* verdictName, int n)
{
  vtkDataArray* verdict = EdgeArray(filter, verdictName);
  vtkIdType onLine = 0;
  for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfCells(); ++i)
  {
    double bounds[6];
    filter->GetOutput()->GetCellBounds(i, bounds);
    const bool isOnLine = bounds[0] == 7.0 && bounds[1] == 7.0;
    onLine += isOnLine;
    EXPECT_EQ(static_cast<int>(verdict->GetTuple1(i)),
      isOnLine ? vtkJacobianContinuity::CREASE : vtkJacobianContinuity::DIFFERENTIABLE);
  }
  EXPECT_EQ(onLine, n);
}

TEST(JacobianContinuity, SmallCreasesAreFound)
{
  vtkNew<PiecewiseMap> map;
  map->Amount = 1e-6;
  const auto filter = Measure(RegularGrid(14), map);
  ExpectCreasesOnTheLineOnly(filter, "Verdict", 14);
}

TEST(JacobianContinuity, OnceDifferentiableMapsAreDifferentiable)
{
  vtkNew<PiecewiseMap> map;
  map->Amount = 0.1;
  map->Exponent = 2;
  const auto once = Measure(RegularGrid(14), map, true);
  EXPECT_EQ(once->GetNumberOfCreases(), 0);
  EXPECT_EQ(once->GetNumberOfUndecidedEdges(), 0);
  ExpectCreasesOnTheLineOnly(once, "SecondDerivativeVerdict", 14);

  map->Exponent = 3;
  map->Modified();
  const auto twice = Measure(RegularGrid(14), map, true);
  vtkDataArray* second = EdgeArray(twice, "SecondDerivativeVerdict");
  for (vtkIdType i = 0; i < second->GetNumberOfTuples(); ++i)
  {
    EXPECT_EQ(second->GetTuple1(i), vtkJacobianContinuity::DIFFERENTIABLE);
  }
}

TEST(JacobianContinuity, JumpsOfAKnownMapAreExact)
{
  // Two squares, the second stretched along x by 1 + a and sheared by b: across the edge x = 1 the
  // derivative in its direction changes from (1, 0) to (1 + a, b).
  const double a = 0.5;
  const double b = 0.25;
  const std::vector<Triangle> triangles{ { 0, 1, 4 }, { 0, 4, 3 }, { 1, 2, 5 }, { 1, 5, 4 } };
  const auto source = MakeMesh(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 }, { 2, 1, 0 } }, triangles);
  const auto target = MakeMesh(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 2 + a, b, 0 }, { 0, 1, 0 }, { 1, 1, 0 }, { 2 + a, 1 + b, 0 } },
    triangles);
  const auto filter = Measure(source, target, vtkJacobianContinuity::LINEAR);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 3);
  EXPECT_EQ(filter->GetNumberOfBoundaryEdges(), 6);
  EXPECT_EQ(filter->GetNumberOfCreases(), 1);
  const double norm = std::hypot(1.0, 0.5 * (1.0 + std::hypot(1.0 + a, b)));
  for (vtkIdType i = 0; i < 3; ++i)
  {
    if (EdgeArray(filter, "Verdict")->GetTuple1(i) != vtkJacobianContinuity::CREASE)
    {
      continue;
    }
    EXPECT_NEAR(EdgeArray(filter, "JacobianJump")->GetTuple1(i), std::hypot(a, b) / norm, 1e-9);
    EXPECT_NEAR(EdgeArray(filter, "NormalJump")->GetTuple1(i), a / norm, 1e-9);
    EXPECT_NEAR(EdgeArray(filter, "TangentialJump")->GetTuple1(i), b / norm, 1e-9);
    EXPECT_NEAR(EdgeArray(filter, "AngleJump")->GetTuple1(i),
      std::atan2(b, 1.0 + a) * 180.0 / std::acos(-1.0), 1e-7);
    EXPECT_NEAR(EdgeArray(filter, "StretchJump")->GetTuple1(i), std::hypot(1.0 + a, b) - 1.0, 1e-9);
    double cells[2];
    EdgeArray(filter, "EdgeTriangles")->GetTuple(i, cells);
    EXPECT_EQ((std::set<double>{ cells[0], cells[1] }), (std::set<double>{ 0.0, 3.0 }));
  }
}

TEST(JacobianContinuity, TrianglesAndPointsHaveTheLargestJumpOfTheirEdges)
{
  const MeshPair pair = MakePlanarPair(6, 2);
  const auto filter = Measure(pair.Source, pair.Target, vtkJacobianContinuity::LINEAR);
  auto* colored = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  vtkDataArray* triangleJump = colored->GetCellData()->GetArray("JacobianJump");
  vtkDataArray* pointJump = colored->GetPointData()->GetArray("JacobianJump");
  std::vector<double> largest(colored->GetNumberOfCells(), 0.0);
  for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfCells(); ++i)
  {
    double cells[2];
    EdgeArray(filter, "EdgeTriangles")->GetTuple(i, cells);
    for (const double cell : cells)
    {
      double& value = largest[static_cast<std::size_t>(cell)];
      value = std::max(value, EdgeArray(filter, "JacobianJump")->GetTuple1(i));
    }
  }
  for (vtkIdType t = 0; t < colored->GetNumberOfCells(); ++t)
  {
    EXPECT_EQ(triangleJump->GetTuple1(t), largest[t]);
  }
  EXPECT_EQ(pointJump->GetRange()[1], filter->GetLargestJump());
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells() * 2 + filter->GetNumberOfBoundaryEdges(),
    3 * pair.Source->GetNumberOfCells());
}

/// A map with modified values.
class AlteredMap : public PiecewiseMap
{
public:
  static AlteredMap* New();
  vtkTypeMacro(AlteredMap, PiecewiseMap);
  std::function<double(double)> Alter;
  vtkAbstractTransform* MakeTransform() override { return AlteredMap::New(); }

protected:
  using PiecewiseMap::ForwardTransformPoint;
  void ForwardTransformPoint(const double in[3], double out[3]) override
  {
    this->Map(in, out);
    out[0] = this->Alter(out[0]);
    out[1] = this->Alter(out[1]);
  }
};
vtkStandardNewMacro(AlteredMap);

TEST(JacobianContinuity, ValuesOfFewDigitsAreNotMistakenForCreases)
{
  vtkNew<AlteredMap> map;
  for (const std::function<double(double)>& alter :
    { std::function<double(double)>([](double x) { return double(static_cast<float>(x)); }),
      std::function<double(double)>([](double x) { return std::round(1e6 * x) / 1e6; }) })
  {
    map->Alter = alter;
    map->Amount = 0.0;
    map->Modified();
    EXPECT_EQ(Measure(RegularGrid(14), map)->GetNumberOfCreases(), 0);
    map->Amount = 0.5;
    map->Modified();
    EXPECT_EQ(Measure(RegularGrid(14), map)->GetNumberOfCreases(), 14);
  }
}

TEST(JacobianContinuity, NonFiniteValuesAreUndecided)
{
  vtkNew<AlteredMap> map;
  map->Alter = [](double x) { return x > 3.5 ? std::numeric_limits<double>::quiet_NaN() : x; };
  const auto filter = Measure(RegularGrid(14), map);
  vtkIdType unknown = 0;
  for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfCells(); ++i)
  {
    const double jump = EdgeArray(filter, "JacobianJump")->GetTuple1(i);
    EXPECT_NE(EdgeArray(filter, "Verdict")->GetTuple1(i), vtkJacobianContinuity::CREASE);
    EXPECT_TRUE(std::isnan(jump) || jump < 1e-6) << jump;
    unknown += std::isnan(jump);
  }
  EXPECT_GT(unknown, 100);
}

TEST(JacobianContinuity, NationalGridsAreMeasured)
{
  // Seven digits before the decimal point: many verdicts are undecided, none is wrong.
  const MeshPair near = MakePlanarPair(12, 3, 0.2);
  MeshPair far;
  for (auto side : { &MeshPair::Source, &MeshPair::Target })
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (vtkIdType i = 0; i < (near.*side)->GetNumberOfPoints(); ++i)
    {
      double point[3];
      (near.*side)->GetPoint(i, point);
      points->InsertNextPoint(1000.0 * point[0] + 3.2e6, 1000.0 * point[1] + 6.7e6, 0.0);
    }
    far.*side = vtkSmartPointer<vtkPolyData>::New();
    (far.*side)->SetPoints(points);
    (far.*side)->SetPolys((near.*side)->GetPolys());
  }
  for (int system = 0; system < 3; ++system)
  {
    const auto filter = Measure(far.Source, far.Target, system);
    const vtkIdType edges = filter->GetOutput()->GetNumberOfCells();
    if (system == vtkJacobianContinuity::SMOOTH)
    {
      EXPECT_EQ(filter->GetNumberOfCreases(), 0);
    }
    else
    {
      EXPECT_EQ(filter->GetNumberOfDifferentiableEdges(), 0);
      EXPECT_GT(filter->GetNumberOfCreases(), edges * 9 / 10);
    }
  }
}

TEST(JacobianContinuity, ScaleDoesNotMatter)
{
  const MeshPair pair = MakePlanarPair(4, 3, 0.2);
  for (const double scale : { 1e-300, 1e-160, 1e160, 1e300 })
  {
    MeshPair scaled;
    for (auto side : { &MeshPair::Source, &MeshPair::Target })
    {
      vtkNew<vtkPoints> points;
      points->SetDataTypeToDouble();
      for (vtkIdType i = 0; i < (pair.*side)->GetNumberOfPoints(); ++i)
      {
        double point[3];
        (pair.*side)->GetPoint(i, point);
        points->InsertNextPoint(scale * point[0], scale * point[1], 0.0);
      }
      scaled.*side = vtkSmartPointer<vtkPolyData>::New();
      (scaled.*side)->SetPoints(points);
      (scaled.*side)->SetPolys((pair.*side)->GetPolys());
    }
    for (int system = 0; system < 3; ++system)
    {
      SCOPED_TRACE(
        "scale " + std::to_string(std::log10(scale)) + ", system " + std::to_string(system));
      const auto expected = Measure(pair.Source, pair.Target, system);
      const auto found = Measure(scaled.Source, scaled.Target, system);
      EXPECT_EQ(found->GetNumberOfCreases(), expected->GetNumberOfCreases());
      EXPECT_EQ(
        found->GetNumberOfDifferentiableEdges(), expected->GetNumberOfDifferentiableEdges());
    }
  }
}

TEST(JacobianContinuity, AHomeomorphismTransformIsMeasuredOnOtherTriangles)
{
  const MeshPair pair = MakePlanarPair(5, 6);
  vtkNew<vtkHomeomorphismTransform> transform;
  transform->SetSource(pair.Source);
  transform->SetTarget(pair.Target);
  vtkNew<vtkPolyData> part;
  part->SetPoints(pair.Source->GetPoints());
  vtkNew<vtkCellArray> triangles;
  triangles->InsertNextCell({ 0, 1, 7 });
  triangles->InsertNextCell({ 1, 2, 7 });
  part->SetPolys(triangles);
  Messages messages(transform.Get());
  const auto filter = Measure(part, transform);
  EXPECT_EQ(messages.Error(), "");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 1);
  EXPECT_EQ(filter->GetErrorCode(), 0u);
}

TEST(JacobianContinuity, StretchAlongTheEdgeHidesNoCrease)
{
  // The map stretches by 1 and 3 across an edge, and by 1e8 along it.
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 1, 0, 3 } };
  const auto source =
    MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 1, 0 }, { 0.5, -1, 0 } }, triangles);
  const auto target =
    MakeMesh({ { 0, 0, 0 }, { 1e8, 0, 0 }, { 0.5e8, 1, 0 }, { 0.5e8, -3, 0 } }, triangles);
  const auto filter = Measure(source, target, vtkJacobianContinuity::LINEAR);
  EXPECT_EQ(filter->GetNumberOfDifferentiableEdges(), 0);
}

TEST(JacobianContinuity, VerdictsDoNotDependOnTheOrigin)
{
  // Coordinates as those of Mercator projections: triangles of 10 m, 15,000 km from the origin. The
  // points are multiples of 2^-20, so that moving them rounds nothing.
  const auto moved = [](vtkPolyData* mesh, const Point& offset) {
    std::vector<Point> points;
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
    {
      Point p;
      Point q;
      mesh->GetPoint(i, p.data());
      for (int axis = 0; axis < 3; ++axis)
      {
        q[axis] = std::ldexp(std::rint(std::ldexp(10.0 * p[axis], 20)), -20) + offset[axis];
      }
      points.push_back(q);
    }
    return MakeMesh(points, GridTriangles(5));
  };
  const MeshPair pair = MakePlanarPair(5, 21);
  const Point far{ 14650000.0, 3840000.0, 0.0 };
  for (const int system : { vtkJacobianContinuity::LINEAR, vtkJacobianContinuity::CONTOUR,
         vtkJacobianContinuity::SMOOTH })
  {
    SCOPED_TRACE(system);
    const auto run = [&](const Point& source, const Point& target) {
      vtkNew<vtkJacobianContinuity> filter;
      filter->SetSourceData(moved(pair.Source, source));
      filter->SetTargetData(moved(pair.Target, target));
      filter->SetCoordinateSystem(system);
      filter->SetDiscordantTriangles(vtkJacobianContinuity::USE_LINEAR);
      filter->SpokesOn();
      filter->WingSegmentsOn();
      filter->StripBordersOn();
      filter->CentroidsOn();
      filter->VerticesOn();
      filter->Update();
      vtkSmartPointer<vtkPolyData> lines = vtkPolyData::SafeDownCast(filter->GetOutput());
      return lines;
    };
    const vtkSmartPointer<vtkPolyData> centered = run({}, {});
    vtkDataArray* expected = centered->GetCellData()->GetArray("Verdict");
    vtkDataArray* jumps = centered->GetCellData()->GetArray("JacobianJump");
    ASSERT_GT(expected->GetNumberOfTuples(), 200);
    for (const auto& [source, target] :
      { std::pair<Point, Point>{ far, {} }, { {}, far }, { far, far } })
    {
      const vtkSmartPointer<vtkPolyData> output = run(source, target);
      vtkDataArray* verdicts = output->GetCellData()->GetArray("Verdict");
      vtkDataArray* found = output->GetCellData()->GetArray("JacobianJump");
      ASSERT_EQ(expected->GetNumberOfTuples(), verdicts->GetNumberOfTuples());
      for (vtkIdType i = 0; i < expected->GetNumberOfTuples(); ++i)
      {
        EXPECT_EQ(expected->GetTuple1(i), verdicts->GetTuple1(i)) << "feature " << i;
        if (std::isfinite(jumps->GetTuple1(i)))
        {
          EXPECT_NEAR(jumps->GetTuple1(i), found->GetTuple1(i), 1e-8) << "feature " << i;
        }
      }
    }
  }
}

TEST(JacobianContinuity, NeedsAMap)
{
  vtkNew<vtkJacobianContinuity> filter;
  filter->SetSourceData(RegularGrid(2));
  Messages messages(filter.Get());
  filter->Update();
  EXPECT_NE(messages.Error().find("There is no map to measure"), std::string::npos);
}

TEST(JacobianContinuity, TransformsOfSurfacesAreRefused)
{
  vtkNew<PiecewiseMap> map;
  vtkNew<vtkJacobianContinuity> filter;
  filter->SetSourceData(MakeSheet(5, 1, 0.5));
  filter->SetTransform(map);
  Messages messages(filter.Get());
  filter->Update();
  EXPECT_NE(messages.Error().find("planar triangulation only"), std::string::npos);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
}

} // namespace
