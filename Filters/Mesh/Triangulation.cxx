// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Triangulation.h"

#include "Kernel/Geometry.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace homeomorphism
{

void Triangulation::SetTriangles(
  LargeArray<Corners> triangles, vtkIdType firstCell, LargeArray<Corners> scratch)
{
  this->Triangles = std::move(triangles);
  this->Adjacency = std::move(scratch);
  this->FirstCell = firstCell;
  this->Masked.assign(this->Triangles.size(), 0);
}

std::vector<TriangleIndex> Triangulation::FindAdjacency(vtkIdType numberOfPoints)
{
  // Half edges are stored in one list per point, the lesser of their two points. Half edges with
  // the same greater point in a list belong to the same edge. The code of a half edge is triangle *
  // 8 + edge * 2 + whether it runs from the lesser to the greater point. Until its adjacency is
  // known, its entry contains the code of the next half edge in its list.
  const TriangleIndex count = this->GetNumberOfTriangles();
  if (this->Adjacency.size() != this->Triangles.size())
  {
    this->Adjacency = LargeArray<Corners>(this->Triangles.size());
  }
  LargeArray<std::int32_t> lists(static_cast<std::size_t>(numberOfPoints), -1);
  for (TriangleIndex t = 0; t < count; ++t)
  {
    const Corners& corners = this->Triangles[t];
    for (int k = 0; k < 3; ++k)
    {
      this->Adjacency[t][k] = -1;
      if (!this->Masked[t])
      {
        const std::int32_t start = corners[NextCorner(k)];
        const std::int32_t end = corners[PreviousCorner(k)];
        std::int32_t& list = lists[std::min(start, end)];
        this->Adjacency[t][k] = list;
        list = t * 8 + k * 2 + (start < end ? 1 : 0);
      }
    }
  }

  this->MixedWinding = false;
  std::vector<TriangleIndex> crowded;
  // The half edges of a point, with the greater point in the high bits, so that sorting groups them
  // by edge in the order of their triangles.
  constexpr int bits = 31;
  static_assert(MaximumTriangles * 8 <= (vtkIdType(1) << bits), "The codes of half edges");
  std::vector<std::uint64_t> halfEdges;
  const auto codeOf = [](std::uint64_t halfEdge) {
    return static_cast<std::int32_t>(halfEdge & ((std::uint64_t(1) << bits) - 1));
  };
  for (const std::int32_t list : lists)
  {
    halfEdges.clear();
    for (std::int32_t code = list; code >= 0;)
    {
      const TriangleIndex t = code >> 3;
      const int k = (code >> 1) & 3;
      const Corners& corners = this->Triangles[t];
      const auto greater =
        static_cast<std::uint64_t>(std::max(corners[NextCorner(k)], corners[PreviousCorner(k)]));
      halfEdges.push_back((greater << bits) + static_cast<std::uint64_t>(code));
      code = std::exchange(this->Adjacency[t][k], -1);
    }
    std::sort(halfEdges.begin(), halfEdges.end());
    for (auto first = halfEdges.begin(); first != halfEdges.end();)
    {
      auto last = first + 1;
      while (last != halfEdges.end() && *last >> bits == *first >> bits)
      {
        ++last;
      }
      if (last - first == 2)
      {
        const std::int32_t a = codeOf(first[0]);
        const std::int32_t b = codeOf(first[1]);
        const std::int32_t same = (a & 1) == (b & 1) ? 1 : 0;
        this->Adjacency[a >> 3][(a >> 1) & 3] = (b & ~1) + same;
        this->Adjacency[b >> 3][(b >> 1) & 3] = (a & ~1) + same;
        this->MixedWinding = this->MixedWinding || same != 0;
      }
      else if (last - first > 2)
      {
        std::transform(first, last, std::back_inserter(crowded),
          [&codeOf](std::uint64_t halfEdge) { return codeOf(halfEdge) >> 3; });
      }
      first = last;
    }
  }
  std::sort(crowded.begin(), crowded.end());
  crowded.erase(std::unique(crowded.begin(), crowded.end()), crowded.end());
  return crowded;
}

std::vector<TriangleIndex> Triangulation::FindNonOrientable() const
{
  if (!this->MixedWinding)
  {
    return {};
  }
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
        const Twin across = this->GetTwin(t, k);
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
