// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FigurePair.h
/// What an isomorphic triangulation is made from, and for what it can be refused.

#ifndef homeomorphism_FigurePair_h
#define homeomorphism_FigurePair_h

#include "Kernel/Geometry.h"

#include <array>
#include <string>
#include <vector>

namespace homeomorphism
{

/// The same figure drawn twice: corresponding points, and what joins them. Domain 0 is the source,
/// domain 1 the target. The largest coordinates of each domain should be about 1.
struct FigurePair
{
  /// Corresponding points have the same number.
  std::array<std::vector<Vector2>, 2> Points;
  /// Closed polygons as point numbers, each at least three, the first not repeated. A point is
  /// inside the domain if an odd number of loops surround it: outlines, holes, islands in holes.
  std::vector<std::vector<int>> Loops;
  /// Open polygonal lines as point numbers: constraint segments between consecutive ones.
  std::vector<std::vector<int>> Lines;
};

/// Why a figure is refused, or where the construction had to stop.
struct FigureProblem
{
  enum class Kind
  {
    /// There are no points, or fewer than three.
    Empty,
    /// The two figures do not have the same number of points.
    PointCountsDiffer,
    /// A loop or line names a point that does not exist, a loop has fewer than three points, or
    /// consecutive points are the same.
    BadCell,
    /// The cells of the two figures differ.
    CellsDiffer,
    /// A coordinate is NaN or infinite, or beyond 1e150, which normalized coordinates are not.
    NotFinite,
    /// A figure in space does not lie in a plane.
    NotPlanar,
    /// All points lie on one line, and neither loops nor frames were given.
    Collinear,
    /// Points have the same position.
    Coincident,
    /// Segments cross.
    Crossing,
    /// A point lies on a segment in one domain and not in the other.
    PointOnSegment,
    /// The segments at a point follow each other differently.
    CyclicOrder,
    /// Points that a closed curve of segments surrounds in one domain only.
    OtherFace,
    /// Points of a loop that is inside another loop in one domain only.
    OutlineAgainstHole,
    /// A loop runs counterclockwise in one domain and clockwise in the other, unlike the first one.
    LoopSense,
    /// A point lies outside the domain that the loops or the frame bound.
    OutsideDomain,
    /// The convex hulls do not have the same points in the same order.
    HullsDiffer,
    /// A frame is not a convex polygon, or the frames have different numbers of corners.
    BadFrame,
    /// More points would have to be added than are allowed.
    PointLimit,
    /// A face is too narrow for double precision.
    Precision,
    /// The caller wished to stop.
    Aborted
  };

  /// What can be done about it.
  enum class Remedy
  {
    None,
    MovePoints,
    RemovePoints,
    RemoveSegments,
    CorrectCells,
    GiveFrames,
    EnlargeFrames,
    UseFrames,
    AllowMorePoints
  };

  Kind What = Kind::Empty;
  /// 0 source, 1 target, -1 if the two disagree.
  int Domain = -1;
  /// Numbers of the points concerned, ascending if no other order is natural; at most 10. For
  /// crossing segments the two ends of the one, then of the other; for PointOnSegment the point,
  /// then the segment's ends.
  std::vector<int> Points;
  /// Number of the line that was to be drawn (in FigurePair::Lines), or -1.
  int Line = -1;
  /// Number of the loop concerned, or -1.
  int Loop = -1;
  /// How often this occurs, where that was counted: points added for PointLimit.
  int Count = 1;

  Remedy GetRemedy() const;
  /// One sentence: what is wrong, where, and what to do. Points have their names, if there are any,
  /// or else their numbers.
  std::string Message(const std::vector<std::string>& names = {}) const;
};

using FigureProblems = std::vector<FigureProblem>;

/// A problem that concerns some points: all are counted, and the first 10 are listed.
FigureProblem MakeProblem(
  FigureProblem::Kind kind, int domain, std::vector<int> points, int line = -1, int loop = -1);

} // namespace homeomorphism

#endif
