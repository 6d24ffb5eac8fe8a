// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "RayFans.h"

#include "InnerLines.h"

#include <algorithm>
#include <cmath>

namespace homeomorphism
{
namespace
{

/// Computes the components of the rays along two axes of the plane of a triangle.
void FindComponents(RayFan& fan, const std::array<Vector3, 3>& axes)
{
  for (RayFan::Ray& ray : fan.Rays)
  {
    ray.InPlane = { Dot3(ray.Direction, axes[0]), Dot3(ray.Direction, axes[1]) };
  }
}

} // namespace

RayFans::RayFans(const Homeomorphism& map, CenterPoint center, int raysBetween)
  : Map(map)
  , Center(center)
  , RaysBetween(raysBetween)
{
  const Triangulation& topology = map.GetPair().GetTriangulation();
  std::int32_t points = 0;
  const auto visitCorners = [&topology](auto&& visit) {
    for (TriangleIndex t = 0; t < topology.GetNumberOfTriangles(); ++t)
    {
      for (int k = 0; k < 3 && !topology.IsMasked(t); ++k)
      {
        visit(topology.GetCorners(t)[k], t);
      }
    }
  };
  visitCorners([&](std::int32_t point, TriangleIndex) { points = std::max(points, point + 1); });
  this->Offsets.assign(points + 1, 0);
  visitCorners([&](std::int32_t point, TriangleIndex) { ++this->Offsets[point]; });
  std::int32_t end = 0;
  for (std::int32_t& offset : this->Offsets)
  {
    end += offset;
    offset = end;
  }
  this->Triangles.resize(end);
  visitCorners(
    [&](std::int32_t point, TriangleIndex t) { this->Triangles[--this->Offsets[point]] = t; });
}

TriangleIndex RayFans::GetTriangleAt(std::int32_t point) const
{
  return this->Offsets[point] < this->Offsets[point + 1] ? this->Triangles[this->Offsets[point]]
                                                         : -1;
}

template <typename LengthOf>
void RayFans::AddRays(RayFan& fan, TriangleIndex triangle, const Vector2& from, const Vector2& to,
  LengthOf&& lengthOf) const
{
  const MeshGeometry& source = this->Map.GetPair().GetGeometry(Domain::Source);
  const double start = std::atan2(from.y, from.x);
  const double angle = std::atan2(Cross(from, to), Dot(from, to));
  for (int i = 0; i <= this->RaysBetween + 1; ++i)
  {
    const double turned = start + angle * i / (this->RaysBetween + 1);
    const Vector2 direction{ std::cos(turned), std::sin(turned) };
    RayFan::Ray ray;
    ray.Direction = ToSpace(source, triangle, direction);
    ray.Length = 0.5 * lengthOf(direction) / source.GetScale();
    fan.Rays.push_back(ray);
  }
}

Vector2 RayFans::GetCenterInFrame(TriangleIndex triangle) const
{
  const MeshGeometry& source = this->Map.GetPair().GetGeometry(Domain::Source);
  const Triangulation& topology = this->Map.GetPair().GetTriangulation();
  return ContourChart(
    source.GetShape(triangle), source.GetViews(topology.GetCorners(triangle)), this->Center)
    .Center();
}

Vector3 RayFans::GetCenter(TriangleIndex triangle) const
{
  const MeshGeometry& source = this->Map.GetPair().GetGeometry(Domain::Source);
  Vector3 center;
  source.FromNormalized(
    source.FromFrame(triangle, { this->GetCenterInFrame(triangle), 0.0 }), center.data());
  return center;
}

RayFan RayFans::GetAroundCenter(TriangleIndex triangle) const
{
  const MeshGeometry& source = this->Map.GetPair().GetGeometry(Domain::Source);
  const TriangleShape& shape = source.GetShape(triangle);
  const Vector2 center = this->GetCenterInFrame(triangle);
  RayFan fan;
  fan.Near = { GetFrameOrigin(this->Map.GetPair(), Domain::Source, triangle), { triangle } };
  fan.Point = FromFrame(this->Map.GetPair(), Domain::Source, triangle, fan.Near.Origin, center);
  for (int k = 0; k < 3; ++k)
  {
    this->AddRays(fan, triangle, shape.Corner(NextCorner(k)) - center,
      shape.Corner(PreviousCorner(k)) - center,
      [&](const Vector2& direction) { return DistanceToExit(shape, center, direction); });
  }
  FindComponents(fan, source.GetAxes(triangle));
  return fan;
}

RayFan RayFans::GetAroundVertex(std::int32_t point) const
{
  const MeshGeometry& source = this->Map.GetPair().GetGeometry(Domain::Source);
  const Triangulation& topology = this->Map.GetPair().GetTriangulation();
  RayFan fan;
  fan.Near.Origin = point;
  fan.Point = Vector3{};
  for (std::int32_t i = this->Offsets[point]; i < this->Offsets[point + 1]; ++i)
  {
    const TriangleIndex triangle = this->Triangles[i];
    fan.Near.Triangles.push_back(triangle);
    const TriangleShape& shape = source.GetShape(triangle);
    const Triangulation::Corners& corners = topology.GetCorners(triangle);
    const int corner =
      static_cast<int>(std::find(corners.begin(), corners.end(), point) - corners.begin());
    this->AddRays(fan, triangle, shape.Corner(NextCorner(corner)) - shape.Corner(corner),
      shape.Corner(PreviousCorner(corner)) - shape.Corner(corner), [&](const Vector2& direction) {
        // The length up to the opposite edge. By rounding, a ray along an edge could otherwise
        // leave through that edge.
        return -1.0 / shape.VectorToBarycentric(direction)[corner];
      });
  }
  FindComponents(fan, source.GetAxes(this->GetTriangleAt(point)));
  return fan;
}

JacobianJump RayFans::GetExactJumpAtCenter(TriangleIndex triangle, const RayFan& fan) const
{
  const ChartedTriangulation& charts = this->Map.GetCharts(Domain::Source);
  if (charts.GetSystemOf(triangle) != CoordinateSystem::Contour)
  {
    JacobianJump none;
    none.Jump = 0.0;
    return none;
  }
  std::vector<Vector3> derivatives;
  for (const RayFan::Ray& ray : fan.Rays)
  {
    // The contour that starts along the ray. Contours are straight near the center.
    const Vector3 beside = Sum(fan.Point, 0.25 * ray.Length, ray.Direction);
    TriangularCoordinates contour = charts.ToCoordinates(
      triangle, ToFrame(this->Map.GetPair(), Domain::Source, triangle, fan.Near.Origin, beside));
    contour.ContourParameter = 0.0;
    derivatives.push_back(this->Map.GetJacobian(Domain::Source, triangle, contour) * ray.Direction);
  }
  return CompareDerivatives(fan, derivatives);
}

} // namespace homeomorphism
