// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkSMHomeomorphismProxy.h"

#include "vtkClientServerID.h"
#include "vtkClientServerStream.h"
#include "vtkObjectFactory.h"
#include "vtkSMProperty.h"

vtkStandardNewMacro(vtkSMHomeomorphismProxy);

vtkSMHomeomorphismProxy::vtkSMHomeomorphismProxy() = default;

vtkSMHomeomorphismProxy::~vtkSMHomeomorphismProxy() = default;

void vtkSMHomeomorphismProxy::UpdatePropertyInformationInternal(vtkSMProperty* property)
{
  if (this->ObjectsCreated && this->Location != 0 && (!property || property->GetInformationOnly()))
  {
    // The null object as an id, since pointers cannot be sent to other processes.
    vtkClientServerStream stream;
    stream << vtkClientServerStream::Invoke << VTKOBJECT(this) << "ReduceStatistics"
           << vtkClientServerID() << vtkClientServerStream::End;
    this->ExecuteStream(stream);
  }
  this->Superclass::UpdatePropertyInformationInternal(property);
}

void vtkSMHomeomorphismProxy::PostUpdateData(bool using_cache)
{
  this->Superclass::PostUpdateData(using_cache);
  if (!using_cache)
  {
    this->UpdatePropertyInformation();
  }
}
