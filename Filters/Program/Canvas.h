// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Canvas.h
/// Drawings as PNG, SVG and PDF, without a display.

#ifndef dhm_Canvas_h
#define dhm_Canvas_h

#include "vtkType.h"

#include <array>
#include <functional>
#include <memory>
#include <string>

class vtkImageData;
class vtkPolyData;

namespace dhm
{

class OutputFile;

/// Red, green, blue and opacity, from 0 to 1.
struct Color
{
  double Red = 0.0;
  double Green = 0.0;
  double Blue = 0.0;
  double Opacity = 1.0;
};

/// An area of a page, in its units (pixels, in a PNG), y downwards.
struct Area
{
  double Left = 0.0;
  double Top = 0.0;
  double Width = 0.0;
  double Height = 0.0;
};

/// A page to draw on.
class Canvas
{
public:
  /// Whether the format is one of drawings (png, svg, pdf).
  static bool IsFormat(const std::string& format);

  Canvas(double width, double height, const OutputFile& file);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// From here on, drawing is done in the coordinates of meshes and images: @a bounds (xmin, xmax,
  /// ymin, ymax, y upwards) is shown in the middle of @a area, as large as fits, and nothing
  /// outside the area.
  void Enter(const Area& area, const std::array<double, 4>& bounds);
  /// Back to the page's own units.
  void Leave();

  void FillPage(const Color& color);
  void DrawFrame(const Area& area, const Color& color);
  /// A vtkPolyData's lines, or the sides of its polygons. @a width in the page's units.
  void DrawLines(vtkPolyData* data, const Color& color, double width);
  void DrawEdges(vtkPolyData* mesh, const Color& color, double width);
  /// Polygons of a mesh: those of which @a isShown says so.
  void FillCells(
    vtkPolyData* mesh, const std::function<bool(vtkIdType cell)>& isShown, const Color& color);
  /// A dot, its radius in the page's units.
  void DrawDot(double x, double y, double radius, const Color& color);
  /// An image of 1 to 4 components (the brightest of a type being white), at its place.
  void DrawImage(vtkImageData* image);
  /// Text whose line is centerd (or begins) at a place of the page.
  void Write(const std::string& text, double x, double y, double size, bool centered = true);

  /// Ends the drawing. Throws Failure if it cannot be written.
  void Finish();

private:
  class Internals;
  std::unique_ptr<Internals> Internal;
};

} // namespace dhm

#endif
