// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file LeastBendingDerivatives.h
/// The derivatives of least bending at the points of a mesh each of whose triangles is one cubic
/// element.

#ifndef homeomorphism_LeastBendingDerivatives_h
#define homeomorphism_LeastBendingDerivatives_h

#include "Mesh/CubicTemplate.h"
#include "Mesh/LargeArray.h"

#include <map>

namespace homeomorphism
{

/// The conditions of the boundary at a point.
struct BoundaryPoint
{
  bool Straight = false;
  Vector2 Tangent;
  /// The derivative along the tangent, if the boundary is straight.
  Vector2 Slope;
  /// The derivative at a corner.
  Matrix2 Derivative;
};

struct LeastBendingDerivatives
{
  LargeArray<Matrix2> AtPoints;
  /// The integral of the squared second derivatives.
  double Energy = 0.0;
};

/// Minimizes the integral of the squared second derivatives over the derivatives at all points,
/// subject to the conditions of @a boundary, by conjugate gradients, starting from the derivatives
/// of the template. The values at the points are those of the piecewise linear map. The condition
/// number of the system does not depend on the number of triangles. @a scratch is memory that the
/// function may use while it runs.
LeastBendingDerivatives FindLeastBendingDerivatives(const CubicTemplate& cubicTemplate,
  const PointFans& fans, const std::map<int, BoundaryPoint>& boundary, LargeScratch scratch,
  const ParallelFor& parallelFor);

} // namespace homeomorphism

#endif
