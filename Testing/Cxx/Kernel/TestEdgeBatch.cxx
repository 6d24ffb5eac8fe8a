// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Batches of edge views equal single edge views to the same bits, for any number of edges and any
// size of triangles.

#include "Kernel/Simd/EdgeBatch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{

using namespace homeomorphism;

struct RandomEdges
{
  PointBatch Start;
  PointBatch End;
  PointBatch Opposite;

  explicit RandomEdges(std::mt19937_64& generator)
  {
    std::uniform_int_distribution<int> exponent(-1000, 0);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    for (int i = 0; i < EdgeBatchSize; ++i)
    {
      // Triangles far smaller than their distance from the origin, and products that underflow.
      const double size = std::ldexp(1.0, i % 3 == 0 ? exponent(generator) : 0);
      const double away = i % 5 == 0 ? coordinate(generator) : 0.0;
      for (PointBatch* points : { &this->Start, &this->End, &this->Opposite })
      {
        points->Set(
          i, { away + size * coordinate(generator), away + size * coordinate(generator) });
      }
    }
  }

  EdgeView View(int i) const
  {
    return ViewFromEdge({ this->Start.X[i], this->Start.Y[i] }, { this->End.X[i], this->End.Y[i] },
      { this->Opposite.X[i], this->Opposite.Y[i] });
  }
};

/// Equal, or both NaN, as for three coincident points.
void ExpectSame(double expected, double actual)
{
  if (!std::isnan(expected) || !std::isnan(actual))
  {
    ASSERT_EQ(expected, actual);
  }
}

TEST(EdgeBatchSize, BatchesEqualSingleEdges)
{
  std::mt19937_64 generator(11);
  for (int n = 0; n < 2000; ++n)
  {
    const RandomEdges edges(generator);
    const RandomEdges others(generator);
    const int count = 1 + n % EdgeBatchSize;
    ViewBatch views;
    ViewBatch neighbors;
    ViewFromEdges(edges.Start, edges.End, edges.Opposite, count, views);
    ViewFromEdges(others.Start, others.End, others.Opposite, count, neighbors);
    SmoothStrip strips[EdgeBatchSize];
    MakeSmoothStrips(views, neighbors, count, strips);
    for (int i = 0; i < count; ++i)
    {
      const EdgeView view = edges.View(i);
      ExpectSame(view.Length, views.Length[i]);
      ExpectSame(view.Foot, views.Foot[i]);
      ExpectSame(view.Height, views.Height[i]);
      const SmoothStrip strip(view, others.View(i));
      ExpectSame(strip.OffsetNext, strips[i].OffsetNext);
      ExpectSame(strip.OffsetPrevious, strips[i].OffsetPrevious);
      ExpectSame(strip.Kappa, strips[i].Kappa);
      ExpectSame(strip.Tau, strips[i].Tau);
    }
  }
}

} // namespace
