// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PointBlock.h
/// Points that are located and mapped together.

#ifndef homeomorphism_PointBlock_h
#define homeomorphism_PointBlock_h

#include "MeshGeometry.h"
#include "Triangulation.h"

#include "Kernel/Simd/Vectorize.h"
#include "Kernel/SmoothChart.h"

#include <memory>

namespace homeomorphism
{

class CubicHomeomorphism;
class CubicTriangle;

/// A point of a triangulation.
struct SurfacePoint
{
  /// -1 if the point is outside.
  TriangleIndex Triangle = -1;
  /// The point in the frame of the triangle, moved to the nearest point of the closed triangle.
  FramePoint Point;
  /// The corner of the triangle (0 to 2) that equals the point bit for bit, or -1.
  int Corner = -1;
};

/// Information from previous points that makes the location of the next ones faster. It does not
/// change results.
struct LocationHint
{
  TriangleIndex Triangle = -1;
  /// The recent number of consecutive points in one triangle.
  int RunLength = 1;
  /// Whether most points of the last block were not in the triangle of the point before.
  bool IsScattered = false;
};

/// Up to Capacity points that are located and mapped together, which takes a fraction of the time
/// of single points. Not copyable, because it refers to its own buffers.
struct PointBlock
{
  static constexpr int Capacity = SmoothBatch::Capacity;
  static constexpr int Size = SmoothBatch::Size;

  PointBlock() = default;
  PointBlock(const PointBlock&) = delete;
  PointBlock& operator=(const PointBlock&) = delete;

  int Count = 0;
  /// The points, in the buffer or in an array of the caller.
  const double (*Points)[3] = this->PointBuffer;
  /// The images of the points; points outside are copied. Set by MapBlock, which may overwrite up
  /// to WidestVector - 1 elements after the last. In the buffer or in an array of the caller.
  double (*Images)[3] = this->ImageBuffer;

  /// The located points (see SurfacePoint), as a structure of arrays.
  TriangleIndex Triangles[Capacity];
  int Corners[Capacity];
  double InPlane[2][Size];
  double Offsets[Size];
  /// Barycentric coordinates of the apex of the triangle's frame, the corner after it and the one
  /// before it.
  double Apex[Size];
  double First[Size];
  double Second[Size];

  /// Whether the data that GetJacobian needs is kept when points are mapped.
  bool KeepsReferences = false;
  /// In the Smooth system: the references for a corner, the next one and the previous one, and the
  /// number of that corner. In the Cubic system: points of the map's source, and their triangles.
  double References[3][Size];
  int ReferencePlaces[Capacity];

  double PointBuffer[Capacity][3];
  double ImageBuffer[Size][3];

  /// The Cubic map of the last points, and its working data, which is kept for the next block.
  std::shared_ptr<const CubicHomeomorphism> Cubic;
  std::shared_ptr<CubicTriangle> PreparedCubics;

  SurfacePoint GetSurfacePoint(int i) const
  {
    return { this->Triangles[i], { { this->InPlane[0][i], this->InPlane[1][i] }, this->Offsets[i] },
      this->Corners[i] };
  }
};

} // namespace homeomorphism

#endif
