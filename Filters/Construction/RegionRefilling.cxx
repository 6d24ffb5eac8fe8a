// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "RegionRefilling.h"

#include "FaceFilling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace homeomorphism
{
namespace
{

/// Regions with more corners are not filled again, because n corners can take O(n^4) steps.
constexpr std::size_t MaximumCorners = 250;

/// An edge with a triangle of the region on its left.
using HalfEdge = std::array<int, 2>;

HalfEdge EdgeOf(const PairMesh::Triangle& triangle, int k)
{
  return { triangle.Vertices[NextCorner(k)], triangle.Vertices[PreviousCorner(k)] };
}

/// The star of a free vertex, extended to about @a size triangles: by breadth-first search for even
/// turns and by depth-first search, which extends it to one side, for odd turns.
std::vector<int> Grow(const PairMesh& mesh, int vertex, int size, int turn)
{
  std::vector<int> region;
  mesh.Star(vertex, region);
  std::rotate(region.begin(),
    region.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(turn) % region.size()),
    region.end());
  std::set<int> known(region.begin(), region.end());
  std::deque<int> next(region.begin(), region.end());
  while (!next.empty() && static_cast<int>(region.size()) < size)
  {
    const PairMesh::Triangle& t = mesh.GetTriangles()[next.front()];
    next.pop_front();
    for (int side = 0; side < 3; ++side)
    {
      const int k = (side + turn) % 3;
      const int n = t.Neighbors[k];
      if (n >= 0 && !t.Fixed[k] && known.insert(n).second)
      {
        region.push_back(n);
        if (turn % 2 == 0)
        {
          next.push_back(n);
        }
        else
        {
          next.push_front(n);
        }
      }
    }
  }
  return region;
}

/// The sides of a region that has been slit into a polygon, and the free vertices inside it.
struct SlitRegion
{
  std::set<HalfEdge> Sides;
  std::vector<int> Inside;
};

SlitRegion Slit(const PairMesh& mesh, const std::vector<int>& region)
{
  SlitRegion slit;
  const std::set<int> known(region.begin(), region.end());
  std::map<int, int> parents;
  std::map<int, int> degrees;
  const auto root = [&](int v) {
    while (parents.emplace(v, v).first->second != v)
    {
      v = parents[v];
    }
    return v;
  };
  // Edges with few added ends come first, then short edges, so that free vertices remain inside.
  std::vector<std::tuple<int, double, HalfEdge>> candidates;
  for (const int i : region)
  {
    const PairMesh::Triangle& t = mesh.GetTriangles()[i];
    for (int k = 0; k < 3; ++k)
    {
      const HalfEdge edge = EdgeOf(t, k);
      const bool isBorder = t.Neighbors[k] < 0 || known.count(t.Neighbors[k]) == 0;
      if (isBorder || t.Fixed[k])
      {
        slit.Sides.insert(edge);
        parents[root(edge[0])] = root(edge[1]);
      }
      if (edge[0] < edge[1] || isBorder)
      {
        double length = 0.0;
        int free = 0;
        for (int end = 0; end < 2; ++end)
        {
          const auto& points = mesh.GetPoints(end);
          const Vector2 along = points[edge[1]] - points[edge[0]];
          length += std::sqrt(Dot(along, along));
          free += edge[end] >= mesh.GetFirstAdded() ? 1 : 0;
        }
        if (isBorder || t.Fixed[k])
        {
          ++degrees[edge[0]];
          ++degrees[edge[1]];
        }
        else
        {
          candidates.emplace_back(free, length, edge);
        }
      }
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<HalfEdge> slits;
  for (const auto& candidate : candidates)
  {
    const HalfEdge& edge = std::get<2>(candidate);
    if (root(edge[0]) != root(edge[1]))
    {
      parents[root(edge[0])] = root(edge[1]);
      slits.push_back(edge);
      ++degrees[edge[0]];
      ++degrees[edge[1]];
    }
  }
  // Remove slits that end at an added vertex; the vertex is then inside.
  for (bool changed = true; changed;)
  {
    changed = false;
    for (auto edge = slits.begin(); edge != slits.end();)
    {
      const auto end = std::find_if(edge->begin(), edge->end(),
        [&](int v) { return degrees[v] == 1 && v >= mesh.GetFirstAdded(); });
      if (end == edge->end())
      {
        ++edge;
        continue;
      }
      slit.Inside.push_back(*end);
      --degrees[(*edge)[0]];
      --degrees[(*edge)[1]];
      edge = slits.erase(edge);
      changed = true;
    }
  }
  for (const HalfEdge& edge : slits)
  {
    slit.Sides.insert(edge);
    slit.Sides.insert({ edge[1], edge[0] });
  }
  return slit;
}

/// The corners of the walk along the sides; empty if there is more than one walk.
std::vector<int> Walk(const PairMesh& mesh, const std::vector<int>& region, const SlitRegion& slit)
{
  std::vector<int> corners;
  int t = region[0];
  int k = 0;
  const auto isSide = [&]() { return slit.Sides.count(EdgeOf(mesh.GetTriangles()[t], k)) != 0; };
  for (std::size_t i = 0; i < 3 * region.size() && !isSide(); ++i)
  {
    t = region[i / 3];
    k = static_cast<int>(i % 3);
  }
  const HalfEdge start = EdgeOf(mesh.GetTriangles()[t], k);
  HalfEdge edge = start;
  do
  {
    corners.push_back(edge[0]);
    for (bool found = false; !found;)
    {
      // The next side, clockwise about the end of the last one.
      k = PreviousCorner(mesh.IndexOf(t, edge[1]));
      found = isSide();
      t = found ? t : mesh.GetTriangles()[t].Neighbors[k];
    }
    edge = EdgeOf(mesh.GetTriangles()[t], k);
  } while (edge != start);
  return corners.size() == slit.Sides.size() ? corners : std::vector<int>();
}

} // namespace

bool RefillRegion(PairMesh& mesh, int vertex, int size, int turn)
{
  const std::vector<int> region = Grow(mesh, vertex, size, turn);
  const SlitRegion slit = Slit(mesh, region);
  if (slit.Inside.empty())
  {
    return false;
  }
  std::vector<int> corners = Walk(mesh, region, slit);
  if (corners.size() > MaximumCorners)
  {
    return false;
  }
  PolygonPair polygons;
  for (int d = 0; d < 2; ++d)
  {
    for (const int v : corners)
    {
      polygons[d].push_back(mesh.GetPoints(d)[v]);
    }
  }
  std::array<std::vector<Vector2>, 2> added;
  CornerTriangles filled;
  if (!FillWithFewPoints(
        polygons, mesh.GetQuality(), static_cast<int>(slit.Inside.size()) - 1, added, filled))
  {
    return false;
  }
  for (std::size_t i = 0; i < added[0].size(); ++i)
  {
    const int point = slit.Inside[i];
    corners.push_back(point);
    for (int d = 0; d < 2; ++d)
    {
      mesh.Move(point, d, added[d][i]);
    }
  }
  for (auto& t : filled)
  {
    t = { corners[t[0]], corners[t[1]], corners[t[2]] };
  }
  mesh.Replace(region, filled);
  return true;
}

} // namespace homeomorphism
