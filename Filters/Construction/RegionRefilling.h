// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file RegionRefilling.h
/// Triangulating regions of a pair of triangulations again, with fewer added points.

#ifndef homeomorphism_RegionRefilling_h
#define homeomorphism_RegionRefilling_h

#include "PairMesh.h"

namespace homeomorphism
{

/// Triangulates a region of about @a size triangles around a free vertex again, if this needs fewer
/// added points. Returns whether it did. The region does not extend across fixed edges. If it
/// surrounds vertices of the figure, it is slit along fixed and short edges until it is a polygon
/// that contains only free vertices.
/// @param turn at least 0; determines the direction in which the region grows first
bool RefillRegion(PairMesh& mesh, int vertex, int size, int turn);

} // namespace homeomorphism

#endif
