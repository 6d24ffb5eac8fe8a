// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MapStatistics.h
/// Numbers about the homeomorphism of a pair in one coordinate system, from samples.

#ifndef homeomorphism_MapStatistics_h
#define homeomorphism_MapStatistics_h

#include "PairStatistics.h"

#include "Mesh/Homeomorphism.h"

#include "vtkType.h"

#include <limits>
#include <vector>

namespace homeomorphism
{

/// The Jacobian determinant of a map and its distance from the piecewise linear map, at points
/// evenly spread in each triangle: 105 of them, fewer if that were more than two million in all,
/// at least one.
struct MapSamples
{
  /// For each triangle, the least and the greatest determinant, and the largest distance of a
  /// point's image from that by the Linear system, in the target's units. NaN for triangles that
  /// are masked. Determinants are positive where the map has the orientation of the pair.
  std::vector<double> SmallestDeterminants;
  std::vector<double> LargestDeterminants;
  std::vector<double> Deviations;
  Extreme SmallestDeterminant;
  Extreme LargestDeterminant;
  Extreme LargestDeviation;
  /// The point of the source at which the deviation is largest.
  Vector3 DeviationPoint{};
  vtkIdType Samples = 0;
  /// Samples whose determinant is not positive.
  vtkIdType NotPositive = 0;
};

/// Samples a map; @a linear is the Linear map of the same meshes. In parallel; the result does not
/// depend on the number of threads.
MapSamples SampleMap(const Homeomorphism& map, const Homeomorphism& linear);

/// How much a map bends at a finite distance. Its second differences
///
///     (f(x + h u) + f(x - h u) - 2 f(x)) / h^2
///
/// with h a tenth of the source's mean edge length, in three unit directions u at 60 degrees to
/// each other, are those of one quadratic function, whose Hessian's norm (root of the sum of
/// squares) is taken, with lengths in mean edge lengths of source and target.
struct SecondDifference
{
  /// The root mean square over the samples, NaN if there is none. Dimensionless; 0 for affine maps.
  double RootMeanSquare = std::numeric_limits<double>::quiet_NaN();
  vtkIdType Samples = 0;
};

/// Measures second differences at points uniform in the source's area, always the same ones: 16 for
/// each triangle, at least 50,000 and at most a million. Points whose neighbors are outside the
/// domain are left out. Planar pairs only; no samples otherwise. In parallel; the result does not
/// depend on the number of threads.
SecondDifference MeasureSecondDifference(
  const Homeomorphism& map, double meanSourceEdge, double meanTargetEdge);

} // namespace homeomorphism

#endif
