// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Defects.h
/// The diagnostics of meshes as values that a test can compare.

#ifndef fixtures_Defects_h
#define fixtures_Defects_h

#include "FilterRuns.h"

#include "Mesh/Homeomorphism.h"
#include "Pipeline/DiagnosticMessages.h"

#include <memory>
#include <numeric>

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

  Ids Masked() const
  {
    Ids masked;
    const auto& triangulation = this->Map->GetPair().GetTriangulation();
    for (homeomorphism::TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
    {
      if (triangulation.IsMasked(t))
      {
        masked.push_back(t);
      }
    }
    return masked;
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

/// With MaskInvalidTriangles.
inline Reading ReadMasked(const MeshPair& pair)
{
  homeomorphism::HomeomorphismOptions options;
  options.MaskInvalidTriangles = true;
  return Read(pair, options);
}

/// The meshes are refused with these defects, each of which has the remedy that belongs to it.
inline void ExpectRefused(
  const Reading& reading, const std::vector<Defect>& defects, Remedy remedy = Remedy::RepairOrMask)
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

/// With MaskInvalidTriangles the defects are found, exactly their cells are masked, and the rest is
/// mapped as if they had been removed from the meshes.
inline void ExpectMasked(const MeshPair& pair, const std::vector<Defect>& defects)
{
  const Reading reading = ReadMasked(pair);
  ASSERT_TRUE(reading.Map);
  EXPECT_EQ(reading.Defects(), defects);
  std::set<vtkIdType> masked;
  for (const MeshDiagnostic& one : reading.Diagnostics)
  {
    EXPECT_EQ(one.Result, Outcome::Masked);
    masked.insert(one.Ids.begin(), one.Ids.end());
  }
  EXPECT_EQ(reading.Masked(), Ids(masked.begin(), masked.end()));
  const std::vector<Triangle> triangles = TrianglesOf(pair.Source);
  std::vector<Triangle> rest;
  for (vtkIdType t = 0; t < static_cast<vtkIdType>(triangles.size()); ++t)
  {
    if (masked.count(t) == 0)
    {
      rest.push_back(triangles[t]);
    }
  }
  const MeshPair pierced = WithTriangles(pair, rest);
  for (const bool inverse : { false, true })
  {
    vtkPolyData* from = inverse ? pair.Target : pair.Source;
    std::vector<Point> points;
    Ids expectedTriangles;
    for (vtkIdType t = 0; t < static_cast<vtkIdType>(triangles.size()); ++t)
    {
      // In others, points are in a neighbor across an edge, too.
      const double area = Norm(NormalOf(from, t));
      if (std::isfinite(area) && area > 1e-6)
      {
        const std::vector<Point> inside = SamplePoints(from, { triangles[t] }, 4, t);
        points.insert(points.end(), inside.begin(), inside.end());
        expectedTriangles.insert(expectedTriangles.end(), 4, masked.count(t) > 0 ? -1 : t);
      }
    }
    for (const System& system : { Linear, Contour, Smooth })
    {
      const MappedPoints expected = MapPoints(pierced, points, { system, false, inverse });
      const MappedPoints mapped = MapPoints(pair, points, { system, true, inverse });
      ASSERT_EQ(expected.Error + expected.Warning + mapped.Error, "");
      EXPECT_NE(mapped.Warning, "");
      EXPECT_EQ(mapped.Triangles, expectedTriangles);
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        EXPECT_EQ(expected.IsInside(i), mapped.IsInside(i));
        EXPECT_LE(Distance(expected.Images[i], mapped.Images[i]), 1e-14) << system.Name;
      }
    }
  }
}

/// A defect that either mesh can have is found in the source, in the target and in a mesh alone,
/// and masked where that is a remedy.
inline void ExpectFoundInEachMesh(const MeshPair& valid,
  const std::function<void(vtkPolyData*)>& damage, Kind kind, const Ids& cells,
  Remedy remedy = Remedy::RepairOrMask)
{
  for (const bool inSource : { true, false })
  {
    const MeshPair pair = CopyOf(valid);
    vtkPolyData* damaged = inSource ? pair.Source : pair.Target;
    damage(damaged);
    const std::vector<Defect> defects{ { kind, inSource ? Where::Source : Where::Target, cells } };
    ExpectRefused(Read(pair), defects, remedy);
    ExpectRefused(Read(damaged), { { kind, Where::Triangulation, cells } }, remedy);
    if (remedy == Remedy::RepairOrMask)
    {
      ExpectMasked(pair, defects);
    }
  }
}

} // namespace fixtures

#endif
