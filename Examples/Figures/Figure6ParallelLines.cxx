// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Parallel lines through a pair of triangulated polygons, under the three coordinate systems.

#include "Drawing.h"
#include "Meshes.h"

#include <cmath>
#include <iostream>
#include <stdexcept>

namespace
{

const Color edgeColor{ 0.62, 0.65, 0.70 };
const Color lineColor{ 0.13, 0.40, 0.67 };
const Color frameColor{ 0.80, 0.22, 0.15 };

constexpr int columns = 8;

/// A straight band of triangles, with a bulge, and the same band bent into an arch.
Curve MakeBand(bool bent)
{
  Curve points;
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < columns; ++column)
    {
      const double x = column + (row == 1 ? 0.5 : 0.0);
      const double waist = 1.0 + 0.12 * std::cos(0.9 * x);
      const double y = 0.88 * (row - 1) * waist;
      if (!bent)
      {
        points.push_back({ x, y });
        continue;
      }
      const double angle = std::acos(-1.0) * (1.0 - x / (columns - 0.5));
      const double radius = 2.75 + y * (1.0 + 0.1 * std::sin(1.7 * x));
      points.push_back({ radius * std::cos(angle), radius * std::sin(angle) });
    }
  }
  return points;
}

std::vector<TriangleIds> MakeTriangles()
{
  std::vector<TriangleIds> triangles;
  for (vtkIdType i = 0; i + 1 < columns; ++i)
  {
    const vtkIdType low = i;
    const vtkIdType middle = columns + i;
    const vtkIdType high = 2 * columns + i;
    triangles.push_back({ low, low + 1, middle });
    triangles.push_back({ low + 1, middle + 1, middle });
    triangles.push_back({ middle, high + 1, high });
    triangles.push_back({ middle, middle + 1, high + 1 });
  }
  return triangles;
}

void Draw(const std::string& folder)
{
  const auto source = MakeMesh(MakeBand(false), MakeTriangles());
  const auto target = MakeMesh(MakeBand(true), MakeTriangles());
  for (vtkPolyData* mesh : { source.Get(), target.Get() })
  {
    const auto coordinates = MakeCoordinates(mesh, vtkTriangularCoordinates::CONTOUR, 1, 1);
    if (coordinates->GetNumberOfDiscordantTriangles() > 0)
    {
      throw std::runtime_error("All triangles should be concordant.");
    }
  }
  std::vector<Curve> lines;
  for (int i = -11; i <= 29; ++i)
  {
    const double x = 0.3 * i;
    for (const Curve& piece : CrossMesh(source, { x - 2.0, -2.0 }, { x + 2.0, 2.0 }))
    {
      lines.push_back(Divide(piece.front(), piece.back(), 400));
    }
  }

  constexpr int width = 1240;
  constexpr int height = 790;
  constexpr double panelWidth = 400.0;
  Drawing drawing(width, height);
  Panel page = drawing.GetPage();
  const Pen edge{ edgeColor, 1.4 };
  const Pen line{ lineColor, 1.8 };

  Panel start(drawing, { 320.0, 592.0, 600.0, 150.0 }, { -0.1, -1.05, 7.7, 2.1 });
  start.StrokeEdges(source, edge);
  for (const Curve& curve : lines)
  {
    start.Stroke(curve, line);
  }
  page.Label({ 620.0, height - 22.0 }, "Source", { 22.0 });

  // Where the edges are hardest on the lines.
  const Rectangle closeUp{ -0.85, 2.15, 1.7, 1.1 };
  for (int system = 0; system < 3; ++system)
  {
    const double left = 10.0 + 410.0 * system;
    const auto map = MakeMap(source, target, system);
    Panel panel(drawing, { left, 300.0, panelWidth, 238.0 }, { -3.8, -0.15, 7.6, 4.0 });
    Panel detail(drawing, { left, 15.0, panelWidth, 258.0 }, closeUp);
    for (Panel* view : { &panel, &detail })
    {
      const double thicker = view == &detail ? 1.7 : 1.0;
      view->StrokeEdges(target, { edgeColor, 1.4 * thicker });
      for (const Curve& curve : lines)
      {
        view->Stroke(MapCurve(map, curve), { lineColor, 1.5 * thicker });
      }
    }
    const double right = closeUp.Left + closeUp.Width;
    const double top = closeUp.Bottom + closeUp.Height;
    panel.StrokeClosed({ { closeUp.Left, closeUp.Bottom }, { right, closeUp.Bottom },
                         { right, top }, { closeUp.Left, top } },
      { frameColor, 1.6 });
    detail.Frame({ frameColor, 1.6 });
    page.Label({ left + 0.5 * panelWidth, 558.0 }, systemNames[static_cast<std::size_t>(system)],
      { 22.0 });
  }
  drawing.Write(folder + "/figure-6-parallel-lines.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
