// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Batches of edge views equal single edge views, bit for bit, for any number of edges and any size
// of triangles.

#include "Fixtures/Random.h"

#include "Kernel/Simd/EdgeBatch.h"

#include <gtest/gtest.h>

namespace
{

using namespace homeomorphism;
using fixtures::Random;

struct RandomEdges
{
  PointBatch Start;
  PointBatch End;
  PointBatch Opposite;

  explicit RandomEdges(Random& random)
  {
    for (int i = 0; i < EdgeBatchSize; ++i)
    {
      // Triangles far smaller than their distance from the origin, and products that underflow.
      const double size = i % 3 == 0 ? std::ldexp(1.0, random.Integer(-1000, 0)) : 1.0;
      const double away = i % 5 == 0 ? random.Uniform(-1.0, 1.0) : 0.0;
      for (PointBatch* points : { &this->Start, &this->End, &this->Opposite })
      {
        const auto [x, y, z] = random.Vector();
        points->Set(i, { away + size * x, away + size * y });
      }
    }
  }

  EdgeView View(int i) const
  {
    return ViewFromEdge({ this->Start.X[i], this->Start.Y[i] }, { this->End.X[i], this->End.Y[i] },
      { this->Opposite.X[i], this->Opposite.Y[i] });
  }
};

TEST(EdgeBatch, BatchesEqualSingleEdges)
{
  Random random(11);
  for (int n = 0; n < 2000; ++n)
  {
    const RandomEdges edges(random);
    const RandomEdges others(random);
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
      const SmoothStrip strip(view, others.View(i));
      for (const auto& [expected, actual] :
        { std::pair{ view.Length, views.Length[i] }, { view.Foot, views.Foot[i] },
          { view.Height, views.Height[i] }, { strip.OffsetNext, strips[i].OffsetNext },
          { strip.OffsetPrevious, strips[i].OffsetPrevious }, { strip.Kappa, strips[i].Kappa },
          { strip.Tau, strips[i].Tau } })
      {
        // Three coincident points have NaN.
        ASSERT_TRUE(expected == actual || (std::isnan(expected) && std::isnan(actual)));
      }
    }
  }
}

} // namespace
