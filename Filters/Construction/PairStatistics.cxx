// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PairStatistics.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkMath.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace homeomorphism
{
namespace
{

constexpr double None = std::numeric_limits<double>::quiet_NaN();

/// The sides of a triangle in normalized coordinates: side k is opposite corner k.
std::array<Vector3, 3> SidesOf(const MeshGeometry& geometry, const Triangulation::Corners& corners)
{
  std::array<Vector3, 3> sides;
  for (std::size_t k = 0; k < 3; ++k)
  {
    sides[k] =
      Difference(geometry.GetPoint(corners[(k + 2) % 3]), geometry.GetPoint(corners[(k + 1) % 3]));
  }
  return sides;
}

double SmallestAngleOf(const std::array<Vector3, 3>& sides)
{
  double smallest = None;
  for (std::size_t k = 0; k < 3; ++k)
  {
    // At corner k, between the other two sides.
    const Vector3 a = Unit(sides[(k + 1) % 3]);
    const Vector3 b = Unit(sides[(k + 2) % 3]);
    smallest = std::fmin(smallest, std::atan2(Length(Cross3(a, b)), -Dot3(a, b)));
  }
  return vtkMath::DegreesFromRadians(smallest);
}

double AreaOf(const MeshGeometry& geometry, const Triangulation::Corners& corners)
{
  const std::array<Vector3, 3> sides = SidesOf(geometry, corners);
  return 0.5 * Length(Cross3(sides[1], sides[2]));
}

/// Calls work(triangle) in parallel for the triangles that are not masked.
template <typename Work>
void ForEachTriangle(const Triangulation& triangulation, Work&& work)
{
  vtkSMPTools::For(0, triangulation.GetNumberOfTriangles(), [&](vtkIdType begin, vtkIdType end) {
    for (vtkIdType i = begin; i < end; ++i)
    {
      const auto triangle = static_cast<TriangleIndex>(i);
      if (!triangulation.IsMasked(triangle))
      {
        work(triangle);
      }
    }
  });
}

/// Moves from a boundary edge of a triangle to the next boundary edge around one of its ends.
void StepAlongBoundary(
  const Triangulation& triangulation, TriangleIndex& triangle, int& edge, std::int32_t& end)
{
  // Edge k is opposite corner k: of the two edges at a corner, the other one.
  const auto other = [&triangulation](TriangleIndex t, int e, std::int32_t corner) {
    const Triangulation::Corners& corners = triangulation.GetCorners(t);
    for (int k = 0; k < 3; ++k)
    {
      if (k != e && corners[static_cast<std::size_t>(k)] != corner)
      {
        return k;
      }
    }
    return e;
  };
  edge = other(triangle, edge, end);
  for (Twin twin = triangulation.GetTwin(triangle, edge); twin.Triangle >= 0;
       twin = triangulation.GetTwin(triangle, edge))
  {
    triangle = twin.Triangle;
    edge = other(triangle, twin.Edge, end);
  }
  for (int k = 0; k < 3; ++k)
  {
    const std::int32_t corner = triangulation.GetCorners(triangle)[static_cast<std::size_t>(k)];
    if (k != edge && corner != end)
    {
      end = corner;
      return;
    }
  }
}

vtkIdType CountBoundaryLoops(const Triangulation& triangulation)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  std::vector<std::array<bool, 3>> seen(static_cast<std::size_t>(count), { false, false, false });
  vtkIdType loops = 0;
  for (TriangleIndex first = 0; first < count; ++first)
  {
    for (int edge = 0; edge < 3; ++edge)
    {
      if (triangulation.IsMasked(first) || triangulation.GetTwin(first, edge).Triangle >= 0 ||
        seen[static_cast<std::size_t>(first)][static_cast<std::size_t>(edge)])
      {
        continue;
      }
      ++loops;
      TriangleIndex triangle = first;
      int current = edge;
      std::int32_t end = triangulation.GetCorners(first)[static_cast<std::size_t>((edge + 1) % 3)];
      do
      {
        seen[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(current)] = true;
        StepAlongBoundary(triangulation, triangle, current, end);
      } while (!seen[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(current)]);
    }
  }
  return loops;
}

} // namespace

PointCounts CountPoints(vtkPolyData* mesh)
{
  PointCounts counts;
  const vtkIdType count = mesh->GetNumberOfPoints();
  std::vector<bool> used(static_cast<std::size_t>(count), false);
  const auto cells = vtk::TakeSmartPointer(mesh->GetPolys()->NewIterator());
  // The mesh may have been refused.
  const bool isSound = mesh->GetPolys()->IsValid();
  for (cells->GoToFirstCell(); isSound && !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType size;
    const vtkIdType* points;
    cells->GetCurrentCell(size, points);
    std::for_each(points, points + size, [&](vtkIdType point) {
      if (point >= 0 && point < count)
      {
        used[static_cast<std::size_t>(point)] = true;
      }
    });
  }
  counts.Unused = std::count(used.begin(), used.end(), false);

  std::vector<Vector3> positions;
  for (vtkIdType i = 0; i < count; ++i)
  {
    Vector3 p;
    mesh->GetPoint(i, p.data());
    // NaN would leave the order undefined.
    if (std::none_of(p.begin(), p.end(), [](double x) { return std::isnan(x); }))
    {
      positions.push_back(p);
    }
  }
  std::sort(positions.begin(), positions.end());
  const auto distinct = std::unique(positions.begin(), positions.end());
  counts.Duplicate = static_cast<vtkIdType>(positions.end() - distinct);
  return counts;
}

vtkIdType CountReordered(vtkPolyData* source, vtkPolyData* target)
{
  const auto a = vtk::TakeSmartPointer(source->GetPolys()->NewIterator());
  const auto b = vtk::TakeSmartPointer(target->GetPolys()->NewIterator());
  vtkIdType reordered = 0;
  for (a->GoToFirstCell(), b->GoToFirstCell();
       !a->IsDoneWithTraversal() && !b->IsDoneWithTraversal(); a->GoToNextCell(), b->GoToNextCell())
  {
    vtkIdType sizes[2];
    const vtkIdType* points[2];
    a->GetCurrentCell(sizes[0], points[0]);
    b->GetCurrentCell(sizes[1], points[1]);
    reordered += !std::equal(points[0], points[0] + sizes[0], points[1], points[1] + sizes[1]);
  }
  return reordered;
}

TriangulationCounts CountConnections(const Triangulation& triangulation)
{
  TriangulationCounts counts;
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  // 0: not reached; 1: same winding as the first triangle of the component; -1: opposite winding.
  std::vector<signed char> winding(static_cast<std::size_t>(count), 0);
  for (TriangleIndex first = 0; first < count; ++first)
  {
    if (winding[static_cast<std::size_t>(first)] != 0 || triangulation.IsMasked(first))
    {
      continue;
    }
    ++counts.Components;
    std::vector<TriangleIndex> reached{ first };
    winding[static_cast<std::size_t>(first)] = 1;
    vtkIdType otherwise = 0;
    for (std::size_t i = 0; i < reached.size(); ++i)
    {
      const TriangleIndex triangle = reached[i];
      const signed char own = winding[static_cast<std::size_t>(triangle)];
      otherwise += own < 0;
      for (int edge = 0; edge < 3; ++edge)
      {
        const Twin twin = triangulation.GetTwin(triangle, edge);
        if (twin.Triangle < 0)
        {
          ++counts.BoundaryEdges;
          continue;
        }
        counts.InteriorEdges += twin.Triangle > triangle;
        auto& neighbor = winding[static_cast<std::size_t>(twin.Triangle)];
        if (neighbor == 0)
        {
          neighbor = static_cast<signed char>(twin.SameDirection ? -own : own);
          reached.push_back(twin.Triangle);
        }
      }
    }
    counts.OppositeWindings +=
      std::min(otherwise, static_cast<vtkIdType>(reached.size()) - otherwise);
  }
  counts.BoundaryLoops = CountBoundaryLoops(triangulation);
  return counts;
}

MeshShapes MeasureShapes(const TriangulationPair& pair, Domain domain)
{
  const Triangulation& triangulation = pair.GetTriangulation();
  const MeshGeometry& geometry = pair.GetGeometry(domain);
  const auto count = static_cast<std::size_t>(triangulation.GetNumberOfTriangles());
  MeshShapes shapes;
  shapes.SmallestAngles.assign(count, None);
  shapes.AreaRatios.assign(count, None);
  std::vector<double> areas(count, None);
  std::vector<unsigned char> concordant(count, 0);
  // For each triangle, the lengths of the edges that it does not share with an earlier triangle.
  std::vector<std::array<double, 3>> lengths(count, { None, None, None });
  ForEachTriangle(triangulation, [&](TriangleIndex triangle) {
    const auto n = static_cast<std::size_t>(triangle);
    const Triangulation::Corners& corners = triangulation.GetCorners(triangle);
    const std::array<Vector3, 3> sides = SidesOf(geometry, corners);
    shapes.SmallestAngles[n] = SmallestAngleOf(sides);
    areas[n] = AreaOf(geometry, corners);
    concordant[n] = geometry.IsConcordant(corners);
    for (int edge = 0; edge < 3; ++edge)
    {
      const TriangleIndex neighbor = triangulation.GetTwin(triangle, edge).Triangle;
      if (neighbor < 0 || neighbor > triangle)
      {
        lengths[n][static_cast<std::size_t>(edge)] = Length(sides[static_cast<std::size_t>(edge)]);
      }
    }
  });
  ForEachTriangle(triangulation, [&](TriangleIndex triangle) {
    const auto n = static_cast<std::size_t>(triangle);
    for (int edge = 0; edge < 3; ++edge)
    {
      const TriangleIndex neighbor = triangulation.GetTwin(triangle, edge).Triangle;
      if (neighbor >= 0)
      {
        const double ratio = areas[n] / areas[static_cast<std::size_t>(neighbor)];
        shapes.AreaRatios[n] = std::fmax(shapes.AreaRatios[n], std::fmax(ratio, 1.0 / ratio));
      }
    }
  });
  constexpr std::array<double, 3> limits{ 10.0, 15.0, 20.0 };
  double total = 0.0;
  double edges = 0.0;
  double lengthOfEdges = 0.0;
  for (std::size_t n = 0; n < count; ++n)
  {
    const auto triangle = static_cast<TriangleIndex>(n);
    if (triangulation.IsMasked(triangle))
    {
      continue;
    }
    const vtkIdType cell = triangulation.GetCellId(triangle);
    total += 1.0;
    shapes.Area += areas[n];
    shapes.DiscordantTriangles += !concordant[n];
    shapes.SmallestAngle.TakeSmaller(shapes.SmallestAngles[n], cell);
    shapes.LargestAreaRatio.TakeLarger(shapes.AreaRatios[n], cell);
    for (std::size_t k = 0; k < limits.size(); ++k)
    {
      shapes.SharesOfSmallAngles[k] += shapes.SmallestAngles[n] < limits[k];
    }
    for (const double length : lengths[n])
    {
      if (!std::isnan(length))
      {
        lengthOfEdges += length;
        edges += 1.0;
      }
    }
  }
  shapes.Concordant.assign(concordant.begin(), concordant.end());
  for (double& share : shapes.SharesOfSmallAngles)
  {
    share /= std::max(1.0, total);
  }
  const double unit = geometry.GetInverseScale();
  shapes.MeanEdgeLength = lengthOfEdges / edges * unit;
  shapes.Area = shapes.Area * unit * unit;
  return shapes;
}

LinearMaps MeasureLinearMaps(const TriangulationPair& pair)
{
  const Triangulation& triangulation = pair.GetTriangulation();
  const MeshGeometry& source = pair.GetGeometry(Domain::Source);
  const MeshGeometry& target = pair.GetGeometry(Domain::Target);
  const auto count = static_cast<std::size_t>(triangulation.GetNumberOfTriangles());
  const double rescale = source.GetScale() / target.GetScale();
  LinearMaps maps;
  maps.Determinants.assign(count, None);
  maps.Distortions.assign(count, None);
  std::vector<std::array<double, 2>> stretches(count, { None, None });
  ForEachTriangle(triangulation, [&](TriangleIndex triangle) {
    const auto n = static_cast<std::size_t>(triangle);
    // Two sides of the triangle in its own plane: the first along x.
    struct Flat
    {
      double Length;
      double X;
      double Y;
    };
    const auto flatten = [&](const MeshGeometry& geometry) {
      const auto sides = SidesOf(geometry, triangulation.GetCorners(triangle));
      const double length = Length(sides[2]);
      const Vector3 u = Scaled(sides[2], 1.0 / length);
      return Flat{ length, -Dot3(u, sides[1]), Length(Cross3(u, sides[1])) };
    };
    const Flat p = flatten(source);
    const Flat q = flatten(target);
    // The linear map is upper triangular in the two frames; its singular values.
    const double a = q.Length / p.Length;
    const double d = q.Y / p.Y;
    const double b = (q.X - a * p.X) / p.Y;
    const double largest = 0.5 * (std::hypot(a + d, b) + std::hypot(a - d, b));
    // The product of the singular values is the determinant. Half the difference of the two terms
    // would suffer from cancellation.
    const double smallest = a * d / largest;
    maps.Determinants[n] = a * d * rescale * rescale;
    maps.Distortions[n] = largest / smallest;
    stretches[n] = { smallest * rescale, largest * rescale };
  });
  for (std::size_t n = 0; n < count; ++n)
  {
    const vtkIdType cell = triangulation.GetCellId(static_cast<TriangleIndex>(n));
    maps.SmallestStretch.TakeSmaller(stretches[n][0], cell);
    maps.LargestStretch.TakeLarger(stretches[n][1], cell);
    maps.LargestDistortion.TakeLarger(maps.Distortions[n], cell);
  }
  return maps;
}

bool IsMirrored(const TriangulationPair& pair)
{
  const MeshGeometry& source = pair.GetGeometry(Domain::Source);
  const MeshGeometry& target = pair.GetGeometry(Domain::Target);
  const Triangulation& triangulation = pair.GetTriangulation();
  if (!source.IsPlanar() || !target.IsPlanar())
  {
    return false;
  }
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    if (!triangulation.IsMasked(t))
    {
      const Triangulation::Corners& corners = triangulation.GetCorners(t);
      return source.GetOrientation(corners) != target.GetOrientation(corners);
    }
  }
  return false;
}

} // namespace homeomorphism
