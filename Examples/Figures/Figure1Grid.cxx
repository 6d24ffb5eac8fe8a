// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The grid of triangular coordinates over adjacent triangles, in the three coordinate systems. The
// second patch has the same triangles and other points, which make two of them discordant.

#include "Drawing.h"
#include "Meshes.h"

#include "vtkMath.h"

#include <cmath>
#include <iostream>
#include <string>
#include <vector>

namespace
{

const Color edgeColor{ 0.13, 0.14, 0.17 };
const Color contourColor{ 0.13, 0.40, 0.67 };
const Color ringColor{ 0.85, 0.45, 0.13 };

/// In degrees, for reading from left to right or upwards.
double AngleOfLongestEdge(const Curve& corners)
{
  Point longest{ 0.0, 0.0 };
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Point edge = Subtract(corners[(k + 1) % 3], corners[k]);
    if (Length(edge) > Length(longest))
    {
      longest = edge;
    }
  }
  return vtkMath::DegreesFromRadians(std::atan(longest[1] / longest[0]));
}

void DrawPatch(Panel& panel, vtkPolyData* patch, int system)
{
  const auto coordinates = MakeCoordinates(patch, system, 8, 5);
  for (vtkIdType triangle = 0; triangle < patch->GetNumberOfCells(); ++triangle)
  {
    const Curve corners = GetTriangle(patch, triangle);
    if (system == vtkTriangularCoordinates::CONTOUR && !IsConcordant(coordinates, triangle))
    {
      panel.Fill(corners, { 0.92, 0.92, 0.93 });
      panel.Hatch(corners, 7.0, { { 0.72, 0.72, 0.75 }, 1.0 });
      continue;
    }
    panel.StrokeLines(
      SelectLines(coordinates, vtkTriangularCoordinates::RING_LINE, triangle), { ringColor, 1.0 });
    panel.StrokeLines(SelectLines(coordinates, vtkTriangularCoordinates::CONTOUR_LINE, triangle),
      { contourColor, 1.1 });
  }
  panel.StrokeEdges(patch, { edgeColor, 2.4 });
  for (vtkIdType triangle = 0; triangle < patch->GetNumberOfCells(); ++triangle)
  {
    if (system == vtkTriangularCoordinates::CONTOUR && !IsConcordant(coordinates, triangle))
    {
      const Curve corners = GetTriangle(patch, triangle);
      Lettering letters{ 15.0 };
      letters.Orientation = AngleOfLongestEdge(corners);
      panel.Label(Between(corners[0], Between(corners[1], corners[2], 0.5), 2.0 / 3.0),
        "discordant", letters);
    }
  }
}

void Draw(const std::string& folder)
{
  const Curve concordant{ { 0.12, 0.02 }, { 1.08, -0.25 }, { 0.62, 0.82 }, { -0.42, 0.95 },
    { -0.98, 0.08 }, { -0.42, -0.78 }, { 0.55, -0.95 }, { 1.48, 0.72 } };
  const Curve withDiscordant{ { 0.3, 0.56 }, { 1.15, -0.6 }, { 0.8, 0.92 }, { -1.0, 0.95 },
    { -0.98, -0.1 }, { -0.5, -0.88 }, { 0.5, -0.95 }, { 1.24, 0.62 } };
  const std::vector<TriangleIds> triangles{ { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 4 }, { 0, 4, 5 },
    { 0, 5, 6 }, { 0, 6, 1 }, { 1, 7, 2 } };

  constexpr int width = 1240;
  constexpr int height = 702;
  constexpr double panelWidth = 400.0;
  constexpr double panelHeight = 315.0;
  Drawing drawing(width, height);
  Panel page = drawing.GetPage();
  for (int row = 0; row < 2; ++row)
  {
    const auto patch = MakeMesh(row == 0 ? concordant : withDiscordant, triangles);
    const auto coordinates = MakeCoordinates(patch, vtkTriangularCoordinates::CONTOUR, 1, 1);
    std::cout << "row " << row + 1 << ": " << coordinates->GetNumberOfDiscordantTriangles()
              << " of " << triangles.size() << " triangles discordant\n";
    for (int system = 0; system < 3; ++system)
    {
      const double left = 10.0 + 410.0 * system;
      const double bottom = row == 0 ? 336.0 : 8.0;
      Panel panel(drawing, { left, bottom, panelWidth, panelHeight }, { -1.02, -0.98, 2.54, 1.96 });
      DrawPatch(panel, patch, system);
      if (row == 0)
      {
        page.Label({ left + 0.5 * panelWidth, height - 26.0 },
          systemNames[static_cast<std::size_t>(system)], { 22.0 });
      }
    }
  }
  drawing.Write(folder + "/figure-1-grid.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
