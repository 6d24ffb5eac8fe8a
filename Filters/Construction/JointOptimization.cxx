// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "JointOptimization.h"

#include "Kernel/ExactSign.h"
#include "RegionRefilling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <utility>

namespace homeomorphism
{
namespace
{

/// Larger outlines of one or two stars are not filled by diagonals, which would take too long.
constexpr int LargestOutline = 40;
/// If the motion of a vertex affects more free vertices than this, only those near it are moved
/// with it.
constexpr std::size_t LargestMovedSet = 40;
/// Meshes with more free vertices are not smoothed as a whole.
constexpr int MaximumSmoothed = 5000;
/// Points are not merged while there are more added points than this.
constexpr int MaximumMerged = 20000;
/// Meshes with more added points are not refilled by regions.
constexpr int MaximumRefilled = 100;
/// The sizes of these regions, in triangles.
constexpr std::array<int, 4> RegionSizes{ { 6, 10, 18, 32 } };
/// The number of regions of each size that are tried around a point, and the number of rounds.
constexpr int RegionTurns = 12;
constexpr int RegionRounds = 8;
/// Meshes with more free vertices are not improved by moving single vertices.
constexpr int MaximumSettled = 1000;
constexpr int SettlingPasses = 4;
/// AddPoints stops, or accepts the worst triangle, after this many points without improvement.
constexpr int IdlePoints = 7;
/// The number of points without improvement for each triangle after the first accepted one.
constexpr int IdlePointsLater = 2;
/// In meshes with more free vertices, points are not removed in order to insert others elsewhere.
constexpr std::size_t MaximumRelocated = 20;

/// Minimization by L-BFGS; the search direction is that of algorithm 7.4 in Nocedal, Wright,
/// "Numerical Optimization", 2006. @a evaluate returns the value of the objective, which is
/// infinite outside the feasible set, and computes the gradient. @a firstStep is the largest
/// component of the first step.
void Minimize(std::vector<double>& x,
  const std::function<double(const std::vector<double>&, std::vector<double>&)>& evaluate,
  double firstStep, int steps)
{
  constexpr std::size_t memory = 8;
  const std::size_t n = x.size();
  const auto dot = [n](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i)
    {
      sum += a[i] * b[i];
    }
    return sum;
  };
  std::vector<std::vector<double>> moves;
  std::vector<std::vector<double>> changes;
  std::vector<double> gradient(n);
  std::vector<double> nextGradient(n);
  std::vector<double> next(n);
  double value = evaluate(x, gradient);
  for (int step = 0; step < steps && std::isfinite(value); ++step)
  {
    std::vector<double> direction = gradient;
    std::vector<double> shares(moves.size());
    for (std::size_t i = moves.size(); i-- > 0;)
    {
      shares[i] = dot(moves[i], direction) / dot(moves[i], changes[i]);
      for (std::size_t k = 0; k < n; ++k)
      {
        direction[k] -= shares[i] * changes[i][k];
      }
    }
    if (!moves.empty())
    {
      const double scale = dot(moves.back(), changes.back()) / dot(changes.back(), changes.back());
      for (double& component : direction)
      {
        component *= scale;
      }
    }
    for (std::size_t i = 0; i < moves.size(); ++i)
    {
      const double share = shares[i] - dot(changes[i], direction) / dot(moves[i], changes[i]);
      for (std::size_t k = 0; k < n; ++k)
      {
        direction[k] += share * moves[i][k];
      }
    }
    const double slope = -dot(gradient, direction);
    double largest = 0.0;
    for (const double component : direction)
    {
      largest = std::max(largest, std::abs(component));
    }
    if (!(slope < 0.0) || !(largest > 0.0))
    {
      return;
    }
    double length = moves.empty() ? firstStep / largest : std::min(1.0, 20.0 * firstStep / largest);
    double nextValue = value;
    bool found = false;
    for (int trial = 0; trial < 25 && !found; ++trial, length *= 0.5)
    {
      for (std::size_t k = 0; k < n; ++k)
      {
        next[k] = x[k] - length * direction[k];
      }
      nextValue = evaluate(next, nextGradient);
      found = nextValue <= value + 1e-4 * length * slope;
    }
    if (!found)
    {
      if (moves.empty())
      {
        return;
      }
      // No decrease in the search direction: restart with steepest descent.
      moves.clear();
      changes.clear();
      continue;
    }
    std::vector<double> move(n);
    std::vector<double> change(n);
    for (std::size_t k = 0; k < n; ++k)
    {
      move[k] = next[k] - x[k];
      change[k] = nextGradient[k] - gradient[k];
    }
    if (dot(move, change) > 1e-12 * std::sqrt(dot(move, move) * dot(change, change)))
    {
      moves.push_back(std::move(move));
      changes.push_back(std::move(change));
      if (moves.size() > memory)
      {
        moves.erase(moves.begin());
        changes.erase(changes.begin());
      }
    }
    const bool stalled = value - nextValue < 1e-7 * (std::abs(value) + 1e-3);
    x = next;
    gradient = nextGradient;
    value = nextValue;
    if (stalled)
    {
      return;
    }
  }
}

} // namespace

JointOptimization::JointOptimization(PairMesh& mesh, std::function<bool()> keepGoing)
  : Mesh(mesh)
  , KeepGoing(std::move(keepGoing))
{
}

void JointOptimization::FlipAround(std::vector<int> triangles)
{
  std::vector<int> made;
  while (!triangles.empty())
  {
    const int t = triangles.back();
    triangles.pop_back();
    for (int k = 0; k < 3; ++k)
    {
      if (this->Mesh.FlipIfBetter(t, k, made))
      {
        for (const int m : made)
        {
          triangles.push_back(m);
          for (const int n : this->Mesh.GetTriangles()[m].Neighbors)
          {
            if (n >= 0)
            {
              triangles.push_back(n);
            }
          }
        }
        break;
      }
    }
  }
}

void JointOptimization::Flip()
{
  std::vector<int> all;
  for (int t = static_cast<int>(this->Mesh.GetTriangles().size()); t-- > 0;)
  {
    all.push_back(t);
  }
  this->FlipAround(std::move(all));
}

std::vector<int> JointOptimization::FreeVerticesOf(const std::vector<int>& triangles) const
{
  std::vector<int> vertices;
  for (const int t : triangles)
  {
    for (const int v : this->Mesh.GetTriangles()[t].Vertices)
    {
      if (v >= this->Mesh.GetFirstAdded())
      {
        vertices.push_back(v);
      }
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  vertices.erase(std::remove_if(vertices.begin(), vertices.end(),
                   [this](int v) { return !this->Mesh.IsFree(v); }),
    vertices.end());
  return vertices;
}

std::vector<int> JointOptimization::MovedWith(int vertex) const
{
  std::vector<int> vertices;
  std::vector<int> next{ vertex };
  std::vector<int> star;
  while (next.size() > vertices.size() && next.size() <= LargestMovedSet)
  {
    vertices = next;
    std::vector<int> triangles;
    for (const int v : vertices)
    {
      this->Mesh.Star(v, star);
      triangles.insert(triangles.end(), star.begin(), star.end());
    }
    next = this->FreeVerticesOf(triangles);
  }
  if (next.size() <= LargestMovedSet)
  {
    return next;
  }
  this->Mesh.Star(vertex, star);
  return this->FreeVerticesOf(this->Mesh.Grow(this->Mesh.Grow(star)));
}

std::vector<int> JointOptimization::Neighborhood(int triangle, int rings) const
{
  std::vector<int> triangles{ triangle };
  for (int i = 0; i < rings; ++i)
  {
    triangles = this->Mesh.Grow(triangles);
  }
  return triangles;
}

void JointOptimization::SmoothDomain(
  const std::vector<int>& vertices, int domain, Goal goal, double sharpness, int steps)
{
  const auto& points = this->Mesh.GetPoints(domain);
  std::map<int, int> variable;
  std::vector<int> triangles;
  std::vector<int> star;
  for (const int v : vertices)
  {
    variable.emplace(v, static_cast<int>(variable.size()));
    this->Mesh.Star(v, star);
    triangles.insert(triangles.end(), star.begin(), star.end());
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  // The variables are displacements from the present positions, in units of a typical edge.
  struct Moving
  {
    TrianglePoints Start;
    TrianglePoints Other;
    std::array<int, 3> Variables;
  };
  std::vector<Moving> moving;
  double unit = 0.0;
  for (const int t : triangles)
  {
    Moving m{ this->Mesh.PointsOf(t, domain), this->Mesh.PointsOf(t, 1 - domain), {} };
    unit += std::sqrt(std::abs(Cross(m.Start[1] - m.Start[0], m.Start[2] - m.Start[0])));
    for (int k = 0; k < 3; ++k)
    {
      const auto found = variable.find(this->Mesh.GetTriangles()[t].Vertices[k]);
      m.Variables[k] = found == variable.end() ? -1 : 2 * found->second;
    }
    moving.push_back(m);
  }
  unit /= static_cast<double>(triangles.size());
  if (!(unit > 0.0))
  {
    return;
  }
  const QualityMeasure quality = this->Mesh.GetQuality();
  std::vector<std::array<QualityTerm, 9>> terms(moving.size());
  std::vector<int> counts(moving.size());
  const auto evaluate = [&](const std::vector<double>& x, std::vector<double>& gradient) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double least = infinity;
    for (std::size_t i = 0; i < moving.size(); ++i)
    {
      TrianglePoints p = moving[i].Start;
      for (int k = 0; k < 3; ++k)
      {
        const int at = moving[i].Variables[k];
        if (at >= 0)
        {
          p[k] = p[k] + unit * Vector2{ x[at], x[at + 1] };
        }
      }
      counts[i] = QualityTerms(quality, p, moving[i].Other, terms[i]);
      if (counts[i] == 0)
      {
        return infinity;
      }
      for (int k = 0; k < counts[i]; ++k)
      {
        least = std::min(least, terms[i][k].Value);
      }
    }
    std::fill(gradient.begin(), gradient.end(), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < moving.size(); ++i)
    {
      for (int k = 0; k < counts[i]; ++k)
      {
        double weight;
        if (goal == Goal::SoftMinimum)
        {
          weight = std::exp(-sharpness * (terms[i][k].Value - least));
          sum += weight;
        }
        else
        {
          // Bounded, so that a few very obtuse angles cost less than many slightly obtuse ones.
          const double excess = 91.0 - terms[i][k].Value;
          if (excess <= 0.0)
          {
            continue;
          }
          const double denominator = excess * excess + 64.0;
          sum += excess * excess / denominator;
          weight = 128.0 * excess / (denominator * denominator);
        }
        for (int c = 0; c < 3 && weight > 0.0; ++c)
        {
          const int at = moving[i].Variables[c];
          if (at >= 0)
          {
            gradient[at] -= weight * unit * terms[i][k].Gradient[c].x;
            gradient[at + 1] -= weight * unit * terms[i][k].Gradient[c].y;
          }
        }
      }
    }
    if (goal == Goal::ObtuseExcess)
    {
      return sum;
    }
    for (double& component : gradient)
    {
      component /= sum;
    }
    return std::log(sum) / sharpness - least;
  };
  std::vector<double> x(2 * vertices.size(), 0.0);
  Minimize(x, evaluate, 0.02, steps);
  const std::size_t mark = this->Mesh.Mark();
  for (const int v : vertices)
  {
    const int at = 2 * variable[v];
    this->Mesh.Move(v, domain, points[v] + unit * Vector2{ x[at], x[at + 1] });
  }
  bool positive = true;
  for (const int t : triangles)
  {
    const TrianglePoints p = this->Mesh.PointsOf(t, domain);
    positive = positive && Orientation(p[0], p[1], p[2]) > 0;
  }
  if (!positive)
  {
    this->Mesh.RollBack(mark);
    return;
  }
  for (const int t : triangles)
  {
    this->Mesh.Update(t);
  }
}

void JointOptimization::Smooth(const std::vector<int>& vertices, bool finish)
{
  if (vertices.empty())
  {
    return;
  }
  for (int d = 0; d < 2; ++d)
  {
    if (this->Mesh.GetQuality().Kind == PairQuality::NonObtuse)
    {
      this->SmoothDomain(vertices, d, Goal::ObtuseExcess, 1.0, 15);
    }
    this->SmoothDomain(vertices, d, Goal::SoftMinimum, 0.3, 15);
    this->SmoothDomain(vertices, d, Goal::SoftMinimum, 1.2, 15);
    if (finish)
    {
      for (const double sharpness : { 5.0, 20.0, 100.0 })
      {
        this->SmoothDomain(vertices, d, Goal::SoftMinimum, sharpness, 30);
      }
    }
  }
}

void JointOptimization::SmoothAndFlip(const std::vector<int>& vertices, bool finish)
{
  const std::size_t mark = this->Mesh.Mark();
  const double before = this->Mesh.Score();
  this->Smooth(vertices, finish);
  if (this->Mesh.Score() < before)
  {
    this->Mesh.RollBack(mark);
  }
  std::vector<int> triangles;
  std::vector<int> star;
  for (const int v : vertices)
  {
    this->Mesh.Star(v, star);
    triangles.insert(triangles.end(), star.begin(), star.end());
  }
  this->FlipAround(std::move(triangles));
}

void JointOptimization::Improve(int rounds)
{
  const std::vector<int> vertices = this->Mesh.FreeVertices();
  if (vertices.empty() || static_cast<int>(vertices.size()) > MaximumSmoothed)
  {
    return;
  }
  double score = this->Mesh.Score();
  for (int i = 0; i < rounds && this->KeepGoing(); ++i)
  {
    this->SmoothAndFlip(vertices, i + 1 == rounds);
    const double now = this->Mesh.Score();
    if (!(now > score + 1e-3))
    {
      break;
    }
    score = now;
  }
}

bool JointOptimization::RemovePoint(int vertex)
{
  std::vector<int> star;
  std::vector<int> outline;
  this->Mesh.Star(vertex, star);
  if (static_cast<int>(star.size()) > LargestOutline || !this->Mesh.Outline(star, outline))
  {
    return false;
  }
  return this->RefillWithout(star, outline);
}

bool JointOptimization::RefillWithout(
  const std::vector<int>& triangles, const std::vector<int>& outline)
{
  PolygonPair polygons;
  for (int d = 0; d < 2; ++d)
  {
    for (const int v : outline)
    {
      polygons[d].push_back(this->Mesh.GetPoints(d)[v]);
    }
  }
  CornerTriangles filled;
  if (!FillByDiagonals(polygons, this->Mesh.GetQuality(), filled))
  {
    return false;
  }
  for (auto& t : filled)
  {
    t = { outline[t[0]], outline[t[1]], outline[t[2]] };
  }
  this->Mesh.Replace(triangles, filled);
  return true;
}

bool JointOptimization::MergePoints(int vertex, int other)
{
  std::vector<int> triangles;
  std::vector<int> star;
  std::vector<int> outline;
  this->Mesh.Star(vertex, triangles);
  this->Mesh.Star(other, star);
  triangles.insert(triangles.end(), star.begin(), star.end());
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  if (static_cast<int>(triangles.size()) > LargestOutline ||
    !this->Mesh.Outline(triangles, outline) || triangles.size() != outline.size() + 2)
  {
    // The two stars do not form a disk with exactly these two interior vertices.
    return false;
  }
  PolygonPair polygons;
  for (int d = 0; d < 2; ++d)
  {
    for (const int v : outline)
    {
      polygons[d].push_back(this->Mesh.GetPoints(d)[v]);
    }
  }
  CornerTriangles filled;
  std::array<Vector2, 2> center;
  if (FillByDiagonals(polygons, this->Mesh.GetQuality(), filled))
  {
    for (auto& t : filled)
    {
      t = { outline[t[0]], outline[t[1]], outline[t[2]] };
    }
  }
  else if (FindStarCenter(polygons, center))
  {
    const int n = static_cast<int>(outline.size());
    for (int i = 0; i < n; ++i)
    {
      filled.push_back({ vertex, outline[i], outline[(i + 1) % n] });
    }
    this->Mesh.Move(vertex, 0, center[0]);
    this->Mesh.Move(vertex, 1, center[1]);
  }
  else
  {
    return false;
  }
  this->Mesh.Replace(triangles, filled);
  return true;
}

void JointOptimization::RemovePoints(bool mergePoints)
{
  std::vector<int> star;
  const auto neighbors = [&](int vertex) {
    std::vector<int> found;
    this->Mesh.Star(vertex, star);
    found.reserve(star.size());
    for (const int t : star)
    {
      found.push_back(
        this->Mesh.GetTriangles()[t].Vertices[NextCorner(this->Mesh.IndexOf(t, vertex))]);
    }
    return found;
  };
  for (int pass = 0; pass < 6; ++pass)
  {
    const int before = this->Mesh.CountAdded();
    const bool merge = mergePoints && before <= MaximumMerged;
    // Points in the queue. A point enters it again only when the mesh has changed near it.
    std::vector<char> queued(static_cast<std::size_t>(this->Mesh.GetNumberOfPoints()), 0);
    std::priority_queue<std::pair<int, int>, std::vector<std::pair<int, int>>, std::greater<>>
      queue;
    const auto enqueue = [&](int vertex) {
      if (this->Mesh.IsFree(vertex) && !queued[vertex])
      {
        this->Mesh.Star(vertex, star);
        queued[vertex] = 1;
        queue.emplace(static_cast<int>(star.size()), vertex);
      }
    };
    for (const int v : this->Mesh.FreeVertices())
    {
      enqueue(v);
    }
    while (!queue.empty() && this->KeepGoing())
    {
      const int vertex = queue.top().second;
      queue.pop();
      queued[vertex] = 0;
      if (!this->Mesh.IsFree(vertex))
      {
        continue;
      }
      const std::vector<int> around = neighbors(vertex);
      bool changed = this->RemovePoint(vertex);
      std::vector<int> further;
      for (std::size_t i = 0; i < around.size() && merge && !changed; ++i)
      {
        if (this->Mesh.IsFree(around[i]))
        {
          further = neighbors(around[i]);
          changed = this->MergePoints(vertex, around[i]);
        }
      }
      if (changed)
      {
        this->Mesh.Commit();
        enqueue(vertex);
        for (const int v : around)
        {
          enqueue(v);
        }
        for (const int v : further)
        {
          enqueue(v);
        }
      }
    }
    this->Mesh.Commit();
    if (mergePoints && !merge && this->Mesh.CountAdded() < MaximumMerged)
    {
      continue;
    }
    if (!merge || this->Mesh.CountAdded() == 0 || (pass > 1 && this->Mesh.CountAdded() == before))
    {
      return;
    }
    // Flipping edges and moving points may make more points removable.
    this->Flip();
    this->Improve(2);
    this->Mesh.Commit();
  }
}

void JointOptimization::RefillRegions()
{
  if (this->Mesh.CountAdded() > MaximumRefilled)
  {
    return;
  }
  for (int round = 0, idle = 0; round < RegionRounds && idle < 2; ++round)
  {
    const int before = this->Mesh.CountAdded();
    for (const int size : RegionSizes)
    {
      for (const int vertex : this->Mesh.FreeVertices())
      {
        for (int turn = 0; turn < RegionTurns && this->Mesh.IsFree(vertex) && this->KeepGoing();
             ++turn)
        {
          if (RefillRegion(this->Mesh, vertex, size, turn))
          {
            this->Mesh.Commit();
          }
        }
      }
    }
    idle = this->Mesh.CountAdded() < before ? 0 : idle + 1;
    // Flipping edges and moving points may make more points removable.
    this->Settle();
  }
}

void JointOptimization::Settle()
{
  std::vector<int> star;
  std::vector<int> outline;
  std::vector<Vector2> polygon;
  const std::vector<int> vertices = this->Mesh.FreeVertices();
  if (static_cast<int>(vertices.size()) > MaximumSettled)
  {
    return;
  }
  const auto worst = [&]() {
    double least = std::numeric_limits<double>::infinity();
    for (const int t : star)
    {
      this->Mesh.Update(t);
      least = std::min(least, this->Mesh.GetTriangles()[t].Quality);
    }
    return least;
  };
  for (int pass = 0; pass < SettlingPasses && this->KeepGoing(); ++pass)
  {
    this->Flip();
    for (const int vertex : vertices)
    {
      this->Mesh.Star(vertex, star);
      this->Mesh.Outline(star, outline);
      // Move the vertex in both domains or, if that does not help, in one of them.
      const double before = worst();
      bool moved = false;
      for (const int domains : { 3, 1, 2 })
      {
        const std::size_t mark = this->Mesh.Mark();
        for (int d = 0; d < 2 && !moved; ++d)
        {
          Vector2 center;
          polygon.clear();
          for (const int v : outline)
          {
            polygon.push_back(this->Mesh.GetPoints(d)[v]);
          }
          if ((domains & (1 << d)) != 0 && FindBestStarCenter(polygon, center))
          {
            this->Mesh.Move(vertex, d, center);
          }
        }
        moved = moved || worst() > before;
        if (!moved)
        {
          this->Mesh.RollBack(mark);
        }
      }
      worst();
    }
  }
  this->Mesh.Commit();
}

int JointOptimization::SplitTriangle(int t)
{
  const auto v = this->Mesh.GetTriangles()[t].Vertices;
  std::array<Vector2, 2> center;
  for (int d = 0; d < 2; ++d)
  {
    const TrianglePoints p = this->Mesh.PointsOf(t, d);
    center[d] = p[0] + (1.0 / 3.0) * ((p[1] - p[0]) + (p[2] - p[0]));
  }
  const std::size_t mark = this->Mesh.Mark();
  const int vertex = this->Mesh.AddPoint(center[0], center[1]);
  for (const int made : this->Mesh.Replace({ t },
         { { { vertex, v[0], v[1] } }, { { vertex, v[1], v[2] } }, { { vertex, v[2], v[0] } } }))
  {
    if (this->Mesh.GetTriangles()[made].Quality < 0.0)
    {
      this->Mesh.RollBack(mark);
      return -1;
    }
  }
  return vertex;
}

int JointOptimization::SplitEdge(int t, int k)
{
  const auto& triangle = this->Mesh.GetTriangles()[t];
  const int n = triangle.Neighbors[k];
  if (n < 0 || triangle.Fixed[k])
  {
    return -1;
  }
  const int a = triangle.Vertices[k];
  const int b = triangle.Vertices[NextCorner(k)];
  const int c = triangle.Vertices[PreviousCorner(k)];
  const int d = this->Mesh.GetTriangles()[n].Vertices[NextCorner(this->Mesh.IndexOf(n, b))];
  std::array<Vector2, 2> middle;
  for (int i = 0; i < 2; ++i)
  {
    const auto& p = this->Mesh.GetPoints(i);
    middle[i] = p[b] + 0.5 * (p[c] - p[b]);
  }
  const std::size_t mark = this->Mesh.Mark();
  const int vertex = this->Mesh.AddPoint(middle[0], middle[1]);
  for (const int made :
    this->Mesh.Replace({ t, n },
      { { { vertex, a, b } }, { { vertex, b, d } }, { { vertex, d, c } }, { { vertex, c, a } } }))
  {
    if (this->Mesh.GetTriangles()[made].Quality < 0.0)
    {
      this->Mesh.RollBack(mark);
      return -1;
    }
  }
  return vertex;
}

bool JointOptimization::InsertNear(int worst)
{
  // Candidates: centroids (edge -1) and midpoints of edges near the worst triangle.
  std::vector<std::pair<double, std::pair<int, int>>> tried;
  const std::vector<int> near = this->Neighborhood(worst, 2);
  const auto insert = [&](const std::pair<int, int>& place, int rounds) {
    const int vertex = place.second < 0 ? this->SplitTriangle(place.first)
                                        : this->SplitEdge(place.first, place.second);
    if (vertex < 0)
    {
      return false;
    }
    std::vector<int> star;
    this->Mesh.Star(vertex, star);
    this->FlipAround(star);
    for (int i = 0; i < rounds; ++i)
    {
      this->SmoothAndFlip(this->MovedWith(vertex), rounds > 1 && i + 1 == rounds);
    }
    return true;
  };
  const std::size_t mark = this->Mesh.Mark();
  for (const int t : near)
  {
    for (int k = -1; k < 3; ++k)
    {
      if (k < 0 || this->Mesh.GetTriangles()[t].Neighbors[k] < t)
      {
        if (insert({ t, k }, 1))
        {
          tried.push_back({ -this->Mesh.Score(), { t, k } });
        }
        this->Mesh.RollBack(mark);
      }
    }
  }
  std::sort(tried.begin(), tried.end());
  if (tried.empty())
  {
    return false;
  }
  const std::size_t finalists = std::min<std::size_t>(3, tried.size());
  std::size_t best = 0;
  double bestScore = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < finalists; ++i)
  {
    insert(tried[i].second, 4);
    if (this->Mesh.Score() > bestScore)
    {
      bestScore = this->Mesh.Score();
      best = i;
    }
    this->Mesh.RollBack(mark);
  }
  insert(tried[best].second, 4);
  return true;
}

bool JointOptimization::Relocate()
{
  const double before = this->Mesh.Score();
  for (const int vertex : this->Mesh.FreeVertices())
  {
    if (!this->KeepGoing())
    {
      return false;
    }
    const std::size_t mark = this->Mesh.Mark();
    std::vector<int> star;
    this->Mesh.Star(vertex, star);
    if (this->RemovePoint(vertex))
    {
      this->Flip();
      if (this->InsertNear(this->Mesh.Worst()) && this->Mesh.Score() > before + 1e-2)
      {
        return true;
      }
    }
    this->Mesh.RollBack(mark);
  }
  return false;
}

bool JointOptimization::FlipAndMove()
{
  const double before = this->Mesh.Score();
  std::vector<int> made;
  for (const int t : this->Neighborhood(this->Mesh.Worst(), 2))
  {
    for (int k = 0; k < 3 && this->KeepGoing(); ++k)
    {
      const std::size_t mark = this->Mesh.Mark();
      if (this->Mesh.GetTriangles()[t].Neighbors[k] < t && this->Mesh.Flip(t, k, 0.0, made))
      {
        const std::vector<int> vertices =
          this->FreeVerticesOf(this->Mesh.Grow(this->Mesh.Grow(this->Mesh.Grow(made))));
        this->Smooth(vertices, true);
        if (this->Mesh.Score() > before + 1e-2)
        {
          this->SmoothAndFlip(vertices, true);
          return true;
        }
        this->Mesh.RollBack(mark);
      }
    }
  }
  return false;
}

bool JointOptimization::Exchange()
{
  const double before = this->Mesh.Score();
  const std::size_t mark = this->Mesh.Mark();
  if (!this->InsertNear(this->Mesh.Worst()))
  {
    return false;
  }
  const auto remove = [this](int vertex) {
    std::vector<int> star;
    this->Mesh.Star(vertex, star);
    std::vector<int> vertices = this->FreeVerticesOf(this->Mesh.Grow(this->Mesh.Grow(star)));
    vertices.erase(std::remove(vertices.begin(), vertices.end(), vertex), vertices.end());
    if (!this->RemovePoint(vertex))
    {
      return false;
    }
    this->Flip();
    for (int i = 0; i < 3; ++i)
    {
      this->SmoothAndFlip(vertices, i == 2);
    }
    return true;
  };
  // Remove the point whose removal leaves the best mesh.
  const std::size_t inserted = this->Mesh.Mark();
  int best = -1;
  double bestScore = before + 1e-2;
  for (const int vertex : this->Mesh.FreeVertices())
  {
    if (this->KeepGoing() && remove(vertex) && this->Mesh.Score() > bestScore)
    {
      best = vertex;
      bestScore = this->Mesh.Score();
    }
    this->Mesh.RollBack(inserted);
  }
  if (best < 0)
  {
    this->Mesh.RollBack(mark);
    return false;
  }
  return remove(best);
}

void JointOptimization::AddPoints(double target, int maximum)
{
  const PairQuality kind = this->Mesh.GetQuality().Kind;
  // For these qualities, the share of triangles that reach the target matters, not only the worst
  // triangle.
  const bool isShare = kind == PairQuality::Concordance || kind == PairQuality::NonObtuse;
  const double least = isShare ? 0.5 * this->Mesh.GetQuality().Thin : 0.0;
  this->Mesh.Commit();
  PairMesh best = this->Mesh;
  double bestQuality = best.WorstQuality();
  int idle = 0;
  const auto keepBest = [&]() {
    const double quality = this->Mesh.WorstQuality();
    if (quality > bestQuality + 1e-6 && this->Mesh.SmallestAngle() >= least)
    {
      this->Mesh.Commit();
      best = this->Mesh;
      bestQuality = quality;
      idle = 0;
    }
  };
  this->Improve(3);
  this->Mesh.Commit();
  keepBest();
  while (bestQuality < target && this->Mesh.CountAdded() < maximum && this->KeepGoing())
  {
    const bool inserted = this->InsertNear(this->Mesh.Worst());
    this->Mesh.Commit();
    ++idle;
    keepBest();
    if (!inserted || idle >= IdlePoints)
    {
      if (!isShare)
      {
        break;
      }
      // Further points do not improve the worst triangle: continue with the next worst one.
      this->Mesh = best;
      this->Mesh.Accept(this->Mesh.Worst());
      best = this->Mesh;
      bestQuality = best.WorstQuality();
      idle = IdlePoints - IdlePointsLater;
    }
  }
  const bool tryElsewhere = this->Mesh.FreeVertices().size() <= MaximumRelocated;
  for (int i = 0; i < 2 * maximum && bestQuality < target && this->KeepGoing(); ++i)
  {
    if (!(tryElsewhere && this->Relocate()) && !this->FlipAndMove() &&
      !(tryElsewhere && this->Exchange()))
    {
      break;
    }
    this->Mesh.Commit();
    keepBest();
  }
  this->Mesh = best;
}

void JointOptimization::Refine(const std::array<double, 2>& maximumArea, int maximum)
{
  const auto excess = [&](int t) {
    double largest = 0.0;
    for (int d = 0; d < 2; ++d)
    {
      const TrianglePoints p = this->Mesh.PointsOf(t, d);
      largest = std::max(largest, 0.5 * Cross(p[1] - p[0], p[2] - p[0]) / maximumArea[d]);
    }
    return largest;
  };
  int added = this->Mesh.CountAdded();
  std::priority_queue<std::pair<double, int>> queue;
  for (int t = 0; t < static_cast<int>(this->Mesh.GetTriangles().size()); ++t)
  {
    if (this->Mesh.GetTriangles()[t].Alive && excess(t) > 1.0)
    {
      queue.emplace(excess(t), t);
    }
  }
  while (!queue.empty() && added < maximum && this->KeepGoing())
  {
    const auto [size, t] = queue.top();
    queue.pop();
    if (!this->Mesh.GetTriangles()[t].Alive || excess(t) != size)
    {
      continue;
    }
    // The longest edge that is not fixed. Squared lengths are divided by the maximum areas, so that
    // both domains have equal weight.
    int longest = -1;
    double length = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      double sum = 0.0;
      for (int d = 0; d < 2; ++d)
      {
        const TrianglePoints p = this->Mesh.PointsOf(t, d);
        const Vector2 edge = p[NextCorner(k)] - p[PreviousCorner(k)];
        sum += Dot(edge, edge) / maximumArea[d];
      }
      if (!this->Mesh.GetTriangles()[t].Fixed[k] && sum > length)
      {
        longest = k;
        length = sum;
      }
    }
    std::vector<int> star;
    const int vertex = longest >= 0 ? this->SplitEdge(t, longest) : this->SplitTriangle(t);
    if (vertex < 0)
    {
      continue;
    }
    ++added;
    this->Mesh.Star(vertex, star);
    this->FlipAround(star);
    this->Mesh.Commit();
    this->Mesh.Star(vertex, star);
    for (const int made : this->Mesh.Grow(star))
    {
      if (excess(made) > 1.0)
      {
        queue.emplace(excess(made), made);
      }
    }
  }
}

} // namespace homeomorphism
