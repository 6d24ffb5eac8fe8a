// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Vector3.h
/// Points and vectors of 3-space.

#ifndef homeomorphism_Vector3_h
#define homeomorphism_Vector3_h

#include "Kernel/Geometry.h"

#include <array>
#include <cmath>

namespace homeomorphism
{

/// A point or vector of 3-space.
using Vector3 = std::array<double, 3>;

inline Vector3 Difference(const Vector3& a, const Vector3& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

inline Vector3 Scaled(const Vector3& a, double factor)
{
  return { a[0] * factor, a[1] * factor, a[2] * factor };
}

inline double Length(const Vector3& a)
{
  // Some implementations of the three-argument function return 0 for (0, NaN, NaN).
  return std::hypot(std::hypot(a[0], a[1]), a[2]);
}

inline double Dot3(const Vector3& a, const Vector3& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// a + factor * b.
inline Vector3 Sum(const Vector3& a, double factor, const Vector3& b)
{
  return { a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2] };
}

inline Vector3 Unit(const Vector3& a)
{
  const double length = Length(a);
  return { a[0] / length, a[1] / length, a[2] / length };
}

/// The unit vector perpendicular to a line, given by a point and its unit tangent, towards the
/// point
/// @a beside.
inline Vector3 UnitAcross(const Vector3& onLine, const Vector3& tangent, const Vector3& beside)
{
  const Vector3 d = Unit(Difference(beside, onLine));
  return Unit(Sum(d, -Dot3(d, tangent), tangent));
}

/// The cross product. Each component is accurate, so that normals of needles are accurate, too.
inline Vector3 Cross3(const Vector3& a, const Vector3& b)
{
  return { DifferenceOfProducts(a[1], b[2], a[2], b[1]),
    DifferenceOfProducts(a[2], b[0], a[0], b[2]), DifferenceOfProducts(a[0], b[1], a[1], b[0]) };
}

} // namespace homeomorphism

#endif
