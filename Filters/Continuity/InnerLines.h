// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file InnerLines.h
/// Lines within triangles at which some coordinate system is made of pieces.

#ifndef homeomorphism_InnerLines_h
#define homeomorphism_InnerLines_h

#include "Continuity/JacobianJump.h"
#include "Mesh/Homeomorphism.h"

namespace homeomorphism
{

/// The lines of a triangle, numbered from 0.
enum class InnerLine
{
  /// From the center to corner k.
  Spoke,
  /// From the middle of the center segment on edge k / 2 to an end of that edge: the next corner in
  /// cyclic order if k is even, the one after if it is odd.
  WingSegment,
  /// From the center to its foot on edge k.
  CenterSegment,
  /// The border of the strip along edge k within which the Smooth chart is not affine.
  StripBorder
};

/// The inner lines of a map's source, whatever the map's own coordinate system is.
class InnerLines
{
public:
  /// Refers to the map. Its target need not exist. @a center is the center of the Contour system.
  InnerLines(const Homeomorphism& map, CenterPoint center)
    : Map(map)
    , Center(center)
  {
  }

  /// The number of lines of a kind in each triangle.
  static int GetNumberOfLines(InnerLine kind) { return kind == InnerLine::WingSegment ? 6 : 3; }

  /// Not so for the center and wing segments of an edge that the center has no foot on, nor for the
  /// strip of a boundary edge.
  bool Exists(TriangleIndex triangle, InnerLine kind, int number) const;

  /// The point at a proportion t, from 0 to 1, of the line.
  Vector3 GetPosition(TriangleIndex triangle, InnerLine kind, int number, double t) const;

  LineCrossing GetCrossing(TriangleIndex triangle, InnerLine kind, int number, double t,
    const MapUnderTest& evaluate) const;

  /// The jump across the line by the map's closed form: that of the Contour system at spokes.
  /// Nowhere else within a triangle is there one, in any system.
  JacobianJump GetExactJump(TriangleIndex triangle, InnerLine kind, int number, double t,
    const LineCrossing& crossing) const;

private:
  /// In the triangle's frame.
  struct PointOnLine
  {
    Vector2 Position;
    Vector2 Tangent;
    /// How far the line goes on, both ways, without a bend.
    double Reach;
  };

  const MeshGeometry& GetSource() const { return this->Map.GetPair().GetGeometry(Domain::Source); }
  PointOnLine GetPoint(TriangleIndex triangle, InnerLine kind, int number, double t) const;
  ContourChart MakeContourChart(TriangleIndex triangle) const;
  double GetStripWidth(TriangleIndex triangle, int edge) const;

  const Homeomorphism& Map;
  CenterPoint Center;
};

/// How far a ray from a point of a triangle, both in its frame, stays in it; @a direction is a unit
/// vector.
double DistanceToExit(const TriangleShape& shape, const Vector2& point, const Vector2& direction);

/// A direction of a triangle's frame as a direction of the input's space.
Vector3 ToSpace(const MeshGeometry& geometry, TriangleIndex triangle, const Vector2& direction);

} // namespace homeomorphism

#endif
