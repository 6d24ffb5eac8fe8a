// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MapUnderTest.h"

#include "vtkAbstractTransform.h"

#include <algorithm>
#include <array>
#include <limits>

namespace homeomorphism
{

std::int32_t GetFrameOrigin(const TriangulationPair& pair, Domain domain, TriangleIndex triangle)
{
  const int apex = pair.GetGeometry(domain).GetApex(triangle);
  return pair.GetTriangulation().GetCorners(triangle)[NextCorner(apex)];
}

Vector2 ToFrame(const TriangulationPair& pair, Domain domain, TriangleIndex triangle,
  std::int32_t origin, const Vector3& point)
{
  const MeshGeometry& geometry = pair.GetGeometry(domain);
  const Vector3 d =
    Difference(point, geometry.GetVector(origin, GetFrameOrigin(pair, domain, triangle)));
  const std::array<Vector3, 3> axes = geometry.GetAxes(triangle);
  return { geometry.GetScale() * Dot3(d, axes[0]), geometry.GetScale() * Dot3(d, axes[1]) };
}

Vector3 FromFrame(const TriangulationPair& pair, Domain domain, TriangleIndex triangle,
  std::int32_t origin, const Vector2& point)
{
  const MeshGeometry& geometry = pair.GetGeometry(domain);
  const std::array<Vector3, 3> axes = geometry.GetAxes(triangle);
  const Vector3 d =
    Sum(Scaled(axes[0], point.x / geometry.GetScale()), point.y / geometry.GetScale(), axes[1]);
  return Sum(geometry.GetVector(origin, GetFrameOrigin(pair, domain, triangle)), 1.0, d);
}

MapUnderTest MakeMapUnderTest(const Homeomorphism& map)
{
  return [&map](const Vicinity& vicinity) {
    const auto evaluate = [&map, vicinity](const Vector3& point, Vector3& image) {
      if (point == Vector3{})
      {
        image = Vector3{};
        return true;
      }
      const TriangulationPair& pair = map.GetPair();
      const MeshGeometry& source = pair.GetGeometry(Domain::Source);
      // The triangle in which the point is deepest.
      TriangleIndex found = -1;
      Vector2 inFrame{};
      double deepest = -std::numeric_limits<double>::infinity();
      for (const TriangleIndex t : vicinity.Triangles)
      {
        const TriangleShape shape = source.GetShape(t);
        const Vector2 candidate = ToFrame(pair, Domain::Source, t, vicinity.Origin, point);
        Barycentric l = shape.VectorToBarycentric(candidate - shape.Corner(0));
        l[0] += 1.0;
        const double depth = std::min({ l[0], l[1], l[2] });
        if (depth > deepest)
        {
          found = t;
          inFrame = candidate;
          deepest = depth;
        }
      }
      if (found < 0)
      {
        return false;
      }
      if (deepest < 0.0)
      {
        // By rounding, a point of an edge is outside the triangle.
        const TriangleShape shape = source.GetShape(found);
        inFrame = shape.FromBarycentric(shape.ToBarycentric(inFrame));
      }
      image = FromFrame(pair, Domain::Target, found, vicinity.Origin,
        map.MapInFrame(Domain::Source, found, inFrame));
      return true;
    };
    LocalMap local{ evaluate };
    if (map.GetCubic())
    {
      // The Cubic system computes in coordinates that are not relative to the origin.
      Vector3 origin;
      const TriangulationPair& pair = map.GetPair();
      pair.GetGeometry(Domain::Source).FromMeshPoint(vicinity.Origin, 0.0, origin.data());
      local.PointMagnitude = Length(origin);
      pair.GetGeometry(Domain::Target).FromMeshPoint(vicinity.Origin, 0.0, origin.data());
      local.ImageMagnitude = Length(origin);
    }
    return local;
  };
}

MapUnderTest MakeMapUnderTest(vtkAbstractTransform* transform, const Homeomorphism& map)
{
  return [transform, &map](const Vicinity& vicinity) {
    Vector3 origin;
    Vector3 imageOfOrigin;
    map.GetPair().GetGeometry(Domain::Source).FromMeshPoint(vicinity.Origin, 0.0, origin.data());
    transform->InternalTransformPoint(origin.data(), imageOfOrigin.data());
    const auto evaluate = [transform, origin, imageOfOrigin](const Vector3& point, Vector3& image) {
      const Vector3 absolute = Sum(origin, 1.0, point);
      transform->InternalTransformPoint(absolute.data(), image.data());
      image = Difference(image, imageOfOrigin);
      return true;
    };
    return LocalMap{ evaluate, Length(origin), Length(imageOfOrigin) };
  };
}

} // namespace homeomorphism
