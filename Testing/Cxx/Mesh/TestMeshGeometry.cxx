// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/Meshes.h"
#include "Fixtures/Triangles.h"

#include "Mesh/MeshGeometry.h"

#include <gtest/gtest.h>

#include <functional>

using namespace homeomorphism;
using fixtures::Point;
using fixtures::Triangle;
using homeomorphism_test::Random;
using homeomorphism_test::Ulp;

namespace
{

/// Triangles with three points of their own each.
class Soup
{
public:
  Soup(int count, const std::function<Vector3(Random&)>& pointOf)
  {
    Random random(51);
    LargeArray<Triangulation::Corners> corners(static_cast<std::size_t>(count));
    this->Points->SetDataTypeToDouble();
    for (std::int32_t t = 0; t < count; ++t)
    {
      for (int k = 0; k < 3; ++k)
      {
        this->Points->InsertNextPoint(pointOf(random).data());
      }
      corners[static_cast<std::size_t>(t)] = { 3 * t, 3 * t + 1, 3 * t + 2 };
    }
    this->Topology.SetTriangles(std::move(corners), 0);
  }

  vtkNew<vtkPoints> Points;
  Triangulation Topology;
};

void ExpectFramesToReturn(Soup& soup, double size)
{
  MeshGeometry geometry(soup.Points, soup.Topology);
  geometry.ComputeFrames(soup.Topology);
  for (TriangleIndex t = 0; t < soup.Topology.GetNumberOfTriangles(); ++t)
  {
    const Triangulation::Corners& corners = soup.Topology.GetCorners(t);
    for (const std::int32_t corner : corners)
    {
      Point point;
      soup.Points->GetPoint(corner, point.data());
      EXPECT_TRUE(geometry.IsMeshPoint(corner, point.data()));
      const Vector3 normalized = geometry.ToNormalized(point.data());
      Point back;
      geometry.FromNormalized(normalized, back.data());
      EXPECT_LE(fixtures::Distance(point, back), 8.0 * Ulp * size);
      const FramePoint inFrame = geometry.ToFrame(t, normalized);
      geometry.FromNormalized(geometry.FromFrame(t, inFrame), back.data());
      EXPECT_LE(fixtures::Distance(point, back), 16.0 * Ulp * size);
      EXPECT_LE(std::abs(inFrame.Offset), 16.0 * Ulp);
    }
    // The axes of the frame are orthonormal.
    const std::array<Vector3, 3> axes = geometry.GetAxes(t);
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        EXPECT_NEAR(Dot3(axes[i], axes[j]), i == j ? 1.0 : 0.0, 8.0 * Ulp);
      }
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
      Soup soup(200, [kind, scale](Random& random) -> Vector3 {
        const double x = scale * random.Uniform();
        const double y = scale * random.Uniform();
        const double slope = 0.25 * x - 0.5 * y + 3.0 * scale;
        return { x, y, kind == 0 ? 0.0 : kind == 1 ? slope : scale * random.Uniform() };
      });
      ExpectFramesToReturn(soup, 4.0 * scale);
      EXPECT_EQ(MeshGeometry(soup.Points, soup.Topology).IsPlanar(), kind < 2);
    }
  }
}

// Normalized coordinates are those of the input times a power of two.
TEST(MeshGeometry, NormalizesWithoutRounding)
{
  Soup soup(20, [](Random& random) -> Vector3 {
    return { 3e7 * random.Uniform(), 5e6 + random.Uniform(), 0.0 };
  });
  MeshGeometry geometry(soup.Points, soup.Topology);
  int exponent;
  EXPECT_EQ(std::frexp(geometry.GetScale(), &exponent), 0.5);
  EXPECT_EQ(geometry.GetScale() * geometry.GetInverseScale(), 1.0);
  double point[3];
  soup.Points->GetPoint(7, point);
  const Vector3 normalized = geometry.ToNormalized(point);
  EXPECT_EQ(normalized[0] * geometry.GetInverseScale(), point[0]);
  EXPECT_EQ(normalized[1] * geometry.GetInverseScale(), point[1]);
}

TEST(MeshGeometry, OrientationIsExact)
{
  // The third point is exactly on the line, or one ulp beside it.
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->InsertNextPoint(0.5, 0.5, 0.0);
  points->InsertNextPoint(12.0, 12.0, 0.0);
  points->InsertNextPoint(24.0, 24.0, 0.0);
  points->InsertNextPoint(24.0, std::nextafter(24.0, 25.0), 0.0);
  points->InsertNextPoint(std::nextafter(24.0, 25.0), 24.0, 0.0);
  LargeArray<Triangulation::Corners> corners(3);
  corners[0] = { 0, 1, 2 };
  corners[1] = { 0, 1, 3 };
  corners[2] = { 0, 1, 4 };
  Triangulation topology;
  topology.SetTriangles(std::move(corners), 0);
  const MeshGeometry geometry(points, topology);
  EXPECT_EQ(geometry.GetOrientation(topology.GetCorners(0)), 0);
  EXPECT_EQ(geometry.GetOrientation(topology.GetCorners(1)), 1);
  EXPECT_EQ(geometry.GetOrientation(topology.GetCorners(2)), -1);
  EXPECT_TRUE(geometry.IsDegenerate(topology, 0));
  EXPECT_FALSE(geometry.IsDegenerate(topology, 1));
}

// --- Planarity -----------------------------------------------------------------------------------

/// Whether points, stored as doubles or floats, are those of a plane. Of the grid, unless triangles
/// are given.
bool IsPlanar(const std::vector<Point>& points, int dataType = VTK_DOUBLE,
  const std::vector<Triangle>& given = {})
{
  const auto cloud = fixtures::MakeCloud(points, dataType);
  const int n = static_cast<int>(std::lround(std::sqrt(double(points.size())))) - 1;
  std::vector<Triangulation::Corners> triangles;
  for (const Triangle& t : given.empty() ? fixtures::GridTriangles(n) : given)
  {
    triangles.push_back({ static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
      static_cast<std::int32_t>(t[2]) });
  }
  Triangulation triangulation;
  triangulation.SetTriangles(triangles, 0);
  triangulation.FindAdjacency(cloud->GetNumberOfPoints());
  return MeshGeometry(cloud->GetPoints(), triangulation).IsPlanar();
}

TEST(MeshGeometry, RotatedAndShiftedPlanesArePlanar)
{
  using fixtures::operator*;
  using fixtures::operator+;
  fixtures::Random random(5);
  for (int n = 0; n < 1000; ++n)
  {
    const fixtures::Matrix rotation =
      fixtures::Rotation(random.Vector(), random.Uniform(-3.0, 3.0));
    const double size = std::pow(10.0, random.Uniform(-6.0, 6.0));
    const double away = n % 2 ? 0.0 : std::pow(10.0, random.Uniform(-3.0, 3.0)) * size;
    const double stretch = n % 5 == 0 ? 1e-3 : 1.0;
    const Point shift = away * random.Vector();
    std::vector<Point> points = fixtures::GridPoints(6, static_cast<std::uint64_t>(n), 0.2);
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
    ASSERT_TRUE(IsPlanar(points)) << n;
    ASSERT_TRUE(IsPlanar(points, VTK_FLOAT)) << n;
    ASSERT_FALSE(IsPlanar(bent, n % 2 ? VTK_FLOAT : VTK_DOUBLE)) << n;
  }
}

} // namespace
