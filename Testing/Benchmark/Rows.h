// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Rows.h
/// The rows of the table: everything that is timed, by name.

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
  /// Points in double precision, and as many places for their images.
  vtkPoints* In;
  vtkPoints* Out;
  int Threads;
  /// What the row made: the images' coordinates if it sets nothing else.
  vtkSmartPointer<vtkDataArray> Result;
};

struct Row
{
  /// What is timed.
  std::function<void(Task&)> Run;
  /// What is not: preparing, and bringing the result to where it is compared.
  std::function<void(Task&)> Before;
  std::function<void(Task&)> After;
};

/// Names are made of words without spaces, separated by slashes: who maps, how, and "forward" or
/// "inverse". A new row is one lambda:
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
/// Add rows for a workload, which they refer to.
void AddHomeomorphismRows(const Workload& workload, Rows& rows);
void AddPeerRows(const Workload& workload, Rows& rows);
void AddBoundRows(const Workload& workload, Rows& rows);
void AddImageRows(const Workload& workload, Rows& rows);
void AddConstructionRows(const Workload& workload, Rows& rows);
///@}

/// What the row "construct/..." of a name made in its last run is destroyed, and made anew.
struct Memory
{
  /// Allocated and kept, in bytes.
  double Kept;
  /// Allocated at most meanwhile.
  double Peak;
};
Memory MeasureMemory(Row& row, Task& task);

#endif
