// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file RandomTriangles.h
/// Random triangles, neighbors and points for property tests. All values follow from the seed on
/// every platform, unlike those of the distributions of the standard library.

#ifndef RandomTriangles_h
#define RandomTriangles_h

#include "PlaneTriangle.h"

#include "Kernel/ContourChart.h"
#include "Kernel/ExactSign.h"
#include "Kernel/LinearChart.h"
#include "Kernel/SmoothChart.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>

namespace homeomorphism_test
{

constexpr double Ulp = std::numeric_limits<double>::epsilon();

class RandomNumbers
{
public:
  explicit RandomNumbers(std::uint64_t seed)
    : Engine(seed)
  {
  }

  std::uint64_t Bits() { return this->Engine(); }

  /// Uniform in [0, 1).
  double Uniform() { return std::ldexp(static_cast<double>(this->Engine() >> 11), -53); }
  double Uniform(double lower, double upper) { return lower + (upper - lower) * this->Uniform(); }
  /// 10 to a power that is uniform between the two arguments.
  double PowerOfTen(double lower, double upper)
  {
    return std::pow(10.0, this->Uniform(lower, upper));
  }
  /// 0 to @a count - 1.
  int Below(int count)
  {
    return static_cast<int>(this->Engine() % static_cast<std::uint64_t>(count));
  }
  int Integer(int least, int greatest) { return least + this->Below(greatest - least + 1); }
  bool Chance(double probability) { return this->Uniform() < probability; }

  /// In [0, 1], with the exponents of the distances to both ends uniformly distributed.
  double Proportion()
  {
    switch (this->Below(6))
    {
      case 0:
        return this->PowerOfTen(-18.0, 0.0);
      case 1:
        return 1.0 - this->PowerOfTen(-18.0, 0.0);
      case 2:
        return this->Below(2);
      default:
        return this->Uniform();
    }
  }

private:
  std::mt19937_64 Engine;
};

using Corners = std::array<Vector2, 3>;

/// The triangle with base from (0, 0) to (1, 0) and this apex, rotated and scaled, with randomly
/// numbered corners.
inline Corners Moved(RandomNumbers& random, const Vector2& apex, double scale)
{
  const double angle = random.Uniform(0.0, 6.283185307179586);
  // One in four stays axis-parallel, where coordinates are exact.
  const bool turned = random.Chance(0.75);
  const Vector2 u =
    turned ? Vector2{ scale * std::cos(angle), scale * std::sin(angle) } : Vector2{ scale, 0.0 };
  const auto surfacePoint = [&u](const Vector2& p) -> Vector2 {
    return { p.x * u.x - p.y * u.y, p.x * u.y + p.y * u.x };
  };
  const Corners corners{ surfacePoint({ 0.0, 0.0 }), surfacePoint({ 1.0, 0.0 }),
    surfacePoint(apex) };
  const int first = random.Below(3);
  return { corners[first], corners[NextCorner(first)], corners[PreviousCorner(first)] };
}

/// The height over the longest edge is at least a quarter of that edge.
inline Corners FatTriangle(RandomNumbers& random)
{
  const Vector2 apex{ random.Uniform(0.1, 0.9), random.Uniform(0.25, 0.86) };
  return Moved(random, apex, random.PowerOfTen(-0.5, 0.5));
}

/// From fat triangles to needles with a height of a millionth of the longest edge.
inline Corners AnyTriangle(RandomNumbers& random)
{
  return Moved(
    random, { random.Proportion(), random.PowerOfTen(-6.0, -0.07) }, random.PowerOfTen(-3.0, 3.0));
}

inline bool IsConcordant(const Corners& corners)
{
  return homeomorphism::IsConcordant(&corners[0].x, &corners[1].x, &corners[2].x, 2);
}

inline Corners FatConcordantTriangle(RandomNumbers& random)
{
  Corners corners;
  do
  {
    corners = FatTriangle(random);
  } while (!IsConcordant(corners));
  return corners;
}

/// Concordant triangles: fat ones, flat caps and tall needles down to a millionth, and triangles of
/// each kind that one bit separates from discordant ones.
inline Corners ConcordantTriangle(RandomNumbers& random)
{
  for (;;)
  {
    Corners corners;
    const double scale = random.PowerOfTen(-3.0, 3.0);
    const double thin = random.PowerOfTen(-6.0, 0.0);
    const int kind = random.Below(3);
    Vector2 apex;
    if (kind == 0)
    {
      apex = { random.Uniform(-0.5, 1.5), random.Uniform(0.05, 1.5) };
    }
    else if (kind == 1)
    {
      // A flat cap is concordant approximately for |x - 1/2| < 2 thin^2.
      apex = { 0.5 + random.Uniform(-2.5, 2.5) * thin * thin, thin };
    }
    else
    {
      // With the short edge as unit, a tall needle is concordant for -1 < x < 2.
      apex = { random.Chance(0.3) ? 0.5 : random.Uniform(-1.2, 2.2), 1.0 / thin };
    }
    corners = Moved(random, apex, kind == 2 ? scale * thin : scale);
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
inline Neighbor AnyNeighbor(RandomNumbers& random, const EdgeView& own)
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

inline std::array<Neighbor, 3> AnyNeighbors(RandomNumbers& random, const EdgeViews& views)
{
  return { AnyNeighbor(random, views[0]), AnyNeighbor(random, views[1]),
    AnyNeighbor(random, views[2]) };
}

/// Neighbors of a size similar to that of the triangle.
inline std::array<Neighbor, 3> ModerateNeighbors(RandomNumbers& random, const EdgeViews& views)
{
  std::array<Neighbor, 3> neighbors;
  for (int k = 0; k < 3; ++k)
  {
    neighbors[k].Exists = true;
    neighbors[k].View = { views[k].Length, random.Uniform(-0.5, 1.5),
      views[k].Height * random.Uniform(0.3, 3.0) };
  }
  return neighbors;
}

/// Uniform in the triangle.
inline Barycentric AnyBarycentric(RandomNumbers& random)
{
  double x = random.Uniform();
  double y = random.Uniform();
  if (x + y > 1.0)
  {
    x = 1.0 - x;
    y = 1.0 - y;
  }
  return { x, y, 1.0 - x - y };
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
  double nearest = std::numeric_limits<double>::infinity();
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
  using Chart = LinearChart;
  static constexpr const char* Name = "Linear";
  static Corners Any(RandomNumbers& random) { return AnyTriangle(random); }
  static Corners Fat(RandomNumbers& random) { return FatTriangle(random); }
  static Chart Make(RandomNumbers&, const PlaneTriangle& t, bool) { return Chart(t.Shape); }
};

struct ContourSystem
{
  using Chart = ContourChart;
  static constexpr const char* Name = "Contour";
  static Corners Any(RandomNumbers& random) { return ConcordantTriangle(random); }
  static Corners Fat(RandomNumbers& random) { return FatConcordantTriangle(random); }
  static Chart Make(RandomNumbers&, const PlaneTriangle& t, bool)
  {
    return Chart(t.Shape, t.Views());
  }
};

struct IncenterSystem
{
  using Chart = ContourChart;
  static constexpr const char* Name = "Contour from the incenter";
  static Corners Any(RandomNumbers& random) { return AnyTriangle(random); }
  static Corners Fat(RandomNumbers& random) { return FatTriangle(random); }
  static Chart Make(RandomNumbers&, const PlaneTriangle& t, bool)
  {
    return Chart(t.Shape, t.Views(), CenterPoint::Incenter);
  }
};

struct SmoothSystem
{
  using Chart = SmoothChart;
  static constexpr const char* Name = "Smooth";
  static Corners Any(RandomNumbers& random) { return AnyTriangle(random); }
  static Corners Fat(RandomNumbers& random) { return FatTriangle(random); }
  static Chart Make(RandomNumbers& random, const PlaneTriangle& t, bool moderate)
  {
    const EdgeViews views = t.Views();
    return Chart(
      t.Shape, views, moderate ? ModerateNeighbors(random, views) : AnyNeighbors(random, views));
  }
};

/// Names of the typed tests.
struct SystemName
{
  template <typename System>
  static std::string GetName(int)
  {
    std::string name = System::Name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
  }
};

/// The largest |D ToPoint| / longest edge at a reference point, at least 1. This is the factor by
/// which the Smooth chart magnifies the rounding of (e, p, c) beside a sheared or far larger
/// neighbor.
template <typename Chart>
double Magnification(const Chart&, const TriangleShape&, const typename Chart::Reference&)
{
  return 1.0;
}

inline double Magnification(
  const SmoothChart& chart, const TriangleShape& shape, const Barycentric& l)
{
  double largest = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    Barycentric direction{};
    direction[NextCorner(k)] = -1.0;
    direction[PreviousCorner(k)] = 1.0;
    largest = std::max(largest, Norm(chart.Pushforward(l, direction)));
    // Between the directions of the two corners: across the edge.
    direction = { -0.5, -0.5, -0.5 };
    direction[k] = 1.0;
    largest = std::max(largest, Norm(chart.Pushforward(l, direction)));
  }
  return std::max(1.0, largest / shape.Base);
}

/// The largest |D ToReference| times the longest edge. This is the factor by which the Smooth chart
/// magnifies the rounding of a point beside a far smaller neighbor.
template <typename Chart>
double InverseMagnification(const Chart&, const TriangleShape&, const typename Chart::Reference&)
{
  return 1.0;
}

inline double InverseMagnification(
  const SmoothChart& chart, const TriangleShape& shape, const Barycentric& l)
{
  // Use directions of the affine chart, so that the shape of the triangle does not matter.
  double largest = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    Barycentric direction{ -0.5, -0.5, -0.5 };
    direction[k] = 1.0;
    for (const double component : chart.Pullback(l, shape.FromBarycentric(direction)))
    {
      largest = std::max(largest, std::abs(component));
    }
  }
  return std::max(1.0, largest);
}

/// Prints the corners of a triangle and a point of it with all digits.
inline std::string Description(const PlaneTriangle& t, const Vector2& inFrame)
{
  char text[1024];
  std::snprintf(text, sizeof(text),
    "corners (%.17g, %.17g) (%.17g, %.17g) (%.17g, %.17g); shape base %.17g apexX %.17g height "
    "%.17g apex %d; point in frame (%.17g, %.17g)",
    t.Corners[0].x, t.Corners[0].y, t.Corners[1].x, t.Corners[1].y, t.Corners[2].x, t.Corners[2].y,
    t.Shape.Base, t.Shape.ApexX, t.Shape.Height, t.Shape.Apex, inFrame.x, inFrame.y);
  return text;
}

/// The largest of many values, NaN above all, and where it occurs.
class Worst
{
public:
  template <typename Describe>
  void Take(double value, Describe&& describe)
  {
    if (!(value <= this->Value) && !std::isnan(this->Value))
    {
      this->Value = value;
      this->Where = describe();
    }
  }
  void Take(double value, const PlaneTriangle& triangle, const Vector2& point)
  {
    this->Take(value, [&]() { return Description(triangle, point); });
  }
  double Value = 0.0;
  std::string Where;
};

} // namespace homeomorphism_test

#endif
