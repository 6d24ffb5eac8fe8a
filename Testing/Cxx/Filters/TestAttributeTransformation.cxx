// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Transformation of vectors, normals, tensors and gradients by vtkDifferentiableHomeomorphism.

#include "Fixtures/FilterRuns.h"

#include "vtkShortArray.h"
#include "vtkUnstructuredGrid.h"

namespace
{

using namespace fixtures;

class AttributesInEverySystem : public ::testing::TestWithParam<System>
{
};

INSTANTIATE_TEST_SUITE_P(
  All, AttributesInEverySystem, ::testing::ValuesIn(AllSystems()), NameOfSystem);

/// A random symmetric tensor as a matrix, from VTK's order XX, YY, ZZ, XY, YZ, XZ.
Matrix SymmetricOf(vtkDataArray* array, vtkIdType i)
{
  double t[6];
  array->GetTuple(i, t);
  return { { { t[0], t[3], t[5] }, { t[3], t[1], t[4] }, { t[5], t[4], t[2] } } };
}

/// Points inside the triangles of a mesh, with an array of each kind.
vtkSmartPointer<vtkPolyData> MakeCloudWithArrays(vtkPolyData* mesh, std::uint64_t seed)
{
  constexpr vtkIdType count = 3000;
  const auto cloud = MakeCloud(mesh, InnerSamples(mesh, count, seed, 1e-3));
  vtkPointData* pointData = cloud->GetPointData();
  pointData->SetScalars(RandomArray("Scalars", 3, count, seed + 1));
  pointData->SetVectors(RandomArray("Vectors", 3, count, seed + 2));
  const auto normals = RandomArray("Normals", 3, count, seed + 3);
  for (vtkIdType i = 0; i < count; ++i)
  {
    normals->SetTuple(i, Unit(VectorOf(normals, i)).data());
  }
  pointData->SetNormals(normals);
  pointData->SetTensors(RandomArray("Tensors", 9, count, seed + 4));
  pointData->SetTCoords(RandomArray("TextureCoordinates", 3, count, seed + 5));
  pointData->AddArray(RandomArray("Displacement", 3, count, seed + 6));
  pointData->AddArray(RandomArray("Stress", 6, count, seed + 7));
  pointData->AddArray(RandomArray<vtkFloatArray>("FloatVelocity", 3, count, seed + 8));
  pointData->AddArray(RandomArray<vtkIntArray>("Counts", 3, count, seed + 9));
  pointData->AddArray(RandomArray("Pair", 2, count, seed + 10));
  pointData->AddArray(RandomArray("Single", 1, count, seed + 11));
  return cloud;
}

// --- Forward and back ----------------------------------------------------------------------------

TEST_P(AttributesInEverySystem, FollowsTheJacobian)
{
  for (const Pairing& pairing : AllPairings(6, 1, 410))
  {
    const MeshPair& pair = pairing.Meshes;
    const auto cloud = MakeCloudWithArrays(pair.Source, 80);
    const vtkIdType count = cloud->GetNumberOfPoints();
    for (const char* name : { "Gradient", "Normal" })
    {
      cloud->GetPointData()->AddArray(RandomArray(name, 3, count, 81));
    }
    cloud->GetPointData()->AddArray(RandomArray("Metric9", 9, count, 82));
    cloud->GetPointData()->AddArray(RandomArray("Metric6", 6, count, 83));
    const auto filter = MakeFilter(GetParam(), pair, cloud);
    filter->ComputeJacobianOn();
    filter->TransformAllInputVectorsOn();
    for (const char* name : { "Gradient", "Metric9", "Metric6" })
    {
      filter->SetAttributeTransformation(
        name, vtkDifferentiableHomeomorphism::GRADIENT_TRANSFORMATION);
    }
    filter->SetAttributeTransformation(
      "Normal", vtkDifferentiableHomeomorphism::NORMAL_TRANSFORMATION);
    vtkPointSet* output = Output(filter);
    for (vtkIdType i = 0; i < count; ++i)
    {
      const Matrix j = JacobianOf(output, i);
      const Matrix inverseTransposed = Transposed(Inverted(j));
      const double bound = 1e-11 * Norm(j) * Norm(inverseTransposed);
      const auto vector = [i](vtkDataSet* data, const char* name) {
        return VectorOf(PointArray(data, name), i);
      };
      const auto takeVector = [&](const char* name, const Point& expected) {
        ASSERT_LE(Distance(vector(output, name), expected), bound * (1.0 + Norm(expected)));
      };
      const auto takeTensor = [&](auto* read, const char* name, const Matrix& a) {
        const Matrix before = read(PointArray(cloud, name), i);
        ASSERT_LE(Distance(read(PointArray(output, name), i), a * before * Transposed(a)),
          bound * Norm(before) * Norm(a) * Norm(a));
      };
      takeVector("Vectors", j * vector(cloud, "Vectors"));
      takeVector("Displacement", j * vector(cloud, "Displacement"));
      takeVector("Normals", Unit(inverseTransposed * vector(cloud, "Normals")));
      takeVector("Normal", Unit(inverseTransposed * vector(cloud, "Normal")));
      takeVector("Gradient", inverseTransposed * vector(cloud, "Gradient"));
      takeTensor(MatrixOf, "Tensors", j);
      takeTensor(SymmetricOf, "Stress", j);
      takeTensor(MatrixOf, "Metric9", inverseTransposed);
      takeTensor(SymmetricOf, "Metric6", inverseTransposed);
      // The derivative of a scalar along a path is invariant.
      ASSERT_LE(std::abs(Dot(vector(output, "Gradient"), vector(output, "Vectors")) -
                  Dot(vector(cloud, "Gradient"), vector(cloud, "Vectors"))),
        bound * Norm(vector(output, "Gradient")) * Norm(vector(output, "Vectors")));
    }
  }
}

// --- Cells ---------------------------------------------------------------------------------------

TEST_P(AttributesInEverySystem, CellDataIsTransformedAtCellCenters)
{
  for (const Pairing& pairing : AllPairings(6, 2, 450))
  {
    const MeshPair& pair = pairing.Meshes;
    // Lines and polygons inside triangles, and one cell without points between them.
    Random random(102);
    vtkNew<vtkUnstructuredGrid> data;
    std::vector<Point> positions;
    std::vector<Point> means;
    const auto addCell = [&](int type, vtkIdType size) {
      const vtkIdType triangle = random.Below(pair.Source->GetNumberOfCells());
      std::vector<vtkIdType> ids;
      Point mean{};
      for (vtkIdType k = 0; k < size; ++k)
      {
        const Point position = PositionOf(pair.Source, { triangle, random.Weights(1e-3) });
        ids.push_back(static_cast<vtkIdType>(positions.size()));
        positions.push_back(position);
        mean = mean + (1.0 / static_cast<double>(size)) * position;
      }
      data->InsertNextCell(type, size, ids.data());
      means.push_back(mean);
    };
    for (int i = 0; i < 100; ++i)
    {
      addCell(VTK_POLY_LINE, 2 + random.Below(4));
    }
    addCell(VTK_EMPTY_CELL, 0);
    for (int i = 0; i < 100; ++i)
    {
      addCell(VTK_POLYGON, 3 + random.Below(3));
    }
    data->SetPoints(MakeCloud(positions)->GetPoints());
    const vtkIdType cells = data->GetNumberOfCells();
    ASSERT_EQ(cells, 201);
    data->GetCellData()->SetVectors(RandomArray("Flux", 3, cells, 103));
    data->GetCellData()->SetTensors(RandomArray("Tensor", 9, cells, 104));
    data->GetCellData()->AddArray(RandomArray("Other", 3, cells, 105));
    data->GetCellData()->AddArray(RandomArray("Gradient", 3, cells, 106));
    const auto filter = MakeFilter(GetParam(), pair, data);
    filter->SetAttributeTransformation(
      "Gradient", vtkDifferentiableHomeomorphism::GRADIENT_TRANSFORMATION);
    vtkPointSet* output = Output(filter);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);

    const auto atMeans = MakeFilter(GetParam(), pair, MakeCloud(means));
    atMeans->ComputeJacobianOn();
    vtkDataArray* jacobian = PointArray(Output(atMeans), "Jacobian");
    for (vtkIdType i = 0; i < cells; ++i)
    {
      const Point flux = VectorOf(CellArray(output, "Flux"), i);
      if (i == 100)
      {
        EXPECT_TRUE(std::isnan(flux[0]) && std::isnan(flux[1]) && std::isnan(flux[2]));
        continue;
      }
      const Matrix j = MatrixOf(jacobian, i);
      const double bound = 1e-9 * Norm(j) * Norm(Inverted(j));
      const auto before = [&](const char* name) { return VectorOf(CellArray(data, name), i); };
      const Matrix tensor = MatrixOf(CellArray(data, "Tensor"), i);
      ASSERT_LE(Distance(flux, j * before("Flux")), bound * Norm(before("Flux")) * Norm(j));
      ASSERT_LE(Distance(VectorOf(CellArray(output, "Gradient"), i),
                  Transposed(Inverted(j)) * before("Gradient")),
        bound * Norm(before("Gradient")) * Norm(Inverted(j)));
      ASSERT_LE(Distance(MatrixOf(CellArray(output, "Tensor"), i), j * tensor * Transposed(j)),
        bound * Norm(tensor) * Norm(j) * Norm(j));
    }
    EXPECT_EQ(CountDifferentValues(CellArray(output, "Other"), CellArray(data, "Other")), 0);
    EXPECT_STREQ(output->GetCellData()->GetVectors()->GetName(), "Flux");
    EXPECT_STREQ(output->GetCellData()->GetTensors()->GetName(), "Tensor");
    EXPECT_FALSE(CellArray(output, "Jacobian"));
  }
}

TEST(AttributeTransformation, CellsMaySpanTrianglesOfASurface)
{
  // Polygons of four neighboring points, whose means lie well off the surface.
  const MeshPair pair = MakeClosedPair(2, 455);
  std::map<std::pair<vtkIdType, vtkIdType>, vtkIdType> apexes;
  vtkNew<vtkCellArray> polygons;
  for (const Triangle& t : TrianglesOf(pair.Source))
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto found = apexes.find({ t[(k + 1) % 3], t[k] });
      if (found != apexes.end())
      {
        polygons->InsertNextCell({ t[k], found->second, t[(k + 1) % 3], t[(k + 2) % 3] });
      }
      apexes[{ t[k], t[(k + 1) % 3] }] = t[(k + 2) % 3];
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(pair.Source->GetPoints());
  data->SetPolys(polygons);
  data->GetCellData()->SetVectors(RandomArray("Flux", 3, data->GetNumberOfCells(), 108));
  ASSERT_EQ(data->GetNumberOfCells(), 3 * pair.Source->GetNumberOfCells() / 2);
  const auto filter = MakeFilter(Smooth, pair, data);
  vtkDataArray* mapped = Output(filter)->GetCellData()->GetVectors();
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    ASSERT_GT(Norm(VectorOf(mapped, i)), 0.0);
  }
}

// --- Which arrays --------------------------------------------------------------------------------

class WhichArrays : public ::testing::Test
{
protected:
  /// Names of the arrays that differ between input and output.
  std::string Changed()
  {
    this->Filter->Update();
    auto* output = vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(0));
    std::string names;
    for (int i = 0; i < this->Cloud->GetPointData()->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* before = this->Cloud->GetPointData()->GetArray(i);
      vtkDataArray* after = PointArray(output, before->GetName());
      EXPECT_TRUE(after) << before->GetName();
      if (CountDifferentValues(before, after) != 0)
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

TEST_F(WhichArrays, ActiveOnesByDefault)
{
  EXPECT_EQ(this->Changed(), "Vectors Normals Tensors");
}

TEST_F(WhichArrays, NoneWithoutTransformActiveAttributes)
{
  this->Filter->TransformActiveAttributesOff();
  EXPECT_EQ(this->Changed(), "");
  this->Filter->TransformAllInputVectorsOn();
  EXPECT_EQ(this->Changed(), "");
  this->Filter->SetAttributeTransformation("Displacement", Algorithm::TANGENT_TRANSFORMATION);
  EXPECT_EQ(this->Changed(), "Displacement");
}

TEST_F(WhichArrays, AllVectors)
{
  // Texture coordinates, active scalars, integers and arrays of other sizes are not transformed.
  this->Filter->TransformAllInputVectorsOn();
  EXPECT_EQ(this->Changed(), "Vectors Normals Tensors Displacement Stress FloatVelocity");
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

TEST_F(WhichArrays, RolesAndNamesAreKept)
{
  vtkDataArray* vectors = PointArray(this->Cloud, "Vectors");
  for (const int component : { 0, 1, 2 })
  {
    vectors->SetComponentName(
      component, std::string(1, static_cast<char>('X' + component)).c_str());
  }
  this->Filter->TransformAllInputVectorsOn();
  vtkPointData* pointData = Output(this->Filter)->GetPointData();
  const std::vector<std::pair<int, const char*>> roles{
    { vtkDataSetAttributes::SCALARS, "Scalars" }, { vtkDataSetAttributes::VECTORS, "Vectors" },
    { vtkDataSetAttributes::NORMALS, "Normals" }, { vtkDataSetAttributes::TENSORS, "Tensors" },
    { vtkDataSetAttributes::TCOORDS, "TextureCoordinates" }
  };
  for (const auto& role : roles)
  {
    ASSERT_TRUE(pointData->GetAbstractAttribute(role.first)) << role.second;
    EXPECT_STREQ(pointData->GetAbstractAttribute(role.first)->GetName(), role.second);
    EXPECT_EQ(
      pointData->GetAbstractAttribute(role.first), pointData->GetAbstractArray(role.second));
  }
  EXPECT_STREQ(pointData->GetVectors()->GetComponentName(1), "Y");
  // No duplicates: the arrays of the input and the mask.
  EXPECT_EQ(pointData->GetNumberOfArrays(), this->Cloud->GetPointData()->GetNumberOfArrays() + 1);
  // The arrays of the input are unchanged.
  EXPECT_NE(this->Cloud->GetPointData()->GetVectors(), pointData->GetVectors());
}

TEST_F(WhichArrays, TypesOfNumbers)
{
  this->Filter->TransformAllInputVectorsOn();
  this->Filter->SetAttributeTransformation("Counts", Algorithm::TANGENT_TRANSFORMATION);
  this->Filter->ComputeJacobianOn();
  vtkPointSet* output = Output(this->Filter);
  EXPECT_EQ(PointArray(output, "FloatVelocity")->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(PointArray(output, "Vectors")->GetDataType(), VTK_DOUBLE);
  // A transformed integer vector is no longer integral.
  ASSERT_EQ(PointArray(output, "Counts")->GetDataType(), VTK_DOUBLE);
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    const Matrix j = JacobianOf(output, i);
    const Point counts = j * VectorOf(PointArray(this->Cloud, "Counts"), i);
    ASSERT_LE(Distance(VectorOf(PointArray(output, "Counts"), i), counts), 1e-12 * Norm(counts));
    const Point velocity = j * VectorOf(PointArray(this->Cloud, "FloatVelocity"), i);
    ASSERT_LE(
      Distance(VectorOf(PointArray(output, "FloatVelocity"), i), velocity), 1e-6 * Norm(velocity));
  }

  // Integer vectors are also transformed if they are the active ones.
  this->Cloud->GetPointData()->SetVectors(
    RandomArray<vtkShortArray>("ShortVectors", 3, this->Cloud->GetNumberOfPoints(), 121));
  this->Filter->ClearAttributeTransformations();
  output = Output(this->Filter);
  EXPECT_EQ(PointArray(output, "ShortVectors")->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(PointArray(output, "ShortVectors"), output->GetPointData()->GetVectors());
  EXPECT_EQ(PointArray(output, "Counts")->GetDataType(), VTK_INT);
}

} // namespace
