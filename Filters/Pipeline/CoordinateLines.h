// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CoordinateLines.h
/// Polylines of triangular coordinates: center and wing segments, contours, and rings.

#ifndef homeomorphism_CoordinateLines_h
#define homeomorphism_CoordinateLines_h

#include "Mesh/Homeomorphism.h"

class vtkAlgorithm;
class vtkPolyData;

namespace homeomorphism
{

/// The numbers and the resolution of lines, see vtkTriangularCoordinates.
struct CoordinateLineOptions
{
  int NumberOfContours;
  int NumberOfRings;
  int Resolution;
};

/// Fills @a output with the lines of all triangles of the source, see output 1 of
/// vtkTriangularCoordinates. If @a self is aborted, the output contains the lines of the triangles
/// processed so far.
void MakeCoordinateLines(vtkAlgorithm* self, const Homeomorphism& map,
  const CoordinateLineOptions& options, vtkPolyData* output);

} // namespace homeomorphism

#endif
