// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// A straight line carried from one triangulation onto another: the piecewise linear map bends it at every
// edge, the Smooth one at none.

#include "Drawing.h"
#include "Meshes.h"

#include <cmath>
#include <iostream>

namespace
{

const Color edgeColor{ 0.55, 0.58, 0.64 };
const Color lineColor{ 0.13, 0.40, 0.67 };
const Color bendColor{ 0.80, 0.22, 0.15 };

double AngleBetween(const Point& a, const Point& b)
{
  return std::acos(ScalarProduct(a, b) / Length(a) / Length(b)) * 180.0 / std::acos(-1.0);
}

void Draw(const std::string& folder)
{
  const Curve source{ { 0.0, 0.0 }, { 1.0, -0.05 }, { 2.05, 0.0 }, { 3.0, 0.05 }, { -0.5, 0.9 },
    { 0.5, 0.85 }, { 1.5, 0.95 }, { 2.5, 0.88 }, { 3.5, 0.95 }, { 0.05, 1.8 }, { 1.0, 1.85 },
    { 2.0, 1.78 }, { 3.0, 1.82 } };
  const Curve target{ { -0.05, 0.3 }, { 1.1, -0.25 }, { 1.9, 0.3 }, { 3.1, -0.2 }, { -0.45, 1.25 },
    { 0.35, 0.75 }, { 1.62, 1.3 }, { 2.35, 0.8 }, { 3.5, 1.1 }, { 0.2, 1.9 }, { 0.85, 1.7 },
    { 2.1, 1.95 }, { 2.95, 1.7 } };
  const std::vector<TriangleIds> triangles{ { 0, 1, 5 }, { 1, 6, 5 }, { 1, 2, 6 }, { 2, 7, 6 },
    { 2, 3, 7 }, { 3, 8, 7 }, { 0, 5, 4 }, { 4, 5, 9 }, { 5, 10, 9 }, { 5, 6, 10 }, { 6, 11, 10 },
    { 6, 7, 11 }, { 7, 12, 11 }, { 7, 8, 12 } };
  const auto sourceMesh = MakeMesh(source, triangles);
  const auto targetMesh = MakeMesh(target, triangles);
  const Curve crossings = CrossMesh(sourceMesh, { -1.0, 0.30 }, { 4.5, 0.62 }).at(0);

  constexpr int width = 1240;
  constexpr int height = 330;
  constexpr double panelWidth = 400.0;
  Drawing drawing(width, height);
  Panel page = drawing.GetPage();
  const std::array<std::string, 3> titles{ "Source", "Linear", "Smooth" };
  for (std::size_t i = 0; i < 3; ++i)
  {
    const double left = 10.0 + 410.0 * static_cast<double>(i);
    Panel panel(drawing, { left, 10.0, panelWidth, 270.0 }, { -0.6, -0.25, 4.2, 2.3 });
    panel.StrokeEdges(i == 0 ? sourceMesh : targetMesh, { edgeColor, 1.6 });
    page.Label({ left + 0.5 * panelWidth, height - 24.0 }, titles[i], { 22.0 });
    Curve fine;
    for (std::size_t k = 0; k + 1 < crossings.size(); ++k)
    {
      const Curve piece = Divide(crossings[k], crossings[k + 1], 200);
      fine.insert(fine.end(), piece.begin() + (k > 0 ? 1 : 0), piece.end());
    }
    if (i == 0)
    {
      panel.Stroke(crossings, { lineColor, 3.0 });
      continue;
    }
    const auto map = MakeMap(sourceMesh, targetMesh,
      i == 1 ? vtkHomeomorphismTransform::LINEAR : vtkHomeomorphismTransform::SMOOTH);
    panel.Stroke(MapCurve(map, fine), { lineColor, 3.0 });
    const Curve bends = MapCurve(map, crossings);
    for (std::size_t k = 1; i == 1 && k + 1 < bends.size(); ++k)
    {
      const double angle =
        AngleBetween(Subtract(bends[k], bends[k - 1]), Subtract(bends[k + 1], bends[k]));
      std::cout << "bend of " << angle << " degrees\n";
      panel.Dot(bends[k], 4.0, bendColor);
      Lettering lettering;
      lettering.Size = 14.0;
      lettering.Ink = bendColor;
      panel.Label(bends[k], Decimal(angle, 0) + "\u00b0", lettering,
        { 0.0, k % 2 == 0 ? 15.0 : -15.0 });
    }
  }
  drawing.Write(folder + "/figure-2-bent-line.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
