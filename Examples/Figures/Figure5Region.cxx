// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Where the third vertex C may be for a triangle ABC with A = (0, 0) and B = (1, 0) to be
// concordant, and what the library says about 100000 random triangles.
//
// With G = (A + B + C) / 3 the condition 0 < (G - A).(B - A) < |B - A|^2 says -1 < x < 2. For the
// edge BC it says (x - 1)(x - 2) + y^2 > 0 and (x - 1)(2x - 1) + 2 y^2 > 0: outside the circles
// about (3/2, 0) and (3/4, 0) with radius 1/2 and 1/4. The edge CA has their mirror images in x =
// 1/2.

#include "Drawing.h"
#include "Meshes.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkNew.h"

#include <cstdint>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const Color concordantFill{ 0.885, 0.93, 0.975 };
const Color discordantFill{ 0.995, 0.925, 0.865 };
const Color concordantDot{ 0.22, 0.47, 0.73 };
const Color discordantDot{ 0.84, 0.42, 0.12 };

constexpr double leftmost = -1.5;
constexpr double rightmost = 2.5;
constexpr double highest = 1.6;

/// Coordinates are multiples of 1 / unit, so that all that follows is exact.
constexpr std::int64_t unit = std::int64_t{ 1 } << 20;

struct Sample
{
  std::int64_t X;
  std::int64_t Y;
};

bool IsInRegion(const Sample& sample)
{
  const auto isOutside = [](std::int64_t x, std::int64_t y) {
    return (x - unit) * (x - 2 * unit) + y * y > 0 && (x - unit) * (2 * x - unit) + 2 * y * y > 0;
  };
  return sample.X > -unit && sample.X < 2 * unit && isOutside(sample.X, sample.Y) &&
    isOutside(unit - sample.X, sample.Y);
}

std::vector<Sample> MakeSamples(std::size_t count)
{
  std::mt19937_64 generator(2001);
  // The top bits of a number, scaled: the distributions of the standard differ between libraries.
  const auto draw = [&generator](double from, double to) {
    const auto first = static_cast<std::int64_t>(from * unit);
    const auto range = static_cast<std::uint64_t>((to - from) * unit) + 1;
    return first + static_cast<std::int64_t>((generator() >> 32) * range >> 32);
  };
  std::vector<Sample> samples;
  while (samples.size() < count)
  {
    const std::int64_t x = draw(leftmost, rightmost);
    const std::int64_t y = draw(-highest, highest);
    if (y != 0)
    {
      samples.push_back({ x, y });
    }
  }
  return samples;
}

/// What the library says of each triangle.
std::vector<bool> Ask(const std::vector<Sample>& samples)
{
  // Side by side, without overlaps, at whole numbers.
  constexpr double distance = 5.0;
  Curve points;
  std::vector<TriangleIds> triangles;
  for (const Sample& sample : samples)
  {
    const auto first = static_cast<vtkIdType>(points.size());
    const double offset = distance * static_cast<double>(triangles.size());
    points.push_back({ offset, 0.0 });
    points.push_back({ offset + 1.0, 0.0 });
    points.push_back({ offset + static_cast<double>(sample.X) / static_cast<double>(unit),
      static_cast<double>(sample.Y) / static_cast<double>(unit) });
    triangles.push_back({ first, first + 1, first + 2 });
  }
  const auto mesh = MakeMesh(points, triangles);
  vtkNew<vtkTriangularCoordinates> coordinates;
  coordinates->SetInputData(mesh);
  coordinates->GenerateLinesOff();
  coordinates->Update();
  if (coordinates->GetErrorCode() != 0)
  {
    throw std::runtime_error("The triangles were refused.");
  }
  vtkDataArray* const concordant =
    coordinates->GetTriangulation()->GetCellData()->GetArray("Concordant");
  std::vector<bool> answers;
  for (vtkIdType i = 0; i < concordant->GetNumberOfTuples(); ++i)
  {
    answers.push_back(concordant->GetTuple1(i) != 0.0);
  }
  return answers;
}

void Draw(const std::string& folder)
{
  const std::vector<Sample> samples = MakeSamples(100000);
  const std::vector<bool> answers = Ask(samples);
  if (answers.size() != samples.size())
  {
    throw std::runtime_error("The library did not answer for every triangle.");
  }
  int disagreements = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    disagreements += answers[i] != IsInRegion(samples[i]) ? 1 : 0;
  }
  std::cout << samples.size() << " points, " << disagreements << " disagreements\n";

  const double middle = 0.5 * (leftmost + rightmost);
  Drawing drawing(1190, 948);
  Panel page = drawing.GetPage();
  Panel panel(drawing, { 45.0, 40.0, 1125.0, 900.0 },
    { leftmost, -highest, rightmost - leftmost, 2.0 * highest });

  // The region, and on top of it what is not part of it.
  const auto fillColumns = [&](double from, double to, const Color& color) {
    panel.Fill({ { from, -highest }, { to, -highest }, { to, highest }, { from, highest } }, color);
  };
  fillColumns(leftmost, rightmost, discordantFill);
  fillColumns(-1.0, 2.0, concordantFill);
  struct Circle
  {
    double X;
    double Radius;
    std::string Center;
    std::string RadiusText;
  };
  const std::vector<Circle> circles{ { 1.5, 0.5, "3/2", "1/2" }, { 0.75, 0.25, "3/4", "1/4" },
    { 0.25, 0.25, "1/4", "1/4" }, { -0.5, 0.5, "\u22121/2", "1/2" } };
  for (const Circle& circle : circles)
  {
    panel.FillCircle({ circle.X, 0.0 }, circle.Radius, discordantFill);
  }
  for (std::size_t i = 0; i < 4000; ++i)
  {
    panel.Dot({ static_cast<double>(samples[i].X) / static_cast<double>(unit),
                static_cast<double>(samples[i].Y) / static_cast<double>(unit) },
      1.7, answers[i] ? concordantDot : discordantDot);
  }

  const Pen boundary{ ink, 2.2 };
  panel.Stroke({ { leftmost, 0.0 }, { rightmost, 0.0 } }, { { 0.45, 0.47, 0.52 }, 1.2 });
  for (const double x : { -1.0, 2.0 })
  {
    panel.Stroke({ { x, -highest }, { x, highest } }, boundary);
  }
  const Lettering small{ 14.0 };
  for (const Circle& circle : circles)
  {
    panel.StrokeCircle({ circle.X, 0.0 }, circle.Radius, boundary);
    const double rise = 0.4 * circle.Radius;
    panel.Label({ circle.X, rise }, "center (" + circle.Center + ", 0)", small);
    panel.Label({ circle.X, -rise }, "radius " + circle.RadiusText, small);
    panel.Dot({ circle.X, 0.0 }, 3.0, ink);
  }
  const Lettering large{ 18.0 };
  panel.Label({ -1.0, 1.35 }, "$x$ = \u22121", large, { 40.0, 0.0 });
  panel.Label({ 2.0, 1.35 }, "$x$ = 2", large, { -34.0, 0.0 });
  panel.Label({ middle, 1.1 }, "$ABC$ concordant", { 24.0, { 0.10, 0.32, 0.56 } });
  panel.Label({ middle, -1.1 }, "$ABC$ concordant", { 24.0, { 0.10, 0.32, 0.56 } });
  for (const double x : { -1.25, 2.25 })
  {
    panel.Label({ x, 0.75 }, "discordant", { 18.0, { 0.66, 0.29, 0.05 } });
  }
  panel.Dot({ 0.0, 0.0 }, 6.0, ink);
  panel.Dot({ 1.0, 0.0 }, 6.0, ink);
  panel.Label({ 0.0, 0.0 }, "$A$", { 24.0 }, { 9.0, 56.0 });
  panel.Label({ 1.0, 0.0 }, "$B$", { 24.0 }, { -9.0, 56.0 });
  panel.Frame({ ink, 1.2 });

  for (const double x : { -1.0, 0.0, 1.0, 2.0 })
  {
    const Point onPage = panel.ToPage({ x, -highest });
    page.Stroke({ onPage, Add(onPage, { 0.0, -6.0 }) }, { ink, 1.2 });
    page.Label(onPage, Decimal(x, 0), { 16.0 }, { 0.0, -20.0 });
  }
  for (const double y : { -1.0, 0.0, 1.0 })
  {
    const Point onPage = panel.ToPage({ leftmost, y });
    page.Stroke({ onPage, Add(onPage, { -6.0, 0.0 }) }, { ink, 1.2 });
    Lettering letters{ 16.0 };
    letters.Horizontal = Alignment::Right;
    page.Label(onPage, Decimal(y, 0), letters, { -11.0, 0.0 });
  }
  drawing.Write(folder + "/figure-5-region.png");
  if (disagreements > 0)
  {
    throw std::runtime_error("The library and the inequalities disagree.");
  }
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
