// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The map is rebuilt if the meshes or the options change, in place or not, and only then, in all
// classes that keep a map.

#include "Fixtures/FilterRuns.h"

#include "vtkTransformPolyDataFilter.h"
#include "vtkWeakPointer.h"

#include <memory>

namespace
{

using namespace fixtures;

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

const std::vector<Point> Samples{ { 0.3, 0.4, 0 }, { 0.75, 0.25, 0 }, { 0.5, 0.5, 0 },
  { 0.4, 0.1, 0 }, { 1.2, 0.7, 0 }, { 1.7, 0.4, 0 } };

void MoveThePoint(vtkPolyData* mesh)
{
  MovePoint(mesh, 4, { 1.1, 0.9, 0.0 });
}

void MoveThePointInItsArray(vtkPolyData* mesh)
{
  mesh->GetPoints()->GetData()->SetComponent(4, 0, 1.05);
  mesh->GetPoints()->GetData()->Modified();
}

/// Replaces the triangles of the first square.
void ReplaceTriangles(vtkPolyData* mesh, const Triangle& first, const Triangle& second)
{
  mesh->GetPolys()->ReplaceCellAtId(0, 3, first.data());
  mesh->GetPolys()->ReplaceCellAtId(1, 3, second.data());
  mesh->GetPolys()->Modified();
}

void FlipDiagonal(vtkPolyData* mesh)
{
  ReplaceTriangles(mesh, { 0, 1, 3 }, { 1, 4, 3 });
}

/// The second triangle has a repeated corner.
void Break(vtkPolyData* mesh)
{
  ReplaceTriangles(mesh, { 0, 1, 4 }, { 0, 4, 4 });
}

using Arrays = std::vector<vtkDataArray*>;

/// A user of a pair of meshes that asks the same question repeatedly. An empty answer is a refusal.
struct User
{
  const char* Name;
  std::function<std::vector<double>()> Ask;
  /// Calls Modified for changes that do not update any modification time.
  std::function<void()> Touch;
};

template <typename Object>
User MakeUser(const char* name, Object object, const std::function<Arrays()>& collect)
{
  auto messages = std::make_shared<Messages>(object.Get());
  const auto ask = [object, messages, collect]() {
    messages->Clear();
    object->Update();
    std::vector<double> answer;
    for (vtkDataArray* array : messages->HasError() ? Arrays{} : collect())
    {
      for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
      {
        const double x = array->GetVariantValue(i).ToDouble();
        // NaN is unequal to everything, itself included.
        answer.push_back(std::isnan(x) ? -1e99 : x);
      }
    }
    return answer;
  };
  return { name, ask, [object]() { object->Modified(); } };
}

User MakeFilterUser(const MeshPair& pair)
{
  const auto filter = MakeFilter(Smooth, pair, MakeCloud(Samples));
  filter->ComputeTriangleIdOn();
  return MakeUser("filter", filter, [filter]() -> Arrays {
    auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
    return { output->GetPoints()->GetData(), PointArray(output, "TriangleId") };
  });
}

User MakeCoordinatesUser(const MeshPair& pair)
{
  const auto filter = MakeCoordinates(Smooth, pair.Source, MakeCloud(Samples));
  filter->GenerateLinesOn();
  return MakeUser("coordinates", filter, [filter]() -> Arrays {
    auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
    return { PointArray(output, "TriangleId"), PointArray(output, "EdgeLabel"),
      PointArray(output, "EdgeParameter"), PointArray(output, "ContourParameter"),
      CellArray(filter->GetTriangulation(), "SmallestAngle"),
      filter->GetLines()->GetPoints()->GetData() };
  });
}

std::vector<Point> Transformed(vtkAbstractTransform* transform)
{
  std::vector<Point> images;
  for (const Point& p : Samples)
  {
    images.push_back(fixtures::Transformed(transform, p));
  }
  return images;
}

/// Through a filter of VTK, which must notice what changes.
User MakeTransformUser(const MeshPair& pair)
{
  const auto transform = MakeTransform(Smooth, pair);
  const auto filter = vtkSmartPointer<vtkTransformPolyDataFilter>::New();
  filter->SetInputData(MakeCloud(Samples));
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->SetTransform(transform);
  return MakeUser("transform", transform, [transform, filter]() -> Arrays {
    EXPECT_EQ(PointsOf(Output(filter.Get())), Transformed(transform));
    return { filter->GetOutput()->GetPoints()->GetData() };
  });
}

using MakeAUser = User (*)(const MeshPair&);

using ChangedMeshes = ::testing::TestWithParam<MakeAUser>;

INSTANTIATE_TEST_SUITE_P(Users, ChangedMeshes,
  ::testing::Values(&MakeFilterUser, &MakeCoordinatesUser, &MakeTransformUser),
  [](const ::testing::TestParamInfo<MakeAUser>& one) { return one.param(MakeTwoSquares()).Name; });

TEST_P(ChangedMeshes, GiveTheAnswersOfNewMeshes)
{
  // One of two meshes or both of them change. If one does so alone, the pair is often refused.
  for (const unsigned int which : { 1u, 2u, 3u })
  {
    SCOPED_TRACE(which);
    const MeshPair pair = MakeTwoSquares();
    const User user = GetParam()(pair);
    std::set<std::vector<double>> answers{ user.Ask() };
    const std::vector<std::function<void(vtkPolyData*)>> changes{ MoveThePoint,
      MoveThePointInItsArray, FlipDiagonal, Break,
      [](vtkPolyData* mesh) {
        ReplaceTriangles(mesh, { 0, 1, 4 }, { 0, 4, 3 });
      },
      [](vtkPolyData* mesh) {
        mesh->AllocateCellGhostArray()->SetValue(0, vtkDataSetAttributes::HIDDENCELL);
        mesh->GetCellGhostArray()->Modified();
      },
      // These do not change any modification time.
      [](vtkPolyData* mesh) { mesh->GetPoints()->InsertNextPoint(9.0, 9.0, 0.0); },
      [](vtkPolyData* mesh) {
        mesh->GetPolys()->Reset();
        mesh->GetPolys()->InsertNextCell({ 1, 2, 5 });
        mesh->GetPolys()->InsertNextCell({ 1, 5, 4 });
      } };
    for (const auto& change : changes)
    {
      if ((which & 1u) != 0)
      {
        change(pair.Source);
      }
      if ((which & 2u) != 0)
      {
        change(pair.Target);
      }
      user.Touch();
      const std::vector<double> answer = user.Ask();
      EXPECT_EQ(answer, GetParam()(CopyOf(pair)).Ask());
      // The answer stays the same. (After a failed update a filter does not report again.)
      EXPECT_TRUE(answer.empty() || user.Ask() == answer);
      answers.insert(answer);
    }
    // The target is nothing to the coordinates of the source.
    const bool isUsed = which != 2 || GetParam() != &MakeCoordinatesUser;
    EXPECT_EQ(answers.size() > 3, isUsed);
    EXPECT_EQ(answers.count({}) > 0, isUsed);
  }
}

TEST(HomeomorphismCache, CopiesAndInversesOfATransformFollow)
{
  // They share what the transform has computed until the meshes change.
  const MeshPair pair = MakeTwoSquares();
  const auto transform = MakeTransform(Smooth, pair);
  vtkAbstractTransform* inverse = transform->GetInverse();
  vtkNew<vtkHomeomorphismTransform> copy;
  copy->DeepCopy(transform);
  copy->Update();
  inverse->Update();
  FlipDiagonal(pair.Source);
  FlipDiagonal(pair.Target);
  const auto fresh = MakeTransform(Smooth, CopyOf(pair));
  EXPECT_EQ(Transformed(copy), Transformed(fresh));
  EXPECT_EQ(Transformed(inverse), Transformed(fresh->GetInverse()));
}

class Builds : public ::testing::Test
{
protected:
  Builds() { this->ExpectNewBuilds(1, "first"); }

  void ExpectNewBuilds(vtkIdType builds, const char* change)
  {
    const vtkIdType before = this->Filter->GetNumberOfMeshBuilds();
    this->Filter->Update();
    EXPECT_EQ(this->Filter->GetNumberOfMeshBuilds() - before, builds) << change;
    this->Filter->Modified();
    this->Filter->Update();
    EXPECT_EQ(this->Filter->GetNumberOfMeshBuilds() - before, builds) << change;
  }

  MeshPair Pair = MakeTwoSquares();
  vtkSmartPointer<vtkDifferentiableHomeomorphism> Filter =
    MakeFilter(Smooth, Pair, MakeCloud(Samples));
};

TEST_F(Builds, OneForEachChangeOfAMesh)
{
  for (vtkPolyData* mesh : { this->Pair.Source.Get(), this->Pair.Target.Get() })
  {
    MoveThePoint(mesh);
    this->ExpectNewBuilds(1, "a point");
    MoveThePointInItsArray(mesh);
    this->ExpectNewBuilds(1, "the array of points");
    // Only the data object is marked as modified.
    static_cast<double*>(mesh->GetPoints()->GetVoidPointer(0))[12] = 1.15;
    mesh->Modified();
    this->ExpectNewBuilds(1, "coordinates overwritten in place");
    vtkNew<vtkPoints> points;
    points->DeepCopy(mesh->GetPoints());
    mesh->SetPoints(points);
    this->ExpectNewBuilds(1, "other points");
    vtkNew<vtkCellArray> polygons;
    polygons->DeepCopy(mesh->GetPolys());
    mesh->SetPolys(polygons);
    this->ExpectNewBuilds(1, "other polygons");
    AddVerticesAndLines(mesh, 1, 0);
    this->ExpectNewBuilds(1, "vertices, which shift the cell ids");
    const auto ghosts = MakeGhosts(6, {}, 0);
    mesh->GetPointData()->AddArray(ghosts);
    this->ExpectNewBuilds(1, "ghosts");
    ghosts->SetValue(0, vtkDataSetAttributes::HIDDENPOINT);
    ghosts->Modified();
    this->ExpectNewBuilds(1, "a hidden point");
  }
  this->Filter->SetSourceData(MakeTwoSquares().Source);
  this->ExpectNewBuilds(1, "an equal mesh of other arrays");
}

TEST_F(Builds, NoneForAttributesAndCopies)
{
  for (vtkPolyData* mesh : { this->Pair.Source.Get(), this->Pair.Target.Get() })
  {
    const auto values = RandomArray("Values", 1, mesh->GetNumberOfPoints(), 1);
    mesh->GetPointData()->SetScalars(values);
    mesh->GetCellData()->AddArray(RandomArray("OfCells", 1, mesh->GetNumberOfCells(), 2));
    mesh->Modified();
    this->ExpectNewBuilds(0, "attributes");
    values->FillValue(2.0);
    values->Modified();
    this->ExpectNewBuilds(0, "a changed attribute");
  }
  // Pipelines pass shallow copies on.
  vtkNew<vtkPolyData> same;
  same->ShallowCopy(this->Pair.Source);
  this->Filter->SetSourceData(same);
  this->ExpectNewBuilds(0, "a shallow copy");
}

TEST_F(Builds, OneForEachOptionOfTheMap)
{
  using Algorithm = vtkDifferentiableHomeomorphism;
  using Change = std::function<void(Algorithm*)>;
  const std::vector<Change> changes{ &Algorithm::SetCoordinateSystemToLinear,
    &Algorithm::SetCoordinateSystemToContour,
    [](Algorithm* f) { f->SetCenterPoint(Algorithm::INCENTER); },
    [](Algorithm* f) { f->SetDiscordantTriangles(Algorithm::REFUSE); },
    &Algorithm::SetCoordinateSystemToSmooth, &Algorithm::MaskInvalidTrianglesOn,
    // These do not affect the map itself, but the output.
    [](Algorithm* f) { f->SetTolerance(0.125); }, &Algorithm::ComputeTriangleIdOn,
    &Algorithm::ComputeJacobianOn, &Algorithm::ComputeJacobianDeterminantOn,
    &Algorithm::TransformActiveAttributesOff, &Algorithm::TransformAllInputVectorsOn,
    [](Algorithm* f) { f->SetAttributeTransformation("Any", Algorithm::NO_TRANSFORMATION); },
    &Algorithm::ClearAttributeTransformations, &Algorithm::BlankOutsideOff,
    [](Algorithm* f) { f->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION); },
    &Algorithm::InverseOn,
    [](Algorithm* f) {
      f->SetDataObject(MakeCloud({ { 0.5, 0.5, 0.0 } }));
    } };
  for (std::size_t i = 0; i < changes.size(); ++i)
  {
    SCOPED_TRACE(i);
    const vtkMTimeType before = Output(this->Filter)->GetMTime();
    changes[i](this->Filter);
    const vtkMTimeType after = Output(this->Filter)->GetMTime();
    EXPECT_GT(after, before);
    // Another update does nothing.
    EXPECT_EQ(Output(this->Filter)->GetMTime(), after);
    EXPECT_EQ(this->Filter->GetNumberOfMeshBuilds(), std::min<vtkIdType>(i + 2, 7));
  }
}

TEST_F(Builds, NoneForTheSameRefusal)
{
  Break(this->Pair.Source);
  Break(this->Pair.Target);
  Messages messages(this->Filter);
  this->ExpectNewBuilds(1, "broken");
  EXPECT_TRUE(messages.HasError());
  this->ExpectNewBuilds(0, "still broken");
}

TEST_F(Builds, KeepNoMeshAlive)
{
  vtkWeakPointer<vtkPolyData> source = this->Pair.Source.Get();
  vtkWeakPointer<vtkPoints> points = this->Pair.Source->GetPoints();
  this->Filter->SetSourceData(MakeTwoSquares().Source);
  this->Filter->Update();
  this->Pair = {};
  EXPECT_FALSE(source);
  EXPECT_FALSE(points);
}

} // namespace
