// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PairMesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace homeomorphism
{
namespace
{

/// An edge as a number, the same for both directions, and one of its triangles.
struct KeyedEdge
{
  std::uint64_t Key;
  int Triangle;
  int Edge;
};

std::uint64_t EdgeKey(int a, int b)
{
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) |
    static_cast<std::uint64_t>(std::max(a, b));
}

/// The sharpness of Score, per degree.
constexpr double ScoreSharpness = 0.5;

} // namespace

PairMesh::PairMesh(const std::array<std::vector<Vector2>, 2>& points,
  const std::vector<std::array<int, 3>>& triangles, const std::vector<std::array<int, 2>>& fixed,
  int firstAdded, const QualityMeasure& quality)
  : Points(points)
  , Triangles(triangles.size())
  , TriangleOf(points[0].size(), -1)
  , FirstAdded(firstAdded)
  , Quality(quality)
{
  std::vector<KeyedEdge> edges;
  edges.reserve(3 * triangles.size() + fixed.size());
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
  {
    this->Triangles[t].Vertices = triangles[t];
    this->Triangles[t].Alive = true;
    for (int k = 0; k < 3; ++k)
    {
      this->TriangleOf[triangles[t][k]] = t;
      edges.push_back(
        { EdgeKey(triangles[t][NextCorner(k)], triangles[t][PreviousCorner(k)]), t, k });
    }
    this->Update(t);
  }
  for (const auto& edge : fixed)
  {
    edges.push_back({ EdgeKey(edge[0], edge[1]), -1, 0 });
  }
  std::sort(edges.begin(), edges.end(), [](const KeyedEdge& a, const KeyedEdge& b) {
    return a.Key != b.Key ? a.Key < b.Key : a.Triangle < b.Triangle;
  });
  for (std::size_t i = 0; i < edges.size();)
  {
    std::size_t end = i;
    while (end < edges.size() && edges[end].Key == edges[i].Key)
    {
      ++end;
    }
    std::size_t first = i;
    while (first < end && edges[first].Triangle < 0)
    {
      ++first;
    }
    for (std::size_t k = first; k < end; ++k)
    {
      Triangle& t = this->Triangles[edges[k].Triangle];
      t.Fixed[edges[k].Edge] = first > i || end - first == 1;
      if (end - first == 2)
      {
        t.Neighbors[edges[k].Edge] = edges[k == first ? first + 1 : first].Triangle;
      }
    }
    i = end;
  }
}

void PairMesh::SetQuality(const QualityMeasure& quality)
{
  this->Quality = quality;
  for (int t = 0; t < static_cast<int>(this->Triangles.size()); ++t)
  {
    this->Update(t);
  }
}

int PairMesh::IndexOf(int triangle, int vertex) const
{
  const auto& vertices = this->Triangles[triangle].Vertices;
  return vertices[0] == vertex ? 0 : (vertices[1] == vertex ? 1 : 2);
}

TrianglePoints PairMesh::PointsOf(int triangle, int domain) const
{
  const auto& v = this->Triangles[triangle].Vertices;
  const auto& points = this->Points[domain];
  return { points[v[0]], points[v[1]], points[v[2]] };
}

void PairMesh::Update(int triangle)
{
  Triangle& t = this->Triangles[triangle];
  t.Quality = t.Alive
    ? QualityOf(this->Quality, this->PointsOf(triangle, 0), this->PointsOf(triangle, 1))
    : std::numeric_limits<double>::infinity();
}

bool PairMesh::Star(int vertex, std::vector<int>& star) const
{
  star.clear();
  const int start = this->TriangleOf[vertex];
  int first = start;
  // Clockwise to the boundary, if there is one.
  for (;;)
  {
    const int n = this->Triangles[first].Neighbors[PreviousCorner(this->IndexOf(first, vertex))];
    if (n < 0 || n == start)
    {
      first = n < 0 ? first : start;
      break;
    }
    first = n;
  }
  for (int t = first; t >= 0;)
  {
    star.push_back(t);
    t = this->Triangles[t].Neighbors[NextCorner(this->IndexOf(t, vertex))];
    if (t == first)
    {
      return true;
    }
  }
  return false;
}

bool PairMesh::IsFree(int vertex) const
{
  if (vertex < this->FirstAdded || this->TriangleOf[vertex] < 0)
  {
    return false;
  }
  std::vector<int> star;
  if (!this->Star(vertex, star))
  {
    return false;
  }
  for (const int t : star)
  {
    if (this->Triangles[t].Fixed[PreviousCorner(this->IndexOf(t, vertex))])
    {
      return false;
    }
  }
  return true;
}

int PairMesh::CountAdded() const
{
  return static_cast<int>(std::count_if(this->TriangleOf.begin() + this->FirstAdded,
    this->TriangleOf.end(), [](int triangle) { return triangle >= 0; }));
}

std::vector<int> PairMesh::FreeVertices() const
{
  std::vector<int> vertices;
  for (int v = this->FirstAdded; v < this->GetNumberOfPoints(); ++v)
  {
    if (this->IsFree(v))
    {
      vertices.push_back(v);
    }
  }
  return vertices;
}

std::vector<int> PairMesh::Grow(const std::vector<int>& triangles) const
{
  std::vector<int> grown = triangles;
  std::vector<int> vertices;
  for (const int t : triangles)
  {
    const auto& v = this->Triangles[t].Vertices;
    vertices.insert(vertices.end(), v.begin(), v.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<int> star;
  std::vector<int> others;
  for (const int v : vertices)
  {
    this->Star(v, star);
    others.insert(others.end(), star.begin(), star.end());
  }
  std::vector<int> known = triangles;
  std::sort(known.begin(), known.end());
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  std::set_difference(
    others.begin(), others.end(), known.begin(), known.end(), std::back_inserter(grown));
  return grown;
}

bool PairMesh::Outline(const std::vector<int>& triangles, std::vector<int>& outline) const
{
  outline.clear();
  std::vector<std::array<int, 2>> edges;
  for (const int t : triangles)
  {
    const Triangle& triangle = this->Triangles[t];
    for (int k = 0; k < 3; ++k)
    {
      const bool inside = triangle.Neighbors[k] >= 0 &&
        std::find(triangles.begin(), triangles.end(), triangle.Neighbors[k]) != triangles.end();
      if (inside && triangle.Fixed[k])
      {
        return false;
      }
      if (!inside)
      {
        edges.push_back({ triangle.Vertices[NextCorner(k)], triangle.Vertices[PreviousCorner(k)] });
      }
    }
  }
  // The triangles form a disk if one edge leaves every boundary vertex and one walk contains all
  // edges.
  std::size_t at = 0;
  do
  {
    outline.push_back(edges[at][0]);
    std::size_t next = edges.size();
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      if (edges[i][0] == edges[at][1])
      {
        if (next < edges.size())
        {
          return false;
        }
        next = i;
      }
    }
    at = next;
  } while (at != 0 && outline.size() <= edges.size());
  return outline.size() == edges.size();
}

int PairMesh::Allocate()
{
  if (this->FreeTriangles.empty())
  {
    this->Triangles.emplace_back();
    return static_cast<int>(this->Triangles.size()) - 1;
  }
  const int t = this->FreeTriangles.back();
  this->FreeTriangles.pop_back();
  return t;
}

void PairMesh::Free(int triangle)
{
  this->Triangles[triangle] = Triangle();
  this->Update(triangle);
  this->FreeTriangles.push_back(triangle);
}

std::vector<int> PairMesh::Replace(
  const std::vector<int>& triangles, const std::vector<std::array<int, 3>>& vertices)
{
  struct Border
  {
    std::array<int, 2> Ends;
    int Neighbor;
    int NeighborEdge;
    bool Fixed;
  };
  Change change;
  change.Old = triangles;
  std::vector<Border> borders;
  for (const int t : triangles)
  {
    const Triangle& triangle = this->Triangles[t];
    change.Before.push_back(triangle);
    for (int k = 0; k < 3; ++k)
    {
      const int n = triangle.Neighbors[k];
      const bool outside =
        n < 0 || std::find(triangles.begin(), triangles.end(), n) == triangles.end();
      // A fixed edge inside remains; its other side is one of the new triangles.
      if (outside || triangle.Fixed[k])
      {
        const int next = triangle.Vertices[NextCorner(k)];
        borders.push_back({ { { next, triangle.Vertices[PreviousCorner(k)] } }, outside ? n : -1,
          n < 0 ? 0 : NextCorner(this->IndexOf(n, next)), triangle.Fixed[k] });
      }
    }
  }
  for (const int t : triangles)
  {
    for (const int v : this->Triangles[t].Vertices)
    {
      this->TriangleOf[v] = -1;
    }
  }
  for (const int t : triangles)
  {
    this->Free(t);
  }
  for (const auto& v : vertices)
  {
    const int t = this->Allocate();
    change.Made.push_back(t);
    this->Triangles[t] = Triangle();
    this->Triangles[t].Vertices = v;
    this->Triangles[t].Alive = true;
    this->Update(t);
    for (int k = 0; k < 3; ++k)
    {
      this->TriangleOf[v[k]] = t;
      const std::array<int, 2> ends{ { v[NextCorner(k)], v[PreviousCorner(k)] } };
      for (const Border& border : borders)
      {
        if (border.Ends == ends)
        {
          this->Triangles[t].Neighbors[k] = border.Neighbor;
          this->Triangles[t].Fixed[k] = border.Fixed;
          if (border.Neighbor >= 0)
          {
            this->Triangles[border.Neighbor].Neighbors[border.NeighborEdge] = t;
          }
        }
      }
      for (const int other : change.Made)
      {
        for (int j = 0; j < 3 && other != t; ++j)
        {
          const auto& w = this->Triangles[other].Vertices;
          if (w[NextCorner(j)] == ends[1] && w[PreviousCorner(j)] == ends[0])
          {
            this->Triangles[t].Neighbors[k] = other;
            this->Triangles[other].Neighbors[j] = t;
          }
        }
      }
    }
  }
  this->Changes.push_back(std::move(change));
  return this->Changes.back().Made;
}

int PairMesh::AddPoint(const Vector2& source, const Vector2& target)
{
  this->Points[0].push_back(source);
  this->Points[1].push_back(target);
  this->TriangleOf.push_back(-1);
  Change change;
  change.Vertex = this->GetNumberOfPoints() - 1;
  change.Domain = -1;
  this->Changes.push_back(change);
  return change.Vertex;
}

void PairMesh::Move(int vertex, int domain, const Vector2& position)
{
  Change change;
  change.Vertex = vertex;
  change.Domain = domain;
  change.Position = this->Points[domain][vertex];
  this->Changes.push_back(change);
  this->Points[domain][vertex] = position;
}

void PairMesh::RollBack(std::size_t mark)
{
  std::vector<int> star;
  while (this->Changes.size() > mark)
  {
    const Change change = std::move(this->Changes.back());
    this->Changes.pop_back();
    if (change.Vertex >= 0)
    {
      if (change.Domain < 0)
      {
        this->Points[0].pop_back();
        this->Points[1].pop_back();
        this->TriangleOf.pop_back();
        continue;
      }
      this->Points[change.Domain][change.Vertex] = change.Position;
      if (this->TriangleOf[change.Vertex] >= 0)
      {
        this->Star(change.Vertex, star);
        for (const int t : star)
        {
          this->Update(t);
        }
      }
      continue;
    }
    for (const int t : change.Made)
    {
      for (const int v : this->Triangles[t].Vertices)
      {
        this->TriangleOf[v] = -1;
      }
    }
    for (auto t = change.Made.rbegin(); t != change.Made.rend(); ++t)
    {
      this->Free(*t);
    }
    // The free numbers are a stack. Take them off it in reverse order of their release.
    for (std::size_t i = change.Old.size(); i-- > 0;)
    {
      const auto at =
        std::find(this->FreeTriangles.rbegin(), this->FreeTriangles.rend(), change.Old[i]);
      this->FreeTriangles.erase(std::next(at).base());
    }
    for (std::size_t i = 0; i < change.Old.size(); ++i)
    {
      this->Triangles[change.Old[i]] = change.Before[i];
    }
    for (const int t : change.Old)
    {
      const Triangle& triangle = this->Triangles[t];
      for (int k = 0; k < 3; ++k)
      {
        this->TriangleOf[triangle.Vertices[k]] = t;
        const int n = triangle.Neighbors[k];
        if (n >= 0)
        {
          const int next = triangle.Vertices[NextCorner(k)];
          this->Triangles[n].Neighbors[NextCorner(this->IndexOf(n, next))] = t;
        }
      }
    }
  }
}

bool PairMesh::FlipIfBetter(int t, int k, std::vector<int>& made)
{
  const int n = this->Triangles[t].Neighbors[k];
  // The margin keeps rounding from flipping an edge back and forth.
  return n >= 0 &&
    this->Flip(t, k, std::min(this->Triangles[t].Quality, this->Triangles[n].Quality) + 1e-9, made);
}

bool PairMesh::Flip(int t, int k, double least, std::vector<int>& made)
{
  const Triangle& triangle = this->Triangles[t];
  const int n = triangle.Neighbors[k];
  if (!triangle.Alive || n < 0 || triangle.Fixed[k])
  {
    return false;
  }
  const int a = triangle.Vertices[k];
  const int b = triangle.Vertices[NextCorner(k)];
  const int c = triangle.Vertices[PreviousCorner(k)];
  const int d = this->Triangles[n].Vertices[NextCorner(this->IndexOf(n, b))];
  for (const auto& v : { std::array<int, 3>{ { a, b, d } }, std::array<int, 3>{ { a, d, c } } })
  {
    const auto& p = this->Points[0];
    const auto& q = this->Points[1];
    if (!(QualityOf(this->Quality, { p[v[0]], p[v[1]], p[v[2]] }, { q[v[0]], q[v[1]], q[v[2]] }) >
          least))
    {
      return false;
    }
  }
  made = this->Replace({ t, n }, { { { a, b, d } }, { { a, d, c } } });
  return true;
}

void PairMesh::Accept(int triangle)
{
  // With the margin, rounding is not mistaken for a deterioration.
  Triangle& t = this->Triangles[triangle];
  t.AcceptedQuality = t.Quality - 1e-9;
}

int PairMesh::Worst() const
{
  int worst = -1;
  for (int t = 0; t < static_cast<int>(this->Triangles.size()); ++t)
  {
    const Triangle& triangle = this->Triangles[t];
    if (triangle.Alive && !triangle.IsAccepted() &&
      (worst < 0 || triangle.Quality < this->Triangles[worst].Quality))
    {
      worst = t;
    }
  }
  return worst;
}

double PairMesh::SmallestAngle() const
{
  double smallest = 180.0;
  for (int t = 0; t < static_cast<int>(this->Triangles.size()); ++t)
  {
    for (int d = 0; d < 2 && this->Triangles[t].Alive; ++d)
    {
      const auto angles = Angles(this->PointsOf(t, d));
      smallest = std::min({ smallest, angles[0], angles[1], angles[2] });
    }
  }
  return smallest;
}

double PairMesh::WorstQuality() const
{
  const int worst = this->Worst();
  return worst < 0 ? std::numeric_limits<double>::infinity() : this->Triangles[worst].Quality;
}

double PairMesh::Score() const
{
  const double worst = this->WorstQuality();
  double sum = 0.0;
  for (const Triangle& t : this->Triangles)
  {
    if (t.Quality - worst < 60.0 && !t.IsAccepted())
    {
      sum += std::exp(-ScoreSharpness * (t.Quality - worst));
    }
  }
  return worst - std::log(sum) / ScoreSharpness;
}

} // namespace homeomorphism
