// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MapStatistics.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace homeomorphism
{
namespace
{

constexpr double None = std::numeric_limits<double>::quiet_NaN();

/// The triangles that are not masked.
std::vector<TriangleIndex> FindValid(const Triangulation& triangulation)
{
  std::vector<TriangleIndex> valid;
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    if (!triangulation.IsMasked(t))
    {
      valid.push_back(t);
    }
  }
  return valid;
}

/// The inner points of a triangle on a barycentric grid.
std::vector<Barycentric> MakeInnerGrid(std::size_t numberOfTriangles)
{
  constexpr double most = 2e6;
  int divisions = 16;
  const auto perTriangle = [](int n) { return (n - 1) * (n - 2) / 2; };
  while (divisions > 3 && perTriangle(divisions) * static_cast<double>(numberOfTriangles) > most)
  {
    --divisions;
  }
  std::vector<Barycentric> grid;
  for (int i = 1; i < divisions - 1; ++i)
  {
    for (int j = 1; j < divisions - i; ++j)
    {
      const double u = static_cast<double>(i) / divisions;
      const double v = static_cast<double>(j) / divisions;
      grid.push_back({ 1.0 - u - v, u, v });
    }
  }
  return grid;
}

SurfacePoint MakePoint(
  const MeshGeometry& geometry, TriangleIndex triangle, const Barycentric& weights)
{
  SurfacePoint point;
  point.Triangle = triangle;
  point.Point.InPlane = geometry.GetShape(triangle).FromBarycentric(weights);
  return point;
}

/// The point with a given number in a low-discrepancy sequence of points in a triangle (Martin
/// Roberts' R2 sequence, folded into the triangle).
Barycentric MakeWeights(std::int64_t number)
{
  constexpr double golden = 1.32471795724474602596;
  const auto fraction = [number](double step) {
    const double x = 0.5 + step * static_cast<double>(number);
    return x - std::floor(x);
  };
  double u = fraction(1.0 / golden);
  double v = fraction(1.0 / (golden * golden));
  if (u + v > 1.0)
  {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return { 1.0 - u - v, u, v };
}

} // namespace

MapSamples SampleMap(const Homeomorphism& map, const Homeomorphism& linear)
{
  const TriangulationPair& pair = map.GetPair();
  const Triangulation& triangulation = pair.GetTriangulation();
  const MeshGeometry& geometry = pair.GetGeometry(Domain::Source);
  const double sign = IsMirrored(pair) ? -1.0 : 1.0;
  const auto count = static_cast<std::size_t>(triangulation.GetNumberOfTriangles());
  MapSamples samples;
  samples.SmallestDeterminants.assign(count, None);
  samples.LargestDeterminants.assign(count, None);
  samples.Deviations.assign(count, None);
  const std::vector<TriangleIndex> valid = FindValid(triangulation);
  const std::vector<Barycentric> grid = MakeInnerGrid(valid.size());
  std::vector<std::size_t> farthest(count, 0);
  std::vector<vtkIdType> notPositive(count, 0);
  vtkSMPTools::For(0, static_cast<vtkIdType>(valid.size()), [&](vtkIdType begin, vtkIdType end) {
    for (vtkIdType i = begin; i < end; ++i)
    {
      const TriangleIndex triangle = valid[static_cast<std::size_t>(i)];
      const auto n = static_cast<std::size_t>(triangle);
      for (std::size_t k = 0; k < grid.size(); ++k)
      {
        const SurfacePoint point = MakePoint(geometry, triangle, grid[k]);
        const double determinant = sign * map.GetJacobian(Domain::Source, point).Determinant;
        samples.SmallestDeterminants[n] = std::fmin(samples.SmallestDeterminants[n], determinant);
        samples.LargestDeterminants[n] = std::fmax(samples.LargestDeterminants[n], determinant);
        notPositive[n] += !(determinant > 0.0);
        Vector3 image;
        Vector3 linearImage;
        if (!map.MapPoint(Domain::Source, point, image.data()))
        {
          // A Cubic map is not evaluated where it is not certified.
          continue;
        }
        linear.MapPoint(Domain::Source, point, linearImage.data());
        const double deviation = Length(Difference(image, linearImage));
        if (!(deviation <= samples.Deviations[n]))
        {
          samples.Deviations[n] = deviation;
          farthest[n] = k;
        }
      }
    }
  });
  samples.Samples = static_cast<vtkIdType>(valid.size()) * static_cast<vtkIdType>(grid.size());
  for (const TriangleIndex triangle : valid)
  {
    const auto n = static_cast<std::size_t>(triangle);
    const vtkIdType cell = triangulation.GetCellId(triangle);
    samples.NotPositive += notPositive[n];
    samples.SmallestDeterminant.TakeSmaller(samples.SmallestDeterminants[n], cell);
    samples.LargestDeterminant.TakeLarger(samples.LargestDeterminants[n], cell);
    samples.LargestDeviation.TakeLarger(samples.Deviations[n], cell);
    if (samples.LargestDeviation.Cell == cell)
    {
      const SurfacePoint point = MakePoint(geometry, triangle, grid[farthest[n]]);
      geometry.FromNormalized(
        geometry.FromFrame(triangle, point.Point), samples.DeviationPoint.data());
    }
  }
  return samples;
}

SecondDifference MeasureSecondDifference(
  const Homeomorphism& map, double meanSourceEdge, double meanTargetEdge)
{
  SecondDifference result;
  const TriangulationPair& pair = map.GetPair();
  const Triangulation& triangulation = pair.GetTriangulation();
  const MeshGeometry& geometry = pair.GetGeometry(Domain::Source);
  const std::vector<TriangleIndex> valid = FindValid(triangulation);
  if (!geometry.IsColumnar() || valid.empty())
  {
    return result;
  }
  // The area is divided into equal shares, one per sample. Each sample lies in the triangle that
  // contains the middle of its share.
  std::vector<double> cumulativeAreas;
  double area = 0.0;
  for (const TriangleIndex triangle : valid)
  {
    const Triangulation::Corners& corners = triangulation.GetCorners(triangle);
    const Vector2 a = geometry.GetPlanePoint(corners[0]);
    area += std::abs(
      Cross(geometry.GetPlanePoint(corners[1]) - a, geometry.GetPlanePoint(corners[2]) - a));
    cumulativeAreas.push_back(area);
  }
  const auto count =
    static_cast<vtkIdType>(std::min(1e6, std::max(5e4, 16.0 * static_cast<double>(valid.size()))));
  const double tolerance =
    map.GetAbsoluteTolerance(Domain::Source, 0.0, 0.5 * std::numeric_limits<double>::epsilon());
  // The step in normalized coordinates.
  const double step = 0.1 * meanSourceEdge * geometry.GetScale();
  const double height = std::sqrt(0.75) * step;
  const std::array<Vector2, 3> directions{ Vector2{ step, 0.0 }, Vector2{ 0.5 * step, height },
    Vector2{ -0.5 * step, height } };
  std::vector<double> squares(static_cast<std::size_t>(count), None);
  vtkSMPTools::For(0, count, [&](vtkIdType begin, vtkIdType end) {
    for (vtkIdType i = begin; i < end; ++i)
    {
      const double middle = area * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      const auto at = std::min<std::ptrdiff_t>(
        std::upper_bound(cumulativeAreas.begin(), cumulativeAreas.end(), middle) -
          cumulativeAreas.begin(),
        static_cast<std::ptrdiff_t>(valid.size()) - 1);
      const TriangleIndex triangle = valid[static_cast<std::size_t>(at)];
      const SurfacePoint point = MakePoint(geometry, triangle, MakeWeights(i));
      Vector3 image;
      const Vector3 center = geometry.FromFrame(triangle, point.Point);
      std::array<Vector3, 3> seconds;
      bool isInside = map.MapPoint(Domain::Source, point, image.data());
      for (std::size_t k = 0; k < 3 && isInside; ++k)
      {
        Vector3 sum = Scaled(image, -2.0);
        for (const double sense : { -1.0, 1.0 })
        {
          Vector3 position;
          geometry.FromNormalized(
            { center[0] + sense * directions[k].x, center[1] + sense * directions[k].y, center[2] },
            position.data());
          const SurfacePoint neighbor =
            map.Locate(Domain::Source, position.data(), tolerance, triangle);
          Vector3 neighborImage;
          isInside = isInside && neighbor.Triangle >= 0 &&
            map.MapPoint(Domain::Source, neighbor, neighborImage.data());
          if (isInside)
          {
            sum = Sum(sum, 1.0, neighborImage);
          }
        }
        // h is a tenth of an edge, which is the unit of length in the source.
        seconds[k] = Scaled(sum, 100.0 / meanTargetEdge);
      }
      if (!isInside)
      {
        continue;
      }
      // Second derivatives along x and y, and the mixed one, of the quadratic function.
      const Vector3& xx = seconds[0];
      const Vector3 yy = Scaled(Sum(Sum(seconds[1], 1.0, seconds[2]), -0.5, seconds[0]), 2.0 / 3.0);
      const Vector3 xy = Scaled(Difference(seconds[1], seconds[2]), 1.0 / std::sqrt(3.0));
      squares[static_cast<std::size_t>(i)] = Dot3(xx, xx) + 2.0 * Dot3(xy, xy) + Dot3(yy, yy);
    }
  });
  double sum = 0.0;
  for (const double square : squares)
  {
    if (!std::isnan(square))
    {
      sum += square;
      ++result.Samples;
    }
  }
  result.RootMeanSquare = std::sqrt(sum / static_cast<double>(result.Samples));
  return result;
}

} // namespace homeomorphism
