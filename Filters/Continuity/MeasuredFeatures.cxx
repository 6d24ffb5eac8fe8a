// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MeasuredFeatures.h"

namespace homeomorphism
{
namespace
{

InnerLine ToInnerLine(FeatureKind kind)
{
  switch (kind)
  {
    case FeatureKind::WingSegment:
      return InnerLine::WingSegment;
    case FeatureKind::CenterSegment:
      return InnerLine::CenterSegment;
    case FeatureKind::StripBorder:
      return InnerLine::StripBorder;
    default:
      return InnerLine::Spoke;
  }
}

} // namespace

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
      this->Places.push_back({ FeatureKind::Centroid, t });
    }
  }
  for (std::int32_t point = 0;
       isSelected(FeatureKind::Vertex) && point < this->Points->GetNumberOfPoints(); ++point)
  {
    if (this->Points->GetTriangleAt(point) >= 0)
    {
      this->Places.push_back({ FeatureKind::Vertex, point });
    }
  }
  const auto addEdges = [this, &isSelected](FeatureKind kind, const std::vector<MeshEdge>& edges) {
    for (std::size_t i = 0; i < edges.size() && isSelected(kind); ++i)
    {
      this->Places.push_back({ kind, static_cast<std::int32_t>(i) });
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
  const InnerLine line = ToInnerLine(kind);
  for (TriangleIndex t = 0; t < topology.GetNumberOfTriangles(); ++t)
  {
    for (int i = 0; i < InnerLines::GetNumberOfLines(line) && !topology.IsMasked(t); ++i)
    {
      if (this->Lines.Exists(t, line, i))
      {
        this->Places.push_back({ kind, t, i });
      }
    }
  }
}

std::array<vtkIdType, 2> MeasuredFeatures::GetCells(const MeasuredFeature& place) const
{
  const Triangulation& topology = this->Map.GetPair().GetTriangulation();
  std::array<TriangleIndex, 2> triangles{ place.Item, place.Item };
  switch (place.Kind)
  {
    case FeatureKind::Edge:
      triangles = this->Edges.GetInteriorEdges()[place.Item].Triangles;
      break;
    case FeatureKind::BoundaryEdge:
      triangles = this->Edges.GetBoundaryEdges()[place.Item].Triangles;
      break;
    case FeatureKind::Vertex:
      triangles = { this->Points->GetTriangleAt(place.Item), -1 };
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

Vector3 MeasuredFeatures::GetPosition(const MeasuredFeature& place, int point) const
{
  switch (place.Kind)
  {
    case FeatureKind::Edge:
    case FeatureKind::BoundaryEdge:
    {
      const bool interior = place.Kind == FeatureKind::Edge;
      const MeshEdge& edge =
        (interior ? this->Edges.GetInteriorEdges() : this->Edges.GetBoundaryEdges())[place.Item];
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
      return this->Points->GetAroundCenter(place.Item).Point;
    case FeatureKind::Vertex:
      return this->Edges.GetPosition(Domain::Source, place.Item);
    default:
      return this->Lines.GetPosition(
        place.Item, ToInnerLine(place.Kind), place.Line, this->GetProportion(point));
  }
}

MeasuredFeatures::Sample MeasuredFeatures::Measure(const MeasuredFeature& place, int sampleNumber,
  const MapUnderTest& map, double resolution, bool secondDerivatives) const
{
  const bool exact = this->Map.GetPair().HasTarget();
  Sample sample;
  if (IsPoint(place.Kind))
  {
    const bool vertex = place.Kind == FeatureKind::Vertex;
    const RayFan star = vertex ? this->Points->GetAroundVertex(place.Item)
                               : this->Points->GetAroundCenter(place.Item);
    sample.First = EstimateJump(map, star, resolution);
    if (exact && !vertex)
    {
      sample.Exact = this->Points->GetExactJumpAtCenter(place.Item, star).Jump;
    }
    return sample;
  }
  const double t = this->GetProportion(sampleNumber + 1);
  LineCrossing crossing;
  if (place.Kind == FeatureKind::Edge)
  {
    crossing = this->Edges.GetCrossing(place.Item, t, map);
    if (exact)
    {
      sample.Exact = this->Edges.GetExactJump(place.Item, crossing).Jump;
    }
  }
  else
  {
    const InnerLine line = ToInnerLine(place.Kind);
    crossing = this->Lines.GetCrossing(place.Item, line, place.Line, t, map);
    if (exact)
    {
      sample.Exact = this->Lines.GetExactJump(place.Item, line, place.Line, t, crossing).Jump;
    }
  }
  sample.First = EstimateJump(map, crossing, 1, resolution);
  if (secondDerivatives)
  {
    // Dividing by the step twice leaves a thousandth of the accuracy.
    sample.Second = EstimateJump(map, crossing, 2, 1e3 * resolution);
  }
  return sample;
}

} // namespace homeomorphism
