// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// For which third corner C is the triangle ABC concordant, A = (0, 0) and B = (1, 0) being given? The region
// from the inequalities, confirmed by the library's predicate at 100,000 points.

#include "Drawing.h"
#include "Meshes.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"

#include <cmath>
#include <iostream>
#include <random>
#include <stdexcept>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const Color insideColor{ 0.82, 0.90, 0.97 };
const Color borderColor{ 0.13, 0.40, 0.67 };
const Color concordantColor{ 0.10, 0.33, 0.58 };
const Color discordantColor{ 0.80, 0.30, 0.20 };

struct Circle
{
  double CenterX;
  double Radius;
  std::string Label;
};

const std::array<Circle, 4> circles{ { { 1.5, 0.5, "radius 1/2" }, { 0.75, 0.25, "radius 1/4" },
  { -0.5, 0.5, "radius 1/2" }, { 0.25, 0.25, "radius 1/4" } } };
constexpr double leftLine = -1.0;
constexpr double rightLine = 2.0;

/// By the inequalities. In products of coordinates that are multiples of 2^-20 nothing is rounded.
bool IsInRegion(const Point& c)
{
  bool inside = leftLine < c[0] && c[0] < rightLine;
  for (const Circle& circle : circles)
  {
    const double x = c[0] - circle.CenterX;
    inside = inside && x * x + c[1] * c[1] > circle.Radius * circle.Radius;
  }
  return inside;
}

/// Random points that are multiples of 2^-20, off the line AB.
Curve MakeSamples(int count)
{
  std::mt19937_64 generator(20);
  const auto multiple = [&generator](double lower, double upper) {
    const double unit = std::ldexp(static_cast<double>(generator() >> 11), -53);
    return std::floor(std::ldexp(lower + (upper - lower) * unit, 20)) * std::ldexp(1.0, -20);
  };
  Curve samples;
  while (static_cast<int>(samples.size()) < count)
  {
    const double x = multiple(-1.5, 2.5);
    const double y = multiple(-1.6, 1.6);
    if (y != 0.0)
    {
      samples.push_back({ x, y });
    }
  }
  return samples;
}

/// The library's answers for all samples, each as a triangle of its own, side by side.
std::vector<bool> AskLibrary(const Curve& samples)
{
  Curve points;
  std::vector<TriangleIds> triangles;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const double shift = 8.0 * static_cast<double>(i);
    const auto first = static_cast<vtkIdType>(points.size());
    points.insert(points.end(),
      { { shift, 0.0 }, { shift + 1.0, 0.0 }, { shift + samples[i][0], samples[i][1] } });
    triangles.push_back({ first, first + 1, first + 2 });
    if (samples[i][1] < 0.0)
    {
      std::swap(triangles.back()[0], triangles.back()[1]);
    }
  }
  vtkNew<vtkTriangularCoordinates> coordinates;
  coordinates->SetInputData(MakeMesh(points, triangles));
  coordinates->SetDiscordantTriangles(vtkTriangularCoordinates::CARRY_BY_LINEAR);
  coordinates->SetCoordinateSystemToContour();
  coordinates->GenerateLinesOff();
  coordinates->Update();
  std::vector<bool> answers;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    answers.push_back(IsConcordant(coordinates, static_cast<vtkIdType>(i)));
  }
  return answers;
}

void Draw(const std::string& folder)
{
  constexpr int count = 100000;
  constexpr std::size_t shown = 5000;
  const Curve samples = MakeSamples(count);
  const std::vector<bool> answers = AskLibrary(samples);
  int disagreements = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    disagreements += answers[i] != IsInRegion(samples[i]);
  }
  std::cout << count << " points, " << disagreements << " disagreements\n";
  if (disagreements > 0)
  {
    throw std::runtime_error("The region is not what the predicate says.");
  }

  constexpr int width = 1000;
  constexpr int height = 790;
  Drawing drawing(width, height);
  Panel panel(drawing, { 20.0, 20.0, 960.0, 750.0 }, { -1.5, -1.6, 4.0, 3.2 });
  panel.Fill({ { leftLine, -1.6 }, { rightLine, -1.6 }, { rightLine, 1.6 }, { leftLine, 1.6 } },
    insideColor);
  for (const Circle& circle : circles)
  {
    panel.FillCircle({ circle.CenterX, 0.0 }, circle.Radius, { 1.0, 1.0, 1.0 });
  }
  // Not under what is written.
  const auto isUnderLabel = [](const Point& p) {
    bool under = std::abs(p[1] - 1.45) < 0.06 && (p[0] < leftLine || p[0] > rightLine);
    under = under || (std::abs(p[0] - 0.5) < 0.52 && std::abs(p[1] - 1.15) < 0.08);
    for (const Circle& circle : circles)
    {
      under = under || (std::abs(p[0] - circle.CenterX) < 0.18 && std::abs(p[1] + 0.07) < 0.05);
    }
    return under;
  };
  for (std::size_t i = 0; i < shown; ++i)
  {
    if (isUnderLabel(samples[i]))
    {
      continue;
    }
    panel.Dot(samples[i], 1.5, answers[i] ? concordantColor : discordantColor);
  }
  const Pen border{ borderColor, 2.6 };
  panel.Stroke({ { leftLine, -1.6 }, { leftLine, 1.6 } }, border);
  panel.Stroke({ { rightLine, -1.6 }, { rightLine, 1.6 } }, border);
  for (const Circle& circle : circles)
  {
    panel.StrokeCircle({ circle.CenterX, 0.0 }, circle.Radius, border);
    panel.Label({ circle.CenterX, 0.0 }, circle.Label, { 15.0 }, { 0.0, -16.0 });
  }
  panel.Stroke({ { 0.0, 0.0 }, { 1.0, 0.0 } }, { ink, 3.0 });
  panel.Dot({ 0.0, 0.0 }, 5.0, ink);
  panel.Dot({ 1.0, 0.0 }, 5.0, ink);
  panel.Label({ 0.0, 0.0 }, "$A$", { 20.0 }, { -6.0, 18.0 });
  panel.Label({ 1.0, 0.0 }, "$B$", { 20.0 }, { 6.0, 18.0 });
  panel.Label({ leftLine, 1.45 }, "$x$ = " + Decimal(leftLine, 0), { 18.0 }, { -38.0, 0.0 });
  panel.Label({ rightLine, 1.45 }, "$x$ = " + Decimal(rightLine, 0), { 18.0 }, { 34.0, 0.0 });
  panel.Label({ 0.5, 1.15 }, "$C$ here: concordant", { 24.0 });
  drawing.Write(folder + "/figure-5-region.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
