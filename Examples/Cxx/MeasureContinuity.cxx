// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures across how many edges the Jacobian of the map between two meshes is discontinuous:
//   MeasureContinuity SOURCE.vtp TARGET.vtp

#include <vtkJacobianContinuity.h>
#include <vtkNew.h>
#include <vtkXMLPolyDataReader.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc != 3)
  {
    std::cerr << "Usage: MeasureContinuity SOURCE.vtp TARGET.vtp\n";
    return EXIT_FAILURE;
  }
  vtkNew<vtkXMLPolyDataReader> source;
  source->SetFileName(argv[1]);
  vtkNew<vtkXMLPolyDataReader> target;
  target->SetFileName(argv[2]);
  vtkNew<vtkJacobianContinuity> continuity;
  continuity->SetSourceConnection(source->GetOutputPort());
  continuity->SetTargetConnection(target->GetOutputPort());
  for (const bool smooth : { false, true })
  {
    continuity->SetCoordinateSystem(
      smooth ? vtkJacobianContinuity::SMOOTH : vtkJacobianContinuity::LINEAR);
    continuity->Update();
    if (continuity->GetErrorCode() != 0)
    {
      return EXIT_FAILURE;
    }
    std::cout << (smooth ? "Smooth: " : "Linear: ") << continuity->GetNumberOfCreases()
              << " creases\n";
  }
  return EXIT_SUCCESS;
}
