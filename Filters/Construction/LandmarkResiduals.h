// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file LandmarkResiduals.h
/// Residuals of landmarks, from which wrong landmarks are recognized.

#ifndef homeomorphism_LandmarkResiduals_h
#define homeomorphism_LandmarkResiduals_h

#include "Kernel/Geometry.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// For each landmark, the distance in the target, in its units, between the landmark and its
/// prediction by a smooth map through its neighbors.
///
/// The map is a quadratic polynomial (an affine map if there are fewer than 15 landmarks). It is
/// fitted, without the landmark, to its 18 nearest neighbors in the source; nearer ones have more
/// weight, and neighbors that do not fit have less (Cauchy weights), so that a wrong landmark does
/// not increase the residuals of others. Near the border of the landmarks, the map is extrapolated,
/// which magnifies errors of the neighbors. There, the distance is divided by the ratio of its
/// standard deviation to the usual one, for independent errors of all landmarks.
///
/// At the border, the neighbor of a wrong landmark may fit worse than the wrong one. Therefore,
/// while a residual is larger than four times the 80 % quantile, the landmark without which the
/// others fit best is excluded from the fits of all others (at most ten landmarks, and at most a
/// fifth of them).
///
/// Among few landmarks, a wrong one is a neighbor of most others and increases their residuals.
/// Therefore, among at most 30 landmarks, the exclusion of each one is tried first, and among 8 to
/// 16 also that of each two. They are excluded if that halves the sum of the others' residuals, and
/// if their own are more than six times the 80 % quantile.
///
/// A landmark that is wrong in the source may be far from all others there, where its prediction is
/// uncertain (a ratio above three). If it has a large residual under the inverse map, its residual
/// is that of the inverse map times the ratio of the 80 % quantiles, if this is larger.
///
/// All residuals are 0 if there are fewer than five landmarks. Of equally near neighbors, and of
/// landmarks with equal residuals, the one with the smaller number comes first. Takes O(n log n)
/// steps.
std::vector<double> LandmarkResiduals(const std::array<std::vector<Vector2>, 2>& landmarks);

} // namespace homeomorphism

#endif
