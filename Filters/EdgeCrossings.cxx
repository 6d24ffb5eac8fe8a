// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "EdgeCrossings.h"

#include <algorithm>

namespace homeomorphism
{

EdgeCrossings::EdgeCrossings(const Homeomorphism& map)
  : Map(map)
{
  const Triangulation& topology = map.GetPair().GetTriangulation();
  for (TriangleIndex t = 0; t < topology.GetNumberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3 && !topology.IsMasked(t); ++k)
    {
      const AcrossEdge across = topology.GetAcross(t, k);
      const bool boundary = across.Triangle < 0;
      if (!boundary && across.Triangle <= t)
      {
        continue;
      }
      const Triangulation::Corners& corners = topology.GetCorners(t);
      MeshEdge edge;
      edge.Triangles = { t, across.Triangle };
      edge.Points = { corners[NextCorner(k)], corners[PreviousCorner(k)] };
      edge.Apexes = { corners[k],
        boundary ? -1 : topology.GetCorners(across.Triangle)[across.Edge] };
      (boundary ? this->BoundaryEdges : this->InteriorEdges).push_back(edge);
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
  std::size_t edgeIndex, double proportion, const MapUnderTest& evaluate) const
{
  const MeshEdge& edge = this->InteriorEdges[edgeIndex];
  const Vector3 start = this->GetPosition(Side::Source, edge.Points[0]);
  const Vector3 vector = Difference(this->GetPosition(Side::Source, edge.Points[1]), start);
  const double length = Length(vector);
  LineCrossing crossing;
  crossing.Point = Sum(start, proportion, vector);
  crossing.Tangent = Unit(vector);
  crossing.TangentReach = 0.5 * std::min(proportion, 1.0 - proportion) * length;
  for (int side = 0; side < 2; ++side)
  {
    const Vector3 apex = this->GetPosition(Side::Source, edge.Apexes[side]);
    crossing.Inward[side] = UnitAcross(start, crossing.Tangent, apex);
    // Where the perpendicular leaves the triangle again: through the edge to the apex from the
    // start, or that from the end.
    const Vector3 toApex = Difference(apex, start);
    const double foot = Dot3(toApex, crossing.Tangent);
    const double height = Dot3(toApex, crossing.Inward[side]);
    const double along = proportion * length;
    double reach = height;
    if (foot > along)
    {
      reach = std::min(reach, height * (along / foot));
    }
    if (foot < along)
    {
      reach = std::min(reach, height * ((length - along) / (length - foot)));
    }
    crossing.Reach[side] = 0.5 * reach;
  }

  if (!this->Map.GetPair().HasTarget())
  {
    FindImageAxes(evaluate, crossing);
    return crossing;
  }
  const Vector3 targetStart = this->GetPosition(Side::Target, edge.Points[0]);
  const Vector3 tangent =
    Unit(Difference(this->GetPosition(Side::Target, edge.Points[1]), targetStart));
  for (int side = 0; side < 2; ++side)
  {
    const Vector3 inward =
      UnitAcross(targetStart, tangent, this->GetPosition(Side::Target, edge.Apexes[side]));
    const Vector3 normal = Cross3(tangent, inward);
    crossing.ImageAxes[side] = { tangent, inward, side == 0 ? normal : Scaled(normal, -1.0) };
  }
  return crossing;
}

JacobianJump EdgeCrossings::GetExactJump(std::size_t edgeIndex, const LineCrossing& crossing) const
{
  const MeshEdge& edge = this->InteriorEdges[edgeIndex];
  const Embedding& source = this->Map.GetPair().GetEmbedding(Side::Source);
  std::array<Vector3, 2> across;
  Vector3 along;
  for (int side = 0; side < 2; ++side)
  {
    Location place;
    place.Triangle = edge.Triangles[side];
    place.Point = source.ToFrame(place.Triangle, source.ToWorking(crossing.Point.data()));
    const Jacobian jacobian = this->Map.GetJacobian(Side::Source, place);
    across[side] = jacobian * crossing.Inward[side];
    along = jacobian * crossing.Tangent;
  }
  return CompareDerivatives(crossing, across, along);
}

} // namespace homeomorphism
