// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMHomeomorphismProxy
 * @brief   proxy of a filter with statistics of all processes
 *
 * Proxy of a filter with a method ReduceStatistics. Before the information properties are fetched
 * from the first process of the server, all processes of the server call that method. This is the
 * only point of synchronization, so a process without data, without an execution or with an error
 * does not block the others. The information properties are fetched after every update.
 */

#ifndef vtkSMHomeomorphismProxy_h
#define vtkSMHomeomorphismProxy_h

#include "vtkHomeomorphismServerManagerModule.h" // for the export macro
#include "vtkSMSourceProxy.h"

class VTKHOMEOMORPHISMSERVERMANAGER_EXPORT vtkSMHomeomorphismProxy : public vtkSMSourceProxy
{
public:
  static vtkSMHomeomorphismProxy* New();
  vtkTypeMacro(vtkSMHomeomorphismProxy, vtkSMSourceProxy);

protected:
  vtkSMHomeomorphismProxy();
  ~vtkSMHomeomorphismProxy() override;

  void UpdatePropertyInformationInternal(vtkSMProperty* property) override;
  void PostUpdateData(bool using_cache) override;

private:
  vtkSMHomeomorphismProxy(const vtkSMHomeomorphismProxy&) = delete;
  void operator=(const vtkSMHomeomorphismProxy&) = delete;
};

#endif
