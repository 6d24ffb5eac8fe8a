// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ConstrainedTriangulation.h"

#include "Kernel/ExactSign.h"

#include <algorithm>
#include <deque>
#include <numeric>

namespace homeomorphism
{
namespace
{

/// Position of a cell along the Hilbert curve through a grid of 2^bits cells in each direction.
std::uint64_t HilbertIndex(std::uint32_t x, std::uint32_t y, int bits)
{
  std::uint64_t index = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
  {
    const std::uint32_t rx = (x >> bit) & 1u;
    const std::uint32_t ry = (y >> bit) & 1u;
    index = 4 * index + ((3 * rx) ^ ry);
    if (ry == 0)
    {
      if (rx == 1)
      {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return index;
}

/// Whether two points on a line through a third are on the same side of it. Products of their
/// distances could underflow.
bool AreOnOneSide(const Vector2& from, const Vector2& a, const Vector2& b)
{
  return b.x != from.x ? (a.x > from.x) == (b.x > from.x) : (a.y > from.y) == (b.y > from.y);
}

/// A number from 0 to 63 that is k with probability 2^-(k + 1), always the same for an index.
int RandomLevel(std::uint64_t index)
{
  index = (index + 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
  index ^= index >> 31;
  index *= 0x94d049bb133111ebu;
  index ^= index >> 29;
  int level = 0;
  while (level < 63 && (index & 1u) == 0)
  {
    index >>= 1;
    ++level;
  }
  return level;
}

} // namespace

bool CertainlyInCircle(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d)
{
  const Vector2 u = a - d;
  const Vector2 v = b - d;
  const Vector2 w = c - d;
  const double uu = Dot(u, u);
  const double vv = Dot(v, v);
  const double ww = Dot(w, w);
  const double determinant = uu * Cross(v, w) + vv * Cross(w, u) + ww * Cross(u, v);
  const double permanent = uu * (std::abs(v.x * w.y) + std::abs(v.y * w.x)) +
    vv * (std::abs(w.x * u.y) + std::abs(w.y * u.x)) +
    ww * (std::abs(u.x * v.y) + std::abs(u.y * v.x));
  // Twice Shewchuk's bound, which is (10 + 96 u) u for the unit roundoff u.
  return determinant > 10.0 * std::numeric_limits<double>::epsilon() * permanent;
}

std::vector<int> HilbertOrder(const std::vector<Vector2>& points)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vector2 low{ infinity, infinity };
  Vector2 high{ -infinity, -infinity };
  for (const Vector2& p : points)
  {
    low = { std::min(low.x, p.x), std::min(low.y, p.y) };
    high = { std::max(high.x, p.x), std::max(high.y, p.y) };
  }
  constexpr int bits = 20;
  const double extent = std::max(high.x - low.x, high.y - low.y);
  const double scale = extent > 0.0 ? ((1 << bits) - 1) / extent : 0.0;
  std::vector<std::uint64_t> cells;
  cells.reserve(points.size());
  for (const Vector2& p : points)
  {
    cells.push_back(HilbertIndex(static_cast<std::uint32_t>((p.x - low.x) * scale),
      static_cast<std::uint32_t>((p.y - low.y) * scale), bits));
  }
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    if (cells[a] != cells[b])
    {
      return cells[a] < cells[b];
    }
    return std::make_pair(points[a].x, points[a].y) < std::make_pair(points[b].x, points[b].y);
  });
  return order;
}

ConstrainedTriangulation::ConstrainedTriangulation(std::vector<Vector2>& points)
  : Points(points)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vector2 low{ infinity, infinity };
  Vector2 high{ -infinity, -infinity };
  for (std::size_t i = BoxCorners; i < points.size(); ++i)
  {
    low = { std::min(low.x, points[i].x), std::min(low.y, points[i].y) };
    high = { std::max(high.x, points[i].x), std::max(high.y, points[i].y) };
  }
  const double margin = std::max({ high.x - low.x, high.y - low.y, 1e-30,
    1e-6 * std::max({ std::abs(low.x), std::abs(low.y), std::abs(high.x), std::abs(high.y) }) });
  points[0] = { low.x - margin, low.y - margin };
  points[1] = { high.x + margin, low.y - margin };
  points[2] = { high.x + margin, high.y + margin };
  points[3] = { low.x - margin, high.y + margin };
  this->Triangles.reserve(2 * points.size());
  this->Triangles.push_back({ { 0, 1, 2 }, { -1, 1, -1 }, { false, false, false }, false });
  this->Triangles.push_back({ { 0, 2, 3 }, { -1, -1, 0 }, { false, false, false }, false });
  this->TriangleOf.assign(points.size(), -1);
  this->TriangleOf[0] = this->TriangleOf[2] = 0;
  this->TriangleOf[1] = 0;
  this->TriangleOf[3] = 1;

  // Biased randomized insertion order (Amenta, Choi, Rote 2003); each round follows the curve.
  const std::vector<int> order =
    HilbertOrder(std::vector<Vector2>(points.begin() + BoxCorners, points.end()));
  std::vector<std::vector<int>> rounds(64);
  for (const int i : order)
  {
    rounds[RandomLevel(static_cast<std::uint64_t>(i))].push_back(i + BoxCorners);
  }
  for (auto round = rounds.rbegin(); round != rounds.rend(); ++round)
  {
    for (const int vertex : *round)
    {
      this->Insert(vertex);
    }
  }
}

int ConstrainedTriangulation::Sign(int a, int b, int c) const
{
  return Orientation(this->Points[a], this->Points[b], this->Points[c]);
}

int ConstrainedTriangulation::IndexOf(int triangle, int vertex) const
{
  const auto& vertices = this->Triangles[triangle].Vertices;
  return vertices[0] == vertex ? 0 : (vertices[1] == vertex ? 1 : 2);
}

ConstrainedTriangulation::Edge ConstrainedTriangulation::Twin(int triangle, int edge) const
{
  const int neighbor = this->Triangles[triangle].Neighbors[edge];
  if (neighbor < 0)
  {
    return {};
  }
  const int next = this->Triangles[triangle].Vertices[NextCorner(edge)];
  // The twin's edge is opposite the corner before the shared edge's end.
  return { neighbor, NextCorner(this->IndexOf(neighbor, next)) };
}

void ConstrainedTriangulation::Link(int triangle, int edge, int neighbor, int neighborEdge)
{
  this->Triangles[triangle].Neighbors[edge] = neighbor;
  if (neighbor >= 0)
  {
    this->Triangles[neighbor].Neighbors[neighborEdge] = triangle;
  }
}

int ConstrainedTriangulation::Locate(const Vector2& point, int& onEdge) const
{
  int triangle = this->Hint;
  int previous = -1;
  unsigned turn = 0;
  for (;;)
  {
    const Triangle& t = this->Triangles[triangle];
    onEdge = -1;
    int exit = -1;
    // Begin with a random edge: a walk that always tries the same edge first can cycle.
    turn = turn * 1664525u + 1013904223u;
    int k = static_cast<int>((turn >> 16) % 3u);
    for (int i = 0; i < 3 && exit < 0; ++i, k = NextCorner(k))
    {
      if (t.Neighbors[k] >= 0 && t.Neighbors[k] == previous)
      {
        continue;
      }
      const int sign = Orientation(this->Points[t.Vertices[NextCorner(k)]],
        this->Points[t.Vertices[PreviousCorner(k)]], point);
      if (sign < 0)
      {
        exit = k;
      }
      else if (sign == 0)
      {
        onEdge = k;
      }
    }
    if (exit < 0 || t.Neighbors[exit] < 0)
    {
      this->Hint = triangle;
      return triangle;
    }
    previous = triangle;
    triangle = t.Neighbors[exit];
  }
}

bool ConstrainedTriangulation::CanInsert(const Vector2& position) const
{
  const Vector2& low = this->Points[0];
  const Vector2& high = this->Points[2];
  if (!(position.x > low.x && position.x < high.x && position.y > low.y && position.y < high.y))
  {
    return false;
  }
  int onEdge = -1;
  const Triangle& t = this->Triangles[this->Locate(position, onEdge)];
  for (const int v : t.Vertices)
  {
    if (this->Points[v].x == position.x && this->Points[v].y == position.y)
    {
      return false;
    }
  }
  return onEdge < 0 || !t.Constrained[onEdge];
}

void ConstrainedTriangulation::Insert(int vertex)
{
  const Vector2 point = this->Points[vertex];
  if (static_cast<int>(this->TriangleOf.size()) <= vertex)
  {
    this->TriangleOf.resize(static_cast<std::size_t>(vertex) + 1, -1);
  }
  int onEdge = -1;
  const int t = this->Locate(point, onEdge);
  const int n = static_cast<int>(this->Triangles.size());
  this->TriangleOf[vertex] = t;
  if (onEdge >= 0)
  {
    // t = (a, b, c) with the point on bc, and its neighbor (d, c, b) become four.
    const Edge twin = this->Twin(t, onEdge);
    const Triangle old = this->Triangles[t];
    const int k = onEdge;
    const int a = old.Vertices[k];
    const int b = old.Vertices[NextCorner(k)];
    const int c = old.Vertices[PreviousCorner(k)];
    const bool fixed = old.Constrained[k];
    const Edge ca = this->Twin(t, NextCorner(k));
    const Edge ab = this->Twin(t, PreviousCorner(k));
    this->Triangles[t] = { { vertex, a, b }, { -1, -1, -1 },
      { old.Constrained[PreviousCorner(k)], fixed, false }, old.Outside };
    this->Triangles.push_back({ { vertex, c, a }, { -1, -1, -1 },
      { old.Constrained[NextCorner(k)], false, fixed }, old.Outside });
    this->Link(t, 0, ab.Triangle, ab.Index);
    this->Link(n, 0, ca.Triangle, ca.Index);
    this->Link(t, 2, n, 1);
    this->TriangleOf[a] = this->TriangleOf[b] = t;
    this->TriangleOf[c] = n;
    this->Doubtful.push_back({ t, 0 });
    this->Doubtful.push_back({ n, 0 });
    if (twin.Triangle >= 0)
    {
      const int o = twin.Triangle;
      const int j = twin.Index;
      const Triangle other = this->Triangles[o];
      const int d = other.Vertices[j];
      const Edge bd = this->Twin(o, NextCorner(j));
      const Edge dc = this->Twin(o, PreviousCorner(j));
      this->Triangles[o] = { { vertex, b, d }, { -1, -1, -1 },
        { other.Constrained[NextCorner(j)], false, fixed }, other.Outside };
      this->Triangles.push_back({ { vertex, d, c }, { -1, -1, -1 },
        { other.Constrained[PreviousCorner(j)], fixed, false }, other.Outside });
      this->Link(o, 0, bd.Triangle, bd.Index);
      this->Link(n + 1, 0, dc.Triangle, dc.Index);
      this->Link(t, 1, o, 2);
      this->Link(o, 1, n + 1, 2);
      this->Link(n + 1, 1, n, 2);
      this->TriangleOf[d] = o;
      this->Doubtful.push_back({ o, 0 });
      this->Doubtful.push_back({ n + 1, 0 });
    }
  }
  else
  {
    const Triangle old = this->Triangles[t];
    std::array<Edge, 3> twins;
    for (int k = 0; k < 3; ++k)
    {
      twins[k] = this->Twin(t, k);
    }
    const std::array<int, 3> parts{ { t, n, n + 1 } };
    this->Triangles.resize(this->Triangles.size() + 2);
    for (int k = 0; k < 3; ++k)
    {
      const int b = old.Vertices[NextCorner(k)];
      const int c = old.Vertices[PreviousCorner(k)];
      this->Triangles[parts[k]] = { { vertex, b, c },
        { -1, parts[NextCorner(k)], parts[PreviousCorner(k)] },
        { old.Constrained[k], false, false }, old.Outside };
      this->Link(parts[k], 0, twins[k].Triangle, twins[k].Index);
      this->TriangleOf[b] = parts[k];
      this->Doubtful.push_back({ parts[k], 0 });
    }
  }
  this->Legalize();
}

bool ConstrainedTriangulation::IsConvex(int t, int k) const
{
  const Edge twin = this->Twin(t, k);
  const auto& v = this->Triangles[t].Vertices;
  const int a = v[k];
  const int d = this->Triangles[twin.Triangle].Vertices[twin.Index];
  return this->Sign(a, v[NextCorner(k)], d) > 0 && this->Sign(a, d, v[PreviousCorner(k)]) > 0;
}

void ConstrainedTriangulation::Flip(int t, int k)
{
  const Edge twin = this->Twin(t, k);
  const int o = twin.Triangle;
  const int j = twin.Index;
  const Triangle left = this->Triangles[t];
  const Triangle right = this->Triangles[o];
  const int a = left.Vertices[k];
  const int b = left.Vertices[NextCorner(k)];
  const int c = left.Vertices[PreviousCorner(k)];
  const int d = right.Vertices[j];
  const Edge ca = this->Twin(t, NextCorner(k));
  const Edge ab = this->Twin(t, PreviousCorner(k));
  const Edge bd = this->Twin(o, NextCorner(j));
  const Edge dc = this->Twin(o, PreviousCorner(j));
  this->Triangles[t] = { { a, b, d }, { -1, o, -1 },
    { right.Constrained[NextCorner(j)], false, left.Constrained[PreviousCorner(k)] },
    left.Outside };
  this->Triangles[o] = { { a, d, c }, { -1, -1, t },
    { right.Constrained[PreviousCorner(j)], left.Constrained[NextCorner(k)], false },
    left.Outside };
  this->Link(t, 0, bd.Triangle, bd.Index);
  this->Link(t, 2, ab.Triangle, ab.Index);
  this->Link(o, 0, dc.Triangle, dc.Index);
  this->Link(o, 1, ca.Triangle, ca.Index);
  this->TriangleOf[a] = this->TriangleOf[b] = this->TriangleOf[d] = t;
  this->TriangleOf[c] = o;
}

void ConstrainedTriangulation::Legalize()
{
  // Flips can cycle where products of coordinates underflow, so their number is limited. Without
  // cycles, far fewer flips are needed. The triangulation is valid after each flip.
  std::size_t flipsLeft = 64 + 16 * this->Triangles.size();
  while (!this->Doubtful.empty())
  {
    const auto [t, k] = this->Doubtful.back();
    this->Doubtful.pop_back();
    const Edge twin = this->Twin(t, k);
    if (twin.Triangle < 0 || this->Triangles[t].Constrained[k])
    {
      continue;
    }
    const auto& v = this->Triangles[t].Vertices;
    const int d = this->Triangles[twin.Triangle].Vertices[twin.Index];
    if (CertainlyInCircle(
          this->Points[v[0]], this->Points[v[1]], this->Points[v[2]], this->Points[d]) &&
      this->IsConvex(t, k) && flipsLeft > 0)
    {
      --flipsLeft;
      this->Flip(t, k);
      this->Doubtful.push_back({ t, 0 });
      this->Doubtful.push_back({ t, 2 });
      this->Doubtful.push_back({ twin.Triangle, 0 });
      this->Doubtful.push_back({ twin.Triangle, 1 });
    }
  }
}

ConstrainedTriangulation::Edge ConstrainedTriangulation::FindEdge(int from, int to) const
{
  // Turn counterclockwise about the vertex. If the boundary of the box is reached, turn clockwise.
  bool clockwise = false;
  for (int t = this->TriangleOf[from];;)
  {
    const int i = this->IndexOf(t, from);
    if (this->Triangles[t].Vertices[NextCorner(i)] == to)
    {
      return { t, PreviousCorner(i) };
    }
    t = this->Triangles[t].Neighbors[clockwise ? PreviousCorner(i) : NextCorner(i)];
    if (t < 0)
    {
      clockwise = true;
      t = this->TriangleOf[from];
    }
  }
}

ConstrainedTriangulation::Trace ConstrainedTriangulation::Follow(int from, int to) const
{
  Trace trace;
  const int start = this->TriangleOf[from];
  int t = start;
  int entered = -1;
  do
  {
    const int i = this->IndexOf(t, from);
    const int right = this->Triangles[t].Vertices[NextCorner(i)];
    if (right == to)
    {
      trace.First = t;
      trace.IsEdge = true;
      return trace;
    }
    t = this->Triangles[t].Neighbors[NextCorner(i)];
  } while (t != start);
  do
  {
    const int i = this->IndexOf(t, from);
    const int right = this->Triangles[t].Vertices[NextCorner(i)];
    const int left = this->Triangles[t].Vertices[PreviousCorner(i)];
    const int rightSign = this->Sign(from, to, right);
    if (rightSign == 0 && AreOnOneSide(this->Points[from], this->Points[right], this->Points[to]))
    {
      trace.Result = Trace::Outcome::MeetsVertex;
      trace.Obstacle = { right, right };
      trace.First = t;
      return trace;
    }
    if (rightSign < 0 && this->Sign(from, to, left) > 0)
    {
      entered = t;
      break;
    }
    t = this->Triangles[t].Neighbors[NextCorner(i)];
  } while (t != start);
  trace.First = entered;
  int edge = this->IndexOf(entered, from);
  t = entered;
  for (;;)
  {
    const int right = this->Triangles[t].Vertices[NextCorner(edge)];
    const int left = this->Triangles[t].Vertices[PreviousCorner(edge)];
    if (this->Triangles[t].Constrained[edge])
    {
      trace.Result = Trace::Outcome::CrossesConstraint;
      trace.Obstacle = { right, left };
      return trace;
    }
    trace.Crossed.emplace_back(left, right);
    const Edge twin = this->Twin(t, edge);
    t = twin.Triangle;
    const int apex = this->Triangles[t].Vertices[twin.Index];
    if (apex == to)
    {
      return trace;
    }
    const int sign = this->Sign(from, to, apex);
    if (sign == 0)
    {
      trace.Result = Trace::Outcome::MeetsVertex;
      trace.Obstacle = { apex, apex };
      return trace;
    }
    // The twin is (apex, left, right) with the shared edge opposite the apex.
    edge = sign > 0 ? NextCorner(twin.Index) : PreviousCorner(twin.Index);
  }
}

void ConstrainedTriangulation::SetConstrained(int from, int to, bool constrained)
{
  const Edge edge = this->FindEdge(from, to);
  this->Triangles[edge.Triangle].Constrained[edge.Index] = constrained;
  const Edge twin = this->Twin(edge.Triangle, edge.Index);
  this->Triangles[twin.Triangle].Constrained[twin.Index] = constrained;
}

void ConstrainedTriangulation::Constrain(int from, int to, const Trace& trace)
{
  // Flip the crossed edges until none crosses the segment (Sloan 1993).
  std::deque<std::pair<int, int>> crossed(trace.Crossed.begin(), trace.Crossed.end());
  std::vector<std::pair<int, int>> made;
  while (!crossed.empty())
  {
    const auto [left, right] = crossed.front();
    crossed.pop_front();
    const Edge edge = this->FindEdge(left, right);
    if (!this->IsConvex(edge.Triangle, edge.Index))
    {
      crossed.emplace_back(left, right);
      continue;
    }
    this->Flip(edge.Triangle, edge.Index);
    const int a = this->Triangles[edge.Triangle].Vertices[0];
    const int d = this->Triangles[edge.Triangle].Vertices[2];
    const bool ends = a == from || a == to || d == from || d == to;
    const int signA = ends ? 0 : this->Sign(from, to, a);
    if (!ends && signA != this->Sign(from, to, d))
    {
      crossed.emplace_back(signA > 0 ? a : d, signA > 0 ? d : a);
    }
    else
    {
      made.emplace_back(a, d);
    }
  }
  this->SetConstrained(from, to, true);
  for (const auto& [a, d] : made)
  {
    this->Doubtful.push_back(this->FindEdge(a, d));
  }
  this->Legalize();
}

int ConstrainedTriangulation::ConstrainedNeighborBefore(int from, int to, const Trace& trace) const
{
  // Clockwise from the triangle that the segment enters, or the one to the left of the edge.
  int t = trace.First;
  const int start = t;
  do
  {
    const int i = this->IndexOf(t, from);
    const int right = this->Triangles[t].Vertices[NextCorner(i)];
    if (this->Triangles[t].Constrained[PreviousCorner(i)] && right != to)
    {
      return right;
    }
    t = this->Triangles[t].Neighbors[PreviousCorner(i)];
  } while (t != start);
  return -1;
}

} // namespace homeomorphism
