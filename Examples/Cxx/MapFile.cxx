// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Maps the points of a file, with their vectors, from one mesh to another:
//   MapFile SOURCE.vtp TARGET.vtp DATA.vtp RESULT.vtp

#include <vtkDifferentiableHomeomorphism.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc != 5)
  {
    std::cerr << "Usage: MapFile SOURCE.vtp TARGET.vtp DATA.vtp RESULT.vtp\n";
    return EXIT_FAILURE;
  }
  vtkNew<vtkXMLPolyDataReader> readers[3];
  for (int i = 0; i < 3; ++i)
  {
    readers[i]->SetFileName(argv[i + 1]);
    readers[i]->Update();
    if (readers[i]->GetErrorCode() != 0 || readers[i]->GetOutput()->GetNumberOfPoints() == 0)
    {
      std::cerr << argv[i + 1] << " has no points.\n";
      return EXIT_FAILURE;
    }
  }
  vtkNew<vtkDifferentiableHomeomorphism> map;
  map->SetSourceConnection(readers[0]->GetOutputPort());
  map->SetTargetConnection(readers[1]->GetOutputPort());
  map->SetDataConnection(readers[2]->GetOutputPort());
  map->ComputeJacobianDeterminantOn();

  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(map->GetOutputPort());
  writer->SetFileName(argv[4]);
  writer->SetDataModeToBinary();
  if (writer->Write() == 0 || writer->GetErrorCode() != 0 || map->GetErrorCode() != 0)
  {
    return EXIT_FAILURE;
  }
  std::cout << map->GetNumberOfOutsidePoints() << " points are outside.\n";
  return EXIT_SUCCESS;
}
