// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PointLocation.h"

#include "Kernel/ExactSign.h"

#include <cmath>

namespace homeomorphism
{
namespace
{

double Distance(const Vector2& a, const Vector2& b)
{
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// The point of the closed triangle nearest to @a point, which is the point itself if it is inside.
Vector2 NearestInTriangle(const TriangleShape& shape, const Vector2& point)
{
  const Barycentric l = shape.ToBarycentric(point);
  return l[0] > 0.0 && l[1] > 0.0 && l[2] > 0.0 ? point : shape.FromBarycentric(l);
}

/// The position of a point relative to a triangle of the plane: 1 inside, 0 on its boundary, -1
/// outside.
int Containment(
  const MeshGeometry& geometry, const Triangulation::Corners& corners, const Vector2& point)
{
  const Vector2& a = geometry.GetPlanePoint(corners[0]);
  const Vector2& b = geometry.GetPlanePoint(corners[1]);
  const Vector2& c = geometry.GetPlanePoint(corners[2]);
  const int ab = Orientation(a, b, point);
  const int bc = Orientation(b, c, point);
  const int ca = Orientation(c, a, point);
  const bool left = ab > 0 || bc > 0 || ca > 0;
  const bool right = ab < 0 || bc < 0 || ca < 0;
  if (left && right)
  {
    return -1;
  }
  return ab != 0 && bc != 0 && ca != 0 ? 1 : 0;
}

/// The best candidate so far: the nearest triangle, and the lowest number among equally near ones.
struct Nearest
{
  SurfacePoint Found;
  double Distance;

  void Offer(TriangleIndex triangle, const FramePoint& framePoint, double distance)
  {
    const bool better = this->Found.Triangle < 0 ? distance <= this->Distance
                                                 : distance < this->Distance ||
        (distance == this->Distance && triangle < this->Found.Triangle);
    if (better)
    {
      this->Found.Triangle = triangle;
      this->Found.Point = framePoint;
      this->Distance = distance;
    }
  }
};

} // namespace

PointLocation::PointLocation(const Triangulation& triangulation, const MeshGeometry& geometry)
  : Topology(triangulation)
  , Geometry(geometry)
{
  if (geometry.IsPlanar())
  {
    this->PlantSeeds();
  }
  else
  {
    this->SpaceTree.Build(this->ListTriangles(), [this](TriangleIndex t) {
      Box<3> box;
      for (const std::int32_t corner : this->Topology.GetCorners(t))
      {
        box.Add(this->Geometry.GetPoint(corner));
      }
      return box;
    });
  }
}

std::vector<TriangleIndex> PointLocation::ListTriangles() const
{
  std::vector<TriangleIndex> triangles;
  triangles.reserve(this->Topology.GetNumberOfTriangles());
  for (TriangleIndex t = 0; t < this->Topology.GetNumberOfTriangles(); ++t)
  {
    if (!this->Topology.IsMasked(t))
    {
      triangles.push_back(t);
    }
  }
  return triangles;
}

const BoxTree<2>& PointLocation::GetPlaneTree() const
{
  std::call_once(this->HasPlaneTree, [this]() {
    this->PlaneTree.Build(
      this->ListTriangles(), [this](TriangleIndex t) { return this->PlaneBox(t); });
  });
  return this->PlaneTree;
}

Box<2> PointLocation::PlaneBox(TriangleIndex triangle) const
{
  Box<2> box;
  for (const std::int32_t corner : this->Topology.GetCorners(triangle))
  {
    const Vector2& p = this->Geometry.GetPlanePoint(corner);
    box.Add({ p.x, p.y });
  }
  return box;
}

void PointLocation::PlantSeeds()
{
  const Box<2>& bounds = this->Geometry.GetPlaneBounds();
  const double width = bounds.Greatest[0] - bounds.Least[0];
  const double height = bounds.Greatest[1] - bounds.Least[1];
  const double cells = 0.5 * static_cast<double>(this->Topology.GetNumberOfTriangles());
  const double columns = std::floor(std::sqrt(cells * width / height));
  if (!(columns >= 1.0 && columns <= cells))
  {
    return;
  }
  this->SeedColumns = columns;
  this->SeedRows = std::max(1.0, std::floor(cells / columns));
  this->SeedOrigin = { bounds.Least[0], bounds.Least[1] };
  this->SeedScale = { this->SeedColumns / width, this->SeedRows / height };
  this->Seeds = LargeArray<TriangleIndex>(
    static_cast<std::size_t>(this->SeedColumns) * static_cast<std::size_t>(this->SeedRows), -1);
  for (TriangleIndex t = 0; t < this->Topology.GetNumberOfTriangles(); ++t)
  {
    if (this->Topology.IsMasked(t))
    {
      continue;
    }
    Vector2 middle;
    for (const std::int32_t corner : this->Topology.GetCorners(t))
    {
      middle = middle + (1.0 / 3.0) * this->Geometry.GetPlanePoint(corner);
    }
    const double x = (middle.x - this->SeedOrigin.x) * this->SeedScale.x;
    const double y = (middle.y - this->SeedOrigin.y) * this->SeedScale.y;
    if (x >= 0.0 && y >= 0.0 && x < this->SeedColumns && y < this->SeedRows)
    {
      this->Seeds[static_cast<std::size_t>(y) * static_cast<std::size_t>(this->SeedColumns) +
        static_cast<std::size_t>(x)] = t;
    }
  }
}

void PointLocation::SetOverlapping(const std::vector<TriangleIndex>& triangles)
{
  this->Overlapping.clear();
  for (const TriangleIndex t : triangles)
  {
    this->Overlapping.resize(static_cast<std::size_t>(this->Topology.GetNumberOfTriangles()), 0);
    this->Overlapping[t] = 1;
  }
}

SurfacePoint PointLocation::Find(
  const Vector3& normalized, double tolerance, TriangleIndex hint) const
{
  if (!(std::isfinite(normalized[0]) && std::isfinite(normalized[1]) &&
        std::isfinite(normalized[2])))
  {
    return {};
  }
  if (!this->Geometry.IsColumnar() && this->Geometry.IsPlanar() &&
    std::abs(normalized[2]) > tolerance)
  {
    return {};
  }
  SurfacePoint location = this->Geometry.IsPlanar()
    ? this->FindInPlane(normalized, tolerance, hint)
    : this->FindNearest(normalized, tolerance, hint);
  if (!this->Geometry.IsColumnar())
  {
    location.Point.Offset = 0.0;
  }
  return location;
}

int PointLocation::FindCorner(TriangleIndex triangle, const Vector3& normalized) const
{
  const Triangulation::Corners& corners = this->Topology.GetCorners(triangle);
  int found = -1;
  for (int k = 0; k < 3; ++k)
  {
    const Vector3 corner = this->Geometry.GetPoint(corners[k]);
    if (normalized[0] == corner[0] && normalized[1] == corner[1] &&
      (this->Geometry.IsPlanar() || normalized[2] == corner[2]))
    {
      found = k;
    }
  }
  return found;
}

SurfacePoint PointLocation::ToSurfacePoint(TriangleIndex triangle, const Vector3& normalized) const
{
  return { triangle, this->Geometry.ToFrame(triangle, normalized),
    this->FindCorner(triangle, normalized) };
}

/// The triangle that a walk comes to, or -1 if it must be searched for; where the point is for
/// certain in the triangle's interior, @a location is set.
TriangleIndex PointLocation::Walk(
  const Vector2& point, TriangleIndex start, SurfacePoint& location) const
{
  // Walks in triangulations that are not Delaunay may cycle.
  constexpr int longest = 64;
  TriangleIndex t = start;
  for (int step = 0; step < longest; ++step)
  {
    const PlaneFrame& frame = this->Geometry.GetPlaneFrame(t);
    const PlaneRelation relation(frame, point);
    if (relation.IsInside())
    {
      if (this->IsOverlapping(t))
      {
        return -1;
      }
      location.Triangle = t;
      location.Point.InPlane = relation.InPlane;
      return t;
    }
    // Leave by the edge that the point is farthest beyond.
    int edge = -1;
    if (relation.IsOutside())
    {
      edge = frame.Apex;
      double least = relation.Apex;
      if (relation.First < least)
      {
        least = relation.First;
        edge = NextCorner(frame.Apex);
      }
      if (relation.Second < least)
      {
        edge = PreviousCorner(frame.Apex);
      }
    }
    else
    {
      const Triangulation::Corners& corners = this->Topology.GetCorners(t);
      int onEdge = -1;
      int edges = 0;
      for (int k = 0; k < 3; ++k)
      {
        const int side = frame.Orientation *
          Orientation(this->Geometry.GetPlanePoint(corners[NextCorner(k)]),
            this->Geometry.GetPlanePoint(corners[PreviousCorner(k)]), point);
        if (side < 0)
        {
          edge = k;
        }
        else if (side == 0)
        {
          onEdge = k;
          ++edges;
        }
      }
      if (edge < 0)
      {
        if (edges == 0)
        {
          return this->IsOverlapping(t) ? -1 : t;
        }
        // A point in the interior of an interior edge belongs to two triangles only. A point at a
        // vertex or on the boundary may belong to more, including triangles that do not share a
        // point of the mesh with this one.
        const TriangleIndex other = edges == 1 ? this->Topology.GetTwin(t, onEdge).Triangle : -1;
        return other >= 0 && !this->IsOverlapping(t) && !this->IsOverlapping(other)
          ? std::min(t, other)
          : -1;
      }
    }
    t = this->Topology.GetTwin(t, edge).Triangle;
    if (t < 0)
    {
      return -1;
    }
  }
  return -1;
}

TriangleIndex PointLocation::SearchPlane(const Vector2& point) const
{
  TriangleIndex found = -1;
  this->GetPlaneTree().Search(
    Box<2>::Around({ point.x, point.y }, 0.0), [this, &point, &found](TriangleIndex t) {
      if ((found < 0 || t < found) &&
        Containment(this->Geometry, this->Topology.GetCorners(t), point) >= 0)
      {
        found = t;
      }
      return true;
    });
  return found;
}

SurfacePoint PointLocation::FindInPlane(
  const Vector3& normalized, double tolerance, TriangleIndex hint) const
{
  const Vector2 point{ normalized[0], normalized[1] };
  SurfacePoint location;
  location.Point.Offset = normalized[2];
  // From a triangle many times its size away, the way from the seed is shorter.
  constexpr double far = -4.0;
  // Coordinates of the domain are close to 1; products of huge coordinates would overflow.
  constexpr double huge = 1e100;
  const bool isHuge = std::abs(point.x) > huge || std::abs(point.y) > huge;
  TriangleIndex start = isHuge || (hint >= 0 && this->Topology.IsMasked(hint)) ? -1 : hint;
  if (start >= 0)
  {
    const PlaneFrame& frame = this->Geometry.GetPlaneFrame(start);
    start = PlaneRelation(frame, point).Least < far * frame.Height ? -1 : start;
  }
  TriangleIndex found = -1;
  for (const TriangleIndex candidate : { start, this->GetSeed(point) })
  {
    if (found < 0 && candidate >= 0)
    {
      found = this->Walk(point, candidate, location);
    }
  }
  if (location.Triangle >= 0)
  {
    return location;
  }
  if (found < 0)
  {
    found = this->SearchPlane(point);
  }
  if (found >= 0)
  {
    return this->ToSurfacePoint(found, normalized);
  }
  Nearest nearest{ {}, tolerance };
  Box<2> box = Box<2>::Around({ point.x, point.y }, tolerance);
  this->GetPlaneTree().Search(box, [&](TriangleIndex t) {
    FramePoint framePoint = this->Geometry.ToFrame(t, normalized);
    const Vector2 inTriangle = NearestInTriangle(this->Geometry.GetShape(t), framePoint.InPlane);
    const double distance = Distance(inTriangle, framePoint.InPlane);
    framePoint.InPlane = inTriangle;
    nearest.Offer(t, framePoint, distance);
    box = Box<2>::Around({ point.x, point.y }, nearest.Distance);
    return true;
  });
  return nearest.Found;
}

SurfacePoint PointLocation::FindNearest(
  const Vector3& normalized, double tolerance, TriangleIndex hint) const
{
  Nearest nearest{ {}, tolerance };
  const auto offer = [&](TriangleIndex t) {
    FramePoint framePoint = this->Geometry.ToFrame(t, normalized);
    const Vector2 inTriangle = NearestInTriangle(this->Geometry.GetShape(t), framePoint.InPlane);
    const double distance = std::hypot(Distance(inTriangle, framePoint.InPlane), framePoint.Offset);
    framePoint.InPlane = inTriangle;
    nearest.Offer(t, framePoint, distance);
  };
  if (hint >= 0 && !this->Topology.IsMasked(hint))
  {
    // The nearest triangle is at most this far away.
    offer(hint);
  }
  Box<3> box = Box<3>::Around(normalized, nearest.Distance);
  this->SpaceTree.Search(box, [&](TriangleIndex t) {
    offer(t);
    box = Box<3>::Around(normalized, nearest.Distance);
    return true;
  });
  if (nearest.Found.Triangle >= 0)
  {
    nearest.Found.Corner = this->FindCorner(nearest.Found.Triangle, normalized);
  }
  return nearest.Found;
}

} // namespace homeomorphism
