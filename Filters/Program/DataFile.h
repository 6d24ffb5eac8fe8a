// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file DataFile.h
/// Reads and writes data sets of any kind through VTK's readers and writers.

#ifndef dhm_DataFile_h
#define dhm_DataFile_h

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <string>

namespace dhm
{

class InputFile;
class OutputFile;

/// Whether the format is one of pictures (png, jpg, tif, ...).
bool IsPicture(const std::string& format);

/// Whether the format is one of points and polygons and nothing else (obj, off, ply, stl).
bool IsMesh(const std::string& format);

/// Reads VTK's XML and legacy files, pictures, and such meshes. Throws Failure if the file cannot
/// be read as what its name says, or the format is not known: it is none of these, and none of @a
/// others, which the message names before them.
vtkSmartPointer<vtkDataObject> ReadData(const InputFile& file, const std::string& others = "");

/// Reads a picture or VTK image. A picture's pixels are at 0, 1, 2, ..., whatever resolution it
/// claims. Throws Failure.
vtkSmartPointer<vtkImageData> ReadImage(const InputFile& file);

/// Writes data: VTK's XML and legacy formats, pictures, and obj and off. Throws Failure if the
/// format is not known or not for such data, or the file cannot be written.
void WriteData(vtkDataObject* data, const OutputFile& file);

/// Throws Failure if WriteData does not know the format, so that nobody waits for a result that
/// cannot be written. The message names @a others, which somebody else writes, too.
void CheckOutputFormat(const std::string& format, const std::string& others = "");

} // namespace dhm

#endif
