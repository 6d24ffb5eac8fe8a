// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ExactSign.h
/// Predicates whose answer is the sign of a polynomial in the coordinates, without rounding.
///
/// A floating-point evaluation with an error bound decides nearly always; where it cannot, the
/// polynomial is evaluated exactly as a sum of doubles (Dekker's and Shewchuk's expansions:
/// "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997).
/// Differences are scaled by powers of two, so that products do not underflow however small the
/// triangle. Coordinates must be below 1e150, which those of the mesh floor are.

#ifndef homeomorphism_ExactSign_h
#define homeomorphism_ExactSign_h

#include "Geometry.h"

#include <cmath>
#include <limits>

namespace homeomorphism
{

/// Sign of the area of a, b, c: 1 if counterclockwise, -1 if clockwise, 0 if the points are on a
/// line.
int ExactOrientation(const Vector2& a, const Vector2& b, const Vector2& c);

/// The same, decided in a few operations unless the points are almost on a line.
inline int Orientation(const Vector2& a, const Vector2& b, const Vector2& c)
{
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double magnitude = std::abs(left) + std::abs(right);
  // Shewchuk's bound (3 + 16 u) u on the relative error, with u half an ulp of 1.
  constexpr double u = std::numeric_limits<double>::epsilon() / 2.0;
  const double bound = (3.0 + 16.0 * u) * u * magnitude;
  // Products near the least normal number are not rounded relatively.
  if (magnitude > 1e-280)
  {
    if (determinant > bound)
    {
      return 1;
    }
    if (determinant < -bound)
    {
      return -1;
    }
  }
  return ExactOrientation(a, b, c);
}

/// Whether the triangle a, b, c (each of @a dimension coordinates, 2 or 3) is concordant: whether
/// the foot of the perpendicular from its centroid G lies strictly inside each edge, 0 < (G - A).(B
/// - A) < |B - A|^2 for all three edges AB. Multiplied by 3 this is (B - A).((B - A) + (C - A)) > 0
/// for each of the six ordered pairs of corners, which is what is evaluated, exactly. Equivalently,
/// a^2 < b^2 + 3 c^2 for the edge lengths in any order.
bool IsConcordant(const double* a, const double* b, const double* c, int dimension);

} // namespace homeomorphism

#endif
