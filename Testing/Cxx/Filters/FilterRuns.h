// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FilterRuns.h
/// Helpers for tests of the VTK classes: coordinate systems, pairs of meshes of every kind, random
/// points of a mesh, and small linear algebra.

#ifndef FilterRuns_h
#define FilterRuns_h

#include "TestMeshes.h"

#include "vtkDifferentiableHomeomorphism.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace filter_runs
{

using namespace test_meshes;

constexpr double Ulp = std::numeric_limits<double>::epsilon();

// --- Small linear algebra ------------------------------------------------------------------------

using Matrix = std::array<Point, 3>; // rows

inline Point operator+(const Point& a, const Point& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
}
inline Point operator-(const Point& a, const Point& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}
inline Point operator*(double factor, const Point& a)
{
  return { factor * a[0], factor * a[1], factor * a[2] };
}
inline double Dot(const Point& a, const Point& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point Cross(const Point& a, const Point& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}
inline double Norm(const Point& a)
{
  return std::hypot(a[0], a[1], a[2]);
}
inline Point Unit(const Point& a)
{
  return (1.0 / Norm(a)) * a;
}
inline double Distance(const Point& a, const Point& b)
{
  return Norm(a - b);
}
inline Point operator*(const Matrix& m, const Point& a)
{
  return { Dot(m[0], a), Dot(m[1], a), Dot(m[2], a) };
}
inline Matrix Transposed(const Matrix& m)
{
  Matrix t;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      t[i][j] = m[j][i];
    }
  }
  return t;
}
inline Matrix operator*(const Matrix& a, const Matrix& b)
{
  const Matrix columns = Transposed(b);
  Matrix product;
  for (int i = 0; i < 3; ++i)
  {
    product[i] = { Dot(a[i], columns[0]), Dot(a[i], columns[1]), Dot(a[i], columns[2]) };
  }
  return product;
}
inline double Determinant(const Matrix& m)
{
  return Dot(m[0], Cross(m[1], m[2]));
}
/// By cofactors.
inline Matrix Inverted(const Matrix& m)
{
  const double factor = 1.0 / Determinant(m);
  return Transposed(
    { factor * Cross(m[1], m[2]), factor * Cross(m[2], m[0]), factor * Cross(m[0], m[1]) });
}
/// Frobenius norm.
inline double Norm(const Matrix& m)
{
  return std::hypot(Norm(m[0]), Norm(m[1]), Norm(m[2]));
}
inline double Distance(const Matrix& a, const Matrix& b)
{
  return std::hypot(Distance(a[0], b[0]), Distance(a[1], b[1]), Distance(a[2], b[2]));
}
/// Rotation by an angle about an axis (Rodrigues).
inline Matrix Rotation(const Point& axis, double angle)
{
  const Point n = Unit(axis);
  Matrix m;
  for (int column = 0; column < 3; ++column)
  {
    Point e{};
    e[column] = 1.0;
    const Point turned =
      std::cos(angle) * e + std::sin(angle) * Cross(n, e) + (1.0 - std::cos(angle)) * Dot(n, e) * n;
    for (int row = 0; row < 3; ++row)
    {
      m[row][column] = turned[row];
    }
  }
  return m;
}

// --- Access to VTK objects -----------------------------------------------------------------------

inline Point PointOf(vtkDataSet* data, vtkIdType i)
{
  Point p;
  data->GetPoint(i, p.data());
  return p;
}
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

template <typename Algorithm>
auto HasAbortedKey(int) -> decltype(Algorithm::ABORTED(), bool())
{
  return true;
}
template <typename Algorithm>
bool HasAbortedKey(long)
{
  return false;
}
/// Whether the output of an aborted algorithm is @a whole in size. The executive empties it since
/// VTK 9.3: then false is returned, and checked.
inline bool KeepsAbortedOutput(vtkDataSet* output, vtkIdType whole)
{
  const bool empties = HasAbortedKey<vtkAlgorithm>(0);
  EXPECT_EQ(output->GetNumberOfPoints(), empties ? 0 : whole);
  return !empties && output->GetNumberOfPoints() == whole;
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

inline std::vector<System> AllSystems()
{
  return { Linear, Contour, Incenter, Smooth };
}

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

inline vtkSmartPointer<vtkDifferentiableHomeomorphism> MakeFilter(
  const System& system, const MeshPair& pair, vtkDataObject* data = nullptr)
{
  auto filter = vtkSmartPointer<vtkDifferentiableHomeomorphism>::New();
  SetSystem(filter.Get(), system);
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  if (data)
  {
    filter->SetDataObject(data);
  }
  return filter;
}

/// The output of the filter after an update, as a point set.
inline vtkPointSet* Output(vtkDifferentiableHomeomorphism* filter)
{
  filter->Update();
  return vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
}

// --- Pairs of meshes -----------------------------------------------------------------------------

/// A mesh with every point moved by a function.
template <typename Move>
vtkSmartPointer<vtkPolyData> Moved(vtkPolyData* mesh, Move&& move)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(mesh->GetPoints()->GetDataType());
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    const Point moved = move(PointOf(mesh, i));
    points->InsertNextPoint(moved.data());
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(mesh);
  result->SetPoints(points);
  return result;
}

/// The kinds of pairs: planar (a square and another square, a sheared one with many discordant
/// triangles, and one in a tilted plane), surfaces with boundary, a plane and a surface, and closed
/// surfaces.
struct Pairing
{
  const char* Name;
  MeshPair Meshes;
};

inline Matrix Tilt()
{
  return Rotation({ 1.0, -2.0, 0.7 }, 0.9);
}

inline vtkSmartPointer<vtkPolyData> Tilted(
  vtkPolyData* mesh, const Matrix& rotation, const Point& shift)
{
  return Moved(mesh, [&](const Point& p) { return rotation * p + shift; });
}

inline vtkSmartPointer<vtkPolyData> Sheared(vtkPolyData* mesh)
{
  return Moved(mesh, [](const Point& p) -> Point { return { p[0] + 1.2 * p[1], p[1], p[2] }; });
}

inline std::vector<Pairing> AllPairings(int n, int divisions, std::uint64_t seed)
{
  const MeshPair planar = MakePlanarPair(n, seed);
  const MeshPair closed = MakeClosedPair(divisions, seed + 4);
  return { { "planar", planar }, { "sheared", { planar.Source, Sheared(planar.Target) } },
    { "tilted", { planar.Source, Tilted(planar.Target, Tilt(), { 1.0, 2.0, 3.0 }) } },
    { "sheets", { MakeSheet(n, seed + 2, 0.5), MakeSheet(n, seed + 3, 1.2) } },
    { "plane to sheet", { planar.Source, MakeSheet(n, seed + 3, 1.2) } }, { "closed", closed } };
}

// --- Random points -------------------------------------------------------------------------------

/// Random numbers that follow from the seed on every platform, unlike the distributions of the
/// standard library.
class Random
{
public:
  explicit Random(std::uint64_t seed)
    : Engine(seed)
  {
  }
  /// Uniform in [0, 1).
  double Uniform() { return std::ldexp(static_cast<double>(this->Engine() >> 11), -53); }
  double Uniform(double lower, double upper) { return lower + (upper - lower) * this->Uniform(); }
  vtkIdType Below(vtkIdType count)
  {
    return static_cast<vtkIdType>(this->Engine() % static_cast<std::uint64_t>(count));
  }
  Point Vector() { return { Uniform(-1.0, 1.0), Uniform(-1.0, 1.0), Uniform(-1.0, 1.0) }; }

private:
  std::mt19937_64 Engine;
};

/// A point of a mesh: a triangle and the weights of its three points.
struct MeshPoint
{
  vtkIdType Triangle;
  Point Weights;
};

/// Uniform in the triangle, with all weights at least @a margin.
inline Point RandomWeights(Random& random, double margin = 0.0)
{
  double u = random.Uniform();
  double v = random.Uniform();
  if (u + v > 1.0)
  {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  const double room = 1.0 - 3.0 * margin;
  return { margin + room * u, margin + room * v, margin + room * (1.0 - u - v) };
}

/// Everywhere in the triangles; one in four on an edge, or close to an edge or a vertex at any
/// power of ten down to rounding.
inline std::vector<MeshPoint> RandomSamples(vtkPolyData* mesh, vtkIdType count, std::uint64_t seed)
{
  Random random(seed);
  std::vector<MeshPoint> samples(count);
  for (MeshPoint& surfacePoint : samples)
  {
    surfacePoint.Triangle = random.Below(mesh->GetNumberOfCells());
    surfacePoint.Weights = RandomWeights(random);
    const vtkIdType kind = random.Below(12);
    if (kind < 3)
    {
      const auto k = static_cast<std::size_t>(random.Below(3));
      const double small = kind == 0
        ? 0.0
        : 0.5 * std::pow(10.0, random.Uniform(-17.0, 0.0)) * surfacePoint.Weights[k];
      const double t = random.Uniform();
      const double next = kind == 2 ? small * t : t * (1.0 - small);
      surfacePoint.Weights[k] = small;
      surfacePoint.Weights[(k + 1) % 3] = next;
      surfacePoint.Weights[(k + 2) % 3] = 1.0 - small - next;
    }
  }
  return samples;
}

/// Inside triangles, with all weights at least @a margin.
inline std::vector<MeshPoint> InnerSamples(
  vtkPolyData* mesh, vtkIdType count, std::uint64_t seed, double margin)
{
  Random random(seed);
  std::vector<MeshPoint> samples(count);
  for (MeshPoint& surfacePoint : samples)
  {
    surfacePoint = { random.Below(mesh->GetNumberOfCells()), RandomWeights(random, margin) };
  }
  return samples;
}

inline std::array<Point, 3> CornersOf(vtkPolyData* mesh, vtkIdType triangle)
{
  vtkNew<vtkIdList> ids;
  mesh->GetCellPoints(triangle, ids);
  return { PointOf(mesh, ids->GetId(0)), PointOf(mesh, ids->GetId(1)),
    PointOf(mesh, ids->GetId(2)) };
}

inline Point PositionOf(vtkPolyData* mesh, const MeshPoint& surfacePoint)
{
  const std::array<Point, 3> corners = CornersOf(mesh, surfacePoint.Triangle);
  return surfacePoint.Weights[0] * corners[0] + surfacePoint.Weights[1] * corners[1] +
    surfacePoint.Weights[2] * corners[2];
}

/// Points without cells.
inline vtkSmartPointer<vtkPolyData> MakeCloud(
  const std::vector<Point>& positions, int dataType = VTK_DOUBLE)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(dataType);
  points->SetNumberOfPoints(static_cast<vtkIdType>(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), positions[i].data());
  }
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  cloud->SetPoints(points);
  return cloud;
}

inline vtkSmartPointer<vtkPolyData> MakeCloud(
  vtkPolyData* mesh, const std::vector<MeshPoint>& samples)
{
  std::vector<Point> positions;
  positions.reserve(samples.size());
  for (const MeshPoint& surfacePoint : samples)
  {
    positions.push_back(PositionOf(mesh, surfacePoint));
  }
  return MakeCloud(positions);
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

/// The largest of many errors divided by their bounds.
class Worst
{
public:
  void Take(double error, double bound)
  {
    // Negated so that NaN is the largest.
    if (!(error / bound <= this->OverBound))
    {
      this->OverBound = std::isnan(error) ? std::numeric_limits<double>::infinity() : error / bound;
    }
    if (!(error <= this->Error))
    {
      this->Error = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
    }
  }
  double OverBound = 0.0;
  double Error = 0.0;
};

} // namespace filter_runs

#endif
