// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Carries a photograph, a regular grid and a set of parallel lines onto the mesh of another
// photograph, with each of the three coordinate systems: mapped data as VTK files, one picture, one
// table.
//
//   CarryFaces [--generated] [OUTPUT_FOLDER]
//
// The photographs and their meshes are those of Debian's package gtkmorph-example. With
// --generated, a test chart and a random pair of meshes take their place.

#include "Measure.h"
#include "Picture.h"
#include "XmorphMesh.h"

#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkDifferentiableHomeomorphism.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkImageData.h"
#include "vtkImageReslice.h"
#include "vtkNew.h"
#include "vtkPNGReader.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkXMLImageDataWriter.h"
#include "vtkXMLPolyDataWriter.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>

namespace
{

const std::string photographs = "/usr/share/xmorph/example/AD/";
const std::array<std::string, 3> systemNames{ "Linear", "Contour", "Smooth" };

/// What is carried, and where.
struct Task
{
  vtkSmartPointer<vtkImageData> SourceImage;
  /// What lies under the target mesh, if anything.
  vtkSmartPointer<vtkImageData> TargetImage;
  std::array<int, 2> TargetSize;
  vtkSmartPointer<vtkPolyData> Source;
  vtkSmartPointer<vtkPolyData> Target;
  /// Of the close-ups, in the target.
  std::array<double, 3> CloseUp;
  std::array<double, 3> MeshColor;
  std::array<double, 3> LineColor;
};

vtkSmartPointer<vtkImageData> ReadPhotograph(const std::string& fileName)
{
  if (!std::filesystem::exists(fileName))
  {
    throw std::runtime_error(
      fileName + " is not there: install Debian's package gtkmorph-example, or use --generated.");
  }
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(fileName.c_str());
  reader->Update();
  // Pixels count from (0, 0), whatever resolution the file claims.
  reader->GetOutput()->SetSpacing(1.0, 1.0, 1.0);
  reader->GetOutput()->SetOrigin(0.0, 0.0, 0.0);
  return reader->GetOutput();
}

Task MakeFaces()
{
  Task task;
  task.SourceImage = ReadPhotograph(photographs + "image1.png");
  task.TargetImage = ReadPhotograph(photographs + "image2.png");
  int size[3];
  task.SourceImage->GetDimensions(size);
  XmorphMesh first = ReadXmorphMesh(photographs + "image1.png.mesh");
  FitToPicture(first, size[0], size[1]);
  task.TargetImage->GetDimensions(size);
  XmorphMesh second = ReadXmorphMesh(photographs + "image2.png.mesh");
  FitToPicture(second, size[0], size[1]);
  const auto meshes = CutIntoTriangles(first, second);
  task.Source = meshes[0];
  task.Target = meshes[1];
  task.TargetSize = { size[0], size[1] };
  task.CloseUp = { 127.0, 143.0, 24.0 };
  task.MeshColor = { 0.1, 0.2, 0.6 };
  task.LineColor = { 1.0, 0.85, 0.1 };
  return task;
}

/// Rings and squares in pale colours.
vtkSmartPointer<vtkImageData> MakeChart(int width, int height)
{
  auto chart = vtkSmartPointer<vtkImageData>::New();
  chart->SetDimensions(width, height, 1);
  chart->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      auto* pixel = static_cast<unsigned char*>(chart->GetScalarPointer(x, y, 0));
      const double u = (x - 0.5 * width) / width;
      const double v = (y - 0.5 * height) / width;
      const double ring = 0.5 + 0.5 * std::cos(50.0 * std::hypot(u, v));
      const bool square = ((x * 10 / width) + (y * 10 / width)) % 2 == 0;
      const double shade = square ? 0.96 : 1.0;
      pixel[0] = static_cast<unsigned char>(shade * (250.0 - 75.0 * ring));
      pixel[1] = static_cast<unsigned char>(shade * (247.0 - 37.0 * ring));
      pixel[2] = static_cast<unsigned char>(shade * (238.0 - 18.0 * ring));
    }
  }
  return chart;
}

Task MakeGenerated()
{
  constexpr int cells = 6;
  constexpr int size = 360;
  std::mt19937_64 generator(12);
  std::uniform_real_distribution<double> offset(-0.3, 0.3);
  std::array<XmorphMesh, 2> meshes;
  for (XmorphMesh& mesh : meshes)
  {
    mesh.Columns = mesh.Rows = cells + 1;
    for (int row = 0; row <= cells; ++row)
    {
      for (int column = 0; column <= cells; ++column)
      {
        const bool insideRow = row > 0 && row < cells;
        const bool insideColumn = column > 0 && column < cells;
        mesh.Points.push_back({ column + (insideColumn ? offset(generator) : 0.0),
          row + (insideRow ? offset(generator) : 0.0) });
      }
    }
    FitToPicture(mesh, size, size);
  }
  Task task;
  const auto triangulated = CutIntoTriangles(meshes[0], meshes[1]);
  task.SourceImage = MakeChart(size, size);
  task.TargetSize = { size, size };
  task.Source = triangulated[0];
  task.Target = triangulated[1];
  task.CloseUp = { 175.0, 185.0, 62.0 };
  task.MeshColor = { 0.2, 0.3, 0.45 };
  task.LineColor = { 0.75, 0.1, 0.15 };
  return task;
}

/// Straight lines across the mesh's bounding box, finely divided: @a count across x, and as many
/// across y if it is to be a grid.
vtkSmartPointer<vtkPolyData> MakeLines(vtkPolyData* mesh, int count, bool grid)
{
  constexpr int pieces = 2000;
  double bounds[6];
  mesh->GetBounds(bounds);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  for (int direction = 0; direction < (grid ? 2 : 1); ++direction)
  {
    for (int i = 0; i <= count; ++i)
    {
      lines->InsertNextCell(pieces + 1);
      for (int k = 0; k <= pieces; ++k)
      {
        const double across = static_cast<double>(i) / count;
        const double along = static_cast<double>(k) / pieces;
        const double x = direction == 0 ? across : along;
        const double y = direction == 0 ? along : across;
        lines->InsertCellPoint(points->InsertNextPoint(
          bounds[0] + x * (bounds[1] - bounds[0]), bounds[2] + y * (bounds[3] - bounds[2]), 0.0));
      }
    }
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(points);
  result->SetLines(lines);
  return result;
}

/// The lines, carried from the source's domain to the target's.
vtkSmartPointer<vtkPolyData> CarryLines(const Task& task, vtkPolyData* lines, int coordinateSystem)
{
  vtkNew<vtkDifferentiableHomeomorphism> map;
  map->SetSourceData(task.Source);
  map->SetTargetData(task.Target);
  map->SetDataObject(lines);
  map->SetCoordinateSystem(coordinateSystem);
  map->SetDiscordantTriangles(vtkDifferentiableHomeomorphism::CARRY_BY_LINEAR);
  map->ComputeJacobianDeterminantOn();
  map->Update();
  return vtkPolyData::SafeDownCast(map->GetOutputDataObject(0));
}

/// The image, carried onto the target's grid of pixels.
vtkSmartPointer<vtkImageData> CarryImage(const Task& task, int coordinateSystem, int refinement)
{
  vtkNew<vtkHomeomorphismTransform> map;
  map->SetSource(task.Source);
  map->SetTarget(task.Target);
  map->SetCoordinateSystem(coordinateSystem);
  map->SetDiscordantTriangles(vtkHomeomorphismTransform::CARRY_BY_LINEAR);
  vtkNew<vtkImageReslice> reslice;
  reslice->SetInputData(task.SourceImage);
  // The transform of a reslice leads from the output's grid to the input.
  reslice->SetResliceTransform(map->GetInverse());
  reslice->SetInterpolationModeToCubic();
  reslice->SetOutputOrigin(0.0, 0.0, 0.0);
  reslice->SetOutputSpacing(1.0 / refinement, 1.0 / refinement, 1.0);
  reslice->SetOutputExtent(
    0, refinement * (task.TargetSize[0] - 1), 0, refinement * (task.TargetSize[1] - 1), 0, 0);
  reslice->SetBackgroundColor(255.0, 255.0, 255.0, 255.0);
  reslice->Update();
  return reslice->GetOutput();
}

template <typename Writer>
void Write(vtkDataObject* data, const std::string& fileName)
{
  vtkNew<Writer> writer;
  writer->SetInputDataObject(data);
  writer->SetFileName(fileName.c_str());
  // VTK before 9.4 cannot read data at a file's end with every version of expat.
  writer->SetDataModeToBinary();
  if (!writer->Write())
  {
    throw std::runtime_error("Cannot write " + fileName + ".");
  }
  std::cout << "wrote " << fileName << std::endl;
}

void Run(const Task& task, const std::string& folder)
{
  std::filesystem::create_directories(folder);
  constexpr int refinement = 3;
  const auto grid = MakeLines(task.Source, 14, true);
  const auto parallelLines = MakeLines(task.Source, 48, false);

  std::cout << "The meshes have " << task.Source->GetNumberOfPoints() << " points and "
            << task.Source->GetNumberOfCells() << " triangles." << std::endl;
  Write<vtkXMLPolyDataWriter>(task.Source, folder + "/source-mesh.vtp");
  Write<vtkXMLPolyDataWriter>(task.Target, folder + "/target-mesh.vtp");

  std::vector<Panel> panels;
  // The source's close-up shows the same place, found by the map itself.
  vtkNew<vtkHomeomorphismTransform> map;
  map->SetSource(task.Source);
  map->SetTarget(task.Target);
  const double center[3] = { task.CloseUp[0], task.CloseUp[1], 0.0 };
  double sourceCenter[3];
  map->GetInverse()->TransformPoint(center, sourceCenter);
  panels.push_back({ "Source", task.SourceImage, task.Source, grid, task.MeshColor, task.LineColor,
    { sourceCenter[0], sourceCenter[1], task.CloseUp[2] } });

  std::array<Measurements, 3> measurements;
  for (int system = 0; system < 3; ++system)
  {
    std::cout << systemNames[system] << " ..." << std::endl;
    const std::string prefix = folder + "/" + systemNames[system];
    const auto image = CarryImage(task, system, refinement);
    const auto carriedGrid = CarryLines(task, grid, system);
    Write<vtkXMLImageDataWriter>(image, prefix + "-image.vti");
    Write<vtkXMLPolyDataWriter>(carriedGrid, prefix + "-grid.vtp");
    Write<vtkXMLPolyDataWriter>(
      CarryLines(task, parallelLines, system), prefix + "-parallel-lines.vtp");
    panels.push_back({ systemNames[system], image, task.Target, carriedGrid, task.MeshColor,
      task.LineColor, task.CloseUp });
    measurements[system] = Measure(task.Source, task.Target, system);
  }
  if (task.TargetImage)
  {
    panels.push_back({ "Target", task.TargetImage, task.Target, vtkSmartPointer<vtkPolyData>::New(),
      task.MeshColor, task.LineColor, task.CloseUp });
  }
  WritePicture(panels, folder + "/three-systems.png");
  std::cout << "wrote " << folder << "/three-systems.png\n" << std::endl;

  std::printf("%-28s %12s %12s %12s\n", "", systemNames[0].c_str(), systemNames[1].c_str(),
    systemNames[2].c_str());
  const auto row = [&measurements](const char* name, const char* format, auto member) {
    std::printf("%-28s", name);
    for (const Measurements& m : measurements)
    {
      std::printf(format, m.*member);
    }
    std::printf("\n");
  };
  row("triangles refused (1)", " %12lld", &Measurements::TrianglesRefused);
  row("points mapped", " %12lld", &Measurements::PointsMapped);
  row("points outside", " %12lld", &Measurements::PointsOutside);
  row("smallest det J", " %12.4f", &Measurements::SmallestDeterminant);
  row("largest jump of J (2)", " %12.2g", &Measurements::LargestJump);
  row("round-trip error, pixels", " %12.2g", &Measurements::RoundTripError);
  row("time per point, ns (3)", " %12.0f", &Measurements::NanosecondsPerPoint);
  std::printf("\n(1) discordant in source or target: carried by Linear instead\n"
              "(2) across edges, relative to the norm of J; 0 where the map is differentiable\n"
              "(3) a million points row by row on all processors, median of 5; it varies\n");
}

} // namespace

int main(int argc, char* argv[])
{
  bool generated = false;
  std::string folder = "Output";
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (argument == "--generated")
    {
      generated = true;
    }
    else if (!argument.empty() && argument[0] != '-')
    {
      folder = argument;
    }
    else
    {
      std::cerr << "Usage: CarryFaces [--generated] [OUTPUT_FOLDER]\n";
      return EXIT_FAILURE;
    }
  }
  try
  {
    Run(generated ? MakeGenerated() : MakeFaces(), folder);
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
