// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FaceDissection.h
/// Common diagonals of two polygons that leave little for added points.

#ifndef homeomorphism_FaceDissection_h
#define homeomorphism_FaceDissection_h

#include "FaceFilling.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// Diagonals that do not cross and lie inside both polygons, chosen by dynamic programming so that
/// the faces they leave are triangles, the best ones there are, and few others with few corners: a
/// face of r corners costs (r - 3) / 2. Takes m^2 d steps and 4 m^2 bytes if each of the m corners
/// sees d others in both polygons. Pairs of positions of corners.
/// @param own a triangulation of each polygon by diagonals
std::vector<std::array<int, 2>> Dissect(const PolygonPair& polygons,
  const std::array<CornerTriangles, 2>& own, const QualityMeasure& quality);

} // namespace homeomorphism

#endif
