// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file SmoothChart.h
/// The Smooth coordinate system: twice continuously differentiable across every edge, bijective on
/// any non-degenerate triangle.
///
/// Reference coordinates are barycentric, l = (l_1, l_2, l_3), and the chart of a triangle with
/// corners P_1, P_2, P_3 is
///
///     Phi(l) = l_1 P_1 + l_2 P_2 + l_3 P_3 + D_1 B_1(l) + D_2 B_2(l) + D_3 B_3(l).
///
/// For the edge opposite corner k, with ends i and j: D_k = - a / (a + a*) (P_k + P* - P_i - P_j),
/// where P* is the apex of the neighboring triangle, unfolded about the edge, and a and a* are the
/// two areas; D_k = 0 on the boundary. The function B_k = l_k W(u), u = l_k / (tau_k q),
/// q = l_i l_j / (l_i + l_j), W(u) = (1 - u)^3 (1 + 3 u), lives on the edge's *strip*
/// 0 <= u < 1 alone. The strips of a triangle are disjoint and the chart is affine outside them.
///
/// Why it is C2: on the edge both neighbors' charts have the derivative
/// V = (a* m - a m*) / (a + a*) across it, m and m* being the vectors from the edge's midpoint to
/// the two apexes, and no second derivative but zero, because W'(0) = 0.

#ifndef homeomorphism_SmoothChart_h
#define homeomorphism_SmoothChart_h

#include "CoordinateSystem.h"
#include "Geometry.h"
#include "Kernel/Simd/Vectorize.h"

#include <array>
#include <cstdint>

namespace homeomorphism
{

/// The triangle on the other side of an edge, unfolded into this triangle's plane.
struct Neighbor
{
  /// False on the boundary.
  bool Exists = false;
  /// The neighbor's apex as the shared edge sees it, the edge being run through as in this
  /// triangle (see Reversed).
  EdgeView View;
};

/// What the chart needs to know of an edge's strip. All zero but kappa on the boundary.
struct SmoothStrip
{
  /// The components of D_k along the corners after and before k in cyclic order. The three sum to
  /// 0.
  double OffsetNext = 0.0;
  double OffsetPrevious = 0.0;
  /// kappa = 1 + d_k = 2 a* / (a + a*), kept because 1 + d_k cancels beside a far smaller
  /// neighbor.
  double Kappa = 1.0;
  /// In (0, 1]; 0 on the boundary, where there is no strip.
  double Tau = 0.0;

  SmoothStrip() = default;

  /// @a own is what the edge sees of its triangle, @a neighbor of the one on its other side.
  HOMEOMORPHISM_ALWAYS_INLINE SmoothStrip(const EdgeView& own, const EdgeView& neighbor)
  {
    const double sum = own.Height + neighbor.Height;
    const double ownShare = own.Height / sum;
    const double otherShare = neighbor.Height / sum;
    this->OffsetNext = ownShare * neighbor.Foot - otherShare * (1.0 - own.Foot);
    this->OffsetPrevious = ownShare * (1.0 - neighbor.Foot) - otherShare * own.Foot;
    // The three components sum to 0, which far feet let cancellation spoil: then barycentric
    // coordinates would not sum to 1, and what they lack would be lost on the way back.
    const double excess = this->OffsetNext + this->OffsetPrevious + (otherShare - ownShare);
    this->OffsetNext -= 0.5 * excess;
    this->OffsetPrevious -= 0.5 * excess;
    this->Kappa = 2.0 * otherShare;
    const double least =
      this->OffsetPrevious < this->OffsetNext ? this->OffsetPrevious : this->OffsetNext;
    this->Tau = least < -0.5 ? -0.5 / least : 1.0;
  }

  /// Whether l is in the strip, if it is that of edge k: 0 <= l_k / (tau q) < 1.
  bool Contains(double k, double next, double previous) const
  {
    return k * (next + previous) < this->Tau * next * previous;
  }
};

/// The strips of a triangle's edges; element k belongs to the edge opposite corner k.
using SmoothStrips = std::array<SmoothStrip, 3>;

/// A triangle's strips. views[k] is what the edge opposite corner k sees of this triangle,
/// neighbors[k] what lies on its other side. Both triangles at an edge must be given the same two
/// views of it (one reversed).
SmoothStrips MakeSmoothStrips(const EdgeViews& views, const std::array<Neighbor, 3>& neighbors);

/// Points in arrays, so that the processor can deal with several at once.
struct SmoothBatch
{
  static constexpr int Capacity = 256;
  /// With the room that whole vectors take.
  static constexpr int Size = Capacity + WidestVector;

  /// k, the corner with the least coordinate: only of the edge opposite to it can a strip contain
  /// the point.
  std::int64_t Corner[Size];
  /// The barycentric coordinates with respect to k, the next corner and the previous one: of the
  /// affine chart of the source, then of the reference, then of the affine chart of the target.
  double L[3][Size];
  /// SmoothStrip's numbers in source and target.
  double OffsetNext[2][Size];
  double OffsetPrevious[2][Size];
  double Kappa[2][Size];
  double Tau[2][Size];
};

/// The corner with the least of three barycentric coordinates, the first of equals.
inline int LeastCorner(double first, double second, double third)
{
  const double lesser = second < first ? second : first;
  return third < lesser ? 2 : (second < first ? 1 : 0);
}

/// Puts points of one triangle into the batch from @a begin to before @a end. @a
/// coordinates[corner] points to arrays of the barycentric coordinates of the source's affine
/// chart, one for each lane. Up to WidestVector - 1 batch after the last are spoilt.
void SetSmoothBatch(SmoothBatch& batch, int begin, int end, const double* const coordinates[3],
  const SmoothStrips& source, const SmoothStrips& target);

/// Fills batch with a point that the map leaves where it is.
void FillSmoothBatch(SmoothBatch& batch, int begin, int end);

/// Takes the first @a count points from the source's chart to the target's: to the same bits as
/// SmoothChart's ToReference and ToPoint. Batch up to the next multiple of 32 are filled.
void MapSmoothBatch(SmoothBatch& batch, int count);

/// Takes the coordinates out of the batch, into arrays as in SetSmoothBatch, where they spoil what
/// comes after.
void GetSmoothBatch(const SmoothBatch& batch, int begin, int end, double* const coordinates[3]);

/// The chart of the Smooth system.
class SmoothChart
{
public:
  using Reference = Barycentric;
  using Direction = Barycentric;

  SmoothChart(const TriangleShape& shape, const SmoothStrips& strips)
    : Shape(shape)
    , Strips(strips)
  {
  }

  SmoothChart(
    const TriangleShape& shape, const EdgeViews& views, const std::array<Neighbor, 3>& neighbors)
    : SmoothChart(shape, MakeSmoothStrips(views, neighbors))
  {
  }

  Reference ToReference(const Vector2& point) const;
  Vector2 ToPoint(const Reference& l) const;
  Direction Pullback(const Reference& l, const Vector2& vector) const;
  Vector2 Pushforward(const Reference& l, const Direction& direction) const;

  /// The Contour coordinates, in the equilateral triangle, of the point with the barycentric
  /// coordinates l.
  TriangularCoordinates ToCoordinates(const Reference& l) const;
  Reference FromCoordinates(const TriangularCoordinates& coordinates) const;

  /// The chart's determinant at l over that of the affine chart, positive everywhere:
  /// 1 + d_k K'(u) + 12 tau u^3 (1 - u)^2 (d_i (l_j / (l_i + l_j))^2 + d_j (l_i / (l_i + l_j))^2),
  /// K = u W; d are the barycentric components of D_k.
  double DeterminantRatio(const Reference& l) const;

  /// A lower bound of DeterminantRatio over the triangle, min(2 a* / (a + a*), 0.28) over its
  /// interior edges, 1 if it has none.
  double DeterminantBound() const;

  /// tau of the strip of an edge (0 to 2): in (0, 1], 0 on the boundary, where there is no strip.
  double StripWidth(int edge) const { return this->Strips[edge].Tau; }

private:
  /// The strip that l is in, or -1.
  int StripAt(const Barycentric& l) const;

  TriangleShape Shape;
  SmoothStrips Strips;
};

} // namespace homeomorphism

#endif
