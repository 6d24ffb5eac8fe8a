// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The jump of the Jacobian along an edge of two triangles: measured, and in closed form.

#include "Drawing.h"
#include "Meshes.h"

#include "vtkDataArray.h"
#include "vtkJacobianContinuity.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const Color gridColor{ 0.88, 0.89, 0.91 };
const std::array<Color, 3> systemColors{ { { 0.80, 0.30, 0.15 }, { 0.13, 0.40, 0.67 },
  { 0.15, 0.50, 0.35 } } };

constexpr double lowest = -13.0;
constexpr double highest = 0.6;

void Draw(const std::string& folder)
{
  const std::vector<TriangleIds> triangles{ { 0, 1, 2 }, { 1, 0, 3 } };
  const auto source =
    MakeMesh({ { -2.0, 0.0 }, { 2.0, 0.0 }, { 0.0, 3.0 }, { 0.0, -3.0 } }, triangles);
  const auto target =
    MakeMesh({ { -2.0, 0.0 }, { 2.0, 0.0 }, { 0.6, 6.0 }, { 0.0, -3.0 } }, triangles);
  constexpr int samples = 99;

  Drawing drawing(1000, 560);
  Panel panel(
    drawing, { 100.0, 70.0, 860.0, 465.0 }, { 0.0, lowest, 1.0, highest - lowest }, true);
  for (int power = -12; power <= 0; power += 2)
  {
    const double y = power;
    panel.Stroke({ { 0.0, y }, { 1.0, y } }, { gridColor, 1.0 });
    Lettering lettering;
    lettering.Size = 16.0;
    lettering.Horizontal = Alignment::Right;
    panel.Label(
      { 0.0, y }, power == 0 ? "1" : "10^{" + Decimal(power, 0) + "}", lettering, { -10.0, 0.0 });
  }
  for (int i = 0; i <= 4; ++i)
  {
    panel.Label({ 0.25 * i, lowest }, Decimal(0.25 * i, 2), { 16.0 }, { 0.0, -18.0 });
  }
  Panel page = drawing.GetPage();
  page.Label({ 530.0, 20.0 }, "$p$, position along the edge", { 18.0 });
  Lettering upright;
  upright.Size = 18.0;
  upright.Orientation = 90.0;
  page.Label({ 24.0, 302.0 }, "jump of the Jacobian, relative", upright);

  for (int system = 0; system < 3; ++system)
  {
    vtkNew<vtkJacobianContinuity> filter;
    filter->SetSourceData(source);
    filter->SetTargetData(target);
    filter->SetCoordinateSystem(system);
    filter->SetSamplesPerEdge(samples);
    filter->Update();
    vtkPointData* values = filter->GetOutput()->GetPointData();
    vtkDataArray* jump = values->GetArray("JacobianJump");
    vtkDataArray* exact = values->GetArray("JacobianJumpExact");
    vtkDataArray* bound = values->GetArray("JacobianJumpError");
    if (!jump)
    {
      throw std::runtime_error("The pair of triangulations was refused.");
    }
    double difference = 0.0;
    double largestBound = 0.0;
    Curve closedForm;
    const Color& color = systemColors[static_cast<std::size_t>(system)];
    for (int i = 1; i <= samples; ++i)
    {
      difference = std::max(difference, std::abs(jump->GetTuple1(i) - exact->GetTuple1(i)));
      largestBound = std::max(largestBound, bound->GetTuple1(i));
      closedForm.push_back(
        { i / (samples + 1.0), std::log10(std::max(exact->GetTuple1(i), 1e-30)) });
    }
    std::printf("%s: largest |measured - closed form| %.1e, largest error bound %.1e\n",
      systemNames[static_cast<std::size_t>(system)].c_str(), difference, largestBound);
    // Smooth's closed form is 0, which has no place on this scale.
    if (system != vtkJacobianContinuity::SMOOTH)
    {
      panel.Stroke(closedForm, { color, 2.4 });
    }
    for (int i = 3; i <= samples; i += 4)
    {
      panel.Ring({ i / (samples + 1.0), std::log10(std::max(jump->GetTuple1(i), 1e-13)) }, 4.0,
        { 1.0, 1.0, 1.0 }, { color, 2.0 });
    }
  }
  const auto name = [&panel](double x, double y, const std::string& text, int system) {
    Lettering lettering;
    lettering.Size = 20.0;
    lettering.Ink = systemColors[static_cast<std::size_t>(system)];
    panel.Label({ x, y }, text, lettering);
  };
  name(0.16, 0.33, "Linear", 0);
  name(0.84, -1.25, "Contour", 1);
  name(0.5, -7.0, "Smooth: no jump, only the measurement's rounding", 2);
  panel.Frame({ ink, 1.2 });
  drawing.Write(folder + "/figure-7-jump-along-edge.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
