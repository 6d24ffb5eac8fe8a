// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicBatch.h
/// Images and preimages of points of one cubic element, in batches.

#ifndef homeomorphism_CubicBatch_h
#define homeomorphism_CubicBatch_h

#include "Kernel/CubicElement.h"

namespace homeomorphism
{

// All arrays have one element per point; l[i] contains the barycentric coordinates for corner i.

/// Maps points @a begin to @a end - 1 of the net's element and adds @a origin. The results are the
/// same, bit for bit, as those of CubicNet. Reads and overwrites up to WidestVector - 1 elements
/// after the last.
void MapByNet(const CubicNet& net, const Vector2& origin, const double* const l[3], int begin,
  int end, double* x, double* y);

/// Maps points of a triangle by the affine map to the triangle @a corners. Sets @a isMiddle where
/// all coordinates are between @a least and @a greatest. Reads and overwrites as MapByNet does.
void MapMiddle(const std::array<Vector2, 3>& corners, const std::array<double, 3>& least,
  const std::array<double, 3>& greatest, const double* const l[3], int begin, int end, double* x,
  double* y, std::int64_t* isMiddle);

/// Points that are iterated towards preimages, in one element after another, as a structure of
/// arrays.
struct CubicWalkers
{
  static constexpr int Capacity = 256;
  static constexpr int Size = Capacity + WidestVector;

  enum State : std::int8_t
  {
    OnTheWay,
    /// The coordinates are those of the preimage.
    Found,
    /// A step left the element; the coordinates are those of the end of the step, outside.
    Left,
    /// The steps do not converge.
    Failed
  };

  /// Barycentric coordinates of the points.
  double L[3][Size];
  /// The images whose preimages are computed, relative to the same origin as those of the net.
  double X[Size];
  double Y[Size];
  /// The distance of the last point's image from the given image (infinity before the first step),
  /// and the length of the last step (0 before the first step).
  double Residual[Size];
  double Move[Size];
  /// The residual that the last step would have left without its second-order part, 0 before the
  /// first step.
  double SecondOrder[Size];
  std::int64_t States[Size];
};

/// Moves walkers @a begin to @a end - 1 in a net's element from the preimage under the piecewise
/// linear map to the value of the inverse's cubic Hermite interpolant, unless that is far away.
void StartByNet(const CubicNet& net, int begin, int end, CubicWalkers& walkers);

/// Iterates walkers @a begin to @a end - 1 in a net's element by Chebyshev's method (Newton's
/// method with second derivatives) until none is OnTheWay. Accepts preimages whose images differ
/// from the given ones by at most @a tolerance. The result of a walker does not depend on the
/// others.
void WalkByNet(const CubicNet& net, double tolerance, int begin, int end, CubicWalkers& walkers);

} // namespace homeomorphism

#endif
