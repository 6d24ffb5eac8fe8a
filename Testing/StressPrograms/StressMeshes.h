// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file StressMeshes.h
/// Random pairs of isomorphic planar meshes, in families of increasing difficulty.

#ifndef StressMeshes_h
#define StressMeshes_h

#include "Fixtures/Meshes.h"
#include "Fixtures/Triangles.h"

#include "Kernel/CoordinateSystem.h"

namespace homeomorphism_stress
{

using namespace homeomorphism_test;

/// A coordinate system under test.
struct TestedSystem
{
  const char* Name;
  homeomorphism::CoordinateSystem System;
  homeomorphism::CenterPoint Center;
  /// The decimal exponent of the least ratio of height to base that the system accepts.
  double Thinnest;
  /// The factor of the exponents of all shapes, less than 1 for a system that accepts fewer shapes.
  double Difficulty;

  /// Whether all triangles must be concordant.
  bool RequiresConcordance() const
  {
    return this->System == homeomorphism::CoordinateSystem::Contour &&
      this->Center == CenterPoint::Centroid;
  }
};

constexpr std::array<TestedSystem, 4> Systems{ {
  { "Linear", homeomorphism::CoordinateSystem::Linear, CenterPoint::Centroid, -280.0, 1.0 },
  { "Contour", homeomorphism::CoordinateSystem::Contour, CenterPoint::Centroid, -140.0, 1.0 },
  { "Incenter", homeomorphism::CoordinateSystem::Contour, CenterPoint::Incenter, -3.0, 0.2 },
  { "Smooth", homeomorphism::CoordinateSystem::Smooth, CenterPoint::Centroid, -280.0, 1.0 },
} };

struct Family
{
  const char* Name;
  const char* Description;
};

enum FamilyIndex
{
  FAIR,
  RATIOS,
  NEEDLES,
  SURVEY,
  SMALL,
  LARGE,
  FAR_AWAY
};

constexpr std::array<Family, 7> Families{ {
  { "fair", "grids, fans and clusters of triangles that are neither thin nor small" },
  { "ratios", "areas across edges up to 1e12 times each other, apexes up to 20 edges aside" },
  { "needles",
    "needles and caps, as thin as 1e-15, and far thinner where an edge is parallel to an axis" },
  { "survey", "coordinates of a national grid: seven digits before the point, three behind" },
  { "small", "any of these, coordinates about 1e-300" },
  { "large", "any of these, coordinates about 1e300" },
  { "far", "any of these, up to 1e12 times their size away from the origin" },
} };

using Triangles = std::vector<fixtures::Triangle>;

/// Triangles, and two sets of points for them.
struct PlanePair
{
  Triangles Cells;
  std::array<std::vector<Vector2>, 2> Points;
};

/// The range of shapes.
enum class Shape
{
  Fair,
  Ratio,
  Thin
};

/// The apex of a triangle over the edge from (0, 0) to (1, 0).
inline Vector2 AnyApex(Random& random, Shape shape, double difficulty, double thinnest)
{
  switch (shape)
  {
    case Shape::Fair:
      return { random.Uniform(-0.3, 1.3), random.Uniform(0.3, 1.5) };
    case Shape::Ratio:
      return { random.Chance(0.5) ? random.Uniform()
                                  : random.Uniform(-20.0 * difficulty, 1.0 + 20.0 * difficulty),
        random.PowerOfTen(-6.0 * difficulty, 6.0 * difficulty) };
    default:
      return { random.Proportion(),
        random.Chance(0.3) ? random.PowerOfTen(0.0, 15.0 * difficulty)
                           : random.PowerOfTen(thinnest, 0.0) };
  }
}

/// Two triangles with a common edge.
inline std::vector<Vector2> TwoTriangles(
  Random& random, Shape shape, double difficulty, double thinnest, bool concordant)
{
  const auto apex = [&]() {
    return concordant ? ConcordantApex(random, shape != Shape::Fair)
                      : AnyApex(random, shape, difficulty, thinnest);
  };
  const Vector2 left = apex();
  const Vector2 right = apex();
  return { { 0.0, 0.0 }, { 1.0, 0.0 }, left, { right.x, -right.y } };
}

/// A triangle and its three neighbors. If they overlap, the mesh is refused.
inline std::vector<Vector2> Cluster(Random& random, Shape shape, double difficulty)
{
  std::vector<Vector2> points{ { 0.0, 0.0 }, { 1.0, 0.0 },
    AnyApex(random, shape, difficulty, -15.0 * difficulty) };
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 start = points[NextCorner(k)];
    const Vector2 edge = points[PreviousCorner(k)] - start;
    const double height =
      shape == Shape::Fair ? random.Uniform(0.1, 0.8) : random.PowerOfTen(-12.0 * difficulty, 0.0);
    points.push_back(
      start + random.Uniform(0.05, 0.95) * edge + height * Vector2{ edge.y, -edge.x });
  }
  return points;
}

/// A vertex with @a count triangles around it.
inline std::vector<Vector2> Fan(Random& random, Shape shape, double difficulty, int count)
{
  std::vector<double> angles(count);
  double sum = 0.0;
  for (double& angle : angles)
  {
    angle =
      shape == Shape::Thin ? random.PowerOfTen(-12.0 * difficulty, 0.0) : random.Uniform(0.2, 1.0);
    sum += angle;
  }
  std::vector<Vector2> points{ { 0.0, 0.0 } };
  double at = 0.0;
  for (const double angle : angles)
  {
    const double radius = shape == Shape::Fair
      ? random.Uniform(0.5, 1.5)
      : random.PowerOfTen(-3.0 * difficulty, 3.0 * difficulty);
    points.push_back({ radius * std::cos(at), radius * std::sin(at) });
    at += 6.283185307179586 * angle / sum;
  }
  return points;
}

/// A grid of 3 x 3 cells; with @a equilateral, of almost equilateral triangles.
inline std::vector<Vector2> Grid(Random& random, bool equilateral)
{
  const double jitter = equilateral ? 0.1 : 0.25;
  std::vector<Vector2> points;
  for (int j = 0; j < 4; ++j)
  {
    for (int i = 0; i < 4; ++i)
    {
      const double x = i + random.Uniform(-jitter, jitter);
      const double y = j + random.Uniform(-jitter, jitter);
      points.push_back(equilateral ? Vector2{ x + 0.5 * y, 0.866 * y } : Vector2{ x, y });
    }
  }
  return points;
}

inline Triangles GridCells()
{
  Triangles cells;
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      const int a = 4 * j + i;
      cells.push_back({ a, a + 1, a + 4 });
      cells.push_back({ a + 1, a + 5, a + 4 });
    }
  }
  return cells;
}

/// Transforms a mesh according to its family, by rotation, scaling, translation and rounding.
inline void TransformMesh(Random& random, int family, bool turn, std::vector<Vector2>& points)
{
  double size = 0.0;
  for (const Vector2& p : points)
  {
    size = std::max({ size, std::abs(p.x), std::abs(p.y) });
  }
  const double angle = turn ? random.Uniform(0.0, 6.283185307179586) : 0.0;
  const Vector2 u = turn ? Vector2{ std::cos(angle), std::sin(angle) } : Vector2{ 1.0, 0.0 };
  Vector2 shift;
  double scale = 1.0;
  double grain = 0.0;
  switch (family)
  {
    case SURVEY:
      // Sizes from a few meters to a country.
      scale = random.PowerOfTen(0.5, 5.5) / size;
      shift = { random.Uniform(3.2e6, 3.9e6), random.Uniform(5.2e6, 6.1e6) };
      grain = 1000.0;
      break;
    case SMALL:
      scale = 1e-300 * random.PowerOfTen(-1.0, 1.0) / size;
      break;
    case LARGE:
      scale = 1e300 * random.PowerOfTen(-1.0, 1.0) / size;
      break;
    case FAR_AWAY:
    {
      const double distance = size * random.PowerOfTen(0.0, 12.0);
      shift = { distance * random.Uniform(-1.0, 1.0), distance * random.Uniform(-1.0, 1.0) };
      break;
    }
    default:
      scale = random.Chance(0.5) ? 1.0 : random.PowerOfTen(-3.0, 3.0);
  }
  for (Vector2& p : points)
  {
    p = { scale * (p.x * u.x - p.y * u.y) + shift.x, scale * (p.x * u.y + p.y * u.x) + shift.y };
    if (grain > 0.0)
    {
      p = { std::round(p.x * grain) / grain, std::round(p.y * grain) / grain };
    }
  }
}

/// A pair of a family. It may be invalid, especially where coordinates are
/// rounded.
inline PlanePair AnyPair(Random& random, int family, const TestedSystem& system)
{
  constexpr std::array<Shape, 3> shapes{ Shape::Fair, Shape::Ratio, Shape::Thin };
  const Shape shape = family <= NEEDLES ? shapes[family] : shapes[random.Below(3)];
  PlanePair pair;
  const bool concordant = system.RequiresConcordance();
  const double difficulty = system.Difficulty;
  const int kind = concordant ? (shape == Shape::Fair ? random.Below(2) : 0) : random.Below(4);
  const int count = random.Integer(3, 24);
  for (int side = 0; side < 2; ++side)
  {
    const bool turn = random.Chance(0.6);
    const bool extreme = family == NEEDLES && !turn && random.Chance(0.5);
    std::vector<Vector2>& points = pair.Points[side];
    switch (kind)
    {
      case 0:
        points = TwoTriangles(
          random, shape, difficulty, extreme ? system.Thinnest : -15.0 * difficulty, concordant);
        break;
      case 1:
        points =
          shape == Shape::Fair ? Grid(random, concordant) : Cluster(random, shape, difficulty);
        break;
      case 2:
        points = Cluster(random, shape, difficulty);
        break;
      default:
        points = Fan(random, shape, difficulty, count);
    }
    TransformMesh(random, family, turn, points);
  }
  if (kind == 0)
  {
    pair.Cells = { { 0, 1, 2 }, { 1, 0, 3 } };
  }
  else if (kind == 1 && shape == Shape::Fair)
  {
    pair.Cells = GridCells();
  }
  else if (kind <= 2)
  {
    pair.Cells = { { 0, 1, 2 }, { 2, 1, 3 }, { 0, 2, 4 }, { 1, 0, 5 } };
  }
  else
  {
    for (int i = 0; i < count; ++i)
    {
      pair.Cells.push_back({ 0, 1 + i, 1 + (i + 1) % count });
    }
  }
  return pair;
}

} // namespace homeomorphism_stress

#endif
