// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTriangularCoordinates.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkTriangularCoordinates);

//------------------------------------------------------------------------------
void vtkTriangularCoordinates::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
