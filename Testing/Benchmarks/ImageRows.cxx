// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ImageRows.cxx
/// Warping an image: each pixel of the output, over the source mesh, gets the value of the input at
/// its image, over the target mesh.

#include "Rows.h"
#include "Workload.h"

#include "vtkHomeomorphismTransform.h"
#include "vtkImageData.h"
#include "vtkImageReslice.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkResampleThroughHomeomorphism.h"
#include "vtkThinPlateSplineTransform.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

namespace
{

struct NamedSystem
{
  const char* Name;
  int System;
};

const std::array<NamedSystem, 4> systems{ { { "Linear", vtkHomeomorphismTransform::LINEAR },
  { "Contour", vtkHomeomorphismTransform::CONTOUR },
  { "Smooth", vtkHomeomorphismTransform::SMOOTH },
  { "CubicLeast", vtkHomeomorphismTransform::CUBIC } } };
constexpr vtkIdType numberOfLandmarks = 200;

void AddReslice(
  const Workload& workload, const std::string& name, vtkAbstractTransform* transform, Rows& rows)
{
  auto reslice = vtkSmartPointer<vtkImageReslice>::New();
  reslice->SetInputData(workload.Image);
  reslice->SetResliceTransform(transform);
  reslice->SetInterpolationModeToLinear();
  Row& row = rows["reslice/" + name];
  row.Before = [reslice, held = vtkSmartPointer<vtkAbstractTransform>(transform)](Task& task) {
    held->Update();
    reslice->SetNumberOfThreads(task.Threads);
    reslice->Modified();
  };
  row.Run = [reslice](Task&) { reslice->Update(); };
  row.After = [reslice](
                Task& task) { task.Result = reslice->GetOutput()->GetPointData()->GetScalars(); };
}

vtkSmartPointer<vtkThinPlateSplineTransform> MakeSpline(const Workload& workload)
{
  std::vector<vtkIdType> ids(static_cast<std::size_t>(workload.Source->GetNumberOfPoints()));
  std::iota(ids.begin(), ids.end(), 0);
  std::shuffle(ids.begin(), ids.end(), std::mt19937_64(1));
  vtkNew<vtkPoints> landmarks[2];
  for (vtkIdType i = 0;
       i < std::min<vtkIdType>(numberOfLandmarks, static_cast<vtkIdType>(ids.size())); ++i)
  {
    landmarks[0]->InsertNextPoint(workload.Source->GetPoint(ids[static_cast<std::size_t>(i)]));
    landmarks[1]->InsertNextPoint(workload.Target->GetPoint(ids[static_cast<std::size_t>(i)]));
  }
  auto spline = vtkSmartPointer<vtkThinPlateSplineTransform>::New();
  spline->SetBasisToR2LogR();
  spline->SetSourceLandmarks(landmarks[0]);
  spline->SetTargetLandmarks(landmarks[1]);
  return spline;
}

} // namespace

void AddImageRows(const Workload& workload, Rows& rows)
{
  for (const NamedSystem& system : systems)
  {
    // The meshes are exchanged, because the inverse of Cubic is not the map from the target mesh to
    // the source mesh.
    vtkNew<vtkHomeomorphismTransform> transform;
    transform->SetSource(workload.Target);
    transform->SetTarget(workload.Source);
    transform->SetCoordinateSystem(system.System);
    AddReslice(workload, system.Name, transform->GetInverse(), rows);

    // Here the target mesh covers the data, and the source mesh covers the grid.
    auto grid = vtkSmartPointer<vtkImageData>::New();
    grid->CopyStructure(workload.Image);
    auto resample = vtkSmartPointer<vtkResampleThroughHomeomorphism>::New();
    resample->SetSourceData(workload.Target);
    resample->SetTargetData(workload.Source);
    resample->SetDataObject(workload.Image);
    resample->SetGridData(grid);
    resample->SetCoordinateSystem(system.System);
    Row& row = rows[std::string("resample/") + system.Name];
    row.Before = [grid](Task&) { grid->Modified(); };
    row.Run = [resample](Task&) { resample->Update(); };
    row.After = [resample](Task& task) {
      task.Result = resample->GetOutput()->GetPointData()->GetArray("Color");
    };
  }
  AddReslice(workload, "ThinPlateSpline", MakeSpline(workload), rows);
}
