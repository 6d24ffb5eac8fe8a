// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicHomeomorphism.h
/// The Cubic map between the planes of two meshes.

#ifndef homeomorphism_CubicHomeomorphism_h
#define homeomorphism_CubicHomeomorphism_h

#include "CubicMap.h"
#include "TriangulationPair.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace homeomorphism
{

/// A CubicMap of a planar TriangulationPair, in both meshes' normalized coordinates. Triangles are
/// turned counterclockwise for it, and a mirrored target is mirrored back. Immutable; any number of
/// threads may use it.
class CubicHomeomorphism
{
public:
  /// Both meshes must be planar. The options' MaximumDeviation is in the target's input units.
  CubicHomeomorphism(const TriangulationPair& pair, CubicMapOptions options);

  const CubicMap& GetMap() const { return *this->Map; }

  /// Fetches what MapPoint reads of a triangle into the processor's cache.
  void PrefetchTriangle(TriangleIndex triangle) const
  {
    const CubicNet* net = this->Map->GetNet(this->Numbers[triangle]);
    if (net)
    {
      for (std::size_t at = 0; at < sizeof(CubicNet); at += 64)
      {
        Prefetch(reinterpret_cast<const char*>(net) + at);
      }
    }
  }

  /// Sets points @a begin to @a end - 1 of a batch, which lie in one triangle, from arrays of their
  /// barycentric coordinates for the triangle's corners and of their places in its frame. Reads and
  /// overwrites up to WidestVector - 1 elements after the last.
  void SetPoints(Domain from, TriangleIndex triangle, int begin, int end, const double* const l[3],
    const double* const inFrame[2], CubicBatch& batch) const;

  /// Maps the points of a batch to the plane of the other mesh. Their triangles become the map's,
  /// -1 where there is no image: in triangles in which the map is not certified. @a prepared is
  /// the map's.
  void MapPoints(Domain from, CubicBatch& batch, CubicTriangle& prepared) const;

  /// The points of the map's source that belong to a batch which MapPoints has mapped, and their
  /// triangles in the map: the points themselves or their preimages. @a triangles are the meshes'.
  void GetSourcePoints(Domain from, const TriangleIndex* triangles, const CubicBatch& batch,
    double* x, double* y, int* numbers) const;

  /// The image of one point, to the same bits, in the plane of the other mesh. Returns false if
  /// there is none. Sets the derivative from frame to frame unless it is null: to NaN where there
  /// is no image.
  bool MapPoint(Domain from, TriangleIndex triangle, const Barycentric& l, const Vector2& inFrame,
    Vector2& image, Matrix2* derivative = nullptr) const;

  /// The derivative, from frame to frame of a mesh's triangle, at a point of the map's source.
  Matrix2 Derive(Domain from, TriangleIndex triangle, int number, const Vector2& point) const;

  /// The least Bernstein coefficient of the determinant over the piecewise linear map's, 0 for a
  /// masked triangle.
  double GetCertificate(TriangleIndex triangle) const
  {
    return this->Numbers[triangle] < 0 ? 0.0
                                       : this->Map->GetCertificates()[this->Numbers[triangle]];
  }

  /// Points of the mesh at which the map has no derivative, ascending.
  std::vector<std::int32_t> GetExceptionalPoints(bool interior) const;

private:
  void LeaveUncertified(CubicBatch& batch) const;

  const TriangulationPair& Pair;
  std::unique_ptr<CubicMap> Map;
  /// Triangles and points of the map by those of the meshes, and back; -1 for masked ones.
  LargeVector<std::int32_t> Numbers;
  LargeVector<std::int32_t> Triangles;
  LargeVector<std::int32_t> Points;
  /// Whether the target is a mirror image.
  bool IsMirrored = false;
  /// Whether a triangle's corners 1 and 2 are exchanged in the map.
  LargeVector<std::uint8_t> Reversed;
};

} // namespace homeomorphism

#endif
