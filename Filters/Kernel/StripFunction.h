// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file StripFunction.h
/// The function B_k of the Smooth coordinate system, see SmoothChart.h.

#ifndef homeomorphism_StripFunction_h
#define homeomorphism_StripFunction_h

#include "Kernel/Simd/Vectorize.h"

#include <algorithm>
#include <type_traits>

namespace homeomorphism
{

/// B_k, its derivatives and the determinant of the chart at a point of the strip of edge k. The
/// arguments are the coordinates of the point for k, the next corner and the previous one. Outside
/// the strip B_k is continued by l_k beyond the edge and by 0 elsewhere. Constants are exact in
/// single precision, so that the formulas are of the type Real.
template <typename Real>
struct StripFunction
{
  static constexpr Real Tiny = std::is_same_v<Real, float> ? 1e-30f : Real(1e-290);

  Real K;
  Real ShareNext;
  Real SharePrevious;
  Real Tau;
  Real U;
  /// 1 / (l_i + l_j) and 1 / (tau q).
  Real OverSum;
  Real OverWidth;

  HOMEOMORPHISM_ALWAYS_INLINE StripFunction(Real k, Real next, Real previous, Real tau)
    : K(k)
    , Tau(tau)
  {
    // A single division gives 1 / sum and k / (tau q) = k sum / product.
    const Real sum = next + previous;
    // The product underflows only so close to a corner that the value does not matter.
    Real product = tau * (next * previous);
    product += Tiny;
    const Real over = 1.0f / (sum * product);
    this->OverSum = product * over;
    this->ShareNext = next * this->OverSum;
    this->SharePrevious = previous * this->OverSum;
    this->OverWidth = sum * sum * over;
    // The first product is computed in parallel with the division.
    Real u = k * (sum * sum) * over;
    // At a corner u is NaN, and there is no strip.
    u = std::max(Real(0.0f), std::min(Real(1.0f), u));
    this->U = std::min(previous, next) > 0.0f ? u : 1.0f;
  }

  /// W(u) = (1 - u)^3 (1 + 3 u).
  HOMEOMORPHISM_ALWAYS_INLINE Real W() const
  {
    const Real rest = 1.0f - this->U;
    return rest * rest * (rest * (1.0f + 3.0f * this->U));
  }

  /// B = l_k W(u).
  HOMEOMORPHISM_ALWAYS_INLINE Real Value() const { return this->K * this->W(); }

  /// 1 - K'(u) with K' = (1 - u)^2 (1 - 3 u) (1 + 5 u), which is dB/dl_k.
  HOMEOMORPHISM_ALWAYS_INLINE Real OneMinusSlope() const
  {
    return this->U * this->U * (18.0f - this->U * (32.0f - 15.0f * this->U));
  }

  /// The part of the other two corners: dB/dl_i = 12 tau u^3 (1 - u)^2 (l_j / (l_i + l_j))^2, and
  /// with i, j exchanged.
  HOMEOMORPHISM_ALWAYS_INLINE Real AlongSides(Real next, Real previous) const
  {
    const Real rest = 1.0f - this->U;
    return 12.0f * this->Tau * this->U * this->U * this->U * rest * rest *
      (this->SharePrevious * this->SharePrevious * next +
        this->ShareNext * this->ShareNext * previous);
  }

  /// 1 + d_k K' + AlongSides(d), without the cancellation of a small kappa = 1 + d_k.
  HOMEOMORPHISM_ALWAYS_INLINE Real DeterminantRatio(
    Real kappa, Real offsetNext, Real offsetPrevious) const
  {
    const Real rest = this->OneMinusSlope();
    return kappa * (1.0f - rest) + rest + this->AlongSides(offsetNext, offsetPrevious);
  }

  /// Half the second derivative of beta - B(affine - d beta) with respect to beta, -d^T B'' d. With
  /// K'' = -12 u (1 - u) (3 - 5 u), q' = (l_j / (l_i + l_j))^2 d_i + (l_i / (l_i + l_j))^2 d_j and
  /// q'' = -2 (d_i l_j - d_j l_i)^2 / (l_i + l_j)^3, B'' is 12 tau u^3 (1 - u)^2 q'' + K'' / (tau
  /// q) (d_k - u tau q')^2.
  HOMEOMORPHISM_ALWAYS_INLINE Real HalfCurvature(
    Real kappa, Real offsetNext, Real offsetPrevious) const
  {
    const Real rest = 1.0f - this->U;
    const Real turn = offsetNext * this->SharePrevious - offsetPrevious * this->ShareNext;
    const Real slope = this->SharePrevious * this->SharePrevious * offsetNext +
      this->ShareNext * this->ShareNext * offsetPrevious;
    const Real approach = (kappa - 1.0f) - this->U * (this->Tau * slope);
    const Real u2 = this->U * this->U;
    return 12.0f * u2 * this->U * (rest * rest) * this->Tau * (turn * turn) * this->OverSum +
      6.0f * this->U * rest * (3.0f - 5.0f * this->U) * this->OverWidth * (approach * approach);
  }

  /// beta - B for a point with the affine coordinate affineK = l_k + d_k beta, without
  /// cancellation: beta (1 + d_k W) - affineK W.
  HOMEOMORPHISM_ALWAYS_INLINE Real Residual(Real beta, Real affineK, Real kappa) const
  {
    const Real w = this->W();
    const Real oneMinusW = this->U * this->U * (6.0f - this->U * (8.0f - 3.0f * this->U));
    return beta * (kappa * w + oneMinusW) - affineK * w;
  }
};

} // namespace homeomorphism

#endif
