// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "CubicBatch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

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

HOMEOMORPHISM_FOR_WIDE_VECTORS
void MapByCorners(const std::array<Vector2, 3>& corners, const Vector2& origin,
  const double* const l[3], int count, double* x, double* y)
{
  const Vector2 at = origin;
  const Vector2 first = corners[1];
  const Vector2 second = corners[2];
  const double* l1 = l[1];
  const double* l2 = l[2];
  HOMEOMORPHISM_SIMD
  for (int i = 0; i < count; ++i)
  {
    x[i] = at.x + (l1[i] * first.x + l2[i] * second.x);
    y[i] = at.y + (l1[i] * first.y + l2[i] * second.y);
  }
}

namespace
{

// Half the second derivatives of an element by barycentric coordinates, divided by its least
// stretch, rarely exceed this.
constexpr double MostBending = 10.0;
constexpr int MostRounds = 6;

// Points may be outside an element by this much. The map of the neighboring element has the same
// values and derivatives on the edge, so the difference is below rounding there.
constexpr double LeastCoordinate = -1e-9;

// Rounding errors of barycentric coordinates.
constexpr double Rounding = 8.0 * std::numeric_limits<double>::epsilon();

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

// The difference of the interpolant and the piecewise linear map, for one barycentric coordinate of
// the source, at barycentric coordinates of the target.
template <typename Real>
HOMEOMORPHISM_ALWAYS_INLINE double Change(
  const InverseInterpolant::Component<Real>& of, double a, double b, double c)
{
  const double ab = a * b;
  const double bc = b * c;
  const double ca = c * a;
  return ab * (a * of.Next[0] + b * of.Previous[1] + ab * of.Edge[2]) +
    bc * (b * of.Next[1] + c * of.Previous[2] + bc * of.Edge[0]) +
    ca * (c * of.Next[2] + a * of.Previous[0] + ca * of.Edge[1]) + ab * c * of.Middle;
}

struct Interpolant
{
  InverseInterpolant::Component<double> Components[2];

  explicit Interpolant(const InverseInterpolant& inverse)
  {
    for (int k = 0; k < 2; ++k)
    {
      const InverseInterpolant::Component<float>& of = inverse.Components[k];
      std::copy_n(of.Next, 3, this->Components[k].Next);
      std::copy_n(of.Previous, 3, this->Components[k].Previous);
      std::copy_n(of.Edge, 3, this->Components[k].Edge);
      this->Components[k].Middle = of.Middle;
    }
  }
};

// StartWalkers for one vector.
HOMEOMORPHISM_ALWAYS_INLINE void StartVector(const Interpolant& inverse, const Vector2& origin,
  const double* const l[3], const double* x, const double* y, std::int64_t at, std::int64_t count,
  std::int64_t begin, CubicWalkers& walkers)
{
  HOMEOMORPHISM_SIMD
  for (std::int64_t lane = 0; lane < WidestVector; ++lane)
  {
    const std::int64_t from = at + lane;
    const std::int64_t to = begin + at + lane;
    const double a = l[0][from];
    const double b = l[1][from];
    const double c = l[2][from];
    const double to1 = b + Change(inverse.Components[0], a, b, c);
    const double to2 = c + Change(inverse.Components[1], a, b, c);
    const double to0 = 1.0 - to1 - to2;
    const double lesser = to1 < to0 ? to1 : to0;
    const double least = to2 < lesser ? to2 : lesser;
    const bool isNear = least > LeastStart;
    walkers.L[0][to] = isNear ? to0 : a;
    walkers.L[1][to] = isNear ? to1 : b;
    walkers.L[2][to] = isNear ? to2 : c;
    walkers.X[to] = x[from] - origin.x;
    walkers.Y[to] = y[from] - origin.y;
    const bool isOut = isNear & (least < LeastCoordinate);
    const std::int64_t state =
      isOut ? std::int64_t(CubicWalkers::Left) : std::int64_t(CubicWalkers::OnTheWay);
    walkers.States[to] = from < count ? state : std::int64_t(CubicWalkers::Found);
  }
}

} // anonymous namespace

InverseInterpolant::InverseInterpolant(const CubicNet& net)
{
  const CubicNet::Component& x = net.GetX();
  const CubicNet::Component& y = net.GetY();
  std::array<Component<double>, 2> found = {};
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
    // The derivatives of the inverse towards the images of both other corners, minus those of the
    // piecewise linear map.
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
      found[k].Next[i] = components[0][k + 1];
      found[k].Previous[i] = components[1][k + 1];
      found[k].Middle += 0.5 * (components[0][k + 1] + components[1][k + 1]);
    }
  }
  // The points 0 to 2 are the middles of the edges, point 3 is the centroid.
  const Vector2 origin{ x.Corner[0], y.Corner[0] };
  const Vector2 first = Vector2{ x.Corner[1], y.Corner[1] } - origin;
  const Vector2 second = Vector2{ x.Corner[2], y.Corner[2] } - origin;
  const double scale = 1.0 / Cross(first, second);
  double images[4][3];
  for (int n = 0; n < 4; ++n)
  {
    const int start = NextCorner(n);
    const int end = PreviousCorner(n);
    const auto map = [n, start, end](const CubicNet::Component& b) {
      return n == 3 ? b.Center
                    : 0.125 * (b.Corner[start] + b.Next[start] + b.Previous[end] + b.Corner[end]);
    };
    const Vector2 image = Vector2{ map(x), map(y) } - origin;
    images[n][1] = scale * Cross(image, second);
    images[n][2] = scale * Cross(first, image);
    images[n][0] = 1.0 - images[n][1] - images[n][2];
  }
  // The term of one point is small at the others, so that two sweeps are enough.
  for (int sweep = 0; sweep < 2; ++sweep)
  {
    for (int n = 0; n < 4; ++n)
    {
      const auto [a, b, c] = images[n];
      for (int k = 0; k < 2; ++k)
      {
        Component<double>& of = found[k];
        const double coordinate = n == 3 ? 1.0 / 3.0 : n == k + 1 ? 0.0 : 0.5;
        const double error = coordinate - images[n][k + 1] - Change(of, a, b, c);
        const double product = n == 0 ? b * c : n == 1 ? c * a : a * b;
        (n == 3 ? of.Middle : of.Edge[n]) += error / (product * (n == 3 ? c : product));
      }
    }
  }
  for (int k = 0; k < 2; ++k)
  {
    for (int i = 0; i < 3; ++i)
    {
      this->Components[k].Next[i] = static_cast<float>(found[k].Next[i]);
      this->Components[k].Previous[i] = static_cast<float>(found[k].Previous[i]);
      this->Components[k].Edge[i] = static_cast<float>(found[k].Edge[i]);
    }
    this->Components[k].Middle = static_cast<float>(found[k].Middle);
  }
}

HOMEOMORPHISM_FOR_WIDE_VECTORS
bool StartWalkers(const InverseInterpolant& inverse, const Vector2& origin,
  const double* const l[3], const double* x, const double* y, int count, int begin,
  CubicWalkers& walkers)
{
  const Interpolant interpolant(inverse);
  for (int at = 0; at < count; at += WidestVector)
  {
    StartVector(interpolant, origin, l, x, y, at, count, begin, walkers);
  }
  std::int64_t greatest = CubicWalkers::OnTheWay;
  for (int i = begin; i < begin + InWholeVectors(count); ++i)
  {
    // The elements after the last one are Found.
    greatest = std::max(greatest, walkers.States[i]);
  }
  return greatest <= CubicWalkers::Found;
}

namespace
{

// One component of an element as a polynomial in d1 = l1 - l0 and d2 = l2 - l0, which are 0 at the
// centroid. The second derivatives of the three pieces agree there, so that only the terms of third
// degree depend on the piece.
struct CentroidComponent
{
  double Value;
  double By1;
  double By2;
  double By11;
  double By12;
  double By22;
  // By the piece's opposite corner: the factors of d1^3 / 3, d1^2 d2, d1 d2^2 and d2^3 / 3.
  double By111[3];
  double By112[3];
  double By122[3];
  double By222[3];

  CentroidComponent() = default;
  explicit CentroidComponent(const CubicNet::Component& b)
  {
    const double z = b.Center;
    this->Value = z;
    this->By1 = b.Spoke[1] - 3.0 * z;
    this->By2 = b.Spoke[2] - 3.0 * z;
    this->By11 = b.Inner[1] - 2.0 * b.Spoke[1] + 3.0 * z;
    this->By12 = b.Middle[0] - 2.0 * (b.Spoke[1] + b.Spoke[2]) + 6.0 * z;
    this->By22 = b.Inner[2] - 2.0 * b.Spoke[2] + 3.0 * z;
    double cube[3];
    for (int i = 0; i < 3; ++i)
    {
      cube[i] = b.Corner[i] - b.Inner[i] + b.Spoke[i] - z;
    }
    // In piece k, the terms are e u^3 + f u^2 v + g u v^2 + h v^3 with u = l_i - l_k, v = l_j -
    // l_k.
    double f[3];
    double g[3];
    for (int k = 0; k < 3; ++k)
    {
      const int i = NextCorner(k);
      const int j = PreviousCorner(k);
      const double shared = b.Middle[k] - b.Spoke[i] - b.Spoke[j] + 3.0 * z;
      f[k] = b.Next[i] - b.Inner[i] - shared + b.Spoke[i];
      g[k] = b.Previous[j] - b.Inner[j] - shared + b.Spoke[j];
    }
    // u = d1 and v = d2.
    this->By111[0] = 3.0 * cube[1];
    this->By112[0] = f[0];
    this->By122[0] = g[0];
    this->By222[0] = 3.0 * cube[2];
    // u = d2 - d1 and v = -d1.
    this->By111[1] = -3.0 * (cube[2] + f[1] + g[1] + cube[0]);
    this->By112[1] = 3.0 * cube[2] + 2.0 * f[1] + g[1];
    this->By122[1] = -3.0 * cube[2] - f[1];
    this->By222[1] = 3.0 * cube[2];
    // u = -d2 and v = d1 - d2.
    this->By111[2] = 3.0 * cube[1];
    this->By112[2] = -3.0 * cube[1] - g[2];
    this->By122[2] = 3.0 * cube[1] + 2.0 * g[2] + f[2];
    this->By222[2] = -3.0 * (cube[0] + f[2] + g[2] + cube[1]);
  }
};

// An element in the form that is fastest to invert.
struct CentroidForm
{
  CentroidComponent X;
  CentroidComponent Y;

  CentroidForm() = default;
  explicit CentroidForm(const CubicNet& net)
    : X(net.GetX())
    , Y(net.GetY())
  {
  }
};

constexpr double Third = 1.0 / 3.0;

HOMEOMORPHISM_ALWAYS_INLINE double Greater(double p, double q)
{
  const double absP = std::abs(p);
  const double absQ = std::abs(q);
  return absQ > absP ? absQ : absP;
}

// A component's value and derivatives at a walker.
struct ComponentAtWalker
{
  double Value;
  double By1;
  double By2;
  // The second derivatives, of which two are halved.
  double Half11;
  double By12;
  double Half22;
  double By111;
  double By112;
  double By122;
  double By222;

  HOMEOMORPHISM_ALWAYS_INLINE ComponentAtWalker(const CentroidComponent& of, std::int64_t is0,
    std::int64_t is1, std::int64_t is2, double d1, double d2)
  {
    this->By111 = Choose(is0, of.By111[0], is1, of.By111[1], is2, of.By111[2]);
    this->By112 = Choose(is0, of.By112[0], is1, of.By112[1], is2, of.By112[2]);
    this->By122 = Choose(is0, of.By122[0], is1, of.By122[1], is2, of.By122[2]);
    this->By222 = Choose(is0, of.By222[0], is1, of.By222[1], is2, of.By222[2]);
    // Half the second derivatives are of degree 1.
    const double linear11 = this->By111 * d1 + this->By112 * d2;
    const double linear12 = this->By112 * d1 + this->By122 * d2;
    const double linear22 = this->By122 * d1 + this->By222 * d2;
    this->Half11 = of.By11 + linear11;
    this->By12 = of.By12 + 2.0 * linear12;
    this->Half22 = of.By22 + linear22;
    // The derivatives: of the terms of second and of third degree.
    const double second1 = 2.0 * of.By11 * d1 + of.By12 * d2;
    const double second2 = of.By12 * d1 + 2.0 * of.By22 * d2;
    const double third1 = linear11 * d1 + linear12 * d2;
    const double third2 = linear12 * d1 + linear22 * d2;
    this->By1 = of.By1 + second1 + third1;
    this->By2 = of.By2 + second2 + third2;
    this->Value = of.Value + d1 * (of.By1 + 0.5 * second1 + Third * third1) +
      d2 * (of.By2 + 0.5 * second2 + Third * third2);
  }

  // What a move changes beyond the derivatives times the move.
  HOMEOMORPHISM_ALWAYS_INLINE double GetRest(double move1, double move2) const
  {
    return move1 * move1 * (this->Half11 + Third * this->By111 * move1 + this->By112 * move2) +
      move1 * move2 * this->By12 +
      move2 * move2 * (this->Half22 + this->By122 * move1 + Third * this->By222 * move2);
  }
};

// Newton's step of a walker, in d1 and d2.
struct NewtonStep
{
  ComponentAtWalker X;
  ComponentAtWalker Y;
  // The inverse of the derivative.
  double Inverse1X;
  double Inverse1Y;
  double Inverse2X;
  double Inverse2Y;
  double Move1;
  double Move2;
  // The greater component of the residual.
  double Residual;

  static HOMEOMORPHISM_ALWAYS_INLINE NewtonStep Find(
    const CentroidForm& net, double l0, double l1, double l2, double imageX, double imageY)
  {
    // The piece opposite the corner with the least coordinate, as in FindPiece.
    const double lesser = l1 < l0 ? l1 : l0;
    const std::int64_t is2 = -std::int64_t(l2 < lesser);
    const std::int64_t is1 = -std::int64_t(l1 < l0) & ~is2;
    const std::int64_t is0 = ~(is1 | is2);
    const double d1 = l1 - l0;
    const double d2 = l2 - l0;
    NewtonStep step{ { net.X, is0, is1, is2, d1, d2 }, { net.Y, is0, is1, is2, d1, d2 }, 0.0, 0.0,
      0.0, 0.0, 0.0, 0.0, 0.0 };
    const double residualX = imageX - step.X.Value;
    const double residualY = imageY - step.Y.Value;
    const double scale = 1.0 / (step.X.By1 * step.Y.By2 - step.Y.By1 * step.X.By2);
    step.Inverse1X = scale * step.Y.By2;
    step.Inverse1Y = -scale * step.X.By2;
    step.Inverse2X = -scale * step.Y.By1;
    step.Inverse2Y = scale * step.X.By1;
    step.Move1 = residualX * step.Inverse1X + residualY * step.Inverse1Y;
    step.Move2 = residualX * step.Inverse2X + residualY * step.Inverse2Y;
    step.Residual = Greater(residualX, residualY);
    return step;
  }
};

// Where a move in d1 and d2 leads a walker.
struct WalkerMove
{
  double L0;
  double L1;
  double L2;
  bool IsOut;

  HOMEOMORPHISM_ALWAYS_INLINE WalkerMove(
    double l0, double l1, double l2, double move1, double move2)
  {
    const double move0 = -Third * (move1 + move2);
    this->L0 = l0 + move0;
    this->L1 = l1 + (move0 + move1);
    this->L2 = l2 + (move0 + move2);
    const double lesser = this->L1 < this->L0 ? this->L1 : this->L0;
    this->IsOut = (this->L2 < lesser ? this->L2 : lesser) < LeastCoordinate;
  }
};

// Two moves of a walker: the first by Newton's step, corrected until also the terms of second and
// third degree nearly vanish; the second by Newton's step, where that is accurate enough.
struct WalkerSteps
{
  const CentroidForm& Net;
  double L0;
  double L1;
  double L2;
  double ImageX;
  double ImageY;
  NewtonStep First;
  double Move1;
  double Move2;
  double Missed;
  double Turn;

  HOMEOMORPHISM_ALWAYS_INLINE WalkerSteps(
    const CentroidForm& net, const CubicWalkers& walkers, int i)
    : Net(net)
    , L0(walkers.L[0][i])
    , L1(walkers.L[1][i])
    , L2(walkers.L[2][i])
    , ImageX(walkers.X[i])
    , ImageY(walkers.Y[i])
    , First(NewtonStep::Find(net, this->L0, this->L1, this->L2, this->ImageX, this->ImageY))
    , Move1(First.Move1)
    , Move2(First.Move2)
  {
  }

  HOMEOMORPHISM_ALWAYS_INLINE void Correct(bool isFirst)
  {
    const double restX = this->First.X.GetRest(this->Move1, this->Move2);
    const double restY = this->First.Y.GetRest(this->Move1, this->Move2);
    const double turn1 = restX * this->First.Inverse1X + restY * this->First.Inverse1Y;
    const double turn2 = restX * this->First.Inverse2X + restY * this->First.Inverse2Y;
    if (isFirst)
    {
      this->Missed = Greater(restX, restY);
    }
    this->Turn = Greater(turn1, turn2);
    this->Move1 = this->First.Move1 - turn1;
    this->Move2 = this->First.Move2 - turn2;
  }

  HOMEOMORPHISM_ALWAYS_INLINE void Finish(double tolerance, CubicWalkers& walkers, int i)
  {
    const double firstLength = Greater(this->First.Move1, this->First.Move2);
    const bool isSmall = this->Turn <= 0.5 * firstLength;
    const WalkerMove to(this->L0, this->L1, this->L2, isSmall ? this->Move1 : this->First.Move1,
      isSmall ? this->Move2 : this->First.Move2);
    const NewtonStep second =
      NewtonStep::Find(this->Net, to.L0, to.L1, to.L2, this->ImageX, this->ImageY);
    const double length = Greater(second.Move1, second.Move2);
    const double now = second.Residual;
    const WalkerMove last(to.L0, to.L1, to.L2, second.Move1, second.Move2);
    const bool isThere = now <= 0.5 * tolerance;
    // The residual of Newton's step is a constant times the square of its length, with about the
    // constant of the first step. Steps that are as short as rounding errors are the last, too.
    const double constant = now > this->Missed ? now : this->Missed;
    const bool isAccurate =
      (constant * length * length <= 0.05 * tolerance * firstLength * firstLength) &
      (MostBending * now * length <= tolerance);
    const bool isLast = (isAccurate | (length <= Rounding)) & !to.IsOut;
    const bool isOut = to.IsOut | (isLast & last.IsOut);
    const double end0 = isLast ? last.L0 : to.L0;
    const double end1 = isLast ? last.L1 : to.L1;
    const double end2 = isLast ? last.L2 : to.L2;
    const std::int64_t state = walkers.States[i];
    const bool isActive = state == CubicWalkers::OnTheWay;
    walkers.L[0][i] = isActive ? end0 : this->L0;
    walkers.L[1][i] = isActive ? end1 : this->L1;
    walkers.L[2][i] = isActive ? end2 : this->L2;
    const std::int64_t better = now < this->First.Residual ? std::int64_t(CubicWalkers::OnTheWay)
                                                           : std::int64_t(CubicWalkers::Failed);
    const std::int64_t inside = (isThere | isLast) ? std::int64_t(CubicWalkers::Found) : better;
    const std::int64_t outcome = isOut ? std::int64_t(CubicWalkers::Left) : inside;
    walkers.States[i] = isActive ? outcome : state;
  }
};

// Moves one vector of walkers.
HOMEOMORPHISM_ALWAYS_INLINE void MoveVector(
  const CentroidForm& net, int begin, double tolerance, CubicWalkers& walkers)
{
  HOMEOMORPHISM_SIMD
  for (int i = begin; i < begin + WidestVector; ++i)
  {
    WalkerSteps steps(net, walkers, i);
    steps.Correct(true);
    steps.Correct(false);
    steps.Finish(tolerance, walkers, i);
  }
}

// Moves two vectors of walkers by turns: one is computed while the other waits for results.
HOMEOMORPHISM_ALWAYS_INLINE void MoveVectors(const CentroidForm& firstNet, int firstBegin,
  const CentroidForm& secondNet, int secondBegin, double tolerance, CubicWalkers& walkers)
{
  HOMEOMORPHISM_SIMD
  for (int lane = 0; lane < WidestVector; ++lane)
  {
    WalkerSteps first(firstNet, walkers, firstBegin + lane);
    WalkerSteps second(secondNet, walkers, secondBegin + lane);
    first.Correct(true);
    second.Correct(true);
    first.Correct(false);
    second.Correct(false);
    first.Finish(tolerance, walkers, firstBegin + lane);
    second.Finish(tolerance, walkers, secondBegin + lane);
  }
}

struct WalkerVector
{
  int Run;
  int Begin;
};

} // anonymous namespace

HOMEOMORPHISM_FOR_WIDE_VECTORS
void IterateWalkers(CubicRun* runs, int numberOfRuns, double tolerance, CubicWalkers& walkers)
{
  CentroidForm nets[CubicWalkers::Size / WidestVector];
  WalkerVector vectors[CubicWalkers::Size / WidestVector];
  int count = 0;
  for (int run = 0; run < numberOfRuns; ++run)
  {
    nets[run] = CentroidForm(*runs[run].Net);
    runs[run].AreFound = true;
    for (int at = runs[run].Begin; at < runs[run].End; at += WidestVector)
    {
      vectors[count++] = { run, at };
    }
  }
  for (int round = 0; round < MostRounds && count > 0; ++round)
  {
    int n = 0;
    for (; n + 1 < count; n += 2)
    {
      const auto [firstRun, firstBegin] = vectors[n];
      const auto [secondRun, secondBegin] = vectors[n + 1];
      MoveVectors(nets[firstRun], firstBegin, nets[secondRun], secondBegin, tolerance, walkers);
    }
    if (n < count)
    {
      MoveVector(nets[vectors[n].Run], vectors[n].Begin, tolerance, walkers);
    }
    int remaining = 0;
    for (n = 0; n < count; ++n)
    {
      const auto [run, begin] = vectors[n];
      std::int64_t least = CubicWalkers::Failed;
      std::int64_t greatest = CubicWalkers::OnTheWay;
      for (int i = begin; i < begin + WidestVector; ++i)
      {
        least = std::min(least, walkers.States[i]);
        greatest = std::max(greatest, walkers.States[i]);
      }
      runs[run].AreFound &= greatest <= CubicWalkers::Found;
      vectors[remaining] = vectors[n];
      remaining += least == CubicWalkers::OnTheWay ? 1 : 0;
    }
    count = remaining;
  }
  for (int n = 0; n < count; ++n)
  {
    runs[vectors[n].Run].AreFound = false;
  }
}

} // namespace homeomorphism
