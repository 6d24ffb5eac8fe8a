// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads xmorph meshes from any bytes, and maps the points of the first onto the second.

#include "../../Filters/Program/XmorphMesh.h"

#include "vtkDifferentiableHomeomorphism.h"
#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  vtkObject::GlobalWarningDisplayOff();
  vtkSMPTools::SetBackend("Sequential");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  // Two files with a zero byte between them; the same twice if there is none.
  const std::uint8_t* end = bytes + size;
  const std::uint8_t* middle = std::find(bytes, end, std::uint8_t(0));
  std::istringstream first(std::string(bytes, middle));
  std::istringstream second(middle == end ? std::string(bytes, end) : std::string(middle + 1, end));
  try
  {
    XmorphMesh meshes[2] = { ReadXmorphMesh(first, "first"), ReadXmorphMesh(second, "second") };
    for (XmorphMesh& mesh : meshes)
    {
      FitToPicture(mesh, 100, 80);
    }
    const auto pair = CutIntoTriangles(meshes[0], meshes[1]);
    vtkNew<vtkDifferentiableHomeomorphism> filter;
    filter->SetSourceData(pair[0]);
    filter->SetTargetData(pair[1]);
    filter->Update();
  }
  catch (const std::runtime_error&)
  {
  }
  return 0;
}
