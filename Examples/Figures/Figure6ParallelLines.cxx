// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Parallel lines across a polygon, and their images on another one in the three coordinate systems.

#include "Drawing.h"
#include "Meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const Color edgeColor{ 0.60, 0.63, 0.69 };
const Color fillColor{ 0.965, 0.97, 0.98 };

/// The lines' colors, from the first to the last.
Color ColorOf(double share)
{
  const Color first{ 0.10, 0.30, 0.62 };
  const Color middle{ 0.62, 0.16, 0.46 };
  const Color last{ 0.90, 0.46, 0.10 };
  const Color& a = share < 0.5 ? first : middle;
  const Color& b = share < 0.5 ? middle : last;
  const double weight = share < 0.5 ? 2.0 * share : 2.0 * share - 1.0;
  return { a.Red + weight * (b.Red - a.Red), a.Green + weight * (b.Green - a.Green),
    a.Blue + weight * (b.Blue - a.Blue) };
}

struct ColoredCurve
{
  Curve Points;
  Color Ink;
};

void DrawPolygon(
  Panel& panel, vtkPolyData* mesh, const std::vector<ColoredCurve>& lines, double width)
{
  for (vtkIdType triangle = 0; triangle < mesh->GetNumberOfCells(); ++triangle)
  {
    panel.Fill(GetTriangle(mesh, triangle), fillColor);
  }
  panel.StrokeEdges(mesh, { edgeColor, 0.7 * width });
  for (const ColoredCurve& line : lines)
  {
    panel.Stroke(line.Points, { line.Ink, width });
  }
  for (const Curve& edge : BoundaryEdges(mesh))
  {
    panel.Stroke(edge, { ink, 1.5 * width });
    for (const Point& end : edge)
    {
      panel.Dot(end, 0.75 * width, ink);
    }
  }
}

void Draw(const std::string& folder)
{
  const Curve from{ { 1.07, 0.0 }, { 2.11, 1.03 }, { 2.56, 2.31 }, { 2.57, 3.79 }, { 2.14, 4.87 },
    { 1.24, 6.02 }, { 0.0, 0.53 }, { 0.82, 1.21 }, { 1.37, 2.04 }, { 1.37, 3.25 }, { 1.46, 4.12 },
    { 0.8, 4.87 }, { 0.22, 5.54 }, { 0.17, 1.6 }, { 0.39, 1.98 }, { 0.76, 2.88 }, { 0.86, 3.31 },
    { 0.33, 4.32 }, { 0.11, 4.79 } };
  const Curve to{ { 1.73, 0.76 }, { 1.66, 1.26 }, { 1.48, 2.23 }, { 1.88, 2.82 }, { 2.33, 3.66 },
    { 2.94, 4.28 }, { 1.43, 0.19 }, { 1.19, 0.76 }, { 0.91, 1.83 }, { 1.1, 2.78 }, { 1.3, 3.64 },
    { 1.76, 4.43 }, { 2.76, 5.38 }, { 0.44, 0.0 }, { 0.19, 1.09 }, { 0.09, 2.12 }, { 0.0, 3.66 },
    { 0.59, 4.64 }, { 1.73, 5.73 } };
  const std::vector<TriangleIds> triangles{ { 6, 0, 7 }, { 6, 7, 13 }, { 0, 1, 7 }, { 7, 14, 13 },
    { 7, 1, 8 }, { 7, 8, 14 }, { 1, 2, 8 }, { 8, 15, 14 }, { 8, 2, 9 }, { 8, 9, 15 }, { 2, 3, 9 },
    { 9, 16, 15 }, { 9, 3, 10 }, { 9, 10, 16 }, { 3, 4, 10 }, { 10, 17, 16 }, { 10, 4, 11 },
    { 10, 11, 17 }, { 4, 5, 11 }, { 11, 18, 17 }, { 11, 5, 12 }, { 11, 12, 18 } };
  const auto source = MakeMesh(from, triangles);
  const auto target = MakeMesh(to, triangles);
  const std::array<vtkPolyData*, 2> meshes{ source, target };
  for (vtkPolyData* mesh : meshes)
  {
    const auto coordinates = MakeCoordinates(mesh, vtkTriangularCoordinates::CONTOUR, 1, 1);
    if (coordinates->GetNumberOfDiscordantTriangles() > 0)
    {
      throw std::runtime_error("A triangle is discordant.");
    }
  }

  std::vector<ColoredCurve> lines;
  constexpr int count = 44;
  for (int k = 0; k < count; ++k)
  {
    const double share = (k + 0.5) / count;
    const double y = -0.9 + 7.0 * share;
    for (const Curve& piece : CrossMesh(source, { -1.0, y }, { 4.0, y + 1.0 }))
    {
      lines.push_back({ Divide(piece.front(), piece.back(), 1500), ColorOf(share) });
    }
  }
  std::cout << source->GetNumberOfCells() << " triangles, all concordant in both; " << lines.size()
            << " pieces of lines\n";

  constexpr int height = 900;
  Drawing drawing(1240, height);
  Panel page = drawing.GetPage();
  // The middle of an interior edge.
  const Point closeUpFrom = Between(from[9], from[2], 0.45);
  const Point closeUpTo = Between(to[9], to[2], 0.45);
  for (int column = 0; column < 4; ++column)
  {
    const double left = 10.0 + 310.0 * column;
    vtkPolyData* const mesh = meshes[column == 0 ? 0 : 1];
    std::vector<ColoredCurve> shown = lines;
    std::string title = "Source";
    if (column > 0)
    {
      const auto map = MakeMap(source, target, column - 1);
      for (ColoredCurve& line : shown)
      {
        line.Points = MapCurve(map, line.Points);
      }
      title = systemNames[static_cast<std::size_t>(column - 1)];
    }
    page.Label({ left + 145.0, height - 26.0 }, title, { 22.0 });
    Panel panel(drawing, { left, 302.0, 290.0, 545.0 }, { -0.05, -0.05, 3.1, 6.13 });
    DrawPolygon(panel, mesh, shown, 1.5);
    const Point& center = column == 0 ? closeUpFrom : closeUpTo;
    constexpr double half = 0.42;
    const Rectangle window{ center[0] - half, center[1] - half, 2.0 * half, 2.0 * half };
    const double right = window.Left + window.Width;
    const double top = window.Bottom + window.Height;
    panel.StrokeClosed({ { window.Left, window.Bottom }, { right, window.Bottom }, { right, top },
                         { window.Left, top } },
      { ink, 1.2, 4.0 });
    Panel closeUp(drawing, { left + 5.0, 10.0, 280.0, 280.0 }, window);
    DrawPolygon(closeUp, mesh, shown, 3.0);
    closeUp.Frame({ ink, 1.2 });
  }
  drawing.Write(folder + "/figure-6-parallel-lines.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
