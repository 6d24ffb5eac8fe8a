// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicElement.h
/// The reduced Hsieh-Clough-Tocher triangle as a map of the plane, and the certificate that its
/// Jacobian determinant is positive.

#ifndef homeomorphism_CubicElement_h
#define homeomorphism_CubicElement_h

#include "Kernel/CoordinateSystem.h"
#include "Kernel/Geometry.h"

#include <array>
#include <cstdint>

namespace homeomorphism
{

inline Vector2 operator*(const Matrix2& m, const Vector2& v)
{
  return { m.ImageOfX.x * v.x + m.ImageOfY.x * v.y, m.ImageOfX.y * v.x + m.ImageOfY.y * v.y };
}

inline Matrix2 operator+(const Matrix2& a, const Matrix2& b)
{
  return { a.ImageOfX + b.ImageOfX, a.ImageOfY + b.ImageOfY };
}

inline Matrix2 operator-(const Matrix2& a, const Matrix2& b)
{
  return { a.ImageOfX - b.ImageOfX, a.ImageOfY - b.ImageOfY };
}

inline Matrix2 operator*(double s, const Matrix2& m)
{
  return { s * m.ImageOfX, s * m.ImageOfY };
}

/// The matrix w v^T.
inline Matrix2 OuterProduct(const Vector2& w, const Vector2& v)
{
  return { v.x * w, v.y * w };
}

inline double SquaredNorm(const Matrix2& m)
{
  return Dot(m.ImageOfX, m.ImageOfX) + Dot(m.ImageOfY, m.ImageOfY);
}

/// The solution x of m x = v.
inline Vector2 Solve(const Matrix2& m, const Vector2& v)
{
  const double inverse = 1.0 / m.Determinant();
  return { inverse * Cross(v, m.ImageOfY), inverse * Cross(m.ImageOfX, v) };
}

/// The derivative of the affine map of one triangle onto another. Every entry is accurate to a few
/// ulp if the differences of the corners are exact.
Matrix2 AffineDerivative(const std::array<Vector2, 3>& from, const std::array<Vector2, 3>& to);

/// The frame of a triangle with a right angle: unit vectors along its two legs, and their lengths.
/// The formulas for such a triangle have no cancellation, even if it is very thin.
struct RightAngle
{
  /// The corner with the right angle, -1 if there is none. Tangent points to it from the corner
  /// Start; Normal points from it to the third corner.
  int Corner = -1;
  int Start = 0;
  Vector2 Tangent;
  Vector2 Normal;
  double AlongTangent = 0.0;
  double AlongNormal = 0.0;
  /// D's derivatives at the corners along Tangent and Normal, which are used instead of Gradients.
  std::array<Vector2, 3> ByTangent = {};
  std::array<Vector2, 3> ByNormal = {};
};

/// The map f(x) = Affine x + D(x) on a triangle. D is the reduced Hsieh-Clough-Tocher interpolant
/// of the Values and Gradients at the corners: C1, cubic in each of the three pieces into which the
/// centroid divides the triangle, with a normal derivative that is linear along each edge (Clough,
/// Tocher 1965; Percell 1976). Two elements that agree in f and its derivative at the ends of a
/// shared edge therefore agree in both along the whole edge.
struct CubicElement
{
  /// Corners, counterclockwise, relative to an origin nearby.
  std::array<Vector2, 3> Points;
  Matrix2 Affine;
  /// D at the corners.
  std::array<Vector2, 3> Values = {};
  /// The derivative of D at the corners.
  std::array<Matrix2, 3> Gradients = {};
  RightAngle Right = {};
};

/// Bernstein ordinates of D. The piece opposite corner k has the corners i = NextCorner(k),
/// j = PreviousCorner(k) and the centroid O.
template <typename Vector>
struct CubicOrdinates
{
  std::array<Vector, 3> Corner;
  /// On edge k beside its start i, and beside its end j.
  std::array<Vector, 3> AfterStart;
  std::array<Vector, 3> BeforeEnd;
  /// On the segment from corner i to O, beside i.
  std::array<Vector, 3> Inner;
  /// The middle ordinate of piece k.
  std::array<Vector, 3> Middle;
  /// On the segment from corner i to O, beside O.
  std::array<Vector, 3> Spoke;
  Vector Center;
};

/// Barycentric coordinates of a point, computed from its components along the longest edge and
/// perpendicular to it: rounding moves the point by a few ulp of that edge, even in a needle.
Barycentric ToBarycentric(const std::array<Vector2, 3>& points, const Vector2& point);

/// Barycentric coordinates of a point relative to corner 0, faster than ToBarycentric, but
/// inaccurate in thin triangles.
inline Barycentric ToBarycentricByAreas(const std::array<Vector2, 3>& corners, const Vector2& point)
{
  const double scale = 1.0 / Cross(corners[1], corners[2]);
  const double first = scale * Cross(point, corners[2]);
  const double second = scale * Cross(corners[1], point);
  return { 1.0 - first - second, first, second };
}

/// Barycentric coordinates in the piece that contains a point of the triangle.
struct CubicPiece
{
  int Opposite;
  double Start;
  double End;
  double Centroid;

  /// The quadratic Bernstein polynomials of the start u, the end v and the centroid w: uu, 2uv, vv,
  /// 2uw, 2vw, ww.
  std::array<double, 6> GetQuadratics() const
  {
    const double u = this->Start;
    const double v = this->End;
    const double w = this->Centroid;
    return { u * u, 2.0 * u * v, v * v, 2.0 * u * w, 2.0 * v * w, w * w };
  }
};

inline CubicPiece FindPiece(const Barycentric& l)
{
  const int k = l[0] <= l[1] ? (l[0] <= l[2] ? 0 : 2) : (l[1] <= l[2] ? 1 : 2);
  return { k, l[NextCorner(k)] - l[k], l[PreviousCorner(k)] - l[k], 3.0 * l[k] };
}

CubicOrdinates<Vector2> GetOrdinates(const CubicElement& element);

/// The derivative of D at a point with barycentric coordinates @a l.
Matrix2 Derive(const CubicElement& element, const Barycentric& l);

/// D and its derivative; the same as Derive.
void Evaluate(const CubicElement& element, const CubicOrdinates<Vector2>& b, const Barycentric& l,
  Vector2& value, Matrix2& derivative);

/// ToBarycentric, prepared for many points of one triangle.
class BarycentricFrame
{
public:
  BarycentricFrame() = default;
  explicit BarycentricFrame(const std::array<Vector2, 3>& points);

  Barycentric operator()(const Vector2& point) const
  {
    const Vector2 d = point - this->Start;
    const double height = Dot(this->Across, d);
    const double along = Dot(this->Along, d) - height * this->Foot;
    return InOrder(this->Apex, height, 1.0 - height - along, along);
  }

private:
  int Apex = 0;
  Vector2 Start;
  Vector2 Along;
  Vector2 Across;
  /// The position of the apex's foot, as a fraction of the longest edge.
  double Foot = 0.0;
};

/// f (not only D) of one element, as a single formula for all three pieces. This is the fastest way
/// to evaluate it.
///
/// With the smallest barycentric coordinate m, n_i = l_i - m and w = 3 m, the barycentric
/// coordinates in the piece that contains the point are w and the two of n_0, n_1, n_2 that are not
/// zero. Pieces share the ordinates on their borders. So f is the sum of n_i^3, n_i^2 n_j, n_i^2 w,
/// n_i n_j w, n_i w^2 and w^3, times 19 ordinates and the factors of the Bernstein polynomials: the
/// terms of the other pieces vanish.
class CubicNet
{
public:
  CubicNet() = default;
  explicit CubicNet(const CubicElement& element);

  /// f at a point with barycentric coordinates @a l.
  Vector2 operator()(const Barycentric& l) const
  {
    return { Map(this->X, l[0], l[1], l[2]), Map(this->Y, l[0], l[1], l[2]) };
  }

  /// The difference of @a image and f at a point with barycentric coordinates @a l, and Newton's
  /// step towards the preimage of @a image. In thin elements, rounding may make the step
  /// inaccurate.
  Vector2 GetResidual(const Barycentric& l, const std::array<Vector2, 3>& points,
    const Vector2& image, Vector2& step) const;

  /// The derivative of f at a point with barycentric coordinates @a l, with an error of a few ulp
  /// times the aspect ratio of the triangle. @a area is twice its area.
  Matrix2 GetDerivative(
    const Barycentric& l, const std::array<Vector2, 3>& points, double area) const;

  /// The ordinates of one component of f. Element i belongs to corner i: the ordinate at the
  /// corner, those beside it on the edges to the next and to the previous corner, and those on the
  /// segment to the centroid; in Middle, it belongs to the piece opposite the corner.
  struct Component
  {
    double Corner[3];
    double Next[3];
    double Previous[3];
    double Inner[3];
    double Middle[3];
    double Spoke[3];
    double Center;
  };

  const Component& GetX() const { return this->X; }
  const Component& GetY() const { return this->Y; }

  /// Barycentric coordinates in the piece that contains a point: n_i = l_i - m and w = 3 m, where m
  /// is the least of the l_i.
  struct InPiece
  {
    double N0;
    double N1;
    double N2;
    double W;

    HOMEOMORPHISM_ALWAYS_INLINE InPiece(double l0, double l1, double l2)
    {
      const double lesser = l1 < l0 ? l1 : l0;
      const double m = l2 < lesser ? l2 : lesser;
      this->N0 = l0 - m;
      this->N1 = l1 - m;
      this->N2 = l2 - m;
      this->W = 3.0 * m;
    }
  };

  static HOMEOMORPHISM_ALWAYS_INLINE double Map(const Component& b, double l0, double l1, double l2)
  {
    const auto [n0, n1, n2, w] = InPiece(l0, l1, l2);
    const double ww = w * w;
    const double at0 =
      n0 * (n0 * b.Corner[0] + n1 * b.Next[0] + n2 * b.Previous[0] + w * b.Inner[0]);
    const double at1 =
      n1 * (n1 * b.Corner[1] + n2 * b.Next[1] + n0 * b.Previous[1] + w * b.Inner[1]);
    const double at2 =
      n2 * (n2 * b.Corner[2] + n0 * b.Next[2] + n1 * b.Previous[2] + w * b.Inner[2]);
    return n0 * (at0 + ww * b.Spoke[0]) + n1 * (at1 + ww * b.Spoke[1]) +
      n2 * (at2 + ww * b.Spoke[2]) +
      w * (n1 * n2 * b.Middle[0] + n2 * n0 * b.Middle[1] + n0 * n1 * b.Middle[2] + ww * b.Center);
  }

private:
  /// The derivatives along the edges from the corner opposite the piece to the next and to the
  /// previous corner.
  Matrix2 GetEdgeDerivatives(const CubicPiece& piece) const;

  Component X;
  Component Y;
};

/// The exponents of a Bernstein polynomial of degree 4, for start, end and centroid of a piece.
struct QuarticIndex
{
  int Start;
  int End;
  int Centroid;
};

/// The order of the 15 Bernstein coefficients of a piece.
const std::array<QuarticIndex, 15>& QuarticIndices();

/// Bernstein coefficients of det f': the quartic on the piece opposite corner k starts at 15 k.
using DeterminantCoefficients = std::array<double, 45>;

DeterminantCoefficients GetDeterminantCoefficients(const CubicElement& element);

/// A lower bound of det f' on the triangle. Where D' is small compared with Affine, it is computed
/// from the lengths of its ordinates; elsewhere, it is the smallest Bernstein coefficient minus a
/// bound on its rounding error. If it is positive, the determinant of the map that these doubles
/// define is positive everywhere. Where the smallest coefficient is below @a enough, pieces are
/// halved up to @a subdivisions times, which raises it towards the smallest determinant.
double LeastDeterminant(const CubicElement& element, double enough = 0.0, int subdivisions = 6);

/// The length of the longest ordinate of D, an upper bound of |D|.
double GreatestDisplacement(const CubicElement& element);

/// The matrix E of the bending: the integral of the squared second derivatives
/// |fxx|^2 + 2 |fxy|^2 + |fyy|^2 is the sum over both components of v^T E v, where v has the value,
/// the x derivative and the y derivative at corners 0, 1, 2.
using BendingMatrix = std::array<std::array<double, 9>, 9>;

BendingMatrix GetBendingMatrix(const std::array<Vector2, 3>& points);

} // namespace homeomorphism

#endif
