// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/Triangles.h"

#include "Kernel/RootFinding.h"

#include <gtest/gtest.h>

using namespace homeomorphism;
using namespace homeomorphism_test;

namespace
{

/// scale * (x^power - root^power) on [0, 1]: increasing, with a slope that vanishes at 0.
template <int Width, bool AtEnds>
struct PowerEquation : RootBatch<Width, AtEnds>
{
  int Evaluations = 0;

  void Set(int index, double root, double guess, double)
  {
    (void)root;
    this->Start(index, 0.0, 1.0, guess);
  }

  void Evaluate(int index, double root, double, double power)
  {
    ++this->Evaluations;
    const double x = this->Root[index];
    const double value = std::pow(x, power) - std::pow(root, power);
    this->Step(index, value, value / (power * std::pow(x, power - 1.0)), 0x1p-26);
  }
};

template <bool AtEnds>
double Solve(double root, double guess, double power)
{
  PowerEquation<1, AtEnds> equation;
  SolveBatch<1>(equation, &root, &guess, &power);
  return equation.Root[0];
}

} // namespace

TEST(RootFinding, FindsTheRootFromAnyGuess)
{
  Random random(11);
  for (int i = 0; i < 10000; ++i)
  {
    const double root = random.Uniform(0.01, 1.0);
    const double guess = random.Uniform(-0.5, 1.5);
    const double power = random.Integer(1, 5);
    EXPECT_NEAR(Solve<false>(root, guess, power), root, 8.0 * Ulp * root) << root << " " << guess;
    EXPECT_NEAR(Solve<true>(root, guess, power), root, 8.0 * Ulp * root) << root << " " << guess;
  }
}

TEST(RootFinding, FindsRootsAtTheEnds)
{
  for (const double guess : { 0.0, 0.3, 1.0 })
  {
    for (const double power : { 1.0, 3.0 })
    {
      EXPECT_EQ(Solve<true>(1.0, guess, power), 1.0);
      EXPECT_NEAR(Solve<false>(1.0, guess, power), 1.0, 2.0 * Ulp);
      EXPECT_LE(Solve<true>(0.0, guess, power), 0x1p-50);
    }
  }
}

// The solution of an equation does not depend on the other equations of its batch, to the last bit.
TEST(RootFinding, EquationsOfABatchAreIndependent)
{
  constexpr int width = 8;
  Random random(12);
  for (int i = 0; i < 1000; ++i)
  {
    double roots[width];
    double guesses[width];
    double powers[width];
    std::generate_n(roots, width, [&random]() { return random.Uniform(); });
    std::generate_n(guesses, width, [&random]() { return random.Uniform(); });
    std::generate_n(powers, width, [&random]() { return random.Integer(1, 4); });
    PowerEquation<width, true> batch;
    SolveBatch<width>(batch, roots, guesses, powers);
    for (int index = 0; index < width; ++index)
    {
      EXPECT_EQ(batch.Root[index], Solve<true>(roots[index], guesses[index], powers[index]));
    }
  }
}

// NaN values or slopes do not prevent termination.
TEST(RootFinding, EndsWithoutARoot)
{
  struct NoRoot : RootBatch<1, true>
  {
    void Set(int index) { this->Start(index, 0.0, 1.0, 0.5); }
    void Evaluate(int index)
    {
      this->Step(index, fixtures::NotANumber, fixtures::NotANumber, 0x1p-26);
    }
  };
  NoRoot equation;
  SolveBatch<1>(equation);
  SUCCEED();
}
