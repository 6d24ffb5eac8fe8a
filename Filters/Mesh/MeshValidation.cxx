// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MeshValidation.h"

#include "BoxTree.h"

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

/// Adds a defect of a mesh as a whole, of which two numbers are known.
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

/// The triangles for which a predicate holds, masked ones excepted.
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

/// Reads polygons from offsets and connectivity, which need not be well formed. The memory itself
/// is read, and not by the arrays' own methods: so sanitizers of this module's code see what is
/// read.
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

/// Whether the interiors of two triangles of the plane have a point in common: not if the line
/// through an edge of one separates them.
bool InteriorsMeet(const MeshGeometry& geometry, const Triangulation::Corners& first,
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

/// Whether a triangle and a neighbor across an edge lie on the same side of it.
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

/// Whether there are such triangles.
bool HasFolds(const Triangulation& triangulation, const MeshGeometry& geometry)
{
  if (!triangulation.HasMixedWinding())
  {
    // As usual: then all turn the same way unless there are folds or pieces apart.
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

/// The box around some corners of a triangle of the plane.
Box<2> BoxAround(const MeshGeometry& geometry, std::initializer_list<std::int32_t> points)
{
  Box<2> box;
  for (const std::int32_t point : points)
  {
    box.Add({ geometry.GetPlanePoint(point).x, geometry.GetPlanePoint(point).y });
  }
  return box;
}

/// Whether a triangle's interior meets that of one that is near a box. visitNear(box, visit) is
/// like PointLocation::VisitNear.
template <typename VisitNear>
bool OverlapsNear(const Triangulation& triangulation, const MeshGeometry& geometry,
  VisitNear&& visitNear, TriangleIndex t, const Box<2>& box)
{
  bool overlaps = false;
  visitNear(box, [&](TriangleIndex other) {
    overlaps = other != t &&
      InteriorsMeet(geometry, triangulation.GetCorners(t), triangulation.GetCorners(other));
    return !overlaps;
  });
  return overlaps;
}

/// A coarse grid over a part of the plane, which says where boxes were put. All is done in time
/// that does not depend on how large the boxes are.
class Cover
{
public:
  Cover(const Box<2>& bounds, int cellsPerSide)
    : Bounds(bounds)
    , Side(cellsPerSide)
    , Counts(static_cast<std::size_t>(Side + 1) * static_cast<std::size_t>(Side + 1), 0)
  {
  }

  void Put(const Box<2>& box)
  {
    // Where the count changes; the sums are made by Finish.
    const Cells cells = this->CellsOf(box);
    this->At(cells.Least[0], cells.Least[1]) += 1;
    this->At(cells.Greatest[0] + 1, cells.Least[1]) -= 1;
    this->At(cells.Least[0], cells.Greatest[1] + 1) -= 1;
    this->At(cells.Greatest[0] + 1, cells.Greatest[1] + 1) += 1;
  }

  /// After all boxes were put.
  void Finish()
  {
    this->SumUp();
    for (std::int32_t& count : this->Counts)
    {
      count = count > 0 ? 1 : 0;
    }
    // At(x, y) becomes the number of covered cells before it in both directions.
    for (int y = this->Side; y >= 0; --y)
    {
      for (int x = this->Side; x >= 0; --x)
      {
        this->At(x, y) = x > 0 && y > 0 ? this->At(x - 1, y - 1) : 0;
      }
    }
    this->SumUp();
  }

  /// False only if @a box meets none of the boxes.
  bool MayMeet(const Box<2>& box) const
  {
    const Cells cells = this->CellsOf(box);
    return this->At(cells.Greatest[0] + 1, cells.Greatest[1] + 1) -
      this->At(cells.Least[0], cells.Greatest[1] + 1) -
      this->At(cells.Greatest[0] + 1, cells.Least[1]) + this->At(cells.Least[0], cells.Least[1]) >
      0;
  }

private:
  struct Cells
  {
    std::array<int, 2> Least;
    std::array<int, 2> Greatest;
  };

  std::int32_t& At(int x, int y)
  {
    return this->Counts[static_cast<std::size_t>(y) * static_cast<std::size_t>(this->Side + 1) +
      static_cast<std::size_t>(x)];
  }
  std::int32_t At(int x, int y) const { return const_cast<Cover*>(this)->At(x, y); }

  void SumUp()
  {
    for (int y = 0; y <= this->Side; ++y)
    {
      for (int x = 1; x <= this->Side; ++x)
      {
        this->At(x, y) += this->At(x - 1, y);
      }
    }
    for (int y = 1; y <= this->Side; ++y)
    {
      for (int x = 0; x <= this->Side; ++x)
      {
        this->At(x, y) += this->At(x, y - 1);
      }
    }
  }

  /// Never decreases with the coordinate, so that boxes that meet have a cell in common.
  Cells CellsOf(const Box<2>& box) const
  {
    Cells cells;
    for (int axis = 0; axis < 2; ++axis)
    {
      const double least = this->Bounds.Least[axis];
      const double scale = this->Side / (this->Bounds.Greatest[axis] - least);
      const auto cellOf = [&](double x) {
        const double place = (x - least) * scale;
        // Also where it is not a number, because the scale is not finite.
        return place > 0.0 ? static_cast<int>(std::min(place, this->Side - 1.0)) : 0;
      };
      cells.Least[axis] = cellOf(box.Least[axis]);
      cells.Greatest[axis] = cellOf(box.Greatest[axis]);
    }
    return cells;
  }

  Box<2> Bounds;
  int Side;
  std::vector<std::int32_t> Counts;
};

/// Whether a triangle at the boundary overlaps one that is near its boundary edge.
bool OverlapsAtBoundary(const Triangulation& triangulation, const MeshGeometry& geometry)
{
  const auto boxOf = [&](TriangleIndex t) {
    const Triangulation::Corners& corners = triangulation.GetCorners(t);
    return BoxAround(geometry, { corners[0], corners[1], corners[2] });
  };
  const auto boxOfEdge = [&](TriangleIndex t, int k) {
    const Triangulation::Corners& corners = triangulation.GetCorners(t);
    return BoxAround(geometry, { corners[NextCorner(k)], corners[PreviousCorner(k)] });
  };
  const TriangleList atBoundary = FindTriangles(triangulation, [&](TriangleIndex t) {
    return triangulation.GetTwin(t, 0).Triangle < 0 || triangulation.GetTwin(t, 1).Triangle < 0 ||
      triangulation.GetTwin(t, 2).Triangle < 0;
  });
  const auto visitEdges = [&](const auto& visit) {
    return std::any_of(atBoundary.begin(), atBoundary.end(), [&](TriangleIndex t) {
      bool found = false;
      for (int k = 0; k < 3 && !found; ++k)
      {
        found = triangulation.GetTwin(t, k).Triangle < 0 && visit(t, boxOfEdge(t, k));
      }
      return found;
    });
  };
  // Most triangles are far from all boundary edges.
  const double few = 0.5 * std::sqrt(static_cast<double>(triangulation.GetNumberOfTriangles()));
  Cover cover(geometry.GetPlaneBounds(), 1 + static_cast<int>(std::min(few, 255.0)));
  visitEdges([&cover](TriangleIndex, const Box<2>& box) {
    cover.Put(box);
    return false;
  });
  cover.Finish();
  BoxTree<2> tree;
  tree.Build(
    FindTriangles(triangulation, [&](TriangleIndex t) { return cover.MayMeet(boxOf(t)); }), boxOf);
  const auto visitNear = [&tree](const Box<2>& box, const auto& visit) { tree.Search(box, visit); };
  return visitEdges([&](TriangleIndex t, const Box<2>& box) {
    return OverlapsNear(triangulation, geometry, visitNear, t, box);
  });
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
    ReportCounts(
      MeshDiagnostic::Kind::TooManyTriangles, where, count, numberOfPoints, diagnostics);
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

TriangleList FindOverlapping(
  const Triangulation& triangulation, const MeshGeometry& geometry, const PointLocation& location)
{
  // Without folds, how often a point of the plane is covered changes only across boundary edges.
  // Beside a region that is covered twice there then is a boundary edge whose triangle is on the
  // side that is covered twice: there it overlaps a triangle that touches the edge. So only what is
  // near boundary edges has to be compared.
  if (!HasFolds(triangulation, geometry) && !OverlapsAtBoundary(triangulation, geometry))
  {
    return {};
  }
  const auto visitNear = [&location](const Box<2>& box, const auto& visit) {
    location.VisitNear(box, visit);
  };
  // Something overlaps: name all that do.
  return FindTriangles(triangulation, [&](TriangleIndex t) {
    const Triangulation::Corners& corners = triangulation.GetCorners(t);
    return OverlapsNear(triangulation, geometry, visitNear, t,
      BoxAround(geometry, { corners[0], corners[1], corners[2] }));
  });
}

} // namespace homeomorphism
