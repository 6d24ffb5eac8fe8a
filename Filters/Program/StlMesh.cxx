// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "StlMesh.h"

#include "Failure.h"
#include "WordReader.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <istream>
#include <iterator>

namespace dhm
{
namespace
{

/// A binary file's heading, then the number of triangles, then so many bytes for each: normal,
/// three points, and two bytes that mean nothing.
constexpr std::size_t headingSize = 80;
constexpr std::size_t bytesOfTriangle = 50;

std::uint32_t LittleEndian(const char* bytes)
{
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k)
  {
    value = value << 8 | static_cast<unsigned char>(bytes[k]);
  }
  return value;
}

void ReadBinary(const std::string& bytes, vtkPoints* points)
{
  for (std::size_t at = headingSize + 4; at < bytes.size(); at += bytesOfTriangle)
  {
    for (std::size_t corner = 1; corner <= 3; ++corner)
    {
      double point[3];
      for (std::size_t k = 0; k < 3; ++k)
      {
        const std::uint32_t bits = LittleEndian(bytes.data() + at + 12 * corner + 4 * k);
        float value;
        std::memcpy(&value, &bits, sizeof value);
        point[k] = static_cast<double>(value);
      }
      points->InsertNextPoint(point);
    }
  }
}

void ReadText(std::istream& file, const std::string& fileName, vtkPoints* points)
{
  WordReader words(file, fileName);
  const auto next = [&words](const std::string& expected) {
    std::string word = words.Require(expected);
    std::transform(word.begin(), word.end(), word.begin(),
      [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return word;
  };
  const auto require = [&](const std::string& expected) {
    const std::string word = next("\"" + expected + "\"");
    if (word != expected)
    {
      words.Fail("\"" + expected + "\"", word);
    }
  };
  std::string word;
  while (words.Next(word))
  {
    // solid, and a name
    words.SkipLine();
    for (word = next("\"facet\" or \"endsolid\""); word == "facet";
         word = next("\"facet\" or \"endsolid\""))
    {
      require("normal");
      for (int k = 0; k < 3; ++k)
      {
        // Wrong normals, nan among them, are common, and are not needed.
        words.Require("a number");
      }
      require("outer");
      require("loop");
      for (int corner = 0; corner < 3; ++corner)
      {
        require("vertex");
        double point[3];
        for (double& coordinate : point)
        {
          coordinate = words.RequireNumber("a coordinate");
        }
        points->InsertNextPoint(point);
      }
      require("endloop");
      require("endfacet");
    }
    if (word != "endsolid")
    {
      words.Fail("\"facet\" or \"endsolid\"", word);
    }
    words.SkipLine();
  }
}

} // namespace

vtkSmartPointer<vtkPolyData> ReadStl(std::istream& file, const std::string& fileName)
{
  const std::string bytes{ std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  // Binary files may begin with "solid", too.
  const bool hasCount = bytes.size() >= headingSize + 4;
  const std::size_t count = hasCount ? LittleEndian(bytes.data() + headingSize) : 0;
  if (hasCount && bytes.size() == headingSize + 4 + bytesOfTriangle * count)
  {
    ReadBinary(bytes, points);
  }
  else if (bytes.compare(0, 5, "solid") == 0)
  {
    file.clear();
    file.seekg(0);
    ReadText(file, fileName, points);
  }
  else
  {
    throw Failure(FILE_TROUBLE,
      fileName + " is no STL mesh, or has been cut off: it does not begin with \"solid\"" +
        (hasCount ? ", and it has " + std::to_string(bytes.size()) +
              " bytes where a binary one of " + std::to_string(count) + " triangles has " +
              std::to_string(headingSize + 4 + bytesOfTriangle * count)
                  : std::string()) +
        ".");
  }
  if (points->GetNumberOfPoints() == 0)
  {
    throw Failure(FILE_TROUBLE, fileName + " has no triangles.");
  }
  vtkNew<vtkCellArray> triangles;
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); i += 3)
  {
    triangles->InsertNextCell({ i, i + 1, i + 2 });
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);
  return mesh;
}

} // namespace dhm
