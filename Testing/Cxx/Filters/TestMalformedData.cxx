// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Data whose arrays and cells do not match: nothing is read out of bounds, and all valid parts are
// mapped.

#include "Fixtures/FilterRuns.h"

#include "vtkResampleThroughHomeomorphism.h"
#include "vtkTriangulationPairReport.h"

#include "vtkCellType.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnstructuredGrid.h"

namespace
{

using namespace fixtures;

constexpr double HiddenPoint = vtkDataSetAttributes::HIDDENPOINT;
constexpr double HiddenCell = vtkDataSetAttributes::HIDDENCELL;

/// Two triangles, the second of them outside.
vtkSmartPointer<vtkPolyData> MakeDataPartlyOutside()
{
  return MakeMesh(
    { { 0.5, 0.5, 0 }, { 1.5, 0.5, 0 }, { 0.5, 1.5, 0 }, { 5, 5, 0 }, { 6, 5, 0 }, { 5, 6, 0 } },
    { { 0, 1, 2 }, { 3, 4, 5 } });
}

/// The square [0, 2] x [0, 2] is mapped to itself with doubled coordinates.
const Matrix Jacobian{ { { 2, 0, 0 }, { 0, 2, 0 }, { 0, 0, 1 } } };

class MalformedData : public ::testing::Test
{
protected:
  vtkPointSet* Run(vtkDataObject* data)
  {
    this->Filter->SetDataObject(data);
    vtkPointSet* output = Output(this->Filter);
    EXPECT_EQ(this->Log.Error(), "");
    return output;
  }

  vtkSmartPointer<vtkPolyData> Source = RegularGrid(2);
  vtkSmartPointer<vtkDifferentiableHomeomorphism> Filter =
    MakeFilter(Linear, { Source, Resized(Source, 2.0) });
  Messages Log{ Filter };
};

TEST_F(MalformedData, GhostArraysOfWrongLengthAreReplaced)
{
  for (const vtkIdType points : { 0, 1, 5, 7, 100 })
  {
    for (const vtkIdType cells : { 0, 1, 3, 50 })
    {
      const auto data = MakeDataPartlyOutside();
      data->GetPointData()->AddArray(MakeGhosts(points, {}, 0));
      data->GetCellData()->AddArray(MakeGhosts(cells, {}, 0));
      vtkPointSet* output = this->Run(data);
      EXPECT_EQ(ValuesOf(PointArray(output, "vtkGhostType")),
        (std::vector<double>{ 0, 0, 0, HiddenPoint, HiddenPoint, HiddenPoint }));
      EXPECT_EQ(
        ValuesOf(CellArray(output, "vtkGhostType")), (std::vector<double>{ 0, HiddenCell }));
      // The filter must not modify its input.
      EXPECT_EQ(PointArray(data, "vtkGhostType")->GetNumberOfTuples(), points);
    }
  }
}

TEST_F(MalformedData, ArraysOfWrongLengthPassUnchanged)
{
  this->Filter->SetAttributeTransformation(
    "Gradients", vtkDifferentiableHomeomorphism::GRADIENT_TRANSFORMATION);
  for (const vtkIdType tuples : { 0, 1, 2, 5, 7, 5000 })
  {
    SCOPED_TRACE(tuples);
    const auto data = MakeDataPartlyOutside();
    const std::vector<vtkSmartPointer<vtkDoubleArray>> arrays{ RandomArray("Vectors", 3, tuples, 1),
      RandomArray("Normals", 3, tuples, 2), RandomArray("Tensors", 9, tuples, 3),
      RandomArray("Gradients", 3, tuples, 4) };
    // 2 tuples match the number of cells, but not that of points.
    for (vtkDataSetAttributes* attributes :
      std::initializer_list<vtkDataSetAttributes*>{ data->GetPointData(), data->GetCellData() })
    {
      for (const auto& array : arrays)
      {
        attributes->AddArray(array);
      }
      attributes->SetActiveVectors("Vectors");
      attributes->SetActiveNormals("Normals");
      attributes->SetActiveTensors("Tensors");
    }
    vtkPointSet* output = this->Run(data);
    EXPECT_EQ(
      ValuesOf(PointArray(output, "vtkValidPointMask")), (std::vector<double>{ 1, 1, 1, 0, 0, 0 }));
    for (const auto& array : arrays)
    {
      EXPECT_EQ(PointArray(output, array->GetName()), array);
      EXPECT_EQ(CellArray(output, array->GetName()) == array, tuples != 2);
    }
    // An array beside them is transformed nevertheless, of which one vector is not a number.
    const auto others = RandomArray("Others", 3, 6, 5);
    others->SetComponent(0, 0, NotANumber);
    data->GetPointData()->SetVectors(others);
    this->Filter->TransformAllInputVectorsOn();
    vtkDataArray* mapped = PointArray(this->Run(data), "Others");
    EXPECT_TRUE(std::isnan(mapped->GetComponent(0, 0)));
    EXPECT_LT(Distance(VectorOf(mapped, 1), Jacobian * VectorOf(others, 1)), 1e-12);
  }
}

// Just past the end, negative, and so far off that an access would crash.
const std::vector<vtkIdType> NoPoints{ 6, 7, -1, -1000, vtkIdType(1) << 44, -(vtkIdType(1) << 44),
  std::numeric_limits<vtkIdType>::max() };

TEST_F(MalformedData, CellsWithInvalidPointIds)
{
  for (const vtkIdType noPoint : NoPoints)
  {
    SCOPED_TRACE(noPoint);
    const auto polygons = MakeDataPartlyOutside();
    SetTriangles(polygons, { { 0, 1, 2 }, { 0, noPoint, 2 }, { 3, 4, 5 } });
    vtkNew<vtkUnstructuredGrid> grid;
    grid->SetPoints(polygons->GetPoints());
    grid->SetCells(VTK_TRIANGLE, polygons->GetPolys());
    for (vtkDataSet* data : std::initializer_list<vtkDataSet*>{ polygons, grid })
    {
      const auto before = RandomArray("Vectors", 3, 3, 6);
      data->GetCellData()->SetVectors(before);
      vtkPointSet* output = this->Run(data);
      ASSERT_EQ(output->GetNumberOfPoints(), 6);
      ASSERT_EQ(output->GetNumberOfCells(), 3);
      // Only whole cells inside are visible.
      EXPECT_EQ(ValuesOf(CellArray(output, "vtkGhostType")),
        (std::vector<double>{ 0, HiddenCell, HiddenCell }));
      // Cell vectors are transformed at the center of the cell, which does not exist.
      vtkDataArray* vectors = output->GetCellData()->GetVectors();
      EXPECT_LT(Distance(VectorOf(vectors, 0), Jacobian * VectorOf(before, 0)), 1e-12);
      EXPECT_TRUE(std::isnan(vectors->GetComponent(1, 0)));
      EXPECT_TRUE(std::isnan(vectors->GetComponent(2, 0)));
    }
    // Coordinates belong to points: the cells are not read.
    const auto coordinates = MakeCoordinates(Linear, this->Source, polygons);
    coordinates->Update();
    EXPECT_EQ(coordinates->GetNumberOfOutsidePoints(), 3);
  }
}

TEST_F(MalformedData, PolygonsAndLinesWithTooFewPoints)
{
  const auto data = MakeDataPartlyOutside();
  data->AllocateEstimate(4, 3);
  const vtkIdType ids[] = { 0, 1, 3 };
  data->InsertNextCell(VTK_POLY_LINE, 1, ids);
  data->InsertNextCell(VTK_POLYGON, 2, ids);
  data->InsertNextCell(VTK_POLYGON, 1, ids);
  data->InsertNextCell(VTK_POLYGON, 3, ids);
  data->DeleteCells();
  data->GetCellData()->SetVectors(RandomArray("Flux", 3, 4, 7));
  vtkPointSet* output = this->Run(data);
  ASSERT_EQ(output->GetNumberOfCells(), 4);
  EXPECT_EQ(
    ValuesOf(CellArray(output, "vtkGhostType")), (std::vector<double>{ 0, 0, 0, HiddenCell }));
  EXPECT_TRUE(std::isfinite(CellArray(output, "Flux")->GetComponent(0, 0)));
  EXPECT_TRUE(std::isnan(CellArray(output, "Flux")->GetComponent(3, 0)));
}

TEST_F(MalformedData, IsRefusedWhereValuesAreLookedFor)
{
  using Change = std::function<void(vtkPolyData*)>;
  const std::vector<Change> changes{
    // A point that does not exist, a polygon of two points, and a point that is not a number.
    [](vtkPolyData* data) {
      SetTriangles(data, { { 0, 1, 9 } });
    },
    [](vtkPolyData* data) {
      data->GetPolys()->InsertNextCell({ 0, 1 });
    },
    [](vtkPolyData* data) {
      MovePoint(data, 5, { 0, NotANumber, 0 });
    },
    // Offsets that do not fit, and an array of another length.
    [](vtkPolyData* data) {
      data->GetPolys()->SetData(RandomArray<vtkTypeInt64Array>("Offsets", 1, 3, 1),
        RandomArray<vtkTypeInt64Array>("Points", 1, 3, 2));
    },
    [](vtkPolyData* data) { data->GetPointData()->AddArray(RandomArray("Velocity", 3, 2, 8)); }
  };
  for (std::size_t i = 0; i < changes.size(); ++i)
  {
    SCOPED_TRACE(i);
    const auto resample =
      MakeAlgorithm<vtkResampleThroughHomeomorphism>({ this->Source, this->Source });
    Messages messages(resample);
    const auto data = MakeDataPartlyOutside();
    resample->SetDataObject(data);
    resample->SetSamplingDimensions(5, 5);
    resample->Update();
    EXPECT_EQ(messages.Error(), "");
    EXPECT_EQ(resample->GetOutput()->GetNumberOfPoints(), 25);
    const auto changed = MakeDataPartlyOutside();
    changes[i](changed);
    resample->SetDataObject(changed);
    resample->Update();
    EXPECT_TRUE(messages.HasError());
    EXPECT_EQ(resample->GetErrorCode(), vtkResampleThroughHomeomorphism::DATA_REFUSED);
    EXPECT_EQ(resample->GetOutput()->GetNumberOfPoints(), 0);
  }
}

TEST_F(MalformedData, CorruptMeshesAreRefusedBeforeTheyAreUsed)
{
  std::vector<vtkSmartPointer<vtkPolyData>> meshes;
  for (const vtkIdType noPoint : NoPoints)
  {
    meshes.push_back(MakeDataPartlyOutside());
    SetTriangles(meshes.back(), { { 0, 1, 2 }, { 0, noPoint, 2 } });
  }
  meshes.push_back(MakeDataPartlyOutside());
  meshes.back()->GetPolys()->SetData(RandomArray<vtkTypeInt64Array>("Offsets", 1, 3, 1),
    RandomArray<vtkTypeInt64Array>("Points", 1, 3, 2));
  for (const auto& mesh : meshes)
  {
    // With the image that it lays over the mesh.
    const auto resample = MakeAlgorithm<vtkResampleThroughHomeomorphism>({ mesh, mesh });
    Messages messages(resample);
    resample->SetSamplingDimensions(5, 5);
    resample->Update();
    EXPECT_TRUE(messages.HasError());
    EXPECT_EQ(resample->GetErrorCode(), vtkResampleThroughHomeomorphism::MESHES_REFUSED);
    // It counts points of refused meshes, too.
    const auto report = MakeAlgorithm<vtkTriangulationPairReport>({ mesh, mesh });
    report->Update();
    EXPECT_EQ(report->GetStatistic("Measured"), 0.0);
    EXPECT_GE(report->GetStatistic("SourceUnusedPoints"), 3.0);
  }
}

TEST_F(MalformedData, UnnamedAttributesAreReplaced)
{
  for (const bool onCells : { false, true })
  {
    const auto data = MakeDataPartlyOutside();
    const auto attributesOf = [onCells](vtkDataSet* of) {
      return onCells ? static_cast<vtkDataSetAttributes*>(of->GetCellData()) : of->GetPointData();
    };
    vtkDataSetAttributes* input = attributesOf(data);
    const vtkIdType tuples = onCells ? 2 : 6;
    // An unnamed array without a role is kept.
    const auto plain = RandomArray(nullptr, 1, tuples, 1);
    const auto vectors = RandomArray(nullptr, 3, tuples, 2);
    const auto tensors = RandomArray(nullptr, 9, tuples, 3);
    input->AddArray(plain);
    input->SetVectors(vectors);
    input->SetNormals(RandomArray(nullptr, 3, tuples, 4));
    input->SetTensors(tensors);
    vtkDataSetAttributes* result = attributesOf(this->Run(data));
    int unnamed = 0;
    for (int i = 0; i < result->GetNumberOfArrays(); ++i)
    {
      unnamed += result->GetAbstractArray(i)->GetName() == nullptr;
    }
    EXPECT_EQ(unnamed, 4);
    EXPECT_EQ(result->GetAbstractArray(0), plain);
    ASSERT_TRUE(result->GetVectors() && result->GetNormals() && result->GetTensors());
    EXPECT_LT(Distance(VectorOf(result->GetVectors(), 0), Jacobian * VectorOf(vectors, 0)), 1e-12);
    EXPECT_LT(Distance(MatrixOf(result->GetTensors(), 0),
                Jacobian * MatrixOf(tensors, 0) * Transposed(Jacobian)),
      1e-12);
    EXPECT_NEAR(Norm(VectorOf(result->GetNormals(), 0)), 1.0, 1e-13);
    // The arrays of the input are unchanged.
    EXPECT_EQ(input->GetNumberOfArrays(), 4);
    EXPECT_EQ(input->GetVectors(), vectors);
    EXPECT_TRUE(IsSame(vectors, RandomArray(nullptr, 3, tuples, 2)));
  }
}

TEST_F(MalformedData, AnArrayKeepsAllItsRoles)
{
  // Velocities are often both the active vectors and the active scalars, for coloring.
  const auto data = MakeDataPartlyOutside();
  const auto velocities = RandomArray("Velocities", 3, 6, 9);
  data->GetPointData()->SetScalars(velocities);
  data->GetPointData()->SetActiveVectors("Velocities");
  vtkPointData* result = this->Run(data)->GetPointData();
  ASSERT_TRUE(result->GetVectors());
  EXPECT_LT(Distance(VectorOf(result->GetVectors(), 1), Jacobian * VectorOf(velocities, 1)), 1e-12);
  EXPECT_EQ(result->GetScalars(), result->GetVectors());
}

TEST_F(MalformedData, PiecesOfSeveralOutputs)
{
  for (const bool ownData : { false, true })
  {
    vtkNew<vtkTriangularCoordinates> filter;
    filter->SetInputData(0, this->Source);
    if (ownData)
    {
      filter->SetDataObject(MakeDataPartlyOutside());
    }
    // Cells of the pieces of each output, requested by its own consumer in turn, as in several
    // processes, or of the first output for all.
    const auto countCells = [&filter](int pieces, bool ofEach) {
      std::vector<vtkIdType> sums(3, 0);
      for (int piece = 0; piece < pieces; ++piece)
      {
        UpdatePiece(filter, piece, pieces);
        for (const int port : { 0, 1, 2 })
        {
          vtkDataObject* data =
            ofEach ? UpdatePiece(filter, piece, pieces, port) : filter->GetOutputDataObject(port);
          EXPECT_EQ(data->GetInformation()->Get(vtkDataObject::DATA_PIECE_NUMBER()), piece);
          sums[port] += data->GetNumberOfElements(vtkDataObject::CELL);
        }
      }
      return sums;
    };
    std::vector<vtkIdType> whole = countCells(1, true);
    EXPECT_GT(*std::min_element(whole.begin(), whole.end()), 0);
    // Data that is no pipeline's output is in every piece.
    whole[0] *= ownData ? 2 : 1;
    EXPECT_EQ(countCells(2, true), whole);
    EXPECT_EQ(countCells(2, false), whole);
  }
}

} // namespace
