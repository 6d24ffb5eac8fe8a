// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PictureFile.h
/// Pictures that VTK 9.1 does not read or write safely: its reader of PNG crashes on damaged files,
/// that of PNM takes what is missing for black, and that of TIFF turns pictures with opacity upside
/// down.

#ifndef dhm_PictureFile_h
#define dhm_PictureFile_h

#include "vtkImageData.h"
#include "vtkSmartPointer.h"

namespace dhm
{

class InputFile;
class OutputFile;

/// @name Reading
/// Pixels of one, two, three or four components (gray or colors, and opacity) of 8 or 16 bits,
/// from the lower left. They throw Failure if the file is no such picture, or is damaged.
///@{
vtkSmartPointer<vtkImageData> ReadPng(const InputFile& file);
/// PGM and PPM, binary and text.
vtkSmartPointer<vtkImageData> ReadPnm(const InputFile& file);
/// Whatever libtiff reads; numbers of 8 to 64 bits as they are.
vtkSmartPointer<vtkImageData> ReadTiff(const InputFile& file);
///@}

/// @name Writing
/// They throw Failure if such pictures cannot hold the pixels, or the file cannot be written.
///@{
void WritePnm(vtkImageData* image, const OutputFile& file);
void WriteTiff(vtkImageData* image, const OutputFile& file);
///@}

} // namespace dhm

#endif
