// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file AdjacentTriangles.h
/// Two triangles with a common edge, for tests of derivatives across the edge.

#ifndef AdjacentTriangles_h
#define AdjacentTriangles_h

#include "RandomTriangles.h"

namespace homeomorphism_test
{

/// The edge from Start to End, the first triangle to its left and the second to its right. The
/// shared edge is opposite corner 2 in both. It runs from corner 0 to corner 1 in the first and
/// from corner 1 to corner 0 in the second.
struct AdjacentTriangles
{
  Vector2 Start;
  Vector2 End;
  PlaneTriangle First;
  PlaneTriangle Second;

  AdjacentTriangles(
    const Vector2& start, const Vector2& end, const Vector2& left, const Vector2& right)
    : Start(start)
    , End(end)
    , First({ start, end, left })
    , Second({ end, start, right })
  {
  }

  Vector2 Tangent() const { return (1.0 / this->Length()) * (this->End - this->Start); }
  /// The unit normal of the edge, pointing into the first triangle.
  Vector2 Normal() const
  {
    const Vector2 tangent = this->Tangent();
    return { -tangent.y, tangent.x };
  }
  double Length() const { return Norm(this->End - this->Start); }
  Vector2 At(double w) const { return (1.0 - w) * this->Start + w * this->End; }

  /// The Smooth charts of the two triangles, which have no other neighbors.
  std::array<SmoothChart, 2> SmoothCharts() const
  {
    const EdgeViews first = this->First.Views();
    const EdgeViews second = this->Second.Views();
    return { SmoothChart(
               this->First.Shape, first, { Neighbor{}, {}, { true, Reversed(second[2]) } }),
      SmoothChart(this->Second.Shape, second, { Neighbor{}, {}, { true, Reversed(first[2]) } }) };
  }
};

/// The Smooth reference, in the first or in the second triangle, of the point at w on the edge.
inline std::array<Barycentric, 2> OnSharedEdge(double w)
{
  return { Barycentric{ 1.0 - w, w, 0.0 }, Barycentric{ w, 1.0 - w, 0.0 } };
}

/// Two triangles of similar size.
inline AdjacentTriangles ModerateAdjacentTriangles(RandomNumbers& random)
{
  const double angle = random.Uniform(0.0, 6.283185307179586);
  const double scale = random.PowerOfTen(-0.5, 0.5);
  const Vector2 u{ scale * std::cos(angle), scale * std::sin(angle) };
  const auto surfacePoint = [&u](double x, double y) -> Vector2 {
    return { x * u.x - y * u.y, x * u.y + y * u.x };
  };
  return { surfacePoint(0.0, 0.0), surfacePoint(1.0, 0.0),
    surfacePoint(random.Uniform(-0.2, 1.2), random.Uniform(0.4, 1.5)),
    surfacePoint(random.Uniform(-0.2, 1.2), -random.Uniform(0.4, 1.5)) };
}

/// Two triangles, one up to a million times larger than the other, with apexes up to twenty edge
/// lengths aside.
inline AdjacentTriangles AnyAdjacentTriangles(RandomNumbers& random)
{
  const double angle = random.Uniform(0.0, 6.283185307179586);
  const Vector2 u{ std::cos(angle), std::sin(angle) };
  const auto surfacePoint = [&u](double x, double y) -> Vector2 {
    return { x * u.x - y * u.y, x * u.y + y * u.x };
  };
  const double ratio = random.PowerOfTen(-6.0, 6.0);
  const double height = random.PowerOfTen(-1.0, 1.0) / std::sqrt(ratio);
  const auto foot = [&random]() {
    return random.Chance(0.5) ? random.Uniform() : random.Uniform(-20.0, 21.0);
  };
  const double left = foot();
  const double right = foot();
  return { surfacePoint(0.0, 0.0), surfacePoint(1.0, 0.0), surfacePoint(left, height),
    surfacePoint(right, -height * ratio) };
}

inline Vector2 Times(const Matrix2& matrix, const Vector2& v)
{
  return v.x * matrix.ImageOfX + v.y * matrix.ImageOfY;
}

} // namespace homeomorphism_test

#endif
