// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Picture.h
/// Panels side by side, each with an image and lines over it, and a row of close-ups below.

#ifndef Picture_h
#define Picture_h

#include "vtkImageData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <string>
#include <vector>

struct Panel
{
  std::string Title;
  vtkSmartPointer<vtkImageData> Image;
  /// Drawn faintly.
  vtkSmartPointer<vtkPolyData> Mesh;
  /// Drawn prominently.
  vtkSmartPointer<vtkPolyData> Lines;
  std::array<double, 3> MeshColor;
  std::array<double, 3> LineColor;
  /// What the close-up shows: centre and half the side of a square.
  std::array<double, 3> CloseUp;
};

/// Draws the panels and writes a PNG. Needs a display (X).
void WritePicture(const std::vector<Panel>& panels, const std::string& fileName);

#endif
