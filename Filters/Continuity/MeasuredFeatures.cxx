// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MeasuredFeatures.h"

namespace homeomorphism
{
MeasuredFeatures::MeasuredFeatures(const Homeomorphism& map, CenterPoint center,
  const FeatureSelection& selection, bool planar, int samples)
  : Map(map)
  , Planar(planar)
  , Samples(samples)
  , Edges(map)
  , Lines(map, center)
{
  const auto isSelected = [&selection](FeatureKind kind) { return selection[int(kind)]; };
  const Triangulation& topology = map.GetPair().GetTriangulation();
  if (isSelected(FeatureKind::Centroid) || isSelected(FeatureKind::Vertex))
  {
    this->Points.emplace(map, center, samples);
  }
  for (TriangleIndex t = 0; t < topology.GetNumberOfTriangles(); ++t)
  {
    if (isSelected(FeatureKind::Centroid) && !topology.IsMasked(t))
    {
      this->Features.push_back({ FeatureKind::Centroid, t });
    }
  }
  for (std::int32_t point = 0;
       isSelected(FeatureKind::Vertex) && point < this->Points->GetNumberOfPoints(); ++point)
  {
    if (this->Points->GetTriangleAt(point) >= 0)
    {
      this->Features.push_back({ FeatureKind::Vertex, point });
    }
  }
  const auto addEdges = [this, &isSelected](FeatureKind kind, const std::vector<MeshEdge>& edges) {
    for (std::size_t i = 0; i < edges.size() && isSelected(kind); ++i)
    {
      this->Features.push_back({ kind, static_cast<std::int32_t>(i) });
    }
  };
  addEdges(FeatureKind::Edge, this->Edges.GetInteriorEdges());
  addEdges(FeatureKind::BoundaryEdge, this->Edges.GetBoundaryEdges());
  for (const FeatureKind kind : { FeatureKind::Spoke, FeatureKind::WingSegment,
         FeatureKind::CenterSegment, FeatureKind::StripBorder })
  {
    if (isSelected(kind))
    {
      this->AddInnerLines(kind);
    }
  }
}

void MeasuredFeatures::AddInnerLines(FeatureKind kind)
{
  const Triangulation& topology = this->Map.GetPair().GetTriangulation();
  for (TriangleIndex t = 0; t < topology.GetNumberOfTriangles(); ++t)
  {
    for (int i = 0; i < InnerLines::GetNumberOfLines(kind) && !topology.IsMasked(t); ++i)
    {
      if (this->Lines.Exists(t, kind, i))
      {
        this->Features.push_back({ kind, t, i });
      }
    }
  }
}

std::array<vtkIdType, 2> MeasuredFeatures::GetCells(const MeasuredFeature& feature) const
{
  const Triangulation& topology = this->Map.GetPair().GetTriangulation();
  std::array<TriangleIndex, 2> triangles{ feature.Item, feature.Item };
  switch (feature.Kind)
  {
    case FeatureKind::Edge:
      triangles = this->Edges.GetInteriorEdges()[feature.Item].Triangles;
      break;
    case FeatureKind::BoundaryEdge:
      triangles = this->Edges.GetBoundaryEdges()[feature.Item].Triangles;
      break;
    case FeatureKind::Vertex:
      triangles = { this->Points->GetTriangleAt(feature.Item), -1 };
      break;
    default:
      break;
  }
  std::array<vtkIdType, 2> cells{ -1, -1 };
  for (int side = 0; side < 2; ++side)
  {
    if (triangles[side] >= 0)
    {
      cells[side] = topology.GetCellId(triangles[side]);
    }
  }
  return cells;
}

Vector3 MeasuredFeatures::GetPosition(const MeasuredFeature& feature, int point) const
{
  switch (feature.Kind)
  {
    case FeatureKind::Edge:
    case FeatureKind::BoundaryEdge:
    {
      const bool interior = feature.Kind == FeatureKind::Edge;
      const MeshEdge& edge =
        (interior ? this->Edges.GetInteriorEdges() : this->Edges.GetBoundaryEdges())[feature.Item];
      const Vector3 start = this->Edges.GetPosition(Domain::Source, edge.Points[0]);
      const Vector3 end = this->Edges.GetPosition(Domain::Source, edge.Points[1]);
      if (point == 0)
      {
        return start;
      }
      return !interior || point == this->Samples + 1
        ? end
        : Sum(start, this->GetProportion(point), Difference(end, start));
    }
    case FeatureKind::Centroid:
      return this->Points->GetCenter(feature.Item);
    case FeatureKind::Vertex:
      return this->Edges.GetPosition(Domain::Source, feature.Item);
    default:
      return this->Lines.GetPosition(
        feature.Item, feature.Kind, feature.Line, this->GetProportion(point));
  }
}

MeasuredFeatures::Sample MeasuredFeatures::Measure(const MeasuredFeature& feature, int sampleNumber,
  const MapUnderTest& map, double resolution, bool secondDerivatives) const
{
  const bool exact = this->Map.GetPair().HasTarget();
  Sample sample;
  if (IsPoint(feature.Kind))
  {
    const bool vertex = feature.Kind == FeatureKind::Vertex;
    const RayFan fan = vertex ? this->Points->GetAroundVertex(feature.Item)
                              : this->Points->GetAroundCenter(feature.Item);
    sample.First = EstimateJump(map(fan.Near), fan, resolution);
    if (exact && !vertex)
    {
      sample.Exact = this->Points->GetExactJumpAtCenter(feature.Item, fan).Jump;
    }
    return sample;
  }
  const double t = this->GetProportion(sampleNumber + 1);
  LineCrossing crossing;
  if (feature.Kind == FeatureKind::Edge)
  {
    crossing = this->Edges.GetCrossing(feature.Item, t, map);
    if (exact)
    {
      sample.Exact = this->Edges.GetExactJump(feature.Item, crossing).Jump;
    }
  }
  else
  {
    crossing = this->Lines.GetCrossing(feature.Item, feature.Kind, feature.Line, t, map);
    if (exact)
    {
      sample.Exact =
        this->Lines.GetExactJump(feature.Item, feature.Kind, feature.Line, t, crossing).Jump;
    }
  }
  const LocalMap local = map(crossing.Near);
  sample.First = EstimateJump(local, crossing, 1, resolution);
  if (secondDerivatives)
  {
    // Dividing by the step twice loses three decimal digits.
    sample.Second = EstimateJump(local, crossing, 2, 1e3 * resolution);
  }
  return sample;
}

} // namespace homeomorphism
