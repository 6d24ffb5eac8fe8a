// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshDiagnostic.h
/// Defects of a triangulation, or of a pair of triangulations, as data.
/// Pipeline/DiagnosticMessages.h puts them into words.

#ifndef homeomorphism_MeshDiagnostic_h
#define homeomorphism_MeshDiagnostic_h

#include "Vector3.h"

#include "vtkType.h"

#include <array>
#include <limits>
#include <vector>

namespace homeomorphism
{

/// All defects of one kind in one mesh.
struct MeshDiagnostic
{
  enum class Kind
  {
    /// Source and target have different numbers of points. Counts has both.
    PointCountsDiffer,
    /// Source and target have different numbers of triangles. Counts has both.
    CellCountsDiffer,
    /// More polygons or points than can be numbered. Counts has the polygons and the points.
    TooManyTriangles,
    /// Polygons with another number of corners than three.
    NotTriangles,
    /// Triangle strips.
    TriangleStrips,
    /// Triangles that refer to points that do not exist.
    BadConnectivity,
    /// Triangles with different points in source and target.
    ConnectivityDiffers,
    /// Triangles that use a point twice.
    RepeatedCorner,
    /// Triangles with a coordinate that is not finite.
    NotFinite,
    /// Triangles without area.
    DegenerateTriangle,
    /// Triangles at an edge of more than two triangles.
    NonManifoldEdge,
    /// Triangles whose winding contradicts a neighbor's, however triangles are reversed.
    NonOrientable,
    /// Triangles of planar meshes with another orientation change than the majority.
    Flipped,
    /// Triangles of a planar mesh whose interiors meet. Size is the depth of the largest overlap.
    Overlapping,
    /// Triangles for which the Contour system with the centroid does not exist.
    Discordant,
    /// The mesh is a surface, and the Cubic system maps planar meshes only.
    NotPlanar,
    /// The Cubic system with LEAST bending would have more triangles, once refined, than it can
    /// number the unknowns of. Counts has the mesh's triangles and the refined ones.
    TooManyRefined,
    /// The points nearly lie in a plane, but the mesh is treated as a surface. Size is the largest
    /// distance from that plane, Tolerance the relative tolerance that finds points of the plane.
    NearlyPlanar
  };
  static constexpr int NumberOfKinds = int(Kind::NearlyPlanar) + 1;

  /// The mesh with the defect.
  enum class Mesh
  {
    Source,
    Target,
    /// The two meshes disagree. Ids are those of the source.
    Pair,
    /// There is only one mesh.
    Triangulation
  };

  /// What becomes of the triangles or the meshes.
  enum class Outcome
  {
    /// The meshes are refused.
    Refused,
    /// The triangles are masked (MaskInvalidTriangles).
    Masked,
    /// The triangles are mapped by the Linear system (DiscordantTriangles).
    MappedByLinear,
    /// The meshes are accepted.
    Accepted
  };

  /// What a user can do.
  enum class Remedy
  {
    /// Give the same mesh twice, with different point coordinates.
    UseSameMesh,
    /// Split the meshes into smaller ones.
    SplitMeshes,
    /// Triangulate the source and give the target its cells.
    Triangulate,
    /// Read or make the mesh again: it is corrupt.
    ReadAgain,
    /// Give the target the source's cells and its own points in the same order.
    UseSourceCells,
    /// Repair or remove the triangles, or mask them.
    RepairOrMask,
    /// Cut the surface open along a line of edges.
    CutOpen,
    /// Move points so that the triangles keep their orientation, or mask them.
    MovePointsOrMask,
    /// Use the Smooth system, or map the triangles by the Linear system.
    UseOtherSystem,
    /// Use the Smooth system.
    UseSmoothSystem,
    /// Use less FairnessRefinement, or LOCAL bending.
    RefineLess,
    /// Project the mesh to the plane, or use the tolerance.
    FlattenOrUseTolerance
  };

  Kind What = Kind::NotTriangles;
  Mesh Where = Mesh::Source;
  Outcome Result = Outcome::Refused;
  /// Cell ids of all defective triangles, ascending. Empty if a mesh is defective as a whole.
  std::vector<vtkIdType> Ids;
  /// First corner of the first defective triangle, in the input's coordinates. NaN if there is
  /// none.
  Vector3 Position{ NotANumber, NotANumber, NotANumber };
  /// Numbers that differ or are too large; see Kind.
  std::array<vtkIdType, 2> Counts{ 0, 0 };
  /// In the input's units; NaN for kinds without a size.
  double Size = NotANumber;
  /// Relative to the diagonal of the mesh's bounding box, as the filters' Tolerance; NaN for kinds
  /// without a tolerance.
  double Tolerance = NotANumber;

  /// The remedy that belongs to the kind.
  Remedy GetRemedy() const;

private:
  static constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();
};

using MeshDiagnostics = std::vector<MeshDiagnostic>;

/// Whether one of the diagnostics caused the meshes to be refused.
bool IsRefused(const MeshDiagnostics& diagnostics);

} // namespace homeomorphism

#endif
