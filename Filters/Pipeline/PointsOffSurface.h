// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PointsOffSurface.h
/// Points that are outside only because they lie slightly off a surface.

#ifndef homeomorphism_PointsOffSurface_h
#define homeomorphism_PointsOffSurface_h

#include "Mesh/Homeomorphism.h"

class vtkDataSet;
class vtkObject;
class vtkUnsignedCharArray;

namespace homeomorphism
{

/// If a mesh is not planar, and some points of @a data that @a mask excludes are within a
/// thousandth of its diagonal, issues a warning with their largest distance and the Tolerance that
/// would include them. The usual reason is the rounding of coordinates. At most a thousand of the
/// excluded points are examined.
void WarnOfPointsOffSurface(vtkObject* self, const Homeomorphism& map, Domain domain,
  vtkDataSet* data, vtkUnsignedCharArray* mask);

} // namespace homeomorphism

#endif
