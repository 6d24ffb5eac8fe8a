// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshParts.h
/// The cells of meshes, one after the other, and what is often asked of a mesh.

#ifndef dhm_MeshParts_h
#define dhm_MeshParts_h

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

namespace dhm
{

/// Calls work(number, count, points) for each cell: its place in the array, from 0, and its points.
template <typename Work>
void ForEachCell(vtkCellArray* cells, Work&& work)
{
  const auto iterator = vtk::TakeSmartPointer(cells->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    vtkIdType count;
    const vtkIdType* points;
    iterator->GetCurrentCell(count, points);
    work(iterator->GetCurrentCellId(), count, points);
  }
}

/// The cell id of a mesh's first polygon: vertices and lines come before.
inline vtkIdType FirstPolygon(vtkPolyData* mesh)
{
  return mesh->GetNumberOfVerts() + mesh->GetNumberOfLines();
}

/// Whether z is the same everywhere.
inline bool IsFlat(vtkPolyData* mesh)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  return bounds[4] == bounds[5];
}

} // namespace dhm

#endif
