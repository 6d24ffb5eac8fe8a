// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PointBlocks.h
/// Reading, writing and processing points of VTK objects in blocks.

#ifndef homeomorphism_PointBlocks_h
#define homeomorphism_PointBlocks_h

#include "VTKVersions.h"

#include "Mesh/Homeomorphism.h"

#include "vtkAlgorithm.h"
#include "vtkDataSet.h"
#include "vtkSMPTools.h"
#include "vtkType.h"

#include <algorithm>

class vtkDataArray;

namespace homeomorphism
{

/// The relative rounding error of coordinates of a VTK type.
double PrecisionOfType(int dataType);

/// The relative rounding error of the points of a data set; that of double for implicit points.
double PrecisionOfPoints(vtkDataSet* data);

/// Reads the points of a block from an array of 3 components, starting with tuple @a first.
void ReadPoints(vtkDataArray* array, vtkIdType first, PointBlock& block);

/// Reads the points of a block from a data set, starting with point @a first.
void ReadPoints(vtkDataSet* data, vtkIdType first, PointBlock& block);

/// If possible, lets MapBlock write the images of a block directly to an array of 3 components,
/// from tuple @a first. The array must be of type double and have room before tuple @a end for the
/// elements that MapBlock overwrites after the last image. Otherwise WritePoints copies the images.
void SetImages(vtkDataArray* array, vtkIdType first, vtkIdType end, PointBlock& block);

/// Writes points to an array of 3 components, from tuple @a first, unless they are already there.
void WritePoints(const double (*points)[3], int count, vtkIdType first, vtkDataArray* array);

/// Calls work(begin, end) in parallel over [0, count), in blocks. Between blocks, progress is
/// reported and abort requests are checked. A block should take a fraction of a second. Returns the
/// number of items processed, which is less than @a count only after an abort.
template <typename Work>
vtkIdType RunInBlocks(vtkAlgorithm* self, vtkIdType count, double progressBegin, double progressEnd,
  Work&& work, vtkIdType blockSize = 1 << 17)
{
  for (vtkIdType begin = 0; begin < count; begin += blockSize)
  {
    self->UpdateProgress(progressBegin +
      (progressEnd - progressBegin) * static_cast<double>(begin) / static_cast<double>(count));
    if (ShouldAbort(self))
    {
      return begin;
    }
    vtkSMPTools::For(begin, std::min(count, begin + blockSize), work);
  }
  return count;
}

/// Reads, locates and maps the points of a data set in parallel, block by block, and calls
/// use(first, block) with each block. Points for which isHidden(id) holds are treated as outside.
/// Images are written directly to @a images if possible (see SetImages). @a keepReferences must be
/// true if @a use computes Jacobians. Returns the number of points processed; see RunInBlocks.
template <typename IsHidden, typename Use>
vtkIdType MapInBlocks(vtkAlgorithm* self, const Homeomorphism& map, Domain from, vtkDataSet* data,
  double tolerance, double progressBegin, double progressEnd, IsHidden&& isHidden,
  vtkDataArray* images, bool keepReferences, Use&& use)
{
  return RunInBlocks(self, data->GetNumberOfPoints(), progressBegin, progressEnd,
    [&](vtkIdType begin, vtkIdType end) {
      LocationHint hint;
      PointBlock block;
      block.KeepsReferences = keepReferences;
      for (vtkIdType first = begin; first < end; first += PointBlock::Capacity)
      {
        block.Count = static_cast<int>(std::min<vtkIdType>(PointBlock::Capacity, end - first));
        ReadPoints(data, first, block);
        SetImages(images, first, end, block);
        map.LocateBlock(from, block, tolerance, hint);
        for (int i = 0; i < block.Count; ++i)
        {
          block.Triangles[i] = isHidden(first + i) ? -1 : block.Triangles[i];
        }
        map.MapBlock(from, block);
        use(first, block);
      }
    });
}

} // namespace homeomorphism

#endif
