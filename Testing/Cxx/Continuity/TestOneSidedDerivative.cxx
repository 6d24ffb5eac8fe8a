// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/Triangles.h"

#include "Continuity/OneSidedDerivative.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace homeomorphism;
using homeomorphism_test::Random;
using homeomorphism_test::Ulp;

namespace
{

using Vector = OneSidedDerivative::Vector;

double LengthOfError(const DerivativeEstimate& estimate, const Vector& exact)
{
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    sum += std::abs(estimate.Value[axis] - exact[axis]);
  }
  return sum;
}

} // namespace

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
    const Vector first{ a, b, b };
    const Vector second{ a * a, 0.0, 2.0 * a };
    const DerivativeEstimate one = OneSidedDerivative(function, 1, 0.1, 4.0 * Ulp).Extrapolate();
    EXPECT_LE(LengthOfError(one, first), one.Error);
    EXPECT_LT(one.Error, 1e-8);
    const DerivativeEstimate two = OneSidedDerivative(function, 2, 0.1, 4.0 * Ulp).Extrapolate();
    EXPECT_LE(LengthOfError(two, second), two.Error);
    EXPECT_LT(two.Error, 1e-3);
  }
}

// A piece of another slope that begins close to 0 does not affect the derivative at 0.
TEST(OneSidedDerivative, DetectsPiecesThatBeginNearby)
{
  for (const double border : { 0.05, 1e-2, 1e-3, 1e-4 })
  {
    const auto function = [border](double t) -> Vector {
      return { t < border ? 3.0 * t : 3.0 * border + (t - border), 0.0, 0.0 };
    };
    const DerivativeEstimate estimate =
      OneSidedDerivative(function, 1, 0.1, 4.0 * Ulp).Extrapolate();
    EXPECT_LE(std::abs(estimate.Value[0] - 3.0), estimate.Error) << border;
    EXPECT_LT(estimate.Error, 0.1) << border;
  }
}

TEST(OneSidedDerivative, IsUndefinedWhereTheFunctionIs)
{
  const auto function = [](double) -> Vector {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return { nan, nan, nan };
  };
  const DerivativeEstimate estimate = OneSidedDerivative(function, 1, 0.1, Ulp).Extrapolate();
  EXPECT_TRUE(std::isinf(estimate.Error));
  EXPECT_TRUE(std::isnan(estimate.Value[0]));
}

// Values stored as floats are known to float precision only, whatever rounding the caller claims.
TEST(OneSidedDerivative, DetectsStoredPrecision)
{
  const auto function = [](double t) -> Vector {
    return { static_cast<double>(static_cast<float>(1.0 + 0.7 * t)), 0.0, 0.0 };
  };
  const DerivativeEstimate estimate = OneSidedDerivative(function, 1, 0.1, 4.0 * Ulp).Extrapolate();
  EXPECT_LE(std::abs(estimate.Value[0] - 0.7), estimate.Error);
}
