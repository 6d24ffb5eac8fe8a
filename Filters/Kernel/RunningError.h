// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file RunningError.h
/// Numbers with a bound on their rounding error.

#ifndef homeomorphism_RunningError_h
#define homeomorphism_RunningError_h

#include <cmath>
#include <limits>

namespace homeomorphism
{

/// A double and a bound on its distance from the result of the same operations without rounding
/// (Wilkinson's running error analysis; Higham, "Accuracy and Stability of Numerical Algorithms",
/// 3.3). The bound itself is rounded: after n operations, it may be too small by a factor of
/// 1 - n 2^-52, for which LowerBound compensates if n <= 2^20.
struct RunningError
{
  double Value = 0.0;
  double Error = 0.0;

  RunningError() = default;
  // Numbers are exact. NOLINTNEXTLINE(google-explicit-constructor)
  RunningError(double exact)
    : Value(exact)
  {
  }
  RunningError(double value, double error)
    : Value(value)
    , Error(error)
  {
  }

  /// A lower bound of the exact value.
  double LowerBound() const { return this->Value - 1.000001 * this->Error; }

  static constexpr double Unit = 0x1p-53;
};

inline RunningError operator-(const RunningError& a)
{
  return { -a.Value, a.Error };
}

inline RunningError operator+(const RunningError& a, const RunningError& b)
{
  const double value = a.Value + b.Value;
  return { value, a.Error + b.Error + RunningError::Unit * std::abs(value) };
}

inline RunningError operator-(const RunningError& a, const RunningError& b)
{
  const double value = a.Value - b.Value;
  return { value, a.Error + b.Error + RunningError::Unit * std::abs(value) };
}

inline RunningError operator*(const RunningError& a, const RunningError& b)
{
  const double value = a.Value * b.Value;
  // The last term is for products that underflow: the value, and three products in its bound.
  return { value,
    a.Error * std::abs(b.Value) + (std::abs(a.Value) + a.Error) * b.Error +
      RunningError::Unit * std::abs(value) + 4.0 * std::numeric_limits<double>::denorm_min() };
}

inline RunningError operator/(const RunningError& a, const RunningError& b)
{
  const double value = a.Value / b.Value;
  const double least = std::abs(b.Value) - 1.000001 * b.Error;
  if (!(least > 0.0))
  {
    return { value, std::numeric_limits<double>::infinity() };
  }
  // Underflow in the numerator of the bound is divided, too.
  const double underflow =
    b.Error > 0.0 && std::abs(value) < 1.0 ? std::numeric_limits<double>::denorm_min() : 0.0;
  return { value,
    (a.Error + std::abs(value) * b.Error + underflow) / least +
      2.0 * RunningError::Unit * std::abs(value) +
      4.0 * std::numeric_limits<double>::denorm_min() };
}

} // namespace homeomorphism

#endif
