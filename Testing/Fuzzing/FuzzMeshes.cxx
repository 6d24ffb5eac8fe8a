// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes meshes and data from arbitrary bytes and maps points through all classes or, in FuzzMaps,
// from raw arrays to mapped points without VTK's pipeline, which is ten times faster. For all
// bytes: nothing crashes or hangs, and every point reported as inside has an image whose preimage
// is the point. If the environment variable FUZZ_SHOW is set, the meshes encoded by the bytes are
// printed.

#include "FuzzInput.h"

#include "../Cxx/Fixtures/Meshes.h"

#include "Mesh/Homeomorphism.h"

#include "vtkCellData.h"
#include "vtkDifferentiableHomeomorphism.h"
#include "vtkDoubleArray.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkIdTypeArray.h"
#include "vtkJacobianContinuity.h"
#include "vtkObject.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkResampleThroughHomeomorphism.h"
#include "vtkSMPTools.h"
#include "vtkTriangularCoordinates.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>

namespace
{

using fuzz::Input;

constexpr int MostPoints = 16;
constexpr int MostCells = 16;

vtkSmartPointer<vtkPoints> AnyPoints(Input& input, int count)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  const bool inFloat = input.Chance(8);
  const bool inPlane = !input.Chance(4);
  points->SetDataType(inFloat ? VTK_FLOAT : VTK_DOUBLE);
  for (int i = 0; i < count; ++i)
  {
    const double x = input.Number();
    const double y = input.Number();
    points->InsertNextPoint(x, y, inPlane ? 0.0 : input.Number());
  }
  points->Squeeze();
  return points;
}

/// A cell array, valid or invalid.
template <typename ArrayType>
vtkSmartPointer<vtkCellArray> RawCells(Input& input, int count, int points)
{
  vtkNew<ArrayType> offsets;
  vtkNew<ArrayType> connectivity;
  offsets->InsertNextValue(0);
  const bool sound = !input.Chance(8);
  for (int i = 0; i < count; ++i)
  {
    const int corners = input.Chance(16) ? input.Below(6) : 3;
    for (int k = 0; k < corners; ++k)
    {
      connectivity->InsertNextValue(
        points == 0 || input.Chance(64) ? input.Byte() - 8 : input.Below(points));
    }
    const auto end = static_cast<int>(connectivity->GetNumberOfValues());
    // Invalid offsets often differ only slightly from valid ones.
    const int wrong = sound || input.Chance(2) ? 0 : input.Below(5) - 2;
    offsets->InsertNextValue(sound || wrong != 0 ? end + wrong : input.Byte() - 8);
  }
  // The allocation ends with the values, so that the sanitizer detects reading past them.
  offsets->Squeeze();
  connectivity->Squeeze();
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

vtkSmartPointer<vtkCellArray> AnyCells(Input& input, int points)
{
  if (input.Chance(2))
  {
    // A grid, which is a valid mesh more often than random ids are.
    const vtkSmartPointer<vtkCellArray> cells =
      fixtures::MakeMesh({}, fixtures::GridTriangles(1 + input.Below(3)))->GetPolys();
    cells->Squeeze();
    return cells;
  }
  const int count = input.Below(MostCells + 1);
  return input.Chance(2) ? RawCells<vtkTypeInt32Array>(input, count, points)
                         : RawCells<vtkTypeInt64Array>(input, count, points);
}

void AddGhosts(Input& input, vtkDataSetAttributes* attributes, vtkIdType tuples)
{
  if (!input.Chance(16))
  {
    return;
  }
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(input.Chance(4) ? input.Below(40) : tuples);
  for (vtkIdType i = 0; i < ghosts->GetNumberOfTuples(); ++i)
  {
    ghosts->SetValue(i, input.Byte());
  }
  attributes->AddArray(ghosts);
}

[[noreturn]] void Fail(const char* what)
{
  std::cerr << "Broken: " << what << std::endl;
  std::abort();
}

bool IsTame(vtkPoints* points)
{
  for (vtkIdType i = 0; points && i < points->GetNumberOfPoints(); ++i)
  {
    double p[3];
    points->GetPoint(i, p);
    for (const double x : p)
    {
      // Larger numbers may overflow in intermediate results, and smaller ones underflow.
      if (!(std::abs(x) < 1e100) || (x != 0.0 && std::abs(x) < 1e-100))
      {
        return false;
      }
    }
  }
  return true;
}

struct Setting
{
  int System;
  int Center;
  bool Mask;
  bool ByLinear;
  bool Inverse;
  /// Whether the data is the mesh itself.
  bool MapsTheMesh;
};

template <typename Algorithm>
void Configure(Algorithm* algorithm, const Setting& setting)
{
  algorithm->SetCoordinateSystem(setting.System);
  algorithm->SetCenterPoint(setting.Center);
  algorithm->SetMaskInvalidTriangles(setting.Mask);
  algorithm->SetDiscordantTriangles(setting.ByLinear ? 1 : 0);
}

constexpr double HalfUlp = 0.5 * std::numeric_limits<double>::epsilon();

std::shared_ptr<const homeomorphism::Homeomorphism> MakeMap(vtkPolyData* source,
  vtkPolyData* target, const Setting& setting, homeomorphism::MeshDiagnostics& problems)
{
  homeomorphism::HomeomorphismOptions options;
  options.System = static_cast<homeomorphism::CoordinateSystem>(setting.System);
  options.Center = static_cast<homeomorphism::CenterPoint>(setting.Center);
  options.MaskInvalidTriangles = setting.Mask;
  options.DiscordantByLinear = setting.ByLinear;
  return homeomorphism::Homeomorphism::Make(source, target, options, problems);
}

/// Whether rounding may move an image out of the domain. This is possible far from the origin, if
/// the rounding error of the image exceeds the tolerance of the domain.
bool IsFarBeside(
  const homeomorphism::Homeomorphism& map, homeomorphism::Domain domain, const double image[3])
{
  const double largest = std::max({ std::abs(image[0]), std::abs(image[1]), std::abs(image[2]) });
  const double scale = map.GetPair().GetGeometry(domain).GetScale();
  return 4.0 * HalfUlp * largest * scale > map.GetAbsoluteTolerance(domain, 0.0, HalfUlp);
}

/// Fails unless an image is finite, its determinant is not NaN, and the image is found in the other
/// domain.
void CheckImage(const homeomorphism::Homeomorphism& map, homeomorphism::Domain from,
  const double image[3], double determinant, bool isFound)
{
  if (!(std::isfinite(image[0]) && std::isfinite(image[1]) && std::isfinite(image[2])))
  {
    Fail("an image that is not finite");
  }
  if (std::isnan(determinant))
  {
    Fail("a determinant that is not a number");
  }
  if (!isFound && !IsFarBeside(map, Opposite(from), image))
  {
    Fail("an image outside the other domain");
  }
}

/// Maps the points without the filters, which is far faster.
void MapDirectly(
  vtkPolyData* source, vtkPolyData* target, vtkPoints* points, const Setting& setting, bool tame)
{
  using namespace homeomorphism;
  MeshDiagnostics problems;
  const auto map = MakeMap(source, target, setting, problems);
  if (!map)
  {
    if (!IsRefused(problems))
    {
      Fail("refused without a word");
    }
    return;
  }
  const Domain from = setting.Inverse ? Domain::Target : Domain::Source;
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double point[3];
    points->GetPoint(i, point);
    const SurfacePoint surfacePoint =
      map->Locate(from, point, map->GetAbsoluteTolerance(from, 0.0, HalfUlp), -1);
    if (surfacePoint.Triangle < 0)
    {
      continue;
    }
    double image[3];
    map->MapPoint(from, surfacePoint, image);
    const Jacobian jacobian = map->GetJacobian(from, surfacePoint);
    const double tolerance = map->GetAbsoluteTolerance(Opposite(from), 0.0, HalfUlp);
    if (tame)
    {
      CheckImage(*map, from, image, jacobian.Determinant,
        map->Locate(Opposite(from), image, tolerance, -1).Triangle >= 0);
    }
  }
}

void MapByFilter(vtkPolyData* meshes[2], vtkPolyData* cloud, const Setting& setting, bool tame)
{
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  filter->SetSourceData(meshes[0]);
  filter->SetTargetData(meshes[1]);
  filter->SetDataObject(cloud);
  Configure(filter.Get(), setting);
  filter->SetInverse(setting.Inverse);
  filter->ComputeJacobianDeterminantOn();
  filter->ComputeTriangleIdOn();
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  const bool taken = filter->GetErrorCode() == 0;
  if (output->GetNumberOfPoints() != (taken ? cloud->GetNumberOfPoints() : 0))
  {
    Fail("an error and an output, or neither");
  }
  if (taken)
  {
    auto* valid =
      vtkUnsignedCharArray::SafeDownCast(output->GetPointData()->GetArray("vtkValidPointMask"));
    vtkDataArray* determinant = output->GetPointData()->GetArray("JacobianDeterminant");
    if (!valid || !determinant)
    {
      Fail("no mask or no determinant");
    }
    homeomorphism::MeshDiagnostics problems;
    const auto map = MakeMap(meshes[0], meshes[1], setting, problems);
    if (!map)
    {
      Fail("meshes taken once and refused then");
    }
    vtkNew<vtkDifferentiableHomeomorphism> back;
    back->SetSourceData(meshes[0]);
    back->SetTargetData(meshes[1]);
    back->SetDataObject(output);
    Configure(back.Get(), setting);
    back->SetInverse(!setting.Inverse);
    back->Update();
    auto* returned = vtkPointSet::SafeDownCast(back->GetOutputDataObject(0));
    auto* returnedValid =
      vtkUnsignedCharArray::SafeDownCast(returned->GetPointData()->GetArray("vtkValidPointMask"));
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      if (!valid->GetValue(i) || !tame)
      {
        continue;
      }
      double image[3];
      output->GetPoint(i, image);
      CheckImage(*map,
        setting.Inverse ? homeomorphism::Domain::Target : homeomorphism::Domain::Source, image,
        determinant->GetComponent(i, 0), returnedValid && returnedValid->GetValue(i));
    }
  }
}

void MapByTransform(vtkPolyData* meshes[2], vtkPoints* points, const Setting& setting)
{
  vtkNew<vtkHomeomorphismTransform> transform;
  transform->SetSource(meshes[0]);
  transform->SetTarget(meshes[1]);
  Configure(transform.Get(), setting);
  vtkNew<vtkPoints> images;
  transform->TransformPoints(points, images);
  transform->GetInverse()->TransformPoints(images, points);
}

void FindCoordinates(vtkPolyData* mesh, const Setting& setting)
{
  vtkNew<vtkTriangularCoordinates> coordinates;
  coordinates->SetInputData(mesh);
  Configure(coordinates.Get(), setting);
  coordinates->SetNumberOfContours(2);
  coordinates->SetNumberOfRings(2);
  coordinates->SetLineResolution(3);
  coordinates->Update();
}

void MeasureAndResample(vtkPolyData* meshes[2], vtkPolyData* cloud, const Setting& setting)
{
  vtkNew<vtkJacobianContinuity> continuity;
  continuity->SetInputDataObject(0, meshes[0]);
  continuity->SetInputDataObject(1, meshes[1]);
  Configure(continuity.Get(), setting);
  continuity->SetSamplesPerEdge(1);
  continuity->SetVertices(true);
  continuity->Update();

  vtkNew<vtkResampleThroughHomeomorphism> resample;
  resample->SetInputDataObject(0, meshes[0]);
  resample->SetInputDataObject(1, meshes[1]);
  resample->SetInputDataObject(2, setting.Inverse ? cloud : meshes[0]);
  Configure(resample.Get(), setting);
  resample->SetSamplingDimensions(4, 3);
  resample->Update();
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  vtkObject::GlobalWarningDisplayOff();
  vtkSMPTools::SetBackend("Sequential");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  Input input(bytes, size);
#ifdef FUZZ_MAPS_ONLY
  const int way = -1;
#else
  const int way = input.Below(8);
#endif
  Setting setting;
  setting.MapsTheMesh = input.Chance(4);
  setting.System = input.Below(3);
  setting.Center = input.Below(2);
  setting.Mask = input.Chance(2);
  setting.ByLinear = input.Chance(2);
  setting.Inverse = input.Chance(2);
  const int numberOfPoints = input.Chance(2) ? 16 : input.Below(MostPoints + 1);

  vtkNew<vtkPolyData> meshes[2];
  const auto cells = AnyCells(input, numberOfPoints);
  const bool ownCells = input.Chance(8);
  for (int domain = 0; domain < 2; ++domain)
  {
    meshes[domain]->SetPoints(AnyPoints(input, numberOfPoints));
    meshes[domain]->SetPolys(domain == 1 && ownCells ? AnyCells(input, numberOfPoints) : cells);
    if (input.Chance(16))
    {
      meshes[domain]->SetLines(RawCells<vtkTypeInt64Array>(input, input.Below(3), numberOfPoints));
    }
    if (input.Chance(16))
    {
      meshes[domain]->SetStrips(RawCells<vtkTypeInt64Array>(input, input.Below(2), numberOfPoints));
    }
    AddGhosts(input, meshes[domain]->GetPointData(), numberOfPoints);
    AddGhosts(input, meshes[domain]->GetCellData(), meshes[domain]->GetPolys()->GetNumberOfCells());
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(AnyPoints(input, 1 + input.Below(12)));
  vtkNew<vtkDoubleArray> vectors;
  vectors->SetName("Vectors");
  vectors->SetNumberOfComponents(3);
  for (int i = input.Chance(16) ? input.Below(40) : static_cast<int>(cloud->GetNumberOfPoints());
       i > 0; --i)
  {
    vectors->InsertNextTuple3(1.0, input.Number(), -1.0);
  }
  vectors->Squeeze();
  cloud->GetPointData()->SetVectors(vectors);
  if (input.Chance(4))
  {
    const auto points = static_cast<int>(cloud->GetNumberOfPoints());
    cloud->SetLines(RawCells<vtkTypeInt64Array>(input, input.Below(4), points));
    cloud->SetPolys(RawCells<vtkTypeInt32Array>(input, input.Below(6), points));
    vtkNew<vtkDoubleArray> flux;
    flux->SetName("Flux");
    flux->SetNumberOfComponents(3);
    flux->SetNumberOfTuples(input.Chance(8) ? input.Below(20) : cloud->GetNumberOfCells());
    flux->Fill(1.0);
    cloud->GetCellData()->SetVectors(flux);
  }

  const bool tame =
    IsTame(meshes[0]->GetPoints()) && IsTame(meshes[1]->GetPoints()) && IsTame(cloud->GetPoints());
  vtkPolyData* pair[2] = { meshes[0], meshes[1] };
  if (std::getenv("FUZZ_SHOW"))
  {
    std::cout.precision(17);
    for (vtkPolyData* mesh : { pair[0], pair[1], cloud.Get() })
    {
      for (const fixtures::Point& p : fixtures::PointsOf(mesh))
      {
        std::cout << p[0] << ", " << p[1] << ", " << p[2] << "\n";
      }
      mesh->GetPolys()->PrintDebug(std::cout);
    }
    std::cout << "way " << way << ", system " << setting.System << ", center " << setting.Center
              << ", mask " << setting.Mask << ", by linear " << setting.ByLinear << ", inverse "
              << setting.Inverse << std::endl;
  }
  switch (way)
  {
    case 0:
    case 1:
      MapByFilter(
        pair, setting.MapsTheMesh ? pair[setting.Inverse ? 1 : 0] : cloud.Get(), setting, tame);
      break;
    case 2:
      MapByTransform(pair, cloud->GetPoints(), setting);
      break;
    case 3:
      FindCoordinates(meshes[0], setting);
      break;
    case 4:
      MeasureAndResample(pair, cloud, setting);
      break;
    default:
      MapDirectly(meshes[0], meshes[1], cloud->GetPoints(), setting, tame);
  }
  return 0;
}
