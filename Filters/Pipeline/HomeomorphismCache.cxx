// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "HomeomorphismCache.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace homeomorphism
{

void HomeomorphismCache::AddStamps(vtkPolyData* mesh, std::vector<Stamp>& stamps)
{
  const auto add = [&stamps](vtkObject* object) {
    stamps.emplace_back(object, object ? object->GetMTime() : 0);
  };
  if (!mesh)
  {
    add(nullptr);
    return;
  }
  // An object changed in place may keep its arrays' times, but hardly its size.
  const auto addSize = [&stamps](vtkIdType size) {
    stamps.emplace_back(nullptr, static_cast<vtkMTimeType>(size));
  };
  addSize(mesh->GetNumberOfPoints());
  add(mesh->GetPoints());
  add(mesh->GetPoints() ? mesh->GetPoints()->GetData() : nullptr);
  for (vtkCellArray* cells :
    { mesh->GetVerts(), mesh->GetLines(), mesh->GetPolys(), mesh->GetStrips() })
  {
    add(cells);
    addSize(cells ? cells->GetNumberOfCells() : 0);
    add(cells ? cells->GetOffsetsArray() : nullptr);
    add(cells ? cells->GetConnectivityArray() : nullptr);
  }
  add(mesh->GetPointData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
  add(mesh->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
}

std::shared_ptr<const Homeomorphism> HomeomorphismCache::Get(
  vtkPolyData* source, vtkPolyData* target, const HomeomorphismOptions& options)
{
  std::vector<Stamp> stamps;
  AddStamps(source, stamps);
  AddStamps(target, stamps);
  const bool sameMeshes = std::equal(stamps.begin(), stamps.end(), this->Stamps.begin(),
    this->Stamps.end(), [](const Stamp& a, const Stamp& b) {
      return a.first.GetPointer() == b.first.GetPointer() && a.second == b.second;
    });
  const bool sameOptions = options.System == this->Options.System &&
    options.Center == this->Options.Center &&
    options.MaskInvalidTriangles == this->Options.MaskInvalidTriangles &&
    options.DiscordantByLinear == this->Options.DiscordantByLinear &&
    options.Cubic == this->Options.Cubic;
  if (this->NumberOfBuilds == 0 || !sameMeshes || !sameOptions)
  {
    this->Problems.clear();
    this->Current = Homeomorphism::Make(source, target, options, this->Problems);
    this->Stamps = std::move(stamps);
    this->Options = options;
    ++this->NumberOfBuilds;
  }
  return this->Current;
}

} // namespace homeomorphism
