// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file LandmarkResiduals.h
/// Which landmark is probably wrong.

#ifndef homeomorphism_LandmarkResiduals_h
#define homeomorphism_LandmarkResiduals_h

#include "Kernel/Geometry.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// For each landmark, the distance in the target, in its units, between the landmark and the place
/// where a smooth map through its neighbors puts it. At the border of the landmarks the map is
/// extrapolated, which magnifies errors of the neighbors; there the distance is divided by the
/// ratio of its standard deviation to the usual one, for independent errors of all landmarks. The
/// map is a quadratic polynomial (an affine map if there are fewer than nine landmarks), fitted
/// without the landmark to its 18 nearest neighbors in the source, nearer ones with more weight;
/// neighbors that do not fit lose theirs (Cauchy weights), so that a wrong landmark does not accuse
/// the others. As long as a residual is larger than four times that of four fifths of the
/// landmarks, the landmark without which the others fit best is left out of the fits of all others
/// (at most ten, and a fifth of them), since at the border of the landmarks the neighbor of a wrong
/// one may fit worse than the wrong one. 0 for all if there are fewer than five landmarks. Of
/// equally near neighbors, and of landmarks with equal residuals, the one with the lower number
/// comes first. Takes n log n steps.
std::vector<double> LandmarkResiduals(const std::array<std::vector<Vector2>, 2>& landmarks);

} // namespace homeomorphism

#endif
