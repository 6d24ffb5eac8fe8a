// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "TextMesh.h"

#include "Failure.h"
#include "LineReader.h"
#include "MeshParts.h"
#include "Numbers.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"

#include <istream>
#include <optional>
#include <ostream>

namespace dhm
{
namespace
{

/// The line's words from @a first as coordinates.
void ReadPoint(const LineReader& line, std::size_t first, vtkPoints* points)
{
  double point[3];
  for (std::size_t k = 0; k < 3; ++k)
  {
    const auto value =
      first + k < line.Words.size() ? ToNumber(line.Words[first + k]) : std::nullopt;
    if (!value)
    {
      line.Fail("three coordinates");
    }
    point[k] = *value;
  }
  points->InsertNextPoint(point);
}

vtkSmartPointer<vtkPolyData> MakeMesh(vtkPoints* points, vtkCellArray* polygons)
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(polygons);
  return mesh;
}

void WritePoint(vtkPolyData* mesh, vtkIdType point, std::ostream& file)
{
  double x[3];
  mesh->GetPoint(point, x);
  file << ToText(x[0]) << ' ' << ToText(x[1]) << ' ' << ToText(x[2]) << '\n';
}

} // namespace

vtkSmartPointer<vtkPolyData> ReadObj(std::istream& file, const std::string& fileName)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  LineReader lines(file, fileName, "#");
  while (lines.Next())
  {
    if (lines.Words[0] == "v")
    {
      ReadPoint(lines, 1, points);
    }
    else if (lines.Words[0] == "f")
    {
      if (lines.Words.size() < 4)
      {
        lines.Fail("a face of at least three points");
      }
      polygons->InsertNextCell(static_cast<int>(lines.Words.size()) - 1);
      for (std::size_t k = 1; k < lines.Words.size(); ++k)
      {
        // point/texture/normal; negative numbers count from the last point backwards.
        const std::string& word = lines.Words[k];
        const auto number = ToNumber<vtkIdType>(word.substr(0, word.find('/')));
        const vtkIdType count = points->GetNumberOfPoints();
        const vtkIdType id = number.value_or(0) < 0 ? count + *number : number.value_or(0) - 1;
        if (id < 0 || id >= count)
        {
          lines.Fail("numbers of points that came before, 1 to " + std::to_string(count) +
            ", instead of \"" + word + "\"");
        }
        polygons->InsertCellPoint(id);
      }
    }
  }
  if (points->GetNumberOfPoints() == 0)
  {
    throw Failure(
      FILE_TROUBLE, fileName + " has no points (lines \"v x y z\"): it is no OBJ mesh.");
  }
  return MakeMesh(points, polygons);
}

vtkSmartPointer<vtkPolyData> ReadOff(std::istream& file, const std::string& fileName)
{
  LineReader lines(file, fileName, "#");
  lines.Require("OFF");
  if (lines.Words[0] != "OFF")
  {
    lines.Fail("OFF, the first word of an OFF mesh");
  }
  lines.Words.erase(lines.Words.begin());
  if (lines.Words.empty())
  {
    lines.Require("the numbers of points and faces");
  }
  const auto pointCount = ToNumber<vtkIdType>(lines.Words[0]);
  const auto faceCount =
    lines.Words.size() > 1 ? ToNumber<vtkIdType>(lines.Words[1]) : std::optional<vtkIdType>();
  if (!pointCount || !faceCount || *pointCount < 0 || *faceCount < 0)
  {
    lines.Fail("the numbers of points and faces");
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < *pointCount; ++i)
  {
    lines.Require("point " + std::to_string(i) + " of " + std::to_string(*pointCount));
    ReadPoint(lines, 0, points);
  }
  vtkNew<vtkCellArray> polygons;
  for (vtkIdType i = 0; i < *faceCount; ++i)
  {
    lines.Require("face " + std::to_string(i) + " of " + std::to_string(*faceCount));
    const auto size = ToNumber<int>(lines.Words[0]);
    if (!size || *size < 3 || lines.Words.size() <= static_cast<std::size_t>(*size))
    {
      lines.Fail("the number of the face's points, at least 3, and as many numbers of points");
    }
    polygons->InsertNextCell(*size);
    for (int k = 1; k <= *size; ++k)
    {
      const auto id = ToNumber<vtkIdType>(lines.Words[k]);
      if (!id || *id < 0 || *id >= *pointCount)
      {
        lines.Fail("numbers of points, 0 to " + std::to_string(*pointCount - 1) +
          ", instead of \"" + lines.Words[k] + "\"");
      }
      polygons->InsertCellPoint(*id);
    }
  }
  return MakeMesh(points, polygons);
}

void WriteObj(vtkPolyData* mesh, std::ostream& file)
{
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    file << "v ";
    WritePoint(mesh, i, file);
  }
  ForEachCell(mesh->GetPolys(), [&file](vtkIdType, vtkIdType count, const vtkIdType* points) {
    file << 'f';
    for (vtkIdType k = 0; k < count; ++k)
    {
      file << ' ' << points[k] + 1;
    }
    file << '\n';
  });
}

void WriteOff(vtkPolyData* mesh, std::ostream& file)
{
  file << "OFF\n" << mesh->GetNumberOfPoints() << ' ' << mesh->GetNumberOfPolys() << " 0\n";
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    WritePoint(mesh, i, file);
  }
  ForEachCell(mesh->GetPolys(), [&file](vtkIdType, vtkIdType count, const vtkIdType* points) {
    file << count;
    for (vtkIdType k = 0; k < count; ++k)
    {
      file << ' ' << points[k];
    }
    file << '\n';
  });
}

} // namespace dhm
