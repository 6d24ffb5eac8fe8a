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
#include <cstring>

namespace homeomorphism
{
namespace
{

void AddWord(std::uint64_t word, std::uint64_t& hash)
{
  // A step of the finalizer of MurmurHash3 (Appleby, public domain).
  hash = (hash ^ word) * 0xff51afd7ed558ccdu;
  hash ^= hash >> 32;
}

void AddContents(vtkDataArray* array, std::uint64_t& hash)
{
  const vtkIdType values = array ? array->GetNumberOfValues() : 0;
  AddWord(static_cast<std::uint64_t>(values), hash);
  if (values == 0)
  {
    return;
  }
  if (!array->HasStandardMemoryLayout())
  {
    for (vtkIdType tuple = 0; tuple < array->GetNumberOfTuples(); ++tuple)
    {
      for (int component = 0; component < array->GetNumberOfComponents(); ++component)
      {
        const double value = array->GetComponent(tuple, component);
        std::uint64_t word;
        std::memcpy(&word, &value, sizeof(word));
        AddWord(word, hash);
      }
    }
    return;
  }
  const auto* bytes = static_cast<const char*>(array->GetVoidPointer(0));
  const auto size =
    static_cast<std::size_t>(values) * static_cast<std::size_t>(array->GetDataTypeSize());
  for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t))
  {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, std::min(sizeof(word), size - i));
    AddWord(word, hash);
  }
}

std::array<vtkCellArray*, 4> GetCellArrays(vtkPolyData* mesh)
{
  return { mesh->GetVerts(), mesh->GetLines(), mesh->GetPolys(), mesh->GetStrips() };
}

std::uint64_t HashContents(vtkPolyData* source, vtkPolyData* target)
{
  std::uint64_t hash = 0;
  for (vtkPolyData* mesh : { source, target })
  {
    if (!mesh)
    {
      continue;
    }
    AddContents(mesh->GetPoints() ? mesh->GetPoints()->GetData() : nullptr, hash);
    for (vtkCellArray* cells : GetCellArrays(mesh))
    {
      if (cells)
      {
        AddContents(cells->GetOffsetsArray(), hash);
        AddContents(cells->GetConnectivityArray(), hash);
      }
    }
    AddContents(mesh->GetPointData()->GetArray(vtkDataSetAttributes::GhostArrayName()), hash);
    AddContents(mesh->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()), hash);
  }
  return hash;
}

void AddStamps(vtkPolyData* mesh, std::vector<std::pair<const void*, vtkMTimeType>>& stamps)
{
  const auto add = [&stamps](vtkObject* object) {
    stamps.emplace_back(object, object ? object->GetMTime() : 0);
  };
  if (!mesh)
  {
    add(nullptr);
    return;
  }
  // An object changed in place may keep the modification times of its arrays, but rarely its size.
  const auto addSize = [&stamps](vtkIdType size) {
    stamps.emplace_back(nullptr, static_cast<vtkMTimeType>(size));
  };
  addSize(mesh->GetNumberOfPoints());
  add(mesh->GetPoints());
  add(mesh->GetPoints() ? mesh->GetPoints()->GetData() : nullptr);
  for (vtkCellArray* cells : GetCellArrays(mesh))
  {
    add(cells);
    addSize(cells ? cells->GetNumberOfCells() : 0);
    add(cells ? cells->GetOffsetsArray() : nullptr);
    add(cells ? cells->GetConnectivityArray() : nullptr);
  }
  add(mesh->GetPointData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
  add(mesh->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
}

/// The modification time of the object itself, which changes with Modified() but not with the data
/// of the mesh.
vtkMTimeType GetOwnTime(vtkPolyData* mesh)
{
  return mesh ? mesh->vtkObject::GetMTime() : 0;
}

} // namespace

bool HomeomorphismCache::HasChanged(vtkPolyData* source, vtkPolyData* target)
{
  MeshState state;
  AddStamps(source, state.Parts);
  AddStamps(target, state.Parts);
  state.Times = { GetOwnTime(source), GetOwnTime(target) };
  const bool sameParts = state.Parts == this->State.Parts;
  if (this->NumberOfBuilds > 0 && sameParts && state.Times == this->State.Times)
  {
    return false;
  }
  // A new shallow copy of a mesh is equivalent to the old one, and coordinates may have been
  // overwritten in place, so compare the contents.
  state.Contents = HashContents(source, target);
  const bool changed =
    this->NumberOfBuilds == 0 || !sameParts || state.Contents != this->State.Contents;
  this->State = std::move(state);
  return changed;
}

std::shared_ptr<const Homeomorphism> HomeomorphismCache::Get(
  vtkPolyData* source, vtkPolyData* target, const HomeomorphismOptions& options)
{
  if (this->HasChanged(source, target) || !(options == this->Options))
  {
    this->Problems.clear();
    this->Current = Homeomorphism::Make(source, target, options, this->Problems);
    this->Options = options;
    ++this->NumberOfBuilds;
  }
  return this->Current;
}

} // namespace homeomorphism
