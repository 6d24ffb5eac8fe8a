// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file LinearAlgebra.h
/// Points, vectors and matrices of space for tests, apart from those of the library.

#ifndef fixtures_LinearAlgebra_h
#define fixtures_LinearAlgebra_h

#include <array>
#include <cmath>

namespace fixtures
{

using Point = std::array<double, 3>;
using Matrix = std::array<Point, 3>; // rows

inline Point operator+(const Point& a, const Point& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
}
inline Point operator-(const Point& a, const Point& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}
inline Point operator*(double factor, const Point& a)
{
  return { factor * a[0], factor * a[1], factor * a[2] };
}
inline double Dot(const Point& a, const Point& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point Cross(const Point& a, const Point& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}
inline double Norm(const Point& a)
{
  return std::hypot(a[0], a[1], a[2]);
}
inline Point Unit(const Point& a)
{
  return (1.0 / Norm(a)) * a;
}
inline double Distance(const Point& a, const Point& b)
{
  return Norm(a - b);
}
inline Point operator*(const Matrix& m, const Point& a)
{
  return { Dot(m[0], a), Dot(m[1], a), Dot(m[2], a) };
}
inline Matrix Transposed(const Matrix& m)
{
  return { { { m[0][0], m[1][0], m[2][0] }, { m[0][1], m[1][1], m[2][1] },
    { m[0][2], m[1][2], m[2][2] } } };
}
inline Matrix operator*(const Matrix& a, const Matrix& b)
{
  const Matrix columns = Transposed(b);
  return { { columns * a[0], columns * a[1], columns * a[2] } };
}
inline double Determinant(const Matrix& m)
{
  return Dot(m[0], Cross(m[1], m[2]));
}
/// By cofactors.
inline Matrix Inverted(const Matrix& m)
{
  const double factor = 1.0 / Determinant(m);
  return Transposed(
    { factor * Cross(m[1], m[2]), factor * Cross(m[2], m[0]), factor * Cross(m[0], m[1]) });
}
/// Frobenius norm.
inline double Norm(const Matrix& m)
{
  return std::hypot(Norm(m[0]), Norm(m[1]), Norm(m[2]));
}
inline double Distance(const Matrix& a, const Matrix& b)
{
  return std::hypot(Distance(a[0], b[0]), Distance(a[1], b[1]), Distance(a[2], b[2]));
}
/// Rotation by an angle about an axis (Rodrigues).
inline Matrix Rotation(const Point& axis, double angle)
{
  const Point n = Unit(axis);
  const auto turned = [&](const Point& e) {
    return std::cos(angle) * e + std::sin(angle) * Cross(n, e) +
      (1.0 - std::cos(angle)) * Dot(n, e) * n;
  };
  return Transposed({ { turned({ 1, 0, 0 }), turned({ 0, 1, 0 }), turned({ 0, 0, 1 }) } });
}

} // namespace fixtures

#endif
