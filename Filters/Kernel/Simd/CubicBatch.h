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

/// Maps @a count points by the affine map to the triangle @a corners, of which corner 0 is the
/// origin, and adds @a origin. Overwrites no elements after the last.
void MapByCorners(const std::array<Vector2, 3>& corners, const Vector2& origin,
  const double* const l[3], int count, double* x, double* y);

/// An approximation of the inverse of an element, from which the iterations start: a quartic
/// polynomial with the inverse's values and derivatives at the corners, and nearly with its values
/// at the images of the middles of the edges and of the centroid.
struct InverseInterpolant
{
  /// Coefficients for one of the source's barycentric coordinates. Element i of Next and Previous
  /// belongs to corner i, that of Edge to the edge opposite corner i.
  template <typename Real>
  struct Component
  {
    Real Next[3];
    Real Previous[3];
    Real Edge[3];
    Real Middle;
  };

  InverseInterpolant() = default;
  explicit InverseInterpolant(const CubicNet& net);

  /// For corners 1 and 2.
  Component<float> Components[2];
};

/// Points that are iterated towards preimages, as a structure of arrays.
struct CubicWalkers
{
  static constexpr int Size = 512;

  enum State : std::int8_t
  {
    OnTheWay,
    /// The coordinates are those of the preimage.
    Found,
    /// A step left the element; the coordinates are those of the end of the step, outside.
    Left,
    /// The steps do not converge; the coordinates are arbitrary, perhaps NaN.
    Failed
  };

  /// Barycentric coordinates of the points.
  double L[3][Size];
  /// The images whose preimages are computed, relative to the same origin as those of the net.
  double X[Size];
  double Y[Size];
  std::int64_t States[Size];
};

/// Walkers in one element. The elements of the arrays up to the next multiple of WidestVector
/// belong to the run, too; their state is Found.
struct CubicRun
{
  const CubicNet* Net;
  /// A multiple of WidestVector.
  int Begin;
  int End;
  /// Whether all are Found.
  bool AreFound;
};

/// Sets @a count walkers of an element from @a begin on: to the value of the inverse's interpolant,
/// or to the preimage under the piecewise linear map where that is far away. @a l are the
/// barycentric coordinates of the images in the target's triangle; @a x and @a y minus @a origin
/// are relative to the same origin as the net. The walkers are OnTheWay, or Left if they are
/// outside the element. Returns whether all are inside. Reads and overwrites up to WidestVector - 1
/// elements after the last.
bool StartWalkers(const InverseInterpolant& inverse, const Vector2& origin,
  const double* const l[3], const double* x, const double* y, int count, int begin,
  CubicWalkers& walkers);

/// Iterates walkers that are OnTheWay by Newton's method with corrections of higher order, until
/// none is. Accepts preimages whose images differ from the given ones by at most @a tolerance. The
/// result of a walker does not depend on the others.
void IterateWalkers(CubicRun* runs, int numberOfRuns, double tolerance, CubicWalkers& walkers);

} // namespace homeomorphism

#endif
