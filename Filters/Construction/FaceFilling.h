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
/// simple, as the boundary of a face is: corners may coincide and edges be run through twice.
using PolygonPair = std::array<std::vector<Vector2>, 2>;

/// Triangles as positions of corners; numbers from the number of corners on are added points.
using CornerTriangles = std::vector<std::array<int, 3>>;

/// Triangulates by diagonals alone, with the best worst quality that there is (dynamic programming:
/// Klincsek 1980; Aronov, Seidel, Souvaine 1993). False if no pair of triangulations has the same
/// diagonals. Takes m^3 steps at most. No diagonal's visibility has to be tested: triangles that
/// are counterclockwise in both domains cover the inside of the polygons exactly once.
bool FillByDiagonals(
  const PolygonPair& polygons, const QualityMeasure& quality, CornerTriangles& triangles);

/// The same with at most @a most added points, as few as this search finds: the polygons are
/// divided into triangles and into quadrangles and parts along the boundary that have a point in
/// the middle. The points are appended to @a added.
bool FillWithFewPoints(const PolygonPair& polygons, const QualityMeasure& quality, int most,
  std::array<std::vector<Vector2>, 2>& added, CornerTriangles& triangles);

/// A point of each domain from which the whole polygon is visible; false if there is none.
bool FindStarCenter(const PolygonPair& polygons, std::array<Vector2, 2>& center);

/// A point from which a whole polygon is visible and whose triangles have large angles at the
/// polygon's corners; false if there is none.
bool FindBestStarCenter(const std::vector<Vector2>& polygon, Vector2& center);

/// Triangulates by the overlay of triangulations of the two polygons: every crossing of their
/// diagonals becomes a point (Aronov, Seidel, Souvaine 1993). Flips first lower the number of
/// crossings as long as they can. Appends the points to @a added. False if doubles are too coarse
/// for a cell.
/// @param own the diagonals of each domain: a triangulation of its polygon
bool FillByOverlay(const PolygonPair& polygons, const std::array<CornerTriangles, 2>& own,
  const QualityMeasure& quality, std::array<std::vector<Vector2>, 2>& added,
  CornerTriangles& triangles);

/// The number of crossings of diagonals of two triangulations of a polygon.
int CountCrossings(const std::array<CornerTriangles, 2>& triangulations, int corners);

} // namespace homeomorphism

#endif
