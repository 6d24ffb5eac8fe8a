// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Meshes.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace
{

double Cross(const Point& a, const Point& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

bool IsInside(const Curve& triangle, const Point& point)
{
  int left = 0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Point& a = triangle[k];
    const Point& b = triangle[(k + 1) % 3];
    left += Cross(Subtract(b, a), Subtract(point, a)) > 0.0 ? 1 : 0;
  }
  return left == 0 || left == 3;
}

} // namespace

const std::array<std::string, 3> systemNames{ "Linear", "Contour", "Smooth" };

vtkSmartPointer<vtkPolyData> MakeMesh(
  const Curve& points, const std::vector<TriangleIds>& triangles)
{
  vtkNew<vtkPoints> vertices;
  vertices->SetDataTypeToDouble();
  for (const Point& point : points)
  {
    vertices->InsertNextPoint(point[0], point[1], 0.0);
  }
  vtkNew<vtkCellArray> cells;
  for (const TriangleIds& triangle : triangles)
  {
    cells->InsertNextCell(3, triangle.data());
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(vertices);
  mesh->SetPolys(cells);
  return mesh;
}

Curve GetTriangle(vtkPolyData* mesh, vtkIdType triangle)
{
  vtkNew<vtkIdList> ids;
  mesh->GetPolys()->GetCellAtId(triangle, ids);
  Curve corners;
  for (vtkIdType k = 0; k < 3; ++k)
  {
    double point[3];
    mesh->GetPoint(ids->GetId(k), point);
    corners.push_back({ point[0], point[1] });
  }
  return corners;
}

vtkSmartPointer<vtkTriangularCoordinates> MakeCoordinates(
  vtkPolyData* mesh, int coordinateSystem, int contours, int rings, int centerPoint)
{
  auto coordinates = vtkSmartPointer<vtkTriangularCoordinates>::New();
  coordinates->SetInputData(mesh);
  coordinates->SetCoordinateSystem(coordinateSystem);
  coordinates->SetCenterPoint(centerPoint);
  coordinates->SetDiscordantTriangles(vtkTriangularCoordinates::USE_LINEAR);
  coordinates->SetNumberOfContours(contours);
  coordinates->SetNumberOfRings(rings);
  coordinates->SetLineResolution(64);
  coordinates->Update();
  if (coordinates->GetErrorCode() != 0)
  {
    throw std::runtime_error("The triangulation was refused.");
  }
  return coordinates;
}

vtkSmartPointer<vtkPolyData> SelectLines(
  vtkTriangularCoordinates* coordinates, int lineType, vtkIdType triangle)
{
  vtkPolyData* const lines = coordinates->GetLines();
  vtkDataArray* const types = lines->GetCellData()->GetArray("LineType");
  vtkDataArray* const triangles = lines->GetCellData()->GetArray("TriangleId");
  vtkNew<vtkCellArray> selected;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < lines->GetNumberOfCells(); ++cell)
  {
    const bool wanted =
      triangle < 0 || static_cast<vtkIdType>(triangles->GetTuple1(cell)) == triangle;
    if (wanted && static_cast<int>(types->GetTuple1(cell)) == lineType)
    {
      lines->GetCellPoints(cell, ids);
      selected->InsertNextCell(ids);
    }
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(lines->GetPoints());
  result->SetLines(selected);
  return result;
}

bool IsConcordant(vtkTriangularCoordinates* coordinates, vtkIdType triangle)
{
  vtkDataArray* const concordant =
    coordinates->GetTriangulation()->GetCellData()->GetArray("Concordant");
  return concordant->GetTuple1(triangle) != 0.0;
}

vtkSmartPointer<vtkHomeomorphismTransform> MakeMap(
  vtkPolyData* source, vtkPolyData* target, int coordinateSystem)
{
  auto map = vtkSmartPointer<vtkHomeomorphismTransform>::New();
  map->SetSource(source);
  map->SetTarget(target);
  map->SetCoordinateSystem(coordinateSystem);
  // A refused pair has no points inside.
  const Curve triangle = GetTriangle(source, 0);
  const Point mean = Between(triangle[0], Between(triangle[1], triangle[2], 0.5), 2.0 / 3.0);
  const double point[3] = { mean[0], mean[1], 0.0 };
  if (!map->IsInside(point))
  {
    throw std::runtime_error("The pair of triangulations was refused.");
  }
  return map;
}

Curve MapCurve(vtkHomeomorphismTransform* map, const Curve& curve)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Point& point : curve)
  {
    points->InsertNextPoint(point[0], point[1], 0.0);
  }
  vtkNew<vtkPoints> images;
  images->SetDataTypeToDouble();
  map->TransformPoints(points, images);
  Curve result;
  for (vtkIdType i = 0; i < images->GetNumberOfPoints(); ++i)
  {
    double image[3];
    images->GetPoint(i, image);
    if (image[0] == map->GetOutsideCoordinate())
    {
      throw std::runtime_error("A point of a curve is outside the triangulation.");
    }
    result.push_back({ image[0], image[1] });
  }
  return result;
}

Curve Divide(const Point& from, const Point& to, int pieces)
{
  Curve curve;
  for (int k = 0; k <= pieces; ++k)
  {
    curve.push_back(Between(from, to, static_cast<double>(k) / pieces));
  }
  return curve;
}

std::vector<Curve> BoundaryEdges(vtkPolyData* mesh)
{
  std::map<std::pair<vtkIdType, vtkIdType>, int> uses;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < mesh->GetPolys()->GetNumberOfCells(); ++cell)
  {
    mesh->GetPolys()->GetCellAtId(cell, ids);
    for (vtkIdType k = 0; k < 3; ++k)
    {
      ++uses[std::minmax({ ids->GetId(k), ids->GetId((k + 1) % 3) })];
    }
  }
  std::vector<Curve> edges;
  for (const auto& [ends, count] : uses)
  {
    if (count == 1)
    {
      double a[3];
      double b[3];
      mesh->GetPoint(ends.first, a);
      mesh->GetPoint(ends.second, b);
      edges.push_back({ { a[0], a[1] }, { b[0], b[1] } });
    }
  }
  return edges;
}

std::vector<Curve> CrossMesh(vtkPolyData* mesh, const Point& from, const Point& to)
{
  const Point along = Subtract(to, from);
  std::vector<Curve> triangles;
  std::vector<double> crossings;
  for (vtkIdType cell = 0; cell < mesh->GetPolys()->GetNumberOfCells(); ++cell)
  {
    const Curve triangle = GetTriangle(mesh, cell);
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Point& a = triangle[k];
      const Point edge = Subtract(triangle[(k + 1) % 3], a);
      const double denominator = Cross(along, edge);
      if (denominator != 0.0)
      {
        const double onLine = Cross(Subtract(a, from), edge) / denominator;
        const double onEdge = Cross(Subtract(a, from), along) / denominator;
        if (onLine >= 0.0 && onLine <= 1.0 && onEdge >= 0.0 && onEdge <= 1.0)
        {
          crossings.push_back(onLine);
        }
      }
    }
    triangles.push_back(triangle);
  }
  std::sort(crossings.begin(), crossings.end());
  // Each edge inside was found from both of its triangles.
  const auto same = [](double a, double b) { return b - a < 1e-9; };
  crossings.erase(std::unique(crossings.begin(), crossings.end(), same), crossings.end());

  std::vector<Curve> pieces;
  bool inside = false;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i)
  {
    const Point middle = Between(from, to, 0.5 * (crossings[i] + crossings[i + 1]));
    const bool wasInside = inside;
    inside = std::any_of(triangles.begin(), triangles.end(),
      [&middle](const Curve& triangle) { return IsInside(triangle, middle); });
    if (inside)
    {
      if (!wasInside)
      {
        pieces.push_back({ Between(from, to, crossings[i]) });
      }
      pieces.back().push_back(Between(from, to, crossings[i + 1]));
    }
  }
  return pieces;
}
