// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PairPicture.h"

#include "Canvas.h"
#include "MeshPair.h"
#include "MeshParts.h"
#include "PairReport.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace dhm
{
namespace
{

constexpr Color white{ 1.0, 1.0, 1.0, 1.0 };
constexpr Color frameColor{ 0.8, 0.8, 0.8, 1.0 };
constexpr Color edgeColor{ 0.2, 0.3, 0.45, 0.8 };
constexpr Color invalidColor{ 0.85, 0.1, 0.1, 0.85 };
constexpr Color discordantColor{ 0.98, 0.75, 0.3, 0.7 };
constexpr Color duplicateColor{ 0.6, 0.0, 0.6, 1.0 };

bool Contains(const std::vector<vtkIdType>& ids, vtkIdType id)
{
  return std::binary_search(ids.begin(), ids.end(), id);
}

} // namespace

vtkSmartPointer<vtkPolyData> Flatten(vtkPolyData* mesh)
{
  const vtkIdType count = mesh->GetNumberOfPoints();
  std::vector<std::array<double, 3>> places(static_cast<std::size_t>(count));
  std::vector<bool> finite(places.size());
  std::array<double, 3> low;
  std::array<double, 3> high;
  low.fill(VTK_DOUBLE_MAX);
  high.fill(VTK_DOUBLE_MIN);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    mesh->GetPoint(static_cast<vtkIdType>(i), places[i].data());
    finite[i] =
      std::all_of(places[i].begin(), places[i].end(), [](double x) { return std::isfinite(x); });
    for (std::size_t axis = 0; finite[i] && axis < 3; ++axis)
    {
      low[axis] = std::min(low[axis], places[i][axis]);
      high[axis] = std::max(high[axis], places[i][axis]);
    }
  }
  const auto thickness = [&](std::size_t axis) { return high[axis] - low[axis]; };
  std::size_t thinnest = 2;
  for (const std::size_t axis : { 1, 0 })
  {
    thinnest = thickness(axis) < thickness(thinnest) ? axis : thinnest;
  }
  const std::size_t x = thinnest == 0 ? 1 : 0;
  const std::size_t y = thinnest == 2 ? 1 : 2;

  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const bool shown = finite[i];
    points->SetPoint(static_cast<vtkIdType>(i), shown ? places[i][x] : 0.5 * (low[x] + high[x]),
      shown ? places[i][y] : 0.5 * (low[y] + high[y]), 0.0);
  }
  vtkNew<vtkCellArray> polygons;
  ForEachCell(mesh->GetPolys(), [&](vtkIdType, vtkIdType size, const vtkIdType* ids) {
    const bool shown = std::all_of(ids, ids + size,
      [&](vtkIdType id) { return id >= 0 && id < count && finite[static_cast<std::size_t>(id)]; });
    polygons->InsertNextCell(shown ? size : 0, ids);
  });
  auto flat = vtkSmartPointer<vtkPolyData>::New();
  flat->SetPoints(points);
  flat->SetPolys(polygons);
  // Cells keep their numbers.
  flat->SetVerts(mesh->GetVerts());
  flat->SetLines(mesh->GetLines());
  return flat;
}

std::array<double, 4> BoundsOf(vtkPolyData* flat)
{
  double bounds[6];
  flat->GetPoints()->GetBounds(bounds);
  const double size = std::max(bounds[1] - bounds[0], bounds[3] - bounds[2]);
  // An empty mesh, or a single point, has a place, too.
  const double margin = size > 0.0 && std::isfinite(size) ? 0.03 * size : 1.0;
  return { bounds[0] - margin, bounds[1] + margin, bounds[2] - margin, bounds[3] + margin };
}

void DrawPair(const MeshPair& pair, const PairReport& report, const OutputFile& file)
{
  constexpr double panel = 620.0;
  constexpr double gap = 10.0;
  constexpr double title = 34.0;
  constexpr double legend = 34.0;
  std::array<vtkSmartPointer<vtkPolyData>, 2> meshes;
  std::array<std::array<double, 4>, 2> bounds;
  double tallest = 0.0;
  for (std::size_t side = 0; side < 2; ++side)
  {
    meshes[side] = Flatten(pair.Meshes[side]);
    bounds[side] = BoundsOf(meshes[side]);
    tallest =
      std::max(tallest, (bounds[side][3] - bounds[side][2]) / (bounds[side][1] - bounds[side][0]));
  }
  const double height = panel * std::clamp(tallest, 0.3, 2.0);
  const double width = 2.0 * panel + 3.0 * gap;
  Canvas canvas(width, title + height + legend, file);
  canvas.FillPage(white);
  for (std::size_t side = 0; side < 2; ++side)
  {
    const Area area{ gap + static_cast<double>(side) * (panel + gap), title, panel, height };
    canvas.Write(side == 0 ? "Source" : "Target", area.Left + 0.5 * panel, title - 12.0, 17.0);
    canvas.Enter(area, bounds[side]);
    vtkPolyData* mesh = meshes[side];
    canvas.FillCells(
      mesh, [&](vtkIdType cell) { return Contains(report.Meshes[side].DiscordantTriangles, cell); },
      discordantColor);
    canvas.DrawEdges(mesh, edgeColor, 0.7);
    canvas.FillCells(
      mesh, [&](vtkIdType cell) { return Contains(report.InvalidTriangles, cell); }, invalidColor);
    for (const vtkIdType point : report.Meshes[side].FirstDuplicates)
    {
      double p[3];
      mesh->GetPoint(point, p);
      canvas.DrawDot(p[0], p[1], 4.0, duplicateColor);
    }
    canvas.Leave();
    canvas.DrawFrame(area, frameColor);
  }
  const std::pair<const char*, Color> entries[] = { { "invalid", invalidColor },
    { "discordant (no Contour there)", discordantColor }, { "duplicate points", duplicateColor } };
  double x = gap + 8.0;
  for (const auto& entry : entries)
  {
    canvas.DrawDot(x, title + height + 18.0, 6.0, entry.second);
    canvas.Write(entry.first, x + 12.0, title + height + 23.0, 14.0, false);
    x += 30.0 + 8.0 * static_cast<double>(std::string(entry.first).size());
  }
  canvas.Finish();
}

} // namespace dhm
