// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PairReport.h
/// Everything there is to know about a pair of meshes before trusting the map between them.

#ifndef dhm_PairReport_h
#define dhm_PairReport_h

#include "MeshPair.h"

#include "Mesh/MeshDiagnostic.h"

#include "vtkType.h"

#include <array>
#include <functional>
#include <vector>

namespace dhm
{

struct MapOptions;

/// A number and where it occurs; nowhere (-1) if there was nothing to measure.
struct Extreme
{
  double Value = 0.0;
  vtkIdType Cell = -1;
};

/// About one mesh.
struct MeshReport
{
  vtkIdType Points = 0;
  /// Cells that are polygons.
  vtkIdType Triangles = 0;
  /// Points that no triangle uses.
  vtkIdType UnusedPoints = 0;
  /// Points that are in the place of an earlier one, and the first of them.
  vtkIdType DuplicatePoints = 0;
  std::vector<vtkIdType> FirstDuplicates;
  /// The rest is known only if the pair is isomorphic.
  bool Planar = false;
  /// Cell ids, ascending.
  std::vector<vtkIdType> DiscordantTriangles;
  /// Degrees.
  Extreme SmallestAngle;
  /// Of the areas of two triangles that share an edge, the larger over the smaller.
  Extreme LargestAreaRatio;
};

/// About the map in one coordinate system.
struct SystemReport
{
  /// Of the ratio of areas, over the sampled points.
  Extreme SmallestDeterminant;
  Extreme LargestDeterminant;
  /// Points at which the determinant was found, and those of them where it is not positive (with
  /// the sign of a mirrored pair reversed).
  vtkIdType Samples = 0;
  vtkIdType NotPositive = 0;
  /// How far from Linear's a point's image is, in the target's units, at most, over the sampled
  /// points.
  Extreme DistanceFromLinear;
  /// What vtkJacobianContinuity found at the interior edges.
  bool ContinuityMeasured = false;
  vtkIdType DifferentiableEdges = 0;
  vtkIdType Creases = 0;
  vtkIdType UndecidedEdges = 0;
  double LargestJump = 0.0;
};

struct PairReport
{
  /// Whether the pair defines a map: no problems.
  bool Valid = false;
  /// All kinds of defects, each with the first offenders.
  homeomorphism::MeshDiagnostics Problems;
  /// Cell ids of all triangles that are invalid, ascending, if the rest makes a pair; else of those
  /// that the problems name.
  std::vector<vtkIdType> InvalidTriangles;
  std::array<MeshReport, 2> Meshes;
  /// Whether the target is a mirror image.
  bool Mirrored = false;
  /// Triangles wound otherwise than most of their component, in both meshes alike, which is mended.
  vtkIdType MendedWindings = 0;
  /// Triangles whose three points come in another order in the target, which is mended, too.
  vtkIdType ReorderedTriangles = 0;
  vtkIdType Components = 0;
  vtkIdType InteriorEdges = 0;
  vtkIdType BoundaryEdges = 0;
  vtkIdType BoundaryLoops = 0;
  /// Of the linear map of a triangle onto its counterpart: the largest and the smallest factor by
  /// which it changes lengths, and the largest ratio of the two.
  Extreme LargestStretch;
  Extreme SmallestStretch;
  Extreme WorstDistortion;
  /// Whether the map could be measured; see SystemReport.
  bool Measured = false;
  std::array<SystemReport, 3> Systems;
};

/// What CheckPair does besides the meshes themselves.
struct CheckExtent
{
  bool Determinants = true;
  bool Continuity = true;
};

/// Checks a pair. Invalid triangles are left out of the measurements. All but what takes long, the
/// measurements of the map, is shown to @a onMeshes before these begin.
PairReport CheckPair(const MeshPair& pair, const CheckExtent& extent,
  const std::function<void(const PairReport& report)>& onMeshes);

/// Whether hardly any triangles share an edge though points of both meshes are in the places of
/// others: as if each triangle had points of its own.
bool IsUnwelded(const PairReport& report);

/// Throws Failure, naming what is wrong, if the pair defines no map, not even without its invalid
/// triangles if these are left out.
void RequireMap(const MeshPair& pair, const MapOptions& map);
/// The same where no triangle can be left out.
void RequireMap(const MeshPair& pair);

/// A defect as a sentence, in which the program's options have their own names. @a advice says how
/// triangles are left out, if they can be.
std::string Describe(const homeomorphism::MeshDiagnostic& problem, const std::string& advice);

} // namespace dhm

#endif
