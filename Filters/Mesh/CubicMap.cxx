// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Mesh/CubicMap.h"

#include "Kernel/Simd/CubicBatch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace homeomorphism
{
namespace
{

// The least ratio of twice the area to the sum of the squared edges. Nets of thinner triangles have
// inaccurate derivatives.
constexpr double LeastThickness = 1.0 / 16.0;
// Whether a triangle is counterclockwise in both domains, computed relative to corner 0 as in the
// map. Rounding can flip the parts of a refined needle. Fourth powers of the lengths must be
// representable.
bool IsPositive(const PlanarPair& pair, int triangle)
{
  constexpr double least = 1e-75;
  constexpr double greatest = 1e75;
  const auto isPositive = [](const std::array<Vector2, 3>& corners) {
    const double length = std::max(MaxNorm(corners[1]), MaxNorm(corners[2]));
    return length > least && length < greatest &&
      DifferenceOfProducts(corners[1].x, corners[2].y, corners[1].y, corners[2].x) > 0.0;
  };
  return isPositive(pair.GetSourceCorners(triangle)) && isPositive(pair.GetTargetCorners(triangle));
}

// Whether all elements of a triangle that is cut are thicker than the rounding errors of points. A
// cubic grows without bound at points outside its element.
bool IsResolved(const CubicTemplate& cubicTemplate, int triangle)
{
  constexpr double leastUlps = 4.0;
  const PlanarPair& pair = cubicTemplate.GetPair();
  double coordinates = 0.0;
  double thinnest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
  {
    const std::int32_t corner = pair.Triangles[triangle][k];
    coordinates = std::max(coordinates, MaxNorm(pair.Source[corner]));
    thinnest = std::min(
      { thinnest, cubicTemplate.GetRadius(corner), cubicTemplate.GetHeights(triangle)[k] });
  }
  return thinnest >= leastUlps * std::numeric_limits<double>::epsilon() * coordinates;
}

} // anonymous namespace

//------------------------------------------------------------------------------
CubicMap::CubicMap(PlanarPair pair, const CubicMapOptions& options, const ParallelFor& parallelFor)
  : Pair(std::move(pair))
{
  const int points = this->Pair.GetNumberOfPoints();
  const std::vector<std::int32_t> separated = this->Pair.SeparateParts();
  std::vector<std::uint8_t> isFree;
  if (options.Bending == CubicBending::Least && options.FairnessRefinement > 0)
  {
    this->Levels = options.FairnessRefinement;
    this->Fine = std::make_unique<PlanarPair>(this->Pair.Refine());
    for (int level = 1; level < this->Levels; ++level)
    {
      *this->Fine = this->Fine->Refine();
    }
    isFree.assign(this->Fine->Source.size(), 1);
    std::fill_n(isFree.begin(), this->Pair.Source.size(), std::uint8_t(0));
  }
  CubicTemplateOptions templateOptions;
  templateOptions.MaximumDeviation = options.MaximumDeviation;
  const auto makeTemplate = [&](bool onlyBoundary) {
    templateOptions.OnlyBoundary = onlyBoundary;
    this->Template = std::make_unique<CubicTemplate>(this->GetFine(), templateOptions, parallelFor);
  };
  if (options.Bending == CubicBending::Least)
  {
    BendingOptions bending;
    bending.MaximumDeviation = options.MaximumDeviation;
    bending.CertificateMargin = options.CertificateMargin;
    this->Bending = std::make_unique<BendingSolution>();
    bool isCertified = false;
    if (isFree.empty())
    {
      makeTemplate(true);
      isCertified = SolveWithWholeTriangles(*this->Template, bending, *this->Bending, parallelFor);
    }
    if (!isCertified)
    {
      makeTemplate(false);
      *this->Bending = SolveForLeastBending(*this->Template, bending, isFree, parallelFor);
    }
    this->Statistics.Bending = this->Bending->Statistics;
    if (this->Statistics.Bending.TookTemplate)
    {
      // The template is more accurate in closed form than by its nodes.
      this->Bending.reset();
    }
  }
  else
  {
    makeTemplate(false);
  }
  if (!this->Bending)
  {
    this->Template->FindMiddles(parallelFor);
  }
  else if (this->Bending->Nets.empty() &&
    std::find(this->Bending->Cuts.begin(), this->Bending->Cuts.end(), -1) !=
      this->Bending->Cuts.end())
  {
    const PlanarPair& fine = this->GetFine();
    this->Bending->Nets = LargeArray<CubicNet>(fine.Triangles.size());
    parallelFor(fine.GetNumberOfTriangles(), [&](std::int64_t begin, std::int64_t end) {
      for (int t = static_cast<int>(begin); t < end; ++t)
      {
        if (this->Bending->Cuts[t] < 0)
        {
          this->Bending->Nets[t] =
            CubicNet(this->Bending->GetWhole(fine, this->Template->GetAffine(t), t));
        }
      }
    });
  }
  if (this->Bending && !this->Bending->Nets.empty())
  {
    this->Inverses = LargeArray<InverseInterpolant>(this->Bending->Nets.size());
    parallelFor(this->GetFine().GetNumberOfTriangles(), [&](std::int64_t begin, std::int64_t end) {
      for (int t = static_cast<int>(begin); t < end; ++t)
      {
        if (this->IsWhole(t))
        {
          this->Inverses[t] = InverseInterpolant(this->Bending->Nets[t]);
        }
      }
    });
  }
  double coordinates = 0.0;
  for (const Vector2& target : this->Pair.Target)
  {
    coordinates = std::max(coordinates, MaxNorm(target));
  }
  this->ResidualTolerance = ResidualUlps * std::numeric_limits<double>::epsilon() * coordinates;
  const bool isKnown = this->Bending && !this->Bending->Certificates.empty();
  if (isKnown)
  {
    this->Certificates = std::move(this->Bending->Certificates);
  }
  else
  {
    this->Certificates.assign(this->Pair.Triangles.size(), 0.0);
  }
  LargeVector<std::int64_t> elements(this->Pair.Triangles.size(), 0);
  parallelFor(this->Pair.GetNumberOfTriangles(), [&](std::int64_t begin, std::int64_t end) {
    for (int t = static_cast<int>(begin); t < end; ++t)
    {
      // Triangles of the refined pair, the pair's own if it is not refined.
      const int children = 1 << (2 * this->Levels);
      const int firstChild = children * t;
      bool isPositive = true;
      for (int child = firstChild; child < firstChild + children; ++child)
      {
        isPositive = isPositive && IsPositive(this->GetFine(), child) &&
          (this->IsWhole(child) || IsResolved(*this->Template, child));
      }
      if (!isPositive)
      {
        this->Certificates[t] = 0.0;
        continue;
      }
      if (isKnown)
      {
        elements[t] = 1;
        continue;
      }
      if (!this->Bending)
      {
        double least = std::numeric_limits<double>::infinity();
        for (int child = firstChild; child < firstChild + children; ++child)
        {
          least = std::min(least, this->Template->GetCertificate(child));
        }
        this->Certificates[t] = least;
        elements[t] = static_cast<std::int64_t>(children) * TriangleCut::NumberOfElements;
        continue;
      }
      double least = std::numeric_limits<double>::infinity();
      this->VisitElements(
        t, [&](const CubicElement& element, const Vector2&, const Vector2&, double) {
          least = std::min(least, LeastDeterminant(element));
          ++elements[t];
        });
      this->Certificates[t] = least / this->Pair.GetAffine(t).Determinant();
    }
  });
  for (std::size_t t = 0; t < elements.size(); ++t)
  {
    this->Statistics.Elements += elements[t];
    this->Statistics.UncertifiedTriangles += this->Certificates[t] > 0.0 ? 0 : 1;
  }
  for (int point = 0; point < this->Pair.GetNumberOfPoints(); ++point)
  {
    this->Statistics.Rings += this->Template->GetNumberOfRings(point);
    if (this->Template->GetKind(point) == VertexKind::Exceptional)
    {
      (this->Template->IsBoundary(point) ? this->Statistics.ExceptionalBoundaryPoints
                                         : this->Statistics.ExceptionalInteriorPoints)
        .push_back(point < points ? point : separated[point - points]);
    }
  }
  // Where parts touch, each has its own derivative.
  std::vector<std::int32_t>& exceptional = this->Statistics.ExceptionalBoundaryPoints;
  exceptional.insert(exceptional.end(), separated.begin(), separated.end());
  std::sort(exceptional.begin(), exceptional.end());
  exceptional.erase(std::unique(exceptional.begin(), exceptional.end()), exceptional.end());
}

//------------------------------------------------------------------------------
int CubicMap::FindChild(int triangle, Barycentric& l) const
{
  int child = triangle;
  for (int level = 0; level < this->Levels; ++level)
  {
    int corner = 3;
    for (int c = 0; c < 3; ++c)
    {
      corner = l[c] > 0.5 ? c : corner;
    }
    if (corner < 3)
    {
      // Corner c stays; the others become midpoints.
      for (int c = 0; c < 3; ++c)
      {
        l[c] = c == corner ? 2.0 * l[c] - 1.0 : 2.0 * l[c];
      }
    }
    else
    {
      l = { 1.0 - 2.0 * l[0], 1.0 - 2.0 * l[1], 1.0 - 2.0 * l[2] };
    }
    child = 4 * child + corner;
  }
  return child;
}

//------------------------------------------------------------------------------
int CubicMap::FindChild(int triangle, const Vector2& point) const
{
  Barycentric l = this->GetBarycentric(triangle, point);
  return this->FindChild(triangle, l);
}

//------------------------------------------------------------------------------
void CubicMap::MapFine(
  int triangle, const Vector2& point, Vector2& image, Matrix2& derivative) const
{
  if (!this->Bending)
  {
    this->Template->Evaluate(triangle, point, image, derivative);
    return;
  }
  const PlanarPair& pair = this->GetFine();
  const Matrix2& affine = this->Template->GetAffine(triangle);
  const std::array<std::int32_t, 3>& corners = pair.Triangles[triangle];
  CubicElement element;
  Vector2 local = point;
  int origin = 0;
  if (this->Bending->Cuts[triangle] < 0)
  {
    element = this->Bending->GetWhole(pair, affine, triangle);
  }
  else
  {
    const TriangleCut cut = this->Template->GetCut(triangle);
    const int number = cut.Find(point);
    origin = TriangleCut::GetOrigin(number);
    local = point - cut.Corners[origin];
    if (number < TriangleCut::FirstStrip &&
      this->Template->GetKind(corners[origin]) != VertexKind::Differentiable)
    {
      this->Template->EvaluateRings(triangle, origin, local, image, derivative);
      image = image + (pair.Target[corners[origin]] - pair.Target[corners[0]]);
      return;
    }
    element = this->Bending->GetElement(pair, cut, affine, triangle, number);
  }
  Vector2 value;
  Matrix2 gradient;
  Evaluate(element, GetOrdinates(element), ToBarycentric(element.Points, local), value, gradient);
  image = affine * local + value + (pair.Target[corners[origin]] - pair.Target[corners[0]]);
  derivative = affine + gradient;
}

//------------------------------------------------------------------------------
bool CubicMap::IsInMiddle(int fineTriangle, const Barycentric& l) const
{
  const CubicTemplate::MiddleBounds& bounds = this->Template->GetMiddle(fineTriangle);
  bool isMiddle = true;
  for (int k = 0; k < 3; ++k)
  {
    isMiddle = isMiddle && l[k] > bounds.Least[k] && l[k] < bounds.Greatest[k];
  }
  return isMiddle;
}

//------------------------------------------------------------------------------
Vector2 CubicMap::MapPoint(
  int triangle, const Barycentric& l, const Vector2& point, CubicTriangle& prepared) const
{
  if (this->Levels == 0)
  {
    return this->MapFinePoint(triangle, l, point, prepared);
  }
  Barycentric inChild = l;
  const int child = this->FindChild(triangle, inChild);
  return this->MapFinePoint(child, inChild, point, prepared);
}

//------------------------------------------------------------------------------
Vector2 CubicMap::MapFinePoint(
  int child, const Barycentric& l, const Vector2& point, CubicTriangle& prepared) const
{
  const PlanarPair& pair = this->GetFine();
  const Vector2 origin = pair.Target[pair.Triangles[child][0]];
  if (this->IsWhole(child))
  {
    return origin + this->Bending->Nets[child](l);
  }
  if (!this->Bending && this->IsInMiddle(child, l))
  {
    const std::array<Vector2, 3> corners = pair.GetTargetCorners(child);
    // The same operations as in MapMiddle.
    return { origin.x + l[1] * corners[1].x + l[2] * corners[2].x,
      origin.y + l[1] * corners[1].y + l[2] * corners[2].y };
  }
  prepared.Set(child);
  return origin + prepared.Map(point - pair.Source[pair.Triangles[child][0]]);
}

//------------------------------------------------------------------------------
Matrix2 CubicMap::GetDerivative(int triangle, const Vector2& point, CubicTriangle& prepared) const
{
  const int child = this->Levels > 0 ? this->FindChild(triangle, point) : triangle;
  const PlanarPair& pair = this->GetFine();
  const Vector2 local = point - pair.Source[pair.Triangles[child][0]];
  const std::array<Vector2, 3> corners = pair.GetSourceCorners(child);
  const double area = Cross(corners[1], corners[2]);
  const Barycentric l = ToBarycentricByAreas(corners, local);
  if (this->IsWhole(child))
  {
    // The rounding errors of the net's ordinates are proportional to the longest edge.
    const Vector2 edge = corners[2] - corners[1];
    const double squares =
      Dot(corners[1], corners[1]) + Dot(corners[2], corners[2]) + Dot(edge, edge);
    if (LeastThickness * squares <= area)
    {
      return this->Bending->Nets[child].GetDerivative(l, corners, area);
    }
    const Matrix2& affine = this->Template->GetAffine(child);
    const CubicElement element = this->Bending->GetWhole(pair, affine, child);
    return affine + Derive(element, ToBarycentric(element.Points, local));
  }
  if (!this->Bending)
  {
    if (this->IsInMiddle(child, l))
    {
      return this->Template->GetAffine(child);
    }
    prepared.Set(child);
    return prepared.GetTemplateDerivative(local);
  }
  Vector2 image;
  Matrix2 derivative;
  this->MapFine(child, local, image, derivative);
  return derivative;
}

//------------------------------------------------------------------------------
void CubicMap::MoveToChildren(CubicBatch& batch) const
{
  for (int i = 0; this->Levels > 0 && i < batch.Count; ++i)
  {
    if (batch.Triangles[i] >= 0)
    {
      Barycentric l{ batch.L[0][i], batch.L[1][i], batch.L[2][i] };
      batch.Triangles[i] = this->FindChild(batch.Triangles[i], l);
      for (int k = 0; k < 3; ++k)
      {
        batch.L[k][i] = l[k];
      }
    }
  }
}

//------------------------------------------------------------------------------
void CubicMap::MapPoints(CubicBatch& batch, CubicTriangle& prepared) const
{
  this->MoveToChildren(batch);
  const PlanarPair& pair = this->GetFine();
  const double* const l[3] = { batch.L[0], batch.L[1], batch.L[2] };
  std::int64_t isMiddle[CubicBatch::Size];
  batch.ForEachRun([&](int begin, int end, int t) {
    const Vector2 origin = pair.Target[pair.Triangles[t][0]];
    if (this->IsWhole(t))
    {
      MapByNet(this->Bending->Nets[t], origin, l, begin, end, batch.ImageX, batch.ImageY);
      return;
    }
    if (!this->Bending)
    {
      const std::array<std::int32_t, 3>& corners = pair.Triangles[t];
      const CubicTemplate::MiddleBounds& bounds = this->Template->GetMiddle(t);
      MapMiddle({ origin, pair.Target[corners[1]], pair.Target[corners[2]] }, bounds.Least,
        bounds.Greatest, l, begin, end, batch.ImageX, batch.ImageY, isMiddle);
    }
    const Vector2 from = pair.Source[pair.Triangles[t][0]];
    for (int i = begin; i < end; ++i)
    {
      if (this->Bending || isMiddle[i] == 0)
      {
        prepared.Set(t);
        const Vector2 image = origin + prepared.Map(Vector2{ batch.X[i], batch.Y[i] } - from);
        batch.ImageX[i] = image.x;
        batch.ImageY[i] = image.y;
      }
    }
  });
}

//------------------------------------------------------------------------------
void CubicMap::VisitFine(int triangle,
  const std::function<void(const CubicElement& element, const Vector2& sourceOrigin,
    const Vector2& targetOrigin, double factor)>& visit,
  int endlessRings) const
{
  const PlanarPair& pair = this->GetFine();
  const std::array<std::int32_t, 3>& corners = pair.Triangles[triangle];
  const Matrix2& affine = this->Template->GetAffine(triangle);
  if (this->Bending && this->Bending->Cuts[triangle] < 0)
  {
    visit(this->Bending->GetWhole(pair, affine, triangle), pair.Source[corners[0]],
      pair.Target[corners[0]], 1.0);
    return;
  }
  const TriangleCut cut = this->Template->GetCut(triangle);
  for (int number = 0; number < TriangleCut::NumberOfElements; ++number)
  {
    const int origin = TriangleCut::GetOrigin(number);
    const Vector2 sourceOrigin = pair.Source[corners[origin]];
    const Vector2 targetOrigin = pair.Target[corners[origin]];
    const VertexKind kind = this->Template->GetKind(corners[origin]);
    if (number < TriangleCut::FirstStrip && kind != VertexKind::Differentiable)
    {
      if (number % 3 == 0)
      {
        const int repeats = kind == VertexKind::Exceptional ? endlessRings : 1;
        double scale = 1.0;
        for (int ring = 0; ring < repeats; ++ring, scale *= VertexRings::Ratio)
        {
          this->Template->VisitRings(
            triangle, origin, [&](const CubicElement& element, double factor) {
              visit(element, sourceOrigin, targetOrigin, scale * factor);
            });
        }
      }
      continue;
    }
    visit(this->Bending ? this->Bending->GetElement(pair, cut, affine, triangle, number)
                        : this->Template->GetElement(cut, affine, triangle, number),
      sourceOrigin, targetOrigin, 1.0);
  }
}

//------------------------------------------------------------------------------
void CubicMap::VisitElements(int triangle,
  const std::function<void(const CubicElement& element, const Vector2& sourceOrigin,
    const Vector2& targetOrigin, double factor)>& visit,
  int endlessRings) const
{
  const int children = 1 << (2 * this->Levels);
  for (int child = children * triangle; child < children * (triangle + 1); ++child)
  {
    this->VisitFine(child, visit, endlessRings);
  }
}

} // namespace homeomorphism
