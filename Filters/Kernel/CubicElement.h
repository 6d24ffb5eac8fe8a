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

/// The derivative of the affine map that takes one triangle to another: accurate to a few ulp of
/// every entry if the differences of the corners are exact.
Matrix2 AffineDerivative(const std::array<Vector2, 3>& from, const std::array<Vector2, 3>& to);

/// The frame of a triangle with a right angle, however thin: unit vectors along its two legs, and
/// the legs' lengths. In the formulas for such a triangle nothing cancels.
struct RightAngle
{
  /// The corner with the right angle, -1 if there is none; Tangent leads to it from the corner
  /// Start, Normal leads from it to the third corner.
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
/// of the Values and Gradients at the corners: C1, cubic in each of the three pieces about the
/// centroid, cubic along each edge with a normal derivative that is linear there (Clough, Tocher
/// 1965; Percell 1976). Two elements that agree in f and its derivative at the ends of a shared
/// edge therefore agree in both along the whole edge.
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

/// Barycentric coordinates of a point, by its components along the longest edge and at a right
/// angle to it: rounding moves the point by a few ulp of that edge, even in a needle.
Barycentric ToBarycentric(const std::array<Vector2, 3>& points, const Vector2& point);

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

/// D and its derivative at a point with barycentric coordinates @a l.
void Evaluate(const CubicElement& element, const CubicOrdinates<Vector2>& ordinates,
  const Barycentric& l, Vector2& value, Matrix2& derivative);

/// Barycentric coordinates as ToBarycentric gives them, prepared for many points of one triangle.
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
    Barycentric l;
    l[this->Apex] = height;
    l[PreviousCorner(this->Apex)] = along;
    l[NextCorner(this->Apex)] = 1.0 - height - along;
    return l;
  }

private:
  int Apex = 0;
  Vector2 Start;
  Vector2 Along;
  Vector2 Across;
  /// Of the apex, over the length of the longest edge.
  double Foot = 0.0;
};

/// The Bernstein ordinates of f, not only of D, of one element: the fastest way to its values.
class CubicNet
{
public:
  CubicNet() = default;
  explicit CubicNet(const CubicElement& element);

  /// f at a point with barycentric coordinates @a l.
  Vector2 operator()(const Barycentric& l) const
  {
    const CubicPiece piece = FindPiece(l);
    Vector2 start;
    Vector2 end;
    Vector2 centroid;
    this->Reduce(piece, start, end, centroid);
    return piece.Start * start + piece.End * end + piece.Centroid * centroid;
  }

  /// How far f is from @a image at a point with barycentric coordinates @a l, and Newton's step
  /// towards the point that has this image. Rounding may spoil the step in thin elements.
  Vector2 GetResidual(const Barycentric& l, const std::array<Vector2, 3>& points,
    const Vector2& image, Vector2& step) const;

private:
  void Reduce(const CubicPiece& piece, Vector2& start, Vector2& end, Vector2& centroid) const
  {
    const std::array<Vector2, 19>& b = this->Ordinates;
    const int k = piece.Opposite;
    const int i = NextCorner(k);
    const int j = PreviousCorner(k);
    const auto [uu, uv, vv, uw, vw, ww] = piece.GetQuadratics();
    start = uu * b[i] + uv * b[AfterStart + k] + vv * b[BeforeEnd + k] + uw * b[Inner + i] +
      vw * b[Middle + k] + ww * b[Spoke + i];
    end = uu * b[AfterStart + k] + uv * b[BeforeEnd + k] + vv * b[j] + uw * b[Middle + k] +
      vw * b[Inner + j] + ww * b[Spoke + j];
    centroid = uu * b[Inner + i] + uv * b[Middle + k] + vv * b[Inner + j] + uw * b[Spoke + i] +
      vw * b[Spoke + j] + ww * b[Center];
  }

  /// As in CubicOrdinates, three of a kind, the corners' first.
  enum : std::uint8_t
  {
    AfterStart = 3,
    BeforeEnd = 6,
    Inner = 9,
    Middle = 12,
    Spoke = 15,
    Center = 18
  };
  std::array<Vector2, 19> Ordinates;
};

/// The weights of a quartic's Bernstein coefficients: start, end and centroid of its piece.
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

/// A lower bound of det f' on the triangle: where D' is small beside Affine, from the lengths of
/// its ordinates; elsewhere the least Bernstein coefficient less what rounding may have done to it.
/// Positive means positive everywhere: for the map that these doubles define, with
/// no rounding. Where the least coefficient is below @a enough, pieces are halved up to
/// @a subdivisions times, which raises it towards the least determinant.
double LeastDeterminant(const CubicElement& element, double enough = 0.0, int subdivisions = 6);

/// The longest ordinate of D: |D| is at most that.
double GreatestDisplacement(const CubicElement& element);

/// The integral of the squared second derivatives |fxx|^2 + 2 |fxy|^2 + |fyy|^2 is the sum over
/// both components of v^T E v; v = value, x derivative and y derivative at corners 0, 1, 2.
using BendingMatrix = std::array<std::array<double, 9>, 9>;

BendingMatrix GetBendingMatrix(const std::array<Vector2, 3>& points);

/// Only the rows and columns of derivatives, in less time; the others are 0.
BendingMatrix GetBendingMatrixOfDerivatives(const std::array<Vector2, 3>& points);

} // namespace homeomorphism

#endif
