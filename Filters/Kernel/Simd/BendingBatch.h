// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file BendingBatch.h
/// The bending of many cubic elements as quadratic functions of the derivatives at their corners.

#ifndef homeomorphism_BendingBatch_h
#define homeomorphism_BendingBatch_h

#include "Kernel/CubicElement.h"

namespace homeomorphism
{

/// The rows and columns of GetBendingMatrix that belong to derivatives, for Size triangles.
struct BendingBatch
{
  static constexpr int Size = 4 * WidestVector;

  /// Corners 1 and 2 relative to corner 0: x and y.
  double Corners[2][2][Size];
  /// At corner i: xx, xy, yy.
  double Diagonal[3][3][Size];
  /// Rows of the start of edge k, columns of its end: xx, xy, yx, yy.
  double Edge[3][4][Size];

  void SetCorners(int number, const std::array<Vector2, 3>& points);

  /// Sets Diagonal and Edge from Corners.
  void SetMatrices();
};

} // namespace homeomorphism

#endif
