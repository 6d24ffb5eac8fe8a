// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MappedRow.h
/// Mapping rows of points in blocks for callers that request the points one by one.

#ifndef homeomorphism_MappedRow_h
#define homeomorphism_MappedRow_h

#include "Mesh/PointBlock.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace homeomorphism
{

/// The points that a caller will probably request next, and their images. Callers such as
/// vtkImageReslice request the points of a row, at equal steps. After a few equal steps, the next
/// points are mapped as a block, which takes a fraction of the time; the results are the same, bit
/// for bit. The image of a point is used only if its coordinates equal those that were mapped.
/// Steps that differ by rounding are not followed. For one thread.
class MappedRow
{
public:
  /// The index of a point in GetBlock(), or -1 if its image is not there. @a key identifies the
  /// map, its tolerance, and the domain. mapBlock(block, hint) locates and maps a block.
  template <typename MapBlock>
  int Find(const double point[3], std::uint64_t key, MapBlock&& mapBlock)
  {
    const bool isSameMap = key == this->Key;
    const bool mayBeNext = isSameMap && this->Next < this->Block.Count;
    constexpr std::size_t size = 3 * sizeof(double);
    // Bits are compared. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    if (mayBeNext && std::memcmp(point, this->Block.PointBuffer[this->Next], size) == 0)
    {
      return this->Next++;
    }
    bool isRow = isSameMap;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double step = point[axis] - this->Last[axis];
      isRow = isRow && step == this->Step[axis];
      this->Step[axis] = step;
      this->Last[axis] = point[axis];
    }
    this->Key = key;
    this->Hint = isSameMap ? this->Hint : LocationHint();
    this->EqualSteps = isRow ? this->EqualSteps + 1 : 0;
    this->Length = isRow ? this->Length : Shortest;
    this->Block.Count = 0;
    constexpr int enough = 4;
    if (this->EqualSteps < enough)
    {
      return -1;
    }
    this->Block.Count = this->Length;
    for (int i = 0; i < this->Length; ++i)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        this->Last[axis] = point[axis] + i * this->Step[axis];
        this->Block.PointBuffer[i][axis] = this->Last[axis];
      }
    }
    // Blocks become longer while a row continues.
    this->Length = std::min(2 * this->Length, PointBlock::Capacity);
    mapBlock(this->Block, this->Hint);
    this->Next = 1;
    return 0;
  }

  const PointBlock& GetBlock() const { return this->Block; }

private:
  static constexpr int Shortest = 16;

  std::uint64_t Key = 0;
  double Last[3] = { 0.0, 0.0, 0.0 };
  double Step[3] = { 0.0, 0.0, 0.0 };
  int EqualSteps = 0;
  int Length = Shortest;
  int Next = 0;
  LocationHint Hint;
  PointBlock Block;
};

} // namespace homeomorphism

#endif
