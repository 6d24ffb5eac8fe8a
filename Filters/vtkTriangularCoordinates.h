// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkTriangularCoordinates_h
#define vtkTriangularCoordinates_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkFiltersHomeomorphismModule.h" // For export macro

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkTriangularCoordinates : public vtkDataObjectAlgorithm
{
public:
  static vtkTriangularCoordinates* New();
  vtkTypeMacro(vtkTriangularCoordinates, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkTriangularCoordinates() = default;
  ~vtkTriangularCoordinates() override = default;

private:
  vtkTriangularCoordinates(const vtkTriangularCoordinates&) = delete;
  void operator=(const vtkTriangularCoordinates&) = delete;
};

#endif
