// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkDifferentiableHomeomorphism: the properties of the map in every coordinate system, and the
// arrays of the output.

#include "Fixtures/FilterRuns.h"

namespace
{

using namespace fixtures;

using FilterInEverySystem = TestInEverySystem;

INSTANTIATE_TEST_SUITE_P(All, FilterInEverySystem, ::testing::ValuesIn(AllSystems()), NameOfSystem);

TEST_P(FilterInEverySystem, RoundTrip)
{
  for (const auto& [kind, pair] : AllPairings(20, 3, 100))
  {
    SCOPED_TRACE(kind);
    const auto cloud = MakeCloud(pair.Source, RandomSamples(pair.Source, 8000, 1));
    const auto forward = MakeFilter(GetParam(), pair, cloud);
    const auto backward = MakeFilter(GetParam(), pair);
    backward->SetDataConnection(forward->GetOutputPort());
    backward->InverseOn();
    forward->ComputeJacobianOn();
    backward->ComputeJacobianOn();
    vtkPointSet* back = Output(backward);
    EXPECT_EQ(forward->GetNumberOfOutsidePoints(), 0);
    EXPECT_EQ(backward->GetNumberOfOutsidePoints(), 0);
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      // The image is rounded to an ulp of the target's coordinates, and the inverse magnifies this
      // by |J^-1|, to more than 1e-14 where the map contracts strongly. At an edge the derivatives
      // of both triangles count, because rounding may move the image to the other side.
      const double stretch =
        std::max(Norm(Inverted(JacobianOf(Output(forward), i))), Norm(JacobianOf(back, i)));
      ASSERT_LE(Distance(PointOf(back, i), PointOf(cloud, i)),
        std::max(1e-14 * pair.Source->GetLength(), stretch * Ulp * LargestCoordinate(pair.Target)));
    }
  }
}

TEST_P(FilterInEverySystem, InverseIsTheMapOfExchangedMeshes)
{
  for (const auto& [kind, pair] : AllPairings(8, 2, 110))
  {
    SCOPED_TRACE(kind);
    const auto cloud = MakeCloud(pair.Target, RandomSamples(pair.Target, 5000, 2));
    const auto inverse = MakeFilter(GetParam(), pair, cloud);
    inverse->InverseOn();
    const auto exchanged = MakeFilter(GetParam(), { pair.Target, pair.Source }, cloud);
    ComputeEverything(inverse);
    ComputeEverything(exchanged);
    vtkPointSet* a = Output(inverse);
    vtkPointSet* b = Output(exchanged);
    ExpectSame(a, b, { "vtkValidPointMask", "TriangleId", "Jacobian", "JacobianDeterminant" });
    EXPECT_GT(CountDifferentPoints(a, cloud), 4000);
  }
}

/// The mesh with its points stored as floats.
vtkSmartPointer<vtkPolyData> InFloat(vtkPolyData* mesh)
{
  const auto narrow = CopyOf(mesh);
  narrow->SetPoints(MakeCloud(PointsOf(mesh), VTK_FLOAT)->GetPoints());
  return narrow;
}

TEST_P(FilterInEverySystem, VerticesMapToVerticesAndEdgesLinearly)
{
  for (const auto& [kind, pair] : AllPairings(10, 2, 150))
  {
    SCOPED_TRACE(kind);
    // Points stored as floats lie off a tilted plane by rounding errors of their own.
    for (const MeshPair& one : { pair, MeshPair{ InFloat(pair.Source), InFloat(pair.Target) } })
    {
      const auto filter = MakeFilter(GetParam(), one);
      EXPECT_EQ(CountDifferentPoints(Output(filter), one.Target), 0);
      EXPECT_EQ(CountDifferentCells(Output(filter), one.Target), 0);
      filter->InverseOn();
      EXPECT_EQ(CountDifferentPoints(Output(filter), one.Source), 0);
      EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    }
    Random random(5);
    std::vector<MeshPoint> samples;
    for (vtkIdType i = 0; i < 24 * pair.Source->GetNumberOfCells(); ++i)
    {
      const double p = i % 2 == 0 ? random.Uniform() : random.PowerOfTen(-15.0, 0.0);
      Point weights{ p, 1.0 - p, 0.0 };
      std::rotate(weights.begin(), weights.begin() + i % 3, weights.end());
      samples.push_back({ i / 24, weights });
    }
    const auto onEdges = MakeFilter(GetParam(), pair, MakeCloud(pair.Source, samples));
    onEdges->ComputeJacobianOn();
    vtkPointSet* output = Output(onEdges);
    EXPECT_EQ(onEdges->GetNumberOfOutsidePoints(), 0);
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      ASSERT_LE(
        Distance(PointOf(output, i), PositionOf(pair.Target, samples[static_cast<std::size_t>(i)])),
        std::max(1e-14 * pair.Target->GetLength(),
          2.0 * Norm(JacobianOf(output, i)) * Ulp * LargestCoordinate(pair.Source)));
    }
  }
}

/// The attainable accuracy of a Jacobian. In all systems except Linear, J depends on the direction
/// from a vertex near it, and the relative accuracy of that direction decreases with the distance.
double JacobianBound(vtkPolyData* mesh, const MeshPoint& surfacePoint)
{
  const Point position = PositionOf(mesh, surfacePoint);
  double nearest = mesh->GetLength();
  for (const Point& corner : CornersOf(mesh, surfacePoint.Triangle))
  {
    nearest = std::min(nearest, Distance(corner, position));
  }
  return 1e-11 + 32.0 * Ulp * mesh->GetLength() / nearest;
}

TEST_P(FilterInEverySystem, AffineMapsAreReproduced)
{
  // In the plane, a similarity for the Contour system, because other affine maps do not preserve
  // its right angles. On surfaces, motions.
  const Matrix identity{ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  const Matrix motion = Rotation({ 2.0, 1.0, -1.0 }, 1.3);
  const Matrix turn = Rotation({ 0.0, 0.0, 1.0 }, 2.1);
  const Matrix similarity{ { 2.5 * turn[0], 2.5 * turn[1], { 0.0, 0.0, 1.0 } } };
  const Matrix affine{ { { 1.5, 0.75, 0.0 }, { -0.25, 2.0, 0.0 }, { 0.0, 0.0, 1.0 } } };
  std::vector<std::pair<vtkSmartPointer<vtkPolyData>, Matrix>> cases{
    { MakePlanarPair(10, 180).Source, GetParam().IsContour() ? similarity : affine },
    { MakeSheet(8, 185, 0.7), motion }, { MakeClosedPair(2, 186).Target, motion }
  };
  for (const Pairing& pairing : AllPairings(8, 2, 120))
  {
    cases.emplace_back(pairing.Meshes.Target, identity);
  }
  for (const auto& [source, matrix] : cases)
  {
    const Point shift = matrix == identity ? Point{} : Point{ 0.25, -1.0, 2.0 };
    const auto target = Tilted(source, matrix, shift);
    const std::vector<MeshPoint> samples = RandomSamples(source, 10000, 8);
    const auto cloud = MakeCloud(source, samples);
    const auto filter = MakeFilter(GetParam(), { source, target }, cloud);
    ComputeEverything(filter);
    vtkPointSet* output = Output(filter);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      ASSERT_LE(Distance(PointOf(output, i), matrix * PointOf(cloud, i) + shift),
        1e-14 * target->GetLength());
      const double bound =
        Norm(matrix) * JacobianBound(source, samples[static_cast<std::size_t>(i)]);
      ASSERT_LE(Distance(JacobianOf(output, i), matrix), bound);
      ASSERT_NEAR(
        PointValue(output, "JacobianDeterminant", i), Determinant(matrix), bound * Norm(matrix));
    }
  }
}

TEST_P(FilterInEverySystem, MirroredPairs)
{
  // The mirror image of the map is the map of the mirror images.
  const MeshPair pair = MakePlanarPair(12, 170);
  const auto cloud = MakeCloud(pair.Source, RandomSamples(pair.Source, 20000, 6));
  const auto straight = MakeFilter(GetParam(), pair, cloud);
  const auto mirror = MakeFilter(GetParam(), { pair.Source, Mirrored(pair.Target) }, cloud);
  mirror->ComputeJacobianDeterminantOn();
  vtkPointSet* image = Output(mirror);
  EXPECT_LT(PointArray(image, "JacobianDeterminant")->GetRange()[1], 0.0);
  EXPECT_LE(LargestDistance(image, Mirrored(vtkPolyData::SafeDownCast(Output(straight)))), 1e-13);
  // On a surface it is another surface, where areas have no sign.
  const MeshPair closed = MakeClosedPair(2, 172);
  const auto onSurface = MakeFilter(GetParam(), { closed.Source, Mirrored(closed.Target) });
  onSurface->ComputeJacobianDeterminantOn();
  EXPECT_GT(PointArray(Output(onSurface), "JacobianDeterminant")->GetRange()[0], 0.0);
  EXPECT_EQ(onSurface->GetNumberOfOutsidePoints(), 0);
}

TEST_P(FilterInEverySystem, JacobianIsTheDerivative)
{
  for (const auto& [kind, pair] : AllPairings(8, 2, 330))
  {
    SCOPED_TRACE(kind);
    const std::vector<MeshPoint> samples = InnerSamples(pair.Source, 4000, 35, 1e-3);
    // Copies, because pairs share meshes. Vertices before the polygons shift the cell ids.
    const MeshPair shifted = CopyOf(pair);
    AddVerticesAndLines(shifted.Source, 2, 0);
    AddVerticesAndLines(shifted.Target, 2, 0);
    const auto filter = MakeFilter(GetParam(), shifted, MakeCloud(pair.Source, samples));
    ComputeEverything(filter);
    vtkPointSet* output = Output(filter);
    ASSERT_TRUE(vtkIdTypeArray::SafeDownCast(PointArray(output, "TriangleId")));
    // Steps along two edges of the triangle stay in its plane.
    constexpr double h = 2e-5;
    std::vector<MeshPoint> stencils;
    for (const MeshPoint& surfacePoint : samples)
    {
      for (const std::size_t direction : { 1u, 2u })
      {
        for (const double step : { -2.0, -1.0, 1.0, 2.0 })
        {
          MeshPoint moved = surfacePoint;
          moved.Weights[direction] += step * h;
          moved.Weights[0] -= step * h;
          stencils.push_back(moved);
        }
      }
    }
    const auto stencilFilter = MakeFilter(GetParam(), pair, MakeCloud(pair.Source, stencils));
    vtkPointSet* images = Output(stencilFilter);
    std::vector<double> errors;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      const auto id = static_cast<vtkIdType>(i);
      const Matrix j = JacobianOf(output, id);
      ASSERT_EQ(PointValue(output, "TriangleId", id), samples[i].Triangle + 2);
      const std::array<Point, 3> from = CornersOf(pair.Source, samples[i].Triangle);
      const std::array<Point, 3> to = CornersOf(pair.Target, samples[i].Triangle);
      // The Jacobian maps normal to normal. The normals of these planes follow from the winding.
      const Point normal = Unit(NormalOf(pair.Source, samples[i].Triangle));
      const Point image = Unit(NormalOf(pair.Target, samples[i].Triangle));
      ASSERT_LE(Distance(j * normal, image), 1e-11);
      ASSERT_NEAR(PointValue(output, "JacobianDeterminant", id), Determinant(j),
        1e-11 * (1.0 + std::abs(Determinant(j))) * Norm(j));
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
    // A few stencils lie across spokes of Contour, wing segments, or the borders of strips.
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() * 99 / 100], 1e-8);
    EXPECT_LT(errors.back(), GetParam().IsContour() ? 10.0 : 1e-5);
  }
}

TEST_P(FilterInEverySystem, UsedCoordinateSystemMarksTrianglesMappedByLinear)
{
  // Discordant triangles in the source alone, in the target alone, and none.
  const MeshPair planar = MakePlanarPair(8, 343);
  const auto sheared = Sheared(planar.Source);
  const MeshPair allConcordant = MakePlanarPair(12, 344, 0.06);
  for (const MeshPair& pair :
    { MeshPair{ sheared, planar.Target }, MeshPair{ planar.Target, sheared }, allConcordant })
  {
    const auto cloud = MakeCloud(pair.Source, InnerSamples(pair.Source, 2000, 45, 1e-3));
    cloud->GetPoints()->InsertNextPoint(-1000.0, 0.0, 0.0);
    const auto filter = MakeFilter(GetParam(), pair, cloud);
    filter->ComputeTriangleIdOn();
    vtkPointSet* output = Output(filter);
    vtkDataArray* used = PointArray(output, "UsedCoordinateSystem");
    if (!GetParam().IsChoosy() || pair.Source == allConcordant.Source)
    {
      EXPECT_FALSE(used);
      EXPECT_EQ(filter->GetNumberOfDiscordantTriangles(), 0);
      continue;
    }
    // Discordant in either mesh.
    const auto ofSource = MakeCoordinates(GetParam(), pair.Source);
    const auto ofTarget = MakeCoordinates(GetParam(), pair.Target);
    std::vector<double> concordant = ValuesOf(CellArray(Output(ofSource), "Concordant"));
    const std::vector<double> inTarget = ValuesOf(CellArray(Output(ofTarget), "Concordant"));
    std::transform(concordant.begin(), concordant.end(), inTarget.begin(), concordant.begin(),
      std::multiplies<>());
    const auto count = std::count(concordant.begin(), concordant.end(), 0.0);
    EXPECT_EQ(filter->GetNumberOfDiscordantTriangles(), count);
    EXPECT_GT(count, 20);
    ASSERT_TRUE(vtkIntArray::SafeDownCast(used));
    for (vtkIdType i = 0; i < 2000; ++i)
    {
      const auto t = static_cast<std::size_t>(PointValue(output, "TriangleId", i));
      ASSERT_EQ(used->GetComponent(i, 0),
        concordant[t] == 0.0 ? Linear.CoordinateSystem : Contour.CoordinateSystem);
    }
    EXPECT_EQ(used->GetComponent(2000, 0), -1.0);
  }
}

TEST_P(FilterInEverySystem, OutsidePointsAreMarkedAndBlanked)
{
  using Attributes = vtkDataSetAttributes;
  const MeshPair pair = MakePlanarPair(8, 310);
  for (const bool hasGhosts : { false, true })
  {
    const auto image = MakeImage({ 0, 40, 0, 30, 0, 0 }, { -1.0, 0.1, 0.0 }, { 0.26, 0.3, 1.0 });
    const vtkIdType points = image->GetNumberOfPoints();
    const vtkIdType cells = image->GetNumberOfCells();
    image->GetPointData()->SetVectors(RandomArray("Velocity", 3, points, 31));
    const auto pointGhosts = MakeGhosts(points, {}, 0);
    const auto cellGhosts = MakeGhosts(cells, {}, 0);
    if (hasGhosts)
    {
      for (vtkIdType i = 0; i < points; ++i)
      {
        pointGhosts->SetValue(i,
          (i % 5 == 0 ? Attributes::DUPLICATEPOINT : 0) |
            (i % 11 == 0 ? Attributes::HIDDENPOINT : 0));
      }
      for (vtkIdType i = 0; i < cells; i += 7)
      {
        cellGhosts->SetValue(i, Attributes::DUPLICATECELL);
      }
      image->GetPointData()->AddArray(pointGhosts);
      image->GetCellData()->AddArray(cellGhosts);
    }
    const auto filter = MakeFilter(GetParam(), pair, image);
    ComputeEverything(filter);
    vtkPointSet* output = Output(filter);
    const char* name = Attributes::GhostArrayName();
    vtkIdType outside = 0;
    for (vtkIdType i = 0; i < points; ++i)
    {
      const Point p = PointOf(image, i);
      const int ghost = pointGhosts->GetValue(i);
      // Hidden points are outside. Ghost points are marked, but not counted.
      const bool isOutside = p[0] < 0.0 || p[0] > 8.0 || p[1] < 0.0 || p[1] > 8.0 ||
        (ghost & Attributes::HIDDENPOINT) != 0;
      outside += isOutside && (ghost & Attributes::DUPLICATEPOINT) == 0;
      ASSERT_NE(IsValid(output, i), isOutside);
      ASSERT_EQ(PointValue(output, "TriangleId", i) < 0, isOutside);
      ASSERT_EQ(std::isnan(Norm(JacobianOf(output, i))), isOutside);
      ASSERT_EQ(std::isnan(PointValue(output, "JacobianDeterminant", i)), isOutside);
      ASSERT_EQ(std::isnan(Norm(VectorOf(PointArray(output, "Velocity"), i))), isOutside);
      ASSERT_TRUE(!isOutside || PointOf(output, i) == p);
      ASSERT_EQ(PointValue(output, name, i), ghost | (isOutside ? Attributes::HIDDENPOINT : 0));
    }
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), outside);
    EXPECT_GT(outside, 100);
    for (vtkIdType cell = 0; cell < cells; ++cell)
    {
      const std::vector<vtkIdType> ids = IdsOf(image, cell);
      const bool isInside =
        std::all_of(ids.begin(), ids.end(), [output](vtkIdType i) { return IsValid(output, i); });
      ASSERT_EQ(CellValue(output, name, cell),
        cellGhosts->GetValue(cell) | (isInside ? 0 : Attributes::HIDDENCELL));
    }
    // The input's arrays are not modified.
    EXPECT_EQ(PointArray(image, name), hasGhosts ? pointGhosts.Get() : nullptr);
    filter->BlankOutsideOff();
    EXPECT_EQ(PointArray(Output(filter), name), hasGhosts ? pointGhosts.Get() : nullptr);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), outside);
  }
  // There are none if all points are inside.
  const auto inside = MakeFilter(GetParam(), pair);
  EXPECT_FALSE(PointArray(Output(inside), Attributes::GhostArrayName()));
}

TEST(DifferentiableHomeomorphism, ArraysOfTheSameNameAreReplaced)
{
  const MeshPair pair = MakePlanarPair(4, 345);
  const auto data = CopyOf(pair.Source.Get());
  const std::vector<std::pair<const char*, int>> added{ { "vtkValidPointMask", 1 },
    { "TriangleId", 1 }, { "Jacobian", 9 }, { "JacobianDeterminant", 1 } };
  for (const auto& [name, components] : added)
  {
    data->GetPointData()->AddArray(RandomArray<vtkIntArray>(name, 2, 25, 37));
  }
  const auto filter = MakeFilter(Smooth, pair, data);
  // Only added arrays replace others.
  EXPECT_EQ(PointArray(Output(filter), "Jacobian")->GetNumberOfComponents(), 2);
  ComputeEverything(filter);
  EXPECT_EQ(Output(filter)->GetPointData()->GetNumberOfArrays(), 4);
  for (const auto& [name, components] : added)
  {
    EXPECT_EQ(PointArray(Output(filter), name)->GetNumberOfComponents(), components);
    EXPECT_EQ(PointArray(data, name)->GetNumberOfComponents(), 2);
  }
}

} // namespace
