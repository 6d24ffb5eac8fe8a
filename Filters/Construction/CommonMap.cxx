// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "CommonMap.h"

#include "Kernel/ExactSign.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace homeomorphism
{
namespace
{

/// A bend is placed on an edge only if at least this share of the edge is visible.
constexpr double VisibleShare = 0.1;

std::vector<Vector2> WithBox(const std::vector<Vector2>& points)
{
  std::vector<Vector2> all(ConstrainedTriangulation::BoxCorners);
  all.insert(all.end(), points.begin(), points.end());
  return all;
}

/// The least angle at which a line passes a vertex: smaller angles could be lost in rounding.
constexpr double GrazingAngle = 1e-9;

double Length(const Vector2& v)
{
  return std::sqrt(Dot(v, v));
}

/// Edges shorter than this leave no room for a bend: a million units in the last place.
double LeastPortal(const std::vector<Vector2>& points)
{
  double largest = 0.0;
  for (const Vector2& p : points)
  {
    largest = std::max({ largest, std::abs(p.x), std::abs(p.y) });
  }
  return 1e6 * std::numeric_limits<double>::epsilon() * largest;
}

/// Root mean square distance from the center.
double Spread(const std::vector<Vector2>& points)
{
  Vector2 center;
  const double share = 1.0 / static_cast<double>(points.size());
  for (const Vector2& p : points)
  {
    center = center + share * p;
  }
  double sum = 0.0;
  for (const Vector2& p : points)
  {
    sum += share * Dot(p - center, p - center);
  }
  return sum > 0.0 ? std::sqrt(sum) : 1.0;
}

} // namespace

CommonMap::CommonMap(const std::array<std::vector<Vector2>, 2>& points)
  : Points{ { WithBox(points[0]), WithBox(points[1]) } }
  , Drawings{ { ConstrainedTriangulation(this->Points[0]),
      ConstrainedTriangulation(this->Points[1]) } }
  , Scales{ { Spread(points[0]), Spread(points[1]) } }
  , LeastPortals{ { LeastPortal(points[0]), LeastPortal(points[1]) } }
  , Parents(this->Points[0].size())
  , Degrees(this->Points[0].size(), 0)
  , NumberOfComponents(static_cast<int>(points[0].size()))
{
  std::iota(this->Parents.begin(), this->Parents.end(), 0);
}

int CommonMap::Component(int vertex) const
{
  while (this->Parents[vertex] != vertex)
  {
    this->Parents[vertex] = this->Parents[this->Parents[vertex]];
    vertex = this->Parents[vertex];
  }
  return vertex;
}

double CommonMap::ScaledLength(int from, int to) const
{
  std::array<double, 2> lengths;
  for (int d = 0; d < 2; ++d)
  {
    const Vector2 edge = this->Points[d][to] - this->Points[d][from];
    lengths[d] = std::sqrt(Dot(edge, edge)) / this->Scales[d];
  }
  switch (this->Order)
  {
    case 0:
      return std::max(lengths[0], lengths[1]);
    case 1:
      return lengths[0] + lengths[1];
    case 2:
    case 3:
      return lengths[this->Order - 2];
    default:
      break;
  }
  const auto edge = static_cast<unsigned>(std::min(from, to)) * 2654435761u +
    static_cast<unsigned>(std::max(from, to)) * 2246822519u;
  const unsigned hash = (edge ^ (edge >> 15)) * (2u * static_cast<unsigned>(this->Order) + 1u);
  const double noise = 0.25 * (this->Order % 8);
  return std::max(lengths[0], lengths[1]) * (1.0 + noise * ((hash >> 16) / 65536.0));
}

bool CommonMap::IsOutside(int vertex, int domain) const
{
  const auto& drawing = this->Drawings[domain];
  const int start = drawing.GetTriangleOf(vertex);
  int t = start;
  do
  {
    const auto& triangle = drawing.GetTriangles()[t];
    if (!triangle.Outside)
    {
      return false;
    }
    t = triangle.Neighbors[NextCorner(drawing.IndexOf(t, vertex))];
  } while (t != start);
  return true;
}

CommonMap::Answer CommonMap::Add(int from, int to)
{
  std::array<Triangulation::Trace, 2> traces;
  for (int d = 0; d < 2; ++d)
  {
    traces[d] = this->Drawings[d].Follow(from, to);
    const auto& obstacle = traces[d].Obstacle;
    switch (traces[d].Result)
    {
      case Triangulation::Trace::Outcome::CrossesConstraint:
        return { Refusal::Crosses, d, { obstacle[0], obstacle[1] } };
      case Triangulation::Trace::Outcome::MeetsVertex:
        return { Refusal::MeetsVertex, d, { obstacle[0], obstacle[1] } };
      case Triangulation::Trace::Outcome::Clear:
        break;
    }
    const auto& first = this->Drawings[d].GetTriangles()[traces[d].First];
    if (traces[d].IsEdge &&
      first.Constrained[PreviousCorner(this->Drawings[d].IndexOf(traces[d].First, from))])
    {
      return { Refusal::Exists, d, {} };
    }
    if (first.Outside)
    {
      return { Refusal::Outside, d, {} };
    }
  }
  if (this->Degrees[from] > 1 &&
    this->Drawings[0].ConstrainedNeighborBefore(from, to, traces[0]) !=
      this->Drawings[1].ConstrainedNeighborBefore(from, to, traces[1]))
  {
    return { Refusal::CyclicOrder, -1, { from } };
  }
  if (this->Degrees[to] > 1 &&
    this->Drawings[0].ConstrainedNeighborBefore(to, from, this->Drawings[0].Follow(to, from)) !=
      this->Drawings[1].ConstrainedNeighborBefore(to, from, this->Drawings[1].Follow(to, from)))
  {
    return { Refusal::CyclicOrder, -1, { to } };
  }
  for (int d = 0; d < 2; ++d)
  {
    this->Drawings[d].Constrain(from, to, traces[d]);
  }
  const int fromRoot = this->Component(from);
  const int toRoot = this->Component(to);
  if (fromRoot == toRoot)
  {
    std::vector<int> differing;
    if (this->NumberOfComponents > 1 && !this->SeparatesAlike(from, to, differing))
    {
      this->Drawings[0].SetConstrained(from, to, false);
      this->Drawings[1].SetConstrained(from, to, false);
      return { Refusal::Separates, -1, differing };
    }
  }
  else
  {
    this->Parents[std::max(fromRoot, toRoot)] = std::min(fromRoot, toRoot);
    --this->NumberOfComponents;
  }
  ++this->Degrees[from];
  ++this->Degrees[to];
  return {};
}

bool CommonMap::Flood(int domain, int start, std::size_t limit, std::vector<int>& region)
{
  const auto& triangles = this->Drawings[domain].GetTriangles();
  auto& marks = this->Marks[domain];
  marks.resize(triangles.size(), 0);
  const int mark = ++this->LastMark;
  region.assign(1, start);
  marks[start] = mark;
  for (std::size_t i = 0; i < region.size(); ++i)
  {
    const auto& t = triangles[region[i]];
    for (int k = 0; k < 3; ++k)
    {
      const int n = t.Neighbors[k];
      if (n >= 0 && !t.Constrained[k] && marks[n] != mark)
      {
        marks[n] = mark;
        region.push_back(n);
      }
    }
    if (region.size() > limit)
    {
      return false;
    }
  }
  return true;
}

std::vector<std::array<int, 2>> CommonMap::Signature(
  int domain, const std::vector<int>& region) const
{
  std::vector<std::array<int, 2>> signature;
  for (const int i : region)
  {
    const auto& t = this->Drawings[domain].GetTriangles()[i];
    for (int k = 0; k < 3; ++k)
    {
      if (t.Constrained[k])
      {
        signature.push_back({ t.Vertices[NextCorner(k)], t.Vertices[PreviousCorner(k)] });
      }
      if (this->Degrees[t.Vertices[k]] == 0)
      {
        signature.push_back({ t.Vertices[k], t.Vertices[k] });
      }
    }
  }
  std::sort(signature.begin(), signature.end());
  signature.erase(std::unique(signature.begin(), signature.end()), signature.end());
  return signature;
}

bool CommonMap::SeparatesAlike(int from, int to, std::vector<int>& differing)
{
  // Find the smaller of the two new faces by flood fills from both sides with doubling limits. So
  // all splits together take O(n log n) steps.
  std::array<int, 2> ends{ { from, to } };
  std::array<std::vector<int>, 2> regions;
  for (std::size_t limit = 8;; limit *= 2)
  {
    const auto left = this->Drawings[0].FindEdge(ends[0], ends[1]);
    if (this->Flood(0, left.Triangle, limit, regions[0]))
    {
      break;
    }
    std::swap(ends[0], ends[1]);
    const auto right = this->Drawings[0].FindEdge(ends[0], ends[1]);
    if (this->Flood(0, right.Triangle, limit, regions[0]))
    {
      break;
    }
    std::swap(ends[0], ends[1]);
  }
  const int start = this->Drawings[1].FindEdge(ends[0], ends[1]).Triangle;
  const bool sameSize = this->Flood(1, start, regions[0].size(), regions[1]);
  if (sameSize && this->Signature(0, regions[0]) == this->Signature(1, regions[1]))
  {
    return true;
  }
  this->Flood(1, start, this->Drawings[1].GetTriangles().size(), regions[1]);
  const auto signature0 = this->Signature(0, regions[0]);
  const auto signature1 = this->Signature(1, regions[1]);
  std::vector<std::array<int, 2>> difference;
  std::set_symmetric_difference(signature0.begin(), signature0.end(), signature1.begin(),
    signature1.end(), std::back_inserter(difference));
  for (const auto& pair : difference)
  {
    for (const int vertex : pair)
    {
      if (vertex >= Triangulation::BoxCorners)
      {
        differing.push_back(vertex);
      }
    }
  }
  std::sort(differing.begin(), differing.end());
  differing.erase(std::unique(differing.begin(), differing.end()), differing.end());
  return false;
}

void CommonMap::MarkOutside(const std::vector<std::array<int, 2>>& loopEdges)
{
  std::map<std::array<int, 2>, int> parity;
  for (const auto& edge : loopEdges)
  {
    parity[{ std::min(edge[0], edge[1]), std::max(edge[0], edge[1]) }] ^= 1;
  }
  for (Triangulation& drawing : this->Drawings)
  {
    auto& triangles = drawing.GetTriangles();
    std::vector<char> seen(triangles.size(), 0);
    std::vector<int> stack{ drawing.GetTriangleOf(0) };
    seen[stack[0]] = 1;
    triangles[stack[0]].Outside = true;
    while (!stack.empty())
    {
      const auto t = triangles[stack.back()];
      stack.pop_back();
      for (int k = 0; k < 3; ++k)
      {
        const int n = t.Neighbors[k];
        if (n < 0 || seen[n])
        {
          continue;
        }
        bool crossesLoop = false;
        if (t.Constrained[k])
        {
          const int a = t.Vertices[NextCorner(k)];
          const int b = t.Vertices[PreviousCorner(k)];
          const auto found = parity.find({ std::min(a, b), std::max(a, b) });
          crossesLoop = found != parity.end() && found->second != 0;
        }
        seen[n] = 1;
        triangles[n].Outside = t.Outside != crossesLoop;
        stack.push_back(n);
      }
    }
  }
}

std::vector<std::array<int, 2>> CommonMap::Candidates() const
{
  std::vector<std::array<int, 2>> edges;
  for (const Triangulation& drawing : this->Drawings)
  {
    for (const auto& t : drawing.GetTriangles())
    {
      for (int k = 0; k < 3 && !t.Outside; ++k)
      {
        const int a = t.Vertices[NextCorner(k)];
        const int b = t.Vertices[PreviousCorner(k)];
        if (a < b && !t.Constrained[k])
        {
          edges.push_back({ a, b });
        }
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<std::pair<double, std::array<int, 2>>> keyed;
  keyed.reserve(edges.size());
  for (const auto& edge : edges)
  {
    keyed.emplace_back(this->ScaledLength(edge[0], edge[1]), edge);
  }
  std::sort(keyed.begin(), keyed.end());
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    edges[i] = keyed[i].second;
  }
  return edges;
}

std::vector<int> CommonMap::Fan(int domain, int vertex, int before) const
{
  const auto& drawing = this->Drawings[domain];
  std::vector<int> fan;
  const int start =
    before < 0 ? drawing.GetTriangleOf(vertex) : drawing.FindEdge(vertex, before).Triangle;
  int t = start;
  do
  {
    fan.push_back(t);
    const int left = NextCorner(drawing.IndexOf(t, vertex));
    const auto& triangle = drawing.GetTriangles()[t];
    if (triangle.Constrained[left])
    {
      break;
    }
    t = triangle.Neighbors[left];
  } while (t != start);
  return fan;
}

std::vector<std::array<int, 3>> CommonMap::FaceTriangles(
  int domain, const std::vector<int>& walk) const
{
  std::map<int, std::array<int, 3>> labels;
  const int m = static_cast<int>(walk.size());
  for (int i = 0; i < m; ++i)
  {
    // The corner between the edges to the next and to the previous vertex.
    for (const int t : this->Fan(domain, walk[i], walk[(i + 1) % m]))
    {
      labels[t][this->Drawings[domain].IndexOf(t, walk[i])] = i;
    }
  }
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(labels.size());
  for (const auto& entry : labels)
  {
    triangles.push_back(entry.second);
  }
  return triangles;
}

void CommonMap::Faces(std::vector<std::array<int, 3>>& closed, std::vector<Face>& faces) const
{
  const Triangulation& drawing = this->Drawings[0];
  const auto& triangles = drawing.GetTriangles();
  std::vector<char> seen(triangles.size(), 0);
  std::vector<int> region;
  for (std::size_t first = 0; first < triangles.size(); ++first)
  {
    if (seen[first] || triangles[first].Outside)
    {
      continue;
    }
    const auto& c = triangles[first].Constrained;
    if (c[0] && c[1] && c[2])
    {
      closed.push_back(triangles[first].Vertices);
      continue;
    }
    Face face;
    std::map<std::array<int, 2>, bool> halfEdges;
    region.assign(1, static_cast<int>(first));
    seen[first] = 1;
    std::vector<int> isolated;
    for (std::size_t i = 0; i < region.size(); ++i)
    {
      const auto& t = triangles[region[i]];
      for (int k = 0; k < 3; ++k)
      {
        if (this->Degrees[t.Vertices[k]] == 0)
        {
          isolated.push_back(t.Vertices[k]);
        }
        if (t.Constrained[k])
        {
          halfEdges[{ t.Vertices[NextCorner(k)], t.Vertices[PreviousCorner(k)] }] = false;
        }
        else if (!seen[t.Neighbors[k]])
        {
          seen[t.Neighbors[k]] = 1;
          region.push_back(t.Neighbors[k]);
        }
      }
    }
    for (auto& entry : halfEdges)
    {
      if (entry.second)
      {
        continue;
      }
      std::vector<int> walk;
      std::array<int, 2> edge = entry.first;
      do
      {
        halfEdges[edge] = true;
        walk.push_back(edge[0]);
        // The next constrained edge, clockwise about the end of this one.
        int t = drawing.FindEdge(edge[0], edge[1]).Triangle;
        for (;;)
        {
          const int right = PreviousCorner(drawing.IndexOf(t, edge[1]));
          if (triangles[t].Constrained[right])
          {
            edge = { edge[1], triangles[t].Vertices[PreviousCorner(right)] };
            break;
          }
          t = triangles[t].Neighbors[right];
        }
      } while (edge != entry.first);
      face.Walks.push_back(walk);
    }
    std::sort(isolated.begin(), isolated.end());
    isolated.erase(std::unique(isolated.begin(), isolated.end()), isolated.end());
    for (const int vertex : isolated)
    {
      face.Walks.push_back({ vertex });
    }
    if (face.Walks.size() == 1)
    {
      face.Triangles = { { this->FaceTriangles(0, face.Walks[0]),
        this->FaceTriangles(1, face.Walks[0]) } };
    }
    faces.push_back(std::move(face));
  }
}

std::vector<Vector2> CommonMap::Shorten(
  int domain, int from, int to, const std::vector<std::array<int, 2>>& portals) const
{
  const auto& points = this->Points[domain];
  std::vector<Vector2> bends;
  Vector2 at = points[from];
  const std::size_t n = portals.size();
  for (std::size_t next = 0; next < n;)
  {
    // The visible wedge narrows from portal to portal.
    Vector2 left = points[portals[next][0]];
    Vector2 right = points[portals[next][1]];
    std::size_t stop = next;
    Vector2 bend = left + 0.5 * (right - left);
    bool seesEnd = false;
    for (std::size_t i = next; i < n; ++i)
    {
      const Vector2 l = points[portals[i][0]];
      const Vector2 r = points[portals[i][1]];
      if (i > next)
      {
        // The share of the portal that is visible between the wedge's sides.
        const Vector2 along = r - l;
        const auto meet = [&](const Vector2& side) {
          const double denominator = Cross(side - at, along);
          return denominator != 0.0 ? Cross(l - at, side - at) / denominator : 0.5;
        };
        const double low = Cross(left - at, l - at) > 0.0 ? meet(left) : 0.0;
        const double high = Cross(right - at, r - at) < 0.0 ? meet(right) : 1.0;
        if (!(high > low) || Cross(left - at, r - at) >= 0.0 || Cross(right - at, l - at) <= 0.0)
        {
          break;
        }
        if (high - low >= VisibleShare)
        {
          stop = i;
          bend = l + (0.5 * (low + high)) * along;
        }
        left = low > 0.0 ? left : l;
        right = high < 1.0 ? right : r;
      }
      if (i + 1 == n)
      {
        const Vector2 end = points[to];
        seesEnd =
          Cross(left - at, end - at) < -GrazingAngle * Length(left - at) * Length(end - at) &&
          Cross(right - at, end - at) > GrazingAngle * Length(right - at) * Length(end - at);
      }
    }
    if (seesEnd)
    {
      break;
    }
    bends.push_back(bend);
    at = bend;
    next = stop + 1;
  }
  return bends;
}

std::vector<CommonMap::Path> CommonMap::FindPaths(
  int domain, int from, int before, const std::vector<std::array<int, 2>>& goals) const
{
  // Breadth-first search through the triangles of the face, from all triangles at the corner.
  const auto& drawing = this->Drawings[domain];
  std::map<int, int> cameFrom;
  std::vector<int> queue = this->Fan(domain, from, before);
  for (const int t : queue)
  {
    cameFrom[t] = -1;
  }
  for (std::size_t i = 0; i < queue.size(); ++i)
  {
    const auto& t = drawing.GetTriangles()[queue[i]];
    for (int k = 0; k < 3; ++k)
    {
      const Vector2 edge = drawing.GetPoint(t.Vertices[NextCorner(k)]) -
        drawing.GetPoint(t.Vertices[PreviousCorner(k)]);
      if (!t.Constrained[k] && Length(edge) > this->LeastPortals[domain] &&
        cameFrom.emplace(t.Neighbors[k], queue[i]).second)
      {
        queue.push_back(t.Neighbors[k]);
      }
    }
  }
  std::map<int, int> rank;
  for (std::size_t i = 0; i < queue.size(); ++i)
  {
    rank[queue[i]] = static_cast<int>(i);
  }
  std::vector<Path> paths;
  for (const auto& goal : goals)
  {
    int best = -1;
    for (const int t : this->Fan(domain, goal[0], goal[1]))
    {
      const auto reached = rank.find(t);
      if (reached != rank.end() && (best < 0 || reached->second < rank[best]))
      {
        best = t;
      }
    }
    if (best < 0)
    {
      paths.push_back({ false, {} });
      continue;
    }
    std::vector<std::array<int, 2>> portals;
    for (int t = best; cameFrom[t] >= 0; t = cameFrom[t])
    {
      const auto& triangle = drawing.GetTriangles()[t];
      int k = 0;
      while (triangle.Neighbors[k] != cameFrom[t])
      {
        ++k;
      }
      // In the direction of the path, the left end of the edge is the next corner of this triangle.
      portals.push_back({ triangle.Vertices[NextCorner(k)], triangle.Vertices[PreviousCorner(k)] });
    }
    std::reverse(portals.begin(), portals.end());
    paths.push_back({ true, this->Shorten(domain, from, goal[0], portals) });
  }
  return paths;
}

CommonMap::Drawn CommonMap::Draw(Route& route)
{
  const std::size_t count = std::max(route.Bends[0].size(), route.Bends[1].size());
  for (int d = 0; d < 2; ++d)
  {
    // Divide the longest pieces until both domains have the same number of bends.
    auto& bends = route.Bends[d];
    while (bends.size() < count)
    {
      std::size_t longest = 0;
      double length = -1.0;
      Vector2 middle;
      for (std::size_t i = 0; i <= bends.size(); ++i)
      {
        const Vector2 a = i == 0 ? this->Points[d][route.From] : bends[i - 1];
        const Vector2 b = i == bends.size() ? this->Points[d][route.To] : bends[i];
        if (Dot(b - a, b - a) > length)
        {
          length = Dot(b - a, b - a);
          longest = i;
          middle = a + 0.5 * (b - a);
        }
      }
      bends.insert(bends.begin() + static_cast<std::ptrdiff_t>(longest), middle);
    }
  }
  int previous = route.From;
  for (std::size_t i = 0; i <= count; ++i)
  {
    int vertex = route.To;
    if (i < count)
    {
      if (!this->Drawings[0].CanInsert(route.Bends[0][i]) ||
        !this->Drawings[1].CanInsert(route.Bends[1][i]))
      {
        return Drawn::No;
      }
      vertex = static_cast<int>(this->Points[0].size());
      for (int d = 0; d < 2; ++d)
      {
        this->Points[d].push_back(route.Bends[d][i]);
        this->Drawings[d].Insert(vertex);
      }
      this->Parents.push_back(vertex);
      this->Degrees.push_back(0);
      ++this->NumberOfComponents;
    }
    if (this->Add(previous, vertex).Why != Refusal::None)
    {
      return i == 0 && count == 0 ? Drawn::No : Drawn::Broken;
    }
    previous = vertex;
  }
  return Drawn::Yes;
}

CommonMap::Drawn CommonMap::Split(const Face& face)
{
  const auto& walk = face.Walks[0];
  const int m = static_cast<int>(walk.size());
  Route best;
  best.Cost = std::numeric_limits<double>::infinity();
  constexpr int starts = 24;
  for (int s = 0; s < std::min(m, starts); ++s)
  {
    const int i = static_cast<int>(static_cast<long long>(s) * m / std::min(m, starts));
    std::vector<std::array<int, 2>> goals;
    std::vector<int> cut;
    for (int offset = 2; offset <= m / 2; offset += 1 + offset / 4)
    {
      for (const int j : { (i + offset) % m, (i + m - offset) % m })
      {
        if (walk[j] != walk[i])
        {
          goals.push_back({ walk[j], walk[(j + 1) % m] });
          cut.push_back(std::min(offset, 64));
        }
      }
    }
    const auto paths0 = this->FindPaths(0, walk[i], walk[(i + 1) % m], goals);
    const auto paths1 = this->FindPaths(1, walk[i], walk[(i + 1) % m], goals);
    for (std::size_t k = 0; k < goals.size(); ++k)
    {
      // The number of bends per corner that is cut off. If there are too many, a part would have
      // more corners than the face.
      const double bends =
        static_cast<double>(std::max(paths0[k].Bends.size(), paths1[k].Bends.size()));
      const double cost = bends / cut[k];
      if (paths0[k].Exists && paths1[k].Exists && bends > 0.0 && cost < 0.4 && cost < best.Cost)
      {
        best = { walk[i], goals[k][0], { { paths0[k].Bends, paths1[k].Bends } }, cost };
      }
    }
  }
  return best.From < 0 ? Drawn::No : this->Draw(best);
}

CommonMap::Drawn CommonMap::Bridge(const Face& face)
{
  std::map<int, int> walkOf;
  std::size_t smallest = 0;
  for (std::size_t i = 0; i < face.Walks.size(); ++i)
  {
    if (face.Walks[i].size() < face.Walks[smallest].size())
    {
      smallest = i;
    }
    for (const int vertex : face.Walks[i])
    {
      walkOf.emplace(vertex, static_cast<int>(i));
    }
  }
  const auto& walk = face.Walks[smallest];
  std::vector<Route> routes;
  for (int d = 0; d < 2; ++d)
  {
    const auto& drawing = this->Drawings[d];
    for (std::size_t i = 0; i < walk.size(); ++i)
    {
      const int from = walk[i];
      const int before = walk.size() > 1 ? walk[(i + 1) % walk.size()] : -1;
      std::vector<std::array<int, 2>> goals;
      for (const int t : this->Fan(d, from, before))
      {
        const int k = drawing.IndexOf(t, from);
        const int to = drawing.GetTriangles()[t].Vertices[PreviousCorner(k)];
        const auto found = walkOf.find(to);
        if (found != walkOf.end() && found->second != static_cast<int>(smallest))
        {
          const int toBefore =
            drawing.ConstrainedNeighborBefore(to, from, drawing.Follow(to, from));
          goals.push_back({ to, toBefore });
        }
      }
      // The route is straight in this domain and has few bends in the other one.
      const auto paths = this->FindPaths(1 - d, from, before, goals);
      for (std::size_t k = 0; k < goals.size(); ++k)
      {
        if (paths[k].Exists)
        {
          Route route{ from, goals[k][0], {}, static_cast<double>(paths[k].Bends.size()) };
          route.Bends[1 - d] = paths[k].Bends;
          routes.push_back(std::move(route));
        }
      }
    }
  }
  const auto best =
    std::min_element(routes.begin(), routes.end(), [&](const Route& a, const Route& b) {
      return std::make_pair(a.Cost, this->ScaledLength(a.From, a.To)) <
        std::make_pair(b.Cost, this->ScaledLength(b.From, b.To));
    });
  return best == routes.end() ? Drawn::No : this->Draw(*best);
}

} // namespace homeomorphism
