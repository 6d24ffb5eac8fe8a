// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PlyMesh.h
/// Stanford's polygon files.

#ifndef dhm_PlyMesh_h
#define dhm_PlyMesh_h

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <iosfwd>
#include <string>

namespace dhm
{

/// Reads the points and faces of a PLY file, text or binary. (VTK 9.1's reader rounds coordinates
/// to single precision and crashes on files that have been cut off.) Throws Failure, naming the
/// place, if it is not one.
vtkSmartPointer<vtkPolyData> ReadPly(std::istream& file, const std::string& fileName);

} // namespace dhm

#endif
