// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The counterexample of Documentation/differentiability.md with its numbers: from values of the
// map, from the closed form of the library, and from the formulas of the document, evaluated here.

#include "Fixtures/FilterRuns.h"

namespace
{

using namespace fixtures;

/// Two triangles on the edge from (-2, 0) to (2, 0). In the target the upper apex is moved up.
MeshPair MakeCounterexample()
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 1, 0, 3 } };
  return { MakeMesh({ { -2, 0, 0 }, { 2, 0, 0 }, { 0, 3, 0 }, { 0, -3, 0 } }, triangles),
    MakeMesh({ { -2, 0, 0 }, { 2, 0, 0 }, { 0, 6, 0 }, { 0, -3, 0 } }, triangles) };
}

Point Image(vtkHomeomorphismTransform* map, double x, double y)
{
  return Transformed(map, { x, y, 0.0 });
}

/// The length of the contour of a half edge that ends at a given distance from the foot, by the
/// formulas of the document. Bisection, which shares no code with the library.
double ContourLength(double h, double b, double edgePoint)
{
  double lower = 0.0;
  double upper = 1.0;
  const auto radius = [=](double s) { return std::hypot(h * (1.0 + s), 2.0 * b * s); };
  for (int i = 0; i < 200; ++i)
  {
    const double s = 0.5 * (lower + upper);
    const double end = b * s * (1.0 + h * (1.0 - s) / (radius(s) + h * (1.0 + s)));
    (end < edgePoint ? lower : upper) = s;
  }
  const double s = 0.5 * (lower + upper);
  const double turn = std::atan2(2.0 * b * s, h * (1.0 + s));
  const double arc = s > 1e-12 ? h * (1.0 - s) * radius(s) / (4.0 * b * s) * turn : 0.5 * h;
  return 0.5 * radius(s) + arc;
}

TEST(Differentiability, OneSidedDerivativesOfContourDifferByTheJump)
{
  // On the middle line it is piecewise linear.
  const auto map = MakeTransform(Contour, MakeCounterexample());
  for (int i = -16; i <= 16; ++i)
  {
    const double y = i / 16.0;
    EXPECT_LT(Distance(Image(map, 0.0, y), { 0.0, i > 0 ? 2.0 * y : y, 0.0 }), 4e-15);
  }
  // The derivatives from above at these shares of the edge; those from below are 1.
  for (const auto& [proportion, derivative] : std::vector<std::pair<double, double>>{
         { 1.0 / 2.0, 2.0 }, { 2.0 / 3.0, 1.73095 }, { 5.0 / 6.0, 1.42977 } })
  {
    const double x = -2.0 + 4.0 * proportion;
    EXPECT_NEAR(ContourLength(2.0, 2.0, x) / ContourLength(1.0, 2.0, x), derivative, 5e-6);
    constexpr double step = 1e-7;
    EXPECT_NEAR(Image(map, x, step)[1] / step, derivative, 6e-6);
    EXPECT_NEAR(Image(map, x, -step)[1] / -step, 1.0, 1e-6);
  }
  EXPECT_NEAR(
    ContourLength(2.0, 2.0, 2.0 - 1e-9) / ContourLength(1.0, 2.0, 2.0 - 1e-9), 1.26491, 5e-6);
  // The five samples of the filter are at sixths of the edge, whose direction does not matter.
  const auto filter = Measure(MakeCounterexample(), Contour);
  for (const char* name : { "JacobianJump", "JacobianJumpExact" })
  {
    const std::vector<double> jumps{ 0.27313, 0.43188, 0.55470, 0.43188, 0.27313 };
    for (std::size_t i = 0; i < 5; ++i)
    {
      EXPECT_NEAR(ValuesOf(PointArray(filter->GetOutput(), name))[i + 1], jumps[i], 5e-6);
    }
    EXPECT_NEAR(PointValue(filter->GetOutput(), name, 3), 2.0 / std::sqrt(13.0), 1e-8);
  }
}

TEST(Differentiability, DirectionsTurnAtDifferentRatesBesideASpoke)
{
  // lambda of the document.
  const auto kappa = [](double rho, double h, double edge) {
    return rho * rho * (2.0 * rho + h) / (h * (rho + h) * edge);
  };
  const double rho = std::sqrt(5.0);
  const double rhoOfImage = std::sqrt(8.0);
  const double besideAB = kappa(rho, 1.0, 4.0) / kappa(rhoOfImage, 2.0, 4.0);
  const double besideCA = kappa(rho, 4.0 / std::sqrt(13.0), std::sqrt(13.0)) /
    kappa(rhoOfImage, 8.0 / std::sqrt(40.0), std::sqrt(40.0));
  EXPECT_NEAR(besideAB, 1.33292, 5e-6);
  EXPECT_NEAR(besideCA, 1.23330, 5e-6);

  // From values of the map: a small turn to either side of the segment from the centroid (0, 1) to
  // A = (-2, 0).
  const auto map = MakeTransform(Contour, MakeCounterexample());
  const double direction = std::atan2(-1.0, -2.0);
  const auto directionOfImage = [&](double turn) {
    constexpr double distance = 0.25;
    const auto image = Image(
      map, distance * std::cos(direction + turn), 1.0 + distance * std::sin(direction + turn));
    return std::atan2(image[1] - 2.0, image[0]);
  };
  constexpr double turn = 1e-6;
  const double straight = directionOfImage(0.0);
  EXPECT_NEAR(straight, std::atan2(-2.0, -2.0), 1e-14);
  // Counterclockwise is the side of AB, clockwise that of CA.
  EXPECT_NEAR((directionOfImage(turn) - straight) / turn, besideAB, 1e-5);
  EXPECT_NEAR((straight - directionOfImage(-turn)) / turn, besideCA, 1e-5);
}

TEST(Differentiability, CreasesOfContourAreAsDocumented)
{
  for (const System& system : { Contour, Incenter })
  {
    const auto filter = Measure(MakeCounterexample(), system, ListEverything);
    // The upper triangle is stretched, the lower one is not. On both sides of the spoke to the
    // upper corner directions turn alike, but distances grow on both sides.
    const auto count = [&filter](int type, int verdict) {
      return filter->GetNumberOfFeatures(type, verdict);
    };
    using Continuity = vtkJacobianContinuity;
    EXPECT_EQ(count(Continuity::EDGE, Continuity::CREASE), 1);
    EXPECT_EQ(count(Continuity::SPOKE, Continuity::CREASE), 3);
    EXPECT_EQ(count(Continuity::SPOKE, Continuity::DIFFERENTIABLE), 3);
    EXPECT_EQ(count(Continuity::TRIANGLE_CENTER, Continuity::CREASE), 1);
    EXPECT_EQ(count(Continuity::WING_SEGMENT, Continuity::CREASE), 0);
    EXPECT_EQ(count(Continuity::CENTER_SEGMENT, Continuity::CREASE), 0);
  }
}

} // namespace
