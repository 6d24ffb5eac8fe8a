// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FigureBoundary.h
/// The domain of a figure: its outline, a frame around it, or its convex hull.

#ifndef homeomorphism_FigureBoundary_h
#define homeomorphism_FigureBoundary_h

#include "FigurePair.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// What is triangulated.
enum class FigureDomain
{
  /// The inside of the loops if there are any, else a frame.
  Automatic,
  /// The inside of the loops.
  Outline,
  /// A frame around the points.
  Frame,
  /// The convex hulls, if they have the same points in the same order.
  ConvexHull
};

struct BoundaryOptions
{
  FigureDomain Domain = FigureDomain::Automatic;
  /// Corresponding corners of two convex polygons around the points; both empty: the source's
  /// bounds, enlarged, and their image by the affine map that fits best, enlarged further until all
  /// points are inside, or where that would have to be much larger the target's bounds.
  std::array<std::vector<Vector2>, 2> Frames;
  /// How far such a frame is from the points, in their spacings: the spacing of points is that of
  /// as many points spread evenly over their bounds.
  double FrameMargin = 0.5;
  /// Whether such a frame gets points on its edges, about two spacings apart.
  bool DividesFrame = true;
};

/// A figure with the boundary of its domain.
struct BoundedFigure
{
  /// The figure's points, then the frame's.
  std::array<std::vector<Vector2>, 2> Points;
  /// Loops that bound the domain, and those that are constraints only.
  std::vector<std::vector<int>> Loops;
  std::vector<std::vector<int>> ClosedLines;
  bool Mirrored = false;
  int NumberOfFramePoints = 0;
  bool HasAutomaticFrame = false;
  /// Whether the automatic frame has points on its edges.
  bool FrameIsDivided = false;
  /// Empty, or why the figure is refused.
  FigureProblems Problems;
};

BoundedFigure FindBoundary(const FigurePair& figure, const BoundaryOptions& options);

/// Whether @a p, on the line of @a a and @a b, lies strictly between them.
bool IsBetween(const Vector2& p, const Vector2& a, const Vector2& b);

/// Corners of two rectangles, given as the lower and the upper corner, so that corners of the same
/// number correspond under the affine map that fits the points best. The target's run the other way
/// round if that map is a reflection.
std::array<std::vector<Vector2>, 2> MatchRectangles(const FigurePair& figure,
  const std::array<Vector2, 2>& source, const std::array<Vector2, 2>& target);

} // namespace homeomorphism

#endif
