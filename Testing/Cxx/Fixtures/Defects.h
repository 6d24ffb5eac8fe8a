// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Defects.h
/// The diagnostics of meshes as values that a test can compare.

#ifndef fixtures_Defects_h
#define fixtures_Defects_h

#include "Meshes.h"

#include "Mesh/Homeomorphism.h"
#include "Pipeline/DiagnosticMessages.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <numeric>
#include <ostream>
#include <vector>

namespace fixtures
{

using homeomorphism::MeshDiagnostic;
using Kind = MeshDiagnostic::Kind;
using Where = MeshDiagnostic::Mesh;
using Outcome = MeshDiagnostic::Outcome;
using Remedy = MeshDiagnostic::Remedy;
using Ids = std::vector<vtkIdType>;

/// What a diagnostic names: the defect, the mesh and the cells.
struct Defect
{
  Kind What;
  Where Mesh;
  Ids Cells;

  bool operator==(const Defect& other) const
  {
    return this->What == other.What && this->Mesh == other.Mesh && this->Cells == other.Cells;
  }
};

inline void PrintTo(const Defect& defect, std::ostream* os)
{
  *os << homeomorphism::GetName(defect.What) << " in " << homeomorphism::GetName(defect.Mesh)
      << ::testing::PrintToString(defect.Cells);
}

/// The ids from one to another.
inline Ids Range(vtkIdType first, vtkIdType last)
{
  Ids ids(static_cast<std::size_t>(last - first + 1));
  std::iota(ids.begin(), ids.end(), first);
  return ids;
}

/// What happens to a pair, or to a triangulation if there is no target: the map, if there is one,
/// and the diagnostics.
struct Reading
{
  std::shared_ptr<const homeomorphism::Homeomorphism> Map;
  homeomorphism::MeshDiagnostics Diagnostics;

  std::vector<Defect> Defects() const
  {
    std::vector<Defect> defects;
    for (const MeshDiagnostic& one : this->Diagnostics)
    {
      defects.push_back({ one.What, one.Where, one.Ids });
    }
    return defects;
  }
};

inline Reading Read(vtkPolyData* source, vtkPolyData* target = nullptr,
  const homeomorphism::HomeomorphismOptions& options = {})
{
  Reading reading;
  reading.Map = homeomorphism::Homeomorphism::Make(source, target, options, reading.Diagnostics);
  return reading;
}

inline Reading Read(const MeshPair& pair, const homeomorphism::HomeomorphismOptions& options = {})
{
  return Read(pair.Source, pair.Target, options);
}

/// The meshes are refused with these defects, each of which has the remedy that belongs to it.
inline void ExpectRefused(const Reading& reading, const std::vector<Defect>& defects, Remedy remedy)
{
  EXPECT_FALSE(reading.Map);
  EXPECT_EQ(reading.Defects(), defects);
  for (const MeshDiagnostic& one : reading.Diagnostics)
  {
    EXPECT_EQ(one.Result, Outcome::Refused);
    EXPECT_EQ(one.GetRemedy(), remedy);
  }
}

inline void ExpectAccepted(const Reading& reading)
{
  EXPECT_TRUE(reading.Map);
  EXPECT_EQ(reading.Defects(), std::vector<Defect>());
}

/// A defect that either mesh can have is found in the source, in the target and in a mesh alone.
inline void ExpectRefusedInEachMesh(const MeshPair& valid,
  const std::function<void(vtkPolyData*)>& damage, Kind kind, const Ids& cells,
  Remedy remedy = Remedy::RepairOrMask)
{
  for (const bool inSource : { true, false })
  {
    MeshPair pair{ vtkSmartPointer<vtkPolyData>::New(), vtkSmartPointer<vtkPolyData>::New() };
    pair.Source->DeepCopy(valid.Source);
    pair.Target->DeepCopy(valid.Target);
    vtkPolyData* damaged = inSource ? pair.Source : pair.Target;
    damage(damaged);
    ExpectRefused(
      Read(pair), { { kind, inSource ? Where::Source : Where::Target, cells } }, remedy);
    ExpectRefused(Read(damaged), { { kind, Where::Triangulation, cells } }, remedy);
  }
}

} // namespace fixtures

#endif
