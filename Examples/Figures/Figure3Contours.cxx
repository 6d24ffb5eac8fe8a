// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The guides of the Contour system in a triangle, and how a contour is built.

#include "Drawing.h"
#include "Meshes.h"

#include <cmath>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const Color faint{ 0.72, 0.75, 0.80 };
const Color centerColor{ 0.80, 0.22, 0.15 };
const Color wingColor{ 0.15, 0.50, 0.35 };
const Color contourColor{ 0.13, 0.40, 0.67 };

Point FootOn(const Point& a, const Point& b, const Point& point)
{
  const Point edge = Subtract(b, a);
  return Add(a, edge, ScalarProduct(Subtract(point, a), edge) / ScalarProduct(edge, edge));
}

Lettering Colored(const Color& color, double size = 18.0)
{
  Lettering lettering;
  lettering.Size = size;
  lettering.Ink = color;
  return lettering;
}

void DrawGuides(Drawing& drawing)
{
  Panel panel(drawing, { 15.0, 15.0, 560.0, 400.0 }, { -0.4, -0.5, 6.8, 5.6 });
  const Curve corners{ { 0.0, 0.0 }, { 6.0, 0.0 }, { 2.3, 4.7 } };
  const auto mesh = MakeMesh(corners, { { 0, 1, 2 } });
  const auto coordinates = MakeCoordinates(mesh, vtkTriangularCoordinates::CONTOUR, 10, 1);
  const Point centroid =
    Between(corners[0], Between(corners[1], corners[2], 0.5), 2.0 / 3.0);
  Curve hexagon;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Point foot = FootOn(corners[k], corners[(k + 1) % 3], centroid);
    hexagon.push_back(corners[k]);
    hexagon.push_back(Between(centroid, foot, 0.5));
  }
  panel.Fill(hexagon, { 0.93, 0.96, 0.94 });
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::CONTOUR_LINE), { { 0.62, 0.74, 0.86 }, 1.2 });
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::WING_SEGMENT), { wingColor, 2.2 });
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::CENTER_SEGMENT), { centerColor, 2.2 });
  panel.StrokeEdges(mesh, { ink, 2.4 });
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Point& a = corners[k];
    const Point& b = corners[(k + 1) % 3];
    panel.RightAngle(FootOn(a, b, centroid), b, centroid, 10.0, { centerColor, 1.3 });
  }
  panel.Dot(centroid, 4.5, ink);
  panel.Label(centroid, "$G$", {}, { 12.0, 14.0 });
  panel.Label(corners[0], "$A$", {}, { -12.0, -8.0 });
  panel.Label(corners[1], "$B$", {}, { 12.0, -8.0 });
  panel.Label(corners[2], "$C$", {}, { 0.0, 16.0 });
  panel.Label({ 4.75, 3.3 }, "center segments", Colored(centerColor, 16.0));
  panel.Label({ 5.0, 2.85 }, "wing segments", Colored(wingColor, 16.0));
  panel.Label({ 5.25, 2.4 }, "contours", Colored(contourColor, 16.0));
}

void DrawConstruction(Drawing& drawing)
{
  constexpr double h = 2.6;
  constexpr double b = 4.4;
  constexpr double s = 0.5;
  const double length = std::hypot(h * (1.0 + s), 2.0 * b * s);
  const Point wing{ b * s, 0.5 * h * (1.0 - s) };
  const double radius = h * (1.0 - s) * length / (4.0 * b * s);
  const Point arcCenter{ b * s - h * h * (1.0 - s * s) / (4.0 * b * s), 0.0 };
  const double turn = std::atan2(2.0 * b * s, h * (1.0 + s));
  const Point end{ arcCenter[0] + radius, 0.0 };
  const Point centroid{ 0.0, h };
  const Point foot{ 0.0, 0.0 };
  const Point corner{ b, 0.0 };

  Panel panel(drawing, { 600.0, 15.0, 625.0, 400.0 }, { -0.55, -0.55, 5.4, 3.5 });
  panel.Stroke({ centroid, corner }, { faint, 1.5, 6.0 });
  panel.Stroke({ { 0.0, 0.5 * h }, corner }, { wingColor, 2.2 });
  panel.Stroke({ centroid, foot }, { centerColor, 2.2 });
  panel.Stroke({ { -0.35, 0.0 }, corner }, { ink, 2.4 });
  panel.Stroke({ arcCenter, wing }, { faint, 1.5, 5.0 });
  panel.Stroke({ centroid, wing }, { contourColor, 3.4 });
  panel.StrokeArc(arcCenter, radius, turn, 0.0, { contourColor, 3.4 });
  const double down = -0.5 * std::acos(-1.0);
  panel.StrokeArc(centroid, 0.5, down, down + turn, { ink, 1.3 });
  panel.StrokeArc(arcCenter, 0.32, 0.0, turn, { ink, 1.3 });
  panel.RightAngle(end, { end[0], 1.0 }, foot, 10.0, { ink, 1.3 });
  panel.RightAngle(wing, centroid, arcCenter, 10.0, { ink, 1.3 });
  panel.RightAngle(foot, corner, centroid, 10.0, { centerColor, 1.3 });
  for (const Point& point : { centroid, foot, corner, wing, end, arcCenter })
  {
    panel.Dot(point, 4.0, ink);
  }
  panel.Label(centroid, "$G$ = (0, $h$)", {}, { 48.0, 10.0 });
  panel.Label(foot, "foot (0, 0)", {}, { -8.0, -18.0 });
  panel.Label(corner, "corner ($b$, 0)", {}, { -10.0, -18.0 });
  panel.Label(wing, "$W$", {}, { 14.0, 14.0 });
  panel.Label(end, "$E$", {}, { 4.0, -18.0 });
  panel.Label(arcCenter, "$O$", {}, { 0.0, -18.0 });
  panel.Label(Between(arcCenter, wing, 0.55), "$r$", {}, { -12.0, 6.0 });
  panel.Label(Between(centroid, wing, 0.5), "$R$/2", Colored(contourColor), { 20.0, 10.0 });
  const double halfTurn = down + 0.5 * turn;
  panel.Label(Add(centroid, { std::cos(halfTurn), std::sin(halfTurn) }, 0.68), "$phi$", {});
  panel.Label(
    Add(arcCenter, { std::cos(0.5 * turn), std::sin(0.5 * turn) }, 0.5), "$phi$", {});
}

void Draw(const std::string& folder)
{
  Drawing drawing(1240, 430);
  DrawGuides(drawing);
  DrawConstruction(drawing);
  drawing.Write(folder + "/figure-3-contours.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
