// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/Random.h"

#include "Continuity/OneSidedDerivative.h"

#include <gtest/gtest.h>

using namespace fixtures;
using homeomorphism::DerivativeEstimate;
using homeomorphism::OneSidedDerivative;
using Vector = OneSidedDerivative::Vector;

// Both derivatives of smooth functions are found within the bound of the error, and the bound is
// small.
TEST(OneSidedDerivative, BoundsItsError)
{
  Random random(31);
  for (int i = 0; i < 2000; ++i)
  {
    const double a = random.Uniform(-2.0, 2.0);
    const double b = random.Uniform(-2.0, 2.0);
    const auto function = [a, b](double t) -> Vector {
      return { std::exp(a * t), std::sin(b * t), a * t * t + b * t };
    };
    const Vector exact[] = { { a, b, b }, { a * a, 0.0, 2.0 * a } };
    const double bounds[] = { 1e-8, 1e-3 };
    for (const int order : { 1, 2 })
    {
      const auto found = OneSidedDerivative(function, order, 0.1, 4.0 * Ulp).Extrapolate();
      double error = 0.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        error += std::abs(found.Value[axis] - exact[order - 1][axis]);
      }
      EXPECT_LE(error, found.Error);
      EXPECT_LT(found.Error, bounds[order - 1]);
    }
  }
}

// A piece of another slope that begins close to 0 does not affect the derivative at 0. Values
// stored as floats are known to float precision only, whatever rounding the caller claims.
TEST(OneSidedDerivative, DetectsPiecesThatBeginNearbyAndStoredPrecision)
{
  for (const double border : { 0.05, 1e-2, 1e-3, 1e-4, 0.0 })
  {
    const auto function = [border](double t) -> Vector {
      const double piece = t < border ? 3.0 * t : 3.0 * border + (t - border);
      const auto rounded = static_cast<double>(static_cast<float>(1.0 + 3.0 * t));
      return { border > 0.0 ? piece : rounded, 0.0, 0.0 };
    };
    const auto found = OneSidedDerivative(function, 1, 0.1, 4.0 * Ulp).Extrapolate();
    EXPECT_LE(std::abs(found.Value[0] - 3.0), found.Error) << border;
    EXPECT_LT(found.Error, 0.1) << border;
  }
}

TEST(OneSidedDerivative, IsUndefinedWhereTheFunctionIs)
{
  const auto function = [](double) -> Vector { return { NotANumber, NotANumber, NotANumber }; };
  const DerivativeEstimate found = OneSidedDerivative(function, 1, 0.1, Ulp).Extrapolate();
  EXPECT_TRUE(std::isinf(found.Error));
  EXPECT_TRUE(std::isnan(found.Value[0]));
}
