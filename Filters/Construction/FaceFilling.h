// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FaceFilling.h
/// Isomorphic triangulations of two simple polygons with the same corners.

#ifndef homeomorphism_FaceFilling_h
#define homeomorphism_FaceFilling_h

#include "PairQuality.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// Two simple polygons, counterclockwise, as positions of corresponding corners. They may be weakly
/// simple, as the boundary of a face is: corners may coincide, and edges may be traversed twice.
using PolygonPair = std::array<std::vector<Vector2>, 2>;

/// Triangles as positions of corners; numbers from the number of corners on are added points.
using CornerTriangles = std::vector<std::array<int, 3>>;

/// Triangulates by diagonals only, so that the quality of the worst triangle is optimal (dynamic
/// programming: Klincsek 1980; Aronov, Seidel, Souvaine 1993). Returns false if no triangulations
/// of the two polygons have the same diagonals. Takes O(m^3) steps. Diagonals are not tested for
/// visibility: triangles that are counterclockwise in both domains cover the interior of the
/// polygons exactly once.
bool FillByDiagonals(
  const PolygonPair& polygons, const QualityMeasure& quality, CornerTriangles& triangles);

/// Triangulates with at most @a most added points, as few as the search finds. The polygons are
/// divided into triangles, and into quadrilaterals and parts along the boundary that each get a
/// point in the middle. The points are appended to @a added.
bool FillWithFewPoints(const PolygonPair& polygons, const QualityMeasure& quality, int most,
  std::array<std::vector<Vector2>, 2>& added, CornerTriangles& triangles);

/// Finds a point in each domain from which the whole polygon is visible. Returns false if there is
/// none.
bool FindStarCenter(const PolygonPair& polygons, std::array<Vector2, 2>& center);

/// Finds a point from which a whole polygon is visible and whose triangles have large angles at the
/// corners of the polygon. Returns false if there is none.
bool FindBestStarCenter(const std::vector<Vector2>& polygon, Vector2& center);

/// Triangulates by the overlay of triangulations of the two polygons: every crossing of their
/// diagonals becomes a point (Aronov, Seidel, Souvaine 1993). Before that, edges are flipped as
/// long as this reduces the number of crossings. Appends the points to @a added. Returns false if
/// double precision does not suffice for a cell of the overlay.
/// @param own for each domain, a triangulation of its polygon by diagonals
bool FillByOverlay(const PolygonPair& polygons, const std::array<CornerTriangles, 2>& own,
  const QualityMeasure& quality, std::array<std::vector<Vector2>, 2>& added,
  CornerTriangles& triangles);

/// The number of crossings between the diagonals of two triangulations of a polygon.
int CountCrossings(const std::array<CornerTriangles, 2>& triangulations);

} // namespace homeomorphism

#endif
