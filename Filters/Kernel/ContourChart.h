// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ContourChart.h
/// The Contour coordinate system: the construction published in "Constructing Differentiable
/// Homeomorphisms between Isomorphic Triangulations".
///
/// Three *center segments* are the perpendiculars from the center G of the triangle to the edges.
/// Six *wing segments* join each corner to the midpoints of the two adjacent center segments. A
/// *contour* starts at G as a straight segment. Where it meets a wing segment, it continues
/// tangentially as a circular arc that meets the edge at a right angle. The contours cover the
/// triangle once if the feet of the center segments lie strictly inside the edges (a *concordant*
/// triangle, see IsConcordant).

#ifndef homeomorphism_ContourChart_h
#define homeomorphism_ContourChart_h

#include "CoordinateSystem.h"
#include "Geometry.h"

#include <array>

namespace homeomorphism
{

/// The point from which the contours of a triangle start.
enum class CenterPoint
{
  /// The centroid, as published. Triangles may be discordant.
  Centroid = 0,
  /// The center of the inscribed circle. Its feet are the points where the circle touches the
  /// edges, so every triangle is concordant.
  Incenter = 1
};

/// The chart of the Contour system. The reference is (e, p, c). The triangle should be concordant
/// with respect to the center. If a foot lies outside its edge, the half edge on that side is
/// replaced by one of almost zero length.
class ContourChart
{
public:
  using Reference = TriangularCoordinates;
  /// A tangent vector of the reference: x is the change of c, y is c times the change of p. It
  /// stays finite at the center, where c = 0 and p is undefined.
  using Direction = Vector2;

  explicit ContourChart(
    const TriangleShape& shape, const EdgeViews& views, CenterPoint center = CenterPoint::Centroid);

  Reference ToReference(const Vector2& point) const;
  Vector2 ToPoint(const Reference& coordinates) const;

  /// The derivatives of ToReference and ToPoint. At the center, where the map is not
  /// differentiable, they are the limits along the contour given by the reference.
  class Differential
  {
  public:
    Differential(const Matrix2& columns, double unit)
      : Columns(columns)
      , Unit(unit)
    {
    }
    Direction Pullback(const Vector2& vector) const;
    Vector2 Pushforward(const Direction& direction) const;

  private:
    /// The images of the two unit directions of the reference, in units of Unit.
    Matrix2 Columns;
    double Unit;
  };

  Differential DifferentialAt(const Reference& coordinates) const;
  Direction Pullback(const Reference& coordinates, const Vector2& vector) const
  {
    return this->DifferentialAt(coordinates).Pullback(vector);
  }
  Vector2 Pushforward(const Reference& coordinates, const Direction& direction) const
  {
    return this->DifferentialAt(coordinates).Pushforward(direction);
  }

  TriangularCoordinates ToCoordinates(const Reference& coordinates) const { return coordinates; }
  Reference FromCoordinates(const TriangularCoordinates& coordinates) const { return coordinates; }

  /// Replaces at most 256 points by their images under the homeomorphism from the triangles with
  /// the charts @a from to those with the charts @a to. The results are the same, bit for bit, as
  /// those of ToReference and ToPoint, in a fraction of the time.
  static void MapPoints(
    const ContourChart* const* from, const ContourChart* const* to, Vector2* points, int count);

  /// See CoordinateSystem.h.
  static MappedPoint<ContourChart> MapWithDerivatives(
    const ContourChart& from, const ContourChart& to, const Vector2& point);

  /// The point at which the contours start.
  Vector2 Center() const;
  /// The foot of the center segment on an edge (1 to 3).
  Vector2 Foot(int edge) const;

  /// The chart of the equilateral triangle with base 1. The Smooth system maps its contours to all
  /// triangles.
  static const ContourChart& Equilateral();
  static const TriangleShape& EquilateralShape();

private:
  /// An edge and its center segment.
  struct Edge
  {
    Vector2 Start;   ///< the next corner, where p = 0
    Vector2 Tangent; ///< unit vector towards p = 1; the triangle lies to its left
    double Length;
    double CenterHeight; ///< h
    double FootDistance; ///< distance of the foot from Start
  };

  /// One half of an edge, and the end of a contour in it.
  struct Half
  {
    double Side; ///< 1 if the half extends along the tangent, -1 if against it
    double Length;
    double EdgePoint; ///< distance of the end of the contour from the foot
  };

  /// A point in the frame of its half edge, and the parameter s of its contour. Unless the point
  /// lies on the straight piece of its contour, s is the root of an equation.
  struct Search
  {
    int EdgeLabel; ///< 0 for the center
    double Side;
    double Height; ///< h
    double Length; ///< b
    double X;
    double Y;
    bool IsStraight;
    double S;
  };

  /// The half edge at which a contour ends, and the equation of the contour: E(s) / b = Proportion.
  struct Ending
  {
    Half AtEdge;
    double Flatness; ///< 2 b / h
    double Proportion;
  };

  Search StartSearch(const Vector2& pointInFrame) const;
  /// StartSearch, followed by the solution of the equation.
  Search Find(const Vector2& pointInFrame) const;
  Reference EndSearch(const Search& search) const;
  Ending EndingOf(const Reference& coordinates) const;
  Vector2 PointOn(const Reference& coordinates, const Half& half, double s) const;
  Half HalfAt(const Edge& edge, double p) const;
  Differential DifferentialOn(const Reference& coordinates, const Half& half, double s) const;

  /// The unit of length of all members below: a power of two near the size of the triangle, so that
  /// products neither underflow nor overflow.
  double Unit;
  TriangleShape Shape;
  Barycentric CenterWeights;
  std::array<Edge, 3> Edges;
};

static_assert(IsChart<ContourChart>::value, "See CoordinateSystem.h");

inline MappedPoint<ContourChart> MapWithDerivatives(
  const ContourChart& from, const ContourChart& to, const Vector2& point)
{
  return ContourChart::MapWithDerivatives(from, to, point);
}

} // namespace homeomorphism

#endif
