// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file VTKVersions.h
/// Differences between versions of VTK. They are detected by the presence of methods rather than by
/// version numbers, because ParaView's VTK has version numbers of its own.

#ifndef homeomorphism_VTKVersions_h
#define homeomorphism_VTKVersions_h

#include "vtkAlgorithm.h"
#include "vtkImageData.h"
#include "vtkUnstructuredGrid.h"

namespace homeomorphism
{
namespace versions
{

template <typename Algorithm>
auto ShouldAbort(Algorithm* self, int) -> decltype(self->CheckAbort())
{
  return self->CheckAbort();
}
template <typename Algorithm>
bool ShouldAbort(Algorithm* self, long)
{
  return self->GetAbortExecute() != 0;
}

template <typename Image>
auto HasPointArray(Image* image, int) -> decltype(image->GetPoints(), bool())
{
  return true;
}
template <typename Image>
bool HasPointArray(Image*, long)
{
  return false;
}

template <typename Grid>
auto GetCellTypes(Grid* grid, int) -> decltype(grid->GetCellTypes())
{
  return grid->GetCellTypes();
}
template <typename Grid>
auto GetCellTypes(Grid* grid, long)
{
  return grid->GetCellTypesArray();
}

template <typename Grid>
auto CopyCells(Grid* from, Grid* to, int) -> decltype(from->GetPolyhedronFaceLocations(), void())
{
  to->SetPolyhedralCells(GetCellTypes(from, 0), from->GetCells(),
    from->GetPolyhedronFaceLocations(), from->GetPolyhedronFaces());
}
template <typename Grid>
auto CopyCells(Grid* from, Grid* to, long) -> decltype(from->GetFaceLocations(), void())
{
  to->SetCells(GetCellTypes(from, 0), from->GetCells(), from->GetFaceLocations(), from->GetFaces());
}

} // namespace versions

/// Whether an algorithm has been requested to abort. Since VTK 9.3, this includes requests to
/// upstream algorithms.
inline bool ShouldAbort(vtkAlgorithm* self)
{
  return versions::ShouldAbort(self, 0);
}

/// Whether GetPoint of an image reads an implicit array of points, as it does since VTK 9.5. Its
/// rounding then differs from that of TransformIndexToPhysicalPoint.
inline bool HasPointArray(vtkImageData* image)
{
  return versions::HasPointArray(image, 0);
}

/// Copies the cells of one grid to another, including polyhedra. VTK 9.4 renamed the lists of
/// faces, and VTK 9.6 the list of types.
inline void CopyCells(vtkUnstructuredGrid* from, vtkUnstructuredGrid* to)
{
  versions::CopyCells(from, to, 0);
}

} // namespace homeomorphism

#endif
