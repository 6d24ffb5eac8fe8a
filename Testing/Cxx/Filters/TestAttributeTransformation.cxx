// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Transformation of vectors, normals, tensors and gradients by vtkDifferentiableHomeomorphism.

#include "Fixtures/FilterRuns.h"

#include "vtkShortArray.h"
#include "vtkUnstructuredGrid.h"

namespace
{

using namespace fixtures;

using AttributesInEverySystem = TestInEverySystem;

INSTANTIATE_TEST_SUITE_P(
  All, AttributesInEverySystem, ::testing::ValuesIn(AllSystems()), NameOfSystem);

/// A tensor of 9 components, or a symmetric one in VTK's order XX, YY, ZZ, XY, YZ, XZ.
Matrix TensorOf(vtkDataArray* array, vtkIdType i)
{
  double t[9];
  array->GetTuple(i, t);
  const Matrix symmetric{ { { t[0], t[3], t[5] }, { t[3], t[1], t[4] }, { t[5], t[4], t[2] } } };
  return array->GetNumberOfComponents() == 9 ? MatrixOf(array, i) : symmetric;
}

/// Tuples of the output are those of the input transformed by a matrix.
struct Transformation
{
  vtkDataSetAttributes* Input;
  vtkDataSetAttributes* Output;
  vtkIdType Id;
  double Bound;

  void ExpectVector(const char* name, const Matrix& a, bool isNormal = false) const
  {
    const Point image = a * VectorOf(this->Input->GetArray(name), this->Id);
    EXPECT_LE(
      Distance(VectorOf(this->Output->GetArray(name), this->Id), isNormal ? Unit(image) : image),
      this->Bound * (1.0 + Norm(image)))
      << name;
  }
  void ExpectTensor(const char* name, const Matrix& a) const
  {
    const Matrix before = TensorOf(this->Input->GetArray(name), this->Id);
    EXPECT_LE(
      Distance(TensorOf(this->Output->GetArray(name), this->Id), a * before * Transposed(a)),
      this->Bound * Norm(before) * Norm(a) * Norm(a))
      << name;
  }
};

/// Active attributes.
using Attributes = vtkDataSetAttributes;
const std::vector<std::pair<int, const char*>> Roles{ { Attributes::SCALARS, "Scalars" },
  { Attributes::VECTORS, "Vectors" }, { Attributes::NORMALS, "Normals" },
  { Attributes::TENSORS, "Tensors" }, { Attributes::TCOORDS, "TextureCoordinates" } };

/// Points inside the triangles of a mesh, with an array of each kind.
vtkSmartPointer<vtkPolyData> MakeCloudWithArrays(vtkPolyData* mesh, std::uint64_t seed)
{
  constexpr vtkIdType count = 3000;
  const auto cloud = MakeCloud(mesh, InnerSamples(mesh, count, seed, 1e-3));
  vtkPointData* pointData = cloud->GetPointData();
  for (const auto& [name, components] : std::vector<std::pair<const char*, int>>{ { "Scalars", 3 },
         { "Vectors", 3 }, { "Normals", 3 }, { "Tensors", 9 }, { "TextureCoordinates", 3 },
         { "Displacement", 3 }, { "Stress", 6 }, { "Pair", 2 }, { "Single", 1 } })
  {
    pointData->AddArray(RandomArray(name, components, count, ++seed));
  }
  pointData->AddArray(RandomArray<vtkFloatArray>("FloatVelocity", 3, count, seed + 1));
  pointData->AddArray(RandomArray<vtkIntArray>("Counts", 3, count, seed + 2));
  for (const auto& [role, name] : Roles)
  {
    pointData->SetActiveAttribute(name, role);
  }
  for (vtkIdType i = 0; i < count; ++i)
  {
    pointData->GetNormals()->SetTuple(i, Unit(VectorOf(pointData->GetNormals(), i)).data());
  }
  return cloud;
}

TEST_P(AttributesInEverySystem, FollowTheJacobian)
{
  using Filter = vtkDifferentiableHomeomorphism;
  for (const auto& [kind, pair] : AllPairings(6, 1, 410))
  {
    SCOPED_TRACE(kind);
    const auto cloud = MakeCloudWithArrays(pair.Source, 80);
    const vtkIdType count = cloud->GetNumberOfPoints();
    for (const auto& [name, components] : std::vector<std::pair<const char*, int>>{
           { "Gradient", 3 }, { "Normal", 3 }, { "Metric9", 9 }, { "Metric6", 6 } })
    {
      cloud->GetPointData()->AddArray(RandomArray(name, components, count, 81));
    }
    const auto filter = MakeFilter(GetParam(), pair, cloud);
    filter->ComputeJacobianOn();
    filter->TransformAllInputVectorsOn();
    for (const char* name : { "Gradient", "Metric9", "Metric6" })
    {
      filter->SetAttributeTransformation(name, Filter::GRADIENT_TRANSFORMATION);
    }
    filter->SetAttributeTransformation("Normal", Filter::NORMAL_TRANSFORMATION);
    filter->SetAttributeTransformation("Counts", Filter::TANGENT_TRANSFORMATION);
    vtkPointSet* output = Output(filter);
    for (vtkIdType i = 0; i < count; ++i)
    {
      const Matrix j = JacobianOf(output, i);
      const Matrix inverseTransposed = Transposed(Inverted(j));
      const double bound = 1e-11 * Norm(j) * Norm(inverseTransposed);
      Transformation transformation{ cloud->GetPointData(), output->GetPointData(), i, bound };
      for (const char* name : { "Vectors", "Displacement", "Counts" })
      {
        transformation.ExpectVector(name, j);
      }
      transformation.ExpectVector("Gradient", inverseTransposed);
      transformation.ExpectVector("Normals", inverseTransposed, true);
      transformation.ExpectVector("Normal", inverseTransposed, true);
      transformation.ExpectTensor("Tensors", j);
      transformation.ExpectTensor("Stress", j);
      transformation.ExpectTensor("Metric9", inverseTransposed);
      transformation.ExpectTensor("Metric6", inverseTransposed);
      transformation.Bound = 1e-6 * Norm(j) * Norm(inverseTransposed);
      transformation.ExpectVector("FloatVelocity", j);
    }
  }
}

TEST_P(AttributesInEverySystem, OfCellsAreTransformedAtTheirCenters)
{
  for (const auto& [kind, pair] : AllPairings(6, 2, 450))
  {
    SCOPED_TRACE(kind);
    // Lines and polygons inside triangles, and one cell without points between them.
    Random random(102);
    vtkNew<vtkUnstructuredGrid> data;
    std::vector<Point> positions;
    std::vector<Point> means;
    for (int i = 0; i < 201; ++i)
    {
      const int type = i < 100 ? VTK_POLY_LINE : i > 100 ? VTK_POLYGON : VTK_EMPTY_CELL;
      const int size = i == 100 ? 0 : 3 + random.Below(3);
      const vtkIdType triangle = random.Below(pair.Source->GetNumberOfCells());
      std::vector<vtkIdType> ids;
      means.push_back({});
      for (int k = 0; k < size; ++k)
      {
        ids.push_back(static_cast<vtkIdType>(positions.size()));
        positions.push_back(PositionOf(pair.Source, { triangle, random.Weights(1e-3) }));
        means.back() = means.back() + (1.0 / size) * positions.back();
      }
      data->InsertNextCell(type, size, ids.data());
    }
    data->SetPoints(MakeCloud(positions)->GetPoints());
    vtkCellData* before = data->GetCellData();
    before->SetVectors(RandomArray("Flux", 3, 201, 103));
    before->SetTensors(RandomArray("Tensor", 9, 201, 104));
    before->AddArray(RandomArray("Other", 3, 201, 105));
    before->AddArray(RandomArray("Gradient", 3, 201, 106));
    const auto filter = MakeFilter(GetParam(), pair, data);
    filter->SetAttributeTransformation(
      "Gradient", vtkDifferentiableHomeomorphism::GRADIENT_TRANSFORMATION);
    vtkCellData* after = Output(filter)->GetCellData();
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);

    const auto atMeans = MakeFilter(GetParam(), pair, MakeCloud(means));
    atMeans->ComputeJacobianOn();
    for (vtkIdType i = 0; i < 201; ++i)
    {
      if (i == 100)
      {
        const Point flux = VectorOf(after->GetVectors(), i);
        EXPECT_TRUE(std::isnan(flux[0]) && std::isnan(flux[1]) && std::isnan(flux[2]));
        continue;
      }
      const Matrix j = JacobianOf(Output(atMeans), i);
      const double bound = 1e-9 * Norm(j) * Norm(Inverted(j));
      const Transformation transformation{ before, after, i, bound };
      transformation.ExpectVector("Flux", j);
      transformation.ExpectVector("Gradient", Transposed(Inverted(j)));
      transformation.ExpectTensor("Tensor", j);
    }
    EXPECT_TRUE(IsSame(after->GetArray("Other"), before->GetArray("Other")));
    EXPECT_STREQ(after->GetVectors()->GetName(), "Flux");
    EXPECT_STREQ(after->GetTensors()->GetName(), "Tensor");
    EXPECT_FALSE(after->GetArray("Jacobian"));
  }
}

TEST(AttributeTransformation, CellsMaySpanTrianglesOfASurface)
{
  // The points of the four parts of a triangle, whose mean lies well off the surface.
  const MeshPair pair = MakeClosedPair(2, 455);
  const std::vector<Triangle> triangles = TrianglesOf(pair.Source);
  vtkNew<vtkPolyData> data;
  data->SetPoints(pair.Source->GetPoints());
  data->SetPolys(vtkNew<vtkCellArray>());
  for (std::size_t t = 0; t < triangles.size(); t += 4)
  {
    data->GetPolys()->InsertNextCell(12, triangles[t].data());
  }
  data->GetCellData()->SetVectors(RandomArray("Flux", 3, data->GetNumberOfCells(), 108));
  const auto filter = MakeFilter(Smooth, pair, data);
  vtkDataArray* mapped = Output(filter)->GetCellData()->GetVectors();
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    ASSERT_GT(Norm(VectorOf(mapped, i)), 0.0);
  }
}

class WhichArrays : public ::testing::Test
{
protected:
  /// Names of the arrays that differ between input and output.
  std::string Changed()
  {
    vtkPointSet* output = Output(this->Filter);
    std::string names;
    for (int i = 0; i < this->Cloud->GetPointData()->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* before = this->Cloud->GetPointData()->GetArray(i);
      vtkDataArray* after = PointArray(output, before->GetName());
      EXPECT_TRUE(after) << before->GetName();
      if (!IsSame(before, after))
      {
        names += std::string(names.empty() ? "" : " ") + before->GetName();
      }
    }
    return names;
  }

  using Algorithm = vtkDifferentiableHomeomorphism;
  const MeshPair Pair = MakePlanarPair(6, 460);
  const vtkSmartPointer<vtkPolyData> Cloud = MakeCloudWithArrays(this->Pair.Source, 110);
  const vtkSmartPointer<vtkDifferentiableHomeomorphism> Filter =
    MakeFilter(Smooth, this->Pair, this->Cloud);
};

TEST_F(WhichArrays, ActiveOnesOrAllVectors)
{
  EXPECT_EQ(this->Changed(), "Vectors Normals Tensors");
  // Texture coordinates, active scalars, integers and arrays of other sizes are not transformed.
  this->Filter->TransformAllInputVectorsOn();
  EXPECT_EQ(this->Changed(), "Vectors Normals Tensors Displacement Stress FloatVelocity");
  this->Filter->TransformActiveAttributesOff();
  EXPECT_EQ(this->Changed(), "");
  this->Filter->TransformAllInputVectorsOff();
  EXPECT_EQ(this->Changed(), "");
  this->Filter->SetAttributeTransformation("Displacement", Algorithm::TANGENT_TRANSFORMATION);
  EXPECT_EQ(this->Changed(), "Displacement");
}

TEST_F(WhichArrays, NamedOnes)
{
  this->Filter->SetAttributeTransformation("Vectors", Algorithm::NO_TRANSFORMATION);
  EXPECT_EQ(this->Changed(), "Normals Tensors");
  this->Filter->SetAttributeTransformation("Scalars", Algorithm::TANGENT_TRANSFORMATION);
  EXPECT_EQ(this->Changed(), "Scalars Normals Tensors");
  this->Filter->SetAttributeTransformation(
    "TextureCoordinates", Algorithm::GRADIENT_TRANSFORMATION);
  this->Filter->SetAttributeTransformation("Counts", Algorithm::TANGENT_TRANSFORMATION);
  EXPECT_EQ(this->Changed(), "Scalars Normals Tensors TextureCoordinates Counts");
  // Arrays without the components of a vector or tensor pass, and so do tensors declared as
  // normals.
  for (const char* name : { "Pair", "Single" })
  {
    this->Filter->SetAttributeTransformation(name, Algorithm::TANGENT_TRANSFORMATION);
  }
  this->Filter->SetAttributeTransformation("Stress", Algorithm::NORMAL_TRANSFORMATION);
  this->Filter->SetAttributeTransformation("No such array", Algorithm::TANGENT_TRANSFORMATION);
  EXPECT_EQ(this->Changed(), "Scalars Normals Tensors TextureCoordinates Counts");
  EXPECT_EQ(this->Filter->GetAttributeTransformation("Vectors"), Algorithm::NO_TRANSFORMATION);
  EXPECT_EQ(this->Filter->GetAttributeTransformation("Counts"), Algorithm::TANGENT_TRANSFORMATION);
  EXPECT_EQ(this->Filter->GetAttributeTransformation("Displacement"), -1);
  EXPECT_EQ(this->Filter->GetAttributeTransformation(nullptr), -1);
  this->Filter->ClearAttributeTransformations();
  EXPECT_EQ(this->Filter->GetAttributeTransformation("Counts"), -1);
  EXPECT_EQ(this->Changed(), "Vectors Normals Tensors");
}

TEST_F(WhichArrays, RolesNamesAndTypesAreKept)
{
  vtkPointData* input = this->Cloud->GetPointData();
  input->GetVectors()->SetComponentName(1, "Y");
  this->Filter->TransformAllInputVectorsOn();
  this->Filter->SetAttributeTransformation("Counts", Algorithm::TANGENT_TRANSFORMATION);
  vtkPointData* output = Output(this->Filter)->GetPointData();
  for (const auto& [role, name] : Roles)
  {
    ASSERT_TRUE(output->GetAbstractAttribute(role)) << name;
    EXPECT_STREQ(output->GetAbstractAttribute(role)->GetName(), name);
    EXPECT_EQ(output->GetAbstractAttribute(role), output->GetAbstractArray(name));
  }
  EXPECT_STREQ(output->GetVectors()->GetComponentName(1), "Y");
  // No duplicates: the arrays of the input, which are unchanged, and the mask.
  EXPECT_EQ(output->GetNumberOfArrays(), input->GetNumberOfArrays() + 1);
  EXPECT_NE(input->GetVectors(), output->GetVectors());
  // A transformed integer vector is no longer integral.
  EXPECT_EQ(output->GetArray("FloatVelocity")->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(output->GetArray("Vectors")->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(output->GetArray("Counts")->GetDataType(), VTK_DOUBLE);

  // Integer vectors are also transformed if they are the active ones.
  input->SetVectors(
    RandomArray<vtkShortArray>("ShortVectors", 3, this->Cloud->GetNumberOfPoints(), 121));
  this->Filter->ClearAttributeTransformations();
  output = Output(this->Filter)->GetPointData();
  EXPECT_EQ(output->GetArray("ShortVectors")->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(output->GetArray("ShortVectors"), output->GetVectors());
  EXPECT_EQ(output->GetArray("Counts")->GetDataType(), VTK_INT);
}

} // namespace
