// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The Contour system is not differentiable across a shared edge. The jump follows from the lengths
// of the contours that end there.

#include "AdjacentTriangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

using namespace homeomorphism_test;

AdjacentTriangles ConcordantPair(RandomNumbers& random)
{
  for (;;)
  {
    const AdjacentTriangles pair = ModerateAdjacentTriangles(random);
    if (IsConcordant(pair.First.Corners) && IsConcordant(pair.Second.Corners))
    {
      return pair;
    }
  }
}

std::array<ContourChart, 2> Charts(const AdjacentTriangles& pair, CenterPoint center)
{
  return { ContourChart(pair.First.Shape, pair.First.Views(), center),
    ContourChart(pair.Second.Shape, pair.Second.Views(), center) };
}

/// The derivatives of the map from the two sides of the edge at one point.
struct BothSides
{
  Matrix2 First;
  Matrix2 Second;
  /// Ratios of contour lengths.
  double FirstRatio;
  double SecondRatio;

  BothSides(const AdjacentTriangles& p, const AdjacentTriangles& q, double w, CenterPoint center)
  {
    const std::array<ContourChart, 2> chartsP = Charts(p, center);
    const std::array<ContourChart, 2> chartsQ = Charts(q, center);
    this->First = InPlane(p.First, q.First, MapDerivative(chartsP[0], chartsQ[0], { 3, w, 1.0 }));
    this->Second =
      InPlane(p.Second, q.Second, MapDerivative(chartsP[1], chartsQ[1], { 3, 1.0 - w, 1.0 }));
    this->FirstRatio = chartsQ[0].ContourLength(3, w) / chartsP[0].ContourLength(3, w);
    this->SecondRatio = chartsQ[1].ContourLength(3, 1.0 - w) / chartsP[1].ContourLength(3, 1.0 - w);
  }

  double Jump() const { return Norm(this->First - this->Second); }
};

CenterPoint AnyCenter(RandomNumbers& random)
{
  return random.Chance(0.5) ? CenterPoint::Centroid : CenterPoint::Incenter;
}

TEST(ContourEdge, JumpIsTheDifferenceOfLengthRatios)
{
  RandomNumbers random(61);
  double worst = 0.0;
  double largestJump = 0.0;
  for (int n = 0; n < 30000; ++n)
  {
    const AdjacentTriangles p = ConcordantPair(random);
    const AdjacentTriangles q = ConcordantPair(random);
    const BothSides at(p, q, random.Uniform(0.001, 0.999), AnyCenter(random));
    const double expected = std::abs(at.FirstRatio - at.SecondRatio);
    worst = std::max(worst, std::abs(at.Jump() - expected) / Norm(at.First));
    largestJump = std::max(largestJump, expected);
    // The derivatives differ only in the image of the normal, which stays normal to the edge.
    const Vector2 jumpOfTangent = Times(at.First - at.Second, p.Tangent());
    const Vector2 jumpOfNormal = Times(at.First - at.Second, p.Normal());
    const Vector2 expectedJump = (at.FirstRatio - at.SecondRatio) * q.Normal();
    const Vector2 expectedTangent = (q.Length() / p.Length()) * q.Tangent();
    worst = std::max({ worst, Norm(jumpOfTangent) / Norm(at.First),
      Norm(jumpOfNormal - expectedJump) / Norm(at.First),
      Norm(Times(at.First, p.Tangent()) - expectedTangent) / Norm(at.First) });
  }
  EXPECT_LT(worst, 1e-13);
  EXPECT_GT(largestJump, 0.5);
}

TEST(ContourEdge, JumpIsMeasuredFromMappedPoints)
{
  // One-sided differences of mapped points across the edge, with an error of order h^3.
  RandomNumbers random(62);
  double worst = 0.0;
  for (int n = 0; n < 5000; ++n)
  {
    const AdjacentTriangles p = ConcordantPair(random);
    const AdjacentTriangles q = ConcordantPair(random);
    const double w = random.Uniform(0.2, 0.8);
    const CenterPoint center = AnyCenter(random);
    const std::array<ContourChart, 2> chartsP = Charts(p, center);
    const std::array<ContourChart, 2> chartsQ = Charts(q, center);
    const auto derivative = [&](int side) {
      const PlaneTriangle& triangle = side == 0 ? p.First : p.Second;
      const PlaneTriangle& image = side == 0 ? q.First : q.Second;
      const double h = 2e-5 * p.Length();
      const auto map = [&](double distance) {
        const Vector2 at = p.At(w) + (side == 0 ? distance : -distance) * p.Normal();
        return image.FromFrame(MapPoint(chartsP[side], chartsQ[side], triangle.ToFrame(at)));
      };
      const Vector2 sum =
        (-11.0 / 6.0) * map(0.0) + 3.0 * map(h) - 1.5 * map(2.0 * h) + (1.0 / 3.0) * map(3.0 * h);
      return ((side == 0 ? 1.0 : -1.0) / h) * sum;
    };
    const BothSides at(p, q, w, center);
    const Vector2 jump = derivative(0) - derivative(1);
    const Vector2 expected = (at.FirstRatio - at.SecondRatio) * q.Normal();
    worst = std::max(worst, Norm(jump - expected) / Norm(at.First));
  }
  EXPECT_LT(worst, 1e-7);
}

} // namespace
