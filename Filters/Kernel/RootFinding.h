// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file RootFinding.h
/// Bracketed iteration for the roots of batches of increasing functions, with steps of Newton's or
/// Halley's method.

#ifndef homeomorphism_RootFinding_h
#define homeomorphism_RootFinding_h

#include "Kernel/Simd/Vectorize.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace homeomorphism
{

/// The step of Halley's method towards the root of an increasing function, to be subtracted. Its
/// denominator is limited to between half and twice Newton's.
template <typename Real>
HOMEOMORPHISM_ALWAYS_INLINE Real HalleyStep(Real value, Real slope, Real halfCurvature)
{
  const Real square = slope * slope;
  const Real denominator = square - value * halfCurvature;
  // By references, limits take one instruction each; conditional expressions are slower.
  return value * slope / std::min(2.0f * square, std::max(0.5f * square, denominator));
}

/// Solves @a Width equations, each for the root of an increasing function in an interval. Every
/// evaluation narrows the bracket. A step that leaves the bracket is replaced by bisection. The
/// iteration ends when the step is below rounding or the bracket is empty. A root that has
/// converged no longer changes, so the result of an equation does not depend on the other
/// equations.
///
/// With @a AtEnds, a step that leaves the bracket is first replaced by a step to the end of the
/// bracket, unless that end has already been evaluated. Use this for functions whose root often
/// lies at an end.
///
/// Branch-free, so that the loop over the batch vectorizes.
template <int Width, bool AtEnds>
class RootBatch
{
public:
  double Root[Width];

  HOMEOMORPHISM_ALWAYS_INLINE void Start(int index, double lower, double upper, double guess)
  {
    this->Root[index] = std::max(lower, std::min(upper, guess));
    this->Lower[index] = lower;
    this->Upper[index] = upper;
    this->TriedLower[index] = 0.0;
    this->TriedUpper[index] = 0.0;
    this->LastStep[index] = 0.0;
    this->Done[index] = 0;
  }

  /// Subtracts a step without using the bracket. The result is taken as the root if @a found is not
  /// 0, the step is at most @a enough times the result, and the result is in the interval.
  HOMEOMORPHISM_ALWAYS_INLINE void StepFreely(
    int index, double step, double enough, double found = 1.0)
  {
    const double x = this->Root[index] - step;
    double done = std::abs(step) <= enough * x ? found : 0.0;
    done = x <= this->Upper[index] ? done : 0.0;
    this->Root[index] = x;
    this->Done[index] = done > 0.0 ? 1 : 0;
  }

  /// 1 if the root is found, else 0.
  HOMEOMORPHISM_ALWAYS_INLINE double IsFound(int index) const
  {
    return this->Done[index] != 0 ? 1.0 : 0.0;
  }

  /// Subtracts a step of Newton's or Halley's method; @a value is the function at Root. The
  /// iteration ends with a step of at most @a enough times the root. With @a AtEnds, it also ends
  /// when the ratio to the previous step shows that the remaining error is below rounding (relative
  /// to the step, the error is about the square of that ratio).
  HOMEOMORPHISM_ALWAYS_INLINE void Step(int index, double value, double step, double enough)
  {
    const double x = this->Root[index];
    const double size = std::abs(step);
    const double lower = value < 0.0 ? x : this->Lower[index];
    const double upper = value > 0.0 ? x : this->Upper[index];
    const double middle = 0.5 * (lower + upper);
    double below = middle;
    double above = middle;
    double done = size <= enough * x ? 1.0 : 0.0;
    if constexpr (AtEnds)
    {
      const double triedLower = value < 0.0 ? 1.0 : this->TriedLower[index];
      const double triedUpper = value > 0.0 ? 1.0 : this->TriedUpper[index];
      this->TriedLower[index] = triedLower;
      this->TriedUpper[index] = triedUpper;
      below = triedLower > 0.0 ? middle : lower;
      above = triedUpper > 0.0 ? middle : upper;
      const double last = this->LastStep[index];
      done = size * size * size <= 0x1p-55 * x * (last * last) ? 1.0 : done;
      // The root lies within one ulp of the lower end. Evaluate that end too, if it has not been
      // evaluated.
      const double atLower = middle == lower ? triedUpper : 0.0;
      done = atLower > 0.0 ? 1.0 : done;
    }
    else
    {
      // A last step out of the bracket is one to its end, up to rounding.
      below = done > 0.0 ? lower : middle;
      above = done > 0.0 ? upper : middle;
      done = middle == lower ? 1.0 : done;
    }
    done = middle == upper ? 1.0 : done;
    done = value == 0.0 ? 1.0 : done;
    const double newton = x - step;
    double next = newton > lower ? newton : below;
    next = newton < upper ? next : above;
    if constexpr (AtEnds)
    {
      // An infinite or NaN step is replaced by bisection.
      next = size <= std::numeric_limits<double>::max() ? next : middle;
      this->LastStep[index] = next == newton ? size : 0.0;
    }
    next = size <= 0x1p-53 * x ? x : next;
    next = value == 0.0 ? x : next;
    this->Root[index] = this->Done[index] != 0 ? x : next;
    this->Done[index] = done > 0.0 ? 1 : this->Done[index];
    this->Lower[index] = lower;
    this->Upper[index] = upper;
  }

  /// Whether all roots have converged. The limit of @a steps exceeds the number of bisections from
  /// 1 to the smallest relevant root, the cube of an ulp of 1.
  HOMEOMORPHISM_ALWAYS_INLINE bool IsDone(int steps) const
  {
    // The flags are integers, so that the loop vectorizes.
    std::int64_t done = 1;
    for (int index = 0; index < Width; ++index)
    {
      done &= this->Done[index];
    }
    return done != 0 || steps > 250;
  }

private:
  double Lower[Width];
  double Upper[Width];
  double TriedLower[Width];
  double TriedUpper[Width];
  double LastStep[Width];
  std::int64_t Done[Width];
};

/// Whether an equation has the functions Approach and Finish.
template <typename Equation, typename = void>
struct HasApproach : std::false_type
{
};
template <typename Equation>
struct HasApproach<Equation, std::void_t<decltype(&Equation::Approach)>> : std::true_type
{
};

/// Finds the roots of the equations of a batch. @a Equation is a RootBatch with functions Set and
/// Evaluate, which take an index and the elements of @a numbers (arrays with one value per
/// equation) for that index. An equation may also have functions Approach and Finish, which each
/// take a step without a bracket. They are called once for each index. Where the root has not been
/// found then, bracketed steps follow.
template <int Width, typename Equation, typename... Numbers>
HOMEOMORPHISM_ALWAYS_INLINE void SolveBatch(Equation& equation, const Numbers*... numbers)
{
  HOMEOMORPHISM_SIMD
  for (int index = 0; index < Width; ++index)
  {
    equation.Set(index, numbers[index]...);
  }
  if constexpr (HasApproach<Equation>::value)
  {
    HOMEOMORPHISM_SIMD
    for (int index = 0; index < Width; ++index)
    {
      equation.Approach(index, numbers[index]...);
    }
    HOMEOMORPHISM_SIMD
    for (int index = 0; index < Width; ++index)
    {
      equation.Finish(index, numbers[index]...);
    }
  }
  for (int step = 0; !equation.IsDone(step); ++step)
  {
    HOMEOMORPHISM_SIMD
    for (int index = 0; index < Width; ++index)
    {
      equation.Evaluate(index, numbers[index]...);
    }
  }
}

} // namespace homeomorphism

#endif
