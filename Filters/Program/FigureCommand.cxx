// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Canvas.h"
#include "Command.h"
#include "DataFile.h"
#include "Failure.h"
#include "ImageWarp.h"
#include "InputFile.h"
#include "MeshParts.h"
#include "Numbers.h"
#include "OutputFile.h"
#include "PairPicture.h"
#include "PairReport.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkTriangularCoordinates.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

namespace dhm
{
namespace
{

struct Options
{
  InputFiles Inputs;
  OutputOptions Output;
  MapOptions Map;
  bool AllSystems = false;
  int GridLines = 16;
  bool Contours = false;
  std::string Image;
  std::string CloseUp;
  double Width = 420.0;
};

/// A panel: a mesh, what is drawn over it, and what lies under it.
struct Panel
{
  std::string Title;
  vtkSmartPointer<vtkPolyData> Mesh;
  vtkSmartPointer<vtkPolyData> Lines;
  vtkSmartPointer<vtkImageData> Image;
  std::array<double, 4> Bounds;
  std::array<double, 4> CloseUp;
};

/// Of how many straight pieces a grid line consists.
constexpr int pieces = 2000;

/// Lines across a box, as rows of points.
void MakeGridLines(const std::array<double, 4>& box, int count, vtkPoints* points)
{
  points->SetDataTypeToDouble();
  const double width = box[1] - box[0];
  const double height = box[3] - box[2];
  // Squares: as many lines across the longer side as asked for.
  const double spacing = std::max(width, height) / count;
  for (int direction = 0; direction < 2; ++direction)
  {
    const int lines = static_cast<int>((direction == 0 ? width : height) / spacing);
    const double first = 0.5 * ((direction == 0 ? width : height) - lines * spacing);
    for (int line = 0; line <= lines; ++line)
    {
      const double across = first + line * spacing;
      for (int k = 0; k <= pieces; ++k)
      {
        const double along = static_cast<double>(k) / pieces;
        points->InsertNextPoint(box[0] + (direction == 0 ? across : along * width),
          box[2] + (direction == 0 ? along * height : across), 0.0);
      }
    }
  }
}

/// The grid's lines with the points where they are, interrupted where the mask says so.
vtkSmartPointer<vtkPolyData> Connect(vtkPoints* points, vtkDataArray* mask)
{
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIdList> piece;
  const auto end = [&] {
    if (piece->GetNumberOfIds() > 1)
    {
      lines->InsertNextCell(piece);
    }
    piece->Reset();
  };
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    if (i % (pieces + 1) == 0)
    {
      end();
    }
    if (mask->GetTuple1(i) == 0.0)
    {
      end();
    }
    else
    {
      piece->InsertNextId(i);
    }
  }
  end();
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(points);
  result->SetLines(lines);
  return result;
}

/// The map of points, and which of them are inside.
vtkSmartPointer<vtkPolyData> MapPoints(
  const MeshPair& pair, const MapOptions& options, vtkPoints* points, bool inverse)
{
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  vtkNew<vtkDifferentiableHomeomorphism> map;
  options.ApplyTo(map.Get());
  map->SetSourceData(pair.Source());
  map->SetTargetData(pair.Target());
  map->SetDataObject(data);
  map->SetInverse(inverse);
  map->BlankOutsideOff();
  Run(map, "Mapping");
  return vtkPolyData::SafeDownCast(map->GetOutputDataObject(0));
}

vtkSmartPointer<vtkPolyData> CoordinateLines(vtkPolyData* mesh, const MapOptions& options)
{
  vtkNew<vtkTriangularCoordinates> coordinates;
  options.ApplyTo(coordinates.Get());
  coordinates->SetInputDataObject(0, mesh);
  Run(coordinates, "Drawing coordinates");
  return coordinates->GetLines();
}

/// Center and half the side of a square, from "X,Y,R"; nothing from an empty text.
std::vector<double> ReadCloseUp(const std::string& text)
{
  std::vector<double> values;
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, ',');)
  {
    const auto value = ToNumber(word);
    if (!value || !std::isfinite(*value))
    {
      values.clear();
      break;
    }
    values.push_back(*value);
  }
  if (!text.empty() && (values.size() != 3 || !(values[2] > 0.0)))
  {
    throw Failure(
      WRONG_USAGE, "A close-up is X,Y,R: center and half the side of a square in the target.");
  }
  return values;
}

std::array<double, 4> SquareAround(double x, double y, double r)
{
  return { x - r, x + r, y - r, y + r };
}

/// From 0 to 1, of the color components of all pixels.
double MeanBrightness(vtkImageData* image)
{
  vtkDataArray* pixels = image->GetPointData()->GetScalars();
  const int colors = pixels->GetNumberOfComponents() >= 3 ? 3 : 1;
  double sum = 0.0;
  for (vtkIdType i = 0; i < pixels->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < colors; ++k)
    {
      sum += pixels->GetComponent(i, k);
    }
  }
  return sum / (Brightest(pixels) * colors * static_cast<double>(pixels->GetNumberOfTuples()));
}

void Draw(const std::vector<Panel>& panels, bool closeUps, double width, const OutputFile& file)
{
  constexpr double gap = 6.0;
  constexpr double title = 30.0;
  // What stands out from what lies below.
  const bool onDark = panels.front().Image && MeanBrightness(panels.front().Image) < 0.5;
  const Color lineColor = onDark ? Color{ 1.0, 0.85, 0.1, 1.0 } : Color{ 0.75, 0.1, 0.15, 1.0 };
  const Color meshColor = onDark ? Color{ 0.1, 0.2, 0.6, 0.5 } : Color{ 0.2, 0.3, 0.45, 0.45 };
  double tallest = 0.0;
  for (const Panel& panel : panels)
  {
    tallest =
      std::max(tallest, (panel.Bounds[3] - panel.Bounds[2]) / (panel.Bounds[1] - panel.Bounds[0]));
  }
  const double height = width * std::clamp(tallest, 0.2, 3.0);
  const auto count = static_cast<double>(panels.size());
  Canvas canvas(
    count * (width + gap) + gap, title + height + gap + (closeUps ? width + gap : 0.0), file);
  canvas.FillPage({ 1.0, 1.0, 1.0, 1.0 });
  for (std::size_t i = 0; i < panels.size(); ++i)
  {
    const Panel& panel = panels[i];
    const Area area{ gap + static_cast<double>(i) * (width + gap), title, width, height };
    canvas.Write(panel.Title, area.Left + 0.5 * width, title - 10.0, 16.0);
    for (int row = 0; row < (closeUps ? 2 : 1); ++row)
    {
      const Area place = row == 0 ? area : Area{ area.Left, title + height + gap, width, width };
      const double lineWidth = row == 0 ? 1.0 : 2.0;
      canvas.Enter(place, row == 0 ? panel.Bounds : panel.CloseUp);
      if (panel.Image)
      {
        canvas.DrawImage(panel.Image);
      }
      canvas.DrawEdges(panel.Mesh, meshColor, 0.7 * lineWidth);
      canvas.DrawLines(panel.Lines, lineColor, lineWidth);
      canvas.Leave();
      canvas.DrawFrame(place, { 0.8, 0.8, 0.8, 1.0 });
    }
  }
  canvas.Finish();
}

void MakeFigure(const Options& options)
{
  const std::vector<double> closeUp = ReadCloseUp(options.CloseUp);
  OutputFile output(options.Output.Name, options.Output.Format, options.Output.Replace);
  if (!Canvas::IsFormat(output.GetFormat()))
  {
    throw Failure(WRONG_USAGE, "Figures are .png, .svg or .pdf: " + output.GetName() + " is none.");
  }
  MeshPair pair = options.Inputs.ReadPair(0);
  RequireMap(pair, options.Map);
  vtkSmartPointer<vtkImageData> image;
  if (!options.Image.empty())
  {
    image = ReadImage(InputFile(options.Image, "png"));
    const std::array<int, 2> size{ image->GetDimensions()[0], image->GetDimensions()[1] };
    FitToPictures(pair, size, size);
    RequireOverlap(image, options.Image, pair.Source(), pair.GetNameOf(0));
  }
  for (vtkPolyData* mesh : { pair.Source(), pair.Target() })
  {
    if (!IsFlat(mesh))
    {
      throw Failure(REFUSED, "Figures are drawn of meshes in planes parallel to x and y only.");
    }
  }

  double bounds[6];
  pair.Source()->GetBounds(bounds);
  vtkNew<vtkPoints> grid;
  MakeGridLines({ bounds[0], bounds[1], bounds[2], bounds[3] }, options.GridLines, grid);
  std::vector<Panel> panels(1);
  for (int system = 0; system < 3; ++system)
  {
    if (!options.AllSystems && system != options.Map.System)
    {
      continue;
    }
    MapOptions map = options.Map;
    map.System = system;
    // Of all three, Contour's gaps are not what is to be seen.
    map.LinearWhereDiscordant = map.LinearWhereDiscordant || options.AllSystems;
    Panel panel;
    panel.Title = SystemNames[system];
    panel.Mesh = pair.Target();
    panel.Bounds = BoundsOf(pair.Target());
    const auto carried = MapPoints(pair, map, grid, false);
    vtkDataArray* mask = carried->GetPointData()->GetArray("vtkValidPointMask");
    panel.Lines =
      options.Contours ? CoordinateLines(pair.Target(), map) : Connect(carried->GetPoints(), mask);
    if (!closeUp.empty())
    {
      panel.CloseUp = SquareAround(closeUp[0], closeUp[1], closeUp[2]);
    }
    if (image)
    {
      // Three pixels for one, so that close-ups show lines, not pixels.
      auto pixels = vtkSmartPointer<vtkImageData>::New();
      const int* size = image->GetDimensions();
      pixels->SetDimensions(3 * size[0] - 2, 3 * size[1] - 2, 1);
      pixels->SetOrigin(image->GetOrigin());
      pixels->SetSpacing(image->GetSpacing()[0] / 3.0, image->GetSpacing()[1] / 3.0, 1.0);
      panel.Image =
        Finish(WarpImage(image, pair.Source(), pair.Target(), pixels, false, map, "Warping"),
          Background());
    }
    panels.push_back(panel);
    if (!panels[0].Mesh)
    {
      Panel& source = panels[0];
      source.Title = "Source";
      source.Mesh = pair.Source();
      source.Bounds = BoundsOf(pair.Source());
      source.Lines = options.Contours ? CoordinateLines(pair.Source(), map) : Connect(grid, mask);
      source.Image = image;
    }
    if (!closeUp.empty() && panels.size() == 2)
    {
      // The same place in the source.
      vtkNew<vtkPoints> center;
      center->SetDataTypeToDouble();
      center->InsertNextPoint(closeUp[0], closeUp[1], 0.0);
      double place[3];
      MapPoints(pair, map, center, true)->GetPoint(0, place);
      panels[0].CloseUp = SquareAround(place[0], place[1], closeUp[2]);
    }
  }
  Draw(panels, !closeUp.empty(), options.Width, output);
  output.Commit();
}

} // namespace

void AddFigure(CLI::App& program)
{
  CLI::App* command = program.add_subcommand(
    "figure", "Draw a grid, or the contours, on the source and carried onto the target");
  const auto options = std::make_shared<Options>();
  options->Inputs.AddTo(*command, "SOURCE [TARGET]", 0, "The pair, in a plane");
  options->Output.AddTo(*command, "The figure: .png .svg .pdf, or - for standard output", "png");
  options->Map.AddTo(*command);
  command->add_flag("--all-systems", options->AllSystems, "One panel for each of the three systems")
    ->group("Map");
  command
    ->add_option("--grid", options->GridLines,
      "Number of grid lines along the longer side, less one (default: 16)")
    ->check(NumberFrom(1, 500))
    ->type_name("NUMBER")
    ->group("Results");
  command
    ->add_flag("--contours", options->Contours,
      "Draw each mesh's own triangular coordinates (contours and rings) instead of a grid")
    ->group("Results");
  command
    ->add_option("--image", options->Image, "Image over the source, to be drawn and warped below")
    ->type_name("FILE")
    ->group("Results");
  command
    ->add_option("--close-up", options->CloseUp,
      "Add close-ups: center and half the side of a square in the target")
    ->type_name("X,Y,R")
    ->group("Results");
  command->add_option("--width", options->Width, "Width of a panel in pixels (default: 420)")
    ->check(NumberFrom(50, 5000))
    ->type_name("NUMBER")
    ->group("Results");
  command->callback([options] { MakeFigure(*options); });
}

} // namespace dhm
