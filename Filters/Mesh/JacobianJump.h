// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file JacobianJump.h
/// Does a map's Jacobian jump across a line? Estimated from the map's values alone.

#ifndef homeomorphism_JacobianJump_h
#define homeomorphism_JacobianJump_h

#include "Embedding.h"

#include <array>
#include <functional>
#include <limits>

namespace homeomorphism
{

/// A map that can be evaluated: takes a point to its image, both in the input's coordinates, and
/// returns false where it has none. Must be safe to call from several threads.
using MapUnderTest = std::function<bool(const Vector3& point, Vector3& image)>;

/// A point of a line in the domain, and what is on the two sides of the line there.
struct LineCrossing
{
  Vector3 Point;
  /// Unit vector along the line.
  Vector3 Tangent;
  /// How far the map may be followed along the line, both ways.
  double TangentReach;
  /// Unit vectors away from the line into the two sides, in the planes that the sides lie in.
  std::array<Vector3, 2> Inward;
  /// How far the map may be followed that way.
  std::array<double, 2> Reach;
  /// For each side, three orthonormal vectors of the image's space in which derivatives are compared:
  /// along the image of the line, into the image of the side, and the normal. The first and the last
  /// axes of the sides agree with each other once the sides are unfolded.
  std::array<std::array<Vector3, 3>, 2> ImageAxes;
};

/// What is concluded.
enum class JumpVerdict
{
  Differentiable = 0,
  Kink = 1,
  Undecided = 2
};

/// The jump of the Jacobian, or of the second derivative, at a crossing. Lengths are relative to the
/// norm of the Jacobian (for second derivatives: times the norm of the Jacobian over the reach).
struct JacobianJump
{
  static constexpr double None = std::numeric_limits<double>::quiet_NaN();

  /// Norm of the difference of the derivatives on the two sides.
  double Jump = None;
  /// Bound on the error of Jump.
  double Error = None;
  /// Its part at a right angle to the line's image, and that along it.
  double Normal = None;
  double Tangential = None;
  /// Angle, in radians, between the images of the direction across the line on the two sides, and the
  /// ratio of the longer to the shorter, less 1.
  double Angle = None;
  double Stretch = None;
  /// The exponent with which the difference of the plain quotients on the two sides shrinks with the
  /// step: about 1 if the map is differentiable, 0 at a kink; NaN where the difference is all
  /// rounding.
  double Order = None;
  JumpVerdict Verdict = JumpVerdict::Undecided;
};

/// Estimates the jump of the derivative of order 1 or 2 across the line. Relative jumps up to
/// @a resolution count as none: the map is differentiable if the jump cannot be larger, given its error
/// bound, and has a kink if the jump is larger and stands out from its error bound.
JacobianJump EstimateJump(
  const MapUnderTest& map, const LineCrossing& crossing, int order, double resolution);

/// The same from known derivatives in the directions Inward, and along the line: no error, no order, no
/// verdict.
JacobianJump CompareDerivatives(const LineCrossing& crossing, const std::array<Vector3, 2>& inward,
  const Vector3& along);

} // namespace homeomorphism

#endif
