// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Resampled data equals the data at the preimages of the grid's points.

#include "Fixtures/FilterRuns.h"

#include "vtkExtractVOI.h"
#include "vtkRTAnalyticSource.h"
#include "vtkResampleThroughHomeomorphism.h"
#include "vtkUnstructuredGrid.h"

namespace
{

using namespace fixtures;

constexpr int n = 6;

MeshPair MakePair()
{
  // The target is a sheared square: much of its bounding box is outside.
  const MeshPair pair = MakePlanarPair(n, 11);
  return { pair.Source, Sheared(pair.Target) };
}

double Field(const Point& p)
{
  return 3.0 * p[0] - 2.0 * p[1] + 0.5;
}

/// The field at the points of data, as active scalars.
void AddField(vtkDataSet* data)
{
  data->GetPointData()->SetScalars(ValuesAt(data, "Field", Field));
}

/// An image over the source's domain and beyond, with a scalar that interpolation reproduces, a
/// vector, and cell data.
vtkSmartPointer<vtkImageData> MakeImage()
{
  constexpr double spacing = (n + 1.0) / 40.0;
  auto image =
    fixtures::MakeImage({ 0, 40, 0, 40, 0, 0 }, { -0.5, -0.5, 0.0 }, { spacing, spacing, 1.0 });
  AddField(image);
  const auto wind = RandomArray("Wind", 3, image->GetNumberOfPoints(), 1);
  wind->FillComponent(0, 1.0);
  wind->FillComponent(1, 2.0);
  wind->FillComponent(2, 0.0);
  image->GetPointData()->SetVectors(wind);
  const auto row = RandomArray<vtkIntArray>("Row", 1, image->GetNumberOfCells(), 2);
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    row->SetValue(i, static_cast<int>(i / 40));
  }
  image->GetCellData()->AddArray(row);
  return image;
}

vtkSmartPointer<vtkResampleThroughHomeomorphism> MakeResample(
  const MeshPair& pair, vtkDataObject* data)
{
  auto filter = MakeAlgorithm<vtkResampleThroughHomeomorphism>(pair);
  filter->SetDataObject(data);
  filter->SetSamplingDimensions(50, 40);
  return filter;
}

/// Compares every point of the output with the transform.
void ExpectPulledBack(vtkDataSet* output, const MeshPair& pair)
{
  const auto map = MakeTransform(Smooth, pair);
  map->Update();
  ASSERT_TRUE(PointArray(output, "Field"));
  vtkIdType inside = 0;
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    const Point origin = Transformed(map->GetInverse(), PointOf(output, i));
    const bool valid = std::abs(origin[0]) < 1e20;
    EXPECT_EQ(IsValid(output, i), valid);
    inside += valid;
    if (!valid)
    {
      EXPECT_TRUE(std::isnan(PointValue(output, "Field", i)));
      EXPECT_TRUE(output->GetPointGhostArray());
      EXPECT_TRUE(output->GetPointGhostArray()->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT);
      continue;
    }
    EXPECT_NEAR(PointValue(output, "Field", i), Field(origin), 1e-11);
    if (PointArray(output, "Row"))
    {
      const double exactRow = (origin[1] + 0.5) * 40.0 / (n + 1.0);
      EXPECT_NEAR(PointValue(output, "Row", i) + 0.5, exactRow, 0.5 + 1e-9);
    }
    if (vtkDataArray* wind = PointArray(output, "Wind"))
    {
      double image[3];
      double jacobian[3][3];
      map->InternalTransformDerivative(origin.data(), image, jacobian);
      for (int k = 0; k < 2; ++k)
      {
        // On an edge of the triangulation the map is once differentiable, so either side is
        // accepted.
        EXPECT_NEAR(wind->GetComponent(i, k), jacobian[k][0] + 2.0 * jacobian[k][1], 1e-9);
      }
    }
  }
  EXPECT_GT(inside, output->GetNumberOfPoints() / 4);
  EXPECT_LT(inside, output->GetNumberOfPoints());
}

TEST(Resample, ImagesAreSampledAtPreimages)
{
  const MeshPair pair = MakePair();
  const auto filter = MakeResample(pair, MakeImage());
  auto* image = vtkImageData::SafeDownCast(Output(filter.Get()));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->GetDimensions()[0], 50);
  EXPECT_EQ(image->GetDimensions()[1], 40);
  for (int i = 0; i < 4; ++i)
  {
    EXPECT_NEAR(image->GetBounds()[i], pair.Target->GetBounds()[i], 1e-12);
  }
  EXPECT_STREQ(image->GetPointData()->GetScalars()->GetName(), "Field");
  EXPECT_STREQ(image->GetPointData()->GetVectors()->GetName(), "Wind");
  ExpectPulledBack(image, pair);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), CountOutside(image));
  const auto inverse = MakeResample({ pair.Target, pair.Source }, MakeImage());
  inverse->InverseOn();
  ExpectSame(Output(inverse.Get()), image, { "Field", "Wind" });
}

TEST(Resample, AnyGridAndAnyDataAreSupported)
{
  const MeshPair pair = MakePair();
  const auto filter = MakeResample(pair, MakeImage());
  Random random(3);
  std::vector<Point> points;
  for (int i = 0; i < 500; ++i)
  {
    points.push_back({ random.Uniform(-1.0, 16.0), random.Uniform(-1.0, 7.0), 0.0 });
  }
  filter->SetGridData(MakeCloud(points));
  auto* cloud = vtkPolyData::SafeDownCast(Output(filter.Get()));
  ASSERT_TRUE(cloud);
  ExpectPulledBack(cloud, pair);

  // The data in two blocks, halves of the image.
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (unsigned int half = 0; half < 2; ++half)
  {
    vtkNew<vtkExtractVOI> cut;
    cut->SetInputData(MakeImage());
    cut->SetVOI(half == 0 ? 0 : 20, half == 0 ? 20 : 40, 0, 40, 0, 0);
    cut->Update();
    blocks->SetBlock(half, cut->GetOutput());
  }
  filter->SetDataObject(blocks);
  ExpectPulledBack(Output(filter.Get()), pair);

  // The mesh is its own data.
  const auto source = CopyOf(pair.Source.Get());
  AddField(source);
  filter->SetSourceData(source);
  filter->SetDataObject(nullptr);
  ExpectPulledBack(Output(filter.Get()), pair);
}

TEST(Resample, PiecesFormTheWhole)
{
  const MeshPair pair = MakePair();
  const auto whole = MakeResample(pair, MakeImage());
  const auto pieces = MakeResample(pair, MakeImage());
  auto* expected = vtkImageData::SafeDownCast(Output(whole.Get()));
  for (int piece = 0; piece < 3; ++piece)
  {
    pieces->UpdatePiece(piece, 3, 0);
    auto* part = vtkImageData::SafeDownCast(pieces->GetOutputDataObject(0));
    EXPECT_LT(part->GetNumberOfPoints(), expected->GetNumberOfPoints());
    for (vtkIdType i = 0; i < part->GetNumberOfPoints(); ++i)
    {
      const vtkIdType same = expected->FindPoint(part->GetPoint(i));
      EXPECT_TRUE(SameBits(PointValue(part, "Field", i), PointValue(expected, "Field", same)));
    }
  }
  EXPECT_EQ(pieces->GetNumberOfMeshBuilds(), 1);
}

TEST(Resample, GridsAreRequestedInTheExtentOfTheOutput)
{
  // The grid's source makes only the extent that a consumer of the output requests.
  vtkNew<vtkRTAnalyticSource> grid;
  grid->SetWholeExtent(0, 30, 0, 20, 0, 0);
  const auto filter = MakeResample(MakePair(), MakeImage());
  filter->SetGridConnection(grid->GetOutputPort());
  for (const std::array<int, 6>& extent :
    { std::array<int, 6>{ 2, 9, 3, 5, 0, 0 }, { 11, 12, 0, 20, 0, 0 }, { 0, 30, 0, 20, 0, 0 } })
  {
    filter->UpdateExtent(extent.data());
    for (vtkDataObject* image : { grid->GetOutputDataObject(0), filter->GetOutputDataObject(0) })
    {
      std::array<int, 6> made;
      vtkImageData::SafeDownCast(image)->GetExtent(made.data());
      EXPECT_EQ(made, extent);
    }
  }
}

TEST(Resample, DataMayBeReplacedInPlace)
{
  // VTK keeps lists of the cells of each point from the first search.
  const MeshPair pair = MakePair();
  const auto toGrid = [](vtkPolyData* mesh) {
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    grid->SetPoints(mesh->GetPoints());
    grid->SetCells(VTK_TRIANGLE, mesh->GetPolys());
    grid->GetPointData()->ShallowCopy(mesh->GetPointData());
    return grid;
  };
  const auto withField = [](int side) {
    // Larger than the domain, so that none of its points is outside by rounding.
    const auto mesh = Moved(MakePlanarPair(side, 5).Source, [side](const Point& p) {
      return (n + 1.0) / side * p - Point{ 0.5, 0.5, 0.0 };
    });
    AddField(mesh);
    return mesh;
  };
  const auto coarse = withField(2);
  const auto fine = withField(200);
  for (const int kind : { 0, 1, 2 })
  {
    SCOPED_TRACE(kind);
    const auto polygons = CopyOf(coarse.Get());
    const auto grid = toGrid(coarse);
    vtkPointSet* data = kind == 0 ? static_cast<vtkPointSet*>(polygons) : grid.Get();
    vtkNew<vtkMultiBlockDataSet> tree;
    tree->SetBlock(0, data);
    const auto resample = MakeResample(pair, kind == 2 ? static_cast<vtkDataObject*>(tree) : data);
    resample->Update();
    data->SetPoints(fine->GetPoints());
    data->GetPointData()->ShallowCopy(fine->GetPointData());
    polygons->SetPolys(fine->GetPolys());
    grid->SetCells(VTK_TRIANGLE, fine->GetPolys());
    tree->Modified();
    ExpectPulledBack(Output(resample.Get()), pair);
  }
}

} // namespace
