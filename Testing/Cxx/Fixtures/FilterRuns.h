// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FilterRuns.h
/// Runs of the VTK classes: coordinate systems, filters, messages, and comparisons of results.

#ifndef fixtures_FilterRuns_h
#define fixtures_FilterRuns_h

#include "Meshes.h"

#include "vtkDifferentiableHomeomorphism.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkJacobianContinuity.h"
#include "vtkTriangularCoordinates.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkImplicitPolyDataDistance.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkTestErrorObserver.h"
#include "vtkVariant.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <ostream>
#include <set>
#include <string>

namespace fixtures
{

// --- Access to VTK objects -----------------------------------------------------------------------

inline Point VectorOf(vtkDataArray* array, vtkIdType i)
{
  Point p{};
  array->GetTuple(i, p.data());
  return p;
}
inline Matrix MatrixOf(vtkDataArray* array, vtkIdType i)
{
  Matrix m;
  array->GetTuple(i, m[0].data());
  return m;
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
inline vtkIdType CountOutside(vtkDataSet* data)
{
  const std::vector<double> mask = ValuesOf(PointArray(data, "vtkValidPointMask"));
  return std::count(mask.begin(), mask.end(), 0.0);
}
inline Matrix JacobianOf(vtkDataSet* data, vtkIdType i)
{
  return MatrixOf(PointArray(data, "Jacobian"), i);
}

inline double LargestCoordinate(vtkDataSet* mesh)
{
  const double* b = mesh->GetBounds();
  return std::max({ -b[0], b[1], -b[2], b[3], -b[4], b[5] });
}

/// The number rounded to float. It is stored in between, because GCC 12 optimizes vectorized
/// conversions of neighboring elements to float and back away.
inline double RoundedToFloat(double x)
{
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}

/// Whether two numbers are the same double (NaN equals NaN, and 0 equals -0).
inline bool SameBits(double a, double b)
{
  return a == b || (std::isnan(a) && std::isnan(b));
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

/// Whether two arrays have the same type, size and values.
inline bool IsSame(vtkDataArray* a, vtkDataArray* b)
{
  if (!a || !b || a->GetDataType() != b->GetDataType() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents() ||
    a->GetNumberOfTuples() != b->GetNumberOfTuples())
  {
    return false;
  }
  bool same = true;
  for (vtkIdType i = 0; i < a->GetNumberOfValues(); ++i)
  {
    same = same && SameBits(a->GetVariantValue(i).ToDouble(), b->GetVariantValue(i).ToDouble());
  }
  return same;
}

/// The points and these arrays of them are equal to the last bit.
inline void ExpectSame(vtkDataSet* a, vtkDataSet* b, const std::vector<const char*>& names)
{
  EXPECT_EQ(CountDifferentPoints(a, b), 0);
  for (const char* name : names)
  {
    EXPECT_TRUE(IsSame(PointArray(a, name), PointArray(b, name))) << name;
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
  vtkNew<vtkImplicitPolyDataDistance> distance;
  distance->SetInput(mesh);
  double largest = 0.0;
  for (Point point : points)
  {
    largest = std::max(largest, std::abs(distance->EvaluateFunction(point.data())));
  }
  return largest;
}

inline vtkIdType CountDifferentCells(vtkDataSet* a, vtkDataSet* b)
{
  EXPECT_EQ(a->GetNumberOfCells(), b->GetNumberOfCells());
  vtkIdType different = 0;
  for (vtkIdType i = 0; i < std::min(a->GetNumberOfCells(), b->GetNumberOfCells()); ++i)
  {
    different += a->GetCellType(i) != b->GetCellType(i) || IdsOf(a, i) != IdsOf(b, i);
  }
  return different;
}

/// An array of the values of a function at the points.
template <typename Function>
vtkSmartPointer<vtkDoubleArray> ValuesAt(vtkDataSet* data, const char* name, Function&& function)
{
  auto values = vtkSmartPointer<vtkDoubleArray>::New();
  values->SetName(name);
  for (const Point& p : PointsOf(data))
  {
    values->InsertNextValue(function(p));
  }
  return values;
}

inline vtkSmartPointer<vtkImageData> MakeImage(
  std::array<int, 6> extent, const Point& origin, const Point& spacing)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(extent.data());
  image->SetOrigin(origin.data());
  image->SetSpacing(spacing.data());
  return image;
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

/// Sets the meshes of an algorithm. Coordinates have no target.
inline void SetMeshes(vtkHomeomorphismAlgorithm* algorithm, const MeshPair& pair)
{
  algorithm->SetSourceData(pair.Source);
  if (!vtkTriangularCoordinates::SafeDownCast(algorithm))
  {
    algorithm->SetTargetData(pair.Target);
  }
}

/// An algorithm of two meshes, with its default options.
template <typename Algorithm>
vtkSmartPointer<Algorithm> MakeAlgorithm(const MeshPair& pair)
{
  auto algorithm = vtkSmartPointer<Algorithm>::New();
  SetMeshes(algorithm, pair);
  return algorithm;
}

inline vtkSmartPointer<vtkDifferentiableHomeomorphism> MakeFilter(
  const System& system, const MeshPair& pair, vtkDataObject* data = nullptr)
{
  auto filter = MakeAlgorithm<vtkDifferentiableHomeomorphism>(pair);
  SetSystem(filter.Get(), system);
  filter->SetDataObject(data);
  return filter;
}

/// Adds the arrays that tell of the map at each point.
inline void ComputeEverything(vtkDifferentiableHomeomorphism* filter)
{
  filter->ComputeJacobianOn();
  filter->ComputeJacobianDeterminantOn();
  filter->ComputeTriangleIdOn();
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
  filter->SetDataObject(data);
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

/// Lists the features of every type.
inline void ListEverything(vtkJacobianContinuity* filter)
{
  filter->BoundaryEdgesOn();
  filter->SpokesOn();
  filter->WingSegmentsOn();
  filter->CenterSegmentsOn();
  filter->StripBordersOn();
  filter->CentroidsOn();
  filter->VerticesOn();
}

/// Measures the edges, unless something else is changed before.
inline vtkSmartPointer<vtkJacobianContinuity> Measure(
  const MeshPair& pair, const System& system,
  const std::function<void(vtkJacobianContinuity*)>& change = [](vtkJacobianContinuity*) {})
{
  auto filter = MakeAlgorithm<vtkJacobianContinuity>(pair);
  SetSystem(filter.Get(), system);
  change(filter);
  filter->Update();
  return filter;
}

// --- Messages and pieces -------------------------------------------------------------------------

/// Collects the errors and warnings of an algorithm and its executive.
class Messages
{
public:
  explicit Messages(vtkObject* object)
  {
    this->Observe(object);
    if (auto* algorithm = vtkAlgorithm::SafeDownCast(object))
    {
      this->Observe(algorithm->GetExecutive());
    }
  }

  bool HasError() { return this->Observer->GetError(); }
  bool HasWarning() { return this->Observer->GetWarning(); }
  std::string Error() { return this->Observer->GetErrorMessage(); }
  std::string Warning() { return this->Observer->GetWarningMessage(); }
  void Clear() { this->Observer->Clear(); }

private:
  void Observe(vtkObject* object)
  {
    object->AddObserver(vtkCommand::ErrorEvent, this->Observer);
    object->AddObserver(vtkCommand::WarningEvent, this->Observer);
  }
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
  System CoordinateSystem = Smooth;
  bool Mask = false;
  bool Inverse = false;
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
  const auto filter = MakeFilter(options.CoordinateSystem, pair, MakeCloud(points));
  Messages messages(filter);
  filter->SetMaskInvalidTriangles(options.Mask);
  filter->SetInverse(options.Inverse);
  filter->SetTolerance(options.Tolerance);
  filter->ComputeTriangleIdOn();
  vtkPointSet* output = Output(filter);
  const std::vector<double> ids = ValuesOf(PointArray(output, "TriangleId"));
  return { PointsOf(output), { ids.begin(), ids.end() }, messages.Error(), messages.Warning() };
}

} // namespace fixtures

#endif
