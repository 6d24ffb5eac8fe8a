// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads any bytes as one of the files that the program dhm reads itself. What it also writes is
// written, and what is written must be read as the same.

#include "FuzzRequire.h"

#include "Program/Failure.h"
#include "Program/PlyMesh.h"
#include "Program/PointTable.h"
#include "Program/StlMesh.h"
#include "Program/TextMesh.h"
#include "Program/TriangulationFile.h"

#include "vtkPoints.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <sstream>
#include <string>

namespace
{

using fuzz::Require;

/// Whether the points are the same, what is no number included.
void RequireSamePoints(vtkPolyData* a, vtkPolyData* b)
{
  Require(a->GetNumberOfPoints() == b->GetNumberOfPoints());
  Require(a->GetNumberOfPolys() == b->GetNumberOfPolys());
  for (vtkIdType i = 0; i < a->GetNumberOfPoints(); ++i)
  {
    double x[3];
    double y[3];
    a->GetPoint(i, x);
    b->GetPoint(i, y);
    for (int axis = 0; axis < 3; ++axis)
    {
      Require(x[axis] == y[axis] || (std::isnan(x[axis]) && std::isnan(y[axis])));
    }
  }
}

using Reader = vtkSmartPointer<vtkPolyData> (*)(std::istream&, const std::string&);
using Writer = void (*)(vtkPolyData*, std::ostream&);

void ReadMeshAndBack(std::istream& file, Reader read, Writer write)
{
  const auto mesh = read(file, "file");
  std::stringstream text;
  write(mesh, text);
  RequireSamePoints(mesh, read(text, "what was written"));
}

void ReadTriangulationAndBack(std::istream& file)
{
  const auto read = dhm::ReadTriangulationFile(file, "file");
  std::stringstream text;
  dhm::WriteTriangulationFile(read.Metadata, read.Meshes[0], read.Meshes[1], text);
  const auto again = dhm::ReadTriangulationFile(text, "what was written");
  RequireSamePoints(read.Meshes[0], again.Meshes[0]);
  RequireSamePoints(read.Meshes[1], again.Meshes[1]);
}

void ReadTableAndBack(std::istream& file)
{
  const dhm::PointTable table(file, "file", "");
  std::stringstream text;
  table.Write(text);
  const std::string written = text.str();
  const dhm::PointTable again(text, "what was written", "");
  RequireSamePoints(table.ToPoints(), again.ToPoints());
  std::stringstream twice;
  again.Write(twice);
  Require(twice.str() == written);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  if (size == 0)
  {
    return 0;
  }
  std::istringstream file(std::string(bytes + 1, bytes + size));
  try
  {
    switch (bytes[0])
    {
      case 'o':
        ReadMeshAndBack(file, dhm::ReadObj, dhm::WriteObj);
        break;
      case 'f':
        ReadMeshAndBack(file, dhm::ReadOff, dhm::WriteOff);
        break;
      case 'j':
        ReadTriangulationAndBack(file);
        break;
      case 'p':
        dhm::ReadPly(file, "file");
        break;
      case 's':
        dhm::ReadStl(file, "file");
        break;
      default:
        ReadTableAndBack(file);
    }
  }
  catch (const dhm::Failure&)
  {
  }
  return 0;
}
