// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "EdgeBatch.h"

namespace homeomorphism
{

HOMEOMORPHISM_WITH_FMA
void ViewFromEdges(const PointBatch& start, const PointBatch& end, const PointBatch& opposite,
  int count, ViewBatch& views)
{
  HOMEOMORPHISM_SIMD
  for (int i = 0; i < count; ++i)
  {
    const EdgeView view = ViewFromEdge(
      { start.X[i], start.Y[i] }, { end.X[i], end.Y[i] }, { opposite.X[i], opposite.Y[i] });
    views.Length[i] = view.Length;
    views.Foot[i] = view.Foot;
    views.Height[i] = view.Height;
  }
}

HOMEOMORPHISM_FOR_WIDE_VECTORS
void MakeSmoothStrips(
  const ViewBatch& own, const ViewBatch& neighbor, int count, SmoothStrip* strips)
{
  HOMEOMORPHISM_SIMD
  for (int i = 0; i < count; ++i)
  {
    strips[i] = SmoothStrip({ own.Length[i], own.Foot[i], own.Height[i] },
      { neighbor.Length[i], neighbor.Foot[i], neighbor.Height[i] });
  }
}

} // namespace homeomorphism
