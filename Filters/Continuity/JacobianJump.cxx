// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "JacobianJump.h"

#include "Continuity/OneSidedDerivative.h"

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

/// The noise of a function's values: their fourth differences over steps so small that those of a
/// smooth function vanish.
template <typename Function>
double Noise(Function&& function, double length)
{
  constexpr int count = 8;
  const double step = length * 0x1p-22;
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
    // The norm of the coefficients 1, -4, 6, -4, 1 is 8.4. Half of it allows for differences that
    // are small by chance.
    noise = std::max(noise, Length(difference) / 4.0);
  }
  return noise;
}

/// A linear expression in the derivatives of this order in the directions Inward, given in the axes
/// of each side, that is zero if both belong to one smooth map. The two directions are opposite, so
/// the sum of first derivatives and the difference of second derivatives vanish. The second axes of
/// the two sides are opposite.
Vector3 Mismatch(const std::array<Vector3, 2>& derivatives, int order)
{
  const double sign = order == 1 ? 1.0 : -1.0;
  return { derivatives[0][0] + sign * derivatives[1][0],
    derivatives[0][1] - sign * derivatives[1][1], derivatives[0][2] + sign * derivatives[1][2] };
}

/// Computes all quantities that follow from the derivatives.
JacobianJump Describe(const std::array<Vector3, 2>& derivatives, int order, double norm)
{
  const Vector3 mismatch = Mismatch(derivatives, order);
  JacobianJump jump;
  jump.Jump = Length(mismatch) / norm;
  jump.Normal = std::hypot(mismatch[1], mismatch[2]) / norm;
  jump.Tangential = std::abs(mismatch[0]) / norm;
  // The derivative of the second side in the axes of the first.
  const double sign = order == 1 ? -1.0 : 1.0;
  const Vector3 other{ sign * derivatives[1][0], -sign * derivatives[1][1],
    sign * derivatives[1][2] };
  const Vector3& one = derivatives[0];
  const Vector3 cross{ one[1] * other[2] - one[2] * other[1], one[2] * other[0] - one[0] * other[2],
    one[0] * other[1] - one[1] * other[0] };
  jump.Angle = std::atan2(Length(cross), one[0] * other[0] + one[1] * other[1] + one[2] * other[2]);
  const double longer = std::max(Length(one), Length(other));
  jump.Stretch =
    (longer - std::min(Length(one), Length(other))) / std::min(Length(one), Length(other));
  return jump;
}

/// Slope of log(difference) against log(step) where the difference exceeds rounding: the median
/// over neighboring steps. @a any returns the steps; the other functions take the index of one.
template <typename DifferenceAt, typename RoundingAt>
double ObservedOrder(
  const OneSidedDerivative& any, DifferenceAt&& differenceAt, RoundingAt&& roundingAt)
{
  std::vector<double> slopes;
  double last = 0.0;
  for (int i = 0; i < any.GetNumberOfSteps(); ++i)
  {
    const double difference = differenceAt(i);
    if (!(difference > 64.0 * roundingAt(i)))
    {
      break;
    }
    if (i > 0)
    {
      slopes.push_back(std::log(last / difference) / std::log(any.GetStep(i - 1) / any.GetStep(i)));
    }
    last = difference;
  }
  if (slopes.empty())
  {
    return JacobianJump::None;
  }
  // The last few steps, closest to the limit.
  const auto begin =
    slopes.end() - static_cast<std::ptrdiff_t>(std::min<std::size_t>(5, slopes.size()));
  const auto middle = begin + (slopes.end() - begin) / 2;
  std::nth_element(begin, middle, slopes.end());
  return *middle;
}

/// @a magnification is the ratio of the jump relative to the derivative that jumps and the jump
/// relative to the whole Jacobian. It is large where the map stretches along the line far more than
/// across it.
JumpVerdict Conclude(const JacobianJump& jump, double magnification, double resolution)
{
  const double size = magnification * jump.Jump;
  const double error = magnification * jump.Error;
  // A jump that decreases with the step may belong to another border of the map that the steps do
  // not resolve, unless the extrapolation excludes it.
  if (size > 2.0 * error && size > resolution &&
    (std::abs(jump.Order) < 0.1 || size > 1000.0 * error))
  {
    return JumpVerdict::Crease;
  }
  // A jump that grows indicates a discontinuous map.
  return size + error <= resolution && !(jump.Order < -0.5) ? JumpVerdict::Differentiable
                                                            : JumpVerdict::Undecided;
}

/// The map along a ray.
class FunctionOnRay
{
public:
  FunctionOnRay(const LocalMap& map, const Vector3& start, const Vector3& direction)
    : Map(map)
    , Start(start)
    , Direction(direction)
  {
  }

  Vector3 operator()(double step) const
  {
    Vector3 image;
    if (!this->Map.Evaluate(Sum(this->Start, step, this->Direction), image))
    {
      image.fill(JacobianJump::None);
    }
    return image;
  }

  /// A bound on the errors of the values on a ray of this length.
  double Rounding(double length) const
  {
    // The map transforms the rounding error of a point, and its image is rounded as well.
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    const Vector3 start = (*this)(0.0);
    const Vector3 far = (*this)(length);
    const double slope = Length(Difference(far, start)) / length;
    const double least = 0.5 * ulp *
      (this->Map.ImageMagnitude + std::max(Length(far), Length(start)) +
        slope * (this->Map.PointMagnitude + Length(this->Start) + length));
    return std::max(least, Noise(*this, length));
  }

private:
  const LocalMap& Map;
  const Vector3& Start;
  Vector3 Direction;
};

/// The deviations of the derivatives along a fan's rays from those of the linear map that fits them
/// best.
class DeviationFromLinear
{
public:
  explicit DeviationFromLinear(const RayFan& fan)
    : Rays(fan.Rays.size())
  {
    // The derivatives of linear maps span a plane in the space of all derivatives. These are
    // orthonormal axes of it.
    for (const RayFan::Ray& ray : fan.Rays)
    {
      this->Axes[0].push_back(ray.InPlane.x);
      this->Axes[1].push_back(ray.InPlane.y);
    }
    this->Normalize(0);
    // Orthogonalize twice, since the rays of a narrow sector leave little of the second axis.
    for (int pass = 0; pass < 2; ++pass)
    {
      double common = 0.0;
      for (std::size_t i = 0; i < this->Rays; ++i)
      {
        common += this->Axes[0][i] * this->Axes[1][i];
      }
      for (std::size_t i = 0; i < this->Rays; ++i)
      {
        this->Axes[1][i] -= common * this->Axes[0][i];
      }
      this->Normalize(1);
    }
  }

  /// The largest deviation. @a derivativeOf takes the index of a ray.
  template <typename DerivativeOf>
  double Largest(DerivativeOf&& derivativeOf) const
  {
    std::array<Vector3, 2> parts{};
    for (std::size_t i = 0; i < this->Rays; ++i)
    {
      for (int k = 0; k < 2; ++k)
      {
        parts[k] = Sum(parts[k], this->Axes[k][i], derivativeOf(i));
      }
    }
    double largest = 0.0;
    for (std::size_t i = 0; i < this->Rays; ++i)
    {
      const double deviation =
        Length(Sum(Sum(derivativeOf(i), -this->Axes[0][i], parts[0]), -this->Axes[1][i], parts[1]));
      largest = deviation <= largest ? largest : deviation;
    }
    return largest;
  }

  /// The effect of errors of the derivatives on the largest deviation.
  template <typename ErrorOf>
  double LargestError(ErrorOf&& errorOf) const
  {
    double largest = 0.0;
    for (std::size_t i = 0; i < this->Rays; ++i)
    {
      double error = 0.0;
      for (std::size_t k = 0; k < this->Rays; ++k)
      {
        const double weight = (i == k ? 1.0 : 0.0) - this->Axes[0][i] * this->Axes[0][k] -
          this->Axes[1][i] * this->Axes[1][k];
        error += std::abs(weight) * errorOf(k);
      }
      largest = error <= largest ? largest : error;
    }
    return largest;
  }

private:
  void Normalize(int axis)
  {
    double square = 0.0;
    for (const double component : this->Axes[axis])
    {
      square += component * component;
    }
    for (double& component : this->Axes[axis])
    {
      component = square > 0.0 ? component / std::sqrt(square) : 0.0;
    }
  }

  std::size_t Rays;
  std::array<std::vector<double>, 2> Axes;
};

/// The norm of a Jacobian with these derivatives along evenly distributed rays.
template <typename DerivativeOf>
double NormOfJacobian(std::size_t rays, DerivativeOf&& derivativeOf)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < rays; ++i)
  {
    sum += Length(derivativeOf(i));
  }
  return std::sqrt(2.0) * sum / static_cast<double>(rays);
}

} // namespace

void FindImageAxes(const LocalMap& map, LineCrossing& crossing)
{
  constexpr double small = 1.0 / 1024.0;
  const FunctionOnRay along(map, crossing.Point, crossing.Tangent);
  const FunctionOnRay across(map, crossing.Point, crossing.Inward[0]);
  const Vector3 start = along(0.0);
  const Vector3 tangent = Unit(Difference(along(small * crossing.TangentLength), start));
  const Vector3 inward = UnitAcross(start, tangent, across(small * crossing.RayLengths[0]));
  const Vector3 normal = Cross3(tangent, inward);
  crossing.ImageAxes[0] = { tangent, inward, normal };
  crossing.ImageAxes[1] = { tangent, Scaled(inward, -1.0), normal };
}

JacobianJump EstimateJump(
  const LocalMap& map, const LineCrossing& crossing, int order, double resolution)
{
  struct Estimated
  {
    OneSidedDerivative Quotients;
    DerivativeEstimate Limit;
    double Rounding;
  };
  const auto estimate = [](const FunctionOnRay& onRay, double length, double rounding,
                          int steps = OneSidedDerivative::MaximumSteps) {
    const OneSidedDerivative quotients(onRay, 1, length, rounding, steps);
    return Estimated{ quotients, quotients.Extrapolate(), rounding };
  };
  const auto estimateSide = [&](int side) {
    const FunctionOnRay onRay(map, crossing.Point, crossing.Inward[side]);
    return estimate(onRay, crossing.RayLengths[side], onRay.Rounding(crossing.RayLengths[side]));
  };
  const std::array<Estimated, 2> first{ estimateSide(0), estimateSide(1) };
  const auto estimateTangent = [&](double sign) {
    const FunctionOnRay onRay(map, crossing.Point, Scaled(crossing.Tangent, sign));
    return estimate(onRay, crossing.TangentLength, std::max(first[0].Rounding, first[1].Rounding),
      OneSidedDerivative::HalvedSteps);
  };
  const std::array<Estimated, 2> tangents{ estimateTangent(1.0), estimateTangent(-1.0) };
  double norm =
    std::hypot(0.5 * (Length(tangents[0].Limit.Value) + Length(tangents[1].Limit.Value)),
      0.5 * (Length(first[0].Limit.Value) + Length(first[1].Limit.Value)));
  const double normError = 0.5 *
    (tangents[0].Limit.Error + tangents[1].Limit.Error + first[0].Limit.Error +
      first[1].Limit.Error) /
    norm;
  std::array<Estimated, 2> domains = first;
  if (order == 2)
  {
    norm /= std::min(crossing.RayLengths[0], crossing.RayLengths[1]);
    for (int side = 0; side < 2; ++side)
    {
      const FunctionOnRay onRay(map, crossing.Point, crossing.Inward[side]);
      domains[side].Quotients =
        OneSidedDerivative(onRay, 2, crossing.RayLengths[side], first[side].Rounding);
      domains[side].Limit = domains[side].Quotients.Extrapolate();
    }
  }
  JacobianJump jump = Describe({ InAxes(domains[0].Limit.Value, crossing.ImageAxes[0]),
                                 InAxes(domains[1].Limit.Value, crossing.ImageAxes[1]) },
    order, norm);
  jump.Error = (domains[0].Limit.Error + domains[1].Limit.Error) / norm + jump.Jump * normError;
  jump.Order = ObservedOrder(
    domains[0].Quotients,
    [&](int i) {
      return Length(Mismatch({ InAxes(domains[0].Quotients.GetQuotient(i), crossing.ImageAxes[0]),
                               InAxes(domains[1].Quotients.GetQuotient(i), crossing.ImageAxes[1]) },
        order));
    },
    [&](
      int i) { return domains[0].Quotients.GetRounding(i) + domains[1].Quotients.GetRounding(i); });
  const double across = 0.5 * (Length(first[0].Limit.Value) + Length(first[1].Limit.Value));
  jump.Verdict = Conclude(jump, order == 1 ? norm / across : 1.0, resolution);
  return jump;
}

JacobianJump CompareDerivatives(
  const LineCrossing& crossing, const std::array<Vector3, 2>& inward, const Vector3& along)
{
  const double norm = std::hypot(Length(along), 0.5 * (Length(inward[0]) + Length(inward[1])));
  return Describe(
    { InAxes(inward[0], crossing.ImageAxes[0]), InAxes(inward[1], crossing.ImageAxes[1]) }, 1,
    norm);
}

JacobianJump EstimateJump(const LocalMap& map, const RayFan& fan, double resolution)
{
  std::vector<OneSidedDerivative> quotients;
  std::vector<DerivativeEstimate> limits;
  for (const RayFan::Ray& ray : fan.Rays)
  {
    const FunctionOnRay onRay(map, fan.Point, ray.Direction);
    quotients.emplace_back(onRay, 1, ray.Length, onRay.Rounding(ray.Length));
    limits.push_back(quotients.back().Extrapolate());
  }
  const DeviationFromLinear deviation(fan);
  const auto limitOf = [&limits](std::size_t ray) { return limits[ray].Value; };
  const double norm = NormOfJacobian(limits.size(), limitOf);
  JacobianJump jump;
  jump.Jump = deviation.Largest(limitOf) / norm;
  jump.Error =
    deviation.LargestError([&limits](std::size_t ray) { return limits[ray].Error; }) / norm;
  jump.Order = ObservedOrder(
    quotients.front(),
    [&](int i) {
      return deviation.Largest([&](std::size_t ray) { return quotients[ray].GetQuotient(i); });
    },
    [&](int i) {
      return deviation.LargestError([&](std::size_t ray) { return quotients[ray].GetRounding(i); });
    });
  jump.Verdict = Conclude(jump, 1.0, resolution);
  return jump;
}

JacobianJump CompareDerivatives(const RayFan& fan, const std::vector<Vector3>& derivatives)
{
  const auto derivativeOf = [&derivatives](std::size_t ray) { return derivatives[ray]; };
  JacobianJump jump;
  jump.Jump = DeviationFromLinear(fan).Largest(derivativeOf) /
    NormOfJacobian(derivatives.size(), derivativeOf);
  return jump;
}

} // namespace homeomorphism
