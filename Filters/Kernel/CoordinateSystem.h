// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CoordinateSystem.h
/// The interface of a coordinate system, and the homeomorphism defined by two of its charts.
/// A coordinate system assigns a *chart* to every triangle: a bijection between the points of the
/// triangle and a reference set that is the same for all triangles. A chart is constructed from the
/// shape of the triangle and provides
///
///     using Reference = ...; // a point of the reference
///     using Direction = ...; // a tangent vector of the reference
///     class Differential; // Pullback(vector) and Pushforward(direction) at one reference
///     Reference ToReference(const Vector2& point) const;
///     Vector2 ToPoint(const Reference& reference) const;
///     // The derivatives of ToReference and ToPoint at a reference.
///     Differential DifferentialAt(const Reference& reference) const;
///     Direction Pullback(const Reference& reference, const Vector2& vector) const;
///     Vector2 Pushforward(const Reference& reference, const Direction& direction) const;
///     TriangularCoordinates ToCoordinates(const Reference& reference) const;
///     Reference FromCoordinates(const TriangularCoordinates& coordinates) const;
///
/// Points and vectors are given in the frame of the triangle (TriangleShape). A point outside the
/// closed triangle is replaced by the nearest point of the triangle. Derivatives are in closed
/// form; on an edge they are the limits from inside the triangle. Charts are immutable and may be
/// shared by any number of threads.

#ifndef homeomorphism_CoordinateSystem_h
#define homeomorphism_CoordinateSystem_h

#include "Geometry.h"

#include <type_traits>
#include <utility>

namespace homeomorphism
{

enum class CoordinateSystem
{
  /// Straight contours. The homeomorphism is piecewise linear.
  Linear = 0,
  /// The published construction: a straight piece, then an arc perpendicular to the edge.
  Contour = 1,
  /// The contours of the equilateral triangle, mapped by a chart that is twice continuously
  /// differentiable across edges.
  Smooth = 2,
  /// A piecewise cubic map that is continuously differentiable, including at vertices, and bends
  /// little. Planar pairs only. It has no charts; those of Linear take their place.
  Cubic = 3
};

/// The triangular coordinates (e, p, c) of a point of a triangle.
struct TriangularCoordinates
{
  /// e, 1 to 3: the edge at which the contour ends. Edge k is opposite the k-th corner.
  int Edge = 1;
  /// p in [0, 1]: the position of that end as a proportion of the length of the edge, from the next
  /// corner in cyclic order to the one after it.
  double EdgeParameter = 0.5;
  /// c in [0, 1]: the position of the point on its contour, 0 at the center and 1 on the edge.
  double ContourParameter = 0.0;
};

/// A linear map of the plane. Its columns are the images of the unit vectors.
struct Matrix2
{
  Vector2 ImageOfX;
  Vector2 ImageOfY;

  double Determinant() const { return Cross(this->ImageOfX, this->ImageOfY); }
};

inline Matrix2 FromRows(const Vector2& x, const Vector2& y)
{
  return { { x.x, y.x }, { x.y, y.y } };
}

/// Maps a point of a triangle to the point of the corresponding triangle with the same reference.
template <typename Chart>
Vector2 MapPoint(const Chart& from, const Chart& to, const Vector2& point)
{
  return to.ToPoint(from.ToReference(point));
}

/// The derivative of the homeomorphism at a point, from the derivatives of both charts. Charts with
/// a faster formula overload this function.
template <typename Differential>
Matrix2 MapDerivative(const Differential& from, const Differential& to)
{
  return { to.Pushforward(from.Pullback({ 1.0, 0.0 })),
    to.Pushforward(from.Pullback({ 0.0, 1.0 })) };
}

/// The determinant of MapDerivative, which is @a matrix. The determinant of a matrix suffers from
/// cancellation if a triangle or its neighbor is so thin that the columns are almost parallel.
/// Charts whose determinants are products overload this function.
template <typename Differential>
double MapDeterminant(const Differential&, const Differential&, const Matrix2& matrix)
{
  return matrix.Determinant();
}

/// The image of a point, and the derivatives of both charts there.
template <typename Chart>
struct MappedPoint
{
  Vector2 Image;
  typename Chart::Differential From;
  typename Chart::Differential To;
};

/// MapPoint with the derivatives of the charts. Charts that solve equations overload this function
/// so that each equation is solved only once.
template <typename Chart>
MappedPoint<Chart> MapWithDerivatives(const Chart& from, const Chart& to, const Vector2& point)
{
  const auto reference = from.ToReference(point);
  return { to.ToPoint(reference), from.DifferentialAt(reference), to.DifferentialAt(reference) };
}

/// The derivative of the homeomorphism at the point with this reference in both triangles.
template <typename Chart>
Matrix2 MapDerivative(
  const Chart& from, const Chart& to, const typename Chart::Reference& reference)
{
  return MapDerivative(from.DifferentialAt(reference), to.DifferentialAt(reference));
}

/// Whether a class is a chart. The file of each chart asserts this.
template <typename Chart, typename = void>
struct IsChart : std::false_type
{
};
template <typename Chart>
struct IsChart<Chart,
  std::enable_if_t<std::is_same_v<decltype(std::declval<const Chart&>().ToReference(Vector2())),
                     typename Chart::Reference> &&
    std::is_same_v<decltype(std::declval<const Chart&>().ToPoint(
                     std::declval<const typename Chart::Reference&>())),
      Vector2> &&
    std::is_same_v<decltype(std::declval<const Chart&>()
                              .DifferentialAt(std::declval<const typename Chart::Reference&>())
                              .Pullback(Vector2())),
      typename Chart::Direction> &&
    std::is_same_v<decltype(std::declval<const Chart&>()
                              .DifferentialAt(std::declval<const typename Chart::Reference&>())
                              .Pushforward(std::declval<const typename Chart::Direction&>())),
      Vector2> &&
    std::is_same_v<decltype(std::declval<const Chart&>().FromCoordinates(
                     std::declval<const Chart&>().ToCoordinates(
                       std::declval<const typename Chart::Reference&>()))),
      typename Chart::Reference>>> : std::true_type
{
};

} // namespace homeomorphism

#endif
