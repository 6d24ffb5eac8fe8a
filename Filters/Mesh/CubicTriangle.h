// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicTriangle.h
/// The Cubic map on one triangle, prepared for many points.

#ifndef homeomorphism_CubicTriangle_h
#define homeomorphism_CubicTriangle_h

#include "Mesh/BendingSolve.h"
#include "Mesh/CubicTemplate.h"
#include "Mesh/PlanarPair.h"

#include <array>
#include <cstdint>
#include <vector>

namespace homeomorphism
{

/// Elements are made when a point in them is mapped for the first time, and kept until another
/// triangle is set. What it computes depends on the triangle and the point alone.
class CubicTriangle
{
public:
  /// @a bending is null for the template itself. Both must outlive this.
  CubicTriangle(const CubicTemplate& cubicTemplate, const BendingSolution* bending)
    : Template(cubicTemplate)
    , Bending(bending)
  {
  }

  void Set(int triangle);
  /// Whether the map is one element there.
  bool IsWhole() const { return this->Whole; }
  /// Of the piecewise linear map.
  const Matrix2& GetAffine() const { return this->Affine; }

  /// The image of a point relative to that of corner 0, both relative to it.
  Vector2 Map(const Vector2& point);

  /// How far the image of a point is from @a image, and Newton's step towards its preimage.
  Vector2 GetResidual(const Vector2& point, const Vector2& image, Vector2& step);

private:
  struct Element
  {
    std::array<Vector2, 3> Points;
    BarycentricFrame Frame;
    CubicNet Net;
    /// Where its coordinates begin, relative to corner 0.
    Vector2 SourceOrigin;
    Vector2 TargetOrigin;
  };

  void Make(const std::array<Vector2, 3>& points, const CubicNet& net, int origin);
  /// The element that contains a point, null if the map is affine or inside rings there.
  const Element* Find(const Vector2& point, int& ringCorner);
  /// Where there is no element.
  Vector2 MapOutside(const Vector2& point, int ringCorner, Matrix2& derivative) const;

  const CubicTemplate& Template;
  const BendingSolution* Bending;
  int Triangle = -1;
  bool Whole = false;
  Matrix2 Affine;
  TriangleCut Cut;
  /// Half planes of the points in the middle hexagon: those beyond the line of a corner's inner
  /// points.
  std::array<Vector2, 3> CornerNormals;
  std::array<double, 3> CornerOffsets;
  std::array<std::uint8_t, 3> InRings{};
  /// Those that are made, a whole triangle's alone, and where each of a cut one's is, -1 if
  /// nowhere.
  std::vector<Element> Elements;
  std::array<std::int8_t, TriangleCut::NumberOfElements> Made;
};

} // namespace homeomorphism

#endif
