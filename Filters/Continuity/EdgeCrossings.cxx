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
      const Twin across = topology.GetTwin(t, k);
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

Vector3 EdgeCrossings::GetPosition(Domain domain, std::int32_t point) const
{
  Vector3 position;
  this->Map.GetPair().GetGeometry(domain).FromMeshPoint(point, 0.0, position.data());
  return position;
}

LineCrossing EdgeCrossings::GetCrossing(
  std::size_t edgeIndex, double proportion, const MapUnderTest& map) const
{
  const MeshEdge& edge = this->InteriorEdges[edgeIndex];
  const MeshGeometry& source = this->Map.GetPair().GetGeometry(Domain::Source);
  // The edge's start is the local origin.
  const Vector3 start{};
  const Vector3 vector = source.GetVector(edge.Points[0], edge.Points[1]);
  const double length = Length(vector);
  LineCrossing crossing;
  crossing.Near = { edge.Points[0], { edge.Triangles[0], edge.Triangles[1] } };
  crossing.Point = Scaled(vector, proportion);
  crossing.Tangent = Unit(vector);
  crossing.TangentLength = 0.5 * std::min(proportion, 1.0 - proportion) * length;
  for (int side = 0; side < 2; ++side)
  {
    const Vector3 toApex = source.GetVector(edge.Points[0], edge.Apexes[side]);
    crossing.Inward[side] = UnitAcross(start, crossing.Tangent, toApex);
    // The perpendicular leaves the triangle through the edge from the start to the apex or through
    // the edge from the end to the apex.
    const double foot = Dot3(toApex, crossing.Tangent);
    const double height = Dot3(toApex, crossing.Inward[side]);
    const double along = proportion * length;
    double toExit = height;
    if (foot > along)
    {
      toExit = std::min(toExit, height * (along / foot));
    }
    if (foot < along)
    {
      toExit = std::min(toExit, height * ((length - along) / (length - foot)));
    }
    crossing.RayLengths[side] = 0.5 * toExit;
  }

  if (!this->Map.GetPair().HasTarget())
  {
    FindImageAxes(map(crossing.Near), crossing);
    return crossing;
  }
  const MeshGeometry& target = this->Map.GetPair().GetGeometry(Domain::Target);
  const Vector3 tangent = Unit(target.GetVector(edge.Points[0], edge.Points[1]));
  for (int side = 0; side < 2; ++side)
  {
    const Vector3 inward =
      UnitAcross(start, tangent, target.GetVector(edge.Points[0], edge.Apexes[side]));
    const Vector3 normal = Cross3(tangent, inward);
    crossing.ImageAxes[side] = { tangent, inward, side == 0 ? normal : Scaled(normal, -1.0) };
  }
  return crossing;
}

JacobianJump EdgeCrossings::GetExactJump(std::size_t edgeIndex, const LineCrossing& crossing) const
{
  const MeshEdge& edge = this->InteriorEdges[edgeIndex];
  std::array<Vector3, 2> across;
  Vector3 along;
  for (int side = 0; side < 2; ++side)
  {
    SurfacePoint surfacePoint;
    surfacePoint.Triangle = edge.Triangles[side];
    surfacePoint.Point.InPlane = ToFrame(this->Map.GetPair(), Domain::Source, edge.Triangles[side],
      crossing.Near.Origin, crossing.Point);
    const Jacobian jacobian = this->Map.GetJacobian(Domain::Source, surfacePoint);
    across[side] = jacobian * crossing.Inward[side];
    along = jacobian * crossing.Tangent;
  }
  return CompareDerivatives(crossing, across, along);
}

} // namespace homeomorphism
