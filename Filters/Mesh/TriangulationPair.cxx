// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "TriangulationPair.h"

#include "MeshValidation.h"

#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace homeomorphism
{

/// Builds a pair step by step. Each step relies on the checks of the previous ones.
class TriangulationPair::Builder
{
public:
  Builder(vtkPolyData* source, vtkPolyData* target, bool maskInvalidTriangles,
    MeshDiagnostics& diagnostics)
    : Meshes{ source, target }
    , Names{ target ? MeshDiagnostic::Mesh::Source : MeshDiagnostic::Mesh::Triangulation,
      MeshDiagnostic::Mesh::Target }
    , MaskInvalidTriangles(maskInvalidTriangles)
    , Diagnostics(diagnostics)
    , Pair(new TriangulationPair)
  {
  }

  std::shared_ptr<const TriangulationPair> Build()
  {
    this->ReadTopology();
    // Masked triangles do not affect the plane or the size of the domain, so after masking all
    // steps are repeated.
    do
    {
      this->HasMasked = false;
      if (!IsRefused(this->Diagnostics))
      {
        this->ReadGeometry();
      }
      if (!IsRefused(this->Diagnostics))
      {
        this->FindAdjacency();
      }
      if (!IsRefused(this->Diagnostics))
      {
        this->ExcludeOverlaps();
      }
    } while (this->HasMasked && !IsRefused(this->Diagnostics));
    if (IsRefused(this->Diagnostics))
    {
      return nullptr;
    }
    for (int domain = 0; domain < 2 && this->Meshes[domain]; ++domain)
    {
      this->Pair->Geometries[domain]->ComputeFrames(*this->Pair->Topology);
      this->Pair->Locations[domain]->FillSeeds();
      this->ReportNearlyPlanar(domain);
    }
    return std::shared_ptr<const TriangulationPair>(std::move(this->Pair));
  }

private:
  /// Masks or refuses triangles, and returns whether there were any. Of a pair's defects, the ids
  /// are those of the source's cells.
  bool Exclude(MeshDiagnostic::Kind kind, int domain, MeshDiagnostic::Mesh where,
    const TriangleList& triangles, double size = std::numeric_limits<double>::quiet_NaN())
  {
    if (triangles.empty())
    {
      return false;
    }
    MeshDiagnostic diagnostic;
    diagnostic.What = kind;
    diagnostic.Where = where;
    diagnostic.Size = size;
    // No single triangle makes a surface non-orientable.
    const bool mask = this->MaskInvalidTriangles && kind != MeshDiagnostic::Kind::NonOrientable;
    diagnostic.Result = mask ? MeshDiagnostic::Outcome::Masked : MeshDiagnostic::Outcome::Refused;
    const vtkIdType firstCell = FirstPolygon(this->Meshes[domain]);
    diagnostic.Ids.reserve(triangles.size());
    for (const TriangleIndex t : triangles)
    {
      diagnostic.Ids.push_back(firstCell + t);
      if (mask)
      {
        this->Pair->Topology->Mask(t);
        this->HasMasked = true;
      }
    }
    if (this->Meshes[domain]->GetPoints())
    {
      const Triangulation::Corners& corners = this->Pair->Topology->GetCorners(triangles.front());
      this->Meshes[domain]->GetPoint(corners[0], diagnostic.Position.data());
    }
    this->Diagnostics.push_back(std::move(diagnostic));
    return true;
  }

  /// Reports a surface that was probably meant to be planar, and the tolerance that it needs. The
  /// surface is accepted.
  void ReportNearlyPlanar(int domain)
  {
    const MeshGeometry& geometry = *this->Pair->Geometries[domain];
    if (geometry.GetThickness() == 0.0)
    {
      return;
    }
    MeshDiagnostic diagnostic;
    diagnostic.What = MeshDiagnostic::Kind::NearlyPlanar;
    diagnostic.Where = this->Names[domain];
    diagnostic.Result = MeshDiagnostic::Outcome::Accepted;
    diagnostic.Size = geometry.GetThickness() / geometry.GetScale();
    // A power of ten, with a margin for the rounding of points.
    diagnostic.Tolerance =
      std::pow(10.0, std::ceil(std::log10(2.0 * geometry.GetThickness() / geometry.GetDiagonal())));
    this->Diagnostics.push_back(diagnostic);
  }

  void ReadTopology()
  {
    LargeArray<Triangulation::Corners> triangles =
      ReadTriangles(this->Meshes[0], this->Names[0], this->Diagnostics);
    LargeArray<Triangulation::Corners> others;
    if (this->Meshes[1])
    {
      others = ReadTriangles(this->Meshes[1], this->Names[1], this->Diagnostics);
      if (!IsRefused(this->Diagnostics))
      {
        CompareConnectivity(this->Meshes[0], this->Meshes[1], triangles, others, this->Diagnostics);
      }
    }
    if (IsRefused(this->Diagnostics))
    {
      return;
    }
    Triangulation& topology = *this->Pair->Topology;
    topology.SetTriangles(std::move(triangles), FirstPolygon(this->Meshes[0]), std::move(others));
    for (vtkPolyData* mesh : this->Meshes)
    {
      // Blanked triangles are not part of the mesh and are not reported.
      for (const TriangleIndex t : mesh ? FindBlanked(mesh, topology) : TriangleList())
      {
        topology.Mask(t);
      }
    }
    this->Exclude(
      MeshDiagnostic::Kind::RepeatedCorner, 0, this->Names[0], FindRepeatedCorners(topology));
  }

  void ReadGeometry()
  {
    const Triangulation& topology = *this->Pair->Topology;
    const vtkNew<vtkPoints> none;
    // The second geometry depends on the first, which must belong to the same pass.
    this->Pair->Geometries = {};
    for (int domain = 0; domain < 2 && this->Meshes[domain]; ++domain)
    {
      vtkPoints* points = this->Meshes[domain]->GetPoints();
      this->Pair->Geometries[domain] = std::make_shared<MeshGeometry>(
        points ? points : none.Get(), topology, this->Pair->Geometries[0].get());
      const MeshGeometry& geometry = *this->Pair->Geometries[domain];
      if (this->Exclude(MeshDiagnostic::Kind::NotFinite, domain, this->Names[domain],
            FindNotFinite(topology, geometry)) &&
        !this->MaskInvalidTriangles)
      {
        // Areas are undefined then.
        continue;
      }
      this->Exclude(MeshDiagnostic::Kind::DegenerateTriangle, domain, this->Names[domain],
        FindDegenerate(topology, geometry));
    }
    const bool planar = this->Pair->Geometries[0]->IsPlanar() &&
      (!this->Meshes[1] || this->Pair->Geometries[1]->IsPlanar());
    for (const auto& geometry : this->Pair->Geometries)
    {
      if (geometry)
      {
        geometry->SetColumnar(planar);
      }
    }
    if (planar && this->Meshes[1] && !IsRefused(this->Diagnostics))
    {
      this->Exclude(MeshDiagnostic::Kind::Flipped, 0, MeshDiagnostic::Mesh::Pair,
        FindFlipped(topology, *this->Pair->Geometries[0], *this->Pair->Geometries[1]));
    }
  }

  void FindAdjacency()
  {
    Triangulation& topology = *this->Pair->Topology;
    const vtkIdType numberOfPoints = this->Meshes[0]->GetNumberOfPoints();
    if (this->Exclude(MeshDiagnostic::Kind::NonManifoldEdge, 0, this->Names[0],
          topology.FindAdjacency(numberOfPoints)) &&
      this->MaskInvalidTriangles)
    {
      topology.FindAdjacency(numberOfPoints);
    }
    this->Exclude(
      MeshDiagnostic::Kind::NonOrientable, 0, this->Names[0], topology.FindNonOrientable());
  }

  void ExcludeOverlaps()
  {
    Triangulation& topology = *this->Pair->Topology;
    for (int domain = 0; domain < 2 && this->Meshes[domain]; ++domain)
    {
      const MeshGeometry& geometry = *this->Pair->Geometries[domain];
      this->Pair->Locations[domain] = std::make_shared<PointLocation>(topology, geometry);
      if (!geometry.IsPlanar())
      {
        continue;
      }
      const Overlaps overlaps = FindOverlapping(topology, geometry, *this->Pair->Locations[domain]);
      this->Pair->Locations[domain]->SetOverlapping(overlaps.WithinRounding);
      if (this->Exclude(MeshDiagnostic::Kind::Overlapping, domain, this->Names[domain],
            overlaps.Triangles, overlaps.Depth / geometry.GetScale()) &&
        this->MaskInvalidTriangles)
      {
        // Triangles masked so far are removed from the other mesh, too, before it is checked.
        topology.FindAdjacency(this->Meshes[0]->GetNumberOfPoints());
      }
    }
  }

  std::array<vtkPolyData*, 2> Meshes;
  std::array<MeshDiagnostic::Mesh, 2> Names;
  bool MaskInvalidTriangles;
  bool HasMasked = false;
  MeshDiagnostics& Diagnostics;
  std::unique_ptr<TriangulationPair> Pair;
};

std::shared_ptr<const TriangulationPair> TriangulationPair::Read(
  vtkPolyData* source, vtkPolyData* target, bool maskInvalidTriangles, MeshDiagnostics& diagnostics)
{
  return Builder(source, target, maskInvalidTriangles, diagnostics).Build();
}

std::shared_ptr<const TriangulationPair> TriangulationPair::Inverted() const
{
  std::shared_ptr<TriangulationPair> result(new TriangulationPair(*this));
  std::swap(result->Geometries[0], result->Geometries[1]);
  std::swap(result->Locations[0], result->Locations[1]);
  return result;
}

} // namespace homeomorphism
