// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHomeomorphismTransform.h"

#include "vtkMath.h"
#include "vtkObjectFactory.h"

#include <algorithm>

vtkStandardNewMacro(vtkHomeomorphismTransform);

//------------------------------------------------------------------------------
void vtkHomeomorphismTransform::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

//------------------------------------------------------------------------------
vtkAbstractTransform* vtkHomeomorphismTransform::MakeTransform()
{
  return vtkHomeomorphismTransform::New();
}

//------------------------------------------------------------------------------
void vtkHomeomorphismTransform::ForwardTransformPoint(const float in[3], float out[3])
{
  std::copy_n(in, 3, out);
}

//------------------------------------------------------------------------------
void vtkHomeomorphismTransform::ForwardTransformPoint(const double in[3], double out[3])
{
  std::copy_n(in, 3, out);
}

//------------------------------------------------------------------------------
void vtkHomeomorphismTransform::ForwardTransformDerivative(
  const float in[3], float out[3], float derivative[3][3])
{
  this->ForwardTransformPoint(in, out);
  vtkMath::Identity3x3(derivative);
}

//------------------------------------------------------------------------------
void vtkHomeomorphismTransform::ForwardTransformDerivative(
  const double in[3], double out[3], double derivative[3][3])
{
  this->ForwardTransformPoint(in, out);
  vtkMath::Identity3x3(derivative);
}
