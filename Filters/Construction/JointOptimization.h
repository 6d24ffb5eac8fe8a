// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file JointOptimization.h
/// Fewer added points and better triangles for a pair of triangulations.

#ifndef homeomorphism_JointOptimization_h
#define homeomorphism_JointOptimization_h

#include "PairMesh.h"

#include <functional>
#include <vector>

namespace homeomorphism
{

/// Improves a pair of triangulations without chance: the same mesh always becomes the same.
class JointOptimization
{
public:
  /// @param keepGoing is asked now and then; false stops the work early, with a valid mesh
  JointOptimization(PairMesh& mesh, std::function<bool()> keepGoing);

  /// Flips edges while the worse of two triangles gets better.
  void Flip();

  /// Takes out added points, and on request merges neighboring ones, as long as that is possible.
  void RemovePoints(bool mergePoints);

  /// Takes out further added points by filling larger and larger regions around them anew, if there
  /// are at most a few hundred.
  void RefillRegions();

  /// Moves free points one by one to where the triangles around them are better, and flips: a few
  /// times. Unlike Improve, also gets on where some triangles are too thin to be improved.
  void Settle();

  /// Moves the free points of each domain, and flips: at most @a rounds times.
  void Improve(int rounds);

  /// Adds points until the worst quality reaches @a target or there are @a maximum, and moves added
  /// points to other places as long as that helps. Keeps the best mesh seen. With Concordance and
  /// NonObtuse, of which each triangle has its share, goes on with the next worst triangle where
  /// points do not help, and keeps no mesh that has an angle below half of QualityMeasure::Thin.
  void AddPoints(double target, int maximum);

  /// Halves the longest edges until no triangle of either domain, measured in shares of that
  /// domain's area, is larger than @a maximumShare, or there are @a maximum points.
  void Refine(const std::array<double, 2>& maximumArea, int maximum);

private:
  /// What is moved in an optimization: the soft minimum of qualities, or the excess of obtuse
  /// angles.
  enum class Goal
  {
    SoftMinimum,
    ObtuseExcess
  };

  void FlipAround(std::vector<int> triangles);
  bool RemovePoint(int vertex);
  /// Fills an outline by diagonals in the place of triangles.
  bool RefillWithout(const std::vector<int>& triangles, const std::vector<int>& outline);
  bool MergePoints(int vertex, int other);
  void Smooth(const std::vector<int>& vertices, bool finish);
  void SmoothDomain(
    const std::vector<int>& vertices, int domain, Goal goal, double sharpness, int steps);
  void Round(const std::vector<int>& vertices, bool finish);
  std::vector<int> Neighborhood(int triangle, int rings) const;
  std::vector<int> FreeVerticesOf(const std::vector<int>& triangles) const;
  /// The free vertices whose best positions depend on a vertex: those that edges between free
  /// vertices connect with it, or those near it if these are many.
  std::vector<int> MovedWith(int vertex) const;
  bool InsertNear(int worst);
  bool Relocate();
  bool FlipAndMove();
  bool Exchange();
  int SplitTriangle(int triangle);
  int SplitEdge(int t, int k);

  PairMesh& Mesh;
  std::function<bool()> KeepGoing;
};

} // namespace homeomorphism

#endif
