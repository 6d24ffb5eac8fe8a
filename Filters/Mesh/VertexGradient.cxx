// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Mesh/VertexGradient.h"

#include "Kernel/LinearProgram.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace homeomorphism
{
namespace
{

using Complex = std::complex<double>;

constexpr double Pi = 3.141592653589793;
// A derivative with this margin is accepted without a search for a better one.
constexpr double GoodMargin = 0.02;

Complex ToComplex(const Vector2& v)
{
  return { v.x, v.y };
}

Vector2 Rotated(const Vector2& v)
{
  return { -v.y, v.x };
}

Vector2 Normalized(const Vector2& v)
{
  return (1.0 / std::sqrt(Dot(v, v))) * v;
}

double OperatorNorm(const Matrix2& m)
{
  const double squares = SquaredNorm(m);
  const double d = m.Determinant();
  const double difference = std::sqrt(std::max(0.0, squares * squares - 4.0 * d * d));
  return std::sqrt(0.5 * (squares + difference));
}

double LeastCoefficient(const CubicElement& element)
{
  const DeterminantCoefficients c = GetDeterminantCoefficients(element);
  double least = c[0];
  for (double coefficient : c)
  {
    least = coefficient < least || std::isnan(coefficient) ? coefficient : least;
  }
  return least;
}

// Adds the multiple of 2 pi to an angle that brings it within half a turn of a reference.
double Near(double angle, double reference)
{
  return angle - 2.0 * Pi * std::round((angle - reference) / (2.0 * Pi));
}

// Positions of the rays and of their images as logarithms, continuous around the vertex.
struct RayLogarithms
{
  std::vector<Complex> Source;
  std::vector<Complex> Image;

  explicit RayLogarithms(const VertexFan& fan)
  {
    const std::size_t n = fan.Sectors.size();
    for (std::size_t i = 0; i <= n; ++i)
    {
      const FanSector& sector = fan.Sectors[i < n ? i : n - 1];
      const Vector2 ray = i < n ? sector.Start : sector.End;
      Complex source = std::log(ToComplex(ray));
      Complex image = std::log(ToComplex(sector.Affine * ray));
      if (i > 0)
      {
        // A sector turns by less than half a turn, to the left.
        source.imag(Near(source.imag(), this->Source.back().imag() + 0.5 * Pi));
        image.imag(Near(image.imag(), this->Image.back().imag() + 0.5 * Pi));
      }
      else
      {
        image.imag(Near(image.imag(), source.imag()));
      }
      this->Source.push_back(source);
      this->Image.push_back(image);
    }
  }
};

// The linear map z -> a z + b conj(z) that fits log(f(z) / z) best, integrated over directions: its
// Fourier coefficients at 1 and at conj(z)/z are log a and, to first order, b/a.
Matrix2 FitLogarithm(const VertexFan& fan)
{
  const RayLogarithms rays(fan);
  static const double nodes[4] = { 0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
    0.9305681557970263 };
  static const double weights[4] = { 0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
    0.1739274225687269 };
  Complex mean = 0.0;
  Complex first = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < fan.Sectors.size(); ++i)
  {
    const double start = rays.Source[i].imag();
    const double width = rays.Source[i + 1].imag() - start;
    double turn = rays.Image[i].imag() - start;
    for (int n = 0; n < 4; ++n)
    {
      const double angle = start + nodes[n] * width;
      const Vector2 direction{ std::cos(angle), std::sin(angle) };
      Complex value = std::log(ToComplex(fan.Sectors[i].Affine * direction) / ToComplex(direction));
      // Turns of neighboring directions differ by less than half a turn.
      value.imag(Near(value.imag(), turn));
      turn = value.imag();
      mean += width * weights[n] * value;
      first += width * weights[n] * value * std::polar(1.0, 2.0 * angle);
      total += width * weights[n];
    }
  }
  const Complex a = std::exp(mean / total);
  Complex ratio = first / total;
  const double size = std::abs(ratio);
  ratio = size > 0.9 ? ratio * (0.9 / size) : ratio;
  const Complex b = a * ratio;
  const Complex x = a + b;
  const Complex y = Complex(0.0, 1.0) * (a - b);
  return { { x.real(), x.imag() }, { y.real(), y.imag() } };
}

Matrix2 Multiply(const Matrix2& a, const Matrix2& b)
{
  return { a * b.ImageOfX, a * b.ImageOfY };
}

// The mean of the sectors' derivatives, weighted by area.
Matrix2 GetMeanDerivative(const VertexFan& fan)
{
  Matrix2 mean{};
  double total = 0.0;
  for (const FanSector& sector : fan.Sectors)
  {
    const double area = Cross(sector.Start, sector.End);
    mean = mean + area * sector.Affine;
    total += area;
  }
  return (1.0 / total) * mean;
}

// The linear map that fits the fan best. If the mean of the sectors' derivatives is close to all of
// them, the remainder is fitted, so that affine pairs are reproduced up to rounding.
Matrix2 FitLinear(const VertexFan& fan)
{
  const Matrix2 mean = GetMeanDerivative(fan);
  const double determinant = mean.Determinant();
  if (!(determinant > 0.0))
  {
    return FitLogarithm(fan);
  }
  const Matrix2 inverse = (1.0 / determinant) *
    Matrix2{ { mean.ImageOfY.y, -mean.ImageOfX.y }, { -mean.ImageOfY.x, mean.ImageOfX.x } };
  VertexFan rest = fan;
  for (FanSector& sector : rest.Sectors)
  {
    sector.Affine = Multiply(inverse, sector.Affine);
    if (SquaredNorm(sector.Affine - Matrix2{ { 1.0, 0.0 }, { 0.0, 1.0 } }) > 0.25)
    {
      return FitLogarithm(fan);
    }
  }
  return Multiply(mean, FitLogarithm(rest));
}

// The linear maps among which the derivative at a vertex is looked for.
std::vector<Matrix2> GetBasis(const VertexFan& fan)
{
  if (fan.Closed)
  {
    return { { { 1.0, 0.0 }, {} }, { { 0.0, 1.0 }, {} }, { {}, { 1.0, 0.0 } },
      { {}, { 0.0, 1.0 } } };
  }
  // Boundary directions go to those of their images: the dual basis of the directions.
  const FanSector& first = fan.Sectors.front();
  const FanSector& last = fan.Sectors.back();
  const Vector2 start = Normalized(first.Start);
  const Vector2 imageOfStart = Normalized(first.Affine * first.Start);
  if (fan.Straight)
  {
    const Vector2 normal = Rotated(start);
    return { OuterProduct(imageOfStart, start), OuterProduct(imageOfStart, normal),
      OuterProduct(Rotated(imageOfStart), normal) };
  }
  const Vector2 end = Normalized(last.End);
  const Vector2 imageOfEnd = Normalized(last.Affine * last.End);
  const double area = Cross(start, end);
  return { OuterProduct(imageOfStart, (-1.0 / area) * Rotated(end)),
    OuterProduct(imageOfEnd, (1.0 / area) * Rotated(start)) };
}

double MeanStretch(const VertexFan& fan)
{
  double sum = 0.0;
  for (const FanSector& sector : fan.Sectors)
  {
    sum += std::log(sector.Affine.Determinant());
  }
  return std::exp(0.5 * sum / static_cast<double>(fan.Sectors.size()));
}

double GreatestNorm(const VertexFan& fan)
{
  double greatest = 0.0;
  for (const FanSector& sector : fan.Sectors)
  {
    greatest = std::max(greatest, OperatorNorm(sector.Affine));
  }
  return greatest;
}

// Coefficients in which the vertex has weight 3: their linear part in the vertex's derivative
// decides for small derivatives.
struct VertexWeights
{
  std::vector<int> Three;

  VertexWeights()
  {
    const std::array<QuarticIndex, 15>& indices = QuarticIndices();
    for (int n = 0; n < 15; ++n)
    {
      // The vertex is corner 0: it starts the edge of piece 2 and ends that of piece 1.
      if (indices[n].End == 3)
      {
        this->Three.push_back(15 + n);
      }
      if (indices[n].Start == 3)
      {
        this->Three.push_back(30 + n);
      }
    }
  }
};

template <int Dimension>
bool SolveProgram(const std::vector<std::array<double, 4>>& rows, std::array<double, 4>& weights)
{
  // The unknowns are the weights of the basis and the least slack, which is maximized.
  std::vector<HalfSpace<Dimension + 1>> halfSpaces;
  // A fixed shuffle: Seidel's algorithm is linear on average over the orders.
  const std::size_t count = rows.size();
  std::size_t step = count / 2 + 1;
  const auto divides = [count](std::size_t s) {
    std::size_t a = count;
    while (s != 0)
    {
      const std::size_t rest = a % s;
      a = s;
      s = rest;
    }
    return a != 1;
  };
  while (step < count && divides(step))
  {
    ++step;
  }
  for (std::size_t n = 0, at = 0; n < count; ++n, at = (at + step) % count)
  {
    HalfSpace<Dimension + 1> halfSpace{};
    double squares = 0.0;
    for (int i = 0; i < Dimension; ++i)
    {
      squares += rows[at][i] * rows[at][i];
    }
    const double length = std::sqrt(squares);
    if (!(length > 0.0))
    {
      return false;
    }
    for (int i = 0; i < Dimension; ++i)
    {
      halfSpace.Normal[i] = -rows[at][i] / length;
    }
    halfSpace.Normal[Dimension] = 1.0;
    halfSpaces.push_back(halfSpace);
  }
  std::array<double, Dimension + 1> objective{};
  objective[Dimension] = 1.0;
  std::array<double, Dimension + 1> bounds;
  bounds.fill(1.0);
  bounds[Dimension] = 10.0;
  std::array<double, Dimension + 1> x;
  if (!MaximizeLinear<Dimension + 1>(objective, halfSpaces, bounds, x) || !(x[Dimension] > 0.0))
  {
    return false;
  }
  std::copy_n(x.begin(), Dimension, weights.begin());
  return true;
}

Matrix2 Combine(const std::vector<Matrix2>& basis, const std::array<double, 4>& weights)
{
  Matrix2 sum{};
  for (std::size_t i = 0; i < basis.size(); ++i)
  {
    sum = sum + weights[i] * basis[i];
  }
  return sum;
}

double LeastSlack(const std::vector<std::array<double, 4>>& rows, const std::array<double, 4>& w)
{
  double least = std::numeric_limits<double>::infinity();
  for (const std::array<double, 4>& row : rows)
  {
    double value = 0.0;
    double squares = 0.0;
    for (int i = 0; i < 4; ++i)
    {
      value += row[i] * w[i];
      squares += row[i] * row[i];
    }
    least = std::min(least, value / std::sqrt(squares));
  }
  return least;
}

// The direction of the derivative that keeps all coefficients of weight 3 farthest above zero as
// the derivative shrinks. Returns false if none keeps them positive.
bool SolveForDirection(
  const VertexFan& fan, const std::vector<Matrix2>& rayGradients, Matrix2& direction)
{
  static const VertexWeights vertexWeights;
  const std::vector<Matrix2> basis = GetBasis(fan);
  const double stretch = MeanStretch(fan);
  std::vector<std::array<double, 4>> rows;
  for (std::size_t s = 0; s < fan.Sectors.size(); ++s)
  {
    const std::size_t next = fan.Closed && s + 1 == fan.Sectors.size() ? 0 : s + 1;
    const std::size_t first = rows.size();
    rows.resize(first + 3 * vertexWeights.Three.size());
    for (std::size_t i = 0; i < basis.size(); ++i)
    {
      const std::array<CubicElement, 3> plus =
        GetCornerElements(fan.Sectors[s], stretch * basis[i], rayGradients[s], rayGradients[next]);
      const std::array<CubicElement, 3> minus =
        GetCornerElements(fan.Sectors[s], -stretch * basis[i], rayGradients[s], rayGradients[next]);
      for (int e = 0; e < 3; ++e)
      {
        const DeterminantCoefficients a = GetDeterminantCoefficients(plus[e]);
        const DeterminantCoefficients b = GetDeterminantCoefficients(minus[e]);
        for (std::size_t n = 0; n < vertexWeights.Three.size(); ++n)
        {
          rows[first + e * vertexWeights.Three.size() + n][i] =
            0.5 * (a[vertexWeights.Three[n]] - b[vertexWeights.Three[n]]);
        }
      }
    }
  }
  std::array<double, 4> weights{};
  const bool solved = basis.size() == 4 ? SolveProgram<4>(rows, weights)
    : basis.size() == 3                 ? SolveProgram<3>(rows, weights)
                                        : SolveProgram<2>(rows, weights);
  if (!solved)
  {
    return false;
  }
  direction = Combine(basis, weights);
  // Raise the determinant inside the cone of the constraints, by steps along its gradient that keep
  // part of the slack.
  const auto normalizedDeterminant = [&basis](const std::array<double, 4>& w) {
    const Matrix2 m = Combine(basis, w);
    return m.Determinant() / SquaredNorm(m);
  };
  double determinant = normalizedDeterminant(weights);
  double step = 0.5;
  for (int round = 0; round < 200 && determinant < 0.1 && step > 1e-6; ++round)
  {
    const Matrix2 m = Combine(basis, weights);
    const Matrix2 cofactors{ { m.ImageOfY.y, -m.ImageOfY.x }, { -m.ImageOfX.y, m.ImageOfX.x } };
    const double size = std::sqrt(SquaredNorm(m));
    std::array<double, 4> moved = weights;
    for (std::size_t i = 0; i < basis.size(); ++i)
    {
      moved[i] += step *
        (Dot(cofactors.ImageOfX, basis[i].ImageOfX) + Dot(cofactors.ImageOfY, basis[i].ImageOfY));
    }
    const double better = normalizedDeterminant(moved);
    if (better > determinant && LeastSlack(rows, moved) > 1e-3 * size)
    {
      weights = moved;
      determinant = better;
      step *= 1.5;
    }
    else
    {
      step *= 0.5;
    }
  }
  direction = Combine(basis, weights);
  direction = (1.0 / std::sqrt(SquaredNorm(direction))) * direction;
  return direction.Determinant() > 0.0;
}

void TryDerivative(const VertexFan& fan, const std::vector<Matrix2>& rayGradients,
  const Matrix2& derivative, double greatestNorm, VertexDerivative& best)
{
  if (!(derivative.Determinant() > 0.0))
  {
    return;
  }
  const double norm = OperatorNorm(derivative);
  const Matrix2 limited = norm > greatestNorm ? (greatestNorm / norm) * derivative : derivative;
  const double margin = GetFanMargin(fan, rayGradients, limited, best.Margin);
  if (margin > best.Margin)
  {
    best = { limited, margin };
  }
}

// A path between two stars. The images of the rays are given by logarithms, so their cyclic order
// is preserved and their lengths remain positive.
struct StarPath
{
  std::vector<Complex> Start;
  std::vector<Complex> End;

  double GetLength() const
  {
    double greatest = 0.0;
    for (std::size_t i = 0; i < this->Start.size(); ++i)
    {
      greatest = std::max(greatest, std::abs(this->End[i] - this->Start[i]));
    }
    return greatest;
  }
};

// The star and the map's derivatives at an outline. @a rate is the derivative of @a share with
// respect to the logarithm of the radius.
VertexRings::Outline GetOutline(
  const VertexFan& fan, const StarPath& path, double share, double rate)
{
  const std::size_t n = fan.Sectors.size();
  std::vector<Vector2> images(n + 1);
  std::vector<Vector2> changes(n + 1);
  for (std::size_t i = 0; i <= n; ++i)
  {
    const Complex difference = path.End[i] - path.Start[i];
    const Complex image = std::exp(path.Start[i] + share * difference);
    const Complex change = rate * image * difference;
    images[i] = { image.real(), image.imag() };
    changes[i] = { change.real(), change.imag() };
  }
  if (fan.Closed)
  {
    images[n] = images[0];
    changes[n] = changes[0];
  }
  VertexRings::Outline outline;
  VertexFan star = fan;
  std::vector<Matrix2> drift(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const FanSector& sector = fan.Sectors[i];
    const std::array<Vector2, 3> from{ Vector2{}, sector.Start, sector.End };
    star.Sectors[i].Affine = AffineDerivative(from, { Vector2{}, images[i], images[i + 1] });
    drift[i] = AffineDerivative(from, { Vector2{}, changes[i], changes[i + 1] });
    outline.Affine.push_back(star.Sectors[i].Affine);
  }
  outline.Rays = GetRayGradients(star);
  for (std::size_t i = 0; i < outline.Rays.size(); ++i)
  {
    const Vector2 ray = i < n ? fan.Sectors[i].Start : fan.Sectors[n - 1].End;
    outline.Rays[i] = outline.Rays[i] + OuterProduct(changes[i], (1.0 / Dot(ray, ray)) * ray);
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    const FanSector& sector = fan.Sectors[i];
    for (int end = 0; end < 2; ++end)
    {
      const Vector2 point = end == 0 ? sector.InnerStart : sector.InnerEnd;
      const Matrix2 gradient =
        outline.Affine[i] + OuterProduct(drift[i] * point, (1.0 / Dot(point, point)) * point);
      (end == 0 ? outline.InnerStart : outline.InnerEnd).push_back(gradient);
    }
  }
  return outline;
}

VertexFan GetStar(const VertexFan& fan, const VertexRings::Outline& outline)
{
  VertexFan star = fan;
  for (std::size_t i = 0; i < star.Sectors.size(); ++i)
  {
    star.Sectors[i].Affine = outline.Affine[i];
  }
  return star;
}

bool IsRingCertified(
  const VertexFan& fan, const VertexRings::Outline& outer, const VertexRings::Outline& inner)
{
  for (std::size_t s = 0; s < fan.Sectors.size(); ++s)
  {
    for (const CubicElement& element : GetRingElements(fan, outer, inner, static_cast<int>(s)))
    {
      if (!(LeastCoefficient(element) > 0.0) || !(LeastDeterminant(element) > 0.0))
      {
        return false;
      }
    }
  }
  return true;
}

} // anonymous namespace

//------------------------------------------------------------------------------
Matrix2 FitBoundary(const VertexFan& fan)
{
  const FanSector& first = fan.Sectors.front();
  const FanSector& last = fan.Sectors.back();
  const Vector2 start = Normalized(first.Start);
  const Vector2 imageOfStart = first.Affine * start;
  if (!fan.Straight)
  {
    // The stretches along the two edges for which the map is closest to the sectors' maps. Where
    // the boundary is almost straight, unequal stretches would result in a shear.
    const std::vector<Matrix2> basis = GetBasis(fan);
    const Vector2 imageOfEnd = last.Affine * Normalized(last.End);
    const auto product = [](const Matrix2& a, const Matrix2& b) {
      return Dot(a.ImageOfX, b.ImageOfX) + Dot(a.ImageOfY, b.ImageOfY);
    };
    const Matrix2 mean = GetMeanDerivative(fan);
    const double aa = product(basis[0], basis[0]);
    const double ab = product(basis[0], basis[1]);
    const double bb = product(basis[1], basis[1]);
    const double am = product(basis[0], mean);
    const double bm = product(basis[1], mean);
    const double determinant = aa * bb - ab * ab;
    std::array<double, 2> stretches{ std::sqrt(Dot(imageOfStart, imageOfStart)),
      std::sqrt(Dot(imageOfEnd, imageOfEnd)) };
    const std::array<double, 2> best{ (am * bb - bm * ab) / determinant,
      (bm * aa - am * ab) / determinant };
    for (std::size_t i = 0; i < 2; ++i)
    {
      // Cubics along the edges stay monotone up to three times their slope.
      const double own = stretches[i];
      stretches[i] = std::isfinite(best[i]) ? std::clamp(best[i], 0.2 * own, 2.5 * own) : own;
    }
    return stretches[0] * basis[0] + stretches[1] * basis[1];
  }
  const Vector2 imageOfEnd = last.Affine * Normalized(last.End);
  const double stretch =
    std::sqrt(std::sqrt(Dot(imageOfEnd, imageOfEnd) / Dot(imageOfStart, imageOfStart)));
  const Vector2 normal = Rotated(start);
  Vector2 imageOfNormal = first.Affine * normal;
  for (const FanSector& sector : fan.Sectors)
  {
    if (Cross(sector.Start, normal) >= 0.0 && Cross(normal, sector.End) >= 0.0)
    {
      imageOfNormal = sector.Affine * normal;
    }
  }
  return OuterProduct(stretch * imageOfStart, start) + OuterProduct(imageOfNormal, normal);
}

//------------------------------------------------------------------------------
Matrix2 HarmonicMean(const Matrix2& a, const Matrix2& b)
{
  const double d = a.Determinant();
  const double e = b.Determinant();
  return a + (d / (d + e)) * (b - a);
}

//------------------------------------------------------------------------------
std::vector<Matrix2> GetRayGradients(const VertexFan& fan)
{
  const std::size_t n = fan.Sectors.size();
  std::vector<Matrix2> rays(fan.Closed ? n : n + 1);
  for (std::size_t i = 0; i < n; ++i)
  {
    if (i > 0 || fan.Closed)
    {
      rays[i] = HarmonicMean(fan.Sectors[i > 0 ? i - 1 : n - 1].Affine, fan.Sectors[i].Affine);
    }
  }
  if (!fan.Closed)
  {
    rays[0] = fan.Sectors[0].Affine;
    rays[n] = fan.Sectors[n - 1].Affine;
  }
  return rays;
}

//------------------------------------------------------------------------------
std::array<CubicElement, 3> GetCornerElements(const FanSector& sector, const Matrix2& derivative,
  const Matrix2& startGradient, const Matrix2& endGradient)
{
  const Matrix2& affine = sector.Affine;
  const Matrix2 atVertex = derivative - affine;
  std::array<CubicElement, 3> elements{ { { { Vector2{}, sector.Start, sector.InnerStart }, affine,
                                            {}, { atVertex, startGradient - affine, Matrix2{} },
                                            {} },
    { { Vector2{}, sector.InnerStart, sector.InnerEnd }, affine, {},
      { atVertex, Matrix2{}, Matrix2{} }, {} },
    { { Vector2{}, sector.InnerEnd, sector.End }, affine, {},
      { atVertex, Matrix2{}, endGradient - affine }, {} } } };
  for (int end = 0; end < 2; ++end)
  {
    // The right angle is at the edge point, where the map differs from the affine one across the
    // edge only.
    CubicElement& element = elements[end == 0 ? 0 : 2];
    RightAngle& right = element.Right;
    right.Corner = end == 0 ? 1 : 2;
    right.Start = 0;
    right.Tangent = sector.Along[end];
    right.Normal = end == 0 ? Rotated(right.Tangent) : Vector2{ right.Tangent.y, -right.Tangent.x };
    right.AlongTangent = sector.Radius;
    right.AlongNormal = sector.Heights[end];
    right.ByTangent[0] = atVertex * right.Tangent;
    right.ByNormal[0] = atVertex * right.Normal;
    right.ByNormal[right.Corner] = element.Gradients[right.Corner] * right.Normal;
  }
  return elements;
}

//------------------------------------------------------------------------------
double GetFanMargin(const VertexFan& fan, const std::vector<Matrix2>& rayGradients,
  const Matrix2& derivative, double least)
{
  double margin = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < fan.Sectors.size() && margin > least; ++s)
  {
    const std::size_t next = fan.Closed && s + 1 == fan.Sectors.size() ? 0 : s + 1;
    const double determinant = fan.Sectors[s].Affine.Determinant();
    for (const CubicElement& element :
      GetCornerElements(fan.Sectors[s], derivative, rayGradients[s], rayGradients[next]))
    {
      double here = LeastCoefficient(element);
      if (here > 0.0)
      {
        here = LeastDeterminant(element, 0.0, 0);
      }
      margin = here / determinant < margin ? here / determinant : margin;
      if (!(margin > least))
      {
        return std::isnan(here) ? -std::numeric_limits<double>::infinity() : margin;
      }
    }
  }
  return margin;
}

//------------------------------------------------------------------------------
VertexDerivative FindVertexDerivative(const VertexFan& fan)
{
  const std::vector<Matrix2> rayGradients = GetRayGradients(fan);
  const double greatestNorm = GreatestNorm(fan);
  const Matrix2 fit = fan.Closed ? FitLinear(fan) : FitBoundary(fan);
  VertexDerivative best;
  best.Derivative = fit;
  best.Margin = 0.0;
  for (double scale : { 1.0, 0.7, 0.5, 0.35 })
  {
    TryDerivative(fan, rayGradients, scale * fit, greatestNorm, best);
    if (best.Margin >= GoodMargin)
    {
      return best;
    }
  }
  Matrix2 direction;
  if (SolveForDirection(fan, rayGradients, direction))
  {
    const double stretch = MeanStretch(fan);
    int failures = 0;
    for (int k = 0; k < 80 && failures < 6; ++k)
    {
      const double before = best.Margin;
      TryDerivative(
        fan, rayGradients, std::exp2(1.0 - 0.5 * k) * stretch * direction, greatestNorm, best);
      failures = best.Margin > 0.0 && best.Margin == before ? failures + 1 : 0;
    }
  }
  best.Margin = best.Margin > 0.0 ? best.Margin : -1.0;
  return best;
}

//------------------------------------------------------------------------------
std::array<CubicElement, 6> GetRingElements(const VertexFan& fan, const VertexRings::Outline& outer,
  const VertexRings::Outline& inner, int sector)
{
  constexpr double ratio = VertexRings::Ratio;
  const FanSector& s = fan.Sectors[sector];
  const std::size_t first = static_cast<std::size_t>(sector);
  const std::size_t last = first + 1 == outer.Rays.size() && fan.Closed ? 0 : first + 1;
  const Matrix2 affine = outer.Affine[first];
  // The inner outline's values as displacements from the outer outline's linear map.
  const Matrix2 change = inner.Affine[first] - affine;
  struct Node
  {
    Vector2 Point;
    Vector2 Value;
    Matrix2 Gradient;
  };
  const Node outerNodes[4] = { { s.Start, {}, outer.Rays[first] - affine },
    { s.InnerStart, {}, outer.InnerStart[first] - affine },
    { s.InnerEnd, {}, outer.InnerEnd[first] - affine }, { s.End, {}, outer.Rays[last] - affine } };
  Node innerNodes[4] = { { s.Start, {}, inner.Rays[first] - affine },
    { s.InnerStart, {}, inner.InnerStart[first] - affine },
    { s.InnerEnd, {}, inner.InnerEnd[first] - affine }, { s.End, {}, inner.Rays[last] - affine } };
  for (Node& node : innerNodes)
  {
    node.Point = ratio * node.Point;
    node.Value = change * node.Point;
  }
  const auto make = [&affine](const Node& a, const Node& b, const Node& c) {
    return CubicElement{ { a.Point, b.Point, c.Point }, affine, { a.Value, b.Value, c.Value },
      { a.Gradient, b.Gradient, c.Gradient } };
  };
  // Beside a ray the diagonal ends at the lower inner point.
  return { { make(innerNodes[0], outerNodes[0], innerNodes[1]),
    make(outerNodes[0], outerNodes[1], innerNodes[1]),
    make(innerNodes[1], outerNodes[1], innerNodes[2]),
    make(outerNodes[1], outerNodes[2], innerNodes[2]),
    make(innerNodes[2], outerNodes[3], innerNodes[3]),
    make(innerNodes[2], outerNodes[2], outerNodes[3]) } };
}

//------------------------------------------------------------------------------
VertexRings::Outline GetHomogeneousOutline(const VertexFan& fan)
{
  VertexRings::Outline outline;
  for (const FanSector& sector : fan.Sectors)
  {
    outline.Affine.push_back(sector.Affine);
  }
  outline.InnerStart = outline.Affine;
  outline.InnerEnd = outline.Affine;
  outline.Rays = GetRayGradients(fan);
  return outline;
}

namespace
{

// Adds rings along a path. The rate of change from ring to ring is zero at both ends and increases
// as long as the rings are certified. Returns true as soon as the star has a certified derivative,
// and false at the end of the path or if no next ring is certified.
bool FollowPath(const VertexFan& fan, const StarPath& path, double fastest, VertexRings& rings)
{
  const double ratioLogarithm = std::log(VertexRings::Ratio);
  // The innermost outline must stay well above what coordinates beside the vertex can represent.
  constexpr int greatestNumber = 46;
  const auto append = [&](double share, double rate) {
    if (rings.GetNumberOfRings() == greatestNumber)
    {
      return false;
    }
    rings.Outlines.push_back(GetOutline(fan, path, share, rate / ratioLogarithm));
    const VertexRings::Outline* const inner = &rings.Outlines.back();
    const bool certified = IsRingCertified(fan, inner[-1], inner[0]);
    if (!certified)
    {
      rings.Outlines.pop_back();
    }
    return certified;
  };
  // The share of the path that has been covered, and its increase from ring to ring.
  double share = 0.0;
  double rate = 0.0;
  bool isLast = false;
  while (true)
  {
    if (rate > 0.0 && append(share + 0.5 * rate, 0.0))
    {
      rings.Center = FindVertexDerivative(GetStar(fan, rings.Outlines.back()));
      if (rings.Center.Margin > 0.0 || isLast)
      {
        return rings.Center.Margin > 0.0;
      }
      rings.Outlines.pop_back();
    }
    // If the next ring has this rate, the one after it can end the path with rate zero.
    const double last = 1.0 - share - 0.5 * rate;
    bool isCertified = false;
    for (double factor : { 1.6, 1.2, 1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005 })
    {
      const double next = std::min({ fastest, factor * (rate > 0.0 ? rate : fastest), last });
      if (next > 0.0 && append(share + 0.5 * (rate + next), next))
      {
        isLast = next == last;
        share += 0.5 * (rate + next);
        rate = next;
        isCertified = true;
        break;
      }
    }
    if (!isCertified)
    {
      return false;
    }
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
bool FindVertexRings(const VertexFan& fan, VertexRings& rings)
{
  const RayLogarithms logarithms(fan);
  const std::size_t rays = logarithms.Source.size();
  // First, the images of the rays become equally long and keep their directions. Then they turn.
  double shortest = std::numeric_limits<double>::infinity();
  double longest = -shortest;
  double turn = 0.0;
  for (std::size_t i = 0; i < rays; ++i)
  {
    shortest = std::min(shortest, logarithms.Image[i].real());
    longest = std::max(longest, logarithms.Image[i].real());
    turn += (logarithms.Image[i] - logarithms.Source[i]).imag() / static_cast<double>(rays);
  }
  StarPath stretch{ logarithms.Image, logarithms.Image };
  for (Complex& end : stretch.End)
  {
    end.real(0.5 * (shortest + longest));
  }
  StarPath turning{ stretch.End, stretch.End };
  const Matrix2 boundary = fan.Closed ? Matrix2{} : FitBoundary(fan);
  for (std::size_t i = 0; i < rays; ++i)
  {
    Complex& end = turning.End[i];
    if (fan.Closed)
    {
      end.imag(logarithms.Source[i].imag() + turn);
      continue;
    }
    const FanSector& sector = fan.Sectors[std::min(i, rays - 2)];
    const double angle = end.imag();
    end = std::log(ToComplex(boundary * (i + 1 < rays ? sector.Start : sector.End)));
    end.imag(Near(end.imag(), i > 0 ? turning.End[i - 1].imag() + 0.5 * Pi : angle));
  }
  // The largest change of a logarithm from ring to ring: half the change of the radius's logarithm,
  // or less.
  for (double speed : { 0.35, 0.2, 0.1 })
  {
    rings.Outlines.assign(1, GetHomogeneousOutline(fan));
    bool hasDerivative = false;
    for (const StarPath* path : { &stretch, &turning })
    {
      hasDerivative = hasDerivative || FollowPath(fan, *path, speed / path->GetLength(), rings);
    }
    if (hasDerivative)
    {
      return true;
    }
  }
  rings.Outlines.clear();
  return false;
}

} // namespace homeomorphism
