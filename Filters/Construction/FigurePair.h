// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FigurePair.h
/// The input of an isomorphic triangulation, and the reasons for which it can be refused.

#ifndef homeomorphism_FigurePair_h
#define homeomorphism_FigurePair_h

#include "Kernel/Geometry.h"

#include <array>
#include <string>
#include <vector>

namespace homeomorphism
{

/// A figure drawn in two domains: corresponding points, and the lines between them. Domain 0 is the
/// source, domain 1 the target. The largest coordinates of each domain should be about 1.
struct FigurePair
{
  /// Corresponding points have the same number.
  std::array<std::vector<Vector2>, 2> Points;
  /// Closed polygons as point numbers, at least three each; the first one is not repeated. A point
  /// is inside the domain if an odd number of loops surround it: outlines, holes, islands in holes.
  std::vector<std::vector<int>> Loops;
  /// Open polygonal lines as point numbers: constraint segments between consecutive ones.
  std::vector<std::vector<int>> Lines;
};

/// The reason why a figure is refused, or why the construction had to stop.
struct FigureProblem
{
  enum class Kind
  {
    /// There are fewer than three points.
    Empty,
    /// The two figures do not have the same number of points.
    PointCountsDiffer,
    /// A loop or line refers to a point that does not exist, a loop has fewer than three points, or
    /// consecutive points are the same.
    BadCell,
    /// The cells of the two figures differ.
    CellsDiffer,
    /// A coordinate is NaN or infinite, or exceeds 1e150, which normalized coordinates never do.
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
    /// The segments at a point have different cyclic orders in the two domains.
    CyclicOrder,
    /// A closed curve of segments surrounds points in one domain only.
    OtherFace,
    /// A loop is inside another loop in one domain only.
    OutlineAgainstHole,
    /// A loop is mirrored between the domains and the first loop is not, or the reverse.
    LoopSense,
    /// A point lies outside the domain that is bounded by the loops or the frame.
    OutsideDomain,
    /// The convex hulls do not have the same points in the same order.
    HullsDiffer,
    /// A frame is not a convex polygon, or the frames have different numbers of corners.
    BadFrame,
    /// More points must be added than are allowed.
    PointLimit,
    /// A face is too narrow for double precision.
    Precision,
    /// The caller requested to stop.
    Aborted
  };

  /// The action that a user can take.
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
  /// Numbers of the points concerned, at most 10, ascending unless stated otherwise. For crossing
  /// segments, the two ends of one segment, then those of the other; for PointOnSegment, the point,
  /// then the ends of the segment.
  std::vector<int> Points;
  /// Number of the line that could not be drawn (in FigurePair::Lines), or -1.
  int Line = -1;
  /// Number of the loop concerned, or -1.
  int Loop = -1;
  /// The number of occurrences, if they were counted; for PointLimit, the number of points needed.
  int Count = 1;

  Remedy GetRemedy() const;
  /// The problem, its location, and the remedy. Points are identified by their names, if there are
  /// any, otherwise by their numbers.
  std::string Message(const std::vector<std::string>& names = {}) const;
};

using FigureProblems = std::vector<FigureProblem>;

/// A problem that concerns some points: all are counted, and the first 10 are listed.
FigureProblem MakeProblem(
  FigureProblem::Kind kind, int domain, std::vector<int> points, int line = -1, int loop = -1);

} // namespace homeomorphism

#endif
