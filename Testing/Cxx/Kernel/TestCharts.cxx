// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Charts of all systems: round trips from a point to its coordinates and back, for triangles of all
// shapes, on and within a few ulp of every line at which the formulas change; edges, on which
// coordinates are proportional to lengths; and derivatives. See TestReferenceValues for values.

#include "Fixtures/Triangles.h"

#include <gtest/gtest.h>

namespace
{

using namespace homeomorphism_test;

/// A point on a line of a triangle, in its frame, at which the formulas of the chart change.
Vector2 OnLineOf(const LinearChart&, const TriangleShape& shape, int k, double proportion)
{
  // A spoke.
  Barycentric l;
  l.fill((1.0 - proportion) / 3.0);
  l[k] += proportion;
  return shape.FromBarycentric(l);
}

Vector2 OnLineOf(const ContourChart& chart, const TriangleShape& shape, int k, double proportion)
{
  // A spoke, a center segment or a wing segment.
  const Vector2 foot = chart.Foot(k + 1);
  const Vector2 middle = 0.5 * (chart.Center() + foot);
  const auto between = [proportion](const Vector2& a, const Vector2& b) {
    return (1.0 - proportion) * a + proportion * b;
  };
  const std::array<Vector2, 4> lines{ between(chart.Center(), shape.Corner(k)),
    between(chart.Center(), foot), between(middle, shape.Corner(NextCorner(k))),
    between(middle, shape.Corner(PreviousCorner(k))) };
  return lines[static_cast<std::size_t>(1024.0 * proportion) % 4];
}

Vector2 OnLineOf(const SmoothChart& chart, const TriangleShape& shape, int k, double proportion)
{
  // The border of a strip, or a line at which (e, p, c) changes formula in the equilateral
  // triangle, where coordinates are computed.
  if (static_cast<int>(4096.0 * proportion) % 2 == 0 && chart.StripWidth(k) > 0.0)
  {
    return shape.FromBarycentric(OnStripBorder(k, chart.StripWidth(k), proportion));
  }
  const TriangleShape& equilateral = ContourChart::EquilateralShape();
  return chart.ToPoint(
    equilateral.ToBarycentric(OnLineOf(ContourChart::Equilateral(), equilateral, k, proportion)));
}

/// A point of the closed triangle, or outside by a few ulp.
template <typename Chart>
Vector2 AnyPoint(Random& random, const TriangleShape& shape, const Chart& chart)
{
  const int kind = random.Below(8);
  if (kind <= 1)
  {
    return shape.FromBarycentric(random.Weights());
  }
  const int k = random.Below(3);
  const double proportion = random.Proportion();
  if (kind == 2)
  {
    // Anywhere near an edge or a corner.
    const double c = 1.0 - random.PowerOfTen(-18.0, 0.0);
    return shape.FromBarycentric(LinearChart(shape).FromCoordinates({ k + 1, proportion, c }));
  }
  Vector2 point = shape.Corner(k);
  if (kind > 3)
  {
    point = random.Chance(0.3)
      ? (1.0 - proportion) * point + proportion * shape.Corner(NextCorner(k))
      : OnLineOf(chart, shape, k, proportion);
  }
  if (kind == 4)
  {
    return point;
  }
  if (kind <= 6)
  {
    // An ulp of the coordinates themselves.
    return { MovedByUlps(point.x, random.Integer(-4, 4)),
      MovedByUlps(point.y, random.Integer(-4, 4)) };
  }
  // An ulp of coordinates as large as the triangle, as left by a translation.
  const double unit = 0.5 * Ulp * shape.Base;
  return { point.x + unit * random.Integer(-4, 4), point.y + unit * random.Integer(-4, 4) };
}

template <typename System>
struct Domain
{
  PlaneTriangle Triangle;
  typename System::Chart Chart;

  explicit Domain(Random& random)
    : Triangle(System::Any(random))
    , Chart(System::Make(random, this->Triangle))
  {
  }
};

template <typename System>
class Charts : public testing::Test
{
};

using Systems = testing::Types<LinearSystem, ContourSystem, IncenterSystem, SmoothSystem>;

TYPED_TEST_SUITE(Charts, Systems, SystemName);

TYPED_TEST(Charts, PointToCoordinatesToPoint)
{
  constexpr int triangles = 6000;
  constexpr int pointsPerTriangle = 100;
  Random random(21);
  for (int n = 0; n < triangles; ++n)
  {
    const Domain<TypeParam> domain(random);
    const PlaneTriangle& triangle = domain.Triangle;
    const TriangleShape& shape = triangle.Shape;
    const auto& chart = domain.Chart;
    for (int i = 0; i < pointsPerTriangle; ++i)
    {
      const Vector2 point = AnyPoint(random, shape, chart);
      // A point outside by rounding is replaced by the nearest point of the triangle.
      const double outside = DistanceOutside(shape, point);
      const auto reference = chart.ToReference(point);
      const Vector2 back = chart.ToPoint(reference);
      ASSERT_LE((Norm(back - point) - outside) / shape.Base, 1e-14) << Description(triangle, point);

      const TriangularCoordinates coordinates = chart.ToCoordinates(reference);
      EXPECT_TRUE(coordinates.Edge >= 1 && coordinates.Edge <= 3);
      EXPECT_TRUE(coordinates.EdgeParameter >= 0.0 && coordinates.EdgeParameter <= 1.0);
      EXPECT_TRUE(coordinates.ContourParameter >= 0.0 && coordinates.ContourParameter <= 1.0);
      const auto again = chart.FromCoordinates(coordinates);
      const double magnification = std::max(
        Magnification(chart, shape, reference).Forward, Magnification(chart, shape, again).Forward);
      ASSERT_LE(
        (Norm(chart.ToPoint(again) - point) - outside) / (shape.Base * magnification), 1e-14)
        << Description(triangle, point);
    }
  }
}

TYPED_TEST(Charts, PointOnAnEdgeHasItsCoordinates)
{
  Random random(32);
  // Smooth computes its coordinates in the equilateral triangle, whose sides are not on the x axis.
  const bool isExactOnBase = std::string(TypeParam::Name) != SmoothSystem::Name;
  for (int n = 0; n < 20000; ++n)
  {
    const Domain<TypeParam> p(random);
    const TriangleShape& shape = p.Triangle.Shape;
    for (int k = 0; k < 3; ++k)
    {
      const double t = random.Uniform(0.001, 0.999);
      const Vector2 start = shape.Corner(NextCorner(k));
      const Vector2 end = shape.Corner(PreviousCorner(k));
      const Vector2 point = (1.0 - t) * start + t * end;
      const auto reference = p.Chart.ToReference(point);
      const TriangularCoordinates found = p.Chart.ToCoordinates(reference);
      ASSERT_EQ(found.Edge, k + 1);
      // The position of the point is known to an ulp of the longest edge.
      const double rounding = Ulp * shape.Base * Magnification(p.Chart, shape, reference).Inverse;
      ASSERT_LT(std::abs(found.EdgeParameter - t) * Norm(end - start), 16.0 * rounding)
        << Description(p.Triangle, point);
      // The contour may be as short as the height of the triangle.
      ASSERT_LT((1.0 - found.ContourParameter) * shape.Height, 16.0 * rounding)
        << Description(p.Triangle, point);
      ASSERT_TRUE(k != shape.Apex || !isExactOnBase || found.ContourParameter == 1.0);
    }
    // In coordinates all edges are exact: c = 1 is on the edge, at p.
    const int e = random.Integer(1, 3);
    const double t = random.Proportion();
    const Vector2 expected =
      (1.0 - t) * shape.Corner(NextCorner(e - 1)) + t * shape.Corner(PreviousCorner(e - 1));
    const auto reference = p.Chart.FromCoordinates({ e, t, 1.0 });
    const Vector2 found = p.Chart.ToPoint(reference);
    const double rounding = Ulp * shape.Base * Magnification(p.Chart, shape, reference).Forward;
    ASSERT_LT(Norm(found - expected), 16.0 * rounding) << Description(p.Triangle, expected);
  }
}

TYPED_TEST(Charts, DerivativesAreInverseToEachOtherAndKeepOrientation)
{
  Random random(42);
  for (int n = 0; n < 40000; ++n)
  {
    const Domain<TypeParam> p(random);
    const Domain<TypeParam> q(random);
    for (int i = 0; i < 5; ++i)
    {
      // Inside, on the edges, near the corners and along contours near the center.
      const double c = random.Chance(0.3) ? 1.0 : random.Uniform();
      const auto reference = p.Chart.FromCoordinates({ random.Integer(1, 3),
        random.Uniform(1e-9, 1.0 - 1e-9), random.Chance(0.2) ? 1e-9 * c : c });
      const Vector2 point = p.Chart.ToPoint(reference);
      const Matrix2 derivative = MapDerivative(p.Chart, q.Chart, reference);
      // Negated so that NaN fails.
      ASSERT_TRUE(derivative.Determinant() > 0.0)
        << Description(p.Triangle, point) << " to " << Description(q.Triangle, {});
      // Contour directions are measured against p, whose unit is the edge, which may be short. The
      // error is therefore relative to the largest component.
      const Matrix2 identity = MapDerivative(p.Chart, p.Chart, reference);
      const double error = Norm(identity - Matrix2{ { 1.0, 0.0 }, { 0.0, 1.0 } });
      const Magnification magnified(p.Chart, p.Triangle.Shape, reference);
      const double condition = p.Triangle.Aspect() * magnified.Forward * magnified.Inverse;
      ASSERT_LT(error, 64.0 * Ulp * condition) << Description(p.Triangle, point);
      // The derivatives of the two charts, one after the other. Barycentric components of offsets
      // beside a short edge are as large as the aspect ratio, and cancel.
      const auto composed = [&](const Vector2& axis) {
        return q.Chart.Pushforward(reference, p.Chart.Pullback(reference, axis));
      };
      const double difference =
        Norm(derivative - Matrix2{ composed({ 1.0, 0.0 }), composed({ 0.0, 1.0 }) });
      const double scale = q.Triangle.Shape.Base / p.Triangle.Shape.Base * magnified.Inverse *
        Magnification(q.Chart, q.Triangle.Shape, reference).Forward;
      ASSERT_LE(difference, 64.0 * Ulp * p.Triangle.Aspect() * q.Triangle.Aspect() * scale)
        << Description(p.Triangle, point) << " to " << Description(q.Triangle, {});
    }
  }
}

/// Near the tip of a flat cap arcs turn by almost a right angle, and the cosine cancels. The root
/// must still be found.
TEST(ContourCharts, NearTheTipOfACap)
{
  const PlaneTriangle triangle({ Vector2{ 40.334549577597691, 0.0 }, { 0.0, 0.0 },
    { 20.167274795109954, -0.00039122220690191047 } });
  const ContourChart chart(triangle.Shape, triangle.Views());
  const Vector2 point = triangle.ToFrame({ 40.334549528054019, -6.4072727144124634e-13 });
  EXPECT_LT(Norm(chart.ToPoint(chart.ToReference(point)) - point), 1e-14 * triangle.Shape.Base);
}

/// With the incenter, needles and caps as thin as doubles can represent: products of two heights
/// underflow.
TEST(ContourCharts, NeedlesFromTheIncenterHaveImagesAndDerivatives)
{
  Random random(44);
  const auto small = [&random]() {
    return random.Chance(0.1) ? 0.0
                              : 0.5 * random.PowerOfTen(random.Chance(0.5) ? -3.0 : -300.0, 0.0);
  };
  for (int n = 0; n < 50000; ++n)
  {
    const double apexX = random.Chance(0.3) ? 0.5 : small();
    const TriangleShape shape{ 1.0, apexX, random.PowerOfTen(-280.0, 0.0), 2 };
    const ContourChart chart(shape,
      ViewsFromEdges(shape.Corner(0), shape.Corner(1), shape.Corner(2)), CenterPoint::Incenter);
    const int k = random.Below(3);
    Barycentric l;
    l[NextCorner(k)] = small();
    l[PreviousCorner(k)] = small();
    l[k] = 1.0 - l[NextCorner(k)] - l[PreviousCorner(k)];
    const auto reference = chart.ToReference(shape.FromBarycentric(l));
    ASSERT_LT(DistanceOutside(shape, chart.ToPoint(reference)), 1e-15)
      << shape.Height << ", " << apexX;
    for (const Vector2& axis : { Vector2{ 1.0, 0.0 }, Vector2{ 0.0, 1.0 } })
    {
      const Vector2 pulled = chart.Pullback(reference, axis);
      const Vector2 pushed = chart.Pushforward(reference, axis);
      ASSERT_FALSE(std::isnan(pulled.x + pulled.y)) << shape.Height << ", " << apexX;
      ASSERT_TRUE(std::isfinite(pushed.x + pushed.y)) << shape.Height << ", " << apexX;
    }
  }
}

} // namespace
