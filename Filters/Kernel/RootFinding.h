// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file RootFinding.h
/// The root of an increasing function, by Newton's method kept inside a bracket.

#ifndef homeomorphism_RootFinding_h
#define homeomorphism_RootFinding_h

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
/// Newton's step is taken where it stays inside the bracket, which every evaluation narrows. Where it
/// leads out, an end of the bracket is tried, once, and then the bracket is halved. So this ends: at a
/// number next to a change of sign, at an end, or where Newton's steps have sunk into rounding.
template <typename Function>
double RootOfIncreasing(Function&& function, double lower, double upper, double guess)
{
  constexpr double ulp = std::numeric_limits<double>::epsilon();
  // Newton needs a handful of steps. Halving alone, which only a function that is not increasing would
  // bring about, exhausts the doubles from 1 down to the smallest root that matters, an ulp of 1 cubed,
  // well before this many.
  constexpr int limit = 250;
  double x = guess < lower ? lower : (guess > upper ? upper : guess);
  bool triedLower = false;
  bool triedUpper = false;
  double lastNewtonStep = std::numeric_limits<double>::infinity();
  for (int i = 0; i < limit; ++i)
  {
    const ValueAndSlope at = function(x);
    const double newtonStep = std::abs(at.Value / at.Slope);
    const double size = ulp * std::abs(x);
    const bool stalled = newtonStep <= 1024.0 * size && newtonStep >= 0.5 * lastNewtonStep;
    // Beyond an end there is no root, whatever rounding says.
    const bool rootAtEnd = (at.Value < 0.0 && x == upper) || (at.Value > 0.0 && x == lower);
    if (at.Value == 0.0 || newtonStep <= 2.0 * size || stalled || rootAtEnd)
    {
      return x;
    }
    (at.Value < 0.0 ? lower : upper) = x;
    (at.Value < 0.0 ? triedLower : triedUpper) = true;
    double next = x - at.Value / at.Slope;
    lastNewtonStep = newtonStep;
    if (!(next > lower && next < upper))
    {
      lastNewtonStep = std::numeric_limits<double>::infinity();
      const double middle = lower + 0.5 * (upper - lower);
      if (next <= lower && !triedLower)
      {
        next = lower;
      }
      else if (next >= upper && !triedUpper)
      {
        next = upper;
      }
      else if (middle > lower && middle < upper)
      {
        next = middle;
      }
      else
      {
        return x;
      }
    }
    x = next;
  }
  return x;
}

} // namespace homeomorphism

#endif
