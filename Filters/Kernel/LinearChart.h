// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file LinearChart.h
/// The Linear coordinate system. Contours are segments from the centroid to the edges, and the
/// homeomorphism is piecewise linear.

#ifndef homeomorphism_LinearChart_h
#define homeomorphism_LinearChart_h

#include "CoordinateSystem.h"
#include "Geometry.h"

namespace homeomorphism
{

/// The chart of the Linear system: barycentric coordinates.
class LinearChart
{
public:
  using Reference = Barycentric;
  using Direction = Barycentric;

  explicit LinearChart(const TriangleShape& shape)
    : Shape(shape)
  {
  }

  Reference ToReference(const Vector2& point) const { return this->Shape.ToBarycentric(point); }
  Vector2 ToPoint(const Reference& l) const { return this->Shape.FromBarycentric(l); }

  class Differential
  {
  public:
    explicit Differential(const TriangleShape& shape)
      : Shape(shape)
    {
    }
    Direction Pullback(const Vector2& vector) const
    {
      return this->Shape.VectorToBarycentric(vector);
    }
    Vector2 Pushforward(const Direction& direction) const
    {
      return this->Shape.FromBarycentric(direction);
    }
    friend Matrix2 MapDerivative(const Differential& from, const Differential& to)
    {
      const int between = CornersBetween(to.Shape.Apex, from.Shape.Apex);
      return FromRows(from.Shape.GetGradient(to.Shape.GetX().Turned(between)),
        from.Shape.GetGradient(to.Shape.GetY().Turned(between)));
    }
    friend double MapDeterminant(const Differential& from, const Differential& to, const Matrix2&)
    {
      return AffineDeterminant(from.Shape, to.Shape);
    }

  private:
    TriangleShape Shape;
  };

  Differential DifferentialAt(const Reference&) const { return Differential(this->Shape); }
  Direction Pullback(const Reference& l, const Vector2& vector) const
  {
    return this->DifferentialAt(l).Pullback(vector);
  }
  Vector2 Pushforward(const Reference& l, const Direction& direction) const
  {
    return this->DifferentialAt(l).Pushforward(direction);
  }

  /// e is the edge with the smallest barycentric coordinate (the first of equals), c = 1 - 3 l_e,
  /// and p is the point at which the ray from the centroid through the point meets the edge.
  TriangularCoordinates ToCoordinates(const Reference& l) const
  {
    int edge = 0;
    for (int k = 1; k < 3; ++k)
    {
      if (l[k] < l[edge])
      {
        edge = k;
      }
    }
    const double towardsNext = l[NextCorner(edge)] - l[edge];
    const double towardsPrevious = l[PreviousCorner(edge)] - l[edge];
    const double c = towardsNext + towardsPrevious;
    return { edge + 1, c > 0.0 ? towardsPrevious / c : 0.5, c < 1.0 ? c : 1.0 };
  }

  Reference FromCoordinates(const TriangularCoordinates& coordinates) const
  {
    const int edge = coordinates.Edge - 1;
    const double p = coordinates.EdgeParameter;
    const double c = coordinates.ContourParameter;
    const double least = (1.0 - c) / 3.0;
    return InOrder(edge, least, least + c * (1.0 - p), least + c * p);
  }

private:
  TriangleShape Shape;
};

static_assert(IsChart<LinearChart>::value, "See CoordinateSystem.h");

} // namespace homeomorphism

#endif
