// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkDifferentiableHomeomorphism: the properties of the map, the supported kinds of data, the
// output arrays, and caching.

#include "Fixtures/FilterRuns.h"

#include "vtkTriangularCoordinates.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkRectilinearGrid.h"
#include "vtkStringArray.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"

#include <functional>
#include <iostream>
#include <set>
#include <sstream>

namespace
{

using namespace fixtures;

class FilterInEverySystem : public ::testing::TestWithParam<System>
{
};

INSTANTIATE_TEST_SUITE_P(All, FilterInEverySystem, ::testing::ValuesIn(AllSystems()), NameOfSystem);

/// Pairs whose triangles are all concordant. In the Contour system discordant triangles are mapped
/// by the Linear system, and they differ from pair to pair.
MeshPair ConcordantPair(std::uint64_t seed)
{
  return MakePlanarPair(12, seed, 0.06);
}

// --- The map -------------------------------------------------------------------------------------

TEST_P(FilterInEverySystem, RoundTrip)
{
  constexpr vtkIdType pointsPerPair = 170000;
  vtkIdType total = 0;
  for (const Pairing& pairing : AllPairings(20, 3, 100))
  {
    const MeshPair& pair = pairing.Meshes;
    const auto cloud = MakeCloud(pair.Source, RandomSamples(pair.Source, pointsPerPair, 1));
    const auto forward = MakeFilter(GetParam(), pair, cloud);
    const auto backward = MakeFilter(GetParam(), pair);
    backward->SetDataConnection(forward->GetOutputPort());
    backward->InverseOn();
    for (const auto& filter : { forward, backward })
    {
      filter->ComputeJacobianOn();
    }
    vtkPointSet* back = Output(backward);
    ASSERT_TRUE(back);
    EXPECT_EQ(forward->GetNumberOfOutsidePoints(), 0) << pairing.Name;
    EXPECT_EQ(backward->GetNumberOfOutsidePoints(), 0) << pairing.Name;

    // The image is rounded to an ulp of the target's coordinates, and the inverse magnifies this by
    // |J^-1|, to more than 1e-14 where the map contracts strongly. At an edge the derivatives of
    // both triangles count, because rounding may move the image to the other side.
    const double size = SizeOf(pair.Source);
    const double stored = Ulp * LargestCoordinate(pair.Target);
    vtkDataArray* jacobian = PointArray(Output(forward), "Jacobian");
    vtkDataArray* jacobianBack = PointArray(back, "Jacobian");
    Worst worst;
    double worstWellConditioned = 0.0;
    for (vtkIdType i = 0; i < pointsPerPair; ++i)
    {
      const double error = Distance(PointOf(back, i), PointOf(cloud, i));
      const double stretch =
        std::max(Norm(Inverted(MatrixOf(jacobian, i))), Norm(MatrixOf(jacobianBack, i)));
      worst.Take(error, std::max(1e-14 * size, stretch * stored));
      if (stretch * stored < 1e-15 * size)
      {
        worstWellConditioned = std::max(worstWellConditioned, error / size);
      }
    }
    std::cout << GetParam().Name << ", " << pairing.Name << ": worst round trip "
              << worst.Error / size << " of the mesh's size, " << worstWellConditioned
              << " where well conditioned, " << worst.OverBound << " of the bound\n";
    EXPECT_LE(worst.OverBound, 1.0) << pairing.Name;
    total += pointsPerPair;
  }
  EXPECT_GE(total, 1000000);
}

TEST_P(FilterInEverySystem, InverseIsTheMapOfExchangedMeshes)
{
  for (const Pairing& pairing : AllPairings(8, 2, 110))
  {
    const MeshPair& pair = pairing.Meshes;
    const auto cloud = MakeCloud(pair.Target, RandomSamples(pair.Target, 5000, 2));
    const auto inverse = MakeFilter(GetParam(), pair, cloud);
    inverse->InverseOn();
    const auto exchanged = MakeFilter(GetParam(), { pair.Target, pair.Source }, cloud);
    for (const auto& filter : { inverse, exchanged })
    {
      filter->ComputeJacobianOn();
      filter->ComputeJacobianDeterminantOn();
      filter->ComputeTriangleIdOn();
    }
    vtkPointSet* a = Output(inverse);
    vtkPointSet* b = Output(exchanged);
    EXPECT_EQ(CountDifferentPoints(a, b), 0) << pairing.Name;
    EXPECT_GT(CountDifferentPoints(a, cloud), 4000) << pairing.Name;
    for (const char* name :
      { "vtkValidPointMask", "TriangleId", "Jacobian", "JacobianDeterminant" })
    {
      EXPECT_EQ(CountDifferentValues(PointArray(a, name), PointArray(b, name)), 0)
        << pairing.Name << " " << name;
    }
  }
}

TEST_P(FilterInEverySystem, EqualMeshesGiveTheIdentity)
{
  for (const Pairing& pairing : AllPairings(8, 2, 120))
  {
    const auto mesh = pairing.Meshes.Target;
    vtkNew<vtkPolyData> copy;
    copy->DeepCopy(mesh);
    const auto cloud = MakeCloud(mesh, RandomSamples(mesh, 5000, 3));
    const auto filter = MakeFilter(GetParam(), { mesh, copy }, cloud);
    filter->ComputeJacobianOn();
    vtkPointSet* output = Output(filter);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    Worst worst;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      worst.Take(Distance(PointOf(output, i), PointOf(cloud, i)), 1e-14 * SizeOf(mesh));
      const Matrix identity{ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
      worst.Take(Distance(MatrixOf(PointArray(output, "Jacobian"), i), identity), 1e-10);
    }
    EXPECT_LE(worst.OverBound, 1.0) << pairing.Name;
  }
}

TEST_P(FilterInEverySystem, MapsCompose)
{
  const MeshPair first = ConcordantPair(130);
  const MeshPair second = ConcordantPair(132);
  const MeshPair closed = MakeClosedPair(2, 134);
  struct Triple
  {
    vtkSmartPointer<vtkPolyData> P;
    vtkSmartPointer<vtkPolyData> Q;
    vtkSmartPointer<vtkPolyData> R;
    bool IsConcordant;
  };
  const Matrix tilt = Tilt();
  const std::vector<Triple> triples{ { first.Source, first.Target, second.Source, true },
    { first.Source, Tilted(first.Target, tilt, { 0.0, 0.0, 1.0 }), second.Source, true },
    { MakeSheet(8, 136, 0.4), MakeSheet(8, 137, 0.8), MakePlanarPair(8, 138).Source, false },
    { closed.Source, closed.Target, MakeClosedPair(2, 140).Target, false } };
  for (const Triple& triple : triples)
  {
    if (!triple.IsConcordant && GetParam().IsContour() &&
      GetParam().CenterPoint == vtkDifferentiableHomeomorphism::CENTROID)
    {
      continue;
    }
    const auto cloud = MakeCloud(triple.P, RandomSamples(triple.P, 20000, 4));
    const auto toQ = MakeFilter(GetParam(), { triple.P, triple.Q }, cloud);
    const auto toR = MakeFilter(GetParam(), { triple.Q, triple.R });
    toR->SetDataConnection(toQ->GetOutputPort());
    toR->ComputeJacobianOn();
    const auto direct = MakeFilter(GetParam(), { triple.P, triple.R }, cloud);
    vtkPointSet* twoSteps = Output(toR);
    vtkPointSet* oneStep = Output(direct);
    EXPECT_EQ(toR->GetNumberOfOutsidePoints(), 0);
    Worst worst;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      // As in RoundTrip: the second map magnifies the rounding in Q.
      const double stretch = Norm(MatrixOf(PointArray(twoSteps, "Jacobian"), i));
      worst.Take(Distance(PointOf(twoSteps, i), PointOf(oneStep, i)),
        std::max(1e-14 * SizeOf(triple.R), 2.0 * stretch * Ulp * LargestCoordinate(triple.Q)));
    }
    EXPECT_LE(worst.OverBound, 1.0);
  }
}

TEST_P(FilterInEverySystem, VerticesMapToVerticesExactly)
{
  for (const Pairing& pairing : AllPairings(10, 2, 150))
  {
    const MeshPair& pair = pairing.Meshes;
    const auto filter = MakeFilter(GetParam(), pair);
    vtkPointSet* output = Output(filter);
    ASSERT_TRUE(output);
    EXPECT_EQ(CountDifferentPoints(output, pair.Target), 0) << pairing.Name;
    EXPECT_EQ(CountDifferentCells(output, pair.Target), 0) << pairing.Name;
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0) << pairing.Name;

    filter->InverseOn();
    EXPECT_EQ(CountDifferentPoints(Output(filter), pair.Source), 0) << pairing.Name;
  }
}

TEST_P(FilterInEverySystem, VerticesOfFloatMeshesMapToVerticesExactly)
{
  for (const Pairing& pairing : AllPairings(6, 1, 155))
  {
    MeshPair pair = pairing.Meshes;
    for (auto* mesh : { &pair.Source, &pair.Target })
    {
      vtkNew<vtkPoints> points;
      points->SetDataTypeToFloat();
      points->DeepCopy((*mesh)->GetPoints());
      ASSERT_EQ(points->GetDataType(), VTK_FLOAT);
      auto copy = vtkSmartPointer<vtkPolyData>::New();
      copy->ShallowCopy(*mesh);
      copy->SetPoints(points);
      *mesh = copy;
    }
    const auto filter = MakeFilter(GetParam(), pair);
    vtkPointSet* output = Output(filter);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0) << pairing.Name;
    EXPECT_EQ(CountDifferentPoints(output, pair.Target), 0) << pairing.Name;
  }
}

TEST_P(FilterInEverySystem, EdgesAreMappedLinearly)
{
  for (const Pairing& pairing : AllPairings(10, 2, 160))
  {
    const MeshPair& pair = pairing.Meshes;
    Random random(5);
    std::vector<MeshPoint> samples;
    for (vtkIdType t = 0; t < pair.Source->GetNumberOfCells(); ++t)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        for (int i = 0; i < 8; ++i)
        {
          const double p = i < 4 ? random.Uniform() : std::pow(10.0, random.Uniform(-15.0, 0.0));
          MeshPoint surfacePoint{ t, {} };
          surfacePoint.Weights[(k + 1) % 3] = 1.0 - p;
          surfacePoint.Weights[(k + 2) % 3] = p;
          samples.push_back(surfacePoint);
        }
      }
    }
    const auto cloud = MakeCloud(pair.Source, samples);
    const auto filter = MakeFilter(GetParam(), pair, cloud);
    filter->ComputeJacobianOn();
    vtkPointSet* output = Output(filter);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0) << pairing.Name;
    Worst worst;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      const auto id = static_cast<vtkIdType>(i);
      const double stretch = Norm(MatrixOf(PointArray(output, "Jacobian"), id));
      worst.Take(Distance(PointOf(output, id), PositionOf(pair.Target, samples[i])),
        std::max(
          1e-14 * SizeOf(pair.Target), 2.0 * stretch * Ulp * LargestCoordinate(pair.Source)));
    }
    EXPECT_LE(worst.OverBound, 1.0) << pairing.Name;
  }
}

TEST_P(FilterInEverySystem, MirroredPairs)
{
  MeshPair pair = MakePlanarPair(12, 170);
  pair.Target = Moved(pair.Target, [](const Point& p) -> Point { return { -p[0], p[1], p[2] }; });
  const auto cloud = MakeCloud(pair.Source, RandomSamples(pair.Source, 20000, 6));
  const auto forward = MakeFilter(GetParam(), pair, cloud);
  forward->ComputeJacobianOn();
  forward->ComputeJacobianDeterminantOn();
  const auto backward = MakeFilter(GetParam(), pair);
  backward->SetDataConnection(forward->GetOutputPort());
  backward->InverseOn();
  vtkPointSet* back = Output(backward);
  double range[2];
  PointArray(back, "JacobianDeterminant")->GetRange(range);
  EXPECT_LT(range[1], 0.0);
  Worst worst;
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    const double stretch = Norm(Inverted(MatrixOf(PointArray(back, "Jacobian"), i)));
    worst.Take(Distance(PointOf(back, i), PointOf(cloud, i)),
      std::max(1e-14 * SizeOf(pair.Source), 2.0 * stretch * Ulp * LargestCoordinate(pair.Target)));
  }
  EXPECT_LE(worst.OverBound, 1.0);

  // The mirror image of the map is the map of the mirror images.
  const MeshPair straight = MakePlanarPair(12, 170);
  const auto unmirrored = MakeFilter(GetParam(), straight, cloud);
  vtkPointSet* image = Output(unmirrored);
  vtkPointSet* mirrored = vtkPointSet::SafeDownCast(forward->GetOutputDataObject(0));
  double largest = 0.0;
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    const Point p = PointOf(image, i);
    largest = std::max(largest, Distance(PointOf(mirrored, i), { -p[0], p[1], p[2] }));
  }
  EXPECT_LE(largest, 1e-14 * SizeOf(pair.Target));

  // On a surface the mirror image is another surface, where areas have no sign.
  MeshPair closed = MakeClosedPair(2, 172);
  closed.Target = Moved(closed.Target, [](const Point& p) -> Point {
    return { -p[0], p[1], p[2] };
  });
  const auto onSurface =
    MakeFilter(GetParam(), closed, MakeCloud(closed.Source, RandomSamples(closed.Source, 5000, 7)));
  onSurface->ComputeJacobianDeterminantOn();
  PointArray(Output(onSurface), "JacobianDeterminant")->GetRange(range);
  EXPECT_EQ(onSurface->GetNumberOfOutsidePoints(), 0);
  EXPECT_GT(range[0], 0.0);
}

/// The attainable accuracy of a Jacobian. In all systems except Linear, J depends on the direction
/// from a vertex near it, and the relative accuracy of that direction decreases with the distance.
double JacobianBound(vtkPolyData* mesh, const MeshPoint& surfacePoint)
{
  const Point position = PositionOf(mesh, surfacePoint);
  double nearest = SizeOf(mesh);
  for (const Point& corner : CornersOf(mesh, surfacePoint.Triangle))
  {
    nearest = std::min(nearest, Distance(corner, position));
  }
  return 1e-11 + 32.0 * Ulp * SizeOf(mesh) / nearest;
}

TEST_P(FilterInEverySystem, AffinePairs)
{
  // A similarity for the Contour system, because other affine maps do not preserve its right
  // angles.
  const Matrix turn = Rotation({ 0.0, 0.0, 1.0 }, 2.1);
  const Matrix affine{ { { 1.5, 0.75, 0.0 }, { -0.25, 2.0, 0.0 }, { 0.0, 0.0, 1.0 } } };
  const Matrix similarity{ { 2.5 * turn[0], 2.5 * turn[1], { 0.0, 0.0, 1.0 } } };
  const Matrix& matrix = GetParam().IsContour() ? similarity : affine;
  const Point shift{ 3.0, -4.0, 0.5 };
  const auto source = MakePlanarPair(10, 180).Source;
  const auto image = [&](const Point& p) { return matrix * p + shift; };
  const MeshPair pair{ source, Moved(source, image) };
  const std::vector<MeshPoint> samples = RandomSamples(source, 20000, 8);
  const auto cloud = MakeCloud(source, samples);
  const auto filter = MakeFilter(GetParam(), pair, cloud);
  filter->ComputeJacobianOn();
  filter->ComputeJacobianDeterminantOn();
  vtkPointSet* output = Output(filter);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
  Worst points;
  Worst jacobians;
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    points.Take(
      Distance(PointOf(output, i), image(PointOf(cloud, i))), 1e-14 * SizeOf(pair.Target));
    const double bound = JacobianBound(source, samples[static_cast<std::size_t>(i)]);
    jacobians.Take(
      Distance(MatrixOf(PointArray(output, "Jacobian"), i), matrix), bound * Norm(matrix));
    jacobians.Take(
      std::abs(PointArray(output, "JacobianDeterminant")->GetComponent(i, 0) - Determinant(matrix)),
      bound * Norm(matrix) * Norm(matrix));
  }
  EXPECT_LE(points.OverBound, 1.0);
  EXPECT_LE(jacobians.OverBound, 1.0);
}

TEST_P(FilterInEverySystem, SurfacesThatAreMovedInSpace)
{
  const Matrix turn = Rotation({ 2.0, 1.0, -1.0 }, 1.3);
  const Point shift{ 0.25, -1.0, 2.0 };
  for (const auto& source : { MakeSheet(8, 185, 0.7), MakeClosedPair(2, 186).Target })
  {
    const MeshPair pair{ source, Tilted(source, turn, shift) };
    const std::vector<MeshPoint> samples = RandomSamples(source, 10000, 9);
    const auto cloud = MakeCloud(source, samples);
    const auto filter = MakeFilter(GetParam(), pair, cloud);
    filter->ComputeJacobianOn();
    filter->ComputeJacobianDeterminantOn();
    vtkPointSet* output = Output(filter);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    Worst worst;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      worst.Take(Distance(PointOf(output, i), turn * PointOf(cloud, i) + shift),
        1e-14 * SizeOf(pair.Target));
      const double bound = JacobianBound(source, samples[static_cast<std::size_t>(i)]);
      worst.Take(Distance(MatrixOf(PointArray(output, "Jacobian"), i), turn), bound);
      worst.Take(
        std::abs(PointArray(output, "JacobianDeterminant")->GetComponent(i, 0) - 1.0), bound);
    }
    EXPECT_LE(worst.OverBound, 1.0);
  }
}

TEST_P(FilterInEverySystem, PlanesParallelToTwoAxesGiveTheSameBits)
{
  const MeshPair pair = MakePlanarPair(10, 190);
  const auto cloud = MakeCloud(pair.Source, RandomSamples(pair.Source, 10000, 10));
  const auto filter = MakeFilter(GetParam(), pair, cloud);
  filter->ComputeJacobianOn();
  vtkPointSet* flat = Output(filter);
  // x and y become y and z (the plane x = const), or z and x.
  for (const int turns : { 1, 2 })
  {
    const auto turned = [turns](const Point& p) {
      Point q;
      for (int axis = 0; axis < 3; ++axis)
      {
        q[(axis + turns) % 3] = p[axis];
      }
      return q;
    };
    const auto at = [&turned](double height) {
      return [&turned, height](const Point& p) { return turned({ p[0], p[1], height }); };
    };
    const auto turnedFilter = MakeFilter(GetParam(),
      { Moved(pair.Source, at(0.75)), Moved(pair.Target, at(-2.5)) }, Moved(cloud, at(0.75)));
    turnedFilter->ComputeJacobianOn();
    vtkPointSet* output = Output(turnedFilter);
    EXPECT_EQ(turnedFilter->GetNumberOfOutsidePoints(), 0);
    vtkIdType different = 0;
    vtkIdType jacobians = 0;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      const Point p = PointOf(flat, i);
      different += PointOf(output, i) != turned({ p[0], p[1], -2.5 });
      const Matrix j = MatrixOf(PointArray(flat, "Jacobian"), i);
      const Matrix turnedRows{ turned(j[0]), turned(j[1]), turned(j[2]) };
      Matrix expected;
      for (int row = 0; row < 3; ++row)
      {
        expected[(row + turns) % 3] = turnedRows[row];
      }
      jacobians += MatrixOf(PointArray(output, "Jacobian"), i) != expected;
    }
    EXPECT_EQ(different, 0);
    EXPECT_EQ(jacobians, 0);
  }
}

TEST_P(FilterInEverySystem, RotatedPlanesGiveTheRotatedImageAndKeepHeights)
{
  const MeshPair pair = MakePlanarPair(10, 200);
  const auto samples = RandomSamples(pair.Source, 10000, 11);
  Random random(12);
  std::vector<Point> positions;
  for (const MeshPoint& surfacePoint : samples)
  {
    Point p = PositionOf(pair.Source, surfacePoint);
    p[2] = random.Uniform(-5.0, 5.0);
    positions.push_back(p);
  }
  const auto cloud = MakeCloud(positions);
  const auto filter = MakeFilter(GetParam(), pair, cloud);
  filter->ComputeJacobianOn();
  vtkPointSet* flat = Output(filter);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
  vtkIdType changedHeights = 0;
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    changedHeights += PointOf(flat, i)[2] != positions[static_cast<std::size_t>(i)][2];
  }
  EXPECT_EQ(changedHeights, 0);

  // Rotated a little, by a right angle, and upside down.
  const std::vector<Matrix> rotations{ Rotation({ 1.0, 1.0, 0.0 }, 0.4),
    Rotation({ -1.0, 2.0, 0.3 }, -0.6), Rotation({ 0.0, 1.0, 0.1 }, 1.4),
    Rotation({ 1.0, 0.1, 0.0 }, -1.3), Rotation({ 1.0, 0.3, 0.0 }, 2.8) };
  const Point shift{ 1.0, -2.0, 0.5 };
  int turnedOver = 0;
  for (std::size_t k = 0; k < rotations.size(); ++k)
  {
    const Matrix& from = rotations[k];
    const Matrix& to = rotations[(k + 1) % rotations.size()];
    // The normals of source and target make less than a right angle.
    const Point sourceUp = from * Point{ 0.0, 0.0, 1.0 };
    const Point targetUp = to * Point{ 0.0, 0.0, 1.0 };
    const double side = Dot(sourceUp, targetUp) < 0.0 ? -1.0 : 1.0;
    EXPECT_GT(std::abs(Dot(sourceUp, targetUp)), 0.01);
    turnedOver += side < 0.0;
    const Matrix flip{ { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, side } } };

    const auto tilted = MakeFilter(GetParam(),
      { Tilted(pair.Source, from, {}), Tilted(pair.Target, to, shift) }, Tilted(cloud, from, {}));
    tilted->ComputeJacobianOn();
    tilted->ComputeJacobianDeterminantOn();
    vtkPointSet* output = Output(tilted);
    // Points outside by the rounding of a rotation are moved inside. Heights must not disturb this.
    EXPECT_EQ(tilted->GetNumberOfOutsidePoints(), 0);
    Worst points;
    Worst jacobians;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      const Matrix j = MatrixOf(PointArray(flat, "Jacobian"), i);
      points.Take(Distance(PointOf(output, i), to * (flip * PointOf(flat, i)) + shift),
        8.0 * Ulp * (1.0 + Norm(j)) * SizeOf(pair.Target));
      const auto& weights = samples[static_cast<std::size_t>(i)].Weights;
      if (*std::min_element(weights.begin(), weights.end()) > 1e-3)
      {
        // At edges, rounding decides which triangle gives the limit.
        const Matrix expected = to * (flip * j) * Transposed(from);
        jacobians.Take(
          Distance(MatrixOf(PointArray(output, "Jacobian"), i), expected), 1e-9 * Norm(j));
        jacobians.Take(std::abs(PointArray(output, "JacobianDeterminant")->GetComponent(i, 0) -
                         side * Determinant(j)),
          1e-9 * Norm(j) * Norm(j));
      }
    }
    EXPECT_LE(points.OverBound, 1.0);
    EXPECT_LE(jacobians.OverBound, 1.0);
  }
  EXPECT_GT(turnedOver, 0);
}

TEST_P(FilterInEverySystem, HeightsAreLengths)
{
  // For any sizes of the two meshes, in planes at any height.
  const MeshPair pair = MakePlanarPair(6, 210);
  for (const double factor : { 1000.0, 0.001 })
  {
    const auto target = Moved(pair.Target, [factor](const Point& p) -> Point {
      return { factor * p[0], factor * p[1], 0.0 };
    });
    Random random(13);
    std::vector<Point> positions;
    for (const MeshPoint& surfacePoint : RandomSamples(pair.Source, 2000, 14))
    {
      positions.push_back(PositionOf(pair.Source, surfacePoint));
      positions.back()[2] = random.Uniform(-20.0, 20.0);
    }
    const auto cloud = MakeCloud(positions);
    const auto filter = MakeFilter(GetParam(), { pair.Source, target }, cloud);
    filter->ComputeJacobianOn();
    vtkPointSet* output = Output(filter);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    vtkIdType wrong = 0;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      wrong += PointOf(output, i)[2] != PointOf(cloud, i)[2];
      const Matrix j = MatrixOf(PointArray(output, "Jacobian"), i);
      wrong += j[2] != Point{ 0.0, 0.0, 1.0 } || j[0][2] != 0.0 || j[1][2] != 0.0;
    }
    EXPECT_EQ(wrong, 0);

    const auto lifted = Moved(target, [](const Point& p) -> Point {
      return { p[0], p[1], p[2] - 7.0 };
    });
    const auto lift = MakeFilter(GetParam(), { pair.Source, lifted }, cloud);
    output = Output(lift);
    Worst worst;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      worst.Take(std::abs(PointOf(output, i)[2] - (PointOf(cloud, i)[2] - 7.0)), 1e-14);
    }
    EXPECT_LE(worst.OverBound, 1.0);
  }
}

// --- Kinds of data -------------------------------------------------------------------------------

class KindsOfData : public ::testing::Test
{
protected:
  static constexpr int N = 8;
  const MeshPair Pair = MakePlanarPair(N, 300);

  /// Arrays of several kinds: point data, cell data and field data.
  static void AddArrays(vtkDataSet* data)
  {
    const vtkIdType points = data->GetNumberOfPoints();
    const vtkIdType cells = data->GetNumberOfCells();
    data->GetPointData()->SetScalars(RandomArray("Temperature", 1, points, 20));
    data->GetPointData()->AddArray(RandomArray<vtkIntArray>("Number", 2, points, 21));
    data->GetPointData()->AddArray(RandomArray<vtkFloatArray>("Unmarked", 3, points, 22));
    data->GetCellData()->SetScalars(RandomArray<vtkFloatArray>("Pressure", 1, cells, 23));
    data->GetCellData()->AddArray(RandomArray<vtkIdTypeArray>("Material", 1, cells, 24));
    const auto names = [](const char* name, vtkIdType count) {
      auto array = vtkSmartPointer<vtkStringArray>::New();
      array->SetName(name);
      for (vtkIdType i = 0; i < count; ++i)
      {
        array->InsertNextValue(std::to_string(i));
      }
      return array;
    };
    data->GetPointData()->AddArray(names("PointName", points));
    data->GetCellData()->AddArray(names("CellName", cells));
    data->GetFieldData()->AddArray(names("Remarks", 3));
    data->GetFieldData()->AddArray(RandomArray("Constants", 4, 2, 25));
  }

  static void ExpectArraysPassed(vtkFieldData* input, vtkFieldData* output)
  {
    for (int i = 0; i < input->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* before = input->GetAbstractArray(i);
      vtkAbstractArray* after = output->GetAbstractArray(before->GetName());
      ASSERT_TRUE(after) << before->GetName();
      EXPECT_STREQ(after->GetClassName(), before->GetClassName());
      ASSERT_EQ(after->GetNumberOfValues(), before->GetNumberOfValues()) << before->GetName();
      vtkIdType different = 0;
      for (vtkIdType k = 0; k < before->GetNumberOfValues(); ++k)
      {
        different += before->GetVariantValue(k) != after->GetVariantValue(k);
      }
      EXPECT_EQ(different, 0) << before->GetName();
    }
  }

  /// @a output must equal @a input except for its points, which are those of the mapped point
  /// cloud.
  void ExpectMapped(vtkDataSet* input, vtkDataObject* outputObject)
  {
    auto* output = vtkPointSet::SafeDownCast(outputObject);
    ASSERT_TRUE(output);
    const bool isGrid =
      vtkImageData::SafeDownCast(input) || vtkRectilinearGrid::SafeDownCast(input);
    EXPECT_STREQ(output->GetClassName(), isGrid ? "vtkStructuredGrid" : input->GetClassName());
    std::vector<Point> positions;
    for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
    {
      positions.push_back(PointOf(input, i));
    }
    auto* pointSet = vtkPointSet::SafeDownCast(input);
    const int type =
      pointSet && pointSet->GetPoints() ? pointSet->GetPoints()->GetDataType() : VTK_DOUBLE;
    const auto filter = MakeFilter(Smooth, this->Pair, MakeCloud(positions, type));
    vtkPointSet* expected = Output(filter);
    EXPECT_EQ(CountDifferentPoints(output, expected), 0) << input->GetClassName();
    EXPECT_EQ(CountDifferentValues(
                PointArray(output, "vtkValidPointMask"), PointArray(expected, "vtkValidPointMask")),
      0);

    ASSERT_EQ(output->GetNumberOfCells(), input->GetNumberOfCells());
    vtkNew<vtkIdList> before;
    vtkNew<vtkIdList> after;
    for (vtkIdType i = 0; i < input->GetNumberOfCells(); ++i)
    {
      input->GetCellPoints(i, before);
      output->GetCellPoints(i, after);
      if (isGrid)
      {
        // Voxels and hexahedra number their points differently.
        std::sort(before->begin(), before->end());
        std::sort(after->begin(), after->end());
      }
      ASSERT_TRUE(std::equal(before->begin(), before->end(), after->begin(), after->end()));
    }
    ExpectArraysPassed(input->GetPointData(), output->GetPointData());
    ExpectArraysPassed(input->GetCellData(), output->GetCellData());
    ExpectArraysPassed(input->GetFieldData(), output->GetFieldData());
    for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role)
    {
      for (const bool atPoints : { true, false })
      {
        vtkDataSetAttributes* in = atPoints
          ? static_cast<vtkDataSetAttributes*>(input->GetPointData())
          : input->GetCellData();
        vtkDataSetAttributes* out = atPoints
          ? static_cast<vtkDataSetAttributes*>(output->GetPointData())
          : output->GetCellData();
        vtkAbstractArray* wanted = in->GetAbstractAttribute(role);
        vtkAbstractArray* found = out->GetAbstractAttribute(role);
        EXPECT_EQ(wanted != nullptr, found != nullptr) << role;
        if (wanted && found)
        {
          EXPECT_STREQ(found->GetName(), wanted->GetName());
        }
      }
    }
  }

  /// Inside the domain and slightly beyond.
  vtkSmartPointer<vtkImageData> MakeImage() const
  {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetExtent(-3, 17, 5, 30, 2, 4);
    image->SetOrigin(1.0, -0.25, 0.5);
    image->SetSpacing(0.37, 0.28, 0.125);
    // Rotated in the plane by an angle of the triangle with the sides 3, 4, 5.
    image->SetDirectionMatrix(0.8, 0.6, 0.0, -0.6, 0.8, 0.0, 0.0, 0.0, 1.0);
    AddArrays(image);
    return image;
  }

  vtkSmartPointer<vtkRectilinearGrid> MakeRectilinearGrid() const
  {
    auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
    grid->SetExtent(2, 14, -1, 9, 0, 1);
    const auto coordinates = [](int count, double first, double last) {
      const auto array = vtkSmartPointer<vtkFloatArray>::New();
      for (int i = 0; i < count; ++i)
      {
        const double t = static_cast<double>(i) / (count - 1);
        array->InsertNextValue(static_cast<float>(first + (last - first) * t * t));
      }
      return array;
    };
    grid->SetXCoordinates(coordinates(13, -0.5, 7.5));
    grid->SetYCoordinates(coordinates(11, 0.125, 8.0));
    grid->SetZCoordinates(coordinates(2, 0.0, 1.0));
    AddArrays(grid);
    return grid;
  }

  vtkSmartPointer<vtkStructuredGrid> MakeStructuredGrid() const
  {
    auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
    grid->SetExtent(4, 15, 1, 7, 0, 0);
    vtkNew<vtkPoints> points;
    for (int j = 0; j < 7; ++j)
    {
      for (int i = 0; i < 12; ++i)
      {
        const double radius = 0.5 + 0.5 * j;
        points->InsertNextPoint(
          4.0 + radius * std::cos(0.5 * i), 4.0 + radius * std::sin(0.5 * i), 0.1 * j);
      }
    }
    grid->SetPoints(points);
    AddArrays(grid);
    return grid;
  }

  vtkSmartPointer<vtkUnstructuredGrid> MakeUnstructuredGrid() const
  {
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    const auto samples = RandomSamples(this->Pair.Source, 40, 26);
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const MeshPoint& surfacePoint : samples)
    {
      Point p = PositionOf(this->Pair.Source, surfacePoint);
      p[2] = 0.25 * static_cast<double>(points->GetNumberOfPoints() % 7);
      points->InsertNextPoint(p.data());
    }
    grid->SetPoints(points);
    for (vtkIdType i = 0; i + 8 <= 40; i += 4)
    {
      const vtkIdType ids[8] = { i, i + 1, i + 2, i + 3, i + 4, i + 5, i + 6, i + 7 };
      grid->InsertNextCell(VTK_TETRA, 4, ids);
      grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
      grid->InsertNextCell(VTK_QUADRATIC_TRIANGLE, 6, ids);
      grid->InsertNextCell(VTK_VERTEX, 1, ids);
    }
    AddArrays(grid);
    return grid;
  }

  vtkSmartPointer<vtkPolyData> MakePolyData() const
  {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->ShallowCopy(MakeCloud(this->Pair.Source, RandomSamples(this->Pair.Source, 60, 27)));
    vtkNew<vtkCellArray> verts;
    verts->InsertNextCell({ 0, 1, 2 });
    vtkNew<vtkCellArray> lines;
    lines->InsertNextCell({ 3, 4, 5, 6, 7, 8 });
    vtkNew<vtkCellArray> polygons;
    polygons->InsertNextCell({ 9, 10, 11, 12, 13 });
    polygons->InsertNextCell({ 14, 15, 16 });
    vtkNew<vtkCellArray> strips;
    strips->InsertNextCell({ 17, 18, 19, 20 });
    data->SetVerts(verts);
    data->SetLines(lines);
    data->SetPolys(polygons);
    data->SetStrips(strips);
    AddArrays(data);
    return data;
  }
};

TEST_F(KindsOfData, PolyData)
{
  const auto data = this->MakePolyData();
  const auto filter = MakeFilter(Smooth, this->Pair, data);
  this->ExpectMapped(data, Output(filter));
}

TEST_F(KindsOfData, UnstructuredGrid)
{
  const auto data = this->MakeUnstructuredGrid();
  const auto filter = MakeFilter(Smooth, this->Pair, data);
  this->ExpectMapped(data, Output(filter));
}

TEST_F(KindsOfData, StructuredGrid)
{
  const auto data = this->MakeStructuredGrid();
  const auto filter = MakeFilter(Smooth, this->Pair, data);
  this->ExpectMapped(data, Output(filter));
  auto* output = vtkStructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_TRUE(std::equal(data->GetExtent(), data->GetExtent() + 6, output->GetExtent()));
}

TEST_F(KindsOfData, ImageData)
{
  const auto data = this->MakeImage();
  const auto filter = MakeFilter(Smooth, this->Pair, data);
  this->ExpectMapped(data, Output(filter));
  auto* output = vtkStructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_TRUE(std::equal(data->GetExtent(), data->GetExtent() + 6, output->GetExtent()));
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_GT(filter->GetNumberOfOutsidePoints(), 0);
  EXPECT_LT(filter->GetNumberOfOutsidePoints(), data->GetNumberOfPoints() / 2);
}

TEST_F(KindsOfData, RectilinearGrid)
{
  const auto data = this->MakeRectilinearGrid();
  const auto filter = MakeFilter(Smooth, this->Pair, data);
  this->ExpectMapped(data, Output(filter));
  auto* output = vtkStructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_TRUE(std::equal(data->GetExtent(), data->GetExtent() + 6, output->GetExtent()));
}

TEST_F(KindsOfData, MultiBlockDataSet)
{
  vtkNew<vtkMultiBlockDataSet> inner;
  inner->SetBlock(0, this->MakePolyData());
  inner->SetBlock(1, vtkNew<vtkMultiBlockDataSet>());
  inner->SetBlock(2, this->MakeUnstructuredGrid());
  inner->SetBlock(3, vtkNew<vtkPolyData>());
  vtkNew<vtkMultiBlockDataSet> data;
  data->SetNumberOfBlocks(5);
  data->SetBlock(0, this->MakeImage());
  data->SetBlock(2, inner);
  data->SetBlock(3, this->MakeRectilinearGrid());
  data->GetMetaData(0u)->Set(vtkCompositeDataSet::NAME(), "picture");
  data->GetMetaData(2u)->Set(vtkCompositeDataSet::NAME(), "inner");
  data->GetFieldData()->AddArray(RandomArray("WholeTree", 2, 3, 28));

  const auto filter = MakeFilter(Smooth, this->Pair, data);
  const Messages messages(filter);
  filter->Update();
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  ASSERT_EQ(output->GetNumberOfBlocks(), 5u);
  this->ExpectMapped(this->MakeImage(), output->GetBlock(0));
  EXPECT_FALSE(output->GetBlock(1));
  EXPECT_FALSE(output->GetBlock(4));
  this->ExpectMapped(this->MakeRectilinearGrid(), output->GetBlock(3));
  EXPECT_STREQ(output->GetMetaData(0u)->Get(vtkCompositeDataSet::NAME()), "picture");
  EXPECT_STREQ(output->GetMetaData(2u)->Get(vtkCompositeDataSet::NAME()), "inner");
  auto* outputInner = vtkMultiBlockDataSet::SafeDownCast(output->GetBlock(2));
  ASSERT_TRUE(outputInner);
  ASSERT_EQ(outputInner->GetNumberOfBlocks(), 4u);
  this->ExpectMapped(this->MakePolyData(), outputInner->GetBlock(0));
  EXPECT_TRUE(vtkMultiBlockDataSet::SafeDownCast(outputInner->GetBlock(1)));
  this->ExpectMapped(this->MakeUnstructuredGrid(), outputInner->GetBlock(2));
  auto* empty = vtkPolyData::SafeDownCast(outputInner->GetBlock(3));
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->GetNumberOfPoints(), 0);

  // Outside points of all blocks are counted together.
  vtkIdType outside = 0;
  for (vtkDataObject* block : { output->GetBlock(0), output->GetBlock(3) })
  {
    vtkDataArray* mask = PointArray(vtkDataSet::SafeDownCast(block), "vtkValidPointMask");
    for (vtkIdType i = 0; i < mask->GetNumberOfTuples(); ++i)
    {
      outside += mask->GetComponent(i, 0) == 0.0;
    }
  }
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), outside);
  EXPECT_GT(outside, 0);

  ASSERT_TRUE(output->GetFieldData()->GetArray("WholeTree"));
  ExpectArraysPassed(data->GetFieldData(), output->GetFieldData());

  // The input is not modified; in particular it does not get the arrays of the output.
  EXPECT_FALSE(PointArray(vtkDataSet::SafeDownCast(data->GetBlock(0)), "vtkValidPointMask"));
  EXPECT_TRUE(vtkImageData::SafeDownCast(data->GetBlock(0)));
}

TEST_F(KindsOfData, PartitionedDataSetCollection)
{
  vtkNew<vtkPartitionedDataSet> first;
  first->SetNumberOfPartitions(3);
  first->SetPartition(0, this->MakeImage());
  first->SetPartition(2, this->MakeImage());
  vtkNew<vtkPartitionedDataSet> second;
  second->SetPartition(0, this->MakePolyData());
  vtkNew<vtkPartitionedDataSetCollection> data;
  data->SetPartitionedDataSet(0, first);
  data->SetPartitionedDataSet(1, vtkNew<vtkPartitionedDataSet>());
  data->SetPartitionedDataSet(2, second);
  data->GetMetaData(2u)->Set(vtkCompositeDataSet::NAME(), "second");

  const auto filter = MakeFilter(Smooth, this->Pair, data);
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 3u);
  ASSERT_EQ(output->GetNumberOfPartitions(0), 3u);
  EXPECT_EQ(output->GetNumberOfPartitions(1), 0u);
  ASSERT_EQ(output->GetNumberOfPartitions(2), 1u);
  this->ExpectMapped(this->MakeImage(), output->GetPartition(0, 0));
  EXPECT_FALSE(output->GetPartition(0, 1));
  this->ExpectMapped(this->MakeImage(), output->GetPartition(0, 2));
  this->ExpectMapped(this->MakePolyData(), output->GetPartition(2, 0));
  EXPECT_STREQ(output->GetMetaData(2u)->Get(vtkCompositeDataSet::NAME()), "second");

  // A partitioned data set is also a tree.
  filter->SetDataObject(first);
  filter->Update();
  auto* partitions = vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(partitions);
  this->ExpectMapped(this->MakeImage(), partitions->GetPartition(2));
}

TEST_F(KindsOfData, TypesMayChangeBetweenUpdates)
{
  const auto filter = MakeFilter(Smooth, this->Pair, this->MakeImage());
  for (int round = 0; round < 2; ++round)
  {
    for (const vtkSmartPointer<vtkDataSet>& data :
      std::initializer_list<vtkSmartPointer<vtkDataSet>>{
        this->MakeImage(), this->MakeUnstructuredGrid(), this->MakePolyData() })
    {
      filter->SetDataObject(data);
      this->ExpectMapped(data, Output(filter));
    }
    vtkNew<vtkMultiBlockDataSet> tree;
    tree->SetBlock(0, this->MakeImage());
    filter->SetDataObject(tree);
    filter->Update();
    EXPECT_TRUE(vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0)));
  }
}

TEST_F(KindsOfData, WithoutDataTheMeshIsMapped)
{
  MeshPair pair = this->Pair;
  AddArrays(pair.Source);
  vtkNew<vtkPolyData> target;
  target->ShallowCopy(pair.Target);
  target->GetPointData()->SetScalars(
    RandomArray("OfTheTarget", 1, target->GetNumberOfPoints(), 29));
  pair.Target = target;

  const auto filter = MakeFilter(Smooth, pair);
  this->ExpectMapped(pair.Source, Output(filter));
  EXPECT_EQ(CountDifferentPoints(Output(filter), pair.Target), 0);
  EXPECT_FALSE(PointArray(Output(filter), "OfTheTarget"));

  filter->InverseOn();
  vtkPointSet* output = Output(filter);
  ASSERT_TRUE(vtkPolyData::SafeDownCast(output));
  EXPECT_EQ(CountDifferentPoints(output, pair.Source), 0);
  EXPECT_EQ(CountDifferentCells(output, pair.Target), 0);
  EXPECT_TRUE(PointArray(output, "OfTheTarget"));
  EXPECT_FALSE(PointArray(output, "Temperature"));
}

TEST_F(KindsOfData, PrecisionOfPoints)
{
  std::vector<Point> positions;
  for (const MeshPoint& surfacePoint : RandomSamples(this->Pair.Source, 5000, 30))
  {
    // Points that are equal in both precisions.
    positions.push_back(RoundedToFloat(PositionOf(this->Pair.Source, surfacePoint)));
  }
  struct Case
  {
    int Input;
    int Setting;
    int Output;
  };
  const Case cases[] = { { VTK_DOUBLE, vtkAlgorithm::DOUBLE_PRECISION, VTK_DOUBLE },
    { VTK_DOUBLE, vtkAlgorithm::DEFAULT_PRECISION, VTK_DOUBLE },
    { VTK_DOUBLE, vtkAlgorithm::SINGLE_PRECISION, VTK_FLOAT },
    { VTK_FLOAT, vtkAlgorithm::DEFAULT_PRECISION, VTK_FLOAT },
    { VTK_FLOAT, vtkAlgorithm::SINGLE_PRECISION, VTK_FLOAT },
    { VTK_FLOAT, vtkAlgorithm::DOUBLE_PRECISION, VTK_DOUBLE } };
  const auto reference = MakeFilter(Smooth, this->Pair, MakeCloud(positions));
  vtkPointSet* exact = Output(reference);
  for (const Case& one : cases)
  {
    const auto filter = MakeFilter(Smooth, this->Pair, MakeCloud(positions, one.Input));
    filter->SetOutputPointsPrecision(one.Setting);
    vtkPointSet* output = Output(filter);
    ASSERT_EQ(output->GetPoints()->GetDataType(), one.Output);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    vtkIdType different = 0;
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      Point expected = PointOf(exact, i);
      expected = one.Output == VTK_FLOAT ? RoundedToFloat(expected) : expected;
      // A float point may be outside by its own rounding; it is then moved slightly.
      different += Distance(PointOf(output, i), expected) >
        (one.Input == VTK_FLOAT ? 4e-7 : 0.0) * SizeOf(this->Pair.Target);
    }
    EXPECT_EQ(different, 0) << one.Input << " " << one.Setting;
  }
}

// --- Points outside ------------------------------------------------------------------------------

/// The unsigned char array of ghosts, or null.
vtkUnsignedCharArray* Ghosts(vtkDataSetAttributes* attributes)
{
  return vtkArrayDownCast<vtkUnsignedCharArray>(
    attributes->GetArray(vtkDataSetAttributes::GhostArrayName()));
}

TEST_P(FilterInEverySystem, OutsidePointsAreMarkedAndBlanked)
{
  const MeshPair pair = MakePlanarPair(8, 310);
  vtkNew<vtkImageData> image;
  image->SetDimensions(41, 31, 1);
  image->SetOrigin(-1.0, 0.1, 0.0);
  image->SetSpacing(0.26, 0.3, 1.0);
  image->GetPointData()->SetVectors(RandomArray("Velocity", 3, image->GetNumberOfPoints(), 31));
  image->GetCellData()->SetVectors(RandomArray("Flux", 3, image->GetNumberOfCells(), 32));
  vtkNew<vtkUnsignedCharArray> pointGhosts;
  pointGhosts->SetName(vtkDataSetAttributes::GhostArrayName());
  pointGhosts->SetNumberOfTuples(image->GetNumberOfPoints());
  vtkNew<vtkUnsignedCharArray> cellGhosts;
  cellGhosts->SetName(vtkDataSetAttributes::GhostArrayName());
  cellGhosts->SetNumberOfTuples(image->GetNumberOfCells());

  const auto filter = MakeFilter(GetParam(), pair, image);
  filter->ComputeJacobianOn();
  filter->ComputeJacobianDeterminantOn();
  filter->ComputeTriangleIdOn();
  for (const bool hasGhosts : { false, true })
  {
    if (hasGhosts)
    {
      for (vtkIdType i = 0; i < pointGhosts->GetNumberOfTuples(); ++i)
      {
        pointGhosts->SetValue(i, i % 5 == 0 ? vtkDataSetAttributes::DUPLICATEPOINT : 0);
      }
      for (vtkIdType i = 0; i < cellGhosts->GetNumberOfTuples(); ++i)
      {
        cellGhosts->SetValue(i, i % 7 == 0 ? vtkDataSetAttributes::DUPLICATECELL : 0);
      }
      image->GetPointData()->AddArray(pointGhosts);
      image->GetCellData()->AddArray(cellGhosts);
    }
    auto* output = vtkStructuredGrid::SafeDownCast(Output(filter));
    ASSERT_TRUE(output);
    vtkIdType outside = 0;
    ASSERT_TRUE(Ghosts(output->GetPointData()));
    ASSERT_TRUE(Ghosts(output->GetCellData()));
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      const Point p = PointOf(image, i);
      const bool isOutside = p[0] < 0.0 || p[0] > 8.0 || p[1] < 0.0 || p[1] > 8.0;
      // Ghost points are marked, but not counted.
      outside += isOutside && !(hasGhosts && i % 5 == 0);
      ASSERT_EQ(PointArray(output, "vtkValidPointMask")->GetComponent(i, 0), isOutside ? 0 : 1);
      ASSERT_EQ(PointArray(output, "TriangleId")->GetComponent(i, 0) < 0, isOutside);
      ASSERT_EQ(
        std::isnan(PointArray(output, "JacobianDeterminant")->GetComponent(i, 0)), isOutside);
      for (int k = 0; k < 9; ++k)
      {
        ASSERT_EQ(std::isnan(PointArray(output, "Jacobian")->GetComponent(i, k)), isOutside);
      }
      for (int k = 0; k < 3; ++k)
      {
        ASSERT_EQ(std::isnan(PointArray(output, "Velocity")->GetComponent(i, k)), isOutside);
      }
      if (isOutside)
      {
        ASSERT_EQ(PointOf(output, i), p);
      }
      const int before = hasGhosts && i % 5 == 0 ? vtkDataSetAttributes::DUPLICATEPOINT : 0;
      ASSERT_EQ(Ghosts(output->GetPointData())->GetValue(i),
        before | (isOutside ? vtkDataSetAttributes::HIDDENPOINT : 0));
      ASSERT_EQ(output->IsPointVisible(i) != 0, !isOutside);
    }
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), outside);
    EXPECT_GT(outside, 100);
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell)
    {
      image->GetCellPoints(cell, ids);
      const bool isOutside = std::any_of(ids->begin(), ids->end(), [&](vtkIdType i) {
        return PointArray(output, "vtkValidPointMask")->GetComponent(i, 0) == 0.0;
      });
      const int before = hasGhosts && cell % 7 == 0 ? vtkDataSetAttributes::DUPLICATECELL : 0;
      ASSERT_EQ(Ghosts(output->GetCellData())->GetValue(cell),
        before | (isOutside ? vtkDataSetAttributes::HIDDENCELL : 0));
      ASSERT_EQ(output->IsCellVisible(cell) != 0, !isOutside);
    }
    // The input's arrays are not modified.
    EXPECT_EQ(Ghosts(image->GetPointData()) != nullptr, hasGhosts);
    for (vtkIdType i = 0; hasGhosts && i < pointGhosts->GetNumberOfTuples(); ++i)
    {
      ASSERT_EQ(pointGhosts->GetValue(i), i % 5 == 0 ? vtkDataSetAttributes::DUPLICATEPOINT : 0);
    }
  }

  filter->BlankOutsideOff();
  vtkPointSet* output = Output(filter);
  EXPECT_EQ(CountDifferentValues(Ghosts(output->GetPointData()), pointGhosts), 0);
  EXPECT_EQ(CountDifferentValues(Ghosts(output->GetCellData()), cellGhosts), 0);
  EXPECT_GT(filter->GetNumberOfOutsidePoints(), 100);
  image->GetPointData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  image->GetCellData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  output = Output(filter);
  EXPECT_FALSE(Ghosts(output->GetPointData()));
  EXPECT_FALSE(Ghosts(output->GetCellData()));
}

TEST(HomeomorphismFilter, NoGhostsIfAllPointsAreInside)
{
  const MeshPair pair = MakePlanarPair(4, 315);
  const auto filter = MakeFilter(Smooth, pair);
  vtkPointSet* output = Output(filter);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
  EXPECT_FALSE(Ghosts(output->GetPointData()));
  EXPECT_FALSE(Ghosts(output->GetCellData()));
}

TEST_P(FilterInEverySystem, ToleranceMapsPointsLikeTheNearestPointOfTheDomain)
{
  const MeshPair pair = MakePlanarPair(8, 316);
  // The image of the boundary point below, at three distances from it.
  const double diagonal = SizeOf(pair.Source);
  const auto cloud = MakeCloud(
    { { 3.3, 0.0, 0.0 }, { 3.3, -0.009 * diagonal, 0.0 }, { 3.3, -0.011 * diagonal, 0.0 } });
  const auto filter = MakeFilter(GetParam(), pair, cloud);
  Output(filter);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 2);
  filter->SetTolerance(0.01);
  vtkPointSet* output = Output(filter);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 1);
  EXPECT_LE(Distance(PointOf(output, 0), PointOf(output, 1)), 1e-14 * diagonal);
  EXPECT_EQ(PointArray(output, "vtkValidPointMask")->GetComponent(2, 0), 0.0);
  filter->SetTolerance(-1.0);
  EXPECT_EQ(filter->GetTolerance(), 0.0);
}

TEST_P(FilterInEverySystem, PointsOffASurfaceAreOutside)
{
  for (const Pairing& pairing :
    { Pairing{ "sheet", { MakeSheet(6, 317, 0.5), MakeSheet(6, 318, 0.8) } },
      Pairing{ "plane", { MakePlanarPair(6, 317).Source, MakeSheet(6, 318, 0.8) } } })
  {
    const MeshPair& pair = pairing.Meshes;
    const double size = SizeOf(pair.Source);
    std::vector<Point> positions;
    const std::vector<MeshPoint> samples = InnerSamples(pair.Source, 300, 33, 0.2);
    for (const MeshPoint& surfacePoint : samples)
    {
      const std::array<Point, 3> c = CornersOf(pair.Source, surfacePoint.Triangle);
      const Point normal = Unit(Cross(c[1] - c[0], c[2] - c[0]));
      positions.push_back(PositionOf(pair.Source, surfacePoint) + 1e-4 * size * normal);
    }
    const auto cloud = MakeCloud(positions);
    const auto filter = MakeFilter(GetParam(), pair, cloud);
    vtkPointSet* output = Output(filter);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 300) << pairing.Name;
    EXPECT_EQ(CountDifferentPoints(output, cloud), 0) << pairing.Name;
    // With a tolerance they map to the images of the nearest points of the surface.
    filter->SetTolerance(1.5e-4);
    output = Output(filter);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0) << pairing.Name;
    const auto feet = MakeFilter(GetParam(), pair, MakeCloud(pair.Source, samples));
    vtkPointSet* expected = Output(feet);
    Worst worst;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      const auto id = static_cast<vtkIdType>(i);
      const std::array<Point, 3> c = CornersOf(pair.Target, samples[i].Triangle);
      const Point normal = Unit(Cross(c[1] - c[0], c[2] - c[0]));
      worst.Take(std::abs(Dot(normal, PointOf(output, id) - c[0])), 1e-15 * size);
      worst.Take(Distance(PointOf(output, id), PointOf(expected, id)), 1e-13 * size);
    }
    EXPECT_LE(worst.OverBound, 1.0) << pairing.Name;
  }
}

TEST(HomeomorphismFilter, NonFinitePointsAreOutside)
{
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = vtkMath::Nan();
  const auto cloud = MakeCloud({ { nan, 1.0, 0.0 }, { 1.0, nan, 0.0 }, { 1.0, 1.0, nan },
    { infinity, 1.0, 0.0 }, { 1.0, -infinity, 0.0 }, { 1e300, 1e300, 0.0 }, { 1.0, 1.0, 0.0 } });
  for (const Pairing& pairing : AllPairings(4, 1, 319))
  {
    const auto filter = MakeFilter(Smooth, pairing.Meshes, cloud);
    filter->SetTolerance(0.5);
    vtkPointSet* output = Output(filter);
    for (vtkIdType i = 0; i < 6; ++i)
    {
      EXPECT_EQ(PointArray(output, "vtkValidPointMask")->GetComponent(i, 0), 0.0) << pairing.Name;
    }
    EXPECT_EQ(CountDifferentPoints(output, cloud), 7 - filter->GetNumberOfOutsidePoints());
  }
}

// --- Arrays --------------------------------------------------------------------------------------

TEST_P(FilterInEverySystem, TriangleIdIsTheCellIdInTheSource)
{
  for (const Pairing& pairing : AllPairings(8, 2, 320))
  {
    MeshPair pair = pairing.Meshes;
    // Vertices before the polygons shift the cell ids.
    for (auto* mesh : { &pair.Source, &pair.Target })
    {
      vtkNew<vtkCellArray> verts;
      verts->InsertNextCell({ 0 });
      verts->InsertNextCell({ 1, 2 });
      (*mesh)->SetVerts(verts);
    }
    Random random(34);
    std::vector<MeshPoint> samples;
    for (int i = 0; i < 3000; ++i)
    {
      samples.push_back(
        { 2 + random.Below(pair.Source->GetNumberOfCells() - 2), RandomWeights(random, 1e-6) });
    }
    for (const bool inverse : { false, true })
    {
      const auto filter =
        MakeFilter(GetParam(), pair, MakeCloud(inverse ? pair.Target : pair.Source, samples));
      filter->SetInverse(inverse);
      filter->ComputeTriangleIdOn();
      vtkPointSet* output = Output(filter);
      vtkDataArray* ids = PointArray(output, "TriangleId");
      ASSERT_TRUE(vtkIdTypeArray::SafeDownCast(ids));
      vtkIdType wrong = 0;
      for (std::size_t i = 0; i < samples.size(); ++i)
      {
        wrong += ids->GetComponent(static_cast<vtkIdType>(i), 0) !=
          static_cast<double>(samples[i].Triangle);
      }
      EXPECT_EQ(wrong, 0) << pairing.Name << inverse;
    }
  }
}

/// Points whose surrounding stencil has the same triangle and the same e throughout, so that no
/// crease of the Linear and Contour systems separates its points.
std::vector<bool> HaveNoCrease(
  const System& system, const MeshPair& pair, vtkPolyData* stencils, vtkIdType pointsOfStencil)
{
  vtkNew<vtkTriangularCoordinates> coordinates;
  SetSystem(coordinates.Get(), system);
  coordinates->SetInputData(0, pair.Source);
  coordinates->SetDataObject(stencils);
  coordinates->GenerateLinesOff();
  coordinates->Update();
  auto* output = vtkPointSet::SafeDownCast(coordinates->GetOutputDataObject(0));
  vtkDataArray* triangle = PointArray(output, "TriangleId");
  vtkDataArray* edge = PointArray(output, "EdgeLabel");
  std::vector<bool> smooth;
  for (vtkIdType i = 0; i < stencils->GetNumberOfPoints(); i += pointsOfStencil)
  {
    bool same = true;
    for (vtkIdType k = i; k < i + pointsOfStencil; ++k)
    {
      same = same && triangle->GetComponent(k, 0) == triangle->GetComponent(i, 0) &&
        edge->GetComponent(k, 0) == edge->GetComponent(i, 0);
    }
    smooth.push_back(same);
  }
  return smooth;
}

TEST_P(FilterInEverySystem, JacobianIsTheDerivative)
{
  for (const Pairing& pairing : AllPairings(8, 2, 330))
  {
    const MeshPair& pair = pairing.Meshes;
    const std::vector<MeshPoint> samples = InnerSamples(pair.Source, 4000, 35, 1e-3);
    const auto filter = MakeFilter(GetParam(), pair, MakeCloud(pair.Source, samples));
    filter->ComputeJacobianOn();
    filter->ComputeJacobianDeterminantOn();
    vtkPointSet* output = Output(filter);
    vtkDataArray* jacobian = PointArray(output, "Jacobian");
    vtkDataArray* determinant = PointArray(output, "JacobianDeterminant");
    ASSERT_EQ(jacobian->GetDataType(), VTK_DOUBLE);
    ASSERT_EQ(jacobian->GetNumberOfComponents(), 9);
    ASSERT_EQ(determinant->GetDataType(), VTK_DOUBLE);

    // Steps along two edges of the triangle stay in its plane.
    constexpr double h = 2e-5;
    const double steps[] = { -2.0, -1.0, 1.0, 2.0 };
    std::vector<MeshPoint> stencils;
    for (const MeshPoint& surfacePoint : samples)
    {
      for (const std::size_t direction : { 1u, 2u })
      {
        for (const double step : steps)
        {
          MeshPoint moved = surfacePoint;
          moved.Weights[direction] += step * h;
          moved.Weights[0] -= step * h;
          stencils.push_back(moved);
        }
      }
    }
    const auto stencilCloud = MakeCloud(pair.Source, stencils);
    const std::vector<bool> hasNoCrease = HaveNoCrease(GetParam(), pair, stencilCloud, 8);
    const auto stencilFilter = MakeFilter(GetParam(), pair, stencilCloud);
    vtkPointSet* images = Output(stencilFilter);
    std::vector<double> errors;
    Worst worst;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      const auto id = static_cast<vtkIdType>(i);
      const Matrix j = MatrixOf(jacobian, id);
      const std::array<Point, 3> from = CornersOf(pair.Source, samples[i].Triangle);
      const std::array<Point, 3> to = CornersOf(pair.Target, samples[i].Triangle);
      // The Jacobian maps normal to normal. The normals of these planes follow from the winding.
      const Point normal = Unit(Cross(from[1] - from[0], from[2] - from[0]));
      const Point image = Unit(Cross(to[1] - to[0], to[2] - to[0]));
      worst.Take(Distance(j * normal, image), 1e-11);
      worst.Take(std::abs(determinant->GetComponent(id, 0) - Determinant(j)),
        1e-11 * (1.0 + std::abs(Determinant(j))) * Norm(j));
      if (!hasNoCrease[i])
      {
        continue;
      }
      for (int direction = 0; direction < 2; ++direction)
      {
        const vtkIdType first = 8 * id + 4 * direction;
        const Point difference = (1.0 / (12.0 * h)) *
          (8.0 * (PointOf(images, first + 2) - PointOf(images, first + 1)) -
            (PointOf(images, first + 3) - PointOf(images, first)));
        const Point expected = j * (from[direction + 1] - from[0]);
        errors.push_back(Distance(difference, expected) / Norm(to[direction + 1] - to[0]));
      }
    }
    EXPECT_LE(worst.OverBound, 1.0) << pairing.Name;
    ASSERT_GT(errors.size(), samples.size());
    // Second derivatives jump at wing segments, third ones at the borders of strips, and the
    // Contour system is homogeneous around the centroid. The error of the few stencils there grows
    // with the ratio of their width to that distance.
    std::sort(errors.begin(), errors.end());
    const double nearlyAll = errors[errors.size() * 99 / 100];
    std::cout << GetParam().Name << ", " << pairing.Name << ": Jacobian against differences, 99 % "
              << nearlyAll << ", all " << errors.back() << ", " << errors.size()
              << " differences\n";
    EXPECT_LT(nearlyAll, 1e-8) << pairing.Name;
    EXPECT_LT(errors.back(), 0.02) << pairing.Name;
  }
}

TEST_P(FilterInEverySystem, JacobianDeterminantIsTheRatioOfAreas)
{
  const MeshPair planar = MakePlanarPair(6, 340);
  const MeshPair mirrored{ planar.Source, Moved(planar.Target, [](const Point& p) -> Point {
                            return { p[0], 8.0 - p[1], p[2] };
                          }) };
  for (const MeshPair& pair : { planar, mirrored, MakeClosedPair(1, 341) })
  {
    const bool isPlanar = pair.Source == planar.Source;
    constexpr double h = 1e-6;
    std::vector<MeshPoint> corners;
    const std::vector<MeshPoint> samples = InnerSamples(pair.Source, 2000, 36, 1e-3);
    for (const MeshPoint& surfacePoint : samples)
    {
      corners.push_back(surfacePoint);
      for (const std::size_t direction : { 1u, 2u })
      {
        MeshPoint moved = surfacePoint;
        moved.Weights[direction] += h;
        moved.Weights[0] -= h;
        corners.push_back(moved);
      }
    }
    const auto cloud = MakeCloud(pair.Source, corners);
    const auto filter = MakeFilter(GetParam(), pair, cloud);
    filter->ComputeJacobianDeterminantOn();
    vtkPointSet* output = Output(filter);
    const std::vector<bool> hasNoCrease = HaveNoCrease(GetParam(), pair, cloud, 3);
    Worst worst;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      if (!hasNoCrease[i])
      {
        continue;
      }
      const auto id = 3 * static_cast<vtkIdType>(i);
      const auto area = [id](vtkDataSet* data) {
        return Cross(
          PointOf(data, id + 1) - PointOf(data, id), PointOf(data, id + 2) - PointOf(data, id));
      };
      const double ratio =
        isPlanar ? area(output)[2] / area(cloud)[2] : Norm(area(output)) / Norm(area(cloud));
      const double determinant = PointArray(output, "JacobianDeterminant")->GetComponent(id, 0);
      worst.Take(std::abs(ratio / determinant - 1.0), 1e-3);
    }
    EXPECT_LE(worst.OverBound, 1.0);
  }
}

TEST_P(FilterInEverySystem, UsedCoordinateSystemMarksTrianglesMappedByLinear)
{
  // Discordant triangles in the source alone, in the target alone, and none.
  const MeshPair planar = MakePlanarPair(8, 343);
  const auto sheared = Sheared(planar.Source);
  const bool standsIn =
    GetParam().IsContour() && GetParam().CenterPoint == vtkDifferentiableHomeomorphism::CENTROID;
  const MeshPair concordant = ConcordantPair(344);
  for (const MeshPair& pair :
    { MeshPair{ sheared, planar.Target }, MeshPair{ planar.Target, sheared }, concordant })
  {
    const auto cloud = MakeCloud(pair.Source, InnerSamples(pair.Source, 2000, 45, 1e-3));
    cloud->GetPoints()->InsertNextPoint(-1000.0, 0.0, 0.0);
    const auto filter = MakeFilter(GetParam(), pair, cloud);
    filter->ComputeTriangleIdOn();
    vtkPointSet* output = Output(filter);
    vtkDataArray* used = PointArray(output, "UsedCoordinateSystem");
    if (!standsIn || pair.Source == concordant.Source)
    {
      EXPECT_FALSE(used);
      EXPECT_EQ(filter->GetNumberOfDiscordantTriangles(), 0);
      continue;
    }
    std::set<vtkIdType> discordant;
    for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
    {
      for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
      {
        const std::array<Point, 3> c = CornersOf(mesh, t);
        for (std::size_t k = 0; k < 6; ++k)
        {
          // Concordance, for each ordered pair of corners A, B and the third C.
          const Point& a = c[k % 3];
          const Point& b = c[(k + 1 + k / 3) % 3];
          const Point& third = c[(k + 2 - k / 3) % 3];
          if (Dot(b - a, (b - a) + (third - a)) <= 0.0)
          {
            discordant.insert(t);
          }
        }
      }
    }
    EXPECT_EQ(filter->GetNumberOfDiscordantTriangles(), static_cast<vtkIdType>(discordant.size()));
    EXPECT_GT(discordant.size(), 20u);
    ASSERT_TRUE(vtkIntArray::SafeDownCast(used));
    vtkIdType wrong = 0;
    for (vtkIdType i = 0; i < 2000; ++i)
    {
      const auto t = static_cast<vtkIdType>(PointArray(output, "TriangleId")->GetComponent(i, 0));
      wrong += used->GetComponent(i, 0) !=
        (discordant.count(t) ? vtkDifferentiableHomeomorphism::LINEAR
                             : vtkDifferentiableHomeomorphism::CONTOUR);
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(used->GetComponent(2000, 0), -1.0);
  }
}

TEST(HomeomorphismFilter, ArraysOfTheSameNameAreReplaced)
{
  const MeshPair pair = MakePlanarPair(4, 345);
  vtkNew<vtkPolyData> data;
  data->ShallowCopy(pair.Source);
  const vtkIdType count = data->GetNumberOfPoints();
  for (const char* name : { "vtkValidPointMask", "TriangleId", "Jacobian", "JacobianDeterminant" })
  {
    data->GetPointData()->AddArray(RandomArray<vtkIntArray>(name, 2, count, 37));
  }
  const auto filter = MakeFilter(Smooth, pair, data);
  vtkPointSet* output = Output(filter);
  EXPECT_EQ(PointArray(output, "vtkValidPointMask")->GetNumberOfComponents(), 1);
  EXPECT_EQ(PointArray(output, "vtkValidPointMask")->GetDataType(), VTK_UNSIGNED_CHAR);
  // Only added arrays replace others.
  EXPECT_EQ(PointArray(output, "Jacobian")->GetNumberOfComponents(), 2);
  filter->ComputeJacobianOn();
  filter->ComputeJacobianDeterminantOn();
  filter->ComputeTriangleIdOn();
  output = Output(filter);
  EXPECT_EQ(output->GetPointData()->GetNumberOfArrays(), 4);
  EXPECT_EQ(PointArray(output, "Jacobian")->GetNumberOfComponents(), 9);
  EXPECT_EQ(PointArray(output, "JacobianDeterminant")->GetNumberOfComponents(), 1);
  EXPECT_EQ(PointArray(output, "TriangleId")->GetNumberOfComponents(), 1);
  EXPECT_EQ(data->GetPointData()->GetArray("Jacobian")->GetNumberOfComponents(), 2);
}

// --- Caching -------------------------------------------------------------------------------------

/// Counts executions.
class ExecutionCount
{
public:
  explicit ExecutionCount(vtkAlgorithm* algorithm)
  {
    algorithm->AddObserver(vtkCommand::StartEvent, this, &ExecutionCount::Increment);
  }
  int Get() const { return this->Count; }

private:
  void Increment() { ++this->Count; }
  int Count = 0;
};

TEST(HomeomorphismFilter, MeshesAreReadOnlyWhenTheyChange)
{
  const MeshPair pair = MakePlanarPair(6, 350);
  const auto samples = RandomSamples(pair.Source, 100, 38);
  const auto filter = MakeFilter(Smooth, pair, MakeCloud(pair.Source, samples));
  ExecutionCount executions(filter);
  EXPECT_EQ(filter->GetNumberOfMeshBuilds(), 0);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfMeshBuilds(), 1);
  filter->Update();
  EXPECT_EQ(executions.Get(), 1);

  // Other data and other outputs of the same map.
  filter->SetDataObject(MakeCloud(pair.Source, RandomSamples(pair.Source, 200, 39)));
  filter->Update();
  filter->InverseOn();
  filter->Update();
  filter->InverseOff();
  filter->ComputeJacobianOn();
  filter->SetTolerance(0.1);
  filter->Update();
  // Attributes of the meshes do not matter.
  pair.Source->GetPointData()->SetScalars(
    RandomArray("Temperature", 1, pair.Source->GetNumberOfPoints(), 40));
  filter->Update();
  EXPECT_EQ(executions.Get(), 5);
  EXPECT_EQ(filter->GetNumberOfMeshBuilds(), 1);
  // Another data object with the same points and cells.
  vtkNew<vtkPolyData> sameMesh;
  sameMesh->ShallowCopy(pair.Source);
  filter->SetSourceData(sameMesh);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfMeshBuilds(), 1);

  const auto data = MakeCloud(sameMesh, samples);
  filter->SetDataObject(data);
  pair.Target->GetPoints()->SetPoint(24, 3.1, 3.2, 0.0);
  pair.Target->GetPoints()->Modified();
  pair.Target->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfMeshBuilds(), 2);
  const auto fresh = MakeFilter(Smooth, { sameMesh, pair.Target }, data);
  EXPECT_EQ(CountDifferentPoints(Output(filter), Output(fresh)), 0);

  filter->SetTargetData(MakePlanarPair(6, 352).Target);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfMeshBuilds(), 3);
  filter->SetCoordinateSystemToLinear();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfMeshBuilds(), 4);
}

TEST(HomeomorphismFilter, MovedPointsOfAMeshAreUsed)
{
  const MeshPair pair = MakePlanarPair(6, 353);
  const auto data = MakeCloud(pair.Source, RandomSamples(pair.Source, 500, 41));
  const auto filter = MakeFilter(Smooth, pair, data);
  filter->Update();
  vtkNew<vtkPolyData> before;
  before->DeepCopy(Output(filter));
  // Only the points are marked as modified, as after vtkPoints::SetPoint.
  Point moved = PointOf(pair.Target, 24);
  moved[0] += 0.1;
  pair.Target->GetPoints()->SetPoint(24, moved.data());
  pair.Target->GetPoints()->Modified();
  const auto fresh = MakeFilter(Smooth, pair, data);
  EXPECT_EQ(CountDifferentPoints(Output(filter), Output(fresh)), 0);
  EXPECT_GT(CountDifferentPoints(Output(filter), before), 10);
}

TEST(HomeomorphismFilter, UpdatingTwiceIsStable)
{
  const MeshPair pair = MakeClosedPair(2, 355);
  const auto data = MakeCloud(pair.Source, RandomSamples(pair.Source, 500, 42));
  data->GetPointData()->SetVectors(RandomArray("Velocity", 3, 500, 43));
  const auto filter = MakeFilter(Smooth, pair, data);
  filter->ComputeJacobianOn();
  vtkNew<vtkPolyData> first;
  first->DeepCopy(Output(filter));
  for (const bool modified : { false, true })
  {
    if (modified)
    {
      filter->Modified();
    }
    vtkPointSet* again = Output(filter);
    EXPECT_EQ(CountDifferentPoints(first, again), 0);
    EXPECT_EQ(
      first->GetPointData()->GetNumberOfArrays(), again->GetPointData()->GetNumberOfArrays());
    for (const char* name : { "Velocity", "Jacobian", "vtkValidPointMask" })
    {
      EXPECT_EQ(CountDifferentValues(PointArray(first, name), PointArray(again, name)), 0);
    }
  }
}

TEST(HomeomorphismFilter, ChangingAPropertyExecutesAgain)
{
  const MeshPair pair = MakePlanarPair(6, 356, 0.05);
  const auto filter =
    MakeFilter(Smooth, pair, MakeCloud(pair.Source, RandomSamples(pair.Source, 50, 44)));
  using Filter = vtkDifferentiableHomeomorphism;
  const std::vector<std::function<void(Filter*)>> changes{ [](Filter* f) {
                                                            f->SetCoordinateSystemToLinear();
                                                          },
    [](Filter* f) { f->SetCoordinateSystemToContour(); },
    [](Filter* f) { f->SetCenterPoint(Filter::INCENTER); },
    [](Filter* f) { f->SetDiscordantTriangles(Filter::USE_LINEAR); },
    [](Filter* f) { f->SetCoordinateSystemToSmooth(); },
    [](Filter* f) { f->MaskInvalidTrianglesOn(); }, [](Filter* f) { f->SetTolerance(0.125); },
    [](Filter* f) { f->ComputeTriangleIdOn(); }, [](Filter* f) { f->ComputeJacobianOn(); },
    [](Filter* f) { f->ComputeJacobianDeterminantOn(); },
    [](Filter* f) { f->TransformActiveAttributesOff(); },
    [](Filter* f) { f->TransformAllInputVectorsOn(); },
    [](Filter* f) { f->SetAttributeTransformation("Any", Filter::GRADIENT_TRANSFORMATION); },
    [](Filter* f) { f->ClearAttributeTransformations(); }, [](Filter* f) { f->BlankOutsideOff(); },
    [](Filter* f) { f->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION); },
    [](Filter* f) { f->InverseOn(); } };
  filter->SetDiscordantTriangles(Filter::REFUSE);
  ExecutionCount executions(filter);
  filter->Update();
  int expected = 1;
  EXPECT_EQ(executions.Get(), expected);
  for (const auto& change : changes)
  {
    change(filter);
    filter->Update();
    EXPECT_EQ(executions.Get(), ++expected);
    // Setting an equal value changes nothing.
    filter->Update();
    EXPECT_EQ(executions.Get(), expected);
  }
}

TEST(HomeomorphismFilter, PropertiesAreClampedAndPrinted)
{
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  EXPECT_EQ(filter->GetCoordinateSystem(), vtkDifferentiableHomeomorphism::SMOOTH);
  filter->SetCoordinateSystem(-3);
  EXPECT_EQ(filter->GetCoordinateSystem(), vtkDifferentiableHomeomorphism::LINEAR);
  filter->SetCoordinateSystem(17);
  EXPECT_EQ(filter->GetCoordinateSystem(), vtkDifferentiableHomeomorphism::CUBIC);
  filter->SetAttributeTransformation(
    "Force", vtkDifferentiableHomeomorphism::NORMAL_TRANSFORMATION);
  std::ostringstream text;
  filter->Print(text);
  for (const char* word :
    { "CoordinateSystem: 3", "Inverse: 0", "CenterPoint: 0", "DiscordantTriangles: 0",
      "MaskInvalidTriangles: 0", "Tolerance: 0", "ComputeTriangleId: 0", "ComputeJacobian: 0",
      "ComputeJacobianDeterminant: 0", "TransformActiveAttributes: 1",
      "TransformAllInputVectors: 0", "AttributeTransformation of Force: 3", "BlankOutside: 1",
      "OutputPointsPrecision: 2", "NumberOfOutsidePoints: 0" })
  {
    EXPECT_NE(text.str().find(word), std::string::npos) << word;
  }
}

// --- Empty inputs --------------------------------------------------------------------------------

TEST_P(FilterInEverySystem, EmptyInputsGiveEmptyOutputsWithoutErrors)
{
  const vtkNew<vtkPolyData> nothing;
  const vtkNew<vtkPolyData> noCells;
  noCells->SetPoints(vtkNew<vtkPoints>());
  const MeshPair pair = MakePlanarPair(3, 360);
  const auto run = [&](vtkPolyData* source, vtkPolyData* target, vtkDataObject* data) {
    vtkNew<vtkDifferentiableHomeomorphism> filter;
    Messages messages(filter);
    filter->SetCoordinateSystem(GetParam().CoordinateSystem);
    filter->SetCenterPoint(GetParam().CenterPoint);
    filter->SetDiscordantTriangles(vtkDifferentiableHomeomorphism::REFUSE);
    filter->SetSourceData(source);
    filter->SetTargetData(target);
    filter->SetDataObject(data);
    filter->ComputeJacobianOn();
    filter->ComputeJacobianDeterminantOn();
    filter->ComputeTriangleIdOn();
    filter->Update();
    EXPECT_FALSE(messages.HasError()) << messages.Error();
    EXPECT_FALSE(messages.HasWarning()) << messages.Warning();
    vtkSmartPointer<vtkDataObject> output = filter->GetOutputDataObject(0);
    return output;
  };
  const MeshPair concordant = MakePlanarPair(3, 360, 0.05);
  for (vtkPolyData* empty : { nothing.Get(), noCells.Get() })
  {
    EXPECT_EQ(run(empty, empty, nullptr)->GetNumberOfElements(vtkDataObject::POINT), 0);
    EXPECT_EQ(
      run(concordant.Source, concordant.Target, empty)->GetNumberOfElements(vtkDataObject::POINT),
      0);
    // All points are outside an empty domain.
    const auto output = run(empty, empty, pair.Source);
    auto* points = vtkPointSet::SafeDownCast(output);
    ASSERT_TRUE(points);
    EXPECT_EQ(CountDifferentPoints(points, pair.Source), 0);
    EXPECT_EQ(PointArray(points, "vtkValidPointMask")->GetRange()[1], 0.0);
    EXPECT_EQ(PointArray(points, "TriangleId")->GetRange()[1], -1.0);
  }
  for (const vtkSmartPointer<vtkDataObject>& data :
    std::initializer_list<vtkSmartPointer<vtkDataObject>>{ vtkSmartPointer<vtkImageData>::New(),
      vtkSmartPointer<vtkRectilinearGrid>::New(), vtkSmartPointer<vtkStructuredGrid>::New(),
      vtkSmartPointer<vtkUnstructuredGrid>::New(), vtkSmartPointer<vtkMultiBlockDataSet>::New(),
      vtkSmartPointer<vtkPartitionedDataSetCollection>::New() })
  {
    const auto output = run(concordant.Source, concordant.Target, data);
    ASSERT_TRUE(output) << data->GetClassName();
    EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::POINT), 0) << data->GetClassName();
  }
}

} // namespace
