// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file GridFilling.h
/// Isomorphic triangulations of unrelated points in two quadrangles.

#ifndef homeomorphism_GridFilling_h
#define homeomorphism_GridFilling_h

#include "Kernel/Geometry.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// Triangulates two parallelograms with n points whose positions have little to do with each other.
/// A line runs through each point in both domains: in the first along one direction of the frame,
/// in the order of the points along the other; in the second these lines pass each other point on
/// the right side of it. With the lines that are straight in the second domain they make a grid of
/// (n + 2)^2 points whose cells are convex in both domains.
///
/// @a corners are the numbers of the corners, in cyclic order, and @a landmarks those of the
/// points. Appends the other points of the grid. False, and no triangles, if a point is too near an
/// edge or rounding does not allow it.
bool FillByGrid(std::array<int, 4> corners, const std::vector<int>& landmarks,
  std::array<std::vector<Vector2>, 2>& points, std::vector<std::array<int, 3>>& triangles);

} // namespace homeomorphism

#endif
