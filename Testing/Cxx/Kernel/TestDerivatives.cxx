// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The closed-form derivatives agree with finite differences, are inverse to each other, and satisfy
// the definition of the Contour system.

#include "RandomTriangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace
{

using namespace homeomorphism_test;

template <typename System>
struct Domain
{
  PlaneTriangle Triangle;
  typename System::Chart Chart;

  Domain(RandomNumbers& random, bool fat)
    : Triangle(fat ? System::Fat(random) : System::Any(random))
    , Chart(System::Make(random, this->Triangle, fat))
  {
  }
};

/// The region, of those in which a chart is one analytic function, that contains a point.
int RegionOf(const LinearChart&, const TriangleShape&, const Vector2&)
{
  return 0;
}

int RegionOf(const ContourChart& chart, const TriangleShape& shape, const Vector2& point)
{
  const TriangularCoordinates coordinates = chart.ToReference(point);
  const int k = coordinates.Edge - 1;
  const Vector2 foot = chart.Foot(coordinates.Edge);
  const Vector2 center = chart.Center();
  // Before or after the center segment, above or below the wing segment on that side.
  const bool isBefore = Cross(center - foot, point - foot) > 0.0;
  const Vector2 corner = shape.Corner(isBefore ? NextCorner(k) : PreviousCorner(k));
  const Vector2 middle = 0.5 * (center + foot);
  const bool isStraight = (Cross(corner - middle, point - middle) > 0.0) ==
    (Cross(corner - middle, center - middle) > 0.0);
  return 4 * k + 2 * isBefore + isStraight;
}

int RegionOf(const SmoothChart& chart, const TriangleShape&, const Vector2& point)
{
  const Barycentric l = chart.ToReference(point);
  for (int k = 0; k < 3; ++k)
  {
    const double i = l[NextCorner(k)];
    const double j = l[PreviousCorner(k)];
    if (l[k] * (i + j) < chart.StripWidth(k) * i * j)
    {
      return k;
    }
  }
  return 3;
}

template <typename Chart>
Vector2 CenterOf(const Chart&, const TriangleShape& shape)
{
  return shape.FromBarycentric({ 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 });
}

Vector2 CenterOf(const ContourChart& chart, const TriangleShape&)
{
  return chart.Center();
}

struct Quotient
{
  Vector2 Value;
  /// The change made by the last extrapolation, which is far larger than the remaining error.
  double Change;
};

/// Column @a axis of the derivative of the map, by central differences with the steps h, h / 2 and
/// h / 4, extrapolated twice: the error is of order h^6. False if the points used are not in one
/// region of either triangle, or too close to the center or to a vertex, where derivatives grow.
template <typename System>
bool Differences(const Domain<System>& from, const Domain<System>& to, const Vector2& point,
  int axis, Quotient& result)
{
  const TriangleShape& shape = from.Triangle.Shape;
  const double h = 2e-4 * shape.Base;
  const auto region = [&from, &to](const Vector2& x) {
    return std::array<int, 2>{ RegionOf(from.Chart, from.Triangle.Shape, x),
      RegionOf(to.Chart, to.Triangle.Shape, MapPoint(from.Chart, to.Chart, x)) };
  };
  const auto away = [&shape, h](const Vector2& x, const Vector2& special) {
    return Norm(x - special) > 200.0 * h;
  };
  if (!away(point, CenterOf(from.Chart, shape)) || !away(point, shape.Corner(0)) ||
    !away(point, shape.Corner(1)) || !away(point, shape.Corner(2)))
  {
    return false;
  }
  std::array<Vector2, 3> quotients;
  for (int i = 0; i < 3; ++i)
  {
    const double step = std::ldexp(h, -i);
    const Vector2 offset = axis == 0 ? Vector2{ step, 0.0 } : Vector2{ 0.0, step };
    for (const Vector2& x : { point + offset, point - offset })
    {
      for (int k = 0; k < 3; ++k)
      {
        if (Cross(shape.Corner(PreviousCorner(k)) - shape.Corner(NextCorner(k)),
              x - shape.Corner(NextCorner(k))) <= 0.0)
        {
          return false;
        }
      }
      if (region(x) != region(point))
      {
        return false;
      }
    }
    quotients[i] = (0.5 / step) *
      (MapPoint(from.Chart, to.Chart, point + offset) -
        MapPoint(from.Chart, to.Chart, point - offset));
  }
  const Vector2 first = quotients[1] + (1.0 / 3.0) * (quotients[1] - quotients[0]);
  const Vector2 second = quotients[2] + (1.0 / 3.0) * (quotients[2] - quotients[1]);
  result = { second + (1.0 / 15.0) * (second - first), Norm(second - first) };
  return true;
}

template <typename System>
class Derivatives : public testing::Test
{
};

using Systems = testing::Types<LinearSystem, ContourSystem, IncenterSystem, SmoothSystem>;

TYPED_TEST_SUITE(Derivatives, Systems, SystemName);

TYPED_TEST(Derivatives, AgreeWithFiniteDifferences)
{
  RandomNumbers random(41);
  Worst worst;
  int compared = 0;
  int sharp = 0;
  for (int n = 0; n < 4000; ++n)
  {
    const Domain<TypeParam> p(random, true);
    const Domain<TypeParam> q(random, true);
    for (int i = 0; i < 5; ++i)
    {
      const Vector2 point = p.Triangle.Shape.FromBarycentric(AnyBarycentric(random));
      std::array<Quotient, 2> found;
      if (!Differences(p, q, point, 0, found[0]) || !Differences(p, q, point, 1, found[1]))
      {
        continue;
      }
      ++compared;
      const Matrix2 derivative = MapDerivative(p.Chart, q.Chart, p.Chart.ToReference(point));
      const double norm = Norm(derivative);
      const double error = Norm(Matrix2{ found[0].Value, found[1].Value } - derivative) / norm;
      const double change = std::max(found[0].Change, found[1].Change) / norm;
      // Beside an edge and a wing segment the derivative may change within a few steps. Elsewhere
      // the step is so small that only rounding matters, an ulp divided by the step.
      sharp += change < 1e-9;
      const double allowed = change + 64.0 * Ulp / 5e-5;
      worst.Take(error / allowed, p.Triangle, point);
    }
  }
  EXPECT_GT(compared, 15000);
  EXPECT_GT(sharp, 0.9 * compared);
  EXPECT_LT(worst.Value, 0.2) << worst.Where;
}

TYPED_TEST(Derivatives, PullbackIsTheInverseOfPushforward)
{
  RandomNumbers random(42);
  Worst worst;
  for (int n = 0; n < 20000; ++n)
  {
    const Domain<TypeParam> p(random, false);
    for (int i = 0; i < 5; ++i)
    {
      const Vector2 point = p.Triangle.Shape.FromBarycentric(AnyBarycentric(random));
      const auto reference = p.Chart.ToReference(point);
      // Contour directions are measured against p, whose unit is the edge, which may be short. The
      // error is therefore relative to the largest component.
      const Matrix2 identity = MapDerivative(p.Chart, p.Chart, reference);
      const double error = Norm(identity - Matrix2{ { 1.0, 0.0 }, { 0.0, 1.0 } });
      const double condition = p.Triangle.Shape.Base / p.Triangle.Shape.Height *
        Magnification(p.Chart, p.Triangle.Shape, reference) *
        InverseMagnification(p.Chart, p.Triangle.Shape, reference);
      worst.Take(error / (Ulp * condition), p.Triangle, point);
    }
  }
  EXPECT_LT(worst.Value, 64.0) << worst.Where;
}

TYPED_TEST(Derivatives, DeterminantIsPositive)
{
  RandomNumbers random(43);
  for (int n = 0; n < 40000; ++n)
  {
    const Domain<TypeParam> p(random, false);
    const Domain<TypeParam> q(random, false);
    for (int i = 0; i < 5; ++i)
    {
      // Inside, on the edges, near the corners and along contours near the center.
      const double c = random.Chance(0.3) ? 1.0 : random.Uniform();
      const TriangularCoordinates coordinates{ random.Integer(1, 3),
        random.Uniform(1e-9, 1.0 - 1e-9), random.Chance(0.2) ? 1e-9 * c : c };
      const auto reference = p.Chart.FromCoordinates(coordinates);
      const Matrix2 derivative = MapDerivative(p.Chart, q.Chart, reference);
      // Negated so that NaN fails.
      ASSERT_TRUE(derivative.Determinant() > 0.0)
        << Description(p.Triangle, p.Chart.ToPoint(reference)) << " to "
        << Description(q.Triangle, {});
    }
  }
}

template <typename System>
class ContourDerivatives : public testing::Test
{
};

using ContourSystems = testing::Types<ContourSystem, IncenterSystem>;
TYPED_TEST_SUITE(ContourDerivatives, ContourSystems, SystemName);

TYPED_TEST(ContourDerivatives, ContourIsStraightThenAnArcAtARightAngle)
{
  RandomNumbers random(45);
  for (int n = 0; n < 5000; ++n)
  {
    const Domain<TypeParam> p(random, true);
    const TriangleShape& shape = p.Triangle.Shape;
    const int e = random.Integer(1, 3);
    const double t = random.Uniform(0.01, 0.99);
    const double length = p.Chart.ContourLength(e, t);
    const Vector2 edge = shape.Corner(PreviousCorner(e - 1)) - shape.Corner(NextCorner(e - 1));
    const Vector2 tangent = (1.0 / Norm(edge)) * edge;
    const auto speed = [&](double c) { return p.Chart.Pushforward({ e, t, c }, { 1.0, 0.0 }); };
    // Arc length is proportional to the parameter, and at the edge the contour is perpendicular to
    // it.
    for (const double c : { 0.0, random.Uniform(), 1.0 })
    {
      EXPECT_NEAR(Norm(speed(c)), length, 1e-13 * length);
    }
    EXPECT_NEAR(Dot(speed(1.0), tangent), 0.0, 1e-13 * length);
    EXPECT_LT(Cross(tangent, speed(1.0)), 0.0);
    // The contour starts at the center and is straight up to the wing segment.
    const Vector2 start = p.Chart.ToPoint({ e, t, 0.0 });
    EXPECT_LT(Norm(start - p.Chart.Center()), 1e-14 * shape.Base);

    // The contour meets the wing segment where its direction starts to turn. Half of the turning is
    // reached in the middle of the arc, so the length of the arc follows from its radius. The only
    // assumption is that the direction turns at a constant rate from some c to 1.
    const Vector2 first = speed(0.0);
    const double turn = std::abs(std::atan2(Cross(first, speed(1.0)), Dot(first, speed(1.0))));
    constexpr double nearEnd = 0.999;
    const double turned =
      std::abs(std::atan2(Cross(speed(nearEnd), speed(1.0)), Dot(speed(nearEnd), speed(1.0))));
    const double cOfWing = 1.0 - (1.0 - nearEnd) * turn / turned;
    if (turn < 1e-6 || cOfWing > 0.99)
    {
      continue;
    }
    const Vector2 foot = p.Chart.Foot(e);
    const Vector2 middle = 0.5 * (p.Chart.Center() + foot);
    const Vector2 end = p.Chart.ToPoint({ e, t, 1.0 });
    const bool isBefore = Dot(end - foot, tangent) < 0.0;
    const Vector2 corner = shape.Corner(isBefore ? NextCorner(e - 1) : PreviousCorner(e - 1));
    const Vector2 wing = p.Chart.ToPoint({ e, t, cOfWing });
    EXPECT_NEAR(
      Cross(corner - middle, wing - middle) / Norm(corner - middle), 0.0, 1e-8 * shape.Base);
    // The contour is straight before that point.
    const Vector2 before = speed(0.99 * cOfWing);
    EXPECT_NEAR(Cross(first, before), 0.0, 1e-13 * length * length);
  }
}

} // namespace
