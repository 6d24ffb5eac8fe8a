// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TestMalformedData.cxx
/// Malformed and unusual input: arrays and cells that do not match, meshes with different cell
/// numbering, and requests for pieces. Nothing may be read out of bounds.

#include "TestMeshes.h"

#include "vtkDifferentiableHomeomorphism.h"
#include "vtkTriangularCoordinates.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace
{

using namespace test_meshes;

constexpr auto Linear = vtkDifferentiableHomeomorphism::LINEAR;

/// The square [0, n] x [0, n] and the same square with doubled coordinates: J is twice the identity
/// in the plane.
MeshPair MakeDoublingPair(int n)
{
  std::vector<Point> points = GridPoints(n, 3, 0.0);
  const auto source = MakeMesh(points, GridTriangles(n));
  for (Point& p : points)
  {
    p = { 2.0 * p[0], 2.0 * p[1], 0.0 };
  }
  return { source, MakeMesh(points, GridTriangles(n)) };
}

/// The centroids of the triangles of a mesh, in their order.
std::vector<Point> Centroids(vtkPolyData* mesh)
{
  std::vector<Point> result;
  vtkCellArray* cells = mesh->GetPolys();
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCellAtId(cell, count, ids);
    Point mean{};
    for (vtkIdType k = 0; k < count; ++k)
    {
      double p[3];
      mesh->GetPoint(ids[k], p);
      for (int axis = 0; axis < 3; ++axis)
      {
        mean[axis] += p[axis] / static_cast<double>(count);
      }
    }
    result.push_back(mean);
  }
  return result;
}

/// Puts vertex and line cells before the triangles of a mesh, which shifts their cell ids.
void AddVertsAndLines(vtkPolyData* mesh, int verts, int lines)
{
  vtkNew<vtkCellArray> vertCells;
  for (vtkIdType i = 0; i < verts; ++i)
  {
    vertCells->InsertNextCell(1, &i);
  }
  vtkNew<vtkCellArray> lineCells;
  for (vtkIdType i = 0; i < lines; ++i)
  {
    const vtkIdType ends[] = { i, i + 1 };
    lineCells->InsertNextCell(2, ends);
  }
  mesh->SetVerts(vertCells);
  mesh->SetLines(lineCells);
}

vtkSmartPointer<vtkUnsignedCharArray> MakeGhosts(vtkIdType tuples, vtkIdType hidden, int flag)
{
  const auto ghosts = vtkSmartPointer<vtkUnsignedCharArray>::New();
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(tuples);
  ghosts->FillValue(0);
  if (hidden >= 0)
  {
    ghosts->SetValue(hidden, static_cast<unsigned char>(flag));
  }
  return ghosts;
}

/// Values that encode their position: component k of tuple i is 10 i + k + 1.
vtkSmartPointer<vtkDoubleArray> MakeNumbers(const char* name, int components, vtkIdType tuples)
{
  const auto numbers = vtkSmartPointer<vtkDoubleArray>::New();
  numbers->SetName(name);
  numbers->SetNumberOfComponents(components);
  numbers->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < tuples; ++i)
  {
    for (int k = 0; k < components; ++k)
    {
      numbers->SetComponent(i, k, static_cast<double>(10 * i + k + 1));
    }
  }
  return numbers;
}

/// The filter with a Linear map, so that results are simple.
class MalformedData : public ::testing::Test
{
protected:
  void SetUp() override { this->SetMeshes(this->Pair); }

  void SetMeshes(const MeshPair& pair)
  {
    this->Filter->SetSourceData(pair.Source);
    this->Filter->SetTargetData(pair.Target);
    this->Filter->SetCoordinateSystem(Linear);
  }

  vtkPointSet* Run(vtkDataObject* data)
  {
    this->Filter->SetDataObject(data);
    this->Filter->Update();
    EXPECT_FALSE(this->Log.HasError()) << this->Log.Error();
    return vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(0));
  }

  std::vector<double> ValidOf(vtkPointSet* output)
  {
    std::vector<double> valid;
    vtkDataArray* mask = output->GetPointData()->GetArray("vtkValidPointMask");
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      valid.push_back(mask->GetTuple1(i));
    }
    return valid;
  }

  MeshPair Pair = MakeDoublingPair(2);
  vtkNew<vtkDifferentiableHomeomorphism> Filter;
  Messages Log{ this->Filter };
};

//------------------------------------------------------------------------------------------------
// Hidden cells of meshes that have other vertices and lines.

TEST_F(MalformedData, HiddenCellsOfTheTargetAreFoundByTheirIdsInTheTarget)
{
  for (const bool onTarget : { true, false })
  {
    // Vertices and lines in addition to the triangles of either mesh. The hidden cell is in the
    // first mesh.
    for (const auto& counts : std::vector<std::array<int, 4>>{
           { 0, 0, 1, 0 }, { 1, 0, 0, 0 }, { 0, 0, 2, 3 }, { 2, 3, 1, 1 }, { 0, 2, 0, 0 } })
    {
      for (vtkIdType hidden = 0; hidden < 8; ++hidden)
      {
        SCOPED_TRACE(hidden);
        const MeshPair pair = MakeDoublingPair(2);
        vtkPolyData* mesh = onTarget ? pair.Target : pair.Source;
        vtkPolyData* other = onTarget ? pair.Source : pair.Target;
        AddVertsAndLines(mesh, counts[0], counts[1]);
        AddVertsAndLines(other, counts[2], counts[3]);
        // As long as the array of the mesh itself: cell ids of the other mesh would exceed it.
        const vtkIdType cell = counts[0] + counts[1] + hidden;
        mesh->GetCellData()->AddArray(
          MakeGhosts(mesh->GetNumberOfCells(), cell, vtkDataSetAttributes::HIDDENCELL));
        this->SetMeshes(pair);
        std::vector<double> expected(8, 1.0);
        expected[hidden] = 0.0;
        EXPECT_EQ(this->ValidOf(this->Run(MakeMesh(Centroids(pair.Source), {}))), expected);
      }
    }
  }
}

TEST_F(MalformedData, GhostArraysOfWrongLengthOnTheMeshesAreIgnored)
{
  for (vtkPolyData* mesh : { this->Pair.Source.Get(), this->Pair.Target.Get() })
  {
    mesh->GetCellData()->AddArray(MakeGhosts(2, 1, vtkDataSetAttributes::HIDDENCELL));
    mesh->GetPointData()->AddArray(MakeGhosts(3, 1, vtkDataSetAttributes::HIDDENPOINT));
  }
  EXPECT_EQ(this->ValidOf(this->Run(MakeMesh(Centroids(this->Pair.Source), {}))),
    std::vector<double>(8, 1.0));
}

//------------------------------------------------------------------------------------------------
// Data.

/// A mesh of two triangles, one of them outside.
vtkSmartPointer<vtkPolyData> MakeDataPartlyOutside()
{
  return MakeMesh(
    { { 0.5, 0.5, 0 }, { 1.5, 0.5, 0 }, { 0.5, 1.5, 0 }, { 5, 5, 0 }, { 6, 5, 0 }, { 5, 6, 0 } },
    { { 0, 1, 2 }, { 3, 4, 5 } });
}

TEST_F(MalformedData, GhostArraysOfWrongLengthOnTheDataAreReplaced)
{
  for (const vtkIdType points : { 0, 1, 3, 5, 7, 100 })
  {
    for (const vtkIdType cells : { 0, 1, 3, 50 })
    {
      const auto data = MakeDataPartlyOutside();
      data->GetPointData()->AddArray(MakeGhosts(points, -1, 0));
      data->GetCellData()->AddArray(MakeGhosts(cells, -1, 0));
      vtkPointSet* output = this->Run(data);
      vtkDataArray* pointGhosts = output->GetPointData()->GetArray("vtkGhostType");
      vtkDataArray* cellGhosts = output->GetCellData()->GetArray("vtkGhostType");
      ASSERT_EQ(pointGhosts->GetNumberOfTuples(), 6);
      ASSERT_EQ(cellGhosts->GetNumberOfTuples(), 2);
      for (vtkIdType i = 0; i < 6; ++i)
      {
        EXPECT_EQ(
          pointGhosts->GetTuple1(i), i < 3 ? 0.0 : double(vtkDataSetAttributes::HIDDENPOINT));
      }
      EXPECT_EQ(cellGhosts->GetTuple1(0), 0.0);
      EXPECT_EQ(cellGhosts->GetTuple1(1), double(vtkDataSetAttributes::HIDDENCELL));
      // The filter must not modify its input.
      EXPECT_EQ(data->GetPointData()->GetArray("vtkGhostType")->GetNumberOfTuples(), points);
    }
  }
}

TEST_F(MalformedData, GhostArraysThatFitAreKept)
{
  const auto data = MakeDataPartlyOutside();
  data->GetPointData()->AddArray(MakeGhosts(6, 1, vtkDataSetAttributes::DUPLICATEPOINT));
  data->GetCellData()->AddArray(MakeGhosts(2, 1, vtkDataSetAttributes::DUPLICATECELL));
  vtkPointSet* output = this->Run(data);
  vtkDataArray* pointGhosts = output->GetPointData()->GetArray("vtkGhostType");
  vtkDataArray* cellGhosts = output->GetCellData()->GetArray("vtkGhostType");
  EXPECT_EQ(pointGhosts->GetTuple1(1), double(vtkDataSetAttributes::DUPLICATEPOINT));
  EXPECT_EQ(pointGhosts->GetTuple1(4), double(vtkDataSetAttributes::HIDDENPOINT));
  EXPECT_EQ(cellGhosts->GetTuple1(1),
    double(vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL));
}

TEST_F(MalformedData, ArraysOfWrongLengthPassUnchanged)
{
  for (const vtkIdType tuples : { 0, 1, 2, 5, 7, 5000 })
  {
    SCOPED_TRACE(tuples);
    const auto data = MakeDataPartlyOutside();
    const auto vectors = MakeNumbers("Vectors", 3, tuples);
    const auto normals = MakeNumbers("Normals", 3, tuples);
    const auto tensors = MakeNumbers("Tensors", 9, tuples);
    const auto gradients = MakeNumbers("Gradients", 3, tuples);
    this->Filter->SetAttributeTransformation(
      "Gradients", vtkDifferentiableHomeomorphism::GRADIENT_TRANSFORMATION);
    // 2 tuples match the number of cells, but not that of points.
    for (vtkDataSetAttributes* attributes :
      std::initializer_list<vtkDataSetAttributes*>{ data->GetPointData(), data->GetCellData() })
    {
      attributes->AddArray(vectors);
      attributes->AddArray(normals);
      attributes->AddArray(tensors);
      attributes->AddArray(gradients);
      attributes->SetActiveVectors("Vectors");
      attributes->SetActiveNormals("Normals");
      attributes->SetActiveTensors("Tensors");
    }
    vtkPointSet* output = this->Run(data);
    EXPECT_EQ(output->GetNumberOfPoints(), 6);
    EXPECT_EQ(this->ValidOf(output), (std::vector<double>{ 1, 1, 1, 0, 0, 0 }));
    for (const auto& array : { vectors, normals, tensors, gradients })
    {
      EXPECT_EQ(output->GetPointData()->GetAbstractArray(array->GetName()), array);
      if (tuples != 2)
      {
        EXPECT_EQ(output->GetCellData()->GetAbstractArray(array->GetName()), array);
      }
    }
  }
}

TEST_F(MalformedData, ArraysOfWrongLengthDoNotBlockOthers)
{
  const auto data = MakeDataPartlyOutside();
  const auto tooLong = MakeNumbers("TooLong", 3, 7);
  data->GetPointData()->SetVectors(MakeNumbers("Vectors", 3, 6));
  data->GetPointData()->AddArray(tooLong);
  this->Filter->TransformAllInputVectorsOn();
  vtkPointSet* output = this->Run(data);
  EXPECT_EQ(output->GetPointData()->GetArray("TooLong"), tooLong);
  vtkDataArray* mapped = output->GetPointData()->GetVectors();
  ASSERT_NE(mapped, nullptr);
  EXPECT_NEAR(mapped->GetComponent(2, 0), 42.0, 1e-13);
  EXPECT_NEAR(mapped->GetComponent(2, 1), 44.0, 1e-13);
  EXPECT_NEAR(mapped->GetComponent(2, 2), 23.0, 1e-13);
}

TEST_F(MalformedData, ArraysOfWrongLengthOnImagesPass)
{
  const vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 1);
  for (const vtkIdType tuples : { 4, 8, 10, 4000 })
  {
    const auto vectors = MakeNumbers("Vectors", 3, tuples);
    image->GetPointData()->SetVectors(vectors);
    vtkPointSet* output = this->Run(image);
    EXPECT_EQ(output->GetPointData()->GetAbstractArray("Vectors"), vectors);
    EXPECT_EQ(this->ValidOf(output), std::vector<double>(9, 1.0));
  }
}

/// Ids of points that do not exist: just past the end, negative, and so far off that an access
/// would crash.
const std::vector<vtkIdType> NoPoints{ 6, 7, -1, -1000, vtkIdType(1) << 44, -(vtkIdType(1) << 44),
  std::numeric_limits<vtkIdType>::max() };

void ExpectCorruptCellHandled(vtkPointSet* output)
{
  ASSERT_NE(output, nullptr);
  ASSERT_EQ(output->GetNumberOfPoints(), 6);
  ASSERT_EQ(output->GetNumberOfCells(), 3);
  // Only whole cells inside are visible.
  vtkDataArray* ghosts = output->GetCellData()->GetArray("vtkGhostType");
  ASSERT_NE(ghosts, nullptr);
  EXPECT_EQ(ghosts->GetTuple1(0), 0.0);
  EXPECT_EQ(ghosts->GetTuple1(1), double(vtkDataSetAttributes::HIDDENCELL));
  EXPECT_EQ(ghosts->GetTuple1(2), double(vtkDataSetAttributes::HIDDENCELL));
  // Cell vectors are transformed at the center of the cell, which does not exist.
  vtkDataArray* vectors = output->GetCellData()->GetVectors();
  ASSERT_NE(vectors, nullptr);
  EXPECT_NEAR(vectors->GetComponent(0, 0), 2.0, 1e-13);
  EXPECT_TRUE(std::isnan(vectors->GetComponent(1, 0)));
  EXPECT_TRUE(std::isnan(vectors->GetComponent(2, 0)));
}

TEST_F(MalformedData, CellsOfAGridWithInvalidPointIds)
{
  for (const vtkIdType noPoint : NoPoints)
  {
    SCOPED_TRACE(noPoint);
    const auto whole = MakeDataPartlyOutside();
    // InsertNextCell of the grid would access the points, so the cell array is filled directly.
    const vtkNew<vtkCellArray> cells;
    for (const Triangle& triangle :
      std::vector<Triangle>{ { 0, 1, 2 }, { 0, noPoint, 2 }, { 3, 4, 5 } })
    {
      cells->InsertNextCell(3, triangle.data());
    }
    const vtkNew<vtkUnstructuredGrid> grid;
    grid->SetPoints(whole->GetPoints());
    grid->SetCells(VTK_TRIANGLE, cells);
    grid->GetCellData()->SetVectors(MakeNumbers("Vectors", 3, 3));
    ExpectCorruptCellHandled(this->Run(grid));
  }
}

TEST_F(MalformedData, CellsOfPolyDataWithInvalidPointIds)
{
  for (const vtkIdType noPoint : NoPoints)
  {
    SCOPED_TRACE(noPoint);
    const auto data = MakeDataPartlyOutside();
    const vtkNew<vtkCellArray> cells;
    for (const Triangle& triangle :
      std::vector<Triangle>{ { 0, 1, 2 }, { 0, noPoint, 2 }, { 3, 4, 5 } })
    {
      cells->InsertNextCell(3, triangle.data());
    }
    data->SetPolys(cells);
    data->GetCellData()->SetVectors(MakeNumbers("Vectors", 3, 3));
    ExpectCorruptCellHandled(this->Run(data));
  }
}

TEST_F(MalformedData, CoordinatesOfDataWithInvalidPointIds)
{
  // Coordinates belong to points; the filter does not read the cells.
  for (const vtkIdType noPoint : NoPoints)
  {
    const auto data = MakeDataPartlyOutside();
    const Triangle corrupt{ 0, noPoint, 2 };
    data->GetPolys()->InsertNextCell(3, corrupt.data());
    const vtkNew<vtkTriangularCoordinates> coordinates;
    coordinates->SetInputData(0, this->Pair.Source);
    coordinates->SetDataObject(data);
    coordinates->Update();
    EXPECT_EQ(coordinates->GetNumberOfOutsidePoints(), 3);
  }
}

TEST_F(MalformedData, MeshesWithInvalidPointIdsAreRefused)
{
  for (const vtkIdType noPoint : { vtkIdType(9), vtkIdType(-1), vtkIdType(1) << 44 })
  {
    // Truncating the id to 32 bits must not make it valid.
    const MeshPair pair = MakeDoublingPair(2);
    const Triangle corrupt{ 0, noPoint, 4 };
    pair.Source->GetPolys()->ReplaceCellAtId(3, 3, corrupt.data());
    const vtkNew<vtkDifferentiableHomeomorphism> filter;
    Messages told(filter);
    filter->SetSourceData(pair.Source);
    filter->SetTargetData(pair.Target);
    filter->Update();
    EXPECT_NE(
      told.Error().find("1 triangle of the source (cell 3) refers to points"), std::string::npos)
      << told.Error();
  }
}

//------------------------------------------------------------------------------------------------
// Arrays without a name.

TEST_F(MalformedData, UnnamedAttributesAreReplaced)
{
  for (const bool onCells : { false, true })
  {
    const auto data = MakeDataPartlyOutside();
    vtkDataSetAttributes* input = data->GetPointData();
    if (onCells)
    {
      input = data->GetCellData();
    }
    const vtkIdType tuples = onCells ? 2 : 6;
    // An unnamed array without a role is kept.
    const auto plain = MakeNumbers(nullptr, 1, tuples);
    input->AddArray(plain);
    input->SetVectors(MakeNumbers(nullptr, 3, tuples));
    input->SetNormals(MakeNumbers(nullptr, 3, tuples));
    input->SetTensors(MakeNumbers(nullptr, 9, tuples));
    const int arrays = input->GetNumberOfArrays();
    ASSERT_EQ(arrays, 4);

    vtkPointSet* output = this->Run(data);
    vtkDataSetAttributes* result = output->GetPointData();
    if (onCells)
    {
      result = output->GetCellData();
    }
    int unnamed = 0;
    int kept = 0;
    for (int i = 0; i < result->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* array = result->GetAbstractArray(i);
      unnamed += array->GetName() == nullptr;
      kept += array == plain;
      // No transformed array remains in its original form.
      EXPECT_NE(array, input->GetVectors());
      EXPECT_NE(array, input->GetNormals());
      EXPECT_NE(array, input->GetTensors());
    }
    EXPECT_EQ(unnamed, arrays);
    EXPECT_EQ(kept, 1);
    ASSERT_NE(result->GetVectors(), nullptr);
    ASSERT_NE(result->GetNormals(), nullptr);
    ASSERT_NE(result->GetTensors(), nullptr);
    EXPECT_NEAR(result->GetVectors()->GetComponent(0, 0), 2.0, 1e-13);
    EXPECT_NEAR(result->GetTensors()->GetComponent(0, 0), 4.0, 1e-13);
    EXPECT_NEAR(
      std::hypot(result->GetNormals()->GetComponent(0, 0), result->GetNormals()->GetComponent(0, 1),
        result->GetNormals()->GetComponent(0, 2)),
      1.0, 1e-13);
    // The arrays of the input are unchanged.
    EXPECT_EQ(input->GetNumberOfArrays(), arrays);
    EXPECT_EQ(input->GetVectors()->GetComponent(0, 0), 1.0);
  }
}

TEST_F(MalformedData, UnnamedArraysWithoutARoleAreReplaced)
{
  const auto data = MakeDataPartlyOutside();
  const auto vectors = MakeNumbers(nullptr, 3, 6);
  data->GetPointData()->AddArray(vectors);
  this->Filter->TransformAllInputVectorsOn();
  vtkPointData* result = this->Run(data)->GetPointData();
  std::vector<vtkDataArray*> unnamed;
  for (int i = 0; i < result->GetNumberOfArrays(); ++i)
  {
    if (!result->GetAbstractArray(i)->GetName())
    {
      unnamed.push_back(result->GetArray(i));
    }
  }
  ASSERT_EQ(unnamed.size(), 1u);
  EXPECT_NE(unnamed[0], vectors);
  EXPECT_NEAR(unnamed[0]->GetComponent(1, 0), 22.0, 1e-13);
}

TEST_F(MalformedData, AnArrayKeepsAllItsRoles)
{
  // Velocities are often both the active vectors and the active scalars, for coloring.
  const auto data = MakeDataPartlyOutside();
  const auto velocities = MakeNumbers("Velocities", 3, 6);
  data->GetPointData()->SetScalars(velocities);
  data->GetPointData()->SetActiveVectors("Velocities");
  ASSERT_EQ(data->GetPointData()->GetScalars(), velocities);
  ASSERT_EQ(data->GetPointData()->GetVectors(), velocities);
  vtkPointData* result = this->Run(data)->GetPointData();
  ASSERT_NE(result->GetVectors(), nullptr);
  EXPECT_NEAR(result->GetVectors()->GetComponent(1, 0), 22.0, 1e-13);
  EXPECT_EQ(result->GetScalars(), result->GetVectors());
}

//------------------------------------------------------------------------------------------------
// Pieces.

/// Requests a piece of an output, as a consumer of that port does. Returns its number of cells.
vtkIdType UpdatePort(vtkAlgorithm* filter, int port, int piece, int pieces)
{
  filter->UpdateInformation();
  vtkInformation* request = filter->GetOutputInformation(port);
  request->Set(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER(), piece);
  request->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(), pieces);
  request->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  filter->Update(port);
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(port))->GetNumberOfCells();
}

/// Number of cells of an output in each of some pieces.
std::vector<vtkIdType> CellsOfPieces(vtkAlgorithm* filter, int port, int pieces)
{
  std::vector<vtkIdType> cells;
  for (int piece = 0; piece < pieces; ++piece)
  {
    cells.push_back(UpdatePort(filter, port, piece, pieces));
  }
  return cells;
}

using Counts = std::vector<vtkIdType>;

TEST_F(MalformedData, PiecesOfTheMeshItself)
{
  EXPECT_EQ(CellsOfPieces(this->Filter, 0, 1), (Counts{ 8 }));
  EXPECT_EQ(CellsOfPieces(this->Filter, 0, 2), (Counts{ 8, 0 }));
  EXPECT_EQ(CellsOfPieces(this->Filter, 0, 3), (Counts{ 8, 0, 0 }));
  this->Filter->InverseOn();
  EXPECT_EQ(CellsOfPieces(this->Filter, 0, 2), (Counts{ 8, 0 }));
  EXPECT_EQ(this->Filter->GetNumberOfMeshBuilds(), 1);
  // And through the shorthand, in either order.
  this->Filter->UpdatePiece(1, 2, 0);
  EXPECT_EQ(vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(0))->GetNumberOfCells(), 0);
  this->Filter->UpdatePiece(0, 2, 0);
  EXPECT_EQ(vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(0))->GetNumberOfCells(), 8);
}

TEST_F(MalformedData, PiecesOfTheCoordinatesOfTheMeshItself)
{
  for (int port = 0; port < 3; ++port)
  {
    SCOPED_TRACE(port);
    const vtkNew<vtkTriangularCoordinates> filter;
    filter->SetInputData(0, this->Pair.Source);
    const Counts whole = CellsOfPieces(filter, port, 1);
    ASSERT_GT(whole[0], 0);
    EXPECT_EQ(CellsOfPieces(filter, port, 2), (Counts{ whole[0], 0 }));
    EXPECT_EQ(CellsOfPieces(filter, port, 3), (Counts{ whole[0], 0, 0 }));
  }
}

TEST_F(MalformedData, PiecesOfAllOutputsTogether)
{
  // Consumers of several outputs that request their pieces in turn, as in a program with several
  // processes.
  const vtkNew<vtkTriangularCoordinates> filter;
  filter->SetInputData(0, this->Pair.Source);
  filter->Update();
  Counts whole;
  for (int port = 0; port < 3; ++port)
  {
    whole.push_back(
      vtkDataSet::SafeDownCast(filter->GetOutputDataObject(port))->GetNumberOfCells());
  }
  Counts sums(3, 0);
  for (int piece = 0; piece < 2; ++piece)
  {
    for (int port = 0; port < 3; ++port)
    {
      sums[port] += UpdatePort(filter, port, piece, 2);
    }
  }
  EXPECT_EQ(sums, whole);
}

TEST_F(MalformedData, PiecesRequestedOfTheFirstOutputApplyToAll)
{
  // UpdatePiece requests a piece of output 0. The other outputs of the same execution are marked as
  // the same piece, and must be that piece.
  for (const bool ownData : { false, true })
  {
    SCOPED_TRACE(ownData);
    const vtkNew<vtkTriangularCoordinates> filter;
    filter->SetInputData(0, this->Pair.Source);
    if (ownData)
    {
      filter->SetDataObject(MakeDataPartlyOutside());
    }
    filter->Update();
    const Counts whole{ filter->GetLines()->GetNumberOfCells(),
      filter->GetTriangulation()->GetNumberOfCells() };
    Counts sums(2, 0);
    for (int piece = 0; piece < 2; ++piece)
    {
      filter->UpdatePiece(piece, 2, 0);
      for (int output : { 1, 2 })
      {
        vtkDataObject* data = filter->GetOutputDataObject(output);
        EXPECT_EQ(data->GetInformation()->Get(vtkDataObject::DATA_PIECE_NUMBER()), piece);
        sums[output - 1] += vtkDataSet::SafeDownCast(data)->GetNumberOfCells();
      }
    }
    EXPECT_EQ(sums, whole);
  }
}

//------------------------------------------------------------------------------------------------
// Cell ids in messages.

/// The messages for a pair whose source has 1 vertex and whose target has 2 vertices and 3 lines.
std::string Message(
  const std::function<void(const MeshPair&)>& damage, int system = Linear, bool mask = false)
{
  const MeshPair pair = MakeDoublingPair(2);
  AddVertsAndLines(pair.Source, 1, 0);
  AddVertsAndLines(pair.Target, 2, 3);
  damage(pair);
  const vtkNew<vtkDifferentiableHomeomorphism> filter;
  Messages told(filter);
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->SetCoordinateSystem(system);
  filter->SetMaskInvalidTriangles(mask);
  filter->Update();
  EXPECT_EQ(told.HasError(), !mask);
  return mask ? told.Warning() : told.Error();
}

TEST(CellIdsInMessages, DegenerateTriangles)
{
  const auto flatten = [](vtkPolyData* mesh) {
    // Move point 2, which only triangle 2 (points 1, 2, 5) uses, onto the opposite edge.
    double a[3];
    double b[3];
    mesh->GetPoint(1, a);
    mesh->GetPoint(5, b);
    mesh->GetPoints()->SetPoint(2, 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.0);
  };
  for (const bool mask : { false, true })
  {
    EXPECT_NE(Message([&](const MeshPair& pair) { flatten(pair.Source); }, Linear, mask)
                .find("1 triangle of the source (cell 3) is degenerate"),
      std::string::npos);
    EXPECT_NE(Message([&](const MeshPair& pair) { flatten(pair.Target); }, Linear, mask)
                .find("1 triangle of the target (cell 7) is degenerate"),
      std::string::npos);
  }
}

TEST(CellIdsInMessages, NonFiniteTriangles)
{
  const auto damage = [](vtkPolyData* mesh) {
    mesh->GetPoints()->SetPoint(2, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  };
  // Point 2 is a corner of triangle 2 only.
  EXPECT_NE(Message([&](const MeshPair& pair) {
    damage(pair.Source);
  }).find("1 triangle of the source (cell 3) has a coordinate that is not finite"),
    std::string::npos);
  EXPECT_NE(Message([&](const MeshPair& pair) {
    damage(pair.Target);
  }).find("1 triangle of the target (cell 7) has a coordinate that is not finite"),
    std::string::npos);
}

/// The messages for three triangles without common points, the last two of which coincide in one of
/// the meshes.
std::string OverlapMessage(bool inTarget)
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 3, 4, 5 }, { 6, 7, 8 } };
  const std::vector<Point> apart{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 2, 0, 0 }, { 3, 0, 0 },
    { 2, 1, 0 }, { 4, 0, 0 }, { 5, 0, 0 }, { 4, 1, 0 } };
  std::vector<Point> overlapping = apart;
  for (int i = 6; i < 9; ++i)
  {
    overlapping[i][0] -= 1.8;
  }
  const MeshPair pair{ MakeMesh(inTarget ? apart : overlapping, triangles),
    MakeMesh(inTarget ? overlapping : apart, triangles) };
  AddVertsAndLines(pair.Source, 1, 0);
  AddVertsAndLines(pair.Target, 2, 3);
  const vtkNew<vtkDifferentiableHomeomorphism> filter;
  Messages told(filter);
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->Update();
  return told.Error();
}

TEST(CellIdsInMessages, OverlappingTriangles)
{
  EXPECT_NE(
    OverlapMessage(false).find("2 triangles of the source (cells 2, 3) overlap"), std::string::npos)
    << OverlapMessage(false);
  EXPECT_NE(
    OverlapMessage(true).find("2 triangles of the target (cells 6, 7) overlap"), std::string::npos)
    << OverlapMessage(true);
}

TEST(CellIdsInMessages, DiscordantTriangles)
{
  // Corner 2 of triangle 2, used by no other triangle, is moved far out: its foot on the opposite
  // edge leaves that edge.
  const auto pull = [](vtkPolyData* mesh) {
    double p[3];
    mesh->GetPoint(2, p);
    mesh->GetPoints()->SetPoint(2, 4.0 * p[0], p[1], 0.0);
  };
  const auto contour = vtkDifferentiableHomeomorphism::CONTOUR;
  const std::string source = Message([&](const MeshPair& pair) { pull(pair.Source); }, contour);
  EXPECT_NE(source.find("1 triangle of the source (cell 3) is discordant"), std::string::npos)
    << source;
  const std::string target = Message([&](const MeshPair& pair) { pull(pair.Target); }, contour);
  EXPECT_NE(target.find("1 triangle of the target (cell 7) is discordant"), std::string::npos)
    << target;
}

TEST(CellIdsInMessages, NonTriangles)
{
  const auto add = [](vtkPolyData* mesh) {
    const vtkIdType square[] = { 0, 1, 4, 3 };
    mesh->GetPolys()->InsertNextCell(4, square);
  };
  EXPECT_NE(Message([&](const MeshPair& pair) {
    add(pair.Target);
  }).find("1 cell of the target (cell 13) is not a triangle"),
    std::string::npos);
  EXPECT_NE(Message([&](const MeshPair& pair) {
    add(pair.Source);
  }).find("1 cell of the source (cell 9) is not a triangle"),
    std::string::npos);
}

} // namespace
