// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PointLocation.h"

#include "Kernel/ExactSign.h"

#include <cmath>
#include <initializer_list>

namespace homeomorphism
{
namespace
{

double Distance(const Vector2& a, const Vector2& b)
{
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// The point of the closed triangle nearest to @a point, which is the point itself if it is inside.
Vector2 NearestInTriangle(const TriangleShape& shape, const Vector2& point)
{
  const Barycentric l = shape.ToBarycentric(point);
  return l[0] > 0.0 && l[1] > 0.0 && l[2] > 0.0 ? point : shape.FromBarycentric(l);
}

/// The position of a point relative to a triangle of the plane: 1 inside, 0 on its boundary, -1
/// outside.
int Containment(
  const MeshGeometry& geometry, const Triangulation::Corners& corners, const Vector2& point)
{
  const Vector2& a = geometry.GetPlanePoint(corners[0]);
  const Vector2& b = geometry.GetPlanePoint(corners[1]);
  const Vector2& c = geometry.GetPlanePoint(corners[2]);
  const int ab = Orientation(a, b, point);
  const int bc = Orientation(b, c, point);
  const int ca = Orientation(c, a, point);
  const bool left = ab > 0 || bc > 0 || ca > 0;
  const bool right = ab < 0 || bc < 0 || ca < 0;
  if (left && right)
  {
    return -1;
  }
  return ab != 0 && bc != 0 && ca != 0 ? 1 : 0;
}

/// A box around a point with all triangles that are at most this far away, up to the rounding of
/// distances: of equally near triangles, none may be missed.
Box<3> BoxAround(const Vector3& point, double distance, double diagonal)
{
  constexpr double rounding = 32.0 * std::numeric_limits<double>::epsilon();
  const double size =
    distance + diagonal + std::abs(point[0]) + std::abs(point[1]) + std::abs(point[2]);
  return Box<3>::Around(point, distance + rounding * size);
}

/// The best candidate so far: the nearest triangle, and the lowest number among equally near ones.
struct Nearest
{
  SurfacePoint Found;
  double Distance;

  void Offer(TriangleIndex triangle, const FramePoint& framePoint, double distance)
  {
    const bool better = this->Found.Triangle < 0 ? distance <= this->Distance
                                                 : distance < this->Distance ||
        (distance == this->Distance && triangle < this->Found.Triangle);
    if (better)
    {
      this->Found.Triangle = triangle;
      this->Found.Point = framePoint;
      this->Distance = distance;
    }
  }
};

/// Sets the members of a block for the points from @a begin on that are certainly in the interior
/// of a triangle and at most @a highest above the plane. Returns the number of the first other
/// point, or
/// @a end if there is none.
HOMEOMORPHISM_FOR_WIDE_VECTORS
int FindRun(const PlaneFrame& frame, const double normalized[3][PointBlock::Size], int begin,
  int end, double highest, PointBlock& block)
{
  const PlaneFrame f = frame;
  const double* x = normalized[0];
  const double* y = normalized[1];
  const double* height = normalized[2];
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::int64_t isIn[PointBlock::Size];
  const int stop = begin + InWholeVectors(end - begin);
  HOMEOMORPHISM_SIMD
  for (int i = begin; i < stop; ++i)
  {
    const PlaneRelation relation(f, { x[i], y[i] });
    block.InPlane[0][i] = relation.InPlane.x;
    block.InPlane[1][i] = relation.InPlane.y;
    block.Apex[i] = relation.Apex;
    block.First[i] = relation.First;
    block.Second[i] = relation.Second;
    // A NaN height counts as too high. Branches would prevent vectorization.
    const double margin = std::abs(height[i]) <= highest ? relation.Margin : infinity;
    isIn[i] = relation.Least > margin ? 1 : 0;
  }
  int inside = begin;
  while (inside < end && isIn[inside] != 0)
  {
    ++inside;
  }
  return inside;
}

} // namespace

PointLocation::PointLocation(const Triangulation& triangulation, const MeshGeometry& geometry)
  : Topology(triangulation)
  , Geometry(geometry)
{
  if (geometry.IsPlanar())
  {
    this->PlantSeeds();
  }
  else
  {
    this->SpaceTree.Build(this->ListTriangles(), [this](TriangleIndex t) {
      Box<3> box;
      for (const std::int32_t corner : this->Topology.GetCorners(t))
      {
        box.Add(this->Geometry.GetPoint(corner));
      }
      return box;
    });
  }
}

std::vector<TriangleIndex> PointLocation::ListTriangles() const
{
  std::vector<TriangleIndex> triangles;
  triangles.reserve(this->Topology.GetNumberOfTriangles());
  for (TriangleIndex t = 0; t < this->Topology.GetNumberOfTriangles(); ++t)
  {
    if (!this->Topology.IsMasked(t))
    {
      triangles.push_back(t);
    }
  }
  return triangles;
}

const BoxTree<2>& PointLocation::GetPlaneTree() const
{
  std::call_once(this->HasPlaneTree, [this]() {
    this->PlaneTree.Build(
      this->ListTriangles(), [this](TriangleIndex t) { return this->PlaneBox(t); });
  });
  return this->PlaneTree;
}

Box<2> PointLocation::PlaneBox(TriangleIndex triangle) const
{
  Box<2> box;
  for (const std::int32_t corner : this->Topology.GetCorners(triangle))
  {
    const Vector2& p = this->Geometry.GetPlanePoint(corner);
    box.Add({ p.x, p.y });
  }
  return box;
}

/// The mean width and height of the triangles in a sample of a thousand.
Vector2 PointLocation::GetMeanExtent() const
{
  const TriangleIndex count = this->Topology.GetNumberOfTriangles();
  Vector2 sum;
  int sampled = 0;
  for (TriangleIndex t = 0; t < count; t += 1 + count / 1000)
  {
    if (!this->Topology.IsMasked(t))
    {
      const Box<2> box = this->PlaneBox(t);
      sum = sum + Vector2{ box.Greatest[0] - box.Least[0], box.Greatest[1] - box.Least[1] };
      ++sampled;
    }
  }
  return (1.0 / sampled) * sum;
}

void PointLocation::PlantSeeds()
{
  const Box<2>& bounds = this->Geometry.GetPlaneBounds();
  const double width = bounds.Greatest[0] - bounds.Least[0];
  const double height = bounds.Greatest[1] - bounds.Least[1];
  const double cells = 0.5 * static_cast<double>(this->Topology.GetNumberOfTriangles());
  // Cells are squares or, if triangles are elongated, have the proportions of the triangles.
  const Vector2 extent = this->GetMeanExtent();
  const bool isLong = !(std::max(extent.x, extent.y) <= 2.0 * std::min(extent.x, extent.y));
  const double columns = std::sqrt(cells * (width / height) * (isLong ? extent.y / extent.x : 1.0));
  if (!(cells >= 1.0 && columns <= std::numeric_limits<double>::max()))
  {
    return;
  }
  // Long triangles cross many cells, at most about the square root of their number.
  this->LongestWalk = 64 + static_cast<int>(16.0 * std::sqrt(cells));
  this->SeedColumns = std::floor(std::min(cells, std::max(1.0, columns)));
  this->SeedRows = std::max(1.0, std::floor(cells / this->SeedColumns));
  this->SeedOrigin = { bounds.Least[0], bounds.Least[1] };
  this->SeedScale = { this->SeedColumns / width, this->SeedRows / height };
  this->Seeds = LargeArray<TriangleIndex>(
    static_cast<std::size_t>(this->SeedColumns) * static_cast<std::size_t>(this->SeedRows), -1);
  for (TriangleIndex t = 0; t < this->Topology.GetNumberOfTriangles(); ++t)
  {
    if (this->Topology.IsMasked(t))
    {
      continue;
    }
    Vector2 middle;
    for (const std::int32_t corner : this->Topology.GetCorners(t))
    {
      middle = middle + (1.0 / 3.0) * this->Geometry.GetPlanePoint(corner);
    }
    const double x = (middle.x - this->SeedOrigin.x) * this->SeedScale.x;
    const double y = (middle.y - this->SeedOrigin.y) * this->SeedScale.y;
    if (x >= 0.0 && y >= 0.0 && x < this->SeedColumns && y < this->SeedRows)
    {
      this->Seeds[static_cast<std::size_t>(y) * static_cast<std::size_t>(this->SeedColumns) +
        static_cast<std::size_t>(x)] = t;
    }
  }
}

void PointLocation::FillSeeds()
{
  const auto columns = static_cast<std::size_t>(this->SeedColumns);
  const std::size_t cells = this->Seeds.size();
  const auto empty =
    static_cast<std::size_t>(std::count(this->Seeds.begin(), this->Seeds.end(), -1));
  if (empty == cells)
  {
    return;
  }
  if (4 * empty < cells)
  {
    // If triangles are not elongated, few cells are empty. The triangle of the previous cell, in
    // its row or in the previous row, is near enough.
    for (std::size_t row = 0; empty > 0 && row < cells; row += columns)
    {
      TriangleIndex last = -1;
      for (std::size_t cell = row; cell < row + columns; ++cell)
      {
        TriangleIndex& seed = this->Seeds[cell];
        seed = seed < 0 ? last : seed;
        seed = seed < 0 && row > 0 ? this->Seeds[cell - columns] : seed;
        last = seed;
      }
    }
    return;
  }
  // Walk to the middle of each empty cell, from the previous cell or from its neighbor in the
  // previous row. Rows are traversed in alternating directions, from the first seed to the last row
  // and then back to the first row. The total number of steps is limited.
  std::int64_t steps = std::int64_t(128) * this->Topology.GetNumberOfTriangles();
  const auto cellAt = [columns](std::size_t n) {
    const std::size_t row = n / columns;
    return row * columns + (row % 2 == 0 ? n % columns : columns - 1 - n % columns);
  };
  const auto fill = [&](std::size_t cell, std::initializer_list<TriangleIndex> starts) {
    const std::size_t row = cell / columns;
    const Vector2 middle{ this->SeedOrigin.x +
        (static_cast<double>(cell % columns) + 0.5) / this->SeedScale.x,
      this->SeedOrigin.y + (static_cast<double>(row) + 0.5) / this->SeedScale.y };
    for (const TriangleIndex start : starts)
    {
      if (this->Seeds[cell] < 0 && start >= 0)
      {
        PlaneRelation relation;
        int left = static_cast<int>(std::min<std::int64_t>(steps, this->LongestWalk));
        steps -= left;
        this->Seeds[cell] =
          this->Walk(middle, start, -std::numeric_limits<double>::infinity(), left, relation);
        steps += left;
      }
    }
    return this->Seeds[cell] >= 0 ? this->Seeds[cell] : *starts.begin();
  };
  std::size_t first = 0;
  while (this->Seeds[cellAt(first)] < 0)
  {
    ++first;
  }
  TriangleIndex last = this->Seeds[cellAt(first)];
  for (std::size_t n = first + 1; n < cells; ++n)
  {
    const std::size_t cell = cellAt(n);
    last = fill(cell, { last, cell < columns ? -1 : this->Seeds[cell - columns] });
  }
  last = this->Seeds[cellAt(first)];
  for (std::size_t n = first; n > 0; --n)
  {
    const std::size_t cell = cellAt(n - 1);
    last = fill(cell, { last, cell + columns < cells ? this->Seeds[cell + columns] : -1 });
  }
}

void PointLocation::SetOverlapping(const std::vector<TriangleIndex>& triangles)
{
  this->Overlapping.clear();
  for (const TriangleIndex t : triangles)
  {
    this->Overlapping.resize(static_cast<std::size_t>(this->Topology.GetNumberOfTriangles()), 0);
    this->Overlapping[t] = 1;
  }
}

SurfacePoint PointLocation::Find(const double point[3], double tolerance, TriangleIndex hint) const
{
  return this->Find(point, this->Geometry.ToNormalized(point), tolerance, hint);
}

SurfacePoint PointLocation::Find(
  const double point[3], const Vector3& normalized, double tolerance, TriangleIndex hint) const
{
  if (hint >= 0 && this->MayWalk(normalized, tolerance) && !this->Topology.IsMasked(hint))
  {
    // Most points are in or near the triangle of the previous point.
    PlaneRelation relation;
    int steps = this->LongestWalk;
    const TriangleIndex found =
      this->Walk({ normalized[0], normalized[1] }, hint, Farthest, steps, relation);
    if (found >= 0 && relation.IsInside())
    {
      return { found, { relation.InPlane, this->GetOffset(normalized) }, -1 };
    }
    if (found >= 0)
    {
      return this->ToSurfacePoint(found, point, normalized);
    }
  }
  if (!(std::isfinite(normalized[0]) && std::isfinite(normalized[1]) &&
        std::isfinite(normalized[2])))
  {
    return {};
  }
  if (!this->Geometry.IsPlanar())
  {
    return this->FindNearest(normalized, tolerance, hint);
  }
  if (!(std::abs(normalized[2]) <= this->GetHighest(tolerance)))
  {
    return {};
  }
  TriangleIndex found = -1;
  const TriangleIndex seed = this->GetSeed({ normalized[0], normalized[1] });
  if (seed >= 0)
  {
    PlaneRelation relation;
    int steps = this->LongestWalk;
    found = this->Walk({ normalized[0], normalized[1] }, seed,
      -std::numeric_limits<double>::infinity(), steps, relation);
    if (found >= 0 && relation.IsInside())
    {
      return { found, { relation.InPlane, this->GetOffset(normalized) }, -1 };
    }
  }
  if (found < 0)
  {
    found = this->SearchPlane({ normalized[0], normalized[1] });
  }
  return found >= 0 ? this->ToSurfacePoint(found, point, normalized)
                    : this->FindNearestInPlane(normalized, tolerance);
}

int PointLocation::FindCorner(TriangleIndex triangle, const Vector3& normalized) const
{
  const Triangulation::Corners& corners = this->Topology.GetCorners(triangle);
  int found = -1;
  for (int k = 0; k < 3; ++k)
  {
    const Vector3 corner = this->Geometry.GetPoint(corners[k]);
    if (normalized[0] == corner[0] && normalized[1] == corner[1] &&
      (this->Geometry.IsPlanar() || normalized[2] == corner[2]))
    {
      found = k;
    }
  }
  return found;
}

SurfacePoint PointLocation::ToSurfacePoint(
  TriangleIndex triangle, const double point[3], const Vector3& normalized) const
{
  FramePoint inFrame = this->Geometry.ToFrame(triangle, normalized);
  const int corner = this->FindCorner(triangle, normalized);
  // The rounding of a mesh point's distance from a plane that is not parallel to two axes must not
  // move it.
  const bool isMeshPoint =
    corner >= 0 && this->Geometry.IsMeshPoint(this->Topology.GetCorners(triangle)[corner], point);
  inFrame.Offset = isMeshPoint ? 0.0 : this->GetOffset(normalized);
  return { triangle, inFrame, corner };
}

/// The neighbor beyond the edge that a point outside a triangle is farthest from, or -1.
TriangleIndex PointLocation::LeaveTowards(
  TriangleIndex triangle, const PlaneFrame& frame, const PlaneRelation& relation) const
{
  int edge = frame.Apex;
  double least = relation.Apex;
  if (relation.First < least)
  {
    least = relation.First;
    edge = NextCorner(frame.Apex);
  }
  if (relation.Second < least)
  {
    edge = PreviousCorner(frame.Apex);
  }
  return this->Topology.GetTwin(triangle, edge).Triangle;
}

/// The triangle that a walk comes to, or -1 if it must be searched for. @a relation is the point's
/// to the last triangle of the walk. No walk starts from a triangle for which a barycentric
/// coordinate of the point is less than @a farthest, and none takes more than @a steps, which is
/// decreased by those taken.
TriangleIndex PointLocation::Walk(const Vector2& point, TriangleIndex start, double farthest,
  int& steps, PlaneRelation& relation) const
{
  TriangleIndex t = start;
  // Walks in triangulations that are not Delaunay may cycle. Brent's method: a cycle returns to the
  // triangle of the last step whose number is a power of two.
  TriangleIndex remembered = -1;
  for (int step = 0; steps > 0; ++step, --steps)
  {
    if (t == remembered)
    {
      return -1;
    }
    remembered = (step & (step - 1)) == 0 ? t : remembered;
    const PlaneFrame& frame = this->Geometry.GetPlaneFrame(t);
    relation = PlaneRelation(frame, point);
    if (relation.IsInside())
    {
      return this->IsOverlapping(t) ? -1 : t;
    }
    if (relation.IsOutside())
    {
      if (step == 0 && relation.Least < farthest * frame.Height)
      {
        return -1;
      }
      t = this->LeaveTowards(t, frame, relation);
    }
    else
    {
      int edge = -1;
      const Triangulation::Corners& corners = this->Topology.GetCorners(t);
      int onEdge = -1;
      int edges = 0;
      for (int k = 0; k < 3; ++k)
      {
        const int side = frame.Orientation *
          Orientation(this->Geometry.GetPlanePoint(corners[NextCorner(k)]),
            this->Geometry.GetPlanePoint(corners[PreviousCorner(k)]), point);
        if (side < 0)
        {
          edge = k;
        }
        else if (side == 0)
        {
          onEdge = k;
          ++edges;
        }
      }
      if (edge < 0)
      {
        if (edges == 0)
        {
          return this->IsOverlapping(t) ? -1 : t;
        }
        // A point in the interior of an interior edge belongs to two triangles only. A point at a
        // vertex or on the boundary may belong to more, including triangles that do not share a
        // point of the mesh with this one.
        const TriangleIndex other = edges == 1 ? this->Topology.GetTwin(t, onEdge).Triangle : -1;
        return other >= 0 && !this->IsOverlapping(t) && !this->IsOverlapping(other)
          ? std::min(t, other)
          : -1;
      }
      t = this->Topology.GetTwin(t, edge).Triangle;
    }
    if (t < 0)
    {
      return -1;
    }
  }
  return -1;
}

TriangleIndex PointLocation::SearchPlane(const Vector2& point) const
{
  TriangleIndex found = -1;
  this->GetPlaneTree().Search(
    Box<2>::Around({ point.x, point.y }, 0.0), [this, &point, &found](TriangleIndex t) {
      if ((found < 0 || t < found) &&
        Containment(this->Geometry, this->Topology.GetCorners(t), point) >= 0)
      {
        found = t;
      }
      return true;
    });
  return found;
}

SurfacePoint PointLocation::FindNearestInPlane(const Vector3& normalized, double tolerance) const
{
  const Vector2 point{ normalized[0], normalized[1] };
  Nearest nearest{ {}, tolerance };
  Box<2> box = Box<2>::Around({ point.x, point.y }, tolerance);
  this->GetPlaneTree().Search(box, [&](TriangleIndex t) {
    FramePoint framePoint = this->Geometry.ToFrame(t, normalized);
    const Vector2 inTriangle = NearestInTriangle(this->Geometry.GetShape(t), framePoint.InPlane);
    const double distance = Distance(inTriangle, framePoint.InPlane);
    framePoint = { inTriangle, this->GetOffset(normalized) };
    nearest.Offer(t, framePoint, distance);
    box = Box<2>::Around({ point.x, point.y }, nearest.Distance);
    return true;
  });
  return nearest.Found;
}

int PointLocation::FindBlock(PointBlock& block, double tolerance, LocationHint& hint) const
{
  double normalized[3][PointBlock::Size];
  this->Geometry.ToNormalized(
    block.Points, block.Count, normalized[0], normalized[1], normalized[2]);
  // Whole SIMD vectors read elements beyond the last point.
  for (int i = block.Count; i < block.Count + WidestVector; ++i)
  {
    normalized[0][i] = normalized[1][i] = normalized[2][i] = 0.0;
    block.Apex[i] = block.First[i] = block.Second[i] = 0.0;
  }
  int outside = 0;
  const auto search = [&](int i, TriangleIndex start) {
    const SurfacePoint found = this->Find(
      block.Points[i], { normalized[0][i], normalized[1][i], normalized[2][i] }, tolerance, start);
    this->SetPoint(block, i, found);
    outside += found.Triangle < 0 ? 1 : 0;
    return found.Triangle;
  };
  if (!this->Geometry.IsPlanar())
  {
    for (int i = 0; i < block.Count; ++i)
    {
      const TriangleIndex found = search(i, hint.Triangle);
      hint.Triangle = found >= 0 ? found : hint.Triangle;
    }
    return outside;
  }
  int moves = 0;
  if (hint.IsScattered)
  {
    this->FindScattered(block, normalized, tolerance, search);
    for (int i = 0; i < block.Count; ++i)
    {
      const TriangleIndex found = block.Triangles[i];
      moves += found != hint.Triangle ? 1 : 0;
      hint.Triangle = found >= 0 ? found : hint.Triangle;
    }
    hint.IsScattered = 2 * moves > block.Count;
    return outside;
  }
  const double highest = this->GetHighest(tolerance);
  int run = 0;
  TriangleIndex last = hint.Triangle;
  TriangleIndex next = -1;
  for (int i = 0; i < block.Count;)
  {
    const TriangleIndex start = next >= 0 ? next : last;
    next = -1;
    const Vector3 point{ normalized[0][i], normalized[1][i], normalized[2][i] };
    PlaneRelation relation;
    TriangleIndex found = -1;
    if (start >= 0 && this->MayWalk(point, tolerance) && !this->Topology.IsMasked(start))
    {
      int steps = this->LongestWalk;
      found = this->Walk({ point[0], point[1] }, start, Farthest, steps, relation);
    }
    const bool isInside = found >= 0 && relation.IsInside();
    if (isInside)
    {
      this->SetPoint(block, i, found, relation, point);
    }
    else
    {
      found = search(i, found >= 0 ? found : start);
    }
    if (found == last)
    {
      ++run;
    }
    else
    {
      ++moves;
      hint.RunLength = std::min(run, 32);
      run = 1;
    }
    last = found >= 0 ? found : last;
    ++i;
    // Consecutive points are often in the same triangle. Try twice as many as in the last run.
    while (isInside && i < block.Count && (hint.RunLength > 2 || run > 2))
    {
      const int end =
        std::min(block.Count, i + std::max(WidestVector, 2 * std::max(run, hint.RunLength)));
      const int inside =
        FindRun(this->Geometry.GetPlaneFrame(found), normalized, i, end, highest, block);
      for (int k = i; k < inside; ++k)
      {
        block.Triangles[k] = found;
        block.Corners[k] = -1;
        block.Offsets[k] = this->Geometry.IsColumnar() ? normalized[2][k] : 0.0;
      }
      run += inside - i;
      i = inside;
      if (inside < end)
      {
        // The next point is in another triangle. The edge that it lies beyond is known already.
        relation.Apex = block.Apex[i];
        relation.First = block.First[i];
        relation.Second = block.Second[i];
        next = this->LeaveTowards(found, this->Geometry.GetPlaneFrame(found), relation);
        break;
      }
    }
  }
  hint.Triangle = last;
  hint.IsScattered = 2 * moves > block.Count;
  return outside;
}

/// Finds points that are far from each other. Their walks advance together, step by step, so that
/// the memory of many triangles is prefetched at the same time.
template <typename Search>
void PointLocation::FindScattered(PointBlock& block, const double normalized[3][PointBlock::Size],
  double tolerance, Search&& search) const
{
  TriangleIndex triangles[PointBlock::Capacity];
  int walking[PointBlock::Capacity];
  const auto prefetch = [this](TriangleIndex t) {
    this->Geometry.PrefetchFrame(t);
    this->Topology.PrefetchTwin(t);
  };
  const auto prefetchSeed = [&](int i) {
    Prefetch(i < block.Count ? this->FindSeed({ normalized[0][i], normalized[1][i] }) : nullptr);
  };
  for (int i = 0; i < PrefetchDistance; ++i)
  {
    prefetchSeed(i);
  }
  // Walks begin some points ahead of the first steps.
  int begun = 0;
  const auto beginUpTo = [&](int end) {
    for (; begun < std::min(end, block.Count); ++begun)
    {
      prefetchSeed(begun + PrefetchDistance);
      const Vector3 point{ normalized[0][begun], normalized[1][begun], normalized[2][begun] };
      walking[begun] = begun;
      triangles[begun] =
        this->MayWalk(point, tolerance) ? this->GetSeed({ point[0], point[1] }) : -1;
      if (triangles[begun] >= 0)
      {
        prefetch(triangles[begun]);
      }
    }
  };
  int count = block.Count;
  constexpr int longest = 8;
  for (int step = 0; step < longest && count > 0; ++step)
  {
    int left = 0;
    for (int n = 0; n < count; ++n)
    {
      beginUpTo(n + PrefetchDistance);
      const int i = walking[n];
      const TriangleIndex t = triangles[i];
      if (t < 0)
      {
        search(i, -1);
        continue;
      }
      const PlaneFrame& frame = this->Geometry.GetPlaneFrame(t);
      const PlaneRelation relation(frame, { normalized[0][i], normalized[1][i] });
      if (relation.IsInside() && !this->IsOverlapping(t))
      {
        this->SetPoint(
          block, i, t, relation, { normalized[0][i], normalized[1][i], normalized[2][i] });
        continue;
      }
      const TriangleIndex next = relation.IsOutside() ? this->LeaveTowards(t, frame, relation) : -1;
      if (next < 0)
      {
        search(i, t);
        continue;
      }
      prefetch(next);
      triangles[i] = next;
      walking[left++] = i;
    }
    count = left;
  }
  for (int n = 0; n < count; ++n)
  {
    search(walking[n], triangles[walking[n]]);
  }
}

/// Sets a point of a block that is certainly in the interior of a triangle.
void PointLocation::SetPoint(PointBlock& block, int i, TriangleIndex triangle,
  const PlaneRelation& relation, const Vector3& normalized) const
{
  block.Triangles[i] = triangle;
  block.Corners[i] = -1;
  block.InPlane[0][i] = relation.InPlane.x;
  block.InPlane[1][i] = relation.InPlane.y;
  block.Offsets[i] = this->GetOffset(normalized);
  block.Apex[i] = relation.Apex;
  block.First[i] = relation.First;
  block.Second[i] = relation.Second;
}

void PointLocation::SetPoint(PointBlock& block, int i, const SurfacePoint& found) const
{
  block.Triangles[i] = found.Triangle;
  block.Corners[i] = found.Corner;
  block.InPlane[0][i] = found.Point.InPlane.x;
  block.InPlane[1][i] = found.Point.InPlane.y;
  block.Offsets[i] = found.Point.Offset;
  block.Apex[i] = block.First[i] = block.Second[i] = 0.0;
  if (found.Triangle >= 0)
  {
    const TriangleShape shape = this->Geometry.GetShape(found.Triangle);
    const Barycentric l = shape.ToBarycentric(found.Point.InPlane);
    block.Apex[i] = l[shape.Apex];
    block.First[i] = l[NextCorner(shape.Apex)];
    block.Second[i] = l[PreviousCorner(shape.Apex)];
  }
}

SurfacePoint PointLocation::FindNearest(
  const Vector3& normalized, double tolerance, TriangleIndex hint) const
{
  Nearest nearest{ {}, tolerance };
  const auto offer = [&](TriangleIndex t) {
    FramePoint framePoint = this->Geometry.ToFrame(t, normalized);
    const Vector2 inTriangle = NearestInTriangle(this->Geometry.GetShape(t), framePoint.InPlane);
    const double distance = std::hypot(Distance(inTriangle, framePoint.InPlane), framePoint.Offset);
    framePoint.InPlane = inTriangle;
    nearest.Offer(t, framePoint, distance);
  };
  if (hint >= 0 && !this->Topology.IsMasked(hint))
  {
    // The nearest triangle is at most this far away.
    offer(hint);
  }
  const double diagonal = this->Geometry.GetDiagonal();
  Box<3> box = BoxAround(normalized, nearest.Distance, diagonal);
  this->SpaceTree.Search(box, [&](TriangleIndex t) {
    offer(t);
    box = BoxAround(normalized, nearest.Distance, diagonal);
    return true;
  });
  if (nearest.Found.Triangle >= 0)
  {
    nearest.Found.Corner = this->FindCorner(nearest.Found.Triangle, normalized);
    nearest.Found.Point.Offset = 0.0;
  }
  return nearest.Found;
}

} // namespace homeomorphism
