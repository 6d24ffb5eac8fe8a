// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// A discordant triangle: a foot of its centroid lies outside an edge. From the incenter, and in the Smooth
// system, it has a grid all the same.

#include "Drawing.h"
#include "Meshes.h"

#include <iostream>
#include <stdexcept>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const Color faint{ 0.60, 0.63, 0.68 };
const Color footColor{ 0.80, 0.22, 0.15 };
const Color segmentColor{ 0.15, 0.50, 0.35 };
const Color contourColor{ 0.13, 0.40, 0.67 };
const Color ringColor{ 0.85, 0.45, 0.13 };

void DrawFeet(Panel& panel, const Curve& corners)
{
  const Point centroid =
    Between(corners[0], Between(corners[1], corners[2], 0.5), 2.0 / 3.0);
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Point& a = corners[k];
    const Point& b = corners[(k + 1) % 3];
    const Point edge = Subtract(b, a);
    const double proportion =
      ScalarProduct(Subtract(centroid, a), edge) / ScalarProduct(edge, edge);
    const Point foot = Add(a, edge, proportion);
    const bool outside = proportion <= 0.0 || proportion >= 1.0;
    std::cout << "foot at " << proportion << " of the edge\n";
    if (outside)
    {
      panel.Stroke({ b, Add(a, edge, proportion + 0.25) }, { faint, 1.5, 5.0 });
    }
    panel.Stroke({ centroid, foot }, { outside ? footColor : segmentColor, 2.2 });
    panel.RightAngle(foot, a, centroid, 9.0, { outside ? footColor : segmentColor, 1.3 });
    panel.Dot(foot, outside ? 5.0 : 3.5, outside ? footColor : segmentColor);
    if (outside)
    {
      Lettering lettering;
      lettering.Size = 16.0;
      lettering.Ink = footColor;
      lettering.Horizontal = Alignment::Left;
      panel.Label(foot, "foot outside", lettering, { 10.0, -14.0 });
    }
  }
  panel.Dot(centroid, 4.5, ink);
  panel.Label(centroid, "$G$", {}, { -15.0, -2.0 });
}

void DrawGrid(Panel& panel, vtkPolyData* mesh, int system, int center)
{
  const auto coordinates = MakeCoordinates(mesh, system, 8, 6, center);
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::RING_LINE), { ringColor, 1.1 });
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::CONTOUR_LINE), { contourColor, 1.2 });
}

void Draw(const std::string& folder)
{
  const Curve corners{ { 0.0, 0.0 }, { 2.0, 0.0 }, { 4.7, 2.5 } };
  const auto mesh = MakeMesh(corners, { { 0, 1, 2 } });
  if (IsConcordant(MakeCoordinates(mesh, vtkTriangularCoordinates::CONTOUR, 1, 1), 0))
  {
    throw std::runtime_error("The triangle should be discordant.");
  }
  constexpr int width = 1240;
  constexpr int height = 320;
  constexpr double panelWidth = 395.0;
  Drawing drawing(width, height);
  Panel page = drawing.GetPage();
  const std::array<std::string, 3> titles{ "Contour: discordant", "Contour, from the incenter",
    "Smooth" };
  for (std::size_t i = 0; i < 3; ++i)
  {
    const double left = 12.0 + 411.0 * static_cast<double>(i);
    page.Label({ left + 0.5 * panelWidth, height - 24.0 }, titles[i], { 20.0 });
    Panel panel(drawing, { left, 10.0, panelWidth, 255.0 }, { -0.1, -0.4, 4.9, 3.05 });
    if (i == 1)
    {
      DrawGrid(panel, mesh, vtkTriangularCoordinates::CONTOUR, vtkTriangularCoordinates::INCENTER);
    }
    else if (i == 2)
    {
      DrawGrid(panel, mesh, vtkTriangularCoordinates::SMOOTH, vtkTriangularCoordinates::CENTROID);
    }
    panel.StrokeEdges(mesh, { ink, 2.4 });
    if (i == 0)
    {
      DrawFeet(panel, corners);
    }
  }
  drawing.Write(folder + "/figure-4-discordant.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
