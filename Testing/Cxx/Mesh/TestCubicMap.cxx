// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The Cubic map: certified, C1, one to one, within MaximumDeviation, with both kinds of bending, on
// random pairs as uneven as convex combinations make them, needles, and boundaries of all kinds.

#include "CubicPairs.h"

#include "Mesh/CubicMap.h"

#include <gtest/gtest.h>

namespace
{

using namespace homeomorphism;
using namespace cubic_test;
using cubic_test::Norm;

/// Certified, and the elements' areas add up to the target's.
void ExpectCertified(const CubicMap& map)
{
  EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, 0);
  EXPECT_TRUE(map.GetStatistics().ExceptionalInteriorPoints.empty());
  const PlanarPair& pair = map.GetPair();
  double area = 0.0;
  double expected = 0.0;
  for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
  {
    EXPECT_GT(map.GetCertificates()[static_cast<std::size_t>(t)], 0.0);
    const std::array<Vector2, 3> target = pair.GetTargetCorners(t);
    expected += 0.5 * Cross(target[1], target[2]);
    map.VisitElements(
      t,
      [&area](const CubicElement& element, const Vector2&, const Vector2&, double factor) {
        // The mean of its Bernstein coefficients is the mean of the determinant.
        const DeterminantCoefficients c = GetDeterminantCoefficients(element);
        area += factor * factor * 0.5 *
          Cross(element.Points[1] - element.Points[0], element.Points[2] - element.Points[0]) *
          std::accumulate(c.begin(), c.end(), 0.0) / 45.0;
      },
      60);
  }
  EXPECT_NEAR(area, expected, 1e-12 * expected);
}

double Norm(const Matrix2& m)
{
  return std::sqrt(SquaredNorm(m));
}

struct Value
{
  Vector2 Image;
  Matrix2 Derivative;

  Value(const CubicMap& map, int triangle, const Vector2& point)
  {
    CubicTriangle prepared = map.Prepare();
    this->Image = map.MapPoint(triangle, point, prepared);
    this->Derivative = map.GetDerivative(triangle, point, prepared);
  }
};

/// Values and derivatives from both sides of each inner edge agree, vertices included. Derivatives
/// are compared with those of the affine maps of the triangles and their neighbors.
void ExpectContinuouslyDifferentiable(const CubicMap& map, double tolerance)
{
  const PlanarPair& pair = map.GetPair();
  const std::vector<std::int32_t>& exceptional = map.GetStatistics().ExceptionalBoundaryPoints;
  const auto isExceptional = [&](int point) {
    return std::count(exceptional.begin(), exceptional.end(), point) > 0;
  };
  for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int neighbor = pair.Neighbors[t][k];
      if (neighbor < t)
      {
        continue;
      }
      double scale = std::max(Norm(pair.GetAffine(t)), Norm(pair.GetAffine(neighbor)));
      for (const int each : { t, neighbor })
      {
        for (const int next : pair.Neighbors[each])
        {
          scale = next < 0 ? scale : std::max(scale, Norm(pair.GetAffine(next)));
        }
      }
      const int start = pair.Triangles[t][NextCorner(k)];
      const int end = pair.Triangles[t][PreviousCorner(k)];
      for (double s : { 0.0, 1e-6, 0.03, 0.2, 0.31, 0.5, 0.7, 0.88, 1.0 })
      {
        if ((s == 0.0 && isExceptional(start)) || (s == 1.0 && isExceptional(end)))
        {
          continue;
        }
        const Vector2 a = pair.Source[start];
        const Vector2 point = s == 1.0 ? pair.Source[end] : a + s * (pair.Source[end] - a);
        const Value one(map, t, point);
        const Value other(map, neighbor, point);
        EXPECT_LT(Norm(one.Image - other.Image), 1e-14);
        EXPECT_LT(Norm(one.Derivative - other.Derivative), tolerance * scale)
          << t << " " << k << " " << s;
      }
    }
  }
}

void ExpectRoundTrip(const CubicMap& map, int count, double deviation = 1e300)
{
  const PlanarPair& pair = map.GetPair();
  double size = 1.0;
  for (std::size_t i = 0; i < pair.Source.size(); ++i)
  {
    size = std::max({ size, Norm(pair.Source[i]), Norm(pair.Target[i]) });
  }
  CubicTriangle prepared = map.Prepare();
  for (const Sample& sample : RandomSamples(pair, 3, count))
  {
    const Vector2 point = sample.In(pair, pair.Source);
    const Value value(map, sample.Triangle, point);
    EXPECT_GT(value.Derivative.Determinant(), 0.0);
    EXPECT_LE(Norm(value.Image - sample.In(pair, pair.Target)), deviation + 1e-14);
    int triangle = LocateImage(pair, value.Image, sample.Triangle);
    Vector2 back;
    ASSERT_TRUE(map.FindPreimage(value.Image, triangle, back));
    const double norm = Norm(value.Derivative);
    const double condition = std::max(1.0, norm) * norm / value.Derivative.Determinant();
    EXPECT_LE(Norm(back - point), 1e-13 * size * condition);
    EXPECT_LE(Norm(map.MapPoint(triangle, back, prepared) - value.Image), 1e-13 * size);
  }
}

/// A grid, and its image by a smooth map that keeps the square: all vertices of the boundary but
/// the corners are straight.
PlanarPair DisplacedGrid(int cells)
{
  Random random(32);
  PlanarPair pair = JitteredGrid(random, cells, 0.2);
  for (Vector2& p : pair.Target)
  {
    const bool isInside = p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0;
    const double x = 3.141592653589793 * p.x;
    const double y = 3.141592653589793 * p.y;
    const Vector2 move{ std::sin(x) * std::sin(2.0 * y), std::sin(2.0 * x) * std::sin(y) };
    p = p + (isInside ? 0.03 : 0.0) * move;
  }
  return pair;
}

/// A polygon with a vertex in its middle.
PlanarPair Wheel(const LargeVector<Vector2>& source, const LargeVector<Vector2>& target)
{
  PlanarPair pair;
  pair.Source = source;
  pair.Target = target;
  AddHub(pair, { 0.03, -0.02 }, { -0.05, 0.04 });
  return pair;
}

} // anonymous namespace

using CubicMaps = testing::TestWithParam<CubicBending>;

INSTANTIATE_TEST_SUITE_P(
  Bending, CubicMaps, testing::Values(CubicBending::Local, CubicBending::Least));

TEST_P(CubicMaps, AreCertifiedAndC1)
{
  int seed = GetParam() == CubicBending::Local ? 0 : 5;
  for (double strength : { 0.0, 0.5, 1.2, 2.0, 3.0 })
  {
    const CubicMap map(RandomPair(++seed, strength, 7), Options(GetParam()));
    ExpectCertified(map);
    EXPECT_TRUE(map.GetStatistics().ExceptionalBoundaryPoints.empty());
    // Heights above the edges fall with the ratio of areas, and J turns within them.
    ExpectContinuouslyDifferentiable(map, strength < 1.5 ? 1e-10 : 1e-7);
    ExpectRoundTrip(map, 300);
  }
}

TEST(CubicMap, CutsOnlySomeTriangles)
{
  // One vertex moves far, all others stay: slaves between cut and whole triangles.
  Random random(5);
  PlanarPair pair = JitteredGrid(random, 10, 0.2);
  const int middle = 5 * 11 + 5;
  pair.Target[middle] = pair.Target[middle] + Vector2{ 0.076, 0.02 };
  const CubicMap map(pair, Options(CubicBending::Least));
  ExpectCertified(map);
  EXPECT_GT(map.GetStatistics().Bending.CutTriangles, 0);
  EXPECT_LT(map.GetStatistics().Bending.CutTriangles, 100);
  ExpectContinuouslyDifferentiable(map, 1e-10);
  ExpectRoundTrip(map, 1000);
}

TEST(CubicMap, RefinementBendsLess)
{
  const PlanarPair pair = RandomPair(21, 0.3, 5);
  CubicMapOptions options;
  const CubicMap coarse(pair, options);
  options.FairnessRefinement = 1;
  const CubicMap fine(pair, options);
  ExpectCertified(fine);
  ExpectContinuouslyDifferentiable(fine, 1e-10);
  ExpectRoundTrip(fine, 500);
  EXPECT_LT(fine.GetStatistics().Bending.Energy, coarse.GetStatistics().Bending.Energy);
  // Vertices stay on vertices.
  for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
  {
    const int corner = pair.Triangles[t][1];
    EXPECT_LT(Norm(Value(fine, t, pair.Source[corner]).Image - pair.Target[corner]), 1e-15);
  }
}

TEST_P(CubicMaps, AffinePairsAreReproduced)
{
  for (bool identity : { true, false })
  {
    PlanarPair pair = RandomPair(31, 0.0, 6);
    const Matrix2 affine =
      identity ? Matrix2{ { 1.0, 0.0 }, { 0.0, 1.0 } } : Matrix2{ { 1.5, 0.25 }, { -0.75, 2.0 } };
    std::transform(pair.Source.begin(), pair.Source.end(), pair.Target.begin(),
      [&affine](const Vector2& p) { return affine * p; });
    const CubicMap map(pair, Options(GetParam()));
    for (const Sample& sample : RandomSamples(pair, 1, 1000))
    {
      const Vector2 point = sample.In(pair, pair.Source);
      const Value value(map, sample.Triangle, point);
      EXPECT_LT(Norm(value.Image - affine * point), 4e-16 * (identity ? 1.0 : 4.0));
      EXPECT_LT(Norm(value.Derivative - affine), 1e-11);
    }
  }
}

TEST_P(CubicMaps, DerivativesInNeedlesAreAccurate)
{
  PlanarPair pair = Moved(RandomPair(31, 0.0, 6), [](const Vector2& p) {
    return Vector2{ p.x, std::ldexp(p.y, -20) };
  });
  pair.Target = pair.Source;
  const CubicMap map(pair, Options(GetParam()));
  for (const Sample& sample : RandomSamples(pair, 1, 1000))
  {
    const Value value(map, sample.Triangle, sample.In(pair, pair.Source));
    EXPECT_LT(Norm(value.Derivative - Matrix2{ { 1.0, 0.0 }, { 0.0, 1.0 } }), 1e-12);
  }
}

TEST_P(CubicMaps, KeepsItsDeviation)
{
  const PlanarPair pair = RandomPair(41, 1.0, 6);
  for (double deviation : { 1e-2, 1e-4, 1e-6 })
  {
    CubicMapOptions options = Options(GetParam());
    options.MaximumDeviation = deviation;
    const CubicMap map(pair, options);
    ExpectCertified(map);
    ExpectRoundTrip(map, 300, deviation);
  }
}

TEST(CubicMap, NeedlesAreCertified)
{
  Random random(5);
  for (int n = 0; n < 10000; ++n)
  {
    SCOPED_TRACE(n);
    const CubicMap map(RandomNeedles(random, 20.0), Options(CubicBending::Local));
    EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, 0);
    ExpectRoundTrip(map, 40);
  }
}

TEST_P(CubicMaps, CertifiedTrianglesBesideOthersStayInTheTarget)
{
  // A triangle on the edge of another one, so thin in the source that often one of them is not
  // certified.
  Random random(35);
  int certified = 0;
  for (int n = 0; n < 200; ++n)
  {
    const double turn = random.Uniform(0.0, 6.283185307179586);
    const Vector2 shift{ random.Uniform(), random.Uniform() };
    const Vector2 along{ std::cos(turn), std::sin(turn) };
    const auto place = [&](double x, double y) {
      return shift + x * along + y * Vector2{ -along.y, along.x };
    };
    const double foot = random.Uniform();
    const double shear = n % 2 == 0 ? 2.0 : random.PowerOfTen(-12.0, 0.0);
    const double height = n % 2 == 0 ? 1e-8 : random.PowerOfTen(-16.0, -7.0);
    const auto sheared = [&](double x) { return x + shear * random.Uniform(-0.5, 0.5); };
    PlanarPair pair;
    pair.Source = { place(0.0, 0.0), place(1.0, 0.0), place(foot, height), place(0.5, -1.0) };
    pair.Target = { { 0.0, 0.0 }, { 1.0, 0.0 }, { sheared(foot), random.Uniform(0.5, 1.5) },
      { sheared(0.5), -1.0 } };
    pair.Triangles = { { 0, 1, 2 }, { 1, 0, 3 } };
    pair.FindNeighbors();
    const CubicMap map(pair, Options(GetParam()));
    CubicTriangle prepared = map.Prepare();
    for (const Sample& sample : RandomSamples(pair, static_cast<std::uint64_t>(n), 400))
    {
      if (!map.IsCertified(sample.Triangle))
      {
        continue;
      }
      ++certified;
      const Vector2 image = map.MapPoint(sample.Triangle, sample.In(pair, pair.Source), prepared);
      double outside = 1.0;
      for (int t = 0; t < 2; ++t)
      {
        const Barycentric l =
          ToBarycentric(pair.GetTargetCorners(t), image - pair.Target[pair.Triangles[t][0]]);
        outside = std::min(outside, -std::min({ l[0], l[1], l[2] }));
      }
      // Rounding of the point, stretched as much as the thin triangle.
      ASSERT_LT(outside, 1e-14 + 1e-13 / height) << n << " " << height;
    }
  }
  EXPECT_GT(certified, 20000);
}

TEST_P(CubicMaps, TrianglesAsThinAsRoundingAreNotCertified)
{
  // Two neighbors in the middle of a grid are a few rounding units apart in the source.
  for (const double ulps : { 1.0, 4.0, 30.0, 1000.0, 1e5 })
  {
    SCOPED_TRACE(ulps);
    Random random(36);
    PlanarPair pair = JitteredGrid(random, 8, 0.0);
    pair.Source[41].x = pair.Source[40].x + ulps * 0x1p-53;
    const CubicMap map(pair, Options(GetParam()));
    CubicTriangle prepared = map.Prepare();
    for (Sample sample : RandomSamples(pair, 37, 300))
    {
      for (sample.Triangle = 0; sample.Triangle < pair.GetNumberOfTriangles(); ++sample.Triangle)
      {
        if (map.IsCertified(sample.Triangle))
        {
          const Vector2 image =
            map.MapPoint(sample.Triangle, sample.In(pair, pair.Source), prepared);
          ASSERT_LT(Norm(image - Vector2{ 0.5, 0.5 }), 0.8) << sample.Triangle;
        }
      }
    }
  }
}

TEST(CubicMap, FarFromTheOrigin)
{
  // Steps of 2^-28 there: the same differences.
  const auto away = [](const Vector2& p) {
    return Vector2{ std::round(p.x * 0x1p20) * 0x1p-20 + 0x1p24,
      std::round(p.y * 0x1p20) * 0x1p-20 + 0x1p24 };
  };
  const CubicMap map(Moved(RandomPair(61, 1.0, 6), away), Options(CubicBending::Local));
  ExpectCertified(map);
}

TEST_P(CubicMaps, BoundaryCornersAreDifferentiableWhereTheyCanBe)
{
  // A square with points on its sides, against itself with the points moved along the sides.
  const LargeVector<Vector2> square{ { -1.0, -1.0 }, { 0.0, -1.0 }, { 1.0, -1.0 }, { 1.0, 0.0 },
    { 1.0, 1.0 }, { 0.0, 1.0 }, { -1.0, 1.0 }, { -1.0, 0.0 } };
  LargeVector<Vector2> moved = square;
  moved[1].x = 0.5;
  moved[3].y = -0.4;
  moved[5].x = 0.3;
  const CubicMap map(Wheel(square, moved), Options(GetParam()));
  ExpectCertified(map);
  EXPECT_TRUE(map.GetStatistics().ExceptionalBoundaryPoints.empty());
  ExpectContinuouslyDifferentiable(map, 1e-11);
  // Sides stay on sides.
  for (int i = 0; i < 8; ++i)
  {
    for (double s : { 0.1, 0.2, 0.5, 0.77 })
    {
      const Vector2 next = square[static_cast<std::size_t>((i + 1) % 8)];
      const Vector2 here = square[static_cast<std::size_t>(i)];
      const Vector2 image = Value(map, i, here + s * (next - here)).Image;
      EXPECT_LT(std::abs(std::max(std::abs(image.x), std::abs(image.y)) - 1.0), 1e-14);
    }
  }
}

TEST_P(CubicMaps, BoundaryCornersStraightOnOneSideAreListed)
{
  const LargeVector<Vector2> square{ { -1.0, -1.0 }, { 0.0, -1.0 }, { 1.0, -1.0 }, { 1.0, 1.0 },
    { -1.0, 1.0 } };
  LargeVector<Vector2> bent = square;
  bent[1].y = -1.5;
  const CubicMap map(Wheel(square, bent), Options(GetParam()));
  ExpectCertified(map);
  EXPECT_EQ(map.GetStatistics().ExceptionalBoundaryPoints, std::vector<std::int32_t>{ 1 });
  // C1 all the way to it.
  ExpectContinuouslyDifferentiable(map, 1e-9);
  ExpectRoundTrip(map, 1000);
}

TEST(CubicMap, StarsBeyondTheProgramHaveRings)
{
  int rings = 0;
  Random random(71);
  for (int n = 0; n < 60; ++n)
  {
    const CubicMap map(RandomStar(random, 3 + n % 6, 0.5), Options(CubicBending::Local));
    ExpectCertified(map);
    if (map.GetStatistics().Rings > 0)
    {
      ++rings;
      // Rings have small elements.
      ExpectContinuouslyDifferentiable(map, 2e-7);
      ExpectRoundTrip(map, 100);
    }
  }
  EXPECT_GT(rings, 0);
}

TEST_P(CubicMaps, PointsWithinRoundingOfExceptionalVerticesKeepTheirSense)
{
  Random random(38);
  for (int n = 0; n < 40; ++n)
  {
    const PlanarPair pair = RandomStar(random, 4 + n % 7, 1.5);
    const CubicMap map(pair, Options(GetParam()));
    CubicTriangle prepared = map.Prepare();
    const std::vector<std::int32_t>& exceptional = map.GetStatistics().ExceptionalBoundaryPoints;
    for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
    {
      for (int k = 0; k < 3 && map.IsCertified(t); ++k)
      {
        const int point = pair.Triangles[t][k];
        if (std::count(exceptional.begin(), exceptional.end(), point) == 0)
        {
          continue;
        }
        for (int digits = 10; digits < 64; ++digits)
        {
          const double share = std::pow(10.0, -0.25 * digits);
          for (const int other : { NextCorner(k), PreviousCorner(k) })
          {
            const Vector2 start = pair.Source[point];
            const Vector2 end = pair.Source[pair.Triangles[t][other]];
            EXPECT_GT(
              map.GetDerivative(t, start + share * (end - start), prepared).Determinant(), 0.0)
              << n << " " << t << " " << share;
          }
        }
      }
    }
  }
}

TEST(CubicMap, RingsLeadToADerivativeWhereSectorsAreAlmostHalfTurns)
{
  // At vertices of these, images of sectors are 177 to 180 degrees beside others of a hundredth.
  for (double strength : { 3.0, 4.0 })
  {
    const CubicMap map(RandomPair(3, strength), Options(CubicBending::Local));
    ExpectCertified(map);
    EXPECT_GT(map.GetStatistics().Rings, 0);
    ExpectRoundTrip(map, 500);
  }
  // Far from what can be done without rings that turn the rays.
  Random random(72);
  for (int n = 0; n < 200; ++n)
  {
    const CubicMap map(RandomStar(random, 3 + n % 7, 2.8), Options(CubicBending::Local));
    ExpectCertified(map);
    EXPECT_LT(map.GetStatistics().Rings, 30);
  }
}

TEST(CubicMap, DoesNotDependOnThreads)
{
  const ParallelFor pieces = [](std::int64_t count, const auto& body) {
    for (std::int64_t begin = count - 1; begin >= 0; --begin)
    {
      body(begin, begin + 1);
    }
  };
  for (const PlanarPair& pair : { RandomPair(81, 1.0, 6), DisplacedGrid(40) })
  {
    const CubicMap first(pair, CubicMapOptions());
    const CubicMap second(pair, CubicMapOptions(), pieces);
    for (const Sample& sample : RandomSamples(pair, 1, 500))
    {
      const Vector2 point = sample.In(pair, pair.Source);
      const Vector2 image = Value(first, sample.Triangle, point).Image;
      const Vector2 again = Value(second, sample.Triangle, point).Image;
      EXPECT_TRUE(image.x == again.x && image.y == again.y);
    }
  }
}

TEST(CubicMap, BoundsOfSmoothPairsAreBelowAllCoefficients)
{
  for (double size : { 0.02, 0.1, 0.2 })
  {
    Random random(31);
    PlanarPair pair = JitteredGrid(random, 40, 0.3);
    for (Vector2& p : pair.Target)
    {
      p = p + size * std::sin(3.0 * p.x) * Vector2{ std::sin(4.0 * p.y), std::cos(2.0 * p.x) };
    }
    const CubicMap map(pair, Options(CubicBending::Local));
    int bounded = 0;
    for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
    {
      double least = pair.GetAffine(t).Determinant();
      map.VisitElements(
        t, [&least](const CubicElement& element, const Vector2&, const Vector2&, double) {
          const DeterminantCoefficients c = GetDeterminantCoefficients(element);
          least = std::min(least, *std::min_element(c.begin(), c.end()));
        });
      const double certificate = map.GetCertificates()[static_cast<std::size_t>(t)];
      const double ratio = least / pair.GetAffine(t).Determinant();
      EXPECT_GT(certificate, 0.0);
      // Subdivision raises coefficients, but only small ones.
      EXPECT_LE(certificate, std::max(ratio, 1e-3) + 1e-12) << t;
      bounded += certificate > 0.3 && certificate < ratio - 1e-6 ? 1 : 0;
    }
    EXPECT_GT(2 * bounded, pair.GetNumberOfTriangles());
  }
}

TEST(CubicMap, ConjugateGradientsFindWhatEliminationFinds)
{
  const PlanarPair pair = DisplacedGrid(12);
  const CubicTemplate cubicTemplate(pair, {});
  BendingSolution gradients;
  ASSERT_TRUE(SolveWithWholeTriangles(cubicTemplate, {}, gradients));
  const BendingSolution elimination = SolveForLeastBending(cubicTemplate, {}, {});
  EXPECT_EQ(elimination.Statistics.Rounds, 1);
  EXPECT_GE(gradients.Statistics.Energy, (1.0 - 1e-11) * elimination.Statistics.Energy);
  EXPECT_LE(gradients.Statistics.Energy, (1.0 + 1e-8) * elimination.Statistics.Energy);
  double greatest = 0.0;
  double difference = 0.0;
  for (std::size_t n = 0; n < pair.Source.size(); ++n)
  {
    const Matrix2& exact = elimination.Points[n].Gradient;
    greatest = std::max(greatest, Norm(cubicTemplate.GetDerivative(static_cast<int>(n)) - exact));
    difference = std::max(difference, Norm(gradients.Points[n].Gradient - exact));
  }
  EXPECT_LT(difference, 1e-4 * greatest);
}

TEST(CubicMap, SystemsThatAreNotSolvedLeaveTheTemplate)
{
  BendingOptions iterative;
  iterative.DirectUnknowns = 0;
  const PlanarPair even = RandomPair(5, 0.3, 6);
  const CubicTemplate templateOfEven(even, {});
  const double energy = SolveForLeastBending(templateOfEven, {}, {}).Statistics.Energy;
  EXPECT_NEAR(
    SolveForLeastBending(templateOfEven, iterative, {}).Statistics.Energy, energy, 1e-9 * energy);

  const auto expectTemplate = [](const PlanarPair& pair, const BendingOptions& options) {
    const CubicTemplate cubicTemplate(pair, {});
    const BendingSolution solution = SolveForLeastBending(cubicTemplate, options, {});
    EXPECT_TRUE(solution.Statistics.TookTemplate);
    EXPECT_EQ(solution.Statistics.CutTriangles, pair.GetNumberOfTriangles());
    EXPECT_EQ(solution.Statistics.TemplateTriangles, pair.GetNumberOfTriangles());
  };
  // Conjugate gradients do not converge where elements are thin.
  PlanarPair uneven = RandomPair(5, 1.2, 6);
  expectTemplate(uneven, iterative);
  // Nothing determines the derivative at a point without triangles: the matrix is singular.
  uneven.Source.push_back({});
  uneven.Target.push_back({});
  expectTemplate(uneven, {});
}

TEST(CubicMap, ClosedFormsAgreeWithTheElements)
{
  for (double strength : { 0.0, 1.2, 3.0 })
  {
    const PlanarPair pair = RandomPair(16, strength, 8);
    const CubicTemplate cubicTemplate(pair, {});
    CubicTriangle triangle(cubicTemplate, nullptr, CubicTriangle::ManyTriangles);
    for (const Sample& sample : RandomSamples(pair, 17, 20000))
    {
      const std::array<Vector2, 3> corners = pair.GetSourceCorners(sample.Triangle);
      const Vector2 point = sample.Weights[1] * corners[1] + sample.Weights[2] * corners[2];
      Vector2 image;
      Matrix2 derivative;
      cubicTemplate.Evaluate(sample.Triangle, point, image, derivative);
      triangle.Set(sample.Triangle);
      // In the plane's axes, as elements are evaluated here, very thin ones lose digits.
      EXPECT_LT(Norm(triangle.Map(point) - image), strength < 2.0 ? 1e-14 : 1e-12);
      Vector2 step;
      const Vector2 wanted = image + Vector2{ 1e-3, -2e-3 };
      const Vector2 residual = triangle.GetResidual(point, wanted, false, step);
      EXPECT_LT(Norm(derivative * step - residual),
        (strength < 2.0 ? 1e-9 : 1e-7) * Norm(derivative) * (1e-3 + Norm(step)));
      // Whether the element of the last point is tried first does not matter.
      const Vector2 near = 0.97 * point;
      const Vector2 tried = triangle.GetResidual(near, wanted, true, step);
      EXPECT_LT(Norm(triangle.GetResidual(near, wanted, false, step) - tried),
        strength < 2.0 ? 1e-14 : 1e-12);
    }
  }
}

TEST_P(CubicMaps, BatchesGiveTheBitsOfSinglePoints)
{
  for (const auto& [refinement, strength] :
    std::vector<std::pair<int, double>>{ { 0, 0.0 }, { 0, 0.4 }, { 0, 1.2 }, { 1, 0.4 } })
  {
    CubicMapOptions options = Options(GetParam());
    options.FairnessRefinement = GetParam() == CubicBending::Least ? refinement : 0;
    const CubicMap map(RandomPair(18, strength, 5), options);
    const PlanarPair& pair = map.GetPair();
    CubicTriangle prepared = map.Prepare();
    std::vector<Sample> samples = RandomSamples(pair, 19, 10 * CubicBatch::Size);
    for (int round = 0; round < 10; ++round)
    {
      // Runs of one to sixteen points in a triangle, half of them in neighbors as in a scan.
      Sample* const first = &samples[static_cast<std::size_t>(round * CubicBatch::Size)];
      const int count = CubicBatch::Capacity - round;
      for (int i = 1; i < count; ++i)
      {
        if (i % (7 * round + 1) % 16 != 0)
        {
          first[i].Triangle = first[i - 1].Triangle;
        }
        else if (round % 2 == 0)
        {
          const int last = first[i - 1].Triangle;
          first[i].Triangle = std::max(last, pair.Neighbors[last][i % 3]);
        }
      }
      const auto set = [](CubicBatch& batch, int i, const Sample& sample, const Vector2& point) {
        if (i < CubicBatch::Capacity)
        {
          batch.Triangles[i] = sample.Triangle;
        }
        batch.X[i] = point.x;
        batch.Y[i] = point.y;
        for (int k = 0; k < 3; ++k)
        {
          batch.L[k][i] = sample.Weights[k];
        }
      };
      for (const bool inverse : { false, true })
      {
        const auto pointOf = [&](int i) {
          return first[i].In(pair, inverse ? pair.Target : pair.Source);
        };
        CubicBatch batch;
        batch.Count = count;
        for (int i = 0; i < CubicBatch::Size; ++i)
        {
          set(batch, i, first[i], pointOf(std::min(i, count - 1)));
        }
        inverse ? map.FindPreimages(batch, prepared) : map.MapPoints(batch, prepared);
        for (int i = 0; i < count; ++i)
        {
          CubicBatch single;
          single.Count = 1;
          for (int k = 0; k < WidestVector; ++k)
          {
            set(single, k, first[i], pointOf(i));
          }
          CubicTriangle fresh = map.Prepare();
          inverse ? map.FindPreimages(single, fresh) : map.MapPoints(single, fresh);
          EXPECT_EQ(batch.Triangles[i], single.Triangles[0]);
          EXPECT_EQ(batch.ImageX[i], single.ImageX[0]);
          EXPECT_EQ(batch.ImageY[i], single.ImageY[0]);
          const Vector2 found{ batch.ImageX[i], batch.ImageY[i] };
          if (!inverse)
          {
            const Vector2 alone =
              map.MapPoint(first[i].Triangle, first[i].Weights, pointOf(i), fresh);
            EXPECT_TRUE(alone.x == found.x && alone.y == found.y);
          }
          const Vector2 image = inverse ? map.MapPoint(batch.Triangles[i], found, fresh)
                                        : map.MapPoint(first[i].Triangle, pointOf(i), fresh);
          EXPECT_LT(Norm(image - (inverse ? pointOf(i) : found)), 1e-13);
          // Nor do the points before it change the image of a single point.
          const Vector2 again = inverse ? map.MapPoint(batch.Triangles[i], found, prepared)
                                        : map.MapPoint(first[i].Triangle, pointOf(i), prepared);
          EXPECT_TRUE(image.x == again.x && image.y == again.y);
        }
      }
    }
  }
}

TEST_P(CubicMaps, LengthsThatOverflowAreNotCertified)
{
  for (double scale : { 1e160, 1e-170, 1e300 })
  {
    const PlanarPair pair =
      Moved(RandomPair(22, 0.5, 3), [scale](const Vector2& p) { return scale * p; });
    const CubicMap map(pair, Options(GetParam()));
    EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, pair.GetNumberOfTriangles()) << scale;
  }
}

TEST_P(CubicMaps, PointsOutsideHaveNoPreimage)
{
  for (double strength : { 0.0, 1.2 })
  {
    const CubicMap map(RandomPair(20, strength, 4), Options(GetParam()));
    for (const Vector2& image : { Vector2{ -0.5, 0.3 }, Vector2{ 3.0, 7.0 }, Vector2{ 1.01, 0.5 } })
    {
      int triangle = 0;
      Vector2 point;
      EXPECT_FALSE(map.FindPreimage(image, triangle, point));
    }
  }
}

TEST(CubicMap, RefinedTemplatesAreCertifiedByTheirOwnTriangles)
{
  // With a margin above 1 the solver always ends with the template, of the refined pair.
  CubicMapOptions options = Options(CubicBending::Least);
  options.FairnessRefinement = 1;
  options.CertificateMargin = 2.0;
  const CubicMap map(RandomPair(9, 2.0, 3), options);
  const PlanarPair& pair = map.GetPair();
  ASSERT_TRUE(map.GetStatistics().Bending.TookTemplate);
  EXPECT_EQ(map.GetStatistics().Elements, 4 * 19 * pair.GetNumberOfTriangles());
  for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
  {
    double least = std::numeric_limits<double>::infinity();
    map.VisitElements(
      t, [&least](const CubicElement& element, const Vector2&, const Vector2&, double) {
        least = std::min(least, LeastDeterminant(element));
      });
    least /= pair.GetAffine(t).Determinant();
    EXPECT_NEAR(map.GetCertificates()[static_cast<std::size_t>(t)], least, 1e-9 * least) << t;
  }
}

TEST(CubicMap, PartsTurnedOverByRoundingAreNotCertified)
{
  // Needles a few ulp high: the midpoints of their edges are rounded to either side.
  Random random(14);
  int turned = 0;
  for (int n = 0; n < 80; ++n)
  {
    PlanarPair pair;
    const Vector2 a{ random.Uniform(1.0, 2.0), random.Uniform(1.0, 2.0) };
    const Vector2 b{ random.Uniform(2.0, 3.0), random.Uniform(1.0, 2.0) };
    Vector2 c = a + random.Uniform() * (b - a);
    c.y = std::nextafter(std::nextafter(c.y, 3.0), 3.0);
    pair.Source = { a, b, c };
    pair.Target = pair.Source;
    pair.Triangles = { { 0, 1, 2 } };
    pair.FindNeighbors();
    if (!(Cross(b - a, c - a) > 0.0))
    {
      continue;
    }
    CubicMapOptions options = Options(CubicBending::Least);
    options.FairnessRefinement = 1;
    const CubicMap map(pair, options);
    bool isTurned = false;
    const PlanarPair fine = pair.Refine();
    for (int t = 0; t < fine.GetNumberOfTriangles(); ++t)
    {
      const std::array<Vector2, 3> corners = fine.GetSourceCorners(t);
      isTurned = isTurned || !(Cross(corners[1], corners[2]) > 0.0);
    }
    turned += isTurned ? 1 : 0;
    EXPECT_FALSE(isTurned && map.GetCertificates()[0] > 0.0) << n;
  }
  EXPECT_GT(turned, 3);
}

void ExpectExactPreimages(const CubicMap& map, int count, double tolerance)
{
  const PlanarPair& pair = map.GetPair();
  CubicTriangle prepared = map.Prepare();
  for (const Sample& sample : RandomSamples(pair, 8, count))
  {
    const Vector2 image = sample.In(pair, pair.Target);
    int triangle = sample.Triangle;
    Vector2 point;
    ASSERT_TRUE(map.FindPreimage(image, triangle, point, prepared));
    ASSERT_LE(Norm(map.MapPoint(triangle, point, prepared) - image), tolerance);
  }
}

TEST(CubicMap, PreimagesAreExactWhereSecondDerivativesChangeSign)
{
  // Between inflections the first of Newton's steps may by chance come much closer than the next.
  // One component bends, so that this happens along whole lines.
  Random random(7);
  PlanarPair pair = JitteredGrid(random, 3, 0.0);
  for (Vector2& p : pair.Target)
  {
    p.x += 0.13 * std::sin(6.283185307179586 * p.x);
  }
  ExpectExactPreimages(CubicMap(pair, Options(CubicBending::Least)), 1000000, 4e-15);
}

TEST(CubicMap, PreimagesUnderTheTemplateAreExact)
{
  // In needles, rounding a point moves its image.
  for (const double width : { 1.0, 0.1, 0.01, 1e-4 })
  {
    PlanarPair pair = RandomPair(20, 1.2, 4);
    for (Vector2& point : pair.Source)
    {
      point.y *= width;
      point = { 0.8 * point.x - 0.6 * point.y, 0.6 * point.x + 0.8 * point.y };
    }
    ExpectExactPreimages(CubicMap(pair, Options(CubicBending::Local)), 200000, 2e-15 / width);
  }
}

TEST(CubicMap, DeterminantsArePositiveOnBothSidesOfRoundedEdges)
{
  // Elements beside edges can be so thin that rounding moves a point by 1e-8 of their height.
  for (int seed = 0; seed < 20; ++seed)
  {
    const CubicMap map(RandomPair(seed, 4.0, 11), Options(CubicBending::Local));
    const PlanarPair& pair = map.GetPair();
    CubicTriangle prepared = map.Prepare();
    for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
    {
      for (int k = 0; k < 3; ++k)
      {
        const Vector2& start = pair.Source[pair.Triangles[t][k]];
        const Vector2 edge = pair.Source[pair.Triangles[t][NextCorner(k)]] - start;
        for (double s = 0.5; s > 1e-6; s *= 0.7)
        {
          EXPECT_GT(map.GetDerivative(t, start + s * edge, prepared).Determinant(), 0.0) << seed;
        }
      }
    }
  }
}

TEST_P(CubicMaps, PartsMayTouchInAPoint)
{
  // An hourglass whose halves share a point only.
  PlanarPair pair;
  pair.Source = { { 0.0, 0.0 }, { 1.0, 0.0 }, { 0.5, 1.0 }, { 0.0, 2.0 }, { 0.6, 2.1 },
    { 1.0, 2.0 } };
  pair.Target = { { 0.1, 0.0 }, { 1.0, 0.2 }, { 0.5, 1.0 }, { 0.0, 1.8 }, { 0.5, 2.0 },
    { 1.3, 2.2 } };
  pair.Triangles = { { 0, 1, 2 }, { 2, 5, 4 }, { 2, 4, 3 } };
  pair.FindNeighbors();
  for (double deviation : { 1e300, 1e-3 })
  {
    CubicMapOptions options = Options(GetParam());
    options.MaximumDeviation = deviation;
    const CubicMap map(pair, options);
    EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, 0);
    EXPECT_EQ(map.GetStatistics().ExceptionalBoundaryPoints, std::vector<int>{ 2 });
    ExpectRoundTrip(map, 600, deviation);
    for (int t = 0; t < 3; ++t)
    {
      EXPECT_LT(Norm(Value(map, t, pair.Source[2]).Image - pair.Target[2]), 1e-15);
    }
  }
}

TEST(CubicMap, BendingFallsFromRoundToRound)
{
  // In the last round for the second pair, it would rise.
  for (const auto& [seed, strength] : { std::pair(29, 2.0), std::pair(26, 2.5) })
  {
    const CubicMap map(RandomPair(seed, strength, 5), Options(CubicBending::Least));
    EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, 0);
    const BendingStatistics& bending = map.GetStatistics().Bending;
    const std::vector<double>& energies = bending.MinimizedEnergies;
    ASSERT_GT(energies.size(), 2U);
    // Elements that are far thinner than their triangles count less.
    EXPECT_LT(energies.back(), 0.9 * bending.Energy);
    for (std::size_t n = 1; n < energies.size(); ++n)
    {
      EXPECT_LT(energies[n], energies[n - 1]);
    }
    EXPECT_LT(energies.back(), 0.5 * energies.front());
  }
}

TEST(CubicMap, StripsAndCornersLeaveNoGap)
{
  const PlanarPair pair = RandomPair(15, 0.5, 12);
  const CubicTemplate cubicTemplate(pair, {});
  for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
  {
    const TriangleCut cut = cubicTemplate.GetCut(t);
    for (int k = 0; k < 3; ++k)
    {
      const Vector2 along = cut.Along[k];
      const Vector2 normal{ -along.y, along.x };
      for (int ulps = -8; ulps <= 8; ++ulps)
      {
        // Halfway from an edge point to its inner point, where the map differs from the affine one.
        const double shift = ulps * 0x1p-54;
        const Vector2 high = 0.5 * cut.Heights[k] * normal;
        const Vector2 start =
          cut.Corners[NextCorner(k)] + ((cut.Radii[NextCorner(k)] + shift) * along + high);
        const Vector2 end =
          cut.Corners[PreviousCorner(k)] - ((cut.Radii[PreviousCorner(k)] + shift) * along - high);
        EXPECT_LT(cut.Find(start), TriangleCut::FirstMiddle) << t << " " << k;
        EXPECT_LT(cut.Find(end), TriangleCut::FirstMiddle) << t << " " << k;
      }
    }
  }
}
