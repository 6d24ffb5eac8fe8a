// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file JointOptimization.h
/// Removal of added points and improvement of triangles in a pair of triangulations.

#ifndef homeomorphism_JointOptimization_h
#define homeomorphism_JointOptimization_h

#include "PairMesh.h"

#include <functional>
#include <vector>

namespace homeomorphism
{

/// Improves a pair of triangulations, deterministically.
class JointOptimization
{
public:
  /// @param keepGoing is called repeatedly; if it returns false, work stops with a valid mesh
  JointOptimization(PairMesh& mesh, std::function<bool()> keepGoing);

  /// Flips edges while this improves the worse of the two triangles.
  void Flip();

  /// Removes added points, and on request merges neighboring ones, as long as that is possible.
  void RemovePoints(bool mergePoints);

  /// Removes further added points by triangulating larger and larger regions around them again, if
  /// there are at most a few hundred.
  void RefillRegions();

  /// Moves free points, one by one, to where the triangles around them are better, and flips edges;
  /// a few times. Unlike Improve, this also works if some triangles are too thin to be improved.
  void Settle();

  /// Moves the free points of each domain and flips edges, at most @a rounds times.
  void Improve(int rounds);

  /// Adds points until the worst quality reaches @a target or there are @a maximum points, and
  /// moves added points to other triangles as long as that helps. Keeps the best mesh found. With
  /// Concordance and NonObtuse, continues with the next worst triangle where points do not help,
  /// and does not keep a mesh that has an angle below half of QualityMeasure::Thin.
  void AddPoints(double target, int maximum);

  /// Halves the longest edges until no triangle is larger than @a maximumArea of its domain, or
  /// there are @a maximum points.
  void Refine(const std::array<double, 2>& maximumArea, int maximum);

private:
  /// The objective of an optimization: the soft minimum of qualities, or the excess of obtuse
  /// angles.
  enum class Goal
  {
    SoftMinimum,
    ObtuseExcess
  };

  void FlipAround(std::vector<int> triangles);
  bool RemovePoint(int vertex);
  /// Triangulates the outline of triangles again, by diagonals only.
  bool RefillWithout(const std::vector<int>& triangles, const std::vector<int>& outline);
  bool MergePoints(int vertex, int other);
  void Smooth(const std::vector<int>& vertices, bool finish);
  void SmoothDomain(
    const std::vector<int>& vertices, int domain, Goal goal, double sharpness, int steps);
  /// Smooths, unless that makes the mesh worse, and flips edges around the vertices.
  void SmoothAndFlip(const std::vector<int>& vertices, bool finish);
  std::vector<int> Neighborhood(int triangle, int rings) const;
  std::vector<int> FreeVerticesOf(const std::vector<int>& triangles) const;
  /// The free vertices whose best positions depend on a vertex: those that are connected with it by
  /// edges between free vertices, or, if these are many, those near it.
  std::vector<int> MovedWith(int vertex) const;
  /// Adds a point near the worst triangle. The candidates are the centroids of triangles and the
  /// midpoints of edges.
  bool InsertNear(int worst);
  /// Removes a point and inserts another one near the worst triangle.
  bool Relocate();
  /// Flips an edge near the worst triangle and smooths.
  bool FlipAndMove();
  /// Inserts a point near the worst triangle and removes another one.
  bool Exchange();
  int SplitTriangle(int triangle);
  int SplitEdge(int t, int k);

  PairMesh& Mesh;
  std::function<bool()> KeepGoing;
};

} // namespace homeomorphism

#endif
