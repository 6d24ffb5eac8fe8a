// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TestChangedMeshes.cxx
/// Meshes that change in place after an update. Data computed from them must be recomputed after a
/// change, and only then.

#include "TestMeshes.h"

#include "vtkDifferentiableHomeomorphism.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkTriangularCoordinates.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <functional>

namespace
{

using namespace test_meshes;

/// Two adjacent squares with changeable diagonals. The target is not an affine image of the source,
/// so the map depends on the diagonals.
MeshPair MakeTwoSquares()
{
  const std::vector<Triangle> triangles{ { 0, 1, 4 }, { 0, 4, 3 }, { 1, 2, 5 }, { 1, 5, 4 } };
  return { MakeMesh(
             { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 }, { 2, 1, 0 } },
             triangles),
    MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 0, 1, 0 }, { 1.5, 2, 0 }, { 3, 1.5, 0 } },
      triangles) };
}

/// Replaces the diagonal of the first square in place. Only the modification time of the cell array
/// changes.
void FlipDiagonal(vtkPolyData* mesh)
{
  const Triangle first{ 0, 1, 3 };
  const Triangle second{ 1, 4, 3 };
  mesh->GetPolys()->ReplaceCellAtId(0, 3, first.data());
  mesh->GetPolys()->ReplaceCellAtId(1, 3, second.data());
  mesh->GetPolys()->Modified();
}

/// Keeps only the second square, in place: Reset keeps the arrays.
void KeepSecondSquare(vtkPolyData* mesh)
{
  const Triangle first{ 1, 2, 5 };
  const Triangle second{ 1, 5, 4 };
  mesh->GetPolys()->Reset();
  mesh->GetPolys()->InsertNextCell(3, first.data());
  mesh->GetPolys()->InsertNextCell(3, second.data());
}

const std::vector<Point> Samples{ { 0.3, 0.4, 0 }, { 0.75, 0.25, 0 }, { 0.5, 0.5, 0 },
  { 0.4, 0.1, 0 }, { 1.2, 0.7, 0 }, { 1.7, 0.4, 0 } };

/// A consumer of a pair of meshes that maps the test points repeatedly. An empty result is a
/// refusal.
class User
{
public:
  virtual ~User() = default;
  virtual std::vector<double> Ask() = 0;
  /// Calls Modified for changes that do not update any modification time.
  virtual void Touch() = 0;
};

void Append(std::vector<double>& numbers, vtkDataArray* array)
{
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < array->GetNumberOfComponents(); ++k)
    {
      const double x = array->GetComponent(i, k);
      // NaN is unequal to everything, itself included.
      numbers.push_back(std::isnan(x) ? -1e99 : x);
    }
  }
}

class FilterUser : public User
{
public:
  explicit FilterUser(const MeshPair& pair)
    : Log(Filter)
  {
    this->Filter->SetSourceData(pair.Source);
    this->Filter->SetTargetData(pair.Target);
    this->Filter->SetDataObject(MakeMesh(Samples, {}));
    this->Filter->ComputeTriangleIdOn();
  }
  std::vector<double> Ask() override
  {
    this->Log.Clear();
    this->Filter->Update();
    std::vector<double> answer;
    auto* output = vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(0));
    if (!this->Log.HasError())
    {
      Append(answer, output->GetPoints()->GetData());
      Append(answer, output->GetPointData()->GetArray("TriangleId"));
    }
    return answer;
  }
  void Touch() override { this->Filter->Modified(); }

  vtkNew<vtkDifferentiableHomeomorphism> Filter;
  Messages Log;
};

/// The filter with a single mesh: the source of the pair.
class CoordinatesUser : public User
{
public:
  explicit CoordinatesUser(const MeshPair& pair)
    : Log(Filter)
  {
    this->Filter->SetInputData(0, pair.Source);
    this->Filter->SetDataObject(MakeMesh(Samples, {}));
  }
  std::vector<double> Ask() override
  {
    this->Log.Clear();
    this->Filter->Update();
    std::vector<double> answer;
    auto* output = vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(0));
    if (!this->Log.HasError())
    {
      for (const char* name : { "TriangleId", "EdgeLabel", "EdgeParameter", "ContourParameter" })
      {
        Append(answer, output->GetPointData()->GetArray(name));
      }
      Append(answer, this->Filter->GetTriangulation()->GetCellData()->GetArray("SmallestAngle"));
      Append(answer, this->Filter->GetLines()->GetPoints()->GetData());
    }
    return answer;
  }
  void Touch() override { this->Filter->Modified(); }

  vtkNew<vtkTriangularCoordinates> Filter;
  Messages Log;
};

class TransformUser : public User
{
public:
  explicit TransformUser(const MeshPair& pair)
    : Log(Transform)
  {
    this->Transform->SetSource(pair.Source);
    this->Transform->SetTarget(pair.Target);
  }
  std::vector<double> Ask() override
  {
    this->Log.Clear();
    this->Transform->Update();
    std::vector<double> answer;
    for (const Point& surfacePoint : this->Log.HasError() ? std::vector<Point>() : Samples)
    {
      Point image;
      this->Transform->TransformPoint(surfacePoint.data(), image.data());
      answer.insert(answer.end(), image.begin(), image.end());
    }
    return answer;
  }
  void Touch() override { this->Transform->Modified(); }

  vtkNew<vtkHomeomorphismTransform> Transform;
  Messages Log;
};

enum class Kind
{
  Filter,
  Coordinates,
  Transform
};
constexpr Kind Kinds[] = { Kind::Filter, Kind::Coordinates, Kind::Transform };

std::unique_ptr<User> MakeUser(Kind kind, const MeshPair& pair)
{
  switch (kind)
  {
    case Kind::Filter:
      return std::make_unique<FilterUser>(pair);
    case Kind::Coordinates:
      return std::make_unique<CoordinatesUser>(pair);
    default:
      return std::make_unique<TransformUser>(pair);
  }
}

const char* NameOf(Kind kind)
{
  return kind == Kind::Filter ? "filter"
                              : (kind == Kind::Coordinates ? "coordinates" : "transform");
}

/// Copies of the meshes in new objects.
MeshPair Anew(const MeshPair& pair)
{
  MeshPair copy;
  for (auto mesh : { &MeshPair::Source, &MeshPair::Target })
  {
    copy.*mesh = vtkSmartPointer<vtkPolyData>::New();
    (copy.*mesh)->DeepCopy(pair.*mesh);
  }
  return copy;
}

/// Changes meshes after a consumer has used them. The consumer must then give the same result as a
/// new one.
void ExpectNoticed(
  const std::function<void(const MeshPair&)>& change, bool touch = false, bool changesSource = true)
{
  for (const Kind kind : Kinds)
  {
    if (kind == Kind::Coordinates && !changesSource)
    {
      continue;
    }
    SCOPED_TRACE(NameOf(kind));
    const MeshPair pair = MakeTwoSquares();
    const auto user = MakeUser(kind, pair);
    const std::vector<double> before = user->Ask();
    ASSERT_FALSE(before.empty());
    change(pair);
    if (touch)
    {
      user->Touch();
    }
    const std::vector<double> after = user->Ask();
    EXPECT_EQ(after, MakeUser(kind, Anew(pair))->Ask());
    EXPECT_NE(after, before);
    // The result stays the same. (After a failed update a filter does not report again.)
    if (!after.empty())
    {
      EXPECT_EQ(user->Ask(), after);
    }
  }
}

TEST(ChangedMeshes, CellsReplacedInPlace)
{
  ExpectNoticed([](const MeshPair& pair) {
    FlipDiagonal(pair.Source);
    FlipDiagonal(pair.Target);
  });
}

TEST(ChangedMeshes, CellsReplacedInOneMeshAreRefused)
{
  // Source and target are no longer isomorphic.
  for (const auto mesh : { &MeshPair::Source, &MeshPair::Target })
  {
    for (const Kind kind : { Kind::Filter, Kind::Transform })
    {
      SCOPED_TRACE(NameOf(kind));
      const MeshPair pair = MakeTwoSquares();
      const auto user = MakeUser(kind, pair);
      ASSERT_FALSE(user->Ask().empty());
      FlipDiagonal(pair.*mesh);
      EXPECT_TRUE(user->Ask().empty());
    }
  }
}

TEST(ChangedMeshes, CellsMadeInvalidInPlaceAreRefused)
{
  ExpectNoticed([](const MeshPair& pair) {
    for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
    {
      // A repeated corner.
      const Triangle triangle{ 0, 4, 4 };
      mesh->GetPolys()->ReplaceCellAtId(1, 3, triangle.data());
      mesh->GetPolys()->Modified();
    }
  });
}

TEST(ChangedMeshes, FewerCellsAfterReset)
{
  ExpectNoticed([](const MeshPair& pair) {
    for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
    {
      KeepSecondSquare(mesh);
      mesh->GetPolys()->Modified();
    }
  });
}

TEST(ChangedMeshes, FewerCellsAfterResetWithoutModifiedTime)
{
  // Only the number of cells has changed when the consumer updates.
  ExpectNoticed(
    [](const MeshPair& pair) {
      for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
      {
        KeepSecondSquare(mesh);
      }
    },
    true);
}

TEST(ChangedMeshes, FewerCellsInOneMeshAreRefused)
{
  for (const auto mesh : { &MeshPair::Source, &MeshPair::Target })
  {
    for (const Kind kind : { Kind::Filter, Kind::Transform })
    {
      SCOPED_TRACE(NameOf(kind));
      const MeshPair pair = MakeTwoSquares();
      const auto user = MakeUser(kind, pair);
      ASSERT_FALSE(user->Ask().empty());
      KeepSecondSquare(pair.*mesh);
      (pair.*mesh)->GetPolys()->Modified();
      EXPECT_TRUE(user->Ask().empty());
    }
  }
}

TEST(ChangedMeshes, MorePointsInOneMeshAreRefused)
{
  for (const auto mesh : { &MeshPair::Source, &MeshPair::Target })
  {
    for (const Kind kind : { Kind::Filter, Kind::Transform })
    {
      SCOPED_TRACE(NameOf(kind));
      const MeshPair pair = MakeTwoSquares();
      const auto user = MakeUser(kind, pair);
      ASSERT_FALSE(user->Ask().empty());
      // InsertNextPoint does not change any modification time.
      (pair.*mesh)->GetPoints()->InsertNextPoint(9.0, 9.0, 0.0);
      user->Touch();
      EXPECT_TRUE(user->Ask().empty());
    }
  }
}

TEST(ChangedMeshes, ARefusedMeshRepairedInPlaceIsAccepted)
{
  // A refusal is cached like a result and must be invalidated like one.
  for (const Kind kind : Kinds)
  {
    SCOPED_TRACE(NameOf(kind));
    const MeshPair pair = MakeTwoSquares();
    const Triangle broken{ 0, 4, 4 };
    const Triangle whole{ 0, 4, 3 };
    for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
    {
      mesh->GetPolys()->ReplaceCellAtId(1, 3, broken.data());
    }
    const auto user = MakeUser(kind, pair);
    EXPECT_TRUE(user->Ask().empty());
    for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
    {
      mesh->GetPolys()->ReplaceCellAtId(1, 3, whole.data());
      mesh->GetPolys()->Modified();
    }
    EXPECT_EQ(user->Ask(), MakeUser(kind, MakeTwoSquares())->Ask());
  }
}

TEST(ChangedMeshes, PointsMovedInPlace)
{
  ExpectNoticed([](const MeshPair& pair) {
    pair.Source->GetPoints()->SetPoint(4, 1.1, 0.9, 0.0);
    pair.Source->GetPoints()->Modified();
  });
  ExpectNoticed(
    [](const MeshPair& pair) {
      pair.Target->GetPoints()->SetPoint(4, 1.1, 0.9, 0.0);
      pair.Target->GetPoints()->Modified();
    },
    false, false);
  // Through the array of the points.
  ExpectNoticed([](const MeshPair& pair) {
    vtkDataArray* coordinates = pair.Source->GetPoints()->GetData();
    coordinates->SetComponent(4, 0, 1.1);
    coordinates->Modified();
  });
}

TEST(ChangedMeshes, CellsHiddenInPlace)
{
  ExpectNoticed([](const MeshPair& pair) {
    pair.Source->AllocateCellGhostArray()->SetValue(0, vtkDataSetAttributes::HIDDENCELL);
    pair.Source->GetCellGhostArray()->Modified();
  });
}

/// Changes to the meshes and options of a filter, and whether the meshes are read again.
class Rebuilds : public ::testing::Test
{
protected:
  MeshPair Pair = MakeTwoSquares();
  FilterUser User{ Pair };

  /// The number of times the meshes are read in another update.
  vtkIdType BuildsOfUpdate()
  {
    const vtkIdType before = this->User.Filter->GetNumberOfMeshBuilds();
    EXPECT_FALSE(this->User.Ask().empty());
    return this->User.Filter->GetNumberOfMeshBuilds() - before;
  }
};

TEST_F(Rebuilds, OncePerChange)
{
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  EXPECT_EQ(this->BuildsOfUpdate(), 0);
  FlipDiagonal(this->Pair.Source);
  FlipDiagonal(this->Pair.Target);
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  EXPECT_EQ(this->BuildsOfUpdate(), 0);
  this->Pair.Source->GetPoints()->Modified();
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  KeepSecondSquare(this->Pair.Source);
  KeepSecondSquare(this->Pair.Target);
  this->Pair.Source->GetPolys()->Modified();
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
}

TEST_F(Rebuilds, NoneForDataOnTheMeshes)
{
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  for (vtkPolyData* mesh : { this->Pair.Source.Get(), this->Pair.Target.Get() })
  {
    const vtkNew<vtkDoubleArray> numbers;
    numbers->SetName("Numbers");
    numbers->SetNumberOfTuples(mesh->GetNumberOfPoints());
    numbers->FillValue(1.0);
    mesh->GetPointData()->SetScalars(numbers);
    EXPECT_EQ(this->BuildsOfUpdate(), 0);
    numbers->FillValue(2.0);
    numbers->Modified();
    EXPECT_EQ(this->BuildsOfUpdate(), 0);
    const vtkNew<vtkDoubleArray> perCell;
    perCell->SetName("PerCell");
    perCell->SetNumberOfTuples(mesh->GetNumberOfCells());
    perCell->FillValue(3.0);
    mesh->GetCellData()->AddArray(perCell);
    mesh->Modified();
    EXPECT_EQ(this->BuildsOfUpdate(), 0);
  }
}

TEST_F(Rebuilds, NoneForAnotherObjectWithTheSameArrays)
{
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  const vtkNew<vtkPolyData> same;
  same->ShallowCopy(this->Pair.Source);
  this->User.Filter->SetSourceData(same);
  EXPECT_EQ(this->BuildsOfUpdate(), 0);
}

TEST_F(Rebuilds, OncePerChangeOfOptions)
{
  auto* filter = this->User.Filter.Get();
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  filter->SetCoordinateSystemToLinear();
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  filter->MaskInvalidTrianglesOn();
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  filter->SetCenterPoint(vtkDifferentiableHomeomorphism::INCENTER);
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  filter->SetDiscordantTriangles(vtkDifferentiableHomeomorphism::USE_LINEAR);
  EXPECT_EQ(this->BuildsOfUpdate(), 1);
  // These options do not affect the map itself.
  filter->ComputeJacobianOn();
  filter->SetTolerance(0.1);
  filter->BlankOutsideOff();
  filter->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION);
  EXPECT_EQ(this->BuildsOfUpdate(), 0);
  filter->InverseOn();
  EXPECT_EQ(this->BuildsOfUpdate(), 0);
}

TEST(ChangedMeshes, OptionsOfAllClasses)
{
  // Linear and Smooth differ in the two squares.
  const MeshPair pair = MakeTwoSquares();
  FilterUser filter(pair);
  CoordinatesUser coordinates(pair);
  TransformUser transform(pair);
  const auto smooth = std::make_tuple(filter.Ask(), coordinates.Ask(), transform.Ask());
  filter.Filter->SetCoordinateSystemToLinear();
  coordinates.Filter->SetCoordinateSystemToLinear();
  transform.Transform->SetCoordinateSystemToLinear();
  const auto linear = std::make_tuple(filter.Ask(), coordinates.Ask(), transform.Ask());
  EXPECT_NE(std::get<0>(smooth), std::get<0>(linear));
  EXPECT_NE(std::get<1>(smooth), std::get<1>(linear));
  EXPECT_NE(std::get<2>(smooth), std::get<2>(linear));
  filter.Filter->SetCoordinateSystemToSmooth();
  coordinates.Filter->SetCoordinateSystemToSmooth();
  transform.Transform->SetCoordinateSystemToSmooth();
  EXPECT_EQ(smooth, std::make_tuple(filter.Ask(), coordinates.Ask(), transform.Ask()));
}

TEST(ChangedMeshes, CopiesAndInversesOfATransformFollow)
{
  // They share the data computed by the transform until it changes.
  const MeshPair pair = MakeTwoSquares();
  TransformUser user(pair);
  ASSERT_FALSE(user.Ask().empty());
  vtkAbstractTransform* inverse = user.Transform->GetInverse();
  const vtkNew<vtkHomeomorphismTransform> copy;
  copy->DeepCopy(user.Transform);
  copy->Update();
  inverse->Update();
  FlipDiagonal(pair.Source);
  FlipDiagonal(pair.Target);
  const MeshPair anew = Anew(pair);
  TransformUser fresh(anew);
  for (const Point& surfacePoint : Samples)
  {
    Point expected;
    Point image;
    Point back;
    fresh.Transform->TransformPoint(surfacePoint.data(), expected.data());
    copy->TransformPoint(surfacePoint.data(), image.data());
    EXPECT_EQ(image, expected);
    inverse->TransformPoint(expected.data(), back.data());
    Point expectedBack;
    fresh.Transform->GetInverse()->TransformPoint(expected.data(), expectedBack.data());
    EXPECT_EQ(back, expectedBack);
  }
}

} // namespace
