// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Random.h
/// Random numbers that are determined by the seed on every platform, unlike those of the
/// distributions of the standard library.

#ifndef fixtures_Random_h
#define fixtures_Random_h

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace fixtures
{

constexpr double Ulp = std::numeric_limits<double>::epsilon();
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

class Random
{
public:
  explicit Random(std::uint64_t seed)
    : Engine(seed)
  {
  }

  std::uint64_t Bits() { return this->Engine(); }
  /// Uniform in [0, 1).
  double Uniform() { return std::ldexp(static_cast<double>(this->Engine() >> 11), -53); }
  double Uniform(double lower, double upper) { return lower + (upper - lower) * this->Uniform(); }
  std::array<double, 3> Vector()
  {
    return { this->Uniform(-1.0, 1.0), this->Uniform(-1.0, 1.0), this->Uniform(-1.0, 1.0) };
  }
  /// 10 to a power that is uniform between the two arguments.
  double PowerOfTen(double lower, double upper)
  {
    return std::pow(10.0, this->Uniform(lower, upper));
  }
  /// 0 to @a count - 1.
  template <typename Count>
  Count Below(Count count)
  {
    return static_cast<Count>(this->Engine() % static_cast<std::uint64_t>(count));
  }
  int Integer(int least, int greatest) { return least + this->Below(greatest - least + 1); }
  bool Chance(double probability) { return this->Uniform() < probability; }
  /// In [0, 1], with the exponents of the distances to both ends uniformly distributed.
  double Proportion()
  {
    switch (this->Below(6))
    {
      case 0:
        return this->PowerOfTen(-18.0, 0.0);
      case 1:
        return 1.0 - this->PowerOfTen(-18.0, 0.0);
      case 2:
        return this->Below(2);
      default:
        return this->Uniform();
    }
  }

  /// Barycentric coordinates, uniform in a triangle, of at least @a margin.
  std::array<double, 3> Weights(double margin = 0.0)
  {
    double u = this->Uniform();
    double v = this->Uniform();
    if (u + v > 1.0)
    {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const double room = 1.0 - 3.0 * margin;
    return { margin + room * u, margin + room * v, margin + room * (1.0 - u - v) };
  }

  /// For std::shuffle.
  std::mt19937_64 Engine;
};

} // namespace fixtures

#endif
