// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/Triangulations.h"

#include "Mesh/MeshGeometry.h"

#include <gtest/gtest.h>

#include <functional>

using namespace homeomorphism;
using namespace fixtures;

namespace
{

/// Triangles with three points of their own each.
vtkSmartPointer<vtkPolyData> MakeSoup(int count, const std::function<Point(Random&)>& pointOf)
{
  Random random(51);
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  for (vtkIdType t = 0; t < count; ++t)
  {
    points.insert(points.end(), { pointOf(random), pointOf(random), pointOf(random) });
    triangles.push_back({ 3 * t, 3 * t + 1, 3 * t + 2 });
  }
  return MakeMesh(points, triangles);
}

bool IsPlanar(vtkPolyData* mesh)
{
  return MeshGeometry(mesh->GetPoints(), TriangulationOf(mesh)).IsPlanar();
}

void ExpectFramesToReturn(vtkPolyData* mesh, double size)
{
  const Triangulation topology = TriangulationOf(mesh);
  MeshGeometry geometry(mesh->GetPoints(), topology);
  geometry.ComputeFrames(topology);
  for (TriangleIndex t = 0; t < topology.GetNumberOfTriangles(); ++t)
  {
    for (const std::int32_t corner : topology.GetCorners(t))
    {
      const Point point = PointOf(mesh, corner);
      EXPECT_TRUE(geometry.IsMeshPoint(corner, point.data()));
      const Vector3 normalized = geometry.ToNormalized(point.data());
      Point back;
      geometry.FromNormalized(normalized, back.data());
      EXPECT_LE(Distance(point, back), 8.0 * Ulp * size);
      const FramePoint inFrame = geometry.ToFrame(t, normalized);
      geometry.FromNormalized(geometry.FromFrame(t, inFrame), back.data());
      EXPECT_LE(Distance(point, back), 16.0 * Ulp * size);
      EXPECT_LE(std::abs(inFrame.Offset), 16.0 * Ulp);
    }
    // The axes of the frame are orthonormal.
    const std::array<Vector3, 3> axes = geometry.GetAxes(t);
    for (int i = 0; i < 3; ++i)
    {
      EXPECT_NEAR(Dot3(axes[i], axes[i]), 1.0, 8.0 * Ulp);
      EXPECT_NEAR(Dot3(axes[i], axes[(i + 1) % 3]), 0.0, 8.0 * Ulp);
    }
  }
}

TEST(MeshGeometry, FramesReturn)
{
  // In a plane, in a tilted plane and on a surface.
  for (const int kind : { 0, 1, 2 })
  {
    for (const double scale : { 1e-200, 1.0, 1e150 })
    {
      const auto soup = MakeSoup(200, [kind, scale](Random& random) -> Point {
        const double x = scale * random.Uniform();
        const double y = scale * random.Uniform();
        const double slope = 0.25 * x - 0.5 * y + 3.0 * scale;
        return { x, y, kind == 0 ? 0.0 : kind == 1 ? slope : scale * random.Uniform() };
      });
      ExpectFramesToReturn(soup, 4.0 * scale);
      EXPECT_EQ(IsPlanar(soup), kind < 2);
    }
  }
}

// Normalized coordinates are those of the input times a power of two.
TEST(MeshGeometry, NormalizesWithoutRounding)
{
  const auto soup = MakeSoup(20, [](Random& random) -> Point {
    return { 3e7 * random.Uniform(), 5e6 + random.Uniform(), 0.0 };
  });
  const MeshGeometry geometry(soup->GetPoints(), TriangulationOf(soup));
  int exponent;
  EXPECT_EQ(std::frexp(geometry.GetScale(), &exponent), 0.5);
  EXPECT_EQ(geometry.GetScale() * geometry.GetInverseScale(), 1.0);
  const Point point = PointOf(soup, 7);
  const Vector3 normalized = geometry.ToNormalized(point.data());
  EXPECT_EQ(normalized[0] * geometry.GetInverseScale(), point[0]);
  EXPECT_EQ(normalized[1] * geometry.GetInverseScale(), point[1]);
}

TEST(MeshGeometry, RotatedAndShiftedPlanesArePlanar)
{
  // Whether points of the grid, stored as doubles or floats, are those of a plane.
  const auto isPlanar = [](const std::vector<Point>& points, int dataType) {
    const auto mesh = MakeCloud(points, dataType);
    SetTriangles(mesh, GridTriangles(6));
    return IsPlanar(mesh);
  };
  Random random(5);
  for (int n = 0; n < 1000; ++n)
  {
    const Matrix rotation = Rotation(random.Vector(), random.Uniform(-3.0, 3.0));
    const double size = std::pow(10.0, random.Uniform(-6.0, 6.0));
    const double away = n % 2 ? 0.0 : std::pow(10.0, random.Uniform(-3.0, 3.0)) * size;
    const double stretch = n % 5 == 0 ? 1e-3 : 1.0;
    const Point shift = away * random.Vector();
    std::vector<Point> points = GridPoints(6, static_cast<std::uint64_t>(n), 0.2);
    std::vector<Point> bent = points;
    // One point off the plane by a few dozen ulp, in double and in float.
    const double off = n % 2 ? 1e-4 : 2e-13;
    bent[static_cast<std::size_t>(random.Below(49))][2] = off;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      points[i] =
        rotation * Point{ size * points[i][0], stretch * size * points[i][1], 0.0 } + shift;
      bent[i] = rotation * bent[i];
    }
    ASSERT_TRUE(isPlanar(points, VTK_DOUBLE)) << n;
    ASSERT_TRUE(isPlanar(points, VTK_FLOAT)) << n;
    ASSERT_FALSE(isPlanar(bent, n % 2 ? VTK_FLOAT : VTK_DOUBLE)) << n;
  }
}

} // namespace
