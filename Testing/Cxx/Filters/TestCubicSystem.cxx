// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The Cubic system through the VTK classes: both directions, mirrored targets and mixed winding,
// tilted planes, its Jacobian, its arrays and statistics, and what it refuses.

#include "Fixtures/FilterRuns.h"

#include "vtkHomeomorphismTransform.h"
#include "vtkJacobianContinuity.h"
#include "vtkTriangularCoordinates.h"

namespace
{

using namespace fixtures;

/// A grid of squares cut in two; the target's inner points are moved, and every point by an affine
/// map whose determinant is negative if the target is to be mirrored. Every third triangle is wound
/// the other way in both.
MeshPair MakePair(bool mirrored, bool tilted)
{
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr int cells = 6;
  std::vector<Point> source;
  std::vector<Point> target;
  std::vector<Triangle> triangles;
  for (int j = 0; j <= cells; ++j)
  {
    for (int i = 0; i <= cells; ++i)
    {
      const bool inner = i > 0 && j > 0 && i < cells && j < cells;
      const double x = i + (inner ? 0.2 * uniform(random) : 0.0);
      const double y = j + (inner ? 0.2 * uniform(random) : 0.0);
      const double u = x + (inner ? 0.25 * uniform(random) : 0.0);
      const double v = y + (inner ? 0.25 * uniform(random) : 0.0);
      source.push_back({ x, y, tilted ? 0.5 * x : 0.0 });
      target.push_back(
        { mirrored ? 10.0 - 2.0 * u : 2.0 * u, v + 0.3 * u, tilted ? 0.25 * v : 0.0 });
    }
  }
  for (int j = 0; j < cells; ++j)
  {
    for (int i = 0; i < cells; ++i)
    {
      const int a = j * (cells + 1) + i;
      const int b = a + 1;
      const int c = b + cells + 1;
      const int d = a + cells + 1;
      triangles.push_back({ a, b, c });
      triangles.push_back({ a, c, d });
    }
  }
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    std::swap(triangles[t][1], triangles[t][2]);
  }
  return { MakeMesh(source, triangles), MakeMesh(target, triangles) };
}

vtkSmartPointer<vtkHomeomorphismTransform> MakeTransform(const MeshPair& pair, int bending)
{
  auto map = vtkSmartPointer<vtkHomeomorphismTransform>::New();
  map->SetSource(pair.Source);
  map->SetTarget(pair.Target);
  map->SetCoordinateSystemToCubic();
  map->SetCubicBending(bending);
  return map;
}

} // anonymous namespace

TEST(CubicSystem, MapsThereAndBack)
{
  for (int kind = 0; kind < 8; ++kind)
  {
    const MeshPair pair = MakePair((kind & 1) != 0, (kind & 2) != 0);
    const int bending =
      kind < 4 ? vtkHomeomorphismTransform::LOCAL : vtkHomeomorphismTransform::LEAST;
    const auto map = MakeTransform(pair, bending);
    const auto inverse = MakeTransform(pair, bending);
    inverse->Inverse();
    // InternalTransformDerivative does not.
    map->Update();
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(0.05, 5.95);
    for (int n = 0; n < 300; ++n)
    {
      double point[3] = { uniform(random), uniform(random), 0.0 };
      point[2] = (kind & 2) != 0 ? 0.5 * point[0] : 0.0;
      double image[3];
      double derivative[3][3];
      map->InternalTransformDerivative(point, image, derivative);
      double back[3];
      inverse->TransformPoint(image, back);
      for (int axis = 0; axis < 3; ++axis)
      {
        EXPECT_NEAR(back[axis], point[axis], 1e-12) << kind;
      }
      // The derivative against differences along the plane.
      constexpr double h = 1e-6;
      const double slope = (kind & 2) != 0 ? 0.5 : 0.0;
      for (int axis = 0; axis < 2; ++axis)
      {
        const double d[3] = { axis == 0 ? h : 0.0, axis == 1 ? h : 0.0,
          axis == 0 ? slope * h : 0.0 };
        double plus[3];
        double minus[3];
        const double p[3] = { point[0] + d[0], point[1] + d[1], point[2] + d[2] };
        const double m[3] = { point[0] - d[0], point[1] - d[1], point[2] - d[2] };
        map->TransformPoint(p, plus);
        map->TransformPoint(m, minus);
        for (int row = 0; row < 3; ++row)
        {
          const double expected =
            derivative[row][0] * d[0] + derivative[row][1] * d[1] + derivative[row][2] * d[2];
          EXPECT_NEAR(0.5 * (plus[row] - minus[row]), expected, 1e-4 * h) << kind;
        }
      }
    }
  }
}

TEST(CubicSystem, IsDifferentiableAtEdgesAndVertices)
{
  const MeshPair pair = MakePair(false, false);
  for (int bending : { vtkJacobianContinuity::LOCAL, vtkJacobianContinuity::LEAST })
  {
    const auto measure = MakeAlgorithm<vtkJacobianContinuity>(pair);
    measure->SetCoordinateSystemToCubic();
    measure->SetCubicBending(bending);
    measure->VerticesOn();
    measure->Update();
    const auto count = [&measure](int feature, int verdict) {
      return measure->GetNumberOfFeatures(feature, verdict);
    };
    using Continuity = vtkJacobianContinuity;
    EXPECT_EQ(count(Continuity::EDGE, Continuity::DIFFERENTIABLE), 96) << bending;
    EXPECT_EQ(count(Continuity::EDGE, Continuity::CREASE), 0) << bending;
    // Interior vertices and, where the boundary is straight or turns alike, the others.
    EXPECT_EQ(count(Continuity::VERTEX, Continuity::DIFFERENTIABLE), 49) << bending;
    EXPECT_EQ(count(Continuity::VERTEX, Continuity::CREASE), 0) << bending;
  }
}

TEST(CubicSystem, TellsWhatItIs)
{
  const MeshPair pair = MakePair(false, false);
  const auto filter = MakeAlgorithm<vtkDifferentiableHomeomorphism>(pair);
  filter->SetCoordinateSystemToCubic();
  filter->Update();
  auto* mesh = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(mesh, nullptr);
  vtkDataArray* certificates = mesh->GetCellData()->GetArray("Certificate");
  ASSERT_NE(certificates, nullptr);
  for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
  {
    EXPECT_GT(certificates->GetTuple1(t), 0.0);
  }
  vtkDataArray* exceptional = mesh->GetPointData()->GetArray("ExceptionalVertex");
  ASSERT_NE(exceptional, nullptr);
  EXPECT_EQ(exceptional->GetRange()[1], 0.0);
  EXPECT_GE(filter->GetNumberOfCubicElements(), 72);
  EXPECT_EQ(filter->GetNumberOfUncertifiedTriangles(), 0);
  EXPECT_GT(filter->GetBendingEnergy(), 0.0);
  // Vertices go to vertices.
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_EQ(mesh->GetPoint(i)[axis], pair.Target->GetPoint(i)[axis]);
    }
  }
}

TEST(CubicSystem, RefusesSurfacesAndCoordinates)
{
  MeshPair pair = MakePair(false, false);
  double raised[3];
  pair.Target->GetPoint(24, raised);
  raised[2] = 0.5;
  pair.Target->GetPoints()->SetPoint(24, raised);
  const auto filter = MakeAlgorithm<vtkDifferentiableHomeomorphism>(pair);
  Messages errors(filter);
  filter->SetCoordinateSystemToCubic();
  filter->Update();
  EXPECT_TRUE(errors.HasError());
  EXPECT_EQ(filter->GetErrorCode(), vtkHomeomorphismAlgorithm::MESHES_REFUSED);

  vtkNew<vtkTriangularCoordinates> coordinates;
  Messages moreErrors(coordinates);
  coordinates->SetSourceData(pair.Source);
  coordinates->SetCoordinateSystemToCubic();
  coordinates->Update();
  EXPECT_TRUE(moreErrors.HasError());
  EXPECT_NE(coordinates->GetErrorCode(), 0u);
}

TEST(CubicSystem, RefusesWhatItCannotNumber)
{
  // 263,538 triangles, 256 times as many after four refinements.
  const vtkSmartPointer<vtkPolyData> mesh = MakePlanarPair(363, 3).Source;
  ASSERT_GT(mesh->GetNumberOfPolys() * 256, vtkIdType(1) << 26);
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  Messages errors(filter);
  filter->SetSourceData(mesh);
  filter->SetTargetData(mesh);
  filter->SetCoordinateSystemToCubic();
  filter->SetFairnessRefinement(4);
  filter->Update();
  EXPECT_NE(errors.Error().find("at most 67108864"), std::string::npos) << errors.Error();
  EXPECT_NE(errors.Error().find("less FairnessRefinement"), std::string::npos);
}
