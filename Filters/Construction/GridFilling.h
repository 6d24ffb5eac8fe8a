// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file GridFilling.h
/// Isomorphic triangulations of points at unrelated positions in two parallelograms.

#ifndef homeomorphism_GridFilling_h
#define homeomorphism_GridFilling_h

#include "Kernel/Geometry.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// Triangulates two parallelograms with n points whose positions in the two domains are unrelated.
/// A line passes through each point in both domains. In the first domain, it is straight and
/// parallel to one direction of the frame; the lines are in the order of the points along the other
/// direction. In the second domain, each line passes every other point on the same side as in the
/// first one. Together with lines that are straight in the second domain, these lines form a grid
/// of (n + 2)^2 points whose cells are convex in both domains.
///
/// @a corners are the numbers of the corners, in cyclic order, and @a landmarks those of the
/// points. Appends the other points of the grid. Returns false, without triangles, if a point is
/// too close to an edge or if double precision does not suffice.
bool FillByGrid(std::array<int, 4> corners, const std::vector<int>& landmarks,
  std::array<std::vector<Vector2>, 2>& points, std::vector<std::array<int, 3>>& triangles);

} // namespace homeomorphism

#endif
