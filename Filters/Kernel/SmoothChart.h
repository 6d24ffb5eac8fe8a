// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file SmoothChart.h
/// The Smooth coordinate system: twice continuously differentiable across every edge, bijective on
/// any non-degenerate triangle.
/// The reference is barycentric, l = (l_1, l_2, l_3). The chart of a triangle with corners P_1,
/// P_2, P_3 is
///
///     Phi(l) = l_1 P_1 + l_2 P_2 + l_3 P_3 + D_1 B_1(l) + D_2 B_2(l) + D_3 B_3(l).
///
/// For the edge opposite corner k with ends i and j, D_k = - a / (a + a*) (P_k + P* - P_i - P_j),
/// where P* is the apex of the adjacent triangle, unfolded about the edge, and a and a* are the two
/// areas. D_k = 0 on the boundary. The function B_k = l_k W(u), u = l_k / (tau_k q), q = l_i l_j /
/// (l_i + l_j), W(u) = (1 - u)^3 (1 + 3 u), vanishes outside the *strip* 0 <= u < 1 of the edge.
/// The strips of a triangle are disjoint, and the chart is affine outside them.
///
/// On the edge, the charts of both triangles have the derivative V = (a* m - a m*) / (a + a*)
/// across it, where m and m* are the vectors from the midpoint of the edge to the two apexes. Their
/// second derivatives vanish there because W'(0) = 0. Hence the map is C2 across the edge. Proofs:
/// Documentation/differentiability.md.

#ifndef homeomorphism_SmoothChart_h
#define homeomorphism_SmoothChart_h

#include "CoordinateSystem.h"
#include "Geometry.h"
#include "Kernel/Simd/Vectorize.h"
#include "StripFunction.h"

#include <array>
#include <cstdint>

namespace homeomorphism
{

/// The twin triangle at an edge, unfolded into the plane of this triangle.
struct Neighbor
{
  /// False on the boundary.
  bool Exists = false;
  /// The view of the twin triangle from the shared edge, with the edge directed as in this triangle
  /// (see Reversed).
  EdgeView View;
};

/// The parameters of the strip of an edge. All are zero on the boundary except Kappa.
struct SmoothStrip
{
  /// Barycentric components of D_k for the corners after and before k in cyclic order. The three
  /// components sum to 0.
  double OffsetNext = 0.0;
  double OffsetPrevious = 0.0;
  /// kappa = 1 + d_k = 2 a* / (a + a*). Stored because 1 + d_k cancels if the neighbor is much
  /// smaller.
  double Kappa = 1.0;
  /// The width tau in (0, 1]; 0 on the boundary, where there is no strip.
  double Tau = 0.0;

  SmoothStrip() = default;

  /// @a own is the view of this triangle from the edge, @a neighbor that of the twin triangle.
  HOMEOMORPHISM_ALWAYS_INLINE SmoothStrip(const EdgeView& own, const EdgeView& neighbor)
  {
    const double sum = own.Height + neighbor.Height;
    const double ownShare = own.Height / sum;
    const double otherShare = neighbor.Height / sum;
    this->OffsetNext = ownShare * neighbor.Foot - otherShare * (1.0 - own.Foot);
    this->OffsetPrevious = ownShare * (1.0 - neighbor.Foot) - otherShare * own.Foot;
    // Restore a sum of 0, which is inexact by cancellation if a foot is far away. Otherwise
    // barycentric coordinates would not sum to 1, and round trips would lose the difference.
    const double excess = this->OffsetNext + this->OffsetPrevious + (otherShare - ownShare);
    this->OffsetNext -= 0.5 * excess;
    this->OffsetPrevious -= 0.5 * excess;
    this->Kappa = 2.0 * otherShare;
    const double least =
      this->OffsetPrevious < this->OffsetNext ? this->OffsetPrevious : this->OffsetNext;
    this->Tau = least < -0.5 ? -0.5 / least : 1.0;
  }

  /// Whether l is in the strip, given that the strip belongs to edge k: 0 <= l_k / (tau q) < 1.
  bool Contains(const CornerCoordinates& l) const
  {
    return l.Own * (l.Next + l.Previous) < this->Tau * l.Next * l.Previous;
  }

  /// B_k at l.
  HOMEOMORPHISM_ALWAYS_INLINE StripFunction<double> GetFunction(const CornerCoordinates& l) const
  {
    return { l.Own, l.Next, l.Previous, this->Tau };
  }

  /// l + @a factor d, with the barycentric components d of D_k.
  HOMEOMORPHISM_ALWAYS_INLINE CornerCoordinates Move(
    const CornerCoordinates& l, double factor) const
  {
    return { l.Own + (this->Kappa - 1.0) * factor, l.Next + this->OffsetNext * factor,
      l.Previous + this->OffsetPrevious * factor };
  }

  /// The sum of the values for three corners times the components of D_k.
  HOMEOMORPHISM_ALWAYS_INLINE double Dot(const CornerCoordinates& values) const
  {
    return (this->Kappa - 1.0) * values.Own +
      (this->OffsetNext * values.Next + this->OffsetPrevious * values.Previous);
  }
};

/// Narrows the strips of an edge of a triangle in both meshes of a pair if images under the Smooth
/// and the piecewise linear map could otherwise differ by more than @a greatest, in the units of
/// @a shape, the target's triangle. Both strips then have the same width, tau. So B_k is the same
/// function in both meshes, and the images differ by at most |D - L D'| max B_k, where D' is the
/// source's offset, D the target's, L the affine map, and max B_k < 4/81 tau.
void LimitDeviation(
  SmoothStrip& source, SmoothStrip& target, int edge, const TriangleShape& shape, double greatest);

/// The strips of the edges of a triangle. Element k belongs to the edge opposite corner k.
using SmoothStrips = std::array<SmoothStrip, 3>;

/// The strips of a triangle, stored at a constant distance from each other.
struct SmoothStripsView
{
  const SmoothStrip* First;
  int Stride;

  const SmoothStrip& operator[](int edge) const { return this->First[edge * this->Stride]; }
  SmoothStrips All() const { return { (*this)[0], (*this)[1], (*this)[2] }; }
};

/// The strips of a triangle. views[k] is the view of this triangle from the edge opposite corner k,
/// neighbors[k] its twin triangle. For both triangles at an edge, the same two views must be passed
/// (one of them reversed).
SmoothStrips MakeSmoothStrips(const EdgeViews& views, const std::array<Neighbor, 3>& neighbors);

/// A SIMD batch of points, as a structure of arrays.
struct SmoothBatch
{
  static constexpr int Capacity = 256;
  /// Capacity rounded up to whole SIMD vectors.
  static constexpr int Size = Capacity + WidestVector;

  /// k, the corner with the least coordinate. Only the strip of the opposite edge can contain the
  /// point.
  std::int64_t Corner[Size];
  /// Barycentric coordinates for k, the next corner and the previous one: first those of the affine
  /// chart of the source, then the reference, then those of the affine chart of the target.
  double L[3][Size];
  /// Members of SmoothStrip, in source and target.
  double OffsetNext[2][Size];
  double OffsetPrevious[2][Size];
  double Kappa[2][Size];
  double Tau[2][Size];
};

/// The corner with the smallest of three barycentric coordinates; the first one of equal ones.
inline int LeastCorner(double first, double second, double third)
{
  const double lesser = second < first ? second : first;
  return third < lesser ? 2 : (second < first ? 1 : 0);
}

/// Sets the points @a begin to @a end - 1 of the batch, which lie in one triangle. @a
/// coordinates[corner] points to arrays of the barycentric coordinates of the affine chart of the
/// source, one per point. Overwrites up to WidestVector - 1 elements after the last.
void SetSmoothBatch(SmoothBatch& batch, int begin, int end, const double* const coordinates[3],
  const SmoothStripsView& source, const SmoothStripsView& target);

/// Fills elements with a point that the map does not move.
void FillSmoothBatch(SmoothBatch& batch, int begin, int end);

/// Maps the first @a count points from the source's chart to the target's. The results are the
/// same, bit for bit, as those of SmoothChart::ToReference and ToPoint. Fills elements up to the
/// next multiple of 32. Copies the references to @a references, in the order of L, unless it is
/// null.
void MapSmoothBatch(SmoothBatch& batch, int count, double (*references)[SmoothBatch::Size]);

/// A point in the affine charts of both triangles, and its reference.
struct SmoothPoint
{
  /// The corner with the least coordinate, to which the others refer.
  int Corner;
  CornerCoordinates Reference;
  CornerCoordinates Image;
};

/// Maps a point of the affine chart of the source. The result is the same, bit for bit, as that of
/// MapSmoothBatch. @a l refers to @a corner, any of the three.
SmoothPoint MapSmoothPoint(int corner, const CornerCoordinates& l, const SmoothStripsView& source,
  const SmoothStripsView& target);

/// The chart of the Smooth system.
class SmoothChart
{
public:
  using Reference = Barycentric;
  /// For the corner with the least coordinate of the reference.
  using Direction = CornerCoordinates;

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

  /// The derivative of the chart is that of the affine chart, times the identity plus a matrix of
  /// rank one in a strip.
  class Differential
  {
  public:
    /// Reads only one of the strips. @a l refers to @a corner, which has the smallest coordinate.
    Differential(const TriangleShape& shape, const SmoothStripsView& strips, int corner,
      const CornerCoordinates& l)
      : Shape(shape)
      , Edge(corner)
      , Strip(strips[corner])
    {
      this->IsInStrip = this->Strip.Contains(l);
      if (!this->IsInStrip)
      {
        return;
      }
      const StripFunction<double> function = this->Strip.GetFunction(l);
      this->Gradient = { 1.0 - function.OneMinusSlope(), function.AlongSides(1.0, 0.0),
        function.AlongSides(0.0, 1.0) };
      this->DeterminantRatio = function.DeterminantRatio(
        this->Strip.Kappa, this->Strip.OffsetNext, this->Strip.OffsetPrevious);
      this->InverseDeterminantRatio = 1.0 / this->DeterminantRatio;
    }
    Direction Pullback(const Vector2& vector) const
    {
      const CornerCoordinates direction = this->Shape.VectorToCornerCoordinates(vector).Turned(
        CornersBetween(this->Shape.Apex, this->Edge));
      // Sherman-Morrison formula.
      return this->IsInStrip
        ? this->Strip.Move(direction, -this->Along(direction) * this->InverseDeterminantRatio)
        : direction;
    }
    Vector2 Pushforward(const Direction& direction) const
    {
      const CornerCoordinates moved =
        (this->IsInStrip ? this->Strip.Move(direction, this->Along(direction)) : direction)
          .Turned(CornersBetween(this->Edge, this->Shape.Apex));
      return this->Shape.ToFrame(moved.Own, moved.Previous);
    }
    /// With the affine derivative A, the offsets D and D' of source and target in the frame of the
    /// target, and the gradients g and g' of B in that of the source, the derivative is A + D'
    /// g'^T - (A D + D' g'^T D) g^T / det.
    friend Matrix2 MapDerivative(const Differential& from, const Differential& to)
    {
      const int toEdge = CornersBetween(to.Shape.Apex, to.Edge);
      const int toApex = CornersBetween(from.Edge, from.Shape.Apex);
      const CornerCoordinates& g = from.Gradient;
      const CornerCoordinates& otherG = to.Gradient;
      const double along = from.Strip.Dot(otherG);
      const auto row = [&](const CornerCoordinates& affine) {
        const double offset = to.Strip.Dot(affine);
        const double back =
          (from.Strip.Dot(affine) + offset * along) * from.InverseDeterminantRatio;
        return from.Shape.GetGradient(
          CornerCoordinates{ affine.Own + (offset * otherG.Own - back * g.Own),
            affine.Next + (offset * otherG.Next - back * g.Next),
            affine.Previous + (offset * otherG.Previous - back * g.Previous) }
            .Turned(toApex));
      };
      return FromRows(row(to.Shape.GetX().Turned(toEdge)), row(to.Shape.GetY().Turned(toEdge)));
    }
    friend double MapDeterminant(const Differential& from, const Differential& to, const Matrix2&)
    {
      return AffineDeterminant(from.Shape, to.Shape) *
        (to.DeterminantRatio * from.InverseDeterminantRatio);
    }
    /// See SmoothChart.
    double GetDeterminantRatio() const { return this->DeterminantRatio; }

  private:
    /// The derivative of B along a direction whose components sum to 0.
    double Along(const CornerCoordinates& direction) const
    {
      return this->Gradient.Own * direction.Own +
        (this->Gradient.Next * direction.Next + this->Gradient.Previous * direction.Previous);
    }

    TriangleShape Shape;
    /// The edge whose strip may contain l, and whether it does.
    int Edge;
    bool IsInStrip;
    SmoothStrip Strip;
    CornerCoordinates Gradient{ 0.0, 0.0, 0.0 };
    double DeterminantRatio = 1.0;
    double InverseDeterminantRatio = 1.0;
  };

  Differential DifferentialAt(const Reference& l) const
  {
    const int corner = LeastCorner(l[0], l[1], l[2]);
    return { this->Shape, { this->Strips.data(), 1 }, corner, CornerCoordinates::From(l, corner) };
  }
  Direction Pullback(const Reference& l, const Vector2& vector) const
  {
    return this->DifferentialAt(l).Pullback(vector);
  }
  Vector2 Pushforward(const Reference& l, const Direction& direction) const
  {
    return this->DifferentialAt(l).Pushforward(direction);
  }

  /// The Contour coordinates of the point of the equilateral triangle with barycentric coordinates
  /// l.
  TriangularCoordinates ToCoordinates(const Reference& l) const;
  Reference FromCoordinates(const TriangularCoordinates& coordinates) const;

  /// The determinant of the chart at l divided by that of the affine chart. Positive everywhere: 1
  /// + d_k K'(u) + 12 tau u^3 (1 - u)^2 (d_i (l_j / (l_i + l_j))^2 + d_j (l_i / (l_i + l_j))^2),
  /// where K = u W and d are the barycentric components of D_k.
  double DeterminantRatio(const Reference& l) const
  {
    return this->DifferentialAt(l).GetDeterminantRatio();
  }

  /// A lower bound of DeterminantRatio over the triangle: the least min(2 a* / (a + a*), 0.28) over
  /// its interior edges, 1 if it has none.
  double DeterminantBound() const;

  /// The width tau of the strip of an edge (0 to 2), in (0, 1]; 0 on the boundary.
  double StripWidth(int edge) const { return this->Strips[edge].Tau; }

private:
  TriangleShape Shape;
  SmoothStrips Strips;
};

static_assert(IsChart<SmoothChart>::value, "See CoordinateSystem.h");

} // namespace homeomorphism

#endif
