// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MappedPoints.h
/// Images of a list of points under vtkDifferentiableHomeomorphism, and modifications of the meshes
/// of TestMeshes.h.

#ifndef MappedPoints_h
#define MappedPoints_h

#include "TestMeshes.h"

#include "vtkDifferentiableHomeomorphism.h"

#include "vtkDataArray.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace test_meshes
{

inline std::vector<Point> PointsOf(vtkPolyData* mesh)
{
  std::vector<Point> points(mesh->GetNumberOfPoints());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh->GetPoint(static_cast<vtkIdType>(i), points[i].data());
  }
  return points;
}

inline void MovePoint(vtkPolyData* mesh, vtkIdType id, const Point& surfacePoint)
{
  mesh->GetPoints()->SetPoint(id, surfacePoint.data());
  mesh->GetPoints()->Modified();
}

/// The point with these barycentric weights in a triangle.
inline Point PointIn(vtkPolyData* mesh, const Triangle& triangle, const Point& weights)
{
  const std::vector<Point> points = PointsOf(mesh);
  Point result{};
  for (int k = 0; k < 3; ++k)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      result[axis] += weights[k] * points[triangle[k]][axis];
    }
  }
  return result;
}

inline Point CentroidOf(vtkPolyData* mesh, const Triangle& triangle)
{
  return PointIn(mesh, triangle, { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 });
}

inline double DistanceOf(const Point& a, const Point& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// A vtkPolyData with points only.
inline vtkSmartPointer<vtkPolyData> MakeCloud(const std::vector<Point>& points)
{
  return MakeMesh(points, {});
}

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

/// Some points in every triangle of a mesh.
inline std::vector<Point> SamplePoints(
  vtkPolyData* mesh, const std::vector<Triangle>& triangles, int perTriangle, std::uint64_t seed)
{
  std::mt19937_64 generator(seed);
  std::exponential_distribution<double> weight;
  const std::vector<Point> corners = PointsOf(mesh);
  std::vector<Point> points;
  for (const Triangle& triangle : triangles)
  {
    for (int n = 0; n < perTriangle; ++n)
    {
      Point w{ weight(generator), weight(generator), weight(generator) };
      const double sum = w[0] + w[1] + w[2];
      Point point{};
      for (int k = 0; k < 3; ++k)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          point[axis] += w[k] / sum * corners[triangle[k]][axis];
        }
      }
      points.push_back(point);
    }
  }
  return points;
}

} // namespace test_meshes

#endif
