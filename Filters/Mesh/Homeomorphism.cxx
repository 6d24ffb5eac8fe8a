// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Homeomorphism.h"

#include "MeshValidation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace homeomorphism
{

std::shared_ptr<const Homeomorphism> Homeomorphism::Make(vtkPolyData* source,
  vtkPolyData* target, const HomeomorphismOptions& options, MeshProblems& problems)
{
  std::unique_ptr<Homeomorphism> result(new Homeomorphism);
  result->Pair =
    TriangulationPair::Read(source, target, options.MaskInvalidTriangles, problems);
  if (!result->Pair)
  {
    return nullptr;
  }
  const Triangulation& topology = result->Pair->GetTriangulation();
  std::vector<Side> sides{ Side::Source };
  if (target)
  {
    sides.push_back(Side::Target);
  }

  std::vector<std::uint8_t> carriedByLinear;
  // Seen from the incenter every triangle is concordant.
  if (options.System == CoordinateSystem::Contour && options.Center == CenterPoint::Centroid)
  {
    for (const Side side : sides)
    {
      const std::vector<TriangleIndex> discordant =
        FindDiscordant(topology, result->Pair->GetEmbedding(side));
      if (discordant.empty())
      {
        continue;
      }
      carriedByLinear.resize(topology.GetNumberOfTriangles(), 0);
      MeshProblem problem;
      problem.What = MeshProblem::Kind::Discordant;
      problem.Where = !target ? "triangulation" : (side == Side::Source ? "source" : "target");
      problem.Count = static_cast<vtkIdType>(discordant.size());
      problem.Result = options.DiscordantByLinear ? MeshProblem::Outcome::CarriedByLinear
                                                  : MeshProblem::Outcome::Refused;
      for (const TriangleIndex t : discordant)
      {
        carriedByLinear[t] = 1;
        if (problem.FirstCells.size() < MeshProblem::MaximumIds)
        {
          problem.FirstCells.push_back(
            FirstPolygon(side == Side::Source ? source : target) + t);
        }
      }
      problems.push_back(problem);
    }
    if (IsRefused(problems))
    {
      return nullptr;
    }
  }
  for (const Side side : sides)
  {
    result->Charts[int(side)] = std::make_unique<ChartedTriangulation>(topology,
      result->Pair->GetEmbedding(side), options.System, options.Center, carriedByLinear);
  }
  return std::shared_ptr<const Homeomorphism>(std::move(result));
}

double Homeomorphism::GetReach(Side side, double tolerance, double precision) const
{
  const Embedding& embedding = this->Pair->GetEmbedding(side);
  // Three coordinates, each rounded when stored and again on the way to the triangle's frame.
  const double rounding = 8.0 * std::max(precision, embedding.GetCoordinatePrecision()) *
    embedding.GetLargestCoordinate();
  return std::max(rounding, tolerance * embedding.GetDiagonal());
}

Location Homeomorphism::Locate(
  Side side, const double point[3], double reach, TriangleIndex hint) const
{
  return this->Locate(side, point, this->Pair->GetEmbedding(side).ToWorking(point), reach, hint);
}

Location Homeomorphism::Locate(Side side, const double point[3], const Vector3& working, double reach,
  TriangleIndex hint) const
{
  Location place = this->Pair->GetLocation(side).Find(working, reach, hint);
  if (place.Corner >= 0 &&
    this->Pair->GetEmbedding(side).IsMeshPoint(
      this->Pair->GetTriangulation().GetCorners(place.Triangle)[place.Corner], point))
  {
    // The rounding of its distance from a plane that is not parallel to two axes must not move it.
    place.Point.Offset = 0.0;
  }
  return place;
}

void Homeomorphism::LocateBlock(
  Side side, PointBlock& block, double reach, LocationHint& hint) const
{
  const Embedding& embedding = this->Pair->GetEmbedding(side);
  const PointLocation& location = this->Pair->GetLocation(side);
  const bool planar = embedding.IsPlanar();
  const bool columnar = embedding.IsColumnar();
  const bool scattered = planar && hint.ScatteredBlocks > 0;
  TriangleIndex seeds[PointBlock::Capacity];
  if (scattered)
  {
    // Memory is slow to answer but takes many questions at a time.
    for (int i = 0; i < block.Count; ++i)
    {
      const Vector3 working = embedding.ToWorking(block.Points[i]);
      seeds[i] = location.GetSeed({ working[0], working[1] });
      if (seeds[i] >= 0)
      {
        Prefetch(&embedding.GetPlaneFrame(seeds[i]));
        this->Pair->GetTriangulation().PrefetchAcross(seeds[i]);
      }
    }
  }
  int jumps = 0;
  for (int i = 0; i < block.Count; ++i)
  {
    const Vector3 working = embedding.ToWorking(block.Points[i]);
    Location& place = block.Places[i];
    const TriangleIndex start = scattered ? seeds[i] : hint.Triangle;
    if (planar && start >= 0 && (columnar || std::abs(working[2]) <= reach))
    {
      const PlaneFrame& frame = embedding.GetPlaneFrame(start);
      const PlaneRelation relation(frame, { working[0], working[1] });
      if (relation.IsInside() && std::isfinite(working[2]))
      {
        place.Triangle = start;
        place.Point = { relation.InPlane, columnar ? working[2] : 0.0 };
        place.Corner = -1;
        block.Affine[i][frame.Apex] = relation.Apex;
        block.Affine[i][NextCorner(frame.Apex)] = relation.First;
        block.Affine[i][PreviousCorner(frame.Apex)] = relation.Second;
        hint.Triangle = start;
        continue;
      }
      jumps += relation.Least < -4.0 * frame.Height;
    }
    place = this->Locate(side, block.Points[i], working, reach, start);
    if (place.Triangle >= 0)
    {
      block.Affine[i] = embedding.GetShape(place.Triangle).ToBarycentric(place.Point.InPlane);
      hint.Triangle = place.Triangle;
    }
  }
  if (hint.ScatteredBlocks > 0)
  {
    --hint.ScatteredBlocks;
  }
  else if (2 * jumps > block.Count)
  {
    hint.ScatteredBlocks = 16;
  }
}

void Homeomorphism::MapBlock(Side from, PointBlock& block) const
{
  const Embedding& target = this->Pair->GetEmbedding(Opposite(from));
  const ChartedTriangulation& charts = this->GetCharts(from);
  const ChartedTriangulation& otherCharts = this->GetCharts(Opposite(from));
  if (charts.GetSystem() == CoordinateSystem::Smooth)
  {
    SmoothLanes lanes;
    std::array<std::pair<int, int>, PointBlock::Capacity> pointAndCorner;
    int count = 0;
    for (int i = 0; i < block.Count; ++i)
    {
      const TriangleIndex t = block.Places[i].Triangle;
      if (t < 0)
      {
        continue;
      }
      // Only of the edge that is nearest by barycentric coordinates can a strip contain the point.
      const Barycentric& l = block.Affine[i];
      const int lesser = l[1] < l[0] ? 1 : 0;
      const int k = l[2] < l[lesser] ? 2 : lesser;
      const double next = l[NextCorner(k)];
      const double previous = l[PreviousCorner(k)];
      const SmoothStrip& strip = charts.GetSmoothStrip(t, k);
      const SmoothStrip& other = otherCharts.GetSmoothStrip(t, k);
      if (strip.Contains(l[k], next, previous) || other.Contains(l[k], next, previous))
      {
        lanes.Set(count, l[k], next, previous, strip, other);
        pointAndCorner[count++] = { i, k };
      }
    }
    MapSmoothLanes(lanes, count);
    for (int lane = 0; lane < count; ++lane)
    {
      const int k = pointAndCorner[lane].second;
      Barycentric& l = block.Affine[pointAndCorner[lane].first];
      l[k] = lanes.L[0][lane];
      l[NextCorner(k)] = lanes.L[1][lane];
      l[PreviousCorner(k)] = lanes.L[2][lane];
    }
  }
  for (int i = 0; i < block.Count; ++i)
  {
    const Location& place = block.Places[i];
    const TriangleIndex t = place.Triangle;
    if (t < 0)
    {
      continue;
    }
    if (place.Corner >= 0 || charts.GetSystemOf(t) == CoordinateSystem::Contour)
    {
      this->MapPoint(from, place, block.Points[i]);
      continue;
    }
    const double offset = this->OffsetOfImage(from, place);
    const Barycentric& l = block.Affine[i];
    if (target.IsPlanar())
    {
      const PlaneFrame& frame = target.GetPlaneFrame(t);
      const Vector2 inPlane = frame.FromFrame(frame.Shape().FromBarycentric(l));
      target.FromWorking(
        { inPlane.x, inPlane.y, target.IsColumnar() ? offset : frame.Side * offset },
        block.Points[i]);
      continue;
    }
    target.FromWorking(
      target.FromFrame(t, { target.GetShape(t).FromBarycentric(l), offset }), block.Points[i]);
  }
}

double Homeomorphism::OffsetOfImage(Side from, const Location& place) const
{
  // Distances from a plane are lengths of the input's space, not of either working space.
  return place.Point.Offset == 0.0 ? 0.0
                                   : place.Point.Offset / this->Pair->GetEmbedding(from).GetScale() *
      this->Pair->GetEmbedding(Opposite(from)).GetScale();
}

template <typename Use>
auto Homeomorphism::VisitCharts(Side from, TriangleIndex triangle, Use&& use) const
{
  const ChartedTriangulation& source = this->GetCharts(from);
  const ChartedTriangulation& target = this->GetCharts(Opposite(from));
  switch (source.GetSystemOf(triangle))
  {
    case CoordinateSystem::Contour:
      return use(source.GetContourChart(triangle), target.GetContourChart(triangle));
    case CoordinateSystem::Smooth:
      return use(source.GetSmoothChart(triangle), target.GetSmoothChart(triangle));
    default:
      return use(source.GetLinearChart(triangle), target.GetLinearChart(triangle));
  }
}

void Homeomorphism::MapPoint(Side from, const Location& place, double image[3]) const
{
  const Embedding& target = this->Pair->GetEmbedding(Opposite(from));
  const double offset = this->OffsetOfImage(from, place);
  if (place.Corner >= 0)
  {
    target.FromMeshPoint(
      this->Pair->GetTriangulation().GetCorners(place.Triangle)[place.Corner], offset, image);
    return;
  }
  FramePoint point;
  point.Offset = offset;
  point.InPlane = this->VisitCharts(from, place.Triangle,
    [&place](const auto& chart, const auto& other) {
      return homeomorphism::MapPoint(chart, other, place.Point.InPlane);
    });
  target.FromWorking(target.FromFrame(place.Triangle, point), image);
}

Jacobian Homeomorphism::GetJacobian(Side from, const Location& place) const
{
  return this->FromFrames(from, place.Triangle,
    this->VisitCharts(from, place.Triangle, [&place](const auto& chart, const auto& other) {
      return MapDerivative(chart, other, chart.ToReference(place.Point.InPlane));
    }));
}

Jacobian Homeomorphism::GetJacobian(
  Side from, TriangleIndex triangle, const TriangularCoordinates& coordinates) const
{
  return this->FromFrames(from, triangle,
    this->VisitCharts(from, triangle, [&coordinates](const auto& chart, const auto& other) {
      return MapDerivative(chart, other, chart.FromCoordinates(coordinates));
    }));
}

Jacobian Homeomorphism::FromFrames(
  Side from, TriangleIndex triangle, const Matrix2& inFrames) const
{
  const Embedding& source = this->Pair->GetEmbedding(from);
  const Embedding& target = this->Pair->GetEmbedding(Opposite(from));
  const double rescale = source.GetScale() / target.GetScale();
  const std::array<Vector3, 3> from3 = source.GetAxes(triangle);
  const std::array<Vector3, 3> to3 = target.GetAxes(triangle);

  Jacobian jacobian;
  for (int row = 0; row < 3; ++row)
  {
    const double alongTangent =
      rescale * (to3[0][row] * inFrames.ImageOfX.x + to3[1][row] * inFrames.ImageOfX.y);
    const double alongInward =
      rescale * (to3[0][row] * inFrames.ImageOfY.x + to3[1][row] * inFrames.ImageOfY.y);
    for (int column = 0; column < 3; ++column)
    {
      jacobian.Matrix[3 * row + column] = alongTangent * from3[0][column] +
        alongInward * from3[1][column] + to3[2][row] * from3[2][column];
    }
  }
  jacobian.Determinant = inFrames.Determinant() * rescale * rescale *
    source.GetHandedness(triangle) * target.GetHandedness(triangle);
  return jacobian;
}

} // namespace homeomorphism
