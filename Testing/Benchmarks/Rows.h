// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Rows.h
/// The rows of the table: all timed tasks, by name.

#ifndef Rows_h
#define Rows_h

#include "vtkDataArray.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <map>
#include <string>

struct Workload;

/// One run of a row.
struct Task
{
  /// Points in double precision, and an array of the same size for their images.
  vtkPoints* In;
  vtkPoints* Out;
  int Threads;
  /// The result of the row: the coordinates of the images unless it sets another one.
  vtkSmartPointer<vtkDataArray> Result;
};

struct Row
{
  /// The timed part.
  std::function<void(Task&)> Run;
  /// The parts that are not timed: preparation, and copying the result for comparison.
  std::function<void(Task&)> Before;
  std::function<void(Task&)> After;
};

/// Names consist of words without spaces, separated by slashes: the software, the method, and
/// "forward" or "inverse". A new row is one lambda:
///
///   rows["batch/Smooth/forward"].Run = [&workload](Task& task) { ... };
using Rows = std::map<std::string, Row>;

/// Coordinates of vtkPoints of doubles.
double* Coordinates(vtkPoints* points);

inline std::string Direction(bool inverse)
{
  return inverse ? "/inverse" : "/forward";
}

///@{
/// Add rows for a workload, to which they keep a reference.
void AddHomeomorphismRows(const Workload& workload, Rows& rows);
void AddPeerRows(const Workload& workload, Rows& rows);
void AddBoundRows(const Workload& workload, Rows& rows);
void AddImageRows(const Workload& workload, Rows& rows);
void AddConstructionRows(const Workload& workload, Rows& rows);
///@}

/// Destroys the result of the last run of the row "construct/..." with this name, and makes it
/// again.
struct Memory
{
  /// Bytes allocated and kept.
  double Kept;
  /// Bytes allocated at the peak.
  double Peak;
};
Memory MeasureMemory(Row& row, Task& task);

#endif
