// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file InBetween.h
/// Meshes on the way from the source to the target, and where they fold.

#ifndef dhm_InBetween_h
#define dhm_InBetween_h

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

namespace dhm
{

/// Triangles of a planar pair that are turned over at a time between 0 and 1, though they are not
/// at its ends. (On surfaces, nothing is turned over.)
struct Folds
{
  /// Whether source and target are mirror images.
  bool Mirrored = false;
  /// Number of triangles that are turned over at some time.
  vtkIdType Triangles = 0;
  /// The first to be turned over; -1 if there is none.
  vtkIdType FirstCell = -1;
  /// The time when the first is, and when the last no longer is.
  double Begin = 1.0;
  double End = 0.0;
};

/// The mesh whose points have gone the proportion @a t of their way along straight lines. At 0 and
/// 1 the very points of source and target.
vtkSmartPointer<vtkPolyData> InBetween(vtkPolyData* source, vtkPolyData* target, double t);

/// The area of a triangle is a quadratic function of the time; its roots tell.
Folds FindFolds(vtkPolyData* source, vtkPolyData* target);

/// Whether a triangle is turned over, or has no area, at a time.
bool IsFolded(vtkPolyData* source, vtkPolyData* target, double t);

} // namespace dhm

#endif
