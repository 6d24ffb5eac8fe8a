// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file VertexGradient.h
/// The derivative of the cubic template at a vertex, certified in the corners there; and the rings
/// around vertices at which a derivative can be certified only after a deformation. See
/// Documentation/cubic.md.

#ifndef homeomorphism_VertexGradient_h
#define homeomorphism_VertexGradient_h

#include "Kernel/CubicElement.h"

#include <array>
#include <vector>

namespace homeomorphism
{

/// A triangle's corner at a vertex, relative to the vertex: two edge points at the same distance
/// from it, and two inner points above them, perpendicular to the edges.
struct FanSector
{
  Vector2 Start;
  Vector2 InnerStart;
  Vector2 InnerEnd;
  Vector2 End;
  /// The piecewise linear map's derivative.
  Matrix2 Affine;
  /// The distance of the edge points from the vertex, and for the first and the last edge its
  /// direction from the vertex, and the height of the inner point above it.
  double Radius = 0.0;
  std::array<Vector2, 2> Along = {};
  std::array<double, 2> Heights = {};
};

/// The corners at a vertex, counterclockwise. Open at a boundary vertex.
struct VertexFan
{
  std::vector<FanSector> Sectors;
  bool Closed = true;
  /// At a boundary vertex: whether the boundary is straight there in both meshes. If false, it is
  /// straight in neither, and both angles are less than a half turn, or both are greater.
  bool Straight = false;
};

/// A derivative at a vertex.
struct VertexDerivative
{
  Matrix2 Derivative;
  /// The smallest Bernstein coefficient of the determinant in the corners at the vertex, divided by
  /// the affine determinant of the sector. The derivative is certified if it is positive.
  double Margin = -1.0;
};

/// The det-harmonic mean of the derivatives of two sectors: the derivative on the ray between them.
Matrix2 HarmonicMean(const Matrix2& a, const Matrix2& b);

/// A linear map with a positive determinant that maps the boundary directions of an open fan to
/// those of their images and is close to the piecewise linear map.
Matrix2 FitBoundary(const VertexFan& fan);

/// The derivatives on the rays of a fan: det-harmonic means, and at the ends of an open fan the
/// derivative of the sector. Ray i is the first ray of sector i.
std::vector<Matrix2> GetRayGradients(const VertexFan& fan);

/// The three elements of a sector: (vertex, Start, InnerStart), (vertex, InnerStart, InnerEnd),
/// (vertex, InnerEnd, End).
std::array<CubicElement, 3> GetCornerElements(const FanSector& sector, const Matrix2& derivative,
  const Matrix2& startGradient, const Matrix2& endGradient);

/// The smallest coefficient in the elements of GetCornerElements, divided by the affine determinant
/// of the sector, minus a bound on its rounding error. Stops when it falls to @a least.
double GetFanMargin(const VertexFan& fan, const std::vector<Matrix2>& rayGradients,
  const Matrix2& derivative, double least = -1.0);

/// The derivative with the largest margin found: a linear map that fits the piecewise linear map,
/// unscaled or scaled down, or otherwise the solution of a linear program. Its operator norm is at
/// most that of the sectors' derivatives. If the margin is not positive, rings are needed.
VertexDerivative FindVertexDerivative(const VertexFan& fan);

/// Concentric rings in which the piecewise linear star is deformed to a star that has a certified
/// derivative. Ring j lies between the outlines at Ratio^j and Ratio^(j+1) times the fan's points.
struct VertexRings
{
  static constexpr double Ratio = 0.5;

  /// The data of an outline (number 0 is that of the fan itself): for each sector, the derivative
  /// of the piecewise linear star and the map's derivatives at the inner points; and the map's
  /// derivatives on the rays.
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

/// The six elements of a sector between two outlines, at the scale of the outer one: two along the
/// first ray of the sector, two in the middle, two along its last ray.
std::array<CubicElement, 6> GetRingElements(const VertexFan& fan, const VertexRings::Outline& outer,
  const VertexRings::Outline& inner, int sector);

/// Finds rings whose elements are all certified. If there are none that doubles can represent near
/// the vertex, returns false and leaves no outlines.
bool FindVertexRings(const VertexFan& fan, VertexRings& rings);

/// The outline of a star that is the same at every scale: an infinite sequence of rings, for a
/// vertex without a derivative.
VertexRings::Outline GetHomogeneousOutline(const VertexFan& fan);

} // namespace homeomorphism

#endif
