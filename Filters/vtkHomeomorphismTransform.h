// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkHomeomorphismTransform_h
#define vtkHomeomorphismTransform_h

#include "vtkFiltersHomeomorphismModule.h" // For export macro
#include "vtkWarpTransform.h"

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkHomeomorphismTransform : public vtkWarpTransform
{
public:
  static vtkHomeomorphismTransform* New();
  vtkTypeMacro(vtkHomeomorphismTransform, vtkWarpTransform);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkAbstractTransform* MakeTransform() override;

protected:
  vtkHomeomorphismTransform() = default;
  ~vtkHomeomorphismTransform() override = default;

  void ForwardTransformPoint(const float in[3], float out[3]) override;
  void ForwardTransformPoint(const double in[3], double out[3]) override;
  void ForwardTransformDerivative(const float in[3], float out[3], float derivative[3][3]) override;
  void ForwardTransformDerivative(
    const double in[3], double out[3], double derivative[3][3]) override;

private:
  vtkHomeomorphismTransform(const vtkHomeomorphismTransform&) = delete;
  void operator=(const vtkHomeomorphismTransform&) = delete;
};

#endif
