// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ConstructionRows.cxx
/// Time and memory of preparation.

#include "Rows.h"
#include "Workload.h"

#include "Mesh/Homeomorphism.h"

#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkStaticCellLocator.h"

#include <malloc.h>

#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

using namespace homeomorphism;

namespace
{

double Allocated()
{
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/// A line of /proc/self/status, in bytes.
double Status(const std::string& name)
{
  std::ifstream file("/proc/self/status");
  std::string word;
  while (file >> word)
  {
    if (word == name)
    {
      double kilobytes;
      file >> kilobytes;
      return 1024.0 * kilobytes;
    }
  }
  throw std::runtime_error("no " + name + " in /proc/self/status");
}

void AddHomeomorphism(const Workload& workload, const std::string& name, CoordinateSystem system,
  Rows& rows, CubicBending bending = CubicBending::Least)
{
  auto map = std::make_shared<std::shared_ptr<const Homeomorphism>>();
  Row& row = rows["construct/" + name];
  // Destroying the previous result is not timed.
  row.Before = [map](Task&) { map->reset(); };
  row.Run = [map, system, bending, &workload](Task&) {
    HomeomorphismOptions options;
    options.System = system;
    options.Cubic.Bending = bending;
    MeshDiagnostics problems;
    *map = Homeomorphism::Make(workload.Source, workload.Target, options, problems);
    if (!*map)
    {
      throw std::runtime_error("the meshes are refused");
    }
  };
}

} // namespace

void AddConstructionRows(const Workload& workload, Rows& rows)
{
  AddHomeomorphism(workload, "Linear", CoordinateSystem::Linear, rows);
  AddHomeomorphism(workload, "Contour", CoordinateSystem::Contour, rows);
  AddHomeomorphism(workload, "Smooth", CoordinateSystem::Smooth, rows);
  AddHomeomorphism(workload, "CubicLocal", CoordinateSystem::Cubic, rows, CubicBending::Local);
  AddHomeomorphism(workload, "CubicLeast", CoordinateSystem::Cubic, rows);

  auto locator = std::make_shared<vtkSmartPointer<vtkStaticCellLocator>>();
  Row& row = rows["construct/vtkStaticCellLocator"];
  row.Before = [locator, &workload](Task&) {
    // The cells are part of the mesh; vtkPolyData builds them when they are first used.
    workload.Source->BuildCells();
    *locator = vtkSmartPointer<vtkStaticCellLocator>::New();
    (*locator)->SetDataSet(workload.Source);
  };
  row.Run = [locator](Task&) { (*locator)->BuildLocator(); };
}

Memory MeasureMemory(Row& row, Task& task)
{
  row.Before(task);
  malloc_trim(0);
  const double before = Allocated();
  const double residentBefore = Status("VmRSS:");
  // Reset the high-water mark.
  std::ofstream("/proc/self/clear_refs") << "5";
  row.Run(task);
  return { Allocated() - before, Status("VmHWM:") - residentBefore };
}
