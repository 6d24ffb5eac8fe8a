// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ContourChart.h"

#include "RootFinding.h"

#include <algorithm>
#include <limits>

namespace homeomorphism
{
namespace
{

double Clamp01(double x)
{
  return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0;
}

/// sin(x) / x.
double SineRatio(double x)
{
  return x != 0.0 ? std::sin(x) / x : 1.0;
}

/// atan(z) / z.
double ArcTangentRatio(double z)
{
  return z != 0.0 ? std::atan(z) / z : 1.0;
}

/// Derivative of atan(z) / z, (1 / (1 + z^2) - atan(z) / z) / z, by its series where that cancels.
double ArcTangentRatioDerivative(double z)
{
  if (z > 0.25)
  {
    return (1.0 / (1.0 + z * z) - std::atan(z) / z) / z;
  }
  const double z2 = z * z;
  double sum = 0.0;
  for (int n = 14; n >= 1; --n)
  {
    sum = -z2 * sum + 2.0 * n / (2.0 * n + 1.0);
  }
  return -z * sum;
}

/// (sin x - x cos x) / x^2, by its series where that cancels.
double SineMinusCosineRatio(double x)
{
  if (x > 0.5)
  {
    return (std::sin(x) - x * std::cos(x)) / (x * x);
  }
  const double x2 = x * x;
  double sum = 0.0;
  for (int n = 9; n >= 1; --n)
  {
    // Each term is the one before times -x^2 / (2 n (2 n + 3)).
    sum = 1.0 - x2 / (2.0 * n * (2.0 * n + 3.0)) * sum;
  }
  return x / 3.0 * sum;
}

/// The number s of the contour that meets the edge at E(s) = b @a proportion.
double ContourEndingAt(double h, double b, double proportion)
{
  const double flatness = 2.0 * b / h;
  return RootOfIncreasing(
    [=](double s) -> ValueAndSlope {
      // E / b and its derivative, with R / (h (1 + s)) = sqrt(1 + tan^2 phi).
      const double slope = flatness * s / (1.0 + s);
      const double secant = std::sqrt(1.0 + slope * slope);
      const double share = (1.0 - s) / ((1.0 + s) * (1.0 + secant));
      const double secantDerivative = slope / secant * flatness / ((1.0 + s) * (1.0 + s));
      const double shareDerivative = -2.0 / ((1.0 + s) * (1.0 + s) * (1.0 + secant)) -
        share / (1.0 + secant) * secantDerivative;
      return { s * (1.0 + share) - proportion, 1.0 + share + s * shareDerivative };
    },
    // 0 <= share <= 1 / 2.
    proportion / 1.5, proportion, proportion / 1.25);
}

/// The number s of the contour whose arc passes through (x, y): the only root, in
/// [0, 1 - 2 y / h], of E(s) - y^2 / (r + sqrt(r^2 - y^2)) - x. This is the smallest root of the
/// publication's cubic; the cubic's larger root belongs to the other half of the circle.
double ContourThrough(double h, double b, double x, double y)
{
  return RootOfIncreasing(
    [=](double s) -> ValueAndSlope {
      const ArcOfHalf arc(h, b, s);
      const ArcOfHalfDerivative derivative(h, b, s, arc);
      const double sine = std::min(1.0, y * arc.Curvature);
      const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
      const double slope = derivative.EdgePoint -
        (y > 0.0 ? derivative.Curvature * y * y / (cosine * (1.0 + cosine)) : 0.0);
      return { arc.EdgePoint - (y > 0.0 ? y * sine / (1.0 + cosine) : 0.0) - x, slope };
    },
    0.0, std::max(0.0, 1.0 - 2.0 * y / h), x / b);
}

} // namespace

ArcOfHalf::ArcOfHalf(double h, double b, double s)
  : R(std::hypot(h * (1.0 + s), 2.0 * b * s))
  , Curvature(4.0 * b * s / (h * (1.0 - s) * R))
  , EdgePoint(b * s * (1.0 + h * (1.0 - s) / (R + h * (1.0 + s))))
{
}

ContourOfHalf::ContourOfHalf(double h, double b, double s)
  : ArcOfHalf(h, b, s)
  , Slope(2.0 * b * s / (h * (1.0 + s)))
  , ArcLength(0.5 * R * (1.0 - s) / (1.0 + s) * ArcTangentRatio(Slope))
  , Length(0.5 * R + ArcLength)
{
}

ArcOfHalfDerivative::ArcOfHalfDerivative(double h, double b, double s, const ArcOfHalf& arc)
  : R((h * (h / arc.R) * (1.0 + s)) + 4.0 * b * (b / arc.R) * s)
  , Curvature(4.0 * b / (h * (1.0 - s) * arc.R) * (1.0 / (1.0 - s) - s * R / arc.R))
{
  const double sum = arc.R + h * (1.0 + s);
  const double extra = h * (1.0 - s) / sum;
  this->EdgePoint = b * (1.0 + extra) - b * s * (h / sum + extra * (this->R + h) / sum);
}

ContourOfHalfDerivative::ContourOfHalfDerivative(
  double h, double b, double s, const ContourOfHalf& contour)
  : ArcOfHalfDerivative(h, b, s, contour)
{
  const double slopeDerivative = 2.0 * b / (h * (1.0 + s) * (1.0 + s));
  this->Angle = 2.0 * (b / contour.R) * (h / contour.R);
  this->Radius = h / (4.0 * b * s) * ((1.0 - s) * this->R - contour.R / s);

  const double ratio = ArcTangentRatio(contour.Slope);
  const double share = (1.0 - s) / (1.0 + s);
  const double shareDerivative = -2.0 / ((1.0 + s) * (1.0 + s));
  this->Length = 0.5 * this->R * (1.0 + share * ratio) +
    0.5 * contour.R *
      (shareDerivative * ratio +
        share * ArcTangentRatioDerivative(contour.Slope) * slopeDerivative);
}

ContourChart::ContourChart(
  const TriangleShape& shape, const EdgeViews& views, CenterPoint center)
  : Unit(PowerOfTwoNear(shape.Base))
  , Shape{ shape.Base / Unit, shape.ApexX / Unit, shape.Height / Unit, shape.Apex }
{
  if (center == CenterPoint::Centroid)
  {
    this->CenterWeights = { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 };
  }
  else
  {
    double perimeter = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      this->CenterWeights[k] = views[k].Length;
      perimeter += this->CenterWeights[k];
    }
    for (double& weight : this->CenterWeights)
    {
      weight /= perimeter;
    }
  }
  for (int k = 0; k < 3; ++k)
  {
    const EdgeView view{ views[k].Length / this->Unit, views[k].Foot,
      views[k].Height / this->Unit };
    Edge& edge = this->Edges[k];
    edge.Start = this->Shape.Corner(NextCorner(k));
    edge.Length = view.Length;
    // The tangent of an edge other than the base follows from how it sees the base's far end; the
    // difference of its own ends would be useless where it is short.
    if (k == shape.Apex)
    {
      edge.Tangent = { 1.0, 0.0 };
    }
    else if (k == NextCorner(shape.Apex))
    {
      edge.Tangent = { -view.Foot * view.Length / this->Shape.Base,
        view.Height / this->Shape.Base };
    }
    else
    {
      edge.Tangent = { (view.Foot - 1.0) * view.Length / this->Shape.Base,
        -view.Height / this->Shape.Base };
    }
    edge.CenterHeight = this->CenterWeights[k] * view.Height;
    // The foot of a weighted mean of the corners is the weighted mean of their feet: 0 and Length
    // for the edge's ends.
    edge.FootDistance = view.Length *
      (this->CenterWeights[PreviousCorner(k)] + this->CenterWeights[k] * view.Foot);
  }
}

ContourChart::Half ContourChart::HalfAt(const Edge& edge, double p) const
{
  const double fromFoot = p * edge.Length - edge.FootDistance;
  Half half;
  half.Side = fromFoot >= 0.0 ? 1.0 : -1.0;
  half.EdgePoint = std::abs(fromFoot);
  // Rounding may put the foot of a barely concordant triangle on a corner.
  const double least = std::numeric_limits<double>::epsilon() * edge.Length;
  half.Length =
    std::max(least, half.Side > 0.0 ? edge.Length - edge.FootDistance : edge.FootDistance);
  return half;
}

ContourChart::Reference ContourChart::ToReference(const Vector2& pointInFrame) const
{
  const Vector2 point = (1.0 / this->Unit) * pointInFrame;
  const Barycentric l = this->Shape.ToBarycentric(point);
  int k = 0;
  for (int other = 1; other < 3; ++other)
  {
    if (l[other] * this->CenterWeights[k] < l[k] * this->CenterWeights[other])
    {
      k = other;
    }
  }
  const Edge& edge = this->Edges[k];
  // On the boundary, and outside by rounding, the nearest point of the triangle counts.
  const bool inside = l[0] > 0.0 && l[1] > 0.0 && l[2] > 0.0;
  const Vector2 fromStart = (inside ? point : this->Shape.FromBarycentric(l)) - edge.Start;
  const double along = Dot(fromStart, edge.Tangent);
  const double y = std::max(0.0, Cross(edge.Tangent, fromStart));
  const Half half = this->HalfAt(edge, along / edge.Length);
  const double x = half.EdgePoint;
  const double h = edge.CenterHeight;
  const double b = half.Length;

  double s = 0.0;
  Reference coordinates;
  coordinates.Edge = k + 1;
  if (2.0 * y * b >= h * (b - x))
  {
    const double below = std::max(0.0, h - y);
    const double distance = std::hypot(x, below);
    if (distance == 0.0)
    {
      return Reference{};
    }
    const double denominator = 2.0 * b * below - x * h;
    s = denominator > 0.0 ? Clamp01(x * h / denominator) : 1.0;
    const ContourOfHalf contour(h, b, s);
    coordinates.ContourParameter = Clamp01(distance / contour.Length);
    coordinates.EdgeParameter =
      Clamp01((edge.FootDistance + half.Side * contour.EdgePoint) / edge.Length);
    return coordinates;
  }

  s = Clamp01(ContourThrough(h, b, x, y));
  const ContourOfHalf contour(h, b, s);
  // The arc that remains between the point and the edge, r psi, with sin psi = y / r. Near a right
  // angle the sine says little about the angle, so the cosine helps.
  double remaining = 0.0;
  if (y > 0.0 && s < 1.0)
  {
    const double sine = std::min(1.0, y * contour.Curvature);
    const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
    const double inset = y * sine / (1.0 + cosine);
    const double angle = std::atan2(sine, 1.0 - inset * contour.Curvature);
    remaining = sine > 0.0 ? y * angle / sine : y;
  }
  coordinates.ContourParameter = Clamp01(1.0 - remaining / contour.Length);
  coordinates.EdgeParameter =
    Clamp01((edge.FootDistance + half.Side * contour.EdgePoint) / edge.Length);
  return coordinates;
}

Vector2 ContourChart::ToPoint(const Reference& coordinates) const
{
  const Edge& edge = this->Edges[coordinates.Edge - 1];
  const Half half = this->HalfAt(edge, coordinates.EdgeParameter);
  const double h = edge.CenterHeight;
  const double s = ContourEndingAt(h, half.Length, Clamp01(half.EdgePoint / half.Length));
  const ContourOfHalf contour(h, half.Length, s);
  const double remaining = (1.0 - coordinates.ContourParameter) * contour.Length;
  double x = 0.0;
  double y = 0.0;
  if (remaining >= contour.ArcLength)
  {
    const double share = 2.0 * coordinates.ContourParameter * contour.Length / contour.R;
    x = share * half.Length * s;
    y = h - share * 0.5 * h * (1.0 + s);
  }
  else
  {
    const double angle = remaining * contour.Curvature;
    const double halfAngle = 0.5 * angle;
    x = contour.EdgePoint - remaining * SineRatio(halfAngle) * std::sin(halfAngle);
    y = remaining * SineRatio(angle);
  }
  const double along = edge.FootDistance + half.Side * x;
  return this->Unit *
    Vector2{ edge.Start.x + along * edge.Tangent.x - y * edge.Tangent.y,
      edge.Start.y + along * edge.Tangent.y + y * edge.Tangent.x };
}

/// The images of the two unit directions of the reference.
Matrix2 ContourChart::Columns(const Reference& coordinates) const
{
  const Edge& edge = this->Edges[coordinates.Edge - 1];
  const Half half = this->HalfAt(edge, coordinates.EdgeParameter);
  const double h = edge.CenterHeight;
  const double b = half.Length;
  const double c = coordinates.ContourParameter;
  const double s = ContourEndingAt(h, b, Clamp01(half.EdgePoint / b));
  const ContourOfHalf contour(h, b, s);
  const ContourOfHalfDerivative derivative(h, b, s, contour);
  const double remaining = (1.0 - c) * contour.Length;

  // In the half's frame: the derivative with respect to c, and that with respect to s over c.
  Vector2 byC;
  Vector2 bySOverC;
  if (remaining >= contour.ArcLength)
  {
    // X = G + c L T with the unit vector T = (sin phi, -cos phi).
    const double sine = 2.0 * b * s / contour.R;
    const double cosine = h * (1.0 + s) / contour.R;
    byC = { contour.Length * sine, -contour.Length * cosine };
    const double turn = contour.Length * derivative.Angle;
    bySOverC = { turn * cosine + derivative.Length * sine,
      turn * sine - derivative.Length * cosine };
  }
  else
  {
    // X = (E - r (1 - cos psi), r sin psi) with r psi = (1 - c) L.
    const double angle = remaining * contour.Curvature;
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    byC = { contour.Length * sine, -contour.Length * cosine };
    // d(1/r)/ds (r psi)^2, from whichever of 1/r and r is finite.
    const double bend = s < 0.5 ? derivative.Curvature * remaining * remaining
                                : -derivative.Radius * angle * angle;
    const double halfSine = SineRatio(0.5 * angle);
    const double stretch = (1.0 - c) * derivative.Length;
    const Vector2 byS = { derivative.EdgePoint + bend * (0.5 * halfSine * halfSine - SineRatio(angle)) -
        stretch * sine,
      stretch * cosine - bend * SineMinusCosineRatio(angle) };
    bySOverC = { byS.x / c, byS.y / c };
  }
  // p Length = foot + Side E(s).
  const double rate = half.Side * edge.Length / derivative.EdgePoint;
  const auto toTriangle = [&edge, &half](const Vector2& v) -> Vector2 {
    const double along = half.Side * v.x;
    return { along * edge.Tangent.x - v.y * edge.Tangent.y,
      along * edge.Tangent.y + v.y * edge.Tangent.x };
  };
  return { toTriangle(byC), rate * toTriangle(bySOverC) };
}

Vector2 ContourChart::Push(const Reference& coordinates, const Direction& direction) const
{
  const Matrix2 columns = this->Columns(coordinates);
  return this->Unit * (direction.x * columns.ImageOfX + direction.y * columns.ImageOfY);
}

ContourChart::Direction ContourChart::Pull(
  const Reference& coordinates, const Vector2& vectorInFrame) const
{
  const Vector2 vector = (1.0 / this->Unit) * vectorInFrame;
  const Matrix2 columns = this->Columns(coordinates);
  const double determinant = columns.Determinant();
  return { Cross(vector, columns.ImageOfY) / determinant,
    Cross(columns.ImageOfX, vector) / determinant };
}

double ContourChart::ContourLength(int edgeLabel, double p) const
{
  const Edge& edge = this->Edges[edgeLabel - 1];
  const Half half = this->HalfAt(edge, p);
  const double s =
    ContourEndingAt(edge.CenterHeight, half.Length, Clamp01(half.EdgePoint / half.Length));
  return this->Unit * ContourOfHalf(edge.CenterHeight, half.Length, s).Length;
}

double ContourChart::ContourLengthDerivative(int edgeLabel, double p) const
{
  const Edge& edge = this->Edges[edgeLabel - 1];
  const Half half = this->HalfAt(edge, p);
  const double s =
    ContourEndingAt(edge.CenterHeight, half.Length, Clamp01(half.EdgePoint / half.Length));
  const ContourOfHalf contour(edge.CenterHeight, half.Length, s);
  const ContourOfHalfDerivative derivative(edge.CenterHeight, half.Length, s, contour);
  return this->Unit * derivative.Length * half.Side * edge.Length / derivative.EdgePoint;
}

Vector2 ContourChart::Center() const
{
  return this->Unit * this->Shape.FromBarycentric(this->CenterWeights);
}

Vector2 ContourChart::Foot(int edgeLabel) const
{
  const Edge& edge = this->Edges[edgeLabel - 1];
  return this->Unit * (edge.Start + edge.FootDistance * edge.Tangent);
}

const TriangleShape& ContourChart::EquilateralShape()
{
  static const TriangleShape shape{ 1.0, 0.5, std::sqrt(0.75), 2 };
  return shape;
}

const ContourChart& ContourChart::Equilateral()
{
  static const ContourChart chart(EquilateralShape(),
    ViewsFromEdges(EquilateralShape().Corner(0), EquilateralShape().Corner(1),
      EquilateralShape().Corner(2)));
  return chart;
}

} // namespace homeomorphism
