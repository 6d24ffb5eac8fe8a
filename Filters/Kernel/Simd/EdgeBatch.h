// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file EdgeBatch.h
/// Batches of views from edges in the plane, and of strips.

#ifndef homeomorphism_EdgeBatch_h
#define homeomorphism_EdgeBatch_h

#include "Kernel/SmoothChart.h"

namespace homeomorphism
{

/// The number of edges in a batch. All its arrays fit into the first-level cache.
constexpr int EdgeBatchSize = 64;

/// One point per edge or triangle.
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

/// The members of EdgeView.
struct ViewBatch
{
  double Length[EdgeBatchSize];
  double Foot[EdgeBatchSize];
  double Height[EdgeBatchSize];
};

/// Computes ViewFromEdge of the first @a count edges; the same results, bit for bit.
void ViewFromEdges(const PointBatch& start, const PointBatch& end, const PointBatch& opposite,
  int count, ViewBatch& views);

/// Computes the strips of the first @a count edges in the triangles with the views @a own.
void MakeSmoothStrips(
  const ViewBatch& own, const ViewBatch& neighbor, int count, SmoothStrip* strips);

} // namespace homeomorphism

#endif
