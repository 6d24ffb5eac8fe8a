// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file HomeomorphismCache.h
/// A cache that keeps a homeomorphism until its meshes or its options change.

#ifndef homeomorphism_HomeomorphismCache_h
#define homeomorphism_HomeomorphismCache_h

#include "Mesh/Homeomorphism.h"

#include "vtkType.h"

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

class vtkPolyData;

namespace homeomorphism
{

/// The last homeomorphism, and the state of its inputs. Not thread-safe, but several caches may use
/// the same meshes in several threads, because a cache neither references nor changes them.
class HomeomorphismCache
{
public:
  /// The homeomorphism of these meshes. It is rebuilt only if their points or cells (not other
  /// arrays) or the options have changed. After coordinates have been overwritten in place,
  /// Modified() must be called on the points or on the mesh. Null if the meshes are refused; see
  /// GetProblems.
  std::shared_ptr<const Homeomorphism> Get(
    vtkPolyData* source, vtkPolyData* target, const HomeomorphismOptions& options);

  /// The defects found when the homeomorphism was built.
  const MeshDiagnostics& GetProblems() const { return this->Problems; }

  /// The number of times a homeomorphism was built or refused.
  vtkIdType GetNumberOfBuilds() const { return this->NumberOfBuilds; }

private:
  /// Address and modification time of an object, or null and a size. Modification times are unique
  /// in VTK, so a new object at an old address is not mistaken for the old one.
  using Stamp = std::pair<const void*, vtkMTimeType>;

  struct MeshState
  {
    std::vector<Stamp> Parts;
    /// The modification times of the meshes themselves, without their parts.
    std::array<vtkMTimeType, 2> Times{};
    /// Hash of all coordinates and point ids.
    std::uint64_t Contents = 0;
  };

  bool HasChanged(vtkPolyData* source, vtkPolyData* target);

  std::shared_ptr<const Homeomorphism> Current;
  MeshState State;
  HomeomorphismOptions Options;
  MeshDiagnostics Problems;
  vtkIdType NumberOfBuilds = 0;
};

} // namespace homeomorphism

#endif
