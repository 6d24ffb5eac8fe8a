// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The Cubic system through the VTK classes: both directions, mirrored targets and mixed winding,
// tilted planes, its Jacobian, its arrays and statistics, and its refusals.

#include "Fixtures/FilterRuns.h"

namespace
{

using namespace fixtures;
using Map = vtkDifferentiableHomeomorphism;

/// The target is sheared, and mirrored or tilted on request. Every third triangle is wound the
/// other way in both meshes.
MeshPair MakePair(bool mirrored, bool tilted)
{
  const MeshPair grid = MakePlanarPair(6, 5, 0.2);
  std::vector<Triangle> triangles = GridTriangles(6);
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    std::swap(triangles[t][1], triangles[t][2]);
  }
  const auto source = Moved(grid.Source, [tilted](const Point& p) -> Point {
    return { p[0], p[1], tilted ? 0.5 * p[0] : 0.0 };
  });
  const auto target = Moved(grid.Target, [mirrored, tilted](const Point& p) -> Point {
    return { (mirrored ? -2.0 : 2.0) * p[0], p[1] + 0.3 * p[0], tilted ? 0.25 * p[1] : 0.0 };
  });
  return WithTriangles({ source, target }, triangles);
}

TEST(CubicSystem, MapsThereAndBack)
{
  for (int kind = 0; kind < 8; ++kind)
  {
    SCOPED_TRACE(kind);
    const MeshPair pair = MakePair((kind & 1) != 0, (kind & 2) != 0);
    const std::vector<MeshPoint> samples = InnerSamples(pair.Source, 300, 7, 1e-3);
    // At each point, and at steps along two edges of its triangle, which stay in the plane.
    constexpr double h = 1e-6;
    std::vector<Point> points;
    for (const MeshPoint& sample : samples)
    {
      const std::array<Point, 3> corners = CornersOf(pair.Source, sample.Triangle);
      const Point point = PositionOf(pair.Source, sample);
      points.push_back(point);
      for (const int k : { 1, 2 })
      {
        points.push_back(point - h * (corners[k] - corners[0]));
        points.push_back(point + h * (corners[k] - corners[0]));
      }
    }
    const auto cloud = MakeCloud(points);
    const auto forward = MakeFilter(Cubic, pair, cloud);
    const auto backward = MakeFilter(Cubic, pair);
    for (const auto& filter : { forward, backward })
    {
      filter->SetCubicBending(kind < 4 ? Map::LOCAL : Map::LEAST);
      filter->SetTolerance(1e-12);
    }
    forward->ComputeJacobianOn();
    vtkPointSet* images = Output(forward);
    backward->SetDataObject(images);
    backward->InverseOn();
    EXPECT_EQ(forward->GetNumberOfOutsidePoints(), 0);
    EXPECT_LE(LargestDistance(Output(backward), cloud), 1e-12);
    for (vtkIdType i = 0; i < images->GetNumberOfPoints(); ++i)
    {
      // Two images on either side of that of the point.
      const vtkIdType k = i % 5;
      const auto differenceOf = [&](vtkDataSet* of) { return PointOf(of, i + 1) - PointOf(of, i); };
      ASSERT_TRUE((k != 1 && k != 3) ||
        Distance(differenceOf(images), JacobianOf(images, i - k) * differenceOf(cloud)) < 1e-4 * h);
    }
  }
}

TEST(CubicSystem, TellsWhatItIs)
{
  const MeshPair pair = MakePair(false, false);
  const auto filter = MakeFilter(Cubic, pair);
  vtkPointSet* mesh = Output(filter);
  ASSERT_TRUE(CellArray(mesh, "Certificate") && PointArray(mesh, "ExceptionalVertex"));
  EXPECT_GT(CellArray(mesh, "Certificate")->GetRange()[0], 0.0);
  EXPECT_EQ(PointArray(mesh, "ExceptionalVertex")->GetRange()[1], 0.0);
  EXPECT_GE(filter->GetNumberOfCubicElements(), 72);
  EXPECT_EQ(filter->GetNumberOfUncertifiedTriangles(), 0);
  EXPECT_GT(filter->GetBendingEnergy(), 0.0);
  EXPECT_EQ(CountDifferentPoints(mesh, pair.Target), 0);
}

TEST(CubicSystem, RefusesSurfacesCoordinatesAndWhatItCannotNumber)
{
  const MeshPair pair = MakePair(false, false);
  const auto coordinates = MakeCoordinates(Cubic, pair.Source);
  MovePoint(pair.Target, 24, PointOf(pair.Target, 24) + Point{ 0.0, 0.0, 0.5 });
  const auto surface = MakeFilter(Cubic, pair);
  // 263,538 triangles, 256 times as many after four refinements.
  const vtkSmartPointer<vtkPolyData> mesh = MakePlanarPair(363, 3).Source;
  ASSERT_GT(mesh->GetNumberOfPolys() * 256, vtkIdType(1) << 26);
  const auto fine = MakeFilter(Cubic, { mesh, mesh });
  fine->SetFairnessRefinement(4);
  for (vtkHomeomorphismAlgorithm* filter :
    std::initializer_list<vtkHomeomorphismAlgorithm*>{ surface, coordinates, fine })
  {
    Messages errors(filter);
    filter->Update();
    EXPECT_TRUE(errors.HasError());
    EXPECT_NE(filter->GetErrorCode(), 0u);
    // The number that is too large is named.
    EXPECT_EQ(errors.Error().find("67108864") != std::string::npos, filter == fine);
  }
  EXPECT_EQ(surface->GetErrorCode(), vtkHomeomorphismAlgorithm::MESHES_REFUSED);
}

TEST(CubicSystem, LeavesWhatIsNotCertified)
{
  // Two neighbors in the middle of a grid are a rounding unit apart in the source.
  std::vector<Point> source = GridPoints(8, 0, 0.0);
  source[41][0] = std::nextafter(source[40][0], 8.0);
  const MeshPair pair{ MakeMesh(source, GridTriangles(8)), RegularGrid(8) };
  Random random(11);
  std::vector<Point> points;
  std::generate_n(std::back_inserter(points), 4000, [&random]() -> Point {
    return { random.Uniform(0.01, 7.99), random.Uniform(0.01, 7.99), 0 };
  });
  const MappedPoints mapped = MapPoints(pair, points, { Cubic });
  EXPECT_NE(mapped.Warning.find("not certified"), std::string::npos) << mapped.Warning;
  const MappedPoints back = MapPoints(pair, mapped.Images, { Cubic, false, true });
  int inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (!mapped.IsInside(i))
    {
      EXPECT_EQ(mapped.Images[i], points[i]);
      continue;
    }
    ++inside;
    const Point image = mapped.Images[i];
    EXPECT_TRUE(std::min(image[0], image[1]) >= 0.0 && std::max(image[0], image[1]) <= 8.0);
    EXPECT_TRUE(!back.IsInside(i) || Distance(back.Images[i], points[i]) < 1e-9);
  }
  EXPECT_GT(inside, 3000);
  EXPECT_LT(inside, 4000);
}

} // namespace
