// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Triangulation.h
/// The connectivity of a mesh: the points of each triangle and its neighbors across the edges.

#ifndef homeomorphism_Triangulation_h
#define homeomorphism_Triangulation_h

#include "LargeArray.h"

#include "vtkType.h"

#include <array>
#include <cstdint>
#include <vector>

namespace homeomorphism
{

/// Index of a triangle, from 0; -1 for none.
using TriangleIndex = std::int32_t;

/// Prefetches memory to hide its latency, where the compiler can.
inline void Prefetch(const void* address)
{
#if defined(__GNUC__)
  __builtin_prefetch(address);
#else
  (void)address;
#endif
}

inline void PrefetchToWrite(const void* address)
{
#if defined(__GNUC__)
  __builtin_prefetch(address, 1);
#else
  (void)address;
#endif
}

/// The number of points by which prefetching precedes use. Processors wait for a few dozen cache
/// lines at the same time; more prefetches at once would take longer.
constexpr int PrefetchDistance = 32;

/// The same edge, seen from the neighboring triangle.
struct Twin
{
  /// -1 on the boundary.
  TriangleIndex Triangle = -1;
  /// The shared edge in that triangle, 0 to 2.
  int Edge = 0;
  /// Whether both triangles traverse the edge in the same direction. This occurs only in meshes
  /// with mixed winding.
  bool SameDirection = false;
};

/// Triangles as triples of point ids, and their adjacency. Filled by TriangulationPair::Read,
/// constant afterwards. Corners and edges are numbered 0 to 2 in the order of the points of the
/// cell; edge k is opposite corner k.
class Triangulation
{
public:
  using Corners = std::array<std::int32_t, 3>;

  /// The number of triangles must be less than this; the adjacency cannot represent more.
  static constexpr vtkIdType MaximumTriangles = vtkIdType(1) << 28;

  TriangleIndex GetNumberOfTriangles() const
  {
    return static_cast<TriangleIndex>(this->Triangles.size());
  }

  const Corners& GetCorners(TriangleIndex triangle) const { return this->Triangles[triangle]; }

  /// The cell id of the triangle in the vtkPolyData from which it was read.
  vtkIdType GetCellId(TriangleIndex triangle) const { return this->FirstCell + triangle; }

  /// Whether the triangle is masked, that is, not part of the domain. Its edges are boundary edges.
  bool IsMasked(TriangleIndex triangle) const { return this->Masked[triangle] != 0; }

  Twin GetTwin(TriangleIndex triangle, int edge) const
  {
    const std::int32_t code = this->Adjacency[triangle][edge];
    if (code < 0)
    {
      return {};
    }
    return { code >> 3, (code >> 1) & 3, (code & 1) != 0 };
  }

  /// Prefetches the data that GetTwin reads.
  void PrefetchTwin(TriangleIndex triangle) const { Prefetch(&this->Adjacency[triangle]); }

  /// Sets the triangles. Their neighbors are not known until FindAdjacency is called. @a scratch is
  /// an array of the same size that is no longer needed, whose memory is reused.
  void SetTriangles(
    LargeArray<Corners> triangles, vtkIdType firstCell, LargeArray<Corners> scratch = {});
  void Mask(TriangleIndex triangle) { this->Masked[triangle] = 1; }

  /// Finds the neighbor across each edge, in linear time. Masked triangles are ignored. Returns, in
  /// ascending order, the triangles at edges of more than two triangles; such edges are treated as
  /// boundary edges.
  std::vector<TriangleIndex> FindAdjacency(vtkIdType numberOfPoints);

  /// Whether there are adjacent triangles that traverse their edge in the same direction.
  bool HasMixedWinding() const { return this->MixedWinding; }

  /// Returns, in ascending order, the triangles whose winding remains inconsistent with that of a
  /// neighbor after as many triangles as possible have been oriented consistently: none if the
  /// surface is orientable.
  std::vector<TriangleIndex> FindNonOrientable() const;

private:
  LargeArray<Corners> Triangles;
  std::vector<std::uint8_t> Masked;
  // Twin triangle, its edge and direction: triangle * 8 + edge * 2 + same direction.
  LargeArray<Corners> Adjacency;
  bool MixedWinding = false;
  vtkIdType FirstCell = 0;
};

} // namespace homeomorphism

#endif
