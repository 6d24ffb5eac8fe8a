// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Homeomorphism.h"

#include "MeshValidation.h"

#include <algorithm>
#include <limits>

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
  const Embedding& embedding = this->Pair->GetEmbedding(side);
  Location place =
    this->Pair->GetLocation(side).Find(embedding.ToWorking(point), reach, hint);
  if (place.Corner >= 0 &&
    embedding.IsMeshPoint(
      this->Pair->GetTriangulation().GetCorners(place.Triangle)[place.Corner], point))
  {
    // The rounding of its distance from a plane that is not parallel to two axes must not move it.
    place.Point.Offset = 0.0;
  }
  return place;
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
  const Embedding& source = this->Pair->GetEmbedding(from);
  const Embedding& target = this->Pair->GetEmbedding(Opposite(from));
  // Distances from a plane are lengths of the input's space, not of either working space.
  const double offset = place.Point.Offset == 0.0
    ? 0.0
    : place.Point.Offset / source.GetScale() * target.GetScale();
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
