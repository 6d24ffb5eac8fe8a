// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "InnerLines.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace homeomorphism
{
namespace
{

Vector2 Unit(const Vector2& a)
{
  return (1.0 / std::hypot(a.x, a.y)) * a;
}

/// Barycentric coordinates of any point of the plane, inside or outside the triangle.
Barycentric ToBarycentricAnywhere(const TriangleShape& shape, const Vector2& point)
{
  Barycentric l = shape.VectorToBarycentric(point - shape.Corner(0));
  l[0] += 1.0;
  return l;
}

} // namespace

double DistanceToExit(const TriangleShape& shape, const Vector2& point, const Vector2& direction)
{
  const Barycentric l = ToBarycentricAnywhere(shape, point);
  const Barycentric change = shape.VectorToBarycentric(direction);
  double distance = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
  {
    if (change[k] < 0.0)
    {
      distance = std::min(distance, -l[k] / change[k]);
    }
  }
  return distance;
}

Vector3 ToSpace(const MeshGeometry& geometry, TriangleIndex triangle, const Vector2& direction)
{
  const std::array<Vector3, 3> axes = geometry.GetAxes(triangle);
  return Sum(Scaled(axes[0], direction.x), direction.y, axes[1]);
}

ContourChart InnerLines::MakeContourChart(TriangleIndex triangle) const
{
  const MeshGeometry& source = this->GetSource();
  const Triangulation& topology = this->Map.GetPair().GetTriangulation();
  return ContourChart(
    source.GetShape(triangle), source.GetViews(topology.GetCorners(triangle)), this->Center);
}

double InnerLines::GetStripWidth(TriangleIndex triangle, int edge) const
{
  const ChartedTriangulation& charts = this->Map.GetCharts(Domain::Source);
  if (charts.GetSystem() == CoordinateSystem::Smooth)
  {
    return charts.GetSmoothChart(triangle).StripWidth(edge);
  }
  const MeshGeometry& source = this->GetSource();
  const Triangulation& topology = this->Map.GetPair().GetTriangulation();
  return SmoothChart(source.GetShape(triangle), source.GetViews(topology.GetCorners(triangle)),
    UnfoldNeighbors(topology, source, triangle))
    .StripWidth(edge);
}

bool InnerLines::Exists(TriangleIndex triangle, FeatureKind kind, int number) const
{
  const Triangulation& topology = this->Map.GetPair().GetTriangulation();
  if (kind == FeatureKind::Spoke)
  {
    return true;
  }
  if (kind == FeatureKind::StripBorder)
  {
    return topology.GetTwin(triangle, number).Triangle >= 0;
  }
  const int edge = kind == FeatureKind::WingSegment ? number / 2 : number;
  const Barycentric foot = ToBarycentricAnywhere(
    this->GetSource().GetShape(triangle), this->MakeContourChart(triangle).Foot(edge + 1));
  return foot[NextCorner(edge)] > 0.0 && foot[PreviousCorner(edge)] > 0.0;
}

InnerLines::PointOnLine InnerLines::GetPoint(
  TriangleIndex triangle, FeatureKind kind, int number, double t) const
{
  const TriangleShape& shape = this->GetSource().GetShape(triangle);
  if (kind == FeatureKind::StripBorder)
  {
    // l_k = tau l_i l_j / (l_i + l_j), with the proportion t = l_j / (l_i + l_j).
    const double tau = this->GetStripWidth(triangle, number);
    const double a = tau * t * (1.0 - t);
    const double third = a / (1.0 + a);
    const double change = tau * (1.0 - 2.0 * t) / (1.0 + a) / (1.0 + a);
    Barycentric l;
    Barycentric tangent;
    l[number] = third;
    l[NextCorner(number)] = (1.0 - t) * (1.0 - third);
    l[PreviousCorner(number)] = t * (1.0 - third);
    tangent[number] = change;
    tangent[NextCorner(number)] = -(1.0 - third) - (1.0 - t) * change;
    tangent[PreviousCorner(number)] = (1.0 - third) - t * change;
    return { shape.FromBarycentric(l), Unit(shape.FromBarycentric(tangent)),
      std::numeric_limits<double>::infinity() };
  }
  const ContourChart construction = this->MakeContourChart(triangle);
  Vector2 start = construction.Center();
  Vector2 end;
  if (kind == FeatureKind::Spoke)
  {
    end = shape.Corner(number);
  }
  else if (kind == FeatureKind::CenterSegment)
  {
    end = construction.Foot(number + 1);
  }
  else
  {
    const int edge = number / 2;
    start = 0.5 * (start + construction.Foot(edge + 1));
    end = shape.Corner(number % 2 == 0 ? NextCorner(edge) : PreviousCorner(edge));
  }
  const double length = std::hypot(end.x - start.x, end.y - start.y);
  return { (1.0 - t) * start + t * end, Unit(end - start), std::min(t, 1.0 - t) * length };
}

Vector3 InnerLines::GetPosition(
  TriangleIndex triangle, FeatureKind kind, int number, double t) const
{
  const MeshGeometry& source = this->GetSource();
  Vector3 position;
  source.FromNormalized(
    source.FromFrame(triangle, { this->GetPoint(triangle, kind, number, t).Position, 0.0 }),
    position.data());
  return position;
}

LineCrossing InnerLines::GetCrossing(
  TriangleIndex triangle, FeatureKind kind, int number, double t, const MapUnderTest& map) const
{
  const MeshGeometry& source = this->GetSource();
  const TriangleShape& shape = source.GetShape(triangle);
  const PointOnLine point = this->GetPoint(triangle, kind, number, t);
  const auto rayLength = [&](const Vector2& direction) {
    return 0.5 * DistanceToExit(shape, point.Position, direction) / source.GetScale();
  };
  const Vector2 left{ -point.Tangent.y, point.Tangent.x };
  const Vector2 right{ point.Tangent.y, -point.Tangent.x };
  LineCrossing crossing;
  crossing.Near = { GetFrameOrigin(this->Map.GetPair(), Domain::Source, triangle), { triangle } };
  crossing.Point =
    FromFrame(this->Map.GetPair(), Domain::Source, triangle, crossing.Near.Origin, point.Position);
  crossing.Tangent = ToSpace(source, triangle, point.Tangent);
  crossing.TangentLength = std::min({ rayLength(point.Tangent), rayLength(-1.0 * point.Tangent),
    0.5 * point.StraightLength / source.GetScale() });
  crossing.Inward = { ToSpace(source, triangle, left), ToSpace(source, triangle, right) };
  crossing.RayLengths = { rayLength(left), rayLength(right) };
  FindImageAxes(map(crossing.Near), crossing);
  return crossing;
}

JacobianJump InnerLines::GetExactJump(TriangleIndex triangle, FeatureKind kind, int number,
  double t, const LineCrossing& crossing) const
{
  if (kind != FeatureKind::Spoke ||
    this->Map.GetCharts(Domain::Source).GetSystemOf(triangle) != CoordinateSystem::Contour)
  {
    JacobianJump none;
    none.Jump = none.Normal = none.Tangential = none.Angle = none.Stretch = 0.0;
    return none;
  }
  // Corners are counterclockwise. To the left of the segment to corner k lies the corner before it,
  // the other end of the edge that ends in corner k.
  const Jacobian left =
    this->Map.GetJacobian(Domain::Source, triangle, { NextCorner(number) + 1, 1.0, t });
  const Jacobian right =
    this->Map.GetJacobian(Domain::Source, triangle, { PreviousCorner(number) + 1, 0.0, t });
  return CompareDerivatives(
    crossing, { left * crossing.Inward[0], right * crossing.Inward[1] }, left * crossing.Tangent);
}

} // namespace homeomorphism
