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

double QualityOf(
  const QualityMeasure& quality, const TrianglePoints& source, const TrianglePoints& target)
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
      // Counterclockwise, but with an area of 0 in floating point.
      return 0.0;
    }
  }
  return std::max(worst, 0.0);
}

int QualityTerms(const QualityMeasure& quality, const TrianglePoints& p,
  const TrianglePoints& other, std::array<QualityTerm, 9>& terms)
{
  const double doubleArea = Cross(p[1] - p[0], p[2] - p[0]);
  if (!(doubleArea > 0.0))
  {
    return 0;
  }
  int count = 0;
  if (quality.Kind == PairQuality::Distortion)
  {
    // For the map from the other triangle to p, |J|^2 times the other triangle's area is half the
    // cotangent-weighted sum of squared edges (Pinkall, Polthier 1993).
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
    // The mean of the ratio of singular values and its inverse is energy / (2 A), with the area A
    // of p. The quality is 60 divided by this mean.
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
  // Compute the angle opposite the longest edge from the other two.
  TrianglePoints edges;
  std::array<double, 3> squares;
  int longest = 0;
  for (int k = 0; k < 3; ++k)
  {
    edges[k] = p[PreviousCorner(k)] - p[NextCorner(k)];
    squares[k] = Dot(edges[k], edges[k]);
    longest = squares[k] > squares[longest] ? k : longest;
  }
  std::array<double, 3> angles;
  angles[longest] = 180.0;
  for (const int k : { NextCorner(longest), PreviousCorner(longest) })
  {
    angles[k] =
      Degrees * std::atan2(doubleArea, -Dot(edges[NextCorner(k)], edges[PreviousCorner(k)]));
    angles[longest] -= angles[k];
  }
  const bool isConcordance = quality.Kind == PairQuality::Concordance;
  for (int k = 0; k < 3; ++k)
  {
    const int next = NextCorner(k);
    const int previous = PreviousCorner(k);
    const Vector2& u = edges[previous];
    const Vector2 v = -1.0 * edges[next];
    const Vector2 byU = (Degrees / squares[previous]) * Vector2{ -u.y, u.x };
    const Vector2 byV = (Degrees / squares[next]) * Vector2{ -v.y, v.x };
    const auto add = [&](double value, const Vector2& byNext, const Vector2& byPrevious) {
      QualityTerm& term = terms[count++];
      term.Value = value;
      term.Gradient[next] = byNext;
      term.Gradient[previous] = byPrevious;
      term.Gradient[k] = -1.0 * (byNext + byPrevious);
    };
    if (quality.Kind == PairQuality::MinimumAngle)
    {
      add(angles[k], -1.0 * byU, byV);
      continue;
    }
    if (angles[k] < 2.0 * quality.Thin)
    {
      const double ratio = std::max(angles[k], 0.0) / quality.Thin;
      const double slope = 360.0 * ratio * ratio * ratio / quality.Thin;
      add(90.0 * ratio * ratio * ratio * ratio, -slope * byU, slope * byV);
    }
    if (quality.Kind == PairQuality::NonObtuse)
    {
      add(180.0 - angles[k], byU, -1.0 * byV);
    }
    else if (isConcordance)
    {
      // The projection of the centroid to an edge is between its ends if the angles between the
      // edge and the medians at its ends are below 90 degrees. The median divides the angle at the
      // corner.
      const Vector2 median = u + v;
      const Vector2 byMedian = (Degrees / Dot(median, median)) * Vector2{ -median.y, median.x };
      const double withU = Degrees * std::atan2(doubleArea, Dot(u, median));
      add(180.0 - withU, byU - byMedian, -1.0 * byMedian);
      add(180.0 - (angles[k] - withU), byMedian, byMedian - byV);
    }
  }
  return count;
}

PairQualities MeasureQualities(const std::array<std::vector<Vector2>, 2>& points,
  const std::vector<std::array<int, 3>>& triangles)
{
  PairQualities qualities;
  qualities.MinimumAngle = { { 180.0, 180.0 } };
  int obtuse = 0;
  int discordant = 0;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
  {
    std::array<TrianglePoints, 2> p;
    bool isObtuse = false;
    bool isDiscordant = false;
    double smallest = 180.0;
    for (int d = 0; d < 2; ++d)
    {
      for (int k = 0; k < 3; ++k)
      {
        p[d][k] = points[d][triangles[t][k]];
      }
      if (Cross(p[d][1] - p[d][0], p[d][2] - p[d][0]) < 0.0)
      {
        for (Vector2& corner : p[d])
        {
          corner.y = -corner.y;
        }
      }
      for (const double angle : Angles(p[d]))
      {
        for (int i = 0; i < 3; ++i)
        {
          qualities.SharesBelow[d][i] += angle < 10.0 + 5.0 * i ? 1.0 : 0.0;
        }
        isObtuse = isObtuse || angle > 90.0;
        smallest = std::min(smallest, angle);
        if (angle < qualities.MinimumAngle[d])
        {
          qualities.MinimumAngle[d] = angle;
          qualities.MinimumAngleTriangle[d] = t;
        }
      }
      isDiscordant = isDiscordant || !IsConcordant(&p[d][0].x, &p[d][1].x, &p[d][2].x, 2);
    }
    obtuse += isObtuse ? 1 : 0;
    discordant += isDiscordant ? 1 : 0;
    const double distortion = Distortion(p[0], p[1]);
    qualities.MinimumAngles.push_back(smallest);
    qualities.Distortions.push_back(distortion);
    if (qualities.LargestDistortionTriangle < 0 || distortion > qualities.LargestDistortion)
    {
      qualities.LargestDistortion = distortion;
      qualities.LargestDistortionTriangle = t;
    }
  }
  const double n = static_cast<double>(std::max<std::size_t>(triangles.size(), 1));
  for (auto& shares : qualities.SharesBelow)
  {
    for (double& share : shares)
    {
      share /= 3.0 * n;
    }
  }
  qualities.ObtuseShare = obtuse / n;
  qualities.DiscordantShare = discordant / n;
  return qualities;
}

} // namespace homeomorphism
