// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// FindOverlapping looks only at boundary edges unless the mesh is folded. Here every triangle of
// many small meshes is compared with every other, in integers. What overlaps by the rounding of its
// coordinates does not count.

#include "TestMeshes.h"

#include "Mesh/MeshGeometry.h"
#include "Mesh/MeshValidation.h"
#include "Mesh/PointLocation.h"
#include "Mesh/Triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <numeric>
#include <random>

namespace
{

using namespace homeomorphism;

#ifdef __SIZEOF_INT128__
__extension__ using Integer = __int128;
#else
#error "The exact check of this test needs integers of 128 bits."
#endif

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

/// A point (X / W, Y / W), W not 0.
struct RationalPoint
{
  Integer X;
  Integer Y;
  Integer W;
};

/// A line a x + b y = c.
struct Line
{
  Integer A;
  Integer B;
  Integer C;
};

int Sign(Integer value)
{
  return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

Line Through(const IntegerPoint& p, const IntegerPoint& q)
{
  const Integer a = q.Y - p.Y;
  const Integer b = p.X - q.X;
  return { a, b, a * p.X + b * p.Y };
}

int Domain(const Line& line, const RationalPoint& p)
{
  return Sign(line.A * p.X + line.B * p.Y - line.C * p.W) * Sign(p.W);
}

/// Twice the signed area of three points.
Integer Determinant(const RationalPoint& p, const RationalPoint& q, const RationalPoint& r)
{
  return p.X * (q.Y * r.W - r.Y * q.W) - p.Y * (q.X * r.W - r.X * q.W) +
    p.W * (q.X * r.Y - r.X * q.Y);
}

class ExactTriangle
{
public:
  ExactTriangle(const Complex& complex, std::size_t triangle)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->Points[k] = complex.Points[complex.Triangles[triangle][k]];
    }
    for (int k = 0; k < 3; ++k)
    {
      this->Lines[k] = Through(this->Points[(k + 1) % 3], this->Points[(k + 2) % 3]);
      this->Inside[k] = Domain(this->Lines[k], this->Corner(k));
    }
  }

  RationalPoint Corner(int k) const { return { this->Points[k].X, this->Points[k].Y, 1 }; }
  bool HasArea() const { return this->Inside[0] != 0; }

  /// Whether a point is in the closed triangle.
  bool Contains(const RationalPoint& p) const
  {
    for (int k = 0; k < 3; ++k)
    {
      if (Domain(this->Lines[k], p) * this->Inside[k] < 0)
      {
        return false;
      }
    }
    return true;
  }

  std::array<IntegerPoint, 3> Points;
  std::array<Line, 3> Lines;
  std::array<int, 3> Inside;
};

/// Whether the intersection of two triangles has a positive area. It is the convex hull of the
/// corners of each inside the other and of the crossings of their edges.
bool CommonPartHasArea(const ExactTriangle& first, const ExactTriangle& second)
{
  std::vector<RationalPoint> hull;
  const auto add = [&](const RationalPoint& p) {
    if (first.Contains(p) && second.Contains(p))
    {
      hull.push_back(p);
    }
  };
  for (int k = 0; k < 3; ++k)
  {
    add(first.Corner(k));
    add(second.Corner(k));
    for (int j = 0; j < 3; ++j)
    {
      const Line& l = first.Lines[k];
      const Line& m = second.Lines[j];
      const Integer w = l.A * m.B - m.A * l.B;
      if (w != 0)
      {
        add({ l.C * m.B - m.C * l.B, l.A * m.C - m.A * l.C, w });
      }
    }
  }
  for (std::size_t i = 0; i < hull.size(); ++i)
  {
    for (std::size_t j = i + 1; j < hull.size(); ++j)
    {
      for (std::size_t k = j + 1; k < hull.size(); ++k)
      {
        if (Determinant(hull[i], hull[j], hull[k]) != 0)
        {
          return true;
        }
      }
    }
  }
  return false;
}

TriangleList FindOverlappingExactly(const Complex& complex)
{
  std::vector<ExactTriangle> triangles;
  for (std::size_t t = 0; t < complex.Triangles.size(); ++t)
  {
    triangles.emplace_back(complex, t);
  }
  std::vector<bool> overlaps(triangles.size(), false);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t u = t + 1; u < triangles.size(); ++u)
    {
      if (!complex.Masked[t] && !complex.Masked[u] && !(overlaps[t] && overlaps[u]) &&
        CommonPartHasArea(triangles[t], triangles[u]))
      {
        overlaps[t] = overlaps[u] = true;
      }
    }
  }
  TriangleList list;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (overlaps[t])
    {
      list.push_back(static_cast<TriangleIndex>(t));
    }
  }
  return list;
}

/// The same result from FindOverlapping, with the integer grid in the xy plane, or a finer one.
TriangleList FindOverlappingQuickly(const Complex& complex, const std::array<int, 3>& axes)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const IntegerPoint& p : complex.Points)
  {
    std::array<double, 3> x{};
    x[axes[0]] = p.X;
    x[axes[1]] = p.Y;
    x[axes[2]] = 7.0;
    points->InsertNextPoint(x.data());
  }
  Triangulation triangulation;
  triangulation.SetTriangles(complex.Triangles, 0);
  for (std::size_t t = 0; t < complex.Masked.size(); ++t)
  {
    if (complex.Masked[t])
    {
      triangulation.Mask(static_cast<TriangleIndex>(t));
    }
  }
  triangulation.FindAdjacency(points->GetNumberOfPoints());
  const MeshGeometry geometry(points, triangulation);
  const PointLocation location(triangulation, geometry);
  return FindOverlapping(triangulation, geometry, location).Triangles;
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
    for (const auto& t : test_meshes::GridTriangles(squares))
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
      const double angle = start + 2.0 * pi * turns * i / triangles;
      const double radius = this->Uniform(30, 60);
      fan.Points.push_back({ static_cast<int>(std::lround(radius * std::cos(angle))),
        static_cast<int>(std::lround(radius * std::sin(angle))) });
    }
    for (int i = 0; i < triangles; ++i)
    {
      fan.Triangles.push_back({ 0, i + 1, closed ? (i + 1) % triangles + 1 : i + 2 });
    }
    return fan;
  }

  /// A strip along a circle, which may overlap its own beginning.
  Complex Strip(int squares, double turns, bool closed)
  {
    const double pi = std::acos(-1.0);
    Complex strip;
    const int radius = this->Uniform(20, 40);
    for (int i = 0; i <= squares; ++i)
    {
      const double angle = 2.0 * pi * turns * i / squares;
      for (const int r : { radius, radius + this->Uniform(5, 15) })
      {
        strip.Points.push_back({ static_cast<int>(std::lround(r * std::cos(angle))),
          static_cast<int>(std::lround(r * std::sin(angle))) });
      }
    }
    for (int i = 0; i < squares; ++i)
    {
      const std::int32_t a = 2 * i;
      const std::int32_t c = closed && i + 1 == squares ? 0 : 2 * i + 2;
      strip.Triangles.push_back({ a, a + 1, c + 1 });
      strip.Triangles.push_back({ a, c + 1, c });
    }
    return strip;
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
    for (std::size_t t = 0; t < complex.Triangles.size(); ++t)
    {
      if (ExactTriangle(complex, t).HasArea())
      {
        rest.push_back(complex.Triangles[t]);
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
  std::mt19937_64 Generator;
};

struct Tally
{
  int Free = 0;
  int Overlapping = 0;
};

/// Compares the two results for meshes of one family. Both results must occur often enough.
void Compare(const char* family, int count, std::uint64_t seed,
  const std::function<Complex(RandomComplexes&)>& make, double leastFree, double leastOverlapping)
{
  RandomComplexes random(seed);
  Tally tally;
  for (int n = 0; n < count; ++n)
  {
    Complex complex = make(random);
    random.Finish(complex, n % 4 == 0 ? 0.2 : 0.0);
    const TriangleList exact = FindOverlappingExactly(complex);
    const std::array<std::array<int, 3>, 3> planes{ { { 0, 1, 2 }, { 1, 2, 0 }, { 2, 0, 1 } } };
    const TriangleList quick = FindOverlappingQuickly(complex, planes[n % 3]);
    if (exact != quick)
    {
      std::string text;
      for (const IntegerPoint& p : complex.Points)
      {
        text += " (" + std::to_string(p.X) + "," + std::to_string(p.Y) + ")";
      }
      text += "\n";
      for (std::size_t t = 0; t < complex.Triangles.size(); ++t)
      {
        const auto& c = complex.Triangles[t];
        text += " {" + std::to_string(c[0]) + "," + std::to_string(c[1]) + "," +
          std::to_string(c[2]) + (complex.Masked[t] ? "}masked" : "}");
      }
      FAIL() << family << " " << n << ": exactly " << testing::PrintToString(exact) << " quickly "
             << testing::PrintToString(quick) << "\npoints" << text;
    }
    ++(exact.empty() ? tally.Free : tally.Overlapping);
  }
  std::cout << family << ": " << tally.Free << " free of overlaps, " << tally.Overlapping
            << " not\n";
  EXPECT_GE(tally.Free, leastFree * count);
  EXPECT_GE(tally.Overlapping, leastOverlapping * count);
}

TEST(Overlap, GridsWithHolesAndSlits)
{
  Compare(
    "grids", 3000, 1,
    [](RandomComplexes& random) {
      Complex complex = random.Grid(random.Uniform(1, 5), 10, 2, 0, 0);
      random.Pierce(complex, random.Chance(0.7) ? 0.25 : 0.0);
      random.Slit(complex, random.Chance(0.5) ? 0.15 : 0.0);
      if (random.Chance(0.5))
      {
        random.Disturb(complex, 1, 12);
      }
      return complex;
    },
    0.3, 0.1);
}

TEST(Overlap, FoldedGrids)
{
  Compare(
    "folded grids", 2000, 2,
    [](RandomComplexes& random) {
      Complex complex = random.Grid(random.Uniform(2, 5), 10, 5, 0, 0);
      random.Disturb(complex, random.Uniform(0, 4), 20);
      random.Pierce(complex, random.Chance(0.5) ? 0.4 : 0.0);
      return complex;
    },
    0.1, 0.3);
}

TEST(Overlap, PiecesThatTouchWithoutSharingPoints)
{
  // Cut apart completely or partly, with one piece possibly moved by one unit.
  Compare(
    "pieces", 2000, 3,
    [](RandomComplexes& random) {
      Complex complex = random.Grid(random.Uniform(1, 4), 10, 2, 0, 0);
      random.Slit(complex, random.Chance(0.5) ? 1.0 : 0.5);
      const Complex beside = random.Grid(2, 10, 2,
        -20 + (random.Chance(0.3) ? random.Uniform(-1, 1) : 0), 10 * random.Uniform(-1, 3));
      complex.Add(beside.Points, beside.Triangles);
      return complex;
    },
    0.4, 0.05);
}

TEST(Overlap, NestedPieces)
{
  // A small grid in the hole of a larger one, fitting exactly, with a gap, or overlapping; or
  // covered completely where there is no hole.
  Compare(
    "nested", 2000, 4,
    [](RandomComplexes& random) {
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
    },
    0.3, 0.2);
}

TEST(Overlap, FansThatGoRoundMoreThanOnce)
{
  Compare(
    "fans", 3000, 5,
    [](RandomComplexes& random) {
      const int turns = random.Uniform(1, 3);
      Complex complex = random.Fan(random.Uniform(5 * turns, 9 * turns), turns, random.Chance(0.5));
      if (random.Chance(0.3))
      {
        random.Pierce(complex, 0.5);
      }
      return complex;
    },
    0.2, 0.3);
}

TEST(Overlap, StripsThatRunOverThemselves)
{
  Compare(
    "strips", 3000, 6,
    [](RandomComplexes& random) {
      const bool closed = random.Chance(0.3);
      const double turns = closed ? 1.0 : random.Uniform(60, 125) * 0.01;
      Complex complex = random.Strip(random.Uniform(8, 20), turns, closed);
      if (random.Chance(0.3))
      {
        random.Slit(complex, 0.1);
      }
      return complex;
    },
    0.3, 0.2);
}

TEST(Overlap, TwoFansAtOneVertexMayOverlap)
{
  // Corners that meet at a shared point, adjacent or not.
  Compare(
    "two fans", 2000, 7,
    [](RandomComplexes& random) {
      Complex complex = random.Fan(8, 1, false);
      Complex second = random.Fan(8, 1, false);
      random.Pierce(complex, 0.6);
      random.Pierce(second, 0.6);
      const auto first = static_cast<std::int32_t>(complex.Points.size());
      complex.Points.insert(complex.Points.end(), second.Points.begin(), second.Points.end());
      for (const auto& t : second.Triangles)
      {
        complex.Triangles.push_back({ 0, t[1] + first, t[2] + first });
      }
      return complex;
    },
    0.05, 0.3);
}

TEST(Overlap, AnyTriangles)
{
  // Also edges with many triangles, which count as boundary. Few points on a coarse grid, so that
  // corners touch edges and triangles coincide.
  Compare(
    "soups", 6000, 8,
    [](RandomComplexes& random) {
      return random.Soup(random.Uniform(3, 9), random.Uniform(2, 6), random.Uniform(2, 6));
    },
    0.1, 0.3);
}

TEST(Overlap, NothingToCompare)
{
  EXPECT_TRUE(FindOverlappingQuickly({}, { 0, 1, 2 }).empty());
  Complex one{ { { 0, 0 }, { 1, 0 }, { 0, 1 } }, { { 0, 1, 2 } }, { 0 } };
  EXPECT_TRUE(FindOverlappingQuickly(one, { 0, 1, 2 }).empty());
  one.Masked[0] = 1;
  EXPECT_TRUE(FindOverlappingQuickly(one, { 0, 1, 2 }).empty());
}

/// A triangle, and one that pierces its edge x = 1 with a corner at @a x, of the size @a size.
Overlaps FindOverlapOfPair(double x, double size, double origin)
{
  std::vector<test_meshes::Point> points{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { x, 0.5, 0 },
    { 2, 0.25, 0 }, { 2, 0.75, 0 } };
  for (test_meshes::Point& p : points)
  {
    p = { p[0] * size + origin, p[1] * size + origin, 0.0 };
  }
  const auto mesh = test_meshes::MakeMesh(points, {});
  Triangulation triangulation;
  triangulation.SetTriangles({ { 0, 1, 2 }, { 3, 4, 5 } }, 0);
  triangulation.FindAdjacency(6);
  const MeshGeometry geometry(mesh->GetPoints(), triangulation);
  const PointLocation location(triangulation, geometry);
  Overlaps overlaps = FindOverlapping(triangulation, geometry, location);
  overlaps.Depth /= geometry.GetScale();
  return overlaps;
}

TEST(Overlap, RoundingDoesNotCount)
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

TEST(Overlap, TheSizeIsRelative)
{
  // The same pair, however large.
  for (const double size : { 1e-200, 1e-9, 1e9, 1e200 })
  {
    EXPECT_TRUE(FindOverlapOfPair(std::nextafter(1.0, 0.0), size, 0.0).Triangles.empty());
    EXPECT_EQ(2u, FindOverlapOfPair(1.0 - 1e-13, size, 0.0).Triangles.size());
  }
}

TEST(Overlap, TrianglesThinnerThanTheRoundingOverlap)
{
  // A sliver that lies within a triangle, all of it within rounding of the triangle's edge.
  const auto mesh = test_meshes::MakeMesh(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.25, 0, 0 }, { 0.5, 0, 0 }, { 0.375, 1e-16, 0 } },
    {});
  Triangulation triangulation;
  triangulation.SetTriangles({ { 0, 1, 2 }, { 3, 4, 5 } }, 0);
  triangulation.FindAdjacency(6);
  const MeshGeometry geometry(mesh->GetPoints(), triangulation);
  const PointLocation location(triangulation, geometry);
  EXPECT_EQ((TriangleList{ 0, 1 }), FindOverlapping(triangulation, geometry, location).Triangles);
}

TEST(Overlap, RoundedPointsOfAnEdgeAreAccepted)
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
    std::vector<test_meshes::Point> points;
    for (const Vector2& corner : corners)
    {
      points.push_back({ corner.x, corner.y, 0.0 });
    }
    const auto mesh = test_meshes::MakeMesh(points, {});
    Triangulation triangulation;
    triangulation.SetTriangles({ { 0, 1, 2 }, { 0, 3, 4 }, { 3, 1, 4 } }, 0);
    triangulation.FindAdjacency(5);
    const MeshGeometry geometry(mesh->GetPoints(), triangulation);
    const PointLocation location(triangulation, geometry);
    const Overlaps overlaps = FindOverlapping(triangulation, geometry, location);
    EXPECT_TRUE(overlaps.Triangles.empty()) << "depth " << overlaps.Depth;
    rounded += overlaps.WithinRounding.empty() ? 0 : 1;
  }
  EXPECT_GT(rounded, 200);
}

TEST(Overlap, LongSlantedStrips)
{
  // The boxes around all triangles meet.
  constexpr std::int32_t n = 20000;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const int row : { 0, 1 })
  {
    for (std::int32_t k = 0; k <= n; ++k)
    {
      points->InsertNextPoint(k + row * n, row * n, 0.0);
    }
  }
  std::vector<Triangulation::Corners> triangles;
  for (std::int32_t k = 0; k < n; ++k)
  {
    triangles.push_back({ k, k + 1, k + n + 1 });
    triangles.push_back({ k + 1, k + n + 2, k + n + 1 });
  }
  Triangulation triangulation;
  triangulation.SetTriangles(triangles, 0);
  triangulation.FindAdjacency(points->GetNumberOfPoints());
  const MeshGeometry geometry(points, triangulation);
  const PointLocation location(triangulation, geometry);
  const Overlaps overlaps = FindOverlapping(triangulation, geometry, location);
  EXPECT_TRUE(overlaps.Triangles.empty() && overlaps.WithinRounding.empty());
}

TEST(Overlap, ALargeMeshTakesNearlyLinearTime)
{
  // The time is nearly linear: 720,000 triangles take well under a second, where comparing all
  // pairs would take hours.
  constexpr int n = 600;
  const auto mesh = test_meshes::MakeMesh(test_meshes::GridPoints(n, 9, 0.2), {});
  std::vector<Triangulation::Corners> triangles;
  for (const auto& t : test_meshes::GridTriangles(n))
  {
    triangles.push_back({ static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
      static_cast<std::int32_t>(t[2]) });
  }
  Triangulation triangulation;
  triangulation.SetTriangles(triangles, 0);
  triangulation.FindAdjacency(mesh->GetNumberOfPoints());
  const MeshGeometry geometry(mesh->GetPoints(), triangulation);
  const PointLocation location(triangulation, geometry);
  EXPECT_TRUE(FindOverlapping(triangulation, geometry, location).Triangles.empty());
}

} // namespace
