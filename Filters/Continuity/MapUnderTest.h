// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MapUnderTest.h
/// Maps that are evaluated pointwise, relative to a local origin.
///
/// Difference quotients of coordinates far from the origin lose all digits that the coordinates
/// have in common. Therefore, features are measured in coordinates relative to a point of the mesh
/// at the feature, in the domain and in the image.

#ifndef homeomorphism_MapUnderTest_h
#define homeomorphism_MapUnderTest_h

#include "Mesh/Homeomorphism.h"

#include <cstdint>
#include <functional>
#include <vector>

class vtkAbstractTransform;

namespace homeomorphism
{

/// The position of a feature in the mesh.
struct Vicinity
{
  /// The point of the mesh that is the local origin.
  std::int32_t Origin = 0;
  /// The triangles at the feature. All rays from the feature lie in them.
  std::vector<TriangleIndex> Triangles;
};

/// A map near a feature.
struct LocalMap
{
  /// Maps a point, relative to the local origin, to its image, relative to the image of the origin.
  /// Returns false if there is no image.
  std::function<bool(const Vector3& point, Vector3& image)> Evaluate;
  /// The magnitudes of the coordinates of points and images that determine their rounding errors,
  /// in addition to those of the relative coordinates.
  double PointMagnitude = 0.0;
  double ImageMagnitude = 0.0;
};

/// A map that can be evaluated near a feature.
using MapUnderTest = std::function<LocalMap(const Vicinity& vicinity)>;

/// The values of a homeomorphism, which must outlive the result.
MapUnderTest MakeMapUnderTest(const Homeomorphism& map);

/// The values of any transform, on the source of @a map. Both must outlive the result.
MapUnderTest MakeMapUnderTest(vtkAbstractTransform* transform, const Homeomorphism& map);

/// Conversions between coordinates relative to a point of the mesh and those in a triangle's frame.
///@{
Vector2 ToFrame(const TriangulationPair& pair, Domain domain, TriangleIndex triangle,
  std::int32_t origin, const Vector3& point);
Vector3 FromFrame(const TriangulationPair& pair, Domain domain, TriangleIndex triangle,
  std::int32_t origin, const Vector2& point);
///@}

/// The point of the mesh that is the origin of a triangle's frame.
std::int32_t GetFrameOrigin(const TriangulationPair& pair, Domain domain, TriangleIndex triangle);

} // namespace homeomorphism

#endif
