// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Exactly the points of the closed domain are found, and the result depends on the point alone: in
// any plane, on surfaces, and at any size of the coordinates.

#include "MappedPoints.h"

#include "Mesh/Homeomorphism.h"
#include "Pipeline/DiagnosticMessages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>

namespace
{

using namespace homeomorphism;
using namespace test_meshes;

constexpr double Epsilon = std::numeric_limits<double>::epsilon();

std::shared_ptr<const Homeomorphism> Make(vtkPolyData* source, vtkPolyData* target)
{
  MeshDiagnostics problems;
  HomeomorphismOptions options;
  options.System = homeomorphism::CoordinateSystem::Linear;
  auto map = Homeomorphism::Make(source, target, options, problems);
  for (const MeshDiagnostic& problem : problems)
  {
    ADD_FAILURE() << GetName(problem.What);
  }
  return map;
}

double ToleranceOf(const Homeomorphism& map, double tolerance = 0.0)
{
  return map.GetAbsoluteTolerance(Domain::Source, tolerance, 0.5 * Epsilon);
}

SurfacePoint Locate(
  const Homeomorphism& map, const Point& point, TriangleIndex hint = -1, double tolerance = 0.0)
{
  return map.Locate(Domain::Source, point.data(), ToleranceOf(map, tolerance), hint);
}

/// The surface point in coordinates of the input.
Point PositionOf(const Homeomorphism& map, const SurfacePoint& location)
{
  const MeshGeometry& geometry = map.GetPair().GetGeometry(Domain::Source);
  Point point;
  geometry.FromNormalized(geometry.FromFrame(location.Triangle, location.Point), point.data());
  return point;
}

void ExpectSameLocation(const SurfacePoint& a, const SurfacePoint& b)
{
  ASSERT_EQ(a.Triangle, b.Triangle);
  ASSERT_EQ(a.Corner, b.Corner);
  ASSERT_EQ(a.Point.InPlane.x, b.Point.InPlane.x);
  ASSERT_EQ(a.Point.InPlane.y, b.Point.InPlane.y);
  ASSERT_EQ(a.Point.Offset, b.Point.Offset);
}

//------------------------------------------------------------------------------------------------
// In the plane, compared with exact arithmetic.

struct GridPoint
{
  std::int64_t X;
  std::int64_t Y;
};

int Turn(const GridPoint& a, const GridPoint& b, const GridPoint& c)
{
  const std::int64_t area = (b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X);
  return area > 0 ? 1 : (area < 0 ? -1 : 0);
}

/// A mesh whose points lie on the integer grid, with holes and concave boundary.
struct GridMesh
{
  std::vector<GridPoint> Points;
  std::vector<Triangle> Triangles;

  GridMesh(int squares, int size, int jitter, double holes, std::uint64_t seed)
  {
    std::mt19937_64 generator(seed);
    std::uniform_int_distribution<int> offset(-jitter, jitter);
    for (int j = 0; j <= squares; ++j)
    {
      for (int i = 0; i <= squares; ++i)
      {
        const bool inside = i > 0 && j > 0 && i < squares && j < squares;
        const int dx = offset(generator);
        const int dy = offset(generator);
        this->Points.push_back({ i * size + (inside ? dx : 0), j * size + (inside ? dy : 0) });
      }
    }
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    for (Triangle t : GridTriangles(squares))
    {
      if (chance(generator) >= holes)
      {
        std::shuffle(t.begin(), t.end(), generator);
        this->Triangles.push_back(t);
      }
    }
    std::shuffle(this->Triangles.begin(), this->Triangles.end(), generator);
  }

  /// The triangle with the lowest number that contains the point, including its boundary; -1 if
  /// there is none.
  TriangleIndex Find(const GridPoint& p) const
  {
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      int domains[3];
      for (int k = 0; k < 3; ++k)
      {
        domains[k] = Turn(
          this->Points[this->Triangles[t][k]], this->Points[this->Triangles[t][(k + 1) % 3]], p);
      }
      if (*std::min_element(domains, domains + 3) >= 0 ||
        *std::max_element(domains, domains + 3) <= 0)
      {
        return static_cast<TriangleIndex>(t);
      }
    }
    return -1;
  }

  int CornerAt(TriangleIndex triangle, const GridPoint& p) const
  {
    for (int k = 0; triangle >= 0 && k < 3; ++k)
    {
      const GridPoint& corner = this->Points[this->Triangles[triangle][k]];
      if (corner.X == p.X && corner.Y == p.Y)
      {
        return k;
      }
    }
    return -1;
  }

  /// The mesh with the given grid spacing, in the plane of two of the axes.
  vtkSmartPointer<vtkPolyData> ToMesh(double unit, int normalAxis = 2) const
  {
    std::vector<Point> points;
    for (const GridPoint& p : this->Points)
    {
      points.push_back(MeshPoint(p, unit, normalAxis));
    }
    return MakeMesh(points, this->Triangles);
  }

  static Point MeshPoint(const GridPoint& p, double unit, int normalAxis)
  {
    Point point;
    point[(normalAxis + 1) % 3] = static_cast<double>(p.X) * unit;
    point[(normalAxis + 2) % 3] = static_cast<double>(p.Y) * unit;
    point[normalAxis] = 0.0;
    return point;
  }

  /// Vertices, points on edges, points of a line beyond an edge, and points anywhere.
  std::vector<GridPoint> Queries(int anywhere, std::uint64_t seed) const
  {
    std::mt19937_64 generator(seed);
    std::vector<GridPoint> queries = this->Points;
    std::int64_t size = 0;
    for (const GridPoint& p : this->Points)
    {
      size = std::max({ size, p.X, p.Y });
    }
    for (const Triangle& t : this->Triangles)
    {
      for (int k = 0; k < 3; ++k)
      {
        const GridPoint& a = this->Points[t[k]];
        const GridPoint& b = this->Points[t[(k + 1) % 3]];
        for (const std::int64_t quarter : { -1, 1, 2, 3, 5 })
        {
          // Points of the grid, because all coordinates are multiples of four.
          queries.push_back({ a.X + (b.X - a.X) / 4 * quarter, a.Y + (b.Y - a.Y) / 4 * quarter });
        }
      }
    }
    std::uniform_int_distribution<std::int64_t> coordinate(-size / 8, size + size / 8);
    for (int n = 0; n < anywhere; ++n)
    {
      queries.push_back({ coordinate(generator), coordinate(generator) });
    }
    return queries;
  }
};

/// A mesh with coordinates that are multiples of four.
GridMesh FourfoldMesh(int squares, double holes, std::uint64_t seed)
{
  GridMesh mesh(squares, 16, 4, holes, seed);
  for (GridPoint& p : mesh.Points)
  {
    p = { 4 * p.X, 4 * p.Y };
  }
  return mesh;
}

TEST(PointLocation, AgreesWithExactArithmeticForEveryHint)
{
  int found = 0;
  int outside = 0;
  for (int n = 0; n < 120; ++n)
  {
    const GridMesh grid = FourfoldMesh(1 + n % 5, n % 3 == 0 ? 0.0 : 0.3, n);
    const double unit = std::ldexp(1.0, n % 7 - 3);
    const auto mesh = grid.ToMesh(unit, n % 3);
    const auto map = Make(mesh, nullptr);
    ASSERT_TRUE(map);
    for (const GridPoint& query : grid.Queries(200, n))
    {
      const TriangleIndex expected = grid.Find(query);
      const Point point = GridMesh::MeshPoint(query, unit, n % 3);
      const SurfacePoint location = Locate(*map, point);
      ASSERT_EQ(expected, location.Triangle) << n << ": " << query.X << " " << query.Y;
      ASSERT_EQ(grid.CornerAt(expected, query), location.Corner);
      ++(expected >= 0 ? found : outside);
      for (std::size_t hint = 0; hint < grid.Triangles.size(); ++hint)
      {
        ExpectSameLocation(location, Locate(*map, point, static_cast<TriangleIndex>(hint)));
      }
      if (expected >= 0)
      {
        ASSERT_LE(DistanceOf(point, PositionOf(*map, location)), 2e-13 * unit);
      }
    }
  }
  EXPECT_GT(found, 10000);
  EXPECT_GT(outside, 5000);
}

TEST(PointLocation, AgreesWithExactArithmeticInALargerMesh)
{
  const GridMesh grid = FourfoldMesh(40, 0.1, 1);
  const auto map = Make(grid.ToMesh(0.25), nullptr);
  TriangleIndex hint = -1;
  for (const GridPoint& query : grid.Queries(3000, 2))
  {
    const SurfacePoint location = Locate(*map, GridMesh::MeshPoint(query, 0.25, 2), hint);
    ASSERT_EQ(grid.Find(query), location.Triangle);
    hint = location.Triangle;
  }
}

TEST(PointLocation, AllPointsOfASquareAreFound)
{
  // No point of the closed square falls between triangles, wherever their edges are.
  const auto mesh = MakePlanarPair(30, 3).Source;
  const auto map = Make(mesh, nullptr);
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> coordinate(0.0, 30.0);
  TriangleIndex hint = -1;
  for (int n = 0; n < 200000; ++n)
  {
    Point p{ coordinate(generator), coordinate(generator), 0.0 };
    if (n % 10 == 0)
    {
      p[n / 10 % 2] = n / 20 % 2 ? 0.0 : 30.0;
    }
    const SurfacePoint location = Locate(*map, p, hint);
    ASSERT_GE(location.Triangle, 0) << p[0] << " " << p[1];
    hint = location.Triangle;
  }
}

TEST(PointLocation, PointsOnRoundedEdgesAreFound)
{
  // Edges whose corners are not exactly representable: computed points lie on either side by
  // rounding.
  const MeshPair pair = MakePlanarPair(20, 4);
  const std::vector<Point> points = PointsOf(pair.Source);
  const auto map = Make(pair.Source, nullptr);
  for (const Triangle& t : GridTriangles(20))
  {
    for (int k = 0; k < 3; ++k)
    {
      for (const double w : { 0.5, 0.1, 0.37, 1e-3, 1e-15 })
      {
        Point p{};
        for (int axis = 0; axis < 2; ++axis)
        {
          p[axis] = (1.0 - w) * points[t[k]][axis] + w * points[t[(k + 1) % 3]][axis];
        }
        ASSERT_GE(Locate(*map, p).Triangle, 0);
      }
    }
  }
}

TEST(PointLocation, CornersAreFoundExactly)
{
  for (const bool planar : { true, false })
  {
    const MeshPair pair = planar ? MakePlanarPair(12, 5) : MakeClosedPair(4, 5);
    const auto map = Make(pair.Source, pair.Target);
    for (const Domain domain : { Domain::Source, Domain::Target })
    {
      const bool forward = domain == Domain::Source;
      const std::vector<Point> points = PointsOf(forward ? pair.Source : pair.Target);
      const std::vector<Point> others = PointsOf(forward ? pair.Target : pair.Source);
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        const SurfacePoint location = map->Locate(
          domain, points[i].data(), map->GetAbsoluteTolerance(domain, 0.0, 0.5 * Epsilon), -1);
        ASSERT_GE(location.Triangle, 0);
        ASSERT_GE(location.Corner, 0);
        Point image;
        map->MapPoint(domain, location, image.data());
        ASSERT_EQ(others[i], image);
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
// The boundary of the domain.

TEST(PointLocation, PointsOutsideByRoundingAreFound)
{
  // The largest coordinate is 8, with an ulp of 1.8e-15.
  const auto mesh = MakeMesh(GridPoints(8, 0, 0.0), GridTriangles(8));
  const auto map = Make(mesh, mesh);
  const double ulp = 8.0 * Epsilon;
  for (int axis = 0; axis < 2; ++axis)
  {
    for (const bool high : { false, true })
    {
      for (const double along : { 0.0, 0.3, 3.0, 3.7, 8.0 })
      {
        const auto at = [&](double distance) {
          Point p{};
          p[axis] = high ? 8.0 + distance : -distance;
          p[1 - axis] = along;
          return p;
        };
        for (const double near : { 0.0, 1e-300, ulp, 2.0 * ulp, 3.0 * ulp })
        {
          const SurfacePoint location = Locate(*map, at(near));
          ASSERT_GE(location.Triangle, 0) << near;
          // The result lies on the boundary, not outside.
          Point image;
          map->MapPoint(Domain::Source, location, image.data());
          EXPECT_NEAR(high ? 8.0 : 0.0, image[axis], ulp);
          EXPECT_NEAR(along, image[1 - axis], ulp);
        }
        for (const double far : { 16.0 * ulp, 1e-12, 1e-6, 0.1, 1e10, 1e300 })
        {
          EXPECT_EQ(-1, Locate(*map, at(far)).Triangle) << far;
        }
      }
    }
  }
}

TEST(PointLocation, FloatPointsHaveFloatPrecision)
{
  // The precision of the points counts, independently of that of the mesh.
  const auto mesh = MakeMesh(GridPoints(8, 0, 0.0), GridTriangles(8));
  for (const bool isFloat : { false, true })
  {
    vtkNew<vtkDifferentiableHomeomorphism> filter;
    filter->SetSourceData(mesh);
    filter->SetTargetData(mesh);
    vtkNew<vtkPoints> points;
    points->SetDataType(isFloat ? VTK_FLOAT : VTK_DOUBLE);
    points->InsertNextPoint(-1e-6, 3.3, 0.0);
    points->InsertNextPoint(-1e-5, 3.3, 0.0);
    vtkNew<vtkPolyData> cloud;
    cloud->SetPoints(points);
    filter->SetDataObject(cloud);
    filter->Update();
    EXPECT_EQ(isFloat ? 1 : 2, filter->GetNumberOfOutsidePoints());
  }
}

TEST(PointLocation, NonFiniteCoordinatesAreOutside)
{
  const MeshPair sheets{ MakeSheet(4, 6, 0.3), MakeSheet(4, 7, 0.3) };
  const MeshPair planes = MakePlanarPair(4, 6);
  std::vector<Point> tilted = PointsOf(planes.Source);
  for (Point& p : tilted)
  {
    p[2] = 0.5 * p[0] + 0.25 * p[1];
  }
  const MeshPair tilts{ MakeMesh(tilted, GridTriangles(4)), planes.Target };
  for (const MeshPair& pair : { sheets, planes, tilts })
  {
    const auto map = Make(pair.Source, pair.Target);
    const Point sound = PointsOf(pair.Source)[6];
    ASSERT_GE(Locate(*map, sound).Triangle, 0);
    for (const double bad : { std::numeric_limits<double>::quiet_NaN(),
           std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity() })
    {
      for (int axes = 1; axes < 8; ++axes)
      {
        Point p = sound;
        for (int axis = 0; axis < 3; ++axis)
        {
          p[axis] = axes & (1 << axis) ? bad : p[axis];
        }
        for (const double tolerance : { 0.0, 0.1, 1e300 })
        {
          for (const TriangleIndex hint : { -1, 0, 9 })
          {
            EXPECT_EQ(-1, Locate(*map, p, hint, tolerance).Triangle);
          }
        }
      }
    }
  }
}

TEST(PointLocation, HugeCoordinatesAreOutsideForEveryHint)
{
  // Products of such coordinates overflow.
  for (const double unit : { 1.0, 1e-300, 1e300 })
  {
    std::vector<Point> points = GridPoints(3, 8, 0.2);
    for (Point& p : points)
    {
      p = { unit * p[0], unit * p[1], 0.0 };
    }
    const auto map = Make(MakeMesh(points, GridTriangles(3)), nullptr);
    for (const double huge : { 1e154, 1e160, 1e200, 1e307, 1.7e308 })
    {
      if (huge < 1e3 * unit)
      {
        continue;
      }
      for (const Point& p : { Point{ huge, huge, 0 }, Point{ -huge, huge, 0 }, Point{ huge, 0, 0 },
             Point{ 0, -huge, 0 }, Point{ huge, 0.5 * huge, 0 }, Point{ -huge, -huge, 0 },
             Point{ unit, huge, 0 }, Point{ -huge, 0.3 * unit, 0 } })
      {
        for (TriangleIndex hint = -1; hint < 18; ++hint)
        {
          ASSERT_EQ(-1, Locate(*map, p, hint).Triangle) << unit << " " << p[0] << " " << p[1];
        }
      }
    }
  }
}

TEST(PointLocation, AHugePointAfterOneInsideIsOutside)
{
  // The same through the filter, which uses the triangle of each point as the hint for the next
  // one. With this many points, some neighbors stay together when they are distributed to threads.
  const MeshPair pair = MakePlanarPair(3, 9);
  std::vector<Point> points;
  for (const double huge : { 1e20, 1e155, 1e160, 1e300 })
  {
    for (const Triangle& t : GridTriangles(3))
    {
      for (const Point& far : { Point{ huge, huge, 0 }, Point{ -huge, huge, 0 },
             Point{ huge, 0, 0 }, Point{ 0, -huge, 0 }, Point{ -huge, -huge, 0 } })
      {
        points.push_back(CentroidOf(pair.Source, t));
        points.push_back(far);
      }
    }
  }
  const MappedPoints mapped = MapPoints(pair, points);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    ASSERT_EQ(i % 2 == 0, mapped.IsInside(i)) << points[i][0] << " " << points[i][1] << " goes to "
                                              << mapped.Images[i][0] << " " << mapped.Images[i][1];
  }
}

//------------------------------------------------------------------------------------------------
// Tolerance and nearest point, compared with all triangles.

using Real = long double;
using RealPoint = std::array<Real, 3>;

RealPoint Minus(const RealPoint& a, const RealPoint& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

Real Dot(const RealPoint& a, const RealPoint& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

RealPoint Widen(const Point& p)
{
  return { p[0], p[1], p[2] };
}

RealPoint Cross(const RealPoint& a, const RealPoint& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

Real SquaredDistanceToSegment(const RealPoint& p, const RealPoint& a, const RealPoint& b)
{
  const RealPoint ab = Minus(b, a);
  Real t = Dot(Minus(p, a), ab) / Dot(ab, ab);
  t = std::max<Real>(0, std::min<Real>(1, t));
  const RealPoint d = Minus(p, { a[0] + t * ab[0], a[1] + t * ab[1], a[2] + t * ab[2] });
  return Dot(d, d);
}

Real DistanceToTriangle(const Point& point, const std::array<Point, 3>& corners)
{
  const RealPoint p = Widen(point);
  const RealPoint a = Widen(corners[0]);
  const RealPoint b = Widen(corners[1]);
  const RealPoint c = Widen(corners[2]);
  const RealPoint u = Minus(b, a);
  const RealPoint v = Minus(c, a);
  const RealPoint d = Minus(p, a);
  // Weights of the foot in the plane of the triangle, as ratios of areas, which are accurate for
  // needles too.
  const RealPoint normal = Cross(u, v);
  const Real s = Dot(normal, Cross(d, v)) / Dot(normal, normal);
  const Real t = Dot(normal, Cross(u, d)) / Dot(normal, normal);
  if (s >= 0 && t >= 0 && s + t <= 1)
  {
    const RealPoint off{ d[0] - s * u[0] - t * v[0], d[1] - s * u[1] - t * v[1],
      d[2] - s * u[2] - t * v[2] };
    return std::sqrt(Dot(off, off));
  }
  return std::sqrt(std::min({ SquaredDistanceToSegment(p, a, b), SquaredDistanceToSegment(p, b, c),
    SquaredDistanceToSegment(p, c, a) }));
}

std::vector<Triangle> TrianglesOf(vtkPolyData* mesh)
{
  std::vector<Triangle> triangles;
  for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
  {
    const vtkIdType* ids;
    vtkIdType size;
    mesh->GetCellPoints(t, size, ids);
    triangles.push_back({ ids[0], ids[1], ids[2] });
  }
  return triangles;
}

/// Queries near and far from a mesh. A point is found if and only if some triangle is within the
/// tolerance; the surface point is on the nearest triangle, at the correct distance.
void ExpectNearest(vtkPolyData* mesh, double tolerance, double spread, int queries,
  std::uint64_t seed, int leastFound, int leastOutside)
{
  const auto map = Make(mesh, nullptr);
  const MeshGeometry& geometry = map->GetPair().GetGeometry(Domain::Source);
  const bool planar = geometry.IsPlanar();
  const std::vector<Point> points = PointsOf(mesh);
  const std::vector<Triangle> triangles = TrianglesOf(mesh);
  const double allowed = tolerance * geometry.GetDiagonal() / geometry.GetScale();
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> offset(0.0, spread);
  std::uniform_int_distribution<std::size_t> any(0, points.size() - 1);
  int found = 0;
  int outside = 0;
  double worst = 0.0;
  TriangleIndex hint = -1;
  for (int n = 0; n < queries; ++n)
  {
    Point query = points[any(generator)];
    for (int axis = 0; axis < (planar ? 2 : 3); ++axis)
    {
      query[axis] += offset(generator);
    }
    std::vector<Real> distances;
    for (const Triangle& t : triangles)
    {
      distances.push_back(DistanceToTriangle(query, { points[t[0]], points[t[1]], points[t[2]] }));
    }
    const Real least = *std::min_element(distances.begin(), distances.end());
    if (std::abs(least - static_cast<Real>(allowed)) < 1e-12 * allowed)
    {
      continue;
    }
    const SurfacePoint location = Locate(*map, query, hint, tolerance);
    ExpectSameLocation(location, Locate(*map, query, -1, tolerance));
    ASSERT_EQ(least <= allowed, location.Triangle >= 0) << static_cast<double>(least);
    hint = location.Triangle;
    if (location.Triangle < 0)
    {
      ++outside;
      continue;
    }
    ++found;
    worst = std::max(worst, static_cast<double>(distances[location.Triangle] - least));
    // The surface point without its offset lies on the triangle, at that distance.
    SurfacePoint foot = location;
    foot.Point.Offset = 0.0;
    const Point surfacePoint = PositionOf(*map, foot);
    const Triangle& t = triangles[location.Triangle];
    const double off = static_cast<double>(
      DistanceToTriangle(surfacePoint, { points[t[0]], points[t[1]], points[t[2]] }));
    worst = std::max(
      { worst, off, std::abs(DistanceOf(surfacePoint, query) - static_cast<double>(least)) });
  }
  std::cout << found << " found, " << outside << " outside, worst error " << worst << "\n";
  EXPECT_GE(found, leastFound);
  EXPECT_GE(outside, leastOutside);
  EXPECT_LT(worst, 1e-14 * geometry.GetLargestCoordinate() / geometry.GetScale());
}

TEST(PointLocation, ToleranceInThePlane)
{
  GridMesh grid(8, 16, 4, 0.3, 10);
  ExpectNearest(grid.ToMesh(1.0 / 16.0), 0.01, 0.8, 3000, 10, 1500, 200);
  ExpectNearest(grid.ToMesh(1.0 / 16.0), 0.001, 0.8, 3000, 11, 1000, 300);
  // A tolerance so large that every point is inside.
  ExpectNearest(grid.ToMesh(1.0 / 16.0), 1e3, 50.0, 1000, 12, 990, 0);
}

TEST(PointLocation, ToleranceOfNeedles)
{
  std::vector<Point> points = GridPoints(8, 13, 0.2);
  for (Point& p : points)
  {
    p[1] *= 1e-4;
  }
  ExpectNearest(MakeMesh(points, GridTriangles(8)), 0.01, 0.2, 2000, 13, 400, 200);
}

TEST(PointLocation, ToleranceOnSurfaces)
{
  ExpectNearest(MakeSheet(8, 14, 0.5), 0.01, 0.2, 2000, 14, 500, 500);
  ExpectNearest(MakeClosedPair(3, 15).Target, 0.02, 0.1, 2000, 15, 500, 500);
  ExpectNearest(MakeClosedPair(2, 16).Source, 1e3, 3.0, 1000, 16, 990, 0);
}

TEST(PointLocation, WithTheLargestToleranceAllPointsAreInside)
{
  for (const bool planar : { true, false })
  {
    const auto map = Make(planar ? MakePlanarPair(4, 17).Source : MakeSheet(4, 17, 0.3), nullptr);
    for (const double far : { 10.0, 1e10, 1e150 })
    {
      EXPECT_GE(Locate(*map, { far, -far, 0.0 }, -1, VTK_DOUBLE_MAX).Triangle, 0) << far;
    }
  }
}

//------------------------------------------------------------------------------------------------
// Surfaces.

void ExpectOnSurface(const MeshPair& pair)
{
  const auto map = Make(pair.Source, pair.Target);
  const std::vector<Triangle> triangles = TrianglesOf(pair.Source);
  const std::vector<Point> points = PointsOf(pair.Source);
  const double largest = map->GetPair().GetGeometry(Domain::Source).GetLargestCoordinate() /
    map->GetPair().GetGeometry(Domain::Source).GetScale();
  double worst = 0.0;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (const Point& w : { Point{ 0.3, 0.3, 0.4 }, Point{ 0.9, 0.06, 0.04 },
           Point{ 0.002, 0.498, 0.5 }, Point{ 1e-7, 0.7, 0.3 - 1e-7 } })
    {
      Point p{};
      for (int k = 0; k < 3; ++k)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          p[axis] += w[k] * points[triangles[t][k]][axis];
        }
      }
      const SurfacePoint location = Locate(*map, p);
      ASSERT_EQ(static_cast<TriangleIndex>(t), location.Triangle);
      for (const TriangleIndex hint : { TriangleIndex(0), static_cast<TriangleIndex>(t) })
      {
        ExpectSameLocation(location, Locate(*map, p, hint));
      }
      const TriangleShape& shape =
        map->GetPair().GetGeometry(Domain::Source).GetShape(location.Triangle);
      const Barycentric found = shape.ToBarycentric(location.Point.InPlane);
      for (int k = 0; k < 3; ++k)
      {
        worst = std::max(worst, std::abs(found[k] - w[k]));
      }
      // Points off the surface by more than rounding are outside.
      const RealPoint normal =
        Cross(Minus(Widen(points[triangles[t][1]]), Widen(points[triangles[t][0]])),
          Minus(Widen(points[triangles[t][2]]), Widen(points[triangles[t][0]])));
      const Real length = std::sqrt(Dot(normal, normal));
      for (const double distance : { 4e-15, 1e-12, 1e-6 })
      {
        for (const int domain : { -1, 1 })
        {
          Point off = p;
          for (int axis = 0; axis < 3; ++axis)
          {
            off[axis] += static_cast<double>(domain * distance * largest * normal[axis] / length);
          }
          ASSERT_EQ(-1, Locate(*map, off).Triangle) << distance;
          if (distance < 1e-10)
          {
            ASSERT_EQ(static_cast<TriangleIndex>(t), Locate(*map, off, -1, 1e-10).Triangle);
          }
        }
      }
    }
  }
  std::cout << "worst barycentric coordinate " << worst << "\n";
  EXPECT_LT(worst, 1e-13);
}

TEST(PointLocation, PointsOfAnOpenSheet)
{
  ExpectOnSurface({ MakeSheet(10, 20, 0.5), MakeSheet(10, 21, 0.7) });
}

TEST(PointLocation, PointsOfAClosedSurface)
{
  ExpectOnSurface(MakeClosedPair(3, 22));
}

TEST(PointLocation, PointsOnEdgesOfSurfaces)
{
  // On a shared edge the lower number is used if both are equally near, and one of the two in any
  // case.
  const MeshPair pair = MakeClosedPair(3, 23);
  const auto map = Make(pair.Source, pair.Target);
  const std::vector<Point> points = PointsOf(pair.Source);
  const std::vector<Triangle> triangles = TrianglesOf(pair.Source);
  const Triangulation& topology = map->GetPair().GetTriangulation();
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      Point p;
      for (int axis = 0; axis < 3; ++axis)
      {
        p[axis] = 0.6 * points[triangles[t][(k + 1) % 3]][axis] +
          0.4 * points[triangles[t][(k + 2) % 3]][axis];
      }
      const TriangleIndex found = Locate(*map, p).Triangle;
      const auto here = static_cast<TriangleIndex>(t);
      EXPECT_TRUE(found == here || found == topology.GetTwin(here, k).Triangle);
    }
  }
}

TEST(PointLocation, AFlatMeshInAPairWithASurfaceHasNoHeights)
{
  const MeshPair pair{ MakePlanarPair(4, 24).Source, MakeSheet(4, 25, 0.3) };
  const auto map = Make(pair.Source, pair.Target);
  EXPECT_GE(Locate(*map, { 1.3, 2.2, 0.0 }).Triangle, 0);
  EXPECT_EQ(-1, Locate(*map, { 1.3, 2.2, 1e-9 }).Triangle);
  EXPECT_EQ(-1, Locate(*map, { 1.3, 2.2, -1.0 }).Triangle);
  const auto planes = Make(pair.Source, MakePlanarPair(4, 26).Source);
  for (const double height : { 1e-9, -1.0, 1e9 })
  {
    EXPECT_GE(Locate(*planes, { 1.3, 2.2, height }).Triangle, 0);
  }
}

//------------------------------------------------------------------------------------------------
// Order, hints and threads.

TEST(PointLocation, TheOrderOfPointsDoesNotMatter)
{
  for (const bool planar : { true, false })
  {
    const MeshPair pair = planar ? MakePlanarPair(15, 27) : MakeClosedPair(3, 27);
    const std::vector<Triangle> triangles = TrianglesOf(pair.Source);
    std::vector<Point> points = SamplePoints(pair.Source, triangles, 20, 27);
    // Also points on edges and at corners, which belong to several triangles.
    const std::vector<Point> corners = PointsOf(pair.Source);
    for (const Triangle& t : triangles)
    {
      points.push_back(corners[t[0]]);
      points.push_back(PointIn(pair.Source, t, { 0.5, 0.5, 0.0 }));
    }
    MapOptions options;
    options.Tolerance = 1e-12;
    const MappedPoints straight = MapPoints(pair, points, options);
    std::vector<std::size_t> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      order[i] = i;
    }
    std::mt19937_64 generator(27);
    std::shuffle(order.begin(), order.end(), generator);
    std::vector<Point> shuffled;
    for (const std::size_t i : order)
    {
      shuffled.push_back(points[i]);
    }
    const MappedPoints mixed = MapPoints(pair, shuffled, options);
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      ASSERT_EQ(straight.Triangles[order[i]], mixed.Triangles[i]);
      ASSERT_EQ(straight.Images[order[i]], mixed.Images[i]);
    }
  }
}

//------------------------------------------------------------------------------------------------
// Sizes of coordinates.

MeshPair Scaled(const MeshPair& pair, double source, double target)
{
  const std::vector<Triangle> triangles = TrianglesOf(pair.Source);
  const auto scaled = [&triangles](vtkPolyData* mesh, double factor) {
    std::vector<Point> points = PointsOf(mesh);
    for (Point& p : points)
    {
      for (double& x : p)
      {
        x *= factor;
      }
    }
    return MakeMesh(points, triangles);
  };
  return { scaled(pair.Source, source), scaled(pair.Target, target) };
}

TEST(PointLocation, ScalingByPowersOfTwoIsExact)
{
  for (const bool planar : { true, false })
  {
    const MeshPair pair = planar ? MakePlanarPair(8, 30) : MakeClosedPair(2, 30);
    const std::vector<Point> points = SamplePoints(pair.Source, TrianglesOf(pair.Source), 10, 30);
    const MappedPoints expected = MapPoints(pair, points);
    for (const int exponent : { -1000, -600, -40, 40, 600, 1000 })
    {
      const double factor = std::ldexp(1.0, exponent);
      std::vector<Point> scaled = points;
      for (Point& p : scaled)
      {
        p = { p[0] * factor, p[1] * factor, p[2] * factor };
      }
      const MappedPoints mapped = MapPoints(Scaled(pair, factor, factor), scaled);
      ASSERT_EQ("", mapped.Error);
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        ASSERT_EQ(expected.Triangles[i], mapped.Triangles[i]);
        for (int axis = 0; axis < 3; ++axis)
        {
          ASSERT_EQ(expected.Images[i][axis], mapped.Images[i][axis] / factor) << exponent;
        }
      }
    }
  }
}

TEST(PointLocation, AnySize)
{
  for (const bool planar : { true, false })
  {
    const MeshPair pair = planar ? MakePlanarPair(8, 31) : MakeClosedPair(2, 31);
    const std::vector<Triangle> triangles = TrianglesOf(pair.Source);
    const std::vector<Point> points = SamplePoints(pair.Source, triangles, 10, 31);
    const MappedPoints expected = MapPoints(pair, points);
    for (const double size : { 1e-300, 1e-100, 1e-10, 1e10, 1e100, 1e300, 2e307 })
    {
      std::vector<Point> scaled = points;
      for (Point& p : scaled)
      {
        p = { p[0] * size, p[1] * size, p[2] * size };
      }
      const MappedPoints mapped = MapPoints(Scaled(pair, size, size), scaled);
      ASSERT_EQ("", mapped.Error) << size;
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        ASSERT_TRUE(mapped.IsInside(i)) << size;
        for (int axis = 0; axis < 3; ++axis)
        {
          ASSERT_NEAR(expected.Images[i][axis], mapped.Images[i][axis] / size, 2e-13) << size;
        }
      }
    }
  }
}

TEST(PointLocation, RoundTripsBetweenExtremeSizes)
{
  // Two meshes of very different size: neither the sizes nor their ratio may overflow.
  for (const bool planar : { true, false })
  {
    const MeshPair pair = planar ? MakePlanarPair(4, 32) : MakeClosedPair(1, 32);
    const std::vector<Point> points = SamplePoints(pair.Source, TrianglesOf(pair.Source), 5, 32);
    const MappedPoints expected = MapPoints(pair, points);
    for (const int exponent : { 20, 500, 900 })
    {
      const double factor = std::ldexp(1.0, exponent);
      for (const double source : { factor, 1.0 / factor })
      {
        const double target = 1.0 / source;
        std::vector<Point> scaled = points;
        for (Point& p : scaled)
        {
          p = { p[0] * source, p[1] * source, p[2] * source };
        }
        const MappedPoints mapped = MapPoints(Scaled(pair, source, target), scaled);
        ASSERT_EQ("", mapped.Error);
        for (std::size_t i = 0; i < points.size(); ++i)
        {
          ASSERT_TRUE(mapped.IsInside(i));
          for (int axis = 0; axis < 3; ++axis)
          {
            ASSERT_NEAR(expected.Images[i][axis], mapped.Images[i][axis] / target, 1e-13)
              << (planar ? "plane" : "surface") << " from " << source << " to " << target;
          }
        }
      }
    }
  }
}

TEST(PointLocation, RoundTripsBetweenSurfacesOfDifferentSizes)
{
  // A point off the larger surface by rounding alone must not be farther off the smaller one, or it
  // would be outside on the way back.
  const MeshPair pair = MakeClosedPair(2, 35);
  const std::vector<Point> points = SamplePoints(pair.Source, TrianglesOf(pair.Source), 20, 35);
  for (const double size : { 1e-6, 1e-3, 1e-2, 1.0, 1e2, 1e3, 1e6 })
  {
    const MeshPair sized = Scaled(pair, 1.0, size);
    const MappedPoints there = MapPoints(sized, points);
    MapOptions options;
    options.Inverse = true;
    const MappedPoints back = MapPoints(sized, there.Images, options);
    int lost = 0;
    double worst = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      ASSERT_TRUE(there.IsInside(i));
      lost += !back.IsInside(i);
      worst = std::max(worst, back.IsInside(i) ? DistanceOf(points[i], back.Images[i]) : 0.0);
    }
    EXPECT_EQ(0, lost) << "of " << points.size() << " with a target of size " << size;
    EXPECT_LT(worst, 1e-13) << "with a target of size " << size;
  }
}

TEST(PointLocation, SubnormalCoordinates)
{
  // Multiples of the least positive number, which are exact.
  const GridMesh grid = FourfoldMesh(3, 0.2, 33);
  const double unit = std::numeric_limits<double>::denorm_min();
  const auto mesh = grid.ToMesh(unit);
  const auto map = Make(mesh, mesh);
  ASSERT_TRUE(map);
  for (const GridPoint& query : grid.Queries(500, 33))
  {
    const SurfacePoint location = Locate(*map, GridMesh::MeshPoint(query, unit, 2));
    ASSERT_EQ(grid.Find(query), location.Triangle);
    ASSERT_EQ(grid.CornerAt(location.Triangle, query), location.Corner);
    if (location.Triangle >= 0)
    {
      Point image;
      map->MapPoint(Domain::Source, location, image.data());
      ASSERT_EQ(GridMesh::MeshPoint(query, unit, 2), image);
    }
  }
}

TEST(PointLocation, NationalGrid)
{
  // Meters from the corner of a country, cells of ten meters, points to the millimeter.
  const Point corner{ 4.5e6, 5.8e6, 0.0 };
  const MeshPair origin = MakePlanarPair(10, 34);
  MeshPair pair = Scaled(origin, 10.0, 10.0);
  MeshPair local = Scaled(origin, 10.0, 10.0);
  for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
  {
    const std::vector<Point> points = PointsOf(mesh);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      // Rounded to the millimeter, so that both versions have the same shape.
      Point p{ std::round(1e3 * points[i][0]) / 1e3, std::round(1e3 * points[i][1]) / 1e3, 0.0 };
      MovePoint(
        mesh == pair.Source.Get() ? local.Source : local.Target, static_cast<vtkIdType>(i), p);
      MovePoint(mesh, static_cast<vtkIdType>(i), { corner[0] + p[0], corner[1] + p[1], 0.0 });
    }
  }
  std::vector<Point> points = SamplePoints(local.Source, GridTriangles(10), 20, 34);
  std::vector<Point> onGrid = points;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    points[i] = { std::round(1e3 * points[i][0]) / 1e3, std::round(1e3 * points[i][1]) / 1e3, 0.0 };
    onGrid[i] = { corner[0] + points[i][0], corner[1] + points[i][1], 0.0 };
  }
  const MappedPoints expected = MapPoints(local, points);
  const MappedPoints mapped = MapPoints(pair, onGrid);
  ASSERT_EQ("", mapped.Error);
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    ASSERT_TRUE(expected.IsInside(i));
    ASSERT_TRUE(mapped.IsInside(i));
    const Point back{ mapped.Images[i][0] - corner[0], mapped.Images[i][1] - corner[1], 0.0 };
    worst = std::max(worst, DistanceOf(expected.Images[i], back));
  }
  std::cout << "worst difference " << worst << " m\n";
  // An ulp is about a nanometer.
  EXPECT_LT(worst, 1e-8);
  // Points a millimeter, and a micrometer, outside are outside.
  for (const double off : { 1e-3, 1e-6 })
  {
    const MappedPoints outside = MapPoints(pair,
      { { corner[0] - off, corner[1] + 33.3, 0.0 },
        { corner[0] + 100.0 + off, corner[1] + 1.0, 0.0 },
        { corner[0] + 50.0, corner[1] - off, 0.0 },
        { corner[0] + 50.0, corner[1] + 100.0 + off, 0.0 } });
    EXPECT_EQ((std::vector<vtkIdType>{ -1, -1, -1, -1 }), outside.Triangles);
  }
}

//------------------------------------------------------------------------------------------------
// Planes in space.

/// A frame: the axes of the plane, and the normal along which heights are measured.
struct Frame
{
  std::array<Point, 3> Axes;
  Point Origin;

  Point MeshPoint(const Point& p) const
  {
    Point q = this->Origin;
    for (int k = 0; k < 3; ++k)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        q[axis] += p[k] * this->Axes[k][axis];
      }
    }
    return q;
  }
};

vtkSmartPointer<vtkPolyData> MovedInto(const Frame& frame, vtkPolyData* mesh)
{
  std::vector<Point> points = PointsOf(mesh);
  for (Point& p : points)
  {
    p = frame.MeshPoint(p);
  }
  return MakeMesh(points, TrianglesOf(mesh));
}

/// The map between two frames equals that of the xy plane. The normal of the target is the one that
/// makes less than a right angle with the source's normal.
void ExpectSameInFrames(const Frame& from, Frame to, double tolerance)
{
  const Point& up = from.Axes[2];
  Point& normal = to.Axes[2];
  const double cosine = up[0] * normal[0] + up[1] * normal[1] + up[2] * normal[2];
  if (cosine < 0.0)
  {
    normal = { -normal[0], -normal[1], -normal[2] };
  }
  const MeshPair pair = MakePlanarPair(8, 40);
  const MeshPair moved{ MovedInto(from, pair.Source), MovedInto(to, pair.Target) };
  std::vector<Point> points = SamplePoints(pair.Source, GridTriangles(8), 10, 40);
  const std::size_t corners = points.size();
  for (const Point& p : PointsOf(pair.Source))
  {
    points.push_back(p);
  }
  for (std::size_t i = 0; i < corners; i += 3)
  {
    points[i][2] = 0.25 * static_cast<double>(i % 7) - 0.5;
  }
  points.push_back({ -1e-6, 3.3, 0.0 });
  points.push_back({ 3.3, 8.0 + 1e-6, 1.0 });
  std::vector<Point> inFrame;
  for (const Point& p : points)
  {
    inFrame.push_back(from.MeshPoint(p));
  }
  const MappedPoints expected = MapPoints(pair, points);
  const MappedPoints mapped = MapPoints(moved, inFrame);
  ASSERT_EQ("", mapped.Error + mapped.Warning);
  MapOptions backwards;
  backwards.Inverse = true;
  const MappedPoints back = MapPoints(moved, mapped.Images, backwards);
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    ASSERT_EQ(expected.IsInside(i), mapped.IsInside(i)) << i;
    if (!mapped.IsInside(i))
    {
      continue;
    }
    if (i < corners)
    {
      ASSERT_EQ(expected.Triangles[i], mapped.Triangles[i]);
    }
    worst = std::max({ worst, DistanceOf(to.MeshPoint(expected.Images[i]), mapped.Images[i]),
      DistanceOf(inFrame[i], back.Images[i]) });
  }
  EXPECT_LE(worst, tolerance);
}

const Frame PlaneXY{ { Point{ 1, 0, 0 }, Point{ 0, 1, 0 }, Point{ 0, 0, 1 } }, { 0, 0, 0 } };

TEST(PointLocation, PlanesParallelToTwoAxes)
{
  const Frame yz{ { Point{ 0, 1, 0 }, Point{ 0, 0, 1 }, Point{ 1, 0, 0 } }, { 0, 0, 0 } };
  const Frame zx{ { Point{ 0, 0, 1 }, Point{ 1, 0, 0 }, Point{ 0, 1, 0 } }, { 0, 0, 0 } };
  const Frame shifted{ { Point{ 0, 1, 0 }, Point{ 0, 0, 1 }, Point{ 1, 0, 0 } }, { 2.5, 0, 0 } };
  // Exchanged axes: the same plane and normal, with a mirrored mesh.
  const Frame yx{ { Point{ 0, 1, 0 }, Point{ 1, 0, 0 }, Point{ 0, 0, 1 } }, { 0, 0, 0 } };
  for (const Frame& from : { PlaneXY, yz, zx, shifted, yx })
  {
    for (const Frame& to : { PlaneXY, yz, zx, shifted, yx })
    {
      ExpectSameInFrames(from, to, 1e-14);
    }
  }
}

TEST(PointLocation, AnyPlane)
{
  std::mt19937_64 generator(41);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 30; ++n)
  {
    std::array<Frame, 2> frames;
    for (Frame& frame : frames)
    {
      // Gram-Schmidt. The normal points along the axis closest to it, as for heights.
      Point a{ normal(generator), normal(generator), normal(generator) };
      Point b{ normal(generator), normal(generator), normal(generator) };
      const auto normalize = [](Point& p) {
        const double length = std::hypot(p[0], p[1], p[2]);
        p = { p[0] / length, p[1] / length, p[2] / length };
      };
      normalize(a);
      const double along = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      b = { b[0] - along * a[0], b[1] - along * a[1], b[2] - along * a[2] };
      normalize(b);
      Point c{ a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
      const Point size{ std::abs(c[0]), std::abs(c[1]), std::abs(c[2]) };
      const auto main = std::max_element(size.begin(), size.end()) - size.begin();
      if (c[main] < 0.0)
      {
        c = { -c[0], -c[1], -c[2] };
      }
      frame = { { a, b, c }, { normal(generator), normal(generator), normal(generator) } };
    }
    ExpectSameInFrames(frames[0], frames[1], 1e-13);
    ExpectSameInFrames(frames[0], PlaneXY, 1e-13);
    ExpectSameInFrames(PlaneXY, frames[1], 1e-13);
  }
}

TEST(PointLocation, NormalsOfAPlaneAndASurfaceFollowTheWinding)
{
  // If one of the two meshes is a surface, the normal of a flat mesh follows from its triangles,
  // too.
  const MeshPair pair = MakePlanarPair(4, 43);
  for (int normalAxis = 0; normalAxis < 3; ++normalAxis)
  {
    for (const bool reversed : { false, true })
    {
      std::vector<Triangle> triangles = GridTriangles(4);
      for (Triangle& t : triangles)
      {
        std::swap(t[1], t[reversed ? 2 : 1]);
      }
      std::vector<Point> flat = PointsOf(pair.Source);
      std::vector<Point> bent = PointsOf(pair.Target);
      for (std::size_t i = 0; i < flat.size(); ++i)
      {
        Point p{};
        p[(normalAxis + 1) % 3] = flat[i][0];
        p[(normalAxis + 2) % 3] = flat[i][1];
        flat[i] = p;
        bent[i][2] = 0.3 * std::sin(bent[i][0]);
      }
      const auto map = Make(MakeMesh(flat, triangles), MakeMesh(bent, triangles));
      const double sign = reversed ? -1.0 : 1.0;
      for (const Triangle& t : triangles)
      {
        const Point point = CentroidOf(MakeMesh(flat, {}), t);
        const Jacobian jacobian = map->GetJacobian(Domain::Source, Locate(*map, point));
        // The image of the upper normal of the flat mesh. The grid is counterclockwise seen from
        // above.
        Point image;
        for (int row = 0; row < 3; ++row)
        {
          image[row] = jacobian.Matrix[3 * row + normalAxis];
        }
        const RealPoint normal = Cross(
          Minus(Widen(bent[t[1]]), Widen(bent[t[0]])), Minus(Widen(bent[t[2]]), Widen(bent[t[0]])));
        EXPECT_NEAR(sign * static_cast<double>(std::sqrt(Dot(normal, normal))),
          static_cast<double>(Dot(normal, Widen(image))), 1e-14);
      }
    }
  }
}

TEST(PointLocation, CornersOfATiltedPlaneAreFoundExactly)
{
  const Frame tilted{ { Point{ 0.6, 0.0, 0.8 }, Point{ 0.0, 1.0, 0.0 }, Point{ -0.8, 0.0, 0.6 } },
    { 0.1, 0.2, 0.3 } };
  const MeshPair pair = MakePlanarPair(8, 42);
  const auto mesh = MovedInto(tilted, pair.Source);
  const auto map = Make(mesh, nullptr);
  for (const Point& p : PointsOf(mesh))
  {
    EXPECT_GE(Locate(*map, p).Corner, 0);
  }
}

} // namespace
