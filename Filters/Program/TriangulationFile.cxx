// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "TriangulationFile.h"

#include "Failure.h"
#include "MeshParts.h"
#include "Numbers.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"

#include <algorithm>
#include <istream>
#include <ostream>
#include <vector>

namespace dhm
{
namespace
{

using Json = nlohmann::ordered_json;

/// A file's rows of numbers under a member, with the columns that another member names.
class Table
{
public:
  Table(const Json& document, const std::string& member, const std::string& columns,
    const std::string& fileName)
    : FileName(fileName)
    , Member(member)
  {
    const auto rows = document.find(member);
    const auto names = document.find(columns);
    if (rows == document.end() || !rows->is_array() || names == document.end() ||
      !names->is_array())
    {
      throw Failure(FILE_TROUBLE,
        fileName + " has no arrays \"" + member + "\" and \"" + columns +
          "\": it is no triangulation file.");
    }
    this->Rows = &*rows;
    for (const Json& name : *names)
    {
      this->Columns.push_back(name.is_string() ? name.get<std::string>() : "");
    }
  }

  std::size_t GetNumberOfRows() const { return this->Rows->size(); }

  /// The position of a column.
  std::size_t FindColumn(const std::string& name) const
  {
    const auto found = std::find(this->Columns.begin(), this->Columns.end(), name);
    if (found == this->Columns.end())
    {
      throw Failure(FILE_TROUBLE,
        this->FileName + ": \"" + this->Member + "\" has no column \"" + name + "\".");
    }
    return static_cast<std::size_t>(found - this->Columns.begin());
  }

  double GetNumber(std::size_t row, std::size_t column) const
  {
    const Json& value = this->GetValue(row, column);
    if (!value.is_number())
    {
      this->Fail(row, "a number as \"" + this->Columns[column] + "\"");
    }
    return value.get<double>();
  }

  /// A number of a vertex.
  vtkIdType GetIndex(std::size_t row, std::size_t column, std::size_t count) const
  {
    const Json& value = this->GetValue(row, column);
    if (!value.is_number_integer() || value.get<std::int64_t>() < 0 ||
      value.get<std::uint64_t>() >= count)
    {
      this->Fail(row,
        "the number of a vertex, 0 to " + std::to_string(count) + " less 1, as \"" +
          this->Columns[column] + "\"");
    }
    return value.get<vtkIdType>();
  }

private:
  const Json& GetValue(std::size_t row, std::size_t column) const
  {
    const Json& values = (*this->Rows)[row];
    if (!values.is_array() || values.size() != this->Columns.size())
    {
      this->Fail(row, std::to_string(this->Columns.size()) + " values");
    }
    return values[column];
  }

  [[noreturn]] void Fail(std::size_t row, const std::string& expected) const
  {
    throw Failure(FILE_TROUBLE,
      this->FileName + ": " + this->Member + "[" + std::to_string(row) + "]: expected " + expected +
        ", found " + (*this->Rows)[row].dump(-1, ' ', false, Json::error_handler_t::replace) + ".");
  }

  std::string FileName;
  std::string Member;
  const Json* Rows = nullptr;
  std::vector<std::string> Columns;
};

bool Contains(const Json& document, const std::string& member, const std::string& value)
{
  const auto found = document.find(member);
  return found != document.end() && found->is_array() &&
    std::find(found->begin(), found->end(), value) != found->end();
}

Json Parse(std::istream& file, const std::string& fileName)
{
  try
  {
    return Json::parse(file);
  }
  catch (const Json::exception& error)
  {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
    const std::string what = error.what();
    throw Failure(FILE_TROUBLE, fileName + ": " + what.substr(what.find("] ") + 2) + ".");
  }
}

} // namespace

TriangulationFile ReadTriangulationFile(std::istream& file, const std::string& fileName)
{
  TriangulationFile result;
  Json& document = result.Metadata = Parse(file, fileName);
  const std::string type =
    document.is_object() && document.contains("file_type") && document["file_type"].is_string()
    ? document["file_type"].get<std::string>()
    : "";
  if (type != "triangulation_file")
  {
    throw Failure(FILE_TROUBLE,
      fileName + " is no triangulation file: its \"file_type\" is \"" + type +
        "\", not \"triangulation_file\".");
  }
  const auto version = document.find("format_version");
  if (version == document.end() || !version->is_string() ||
    version->get<std::string>().rfind("1.", 0) != 0)
  {
    throw Failure(FILE_TROUBLE, fileName + ": expected \"format_version\" 1.x.");
  }
  if (!Contains(document, "transformed_components", "horizontal"))
  {
    throw Failure(FILE_TROUBLE,
      fileName + " does not shift horizontal coordinates (\"transformed_components\").");
  }
  result.ShiftsHeights = Contains(document, "transformed_components", "vertical");

  const Table vertices(document, "vertices", "vertices_columns", fileName);
  const char* const columns[2][2] = { { "source_x", "source_y" }, { "target_x", "target_y" } };
  for (int side = 0; side < 2; ++side)
  {
    const std::size_t x = vertices.FindColumn(columns[side][0]);
    const std::size_t y = vertices.FindColumn(columns[side][1]);
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->Allocate(static_cast<vtkIdType>(vertices.GetNumberOfRows()));
    for (std::size_t row = 0; row < vertices.GetNumberOfRows(); ++row)
    {
      points->InsertNextPoint(vertices.GetNumber(row, x), vertices.GetNumber(row, y), 0.0);
    }
    result.Meshes[side] = vtkSmartPointer<vtkPolyData>::New();
    result.Meshes[side]->SetPoints(points);
  }

  const Table triangles(document, "triangles", "triangles_columns", fileName);
  std::array<std::size_t, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
  {
    corners[k] = triangles.FindColumn("idx_vertex" + std::to_string(k + 1));
  }
  vtkNew<vtkCellArray> cells;
  for (std::size_t row = 0; row < triangles.GetNumberOfRows(); ++row)
  {
    std::array<vtkIdType, 3> ids;
    std::transform(corners.begin(), corners.end(), ids.begin(), [&](std::size_t column) {
      return triangles.GetIndex(row, column, vertices.GetNumberOfRows());
    });
    cells->InsertNextCell(3, ids.data());
  }
  for (const auto& mesh : result.Meshes)
  {
    mesh->SetPolys(cells);
  }
  for (const char* member : { "vertices", "vertices_columns", "triangles", "triangles_columns" })
  {
    document.erase(member);
  }
  return result;
}

void WriteTriangulationFile(
  const Json& metadata, vtkPolyData* source, vtkPolyData* target, std::ostream& file)
{
  Json document = metadata.is_object() ? metadata : Json::object();
  const auto add = [&document](const char* member, const Json& value) {
    if (!document.contains(member))
    {
      document[member] = value;
    }
  };
  add("file_type", "triangulation_file");
  add("format_version", "1.0");
  // Heights are not shifted by what is written here.
  document["transformed_components"] = Json::array({ "horizontal" });
  document["vertices_columns"] = { "source_x", "source_y", "target_x", "target_y" };
  document["triangles_columns"] = { "idx_vertex1", "idx_vertex2", "idx_vertex3" };

  // The members one below the other, then the tables, a row to a line.
  std::string text = document.dump(2, ' ', false, Json::error_handler_t::replace);
  text.erase(text.rfind('\n'));
  file << text << ",\n  \"vertices\": [";
  for (vtkIdType i = 0; i < source->GetNumberOfPoints(); ++i)
  {
    double from[3];
    double to[3];
    source->GetPoint(i, from);
    target->GetPoint(i, to);
    file << (i == 0 ? "\n    [" : ",\n    [") << ToText(from[0]) << ", " << ToText(from[1]) << ", "
         << ToText(to[0]) << ", " << ToText(to[1]) << "]";
  }
  file << "\n  ],\n  \"triangles\": [";
  ForEachCell(source->GetPolys(), [&file](vtkIdType number, vtkIdType, const vtkIdType* corners) {
    file << (number == 0 ? "\n    [" : ",\n    [") << corners[0] << ", " << corners[1] << ", "
         << corners[2] << "]";
  });
  file << "\n  ]\n}\n";
}

} // namespace dhm
