// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file OneSidedDerivative.h
/// Estimates of one-sided derivatives of a function from its values.

#ifndef homeomorphism_OneSidedDerivative_h
#define homeomorphism_OneSidedDerivative_h

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace homeomorphism
{

/// An estimate of the components of a vector, and a bound on the norm of its error, infinite if the
/// function could not be evaluated.
struct DerivativeEstimate
{
  std::array<double, 3> Value{};
  double Error = std::numeric_limits<double>::infinity();
};

/// Difference quotients of a function of one variable, f(t) for t >= 0, for decreasing steps h,
/// and their Richardson extrapolation to h = 0.
///
/// The first steps are halved, because extrapolation gains most there. Then they decrease faster,
/// down to a size at which only a large change exceeds rounding. The small steps detect a border
/// between two pieces of the function close to 0. Their ratios are not powers of 2, because the
/// quotients of a self-similar function could otherwise all be the same.
///
/// If the function is smooth on its side, the error of the quotients is a power series in h. If
/// it is smooth only near 0, as for a piecewise map, the rows of small steps agree with each
/// other; where the steps are so small that rounding dominates, rows disagree again. The estimate
/// is the extrapolation that agrees best with its neighbors in Neville's tableau (Ridders 1982)
/// and that is consistent with all smaller steps. Its error bound is computed from the disagreement
/// with its neighbors and from the effect of rounding.
class OneSidedDerivative
{
public:
  using Vector = std::array<double, 3>;
  static constexpr int MaximumSteps = 22;
  /// The number of halved steps. They suffice for the magnitude of a derivative.
  static constexpr int HalvedSteps = 11;

  /// Quotients of order 1, (f(h) - f(0)) / h, or of order 2, (f(2 h) - 2 f(h) + f(0)) / h^2.
  ///
  /// @a function maps a step to a Vector (NaN where it cannot be evaluated), @a largestStep is the
  /// largest argument used, and @a rounding bounds the absolute error of each component.
  template <typename Function>
  OneSidedDerivative(
    Function&& function, int order, double largestStep, double rounding, int steps = MaximumSteps)
    : NumberOfSteps(steps)
  {
    const Vector start = function(0.0);
    const Vector end = function(largestStep);
    const double slope = Distance(start, end) / largestStep;
    // A function that is constant where it should change has values with fewer digits than a
    // double; increase the rounding accordingly.
    double quantum = 0.0;
    Vector last = start;
    for (int i = 0; i < this->NumberOfSteps; ++i)
    {
      const double step = largestStep * StepRatio(i) / order;
      this->Steps[i] = step;
      const Vector near = order == 1 && i == 0 ? end : function(step);
      if (near == start)
      {
        quantum = std::max(quantum, slope * step);
      }
      if (order == 1)
      {
        this->Quotients[i] = Quotient(start, near, step);
        continue;
      }
      // Twice the step is the previous step while steps are halved.
      const Vector far =
        i == 0 ? end : (2.0 * step == this->Steps[i - 1] ? last : function(2.0 * step));
      this->Quotients[i] = Quotient(Quotient(start, near, step), Quotient(near, far, step), step);
      last = near;
    }
    const double error = std::max(rounding, 2.0 * quantum);
    for (int i = 0; i < this->NumberOfSteps; ++i)
    {
      const double step = this->Steps[i];
      this->Rounding[i] = order == 1 ? 2.0 * error / step : 4.0 * error / step / step;
    }
  }

  int GetNumberOfSteps() const { return this->NumberOfSteps; }
  double GetStep(int i) const { return this->Steps[i]; }
  const Vector& GetQuotient(int i) const { return this->Quotients[i]; }
  double GetRounding(int i) const { return this->Rounding[i]; }

  /// The limit of the quotients.
  DerivativeEstimate Extrapolate() const
  {
    const std::array<DerivativeEstimate, MaximumSteps> allRows = this->ExtrapolateRows();
    const auto begin = allRows.begin();
    const auto end = begin + this->NumberOfSteps;
    int first = 0;
    while (true)
    {
      const auto best = std::min_element(begin + first, end,
        [](const DerivativeEstimate& a, const DerivativeEstimate& b) { return a.Error < b.Error; });
      // Large steps may agree on a wrong limit, that of another piece of the map. Smaller steps,
      // which do not reach that piece, contradict them: the distance of their quotients from that
      // limit exceeds rounding and linear convergence.
      const int row = static_cast<int>(best - begin);
      const double approach = 4.0 * Distance(this->Quotients[row], best->Value) / this->Steps[row];
      bool contradicted = false;
      for (int i = row + 1; i < this->NumberOfSteps && !contradicted; ++i)
      {
        contradicted = Distance(this->Quotients[i], best->Value) >
          8.0 * this->Rounding[i] + best->Error + approach * this->Steps[i];
      }
      if (!contradicted)
      {
        // Neighbors in the tableau can agree by chance; the second-best row hardly does as well.
        DerivativeEstimate result = *best;
        if (!std::isfinite(result.Error))
        {
          result.Value.fill(std::numeric_limits<double>::quiet_NaN());
          return result;
        }
        const auto next = best + 1 != end ? best + 1 : best - 1;
        result.Error = std::max(result.Error, 2.0 * Distance(result.Value, next->Value));
        return result;
      }
      first = static_cast<int>(best - begin) + 1;
    }
  }

private:
  static double StepRatio(int i)
  {
    if (i < HalvedSteps)
    {
      return std::ldexp(1.0, -i);
    }
    // The steps decrease to 2^-10 / 4000 in six steps, then to 2^-10 / 8e8 in five.
    constexpr std::array<double, MaximumSteps - HalvedSteps> rest{ 0.27, 0.07, 0.019, 5e-3, 1.3e-3,
      2.5e-4, 4e-5, 3e-6, 2e-7, 1.7e-8, 1.25e-9 };
    return std::ldexp(rest[i - HalvedSteps], 1 - HalvedSteps);
  }

  /// (b - a) / step.
  static Vector Quotient(const Vector& a, const Vector& b, double step)
  {
    return { (b[0] - a[0]) / step, (b[1] - a[1]) / step, (b[2] - a[2]) / step };
  }

  /// The best extrapolation of each row of Neville's tableau, from step i and the larger ones.
  std::array<DerivativeEstimate, MaximumSteps> ExtrapolateRows() const
  {
    struct Entry
    {
      Vector Value{};
      double Rounding = 0.0;
    };
    std::array<DerivativeEstimate, MaximumSteps> best;
    std::array<Entry, MaximumSteps> previous;
    for (int i = 0; i < this->NumberOfSteps; ++i)
    {
      std::array<Entry, MaximumSteps> row;
      row[0] = { this->Quotients[i], this->Rounding[i] };
      for (int k = 1; k <= i; ++k)
      {
        const double weight = 1.0 / (this->Steps[i - k] / this->Steps[i] - 1.0);
        for (int axis = 0; axis < 3; ++axis)
        {
          row[k].Value[axis] = row[k - 1].Value[axis] +
            weight * (row[k - 1].Value[axis] - previous[k - 1].Value[axis]);
        }
        row[k].Rounding =
          row[k - 1].Rounding + weight * (row[k - 1].Rounding + previous[k - 1].Rounding);
        const double error = row[k].Rounding +
          4.0 *
            std::max(Distance(row[k].Value, row[k - 1].Value),
              Distance(row[k].Value, previous[k - 1].Value));
        if (error < best[i].Error)
        {
          best[i] = { row[k].Value, error };
        }
      }
      previous = row;
    }
    return best;
  }

  /// The sum of the absolute differences of the components: between the distance and twice the
  /// distance, and far cheaper, since it is evaluated hundreds of times.
  static double Distance(const Vector& a, const Vector& b)
  {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
  }

  int NumberOfSteps;
  std::array<double, MaximumSteps> Steps;
  std::array<Vector, MaximumSteps> Quotients;
  std::array<double, MaximumSteps> Rounding;
};

} // namespace homeomorphism

#endif
