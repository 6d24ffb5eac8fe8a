// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// A discordant triangle: why contours cannot start at its centroid, and its grids from the incenter
// and in the Smooth system.

#include "Drawing.h"
#include "Meshes.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"

#include <array>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const Color centerColor{ 0.80, 0.36, 0.08 };
const Color contourColor{ 0.13, 0.40, 0.67 };
const Color ringColor{ 0.85, 0.45, 0.13 };
const Color outsideColor{ 0.82, 0.08, 0.16 };

void DrawFeet(Panel& panel, vtkPolyData* mesh)
{
  const Curve corners = GetTriangle(mesh, 0);
  const Point center = Between(corners[0], Between(corners[1], corners[2], 0.5), 2.0 / 3.0);
  panel.Fill(corners, { 0.955, 0.962, 0.975 });
  panel.StrokeEdges(mesh, { ink, 2.6 });
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Point& a = corners[k];
    const Point& b = corners[(k + 1) % 3];
    const Point edge = Subtract(b, a);
    const double share = ScalarProduct(Subtract(center, a), edge) / ScalarProduct(edge, edge);
    const Point foot = Add(a, edge, share);
    const bool inside = share > 0.0 && share < 1.0;
    const Color& color = inside ? centerColor : outsideColor;
    if (!inside)
    {
      std::cout << "the foot is at " << share << " of the edge\n";
      panel.Stroke(
        { share < 0.0 ? a : b, Add(foot, edge, share < 0.0 ? -0.25 : 0.25) }, { ink, 1.8, 7.0 });
    }
    panel.Stroke({ center, foot }, { color, 2.2 });
    panel.RightAngle(foot, center, share < 0.5 ? b : a, 11.0, { color, 1.4 });
    panel.Dot(foot, inside ? 3.8 : 5.6, color);
  }
  panel.Dot(center, 4.6, ink);
  panel.Label(center, "$G$", { 20.0 }, { 17.0, -9.0 });
}

void DrawGrid(Panel& panel, vtkPolyData* mesh, int system, int centerPoint)
{
  const auto coordinates = MakeCoordinates(mesh, system, 6, 5, centerPoint);
  vtkDataArray* const used =
    coordinates->GetTriangulation()->GetCellData()->GetArray("UsedCoordinateSystem");
  if (static_cast<int>(used->GetTuple1(0)) != system)
  {
    throw std::runtime_error("The triangle's grid is not the one that was asked for.");
  }
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::RING_LINE), { ringColor, 1.0 });
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::CONTOUR_LINE), { contourColor, 1.1 });
  panel.StrokeEdges(mesh, { ink, 2.6 });
}

void Draw(const std::string& folder)
{
  const auto mesh = MakeMesh({ { 0.0, 0.0 }, { 1.0, 0.0 }, { -1.6, 1.7 } }, { { 0, 1, 2 } });
  if (IsConcordant(MakeCoordinates(mesh, vtkTriangularCoordinates::CONTOUR, 1, 1), 0))
  {
    throw std::runtime_error("The triangle is concordant.");
  }
  constexpr int height = 330;
  Drawing drawing(1240, height);
  Panel page = drawing.GetPage();
  const std::array<std::string, 3> titles{ "From the centroid: discordant", "From the incenter",
    "Smooth" };
  for (std::size_t k = 0; k < 3; ++k)
  {
    const double left = 10.0 + 410.0 * static_cast<double>(k);
    Panel panel(drawing, { left, 8.0, 400.0, 270.0 }, { -1.66, -0.09, 2.72, 1.86 });
    page.Label({ left + 200.0, height - 26.0 }, titles[k], { 20.0 });
    if (k == 0)
    {
      DrawFeet(panel, mesh);
    }
    else if (k == 1)
    {
      DrawGrid(panel, mesh, vtkTriangularCoordinates::CONTOUR, vtkTriangularCoordinates::INCENTER);
    }
    else
    {
      DrawGrid(panel, mesh, vtkTriangularCoordinates::SMOOTH, vtkTriangularCoordinates::CENTROID);
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
