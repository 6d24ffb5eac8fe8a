// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Triangulation.h"

#include "Kernel/Geometry.h"

#include <algorithm>

namespace homeomorphism
{

void Triangulation::SetTriangles(std::vector<Corners> triangles, vtkIdType firstCell)
{
  this->Triangles = std::move(triangles);
  this->FirstCell = firstCell;
  this->Masked.assign(this->Triangles.size(), 0);
  this->Adjacency.assign(this->Triangles.size(), { -1, -1, -1 });
}

std::vector<TriangleIndex> Triangulation::FindAdjacency(vtkIdType numberOfPoints)
{
  struct HalfEdge
  {
    std::int32_t GreaterPoint;
    std::int32_t TriangleAndEdge; // triangle * 4 + edge
  };
  // Half edges are put into one bucket for each point, the lesser of their two; those with the same
  // greater point in a bucket then are the same edge.
  const auto lesserPoint = [this](TriangleIndex triangle, int edge) {
    const Corners& corners = this->Triangles[triangle];
    return std::min(corners[NextCorner(edge)], corners[PreviousCorner(edge)]);
  };
  std::vector<std::int64_t> bucketEnd(static_cast<std::size_t>(numberOfPoints) + 1, 0);
  const TriangleIndex count = this->GetNumberOfTriangles();
  for (TriangleIndex t = 0; t < count; ++t)
  {
    this->Adjacency[t] = { -1, -1, -1 };
    for (int k = 0; k < 3 && !this->Masked[t]; ++k)
    {
      ++bucketEnd[lesserPoint(t, k) + 1];
    }
  }
  for (vtkIdType i = 0; i < numberOfPoints; ++i)
  {
    bucketEnd[i + 1] += bucketEnd[i];
  }
  std::vector<HalfEdge> halfEdges(bucketEnd[numberOfPoints]);
  // Filling moves the start of each bucket, kept in bucketEnd, to its end.
  for (TriangleIndex t = 0; t < count; ++t)
  {
    for (int k = 0; k < 3 && !this->Masked[t]; ++k)
    {
      const Corners& corners = this->Triangles[t];
      const std::int32_t greater = std::max(corners[NextCorner(k)], corners[PreviousCorner(k)]);
      halfEdges[bucketEnd[lesserPoint(t, k)]++] = { greater, t * 4 + k };
    }
  }

  std::vector<TriangleIndex> crowded;
  std::int64_t begin = 0;
  for (vtkIdType i = 0; i < numberOfPoints; ++i)
  {
    const std::int64_t end = bucketEnd[i];
    std::sort(
      halfEdges.begin() + begin, halfEdges.begin() + end, [](const HalfEdge& a, const HalfEdge& b) {
        return a.GreaterPoint != b.GreaterPoint ? a.GreaterPoint < b.GreaterPoint
                                                : a.TriangleAndEdge < b.TriangleAndEdge;
      });
    for (std::int64_t first = begin; first < end;)
    {
      std::int64_t last = first + 1;
      while (last < end && halfEdges[last].GreaterPoint == halfEdges[first].GreaterPoint)
      {
        ++last;
      }
      if (last - first == 2)
      {
        const std::int32_t a = halfEdges[first].TriangleAndEdge;
        const std::int32_t b = halfEdges[first + 1].TriangleAndEdge;
        const auto start = [this](std::int32_t code) {
          return this->Triangles[code >> 2][NextCorner(code & 3)];
        };
        const std::int32_t same = start(a) == start(b) ? 1 : 0;
        this->Adjacency[a >> 2][a & 3] = (b >> 2) * 8 + (b & 3) * 2 + same;
        this->Adjacency[b >> 2][b & 3] = (a >> 2) * 8 + (a & 3) * 2 + same;
      }
      else if (last - first > 2)
      {
        for (std::int64_t i2 = first; i2 < last; ++i2)
        {
          crowded.push_back(halfEdges[i2].TriangleAndEdge >> 2);
        }
      }
      first = last;
    }
    begin = end;
  }
  std::sort(crowded.begin(), crowded.end());
  crowded.erase(std::unique(crowded.begin(), crowded.end()), crowded.end());
  return crowded;
}

std::vector<TriangleIndex> Triangulation::FindNotOrientable() const
{
  const TriangleIndex count = this->GetNumberOfTriangles();
  constexpr std::int8_t unknown = 0;
  std::vector<std::int8_t> winding(count, unknown);
  std::vector<TriangleIndex> contradictory;
  std::vector<TriangleIndex> waiting;
  for (TriangleIndex seed = 0; seed < count; ++seed)
  {
    if (this->Masked[seed] || winding[seed] != unknown)
    {
      continue;
    }
    winding[seed] = 1;
    waiting.push_back(seed);
    while (!waiting.empty())
    {
      const TriangleIndex t = waiting.back();
      waiting.pop_back();
      for (int k = 0; k < 3; ++k)
      {
        const AcrossEdge across = this->GetAcross(t, k);
        if (across.Triangle < 0)
        {
          continue;
        }
        const auto expected =
          static_cast<std::int8_t>(across.SameDirection ? -winding[t] : winding[t]);
        if (winding[across.Triangle] == unknown)
        {
          winding[across.Triangle] = expected;
          waiting.push_back(across.Triangle);
        }
        else if (winding[across.Triangle] != expected)
        {
          contradictory.push_back(t);
        }
      }
    }
  }
  std::sort(contradictory.begin(), contradictory.end());
  contradictory.erase(std::unique(contradictory.begin(), contradictory.end()), contradictory.end());
  return contradictory;
}

} // namespace homeomorphism
