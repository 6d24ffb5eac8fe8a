// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ProcessStatistics.h
/// Statistics of a filter over processes that have its data in pieces.

#ifndef homeomorphism_ProcessStatistics_h
#define homeomorphism_ProcessStatistics_h

#include <vector>

class vtkMultiProcessController;
class vtkObject;

namespace homeomorphism
{

/// The statistics of the last execution in its own process. Filters keep them apart from the totals
/// that they report, so that reducing again does not count anything twice.
struct ProcessStatistics
{
  /// Counts to be summed, exact up to 2^53; negative if unknown.
  std::vector<double> Sums;
  /// Values whose maximum is computed.
  std::vector<double> Largest;
};

/// The totals over the processes of @a controller (null: the global one), each of which must call
/// this. A sum is -1 if it is unknown in one of them. Without a controller, and after an error,
/// which @a self reports, returns the argument.
ProcessStatistics Total(
  vtkObject* self, const ProcessStatistics& own, vtkMultiProcessController* controller);

} // namespace homeomorphism

#endif
