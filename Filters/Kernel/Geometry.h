// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Geometry.h
/// Plain structs of plane geometry: vectors, and a triangle seen in its own frame.

#ifndef homeomorphism_Geometry_h
#define homeomorphism_Geometry_h

#include "Kernel/Simd/Vectorize.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace homeomorphism
{

/// The corner after @a corner in the cyclic order 0, 1, 2.
constexpr int NextCorner(int corner)
{
  return corner == 2 ? 0 : corner + 1;
}

/// The corner before @a corner in the cyclic order 0, 1, 2.
constexpr int PreviousCorner(int corner)
{
  return corner == 0 ? 2 : corner - 1;
}

/// A point or a vector of a plane.
struct Vector2
{
  double x = 0.0;
  double y = 0.0;
};

inline Vector2 operator+(const Vector2& a, const Vector2& b)
{
  return { a.x + b.x, a.y + b.y };
}

inline Vector2 operator-(const Vector2& a, const Vector2& b)
{
  return { a.x - b.x, a.y - b.y };
}

inline Vector2 operator*(double s, const Vector2& a)
{
  return { s * a.x, s * a.y };
}

inline double Dot(const Vector2& a, const Vector2& b)
{
  return a.x * b.x + a.y * b.y;
}

/// The z component of the cross product: positive if b is to the left of a.
inline double Cross(const Vector2& a, const Vector2& b)
{
  return a.x * b.y - a.y * b.x;
}

/// a d - b c with a relative error of at most 1.5 ulp, however close the two products are (Kahan;
/// Jeannerod, Louvet and Muller 2013). Slow where the processor has no fused multiply-add, so for
/// construction rather than for every point.
HOMEOMORPHISM_ALWAYS_INLINE double DifferenceOfProducts(double a, double d, double b, double c)
{
  const double bc = b * c;
  const double error = std::fma(-b, c, bc);
  return std::fma(a, d, -bc) + error;
}

/// The power of two next to a positive number, 1 for others; it and its reciprocal are normal
/// numbers. Nothing branches, so that loops can become vector instructions.
HOMEOMORPHISM_ALWAYS_INLINE double PowerOfTwoNear(double x)
{
  constexpr double least = 0x1p-1021;
  constexpr double greatest = 0x1p1021;
  double power = x > least ? x : least;
  power = power < greatest ? power : greatest;
  // The number without its fraction: in a double, the bits after the sign and the exponent.
  std::uint64_t bits;
  std::memcpy(&bits, &power, sizeof(bits));
  bits &= std::uint64_t(0xfff) << 52;
  std::memcpy(&power, &bits, sizeof(power));
  power = x > 0.0 ? power : 1.0;
  return x <= std::numeric_limits<double>::max() ? power : 1.0;
}

/// The greatest power of two by which both components of a vector are at least 1 or less, see
/// PowerOfTwoNear.
HOMEOMORPHISM_ALWAYS_INLINE double PowerOfTwoNear(const Vector2& v)
{
  const double x = std::abs(v.x);
  const double y = std::abs(v.y);
  return PowerOfTwoNear(x > y ? x : y);
}

/// Barycentric coordinates of a point of a triangle (they sum to 1), or the components of a vector
/// along the corners (they sum to 0).
using Barycentric = std::array<double, 3>;

/// A non-degenerate triangle in its own frame: the longest edge lies on the x axis, from the corner
/// after the apex, at the origin, to the corner before the apex, at (Base, 0); the apex is at
/// (ApexX, Height) with 0 <= ApexX <= Base and Height > 0. The corners 0, 1, 2 therefore follow
/// each other counterclockwise.
///
/// In this frame a needle is as harmless as an equilateral triangle: converting a point to
/// barycentric coordinates and back moves it by a few ulp of Base, never by ulp times aspect ratio.
struct TriangleShape
{
  double Base = 1.0;
  double ApexX = 0.5;
  double Height = 1.0;
  int Apex = 2;

  /// The position of a corner, 0 to 2.
  Vector2 Corner(int corner) const
  {
    if (corner == this->Apex)
    {
      return { this->ApexX, this->Height };
    }
    return { corner == NextCorner(this->Apex) ? 0.0 : this->Base, 0.0 };
  }

  /// Barycentric coordinates of a point of the closed triangle, or of the nearest point of it.
  Barycentric ToBarycentric(const Vector2& point) const
  {
    const double apex = point.y / this->Height;
    const double second = (point.x - this->ApexX * apex) / this->Base;
    const double first = 1.0 - apex - second;
    if (!(apex >= 0.0 && first >= 0.0 && second >= 0.0))
    {
      return this->NearestOnBoundary(point);
    }
    Barycentric l;
    l[this->Apex] = apex;
    l[NextCorner(this->Apex)] = first;
    l[PreviousCorner(this->Apex)] = second;
    return l;
  }

  /// Barycentric coordinates of the point of the triangle's boundary that is nearest to @a point.
  Barycentric NearestOnBoundary(const Vector2& point) const
  {
    Barycentric nearest{};
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k)
    {
      const Vector2 start = this->Corner(NextCorner(k));
      const Vector2 end = this->Corner(PreviousCorner(k));
      const Vector2 edge = end - start;
      const double length = std::hypot(edge.x, edge.y);
      const Vector2 fromStart = point - start;
      const double along =
        (fromStart.x * (edge.x / length) + fromStart.y * (edge.y / length)) / length;
      const double t = along > 0.0 ? (along < 1.0 ? along : 1.0) : 0.0;
      const double distance = std::hypot(fromStart.x - t * edge.x, fromStart.y - t * edge.y);
      if (distance < least)
      {
        least = distance;
        nearest[k] = 0.0;
        nearest[NextCorner(k)] = 1.0 - t;
        nearest[PreviousCorner(k)] = t;
      }
    }
    return nearest;
  }

  /// The point with these barycentric coordinates. Linear, so it also takes a vector's components
  /// to the vector.
  Vector2 FromBarycentric(const Barycentric& l) const
  {
    const double apex = l[this->Apex];
    const double second = l[PreviousCorner(this->Apex)];
    return { this->Base * second + this->ApexX * apex, this->Height * apex };
  }

  /// The components, summing to 0, of a vector of the plane: the derivative of ToBarycentric.
  Barycentric VectorToBarycentric(const Vector2& vector) const
  {
    const double apex = vector.y / this->Height;
    const double second = (vector.x - this->ApexX * apex) / this->Base;
    Barycentric l;
    l[this->Apex] = apex;
    l[PreviousCorner(this->Apex)] = second;
    l[NextCorner(this->Apex)] = -apex - second;
    return l;
  }
};

/// What one edge of a triangle sees of the triangle's corner on the other side: all that has to be
/// known of a triangle in order to unfold it about that edge.
struct EdgeView
{
  /// Length of the edge.
  double Length = 0.0;
  /// Foot of the opposite corner on the edge, as a proportion of the edge's length counted from the
  /// next corner in cyclic order towards the one after; outside [0, 1] beside an obtuse angle.
  double Foot = 0.0;
  /// Distance of the opposite corner from the edge's line.
  double Height = 0.0;
};

/// The view from an edge of the plane, from @a start to @a end, of the opposite corner. Differences
/// of nearby coordinates being exact, this is accurate to a few ulp of each number, even for the
/// short edge of a needle, where the triangle's own frame knows only the corners' places.
HOMEOMORPHISM_ALWAYS_INLINE EdgeView ViewFromEdge(
  const Vector2& start, const Vector2& end, const Vector2& opposite)
{
  // A power of two keeps the products from underflow without rounding anything.
  const double scale = PowerOfTwoNear(end - start);
  const Vector2 edge = (1.0 / scale) * (end - start);
  const Vector2 other = (1.0 / scale) * (opposite - start);
  const double length = std::sqrt(Dot(edge, edge));
  return { scale * length,
    DifferenceOfProducts(edge.x, other.x, -edge.y, other.y) / length / length,
    scale * std::abs(DifferenceOfProducts(edge.x, other.y, edge.y, other.x)) / length };
}

/// The Length of such a view, to the same bits.
HOMEOMORPHISM_ALWAYS_INLINE double EdgeLength(const Vector2& start, const Vector2& end)
{
  const double scale = PowerOfTwoNear(end - start);
  const Vector2 edge = (1.0 / scale) * (end - start);
  return scale * std::sqrt(Dot(edge, edge));
}

/// The views from the three edges: element k from the edge opposite corner k.
using EdgeViews = std::array<EdgeView, 3>;

inline EdgeViews ViewsFromEdges(const Vector2& a, const Vector2& b, const Vector2& c)
{
  return { ViewFromEdge(b, c, a), ViewFromEdge(c, a, b), ViewFromEdge(a, b, c) };
}

/// The same view with the edge run through in the opposite direction, as a triangle on the other
/// side of the edge sees it.
inline EdgeView Reversed(const EdgeView& view)
{
  return { view.Length, 1.0 - view.Foot, view.Height };
}

} // namespace homeomorphism

#endif
