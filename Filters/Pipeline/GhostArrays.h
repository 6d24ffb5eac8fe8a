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

/// Replaces the ghost array of @a attributes by a copy, or by a new one if its length is not
/// @a tuples, and returns it.
vtkUnsignedCharArray* RenewGhosts(vtkDataSetAttributes* attributes, vtkIdType tuples);

/// The number of points that @a mask excludes, without points of @a data that belong to another
/// piece.
vtkIdType CountOutside(vtkDataSet* data, vtkUnsignedCharArray* mask);

/// Hides (vtkGhostType) the points of @a output that @a mask excludes, and the cells that use them
/// or that have invalid point ids. Does nothing if the mask excludes no points. @a cells is a data
/// set with the cells of the output.
void HidePoints(vtkDataSet* cells, vtkUnsignedCharArray* mask, vtkDataSet* output);

} // namespace homeomorphism

#endif
