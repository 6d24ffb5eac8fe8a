// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file GhostArrays.h
/// Points and cells that are hidden or belong to another piece (vtkGhostType).

#ifndef homeomorphism_GhostArrays_h
#define homeomorphism_GhostArrays_h

#include "vtkType.h"

class vtkDataSet;
class vtkDataSetAttributes;
class vtkUnsignedCharArray;

namespace homeomorphism
{

/// Replaces the ghost array of some attributes, if it fits them, by a copy, else by a new one.
vtkUnsignedCharArray* RenewGhosts(vtkDataSetAttributes* attributes, vtkIdType tuples);

/// Number of points that @a mask leaves out, those of @a data that belong to another piece
/// excepted.
vtkIdType CountOutside(vtkDataSet* data, vtkUnsignedCharArray* mask);

/// Hides (vtkGhostType) the points of @a output that @a mask leaves out, and the cells that use
/// them or points that do not exist; nothing if it leaves none out. @a cells has the output's
/// cells.
void HidePoints(vtkDataSet* cells, vtkUnsignedCharArray* mask, vtkDataSet* output);

} // namespace homeomorphism

#endif
