// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TriangulationPair.h
/// Two isomorphic triangulations, read and validated once.

#ifndef homeomorphism_TriangulationPair_h
#define homeomorphism_TriangulationPair_h

#include "Embedding.h"
#include "MeshProblem.h"
#include "PointLocation.h"
#include "Triangulation.h"

#include <array>
#include <memory>

class vtkPolyData;

namespace homeomorphism
{

/// Which of the two meshes.
enum class Side
{
  Source = 0,
  Target = 1
};

inline Side Opposite(Side side)
{
  return side == Side::Source ? Side::Target : Side::Source;
}

/// An immutable triangulation with one or two embeddings. Any number of threads may use it.
class TriangulationPair
{
public:
  /// Reads and validates. @a target may be null: then there is only the source.
  ///
  /// Defects are added to @a problems. Returns null if they made the meshes be refused; with
  /// @a maskInvalidTriangles, triangles that are defective by themselves are left out instead.
  static std::shared_ptr<const TriangulationPair> Read(
    vtkPolyData* source, vtkPolyData* target, bool maskInvalidTriangles, MeshProblems& problems);

  const Triangulation& GetTriangulation() const { return this->Topology; }
  bool HasTarget() const { return this->Embeddings[1] != nullptr; }
  const Embedding& GetEmbedding(Side side) const { return *this->Embeddings[int(side)]; }
  const PointLocation& GetLocation(Side side) const { return *this->Locations[int(side)]; }

private:
  TriangulationPair() = default;

  class Builder;

  Triangulation Topology;
  std::array<std::unique_ptr<Embedding>, 2> Embeddings;
  std::array<std::unique_ptr<PointLocation>, 2> Locations;
};

} // namespace homeomorphism

#endif
