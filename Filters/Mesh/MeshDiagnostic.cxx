// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MeshDiagnostic.h"

#include <algorithm>

namespace homeomorphism
{

MeshDiagnostic::Remedy MeshDiagnostic::GetRemedy() const
{
  switch (this->What)
  {
    case Kind::PointCountsDiffer:
    case Kind::CellCountsDiffer:
      return Remedy::UseSameMesh;
    case Kind::TooManyTriangles:
      return Remedy::SplitMeshes;
    case Kind::NotTriangles:
    case Kind::TriangleStrips:
      return Remedy::Triangulate;
    case Kind::BadConnectivity:
      return Remedy::ReadAgain;
    case Kind::ConnectivityDiffers:
      return Remedy::UseSourceCells;
    case Kind::RepeatedCorner:
    case Kind::NotFinite:
    case Kind::DegenerateTriangle:
    case Kind::NonManifoldEdge:
    case Kind::Overlapping:
      return Remedy::RepairOrMask;
    case Kind::NonOrientable:
      return Remedy::CutOpen;
    case Kind::Flipped:
      return Remedy::MovePointsOrMask;
    case Kind::Discordant:
      return Remedy::UseOtherSystem;
    case Kind::NotPlanar:
      return Remedy::UseSmoothSystem;
    case Kind::TooManyRefined:
      return Remedy::RefineLess;
    case Kind::NearlyPlanar:
      break;
  }
  return Remedy::FlattenOrUseTolerance;
}

bool IsRefused(const MeshDiagnostics& diagnostics)
{
  return std::any_of(diagnostics.begin(), diagnostics.end(), [](const MeshDiagnostic& diagnostic) {
    return diagnostic.Result == MeshDiagnostic::Outcome::Refused;
  });
}

} // namespace homeomorphism
