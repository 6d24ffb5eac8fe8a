// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PairRefinement.h
/// A pair of finer triangulations whose piecewise linear map is close to a homeomorphism.

#ifndef homeomorphism_PairRefinement_h
#define homeomorphism_PairRefinement_h

#include "Mesh/Homeomorphism.h"

#include "vtkType.h"

#include <array>
#include <functional>
#include <vector>

class vtkPolyData;

namespace homeomorphism
{

/// The finer pair. Its first points are those of the original pair, with their ids.
struct RefinedPair
{
  enum class Outcome
  {
    /// The maximum error is kept.
    Refined,
    /// The maximum error would take more triangles than are allowed.
    TooManyTriangles,
    /// The maximum error would take edges that cannot be halved, because no coordinates lie
    /// between those of their ends.
    BelowRounding,
    /// The caller asked to stop.
    Aborted
  };

  /// A point added: where in the original pair's source it is.
  struct Point
  {
    TriangleIndex Triangle;
    /// Barycentric coordinates with respect to the triangle's corners: multiples of powers of 1/2,
    /// unrounded.
    std::array<double, 3> Weights;
  };

  Outcome Result = Outcome::Refined;
  /// Triples of point ids, in the order of the original triangles, whose windings they have.
  std::vector<std::array<vtkIdType, 3>> Triangles;
  /// The original triangle of each.
  std::vector<TriangleIndex> Originals;
  std::vector<Point> NewPoints;
  /// Coordinates in source and target of the points added.
  std::array<std::vector<Vector3>, 2> NewPositions;
  /// The largest distance between the piecewise linear map and the homeomorphism over all samples,
  /// in the target's units; of an unfinished refinement, the largest that was last seen.
  double LargestError = 0.0;
  /// The number of points at which the distance was measured last, over all triangles.
  vtkIdType Samples = 0;
};

/// Halves edges, with the triangles on both sides of each, so that no vertex lies within an edge
/// (Rivara: bisection), until the piecewise linear map of the finer pair is nowhere farther from
/// the homeomorphism than @a maximumError, in the target's units, as sampled at 595 points of each
/// triangle, and turns no triangle over. The edges are chosen by the distances found on them, so
/// that triangles become long where the map bends in one direction only; triangles lower than 0.03
/// of their longest edge are made no longer.
///
/// Points added on the boundary stay on its edges; the others go where the homeomorphism takes
/// them. @a source and @a target are the meshes that @a map was made from. Triangles are measured
/// in parallel; the result does not depend on the number of threads. @a isAborted is asked now and
/// then.
RefinedPair Refine(const Homeomorphism& map, vtkPolyData* source, vtkPolyData* target,
  double maximumError, vtkIdType maximumTriangles, const std::function<bool()>& isAborted);

} // namespace homeomorphism

#endif
