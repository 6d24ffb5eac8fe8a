// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Drawing.h
/// Line drawings of geometry: panels with coordinates of their own, on a white page.

#ifndef Drawing_h
#define Drawing_h

#include "vtkImageData.h"
#include "vtkPolyData.h"

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

using Point = std::array<double, 2>;
using Curve = std::vector<Point>;

struct Color
{
  double Red = 0.0;
  double Green = 0.0;
  double Blue = 0.0;
  double Opacity = 1.0;
};

/// Lengths are in pixels of the finished picture.
struct Pen
{
  Color Ink;
  double Width = 1.0;
  /// Length of a dash; 0 for solid lines.
  double Dash = 0.0;
};

/// In the page's pixels (from its lower left corner), or in a panel's coordinates.
struct Rectangle
{
  double Left = 0.0;
  double Bottom = 0.0;
  double Width = 0.0;
  double Height = 0.0;
};

enum class Alignment
{
  Left,
  Center,
  Right
};

struct Lettering
{
  double Size = 16.0;
  Color Ink = { 0.13, 0.14, 0.17 };
  Alignment Horizontal = Alignment::Center;
  /// Degrees, counterclockwise; markup is not understood in turned text.
  double Orientation = 0.0;
  bool Halo = true;
};

class Drawing;

/// Something to draw on. Lines and areas are cut off at its border, labels are not.
class Panel
{
public:
  /// Shows @a world in @a place: the same scale in x and y, centerd, or as it takes to fill the
  /// place if it is @a stretched.
  Panel(Drawing& drawing, const Rectangle& place, const Rectangle& world, bool stretched = false);

  Point ToPage(const Point& point) const;
  const Rectangle& GetPlace() const { return this->Place; }

  /// A polygon that is star-shaped about the mean of its corners.
  void Fill(const Curve& polygon, const Color& color);
  /// Parallel lines across a convex polygon, @a spacing pixels apart.
  void Hatch(const Curve& polygon, double spacing, const Pen& pen);
  void Stroke(const Curve& curve, const Pen& pen);
  void StrokeClosed(Curve polygon, const Pen& pen);
  /// All lines of a vtkPolyData.
  void StrokeLines(vtkPolyData* lines, const Pen& pen);
  /// All sides of the polygons of a vtkPolyData, each once.
  void StrokeEdges(vtkPolyData* mesh, const Pen& pen);
  void StrokeArc(
    const Point& center, double radius, double fromAngle, double toAngle, const Pen& pen);
  void StrokeCircle(const Point& center, double radius, const Pen& pen);
  void FillCircle(const Point& center, double radius, const Color& color);
  /// A dot whose radius is in pixels.
  void Dot(const Point& center, double radius, const Color& color);
  void Ring(const Point& center, double radius, const Color& inside, const Pen& pen);
  void Arrow(const Point& from, const Point& to, const Pen& pen);
  /// Two short lines that make a square with the directions from @a corner to the other two points.
  void RightAngle(
    const Point& corner, const Point& first, const Point& second, double size, const Pen& pen);
  /// A color image, at its own origin and spacing.
  void Image(vtkImageData* image);
  void Frame(const Pen& pen);
  /// Text beside a point, @a offset in pixels. Its middle line is at the point's height. Between
  /// two dollar signs letters are set as variables; _x, ^x, _{...}, ^{...} are set low and high.
  void Label(const Point& point, const std::string& text, const Lettering& lettering = {},
    const Point& offset = { 0.0, 0.0 });

private:
  void Triangle(const Point& a, const Point& b, const Point& c, const Color& color);
  void StrokeOnPage(const Curve& curve, const Pen& pen);
  void DotOnPage(const Point& center, double radius, const Color& color);

  Drawing& Page;
  Rectangle Place;
  Point Scale;
  Point Origin;
};

class Drawing
{
public:
  /// The finished picture's size in pixels.
  Drawing(int width, int height);

  /// The whole page, with the page's own coordinates.
  Panel GetPage();

  /// A vertical bar that shows @a colorOf from 0 (bottom) to 1, with labels on its right.
  void ColorBar(const Rectangle& place, const std::function<Color(double)>& colorOf,
    const std::vector<std::pair<double, std::string>>& ticks);

  /// Renders and writes a PNG. Needs a display (X). Throws std::runtime_error if it cannot be
  /// written.
  void Write(const std::string& fileName) const;

private:
  friend class Panel;

  struct Text
  {
    Point Position;
    std::string Content;
    Lettering Style;
  };

  int Width;
  int Height;
  /// Triangles, three after another, in the order in which they cover each other.
  std::vector<Point> Corners;
  std::vector<std::array<unsigned char, 4>> Colors;
  std::vector<Text> Texts;
};

/// @name Points of the plane
///@{
Point Add(const Point& a, const Point& b, double factor = 1.0);
Point Subtract(const Point& a, const Point& b);
Point Between(const Point& a, const Point& b, double proportion);
double ScalarProduct(const Point& a, const Point& b);
double Length(const Point& a);
///@}

/// A number with this many decimals, with a minus sign that is as long as a plus.
std::string Decimal(double value, int decimals);

/// What the eight programs have in common: finds the folder among the arguments (an argument that
/// is no option; Output/Figures by default), makes it, hands @a draw its path, and reports what
/// goes wrong. Options are handed on, too. Returns what main should.
int RunFigure(int argc, char* argv[], const std::vector<std::string>& options,
  const std::function<void(const std::string& folder, const std::vector<std::string>& given)>&
    draw);

#endif
