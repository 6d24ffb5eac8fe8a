// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ChartedTriangulation.h"

#include "Kernel/Simd/EdgeBatch.h"

#include "vtkSMPTools.h"

#include <utility>

namespace homeomorphism
{
namespace
{

/// The triangle on one side of an edge as the neighbor of the other. The view from an edge is
/// invariant under unfolding about that edge.
EdgeView Unfolded(const EdgeView& view, const Twin& across)
{
  return across.SameDirection ? view : Reversed(view);
}

/// Computes the strips of edges of a plane in batches.
class StripMaker
{
public:
  StripMaker(
    const Triangulation& triangulation, const MeshGeometry& geometry, StripArray& strips, int mesh)
    : Topology(triangulation)
    , Geometry(geometry)
    , Strips(strips)
    , Mesh(mesh)
  {
  }

  void Add(TriangleIndex triangle, int edge, const Twin& across)
  {
    const int i = this->Count++;
    const Triangulation::Corners& corners = this->Topology.GetCorners(triangle);
    const Triangulation::Corners& others = this->Topology.GetCorners(across.Triangle);
    const Vector2& start = this->Geometry.GetPlanePoint(corners[NextCorner(edge)]);
    const Vector2& end = this->Geometry.GetPlanePoint(corners[PreviousCorner(edge)]);
    this->First.Set(i, triangle, edge, start, end, this->Geometry.GetPlanePoint(corners[edge]));
    const bool turned = !across.SameDirection;
    this->Turned[i] = turned;
    this->Second.Set(i, across.Triangle, across.Edge, turned ? end : start, turned ? start : end,
      this->Geometry.GetPlanePoint(others[across.Edge]));
    if (this->Count == EdgeBatchSize)
    {
      this->Finish();
    }
  }

  void Finish()
  {
    this->First.Look(this->Turned, this->Count);
    this->Second.Look(this->Turned, this->Count);
    MakeSmoothStrips(this->First.Views, this->Second.Unfolded, this->Count, this->Made);
    this->First.Write(this->Made, this->Count, this->Strips, this->Mesh);
    MakeSmoothStrips(this->Second.Views, this->First.Unfolded, this->Count, this->Made);
    this->Second.Write(this->Made, this->Count, this->Strips, this->Mesh);
    this->Count = 0;
  }

private:
  /// The triangles on one side of the edges.
  struct OneSide
  {
    TriangleIndex Triangles[EdgeBatchSize];
    int Edges[EdgeBatchSize];
    PointBatch Starts;
    PointBatch Ends;
    PointBatch Opposites;
    ViewBatch Views;
    /// Their edges in the triangles on the other side.
    ViewBatch Unfolded;

    void Set(int i, TriangleIndex triangle, int edge, const Vector2& start, const Vector2& end,
      const Vector2& opposite)
    {
      this->Triangles[i] = triangle;
      this->Edges[i] = edge;
      this->Starts.Set(i, start);
      this->Ends.Set(i, end);
      this->Opposites.Set(i, opposite);
    }

    void Look(const bool* turned, int count)
    {
      ViewFromEdges(this->Starts, this->Ends, this->Opposites, count, this->Views);
      for (int i = 0; i < count; ++i)
      {
        // The same operations as in Reversed.
        this->Unfolded.Length[i] = this->Views.Length[i];
        this->Unfolded.Foot[i] = turned[i] ? 1.0 - this->Views.Foot[i] : this->Views.Foot[i];
        this->Unfolded.Height[i] = this->Views.Height[i];
      }
    }

    void Write(const SmoothStrip* made, int count, StripArray& strips, int mesh) const
    {
      for (int i = 0; i < count; ++i)
      {
        strips.Get(this->Triangles[i], mesh)[this->Edges[i] * strips.GetStride()] = made[i];
      }
    }
  };

  const Triangulation& Topology;
  const MeshGeometry& Geometry;
  StripArray& Strips;
  int Mesh;
  int Count = 0;
  bool Turned[EdgeBatchSize];
  OneSide First;
  OneSide Second;
  SmoothStrip Made[EdgeBatchSize];
};

/// Computes the strips of all triangles. Each edge is visited once, for both of its triangles.
void MakeStrips(
  const Triangulation& triangulation, const MeshGeometry& geometry, StripArray& strips, int mesh)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  const auto strip = [&](TriangleIndex t, int edge) -> SmoothStrip& {
    return strips.Get(t, mesh)[edge * strips.GetStride()];
  };
  const auto makeBoth = [&](TriangleIndex t, int k, const Twin& across) {
    const EdgeView own = geometry.GetView(triangulation.GetCorners(t), k);
    const EdgeView other = geometry.GetView(triangulation.GetCorners(across.Triangle), across.Edge);
    strip(t, k) = SmoothStrip(own, Unfolded(other, across));
    strip(across.Triangle, across.Edge) = SmoothStrip(other, Unfolded(own, across));
  };
  vtkSMPTools::For(0, count, [&](vtkIdType begin, vtkIdType end) {
    StripMaker maker(triangulation, geometry, strips, mesh);
    for (auto t = static_cast<TriangleIndex>(begin); t < end; ++t)
    {
      for (int k = 0; k < 3; ++k)
      {
        const Twin across = triangulation.GetTwin(t, k);
        if (across.Triangle < 0)
        {
          strip(t, k) = SmoothStrip();
        }
        else if (across.Triangle > t)
        {
          if (geometry.IsPlanar())
          {
            maker.Add(t, k, across);
          }
          else
          {
            makeBoth(t, k, across);
          }
        }
      }
    }
    maker.Finish();
  });
}

} // namespace

std::array<Neighbor, 3> UnfoldNeighbors(
  const Triangulation& triangulation, const MeshGeometry& geometry, TriangleIndex triangle)
{
  std::array<Neighbor, 3> neighbors;
  for (int k = 0; k < 3; ++k)
  {
    const Twin across = triangulation.GetTwin(triangle, k);
    if (across.Triangle < 0)
    {
      continue;
    }
    const EdgeView view = geometry.GetView(triangulation.GetCorners(across.Triangle), across.Edge);
    neighbors[k] = { true, Unfolded(view, across) };
  }
  return neighbors;
}

std::vector<TriangleIndex> FindDiscordant(
  const Triangulation& triangulation, const MeshGeometry& geometry)
{
  std::vector<TriangleIndex> discordant;
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    if (!triangulation.IsMasked(t) && !geometry.IsConcordant(triangulation.GetCorners(t)))
    {
      discordant.push_back(t);
    }
  }
  return discordant;
}

ChartedTriangulation::ChartedTriangulation(const Triangulation& triangulation,
  const MeshGeometry& geometry, CoordinateSystem system, CenterPoint center,
  std::vector<std::uint8_t> mappedByLinear, std::shared_ptr<StripArray> strips, int mesh)
  : Geometry(geometry)
  , System(system)
  , Center(center)
  , MappedByLinear(std::move(mappedByLinear))
  , Strips(std::move(strips))
  , Mesh(mesh)
{
  if (system == CoordinateSystem::Contour)
  {
    const TriangleIndex count = triangulation.GetNumberOfTriangles();
    this->ContourViews = LargeArray<EdgeViews>(count);
    vtkSMPTools::For(0, count, [&](vtkIdType begin, vtkIdType end) {
      for (auto t = static_cast<TriangleIndex>(begin); t < end; ++t)
      {
        this->ContourViews[t] =
          triangulation.IsMasked(t) ? EdgeViews{} : geometry.GetViews(triangulation.GetCorners(t));
      }
    });
  }
  else if (system == CoordinateSystem::Smooth)
  {
    MakeStrips(triangulation, geometry, *this->Strips, mesh);
  }
}

void ChartedTriangulation::LimitDeviation(TriangleIndex count, ChartedTriangulation& source,
  ChartedTriangulation& target, double maximumDeviation)
{
  if (source.System != CoordinateSystem::Smooth)
  {
    return;
  }
  vtkSMPTools::For(0, count, [&](vtkIdType begin, vtkIdType end) {
    for (auto t = static_cast<TriangleIndex>(begin); t < end; ++t)
    {
      const TriangleShape& shape = target.Geometry.GetShape(t);
      for (int k = 0; k < 3; ++k)
      {
        const int stride = k * source.Strips->GetStride();
        homeomorphism::LimitDeviation(source.Strips->Get(t, source.Mesh)[stride],
          target.Strips->Get(t, target.Mesh)[stride], k, shape, maximumDeviation);
      }
    }
  });
}

TriangularCoordinates ChartedTriangulation::ToCoordinates(
  TriangleIndex triangle, const Vector2& point) const
{
  return this->VisitChart(triangle,
    [&point](const auto& chart) { return chart.ToCoordinates(chart.ToReference(point)); });
}

Vector2 ChartedTriangulation::FromCoordinates(
  TriangleIndex triangle, const TriangularCoordinates& coordinates) const
{
  return this->VisitChart(triangle, [&coordinates](const auto& chart) {
    return chart.ToPoint(chart.FromCoordinates(coordinates));
  });
}

} // namespace homeomorphism
