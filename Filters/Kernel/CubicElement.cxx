// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Kernel/CubicElement.h"

#include "Kernel/RunningError.h"

#include <algorithm>

namespace homeomorphism
{
namespace
{

// The same formulas are used for doubles and for doubles with error bounds.
template <typename T>
struct Vector
{
  T x;
  T y;

  Vector() = default;
  Vector(T a, T b)
    : x(a)
    , y(b)
  {
  }
  explicit Vector(const Vector2& v)
    : x(v.x)
    , y(v.y)
  {
  }
};

template <typename T>
Vector<T> operator+(const Vector<T>& a, const Vector<T>& b)
{
  return { a.x + b.x, a.y + b.y };
}

template <typename T>
Vector<T> operator-(const Vector<T>& a, const Vector<T>& b)
{
  return { a.x - b.x, a.y - b.y };
}

template <typename T>
Vector<T> operator*(const T& s, const Vector<T>& a)
{
  return { s * a.x, s * a.y };
}

template <typename T>
T Cross(const Vector<T>& a, const Vector<T>& b)
{
  return a.x * b.y - a.y * b.x;
}

template <typename T>
T Dot(const Vector<T>& a, const Vector<T>& b)
{
  return a.x * b.x + a.y * b.y;
}

template <typename T>
Vector<T> Apply(const Matrix2& m, const Vector<T>& v)
{
  return { T(m.ImageOfX.x) * v.x + T(m.ImageOfY.x) * v.y,
    T(m.ImageOfX.y) * v.x + T(m.ImageOfY.y) * v.y };
}

// The corners of an element and the derivatives of D there, in the axes of the plane or in the
// frame of the right angle. In a thin element, coordinates of the plane would round the direction
// of the short leg.
struct ElementFrame
{
  std::array<Vector2, 3> Points;
  /// The derivatives along the axes.
  std::array<Matrix2, 3> Gradients;

  explicit ElementFrame(const CubicElement& element)
    : Points(element.Points)
    , Gradients(element.Gradients)
  {
    const RightAngle& right = element.Right;
    for (int i = 0; i < 3 && right.Corner >= 0; ++i)
    {
      this->Points[i] = { i == right.Start ? -right.AlongTangent : 0.0,
        i == right.Start || i == right.Corner ? 0.0 : right.AlongNormal };
      this->Gradients[i] = { right.ByTangent[i], right.ByNormal[i] };
    }
  }
};

// A matrix by the images of two axes: the plane's, or those of a right angle.
template <typename T>
struct Matrix
{
  Vector<T> First;
  Vector<T> Second;
};

template <typename T>
Matrix<T> operator+(const Matrix<T>& a, const Matrix<T>& b)
{
  return { a.First + b.First, a.Second + b.Second };
}

template <typename T>
Matrix<T> operator-(const Matrix<T>& a, const Matrix<T>& b)
{
  return { a.First - b.First, a.Second - b.Second };
}

template <typename T>
Matrix<T> operator*(const T& s, const Matrix<T>& m)
{
  return { s * m.First, s * m.Second };
}

// The Bernstein ordinates of D', which is continuous and quadratic in each piece: at the corners,
// in the middle of the edges, in the middle of the segments from the corners to the centroid, and
// at the centroid.
template <typename T>
struct DerivativeOrdinates
{
  std::array<Matrix<T>, 3> Corner;
  std::array<Matrix<T>, 3> Edge;
  std::array<Matrix<T>, 3> Spoke;
  Matrix<T> Center;
};

template <typename T>
void FinishDerivative(DerivativeOrdinates<T>& d)
{
  d.Center = T(1.0) / T(3.0) * (d.Spoke[0] + d.Spoke[1] + d.Spoke[2]);
}

// In the middle of an edge, the ordinate E of D' maps the edge to that of the derivative of a cubic
// and the normal to the mean of the normal derivatives at the ends. The ordinate S beside a corner
// i satisfies S e = G_i e + (E - G_i) o for both edges e at i, where o is the vector from i to the
// centroid.
template <typename T>
DerivativeOrdinates<T> MakeDerivative(const CubicElement& element)
{
  const T half(0.5);
  const auto apply = [](const Matrix<T>& m, const Vector<T>& v) {
    return v.x * m.First + v.y * m.Second;
  };
  DerivativeOrdinates<T> d;
  for (int i = 0; i < 3; ++i)
  {
    d.Corner[i] = { Vector<T>(element.Gradients[i].ImageOfX),
      Vector<T>(element.Gradients[i].ImageOfY) };
  }
  std::array<Vector<T>, 3> edges;
  for (int k = 0; k < 3; ++k)
  {
    const int i = NextCorner(k);
    const int j = PreviousCorner(k);
    const Vector<T> edge = Vector<T>(element.Points[j]) - Vector<T>(element.Points[i]);
    edges[k] = edge;
    const Matrix<T> sum = d.Corner[i] + d.Corner[j];
    const Vector<T> difference = Vector<T>(element.Values[j]) - Vector<T>(element.Values[i]);
    const Vector<T> bend =
      T(1.0) / Dot(edge, edge) * (T(3.0) * difference - T(1.5) * apply(sum, edge));
    d.Edge[k] = half * sum + Matrix<T>{ edge.x * bend, edge.y * bend };
  }
  const T area = edges[0].x * edges[1].y - edges[0].y * edges[1].x;
  const T third = T(1.0) / T(3.0);
  for (int i = 0; i < 3; ++i)
  {
    const Vector<T> next = edges[PreviousCorner(i)];
    const Vector<T> previous = T(-1.0) * edges[NextCorner(i)];
    const Vector<T> inward = third * (next + previous);
    const Vector<T> first = apply(d.Edge[PreviousCorner(i)] - d.Corner[i], inward);
    const Vector<T> second = apply(d.Edge[NextCorner(i)] - d.Corner[i], inward);
    const T scale = T(1.0) / area;
    d.Spoke[i] = d.Corner[i] +
      Matrix<T>{ scale * (previous.y * first - next.y * second),
        scale * (next.x * second - previous.x * first) };
  }
  FinishDerivative(d);
  return d;
}

// MakeDerivative, simplified by hand for the frame of a right angle. P is the start, R the corner
// with the right angle, S the third corner, and mu = |RS| / |PR|. In a thin triangle, differences
// would be divided by the small mu, so their terms are divided before they are subtracted.
template <typename T>
DerivativeOrdinates<T> MakeRightDerivative(const CubicElement& element)
{
  const RightAngle& right = element.Right;
  const int p = right.Start;
  const int r = right.Corner;
  const int s = 3 - p - r;
  const T half(0.5);
  const T third = T(1.0) / T(3.0);
  const T mu = T(right.AlongNormal) / T(right.AlongTangent);
  DerivativeOrdinates<T> d;
  for (int i = 0; i < 3; ++i)
  {
    d.Corner[i] = { Vector<T>(right.ByTangent[i]), Vector<T>(right.ByNormal[i]) };
  }
  const Vector<T>& aP = d.Corner[p].First;
  const Vector<T>& bP = d.Corner[p].Second;
  const Vector<T>& aR = d.Corner[r].First;
  const Vector<T>& bR = d.Corner[r].Second;
  const Vector<T>& aS = d.Corner[s].First;
  const Vector<T>& bS = d.Corner[s].Second;
  const Vector<T> alongLeg =
    T(1.0) / T(right.AlongTangent) * (Vector<T>(element.Values[r]) - Vector<T>(element.Values[p]));
  const Vector<T> alongOther =
    T(1.0) / T(right.AlongNormal) * (Vector<T>(element.Values[s]) - Vector<T>(element.Values[r]));
  Matrix<T>& pr = d.Edge[s];
  Matrix<T>& rs = d.Edge[p];
  Matrix<T>& ps = d.Edge[r];
  pr = { T(3.0) * alongLeg - (aP + aR), half * (bP + bR) };
  rs = { half * (aR + aS), T(3.0) * alongOther - (bR + bS) };
  const Vector<T> a = aP + aS;
  const Vector<T> b = bP + bS;
  const T scale = T(1.0) / (T(1.0) + mu * mu);
  // (ps - pr) along the tangent, divided by mu.
  const Vector<T> turn = T(1.0) / mu * (aR - aS) +
    scale * (T(1.5) * (mu * a - b) + T(3.0) * (alongOther - mu * alongLeg));
  ps.First = pr.First + mu * turn;
  ps.Second =
    half * b + mu * scale * (T(3.0) * (alongLeg + mu * alongOther) - T(1.5) * (a + mu * b));
  d.Spoke[p] = d.Corner[p] +
    Matrix<T>{ T(2.0) * third * (pr.First - aP) + mu * third * (pr.Second - bP),
      T(2.0) * third * turn + third * (ps.Second - pr.Second) };
  const Vector<T> lean = half * third / mu * (aS - aR);
  d.Spoke[r] = d.Corner[r] +
    Matrix<T>{ third * (pr.First - aR) - mu * third * (pr.Second - bR),
      third * (rs.Second - bR) - lean };
  d.Spoke[s] = d.Corner[s] +
    Matrix<T>{ third * (ps.First - rs.First) + T(2.0) * mu * third * (ps.Second - rs.Second),
      T(2.0) * third * (rs.Second - bS) - lean };
  FinishDerivative(d);
  return d;
}

constexpr int QuadraticWeights[6][3] = { { 2, 0, 0 }, { 1, 1, 0 }, { 0, 2, 0 }, { 1, 0, 1 },
  { 0, 1, 1 }, { 0, 0, 2 } };
constexpr double QuadraticMultiplicity[6] = { 1.0, 2.0, 1.0, 2.0, 2.0, 1.0 };

// Rows have equal exponents of the centroid, so a row is a polynomial on the edge.
constexpr int QuarticNumber(int end, int centroid)
{
  return 5 * centroid - centroid * (centroid - 1) / 2 + end;
}

std::array<QuarticIndex, 15> MakeQuarticIndices()
{
  std::array<QuarticIndex, 15> indices{};
  for (int centroid = 0; centroid <= 4; ++centroid)
  {
    for (int end = 0; end + centroid <= 4; ++end)
    {
      indices[QuarticNumber(end, centroid)] = { 4 - end - centroid, end, centroid };
    }
  }
  return indices;
}

double QuarticMultiplicity(const QuarticIndex& index)
{
  constexpr double factorial[5] = { 1.0, 1.0, 2.0, 6.0, 24.0 };
  return 24.0 / (factorial[index.Start] * factorial[index.End] * factorial[index.Centroid]);
}

template <typename T>
void MakeDeterminant(const CubicElement& element, std::array<T, 45>& coefficients)
{
  const bool isRight = element.Right.Corner >= 0;
  const DerivativeOrdinates<T> d =
    isRight ? MakeRightDerivative<T>(element) : MakeDerivative<T>(element);
  Matrix<T> affine{ Vector<T>(element.Affine.ImageOfX), Vector<T>(element.Affine.ImageOfY) };
  T sign(1.0);
  if (isRight)
  {
    affine = { Apply(element.Affine, Vector<T>(element.Right.Tangent)),
      Apply(element.Affine, Vector<T>(element.Right.Normal)) };
    sign = T(Cross(element.Right.Tangent, element.Right.Normal) > 0.0 ? 1.0 : -1.0);
  }
  const std::array<QuarticIndex, 15>& indices = QuarticIndices();
  for (int k = 0; k < 3; ++k)
  {
    const int i = NextCorner(k);
    const int j = PreviousCorner(k);
    const Matrix<T> ordinates[6] = { affine + d.Corner[i], affine + d.Edge[k], affine + d.Corner[j],
      affine + d.Spoke[i], affine + d.Spoke[j], affine + d.Center };
    T sums[15] = {};
    for (int m = 0; m < 6; ++m)
    {
      for (int n = 0; n < 6; ++n)
      {
        const int end = QuadraticWeights[m][1] + QuadraticWeights[n][1];
        const int centroid = QuadraticWeights[m][2] + QuadraticWeights[n][2];
        T& sum = sums[QuarticNumber(end, centroid)];
        sum = sum +
          T(QuadraticMultiplicity[m] * QuadraticMultiplicity[n]) *
            Cross(ordinates[m].First, ordinates[n].Second);
      }
    }
    for (int n = 0; n < 15; ++n)
    {
      coefficients[15 * k + n] = sign * sums[n] / T(QuarticMultiplicity(indices[n]));
    }
  }
}

using Quartic = std::array<RunningError, 15>;

// Bisects a quartic triangle from the middle of its edge from start to end to the third corner.
// Numbers the corners of the halves so that another edge is bisected next.
std::array<Quartic, 2> Bisect(const Quartic& quartic)
{
  std::array<Quartic, 2> halves;
  for (int centroid = 0; centroid <= 4; ++centroid)
  {
    const int degree = 4 - centroid;
    RunningError row[5];
    for (int end = 0; end <= degree; ++end)
    {
      row[end] = quartic[QuarticNumber(end, centroid)];
    }
    // By de Casteljau's algorithm, the half at the start has the corners (start, middle, centroid).
    for (int step = 0; step <= degree; ++step)
    {
      // Rotated, the half at the start is (centroid, start, middle), the other one (end, centroid,
      // middle).
      const int middle = step;
      halves[0][QuarticNumber(degree - middle, middle)] = row[0];
      halves[1][QuarticNumber(centroid, middle)] = row[degree - step];
      for (int n = 0; n + step < degree; ++n)
      {
        row[n] = RunningError(0.5) * (row[n] + row[n + 1]);
      }
    }
  }
  return halves;
}

double LeastOf(const Quartic& quartic, double enough, int subdivisions)
{
  double least = quartic[0].LowerBound();
  for (const RunningError& coefficient : quartic)
  {
    const double bound = coefficient.LowerBound();
    least = bound < least || std::isnan(bound) ? bound : least;
  }
  if (subdivisions == 0 || least > enough || std::isnan(least))
  {
    return least;
  }
  // The coefficients at the corners are values of the determinant, so subdivision does not raise
  // them.
  for (int corner : { QuarticNumber(0, 0), QuarticNumber(4, 0), QuarticNumber(0, 4) })
  {
    if (quartic[corner].LowerBound() <= least)
    {
      return least;
    }
  }
  const std::array<Quartic, 2> halves = Bisect(quartic);
  const double first = LeastOf(halves[0], enough, subdivisions - 1);
  if (first <= least)
  {
    return least;
  }
  return std::max(least, std::min(first, LeastOf(halves[1], enough, subdivisions - 1)));
}

// A lower bound of the determinant if D' is so small compared with L that rounding is negligible,
// otherwise minus infinity. With N = L^-1 D', each coefficient is det L times a mean of mixed
// determinants of I + N at two ordinates, 1 + (tr N_i + tr N_j) / 2 + ..., which are at least 1 - 2
// |N| - |N|^2.
double BoundByNorms(const CubicElement& element)
{
  constexpr double greatest = 0.15;
  constexpr double greatestCondition = 1e4;
  constexpr double rounding = 1e-6;
  constexpr double none = -std::numeric_limits<double>::infinity();
  const bool isRight = element.Right.Corner >= 0;
  // Products of two numbers above this are far greater than errors by underflow.
  constexpr double leastSquare = 1e-250;
  const double squares = SquaredNorm(element.Affine);
  const double determinant = element.Affine.Determinant();
  if (!(squares < greatestCondition * determinant) || !(squares > leastSquare))
  {
    return none;
  }
  if (!isRight)
  {
    const Vector2 a = element.Points[1] - element.Points[0];
    const Vector2 b = element.Points[2] - element.Points[0];
    const double sides = Dot(a, a) + Dot(b, b);
    if (!(Cross(a, b) > 1e-2 * sides) || !(sides > leastSquare))
    {
      return none;
    }
  }
  const DerivativeOrdinates<double> d =
    isRight ? MakeRightDerivative<double>(element) : MakeDerivative<double>(element);
  const auto norm = [](const Matrix<double>& m) {
    return Dot(m.First, m.First) + Dot(m.Second, m.Second);
  };
  double longest = norm(d.Center);
  for (int i = 0; i < 3; ++i)
  {
    longest = std::max({ longest, norm(d.Corner[i]), norm(d.Edge[i]), norm(d.Spoke[i]) });
  }
  // The Frobenius norm of L^-1 is that of L divided by the determinant.
  const double ratio = std::sqrt(longest) * (std::sqrt(squares) / determinant);
  return ratio < greatest ? determinant * (1.0 - ratio * (2.0 + ratio) - rounding) : none;
}

} // anonymous namespace

//------------------------------------------------------------------------------
Matrix2 AffineDerivative(const std::array<Vector2, 3>& from, const std::array<Vector2, 3>& to)
{
  const Vector2 a = from[1] - from[0];
  const Vector2 b = from[2] - from[0];
  const Vector2 c = to[1] - to[0];
  const Vector2 d = to[2] - to[0];
  const double area = DifferenceOfProducts(a.x, b.y, a.y, b.x);
  return { { DifferenceOfProducts(c.x, b.y, d.x, a.y) / area,
             DifferenceOfProducts(c.y, b.y, d.y, a.y) / area },
    { DifferenceOfProducts(d.x, a.x, c.x, b.x) / area,
      DifferenceOfProducts(d.y, a.x, c.y, b.x) / area } };
}

//------------------------------------------------------------------------------
BarycentricFrame::BarycentricFrame(const std::array<Vector2, 3>& points)
{
  double longest = -1.0;
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 edge = points[PreviousCorner(k)] - points[NextCorner(k)];
    const double squared = Dot(edge, edge);
    this->Apex = squared > longest ? k : this->Apex;
    longest = squared > longest ? squared : longest;
  }
  this->Start = points[NextCorner(this->Apex)];
  const Vector2 edge = points[PreviousCorner(this->Apex)] - this->Start;
  const Vector2 toApex = points[this->Apex] - this->Start;
  this->Along = (1.0 / longest) * edge;
  this->Across = (1.0 / Cross(edge, toApex)) * Vector2{ -edge.y, edge.x };
  this->Foot = Dot(this->Along, toApex);
}

//------------------------------------------------------------------------------
Barycentric ToBarycentric(const std::array<Vector2, 3>& points, const Vector2& point)
{
  return BarycentricFrame(points)(point);
}

//------------------------------------------------------------------------------
CubicNet::CubicNet(const CubicElement& element)
{
  const CubicOrdinates<Vector2> b = GetOrdinates(element);
  std::array<Vector2, 3> images;
  for (int i = 0; i < 3; ++i)
  {
    images[i] = element.Affine * element.Points[i];
  }
  const Vector2 center = (1.0 / 3.0) * (images[0] + images[1] + images[2]);
  // Three times the point at a third of the way from one point to another.
  const auto third = [](const Vector2& from, const Vector2& to) { return 2.0 * from + to; };
  const auto set = [this](double(Component::*member)[3], int i, const Vector2& ordinate) {
    (this->X.*member)[i] = ordinate.x;
    (this->Y.*member)[i] = ordinate.y;
  };
  for (int k = 0; k < 3; ++k)
  {
    const int next = NextCorner(k);
    const int previous = PreviousCorner(k);
    const Vector2 start = images[next];
    const Vector2 end = images[previous];
    set(&Component::Corner, k, images[k] + b.Corner[k]);
    set(&Component::Next, next, third(start, end) + 3.0 * b.AfterStart[k]);
    set(&Component::Previous, previous, third(end, start) + 3.0 * b.BeforeEnd[k]);
    set(&Component::Inner, k, third(images[k], center) + 3.0 * b.Inner[k]);
    set(&Component::Middle, k, 2.0 * (start + end + center) + 6.0 * b.Middle[k]);
    set(&Component::Spoke, k, third(center, images[k]) + 3.0 * b.Spoke[k]);
  }
  this->X.Center = center.x + b.Center.x;
  this->Y.Center = center.y + b.Center.y;
}

//------------------------------------------------------------------------------
HOMEOMORPHISM_ALWAYS_INLINE Matrix2 CubicNet::GetEdgeDerivatives(const CubicPiece& piece) const
{
  const int k = piece.Opposite;
  const int i = NextCorner(k);
  const int j = PreviousCorner(k);
  const auto along = [&piece, k, i, j](const Component& b) -> Vector2 {
    // The derivatives by the coordinates in the piece, where f is one cubic.
    const auto [uu, uv2, vv, uw2, vw2, ww] = piece.GetQuadratics();
    const double byStart = 3.0 * uu * b.Corner[i] + uv2 * b.Next[i] + vv * b.Previous[j] +
      uw2 * b.Inner[i] + 0.5 * vw2 * b.Middle[k] + ww * b.Spoke[i];
    const double byEnd = uu * b.Next[i] + uv2 * b.Previous[j] + 3.0 * vv * b.Corner[j] +
      0.5 * uw2 * b.Middle[k] + vw2 * b.Inner[j] + ww * b.Spoke[j];
    const double byCentroid = uu * b.Inner[i] + 0.5 * uv2 * b.Middle[k] + vv * b.Inner[j] +
      uw2 * b.Spoke[i] + vw2 * b.Spoke[j] + 3.0 * ww * b.Center;
    const double byOpposite = 3.0 * byCentroid - byStart - byEnd;
    return { byStart - byOpposite, byEnd - byOpposite };
  };
  return FromRows(along(this->X), along(this->Y));
}

//------------------------------------------------------------------------------
Vector2 CubicNet::GetResidual(const Barycentric& l, const std::array<Vector2, 3>& points,
  const Vector2& image, Vector2& step) const
{
  const Vector2 residual = image - (*this)(l);
  const CubicPiece piece = FindPiece(l);
  const Matrix2 along = this->GetEdgeDerivatives(piece);
  const double scale = 1.0 / along.Determinant();
  const Vector2& origin = points[piece.Opposite];
  step = (scale * Cross(residual, along.ImageOfY)) * (points[NextCorner(piece.Opposite)] - origin) +
    (scale * Cross(along.ImageOfX, residual)) * (points[PreviousCorner(piece.Opposite)] - origin);
  return residual;
}

//------------------------------------------------------------------------------
Matrix2 CubicNet::GetDerivative(
  const Barycentric& l, const std::array<Vector2, 3>& points, double area) const
{
  const CubicPiece piece = FindPiece(l);
  const Matrix2 along = this->GetEdgeDerivatives(piece);
  const double scale = 1.0 / area;
  const Vector2& origin = points[piece.Opposite];
  const Vector2 first = scale * (points[NextCorner(piece.Opposite)] - origin);
  const Vector2 second = scale * (points[PreviousCorner(piece.Opposite)] - origin);
  // The rows of the inverse of the matrix of both edges.
  return OuterProduct(along.ImageOfX, { second.y, -second.x }) +
    OuterProduct(along.ImageOfY, { -first.y, first.x });
}

//------------------------------------------------------------------------------
CubicOrdinates<Vector2> GetOrdinates(const CubicElement& element)
{
  const ElementFrame frame(element);
  constexpr double third = 1.0 / 3.0;
  constexpr double half = 0.5;
  std::array<Vector2, 3> toCentroid;
  CubicOrdinates<Vector2> b;
  for (int i = 0; i < 3; ++i)
  {
    const Vector2& here = frame.Points[i];
    toCentroid[i] =
      third * ((frame.Points[NextCorner(i)] - here) + (frame.Points[PreviousCorner(i)] - here));
    b.Corner[i] = element.Values[i];
    b.Inner[i] = b.Corner[i] + third * (frame.Gradients[i] * toCentroid[i]);
  }
  for (int k = 0; k < 3; ++k)
  {
    const int i = NextCorner(k);
    const int j = PreviousCorner(k);
    const Vector2 edge = frame.Points[j] - frame.Points[i];
    const Vector2 slopes = frame.Gradients[i] * edge + frame.Gradients[j] * edge;
    b.AfterStart[k] = b.Corner[i] + third * (frame.Gradients[i] * edge);
    b.BeforeEnd[k] = b.Corner[j] - third * (frame.Gradients[j] * edge);
    // The vector from the edge's midpoint to the centroid. In this direction, the derivative at the
    // midpoint is the mean of the normal derivatives at the ends plus the cubic's own derivative
    // along the edge.
    const Vector2 toMiddle = toCentroid[i] - half * edge;
    const double along = Dot(toMiddle, edge) / Dot(edge, edge);
    b.Middle[k] = half * (b.AfterStart[k] + b.BeforeEnd[k]) +
      half * third * (frame.Gradients[i] * toMiddle + frame.Gradients[j] * toMiddle) +
      along * ((b.Corner[j] - b.Corner[i]) - half * slopes);
  }
  for (int i = 0; i < 3; ++i)
  {
    b.Spoke[i] = third * (b.Inner[i] + b.Middle[NextCorner(i)] + b.Middle[PreviousCorner(i)]);
  }
  b.Center = third * (b.Spoke[0] + b.Spoke[1] + b.Spoke[2]);
  return b;
}

//------------------------------------------------------------------------------
Matrix2 Derive(const CubicElement& element, const Barycentric& l)
{
  const CubicPiece piece = FindPiece(l);
  const int k = piece.Opposite;
  const int i = NextCorner(k);
  const int j = PreviousCorner(k);
  const std::array<double, 6> weights = piece.GetQuadratics();
  const bool isRight = element.Right.Corner >= 0;
  const DerivativeOrdinates<double> d =
    isRight ? MakeRightDerivative<double>(element) : MakeDerivative<double>(element);
  const Matrix<double> sum = weights[0] * d.Corner[i] + weights[1] * d.Edge[k] +
    weights[2] * d.Corner[j] + weights[3] * d.Spoke[i] + weights[4] * d.Spoke[j] +
    weights[5] * d.Center;
  const Matrix2 derivative{ { sum.First.x, sum.First.y }, { sum.Second.x, sum.Second.y } };
  // Convert from the axes of the frame to those of the plane.
  return isRight ? OuterProduct(derivative.ImageOfX, element.Right.Tangent) +
      OuterProduct(derivative.ImageOfY, element.Right.Normal)
                 : derivative;
}

//------------------------------------------------------------------------------
void Evaluate(const CubicElement& element, const CubicOrdinates<Vector2>& b, const Barycentric& l,
  Vector2& value, Matrix2& derivative)
{
  const CubicPiece piece = FindPiece(l);
  const int k = piece.Opposite;
  const int i = NextCorner(k);
  const int j = PreviousCorner(k);
  const std::array<double, 6> weights = piece.GetQuadratics();
  const Vector2 fromCentroid[6] = { b.Inner[i], b.Middle[k], b.Inner[j], b.Spoke[i], b.Spoke[j],
    b.Center };
  const Vector2 fromStart[6] = { b.Corner[i], b.AfterStart[k], b.BeforeEnd[k], b.Inner[i],
    b.Middle[k], b.Spoke[i] };
  const Vector2 fromEnd[6] = { b.AfterStart[k], b.BeforeEnd[k], b.Corner[j], b.Middle[k],
    b.Inner[j], b.Spoke[j] };
  Vector2 start;
  Vector2 end;
  Vector2 centroid;
  for (int n = 0; n < 6; ++n)
  {
    start = start + weights[n] * fromStart[n];
    end = end + weights[n] * fromEnd[n];
    centroid = centroid + weights[n] * fromCentroid[n];
  }
  value = piece.Start * start + piece.End * end + piece.Centroid * centroid;
  derivative = Derive(element, l);
}

//------------------------------------------------------------------------------
const std::array<QuarticIndex, 15>& QuarticIndices()
{
  static const std::array<QuarticIndex, 15> indices = MakeQuarticIndices();
  return indices;
}

//------------------------------------------------------------------------------
DeterminantCoefficients GetDeterminantCoefficients(const CubicElement& element)
{
  DeterminantCoefficients coefficients;
  MakeDeterminant<double>(element, coefficients);
  return coefficients;
}

//------------------------------------------------------------------------------
double LeastDeterminant(const CubicElement& element, double enough, int subdivisions)
{
  const double bound = BoundByNorms(element);
  if (bound > enough)
  {
    return bound;
  }
  std::array<RunningError, 45> coefficients;
  MakeDeterminant<RunningError>(element, coefficients);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
  {
    Quartic quartic;
    std::copy_n(coefficients.begin() + 15 * k, 15, quartic.begin());
    const double here = LeastOf(quartic, enough, subdivisions);
    least = here < least || std::isnan(here) ? here : least;
  }
  // NaN does not certify anything.
  return std::isnan(least) ? -std::numeric_limits<double>::infinity() : least;
}

//------------------------------------------------------------------------------
double GreatestDisplacement(const CubicElement& element)
{
  const CubicOrdinates<Vector2> b = GetOrdinates(element);
  double greatest = Dot(b.Center, b.Center);
  for (const std::array<Vector2, 3>* ordinates :
    { &b.Corner, &b.AfterStart, &b.BeforeEnd, &b.Inner, &b.Middle, &b.Spoke })
  {
    for (const Vector2& ordinate : *ordinates)
    {
      greatest = std::max(greatest, Dot(ordinate, ordinate));
    }
  }
  return std::sqrt(greatest);
}

//------------------------------------------------------------------------------
BendingMatrix GetBendingMatrix(const std::array<Vector2, 3>& points)
{
  constexpr int count = 9;
  constexpr int pairs = (count + 1) / 2;
  // Two basis functions are evaluated at a time, as the components of one map.
  std::array<CubicOrdinates<Vector2>, pairs> basis;
  for (int n = 0; n < count; n += 2)
  {
    CubicElement element{ points, {}, {}, {} };
    for (int m = n; m < std::min(n + 2, count); ++m)
    {
      Vector2& target = m % 3 == 0
        ? element.Values[m / 3]
        : (m % 3 == 1 ? element.Gradients[m / 3].ImageOfX : element.Gradients[m / 3].ImageOfY);
      (m == n ? target.x : target.y) = 1.0;
    }
    basis[n / 2] = GetOrdinates(element);
  }
  const double area = 0.5 * Cross(points[1] - points[0], points[2] - points[0]);
  BendingMatrix matrix{};
  for (int k = 0; k < 3; ++k)
  {
    const int i = NextCorner(k);
    const int j = PreviousCorner(k);
    const Vector2 edge = points[j] - points[i];
    const Vector2 toCentroid = (1.0 / 3.0) * (edge + (points[k] - points[i]));
    const double cross = Cross(edge, toCentroid);
    // d/dx and d/dy as combinations of the derivatives along edge and toCentroid.
    const Vector2 alongX{ toCentroid.y / cross, -edge.y / cross };
    const Vector2 alongY{ -toCentroid.x / cross, edge.x / cross };
    // Second derivatives xx, xy, yy of the nine functions at the corners of the piece.
    double hessians[3][3][2 * pairs];
    for (int pair = 0; pair < pairs; ++pair)
    {
      const CubicOrdinates<Vector2>& b = basis[pair];
      // Rows of the control net towards the end (columns) and the centroid (rows).
      const Vector2 net[4][4] = { { b.Corner[i], b.AfterStart[k], b.BeforeEnd[k], b.Corner[j] },
        { b.Inner[i], b.Middle[k], b.Inner[j], {} }, { b.Spoke[i], b.Spoke[j], {}, {} },
        { b.Center, {}, {}, {} } };
      for (int corner = 0; corner < 3; ++corner)
      {
        const int r = corner == 2 ? 1 : 0;
        const int c = corner == 1 ? 1 : 0;
        const Vector2 aa = 6.0 * (net[r][c] + net[r][c + 2] - 2.0 * net[r][c + 1]);
        const Vector2 bb = 6.0 * (net[r][c] + net[r + 2][c] - 2.0 * net[r + 1][c]);
        const Vector2 ab = 6.0 * (net[r][c] + net[r + 1][c + 1] - net[r][c + 1] - net[r + 1][c]);
        const Vector2 xx =
          alongX.x * alongX.x * aa + 2.0 * alongX.x * alongX.y * ab + alongX.y * alongX.y * bb;
        const Vector2 xy = alongX.x * alongY.x * aa +
          (alongX.x * alongY.y + alongX.y * alongY.x) * ab + alongX.y * alongY.y * bb;
        const Vector2 yy =
          alongY.x * alongY.x * aa + 2.0 * alongY.x * alongY.y * ab + alongY.y * alongY.y * bb;
        hessians[corner][0][2 * pair] = xx.x;
        hessians[corner][1][2 * pair] = xy.x;
        hessians[corner][2][2 * pair] = yy.x;
        hessians[corner][0][2 * pair + 1] = xx.y;
        hessians[corner][1][2 * pair + 1] = xy.y;
        hessians[corner][2][2 * pair + 1] = yy.y;
      }
    }
    // Second derivatives are linear in a piece, so quadrature at the midpoints of its edges is
    // exact for their squares.
    for (int corner = 0; corner < 3; ++corner)
    {
      for (int part = 0; part < 3; ++part)
      {
        const double weight = (part == 1 ? 2.0 : 1.0) * area / 9.0 * 0.25;
        double middle[count];
        for (int n = 0; n < count; ++n)
        {
          middle[n] = hessians[corner][part][n] + hessians[NextCorner(corner)][part][n];
        }
        for (int m = 0; m < count; ++m)
        {
          for (int n = 0; n <= m; ++n)
          {
            matrix[m][n] += weight * middle[m] * middle[n];
          }
        }
      }
    }
  }
  for (int m = 0; m < count; ++m)
  {
    for (int n = m + 1; n < count; ++n)
    {
      matrix[m][n] = matrix[n][m];
    }
  }
  return matrix;
}

} // namespace homeomorphism
