// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Mapping points in blocks gives the same results, bit for bit, as mapping each point alone, for
// any order of the points.

#include "Fixtures/Defects.h"

namespace
{

using namespace homeomorphism;
using namespace fixtures;

std::shared_ptr<const Homeomorphism> Make(
  const MeshPair& pair, homeomorphism::CoordinateSystem system)
{
  HomeomorphismOptions options;
  options.System = system;
  options.DiscordantByLinear = true;
  return Read(pair, options).Map;
}

/// Equal to the last bit, including the sign of zero and NaN.
bool IsSame(const double* a, const double* b, int count)
{
  return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(double)) == 0;
}

/// Points of the mesh, of its edges, rounded, of its triangles, in rows and at random, outside, far
/// outside, and NaN.
std::vector<Point> Queries(vtkPolyData* mesh, std::uint64_t seed)
{
  Random random(seed);
  const std::vector<Point> corners = PointsOf(mesh);
  std::vector<Point> queries = corners;
  for (const Triangle& t : TrianglesOf(mesh))
  {
    for (int i = 0; i < 40; ++i)
    {
      // Runs of points in one triangle, at first close to each other, then the same above it.
      const double a = i % 20 < 15 ? 0.04 * (i % 20) + 0.1 : random.Uniform();
      const double b = i % 20 < 15 ? 0.2 : (1.0 - a) * random.Uniform();
      const Point height{ 0.0, 0.0, i < 20 ? 0.0 : 0.3 };
      queries.push_back(PointIn(mesh, t, { a, b, 1.0 - a - b }) + height);
    }
    const double w = random.Uniform();
    for (const Point& weights : { Point{ w, 1.0 - w, 0.0 }, { 0.0, w, 1.0 - w },
           { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 }, { w, 1.2 - w, -0.2 } })
    {
      queries.push_back(PointIn(mesh, t, weights));
    }
  }
  for (const double bad : { NotANumber, Infinity, -Infinity, 1e300, -1e160, 1e20 })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      Point p = corners[corners.size() / 2];
      p[axis] = bad;
      queries.push_back(p);
      queries.push_back(queries[queries.size() / 2]);
    }
  }
  return queries;
}

void ExpectBlocksLikePoints(
  const Homeomorphism& map, Domain domain, const std::vector<Point>& points)
{
  const double tolerance = map.GetAbsoluteTolerance(domain, 0.0, 0.5 * Ulp);
  PointBlock block;
  LocationHint hint;
  for (std::size_t first = 0; first < points.size(); first += block.Count)
  {
    // Blocks of any size.
    block.Count = static_cast<int>(
      std::min<std::size_t>(1 + (first * 7919) % PointBlock::Capacity, points.size() - first));
    std::copy_n(points[first].data(), 3 * block.Count, &block.PointBuffer[0][0]);
    const int outside = map.LocateBlock(domain, block, tolerance, hint);
    std::vector<SurfacePoint> located;
    int expectedOutside = 0;
    for (int i = 0; i < block.Count; ++i)
    {
      located.push_back(map.Locate(domain, points[first + i].data(), tolerance, -1));
      const SurfacePoint& expected = located.back();
      const SurfacePoint found = block.GetSurfacePoint(i);
      ASSERT_EQ(expected.Triangle, found.Triangle) << first + i;
      ASSERT_EQ(expected.Corner, found.Corner) << first + i;
      ASSERT_TRUE(expected.Triangle < 0 ||
        (IsSame(&expected.Point.InPlane.x, &found.Point.InPlane.x, 2) &&
          IsSame(&expected.Point.Offset, &found.Point.Offset, 1)))
        << first + i;
      expectedOutside += expected.Triangle < 0;
    }
    ASSERT_EQ(expectedOutside, outside);
    block.KeepsReferences = first % 2 == 0;
    map.MapBlock(domain, block);
    for (int i = 0; i < block.Count; ++i)
    {
      const SurfacePoint& point = located[static_cast<std::size_t>(i)];
      Point image = points[first + i];
      if (point.Triangle >= 0)
      {
        map.MapPoint(domain, point, image.data());
        const Jacobian jacobian = map.GetJacobian(domain, point);
        Point again;
        Jacobian together;
        map.MapPoint(domain, point, again.data(), together);
        ASSERT_TRUE(IsSame(image.data(), again.data(), 3)) << first + i;
        for (const Jacobian& same : { together, map.GetJacobian(domain, block, i) })
        {
          ASSERT_TRUE(IsSame(jacobian.Matrix.data(), same.Matrix.data(), 9)) << first + i;
          ASSERT_TRUE(IsSame(&jacobian.Determinant, &same.Determinant, 1));
        }
      }
      ASSERT_TRUE(IsSame(image.data(), block.Images[i], 3)) << first + i;
    }
  }
}

TEST(PointBlocks, BlocksEqualSinglePoints)
{
  using homeomorphism::CoordinateSystem;
  const auto sloping = [](const Point& p) -> Point {
    return { p[0], p[1], 0.5 * p[0] - 0.25 * p[1] };
  };
  const auto curved = [](const Point& p) -> Point { return { p[0], p[1], 0.1 * p[0] * p[1] }; };
  const MeshPair plane = MakePlanarPair(9, 21);
  const std::vector<Pairing> pairings{ { "a plane", plane },
    { "two triangles", MakePlanarPair(1, 22) },
    { "a mirrored plane", { plane.Source, fixtures::Mirrored(plane.Target) } },
    { "tilted planes", fixtures::Moved(plane, sloping) },
    { "a closed surface", MakeClosedPair(3, 24) },
    { "a surface", { plane.Source, fixtures::Moved(plane.Target, curved) } } };
  for (const auto& [name, pair] : pairings)
  {
    for (const auto system : { CoordinateSystem::Linear, CoordinateSystem::Contour,
           CoordinateSystem::Smooth, CoordinateSystem::Cubic })
    {
      SCOPED_TRACE(std::string(name) + std::to_string(static_cast<int>(system)));
      const auto map = Make(pair, system);
      // Surfaces are refused by Cubic.
      ASSERT_TRUE(map || system == CoordinateSystem::Cubic);
      for (const Domain domain : { Domain::Source, Domain::Target })
      {
        std::vector<Point> points =
          Queries(domain == Domain::Source ? pair.Source : pair.Target, 5);
        for (int order = 0; map && order < 2; ++order)
        {
          ExpectBlocksLikePoints(*map, domain, points);
          std::shuffle(points.begin(), points.end(), std::mt19937_64(6));
        }
      }
    }
  }
}

TEST(PointBlocks, PointsWithoutPreimageAreOutside)
{
  // Located where they are not: beyond the domain, in the frame of a triangle.
  const auto map = Make(MakePlanarPair(5, 27), homeomorphism::CoordinateSystem::Cubic);
  ASSERT_TRUE(map);
  const SurfacePoint far{ 3, { { 40.0, -70.0 }, 0.0 }, -1 };
  double image[3];
  EXPECT_FALSE(map->MapPoint(Domain::Target, far, image));
  PointBlock block;
  LocationHint hint;
  block.Count = 3;
  const Point inside{ 2.4, 2.6, 0.0 };
  for (int i = 0; i < 3; ++i)
  {
    std::copy_n(inside.data(), 3, block.PointBuffer[i]);
  }
  ASSERT_EQ(map->LocateBlock(Domain::Target, block, 1e-12, hint), 0);
  block.InPlane[0][1] = far.Point.InPlane.x;
  block.InPlane[1][1] = far.Point.InPlane.y;
  EXPECT_EQ(map->MapBlock(Domain::Target, block), 1);
  EXPECT_EQ(block.Triangles[1], -1);
  EXPECT_TRUE(IsSame(block.Images[1], inside.data(), 3));
  for (int i : { 0, 2 })
  {
    const SurfacePoint located = map->Locate(Domain::Target, inside.data(), 1e-12, -1);
    ASSERT_TRUE(map->MapPoint(Domain::Target, located, image));
    EXPECT_EQ(block.Triangles[i], located.Triangle);
    EXPECT_TRUE(IsSame(block.Images[i], image, 3));
  }
}

} // namespace
