// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The predicates agree with 128-bit integer arithmetic, which is exact: coordinates are integers of
// at most 60 bits times a power of two, of which a double holds 53 leading bits.

#include "Fixtures/Triangles.h"

#include "Kernel/ExactSign.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace
{

using namespace homeomorphism_test;

// __extension__ because -Wpedantic rejects this type.
__extension__ using Wide = __int128;

using Point = std::array<std::int64_t, 3>;

/// Coordinates are multiples of this power of two. Products of two differences stay far from the
/// ends of the exponent range.
constexpr std::array<int, 4> units{ 0, -52, 380, -420 };

std::array<double, 3> ToDouble(const Point& p, int unit)
{
  std::array<double, 3> result;
  for (int i = 0; i < 3; ++i)
  {
    result[i] = std::ldexp(static_cast<double>(p[i]), unit);
    // The test requires exactly these numbers.
    EXPECT_EQ(static_cast<std::int64_t>(std::ldexp(result[i], -unit)), p[i]);
  }
  return result;
}

int SignOf(Wide value)
{
  return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

Wide Difference(std::int64_t a, std::int64_t b)
{
  return static_cast<Wide>(a) - b;
}

int IntegerOrientation(const Point& a, const Point& b, const Point& c)
{
  return SignOf(Difference(b[0], a[0]) * Difference(c[1], a[1]) -
    Difference(b[1], a[1]) * Difference(c[0], a[0]));
}

Wide Dot3(const Point& a, const Point& b, const Point& c, const Point& d)
{
  Wide sum = 0;
  for (int i = 0; i < 3; ++i)
  {
    sum += Difference(b[i], a[i]) * Difference(d[i], c[i]);
  }
  return sum;
}

/// By the definition, times 3: 0 < (A + B + C - 3 A).(B - A) < 3 |B - A|^2.
bool IntegerConcordant(const Point& a, const Point& b, const Point& c)
{
  const auto isInside = [](const Point& from, const Point& to, const Point& third) {
    const Wide square = Dot3(from, to, from, to);
    const Wide foot = square + Dot3(from, to, from, third);
    return foot > 0 && foot < 3 * square;
  };
  return isInside(a, b, c) && isInside(b, c, a) && isInside(c, a, b);
}

bool KernelConcordant(const Point& a, const Point& b, const Point& c, int dimension, int unit)
{
  return homeomorphism::IsConcordant(
    ToDouble(a, unit).data(), ToDouble(b, unit).data(), ToDouble(c, unit).data(), dimension);
}

int KernelOrientation(const Point& a, const Point& b, const Point& c, int unit)
{
  const auto inPlane = [unit](const Point& p) {
    const std::array<double, 3> x = ToDouble(p, unit);
    return Vector2{ x[0], x[1] };
  };
  const Vector2 p = inPlane(a);
  const Vector2 q = inPlane(b);
  const Vector2 r = inPlane(c);
  const int sign = Orientation(p, q, r);
  // The floating-point filter must agree with the exact evaluation.
  EXPECT_EQ(ExactOrientation(p, q, r), sign);
  return sign;
}

/// An integer with at most @a bits bits, often small, of which at most 53 bits are not trailing
/// zeros.
std::int64_t AnyInteger(Random& random, int bits)
{
  const int used = random.Integer(1, std::min(bits, 53));
  const int shift = random.Below(bits - used + 1);
  const auto magnitude = static_cast<std::int64_t>(random.Bits() >> (64 - used)) << shift;
  return random.Chance(0.5) ? magnitude : -magnitude;
}

/// One of the three points, moved by one bit in one coordinate: an ulp of the largest coordinates.
void Nudge(Random& random, std::array<Point, 3>& points, int dimension)
{
  std::int64_t& x = points[random.Below(3)][random.Below(dimension)];
  const double moved = std::nextafter(static_cast<double>(x), random.Chance(0.5) ? 1e300 : -1e300);
  // Below 2^53 the next double is not an integer. The next integer is exact too.
  const auto asInteger = static_cast<std::int64_t>(moved);
  x = asInteger != x ? asInteger : x + (random.Chance(0.5) ? 1 : -1);
}

void ExpectConcordance(const std::array<Point, 3>& p, int dimension, int unit)
{
  const bool expected = IntegerConcordant(p[0], p[1], p[2]);
  for (int first = 0; first < 3; ++first)
  {
    const Point& a = p[first];
    const Point& b = p[NextCorner(first)];
    const Point& c = p[PreviousCorner(first)];
    EXPECT_EQ(KernelConcordant(a, b, c, dimension, unit), expected);
    EXPECT_EQ(KernelConcordant(b, a, c, dimension, unit), expected);
  }
}

/// Three points with coordinates in units of a power of two.
struct ScaledPoints
{
  std::array<Point, 3> Points;
  int Unit;
};

/// The signs of many triples are exact; neither may be rare.
template <typename Make>
void ExpectExactOrientations(std::uint64_t seed, Make&& make)
{
  Random random(seed);
  std::array<int, 3> seen{};
  int wrongWithout = 0;
  for (int n = 0; n < 100000; ++n)
  {
    const ScaledPoints scaled = make(random);
    const std::array<Point, 3>& p = scaled.Points;
    const int expected = IntegerOrientation(p[0], p[1], p[2]);
    for (int first = 0; first < 3; ++first)
    {
      const Point& a = p[first];
      const Point& b = p[NextCorner(first)];
      const Point& c = p[PreviousCorner(first)];
      EXPECT_EQ(KernelOrientation(a, b, c, scaled.Unit), expected);
      EXPECT_EQ(KernelOrientation(b, a, c, scaled.Unit), -expected);
    }
    ++seen[expected + 1];
    // A plain evaluation in doubles.
    std::array<std::array<double, 3>, 3> x;
    std::transform(p.begin(), p.end(), x.begin(),
      [&scaled](const Point& point) { return ToDouble(point, scaled.Unit); });
    const double plain =
      x[0][0] * (x[1][1] - x[2][1]) + x[1][0] * (x[2][1] - x[0][1]) + x[2][0] * (x[0][1] - x[1][1]);
    wrongWithout += ((plain > 0.0) - (plain < 0.0)) != expected;
  }
  EXPECT_GT(seen[0], 10000);
  EXPECT_GT(seen[2], 10000);
  EXPECT_GT(wrongWithout, 10);
}

Point AnyPoint(Random& random, int dimension, int bits)
{
  Point point{ AnyInteger(random, bits), AnyInteger(random, bits), 0 };
  point[2] = dimension == 3 ? AnyInteger(random, bits) : 0;
  return point;
}

TEST(ExactSign, OrientationIsExact)
{
  // Anywhere; and exactly collinear, as multiples of one direction that are so small that the sums
  // are doubles, with one bit changed in half of the cases.
  ExpectExactOrientations(12, [](Random& random) {
    ScaledPoints scaled{ {}, units[random.Below(4)] };
    const bool anywhere = random.Chance(0.2);
    const Point d = AnyPoint(random, 2, 26);
    const Point start = AnyPoint(random, 2, 51);
    for (Point& point : scaled.Points)
    {
      const std::int64_t factor = AnyInteger(random, 25);
      point = anywhere ? AnyPoint(random, 2, 60)
                       : Point{ start[0] + factor * d[0], start[1] + factor * d[1], 0 };
    }
    if (random.Chance(0.5))
    {
      Nudge(random, scaled.Points, 2);
    }
    return scaled;
  });
}

TEST(ExactSign, OrientationOfRoundedPointsOnALineIsExact)
{
  ExpectExactOrientations(13, [](Random& random) {
    ScaledPoints scaled{ {}, -52 };
    const double dx = random.Uniform(-1.0, 1.0);
    const double dy = random.Uniform(-1.0, 1.0);
    for (Point& point : scaled.Points)
    {
      // In [1, 2), where one ulp is 2^-52.
      const double t = 0.4 * random.Uniform(-1.0, 1.0);
      point = { static_cast<std::int64_t>(std::ldexp(1.5 + t * dx, 52)),
        static_cast<std::int64_t>(std::ldexp(1.5 + t * dy, 52)), 0 };
    }
    return scaled;
  });
}

TEST(ExactSign, OrientationFromRoundedDifferencesIsExact)
{
  // One point near the origin, two far from it on a line through the origin: the rounding errors of
  // the differences decide.
  ExpectExactOrientations(19, [](Random& random) {
    ScaledPoints scaled{ {}, units[random.Below(4)] };
    const Point d = AnyPoint(random, 2, 26);
    scaled.Points[0] = { random.Integer(-512, 512), random.Integer(-512, 512), 0 };
    for (const int k : { 1, 2 })
    {
      const std::int64_t factor = 256 * AnyInteger(random, 25);
      scaled.Points[k] = { factor * d[0], factor * d[1], 0 };
    }
    return scaled;
  });
}

TEST(ExactSign, ConcordanceIsExact)
{
  Random random(14);
  int concordant = 0;
  for (int n = 0; n < 100000; ++n)
  {
    const int dimension = random.Integer(2, 3);
    const int bits = random.Chance(0.5) ? 4 : 60;
    std::array<Point, 3> p{};
    for (Point& point : p)
    {
      point = AnyPoint(random, dimension, bits);
    }
    ExpectConcordance(p, dimension, units[random.Below(4)]);
    concordant += IntegerConcordant(p[0], p[1], p[2]);
  }
  EXPECT_GT(concordant, 1000);
}

/// Three corners whose foot on the edge from the first to the second is exactly the first: with u =
/// B - A and v = C - A, u.(u + v) = 0, that is, v = -u + w with w perpendicular to u. u has up to
/// @a bits bits, w is up to @a otherBits bits longer.
std::array<Point, 3> OnTheLimit(Random& random, int dimension, int bits, int otherBits)
{
  const Point a = AnyPoint(random, dimension, 52);
  Point u = AnyPoint(random, dimension, bits);
  u[0] += u[0] == 0 && u[1] == 0;
  const Point other = AnyPoint(random, 3, otherBits);
  const Point w = dimension == 2
    ? Point{ -u[1] * other[0], u[0] * other[0], 0 }
    : Point{ u[1] * other[2] - u[2] * other[1], u[2] * other[0] - u[0] * other[2],
        u[0] * other[1] - u[1] * other[0] };
  std::array<Point, 3> p{ a, a, a };
  for (int i = 0; i < 3; ++i)
  {
    p[1][i] += u[i];
    p[2][i] += w[i] - u[i];
  }
  return p;
}

TEST(ExactSign, ConcordanceAtTheLimitIsExact)
{
  Random random(15);
  std::array<int, 2> seen{};
  for (int n = 0; n < 100000; ++n)
  {
    const int dimension = random.Integer(2, 3);
    std::array<Point, 3> p = OnTheLimit(random, dimension, random.Integer(3, 25), 25);
    EXPECT_FALSE(IntegerConcordant(p[0], p[1], p[2]));
    const int unit = units[random.Below(4)];
    ExpectConcordance(p, dimension, unit);
    Nudge(random, p, dimension);
    ExpectConcordance(p, dimension, unit);
    ++seen[IntegerConcordant(p[0], p[1], p[2])];
  }
  EXPECT_GT(seen[0], 10000);
  EXPECT_GT(seen[1], 10000);
}

TEST(ExactSign, ConcordanceFromRoundedDifferencesIsExact)
{
  // Two corners far from the origin, the third within a few of their ulps of it. The differences of
  // coordinates are rounded, and their rounding errors decide.
  Random random(19);
  std::array<int, 2> concordances{};
  for (int n = 0; n < 100000; ++n)
  {
    const int dimension = random.Integer(2, 3);
    std::array<Point, 3> p = random.Chance(0.5) ? OnTheLimit(random, dimension, 48, 1)
                                                : OnTheLimit(random, dimension, 25, 25);
    constexpr std::int64_t far = 256;
    const Point origin = p[0];
    const int last = random.Integer(0, 2);
    for (int i = 0; i < 3; ++i)
    {
      p[0][i] = i < dimension ? random.Integer(-512, 512) : 0;
      p[1][i] = far * (p[1][i] - origin[i]);
      p[2][i] = far * (p[2][i] - origin[i]);
    }
    std::rotate(p.begin(), p.begin() + last, p.end());
    const int unit = units[random.Below(4)];
    ExpectConcordance(p, dimension, unit);
    ++concordances[IntegerConcordant(p[0], p[1], p[2])];
  }
  EXPECT_GT(concordances[0], 10000);
  EXPECT_GT(concordances[1], 10000);
}

} // namespace
