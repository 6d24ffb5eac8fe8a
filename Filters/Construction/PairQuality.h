// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PairQuality.h
/// Quality measures of triangles of a pair of triangulations.

#ifndef homeomorphism_PairQuality_h
#define homeomorphism_PairQuality_h

#include "Kernel/Geometry.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// The quality measure for which an isomorphic triangulation is optimized. The quality of a
/// triangulation is that of its worst triangle.
enum class PairQuality
{
  /// The smallest angle of both domains.
  MinimumAngle,
  /// The margin by which triangles are concordant, as the Contour system requires.
  Concordance,
  /// The ratio of the singular values of the affine map between the two triangles.
  Distortion,
  /// The largest angle of both domains.
  NonObtuse
};

/// A quality measure, and the angle, in degrees, below which triangles are too thin for it.
///
/// For Concordance and NonObtuse, the quality of a triangle with an angle of Thin degrees is at
/// most 90, the limit between concordant and discordant or between acute and obtuse triangles; with
/// a smaller angle a, it is at most 90 (a / Thin)^4. So triangles do not become much thinner than
/// that in order to become concordant or acute. The other two measures do not use Thin.
struct QualityMeasure
{
  // Implicit conversion is intended. NOLINTNEXTLINE(google-explicit-constructor)
  QualityMeasure(PairQuality kind, double thin = 2.5)
    : Kind(kind)
    , Thin(thin)
  {
  }

  PairQuality Kind;
  double Thin;
};

using TrianglePoints = std::array<Vector2, 3>;

/// The angles of a triangle in degrees; negative if it is clockwise.
std::array<double, 3> Angles(const TrianglePoints& p);

/// The larger of the two singular values of the affine map from @a source to @a target divided by
/// the smaller one: 1 for a similarity. Infinite for degenerate triangles.
double Distortion(const TrianglePoints& source, const TrianglePoints& target);

/// The quality of a pair of triangles; a higher value is better. MinimumAngle: the smallest angle
/// in degrees. Concordance: 180 minus the largest angle between an edge and the median at its end;
/// more than 90 if both triangles are concordant. Distortion: 60 for similar triangles, otherwise
/// less. NonObtuse: 180 minus the largest angle; at least 90 if no angle is obtuse. Concordance and
/// NonObtuse are lower for thin triangles, see QualityMeasure. -1 unless both triangles are
/// counterclockwise, which is decided exactly.
double QualityOf(
  const QualityMeasure& quality, const TrianglePoints& source, const TrianglePoints& target);

/// One term of a smooth lower bound of the quality.
struct QualityTerm
{
  double Value = 0.0;
  /// Derivatives by the three corners.
  TrianglePoints Gradient;
};

/// The terms whose smallest is the quality of the triangle @a p in one domain, with their
/// derivatives by its corners. @a other is the triangle in the other domain (for Distortion).
/// Returns the number of terms, 0 if the triangle is not counterclockwise.
int QualityTerms(const QualityMeasure& quality, const TrianglePoints& p,
  const TrianglePoints& other, std::array<QualityTerm, 9>& terms);

/// The shapes of the triangles of a pair of triangulations.
struct PairQualities
{
  std::array<double, 2> MinimumAngle{ { 0.0, 0.0 } };
  /// The triangle where it is.
  std::array<int, 2> MinimumAngleTriangle{ { -1, -1 } };
  /// Shares of the angles of each domain below 10, 15 and 20 degrees.
  std::array<std::array<double, 3>, 2> SharesBelow{};
  /// Shares of the triangles that are obtuse, or discordant, in at least one domain.
  double ObtuseShare = 0.0;
  double DiscordantShare = 0.0;
  /// The largest ratio of singular values, and its triangle.
  double LargestDistortion = 1.0;
  int LargestDistortionTriangle = -1;
  /// For each triangle.
  std::vector<double> MinimumAngles;
  std::vector<double> Distortions;
};

PairQualities MeasureQualities(const std::array<std::vector<Vector2>, 2>& points,
  const std::vector<std::array<int, 3>>& triangles);

} // namespace homeomorphism

#endif
