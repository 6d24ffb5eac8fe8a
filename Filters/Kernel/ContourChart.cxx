// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ContourChart.h"

#include "Kernel/Simd/Vectorize.h"
#include "RootFinding.h"

#include <algorithm>
#include <limits>

namespace homeomorphism
{
namespace
{

double Clamp01(double x)
{
  return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0;
}

/// sin(x) / x.
double SineRatio(double x)
{
  return x != 0.0 ? std::sin(x) / x : 1.0;
}

/// atan(z) / z.
double ArcTangentRatio(double z)
{
  return z != 0.0 ? std::atan(z) / z : 1.0;
}

/// The derivative of atan(z) / z, (1 / (1 + z^2) - atan(z) / z) / z. For small z, where the formula
/// suffers from cancellation, a series is used.
double ArcTangentRatioDerivative(double z)
{
  if (z > 0.25)
  {
    return (1.0 / (1.0 + z * z) - std::atan(z) / z) / z;
  }
  const double z2 = z * z;
  double sum = 0.0;
  for (int n = 14; n >= 1; --n)
  {
    sum = -z2 * sum + 2.0 * n / (2.0 * n + 1.0);
  }
  return -z * sum;
}

/// (sin x - x cos x) / x^2. For small x, where the formula suffers from cancellation, a series is
/// used.
double SineMinusCosineRatio(double x)
{
  if (x > 0.5)
  {
    return (std::sin(x) - x * std::cos(x)) / (x * x);
  }
  const double x2 = x * x;
  double sum = 0.0;
  for (int n = 9; n >= 1; --n)
  {
    // Each term is the previous one times -x^2 / (2 n (2 n + 3)).
    sum = 1.0 - x2 / (2.0 * n * (2.0 * n + 3.0)) * sum;
  }
  return x / 3.0 * sum;
}

/// sqrt(a^2 + b^2) without underflow, overflow or branches.
HOMEOMORPHISM_ALWAYS_INLINE double Hypotenuse(double a, double b)
{
  const double larger = a > b ? a : b;
  double scale = larger > 0x1p-300 ? 1.0 : 0x1p600;
  scale = larger < 0x1p300 ? scale : 0x1p-600;
  double unscale = larger > 0x1p-300 ? 1.0 : 0x1p-600;
  unscale = larger < 0x1p300 ? unscale : 0x1p600;
  const double x = scale * a;
  const double y = scale * b;
  return unscale * std::sqrt(x * x + y * y);
}

/// The part of a contour that is cheap to compute and sufficient to find s. The frame of a half
/// edge has the foot of the center segment at the origin, the center at (0, h) and the corner at
/// (b, 0). The parameter s runs from 0 (the center segment) to 1 (the segment from the center to
/// the corner). The contour meets the wing segment at (b s, h (1 - s) / 2).
struct ArcOfHalf
{
  /// Twice the length of the straight piece: R = sqrt(h^2 (1 + s)^2 + 4 b^2 s^2).
  double R;
  /// 1 / r = 4 b s / (h (1 - s) R), the curvature of the arc; infinite at the corner.
  double Curvature;
  /// E = b s (1 + h (1 - s) / (R + h (1 + s))), where the contour meets the edge.
  double EdgePoint;

  HOMEOMORPHISM_ALWAYS_INLINE ArcOfHalf(double h, double b, double s)
    : R(Hypotenuse(h * (1.0 + s), 2.0 * b * s))
    , Curvature(4.0 * b * s / (h * (1.0 - s) * R))
    , EdgePoint(b * s * (1.0 + h * (1.0 - s) / (R + h * (1.0 + s))))
  {
  }
};

/// A contour with its lengths.
struct ContourOfHalf : ArcOfHalf
{
  /// tan(phi) = 2 b s / (h (1 + s)), where phi is the angle by which the arc turns.
  double Slope;
  /// Length of the arc, r phi = (R / 2) ((1 - s) / (1 + s)) atan(tan phi) / tan phi.
  double ArcLength;
  /// L = R / 2 + r phi, the length of the contour.
  double Length;

  ContourOfHalf(double h, double b, double s);
};

/// Derivatives of the members of ArcOfHalf with respect to s.
struct ArcOfHalfDerivative
{
  double R;
  double Curvature; ///< infinite at the corner
  double EdgePoint; ///< between b / 2 and 3 b / 2

  HOMEOMORPHISM_ALWAYS_INLINE ArcOfHalfDerivative(
    double h, double b, double s, const ArcOfHalf& arc)
  {
    const double overR = 1.0 / arc.R;
    const double overRest = 1.0 / (1.0 - s);
    this->R = h * (h * overR) * (1.0 + s) + 4.0 * b * (b * overR) * s;
    this->Curvature = 4.0 * b * overR * overRest * (overRest - s * this->R * overR) / h;
    const double overSum = 1.0 / (arc.R + h * (1.0 + s));
    const double extra = h * (1.0 - s) * overSum;
    this->EdgePoint = b * (1.0 + extra) - b * s * (h * overSum + extra * (this->R + h) * overSum);
  }
};

/// Derivatives of the members of ContourOfHalf with respect to s.
struct ContourOfHalfDerivative : ArcOfHalfDerivative
{
  double Bend;   ///< R times the derivative of the curvature, which itself overflows in needles
  double Angle;  ///< d phi / d s
  double Radius; ///< d r / d s; infinite at the center segment
  double Length; ///< d L / d s

  ContourOfHalfDerivative(double h, double b, double s, const ContourOfHalf& contour);
};

/// Equations for the parameter s of the contour that meets the edge at E(s) = b @a proportion.
template <int Width>
struct EndingEquation : RootBatch<Width, true>
{
  HOMEOMORPHISM_ALWAYS_INLINE void Set(int index, double, double proportion)
  {
    // 0 <= share <= 1 / 2, see Evaluate.
    this->Start(index, proportion / 1.5, proportion, proportion / 1.25);
  }

  HOMEOMORPHISM_ALWAYS_INLINE void Evaluate(int index, double flatness, double proportion)
  {
    // E / b and its derivative, with R / (h (1 + s)) = sqrt(1 + tan^2 phi).
    const double s = this->Root[index];
    const double over = 1.0 / (1.0 + s);
    const double slope = flatness * s * over;
    const double secant = std::sqrt(1.0 + slope * slope);
    const double overSecant = 1.0 / (1.0 + secant);
    const double share = (1.0 - s) * over * overSecant;
    const double secantDerivative = slope / secant * flatness * over * over;
    const double shareDerivative =
      -2.0 * over * over * overSecant - share * overSecant * secantDerivative;
    const double value = s * (1.0 + share) - proportion;
    this->Step(index, value, value / (1.0 + share + s * shareDerivative), 0x1p-32);
  }
};

/// Equations for the parameter s of the contour whose arc passes through (x, y): the only root in
/// [0, 1 - 2 y / h] of E(s) - y^2 / (r + sqrt(r^2 - y^2)) - x. It is the smallest root of the
/// published cubic. The larger root of the cubic belongs to the other half of the circle.
template <int Width>
struct ThroughEquation : RootBatch<Width, true>
{
  HOMEOMORPHISM_ALWAYS_INLINE void Set(int index, double h, double b, double x, double y)
  {
    const double last = 1.0 - 2.0 * y / h;
    this->Start(index, 0.0, last > 0.0 ? last : 0.0, x / b);
  }

  HOMEOMORPHISM_ALWAYS_INLINE void Evaluate(int index, double h, double b, double x, double y)
  {
    const double s = this->Root[index];
    const ArcOfHalf arc(h, b, s);
    const ArcOfHalfDerivative derivative(h, b, s, arc);
    double sine = y * arc.Curvature;
    sine = sine < 1.0 ? sine : 1.0;
    const double root = std::sqrt((1.0 - sine) * (1.0 + sine));
    // An arc turns by at most phi. Near a right angle the sine does not determine the cosine, and a
    // cosine of 0 would give an infinite slope and a zero step, which would pass for convergence.
    const double least = h * (1.0 + s) / arc.R;
    const double cosine = root > least ? root : least;
    const double overOne = 1.0 / (1.0 + cosine);
    // On the edge the inset is 0, although the curvature at the corner is infinite.
    const double inset = y > 0.0 ? y * sine * overOne : 0.0;
    const double insetDerivative = y > 0.0 ? derivative.Curvature * y * y * overOne / cosine : 0.0;
    const double value = arc.EdgePoint - inset - x;
    this->Step(index, value, value / (derivative.EdgePoint - insetDerivative), 0x1p-50);
  }
};

/// Batches of equations. The elements after the last equation are filled up to whole vectors.
struct ThroughBatch
{
  static constexpr int Capacity = 256;
  double H[Capacity];
  double B[Capacity];
  double X[Capacity];
  double Y[Capacity];
  double S[Capacity];
};

struct EndingBatch
{
  static constexpr int Capacity = 256;
  double Flatness[Capacity];
  double Proportion[Capacity];
  double S[Capacity];
};

/// Number of equations solved together.
constexpr int GroupWidth = 16;

HOMEOMORPHISM_FOR_WIDE_VECTORS
void SolveThrough(ThroughBatch& batch, int count)
{
  for (int first = 0; first < count; first += GroupWidth)
  {
    for (int i = count; i < first + GroupWidth; ++i)
    {
      batch.H[i] = batch.B[i] = 1.0;
      batch.X[i] = batch.Y[i] = 0.0;
    }
    ThroughEquation<GroupWidth> equation;
    SolveBatch<GroupWidth>(
      equation, batch.H + first, batch.B + first, batch.X + first, batch.Y + first);
    std::copy_n(equation.Root, GroupWidth, batch.S + first);
  }
}

HOMEOMORPHISM_FOR_WIDE_VECTORS
void SolveEnding(EndingBatch& batch, int count)
{
  for (int first = 0; first < count; first += GroupWidth)
  {
    for (int i = count; i < first + GroupWidth; ++i)
    {
      batch.Flatness[i] = 1.0;
      batch.Proportion[i] = 0.0;
    }
    EndingEquation<GroupWidth> equation;
    SolveBatch<GroupWidth>(equation, batch.Flatness + first, batch.Proportion + first);
    std::copy_n(equation.Root, GroupWidth, batch.S + first);
  }
}

/// 2 b / h, bounded so that its square is finite. The result does not depend on larger values.
double Flatness(double h, double b)
{
  return std::min(2.0 * b / h, 0x1p500);
}

double ContourEndingAt(double flatness, double proportion)
{
  EndingEquation<1> equation;
  SolveBatch<1>(equation, &flatness, &proportion);
  return equation.Root[0];
}

double ContourThrough(double h, double b, double x, double y)
{
  ThroughEquation<1> equation;
  SolveBatch<1>(equation, &h, &b, &x, &y);
  return equation.Root[0];
}

ContourOfHalf::ContourOfHalf(double h, double b, double s)
  : ArcOfHalf(h, b, s)
  , Slope(2.0 * b * s / (h * (1.0 + s)))
  , ArcLength(0.5 * R * (1.0 - s) / (1.0 + s) * ArcTangentRatio(Slope))
  , Length(0.5 * R + ArcLength)
{
  // The product h R underflows in needles thinner than 1e-150.
  this->Curvature = 4.0 * b * s / this->R / (h * (1.0 - s));
}

ContourOfHalfDerivative::ContourOfHalfDerivative(
  double h, double b, double s, const ContourOfHalf& contour)
  : ArcOfHalfDerivative(h, b, s, contour)
{
  const double slopeDerivative = 2.0 * b / (h * (1.0 + s) * (1.0 + s));
  const double overRest = 1.0 / (1.0 - s);
  this->Bend = 4.0 * (b / h) * overRest * (overRest - s * (this->R / contour.R));
  this->Angle = 2.0 * (b / contour.R) * (h / contour.R);
  this->Radius = h / (4.0 * b * s) * ((1.0 - s) * this->R - contour.R / s);

  const double ratio = ArcTangentRatio(contour.Slope);
  const double share = (1.0 - s) / (1.0 + s);
  const double shareDerivative = -2.0 / ((1.0 + s) * (1.0 + s));
  this->Length = 0.5 * this->R * (1.0 + share * ratio) +
    0.5 * contour.R *
      (shareDerivative * ratio +
        share * ArcTangentRatioDerivative(contour.Slope) * slopeDerivative);
}

} // namespace

ContourChart::ContourChart(const TriangleShape& shape, const EdgeViews& views, CenterPoint center)
  : Unit(PowerOfTwoNear(shape.Base))
{
  // Multiplying by the reciprocal of a power of two is exact.
  const double overUnit = 1.0 / this->Unit;
  this->Shape = { shape.Base * overUnit, shape.ApexX * overUnit, shape.Height * overUnit,
    shape.Apex };
  if (center == CenterPoint::Centroid)
  {
    this->CenterWeights = { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 };
  }
  else
  {
    double perimeter = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      this->CenterWeights[k] = views[k].Length;
      perimeter += this->CenterWeights[k];
    }
    for (double& weight : this->CenterWeights)
    {
      weight /= perimeter;
    }
  }
  for (int k = 0; k < 3; ++k)
  {
    const EdgeView view{ views[k].Length * overUnit, views[k].Foot, views[k].Height * overUnit };
    Edge& edge = this->Edges[k];
    edge.Start = this->Shape.Corner(NextCorner(k));
    edge.Length = view.Length;
    // The tangent of an edge other than the base follows from the view of the far end of the base.
    // The difference of the ends of the edge would be inaccurate for short edges.
    if (k == shape.Apex)
    {
      edge.Tangent = { 1.0, 0.0 };
    }
    else if (k == NextCorner(shape.Apex))
    {
      edge.Tangent = { -view.Foot * view.Length / this->Shape.Base,
        view.Height / this->Shape.Base };
    }
    else
    {
      edge.Tangent = { (view.Foot - 1.0) * view.Length / this->Shape.Base,
        -view.Height / this->Shape.Base };
    }
    // Rounded differences of coordinates may lose the height of a needle, though not its
    // orientation.
    const double height =
      view.Height > 0.0 ? view.Height : std::numeric_limits<double>::epsilon() * view.Length;
    edge.CenterHeight = this->CenterWeights[k] * height;
    // The foot of a weighted mean of the corners is the weighted mean of their feet, which are 0
    // and Length for the ends of the edge.
    edge.FootDistance =
      view.Length * (this->CenterWeights[PreviousCorner(k)] + this->CenterWeights[k] * view.Foot);
  }
}

ContourChart::Half ContourChart::HalfAt(const Edge& edge, double p) const
{
  const double fromFoot = p * edge.Length - edge.FootDistance;
  Half half;
  half.Side = fromFoot >= 0.0 ? 1.0 : -1.0;
  half.EdgePoint = std::abs(fromFoot);
  // Rounding may put the foot of a barely concordant triangle on a corner.
  const double least = std::numeric_limits<double>::epsilon() * edge.Length;
  half.Length =
    std::max(least, half.Side > 0.0 ? edge.Length - edge.FootDistance : edge.FootDistance);
  return half;
}

ContourChart::Search ContourChart::StartSearch(const Vector2& pointInFrame) const
{
  const Vector2 point = (1.0 / this->Unit) * pointInFrame;
  const Barycentric l = this->Shape.ToBarycentric(point);
  int k = 0;
  for (int other = 1; other < 3; ++other)
  {
    if (l[other] * this->CenterWeights[k] < l[k] * this->CenterWeights[other])
    {
      k = other;
    }
  }
  const Edge& edge = this->Edges[k];
  // A point on the boundary, or outside by rounding, is replaced by the nearest point of the
  // triangle.
  const bool inside = l[0] > 0.0 && l[1] > 0.0 && l[2] > 0.0;
  const Vector2 fromStart = (inside ? point : this->Shape.FromBarycentric(l)) - edge.Start;
  const double along = Dot(fromStart, edge.Tangent);
  const Half half = this->HalfAt(edge, along / edge.Length);
  Search search;
  search.EdgeLabel = k + 1;
  search.Side = half.Side;
  search.Height = edge.CenterHeight;
  search.Length = half.Length;
  search.X = half.EdgePoint;
  search.Y = std::max(0.0, Cross(edge.Tangent, fromStart));
  search.S = 0.0;
  const double h = search.Height;
  search.IsStraight = 2.0 * search.Y * search.Length >= h * (search.Length - search.X);
  if (search.IsStraight)
  {
    const double below = std::max(0.0, h - search.Y);
    if (search.X == 0.0 && below == 0.0)
    {
      search.EdgeLabel = 0;
    }
    const double denominator = 2.0 * search.Length * below - search.X * h;
    search.S = denominator > 0.0 ? Clamp01(search.X * h / denominator) : 1.0;
  }
  return search;
}

ContourChart::Reference ContourChart::EndSearch(const Search& search) const
{
  if (search.EdgeLabel == 0)
  {
    return Reference{};
  }
  const Edge& edge = this->Edges[search.EdgeLabel - 1];
  const ContourOfHalf contour(search.Height, search.Length, search.S);
  const double y = search.Y;
  Reference coordinates;
  coordinates.Edge = search.EdgeLabel;
  coordinates.EdgeParameter =
    Clamp01((edge.FootDistance + search.Side * contour.EdgePoint) / edge.Length);
  if (search.IsStraight)
  {
    const double distance = Hypotenuse(search.X, std::max(0.0, search.Height - y));
    coordinates.ContourParameter = Clamp01(distance / contour.Length);
    return coordinates;
  }
  // The length of the arc between the point and the edge, r psi with sin psi = y / r. Near a right
  // angle the sine does not determine the angle, so the cosine is used.
  double remaining = 0.0;
  if (y > 0.0 && search.S < 1.0)
  {
    const double sine = std::min(1.0, y * contour.Curvature);
    const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
    const double inset = y * sine / (1.0 + cosine);
    const double angle = std::atan2(sine, 1.0 - inset * contour.Curvature);
    remaining = sine > 0.0 ? y * angle / sine : y;
  }
  coordinates.ContourParameter = Clamp01(1.0 - remaining / contour.Length);
  return coordinates;
}

ContourChart::Ending ContourChart::EndingOf(const Reference& coordinates) const
{
  const Edge& edge = this->Edges[coordinates.Edge - 1];
  Ending ending;
  ending.AtEdge = this->HalfAt(edge, coordinates.EdgeParameter);
  ending.Flatness = Flatness(edge.CenterHeight, ending.AtEdge.Length);
  ending.Proportion = Clamp01(ending.AtEdge.EdgePoint / ending.AtEdge.Length);
  return ending;
}

Vector2 ContourChart::PointOn(const Reference& coordinates, const Half& half, double s) const
{
  const Edge& edge = this->Edges[coordinates.Edge - 1];
  const double h = edge.CenterHeight;
  const ContourOfHalf contour(h, half.Length, s);
  const double remaining = (1.0 - coordinates.ContourParameter) * contour.Length;
  double x = 0.0;
  double y = 0.0;
  if (remaining >= contour.ArcLength)
  {
    const double share = 2.0 * coordinates.ContourParameter * contour.Length / contour.R;
    x = share * half.Length * s;
    y = h - share * 0.5 * h * (1.0 + s);
  }
  else
  {
    const double angle = remaining * contour.Curvature;
    const double halfAngle = 0.5 * angle;
    x = contour.EdgePoint - remaining * SineRatio(halfAngle) * std::sin(halfAngle);
    y = remaining * SineRatio(angle);
  }
  const double along = edge.FootDistance + half.Side * x;
  return this->Unit *
    Vector2{ edge.Start.x + along * edge.Tangent.x - y * edge.Tangent.y,
      edge.Start.y + along * edge.Tangent.y + y * edge.Tangent.x };
}

ContourChart::Search ContourChart::Find(const Vector2& pointInFrame) const
{
  Search search = this->StartSearch(pointInFrame);
  if (!search.IsStraight)
  {
    search.S = Clamp01(ContourThrough(search.Height, search.Length, search.X, search.Y));
  }
  return search;
}

ContourChart::Reference ContourChart::ToReference(const Vector2& pointInFrame) const
{
  return this->EndSearch(this->Find(pointInFrame));
}

Vector2 ContourChart::ToPoint(const Reference& coordinates) const
{
  const Ending ending = this->EndingOf(coordinates);
  return this->PointOn(
    coordinates, ending.AtEdge, ContourEndingAt(ending.Flatness, ending.Proportion));
}

void ContourChart::MapPoints(
  const ContourChart* const* from, const ContourChart* const* to, Vector2* points, int count)
{
  constexpr int capacity = ThroughBatch::Capacity;
  Search searches[capacity];
  ThroughBatch through;
  int searching = 0;
  for (int i = 0; i < count; ++i)
  {
    searches[i] = from[i]->StartSearch(points[i]);
    if (!searches[i].IsStraight)
    {
      through.H[searching] = searches[i].Height;
      through.B[searching] = searches[i].Length;
      through.X[searching] = searches[i].X;
      through.Y[searching] = searches[i].Y;
      ++searching;
    }
  }
  SolveThrough(through, searching);
  Reference coordinates[capacity];
  Ending endings[capacity];
  EndingBatch ends;
  int found = 0;
  for (int i = 0; i < count; ++i)
  {
    if (!searches[i].IsStraight)
    {
      searches[i].S = Clamp01(through.S[found++]);
    }
    coordinates[i] = from[i]->EndSearch(searches[i]);
    endings[i] = to[i]->EndingOf(coordinates[i]);
    ends.Flatness[i] = endings[i].Flatness;
    ends.Proportion[i] = endings[i].Proportion;
  }
  SolveEnding(ends, count);
  for (int i = 0; i < count; ++i)
  {
    points[i] = to[i]->PointOn(coordinates[i], endings[i].AtEdge, ends.S[i]);
  }
}

MappedPoint<ContourChart> ContourChart::MapWithDerivatives(
  const ContourChart& from, const ContourChart& to, const Vector2& point)
{
  const Search search = from.Find(point);
  const Reference coordinates = from.EndSearch(search);
  const Ending ending = to.EndingOf(coordinates);
  const double s = ContourEndingAt(ending.Flatness, ending.Proportion);
  // The center has no contour of its own.
  return { to.PointOn(coordinates, ending.AtEdge, s),
    search.EdgeLabel == 0
      ? from.DifferentialAt(coordinates)
      : from.DifferentialOn(coordinates, from.EndingOf(coordinates).AtEdge, search.S),
    to.DifferentialOn(coordinates, ending.AtEdge, s) };
}

ContourChart::Differential ContourChart::DifferentialAt(const Reference& coordinates) const
{
  const Ending ending = this->EndingOf(coordinates);
  return this->DifferentialOn(
    coordinates, ending.AtEdge, ContourEndingAt(ending.Flatness, ending.Proportion));
}

/// The images of the two unit directions of the reference.
ContourChart::Differential ContourChart::DifferentialOn(
  const Reference& coordinates, const Half& half, double s) const
{
  const Edge& edge = this->Edges[coordinates.Edge - 1];
  const double h = edge.CenterHeight;
  const double b = half.Length;
  const double c = coordinates.ContourParameter;
  const ContourOfHalf contour(h, b, s);
  const ContourOfHalfDerivative derivative(h, b, s, contour);
  const double remaining = (1.0 - c) * contour.Length;

  // In the frame of the half edge: the derivative with respect to c, and the derivative with
  // respect to s divided by c.
  Vector2 byC;
  Vector2 bySOverC;
  if (remaining >= contour.ArcLength)
  {
    // X = G + c L T with the unit vector T = (sin phi, -cos phi).
    const double sine = 2.0 * b * s / contour.R;
    const double cosine = h * (1.0 + s) / contour.R;
    byC = { contour.Length * sine, -contour.Length * cosine };
    const double turn = contour.Length * derivative.Angle;
    bySOverC = { turn * cosine + derivative.Length * sine,
      turn * sine - derivative.Length * cosine };
  }
  else
  {
    // X = (E - r (1 - cos psi), r sin psi) with r psi = (1 - c) L.
    const double angle = remaining * contour.Curvature;
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    byC = { contour.Length * sine, -contour.Length * cosine };
    // d(1/r)/ds (r psi)^2, computed from 1/r or r, whichever is finite.
    const double bend = s < 0.5 ? derivative.Bend * (remaining / contour.R) * remaining
                                : -derivative.Radius * angle * angle;
    const double halfSine = SineRatio(0.5 * angle);
    const double stretch = (1.0 - c) * derivative.Length;
    const Vector2 byS = { derivative.EdgePoint +
        bend * (0.5 * halfSine * halfSine - SineRatio(angle)) - stretch * sine,
      stretch * cosine - bend * SineMinusCosineRatio(angle) };
    bySOverC = { byS.x / c, byS.y / c };
  }
  // p Length = foot + Side E(s).
  const double rate = half.Side * edge.Length / derivative.EdgePoint;
  const auto toTriangle = [&edge, &half](const Vector2& v) -> Vector2 {
    const double along = half.Side * v.x;
    return { along * edge.Tangent.x - v.y * edge.Tangent.y,
      along * edge.Tangent.y + v.y * edge.Tangent.x };
  };
  return { { toTriangle(byC), rate * toTriangle(bySOverC) }, this->Unit };
}

Vector2 ContourChart::Differential::Pushforward(const Direction& direction) const
{
  return this->Unit * (direction.x * this->Columns.ImageOfX + direction.y * this->Columns.ImageOfY);
}

ContourChart::Direction ContourChart::Differential::Pullback(const Vector2& vectorInFrame) const
{
  const Vector2 vector = (1.0 / this->Unit) * vectorInFrame;
  // Scaling by powers of two avoids underflow of the products.
  const double scaleX = PowerOfTwoNear(this->Columns.ImageOfX);
  const double scaleY = PowerOfTwoNear(this->Columns.ImageOfY);
  const Vector2 x = (1.0 / scaleX) * this->Columns.ImageOfX;
  const Vector2 y = (1.0 / scaleY) * this->Columns.ImageOfY;
  const double determinant = Cross(x, y);
  return { Cross(vector, y) / determinant / scaleX, Cross(x, vector) / determinant / scaleY };
}

Vector2 ContourChart::Center() const
{
  return this->Unit * this->Shape.FromBarycentric(this->CenterWeights);
}

Vector2 ContourChart::Foot(int edgeLabel) const
{
  const Edge& edge = this->Edges[edgeLabel - 1];
  return this->Unit * (edge.Start + edge.FootDistance * edge.Tangent);
}

const TriangleShape& ContourChart::EquilateralShape()
{
  static const TriangleShape shape{ 1.0, 0.5, std::sqrt(0.75), 2 };
  return shape;
}

const ContourChart& ContourChart::Equilateral()
{
  static const ContourChart chart(EquilateralShape(),
    ViewsFromEdges(
      EquilateralShape().Corner(0), EquilateralShape().Corner(1), EquilateralShape().Corner(2)));
  return chart;
}

} // namespace homeomorphism
