// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file JacobianJump.h
/// Jumps of a map's Jacobian across a line or at a point, estimated from the map's values alone.

#ifndef homeomorphism_JacobianJump_h
#define homeomorphism_JacobianJump_h

#include "Continuity/MapUnderTest.h"

#include <array>
#include <limits>
#include <vector>

namespace homeomorphism
{

/// A point of a line in the domain, and the two sides of the line there. Points are relative to the
/// local origin of the vicinity.
struct LineCrossing
{
  Vicinity Near;
  Vector3 Point;
  /// Unit vector along the line.
  Vector3 Tangent;
  /// Length of the rays along the line, both ways.
  double TangentLength;
  /// Unit vectors away from the line into the two sides, in the planes of the sides.
  std::array<Vector3, 2> Inward;
  /// Lengths of the rays into the two sides, on which the map is evaluated.
  std::array<double, 2> RayLengths;
  /// For each side, three orthonormal vectors of the space of the image in which derivatives are
  /// compared: along the image of the line, into the image of the side, and the normal. The first
  /// and last axes of both sides agree once the sides are unfolded.
  std::array<std::array<Vector3, 3>, 2> ImageAxes;
};

/// Computes the axes of the image from values of the map near the line and across it. They are the
/// same on both sides, as within a plane.
void FindImageAxes(const LocalMap& map, LineCrossing& crossing);

/// A point of the domain, relative to the local origin, and rays on which the map is evaluated.
struct RayFan
{
  struct Ray
  {
    /// Unit vector.
    Vector3 Direction;
    /// Its components along orthonormal axes of the plane of all rays.
    Vector2 InPlane;
    double Length;
  };
  Vicinity Near;
  Vector3 Point;
  std::vector<Ray> Rays;
};

/// The conclusion from a jump and the bound on its error.
enum class JumpVerdict
{
  Differentiable = 0,
  Crease = 1,
  Undecided = 2
};

/// The jump of the Jacobian, or of the second derivative, at a crossing or in a ray fan. Lengths
/// are relative to the norm of the Jacobian (for second derivatives: to that norm over the length
/// of the rays).
struct JacobianJump
{
  static constexpr double None = std::numeric_limits<double>::quiet_NaN();

  /// Norm of the difference of the derivatives on the two sides; in a ray fan, the largest
  /// deviation of the derivatives along its rays from those of the linear map that fits them best.
  double Jump = None;
  /// Bound on the error of Jump.
  double Error = None;
  /// Its part at a right angle to the line's image, and that along it. NaN in a ray fan, as are the
  /// angle and the stretch.
  double Normal = None;
  double Tangential = None;
  /// Angle, in radians, between the images of the direction across the line on the two sides, and
  /// the ratio of the longer to the shorter, minus 1.
  double Angle = None;
  double Stretch = None;
  /// The exponent with which the difference of the quotients on the two sides decreases with the
  /// step: about 1 if the map is differentiable, 0 at a crease, NaN where the difference is
  /// rounding only.
  double Order = None;
  JumpVerdict Verdict = JumpVerdict::Undecided;
};

/// Estimates the jump of the derivative of order 1 or 2 across the line. Relative jumps up to @a
/// resolution are ignored: the map is differentiable if the jump cannot be larger, given its error
/// bound, and has a crease if the jump is larger and exceeds its error bound.
JacobianJump EstimateJump(
  const LocalMap& map, const LineCrossing& crossing, int order, double resolution);

/// The jump from known derivatives in the directions Inward and along the line. There is no error,
/// order or verdict.
JacobianJump CompareDerivatives(
  const LineCrossing& crossing, const std::array<Vector3, 2>& inward, const Vector3& along);

/// Estimates how far the map is from having a derivative at the fan's point: whether the one-sided
/// derivatives along its rays are those of one linear map. Verdicts as above.
JacobianJump EstimateJump(const LocalMap& map, const RayFan& fan, double resolution);

/// The deviation from known derivatives along the rays. There is no error, order or verdict.
JacobianJump CompareDerivatives(const RayFan& fan, const std::vector<Vector3>& derivatives);

} // namespace homeomorphism

#endif
