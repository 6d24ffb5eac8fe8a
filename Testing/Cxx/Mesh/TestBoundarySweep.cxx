// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The sweep over the boundary finds out whether triangles overlap. Here every triangle of many
// small meshes is compared with every other, in integers. Overlaps within the rounding of the
// coordinates do not count.

#include "Fixtures/Meshes.h"

#include "Mesh/MeshGeometry.h"
#include "Mesh/MeshValidation.h"
#include "Mesh/PointLocation.h"
#include "Mesh/Triangulation.h"

#include <gtest/gtest.h>

#include <functional>

namespace
{

using namespace homeomorphism;

struct IntegerPoint
{
  int X;
  int Y;
};

/// Triangles over points of the integer grid.
struct Complex
{
  std::vector<IntegerPoint> Points;
  std::vector<Triangulation::Corners> Triangles;
  std::vector<std::uint8_t> Masked;

  void Add(
    const std::vector<IntegerPoint>& points, const std::vector<Triangulation::Corners>& triangles)
  {
    const auto first = static_cast<std::int32_t>(this->Points.size());
    this->Points.insert(this->Points.end(), points.begin(), points.end());
    for (const auto& t : triangles)
    {
      this->Triangles.push_back({ t[0] + first, t[1] + first, t[2] + first });
    }
  }
};

std::int64_t TwiceTheArea(const Complex& complex, const Triangulation::Corners& t)
{
  const IntegerPoint& a = complex.Points[t[0]];
  const IntegerPoint& b = complex.Points[t[1]];
  const IntegerPoint& c = complex.Points[t[2]];
  return std::int64_t(b.X - a.X) * (c.Y - a.Y) - std::int64_t(b.Y - a.Y) * (c.X - a.X);
}

/// Whether the interiors of two triangles meet: their projections on the normal of each edge then
/// have a common interval (separating axis theorem).
bool InteriorsMeet(
  const Complex& complex, const Triangulation::Corners& first, const Triangulation::Corners& second)
{
  for (const auto* edges : { &first, &second })
  {
    for (int k = 0; k < 3; ++k)
    {
      const IntegerPoint& start = complex.Points[(*edges)[k]];
      const IntegerPoint& end = complex.Points[(*edges)[(k + 1) % 3]];
      const auto project = [&](const Triangulation::Corners& t) {
        std::array<std::int64_t, 3> at;
        for (int i = 0; i < 3; ++i)
        {
          const IntegerPoint& p = complex.Points[t[i]];
          at[i] = std::int64_t(end.Y - start.Y) * p.X - std::int64_t(end.X - start.X) * p.Y;
        }
        return std::make_pair(
          *std::min_element(at.begin(), at.end()), *std::max_element(at.begin(), at.end()));
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

TriangleList FindOverlappingExactly(const Complex& complex)
{
  TriangleList list;
  for (std::size_t t = 0; t < complex.Triangles.size(); ++t)
  {
    for (std::size_t u = 0; u < complex.Triangles.size(); ++u)
    {
      if (t != u && !complex.Masked[t] && !complex.Masked[u] &&
        InteriorsMeet(complex, complex.Triangles[t], complex.Triangles[u]))
      {
        list.push_back(static_cast<TriangleIndex>(t));
        break;
      }
    }
  }
  return list;
}

/// The overlaps of a mesh, whose masked triangles do not count.
Overlaps FindOverlaps(vtkPoints* points, const std::vector<Triangulation::Corners>& triangles,
  const std::vector<std::uint8_t>& masked = {})
{
  Triangulation triangulation;
  triangulation.SetTriangles(triangles, 0);
  for (std::size_t t = 0; t < masked.size(); ++t)
  {
    if (masked[t])
    {
      triangulation.Mask(static_cast<TriangleIndex>(t));
    }
  }
  triangulation.FindAdjacency(points->GetNumberOfPoints());
  const MeshGeometry geometry(points, triangulation);
  Overlaps overlaps =
    FindOverlapping(triangulation, geometry, PointLocation(triangulation, geometry));
  overlaps.Depth /= geometry.GetScale();
  return overlaps;
}

/// The same result from FindOverlapping, in a plane parallel to two axes.
TriangleList FindOverlappingQuickly(const Complex& complex, int normalAxis)
{
  std::vector<fixtures::Point> points;
  for (const IntegerPoint& p : complex.Points)
  {
    fixtures::Point x;
    x[(normalAxis + 1) % 3] = p.X;
    x[(normalAxis + 2) % 3] = p.Y;
    x[normalAxis] = 7.0;
    points.push_back(x);
  }
  return FindOverlaps(fixtures::MakeCloud(points)->GetPoints(), complex.Triangles, complex.Masked)
    .Triangles;
}

class RandomComplexes
{
public:
  explicit RandomComplexes(std::uint64_t seed)
    : Generator(seed)
  {
  }

  int Uniform(int least, int greatest)
  {
    return std::uniform_int_distribution<int>(least, greatest)(this->Generator);
  }
  bool Chance(double probability)
  {
    return std::uniform_real_distribution<double>(0.0, 1.0)(this->Generator) < probability;
  }

  /// A grid of squares of the given size, with interior points moved by up to jitter.
  Complex Grid(int squares, int size, int jitter, int atX, int atY)
  {
    Complex grid;
    for (int j = 0; j <= squares; ++j)
    {
      for (int i = 0; i <= squares; ++i)
      {
        const bool inside = i > 0 && j > 0 && i < squares && j < squares;
        const int by = inside ? jitter : 0;
        grid.Points.push_back(
          { atX + i * size + this->Uniform(-by, by), atY + j * size + this->Uniform(-by, by) });
      }
    }
    for (const auto& t : fixtures::GridTriangles(squares))
    {
      grid.Triangles.push_back({ static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
        static_cast<std::int32_t>(t[2]) });
    }
    return grid;
  }

  /// Removes triangles: holes, islands, and vertices at which only corners meet.
  void Pierce(Complex& complex, double probability)
  {
    std::vector<Triangulation::Corners> rest;
    for (const auto& t : complex.Triangles)
    {
      if (!this->Chance(probability))
      {
        rest.push_back(t);
      }
    }
    complex.Triangles = rest;
  }

  /// Duplicates points of some corners: slits, and pieces that touch along edges without sharing
  /// points.
  void Slit(Complex& complex, double probability)
  {
    for (auto& t : complex.Triangles)
    {
      for (std::int32_t& corner : t)
      {
        if (this->Chance(probability))
        {
          complex.Points.push_back(complex.Points[corner]);
          corner = static_cast<std::int32_t>(complex.Points.size()) - 1;
        }
      }
    }
  }

  /// Moves some points, so that there may be folds.
  void Disturb(Complex& complex, int count, int by)
  {
    for (int n = 0; n < count; ++n)
    {
      IntegerPoint& p =
        complex.Points[this->Uniform(0, static_cast<int>(complex.Points.size()) - 1)];
      p.X += this->Uniform(-by, by);
      p.Y += this->Uniform(-by, by);
    }
  }

  /// A fan around a point with some number of turns, closed or not.
  Complex Fan(int triangles, int turns, bool closed)
  {
    const double pi = std::acos(-1.0);
    Complex fan;
    fan.Points.push_back({ this->Uniform(-2, 2), this->Uniform(-2, 2) });
    const double start = this->Uniform(0, 62) * 0.1;
    for (int i = 0; i <= triangles; ++i)
    {
      fan.Points.push_back(
        OnCircle(start + 2.0 * pi * turns * i / triangles, this->Uniform(30, 60)));
    }
    for (int i = 0; i < triangles; ++i)
    {
      fan.Triangles.push_back({ 0, i + 1, closed ? (i + 1) % triangles + 1 : i + 2 });
    }
    return fan;
  }

  /// Triangles over arbitrary points.
  Complex Soup(int points, int triangles, int size)
  {
    Complex soup;
    for (int i = 0; i < points; ++i)
    {
      soup.Points.push_back({ this->Uniform(0, size), this->Uniform(0, size) });
    }
    for (int t = 0; t < triangles; ++t)
    {
      Triangulation::Corners corners;
      for (std::int32_t& corner : corners)
      {
        corner = this->Uniform(0, points - 1);
      }
      soup.Triangles.push_back(corners);
    }
    return soup;
  }

  /// Keeps only non-degenerate triangles, numbers and orients them at random, and masks some.
  void Finish(Complex& complex, double masked)
  {
    std::vector<Triangulation::Corners> rest;
    for (const Triangulation::Corners& t : complex.Triangles)
    {
      if (TwiceTheArea(complex, t) != 0)
      {
        rest.push_back(t);
        std::shuffle(rest.back().begin(), rest.back().end(), this->Generator);
      }
    }
    std::shuffle(rest.begin(), rest.end(), this->Generator);
    complex.Triangles = rest;
    complex.Masked.clear();
    for (std::size_t t = 0; t < rest.size(); ++t)
    {
      complex.Masked.push_back(this->Chance(masked) ? 1 : 0);
    }
  }

private:
  static IntegerPoint OnCircle(double angle, int radius)
  {
    return { static_cast<int>(std::lround(radius * std::cos(angle))),
      static_cast<int>(std::lround(radius * std::sin(angle))) };
  }

  std::mt19937_64 Generator;
};

/// A kind of mesh, and the least shares of such meshes without and with overlaps.
struct Family
{
  const char* Name;
  int Count;
  std::uint64_t Seed;
  double LeastFree;
  double LeastOverlapping;
  std::function<Complex(RandomComplexes&)> Make;
};

Complex MakeGridsWithHolesAndSlits(RandomComplexes& random)
{
  Complex complex = random.Grid(random.Uniform(1, 5), 10, 2, 0, 0);
  random.Pierce(complex, random.Chance(0.7) ? 0.25 : 0.0);
  random.Slit(complex, random.Chance(0.5) ? 0.15 : 0.0);
  if (random.Chance(0.5))
  {
    random.Disturb(complex, 1, 12);
  }
  return complex;
}

Complex MakeFoldedGrids(RandomComplexes& random)
{
  Complex complex = random.Grid(random.Uniform(2, 5), 10, 5, 0, 0);
  random.Disturb(complex, random.Uniform(0, 4), 20);
  random.Pierce(complex, random.Chance(0.5) ? 0.4 : 0.0);
  return complex;
}

/// Cut apart completely or partly, with one piece possibly moved by one unit.
Complex MakePiecesThatTouchWithoutSharingPoints(RandomComplexes& random)
{
  Complex complex = random.Grid(random.Uniform(1, 4), 10, 2, 0, 0);
  random.Slit(complex, random.Chance(0.5) ? 1.0 : 0.5);
  const Complex beside = random.Grid(
    2, 10, 2, -20 + (random.Chance(0.3) ? random.Uniform(-1, 1) : 0), 10 * random.Uniform(-1, 3));
  complex.Add(beside.Points, beside.Triangles);
  return complex;
}

/// A small grid in the hole of a larger one, fitting exactly, with a gap, or overlapping; or
/// covered completely where there is no hole.
Complex MakeNestedPieces(RandomComplexes& random)
{
  Complex complex = random.Grid(5, 10, 0, 0, 0);
  const bool pierced = random.Chance(0.8);
  std::vector<Triangulation::Corners> frame;
  for (std::size_t t = 0; t < complex.Triangles.size(); ++t)
  {
    const std::size_t i = t / 2 % 5;
    const std::size_t j = t / 10;
    if (!pierced || i == 0 || j == 0 || i == 4 || j == 4)
    {
      frame.push_back(complex.Triangles[t]);
    }
  }
  complex.Triangles = frame;
  const int squares = random.Uniform(1, 3);
  const int room = 30 - 10 * squares;
  const int slack = random.Chance(0.4) ? 1 : 0;
  const Complex nested = random.Grid(squares, 10, 2, 10 + random.Uniform(-slack, room + slack),
    10 + random.Uniform(-slack, room + slack));
  complex.Add(nested.Points, nested.Triangles);
  return complex;
}

Complex MakeFansThatGoRoundMoreThanOnce(RandomComplexes& random)
{
  const int turns = random.Uniform(1, 3);
  Complex complex = random.Fan(random.Uniform(5 * turns, 9 * turns), turns, random.Chance(0.5));
  if (random.Chance(0.3))
  {
    random.Pierce(complex, 0.5);
  }
  return complex;
}

/// Also edges with many triangles, which count as boundary. Few points on a coarse grid, so that
/// corners touch edges and triangles coincide.
Complex MakeAnyTriangles(RandomComplexes& random)
{
  return random.Soup(random.Uniform(3, 9), random.Uniform(2, 6), random.Uniform(2, 6));
}

TEST(Overlaps, AgreeWithExactArithmetic)
{
  for (const Family& family :
    { Family{ "GridsWithHolesAndSlits", 3000, 1, 0.3, 0.1, MakeGridsWithHolesAndSlits },
      Family{ "FoldedGrids", 2000, 2, 0.1, 0.3, MakeFoldedGrids },
      Family{ "PiecesThatTouchWithoutSharingPoints", 2000, 3, 0.4, 0.05,
        MakePiecesThatTouchWithoutSharingPoints },
      Family{ "NestedPieces", 2000, 4, 0.3, 0.2, MakeNestedPieces },
      Family{ "FansThatGoRoundMoreThanOnce", 3000, 5, 0.2, 0.3, MakeFansThatGoRoundMoreThanOnce },
      Family{ "AnyTriangles", 6000, 8, 0.1, 0.3, MakeAnyTriangles } })
  {
    SCOPED_TRACE(family.Name);
    RandomComplexes random(family.Seed);
    int free = 0;
    int overlapping = 0;
    for (int n = 0; n < family.Count; ++n)
    {
      Complex complex = family.Make(random);
      random.Finish(complex, n % 4 == 0 ? 0.2 : 0.0);
      const TriangleList exact = FindOverlappingExactly(complex);
      ASSERT_EQ(FindOverlappingQuickly(complex, n % 3), exact) << n;
      ++(exact.empty() ? free : overlapping);
    }
    EXPECT_GE(free, family.LeastFree * family.Count);
    EXPECT_GE(overlapping, family.LeastOverlapping * family.Count);
  }
}

TEST(Overlaps, NothingToCompare)
{
  EXPECT_TRUE(FindOverlappingQuickly({}, 2).empty());
  Complex one{ { { 0, 0 }, { 1, 0 }, { 0, 1 } }, { { 0, 1, 2 } }, { 0 } };
  EXPECT_TRUE(FindOverlappingQuickly(one, 2).empty());
  one.Masked[0] = 1;
  EXPECT_TRUE(FindOverlappingQuickly(one, 2).empty());
}

/// A triangle, and one that pierces its edge x = 1 with a corner at @a x, of the size @a size.
Overlaps FindOverlapOfPair(double x, double size, double origin)
{
  std::vector<fixtures::Point> points;
  for (const Vector2& p :
    { Vector2{ 0, 0 }, { 1, 0 }, { 1, 1 }, { x, 0.5 }, { 2, 0.25 }, { 2, 0.75 } })
  {
    points.push_back({ p.x * size + origin, p.y * size + origin, 0.0 });
  }
  return FindOverlaps(fixtures::MakeCloud(points)->GetPoints(), { { 0, 1, 2 }, { 3, 4, 5 } });
}

TEST(Overlaps, RoundingDoesNotCount)
{
  const Overlaps none = FindOverlapOfPair(1.0, 1.0, 0.0);
  EXPECT_TRUE(none.Triangles.empty() && none.WithinRounding.empty());
  const double ulp = std::numeric_limits<double>::epsilon();
  for (const double origin : { 0.0, 1e4 })
  {
    // The largest coordinate is 2, and origin + 2.
    const double rounding = ulp * (2.0 + origin);
    const Overlaps small = FindOverlapOfPair(1.0 - rounding, 1.0, origin);
    EXPECT_TRUE(small.Triangles.empty());
    EXPECT_EQ((TriangleList{ 0, 1 }), small.WithinRounding);
    for (const double depth : { 32.0 * rounding, 0.125 })
    {
      const Overlaps real = FindOverlapOfPair(1.0 - depth, 1.0, origin);
      EXPECT_EQ((TriangleList{ 0, 1 }), real.Triangles);
      EXPECT_TRUE(real.WithinRounding.empty());
      // A triangle's overlap ends when it has moved by so much.
      EXPECT_NEAR(depth, real.Depth, rounding);
    }
  }
}

TEST(Overlaps, TheSizeIsRelative)
{
  // The same pair, however large.
  for (const double size : { 1e-200, 1e-9, 1e9, 1e200 })
  {
    EXPECT_TRUE(FindOverlapOfPair(std::nextafter(1.0, 0.0), size, 0.0).Triangles.empty());
    EXPECT_EQ(2u, FindOverlapOfPair(1.0 - 1e-13, size, 0.0).Triangles.size());
  }
}

TEST(Overlaps, TrianglesThinnerThanTheRoundingOverlap)
{
  // A sliver that lies within a triangle, all of it within rounding of the triangle's edge.
  const auto mesh = fixtures::MakeCloud(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.25, 0, 0 }, { 0.5, 0, 0 }, { 0.375, 1e-16, 0 } });
  EXPECT_EQ((TriangleList{ 0, 1 }),
    FindOverlaps(mesh->GetPoints(), { { 0, 1, 2 }, { 3, 4, 5 } }).Triangles);
}

TEST(Overlaps, RoundedPointsOfAnEdgeAreAccepted)
{
  // Two triangles along the side of a third, their common corner a rounded point of that side.
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal;
  int rounded = 0;
  for (int k = 0; k < 1000; ++k)
  {
    const Vector2 a{ uniform(generator), uniform(generator) };
    const Vector2 d{ normal(generator), normal(generator) };
    const double t = uniform(generator);
    const Vector2 across{ -d.y, d.x };
    const Vector2 middle = a + 0.5 * d;
    const Vector2 corners[] = { a, a + d, middle + across, a + t * d, middle - across };
    std::vector<fixtures::Point> points;
    for (const Vector2& corner : corners)
    {
      points.push_back({ corner.x, corner.y, 0.0 });
    }
    const auto mesh = fixtures::MakeCloud(points);
    const Overlaps overlaps =
      FindOverlaps(mesh->GetPoints(), { { 0, 1, 2 }, { 0, 3, 4 }, { 3, 1, 4 } });
    EXPECT_TRUE(overlaps.Triangles.empty()) << "depth " << overlaps.Depth;
    rounded += overlaps.WithinRounding.empty() ? 0 : 1;
  }
  EXPECT_GT(rounded, 200);
}

} // namespace
