// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file OneSidedDerivative.h
/// Estimates of one-sided derivatives of a function that can only be evaluated.

#ifndef homeomorphism_OneSidedDerivative_h
#define homeomorphism_OneSidedDerivative_h

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace homeomorphism
{

/// An estimate of a vector's components, and a bound on the length of its error: infinite if the
/// function could not be evaluated.
struct DerivativeEstimate
{
  std::array<double, 3> Value{};
  double Error = std::numeric_limits<double>::infinity();
};

/// Difference quotients of a function of one variable, f(t) for t >= 0, over halving steps h, and their
/// Richardson extrapolation to h = 0.
///
/// The error of the quotients is a power series in h if the function is smooth on its side. Where it is
/// so only near 0, as for a map made of pieces, the rows of small steps agree with each other; where the
/// steps are so small that rounding rules, rows disagree again. So the extrapolation is taken whose
/// neighbours in Neville's tableau agree with it best (Ridders 1982) and that no smaller step
/// contradicts; the disagreement, with what rounding can do to it, bounds its error.
class OneSidedDerivative
{
public:
  using Vector = std::array<double, 3>;
  static constexpr int NumberOfSteps = 18;

  /// Quotients of order 1, (f(h) - f(0)) / h, or 2, (f(2 h) - 2 f(h) + f(0)) / h^2.
  ///
  /// @a function takes a step to a Vector (NaN where it cannot be evaluated), @a largestStep is the
  /// largest argument used, @a rounding bounds the absolute error of each component.
  template <typename Function>
  OneSidedDerivative(Function&& function, int order, double largestStep, double rounding)
  {
    const Vector start = function(0.0);
    Vector far = function(largestStep);
    double step = order == 1 ? largestStep : 0.5 * largestStep;
    for (int i = 0; i < NumberOfSteps; ++i, step *= 0.5)
    {
      this->Steps[i] = step;
      const Vector near = function(order == 1 ? 0.5 * step : step);
      for (int axis = 0; axis < 3; ++axis)
      {
        this->Quotients[i][axis] = order == 1
          ? (far[axis] - start[axis]) / step
          : ((far[axis] - near[axis]) - (near[axis] - start[axis])) / step / step;
      }
      this->Rounding[i] = order == 1 ? 4.0 * rounding / step : 8.0 * rounding / step / step;
      far = near;
    }
  }

  double GetStep(int i) const { return this->Steps[i]; }
  const Vector& GetQuotient(int i) const { return this->Quotients[i]; }
  double GetRounding(int i) const { return this->Rounding[i]; }

  /// The limit of the quotients.
  DerivativeEstimate Extrapolate() const
  {
    const std::array<DerivativeEstimate, NumberOfSteps> rows = this->ExtrapolateRows();
    int first = 0;
    while (true)
    {
      const auto best = std::min_element(rows.begin() + first, rows.end(),
        [](const DerivativeEstimate& a, const DerivativeEstimate& b) { return a.Error < b.Error; });
      // Large steps may agree on the wrong limit, that of another piece of the map. Smaller ones, which
      // do not reach that piece, then contradict them.
      const bool contradicted =
        std::any_of(best, rows.end(), [best](const DerivativeEstimate& row) {
          return Distance(row.Value, best->Value) > row.Error + best->Error;
        });
      if (!contradicted)
      {
        // Neighbours in the tableau can agree by chance; the next best row hardly does as well.
        DerivativeEstimate result = *best;
        const auto next = best + 1 != rows.end() ? best + 1 : best - 1;
        result.Error = std::max(result.Error, 2.0 * Distance(result.Value, next->Value));
        return result;
      }
      first = static_cast<int>(best - rows.begin()) + 1;
    }
  }

private:
  /// The best extrapolation of each row of Neville's tableau: from step i and the larger ones.
  std::array<DerivativeEstimate, NumberOfSteps> ExtrapolateRows() const
  {
    struct Entry
    {
      Vector Value{};
      double Rounding = 0.0;
    };
    std::array<DerivativeEstimate, NumberOfSteps> best;
    std::array<Entry, NumberOfSteps> previous;
    for (int i = 0; i < NumberOfSteps; ++i)
    {
      std::array<Entry, NumberOfSteps> row;
      row[0] = { this->Quotients[i], this->Rounding[i] };
      double power = 1.0;
      for (int k = 1; k <= i; ++k)
      {
        power *= 2.0;
        const double weight = 1.0 / (power - 1.0);
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

  /// The sum of the components' differences: not less than the distance, nor twice as large, and far
  /// cheaper, there being hundreds.
  static double Distance(const Vector& a, const Vector& b)
  {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
  }

  std::array<double, NumberOfSteps> Steps;
  std::array<Vector, NumberOfSteps> Quotients;
  std::array<double, NumberOfSteps> Rounding;
};

} // namespace homeomorphism

#endif
