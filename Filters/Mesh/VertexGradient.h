// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file VertexGradient.h
/// The derivative of the cubic template at a vertex, certified in the vertex's corners, and the
/// rings that lead to it where no derivative can be certified at once.

#ifndef homeomorphism_VertexGradient_h
#define homeomorphism_VertexGradient_h

#include "Kernel/CubicElement.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// A triangle's corner at a vertex, relative to the vertex: two edge points at equal distance, and
/// above them, at right angles to the edges, two inner points.
struct FanSector
{
  Vector2 Start;
  Vector2 InnerStart;
  Vector2 InnerEnd;
  Vector2 End;
  /// The piecewise linear map's derivative.
  Matrix2 Affine;
  /// The edge points' distance from the vertex, and of the first and the last edge the direction in
  /// which it leaves the vertex and the height of the inner point above it.
  double Radius = 0.0;
  std::array<Vector2, 2> Along = {};
  std::array<double, 2> Heights = {};
};

/// The corners at a vertex, counterclockwise. Open at a boundary vertex.
struct VertexFan
{
  std::vector<FanSector> Sectors;
  bool Closed = true;
  /// At a boundary vertex: whether the boundary is straight there in both meshes (or, false, in
  /// neither, with both angles below or both above a half turn).
  bool Straight = false;
};

/// A derivative at a vertex.
struct VertexDerivative
{
  Matrix2 Derivative;
  /// The least Bernstein coefficient of the determinant in the vertex's corners over the sector's
  /// affine determinant. The derivative is certified if it is positive.
  double Margin = -1.0;
};

/// det J's derivative on the ray between two sectors: their det-harmonic mean.
Matrix2 HarmonicMean(const Matrix2& a, const Matrix2& b);

/// A linear map with positive determinant that takes the boundary directions of an open fan to
/// those of their images and is close to the piecewise linear map.
Matrix2 FitBoundary(const VertexFan& fan);

/// The derivatives on the rays of a fan: det-harmonic means; at the ends of an open fan the
/// sector's own. Element i lies before sector i.
std::vector<Matrix2> GetRayGradients(const VertexFan& fan);

/// The three elements of a sector: (vertex, Start, InnerStart), (vertex, InnerStart, InnerEnd),
/// (vertex, InnerEnd, End).
std::array<CubicElement, 3> GetCornerElements(const FanSector& sector, const Matrix2& derivative,
  const Matrix2& startGradient, const Matrix2& endGradient);

/// The least coefficient over the sector's affine determinant, less what rounding may have done, as
/// GetCornerElements give it. Stops when it falls to @a least.
double GetFanMargin(const VertexFan& fan, const std::vector<Matrix2>& rayGradients,
  const Matrix2& derivative, double least = -1.0);

/// The derivative with the greatest margin that is found: a fit of the piecewise linear map by a
/// linear one, as it is and scaled down, or else the solution of a linear program. Its operator
/// norm is at most that of the sectors' derivatives. Unless the margin is positive, rings are
/// needed.
VertexDerivative FindVertexDerivative(const VertexFan& fan);

/// Concentric rings that lead from the piecewise linear star to one that has a certified
/// derivative. Ring j lies between the outlines at Ratio^j and Ratio^(j+1) times the fan's points.
struct VertexRings
{
  static constexpr double Ratio = 0.5;

  /// Of each outline, from the fan's own at 0: the derivative of the piecewise linear star in each
  /// sector, the map's derivative at the sector's inner points and on the rays.
  struct Outline
  {
    std::vector<Matrix2> Affine;
    std::vector<Matrix2> InnerStart;
    std::vector<Matrix2> InnerEnd;
    std::vector<Matrix2> Rays;
  };
  std::vector<Outline> Outlines;
  VertexDerivative Center;

  int GetNumberOfRings() const { return static_cast<int>(this->Outlines.size()) - 1; }
};

/// The six elements of a sector between two outlines, in the scale of the outer one: two beside the
/// sector's first ray, two in the middle, two beside its last ray.
std::array<CubicElement, 6> GetRingElements(const VertexFan& fan, const VertexRings::Outline& outer,
  const VertexRings::Outline& inner, int sector);

/// Finds rings whose elements are all certified. Returns false if there are none that doubles can
/// represent beside the vertex; then there are no outlines.
bool FindVertexRings(const VertexFan& fan, VertexRings& rings);

/// The outline of a star that is the same at every scale: rings without end, for a vertex at which
/// no derivative exists.
VertexRings::Outline GetHomogeneousOutline(const VertexFan& fan);

} // namespace homeomorphism

#endif
