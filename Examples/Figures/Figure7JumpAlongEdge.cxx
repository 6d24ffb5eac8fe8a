// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The relative jump of the Jacobian along the edge of two triangles of which one is stretched:
// measured from outside, and in closed form.

#include "Drawing.h"
#include "Meshes.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkJacobianContinuity.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const std::array<Color, 3> systemColors{ Color{ 0.80, 0.36, 0.08 }, Color{ 0.13, 0.40, 0.67 },
  Color{ 0.16, 0.52, 0.30 } };

struct Sample
{
  double Position;
  double Measured;
  double Exact;
  double Bound;
};

std::vector<Sample> Measure(vtkPolyData* source, vtkPolyData* target, int system)
{
  vtkNew<vtkJacobianContinuity> continuity;
  continuity->SetSourceData(source);
  continuity->SetTargetData(target);
  continuity->SetCoordinateSystem(system);
  continuity->SetSamplesPerEdge(99);
  continuity->Update();
  vtkPolyData* const edges = continuity->GetOutput();
  if (edges->GetNumberOfLines() != 1)
  {
    throw std::runtime_error("The pair of triangulations was refused.");
  }
  vtkPointData* const data = edges->GetPointData();
  vtkNew<vtkIdList> ids;
  edges->GetLines()->GetCellAtId(0, ids);
  std::vector<Sample> samples;
  // The ends are vertices, which have no jump.
  for (vtkIdType i = 1; i + 1 < ids->GetNumberOfIds(); ++i)
  {
    const vtkIdType id = ids->GetId(i);
    const auto value = [&](const char* name) { return data->GetArray(name)->GetTuple1(id); };
    samples.push_back({ (edges->GetPoint(id)[0] + 2.0) / 4.0, value("JacobianJump"),
      value("JacobianJumpExact"), value("JacobianJumpError") });
  }
  return samples;
}

void Draw(const std::string& folder)
{
  const std::vector<TriangleIds> triangles{ { 0, 1, 2 }, { 1, 0, 3 } };
  const auto source =
    MakeMesh({ { -2.0, 0.0 }, { 2.0, 0.0 }, { 0.0, 3.0 }, { 0.0, -3.0 } }, triangles);
  const auto target =
    MakeMesh({ { -2.0, 0.0 }, { 2.0, 0.0 }, { 0.6, 6.0 }, { 0.0, -3.0 } }, triangles);

  constexpr double lowest = -13.0;
  constexpr double highest = 1.0;
  Drawing drawing(1120, 640);
  Panel page = drawing.GetPage();
  Panel plot(drawing, { 105.0, 70.0, 860.0, 550.0 }, { 0.0, lowest, 1.0, highest - lowest }, true);
  const auto place = [&](double position, double value) {
    return Point{ position, std::log10(std::max(value, std::pow(10.0, lowest))) };
  };

  for (int power = static_cast<int>(lowest); power <= static_cast<int>(highest); ++power)
  {
    const Point tick = plot.ToPage({ 0.0, static_cast<double>(power) });
    plot.Stroke({ { 0.0, static_cast<double>(power) }, { 1.0, static_cast<double>(power) } },
      { { 0.91, 0.915, 0.925 }, 1.0 });
    page.Stroke({ tick, Add(tick, { -6.0, 0.0 }) }, { ink, 1.2 });
    if (power % 2 == 0)
    {
      Lettering letters{ 16.0 };
      letters.Horizontal = Alignment::Right;
      page.Label(
        tick, power == 0 ? "1" : "10^{" + Decimal(power, 0) + "}", letters, { -11.0, 0.0 });
    }
  }
  for (int k = 0; k <= 4; ++k)
  {
    const Point tick = plot.ToPage({ 0.25 * k, lowest });
    page.Stroke({ tick, Add(tick, { 0.0, -6.0 }) }, { ink, 1.2 });
    page.Label(tick, Decimal(0.25 * k, 2), { 16.0 }, { 0.0, -20.0 });
  }
  page.Label({ 535.0, 20.0 }, "position along the edge", { 17.0 });
  Lettering turned{ 17.0 };
  turned.Orientation = 90.0;
  page.Label({ 28.0, 345.0 }, "relative jump of the Jacobian", turned);

  std::printf("%-8s %22s %14s %14s %14s\n", "", "largest |measured - exact|", "error bound",
    "least jump", "largest jump");
  for (std::size_t system = 0; system < 3; ++system)
  {
    const std::vector<Sample> samples = Measure(source, target, static_cast<int>(system));
    double difference = 0.0;
    double bound = 0.0;
    double least = samples[0].Measured;
    double largest = 0.0;
    Curve exact;
    Curve bounds;
    for (const Sample& sample : samples)
    {
      difference = std::max(difference, std::abs(sample.Measured - sample.Exact));
      bound = std::max(bound, sample.Bound);
      least = std::min(least, sample.Measured);
      largest = std::max(largest, sample.Measured);
      exact.push_back(place(sample.Position, sample.Exact));
      bounds.push_back(place(sample.Position, sample.Bound));
    }
    std::printf("%-8s %26.2g %14.2g %14.2g %14.2g\n", systemNames[system].c_str(), difference,
      bound, least, largest);
    const Color& color = systemColors[system];
    const bool smooth = static_cast<int>(system) == vtkJacobianContinuity::SMOOTH;
    plot.Stroke(smooth ? bounds : exact, { color, smooth ? 1.2 : 2.0, smooth ? 4.0 : 0.0 });
    for (std::size_t i = 4; i < samples.size(); i += 5)
    {
      plot.Ring(
        place(samples[i].Position, samples[i].Measured), 4.5, { 1.0, 1.0, 1.0 }, { color, 1.8 });
    }
    Lettering letters{ 18.0, color };
    letters.Horizontal = Alignment::Left;
    if (smooth)
    {
      // Measured values are scattered: the name is in their middle.
      plot.Label({ 1.0, -11.6 }, systemNames[system], letters, { 12.0, 0.0 });
      letters.Size = 15.0;
      plot.Label({ 1.0, bounds.back()[1] }, "bound on its error", letters, { 12.0, 0.0 });
    }
    else
    {
      plot.Label({ 1.0, exact.back()[1] }, systemNames[system], letters, { 12.0, 0.0 });
    }
  }
  plot.Frame({ ink, 1.2 });
  drawing.Write(folder + "/figure-7-jump-along-edge.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
