// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file InBetweenPath.h
/// Paths of planar meshes from a source to a target, and the times at which triangles fold.

#ifndef homeomorphism_InBetweenPath_h
#define homeomorphism_InBetweenPath_h

#include "Kernel/Geometry.h"

#include <array>
#include <cstdint>
#include <vector>

namespace homeomorphism
{

/// The triangles that fold at a time between 0 and 1 on a path from a source to a target.
struct PathFolds
{
  /// Number of triangles that are degenerate or flipped relative to the source at some time.
  std::int64_t Triangles = 0;
  /// Index of the triangle that folds first; -1 if none does.
  std::int64_t FirstTriangle = -1;
  /// The time at which the first triangle folds, and the time at which the last one has unfolded:
  /// a closed interval within [0, 1]; 1 and 0 if none folds.
  double Begin = 1.0;
  double End = 0.0;
};

/// A path from a source to a target, two planar meshes with the same triangles. In the complex
/// plane, the point with source p and target q is at time t at
///
///     (1 - t) c + t d + a^t ((1 - t) (p - c) + t (q - d) / a),     a^t = |a|^t exp(i t arg a),
///
/// with the centers c, d and the similarity a. With a = 1, this is the straight path. Otherwise,
/// the mesh as a whole rotates and scales by a^t, while its points move along straight lines
/// relative to it. In both cases, the area of a triangle is |a|^(2t) times a quadratic function of
/// t, so the times at which it folds are known in closed form.
class InBetweenPath
{
public:
  /// The path with the best-fitting similarity (least squares over the points) if @a rotating,
  /// otherwise the straight path. Corresponding points have the same index. If a mesh has no
  /// extent, the path is straight.
  InBetweenPath(
    const std::vector<Vector2>& source, const std::vector<Vector2>& target, bool rotating);

  /// The angle of the similarity, in radians, within [-pi, pi], and its factor.
  double GetAngle() const { return this->Angle; }
  double GetFactor() const;

  /// The position of a point at a time; at 0 and 1 exactly that in source and target.
  Vector2 GetPosition(const Vector2& source, const Vector2& target, double time) const;

  /// The folds of triangles, given as triples of indices of points.
  PathFolds FindFolds(const std::vector<std::array<std::int64_t, 3>>& triangles,
    const std::vector<Vector2>& source, const std::vector<Vector2>& target) const;

private:
  /// A vector of the target relative to the moving mesh: v / a.
  Vector2 Unturned(const Vector2& v) const;

  Vector2 Centers[2];
  double Angle = 0.0;
  double LogFactor = 0.0;
};

} // namespace homeomorphism

#endif
