// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Measure.h
/// What the example's table says about a coordinate system.

#ifndef Measure_h
#define Measure_h

#include "vtkPolyData.h"
#include "vtkType.h"

struct Measurements
{
  /// Triangles in which the system does not exist in the source or in the target.
  vtkIdType TrianglesRefused;
  vtkIdType PointsMapped;
  vtkIdType PointsOutside;
  double SmallestDeterminant;
  /// Over 3 points of each interior edge: the norm of the difference of the Jacobians on the two
  /// sides over the norm of their mean.
  double LargestJump;
  /// Largest distance, in the source's units, of a point mapped there and back from where it was.
  double RoundTripError;
  /// Mapping a million points row by row, location included, meshes read before.
  double NanosecondsPerPoint;
};

Measurements Measure(vtkPolyData* source, vtkPolyData* target, int coordinateSystem);

#endif
