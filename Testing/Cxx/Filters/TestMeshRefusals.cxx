// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// All reasons for refusing meshes, tested through the VTK classes: the message contains the kind of
// defect, the number of offenders and the first of them, and the output is empty. Also valid meshes
// that resemble invalid ones.

#include "MappedPoints.h"

#include "Mesh/Homeomorphism.h"

#include "vtkHomeomorphismTransform.h"
#include "vtkTriangularCoordinates.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCutter.h"
#include "vtkDataSetAttributes.h"
#include "vtkDataSetTriangleFilter.h"
#include "vtkFlyingEdges3D.h"
#include "vtkIdTypeArray.h"
#include "vtkPlane.h"
#include "vtkRTAnalyticSource.h"
#include "vtkTriangleFilter.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedShortArray.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>

namespace
{

using namespace test_meshes;
using Texts = std::vector<std::string>;

constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

const char* const RepairOrMask =
  "Repair or remove them in both meshes, or turn MaskInvalidTriangles on";

void ExpectTexts(const std::string& message, const Texts& texts)
{
  for (const std::string& text : texts)
  {
    EXPECT_NE(message.find(text), std::string::npos)
      << "\"" << text << "\" is not in \"" << message << "\"";
  }
}

/// The filter reports the defect and has no output, not even that of a previous execution.
void ExpectFilterRefuses(const MeshPair& pair, const Texts& texts, const MapOptions& options)
{
  const MeshPair valid = MakePlanarPair(2, 1);
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  Messages messages(filter);
  filter->SetSourceData(valid.Source);
  filter->SetTargetData(valid.Target);
  const auto cloud = MakeCloud({ { 0.5, 0.4, 0.0 }, { 1.0, 1.0, 0.0 } });
  filter->SetDataObject(cloud);
  filter->Update();
  ASSERT_EQ(2, filter->GetOutput()->GetNumberOfElements(vtkDataObject::POINT));
  ASSERT_FALSE(messages.HasError() || messages.HasWarning());

  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->SetCoordinateSystem(options.CoordinateSystem);
  filter->SetInverse(options.Inverse);
  filter->Update();
  EXPECT_TRUE(messages.HasError());
  EXPECT_FALSE(messages.HasWarning()) << messages.Warning();
  ExpectTexts(messages.Error(), texts);
  EXPECT_EQ(0, filter->GetOutput()->GetNumberOfElements(vtkDataObject::POINT));
  EXPECT_EQ(0, filter->GetOutput()->GetNumberOfElements(vtkDataObject::CELL));

  // Also without separate data, when the invalid mesh itself is the data.
  filter->SetInputData(2, nullptr);
  messages.Clear();
  filter->Modified();
  filter->Update();
  EXPECT_TRUE(messages.HasError());
  EXPECT_EQ(0, filter->GetOutput()->GetNumberOfElements(vtkDataObject::POINT));
}

/// The transform reports the defect, and every point is outside.
void ExpectTransformRefuses(const MeshPair& pair, const Texts& texts, const MapOptions& options)
{
  const MeshPair valid = MakePlanarPair(2, 1);
  const Point probe{ 0.5, 0.4, 0.0 };
  vtkNew<vtkHomeomorphismTransform> transform;
  Messages messages(static_cast<vtkObject*>(transform.Get()));
  transform->SetSource(valid.Source);
  transform->SetTarget(valid.Target);
  ASSERT_TRUE(transform->IsInside(probe.data()));
  ASSERT_FALSE(messages.HasError() || messages.HasWarning());

  transform->SetSource(pair.Source);
  transform->SetTarget(pair.Target);
  transform->SetCoordinateSystem(options.CoordinateSystem);
  transform->Update();
  EXPECT_TRUE(messages.HasError());
  ExpectTexts(messages.Error(), texts);
  for (int direction = 0; direction < 2; ++direction)
  {
    EXPECT_FALSE(transform->IsInside(probe.data()));
    Point image;
    transform->TransformPoint(probe.data(), image.data());
    for (const double x : image)
    {
      EXPECT_EQ(1e30, x);
    }
    double derivative[3][3];
    transform->InternalTransformDerivative(probe.data(), image.data(), derivative);
    EXPECT_TRUE(std::isnan(derivative[0][0]) && std::isnan(derivative[2][2]));
    transform->Inverse();
    transform->Update();
  }
}

void ExpectPairRefused(const MeshPair& pair, const Texts& texts, MapOptions options = {})
{
  ExpectFilterRefuses(pair, texts, options);
  ExpectTransformRefuses(pair, texts, options);
  options.Inverse = true;
  ExpectFilterRefuses(pair, texts, options);
}

/// The defect in a single mesh, which vtkTriangularCoordinates calls the triangulation.
void ExpectAloneRefused(vtkPolyData* mesh, const Texts& texts, const MapOptions& options = {})
{
  vtkNew<vtkTriangularCoordinates> filter;
  Messages messages(filter);
  const MeshPair valid = MakePlanarPair(2, 1);
  filter->SetInputData(valid.Source);
  filter->Update();
  ASSERT_FALSE(messages.HasError() || messages.HasWarning());
  ASSERT_GT(filter->GetLines()->GetNumberOfPoints(), 0);

  filter->SetInputData(mesh);
  filter->SetCoordinateSystem(options.CoordinateSystem);
  filter->Update();
  EXPECT_TRUE(messages.HasError());
  EXPECT_FALSE(messages.HasWarning()) << messages.Warning();
  ExpectTexts(messages.Error(), texts);
  EXPECT_EQ(0, filter->GetOutput()->GetNumberOfElements(vtkDataObject::POINT));
  EXPECT_EQ(0, filter->GetLines()->GetNumberOfPoints());
  EXPECT_EQ(0, filter->GetTriangulation()->GetNumberOfPoints());
  EXPECT_EQ(0, filter->GetTriangulation()->GetCellData()->GetNumberOfArrays());
}

/// A defect that either mesh can have: tests it in the source, in the target, and in a single mesh.
void ExpectRefusedOnEachSide(const MeshPair& valid, const std::function<void(vtkPolyData*)>& damage,
  const std::string& offenders, const std::string& cells, const Texts& texts)
{
  for (const bool inSource : { true, false })
  {
    MeshPair pair{ vtkSmartPointer<vtkPolyData>::New(), vtkSmartPointer<vtkPolyData>::New() };
    pair.Source->DeepCopy(valid.Source);
    pair.Target->DeepCopy(valid.Target);
    vtkPolyData* damaged = inSource ? pair.Source : pair.Target;
    damage(damaged);
    Texts expected = texts;
    expected.push_back(offenders + " of the " + (inSource ? "source" : "target") + " " + cells);
    SCOPED_TRACE(expected.back());
    ExpectPairRefused(pair, expected);
    expected.back() = offenders + " of the triangulation " + cells;
    ExpectAloneRefused(damaged, expected);
  }
}

/// Two meshes give the same map, up to rounding.
void ExpectSameMap(const MeshPair& first, const MeshPair& second,
  const std::vector<Triangle>& triangles, double tolerance)
{
  const std::vector<Point> points = SamplePoints(first.Source, triangles, 7, 2);
  for (const int system : { vtkDifferentiableHomeomorphism::LINEAR,
         vtkDifferentiableHomeomorphism::CONTOUR, vtkDifferentiableHomeomorphism::SMOOTH })
  {
    MapOptions options;
    options.CoordinateSystem = system;
    options.DiscordantTriangles = vtkDifferentiableHomeomorphism::USE_LINEAR;
    const MappedPoints a = MapPoints(first, points, options);
    const MappedPoints b = MapPoints(second, points, options);
    ASSERT_EQ("", a.Error + b.Error);
    ASSERT_EQ(points.size(), a.Images.size());
    ASSERT_EQ(points.size(), b.Images.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      ASSERT_TRUE(a.IsInside(i) && b.IsInside(i));
      worst = std::max(worst, DistanceOf(a.Images[i], b.Images[i]));
    }
    EXPECT_LE(worst, tolerance) << "system " << system;
  }
}

/// The mesh with other triangles and the same points.
vtkSmartPointer<vtkPolyData> WithTriangles(
  vtkPolyData* mesh, const std::vector<Triangle>& triangles)
{
  return MakeMesh(PointsOf(mesh), triangles);
}

MeshPair WithTriangles(const MeshPair& pair, const std::vector<Triangle>& triangles)
{
  return { WithTriangles(pair.Source, triangles), WithTriangles(pair.Target, triangles) };
}

/// A mesh with polygons of any number of corners.
vtkSmartPointer<vtkPolyData> MakePolygons(
  const std::vector<Point>& points, const std::vector<std::vector<vtkIdType>>& polygons)
{
  const auto mesh = MakeMesh(points, {});
  for (const auto& polygon : polygons)
  {
    mesh->GetPolys()->InsertNextCell(static_cast<vtkIdType>(polygon.size()), polygon.data());
  }
  return mesh;
}

template <typename ArrayType>
vtkSmartPointer<ArrayType> MakeArray(const std::vector<int>& values)
{
  const auto array = vtkSmartPointer<ArrayType>::New();
  for (const int value : values)
  {
    array->InsertNextValue(value);
  }
  return array;
}

//------------------------------------------------------------------------------------------------
// The two meshes are not isomorphic.

TEST(MeshRefusals, PointCountsDiffer)
{
  MeshPair pair = MakePlanarPair(4, 11);
  pair.Target->GetPoints()->InsertNextPoint(9.0, 9.0, 0.0);
  ExpectPairRefused(pair,
    { "The source has 25 points, the target 26",
      "Source and target must be the same mesh with different point coordinates." });
}

TEST(MeshRefusals, TriangleCountsDiffer)
{
  MeshPair pair = MakePlanarPair(4, 12);
  std::vector<Triangle> fewer = GridTriangles(4);
  fewer.pop_back();
  pair.Target = WithTriangles(pair.Target, fewer);
  ExpectPairRefused(pair,
    { "The source has 32 triangles, the target 31",
      "Source and target must be the same mesh with different point coordinates." });
}

TEST(MeshRefusals, BothDifferingCountsAreReported)
{
  ExpectPairRefused({ MakePlanarPair(4, 12).Source, MakePlanarPair(3, 12).Source },
    { "The source has 25 points, the target 16", "The source has 32 triangles, the target 18" });
}

TEST(MeshRefusals, ConnectivityDiffers)
{
  const MeshPair pair = MakePlanarPair(4, 13);
  std::vector<Triangle> triangles = GridTriangles(4);
  // The other diagonal of the second square.
  triangles[2] = { 1, 2, 6 };
  triangles[3] = { 2, 7, 6 };
  ExpectPairRefused({ pair.Source, WithTriangles(pair.Target, triangles) },
    { "2 triangles of the pair (cells 2, 3) have different points in the source and in the target",
      "Give the target the source's cells, with its own point coordinates in the same order." });
}

TEST(MeshRefusals, OneTriangleIsReportedInTheSingular)
{
  const MeshPair pair = MakePlanarPair(4, 13);
  std::vector<Triangle> triangles = GridTriangles(4);
  triangles[5] = { 2, 8, 12 };
  ExpectPairRefused({ pair.Source, WithTriangles(pair.Target, triangles) },
    { "1 triangle of the pair (cell 5) has different points in the source and in the target." });
}

TEST(MeshRefusals, SameTrianglesInAnotherOrderDiffer)
{
  const MeshPair pair = MakePlanarPair(4, 13);
  std::vector<Triangle> triangles = GridTriangles(4);
  std::rotate(triangles.begin(), triangles.begin() + 1, triangles.end());
  // More than ten: ten are listed.
  ExpectPairRefused({ pair.Source, WithTriangles(pair.Target, triangles) },
    { "32 triangles of the pair (cells 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, ...) have different points" });
}

TEST(MeshRefusals, ARepeatedCornerInOneMeshDiffers)
{
  // {0, 1, 6} and {0, 0, 6} are equal as sets of points only.
  const MeshPair pair = MakePlanarPair(4, 13);
  std::vector<Triangle> triangles = GridTriangles(4);
  triangles[0] = { 0, 0, 6 };
  ExpectPairRefused(
    { pair.Source, WithTriangles(pair.Target, triangles) }, { "1 triangle of the pair (cell 0)" });
  ExpectPairRefused(
    { WithTriangles(pair.Source, triangles), pair.Target }, { "1 triangle of the pair (cell 0)" });
}

TEST(MeshRefusals, TheOrderOfPointsOfATriangleInTheTargetIsFree)
{
  const MeshPair pair = MakePlanarPair(5, 14);
  std::vector<Triangle> triangles = GridTriangles(5);
  std::mt19937_64 generator(14);
  for (Triangle& triangle : triangles)
  {
    std::shuffle(triangle.begin(), triangle.end(), generator);
  }
  // Only the order in the source matters, so the results are identical.
  ExpectSameMap(
    pair, { pair.Source, WithTriangles(pair.Target, triangles) }, GridTriangles(5), 0.0);
}

//------------------------------------------------------------------------------------------------
// Cells that are not triangles.

TEST(MeshRefusals, PolygonsWithOtherNumbersOfCorners)
{
  const std::vector<Point> points = GridPoints(2, 15, 0.2);
  const std::vector<std::vector<vtkIdType>> polygons{ { 0, 1, 4, 3 }, { 1, 2, 5 }, { 1, 5, 4 },
    { 3, 4, 7, 6 }, { 4, 5, 8, 7, 4 }, { 4, 5 }, {} };
  const auto mesh = MakePolygons(points, polygons);
  const Texts advice{ "Triangulate the source (vtkTriangleFilter) and give the target the source's "
                      "cells, so that both are cut along the same diagonals." };
  const std::string fault = "(cells 0, 3, 4, 5, 6) are not triangles";
  ExpectPairRefused({ mesh, mesh },
    { advice[0], "5 cells of the source " + fault, "5 cells of the target " + fault });
  ExpectAloneRefused(mesh, { advice[0], "5 cells of the triangulation " + fault });

  // Only in the target, if the source was triangulated separately.
  const MeshPair pair{ MakeMesh(points, GridTriangles(2)),
    MakePolygons(points, { { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 3, 4, 7, 6 }, { 4, 5, 8, 7 } }) };
  ExpectPairRefused(pair, { advice[0], "4 cells of the target (cells 0, 1, 2, 3)" });
}

TEST(MeshRefusals, OneQuadIsReportedInTheSingular)
{
  const auto mesh = MakePolygons(GridPoints(1, 0, 0.0), { { 0, 1, 3, 2 } });
  ExpectAloneRefused(mesh, { "1 cell of the triangulation (cell 0) is not a triangle" });
}

TEST(MeshRefusals, Strips)
{
  MeshPair pair = MakePlanarPair(2, 16);
  for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
  {
    vtkNew<vtkCellArray> strips;
    const std::array<vtkIdType, 6> ids{ 0, 3, 1, 4, 2, 5 };
    strips->InsertNextCell(6, ids.data());
    strips->InsertNextCell(4, ids.data());
    mesh->SetStrips(strips);
  }
  // Strips follow the eight polygons.
  const Texts texts{ "(cells 8, 9) are triangle strips",
    "Triangulate the source (vtkTriangleFilter)" };
  ExpectPairRefused(pair, texts);
  ExpectAloneRefused(pair.Source, texts);
  pair.Source = MakePlanarPair(2, 16).Source;
  ExpectPairRefused(pair, { "2 cells of the target (cells 8, 9)" });
}

//------------------------------------------------------------------------------------------------
// Corrupt cells.

TEST(MeshRefusals, InvalidPointIds)
{
  for (const vtkIdType wrong :
    { vtkIdType(-1), vtkIdType(25), vtkIdType(1) << 31, (vtkIdType(1) << 32) + 1,
      std::numeric_limits<vtkIdType>::min(), std::numeric_limits<vtkIdType>::max() })
  {
    SCOPED_TRACE(wrong);
    for (int corner = 0; corner < 3; ++corner)
    {
      const MeshPair pair = MakePlanarPair(4, 17);
      std::vector<Triangle> triangles = GridTriangles(4);
      triangles[7][corner] = wrong;
      triangles[31][corner] = wrong;
      const MeshPair damaged = WithTriangles(pair, triangles);
      const std::string fault = "(cells 7, 31) refer to points that do not exist. The mesh is "
                                "corrupt: read or make it again.";
      ExpectPairRefused(
        damaged, { "2 triangles of the source " + fault, "2 triangles of the target " + fault });
      ExpectPairRefused({ pair.Source, damaged.Target }, { "2 triangles of the target " + fault });
      ExpectAloneRefused(damaged.Source, { "2 triangles of the triangulation " + fault });
    }
  }
}

TEST(MeshRefusals, NoPointsAtAll)
{
  vtkNew<vtkPolyData> mesh;
  mesh->SetPolys(MakeMesh({}, GridTriangles(1))->GetPolys());
  ExpectAloneRefused(mesh, { "2 triangles of the triangulation (cells 0, 1) refer to points" });
  ExpectPairRefused({ mesh.Get(), mesh.Get() }, { "2 triangles of the source (cells 0, 1)" });
}

TEST(MeshRefusals, MalformedOffsets)
{
  struct Case
  {
    std::vector<int> Offsets;
    Texts Messages;
  };
  const std::string corrupt = "refer to points that do not exist";
  const std::vector<Case> cases{
    { { 0, 3, 6, 9, 99 }, { "1 triangle of the triangulation (cell 3) refers to points" } },
    { { 0, 3, 6, 9, 13 }, { "1 triangle of the triangulation (cell 3) refers to points" } },
    { { 0, 3, 6, -9, 12 }, { "2 triangles of the triangulation (cells 2, 3) " + corrupt } },
    { { -3, 0, 3, 6, 9 }, { "1 triangle of the triangulation (cell 0) refers to points" } },
    { { 0, 6, 3, 9, 12 },
      { "1 triangle of the triangulation (cell 1) refers to points",
        "2 cells of the triangulation (cells 0, 2) are not triangles" } },
    { { 2147483645, 2147483647, 3, 6, 9 },
      { "2 triangles of the triangulation (cells 0, 1) " + corrupt } },
    { { 0, 0, 0, 0, 0 }, { "4 cells of the triangulation (cells 0, 1, 2, 3) are not triangles" } },
  };
  const std::vector<int> connectivity{ 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4 };
  for (const Case& one : cases)
  {
    for (const bool wide : { true, false })
    {
      const auto mesh = MakeMesh(GridPoints(2, 0, 0.0), {});
      vtkNew<vtkCellArray> polygons;
      if (wide)
      {
        polygons->SetData(MakeArray<vtkTypeInt64Array>(one.Offsets).Get(),
          MakeArray<vtkTypeInt64Array>(connectivity).Get());
      }
      else
      {
        polygons->SetData(MakeArray<vtkTypeInt32Array>(one.Offsets).Get(),
          MakeArray<vtkTypeInt32Array>(connectivity).Get());
      }
      mesh->SetPolys(polygons);
      ExpectAloneRefused(mesh, one.Messages);
    }
  }
}

TEST(MeshRefusals, BothWidthsOfIdsAreRead)
{
  const MeshPair pair = MakePlanarPair(4, 18);
  MeshPair narrow = WithTriangles(pair, GridTriangles(4));
  narrow.Source->GetPolys()->ConvertTo32BitStorage();
  narrow.Target->GetPolys()->ConvertTo64BitStorage();
  ASSERT_FALSE(narrow.Source->GetPolys()->IsStorage64Bit());
  ExpectSameMap(pair, narrow, GridTriangles(4), 0.0);
}

/// The mesh with triangles of which VTK knows only that each has three points, so that it may store
/// no offsets, or an implicit array of them. Null if VTK does not take such ids.
template <typename IdArray>
vtkSmartPointer<vtkPolyData> WithCellSize(vtkPolyData* mesh, const std::vector<Triangle>& triangles)
{
  vtkNew<IdArray> ids;
  for (const Triangle& triangle : triangles)
  {
    for (const vtkIdType id : triangle)
    {
      ids->InsertNextValue(static_cast<typename IdArray::ValueType>(id));
    }
  }
  vtkNew<vtkCellArray> cells;
  if (!cells->SetData(3, ids))
  {
    return nullptr;
  }
  auto copy = vtkSmartPointer<vtkPolyData>::New();
  copy->SetPoints(mesh->GetPoints());
  copy->SetPolys(cells);
  return copy;
}

TEST(MeshRefusals, CellsOfFixedSizeAreRead)
{
  const MeshPair pair = MakePlanarPair(4, 18);
  const std::vector<Triangle> triangles = GridTriangles(4);
  ExpectSameMap(pair,
    { WithCellSize<vtkTypeInt64Array>(pair.Source, triangles),
      WithCellSize<vtkTypeInt32Array>(pair.Target, triangles) },
    triangles, 0.0);
  // Only newer versions of VTK take other integers.
  if (const auto narrow = WithCellSize<vtkUnsignedShortArray>(pair.Target, triangles))
  {
    ExpectSameMap(
      pair, { WithCellSize<vtkIdTypeArray>(pair.Source, triangles), narrow }, triangles, 0.0);
  }
}

/// Expects every corner of a surface to be mapped onto that of the same surface twice as large.
void ExpectSurfaceIsMapped(vtkPolyData* surface)
{
  ASSERT_GT(surface->GetNumberOfPolys(), 100);
  vtkNew<vtkPolyData> doubled;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    const double* point = surface->GetPoint(i);
    points->InsertNextPoint(2.0 * point[0], 2.0 * point[1], 2.0 * point[2]);
  }
  doubled->SetPoints(points);
  doubled->SetPolys(surface->GetPolys());
  vtkNew<vtkDifferentiableHomeomorphism> map;
  Messages messages(map);
  map->SetSourceData(surface);
  map->SetTargetData(doubled);
  map->SetDataObject(surface);
  map->MaskInvalidTrianglesOn();
  map->Update();
  ASSERT_FALSE(messages.HasError());
  ASSERT_EQ(0, map->GetNumberOfOutsidePoints());
  auto* mapped = vtkPolyData::SafeDownCast(map->GetOutput());
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      ASSERT_NEAR(2.0 * surface->GetPoint(i)[k], mapped->GetPoint(i)[k], 1e-5);
    }
  }
}

// These filters leave the storage that is the fastest for them: in VTK 9.6, one without offsets.
TEST(MeshRefusals, SurfacesOfContourFiltersAreRead)
{
  vtkNew<vtkRTAnalyticSource> wavelet;
  wavelet->SetWholeExtent(-9, 9, -9, 9, -9, 9);
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputConnection(wavelet->GetOutputPort());
  surface->SetValue(0, 160.0);
  surface->ComputeNormalsOff();
  surface->Update();
  ExpectSurfaceIsMapped(surface->GetOutput());

  vtkNew<vtkDataSetTriangleFilter> tetrahedra;
  tetrahedra->SetInputConnection(wavelet->GetOutputPort());
  vtkNew<vtkPlane> plane;
  plane->SetNormal(1.0, 2.0, 3.0);
  vtkNew<vtkCutter> cut;
  cut->SetInputConnection(tetrahedra->GetOutputPort());
  cut->SetCutFunction(plane);
  cut->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(cut->GetOutputPort());
  triangles->Update();
  ExpectSurfaceIsMapped(triangles->GetOutput());
}

//------------------------------------------------------------------------------------------------
// Triangles with defects of their own.

TEST(MeshRefusals, RepeatedCorner)
{
  const MeshPair pair = MakePlanarPair(4, 19);
  for (int corner = 0; corner < 3; ++corner)
  {
    std::vector<Triangle> triangles = GridTriangles(4);
    triangles[9][corner] = triangles[9][(corner + 1) % 3];
    triangles[10] = { 7, 7, 7 };
    const MeshPair damaged = WithTriangles(pair, triangles);
    const std::string fault = "(cells 9, 10) use the same point twice";
    ExpectPairRefused(damaged, { "2 triangles of the source " + fault, RepairOrMask });
    ExpectAloneRefused(
      damaged.Target, { "2 triangles of the triangulation " + fault, RepairOrMask });
  }
}

TEST(MeshRefusals, NotFinite)
{
  for (const double bad : { NotANumber, Infinity, -Infinity })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      SCOPED_TRACE(testing::Message() << bad << " in coordinate " << axis);
      // Point 0 has two triangles, point 1 three.
      ExpectRefusedOnEachSide(MakePlanarPair(4, 20),
        [&](vtkPolyData* mesh) {
          Point p = PointsOf(mesh)[0];
          p[axis] = bad;
          MovePoint(mesh, 0, p);
          p = PointsOf(mesh)[1];
          p[axis] = bad;
          MovePoint(mesh, 1, p);
        },
        "4 triangles", "(cells 0, 1, 2, 3) have coordinates that are not finite", { RepairOrMask });
    }
  }
}

TEST(MeshRefusals, NotFiniteOnSurfaces)
{
  for (const double bad : { NotANumber, Infinity })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const MeshPair pair{ MakeSheet(4, 21, 0.3), MakeSheet(4, 22, 0.4) };
      ExpectRefusedOnEachSide(pair,
        [&](vtkPolyData* mesh) {
          Point p = PointsOf(mesh)[24];
          p[axis] = bad;
          MovePoint(mesh, 24, p);
        },
        "2 triangles", "(cells 30, 31) have coordinates that are not finite", {});
    }
  }
}

TEST(MeshRefusals, NoPointFinite)
{
  std::vector<Point> points(4, { NotANumber, Infinity, 0.0 });
  const auto mesh = MakeMesh(points, GridTriangles(1));
  ExpectAloneRefused(mesh, { "2 triangles of the triangulation (cells 0, 1) have coordinates" });
  ExpectPairRefused({ mesh, mesh }, { "2 triangles of the source (cells 0, 1)" });
}

TEST(MeshRefusals, UnusedPointsMayBeInvalid)
{
  const MeshPair pair = MakePlanarPair(4, 23);
  for (const Point& odd : { Point{ NotANumber, 1.0, 0.0 }, Point{ 1.0, Infinity, 0.0 },
         Point{ 1.0, 1.0, NotANumber }, Point{ 0.3, 0.4, 5.0 }, Point{ 1e300, -1e300, 0.0 } })
  {
    std::vector<Point> source = PointsOf(pair.Source);
    std::vector<Point> target = PointsOf(pair.Target);
    source.push_back(odd);
    target.push_back({ 2.0, 2.0, 0.0 });
    ExpectSameMap(pair, { MakeMesh(source, GridTriangles(4)), MakeMesh(target, GridTriangles(4)) },
      GridTriangles(4), 0.0);
    ExpectSameMap({ pair.Target, pair.Source },
      { MakeMesh(target, GridTriangles(4)), MakeMesh(source, GridTriangles(4)) }, GridTriangles(4),
      0.0);
  }
}

TEST(MeshRefusals, DegenerateTrianglesInThePlane)
{
  // Exactly collinear, with a middle point that is not the midpoint.
  const auto damage = [](vtkPolyData* mesh) {
    MovePoint(mesh, 0, { 0.0, 0.0, 0.0 });
    MovePoint(mesh, 1, { 0.5, 0.125, 0.0 });
    MovePoint(mesh, 6, { 1.0, 0.25, 0.0 });
  };
  ExpectRefusedOnEachSide(
    MakePlanarPair(4, 24, 0.0), damage, "1 triangle", "(cell 0) is degenerate", { RepairOrMask });
}

TEST(MeshRefusals, DegenerateTrianglesWithCoincidentPoints)
{
  ExpectRefusedOnEachSide(MakePlanarPair(4, 24, 0.0),
    [](vtkPolyData* mesh) {
      MovePoint(mesh, 0, { 1.0, 1.0, 0.0 });
    },
    "2 triangles", "(cells 0, 1) are degenerate", { RepairOrMask });
}

TEST(MeshRefusals, AHeightOfOneUlpIsNotDegenerate)
{
  // In a plane parallel to two axes this is decided exactly.
  const double above = std::nextafter(0.5, 1.0);
  for (const double height : { 0.5, above })
  {
    const auto mesh = MakeMesh({ { 0, 0, 0 }, { 2, 1, 0 }, { 1, height, 0 } }, { { 0, 1, 2 } });
    if (height == 0.5)
    {
      ExpectAloneRefused(mesh, { "1 triangle of the triangulation (cell 0) is degenerate" });
    }
    else
    {
      EXPECT_EQ("", MapPoints({ mesh, mesh }, { { 0, 0, 0 } }).Error);
    }
  }
}

TEST(MeshRefusals, DegenerateTrianglesInSpace)
{
  // Collinear up to the rounding of the coordinates.
  const MeshPair pair{ MakeSheet(4, 25, 0.3), MakeSheet(4, 26, 0.4) };
  ExpectRefusedOnEachSide(pair,
    [](vtkPolyData* mesh) {
      const std::vector<Point> points = PointsOf(mesh);
      Point between;
      for (int axis = 0; axis < 3; ++axis)
      {
        between[axis] = 0.7 * points[23][axis] + 0.3 * points[18][axis];
      }
      MovePoint(mesh, 24, between);
    },
    "1 triangle", "(cell 31) is degenerate", { RepairOrMask });
}

TEST(MeshRefusals, DegenerateTrianglesInSpaceInFloat)
{
  MeshPair pair{ MakeSheet(4, 25, 0.3), MakeSheet(4, 26, 0.4) };
  for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
  {
    vtkNew<vtkPoints> rounded;
    for (const Point& p : PointsOf(mesh))
    {
      rounded->InsertNextPoint(p.data());
    }
    ASSERT_EQ(VTK_FLOAT, rounded->GetDataType());
    // Exactly collinear, as midpoints of short numbers are.
    rounded->SetPoint(18, 3.0, 3.0, 0.25);
    rounded->SetPoint(23, 3.0, 4.0, 0.75);
    rounded->SetPoint(24, 3.0, 3.5, 0.5);
    mesh->SetPoints(rounded);
  }
  ExpectPairRefused(pair, { "1 triangle of the source (cell 31) is degenerate" });
  ExpectAloneRefused(pair.Target, { "1 triangle of the triangulation (cell 31) is degenerate" });
}

TEST(MeshRefusals, AllPointsInALine)
{
  const auto mesh =
    MakeMesh({ { 0, 0, 0 }, { 1, 2, 3 }, { 2, 4, 6 }, { 3, 6, 9 } }, { { 0, 1, 2 }, { 1, 2, 3 } });
  ExpectAloneRefused(mesh, { "2 triangles of the triangulation (cells 0, 1) are degenerate" });
  const auto point = MakeMesh(std::vector<Point>(3, { 1, 2, 3 }), { { 0, 1, 2 } });
  ExpectAloneRefused(point, { "1 triangle of the triangulation (cell 0) is degenerate" });
  const auto origin = MakeMesh(std::vector<Point>(3, { 0, 0, 0 }), { { 0, 1, 2 } });
  ExpectAloneRefused(origin, { "1 triangle of the triangulation (cell 0) is degenerate" });
}

TEST(MeshRefusals, DefectsOfBothMeshesAreReported)
{
  const MeshPair pair = MakePlanarPair(4, 27, 0.0);
  MovePoint(pair.Source, 0, { 1.0, 1.0, 0.0 });
  MovePoint(pair.Target, 24, { 3.0, 3.0, 0.0 });
  ExpectPairRefused(pair,
    { "2 triangles of the source (cells 0, 1) are degenerate",
      "2 triangles of the target (cells 30, 31) are degenerate" });
}

TEST(MeshRefusals, TenIdsAreListedInFull)
{
  // Points 0 to 5 of the lowest row of squares are moved to the row above: all its triangles
  // collapse.
  for (const int n : { 5, 6 })
  {
    const MeshPair pair = MakePlanarPair(n, 28, 0.0);
    for (vtkIdType i = 0; i <= n; ++i)
    {
      MovePoint(pair.Source, i, { double(i), 1.0, 0.0 });
    }
    ExpectPairRefused(pair,
      { n == 5 ? "10 triangles of the source (cells 0, 1, 2, 3, 4, 5, 6, 7, 8, 9) are degenerate"
               : "12 triangles of the source (cells 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, ...) are "
                 "degenerate" });
  }
}

//------------------------------------------------------------------------------------------------
// Non-manifold and non-orientable surfaces.

TEST(MeshRefusals, NonManifoldEdge)
{
  // A fin on the edge of triangles 0 and 1.
  MeshPair pair{ MakeSheet(3, 29, 0.3), MakeSheet(3, 30, 0.4) };
  std::vector<Triangle> triangles = GridTriangles(3);
  triangles.push_back({ 0, 5, 16 });
  for (auto* mesh : { &pair.Source, &pair.Target })
  {
    std::vector<Point> points = PointsOf(*mesh);
    points.push_back({ 0.5, 0.5, 2.0 });
    *mesh = MakeMesh(points, triangles);
  }
  const std::string fault = "(cells 0, 1, 18) are at non-manifold edges";
  ExpectPairRefused(pair, { "3 triangles of the source " + fault, RepairOrMask });
  ExpectAloneRefused(pair.Target, { "3 triangles of the triangulation " + fault, RepairOrMask });
}

/// A ring of n squares with n half turns, each square divided into two triangles.
vtkSmartPointer<vtkPolyData> MakeTwistedRing(int n, int halfTurns, double width)
{
  const double pi = std::acos(-1.0);
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  for (int i = 0; i < n; ++i)
  {
    const double around = 2.0 * pi * i / n;
    const double twist = pi * halfTurns * i / n;
    for (const double side : { -width, width })
    {
      const double radius = 1.0 + side * std::cos(twist);
      points.push_back(
        { radius * std::cos(around), radius * std::sin(around), side * std::sin(twist) });
    }
    const bool crossed = i + 1 == n && halfTurns % 2 != 0;
    const vtkIdType a = 2 * i;
    const vtkIdType next = 2 * ((i + 1) % n);
    const vtkIdType c = next + (crossed ? 1 : 0);
    const vtkIdType d = next + (crossed ? 0 : 1);
    triangles.push_back({ a, c, a + 1 });
    triangles.push_back({ a + 1, c, d });
  }
  return MakeMesh(points, triangles);
}

TEST(MeshRefusals, NonOrientableSurface)
{
  const MeshPair pair{ MakeTwistedRing(12, 1, 0.3), MakeTwistedRing(12, 1, 0.2) };
  const Texts texts{
    "cannot be wound consistently with their neighbors: the surface is non-orientable",
    "Cut the surface open along a line of edges in both meshes."
  };
  ExpectPairRefused(pair, { texts[0], texts[1], "2 triangles of the source (cells " });
  ExpectAloneRefused(pair.Source, { texts[0], texts[1], "2 triangles of the triangulation" });
  const MeshPair threeTurns{ MakeTwistedRing(12, 3, 0.3), MakeTwistedRing(12, 3, 0.2) };
  ExpectPairRefused(threeTurns, texts);
}

TEST(MeshRefusals, OrientableRingsAreAccepted)
{
  for (const int halfTurns : { 0, 2 })
  {
    const MeshPair pair{ MakeTwistedRing(12, halfTurns, 0.3), MakeTwistedRing(12, halfTurns, 0.2) };
    const MappedPoints mapped = MapPoints(pair, PointsOf(pair.Source));
    EXPECT_EQ("", mapped.Error + mapped.Warning);
    ASSERT_EQ(24u, mapped.Images.size());
    EXPECT_EQ(PointsOf(pair.Target), mapped.Images);
  }
}

//------------------------------------------------------------------------------------------------
// Orientation.

TEST(MeshRefusals, OneFlippedTriangle)
{
  // Cells 30 and 31 share point 24. Moving it across the edge from 18 to 23 flips only cell 31.
  const MeshPair pair = MakePlanarPair(4, 31, 0.0);
  MovePoint(pair.Target, 24, { 2.9, 3.5, 0.0 });
  const Texts texts{ "1 triangle of the pair (cell 31) is flipped between source and target "
                     "relative to the rest",
    "Move their points so that all triangles keep their orientation (or all are mirrored), or turn "
    "MaskInvalidTriangles on" };
  ExpectPairRefused(pair, texts);
  ExpectPairRefused({ pair.Target, pair.Source }, texts);
}

TEST(MeshRefusals, SeveralFlippedTriangles)
{
  const MeshPair pair = MakePlanarPair(4, 32, 0.0);
  // An interior vertex is moved far across the grid.
  MovePoint(pair.Target, 6, { 3.6, 3.7, 0.0 });
  ExpectPairRefused(pair, { "2 triangles of the pair (cells 10, 11) are flipped" });
}

TEST(MeshRefusals, FlippedRelativeToTheRestOfAMirroredMesh)
{
  const MeshPair pair = MakePlanarPair(4, 31, 0.0);
  MovePoint(pair.Target, 24, { 2.9, 3.5, 0.0 });
  std::vector<Point> mirrored = PointsOf(pair.Target);
  for (Point& p : mirrored)
  {
    p[0] = -p[0];
  }
  ExpectPairRefused({ pair.Source, MakeMesh(mirrored, GridTriangles(4)) },
    { "1 triangle of the pair (cell 31) is flipped" });
}

TEST(MeshRefusals, MirroredPairsAreAccepted)
{
  const MeshPair pair = MakePlanarPair(4, 33);
  std::vector<Point> mirrored = PointsOf(pair.Target);
  for (Point& p : mirrored)
  {
    p[0] = -p[0];
  }
  const std::vector<Point> points = SamplePoints(pair.Source, GridTriangles(4), 7, 33);
  const MappedPoints plain = MapPoints(pair, points);
  const MappedPoints mapped =
    MapPoints({ pair.Source, MakeMesh(mirrored, GridTriangles(4)) }, points);
  ASSERT_EQ("", mapped.Error + mapped.Warning);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    EXPECT_NEAR(-plain.Images[i][0], mapped.Images[i][0], 1e-15 * 8);
    EXPECT_NEAR(plain.Images[i][1], mapped.Images[i][1], 1e-15 * 8);
  }
}

TEST(MeshRefusals, MixedWindingIsAccepted)
{
  std::vector<Triangle> mixed = GridTriangles(5);
  std::mt19937_64 generator(34);
  for (Triangle& triangle : mixed)
  {
    std::shuffle(triangle.begin(), triangle.end(), generator);
  }
  const MeshPair pair = MakePlanarPair(5, 34);
  ExpectSameMap(pair, WithTriangles(pair, mixed), GridTriangles(5), 2e-14);
  const MeshPair sheets{ MakeSheet(5, 35, 0.3), MakeSheet(5, 36, 0.4) };
  ExpectSameMap(sheets, WithTriangles(sheets, mixed), GridTriangles(5), 2e-14);
}

TEST(MeshRefusals, ReversedWindingInTheSourceIsAccepted)
{
  std::vector<Triangle> reversed = GridTriangles(5);
  for (Triangle& triangle : reversed)
  {
    std::swap(triangle[0], triangle[2]);
  }
  const MeshPair pair = MakePlanarPair(5, 37);
  ExpectSameMap(
    pair, { WithTriangles(pair.Source, reversed), pair.Target }, GridTriangles(5), 2e-14);
}

//------------------------------------------------------------------------------------------------
// Overlaps.

TEST(MeshRefusals, FoldInBothMeshes)
{
  // The triangle at the corner is folded over its neighbor in both meshes, so no triangle is
  // flipped between them.
  const MeshPair pair = MakePlanarPair(4, 38, 0.0);
  for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
  {
    MovePoint(mesh, 24, { 2.9, 3.5, 0.0 });
  }
  const std::string fault = "(cells 28, 30, 31) overlap other triangles";
  ExpectPairRefused(pair,
    { "3 triangles of the source " + fault, "3 triangles of the target " + fault, RepairOrMask });
  ExpectAloneRefused(pair.Source, { "3 triangles of the triangulation " + fault, RepairOrMask });
}

TEST(MeshRefusals, TwoPiecesOverlap)
{
  // Two single triangles, which may touch.
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 3, 4, 5 } };
  const auto apart = MakeMesh(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }, triangles);
  const auto overlapping = MakeMesh(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.99, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }, triangles);
  EXPECT_EQ("", MapPoints({ apart, apart }, { { 0, 0, 0 } }).Error);
  const std::string fault = "(cells 0, 1) overlap other triangles";
  ExpectPairRefused({ overlapping, apart }, { "2 triangles of the source " + fault, RepairOrMask });
  ExpectPairRefused({ apart, overlapping }, { "2 triangles of the target " + fault, RepairOrMask });
  ExpectPairRefused({ overlapping, overlapping },
    { "2 triangles of the source " + fault, "2 triangles of the target " + fault });
  ExpectAloneRefused(overlapping, { "2 triangles of the triangulation " + fault });
}

TEST(MeshRefusals, DuplicateTriangle)
{
  const auto mesh =
    MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 }, { 2, 0, 1 } });
  ExpectAloneRefused(
    mesh, { "2 triangles of the triangulation (cells 0, 1) overlap other triangles" });
}

TEST(MeshRefusals, FanWithTwoTurns)
{
  // Ten triangles around a vertex, each covering a fifth of a turn: there is no fold and no
  // interior boundary, but every triangle covers another one.
  const double pi = std::acos(-1.0);
  std::vector<Point> points{ { 0, 0, 0 } };
  std::vector<Triangle> triangles;
  for (vtkIdType i = 0; i < 10; ++i)
  {
    const double angle = 4.0 * pi * double(i) / 10.0;
    const double radius = i % 2 ? 1.0 : 1.2;
    points.push_back({ radius * std::cos(angle), radius * std::sin(angle), 0.0 });
    triangles.push_back({ 0, i + 1, (i + 1) % 10 + 1 });
  }
  const auto mesh = MakeMesh(points, triangles);
  const std::string fault = "(cells 0, 1, 2, 3, 4, 5, 6, 7, 8, 9) overlap other triangles";
  ExpectPairRefused({ mesh, mesh }, { "10 triangles of the source " + fault });
  ExpectAloneRefused(mesh, { "10 triangles of the triangulation " + fault });
}

TEST(MeshRefusals, SelfOverlappingStrip)
{
  // Locally the mesh is valid; only its two ends overlap.
  const double pi = std::acos(-1.0);
  const auto spiral = [pi](double turns) {
    std::vector<Point> points;
    std::vector<Triangle> triangles;
    constexpr vtkIdType steps = 40;
    for (vtkIdType i = 0; i <= steps; ++i)
    {
      const double angle = 2.0 * pi * turns * double(i) / double(steps);
      for (const double radius : { 1.0, 2.0 })
      {
        points.push_back({ radius * std::cos(angle), radius * std::sin(angle), 0.0 });
      }
      if (i < steps)
      {
        triangles.push_back({ 2 * i, 2 * i + 1, 2 * i + 3 });
        triangles.push_back({ 2 * i, 2 * i + 3, 2 * i + 2 });
      }
    }
    return MakeMesh(points, triangles);
  };
  const auto open = spiral(0.9);
  const auto closed = spiral(1.01);
  EXPECT_EQ("", MapPoints({ open, open }, { { 1.5, 0, 0 } }).Error);
  ExpectPairRefused(
    { open, closed }, { "4 triangles of the target (cells 0, 1, 78, 79) overlap other triangles" });
  ExpectAloneRefused(closed, { "4 triangles of the triangulation (cells 0, 1, 78, 79)" });
}

TEST(MeshRefusals, SurfacesMayPassThroughThemselves)
{
  // In 3-space only single triangles are checked.
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 3, 4, 5 } };
  const auto mesh = MakeMesh(
    { { -1, -1, 0 }, { 1, -1, 0 }, { 0, 1, 0 }, { 0, 0, -1 }, { 0, 0.5, 1 }, { 0, -0.5, 1 } },
    triangles);
  const MappedPoints mapped = MapPoints({ mesh, mesh }, PointsOf(mesh));
  EXPECT_EQ("", mapped.Error + mapped.Warning);
  EXPECT_EQ(PointsOf(mesh), mapped.Images);
}

//------------------------------------------------------------------------------------------------
// The Contour system.

/// Moves the corner of the target so close to its neighbor on the diagonal that cells 0 and 1
/// between them have an obtuse angle beside a short edge.
void MakeCornerDiscordant(const MeshPair& pair)
{
  MovePoint(pair.Source, 6, { 1.0, 1.0, 0.0 });
  MovePoint(pair.Target, 6, { 1.0, 1.0, 0.0 });
  MovePoint(pair.Target, 0, { 0.8, 0.8, 0.0 });
}

TEST(MeshRefusals, DiscordantTriangles)
{
  const MeshPair pair = MakePlanarPair(4, 39, 0.05);
  MakeCornerDiscordant(pair);
  MapOptions options;
  options.CoordinateSystem = vtkDifferentiableHomeomorphism::CONTOUR;
  const std::string fault = "are discordant: the foot of a center segment is not inside its edge, "
                            "so the Contour system does not exist there";
  const std::string advice = "Use the Smooth system, which takes any triangle, or map them by the "
                             "Linear system (DiscordantTriangles).";
  ExpectPairRefused(pair, { "2 triangles of the target (cells 0, 1) " + fault, advice }, options);
  ExpectPairRefused({ pair.Target, pair.Source },
    { "2 triangles of the source (cells 0, 1) " + fault, advice }, options);
  ExpectAloneRefused(
    pair.Target, { "2 triangles of the triangulation (cells 0, 1) " + fault, advice }, options);

  // Mapping by the Linear system was requested, so there is no warning.
  const std::vector<Point> points = SamplePoints(pair.Source, GridTriangles(4), 5, 39);
  options.DiscordantTriangles = vtkDifferentiableHomeomorphism::USE_LINEAR;
  const MappedPoints mapped = MapPoints(pair, points, options);
  EXPECT_EQ("", mapped.Error + mapped.Warning);
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->SetCoordinateSystemToContour();
  filter->SetDiscordantTriangles(vtkDifferentiableHomeomorphism::USE_LINEAR);
  const auto cloud = MakeCloud(points);
  filter->SetDataObject(cloud);
  filter->Update();
  EXPECT_EQ(2, filter->GetNumberOfDiscordantTriangles());
  vtkDataArray* systems = vtkPolyData::SafeDownCast(filter->GetOutput())
                            ->GetPointData()
                            ->GetArray("UsedCoordinateSystem");
  ASSERT_TRUE(systems);
  // Five points in each triangle: the first ten are in cells 0 and 1.
  for (vtkIdType i = 0; i < systems->GetNumberOfTuples(); ++i)
  {
    EXPECT_EQ(
      i < 10 ? vtkDifferentiableHomeomorphism::LINEAR : vtkDifferentiableHomeomorphism::CONTOUR,
      systems->GetTuple1(i));
  }
  options.CoordinateSystem = vtkDifferentiableHomeomorphism::LINEAR;
  const MappedPoints linear = MapPoints(pair, points, options);
  EXPECT_EQ("", linear.Error + linear.Warning);
  ASSERT_EQ(points.size(), mapped.Images.size());
  double otherwise = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (i < 10)
    {
      EXPECT_EQ(linear.Images[i], mapped.Images[i]);
    }
    otherwise = std::max(otherwise, DistanceOf(linear.Images[i], mapped.Images[i]));
  }
  EXPECT_GT(otherwise, 1e-4);

  for (const int system :
    { vtkDifferentiableHomeomorphism::LINEAR, vtkDifferentiableHomeomorphism::SMOOTH })
  {
    options.CoordinateSystem = system;
    const MappedPoints accepted = MapPoints(pair, points, options);
    EXPECT_EQ("", accepted.Error + accepted.Warning);
  }
}

TEST(MeshRefusals, DiscordantAtTheLimit)
{
  // a^2 = b^2 + 3 c^2 exactly, with the long edge from (0, 0) to (6, 0) and the apex at (x, y): 36
  // = (6 - x)^2 + y^2 + 3 (x^2 + y^2) where x^2 + y^2 = 3 x, as at (1.5, 1.5). At the limit the
  // triangle is discordant; an ulp away it depends on the direction.
  MapOptions options;
  options.CoordinateSystem = vtkDifferentiableHomeomorphism::CONTOUR;
  for (const double y : { std::nextafter(1.5, 0.0), 1.5, std::nextafter(1.5, 2.0) })
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      Triangle ids;
      for (int k = 0; k < 3; ++k)
      {
        ids[(k + corner) % 3] = k;
      }
      const auto mesh = MakeMesh({ { 0, 0, 0 }, { 6, 0, 0 }, { 1.5, y, 0 } }, { ids });
      if (y > 1.5)
      {
        EXPECT_EQ("", MapPoints({ mesh, mesh }, { { 0, 0, 0 } }, options).Error);
      }
      else
      {
        ExpectAloneRefused(
          mesh, { "1 triangle of the triangulation (cell 0) is discordant: the foot" }, options);
      }
    }
  }
}

TEST(MeshRefusals, NoTriangleIsDiscordantWithTheIncenter)
{
  const MeshPair pair = MakePlanarPair(4, 39, 0.05);
  MakeCornerDiscordant(pair);
  vtkNew<vtkTriangularCoordinates> filter;
  Messages messages(filter);
  filter->SetInputData(pair.Target);
  filter->SetCoordinateSystemToContour();
  filter->SetCenterPoint(vtkTriangularCoordinates::INCENTER);
  filter->Update();
  EXPECT_FALSE(messages.HasError() || messages.HasWarning());
  EXPECT_EQ(25, filter->GetOutput()->GetNumberOfElements(vtkDataObject::POINT));
}

//------------------------------------------------------------------------------------------------
// The transform.

TEST(MeshRefusals, TransformOfSurfaces)
{
  const vtkSmartPointer<vtkPolyData> plane = MakePlanarPair(4, 40).Source;
  const vtkSmartPointer<vtkPolyData> sheet = MakeSheet(4, 40, 0.3);
  const std::string fault = " mesh do not lie in a plane, so the map is not one of space: every "
                            "point counts as outside. Use vtkDifferentiableHomeomorphism for "
                            "surfaces.";
  ExpectTransformRefuses({ sheet, plane }, { "The points of the source" + fault }, {});
  ExpectTransformRefuses({ plane, sheet }, { "The points of the target" + fault }, {});
  ExpectTransformRefuses({ sheet, sheet }, { "The points of the source" + fault }, {});
}

TEST(MeshRefusals, TransformWithoutMeshes)
{
  const vtkSmartPointer<vtkPolyData> plane = MakePlanarPair(4, 41).Source;
  ExpectTransformRefuses({ nullptr, plane },
    { "The source mesh is not set (SetSource, SetTarget): every point counts as outside." }, {});
  ExpectTransformRefuses({ plane, nullptr }, { "The target mesh is not set" }, {});
  ExpectTransformRefuses({ nullptr, nullptr }, { "The source mesh is not set" }, {});
}

//------------------------------------------------------------------------------------------------
// Cells other than triangles, and blanked cells.

/// Adds vertex cells and lines, which vtkPolyData numbers before polygons.
void AddVerticesAndLines(vtkPolyData* mesh, int vertices, int lines)
{
  vtkNew<vtkCellArray> vertexCells;
  vtkNew<vtkCellArray> lineCells;
  for (vtkIdType i = 0; i < vertices; ++i)
  {
    vertexCells->InsertNextCell(1, &i);
  }
  const std::array<vtkIdType, 4> ids{ 0, 1, 2, 3 };
  for (int i = 0; i < lines; ++i)
  {
    lineCells->InsertNextCell(4, ids.data());
  }
  mesh->SetVerts(vertexCells);
  mesh->SetLines(lineCells);
}

TEST(MeshRefusals, VerticesAndLinesShiftTheCellIds)
{
  const MeshPair pair = MakePlanarPair(4, 42, 0.0);
  AddVerticesAndLines(pair.Source, 3, 2);
  AddVerticesAndLines(pair.Target, 3, 2);
  const std::vector<Point> points{ CentroidOf(pair.Source, GridTriangles(4)[7]) };
  const MappedPoints mapped = MapPoints(pair, points);
  EXPECT_EQ("", mapped.Error + mapped.Warning);
  EXPECT_EQ(std::vector<vtkIdType>{ 12 }, mapped.Triangles);

  vtkNew<vtkTriangularCoordinates> coordinates;
  coordinates->SetInputData(pair.Source);
  const auto cloud = MakeCloud(points);
  coordinates->SetDataObject(cloud);
  coordinates->Update();
  EXPECT_EQ(12,
    vtkPolyData::SafeDownCast(coordinates->GetOutput())
      ->GetPointData()
      ->GetArray("TriangleId")
      ->GetTuple1(0));

  MovePoint(pair.Source, 0, { 1.0, 1.0, 0.0 });
  ExpectPairRefused(pair, { "2 triangles of the source (cells 5, 6) are degenerate" });
  ExpectAloneRefused(pair.Source, { "2 triangles of the triangulation (cells 5, 6)" });
}

TEST(MeshRefusals, VerticesAndLinesShiftTheIdsOfNonTriangles)
{
  const MeshPair pair = MakePlanarPair(4, 42);
  std::vector<Triangle> triangles = GridTriangles(4);
  triangles[7] = { 0, 1, 99 };
  const auto corrupt = WithTriangles(pair.Source, triangles);
  triangles[7] = { 0, 1, 6 };
  const auto other = WithTriangles(pair.Target, triangles);
  const auto quad = MakePolygons(GridPoints(1, 0, 0.0), { { 0, 1, 3, 2 } });
  for (vtkPolyData* mesh : { pair.Source.Get(), corrupt.Get(), other.Get(), quad.Get() })
  {
    AddVerticesAndLines(mesh, 3, 2);
  }
  ExpectAloneRefused(corrupt, { "1 triangle of the triangulation (cell 12) refers to points" });
  ExpectAloneRefused(quad, { "1 cell of the triangulation (cell 5) is not a triangle" });
  ExpectPairRefused(
    { pair.Source, other }, { "1 triangle of the pair (cell 12) has different points" });
  vtkNew<vtkCellArray> strips;
  const std::array<vtkIdType, 4> ids{ 0, 1, 2, 3 };
  strips->InsertNextCell(4, ids.data());
  pair.Source->SetStrips(strips);
  ExpectAloneRefused(pair.Source, { "1 cell of the triangulation (cell 37) is a triangle strip" });
}

TEST(MeshRefusals, VerticesAndLinesOfOneMeshAlone)
{
  const MeshPair plain = MakePlanarPair(4, 43);
  MeshPair pair = WithTriangles(plain, GridTriangles(4));
  AddVerticesAndLines(pair.Source, 3, 2);
  ExpectSameMap(plain, pair, GridTriangles(4), 0.0);
  AddVerticesAndLines(pair.Target, 1, 7);
  ExpectSameMap(plain, pair, GridTriangles(4), 0.0);
}

TEST(MeshRefusals, CellIdsOfTheTargetAreReported)
{
  // Cell ids of defects of the target are those of the target.
  const MeshPair pair = MakePlanarPair(4, 44, 0.0);
  AddVerticesAndLines(pair.Source, 3, 2);
  AddVerticesAndLines(pair.Target, 1, 0);
  MovePoint(pair.Target, 0, { 1.0, 1.0, 0.0 });
  ExpectPairRefused(pair, { "2 triangles of the target (cells 1, 2) are degenerate" });
}

/// Marks cells or points as hidden.
void Blank(vtkDataSetAttributes* attributes, vtkIdType tuples, const std::vector<vtkIdType>& ids,
  unsigned char mark)
{
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(tuples);
  ghosts->FillValue(0);
  for (const vtkIdType id : ids)
  {
    ghosts->SetValue(id, mark);
  }
  attributes->AddArray(ghosts);
}

/// Maps points in every triangle of a pair. Those in the given triangles must be outside, and the
/// others must have the same images as without these triangles.
void ExpectHoles(const MeshPair& pair, const std::vector<Triangle>& triangles,
  const std::vector<std::size_t>& holes)
{
  std::vector<Triangle> rest;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (std::find(holes.begin(), holes.end(), t) == holes.end())
    {
      rest.push_back(triangles[t]);
    }
  }
  const MeshPair pierced = WithTriangles(pair, rest);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const std::vector<Point> points = SamplePoints(pair.Source, { triangles[t] }, 3, t);
    const MappedPoints mapped = MapPoints(pair, points);
    const MappedPoints expected = MapPoints(pierced, points);
    ASSERT_EQ("", mapped.Error + mapped.Warning);
    const bool hole = std::find(holes.begin(), holes.end(), t) != holes.end();
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      EXPECT_EQ(hole, !mapped.IsInside(i)) << "triangle " << t;
      EXPECT_EQ(expected.Images[i], mapped.Images[i]) << "triangle " << t;
    }
  }
}

TEST(MeshRefusals, BlankedCellsAreHoles)
{
  for (const bool inSource : { true, false })
  {
    const MeshPair pair = MakePlanarPair(4, 45);
    vtkPolyData* mesh = inSource ? pair.Source : pair.Target;
    Blank(mesh->GetCellData(), 32, { 3, 17, 31 }, vtkDataSetAttributes::HIDDENCELL);
    ExpectHoles(pair, GridTriangles(4), { 3, 17, 31 });
  }
}

TEST(MeshRefusals, BlankedPointsAreHoles)
{
  for (const bool inSource : { true, false })
  {
    const MeshPair pair = MakePlanarPair(4, 46);
    vtkPolyData* mesh = inSource ? pair.Source : pair.Target;
    Blank(mesh->GetPointData(), 25, { 0, 24 }, vtkDataSetAttributes::HIDDENPOINT);
    ExpectHoles(pair, GridTriangles(4), { 0, 1, 30, 31 });
  }
}

TEST(MeshRefusals, DuplicateCellsAndPointsAreNotHoles)
{
  const MeshPair pair = MakePlanarPair(4, 46);
  Blank(pair.Source->GetCellData(), 32, { 3 }, vtkDataSetAttributes::DUPLICATECELL);
  Blank(pair.Source->GetPointData(), 25, { 3 }, vtkDataSetAttributes::DUPLICATEPOINT);
  ExpectHoles(pair, GridTriangles(4), {});
}

TEST(MeshRefusals, BlankedCellsBesideVerticesAndLines)
{
  // The ghost array covers all cells. Triangles are numbered after vertices and lines, which may
  // differ between the meshes.
  struct Counts
  {
    int SourceVertices;
    int SourceLines;
    int TargetVertices;
    int TargetLines;
  };
  for (const Counts& n : { Counts{ 3, 2, 3, 2 }, Counts{ 0, 0, 4, 1 }, Counts{ 4, 3, 0, 0 } })
  {
    for (const bool inSource : { true, false })
    {
      SCOPED_TRACE(testing::Message()
        << n.SourceVertices << n.SourceLines << n.TargetVertices << n.TargetLines << inSource);
      const MeshPair pair = MakePlanarPair(4, 47);
      AddVerticesAndLines(pair.Source, n.SourceVertices, n.SourceLines);
      AddVerticesAndLines(pair.Target, n.TargetVertices, n.TargetLines);
      vtkPolyData* mesh = inSource ? pair.Source : pair.Target;
      const vtkIdType first =
        inSource ? n.SourceVertices + n.SourceLines : n.TargetVertices + n.TargetLines;
      Blank(mesh->GetCellData(), 32 + first, { first + 3, first + 30 },
        vtkDataSetAttributes::HIDDENCELL);
      ExpectHoles(pair, GridTriangles(4), { 3, 30 });
    }
  }
}

TEST(MeshRefusals, BlankedDefectsAreIgnored)
{
  MeshPair pair = MakePlanarPair(4, 48, 0.0);
  MovePoint(pair.Source, 0, { NotANumber, 0.0, 7.0 });
  MovePoint(pair.Target, 24, { 3.0, 3.0, 0.0 });
  Blank(pair.Source->GetCellData(), 32, { 0, 1 }, vtkDataSetAttributes::HIDDENCELL);
  Blank(pair.Target->GetPointData(), 25, { 24 }, vtkDataSetAttributes::HIDDENPOINT);
  const MappedPoints mapped =
    MapPoints(pair, { { 1.5, 1.25, 0.0 }, { 0.6, 0.3, 0.0 }, { 3.7, 3.4, 0.0 } });
  EXPECT_EQ("", mapped.Error + mapped.Warning);
  EXPECT_EQ((std::vector<vtkIdType>{ 10, -1, -1 }), mapped.Triangles);
}

TEST(MeshRefusals, BlankedTrianglesDoNotAffectPlanarity)
{
  const MeshPair pair = MakePlanarPair(4, 49);
  MovePoint(pair.Source, 0, { 0.0, 0.0, 7.0 });
  MovePoint(pair.Target, 0, { 0.0, 0.0, -1e5 });
  Blank(pair.Target->GetCellData(), 32, { 0, 1 }, vtkDataSetAttributes::HIDDENCELL);
  vtkNew<vtkHomeomorphismTransform> transform;
  Messages messages(static_cast<vtkObject*>(transform.Get()));
  transform->SetSource(pair.Source);
  transform->SetTarget(pair.Target);
  const Point probe{ 2.3, 2.7, 11.0 };
  EXPECT_TRUE(transform->IsInside(probe.data()));
  EXPECT_EQ("", messages.Error());
}

TEST(MeshRefusals, NearlyPlanarMeshesAreNamed)
{
  using homeomorphism::MeshDiagnostic;
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 0, 2, 3 } };
  const auto flat = MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1.5, 0 } }, triangles);
  const std::vector<Point> probes{ { 0.3, 0.2, 0 }, { 0.6, 0.9, 0 }, { 0.5, 0.5, 0 } };
  for (const double noise : { 1e-9, 1e-12, 1e-7 })
  {
    const auto noisy =
      MakeMesh({ { 0, 0, noise }, { 1, 0, -noise }, { 1, 1, noise }, { 0, 1, 0 } }, triangles);
    homeomorphism::MeshDiagnostics diagnostics;
    ASSERT_TRUE(homeomorphism::Homeomorphism::Make(noisy, flat, {}, diagnostics));
    ASSERT_EQ(1u, diagnostics.size());
    EXPECT_EQ(MeshDiagnostic::Kind::NearlyPlanar, diagnostics[0].What);
    EXPECT_EQ(MeshDiagnostic::Mesh::Source, diagnostics[0].Where);
    EXPECT_EQ(MeshDiagnostic::Outcome::Accepted, diagnostics[0].Result);
    EXPECT_NEAR(2.0 * noise, diagnostics[0].Size, 1e-15);
    EXPECT_LT(diagnostics[0].Tolerance, 100.0 * noise);

    MapOptions options;
    const MappedPoints without = MapPoints({ noisy, flat }, probes, options);
    options.Tolerance = diagnostics[0].Tolerance;
    const MappedPoints with = MapPoints({ noisy, flat }, probes, options);
    for (std::size_t i = 0; i + 1 < probes.size(); ++i)
    {
      EXPECT_FALSE(without.IsInside(i));
      EXPECT_TRUE(with.IsInside(i));
    }
  }
  // Planar meshes and surfaces are not.
  for (const auto& mesh :
    { flat, MakeMesh({ { 0, 0, 0 }, { 1, 0, 1e-3 }, { 1, 1, 0 }, { 0, 1, 0 } }, triangles) })
  {
    homeomorphism::MeshDiagnostics diagnostics;
    EXPECT_TRUE(homeomorphism::Homeomorphism::Make(mesh, mesh, {}, diagnostics));
    EXPECT_TRUE(diagnostics.empty());
  }
}

TEST(MeshRefusals, EmptyMeshesLeaveAllPointsOutside)
{
  for (const bool points : { true, false })
  {
    const auto mesh =
      points ? MakeMesh(GridPoints(2, 0, 0.0), {}) : vtkSmartPointer<vtkPolyData>::New();
    const MappedPoints mapped = MapPoints({ mesh, mesh }, { { 0, 0, 0 }, { 1, 1, 0 } });
    EXPECT_EQ("", mapped.Error + mapped.Warning);
    EXPECT_EQ((std::vector<vtkIdType>{ -1, -1 }), mapped.Triangles);
    EXPECT_EQ((std::vector<Point>{ { 0, 0, 0 }, { 1, 1, 0 } }), mapped.Images);

    vtkNew<vtkTriangularCoordinates> coordinates;
    Messages messages(coordinates);
    coordinates->SetInputData(mesh);
    coordinates->Update();
    EXPECT_FALSE(messages.HasError() || messages.HasWarning());

    vtkNew<vtkHomeomorphismTransform> transform;
    Messages transformMessages(static_cast<vtkObject*>(transform.Get()));
    transform->SetSource(mesh);
    transform->SetTarget(mesh);
    const Point origin{};
    EXPECT_FALSE(transform->IsInside(origin.data()));
    EXPECT_FALSE(transformMessages.HasError() || transformMessages.HasWarning());
  }
}

} // namespace
