// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Mesh/CubicTriangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace homeomorphism
{
namespace
{

Vector2 Normal(const Vector2& along)
{
  return { -along.y, along.x };
}

/// Bubble functions. They and their derivatives are zero at the corners and on the edges, except
/// for the derivative across one edge. In the middle of that edge, it is 9/2 of the derivative of
/// the opposite corner's barycentric coordinate. In the notation of CubicNet, the bubble of edge k
/// is 18 n_i n_j m + 9 (n_i + n_j) m^2 + 6 m^3.
class EdgeBubbles
{
public:
  explicit EdgeBubbles(const Barycentric& l)
    : EdgeBubbles(l, std::min(std::min(l[0], l[1]), l[2]))
  {
  }
  /// The polynomials of a piece, also outside it. They are homogeneous of degree 3.
  EdgeBubbles(const Barycentric& l, int piece)
    : EdgeBubbles(l, l[piece])
  {
  }

  double operator[](int k) const
  {
    const double i = this->N[NextCorner(k)];
    const double j = this->N[PreviousCorner(k)];
    return this->M * (18.0 * i * j + this->M * (9.0 * (i + j) + 6.0 * this->M));
  }

  /// The derivatives with respect to the barycentric coordinates as independent variables.
  Barycentric GetDerivatives(int k) const
  {
    return this->GetDerivatives(k, this->N[0] <= 0.0 ? 0 : (this->N[1] <= 0.0 ? 1 : 2));
  }
  Barycentric GetDerivatives(int k, int piece) const
  {
    const double i = this->N[NextCorner(k)];
    const double j = this->N[PreviousCorner(k)];
    const double byI = this->M * (18.0 * j + 9.0 * this->M);
    const double byJ = this->M * (18.0 * i + 9.0 * this->M);
    const double rest = 18.0 * (i * j + this->M * (i + j + this->M)) - byI - byJ;
    // The least coordinate is subtracted from the others.
    Barycentric by{ piece == 0 ? rest : 0.0, piece == 1 ? rest : 0.0, piece == 2 ? rest : 0.0 };
    by[NextCorner(k)] += byI;
    by[PreviousCorner(k)] += byJ;
    return by;
  }

  /// Negative outside the element.
  double GetLeastCoordinate() const { return this->M; }

private:
  EdgeBubbles(const Barycentric& l, double least)
    : M(least)
    , N{ l[0] - M, l[1] - M, l[2] - M }
  {
  }

  double M;
  std::array<double, 3> N;
};

/// Barycentric coordinates in the upper or the lower element of a strip. The ends of the diagonal
/// are corners 0 and 2.
Barycentric GetStripCoordinates(bool isUpper, double s, double t)
{
  return isUpper ? Barycentric{ 1.0 - t, t - s, s } : Barycentric{ 1.0 - s, s - t, t };
}

/// The factor of the diagonal's bubble in a strip.
double GetBubbleFactor(bool isUpper, double share)
{
  return (isUpper ? 1.0 : -1.0) / 6.0 * share;
}

/// The factor g of the jump in a strip along a line: t (1 - t)^2 plus the diagonal's bubble. It is
/// a cubic polynomial where the line is in one piece of the bubble.
class StripLine
{
public:
  /// The line from (s, t) along (ds, dt). @a share is that of EdgeTerms.
  StripLine(double s, double t, double ds, double dt, double share)
    : Piece(FindPiece(s, t))
  {
    const bool isUpper = IsUpper(s, t);
    const Barycentric l = GetStripCoordinates(isUpper, s, t);
    const Barycentric along =
      isUpper ? Barycentric{ -dt, dt - ds, ds } : Barycentric{ -ds, ds - dt, dt };
    // A homogeneous cubic polynomial b is b(l) + b'(l) d x + b'(d) l x^2 + b(d) x^3 at l + x d.
    const int least = this->Piece % 3;
    const EdgeBubbles start(l);
    const EdgeBubbles direction(along, least);
    const auto sum = [](const Barycentric& a, const Barycentric& b) {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    const double factor = GetBubbleFactor(isUpper, share);
    const double rest = 1.0 - t;
    this->Value = t * rest * rest + factor * start[1];
    this->Slope = rest * (1.0 - 3.0 * t) * dt + factor * sum(start.GetDerivatives(1, least), along);
    this->HalfCurvature =
      (3.0 * t - 2.0) * dt * dt + factor * sum(direction.GetDerivatives(1, least), l);
    this->Third = dt * dt * dt + factor * direction[1];
  }

  /// A number of the piece of the bubble that contains a point.
  static int FindPiece(double s, double t)
  {
    const bool isUpper = IsUpper(s, t);
    const Barycentric l = GetStripCoordinates(isUpper, s, t);
    const int lesser = l[1] < l[0] ? 1 : 0;
    return (isUpper ? 3 : 0) + (l[2] < l[lesser] ? 2 : lesser);
  }
  int GetPiece() const { return this->Piece; }

  /// Solves start + x = g at the distance x from the line's beginning. Returns NaN if Halley's
  /// method does not converge.
  double Solve(double start) const
  {
    constexpr double enough = 0x1p-20;
    constexpr int mostSteps = 6;
    double x = 0.0;
    for (int step = 0; step < mostSteps; ++step)
    {
      const double rest =
        start + x - (this->Value + x * (this->Slope + x * (this->HalfCurvature + x * this->Third)));
      const double slope =
        1.0 - (this->Slope + x * (2.0 * this->HalfCurvature + 3.0 * x * this->Third));
      const double halfCurvature = -(this->HalfCurvature + 3.0 * x * this->Third);
      const double move = rest * slope / (slope * slope - rest * halfCurvature);
      x -= move;
      // The error is about the cube of the last step, times the square of the curvature.
      if (std::abs(move) * (slope + std::abs(halfCurvature)) <= enough * slope)
      {
        return x;
      }
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

private:
  static bool IsUpper(double s, double t) { return t > s; }

  int Piece;
  // The coefficients of the polynomial.
  double Value;
  double Slope;
  double HalfCurvature;
  double Third;
};

} // anonymous namespace

//------------------------------------------------------------------------------
void CubicTriangle::Make(const std::array<Vector2, 3>& points, const CubicNet& net, int origin)
{
  this->Current->Elements.emplace_back();
  Element& made = this->Current->Elements.back();
  const PlanarPair& pair = this->Template.GetPair();
  const std::array<std::int32_t, 3>& corners = pair.Triangles[this->Current->Number];
  made.Points = points;
  made.Frame = BarycentricFrame(points);
  made.Net = net;
  made.SourceOrigin = pair.Source[corners[origin]] - pair.Source[corners[0]];
  made.TargetOrigin = pair.Target[corners[origin]] - pair.Target[corners[0]];
}

//------------------------------------------------------------------------------
void CubicTriangle::Load(int triangle)
{
  this->Triangles.resize(this->Kept);
  std::unique_ptr<Triangle>& kept =
    this->Triangles[static_cast<std::size_t>(triangle) % this->Kept];
  if (!kept)
  {
    kept = std::make_unique<Triangle>();
  }
  this->Current = kept.get();
  if (this->Current->Number == triangle)
  {
    return;
  }
  this->Current->Number = triangle;
  this->Current->Elements.clear();
  const PlanarPair& pair = this->Template.GetPair();
  this->Current->Affine = this->Template.GetAffine(triangle);
  this->Current->Rounding = pair.GetRounding(triangle, this->Current->Affine);
  this->Current->Whole = this->Bending && this->Bending->Cuts[triangle] < 0;
  if (this->Current->Whole)
  {
    this->Make(pair.GetSourceCorners(triangle), this->Bending->Nets[triangle], 0);
    return;
  }
  this->Current->Cut = this->Template.GetCut(triangle);
  this->Current->Made.fill(-1);
  for (EdgeTerms& edge : this->Current->Edges)
  {
    edge.IsMade = false;
  }
  for (int c = 0; c < 3; ++c)
  {
    this->Current->Corners[c].IsMade = false;
    this->Current->Sides[c][0].IsMade = this->Current->Sides[c][1].IsMade = false;
    this->Current->InRings[c] =
      this->Template.GetKind(pair.Triangles[triangle][c]) != VertexKind::Differentiable;
  }
}

//------------------------------------------------------------------------------
double CubicTriangle::GetScale() const
{
  if (!this->Current->Whole)
  {
    const std::array<double, 3>& heights = this->Current->Cut.Heights;
    return std::min({ heights[0], heights[1], heights[2] });
  }
  const std::array<Vector2, 3>& points = this->Current->Elements[0].Points;
  return std::max(
    { std::abs(points[1].x), std::abs(points[1].y), std::abs(points[2].x), std::abs(points[2].y) });
}

//------------------------------------------------------------------------------
const CubicTriangle::Element* CubicTriangle::Find(const Vector2& point)
{
  int& number = this->LastElement;
  if (this->Current->Whole)
  {
    number = 0;
    return &this->Current->Elements[0];
  }
  const TriangleCut& cut = this->Current->Cut;
  if (!this->Bending)
  {
    number = cut.FindBesideEdges(point);
    return nullptr;
  }
  number = cut.Find(point);
  const int origin = TriangleCut::GetOrigin(number);
  if (number < TriangleCut::FirstStrip && this->Current->InRings[origin])
  {
    return nullptr;
  }
  if (this->Current->Made[number] < 0)
  {
    this->Current->Made[number] = static_cast<std::int8_t>(this->Current->Elements.size());
    const CubicElement element = this->Bending->GetElement(
      this->Template.GetPair(), cut, this->Current->Affine, this->Current->Number, number);
    this->Make(element.Points, CubicNet(element), origin);
  }
  return &this->Current->Elements[this->Current->Made[number]];
}

//------------------------------------------------------------------------------
Vector2 CubicTriangle::Map(const Vector2& point)
{
  const Element* element = this->Find(point);
  if (element)
  {
    return element->TargetOrigin + element->Net(element->Frame(point - element->SourceOrigin));
  }
  return this->MapInClosedForm(point, nullptr);
}

//------------------------------------------------------------------------------
Matrix2 CubicTriangle::GetTemplateDerivative(const Vector2& point)
{
  this->Find(point);
  Matrix2 derivative;
  this->MapInClosedForm(point, &derivative);
  return derivative;
}

//------------------------------------------------------------------------------
Vector2 CubicTriangle::GetResidual(
  const Vector2& point, const Vector2& image, bool isNear, Vector2& step)
{
  Matrix2 derivative;
  Vector2 residual;
  const int last = this->LastElement;
  const bool isTried = isNear && !this->Bending && last < TriangleCut::FirstMiddle &&
    !(last < TriangleCut::FirstStrip && this->Current->InRings[TriangleCut::GetOrigin(last)]);
  if (isTried)
  {
    residual = image - this->MapInClosedForm(point, &derivative);
  }
  if (!isTried || !(this->LeastCoordinate >= 0.0))
  {
    const Element* element = this->Find(point);
    if (element)
    {
      return element->Net.GetResidual(element->Frame(point - element->SourceOrigin),
        element->Points, image - element->TargetOrigin, step);
    }
    residual = image - this->MapInClosedForm(point, &derivative);
  }
  step = Solve(derivative, residual);
  return residual;
}

//------------------------------------------------------------------------------
Vector2 CubicTriangle::MapInClosedForm(const Vector2& point, Matrix2* derivative)
{
  const int number = this->LastElement;
  const int origin = TriangleCut::GetOrigin(number);
  if (number < TriangleCut::FirstStrip && this->Current->InRings[origin])
  {
    const PlanarPair& pair = this->Template.GetPair();
    const std::array<std::int32_t, 3>& corners = pair.Triangles[this->Current->Number];
    Vector2 image;
    Matrix2 there;
    this->Template.EvaluateRings(
      this->Current->Number, origin, point - this->Current->Cut.Corners[origin], image, there);
    if (derivative)
    {
      *derivative = there;
    }
    return image + (pair.Target[corners[origin]] - pair.Target[corners[0]]);
  }
  if (derivative)
  {
    *derivative = this->Current->Affine;
  }
  const Vector2 image = this->Current->Affine * point;
  if (number >= TriangleCut::FirstMiddle)
  {
    return image;
  }
  return image +
    (number < TriangleCut::FirstStrip ? this->DeviateInCorner(point, number, derivative)
                                      : this->DeviateInStrip(point, number, derivative));
}

//------------------------------------------------------------------------------
const CubicTriangle::EdgeTerms& CubicTriangle::GetEdge(int k)
{
  EdgeTerms& edge = this->Current->Edges[k];
  if (edge.IsMade)
  {
    return edge;
  }
  edge.IsMade = true;
  const TriangleCut& cut = this->Current->Cut;
  const double height = cut.Heights[k];
  const double strip = cut.Lengths[k] - cut.Radii[NextCorner(k)] - cut.Radii[PreviousCorner(k)];
  edge.InverseHeight = 1.0 / height;
  edge.InverseStrip = 1.0 / strip;
  const double mu = height * edge.InverseStrip;
  edge.StripShare = 1.0 / (1.0 + mu * mu);
  edge.Jump = {};
  const int neighbor = this->Template.GetPair().Neighbors[this->Current->Number][k];
  if (neighbor >= 0)
  {
    const Matrix2& across = this->Template.GetAffine(neighbor);
    const double d = this->Current->Affine.Determinant();
    const double share = d / (d + across.Determinant());
    edge.Jump = (share * height) * ((across - this->Current->Affine) * Normal(cut.Along[k]));
  }
  const Matrix2& affine = this->Current->Affine;
  edge.Shift = Solve(affine, edge.Jump);
  // The relative error of the solution is the unit of the last place times the condition number.
  const double condition = SquaredNorm(affine) / affine.Determinant();
  const double longest = std::max({ cut.Lengths[0], cut.Lengths[1], cut.Lengths[2] });
  edge.Rounding = this->Current->Rounding +
    std::numeric_limits<double>::epsilon() * (condition + longest * edge.InverseHeight) *
      std::sqrt(Dot(edge.Jump, edge.Jump));
  return edge;
}

//------------------------------------------------------------------------------
// In a strip, the image of x is that of x + g shift under the affine map. So x lies on a line along
// the shift through the affine preimage, and g is the root of a cubic equation.
bool CubicTriangle::FindDirectly(Vector2& point, double tolerance)
{
  constexpr int mostPieces = 4;
  const TriangleCut& cut = this->Current->Cut;
  const int number = cut.FindBesideEdges(point);
  if (number < TriangleCut::FirstStrip)
  {
    return false;
  }
  if (number >= TriangleCut::FirstMiddle)
  {
    return this->Current->Rounding <= 0.5 * tolerance;
  }
  const int k = (number - TriangleCut::FirstStrip) / 2;
  const EdgeTerms& edge = this->GetEdge(k);
  if (!(edge.Rounding <= 0.5 * tolerance))
  {
    return false;
  }
  const auto along = [&](const Vector2& d) { return Dot(cut.Along[k], d); };
  const auto across = [&](const Vector2& d) { return Cross(cut.Along[k], d) * edge.InverseHeight; };
  const Vector2 from = point - cut.Corners[NextCorner(k)];
  const double affineS = (along(from) - cut.Radii[NextCorner(k)]) * edge.InverseStrip;
  const double affineT = across(from);
  const double ds = -along(edge.Shift) * edge.InverseStrip;
  const double dt = -across(edge.Shift);
  double g = 0.0;
  double s = affineS;
  double t = affineT;
  for (int piece = 0; piece < mostPieces; ++piece)
  {
    const StripLine line(s, t, ds, dt, edge.StripShare);
    g += line.Solve(g);
    s = affineS + g * ds;
    t = affineT + g * dt;
    if (!(s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0))
    {
      return false;
    }
    if (StripLine::FindPiece(s, t) == line.GetPiece())
    {
      point = point - g * edge.Shift;
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
// In the strip along an edge, with s along the edge points and t across, from 0 to 1, the map is
// L x + w c m g, g = t (1 - t)^2 with the diagonal's bubble.
Vector2 CubicTriangle::DeviateInStrip(const Vector2& point, int number, Matrix2* derivative)
{
  const int k = (number - TriangleCut::FirstStrip) / 2;
  const TriangleCut& cut = this->Current->Cut;
  const EdgeTerms& edge = this->GetEdge(k);
  const Vector2 d = point - cut.Corners[NextCorner(k)];
  const double s = (Dot(cut.Along[k], d) - cut.Radii[NextCorner(k)]) * edge.InverseStrip;
  // Rounding can take points beyond the edge, where the determinant may be negative.
  const double t = std::max(Cross(cut.Along[k], d) * edge.InverseHeight, 0.0);
  const bool isUpper = (number - TriangleCut::FirstStrip) % 2 == 1;
  const EdgeBubbles bubbles(GetStripCoordinates(isUpper, s, t));
  this->LeastCoordinate = bubbles.GetLeastCoordinate();
  const double factor = GetBubbleFactor(isUpper, edge.StripShare);
  const double rest = 1.0 - t;
  if (derivative)
  {
    const Barycentric by = bubbles.GetDerivatives(1);
    const double first = by[1] - by[0];
    const double second = by[2] - by[1];
    const double byS = factor * (isUpper ? second : first) * edge.InverseStrip;
    const double byT =
      (rest * (1.0 - 3.0 * t) + factor * (isUpper ? first : second)) * edge.InverseHeight;
    *derivative =
      *derivative + OuterProduct(edge.Jump, byS * cut.Along[k] + byT * Normal(cut.Along[k]));
  }
  return (t * rest * rest + factor * bubbles[1]) * edge.Jump;
}

//------------------------------------------------------------------------------
const CubicTriangle::CornerTerms& CubicTriangle::GetCorner(int c)
{
  CornerTerms& corner = this->Current->Corners[c];
  if (corner.IsMade)
  {
    return corner;
  }
  constexpr double eighteenth = 1.0 / 18.0;
  corner.IsMade = true;
  const TriangleCut& cut = this->Current->Cut;
  const int id = this->Template.GetPair().Triangles[this->Current->Number][c];
  const Matrix2 difference = this->Template.GetDerivative(id) - this->Current->Affine;
  const Vector2 a = cut.GetNode(9 + 2 * PreviousCorner(c), c);
  const Vector2 b = cut.GetNode(10 + 2 * NextCorner(c), c);
  const double inverse = 1.0 / Cross(a, b);
  const Vector2 imageOfA = difference * a;
  const Vector2 imageOfB = difference * b;
  const double product = 3.0 * Dot(a, b);
  corner.Difference = difference;
  corner.ByFirst = { inverse * b.y, -inverse * b.x };
  corner.BySecond = { -inverse * a.y, inverse * a.x };
  corner.BesideFirst = eighteenth * (imageOfB + (2.0 - product / Dot(a, a)) * imageOfA);
  corner.BesideSecond = eighteenth * (imageOfA + (2.0 - product / Dot(b, b)) * imageOfB);
  return corner;
}

//------------------------------------------------------------------------------
const CubicTriangle::SideTerms& CubicTriangle::GetSide(int c, bool isFirst)
{
  SideTerms& side = this->Current->Sides[c][isFirst ? 0 : 1];
  if (side.IsMade)
  {
    return side;
  }
  side.IsMade = true;
  const TriangleCut& cut = this->Current->Cut;
  const int k = isFirst ? PreviousCorner(c) : NextCorner(c);
  const EdgeTerms& edge = this->GetEdge(k);
  const int id = this->Template.GetPair().Triangles[this->Current->Number][c];
  const Vector2 tangent = (isFirst ? 1.0 : -1.0) * cut.Along[k];
  const Vector2 normal = Normal(cut.Along[k]);
  const double inverseRadius = 1.0 / cut.Radii[c];
  const double mu = cut.Heights[k] * inverseRadius;
  const double share = 1.0 / (1.0 + mu * mu);
  side.Difference = this->Template.GetDerivative(id) - this->Current->Affine;
  const Vector2 along = cut.Radii[c] * (side.Difference * tangent);
  const Vector2 across = cut.Heights[k] * (side.Difference * normal);
  side.ByS = inverseRadius * tangent;
  side.ByT = edge.InverseHeight * normal;
  side.BesideDiagonal = ((mu * mu * share) / 6.0) * along + (1.0 / 9.0 - share / 6.0) * across;
  side.BesideEdge = (1.0 / 18.0) * (across + edge.Jump);
  side.OfEdge = edge.Jump;
  return side;
}

//------------------------------------------------------------------------------
// Beside a corner whose derivative differs from L by B, the map is L x + l_0^2 B x with bubbles
// that make the normal derivatives on the corner's edges linear. Elements with a right angle
// also have the term of the edge.
Vector2 CubicTriangle::DeviateInCorner(const Vector2& point, int number, Matrix2* derivative)
{
  const int c = number / 3;
  const Vector2 x = point - this->Current->Cut.Corners[c];
  if (number % 3 == 1)
  {
    const CornerTerms& corner = this->GetCorner(c);
    const double first = Dot(corner.ByFirst, x);
    const double second = Dot(corner.BySecond, x);
    const double l = 1.0 - first - second;
    const Vector2 linear = corner.Difference * x;
    const EdgeBubbles bubbles({ l, first, second });
    this->LeastCoordinate = bubbles.GetLeastCoordinate();
    if (derivative)
    {
      const Barycentric besideFirst = bubbles.GetDerivatives(2);
      const Barycentric besideSecond = bubbles.GetDerivatives(1);
      const Vector2 common = (-2.0 * l) * linear;
      const Vector2 byFirst = common + (besideFirst[1] - besideFirst[0]) * corner.BesideFirst +
        (besideSecond[1] - besideSecond[0]) * corner.BesideSecond;
      const Vector2 bySecond = common + (besideFirst[2] - besideFirst[0]) * corner.BesideFirst +
        (besideSecond[2] - besideSecond[0]) * corner.BesideSecond;
      *derivative = *derivative + (l * l) * corner.Difference +
        OuterProduct(byFirst, corner.ByFirst) + OuterProduct(bySecond, corner.BySecond);
    }
    return (l * l) * linear + bubbles[2] * corner.BesideFirst + bubbles[1] * corner.BesideSecond;
  }
  // The vertex, the edge point and the inner point are corners 0, 1 and 2; s runs along the edge
  // and t across, from 0 to 1.
  const SideTerms& side = this->GetSide(c, number % 3 == 0);
  const double s = Dot(side.ByS, x);
  const double t = std::max(Dot(side.ByT, x), 0.0);
  const double l = 1.0 - s;
  const Vector2 linear = side.Difference * x;
  const EdgeBubbles bubbles({ l, s - t, t });
  this->LeastCoordinate = bubbles.GetLeastCoordinate();
  if (derivative)
  {
    const Barycentric diagonal = bubbles.GetDerivatives(1);
    const Barycentric beside = bubbles.GetDerivatives(2);
    const Barycentric across = bubbles.GetDerivatives(0);
    const Vector2 byS = (-2.0 * l) * linear + (diagonal[1] - diagonal[0]) * side.BesideDiagonal +
      (beside[1] - beside[0]) * side.BesideEdge +
      (2.0 * t * (s - t) + (1.0 / 9.0) * (across[1] - across[0])) * side.OfEdge;
    const Vector2 byT = (diagonal[2] - diagonal[1]) * side.BesideDiagonal +
      (beside[2] - beside[1]) * side.BesideEdge +
      ((s - t) * (s - 3.0 * t) + (1.0 / 9.0) * (across[2] - across[1])) * side.OfEdge;
    *derivative = *derivative + (l * l) * side.Difference + OuterProduct(byS, side.ByS) +
      OuterProduct(byT, side.ByT);
  }
  return (l * l) * linear + bubbles[1] * side.BesideDiagonal + bubbles[2] * side.BesideEdge +
    ((s - t) * (s - t) * t + (1.0 / 9.0) * bubbles[0]) * side.OfEdge;
}

} // namespace homeomorphism
