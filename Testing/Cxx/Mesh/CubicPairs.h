// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicPairs.h
/// Pairs of plane triangulations for the tests of the cubic map.

#ifndef CubicPairs_h
#define CubicPairs_h

#include "Mesh/PlanarPair.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace cubic_test
{

using homeomorphism::PlanarPair;
using homeomorphism::Vector2;

/// A jittered grid of @a cells^2 squares cut in two, each inner point moved by up to @a jitter
/// of a cell, in the unit square.
inline PlanarPair JitteredGrid(std::mt19937_64& random, int cells, double jitter)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  PlanarPair pair;
  for (int j = 0; j <= cells; ++j)
  {
    for (int i = 0; i <= cells; ++i)
    {
      const bool inner = i > 0 && j > 0 && i < cells && j < cells;
      const double x = i + (inner ? jitter * uniform(random) : 0.0);
      const double y = j + (inner ? jitter * uniform(random) : 0.0);
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
      if ((i + j) % 2 == 0)
      {
        pair.Triangles.push_back({ a, b, c });
        pair.Triangles.push_back({ a, c, d });
      }
      else
      {
        pair.Triangles.push_back({ a, b, d });
        pair.Triangles.push_back({ b, c, d });
      }
    }
  }
  pair.Target = pair.Source;
  pair.FindNeighbors();
  return pair;
}

/// Moves the target's inner points so that each is a convex combination of its neighbors, weights
/// exp(strength * normal): an embedding (Tutte, Floater), however uneven.
inline void EmbedByConvexCombinations(std::mt19937_64& random, PlanarPair& pair, double strength)
{
  std::normal_distribution<double> normal;
  const homeomorphism::PointFans fans(pair);
  struct Row
  {
    int Point;
    std::vector<int> Neighbors;
    std::vector<double> Weights;
  };
  std::vector<Row> rows;
  for (int p = 0; p < pair.GetNumberOfPoints(); ++p)
  {
    const homeomorphism::PointFan fan = fans.Get(pair, p);
    if (!fan.Closed)
    {
      continue;
    }
    Row row{ p, {}, {} };
    double sum = 0.0;
    for (int t : fan.Triangles)
    {
      row.Neighbors.push_back(pair.Triangles[t][homeomorphism::NextCorner(pair.GetCorner(t, p))]);
      row.Weights.push_back(std::exp(strength * normal(random)));
      sum += row.Weights.back();
    }
    for (double& weight : row.Weights)
    {
      weight /= sum;
    }
    rows.push_back(row);
  }
  double change = 1.0;
  for (int sweep = 0; sweep < 200000 && change > 1e-15; ++sweep)
  {
    change = 0.0;
    for (const Row& row : rows)
    {
      Vector2 mean;
      for (std::size_t i = 0; i < row.Neighbors.size(); ++i)
      {
        mean = mean + row.Weights[i] * pair.Target[row.Neighbors[i]];
      }
      const Vector2 move = mean - pair.Target[row.Point];
      change = std::max({ change, std::abs(move.x), std::abs(move.y) });
      pair.Target[row.Point] = mean;
    }
  }
}

/// A random pair of 2 cells^2 triangles.
inline PlanarPair RandomPair(int seed, double strength, int cells = 11)
{
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  PlanarPair pair = JitteredGrid(random, cells, 0.3);
  EmbedByConvexCombinations(random, pair, strength);
  return pair;
}

} // namespace cubic_test

#endif
