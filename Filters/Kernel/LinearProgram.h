// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file LinearProgram.h
/// Linear programs in a few variables, by Seidel's algorithm.

#ifndef homeomorphism_LinearProgram_h
#define homeomorphism_LinearProgram_h

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace homeomorphism
{

/// The half-space Normal . x <= Limit.
template <int Dimension>
struct HalfSpace
{
  std::array<double, Dimension> Normal;
  double Limit;
};

/// Maximizes objective . x over the half-spaces and the box |x_i| <= bounds_i. Expected time is
/// linear in the number of half-spaces if they come in random order (Seidel 1991,
/// "Small-dimensional linear programming and convex hulls made easy"). Returns false if there is no
/// such x. Computed in floating point: @a x satisfies the constraints up to rounding.
template <int Dimension>
bool MaximizeLinear(const std::array<double, Dimension>& objective,
  const std::vector<HalfSpace<Dimension>>& halfSpaces, const std::array<double, Dimension>& bounds,
  std::array<double, Dimension>& x)
{
  for (int i = 0; i < Dimension; ++i)
  {
    x[i] = objective[i] < 0.0 ? -bounds[i] : bounds[i];
  }
  for (std::size_t n = 0; n < halfSpaces.size(); ++n)
  {
    const std::array<double, Dimension>& normal = halfSpaces[n].Normal;
    double value = -halfSpaces[n].Limit;
    double magnitude = std::abs(halfSpaces[n].Limit);
    int pivot = 0;
    for (int i = 0; i < Dimension; ++i)
    {
      value += normal[i] * x[i];
      magnitude += std::abs(normal[i] * x[i]);
      pivot = std::abs(normal[i]) > std::abs(normal[pivot]) ? i : pivot;
    }
    if (value <= 1e-13 * magnitude)
    {
      continue;
    }
    if (normal[pivot] == 0.0)
    {
      return false;
    }
    // The optimum lies on this plane: x_pivot = constant + coefficients . (the others).
    const double constant = halfSpaces[n].Limit / normal[pivot];
    if constexpr (Dimension == 1)
    {
      x[0] = constant;
      for (std::size_t m = 0; m < n; ++m)
      {
        const double excess = halfSpaces[m].Normal[0] * x[0] - halfSpaces[m].Limit;
        if (excess > 1e-12 * (std::abs(halfSpaces[m].Limit) + std::abs(x[0])))
        {
          return false;
        }
      }
      if (std::abs(x[0]) > bounds[0])
      {
        return false;
      }
    }
    else
    {
      constexpr int less = Dimension - 1;
      std::array<double, less> coefficients;
      std::array<double, less> reduced;
      std::array<double, less> limits;
      for (int i = 0, r = 0; i < Dimension; ++i)
      {
        if (i != pivot)
        {
          coefficients[r] = -normal[i] / normal[pivot];
          reduced[r] = objective[i] + objective[pivot] * coefficients[r];
          limits[r] = bounds[i];
          ++r;
        }
      }
      std::vector<HalfSpace<less>> others;
      others.reserve(n + 2);
      for (std::size_t m = 0; m < n; ++m)
      {
        HalfSpace<less> other;
        const double share = halfSpaces[m].Normal[pivot];
        other.Limit = halfSpaces[m].Limit - share * constant;
        for (int i = 0, r = 0; i < Dimension; ++i)
        {
          if (i != pivot)
          {
            other.Normal[r] = halfSpaces[m].Normal[i] + share * coefficients[r];
            ++r;
          }
        }
        others.push_back(other);
      }
      HalfSpace<less> upper{ coefficients, bounds[pivot] - constant };
      HalfSpace<less> lower{ {}, bounds[pivot] + constant };
      for (int r = 0; r < less; ++r)
      {
        lower.Normal[r] = -coefficients[r];
      }
      others.push_back(upper);
      others.push_back(lower);
      std::array<double, less> rest;
      if (!MaximizeLinear<less>(reduced, others, limits, rest))
      {
        return false;
      }
      x[pivot] = constant;
      for (int i = 0, r = 0; i < Dimension; ++i)
      {
        if (i != pivot)
        {
          x[i] = rest[r];
          x[pivot] += coefficients[r] * rest[r];
          ++r;
        }
      }
    }
  }
  return true;
}

} // namespace homeomorphism

#endif
