// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The sweep over the boundary decides whether triangles overlap. Its results are compared with
// tests of all pairs of triangles of many small meshes, in integers. Overlaps within the rounding
// of the coordinates are ignored.

#include "Fixtures/Triangulations.h"

#include "Mesh/MeshGeometry.h"
#include "Mesh/MeshValidation.h"
#include "Mesh/PointLocation.h"
#include "Mesh/Triangulation.h"

#include <gtest/gtest.h>

namespace
{

using namespace homeomorphism;
using namespace fixtures;

/// Whether the interiors of two triangles meet: their projections on the normal of each edge then
/// have a common interval (separating axis theorem).
bool InteriorsMeet(const IntegerMesh& mesh, const Triangle& first, const Triangle& second)
{
  for (const auto* edges : { &first, &second })
  {
    for (int k = 0; k < 3; ++k)
    {
      const IntegerPoint& start = mesh.Points[(*edges)[k]];
      const IntegerPoint& end = mesh.Points[(*edges)[(k + 1) % 3]];
      const auto project = [&](const Triangle& t) {
        return std::minmax({ Turn(start, end, mesh.Points[t[0]]),
          Turn(start, end, mesh.Points[t[1]]), Turn(start, end, mesh.Points[t[2]]) });
      };
      const auto a = project(first);
      const auto b = project(second);
      if (std::max(a.first, b.first) >= std::min(a.second, b.second))
      {
        return false;
      }
    }
  }
  return true;
}

TriangleList FindOverlappingExactly(const IntegerMesh& mesh, const std::vector<bool>& masked)
{
  TriangleList list;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    bool overlaps = false;
    for (std::size_t u = 0; u < mesh.Triangles.size() && !overlaps; ++u)
    {
      overlaps = t != u && !masked[t] && !masked[u] &&
        InteriorsMeet(mesh, mesh.Triangles[t], mesh.Triangles[u]);
    }
    if (overlaps)
    {
      list.push_back(static_cast<TriangleIndex>(t));
    }
  }
  return list;
}

/// The overlaps of a mesh, whose masked triangles do not count. Their depth is in its coordinates.
Overlaps FindOverlaps(vtkPolyData* mesh, const std::vector<bool>& masked = {})
{
  const Triangulation triangulation = TriangulationOf(mesh, masked);
  const MeshGeometry geometry(mesh->GetPoints(), triangulation);
  Overlaps overlaps =
    FindOverlapping(triangulation, geometry, PointLocation(triangulation, geometry));
  overlaps.Depth /= geometry.GetScale();
  return overlaps;
}

/// Adds another mesh.
void Add(IntegerMesh& mesh, const IntegerMesh& other)
{
  const auto first = static_cast<vtkIdType>(mesh.Points.size());
  mesh.Points.insert(mesh.Points.end(), other.Points.begin(), other.Points.end());
  for (const Triangle& t : other.Triangles)
  {
    mesh.Triangles.push_back({ t[0] + first, t[1] + first, t[2] + first });
  }
}

/// Duplicates points of some corners: slits, and pieces that touch along edges without sharing
/// points.
void Slit(Random& random, IntegerMesh& mesh, double probability)
{
  for (Triangle& t : mesh.Triangles)
  {
    for (vtkIdType& corner : t)
    {
      if (random.Chance(probability))
      {
        mesh.Points.push_back(IntegerPoint(mesh.Points[corner]));
        corner = static_cast<vtkIdType>(mesh.Points.size()) - 1;
      }
    }
  }
}

/// Moves some points, so that there may be folds.
void Disturb(Random& random, IntegerMesh& mesh, int count, int by)
{
  for (int n = 0; n < count; ++n)
  {
    IntegerPoint& p = mesh.Points[random.Below(mesh.Points.size())];
    p = { p.X + random.Integer(-by, by), p.Y + random.Integer(-by, by) };
  }
}

IntegerMesh MakeGridWithHolesAndSlits(Random& random)
{
  IntegerMesh mesh(random, random.Integer(1, 5), 10, 2);
  mesh.Pierce(random, random.Chance(0.7) ? 0.25 : 0.0);
  Slit(random, mesh, random.Chance(0.5) ? 0.15 : 0.0);
  Disturb(random, mesh, random.Integer(0, 1), 12);
  return mesh;
}

IntegerMesh MakeFoldedGrid(Random& random)
{
  IntegerMesh mesh(random, random.Integer(2, 5), 10, 5);
  Disturb(random, mesh, random.Integer(0, 4), 20);
  mesh.Pierce(random, random.Chance(0.5) ? 0.4 : 0.0);
  return mesh;
}

/// A small grid in the hole of a larger one, fitting exactly, with a gap, or overlapping; or
/// covered completely where there is no hole.
IntegerMesh MakeNestedPieces(Random& random)
{
  IntegerMesh mesh(random, 5, 10, 0);
  if (random.Chance(0.8))
  {
    mesh.Remove([&mesh](const Triangle& t) {
      const IntegerPoint& a = mesh.Points[t[0]];
      return a.X >= 10 && a.X < 40 && a.Y >= 10 && a.Y < 40;
    });
  }
  const int squares = random.Integer(1, 3);
  const int slack = random.Chance(0.4) ? 1 : 0;
  const auto at = [&]() { return 10 + random.Integer(-slack, 30 - 10 * squares + slack); };
  const int x = at();
  Add(mesh, IntegerMesh(random, squares, 10, 2, { x, at() }));
  return mesh;
}

/// Around a point, closed or not.
IntegerMesh MakeFanThatGoesRoundMoreThanOnce(Random& random)
{
  const int turns = random.Integer(1, 3);
  const int count = random.Integer(5 * turns, 9 * turns);
  const bool closed = random.Chance(0.5);
  const double start = random.Uniform(0.0, 6.2);
  IntegerMesh mesh;
  mesh.Points.push_back({ random.Integer(-2, 2), random.Integer(-2, 2) });
  for (int i = 0; i <= count; ++i)
  {
    const double angle = start + 6.283185307179586 * turns * i / count;
    const int radius = random.Integer(30, 60);
    mesh.Points.push_back(
      { std::lround(radius * std::cos(angle)), std::lround(radius * std::sin(angle)) });
  }
  for (int i = 0; i < count; ++i)
  {
    mesh.Triangles.push_back({ 0, i + 1, closed ? (i + 1) % count + 1 : i + 2 });
  }
  mesh.Pierce(random, random.Chance(0.3) ? 0.5 : 0.0);
  return mesh;
}

/// Up to seven, also edges with many triangles, which count as boundary. Few points on a coarse
/// grid, so that corners touch edges and triangles coincide.
IntegerMesh MakeAnyTriangles(Random& random)
{
  IntegerMesh mesh;
  const int size = random.Integer(2, 6);
  for (int i = random.Integer(3, 9); i > 0; --i)
  {
    mesh.Points.push_back({ random.Integer(0, size), random.Integer(0, size) });
  }
  const auto corner = [&]() { return static_cast<vtkIdType>(random.Below(mesh.Points.size())); };
  for (int t = random.Integer(0, 7); t > 0; --t)
  {
    mesh.Triangles.push_back({ corner(), corner(), corner() });
  }
  return mesh;
}

TEST(Overlaps, AgreeWithExactArithmetic)
{
  /// A kind of mesh, and the least shares of such meshes without and with overlaps.
  struct Family
  {
    const char* Name;
    IntegerMesh (*Make)(Random&);
    double LeastFree;
    double LeastOverlapping;
  };
  for (const Family& family :
    { Family{ "grids with holes and slits", MakeGridWithHolesAndSlits, 0.3, 0.1 },
      { "folded grids", MakeFoldedGrid, 0.1, 0.3 }, { "nested pieces", MakeNestedPieces, 0.3, 0.2 },
      { "fans", MakeFanThatGoesRoundMoreThanOnce, 0.2, 0.3 },
      { "any triangles", MakeAnyTriangles, 0.1, 0.25 } })
  {
    SCOPED_TRACE(family.Name);
    constexpr int count = 3000;
    Random random(1);
    int free = 0;
    for (int n = 0; n < count; ++n)
    {
      IntegerMesh mesh = family.Make(random);
      mesh.Remove([&mesh](const Triangle& t) {
        return Turn(mesh.Points[t[0]], mesh.Points[t[1]], mesh.Points[t[2]]) == 0;
      });
      mesh.Shuffle(random);
      std::vector<bool> masked;
      for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
      {
        masked.push_back(n % 4 == 0 && random.Chance(0.2));
      }
      const TriangleList exact = FindOverlappingExactly(mesh, masked);
      ASSERT_EQ(FindOverlaps(mesh.ToMesh(1.0, n % 3), masked).Triangles, exact) << n;
      free += exact.empty();
    }
    EXPECT_GE(free, family.LeastFree * count);
    EXPECT_GE(count - free, family.LeastOverlapping * count);
  }
}

/// A triangle, and one that pierces its edge x = 1 with a corner at @a x, of the size @a size.
Overlaps FindOverlapOfPair(double x, double size, double origin)
{
  std::vector<Point> points;
  for (const Vector2& p :
    { Vector2{ 0, 0 }, { 1, 0 }, { 1, 1 }, { x, 0.5 }, { 2, 0.25 }, { 2, 0.75 } })
  {
    points.push_back({ p.x * size + origin, p.y * size + origin, 0.0 });
  }
  return FindOverlaps(MakeMesh(points, { { 0, 1, 2 }, { 3, 4, 5 } }));
}

TEST(Overlaps, RoundingDoesNotCount)
{
  const Overlaps none = FindOverlapOfPair(1.0, 1.0, 0.0);
  EXPECT_TRUE(none.Triangles.empty() && none.WithinRounding.empty());
  // However large the pair.
  for (const auto& [size, origin] : { std::pair{ 1.0, 0.0 }, { 1.0, 1e4 }, { 1e-200, 0.0 },
         { 1e-9, 0.0 }, { 1e9, 0.0 }, { 1e200, 0.0 } })
  {
    // The largest coordinate is 2, and origin + 2.
    const double rounding = Ulp * (2.0 + origin / size);
    const Overlaps small = FindOverlapOfPair(1.0 - rounding, size, origin);
    EXPECT_TRUE(small.Triangles.empty());
    EXPECT_EQ((TriangleList{ 0, 1 }), small.WithinRounding);
    for (const double depth : { 32.0 * rounding, 0.125 })
    {
      const Overlaps real = FindOverlapOfPair(1.0 - depth, size, origin);
      EXPECT_EQ((TriangleList{ 0, 1 }), real.Triangles);
      EXPECT_TRUE(real.WithinRounding.empty());
      // A triangle's overlap ends when it has moved by so much.
      EXPECT_NEAR(depth, real.Depth / size, 2.0 * rounding);
    }
  }
}

TEST(Overlaps, TrianglesThinnerThanTheRoundingOverlap)
{
  // A sliver that lies within a triangle, all of it within rounding of the triangle's edge.
  const auto mesh = MakeMesh(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.25, 0, 0 }, { 0.5, 0, 0 }, { 0.375, 1e-16, 0 } },
    { { 0, 1, 2 }, { 3, 4, 5 } });
  EXPECT_EQ((TriangleList{ 0, 1 }), FindOverlaps(mesh).Triangles);
}

TEST(Overlaps, RoundedPointsOfAnEdgeAreAccepted)
{
  // Two triangles along the side of a third, their common corner a rounded point of that side.
  Random random(5);
  int rounded = 0;
  for (int k = 0; k < 1000; ++k)
  {
    const Point a{ random.Uniform(), random.Uniform(), 0.0 };
    const Point d{ random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0), 0.0 };
    const Point across{ -d[1], d[0], 0.0 };
    const Point middle = a + 0.5 * d;
    const Overlaps overlaps = FindOverlaps(
      MakeMesh({ a, a + d, middle + across, a + random.Uniform() * d, middle - across },
        { { 0, 1, 2 }, { 0, 3, 4 }, { 3, 1, 4 } }));
    EXPECT_TRUE(overlaps.Triangles.empty()) << "depth " << overlaps.Depth;
    rounded += overlaps.WithinRounding.empty() ? 0 : 1;
  }
  EXPECT_GT(rounded, 200);
}

} // namespace
