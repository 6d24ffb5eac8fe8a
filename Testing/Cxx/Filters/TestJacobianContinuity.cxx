// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The filter finds all creases, and no others, at features of every type.

#include "Fixtures/FilterRuns.h"
#include "Fixtures/MeasuredMaps.h"

#include "vtkSMPTools.h"

namespace
{

using namespace fixtures;
using Continuity = vtkJacobianContinuity;

vtkSmartPointer<Continuity> Measure(
  vtkPolyData* source, vtkAbstractTransform* transform,
  const std::function<void(Continuity*)>& change = [](Continuity*) {})
{
  auto filter = vtkSmartPointer<Continuity>::New();
  filter->SetSourceData(source);
  filter->SetTransform(transform);
  change(filter);
  filter->Update();
  return filter;
}

double CellValue(Continuity* filter, const char* name, vtkIdType cell)
{
  return fixtures::CellValue(filter->GetOutput(), name, cell);
}

/// The values of all cells.
std::vector<double> CellValues(Continuity* filter, const char* name)
{
  return ValuesOf(CellArray(filter->GetOutput(), name));
}

std::pair<vtkIdType, vtkIdType> TrianglesAt(Continuity* filter, vtkIdType cell)
{
  const Point ids = VectorOf(CellArray(filter->GetOutput(), "EdgeTriangles"), cell);
  return { static_cast<vtkIdType>(ids[0]), static_cast<vtkIdType>(ids[1]) };
}

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

vtkIdType CountOf(Continuity* filter, int featureType)
{
  return static_cast<vtkIdType>(CellsOf(filter, featureType).size());
}

void ExpectAllDifferentiable(Continuity* filter)
{
  for (int type = 0; type <= Continuity::VERTEX; ++type)
  {
    SCOPED_TRACE("features of type " + std::to_string(type));
    EXPECT_EQ(filter->GetNumberOfFeatures(type, Continuity::CREASE), 0);
    EXPECT_EQ(filter->GetNumberOfFeatures(type, Continuity::UNDECIDED), 0);
    EXPECT_EQ(filter->GetNumberOfFeatures(type, Continuity::DIFFERENTIABLE) > 0,
      type != Continuity::BOUNDARY_EDGE);
  }
}

/// Every estimate is within its own bound of the closed form, and most bounds are narrow.
void ExpectJumpsOfTheClosedForm(Continuity* filter)
{
  vtkIdType wide = 0;
  vtkIdType jumps = 0;
  for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfPoints(); ++i)
  {
    const double jump = PointValue(filter->GetOutput(), "JacobianJump", i);
    const double bound = PointValue(filter->GetOutput(), "JacobianJumpError", i);
    const double exact = PointValue(filter->GetOutput(), "JacobianJumpExact", i);
    EXPECT_FALSE(std::abs(jump - exact) > bound);
    jumps += exact > 1e-3;
    wide += exact > 1e-3 && !(bound < 1e-6 * exact);
  }
  EXPECT_LE(2 * wide, jumps);
}

using JacobianContinuityOf = TestInEverySystem;

INSTANTIATE_TEST_SUITE_P(
  All, JacobianContinuityOf, ::testing::ValuesIn(AllSystems()), NameOfSystem);

TEST_P(JacobianContinuityOf, VerdictsAreThoseOfTheClosedForm)
{
  for (const MeshPair& pair : { MakePlanarPair(12, 3), MakeClosedPair(2, 5) })
  {
    const auto filter = Measure(pair, GetParam());
    ExpectJumpsOfTheClosedForm(filter);
    ExpectJumpsOfTheClosedForm(Measure(pair, GetParam(), ListEverything));
    const vtkIdType edges = filter->GetOutput()->GetNumberOfCells();
    for (vtkIdType i = 0; i < edges; ++i)
    {
      const bool jumps = CellValue(filter, "JacobianJumpExact", i) > filter->GetResolution();
      const double verdict = CellValue(filter, "Verdict", i);
      EXPECT_NE(verdict, jumps ? Continuity::DIFFERENTIABLE : Continuity::CREASE);
      if (verdict == Continuity::CREASE)
      {
        EXPECT_NEAR(CellValue(filter, "ConvergenceOrder", i), 0.0, 0.3);
      }
    }
    EXPECT_LE(filter->GetNumberOfUndecidedEdges(), edges / 100);
    EXPECT_EQ(filter->GetNumberOfDifferentiableEdges() + filter->GetNumberOfCreases() +
        filter->GetNumberOfUndecidedEdges(),
      edges);
    EXPECT_EQ(GetParam().CoordinateSystem == Continuity::SMOOTH
        ? filter->GetNumberOfCreases()
        : filter->GetNumberOfDifferentiableEdges(),
      0);
  }
}

TEST_P(JacobianContinuityOf, SimilarAndSomeAffinePairsAreDifferentiable)
{
  const auto source = MakeMesh(GridPoints(5, 4, 0.15), GridTriangles(5));
  const Matrix similarity{ { { 3.0, -4.0, 0.0 }, { 4.0, 3.0, 0.0 }, { 0.0, 0.0, 1.0 } } };
  const Matrix affine{ { { 1.3, 0.2, 0.0 }, { 0.1, 0.9, 0.0 }, { 0.0, 0.0, 1.0 } } };
  ExpectAllDifferentiable(
    Measure({ source, Tilted(source, similarity, { 1.0, 0.0, 0.0 }) }, GetParam(), ListEverything));
  const auto filter = Measure({ source, Tilted(source, affine, {}) }, GetParam(), ListEverything);
  if (!GetParam().IsContour())
  {
    ExpectAllDifferentiable(filter);
    return;
  }
  for (const int type :
    { Continuity::EDGE, Continuity::SPOKE, Continuity::TRIANGLE_CENTER, Continuity::VERTEX })
  {
    EXPECT_EQ(filter->GetNumberOfFeatures(type, Continuity::DIFFERENTIABLE), 0) << type;
  }
}

TEST_P(JacobianContinuityOf, ATransformIsMeasuredLikeItsMeshes)
{
  const MeshPair pair = MakePlanarPair(10, 6);
  const auto transform = MakeTransform(GetParam(), pair);
  const vtkIdType creases = Measure(pair, GetParam())->GetNumberOfCreases();
  const auto byTransform = Measure(pair.Source, transform);
  EXPECT_EQ(byTransform->GetNumberOfCreases(), creases);
  ExpectJumpsOfTheClosedForm(byTransform);
  // On a copy of the mesh, only the values of the map are available.
  const auto fromOutside = Measure(CopyOf(pair.Source.Get()), transform);
  EXPECT_EQ(fromOutside->GetNumberOfCreases(), creases);
  EXPECT_TRUE(std::isnan(CellValue(fromOutside, "JacobianJumpExact", 0)));
  // And on other triangles.
  Messages messages(transform);
  const auto part = Measure(WithTriangles(pair.Source, { { 0, 1, 12 }, { 1, 2, 12 } }), transform);
  EXPECT_FALSE(messages.HasError());
  EXPECT_EQ(part->GetOutput()->GetNumberOfCells(), 1);
  EXPECT_EQ(part->GetErrorCode(), 0u);
  // The closed form is not that of the inverse.
  transform->Inverse();
  EXPECT_TRUE(std::isnan(CellValue(Measure(pair.Source, transform), "JacobianJumpExact", 0)));
}

TEST_P(JacobianContinuityOf, VerdictsDoNotDependOnUnitAndOrigin)
{
  // Coordinates as those of Mercator projections: triangles of 10 m, 15,000 km from the origin. The
  // points are multiples of 2^-20, so that moving them rounds nothing.
  const MeshPair pair = MakePlanarPair(4, 21);
  const auto measure = [&pair](const Point& ofSource, const Point& ofTarget, int exponent) {
    const auto moved = [exponent](vtkPolyData* mesh, const Point& offset) {
      return Moved(mesh, [&](Point p) {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          const double rounded = std::ldexp(std::rint(std::ldexp(10.0 * p[axis], 20)), -20);
          p[axis] = std::ldexp(rounded + offset[axis], exponent);
        }
        return p;
      });
    };
    return Measure(
      { moved(pair.Source, ofSource), moved(pair.Target, ofTarget) }, GetParam(), ListEverything);
  };
  const Point far{ 14650000.0, 3840000.0, 0.0 };
  const auto expected = measure({}, {}, 0);
  const std::vector<double> jumps = CellValues(expected, "JacobianJump");
  for (const auto& found :
    { measure(far, {}, 0), measure({}, far, 0), measure(far, far, 0), measure({}, {}, -1000),
      measure({}, {}, -530), measure({}, {}, 530), measure({}, {}, 990) })
  {
    EXPECT_EQ(CellValues(found, "Verdict"), CellValues(expected, "Verdict"));
    const std::vector<double> others = CellValues(found, "JacobianJump");
    for (std::size_t i = 0; i < jumps.size(); ++i)
    {
      EXPECT_TRUE(!std::isfinite(jumps[i]) || std::abs(others.at(i) - jumps[i]) < 1e-8) << i;
    }
  }
}

TEST(JacobianContinuity, StretchAlongTheEdgeHidesNoCrease)
{
  // The map stretches by 1 and 3 across an edge, and by 1e8 along it.
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 1, 0, 3 } };
  const auto source =
    MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 1, 0 }, { 0.5, -1, 0 } }, triangles);
  const auto target =
    MakeMesh({ { 0, 0, 0 }, { 1e8, 0, 0 }, { 0.5e8, 1, 0 }, { 0.5e8, -3, 0 } }, triangles);
  EXPECT_EQ(Measure({ source, target }, Linear)->GetNumberOfDifferentiableEdges(), 0);
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
  AddVerticesAndLines(source, 2, 1); // shifts the cell ids by three
  const auto filter = Measure({ source, target }, Linear);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 3);
  EXPECT_EQ(filter->GetNumberOfBoundaryEdges(), 6);
  EXPECT_EQ(filter->GetNumberOfCreases(), 1);
  const double norm = std::hypot(1.0, 0.5 * (1.0 + std::hypot(1.0 + a, b)));
  for (vtkIdType i = 0; i < 3; ++i)
  {
    if (CellValue(filter, "Verdict", i) != Continuity::CREASE)
    {
      continue;
    }
    EXPECT_NEAR(CellValue(filter, "JacobianJump", i), std::hypot(a, b) / norm, 1e-9);
    EXPECT_NEAR(CellValue(filter, "NormalJump", i), a / norm, 1e-9);
    EXPECT_NEAR(CellValue(filter, "TangentialJump", i), b / norm, 1e-9);
    EXPECT_NEAR(
      CellValue(filter, "AngleJump", i), std::atan2(b, 1.0 + a) * 180.0 / std::acos(-1.0), 1e-7);
    EXPECT_NEAR(CellValue(filter, "StretchJump", i), std::hypot(1.0 + a, b) - 1.0, 1e-9);
    const auto [first, second] = TrianglesAt(filter, i);
    EXPECT_EQ((std::set<vtkIdType>{ first, second }), (std::set<vtkIdType>{ 3, 6 }));
  }
}

/// The edges on the line x = 7 of a grid of 14 x 14 squares, and no others, have the verdict.
void ExpectCreasesOnTheLineOnly(Continuity* filter, const char* verdict)
{
  vtkIdType onLine = 0;
  for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfCells(); ++i)
  {
    const double* bounds = filter->GetOutput()->GetCell(i)->GetBounds();
    const bool isOnLine = bounds[0] == 7.0 && bounds[1] == 7.0;
    onLine += isOnLine;
    EXPECT_EQ(
      CellValue(filter, verdict, i), isOnLine ? Continuity::CREASE : Continuity::DIFFERENTIABLE);
  }
  EXPECT_EQ(onLine, 14);
}

TEST(JacobianContinuity, CreasesOfTransformsAreFoundByTheirValues)
{
  vtkNew<PiecewiseMap> map;
  map->Amount = 1e-6;
  ExpectCreasesOnTheLineOnly(Measure(RegularGrid(14), map), "Verdict");

  // Once differentiable only.
  map->Amount = 0.1;
  map->Exponent = 2;
  map->Modified();
  const auto once = Measure(RegularGrid(14), map, &Continuity::SecondDerivativesOn);
  EXPECT_EQ(once->GetNumberOfDifferentiableEdges(), once->GetOutput()->GetNumberOfCells());
  ExpectCreasesOnTheLineOnly(once, "SecondDerivativeVerdict");

  map->Exponent = 3;
  map->Modified();
  const auto twice = Measure(RegularGrid(14), map, &Continuity::SecondDerivativesOn);
  for (const double verdict : CellValues(twice, "SecondDerivativeVerdict"))
  {
    EXPECT_EQ(verdict, Continuity::DIFFERENTIABLE);
  }
}

TEST(JacobianContinuity, AnyTransformIsMeasuredAtAllFeatures)
{
  const MeshPair pair = MakePlanarPair(8, 9, 0.15);
  ExpectAllDifferentiable(Measure(pair.Source, MakeThinPlateSpline(pair, 7), ListEverything));

  // A crease along a line of the grid, hence at the points on it, also at the ends of the line,
  // where half of the directions are inside.
  vtkNew<PiecewiseMap> pieces;
  pieces->Amount = 0.2;
  const auto filter = Measure(RegularGrid(9), pieces, ListEverything);
  for (int type = 0; type <= Continuity::VERTEX; ++type)
  {
    const vtkIdType creases = type == Continuity::EDGE ? 9 : type == Continuity::VERTEX ? 10 : 0;
    EXPECT_EQ(filter->GetNumberOfFeatures(type, Continuity::CREASE), creases) << type;
  }
}

TEST(JacobianContinuity, ValuesOfFewDigitsAreNotMistakenForCreases)
{
  for (const double amount : { 0.0, 0.5 })
  {
    vtkNew<PiecewiseMap> map;
    map->Amount = amount;
    const vtkIdType creases = amount > 0.0 ? 14 : 0;
    map->Alter = [](double x) { return RoundedToFloat(x); };
    EXPECT_EQ(Measure(RegularGrid(14), map)->GetNumberOfCreases(), creases);
    map->Alter = [](double x) { return std::round(1e6 * x) / 1e6; };
    map->Modified();
    EXPECT_EQ(Measure(RegularGrid(14), map)->GetNumberOfCreases(), creases);
  }
}

TEST(JacobianContinuity, NonFiniteValuesAreUndecided)
{
  vtkNew<PiecewiseMap> map;
  map->Alter = [](double x) { return x > 3.5 ? vtkMath::Nan() : x; };
  const auto filter = Measure(RegularGrid(14), map);
  EXPECT_EQ(filter->GetNumberOfCreases(), 0);
  vtkIdType unknown = 0;
  for (const double jump : CellValues(filter, "JacobianJump"))
  {
    EXPECT_TRUE(std::isnan(jump) || jump < 1e-6) << jump;
    unknown += std::isnan(jump);
  }
  EXPECT_GT(unknown, 100);
}

TEST(JacobianContinuity, AllFeaturesAreListed)
{
  const MeshPair pair = MakePlanarPair(6, 5, 0.15);
  const auto filter = Measure(pair, Smooth, ListEverything);
  const vtkIdType triangles = pair.Source->GetNumberOfCells();
  const vtkIdType boundary = 24;
  const vtkIdType interior = (3 * triangles - boundary) / 2;
  EXPECT_EQ(filter->GetNumberOfBoundaryEdges(), boundary);
  for (const auto& [type, count, cellType] :
    std::vector<std::tuple<int, vtkIdType, int>>{ { Continuity::EDGE, interior, VTK_POLY_LINE },
      { Continuity::BOUNDARY_EDGE, boundary, VTK_LINE },
      { Continuity::SPOKE, 3 * triangles, VTK_POLY_LINE },
      { Continuity::WING_SEGMENT, 6 * triangles, VTK_POLY_LINE },
      { Continuity::CENTER_SEGMENT, 3 * triangles, VTK_POLY_LINE },
      { Continuity::STRIP_BORDER, 2 * interior, VTK_POLY_LINE },
      { Continuity::TRIANGLE_CENTER, triangles, VTK_VERTEX },
      { Continuity::VERTEX, 49, VTK_VERTEX } })
  {
    EXPECT_EQ(CountOf(filter, type), count) << type;
    for (const vtkIdType cell : CellsOf(filter, type))
    {
      EXPECT_EQ(filter->GetOutput()->GetCellType(cell), cellType);
    }
  }
  // Boundary edges have no jump.
  for (const vtkIdType cell : CellsOf(filter, Continuity::BOUNDARY_EDGE))
  {
    EXPECT_EQ(CellValue(filter, "Verdict", cell), Continuity::NOTHING_TO_COMPARE);
    EXPECT_TRUE(std::isnan(CellValue(filter, "JacobianJump", cell)));
    EXPECT_TRUE(std::isnan(CellValue(filter, "JacobianJumpExact", cell)));
    const auto [inside, outside] = TrianglesAt(filter, cell);
    EXPECT_GE(inside, 0);
    EXPECT_EQ(outside, -1);
    // The middle of a side of a square on the boundary.
    const double* bounds = filter->GetOutput()->GetCell(cell)->GetBounds();
    EXPECT_EQ(
      std::max(std::abs(bounds[0] + bounds[1] - 6.0), std::abs(bounds[2] + bounds[3] - 6.0)), 6.0);
  }
}

TEST(JacobianContinuity, ALoneTriangleHasNoJump)
{
  const auto triangle = MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } });
  const auto filter = Measure({ triangle, triangle }, Smooth);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  auto* colored = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  EXPECT_TRUE(std::isnan(fixtures::CellValue(colored, "JacobianJump", 0)));
  EXPECT_TRUE(std::isnan(PointValue(colored, "JacobianJump", 0)));
}

TEST(JacobianContinuity, LinesHaveTheirPositions)
{
  // The centroid is (1, 1). Its feet are (1, 0), (0, 1) and (1.5, 1.5).
  const auto triangle = MakeMesh({ { 0, 0, 0 }, { 3, 0, 0 }, { 0, 3, 0 } }, { { 0, 1, 2 } });
  const auto filter = Measure({ triangle, triangle }, Contour, ListEverything);
  using Position = std::pair<double, double>;
  using Lines = std::set<std::pair<Position, Position>>;
  const auto linesOf = [&filter](int type) {
    const auto position = [&filter](vtkIdType id) {
      const Point p = PointOf(filter->GetOutput(), id);
      return Position{ std::round(1e9 * p[0]) / 1e9, std::round(1e9 * p[1]) / 1e9 };
    };
    Lines lines;
    for (const vtkIdType cell : CellsOf(filter, type))
    {
      const std::vector<vtkIdType> ids = IdsOf(filter->GetOutput(), cell);
      lines.insert({ position(ids.front()), position(ids.back()) });
    }
    return lines;
  };
  EXPECT_EQ(linesOf(Continuity::SPOKE),
    (Lines{ { { 1, 1 }, { 0, 0 } }, { { 1, 1 }, { 3, 0 } }, { { 1, 1 }, { 0, 3 } } }));
  EXPECT_EQ(linesOf(Continuity::CENTER_SEGMENT),
    (Lines{ { { 1, 1 }, { 1, 0 } }, { { 1, 1 }, { 0, 1 } }, { { 1, 1 }, { 1.5, 1.5 } } }));
  EXPECT_EQ(linesOf(Continuity::WING_SEGMENT),
    (Lines{ { { 1, 0.5 }, { 0, 0 } }, { { 1, 0.5 }, { 3, 0 } }, { { 0.5, 1 }, { 0, 0 } },
      { { 0.5, 1 }, { 0, 3 } }, { { 1.25, 1.25 }, { 3, 0 } }, { { 1.25, 1.25 }, { 0, 3 } } }));
  EXPECT_TRUE(linesOf(Continuity::STRIP_BORDER).empty());
}

TEST(JacobianContinuity, ATriangleWithoutAFootHasNoSegment)
{
  // The foot of the centroid on the first edge is outside it.
  const auto triangle = MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 4, 1, 0 } }, { { 0, 1, 2 } });
  const auto fromCentroid = Measure({ triangle, triangle }, Contour, ListEverything);
  const vtkIdType feet = CountOf(fromCentroid, Continuity::CENTER_SEGMENT);
  EXPECT_LT(feet, 3);
  EXPECT_EQ(CountOf(fromCentroid, Continuity::WING_SEGMENT), 2 * feet);
  EXPECT_EQ(CountOf(fromCentroid, Continuity::SPOKE), 3);
  const auto fromIncenter = Measure({ triangle, triangle }, Incenter, ListEverything);
  EXPECT_EQ(CountOf(fromIncenter, Continuity::CENTER_SEGMENT), 3);
}

TEST(JacobianContinuity, SmoothIsTwiceDifferentiableAndContourOnceAcrossWingSegments)
{
  // The share of a verdict among the features of a type.
  const auto shareOf = [](Continuity* filter, int type, const char* name, int verdict) {
    const std::vector<vtkIdType> cells = CellsOf(filter, type);
    const auto count = std::count_if(cells.begin(), cells.end(),
      [&](vtkIdType cell) { return CellValue(filter, name, cell) == verdict; });
    return static_cast<double>(count) / static_cast<double>(cells.size());
  };
  const MeshPair pair = MakePlanarPair(6, 5, 0.15);
  const auto measureTwice = [](Continuity* filter) {
    ListEverything(filter);
    filter->SecondDerivativesOn();
  };
  const auto smooth = Measure(pair, Smooth, measureTwice);
  const auto contour = Measure(pair, Contour, measureTwice);
  for (const char* name : { "Verdict", "SecondDerivativeVerdict" })
  {
    for (const int type : { Continuity::EDGE, Continuity::SPOKE, Continuity::STRIP_BORDER })
    {
      EXPECT_EQ(shareOf(smooth, type, name, Continuity::CREASE), 0.0) << name << type;
      EXPECT_GE(shareOf(smooth, type, name, Continuity::DIFFERENTIABLE), 0.9) << name << type;
    }
  }
  EXPECT_EQ(shareOf(contour, Continuity::WING_SEGMENT, "Verdict", Continuity::CREASE), 0.0);
  // Except in the two triangles that are the same in both meshes.
  EXPECT_GT(
    shareOf(contour, Continuity::WING_SEGMENT, "SecondDerivativeVerdict", Continuity::CREASE), 0.9);
}

TEST(JacobianContinuity, VerticesOfSurfacesAreNotMeasured)
{
  const MeshPair pair = MakeClosedPair(1, 3);
  const auto filter = Measure(pair, Smooth, ListEverything);
  EXPECT_EQ(CountOf(filter, Continuity::VERTEX), pair.Source->GetNumberOfPoints());
  for (const vtkIdType cell : CellsOf(filter, Continuity::VERTEX))
  {
    EXPECT_EQ(CellValue(filter, "Verdict", cell), Continuity::NOTHING_TO_COMPARE);
    EXPECT_TRUE(std::isnan(CellValue(filter, "JacobianJump", cell)));
  }
  for (const int type : { Continuity::TRIANGLE_CENTER, Continuity::SPOKE })
  {
    EXPECT_EQ(filter->GetNumberOfFeatures(type, Continuity::DIFFERENTIABLE), CountOf(filter, type));
  }
}

TEST(JacobianContinuity, TrianglesAndPointsHaveTheLargestJumpOfTheirEdges)
{
  const MeshPair pair = MakePlanarPair(6, 2);
  const auto filter = Measure(pair, Linear);
  auto* colored = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  std::vector<double> largest(colored->GetNumberOfCells(), 0.0);
  for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfCells(); ++i)
  {
    const auto [first, second] = TrianglesAt(filter, i);
    for (const vtkIdType triangle : { first, second })
    {
      largest[triangle] = std::max(largest[triangle], CellValue(filter, "JacobianJump", i));
    }
  }
  EXPECT_EQ(ValuesOf(CellArray(colored, "JacobianJump")), largest);
  EXPECT_EQ(PointArray(colored, "JacobianJump")->GetRange()[1], filter->GetLargestJump());
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells() * 2 + filter->GetNumberOfBoundaryEdges(),
    3 * pair.Source->GetNumberOfCells());
}

TEST(JacobianContinuity, ResultsDoNotDependOnThreads)
{
  const MeshPair pair = MakePlanarPair(5, 5, 0.15);
  vtkSmartPointer<Continuity> runs[2];
  for (const int threads : { 1, 2 })
  {
    vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads },
      [&]() { runs[threads - 1] = Measure(pair, Contour, ListEverything); });
  }
  ExpectSame(runs[0]->GetOutput(), runs[1]->GetOutput(), { "JacobianJump" });
}

TEST(JacobianContinuity, TheHomeomorphismFilterMeasuresTheSame)
{
  const MeshPair pair = MakePlanarPair(5, 2, 0.15);
  for (const bool inverse : { false, true })
  {
    const auto map = MakeFilter(Contour, pair);
    map->SetInverse(inverse);
    map->Update();
    EXPECT_EQ(map->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL), 0);

    map->MeasureContinuityOn();
    map->GetJacobianContinuity()->SpokesOn();
    map->Update();
    const auto alone = Measure(
      inverse ? MeshPair{ pair.Target, pair.Source } : pair, Contour, &Continuity::SpokesOn);
    auto* measured = vtkPolyData::SafeDownCast(map->GetOutputDataObject(1));
    EXPECT_TRUE(
      IsSame(CellArray(measured, "JacobianJump"), CellArray(alone->GetOutput(), "JacobianJump")));
    EXPECT_EQ(map->GetJacobianContinuity()->GetNumberOfCreases(), alone->GetNumberOfCreases());

    // Nothing is computed twice: neither the map in a second update, nor the measurement for new
    // data. An option of the inner filter repeats the measurement.
    const vtkMTimeType mapped = map->GetOutputDataObject(0)->GetMTime();
    map->Update();
    EXPECT_EQ(map->GetOutputDataObject(0)->GetMTime(), mapped);
    const vtkMTimeType before = map->GetJacobianContinuity()->GetOutput()->GetMTime();
    map->SetDataObject(MakeCloud({ { 1.0, 1.0, 0.0 } }));
    map->Update();
    EXPECT_EQ(map->GetJacobianContinuity()->GetOutput()->GetMTime(), before);
    EXPECT_EQ(map->GetNumberOfMeshBuilds(), 1);
    map->GetJacobianContinuity()->SpokesOff();
    map->Update();
    EXPECT_LT(map->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL),
      alone->GetOutput()->GetNumberOfCells());
  }
}

} // namespace
