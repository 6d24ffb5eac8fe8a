// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDifferentiableHomeomorphism.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDifferentiableHomeomorphism);

//------------------------------------------------------------------------------
void vtkDifferentiableHomeomorphism::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
