// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ConstrainedTriangulation.h
/// Constrained Delaunay triangulation of the points of one domain, inside a box.

#ifndef homeomorphism_ConstrainedTriangulation_h
#define homeomorphism_ConstrainedTriangulation_h

#include "Kernel/Geometry.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace homeomorphism
{

/// Whether @a d is certainly inside the circle through the counterclockwise points @a a, @a b, @a
/// c. Doubtful cases are treated as outside: then every flip lowers the lifted surface, so flips
/// cannot cycle.
bool CertainlyInCircle(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d);

/// Ranks of points along a Hilbert curve through their bounding box. Points in the same cell are
/// ordered by x, then y.
std::vector<int> HilbertOrder(const std::vector<Vector2>& points);

/// A triangulation of a box, with some of its edges constrained. Every topological decision is
/// based on exact orientations. Vertices 0 to 3 are the corners of the box.
class ConstrainedTriangulation
{
public:
  /// The number of vertices that belong to the box.
  static constexpr int BoxCorners = 4;

  /// Edge k is opposite vertex k; the vertices are in counterclockwise order.
  struct Triangle
  {
    std::array<int, 3> Vertices;
    std::array<int, 3> Neighbors;
    std::array<bool, 3> Constrained;
    bool Outside;
  };

  /// An edge of a triangle.
  struct Edge
  {
    int Triangle = -1;
    int Index = 0;
  };

  /// The first obstacle of a segment between two vertices.
  struct Trace
  {
    enum class Outcome
    {
      Clear,
      CrossesConstraint,
      MeetsVertex
    };
    Outcome Result = Outcome::Clear;
    /// The constrained edge that is crossed, or the vertex that is met (twice).
    std::array<int, 2> Obstacle{ { -1, -1 } };
    /// A triangle at the first vertex: if the edge exists, the triangle to its left, otherwise the
    /// first triangle that the segment enters.
    int First = -1;
    bool IsEdge = false;
    /// The ends of the edges that are crossed: first the one to the left of the segment, then the
    /// one to the right.
    std::vector<std::pair<int, int>> Crossed;
  };

  /// Triangulates the box around @a points, whose first four become the box's corners.
  /// @a points must outlive this object and may grow; all points must be finite and distinct.
  explicit ConstrainedTriangulation(std::vector<Vector2>& points);

  /// Whether a vertex can be inserted at a position: it must be finite, in the box, not on a
  /// constrained edge, and not equal to that of another vertex.
  bool CanInsert(const Vector2& position) const;

  /// Inserts a vertex into the triangulation, for which CanInsert must be true.
  void Insert(int vertex);

  /// Follows the segment from @a from to @a to.
  Trace Follow(int from, int to) const;

  /// Makes the segment an edge and constrains it. The trace must be Clear and up to date.
  void Constrain(int from, int to, const Trace& trace);
  void SetConstrained(int from, int to, bool constrained);

  /// The constrained neighbor of @a from that comes first clockwise from the direction of a trace;
  /// -1 if there is none, @a to itself if it is the only one.
  int ConstrainedNeighborBefore(int from, int to, const Trace& trace) const;

  /// The triangle to the left of an edge, which must exist.
  Edge FindEdge(int from, int to) const;

  const std::vector<Triangle>& GetTriangles() const { return this->Triangles; }
  std::vector<Triangle>& GetTriangles() { return this->Triangles; }
  const Vector2& GetPoint(int vertex) const { return this->Points[vertex]; }
  int GetTriangleOf(int vertex) const { return this->TriangleOf[vertex]; }
  int IndexOf(int triangle, int vertex) const;
  Edge Twin(int triangle, int edge) const;

private:
  int Sign(int a, int b, int c) const;
  int Locate(const Vector2& point, int& onEdge) const;
  void Flip(int t, int k);
  bool IsConvex(int t, int k) const;
  void Link(int triangle, int edge, int neighbor, int neighborEdge);
  void Legalize();

  std::vector<Vector2>& Points;
  std::vector<Triangle> Triangles;
  std::vector<int> TriangleOf;
  std::vector<Edge> Doubtful;
  mutable int Hint = 0;
};

} // namespace homeomorphism

#endif
