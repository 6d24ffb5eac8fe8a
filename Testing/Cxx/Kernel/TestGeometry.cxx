// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Edge views agree with integer arithmetic. Where differences of coordinates are exact, every
// number of the view is accurate to a few ulp of itself, even in needles.

#include "Fixtures/Triangles.h"

#include <gtest/gtest.h>

namespace
{

using namespace homeomorphism_test;

double RelativeError(double found, long double exact)
{
  const auto expected = static_cast<double>(exact);
  return found == expected ? 0.0 : std::abs(found - expected) / std::abs(expected);
}

TEST(Geometry, ViewFromEdgeIsAccurateToAFewUlp)
{
  Random random(71);
  for (int n = 0; n < 200000; ++n)
  {
    // At most 26 bits, so that products are exact as 64-bit integers. Edges and opposite corners
    // are short or long independently; often the three points are almost collinear.
    const auto component = [&random]() {
      const int bits = random.Integer(1, 25);
      return random.Integer(-(1 << bits), 1 << bits);
    };
    const std::int64_t ex = component();
    const std::int64_t ey = component();
    std::int64_t ox = component();
    std::int64_t oy = component();
    if (random.Chance(0.5))
    {
      const double t = random.Uniform(-1.0, 1.0);
      ox = std::llround(t * static_cast<double>(ex)) + random.Integer(-2, 2);
      oy = std::llround(t * static_cast<double>(ey)) + random.Integer(-2, 2);
    }
    const std::int64_t square = ex * ex + ey * ey;
    if (square == 0)
    {
      continue;
    }
    const auto length = std::sqrt(static_cast<long double>(square));
    const auto foot =
      static_cast<long double>(ex * ox + ey * oy) / static_cast<long double>(square);
    const auto height = std::abs(static_cast<long double>(ex * oy - ey * ox)) / length;

    // Translated by an integer, so that the differences stay exact.
    const Vector2 start{ static_cast<double>(component()), static_cast<double>(component()) };
    const Vector2 end = start + Vector2{ static_cast<double>(ex), static_cast<double>(ey) };
    const Vector2 opposite = start + Vector2{ static_cast<double>(ox), static_cast<double>(oy) };
    const EdgeView view = ViewFromEdge(start, end, opposite);
    ASSERT_LT(RelativeError(view.Length, length), 2.0 * Ulp);
    ASSERT_LT(RelativeError(view.Foot, foot), 8.0 * Ulp);
    ASSERT_LT(RelativeError(view.Height, height), 8.0 * Ulp);
  }
}

TEST(Geometry, BarycentricCoordinatesAreExactAtCornersAndLinear)
{
  Random random(72);
  for (int n = 0; n < 50000; ++n)
  {
    const TriangleShape shape = PlaneTriangle(AnyTriangle(random)).Shape;
    const Barycentric l = random.Weights();
    const Barycentric m = random.Weights();
    const Barycentric components =
      shape.VectorToBarycentric(shape.FromBarycentric(m) - shape.FromBarycentric(l));
    // An ulp of the points, relative to the height of the triangle.
    const double rounding = Ulp * shape.Base / shape.Height;
    for (int k = 0; k < 3; ++k)
    {
      Barycentric expected{};
      expected[k] = 1.0;
      ASSERT_EQ(shape.ToBarycentric(shape.Corner(k)), expected);
      const Vector2 corner = shape.FromBarycentric(expected);
      ASSERT_EQ(corner.x, shape.Corner(k).x);
      ASSERT_EQ(corner.y, shape.Corner(k).y);
      ASSERT_LT(std::abs(components[k] - (m[k] - l[k])), 8.0 * rounding);
    }
    EXPECT_LT(std::abs(components[0] + components[1] + components[2]), 4.0 * Ulp);
  }
}

} // namespace
