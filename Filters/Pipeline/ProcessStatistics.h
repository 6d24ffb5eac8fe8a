// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ProcessStatistics.h
/// Statistics of a filter over processes that each have a piece of its data.

#ifndef homeomorphism_ProcessStatistics_h
#define homeomorphism_ProcessStatistics_h

#include <vector>

class vtkMultiProcessController;
class vtkObject;

namespace homeomorphism
{

/// The statistics of the last execution in this process. Filters store them separately from the
/// totals that they report, so that repeated reduction does not count anything twice.
struct ProcessStatistics
{
  /// Counts to be summed, exact up to 2^53; negative if unknown.
  std::vector<double> Sums;
  /// Values whose maximum is computed.
  std::vector<double> Largest;
};

/// The totals over the processes of @a controller (null: the global controller), each of which must
/// call this function. A sum is -1 if it is unknown in one of them. Returns @a own if there is no
/// controller, and after an error, which @a self reports.
ProcessStatistics Total(
  vtkObject* self, const ProcessStatistics& own, vtkMultiProcessController* controller);

} // namespace homeomorphism

#endif
