// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Mesh/CubicTemplate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace homeomorphism
{
namespace
{

// The template is valid for all values with a convex middle and Slack < 1. These values result in
// the least bending.
// The distance of edge points from a vertex, divided by the length of its shortest edge.
constexpr double EdgeShare = 0.25;
// The height of inner points, divided by that of the triangle.
constexpr double HeightShare = 0.25;
// The share of the bound of Theorem 1 that is used for the variation of the determinant.
constexpr double Slack = 0.5;

double Length(const Vector2& v)
{
  return std::sqrt(Dot(v, v));
}

void SortUnique(LargeVector<std::int32_t>& numbers)
{
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

Vector2 Normal(const Vector2& along)
{
  return { -along.y, along.x };
}

// The corner's two edges leave it along prev(corner) and arrive along next(corner).
FanSector GetSector(const TriangleCut& cut, const Matrix2& affine, int corner)
{
  const int out = PreviousCorner(corner);
  const int in = NextCorner(corner);
  return { cut.GetNode(3 + 2 * out, corner), cut.GetNode(9 + 2 * out, corner),
    cut.GetNode(10 + 2 * in, corner), cut.GetNode(4 + 2 * in, corner), affine, cut.Radii[corner],
    { cut.Along[out], -1.0 * cut.Along[in] }, { cut.Heights[out], cut.Heights[in] } };
}

// The part of a sector in which a direction lies: beside the first ray (0), in the middle (1), or
// beside the last ray (2).
int FindPart(const FanSector& s, const Vector2& point)
{
  return Cross(s.InnerStart, point) < 0.0 ? 0 : (Cross(point, s.InnerEnd) < 0.0 ? 2 : 1);
}

// The factor by which a sector's outline must be shrunk about the vertex to pass through a point.
double GetGauge(const FanSector& s, int part, const Vector2& point)
{
  const Vector2 a = part == 0 ? s.Start : (part == 1 ? s.InnerStart : s.InnerEnd);
  const Vector2 b = part == 0 ? s.InnerStart : (part == 1 ? s.InnerEnd : s.End);
  return Cross(point - Vector2{}, b - a) / Cross(a, b - a);
}

// Moves a point that is outside an element by rounding into the element. Near the vertex of endless
// rings, elements are smaller than rounding errors, and cubics grow without bound outside them.
Barycentric Inside(const Barycentric& l)
{
  if (*std::min_element(l.begin(), l.end()) >= 0.0)
  {
    return l;
  }
  const Barycentric inside{ std::max(l[0], 0.0), std::max(l[1], 0.0), std::max(l[2], 0.0) };
  const double sum = inside[0] + inside[1] + inside[2];
  return { inside[0] / sum, inside[1] / sum, inside[2] / sum };
}

} // anonymous namespace

//------------------------------------------------------------------------------
void SerialFor(std::int64_t count, const std::function<void(std::int64_t, std::int64_t)>& body)
{
  body(0, count);
}

//------------------------------------------------------------------------------
const std::array<std::array<std::uint8_t, 3>, TriangleCut::NumberOfElements> TriangleCut::Elements =
  [] {
    std::array<std::array<std::uint8_t, 3>, NumberOfElements> elements{};
    const auto set = [&elements](int element, int a, int b, int c) {
      elements[element] = { std::uint8_t(a), std::uint8_t(b), std::uint8_t(c) };
    };
    for (int c = 0; c < 3; ++c)
    {
      const int out = PreviousCorner(c);
      const int in = NextCorner(c);
      set(3 * c, c, 3 + 2 * out, 9 + 2 * out);
      set(3 * c + 1, c, 9 + 2 * out, 10 + 2 * in);
      set(3 * c + 2, c, 10 + 2 * in, 4 + 2 * in);
    }
    for (int k = 0; k < 3; ++k)
    {
      set(FirstStrip + 2 * k, 3 + 2 * k, 4 + 2 * k, 10 + 2 * k);
      set(FirstStrip + 2 * k + 1, 3 + 2 * k, 10 + 2 * k, 9 + 2 * k);
    }
    // The inner points in cyclic order, a fan and a triangle.
    const int ring[6] = { 13, 14, 9, 10, 11, 12 };
    set(FirstMiddle, ring[0], ring[1], ring[2]);
    set(FirstMiddle + 1, ring[2], ring[3], ring[4]);
    set(FirstMiddle + 2, ring[4], ring[5], ring[0]);
    set(FirstMiddle + 3, ring[0], ring[2], ring[4]);
    return elements;
  }();

//------------------------------------------------------------------------------
Vector2 TriangleCut::GetNode(int node, int origin) const
{
  if (node < 3)
  {
    return this->Corners[node] - this->Corners[origin];
  }
  const int n = node < 9 ? node - 3 : node - 9;
  const int k = n / 2;
  const bool atEnd = n % 2 == 1;
  const int corner = atEnd ? PreviousCorner(k) : NextCorner(k);
  Vector2 point = (atEnd ? -this->Radii[corner] : this->Radii[corner]) * this->Along[k];
  if (node >= 9)
  {
    point = point + this->Heights[k] * Normal(this->Along[k]);
  }
  return corner == origin ? point : point + (this->Corners[corner] - this->Corners[origin]);
}

//------------------------------------------------------------------------------
int TriangleCut::FindBesideEdges(const Vector2& point) const
{
  std::array<Vector2, 3> from;
  std::array<double, 3> along;
  for (int k = 0; k < 3; ++k)
  {
    from[k] = point - this->Corners[k];
  }
  for (int k = 0; k < 3; ++k)
  {
    const Vector2& d = from[NextCorner(k)];
    const double start = this->Radii[NextCorner(k)];
    const double end = this->Radii[PreviousCorner(k)];
    const double height = Cross(this->Along[k], d);
    along[k] = Dot(this->Along[k], d);
    if (height <= this->Heights[k] && along[k] >= start && this->Lengths[k] - along[k] >= end)
    {
      const double width = this->Lengths[k] - start - end;
      const bool upper = height * width > (along[k] - start) * this->Heights[k];
      return FirstStrip + 2 * k + (upper ? 1 : 0);
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    const int out = PreviousCorner(c);
    const int in = NextCorner(c);
    const double radius = this->Radii[c];
    const double reach = std::max(this->Heights[out], this->Heights[in]);
    if (Dot(from[c], from[c]) > radius * radius + reach * reach)
    {
      continue;
    }
    const Vector2 first = radius * this->Along[out] + this->Heights[out] * Normal(this->Along[out]);
    const Vector2 last = this->Heights[in] * Normal(this->Along[in]) - radius * this->Along[in];
    // The strips' comparisons, so that rounding leaves no gap between them and the corner.
    if (Cross(first, from[c]) < 0.0)
    {
      if (along[out] <= radius)
      {
        return 3 * c;
      }
    }
    else if (Cross(from[c], last) < 0.0)
    {
      if (this->Lengths[in] - along[in] <= radius)
      {
        return 3 * c + 2;
      }
    }
    else if (Cross(last - first, from[c] - first) >= 0.0)
    {
      return 3 * c + 1;
    }
  }
  return FirstMiddle;
}

//------------------------------------------------------------------------------
int TriangleCut::Find(const Vector2& point) const
{
  const int number = this->FindBesideEdges(point);
  if (number < FirstMiddle)
  {
    return number;
  }
  for (int n = 0; n < 3; ++n)
  {
    const std::array<std::uint8_t, 3>& nodes = Elements[FirstMiddle + n];
    const Vector2 a = this->GetNode(nodes[0], 0);
    const Vector2 b = this->GetNode(nodes[2], 0);
    if (Cross(b - a, point - a) < 0.0)
    {
      return FirstMiddle + n;
    }
  }
  return FirstMiddle + 3;
}

//------------------------------------------------------------------------------
bool TriangleCut::SetRightAngle(int element, CubicElement& result) const
{
  if (element >= FirstMiddle || (element < FirstStrip && element % 3 == 1))
  {
    return false;
  }
  RightAngle& right = result.Right;
  int k;
  if (element < FirstStrip)
  {
    // (corner, edge point, inner point) or (corner, inner point, edge point).
    const int c = element / 3;
    const bool first = element % 3 == 0;
    k = first ? PreviousCorner(c) : NextCorner(c);
    right.Start = 0;
    right.Corner = first ? 1 : 2;
    right.Tangent = first ? this->Along[k] : -1.0 * this->Along[k];
    right.Normal = Normal(this->Along[k]);
    right.AlongTangent = this->Radii[c];
  }
  else
  {
    // (edge point, edge point, inner point) or (edge point, inner point, inner point).
    k = (element - FirstStrip) / 2;
    const bool first = (element - FirstStrip) % 2 == 0;
    right.Start = first ? 0 : 1;
    right.Corner = first ? 1 : 2;
    right.Tangent = first ? this->Along[k] : -1.0 * this->Along[k];
    right.Normal = (first ? 1.0 : -1.0) * Normal(this->Along[k]);
    right.AlongTangent =
      this->Lengths[k] - this->Radii[NextCorner(k)] - this->Radii[PreviousCorner(k)];
  }
  right.AlongNormal = this->Heights[k];
  for (int i = 0; i < 3; ++i)
  {
    right.ByTangent[i] = result.Gradients[i] * right.Tangent;
    right.ByNormal[i] = result.Gradients[i] * right.Normal;
  }
  return true;
}

//------------------------------------------------------------------------------
CubicTemplate::CubicTemplate(
  const PlanarPair& pair, const CubicTemplateOptions& options, const ParallelFor& parallelFor)
  : Pair(pair)
  , Radii(pair.Source.size(), 0.0)
  , Derivatives(pair.Source.size(), Matrix2{})
  , Kinds(pair.Source.size(), VertexKind::Differentiable)
  , Boundary(pair.Source.size(), 0)
  , Affines(pair.Triangles.size())
  , Heights(pair.Triangles.size())
  , Certificates(pair.Triangles.size())
{
  const PointFans fans(pair);
  const std::int64_t points = pair.GetNumberOfPoints();
  LargeArray<Bounds> bounds(pair.Triangles.size());
  parallelFor(pair.GetNumberOfTriangles(), [&](std::int64_t begin, std::int64_t end) {
    for (int t = static_cast<int>(begin); t < end; ++t)
    {
      this->Affines[t] = pair.GetAffine(t);
      if (!options.OnlyBoundary)
      {
        bounds[t] = {};
      }
    }
  });
  parallelFor(points, [&](std::int64_t begin, std::int64_t end) {
    for (int point = static_cast<int>(begin); point < end; ++point)
    {
      double shortest = std::numeric_limits<double>::infinity();
      // The mean of the triangles' derivatives, weighted by area.
      Matrix2 mean{};
      double total = 0.0;
      const bool closed = fans.ForEach(pair, point, [&](int t, int c) {
        const std::array<Vector2, 3> corners = pair.GetSourceCorners(t, c);
        const Vector2& next = corners[NextCorner(c)];
        const Vector2& previous = corners[PreviousCorner(c)];
        shortest = std::min({ shortest, Dot(next, next), Dot(previous, previous) });
        const double area = Cross(next, previous);
        mean = mean + area * this->Affines[t];
        total += area;
      });
      this->Radii[point] = EdgeShare * std::sqrt(shortest);
      this->Boundary[point] = closed ? 0 : 1;
      this->Derivatives[point] = total > 0.0 ? (1.0 / total) * mean : Matrix2{};
    }
  });
  // The data of points that are not Differentiable; null for others.
  LargeVector<std::unique_ptr<Exception>> exceptions(static_cast<std::size_t>(points));
  LargeVector<std::int32_t> changed;
  LargeVector<std::int32_t> triangles;
  if (options.OnlyBoundary)
  {
    for (std::int32_t point = 0; point < points; ++point)
    {
      if (this->Boundary[point] != 0 && fans.First[point] >= 0)
      {
        changed.push_back(point);
        fans.ForEach(pair, point, [&triangles](int t, int) { triangles.push_back(t); });
      }
    }
    SortUnique(triangles);
  }
  else
  {
    changed.resize(static_cast<std::size_t>(points));
    std::iota(changed.begin(), changed.end(), 0);
    triangles.resize(pair.Triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0);
  }
  LargeVector<double> factors(static_cast<std::size_t>(points), 1.0);
  // Shrink the corners in which the map deviates too much, until there are none.
  while (!changed.empty())
  {
    parallelFor(
      static_cast<std::int64_t>(triangles.size()), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t n = begin; n < end; ++n)
        {
          this->SetHeights(triangles[n], options.MaximumDeviation, bounds);
        }
      });
    parallelFor(
      static_cast<std::int64_t>(changed.size()), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t n = begin; n < end; ++n)
        {
          const int point = changed[n];
          if (fans.First[point] < 0)
          {
            continue;
          }
          exceptions[point].reset();
          if (!this->TakeMean(point, fans, bounds))
          {
            exceptions[point] = this->FindDerivative(point, fans);
          }
          factors[point] = 1.0;
          if (options.MaximumDeviation < std::numeric_limits<double>::max() &&
            !options.OnlyBoundary)
          {
            const double deviation =
              this->GetDeviation(fans.Get(pair, point), point, exceptions[point].get());
            // Corners can be shrunk as long as doubles represent their size.
            factors[point] = deviation > options.MaximumDeviation && this->Radii[point] > 1e-300
              ? std::min(0.5, 0.9 * options.MaximumDeviation / deviation)
              : 1.0;
          }
        }
      });
    // The corners' heights, and those of the neighbors' along the same edges, shrink as well.
    LargeVector<std::int32_t> next;
    triangles.clear();
    for (const std::int32_t point : changed)
    {
      if (factors[point] < 1.0)
      {
        this->Radii[point] *= factors[point];
        const PointFan fan = fans.Get(pair, point);
        triangles.insert(triangles.end(), fan.Triangles.begin(), fan.Triangles.end());
      }
    }
    SortUnique(triangles);
    for (const std::int32_t t : triangles)
    {
      next.insert(next.end(), pair.Triangles[t].begin(), pair.Triangles[t].end());
    }
    SortUnique(next);
    changed = std::move(next);
  }
  if (!options.OnlyBoundary)
  {
    parallelFor(pair.GetNumberOfTriangles(), [&](std::int64_t begin, std::int64_t end) {
      for (int t = static_cast<int>(begin); t < end; ++t)
      {
        const std::array<float, 3>& corners = bounds[t].Corners;
        this->Certificates[t] = std::min({ corners[0], corners[1], corners[2] });
      }
    });
  }
  for (std::unique_ptr<Exception>& exception : exceptions)
  {
    if (exception)
    {
      this->Exceptions.push_back(std::move(*exception));
    }
  }
}

//------------------------------------------------------------------------------
void CubicTemplate::FindMiddles(const ParallelFor& parallelFor)
{
  this->Middles = LargeArray<MiddleBounds>(this->Pair.Triangles.size());
  parallelFor(this->Pair.GetNumberOfTriangles(), [this](std::int64_t begin, std::int64_t end) {
    for (int t = static_cast<int>(begin); t < end; ++t)
    {
      this->SetMiddle(t);
    }
  });
}

//------------------------------------------------------------------------------
void CubicTemplate::SetHeights(int triangle, double maximumDeviation, LargeArray<Bounds>& bounds)
{
  const std::array<Vector2, 3> corners = this->Pair.GetSourceCorners(triangle);
  const std::array<std::int32_t, 3>& points = this->Pair.Triangles[triangle];
  Bounds& own = bounds[triangle];
  const Matrix2& affine = this->Affines[triangle];
  const double d = affine.Determinant();
  std::array<double, 3> lengths;
  double share = 1.0;
  for (int k = 0; k < 3; ++k)
  {
    lengths[k] = Length(corners[PreviousCorner(k)] - corners[NextCorner(k)]);
    const double radius =
      std::min(this->Radii[points[NextCorner(k)]], this->Radii[points[PreviousCorner(k)]]);
    share = std::min(share, radius / lengths[k]);
  }
  const double condition = std::sqrt(SquaredNorm(affine)) / d;
  own.Fall = 0.0;
  own.Slope = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 edge = corners[PreviousCorner(k)] - corners[NextCorner(k)];
    const Vector2 apex = corners[k] - corners[NextCorner(k)];
    const double length = lengths[k];
    const double height = DifferenceOfProducts(edge.x, apex.y, edge.y, apex.x) / length;
    const double foot = Dot(apex, edge) / length / length;
    double m =
      HeightShare * share * height / std::max({ 1.0, std::abs(foot), std::abs(1.0 - foot) });
    const int neighbor = this->Pair.Neighbors[triangle][k];
    if (neighbor >= 0)
    {
      const Matrix2& across = this->Affines[neighbor];
      const double e = across.Determinant();
      const Vector2 normal = (1.0 / length) * Normal(edge);
      const Vector2 turn = (across - affine) * normal;
      const double start = this->Radii[points[NextCorner(k)]];
      const double end = this->Radii[points[PreviousCorner(k)]];
      const double strip = length - start - end;
      const double leg = std::min(4.0 / 3.0 * strip, 3.0 * std::min(start, end));
      const double slope = std::abs(Cross(turn, affine * normal));
      const double size = Length(turn);
      m = std::min(m, Slack * leg * std::min(d, e) / slope);
      m = std::min(m, 1.5 * maximumDeviation * (d + e) / (d * size));
      // As in Theorem 1: g_n is at most c, g_t at most 3/2 c m / strip or 2/3 c m / radius.
      const double c = d / (d + e);
      own.Fall = std::max(own.Fall, c / d * (std::abs(e - d) + slope * 2.0 * m / leg));
      own.Slope = std::max(own.Slope, condition * size * c * (1.0 + 2.0 * m / leg));
    }
    this->Heights[triangle][k] = m;
  }
}

//------------------------------------------------------------------------------
void CubicTemplate::SetMiddle(int triangle)
{
  const TriangleCut cut = this->GetCut(triangle);
  MiddleBounds& bounds = this->Middles[triangle];
  const double area = Cross(cut.Corners[1], cut.Corners[2]);
  for (int k = 0; k < 3; ++k)
  {
    bounds.Least[k] = cut.Heights[k] * cut.Lengths[k] / area;
  }
  for (int c = 0; c < 3; ++c)
  {
    // The least coordinate of the corner's inner points, which are r and m from the vertex.
    const int out = PreviousCorner(c);
    const int in = NextCorner(c);
    const Vector2 opposite = cut.Along[c];
    double least = 1.0;
    for (const Vector2& node : { cut.GetNode(9 + 2 * out, c), cut.GetNode(10 + 2 * in, c) })
    {
      // The height over the opposite edge falls as the node leaves the vertex.
      least = std::min(least, 1.0 + Cross(opposite, node) * cut.Lengths[c] / area);
    }
    bounds.Greatest[c] = least;
  }
}

//------------------------------------------------------------------------------
bool CubicTemplate::TakeMean(int point, const PointFans& fans, LargeArray<Bounds>& bounds)
{
  // The mean is accepted if the bound exceeds enough. Up to this condition number of the
  // derivative, rounding errors are certainly far below the allowance for rounding.
  constexpr double enough = 0.3;
  constexpr double greatestCondition = 1e4;
  constexpr double rounding = 1e-6;
  bool close = this->Boundary[point] == 0 && fans.Touching[point] == 0;
  fans.ForEach(this->Pair, point, [&](int t, int c) {
    close = close && bounds[t].Fall < 1.0 - enough;
    bounds[t].Corners[c] = 0.0F;
  });
  if (!close)
  {
    return false;
  }
  const Matrix2& mean = this->Derivatives[point];
  const double radius = this->Radii[point];
  fans.ForEach(this->Pair, point, [&](int t, int c) {
    if (!close)
    {
      return;
    }
    Bounds& own = bounds[t];
    const double squares = SquaredNorm(this->Affines[t]);
    const double determinant = this->Affines[t].Determinant();
    const double condition = squares / determinant;
    // The sine of the angle between the inner points beside the corner.
    const std::array<Vector2, 3> corners = this->Pair.GetSourceCorners(t, c);
    const Vector2& out = corners[NextCorner(c)];
    const Vector2& in = corners[PreviousCorner(c)];
    const Vector2 first =
      (1.0 / Length(out)) * (radius * out + this->Heights[t][PreviousCorner(c)] * Normal(out));
    const Vector2 last =
      (1.0 / Length(in)) * (radius * in - this->Heights[t][NextCorner(c)] * Normal(in));
    const double sine = Cross(first, last) / std::sqrt(Dot(first, first) * Dot(last, last));
    // See "Vertices without a linear program" in Documentation/cubic.md.
    const double turn =
      std::sqrt(SquaredNorm(mean - this->Affines[t]) * squares) / determinant * (1.0 + 2.8 / sine);
    const double bound = 1.0 - own.Fall - turn * (2.0 + 2.0 * own.Slope + turn) - rounding;
    close = sine > 0.0 && condition < greatestCondition && bound > enough;
    own.Corners[c] = static_cast<float>(bound);
  });
  if (!close)
  {
    fans.ForEach(this->Pair, point, [&](int t, int c) { bounds[t].Corners[c] = 0.0F; });
    return false;
  }
  this->Kinds[point] = VertexKind::Differentiable;
  return true;
}

//------------------------------------------------------------------------------
VertexFan CubicTemplate::GetFan(int point, const PointFan& fan) const
{
  VertexFan result;
  result.Closed = fan.Closed;
  for (int t : fan.Triangles)
  {
    result.Sectors.push_back(
      GetSector(this->GetCut(t), this->GetAffine(t), this->Pair.GetCorner(t, point)));
  }
  return result;
}

//------------------------------------------------------------------------------
std::unique_ptr<CubicTemplate::Exception> CubicTemplate::FindDerivative(
  int point, const PointFans& fans)
{
  const PointFan triangles = fans.Get(this->Pair, point);
  VertexFan fan = this->GetFan(point, triangles);
  bool possible = fans.Touching[point] == 0;
  if (possible && !fan.Closed)
  {
    // On a boundary that is straight up to the rounding of its points, or turns to the same side of
    // straight in both meshes.
    const int first = triangles.Triangles.front();
    const int last = triangles.Triangles.back();
    const int ends[2] = {
      this->Pair.Triangles[first][NextCorner(this->Pair.GetCorner(first, point))],
      this->Pair.Triangles[last][PreviousCorner(this->Pair.GetCorner(last, point))]
    };
    int turns[2];
    for (int domain = 0; domain < 2; ++domain)
    {
      const LargeVector<Vector2>& points = domain == 0 ? this->Pair.Source : this->Pair.Target;
      const Vector2 here = points[point];
      const Vector2 start = points[ends[0]] - here;
      const Vector2 end = points[ends[1]] - here;
      const double cross = Cross(start, end);
      double coordinates = 0.0;
      for (const Vector2& p : { here, points[ends[0]], points[ends[1]] })
      {
        coordinates = std::max({ coordinates, std::abs(p.x), std::abs(p.y) });
      }
      const double rounding = 0x1p-50 * coordinates * (Length(start) + Length(end));
      turns[domain] =
        std::abs(cross) <= rounding && Dot(start, end) < 0.0 ? 0 : (cross > 0.0 ? 1 : -1);
    }
    possible = turns[0] == turns[1];
    fan.Straight = possible && turns[0] == 0;
    this->Boundary[point] = fan.Straight ? 2 : 1;
  }
  VertexDerivative derivative;
  if (possible)
  {
    derivative = FindVertexDerivative(fan);
  }
  this->Derivatives[point] = derivative.Derivative;
  this->Kinds[point] = VertexKind::Differentiable;
  if (derivative.Margin > 0.0)
  {
    return nullptr;
  }
  auto exception = std::make_unique<Exception>();
  exception->Point = point;
  if (possible && FindVertexRings(fan, exception->Rings))
  {
    this->Kinds[point] = VertexKind::Rings;
    this->Derivatives[point] = exception->Rings.Center.Derivative;
  }
  else
  {
    this->Kinds[point] = VertexKind::Exceptional;
    exception->Rings.Outlines = { GetHomogeneousOutline(fan) };
  }
  exception->Fan = std::move(fan);
  exception->Triangles = triangles.Triangles;
  return exception;
}

//------------------------------------------------------------------------------
double CubicTemplate::GetDeviation(const PointFan& fan, int point, const Exception* exception) const
{
  double greatest = 0.0;
  for (const int t : fan.Triangles)
  {
    const Matrix2 affine = this->GetAffine(t);
    const int corner = this->Pair.GetCorner(t, point);
    if (exception)
    {
      this->VisitRings(*exception, t, [&](const CubicElement& element, double factor) {
        double farthest = 0.0;
        for (const Vector2& p : element.Points)
        {
          farthest = std::max(farthest, Length((element.Affine - affine) * p));
        }
        greatest = std::max(greatest, factor * (farthest + GreatestDisplacement(element)));
      });
      continue;
    }
    const TriangleCut cut = this->GetCut(t);
    for (int element = 3 * corner; element < 3 * corner + 3; ++element)
    {
      greatest =
        std::max(greatest, GreatestDisplacement(this->GetElement(cut, affine, t, element)));
    }
  }
  return greatest;
}

//------------------------------------------------------------------------------
const CubicTemplate::Exception& CubicTemplate::GetException(int point) const
{
  return *std::lower_bound(this->Exceptions.begin(), this->Exceptions.end(), point,
    [](const Exception& exception, int id) { return exception.Point < id; });
}

//------------------------------------------------------------------------------
const VertexRings& CubicTemplate::GetRings(int point) const
{
  return this->GetException(point).Rings;
}

//------------------------------------------------------------------------------
int CubicTemplate::GetNumberOfRings(int point) const
{
  return this->Kinds[point] == VertexKind::Rings ? this->GetRings(point).GetNumberOfRings() : 0;
}

//------------------------------------------------------------------------------
TriangleCut CubicTemplate::GetCut(int triangle) const
{
  TriangleCut cut;
  cut.Corners = this->Pair.GetSourceCorners(triangle);
  cut.Heights = this->Heights[triangle];
  const std::array<std::int32_t, 3>& corners = this->Pair.Triangles[triangle];
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 edge =
      this->Pair.Source[corners[PreviousCorner(k)]] - this->Pair.Source[corners[NextCorner(k)]];
    cut.Lengths[k] = Length(edge);
    cut.Along[k] = (1.0 / cut.Lengths[k]) * edge;
    cut.Radii[k] = this->Radii[corners[k]];
  }
  return cut;
}

//------------------------------------------------------------------------------
Matrix2 CubicTemplate::GetGradient(
  const TriangleCut& cut, const Matrix2& affine, int triangle, int node) const
{
  if (node < 3)
  {
    return this->Derivatives[this->Pair.Triangles[triangle][node]] - affine;
  }
  if (node >= 9)
  {
    return {};
  }
  const int neighbor = this->Pair.Neighbors[triangle][(node - 3) / 2];
  if (neighbor < 0)
  {
    return {};
  }
  // The derivatives differ only across the edge: the difference of the affine maps is w n^T.
  const Vector2 normal = Normal(cut.Along[(node - 3) / 2]);
  const Matrix2 across = this->GetAffine(neighbor);
  const double d = affine.Determinant();
  const double share = d / (d + across.Determinant());
  return OuterProduct(share * ((across - affine) * normal), normal);
}

//------------------------------------------------------------------------------
CubicElement CubicTemplate::GetElement(
  const TriangleCut& cut, const Matrix2& affine, int triangle, int element) const
{
  const int origin = TriangleCut::GetOrigin(element);
  CubicElement result;
  result.Affine = affine;
  for (int i = 0; i < 3; ++i)
  {
    const int node = TriangleCut::Elements[element][i];
    result.Points[i] = cut.GetNode(node, origin);
    result.Gradients[i] = this->GetGradient(cut, affine, triangle, node);
  }
  if (!cut.SetRightAngle(element, result))
  {
    return result;
  }
  // At edge points, the derivative along the edge is exactly that of the affine map.
  RightAngle& right = result.Right;
  for (int i = 0; i < 3; ++i)
  {
    const bool atVertex = TriangleCut::Elements[element][i] < 3;
    right.ByTangent[i] = atVertex ? result.Gradients[i] * right.Tangent : Vector2{};
    right.ByNormal[i] = result.Gradients[i] * right.Normal;
  }
  return result;
}

//------------------------------------------------------------------------------
void CubicTemplate::EvaluateRings(
  int triangle, int corner, const Vector2& point, Vector2& image, Matrix2& derivative) const
{
  const int id = this->Pair.Triangles[triangle][corner];
  const Exception& exception = this->GetException(id);
  const bool endless = this->Kinds[id] == VertexKind::Exceptional;
  const int sector =
    static_cast<int>(std::find(exception.Triangles.begin(), exception.Triangles.end(), triangle) -
      exception.Triangles.begin());
  const FanSector& s = exception.Fan.Sectors[sector];
  const std::vector<VertexRings::Outline>& outlines = exception.Rings.Outlines;
  const int part = FindPart(s, point);
  const double gauge = GetGauge(s, part, point);
  if (!(gauge > 0.0))
  {
    image = outlines.back().Affine[sector] * point;
    derivative = endless ? outlines.back().Affine[sector] : exception.Rings.Center.Derivative;
    return;
  }
  int ring =
    std::max(0, static_cast<int>(std::floor(std::log(gauge) / std::log(VertexRings::Ratio))));
  const bool center = !endless && ring >= exception.Rings.GetNumberOfRings();
  ring = center ? exception.Rings.GetNumberOfRings() : ring;
  const double scale = std::pow(VertexRings::Ratio, ring);
  // The scale is a power of two, so nothing is rounded.
  const Vector2 scaled = (1.0 / scale) * point;
  CubicElement element;
  if (center)
  {
    FanSector star = s;
    const VertexRings::Outline& outline = outlines.back();
    star.Affine = outline.Affine[sector];
    const std::size_t next =
      static_cast<std::size_t>(sector) + 1 == outline.Rays.size() && exception.Fan.Closed
      ? 0
      : static_cast<std::size_t>(sector) + 1;
    element = GetCornerElements(
      star, exception.Rings.Center.Derivative, outline.Rays[sector], outline.Rays[next])[part];
  }
  else
  {
    const std::array<CubicElement, 6> elements =
      GetRingElements(exception.Fan, outlines[endless ? 0 : ring],
        outlines[endless ? 0 : static_cast<std::size_t>(ring) + 1], sector);
    // Choose the element in which the point is less outside.
    const Barycentric first = ToBarycentric(elements[2 * part].Points, scaled);
    const Barycentric second = ToBarycentric(elements[2 * part + 1].Points, scaled);
    const bool takeFirst = *std::min_element(first.begin(), first.end()) >=
      *std::min_element(second.begin(), second.end());
    element = elements[2 * part + (takeFirst ? 0 : 1)];
  }
  Vector2 value;
  Matrix2 gradient;
  homeomorphism::Evaluate(
    element, GetOrdinates(element), Inside(ToBarycentric(element.Points, scaled)), value, gradient);
  image = scale * (element.Affine * scaled + value);
  derivative = element.Affine + gradient;
}

//------------------------------------------------------------------------------
void CubicTemplate::Evaluate(
  int triangle, const Vector2& point, Vector2& image, Matrix2& derivative) const
{
  const TriangleCut cut = this->GetCut(triangle);
  const Matrix2 affine = this->GetAffine(triangle);
  const int number = cut.Find(point);
  if (number >= TriangleCut::FirstMiddle)
  {
    image = affine * point;
    derivative = affine;
    return;
  }
  const int origin = TriangleCut::GetOrigin(number);
  const Vector2 local = point - cut.Corners[origin];
  const std::array<std::int32_t, 3>& corners = this->Pair.Triangles[triangle];
  if (number < TriangleCut::FirstStrip &&
    this->Kinds[corners[origin]] != VertexKind::Differentiable)
  {
    this->EvaluateRings(triangle, origin, local, image, derivative);
  }
  else
  {
    const CubicElement element = this->GetElement(cut, affine, triangle, number);
    Vector2 value;
    Matrix2 gradient;
    homeomorphism::Evaluate(
      element, GetOrdinates(element), ToBarycentric(element.Points, local), value, gradient);
    image = affine * local + value;
    derivative = affine + gradient;
  }
  image = image + (this->Pair.Target[corners[origin]] - this->Pair.Target[corners[0]]);
}

//------------------------------------------------------------------------------
void CubicTemplate::VisitRings(int triangle, int corner,
  const std::function<void(const CubicElement&, double factor)>& visit) const
{
  this->VisitRings(this->GetException(this->Pair.Triangles[triangle][corner]), triangle, visit);
}

//------------------------------------------------------------------------------
void CubicTemplate::VisitRings(const Exception& exception, int triangle,
  const std::function<void(const CubicElement&, double factor)>& visit) const
{
  const int sector =
    static_cast<int>(std::find(exception.Triangles.begin(), exception.Triangles.end(), triangle) -
      exception.Triangles.begin());
  const std::vector<VertexRings::Outline>& outlines = exception.Rings.Outlines;
  const bool endless = this->Kinds[exception.Point] == VertexKind::Exceptional;
  // One ring stands for all of an endless sequence.
  const std::size_t rings = endless ? 1 : outlines.size() - 1;
  for (std::size_t j = 0; j < rings; ++j)
  {
    for (const CubicElement& element :
      GetRingElements(exception.Fan, outlines[j], outlines[endless ? j : j + 1], sector))
    {
      visit(element, std::pow(VertexRings::Ratio, static_cast<double>(j)));
    }
  }
  if (!endless)
  {
    const VertexRings::Outline& outline = outlines.back();
    FanSector star = exception.Fan.Sectors[sector];
    star.Affine = outline.Affine[sector];
    const std::size_t next = static_cast<std::size_t>(sector) + 1;
    for (const CubicElement& element :
      GetCornerElements(star, exception.Rings.Center.Derivative, outline.Rays[sector],
        outline.Rays[next == outline.Rays.size() && exception.Fan.Closed ? 0 : next]))
    {
      visit(element, std::pow(VertexRings::Ratio, static_cast<double>(rings)));
    }
  }
}

//------------------------------------------------------------------------------
double CubicTemplate::GetCertificate(int triangle) const
{
  if (this->Certificates[triangle] > 0.0F)
  {
    return this->Certificates[triangle];
  }
  const TriangleCut cut = this->GetCut(triangle);
  const Matrix2 affine = this->GetAffine(triangle);
  const double determinant = affine.Determinant();
  // The middle is affine.
  double least = determinant;
  for (int number = 0; number < TriangleCut::FirstMiddle; ++number)
  {
    const int origin = TriangleCut::GetOrigin(number);
    if (number < TriangleCut::FirstStrip &&
      this->Kinds[this->Pair.Triangles[triangle][origin]] != VertexKind::Differentiable)
    {
      if (number % 3 == 0)
      {
        this->VisitRings(triangle, origin, [&least](const CubicElement& element, double) {
          least = std::min(least, LeastDeterminant(element));
        });
      }
      continue;
    }
    least = std::min(least, LeastDeterminant(this->GetElement(cut, affine, triangle, number)));
  }
  return least / determinant;
}

} // namespace homeomorphism
