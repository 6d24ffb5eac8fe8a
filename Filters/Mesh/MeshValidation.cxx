// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MeshValidation.h"

#include "BoundarySweep.h"
#include "Box.h"

#include "Kernel/ExactSign.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace homeomorphism
{
namespace
{

/// Adds the cells with one kind of defect to the diagnostics, if there are any.
void Report(MeshDiagnostic::Kind kind, MeshDiagnostic::Mesh where, std::vector<vtkIdType> ids,
  MeshDiagnostics& diagnostics)
{
  if (ids.empty())
  {
    return;
  }
  MeshDiagnostic diagnostic;
  diagnostic.What = kind;
  diagnostic.Where = where;
  diagnostic.Ids = std::move(ids);
  diagnostics.push_back(std::move(diagnostic));
}

/// Adds a defect of a mesh as a whole that is described by two numbers.
void ReportCounts(MeshDiagnostic::Kind kind, MeshDiagnostic::Mesh where, vtkIdType first,
  vtkIdType second, MeshDiagnostics& diagnostics)
{
  MeshDiagnostic diagnostic;
  diagnostic.What = kind;
  diagnostic.Where = where;
  diagnostic.Counts = { first, second };
  diagnostics.push_back(diagnostic);
}

vtkIdType CountCells(vtkCellArray* cells)
{
  return cells ? cells->GetNumberOfCells() : 0;
}

/// The unmasked triangles for which a predicate holds.
template <typename Predicate>
TriangleList FindTriangles(const Triangulation& triangulation, Predicate&& predicate)
{
  TriangleList found;
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    if (!triangulation.IsMasked(t) && predicate(t))
    {
      found.push_back(t);
    }
  }
  return found;
}

using Int32Array = vtkAOSDataArrayTemplate<vtkTypeInt32>;
using Int64Array = vtkAOSDataArrayTemplate<vtkTypeInt64>;

/// The ids as an array of 64-bit integers: the array itself if it is one, otherwise a copy. A
/// vtkCellArray may keep its offsets as an implicit array and either array with any value type.
vtkSmartPointer<Int64Array> AsInt64Array(vtkDataArray* ids)
{
  if (auto* array = Int64Array::FastDownCast(ids))
  {
    return array;
  }
  auto copy = vtkSmartPointer<vtkTypeInt64Array>::New();
  copy->DeepCopy(ids);
  return copy;
}

/// Reads polygons from offsets and connectivity, which may be malformed. Reads the memory directly
/// rather than through the methods of the arrays, so that sanitizers of this module's code observe
/// the accesses.
template <typename Id>
void ReadPolygons(vtkAOSDataArrayTemplate<Id>* offsetArray,
  vtkAOSDataArrayTemplate<Id>* connectivityArray, vtkIdType numberOfPoints, vtkIdType firstCell,
  LargeArray<Triangulation::Corners>& triangles, std::vector<vtkIdType>& notTriangles,
  std::vector<vtkIdType>& badConnectivity)
{
  const vtkIdType cells = std::max<vtkIdType>(0, offsetArray->GetNumberOfValues() - 1);
  const vtkIdType entries = connectivityArray->GetNumberOfValues();
  const auto* offsets = offsetArray->GetPointer(0);
  const auto* connectivity = connectivityArray->GetPointer(0);
  triangles = LargeArray<Triangulation::Corners>(cells);
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    triangles[cell] = { 0, 0, 0 };
    const vtkIdType begin = offsets[cell];
    const vtkIdType end = offsets[cell + 1];
    if (begin < 0 || end < begin || end > entries)
    {
      badConnectivity.push_back(firstCell + cell);
      continue;
    }
    if (end - begin != 3)
    {
      notTriangles.push_back(firstCell + cell);
      continue;
    }
    bool exist = true;
    for (int k = 0; k < 3; ++k)
    {
      const vtkIdType point = connectivity[begin + k];
      exist = exist && point >= 0 && point < numberOfPoints;
      triangles[cell][k] = exist ? static_cast<std::int32_t>(point) : 0;
    }
    if (!exist)
    {
      badConnectivity.push_back(firstCell + cell);
    }
  }
}

/// Whether the interiors of two triangles of the plane intersect: they do not if the line through
/// an edge of one separates them.
bool InteriorsIntersect(const MeshGeometry& geometry, const Triangulation::Corners& first,
  const Triangulation::Corners& second)
{
  const auto separates = [&geometry](
                           const Triangulation::Corners& a, const Triangulation::Corners& b) {
    const int side = geometry.GetOrientation(a);
    for (int k = 0; k < 3; ++k)
    {
      const Vector2& start = geometry.GetPlanePoint(a[NextCorner(k)]);
      const Vector2& end = geometry.GetPlanePoint(a[PreviousCorner(k)]);
      if (std::all_of(b.begin(), b.end(), [&](std::int32_t corner) {
            return Orientation(start, end, geometry.GetPlanePoint(corner)) * side <= 0;
          }))
      {
        return true;
      }
    }
    return false;
  };
  return !separates(first, second) && !separates(second, first);
}

/// Whether a triangle and a neighbor lie on the same side of their edge.
bool HasFold(const Triangulation& triangulation, const MeshGeometry& geometry, TriangleIndex t)
{
  const int orientation = geometry.GetOrientation(t);
  for (int k = 0; k < 3; ++k)
  {
    const Twin across = triangulation.GetTwin(t, k);
    if (across.Triangle < 0)
    {
      continue;
    }
    const int other = geometry.GetOrientation(across.Triangle);
    if (orientation != (across.SameDirection ? -other : other))
    {
      return true;
    }
  }
  return false;
}

/// Whether any triangle has a fold.
bool HasFolds(const Triangulation& triangulation, const MeshGeometry& geometry)
{
  if (!triangulation.HasMixedWinding())
  {
    // The usual case: then all have the same orientation unless there are folds or separate
    // components.
    bool left = false;
    bool right = false;
    for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
    {
      if (!triangulation.IsMasked(t))
      {
        left = left || geometry.GetOrientation(t) > 0;
        right = right || geometry.GetOrientation(t) < 0;
      }
    }
    if (!left || !right)
    {
      return false;
    }
  }
  return !FindTriangles(triangulation, [&](TriangleIndex t) {
    return HasFold(triangulation, geometry, t);
  }).empty();
}

/// The box around a triangle of the plane.
Box<2> BoxAround(const MeshGeometry& geometry, const Triangulation::Corners& corners)
{
  Box<2> box;
  for (const std::int32_t corner : corners)
  {
    box.Add({ geometry.GetPlanePoint(corner).x, geometry.GetPlanePoint(corner).y });
  }
  return box;
}

/// The boundary edges of a triangulation of the plane.
std::vector<BoundarySegment> FindBoundary(
  const Triangulation& triangulation, const MeshGeometry& geometry)
{
  std::vector<BoundarySegment> boundary;
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3 && !triangulation.IsMasked(t); ++k)
    {
      if (triangulation.GetTwin(t, k).Triangle >= 0)
      {
        continue;
      }
      const Triangulation::Corners& corners = triangulation.GetCorners(t);
      BoundarySegment segment{ geometry.GetPlanePoint(corners[NextCorner(k)]),
        geometry.GetPlanePoint(corners[PreviousCorner(k)]), geometry.GetOrientation(t) };
      if (std::tie(segment.End.x, segment.End.y) < std::tie(segment.Start.x, segment.Start.y))
      {
        std::swap(segment.Start, segment.End);
        segment.Change = -segment.Change;
      }
      boundary.push_back(segment);
    }
  }
  return boundary;
}

/// The penetration depth of two triangles whose interiors intersect: the smallest distance, over
/// all edges, that the other triangle extends across the edge.
double DepthOfOverlap(const MeshGeometry& geometry, const Triangulation::Corners& first,
  const Triangulation::Corners& second)
{
  double depth = std::numeric_limits<double>::infinity();
  const auto compare = [&](const Triangulation::Corners& a, const Triangulation::Corners& b) {
    const int side = geometry.GetOrientation(a);
    for (int k = 0; k < 3; ++k)
    {
      const Vector2& start = geometry.GetPlanePoint(a[NextCorner(k)]);
      const Vector2 edge = geometry.GetPlanePoint(a[PreviousCorner(k)]) - start;
      const double length = std::hypot(edge.x, edge.y);
      double farthest = 0.0;
      for (const std::int32_t corner : b)
      {
        const Vector2 d = geometry.GetPlanePoint(corner) - start;
        farthest = std::max(farthest, side * (Cross(edge, d) / length));
      }
      depth = std::min(depth, farthest);
    }
  };
  compare(first, second);
  compare(second, first);
  return depth;
}

/// The least height of a triangle.
double HeightOf(const MeshGeometry& geometry, const Triangulation::Corners& corners)
{
  const EdgeViews views = geometry.GetViews(corners);
  return std::min({ views[0].Height, views[1].Height, views[2].Height });
}

} // namespace

vtkIdType FirstPolygon(vtkPolyData* mesh)
{
  return CountCells(mesh->GetVerts()) + CountCells(mesh->GetLines());
}

LargeArray<Triangulation::Corners> ReadTriangles(
  vtkPolyData* mesh, MeshDiagnostic::Mesh where, MeshDiagnostics& diagnostics)
{
  LargeArray<Triangulation::Corners> triangles;
  const vtkIdType firstCell = FirstPolygon(mesh);
  std::vector<vtkIdType> notTriangles;
  std::vector<vtkIdType> badConnectivity;
  vtkCellArray* polygons = mesh->GetPolys();
  const vtkIdType count = CountCells(polygons);
  const vtkIdType numberOfPoints = mesh->GetNumberOfPoints();
  if (count >= Triangulation::MaximumTriangles ||
    numberOfPoints >= std::numeric_limits<std::int32_t>::max())
  {
    ReportCounts(MeshDiagnostic::Kind::TooManyTriangles, where, count, numberOfPoints, diagnostics);
    return triangles;
  }
  if (count > 0)
  {
    vtkDataArray* offsets = polygons->GetOffsetsArray();
    vtkDataArray* connectivity = polygons->GetConnectivityArray();
    auto* offsets32 = Int32Array::FastDownCast(offsets);
    auto* connectivity32 = Int32Array::FastDownCast(connectivity);
    if (offsets32 && connectivity32)
    {
      ReadPolygons(offsets32, connectivity32, numberOfPoints, firstCell, triangles, notTriangles,
        badConnectivity);
    }
    else
    {
      ReadPolygons<vtkTypeInt64>(AsInt64Array(offsets), AsInt64Array(connectivity), numberOfPoints,
        firstCell, triangles, notTriangles, badConnectivity);
    }
  }
  Report(MeshDiagnostic::Kind::NotTriangles, where, std::move(notTriangles), diagnostics);
  Report(MeshDiagnostic::Kind::BadConnectivity, where, std::move(badConnectivity), diagnostics);

  std::vector<vtkIdType> strips(static_cast<std::size_t>(CountCells(mesh->GetStrips())));
  std::iota(strips.begin(), strips.end(), firstCell + count);
  Report(MeshDiagnostic::Kind::TriangleStrips, where, std::move(strips), diagnostics);
  return triangles;
}

void CompareConnectivity(vtkPolyData* source, vtkPolyData* target,
  const LargeArray<Triangulation::Corners>& sourceTriangles,
  const LargeArray<Triangulation::Corners>& targetTriangles, MeshDiagnostics& diagnostics)
{
  if (source->GetNumberOfPoints() != target->GetNumberOfPoints())
  {
    ReportCounts(MeshDiagnostic::Kind::PointCountsDiffer, MeshDiagnostic::Mesh::Pair,
      source->GetNumberOfPoints(), target->GetNumberOfPoints(), diagnostics);
  }
  if (sourceTriangles.size() != targetTriangles.size())
  {
    ReportCounts(MeshDiagnostic::Kind::CellCountsDiffer, MeshDiagnostic::Mesh::Pair,
      static_cast<vtkIdType>(sourceTriangles.size()),
      static_cast<vtkIdType>(targetTriangles.size()), diagnostics);
  }
  if (IsRefused(diagnostics))
  {
    return;
  }
  std::vector<vtkIdType> different;
  const vtkIdType firstCell = FirstPolygon(source);
  for (std::size_t t = 0; t < sourceTriangles.size(); ++t)
  {
    if (sourceTriangles[t] != targetTriangles[t] &&
      !std::is_permutation(
        sourceTriangles[t].begin(), sourceTriangles[t].end(), targetTriangles[t].begin()))
    {
      different.push_back(firstCell + static_cast<vtkIdType>(t));
    }
  }
  Report(MeshDiagnostic::Kind::ConnectivityDiffers, MeshDiagnostic::Mesh::Pair,
    std::move(different), diagnostics);
}

vtkUnsignedCharArray* GhostsOf(vtkDataSetAttributes* attributes, vtkIdType tuples)
{
  auto* array = vtkArrayDownCast<vtkUnsignedCharArray>(
    attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  return array && array->GetNumberOfValues() == tuples ? array : nullptr;
}

TriangleList FindBlanked(vtkPolyData* mesh, const Triangulation& triangulation)
{
  vtkUnsignedCharArray* cells = GhostsOf(mesh->GetCellData(), mesh->GetNumberOfCells());
  vtkUnsignedCharArray* points = GhostsOf(mesh->GetPointData(), mesh->GetNumberOfPoints());
  if (!cells && !points)
  {
    return {};
  }
  const vtkIdType firstCell = FirstPolygon(mesh);
  return FindTriangles(triangulation, [&](TriangleIndex t) {
    if (cells && (cells->GetValue(firstCell + t) & vtkDataSetAttributes::HIDDENCELL))
    {
      return true;
    }
    const Triangulation::Corners& corners = triangulation.GetCorners(t);
    return points && std::any_of(corners.begin(), corners.end(), [points](std::int32_t corner) {
      return (points->GetValue(corner) & vtkDataSetAttributes::HIDDENPOINT) != 0;
    });
  });
}

TriangleList FindRepeatedCorners(const Triangulation& triangulation)
{
  return FindTriangles(triangulation, [&triangulation](TriangleIndex t) {
    const Triangulation::Corners& c = triangulation.GetCorners(t);
    return c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
  });
}

TriangleList FindNotFinite(const Triangulation& triangulation, const MeshGeometry& geometry)
{
  if (geometry.IsFinite())
  {
    return {};
  }
  return FindTriangles(triangulation,
    [&](TriangleIndex t) { return !geometry.IsFinite(triangulation.GetCorners(t)); });
}

TriangleList FindDegenerate(const Triangulation& triangulation, const MeshGeometry& geometry)
{
  return FindTriangles(
    triangulation, [&](TriangleIndex t) { return geometry.IsDegenerate(triangulation, t); });
}

TriangleList FindFlipped(
  const Triangulation& triangulation, const MeshGeometry& source, const MeshGeometry& target)
{
  const auto isMirrored = [&](TriangleIndex t) {
    return source.GetOrientation(t) != target.GetOrientation(t);
  };
  TriangleList mirrored = FindTriangles(triangulation, isMirrored);
  std::size_t all = 0;
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    all += triangulation.IsMasked(t) ? 0 : 1;
  }
  if (2 * mirrored.size() <= all)
  {
    return mirrored;
  }
  return FindTriangles(triangulation, [&](TriangleIndex t) { return !isMirrored(t); });
}

Overlaps FindOverlapping(
  const Triangulation& triangulation, const MeshGeometry& geometry, const PointLocation& location)
{
  Overlaps overlaps;
  if (!HasFolds(triangulation, geometry) && CoversAtMostOnce(FindBoundary(triangulation, geometry)))
  {
    return overlaps;
  }
  // Interiors intersect, so find all triangles concerned. The depth of at most this many overlaps
  // of a triangle is measured.
  constexpr int measured = 16;
  const double rounding = geometry.GetRounding();
  const auto areTwins = [&triangulation](TriangleIndex t, TriangleIndex other) {
    return triangulation.GetTwin(t, 0).Triangle == other ||
      triangulation.GetTwin(t, 1).Triangle == other ||
      triangulation.GetTwin(t, 2).Triangle == other;
  };
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    if (triangulation.IsMasked(t))
    {
      continue;
    }
    const Triangulation::Corners& corners = triangulation.GetCorners(t);
    bool meetsByRounding = false;
    int found = 0;
    location.VisitNear(BoxAround(geometry, corners), [&](TriangleIndex other) {
      const Triangulation::Corners& others = triangulation.GetCorners(other);
      if (other == t || !InteriorsIntersect(geometry, corners, others))
      {
        return true;
      }
      const double depth = DepthOfOverlap(geometry, corners, others);
      if (!areTwins(t, other) && depth <= rounding &&
        4.0 * depth <= std::min(HeightOf(geometry, corners), HeightOf(geometry, others)))
      {
        meetsByRounding = true;
        return true;
      }
      overlaps.Depth = std::max(overlaps.Depth, depth);
      return ++found < measured;
    });
    if (found > 0)
    {
      overlaps.Triangles.push_back(t);
    }
    else if (meetsByRounding)
    {
      overlaps.WithinRounding.push_back(t);
    }
  }
  return overlaps;
}

} // namespace homeomorphism
