// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PairMesh.h
/// A triangulation in two domains that can be changed locally; changes can be undone.

#ifndef homeomorphism_PairMesh_h
#define homeomorphism_PairMesh_h

#include "FaceFilling.h"
#include "PairQuality.h"

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace homeomorphism
{

/// Triangles that are counterclockwise in both domains at all times. Added points, those from
/// FirstAdded on, can be moved and removed; the edges of the figure are fixed.
class PairMesh
{
public:
  /// Edge k is opposite vertex k.
  struct Triangle
  {
    std::array<int, 3> Vertices{ { -1, -1, -1 } };
    std::array<int, 3> Neighbors{ { -1, -1, -1 } };
    std::array<bool, 3> Fixed{ { false, false, false } };
    bool Alive = false;
    double Quality = 0.0;
    /// The triangle is not regarded as the worst while its quality is at least this.
    double AcceptedQuality = std::numeric_limits<double>::infinity();

    bool IsAccepted() const { return this->Quality >= this->AcceptedQuality; }
  };

  /// @param fixed the ends of fixed edges; boundary edges are always fixed
  PairMesh(const std::array<std::vector<Vector2>, 2>& points,
    const std::vector<std::array<int, 3>>& triangles, const std::vector<std::array<int, 2>>& fixed,
    int firstAdded, const QualityMeasure& quality);

  const std::vector<Triangle>& GetTriangles() const { return this->Triangles; }
  const std::vector<Vector2>& GetPoints(int domain) const { return this->Points[domain]; }
  int GetNumberOfPoints() const { return static_cast<int>(this->Points[0].size()); }
  int GetFirstAdded() const { return this->FirstAdded; }
  const QualityMeasure& GetQuality() const { return this->Quality; }
  void SetQuality(const QualityMeasure& quality);
  bool IsUsed(int vertex) const { return this->TriangleOf[vertex] >= 0; }
  /// Whether the vertex was added and has no fixed edge.
  bool IsFree(int vertex) const;
  int CountAdded() const;
  std::vector<int> FreeVertices() const;

  int GetTriangleOf(int vertex) const { return this->TriangleOf[vertex]; }
  int IndexOf(int triangle, int vertex) const;
  TrianglePoints PointsOf(int triangle, int domain) const;

  /// The triangles around a vertex, counterclockwise. Returns false if the vertex is on the
  /// boundary; the triangles then begin there.
  bool Star(int vertex, std::vector<int>& star) const;

  /// The given triangles, followed by those that share a vertex with them.
  std::vector<int> Grow(const std::vector<int>& triangles) const;

  /// The corners of the closed walk around triangles, counterclockwise. Returns false if the
  /// triangles do not form a disk or contain a fixed edge.
  bool Outline(const std::vector<int>& triangles, std::vector<int>& outline) const;

  /// Replaces triangles by others with the same outline and the same fixed edges inside. Returns
  /// the new triangles.
  std::vector<int> Replace(
    const std::vector<int>& triangles, const std::vector<std::array<int, 3>>& vertices);

  int AddPoint(const Vector2& source, const Vector2& target);
  void Move(int vertex, int domain, const Vector2& position);
  /// Computes the quality of a triangle again, after its points have been moved.
  void Update(int triangle);

  /// Flips edge @a k of triangle @a t if the quadrilateral is convex in both domains and the worse
  /// of the two triangles becomes better.
  bool FlipIfBetter(int t, int k, std::vector<int>& made);

  /// Flips edge @a k of triangle @a t if the quadrilateral is convex in both domains and both new
  /// triangles are better than @a least, which is at least 0.
  bool Flip(int t, int k, double least, std::vector<int>& made);

  /// The number of changes so far, for RollBack.
  std::size_t Mark() const { return this->Changes.size(); }
  void RollBack(std::size_t mark);
  /// Makes all changes permanent.
  void Commit() { this->Changes.clear(); }

  /// Accepts a triangle as it is: Worst ignores it until it becomes worse or is replaced.
  void Accept(int triangle);
  /// The worst triangle that is not accepted, -1 if there is none.
  int Worst() const;
  double WorstQuality() const;
  /// The smallest angle of all triangles of both domains, in degrees.
  double SmallestAngle() const;
  /// A smooth lower bound of the worst quality, which also depends on the number of bad triangles.
  double Score() const;

private:
  struct Change
  {
    /// For a replacement: the previous triangles, and the numbers of the new ones.
    std::vector<int> Old;
    std::vector<Triangle> Before;
    std::vector<int> Made;
    /// For a moved point, or an added point (domain -1).
    int Vertex = -1;
    int Domain = 0;
    Vector2 Position;
  };

  int Allocate();
  void Free(int triangle);

  std::array<std::vector<Vector2>, 2> Points;
  std::vector<Triangle> Triangles;
  std::vector<int> TriangleOf;
  std::vector<int> FreeTriangles;
  std::vector<Change> Changes;
  int FirstAdded;
  QualityMeasure Quality;
};

} // namespace homeomorphism

#endif
