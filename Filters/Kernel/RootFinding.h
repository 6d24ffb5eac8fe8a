// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file RootFinding.h
/// The root of an increasing function, by Newton's method kept inside a bracket.

#ifndef RootFinding_h
#define RootFinding_h

#include <cmath>
#include <limits>

namespace homeomorphism
{

/// A function's value and slope at a point.
struct ValueAndSlope
{
  double Value;
  double Slope;
};

/// The root of an increasing function in [lower, upper]. @a function returns its ValueAndSlope.
/// Newton's step is taken where it stays inside the bracket, which every evaluation narrows, and the
/// bracket is halved where it does not: so this ends, at a number next to a change of sign or where
/// Newton's steps have sunk into rounding.
template <typename Function>
double RootOfIncreasing(Function&& function, double lower, double upper, double guess)
{
  constexpr double ulp = std::numeric_limits<double>::epsilon();
  // Newton needs a handful of steps; a bracket of doubles in [0, 1] is exhausted by halving well
  // before this many down to the smallest root that matters, one ulp of 1 cubed.
  constexpr int limit = 200;
  double x = guess < lower ? lower : (guess > upper ? upper : guess);
  double lastStep = upper - lower;
  for (int i = 0; i < limit; ++i)
  {
    const ValueAndSlope at = function(x);
    if (at.Value == 0.0)
    {
      return x;
    }
    const double newtonStep = std::abs(at.Value / at.Slope);
    const double size = ulp * std::abs(x);
    if (newtonStep <= 2.0 * size || (newtonStep <= 1024.0 * size && newtonStep >= 0.5 * lastStep))
    {
      return x;
    }
    (at.Value < 0.0 ? lower : upper) = x;
    double next = x - at.Value / at.Slope;
    if (!(next > lower && next < upper))
    {
      next = lower + 0.5 * (upper - lower);
    }
    if (next == lower || next == upper)
    {
      return next;
    }
    lastStep = std::abs(next - x);
    x = next;
  }
  return x;
}

} // namespace homeomorphism

#endif
