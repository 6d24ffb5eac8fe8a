// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FaceDissection.h
/// Common diagonals of two polygons after which few added points are needed.

#ifndef homeomorphism_FaceDissection_h
#define homeomorphism_FaceDissection_h

#include "FaceFilling.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// Finds diagonals that do not cross and lie inside both polygons, by dynamic programming. Their
/// faces are triangles, as good as possible, and few other faces with few corners: the cost of a
/// face of r corners is (r - 3) / 2. Takes O(m^2 d) steps and 4 m^2 bytes if each of the m corners
/// sees d others in both polygons.
/// @param own a triangulation of each polygon by diagonals
/// @return pairs of positions of corners
std::vector<std::array<int, 2>> Dissect(const PolygonPair& polygons,
  const std::array<CornerTriangles, 2>& own, const QualityMeasure& quality);

} // namespace homeomorphism

#endif
