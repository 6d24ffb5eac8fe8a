// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file InBetweenPath.h
/// Paths of a planar mesh's points from a source to a target, and where triangles fold on the way.

#ifndef homeomorphism_InBetweenPath_h
#define homeomorphism_InBetweenPath_h

#include "Kernel/Geometry.h"

#include <array>
#include <cstdint>
#include <vector>

namespace homeomorphism
{

/// The triangles that are turned over at a time between 0 and 1, on a path from a source to a
/// target.
struct PathFolds
{
  /// Number of triangles that have another orientation than in the source, or none, at some time.
  std::int64_t Triangles = 0;
  /// The one that folds first, an index from 0; -1 if none does.
  std::int64_t FirstTriangle = -1;
  /// When the first triangle folds and when the last has unfolded: a closed interval within [0, 1],
  /// empty (1, 0) if none folds.
  double Begin = 1.0;
  double End = 0.0;
};

/// A path from a source to a target, two planar meshes with the same triangles: in the complex
/// plane the point p at time t, on its way to q, is at
///
///     (1 - t) c + t d + a^t ((1 - t) (p - c) + t (q - d) / a),     a^t = |a|^t exp(i t arg a),
///
/// with the centers c, d and the similarity a. With a = 1 this is the straight path. Otherwise the
/// mesh turns and scales as a whole by a^t while its points move straight relative to it. In both
/// cases the area of a triangle is |a|^(2t) times a quadratic function of t, so that the times at
/// which it folds are known in closed form.
class InBetweenPath
{
public:
  /// The path whose similarity fits best (least squares over the points), if @a rotating, or the
  /// straight path. The points are those of all vertices, in the same order. A mesh without extent
  /// has the straight path only.
  InBetweenPath(
    const std::vector<Vector2>& source, const std::vector<Vector2>& target, bool rotating);

  /// The angle of the similarity, in radians, within [-pi, pi], and its factor.
  double GetAngle() const { return this->Angle; }
  double GetFactor() const;

  /// The position of a point at a time. At 0 and 1 the very points of source and target.
  Vector2 GetPosition(const Vector2& source, const Vector2& target, double time) const;

  /// The folds of triangles, given as triples of indices of points.
  PathFolds FindFolds(const std::vector<std::array<std::int64_t, 3>>& triangles,
    const std::vector<Vector2>& source, const std::vector<Vector2>& target) const;

private:
  /// The target's vector relative to the moving mesh: v / a.
  Vector2 Unturned(const Vector2& v) const;

  Vector2 Centers[2];
  double Angle = 0.0;
  double LogFactor = 0.0;
};

} // namespace homeomorphism

#endif
