// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file EdgeBatch.h
/// What edges of the plane see, for many at once.

#ifndef homeomorphism_EdgeBatch_h
#define homeomorphism_EdgeBatch_h

#include "Kernel/SmoothChart.h"

namespace homeomorphism
{

/// How many at once: what all arrays take stays near the processor.
constexpr int EdgeBatchSize = 64;

/// A point of each edge or triangle.
struct PointBatch
{
  double X[EdgeBatchSize];
  double Y[EdgeBatchSize];

  void Set(int i, const Vector2& point)
  {
    this->X[i] = point.x;
    this->Y[i] = point.y;
  }
};

/// EdgeView's numbers.
struct ViewBatch
{
  double Length[EdgeBatchSize];
  double Foot[EdgeBatchSize];
  double Height[EdgeBatchSize];
};

/// ViewFromEdge of the first @a count, to the same bits.
void ViewFromEdges(const PointBatch& start, const PointBatch& end, const PointBatch& opposite,
  int count, ViewBatch& views);

/// The strips of the first @a count edges in the triangle that has the views @a own.
void MakeSmoothStrips(
  const ViewBatch& own, const ViewBatch& neighbor, int count, SmoothStrip* strips);

} // namespace homeomorphism

#endif
