// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file InnerLines.h
/// Lines within triangles that separate the pieces of piecewise defined charts.

#ifndef homeomorphism_InnerLines_h
#define homeomorphism_InnerLines_h

#include "Continuity/FeatureKind.h"
#include "Continuity/JacobianJump.h"
#include "Mesh/Homeomorphism.h"

namespace homeomorphism
{

/// The inner lines of the source of a map. They do not depend on the coordinate system of the map.
class InnerLines
{
public:
  /// Keeps a reference to the map, whose target is optional. @a center is that of the Contour
  /// system.
  InnerLines(const Homeomorphism& map, CenterPoint center)
    : Map(map)
    , Center(center)
  {
  }

  /// The number of lines of a kind in each triangle.
  static int GetNumberOfLines(FeatureKind kind) { return kind == FeatureKind::WingSegment ? 6 : 3; }

  /// Whether the line exists. Center and wing segments do not exist if the foot of the center is
  /// not inside the edge, and strips do not exist at boundary edges.
  bool Exists(TriangleIndex triangle, FeatureKind kind, int number) const;

  /// The point at a proportion t, from 0 to 1, of the line.
  Vector3 GetPosition(TriangleIndex triangle, FeatureKind kind, int number, double t) const;

  LineCrossing GetCrossing(
    TriangleIndex triangle, FeatureKind kind, int number, double t, const MapUnderTest& map) const;

  /// The jump across the line, in closed form. Only the spokes of the Contour system have a jump.
  JacobianJump GetExactJump(TriangleIndex triangle, FeatureKind kind, int number, double t,
    const LineCrossing& crossing) const;

private:
  /// A point of a line, in the frame of the triangle.
  struct PointOnLine
  {
    Vector2 Position;
    Vector2 Tangent;
    /// The length, in both directions, on which the line is straight, or infinity.
    double StraightLength;
  };

  const MeshGeometry& GetSource() const { return this->Map.GetPair().GetGeometry(Domain::Source); }
  PointOnLine GetPoint(TriangleIndex triangle, FeatureKind kind, int number, double t) const;
  ContourChart MakeContourChart(TriangleIndex triangle) const;
  double GetStripWidth(TriangleIndex triangle, int edge) const;

  const Homeomorphism& Map;
  CenterPoint Center;
};

/// The length of a ray from a point of a triangle to the point where it leaves the triangle, in the
/// frame of the triangle. @a direction is a unit vector.
double DistanceToExit(const TriangleShape& shape, const Vector2& point, const Vector2& direction);

/// Transforms a direction from the frame of a triangle to the space of the input.
Vector3 ToSpace(const MeshGeometry& geometry, TriangleIndex triangle, const Vector2& direction);

} // namespace homeomorphism

#endif
