// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FilterRuns.h
/// Runs of the VTK classes: coordinate systems, filters, messages, and comparisons of what came
/// out.

#ifndef fixtures_FilterRuns_h
#define fixtures_FilterRuns_h

#include "Meshes.h"

#include "vtkDifferentiableHomeomorphism.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkTriangularCoordinates.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkCellLocator.h"
#include "vtkCommand.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkTestErrorObserver.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <ostream>
#include <set>
#include <string>

namespace fixtures
{

// --- Access to VTK objects -----------------------------------------------------------------------

inline Point PointOf(vtkPoints* points, vtkIdType i)
{
  Point p;
  points->GetPoint(i, p.data());
  return p;
}
inline Point VectorOf(vtkDataArray* array, vtkIdType i)
{
  Point p;
  array->GetTuple(i, p.data());
  return p;
}
inline Matrix MatrixOf(vtkDataArray* array, vtkIdType i)
{
  double tuple[9];
  array->GetTuple(i, tuple);
  return { { { tuple[0], tuple[1], tuple[2] }, { tuple[3], tuple[4], tuple[5] },
    { tuple[6], tuple[7], tuple[8] } } };
}
inline vtkDataArray* PointArray(vtkDataSet* data, const char* name)
{
  return data->GetPointData()->GetArray(name);
}
inline vtkDataArray* CellArray(vtkDataSet* data, const char* name)
{
  return data->GetCellData()->GetArray(name);
}
/// The number of an array of points or of cells.
inline double PointValue(vtkDataSet* data, const char* name, vtkIdType i)
{
  return PointArray(data, name)->GetComponent(i, 0);
}
inline double CellValue(vtkDataSet* data, const char* name, vtkIdType i)
{
  return CellArray(data, name)->GetComponent(i, 0);
}
inline bool IsValid(vtkDataSet* data, vtkIdType i)
{
  return PointValue(data, "vtkValidPointMask", i) != 0.0;
}
inline vtkIdType CountOutside(vtkDataSet* data)
{
  vtkIdType count = 0;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    count += !IsValid(data, i);
  }
  return count;
}
/// The first components.
inline std::vector<double> ValuesOf(vtkDataArray* array)
{
  std::vector<double> values;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(array->GetComponent(i, 0));
  }
  return values;
}
inline Matrix JacobianOf(vtkDataSet* data, vtkIdType i)
{
  return MatrixOf(PointArray(data, "Jacobian"), i);
}

/// Length of the diagonal of the bounding box of a mesh.
inline double SizeOf(vtkDataSet* mesh)
{
  return mesh->GetLength();
}
inline double LargestCoordinate(vtkDataSet* mesh)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  double largest = 0.0;
  for (const double bound : bounds)
  {
    largest = std::max(largest, std::abs(bound));
  }
  return largest;
}

/// The number rounded to float. It is stored in between, because GCC 12 optimizes vectorized
/// conversions of neighboring elements to float and back away.
inline double RoundedToFloat(double x)
{
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}
inline Point RoundedToFloat(const Point& p)
{
  return { RoundedToFloat(p[0]), RoundedToFloat(p[1]), RoundedToFloat(p[2]) };
}

/// Whether two numbers are the same double (NaN equals NaN).
inline bool SameBits(double a, double b)
{
  std::uint64_t first;
  std::uint64_t second;
  std::memcpy(&first, &a, sizeof(a));
  std::memcpy(&second, &b, sizeof(b));
  return first == second || (std::isnan(a) && std::isnan(b)) || (a == 0.0 && b == 0.0);
}

/// Number of points that differ in any bit of their coordinates.
inline vtkIdType CountDifferentPoints(vtkDataSet* a, vtkDataSet* b)
{
  EXPECT_EQ(a->GetNumberOfPoints(), b->GetNumberOfPoints());
  vtkIdType different = 0;
  for (vtkIdType i = 0; i < std::min(a->GetNumberOfPoints(), b->GetNumberOfPoints()); ++i)
  {
    const Point p = PointOf(a, i);
    const Point q = PointOf(b, i);
    different += !(SameBits(p[0], q[0]) && SameBits(p[1], q[1]) && SameBits(p[2], q[2]));
  }
  return different;
}

/// Number of values that differ in any bit; all of them if the arrays differ in type or size.
inline vtkIdType CountDifferentValues(vtkDataArray* a, vtkDataArray* b)
{
  if (!a || !b || a->GetDataType() != b->GetDataType() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents() ||
    a->GetNumberOfTuples() != b->GetNumberOfTuples())
  {
    return -1;
  }
  vtkIdType different = 0;
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < a->GetNumberOfComponents(); ++k)
    {
      different += !SameBits(a->GetComponent(i, k), b->GetComponent(i, k));
    }
  }
  return different;
}

/// The points and these arrays of them are equal to the last bit.
inline void ExpectSame(vtkDataSet* a, vtkDataSet* b, const std::vector<const char*>& names)
{
  EXPECT_EQ(CountDifferentPoints(a, b), 0);
  for (const char* name : names)
  {
    EXPECT_EQ(CountDifferentValues(PointArray(a, name), PointArray(b, name)), 0) << name;
  }
}

/// The largest distance between points of the same number, infinite if one is not a number.
inline double LargestDistance(vtkDataSet* a, vtkDataSet* b)
{
  EXPECT_EQ(a->GetNumberOfPoints(), b->GetNumberOfPoints());
  double largest = 0.0;
  for (vtkIdType i = 0; i < std::min(a->GetNumberOfPoints(), b->GetNumberOfPoints()); ++i)
  {
    const double distance = Distance(PointOf(a, i), PointOf(b, i));
    largest = std::isnan(distance) ? Infinity : std::max(largest, distance);
  }
  return largest;
}

/// The largest distance of a point from a mesh, by VTK.
inline double LargestDistanceFrom(vtkPolyData* mesh, const std::vector<Point>& points)
{
  vtkNew<vtkCellLocator> locator;
  locator->SetDataSet(mesh);
  locator->BuildLocator();
  double largest = 0.0;
  for (const Point& point : points)
  {
    Point nearest;
    vtkIdType cell;
    int subId;
    double squared;
    locator->FindClosestPoint(point.data(), nearest.data(), cell, subId, squared);
    largest = std::max(largest, std::sqrt(squared));
  }
  return largest;
}

inline vtkIdType CountDifferentCells(vtkDataSet* a, vtkDataSet* b)
{
  EXPECT_EQ(a->GetNumberOfCells(), b->GetNumberOfCells());
  vtkIdType different = 0;
  vtkNew<vtkIdList> first;
  vtkNew<vtkIdList> second;
  for (vtkIdType i = 0; i < std::min(a->GetNumberOfCells(), b->GetNumberOfCells()); ++i)
  {
    a->GetCellPoints(i, first);
    b->GetCellPoints(i, second);
    different += !(a->GetCellType(i) == b->GetCellType(i) &&
      std::equal(first->begin(), first->end(), second->begin(), second->end()));
  }
  return different;
}

/// An array of random numbers.
template <typename ArrayType = vtkDoubleArray>
vtkSmartPointer<ArrayType> RandomArray(
  const char* name, int components, vtkIdType tuples, std::uint64_t seed)
{
  Random random(seed);
  auto array = vtkSmartPointer<ArrayType>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < tuples * components; ++i)
  {
    array->SetValue(i, static_cast<typename ArrayType::ValueType>(random.Uniform(-100.0, 100.0)));
  }
  return array;
}

// --- Coordinate systems --------------------------------------------------------------------------

/// A coordinate system with its options.
struct System
{
  const char* Name;
  int CoordinateSystem;
  int CenterPoint = vtkDifferentiableHomeomorphism::CENTROID;

  bool IsContour() const
  {
    return this->CoordinateSystem == vtkDifferentiableHomeomorphism::CONTOUR;
  }
  /// Whether discordant triangles have no coordinates of the system.
  bool IsChoosy() const
  {
    return this->IsContour() && this->CenterPoint == vtkDifferentiableHomeomorphism::CENTROID;
  }
};

inline void PrintTo(const System& system, std::ostream* os)
{
  *os << system.Name;
}

constexpr System Linear{ "Linear", vtkDifferentiableHomeomorphism::LINEAR };
constexpr System Contour{ "Contour", vtkDifferentiableHomeomorphism::CONTOUR };
constexpr System Incenter{ "ContourFromIncenter", vtkDifferentiableHomeomorphism::CONTOUR,
  vtkDifferentiableHomeomorphism::INCENTER };
constexpr System Smooth{ "Smooth", vtkDifferentiableHomeomorphism::SMOOTH };
/// Not among all systems: of planes only, and its inverse is not the map of exchanged meshes.
constexpr System Cubic{ "Cubic", vtkDifferentiableHomeomorphism::CUBIC };

inline std::vector<System> AllSystems()
{
  return { Linear, Contour, Incenter, Smooth };
}

using TestInEverySystem = ::testing::TestWithParam<System>;

/// For INSTANTIATE_TEST_SUITE_P.
inline std::string NameOfSystem(const ::testing::TestParamInfo<System>& info)
{
  return info.param.Name;
}

/// Discordant triangles are mapped by the Linear system.
template <typename Algorithm>
void SetSystem(Algorithm* algorithm, const System& system)
{
  algorithm->SetCoordinateSystem(system.CoordinateSystem);
  algorithm->SetCenterPoint(system.CenterPoint);
  algorithm->SetDiscordantTriangles(Algorithm::USE_LINEAR);
}

/// An algorithm of two meshes, with its default options.
template <typename Algorithm>
vtkSmartPointer<Algorithm> MakeAlgorithm(const MeshPair& pair)
{
  auto algorithm = vtkSmartPointer<Algorithm>::New();
  algorithm->SetSourceData(pair.Source);
  algorithm->SetTargetData(pair.Target);
  return algorithm;
}

inline vtkSmartPointer<vtkDifferentiableHomeomorphism> MakeFilter(
  const System& system, const MeshPair& pair, vtkDataObject* data = nullptr)
{
  auto filter = MakeAlgorithm<vtkDifferentiableHomeomorphism>(pair);
  SetSystem(filter.Get(), system);
  if (data)
  {
    filter->SetDataObject(data);
  }
  return filter;
}

inline vtkSmartPointer<vtkHomeomorphismTransform> MakeTransform(
  const System& system, const MeshPair& pair)
{
  auto transform = vtkSmartPointer<vtkHomeomorphismTransform>::New();
  SetSystem(transform.Get(), system);
  transform->SetSource(pair.Source);
  transform->SetTarget(pair.Target);
  return transform;
}

inline Point Transformed(vtkAbstractTransform* transform, const Point& p)
{
  Point image;
  transform->TransformPoint(p.data(), image.data());
  return image;
}

/// The coordinates in a mesh, without their lines.
inline vtkSmartPointer<vtkTriangularCoordinates> MakeCoordinates(
  const System& system, vtkPolyData* triangulation, vtkDataObject* data = nullptr)
{
  auto filter = vtkSmartPointer<vtkTriangularCoordinates>::New();
  SetSystem(filter.Get(), system);
  filter->SetSourceData(triangulation);
  if (data)
  {
    filter->SetDataObject(data);
  }
  filter->GenerateLinesOff();
  return filter;
}

/// The output after an update, as a data set: a point set, for the map.
inline vtkDataSet* Output(vtkAlgorithm* filter)
{
  filter->Update();
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
}
inline vtkPointSet* Output(vtkDifferentiableHomeomorphism* filter)
{
  filter->Update();
  return vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
}

// --- Messages and pieces -------------------------------------------------------------------------

/// Collects the errors and warnings of an algorithm and its executive.
class Messages
{
public:
  explicit Messages(vtkAlgorithm* algorithm)
  {
    for (vtkObject* object :
      std::initializer_list<vtkObject*>{ algorithm, algorithm->GetExecutive() })
    {
      object->AddObserver(vtkCommand::ErrorEvent, this->Observer);
      object->AddObserver(vtkCommand::WarningEvent, this->Observer);
    }
  }
  explicit Messages(vtkObject* object)
  {
    object->AddObserver(vtkCommand::ErrorEvent, this->Observer);
    object->AddObserver(vtkCommand::WarningEvent, this->Observer);
  }

  bool HasError() { return this->Observer->GetError(); }
  bool HasWarning() { return this->Observer->GetWarning(); }
  std::string Error() { return this->Observer->GetErrorMessage(); }
  std::string Warning() { return this->Observer->GetWarningMessage(); }
  void Clear() { this->Observer->Clear(); }

private:
  vtkNew<vtkTest::ErrorObserver> Observer;
};

/// Requests a piece of an output, as a consumer of that port does.
inline vtkDataSet* UpdatePiece(vtkAlgorithm* filter, int piece, int pieces, int port = 0)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  filter->UpdateInformation();
  vtkInformation* request = filter->GetOutputInformation(port);
  request->Set(Pipeline::UPDATE_PIECE_NUMBER(), piece);
  request->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), pieces);
  request->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  filter->Update(port);
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(port));
}

// --- Images of points ----------------------------------------------------------------------------

struct MapOptions
{
  int CoordinateSystem = vtkDifferentiableHomeomorphism::SMOOTH;
  bool Mask = false;
  bool Inverse = false;
  int DiscordantTriangles = vtkDifferentiableHomeomorphism::REFUSE;
  double Tolerance = 0.0;
};

struct MappedPoints
{
  std::vector<Point> Images;
  std::vector<vtkIdType> Triangles;
  std::string Error;
  std::string Warning;

  bool IsInside(std::size_t i) const { return this->Triangles.at(i) >= 0; }
};

inline MappedPoints MapPoints(
  const MeshPair& pair, const std::vector<Point>& points, const MapOptions& options = {})
{
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  Messages messages(filter);
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  const auto cloud = MakeCloud(points);
  filter->SetDataObject(cloud);
  filter->SetCoordinateSystem(options.CoordinateSystem);
  filter->SetMaskInvalidTriangles(options.Mask);
  filter->SetInverse(options.Inverse);
  filter->SetDiscordantTriangles(options.DiscordantTriangles);
  filter->SetTolerance(options.Tolerance);
  filter->ComputeTriangleIdOn();
  filter->Update();

  MappedPoints result;
  result.Error = messages.Error();
  result.Warning = messages.Warning();
  auto* output = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  if (output && output->GetNumberOfPoints() > 0)
  {
    result.Images = PointsOf(output);
    vtkDataArray* triangles = output->GetPointData()->GetArray("TriangleId");
    for (vtkIdType i = 0; i < triangles->GetNumberOfTuples(); ++i)
    {
      result.Triangles.push_back(static_cast<vtkIdType>(triangles->GetTuple1(i)));
    }
  }
  return result;
}

} // namespace fixtures

#endif
