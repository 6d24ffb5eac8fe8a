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
  std::size_t edgeIndex, double proportion, const MapUnderTest& evaluate) const
{
  const MeshEdge& edge = this->InteriorEdges[edgeIndex];
  const Vector3 start = this->GetPosition(Domain::Source, edge.Points[0]);
  const Vector3 vector = Difference(this->GetPosition(Domain::Source, edge.Points[1]), start);
  const double length = Length(vector);
  LineCrossing crossing;
  crossing.Point = Sum(start, proportion, vector);
  crossing.Tangent = Unit(vector);
  crossing.TangentReach = 0.5 * std::min(proportion, 1.0 - proportion) * length;
  for (int domain = 0; domain < 2; ++domain)
  {
    const Vector3 apex = this->GetPosition(Domain::Source, edge.Apexes[domain]);
    crossing.Inward[domain] = UnitAcross(start, crossing.Tangent, apex);
    // Where the perpendicular leaves the triangle again: through the edge to the apex from the
    // start, or that from the end.
    const Vector3 toApex = Difference(apex, start);
    const double foot = Dot3(toApex, crossing.Tangent);
    const double height = Dot3(toApex, crossing.Inward[domain]);
    const double along = proportion * length;
    double tolerance = height;
    if (foot > along)
    {
      tolerance = std::min(tolerance, height * (along / foot));
    }
    if (foot < along)
    {
      tolerance = std::min(tolerance, height * ((length - along) / (length - foot)));
    }
    crossing.Reach[domain] = 0.5 * tolerance;
  }

  if (!this->Map.GetPair().HasTarget())
  {
    FindImageAxes(evaluate, crossing);
    return crossing;
  }
  const Vector3 targetStart = this->GetPosition(Domain::Target, edge.Points[0]);
  const Vector3 tangent =
    Unit(Difference(this->GetPosition(Domain::Target, edge.Points[1]), targetStart));
  for (int domain = 0; domain < 2; ++domain)
  {
    const Vector3 inward =
      UnitAcross(targetStart, tangent, this->GetPosition(Domain::Target, edge.Apexes[domain]));
    const Vector3 normal = Cross3(tangent, inward);
    crossing.ImageAxes[domain] = { tangent, inward, domain == 0 ? normal : Scaled(normal, -1.0) };
  }
  return crossing;
}

JacobianJump EdgeCrossings::GetExactJump(std::size_t edgeIndex, const LineCrossing& crossing) const
{
  const MeshEdge& edge = this->InteriorEdges[edgeIndex];
  const MeshGeometry& source = this->Map.GetPair().GetGeometry(Domain::Source);
  std::array<Vector3, 2> across;
  Vector3 along;
  for (int domain = 0; domain < 2; ++domain)
  {
    SurfacePoint surfacePoint;
    surfacePoint.Triangle = edge.Triangles[domain];
    surfacePoint.Point =
      source.ToFrame(surfacePoint.Triangle, source.ToNormalized(crossing.Point.data()));
    const Jacobian jacobian = this->Map.GetJacobian(Domain::Source, surfacePoint);
    across[domain] = jacobian * crossing.Inward[domain];
    along = jacobian * crossing.Tangent;
  }
  return CompareDerivatives(crossing, across, along);
}

} // namespace homeomorphism
