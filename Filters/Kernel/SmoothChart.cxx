// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "SmoothChart.h"

#include "ContourChart.h"
#include "RootFinding.h"

#include <algorithm>

namespace homeomorphism
{
namespace
{

/// Whether l is in the strip of edge k: 0 <= l_k / (tau q) < 1 with q = l_i l_j / (l_i + l_j).
bool IsInStrip(const Barycentric& l, int k, double tau)
{
  const double i = l[NextCorner(k)];
  const double j = l[PreviousCorner(k)];
  return l[k] * (i + j) < tau * i * j;
}

Barycentric Moved(const Barycentric& l, const Barycentric& direction, double factor)
{
  return { l[0] + factor * direction[0], l[1] + factor * direction[1],
    l[2] + factor * direction[2] };
}

} // namespace

/// B_k, its derivatives, and the chart's determinant, at a point of the strip of edge k.
class SmoothChart::StripFunction
{
public:
  StripFunction(const Barycentric& l, int k, const Strip& strip)
    : Corner(k)
    , Owner(strip)
    , LK(l[k])
  {
    const double i = l[NextCorner(k)];
    const double j = l[PreviousCorner(k)];
    this->ShareI = i / (i + j);
    this->ShareJ = j / (i + j);
    this->U = this->LK / (strip.Tau * i * this->ShareJ);
  }

  /// B = l_k W(u).
  double Value() const { return this->LK * this->W(); }

  /// The derivative of B along a direction whose components sum to 0.
  double Along(const Barycentric& direction) const
  {
    return (1.0 - this->OneMinusSlope()) * direction[this->Corner] + this->AlongSides(direction);
  }

  /// 1 + d_k K' + AlongSides(d), without the cancellation that a small kappa = 1 + d_k brings.
  double DeterminantRatio() const
  {
    const double rest = this->OneMinusSlope();
    return this->Owner.Kappa * (1.0 - rest) + rest + this->AlongSides(this->Owner.Offset);
  }

  /// beta - B for a point whose affine coordinate is affineK = l_k + d_k beta, without cancellation:
  /// beta (1 + d_k W) - affineK W.
  double Residual(double beta, double affineK) const
  {
    const double w = this->W();
    const double oneMinusW = this->U * this->U * (6.0 - this->U * (8.0 - 3.0 * this->U));
    return beta * (this->Owner.Kappa * w + oneMinusW) - affineK * w;
  }

private:
  /// W(u) = (1 - u)^3 (1 + 3 u).
  double W() const
  {
    const double rest = 1.0 - this->U;
    return rest * rest * rest * (1.0 + 3.0 * this->U);
  }

  /// 1 - K'(u) with K' = (1 - u)^2 (1 - 3 u) (1 + 5 u), which is dB/dl_k.
  double OneMinusSlope() const
  {
    return this->U * this->U * (18.0 - this->U * (32.0 - 15.0 * this->U));
  }

  /// The share of the other two corners: dB/dl_i = 12 tau u^3 (1 - u)^2 (l_j / (l_i + l_j))^2, and
  /// i, j exchanged.
  double AlongSides(const Barycentric& direction) const
  {
    const double rest = 1.0 - this->U;
    return 12.0 * this->Owner.Tau * this->U * this->U * this->U * rest * rest *
      (this->ShareJ * this->ShareJ * direction[NextCorner(this->Corner)] +
        this->ShareI * this->ShareI * direction[PreviousCorner(this->Corner)]);
  }

  int Corner;
  const Strip& Owner;
  double LK;
  double ShareI;
  double ShareJ;
  double U;
};

SmoothChart::SmoothChart(const TriangleShape& shape, const EdgeViews& views,
  const std::array<Neighbor, 3>& neighbors)
  : Shape(shape)
{
  for (int k = 0; k < 3; ++k)
  {
    if (!neighbors[k].Exists)
    {
      continue;
    }
    const EdgeView& own = views[k];
    const EdgeView& other = neighbors[k].View;
    const double sum = own.Height + other.Height;
    const double ownShare = own.Height / sum;
    const double otherShare = other.Height / sum;
    Strip& strip = this->Strips[k];
    Barycentric& d = strip.Offset;
    d[k] = (other.Height - own.Height) / sum;
    d[NextCorner(k)] = ownShare * other.Foot - otherShare * (1.0 - own.Foot);
    d[PreviousCorner(k)] = ownShare * (1.0 - other.Foot) - otherShare * own.Foot;
    strip.Kappa = 2.0 * otherShare;
    const double least = std::min(d[NextCorner(k)], d[PreviousCorner(k)]);
    strip.Tau = least < -0.5 ? -0.5 / least : 1.0;
  }
}

int SmoothChart::StripAt(const Barycentric& l) const
{
  for (int k = 0; k < 3; ++k)
  {
    if (IsInStrip(l, k, this->Strips[k].Tau))
    {
      return k;
    }
  }
  return -1;
}

SmoothChart::Reference SmoothChart::ToReference(const Vector2& point) const
{
  // The chart maps each strip onto itself, so the affine coordinates tell which it is.
  const Barycentric affine = this->Shape.ToBarycentric(point);
  const int k = this->StripAt(affine);
  if (k < 0)
  {
    return affine;
  }
  // affine = l + d B(l), so with beta = B(l): beta = B(affine - d beta). The difference of the sides
  // increases, because its slope is the determinant ratio.
  const Strip& strip = this->Strips[k];
  const double guess = StripFunction(affine, k, strip).Value();
  // B <= tau q max(u W) <= (1 / 4) (16 / 81).
  constexpr double bound = 0.05;
  const double beta = RootOfIncreasing(
    [&strip, &affine, k](double value) -> ValueAndSlope {
      const Barycentric l = Moved(affine, strip.Offset, -value);
      // Past the strip's ends the chord leaves the triangle (B is continued by l_k) or enters the
      // affine part (B = 0).
      if (l[k] <= 0.0)
      {
        return { strip.Kappa * value - affine[k], strip.Kappa };
      }
      if (!(l[NextCorner(k)] > 0.0 && l[PreviousCorner(k)] > 0.0) || !IsInStrip(l, k, strip.Tau))
      {
        return { value, 1.0 };
      }
      const StripFunction function(l, k, strip);
      return { function.Residual(value, affine[k]), function.DeterminantRatio() };
    },
    0.0, bound, guess);
  return Moved(affine, strip.Offset, -beta);
}

Vector2 SmoothChart::ToPoint(const Reference& l) const
{
  const int k = this->StripAt(l);
  if (k < 0)
  {
    return this->Shape.FromBarycentric(l);
  }
  const Strip& strip = this->Strips[k];
  return this->Shape.FromBarycentric(
    Moved(l, strip.Offset, StripFunction(l, k, strip).Value()));
}

Vector2 SmoothChart::Push(const Reference& l, const Direction& direction) const
{
  const int k = this->StripAt(l);
  if (k < 0)
  {
    return this->Shape.FromBarycentric(direction);
  }
  const Strip& strip = this->Strips[k];
  return this->Shape.FromBarycentric(
    Moved(direction, strip.Offset, StripFunction(l, k, strip).Along(direction)));
}

SmoothChart::Direction SmoothChart::Pull(const Reference& l, const Vector2& vector) const
{
  const Barycentric direction = this->Shape.VectorToBarycentric(vector);
  const int k = this->StripAt(l);
  if (k < 0)
  {
    return direction;
  }
  // The chart's derivative is the identity plus a matrix of rank one (Sherman and Morrison).
  const Strip& strip = this->Strips[k];
  const StripFunction function(l, k, strip);
  return Moved(direction, strip.Offset,
    -function.Along(direction) / function.DeterminantRatio());
}

TriangularCoordinates SmoothChart::ToCoordinates(const Reference& l) const
{
  return ContourChart::Equilateral().ToReference(
    ContourChart::EquilateralShape().FromBarycentric(l));
}

SmoothChart::Reference SmoothChart::FromCoordinates(const TriangularCoordinates& coordinates) const
{
  return ContourChart::EquilateralShape().ToBarycentric(
    ContourChart::Equilateral().ToPoint(coordinates));
}

double SmoothChart::DeterminantRatio(const Reference& l) const
{
  const int k = this->StripAt(l);
  if (k < 0)
  {
    return 1.0;
  }
  const Strip& strip = this->Strips[k];
  return StripFunction(l, k, strip).DeterminantRatio();
}

double SmoothChart::DeterminantBound() const
{
  double bound = 1.0;
  for (int k = 0; k < 3; ++k)
  {
    if (this->Strips[k].Tau > 0.0)
    {
      bound = std::min({ bound, this->Strips[k].Kappa, 0.28 });
    }
  }
  return bound;
}

} // namespace homeomorphism
