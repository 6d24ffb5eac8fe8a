// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicPairs.h
/// Pairs of plane triangulations for the tests of the cubic map.

#ifndef CubicPairs_h
#define CubicPairs_h

#include "Fixtures/Random.h"

#include "Mesh/CubicMapOptions.h"
#include "Mesh/PlanarPair.h"

#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <vector>

namespace cubic_test
{

using fixtures::Random;
using homeomorphism::LargeVector;
using homeomorphism::PlanarPair;
using homeomorphism::Vector2;

inline homeomorphism::CubicMapOptions Options(homeomorphism::CubicBending bending)
{
  homeomorphism::CubicMapOptions options;
  options.Bending = bending;
  return options;
}

/// The pair with every point of both meshes moved by a function.
template <typename Move>
PlanarPair Moved(PlanarPair pair, Move&& move)
{
  for (LargeVector<Vector2>* points : { &pair.Source, &pair.Target })
  {
    std::transform(points->begin(), points->end(), points->begin(), move);
  }
  return pair;
}

/// A jittered grid of @a cells^2 squares cut in two, each inner point moved by up to @a jitter
/// of a cell, in the unit square.
inline PlanarPair JitteredGrid(Random& random, int cells, double jitter)
{
  PlanarPair pair;
  for (int j = 0; j <= cells; ++j)
  {
    for (int i = 0; i <= cells; ++i)
    {
      const bool inner = i > 0 && j > 0 && i < cells && j < cells;
      const double x = i + (inner ? random.Uniform(-jitter, jitter) : 0.0);
      const double y = j + (inner ? random.Uniform(-jitter, jitter) : 0.0);
      pair.Source.push_back({ x / cells, y / cells });
    }
  }
  for (int j = 0; j < cells; ++j)
  {
    for (int i = 0; i < cells; ++i)
    {
      const int a = j * (cells + 1) + i;
      const int b = a + 1;
      const int c = b + cells + 1;
      const int d = a + cells + 1;
      // The corners of the square must not have a triangle with two edges on the boundary.
      const bool isEven = (i + j) % 2 == 0;
      pair.Triangles.push_back({ a, b, isEven ? c : d });
      pair.Triangles.push_back({ isEven ? a : b, c, d });
    }
  }
  pair.Target = pair.Source;
  pair.FindNeighbors();
  return pair;
}

/// Moves the target's inner points so that each is a convex combination of its neighbors, weights
/// exp(strength * normal): an embedding (Tutte, Floater), however uneven.
inline void EmbedByConvexCombinations(Random& random, PlanarPair& pair, double strength)
{
  std::normal_distribution<double> normal;
  const homeomorphism::PointFans fans(pair);
  const int count = pair.GetNumberOfPoints();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, 2);
  std::vector<int> inner;
  for (int p = 0; p < count; ++p)
  {
    const homeomorphism::PointFan fan = fans.Get(pair, p);
    if (!fan.Closed)
    {
      entries.emplace_back(p, p, 1.0);
      right.row(p) << pair.Target[p].x, pair.Target[p].y;
      continue;
    }
    inner.push_back(p);
    for (int t : fan.Triangles)
    {
      const double weight = std::exp(strength * normal(random.Engine));
      const int neighbor = pair.Triangles[t][homeomorphism::NextCorner(pair.GetCorner(t, p))];
      entries.emplace_back(p, neighbor, -weight);
      entries.emplace_back(p, p, weight);
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::MatrixXd points = solver.solve(right);
  for (int p : inner)
  {
    pair.Target[p] = { points(p, 0), points(p, 1) };
  }
}

/// A random pair of 2 cells^2 triangles.
inline PlanarPair RandomPair(int seed, double strength, int cells = 11)
{
  Random random(static_cast<std::uint64_t>(seed));
  PlanarPair pair = JitteredGrid(random, cells, 0.3);
  EmbedByConvexCombinations(random, pair, strength);
  return pair;
}

inline double Norm(const Vector2& v)
{
  return std::hypot(v.x, v.y);
}

/// The triangle of a mesh that contains a point, walking from one of them; -1 outside.
inline int Locate(
  const PlanarPair& pair, const LargeVector<Vector2>& points, int t, const Vector2& point)
{
  for (int step = 0; step < 10000; ++step)
  {
    const std::array<Vector2, 3> corners = PlanarPair::GetCorners(points, pair.Triangles[t]);
    const homeomorphism::Barycentric l =
      ToBarycentric(corners, point - points[pair.Triangles[t][0]]);
    const int least = static_cast<int>(std::min_element(l.begin(), l.end()) - l.begin());
    if (l[least] >= -1e-12 || pair.Neighbors[t][least] < 0)
    {
      return l[least] >= -1e-9 ? t : -1;
    }
    t = pair.Neighbors[t][least];
  }
  return -1;
}

/// The triangle in which the piecewise linear map has an image, or else a hint.
inline int LocateImage(const PlanarPair& pair, const Vector2& image, int hint)
{
  const int found = Locate(pair, pair.Target, hint, image);
  return found < 0 ? hint : found;
}

/// A point of a triangle.
struct Sample
{
  int Triangle;
  homeomorphism::Barycentric Weights;

  Vector2 In(const PlanarPair& pair, const LargeVector<Vector2>& points) const
  {
    const auto& corners = pair.Triangles[this->Triangle];
    const std::array<Vector2, 3> c = PlanarPair::GetCorners(points, corners);
    return points[corners[0]] + (this->Weights[1] * c[1] + this->Weights[2] * c[2]);
  }
};

/// Points of triangles, a third of them close to a corner and a third close to an edge.
inline std::vector<Sample> RandomSamples(const PlanarPair& pair, std::uint64_t seed, int count)
{
  Random random(seed);
  std::vector<Sample> samples(static_cast<std::size_t>(count));
  for (int n = 0; n < count; ++n)
  {
    Sample& sample = samples[static_cast<std::size_t>(n)];
    sample.Triangle = random.Below(pair.GetNumberOfTriangles());
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const bool isSmall = n % 3 != 0 && (i == 0) == (n % 3 == 2);
      sample.Weights[i] = std::pow(random.Uniform(), isSmall ? 12.0 : 1.0) + 1e-30;
      sum += sample.Weights[i];
    }
    std::rotate(sample.Weights.begin(), sample.Weights.begin() + n / 3 % 3, sample.Weights.end());
    for (double& weight : sample.Weights)
    {
      weight /= sum;
    }
  }
  return samples;
}

/// Two triangles on either side of an edge, heights from 1e-3 to 1e3, apexes sheared.
inline PlanarPair RandomNeedles(Random& random, double shear)
{
  const auto apex = [&](double sign) {
    return Vector2{ random.Uniform(-shear, shear), sign * random.PowerOfTen(-3.0, 3.0) };
  };
  PlanarPair pair;
  pair.Source = { { 0.0, 0.0 }, { 1.0, 0.0 }, apex(1.0), apex(-1.0) };
  pair.Target = { { 0.0, 0.0 }, { 1.0, 0.0 }, apex(1.0), apex(-1.0) };
  pair.Triangles = { { 0, 1, 2 }, { 1, 0, 3 } };
  pair.FindNeighbors();
  return pair;
}

/// The polygons of a pair become wheels with a vertex at @a source and @a target.
inline void AddHub(PlanarPair& pair, const Vector2& source, const Vector2& target)
{
  const int n = pair.GetNumberOfPoints();
  pair.Source.push_back(source);
  pair.Target.push_back(target);
  for (int i = 0; i < n; ++i)
  {
    pair.Triangles.push_back({ n, i, (i + 1) % n });
  }
  pair.FindNeighbors();
}

/// Angles of the rays of a star, no sector wider than 172 degrees.
inline std::vector<double> RandomAngles(Random& random, int valence)
{
  constexpr double turn = 2.0 * 3.141592653589793;
  while (true)
  {
    std::vector<double> angles{ turn * random.Uniform() };
    std::vector<double> steps;
    std::generate_n(
      std::back_inserter(steps), valence, [&]() { return 0.02 + std::pow(random.Uniform(), 2.0); });
    const double sum = std::accumulate(steps.begin(), steps.end(), 0.0);
    for (int i = 1; i < valence; ++i)
    {
      angles.push_back(angles.back() + steps[static_cast<std::size_t>(i - 1)] * turn / sum);
    }
    if (*std::max_element(steps.begin(), steps.end()) * turn / sum < turn * 172.0 / 360.0)
    {
      return angles;
    }
  }
}

/// A star whose rays turn by different angles, the greatest minus the least being @a range. The
/// logarithms of the target's radii are up to @a spread.
inline PlanarPair RandomStar(Random& random, int valence, double spread, double* range = nullptr)
{
  constexpr double turn = 2.0 * 3.141592653589793;
  const std::vector<double> from = RandomAngles(random, valence);
  const std::vector<double> to = RandomAngles(random, valence);
  PlanarPair pair;
  std::vector<double> turns;
  for (std::size_t k = 0; k < from.size(); ++k)
  {
    const double radius = std::exp(random.Uniform(-1.0, 1.0));
    const double image = std::exp(random.Uniform(-spread, spread));
    pair.Source.push_back({ radius * std::cos(from[k]), radius * std::sin(from[k]) });
    pair.Target.push_back({ image * std::cos(to[k]), image * std::sin(to[k]) });
    const double angle = to[k] - from[k];
    const double before = turns.empty() ? angle : turns.back();
    turns.push_back(angle - turn * std::round((angle - before) / turn));
  }
  AddHub(pair, {}, {});
  if (range)
  {
    const auto [least, greatest] = std::minmax_element(turns.begin(), turns.end());
    *range = *greatest - *least;
  }
  return pair;
}

} // namespace cubic_test

#endif
