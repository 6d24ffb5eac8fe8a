// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ChartedTriangulation.h
/// The charts of all triangles of one mesh in a coordinate system.

#ifndef homeomorphism_ChartedTriangulation_h
#define homeomorphism_ChartedTriangulation_h

#include "LargeArray.h"
#include "MeshGeometry.h"
#include "Triangulation.h"

#include "Kernel/ContourChart.h"
#include "Kernel/CoordinateSystem.h"
#include "Kernel/LinearChart.h"
#include "Kernel/SmoothChart.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace homeomorphism
{

/// The twin triangles of a triangle, unfolded about its edges into its plane.
std::array<Neighbor, 3> UnfoldNeighbors(
  const Triangulation& triangulation, const MeshGeometry& geometry, TriangleIndex triangle);

/// The unmasked triangles that are not concordant in a geometry.
std::vector<TriangleIndex> FindDiscordant(
  const Triangulation& triangulation, const MeshGeometry& geometry);

/// The strips of all triangles of one mesh or of both meshes of a pair. The strips of an edge of a
/// triangle in both meshes are in the same cache line.
class StripArray
{
public:
  StripArray(TriangleIndex triangles, int meshes)
    : Strips(std::size_t(3) * triangles * meshes)
    , Meshes(meshes)
  {
  }

  /// The strip of a triangle's first edge in a mesh. Those of the other two edges follow at a
  /// distance of GetStride().
  SmoothStrip* Get(TriangleIndex triangle, int mesh)
  {
    return &this->Strips[std::size_t(3) * triangle * this->Meshes + mesh];
  }
  const SmoothStrip* Get(TriangleIndex triangle, int mesh) const
  {
    return &this->Strips[std::size_t(3) * triangle * this->Meshes + mesh];
  }
  int GetStride() const { return this->Meshes; }

private:
  LargeArray<SmoothStrip> Strips;
  int Meshes;
};

/// The charts of all triangles of one geometry. Stores the data that is expensive to compute and
/// constructs charts from it on request. Immutable; any number of threads may use it.
class ChartedTriangulation
{
public:
  /// Keeps a reference to the geometry. @a mappedByLinear marks the triangles that the Linear
  /// system maps (empty: none), the same in both meshes of a pair. The Smooth system stores its
  /// strips in @a strips, which both meshes of a pair share; @a mesh is the number of this mesh
  /// there.
  ChartedTriangulation(const Triangulation& triangulation, const MeshGeometry& geometry,
    CoordinateSystem system, CenterPoint center, std::vector<std::uint8_t> mappedByLinear,
    std::shared_ptr<StripArray> strips, int mesh);

  /// Limits the distance between the Smooth map from @a source to @a target and the piecewise
  /// linear map to @a maximumDeviation, in the target's normalized coordinates, in all @a count
  /// triangles. Does nothing in other systems.
  static void LimitDeviation(TriangleIndex count, ChartedTriangulation& source,
    ChartedTriangulation& target, double maximumDeviation);

  const MeshGeometry& GetGeometry() const { return this->Geometry; }
  CoordinateSystem GetSystem() const { return this->System; }
  /// The center of the triangles' contours: the centroid unless the system is Contour.
  CenterPoint GetCenter() const
  {
    return this->System == CoordinateSystem::Contour ? this->Center : CenterPoint::Centroid;
  }

  /// The coordinate system of the chart of a triangle.
  CoordinateSystem GetSystemOf(TriangleIndex triangle) const
  {
    return this->System == CoordinateSystem::Contour && !this->MappedByLinear.empty() &&
        this->MappedByLinear[triangle]
      ? CoordinateSystem::Linear
      : this->System;
  }

  LinearChart GetLinearChart(TriangleIndex triangle) const
  {
    return LinearChart(this->Geometry.GetShape(triangle));
  }
  ContourChart GetContourChart(TriangleIndex triangle) const
  {
    return ContourChart(
      this->Geometry.GetShape(triangle), this->ContourViews[triangle], this->Center);
  }
  /// Prefetches the data that GetContourChart reads in addition to the frame.
  void PrefetchContourViews(TriangleIndex triangle) const
  {
    Prefetch(&this->ContourViews[triangle]);
    Prefetch(&this->ContourViews[triangle][2].Height);
  }
  SmoothChart GetSmoothChart(TriangleIndex triangle) const
  {
    return SmoothChart(this->Geometry.GetShape(triangle), this->GetStrips(triangle).All());
  }
  SmoothStripsView GetStrips(TriangleIndex triangle) const
  {
    return { this->Strips->Get(triangle, this->Mesh), this->Strips->GetStride() };
  }

  /// Calls visit(chart) with the chart of the triangle and returns the result. The type of the
  /// chart depends on the system.
  template <typename Visit>
  auto VisitChart(TriangleIndex triangle, Visit&& visit) const
  {
    return Dispatch(this->GetSystemOf(triangle),
      [this, triangle, &visit](auto getChart) { return visit(getChart(*this, triangle)); });
  }

  /// Calls visit(chart, otherChart) with the charts of the triangle here and in the other mesh of
  /// the pair.
  template <typename Visit>
  auto VisitCharts(const ChartedTriangulation& other, TriangleIndex triangle, Visit&& visit) const
  {
    return Dispatch(this->GetSystemOf(triangle), [this, &other, triangle, &visit](auto getChart) {
      return visit(getChart(*this, triangle), getChart(other, triangle));
    });
  }

  /// Converts between points in the frame of a triangle and their triangular coordinates.
  TriangularCoordinates ToCoordinates(TriangleIndex triangle, const Vector2& point) const;
  Vector2 FromCoordinates(TriangleIndex triangle, const TriangularCoordinates& coordinates) const;

private:
  /// Calls use with the function that makes the charts of a system.
  template <typename Use>
  static auto Dispatch(CoordinateSystem system, Use&& use)
  {
    switch (system)
    {
      case CoordinateSystem::Contour:
        return use([](const ChartedTriangulation& charts, TriangleIndex triangle) {
          return charts.GetContourChart(triangle);
        });
      case CoordinateSystem::Smooth:
        return use([](const ChartedTriangulation& charts, TriangleIndex triangle) {
          return charts.GetSmoothChart(triangle);
        });
      case CoordinateSystem::Linear:
      case CoordinateSystem::Cubic:
        break;
    }
    return use([](const ChartedTriangulation& charts, TriangleIndex triangle) {
      return charts.GetLinearChart(triangle);
    });
  }

  const MeshGeometry& Geometry;
  CoordinateSystem System;
  CenterPoint Center;
  std::vector<std::uint8_t> MappedByLinear;
  // A third of the size of the charts, which are constructed quickly from it.
  LargeArray<EdgeViews> ContourViews;
  std::shared_ptr<StripArray> Strips;
  int Mesh;
};

} // namespace homeomorphism

#endif
