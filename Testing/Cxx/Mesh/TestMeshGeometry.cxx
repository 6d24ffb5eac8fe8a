// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Cxx/Kernel/RandomTriangles.h"

#include "Mesh/MeshGeometry.h"

#include "vtkNew.h"
#include "vtkPoints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace homeomorphism;
using homeomorphism_test::RandomNumbers;
using homeomorphism_test::Ulp;

namespace
{

/// Triangles with three points of their own each.
class Soup
{
public:
  Soup(int count, const std::function<Vector3(RandomNumbers&)>& pointOf)
  {
    RandomNumbers random(51);
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

double DistanceOf(const double a[3], const double b[3])
{
  return std::hypot(std::hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

void ExpectFramesToReturn(Soup& soup, double size)
{
  MeshGeometry geometry(soup.Points, soup.Topology);
  geometry.ComputeFrames(soup.Topology);
  for (TriangleIndex t = 0; t < soup.Topology.GetNumberOfTriangles(); ++t)
  {
    const Triangulation::Corners& corners = soup.Topology.GetCorners(t);
    for (const std::int32_t corner : corners)
    {
      double point[3];
      soup.Points->GetPoint(corner, point);
      EXPECT_TRUE(geometry.IsMeshPoint(corner, point));
      const Vector3 normalized = geometry.ToNormalized(point);
      double back[3];
      geometry.FromNormalized(normalized, back);
      EXPECT_LE(DistanceOf(point, back), 8.0 * Ulp * size);
      const FramePoint inFrame = geometry.ToFrame(t, normalized);
      geometry.FromNormalized(geometry.FromFrame(t, inFrame), back);
      EXPECT_LE(DistanceOf(point, back), 16.0 * Ulp * size);
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

} // namespace

TEST(MeshGeometry, FramesReturnInThePlane)
{
  for (const double scale : { 1e-200, 1.0, 1e150 })
  {
    Soup soup(200, [scale](RandomNumbers& random) -> Vector3 {
      return { scale * random.Uniform(), scale * random.Uniform(), 0.0 };
    });
    ExpectFramesToReturn(soup, 2.0 * scale);
    EXPECT_TRUE(MeshGeometry(soup.Points, soup.Topology).IsPlanar());
  }
}

TEST(MeshGeometry, FramesReturnInATiltedPlane)
{
  Soup soup(200, [](RandomNumbers& random) -> Vector3 {
    const double x = random.Uniform();
    const double y = random.Uniform();
    return { x, y, 0.25 * x - 0.5 * y + 3.0 };
  });
  ExpectFramesToReturn(soup, 4.0);
  EXPECT_TRUE(MeshGeometry(soup.Points, soup.Topology).IsPlanar());
}

TEST(MeshGeometry, FramesReturnOnASurface)
{
  Soup soup(200, [](RandomNumbers& random) -> Vector3 {
    return { random.Uniform(), random.Uniform(), random.Uniform() };
  });
  ExpectFramesToReturn(soup, 2.0);
  EXPECT_FALSE(MeshGeometry(soup.Points, soup.Topology).IsPlanar());
}

// Normalized coordinates are those of the input times a power of two.
TEST(MeshGeometry, NormalizesWithoutRounding)
{
  Soup soup(20, [](RandomNumbers& random) -> Vector3 {
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
