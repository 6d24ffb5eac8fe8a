// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Triangles.h
/// Random triangles in the plane, as extreme as requested, and their neighbors, points and charts,
/// for tests of properties. Does not use VTK.

#ifndef fixtures_Triangles_h
#define fixtures_Triangles_h

#include "Random.h"

#include "Kernel/ContourChart.h"
#include "Kernel/CoordinateSystem.h"
#include "Kernel/CubicElement.h"
#include "Kernel/ExactSign.h"
#include "Kernel/Geometry.h"
#include "Kernel/LinearChart.h"
#include "Kernel/SmoothChart.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <type_traits>

namespace homeomorphism_test
{

using namespace homeomorphism;
using fixtures::Random;
using fixtures::Ulp;

/// A triangle together with its frame.
struct PlaneTriangle
{
  std::array<Vector2, 3> Corners;
  TriangleShape Shape;
  Vector2 Origin;
  Vector2 Tangent;

  explicit PlaneTriangle(const std::array<Vector2, 3>& corners)
    : Corners(corners)
  {
    double longest = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      const Vector2 edge = corners[PreviousCorner(k)] - corners[NextCorner(k)];
      const double length = std::hypot(edge.x, edge.y);
      if (length > longest)
      {
        longest = length;
        this->Shape.Apex = k;
        this->Origin = corners[NextCorner(k)];
        this->Tangent = (1.0 / length) * edge;
      }
    }
    this->Shape.Base = longest;
    const Vector2 edge = corners[PreviousCorner(this->Shape.Apex)] - this->Origin;
    const Vector2 apex = corners[this->Shape.Apex] - this->Origin;
    this->Shape.ApexX = Dot(apex, this->Tangent);
    this->Shape.Height = DifferenceOfProducts(edge.x, apex.y, edge.y, apex.x) / longest;
  }

  Vector2 ToFrame(const Vector2& point) const
  {
    const Vector2 d = point - this->Origin;
    return { Dot(d, this->Tangent), Cross(this->Tangent, d) };
  }

  Vector2 FromFrame(const Vector2& point) const
  {
    return this->Origin + this->VectorFromFrame(point);
  }

  Vector2 VectorFromFrame(const Vector2& v) const
  {
    return { v.x * this->Tangent.x - v.y * this->Tangent.y,
      v.x * this->Tangent.y + v.y * this->Tangent.x };
  }

  EdgeViews Views() const
  {
    return ViewsFromEdges(this->Corners[0], this->Corners[1], this->Corners[2]);
  }

  /// The condition of its frame: how much the rounding of its corners changes derivatives.
  double Aspect() const { return this->Shape.Base / this->Shape.Height; }
};

/// Transforms the derivative of a homeomorphism from the frames of two triangles to coordinates of
/// the plane.
inline Matrix2 InPlane(const PlaneTriangle& from, const PlaneTriangle& to, const Matrix2& matrix)
{
  const auto image = [&](const Vector2& v) {
    return to.VectorFromFrame(matrix * Vector2{ Dot(v, from.Tangent), Cross(from.Tangent, v) });
  };
  return { image({ 1.0, 0.0 }), image({ 0.0, 1.0 }) };
}

inline double Norm(const Vector2& v)
{
  return std::hypot(v.x, v.y);
}

inline double Norm(const Matrix2& m)
{
  return std::hypot(Norm(m.ImageOfX), Norm(m.ImageOfY));
}

using Corners = std::array<Vector2, 3>;

/// The triangle with base from (0, 0) to (1, 0) and this apex, rotated and scaled, with randomly
/// numbered corners.
inline Corners Moved(Random& random, const Vector2& apex, double scale)
{
  const double angle = random.Uniform(0.0, 6.283185307179586);
  // One in four stays axis-parallel, where coordinates are exact.
  const bool turned = random.Chance(0.75);
  const Vector2 u =
    turned ? Vector2{ scale * std::cos(angle), scale * std::sin(angle) } : Vector2{ scale, 0.0 };
  const auto turn = [&u](const Vector2& p) -> Vector2 {
    return { p.x * u.x - p.y * u.y, p.x * u.y + p.y * u.x };
  };
  const Corners corners{ turn({ 0.0, 0.0 }), turn({ 1.0, 0.0 }), turn(apex) };
  const int first = random.Below(3);
  return { corners[first], corners[NextCorner(first)], corners[PreviousCorner(first)] };
}

/// From fat triangles to needles with a height of a millionth of the longest edge.
inline Corners AnyTriangle(Random& random)
{
  return Moved(
    random, { random.Proportion(), random.PowerOfTen(-6.0, -0.07) }, random.PowerOfTen(-3.0, 3.0));
}

inline bool IsConcordant(const Corners& corners)
{
  return homeomorphism::IsConcordant(&corners[0].x, &corners[1].x, &corners[2].x, 2);
}

/// The apex of a concordant triangle over the edge from (0, 0) to (1, 0): of a fat triangle, or, if
/// it may be thin, also of a flat cap or a tall needle down to a millionth.
inline Vector2 ConcordantApex(Random& random, bool mayBeThin)
{
  for (;;)
  {
    const double thin = mayBeThin ? random.PowerOfTen(-6.0, 0.0) : 1.0;
    Vector2 apex;
    switch (mayBeThin ? random.Below(3) : 0)
    {
      case 0:
        apex = { random.Uniform(-0.5, 1.5), random.Uniform(0.1, 1.5) };
        break;
      case 1:
        // A flat cap is concordant approximately for |x - 1/2| < 2 thin^2.
        apex = { 0.5 + random.Uniform(-2.5, 2.5) * thin * thin, thin };
        break;
      default:
        // With the short edge as unit, a tall needle is concordant for -1 < x < 2.
        apex = { random.Chance(0.3) ? 0.5 : random.Uniform(-1.2, 2.2), 1.0 / thin };
    }
    if (IsConcordant({ Vector2{ 0.0, 0.0 }, Vector2{ 1.0, 0.0 }, apex }))
    {
      return apex;
    }
  }
}

/// Triangles of each such kind, and those that one bit separates from discordant ones.
inline Corners ConcordantTriangle(Random& random)
{
  for (;;)
  {
    Corners corners = Moved(random, ConcordantApex(random, true), random.PowerOfTen(-6.0, 3.0));
    // Rounding may have made it discordant.
    if (!IsConcordant(corners))
    {
      continue;
    }
    if (random.Chance(0.25))
    {
      // Move a corner along another edge until the triangle is discordant, then bisect down to
      // adjacent doubles. The result is the last concordant triangle.
      const int k = random.Below(3);
      const Vector2 inside = corners[k];
      const Vector2 slide = 8.0 * (corners[NextCorner(k)] - corners[PreviousCorner(k)]);
      double concordant = 0.0;
      double discordant = random.Chance(0.5) ? 1.0 : -1.0;
      for (int i = 0; i < 100; ++i)
      {
        const double t = 0.5 * (concordant + discordant);
        corners[k] = inside + t * slide;
        (IsConcordant(corners) ? concordant : discordant) = t;
      }
      corners[k] = inside + concordant * slide;
    }
    return corners;
  }
}

/// A neighbor across an edge from which the triangle has the view @a own: up to a million times
/// lower or higher, with its apex up to twenty edge lengths aside. One in eight is missing.
inline Neighbor AnyNeighbor(Random& random, const EdgeView& own)
{
  if (random.Chance(0.125))
  {
    return {};
  }
  Neighbor neighbor;
  neighbor.Exists = true;
  neighbor.View.Length = own.Length;
  neighbor.View.Foot = random.Chance(0.5) ? random.Uniform() : random.Uniform(-20.0, 21.0);
  neighbor.View.Height =
    own.Height * (random.Chance(0.5) ? random.Uniform(0.2, 5.0) : random.PowerOfTen(-6.0, 6.0));
  return neighbor;
}

inline std::array<Neighbor, 3> AnyNeighbors(Random& random, const EdgeViews& views)
{
  return { AnyNeighbor(random, views[0]), AnyNeighbor(random, views[1]),
    AnyNeighbor(random, views[2]) };
}

/// No subnormal numbers beside 0: the predicate for sides of a line could not form their products.
inline double MovedByUlps(double x, int count)
{
  if (x == 0.0)
  {
    return count * 0x1p-200;
  }
  for (int i = 0; i < std::abs(count); ++i)
  {
    x = std::nextafter(x, count > 0 ? 1e308 : -1e308);
  }
  return x;
}

/// The distance of a point from a closed triangle of either orientation.
inline double DistanceOutside(const Corners& corners, const Vector2& point)
{
  const int sign = Orientation(corners[0], corners[1], corners[2]);
  double nearest = fixtures::Infinity;
  bool inside = true;
  for (int k = 0; k < 3; ++k)
  {
    Vector2 start = corners[NextCorner(k)];
    Vector2 end = corners[PreviousCorner(k)];
    inside = inside && sign * Orientation(start, end, point) >= 0;
    // Measured from the nearer end, so that rounding of the length of the edge does not matter.
    if (Norm(point - end) < Norm(point - start))
    {
      std::swap(start, end);
    }
    const Vector2 edge = end - start;
    const double length = Norm(edge);
    const Vector2 d = point - start;
    const double along = std::min(1.0, std::max(0.0, Dot(d, (1.0 / length) * edge) / length));
    nearest = std::min(nearest, Norm(d - along * edge));
  }
  // Negated so that NaN counts as outside.
  return inside ? 0.0 : nearest;
}

inline double DistanceOutside(const TriangleShape& shape, const Vector2& point)
{
  return DistanceOutside(Corners{ shape.Corner(0), shape.Corner(1), shape.Corner(2) }, point);
}

/// Barycentric coordinates on the inner border of the strip of edge @a k, u = 1.
inline Barycentric OnStripBorder(int k, double tau, double proportion)
{
  // l_k = tau q and l_i + l_j = 1 - l_k with l_j / (l_i + l_j) = proportion.
  const double q = tau * proportion * (1.0 - proportion);
  const double domains = 1.0 / (1.0 + q);
  Barycentric l;
  l[k] = q * domains;
  l[NextCorner(k)] = domains * (1.0 - proportion);
  l[PreviousCorner(k)] = domains * proportion;
  return l;
}

/// The coordinate systems with the construction of their charts, for tests over all systems.
struct LinearSystem
{
  static constexpr const char* Name = "Linear";
  using Chart = LinearChart;
  static Corners Any(Random& random) { return AnyTriangle(random); }
  static Chart Make(Random&, const PlaneTriangle& t) { return Chart(t.Shape); }
};

struct ContourSystem
{
  static constexpr const char* Name = "Contour";
  using Chart = ContourChart;
  static Corners Any(Random& random) { return ConcordantTriangle(random); }
  static Chart Make(Random&, const PlaneTriangle& t) { return Chart(t.Shape, t.Views()); }
};

struct IncenterSystem
{
  static constexpr const char* Name = "Contour_from_the_incenter";
  using Chart = ContourChart;
  static Corners Any(Random& random) { return AnyTriangle(random); }
  static Chart Make(Random&, const PlaneTriangle& t)
  {
    return Chart(t.Shape, t.Views(), CenterPoint::Incenter);
  }
};

struct SmoothSystem
{
  static constexpr const char* Name = "Smooth";
  using Chart = SmoothChart;
  static Corners Any(Random& random) { return AnyTriangle(random); }
  static Chart Make(Random& random, const PlaneTriangle& t)
  {
    const EdgeViews views = t.Views();
    return Chart(t.Shape, views, AnyNeighbors(random, views));
  }
};

/// Names of the typed tests.
struct SystemName
{
  template <typename System>
  static std::string GetName(int)
  {
    return System::Name;
  }
};

/// How much a chart magnifies rounding at a reference point: the largest |D ToPoint| over the
/// longest edge and the largest |D ToReference| times the longest edge, both at least 1. The Smooth
/// chart magnifies the rounding of (e, p, c) beside a sheared or far larger neighbor, and the
/// rounding of a point beside a far smaller one.
struct Magnification
{
  double Forward = 1.0;
  double Inverse = 1.0;

  template <typename Chart>
  Magnification(
    const Chart& chart, const TriangleShape& shape, const typename Chart::Reference& reference)
  {
    if constexpr (std::is_same_v<Chart, SmoothChart>)
    {
      for (int k = 0; k < 3; ++k)
      {
        const CornerCoordinates along = CornerCoordinates{ 0.0, -1.0, 1.0 }.Turned(k);
        const CornerCoordinates across = CornerCoordinates{ 1.0, -0.5, -0.5 }.Turned(k);
        this->Forward =
          std::max({ this->Forward, Norm(chart.Pushforward(reference, along)) / shape.Base,
            Norm(chart.Pushforward(reference, across)) / shape.Base });
        // Directions of the affine chart, so that the shape of the triangle does not matter.
        const Vector2 vector = shape.FromBarycentric(across.InOrderFrom(0));
        for (const double component : chart.Pullback(reference, vector).InOrderFrom(0))
        {
          this->Inverse = std::max(this->Inverse, std::abs(component));
        }
      }
    }
  }
};

/// The corners of a triangle and a point of it, with all digits.
inline std::string Description(const PlaneTriangle& t, const Vector2& inFrame)
{
  std::ostringstream text;
  text.precision(17);
  text << "corners";
  for (const Vector2& corner : t.Corners)
  {
    text << " (" << corner.x << ", " << corner.y << ")";
  }
  text << ", point in frame (" << inFrame.x << ", " << inFrame.y << ")";
  return text.str();
}

} // namespace homeomorphism_test

#endif
