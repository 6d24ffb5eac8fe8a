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

/// The Cubic map on one triangle. The template is evaluated in closed form (see
/// Documentation/cubic.md). Other elements of cut triangles are computed when a point in them is
/// mapped for the first time, and kept until several other triangles have been set. Results depend
/// only on the triangle and the point. Not thread-safe.
class CubicTriangle
{
public:
  /// The number of triangles to keep for rows of points, whose steps and next rows return to the
  /// same triangles.
  static constexpr std::size_t ManyTriangles = 64;
  /// The number of triangles to keep for the Newton steps of one point.
  static constexpr std::size_t FewTriangles = 3;

  /// @a bending is null for the template itself. Both must outlive this object. @a kept is the
  /// number of triangles that are kept.
  CubicTriangle(
    const CubicTemplate& cubicTemplate, const BendingSolution* bending, std::size_t kept)
    : Template(cubicTemplate)
    , Bending(bending)
    , Kept(kept)
  {
  }

  void Set(int triangle)
  {
    if (!this->Current || this->Current->Number != triangle)
    {
      this->Load(triangle);
    }
  }
  /// The corners of the triangle, relative to corner 0.
  const std::array<Vector2, 3>& GetCorners() const
  {
    return this->Current->Whole ? this->Current->Elements[0].Points : this->Current->Cut.Corners;
  }
  /// The number, in the cut, of the element that contained the last point.
  int GetLastElement() const { return this->LastElement; }
  /// The scale on which second derivatives change: the length of a whole triangle, or the smallest
  /// height of the inner points of a cut one.
  double GetScale() const;

  /// The image of a point. Point and image are relative to corner 0 and its image.
  Vector2 Map(const Vector2& point);

  /// The derivative of the template at a point relative to corner 0.
  Matrix2 GetTemplateDerivative(const Vector2& point);

  /// The difference of @a image and the image of a point, and Newton's step towards the preimage of
  /// @a image. If the last point in this triangle @a isNear, its element is tried first.
  Vector2 GetResidual(const Vector2& point, const Vector2& image, bool isNear, Vector2& step);

  /// Replaces a point of the triangle by the preimage, under the template, of its image under the
  /// piecewise linear map. Returns false, and changes nothing, if the preimage is not in the same
  /// strip, or not in the middle as the point is, or if the triangle is so thin that the preimage's
  /// rounding errors could change its image by more than half of @a tolerance.
  bool FindDirectly(Vector2& point, double tolerance);

private:
  struct Element
  {
    std::array<Vector2, 3> Points;
    BarycentricFrame Frame;
    CubicNet Net;
    /// The origins of its coordinates, relative to corner 0.
    Vector2 SourceOrigin;
    Vector2 TargetOrigin;
  };

  /// The data of the template's closed form along an edge.
  struct EdgeTerms
  {
    bool IsMade = false;
    /// w c m: the jump w of the derivative across the edge, times the fraction c of it at the edge
    /// points, times the height m.
    Vector2 Jump;
    double InverseHeight = 0.0;
    /// The reciprocal of the distance between the edge points, and 1 / (1 + mu^2).
    double InverseStrip = 0.0;
    double StripShare = 0.0;
    /// The vector that the affine map maps to Jump, and the rounding errors of FindDirectly.
    Vector2 Shift;
    double Rounding = 0.0;
  };

  /// The data of the closed form in the middle element of a corner. The vertex is corner 0 of the
  /// element.
  struct CornerTerms
  {
    bool IsMade = false;
    /// The derivative at the vertex minus the affine one.
    Matrix2 Difference;
    /// The gradients of the barycentric coordinates of corners 1 and 2.
    Vector2 ByFirst;
    Vector2 BySecond;
    /// The factors of the bubbles of the edges from the vertex to these corners.
    Vector2 BesideFirst;
    Vector2 BesideSecond;
  };

  /// The data of the closed form in an element of a corner with a right angle.
  struct SideTerms
  {
    bool IsMade = false;
    Matrix2 Difference;
    /// The gradients of s along the edge and t across it, both from 0 to 1.
    Vector2 ByS;
    Vector2 ByT;
    /// The factors of the bubbles of the diagonal and of the edge, and that of the edge's part of
    /// the map.
    Vector2 BesideDiagonal;
    Vector2 BesideEdge;
    Vector2 OfEdge;
  };

  void Load(int triangle);
  void Make(const std::array<Vector2, 3>& points, const CubicNet& net, int origin);
  /// Sets LastElement to the element that contains a point, and returns it; null if the map has a
  /// closed form there.
  const Element* Find(const Vector2& point);
  /// The image of a point for which Find returns null. @a derivative may be null.
  Vector2 MapInClosedForm(const Vector2& point, Matrix2* derivative);
  const EdgeTerms& GetEdge(int k);
  const CornerTerms& GetCorner(int c);
  const SideTerms& GetSide(int c, bool isFirst);
  /// The template minus the affine map. Adds its derivative to @a derivative unless that is null.
  Vector2 DeviateInStrip(const Vector2& point, int number, Matrix2* derivative);
  Vector2 DeviateInCorner(const Vector2& point, int number, Matrix2* derivative);

  /// The data of a triangle that has been computed.
  struct Triangle
  {
    int Number = -1;
    bool Whole = false;
    Matrix2 Affine;
    /// PlanarPair::GetRounding of the affine map.
    double Rounding = 0.0;
    TriangleCut Cut;
    std::array<std::uint8_t, 3> InRings{};
    std::array<EdgeTerms, 3> Edges;
    std::array<CornerTerms, 3> Corners;
    /// For each corner, along the edge that starts at it, and along the edge that ends at it.
    std::array<std::array<SideTerms, 2>, 3> Sides;
    /// The computed elements (a whole triangle has only one), and for each element of a cut
    /// triangle its index among them, or -1.
    std::vector<Element> Elements;
    std::array<std::int8_t, TriangleCut::NumberOfElements> Made;
  };
  const CubicTemplate& Template;
  const BendingSolution* Bending;
  int LastElement = 0;
  /// The smallest barycentric coordinate of the last point in its element, if the map has a closed
  /// form there.
  double LeastCoordinate = 0.0;
  /// The last triangles that were set, at the index that is the remainder of the triangle's number.
  /// Allocated when the first triangle is set: whole triangles are mapped without it.
  std::vector<std::unique_ptr<Triangle>> Triangles;
  std::size_t Kept;
  Triangle* Current = nullptr;
};

} // namespace homeomorphism

#endif
