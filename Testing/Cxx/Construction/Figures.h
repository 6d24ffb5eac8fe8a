// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Figures.h
/// Figures in two domains for tests, and a check of pairs that shares no code with their
/// construction except the exact orientation of three points.

#ifndef Figures_h
#define Figures_h

#include "Construction/IsomorphicTriangulation.h"
#include "Kernel/ExactSign.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace figures
{

using namespace homeomorphism;

/// Uniform numbers, the same on every machine.
class Random
{
public:
  explicit Random(std::uint64_t seed)
    : State(seed)
  {
  }

  /// From 0 to 1.
  double operator()()
  {
    // SplitMix64.
    std::uint64_t z = (this->State += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

  double operator()(double low, double high) { return low + (high - low) * (*this)(); }

private:
  std::uint64_t State;
};

inline void Add(FigurePair& figure, const Vector2& source, const Vector2& target)
{
  figure.Points[0].push_back(source);
  figure.Points[1].push_back(target);
}

inline std::vector<int> Range(int first, int last)
{
  std::vector<int> range(static_cast<std::size_t>(last - first));
  std::iota(range.begin(), range.end(), first);
  return range;
}

/// Points in a square whose target is given by a map.
template <typename Map>
FigurePair Mapped(int count, std::uint64_t seed, Map&& map)
{
  Random random(seed);
  FigurePair figure;
  for (int i = 0; i < count; ++i)
  {
    const double x = random();
    const Vector2 p{ x, random() };
    Add(figure, p, map(p, random));
  }
  return figure;
}

inline FigurePair Smooth(int count, std::uint64_t seed)
{
  return Mapped(count, seed, [](const Vector2& p, Random&) {
    return Vector2{ p.x + 0.05 * std::sin(7.0 * p.y + 1.0), p.y + 0.05 * std::sin(6.0 * p.x) };
  });
}

inline FigurePair Noise(int count, double spacings, std::uint64_t seed)
{
  const double amplitude = spacings / std::sqrt(static_cast<double>(count));
  return Mapped(count, seed, [amplitude](const Vector2& p, Random& random) {
    const double x = random(-amplitude, amplitude);
    return Vector2{ p.x + x, p.y + random(-amplitude, amplitude) };
  });
}

inline FigurePair Unrelated(int count, std::uint64_t seed)
{
  return Mapped(count, seed, [](const Vector2&, Random& random) {
    const double x = random();
    return Vector2{ x, random() };
  });
}

/// A figure whose only cell is one loop through all points.
inline FigurePair Outline(const std::vector<Vector2>& source, const std::vector<Vector2>& target)
{
  FigurePair figure;
  figure.Points = { { source, target } };
  figure.Loops.push_back(Range(0, static_cast<int>(source.size())));
  return figure;
}

/// A band that winds round and round, of @a corners corners.
inline std::vector<Vector2> Spiral(int corners, double turns)
{
  const int half = corners / 2;
  std::vector<Vector2> outer;
  std::vector<Vector2> inner;
  for (int i = 0; i < half; ++i)
  {
    const double t = i / (half - 1.0);
    const double angle = 6.283185307179586 * turns * t;
    const double radius = 1.0 + turns * t;
    const Vector2 direction{ std::cos(angle), std::sin(angle) };
    outer.push_back((radius + 0.3) * direction);
    inner.push_back((radius - 0.3) * direction);
  }
  std::reverse(inner.begin(), inner.end());
  outer.insert(outer.end(), inner.begin(), inner.end());
  return outer;
}

/// A convex polygon.
inline std::vector<Vector2> Circle(int corners, double radius = 1.0, Vector2 center = {})
{
  std::vector<Vector2> points;
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 6.283185307179586 * i / corners;
    points.push_back(center + radius * Vector2{ std::cos(angle), std::sin(angle) });
  }
  return points;
}

/// A ring of two circles, the inner one turned in the target, with a third circle in its hole.
inline FigurePair Annulus(int corners, double turn, bool island)
{
  FigurePair figure;
  for (int circle = 0; circle < (island ? 3 : 2); ++circle)
  {
    figure.Loops.push_back(Range(circle * corners, (circle + 1) * corners));
    const double a = circle == 0 ? 0.0 : turn;
    for (const Vector2& p : Circle(corners, std::ldexp(4.0, -circle)))
    {
      Add(figure, p,
        { std::cos(a) * p.x - std::sin(a) * p.y, std::sin(a) * p.x + std::cos(a) * p.y });
    }
  }
  return figure;
}

/// A comb with teeth of two corners each; @a shift moves the numbering.
inline std::vector<Vector2> Comb(int corners, int shift)
{
  const int teeth = (corners - 2) / 2;
  std::vector<Vector2> points{ { 0.0, 0.0 }, { static_cast<double>(teeth), 0.0 } };
  for (int i = teeth; i-- > 0;)
  {
    points.push_back({ i + 1.0, 10.0 });
    points.push_back({ i + 0.5, 0.5 });
  }
  points.pop_back();
  points.push_back({ 0.5, 1.0 });
  std::rotate(
    points.begin(), points.begin() + shift % static_cast<int>(points.size()), points.end());
  return points;
}

/// A snake: a rectangle with slits from both sides by turns, of about @a corners corners. Two whose
/// numberings differ by a quarter need quadratically many added points (Aronov, Seidel, Souvaine
/// 1993).
inline std::vector<Vector2> Snake(int corners, bool shifted)
{
  const int slits = (corners - 4) / 3;
  const double height = 2.0 * (slits + 1);
  std::vector<Vector2> points{ { 0.0, 0.0 }, { 10.0, 0.0 } };
  for (int i = 2; i <= slits; i += 2)
  {
    points.insert(
      points.end(), { { 10.0, 2.0 * i - 0.2 }, { 1.0, 2.0 * i }, { 10.0, 2.0 * i + 0.2 } });
  }
  points.insert(points.end(), { { 10.0, height }, { 0.0, height } });
  for (int i = slits - 1 + slits % 2; i > 0; i -= 2)
  {
    points.insert(
      points.end(), { { 0.0, 2.0 * i + 0.2 }, { 9.0, 2.0 * i }, { 0.0, 2.0 * i - 0.2 } });
  }
  if (shifted)
  {
    std::rotate(points.begin(), points.begin() + static_cast<int>(points.size()) / 4, points.end());
  }
  return points;
}

/// A simple polygon around a random walk along a circle of varying radius.
inline std::vector<Vector2> RandomStar(int corners, Random& random)
{
  std::vector<Vector2> points;
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 6.283185307179586 * (i + 0.8 * random()) / corners;
    points.push_back(random(0.15, 1.0) * Vector2{ std::cos(angle), std::sin(angle) });
  }
  return points;
}

/// Landmarks as `id,source_x,source_y,target_x,target_y`; lines as point numbers, one a row.
inline bool Read(const std::string& name, FigurePair& figure, bool withLines)
{
  const char* folder = std::getenv("DHM_SHARED_DATA");
  const std::string base = std::string(folder ? folder : SHARED_DATA_DIR) + "/landmarks/" + name;
  std::ifstream file(base + ".csv");
  std::string line;
  if (!std::getline(file, line))
  {
    return false;
  }
  while (std::getline(file, line))
  {
    Vector2 p;
    Vector2 q;
    if (std::sscanf(line.c_str(), "%*d,%lf,%lf,%lf,%lf", &p.x, &p.y, &q.x, &q.y) == 4)
    {
      Add(figure, p, q);
    }
  }
  std::ifstream lines(base + "-lines.csv");
  while (withLines && std::getline(lines, line))
  {
    std::istringstream words(line);
    const std::vector<int> ids(std::istream_iterator<int>(words), {});
    if (ids.size() > 1)
    {
      figure.Lines.push_back(ids);
    }
  }
  return true;
}

/// The smallest angle of a complete result, in degrees.
inline double SmallestAngle(const IsomorphicTriangulationResult& result)
{
  const auto statistics = MeasureQualities(result.Points, result.Triangles);
  return std::min(statistics.MinimumAngle[0], statistics.MinimumAngle[1]);
}

/// Empty if a result is a pair of isomorphic triangulations of the figure, else what is wrong.
/// Triangles that are all counterclockwise, meet edge to edge, and end at the figure's loops only
/// cover the domain once if their areas add up to the area that the boundary surrounds.
inline std::string Check(const FigurePair& figure, const IsomorphicTriangulationResult& result)
{
  if (!result.IsComplete())
  {
    return result.Problems[0].Message();
  }
  std::set<std::pair<int, int>> edges;
  std::array<double, 2> areas{ { 0.0, 0.0 } };
  const std::array<double, 2> senses{ { 1.0, result.Mirrored ? -1.0 : 1.0 } };
  std::vector<char> used(result.OriginalIds.size(), 0);
  for (const auto& t : result.Triangles)
  {
    for (int d = 0; d < 2; ++d)
    {
      const auto& p = result.Points[d];
      if (Orientation(p[t[0]], p[t[1]], p[t[2]]) * senses[d] <= 0.0)
      {
        return "a triangle has the wrong orientation in domain " + std::to_string(d);
      }
      areas[d] += 0.5 * senses[d] * Cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
    }
    for (int k = 0; k < 3; ++k)
    {
      used[t[k]] = 1;
      if (!edges.emplace(t[k], t[(k + 1) % 3]).second)
      {
        return "an edge has two triangles on one side";
      }
    }
  }
  const auto has = [&](const std::array<int, 2>& edge) {
    return edges.count({ edge[0], edge[1] }) + edges.count({ edge[1], edge[0] }) > 0;
  };
  if (!std::all_of(result.LoopEdges.begin(), result.LoopEdges.end(), has) ||
    !std::all_of(result.Segments.begin(), result.Segments.end(), has))
  {
    return "an edge of the figure is missing";
  }
  std::array<double, 2> surrounded{ { 0.0, 0.0 } };
  std::set<std::pair<int, int>> loops;
  for (const auto& edge : result.LoopEdges)
  {
    loops.insert(std::minmax(edge[0], edge[1]));
  }
  for (const auto& [a, b] : edges)
  {
    if (edges.count({ b, a }) == 0)
    {
      if (loops.count(std::minmax(a, b)) == 0)
      {
        return "the boundary leaves the loops";
      }
      for (int d = 0; d < 2; ++d)
      {
        const auto& p = result.Points[d];
        surrounded[d] += 0.5 * senses[d] * Cross(p[a] - p[0], p[b] - p[0]);
      }
    }
  }
  for (int d = 0; d < 2; ++d)
  {
    if (!(std::abs(surrounded[d] - areas[d]) <= 1e-9 * areas[d]))
    {
      return "the triangles do not cover domain " + std::to_string(d);
    }
  }
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    const int id = i < figure.Points[0].size() ? static_cast<int>(i) : -1;
    if (!used[i] || result.OriginalIds[i] != id)
    {
      return "a point is not used or has a wrong number";
    }
    for (int d = 0; d < 2 && id >= 0; ++d)
    {
      if (result.Points[d][i].x != figure.Points[d][i].x ||
        result.Points[d][i].y != figure.Points[d][i].y)
      {
        return "a point has moved";
      }
    }
  }
  return "";
}

} // namespace figures

#endif
