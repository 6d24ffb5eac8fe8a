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
  Matrix t;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      t[i][j] = m[j][i];
    }
  }
  return t;
}
inline Matrix operator*(const Matrix& a, const Matrix& b)
{
  const Matrix columns = Transposed(b);
  Matrix product;
  for (int i = 0; i < 3; ++i)
  {
    product[i] = { Dot(a[i], columns[0]), Dot(a[i], columns[1]), Dot(a[i], columns[2]) };
  }
  return product;
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
  Matrix m;
  for (int column = 0; column < 3; ++column)
  {
    Point e{};
    e[column] = 1.0;
    const Point turned =
      std::cos(angle) * e + std::sin(angle) * Cross(n, e) + (1.0 - std::cos(angle)) * Dot(n, e) * n;
    for (int row = 0; row < 3; ++row)
    {
      m[row][column] = turned[row];
    }
  }
  return m;
}

} // namespace fixtures

#endif
