// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// A pair of meshes over faces, each triangle coloured by the largest jump of the Jacobian across its edges,
// for the three coordinate systems. With --photographs, the meshes of Debian's package gtkmorph-example.

#include "Drawing.h"
#include "Meshes.h"
#include "XmorphMesh.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDelaunay2D.h"
#include "vtkImageData.h"
#include "vtkJacobianContinuity.h"
#include "vtkPNGReader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const std::string photographs = "/usr/share/xmorph/example/AD/";

// Of the colours' scale, as powers of ten.
constexpr double lowest = -12.0;
constexpr double highest = 0.0;

struct FacePair
{
  vtkSmartPointer<vtkPolyData> Source;
  vtkSmartPointer<vtkPolyData> Target;
  /// What shows that it is a face, over the source and over the target.
  std::array<std::vector<Curve>, 2> Features;
  vtkSmartPointer<vtkImageData> Photograph;
};

// --- A drawn face --------------------------------------------------------------------------------

/// Points of an ellipse.
Curve Oval(const Point& center, double width, double height, int count, double turn = 0.0)
{
  Curve oval;
  for (int k = 0; k < count; ++k)
  {
    const double angle = 2.0 * std::acos(-1.0) * k / count + turn;
    oval.push_back({ center[0] + width * std::cos(angle), center[1] + height * std::sin(angle) });
  }
  return oval;
}

Curve Closed(Curve curve)
{
  curve.push_back(curve.front());
  return curve;
}

/// The landmarks of a face: outline, eyes, brows, nose, mouth, as closed and open curves.
std::vector<Curve> MakeLandmarks()
{
  const Curve brow{ { 0.18, 0.36 }, { 0.36, 0.43 }, { 0.56, 0.36 } };
  Curve otherBrow;
  for (const Point& point : brow)
  {
    otherBrow.push_back({ -point[0], point[1] });
  }
  return { Closed(Oval({ 0.0, 0.0 }, 0.85, 1.1, 20, 0.1)), Closed(Oval({ 0.36, 0.2 }, 0.16, 0.075, 6)),
    Closed(Oval({ -0.36, 0.2 }, 0.16, 0.075, 6)), brow, otherBrow,
    { { 0.06, 0.2 }, { 0.1, -0.1 }, { 0.14, -0.22 }, { 0.0, -0.28 }, { -0.14, -0.22 } },
    { { -0.3, -0.56 }, { -0.13, -0.5 }, { 0.0, -0.53 }, { 0.13, -0.5 }, { 0.3, -0.56 },
      { 0.12, -0.66 }, { -0.12, -0.66 }, { -0.3, -0.56 } } };
}

/// Points that are no feature: cheeks, chin, forehead.
Curve MakeOtherLandmarks()
{
  return { { 0.5, -0.15 }, { -0.5, -0.15 }, { 0.52, -0.5 }, { -0.52, -0.5 }, { 0.0, -0.85 },
    { 0.3, -0.82 }, { -0.3, -0.82 }, { 0.0, 0.65 }, { 0.35, 0.7 }, { -0.35, 0.7 }, { 0.64, 0.15 },
    { -0.64, 0.15 }, { -0.06, 0.2 } };
}

/// The face turned to its left, smiling, with raised brows.
Point Turn(const Point& p)
{
  const double rim = std::min(1.0, p[0] * p[0] / 0.73 + p[1] * p[1] / 1.22);
  const double inner = 1.0 - rim;
  const auto bump = [&p](double x, double y, double width) {
    const double dx = p[0] - x;
    const double dy = p[1] - y;
    return std::exp(-(dx * dx + dy * dy) / (width * width));
  };
  const double smile = bump(0.3, -0.56, 0.2) + bump(-0.3, -0.56, 0.2);
  const double side = bump(0.3, -0.56, 0.2) - bump(-0.3, -0.56, 0.2);
  const double brows = bump(0.36, 0.42, 0.2) + bump(-0.36, 0.42, 0.2);
  return { p[0] + 0.16 * inner + 0.09 * side, p[1] + 0.12 * smile + 0.08 * brows - 0.03 * inner };
}

Curve TurnAll(const Curve& curve)
{
  Curve result;
  std::transform(curve.begin(), curve.end(), std::back_inserter(result), Turn);
  return result;
}

FacePair MakeDrawnFaces()
{
  FacePair faces;
  faces.Features[0] = MakeLandmarks();
  Curve points = MakeOtherLandmarks();
  for (const Curve& feature : faces.Features[0])
  {
    faces.Features[1].push_back(TurnAll(feature));
    const bool closed = feature.front() == feature.back();
    points.insert(points.end(), feature.begin(), feature.end() - (closed ? 1 : 0));
  }
  vtkNew<vtkDelaunay2D> triangulate;
  triangulate->SetInputData(MakeMesh(points, {}));
  triangulate->Update();
  std::vector<TriangleIds> triangles;
  vtkNew<vtkIdList> ids;
  vtkCellArray* cells = triangulate->GetOutput()->GetPolys();
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
  {
    cells->GetCellAtId(cell, ids);
    triangles.push_back({ ids->GetId(0), ids->GetId(1), ids->GetId(2) });
  }
  faces.Source = MakeMesh(points, triangles);
  faces.Target = MakeMesh(TurnAll(points), triangles);
  return faces;
}

// --- Photographed faces --------------------------------------------------------------------------

FacePair MakePhotographedFaces()
{
  std::array<XmorphMesh, 2> meshes;
  FacePair faces;
  for (std::size_t side = 0; side < 2; ++side)
  {
    const std::string image = photographs + "image" + std::to_string(side + 1) + ".png";
    if (!std::filesystem::exists(image))
    {
      throw std::runtime_error(
        image + " is not there: install Debian's package gtkmorph-example.");
    }
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(image.c_str());
    reader->Update();
    reader->GetOutput()->SetSpacing(1.0, 1.0, 1.0);
    reader->GetOutput()->SetOrigin(0.0, 0.0, 0.0);
    int size[3];
    reader->GetOutput()->GetDimensions(size);
    meshes[side] = ReadXmorphMesh(image + ".mesh");
    FitToPicture(meshes[side], size[0], size[1]);
    if (side == 0)
    {
      faces.Photograph = reader->GetOutput();
    }
  }
  const auto cut = CutIntoTriangles(meshes[0], meshes[1]);
  faces.Source = cut[0];
  faces.Target = cut[1];
  return faces;
}

// --- Drawing -------------------------------------------------------------------------------------

/// From light to dark, for 0 to 1.
Color ColorOf(double share)
{
  const std::vector<Color> colors{ { 1.0, 0.98, 0.83 }, { 0.98, 0.83, 0.55 }, { 0.93, 0.60, 0.38 },
    { 0.80, 0.36, 0.40 }, { 0.55, 0.20, 0.44 }, { 0.25, 0.10, 0.35 } };
  const double place =
    std::clamp(share, 0.0, 1.0) * static_cast<double>(colors.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), colors.size() - 2);
  const double rest = place - static_cast<double>(below);
  const auto blend = [rest](double a, double b) { return a + rest * (b - a); };
  const Color& a = colors[below];
  const Color& b = colors[below + 1];
  return { blend(a.Red, b.Red), blend(a.Green, b.Green), blend(a.Blue, b.Blue) };
}

Color ColorOfJump(double jump)
{
  return ColorOf((std::log10(std::max(jump, 1e-300)) - lowest) / (highest - lowest));
}

Rectangle BoundsOf(vtkPolyData* mesh)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  const double margin = 0.02 * (bounds[1] - bounds[0]);
  return { bounds[0] - margin, bounds[2] - margin, bounds[1] - bounds[0] + 2.0 * margin,
    bounds[3] - bounds[2] + 2.0 * margin };
}

void Draw(const FacePair& faces, const std::string& fileName)
{
  constexpr double panelWidth = 280.0;
  const Rectangle world = BoundsOf(faces.Target);
  const double panelHeight = panelWidth * world.Height / world.Width;
  const int height = static_cast<int>(panelHeight) + 60;
  Drawing drawing(1240, height);
  Panel page = drawing.GetPage();
  const auto leftOf = [](int panel) { return 8.0 + 288.0 * panel; };
  const auto title = [&](int panel, const std::string& text) {
    page.Label({ leftOf(panel) + 0.5 * panelWidth, height - 24.0 }, text, { 20.0 });
  };

  Panel start(drawing, { leftOf(0), 10.0, panelWidth, panelHeight }, BoundsOf(faces.Source));
  if (faces.Photograph)
  {
    start.Image(faces.Photograph);
  }
  start.StrokeEdges(faces.Source, { { 0.45, 0.52, 0.65, 0.7 }, 0.8 });
  for (const Curve& feature : faces.Features[0])
  {
    start.Stroke(feature, { ink, 2.2 });
  }
  title(0, "Source");

  for (int system = 0; system < 3; ++system)
  {
    vtkNew<vtkJacobianContinuity> filter;
    filter->SetSourceData(faces.Source);
    filter->SetTargetData(faces.Target);
    filter->SetCoordinateSystem(system);
    filter->SetDiscordantTriangles(vtkJacobianContinuity::CARRY_BY_LINEAR);
    filter->Update();
    auto* colored = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
    vtkDataArray* jump = colored->GetCellData()->GetArray("JacobianJump");
    if (!jump)
    {
      throw std::runtime_error("The pair of triangulations was refused.");
    }
    const std::string& name = systemNames[static_cast<std::size_t>(system)];
    std::printf("%s: %lld of %lld edges have a kink, largest jump %.1e\n", name.c_str(),
      static_cast<long long>(filter->GetNumberOfKinks()),
      static_cast<long long>(filter->GetOutput()->GetNumberOfCells()), filter->GetLargestJump());
    Panel panel(drawing, { leftOf(system + 1), 10.0, panelWidth, panelHeight }, world);
    for (vtkIdType triangle = 0; triangle < colored->GetNumberOfCells(); ++triangle)
    {
      panel.Fill(GetTriangle(faces.Target, triangle), ColorOfJump(jump->GetTuple1(triangle)));
    }
    panel.StrokeEdges(faces.Target, { { 1.0, 1.0, 1.0, 0.6 }, 0.8 });
    for (const Curve& feature : faces.Features[1])
    {
      panel.Stroke(feature, { ink, 2.2 });
    }
    title(system + 1, name);
  }
  std::vector<std::pair<double, std::string>> ticks;
  for (int power = static_cast<int>(lowest); power <= static_cast<int>(highest); power += 3)
  {
    ticks.emplace_back((power - lowest) / (highest - lowest),
      power == 0 ? "1" : "10^{" + Decimal(power, 0) + "}");
  }
  drawing.ColorBar({ 1164.0, 30.0, 18.0, panelHeight - 40.0 }, ColorOf, ticks);
  drawing.Write(fileName);
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, { "--photographs" },
    [](const std::string& folder, const std::vector<std::string>& options) {
      if (options.empty())
      {
        Draw(MakeDrawnFaces(), folder + "/figure-8-jump-on-mesh.png");
      }
      else
      {
        Draw(MakePhotographedFaces(), folder + "/figure-8-faces.png");
      }
    });
}
