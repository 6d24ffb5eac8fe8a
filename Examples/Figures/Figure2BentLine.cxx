// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// A straight line through a triangulation, and its images on another one: the piecewise linear map
// bends it at every edge, the Smooth one nowhere.

#include "Drawing.h"
#include "Meshes.h"

#include "vtkMath.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

namespace
{

const Color edgeColor{ 0.45, 0.49, 0.56 };
const Color fillColor{ 0.955, 0.962, 0.975 };
const Color lineColor{ 0.78, 0.12, 0.20 };

void DrawMesh(Panel& panel, vtkPolyData* mesh)
{
  for (vtkIdType triangle = 0; triangle < mesh->GetNumberOfCells(); ++triangle)
  {
    panel.Fill(GetTriangle(mesh, triangle), fillColor);
  }
  panel.StrokeEdges(mesh, { edgeColor, 1.6 });
}

/// Degrees by which the direction changes from one vector to the next.
double Bend(const Point& before, const Point& after)
{
  const double cross = before[0] * after[1] - before[1] * after[0];
  return std::abs(vtkMath::DegreesFromRadians(std::atan2(cross, ScalarProduct(before, after))));
}

/// The image of a direction at a point.
Point MapDirection(vtkHomeomorphismTransform* map, const Point& point, const Point& direction)
{
  const double at[3] = { point[0], point[1], 0.0 };
  double image[3];
  double jacobian[3][3];
  map->InternalTransformDerivative(at, image, jacobian);
  return { jacobian[0][0] * direction[0] + jacobian[0][1] * direction[1],
    jacobian[1][0] * direction[0] + jacobian[1][1] * direction[1] };
}

void Draw(const std::string& folder)
{
  const std::vector<TriangleIds> triangles{ { 0, 1, 4 }, { 1, 5, 4 }, { 1, 2, 5 }, { 2, 6, 5 },
    { 2, 3, 6 }, { 4, 5, 7 }, { 5, 8, 7 }, { 5, 6, 8 }, { 6, 9, 8 }, { 3, 9, 6 } };
  const Curve from{ { 0.0, 0.1 }, { 1.0, -0.1 }, { 2.1, 0.0 }, { 3.2, 0.2 }, { 0.35, 1.1 },
    { 1.5, 0.55 }, { 2.6, 1.0 }, { 0.8, 2.05 }, { 2.0, 2.0 }, { 3.15, 1.95 } };
  const Curve to{ { 0.0, 0.3 }, { 0.85, -0.1 }, { 2.3, 0.1 }, { 3.2, -0.05 }, { 0.15, 1.45 },
    { 1.25, 0.55 }, { 2.5, 0.8 }, { 1.15, 1.75 }, { 1.95, 2.2 }, { 3.2, 1.7 } };
  const auto source = MakeMesh(from, triangles);
  const auto target = MakeMesh(to, triangles);
  const Curve line = CrossMesh(source, { -0.5, 0.35 }, { 3.6, 1.75 }).at(0);
  const Point along = Subtract(line.back(), line.front());

  constexpr int height = 610;
  Drawing drawing(1240, height);
  Panel page = drawing.GetPage();
  const auto makePanel = [&](int number, const std::string& title) {
    const double left = 10.0 + 410.0 * number;
    page.Label({ left + 200.0, height - 26.0 }, title, { 22.0 });
    return Panel(drawing, { left, 275.0, 400.0, 285.0 }, { -0.06, -0.2, 3.32, 2.4 });
  };
  const Pen pen{ lineColor, 2.6 };
  const Pen outline{ lineColor, 1.8 };
  const auto makeCloseUp = [&](int number, Panel& panel, const Point& center) {
    constexpr double halfWidth = 0.46;
    constexpr double halfHeight = 0.27;
    const Rectangle window{ center[0] - halfWidth, center[1] - halfHeight, 2.0 * halfWidth,
      2.0 * halfHeight };
    const double right = window.Left + window.Width;
    const double top = window.Bottom + window.Height;
    panel.StrokeClosed({ { window.Left, window.Bottom }, { right, window.Bottom }, { right, top },
                         { window.Left, top } },
      { edgeColor, 1.2, 4.0 });
    Panel closeUp(drawing, { 15.0 + 410.0 * number, 12.0, 390.0, 229.0 }, window);
    closeUp.Frame({ edgeColor, 1.2 });
    return closeUp;
  };
  const Pen thick{ lineColor, 4.0 };

  Panel straight = makePanel(0, "A straight line");
  DrawMesh(straight, source);
  straight.Stroke(line, pen);

  Panel bent = makePanel(1, "Linear");
  DrawMesh(bent, target);
  const auto linear = MakeMap(source, target, vtkHomeomorphismTransform::LINEAR);
  const Curve image = MapCurve(linear, line);
  bent.Stroke(image, pen);
  double largest = 0.0;
  std::size_t sharpest = 0;
  for (std::size_t i = 1; i + 1 < image.size(); ++i)
  {
    const Point before = Subtract(image[i], image[i - 1]);
    const Point after = Subtract(image[i + 1], image[i]);
    const double angle = Bend(before, after);
    if (angle > largest)
    {
      largest = angle;
      sharpest = i;
    }
    bent.Ring(image[i], 4.5, { 1.0, 1.0, 1.0 }, outline);
    // On the outer side of the bend.
    const Point outwards = Subtract(Between({ 0.0, 0.0 }, before, 1.0 / Length(before)),
      Between({ 0.0, 0.0 }, after, 1.0 / Length(after)));
    bent.Label(image[i], Decimal(angle, 1) + "\u00b0", { 15.0 },
      Between({ 0.0, 0.0 }, outwards, 17.0 / Length(outwards)));
  }
  std::cout << "Linear: " << image.size() - 2 << " bends, the largest " << Decimal(largest, 1)
            << " degrees\n";

  Panel unbent = makePanel(2, "Smooth");
  DrawMesh(unbent, target);
  const auto smooth = MakeMap(source, target, vtkHomeomorphismTransform::SMOOTH);
  const Curve smoothImage = MapCurve(smooth, Divide(line.front(), line.back(), 4000));
  unbent.Stroke(smoothImage, pen);
  largest = 0.0;
  for (std::size_t i = 1; i + 1 < line.size(); ++i)
  {
    constexpr double step = 1e-9;
    largest = std::max(largest,
      Bend(MapDirection(smooth, Add(line[i], along, -step), along),
        MapDirection(smooth, Add(line[i], along, step), along)));
    unbent.Ring(MapCurve(smooth, { line[i] })[0], 4.5, { 1.0, 1.0, 1.0 }, outline);
  }
  std::cout << "Smooth: largest bend at an edge " << largest << " degrees\n";

  // The sharpest bend, and the same place in the other two.
  Panel straightCloseUp = makeCloseUp(0, straight, line[sharpest]);
  DrawMesh(straightCloseUp, source);
  straightCloseUp.Stroke(line, thick);
  Panel bentCloseUp = makeCloseUp(1, bent, image[sharpest]);
  DrawMesh(bentCloseUp, target);
  bentCloseUp.Stroke(image, thick);
  Panel unbentCloseUp = makeCloseUp(2, unbent, image[sharpest]);
  DrawMesh(unbentCloseUp, target);
  unbentCloseUp.Stroke(smoothImage, thick);
  drawing.Write(folder + "/figure-2-bent-line.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
