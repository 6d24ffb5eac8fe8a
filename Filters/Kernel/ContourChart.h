// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ContourChart.h
/// The Contour coordinate system: the published construction ("Constructing Differentiable
/// Homeomorphisms between Isomorphic Triangulations").
///
/// From the triangle's centre G the three *center segments* drop perpendicularly to the edges. Six
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
  /// The centre of the inscribed circle: its feet are the circle's points of tangency, so every
  /// triangle is concordant.
  Incenter = 1
};

/// What of a contour depends on its number s alone, in one half of an edge. The half is seen in the
/// frame with the foot of the center segment at the origin, the centre at (0, h) and the corner at
/// (b, 0); its contours are numbered by s from 0, the center segment, to 1, the segment from the
/// centre to the corner. The contour meets the wing segment at (b s, h (1 - s) / 2). This much is cheap
/// and finds s.
struct ArcOfHalf
{
  /// Twice the length of the straight piece: R = sqrt(h^2 (1 + s)^2 + 4 b^2 s^2).
  double R;
  /// 1 / r = 4 b s / (h (1 - s) R), the curvature of the arc; infinite at the corner.
  double Curvature;
  /// E = b s (1 + h (1 - s) / (R + h (1 + s))), where the contour meets the edge.
  double EdgePoint;

  ArcOfHalf(double h, double b, double s);
};

/// The contour's lengths besides.
struct ContourOfHalf : ArcOfHalf
{
  /// tan(phi) = 2 b s / (h (1 + s)), phi being the angle by which the arc turns.
  double Slope;
  /// Length of the arc, r phi = (R / 2) ((1 - s) / (1 + s)) atan(tan phi) / tan phi.
  double ArcLength;
  /// L = R / 2 + r phi, the length of the contour.
  double Length;

  ContourOfHalf(double h, double b, double s);
};

/// Derivatives of an arc's numbers with respect to s.
struct ArcOfHalfDerivative
{
  double R;
  double Curvature; ///< infinite at the corner
  double EdgePoint; ///< between b / 2 and 3 b / 2

  ArcOfHalfDerivative(double h, double b, double s, const ArcOfHalf& arc);
};

/// Derivatives of a contour's numbers with respect to s.
struct ContourOfHalfDerivative : ArcOfHalfDerivative
{
  double Angle;  ///< d phi / d s
  double Radius; ///< d r / d s; infinite at the center segment
  double Length; ///< d L / d s

  ContourOfHalfDerivative(double h, double b, double s, const ContourOfHalf& contour);
};

/// The chart of the Contour system. Its reference is (e, p, c) itself. The triangle should be
/// concordant with respect to the centre; if a foot lies outside its edge, the half edge on that
/// side is taken as shrunk to (almost) nothing.
class ContourChart
{
public:
  using Reference = TriangularCoordinates;
  /// A tangent vector of the reference: x = change of c, y = c times change of p, which stays finite
  /// at the centre, where c = 0 and p has no meaning.
  using Direction = Vector2;

  explicit ContourChart(const TriangleShape& shape, const EdgeViews& views,
    CenterPoint center = CenterPoint::Centroid);

  Reference ToReference(const Vector2& point) const;
  Vector2 ToPoint(const Reference& coordinates) const;

  /// At the centre, where the map is not differentiable, the limits are those along the contour that
  /// the reference names.
  Direction Pull(const Reference& coordinates, const Vector2& vector) const;
  Vector2 Push(const Reference& coordinates, const Direction& direction) const;

  TriangularCoordinates ToCoordinates(const Reference& coordinates) const { return coordinates; }
  Reference FromCoordinates(const TriangularCoordinates& coordinates) const { return coordinates; }

  /// Length of the contour that ends on an edge (1 to 3) at p, and its derivative with respect to p
  /// (not the edge's length). The jump of the homeomorphism's Jacobian across an edge follows from
  /// it in closed form.
  double ContourLength(int edge, double p) const;
  double ContourLengthDerivative(int edge, double p) const;

  /// The centre from which the contours start.
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

  Half HalfAt(const Edge& edge, double p) const;
  Matrix2 Columns(const Reference& coordinates) const;

  /// A power of two near the triangle's size, in which all lengths below are measured, so that their
  /// products neither underflow nor overflow.
  double Unit;
  TriangleShape Shape;
  Barycentric CenterWeights;
  std::array<Edge, 3> Edges;
};

} // namespace homeomorphism

#endif
