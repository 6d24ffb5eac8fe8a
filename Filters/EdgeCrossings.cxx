// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "EdgeCrossings.h"

#include <algorithm>

namespace homeomorphism
{
namespace
{

Vector3 Sum(const Vector3& a, double factor, const Vector3& b)
{
  return { a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2] };
}

Vector3 Unit(const Vector3& a)
{
  const double length = Length(a);
  return { a[0] / length, a[1] / length, a[2] / length };
}

Vector3 Opposite(const Vector3& a)
{
  return { -a[0], -a[1], -a[2] };
}

/// The unit vector from an edge, with a unit tangent, towards a point beside it.
Vector3 UnitInward(const Vector3& start, const Vector3& tangent, const Vector3& beside)
{
  const Vector3 d = Unit(Difference(beside, start));
  return Unit(Sum(d, -Dot3(d, tangent), tangent));
}

} // namespace

EdgeCrossings::EdgeCrossings(const Homeomorphism& map)
  : Map(map)
{
  const Triangulation& topology = map.GetPair().GetTriangulation();
  for (TriangleIndex t = 0; t < topology.GetNumberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3 && !topology.IsMasked(t); ++k)
    {
      const AcrossEdge across = topology.GetAcross(t, k);
      if (across.Triangle < 0)
      {
        ++this->NumberOfBoundaryEdges;
      }
      if (across.Triangle <= t)
      {
        continue;
      }
      const Triangulation::Corners& corners = topology.GetCorners(t);
      InteriorEdge edge;
      edge.Triangles = { t, across.Triangle };
      edge.Cells = { topology.GetCellId(t), topology.GetCellId(across.Triangle) };
      edge.Points = { corners[NextCorner(k)], corners[PreviousCorner(k)] };
      edge.Apexes = { corners[k], topology.GetCorners(across.Triangle)[across.Edge] };
      edge.Start = this->GetPosition(Side::Source, edge.Points[0]);
      edge.End = this->GetPosition(Side::Source, edge.Points[1]);
      this->Edges.push_back(edge);
    }
  }
}

Vector3 EdgeCrossings::GetPosition(Side side, std::int32_t point) const
{
  Vector3 position;
  this->Map.GetPair().GetEmbedding(side).FromMeshPoint(point, 0.0, position.data());
  return position;
}

LineCrossing EdgeCrossings::GetCrossing(
  vtkIdType edgeIndex, double proportion, const MapUnderTest& evaluate) const
{
  const InteriorEdge& edge = this->Edges[edgeIndex];
  const Vector3 vector = Difference(edge.End, edge.Start);
  const double length = Length(vector);
  LineCrossing crossing;
  crossing.Point = Sum(edge.Start, proportion, vector);
  crossing.Tangent = Unit(vector);
  crossing.TangentReach = 0.5 * std::min(proportion, 1.0 - proportion) * length;
  for (int side = 0; side < 2; ++side)
  {
    const Vector3 apex = this->GetPosition(Side::Source, edge.Apexes[side]);
    crossing.Inward[side] = UnitInward(edge.Start, crossing.Tangent, apex);
    // Where the perpendicular leaves the triangle again: through the edge to the apex from the start,
    // or that from the end.
    const Vector3 toApex = Difference(apex, edge.Start);
    const double foot = Dot3(toApex, crossing.Tangent);
    const double height = Dot3(toApex, crossing.Inward[side]);
    const double along = proportion * length;
    double reach = height;
    if (foot > along)
    {
      reach = std::min(reach, height * along / foot);
    }
    if (foot < along)
    {
      reach = std::min(reach, height * (length - along) / (length - foot));
    }
    crossing.Reach[side] = 0.5 * reach;
  }

  std::array<std::array<Vector3, 3>, 2>& axes = crossing.ImageAxes;
  if (this->Map.GetPair().HasTarget())
  {
    const Vector3 start = this->GetPosition(Side::Target, edge.Points[0]);
    const Vector3 tangent =
      Unit(Sum(this->GetPosition(Side::Target, edge.Points[1]), -1.0, start));
    for (int side = 0; side < 2; ++side)
    {
      const Vector3 inward =
        UnitInward(start, tangent, this->GetPosition(Side::Target, edge.Apexes[side]));
      const Vector3 normal = Cross3(tangent, inward);
      axes[side] = { tangent, inward, side == 0 ? normal : Opposite(normal) };
    }
    return crossing;
  }
  // Any orthonormal axes do that both sides share: near the line's image and across it.
  constexpr double small = 1.0 / 1024.0;
  const auto imageOf = [&](const Vector3& direction, double step) {
    Vector3 image{ JacobianJump::None, JacobianJump::None, JacobianJump::None };
    evaluate(Sum(crossing.Point, step, direction), image);
    return image;
  };
  const Vector3 here = imageOf(crossing.Tangent, 0.0);
  const Vector3 tangent = Unit(
    Sum(imageOf(crossing.Tangent, small * crossing.TangentReach), -1.0, here));
  const Vector3 inward =
    UnitInward(here, tangent, imageOf(crossing.Inward[0], small * crossing.Reach[0]));
  const Vector3 normal = Cross3(tangent, inward);
  axes[0] = { tangent, inward, normal };
  axes[1] = { tangent, Opposite(inward), normal };
  return crossing;
}

JacobianJump EdgeCrossings::GetExactJump(
  vtkIdType edgeIndex, const LineCrossing& crossing) const
{
  const InteriorEdge& edge = this->Edges[edgeIndex];
  const Embedding& source = this->Map.GetPair().GetEmbedding(Side::Source);
  std::array<Vector3, 2> across;
  Vector3 along;
  for (int side = 0; side < 2; ++side)
  {
    Location place;
    place.Triangle = edge.Triangles[side];
    place.Point = source.ToFrame(place.Triangle, source.ToWorking(crossing.Point.data()));
    const std::array<double, 9> j = this->Map.GetJacobian(Side::Source, place).Matrix;
    const auto image = [&j](const Vector3& v) -> Vector3 {
      return { j[0] * v[0] + j[1] * v[1] + j[2] * v[2], j[3] * v[0] + j[4] * v[1] + j[5] * v[2],
        j[6] * v[0] + j[7] * v[1] + j[8] * v[2] };
    };
    across[side] = image(crossing.Inward[side]);
    along = image(crossing.Tangent);
  }
  return CompareDerivatives(crossing, across, along);
}

} // namespace homeomorphism
