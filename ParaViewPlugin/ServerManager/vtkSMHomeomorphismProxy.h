// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMHomeomorphismProxy
 * @brief   a filter whose counts are those of all processes
 *
 * The proxy of a filter of this project that has a method ReduceStatistics. Before its information
 * properties are fetched, from the server's first process, all processes of the server are told to
 * call that method. They wait for each other there and nowhere else: whether one has no data, has
 * not executed or had an error makes no difference. The information properties are fetched after
 * every update.
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
