// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file BoundRows.cxx
/// Lower bounds for the time of any map of points, and of any piecewise map.

#include "Rows.h"
#include "Workload.h"

#include "vtkGenericCell.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkStaticCellLocator.h"

#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <vector>

namespace
{

/// The known triangles of the points.
struct KnownTriangles
{
  std::vector<Affine> Maps;
  std::map<vtkPoints*, std::vector<std::int32_t>> Triangles;
};

std::vector<std::int32_t> FindTriangles(vtkPolyData* mesh, vtkPoints* points)
{
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(mesh);
  locator->BuildLocator();
  vtkNew<vtkGenericCell> cell;
  std::vector<std::int32_t> triangles;
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double point[3];
    points->GetPoint(i, point);
    double parametric[3];
    double weights[3];
    const vtkIdType found = locator->FindCell(point, 0.0, cell, parametric, weights);
    if (found < 0)
    {
      throw std::runtime_error("a point is in no triangle");
    }
    triangles.push_back(static_cast<std::int32_t>(found));
  }
  return triangles;
}

} // namespace

void AddBoundRows(const Workload& workload, Rows& rows)
{
  rows["copy"].Run = [](Task& task) {
    std::memcpy(Coordinates(task.Out), Coordinates(task.In),
      3 * sizeof(double) * static_cast<std::size_t>(task.In->GetNumberOfPoints()));
  };
  for (const bool inverse : { false, true })
  {
    auto known = std::make_shared<KnownTriangles>();
    Row& row = rows["affine" + Direction(inverse)];
    row.Before = [known, &workload, inverse](Task& task) {
      if (known->Maps.empty())
      {
        known->Maps = TriangleMaps(workload.GetFrom(inverse), workload.GetTo(inverse));
      }
      std::vector<std::int32_t>& triangles = known->Triangles[task.In];
      if (triangles.empty())
      {
        triangles = FindTriangles(workload.GetFrom(inverse), task.In);
      }
    };
    row.Run = [known](Task& task) {
      const double* in = Coordinates(task.In);
      double* out = Coordinates(task.Out);
      const Affine* maps = known->Maps.data();
      for (const std::int32_t triangle : known->Triangles[task.In])
      {
        Apply(maps[triangle], in, out);
        in += 3;
        out += 3;
      }
    };
  }
}
