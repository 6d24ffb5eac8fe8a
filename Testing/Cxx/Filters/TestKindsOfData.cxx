// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Every kind of data and trees of them go through the filters: types, cells and arrays are kept,
// and the results are those of the points alone.

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

/// Arrays of several kinds: point data, cell data and field data.
void AddArrays(vtkDataSet* data)
{
  const auto names = [](const char* name, vtkIdType count) {
    auto array = vtkSmartPointer<vtkStringArray>::New();
    array->SetName(name);
    for (vtkIdType i = 0; i < count; ++i)
    {
      array->InsertNextValue(std::to_string(i));
    }
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
  data->GetFieldData()->AddArray(RandomArray("Constants", 4, 2, 25));
}

// --- The kinds -----------------------------------------------------------------------------------

/// Inside the domain and slightly beyond.
vtkSmartPointer<vtkDataSet> MakeImage()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(-3, 17, 5, 30, 2, 4);
  image->SetOrigin(1.0, -0.25, 0.5);
  image->SetSpacing(0.37, 0.28, 0.125);
  // Rotated in the plane by an angle of the triangle with the sides 3, 4, 5.
  image->SetDirectionMatrix(0.8, 0.6, 0.0, -0.6, 0.8, 0.0, 0.0, 0.0, 1.0);
  return image;
}

vtkSmartPointer<vtkDataSet> MakeRectilinearGrid()
{
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  grid->SetExtent(2, 14, -1, 9, 0, 1);
  const auto coordinates = [](int count, double first, double last) {
    const auto array = vtkSmartPointer<vtkFloatArray>::New();
    for (int i = 0; i < count; ++i)
    {
      const double t = static_cast<double>(i) / (count - 1);
      array->InsertNextValue(static_cast<float>(first + (last - first) * t * t));
    }
    return array;
  };
  grid->SetXCoordinates(coordinates(13, -0.5, 7.5));
  grid->SetYCoordinates(coordinates(11, 0.125, 8.0));
  grid->SetZCoordinates(coordinates(2, 0.0, 1.0));
  return grid;
}

vtkSmartPointer<vtkDataSet> MakeStructuredGrid()
{
  auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
  grid->SetExtent(4, 15, 1, 7, 0, 0);
  vtkNew<vtkPoints> points;
  for (int j = 0; j < 7; ++j)
  {
    for (int i = 0; i < 12; ++i)
    {
      const double radius = 0.5 + 0.5 * j;
      points->InsertNextPoint(
        4.0 + radius * std::cos(0.5 * i), 4.0 + radius * std::sin(0.5 * i), 0.1 * j);
    }
  }
  grid->SetPoints(points);
  return grid;
}

vtkSmartPointer<vtkDataSet> MakeUnstructuredGrid()
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(
    MakeCloud(ThePair().Source, RandomSamples(ThePair().Source, 40, 26))->GetPoints());
  for (vtkIdType i = 0; i + 8 <= 40; i += 4)
  {
    const vtkIdType ids[8] = { i, i + 1, i + 2, i + 3, i + 4, i + 5, i + 6, i + 7 };
    grid->InsertNextCell(VTK_TETRA, 4, ids);
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
    grid->InsertNextCell(VTK_QUADRATIC_TRIANGLE, 6, ids);
    grid->InsertNextCell(VTK_VERTEX, 1, ids);
  }
  return grid;
}

vtkSmartPointer<vtkDataSet> MakePolyData()
{
  const auto data = MakeCloud(ThePair().Source, RandomSamples(ThePair().Source, 60, 27));
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell({ 0, 1, 2 });
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 3, 4, 5, 6, 7, 8 });
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 9, 10, 11, 12, 13 });
  polygons->InsertNextCell({ 14, 15, 16 });
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({ 17, 18, 19, 20 });
  data->SetVerts(verts);
  data->SetLines(lines);
  data->SetPolys(polygons);
  data->SetStrips(strips);
  return data;
}

vtkSmartPointer<vtkDataSet> WithArrays(const vtkSmartPointer<vtkDataSet>& data)
{
  AddArrays(data);
  return data;
}

std::vector<vtkSmartPointer<vtkDataSet>> AllKinds()
{
  return { WithArrays(MakePolyData()), WithArrays(MakeUnstructuredGrid()),
    WithArrays(MakeStructuredGrid()), WithArrays(MakeRectilinearGrid()), WithArrays(MakeImage()) };
}

// --- What must come out --------------------------------------------------------------------------

void ExpectArraysPassed(vtkFieldData* input, vtkFieldData* output)
{
  for (int i = 0; i < input->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* before = input->GetAbstractArray(i);
    vtkAbstractArray* after = output->GetAbstractArray(before->GetName());
    ASSERT_TRUE(after) << before->GetName();
    EXPECT_STREQ(after->GetClassName(), before->GetClassName());
    ASSERT_EQ(after->GetNumberOfValues(), before->GetNumberOfValues()) << before->GetName();
    for (vtkIdType k = 0; k < before->GetNumberOfValues(); ++k)
    {
      ASSERT_EQ(before->GetVariantValue(k), after->GetVariantValue(k)) << before->GetName();
    }
  }
}

void ExpectAttributesPassed(vtkDataSetAttributes* input, vtkDataSetAttributes* output)
{
  ExpectArraysPassed(input, output);
  for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role)
  {
    vtkAbstractArray* wanted = input->GetAbstractAttribute(role);
    EXPECT_EQ(output->GetAbstractAttribute(role),
      wanted ? output->GetAbstractArray(wanted->GetName()) : nullptr);
  }
}

/// Cells and arrays of the input are in the output.
void ExpectPassed(vtkDataSet* input, vtkDataSet* output)
{
  ASSERT_EQ(output->GetNumberOfCells(), input->GetNumberOfCells());
  vtkNew<vtkIdList> before;
  vtkNew<vtkIdList> after;
  for (vtkIdType i = 0; i < input->GetNumberOfCells(); ++i)
  {
    input->GetCellPoints(i, before);
    output->GetCellPoints(i, after);
    if (output->GetClassName() != std::string(input->GetClassName()))
    {
      // Voxels and hexahedra number their points differently.
      std::sort(before->begin(), before->end());
      std::sort(after->begin(), after->end());
    }
    ASSERT_TRUE(std::equal(before->begin(), before->end(), after->begin(), after->end()));
  }
  ExpectAttributesPassed(input->GetPointData(), output->GetPointData());
  ExpectAttributesPassed(input->GetCellData(), output->GetCellData());
  ExpectArraysPassed(input->GetFieldData(), output->GetFieldData());
}

/// The two filters and what they do with data.
struct AFilter
{
  const char* Name;
  vtkSmartPointer<vtkHomeomorphismAlgorithm> (*Make)();
  void (*Expect)(vtkDataSet* input, vtkDataObject* output);
};

vtkSmartPointer<vtkHomeomorphismAlgorithm> MakeMap()
{
  return MakeFilter(Smooth, ThePair());
}

/// The points are mapped as those of a point cloud; images and rectilinear grids become structured
/// grids.
void ExpectMapped(vtkDataSet* input, vtkDataObject* object)
{
  auto* output = vtkPointSet::SafeDownCast(object);
  ASSERT_TRUE(output);
  auto* pointSet = vtkPointSet::SafeDownCast(input);
  EXPECT_STREQ(output->GetClassName(), pointSet ? input->GetClassName() : "vtkStructuredGrid");
  const int type = pointSet ? pointSet->GetPoints()->GetDataType() : VTK_DOUBLE;
  EXPECT_EQ(output->GetPoints()->GetDataType(), type);
  const auto filter = MakeFilter(Smooth, ThePair(), MakeCloud(PointsOf(input), type));
  vtkPointSet* expected = Output(filter);
  EXPECT_EQ(CountDifferentPoints(output, expected), 0);
  EXPECT_EQ(CountDifferentValues(
              PointArray(output, "vtkValidPointMask"), PointArray(expected, "vtkValidPointMask")),
    0);
  if (auto* grid = vtkStructuredGrid::SafeDownCast(output))
  {
    int extent[6];
    int dimensions[3];
    grid->GetExtent(extent);
    grid->GetDimensions(dimensions);
    EXPECT_EQ(extent[1] - extent[0] + 1, dimensions[0]);
    EXPECT_EQ(input->GetNumberOfPoints(), vtkIdType(dimensions[0]) * dimensions[1] * dimensions[2]);
  }
  ExpectPassed(input, output);
}

vtkSmartPointer<vtkHomeomorphismAlgorithm> MakeTheCoordinates()
{
  return MakeCoordinates(Smooth, ThePair().Source);
}

/// The points have the coordinates of those of a point cloud.
void ExpectCoordinates(vtkDataSet* input, vtkDataObject* object)
{
  auto* output = vtkDataSet::SafeDownCast(object);
  ASSERT_TRUE(output);
  EXPECT_STREQ(output->GetClassName(), input->GetClassName());
  EXPECT_EQ(CountDifferentPoints(output, input), 0);
  const auto filter = MakeCoordinates(Smooth, ThePair().Source, MakeCloud(PointsOf(input)));
  vtkDataSet* expected = Output(filter);
  for (const char* name :
    { "TriangleId", "EdgeLabel", "EdgeParameter", "ContourParameter", "vtkValidPointMask" })
  {
    EXPECT_EQ(CountDifferentValues(PointArray(output, name), PointArray(expected, name)), 0)
      << name;
  }
  ExpectPassed(input, output);
}

std::string NameOfFilter(const ::testing::TestParamInfo<AFilter>& info)
{
  return info.param.Name;
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

  void ExpectTree(vtkDataObjectTree* input, vtkIdType& outside);

  const vtkSmartPointer<vtkHomeomorphismAlgorithm> Filter = GetParam().Make();
};

INSTANTIATE_TEST_SUITE_P(All, KindsOfData,
  ::testing::Values(AFilter{ "Map", MakeMap, ExpectMapped },
    AFilter{ "Coordinates", MakeTheCoordinates, ExpectCoordinates }),
  NameOfFilter);

// --- Tests ---------------------------------------------------------------------------------------

TEST_P(KindsOfData, MayChangeBetweenUpdates)
{
  for (int round = 0; round < 2; ++round)
  {
    for (const auto& data : AllKinds())
    {
      SCOPED_TRACE(data->GetClassName());
      GetParam().Expect(data, this->Run(data));
      // The input is not modified.
      EXPECT_FALSE(PointArray(data, "vtkValidPointMask"));
    }
    vtkNew<vtkMultiBlockDataSet> tree;
    tree->SetBlock(0, WithArrays(MakeImage()));
    EXPECT_TRUE(vtkMultiBlockDataSet::SafeDownCast(this->Run(tree)));
  }
}

/// The output has the nodes, names and leaves of the input. The points outside are counted.
void KindsOfData::ExpectTree(vtkDataObjectTree* input, vtkIdType& outside)
{
  auto* output = vtkDataObjectTree::SafeDownCast(this->Run(input));
  ASSERT_TRUE(output);
  EXPECT_STREQ(output->GetClassName(), input->GetClassName());
  ExpectArraysPassed(input->GetFieldData(), output->GetFieldData());
  vtkSmartPointer<vtkDataObjectTreeIterator> nodes[2];
  for (vtkDataObjectTree* tree : { input, output })
  {
    auto& node = nodes[tree == output];
    node.TakeReference(tree->NewTreeIterator());
    node->VisitOnlyLeavesOff();
    node->SkipEmptyNodesOff();
    node->InitTraversal();
  }
  outside = 0;
  for (; !nodes[0]->IsDoneWithTraversal(); nodes[0]->GoToNextItem(), nodes[1]->GoToNextItem())
  {
    ASSERT_FALSE(nodes[1]->IsDoneWithTraversal());
    const auto nameOf = [](vtkDataObjectTreeIterator* node) {
      const bool hasName =
        node->HasCurrentMetaData() && node->GetCurrentMetaData()->Has(vtkCompositeDataSet::NAME());
      return std::string(
        hasName ? node->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME()) : "");
    };
    EXPECT_EQ(nameOf(nodes[0]), nameOf(nodes[1]));
    vtkDataObject* before = nodes[0]->GetCurrentDataObject();
    vtkDataObject* after = nodes[1]->GetCurrentDataObject();
    ASSERT_EQ(before != nullptr, after != nullptr);
    auto* leaf = vtkDataSet::SafeDownCast(before);
    if (leaf && leaf->GetNumberOfPoints() > 0)
    {
      GetParam().Expect(leaf, after);
      for (vtkIdType i = 0; i < leaf->GetNumberOfPoints(); ++i)
      {
        outside += !IsValid(vtkDataSet::SafeDownCast(after), i);
      }
    }
    else if (before)
    {
      EXPECT_STREQ(after->GetClassName(), before->GetClassName());
    }
  }
  EXPECT_TRUE(nodes[1]->IsDoneWithTraversal());
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
  vtkNew<vtkPartitionedDataSet> second;
  second->SetPartition(0, kinds[0]);
  vtkNew<vtkPartitionedDataSetCollection> collection;
  collection->SetPartitionedDataSet(0, partitions);
  collection->SetPartitionedDataSet(1, vtkNew<vtkPartitionedDataSet>());
  collection->SetPartitionedDataSet(2, second);
  collection->GetMetaData(2u)->Set(vtkCompositeDataSet::NAME(), "second");
  for (vtkDataObjectTree* tree :
    std::initializer_list<vtkDataObjectTree*>{ blocks, collection, partitions })
  {
    SCOPED_TRACE(tree->GetClassName());
    // Outside points of all leaves are counted together.
    vtkIdType outside = -1;
    this->ExpectTree(tree, outside);
    EXPECT_EQ(this->Filter->GetNumberOfOutsidePoints(), outside);
    EXPECT_GT(outside, 0);
  }
}

TEST_P(KindsOfData, EmptyInputsGiveEmptyOutputs)
{
  Messages messages(this->Filter);
  for (const vtkSmartPointer<vtkDataObject>& data :
    std::initializer_list<vtkSmartPointer<vtkDataObject>>{ vtkSmartPointer<vtkPolyData>::New(),
      vtkSmartPointer<vtkImageData>::New(), vtkSmartPointer<vtkRectilinearGrid>::New(),
      vtkSmartPointer<vtkStructuredGrid>::New(), vtkSmartPointer<vtkUnstructuredGrid>::New(),
      vtkSmartPointer<vtkMultiBlockDataSet>::New(),
      vtkSmartPointer<vtkPartitionedDataSetCollection>::New() })
  {
    EXPECT_EQ(this->Run(data)->GetNumberOfElements(vtkDataObject::POINT), 0);
  }
  // All points are outside an empty domain.
  vtkNew<vtkPolyData> nothing;
  vtkNew<vtkPolyData> noCells;
  noCells->SetPoints(vtkNew<vtkPoints>());
  for (vtkPolyData* empty : { nothing.Get(), noCells.Get() })
  {
    for (const System& system : AllSystems())
    {
      this->Filter->SetCoordinateSystem(system.CoordinateSystem);
      this->Filter->SetCenterPoint(system.CenterPoint);
      this->Filter->SetSourceData(empty);
      if (this->Filter->GetNumberOfInputPorts() > 2)
      {
        this->Filter->SetTargetData(empty);
      }
      auto* output = vtkDataSet::SafeDownCast(this->Run(ThePair().Source));
      EXPECT_EQ(CountDifferentPoints(output, ThePair().Source), 0);
      EXPECT_EQ(this->Filter->GetNumberOfOutsidePoints(), output->GetNumberOfPoints());
      EXPECT_EQ(this->Run(nullptr)->GetNumberOfElements(vtkDataObject::POINT), 0);
    }
  }
  EXPECT_EQ(messages.Error() + messages.Warning(), "");
}

TEST(KindsOfData, WithoutDataTheMeshIsMapped)
{
  MeshPair pair = ThePair();
  vtkNew<vtkPolyData> source;
  source->ShallowCopy(pair.Source);
  AddArrays(source);
  vtkNew<vtkPolyData> target;
  target->ShallowCopy(pair.Target);
  target->GetPointData()->SetScalars(RandomArray("OfTarget", 1, target->GetNumberOfPoints(), 29));
  const auto filter = MakeFilter(Smooth, { source.Get(), target.Get() });
  ExpectMapped(source, Output(filter));
  EXPECT_EQ(CountDifferentPoints(Output(filter), target), 0);
  EXPECT_FALSE(PointArray(Output(filter), "OfTarget"));
  filter->InverseOn();
  vtkPointSet* output = Output(filter);
  EXPECT_EQ(CountDifferentPoints(output, source), 0);
  EXPECT_EQ(CountDifferentCells(output, target), 0);
  EXPECT_TRUE(PointArray(output, "OfTarget"));
  EXPECT_FALSE(PointArray(output, "Temperature"));
}

TEST(KindsOfData, PrecisionOfPoints)
{
  // Points that are equal in both precisions.
  const auto cloud = Moved(MakeCloud(ThePair().Source, RandomSamples(ThePair().Source, 5000, 30)),
    [](const Point& p) { return RoundedToFloat(p); });
  const auto reference = MakeFilter(Smooth, ThePair(), cloud);
  struct Case
  {
    int Input;
    int Setting;
    int Output;
  };
  for (const Case& one : { Case{ VTK_DOUBLE, vtkAlgorithm::DOUBLE_PRECISION, VTK_DOUBLE },
         Case{ VTK_DOUBLE, vtkAlgorithm::DEFAULT_PRECISION, VTK_DOUBLE },
         Case{ VTK_DOUBLE, vtkAlgorithm::SINGLE_PRECISION, VTK_FLOAT },
         Case{ VTK_FLOAT, vtkAlgorithm::DEFAULT_PRECISION, VTK_FLOAT },
         Case{ VTK_FLOAT, vtkAlgorithm::SINGLE_PRECISION, VTK_FLOAT },
         Case{ VTK_FLOAT, vtkAlgorithm::DOUBLE_PRECISION, VTK_DOUBLE } })
  {
    const auto filter = MakeFilter(Smooth, ThePair(), MakeCloud(PointsOf(cloud), one.Input));
    filter->SetOutputPointsPrecision(one.Setting);
    vtkPointSet* output = Output(filter);
    ASSERT_EQ(output->GetPoints()->GetDataType(), one.Output);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      Point expected = PointOf(Output(reference), i);
      expected = one.Output == VTK_FLOAT ? RoundedToFloat(expected) : expected;
      // A float point may be outside by its own rounding; it is then moved slightly.
      ASSERT_LE(Distance(PointOf(output, i), expected), one.Input == VTK_FLOAT ? 4e-6 : 0.0);
    }
  }
}

} // namespace
