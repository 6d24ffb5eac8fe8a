// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ExactSign.h
/// Exact predicates: signs of polynomials in the coordinates, free of rounding errors.
///
/// A floating-point filter with an error bound decides nearly all cases. In the others, the
/// polynomial is evaluated exactly as an expansion of doubles (Shewchuk, "Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997). Differences are scaled
/// by powers of two, so products do not underflow even for tiny triangles. Coordinates must be
/// below 1e150, as normalized coordinates are.

#ifndef homeomorphism_ExactSign_h
#define homeomorphism_ExactSign_h

#include "Geometry.h"

#include <cmath>
#include <limits>

namespace homeomorphism
{

/// The sign of the area of a, b, c: 1 if counterclockwise, -1 if clockwise, 0 if
/// collinear.
int ExactOrientation(const Vector2& a, const Vector2& b, const Vector2& c);

/// ExactOrientation, preceded by a floating-point filter, which decides unless the points are
/// nearly collinear.
inline int Orientation(const Vector2& a, const Vector2& b, const Vector2& c)
{
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double magnitude = std::abs(left) + std::abs(right);
  // Shewchuk's relative error bound (3 + 16 u) u, where u is half an ulp of 1.
  constexpr double u = std::numeric_limits<double>::epsilon() / 2.0;
  const double bound = (3.0 + 16.0 * u) * u * magnitude;
  // Below this magnitude, products may be subnormal and the relative bound does not hold.
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

/// Whether the triangle a, b, c (@a dimension coordinates each, 2 or 3) is concordant: the foot of
/// the perpendicular from its centroid G lies strictly inside each edge AB, that is,
/// 0 < (G - A).(B - A) < |B - A|^2. Evaluated exactly as (B - A).((B - A) + (C - A)) > 0 for each
/// of the six ordered pairs of corners. Equivalent to a^2 < b^2 + 3 c^2 for the edge lengths in any
/// order.
bool IsConcordant(const double* a, const double* b, const double* c, int dimension);

} // namespace homeomorphism

#endif
