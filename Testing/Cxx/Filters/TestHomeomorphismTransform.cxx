// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkHomeomorphismTransform equals the map of the filter wherever VTK accepts a transform.

#include "Fixtures/FilterRuns.h"

#include "vtkGeneralTransform.h"
#include "vtkImageReslice.h"
#include "vtkSMPTools.h"
#include "vtkTransformFilter.h"

#include <tuple>

namespace
{

using namespace fixtures;

/// Pairs of planes: xy to xy, and tilted to x = const.
std::vector<MeshPair> PlanarPairs(std::uint64_t seed)
{
  const MeshPair pair = MakePlanarPair(8, seed);
  return { pair,
    { Tilted(pair.Source, Tilt(), { 1.0, 0.5, -2.0 }),
      Moved(pair.Target, [](const Point& p) -> Point {
        return { 3.0, p[0], p[1] };
      }) } };
}

/// In the domain and around it, above and below its plane.
std::vector<Point> PositionsAround(vtkPolyData* mesh, std::uint64_t seed)
{
  std::vector<Point> positions = PointsOf(MakeCloud(mesh, RandomSamples(mesh, 5000, seed)));
  Random random(seed + 1);
  for (std::size_t i = 4000; i < positions.size(); ++i)
  {
    positions[i] = positions[i] + 0.5 * mesh->GetLength() * random.Vector();
  }
  return positions;
}

/// Image and derivative at a point; the input is also the output.
template <typename Real>
std::pair<Point, Matrix> Differential(vtkAbstractTransform* transform, const Real* p)
{
  Real q[3] = { p[0], p[1], p[2] };
  Real d[3][3];
  transform->InternalTransformDerivative(q, q, d);
  return { { q[0], q[1], q[2] },
    { { { d[0][0], d[0][1], d[0][2] }, { d[1][0], d[1][1], d[1][2] },
      { d[2][0], d[2][1], d[2][2] } } } };
}

/// The images of points, with the precision of the points.
std::vector<Point> TransformedAtOnce(vtkAbstractTransform* transform, vtkPoints* points)
{
  vtkNew<vtkPolyData> images;
  images->SetPoints(vtkNew<vtkPoints>());
  images->GetPoints()->SetDataType(points->GetDataType());
  transform->TransformPoints(points, images->GetPoints());
  return PointsOf(images);
}

using TransformInEverySystem = TestInEverySystem;

INSTANTIATE_TEST_SUITE_P(
  All, TransformInEverySystem, ::testing::ValuesIn(AllSystems()), NameOfSystem);

TEST_P(TransformInEverySystem, AgreesWithTheFilter)
{
  for (int kind = 0; kind < 8; ++kind)
  {
    SCOPED_TRACE(kind);
    const MeshPair pair = PlanarPairs(500)[static_cast<std::size_t>(kind & 1)];
    const bool inverse = (kind & 2) != 0;
    const bool isFloat = (kind & 4) != 0;
    const int type = isFloat ? VTK_FLOAT : VTK_DOUBLE;
    const auto cloud = MakeCloud(PositionsAround(inverse ? pair.Target : pair.Source, 60), type);
    const vtkIdType count = cloud->GetNumberOfPoints();
    cloud->GetPointData()->SetNormals(RandomArray("Normals", 3, count, 64));
    cloud->GetPointData()->SetVectors(RandomArray("Vectors", 3, count, 65));
    cloud->GetPointData()->AddArray(RandomArray("More", 3, count, 66));
    const auto filter = MakeFilter(GetParam(), pair, cloud);
    filter->SetInverse(inverse);
    filter->ComputeJacobianOn();
    filter->TransformAllInputVectorsOn();
    vtkPointSet* mapped = Output(filter);
    // Boundary points that rounding to float moves outside count as inside.
    EXPECT_GT(filter->GetNumberOfOutsidePoints(), 100);
    EXPECT_LT(filter->GetNumberOfOutsidePoints(), 1000);
    // The flag here, GetInverse below.
    const auto transform = MakeTransform(GetParam(), pair);
    if (inverse)
    {
      transform->Inverse();
    }
    const double coordinate = transform->GetOutsideCoordinate();
    const double outside = isFloat ? RoundedToFloat(coordinate) : coordinate;
    std::vector<Point> expected = PointsOf(mapped);

    // Point by point.
    for (vtkIdType i = 0; i < count; ++i)
    {
      const Point p = PointOf(cloud, i);
      const bool isInside = IsValid(mapped, i);
      Point& image = expected[static_cast<std::size_t>(i)];
      image = isInside ? image : Point{ outside, outside, outside };
      const float narrow[3] = { float(p[0]), float(p[1]), float(p[2]) };
      const auto [found, derivative] =
        isFloat ? Differential(transform, narrow) : Differential(transform, p.data());
      ASSERT_EQ(found, image);
      ASSERT_NE(std::isnan(Norm(derivative)), isInside);
      if (isFloat)
      {
        float single[3];
        transform->TransformPoint(narrow, single);
        ASSERT_EQ((Point{ single[0], single[1], single[2] }), image);
      }
      else
      {
        ASSERT_EQ(Transformed(transform, p), image);
        ASSERT_EQ(transform->IsInside(p.data()), isInside);
      }
      if (isInside)
      {
        // VTK inverts the forward derivative of an inverse.
        const Matrix j = JacobianOf(mapped, i);
        ASSERT_TRUE(isFloat || inverse || derivative == j);
        ASSERT_LE(Distance(derivative, j),
          (isFloat ? 1e-6 : 1e-13) * Norm(j) * Norm(Inverted(j)) * Norm(j));
      }
    }

    // All points at once, by the transform itself, which appends, and by VTK's users of it.
    EXPECT_EQ(TransformedAtOnce(transform, cloud->GetPoints()), expected);
    const auto appended = MakeCloud({ { 7.0, 8.0, 9.0 } }, type);
    transform->TransformPoints(cloud->GetPoints(), appended->GetPoints());
    EXPECT_EQ(PointOf(appended, 0), (Point{ 7.0, 8.0, 9.0 }));
    EXPECT_EQ(PointOf(appended, count), expected.back());
    const auto another = MakeTransform(GetParam(), pair);
    vtkAbstractTransform* same = inverse ? another->GetInverse() : another.Get();
    vtkNew<vtkTransformFilter> user;
    user->SetInputData(cloud);
    user->SetTransform(same);
    user->TransformAllInputVectorsOn();
    user->Update();
    EXPECT_EQ(PointsOf(user->GetOutput()), expected);
    for (const char* name : { "Normals", "Vectors", "More" })
    {
      EXPECT_TRUE(IsSame(PointArray(user->GetOutput(), name), PointArray(mapped, name))) << name;
    }
    if (!isFloat)
    {
      vtkNew<vtkGeneralTransform> general;
      general->Concatenate(same);
      EXPECT_EQ(TransformedAtOnce(general, cloud->GetPoints()), expected);
    }
  }
}

TEST_P(TransformInEverySystem, Inverse)
{
  const MeshPair pair = PlanarPairs(540)[1];
  const auto transform = MakeTransform(GetParam(), pair);
  vtkAbstractTransform* inverse = transform->GetInverse();
  EXPECT_EQ(inverse->GetInverse(), transform.Get());
  // Setting the flag once gives the inverse, and likewise for the inverse; twice restores the map.
  const Point p = PositionOf(pair.Source, { 7, { 0.3, 0.3, 0.4 } });
  const Point image = Transformed(transform, p);
  const Point back = Transformed(inverse, image);
  for (const bool inverted : { true, false })
  {
    transform->Inverse();
    EXPECT_EQ(Transformed(transform, inverted ? image : p), inverted ? back : image);
    EXPECT_EQ(Transformed(transform->GetInverse(), inverted ? p : image), inverted ? image : back);
  }
}

TEST_P(TransformInEverySystem, CopiesAreEqual)
{
  const MeshPair pair = MakePlanarPair(8, 545);
  const auto transform = MakeTransform(GetParam(), pair);
  transform->MaskInvalidTrianglesOn();
  transform->SetTolerance(0.03);
  const auto optionsOf = [](vtkHomeomorphismTransform* of) {
    return std::make_tuple(of->GetSource(), of->GetTarget(), of->GetCoordinateSystem(),
      of->GetCenterPoint(), of->GetDiscordantTriangles(), of->GetMaskInvalidTriangles(),
      of->GetTolerance(), of->GetInverseFlag());
  };
  for (int direction = 0; direction < 2; ++direction)
  {
    vtkNew<vtkHomeomorphismTransform> copy;
    copy->SetCoordinateSystemToLinear();
    copy->DeepCopy(transform);
    EXPECT_EQ(optionsOf(copy), optionsOf(transform));
    for (const Point& p : PositionsAround(pair.Source, 68))
    {
      ASSERT_EQ(Transformed(copy, p), Transformed(transform, p));
    }
    // A copy is independent of the original.
    copy->SetSource(pair.Target);
    EXPECT_EQ(transform->GetSource(), pair.Source.Get());
    EXPECT_EQ(Transformed(copy, { 1.25, 2.5, 3.0 })[2], 3.0);
    transform->Inverse();
  }
  const auto made = vtkSmartPointer<vtkAbstractTransform>::Take(transform->MakeTransform());
  EXPECT_TRUE(vtkHomeomorphismTransform::SafeDownCast(made));
}

TEST_P(TransformInEverySystem, Outside)
{
  const MeshPair pair = MakePlanarPair(6, 560);
  const auto transform = MakeTransform(GetParam(), pair);
  const double outside = transform->GetOutsideCoordinate();
  EXPECT_GE(outside, 1e29);
  const Point nowhere{ outside, outside, outside };
  for (const Point& p : std::vector<Point>{ { -0.001, 3.0, 0.0 }, { 6.001, 3.0, 5.0 },
         { 1e20, 0.0, 0.0 }, { NotANumber, 1.0, 0.0 }, { 1.0, NotANumber, 0.0 }, nowhere })
  {
    EXPECT_EQ(Transformed(transform, p), nowhere);
    EXPECT_EQ(Transformed(transform->GetInverse(), p), nowhere);
    EXPECT_FALSE(transform->IsInside(p.data()));
  }
  const Point inside{ 3.0, 3.0, 100.0 };
  EXPECT_TRUE(transform->IsInside(inside.data()));
  transform->SetTolerance(0.01);
  EXPECT_LE(std::abs(Transformed(transform, { -0.05, 3.0, 0.0 })[0]), 1e-14);
  EXPECT_EQ(Transformed(transform, { -0.5, 3.0, 0.0 })[0], outside);

  // Larger than any coordinate of the meshes.
  const auto large = MakeTransform(GetParam(), Resized(pair, 1e40));
  EXPECT_GT(large->GetOutsideCoordinate(), 100.0 * 6e40);
  EXPECT_TRUE(large->IsInside((1e40 * inside).data()));
}

TEST_P(TransformInEverySystem, AnyNumberOfThreadsGivesTheSameBits)
{
  const MeshPair pair = MakePlanarPair(12, 580);
  const auto cloud = MakeCloud(pair.Source, RandomSamples(pair.Source, 20000, 70));
  cloud->GetPointData()->SetVectors(RandomArray("Vectors", 3, cloud->GetNumberOfPoints(), 71));
  vtkSmartPointer<vtkPointSet> first;
  const std::string previous = vtkSMPTools::GetBackend();
  for (const std::string backend : { "Sequential", "STDThread", "TBB" })
  {
    if (!vtkSMPTools::SetBackend(backend.c_str()))
    {
      // Only the first two are in every VTK.
      EXPECT_EQ(backend, "TBB");
      continue;
    }
    vtkSMPTools::SetBackend(previous.c_str());
    for (const int threads : { 1, 2, 5 })
    {
      SCOPED_TRACE(backend + std::to_string(threads));
      vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads, backend, false }, [&]() {
        EXPECT_EQ(vtkSMPTools::GetBackend(), backend);
        // The meshes are read again, too.
        const auto filter = MakeFilter(GetParam(), pair, cloud);
        ComputeEverything(filter);
        vtkPointSet* mapped = Output(filter);
        first = first ? first.Get() : mapped;
        ExpectSame(mapped, first, { "Vectors", "Jacobian", "TriangleId", "vtkValidPointMask" });
        // There are no points outside.
        EXPECT_EQ(
          TransformedAtOnce(MakeTransform(GetParam(), pair), cloud->GetPoints()), PointsOf(first));
      });
    }
  }
}

TEST_P(TransformInEverySystem, RowsOfSinglePointsGiveTheBitsOfArrays)
{
  // Steps that are exact, and such that rounding makes them unequal. Rows leave the domain, and
  // each 37th step is twice as long.
  std::vector<Point> positions;
  for (const double step : { 0.125, 0.1 })
  {
    for (int row = 0; row < 20; ++row)
    {
      for (int i = 0; i < 100 + row; ++i)
      {
        positions.push_back({ (i + i / 37) * step - 1.0, 0.3 + row * step, 0.0 });
      }
    }
  }
  const MeshPair pair = MakePlanarPair(9, 582);
  const auto transform = MakeTransform(GetParam(), pair);
  vtkAbstractTransform* inverse = transform->GetInverse();
  const auto expect = [&positions](vtkAbstractTransform* tested, std::size_t first) {
    const std::vector<Point> images = TransformedAtOnce(tested, MakeCloud(positions)->GetPoints());
    for (std::size_t i = first; i < positions.size(); ++i)
    {
      ASSERT_EQ(Transformed(tested, positions[i]), images[i]) << i;
    }
  };
  expect(transform, 0);
  expect(inverse, 0);
  // A row does not end with the map.
  for (std::size_t i = 0; i < 50; ++i)
  {
    Transformed(transform, positions[i]);
  }
  transform->SetTarget(MakePlanarPair(9, 583).Target);
  expect(transform, 50);
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    for (vtkAbstractTransform* tested :
      std::initializer_list<vtkAbstractTransform*>{ transform, inverse })
    {
      const Point image = Transformed(tested, positions[i]);
      EXPECT_TRUE(i % 7 != 0 || Differential(tested, positions[i].data()).first == image) << i;
    }
  }
}

TEST_P(TransformInEverySystem, ImagesAreResampled)
{
  // vtkImageReslice gives pixels outside its background. In the second case their position, in
  // pixels, exceeds the range of float.
  for (const double size : { 1.0, 1e-12 })
  {
    MeshPair pair = Resized(MakePlanarPair(8, 600), size);
    pair.Target = Sheared(pair.Target);
    const auto image =
      MakeImage({ 0, 59, 0, 59, 0, 0 }, { -size, -size, 0.0 }, { 0.2 * size, 0.2 * size, 1.0 });
    const auto grayAt = [size](const Point& p) { return (3.0 * p[0] + p[1]) / size; };
    image->GetPointData()->SetScalars(ValuesAt(image, "Gray", grayAt));
    // From the grid of the output to the input.
    const auto transform = MakeTransform(GetParam(), pair);
    vtkNew<vtkImageReslice> reslice;
    reslice->SetInputData(image);
    reslice->SetResliceTransform(transform->GetInverse());
    reslice->SetInterpolationModeToLinear();
    reslice->SetBackgroundLevel(-1000.0);
    reslice->SetOutputDimensionality(2);
    reslice->SetOutputExtent(0, 149, 0, 79, 0, 0);
    reslice->SetOutputSpacing(0.13 * size, 0.14 * size, 1.0);
    reslice->SetOutputOrigin(-size, -size, 0.0);
    reslice->Update();
    vtkImageData* output = reslice->GetOutput();
    const auto filter = MakeFilter(GetParam(), pair, output);
    filter->InverseOn();
    vtkPointSet* preimages = Output(filter);
    EXPECT_GT(filter->GetNumberOfOutsidePoints(), 1000);
    EXPECT_LT(filter->GetNumberOfOutsidePoints(), 10000);
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      // VTK rounds positions to about 2^-17 of a pixel.
      ASSERT_NEAR(output->GetPointData()->GetScalars()->GetTuple1(i),
        IsValid(preimages, i) ? grayAt(PointOf(preimages, i)) : -1000.0, 1e-4);
    }
  }
}

} // namespace
