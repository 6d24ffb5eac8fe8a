// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Counts the edges across which the Jacobian of the map between two meshes is discontinuous:
//   MeasureContinuity SOURCE.vtp TARGET.vtp

#include <vtkJacobianContinuity.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
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
  vtkNew<vtkXMLPolyDataReader> readers[2];
  for (int i = 0; i < 2; ++i)
  {
    readers[i]->SetFileName(argv[i + 1]);
    readers[i]->Update();
    if (readers[i]->GetErrorCode() != 0 || readers[i]->GetOutput()->GetNumberOfPolys() == 0)
    {
      std::cerr << argv[i + 1] << " has no triangles.\n";
      return EXIT_FAILURE;
    }
  }
  vtkNew<vtkJacobianContinuity> continuity;
  continuity->SetSourceConnection(readers[0]->GetOutputPort());
  continuity->SetTargetConnection(readers[1]->GetOutputPort());
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
