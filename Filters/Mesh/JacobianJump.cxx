// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "JacobianJump.h"

#include "Kernel/OneSidedDerivative.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace homeomorphism
{
namespace
{

/// Components of a vector along three axes.
Vector3 InAxes(const Vector3& v, const std::array<Vector3, 3>& axes)
{
  Vector3 result;
  for (int k = 0; k < 3; ++k)
  {
    result[k] = v[0] * axes[k][0] + v[1] * axes[k][1] + v[2] * axes[k][2];
  }
  return result;
}

/// The noise of a function's values: what is left of them in fourth differences over a step so small
/// that nothing else can be.
template <typename Function>
double Noise(Function&& function, double reach)
{
  constexpr int count = 10;
  const double step = reach * 0x1p-22;
  std::array<Vector3, count> values;
  for (int i = 0; i < count; ++i)
  {
    values[i] = function(i * step);
  }
  double noise = 0.0;
  for (int i = 0; i + 4 < count; ++i)
  {
    Vector3 difference;
    for (int axis = 0; axis < 3; ++axis)
    {
      difference[axis] = values[i][axis] - 4.0 * values[i + 1][axis] + 6.0 * values[i + 2][axis] -
        4.0 * values[i + 3][axis] + values[i + 4][axis];
    }
    // The root of the sum of the squared coefficients is 8.4.
    noise = std::max(noise, Length(difference) / 4.0);
  }
  return noise;
}

/// What must be zero if the derivatives of this order in the directions Inward, given in the sides' own
/// axes, are those of one smooth map. The two directions are opposite, so the first derivatives are as
/// well, and second derivatives equal; a side's second axis is opposite to the other's.
Vector3 Mismatch(const std::array<Vector3, 2>& derivatives, int order)
{
  const double sign = order == 1 ? 1.0 : -1.0;
  return { derivatives[0][0] + sign * derivatives[1][0],
    derivatives[0][1] - sign * derivatives[1][1], derivatives[0][2] + sign * derivatives[1][2] };
}

/// Fills in all that follows from the derivatives themselves.
JacobianJump Describe(const std::array<Vector3, 2>& derivatives, int order, double norm)
{
  const Vector3 mismatch = Mismatch(derivatives, order);
  JacobianJump jump;
  jump.Jump = Length(mismatch) / norm;
  jump.Normal = std::hypot(mismatch[1], mismatch[2]) / norm;
  jump.Tangential = std::abs(mismatch[0]) / norm;
  // The second side's derivative, seen from the first.
  const double sign = order == 1 ? -1.0 : 1.0;
  const Vector3 other{ sign * derivatives[1][0], -sign * derivatives[1][1],
    sign * derivatives[1][2] };
  const Vector3& one = derivatives[0];
  const Vector3 cross{ one[1] * other[2] - one[2] * other[1],
    one[2] * other[0] - one[0] * other[2], one[0] * other[1] - one[1] * other[0] };
  jump.Angle = std::atan2(
    Length(cross), one[0] * other[0] + one[1] * other[1] + one[2] * other[2]);
  const double longer = std::max(Length(one), Length(other));
  jump.Stretch = (longer - std::min(Length(one), Length(other))) /
    std::min(Length(one), Length(other));
  return jump;
}

/// Slope of log(difference of the sides' quotients) against log(step), where the difference stands out
/// from rounding: the median over neighbouring steps.
double ObservedOrder(const OneSidedDerivative& first, const OneSidedDerivative& second,
  const LineCrossing& crossing, int order)
{
  std::vector<double> slopes;
  double last = 0.0;
  for (int i = 0; i < OneSidedDerivative::NumberOfSteps; ++i)
  {
    const double difference =
      Length(Mismatch({ InAxes(first.GetQuotient(i), crossing.ImageAxes[0]),
                        InAxes(second.GetQuotient(i), crossing.ImageAxes[1]) },
        order));
    const double rounding = first.GetRounding(i) + second.GetRounding(i);
    if (!(difference > 16.0 * rounding))
    {
      break;
    }
    if (i > 0)
    {
      slopes.push_back(std::log2(last / difference));
    }
    last = difference;
  }
  if (slopes.empty())
  {
    return JacobianJump::None;
  }
  // The later half: closer to the limit.
  const auto begin = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  const auto middle = begin + (slopes.end() - begin) / 2;
  std::nth_element(begin, middle, slopes.end());
  return *middle;
}

} // namespace

JacobianJump EstimateJump(
  const MapUnderTest& map, const LineCrossing& crossing, int order, double resolution)
{
  const auto along = [&](const Vector3& direction, double step) {
    const Vector3 point{ crossing.Point[0] + step * direction[0],
      crossing.Point[1] + step * direction[1], crossing.Point[2] + step * direction[2] };
    Vector3 image;
    if (!map(point, image))
    {
      image.fill(JacobianJump::None);
    }
    return image;
  };
  const Vector3 center = along(crossing.Tangent, 0.0);
  const Vector3 backwards{ -crossing.Tangent[0], -crossing.Tangent[1], -crossing.Tangent[2] };
  const auto roundingOf = [&](const Vector3& direction, double reach) {
    // A point is known to its rounding, which the map carries over, and so is its image.
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    const Vector3 far = along(direction, reach);
    const double slope =
      Length({ far[0] - center[0], far[1] - center[1], far[2] - center[2] }) / reach;
    const double least = 2.0 * ulp *
      (std::max(Length(far), Length(center)) + slope * (Length(crossing.Point) + reach));
    return std::max(least, Noise([&](double t) { return along(direction, t); }, reach));
  };

  const OneSidedDerivative forward([&](double t) { return along(crossing.Tangent, t); }, 1,
    crossing.TangentReach, roundingOf(crossing.Tangent, crossing.TangentReach));
  const OneSidedDerivative backward([&](double t) { return along(backwards, t); }, 1,
    crossing.TangentReach, roundingOf(backwards, crossing.TangentReach));
  const double tangentLength =
    0.5 * (Length(forward.Extrapolate().Value) + Length(backward.Extrapolate().Value));

  std::array<double, 2> sideLength{};
  std::array<Vector3, 2> derivatives{};
  double error = 0.0;
  double measuredReach = std::min(crossing.Reach[0], crossing.Reach[1]);
  std::array<OneSidedDerivative, 2> sides{
    OneSidedDerivative([&](double t) { return along(crossing.Inward[0], t); }, order,
      crossing.Reach[0], roundingOf(crossing.Inward[0], crossing.Reach[0])),
    OneSidedDerivative([&](double t) { return along(crossing.Inward[1], t); }, order,
      crossing.Reach[1], roundingOf(crossing.Inward[1], crossing.Reach[1]))
  };
  for (int side = 0; side < 2; ++side)
  {
    const DerivativeEstimate estimate = sides[side].Extrapolate();
    derivatives[side] = InAxes(estimate.Value, crossing.ImageAxes[side]);
    error += estimate.Error;
    sideLength[side] = order == 1
      ? Length(estimate.Value)
      : Length(OneSidedDerivative([&](double t) { return along(crossing.Inward[side], t); }, 1,
          crossing.Reach[side], roundingOf(crossing.Inward[side], crossing.Reach[side]))
                 .Extrapolate()
                 .Value);
  }
  double norm = std::hypot(tangentLength, 0.5 * (sideLength[0] + sideLength[1]));
  if (order == 2)
  {
    norm /= measuredReach;
  }
  JacobianJump jump = Describe(derivatives, order, norm);
  jump.Error = error / norm;
  jump.Order = ObservedOrder(sides[0], sides[1], crossing, order);
  if (jump.Jump > 2.0 * jump.Error && jump.Jump > resolution)
  {
    jump.Verdict = JumpVerdict::Kink;
  }
  else if (jump.Jump + jump.Error <= resolution)
  {
    jump.Verdict = JumpVerdict::Differentiable;
  }
  return jump;
}

JacobianJump CompareDerivatives(const LineCrossing& crossing, const std::array<Vector3, 2>& inward,
  const Vector3& along)
{
  const double norm = std::hypot(Length(along), 0.5 * (Length(inward[0]) + Length(inward[1])));
  return Describe({ InAxes(inward[0], crossing.ImageAxes[0]),
                    InAxes(inward[1], crossing.ImageAxes[1]) },
    1, norm);
}

} // namespace homeomorphism
