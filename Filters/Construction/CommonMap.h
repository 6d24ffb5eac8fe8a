// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CommonMap.h
/// A planar map that is drawn in two domains.

#ifndef homeomorphism_CommonMap_h
#define homeomorphism_CommonMap_h

#include "ConstrainedTriangulation.h"

#include <array>
#include <cstddef>
#include <vector>

namespace homeomorphism
{

/// Vertices and edges with one drawing in each of two domains. The drawings are isomorphic at all
/// times: an edge is added only if, in both domains, it crosses nothing, has the same place in the
/// cyclic order of edges at both ends, and separates the other components in the same way. Each
/// drawing consists of the constrained edges of a constrained Delaunay triangulation, whose other
/// edges are candidates.
class CommonMap
{
public:
  /// Why an edge cannot be added.
  enum class Refusal
  {
    None,
    Crosses,
    MeetsVertex,
    CyclicOrder,
    Separates,
    Outside,
    Exists
  };

  struct Answer
  {
    Refusal Why = Refusal::None;
    /// The domain of the obstacle, or -1 if the two domains disagree.
    int Domain = -1;
    /// The ends of the constrained edge that is crossed, the vertex that is met (twice), or
    /// vertices on different sides.
    std::vector<int> Vertices;
  };

  /// A face that is not a triangle.
  struct Face
  {
    /// The closed walks along the boundary, with the face on the left. An isolated vertex is also a
    /// walk.
    std::vector<std::vector<int>> Walks;
    /// If there is one walk: the constrained Delaunay triangulation of the face in each domain, as
    /// triples of positions along the walk.
    std::array<std::vector<std::array<int, 3>>, 2> Triangles;
  };

  /// @a points must not contain coincident points. They become the vertices from
  /// ConstrainedTriangulation::BoxCorners on.
  explicit CommonMap(const std::array<std::vector<Vector2>, 2>& points);
  CommonMap(const CommonMap&) = delete;
  CommonMap& operator=(const CommonMap&) = delete;

  /// Adds an edge unless it is refused.
  Answer Add(int from, int to);

  /// The outcome of drawing a polygonal line.
  enum class Drawn
  {
    Yes,
    /// Double precision did not suffice; the drawings are still isomorphic.
    No,
    /// Rounding has moved a vertex into another face; the map cannot be used any more.
    Broken
  };

  /// Joins two walks of a face by an edge or by a polygonal line with added vertices.
  Drawn Bridge(const Face& face);

  /// Divides a face with one walk by a polygonal line between two of its corners, with few bends
  /// and with many corners on both sides.
  Drawn Split(const Face& face);

  /// Marks the faces that are surrounded by an even number of loops as outside; edges in them are
  /// refused.
  void MarkOutside(const std::vector<std::array<int, 2>>& loopEdges);
  bool IsOutside(int vertex, int domain) const;

  /// Selects the order in which edges are tried: 0 by the longer of the two lengths, 1 by their
  /// sum, 2 and 3 by the length in one domain; all others by the longer length with a different
  /// perturbation each.
  void SetOrder(int order) { this->Order = order; }

  /// The length of an edge as a fraction of the figure's extent; the lengths in both domains are
  /// combined as the order requires.
  double ScaledLength(int from, int to) const;

  /// Unconstrained edges of both triangulations inside the domain, the shortest first.
  std::vector<std::array<int, 2>> Candidates() const;

  /// The faces inside the domain: triangles (@a closed), and others.
  void Faces(std::vector<std::array<int, 3>>& closed, std::vector<Face>& faces) const;

  int GetNumberOfComponents() const { return this->NumberOfComponents; }
  int Component(int vertex) const;
  const std::vector<Vector2>& GetPoints(int domain) const { return this->Points[domain]; }

private:
  using Triangulation = ConstrainedTriangulation;

  /// The bends of a line in one domain, if there is room for it.
  struct Path
  {
    bool Exists = false;
    std::vector<Vector2> Bends;
  };

  /// A polygonal line between two corners: its bends in each domain.
  struct Route
  {
    int From = -1;
    int To = -1;
    std::array<std::vector<Vector2>, 2> Bends;
    double Cost = 0.0;
  };

  /// Whether a new edge that closes a cycle separates the components in the same way in both
  /// domains. If not, returns the vertices that are on different sides.
  bool SeparatesAlike(int from, int to, std::vector<int>& differing);
  /// Finds the triangles of a face by a flood fill; returns false if there are more than the limit.
  bool Flood(int domain, int start, std::size_t limit, std::vector<int>& region);
  /// The constrained edges on the boundary of a region, and its isolated vertices.
  std::vector<std::array<int, 2>> Signature(int domain, const std::vector<int>& region) const;
  /// The triangles of a face at one of its corners: those around a vertex counterclockwise from the
  /// edge to @a before, or all around an isolated vertex (@a before is -1).
  std::vector<int> Fan(int domain, int vertex, int before) const;
  std::vector<Path> FindPaths(
    int domain, int from, int before, const std::vector<std::array<int, 2>>& goals) const;
  Drawn Draw(Route& route);
  /// The bends of a line that crosses the given edges (left and right ends), with few bends.
  std::vector<Vector2> Shorten(
    int domain, int from, int to, const std::vector<std::array<int, 2>>& portals) const;
  std::vector<std::array<int, 3>> FaceTriangles(int domain, const std::vector<int>& walk) const;

  std::array<std::vector<Vector2>, 2> Points;
  std::array<ConstrainedTriangulation, 2> Drawings;
  std::array<double, 2> Scales{ { 1.0, 1.0 } };
  std::array<double, 2> LeastPortals{ { 0.0, 0.0 } };
  int Order = 0;
  mutable std::vector<int> Parents;
  std::vector<int> Degrees;
  int NumberOfComponents = 0;
  std::array<std::vector<int>, 2> Marks;
  int LastMark = 0;
};

} // namespace homeomorphism

#endif
