// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ProcessStatistics.h
/// What a filter counts, over the processes that have its data in pieces.

#ifndef homeomorphism_ProcessStatistics_h
#define homeomorphism_ProcessStatistics_h

#include <vector>

class vtkMultiProcessController;
class vtkObject;

namespace homeomorphism
{

/// What a filter's last execution counted in its own process. Filters keep it apart from the totals
/// that they show, so that nothing is counted twice when totals are made again.
struct ProcessStatistics
{
  /// Counts, exact up to 2^53, of which the sum is wanted; negative if not known.
  std::vector<double> Sums;
  /// Numbers of which the largest is wanted.
  std::vector<double> Largest;
};

/// The totals over the processes of @a controller (null: the global one), each of which must call
/// this. A sum is -1 if it is not known to one of them. Without a controller, and after an error,
/// which @a self reports, what is given.
ProcessStatistics Total(
  vtkObject* self, const ProcessStatistics& own, vtkMultiProcessController* controller);

} // namespace homeomorphism

#endif
