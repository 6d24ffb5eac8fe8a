// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Mesh/PlanarPair.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace homeomorphism
{

//------------------------------------------------------------------------------
void PlanarPair::FindNeighbors()
{
  struct HalfEdge
  {
    std::int32_t Low;
    std::int32_t High;
    std::int32_t Triangle;
    std::int32_t Edge;
  };
  LargeVector<HalfEdge> halfEdges;
  halfEdges.reserve(3 * this->Triangles.size());
  for (int t = 0; t < this->GetNumberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const std::int32_t a = this->Triangles[t][NextCorner(k)];
      const std::int32_t b = this->Triangles[t][PreviousCorner(k)];
      halfEdges.push_back({ std::min(a, b), std::max(a, b), t, k });
    }
  }
  std::sort(halfEdges.begin(), halfEdges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.Low != b.Low ? a.Low < b.Low
                          : (a.High != b.High ? a.High < b.High : a.Triangle < b.Triangle);
  });
  this->Neighbors.assign(this->Triangles.size(), { -1, -1, -1 });
  for (std::size_t begin = 0; begin < halfEdges.size();)
  {
    std::size_t end = begin + 1;
    while (end < halfEdges.size() && halfEdges[end].Low == halfEdges[begin].Low &&
      halfEdges[end].High == halfEdges[begin].High)
    {
      ++end;
    }
    if (end == begin + 2)
    {
      const HalfEdge& a = halfEdges[begin];
      const HalfEdge& b = halfEdges[begin + 1];
      this->Neighbors[a.Triangle][a.Edge] = b.Triangle;
      this->Neighbors[b.Triangle][b.Edge] = a.Triangle;
    }
    begin = end;
  }
}

//------------------------------------------------------------------------------
double PlanarPair::GetRounding(int triangle, const Matrix2& derivative) const
{
  const std::array<Vector2, 3> corners = this->GetSourceCorners(triangle);
  const double length = std::max(Dot(corners[1], corners[1]), Dot(corners[2], corners[2]));
  return std::numeric_limits<double>::epsilon() * std::sqrt(length * SquaredNorm(derivative));
}

//------------------------------------------------------------------------------
PlanarPair PlanarPair::Refine() const
{
  PlanarPair fine;
  fine.Source = this->Source;
  fine.Target = this->Target;
  LargeVector<std::array<std::int32_t, 3>> middles(this->Triangles.size());
  for (int t = 0; t < this->GetNumberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int neighbor = this->Neighbors[t][k];
      if (neighbor >= 0 && neighbor < t)
      {
        middles[t][k] = middles[neighbor][this->GetSharedEdge(neighbor, t)];
        continue;
      }
      const std::int32_t a = this->Triangles[t][NextCorner(k)];
      const std::int32_t b = this->Triangles[t][PreviousCorner(k)];
      middles[t][k] = static_cast<std::int32_t>(fine.Source.size());
      fine.Source.push_back(this->Source[a] + 0.5 * (this->Source[b] - this->Source[a]));
      fine.Target.push_back(this->Target[a] + 0.5 * (this->Target[b] - this->Target[a]));
    }
  }
  fine.Triangles.reserve(4 * this->Triangles.size());
  for (int t = 0; t < this->GetNumberOfTriangles(); ++t)
  {
    const std::array<std::int32_t, 3>& m = middles[t];
    for (int c = 0; c < 3; ++c)
    {
      // Corner c of the child is corner c of its parent.
      std::array<std::int32_t, 3> child;
      child[c] = this->Triangles[t][c];
      child[NextCorner(c)] = m[PreviousCorner(c)];
      child[PreviousCorner(c)] = m[NextCorner(c)];
      fine.Triangles.push_back(child);
    }
    fine.Triangles.push_back(m);
  }
  fine.FindNeighbors();
  return fine;
}

//------------------------------------------------------------------------------
PointFans::PointFans(const PlanarPair& pair)
  : First(pair.Source.size(), -1)
  , Touching(pair.Source.size(), 0)
{
  LargeVector<std::int32_t> counts(pair.Source.size(), 0);
  for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const std::int32_t point = pair.Triangles[t][c];
      ++counts[point];
      // The edge from the corner to the next one is opposite the previous one.
      if (this->First[point] < 0 || pair.Neighbors[t][PreviousCorner(c)] < 0)
      {
        this->First[point] = t;
      }
    }
  }
  for (int point = 0; point < pair.GetNumberOfPoints(); ++point)
  {
    if (this->First[point] < 0)
    {
      continue;
    }
    std::int32_t t = this->First[point];
    std::int32_t count = 0;
    do
    {
      ++count;
      t = pair.Neighbors[t][NextCorner(pair.GetCorner(t, point))];
    } while (t >= 0 && t != this->First[point]);
    this->Touching[point] = count != counts[point];
  }
}

//------------------------------------------------------------------------------
std::vector<std::int32_t> PlanarPair::SeparateParts()
{
  std::vector<std::int32_t> taken;
  const PointFans fans(*this);
  if (std::count(fans.Touching.begin(), fans.Touching.end(), 1) == 0)
  {
    return taken;
  }
  std::vector<std::uint8_t> isUsed(this->Source.size(), 0);
  std::vector<std::array<std::uint8_t, 3>> isDone(this->Triangles.size(), { 0, 0, 0 });
  for (int t = 0; t < this->GetNumberOfTriangles(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const std::int32_t point = this->Triangles[t][c];
      if (isDone[t][c] != 0 || fans.Touching[point] == 0)
      {
        continue;
      }
      // Clockwise to the beginning of the fan, then counterclockwise to its end.
      int first = t;
      int before = this->Neighbors[t][PreviousCorner(c)];
      while (before >= 0 && before != t)
      {
        first = before;
        before = this->Neighbors[first][PreviousCorner(this->GetCorner(first, point))];
      }
      std::int32_t number = point;
      if (isUsed[point] != 0)
      {
        number = this->GetNumberOfPoints();
        taken.push_back(point);
        const Vector2 source = this->Source[point];
        const Vector2 target = this->Target[point];
        this->Source.push_back(source);
        this->Target.push_back(target);
      }
      isUsed[point] = 1;
      int at = first;
      do
      {
        const int corner = this->GetCorner(at, point);
        isDone[at][corner] = 1;
        this->Triangles[at][corner] = number;
        at = this->Neighbors[at][NextCorner(corner)];
      } while (at >= 0 && at != first);
    }
  }
  return taken;
}

//------------------------------------------------------------------------------
PointFan PointFans::Get(const PlanarPair& pair, int point) const
{
  PointFan fan;
  int t = this->First[point];
  while (t >= 0)
  {
    fan.Triangles.push_back(t);
    t = pair.Neighbors[t][NextCorner(pair.GetCorner(t, point))];
    if (t == this->First[point])
    {
      return fan;
    }
  }
  fan.Closed = false;
  return fan;
}

} // namespace homeomorphism
