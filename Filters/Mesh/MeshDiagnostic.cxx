// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MeshDiagnostic.h"

#include <algorithm>
#include <sstream>

namespace homeomorphism
{
namespace
{

/// The sentence's end, after "3 triangles of the source (cells 1, 2, 5) ".
const char* Fault(MeshDiagnostic::Kind kind, bool one)
{
  using Kind = MeshDiagnostic::Kind;
  switch (kind)
  {
    case Kind::BadConnectivity:
      return one ? "refers to points that do not exist" : "refer to points that do not exist";
    case Kind::ConnectivityDiffers:
      return one ? "has different points in the source and in the target"
                 : "have different points in the source and in the target";
    case Kind::RepeatedCorner:
      return one ? "uses the same point twice" : "use the same point twice";
    case Kind::NotFinite:
      return one ? "has a coordinate that is not finite" : "have coordinates that are not finite";
    case Kind::DegenerateTriangle:
      return one ? "has no area" : "have no area";
    case Kind::NonManifoldEdge:
      return one ? "lies at an edge that has more than two triangles"
                 : "lie at edges that have more than two triangles";
    case Kind::NonOrientable:
      return one ? "cannot be wound consistently with its neighbors (the surface has one side only)"
                 : "cannot be wound consistently with their neighbors (the surface has one side "
                   "only)";
    case Kind::Flipped:
      return one ? "is flipped between source and target relative to the rest"
                 : "are flipped between source and target relative to the rest";
    case Kind::Overlapping:
      return one ? "overlaps another triangle" : "overlap other triangles";
    case Kind::Discordant:
      return one ? "is discordant: the foot of a center segment is not inside its edge, so the "
                   "Contour system does not exist there"
                 : "are discordant: the foot of a center segment is not inside its edge, so the "
                   "Contour system does not exist there";
    default:
      return "";
  }
}

const char* Advice(MeshDiagnostic::Kind kind)
{
  using Kind = MeshDiagnostic::Kind;
  switch (kind)
  {
    case Kind::PointCountsDiffer:
    case Kind::CellCountsDiffer:
      return "Source and target must be the same mesh with different point coordinates.";
    case Kind::TooManyTriangles:
      return "Split the meshes.";
    case Kind::NotTriangles:
      return "Triangulate the source (vtkTriangleFilter) and give the target the source's cells, "
             "so that both are cut along the same diagonals.";
    case Kind::BadConnectivity:
      return "The mesh is corrupt: read or build it again.";
    case Kind::ConnectivityDiffers:
      return "Give the target the source's cells, with its own point coordinates in the same "
             "order.";
    case Kind::RepeatedCorner:
    case Kind::NotFinite:
    case Kind::DegenerateTriangle:
    case Kind::NonManifoldEdge:
    case Kind::Overlapping:
      return "Repair or remove them in both meshes, or turn MaskInvalidTriangles on to leave them "
             "out.";
    case Kind::NonOrientable:
      return "Cut the surface open along a line of edges in both meshes.";
    case Kind::Flipped:
      return "Move their points so that all triangles keep their orientation (or all are "
             "mirrored), or turn MaskInvalidTriangles on to leave them out.";
    case Kind::Discordant:
      return "Use the Smooth system, which takes any triangle, or let the Linear system carry them "
             "(DiscordantTriangles).";
    case Kind::NotPlanar:
      return "Use the Smooth system, which maps surfaces too.";
  }
  return "";
}

} // namespace

std::string ListIds(const std::vector<vtkIdType>& firstIds, vtkIdType count)
{
  std::string text;
  for (const vtkIdType id : firstIds)
  {
    text += (text.empty() ? "" : ", ") + std::to_string(id);
  }
  return text + (count > static_cast<vtkIdType>(firstIds.size()) ? ", ..." : "");
}

std::string MeshDiagnostic::Message() const
{
  std::ostringstream text;
  if (this->What == Kind::PointCountsDiffer || this->What == Kind::CellCountsDiffer ||
    this->What == Kind::TooManyTriangles || this->What == Kind::NotPlanar)
  {
    text << this->Details;
  }
  else
  {
    const bool one = this->Count == 1;
    const bool cells = this->What == Kind::NotTriangles;
    text << this->Count << (cells ? " cell" : " triangle") << (one ? "" : "s") << " of the "
         << this->Where << (one ? " (cell " : " (cells ");
    text << ListIds(this->FirstCells, this->Count) << ") ";
    if (cells)
    {
      text << (one ? "is not a triangle" : "are not triangles") << " (" << this->Details << ")";
    }
    else
    {
      text << Fault(this->What, one);
    }
  }
  switch (this->Result)
  {
    case Outcome::Refused:
      text << ". " << Advice(this->What);
      break;
    case Outcome::Masked:
      text << "; left out, as MaskInvalidTriangles asks.";
      break;
    case Outcome::MappedByLinear:
      text << "; carried by the Linear system, as DiscordantTriangles asks.";
      break;
  }
  return text.str();
}

bool IsRefused(const MeshDiagnostics& problems)
{
  return std::any_of(problems.begin(), problems.end(), [](const MeshDiagnostic& problem) {
    return problem.Result == MeshDiagnostic::Outcome::Refused;
  });
}

} // namespace homeomorphism
