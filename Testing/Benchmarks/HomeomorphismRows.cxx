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
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

using namespace homeomorphism;

namespace
{

struct System
{
  const char* Name;
  CoordinateSystem Coordinates;
  CubicBending Bending;
};
const std::array<System, 5> systems{ { { "Linear", CoordinateSystem::Linear, {} },
  { "Contour", CoordinateSystem::Contour, {} }, { "Smooth", CoordinateSystem::Smooth, {} },
  { "CubicLocal", CoordinateSystem::Cubic, CubicBending::Local },
  { "CubicLeast", CoordinateSystem::Cubic, CubicBending::Least } } };

/// A homeomorphism that is constructed at its first use, for both directions.
class LazyHomeomorphism
{
public:
  LazyHomeomorphism(const Workload& workload, const System& system)
    : Meshes(workload)
    , Wanted(system)
  {
  }

  const Homeomorphism& Get()
  {
    if (!this->Map)
    {
      HomeomorphismOptions options;
      options.System = this->Wanted.Coordinates;
      options.Cubic.Bending = this->Wanted.Bending;
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
  const System& Wanted;
  std::shared_ptr<const Homeomorphism> Map;
};

/// Maps points one by one, with or without the Jacobians.
template <bool WithJacobian>
void MapPointByPoint(const Homeomorphism& map, Domain from, Task& task)
{
  const double* in = Coordinates(task.In);
  double* out = Coordinates(task.Out);
  const vtkIdType count = task.In->GetNumberOfPoints();
  const double tolerance =
    map.GetAbsoluteTolerance(from, 0.0, 0.5 * std::numeric_limits<double>::epsilon());
  TriangleIndex hint = -1;
  double sum = 0.0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    const SurfacePoint surfacePoint = map.Locate(from, in + 3 * i, tolerance, hint);
    hint = surfacePoint.Triangle;
    if (surfacePoint.Triangle >= 0)
    {
      if constexpr (WithJacobian)
      {
        Jacobian jacobian;
        map.MapPoint(from, surfacePoint, out + 3 * i, jacobian);
        sum += jacobian.Determinant;
      }
      else
      {
        map.MapPoint(from, surfacePoint, out + 3 * i);
      }
    }
  }
  if (!std::isfinite(sum))
  {
    throw std::runtime_error("a Jacobian is not finite");
  }
}

void AddTransform(const Workload& workload, const System& system, Rows& rows)
{
  auto forward = vtkSmartPointer<vtkHomeomorphismTransform>::New();
  forward->SetSource(workload.Source);
  forward->SetTarget(workload.Target);
  forward->SetCoordinateSystem(static_cast<int>(system.Coordinates));
  forward->SetCubicBending(static_cast<int>(system.Bending));
  for (const bool inverse : { false, true })
  {
    vtkSmartPointer<vtkAbstractTransform> transform = forward;
    if (inverse)
    {
      transform = forward->GetInverse();
    }
    Row& row = rows[std::string("transform/") + system.Name + Direction(inverse)];
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

void AddFilter(const Workload& workload, const System& system, Rows& rows)
{
  for (const bool inverse : { false, true })
  {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    auto filter = vtkSmartPointer<vtkDifferentiableHomeomorphism>::New();
    filter->SetSourceData(workload.Source);
    filter->SetTargetData(workload.Target);
    filter->SetDataObject(data);
    filter->SetCoordinateSystem(static_cast<int>(system.Coordinates));
    filter->SetCubicBending(static_cast<int>(system.Bending));
    filter->SetInverse(inverse);
    Row& row = rows[std::string("filter/") + system.Name + Direction(inverse)];
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
  for (const System& system : systems)
  {
    AddTransform(workload, system, rows);
    AddFilter(workload, system, rows);
    auto map = std::make_shared<LazyHomeomorphism>(workload, system);
    for (const bool inverse : { false, true })
    {
      const Domain from = inverse ? Domain::Target : Domain::Source;
      Row& row = rows[std::string("pointwise/") + system.Name + Direction(inverse)];
      row.Before = [map](Task&) { map->Get(); };
      row.Run = [map, from](Task& task) { MapPointByPoint<false>(map->Get(), from, task); };
      Row& jacobianRow = rows[std::string("jacobian/") + system.Name + Direction(inverse)];
      jacobianRow.Before = row.Before;
      jacobianRow.Run = [map, from](Task& task) { MapPointByPoint<true>(map->Get(), from, task); };
    }
  }
}
