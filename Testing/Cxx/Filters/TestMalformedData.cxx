// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Data whose arrays and cells do not match: nothing is read out of bounds, and what can be mapped
// is.

#include "Fixtures/FilterRuns.h"

#include "vtkResampleThroughHomeomorphism.h"

#include "vtkCellType.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnstructuredGrid.h"

namespace
{

using namespace fixtures;

constexpr double HiddenPoint = vtkDataSetAttributes::HIDDENPOINT;
constexpr double HiddenCell = vtkDataSetAttributes::HIDDENCELL;

/// Values that encode their position: component k of tuple i is 10 i + k + 1.
vtkSmartPointer<vtkDoubleArray> MakeNumbers(const char* name, int components, vtkIdType tuples)
{
  auto numbers = vtkSmartPointer<vtkDoubleArray>::New();
  numbers->SetName(name);
  numbers->SetNumberOfComponents(components);
  numbers->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < tuples * components; ++i)
  {
    numbers->SetValue(i, static_cast<double>(10 * (i / components) + i % components + 1));
  }
  return numbers;
}

/// Two triangles, the second of them outside.
vtkSmartPointer<vtkPolyData> MakeDataPartlyOutside()
{
  return MakeMesh(
    { { 0.5, 0.5, 0 }, { 1.5, 0.5, 0 }, { 0.5, 1.5, 0 }, { 5, 5, 0 }, { 6, 5, 0 }, { 5, 6, 0 } },
    { { 0, 1, 2 }, { 3, 4, 5 } });
}

std::vector<double> ValuesOf(vtkDataArray* array)
{
  std::vector<double> values;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(array->GetTuple1(i));
  }
  return values;
}

/// The square [0, 2] x [0, 2] is mapped to itself with doubled coordinates: J is twice the identity
/// in the plane.
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
    MakeFilter(Linear, { Source, Moved(Source, [](const Point& p) -> Point {
                          return { 2 * p[0], 2 * p[1], 0.0 };
                        }) });
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
    const std::vector<vtkSmartPointer<vtkDoubleArray>> arrays{ MakeNumbers("Vectors", 3, tuples),
      MakeNumbers("Normals", 3, tuples), MakeNumbers("Tensors", 9, tuples),
      MakeNumbers("Gradients", 3, tuples) };
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
  }
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 1);
  const auto vectors = MakeNumbers("Vectors", 3, 4000);
  image->GetPointData()->SetVectors(vectors);
  EXPECT_EQ(PointArray(this->Run(image), "Vectors"), vectors);
}

TEST_F(MalformedData, ArraysOfWrongLengthDoNotBlockOthers)
{
  const auto data = MakeDataPartlyOutside();
  const auto tooLong = MakeNumbers("TooLong", 3, 7);
  data->GetPointData()->SetVectors(MakeNumbers("Vectors", 3, 6));
  data->GetPointData()->AddArray(tooLong);
  this->Filter->TransformAllInputVectorsOn();
  vtkPointSet* output = this->Run(data);
  EXPECT_EQ(PointArray(output, "TooLong"), tooLong);
  EXPECT_LT(Distance(VectorOf(PointArray(output, "Vectors"), 2), { 42.0, 44.0, 23.0 }), 1e-13);
}

TEST_F(MalformedData, VectorsThatAreNotNumbersStayAlone)
{
  const auto data = MakeDataPartlyOutside();
  const auto vectors = MakeNumbers("Vectors", 3, 6);
  vectors->SetComponent(0, 0, NotANumber);
  data->GetPointData()->SetVectors(vectors);
  vtkDataArray* mapped = PointArray(this->Run(data), "Vectors");
  EXPECT_TRUE(std::isnan(mapped->GetComponent(0, 0)));
  EXPECT_LT(Distance(VectorOf(mapped, 1), { 22.0, 24.0, 13.0 }), 1e-13);
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
      data->GetCellData()->SetVectors(MakeNumbers("Vectors", 3, 3));
      vtkPointSet* output = this->Run(data);
      ASSERT_EQ(output->GetNumberOfPoints(), 6);
      ASSERT_EQ(output->GetNumberOfCells(), 3);
      // Only whole cells inside are visible.
      EXPECT_EQ(ValuesOf(CellArray(output, "vtkGhostType")),
        (std::vector<double>{ 0, HiddenCell, HiddenCell }));
      // Cell vectors are transformed at the center of the cell, which does not exist.
      vtkDataArray* vectors = output->GetCellData()->GetVectors();
      EXPECT_NEAR(vectors->GetComponent(0, 0), 2.0, 1e-13);
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
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1 });
  polygons->InsertNextCell({ 2 });
  polygons->InsertNextCell({ 0, 1, 3 });
  data->SetPolys(polygons);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 1 });
  data->SetLines(lines);
  data->GetCellData()->SetVectors(MakeNumbers("Flux", 3, 4));
  vtkPointSet* output = this->Run(data);
  ASSERT_EQ(output->GetNumberOfCells(), 4);
  EXPECT_EQ(
    ValuesOf(CellArray(output, "vtkGhostType")), (std::vector<double>{ 0, 0, 0, HiddenCell }));
  EXPECT_TRUE(std::isfinite(CellArray(output, "Flux")->GetComponent(0, 0)));
  EXPECT_TRUE(std::isnan(CellArray(output, "Flux")->GetComponent(3, 0)));
}

// --- Values that are looked for in data ----------------------------------------------------------

TEST_F(MalformedData, IsRefusedWhereValuesAreLookedFor)
{
  using Change = std::function<void(vtkPolyData*)>;
  const std::vector<std::pair<const char*, Change>> changes{
    { "a point that does not exist",
      [](vtkPolyData* data) {
        data->GetPolys()->InsertNextCell({ 0, 1, 9 });
      } },
    { "a polygon of two points",
      [](vtkPolyData* data) {
        data->GetPolys()->InsertNextCell({ 0, 1 });
      } },
    { "a point that is not a number",
      [](vtkPolyData* data) {
        MovePoint(data, 5, { 0, NotANumber, 0 });
      } },
    { "offsets that do not fit",
      [](vtkPolyData* data) {
        vtkNew<vtkTypeInt64Array> offsets;
        vtkNew<vtkTypeInt64Array> connectivity;
        for (const int offset : { 0, 3, 700 })
        {
          offsets->InsertNextValue(offset);
        }
        for (const int id : { 0, 1, 2 })
        {
          connectivity->InsertNextValue(id);
        }
        data->GetPolys()->SetData(offsets, connectivity);
      } },
    { "an array of another length",
      [](vtkPolyData* data) { data->GetPointData()->AddArray(MakeNumbers("Velocity", 3, 2)); } }
  };
  for (const auto& [name, change] : changes)
  {
    SCOPED_TRACE(name);
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
    change(changed);
    resample->SetDataObject(changed);
    resample->Update();
    EXPECT_TRUE(messages.HasError());
    EXPECT_EQ(resample->GetErrorCode(),
      static_cast<unsigned long>(vtkResampleThroughHomeomorphism::DATA_REFUSED));
    EXPECT_EQ(resample->GetOutput()->GetNumberOfPoints(), 0);
  }
}

// --- Arrays without a name, and with several roles -----------------------------------------------

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
    const auto plain = MakeNumbers(nullptr, 1, tuples);
    input->AddArray(plain);
    input->SetVectors(MakeNumbers(nullptr, 3, tuples));
    input->SetNormals(MakeNumbers(nullptr, 3, tuples));
    input->SetTensors(MakeNumbers(nullptr, 9, tuples));
    vtkDataSetAttributes* result = attributesOf(this->Run(data));
    int unnamed = 0;
    int kept = 0;
    for (int i = 0; i < result->GetNumberOfArrays(); ++i)
    {
      unnamed += result->GetAbstractArray(i)->GetName() == nullptr;
      for (int k = 0; k < input->GetNumberOfArrays(); ++k)
      {
        kept += result->GetAbstractArray(i) == input->GetAbstractArray(k);
      }
    }
    EXPECT_EQ(unnamed, 4);
    EXPECT_EQ(kept, 1);
    ASSERT_TRUE(result->GetVectors() && result->GetNormals() && result->GetTensors());
    EXPECT_NEAR(result->GetVectors()->GetComponent(0, 0), 2.0, 1e-13);
    EXPECT_NEAR(result->GetTensors()->GetComponent(0, 0), 4.0, 1e-13);
    EXPECT_NEAR(Norm(VectorOf(result->GetNormals(), 0)), 1.0, 1e-13);
    // The arrays of the input are unchanged.
    EXPECT_EQ(input->GetNumberOfArrays(), 4);
    EXPECT_EQ(input->GetVectors()->GetComponent(0, 0), 1.0);
  }
}

TEST_F(MalformedData, AnArrayKeepsAllItsRoles)
{
  // Velocities are often both the active vectors and the active scalars, for coloring.
  const auto data = MakeDataPartlyOutside();
  const auto velocities = MakeNumbers("Velocities", 3, 6);
  data->GetPointData()->SetScalars(velocities);
  data->GetPointData()->SetActiveVectors("Velocities");
  vtkPointData* result = this->Run(data)->GetPointData();
  ASSERT_TRUE(result->GetVectors());
  EXPECT_NEAR(result->GetVectors()->GetComponent(1, 0), 22.0, 1e-13);
  EXPECT_EQ(result->GetScalars(), result->GetVectors());
}

// --- Pieces --------------------------------------------------------------------------------------

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
    std::vector<vtkIdType> whole;
    for (int port = 0; port < 3; ++port)
    {
      whole.push_back(UpdatePiece(filter, 0, 1, port)->GetNumberOfCells());
      ASSERT_GT(whole.back(), 0);
    }
    // Consumers of all outputs request their pieces in turn, as in several processes. Data that is
    // no pipeline's output is in every piece.
    whole[0] *= ownData ? 2 : 1;
    std::vector<vtkIdType> sums(3, 0);
    for (int piece = 0; piece < 2; ++piece)
    {
      for (const int port : { 0, 1, 2 })
      {
        sums[port] += UpdatePiece(filter, piece, 2, port)->GetNumberOfCells();
      }
    }
    EXPECT_EQ(sums, whole);
    // A piece requested of the first output applies to all.
    sums.assign(3, 0);
    for (int piece = 0; piece < 2; ++piece)
    {
      filter->UpdatePiece(piece, 2, 0);
      for (const int port : { 0, 1, 2 })
      {
        vtkDataObject* data = filter->GetOutputDataObject(port);
        EXPECT_EQ(data->GetInformation()->Get(vtkDataObject::DATA_PIECE_NUMBER()), piece);
        sums[port] += vtkDataSet::SafeDownCast(data)->GetNumberOfCells();
      }
    }
    EXPECT_EQ(sums, whole);
  }
}

} // namespace
