// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ExactSign.h"

#include <algorithm>

namespace homeomorphism
{
namespace
{

/// Exact sum x + y: the rounded sum and its rounding error (Knuth).
struct TwoTerms
{
  double High;
  double Low;
};

TwoTerms Sum(double x, double y)
{
  const double sum = x + y;
  const double yShare = sum - x;
  const double xShare = sum - yShare;
  return { sum, (x - xShare) + (y - yShare) };
}

TwoTerms Product(double x, double y)
{
  const double product = x * y;
  return { product, std::fma(x, y, -product) };
}

/// An expansion: a number held exactly as a sum of nonoverlapping doubles, smallest first.
class Expansion
{
public:
  void Add(double value)
  {
    int kept = 0;
    for (int i = 0; i < this->Size; ++i)
    {
      const TwoTerms s = Sum(value, this->Terms[i]);
      value = s.High;
      if (s.Low != 0.0)
      {
        this->Terms[kept++] = s.Low;
      }
    }
    if (value != 0.0)
    {
      this->Terms[kept++] = value;
    }
    this->Size = kept;
  }

  void AddProduct(const TwoTerms& a, const TwoTerms& b, double sign)
  {
    for (const double x : { a.Low, a.High })
    {
      for (const double y : { b.Low, b.High })
      {
        const TwoTerms p = Product(sign * x, y);
        this->Add(p.Low);
        this->Add(p.High);
      }
    }
  }

  int Sign() const
  {
    if (this->Size == 0)
    {
      return 0;
    }
    return this->Terms[this->Size - 1] > 0.0 ? 1 : -1;
  }

private:
  // The largest predicate below adds six products of two terms by two, with 8 terms each.
  double Terms[48];
  int Size = 0;
};

/// Exact division by a power of two.
TwoTerms Scaled(const TwoTerms& x, double scale)
{
  return { x.High / scale, x.Low / scale };
}

/// The sign of (b - a).((b - a) + (c - a)).
int SignOfFoot(const double* a, const double* b, const double* c, int dimension)
{
  double value = 0.0;
  double magnitude = 0.0;
  for (int i = 0; i < dimension; ++i)
  {
    const double u = b[i] - a[i];
    const double v = c[i] - a[i];
    value += u * u + u * v;
    magnitude += u * u + std::abs(u * v);
  }
  // Two rounded differences, a product and at most five additions: each term has fewer than 10
  // relative errors of half an ulp.
  const double bound = 10.0 * std::numeric_limits<double>::epsilon() * magnitude;
  // Below this magnitude, products may be subnormal and the relative bound does not hold.
  if (magnitude > 1e-280)
  {
    if (value > bound)
    {
      return 1;
    }
    if (value < -bound)
    {
      return -1;
    }
  }
  double largest = 0.0;
  for (int i = 0; i < dimension; ++i)
  {
    largest = std::max({ largest, std::abs(b[i] - a[i]), std::abs(c[i] - a[i]) });
  }
  const double scale = PowerOfTwoNear(largest);
  Expansion sum;
  for (int i = 0; i < dimension; ++i)
  {
    const TwoTerms u = Scaled(Sum(b[i], -a[i]), scale);
    const TwoTerms v = Scaled(Sum(c[i], -a[i]), scale);
    sum.AddProduct(u, u, 1.0);
    sum.AddProduct(u, v, 1.0);
  }
  return sum.Sign();
}

} // namespace

int ExactOrientation(const Vector2& a, const Vector2& b, const Vector2& c)
{
  const double scaleA = PowerOfTwoNear(std::max(std::abs(a.x - c.x), std::abs(a.y - c.y)));
  const double scaleB = PowerOfTwoNear(std::max(std::abs(b.x - c.x), std::abs(b.y - c.y)));
  const TwoTerms ax = Scaled(Sum(a.x, -c.x), scaleA);
  const TwoTerms ay = Scaled(Sum(a.y, -c.y), scaleA);
  const TwoTerms bx = Scaled(Sum(b.x, -c.x), scaleB);
  const TwoTerms by = Scaled(Sum(b.y, -c.y), scaleB);
  Expansion determinant;
  determinant.AddProduct(ax, by, 1.0);
  determinant.AddProduct(ay, bx, -1.0);
  return determinant.Sign();
}

bool IsConcordant(const double* a, const double* b, const double* c, int dimension)
{
  return SignOfFoot(a, b, c, dimension) > 0 && SignOfFoot(b, a, c, dimension) > 0 &&
    SignOfFoot(b, c, a, dimension) > 0 && SignOfFoot(c, b, a, dimension) > 0 &&
    SignOfFoot(c, a, b, dimension) > 0 && SignOfFoot(a, c, b, dimension) > 0;
}

} // namespace homeomorphism
