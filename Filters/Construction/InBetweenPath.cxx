// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "InBetweenPath.h"

#include "Kernel/ExactSign.h"

#include <algorithm>
#include <cmath>

namespace homeomorphism
{
namespace
{

Vector2 Mean(const std::vector<Vector2>& points)
{
  Vector2 sum{ 0.0, 0.0 };
  for (const Vector2& p : points)
  {
    sum = { sum.x + p.x, sum.y + p.y };
  }
  const double count = std::max<double>(1.0, static_cast<double>(points.size()));
  return { sum.x / count, sum.y / count };
}

/// v rotated by an angle and scaled by exp(logFactor).
Vector2 Turned(const Vector2& v, double angle, double logFactor)
{
  const double factor = std::exp(logFactor);
  const double c = factor * std::cos(angle);
  const double s = factor * std::sin(angle);
  return { c * v.x - s * v.y, s * v.x + c * v.y };
}

/// Accurate to the last few bits, so that needles usually have the correct sign.
double AccurateCross(const Vector2& a, const Vector2& b)
{
  return DifferenceOfProducts(a.x, b.y, a.y, b.x);
}

} // namespace

InBetweenPath::InBetweenPath(
  const std::vector<Vector2>& source, const std::vector<Vector2>& target, bool rotating)
  : Centers{ { 0.0, 0.0 }, { 0.0, 0.0 } }
{
  if (!rotating)
  {
    return;
  }
  const Vector2 centers[2] = { Mean(source), Mean(target) };
  // a = sum conj(p) q / sum |p|^2, relative to the centers.
  double real = 0.0;
  double imaginary = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i)
  {
    const Vector2 p = source[i] - centers[0];
    const Vector2 q = target[i] - centers[1];
    real += Dot(p, q);
    imaginary += Cross(p, q);
    square += Dot(p, p);
  }
  const double logFactor = std::log(std::hypot(real, imaginary)) - std::log(square);
  if (std::isfinite(logFactor))
  {
    this->Centers[0] = centers[0];
    this->Centers[1] = centers[1];
    this->Angle = std::atan2(imaginary, real);
    this->LogFactor = logFactor;
  }
}

double InBetweenPath::GetFactor() const
{
  return std::exp(this->LogFactor);
}

Vector2 InBetweenPath::Unturned(const Vector2& v) const
{
  return this->Angle == 0.0 && this->LogFactor == 0.0 ? v
                                                      : Turned(v, -this->Angle, -this->LogFactor);
}

Vector2 InBetweenPath::GetPosition(const Vector2& source, const Vector2& target, double time) const
{
  if (time <= 0.0 || time >= 1.0)
  {
    return time <= 0.0 ? source : target;
  }
  const auto between = [time](const Vector2& a, const Vector2& b) {
    return Vector2{ (1.0 - time) * a.x + time * b.x, (1.0 - time) * a.y + time * b.y };
  };
  if (this->Angle == 0.0 && this->LogFactor == 0.0)
  {
    return between(source, target);
  }
  const Vector2 center = between(this->Centers[0], this->Centers[1]);
  const Vector2 relative =
    between(source - this->Centers[0], this->Unturned(target - this->Centers[1]));
  const Vector2 turned = Turned(relative, time * this->Angle, time * this->LogFactor);
  return { center.x + turned.x, center.y + turned.y };
}

PathFolds InBetweenPath::FindFolds(const std::vector<std::array<std::int64_t, 3>>& triangles,
  const std::vector<Vector2>& source, const std::vector<Vector2>& target) const
{
  PathFolds folds;
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    const auto corner = [&](const std::vector<Vector2>& points, std::size_t k) -> const Vector2& {
      return points[static_cast<std::size_t>(triangles[i][k])];
    };
    const int sign = Orientation(corner(source, 0), corner(source, 1), corner(source, 2));
    if (sign == 0 || sign != Orientation(corner(target, 0), corner(target, 1), corner(target, 2)))
    {
      // Degenerate at time 0, or degenerate or flipped at time 1.
      ++folds.Triangles;
      const double begin = sign == 0 ? 0.0 : 1.0;
      if (folds.FirstTriangle < 0 || begin < folds.Begin)
      {
        folds.FirstTriangle = static_cast<std::int64_t>(i);
        folds.Begin = begin;
      }
      folds.End = 1.0;
      continue;
    }
    // Twice the area at t, divided by |a|^(2t), is start (1 - t)^2 + middle t (1 - t) + end t^2.
    const Vector2 p[2] = { corner(source, 1) - corner(source, 0),
      corner(source, 2) - corner(source, 0) };
    const Vector2 q[2] = { this->Unturned(corner(target, 1) - corner(target, 0)),
      this->Unturned(corner(target, 2) - corner(target, 0)) };
    const double start = sign * AccurateCross(p[0], p[1]);
    const double middle = sign * (AccurateCross(p[0], q[1]) + AccurateCross(q[0], p[1]));
    const double end = sign * AccurateCross(q[0], q[1]);
    // If both ends are positive, zeros in between require a negative middle coefficient of
    // sufficient size.
    const double root = std::sqrt(start) * std::sqrt(end);
    if (!(middle <= -2.0 * root))
    {
      continue;
    }
    // In s = t / (1 - t): end s^2 + middle s + start = 0.
    const double difference =
      std::sqrt(std::max(0.0, -middle - 2.0 * root)) * std::sqrt(-middle + 2.0 * root);
    const double larger = (-middle + difference) / (2.0 * end);
    const double smaller = 2.0 * start / (-middle + difference);
    const double begin = smaller / (1.0 + smaller);
    ++folds.Triangles;
    if (folds.FirstTriangle < 0 || begin < folds.Begin)
    {
      folds.Begin = begin;
      folds.FirstTriangle = static_cast<std::int64_t>(i);
    }
    folds.End = std::max(folds.End, std::isfinite(larger) ? larger / (1.0 + larger) : 1.0);
  }
  return folds;
}

} // namespace homeomorphism
