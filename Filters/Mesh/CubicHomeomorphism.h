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

/// A point that is mapped.
struct CubicPoint
{
  /// The triangle in the source of the CubicMap, -1 if the point has no image.
  int Number;
  /// The point itself or its preimage, in the source of the CubicMap.
  Vector2 InSource;
  /// The image in the plane of the other mesh.
  Vector2 Image;

  bool Exists() const { return this->Number >= 0; }
};

/// A CubicMap of a planar TriangulationPair, in the normalized coordinates of both meshes. For it,
/// triangles are oriented counterclockwise, and a mirrored target is reflected. Immutable; any
/// number of threads may use it.
class CubicHomeomorphism
{
public:
  /// Both meshes must be planar. The options' MaximumDeviation is in the target's input units.
  CubicHomeomorphism(const TriangulationPair& pair, CubicMapOptions options);

  const CubicMap& GetMap() const { return *this->Map; }

  /// Prefetches the data of a triangle that MapPoint reads.
  void PrefetchTriangle(Domain from, TriangleIndex triangle) const
  {
    const std::int32_t number = this->Numbers[triangle];
    PrefetchAll(this->Map->GetNet(number));
    if (from == Domain::Target)
    {
      PrefetchAll(this->Map->GetInverse(number));
    }
  }

  /// Sets points @a begin to @a end - 1 of a batch, which lie in one triangle, from arrays of their
  /// barycentric coordinates for the triangle's corners and of their coordinates in its frame.
  /// Reads and overwrites up to WidestVector - 1 elements after the last.
  void SetPoints(Domain from, TriangleIndex triangle, int begin, int end, const double* const l[3],
    const double* const inFrame[2], CubicBatch& batch) const;

  /// Maps the points of a batch to the plane of the other mesh. Their triangles become those of the
  /// CubicMap, -1 if there is no image because the map is not certified in the triangle. @a
  /// prepared is that of GetMap().Prepare().
  void MapPoints(Domain from, CubicBatch& batch, CubicTriangle& prepared) const;

  /// For a batch that MapPoints has mapped, the points in the source of the CubicMap (the points
  /// themselves, or their preimages) and their triangles there. @a triangles are those of the
  /// meshes.
  void GetSourcePoints(Domain from, const TriangleIndex* triangles, const CubicBatch& batch,
    double* x, double* y, int* numbers) const;

  /// Maps one point. The image is the same, bit for bit, as that of MapPoints.
  CubicPoint MapPoint(Domain from, TriangleIndex triangle, const Barycentric& l,
    const Vector2& inFrame, CubicTriangle& prepared) const;

  /// The derivative, from plane to plane, at a point of triangle @a number of the source of the
  /// CubicMap; NaN if @a number is negative.
  Matrix2 Derive(Domain from, int number, const Vector2& point, CubicTriangle& prepared) const;

  /// The smallest Bernstein coefficient of the determinant, divided by the determinant of the
  /// piecewise linear map; 0 for a masked triangle.
  double GetCertificate(TriangleIndex triangle) const
  {
    return this->Numbers[triangle] < 0 ? 0.0
                                       : this->Map->GetCertificates()[this->Numbers[triangle]];
  }

  /// Points of the mesh at which the map has no derivative, ascending.
  std::vector<std::int32_t> GetExceptionalPoints(bool interior) const;

private:
  void LeaveUncertified(CubicBatch& batch) const;

  template <typename Data>
  static void PrefetchAll(const Data* data)
  {
    for (std::size_t at = 0; data && at < sizeof(Data); at += 64)
    {
      Prefetch(reinterpret_cast<const char*>(data) + at);
    }
  }

  const TriangulationPair& Pair;
  std::unique_ptr<CubicMap> Map;
  /// The triangles of the CubicMap for those of the meshes (-1 if masked), and the reverse; and the
  /// points of the meshes for those of the CubicMap.
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
