// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkTriangularCoordinates: the coordinates, their lines, and the properties of the triangles.

#include "Fixtures/FilterRuns.h"

#include "vtkTriangularCoordinates.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkRectilinearGrid.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"

#include <map>
#include <set>
#include <sstream>

namespace
{

using namespace fixtures;

vtkSmartPointer<vtkTriangularCoordinates> MakeCoordinates(
  const System& system, vtkPolyData* triangulation, vtkDataObject* data = nullptr)
{
  auto filter = vtkSmartPointer<vtkTriangularCoordinates>::New();
  SetSystem(filter.Get(), system);
  filter->SetInputData(0, triangulation);
  if (data)
  {
    filter->SetDataObject(data);
  }
  filter->GenerateLinesOff();
  return filter;
}

vtkDataSet* Output(vtkTriangularCoordinates* filter)
{
  filter->Update();
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
}

/// The arrays that the filter adds, with access by point.
struct Coordinates
{
  explicit Coordinates(vtkDataSet* data)
    : Triangle(PointArray(data, "TriangleId"))
    , Edge(PointArray(data, "EdgeLabel"))
    , EdgeParameter(PointArray(data, "EdgeParameter"))
    , ContourParameter(PointArray(data, "ContourParameter"))
    , Mask(PointArray(data, "vtkValidPointMask"))
  {
  }
  vtkIdType T(vtkIdType i) const
  {
    return static_cast<vtkIdType>(this->Triangle->GetComponent(i, 0));
  }
  int E(vtkIdType i) const { return static_cast<int>(this->Edge->GetComponent(i, 0)); }
  double P(vtkIdType i) const { return this->EdgeParameter->GetComponent(i, 0); }
  double C(vtkIdType i) const { return this->ContourParameter->GetComponent(i, 0); }

  vtkDataArray* Triangle;
  vtkDataArray* Edge;
  vtkDataArray* EdgeParameter;
  vtkDataArray* ContourParameter;
  vtkDataArray* Mask;
};

/// Single meshes of every kind.
std::vector<std::pair<const char*, vtkSmartPointer<vtkPolyData>>> AllMeshes(std::uint64_t seed)
{
  std::vector<std::pair<const char*, vtkSmartPointer<vtkPolyData>>> meshes;
  for (const Pairing& pairing : AllPairings(8, 2, seed))
  {
    meshes.emplace_back(pairing.Name, pairing.Meshes.Target);
  }
  return meshes;
}

/// The center of a triangle in a system: the start of its contours.
Point CenterOf(const System& system, vtkPolyData* mesh, vtkIdType triangle)
{
  const std::array<Point, 3> c = CornersOf(mesh, triangle);
  Point weights{ 1.0, 1.0, 1.0 };
  if (system.CenterPoint == vtkDifferentiableHomeomorphism::INCENTER)
  {
    weights = { Distance(c[1], c[2]), Distance(c[2], c[0]), Distance(c[0], c[1]) };
  }
  return (1.0 / (weights[0] + weights[1] + weights[2])) *
    (weights[0] * c[0] + weights[1] * c[1] + weights[2] * c[2]);
}

class CoordinatesInEverySystem : public ::testing::TestWithParam<System>
{
};

INSTANTIATE_TEST_SUITE_P(
  All, CoordinatesInEverySystem, ::testing::ValuesIn(AllSystems()), NameOfSystem);

// --- Output 0: the coordinates -------------------------------------------------------------------

TEST_P(CoordinatesInEverySystem, ArraysHaveTheirTypesAndRanges)
{
  for (const auto& mesh : AllMeshes(700))
  {
    const auto filter = MakeCoordinates(
      GetParam(), mesh.second, MakeCloud(mesh.second, RandomSamples(mesh.second, 5000, 60)));
    vtkDataSet* output = Output(filter);
    const Coordinates found(output);
    ASSERT_TRUE(vtkIdTypeArray::SafeDownCast(found.Triangle));
    ASSERT_TRUE(vtkIntArray::SafeDownCast(found.Edge));
    ASSERT_TRUE(vtkDoubleArray::SafeDownCast(found.EdgeParameter));
    ASSERT_TRUE(vtkDoubleArray::SafeDownCast(found.ContourParameter));
    ASSERT_TRUE(vtkUnsignedCharArray::SafeDownCast(found.Mask));
    EXPECT_EQ(output->GetPointData()->GetNumberOfArrays(), 5);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0) << mesh.first;
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      ASSERT_TRUE(found.T(i) >= 0 && found.T(i) < mesh.second->GetNumberOfCells());
      ASSERT_TRUE(found.E(i) >= 1 && found.E(i) <= 3);
      ASSERT_TRUE(found.P(i) >= 0.0 && found.P(i) <= 1.0);
      ASSERT_TRUE(found.C(i) >= 0.0 && found.C(i) <= 1.0);
      ASSERT_EQ(found.Mask->GetComponent(i, 0), 1.0);
    }
  }
}

TEST(TriangularCoordinates, LinearCoordinatesFollowTheirDefinition)
{
  for (const auto& mesh : AllMeshes(710))
  {
    const std::vector<MeshPoint> samples = InnerSamples(mesh.second, 5000, 61, 1e-4);
    const auto filter = MakeCoordinates(Linear, mesh.second, MakeCloud(mesh.second, samples));
    const Coordinates found(Output(filter));
    vtkIdType wrong = 0;
    Worst worst;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      const auto id = static_cast<vtkIdType>(i);
      const Point& l = samples[i].Weights;
      wrong += found.T(id) != samples[i].Triangle;
      // The edge opposite the corner with the least weight.
      const auto least = static_cast<std::size_t>(std::min_element(l.begin(), l.end()) - l.begin());
      const double next = l[(least + 1) % 3] - l[least];
      const double previous = l[(least + 2) % 3] - l[least];
      if (next < 1e-9 || previous < 1e-9)
      {
        continue;
      }
      wrong += found.E(id) != static_cast<int>(least) + 1;
      worst.Take(std::abs(found.C(id) - (1.0 - 3.0 * l[least])), 1e-13);
      worst.Take(
        std::abs(found.P(id) - previous / (next + previous)) * (1.0 - 3.0 * l[least]), 1e-13);
    }
    EXPECT_EQ(wrong, 0) << mesh.first;
    EXPECT_LE(worst.OverBound, 1.0) << mesh.first;
  }
}

TEST_P(CoordinatesInEverySystem, EdgesAreNumberedAsDocumented)
{
  // Points on the edges: edge k is opposite the k-th point, and p runs from the next point to the
  // one after it. The contour of an edge point ends at the point itself: c = 1.
  for (const auto& mesh : AllMeshes(720))
  {
    Random random(62);
    std::vector<MeshPoint> samples;
    for (vtkIdType t = 0; t < mesh.second->GetNumberOfCells(); ++t)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        MeshPoint surfacePoint{ t, {} };
        const double p = random.Uniform(0.01, 0.99);
        surfacePoint.Weights[(k + 1) % 3] = 1.0 - p;
        surfacePoint.Weights[(k + 2) % 3] = p;
        samples.push_back(surfacePoint);
      }
    }
    const auto filter = MakeCoordinates(GetParam(), mesh.second, MakeCloud(mesh.second, samples));
    const Coordinates found(Output(filter));
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0) << mesh.first;
    Worst worst;
    vtkIdType own = 0;
    vtkNew<vtkIdList> ids;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      const auto id = static_cast<vtkIdType>(i);
      worst.Take(1.0 - found.C(id), 1e-12);
      // The triangle may be the neighbor; the point of the edge at p must be the point.
      mesh.second->GetCellPoints(found.T(id), ids);
      const int k = found.E(id) - 1;
      const Point start = PointOf(mesh.second, ids->GetId((k + 1) % 3));
      const Point end = PointOf(mesh.second, ids->GetId((k + 2) % 3));
      const double p = found.P(id);
      worst.Take(Distance((1.0 - p) * start + p * end, PositionOf(mesh.second, samples[i])), 1e-12);
      if (found.T(id) == samples[i].Triangle)
      {
        ++own;
        EXPECT_EQ(k, static_cast<int>(i % 3));
      }
    }
    EXPECT_LE(worst.OverBound, 1.0) << mesh.first;
    EXPECT_GT(own, static_cast<vtkIdType>(samples.size() / 3));
  }
}

TEST_P(CoordinatesInEverySystem, TheCenterIsAtZeroAndVerticesAreAtOne)
{
  for (const auto& mesh : AllMeshes(725))
  {
    std::vector<Point> centers;
    for (vtkIdType t = 0; t < mesh.second->GetNumberOfCells(); ++t)
    {
      centers.push_back(CenterOf(GetParam(), mesh.second, t));
    }
    const auto filter = MakeCoordinates(GetParam(), mesh.second, MakeCloud(centers));
    const Coordinates atCenters(Output(filter));
    for (vtkIdType t = 0; t < mesh.second->GetNumberOfCells(); ++t)
    {
      ASSERT_EQ(atCenters.T(t), t);
      ASSERT_LE(atCenters.C(t), 1e-13) << mesh.first;
    }
    const auto onVertices = MakeCoordinates(GetParam(), mesh.second);
    const Coordinates atVertices(Output(onVertices));
    for (vtkIdType i = 0; i < mesh.second->GetNumberOfPoints(); ++i)
    {
      ASSERT_GE(atVertices.C(i), 1.0 - 1e-13);
      ASSERT_LE(std::min(atVertices.P(i), 1.0 - atVertices.P(i)), 1e-13);
    }
  }
}

TEST_P(CoordinatesInEverySystem, CorrespondingPointsHaveEqualCoordinates)
{
  // By definition of the homeomorphism. The pairs are concordant wherever the Contour system would
  // otherwise be replaced by Linear in different triangles of P alone, of Q alone and of both.
  const Matrix tilt = Tilt();
  const MeshPair planar = MakePlanarPair(10, 730, 0.06);
  std::vector<Pairing> pairings{ { "planar", planar },
    { "tilted", { planar.Source, Tilted(planar.Target, tilt, { 1.0, 0.0, 2.0 }) } } };
  if (GetParam().CoordinateSystem != vtkDifferentiableHomeomorphism::CONTOUR ||
    GetParam().CenterPoint == vtkDifferentiableHomeomorphism::INCENTER)
  {
    for (const Pairing& pairing : AllPairings(8, 2, 731))
    {
      pairings.push_back(pairing);
    }
  }
  for (const Pairing& pairing : pairings)
  {
    const MeshPair& pair = pairing.Meshes;
    const std::vector<MeshPoint> samples = InnerSamples(pair.Source, 5000, 63, 1e-3);
    const auto cloud = MakeCloud(pair.Source, samples);
    const auto onSource = MakeCoordinates(GetParam(), pair.Source, cloud);
    const auto map = MakeFilter(GetParam(), pair, cloud);
    const auto onTarget = MakeCoordinates(GetParam(), pair.Target);
    onTarget->SetDataConnection(map->GetOutputPort());
    const Coordinates before(Output(onSource));
    const Coordinates after(Output(onTarget));
    vtkIdType wrong = 0;
    Worst worst;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      wrong +=
        before.T(i) != after.T(i) || before.T(i) != samples[static_cast<std::size_t>(i)].Triangle;
      worst.Take(std::abs(before.C(i) - after.C(i)), 1e-12);
      if (before.E(i) != after.E(i))
      {
        // Only on a spoke, whose contours belong to two edges.
        const double toEnd = std::min(before.P(i), 1.0 - before.P(i));
        wrong += toEnd * before.C(i) > 1e-12;
        continue;
      }
      // The accuracy of p grows with the distance from the center and decreases with the curvature
      // of contours towards a vertex.
      worst.Take(std::abs(before.P(i) - after.P(i)) * before.C(i), 1e-11);
    }
    EXPECT_EQ(wrong, 0) << pairing.Name;
    EXPECT_LE(worst.OverBound, 1.0) << pairing.Name;
  }
}

TEST_P(CoordinatesInEverySystem, OutsideAndNonFinitePointsAreMarked)
{
  const auto mesh = MakePlanarPair(6, 740).Source;
  const double nan = vtkMath::Nan();
  const std::vector<Point> positions{ { 1.5, 2.5, 0.0 }, { -0.01, 2.0, 0.0 }, { 7.0, 7.0, 7.0 },
    { nan, 1.0, 0.0 }, { 1.5, 2.5, 1e9 } };
  const auto filter = MakeCoordinates(GetParam(), mesh, MakeCloud(positions));
  const Coordinates found(Output(filter));
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 3);
  for (const vtkIdType i : { 1, 2, 3 })
  {
    EXPECT_EQ(found.T(i), -1);
    EXPECT_EQ(found.E(i), 0);
    EXPECT_TRUE(std::isnan(found.P(i)));
    EXPECT_TRUE(std::isnan(found.C(i)));
    EXPECT_EQ(found.Mask->GetComponent(i, 0), 0.0);
  }
  // The distance from the plane is ignored.
  EXPECT_EQ(found.T(0), found.T(4));
  EXPECT_EQ(found.P(0), found.P(4));
  EXPECT_EQ(found.C(0), found.C(4));

  filter->SetTolerance(0.01);
  const Coordinates reached(Output(filter));
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 2);
  EXPECT_GE(reached.C(1), 1.0 - 1e-13);
}

// --- Kinds of data -------------------------------------------------------------------------------

TEST(TriangularCoordinates, EveryKindOfDataKeepsItsType)
{
  const auto mesh = MakePlanarPair(6, 750).Source;
  vtkNew<vtkImageData> image;
  image->SetExtent(-3, 20, 0, 10, 0, 1);
  image->SetSpacing(0.3, 0.5, 1.0);
  vtkNew<vtkRectilinearGrid> rectilinear;
  rectilinear->SetExtent(1, 2, 1, 3, 0, 0);
  for (const int axis : { 0, 1, 2 })
  {
    vtkNew<vtkDoubleArray> coordinates;
    for (int i = 0; i < (axis == 2 ? 1 : 2 + axis); ++i)
    {
      coordinates->InsertNextValue(0.3 + 1.7 * i);
    }
    axis == 0 ? rectilinear->SetXCoordinates(coordinates)
              : (axis == 1 ? rectilinear->SetYCoordinates(coordinates)
                           : rectilinear->SetZCoordinates(coordinates));
  }
  const auto cloud = MakeCloud(mesh, RandomSamples(mesh, 24, 64));
  vtkNew<vtkStructuredGrid> structured;
  structured->SetExtent(5, 8, 0, 5, 3, 3);
  structured->SetPoints(cloud->GetPoints());
  vtkNew<vtkUnstructuredGrid> unstructured;
  unstructured->SetPoints(cloud->GetPoints());
  const vtkIdType ids[] = { 0, 1, 2, 3 };
  unstructured->InsertNextCell(VTK_TETRA, 4, ids);
  for (vtkDataSet* data : std::initializer_list<vtkDataSet*>{
         image, rectilinear, structured, unstructured, cloud.Get(), mesh.Get() })
  {
    data->GetPointData()->SetScalars(RandomArray("Temperature", 1, data->GetNumberOfPoints(), 65));
    data->GetCellData()->SetScalars(RandomArray("Pressure", 1, data->GetNumberOfCells(), 66));
    data->GetFieldData()->AddArray(RandomArray("Constants", 1, 3, 67));
  }

  const auto expectCoordinates = [&mesh](vtkDataSet* data, vtkDataObject* outputObject) {
    auto* output = vtkDataSet::SafeDownCast(outputObject);
    ASSERT_TRUE(output);
    EXPECT_STREQ(output->GetClassName(), data->GetClassName());
    EXPECT_EQ(CountDifferentPoints(output, data), 0);
    EXPECT_EQ(CountDifferentCells(output, data), 0);
    EXPECT_EQ(CountDifferentValues(
                output->GetPointData()->GetScalars(), data->GetPointData()->GetScalars()),
      0);
    EXPECT_EQ(
      CountDifferentValues(output->GetCellData()->GetScalars(), data->GetCellData()->GetScalars()),
      0);
    EXPECT_TRUE(output->GetFieldData()->GetArray("Constants"));
    EXPECT_FALSE(PointArray(data, "EdgeLabel")) << "the input was changed";
    std::vector<Point> positions;
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    {
      positions.push_back(PointOf(data, i));
    }
    const auto reference = MakeCoordinates(Smooth, mesh, MakeCloud(positions));
    vtkDataSet* expected = Output(reference);
    for (const char* name :
      { "TriangleId", "EdgeLabel", "EdgeParameter", "ContourParameter", "vtkValidPointMask" })
    {
      EXPECT_EQ(CountDifferentValues(PointArray(output, name), PointArray(expected, name)), 0)
        << data->GetClassName() << " " << name;
    }
  };
  const auto filter = MakeCoordinates(Smooth, mesh);
  for (vtkDataSet* data :
    std::initializer_list<vtkDataSet*>{ image, rectilinear, structured, unstructured, cloud.Get() })
  {
    filter->SetDataObject(data);
    expectCoordinates(data, Output(filter));
  }

  vtkNew<vtkMultiBlockDataSet> inner;
  inner->SetBlock(1, unstructured);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, image);
  blocks->SetBlock(2, inner);
  blocks->GetMetaData(0u)->Set(vtkCompositeDataSet::NAME(), "picture");
  filter->SetDataObject(blocks);
  filter->Update();
  auto* tree = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(tree);
  ASSERT_EQ(tree->GetNumberOfBlocks(), 3u);
  expectCoordinates(image, tree->GetBlock(0));
  EXPECT_FALSE(tree->GetBlock(1));
  auto* outputInner = vtkMultiBlockDataSet::SafeDownCast(tree->GetBlock(2));
  ASSERT_TRUE(outputInner);
  EXPECT_FALSE(outputInner->GetBlock(0));
  expectCoordinates(unstructured, outputInner->GetBlock(1));
  EXPECT_STREQ(tree->GetMetaData(0u)->Get(vtkCompositeDataSet::NAME()), "picture");
  const auto alone = MakeCoordinates(Smooth, mesh, image);
  alone->Update();
  EXPECT_GT(alone->GetNumberOfOutsidePoints(), 0);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), alone->GetNumberOfOutsidePoints());

  vtkNew<vtkPartitionedDataSet> partitions;
  partitions->SetPartition(0, cloud);
  vtkNew<vtkPartitionedDataSetCollection> collection;
  collection->SetPartitionedDataSet(1, partitions);
  filter->SetDataObject(collection);
  filter->Update();
  auto* outputCollection =
    vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(outputCollection);
  ASSERT_EQ(outputCollection->GetNumberOfPartitions(1), 1u);
  expectCoordinates(cloud, outputCollection->GetPartition(1, 0));
}

TEST(TriangularCoordinates, WithoutDataTheTriangulationIsTheData)
{
  const auto mesh = MakeClosedPair(2, 755).Target;
  mesh->GetCellData()->AddArray(RandomArray("Own", 1, mesh->GetNumberOfCells(), 68));
  const auto filter = MakeCoordinates(Smooth, mesh);
  auto* output = vtkPolyData::SafeDownCast(Output(filter));
  ASSERT_TRUE(output);
  EXPECT_EQ(CountDifferentPoints(output, mesh), 0);
  EXPECT_TRUE(PointArray(output, "EdgeLabel"));
  for (const char* name : { "Own", "Concordant", "ConcordanceMargin", "UsedCoordinateSystem",
         "SmallestAngle", "StripWidth", "DeterminantBound" })
  {
    EXPECT_TRUE(output->GetCellData()->GetArray(name)) << name;
    EXPECT_TRUE(filter->GetTriangulation()->GetCellData()->GetArray(name)) << name;
  }
  EXPECT_FALSE(PointArray(filter->GetTriangulation(), "EdgeLabel"));
  EXPECT_FALSE(mesh->GetCellData()->GetArray("Concordant"));
  // If there is data, the arrays of the triangulation are on output 2 only.
  filter->SetDataObject(MakeCloud(mesh, RandomSamples(mesh, 10, 69)));
  EXPECT_FALSE(Output(filter)->GetCellData()->GetArray("Concordant"));
}

TEST_P(CoordinatesInEverySystem, EmptyInputsGiveEmptyOutputsWithoutErrors)
{
  const auto mesh = MakePlanarPair(3, 760, 0.05).Source;
  const vtkNew<vtkPolyData> nothing;
  for (const bool hasData : { false, true })
  {
    vtkNew<vtkTriangularCoordinates> filter;
    Messages messages(filter);
    filter->SetCoordinateSystem(GetParam().CoordinateSystem);
    filter->SetCenterPoint(GetParam().CenterPoint);
    filter->SetInputData(0, nothing);
    if (hasData)
    {
      filter->SetDataObject(mesh);
    }
    filter->Update();
    EXPECT_FALSE(messages.HasError()) << messages.Error();
    EXPECT_FALSE(messages.HasWarning()) << messages.Warning();
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), hasData ? mesh->GetNumberOfPoints() : 0);
    EXPECT_EQ(filter->GetLines()->GetNumberOfCells(), 0);
    EXPECT_EQ(filter->GetTriangulation()->GetNumberOfCells(), 0);
    EXPECT_EQ(filter->GetNumberOfDiscordantTriangles(), 0);
    filter->SetInputData(0, mesh);
    filter->SetDataObject(nothing);
    filter->Update();
    EXPECT_FALSE(messages.HasError()) << messages.Error();
    EXPECT_EQ(Output(filter)->GetNumberOfPoints(), 0);
  }
}

// --- Output 1: the lines -------------------------------------------------------------------------

/// Points and arrays of one line.
struct Line
{
  int Type;
  vtkIdType Triangle;
  int Edge;
  double P;
  double C;
  std::vector<Point> Points;
};

std::vector<Line> ReadLines(vtkPolyData* lines)
{
  std::vector<Line> result;
  vtkCellData* cellData = lines->GetCellData();
  EXPECT_EQ(cellData->GetScalars(), cellData->GetArray("LineType"));
  EXPECT_EQ(lines->GetNumberOfCells(), lines->GetNumberOfLines());
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < lines->GetNumberOfCells(); ++i)
  {
    Line line{ static_cast<int>(cellData->GetArray("LineType")->GetComponent(i, 0)),
      static_cast<vtkIdType>(cellData->GetArray("TriangleId")->GetComponent(i, 0)),
      static_cast<int>(cellData->GetArray("EdgeLabel")->GetComponent(i, 0)),
      cellData->GetArray("EdgeParameter")->GetComponent(i, 0),
      cellData->GetArray("ContourParameter")->GetComponent(i, 0), {} };
    lines->GetCellPoints(i, ids);
    for (const vtkIdType id : *ids)
    {
      line.Points.push_back(PointOf(lines, id));
    }
    result.push_back(line);
  }
  return result;
}

TEST_P(CoordinatesInEverySystem, AllLinesExist)
{
  const auto mesh = MakePlanarPair(4, 770, 0.05).Source;
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell({ 0 });
  mesh->SetVerts(verts); // shifts the cell ids by one
  for (const int contours : { 1, 4, 7 })
  {
    for (const int rings : { 1, 5 })
    {
      const auto filter = MakeCoordinates(GetParam(), mesh);
      filter->GenerateLinesOn();
      filter->SetNumberOfContours(contours);
      filter->SetNumberOfRings(rings);
      filter->SetLineResolution(3);
      filter->Update();
      std::map<std::pair<vtkIdType, int>, int> counts;
      std::set<std::pair<double, int>> contoursSeen;
      for (const Line& line : ReadLines(filter->GetLines()))
      {
        ++counts[{ line.Triangle, line.Type }];
        const bool isContour = line.Type == vtkTriangularCoordinates::CONTOUR_LINE;
        const bool isRing = line.Type == vtkTriangularCoordinates::RING_LINE;
        EXPECT_EQ(line.Edge == 0, isRing);
        EXPECT_TRUE(line.Edge >= 0 && line.Edge <= 3);
        EXPECT_EQ(std::isnan(line.P), !isContour);
        EXPECT_EQ(std::isnan(line.C), !isRing);
        if (isContour)
        {
          EXPECT_EQ(line.Points.size(), 4u);
          contoursSeen.insert({ line.P, line.Edge });
        }
        if (isRing)
        {
          EXPECT_EQ(line.Points.size(), 10u);
          const double n = line.C * rings;
          EXPECT_NEAR(n, std::round(n), 1e-12);
        }
      }
      EXPECT_EQ(contoursSeen.size(), static_cast<std::size_t>(3 * contours));
      for (vtkIdType t = 1; t <= 32; ++t)
      {
        EXPECT_EQ((counts[{ t, vtkTriangularCoordinates::CENTER_SEGMENT }]), 3);
        EXPECT_EQ((counts[{ t, vtkTriangularCoordinates::WING_SEGMENT }]), 6);
        EXPECT_EQ((counts[{ t, vtkTriangularCoordinates::CONTOUR_LINE }]), 3 * contours);
        EXPECT_EQ((counts[{ t, vtkTriangularCoordinates::RING_LINE }]), rings - 1);
      }
      EXPECT_EQ(filter->GetLines()->GetNumberOfCells(), 32 * (9 + 3 * contours + rings - 1));
      filter->GenerateLinesOff();
      filter->Update();
      EXPECT_EQ(filter->GetLines()->GetNumberOfCells(), 0);
      EXPECT_EQ(filter->GetLines()->GetNumberOfPoints(), 0);
    }
  }
}

TEST_P(CoordinatesInEverySystem, LinesHaveTheirCoordinates)
{
  for (const auto& mesh : AllMeshes(780))
  {
    const auto filter = MakeCoordinates(GetParam(), mesh.second);
    filter->GenerateLinesOn();
    filter->SetNumberOfContours(5);
    filter->SetNumberOfRings(4);
    filter->SetLineResolution(12);
    filter->Update();
    const double size = SizeOf(mesh.second);
    const std::vector<Line> lines = ReadLines(filter->GetLines());

    // All points of the lines are input to the filter again.
    vtkNew<vtkPolyData> points;
    points->SetPoints(filter->GetLines()->GetPoints());
    const auto check = MakeCoordinates(GetParam(), mesh.second, points);
    const Coordinates found(Output(check));
    EXPECT_EQ(check->GetNumberOfOutsidePoints(), 0) << mesh.first;
    Worst worst;
    vtkIdType first = 0;
    vtkIdType wrong = 0;
    for (const Line& line : lines)
    {
      const auto count = static_cast<vtkIdType>(line.Points.size());
      if (line.Type == vtkTriangularCoordinates::RING_LINE)
      {
        worst.Take(Distance(line.Points.front(), line.Points.back()), 1e-14 * size);
        for (vtkIdType k = 0; k < count; ++k)
        {
          wrong += found.T(first + k) != line.Triangle;
          worst.Take(std::abs(found.C(first + k) - line.C), 1e-12);
        }
        // The closed line passes all three edges in order, with p from 0 to 1 on each.
        for (vtkIdType k = 0; k + 1 < count; ++k)
        {
          const auto edge = static_cast<int>(k / 12) + 1;
          const double p = static_cast<double>(k % 12) / 12.0;
          const bool isSpoke = k % 12 == 0;
          wrong += !isSpoke && found.E(first + k) != edge;
          worst.Take(isSpoke ? 0.0 : std::abs(found.P(first + k) - p) * line.C, 1e-11);
        }
      }
      else if (line.Type == vtkTriangularCoordinates::CONTOUR_LINE)
      {
        worst.Take(Distance(line.Points.front(), CenterOf(GetParam(), mesh.second, line.Triangle)),
          1e-14 * size);
        // The line ends on the edge at p.
        const std::array<Point, 3> c = CornersOf(mesh.second, line.Triangle);
        const Point end = (1.0 - line.P) * c[line.Edge % 3] + line.P * c[(line.Edge + 1) % 3];
        worst.Take(Distance(line.Points.back(), end), 2e-14 * size);
        for (vtkIdType k = 1; k + 1 < count; ++k)
        {
          const double parameter = static_cast<double>(k) / static_cast<double>(count - 1);
          wrong += found.T(first + k) != line.Triangle;
          worst.Take(std::abs(found.C(first + k) - parameter), 1e-12);
          if (line.P > 0.0)
          {
            wrong += found.E(first + k) != line.Edge;
            worst.Take(std::abs(found.P(first + k) - line.P) * parameter, 1e-11);
          }
        }
      }
      first += count;
    }
    EXPECT_EQ(first, points->GetNumberOfPoints());
    EXPECT_EQ(wrong, 0) << mesh.first;
    EXPECT_LE(worst.OverBound, 1.0) << mesh.first;
  }
}

TEST(TriangularCoordinates, ContoursAreThePublishedConstruction)
{
  // Center segments are perpendicular to the edges, wing segments join the vertices to their
  // midpoints, and contours meet the edge at a right angle and are divided evenly by arc length.
  for (const System& system : { Contour, Incenter })
  {
    for (const auto& mesh : AllMeshes(790))
    {
      constexpr int resolution = 128;
      const auto filter = MakeCoordinates(system, mesh.second);
      filter->GenerateLinesOn();
      filter->SetLineResolution(resolution);
      filter->Update();
      vtkDataArray* used =
        filter->GetTriangulation()->GetCellData()->GetArray("UsedCoordinateSystem");
      Worst worst;
      int wings = 0;
      int arcs = 0;
      std::map<std::pair<vtkIdType, int>, Point> feet;
      for (const Line& line : ReadLines(filter->GetLines()))
      {
        if (used->GetComponent(line.Triangle, 0) != vtkTriangularCoordinates::CONTOUR)
        {
          continue;
        }
        const std::array<Point, 3> c = CornersOf(mesh.second, line.Triangle);
        const Point center = CenterOf(system, mesh.second, line.Triangle);
        double longest = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
        {
          longest = std::max(longest, Distance(c[k], c[(k + 1) % 3]));
        }
        if (line.Type == vtkTriangularCoordinates::RING_LINE)
        {
          continue;
        }
        const Point start = c[line.Edge % 3];
        const Point end = c[(line.Edge + 1) % 3];
        const Point along = Unit(end - start);
        if (line.Type == vtkTriangularCoordinates::CENTER_SEGMENT)
        {
          const Point foot = line.Points.back();
          feet[{ line.Triangle, line.Edge }] = foot;
          ASSERT_EQ(line.Points.size(), 2u);
          worst.Take(Distance(line.Points.front(), center), 1e-14 * longest * 4);
          worst.Take(std::abs(Dot(foot - center, along)), 1e-14 * longest * 4);
          worst.Take(Norm(Cross(foot - start, along)), 1e-14 * longest * 4);
          EXPECT_GT(Dot(foot - start, along), 0.0);
          EXPECT_LT(Dot(foot - end, along), 0.0);
        }
        else if (line.Type == vtkTriangularCoordinates::WING_SEGMENT)
        {
          ++wings;
          ASSERT_EQ(line.Points.size(), 2u);
          worst.Take(
            std::min(Distance(line.Points.front(), start), Distance(line.Points.front(), end)),
            1e-14 * longest * 4);
          // Its center segment precedes it.
          const Point middle = 0.5 * (center + feet.at({ line.Triangle, line.Edge }));
          worst.Take(Distance(line.Points.back(), middle), 1e-14 * longest * 4);
        }
        else if (line.P > 0.0)
        {
          const std::vector<Point>& p = line.Points;
          const std::size_t n = p.size() - 1;
          std::vector<double> turns{ 0.0 };
          for (std::size_t k = 1; k < n; ++k)
          {
            turns.push_back(Norm(Cross(Unit(p[k] - p[k - 1]), Unit(p[k + 1] - p[k]))));
          }
          // All chords of a circle turn by the same angle; the last one by half of it.
          if (std::abs(turns[n - 1] - turns[n - 2]) < 1e-6 * turns[n - 1])
          {
            ++arcs;
            worst.Take(std::abs(std::abs(Dot(Unit(p[n] - p[n - 1]), along)) -
                         std::sin(0.5 * std::asin(turns[n - 1]))),
              1e-6);
          }
          // At least the first quarter of every contour is straight. Its points are evenly spaced
          // along the contour; beyond that, chords are shorter than their arcs.
          worst.Take(Norm(Cross(Unit(p[1] - p[0]), Unit(p[n / 4] - p[0]))), 1e-9);
          const double sharpest = *std::max_element(turns.begin(), turns.end());
          for (std::size_t k = 1; k < n; ++k)
          {
            worst.Take(std::abs(Distance(p[k], p[k + 1]) / Distance(p[0], p[1]) - 1.0),
              1e-9 + 0.1 * sharpest * sharpest);
          }
        }
      }
      EXPECT_GT(arcs, 100) << system.Name << mesh.first;
      EXPECT_LE(worst.OverBound, 1.0) << system.Name << mesh.first;
      EXPECT_GT(wings, 100) << system.Name << mesh.first;
    }
  }
}

TEST(TriangularCoordinates, ContoursOfTheSmoothSystemContinueAcrossEdges)
{
  // In the Smooth system, the contours of two neighbors that end at the same point of their edge
  // join smoothly (in the plane).
  const auto mesh = MakePlanarPair(4, 795).Source;
  const auto worstTurn = [&mesh](const System& system, int resolution) {
    const auto filter = MakeCoordinates(system, mesh);
    filter->GenerateLinesOn();
    filter->SetNumberOfContours(4);
    filter->SetNumberOfRings(1);
    filter->SetLineResolution(resolution);
    filter->Update();
    std::map<std::pair<long, long>, Point> directions;
    double worst = 0.0;
    int pairs = 0;
    for (const Line& line : ReadLines(filter->GetLines()))
    {
      if (line.Type != vtkTriangularCoordinates::CONTOUR_LINE || line.P == 0.0)
      {
        continue;
      }
      const Point end = line.Points.back();
      const Point direction = Unit(end - line.Points[line.Points.size() - 2]);
      const std::pair<long, long> key{ std::lround(end[0] * 1e9), std::lround(end[1] * 1e9) };
      const auto found = directions.find(key);
      if (found == directions.end())
      {
        directions[key] = direction;
        continue;
      }
      ++pairs;
      worst = std::max(worst, Norm(direction + found->second));
    }
    EXPECT_EQ(pairs, 40 * 3);
    return worst;
  };
  // The directions of the chords converge to those of the lines.
  const double coarse = worstTurn(Smooth, 250);
  EXPECT_LT(coarse, 0.15);
  EXPECT_LT(worstTurn(Smooth, 1000), 0.3 * coarse);
  EXPECT_GT(worstTurn(Linear, 250), 0.5);
}

// --- Output 2: the triangles ---------------------------------------------------------------------

TEST(TriangularCoordinates, TrianglesAreDescribed)
{
  std::vector<vtkSmartPointer<vtkPolyData>> meshes;
  for (const auto& mesh : AllMeshes(800))
  {
    meshes.push_back(mesh.second);
  }
  vtkIdType discordantInAll = 0;
  for (const auto& mesh : meshes)
  {
    const auto filter = MakeCoordinates(Contour, mesh);
    filter->Update();
    vtkCellData* cellData = filter->GetTriangulation()->GetCellData();
    vtkDataArray* concordant = cellData->GetArray("Concordant");
    vtkDataArray* margin = cellData->GetArray("ConcordanceMargin");
    vtkDataArray* used = cellData->GetArray("UsedCoordinateSystem");
    vtkDataArray* angle = cellData->GetArray("SmallestAngle");
    vtkDataArray* width = cellData->GetArray("StripWidth");
    vtkDataArray* bound = cellData->GetArray("DeterminantBound");
    ASSERT_TRUE(vtkUnsignedCharArray::SafeDownCast(concordant));
    ASSERT_TRUE(vtkDoubleArray::SafeDownCast(margin));
    ASSERT_TRUE(vtkIntArray::SafeDownCast(used));
    ASSERT_TRUE(vtkDoubleArray::SafeDownCast(angle));
    ASSERT_TRUE(vtkDoubleArray::SafeDownCast(width));
    ASSERT_EQ(width->GetNumberOfComponents(), 3);
    ASSERT_TRUE(vtkDoubleArray::SafeDownCast(bound));
    // Number of triangles at each edge.
    std::map<std::pair<vtkIdType, vtkIdType>, int> uses;
    vtkNew<vtkIdList> ids;
    const auto key = [&ids](int k) {
      return std::make_pair(std::min(ids->GetId((k + 1) % 3), ids->GetId((k + 2) % 3)),
        std::max(ids->GetId((k + 1) % 3), ids->GetId((k + 2) % 3)));
    };
    for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
    {
      mesh->GetCellPoints(t, ids);
      for (int k = 0; k < 3; ++k)
      {
        ++uses[key(k)];
      }
    }
    vtkIdType discordant = 0;
    Worst worst;
    for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
    {
      const std::array<Point, 3> c = CornersOf(mesh, t);
      const double a2 = Dot(c[1] - c[2], c[1] - c[2]);
      const double b2 = Dot(c[2] - c[0], c[2] - c[0]);
      const double c2 = Dot(c[0] - c[1], c[0] - c[1]);
      // a^2 < b^2 + 3 c^2 in any order, for differences beyond rounding.
      double slack = std::numeric_limits<double>::max();
      for (const auto& order : { Point{ a2, b2, c2 }, Point{ a2, c2, b2 }, Point{ b2, a2, c2 },
             Point{ b2, c2, a2 }, Point{ c2, a2, b2 }, Point{ c2, b2, a2 } })
      {
        slack = std::min(slack, order[1] + 3.0 * order[2] - order[0]);
      }
      ASSERT_GT(std::abs(slack), 1e-12);
      ASSERT_EQ(concordant->GetComponent(t, 0), slack > 0.0 ? 1.0 : 0.0);
      discordant += slack <= 0.0;
      ASSERT_EQ(used->GetComponent(t, 0),
        slack > 0.0 ? vtkTriangularCoordinates::CONTOUR : vtkTriangularCoordinates::LINEAR);

      // The least distance of a foot from an end of its edge.
      const Point g = (1.0 / 3.0) * (c[0] + c[1] + c[2]);
      double least = 1.0;
      for (std::size_t k = 0; k < 3; ++k)
      {
        const Point edge = c[(k + 1) % 3] - c[k];
        const double foot = Dot(g - c[k], edge) / Dot(edge, edge);
        least = std::min({ least, foot, 1.0 - foot });
      }
      worst.Take(std::abs(margin->GetComponent(t, 0) - least), 1e-13);
      ASSERT_EQ(margin->GetComponent(t, 0) > 0.0, slack > 0.0);

      double smallest = 180.0;
      for (std::size_t k = 0; k < 3; ++k)
      {
        const double cosine = Dot(Unit(c[(k + 1) % 3] - c[k]), Unit(c[(k + 2) % 3] - c[k]));
        smallest = std::min(smallest, vtkMath::DegreesFromRadians(std::acos(cosine)));
      }
      worst.Take(std::abs(angle->GetComponent(t, 0) - smallest), 1e-10);

      mesh->GetCellPoints(t, ids);
      bool isBesideNone = true;
      for (int k = 0; k < 3; ++k)
      {
        const bool isBoundary = uses[key(k)] == 1;
        isBesideNone = isBesideNone && isBoundary;
        ASSERT_EQ(width->GetComponent(t, k) == 0.0, isBoundary);
        ASSERT_GE(width->GetComponent(t, k), 0.0);
        ASSERT_LE(width->GetComponent(t, k), 1.0);
      }
      ASSERT_GT(bound->GetComponent(t, 0), 0.0);
      ASSERT_LE(bound->GetComponent(t, 0), isBesideNone ? 1.0 : 0.28);
    }
    EXPECT_LE(worst.OverBound, 1.0);
    EXPECT_EQ(filter->GetNumberOfDiscordantTriangles(), discordant);
    discordantInAll += discordant;

    // In the other systems every triangle has coordinates of that system.
    for (const System& system : { Linear, Smooth, Incenter })
    {
      const auto other = MakeCoordinates(system, mesh);
      other->Update();
      vtkDataArray* usedThere =
        other->GetTriangulation()->GetCellData()->GetArray("UsedCoordinateSystem");
      EXPECT_EQ(usedThere->GetRange()[0], system.CoordinateSystem);
      EXPECT_EQ(usedThere->GetRange()[1], system.CoordinateSystem);
      EXPECT_EQ(other->GetNumberOfDiscordantTriangles(), discordant);
    }
  }
  EXPECT_GT(discordantInAll, 20);
}

TEST(TriangularCoordinates, StripWidthsAndBoundsFollowTheirFormulas)
{
  // Two triangles: (0,0) (1,0) (x,h) and, across the edge from (0,0) to (1,0), (y,-g). For the edge
  // opposite the apex, D = -a/(a+a*) (apex + apex* - ends), in barycentric components.
  Random random(70);
  Worst worst;
  for (int n = 0; n < 500; ++n)
  {
    const double h = std::pow(10.0, random.Uniform(-1.5, 1.5));
    const double g = std::pow(10.0, random.Uniform(-1.5, 1.5));
    const double x = random.Uniform(-2.0, 3.0);
    const double y = random.Uniform(-2.0, 3.0);
    const auto mesh = MakeMesh(
      { { 0, 0, 0 }, { 1, 0, 0 }, { x, h, 0 }, { y, -g, 0 } }, { { 2, 0, 1 }, { 3, 1, 0 } });
    const auto filter = MakeCoordinates(Smooth, mesh);
    filter->Update();
    vtkCellData* cellData = filter->GetTriangulation()->GetCellData();
    for (vtkIdType t = 0; t < 2; ++t)
    {
      const double own = t == 0 ? h : g;
      const double other = t == 0 ? g : h;
      // sum of the apex positions minus that of the ends
      const double shift = (t == 0 ? x + y : 2.0 - x - y) - 1.0;
      const double factor = -own / (own + other);
      // Components for the corners: the apex first, then the ends (next, previous).
      const double along = (own - other) * factor / own;
      const double apexX = t == 0 ? x : 1.0 - y;
      const double previous = factor * shift - along * apexX;
      const double next = -along - previous;
      const double steepest = std::min({ 0.0, next, previous });
      const double tau = steepest < 0.0 ? std::min(1.0, -0.5 / steepest) : 1.0;
      worst.Take(std::abs(cellData->GetArray("StripWidth")->GetComponent(t, 0) - tau), 1e-12 * tau);
      EXPECT_EQ(cellData->GetArray("StripWidth")->GetComponent(t, 1), 0.0);
      EXPECT_EQ(cellData->GetArray("StripWidth")->GetComponent(t, 2), 0.0);
      const double bound = std::min(2.0 * other / (own + other), 0.28);
      worst.Take(std::abs(cellData->GetArray("DeterminantBound")->GetComponent(t, 0) - bound),
        1e-12 * bound);
    }
  }
  EXPECT_LE(worst.OverBound, 1.0);

  // The chart of a single triangle is affine.
  const auto alone = MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } });
  const auto filter = MakeCoordinates(Smooth, alone);
  filter->Update();
  EXPECT_EQ(
    filter->GetTriangulation()->GetCellData()->GetArray("DeterminantBound")->GetRange()[0], 1.0);
}

TEST(TriangularCoordinates, DiscordantTrianglesAreRefusedOrMappedByLinear)
{
  const auto mesh = Sheared(MakePlanarPair(10, 810).Source);
  vtkNew<vtkTriangularCoordinates> filter;
  Messages messages(filter);
  filter->SetInputData(0, mesh);
  filter->SetCoordinateSystemToContour();
  filter->Update();
  EXPECT_NE(messages.Error().find("discordant"), std::string::npos);
  messages.Clear();
  filter->SetDiscordantTriangles(vtkTriangularCoordinates::USE_LINEAR);
  filter->Update();
  // Mapping by Linear was requested, so an array and a count report it, without a warning.
  EXPECT_FALSE(messages.HasError());
  EXPECT_FALSE(messages.HasWarning());
  EXPECT_GT(filter->GetNumberOfDiscordantTriangles(), 0);

  // Triangles mapped by Linear have its coordinates.
  const std::vector<MeshPoint> samples = InnerSamples(mesh, 2000, 71, 1e-3);
  const auto cloud = MakeCloud(mesh, samples);
  filter->SetDataObject(cloud);
  filter->Update();
  const auto linear = MakeCoordinates(Linear, mesh, cloud);
  const Coordinates mixed(vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0)));
  const Coordinates all(Output(linear));
  vtkDataArray* used = filter->GetTriangulation()->GetCellData()->GetArray("UsedCoordinateSystem");
  vtkIdType wrong = 0;
  vtkIdType mapped = 0;
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    if (used->GetComponent(mixed.T(i), 0) == vtkTriangularCoordinates::LINEAR)
    {
      ++mapped;
      wrong += mixed.E(i) != all.E(i) || mixed.P(i) != all.P(i) || mixed.C(i) != all.C(i);
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(mapped, 10);

  // With the incenter no triangle is discordant, although the description still reports discordance
  // with respect to the centroid.
  filter->SetDiscordantTriangles(vtkTriangularCoordinates::REFUSE);
  filter->SetCenterPoint(vtkTriangularCoordinates::INCENTER);
  filter->Update();
  EXPECT_FALSE(messages.HasError());
  EXPECT_FALSE(messages.HasWarning());
}

TEST(TriangularCoordinates, PropertiesAreClampedAndPrinted)
{
  vtkNew<vtkTriangularCoordinates> filter;
  filter->SetNumberOfContours(0);
  filter->SetNumberOfRings(-4);
  filter->SetLineResolution(0);
  EXPECT_EQ(filter->GetNumberOfContours(), 1);
  EXPECT_EQ(filter->GetNumberOfRings(), 1);
  EXPECT_EQ(filter->GetLineResolution(), 1);
  filter->SetNumberOfContours(1 << 20);
  filter->SetNumberOfRings(1 << 20);
  filter->SetLineResolution(1 << 20);
  EXPECT_EQ(filter->GetNumberOfContours(), 100);
  EXPECT_EQ(filter->GetNumberOfRings(), 100);
  EXPECT_EQ(filter->GetLineResolution(), 1000);
  filter->SetTolerance(-2.0);
  EXPECT_EQ(filter->GetTolerance(), 0.0);
  std::ostringstream text;
  filter->Print(text);
  for (const char* word :
    { "CoordinateSystem: 2", "CenterPoint: 0", "DiscordantTriangles: 0", "MaskInvalidTriangles: 0",
      "Tolerance: 0", "GenerateLines: 1", "NumberOfContours: 100", "NumberOfRings: 1",
      "LineResolution: 1", "NumberOfOutsidePoints: 0", "NumberOfDiscordantTriangles: 0" })
  {
    EXPECT_NE(text.str().find(word), std::string::npos) << word;
  }
}

} // namespace
