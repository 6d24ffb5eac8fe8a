// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// How much the Jacobian jumps across the edges of a pair of meshes, in the three coordinate
// systems.
//
//   Figure8JumpOnMesh [--photographs] [OUTPUT_FOLDER]
//
// The meshes are laid over two drawn faces; with --photographs, over the two of Debian's package
// gtkmorph-example.

#include "Drawing.h"
#include "Meshes.h"
#include "Program/XmorphMesh.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDelaunay2D.h"
#include "vtkIdList.h"
#include "vtkJacobianContinuity.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPNGReader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const Color meshColor{ 0.25, 0.35, 0.55, 0.75 };

// --- Colors
// --------------------------------------------------------------------------------------

constexpr double lowestPower = -12.0;

/// From pale to dark: between neighbors linear in CIELAB, each placed where its lightness says.
Color ColorOf(double share)
{
  static const std::array<std::array<double, 3>, 6> colors{ { { 0.990, 0.975, 0.860 },
    { 0.965, 0.815, 0.520 }, { 0.910, 0.540, 0.390 }, { 0.735, 0.290, 0.420 },
    { 0.430, 0.155, 0.430 }, { 0.145, 0.070, 0.230 } } };
  std::array<std::array<double, 3>, 6> lab{};
  for (std::size_t k = 0; k < colors.size(); ++k)
  {
    vtkMath::RGBToLab(colors[k].data(), lab[k].data());
  }
  const double lightness =
    lab.front()[0] + std::clamp(share, 0.0, 1.0) * (lab.back()[0] - lab.front()[0]);
  std::size_t k = 1;
  while (k + 1 < lab.size() && lab[k][0] > lightness)
  {
    ++k;
  }
  const double weight = (lightness - lab[k - 1][0]) / (lab[k][0] - lab[k - 1][0]);
  std::array<double, 3> mixed{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    mixed[i] = lab[k - 1][i] + weight * (lab[k][i] - lab[k - 1][i]);
  }
  std::array<double, 3> rgb{};
  vtkMath::LabToRGB(mixed.data(), rgb.data());
  return { rgb[0], rgb[1], rgb[2] };
}

Color ColorOfJump(double jump)
{
  // Not a number where a triangle has no neighbor.
  return jump > 0.0 ? ColorOf(1.0 - std::log10(jump) / lowestPower) : ColorOf(0.0);
}

std::string Scientific(double value)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  const std::string digits = text;
  const std::size_t e = digits.find('e');
  return digits.substr(0, e) + " \u00d7 10^{" + Decimal(std::stod(digits.substr(e + 1)), 0) + "}";
}

// --- The drawn faces
// ------------------------------------------------------------------------------

/// A point of the first face, and the same of the second, which looks aside and smiles.
struct Landmark
{
  Point First;
  Point Second;
};

/// The second face's points follow from the first's but for the features that move by themselves.
Point Turn(const Point& point, const Point& moved)
{
  // As of a ball that turns: the middle, which is nearest, goes furthest.
  const Point p = Add(point, moved);
  const double depth = std::max(0.0, 1.0 - p[0] * p[0] / 1.1 - p[1] * p[1] / 1.9);
  const Point turned{ p[0] + 0.19 * depth, p[1] + 0.05 * depth };
  constexpr double tilt = -0.10;
  return { std::cos(tilt) * turned[0] - std::sin(tilt) * turned[1],
    std::sin(tilt) * turned[0] + std::cos(tilt) * turned[1] };
}

std::vector<Landmark> MakeLandmarks()
{
  std::vector<Landmark> landmarks;
  const auto add = [&landmarks](const Point& point, const Point& moved) {
    landmarks.push_back({ point, Turn(point, moved) });
  };
  // On both sides, @a moved being that of the right one.
  const auto addBoth = [&add](const Point& point, const Point& moved) {
    add(point, moved);
    add({ -point[0], point[1] }, { -moved[0], moved[1] });
  };
  // Outline
  add({ 0.0, 1.30 }, { 0.0, 0.0 });
  addBoth({ 0.40, 1.21 }, { 0.0, 0.0 });
  addBoth({ 0.74, 0.95 }, { 0.0, 0.0 });
  addBoth({ 0.94, 0.55 }, { 0.0, 0.0 });
  addBoth({ 0.98, 0.10 }, { 0.02, 0.0 });
  addBoth({ 0.91, -0.35 }, { 0.05, 0.0 });
  addBoth({ 0.74, -0.77 }, { 0.05, 0.02 });
  addBoth({ 0.45, -1.10 }, { 0.02, 0.0 });
  add({ 0.0, -1.24 }, { 0.0, -0.04 });
  // Forehead
  add({ 0.0, 0.90 }, { 0.0, 0.02 });
  addBoth({ 0.38, 0.87 }, { 0.0, 0.03 });
  // Brows
  addBoth({ 0.19, 0.49 }, { 0.0, 0.07 });
  addBoth({ 0.43, 0.57 }, { 0.0, 0.09 });
  addBoth({ 0.68, 0.47 }, { 0.0, 0.08 });
  // Eyes
  addBoth({ 0.22, 0.24 }, { 0.0, 0.0 });
  addBoth({ 0.41, 0.355 }, { 0.0, 0.0 });
  addBoth({ 0.61, 0.25 }, { 0.0, 0.01 });
  addBoth({ 0.41, 0.16 }, { 0.0, 0.04 });
  // Nose
  add({ 0.0, 0.27 }, { 0.0, 0.0 });
  add({ 0.0, -0.08 }, { 0.05, 0.02 });
  addBoth({ 0.17, -0.20 }, { 0.03, 0.02 });
  add({ 0.0, -0.27 }, { 0.04, 0.02 });
  // Cheeks
  addBoth({ 0.62, -0.16 }, { 0.02, 0.06 });
  addBoth({ 0.58, -0.60 }, { 0.05, 0.04 });
  // Mouth
  addBoth({ 0.34, -0.62 }, { 0.08, 0.11 });
  addBoth({ 0.14, -0.54 }, { 0.05, 0.0 });
  add({ 0.0, -0.57 }, { 0.0, -0.01 });
  addBoth({ 0.15, -0.695 }, { 0.06, -0.02 });
  add({ 0.0, -0.72 }, { 0.0, -0.06 });
  // Chin
  add({ 0.0, -1.00 }, { 0.0, -0.04 });
  return landmarks;
}

/// A closed smooth curve through points (Catmull and Rom's), or an open one.
Curve Interpolate(const Curve& points, bool closed)
{
  constexpr int pieces = 24;
  const int count = static_cast<int>(points.size());
  const auto at = [&](int i) {
    return points[static_cast<std::size_t>(
      closed ? (i + count) % count : std::clamp(i, 0, count - 1))];
  };
  Curve curve;
  for (int i = 0; i < (closed ? count : count - 1); ++i)
  {
    for (int k = 0; k < pieces; ++k)
    {
      const double t = static_cast<double>(k) / pieces;
      const std::array<double, 4> weights{ 0.5 * (-t + 2.0 * t * t - t * t * t),
        0.5 * (2.0 - 5.0 * t * t + 3.0 * t * t * t), 0.5 * (t + 4.0 * t * t - 3.0 * t * t * t),
        0.5 * (-t * t + t * t * t) };
      Point sum{ 0.0, 0.0 };
      for (std::size_t j = 0; j < weights.size(); ++j)
      {
        sum = Add(sum, at(i + static_cast<int>(j) - 1), weights[j]);
      }
      curve.push_back(sum);
    }
  }
  if (!closed)
  {
    curve.push_back(points.back());
  }
  return curve;
}

Curve Circle(const Point& center, double radius)
{
  Curve circle;
  for (int k = 0; k < 48; ++k)
  {
    const double angle = vtkMath::Pi() * k / 24.0;
    circle.push_back(Add(center, { std::cos(angle), std::sin(angle) }, radius));
  }
  return circle;
}

/// The features of the first face, taken to where @a place says.
void DrawFace(Panel& panel, vtkPolyData* mesh, const std::function<Curve(const Curve&)>& place)
{
  for (vtkIdType triangle = 0; triangle < mesh->GetNumberOfCells(); ++triangle)
  {
    panel.Fill(GetTriangle(mesh, triangle), { 0.985, 0.885, 0.79 });
  }
  const Color lips{ 0.83, 0.36, 0.36 };
  const Color line{ 0.36, 0.20, 0.14 };
  for (const double side : { -1.0, 1.0 })
  {
    const auto mirror = [side](Curve curve) {
      for (Point& point : curve)
      {
        point[0] *= side;
      }
      return curve;
    };
    panel.Fill(place(Circle({ 0.62 * side, -0.27 }, 0.14)), { 0.97, 0.76, 0.68 });
    const Curve eye = place(Interpolate(
      mirror({ { 0.22, 0.24 }, { 0.41, 0.355 }, { 0.61, 0.25 }, { 0.41, 0.16 } }), true));
    panel.Fill(eye, { 1.0, 1.0, 1.0 });
    panel.Fill(place(Circle({ 0.41 * side, 0.258 }, 0.085)), { 0.22, 0.45, 0.55 });
    panel.Fill(place(Circle({ 0.41 * side, 0.258 }, 0.042)), { 0.08, 0.08, 0.10 });
    panel.StrokeClosed(eye, { line, 1.3 });
    panel.Stroke(
      place(Interpolate(mirror({ { 0.19, 0.49 }, { 0.43, 0.57 }, { 0.68, 0.47 } }), false)),
      { line, 4.0 });
  }
  panel.Stroke(
    place(Interpolate({ { -0.16, -0.17 }, { -0.13, -0.25 }, { -0.05, -0.24 }, { 0.0, -0.27 },
                        { 0.05, -0.24 }, { 0.13, -0.25 }, { 0.16, -0.17 } },
      false)),
    { line, 1.6 });
  const Curve mouth =
    place(Interpolate({ { -0.34, -0.62 }, { -0.14, -0.54 }, { 0.0, -0.57 }, { 0.14, -0.54 },
                        { 0.34, -0.62 }, { 0.15, -0.695 }, { 0.0, -0.72 }, { -0.15, -0.695 } },
      true));
  panel.Fill(mouth, lips);
  panel.Stroke(place(Interpolate({ { -0.34, -0.62 }, { -0.15, -0.62 }, { 0.0, -0.63 },
                                   { 0.15, -0.62 }, { 0.34, -0.62 } },
                 false)),
    { { 0.50, 0.14, 0.17 }, 1.3 });
}

double SignedArea(const Curve& triangle)
{
  const Point u = Subtract(triangle[1], triangle[0]);
  const Point v = Subtract(triangle[2], triangle[0]);
  return 0.5 * (u[0] * v[1] - u[1] * v[0]);
}

std::array<vtkSmartPointer<vtkPolyData>, 2> MakeFaces()
{
  Curve first;
  Curve second;
  for (const Landmark& landmark : MakeLandmarks())
  {
    first.push_back(landmark.First);
    second.push_back(landmark.Second);
  }
  vtkNew<vtkDelaunay2D> delaunay;
  delaunay->SetInputData(MakeMesh(first, {}));
  delaunay->Update();
  std::vector<TriangleIds> triangles;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < delaunay->GetOutput()->GetNumberOfCells(); ++cell)
  {
    delaunay->GetOutput()->GetCellPoints(cell, ids);
    triangles.push_back({ ids->GetId(0), ids->GetId(1), ids->GetId(2) });
  }
  const std::array<vtkSmartPointer<vtkPolyData>, 2> faces{ MakeMesh(first, triangles),
    MakeMesh(second, triangles) };
  for (vtkIdType cell = 0; cell < faces[0]->GetNumberOfCells(); ++cell)
  {
    if (!(SignedArea(GetTriangle(faces[0], cell)) * SignedArea(GetTriangle(faces[1], cell)) > 0.0))
    {
      throw std::runtime_error(
        "Triangle " + std::to_string(cell) + " of the second face is turned over.");
    }
  }
  return faces;
}

// --- The photographs
// ------------------------------------------------------------------------------

vtkSmartPointer<vtkImageData> ReadPhotograph(const std::string& fileName)
{
  if (!std::filesystem::exists(fileName))
  {
    throw std::runtime_error(
      fileName + " is not there: install Debian's package gtkmorph-example.");
  }
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(fileName.c_str());
  reader->Update();
  // Pixels count from (0, 0), whatever resolution the file claims.
  reader->GetOutput()->SetSpacing(1.0, 1.0, 1.0);
  reader->GetOutput()->SetOrigin(0.0, 0.0, 0.0);
  return reader->GetOutput();
}

// --- The picture
// ----------------------------------------------------------------------------------

Rectangle FrameAround(vtkPolyData* mesh)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  const double margin = 0.015 * (bounds[3] - bounds[2]);
  return { bounds[0] - margin, bounds[2] - margin, bounds[1] - bounds[0] + 2.0 * margin,
    bounds[3] - bounds[2] + 2.0 * margin };
}

void DrawJumps(Panel& panel, vtkJacobianContinuity* continuity)
{
  vtkPolyData* const triangulation = continuity->GetOutput(1);
  vtkDataArray* const ofTriangles = triangulation->GetCellData()->GetArray("JacobianJump");
  for (vtkIdType triangle = 0; triangle < triangulation->GetNumberOfCells(); ++triangle)
  {
    panel.Fill(GetTriangle(triangulation, triangle), ColorOfJump(ofTriangles->GetTuple1(triangle)));
  }
  // Colored edges between gray ones, thinner where there are many.
  const double width = triangulation->GetNumberOfCells() > 200 ? 1.0 : 2.0;
  panel.StrokeEdges(triangulation, { { 0.62, 0.60, 0.62 }, 1.7 * width });
  vtkPolyData* const edges = continuity->GetOutput(0);
  vtkDataArray* const ofEdges = edges->GetCellData()->GetArray("JacobianJump");
  vtkNew<vtkIdList> ids;
  for (vtkIdType edge = 0; edge < edges->GetNumberOfCells(); ++edge)
  {
    edges->GetCellPoints(edge, ids);
    double from[3];
    double to[3];
    edges->GetPoint(ids->GetId(0), from);
    edges->GetPoint(ids->GetId(ids->GetNumberOfIds() - 1), to);
    panel.Stroke(
      { { from[0], from[1] }, { to[0], to[1] } }, { ColorOfJump(ofEdges->GetTuple1(edge)), width });
  }
  for (const Curve& edge : BoundaryEdges(triangulation))
  {
    panel.Stroke(edge, { ink, 2.0 });
  }
}

void Draw(const std::string& fileName, const std::array<vtkSmartPointer<vtkPolyData>, 2>& meshes,
  const std::function<void(int side, Panel& panel)>& drawFace)
{
  constexpr int height = 505;
  Drawing drawing(1240, height);
  Panel page = drawing.GetPage();
  constexpr double titleHeight = height - 24.0;
  page.Label({ 103.0, titleHeight }, "Source and target", { 19.0 });
  for (int side = 0; side < 2; ++side)
  {
    vtkPolyData* const mesh = meshes[static_cast<std::size_t>(side)];
    Panel panel(drawing, { 8.0, side == 0 ? 236.0 : 8.0, 190.0, 222.0 }, FrameAround(mesh));
    drawFace(side, panel);
    panel.StrokeEdges(mesh, { meshColor, 0.8 });
  }

  std::printf(
    "%-8s %10s %10s %14s %14s\n", "", "triangles", "discordant", "least jump", "largest jump");
  for (int system = 0; system < 3; ++system)
  {
    vtkNew<vtkJacobianContinuity> continuity;
    continuity->SetSourceData(meshes[0]);
    continuity->SetTargetData(meshes[1]);
    continuity->SetCoordinateSystem(system);
    continuity->SetDiscordantTriangles(vtkJacobianContinuity::USE_LINEAR);
    continuity->Update();
    vtkDataArray* const jumps = continuity->GetOutput(0)->GetCellData()->GetArray("JacobianJump");
    if (!jumps || jumps->GetNumberOfTuples() == 0)
    {
      throw std::runtime_error("The pair of meshes was refused.");
    }
    double least = std::numeric_limits<double>::max();
    for (vtkIdType edge = 0; edge < jumps->GetNumberOfTuples(); ++edge)
    {
      least = std::min(least, jumps->GetTuple1(edge));
    }
    vtkIdType discordant = 0;
    if (system == vtkJacobianContinuity::CONTOUR)
    {
      const auto first = MakeCoordinates(meshes[0], system, 1, 1);
      const auto second = MakeCoordinates(meshes[1], system, 1, 1);
      for (vtkIdType triangle = 0; triangle < meshes[0]->GetNumberOfCells(); ++triangle)
      {
        discordant += IsConcordant(first, triangle) && IsConcordant(second, triangle) ? 0 : 1;
      }
    }
    const double largest = continuity->GetLargestJump();
    const std::string& name = systemNames[static_cast<std::size_t>(system)];
    std::printf("%-8s %10lld %10lld %14.2g %14.2g\n", name.c_str(),
      static_cast<long long>(meshes[0]->GetNumberOfCells()), static_cast<long long>(discordant),
      least, largest);

    const double left = 212.0 + 312.0 * system;
    Panel panel(drawing, { left, 36.0, 304.0, 424.0 }, FrameAround(meshes[0]));
    DrawJumps(panel, continuity);
    page.Label({ left + 152.0, titleHeight }, name, { 22.0 });
    page.Label({ left + 152.0, 16.0 },
      "largest jump " + (largest < 0.01 ? Scientific(largest) : Decimal(largest, 2)), { 16.0 });
  }

  std::vector<std::pair<double, std::string>> ticks;
  for (int power = static_cast<int>(lowestPower); power <= 0; power += 3)
  {
    ticks.emplace_back(
      1.0 - power / lowestPower, power == 0 ? "1" : "10^{" + Decimal(power, 0) + "}");
  }
  drawing.ColorBar({ 1163.0, 60.0, 16.0, 380.0 }, ColorOf, ticks);
  drawing.Write(fileName);
}

void DrawDrawnFaces(const std::string& fileName)
{
  const auto meshes = MakeFaces();
  Draw(fileName, meshes, [&meshes](int side, Panel& panel) {
    if (side == 0)
    {
      DrawFace(panel, meshes[0], [](const Curve& curve) { return curve; });
      return;
    }
    const auto map = MakeMap(meshes[0], meshes[1], vtkHomeomorphismTransform::SMOOTH);
    DrawFace(panel, meshes[1], [&map](const Curve& curve) { return MapCurve(map, curve); });
  });
}

void DrawPhotographs(const std::string& fileName)
{
  const std::string folder = "/usr/share/xmorph/example/AD/";
  std::array<vtkSmartPointer<vtkImageData>, 2> images;
  std::array<XmorphMesh, 2> grids;
  for (std::size_t side = 0; side < 2; ++side)
  {
    const std::string name = folder + (side == 0 ? "image1.png" : "image2.png");
    images[side] = ReadPhotograph(name);
    grids[side] = ReadXmorphMesh(name + ".mesh");
    int size[3];
    images[side]->GetDimensions(size);
    FitToPicture(grids[side], size[0], size[1]);
  }
  Draw(fileName, CutIntoTriangles(grids[0], grids[1]),
    [&images](int side, Panel& panel) { panel.Image(images[static_cast<std::size_t>(side)]); });
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, { "--photographs" },
    [](const std::string& folder, const std::vector<std::string>& given) {
      if (given.empty())
      {
        DrawDrawnFaces(folder + "/figure-8-jump-on-mesh.png");
      }
      else
      {
        DrawPhotographs(folder + "/figure-8-faces.png");
      }
    });
}
