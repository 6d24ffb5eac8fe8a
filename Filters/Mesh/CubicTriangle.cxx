// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Mesh/CubicTriangle.h"

namespace homeomorphism
{

//------------------------------------------------------------------------------
void CubicTriangle::Make(const std::array<Vector2, 3>& points, const CubicNet& net, int origin)
{
  this->Elements.emplace_back();
  Element& made = this->Elements.back();
  const PlanarPair& pair = this->Template.GetPair();
  const std::array<std::int32_t, 3>& corners = pair.Triangles[this->Triangle];
  made.Points = points;
  made.Frame = BarycentricFrame(points);
  made.Net = net;
  made.SourceOrigin = pair.Source[corners[origin]] - pair.Source[corners[0]];
  made.TargetOrigin = pair.Target[corners[origin]] - pair.Target[corners[0]];
}

//------------------------------------------------------------------------------
void CubicTriangle::Set(int triangle)
{
  if (this->Triangle == triangle)
  {
    return;
  }
  this->Triangle = triangle;
  this->Elements.clear();
  const PlanarPair& pair = this->Template.GetPair();
  this->Affine = this->Template.GetAffine(triangle);
  this->Whole = this->Bending && this->Bending->Cuts[triangle] < 0;
  if (this->Whole)
  {
    this->Make(pair.GetSourceCorners(triangle), this->Bending->Nets[triangle], 0);
    return;
  }
  this->Cut = this->Template.GetCut(triangle);
  this->Made.fill(-1);
  for (int c = 0; c < 3; ++c)
  {
    const Vector2 first = this->Cut.GetNode(9 + 2 * PreviousCorner(c), c);
    const Vector2 last = this->Cut.GetNode(10 + 2 * NextCorner(c), c);
    const Vector2 along = last - first;
    this->CornerNormals[c] = { along.y, -along.x };
    this->CornerOffsets[c] = Dot(this->CornerNormals[c], first + this->Cut.Corners[c]);
    this->InRings[c] =
      this->Template.GetKind(pair.Triangles[triangle][c]) != VertexKind::Differentiable;
  }
}

//------------------------------------------------------------------------------
const CubicTriangle::Element* CubicTriangle::Find(const Vector2& point, int& ringCorner)
{
  ringCorner = -1;
  if (this->Whole)
  {
    return &this->Elements[0];
  }
  const TriangleCut& cut = this->Cut;
  if (!this->Bending)
  {
    // Most points are in the middle, where the template is affine.
    bool inMiddle = true;
    for (int k = 0; k < 3; ++k)
    {
      const Vector2 d = point - cut.Corners[NextCorner(k)];
      inMiddle = inMiddle & (Cross(cut.Along[k], d) > cut.Heights[k]) &
        (Dot(this->CornerNormals[k], point) > this->CornerOffsets[k]);
    }
    if (inMiddle)
    {
      return nullptr;
    }
  }
  const int number = cut.Find(point);
  if (number >= TriangleCut::FirstMiddle && !this->Bending)
  {
    return nullptr;
  }
  const int origin = TriangleCut::GetOrigin(number);
  if (number < TriangleCut::FirstStrip && this->InRings[origin])
  {
    ringCorner = origin;
    return nullptr;
  }
  if (this->Made[number] < 0)
  {
    this->Made[number] = static_cast<std::int8_t>(this->Elements.size());
    const PlanarPair& pair = this->Template.GetPair();
    const CubicElement element = this->Bending
      ? this->Bending->GetElement(pair, cut, this->Affine, this->Triangle, number)
      : this->Template.GetElement(cut, this->Affine, this->Triangle, number);
    this->Make(element.Points, CubicNet(element), origin);
  }
  return &this->Elements[this->Made[number]];
}

//------------------------------------------------------------------------------
Vector2 CubicTriangle::Map(const Vector2& point)
{
  int ringCorner;
  const Element* element = this->Find(point, ringCorner);
  if (element)
  {
    return element->TargetOrigin + element->Net(element->Frame(point - element->SourceOrigin));
  }
  Matrix2 derivative;
  return this->MapOutside(point, ringCorner, derivative);
}

//------------------------------------------------------------------------------
Vector2 CubicTriangle::GetResidual(const Vector2& point, const Vector2& image, Vector2& step)
{
  int ringCorner;
  const Element* element = this->Find(point, ringCorner);
  if (element)
  {
    return element->Net.GetResidual(element->Frame(point - element->SourceOrigin), element->Points,
      image - element->TargetOrigin, step);
  }
  Matrix2 derivative;
  const Vector2 residual = image - this->MapOutside(point, ringCorner, derivative);
  const double determinant = derivative.Determinant();
  step = { Cross(residual, derivative.ImageOfY) / determinant,
    Cross(derivative.ImageOfX, residual) / determinant };
  return residual;
}

//------------------------------------------------------------------------------
Vector2 CubicTriangle::MapOutside(const Vector2& point, int ringCorner, Matrix2& derivative) const
{
  if (ringCorner < 0)
  {
    derivative = this->Affine;
    return this->Affine * point;
  }
  const PlanarPair& pair = this->Template.GetPair();
  const std::array<std::int32_t, 3>& corners = pair.Triangles[this->Triangle];
  Vector2 image;
  this->Template.EvaluateRings(
    this->Triangle, ringCorner, point - this->Cut.Corners[ringCorner], image, derivative);
  return image + (pair.Target[corners[ringCorner]] - pair.Target[corners[0]]);
}

} // namespace homeomorphism
