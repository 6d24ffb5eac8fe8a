// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The Cubic map: certified, C1, one to one, within its deviation, with both kinds of bending, on
// random pairs as uneven as convex combinations make them, needles, and boundaries of all kinds.

#include "CubicPairs.h"

#include "Mesh/CubicMap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace
{

using namespace homeomorphism;
using namespace cubic_test;

struct Sample
{
  int Triangle;
  Barycentric At;
};

/// Points of triangles, a third of them close to a corner and a third close to an edge.
class Sampler
{
public:
  Sampler(const PlanarPair& pair, std::uint64_t seed)
    : Pair(pair)
    , Random(seed)
  {
  }

  Sample operator()()
  {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Sample sample;
    sample.Triangle = static_cast<int>(
      this->Random() % static_cast<std::uint64_t>(this->Pair.GetNumberOfTriangles()));
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const double power = this->Count % 3 == 0 ? 1.0
        : this->Count % 3 == 1                  ? (i == 0 ? 1.0 : 12.0)
                                                : (i == 0 ? 12.0 : 1.0);
      sample.At[i] = std::pow(uniform(this->Random), power) + 1e-30;
      sum += sample.At[i];
    }
    std::rotate(sample.At.begin(), sample.At.begin() + this->Count / 3 % 3, sample.At.end());
    for (double& l : sample.At)
    {
      l /= sum;
    }
    ++this->Count;
    return sample;
  }

private:
  const PlanarPair& Pair;
  std::mt19937_64 Random;
  int Count = 0;
};

Vector2 PointAt(const PlanarPair& pair, const std::vector<Vector2>& points, const Sample& s)
{
  const std::array<Vector2, 3> c = PlanarPair::GetCorners(points, pair.Triangles[s.Triangle]);
  return points[pair.Triangles[s.Triangle][0]] + (s.At[1] * c[1] + s.At[2] * c[2]);
}

/// The triangle in which the piecewise linear map has an image.
int LocateImage(const PlanarPair& pair, const Vector2& image, int hint)
{
  const int found = Locate(pair, pair.Target, hint, image);
  return found < 0 ? hint : found;
}

double Scale(const PlanarPair& pair, int t)
{
  double scale = std::sqrt(SquaredNorm(pair.GetAffine(t)));
  for (int neighbor : pair.Neighbors[t])
  {
    if (neighbor >= 0)
    {
      scale = std::max(scale, std::sqrt(SquaredNorm(pair.GetAffine(neighbor))));
    }
  }
  return scale;
}

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
        double sum = 0.0;
        for (double coefficient : GetDeterminantCoefficients(element))
        {
          sum += coefficient;
        }
        area += factor * factor * 0.5 *
          Cross(element.Points[1] - element.Points[0], element.Points[2] - element.Points[0]) *
          sum / 45.0;
      },
      60);
  }
  EXPECT_NEAR(area, expected, 1e-12 * expected);
}

/// Values and derivatives from both sides of each inner edge agree, vertices included.
void ExpectContinuouslyDifferentiable(const CubicMap& map, double tolerance)
{
  const PlanarPair& pair = map.GetPair();
  std::vector<std::uint8_t> exceptional(pair.Source.size(), 0);
  for (int point : map.GetStatistics().ExceptionalBoundaryPoints)
  {
    exceptional[static_cast<std::size_t>(point)] = 1;
  }
  for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int neighbor = pair.Neighbors[t][k];
      if (neighbor < t)
      {
        continue;
      }
      const int ends[2] = { pair.Triangles[t][NextCorner(k)],
        pair.Triangles[t][PreviousCorner(k)] };
      const Vector2 a = pair.Source[ends[0]];
      const Vector2 b = pair.Source[ends[1]];
      const double scale = std::max(Scale(pair, t), Scale(pair, neighbor));
      for (double s : { 0.0, 1e-6, 0.03, 0.2, 0.31, 0.5, 0.7, 0.88, 1.0 })
      {
        if ((s == 0.0 && exceptional[ends[0]]) || (s == 1.0 && exceptional[ends[1]]))
        {
          continue;
        }
        const Vector2 point = s == 1.0 ? b : a + s * (b - a);
        Vector2 image[2];
        Matrix2 derivative[2];
        map.MapPoint(t, point, image[0], derivative[0]);
        map.MapPoint(neighbor, point, image[1], derivative[1]);
        EXPECT_LT(Norm(image[0] - image[1]), 1e-14);
        EXPECT_LT(std::sqrt(SquaredNorm(derivative[0] - derivative[1])), tolerance * scale)
          << t << " " << k << " " << s;
      }
    }
  }
}

void ExpectRoundTrip(const CubicMap& map, int count, double deviation = 1e300)
{
  const PlanarPair& pair = map.GetPair();
  Sampler sampler(pair, 3);
  for (int n = 0; n < count; ++n)
  {
    const Sample sample = sampler();
    const Vector2 point = PointAt(pair, pair.Source, sample);
    Vector2 image;
    Matrix2 derivative;
    map.MapPoint(sample.Triangle, point, image, derivative);
    EXPECT_GT(derivative.Determinant(), 0.0);
    EXPECT_LE(Norm(image - PointAt(pair, pair.Target, sample)), deviation + 1e-14);
    int triangle = LocateImage(pair, image, sample.Triangle);
    Vector2 back;
    ASSERT_TRUE(map.FindPreimage(image, triangle, back));
    // Of the problem: both domains have a size of about 1.
    const double size = std::sqrt(SquaredNorm(derivative));
    const double condition = std::max(1.0, size) * size / derivative.Determinant();
    EXPECT_LE(Norm(back - point), 1e-13 * condition);
    Vector2 again;
    map.MapPoint(triangle, back, again, derivative);
    EXPECT_LE(Norm(again - image), 1e-13);
  }
}

CubicMapOptions Options(CubicBending bending)
{
  CubicMapOptions options;
  options.Bending = bending;
  return options;
}

double GetBending(const CubicMap& map)
{
  return map.GetStatistics().Bending.Energy;
}

/// A polygon with a vertex in its middle.
PlanarPair Wheel(const std::vector<Vector2>& source, const std::vector<Vector2>& target)
{
  PlanarPair pair;
  pair.Source = source;
  pair.Target = target;
  AddHub(pair, { 0.03, -0.02 }, { -0.05, 0.04 });
  return pair;
}

} // anonymous namespace

TEST(CubicMap, IsCertifiedAndC1)
{
  int seed = 0;
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    for (double strength : { 0.0, 0.5, 1.2, 2.0, 3.0 })
    {
      const CubicMap map(RandomPair(++seed, strength, 7), Options(bending));
      ExpectCertified(map);
      EXPECT_TRUE(map.GetStatistics().ExceptionalBoundaryPoints.empty());
      // Heights above the edges fall with the ratio of areas, and J turns within them.
      ExpectContinuouslyDifferentiable(map, strength < 1.5 ? 1e-10 : 1e-7);
      ExpectRoundTrip(map, 300);
    }
  }
}

TEST(CubicMap, CutsOnlySomeTriangles)
{
  // One vertex moves far, all others stay: slaves between cut and whole triangles.
  std::mt19937_64 random(5);
  PlanarPair pair = JitteredGrid(random, 10, 0.2);
  pair.Target = pair.Source;
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
  EXPECT_LT(GetBending(fine), GetBending(coarse));
  // Vertices stay on vertices.
  for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
  {
    Vector2 image;
    Matrix2 derivative;
    fine.MapPoint(t, pair.Source[pair.Triangles[t][1]], image, derivative);
    EXPECT_LT(Norm(image - pair.Target[pair.Triangles[t][1]]), 1e-15);
  }
}

TEST(CubicMap, AffinePairsAreReproduced)
{
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    for (bool identity : { true, false })
    {
      PlanarPair pair = RandomPair(31, 0.0, 6);
      const Matrix2 affine =
        identity ? Matrix2{ { 1.0, 0.0 }, { 0.0, 1.0 } } : Matrix2{ { 1.5, 0.25 }, { -0.75, 2.0 } };
      for (std::size_t i = 0; i < pair.Source.size(); ++i)
      {
        pair.Target[i] = affine * pair.Source[i];
      }
      const CubicMap map(pair, Options(bending));
      Sampler sampler(pair, 1);
      for (int n = 0; n < 1000; ++n)
      {
        const Sample sample = sampler();
        const Vector2 point = PointAt(pair, pair.Source, sample);
        Vector2 image;
        Matrix2 derivative;
        map.MapPoint(sample.Triangle, point, image, derivative);
        EXPECT_LT(Norm(image - affine * point), 4e-16 * (identity ? 1.0 : 4.0));
        EXPECT_LT(std::sqrt(SquaredNorm(derivative - affine)), 1e-11);
      }
    }
  }
}

TEST(CubicMap, KeepsItsDeviation)
{
  const PlanarPair pair = RandomPair(41, 1.0, 6);
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    for (double deviation : { 1e-2, 1e-4, 1e-6 })
    {
      CubicMapOptions options = Options(bending);
      options.MaximumDeviation = deviation;
      const CubicMap map(pair, options);
      ExpectCertified(map);
      ExpectRoundTrip(map, 300, deviation);
    }
  }
}

TEST(CubicMap, NeedlesAreCertified)
{
  std::mt19937_64 random(51);
  for (int n = 0; n < 200; ++n)
  {
    const CubicMap map(RandomNeedles(random, 3.0), Options(CubicBending::Local));
    const PlanarPair& pair = map.GetPair();
    EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, 0);
    const double size = std::max({ 1.0, Norm(pair.Target[2]), Norm(pair.Target[3]) });
    Sampler sampler(pair, 52);
    CubicTriangle prepared = map.Prepare();
    for (int k = 0; k < 40; ++k)
    {
      const Sample sample = sampler();
      const Vector2 image =
        map.MapPoint(sample.Triangle, PointAt(pair, pair.Source, sample), prepared);
      int triangle = LocateImage(pair, image, sample.Triangle);
      Vector2 back;
      ASSERT_TRUE(map.FindPreimage(image, triangle, back));
      EXPECT_LE(Norm(map.MapPoint(triangle, back, prepared) - image), 1e-13 * size) << n;
    }
  }
}

TEST(CubicMap, FarFromTheOrigin)
{
  PlanarPair pair = RandomPair(61, 1.0, 6);
  const PlanarPair near = pair;
  // Steps of 2^-28 there: the same differences.
  for (std::vector<Vector2>* points : { &pair.Source, &pair.Target })
  {
    for (Vector2& point : *points)
    {
      point = { std::round(point.x * 0x1p20) * 0x1p-20 + 0x1p24,
        std::round(point.y * 0x1p20) * 0x1p-20 + 0x1p24 };
    }
  }
  const CubicMap map(pair, Options(CubicBending::Local));
  EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, 0);
  EXPECT_TRUE(map.GetStatistics().ExceptionalInteriorPoints.empty());
}

TEST(CubicMap, BoundaryCornersAreDifferentiableWhereTheyCanBe)
{
  // A square with points on its sides, against itself with the points moved along the sides.
  const std::vector<Vector2> square{ { -1.0, -1.0 }, { 0.0, -1.0 }, { 1.0, -1.0 }, { 1.0, 0.0 },
    { 1.0, 1.0 }, { 0.0, 1.0 }, { -1.0, 1.0 }, { -1.0, 0.0 } };
  std::vector<Vector2> moved = square;
  moved[1].x = 0.5;
  moved[3].y = -0.4;
  moved[5].x = 0.3;
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    const CubicMap map(Wheel(square, moved), Options(bending));
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
        Vector2 image;
        Matrix2 derivative;
        map.MapPoint(i, here + s * (next - here), image, derivative);
        EXPECT_LT(std::abs(std::max(std::abs(image.x), std::abs(image.y)) - 1.0), 1e-14);
      }
    }
  }
}

TEST(CubicMap, BoundaryCornersStraightOnOneSideAreListed)
{
  const std::vector<Vector2> square{ { -1.0, -1.0 }, { 0.0, -1.0 }, { 1.0, -1.0 }, { 1.0, 1.0 },
    { -1.0, 1.0 } };
  std::vector<Vector2> bent = square;
  bent[1].y = -1.5;
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    const CubicMap map(Wheel(square, bent), Options(bending));
    ExpectCertified(map);
    EXPECT_EQ(map.GetStatistics().ExceptionalBoundaryPoints, std::vector<std::int32_t>{ 1 });
    // C1 all the way to it.
    ExpectContinuouslyDifferentiable(map, 1e-9);
    ExpectRoundTrip(map, 1000);
  }
}

TEST(CubicMap, StarsBeyondTheProgramHaveRings)
{
  int rings = 0;
  int exceptional = 0;
  std::mt19937_64 random(71);
  for (int n = 0; n < 60; ++n)
  {
    double range;
    const CubicMap map(RandomStar(random, 3 + n % 6, 0.5, range), Options(CubicBending::Local));
    EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, 0);
    const bool isExceptional = !map.GetStatistics().ExceptionalInteriorPoints.empty();
    exceptional += isExceptional ? 1 : 0;
    if (map.GetStatistics().Rings > 0 && !isExceptional)
    {
      ++rings;
      // Rings have small elements.
      ExpectContinuouslyDifferentiable(map, 1e-6);
      ExpectRoundTrip(map, 100);
    }
  }
  EXPECT_GT(rings, 0);
  EXPECT_LE(exceptional, 6);
}

TEST(CubicMap, DoesNotDependOnThreads)
{
  const PlanarPair pair = RandomPair(81, 1.0, 6);
  const ParallelFor pieces = [](std::int64_t count, const auto& body) {
    for (std::int64_t begin = count - 1; begin >= 0; --begin)
    {
      body(begin, begin + 1);
    }
  };
  const CubicMap first(pair, CubicMapOptions());
  const CubicMap second(pair, CubicMapOptions(), pieces);
  Sampler sampler(pair, 1);
  for (int n = 0; n < 500; ++n)
  {
    const Sample sample = sampler();
    const Vector2 point = PointAt(pair, pair.Source, sample);
    Vector2 image[2];
    Matrix2 derivative[2];
    first.MapPoint(sample.Triangle, point, image[0], derivative[0]);
    second.MapPoint(sample.Triangle, point, image[1], derivative[1]);
    EXPECT_EQ(image[0].x, image[1].x);
    EXPECT_EQ(image[0].y, image[1].y);
  }
}

TEST(CubicMap, BoundsOfSmoothPairsAreBelowAllCoefficients)
{
  for (double size : { 0.02, 0.1, 0.2 })
  {
    std::mt19937_64 random(31);
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
          for (double coefficient : GetDeterminantCoefficients(element))
          {
            least = std::min(least, coefficient);
          }
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
  std::mt19937_64 random(33);
  PlanarPair pair = JitteredGrid(random, 12, 0.2);
  for (Vector2& p : pair.Target)
  {
    p = p + 0.05 * std::sin(3.0 * p.x) * Vector2{ std::sin(4.0 * p.y), std::cos(2.0 * p.x) };
  }
  const CubicTemplate cubicTemplate(pair, {});
  const BendingSolution gradients = SolveForLeastBending(cubicTemplate, {}, {});
  // With a list of free points, none of which is, the general solver is taken.
  const BendingSolution elimination =
    SolveForLeastBending(cubicTemplate, {}, std::vector<std::uint8_t>(pair.Source.size(), 0));
  EXPECT_EQ(gradients.Statistics.Rounds, 1);
  EXPECT_EQ(elimination.Statistics.Rounds, 1);
  EXPECT_NEAR(gradients.Statistics.Energy, elimination.Statistics.Energy,
    1e-11 * elimination.Statistics.Energy);
  for (std::size_t n = 0; n < pair.Source.size(); ++n)
  {
    EXPECT_LT(
      std::sqrt(SquaredNorm(gradients.Points[n].Gradient - elimination.Points[n].Gradient)), 1e-10);
  }
}

TEST(CubicMap, PreparedTrianglesChangeNothing)
{
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    for (double strength : { 0.0, 1.2 })
    {
      const CubicMap map(RandomPair(7, strength, 6), Options(bending));
      const PlanarPair& pair = map.GetPair();
      CubicTriangle kept = map.Prepare();
      Sampler sampler(pair, 8);
      for (int n = 0; n < 2000; ++n)
      {
        const Sample sample = sampler();
        const Vector2 point = PointAt(pair, pair.Source, sample);
        CubicTriangle fresh = map.Prepare();
        const Vector2 image = map.MapPoint(sample.Triangle, point, kept);
        const Vector2 again = map.MapPoint(sample.Triangle, point, fresh);
        EXPECT_EQ(image.x, again.x);
        EXPECT_EQ(image.y, again.y);
      }
    }
  }
}

TEST(CubicMap, ClosedFormsAgreeWithTheElements)
{
  for (double strength : { 0.0, 1.2, 3.0 })
  {
    const PlanarPair pair = RandomPair(16, strength, 8);
    const CubicTemplate cubicTemplate(pair, {});
    CubicTriangle triangle(cubicTemplate, nullptr);
    Sampler sampler(pair, 17);
    for (int n = 0; n < 20000; ++n)
    {
      const Sample sample = sampler();
      const std::array<Vector2, 3> corners = pair.GetSourceCorners(sample.Triangle);
      const Vector2 point = sample.At[1] * corners[1] + sample.At[2] * corners[2];
      Vector2 image;
      Matrix2 derivative;
      cubicTemplate.Evaluate(sample.Triangle, point, image, derivative);
      triangle.Set(sample.Triangle);
      // In the plane's axes, as elements are evaluated here, very thin ones lose digits.
      EXPECT_LT(Norm(triangle.Map(point) - image), strength < 2.0 ? 1e-14 : 1e-12);
      Vector2 step;
      const Vector2 wanted = image + Vector2{ 1e-3, -2e-3 };
      const Vector2 residual = triangle.GetResidual(point, wanted, step);
      EXPECT_LT(Norm(derivative * step - residual),
        (strength < 2.0 ? 1e-9 : 1e-7) * std::sqrt(SquaredNorm(derivative)) * (1e-3 + Norm(step)));
    }
  }
}

TEST(CubicMap, BatchesGiveTheBitsOfSinglePoints)
{
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    for (int refinement = 0; refinement < (bending == CubicBending::Least ? 2 : 1); ++refinement)
    {
      for (double strength : { 0.0, 0.4, 1.2 })
      {
        CubicMapOptions options = Options(bending);
        options.FairnessRefinement = refinement;
        const CubicMap map(RandomPair(18, strength, 5), options);
        const PlanarPair& pair = map.GetPair();
        CubicTriangle prepared = map.Prepare();
        Sampler sampler(pair, 19);
        for (int round = 0; round < 10; ++round)
        {
          // Runs of one to twenty points in a triangle.
          CubicBatch points;
          points.Count = CubicBatch::Capacity - round;
          for (int i = 0; i < CubicBatch::Size; ++i)
          {
            Sample sample = sampler();
            const bool stays = i > 0 && i < points.Count && i % (7 * round + 1) % 20 != 0;
            sample.Triangle = stays ? points.Triangles[i - 1] : sample.Triangle;
            for (int k = 0; k < 3; ++k)
            {
              points.L[k][i] = sample.At[k];
            }
            if (i < points.Count)
            {
              const Vector2 point = PointAt(pair, pair.Source, sample);
              points.X[i] = point.x;
              points.Y[i] = point.y;
              points.Triangles[i] = sample.Triangle;
            }
          }
          for (bool inverse : { false, true })
          {
            CubicBatch batch = points;
            for (int i = 0; i < points.Count && inverse; ++i)
            {
              const Vector2 image = PointAt(pair, pair.Target,
                { points.Triangles[i], { points.L[0][i], points.L[1][i], points.L[2][i] } });
              batch.X[i] = image.x;
              batch.Y[i] = image.y;
            }
            const CubicBatch before = batch;
            inverse ? map.FindPreimages(batch, prepared) : map.MapPoints(batch, prepared);
            for (int i = 0; i < points.Count; ++i)
            {
              CubicBatch single;
              single.Count = 1;
              single.Triangles[0] = before.Triangles[i];
              for (int k = 0; k < 3; ++k)
              {
                std::fill_n(single.L[k], WidestVector, before.L[k][i]);
              }
              single.X[0] = before.X[i];
              single.Y[0] = before.Y[i];
              CubicTriangle fresh = map.Prepare();
              inverse ? map.FindPreimages(single, fresh) : map.MapPoints(single, fresh);
              EXPECT_EQ(batch.Triangles[i], single.Triangles[0]);
              EXPECT_EQ(batch.ImageX[i], single.ImageX[0]);
              EXPECT_EQ(batch.ImageY[i], single.ImageY[0]);
              const Vector2 there{ batch.ImageX[i], batch.ImageY[i] };
              const Vector2 point{ before.X[i], before.Y[i] };
              const Vector2 image = inverse ? map.MapPoint(batch.Triangles[i], there, fresh)
                                            : map.MapPoint(before.Triangles[i], point, fresh);
              EXPECT_LT(Norm(image - (inverse ? point : there)), 1e-13);
            }
          }
        }
      }
    }
  }
}

TEST(CubicMap, LengthsThatOverflowAreNotCertified)
{
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    for (double scale : { 1e160, 1e-170, 1e300 })
    {
      PlanarPair pair = RandomPair(22, 0.5, 3);
      for (std::vector<Vector2>* points : { &pair.Source, &pair.Target })
      {
        for (Vector2& point : *points)
        {
          point = scale * point;
        }
      }
      const CubicMap map(pair, Options(bending));
      EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, pair.GetNumberOfTriangles()) << scale;
    }
  }
}

TEST(CubicMap, PointsOutsideHaveNoPreimage)
{
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    for (double strength : { 0.0, 1.2 })
    {
      const CubicMap map(RandomPair(20, strength, 4), Options(bending));
      for (const Vector2& image :
        { Vector2{ -0.5, 0.3 }, Vector2{ 3.0, 7.0 }, Vector2{ 1.01, 0.5 } })
      {
        int triangle = 0;
        Vector2 point;
        EXPECT_FALSE(map.FindPreimage(image, triangle, point));
      }
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
  std::mt19937_64 random(14);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int turned = 0;
  for (int n = 0; n < 80; ++n)
  {
    PlanarPair pair;
    const Vector2 a{ 1.0 + uniform(random), 1.0 + uniform(random) };
    const Vector2 b{ 2.0 + uniform(random), 1.0 + uniform(random) };
    Vector2 c = a + uniform(random) * (b - a);
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

TEST(CubicMap, PreimagesAreExactWhereSecondDerivativesChangeSign)
{
  // Between inflections the first of Newton's steps may by chance come much closer than the next.
  // One component bends, so that this happens along whole lines.
  std::mt19937_64 random(7);
  PlanarPair pair = JitteredGrid(random, 3, 0.0);
  for (Vector2& p : pair.Target)
  {
    p.x += 0.13 * std::sin(6.283185307179586 * p.x);
  }
  const CubicMap map(pair, Options(CubicBending::Least));
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  CubicTriangle prepared = map.Prepare();
  double greatest = 0.0;
  for (int n = 0; n < 1000000; ++n)
  {
    const int start = n % pair.GetNumberOfTriangles();
    double v = uniform(random);
    double w = uniform(random);
    v = v + w > 1.0 ? 1.0 - v : v;
    w = v + w > 1.0 ? 1.0 - w : w;
    const Vector2 image = PointAt(pair, pair.Target, { start, { 1.0 - v - w, v, w } });
    int triangle = start;
    Vector2 point;
    ASSERT_TRUE(map.FindPreimage(image, triangle, point, prepared));
    greatest = std::max(greatest, Norm(map.MapPoint(triangle, point, prepared) - image));
  }
  EXPECT_LE(greatest, 4e-15);
}

TEST(CubicMap, PartsMayTouchInAPoint)
{
  // An hourglass whose halves share a point only.
  PlanarPair pair;
  pair.Source = { { 0.0, 0.0 }, { 1.0, 0.0 }, { 0.5, 1.0 }, { 0.0, 2.0 }, { 0.6, 2.1 },
    { 1.0, 2.0 } };
  pair.Target = { { 0.1, 0.0 }, { 1.0, 0.2 }, { 0.5, 1.0 }, { 0.0, 1.8 }, { 0.5, 2.0 },
    { 1.3, 2.2 } };
  pair.Triangles = { { 0, 1, 2 }, { 2, 5, 4 }, { 2, 4, 3 } };
  pair.FindNeighbors();
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    for (double deviation : { 1e300, 1e-3 })
    {
      CubicMapOptions options = Options(bending);
      options.MaximumDeviation = deviation;
      const CubicMap map(pair, options);
      EXPECT_EQ(map.GetStatistics().UncertifiedTriangles, 0);
      EXPECT_EQ(map.GetStatistics().ExceptionalBoundaryPoints, std::vector<int>{ 2 });
      ExpectRoundTrip(map, 600, deviation);
      for (int t = 0; t < 3; ++t)
      {
        Vector2 image;
        Matrix2 derivative;
        map.MapPoint(t, pair.Source[2], image, derivative);
        EXPECT_LT(Norm(image - pair.Target[2]), 1e-15);
      }
    }
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
