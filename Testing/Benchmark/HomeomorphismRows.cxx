// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file HomeomorphismRows.cxx
/// This module's ways of mapping points: the batch call of the transform, the filter, and point by
/// point in plain arrays.

#include "Rows.h"
#include "Workload.h"

#include "Mesh/Homeomorphism.h"

#include "vtkDifferentiableHomeomorphism.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"

#include <array>
#include <limits>
#include <memory>
#include <stdexcept>

using namespace homeomorphism;

namespace
{

const std::array<const char*, 3> systemNames{ "Linear", "Contour", "Smooth" };
const std::array<CoordinateSystem, 3> systems{ CoordinateSystem::Linear, CoordinateSystem::Contour,
  CoordinateSystem::Smooth };

/// Made at first use, for both directions.
class LazyHomeomorphism
{
public:
  LazyHomeomorphism(const Workload& workload, CoordinateSystem system)
    : Meshes(workload)
    , System(system)
  {
  }

  const Homeomorphism& Get()
  {
    if (!this->Map)
    {
      HomeomorphismOptions options;
      options.System = this->System;
      MeshDiagnostics problems;
      this->Map = Homeomorphism::Make(this->Meshes.Source, this->Meshes.Target, options, problems);
      if (!this->Map)
      {
        throw std::runtime_error("the meshes are refused");
      }
    }
    return *this->Map;
  }

private:
  const Workload& Meshes;
  CoordinateSystem System;
  std::shared_ptr<const Homeomorphism> Map;
};

void MapPointByPoint(const Homeomorphism& map, Domain from, Task& task)
{
  const double* in = Coordinates(task.In);
  double* out = Coordinates(task.Out);
  const vtkIdType count = task.In->GetNumberOfPoints();
  const double tolerance =
    map.GetAbsoluteTolerance(from, 0.0, 0.5 * std::numeric_limits<double>::epsilon());
  TriangleIndex hint = -1;
  for (vtkIdType i = 0; i < count; ++i)
  {
    const SurfacePoint surfacePoint = map.Locate(from, in + 3 * i, tolerance, hint);
    hint = surfacePoint.Triangle;
    if (surfacePoint.Triangle >= 0)
    {
      map.MapPoint(from, surfacePoint, out + 3 * i);
    }
  }
}

void AddTransform(const Workload& workload, int system, Rows& rows)
{
  auto forward = vtkSmartPointer<vtkHomeomorphismTransform>::New();
  forward->SetSource(workload.Source);
  forward->SetTarget(workload.Target);
  forward->SetCoordinateSystem(system);
  for (const bool inverse : { false, true })
  {
    vtkSmartPointer<vtkAbstractTransform> transform = forward;
    if (inverse)
    {
      transform = forward->GetInverse();
    }
    Row& row = rows[std::string("transform/") + systemNames[system] + Direction(inverse)];
    row.Before = [forward, transform](Task& task) {
      // An updated transform shares its prepared map with its inverse.
      forward->Update();
      transform->Update();
      // VTK appends to existing points.
      task.Out->Reset();
    };
    row.Run = [transform](Task& task) { transform->TransformPoints(task.In, task.Out); };
  }
}

void AddFilter(const Workload& workload, int system, Rows& rows)
{
  for (const bool inverse : { false, true })
  {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    auto filter = vtkSmartPointer<vtkDifferentiableHomeomorphism>::New();
    filter->SetSourceData(workload.Source);
    filter->SetTargetData(workload.Target);
    filter->SetDataObject(data);
    filter->SetCoordinateSystem(system);
    filter->SetInverse(inverse);
    Row& row = rows[std::string("filter/") + systemNames[system] + Direction(inverse)];
    row.Before = [data, filter](Task& task) {
      if (filter->GetNumberOfMeshBuilds() == 0)
      {
        filter->Update();
      }
      data->SetPoints(task.In);
      data->Modified();
    };
    row.Run = [filter](Task&) { filter->Update(); };
    row.After = [filter](Task& task) {
      task.Result =
        vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0))->GetPoints()->GetData();
    };
  }
}

} // namespace

void AddHomeomorphismRows(const Workload& workload, Rows& rows)
{
  for (int system = 0; system < 3; ++system)
  {
    AddTransform(workload, system, rows);
    AddFilter(workload, system, rows);
    auto map = std::make_shared<LazyHomeomorphism>(workload, systems[system]);
    for (const bool inverse : { false, true })
    {
      const Domain from = inverse ? Domain::Target : Domain::Source;
      Row& row = rows[std::string("pointwise/") + systemNames[system] + Direction(inverse)];
      row.Before = [map](Task&) { map->Get(); };
      row.Run = [map, from](Task& task) { MapPointByPoint(map->Get(), from, task); };
    }
  }
}
