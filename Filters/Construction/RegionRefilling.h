// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file RegionRefilling.h
/// Parts of a pair of triangulations filled anew, with fewer added points.

#ifndef homeomorphism_RegionRefilling_h
#define homeomorphism_RegionRefilling_h

#include "PairMesh.h"

namespace homeomorphism
{

/// Fills the triangles around a free vertex anew, about @a size of them, if fewer added points do.
/// The region does not reach across fixed edges. It may surround vertices of the figure: it is then
/// slit, along fixed edges and short ones, until it is a polygon that has only free vertices
/// inside.
/// @param turn 0 or more: on which side the region begins to grow
bool RefillRegion(PairMesh& mesh, int vertex, int size, int turn);

} // namespace homeomorphism

#endif
