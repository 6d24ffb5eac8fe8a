// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "CubicBatch.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace homeomorphism
{

HOMEOMORPHISM_FOR_WIDE_VECTORS
void MapByNet(const CubicNet& net, const Vector2& origin, const double* const l[3], int begin,
  int end, double* x, double* y)
{
  const CubicNet::Component netX = net.GetX();
  const CubicNet::Component netY = net.GetY();
  const double originX = origin.x;
  const double originY = origin.y;
  const double* l0 = l[0];
  const double* l1 = l[1];
  const double* l2 = l[2];
  const int stop = begin + InWholeVectors(end - begin);
  HOMEOMORPHISM_SIMD
  for (int i = begin; i < stop; ++i)
  {
    x[i] = originX + CubicNet::Map(netX, l0[i], l1[i], l2[i]);
    y[i] = originY + CubicNet::Map(netY, l0[i], l1[i], l2[i]);
  }
}

HOMEOMORPHISM_FOR_WIDE_VECTORS
void MapMiddle(const std::array<Vector2, 3>& corners, const std::array<double, 3>& least,
  const std::array<double, 3>& greatest, const double* const l[3], int begin, int end, double* x,
  double* y, std::int64_t* isMiddle)
{
  const Vector2 origin = corners[0];
  const Vector2 first = corners[1] - origin;
  const Vector2 second = corners[2] - origin;
  const std::array<double, 3> low = least;
  const std::array<double, 3> high = greatest;
  const double* l0 = l[0];
  const double* l1 = l[1];
  const double* l2 = l[2];
  const int stop = begin + InWholeVectors(end - begin);
  HOMEOMORPHISM_SIMD
  for (int i = begin; i < stop; ++i)
  {
    const double a = l0[i];
    const double b = l1[i];
    const double c = l2[i];
    x[i] = origin.x + b * first.x + c * second.x;
    y[i] = origin.y + b * first.y + c * second.y;
    const bool isIn =
      (a > low[0]) & (a < high[0]) & (b > low[1]) & (b < high[1]) & (c > low[2]) & (c < high[2]);
    isMiddle[i] = isIn ? 1 : 0;
  }
}

namespace
{

// Half the second derivatives of an element by barycentric coordinates, divided by its least
// stretch, rarely exceed this.
constexpr double MostBending = 10.0;
constexpr int MostSteps = 12;

// Points may be outside an element by this much. The map of the neighboring element has the same
// values and derivatives on the edge, so the difference is below rounding there.
constexpr double LeastCoordinate = -1e-9;

// Farther outside, the value of the interpolant is not used.
constexpr double LeastStart = -0.3;

// The number whose mask is -1; the other masks are 0. Branch-free, so that loops vectorize.
HOMEOMORPHISM_ALWAYS_INLINE double Choose(std::int64_t isFirst, double first, std::int64_t isSecond,
  double second, std::int64_t isThird, double third)
{
  std::int64_t bits[3];
  std::memcpy(&bits[0], &first, sizeof(first));
  std::memcpy(&bits[1], &second, sizeof(second));
  std::memcpy(&bits[2], &third, sizeof(third));
  const std::int64_t chosen = (bits[0] & isFirst) | (bits[1] & isSecond) | (bits[2] & isThird);
  double number;
  std::memcpy(&number, &chosen, sizeof(number));
  return number;
}

// The derivatives of the inverse at the corners, minus those of the piecewise linear map, for the
// source's barycentric coordinates of corners 1 and 2: at corner i, towards the images of the next
// and of the previous corner.
struct InverseHermite
{
  double Next[2][3];
  double Previous[2][3];
  double Middle[2];

  explicit InverseHermite(const CubicNet& net)
  {
    const CubicNet::Component& x = net.GetX();
    const CubicNet::Component& y = net.GetY();
    this->Middle[0] = this->Middle[1] = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const int next = NextCorner(i);
      const int previous = PreviousCorner(i);
      const Vector2 corner{ x.Corner[i], y.Corner[i] };
      const Vector2 toNext = Vector2{ x.Corner[next], y.Corner[next] } - corner;
      const Vector2 toPrevious = Vector2{ x.Corner[previous], y.Corner[previous] } - corner;
      const Vector2 alongNext = Vector2{ x.Next[i], y.Next[i] } - 3.0 * corner;
      const Vector2 alongPrevious = Vector2{ x.Previous[i], y.Previous[i] } - 3.0 * corner;
      const double scale = 1.0 / Cross(alongNext, alongPrevious);
      // By corner: components of the derivatives along the two edges.
      double components[2][3] = {};
      components[0][next] = scale * Cross(toNext, alongPrevious) - 1.0;
      components[0][previous] = scale * Cross(alongNext, toNext);
      components[1][next] = scale * Cross(toPrevious, alongPrevious);
      components[1][previous] = scale * Cross(alongNext, toPrevious) - 1.0;
      for (double(&component)[3] : components)
      {
        component[i] = -component[next] - component[previous];
      }
      for (int k = 0; k < 2; ++k)
      {
        this->Next[k][i] = components[0][k + 1];
        this->Previous[k][i] = components[1][k + 1];
        this->Middle[k] += 0.5 * (components[0][k + 1] + components[1][k + 1]);
      }
    }
  }
};

} // anonymous namespace

HOMEOMORPHISM_FOR_WIDE_VECTORS
void StartByNet(const CubicNet& net, int begin, int end, CubicWalkers& walkers)
{
  const InverseHermite h(net);
  const int stop = begin + InWholeVectors(end - begin);
  HOMEOMORPHISM_SIMD
  for (int i = begin; i < stop; ++i)
  {
    const double a = walkers.L[0][i];
    const double b = walkers.L[1][i];
    const double c = walkers.L[2][i];
    const double ab = a * b;
    const double bc = b * c;
    const double ca = c * a;
    const double abc = ab * c;
    const auto change = [&](const double next[3], const double previous[3], double middle) {
      return ab * (a * next[0] + b * previous[1]) + bc * (b * next[1] + c * previous[2]) +
        ca * (c * next[2] + a * previous[0]) + abc * middle;
    };
    const double to1 = b + change(h.Next[0], h.Previous[0], h.Middle[0]);
    const double to2 = c + change(h.Next[1], h.Previous[1], h.Middle[1]);
    const double to0 = 1.0 - to1 - to2;
    const double lesser = to1 < to0 ? to1 : to0;
    const double least = to2 < lesser ? to2 : lesser;
    // Elements after the last one keep their coordinates.
    const bool isNear = (least > LeastStart) & (i < end);
    walkers.L[0][i] = isNear ? to0 : a;
    walkers.L[1][i] = isNear ? to1 : b;
    walkers.L[2][i] = isNear ? to2 : c;
    const bool isOut = isNear & (least < LeastCoordinate);
    walkers.States[i] = isOut ? CubicWalkers::Left : CubicWalkers::OnTheWay;
  }
}

namespace
{

// One step of Chebyshev's method for a vector of walkers: Newton's step with a correction by second
// derivatives.
HOMEOMORPHISM_ALWAYS_INLINE void StepVector(const CubicNet::Component& netX,
  const CubicNet::Component& netY, double tolerance, int begin, CubicWalkers& walkers)
{
  HOMEOMORPHISM_SIMD
  for (int i = begin; i < begin + WidestVector; ++i)
  {
    const double l0 = walkers.L[0][i];
    const double l1 = walkers.L[1][i];
    const double l2 = walkers.L[2][i];
    // The piece that contains the point, by the formulas of FindPiece.
    const double lesser = l1 < l0 ? l1 : l0;
    const double least = l2 < lesser ? l2 : lesser;
    const std::int64_t is2 = -std::int64_t(l2 < lesser);
    const std::int64_t is1 = -std::int64_t(l1 < l0) & ~is2;
    const std::int64_t is0 = ~(is1 | is2);
    // Select the value of corner k, and those of corners NextCorner(k) and PreviousCorner(k).
    const auto opposite = [is0, is1, is2](double of0, double of1, double of2) {
      return Choose(is0, of0, is1, of1, is2, of2);
    };
    const auto start = [is0, is1, is2](double of0, double of1, double of2) {
      return Choose(is2, of0, is0, of1, is1, of2);
    };
    const auto end = [is0, is1, is2](double of0, double of1, double of2) {
      return Choose(is1, of0, is2, of1, is0, of2);
    };
    const double atU = start(l0, l1, l2) - least;
    const double atV = end(l0, l1, l2) - least;
    const double atW = 3.0 * least;
    // The derivatives by u, v and w: quadratic forms.
    const auto derive = [&](const CubicNet::Component& b, double u, double v, double w, double& byU,
                          double& byV, double& byW) {
      const double uu = u * u;
      const double uv = u * v;
      const double vv = v * v;
      const double uw = u * w;
      const double vw = v * w;
      const double ww = w * w;
      const double next = start(b.Next[0], b.Next[1], b.Next[2]);
      const double previous = end(b.Previous[0], b.Previous[1], b.Previous[2]);
      const double middle = opposite(b.Middle[0], b.Middle[1], b.Middle[2]);
      const double innerU = start(b.Inner[0], b.Inner[1], b.Inner[2]);
      const double innerV = end(b.Inner[0], b.Inner[1], b.Inner[2]);
      const double spokeU = start(b.Spoke[0], b.Spoke[1], b.Spoke[2]);
      const double spokeV = end(b.Spoke[0], b.Spoke[1], b.Spoke[2]);
      byU = 3.0 * uu * start(b.Corner[0], b.Corner[1], b.Corner[2]) +
        2.0 * (uv * next + uw * innerU) + vv * previous + vw * middle + ww * spokeU;
      byV = 3.0 * vv * end(b.Corner[0], b.Corner[1], b.Corner[2]) +
        2.0 * (uv * previous + vw * innerV) + uu * next + uw * middle + ww * spokeV;
      byW = uu * innerU + uv * middle + vv * innerV + 2.0 * (uw * spokeU + vw * spokeV) +
        3.0 * ww * b.Center;
    };
    double xU;
    double xV;
    double xW;
    double yU;
    double yV;
    double yW;
    derive(netX, atU, atV, atW, xU, xV, xW);
    derive(netY, atU, atV, atW, yU, yV, yW);
    constexpr double third = 1.0 / 3.0;
    const double residualX = walkers.X[i] - third * (atU * xU + atV * xV + atW * xW);
    const double residualY = walkers.Y[i] - third * (atU * yU + atV * yV + atW * yW);
    const double firstX = xV - xU;
    const double firstY = yV - yU;
    const double secondX = xW - xU;
    const double secondY = yW - yU;
    const double scale = 1.0 / (firstX * secondY - firstY * secondX);
    const double newtonV = scale * (residualX * secondY - residualY * secondX);
    const double newtonW = scale * (firstX * residualY - firstY * residualX);
    const double newtonU = -newtonV - newtonW;
    const auto greatest = [](double p, double q, double r) {
      const double absP = std::abs(p);
      const double absQ = std::abs(q);
      const double absR = std::abs(r);
      const double greater = absQ > absP ? absQ : absP;
      return absR > greater ? absR : greater;
    };
    const auto measure = [&](double byV, double byW) {
      return greatest(third * byW, third * byW - byV - byW, third * byW + byV);
    };
    const double length = measure(newtonV, newtonW);
    // In the move d, the second-order residual of f is the sum of l_c times its derivative by l_c
    // at d, and the third-order residual is f at d.
    derive(netX, newtonU, newtonV, newtonW, xU, xV, xW);
    derive(netY, newtonU, newtonV, newtonW, yU, yV, yW);
    const double missX = atU * xU + atV * xV + atW * xW;
    const double missY = atU * yU + atV * yV + atW * yW;
    const double cubeX = third * (newtonU * xU + newtonV * xV + newtonW * xW);
    const double cubeY = third * (newtonU * yU + newtonV * yV + newtonW * yW);
    const double turnV = scale * (missX * secondY - missY * secondX);
    const double turnW = scale * (firstX * missY - firstY * missX);
    const double turn = measure(turnV, turnW);
    const bool isSmall = turn <= 0.5 * length;
    const double moveV = newtonV - (isSmall ? turnV : 0.0);
    const double moveW = newtonW - (isSmall ? turnW : 0.0);
    const double secondOrder = greatest(missX, missY, 0.0);
    const double thirdOrder = 2.0 * secondOrder * turn + greatest(cubeX, cubeY, 0.0) * length;
    const double moveLeast = third * moveW;
    const double moveStart = moveLeast - moveV - moveW;
    const double moveEnd = moveLeast + moveV;
    const double move0 = Choose(is0, moveLeast, is1, moveEnd, is2, moveStart);
    const double move1 = Choose(is0, moveStart, is1, moveLeast, is2, moveEnd);
    const double move2 = Choose(is0, moveEnd, is1, moveStart, is2, moveLeast);
    const double absX = std::abs(residualX);
    const double absY = std::abs(residualY);
    const double now = absX > absY ? absX : absY;
    const std::int64_t state = walkers.States[i];
    const double lastResidual = walkers.Residual[i];
    const double lastMove = walkers.Move[i];
    const bool isActive = state == CubicWalkers::OnTheWay;
    const bool isWorse = !(now < lastResidual);
    const bool isThere = now <= 0.5 * tolerance;
    // Within one piece, the residual consists mainly of terms of third order. They can be small by
    // chance, so the step must also be short compared with the element.
    const bool isInPiece =
      (atU - moveV - moveW >= 0.0) & (atV + moveV >= 0.0) & (atW + moveW >= 0.0);
    const bool isLastInPiece = isInPiece & isSmall & (thirdOrder <= 0.05 * tolerance * length) &
      (2.0 * MostBending * MostBending * now * length * length <= tolerance);
    // Across pieces, second derivatives jump. The error is then a constant times the square of the
    // length, with about the constant of the last step.
    const double known = walkers.SecondOrder[i];
    const double missed = now > known ? now : known;
    const bool isLastAcross = (missed * length * length <= 0.05 * tolerance * lastMove * lastMove) &
      (MostBending * now * length <= tolerance) & (lastMove > 0.0);
    const bool isLast = isLastInPiece | isLastAcross;
    const double to0 = l0 + move0;
    const double to1 = l1 + move1;
    const double to2 = l2 + move2;
    const double lesserTo = to1 < to0 ? to1 : to0;
    const bool isOut = (to2 < lesserTo ? to2 : lesserTo) < LeastCoordinate;
    const bool moves = isActive & !isWorse & !isThere;
    walkers.L[0][i] = moves ? to0 : l0;
    walkers.L[1][i] = moves ? to1 : l1;
    walkers.L[2][i] = moves ? to2 : l2;
    walkers.Residual[i] = isActive & !isWorse ? now : lastResidual;
    walkers.Move[i] = moves ? length : lastMove;
    walkers.SecondOrder[i] = moves ? secondOrder : known;
    const std::int64_t next = isOut ? std::int64_t(CubicWalkers::Left)
      : isLast                      ? std::int64_t(CubicWalkers::Found)
                                    : std::int64_t(CubicWalkers::OnTheWay);
    const std::int64_t outcome = isWorse ? std::int64_t(CubicWalkers::Failed)
      : isThere                          ? std::int64_t(CubicWalkers::Found)
                                         : next;
    walkers.States[i] = isActive ? outcome : state;
  }
}

} // anonymous namespace

// Moves all walkers that are on the way by one step. Returns whether any is still on the way.
HOMEOMORPHISM_FOR_WIDE_VECTORS
static bool StepByNet(
  const CubicNet& net, double tolerance, int begin, int stop, CubicWalkers& walkers)
{
  const auto isAnyOnTheWay = [&walkers](int at) {
    bool isAny = false;
    for (int i = at; i < at + WidestVector; ++i)
    {
      isAny |= walkers.States[i] == CubicWalkers::OnTheWay;
    }
    return isAny;
  };
  bool isAny = false;
  for (int at = begin; at < stop; at += WidestVector)
  {
    if (!isAnyOnTheWay(at))
    {
      continue;
    }
    StepVector(net.GetX(), net.GetY(), tolerance, at, walkers);
    isAny |= isAnyOnTheWay(at);
  }
  return isAny;
}

void WalkByNet(const CubicNet& net, double tolerance, int begin, int end, CubicWalkers& walkers)
{
  // Stop the walkers after the last one meanwhile.
  const int stop = begin + InWholeVectors(end - begin);
  std::int64_t states[WidestVector];
  std::copy(walkers.States + end, walkers.States + stop, states);
  std::fill(walkers.States + end, walkers.States + stop, CubicWalkers::Failed);
  bool isAny = true;
  for (int step = 0; step < MostSteps && isAny; ++step)
  {
    isAny = StepByNet(net, tolerance, begin, stop, walkers);
  }
  std::copy(states, states + (stop - end), walkers.States + end);
}

} // namespace homeomorphism
