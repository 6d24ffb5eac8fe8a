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

/// The domain that is triangulated.
enum class FigureDomain
{
  /// The interior of the loops if there are any, otherwise a frame.
  Automatic,
  /// The interior of the loops.
  Outline,
  /// A frame around the points.
  Frame,
  /// The convex hulls, which must have the same points in the same order.
  ConvexHull
};

struct BoundaryOptions
{
  FigureDomain Domain = FigureDomain::Automatic;
  /// Corresponding corners of two convex polygons around the points. If both are empty, frames are
  /// automatic: in the source, the enlarged bounds of the points; in the target, their image under
  /// the affine map that fits best, enlarged until all points are inside, or the bounds of the
  /// points if that image would have to be much larger.
  std::array<std::vector<Vector2>, 2> Frames;
  /// The distance of an automatic frame from the points, in spacings: the spacing is that of the
  /// same number of points distributed evenly over their bounds.
  double FrameMargin = 0.5;
  /// Whether an automatic frame has points on its edges, about two spacings apart.
  bool DividesFrame = true;
};

/// A figure with the boundary of its domain.
struct BoundedFigure
{
  /// The points of the figure, followed by those of the frame.
  std::array<std::vector<Vector2>, 2> Points;
  /// Loops that bound the domain, and loops that are only constraints.
  std::vector<std::vector<int>> Loops;
  std::vector<std::vector<int>> ClosedLines;
  bool Mirrored = false;
  int NumberOfFramePoints = 0;
  bool HasAutomaticFrame = false;
  /// Whether the automatic frame has points on its edges.
  bool FrameIsDivided = false;
  /// The reasons why the figure is refused; empty if it is accepted.
  FigureProblems Problems;
};

BoundedFigure FindBoundary(const FigurePair& figure, const BoundaryOptions& options);

/// Whether a point @a p on the line through @a a and @a b lies strictly between them.
bool IsBetween(const Vector2& p, const Vector2& a, const Vector2& b);

/// The corners of two rectangles, each given by its lower and upper corners, in an order such that
/// corners with the same number correspond under the affine map that fits the points best. If that
/// map is a reflection, the order in the target is clockwise.
std::array<std::vector<Vector2>, 2> MatchRectangles(const FigurePair& figure,
  const std::array<Vector2, 2>& source, const std::array<Vector2, 2>& target);

} // namespace homeomorphism

#endif
