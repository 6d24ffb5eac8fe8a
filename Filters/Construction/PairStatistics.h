// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PairStatistics.h
/// Statistics of a pair of triangulations: counts, shapes, and the linear maps of its triangles.

#ifndef homeomorphism_PairStatistics_h
#define homeomorphism_PairStatistics_h

#include "Mesh/TriangulationPair.h"

#include "vtkType.h"

#include <array>
#include <limits>
#include <vector>

class vtkPolyData;

namespace homeomorphism
{

/// The smallest or largest of several values, and the cell where it occurs; NaN and -1 if there are
/// none.
struct Extreme
{
  double Value = std::numeric_limits<double>::quiet_NaN();
  vtkIdType Cell = -1;

  /// Of equal values, the first one is kept. NaN is ignored.
  void TakeLarger(double value, vtkIdType cell)
  {
    if (value > this->Value || (this->Cell < 0 && value == value))
    {
      *this = { value, cell };
    }
  }
  void TakeSmaller(double value, vtkIdType cell)
  {
    if (value < this->Value || (this->Cell < 0 && value == value))
    {
      *this = { value, cell };
    }
  }
};

/// Counts of points of a mesh, which may be invalid.
struct PointCounts
{
  /// Points that no polygon uses.
  vtkIdType Unused = 0;
  /// Points with exactly the same coordinates as a point with a smaller id.
  vtkIdType Duplicate = 0;
};

PointCounts CountPoints(vtkPolyData* mesh);

/// The number of cells whose points are in a different order in the target. The meshes must have
/// the same number of cells.
vtkIdType CountReordered(vtkPolyData* source, vtkPolyData* target);

/// The combinatorics of a triangulation without its masked triangles.
struct TriangulationCounts
{
  vtkIdType Components = 0;
  vtkIdType InteriorEdges = 0;
  vtkIdType BoundaryEdges = 0;
  vtkIdType BoundaryLoops = 0;
  /// Triangles whose winding differs from that of most triangles of their component.
  vtkIdType OppositeWindings = 0;
};

TriangulationCounts CountConnections(const Triangulation& triangulation);

/// The shapes of a mesh's triangles. Values of masked triangles are NaN.
struct MeshShapes
{
  /// For each triangle, the smallest angle in degrees, and the largest ratio of areas between the
  /// triangle and a neighbor, at least 1 (NaN without neighbors).
  std::vector<double> SmallestAngles;
  std::vector<double> AreaRatios;
  /// For each triangle, whether it is concordant (see IsConcordant).
  std::vector<bool> Concordant;
  Extreme SmallestAngle;
  Extreme LargestAreaRatio;
  vtkIdType DiscordantTriangles = 0;
  /// The fractions, from 0 to 1, of triangles whose smallest angle is below 10, 15 and 20 degrees.
  std::array<double, 3> SharesOfSmallAngles{ 0.0, 0.0, 0.0 };
  /// The mean length of the edges, each counted once, in the mesh's units.
  double MeanEdgeLength = std::numeric_limits<double>::quiet_NaN();
  /// The sum of the areas of all triangles, in the mesh's units, squared.
  double Area = 0.0;
};

MeshShapes MeasureShapes(const TriangulationPair& pair, Domain domain);

/// The linear maps of the triangles onto the corresponding ones; NaN for masked triangles.
struct LinearMaps
{
  /// The ratio of the target's area to the source's.
  std::vector<double> Determinants;
  /// The condition number: the ratio of the largest to the smallest factor by which lengths change,
  /// at least 1.
  std::vector<double> Distortions;
  /// The largest and the smallest factor by which lengths change, over all triangles.
  Extreme LargestStretch;
  Extreme SmallestStretch;
  Extreme LargestDistortion;
};

LinearMaps MeasureLinearMaps(const TriangulationPair& pair);

/// Whether the target of a planar pair is a mirror image of the source.
bool IsMirrored(const TriangulationPair& pair);

} // namespace homeomorphism

#endif
