// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file StlMesh.h
/// Triangles as stereolithography has them: each with points of its own.

#ifndef dhm_StlMesh_h
#define dhm_StlMesh_h

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <iosfwd>
#include <string>

namespace dhm
{

/// Reads an STL file, text or binary; no points are joined. (VTK 9.1's reader does not notice where
/// binary files have been cut off.) Throws Failure, naming the place, if it is not one.
vtkSmartPointer<vtkPolyData> ReadStl(std::istream& file, const std::string& fileName);

} // namespace dhm

#endif
