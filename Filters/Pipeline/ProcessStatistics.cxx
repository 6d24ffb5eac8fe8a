// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ProcessStatistics.h"

#include "vtkCommunicator.h"
#include "vtkMultiProcessController.h"
#include "vtkObject.h"

#include <algorithm>

namespace homeomorphism
{

ProcessStatistics Total(
  vtkObject* self, const ProcessStatistics& own, vtkMultiProcessController* controller)
{
  if (!controller)
  {
    controller = vtkMultiProcessController::GetGlobalController();
  }
  if (!controller || controller->GetNumberOfProcesses() == 1)
  {
    return own;
  }
  ProcessStatistics sent = own;
  for (double& sum : sent.Sums)
  {
    sent.Largest.push_back(sum < 0.0 ? 1.0 : 0.0);
    sum = std::max(sum, 0.0);
  }
  ProcessStatistics total = sent;
  // Make both calls even if one fails, because the other processes make them.
  const int added = controller->AllReduce(sent.Sums.data(), total.Sums.data(),
    static_cast<vtkIdType>(sent.Sums.size()), vtkCommunicator::SUM_OP);
  const int compared = controller->AllReduce(sent.Largest.data(), total.Largest.data(),
    static_cast<vtkIdType>(sent.Largest.size()), vtkCommunicator::MAX_OP);
  if (!added || !compared)
  {
    vtkErrorWithObjectMacro(self, << "The processes could not exchange their statistics.");
    return own;
  }
  for (std::size_t i = 0; i < own.Sums.size(); ++i)
  {
    if (total.Largest[own.Largest.size() + i] > 0.0)
    {
      total.Sums[i] = -1.0;
    }
  }
  total.Largest.resize(own.Largest.size());
  return total;
}

} // namespace homeomorphism
