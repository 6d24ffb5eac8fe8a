// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file HomeomorphismCache.h
/// Keeps a homeomorphism until its meshes or its options change.

#ifndef homeomorphism_HomeomorphismCache_h
#define homeomorphism_HomeomorphismCache_h

#include "Mesh/Homeomorphism.h"

#include "vtkObject.h"
#include "vtkType.h"
#include "vtkWeakPointer.h"

#include <memory>
#include <utility>
#include <vector>

class vtkPolyData;

namespace homeomorphism
{

/// The homeomorphism made last, with what it was made from. Not thread-safe.
class HomeomorphismCache
{
public:
  /// The homeomorphism of these meshes, made anew only if their points or cells (not their other
  /// arrays) or the options changed since. Null if the meshes are refused; see GetProblems.
  std::shared_ptr<const Homeomorphism> Get(
    vtkPolyData* source, vtkPolyData* target, const HomeomorphismOptions& options);

  /// What was found wrong when the homeomorphism was made.
  const MeshDiagnostics& GetProblems() const { return this->Problems; }

  /// How often a homeomorphism was made (or refused).
  vtkIdType GetNumberOfBuilds() const { return this->NumberOfBuilds; }

private:
  /// An object's identity and state. The pointer is weak: the cache keeps no mesh alive, and a new
  /// object at an old address is not mistaken for the old one.
  using Stamp = std::pair<vtkWeakPointer<vtkObject>, vtkMTimeType>;

  static void AddStamps(vtkPolyData* mesh, std::vector<Stamp>& stamps);

  std::shared_ptr<const Homeomorphism> Current;
  std::vector<Stamp> Stamps;
  HomeomorphismOptions Options;
  MeshDiagnostics Problems;
  vtkIdType NumberOfBuilds = 0;
};

} // namespace homeomorphism

#endif
