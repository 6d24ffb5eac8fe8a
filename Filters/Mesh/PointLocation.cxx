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

/// The point of the closed triangle nearest to @a point: itself if it is inside.
Vector2 NearestInTriangle(const TriangleShape& shape, const Vector2& point)
{
  const Barycentric l = shape.ToBarycentric(point);
  return l[0] > 0.0 && l[1] > 0.0 && l[2] > 0.0 ? point : shape.FromBarycentric(l);
}

/// Whether a point is in a triangle of the plane: 1 inside, 0 on its boundary, -1 outside.
int Containment(const Embedding& geometry, const Triangulation::Corners& corners,
  const Vector2& point)
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

/// The best candidate so far among triangles at some distance: the nearest, then the lowest number.
struct Nearest
{
  Location Found;
  double Distance;

  void Offer(TriangleIndex triangle, const FramePoint& place, double distance)
  {
    const bool better = this->Found.Triangle < 0
      ? distance <= this->Distance
      : distance < this->Distance ||
        (distance == this->Distance && triangle < this->Found.Triangle);
    if (better)
    {
      this->Found.Triangle = triangle;
      this->Found.Point = place;
      this->Distance = distance;
    }
  }
};

} // namespace

PointLocation::PointLocation(const Triangulation& triangulation, const Embedding& embedding)
  : Topology(triangulation)
  , Geometry(embedding)
{
  std::vector<TriangleIndex> triangles;
  triangles.reserve(triangulation.GetNumberOfTriangles());
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    if (!triangulation.IsMasked(t))
    {
      triangles.push_back(t);
    }
  }
  if (embedding.IsPlanar())
  {
    this->PlaneTree.Build(
      std::move(triangles), [this](TriangleIndex t) { return this->PlaneBox(t); });
  }
  else
  {
    this->SpaceTree.Build(std::move(triangles), [this](TriangleIndex t) {
      Box<3> box;
      for (const std::int32_t corner : this->Topology.GetCorners(t))
      {
        box.Add(this->Geometry.GetPoint(corner));
      }
      return box;
    });
  }
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

Location PointLocation::Find(
  const Vector3& working, double tolerance, TriangleIndex hint) const
{
  if (!(std::isfinite(working[0]) && std::isfinite(working[1]) && std::isfinite(working[2])))
  {
    return {};
  }
  if (!this->Geometry.IsColumnar() && this->Geometry.IsPlanar() &&
    std::abs(working[2]) > tolerance)
  {
    return {};
  }
  Location location = this->Geometry.IsPlanar() ? this->FindInPlane(working, tolerance, hint)
                                                : this->FindNearest(working, tolerance);
  if (!this->Geometry.IsColumnar())
  {
    location.Point.Offset = 0.0;
  }
  return location;
}

/// The place of a point that is in a triangle of the plane.
Location PointLocation::Place(TriangleIndex triangle, const Vector3& working) const
{
  Location location{ triangle, this->Geometry.ToFrame(triangle, working) };
  const Triangulation::Corners& corners = this->Topology.GetCorners(triangle);
  for (int k = 0; k < 3; ++k)
  {
    const Vector3 corner = this->Geometry.GetPoint(corners[k]);
    if (working[0] == corner[0] && working[1] == corner[1] &&
      (this->Geometry.IsPlanar() || working[2] == corner[2]))
    {
      location.Corner = k;
    }
  }
  return location;
}

Location PointLocation::FindInPlane(
  const Vector3& working, double tolerance, TriangleIndex hint) const
{
  const Vector2 point{ working[0], working[1] };
  // No triangles overlap, so one that has the point in its interior is the only one.
  TriangleIndex found = -1;
  if (hint >= 0 && Containment(this->Geometry, this->Topology.GetCorners(hint), point) > 0)
  {
    found = hint;
  }
  else
  {
    this->PlaneTree.Search(
      Box<2>::Around({ point.x, point.y }, 0.0), [this, &point, &found](TriangleIndex t) {
        if ((found < 0 || t < found) &&
          Containment(this->Geometry, this->Topology.GetCorners(t), point) >= 0)
        {
          found = t;
        }
        return true;
      });
  }
  if (found >= 0)
  {
    return this->Place(found, working);
  }
  Nearest nearest{ {}, tolerance };
  Box<2> reach = Box<2>::Around({ point.x, point.y }, tolerance);
  this->PlaneTree.Search(reach, [&](TriangleIndex t) {
    FramePoint place = this->Geometry.ToFrame(t, working);
    const Vector2 inTriangle = NearestInTriangle(this->Geometry.GetShape(t), place.InPlane);
    const double distance = Distance(inTriangle, place.InPlane);
    place.InPlane = inTriangle;
    nearest.Offer(t, place, distance);
    reach = Box<2>::Around({ point.x, point.y }, nearest.Distance);
    return true;
  });
  return nearest.Found;
}

Location PointLocation::FindNearest(const Vector3& working, double tolerance) const
{
  Nearest nearest{ {}, tolerance };
  Box<3> reach = Box<3>::Around(working, tolerance);
  this->SpaceTree.Search(reach, [&](TriangleIndex t) {
    FramePoint place = this->Geometry.ToFrame(t, working);
    const Vector2 inTriangle = NearestInTriangle(this->Geometry.GetShape(t), place.InPlane);
    const double distance = std::hypot(Distance(inTriangle, place.InPlane), place.Offset);
    place.InPlane = inTriangle;
    nearest.Offer(t, place, distance);
    reach = Box<3>::Around(working, nearest.Distance);
    return true;
  });
  if (nearest.Found.Triangle >= 0)
  {
    nearest.Found.Corner = this->Place(nearest.Found.Triangle, working).Corner;
  }
  return nearest.Found;
}

} // namespace homeomorphism
