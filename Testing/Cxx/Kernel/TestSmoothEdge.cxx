// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// In the Smooth system, derivatives on both sides of an edge agree (for second derivatives, see
// TestJacobianContinuity), and the determinant is positive.

#include "Fixtures/Triangles.h"

#include <gtest/gtest.h>

namespace
{

using namespace homeomorphism_test;

/// Two triangles on either side of an edge, opposite corner 2 in both, without other neighbors.
struct AdjacentTriangles
{
  std::array<PlaneTriangle, 2> Triangles;
  std::array<SmoothChart, 2> Charts;

  /// The edge is that from (0, 0) to (1, 0), turned and scaled.
  AdjacentTriangles(const Vector2& end, const Vector2& left, const Vector2& right)
    : Triangles{ PlaneTriangle({ Vector2{}, end, Turned(left, end) }),
      PlaneTriangle({ end, Vector2{}, Turned(right, end) }) }
    , Charts{ this->MakeChart(0), this->MakeChart(1) }
  {
  }

private:
  static Vector2 Turned(const Vector2& p, const Vector2& u)
  {
    return p.x * u + p.y * Vector2{ -u.y, u.x };
  }
  SmoothChart MakeChart(std::size_t i) const
  {
    const Neighbor other{ true, Reversed(this->Triangles[1 - i].Views()[2]) };
    return { this->Triangles[i].Shape, this->Triangles[i].Views(), { Neighbor{}, {}, other } };
  }
};

/// Two triangles of similar size; or one up to a million times larger than the other, with apexes
/// up to twenty edge lengths aside.
AdjacentTriangles AnyAdjacentTriangles(Random& random, bool moderate = false)
{
  const double ratio = moderate ? random.Uniform(0.4, 1.5) : random.PowerOfTen(-6.0, 6.0);
  const double height =
    moderate ? random.Uniform(0.4, 1.5) : random.PowerOfTen(-1.0, 1.0) / std::sqrt(ratio);
  const auto foot = [&random, moderate]() {
    return moderate || random.Chance(0.5) ? random.Uniform(-0.2, 1.2) : random.Uniform(-20.0, 21.0);
  };
  const double scale = random.PowerOfTen(-0.5, 0.5);
  const double angle = random.Uniform(0.0, 6.283185307179586);
  const Vector2 left{ foot(), height };
  return { { scale * std::cos(angle), scale * std::sin(angle) }, left,
    { foot(), -height * ratio } };
}

std::string Description(const AdjacentTriangles& p)
{
  return Description(p.Triangles[0], {}) + " | " + Description(p.Triangles[1], {});
}

TEST(SmoothEdge, DerivativesAgree)
{
  Random random(51);
  for (const bool moderate : { true, false })
  {
    for (int n = 0; n < 50000; ++n)
    {
      const AdjacentTriangles p = AnyAdjacentTriangles(random, moderate);
      const AdjacentTriangles q = AnyAdjacentTriangles(random, moderate);
      const double w = random.Uniform(0.001, 0.999);
      std::array<Matrix2, 2> jacobians;
      double aspect = 1.0;
      double magnification = 1.0;
      for (int i = 0; i < 2; ++i)
      {
        const Barycentric l{ i == 0 ? 1.0 - w : w, i == 0 ? w : 1.0 - w, 0.0 };
        const PlaneTriangle& from = p.Triangles[i];
        jacobians[i] = InPlane(from, q.Triangles[i], MapDerivative(p.Charts[i], q.Charts[i], l));
        // Both map the edge and the direction across it. The angle at which the chart crosses the
        // edge in P determines the condition number.
        aspect = std::max({ aspect, from.Aspect(), q.Triangles[i].Aspect() });
        const Magnification magnified(p.Charts[i], from.Shape, l);
        magnification = std::max({ magnification, magnified.Forward, magnified.Inverse });
      }
      const double condition = aspect * magnification;
      ASSERT_LT(Norm(jacobians[0] - jacobians[1]), 64.0 * Ulp * condition * Norm(jacobians[0]))
        << Description(p) << " to " << Description(q);
    }
  }
}

TEST(SmoothEdge, DeterminantIsBoundedFromBelow)
{
  constexpr int triangles = 100000;
  constexpr int pointsPerTriangle = 102;
  Random random(55);
  // The least determinant over pairs whose shares 2 a / (a + a*) are not small, and the least
  // quotient of determinant and bound where the bound is that share.
  double lowest = 1e300;
  double nearestShare = 1e300;
  for (int n = 0; n < triangles; ++n)
  {
    const AdjacentTriangles p = AnyAdjacentTriangles(random);
    const int side = random.Below(2);
    const SmoothChart& chart = p.Charts[side];
    const double bound = chart.DeterminantBound();
    const double height = p.Triangles[side].Views()[2].Height;
    const double otherHeight = p.Triangles[1 - side].Views()[2].Height;
    const double share = 2.0 * otherHeight / (height + otherHeight);
    const double tau = chart.StripWidth(2);
    for (int i = 0; i < pointsPerTriangle; ++i)
    {
      // 0.6 is where K' is least and u^3 (1 - u)^2 greatest.
      const double u = i % 3 == 0 ? random.Uniform(0.55, 0.65) : random.Uniform();
      const double fromCorner = std::ldexp(random.Uniform(), i % 2 == 0 ? -random.Below(30) : 0);
      const double proportion = random.Chance(0.5) ? fromCorner : 1.0 - fromCorner;
      const double ratio = chart.DeterminantRatio(OnStripBorder(2, tau * u, proportion));
      ASSERT_TRUE(ratio > 0.0 && ratio >= bound * (1.0 - 4.0 * Ulp)) << Description(p);
      lowest = share > 0.5 ? std::min(lowest, ratio) : lowest;
      nearestShare = share < 0.25 ? std::min(nearestShare, ratio / bound) : nearestShare;
    }
  }
  // 1 + K' - 6 u^3 (1 - u)^2 is least at u = 3/5, where K' and u^3 (1 - u)^2 are both extreme: 4385
  // / 15625 = 0.28064. It is approached beside far larger neighbors, near a corner.
  EXPECT_GE(lowest, 0.28064 - 1e-12);
  EXPECT_LT(lowest, 0.2808);
  EXPECT_LT(nearestShare, 1.001);
}

TEST(SmoothEdge, DeterminantIsThatOfTheDerivativeAndOnAnEdgeTheShareOfTheNeighbor)
{
  Random random(56);
  for (int n = 0; n < 100000; ++n)
  {
    const PlaneTriangle t(AnyTriangle(random));
    const EdgeViews views = t.Views();
    const std::array<Neighbor, 3> neighbors = AnyNeighbors(random, views);
    const SmoothChart chart(t.Shape, views, neighbors);
    double least = 1.0;
    for (int k = 0; k < 3; ++k)
    {
      const Barycentric l = random.Chance(0.5)
        ? random.Weights()
        : OnStripBorder(k, chart.StripWidth(k) * random.Uniform(), random.Uniform(0.001, 0.999));
      // To the next corner and to the previous one.
      const Vector2 a = chart.Pushforward(l, { -1.0, 1.0, 0.0 });
      const Vector2 b = chart.Pushforward(l, { -1.0, 0.0, 1.0 });
      const double affine = t.Shape.Base * t.Shape.Height;
      const double error = std::abs(Cross(a, b) / affine - chart.DeterminantRatio(l));
      if (t.Aspect() < 4.0)
      {
        ASSERT_LT(error, 1e-14 * (1.0 + Norm(a) * Norm(b) / affine))
          << Description(t, chart.ToPoint(l));
      }

      const double own = views[k].Height;
      const double other = neighbors[k].View.Height;
      const double share = neighbors[k].Exists ? 2.0 * other / (own + other) : 1.0;
      least = std::min(least, share);
      // The error is relative to the determinant, however small the neighbor.
      const double ratio =
        chart.DeterminantRatio(OnStripBorder(k, 0.0, random.Uniform(0.01, 0.99)));
      ASSERT_LT(std::abs(ratio - share), 4.0 * Ulp * share) << Description(t, {});
    }
    EXPECT_LE(chart.DeterminantBound(), least * (1.0 + 4.0 * Ulp));
  }
}

TEST(SmoothEdge, WithoutNeighborsTheChartIsThatOfTheLinearSystem)
{
  Random random(58);
  for (int n = 0; n < 20000; ++n)
  {
    const PlaneTriangle t(AnyTriangle(random));
    const SmoothChart chart(t.Shape, t.Views(), {});
    const Barycentric l = random.Weights();
    const Vector2 point = chart.ToPoint(l);
    EXPECT_EQ(point.x, t.Shape.FromBarycentric(l).x);
    EXPECT_EQ(point.y, t.Shape.FromBarycentric(l).y);
    EXPECT_EQ(chart.ToReference(point), t.Shape.ToBarycentric(point));
    EXPECT_EQ(chart.DeterminantRatio(l), 1.0);
    EXPECT_EQ(chart.DeterminantBound(), 1.0);
  }
}

} // namespace
