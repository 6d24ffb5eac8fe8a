// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MeshPair.h"

#include "Console.h"
#include "DataFile.h"
#include "Failure.h"
#include "InputFile.h"
#include "OutputFile.h"
#include "TriangulationFile.h"
#include "XmorphMesh.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <fstream>
#include <map>
#include <utility>

namespace dhm
{
namespace
{

/// Throws what @a read throws as a Failure that a file is to blame for.
template <typename Read>
auto ReadXmorph(Read&& read)
{
  try
  {
    return read();
  }
  catch (const std::runtime_error& error)
  {
    throw Failure(FILE_TROUBLE, error.what());
  }
}

/// An unstructured grid's cells as polygons.
vtkSmartPointer<vtkPolyData> ToPolygons(vtkUnstructuredGrid* grid, const std::string& name)
{
  vtkNew<vtkCellArray> polygons;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const int type = grid->GetCellType(cell);
    if (type != VTK_TRIANGLE && type != VTK_QUAD && type != VTK_POLYGON)
    {
      throw Failure(FILE_TROUBLE,
        name + ": cell " + std::to_string(cell) + " is no polygon (type " + std::to_string(type) +
          "): a mesh consists of triangles only.");
    }
    polygons->InsertNextCell(grid->GetCell(cell));
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(grid->GetPoints());
  mesh->SetPolys(polygons);
  mesh->GetPointData()->ShallowCopy(grid->GetPointData());
  mesh->GetCellData()->ShallowCopy(grid->GetCellData());
  return mesh;
}

vtkSmartPointer<vtkPolyData> ReadMeshAsNamed(const InputFile& file)
{
  const std::string& format = file.GetFormat();
  if (!IsMesh(format) && format != "vtp" && format != "vtk" && format != "vtu")
  {
    throw Failure(WRONG_USAGE,
      "Cannot read " + file.GetName() +
        " as a mesh: the formats are .json (PROJ's triangulation files), .vtp, .vtk, .vtu, .obj, "
        ".off, .ply, .stl, and .mesh (xmorph).");
  }
  const vtkSmartPointer<vtkDataObject> data = ReadData(file);
  if (auto* mesh = vtkPolyData::SafeDownCast(data))
  {
    return mesh;
  }
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    return ToPolygons(grid, file.GetName());
  }
  throw Failure(FILE_TROUBLE,
    file.GetName() + " holds a " + data->GetClassName() + ", which is no mesh of triangles.");
}

const char* const formatOption = "--input-format";

vtkSmartPointer<vtkPolyData> ReadMesh(const InputFile& file)
{
  return ReadFrom(file, formatOption, [&file] { return ReadMeshAsNamed(file); });
}

XmorphMesh ReadXmorphMesh(const InputFile& file)
{
  std::ifstream text(file.GetPath());
  return ReadFrom(file, formatOption,
    [&] { return ReadXmorph([&] { return ::ReadXmorphMesh(text, file.GetName()); }); });
}

/// Of two meshes whose triangles have points of their own: makes those one that are in the same
/// place in both. (What is one in one mesh only must not be: it is not the same point.)
void JoinPoints(MeshPair& pair)
{
  if (pair.Source()->GetNumberOfPoints() != pair.Target()->GetNumberOfPoints() ||
    pair.Source()->GetNumberOfPolys() != pair.Target()->GetNumberOfPolys())
  {
    return;
  }
  std::map<std::array<double, 6>, vtkIdType> places;
  std::array<vtkSmartPointer<vtkPoints>, 2> points;
  for (auto& side : points)
  {
    side = vtkSmartPointer<vtkPoints>::New();
    side->SetDataTypeToDouble();
  }
  std::vector<vtkIdType> joined;
  for (vtkIdType i = 0; i < pair.Source()->GetNumberOfPoints(); ++i)
  {
    std::array<double, 6> place;
    pair.Source()->GetPoint(i, place.data());
    pair.Target()->GetPoint(i, place.data() + 3);
    const auto found = places.emplace(place, points[0]->GetNumberOfPoints());
    if (found.second)
    {
      points[0]->InsertNextPoint(place.data());
      points[1]->InsertNextPoint(place.data() + 3);
    }
    joined.push_back(found.first->second);
  }
  vtkNew<vtkCellArray> polygons;
  for (std::size_t i = 0; i + 2 < joined.size(); i += 3)
  {
    polygons->InsertNextCell(3, &joined[i]);
  }
  for (int side = 0; side < 2; ++side)
  {
    pair.Meshes[side]->Initialize();
    pair.Meshes[side]->SetPoints(points[side]);
    pair.Meshes[side]->SetPolys(polygons);
  }
}

MeshPair ReadTwoInOne(const std::string& fileName, const MeshPairOptions& options)
{
  const InputFile file(fileName, options.InputFormat);
  MeshPair pair;
  pair.Names = { file.GetName(), file.GetName() };
  if (file.GetFormat() == "json")
  {
    std::ifstream text(file.GetPath());
    TriangulationFile read =
      ReadFrom(file, formatOption, [&] { return ReadTriangulationFile(text, file.GetName()); });
    if (read.ShiftsHeights)
    {
      Warn(file.GetName() + " shifts heights, too: that is left alone.");
    }
    pair.Metadata = std::move(read.Metadata);
    pair.Meshes = read.Meshes;
    return pair;
  }
  pair.Meshes[0] = ReadMesh(file);
  vtkDataArray* positions = pair.Source()->GetPointData()->GetArray(options.TargetArray.c_str());
  if (!positions || positions->GetNumberOfComponents() < 2 ||
    positions->GetNumberOfComponents() > 3)
  {
    throw Failure(WRONG_USAGE,
      file.GetName() + " has no point array \"" + options.TargetArray +
        "\" of 2 or 3 components that would be the target's positions: give the target's file, "
        "too, or name the array (--target-array).");
  }
  vtkNew<vtkPoints> points;
  points->SetDataType(positions->GetDataType() == VTK_FLOAT ? VTK_FLOAT : VTK_DOUBLE);
  for (vtkIdType i = 0; i < positions->GetNumberOfTuples(); ++i)
  {
    double position[3] = { 0.0, 0.0, 0.0 };
    positions->GetTuple(i, position);
    points->InsertNextPoint(position);
  }
  pair.Meshes[1] = vtkSmartPointer<vtkPolyData>::New();
  pair.Meshes[1]->SetPoints(points);
  pair.Meshes[1]->SetPolys(pair.Source()->GetPolys());
  pair.Meshes[1]->SetVerts(pair.Source()->GetVerts());
  pair.Meshes[1]->SetLines(pair.Source()->GetLines());
  return pair;
}

MeshPair ReadAnyPair(const std::vector<std::string>& files, const MeshPairOptions& options)
{
  if (files.size() == 1)
  {
    return ReadTwoInOne(files[0], options);
  }
  const InputFile source(files[0], options.InputFormat);
  const InputFile target(files[1], options.InputFormat);
  MeshPair pair;
  pair.Names = { source.GetName(), target.GetName() };
  const bool xmorph[2] = { source.GetFormat() == "mesh", target.GetFormat() == "mesh" };
  if (xmorph[0] != xmorph[1])
  {
    throw Failure(WRONG_USAGE,
      "Either both files are meshes of xmorph (.mesh) or none: they are cut into triangles "
      "together.");
  }
  if (xmorph[0])
  {
    pair.FromXmorph = true;
    pair.Meshes = ReadXmorph([&] {
      std::array<XmorphMesh, 2> grids{ ReadXmorphMesh(source), ReadXmorphMesh(target) };
      for (std::size_t side = 0; side < 2; ++side)
      {
        auto& extent = pair.XmorphExtents[side];
        if (options.WorkingSize[0] > 0)
        {
          // Tenths of pixels.
          extent = { 10.0 * (options.WorkingSize[0] - 1), 10.0 * (options.WorkingSize[1] - 1) };
        }
        else if (FillsPicture(grids[side]))
        {
          extent = GetExtent(grids[side]);
        }
        TurnUpright(grids[side], extent[1] > 0.0 ? extent[1] : GetExtent(grids[side])[1]);
      }
      return CutIntoTriangles(grids[0], grids[1]);
    });
    return pair;
  }
  for (const InputFile* file : { &source, &target })
  {
    if (file->GetFormat() == "json")
    {
      throw Failure(WRONG_USAGE,
        file->GetName() +
          " is a triangulation file, which has both source and target: give it alone.");
    }
  }
  pair.Meshes = { ReadMesh(source), ReadMesh(target) };
  if (source.GetFormat() == "stl" && target.GetFormat() == "stl")
  {
    JoinPoints(pair);
  }
  return pair;
}

/// A file without triangles, such as one of points, was hardly meant.
void RequireTriangles(vtkPolyData* mesh, const std::string& name)
{
  if (mesh->GetNumberOfPolys() == 0 && mesh->GetNumberOfStrips() == 0)
  {
    throw Failure(FILE_TROUBLE, name + " has no triangles: it is no mesh.");
  }
}

} // namespace

MeshPair ReadMeshPair(const std::vector<std::string>& files, const MeshPairOptions& options)
{
  MeshPair pair = ReadAnyPair(files, options);
  for (std::size_t side = 0; side < 2; ++side)
  {
    RequireTriangles(pair.Meshes[side], pair.Names[side]);
  }
  return pair;
}

vtkSmartPointer<vtkPolyData> ReadMesh(const std::string& fileName, const std::string& inputFormat)
{
  const InputFile file(fileName, inputFormat);
  if (file.GetFormat() == "json")
  {
    return ReadTwoInOne(fileName, {}).Meshes[0];
  }
  if (file.GetFormat() == "mesh")
  {
    return ReadXmorph([&] {
      XmorphMesh mesh = ReadXmorphMesh(file);
      TurnUpright(mesh, GetExtent(mesh)[1]);
      return CutIntoTriangles(mesh, mesh)[0];
    });
  }
  auto mesh = ReadMesh(file);
  RequireTriangles(mesh, file.GetName());
  return mesh;
}

void FitToPictures(
  MeshPair& pair, const std::array<int, 2>& sourceSize, const std::array<int, 2>& targetSize)
{
  if (!pair.FromXmorph)
  {
    return;
  }
  for (int side = 0; side < 2; ++side)
  {
    const auto& size = side == 0 ? sourceSize : targetSize;
    const auto& extent = pair.XmorphExtents[static_cast<std::size_t>(side)];
    if (!(extent[0] > 0.0 && extent[1] > 0.0))
    {
      throw Failure(WRONG_USAGE,
        pair.Names[static_cast<std::size_t>(side)] +
          " does not fill its picture, and does not say how large that is: give the size of "
          "xmorph's working picture (--working-size; in a session's file, resulting_size).");
    }
    // Xmorph's units end at the last pixel.
    const double factors[2] = { (size[0] - 1) / extent[0], (size[1] - 1) / extent[1] };
    vtkPoints* points = pair.Meshes[side]->GetPoints();
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
    {
      double point[3];
      points->GetPoint(i, point);
      points->SetPoint(i, point[0] * factors[0], point[1] * factors[1], point[2]);
    }
    points->Modified();
  }
}

void CheckPairFormat(const std::string& format)
{
  if (format != "json" && format != "vtp" && format != "vtk")
  {
    throw Failure(WRONG_USAGE,
      CannotWrite("a pair", format) +
        ": the formats are .json, .vtp and .vtk; with the target in a file of its own "
        "(--target-output of dhm convert) .vtp, .vtk, .obj and .off.");
  }
}

void WritePair(const MeshPair& pair, const std::string& targetArray, const OutputFile& file)
{
  CheckPairFormat(file.GetFormat());
  if (file.GetFormat() == "json")
  {
    for (int side = 0; side < 2; ++side)
    {
      double bounds[6];
      pair.Meshes[side]->GetBounds(bounds);
      if (bounds[4] != 0.0 || bounds[5] != 0.0)
      {
        throw Failure(REFUSED,
          "A triangulation file (.json) holds x and y only, but z is not 0 everywhere in " +
            pair.Names[side] + ".");
      }
    }
    file.Write([&pair](std::ostream& text) {
      WriteTriangulationFile(pair.Metadata, pair.Source(), pair.Target(), text);
    });
    return;
  }
  vtkNew<vtkPolyData> both;
  both->ShallowCopy(pair.Source());
  vtkNew<vtkDoubleArray> positions;
  positions->DeepCopy(pair.Target()->GetPoints()->GetData());
  positions->SetName(targetArray.c_str());
  both->GetPointData()->AddArray(positions);
  WriteMesh(both, file);
}

void WriteMesh(vtkPolyData* mesh, const OutputFile& file)
{
  const std::string& format = file.GetFormat();
  if (format != "vtp" && format != "vtk" && format != "obj" && format != "off")
  {
    throw Failure(
      WRONG_USAGE, CannotWrite("a mesh", format) + ": the formats are .vtp, .vtk, .obj and .off.");
  }
  WriteData(mesh, file);
}

} // namespace dhm
