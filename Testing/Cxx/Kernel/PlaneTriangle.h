// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PlaneTriangle.h
/// A triangle of the plane together with its frame, for tests.

#ifndef PlaneTriangle_h
#define PlaneTriangle_h

#include "Kernel/CoordinateSystem.h"
#include "Kernel/Geometry.h"
#include "Kernel/SmoothChart.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace homeomorphism_test
{

using namespace homeomorphism;

struct PlaneTriangle
{
  std::array<Vector2, 3> Corners;
  TriangleShape Shape;
  Vector2 Origin;
  Vector2 Tangent;

  explicit PlaneTriangle(const std::array<Vector2, 3>& corners)
    : Corners(corners)
  {
    double longest = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      const Vector2 edge = corners[PreviousCorner(k)] - corners[NextCorner(k)];
      const double length = std::hypot(edge.x, edge.y);
      if (length > longest)
      {
        longest = length;
        this->Shape.Apex = k;
        this->Origin = corners[NextCorner(k)];
        this->Tangent = (1.0 / length) * edge;
      }
    }
    this->Shape.Base = longest;
    const Vector2 edge = corners[PreviousCorner(this->Shape.Apex)] - this->Origin;
    const Vector2 apex = corners[this->Shape.Apex] - this->Origin;
    this->Shape.ApexX = Dot(apex, this->Tangent);
    this->Shape.Height = DifferenceOfProducts(edge.x, apex.y, edge.y, apex.x) / longest;
  }

  Vector2 ToFrame(const Vector2& point) const
  {
    const Vector2 d = point - this->Origin;
    return { Dot(d, this->Tangent), Cross(this->Tangent, d) };
  }

  Vector2 FromFrame(const Vector2& point) const
  {
    return this->Origin + this->VectorFromFrame(point);
  }

  Vector2 VectorFromFrame(const Vector2& v) const
  {
    return { v.x * this->Tangent.x - v.y * this->Tangent.y,
      v.x * this->Tangent.y + v.y * this->Tangent.x };
  }

  /// The neighbor with this apex across the edge opposite corner @a edge.
  Neighbor NeighborWithApex(int edge, const Vector2& apex) const
  {
    if (std::isnan(apex.x))
    {
      return {};
    }
    return { true,
      ViewFromEdge(this->Corners[NextCorner(edge)], this->Corners[PreviousCorner(edge)], apex) };
  }

  EdgeViews Views() const
  {
    return ViewsFromEdges(this->Corners[0], this->Corners[1], this->Corners[2]);
  }
};

/// Transforms the derivative of a homeomorphism from the frames of two triangles to coordinates of
/// the plane.
inline Matrix2 InPlane(const PlaneTriangle& from, const PlaneTriangle& to, const Matrix2& matrix)
{
  const auto image = [&](const Vector2& v) {
    const Vector2 w{ Dot(v, from.Tangent), Cross(from.Tangent, v) };
    return to.VectorFromFrame(w.x * matrix.ImageOfX + w.y * matrix.ImageOfY);
  };
  return { image({ 1.0, 0.0 }), image({ 0.0, 1.0 }) };
}

inline double Norm(const Vector2& v)
{
  return std::hypot(v.x, v.y);
}

inline double Norm(const Matrix2& m)
{
  return std::hypot(Norm(m.ImageOfX), Norm(m.ImageOfY));
}

inline Matrix2 operator-(const Matrix2& a, const Matrix2& b)
{
  return { a.ImageOfX - b.ImageOfX, a.ImageOfY - b.ImageOfY };
}

} // namespace homeomorphism_test

#endif
