// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CoordinateSystem.h
/// The interface of a coordinate system, and the homeomorphism that two of its charts make.
///
/// A coordinate system gives every triangle a *chart*: a bijection between the triangle's points
/// and a reference that is the same for all triangles. A chart is built from the triangle's shape
/// and offers
///
///     using Reference = ...;   // a point of the reference
///     using Direction = ...;   // a tangent vector of the reference
///     Reference ToReference(const Vector2& point) const;
///     Vector2 ToPoint(const Reference& reference) const;
///     Direction Pullback(const Reference& reference, const Vector2& vector) const;   // D
///     ToReference Vector2 Pushforward(const Reference& reference, const Direction& direction)
///     const; // D ToPoint TriangularCoordinates ToCoordinates(const Reference& reference) const;
///     Reference FromCoordinates(const TriangularCoordinates& coordinates) const;
///
/// Points and vectors are in the triangle's own frame (TriangleShape). A point outside the closed
/// triangle by rounding is taken for the nearest point of it. Derivatives are exact (closed form);
/// on an edge they are the limits from this triangle's side. Charts are immutable: any number of
/// threads may use one.

#ifndef homeomorphism_CoordinateSystem_h
#define homeomorphism_CoordinateSystem_h

#include "Geometry.h"

namespace homeomorphism
{

enum class CoordinateSystem
{
  /// Straight contours: the piecewise linear homeomorphism.
  Linear = 0,
  /// The published construction: straight piece, then an arc that meets the edge at a right angle.
  Contour = 1,
  /// The contours of the equilateral triangle, carried over by a chart that is twice continuously
  /// differentiable across edges.
  Smooth = 2
};

/// The triangular coordinates (e, p, c) of a point of a triangle.
struct TriangularCoordinates
{
  /// e, 1 to 3: the edge at which the point's contour ends. Edge k is opposite the k-th corner.
  int Edge = 1;
  /// p in [0, 1]: where on the edge it ends, as a proportion of the edge's length, counted from the
  /// next corner in cyclic order towards the one after.
  double EdgeParameter = 0.5;
  /// c in [0, 1]: how far along the contour the point is, 0 at the center, 1 on the edge.
  double ContourParameter = 0.0;
};

/// A linear map of the plane: its columns are the images of the unit vectors.
struct Matrix2
{
  Vector2 ImageOfX;
  Vector2 ImageOfY;

  double Determinant() const { return Cross(this->ImageOfX, this->ImageOfY); }
};

/// The homeomorphism from one triangle to its counterpart: the point with the same coordinates.
template <typename Chart>
Vector2 MapPoint(const Chart& from, const Chart& to, const Vector2& point)
{
  return to.ToPoint(from.ToReference(point));
}

/// The homeomorphism's derivative at the point that has this reference in both triangles.
template <typename Chart>
Matrix2 MapDerivative(
  const Chart& from, const Chart& to, const typename Chart::Reference& reference)
{
  return { to.Pushforward(reference, from.Pullback(reference, { 1.0, 0.0 })),
    to.Pushforward(reference, from.Pullback(reference, { 0.0, 1.0 })) };
}

} // namespace homeomorphism

#endif
