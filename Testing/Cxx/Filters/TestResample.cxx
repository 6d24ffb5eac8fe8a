// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Resampled data equals the data at the preimages of the grid's points.

#include "Fixtures/FilterRuns.h"

#include "vtkExtractVOI.h"
#include "vtkHomeomorphismTransform.h"
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

double Field(const double p[3])
{
  return 3.0 * p[0] - 2.0 * p[1] + 0.5;
}

/// An image over the source's domain and beyond, with a scalar that interpolation reproduces, a
/// vector, and cell data.
vtkSmartPointer<vtkImageData> MakeImage()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(0, 40, 0, 40, 0, 0);
  image->SetOrigin(-0.5, -0.5, 0.0);
  image->SetSpacing((n + 1.0) / 40.0, (n + 1.0) / 40.0, 1.0);
  vtkNew<vtkDoubleArray> field;
  field->SetName("Field");
  vtkNew<vtkDoubleArray> wind;
  wind->SetName("Wind");
  wind->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    field->InsertNextValue(Field(image->GetPoint(i)));
    wind->InsertNextTuple3(1.0, 2.0, 0.0);
  }
  image->GetPointData()->SetScalars(field);
  image->GetPointData()->SetVectors(wind);
  vtkNew<vtkIntArray> row;
  row->SetName("Row");
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    row->InsertNextValue(static_cast<int>(i / 40));
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
  vtkNew<vtkHomeomorphismTransform> map;
  map->SetSource(pair.Source);
  map->SetTarget(pair.Target);
  map->Update();
  vtkDataArray* field = output->GetPointData()->GetArray("Field");
  vtkDataArray* wind = output->GetPointData()->GetArray("Wind");
  vtkDataArray* row = output->GetPointData()->GetArray("Row");
  vtkDataArray* mask = output->GetPointData()->GetArray("vtkValidPointMask");
  ASSERT_TRUE(field && mask);
  vtkIdType inside = 0;
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    double point[3];
    output->GetPoint(i, point);
    double origin[3];
    map->GetInverse()->TransformPoint(point, origin);
    const bool valid = std::abs(origin[0]) < 1e20;
    EXPECT_EQ(mask->GetTuple1(i) != 0.0, valid);
    inside += valid;
    if (!valid)
    {
      EXPECT_TRUE(std::isnan(field->GetTuple1(i)));
      EXPECT_TRUE(output->GetPointGhostArray());
      EXPECT_TRUE(output->GetPointGhostArray()->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT);
      continue;
    }
    EXPECT_NEAR(field->GetTuple1(i), Field(origin), 1e-11);
    if (row)
    {
      const double exactRow = (origin[1] + 0.5) * 40.0 / (n + 1.0);
      EXPECT_NEAR(row->GetTuple1(i) + 0.5, exactRow, 0.5 + 1e-9);
    }
    if (wind)
    {
      double image[3];
      double jacobian[3][3];
      map->InternalTransformDerivative(origin, image, jacobian);
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
  filter->Update();
  auto* image = vtkImageData::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->GetDimensions()[0], 50);
  EXPECT_EQ(image->GetDimensions()[1], 40);
  double bounds[6];
  double expected[6];
  image->GetBounds(bounds);
  pair.Target->GetBounds(expected);
  for (int i = 0; i < 4; ++i)
  {
    EXPECT_NEAR(bounds[i], expected[i], 1e-12);
  }
  EXPECT_STREQ(image->GetPointData()->GetScalars()->GetName(), "Field");
  EXPECT_STREQ(image->GetPointData()->GetVectors()->GetName(), "Wind");
  ExpectPulledBack(image, pair);
  vtkIdType valid = 0;
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    valid += image->GetPointData()->GetArray("vtkValidPointMask")->GetTuple1(i) != 0.0;
  }
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), image->GetNumberOfPoints() - valid);
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
  filter->Update();
  auto* cloud = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
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
  filter->Update();
  vtkDataArray* field = filter->GetOutput()->GetPointData()->GetArray("Field");
  ASSERT_TRUE(field);
  const auto whole = MakeResample(pair, MakeImage());
  whole->SetGridData(MakeCloud(points));
  whole->Update();
  for (vtkIdType i = 0; i < field->GetNumberOfTuples(); ++i)
  {
    const double expected = whole->GetOutput()->GetPointData()->GetArray("Field")->GetTuple1(i);
    if (!std::isnan(expected))
    {
      EXPECT_NEAR(field->GetTuple1(i), expected, 1e-12);
    }
  }
}

TEST(Resample, ImagesAreSampledLikeOtherData)
{
  // In a tree an image is treated like any other data, and interpolated by VTK's cells.
  std::mt19937_64 generator(12);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const MeshPair pair = MakePair();
  for (const int slices : { 1, 4 })
  {
    vtkNew<vtkImageData> image;
    image->SetExtent(3, 40, -7, 30, 0, slices - 1);
    image->SetSpacing(0.137, 0.143, 0.31);
    image->SetOrigin(-0.9, 0.8, -0.1 * (slices - 1));
    vtkNew<vtkFloatArray> real;
    real->SetName("Field");
    vtkNew<vtkUnsignedCharArray> color;
    color->SetName("Color");
    color->SetNumberOfComponents(3);
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      real->InsertNextValue(static_cast<float>(number(generator)));
      for (int c = 0; c < 3; ++c)
      {
        color->InsertNextValue(static_cast<unsigned char>(127.5 * (1.0 + number(generator))));
      }
    }
    image->GetPointData()->SetScalars(real);
    image->GetPointData()->AddArray(color);
    vtkNew<vtkIntArray> cells;
    cells->SetName("Cell");
    for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
    {
      cells->InsertNextValue(static_cast<int>(i));
    }
    image->GetCellData()->AddArray(cells);
    vtkNew<vtkMultiBlockDataSet> tree;
    tree->SetBlock(0, image);

    vtkNew<vtkImageData> grid;
    grid->SetDimensions(61, 57, slices);
    grid->SetSpacing(0.12, 0.11, 0.17);
    grid->SetOrigin(-0.3, -0.2, 0.0);
    vtkDataSet* outputs[2];
    const auto direct = MakeResample(pair, image);
    const auto general = MakeResample(pair, tree);
    for (const auto& filter : { direct, general })
    {
      filter->SetGridData(grid);
      filter->Update();
      outputs[filter == general] = filter->GetOutput();
    }
    EXPECT_EQ(direct->GetNumberOfOutsidePoints(), general->GetNumberOfOutsidePoints());
    EXPECT_GT(direct->GetNumberOfOutsidePoints(), 100);
    EXPECT_STREQ(outputs[0]->GetPointData()->GetScalars()->GetName(), "Field");
    vtkIdType valid = 0;
    for (const char* name : { "vtkValidPointMask", "vtkGhostType", "Cell", "Color", "Field" })
    {
      vtkDataArray* values = outputs[0]->GetPointData()->GetArray(name);
      vtkDataArray* expected = outputs[1]->GetPointData()->GetArray(name);
      ASSERT_TRUE(values && expected) << name;
      ASSERT_EQ(values->GetDataType(), expected->GetDataType());
      ASSERT_EQ(values->GetNumberOfComponents(), expected->GetNumberOfComponents());
      const double rounding = values == outputs[0]->GetPointData()->GetScalars() ? 1e-6 : 0.0;
      for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
      {
        for (int c = 0; c < values->GetNumberOfComponents(); ++c)
        {
          const double a = values->GetComponent(i, c);
          const double b = expected->GetComponent(i, c);
          ASSERT_TRUE(std::isnan(a) ? std::isnan(b) : std::abs(a - b) <= rounding)
            << name << " " << i << ": " << a << " " << b;
          valid += std::string(name) == "Field" && !std::isnan(a);
        }
      }
    }
    EXPECT_GT(valid, 1000);
  }
}

TEST(Resample, TheMeshIsItsOwnData)
{
  const MeshPair pair = MakePair();
  vtkNew<vtkPolyData> source;
  source->ShallowCopy(pair.Source);
  vtkNew<vtkDoubleArray> field;
  field->SetName("Field");
  for (vtkIdType i = 0; i < source->GetNumberOfPoints(); ++i)
  {
    field->InsertNextValue(Field(source->GetPoint(i)));
  }
  source->GetPointData()->SetScalars(field);
  const auto filter = MakeResample({ source, pair.Target }, nullptr);
  filter->Update();
  ExpectPulledBack(filter->GetOutput(), pair);
}

TEST(Resample, InverseExchangesSourceAndTarget)
{
  const MeshPair pair = MakePair();
  const auto image = MakeImage();
  const auto forward = MakeResample(pair, image);
  const auto inverse = MakeResample({ pair.Target, pair.Source }, image);
  inverse->InverseOn();
  forward->Update();
  inverse->Update();
  vtkDataArray* a = forward->GetOutput()->GetPointData()->GetArray("Field");
  vtkDataArray* b = inverse->GetOutput()->GetPointData()->GetArray("Field");
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    EXPECT_TRUE(a->GetTuple1(i) == b->GetTuple1(i) ||
      (std::isnan(a->GetTuple1(i)) && std::isnan(b->GetTuple1(i))));
  }
}

TEST(Resample, PiecesFormTheWhole)
{
  const MeshPair pair = MakePair();
  const auto whole = MakeResample(pair, MakeImage());
  whole->Update();
  const auto pieces = MakeResample(pair, MakeImage());
  auto* expected = vtkImageData::SafeDownCast(whole->GetOutputDataObject(0));
  for (int piece = 0; piece < 3; ++piece)
  {
    pieces->UpdatePiece(piece, 3, 0);
    auto* part = vtkImageData::SafeDownCast(pieces->GetOutputDataObject(0));
    EXPECT_LT(part->GetNumberOfPoints(), expected->GetNumberOfPoints());
    for (vtkIdType i = 0; i < part->GetNumberOfPoints(); ++i)
    {
      double point[3];
      part->GetPoint(i, point);
      const vtkIdType same = expected->FindPoint(point);
      const double a = part->GetPointData()->GetArray("Field")->GetTuple1(i);
      const double b = expected->GetPointData()->GetArray("Field")->GetTuple1(same);
      EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
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
    const auto mesh = MakePlanarPair(side, 5).Source;
    vtkNew<vtkDoubleArray> field;
    field->SetName("Field");
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
    {
      double p[3];
      mesh->GetPoint(i, p);
      p[0] = (p[0] * (n + 1)) / side - 0.5;
      p[1] = (p[1] * (n + 1)) / side - 0.5;
      mesh->GetPoints()->SetPoint(i, p);
      field->InsertNextValue(Field(p));
    }
    mesh->GetPointData()->SetScalars(field);
    return mesh;
  };
  const auto coarse = withField(2);
  const auto fine = withField(200);
  for (const int kind : { 0, 1, 2 })
  {
    SCOPED_TRACE(kind);
    vtkSmartPointer<vtkPointSet> data = toGrid(coarse);
    if (kind == 0)
    {
      data = vtkSmartPointer<vtkPolyData>::New();
      data->ShallowCopy(coarse);
    }
    vtkNew<vtkMultiBlockDataSet> tree;
    tree->SetBlock(0, data);
    const auto resample =
      MakeResample(pair, kind == 2 ? static_cast<vtkDataObject*>(tree) : data.Get());
    resample->Update();
    data->SetPoints(fine->GetPoints());
    data->GetPointData()->ShallowCopy(fine->GetPointData());
    if (kind > 0)
    {
      vtkUnstructuredGrid::SafeDownCast(data)->SetCells(VTK_TRIANGLE, fine->GetPolys());
    }
    else
    {
      vtkPolyData::SafeDownCast(data)->SetPolys(fine->GetPolys());
    }
    tree->Modified();
    resample->Update();
    ExpectPulledBack(vtkDataSet::SafeDownCast(resample->GetOutputDataObject(0)), pair);
  }
}

} // namespace
