// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkHomeomorphismTransform equals the map of the filter wherever VTK accepts a transform.

#include "Fixtures/FilterRuns.h"

#include "vtkGeneralTransform.h"
#include "vtkImageReslice.h"
#include "vtkSMPTools.h"
#include "vtkTransformFilter.h"
#include "vtkTransformPolyDataFilter.h"

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
  std::vector<Point> positions;
  for (const MeshPoint& surfacePoint : RandomSamples(mesh, 4000, seed))
  {
    positions.push_back(PositionOf(mesh, surfacePoint));
  }
  Random random(seed + 1);
  const double size = SizeOf(mesh);
  for (const MeshPoint& surfacePoint : RandomSamples(mesh, 1000, seed + 2))
  {
    positions.push_back(PositionOf(mesh, surfacePoint) + 0.5 * size * random.Vector());
  }
  return positions;
}

/// Image and derivative at a point; the input is also the output.
struct Differential
{
  template <typename Real>
  Differential(vtkAbstractTransform* transform, const Real* p)
  {
    Real image[3] = { p[0], p[1], p[2] };
    Real rows[3][3];
    transform->InternalTransformDerivative(image, image, rows);
    std::copy_n(image, 3, this->Image.begin());
    for (std::size_t row = 0; row < 3; ++row)
    {
      std::copy_n(rows[row], 3, this->Derivative[row].begin());
    }
  }

  Point Image;
  Matrix Derivative;
};

class TransformInEverySystem : public ::testing::TestWithParam<System>
{
};

INSTANTIATE_TEST_SUITE_P(
  All, TransformInEverySystem, ::testing::ValuesIn(AllSystems()), NameOfSystem);

// --- Agreement with the filter -------------------------------------------------------------------

TEST_P(TransformInEverySystem, AgreesWithTheFilter)
{
  for (const MeshPair& pair : PlanarPairs(500))
  {
    for (const bool inverse : { false, true })
    {
      for (const int type : { VTK_DOUBLE, VTK_FLOAT })
      {
        const bool isFloat = type == VTK_FLOAT;
        std::vector<Point> positions = PositionsAround(inverse ? pair.Target : pair.Source, 60);
        for (Point& p : positions)
        {
          p = isFloat ? RoundedToFloat(p) : p;
        }
        const auto cloud = MakeCloud(positions, type);
        const vtkIdType count = cloud->GetNumberOfPoints();
        const auto filter = MakeFilter(GetParam(), pair, cloud);
        filter->SetInverse(inverse);
        filter->ComputeJacobianOn();
        vtkPointSet* mapped = Output(filter);
        // Boundary points that rounding to float moves outside count as inside.
        EXPECT_GT(filter->GetNumberOfOutsidePoints(), 100);
        EXPECT_LT(filter->GetNumberOfOutsidePoints(), 1000);
        const auto transform = MakeTransform(GetParam(), pair);
        if (inverse)
        {
          transform->Inverse();
        }
        const double coordinate = transform->GetOutsideCoordinate();
        const double outside = isFloat ? RoundedToFloat(coordinate) : coordinate;
        const auto isInside = [&](vtkIdType i) { return IsValid(mapped, i); };
        const auto expected = [&](vtkIdType i) {
          return isInside(i) ? PointOf(mapped, i) : Point{ outside, outside, outside };
        };

        // Point by point.
        vtkIdType different = 0;
        for (vtkIdType i = 0; i < count; ++i)
        {
          const Point p = positions[static_cast<std::size_t>(i)];
          const float narrow[3] = { static_cast<float>(p[0]), static_cast<float>(p[1]),
            static_cast<float>(p[2]) };
          const Differential found =
            isFloat ? Differential(transform, narrow) : Differential(transform, p.data());
          different += found.Image != expected(i);
          different += std::isnan(Norm(found.Derivative)) == isInside(i);
          if (isFloat)
          {
            float image[3];
            transform->TransformPoint(narrow, image);
            different += Point{ image[0], image[1], image[2] } != expected(i);
          }
          else
          {
            Point same = p;
            transform->TransformPoint(same.data(), same.data());
            different += same != expected(i);
            different += transform->IsInside(p.data()) != isInside(i);
          }
          if (isInside(i))
          {
            // VTK inverts the forward derivative of an inverse.
            const Matrix j = JacobianOf(mapped, i);
            different += !isFloat && !inverse && found.Derivative != j;
            ASSERT_LE(Distance(found.Derivative, j),
              (isFloat ? 1e-6 : 1e-13) * Norm(j) * Norm(Inverted(j)) * Norm(j));
          }
        }
        EXPECT_EQ(different, 0);

        // All points at once, by the transform itself, which appends, and by VTK's users of it.
        const auto countDifferent = [&](vtkPoints* points, vtkIdType first) {
          EXPECT_EQ(points->GetNumberOfPoints(), first + count);
          vtkIdType result = 0;
          for (vtkIdType i = 0; i < count; ++i)
          {
            result += PointOf(points, first + i) != expected(i);
          }
          return result;
        };
        vtkNew<vtkPoints> points;
        points->SetDataType(type);
        points->InsertNextPoint(7.0, 8.0, 9.0);
        transform->TransformPoints(cloud->GetPoints(), points);
        EXPECT_EQ(countDifferent(points, 1), 0);
        EXPECT_EQ(PointOf(points, 0), (Point{ 7.0, 8.0, 9.0 }));
        vtkNew<vtkTransformPolyDataFilter> user;
        user->SetInputData(cloud);
        user->SetTransform(transform);
        user->SetOutputPointsPrecision(vtkAlgorithm::DEFAULT_PRECISION);
        user->Update();
        EXPECT_EQ(countDifferent(user->GetOutput()->GetPoints(), 0), 0);
        if (!isFloat)
        {
          vtkNew<vtkGeneralTransform> general;
          general->Concatenate(transform);
          vtkNew<vtkPoints> viaGeneral;
          viaGeneral->SetDataType(type);
          general->TransformPoints(cloud->GetPoints(), viaGeneral);
          EXPECT_EQ(countDifferent(viaGeneral, 0), 0);
        }
      }
    }
  }
}

TEST_P(TransformInEverySystem, NormalsAndVectorsAgreeWithTheFilter)
{
  for (const MeshPair& pair : PlanarPairs(530))
  {
    for (const bool inverse : { false, true })
    {
      const auto cloud = MakeCloud(PositionsAround(inverse ? pair.Target : pair.Source, 63));
      const vtkIdType count = cloud->GetNumberOfPoints();
      cloud->GetPointData()->SetNormals(RandomArray("Normals", 3, count, 64));
      cloud->GetPointData()->SetVectors(RandomArray("Vectors", 3, count, 65));
      cloud->GetPointData()->AddArray(RandomArray("More", 3, count, 66));
      const auto filter = MakeFilter(GetParam(), pair, cloud);
      filter->SetInverse(inverse);
      filter->TransformAllInputVectorsOn();
      vtkPointSet* mapped = Output(filter);

      // GetInverse here, the inverse flag elsewhere.
      const auto transform = MakeTransform(GetParam(), pair);
      vtkNew<vtkTransformFilter> transformFilter;
      transformFilter->SetInputData(cloud);
      transformFilter->SetTransform(inverse ? transform->GetInverse() : transform.Get());
      transformFilter->TransformAllInputVectorsOn();
      transformFilter->Update();
      vtkPointSet* output = transformFilter->GetOutput();
      for (const char* name : { "Normals", "Vectors", "More" })
      {
        EXPECT_EQ(CountDifferentValues(PointArray(output, name), PointArray(mapped, name)), 0)
          << name;
        EXPECT_NE(CountDifferentValues(PointArray(output, name), PointArray(cloud, name)), 0);
      }
    }
  }
}

// --- Inverses and copies -------------------------------------------------------------------------

TEST_P(TransformInEverySystem, Inverse)
{
  const MeshPair pair = PlanarPairs(540)[1];
  const auto transform = MakeTransform(GetParam(), pair);
  vtkAbstractTransform* inverse = transform->GetInverse();
  EXPECT_EQ(inverse->GetInverse(), transform.Get());
  transform->Update();
  inverse->Update();
  for (const MeshPoint& surfacePoint : InnerSamples(pair.Source, 3000, 67, 1e-3))
  {
    const Differential forward(transform, PositionOf(pair.Source, surfacePoint).data());
    const Differential backward(inverse, forward.Image.data());
    const Matrix inverted = Inverted(forward.Derivative);
    ASSERT_LE(Distance(backward.Derivative, inverted),
      1e-11 * Norm(inverted) * Norm(inverted) * Norm(forward.Derivative));
  }
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
  for (const bool inverse : { false, true })
  {
    if (inverse)
    {
      transform->Inverse();
    }
    vtkNew<vtkHomeomorphismTransform> copy;
    copy->SetCoordinateSystemToLinear();
    copy->DeepCopy(transform);
    EXPECT_EQ(copy->GetSource(), pair.Source.Get());
    EXPECT_EQ(copy->GetTarget(), pair.Target.Get());
    EXPECT_EQ(copy->GetCoordinateSystem(), transform->GetCoordinateSystem());
    EXPECT_EQ(copy->GetCenterPoint(), transform->GetCenterPoint());
    EXPECT_EQ(copy->GetDiscordantTriangles(), transform->GetDiscordantTriangles());
    EXPECT_EQ(copy->GetMaskInvalidTriangles(), true);
    EXPECT_EQ(copy->GetTolerance(), 0.03);
    EXPECT_EQ(copy->GetInverseFlag(), transform->GetInverseFlag());
    vtkIdType different = 0;
    for (const Point& p : PositionsAround(pair.Source, 68))
    {
      different += Transformed(copy, p) != Transformed(transform, p);
    }
    EXPECT_EQ(different, 0);
    // A copy is independent of the original.
    copy->SetSource(pair.Target);
    EXPECT_EQ(transform->GetSource(), pair.Source.Get());
    EXPECT_EQ(Transformed(copy, { 1.25, 2.5, 3.0 })[2], 3.0);
  }
  vtkAbstractTransform* made = transform->MakeTransform();
  EXPECT_TRUE(vtkHomeomorphismTransform::SafeDownCast(made));
  made->Delete();
}

// --- Outside -------------------------------------------------------------------------------------

TEST_P(TransformInEverySystem, Outside)
{
  const MeshPair pair = MakePlanarPair(6, 560);
  const auto transform = MakeTransform(GetParam(), pair);
  const double outside = transform->GetOutsideCoordinate();
  EXPECT_GE(outside, 1e29);
  for (const Point& p : { Point{ -0.001, 3.0, 0.0 }, Point{ 6.001, 3.0, 5.0 },
         Point{ 1e20, 0.0, 0.0 }, Point{ NotANumber, 1.0, 0.0 }, Point{ 1.0, NotANumber, 0.0 },
         Point{ outside, outside, outside } })
  {
    EXPECT_EQ(Transformed(transform, p), (Point{ outside, outside, outside }));
    EXPECT_EQ(Transformed(transform->GetInverse(), p), (Point{ outside, outside, outside }));
    EXPECT_FALSE(transform->IsInside(p.data()));
  }
  const Point inside{ 3.0, 3.0, 100.0 };
  EXPECT_TRUE(transform->IsInside(inside.data()));
  transform->SetTolerance(0.01);
  EXPECT_LE(std::abs(Transformed(transform, { -0.05, 3.0, 0.0 })[0]), 1e-14);
  EXPECT_EQ(Transformed(transform, { -0.5, 3.0, 0.0 })[0], outside);

  // Larger than any coordinate of the meshes.
  const auto galaxy = [](const Point& p) { return 1e40 * p; };
  const auto large =
    MakeTransform(GetParam(), { Moved(pair.Source, galaxy), Moved(pair.Target, galaxy) });
  EXPECT_GT(large->GetOutsideCoordinate(), 100.0 * 6e40);
  EXPECT_TRUE(large->IsInside(galaxy(inside).data()));
}

// --- Threads -------------------------------------------------------------------------------------

TEST_P(TransformInEverySystem, AnyNumberOfThreadsGivesTheSameBits)
{
  const MeshPair pair = MakePlanarPair(12, 580);
  std::vector<Point> positions;
  for (const MeshPoint& surfacePoint : RandomSamples(pair.Source, 20000, 70))
  {
    positions.push_back(PositionOf(pair.Source, surfacePoint));
  }
  const auto cloud = MakeCloud(positions);
  cloud->GetPointData()->SetVectors(RandomArray("Vectors", 3, cloud->GetNumberOfPoints(), 71));
  vtkSmartPointer<vtkPoints> first;
  vtkSmartPointer<vtkPointSet> firstMapped;
  const std::string previous = vtkSMPTools::GetBackend();
  for (const char* backend : { "Sequential", "STDThread", "TBB" })
  {
    if (!vtkSMPTools::SetBackend(backend))
    {
      // Only the first two are in every VTK.
      EXPECT_STREQ(backend, "TBB");
      continue;
    }
    vtkSMPTools::SetBackend(previous.c_str());
    for (const int threads : { 1, 2, 5 })
    {
      vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads, backend, false }, [&]() {
        EXPECT_STREQ(vtkSMPTools::GetBackend(), backend);
        // The meshes are read again, too.
        const auto transform = MakeTransform(GetParam(), pair);
        const auto points = vtkSmartPointer<vtkPoints>::New();
        points->SetDataTypeToDouble();
        transform->TransformPoints(cloud->GetPoints(), points);
        const auto filter = MakeFilter(GetParam(), pair, cloud);
        filter->ComputeJacobianOn();
        filter->ComputeTriangleIdOn();
        vtkPointSet* mapped = Output(filter);
        if (!first)
        {
          first = points;
          firstMapped = mapped;
          return;
        }
        EXPECT_EQ(CountDifferentValues(points->GetData(), first->GetData()), 0) << backend;
        EXPECT_EQ(CountDifferentPoints(mapped, firstMapped), 0) << backend << threads;
        for (const char* name : { "Vectors", "Jacobian", "TriangleId", "vtkValidPointMask" })
        {
          EXPECT_EQ(
            CountDifferentValues(PointArray(mapped, name), PointArray(firstMapped, name)), 0)
            << backend << threads << name;
        }
      });
    }
  }
}

// --- Rows ----------------------------------------------------------------------------------------

TEST_P(TransformInEverySystem, RowsOfSinglePointsGiveTheBitsOfArrays)
{
  // Steps that are exact, and such that rounding makes them unequal; rows leave the domain.
  std::vector<Point> positions;
  for (const double step : { 0.125, 0.1 })
  {
    for (int row = 0; row < 20; ++row)
    {
      for (int i = 0; i < 100 + row; ++i)
      {
        positions.push_back({ i * step - 1.0, 0.3 + row * step, 0.0 });
      }
    }
  }
  const MeshPair pair = MakePlanarPair(9, 582);
  const auto transform = MakeTransform(GetParam(), pair);
  vtkAbstractTransform* inverse = transform->GetInverse();
  const auto expect = [&positions](vtkAbstractTransform* tested) {
    const auto cloud = MakeCloud(positions);
    vtkNew<vtkPoints> expected;
    expected->SetDataTypeToDouble();
    tested->TransformPoints(cloud->GetPoints(), expected);
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
      Point image;
      expected->GetPoint(static_cast<vtkIdType>(i), image.data());
      ASSERT_EQ(Transformed(tested, positions[i]), image) << i;
    }
  };
  expect(transform);
  expect(inverse);
  // A row does not end with the map.
  transform->SetTarget(MakePlanarPair(9, 583).Target);
  expect(transform);
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    const Point image = Transformed(transform, positions[i]);
    const Point preimage = Transformed(inverse, positions[i]);
    if (i % 7 == 0)
    {
      EXPECT_EQ(Differential(transform, positions[i].data()).Image, image) << i;
      EXPECT_EQ(Differential(inverse, positions[i].data()).Image, preimage) << i;
    }
  }
}

// --- Images --------------------------------------------------------------------------------------

TEST_P(TransformInEverySystem, ImagesAreResampled)
{
  // vtkImageReslice gives pixels outside its background. In the second case their position, in
  // pixels, exceeds the range of float.
  for (const double size : { 1.0, 1e-12 })
  {
    MeshPair pair = MakePlanarPair(8, 600);
    pair = { Resized(pair.Source, size), Resized(Sheared(pair.Target), size) };
    vtkNew<vtkImageData> image;
    image->SetDimensions(60, 60, 1);
    image->SetSpacing(0.2 * size, 0.2 * size, 1.0);
    image->SetOrigin(-size, -size, 0.0);
    vtkNew<vtkDoubleArray> gray;
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      const Point p = PointOf(image, i);
      gray->InsertNextValue(3.0 * p[0] / size + p[1] / size);
    }
    image->GetPointData()->SetScalars(gray);
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
      const Point p = PointOf(preimages, i);
      const bool inside = IsValid(preimages, i);
      // VTK rounds positions to about 2^-17 of a pixel.
      ASSERT_NEAR(output->GetPointData()->GetScalars()->GetTuple1(i),
        inside ? 3.0 * p[0] / size + p[1] / size : -1000.0, 1e-4);
    }
  }
}

} // namespace
