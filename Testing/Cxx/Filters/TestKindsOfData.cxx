// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The filters process every kind of data, and trees of data sets: types, cells and arrays are kept,
// and the results are the same as for the points alone.

#include "Fixtures/FilterRuns.h"

#include "vtkCellType.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkFieldData.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkRectilinearGrid.h"
#include "vtkStringArray.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"

namespace
{

using namespace fixtures;

const MeshPair& ThePair()
{
  static const MeshPair pair = MakePlanarPair(8, 300);
  return pair;
}

/// The data with arrays of several kinds: point data, cell data and field data.
vtkSmartPointer<vtkDataSet> WithArrays(const vtkSmartPointer<vtkDataSet>& data)
{
  const auto names = [](const char* name, vtkIdType count) {
    auto array = vtkSmartPointer<vtkStringArray>::New();
    array->SetName(name);
    array->SetNumberOfValues(count);
    return array;
  };
  const vtkIdType points = data->GetNumberOfPoints();
  const vtkIdType cells = data->GetNumberOfCells();
  data->GetPointData()->SetScalars(RandomArray("Temperature", 1, points, 20));
  data->GetPointData()->AddArray(RandomArray<vtkIntArray>("Number", 2, points, 21));
  data->GetPointData()->AddArray(RandomArray<vtkFloatArray>("Unmarked", 3, points, 22));
  data->GetPointData()->AddArray(names("PointName", points));
  data->GetCellData()->SetScalars(RandomArray<vtkFloatArray>("Pressure", 1, cells, 23));
  data->GetCellData()->AddArray(RandomArray<vtkIdTypeArray>("Material", 1, cells, 24));
  data->GetCellData()->AddArray(names("CellName", cells));
  data->GetFieldData()->AddArray(names("Remarks", 3));
  return data;
}

/// Data of each kind, inside the domain and slightly beyond.
std::vector<vtkSmartPointer<vtkDataSet>> AllKinds()
{
  const vtkSmartPointer<vtkPolyData> mesh = ThePair().Source;
  const auto image = MakeImage({ -3, 17, 5, 30, 2, 4 }, { 1.0, -0.25, 0.5 }, { 0.37, 0.28, 0.125 });
  // Rotated in the plane by an angle of the triangle with the sides 3, 4, 5.
  image->SetDirectionMatrix(0.8, 0.6, 0.0, -0.6, 0.8, 0.0, 0.0, 0.0, 1.0);

  vtkNew<vtkRectilinearGrid> rectilinear;
  rectilinear->SetExtent(2, 14, -1, 9, 0, 1);
  const auto coordinates = [](int count, double first, double last) {
    const auto array = vtkSmartPointer<vtkFloatArray>::New();
    for (int i = 0; i < count; ++i)
    {
      const double t = static_cast<double>(i) / (count - 1);
      array->InsertNextValue(static_cast<float>(first + (last - first) * t * t));
    }
    return array;
  };
  rectilinear->SetXCoordinates(coordinates(13, -0.5, 7.5));
  rectilinear->SetYCoordinates(coordinates(11, 0.125, 8.0));
  rectilinear->SetZCoordinates(coordinates(2, 0.0, 1.0));

  vtkNew<vtkStructuredGrid> structured;
  structured->SetExtent(4, 15, 1, 7, 0, 0);
  structured->SetPoints(
    MakeCloud(PointsOf(MakeCloud(mesh, RandomSamples(mesh, 84, 25))), VTK_FLOAT)->GetPoints());

  vtkNew<vtkUnstructuredGrid> unstructured;
  unstructured->SetPoints(MakeCloud(mesh, RandomSamples(mesh, 40, 26))->GetPoints());
  vtkNew<vtkPolyData> polygons;
  polygons->SetPoints(MakeCloud(mesh, RandomSamples(mesh, 60, 27))->GetPoints());
  polygons->AllocateEstimate(40, 8);
  for (vtkIdType i = 0; i + 8 <= 40; i += 4)
  {
    const vtkIdType ids[8] = { i, i + 1, i + 2, i + 3, i + 4, i + 5, i + 6, i + 7 };
    unstructured->InsertNextCell(VTK_TETRA, 4, ids);
    unstructured->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
    unstructured->InsertNextCell(VTK_QUADRATIC_TRIANGLE, 6, ids);
    unstructured->InsertNextCell(VTK_VERTEX, 1, ids);
    polygons->InsertNextCell(VTK_POLY_VERTEX, 3, ids);
    polygons->InsertNextCell(VTK_POLY_LINE, 6, ids);
    polygons->InsertNextCell(VTK_POLYGON, 5, ids);
    polygons->InsertNextCell(VTK_TRIANGLE_STRIP, 4, ids);
  }
  // Cells are numbered by kinds, not as they were inserted.
  polygons->DeleteCells();
  return { WithArrays(polygons), WithArrays(unstructured), WithArrays(structured),
    WithArrays(rectilinear), WithArrays(image) };
}

/// The output has the arrays of the input themselves, with their roles.
void ExpectArraysPassed(vtkFieldData* input, vtkFieldData* output)
{
  for (int i = 0; i < input->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = input->GetAbstractArray(i);
    EXPECT_EQ(output->GetAbstractArray(array->GetName()), array) << array->GetName();
  }
  auto* attributes = vtkDataSetAttributes::SafeDownCast(input);
  for (int role = 0; attributes && role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role)
  {
    EXPECT_EQ(vtkDataSetAttributes::SafeDownCast(output)->GetAbstractAttribute(role),
      attributes->GetAbstractAttribute(role));
  }
}

/// Cells and arrays of the input are in the output.
void ExpectPassed(vtkDataSet* input, vtkDataSet* output)
{
  ASSERT_EQ(output->GetNumberOfCells(), input->GetNumberOfCells());
  for (vtkIdType i = 0; i < input->GetNumberOfCells(); ++i)
  {
    std::vector<vtkIdType> before = IdsOf(input, i);
    std::vector<vtkIdType> after = IdsOf(output, i);
    if (output->GetClassName() != std::string(input->GetClassName()))
    {
      // Voxels and hexahedra number their points differently.
      std::sort(before.begin(), before.end());
      std::sort(after.begin(), after.end());
    }
    ASSERT_EQ(before, after);
  }
  ExpectArraysPassed(input->GetPointData(), output->GetPointData());
  ExpectArraysPassed(input->GetCellData(), output->GetCellData());
  ExpectArraysPassed(input->GetFieldData(), output->GetFieldData());
}

/// A filter, and the arrays that it adds to the points.
struct AFilter
{
  const char* Name;
  vtkSmartPointer<vtkHomeomorphismAlgorithm> (*Make)();
  std::vector<const char*> Arrays;
  bool MovesPoints;
};

const AFilter TheMap{ "Map",
  []() -> vtkSmartPointer<vtkHomeomorphismAlgorithm> { return MakeFilter(Smooth, ThePair()); },
  { "vtkValidPointMask" }, true };
const AFilter TheCoordinates{ "Coordinates",
  []() -> vtkSmartPointer<vtkHomeomorphismAlgorithm> {
    return MakeCoordinates(Smooth, ThePair().Source);
  },
  { "TriangleId", "EdgeLabel", "EdgeParameter", "ContourParameter", "vtkValidPointMask" }, false };

/// The points of the output are those of a point cloud. If points move, images and rectilinear
/// grids become structured grids.
void Expect(const AFilter& kind, vtkDataSet* input, vtkDataObject* object)
{
  auto* output = vtkDataSet::SafeDownCast(object);
  ASSERT_TRUE(output);
  auto* pointSet = vtkPointSet::SafeDownCast(input);
  const bool isSame = pointSet || !kind.MovesPoints;
  EXPECT_STREQ(output->GetClassName(), isSame ? input->GetClassName() : "vtkStructuredGrid");
  const int type = pointSet ? pointSet->GetPoints()->GetDataType() : VTK_DOUBLE;
  auto* points = vtkPointSet::SafeDownCast(output);
  EXPECT_TRUE(!points || points->GetPoints()->GetDataType() == type);
  const auto alone = kind.Make();
  alone->SetDataObject(MakeCloud(PointsOf(input), type));
  ExpectSame(output, Output(alone.Get()), kind.Arrays);
  ExpectPassed(input, output);
}

class KindsOfData : public ::testing::TestWithParam<AFilter>
{
protected:
  vtkDataObject* Run(vtkDataObject* data)
  {
    this->Filter->SetDataObject(data);
    this->Filter->Update();
    EXPECT_EQ(this->Filter->GetErrorCode(), 0u);
    return this->Filter->GetOutputDataObject(0);
  }

  void ExpectTree(vtkDataObjectTree* input);

  const vtkSmartPointer<vtkHomeomorphismAlgorithm> Filter = GetParam().Make();
};

INSTANTIATE_TEST_SUITE_P(All, KindsOfData, ::testing::Values(TheMap, TheCoordinates),
  [](const ::testing::TestParamInfo<AFilter>& one) { return one.param.Name; });

TEST_P(KindsOfData, MayChangeBetweenUpdates)
{
  for (int round = 0; round < 2; ++round)
  {
    for (const auto& data : AllKinds())
    {
      SCOPED_TRACE(data->GetClassName());
      Expect(GetParam(), data, this->Run(data));
      // The input is not modified.
      EXPECT_FALSE(PointArray(data, "vtkValidPointMask"));
    }
    vtkNew<vtkMultiBlockDataSet> tree;
    tree->SetBlock(0, AllKinds().back());
    EXPECT_TRUE(vtkMultiBlockDataSet::SafeDownCast(this->Run(tree)));
  }
}

/// The output has the nodes, names and leaves of the input. The points outside all leaves are
/// counted together.
void KindsOfData::ExpectTree(vtkDataObjectTree* input)
{
  auto* output = vtkDataObjectTree::SafeDownCast(this->Run(input));
  ASSERT_TRUE(output);
  EXPECT_STREQ(output->GetClassName(), input->GetClassName());
  ExpectArraysPassed(input->GetFieldData(), output->GetFieldData());
  const auto node = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(input->NewTreeIterator());
  const auto nameOf = [&node](vtkDataObjectTree* tree) {
    return tree->HasMetaData(node) ? tree->GetMetaData(node)->Get(vtkCompositeDataSet::NAME())
                                   : nullptr;
  };
  node->VisitOnlyLeavesOff();
  node->SkipEmptyNodesOff();
  vtkIdType outside = 0;
  for (node->InitTraversal(); !node->IsDoneWithTraversal(); node->GoToNextItem())
  {
    vtkDataObject* before = node->GetCurrentDataObject();
    vtkDataObject* after = output->GetDataSet(node);
    EXPECT_STREQ(nameOf(input), nameOf(output));
    ASSERT_EQ(before != nullptr, after != nullptr);
    auto* leaf = vtkDataSet::SafeDownCast(before);
    if (leaf && leaf->GetNumberOfPoints() > 0)
    {
      Expect(GetParam(), leaf, after);
      outside += CountOutside(vtkDataSet::SafeDownCast(after));
    }
    else if (before)
    {
      EXPECT_STREQ(after->GetClassName(), before->GetClassName());
    }
  }
  EXPECT_EQ(this->Filter->GetNumberOfOutsidePoints(), outside);
  EXPECT_GT(outside, 0);
}

TEST_P(KindsOfData, Trees)
{
  const auto kinds = AllKinds();
  vtkNew<vtkMultiBlockDataSet> inner;
  inner->SetBlock(0, kinds[0]);
  inner->SetBlock(1, vtkNew<vtkMultiBlockDataSet>());
  inner->SetBlock(2, kinds[1]);
  inner->SetBlock(3, vtkNew<vtkPolyData>());
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetNumberOfBlocks(5);
  blocks->SetBlock(0, kinds[4]);
  blocks->SetBlock(2, inner);
  blocks->SetBlock(3, kinds[3]);
  blocks->GetMetaData(0u)->Set(vtkCompositeDataSet::NAME(), "picture");
  blocks->GetMetaData(2u)->Set(vtkCompositeDataSet::NAME(), "inner");
  blocks->GetFieldData()->AddArray(RandomArray("WholeTree", 2, 3, 28));
  vtkNew<vtkPartitionedDataSet> partitions;
  partitions->SetNumberOfPartitions(3);
  partitions->SetPartition(0, kinds[4]);
  partitions->SetPartition(2, kinds[4]);
  vtkNew<vtkPartitionedDataSetCollection> collection;
  collection->SetPartitionedDataSet(0, partitions);
  collection->SetPartitionedDataSet(1, vtkNew<vtkPartitionedDataSet>());
  collection->GetMetaData(0u)->Set(vtkCompositeDataSet::NAME(), "first");
  for (vtkDataObjectTree* tree :
    std::initializer_list<vtkDataObjectTree*>{ blocks, collection, partitions })
  {
    SCOPED_TRACE(tree->GetClassName());
    this->ExpectTree(tree);
  }
}

TEST_P(KindsOfData, EmptyInputsGiveEmptyOutputs)
{
  Messages messages(this->Filter);
  for (const auto& kind : AllKinds())
  {
    const auto data = vtkSmartPointer<vtkDataObject>::Take(kind->NewInstance());
    EXPECT_EQ(this->Run(data)->GetNumberOfElements(vtkDataObject::POINT), 0);
  }
  EXPECT_EQ(this->Run(vtkNew<vtkMultiBlockDataSet>())->GetNumberOfElements(0), 0);
  EXPECT_EQ(this->Run(vtkNew<vtkPartitionedDataSetCollection>())->GetNumberOfElements(0), 0);
  // All points are outside an empty domain, with points or without.
  for (const auto& empty :
    { vtkSmartPointer<vtkPolyData>::New(), MakeCloud({}), MakeCloud(PointsOf(ThePair().Source)) })
  {
    for (const System& system : AllSystems())
    {
      SetSystem(this->Filter.Get(), system);
      SetMeshes(this->Filter, { empty, empty });
      auto* output = vtkDataSet::SafeDownCast(this->Run(ThePair().Source));
      EXPECT_EQ(CountDifferentPoints(output, ThePair().Source), 0);
      EXPECT_EQ(this->Filter->GetNumberOfOutsidePoints(), output->GetNumberOfPoints());
      EXPECT_EQ(
        this->Run(nullptr)->GetNumberOfElements(vtkDataObject::POINT), empty->GetNumberOfPoints());
    }
  }
  EXPECT_EQ(messages.Error() + messages.Warning(), "");
}

TEST(KindsOfData, WithoutDataTheMeshIsMapped)
{
  const MeshPair pair = CopyOf(ThePair());
  WithArrays(pair.Source.Get());
  pair.Target->GetPointData()->SetScalars(RandomArray("OfTarget", 1, 81, 29));
  const auto filter = MakeFilter(Smooth, pair);
  Expect(TheMap, pair.Source, Output(filter));
  EXPECT_FALSE(PointArray(Output(filter), "OfTarget"));
  filter->InverseOn();
  EXPECT_EQ(CountDifferentPoints(Output(filter), pair.Source), 0);
  EXPECT_TRUE(PointArray(Output(filter), "OfTarget"));
  EXPECT_FALSE(PointArray(Output(filter), "Temperature"));
}

TEST(KindsOfData, PrecisionOfPoints)
{
  // Points that are equal in both precisions.
  const auto any = MakeCloud(ThePair().Source, RandomSamples(ThePair().Source, 5000, 30));
  const auto cloud = MakeCloud(PointsOf(MakeCloud(PointsOf(any), VTK_FLOAT)));
  const auto reference = MakeFilter(Smooth, ThePair(), cloud);
  for (const auto& [input, setting, result] :
    std::vector<std::array<int, 3>>{ { VTK_DOUBLE, vtkAlgorithm::DOUBLE_PRECISION, VTK_DOUBLE },
      { VTK_DOUBLE, vtkAlgorithm::DEFAULT_PRECISION, VTK_DOUBLE },
      { VTK_DOUBLE, vtkAlgorithm::SINGLE_PRECISION, VTK_FLOAT },
      { VTK_FLOAT, vtkAlgorithm::DEFAULT_PRECISION, VTK_FLOAT },
      { VTK_FLOAT, vtkAlgorithm::SINGLE_PRECISION, VTK_FLOAT },
      { VTK_FLOAT, vtkAlgorithm::DOUBLE_PRECISION, VTK_DOUBLE } })
  {
    const auto filter = MakeFilter(Smooth, ThePair(), MakeCloud(PointsOf(cloud), input));
    filter->SetOutputPointsPrecision(setting);
    ASSERT_EQ(Output(filter)->GetPoints()->GetDataType(), result);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    const auto expected = MakeCloud(PointsOf(Output(reference)), result);
    // A float point may be outside by its own rounding; it is then moved slightly.
    EXPECT_LE(LargestDistance(Output(filter), expected), input == VTK_FLOAT ? 4e-6 : 0.0);
  }
}

TEST(KindsOfData, HiddenPointsAreNotOffTheSurface)
{
  const MeshPair pair = MakeClosedPair(2, 5);
  const auto cloud = MakeCloud(PointsOf(pair.Source));
  cloud->GetPointData()->AddArray(
    MakeGhosts(cloud->GetNumberOfPoints(), { 7 }, vtkDataSetAttributes::HIDDENPOINT));
  const auto filter = MakeFilter(Smooth, pair, cloud);
  Messages messages(filter);
  EXPECT_FALSE(IsValid(Output(filter), 7));
  EXPECT_TRUE(IsValid(Output(filter), 8));
  EXPECT_EQ(messages.Warning(), "");
}

} // namespace
