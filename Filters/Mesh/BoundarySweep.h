// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file BoundarySweep.h
/// Decides from its boundary edges whether a triangulation of the plane overlaps itself.

#ifndef homeomorphism_BoundarySweep_h
#define homeomorphism_BoundarySweep_h

#include "Kernel/Geometry.h"

#include <vector>

namespace homeomorphism
{

/// A boundary edge. Start comes before End in the order of x, and of y if x is equal.
struct BoundarySegment
{
  Vector2 Start;
  Vector2 End;
  /// 1 if the edge's triangle is on its left, -1 if it is on its right.
  int Change;
};

/// Whether the triangles with this boundary cover no point of the plane more than once. They must
/// not have folds: the number of triangles that cover a point changes only across boundary edges.
///
/// A line sweeps over the plane (Shamos and Hoey, "Geometric Intersection Problems", 1976) and
/// counts triangles between the edges that it meets, by exact predicates. Edges may touch and lie
/// on each other. If two edges cross, the triangles at them overlap, and the sweep ends. Takes
/// O(n log n) time for n edges.
bool CoversAtMostOnce(std::vector<BoundarySegment> segments);

} // namespace homeomorphism

#endif
