// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "MeshValidation.h"

#include "Kernel/ExactSign.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <limits>

namespace homeomorphism
{
namespace
{

/// Collects the offenders of one kind.
class Offenders
{
public:
  Offenders(MeshProblem::Kind kind, const std::string& where)
  {
    this->Problem.What = kind;
    this->Problem.Where = where;
  }

  void Add(vtkIdType cell)
  {
    ++this->Problem.Count;
    if (this->Problem.FirstCells.size() < MeshProblem::MaximumIds)
    {
      this->Problem.FirstCells.push_back(cell);
    }
  }

  void Report(MeshProblems& problems, const std::string& details = std::string()) const
  {
    if (this->Problem.Count > 0)
    {
      problems.push_back(this->Problem);
      problems.back().Details = details;
    }
  }

private:
  MeshProblem Problem;
};

/// The whole mesh is at fault, not some of its triangles.
void ReportWhole(MeshProblem::Kind kind, const std::string& details, MeshProblems& problems)
{
  MeshProblem problem;
  problem.What = kind;
  problem.Count = 1;
  problem.Details = details;
  problems.push_back(problem);
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

/// Reads polygons from offsets and connectivity, which need not be well formed.
template <typename OffsetArray>
void ReadPolygons(OffsetArray* offsets, OffsetArray* connectivity, vtkIdType numberOfPoints,
  vtkIdType firstCell, std::vector<Triangulation::Corners>& triangles, Offenders& notTriangles,
  Offenders& badConnectivity)
{
  const vtkIdType cells = std::max<vtkIdType>(0, offsets->GetNumberOfValues() - 1);
  const vtkIdType entries = connectivity->GetNumberOfValues();
  triangles.resize(cells, { 0, 0, 0 });
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    const vtkIdType begin = offsets->GetValue(cell);
    const vtkIdType end = offsets->GetValue(cell + 1);
    if (begin < 0 || end < begin || end > entries)
    {
      badConnectivity.Add(firstCell + cell);
      continue;
    }
    if (end - begin != 3)
    {
      notTriangles.Add(firstCell + cell);
      continue;
    }
    bool exist = true;
    for (int k = 0; k < 3; ++k)
    {
      const vtkIdType point = connectivity->GetValue(begin + k);
      exist = exist && point >= 0 && point < numberOfPoints;
      triangles[cell][k] = exist ? static_cast<std::int32_t>(point) : 0;
    }
    if (!exist)
    {
      badConnectivity.Add(firstCell + cell);
    }
  }
}

/// Whether the interiors of two triangles of the plane have a point in common: not if the line
/// through an edge of one separates them.
bool InteriorsMeet(const Embedding& geometry, const Triangulation::Corners& first,
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

/// Whether neighbours across an edge lie on the same side of it.
bool HasFold(const Triangulation& triangulation, const Embedding& embedding, TriangleIndex t)
{
  const int orientation = embedding.GetOrientation(triangulation.GetCorners(t));
  for (int k = 0; k < 3; ++k)
  {
    const AcrossEdge across = triangulation.GetAcross(t, k);
    if (across.Triangle < 0)
    {
      continue;
    }
    const int other = embedding.GetOrientation(triangulation.GetCorners(across.Triangle));
    if (orientation != (across.SameDirection ? -other : other))
    {
      return true;
    }
  }
  return false;
}

/// Whether a triangle's interior meets that of one that is near a box.
bool OverlapsNear(const Triangulation& triangulation, const Embedding& embedding,
  const PointLocation& location, TriangleIndex t, const Box<2>& box)
{
  bool overlaps = false;
  location.VisitNear(box, [&](TriangleIndex other) {
    overlaps = other != t &&
      InteriorsMeet(embedding, triangulation.GetCorners(t), triangulation.GetCorners(other));
    return !overlaps;
  });
  return overlaps;
}

/// The box around some corners of a triangle of the plane.
Box<2> BoxAround(const Embedding& embedding, std::initializer_list<std::int32_t> points)
{
  Box<2> box;
  for (const std::int32_t point : points)
  {
    box.Add({ embedding.GetPlanePoint(point).x, embedding.GetPlanePoint(point).y });
  }
  return box;
}

} // namespace

vtkIdType FirstPolygon(vtkPolyData* mesh)
{
  return CountCells(mesh->GetVerts()) + CountCells(mesh->GetLines());
}

std::vector<Triangulation::Corners> ReadTriangles(
  vtkPolyData* mesh, const std::string& where, MeshProblems& problems)
{
  std::vector<Triangulation::Corners> triangles;
  const vtkIdType firstCell = FirstPolygon(mesh);
  Offenders notTriangles(MeshProblem::Kind::NotTriangles, where);
  Offenders badConnectivity(MeshProblem::Kind::BadConnectivity, where);
  vtkCellArray* polygons = mesh->GetPolys();
  const vtkIdType count = CountCells(polygons);
  const vtkIdType numberOfPoints = mesh->GetNumberOfPoints();
  if (count >= Triangulation::MaximumTriangles ||
    numberOfPoints >= std::numeric_limits<std::int32_t>::max())
  {
    ReportWhole(MeshProblem::Kind::TooManyTriangles,
      "The " + where + " has " + std::to_string(count) + " polygons and " +
        std::to_string(numberOfPoints) + " points; fewer than " +
        std::to_string(Triangulation::MaximumTriangles) + " and " +
        std::to_string(std::numeric_limits<std::int32_t>::max()) + " can be numbered",
      problems);
    return triangles;
  }
  if (count > 0)
  {
    if (polygons->IsStorage64Bit())
    {
      ReadPolygons(polygons->GetOffsetsArray64(), polygons->GetConnectivityArray64(),
        numberOfPoints, firstCell, triangles, notTriangles, badConnectivity);
    }
    else
    {
      ReadPolygons(polygons->GetOffsetsArray32(), polygons->GetConnectivityArray32(),
        numberOfPoints, firstCell, triangles, notTriangles, badConnectivity);
    }
  }
  notTriangles.Report(problems, "polygon with another number of corners than three");
  badConnectivity.Report(problems);

  Offenders strips(MeshProblem::Kind::NotTriangles, where);
  for (vtkIdType strip = 0; strip < CountCells(mesh->GetStrips()); ++strip)
  {
    strips.Add(firstCell + count + strip);
  }
  strips.Report(problems, "triangle strip");
  return triangles;
}

void CompareConnectivity(vtkPolyData* source, vtkPolyData* target,
  const std::vector<Triangulation::Corners>& sourceTriangles,
  const std::vector<Triangulation::Corners>& targetTriangles, MeshProblems& problems)
{
  if (source->GetNumberOfPoints() != target->GetNumberOfPoints())
  {
    ReportWhole(MeshProblem::Kind::PointCountsDiffer,
      "The source has " + std::to_string(source->GetNumberOfPoints()) + " points, the target " +
        std::to_string(target->GetNumberOfPoints()),
      problems);
  }
  if (sourceTriangles.size() != targetTriangles.size())
  {
    ReportWhole(MeshProblem::Kind::CellCountsDiffer,
      "The source has " + std::to_string(sourceTriangles.size()) + " triangles, the target " +
        std::to_string(targetTriangles.size()),
      problems);
  }
  if (IsRefused(problems))
  {
    return;
  }
  Offenders different(MeshProblem::Kind::ConnectivityDiffers, "pair");
  const vtkIdType firstCell = FirstPolygon(source);
  for (std::size_t t = 0; t < sourceTriangles.size(); ++t)
  {
    if (!std::is_permutation(
          sourceTriangles[t].begin(), sourceTriangles[t].end(), targetTriangles[t].begin()))
    {
      different.Add(firstCell + static_cast<vtkIdType>(t));
    }
  }
  different.Report(problems);
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

TriangleList FindNotFinite(const Triangulation& triangulation, const Embedding& embedding)
{
  return FindTriangles(triangulation,
    [&](TriangleIndex t) { return !embedding.IsFinite(triangulation.GetCorners(t)); });
}

TriangleList FindNoArea(const Triangulation& triangulation, const Embedding& embedding)
{
  return FindTriangles(triangulation,
    [&](TriangleIndex t) { return embedding.HasNoArea(triangulation.GetCorners(t)); });
}

TriangleList FindFlipped(
  const Triangulation& triangulation, const Embedding& source, const Embedding& target)
{
  const auto isMirrored = [&](TriangleIndex t) {
    const Triangulation::Corners& corners = triangulation.GetCorners(t);
    return source.GetOrientation(corners) != target.GetOrientation(corners);
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
  const Triangulation& triangulation, const Embedding& embedding, const PointLocation& location)
{
  // Without folds, how often a point of the plane is covered changes only across boundary edges.
  // Beside a region that is covered twice there then is a boundary edge whose triangle is on the
  // side that is covered twice: there it overlaps a triangle that touches the edge. So only what is
  // near boundary edges has to be compared.
  const bool folded = !FindTriangles(triangulation, [&](TriangleIndex t) {
    return HasFold(triangulation, embedding, t);
  }).empty();
  const auto overlapsAtBoundary = [&](TriangleIndex t) {
    const Triangulation::Corners& corners = triangulation.GetCorners(t);
    for (int k = 0; k < 3; ++k)
    {
      if (triangulation.GetAcross(t, k).Triangle < 0 &&
        OverlapsNear(triangulation, embedding, location, t,
          BoxAround(embedding, { corners[NextCorner(k)], corners[PreviousCorner(k)] })))
      {
        return true;
      }
    }
    return false;
  };
  if (!folded && FindTriangles(triangulation, overlapsAtBoundary).empty())
  {
    return {};
  }
  // Something overlaps: name all that do.
  return FindTriangles(triangulation, [&](TriangleIndex t) {
    const Triangulation::Corners& corners = triangulation.GetCorners(t);
    return OverlapsNear(triangulation, embedding, location, t,
      BoxAround(embedding, { corners[0], corners[1], corners[2] }));
  });
}

} // namespace homeomorphism
