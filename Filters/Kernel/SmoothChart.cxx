// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "SmoothChart.h"

#include "ContourChart.h"
#include "Kernel/Simd/Vectorize.h"
#include "RootFinding.h"

#include <algorithm>
#include <cmath>

namespace homeomorphism
{
namespace
{

/// B <= tau q max(u W) <= tau (1 / 4) (16 / 81), at u = 1 / 3.
constexpr double GreatestStripFunction = 4.0 / 81.0;

/// The equations of strips. From affine = l + d B(l) and beta = B(l) follows beta = B(affine - d
/// beta). The difference of both sides increases with beta, because its slope is the determinant
/// ratio. In most triangles, three steps of Halley's method from 0 solve the equation. The first
/// step is computed in single precision, and the third uses the curvature of the second. Bracketed
/// steps follow only if the second or the third step is too long.
template <int Width>
struct StripEquation : RootBatch<Width, false>
{
  /// The error after a whole step is at most about 8 times its cube, in units of the root, so this
  /// is a fraction of the rounding error of a barycentric coordinate.
  static constexpr double Enough = 0x1p-18;
  /// The largest lengths of two consecutive steps with one curvature that are accepted: the error
  /// is about the length of the first times the square of the second.
  static constexpr double EnoughBefore = 0x1p-5;
  static constexpr double EnoughAfter = 0x1p-24;

  HOMEOMORPHISM_ALWAYS_INLINE void Set(int index, double k, double next, double previous,
    double kappa, double offsetNext, double offsetPrevious, double tau)
  {
    constexpr double bound = 0.05;
    static_assert(bound > GreatestStripFunction, "the bracket contains the root");
    const auto f = [](double x) { return static_cast<float>(x); };
    const StripFunction<float> function(f(k), f(next), f(previous), f(tau));
    const float step = HalleyStep(-function.Value(),
      function.DeterminantRatio(f(kappa), f(offsetNext), f(offsetPrevious)),
      function.HalfCurvature(f(kappa), f(offsetNext), f(offsetPrevious)));
    this->Start(index, 0.0, bound, -step);
  }

  HOMEOMORPHISM_ALWAYS_INLINE void Approach(int index, double k, double next, double previous,
    double kappa, double offsetNext, double offsetPrevious, double tau)
  {
    const Linearized at(
      this->Root[index], k, next, previous, kappa, offsetNext, offsetPrevious, tau);
    this->HalfCurvature[index] = at.Function.HalfCurvature(kappa, offsetNext, offsetPrevious);
    this->StepFreely(
      index, HalleyStep(at.Value, at.Slope, this->HalfCurvature[index]), EnoughBefore);
  }

  HOMEOMORPHISM_ALWAYS_INLINE void Finish(int index, double k, double next, double previous,
    double kappa, double offsetNext, double offsetPrevious, double tau)
  {
    const Linearized at(
      this->Root[index], k, next, previous, kappa, offsetNext, offsetPrevious, tau);
    this->StepFreely(index, HalleyStep(at.Value, at.Slope, this->HalfCurvature[index]), EnoughAfter,
      this->IsFound(index));
  }

  HOMEOMORPHISM_ALWAYS_INLINE void Evaluate(int index, double k, double next, double previous,
    double kappa, double offsetNext, double offsetPrevious, double tau)
  {
    const Linearized at(
      this->Root[index], k, next, previous, kappa, offsetNext, offsetPrevious, tau);
    const double curvature = at.Function.HalfCurvature(kappa, offsetNext, offsetPrevious);
    this->Step(index, at.Value, HalleyStep(at.Value, at.Slope, curvature), Enough);
  }

private:
  /// The equation's value and slope at beta.
  struct Linearized
  {
    StripFunction<double> Function;
    double Value;
    double Slope;

    HOMEOMORPHISM_ALWAYS_INLINE Linearized(double beta, double k, double next, double previous,
      double kappa, double offsetNext, double offsetPrevious, double tau)
      : Function(
          k - (kappa - 1.0) * beta, next - offsetNext * beta, previous - offsetPrevious * beta, tau)
      , Value(this->Function.Residual(beta, k, kappa))
      , Slope(this->Function.DeterminantRatio(kappa, offsetNext, offsetPrevious))
    {
    }
  };

  double HalfCurvature[Width];
};

/// The chart maps each strip onto itself, so the affine coordinates determine whether the point
/// with the least coordinate for k is in the strip opposite k.
HOMEOMORPHISM_ALWAYS_INLINE CornerCoordinates ToReferenceOf(
  const CornerCoordinates& affine, const SmoothStrip& strip)
{
  if (!strip.Contains(affine))
  {
    return affine;
  }
  StripEquation<1> equation;
  SolveBatch<1>(equation, &affine.Own, &affine.Next, &affine.Previous, &strip.Kappa,
    &strip.OffsetNext, &strip.OffsetPrevious, &strip.Tau);
  return strip.Move(affine, -equation.Root[0]);
}

HOMEOMORPHISM_ALWAYS_INLINE CornerCoordinates FromReferenceOf(
  const CornerCoordinates& l, const SmoothStrip& strip)
{
  return strip.Contains(l) ? strip.Move(l, strip.GetFunction(l).Value()) : l;
}

} // namespace

void LimitDeviation(
  SmoothStrip& source, SmoothStrip& target, int edge, const TriangleShape& shape, double greatest)
{
  const auto length = [&shape, edge](double own, double next, double previous) {
    const Vector2 offset = shape.FromBarycentric(InOrder(edge, own, next, previous));
    return std::hypot(offset.x, offset.y);
  };
  const double strays =
    source.Tau * length(source.Kappa - 1.0, source.OffsetNext, source.OffsetPrevious) +
    target.Tau * length(target.Kappa - 1.0, target.OffsetNext, target.OffsetPrevious);
  if (GreatestStripFunction * strays <= greatest)
  {
    return;
  }
  const double difference = length(target.Kappa - source.Kappa,
    target.OffsetNext - source.OffsetNext, target.OffsetPrevious - source.OffsetPrevious);
  const double width =
    std::min({ source.Tau, target.Tau, greatest / (GreatestStripFunction * difference) });
  source.Tau = width;
  target.Tau = width;
}

SmoothStrips MakeSmoothStrips(const EdgeViews& views, const std::array<Neighbor, 3>& neighbors)
{
  SmoothStrips strips;
  for (int k = 0; k < 3; ++k)
  {
    if (neighbors[k].Exists)
    {
      strips[k] = SmoothStrip(views[k], neighbors[k].View);
    }
  }
  return strips;
}

namespace
{

/// For few points, this reads less of the strips than the vectorized loops do.
void SetSmoothPoint(SmoothBatch& batch, int i, const double* const coordinates[3],
  const SmoothStripsView& source, const SmoothStripsView& target)
{
  const double l[3] = { coordinates[0][i], coordinates[1][i], coordinates[2][i] };
  const int corner = LeastCorner(l[0], l[1], l[2]);
  batch.Corner[i] = corner;
  batch.L[0][i] = l[corner];
  batch.L[1][i] = l[NextCorner(corner)];
  batch.L[2][i] = l[PreviousCorner(corner)];
  const SmoothStripsView* domains[2] = { &source, &target };
  for (int domain = 0; domain < 2; ++domain)
  {
    const SmoothStrip& strip = (*domains[domain])[corner];
    batch.OffsetNext[domain][i] = strip.OffsetNext;
    batch.OffsetPrevious[domain][i] = strip.OffsetPrevious;
    batch.Kappa[domain][i] = strip.Kappa;
    batch.Tau[domain][i] = strip.Tau;
  }
}

} // namespace

HOMEOMORPHISM_FOR_WIDE_VECTORS
void SetSmoothBatch(SmoothBatch& batch, int begin, int end, const double* const coordinates[3],
  const SmoothStripsView& source, const SmoothStripsView& target)
{
  if (end - begin < LeastVector)
  {
    for (int i = begin; i < end; ++i)
    {
      SetSmoothPoint(batch, i, coordinates, source, target);
    }
    return;
  }
  const int stop = begin + InWholeVectors(end - begin);
  const double* first = coordinates[0];
  const double* second = coordinates[1];
  const double* third = coordinates[2];
  HOMEOMORPHISM_SIMD
  for (int i = begin; i < stop; ++i)
  {
    const double a = first[i];
    const double b = second[i];
    const double c = third[i];
    const double lesser = b < a ? b : a;
    const std::int64_t corner = c < lesser ? 2 : (b < a ? 1 : 0);
    batch.Corner[i] = corner;
    batch.L[0][i] = c < lesser ? c : lesser;
    batch.L[1][i] = corner == 0 ? b : (corner == 1 ? c : a);
    batch.L[2][i] = corner == 0 ? c : (corner == 1 ? a : b);
  }
  const SmoothStripsView* domains[2] = { &source, &target };
  for (int domain = 0; domain < 2; ++domain)
  {
    const SmoothStrip s0 = (*domains[domain])[0];
    const SmoothStrip s1 = (*domains[domain])[1];
    const SmoothStrip s2 = (*domains[domain])[2];
    HOMEOMORPHISM_SIMD
    for (int i = begin; i < stop; ++i)
    {
      const bool is0 = batch.Corner[i] == 0;
      const bool is1 = batch.Corner[i] == 1;
      batch.OffsetNext[domain][i] = is0 ? s0.OffsetNext : (is1 ? s1.OffsetNext : s2.OffsetNext);
      batch.OffsetPrevious[domain][i] =
        is0 ? s0.OffsetPrevious : (is1 ? s1.OffsetPrevious : s2.OffsetPrevious);
      batch.Kappa[domain][i] = is0 ? s0.Kappa : (is1 ? s1.Kappa : s2.Kappa);
      batch.Tau[domain][i] = is0 ? s0.Tau : (is1 ? s1.Tau : s2.Tau);
    }
  }
}

void FillSmoothBatch(SmoothBatch& batch, int begin, int end)
{
  for (int i = begin; i < end; ++i)
  {
    batch.Corner[i] = 0;
    for (double* l : batch.L)
    {
      l[i] = 1.0 / 3.0;
    }
    for (int domain = 0; domain < 2; ++domain)
    {
      batch.OffsetNext[domain][i] = 0.0;
      batch.OffsetPrevious[domain][i] = 0.0;
      batch.Kappa[domain][i] = 1.0;
      batch.Tau[domain][i] = 0.0;
    }
  }
}

HOMEOMORPHISM_FOR_WIDE_VECTORS
void MapSmoothBatch(SmoothBatch& batch, int count, double (*references)[SmoothBatch::Size])
{
  constexpr int width = 32;
  static_assert(SmoothBatch::Capacity % width == 0, "whole groups of batch");
  const int end = (count + width - 1) / width * width;
  FillSmoothBatch(batch, count, std::max(end, count + WidestVector));
  for (int first = 0; first < end; first += width)
  {
    double* k = batch.L[0] + first;
    double* next = batch.L[1] + first;
    double* previous = batch.L[2] + first;
    {
      const double* offsetNext = batch.OffsetNext[0] + first;
      const double* offsetPrevious = batch.OffsetPrevious[0] + first;
      const double* kappa = batch.Kappa[0] + first;
      const double* tau = batch.Tau[0] + first;
      StripEquation<width> equation;
      SolveBatch<width>(equation, k, next, previous, kappa, offsetNext, offsetPrevious, tau);
      HOMEOMORPHISM_SIMD
      for (int i = 0; i < width; ++i)
      {
        k[i] -= (kappa[i] - 1.0) * equation.Root[i];
        next[i] -= offsetNext[i] * equation.Root[i];
        previous[i] -= offsetPrevious[i] * equation.Root[i];
      }
    }
    if (references)
    {
      std::copy_n(k, width, references[0] + first);
      std::copy_n(next, width, references[1] + first);
      std::copy_n(previous, width, references[2] + first);
    }
    const double* offsetNext = batch.OffsetNext[1] + first;
    const double* offsetPrevious = batch.OffsetPrevious[1] + first;
    const double* kappa = batch.Kappa[1] + first;
    const double* tau = batch.Tau[1] + first;
    HOMEOMORPHISM_SIMD
    for (int i = 0; i < width; ++i)
    {
      const double beta = StripFunction<double>(k[i], next[i], previous[i], tau[i]).Value();
      k[i] += (kappa[i] - 1.0) * beta;
      next[i] += offsetNext[i] * beta;
      previous[i] += offsetPrevious[i] * beta;
    }
  }
}

SmoothChart::Reference SmoothChart::ToReference(const Vector2& point) const
{
  const Barycentric affine = this->Shape.ToBarycentric(point);
  const int k = LeastCorner(affine[0], affine[1], affine[2]);
  return ToReferenceOf(CornerCoordinates::From(affine, k), this->Strips[k]).InOrderFrom(k);
}

SmoothPoint MapSmoothPoint(int corner, const CornerCoordinates& l, const SmoothStripsView& source,
  const SmoothStripsView& target)
{
  const int least = LeastCorner(l.Own, l.Next, l.Previous);
  SmoothPoint point;
  point.Corner = CornerAfter(corner, least);
  point.Reference = ToReferenceOf(l.Turned(least), source[point.Corner]);
  point.Image = FromReferenceOf(point.Reference, target[point.Corner]);
  return point;
}

Vector2 SmoothChart::ToPoint(const Reference& l) const
{
  const int k = LeastCorner(l[0], l[1], l[2]);
  return this->Shape.FromBarycentric(
    FromReferenceOf(CornerCoordinates::From(l, k), this->Strips[k]).InOrderFrom(k));
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

double SmoothChart::DeterminantBound() const
{
  double bound = 1.0;
  for (const SmoothStrip& strip : this->Strips)
  {
    if (strip.Tau > 0.0)
    {
      bound = std::min({ bound, strip.Kappa, 0.28 });
    }
  }
  return bound;
}

} // namespace homeomorphism
