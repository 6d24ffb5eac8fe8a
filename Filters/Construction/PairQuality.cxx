// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PairQuality.h"

#include "Kernel/ExactSign.h"

#include <algorithm>
#include <limits>

namespace homeomorphism
{
namespace
{

constexpr double Degrees = 57.295779513082320877;

// An angle of 2.5 degrees counts as much as the limit of concordance: concordant triangles are not
// to become needles.
constexpr double NeedleOffset = 85.0;
constexpr double NeedleFactor = 2.0;

/// (|J|^2 / det J) / 2 of the affine map between two triangles: (s + 1 / s) / 2 for the ratio s of
/// its singular values.
double MeanDistortion(const TrianglePoints& source, const TrianglePoints& target)
{
  const Vector2 a = source[1] - source[0];
  const Vector2 b = source[2] - source[0];
  const Vector2 c = target[1] - target[0];
  const Vector2 d = target[2] - target[0];
  const double det = Cross(a, b);
  // The map's columns are (c b.y - d a.y) / det and (d a.x - c b.x) / det.
  const Vector2 x = b.y * c - a.y * d;
  const Vector2 y = a.x * d - b.x * c;
  return (Dot(x, x) + Dot(y, y)) / (2.0 * det * Cross(c, d));
}

} // namespace

std::array<double, 3> Angles(const TrianglePoints& p)
{
  std::array<double, 3> angles;
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 u = p[NextCorner(k)] - p[k];
    const Vector2 v = p[PreviousCorner(k)] - p[k];
    angles[k] = Degrees * std::atan2(Cross(u, v), Dot(u, v));
  }
  return angles;
}

double Distortion(const TrianglePoints& source, const TrianglePoints& target)
{
  const double mean = MeanDistortion(source, target);
  if (!(mean >= 0.0))
  {
    return std::numeric_limits<double>::infinity();
  }
  return mean > 1.0 ? mean + std::sqrt((mean - 1.0) * (mean + 1.0)) : 1.0;
}

double QualityOf(PairQuality quality, const TrianglePoints& source, const TrianglePoints& target)
{
  if (Orientation(source[0], source[1], source[2]) <= 0 ||
    Orientation(target[0], target[1], target[2]) <= 0)
  {
    return -1.0;
  }
  double worst = std::numeric_limits<double>::infinity();
  std::array<QualityTerm, 9> terms;
  for (int d = 0; d < 2; ++d)
  {
    const int count = d == 0 ? QualityTerms(quality, source, target, terms)
                             : QualityTerms(quality, target, source, terms);
    for (int i = 0; i < count; ++i)
    {
      worst = std::min(worst, terms[i].Value);
    }
    if (count == 0)
    {
      // Counterclockwise, but only just.
      return 0.0;
    }
  }
  return std::max(worst, 0.0);
}

int QualityTerms(PairQuality quality, const TrianglePoints& p, const TrianglePoints& other,
  std::array<QualityTerm, 9>& terms)
{
  const double doubleArea = Cross(p[1] - p[0], p[2] - p[0]);
  if (!(doubleArea > 0.0))
  {
    return 0;
  }
  int count = 0;
  if (quality == PairQuality::Distortion)
  {
    // |J|^2 det is the cotangent-weighted sum of squared edges (Pinkall, Polthier 1993).
    double energy = 0.0;
    TrianglePoints gradient{};
    for (int k = 0; k < 3; ++k)
    {
      const int next = NextCorner(k);
      const int previous = PreviousCorner(k);
      const Vector2 u = other[next] - other[k];
      const Vector2 v = other[previous] - other[k];
      const double area = Cross(u, v);
      if (!(area > 0.0))
      {
        return 0;
      }
      const double cotangent = Dot(u, v) / area;
      const Vector2 edge = p[next] - p[previous];
      energy += 0.5 * cotangent * Dot(edge, edge);
      gradient[next] = gradient[next] + cotangent * edge;
      gradient[previous] = gradient[previous] - cotangent * edge;
    }
    // mean = energy / (2 A), quality = 60 / mean.
    QualityTerm& term = terms[count++];
    term.Value = 60.0 * doubleArea / energy;
    for (int k = 0; k < 3; ++k)
    {
      const Vector2 opposite = p[PreviousCorner(k)] - p[NextCorner(k)];
      const Vector2 areaGradient{ -opposite.y, opposite.x };
      term.Gradient[k] =
        (60.0 / energy) * areaGradient - (60.0 * doubleArea / (energy * energy)) * gradient[k];
    }
    return count;
  }
  for (int k = 0; k < 3; ++k)
  {
    const int next = NextCorner(k);
    const int previous = PreviousCorner(k);
    const Vector2 u = p[next] - p[k];
    const Vector2 v = p[previous] - p[k];
    const double uu = Dot(u, u);
    const double vv = Dot(v, v);
    const double uv = Dot(u, v);
    // The angle and its derivatives by the two other corners.
    QualityTerm& angle = terms[count++];
    angle.Value = Degrees * std::atan2(doubleArea, uv);
    angle.Gradient[next] = (Degrees / uu) * Vector2{ u.y, -u.x };
    angle.Gradient[previous] = (Degrees / vv) * Vector2{ -v.y, v.x };
    if (quality == PairQuality::NonObtuse)
    {
      angle.Value = 180.0 - angle.Value;
      angle.Gradient[next] = -1.0 * angle.Gradient[next];
      angle.Gradient[previous] = -1.0 * angle.Gradient[previous];
    }
    else if (quality == PairQuality::Concordance)
    {
      angle.Value = NeedleOffset + NeedleFactor * angle.Value;
      angle.Gradient[next] = NeedleFactor * angle.Gradient[next];
      angle.Gradient[previous] = NeedleFactor * angle.Gradient[previous];
      // The centroid's foot is within an edge if the median makes an angle below 90 degrees with
      // it.
      const Vector2 median = u + v;
      const double mm = Dot(median, median);
      const Vector2 byMedian = (Degrees / mm) * Vector2{ -median.y, median.x };
      for (int e = 0; e < 2; ++e)
      {
        const Vector2& edge = e == 0 ? u : v;
        const double sign = e == 0 ? 1.0 : -1.0;
        const double square = e == 0 ? uu : vv;
        const Vector2 byEdge = (Degrees / square) * Vector2{ -edge.y, edge.x };
        QualityTerm& foot = terms[count++];
        foot.Value = 180.0 - Degrees * std::atan2(doubleArea, Dot(edge, median));
        const Vector2 common = -sign * byMedian;
        foot.Gradient[next] = e == 0 ? common + sign * byEdge : common;
        foot.Gradient[previous] = e == 0 ? common : common + sign * byEdge;
        foot.Gradient[k] = -1.0 * (foot.Gradient[next] + foot.Gradient[previous]);
      }
    }
    angle.Gradient[k] = -1.0 * (angle.Gradient[next] + angle.Gradient[previous]);
  }
  return count;
}

} // namespace homeomorphism
