// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshDiagnostic.h
/// Defects of a triangulation, or of a pair of triangulations, as data.
/// Pipeline/DiagnosticMessages.h converts them to messages.

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
    /// More polygons or points than can be numbered. Counts has their numbers.
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
    /// Triangles at an edge that belongs to more than two triangles.
    NonManifoldEdge,
    /// Triangles whose winding is inconsistent with a neighbor's after all possible reversals.
    NonOrientable,
    /// Triangles of planar meshes that are flipped between source and target, unlike the majority
    /// (or not flipped, if the majority is).
    Flipped,
    /// Triangles of a planar mesh whose interiors meet. Size is the depth of the largest overlap.
    Overlapping,
    /// Triangles in which the Contour system with the centroid is not defined.
    Discordant,
    /// The mesh is a surface; the Cubic system maps only planar meshes.
    NotPlanar,
    /// In the Cubic system with LEAST bending, there would be more triangles after refinement than
    /// it supports. Counts has the numbers of triangles before and after refinement.
    TooManyRefined,
    /// The points lie nearly in a plane, but the mesh is treated as a surface. Size is the largest
    /// distance from that plane, Tolerance the Tolerance with which points of the plane are inside.
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

  /// The treatment of the triangles or the meshes.
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

  /// The action that a user can take.
  enum class Remedy
  {
    /// Use the same mesh twice, with different point coordinates.
    UseSameMesh,
    /// Split the meshes into smaller ones.
    SplitMeshes,
    /// Triangulate the source, and use its cells for the target.
    Triangulate,
    /// Read or create the mesh again, because it is corrupt.
    ReadAgain,
    /// Use the source's cells for the target, with the target's points in the same order.
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
    /// Use a smaller FairnessRefinement, or LOCAL bending.
    RefineLess,
    /// Project the mesh onto the plane, or use the tolerance.
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
  /// The numbers that differ or are too large; see Kind.
  std::array<vtkIdType, 2> Counts{ 0, 0 };
  /// See Kind; in the input's units. NaN for kinds without a size.
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
