// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// In the Smooth system, first and second derivatives agree from both sides of an edge, the
// determinant is positive, strips are disjoint, and only neighbors influence the chart.

#include "AdjacentTriangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace
{

using namespace homeomorphism_test;

/// The derivative, in the plane, of the map between one of the two triangles and its counterpart.
Matrix2 Jacobian(const PlaneTriangle& p, const SmoothChart& chartP, const PlaneTriangle& q,
  const SmoothChart& chartQ, const Barycentric& l)
{
  return InPlane(p, q, MapDerivative(chartP, chartQ, l));
}

/// The relative change of a derivative of the map when rounding moves the corners by an ulp of the
/// longest edge.
double Aspect(const PlaneTriangle& triangle)
{
  return triangle.Shape.Base / triangle.Shape.Height;
}

TEST(SmoothEdge, FirstDerivativesAgree)
{
  RandomNumbers random(51);
  for (const bool moderate : { true, false })
  {
    Worst worst;
    for (int n = 0; n < 50000; ++n)
    {
      const AdjacentTriangles p =
        moderate ? ModerateAdjacentTriangles(random) : AnyAdjacentTriangles(random);
      const AdjacentTriangles q =
        moderate ? ModerateAdjacentTriangles(random) : AnyAdjacentTriangles(random);
      const std::array<SmoothChart, 2> chartsP = p.SmoothCharts();
      const std::array<SmoothChart, 2> chartsQ = q.SmoothCharts();
      const double w = random.Uniform(0.001, 0.999);
      const std::array<Barycentric, 2> l = OnSharedEdge(w);
      const Matrix2 first = Jacobian(p.First, chartsP[0], q.First, chartsQ[0], l[0]);
      const Matrix2 second = Jacobian(p.Second, chartsP[1], q.Second, chartsQ[1], l[1]);
      // Both map the edge and the direction across it. The angle at which the chart crosses the
      // edge in P determines the condition number.
      double condition = 1.0;
      for (const PlaneTriangle* triangle : { &p.First, &p.Second, &q.First, &q.Second })
      {
        condition = std::max(condition, Aspect(*triangle));
      }
      condition *= std::max({ Magnification(chartsP[0], p.First.Shape, l[0]),
        Magnification(chartsP[1], p.Second.Shape, l[1]),
        InverseMagnification(chartsP[0], p.First.Shape, l[0]),
        InverseMagnification(chartsP[1], p.Second.Shape, l[1]) });
      const double error = Norm(first - second) / (Ulp * condition * Norm(first));
      worst.Take(error, [&]() {
        return Description(p.First, {}) + " | " + Description(p.Second, {}) + " to " +
          Description(q.First, {}) + " | " + Description(q.Second, {});
      });
    }
    EXPECT_LT(worst.Value, 64.0) << worst.Where;
  }
}

TEST(SmoothEdge, SecondDerivativesAgree)
{
  // The derivative across the edge of all entries of the Jacobian, one-sided with an error of order
  // h^2. The difference of the two sides must not be larger, so it decreases 64 times when h
  // decreases 8 times. Two intermediate steps make sure that the coarse differences are not small
  // by chance.
  RandomNumbers random(52);
  double worstFall = 0.0;
  int pairs = 0;
  for (int n = 0; n < 5000; ++n)
  {
    const AdjacentTriangles p = ModerateAdjacentTriangles(random);
    const AdjacentTriangles q = ModerateAdjacentTriangles(random);
    const std::array<SmoothChart, 2> chartsP = p.SmoothCharts();
    const std::array<SmoothChart, 2> chartsQ = q.SmoothCharts();
    const Vector2 point = p.At(random.Uniform(0.2, 0.8));
    // Towards the first triangle and, with the opposite sign, towards the second.
    const Vector2 inward = p.Normal() + random.Uniform(-1.0, 1.0) * p.Tangent();
    const auto jacobian = [&](int side, double distance) {
      const PlaneTriangle& triangle = side == 0 ? p.First : p.Second;
      const PlaneTriangle& image = side == 0 ? q.First : q.Second;
      const Vector2 at = point + ((side == 0 ? distance : -distance) * p.Length()) * inward;
      const Barycentric l = chartsP[side].ToReference(triangle.ToFrame(at));
      return Jacobian(triangle, chartsP[side], image, chartsQ[side], l);
    };
    const auto derivative = [&](int side, double h) -> Matrix2 {
      const Matrix2 at0 = jacobian(side, 0.0);
      const Matrix2 at1 = jacobian(side, h);
      const Matrix2 at2 = jacobian(side, 2.0 * h);
      const double factor = (side == 0 ? 0.5 : -0.5) / h;
      const auto combine = [factor](const Vector2& a, const Vector2& b, const Vector2& c) {
        return factor * (4.0 * b - 3.0 * a - c);
      };
      return { combine(at0.ImageOfX, at1.ImageOfX, at2.ImageOfX),
        combine(at0.ImageOfY, at1.ImageOfY, at2.ImageOfY) };
    };
    const double scale = Norm(jacobian(0, 0.0));
    const auto jump = [&](double h) { return Norm(derivative(0, h) - derivative(1, h)) / scale; };
    const double coarse = std::max({ jump(8e-4), 4.0 * jump(4e-4), 16.0 * jump(2e-4) });
    const double fine = jump(1e-4);
    // Where the jump is above rounding.
    if (coarse > 1e-7)
    {
      ++pairs;
      worstFall = std::max(worstFall, fine / coarse);
    }
  }
  EXPECT_GT(pairs, 4000);
  EXPECT_LT(worstFall, 1.0 / 32.0);
}

/// Barycentric coordinates in the strip of edge @a k, at u and at a proportion of the edge.
Barycentric InStrip(int k, double tau, double u, double proportion)
{
  return OnStripBorder(k, tau * u, proportion);
}

TEST(SmoothEdge, DeterminantIsBoundedFromBelow)
{
  constexpr int triangles = 100000;
  constexpr int pointsPerTriangle = 102;
  RandomNumbers random(55);
  // The least determinant over pairs whose shares 2 a / (a + a*) are not small, and the least
  // quotient of determinant and bound where the bound is that share.
  double lowest = 1e300;
  double nearestShare = 1e300;
  for (int n = 0; n < triangles; ++n)
  {
    const AdjacentTriangles p = AnyAdjacentTriangles(random);
    const std::array<SmoothChart, 2> charts = p.SmoothCharts();
    const int side = random.Below(2);
    const SmoothChart& chart = charts[side];
    const double bound = chart.DeterminantBound();
    const double height = p.First.Views()[2].Height;
    const double otherHeight = p.Second.Views()[2].Height;
    const double share = 2.0 * (side == 0 ? otherHeight : height) / (height + otherHeight);
    const double tau = chart.StripWidth(2);
    for (int i = 0; i < pointsPerTriangle; ++i)
    {
      // 0.6 is where K' is least and u^3 (1 - u)^2 greatest.
      const double u = i % 3 == 0 ? random.Uniform(0.55, 0.65) : random.Uniform();
      double proportion = random.Uniform();
      if (i % 2 == 0)
      {
        const double nearCorner = std::ldexp(proportion, -random.Below(30));
        proportion = random.Chance(0.5) ? nearCorner : 1.0 - nearCorner;
      }
      const double ratio = chart.DeterminantRatio(InStrip(2, tau, u, proportion));
      ASSERT_TRUE(ratio > 0.0 && ratio >= bound * (1.0 - 4.0 * Ulp))
        << Description(p.First, {}) << " | " << Description(p.Second, {});
      if (share > 0.5)
      {
        lowest = std::min(lowest, ratio);
      }
      if (share < 0.25)
      {
        nearestShare = std::min(nearestShare, ratio / bound);
      }
    }
  }
  // 1 + K' - 6 u^3 (1 - u)^2 is least at u = 3/5, where K' and u^3 (1 - u)^2 are both extreme: 4385
  // / 15625 = 0.28064. It is approached beside far larger neighbors, near a corner.
  EXPECT_GE(lowest, 0.28064 - 1e-12);
  EXPECT_LT(lowest, 0.2808);
  EXPECT_LT(nearestShare, 1.001);
}

TEST(SmoothEdge, DeterminantIsThatOfTheDerivative)
{
  RandomNumbers random(56);
  double worst = 0.0;
  for (int n = 0; n < 100000; ++n)
  {
    const PlaneTriangle t(FatTriangle(random));
    const EdgeViews views = t.Views();
    const SmoothChart chart(t.Shape, views, AnyNeighbors(random, views));
    const int k = random.Below(3);
    const Barycentric l = random.Chance(0.5)
      ? AnyBarycentric(random)
      : InStrip(k, chart.StripWidth(k), random.Uniform(), random.Uniform(0.001, 0.999));
    const Vector2 a = chart.Pushforward(l, { -1.0, 1.0, 0.0 });
    const Vector2 b = chart.Pushforward(l, { -1.0, 0.0, 1.0 });
    const double affine = t.Shape.Base * t.Shape.Height;
    const double condition = Norm(a) * Norm(b) / affine;
    worst = std::max(
      worst, std::abs(Cross(a, b) / affine - chart.DeterminantRatio(l)) / (1.0 + condition));
  }
  EXPECT_LT(worst, 1e-14);
}

TEST(SmoothEdge, DeterminantOnAnEdgeIsTheShareOfTheNeighbor)
{
  RandomNumbers random(59);
  double worst = 0.0;
  for (int n = 0; n < 50000; ++n)
  {
    const PlaneTriangle t(AnyTriangle(random));
    const EdgeViews views = t.Views();
    const std::array<Neighbor, 3> neighbors = AnyNeighbors(random, views);
    const SmoothChart chart(t.Shape, views, neighbors);
    double least = 1.0;
    for (int k = 0; k < 3; ++k)
    {
      const double own = views[k].Height;
      const double other = neighbors[k].View.Height;
      const double share = neighbors[k].Exists ? 2.0 * other / (own + other) : 1.0;
      least = neighbors[k].Exists ? std::min(least, share) : least;
      // The error is relative to the determinant, however small the neighbor.
      const double ratio = chart.DeterminantRatio(InStrip(k, 0.0, 0.0, random.Uniform(0.01, 0.99)));
      worst = std::max(worst, std::abs(ratio - share) / share);
    }
    EXPECT_LE(chart.DeterminantBound(), least * (1.0 + 4.0 * Ulp));
  }
  EXPECT_LT(worst, 4.0 * Ulp);
}

TEST(SmoothEdge, ANeighborChangesOnlyItsStrip)
{
  RandomNumbers random(57);
  int inside = 0;
  int changed = 0;
  int wrong = 0;
  for (int n = 0; n < 20000; ++n)
  {
    const PlaneTriangle t(AnyTriangle(random));
    const EdgeViews views = t.Views();
    std::array<Neighbor, 3> neighbors = AnyNeighbors(random, views);
    const SmoothChart before(t.Shape, views, neighbors);
    const int k = random.Below(3);
    neighbors[k] = AnyNeighbor(random, views[k]);
    const SmoothChart after(t.Shape, views, neighbors);
    const double tau = std::max(before.StripWidth(k), after.StripWidth(k));
    for (int i = 0; i < 20; ++i)
    {
      const Barycentric l =
        i < 10 ? AnyBarycentric(random) : InStrip(k, 1.0, random.Uniform(), random.Uniform());
      const double domains = l[NextCorner(k)] * l[PreviousCorner(k)];
      const double least = l[k] * (l[NextCorner(k)] + l[PreviousCorner(k)]);
      const Vector2 x = before.ToPoint(l);
      const Vector2 y = after.ToPoint(l);
      const bool isSame = x.x == y.x && x.y == y.y;
      if (least < tau * domains)
      {
        // Deep enough inside the strip for a visible change.
        if (least < 0.5 * std::min(before.StripWidth(k), after.StripWidth(k)) * domains &&
          least > 0.01 * tau * domains)
        {
          ++inside;
          changed += !isSame;
        }
      }
      else
      {
        const Barycentric back = before.ToReference(x);
        const Barycentric backAfter = after.ToReference(x);
        // The inverse is the same too, except for a point that rounding moves across the border.
        double difference = 0.0;
        for (int j = 0; j < 3; ++j)
        {
          difference = std::max(difference, std::abs(back[j] - backAfter[j]));
        }
        wrong += !isSame || !(difference < 1e-15);
      }
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(inside, 10000);
  EXPECT_GT(changed, 0.99 * inside);
}

TEST(SmoothEdge, WithoutNeighborsTheChartIsThatOfTheLinearSystem)
{
  RandomNumbers random(58);
  for (int n = 0; n < 20000; ++n)
  {
    const PlaneTriangle t(AnyTriangle(random));
    const SmoothChart chart(t.Shape, t.Views(), {});
    const Barycentric l = AnyBarycentric(random);
    const Vector2 point = chart.ToPoint(l);
    EXPECT_EQ(point.x, t.Shape.FromBarycentric(l).x);
    EXPECT_EQ(point.y, t.Shape.FromBarycentric(l).y);
    EXPECT_EQ(chart.ToReference(point), t.Shape.ToBarycentric(point));
    EXPECT_EQ(chart.DeterminantRatio(l), 1.0);
    EXPECT_EQ(chart.DeterminantBound(), 1.0);
  }
}

} // namespace
