// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ContourChart.h
/// The Contour coordinate system: the published construction ("Constructing Differentiable
/// Homeomorphisms between Isomorphic Triangulations").
///
/// From the triangle's center G the three *center segments* drop perpendicularly to the edges. Six
/// *wing segments* join each corner to the midpoints of the two center segments beside it. A
/// *contour* starts at G as a straight segment; where it meets a wing segment it turns tangentially
/// into a circular arc, which meets the edge at a right angle. The triangle is covered once by its
/// contours if the feet of the center segments lie strictly inside the edges (a *concordant*
/// triangle, see IsConcordant).

#ifndef homeomorphism_ContourChart_h
#define homeomorphism_ContourChart_h

#include "CoordinateSystem.h"
#include "Geometry.h"

#include <array>

namespace homeomorphism
{

/// From where the contours of a triangle start.
enum class CenterPoint
{
  /// The publication's choice. Discordant triangles exist.
  Centroid = 0,
  /// The center of the inscribed circle: its feet are the circle's points of tangency, so every
  /// triangle is concordant.
  Incenter = 1
};

/// The chart of the Contour system. Its reference is (e, p, c) itself. The triangle should be
/// concordant with respect to the center; if a foot lies outside its edge, the half edge on that
/// side is taken as shrunk to (almost) nothing.
class ContourChart
{
public:
  using Reference = TriangularCoordinates;
  /// A tangent vector of the reference: x = change of c, y = c times change of p, which stays
  /// finite at the center, where c = 0 and p has no meaning.
  using Direction = Vector2;

  explicit ContourChart(
    const TriangleShape& shape, const EdgeViews& views, CenterPoint center = CenterPoint::Centroid);

  Reference ToReference(const Vector2& point) const;
  Vector2 ToPoint(const Reference& coordinates) const;

  /// At the center, where the map is not differentiable, the limits are those along the contour
  /// that the reference names.
  Direction Pullback(const Reference& coordinates, const Vector2& vector) const;
  Vector2 Pushforward(const Reference& coordinates, const Direction& direction) const;

  TriangularCoordinates ToCoordinates(const Reference& coordinates) const { return coordinates; }
  Reference FromCoordinates(const TriangularCoordinates& coordinates) const { return coordinates; }

  /// The images of points under the homeomorphism from triangles with charts @a from to those with
  /// charts
  /// @a to, at most 256 at once, in a fraction of the time of ToReference and ToPoint, to the same
  /// bits.
  static void MapPoints(
    const ContourChart* const* from, const ContourChart* const* to, Vector2* points, int count);

  /// Length of the contour that ends on an edge (1 to 3) at p, and its derivative with respect to p
  /// (not the edge's length). The jump of the homeomorphism's Jacobian across an edge follows from
  /// it in closed form.
  double ContourLength(int edge, double p) const;
  double ContourLengthDerivative(int edge, double p) const;

  /// The center from which the contours start.
  Vector2 Center() const;
  /// The foot of the center segment on an edge (1 to 3).
  Vector2 Foot(int edge) const;

  /// The chart of the equilateral triangle with base 1, whose contours the Smooth system carries
  /// over to all triangles.
  static const ContourChart& Equilateral();
  static const TriangleShape& EquilateralShape();

private:
  /// An edge as the center segment on it sees it.
  struct Edge
  {
    Vector2 Start;   ///< the next corner, where p = 0
    Vector2 Tangent; ///< unit vector towards p = 1; the triangle is to its left
    double Length;
    double CenterHeight; ///< h
    double FootDistance; ///< of the foot from Start
  };

  /// One half of an edge, and the place in it of the contour that ends at p.
  struct Half
  {
    double Side; ///< 1 if the half runs along the tangent, -1 if against it
    double Length;
    double EdgePoint; ///< distance of the contour's end from the foot
  };

  /// A point in the frame of its half edge, and the number s of its contour, which takes an
  /// equation to find unless the point is on the contour's straight piece.
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

  /// The half edge at which a contour ends, and its equation: E(s) / b = Proportion.
  struct Ending
  {
    Half AtEdge;
    double Flatness; ///< 2 b / h
    double Proportion;
  };

  Search StartSearch(const Vector2& pointInFrame) const;
  Reference EndSearch(const Search& search) const;
  Ending EndingOf(const Reference& coordinates) const;
  Vector2 PointOn(const Reference& coordinates, const Half& half, double s) const;
  Half HalfAt(const Edge& edge, double p) const;
  Matrix2 Columns(const Reference& coordinates) const;

  /// A power of two near the triangle's size, in which all lengths below are measured, so that
  /// their products neither underflow nor overflow.
  double Unit;
  TriangleShape Shape;
  Barycentric CenterWeights;
  std::array<Edge, 3> Edges;
};

} // namespace homeomorphism

#endif
