// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "FaceDissection.h"

#include "Kernel/ExactSign.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace homeomorphism
{
namespace
{

/// The cost of a face is EdgeCost for each edge but one, plus FaceCost. So a triangle costs
/// nothing.
constexpr float EdgeCost = 0.5F;
constexpr float FaceCost = -2.0F * EdgeCost;

/// For each corner of a polygon, the other corners that are visible from it, ascending. A corner is
/// visible if the segment to it lies inside and meets no other corner. Takes one step for each
/// triangle that is visible from a corner.
std::vector<std::vector<int>> VisibleCorners(
  const std::vector<Vector2>& points, const CornerTriangles& own)
{
  const std::size_t m = points.size();
  std::map<std::array<int, 2>, int> apexes;
  std::vector<std::vector<std::array<int, 2>>> opposite(m);
  for (const auto& t : own)
  {
    for (int k = 0; k < 3; ++k)
    {
      const std::array<int, 2> edge{ { t[NextCorner(k)], t[PreviousCorner(k)] } };
      apexes[edge] = t[k];
      opposite[t[k]].push_back(edge);
    }
  }
  // An edge seen from a corner on its left, and the corners that limit the view to the right and
  // to the left.
  struct View
  {
    std::array<int, 2> Edge;
    int Right;
    int Left;
  };
  std::vector<View> views;
  std::vector<std::vector<int>> visible(m);
  for (std::size_t from = 0; from < m; ++from)
  {
    auto& seen = visible[from];
    for (const auto& edge : opposite[from])
    {
      seen.insert(seen.end(), edge.begin(), edge.end());
      views.push_back({ edge, edge[0], edge[1] });
    }
    while (!views.empty())
    {
      const View view = views.back();
      views.pop_back();
      const auto beyond = apexes.find({ view.Edge[1], view.Edge[0] });
      if (beyond == apexes.end())
      {
        continue;
      }
      const int apex = beyond->second;
      const Vector2& p = points[from];
      const bool leftOfRight = Orientation(p, points[view.Right], points[apex]) > 0;
      const bool rightOfLeft = Orientation(p, points[apex], points[view.Left]) > 0;
      if (leftOfRight && rightOfLeft)
      {
        seen.push_back(apex);
      }
      if (leftOfRight)
      {
        views.push_back({ { view.Edge[0], apex }, view.Right, rightOfLeft ? apex : view.Left });
      }
      if (rightOfLeft)
      {
        views.push_back({ { apex, view.Edge[1] }, leftOfRight ? apex : view.Right, view.Left });
      }
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  }
  return visible;
}

} // namespace

std::vector<std::array<int, 2>> Dissect(const PolygonPair& polygons,
  const std::array<CornerTriangles, 2>& own, const QualityMeasure& quality)
{
  const int m = static_cast<int>(polygons[0].size());
  const std::size_t size = polygons[0].size();
  const std::array<std::vector<std::vector<int>>, 2> visible{ { VisibleCorners(polygons[0], own[0]),
    VisibleCorners(polygons[1], own[1]) } };

  // The common chords, by their lower corners. For each one, the best dissection of the part of the
  // polygons between its ends.
  struct Part
  {
    int End;
    float Cost = 0.0F;
    float Quality = std::numeric_limits<float>::infinity();
    /// The third corner of the triangle at the chord; -1 if the face at the chord is not a
    /// triangle.
    int Third = -1;
  };
  std::vector<std::vector<Part>> parts(size);
  std::vector<int> both;
  for (int i = 0; i < m; ++i)
  {
    both.clear();
    std::set_intersection(visible[0][i].begin(), visible[0][i].end(), visible[1][i].begin(),
      visible[1][i].end(), std::back_inserter(both));
    for (auto j = std::upper_bound(both.begin(), both.end(), i); j != both.end(); ++j)
    {
      parts[i].push_back({ *j });
    }
  }

  // The costs of the cheapest walks along chords to each corner from each earlier one.
  std::vector<float> walks(size * size, std::numeric_limits<float>::infinity());
  // For each corner: the part between it and the current corner if there is a chord, and the number
  // of its parts that end at or before the current corner.
  std::vector<Part*> ending(size, nullptr);
  std::vector<std::size_t> passed(size, 0);
  for (int j = 0; j < m; ++j)
  {
    float* const walk = &walks[static_cast<std::size_t>(j) * size];
    walk[j] = 0.0F;
    for (int i = j - 1; i >= 0; --i)
    {
      Part* const first = parts[i].data();
      Part* const last = first + passed[i];
      for (const Part* part = first; part != last; ++part)
      {
        walk[i] = std::min(walk[i], part->Cost + EdgeCost + walk[part->End]);
      }
      if (passed[i] == parts[i].size() || last->End != j)
      {
        ending[i] = nullptr;
        continue;
      }
      Part& best = *last;
      ++passed[i];
      ending[i] = &best;
      if (j - i > 1)
      {
        best.Cost = walk[i] + FaceCost;
        best.Quality = 0.0F;
        for (const Part* part = first; part != last; ++part)
        {
          const int k = part->End;
          const Part* second = ending[k];
          if (!second)
          {
            continue;
          }
          const float cost = part->Cost + second->Cost;
          const float least = std::min(part->Quality, second->Quality);
          if (cost < best.Cost || (cost == best.Cost && least > best.Quality))
          {
            const float ofTriangle = static_cast<float>(
              QualityOf(quality, { polygons[0][i], polygons[0][k], polygons[0][j] },
                { polygons[1][i], polygons[1][k], polygons[1][j] }));
            if (ofTriangle >= 0.0F &&
              (cost < best.Cost || std::min(least, ofTriangle) > best.Quality))
            {
              best.Cost = cost;
              best.Quality = std::min(least, ofTriangle);
              best.Third = k;
            }
          }
        }
      }
      walk[i] = std::min(walk[i], best.Cost + EdgeCost);
    }
  }

  const auto find = [&](int i, int j) -> const Part* {
    const auto at = std::lower_bound(parts[i].begin(), parts[i].end(), j,
      [](const Part& part, int end) { return part.End < end; });
    return at != parts[i].end() && at->End == j ? &*at : nullptr;
  };
  std::vector<std::array<int, 2>> chords;
  std::vector<std::array<int, 2>> open;
  if (find(0, m - 1))
  {
    open.push_back({ 0, m - 1 });
  }
  while (!open.empty())
  {
    const auto [i, j] = open.back();
    open.pop_back();
    const Part& part = *find(i, j);
    if (j - i < 2)
    {
      continue;
    }
    chords.push_back({ i, j });
    if (part.Third >= 0)
    {
      open.push_back({ i, part.Third });
      open.push_back({ part.Third, j });
      continue;
    }
    for (int at = i; at != j;)
    {
      int next = -1;
      float least = std::numeric_limits<float>::infinity();
      for (const Part& edge : parts[at])
      {
        if (edge.End > j || (at == i && edge.End == j))
        {
          break;
        }
        const float cost =
          edge.Cost + EdgeCost + walks[static_cast<std::size_t>(j) * size + edge.End];
        if (cost < least)
        {
          least = cost;
          next = edge.End;
        }
      }
      open.push_back({ at, next });
      at = next;
    }
  }
  return chords;
}

} // namespace homeomorphism
