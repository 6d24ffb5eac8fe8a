// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file JacobianJump.h
/// Jumps of the Jacobian of a map across a line or at a point, estimated from values of the map.

#ifndef homeomorphism_JacobianJump_h
#define homeomorphism_JacobianJump_h

#include "Continuity/MapUnderTest.h"

#include <array>
#include <limits>
#include <vector>

namespace homeomorphism
{

/// A point of a line in the domain, and the two sides of the line there. Points are relative to the
/// local origin (see Vicinity).
struct LineCrossing
{
  Vicinity Near;
  Vector3 Point;
  /// Unit vector along the line.
  Vector3 Tangent;
  /// Length of the rays along the line, in both directions.
  double TangentLength;
  /// Unit vectors away from the line into the two sides, in the planes of the sides.
  std::array<Vector3, 2> Inward;
  /// Lengths of the rays into the two sides, on which the map is evaluated.
  std::array<double, 2> RayLengths;
  /// For each side, three orthonormal vectors in the space of the image, in which derivatives are
  /// compared: along the image of the line, into the image of the side, and the normal. After the
  /// sides have been unfolded, the first and the last axes of both sides agree.
  std::array<std::array<Vector3, 3>, 2> ImageAxes;
};

/// Computes the axes of the image from values of the map near the line, on both sides of it. They
/// are the same for both sides, as in a plane.
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

/// The jump of the Jacobian, or of the second derivative, at a crossing or in a ray fan. Values are
/// relative to the norm of the Jacobian (for second derivatives, divided by the length of the
/// rays).
struct JacobianJump
{
  static constexpr double None = std::numeric_limits<double>::quiet_NaN();

  /// Norm of the difference of the derivatives on the two sides; in a ray fan, the largest
  /// deviation of the derivatives along its rays from those of the linear map that fits them best.
  double Jump = None;
  /// Bound on the error of Jump.
  double Error = None;
  /// The components of the jump perpendicular to and along the image of the line. NaN in a ray fan,
  /// as are the angle and the stretch.
  double Normal = None;
  double Tangential = None;
  /// The angle, in radians, between the images, on the two sides, of the direction across the line,
  /// and the ratio of their lengths, the longer to the shorter, minus 1.
  double Angle = None;
  double Stretch = None;
  /// The power of the step with which the difference of the quotients on the two sides decreases:
  /// about 1 if the map is differentiable, 0 at a crease, NaN if the difference is only rounding.
  double Order = None;
  JumpVerdict Verdict = JumpVerdict::Undecided;
};

/// Estimates the jump of the derivative of order 1 or 2 across the line. Relative jumps up to
/// @a resolution are ignored: the verdict is Differentiable if the jump plus its error bound is at
/// most @a resolution, and Crease if the jump exceeds both @a resolution and its error bound.
JacobianJump EstimateJump(
  const LocalMap& map, const LineCrossing& crossing, int order, double resolution);

/// The jump from known derivatives in the directions Inward and along the line. Error, order and
/// verdict are not set.
JacobianJump CompareDerivatives(
  const LineCrossing& crossing, const std::array<Vector3, 2>& inward, const Vector3& along);

/// Estimates whether the map has a derivative at the fan's point, that is, whether the one-sided
/// derivatives along its rays are those of a linear map. Verdicts as above.
JacobianJump EstimateJump(const LocalMap& map, const RayFan& fan, double resolution);

/// The jump from known derivatives along the rays. Error, order and verdict are not set.
JacobianJump CompareDerivatives(const RayFan& fan, const std::vector<Vector3>& derivatives);

} // namespace homeomorphism

#endif
