// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PairRefinement.h
/// A pair of finer triangulations whose piecewise linear map approximates a homeomorphism.

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
    /// The maximum error was reached.
    Refined,
    /// The maximum error requires more triangles than allowed.
    TooManyTriangles,
    /// The maximum error requires bisecting edges that cannot be bisected, because there are no
    /// coordinates between those of their ends.
    BelowRounding,
    /// The caller aborted.
    Aborted
  };

  /// An added point: its position in the source of the original pair.
  struct Point
  {
    TriangleIndex Triangle;
    /// Barycentric coordinates in the triangle: dyadic rationals, exact.
    std::array<double, 3> Weights;
  };

  Outcome Result = Outcome::Refined;
  /// Triples of point ids, in the order and with the windings of the original triangles.
  std::vector<std::array<vtkIdType, 3>> Triangles;
  /// The original triangle of each triangle.
  std::vector<TriangleIndex> Originals;
  std::vector<Point> NewPoints;
  /// Coordinates of the added points in source and target.
  std::array<std::vector<Vector3>, 2> NewPositions;
  /// The largest distance between the piecewise linear map and the homeomorphism over all samples,
  /// in units of the target. If the refinement was not completed, the last known value.
  double LargestError = 0.0;
  /// The number of points of the last measurement, over all triangles.
  vtkIdType Samples = 0;
};

/// Bisects edges, together with the triangles on both sides, so that the meshes remain conforming
/// (Rivara). Stops when no triangle is flipped and the piecewise linear map of the finer pair
/// differs from the homeomorphism by at most @a maximumError, in units of the target, at 595 sample
/// points of each triangle. Edges are chosen by the errors measured on them, so triangles become
/// elongated where the map bends in only one direction. Triangles with a height below 0.03 of their
/// longest edge are not elongated further.
///
/// Added points are mapped by the homeomorphism. Those on the boundary are then moved onto its
/// edges, from which they may differ by rounding. @a source and @a target are the meshes from which
/// @a map was made. Triangles are measured in parallel; the result does not depend on the number of
/// threads.
/// @a isAborted is called repeatedly; if it returns true, the refinement stops.
RefinedPair Refine(const Homeomorphism& map, vtkPolyData* source, vtkPolyData* target,
  double maximumError, vtkIdType maximumTriangles, const std::function<bool()>& isAborted);

} // namespace homeomorphism

#endif
