// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file EdgeLanes.h
/// What edges of the plane see, for many at once.

#ifndef homeomorphism_EdgeLanes_h
#define homeomorphism_EdgeLanes_h

#include "SmoothChart.h"

namespace homeomorphism
{

/// How many at once: what all arrays take stays near the processor.
constexpr int EdgeLanes = 64;

/// A point of each edge or triangle.
struct LanesOfPoints
{
  double X[EdgeLanes];
  double Y[EdgeLanes];

  void Set(int i, const Vector2& point)
  {
    this->X[i] = point.x;
    this->Y[i] = point.y;
  }
};

/// EdgeView's numbers.
struct ViewLanes
{
  double Length[EdgeLanes];
  double Foot[EdgeLanes];
  double Height[EdgeLanes];
};

/// ViewFromEdge of the first @a count, to the same bits.
void ViewFromEdges(const LanesOfPoints& start, const LanesOfPoints& end,
  const LanesOfPoints& opposite, int count, ViewLanes& views);

/// The strips of the first @a count edges in the triangle that has the views @a own.
void MakeSmoothStrips(
  const ViewLanes& own, const ViewLanes& neighbor, int count, SmoothStrip* strips);

} // namespace homeomorphism

#endif
