// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Geometry.h
/// Plane geometry: vectors, and a triangle in its own frame.

#ifndef homeomorphism_Geometry_h
#define homeomorphism_Geometry_h

#include "Kernel/Simd/Vectorize.h"

#include <algorithm>
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

/// The corner that is @a further (0, 1 or 2) corners after @a corner.
constexpr int CornerAfter(int corner, int further)
{
  return corner + further < 3 ? corner + further : corner + further - 3;
}

/// How many corners after @a corner another one is.
constexpr int CornersBetween(int corner, int other)
{
  return other < corner ? other + 3 - corner : other - corner;
}

/// Values for a corner, the one after it and the one before it, in the order of the corners. The
/// values are loaded, not stored, at indices that depend on the corner: after such stores, loading
/// the result as a whole would be slow.
template <typename T>
HOMEOMORPHISM_ALWAYS_INLINE std::array<T, 3> InOrder(
  int corner, const T& own, const T& next, const T& previous)
{
  static constexpr std::int8_t places[3][3] = { { 0, 1, 2 }, { 2, 0, 1 }, { 1, 2, 0 } };
  const T values[3] = { own, next, previous };
  const std::int8_t(&place)[3] = places[corner];
  // All are initialized. NOLINTNEXTLINE(clang-analyzer-core.uninitialized.ArraySubscript)
  return { values[place[0]], values[place[1]], values[place[2]] };
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

inline double MaxNorm(const Vector2& v)
{
  return std::max(std::abs(v.x), std::abs(v.y));
}

/// a d - b c with a relative error of at most 1.5 ulp, even under cancellation (Kahan; Jeannerod,
/// Louvet and Muller 2013). Without a hardware fused multiply-add this is slow: use it in
/// construction, not for every point.
HOMEOMORPHISM_ALWAYS_INLINE double DifferenceOfProducts(double a, double d, double b, double c)
{
  const double bc = b * c;
  const double error = std::fma(-b, c, bc);
  return std::fma(a, d, -bc) + error;
}

/// The greatest power of two not above a positive number, and 1 for all other values. The result
/// and its reciprocal are normal numbers. Branch-free, so that loops vectorize.
HOMEOMORPHISM_ALWAYS_INLINE double PowerOfTwoNear(double x)
{
  constexpr double least = 0x1p-1021;
  constexpr double greatest = 0x1p1021;
  double power = x > least ? x : least;
  power = power < greatest ? power : greatest;
  // Clear the significand: keep the sign and the exponent.
  std::uint64_t bits;
  std::memcpy(&bits, &power, sizeof(bits));
  bits &= std::uint64_t(0xfff) << 52;
  std::memcpy(&power, &bits, sizeof(power));
  power = x > 0.0 ? power : 1.0;
  return x <= std::numeric_limits<double>::max() ? power : 1.0;
}

/// PowerOfTwoNear of the component with the larger absolute value.
HOMEOMORPHISM_ALWAYS_INLINE double PowerOfTwoNear(const Vector2& v)
{
  const double x = std::abs(v.x);
  const double y = std::abs(v.y);
  return PowerOfTwoNear(x > y ? x : y);
}

/// Barycentric coordinates of a point (they sum to 1), or barycentric components of a vector (they
/// sum to 0).
using Barycentric = std::array<double, 3>;

/// Barycentric coordinates for a corner, the next one and the previous one.
struct CornerCoordinates
{
  double Own;
  double Next;
  double Previous;

  /// Conversions from and to the coordinates for the corners 0, 1, 2.
  static HOMEOMORPHISM_ALWAYS_INLINE CornerCoordinates From(const Barycentric& l, int corner)
  {
    return { l[corner], l[NextCorner(corner)], l[PreviousCorner(corner)] };
  }
  HOMEOMORPHISM_ALWAYS_INLINE Barycentric InOrderFrom(int corner) const
  {
    return InOrder(corner, this->Own, this->Next, this->Previous);
  }

  /// The same coordinates, ordered from the corner that is @a further corners (0, 1 or 2) after
  /// this one.
  HOMEOMORPHISM_ALWAYS_INLINE CornerCoordinates Turned(int further) const
  {
    const double values[5] = { this->Own, this->Next, this->Previous, this->Own, this->Next };
    return { values[further], values[further + 1], values[further + 2] };
  }
};

/// A non-degenerate triangle in its own frame. The longest edge lies on the x axis, from the corner
/// after the apex at the origin to the corner before the apex at (Base, 0). The apex is (ApexX,
/// Height) with 0 <= ApexX <= Base and Height > 0. The corners 0, 1, 2 are in counterclockwise
/// order.
///
/// Needles are well-conditioned in this frame: converting a point to barycentric coordinates and
/// back moves it by a few ulp of Base, independently of the aspect ratio.
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

  /// Barycentric coordinates of the point of the closed triangle nearest to a point.
  Barycentric ToBarycentric(const Vector2& point) const
  {
    return this->ToCornerCoordinates(point).InOrderFrom(this->Apex);
  }

  /// The result of ToBarycentric, for the apex and the corners after and before it.
  HOMEOMORPHISM_ALWAYS_INLINE CornerCoordinates ToCornerCoordinates(const Vector2& point) const
  {
    const double apex = point.y / this->Height;
    const double second = (point.x - this->ApexX * apex) / this->Base;
    const double first = 1.0 - apex - second;
    if (!(apex >= 0.0 && first >= 0.0 && second >= 0.0))
    {
      return CornerCoordinates::From(this->NearestOnBoundary(point), this->Apex);
    }
    return { apex, first, second };
  }

  /// Barycentric coordinates of the boundary point nearest to @a point.
  HOMEOMORPHISM_NEVER_INLINE Barycentric NearestOnBoundary(const Vector2& point) const
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

  /// The point with these barycentric coordinates. The function is linear, so it also maps the
  /// components of a vector to the vector.
  Vector2 FromBarycentric(const Barycentric& l) const
  {
    return this->ToFrame(l[this->Apex], l[PreviousCorner(this->Apex)]);
  }

  /// The result of FromBarycentric, from the coordinates for the apex and the corner before it.
  HOMEOMORPHISM_ALWAYS_INLINE Vector2 ToFrame(double apex, double second) const
  {
    return { this->Base * second + this->ApexX * apex, this->Height * apex };
  }

  /// The components of a vector of the plane, which sum to 0: the derivative of ToBarycentric.
  Barycentric VectorToBarycentric(const Vector2& vector) const
  {
    return this->VectorToCornerCoordinates(vector).InOrderFrom(this->Apex);
  }

  /// The result of VectorToBarycentric, for the apex and the corners after and before it.
  HOMEOMORPHISM_ALWAYS_INLINE CornerCoordinates VectorToCornerCoordinates(
    const Vector2& vector) const
  {
    // Reciprocals, which are the same for both axes.
    const double apex = vector.y * (1.0 / this->Height);
    const double second = (vector.x - this->ApexX * apex) * (1.0 / this->Base);
    return { apex, -apex - second, second };
  }

  /// The x and y coordinates of the apex and of the corners after and before it.
  CornerCoordinates GetX() const { return { this->ApexX, 0.0, this->Base }; }
  CornerCoordinates GetY() const { return { this->Height, 0.0, 0.0 }; }

  /// The gradient of the affine function with these values at the apex and at the corners after and
  /// before it.
  HOMEOMORPHISM_ALWAYS_INLINE Vector2 GetGradient(const CornerCoordinates& values) const
  {
    const double x = (values.Previous - values.Next) * (1.0 / this->Base);
    return { x, (values.Own - values.Next - this->ApexX * x) * (1.0 / this->Height) };
  }
};

/// The determinant of the affine map of one triangle onto another, from frame to frame.
inline double AffineDeterminant(const TriangleShape& from, const TriangleShape& to)
{
  return (to.Base * (1.0 / from.Base)) * (to.Height * (1.0 / from.Height));
}

/// A triangle seen from one of its edges: the opposite corner relative to the edge. These numbers
/// suffice to unfold the triangle about the edge.
struct EdgeView
{
  /// Length of the edge.
  double Length = 0.0;
  /// Foot of the opposite corner, as a proportion of the length of the edge, from the next corner
  /// in cyclic order to the one after it. Outside [0, 1] if an angle at the edge is obtuse.
  double Foot = 0.0;
  /// Distance of the opposite corner from the line of the edge.
  double Height = 0.0;
};

/// The view from the edge from @a start to @a end, in the plane. Differences of nearby coordinates
/// are exact, so each number is accurate to a few ulp, even for the short edge of a needle, for
/// which the frame of the triangle is not accurate enough.
HOMEOMORPHISM_ALWAYS_INLINE EdgeView ViewFromEdge(
  const Vector2& start, const Vector2& end, const Vector2& opposite)
{
  // Scaling by a power of two is exact and avoids underflow of the products.
  const double scale = PowerOfTwoNear(end - start);
  const Vector2 edge = (1.0 / scale) * (end - start);
  const Vector2 other = (1.0 / scale) * (opposite - start);
  const double length = std::sqrt(Dot(edge, edge));
  return { scale * length,
    DifferenceOfProducts(edge.x, other.x, -edge.y, other.y) / length / length,
    scale * std::abs(DifferenceOfProducts(edge.x, other.y, edge.y, other.x)) / length };
}

/// The Length of ViewFromEdge; the same, bit for bit.
HOMEOMORPHISM_ALWAYS_INLINE double EdgeLength(const Vector2& start, const Vector2& end)
{
  const double scale = PowerOfTwoNear(end - start);
  const Vector2 edge = (1.0 / scale) * (end - start);
  return scale * std::sqrt(Dot(edge, edge));
}

/// The views from the three edges. Element k belongs to the edge opposite corner k.
using EdgeViews = std::array<EdgeView, 3>;

inline EdgeViews ViewsFromEdges(const Vector2& a, const Vector2& b, const Vector2& c)
{
  return { ViewFromEdge(b, c, a), ViewFromEdge(c, a, b), ViewFromEdge(a, b, c) };
}

/// The view from the edge in the opposite direction, as in the twin triangle.
inline EdgeView Reversed(const EdgeView& view)
{
  return { view.Length, 1.0 - view.Foot, view.Height };
}

} // namespace homeomorphism

#endif
