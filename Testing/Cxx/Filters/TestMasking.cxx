// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// With MaskInvalidTriangles, exactly the offending triangles are masked with a warning, and the
// rest is mapped as if they had been removed from the meshes.

#include "MappedPoints.h"

#include "vtkFieldData.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkIdTypeArray.h"
#include "vtkTable.h"
#include "vtkTriangularCoordinates.h"
#include "vtkVariant.h"

#include "vtkCellData.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace
{

using namespace test_meshes;

struct Expectation
{
  std::set<std::size_t> Masked;
  /// The expected phrases of the warning, each followed by the outcome.
  std::vector<std::string> Warnings;
};

/// Whether points can be inside a triangle and not in a neighbor across an edge.
bool HasInterior(const std::vector<Point>& points, const Triangle& triangle)
{
  Point normal;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto component = [&](int corner, int offset) {
      return points[triangle[corner]][(axis + offset) % 3] -
        points[triangle[0]][(axis + offset) % 3];
    };
    normal[axis] = component(1, 1) * component(2, 2) - component(1, 2) * component(2, 1);
  }
  // Not if a coordinate is not finite.
  const double area = std::hypot(normal[0], normal[1], normal[2]);
  return std::isfinite(area) && area > 1e-6;
}

void ExpectMasked(
  const MeshPair& pair, const std::vector<Triangle>& triangles, const Expectation& expectation)
{
  std::vector<Triangle> rest;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (!expectation.Masked.count(t))
    {
      rest.push_back(triangles[t]);
    }
  }
  const MeshPair pierced{ MakeMesh(PointsOf(pair.Source), rest),
    MakeMesh(PointsOf(pair.Target), rest) };
  for (const bool inverse : { false, true })
  {
    vtkPolyData* from = inverse ? pair.Target : pair.Source;
    const std::vector<Point> corners = PointsOf(from);
    std::vector<Point> points;
    std::vector<vtkIdType> expectedTriangles;
    std::vector<bool> masked;
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      if (!HasInterior(corners, triangles[t]))
      {
        continue;
      }
      const bool out = expectation.Masked.count(t) > 0;
      for (const Point& p : SamplePoints(from, { triangles[t] }, 4, t))
      {
        points.push_back(p);
        masked.push_back(out);
        expectedTriangles.push_back(out ? -1 : static_cast<vtkIdType>(t));
      }
    }
    for (const int system : { vtkDifferentiableHomeomorphism::LINEAR,
           vtkDifferentiableHomeomorphism::CONTOUR, vtkDifferentiableHomeomorphism::SMOOTH })
    {
      MapOptions options;
      options.Inverse = inverse;
      options.CoordinateSystem = system;
      options.DiscordantTriangles = vtkDifferentiableHomeomorphism::USE_LINEAR;
      const MappedPoints expected = MapPoints(pierced, points, options);
      ASSERT_EQ("", expected.Error + expected.Warning);
      options.Mask = true;
      const MappedPoints mapped = MapPoints(pair, points, options);
      ASSERT_EQ("", mapped.Error);
      for (const std::string& warning : expectation.Warnings)
      {
        EXPECT_NE(std::string::npos, mapped.Warning.find(warning)) << warning << "\nis not in\n"
                                                                   << mapped.Warning;
      }
      ASSERT_EQ(points.size(), mapped.Images.size());
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        EXPECT_EQ(!masked[i], mapped.IsInside(i)) << "triangle " << expectedTriangles[i];
        EXPECT_EQ(expected.IsInside(i), mapped.IsInside(i));
        if (!masked[i])
        {
          EXPECT_EQ(expectedTriangles[i], mapped.Triangles[i]);
        }
        EXPECT_LE(DistanceOf(expected.Images[i], mapped.Images[i]), 1e-14) << "system " << system;
      }
    }
  }

  // The transform gives the same message.
  vtkNew<vtkHomeomorphismTransform> transform;
  Messages messages(static_cast<vtkObject*>(transform.Get()));
  transform->SetSource(pair.Source);
  transform->SetTarget(pair.Target);
  transform->MaskInvalidTrianglesOn();
  transform->Update();
  for (const std::string& warning : expectation.Warnings)
  {
    EXPECT_NE(std::string::npos, messages.Warning().find(warning));
  }
}

std::vector<Point> MovedPoints(const MeshPair& pair, bool source)
{
  return PointsOf(source ? pair.Source : pair.Target);
}

TEST(Masking, RepeatedCorners)
{
  std::vector<Triangle> triangles = GridTriangles(4);
  triangles[9] = { 6, 12, 12 };
  const MeshPair pair = MakePlanarPair(4, 1);
  ExpectMasked(
    { MakeMesh(MovedPoints(pair, true), triangles), MakeMesh(MovedPoints(pair, false), triangles) },
    triangles, { { 9 }, { "1 triangle of the source (cell 9) uses the same point twice" } });
}

TEST(Masking, NotFinite)
{
  const double bad[] = { std::numeric_limits<double>::quiet_NaN(),
    std::numeric_limits<double>::infinity() };
  for (const bool inSource : { true, false })
  {
    for (const double value : bad)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        const MeshPair pair = MakePlanarPair(4, 2);
        vtkPolyData* mesh = inSource ? pair.Source : pair.Target;
        Point p = PointsOf(mesh)[12];
        p[axis] = value;
        MovePoint(mesh, 12, p);
        ExpectMasked(pair, GridTriangles(4),
          { { 10, 11, 13, 18, 20, 21 },
            { std::string("6 triangles of the ") + (inSource ? "source" : "target") +
              " (cells 10, 11, 13, 18, 20, 21) have coordinates that are not finite" } });
      }
    }
  }
}

TEST(Masking, DifferentDefectsInBothMeshes)
{
  const MeshPair pair = MakePlanarPair(4, 3, 0.0);
  MovePoint(pair.Source, 0, { 1.0, 1.0, 0.0 });
  MovePoint(pair.Target, 24, { 3.0, 3.5, std::numeric_limits<double>::quiet_NaN() });
  ExpectMasked(pair, GridTriangles(4),
    { { 0, 1, 30, 31 },
      { "2 triangles of the source (cells 0, 1) are degenerate",
        "2 triangles of the target (cells 30, 31) have coordinates that are not finite" } });
}

TEST(Masking, DegenerateTriangle)
{
  for (const bool inSource : { true, false })
  {
    const MeshPair pair = MakePlanarPair(4, 4, 0.0);
    vtkPolyData* mesh = inSource ? pair.Source : pair.Target;
    // On the line from point 18 to point 23, so that only one of its two triangles collapses.
    MovePoint(mesh, 24, { 3.0, 3.5, 0.0 });
    ExpectMasked(pair, GridTriangles(4),
      { { 31 },
        { std::string("1 triangle of the ") + (inSource ? "source" : "target") +
          " (cell 31) is degenerate" } });
  }
}

TEST(Masking, DegenerateTriangleOnASurface)
{
  const MeshPair pair{ MakeSheet(4, 5, 0.3), MakeSheet(4, 6, 0.4) };
  const std::vector<Point> points = PointsOf(pair.Target);
  Point middle;
  for (int axis = 0; axis < 3; ++axis)
  {
    middle[axis] = 0.6 * points[18][axis] + 0.4 * points[23][axis];
  }
  MovePoint(pair.Target, 24, middle);
  // The collapsed triangle lies on the edge of its neighbors, where the inverse map finds the
  // neighbors. Only the forward map is compared.
  const std::vector<Point> samples = SamplePoints(pair.Source, GridTriangles(4), 4, 5);
  MapOptions options;
  options.Mask = true;
  const MappedPoints mapped = MapPoints(pair, samples, options);
  EXPECT_NE(
    std::string::npos, mapped.Warning.find("1 triangle of the target (cell 31) is degenerate"));
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    EXPECT_EQ(i / 4 == 31 ? -1 : static_cast<vtkIdType>(i / 4), mapped.Triangles[i]);
  }
}

TEST(Masking, NonManifoldEdge)
{
  // A fin on the edge of triangles 0 and 1, and a second one on the edge of the last two.
  std::vector<Triangle> triangles = GridTriangles(3);
  triangles.push_back({ 0, 5, 16 });
  triangles.push_back({ 10, 15, 16 });
  MeshPair pair;
  for (const bool source : { true, false })
  {
    std::vector<Point> points = PointsOf(MakeSheet(3, source ? 7 : 8, 0.4));
    points.push_back({ 0.5, 0.5, 2.0 });
    (source ? pair.Source : pair.Target) = MakeMesh(points, triangles);
  }
  ExpectMasked(pair, triangles,
    { { 0, 1, 16, 17, 18, 19 },
      { "6 triangles of the source (cells 0, 1, 16, 17, 18, 19) are at non-manifold edges" } });
}

TEST(Masking, FlippedAlone)
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 3, 4, 5 }, { 6, 7, 8 } };
  const std::vector<Point> points{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 2, 0, 0 }, { 3, 0, 0 },
    { 2, 1, 0 }, { 4, 0, 0 }, { 5, 0, 0 }, { 4, 1, 0 } };
  std::vector<Point> flipped = points;
  flipped[5] = { 2, -1, 0 };
  ExpectMasked({ MakeMesh(points, triangles), MakeMesh(flipped, triangles) }, triangles,
    { { 1 },
      { "1 triangle of the pair (cell 1) is flipped between source and target relative to the "
        "rest" } });
}

TEST(Masking, FlippedAndThereforeOverlapping)
{
  // Cell 31 is flipped in the target. Its neighbor across the edge to the moved point, cell 30,
  // then lies on cell 28.
  const MeshPair pair = MakePlanarPair(4, 9, 0.0);
  MovePoint(pair.Target, 24, { 2.9, 3.5, 0.0 });
  ExpectMasked(pair, GridTriangles(4),
    { { 28, 30, 31 },
      { "1 triangle of the pair (cell 31) is flipped between source and target relative to the "
        "rest",
        "2 triangles of the target (cells 28, 30) overlap other triangles" } });
}

/// Adds a copy of some grid squares, as a separate component, to points and triangles.
void AddSquares(std::vector<Point>& points, std::vector<Triangle>& triangles, int n,
  const Point& corner, bool frameOnly)
{
  const auto first = static_cast<vtkIdType>(points.size());
  for (Point p : GridPoints(n, 0, 0.0))
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      p[axis] += corner[axis];
    }
    points.push_back(p);
  }
  const std::vector<Triangle> grid = GridTriangles(n);
  for (std::size_t t = 0; t < grid.size(); ++t)
  {
    const int i = static_cast<int>(t) / 2 % n;
    const int j = static_cast<int>(t) / 2 / n;
    const bool frame = i == 0 || j == 0 || i == n - 1 || j == n - 1;
    if (frame || !frameOnly)
    {
      triangles.push_back({ grid[t][0] + first, grid[t][1] + first, grid[t][2] + first });
    }
  }
}

TEST(Masking, OverlappingSheets)
{
  // They share the square from (2.5, 2.5) to (4, 4): the four squares in the corner of the first
  // sheet and of the second.
  std::vector<Point> overlapping;
  std::vector<Triangle> triangles;
  AddSquares(overlapping, triangles, 4, { 0, 0, 0 }, false);
  AddSquares(overlapping, triangles, 4, { 2.5, 2.5, 0 }, false);
  std::vector<Point> apart;
  std::vector<Triangle> same;
  AddSquares(apart, same, 4, { 0, 0, 0 }, false);
  AddSquares(apart, same, 4, { 4, 0, 0 }, false);
  std::set<std::size_t> masked;
  for (std::size_t t = 0; t < 32; ++t)
  {
    const std::size_t i = t / 2 % 4;
    const std::size_t j = t / 8;
    if (i >= 2 && j >= 2)
    {
      masked.insert(t);
    }
    if (i < 2 && j < 2)
    {
      masked.insert(32 + t);
    }
  }
  ASSERT_EQ(16u, masked.size());
  const std::string fault = " (cells 20, 21, 22, 23, 28, 29, 30, 31, 32, 33, ...) overlap other "
                            "triangles";
  ExpectMasked({ MakeMesh(overlapping, triangles), MakeMesh(apart, triangles) }, triangles,
    { masked, { "16 triangles of the source" + fault } });
  ExpectMasked({ MakeMesh(apart, triangles), MakeMesh(overlapping, triangles) }, triangles,
    { masked, { "16 triangles of the target" + fault } });
  // After masking them because of the source, the target has no overlap.
  ExpectMasked({ MakeMesh(overlapping, triangles), MakeMesh(overlapping, triangles) }, triangles,
    { masked, { "16 triangles of the source" + fault } });
}

TEST(Masking, OverlapInTheTargetBehindOneInTheSource)
{
  // Sheets A and B coincide in the target. In the source two frames cover the outermost triangles
  // of A and B, so these are already masked when the target is checked. Only therefore do the rests
  // of A and B have a boundary.
  std::vector<Point> source;
  std::vector<Point> target;
  std::vector<Triangle> triangles;
  std::vector<Triangle> same;
  AddSquares(source, triangles, 6, { 0, 0, 0 }, false);
  AddSquares(source, triangles, 6, { 20, 0, 0 }, false);
  AddSquares(source, triangles, 6, { 0, 0, 0 }, true);
  AddSquares(source, triangles, 6, { 20, 0, 0 }, true);
  AddSquares(target, same, 6, { 0, 0, 0 }, false);
  AddSquares(target, same, 6, { 0, 0, 0 }, false);
  AddSquares(target, same, 6, { 20, 0, 0 }, true);
  AddSquares(target, same, 6, { 30, 0, 0 }, true);
  std::set<std::size_t> all;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    all.insert(t);
  }
  ExpectMasked({ MakeMesh(source, triangles), MakeMesh(target, triangles) }, triangles,
    { all,
      { "160 triangles of the source (cells 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, ...) overlap other "
        "triangles",
        "64 triangles of the target (cells 14, 15, 16, 17, 18, 19, 20, 21, 26, 27, ...) overlap "
        "other "
        "triangles" } });
}

TEST(Masking, MaskedTrianglesDoNotAffectPlanarity)
{
  // A fin perpendicular to a flat sheet. Without it and the two triangles beside it, the sheet is
  // planar: heights are kept, and the transform accepts it.
  std::vector<Triangle> triangles = GridTriangles(3);
  triangles.push_back({ 0, 5, 16 });
  std::vector<Point> source = GridPoints(3, 10, 0.2);
  std::vector<Point> target = GridPoints(3, 11, 0.2);
  source.push_back({ 0.5, 0.5, 2.0 });
  target.push_back({ 0.5, 0.5, 3.0 });
  const MeshPair pair{ MakeMesh(source, triangles), MakeMesh(target, triangles) };
  MapOptions options;
  options.Mask = true;
  const MappedPoints mapped = MapPoints(pair, { { 2.0, 1.3, 0.5 } }, options);
  ASSERT_EQ("", mapped.Error);
  ASSERT_TRUE(mapped.IsInside(0));
  EXPECT_EQ(0.5, mapped.Images[0][2]);

  vtkNew<vtkHomeomorphismTransform> transform;
  Messages messages(static_cast<vtkObject*>(transform.Get()));
  transform->SetSource(pair.Source);
  transform->SetTarget(pair.Target);
  transform->MaskInvalidTrianglesOn();
  transform->Update();
  EXPECT_EQ("", messages.Error());
}

TEST(Masking, MaskedTrianglesDoNotAffectTheTolerance)
{
  // Tolerance is relative to the diagonal of the domain. A collapsed triangle far away is not part
  // of the domain.
  std::vector<Point> points = GridPoints(3, 12, 0.2);
  points.push_back({ 1000.0, 0.0, 0.0 });
  std::vector<Triangle> triangles = GridTriangles(3);
  triangles.push_back({ 0, 3, 16 });
  const auto mesh = MakeMesh(points, triangles);
  MapOptions options;
  options.Mask = true;
  options.Tolerance = 0.01;
  const MappedPoints mapped =
    MapPoints({ mesh, mesh }, { { 1.5, 3.04, 0.0 }, { 1.5, 3.05, 0.0 } }, options);
  ASSERT_EQ("", mapped.Error);
  EXPECT_TRUE(mapped.IsInside(0));
  EXPECT_FALSE(mapped.IsInside(1));
}

TEST(Masking, NonOrientableSurfacesAreRefused)
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 1, 3, 2 }, { 2, 3, 4 }, { 3, 0, 4 },
    { 4, 0, 1 } };
  // Five points, five triangles: the smallest Moebius strip.
  const auto mesh = MakeMesh(
    { { 1, 0, 0.1 }, { 0.3, 1, -0.2 }, { -0.8, 0.6, 0.3 }, { -0.8, -0.6, -0.1 }, { 0.3, -1, 0.4 } },
    triangles);
  MapOptions options;
  options.Mask = true;
  const MappedPoints mapped = MapPoints({ mesh, mesh }, { { 1, 0, 0.1 } }, options);
  EXPECT_NE(std::string::npos, mapped.Error.find("the surface is non-orientable"));
  EXPECT_EQ("", mapped.Warning);
  EXPECT_TRUE(mapped.Images.empty());
}

TEST(Masking, DefectsOfTheWholeMeshAreRefused)
{
  const MeshPair pair = MakePlanarPair(4, 13);
  std::vector<Triangle> triangles = GridTriangles(4);
  triangles[3] = { 1, 2, 99 };
  const auto corrupt = MakeMesh(PointsOf(pair.Source), triangles);
  triangles[3] = { 1, 2, 6 };
  const auto other = MakeMesh(PointsOf(pair.Source), triangles);
  MapOptions options;
  options.Mask = true;
  EXPECT_NE("", MapPoints({ corrupt, corrupt }, { { 1, 1, 0 } }, options).Error);
  EXPECT_NE("", MapPoints({ other, pair.Target }, { { 1, 1, 0 } }, options).Error);
  EXPECT_NE(
    "", MapPoints({ pair.Source, MakePlanarPair(3, 1).Source }, { { 1, 1, 0 } }, options).Error);
}

TEST(Masking, AValidMeshGivesNoWarning)
{
  MapOptions options;
  options.Mask = true;
  const MappedPoints mapped = MapPoints(MakePlanarPair(4, 14), { { 1, 1, 0 } }, options);
  EXPECT_EQ("", mapped.Error + mapped.Warning);
  EXPECT_TRUE(mapped.IsInside(0));
}

TEST(Masking, EveryTriangleMasked)
{
  const auto mesh = MakeMesh(std::vector<Point>(4, { 1, 1, 1 }), GridTriangles(1));
  MapOptions options;
  options.Mask = true;
  const MappedPoints mapped = MapPoints({ mesh, mesh }, { { 1, 1, 1 }, { 0, 0, 0 } }, options);
  EXPECT_EQ("", mapped.Error);
  EXPECT_EQ((std::vector<vtkIdType>{ -1, -1 }), mapped.Triangles);
}

TEST(Masking, CoordinatesFilter)
{
  vtkNew<vtkTriangularCoordinates> filter;
  Messages messages(filter);
  const MeshPair pair = MakePlanarPair(4, 15, 0.0);
  MovePoint(pair.Source, 0, { 1.0, 1.0, 0.0 });
  filter->SetInputData(pair.Source);
  filter->MaskInvalidTrianglesOn();
  filter->Update();
  EXPECT_FALSE(messages.HasError());
  EXPECT_NE(std::string::npos,
    messages.Warning().find("2 triangles of the triangulation (cells 0, 1) are degenerate"));
  vtkDataArray* used = filter->GetTriangulation()->GetCellData()->GetArray("UsedCoordinateSystem");
  ASSERT_TRUE(used);
  for (vtkIdType t = 0; t < 32; ++t)
  {
    EXPECT_EQ(t < 2 ? -1 : static_cast<int>(vtkTriangularCoordinates::SMOOTH), used->GetTuple1(t));
  }
  // They contain no lines.
  vtkDataArray* ids = filter->GetLines()->GetCellData()->GetArray("TriangleId");
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
  {
    ASSERT_GE(ids->GetTuple1(i), 2);
  }
}

TEST(Masking, DiagnosticsAreATable)
{
  const MeshPair pair = MakePlanarPair(4, 3, 0.0);
  MovePoint(pair.Source, 0, { 1.0, 1.0, 0.0 });
  MovePoint(pair.Target, 24, { 3.0, 3.5, std::numeric_limits<double>::quiet_NaN() });
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  Messages messages(filter);
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->MaskInvalidTrianglesOn();
  filter->Update();
  EXPECT_TRUE(messages.HasWarning());
  vtkTable* table = filter->GetDiagnostics();
  ASSERT_EQ(2, table->GetNumberOfRows());
  auto* ids = vtkIdTypeArray::SafeDownCast(table->GetFieldData()->GetArray("Ids"));
  ASSERT_TRUE(ids);
  const char* const kinds[] = { "DegenerateTriangle", "NotFinite" };
  const char* const domains[] = { "source", "target" };
  const vtkIdType firstCells[] = { 0, 30 };
  for (vtkIdType row = 0; row < 2; ++row)
  {
    EXPECT_EQ(kinds[row], table->GetValueByName(row, "Kind").ToString());
    EXPECT_EQ(domains[row], table->GetValueByName(row, "Domain").ToString());
    EXPECT_EQ("masked", table->GetValueByName(row, "Outcome").ToString());
    EXPECT_EQ("RepairOrMask", table->GetValueByName(row, "Remedy").ToString());
    EXPECT_EQ(2, table->GetValueByName(row, "Count").ToInt());
    const vtkIdType first = table->GetValueByName(row, "FirstId").ToInt();
    EXPECT_EQ(firstCells[row], ids->GetValue(first));
    EXPECT_EQ(firstCells[row] + 1, ids->GetValue(first + 1));
  }
  // The table is that of the last update.
  filter->SetSourceData(MakePlanarPair(4, 3).Source);
  filter->SetTargetData(MakePlanarPair(4, 3).Target);
  filter->Update();
  EXPECT_EQ(0, filter->GetDiagnostics()->GetNumberOfRows());
}

} // namespace
