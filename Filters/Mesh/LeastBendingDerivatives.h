// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file LeastBendingDerivatives.h
/// The derivatives of least bending at the points of a mesh whose triangles are one cubic element
/// each.

#ifndef homeomorphism_LeastBendingDerivatives_h
#define homeomorphism_LeastBendingDerivatives_h

#include "Mesh/CubicTemplate.h"
#include "Mesh/LargeArray.h"

#include <map>

namespace homeomorphism
{

/// What the boundary prescribes at a point.
struct BoundaryPoint
{
  bool Straight = false;
  Vector2 Tangent;
  /// The derivative along the tangent, if the boundary is straight.
  Vector2 Slope;
  /// The whole derivative at a corner.
  Matrix2 Derivative;
};

struct LeastBendingDerivatives
{
  LargeArray<Matrix2> AtPoints;
  /// The integral of the squared second derivatives.
  double Energy = 0.0;
};

/// Minimizes the integral of the squared second derivatives over the derivatives at all points that
/// @a boundary leaves free, by conjugate gradients from those of the template. All points are where
/// the piecewise linear map has them. The system is well conditioned for any number of triangles.
/// @a scratch is memory that may be used, for as long as this runs.
LeastBendingDerivatives FindLeastBendingDerivatives(const CubicTemplate& cubicTemplate,
  const PointFans& fans, const std::map<int, BoundaryPoint>& boundary, LargeScratch scratch,
  const ParallelFor& parallelFor);

} // namespace homeomorphism

#endif
