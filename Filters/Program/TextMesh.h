// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TextMesh.h
/// Meshes in the text formats OBJ and OFF, with all digits (VTK reads and writes single precision
/// there): points and polygons, nothing else.

#ifndef dhm_TextMesh_h
#define dhm_TextMesh_h

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <iosfwd>
#include <string>

namespace dhm
{

/// @name Reading
/// The file's name is for messages. They throw Failure, naming file and line, if the text is no
/// such mesh.
///@{
vtkSmartPointer<vtkPolyData> ReadObj(std::istream& file, const std::string& fileName);
vtkSmartPointer<vtkPolyData> ReadOff(std::istream& file, const std::string& fileName);
///@}

/// @name Writing
///@{
void WriteObj(vtkPolyData* mesh, std::ostream& file);
void WriteOff(vtkPolyData* mesh, std::ostream& file);
///@}

} // namespace dhm

#endif
