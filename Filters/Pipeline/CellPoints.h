// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CellPoints.h
/// Safe access to the points of cells that may be malformed.

#ifndef homeomorphism_CellPoints_h
#define homeomorphism_CellPoints_h

#include "vtkCellArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <array>

namespace homeomorphism
{

/// The point ids of the cells of a data set, as stored. vtkPolyData::GetCellPoints reads from a
/// null pointer if a cell has fewer points than a line or polygon needs, or if offsets are
/// invalid.
class CellPoints
{
public:
  explicit CellPoints(vtkDataSet* data)
    : Data(data)
  {
    if (auto* mesh = vtkPolyData::SafeDownCast(data))
    {
      this->Arrays = { mesh->GetVerts(), mesh->GetLines(), mesh->GetPolys(), mesh->GetStrips() };
      this->IsExplicit = true;
    }
    else if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
    {
      this->Arrays[0] = grid->GetCells();
      this->IsExplicit = true;
    }
    else if (data->GetNumberOfCells() > 0)
    {
      // Builds all internal structures before it is used by several threads.
      vtkNew<vtkIdList> ids;
      data->GetCellPoints(0, ids);
    }
    for (vtkCellArray*& array : this->Arrays)
    {
      // Cells of other kinds are numbered too.
      this->Counts[&array - this->Arrays.data()] = array ? array->GetNumberOfCells() : 0;
      array = array && array->IsValid() ? array : nullptr;
    }
  }

  /// Returns no points for a cell of a corrupt array. May be called from several threads.
  void Get(vtkIdType cell, vtkIdList* ids) const
  {
    if (!this->IsExplicit)
    {
      this->Data->GetCellPoints(cell, ids);
      return;
    }
    ids->Reset();
    for (std::size_t i = 0; i < this->Arrays.size(); ++i)
    {
      if (cell < this->Counts[i])
      {
        if (this->Arrays[i])
        {
          this->Arrays[i]->GetCellAtId(cell, ids);
        }
        return;
      }
      cell -= this->Counts[i];
    }
  }

private:
  vtkDataSet* Data;
  bool IsExplicit = false;
  std::array<vtkCellArray*, 4> Arrays{};
  std::array<vtkIdType, 4> Counts{};
};

} // namespace homeomorphism

#endif
