// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Workload.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace
{

/// A file of numbers as an array of three components.
template <typename Array>
vtkSmartPointer<Array> ReadArray(const std::filesystem::path& path)
{
  using Value = typename Array::ValueType;
  const auto tuples =
    static_cast<vtkIdType>(std::filesystem::file_size(path) / (3 * sizeof(Value)));
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(tuples);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(array->GetPointer(0)),
    static_cast<std::streamsize>(3 * sizeof(Value)) * tuples);
  if (!file)
  {
    throw std::runtime_error("cannot read " + path.string());
  }
  return array;
}

vtkSmartPointer<vtkPoints> ReadPoints(const std::filesystem::path& path)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(ReadArray<vtkDoubleArray>(path));
  return points;
}

vtkSmartPointer<vtkPolyData> ReadMesh(
  const std::filesystem::path& points, const std::filesystem::path& triangles)
{
  // An array with one component, as connectivity is stored.
  auto ids = ReadArray<vtkIdTypeArray>(triangles);
  ids->SetNumberOfComponents(1);
  vtkNew<vtkCellArray> cells;
  cells->SetData(3, ids);
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(ReadPoints(points));
  mesh->SetPolys(cells);
  return mesh;
}

} // namespace

Workload::Workload(const std::string& folder)
  : Folder(folder)
{
  const std::filesystem::path path(folder);
  this->Source = ReadMesh(path / "source.f64", path / "triangles.i64");
  this->Target = ReadMesh(path / "target.f64", path / "triangles.i64");
  const std::string prefix = "points-";
  for (const auto& entry : std::filesystem::directory_iterator(path))
  {
    const std::string stem = entry.path().stem().string();
    if (stem.compare(0, prefix.size(), prefix) == 0)
    {
      this->Points[stem.substr(prefix.size())] = ReadPoints(entry.path());
    }
  }
  if (std::filesystem::exists(path / "image.u8"))
  {
    const auto pixels = ReadArray<vtkUnsignedCharArray>(path / "image.u8");
    const int size = static_cast<int>(std::lround(std::sqrt(pixels->GetNumberOfTuples())));
    this->Image = vtkSmartPointer<vtkImageData>::New();
    this->Image->SetDimensions(size, size, 1);
    pixels->SetName("Color");
    this->Image->GetPointData()->SetScalars(pixels);
  }
}

std::vector<Affine> TriangleMaps(vtkPolyData* from, vtkPolyData* to)
{
  std::vector<Affine> maps;
  maps.reserve(static_cast<std::size_t>(from->GetNumberOfCells()));
  vtkCellArray* triangles = from->GetPolys();
  for (vtkIdType t = 0; t < triangles->GetNumberOfCells(); ++t)
  {
    vtkIdType count;
    const vtkIdType* corners;
    triangles->GetCellAtId(t, count, corners);
    double p[3][3];
    double q[3][3];
    for (int i = 0; i < 3; ++i)
    {
      from->GetPoint(corners[i], p[i]);
      to->GetPoint(corners[i], q[i]);
    }
    const double ux = p[1][0] - p[0][0];
    const double uy = p[1][1] - p[0][1];
    const double vx = p[2][0] - p[0][0];
    const double vy = p[2][1] - p[0][1];
    const double area = ux * vy - uy * vx;
    Affine map;
    for (int i = 0; i < 2; ++i)
    {
      const double alongU = q[1][i] - q[0][i];
      const double alongV = q[2][i] - q[0][i];
      double* row = &map[3 * static_cast<std::size_t>(i)];
      row[0] = (alongU * vy - alongV * uy) / area;
      row[1] = (alongV * ux - alongU * vx) / area;
      row[2] = q[0][i] - row[0] * p[0][0] - row[1] * p[0][1];
    }
    maps.push_back(map);
  }
  return maps;
}
