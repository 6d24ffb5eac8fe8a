// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Refinement.h
/// A pair of finer meshes whose piecewise linear map is close to the map of another system: for
/// programs that know no other than piecewise linear maps.

#ifndef dhm_Refinement_h
#define dhm_Refinement_h

#include "MeshPair.h"

#include "vtkType.h"

namespace dhm
{

struct MapOptions;

struct Refinement
{
  /// The finer meshes. The first points and the metadata are the pair's own.
  MeshPair Pair;
  /// The largest distance found between the piecewise linear map and the one that it stands for, in
  /// the target's units, and at how many points it was looked for.
  double Distance = 0.0;
  vtkIdType Samples = 0;
};

/// Halves edges of a planar pair, with the triangles on both sides, until the piecewise linear map
/// is nowhere farther from the map than @a tolerance, as found at many points of each triangle, and
/// turns no triangle over. Which edges follows from the distances found on them, so that triangles
/// become long where the map bends in one direction only. Throws Failure if that takes more than
/// @a mostTriangles triangles.
Refinement Refine(
  const MeshPair& pair, const MapOptions& map, double tolerance, vtkIdType mostTriangles);

} // namespace dhm

#endif
