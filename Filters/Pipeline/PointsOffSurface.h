// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PointsOffSurface.h
/// Points that are outside only because a surface misses them by little.

#ifndef homeomorphism_PointsOffSurface_h
#define homeomorphism_PointsOffSurface_h

#include "Mesh/Homeomorphism.h"

class vtkDataSet;
class vtkObject;
class vtkUnsignedCharArray;

namespace homeomorphism
{

/// If a mesh is not planar and points of @a data that @a mask excludes are close to it, within a
/// thousandth of its diagonal, warns with their largest distance and the Tolerance that would
/// include them. Rounded coordinates are the usual reason. At most a thousand of the excluded
/// points are examined.
void WarnOfPointsOffSurface(vtkObject* self, const Homeomorphism& map, Domain domain,
  vtkDataSet* data, vtkUnsignedCharArray* mask);

} // namespace homeomorphism

#endif
