// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Command.h"
#include "Console.h"
#include "DataFile.h"
#include "Failure.h"
#include "InputFile.h"
#include "OutputFile.h"
#include "PointTable.h"

#include "vtkDataSet.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkTriangularCoordinates.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>

namespace dhm
{
namespace
{

/// Of points whose coordinates are no finite numbers, how many there are; empty if there are none.
std::string DescribeNowhere(vtkDataObject* data)
{
  auto* set = vtkPointSet::SafeDownCast(data);
  vtkIdType count = 0;
  vtkIdType first = -1;
  for (vtkIdType i = 0; set && i < set->GetNumberOfPoints(); ++i)
  {
    double point[3];
    set->GetPoint(i, point);
    if (!std::all_of(point, point + 3, [](double x) { return std::isfinite(x); }))
    {
      ++count;
      first = first < 0 ? i : first;
    }
  }
  return count == 0 ? std::string()
                    : " (of " + std::to_string(count) +
      ", the coordinates are no finite numbers; the first is point " + std::to_string(first) +
      ", counted from 0)";
}

/// What `map` and `coordinates` have in common: data in, the same data with moved points or more
/// arrays out.
struct DataOptions
{
  OutputOptions Output;
  std::string Columns;
  std::string DataFormat = "csv";
  bool RequireInside = false;
  /// Whether points go elsewhere: images do not stay images, and points outside are nowhere.
  bool MovesPoints = false;

  void AddTo(CLI::App& command)
  {
    this->Output.AddTo(command,
      "Where the result goes: a file of the data's kind (images become .vts), or - for standard "
      "output",
      "csv");
    command
      .add_option("--columns", this->Columns,
        "Names or numbers (from 1) of the coordinate columns of a point table, separated by commas "
        "(default: those with usual names, such as x,y,z, or E,N, or lon,lat; of a table without "
        "names, the first two)")
      ->type_name("LIST")
      ->group("Files");
    command
      .add_option("--data-format", this->DataFormat,
        "What the data is if it comes from standard input, as an extension (default: csv)")
      ->type_name("EXTENSION")
      ->group("Files");
    command
      .add_flag("--require-inside", this->RequireInside,
        "Write nothing and fail (status 1) if a point is outside the domain")
      ->group("Files");
  }

  /// Reads the data, lets @a work make other data of it, and writes that. @a work returns the
  /// number of points outside.
  void Process(const std::string& dataName,
    const std::function<vtkIdType(vtkDataObject* data, vtkSmartPointer<vtkDataObject>& result)>&
      work) const
  {
    OutputFile output(this->Output.Name, this->Output.Format, this->Output.Replace);
    const InputFile file(dataName, this->DataFormat);
    std::unique_ptr<PointTable> table;
    vtkSmartPointer<vtkDataObject> data;
    ReadFrom(file, "--data-format", [&] {
      if (PointTable::IsFormat(file.GetFormat()))
      {
        std::ifstream text(file.GetPath(), std::ios::binary);
        table = std::make_unique<PointTable>(text, file.GetName(), this->Columns);
        data = table->ToPoints();
      }
      else
      {
        data = ReadData(file, ".csv, .txt and .xyz (points)");
      }
    });
    const bool asTable = PointTable::IsFormat(output.GetFormat());
    if (asTable && !table)
    {
      throw Failure(WRONG_USAGE,
        "Only points that came from a table can be written as one (." + output.GetFormat() +
          "), but " + file.GetName() + " holds a " + data->GetClassName() + ".");
    }
    if (!asTable)
    {
      CheckOutputFormat(output.GetFormat(), ".csv and .txt (if the data came from such a file)");
    }
    if (IsMesh(output.GetFormat()) && !this->MovesPoints)
    {
      throw Failure(WRONG_USAGE,
        "Coordinates are arrays of points, which a ." + output.GetFormat() +
          " file does not have: write a .vtp.");
    }
    if (IsPicture(output.GetFormat()) && this->MovesPoints)
    {
      throw Failure(WRONG_USAGE,
        "Points that have moved are no picture (." + output.GetFormat() +
          "): of images, write a .vts, or use dhm warp.");
    }

    if (table && !asTable)
    {
      table->AddColumnsTo(vtkPolyData::SafeDownCast(data));
    }

    vtkSmartPointer<vtkDataObject> result;
    const vtkIdType outside = work(data, result);
    if (outside > 0)
    {
      const std::string message =
        Count(outside, "point", "is", "are") + " outside the domain" + DescribeNowhere(data);
      if (this->RequireInside)
      {
        throw Failure(REFUSED, message + ".");
      }
      Warn(message + ": marked 0 in vtkValidPointMask.");
    }
    if (asTable)
    {
      table->Update(vtkDataSet::SafeDownCast(result), this->MovesPoints);
      output.Write([&table](std::ostream& text) { table->Write(text); });
    }
    else
    {
      WriteData(result, output);
    }
    output.Commit();
  }
};

} // namespace

void AddMap(CLI::App& program)
{
  struct Options
  {
    InputFiles Inputs;
    MapOptions Map;
    DataOptions Data;
    bool Inverse = false;
    bool Jacobian = false;
    bool Determinant = false;
    bool TriangleId = false;
    bool TransformAllInputVectors = false;
    bool KeepVectors = false;
  };
  CLI::App* command =
    program.add_subcommand("map", "Carry data from the source's domain to the target's");
  const auto options = std::make_shared<Options>();
  options->Inputs.AddTo(*command, "SOURCE [TARGET] DATA", 1,
    "The pair, and the data to carry: .csv .txt .xyz (points), .vtp .vtu .vts .vtr .vti .vtm .vtk, "
    ".obj .off .ply .stl, or a picture, whose pixels move as points (to warp it, use dhm warp)");
  options->Data.MovesPoints = true;
  options->Data.AddTo(*command);
  options->Map.AddTo(*command);
  command->add_flag("-i,--inverse", options->Inverse, "From the target's domain to the source's")
    ->group("Map");
  command
    ->add_flag("-j,--jacobian", options->Jacobian,
      "Add the map's derivative at each point: Jacobian, 9 numbers row by row")
    ->group("Results");
  command
    ->add_flag("--determinant", options->Determinant,
      "Add the ratio of areas at each point: JacobianDeterminant")
    ->group("Results");
  command
    ->add_flag(
      "--triangle-id", options->TriangleId, "Add the number of each point's triangle: TriangleId")
    ->group("Results");
  command
    ->add_flag("--carry-all-vectors", options->TransformAllInputVectors,
      "Carry all arrays of 3, 6 and 9 components by the derivative, not only the active vectors, "
      "normals and tensors")
    ->group("Results");
  command
    ->add_flag(
      "--keep-vectors", options->KeepVectors, "Leave vectors, normals and tensors as they are")
    ->group("Results");
  command->callback([options] {
    const MeshPair pair = options->Inputs.ReadPair(1);
    options->Data.Process(options->Inputs.Files.back(),
      [&](vtkDataObject* data, vtkSmartPointer<vtkDataObject>& result) {
        vtkNew<vtkDifferentiableHomeomorphism> map;
        options->Map.ApplyTo(map.Get());
        map->SetSourceData(pair.Source());
        map->SetTargetData(pair.Target());
        map->SetDataObject(data);
        map->SetInverse(options->Inverse);
        map->SetComputeJacobian(options->Jacobian);
        map->SetComputeJacobianDeterminant(options->Determinant);
        map->SetComputeTriangleId(options->TriangleId);
        map->SetTransformAllInputVectors(options->TransformAllInputVectors);
        map->SetTransformActiveAttributes(!options->KeepVectors);
        WorkWith(pair, [&] { Run(map, "Mapping"); });
        result = map->GetOutputDataObject(0);
        return map->GetNumberOfOutsidePoints();
      });
  });
}

void AddCoordinates(CLI::App& program)
{
  struct Options
  {
    std::vector<std::string> Files;
    std::string InputFormat = "json";
    MapOptions Map;
    DataOptions Data;
  };
  CLI::App* command = program.add_subcommand(
    "coordinates", "Attach triangular coordinates (e, p, c) in a mesh to the points of data");
  const auto options = std::make_shared<Options>();
  command
    ->add_option("FILES", options->Files,
      "The triangulation (of a triangulation file the source), and the data: as for dhm map")
    ->expected(2)
    ->required()
    ->type_name("MESH DATA");
  command
    ->add_option("--input-format", options->InputFormat,
      "What the mesh is if it comes from standard input, as an extension")
    ->type_name("EXTENSION")
    ->group("Files");
  options->Data.AddTo(*command);
  options->Map.AddTo(*command);
  command->footer(
    "The arrays: TriangleId, EdgeLabel (e, 1 to 3), EdgeParameter (p, 0 to 1 along the edge), "
    "ContourParameter (c, 0 at the center, 1 on the edge), vtkValidPointMask.");
  command->callback([options] {
    const auto mesh = ReadMesh(options->Files[0], options->InputFormat);
    options->Data.Process(
      options->Files[1], [&](vtkDataObject* data, vtkSmartPointer<vtkDataObject>& result) {
        vtkNew<vtkTriangularCoordinates> coordinates;
        options->Map.ApplyTo(coordinates.Get());
        coordinates->SetInputDataObject(0, mesh);
        coordinates->SetDataObject(data);
        coordinates->GenerateLinesOff();
        try
        {
          Run(coordinates, "Finding coordinates");
        }
        catch (const Failure& failure)
        {
          throw Failure(failure.GetStatus(), options->Files[0] + ": " + failure.what());
        }
        result = coordinates->GetOutputDataObject(0);
        return coordinates->GetNumberOfOutsidePoints();
      });
  });
}

} // namespace dhm
