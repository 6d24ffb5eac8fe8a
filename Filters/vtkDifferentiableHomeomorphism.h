// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDifferentiableHomeomorphism_h
#define vtkDifferentiableHomeomorphism_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkFiltersHomeomorphismModule.h" // For export macro

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkDifferentiableHomeomorphism : public vtkDataObjectAlgorithm
{
public:
  static vtkDifferentiableHomeomorphism* New();
  vtkTypeMacro(vtkDifferentiableHomeomorphism, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkDifferentiableHomeomorphism() = default;
  ~vtkDifferentiableHomeomorphism() override = default;

private:
  vtkDifferentiableHomeomorphism(const vtkDifferentiableHomeomorphism&) = delete;
  void operator=(const vtkDifferentiableHomeomorphism&) = delete;
};

#endif
