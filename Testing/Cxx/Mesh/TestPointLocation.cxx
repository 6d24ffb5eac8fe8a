// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Exactly the points of the closed domain are found, and the result depends only on the point: not
// on the hint, the order, or the size of the coordinates.

#include "Fixtures/Defects.h"
#include "Fixtures/Triangulations.h"

namespace
{

using namespace fixtures;
using homeomorphism::Domain;
using homeomorphism::Homeomorphism;
using homeomorphism::MeshGeometry;
using homeomorphism::SurfacePoint;
using homeomorphism::TriangleIndex;

std::shared_ptr<const Homeomorphism> Make(const MeshPair& pair)
{
  homeomorphism::HomeomorphismOptions options;
  options.System = homeomorphism::CoordinateSystem::Linear;
  const Reading reading = Read(pair, options);
  ExpectAccepted(reading);
  return reading.Map;
}

SurfacePoint Locate(
  const Homeomorphism& map, const Point& point, TriangleIndex hint = -1, double tolerance = 0.0)
{
  return map.Locate(Domain::Source, point.data(),
    map.GetAbsoluteTolerance(Domain::Source, tolerance, 0.5 * Ulp), hint);
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

// --- In the plane, compared with exact arithmetic ------------------------------------------------

/// The triangle with the lowest number that contains the point, including its boundary, and its
/// corner that is the point; -1 if there is none.
std::pair<TriangleIndex, int> Find(const IntegerMesh& mesh, const IntegerPoint& p)
{
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    std::array<std::int64_t, 3> turns;
    int cornerAt = -1;
    for (int k = 0; k < 3; ++k)
    {
      const IntegerPoint& corner = mesh.Points[mesh.Triangles[t][k]];
      turns[k] = Turn(corner, mesh.Points[mesh.Triangles[t][(k + 1) % 3]], p);
      cornerAt = corner.X == p.X && corner.Y == p.Y ? k : cornerAt;
    }
    const auto [least, greatest] = std::minmax_element(turns.begin(), turns.end());
    if (*least >= 0 || *greatest <= 0)
    {
      return { static_cast<TriangleIndex>(t), cornerAt };
    }
  }
  return { -1, -1 };
}

/// Vertices, points on edges, points of a line beyond an edge, and points anywhere.
std::vector<IntegerPoint> Queries(const IntegerMesh& mesh, int anywhere, Random& random)
{
  std::vector<IntegerPoint> queries = mesh.Points;
  int size = 0;
  for (const IntegerPoint& p : mesh.Points)
  {
    size = std::max({ size, static_cast<int>(p.X), static_cast<int>(p.Y) });
  }
  for (const Triangle& t : mesh.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const IntegerPoint& a = mesh.Points[t[k]];
      const IntegerPoint& b = mesh.Points[t[(k + 1) % 3]];
      for (const std::int64_t quarter : { -1, 1, 2, 3, 5 })
      {
        // Points of the grid, because all coordinates are multiples of four.
        queries.push_back({ a.X + (b.X - a.X) / 4 * quarter, a.Y + (b.Y - a.Y) / 4 * quarter });
      }
    }
  }
  for (int n = 0; n < anywhere; ++n)
  {
    queries.push_back(
      { random.Integer(-size / 8, size + size / 8), random.Integer(-size / 8, size + size / 8) });
  }
  return queries;
}

/// A mesh whose coordinates are multiples of four, with holes and concave boundary.
IntegerMesh FourfoldMesh(Random& random, int squares, double holes)
{
  IntegerMesh mesh(random, squares, 16, 4);
  mesh.Pierce(random, holes);
  mesh.Shuffle(random);
  for (IntegerPoint& p : mesh.Points)
  {
    p = { 4 * p.X, 4 * p.Y };
  }
  return mesh;
}

TEST(PointLocation, AgreesWithExactArithmeticForEveryHint)
{
  int found = 0;
  int outside = 0;
  Random random(1);
  for (int n = 0; n < 120; ++n)
  {
    const IntegerMesh grid = FourfoldMesh(random, 1 + n % 5, n % 3 == 0 ? 0.0 : 0.3);
    // Multiples of the least positive number, too, which are exact.
    const double unit =
      n % 10 == 9 ? std::numeric_limits<double>::denorm_min() : std::ldexp(1.0, n % 7 - 3);
    const auto mesh = grid.ToMesh(unit, n % 3);
    const auto map = Make({ mesh, mesh });
    for (const IntegerPoint& query : Queries(grid, 200, random))
    {
      const auto [triangle, corner] = Find(grid, query);
      const Point point = IntegerMesh::InSpace(query, unit, n % 3);
      const SurfacePoint location = Locate(*map, point);
      ASSERT_EQ(triangle, location.Triangle) << n << ": " << query.X << " " << query.Y;
      ASSERT_EQ(corner, location.Corner);
      ++(triangle >= 0 ? found : outside);
      for (std::size_t hint = 0; hint < grid.Triangles.size(); ++hint)
      {
        ExpectSameLocation(location, Locate(*map, point, static_cast<TriangleIndex>(hint)));
      }
      if (triangle >= 0)
      {
        ASSERT_LE(Distance(point, PositionOf(*map, location)), 2e-13 * unit);
      }
    }
  }
  EXPECT_GT(found, 10000);
  EXPECT_GT(outside, 5000);
}

/// Triangles around a point, or between two points far away and those of a line, in random order.
IntegerMesh ThinMesh(Random& random, int count, bool isFan)
{
  IntegerMesh mesh;
  for (vtkIdType i = 0; i <= count; ++i)
  {
    mesh.Points.push_back({ 4 * i, 0 });
    mesh.Points.push_back({ isFan ? 2 * count : 4 * i + 4, 4 * std::int64_t(count) });
    const vtkIdType own = 2 * i;
    if (i > 0)
    {
      mesh.Triangles.push_back({ own - 2, own, isFan ? 1 : own - 1 });
    }
    if (i > 0 && !isFan)
    {
      mesh.Triangles.push_back({ own, own + 1, own - 1 });
    }
  }
  mesh.Shuffle(random);
  return mesh;
}

TEST(PointLocation, FansAndSliversAgreeWithExactArithmetic)
{
  Random random(41);
  for (const bool isFan : { true, false })
  {
    const IntegerMesh grid = ThinMesh(random, 1000, isFan);
    const auto map = Make({ grid.ToMesh(0.25), nullptr });
    int found = 0;
    for (const IntegerPoint& query : Queries(grid, 1000, random))
    {
      const TriangleIndex expected = Find(grid, query).first;
      ASSERT_EQ(expected, Locate(*map, IntegerMesh::InSpace(query, 0.25, 2)).Triangle)
        << isFan << ": " << query.X << " " << query.Y;
      found += expected >= 0;
    }
    EXPECT_GT(found, 1000);
  }
}

// --- The boundary of the domain ------------------------------------------------------------------

TEST(PointLocation, PointsOutsideByRoundingAreFound)
{
  // The largest coordinate is 8, with an ulp of 1.8e-15.
  const auto mesh = RegularGrid(8);
  const auto map = Make({ mesh, mesh });
  const double ulp = 8.0 * Ulp;
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
          EXPECT_LE(Distance(image, at(0.0)), 2.0 * ulp);
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
  const auto mesh = RegularGrid(8);
  for (const int type : { VTK_FLOAT, VTK_DOUBLE })
  {
    const auto filter = MakeFilter(
      Smooth, { mesh, mesh }, MakeCloud({ { -1e-6, 3.3, 0.0 }, { -1e-5, 3.3, 0.0 } }, type));
    filter->Update();
    EXPECT_EQ(type == VTK_FLOAT ? 1 : 2, filter->GetNumberOfOutsidePoints());
  }
}

TEST(PointLocation, NonFiniteAndHugeCoordinatesAreOutsideForEveryHint)
{
  const MeshPair planes = MakePlanarPair(4, 6);
  for (const MeshPair& pair : { planes, MeshPair{ MakeSheet(4, 6, 0.3), MakeSheet(4, 7, 0.3) },
         MeshPair{ Tilted(planes.Source, Tilt(), {}), planes.Target } })
  {
    const auto map = Make(pair);
    const Point sound = PointOf(pair.Source, 6);
    ASSERT_GE(Locate(*map, sound).Triangle, 0);
    for (const double bad : { NotANumber, Infinity, -Infinity })
    {
      for (const Point& p : { Point{ bad, sound[1], sound[2] }, { sound[0], bad, sound[2] },
             { sound[0], sound[1], bad }, { bad, bad, bad } })
      {
        for (const double tolerance : { 0.0, 0.1, 1e300 })
        {
          EXPECT_EQ(-1, Locate(*map, p, -1, tolerance).Triangle);
          EXPECT_EQ(-1, Locate(*map, p, 9, tolerance).Triangle);
        }
      }
    }
  }
  // Products of such coordinates overflow.
  for (const double unit : { 1.0, 1e-300, 1e300 })
  {
    const auto map = Make({ Resized(MakePlanarPair(3, 8).Source, unit), nullptr });
    for (const double huge : { 1e154, 1e160, 1e200, 1e307, 1.7e308 })
    {
      for (const Point& p :
        { Point{ huge, huge, 0 }, { -huge, huge, 0 }, { huge, 0, 0 }, { 0, -huge, 0 },
          { huge, 0.5 * huge, 0 }, { unit, huge, 0 }, { -huge, 0.3 * unit, 0 } })
      {
        for (TriangleIndex hint = -1; hint < 18 && huge >= 1e3 * unit; ++hint)
        {
          ASSERT_EQ(-1, Locate(*map, p, hint).Triangle) << unit << " " << p[0] << " " << p[1];
        }
      }
    }
  }
}

// --- Tolerance and nearest point, compared with all triangles ------------------------------------

double DistanceToSegment(const Point& p, const Point& a, const Point& b)
{
  const double t = std::clamp(Dot(p - a, b - a) / Dot(b - a, b - a), 0.0, 1.0);
  return Distance(p, a + t * (b - a));
}

double DistanceToTriangle(const Point& p, const std::array<Point, 3>& corners)
{
  const Point u = corners[1] - corners[0];
  const Point v = corners[2] - corners[0];
  const Point d = p - corners[0];
  // Weights of the foot in the plane of the triangle, as ratios of areas, which are accurate for
  // needles too.
  const Point normal = Cross(u, v);
  const double s = Dot(normal, Cross(d, v)) / Dot(normal, normal);
  const double t = Dot(normal, Cross(u, d)) / Dot(normal, normal);
  if (s >= 0.0 && t >= 0.0 && s + t <= 1.0)
  {
    return std::abs(Dot(d, Unit(normal)));
  }
  return std::min({ DistanceToSegment(p, corners[0], corners[1]),
    DistanceToSegment(p, corners[1], corners[2]), DistanceToSegment(p, corners[2], corners[0]) });
}

/// Queries near and far from a mesh. A point is found if and only if some triangle is within the
/// tolerance; the surface point is on the nearest triangle, at the correct distance.
void ExpectNearest(vtkPolyData* mesh, double tolerance, double spread, int queries,
  std::uint64_t seed, int leastFound, int leastOutside)
{
  const auto map = Make({ mesh, nullptr });
  const MeshGeometry& geometry = map->GetPair().GetGeometry(Domain::Source);
  const TriangleIndex count = static_cast<TriangleIndex>(mesh->GetNumberOfCells());
  const double allowed = tolerance * geometry.GetDiagonal() / geometry.GetScale();
  Random random(seed);
  int found = 0;
  int outside = 0;
  const double rounding = 1e-14 * geometry.GetLargestCoordinate() / geometry.GetScale();
  TriangleIndex hint = -1;
  for (int n = 0; n < queries; ++n)
  {
    Point query = PointOf(mesh, random.Below(mesh->GetNumberOfPoints()));
    for (int axis = 0; axis < (geometry.IsPlanar() ? 2 : 3); ++axis)
    {
      query[axis] += random.Uniform(-1.7 * spread, 1.7 * spread);
    }
    std::vector<double> distances;
    for (TriangleIndex t = 0; t < count; ++t)
    {
      distances.push_back(DistanceToTriangle(query, CornersOf(mesh, t)));
    }
    const double least = *std::min_element(distances.begin(), distances.end());
    if (std::abs(least - allowed) < 1e-12 * allowed)
    {
      continue;
    }
    const SurfacePoint location = Locate(*map, query, hint, tolerance);
    ExpectSameLocation(location, Locate(*map, query, -1, tolerance));
    ASSERT_EQ(least <= allowed, location.Triangle >= 0) << least;
    hint = location.Triangle;
    if (location.Triangle < 0)
    {
      ++outside;
      continue;
    }
    ++found;
    ASSERT_LT(distances[location.Triangle] - least, rounding);
    // The surface point without its offset lies on the triangle, at that distance.
    SurfacePoint foot = location;
    foot.Point.Offset = 0.0;
    const Point surfacePoint = PositionOf(*map, foot);
    ASSERT_LT(DistanceToTriangle(surfacePoint, CornersOf(mesh, location.Triangle)), rounding);
    ASSERT_LT(std::abs(Distance(surfacePoint, query) - least), rounding);
  }
  EXPECT_GE(found, leastFound);
  EXPECT_GE(outside, leastOutside);
}

TEST(PointLocation, ToleranceFindsTheNearestPoint)
{
  Random random(10);
  IntegerMesh grid(random, 8, 16, 4);
  grid.Pierce(random, 0.3);
  ExpectNearest(grid.ToMesh(1.0 / 16.0), 0.01, 0.8, 3000, 10, 1500, 200);
  ExpectNearest(grid.ToMesh(1.0 / 16.0), 0.001, 0.8, 3000, 11, 1000, 300);
  const auto needles = Moved(MakePlanarPair(8, 13, 0.2).Source, [](const Point& p) -> Point {
    return { p[0], 1e-4 * p[1], 0.0 };
  });
  ExpectNearest(needles, 0.01, 0.2, 2000, 13, 400, 200);
  ExpectNearest(MakeSheet(8, 14, 0.5), 0.01, 0.2, 2000, 14, 500, 500);
  ExpectNearest(MakeClosedPair(3, 15).Target, 0.02, 0.1, 2000, 15, 500, 500);
  // A tolerance so large that every point is inside.
  ExpectNearest(grid.ToMesh(1.0 / 16.0), 1e3, 50.0, 1000, 12, 990, 0);
  ExpectNearest(MakeClosedPair(2, 16).Source, 1e3, 3.0, 1000, 16, 990, 0);
  for (const auto& mesh : { MakePlanarPair(4, 17).Source, MakeSheet(4, 17, 0.3) })
  {
    const auto map = Make({ mesh, nullptr });
    for (const double far : { 10.0, 1e10, 1e150 })
    {
      EXPECT_GE(Locate(*map, { far, -far, 0.0 }, -1, VTK_DOUBLE_MAX).Triangle, 0) << far;
    }
  }
}

// --- Surfaces ------------------------------------------------------------------------------------

TEST(PointLocation, PointsOfSurfaces)
{
  for (const auto& mesh : { MakeSheet(10, 20, 0.5), MakeClosedPair(3, 22).Source })
  {
    const auto map = Make({ mesh, nullptr });
    const MeshGeometry& geometry = map->GetPair().GetGeometry(Domain::Source);
    const double largest = LargestCoordinate(mesh);
    const std::vector<Triangle> triangles = TrianglesOf(mesh);
    for (TriangleIndex t = 0; t < static_cast<TriangleIndex>(triangles.size()); ++t)
    {
      const std::array<Point, 3> c = CornersOf(mesh, t);
      const Point normal = Unit(NormalOf(mesh, t));
      for (const Point& w : { Point{ 0.3, 0.3, 0.4 }, { 0.9, 0.06, 0.04 }, { 0.002, 0.498, 0.5 },
             { 1e-7, 0.7, 0.3 - 1e-7 } })
      {
        const Point p = PointIn(mesh, triangles[t], w);
        const SurfacePoint location = Locate(*map, p);
        ASSERT_EQ(t, location.Triangle);
        ExpectSameLocation(location, Locate(*map, p, 0));
        ExpectSameLocation(location, Locate(*map, p, t));
        const auto found = geometry.GetShape(t).ToBarycentric(location.Point.InPlane);
        ASSERT_LT(Distance(Point{ found[0], found[1], found[2] }, w), 1e-13);
        // Points off the surface by more than rounding are outside.
        for (const double distance : { -1e-6, -1e-12, -4e-15, 4e-15, 1e-12, 1e-6 })
        {
          const Point off = p + distance * largest * normal;
          ASSERT_EQ(-1, Locate(*map, off).Triangle) << distance;
          if (std::abs(distance) < 1e-10)
          {
            ASSERT_EQ(t, Locate(*map, off, -1, 1e-10).Triangle);
          }
        }
      }
      for (int k = 0; k < 3; ++k)
      {
        // On an edge, one of its two triangles.
        const Point p = 0.6 * c[(k + 1) % 3] + 0.4 * c[(k + 2) % 3];
        const TriangleIndex found = Locate(*map, p).Triangle;
        EXPECT_TRUE(
          found == t || found == map->GetPair().GetTriangulation().GetTwin(t, k).Triangle);
      }
    }
  }
}

TEST(PointLocation, EquallyNearTrianglesOfSurfacesForEveryHint)
{
  // Roofs, whose ridges have coordinates of few digits. Points beside a ridge have the same
  // distance from the triangles of both sides.
  Random random(30);
  for (int n = 0; n < 50; ++n)
  {
    const double height = random.Integer(1, 8);
    const auto roof = MakeMesh(
      { { -4, 0, 0 }, { -4, 8, 0 }, { 0, 0, height }, { 0, 8, height }, { 4, 0, 0 }, { 4, 8, 0 } },
      { { 4, 5, 3 }, { 4, 3, 2 }, { 2, 3, 1 }, { 2, 1, 0 } });
    const auto map = Make({ roof, nullptr });
    for (int i = 0; i < 200; ++i)
    {
      const double up = random.Uniform(0.0, 0.1);
      const Point p{ i % 2 ? 0.0 : random.Uniform(-0.2, 0.2) * up, random.Uniform(0.0, 8.0),
        height + up };
      const SurfacePoint location = Locate(*map, p, -1, 0.1);
      ASSERT_GE(location.Triangle, 0);
      for (const TriangleIndex hint : { 0, 1, 2, 3 })
      {
        ExpectSameLocation(location, Locate(*map, p, hint, 0.1));
      }
    }
  }
}

} // namespace
