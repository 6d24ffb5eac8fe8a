// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Mapping points in blocks gives the same bits as mapping each point alone, for any order of
// points.

#include "Fixtures/FilterRuns.h"

#include "Mesh/Homeomorphism.h"

#include "vtkDifferentiableHomeomorphism.h"
#include "vtkImageData.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <string>

namespace
{

using namespace homeomorphism;
using namespace fixtures;

std::shared_ptr<const Homeomorphism> Make(
  const MeshPair& pair, homeomorphism::CoordinateSystem system)
{
  MeshDiagnostics problems;
  HomeomorphismOptions options;
  options.System = system;
  options.DiscordantByLinear = true;
  return Homeomorphism::Make(pair.Source, pair.Target, options, problems);
}

/// Equal to the last bit, including the sign of zero and NaN.
bool IsSame(const double* a, const double* b, int count)
{
  return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(double)) == 0;
}

/// Points of the mesh, of its edges, rounded, of its triangles, in rows and at random, outside, far
/// outside, and NaN.
std::vector<Point> Queries(vtkPolyData* mesh, std::uint64_t seed)
{
  const std::vector<Point> corners = PointsOf(mesh);
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> proportion(0.0, 1.0);
  std::vector<Point> queries = corners;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    const vtkNew<vtkIdList> ids;
    mesh->GetCellPoints(cell, ids);
    const auto combine = [&](double a, double b, double c) {
      Point p;
      for (int axis = 0; axis < 3; ++axis)
      {
        p[axis] = a * corners[ids->GetId(0)][axis] + b * corners[ids->GetId(1)][axis] +
          c * corners[ids->GetId(2)][axis];
      }
      return p;
    };
    for (int i = 0; i < 40; ++i)
    {
      // Runs of points in one triangle, at first close to each other.
      const double a = i < 30 ? 0.02 * i + 0.1 : proportion(generator);
      const double b = i < 30 ? 0.2 : (1.0 - a) * proportion(generator);
      queries.push_back(combine(a, b, 1.0 - a - b));
    }
    const double w = proportion(generator);
    queries.push_back(combine(w, 1.0 - w, 0.0));
    queries.push_back(combine(0.0, w, 1.0 - w));
    queries.push_back(combine(1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0));
    queries.push_back(combine(w, 1.2 - w, -0.2));
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : { none, infinity, -infinity, 1e300, -1e160, 1e20 })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      Point p = corners[corners.size() / 2];
      p[axis] = bad;
      queries.push_back(p);
      queries.push_back(queries[queries.size() / 2]);
    }
  }
  return queries;
}

void ExpectBlocksLikePoints(const Homeomorphism& map, Domain domain,
  const std::vector<Point>& points, const std::string& what)
{
  const double tolerance =
    map.GetAbsoluteTolerance(domain, 0.0, 0.5 * std::numeric_limits<double>::epsilon());
  PointBlock block;
  LocationHint hint;
  for (std::size_t first = 0; first < points.size(); first += block.Count)
  {
    // Blocks of any size.
    block.Count = static_cast<int>(
      std::min<std::size_t>(1 + (first * 7919) % PointBlock::Capacity, points.size() - first));
    std::copy_n(points[first].data(), 3 * block.Count, &block.Points[0][0]);
    const int outside = map.LocateBlock(domain, block, tolerance, hint);
    int expectedOutside = 0;
    for (int i = 0; i < block.Count; ++i)
    {
      const SurfacePoint expected = map.Locate(domain, points[first + i].data(), tolerance, -1);
      const SurfacePoint surfacePoint = block.GetSurfacePoint(i);
      ASSERT_EQ(expected.Triangle, surfacePoint.Triangle) << what << ", point " << first + i;
      ASSERT_EQ(expected.Corner, surfacePoint.Corner) << what << ", point " << first + i;
      expectedOutside += expected.Triangle < 0;
      if (expected.Triangle >= 0)
      {
        ASSERT_TRUE(IsSame(&expected.Point.InPlane.x, &surfacePoint.Point.InPlane.x, 2)) << what;
        ASSERT_TRUE(IsSame(&expected.Point.Offset, &surfacePoint.Point.Offset, 1)) << what;
      }
    }
    ASSERT_EQ(expectedOutside, outside) << what;
    map.MapBlock(domain, block);
    for (int i = 0; i < block.Count; ++i)
    {
      Point image = points[first + i];
      const SurfacePoint surfacePoint = map.Locate(domain, image.data(), tolerance, -1);
      if (surfacePoint.Triangle >= 0)
      {
        map.MapPoint(domain, surfacePoint, image.data());
      }
      ASSERT_TRUE(IsSame(image.data(), block.Images[i], 3))
        << what << ", point " << first + i << ": " << image[0] << " " << block.Images[i][0];
    }
  }
}

void ExpectBlocksLikePoints(const MeshPair& pair, const std::string& what)
{
  for (const auto system :
    { homeomorphism::CoordinateSystem::Linear, homeomorphism::CoordinateSystem::Contour,
      homeomorphism::CoordinateSystem::Smooth, homeomorphism::CoordinateSystem::Cubic })
  {
    const auto map = Make(pair, system);
    if (!map && system == homeomorphism::CoordinateSystem::Cubic)
    {
      // Surfaces are refused.
      continue;
    }
    ASSERT_TRUE(map) << what;
    for (const Domain domain : { Domain::Source, Domain::Target })
    {
      std::vector<Point> points = Queries(domain == Domain::Source ? pair.Source : pair.Target, 5);
      ExpectBlocksLikePoints(*map, domain, points, what);
      std::shuffle(points.begin(), points.end(), std::mt19937_64(6));
      ExpectBlocksLikePoints(*map, domain, points, what + ", shuffled");
    }
  }
}

MeshPair Moved(const MeshPair& pair, double (*height)(double, double))
{
  MeshPair moved;
  const auto move = [height](vtkPolyData* mesh) {
    std::vector<Point> points = PointsOf(mesh);
    for (Point& p : points)
    {
      p[2] = height(p[0], p[1]);
    }
    const auto result = vtkSmartPointer<vtkPolyData>::New();
    result->DeepCopy(MakeMesh(points, {}));
    result->SetPolys(mesh->GetPolys());
    return result;
  };
  moved.Source = move(pair.Source);
  moved.Target = move(pair.Target);
  return moved;
}

TEST(PointBlocks, BlocksEqualSinglePointsInAPlane)
{
  ExpectBlocksLikePoints(MakePlanarPair(9, 21), "a plane");
  ExpectBlocksLikePoints(MakePlanarPair(1, 22), "two triangles");
}

TEST(PointBlocks, BlocksEqualSinglePointsInATiltedPlane)
{
  ExpectBlocksLikePoints(
    Moved(MakePlanarPair(9, 23), [](double x, double y) { return 0.5 * x - 0.25 * y; }),
    "a tilted plane");
}

TEST(PointBlocks, BlocksEqualSinglePointsOnSurfaces)
{
  ExpectBlocksLikePoints(MakeClosedPair(4, 24), "a closed surface");
  MeshPair mixed = MakePlanarPair(6, 25);
  mixed.Target = Moved(mixed, [](double x, double y) { return 0.1 * x * y; }).Target;
  ExpectBlocksLikePoints(mixed, "a plane and a surface");
}

TEST(PointBlocks, PointsWithoutPreimageAreOutside)
{
  // Located where they are not: beyond the domain, in the frame of a triangle.
  const auto map = Make(MakePlanarPair(5, 27), homeomorphism::CoordinateSystem::Cubic);
  ASSERT_TRUE(map);
  const SurfacePoint far{ 3, { { 40.0, -70.0 }, 0.0 }, -1 };
  double image[3];
  EXPECT_FALSE(map->MapPoint(Domain::Target, far, image));
  PointBlock block;
  LocationHint hint;
  block.Count = 3;
  const Point inside{ 2.4, 2.6, 0.0 };
  for (int i = 0; i < 3; ++i)
  {
    std::copy_n(inside.data(), 3, block.Points[i]);
  }
  ASSERT_EQ(map->LocateBlock(Domain::Target, block, 1e-12, hint), 0);
  block.InPlane[0][1] = far.Point.InPlane.x;
  block.InPlane[1][1] = far.Point.InPlane.y;
  EXPECT_EQ(map->MapBlock(Domain::Target, block), 1);
  EXPECT_EQ(block.Triangles[1], -1);
  EXPECT_TRUE(IsSame(block.Images[1], inside.data(), 3));
  for (int i : { 0, 2 })
  {
    const SurfacePoint located = map->Locate(Domain::Target, inside.data(), 1e-12, -1);
    ASSERT_TRUE(map->MapPoint(Domain::Target, located, image));
    EXPECT_EQ(block.Triangles[i], located.Triangle);
    EXPECT_TRUE(IsSame(block.Images[i], image, 3));
  }
}

TEST(PointBlocks, AnImageIsMappedLikeItsPoints)
{
  // Rows and slices end anywhere in a block.
  const MeshPair pair = MakePlanarPair(9, 26);
  vtkNew<vtkImageData> image;
  image->SetExtent(-3, 13, 2, 14, -1, 8);
  image->SetOrigin(2.3, -1.9, 0.4);
  image->SetSpacing(0.61, 0.83, 0.27);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    points->InsertNextPoint(image->GetPoint(i));
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkPoints> images[2];
  for (vtkDataSet* data : { static_cast<vtkDataSet*>(image), static_cast<vtkDataSet*>(cloud) })
  {
    vtkNew<vtkDifferentiableHomeomorphism> filter;
    filter->SetSourceData(pair.Source);
    filter->SetTargetData(pair.Target);
    filter->SetDataObject(data);
    filter->Update();
    EXPECT_LT(filter->GetNumberOfOutsidePoints(), points->GetNumberOfPoints() / 2);
    images[data == cloud]->ShallowCopy(
      vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0))->GetPoints());
  }
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    Point a;
    Point b;
    images[0]->GetPoint(i, a.data());
    images[1]->GetPoint(i, b.data());
    ASSERT_TRUE(IsSame(a.data(), b.data(), 3)) << i;
  }
}

} // namespace
