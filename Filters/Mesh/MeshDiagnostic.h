// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshDiagnostic.h
/// What can be wrong with a triangulation or a pair of them, and how a user is told.

#ifndef homeomorphism_MeshDiagnostic_h
#define homeomorphism_MeshDiagnostic_h

#include "vtkType.h"

#include <string>
#include <vector>

namespace homeomorphism
{

/// A defect of one kind: how often it occurs, and where first.
struct MeshDiagnostic
{
  enum class Kind
  {
    PointCountsDiffer,
    CellCountsDiffer,
    TooManyTriangles,
    NotTriangles,
    BadConnectivity,
    ConnectivityDiffers,
    RepeatedCorner,
    NotFinite,
    DegenerateTriangle,
    NonManifoldEdge,
    NonOrientable,
    Flipped,
    Overlapping,
    Discordant,
    NotPlanar
  };

  /// What happened to the triangles concerned.
  enum class Outcome
  {
    /// The meshes were refused.
    Refused,
    /// The triangles were taken out (MaskInvalidTriangles).
    Masked,
    /// The triangles are carried by the Linear system (DiscordantTriangles).
    MappedByLinear
  };

  /// How many ids a message lists.
  static constexpr std::size_t MaximumIds = 10;

  Kind What = Kind::NotTriangles;
  /// "source", "target", "triangulation", or "pair" where the two meshes disagree.
  std::string Where;
  /// Number of offenders.
  vtkIdType Count = 0;
  /// Cell ids of the first offenders, ascending, at most MaximumIds.
  std::vector<vtkIdType> FirstCells;
  Outcome Result = Outcome::Refused;
  /// Further facts, such as the two counts that differ.
  std::string Details;

  /// One or two sentences: what is wrong, how many times, which cells, and what to do about it.
  std::string Message() const;
};

using MeshDiagnostics = std::vector<MeshDiagnostic>;

/// The first of @a count ids, for messages: "1, 2, 5", or "1, 2, 5, ..." if there are more.
std::string ListIds(const std::vector<vtkIdType>& firstIds, vtkIdType count);

/// True if one of the problems made the meshes be refused.
bool IsRefused(const MeshDiagnostics& problems);

} // namespace homeomorphism

#endif
