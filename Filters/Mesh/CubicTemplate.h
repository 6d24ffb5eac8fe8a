// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicTemplate.h
/// A certified C1 homeomorphism of any pair of plane triangulations in closed form. Each triangle
/// is cut into 19 elements. See Documentation/cubic.md.

#ifndef homeomorphism_CubicTemplate_h
#define homeomorphism_CubicTemplate_h

#include "Mesh/LargeArray.h"
#include "Mesh/PlanarPair.h"
#include "Mesh/VertexGradient.h"

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace homeomorphism
{

/// Calls @a body for ranges [begin, end) that cover [0, count), possibly in several threads.
using ParallelFor =
  std::function<void(std::int64_t count, const std::function<void(std::int64_t, std::int64_t)>&)>;

void SerialFor(std::int64_t count, const std::function<void(std::int64_t, std::int64_t)>& body);

/// The cut of one triangle, relative to its corner 0.
///
/// Nodes: corners 0 to 2; on edge k, the edge points 3 + 2k near its start and 4 + 2k near its end;
/// above them, the inner points 9 + 2k and 10 + 2k. Elements: 3c to 3c + 2 at corner c, 9 + 2k and
/// 10 + 2k along edge k, 15 to 18 in the middle.
struct TriangleCut
{
  static constexpr int NumberOfNodes = 15;
  static constexpr int NumberOfElements = 19;
  static constexpr int FirstStrip = 9;
  static constexpr int FirstMiddle = 15;

  static const std::array<std::array<std::uint8_t, 3>, NumberOfElements> Elements;

  std::array<Vector2, 3> Corners;
  /// Unit vectors along the edges.
  std::array<Vector2, 3> Along;
  std::array<double, 3> Lengths;
  /// The distance of the edge points from each corner.
  std::array<double, 3> Radii;
  /// The heights of the inner points above each edge.
  std::array<double, 3> Heights;

  /// The corner to which an element's coordinates are relative: the nearest one.
  static int GetOrigin(int element)
  {
    return element < FirstStrip
      ? element / 3
      : (element < FirstMiddle ? NextCorner((element - FirstStrip) / 2) : 0);
  }

  /// A node relative to the corner @a origin.
  Vector2 GetNode(int node, int origin) const;

  /// Sets the frame of an element that has a right angle (all elements along edges). Returns
  /// whether it has one.
  bool SetRightAngle(int element, CubicElement& result) const;

  /// The element that contains a point of the triangle, relative to corner 0.
  int Find(const Vector2& point) const;

  /// The element that contains a point in a corner or a strip; FirstMiddle in the middle.
  int FindBesideEdges(const Vector2& point) const;
};

/// The kinds of vertices in the template.
enum class VertexKind : std::int8_t
{
  /// The map has a certified derivative at the vertex.
  Differentiable,
  /// The map has a certified derivative at the vertex, inside rings.
  Rings,
  /// The map has no derivative at the vertex. It is homogeneous near the vertex, and C1 around it.
  Exceptional
};

struct CubicTemplateOptions
{
  /// The largest allowed distance from the piecewise linear map, in the units of the target.
  double MaximumDeviation = std::numeric_limits<double>::infinity();
  /// Whether to compute only the data that a map of whole triangles needs: kinds and derivatives at
  /// boundary points. Interior points then have the kind Differentiable and the mean of the
  /// triangles' derivatives, and triangles without boundary points have no heights.
  bool OnlyBoundary = false;
};

/// The map. It stores a radius and a derivative for each point, and three heights for each
/// triangle; elements are computed when they are needed.
class CubicTemplate
{
public:
  /// @a pair must outlive the template.
  CubicTemplate(const PlanarPair& pair, const CubicTemplateOptions& options,
    const ParallelFor& parallelFor = SerialFor);

  const PlanarPair& GetPair() const { return this->Pair; }

  /// The piecewise linear map's derivative.
  const Matrix2& GetAffine(int triangle) const { return this->Affines[triangle]; }

  VertexKind GetKind(int point) const { return this->Kinds[point]; }
  bool IsBoundary(int point) const { return this->Boundary[point] != 0; }
  /// Whether a point lies on a boundary that is straight there in both meshes, to the rounding of
  /// their coordinates.
  bool IsStraight(int point) const { return this->Boundary[point] == 2; }
  double GetRadius(int point) const { return this->Radii[point]; }
  /// The heights of the inner points in a triangle's cut.
  const std::array<double, 3>& GetHeights(int triangle) const { return this->Heights[triangle]; }
  /// The derivative at a point that is differentiable.
  const Matrix2& GetDerivative(int point) const { return this->Derivatives[point]; }
  const VertexRings& GetRings(int point) const;
  int GetNumberOfRings(int point) const;
  /// The corners of the triangles at a point, relative to the point.
  VertexFan GetFan(int point, const PointFan& fan) const;

  TriangleCut GetCut(int triangle) const;

  /// The derivative at a node of a cut, minus the triangle's affine one. Not for a vertex that is
  /// not Differentiable.
  Matrix2 GetGradient(const TriangleCut& cut, const Matrix2& affine, int triangle, int node) const;

  /// Bounds of each barycentric coordinate, between the strip of an edge and the corner opposite
  /// it. Where all coordinates are within the bounds, the map is affine.
  struct MiddleBounds
  {
    std::array<double, 3> Least;
    std::array<double, 3> Greatest;
  };
  /// Computes all bounds. Must be called before GetMiddle.
  void FindMiddles(const ParallelFor& parallelFor = SerialFor);
  const MiddleBounds& GetMiddle(int triangle) const { return this->Middles[triangle]; }

  /// The element, relative to the cut's GetOrigin(element) in the source and in the target. Not for
  /// elements at a vertex that is not Differentiable.
  CubicElement GetElement(
    const TriangleCut& cut, const Matrix2& affine, int triangle, int element) const;

  /// The image of a point near corner @a corner, which is not Differentiable, and the derivative.
  /// Point and image are relative to the corner and its image.
  void EvaluateRings(
    int triangle, int corner, const Vector2& point, Vector2& image, Matrix2& derivative) const;

  /// The image of a point, and the derivative. Point and image are relative to corner 0 and its
  /// image.
  void Evaluate(int triangle, const Vector2& point, Vector2& image, Matrix2& derivative) const;

  /// Calls @a visit with every element of a triangle at a corner that is not Differentiable,
  /// relative to the corner, and with the factor by which it is shrunk.
  void VisitRings(int triangle, int corner,
    const std::function<void(const CubicElement&, double factor)>& visit) const;

  /// The smallest Bernstein coefficient of the determinant in a triangle, divided by the affine
  /// determinant. The triangle is certified if it is positive.
  double GetCertificate(int triangle) const;

private:
  struct Exception
  {
    int Point;
    VertexFan Fan;
    std::vector<int> Triangles;
    VertexRings Rings;
  };

  const Exception& GetException(int point) const;
  /// Bounds in a triangle, while the template is computed.
  struct Bounds
  {
    /// With the derivative L at the corners, along the edges: how far the determinant can be below
    /// the affine one, divided by the affine one; and |D'| divided by the smallest stretch of L.
    double Fall = 0.0;
    double Slope = 0.0;
    /// A lower bound of the determinant in each corner, divided by the affine one; 0 if unknown.
    std::array<float, 3> Corners{};
  };

  void SetHeights(int triangle, double maximumDeviation, LargeArray<Bounds>& bounds);
  void SetMiddle(int triangle);
  /// Uses the mean derivative at an interior point if its corners are then certified, which is the
  /// case where the derivatives of the triangles differ little.
  bool TakeMean(int point, const PointFans& fans, LargeArray<Bounds>& bounds);
  /// Sets a point's derivative and kind. Returns the data of its rings if it is not Differentiable.
  std::unique_ptr<Exception> FindDerivative(int point, const PointFans& fans);
  /// A bound on the distance from the piecewise linear map in the corners at a point.
  double GetDeviation(const PointFan& fan, int point, const Exception* exception) const;
  void VisitRings(const Exception& exception, int triangle,
    const std::function<void(const CubicElement&, double factor)>& visit) const;

  const PlanarPair& Pair;
  LargeArray<double> Radii;
  LargeArray<Matrix2> Derivatives;
  LargeArray<VertexKind> Kinds;
  /// 1 on the boundary, 2 where it is straight.
  LargeArray<std::uint8_t> Boundary;
  LargeArray<Matrix2> Affines;
  LargeArray<std::array<double, 3>> Heights;
  LargeArray<MiddleBounds> Middles;
  /// The certificates of triangles that are certified by bounds, otherwise 0.
  LargeArray<float> Certificates;
  /// Ascending by point.
  std::vector<Exception> Exceptions;
};

} // namespace homeomorphism

#endif
