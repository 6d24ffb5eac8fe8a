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
#include <memory>
#include <vector>

namespace homeomorphism
{

/// The template is evaluated in closed form (see Documentation/cubic.md). Other elements of cut
/// triangles are made when a point in them is mapped for the first time, and kept until several
/// other triangles have been set. What it computes depends on the triangle and the point alone.
class CubicTriangle
{
public:
  /// Points in a row, Newton's steps, and the next rows come back to as many triangles.
  static constexpr std::size_t ManyTriangles = 64;
  /// Newton's steps for one point come back to as many.
  static constexpr std::size_t FewTriangles = 3;

  /// @a bending is null for the template itself. Both must outlive this. @a kept is how many
  /// triangles are kept.
  CubicTriangle(
    const CubicTemplate& cubicTemplate, const BendingSolution* bending, std::size_t kept)
    : Template(cubicTemplate)
    , Bending(bending)
    , Triangles(kept)
  {
  }

  void Set(int triangle);
  /// Of the triangle, relative to corner 0.
  const std::array<Vector2, 3>& GetCorners() const
  {
    return this->Now->Whole ? this->Now->Elements[0].Points : this->Now->Cut.Corners;
  }
  /// The element in which the last point was, as a number of the cut's.
  int GetLastElement() const { return this->LastElement; }
  /// The length of a whole triangle, or the least height of the inner points of a cut one: second
  /// derivatives change on this scale.
  double GetScale() const;

  /// The image of a point relative to that of corner 0, both relative to it.
  Vector2 Map(const Vector2& point);

  /// How far the image of a point is from @a image, and Newton's step towards its preimage. If the
  /// last point in this triangle @a isNear, its element is tried first.
  Vector2 GetResidual(const Vector2& point, const Vector2& image, bool isNear, Vector2& step);

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

  /// What the template's map needs beside an edge.
  struct EdgeTurn
  {
    bool IsMade = false;
    /// w c m: the jump of the derivative across the edge, times the share of it that is taken at
    /// the edge points, times the height.
    Vector2 Turn;
    double InverseHeight = 0.0;
    /// Between the edge points, and 1 / (1 + mu^2) there.
    double InverseStrip = 0.0;
    double StripShare = 0.0;
  };

  /// What it needs in the middle element of a corner. The vertex is corner 0 of the element.
  struct CornerTurn
  {
    bool IsMade = false;
    /// By how much the derivative at the vertex differs from the affine one.
    Matrix2 Turn;
    /// The gradients of the barycentric coordinates of corners 1 and 2.
    Vector2 ByFirst;
    Vector2 BySecond;
    /// The factors of the bubbles beside the edges from the vertex to them.
    Vector2 BesideFirst;
    Vector2 BesideSecond;
  };

  /// What it needs in an element of a corner with a right angle.
  struct SideTurn
  {
    bool IsMade = false;
    Matrix2 Turn;
    /// The gradients of s along the edge and t across, from 0 to 1.
    Vector2 ByS;
    Vector2 ByT;
    /// The factors of the bubbles beside the diagonal and beside the edge, and that of the part
    /// that the edge has.
    Vector2 BesideDiagonal;
    Vector2 BesideEdge;
    Vector2 OfEdge;
  };

  void Make(const std::array<Vector2, 3>& points, const CubicNet& net, int origin);
  /// Sets LastElement to that which contains a point. Null if the map is in closed form there.
  const Element* Find(const Vector2& point);
  /// Where there is no element. @a derivative may be null.
  Vector2 MapInClosedForm(const Vector2& point, Matrix2* derivative);
  const EdgeTurn& GetEdge(int k);
  const CornerTurn& GetCorner(int c);
  const SideTurn& GetSide(int c, bool isFirst);
  /// The template's map less the affine one. Adds its derivative to @a derivative unless null.
  Vector2 DeviateInStrip(const Vector2& point, int number, Matrix2* derivative);
  Vector2 DeviateInCorner(const Vector2& point, int number, Matrix2* derivative);

  /// What is known of a triangle.
  struct Triangle
  {
    int Number = -1;
    bool Whole = false;
    Matrix2 Affine;
    TriangleCut Cut;
    std::array<std::uint8_t, 3> InRings{};
    std::array<EdgeTurn, 3> Edges;
    std::array<CornerTurn, 3> Corners;
    /// Beside the edge that leaves each corner, and beside that which arrives at it.
    std::array<std::array<SideTurn, 2>, 3> Sides;
    /// Those that are made, a whole triangle's alone, and where each of a cut one's is, -1 if
    /// nowhere.
    std::vector<Element> Elements;
    std::array<std::int8_t, TriangleCut::NumberOfElements> Made;
  };
  const CubicTemplate& Template;
  const BendingSolution* Bending;
  int LastElement = 0;
  /// Of the last point in its element, by the map in closed form.
  double LeastCoordinate = 0.0;
  /// The last triangles that were set, by the ends of their numbers; made when they are set.
  std::vector<std::unique_ptr<Triangle>> Triangles;
  Triangle* Now = nullptr;
};

} // namespace homeomorphism

#endif
