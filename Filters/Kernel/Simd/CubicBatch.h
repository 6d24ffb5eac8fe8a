// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicBatch.h
/// Points of one cubic element, mapped and mapped back in batches.

#ifndef homeomorphism_CubicBatch_h
#define homeomorphism_CubicBatch_h

#include "Kernel/CubicElement.h"

namespace homeomorphism
{

// All arrays have one element per point; l[i] has the barycentric coordinates for corner i.

/// Maps points @a begin to @a end - 1 of the net's element, plus @a origin, to the same bits as
/// CubicNet does. Reads and overwrites up to WidestVector - 1 elements after the last.
void MapByNet(const CubicNet& net, const Vector2& origin, const double* const l[3], int begin,
  int end, double* x, double* y);

/// Maps points of a triangle by the affine map to the triangle @a corners. Sets @a isMiddle where
/// all coordinates are between @a least and @a greatest. Reads and overwrites as MapByNet does.
void MapMiddle(const std::array<Vector2, 3>& corners, const std::array<double, 3>& least,
  const std::array<double, 3>& greatest, const double* const l[3], int begin, int end, double* x,
  double* y, std::int64_t* isMiddle);

/// Points on their way to their preimages in one element after another, as a structure of arrays.
struct CubicWalkers
{
  static constexpr int Capacity = 256;
  static constexpr int Size = Capacity + WidestVector;

  enum State : std::int8_t
  {
    OnTheWay,
    /// Its coordinates are those of the preimage.
    Found,
    /// A step left the element: its coordinates are those of the step's end, outside.
    Left,
    /// The steps do not converge.
    Failed
  };

  /// Where the points are.
  double L[3][Size];
  /// The wanted images, relative to what the net's are relative to.
  double X[Size];
  double Y[Size];
  /// How far the image of the last point was from the wanted one, infinity for none yet, and how
  /// long the last step was, 0 for none yet.
  double Residual[Size];
  double Move[Size];
  /// By how much the last step would have missed without its part of second order, 0 for none yet.
  double SecondOrder[Size];
  std::int64_t States[Size];
};

/// Starts walkers @a begin to @a end - 1 in a net's element: from coordinates of the piecewise
/// linear preimage to those of the inverse's cubic Hermite interpolant, unless it is far away.
void StartByNet(const CubicNet& net, int begin, int end, CubicWalkers& walkers);

/// Chebyshev's method, which is Newton's with second derivatives, for walkers @a begin to @a end -
/// 1, which are on the way in a net's element, until none is. Finds preimages whose images differ
/// by at most @a tolerance. What becomes of a walker does not depend on others.
void WalkByNet(const CubicNet& net, double tolerance, int begin, int end, CubicWalkers& walkers);

} // namespace homeomorphism

#endif
