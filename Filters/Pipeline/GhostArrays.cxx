// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "GhostArrays.h"

#include "CellPoints.h"

#include "Mesh/MeshValidation.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace homeomorphism
{

vtkUnsignedCharArray* RenewGhosts(vtkDataSetAttributes* attributes, vtkIdType tuples)
{
  const auto ghosts = vtkSmartPointer<vtkUnsignedCharArray>::New();
  if (vtkUnsignedCharArray* current = GhostsOf(attributes, tuples))
  {
    ghosts->DeepCopy(current);
  }
  else
  {
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    ghosts->SetNumberOfTuples(tuples);
    ghosts->FillValue(0);
  }
  attributes->AddArray(ghosts);
  return ghosts;
}

vtkIdType CountOutside(vtkDataSet* data, vtkUnsignedCharArray* mask)
{
  const vtkIdType numberOfPoints = mask->GetNumberOfTuples();
  vtkUnsignedCharArray* ghosts = GhostsOf(data->GetPointData(), numberOfPoints);
  vtkIdType outside = 0;
  for (vtkIdType i = 0; i < numberOfPoints; ++i)
  {
    outside += !mask->GetValue(i) &&
      !(ghosts && (ghosts->GetValue(i) & vtkDataSetAttributes::DUPLICATEPOINT));
  }
  return outside;
}

void HidePoints(vtkDataSet* cells, vtkUnsignedCharArray* mask, vtkDataSet* output)
{
  const vtkIdType numberOfPoints = mask->GetNumberOfTuples();
  const vtkIdType numberOfCells = output->GetNumberOfCells();
  const unsigned char* isShown = mask->GetPointer(0);
  if (std::find(isShown, isShown + numberOfPoints, 0) == isShown + numberOfPoints)
  {
    return;
  }
  vtkUnsignedCharArray* pointGhosts = RenewGhosts(output->GetPointData(), numberOfPoints);
  vtkUnsignedCharArray* cellGhosts = RenewGhosts(output->GetCellData(), numberOfCells);
  for (vtkIdType i = 0; i < numberOfPoints; ++i)
  {
    if (!mask->GetValue(i))
    {
      pointGhosts->SetValue(i, pointGhosts->GetValue(i) | vtkDataSetAttributes::HIDDENPOINT);
    }
  }
  const CellPoints cellPoints(cells);
  const auto ids = vtkSmartPointer<vtkIdList>::New();
  for (vtkIdType cell = 0; cell < numberOfCells; ++cell)
  {
    cellPoints.Get(cell, ids);
    if (std::any_of(ids->begin(), ids->end(), [=](vtkIdType point) {
          return point < 0 || point >= numberOfPoints || !mask->GetValue(point);
        }))
    {
      cellGhosts->SetValue(cell, cellGhosts->GetValue(cell) | vtkDataSetAttributes::HIDDENCELL);
    }
  }
}

} // namespace homeomorphism
