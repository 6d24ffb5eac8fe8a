// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ChartedTriangulation.h"

#include "vtkSMPTools.h"

#include <utility>

namespace homeomorphism
{
namespace
{

/// One chart for each triangle, made in parallel. A masked triangle gets a chart of no meaning.
template <typename Chart, typename MakeChart>
std::vector<Chart> MakeCharts(
  const Triangulation& triangulation, const Chart& none, MakeChart&& makeChart)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  std::vector<Chart> charts(count, none);
  vtkSMPTools::For(0, count, [&](vtkIdType begin, vtkIdType end) {
    for (auto t = static_cast<TriangleIndex>(begin); t < end; ++t)
    {
      if (!triangulation.IsMasked(t))
      {
        charts[t] = makeChart(t);
      }
    }
  });
  return charts;
}

/// What the triangle on one side of an edge is to the one on the other side. What an edge sees of a
/// triangle does not change when the triangle turns about the edge.
EdgeView Unfolded(const EdgeView& view, const AcrossEdge& across)
{
  return across.SameDirection ? view : Reversed(view);
}

/// The strips of all triangles. Each edge is looked at once, for both of its triangles.
std::vector<SmoothStrips> MakeStrips(const Triangulation& triangulation, const Embedding& embedding)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  std::vector<SmoothStrips> strips(count);
  vtkSMPTools::For(0, count, [&](vtkIdType begin, vtkIdType end) {
    for (auto t = static_cast<TriangleIndex>(begin); t < end; ++t)
    {
      for (int k = 0; k < 3; ++k)
      {
        const AcrossEdge across = triangulation.GetAcross(t, k);
        if (across.Triangle <= t)
        {
          continue;
        }
        const EdgeView own = embedding.GetView(triangulation.GetCorners(t), k);
        const EdgeView other =
          embedding.GetView(triangulation.GetCorners(across.Triangle), across.Edge);
        strips[t][k] = SmoothStrip(own, Unfolded(other, across));
        strips[across.Triangle][across.Edge] = SmoothStrip(other, Unfolded(own, across));
      }
    }
  });
  return strips;
}

} // namespace

std::array<Neighbor, 3> UnfoldNeighbors(
  const Triangulation& triangulation, const Embedding& embedding, TriangleIndex triangle)
{
  std::array<Neighbor, 3> neighbors;
  for (int k = 0; k < 3; ++k)
  {
    const AcrossEdge across = triangulation.GetAcross(triangle, k);
    if (across.Triangle < 0)
    {
      continue;
    }
    const EdgeView view = embedding.GetView(triangulation.GetCorners(across.Triangle), across.Edge);
    neighbors[k] = { true, Unfolded(view, across) };
  }
  return neighbors;
}

std::vector<TriangleIndex> FindDiscordant(
  const Triangulation& triangulation, const Embedding& embedding)
{
  std::vector<TriangleIndex> discordant;
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    if (!triangulation.IsMasked(t) && !embedding.IsConcordant(triangulation.GetCorners(t)))
    {
      discordant.push_back(t);
    }
  }
  return discordant;
}

ChartedTriangulation::ChartedTriangulation(const Triangulation& triangulation,
  const Embedding& embedding, CoordinateSystem system, CenterPoint center,
  std::vector<std::uint8_t> carriedByLinear)
  : Geometry(embedding)
  , System(system)
  , CarriedByLinear(std::move(carriedByLinear))
{
  if (system == CoordinateSystem::Contour)
  {
    this->ContourCharts =
      MakeCharts(triangulation, ContourChart::Equilateral(), [&](TriangleIndex t) {
        return ContourChart(
          embedding.GetShape(t), embedding.GetViews(triangulation.GetCorners(t)), center);
      });
  }
  else if (system == CoordinateSystem::Smooth)
  {
    this->Strips = MakeStrips(triangulation, embedding);
  }
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
