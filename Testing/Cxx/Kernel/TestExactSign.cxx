// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The predicates agree with 128-bit integer arithmetic, which is exact: coordinates are integers of
// at most 60 bits times a power of two, of which a double holds 53 leading bits.

#include "Fixtures/Triangles.h"

#include "Kernel/ExactSign.h"

#include <gtest/gtest.h>

namespace
{

using namespace homeomorphism_test;

// __extension__ because -Wpedantic rejects this type.
__extension__ using Wide = __int128;

using Point = std::array<std::int64_t, 3>;

/// Three points of the plane or of space, whose coordinates are in units of a power of two.
struct Triple
{
  std::array<Point, 3> Points{};
  int Dimension = 2;
  int Unit = 0;

  std::array<double, 3> ToDouble(int i) const
  {
    std::array<double, 3> result;
    for (int axis = 0; axis < 3; ++axis)
    {
      result[axis] = std::ldexp(static_cast<double>(this->Points[i][axis]), this->Unit);
      // The test requires exactly these numbers.
      EXPECT_EQ(
        static_cast<std::int64_t>(std::ldexp(result[axis], -this->Unit)), this->Points[i][axis]);
    }
    return result;
  }
};

/// Products of two differences stay far from the ends of the exponent range.
int AnyUnit(Random& random)
{
  return std::array<int, 4>{ 0, -52, 380, -420 }[random.Below(4)];
}

Wide Difference(std::int64_t a, std::int64_t b)
{
  return static_cast<Wide>(a) - b;
}

int IntegerOrientation(const std::array<Point, 3>& p)
{
  const Wide area = Difference(p[1][0], p[0][0]) * Difference(p[2][1], p[0][1]) -
    Difference(p[1][1], p[0][1]) * Difference(p[2][0], p[0][0]);
  return area > 0 ? 1 : (area < 0 ? -1 : 0);
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
bool IntegerConcordant(const std::array<Point, 3>& p)
{
  const auto isInside = [&p](int from, int to, int third) {
    const Wide square = Dot3(p[from], p[to], p[from], p[to]);
    const Wide foot = square + Dot3(p[from], p[to], p[from], p[third]);
    return foot > 0 && foot < 3 * square;
  };
  return isInside(0, 1, 2) && isInside(1, 2, 0) && isInside(2, 0, 1);
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

Point AnyPoint(Random& random, int dimension, int bits)
{
  return { AnyInteger(random, bits), AnyInteger(random, bits),
    dimension == 3 ? AnyInteger(random, bits) : 0 };
}

/// In half of the cases one of the three points is moved by one bit in one coordinate: an ulp of
/// the largest coordinates.
void Nudge(Random& random, Triple& triple)
{
  if (random.Chance(0.5))
  {
    return;
  }
  std::int64_t& x = triple.Points[random.Below(3)][random.Below(triple.Dimension)];
  // Below 2^53 the next double is not an integer, but the next integer is exact.
  const int sign = random.Chance(0.5) ? 1 : -1;
  const double moved = std::nextafter(static_cast<double>(x), sign * 1e300);
  x = std::abs(x) < (std::int64_t(1) << 53) ? x + sign : static_cast<std::int64_t>(moved);
}

Triple MakeAnywhere(Random& random)
{
  Triple triple{ {}, random.Integer(2, 3), AnyUnit(random) };
  const int bits = random.Chance(0.5) ? 4 : 60;
  for (Point& point : triple.Points)
  {
    point = AnyPoint(random, triple.Dimension, bits);
  }
  return triple;
}

/// Within a few ulp of the other two's coordinates from the origin.
Point NearTheOrigin(Random& random, int dimension)
{
  return { random.Integer(-512, 512), random.Integer(-512, 512),
    dimension == 3 ? random.Integer(-512, 512) : 0 };
}

/// Exactly collinear, as multiples of one direction that are so small that the sums are doubles, or
/// one bit beside; or one point near the origin, and two far from it on a line through the origin:
/// the rounding errors of the differences decide.
Triple MakeCollinear(Random& random)
{
  Triple triple{ {}, 2, AnyUnit(random) };
  const bool isFar = random.Chance(0.5);
  const Point d = AnyPoint(random, 2, 26);
  const Point start = isFar ? Point{} : AnyPoint(random, 2, 51);
  for (Point& point : triple.Points)
  {
    const std::int64_t factor = (isFar ? 256 : 1) * AnyInteger(random, 25);
    point = { start[0] + factor * d[0], start[1] + factor * d[1], 0 };
  }
  if (isFar)
  {
    triple.Points[0] = NearTheOrigin(random, 2);
  }
  else
  {
    Nudge(random, triple);
  }
  return triple;
}

/// Three corners whose foot on the edge from the first to the second is exactly the first: with u =
/// B - A and v = C - A, u.(u + v) = 0, that is, v = -u + w with w perpendicular to u. u has up to
/// @a bits bits, w is up to @a otherBits bits longer.
Triple OnTheLimit(Random& random, int bits, int otherBits)
{
  Triple triple{ {}, random.Integer(2, 3), AnyUnit(random) };
  Point u = AnyPoint(random, triple.Dimension, bits);
  u[0] += u[0] == 0 && u[1] == 0;
  const Point other = AnyPoint(random, 3, otherBits);
  const Point w = triple.Dimension == 2
    ? Point{ -u[1] * other[0], u[0] * other[0], 0 }
    : Point{ u[1] * other[2] - u[2] * other[1], u[2] * other[0] - u[0] * other[2],
        u[0] * other[1] - u[1] * other[0] };
  triple.Points.fill(AnyPoint(random, triple.Dimension, 52));
  for (int i = 0; i < 3; ++i)
  {
    triple.Points[1][i] += u[i];
    triple.Points[2][i] += w[i] - u[i];
  }
  return triple;
}

Triple MakeAtTheLimit(Random& random)
{
  Triple triple = OnTheLimit(random, random.Integer(3, 25), 25);
  EXPECT_FALSE(IntegerConcordant(triple.Points));
  Nudge(random, triple);
  return triple;
}

/// Two corners far from the origin, the third within a few of their ulps of it. The differences of
/// coordinates are rounded, and their rounding errors decide.
Triple MakeAtTheLimitFarAway(Random& random)
{
  Triple triple = random.Chance(0.5) ? OnTheLimit(random, 48, 1) : OnTheLimit(random, 25, 25);
  auto& p = triple.Points;
  for (int i = 0; i < 3; ++i)
  {
    p[1][i] = 256 * (p[1][i] - p[0][i]);
    p[2][i] = 256 * (p[2][i] - p[0][i]);
  }
  p[0] = NearTheOrigin(random, triple.Dimension);
  std::rotate(p.begin(), p.begin() + random.Integer(0, 2), p.end());
  return triple;
}

/// In every order of the three points.
void ExpectExact(const Triple& triple, int orientation, bool isConcordant)
{
  const std::array<std::array<double, 3>, 3> p{ triple.ToDouble(0), triple.ToDouble(1),
    triple.ToDouble(2) };
  for (int first = 0; first < 3; ++first)
  {
    for (const int sense : { 1, -1 })
    {
      const auto& a = p[first];
      const auto& b = p[(first + 3 + sense) % 3];
      const auto& c = p[(first + 3 - sense) % 3];
      EXPECT_EQ(
        homeomorphism::IsConcordant(a.data(), b.data(), c.data(), triple.Dimension), isConcordant);
      if (triple.Dimension == 2)
      {
        const std::array<Vector2, 3> v{ Vector2{ a[0], a[1] }, { b[0], b[1] }, { c[0], c[1] } };
        EXPECT_EQ(Orientation(v[0], v[1], v[2]), sense * orientation);
        // Without the floating-point filter.
        EXPECT_EQ(ExactOrientation(v[0], v[1], v[2]), sense * orientation);
      }
    }
  }
}

TEST(ExactSign, OrientationAndConcordanceAreExact)
{
  struct Family
  {
    const char* Name;
    Triple (*Make)(Random&);
    int LeastOfEachOrientation;
    int LeastConcordant;
  };
  for (const Family& family :
    { Family{ "anywhere", MakeAnywhere, 10000, 1000 }, { "collinear", MakeCollinear, 20000, 0 },
      { "limit of concordance, or one bit beside", MakeAtTheLimit, 10000, 5000 },
      { "limit of concordance to rounding", MakeAtTheLimitFarAway, 10000, 10000 } })
  {
    SCOPED_TRACE(family.Name);
    Random random(12);
    std::array<int, 3> orientations{};
    int concordant = 0;
    for (int n = 0; n < 100000; ++n)
    {
      const Triple triple = family.Make(random);
      const int orientation = IntegerOrientation(triple.Points);
      const bool isConcordant = IntegerConcordant(triple.Points);
      ExpectExact(triple, orientation, isConcordant);
      ++orientations[orientation + 1];
      concordant += isConcordant;
    }
    // No result may be rare.
    EXPECT_GE(std::min(orientations[0], orientations[2]), family.LeastOfEachOrientation);
    EXPECT_GE(concordant, family.LeastConcordant);
    EXPECT_GE(100000 - concordant, 10000);
  }
}

} // namespace
