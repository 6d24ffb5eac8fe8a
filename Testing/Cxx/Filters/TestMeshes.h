// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TestMeshes.h
/// Pairs of triangulations, and a collector of messages of algorithms.

#ifndef TestMeshes_h
#define TestMeshes_h

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkExecutive.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTestErrorObserver.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace test_meshes
{

using Point = std::array<double, 3>;
using Triangle = std::array<vtkIdType, 3>;

struct MeshPair
{
  vtkSmartPointer<vtkPolyData> Source;
  vtkSmartPointer<vtkPolyData> Target;
};

inline vtkSmartPointer<vtkPolyData> MakeMesh(
  const std::vector<Point>& points, const std::vector<Triangle>& triangles)
{
  vtkNew<vtkPoints> meshPoints;
  meshPoints->SetDataTypeToDouble();
  for (const Point& point : points)
  {
    meshPoints->InsertNextPoint(point.data());
  }
  vtkNew<vtkCellArray> cells;
  for (const Triangle& triangle : triangles)
  {
    cells->InsertNextCell(3, triangle.data());
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(meshPoints);
  mesh->SetPolys(cells);
  return mesh;
}

/// The triangles of a grid of n x n unit squares whose points are numbered row by row.
inline std::vector<Triangle> GridTriangles(int n)
{
  std::vector<Triangle> triangles;
  for (vtkIdType j = 0; j < n; ++j)
  {
    for (vtkIdType i = 0; i < n; ++i)
    {
      const vtkIdType a = j * (n + 1) + i;
      const vtkIdType c = a + n + 1;
      triangles.push_back({ a, a + 1, c + 1 });
      triangles.push_back({ a, c + 1, c });
    }
  }
  return triangles;
}

/// The points of that grid. Interior points are moved at random by up to jitter (at most 0.25 keeps
/// the orientation of all triangles). The boundary is the square [0, n] x [0, n].
inline std::vector<Point> GridPoints(int n, std::uint64_t seed, double jitter)
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> offset(-jitter, jitter);
  std::vector<Point> points;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      const bool inside = i > 0 && i < n && j > 0 && j < n;
      const double dx = offset(generator);
      const double dy = offset(generator);
      points.push_back({ i + (inside ? dx : 0.0), j + (inside ? dy : 0.0), 0.0 });
    }
  }
  return points;
}

/// That grid with unmoved points.
inline vtkSmartPointer<vtkPolyData> RegularGrid(int n)
{
  return MakeMesh(GridPoints(n, 0, 0.0), GridTriangles(n));
}

/// Two different triangulations of the square [0, n] x [0, n] with the same triangles.
inline MeshPair MakePlanarPair(int n, std::uint64_t seed, double jitter = 0.25)
{
  return { MakeMesh(GridPoints(n, seed, jitter), GridTriangles(n)),
    MakeMesh(GridPoints(n, seed + 1, jitter), GridTriangles(n)) };
}

/// A surface over that square with waves of height @a wave.
inline vtkSmartPointer<vtkPolyData> MakeSheet(int n, std::uint64_t seed, double wave)
{
  std::vector<Point> points = GridPoints(n, seed, 0.25);
  for (Point& p : points)
  {
    p[2] = wave * std::sin(0.7 * p[0] + 0.3) * std::cos(0.5 * p[1]);
  }
  return MakeMesh(points, GridTriangles(n));
}

/// Two different closed surfaces: an octahedron subdivided @a divisions times, with its points on
/// two ellipsoids and moved at random along them.
inline MeshPair MakeClosedPair(int divisions, std::uint64_t seed)
{
  std::vector<Point> points{ { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 1 },
    { 0, 0, -1 } };
  std::vector<Triangle> triangles{ { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 }, { 1, 0, 5 },
    { 2, 1, 5 }, { 3, 2, 5 }, { 0, 3, 5 } };
  for (int division = 0; division < divisions; ++division)
  {
    std::map<std::pair<vtkIdType, vtkIdType>, vtkIdType> middles;
    const auto middle = [&](vtkIdType a, vtkIdType b) {
      const auto key = std::minmax(a, b);
      const auto found = middles.find(key);
      if (found != middles.end())
      {
        return found->second;
      }
      Point p;
      for (int k = 0; k < 3; ++k)
      {
        p[k] = 0.5 * (points[a][k] + points[b][k]);
      }
      points.push_back(p);
      return middles[key] = static_cast<vtkIdType>(points.size()) - 1;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : triangles)
    {
      const vtkIdType ab = middle(t[0], t[1]);
      const vtkIdType bc = middle(t[1], t[2]);
      const vtkIdType ca = middle(t[2], t[0]);
      finer.insert(
        finer.end(), { { t[0], ab, ca }, { ab, t[1], bc }, { ca, bc, t[2] }, { ab, bc, ca } });
    }
    triangles = finer;
  }
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> offset(-0.2, 0.2);
  const double spacing = std::pow(0.5, divisions);
  const auto surfacePoint = [&](const Point& axes) {
    std::vector<Point> moved = points;
    for (Point& p : moved)
    {
      for (double& x : p)
      {
        x += spacing * offset(generator);
      }
      const double length = std::hypot(p[0], p[1], p[2]);
      for (int k = 0; k < 3; ++k)
      {
        p[k] *= axes[k] / length;
      }
    }
    return MakeMesh(moved, triangles);
  };
  const auto source = surfacePoint({ 1.0, 1.0, 1.0 });
  const auto target = surfacePoint({ 2.0, 1.2, 0.7 });
  return { source, target };
}

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

} // namespace test_meshes

#endif
