// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Finer pairs: the piecewise linear map is within the maximum error between the samples, the meshes
// are valid and conforming, and data is interpolated as in the original triangles.

#include "Fixtures/FilterRuns.h"

#include "vtkRefinedTriangulationPair.h"

#include "vtkFeatureEdges.h"
#include "vtkSMPTools.h"

namespace
{

using namespace fixtures;

vtkSmartPointer<vtkRefinedTriangulationPair> Refined(const MeshPair& pair, double maximumError)
{
  auto filter = MakeAlgorithm<vtkRefinedTriangulationPair>(pair);
  filter->SetMaximumError(maximumError);
  filter->Update();
  return filter;
}

/// The largest distance between the homeomorphism of a pair, in the system of the filter, and the
/// piecewise linear map of the finer pair at random points, some of them on edges, the boundary's
/// too, or close to edges and vertices.
double LargestError(const MeshPair& pair, vtkRefinedTriangulationPair* filter)
{
  const auto cloud = MakeCloud(pair.Source, RandomSamples(pair.Source, 20000, 5));
  const System system{ "", filter->GetCoordinateSystem() };
  const auto exact = MakeFilter(system, pair, cloud);
  exact->SetMaximumDeviation(filter->GetMaximumDeviation());
  const auto linear = MakeFilter(Linear, { filter->GetOutput(), filter->GetTargetOutput() }, cloud);
  for (const auto& map : { exact, linear })
  {
    // On surfaces, and on the boundary, points between corners are off the mesh by rounding.
    map->SetTolerance(1e-12);
    map->Update();
    EXPECT_EQ(map->GetNumberOfOutsidePoints(), 0);
  }
  return LargestDistance(Output(exact), Output(linear));
}

/// The triangles have positive areas, which fill the square [0, size]^2. Every edge has two of them
/// or lies exactly on the boundary, so no edge ends at a vertex inside another edge.
void ExpectConforming(vtkPolyData* mesh, double size)
{
  double twice = 0.0;
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    const double area = NormalOf(mesh, c)[2];
    EXPECT_GT(area, 0.0);
    twice += area;
  }
  EXPECT_NEAR(twice, 2.0 * size * size, 1e-11);
  // Those of one triangle, or of three.
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(mesh);
  edges->FeatureEdgesOff();
  edges->ManifoldEdgesOff();
  edges->Update();
  for (vtkIdType i = 0; i < edges->GetOutput()->GetNumberOfCells(); ++i)
  {
    const double* b = edges->GetOutput()->GetCell(i)->GetBounds();
    EXPECT_TRUE((b[0] == b[1] && (b[0] == 0.0 || b[0] == size)) ||
      (b[2] == b[3] && (b[2] == 0.0 || b[2] == size)));
  }
}

TEST(RefinedTriangulationPair, KeepsTheMaximumErrorPointsAndAreas)
{
  using Filter = vtkRefinedTriangulationPair;
  const MeshPair planar = MakePlanarPair(4, 23);
  // Four triangles whose common corner is moved.
  const auto square = [](double x, double y) {
    return MakeMesh({ { 0, 0, 0 }, { 3, 0, 0 }, { 3, 3, 0 }, { 0, 3, 0 }, { x, y, 0 } },
      { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } });
  };
  const MeshPair upright{ square(1.5, 1.5), square(2.1, 1.8) };
  const auto turn = [](const Point& p) {
    return Point{ 100.0 + 0.8 * p[0] - 0.7 * p[1], 0.6 * p[0] + 0.9 * p[1], 0.0 };
  };
  const MeshPair oblique = Moved(upright, turn);
  struct Case
  {
    MeshPair Pair;
    int System;
    double MaximumError;
    double MaximumDeviation = VTK_DOUBLE_MAX;
  };
  const std::vector<Case> cases{ { planar, Filter::LINEAR, 1e-9 }, { planar, Filter::SMOOTH, 0.01 },
    { planar, Filter::SMOOTH, 0.003 }, { MakePlanarPair(3, 29, 0.1), Filter::CONTOUR, 0.005 },
    { MakeClosedPair(1, 31), Filter::SMOOTH, 0.01 }, { upright, Filter::CUBIC, 0.01 },
    { upright, Filter::CUBIC, 0.01, 0.05 }, { MakePlanarPair(3, 71), Filter::CUBIC, 0.01 },
    { MakePlanarPair(3, 71), Filter::CUBIC, 0.01, 0.05 }, { oblique, Filter::CUBIC, 0.01 } };
  for (const Case& one : cases)
  {
    const MeshPair& pair = one.Pair;
    const auto filter = MakeAlgorithm<Filter>(pair);
    filter->SetMaximumError(one.MaximumError);
    filter->SetCoordinateSystem(one.System);
    filter->SetDiscordantTriangles(Filter::REFUSE);
    filter->SetMaximumDeviation(one.MaximumDeviation);
    filter->SetMaximumNumberOfTriangles(20000);
    filter->Update();
    ASSERT_EQ(filter->GetResult(), Filter::REFINED);
    EXPECT_LE(filter->GetLargestError(), one.MaximumError);
    EXPECT_GT(filter->GetNumberOfSamples(), 0);
    EXPECT_LE(LargestError(pair, filter), 1.05 * one.MaximumError);
    for (const bool ofTarget : { false, true })
    {
      vtkPolyData* mesh = ofTarget ? filter->GetTargetOutput() : filter->GetOutput();
      vtkPolyData* original = ofTarget ? pair.Target : pair.Source;
      // No triangle of a linear map is divided.
      EXPECT_EQ(
        mesh->GetNumberOfCells() == original->GetNumberOfCells(), one.System == Filter::LINEAR);
      for (vtkIdType i = 0; i < original->GetNumberOfPoints(); ++i)
      {
        EXPECT_EQ(PointOf(mesh, i), PointOf(original, i));
      }
      const double* bounds = original->GetBounds();
      if (bounds[0] == 0.0 && bounds[5] == 0.0)
      {
        ExpectConforming(mesh, bounds[1]);
      }
    }
  }
}

TEST(RefinedTriangulationPair, InterpolatesPointDataInTheOriginalTriangle)
{
  const MeshPair pair = MakePlanarPair(3, 43);
  AddVerticesAndLines(pair.Source, 2, 1); // shift the cell ids
  AddVerticesAndLines(pair.Target, 2, 1);
  const auto heights = RandomArray("Height", 1, pair.Source->GetNumberOfPoints(), 47);
  pair.Source->GetPointData()->AddArray(heights);
  const auto cellNumbers = RandomArray("Region", 1, pair.Source->GetNumberOfCells(), 53);
  pair.Target->GetCellData()->AddArray(cellNumbers);
  const auto filter = Refined(pair, 0.004);
  vtkPolyData* refined = filter->GetOutput();
  vtkDataArray* interpolated = PointArray(refined, "Height");
  ASSERT_NE(interpolated, nullptr);
  EXPECT_EQ(PointArray(filter->GetTargetOutput(), "Height"), nullptr);
  for (vtkIdType c = 0; c < refined->GetNumberOfCells(); ++c)
  {
    const auto original = static_cast<vtkIdType>(CellValue(refined, "OriginalCellIds", c));
    EXPECT_EQ(CellValue(filter->GetTargetOutput(), "Region", c), cellNumbers->GetValue(original));
    const auto corners = CornersOf(pair.Source, original);
    const double area = NormalOf(pair.Source, original)[2];
    for (const vtkIdType id : IdsOf(refined, c))
    {
      const Point p = PointOf(refined, id);
      double height = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
      {
        const Point share = Cross(corners[(k + 1) % 3] - p, corners[(k + 2) % 3] - p);
        height += share[2] / area * heights->GetValue(IdsOf(pair.Source, original)[k]);
      }
      EXPECT_NEAR(interpolated->GetTuple1(id), height, 1e-10);
    }
  }
}

TEST(RefinedTriangulationPair, ArraysOfWrongLengthAreLeftOut)
{
  const MeshPair pair = MakePlanarPair(3, 53);
  for (const vtkIdType tuples : { 0, 1, 15, 17, 18 })
  {
    pair.Source->GetPointData()->AddArray(RandomArray("Values", 3, tuples, 1));
    pair.Source->GetCellData()->AddArray(RandomArray("Values", 3, tuples, 2));
    const auto filter = Refined(pair, 0.01);
    vtkPolyData* refined = filter->GetOutput();
    EXPECT_GT(refined->GetNumberOfCells(), 18);
    EXPECT_FALSE(PointArray(refined, "Values"));
    EXPECT_EQ(CellArray(refined, "Values") != nullptr, tuples == 18);
    EXPECT_TRUE(CellArray(refined, "OriginalCellIds"));
  }
}

TEST(RefinedTriangulationPair, DoesNotDependOnThreadsOrUnits)
{
  const MeshPair pair = MakePlanarPair(3, 59);
  const auto filter = Refined(pair, 0.004);
  const auto first = CopyOf(filter->GetTargetOutput());
  vtkSMPTools::Initialize(1);
  filter->Modified();
  filter->Update();
  vtkSMPTools::Initialize();
  EXPECT_EQ(CountDifferentPoints(filter->GetTargetOutput(), first), 0);
  const double unit = 0x1p-40;
  const auto other = Refined(Resized(pair, unit), 0.004 * unit);
  EXPECT_EQ(CountDifferentPoints(other->GetTargetOutput(), Resized(first, unit)), 0);
}

TEST(RefinedTriangulationPair, ReportsFailures)
{
  using Filter = vtkRefinedTriangulationPair;
  const MeshPair near = MakePlanarPair(3, 61);
  const MeshPair far = Moved(near, [](const Point& p) { return p + Point{ 0x1p44, 0x1p44, 0.0 }; });
  struct Case
  {
    MeshPair Pair;
    double MaximumError;
    vtkIdType MaximumNumber;
    int Result;
    bool IsMeasured;
  };
  vtkNew<Filter> filter;
  Messages messages(filter);
  for (const Case& one : { Case{ near, 1e-4, 100, Filter::TOO_MANY_TRIANGLES, true },
         // Fewer than the pair itself has.
         { near, 1e9, 5, Filter::TOO_MANY_TRIANGLES, false },
         { far, 1e-6, 100000, Filter::BELOW_ROUNDING, true },
         { { near.Source, MakePlanarPair(4, 1).Target }, 0.01, 100, Filter::INVALID, false } })
  {
    messages.Clear();
    SetMeshes(filter, one.Pair);
    filter->SetMaximumError(one.MaximumError);
    filter->SetMaximumNumberOfTriangles(one.MaximumNumber);
    filter->Update();
    EXPECT_TRUE(messages.HasError());
    EXPECT_EQ(filter->GetResult(), one.Result);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
    EXPECT_EQ(
      filter->GetLargestError() > (one.IsMeasured ? one.MaximumError : 0.0), one.IsMeasured);
  }
}

} // namespace
