// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PeerRows.cxx
/// Comparable software: PROJ's triangulated grids, and VTK's own classes.

#include "Rows.h"
#include "Workload.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkGenericCell.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkProbeFilter.h"
#include "vtkStaticCellLocator.h"
#include "vtkThinPlateSplineTransform.h"

#include <nlohmann/json.hpp>
#include <proj.h>

#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

namespace
{

/// Writes the pair as a PROJ triangulation file.
void WriteTinshift(const Workload& workload, const std::string& path)
{
  nlohmann::json vertices = nlohmann::json::array();
  for (vtkIdType i = 0; i < workload.Source->GetNumberOfPoints(); ++i)
  {
    double p[3];
    double q[3];
    workload.Source->GetPoint(i, p);
    workload.Target->GetPoint(i, q);
    vertices.push_back({ p[0], p[1], q[0], q[1] });
  }
  nlohmann::json triangles = nlohmann::json::array();
  for (vtkIdType t = 0; t < workload.Source->GetNumberOfCells(); ++t)
  {
    vtkIdType count;
    const vtkIdType* corners;
    workload.Source->GetPolys()->GetCellAtId(t, count, corners);
    triangles.push_back({ corners[0], corners[1], corners[2] });
  }
  const nlohmann::json file{ { "file_type", "triangulation_file" }, { "format_version", "1.0" },
    { "transformed_components", { "horizontal" } },
    { "vertices_columns", { "source_x", "source_y", "target_x", "target_y" } },
    { "triangles_columns", { "idx_vertex1", "idx_vertex2", "idx_vertex3" } },
    { "vertices", vertices }, { "triangles", triangles } };
  std::ofstream(path) << file;
}

class Tinshift
{
public:
  explicit Tinshift(const Workload& workload)
    : Meshes(workload)
  {
  }
  ~Tinshift()
  {
    proj_destroy(this->Operation);
    proj_context_destroy(this->Context);
  }
  Tinshift(const Tinshift&) = delete;
  void operator=(const Tinshift&) = delete;

  void Open()
  {
    if (this->Operation)
    {
      return;
    }
    const std::string path = this->Meshes.Folder + "/tinshift.json";
    WriteTinshift(this->Meshes, path);
    this->Context = proj_context_create();
    this->Operation = proj_create(this->Context, ("+proj=tinshift +file=" + path).c_str());
    if (!this->Operation)
    {
      throw std::runtime_error(std::string("PROJ does not take the triangulation: ") +
        proj_context_errno_string(this->Context, proj_context_errno(this->Context)));
    }
  }

  void Map(PJ_DIRECTION direction, vtkPoints* points)
  {
    double* xyz = Coordinates(points);
    const auto count = static_cast<std::size_t>(points->GetNumberOfPoints());
    proj_trans_generic(this->Operation, direction, xyz, 3 * sizeof(double), count, xyz + 1,
      3 * sizeof(double), count, nullptr, 0, 0, nullptr, 0, 0);
  }

private:
  const Workload& Meshes;
  PJ_CONTEXT* Context = nullptr;
  PJ* Operation = nullptr;
};

void AddTinshift(const Workload& workload, Rows& rows)
{
  auto tinshift = std::make_shared<Tinshift>(workload);
  for (const bool inverse : { false, true })
  {
    Row& row = rows["tinshift" + Direction(inverse)];
    row.Before = [tinshift](Task& task) {
      tinshift->Open();
      // PROJ maps points in place.
      task.Out->DeepCopy(task.In);
    };
    row.Run = [tinshift, inverse](
                Task& task) { tinshift->Map(inverse ? PJ_INV : PJ_FWD, task.Out); };
  }
}

void AddFindCell(const Workload& workload, bool inverse, Rows& rows)
{
  struct Finder
  {
    vtkNew<vtkStaticCellLocator> Locator;
    vtkNew<vtkGenericCell> Cell;
    std::vector<vtkIdType> Found;
  };
  auto finder = std::make_shared<Finder>();
  finder->Locator->SetDataSet(workload.GetFrom(inverse));
  Row& row = rows["FindCell" + Direction(inverse)];
  row.Before = [finder](Task& task) {
    finder->Locator->BuildLocator();
    finder->Found.resize(static_cast<std::size_t>(task.In->GetNumberOfPoints()));
  };
  row.Run = [finder](Task& task) {
    double* in = Coordinates(task.In);
    double parametric[3];
    double weights[3];
    for (vtkIdType& found : finder->Found)
    {
      found = finder->Locator->FindCell(in, 0.0, finder->Cell, parametric, weights);
      in += 3;
    }
  };
  // Only finding cells is timed. The map verifies that they are correct.
  row.After = [finder, &workload, inverse](Task& task) {
    const std::vector<Affine> maps =
      TriangleMaps(workload.GetFrom(inverse), workload.GetTo(inverse));
    const double* in = Coordinates(task.In);
    double* out = Coordinates(task.Out);
    for (const vtkIdType found : finder->Found)
    {
      if (found >= 0)
      {
        Apply(maps[static_cast<std::size_t>(found)], in, out);
      }
      in += 3;
      out += 3;
    }
  };
}

/// Points as an image if they form one, which vtkProbeFilter processes several times
/// faster.
vtkSmartPointer<vtkDataSet> AsDataSet(vtkPoints* points)
{
  const vtkIdType count = points->GetNumberOfPoints();
  const double* p = Coordinates(points);
  vtkIdType columns = 1;
  while (columns < count && p[3 * columns + 1] == p[1])
  {
    ++columns;
  }
  if (columns > 1 && count % columns == 0 && count > columns)
  {
    auto image = vtkSmartPointer<vtkImageData>::New();
    const auto rows = count / columns;
    image->SetDimensions(static_cast<int>(columns), static_cast<int>(rows), 1);
    image->SetOrigin(p[0], p[1], p[2]);
    image->SetSpacing((p[3 * (columns - 1)] - p[0]) / static_cast<double>(columns - 1),
      (p[3 * (count - 1) + 1] - p[1]) / static_cast<double>(rows - 1), 1.0);
    return image;
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  return data;
}

void AddProbe(const Workload& workload, bool inverse, Rows& rows)
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->ShallowCopy(workload.GetFrom(inverse));
  auto images = vtkSmartPointer<vtkDoubleArray>::New();
  images->DeepCopy(workload.GetTo(inverse)->GetPoints()->GetData());
  images->SetName("Image");
  mesh->GetPointData()->AddArray(images);
  auto probe = vtkSmartPointer<vtkProbeFilter>::New();
  probe->SetSourceData(mesh);
  Row& row = rows["vtkProbeFilter" + Direction(inverse)];
  row.Before = [probe](Task& task) { probe->SetInputData(AsDataSet(task.In)); };
  row.Run = [probe](Task&) { probe->Update(); };
  row.After = [probe](Task& task) {
    task.Result = probe->GetOutput()->GetPointData()->GetArray("Image");
  };
}

void AddThinPlateSpline(const Workload& workload, Rows& rows)
{
  auto spline = vtkSmartPointer<vtkThinPlateSplineTransform>::New();
  spline->SetBasisToR2LogR();
  spline->SetSourceLandmarks(workload.Source->GetPoints());
  spline->SetTargetLandmarks(workload.Target->GetPoints());
  for (const bool inverse : { false, true })
  {
    vtkSmartPointer<vtkAbstractTransform> transform = spline;
    if (inverse)
    {
      transform = spline->GetInverse();
    }
    Row& row = rows["vtkThinPlateSplineTransform" + Direction(inverse)];
    row.Before = [transform](Task& task) {
      transform->Update();
      task.Out->Reset();
    };
    row.Run = [transform](Task& task) { transform->TransformPoints(task.In, task.Out); };
  }
}

} // namespace

void AddPeerRows(const Workload& workload, Rows& rows)
{
  AddTinshift(workload, rows);
  AddThinPlateSpline(workload, rows);
  for (const bool inverse : { false, true })
  {
    AddFindCell(workload, inverse, rows);
    AddProbe(workload, inverse, rows);
  }
}
