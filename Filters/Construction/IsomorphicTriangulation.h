// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file IsomorphicTriangulation.h
/// Isomorphic triangulations of two drawings of one figure.

#ifndef homeomorphism_IsomorphicTriangulation_h
#define homeomorphism_IsomorphicTriangulation_h

#include "FigureBoundary.h"
#include "PairQuality.h"

#include <array>
#include <functional>
#include <vector>

namespace homeomorphism
{

struct IsomorphicTriangulationOptions
{
  FigureDomain Domain = FigureDomain::Automatic;
  /// As in BoundaryOptions. An automatic frame half a spacing from the points has points on its
  /// edges, so that triangles between it and the points are not thin, unless the two domains'
  /// positions are unrelated. Frames farther away are tried where points have to be added.
  std::array<std::vector<Vector2>, 2> Frames;
  /// With Concordance and NonObtuse, no angle gets smaller than half the smallest angle, or half of
  /// 5 degrees if that is less, of the pair with the necessary points alone: such a pair is not
  /// taken. If its smallest angle is below 1 degree, half of the points are first used for
  /// MinimumAngle, and the smallest angle that they reach counts, up to 1 degree.
  PairQuality Quality = PairQuality::MinimumAngle;
  /// How many points may be added; -1: as many as necessary after several attempts, and up to 100
  /// for better triangles. Otherwise the first attempt that keeps to the limit is taken, unless
  /// there is a TargetQuality.
  int MaximumNumberOfAddedPoints = -1;
  /// Points are added until the smallest angle of both domains, in degrees, is this large, or for
  /// other qualities until QualityOf is. 0: only the points that are necessary.
  double TargetQuality = 0.0;
  /// Triangles larger than this share of their domain's area are divided. 0: none is.
  double MaximumTriangleSize = 0.0;
  /// Merge necessary points until few are left, and move them to where the triangles are best,
  /// which takes most of the time.
  bool OptimizeAddedPoints = true;
  /// Leave out lines' segments that do not agree with the rest of the figure instead of refusing.
  bool LeaveOutConflictingSegments = false;
  /// Called now and then with the progress from 0 to 1; false stops the work.
  std::function<bool(double)> Progress;
};

struct IsomorphicTriangulationResult
{
  std::array<std::vector<Vector2>, 2> Points;
  /// The figure's number of each point: i for the first points, -1 for those of a frame and added
  /// ones.
  std::vector<int> OriginalIds;
  /// Counterclockwise in the source; in the target clockwise if the figures are mirror images.
  std::vector<std::array<int, 3>> Triangles;
  /// The figure's edges, frames included: loops first, then segments.
  std::vector<std::array<int, 2>> LoopEdges;
  std::vector<std::array<int, 2>> Segments;
  /// Empty, or why there are no triangles.
  FigureProblems Problems;
  /// Segments that were left out, and why.
  FigureProblems LeftOut;
  bool Mirrored = false;
  /// Points added, those of a frame not counted.
  int NumberOfAddedPoints = 0;
  /// Corners of the frame that are no points of the figure, and points on an automatic frame's
  /// edges.
  int NumberOfFramePoints = 0;

  bool IsComplete() const { return this->Problems.empty(); }
};

IsomorphicTriangulationResult MakeIsomorphicTriangulation(
  const FigurePair& figure, const IsomorphicTriangulationOptions& options);

} // namespace homeomorphism

#endif
