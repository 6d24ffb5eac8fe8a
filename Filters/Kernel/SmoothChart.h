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
/// where P* is the apex of the neighbouring triangle, unfolded about the edge, and a and a* are the
/// two areas; D_k = 0 on the boundary. The function B_k = l_k W(u), u = l_k / (tau_k q),
/// q = l_i l_j / (l_i + l_j), W(u) = (1 - u)^3 (1 + 3 u), lives on the edge's *strip*
/// 0 <= u < 1 alone. The strips of a triangle are disjoint and the chart is affine outside them.
///
/// Why it is C2: on the edge both neighbours' charts have the derivative
/// V = (a* m - a m*) / (a + a*) across it, m and m* being the vectors from the edge's midpoint to
/// the two apexes, and no second derivative but zero, because W'(0) = 0.

#ifndef homeomorphism_SmoothChart_h
#define homeomorphism_SmoothChart_h

#include "CoordinateSystem.h"
#include "Geometry.h"

#include <array>

namespace homeomorphism
{

/// The triangle on the other side of an edge, unfolded into this triangle's plane.
struct Neighbor
{
  /// False on the boundary.
  bool Exists = false;
  /// The neighbour's apex as the shared edge sees it, the edge being run through as in this triangle
  /// (see Reversed).
  EdgeView View;
};

/// The chart of the Smooth system.
class SmoothChart
{
public:
  using Reference = Barycentric;
  using Direction = Barycentric;

  /// views[k] is what the edge opposite corner k sees of this triangle, neighbors[k] what lies on its
  /// other side. Both triangles at an edge must be given the same two views of it (one reversed).
  SmoothChart(const TriangleShape& shape, const EdgeViews& views,
    const std::array<Neighbor, 3>& neighbors);

  Reference ToReference(const Vector2& point) const;
  Vector2 ToPoint(const Reference& l) const;
  Direction Pull(const Reference& l, const Vector2& vector) const;
  Vector2 Push(const Reference& l, const Direction& direction) const;

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
  struct Strip
  {
    Barycentric Offset{}; ///< d, the components of D_k along the corners; they sum to 0
    /// kappa = 1 + d_k = 2 a* / (a + a*), kept because 1 + d_k cancels beside a far smaller neighbour.
    double Kappa = 1.0;
    double Tau = 0.0;
  };

  class StripFunction;

  /// The strip that l is in, or -1.
  int StripAt(const Barycentric& l) const;

  TriangleShape Shape;
  std::array<Strip, 3> Strips;
};

} // namespace homeomorphism

#endif
