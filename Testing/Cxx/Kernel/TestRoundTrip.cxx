// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Round trips from a point to its coordinates and back, for all systems, for triangles from fat
// ones to needles, and for points on and within a few ulp of every line at which the formulas
// change.

#include "RandomTriangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace
{

using namespace homeomorphism_test;

struct Segment
{
  Vector2 Start;
  Vector2 End;
};

Vector2 Between(const Segment& segment, double proportion)
{
  return (1.0 - proportion) * segment.Start + proportion * segment.End;
}

void AddEdgesAndSpokes(
  const TriangleShape& shape, const Vector2& center, std::vector<Segment>& lines)
{
  for (int k = 0; k < 3; ++k)
  {
    lines.push_back({ shape.Corner(NextCorner(k)), shape.Corner(PreviousCorner(k)) });
    lines.push_back({ center, shape.Corner(k) });
  }
}

Vector2 Centroid(const TriangleShape& shape)
{
  return shape.FromBarycentric({ 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 });
}

/// The lines of a triangle, in its frame, at which the formulas of the chart change.
std::vector<Segment> LinesOf(const LinearChart&, const TriangleShape& shape)
{
  std::vector<Segment> lines;
  AddEdgesAndSpokes(shape, Centroid(shape), lines);
  return lines;
}

std::vector<Segment> LinesOf(const ContourChart& chart, const TriangleShape& shape)
{
  std::vector<Segment> lines;
  const Vector2 center = chart.Center();
  AddEdgesAndSpokes(shape, center, lines);
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 foot = chart.Foot(k + 1);
    const Vector2 middle = 0.5 * (center + foot);
    lines.push_back({ center, foot });
    lines.push_back({ middle, shape.Corner(NextCorner(k)) });
    lines.push_back({ middle, shape.Corner(PreviousCorner(k)) });
  }
  return lines;
}

/// The chart is smooth except at the borders of strips. Its (e, p, c) change formula where those of
/// the equilateral triangle do, so the images of those lines under the chart are used as well, as
/// polylines.
std::vector<Segment> LinesOf(const SmoothChart& chart, const TriangleShape& shape)
{
  std::vector<Segment> lines;
  AddEdgesAndSpokes(shape, Centroid(shape), lines);
  for (int k = 0; k < 3; ++k)
  {
    // The borders are curved and are approximated by short segments.
    for (int i = 0; i < 16 && chart.StripWidth(k) > 0.0; ++i)
    {
      const double proportion = (i + 0.5) / 16.0;
      const Vector2 onBorder =
        shape.FromBarycentric(OnStripBorder(k, chart.StripWidth(k), proportion));
      lines.push_back({ onBorder, onBorder });
    }
  }
  for (const Segment& line : LinesOf(ContourChart::Equilateral(), ContourChart::EquilateralShape()))
  {
    const TriangleShape& equilateral = ContourChart::EquilateralShape();
    for (int i = 0; i < 4; ++i)
    {
      const Vector2 onLine = chart.ToPoint(equilateral.ToBarycentric(Between(line, (i + 0.5) / 4)));
      lines.push_back({ onLine, onLine });
    }
  }
  return lines;
}

double MovedByUlps(double x, int count)
{
  if (x == 0.0)
  {
    // No subnormal numbers: the predicate for sides of a line could not form their products.
    return count * std::ldexp(1.0, -200);
  }
  for (int i = 0; i < std::abs(count); ++i)
  {
    x = std::nextafter(x, count > 0 ? 1e300 : -1e300);
  }
  return x;
}

double DistanceToSegment(const Vector2& point, const Vector2& start, const Vector2& end)
{
  const Vector2 edge = end - start;
  const Vector2 d = point - start;
  const double length = Norm(edge);
  const double along = std::min(length, std::max(0.0, Dot(d, edge) / length));
  return Norm(d - (along / length) * edge);
}

/// The distance of a point from the closed triangle.
double DistanceOutside(const TriangleShape& shape, const Vector2& point)
{
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 start = shape.Corner(NextCorner(k));
    const Vector2 end = shape.Corner(PreviousCorner(k));
    inside = inside && Orientation(start, end, point) >= 0;
    nearest = std::min(nearest, DistanceToSegment(point, start, end));
  }
  return inside ? 0.0 : nearest;
}

/// A point of the closed triangle, or outside by a few ulp.
Vector2 AnyPoint(
  RandomNumbers& random, const TriangleShape& shape, const std::vector<Segment>& lines)
{
  const int kind = random.Below(8);
  Vector2 point;
  if (kind <= 1)
  {
    return shape.FromBarycentric(AnyBarycentric(random));
  }
  if (kind == 2)
  {
    // Anywhere near an edge or a corner.
    const double c = 1.0 - random.PowerOfTen(-18.0, 0.0);
    return shape.FromBarycentric(
      LinearChart(shape).FromCoordinates({ random.Integer(1, 3), random.Proportion(), c }));
  }
  if (kind == 3)
  {
    const Segment& line = lines[random.Below(static_cast<int>(lines.size()))];
    point = random.Chance(0.5) ? line.Start : line.End;
  }
  else
  {
    point = Between(lines[random.Below(static_cast<int>(lines.size()))], random.Proportion());
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

void ExpectValid(const TriangularCoordinates& c)
{
  EXPECT_GE(c.Edge, 1);
  EXPECT_LE(c.Edge, 3);
  // Negated so that NaN fails.
  EXPECT_TRUE(c.EdgeParameter >= 0.0 && c.EdgeParameter <= 1.0) << c.EdgeParameter;
  EXPECT_TRUE(c.ContourParameter >= 0.0 && c.ContourParameter <= 1.0) << c.ContourParameter;
}

struct Worst
{
  double Value = 0.0;
  std::string Where;
  long Failures = 0;

  template <typename Describe>
  void Take(double value, double bound, Describe describe)
  {
    if (!(value <= bound))
    {
      ++this->Failures;
    }
    if (!(value <= this->Value))
    {
      this->Value = value;
      this->Where = describe();
    }
  }
};

template <typename System>
class RoundTrip : public testing::Test
{
};

using Systems = testing::Types<LinearSystem, ContourSystem, IncenterSystem, SmoothSystem>;

TYPED_TEST_SUITE(RoundTrip, Systems, SystemName);

TYPED_TEST(RoundTrip, PointToCoordinatesToPoint)
{
  constexpr int triangles = 12000;
  constexpr int pointsPerTriangle = 100;
  constexpr double bound = 1e-14;
  RandomNumbers random(21);
  // Points of the closed triangle, then points outside.
  std::array<Worst, 2> viaReference;
  std::array<Worst, 2> viaCoordinates;
  for (int n = 0; n < triangles; ++n)
  {
    const PlaneTriangle triangle(TypeParam::Any(random));
    const TriangleShape& shape = triangle.Shape;
    const auto chart = TypeParam::Make(random, triangle, false);
    const std::vector<Segment> lines = LinesOf(chart, shape);
    for (int i = 0; i < pointsPerTriangle; ++i)
    {
      const Vector2 point = AnyPoint(random, shape, lines);
      const auto describe = [&]() { return Description(triangle, point); };
      // A point outside by rounding is replaced by the nearest point of the triangle.
      const double outside = DistanceOutside(shape, point);
      const auto reference = chart.ToReference(point);
      const Vector2 back = chart.ToPoint(reference);
      const double error = (Norm(back - point) - outside) / shape.Base;
      viaReference[outside > 0.0].Take(error, bound, describe);

      const TriangularCoordinates coordinates = chart.ToCoordinates(reference);
      ExpectValid(coordinates);
      const auto again = chart.FromCoordinates(coordinates);
      const double magnification =
        std::max(Magnification(chart, shape, reference), Magnification(chart, shape, again));
      const double coordinateError =
        (Norm(chart.ToPoint(again) - point) - outside) / (shape.Base * magnification);
      viaCoordinates[outside > 0.0].Take(coordinateError, bound, describe);
    }
  }
  for (const bool outside : { false, true })
  {
    EXPECT_EQ(viaReference[outside].Failures, 0) << viaReference[outside].Where;
    EXPECT_EQ(viaCoordinates[outside].Failures, 0) << viaCoordinates[outside].Where;
  }
}

TYPED_TEST(RoundTrip, CoordinatesToPointToCoordinates)
{
  RandomNumbers random(22);
  double worst = 0.0;
  for (int n = 0; n < 2000; ++n)
  {
    const PlaneTriangle triangle(TypeParam::Fat(random));
    const auto chart = TypeParam::Make(random, triangle, true);
    for (int i = 0; i < 50; ++i)
    {
      // Not near the center, where p is ill-conditioned, nor at a spoke, where e may change.
      const TriangularCoordinates coordinates{ random.Integer(1, 3), random.Uniform(0.001, 0.999),
        random.Uniform(0.01, 0.999) };
      const Vector2 point = chart.ToPoint(chart.FromCoordinates(coordinates));
      EXPECT_EQ(DistanceOutside(triangle.Shape, point), 0.0) << Description(triangle, point);
      const TriangularCoordinates found = chart.ToCoordinates(chart.ToReference(point));
      ASSERT_EQ(found.Edge, coordinates.Edge) << Description(triangle, point);
      // The accuracy of p grows with the distance from the center.
      const double error = std::max(
        std::abs(found.EdgeParameter - coordinates.EdgeParameter) * coordinates.ContourParameter,
        std::abs(found.ContourParameter - coordinates.ContourParameter));
      worst = std::max(worst, error);
    }
  }
  EXPECT_LT(worst, 1e-13);
}

/// Near the tip of a flat cap arcs turn by almost a right angle, and the cosine cancels. The root
/// must still be found.
TEST(ContourRoundTrip, NearTheTipOfACap)
{
  const PlaneTriangle triangle({ Vector2{ 40.334549577597691, 0.0 }, { 0.0, 0.0 },
    { 20.167274795109954, -0.00039122220690191047 } });
  const ContourChart chart(triangle.Shape, triangle.Views());
  const Vector2 point = triangle.ToFrame({ 40.334549528054019, -6.4072727144124634e-13 });
  EXPECT_LT(Norm(chart.ToPoint(chart.ToReference(point)) - point), 1e-14 * triangle.Shape.Base);
}

/// With the incenter, needles and caps as thin as doubles can represent: products of two heights
/// underflow.
TEST(ContourRoundTrip, NeedlesFromTheIncenterHaveImagesAndDerivatives)
{
  const std::vector<double> weights{ 0.0, 1e-300, 1e-200, 1e-100, 1e-40, 1e-17, 1e-10, 1e-3, 0.1,
    0.3 };
  for (int power = -280; power <= 0; power += 4)
  {
    for (const double apexX : { 0.5, 0.9, 0.0, 1e-20, 1e-100, 1e-200 })
    {
      const TriangleShape shape{ 1.0, apexX, std::pow(10.0, power), 2 };
      const ContourChart chart(shape,
        ViewsFromEdges(shape.Corner(0), shape.Corner(1), shape.Corner(2)), CenterPoint::Incenter);
      for (int k = 0; k < 3; ++k)
      {
        for (const double next : weights)
        {
          for (const double previous : weights)
          {
            Barycentric l;
            l[k] = 1.0 - next - previous;
            l[NextCorner(k)] = next;
            l[PreviousCorner(k)] = previous;
            const auto reference = chart.ToReference(shape.FromBarycentric(l));
            const Vector2 image = chart.ToPoint(reference);
            ASSERT_LT(DistanceOutside(shape, image), 1e-15) << power << ", " << apexX;
            for (const Vector2& axis : { Vector2{ 1.0, 0.0 }, Vector2{ 0.0, 1.0 } })
            {
              const Vector2 pulled = chart.Pullback(reference, axis);
              const Vector2 pushed = chart.Pushforward(reference, axis);
              ASSERT_FALSE(std::isnan(pulled.x + pulled.y)) << power << ", " << apexX;
              ASSERT_TRUE(std::isfinite(pushed.x + pushed.y)) << power << ", " << apexX;
            }
          }
        }
      }
    }
  }
}

} // namespace
