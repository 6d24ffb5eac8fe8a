// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MapStatistics.h
/// Statistics of the homeomorphism of a pair in one coordinate system, from samples.

#ifndef homeomorphism_MapStatistics_h
#define homeomorphism_MapStatistics_h

#include "PairStatistics.h"

#include "Mesh/Homeomorphism.h"

#include "vtkType.h"

#include <limits>
#include <vector>

namespace homeomorphism
{

/// The Jacobian determinant of a map and its distance from the piecewise linear map, at points that
/// are evenly distributed in each triangle: 105 points, or fewer (at least one) if that were more
/// than two million in total.
struct MapSamples
{
  /// For each triangle, the smallest and the largest determinant, and the largest distance between
  /// the images of a point under this map and under the Linear map, in the target's units. NaN for
  /// masked triangles. Determinants are positive where the map has the orientation of the pair.
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

/// Samples a map; @a linear is the Linear map of the same meshes. Runs in parallel; the result does
/// not depend on the number of threads.
MapSamples SampleMap(const Homeomorphism& map, const Homeomorphism& linear);

/// A measure of bending at a finite distance. The second differences
///
///     (f(x + h u) + f(x - h u) - 2 f(x)) / h^2
///
/// with h a tenth of the source's mean edge length, in three unit directions u at 60 degrees to
/// each other, determine a quadratic function. The measure is the norm (root of the sum of squares)
/// of its Hessian, with lengths in mean edge lengths of source and target.
struct SecondDifference
{
  /// The root mean square over the samples, NaN if there is none. Dimensionless; 0 for affine maps.
  double RootMeanSquare = std::numeric_limits<double>::quiet_NaN();
  vtkIdType Samples = 0;
};

/// Measures second differences at points that are distributed uniformly over the source, the same
/// ones in every run: 16 per triangle, but at least 50,000 and at most a million. Points x for
/// which x + h u or x - h u is outside the domain are left out. Planar pairs only; otherwise there
/// are no samples. Runs in parallel; the result does not depend on the number of threads.
SecondDifference MeasureSecondDifference(
  const Homeomorphism& map, double meanSourceEdge, double meanTargetEdge);

} // namespace homeomorphism

#endif
