// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file ChartedTriangulation.h
/// The charts that a coordinate system gives to the triangles of one mesh.

#ifndef homeomorphism_ChartedTriangulation_h
#define homeomorphism_ChartedTriangulation_h

#include "LargeArray.h"
#include "MeshGeometry.h"
#include "Triangulation.h"

#include "Kernel/ContourChart.h"
#include "Kernel/CoordinateSystem.h"
#include "Kernel/LinearChart.h"
#include "Kernel/SmoothChart.h"

#include <cstdint>
#include <vector>

namespace homeomorphism
{

/// Neighbors of a triangle, unfolded about its edges into its plane.
std::array<Neighbor, 3> UnfoldNeighbors(
  const Triangulation& triangulation, const MeshGeometry& geometry, TriangleIndex triangle);

/// Triangles, masked ones excepted, that are not concordant in a geometry.
std::vector<TriangleIndex> FindDiscordant(
  const Triangulation& triangulation, const MeshGeometry& geometry);

/// Charts of all triangles of one geometry, made as they are asked for from what is expensive to
/// find. Immutable; any number of threads may use it.
class ChartedTriangulation
{
public:
  /// Refers to the geometry, which must outlive it. @a mappedByLinear says for which triangles
  /// the Linear system stands in (empty: for none); it must be the same in both meshes of a pair.
  ChartedTriangulation(const Triangulation& triangulation, const MeshGeometry& geometry,
    CoordinateSystem system, CenterPoint center, std::vector<std::uint8_t> mappedByLinear);

  const MeshGeometry& GetGeometry() const { return this->Geometry; }
  CoordinateSystem GetSystem() const { return this->System; }
  /// The center of the triangles' contours: the centroid unless the system is Contour.
  CenterPoint GetCenter() const
  {
    return this->System == CoordinateSystem::Contour ? this->Center : CenterPoint::Centroid;
  }

  /// The system that a triangle's chart belongs to.
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
  SmoothChart GetSmoothChart(TriangleIndex triangle) const
  {
    return SmoothChart(this->Geometry.GetShape(triangle), this->Strips[triangle]);
  }
  const SmoothStrips& GetSmoothStrips(TriangleIndex triangle) const
  {
    return this->Strips[triangle];
  }

  /// Calls visit(chart) with the triangle's chart, whatever its type, and returns what it returns.
  template <typename Visit>
  auto VisitChart(TriangleIndex triangle, Visit&& visit) const
  {
    switch (this->GetSystemOf(triangle))
    {
      case CoordinateSystem::Contour:
        return visit(this->GetContourChart(triangle));
      case CoordinateSystem::Smooth:
        return visit(this->GetSmoothChart(triangle));
      default:
        return visit(this->GetLinearChart(triangle));
    }
  }

  /// Triangular coordinates of a point of a triangle's frame, and back.
  TriangularCoordinates ToCoordinates(TriangleIndex triangle, const Vector2& point) const;
  Vector2 FromCoordinates(TriangleIndex triangle, const TriangularCoordinates& coordinates) const;

private:
  const MeshGeometry& Geometry;
  CoordinateSystem System;
  CenterPoint Center;
  std::vector<std::uint8_t> MappedByLinear;
  // A third of the charts' size, from which they are quickly made.
  LargeArray<EdgeViews> ContourViews;
  LargeArray<SmoothStrips> Strips;
};

} // namespace homeomorphism

#endif
