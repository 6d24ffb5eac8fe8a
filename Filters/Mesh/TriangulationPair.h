// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TriangulationPair.h
/// Two isomorphic triangulations, read and validated.

#ifndef homeomorphism_TriangulationPair_h
#define homeomorphism_TriangulationPair_h

#include "MeshDiagnostic.h"
#include "MeshGeometry.h"
#include "PointLocation.h"
#include "Triangulation.h"

#include <array>
#include <memory>

class vtkPolyData;

namespace homeomorphism
{

/// The two meshes of a pair, and their domains.
enum class Domain
{
  Source = 0,
  Target = 1
};

inline Domain Opposite(Domain domain)
{
  return domain == Domain::Source ? Domain::Target : Domain::Source;
}

/// An immutable triangulation with one or two geometries. Any number of threads may use it.
class TriangulationPair
{
public:
  /// Reads and validates the meshes. If @a target is null, there is only the source.
  ///
  /// Defects are added to @a diagnostics. Returns null if the meshes are refused because of them.
  /// With @a maskInvalidTriangles, triangles that are defective by themselves are left out instead.
  static std::shared_ptr<const TriangulationPair> Read(vtkPolyData* source, vtkPolyData* target,
    bool maskInvalidTriangles, MeshDiagnostics& diagnostics);

  const Triangulation& GetTriangulation() const { return *this->Topology; }
  bool HasTarget() const { return this->Geometries[1] != nullptr; }
  const MeshGeometry& GetGeometry(Domain domain) const { return *this->Geometries[int(domain)]; }
  /// The pair with source and target exchanged. It shares all data with this pair.
  std::shared_ptr<const TriangulationPair> Inverted() const;
  const PointLocation& GetLocation(Domain domain) const { return *this->Locations[int(domain)]; }

private:
  TriangulationPair() = default;

  class Builder;

  std::shared_ptr<Triangulation> Topology = std::make_shared<Triangulation>();
  std::array<std::shared_ptr<MeshGeometry>, 2> Geometries;
  std::array<std::shared_ptr<PointLocation>, 2> Locations;
};

} // namespace homeomorphism

#endif
