// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Adjacency, orientability, unfolding of neighbors, planarity, and caching of the homeomorphism.

#include "MappedPoints.h"

#include "Mesh/ChartedTriangulation.h"
#include "Mesh/MeshGeometry.h"
#include "Mesh/Triangulation.h"
#include "Pipeline/HomeomorphismCache.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkWeakPointer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <map>
#include <numeric>
#include <random>
#include <utility>

namespace
{

using namespace homeomorphism;
using namespace test_meshes;

std::vector<Triangulation::Corners> Narrow(const std::vector<Triangle>& triangles)
{
  std::vector<Triangulation::Corners> narrow;
  for (const Triangle& t : triangles)
  {
    narrow.push_back({ static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
      static_cast<std::int32_t>(t[2]) });
  }
  return narrow;
}

/// The start and end of an edge in the triangle's cyclic order.
std::pair<std::int32_t, std::int32_t> EdgeOf(const Triangulation::Corners& corners, int edge)
{
  return { corners[(edge + 1) % 3], corners[(edge + 2) % 3] };
}

//------------------------------------------------------------------------------------------------
// Adjacency.

/// Compares the adjacency with a map from pairs of points to triangles.
void ExpectAdjacency(Triangulation& triangulation, vtkIdType numberOfPoints)
{
  using Edges = std::vector<std::pair<TriangleIndex, int>>;
  std::map<std::pair<std::int32_t, std::int32_t>, Edges> edges;
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  for (TriangleIndex t = 0; t < count; ++t)
  {
    for (int k = 0; k < 3 && !triangulation.IsMasked(t); ++k)
    {
      const auto edge = EdgeOf(triangulation.GetCorners(t), k);
      edges[std::minmax(edge.first, edge.second)].emplace_back(t, k);
    }
  }
  std::vector<TriangleIndex> crowded;
  for (const auto& edge : edges)
  {
    for (const auto& one : edge.second)
    {
      if (edge.second.size() > 2)
      {
        crowded.push_back(one.first);
      }
    }
  }
  std::sort(crowded.begin(), crowded.end());
  crowded.erase(std::unique(crowded.begin(), crowded.end()), crowded.end());
  ASSERT_EQ(crowded, triangulation.FindAdjacency(numberOfPoints));

  for (TriangleIndex t = 0; t < count; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Twin across = triangulation.GetTwin(t, k);
      const auto edge = EdgeOf(triangulation.GetCorners(t), k);
      const Edges& sharing = edges[std::minmax(edge.first, edge.second)];
      if (triangulation.IsMasked(t) || sharing.size() != 2)
      {
        ASSERT_EQ(-1, across.Triangle);
        continue;
      }
      const auto& other = sharing[0] == std::make_pair(t, k) ? sharing[1] : sharing[0];
      ASSERT_EQ(other.first, across.Triangle);
      ASSERT_EQ(other.second, across.Edge);
      const auto otherEdge = EdgeOf(triangulation.GetCorners(other.first), other.second);
      ASSERT_EQ(edge == otherEdge, across.SameDirection);
    }
  }
}

TEST(Triangulation, AdjacencyOfRandomTriangles)
{
  std::mt19937_64 generator(1);
  for (int n = 0; n < 3000; ++n)
  {
    const int points = 3 + n % 12;
    std::uniform_int_distribution<std::int32_t> point(0, points - 1);
    std::vector<Triangulation::Corners> triangles(n % 25);
    Triangulation triangulation;
    for (auto& t : triangles)
    {
      do
      {
        t = { point(generator), point(generator), point(generator) };
      } while (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]);
    }
    triangulation.SetTriangles(triangles, 0);
    for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
    {
      if (n % 3 == 0 && point(generator) == 0)
      {
        triangulation.Mask(t);
      }
    }
    ExpectAdjacency(triangulation, points);
    if (triangulation.GetNumberOfTriangles() > 0)
    {
      // Recomputed after more triangles have been masked.
      triangulation.Mask(0);
      ExpectAdjacency(triangulation, points);
    }
    ASSERT_FALSE(HasFatalFailure()) << n;
  }
}

TEST(Triangulation, AdjacencyOfMeshes)
{
  std::mt19937_64 generator(2);
  for (const bool closed : { false, true })
  {
    const auto mesh = closed ? MakeClosedPair(4, 2).Source : MakePlanarPair(40, 2).Source;
    std::vector<Triangulation::Corners> triangles;
    for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
    {
      const vtkIdType* ids;
      vtkIdType size;
      mesh->GetCellPoints(t, size, ids);
      triangles.push_back({ static_cast<std::int32_t>(ids[0]), static_cast<std::int32_t>(ids[1]),
        static_cast<std::int32_t>(ids[2]) });
      std::shuffle(triangles.back().begin(), triangles.back().end(), generator);
    }
    std::shuffle(triangles.begin(), triangles.end(), generator);
    Triangulation triangulation;
    triangulation.SetTriangles(triangles, 5);
    ExpectAdjacency(triangulation, mesh->GetNumberOfPoints());
    EXPECT_EQ(5 + 17, triangulation.GetCellId(17));
    EXPECT_TRUE(triangulation.FindNonOrientable().empty());
    int boundary = 0;
    for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
    {
      for (int k = 0; k < 3; ++k)
      {
        boundary += triangulation.GetTwin(t, k).Triangle < 0;
      }
    }
    EXPECT_EQ(closed ? 0 : 160, boundary);
  }
}

//------------------------------------------------------------------------------------------------
// Orientability.

/// Whether the triangles can be oriented consistently: no triangle may be connected to its own
/// reverse through a chain of neighbors. Disjoint sets of (triangle, orientation).
bool IsOrientable(const Triangulation& triangulation)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  std::vector<TriangleIndex> parent(2 * count);
  std::iota(parent.begin(), parent.end(), 0);
  const std::function<TriangleIndex(TriangleIndex)> root = [&](TriangleIndex i) {
    return parent[i] == i ? i : parent[i] = root(parent[i]);
  };
  for (TriangleIndex t = 0; t < count; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Twin across = triangulation.GetTwin(t, k);
      for (int side = 0; side < 2 && across.Triangle >= 0; ++side)
      {
        const int otherSide = across.SameDirection ? 1 - side : side;
        parent[root(2 * t + side)] = root(2 * across.Triangle + otherSide);
      }
    }
  }
  for (TriangleIndex t = 0; t < count; ++t)
  {
    if (root(2 * t) == root(2 * t + 1))
    {
      return false;
    }
  }
  return true;
}

/// A strip of triangles closed to a ring, which is non-orientable if the number of points is odd.
std::vector<Triangulation::Corners> ClosedStrip(std::int32_t points)
{
  std::vector<Triangulation::Corners> triangles;
  for (std::int32_t i = 0; i < points; ++i)
  {
    triangles.push_back({ i, (i + 1) % points, (i + 2) % points });
  }
  return triangles;
}

TEST(Triangulation, OrientabilityOfRandomTriangles)
{
  std::mt19937_64 generator(3);
  int oneSided = 0;
  for (int n = 0; n < 4000; ++n)
  {
    const int points = 5 + n % 6;
    std::uniform_int_distribution<std::int32_t> point(0, points - 1);
    std::vector<Triangulation::Corners> triangles;
    Triangulation triangulation;
    // Grows a surface without non-manifold edges.
    for (int attempt = 0; attempt < 40; ++attempt)
    {
      const Triangulation::Corners t{ point(generator), point(generator), point(generator) };
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      {
        continue;
      }
      triangles.push_back(t);
      triangulation.SetTriangles(triangles, 0);
      if (!triangulation.FindAdjacency(points).empty())
      {
        triangles.pop_back();
      }
    }
    triangulation.SetTriangles(triangles, 0);
    triangulation.FindAdjacency(points);
    const bool orientable = IsOrientable(triangulation);
    ASSERT_EQ(orientable, triangulation.FindNonOrientable().empty()) << n;
    oneSided += !orientable;
  }
  EXPECT_GT(oneSided, 200);
  EXPECT_LT(oneSided, 3800);
}

TEST(Triangulation, ClosedStrips)
{
  for (std::int32_t points = 5; points < 30; ++points)
  {
    Triangulation triangulation;
    triangulation.SetTriangles(ClosedStrip(points), 0);
    ASSERT_TRUE(triangulation.FindAdjacency(points).empty());
    const std::vector<TriangleIndex> found = triangulation.FindNonOrientable();
    if (points % 2 == 0)
    {
      EXPECT_TRUE(found.empty());
      continue;
    }
    // The two triangles at the only edge with inconsistent windings, in ascending order.
    ASSERT_EQ(2u, found.size());
    EXPECT_LT(found[0], found[1]);
    triangulation.Mask(found[0]);
    triangulation.FindAdjacency(points);
    EXPECT_TRUE(triangulation.FindNonOrientable().empty());
  }
}

//------------------------------------------------------------------------------------------------
// Unfolding.

TEST(Triangulation, UnfoldedNeighborsKeepTheirLengths)
{
  std::mt19937_64 generator(4);
  double worst = 0.0;
  int neighborsSeen = 0;
  for (const char* kind : { "plane", "sheet", "closed", "steep" })
  {
    const std::string name = kind;
    const auto mesh = name == "plane" ? MakePlanarPair(12, 4).Source
      : name == "closed"              ? MakeClosedPair(3, 4).Target
                                      : MakeSheet(12, 5, name == "steep" ? 8.0 : 0.5);
    std::vector<Triangulation::Corners> triangles;
    for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
    {
      const vtkIdType* ids;
      vtkIdType size;
      mesh->GetCellPoints(t, size, ids);
      triangles.push_back({ static_cast<std::int32_t>(ids[0]), static_cast<std::int32_t>(ids[1]),
        static_cast<std::int32_t>(ids[2]) });
      std::shuffle(triangles.back().begin(), triangles.back().end(), generator);
    }
    Triangulation triangulation;
    triangulation.SetTriangles(triangles, 0);
    triangulation.FindAdjacency(mesh->GetNumberOfPoints());
    MeshGeometry geometry(mesh->GetPoints(), triangulation);
    geometry.ComputeFrames(triangulation);
    EXPECT_EQ(name == "plane", geometry.IsPlanar());
    const std::vector<Point> points = PointsOf(mesh);
    const double scale = geometry.GetScale();
    for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
    {
      const std::array<Neighbor, 3> neighbors = UnfoldNeighbors(triangulation, geometry, t);
      for (int k = 0; k < 3; ++k)
      {
        const Twin across = triangulation.GetTwin(t, k);
        ASSERT_EQ(across.Triangle >= 0, neighbors[k].Exists);
        if (across.Triangle < 0)
        {
          continue;
        }
        ++neighborsSeen;
        // Along the edge of this triangle, from its start: the apex of the neighbor is on the other
        // side.
        const auto edge = EdgeOf(triangulation.GetCorners(t), k);
        const std::int32_t apex = triangulation.GetCorners(across.Triangle)[across.Edge];
        const EdgeView& view = neighbors[k].View;
        const double length = scale * DistanceOf(points[edge.first], points[edge.second]);
        const double toStart = scale * DistanceOf(points[edge.first], points[apex]);
        const double toEnd = scale * DistanceOf(points[edge.second], points[apex]);
        EXPECT_GT(view.Height, 0.0);
        const double along = view.Foot * view.Length;
        worst = std::max({ worst, std::abs(view.Length - length) / length,
          std::abs(std::hypot(along, view.Height) - toStart) / toStart,
          std::abs(std::hypot(view.Length - along, view.Height) - toEnd) / toEnd });
      }
    }
  }
  std::cout << neighborsSeen << " neighbors, worst relative error of a length " << worst << "\n";
  EXPECT_GT(neighborsSeen, 2000);
  EXPECT_LT(worst, 2e-15);
}

//------------------------------------------------------------------------------------------------
// Planes.

/// Rows of a rotation by a random axis and angle.
std::array<Point, 3> RandomRotation(std::mt19937_64& generator)
{
  std::normal_distribution<double> normal;
  double q[4] = { normal(generator), normal(generator), normal(generator), normal(generator) };
  const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  for (double& x : q)
  {
    x /= length;
  }
  return { Point{ 1 - 2 * (q[2] * q[2] + q[3] * q[3]), 2 * (q[1] * q[2] - q[0] * q[3]),
             2 * (q[1] * q[3] + q[0] * q[2]) },
    Point{ 2 * (q[1] * q[2] + q[0] * q[3]), 1 - 2 * (q[1] * q[1] + q[3] * q[3]),
      2 * (q[2] * q[3] - q[0] * q[1]) },
    Point{ 2 * (q[1] * q[3] - q[0] * q[2]), 2 * (q[2] * q[3] + q[0] * q[1]),
      1 - 2 * (q[1] * q[1] + q[2] * q[2]) } };
}

Point Rotated(const std::array<Point, 3>& rotation, const Point& p)
{
  Point result;
  for (int row = 0; row < 3; ++row)
  {
    result[row] = rotation[row][0] * p[0] + rotation[row][1] * p[1] + rotation[row][2] * p[2];
  }
  return result;
}

bool IsPlanar(
  const std::vector<Point>& points, const std::vector<Triangle>& triangles, bool isFloat)
{
  vtkNew<vtkPoints> stored;
  stored->SetDataType(isFloat ? VTK_FLOAT : VTK_DOUBLE);
  for (const Point& p : points)
  {
    stored->InsertNextPoint(p.data());
  }
  Triangulation triangulation;
  triangulation.SetTriangles(Narrow(triangles), 0);
  triangulation.FindAdjacency(stored->GetNumberOfPoints());
  return MeshGeometry(stored, triangulation).IsPlanar();
}

TEST(Planes, RotatedAndShiftedPlanesArePlanar)
{
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> logarithm(-6.0, 6.0);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 2000; ++n)
  {
    const auto rotation = RandomRotation(generator);
    const double size = std::pow(10.0, logarithm(generator));
    const double away = n % 2 ? 0.0 : std::pow(10.0, 0.5 * logarithm(generator)) * size;
    const double stretch = n % 5 == 0 ? 1e-3 : 1.0;
    const Point shift{ away * normal(generator), away * normal(generator),
      away * normal(generator) };
    std::vector<Point> points = GridPoints(6, n, 0.2);
    for (Point& p : points)
    {
      p = Rotated(rotation, { size * p[0], stretch * size * p[1], 0.0 });
      for (int axis = 0; axis < 3; ++axis)
      {
        p[axis] += shift[axis];
      }
    }
    ASSERT_TRUE(IsPlanar(points, GridTriangles(6), false)) << n;
    ASSERT_TRUE(IsPlanar(points, GridTriangles(6), true)) << n;
  }
}

TEST(Planes, SlightlyBentPlanesAreNotPlanar)
{
  // One point off the plane by a few dozen ulp, in double and in float.
  std::mt19937_64 generator(6);
  std::uniform_int_distribution<std::size_t> any(0, 48);
  for (int n = 0; n < 2000; ++n)
  {
    const bool isFloat = n % 2 == 0;
    const auto rotation = RandomRotation(generator);
    std::vector<Point> points = GridPoints(6, n, 0.2);
    points[any(generator)][2] = isFloat ? 1e-4 : 2e-13;
    for (Point& p : points)
    {
      p = Rotated(rotation, p);
    }
    ASSERT_FALSE(IsPlanar(points, GridTriangles(6), isFloat)) << n;
  }
}

TEST(Planes, PlanesParallelToTwoAxesAreDecidedExactly)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<Point> points = GridPoints(4, 7, 0.2);
    for (Point& p : points)
    {
      p = { p[(3 - axis) % 3], p[(4 - axis) % 3], p[(5 - axis) % 3] };
    }
    const int normal = (axis + 2) % 3;
    for (Point& p : points)
    {
      ASSERT_EQ(0.0, p[normal]);
      p[normal] = 0.1;
    }
    EXPECT_TRUE(IsPlanar(points, GridTriangles(4), false));
  }
}

TEST(Planes, UnusedPointsDoNotAffectPlanarity)
{
  std::vector<Point> points = GridPoints(4, 8, 0.2);
  points.push_back({ 1.0, 1.0, 1.0 });
  EXPECT_TRUE(IsPlanar(points, GridTriangles(4), false));
  std::vector<Triangle> triangles = GridTriangles(4);
  triangles.push_back({ 0, 1, 25 });
  EXPECT_FALSE(IsPlanar(points, triangles, false));
}

TEST(Planes, OneTriangleIsPlanar)
{
  EXPECT_TRUE(IsPlanar({ { 1, 2, 3 }, { 5, 3, 1 }, { -2, 4, 4 } }, { { 0, 1, 2 } }, false));
  EXPECT_TRUE(IsPlanar({}, {}, false));
}

TEST(Planes, NormalizedCoordinatesReturn)
{
  std::mt19937_64 generator(9);
  double worst = 0.0;
  for (int n = 0; n < 1000; ++n)
  {
    const auto rotation = RandomRotation(generator);
    std::vector<Point> points = GridPoints(3, n, 0.2);
    for (Point& p : points)
    {
      p = n % 2 ? Rotated(rotation, p) : Point{ p[n % 3], p[(n + 1) % 3], p[(n + 2) % 3] };
      for (double& x : p)
      {
        x *= n % 7 == 0 ? 1e150 : 3.0;
      }
    }
    const auto mesh = MakeMesh(points, {});
    Triangulation triangulation;
    triangulation.SetTriangles(Narrow(GridTriangles(3)), 0);
    const MeshGeometry geometry(mesh->GetPoints(), triangulation);
    ASSERT_TRUE(geometry.IsPlanar());
    for (std::int32_t i = 0; i < 16; ++i)
    {
      const Vector3 normalized = geometry.ToNormalized(points[i].data());
      EXPECT_NEAR(0.0, normalized[2], 1e-14);
      EXPECT_EQ(normalized[0], geometry.GetPoint(i)[0]);
      EXPECT_EQ(normalized[1], geometry.GetPoint(i)[1]);
      Point back;
      geometry.FromNormalized(normalized, back.data());
      if (n % 2 == 0)
      {
        // A plane parallel to two axes involves no rounding.
        EXPECT_EQ(points[i], back);
      }
      worst = std::max(worst, DistanceOf(points[i], back) * geometry.GetScale());
    }
  }
  std::cout << "worst error of working coordinates and back " << worst << "\n";
  EXPECT_LT(worst, 4e-15);
}

//------------------------------------------------------------------------------------------------
// The cache.

class Cache : public testing::Test
{
protected:
  Cache()
  {
    this->Pair = MakePlanarPair(3, 10);
    this->Get();
    this->Current = this->Held.Get(this->Pair.Source, this->Pair.Target, this->Options);
    EXPECT_TRUE(this->Current);
    EXPECT_EQ(1, this->Held.GetNumberOfBuilds());
  }

  void Get() { this->Last = this->Held.Get(this->Pair.Source, this->Pair.Target, this->Options); }

  void ExpectKept(const char* what)
  {
    const vtkIdType before = this->Held.GetNumberOfBuilds();
    this->Get();
    EXPECT_EQ(before, this->Held.GetNumberOfBuilds()) << what;
  }

  void ExpectMadeAnew(const char* what)
  {
    const vtkIdType before = this->Held.GetNumberOfBuilds();
    this->Get();
    EXPECT_EQ(before + 1, this->Held.GetNumberOfBuilds()) << what;
    this->ExpectKept(what);
  }

  MeshPair Pair;
  HomeomorphismOptions Options;
  HomeomorphismCache Held;
  std::shared_ptr<const Homeomorphism> Current;
  std::shared_ptr<const Homeomorphism> Last;
};

TEST_F(Cache, IsKeptWhenOtherArraysChange)
{
  this->ExpectKept("nothing");
  for (vtkPolyData* mesh : { this->Pair.Source.Get(), this->Pair.Target.Get() })
  {
    vtkNew<vtkDoubleArray> values;
    values->SetName("Values");
    values->SetNumberOfTuples(16);
    values->FillValue(1.0);
    mesh->GetPointData()->SetScalars(values);
    this->ExpectKept("point data");
    vtkNew<vtkDoubleArray> cellValues;
    cellValues->SetNumberOfTuples(18);
    cellValues->SetName("CellValues");
    mesh->GetCellData()->AddArray(cellValues);
    this->ExpectKept("cell data");
    mesh->Modified();
    this->ExpectKept("the data object");
    EXPECT_EQ(this->Current, this->Last);
  }
  // Pipelines pass shallow copies on.
  const auto copy = vtkSmartPointer<vtkPolyData>::New();
  copy->ShallowCopy(this->Pair.Source);
  this->Pair.Source = copy;
  this->ExpectKept("a shallow copy");
}

TEST_F(Cache, IsRebuiltWhenPointsChange)
{
  for (vtkPolyData* mesh : { this->Pair.Source.Get(), this->Pair.Target.Get() })
  {
    MovePoint(mesh, 5, { 1.1, 0.9, 0.0 });
    this->ExpectMadeAnew("a point moved");
    mesh->GetPoints()->GetData()->SetComponent(5, 0, 1.05);
    mesh->GetPoints()->GetData()->Modified();
    this->ExpectMadeAnew("the points' array");
    vtkNew<vtkPoints> points;
    points->DeepCopy(mesh->GetPoints());
    mesh->SetPoints(points);
    this->ExpectMadeAnew("other points");
  }
}

TEST_F(Cache, IsRebuiltWhenCellsChange)
{
  for (const bool inSource : { true, false })
  {
    vtkPolyData* mesh = inSource ? this->Pair.Source : this->Pair.Target;
    vtkNew<vtkCellArray> polygons;
    polygons->DeepCopy(mesh->GetPolys());
    mesh->SetPolys(polygons);
    this->ExpectMadeAnew("other polygons");
    vtkNew<vtkCellArray> vertices;
    const vtkIdType zero = 0;
    vertices->InsertNextCell(1, &zero);
    mesh->SetVerts(vertices);
    this->ExpectMadeAnew("vertices, which shift the cell ids");
  }
}

TEST_F(Cache, IsRebuiltWhenCellsChangeInPlace)
{
  // As in user code: change the cells, then call Modified.
  for (const bool inSource : { true, false })
  {
    vtkPolyData* mesh = inSource ? this->Pair.Source : this->Pair.Target;
    const Triangle rotated{ 5, 0, 1 };
    mesh->GetPolys()->ReplaceCellAtId(0, 3, rotated.data());
    mesh->GetPolys()->Modified();
    mesh->Modified();
    this->ExpectMadeAnew("a cell replaced");
  }
}

TEST_F(Cache, IsRebuiltWhenCellsAreAppendedInPlace)
{
  for (const bool inSource : { true, false })
  {
    vtkPolyData* mesh = inSource ? this->Pair.Source : this->Pair.Target;
    const Triangle another{ 0, 1, 5 };
    mesh->GetPolys()->InsertNextCell(3, another.data());
    mesh->GetPolys()->Modified();
    mesh->Modified();
    this->ExpectMadeAnew("a cell appended");
  }
}

TEST_F(Cache, IsRebuiltWhenGhostsChange)
{
  for (const bool ofCells : { true, false })
  {
    vtkPolyData* mesh = this->Pair.Target;
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    ghosts->SetNumberOfTuples(ofCells ? 18 : 16);
    ghosts->FillValue(0);
    if (ofCells)
    {
      mesh->GetCellData()->AddArray(ghosts);
    }
    else
    {
      mesh->GetPointData()->AddArray(ghosts);
    }
    this->ExpectMadeAnew("ghosts added");
    ghosts->SetValue(0,
      ofCells ? static_cast<int>(vtkDataSetAttributes::HIDDENCELL)
              : static_cast<int>(vtkDataSetAttributes::HIDDENPOINT));
    ghosts->Modified();
    this->ExpectMadeAnew("ghosts changed");
    EXPECT_TRUE(this->Last->GetPair().GetTriangulation().IsMasked(0));
  }
}

TEST_F(Cache, IsRebuiltWhenOptionsChange)
{
  this->Options.System = homeomorphism::CoordinateSystem::Contour;
  this->ExpectMadeAnew("system");
  this->Options.Center = CenterPoint::Incenter;
  this->ExpectMadeAnew("center");
  this->Options.MaskInvalidTriangles = true;
  this->ExpectMadeAnew("mask");
  this->Options.DiscordantByLinear = true;
  this->ExpectMadeAnew("discordant");
}

TEST_F(Cache, IsRebuiltForOtherMeshes)
{
  std::swap(this->Pair.Source, this->Pair.Target);
  this->ExpectMadeAnew("exchanged");
  this->Pair.Target = nullptr;
  this->ExpectMadeAnew("no target");
  EXPECT_FALSE(this->Last->GetPair().HasTarget());
  this->Pair = MakePlanarPair(3, 10);
  this->ExpectMadeAnew("equal, but other objects");
}

TEST_F(Cache, KeepsRefusals)
{
  MovePoint(this->Pair.Source, 0, { 1e3, 1e3, 0.0 });
  this->ExpectMadeAnew("spoilt");
  EXPECT_FALSE(this->Last);
  EXPECT_EQ(1u, this->Held.GetProblems().size());
  this->ExpectKept("spoilt");
  EXPECT_FALSE(this->Last);
  EXPECT_EQ(1u, this->Held.GetProblems().size());
  MovePoint(this->Pair.Source, 0, { 0.0, 0.0, 0.0 });
  this->ExpectMadeAnew("repaired");
  EXPECT_TRUE(this->Last);
  EXPECT_TRUE(this->Held.GetProblems().empty());
}

TEST_F(Cache, KeepsNoMeshAlive)
{
  vtkWeakPointer<vtkPolyData> source = this->Pair.Source.Get();
  vtkWeakPointer<vtkPoints> points = this->Pair.Source->GetPoints();
  this->Pair = {};
  EXPECT_FALSE(source);
  EXPECT_FALSE(points);
}

TEST(CacheInFilter, MovingDataDoesNotReadTheMeshesAgain)
{
  const MeshPair pair = MakePlanarPair(4, 11);
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  for (int n = 0; n < 5; ++n)
  {
    const auto cloud = MakeCloud({ { 0.5 + 0.1 * n, 0.5, 0.0 } });
    filter->SetDataObject(cloud);
    filter->SetInverse(n % 2 == 0);
    filter->SetTolerance(0.01 * n);
    filter->SetComputeJacobian(n == 3);
    filter->Update();
    EXPECT_EQ(1, filter->GetNumberOfMeshBuilds());
  }
  MovePoint(pair.Target, 6, { 1.2, 1.1, 0.0 });
  filter->Update();
  EXPECT_EQ(2, filter->GetNumberOfMeshBuilds());
  filter->SetCoordinateSystemToLinear();
  filter->Update();
  EXPECT_EQ(3, filter->GetNumberOfMeshBuilds());
}

} // namespace
