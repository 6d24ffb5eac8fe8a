// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "LandmarkResiduals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

namespace homeomorphism
{
namespace
{

constexpr std::size_t Neighbors = 18;
/// Monomials of a polynomial of degree two in two variables.
constexpr int Monomials = 6;
/// The variance of residuals away from the border, for independent errors of variance 1, is between
/// 1.3 and this.
constexpr double UsualVariance = 1.5;

/// Landmarks with their squared distances.
using Distances = std::vector<std::pair<double, int>>;

/// Points in square cells, to find the nearest ones.
class Cells
{
public:
  explicit Cells(const std::vector<Vector2>& points)
    : Points(points)
  {
    Vector2 high = points[0];
    this->Low = points[0];
    for (const Vector2& p : points)
    {
      this->Low = { std::min(this->Low.x, p.x), std::min(this->Low.y, p.y) };
      high = { std::max(high.x, p.x), std::max(high.y, p.y) };
    }
    const double width = high.x - this->Low.x;
    const double height = high.y - this->Low.y;
    // About four points per cell, and at most about n / 4 rows and columns.
    const double n = static_cast<double>(points.size());
    this->Size = std::max({ std::sqrt(4.0 * width * height / n), 4.0 * width / n, 4.0 * height / n,
      std::numeric_limits<double>::min() });
    this->Columns = static_cast<int>(width / this->Size) + 1;
    this->Rows = static_cast<int>(height / this->Size) + 1;
    this->Starts.assign(static_cast<std::size_t>(this->Columns) * this->Rows + 1, 0);
    for (const Vector2& p : points)
    {
      ++this->Starts[this->CellOf(p) + 1];
    }
    for (std::size_t i = 1; i < this->Starts.size(); ++i)
    {
      this->Starts[i] += this->Starts[i - 1];
    }
    std::vector<int> at(this->Starts.begin(), this->Starts.end() - 1);
    this->Members.resize(points.size());
    for (int i = 0; i < static_cast<int>(points.size()); ++i)
    {
      this->Members[at[this->CellOf(points[i])]++] = i;
    }
  }

  /// The nearest other points, nearest first; of equally near ones the lower number.
  void Nearest(int point, std::size_t count, Distances& found) const
  {
    found.clear();
    const Vector2 p = this->Points[point];
    const int cell = static_cast<int>(this->CellOf(p));
    const int column = cell % this->Columns;
    const int row = cell / this->Columns;
    for (int ring = 0; ring <= std::max(this->Columns, this->Rows); ++ring)
    {
      for (int r = std::max(row - ring, 0); r <= std::min(row + ring, this->Rows - 1); ++r)
      {
        const bool whole = std::abs(r - row) == ring;
        for (int c = column - ring; c <= column + ring; c += whole || ring == 0 ? 1 : 2 * ring)
        {
          if (c < 0 || c >= this->Columns)
          {
            continue;
          }
          const std::size_t at = static_cast<std::size_t>(r) * this->Columns + c;
          for (int i = this->Starts[at]; i < this->Starts[at + 1]; ++i)
          {
            const Vector2 d = this->Points[this->Members[i]] - p;
            if (this->Members[i] != point)
            {
              found.emplace_back(Dot(d, d), this->Members[i]);
            }
          }
        }
      }
      // Points outside the rings so far are farther away than ring * Size.
      if (found.size() >= count)
      {
        std::nth_element(found.begin(), found.begin() + (count - 1), found.end());
        if (found[count - 1].first <= ring * this->Size * ring * this->Size)
        {
          break;
        }
      }
    }
    std::sort(found.begin(), found.end());
    found.resize(std::min(found.size(), count));
  }

private:
  std::size_t CellOf(const Vector2& p) const
  {
    const int column = static_cast<int>((p.x - this->Low.x) / this->Size);
    const int row = static_cast<int>((p.y - this->Low.y) / this->Size);
    return static_cast<std::size_t>(std::min(row, this->Rows - 1)) * this->Columns +
      std::min(column, this->Columns - 1);
  }

  const std::vector<Vector2>& Points;
  Vector2 Low;
  double Size;
  int Columns;
  int Rows;
  std::vector<int> Starts;
  std::vector<int> Members;
};

/// A neighbor in a fit: its position in the target and its monomials, the affine ones first.
struct Neighbor
{
  std::array<double, Monomials> Values;
  Vector2 To;
  double Near;
  double Weight;
  double Error;
};

/// The weighted least-squares polynomial with the first @a terms monomials. Neighbor i changes the
/// constant term by Weight * (Values . influence) times its position.
void Fit(const std::array<Neighbor, Neighbors>& neighbors, std::size_t count, int terms,
  std::array<Vector2, Monomials>& coefficients, std::array<double, Monomials>& influence)
{
  // The upper triangle of the symmetric matrix of the normal equations.
  double a[Monomials][Monomials] = {};
  coefficients = {};
  influence = { 1.0 };
  for (std::size_t i = 0; i < count; ++i)
  {
    const Neighbor& n = neighbors[i];
    for (int r = 0; r < terms; ++r)
    {
      const double weighted = n.Weight * n.Values[r];
      for (int c = r; c < terms; ++c)
      {
        a[r][c] += weighted * n.Values[c];
      }
      coefficients[r] = coefficients[r] + weighted * n.To;
    }
  }
  // A slight regularization makes the solution unique if the neighbors are collinear.
  for (int r = 1; r < terms; ++r)
  {
    a[r][r] += (r < 3 ? 1e-12 : 1e-9) * a[0][0];
  }
  // The matrix is positive definite, so elimination needs no pivoting.
  for (int k = 0; k < terms; ++k)
  {
    for (int r = k + 1; r < terms; ++r)
    {
      const double factor = a[k][r] / a[k][k];
      for (int c = r; c < terms; ++c)
      {
        a[r][c] -= factor * a[k][c];
      }
      coefficients[r] = coefficients[r] - factor * coefficients[k];
      influence[r] -= factor * influence[k];
    }
  }
  for (int k = terms; k-- > 0;)
  {
    for (int c = k + 1; c < terms; ++c)
    {
      coefficients[k] = coefficients[k] - a[k][c] * coefficients[c];
      influence[k] -= a[k][c] * influence[c];
    }
    coefficients[k] = (1.0 / a[k][k]) * coefficients[k];
    influence[k] /= a[k][k];
  }
}

/// The residuals of landmarks under a map through the trusted ones, which are not rejected.
class Residuals
{
public:
  explicit Residuals(const std::array<std::vector<Vector2>, 2>& landmarks)
    : Landmarks(landmarks)
    , Near(landmarks[0])
    , Terms(landmarks[0].size() < 15 ? 3 : 6)
  {
  }

  /// The nearest trusted landmarks, nearest first.
  void Nearest(int landmark, std::size_t count, Distances& nearest) const
  {
    this->Near.Nearest(landmark, count + this->Rejected.size(), nearest);
    nearest.erase(std::remove_if(nearest.begin(), nearest.end(),
                    [this](const std::pair<double, int>& p) {
                      return std::count(this->Rejected.begin(), this->Rejected.end(), p.second);
                    }),
      nearest.end());
    nearest.resize(std::min(nearest.size(), count));
  }

  /// The trusted landmarks whose residual depends on a landmark.
  std::vector<int> DependingOn(int landmark) const
  {
    std::vector<int> result;
    Distances others;
    Distances nearest;
    this->Nearest(landmark, 4 * Neighbors, others);
    for (const auto& [square, other] : others)
    {
      this->Nearest(other, Neighbors, nearest);
      if (std::any_of(nearest.begin(), nearest.end(),
            [landmark](const std::pair<double, int>& p) { return p.second == landmark; }))
      {
        result.push_back(other);
      }
    }
    return result;
  }

  /// @param nearest a buffer, which calls can share
  /// @param reduction the divisor of the distance, above 1 where the map is uncertain
  double Compute(int landmark, Distances& nearest, double* reduction = nullptr) const
  {
    this->Nearest(landmark, Neighbors, nearest);
    const std::size_t count = nearest.size();
    const double radius = std::sqrt(nearest.back().first);
    std::array<Neighbor, Neighbors> neighbors;
    for (std::size_t i = 0; i < count; ++i)
    {
      const auto& [square, id] = nearest[i];
      const Vector2 p = (1.0 / radius) * (this->Landmarks[0][id] - this->Landmarks[0][landmark]);
      Neighbor& n = neighbors[i];
      n.Values = { 1.0, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y };
      n.To = this->Landmarks[1][id] - this->Landmarks[1][landmark];
      n.Near = std::exp(-2.0 * square / (radius * radius));
      n.Weight = n.Near;
    }
    // The constant coefficient is the value at the landmark.
    std::array<Vector2, Monomials> coefficients;
    std::array<double, Monomials> influence;
    std::array<double, Neighbors> sorted;
    for (int pass = 0; pass < 12; ++pass)
    {
      Fit(neighbors, count, this->Terms, coefficients, influence);
      for (std::size_t i = 0; i < count; ++i)
      {
        Vector2 error = neighbors[i].To;
        for (int r = 0; r < this->Terms; ++r)
        {
          error = error - neighbors[i].Values[r] * coefficients[r];
        }
        neighbors[i].Error = std::hypot(error.x, error.y);
        sorted[i] = neighbors[i].Error;
      }
      const auto median = sorted.begin() + count / 2;
      std::nth_element(sorted.begin(), median, sorted.begin() + count);
      if (!(*median > 0.0))
      {
        break;
      }
      for (std::size_t i = 0; i < count; ++i)
      {
        const double ratio = neighbors[i].Error / *median;
        neighbors[i].Weight = neighbors[i].Near / (1.0 + 0.5 * ratio * ratio);
      }
    }
    double variance = 1.0;
    for (std::size_t i = 0; i < count; ++i)
    {
      const Neighbor& n = neighbors[i];
      const double share = n.Weight *
        std::inner_product(
          influence.begin(), influence.begin() + this->Terms, n.Values.begin(), 0.0);
      variance += share * share;
    }
    const double divisor = std::sqrt(std::max(1.0, variance / UsualVariance));
    if (reduction)
    {
      *reduction = divisor;
    }
    return std::hypot(coefficients[0].x, coefficients[0].y) / divisor;
  }

  std::vector<int> Rejected;

private:
  const std::array<std::vector<Vector2>, 2>& Landmarks;
  Cells Near;
  int Terms;
};

/// The landmarks with the largest residuals above a limit that are not rejected, the worst first,
/// of equal ones the lower number.
std::vector<int> FindWorst(
  const std::vector<double>& residuals, double limit, const std::vector<int>& rejected, int count)
{
  std::vector<int> worst;
  for (int i = 0; i < static_cast<int>(residuals.size()); ++i)
  {
    if (residuals[i] > limit && !std::count(rejected.begin(), rejected.end(), i))
    {
      worst.push_back(i);
    }
  }
  const auto last =
    worst.begin() + std::min<std::ptrdiff_t>(count, static_cast<std::ptrdiff_t>(worst.size()));
  std::partial_sort(worst.begin(), last, worst.end(), [&](int a, int b) {
    return residuals[a] > residuals[b] || (residuals[a] == residuals[b] && a < b);
  });
  worst.erase(last, worst.end());
  return worst;
}

/// The 80 % quantile of the residuals of trusted landmarks.
double Quantile80(const std::vector<double>& residuals, const std::vector<int>& rejected)
{
  std::vector<double> trusted;
  for (int i = 0; i < static_cast<int>(residuals.size()); ++i)
  {
    if (!std::count(rejected.begin(), rejected.end(), i))
    {
      trusted.push_back(residuals[i]);
    }
  }
  const auto usual = trusted.begin() + 4 * (static_cast<std::ptrdiff_t>(trusted.size()) - 1) / 5;
  std::nth_element(trusted.begin(), usual, trusted.end());
  return *usual;
}

/// The sum of the residuals of trusted landmarks.
double Sum(const std::vector<double>& residuals, const std::vector<int>& rejected)
{
  double sum = 0.0;
  for (int i = 0; i < static_cast<int>(residuals.size()); ++i)
  {
    sum += std::count(rejected.begin(), rejected.end(), i) ? 0.0 : residuals[i];
  }
  return sum;
}

std::vector<double> ComputeAll(const Residuals& among, int n)
{
  std::vector<double> residuals(n);
  Distances nearest;
  for (int i = 0; i < n; ++i)
  {
    residuals[i] = among.Compute(i, nearest);
  }
  return residuals;
}

/// Rejects one or two of few landmarks. A wrong landmark is a neighbor of most others and increases
/// their residuals, so none is an outlier until the wrong one is excluded. Returns the residuals.
std::vector<double> RejectAmongFew(Residuals& among, int n)
{
  std::vector<double> residuals = ComputeAll(among, n);
  constexpr int few = 30;
  if (n > few)
  {
    return residuals;
  }
  const auto attempt = [&](const std::vector<std::vector<int>>& sets) {
    std::vector<int> rejected = among.Rejected;
    double least = Sum(residuals, rejected) / 2.0;
    std::vector<double> without;
    for (const std::vector<int>& set : sets)
    {
      among.Rejected = set;
      std::vector<double> changed = ComputeAll(among, n);
      const double usual = Quantile80(changed, set);
      const double sum = Sum(changed, set);
      if (sum < least &&
        std::all_of(set.begin(), set.end(), [&](int i) { return changed[i] > 6.0 * usual; }))
      {
        least = sum;
        rejected = set;
        without = std::move(changed);
      }
    }
    among.Rejected = rejected;
    if (!without.empty())
    {
      residuals = std::move(without);
    }
  };
  std::vector<std::vector<int>> sets;
  for (int i = 0; i < n; ++i)
  {
    sets.push_back({ i });
  }
  attempt(sets);
  // Two landmarks that have been interchanged are both wrong. If only one is excluded, the other
  // one still increases the residuals of most landmarks.
  constexpr int fewer = 16;
  if (n >= 8 && n <= fewer)
  {
    sets.clear();
    for (int i = 0; i < n; ++i)
    {
      for (int k = 0; k < i; ++k)
      {
        sets.push_back({ k, i });
      }
    }
    attempt(sets);
  }
  return residuals;
}

/// Rejects outliers. Returns the residuals.
std::vector<double> Reject(Residuals& among, int n)
{
  Distances nearest;
  std::vector<double> residuals = RejectAmongFew(among, n);
  const double limit = 4.0 * Quantile80(residuals, among.Rejected);
  // While there are outliers, reject the one without which the others fit best. The one with the
  // largest residual may only be the neighbor of a wrong landmark.
  while (static_cast<int>(among.Rejected.size()) < std::min(10, n / 5))
  {
    double best = -1.0;
    int rejected = -1;
    std::vector<std::pair<int, double>> changes;
    for (const int candidate : FindWorst(residuals, limit, among.Rejected, 8))
    {
      const std::vector<int> depending = among.DependingOn(candidate);
      among.Rejected.push_back(candidate);
      double gain = residuals[candidate];
      std::vector<std::pair<int, double>> changed;
      for (const int other : depending)
      {
        changed.emplace_back(other, among.Compute(other, nearest));
        gain += residuals[other] - changed.back().second;
      }
      among.Rejected.pop_back();
      if (gain > best)
      {
        best = gain;
        rejected = candidate;
        changes = changed;
      }
    }
    if (rejected < 0)
    {
      break;
    }
    among.Rejected.push_back(rejected);
    for (const auto& [landmark, residual] : changes)
    {
      residuals[landmark] = residual;
    }
  }
  for (const int rejected : among.Rejected)
  {
    residuals[rejected] = among.Compute(rejected, nearest);
  }
  return residuals;
}

} // namespace

std::vector<double> LandmarkResiduals(const std::array<std::vector<Vector2>, 2>& landmarks)
{
  const int n = static_cast<int>(landmarks[0].size());
  if (n < 5)
  {
    return std::vector<double>(n, 0.0);
  }
  Residuals among(landmarks);
  std::vector<double> residuals = Reject(among, n);
  // A landmark that is wrong in the source may be far from its neighbors there, where a map through
  // them is uncertain. The inverse map is certain.
  const std::array<std::vector<Vector2>, 2> exchanged{ landmarks[1], landmarks[0] };
  Residuals back(exchanged);
  const std::vector<double> inverse = Reject(back, n);
  const double usual = Quantile80(inverse, back.Rejected);
  std::vector<int> added;
  Distances nearest;
  for (const int i : back.Rejected)
  {
    constexpr double uncertain = 3.0;
    double reduction = 1.0;
    among.Compute(i, nearest, &reduction);
    if (inverse[i] > 6.0 * usual && reduction > uncertain)
    {
      added.push_back(i);
      if (!std::count(among.Rejected.begin(), among.Rejected.end(), i))
      {
        among.Rejected.push_back(i);
      }
    }
  }
  if (!added.empty())
  {
    residuals = ComputeAll(among, n);
    const double scale = usual > 0.0 ? Quantile80(residuals, among.Rejected) / usual : 0.0;
    for (const int i : added)
    {
      residuals[i] = std::max(residuals[i], scale * inverse[i]);
    }
  }
  return residuals;
}

} // namespace homeomorphism
