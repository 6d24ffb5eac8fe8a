// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file RootFinding.h
/// The roots of increasing functions, by Newton's method kept inside brackets, for several at once.

#ifndef homeomorphism_RootFinding_h
#define homeomorphism_RootFinding_h

#include "Kernel/Simd/Vectorize.h"

#include <cmath>
#include <limits>

namespace homeomorphism
{

/// @a Width equations, each for the root of an increasing function in an interval. Every evaluation
/// narrows the interval. Newton's step is taken where it stays inside; where it leads out, the
/// interval is halved. It ends with a step so small that what is left is below rounding, or when
/// nothing is left of the interval. A root that is found stays as it is while others are looked
/// for, so that none depends on the others.
///
/// With @a AtEnds, a step that leads out leads to the end first, if that was not tried yet: for
/// functions whose root is often there.
///
/// Nothing branches, so that the loop over the batch can become vector instructions.
template <int Width, bool AtEnds>
class RootBatch
{
public:
  double Root[Width];

  HOMEOMORPHISM_ALWAYS_INLINE void Start(int lane, double lower, double upper, double guess)
  {
    guess = guess < upper ? guess : upper;
    this->Root[lane] = guess > lower ? guess : lower;
    this->Lower[lane] = lower;
    this->Upper[lane] = upper;
    this->TriedLower[lane] = 0.0;
    this->TriedUpper[lane] = 0.0;
    this->LastStep[lane] = 0.0;
    this->Done[lane] = 0.0;
  }

  /// The function's value and slope at Root. The last step is at most @a enough times the root, or,
  /// with
  /// @a AtEnds, one that is so much smaller than the step before it that what is left, about the
  /// square of their ratio, is below rounding.
  HOMEOMORPHISM_ALWAYS_INLINE void Step(int lane, double value, double slope, double enough)
  {
    const double x = this->Root[lane];
    const double step = value / slope;
    const double size = std::abs(step);
    const double lower = value < 0.0 ? x : this->Lower[lane];
    const double upper = value > 0.0 ? x : this->Upper[lane];
    const double middle = 0.5 * (lower + upper);
    double below = middle;
    double above = middle;
    double done = size <= enough * x ? 1.0 : 0.0;
    if constexpr (AtEnds)
    {
      const double triedLower = value < 0.0 ? 1.0 : this->TriedLower[lane];
      const double triedUpper = value > 0.0 ? 1.0 : this->TriedUpper[lane];
      this->TriedLower[lane] = triedLower;
      this->TriedUpper[lane] = triedUpper;
      below = triedLower > 0.0 ? middle : lower;
      above = triedUpper > 0.0 ? middle : upper;
      const double last = this->LastStep[lane];
      done = size * size * size <= 0x1p-55 * x * (last * last) ? 1.0 : done;
      // Next to a change of sign; the lower end itself may be still to be tried.
      const double atLower = middle == lower ? triedUpper : 0.0;
      done = atLower > 0.0 ? 1.0 : done;
    }
    else
    {
      done = middle == lower ? 1.0 : done;
    }
    done = middle == upper ? 1.0 : done;
    done = value == 0.0 ? 1.0 : done;
    const double newton = x - step;
    double next = newton > lower ? newton : below;
    next = newton < upper ? next : above;
    if constexpr (AtEnds)
    {
      // A step that is not a number halves the interval, too.
      next = size <= std::numeric_limits<double>::max() ? next : middle;
      this->LastStep[lane] = next == newton ? size : 0.0;
    }
    next = size <= 0x1p-53 * x ? x : next;
    next = value == 0.0 ? x : next;
    this->Root[lane] = this->Done[lane] > 0.0 ? x : next;
    this->Done[lane] = this->Done[lane] > done ? this->Done[lane] : done;
    this->Lower[lane] = lower;
    this->Upper[lane] = upper;
  }

  /// Whether every root was found, or @a steps are more than halving alone would need, from 1 to
  /// the smallest root that matters, an ulp of 1 cubed.
  HOMEOMORPHISM_ALWAYS_INLINE bool IsDone(int steps) const
  {
    // Some of many nearly always need three steps, and to ask takes as long as one.
    if (Width > 1 && steps < 3)
    {
      return false;
    }
    double done = 1.0;
    for (int lane = 0; lane < Width; ++lane)
    {
      done = this->Done[lane] < done ? this->Done[lane] : done;
    }
    return done > 0.0 || steps > 250;
  }

private:
  double Lower[Width];
  double Upper[Width];
  double TriedLower[Width];
  double TriedUpper[Width];
  double LastStep[Width];
  double Done[Width];
};

/// Finds the roots of some equations, a RootBatch with functions Set and Evaluate, which get a lane
/// and what
/// @a numbers, arrays of a value for each lane, have there.
template <int Width, typename Equation, typename... Numbers>
HOMEOMORPHISM_ALWAYS_INLINE void SolveBatch(Equation& equation, const Numbers*... numbers)
{
  HOMEOMORPHISM_SIMD
  for (int lane = 0; lane < Width; ++lane)
  {
    equation.Set(lane, numbers[lane]...);
  }
  for (int step = 0; !equation.IsDone(step); ++step)
  {
    HOMEOMORPHISM_SIMD
    for (int lane = 0; lane < Width; ++lane)
    {
      equation.Evaluate(lane, numbers[lane]...);
    }
  }
}

} // namespace homeomorphism

#endif
