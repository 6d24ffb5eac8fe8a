// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "XmorphMesh.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace
{

/// The most columns or rows of a mesh: far more than anybody lays by hand, and their product is an
/// int.
constexpr int MaximumSide = 10000;

} // namespace

XmorphMesh ReadXmorphMesh(const std::string& fileName)
{
  std::ifstream file(fileName);
  if (!file)
  {
    throw std::runtime_error("Cannot open " + fileName + ".");
  }
  return ReadXmorphMesh(file, fileName);
}

XmorphMesh ReadXmorphMesh(std::istream& file, const std::string& fileName)
{
  int number = 0;
  const auto nextLine = [&]() {
    std::string line;
    std::getline(file, line);
    ++number;
    return std::istringstream(line);
  };
  const auto fail = [&](const std::string& expected) {
    throw std::runtime_error(
      fileName + ", line " + std::to_string(number) + ": expected " + expected + ".");
  };

  std::string magic;
  nextLine() >> magic;
  if (magic != "M2")
  {
    fail("\"M2\", the first line of an xmorph mesh");
  }
  XmorphMesh mesh;
  if (!(nextLine() >> mesh.Columns >> mesh.Rows) || mesh.Columns < 2 || mesh.Rows < 2 ||
    mesh.Columns > MaximumSide || mesh.Rows > MaximumSide)
  {
    fail("the numbers of columns and rows, 2 to " + std::to_string(MaximumSide));
  }
  for (int i = 0; i < mesh.Columns * mesh.Rows; ++i)
  {
    std::array<double, 2> point;
    if (!(nextLine() >> point[0] >> point[1]))
    {
      fail("x and y of point " + std::to_string(i));
    }
    mesh.Points.push_back(point);
  }
  return mesh;
}

std::array<double, 2> GetExtent(const XmorphMesh& mesh)
{
  std::array<double, 2> extent{ 0.0, 0.0 };
  for (const auto& point : mesh.Points)
  {
    extent = { std::max(extent[0], point[0]), std::max(extent[1], point[1]) };
  }
  return extent;
}

bool FillsPicture(const XmorphMesh& mesh)
{
  const std::array<double, 2> extent = GetExtent(mesh);
  // A pixel of xmorph's working picture, laid by hand, is near enough.
  const auto is = [&mesh, &extent](int column, int row, std::size_t axis, double value) {
    const auto& point = mesh.Points[static_cast<std::size_t>(row * mesh.Columns + column)];
    return std::abs(point[axis] - value) <= 0.005 * extent[axis];
  };
  bool fills = true;
  for (int column = 0; column < mesh.Columns; ++column)
  {
    fills = fills && is(column, 0, 1, 0.0) && is(column, mesh.Rows - 1, 1, extent[1]);
  }
  for (int row = 0; row < mesh.Rows; ++row)
  {
    fills = fills && is(0, row, 0, 0.0) && is(mesh.Columns - 1, row, 0, extent[0]);
  }
  return fills;
}

void TurnUpright(XmorphMesh& mesh, double bottom)
{
  for (auto& point : mesh.Points)
  {
    point[1] = bottom - point[1];
  }
}

void FitToPicture(XmorphMesh& mesh, int width, int height)
{
  const auto [right, bottom] = GetExtent(mesh);
  if (!(right > 0.0 && bottom > 0.0))
  {
    throw std::runtime_error(
      "The mesh has no extent: all of its points are at the picture's top left.");
  }
  for (auto& point : mesh.Points)
  {
    point[0] *= (width - 1) / right;
    point[1] = (height - 1) * (1.0 - point[1] / bottom);
  }
}

namespace
{

double SmallestAngle(const XmorphMesh& mesh, const std::array<vtkIdType, 3>& triangle)
{
  double smallest = 4.0;
  for (int k = 0; k < 3; ++k)
  {
    const auto& a = mesh.Points[triangle[k]];
    const auto& b = mesh.Points[triangle[(k + 1) % 3]];
    const auto& c = mesh.Points[triangle[(k + 2) % 3]];
    const double ux = b[0] - a[0];
    const double uy = b[1] - a[1];
    const double vx = c[0] - a[0];
    const double vy = c[1] - a[1];
    // Negative for a triangle turned over, which is worse than any angle.
    smallest = std::min(smallest, std::atan2(vx * uy - vy * ux, ux * vx + uy * vy));
  }
  return smallest;
}

} // namespace

std::array<vtkSmartPointer<vtkPolyData>, 2> CutIntoTriangles(
  const XmorphMesh& first, const XmorphMesh& second)
{
  if (first.Columns != second.Columns || first.Rows != second.Rows)
  {
    throw std::runtime_error("The two meshes do not have the same numbers of columns and rows.");
  }
  vtkNew<vtkCellArray> cells;
  for (vtkIdType row = 0; row + 1 < first.Rows; ++row)
  {
    for (vtkIdType column = 0; column + 1 < first.Columns; ++column)
    {
      const vtkIdType a = row * first.Columns + column;
      const vtkIdType b = a + 1;
      const vtkIdType c = b + first.Columns;
      const vtkIdType d = a + first.Columns;
      using Cut = std::array<std::array<vtkIdType, 3>, 2>;
      const Cut alongAC{ { { a, b, c }, { a, c, d } } };
      const Cut alongBD{ { { a, b, d }, { b, c, d } } };
      const auto quality = [&](const Cut& cut) {
        return std::min({ SmallestAngle(first, cut[0]), SmallestAngle(first, cut[1]),
          SmallestAngle(second, cut[0]), SmallestAngle(second, cut[1]) });
      };
      for (const auto& triangle : quality(alongAC) >= quality(alongBD) ? alongAC : alongBD)
      {
        cells->InsertNextCell(3, triangle.data());
      }
    }
  }
  std::array<vtkSmartPointer<vtkPolyData>, 2> meshes;
  for (int side = 0; side < 2; ++side)
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const auto& point : (side == 0 ? first : second).Points)
    {
      points->InsertNextPoint(point[0], point[1], 0.0);
    }
    meshes[side] = vtkSmartPointer<vtkPolyData>::New();
    meshes[side]->SetPoints(points);
    meshes[side]->SetPolys(cells);
  }
  return meshes;
}
