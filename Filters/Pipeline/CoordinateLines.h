// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CoordinateLines.h
/// The lines that show a triangulation's coordinates: guides, contours and rings.

#ifndef homeomorphism_CoordinateLines_h
#define homeomorphism_CoordinateLines_h

#include "Mesh/Homeomorphism.h"

class vtkAlgorithm;
class vtkPolyData;

namespace homeomorphism
{

/// How many lines of what resolution; see vtkTriangularCoordinates.
struct CoordinateLineOptions
{
  int NumberOfContours;
  int NumberOfRings;
  int Resolution;
};

/// Fills @a output with the lines of all triangles of the source, as output 1 of
/// vtkTriangularCoordinates describes. On behalf of @a self, whose request to abort leaves the
/// lines of the triangles done by then.
void MakeCoordinateLines(vtkAlgorithm* self, const Homeomorphism& map,
  const CoordinateLineOptions& options, vtkPolyData* output);

} // namespace homeomorphism

#endif
