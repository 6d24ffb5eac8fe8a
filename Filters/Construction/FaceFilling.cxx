// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "FaceFilling.h"

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

/// A diagonal or side of a polygon: its corners, the lower number first.
using Chord = std::pair<int, int>;

Chord MakeChord(int a, int b)
{
  return a < b ? Chord(a, b) : Chord(b, a);
}

bool IsBetween(int corner, const Chord& chord)
{
  return chord.first < corner && corner < chord.second;
}

/// Whether two diagonals separate each other's ends.
bool Cross(const Chord& a, const Chord& b)
{
  return b.first != a.first && b.first != a.second && b.second != a.first && b.second != a.second &&
    IsBetween(b.first, a) != IsBetween(b.second, a);
}

/// A triangulation of a polygon by diagonals, which can be flipped.
class ChordTriangulation
{
public:
  explicit ChordTriangulation(const CornerTriangles& triangles)
  {
    for (const auto& t : triangles)
    {
      for (int k = 0; k < 3; ++k)
      {
        const Chord chord = MakeChord(t[NextCorner(k)], t[PreviousCorner(k)]);
        this->Apexes.emplace(chord, std::array<int, 2>{ { -1, -1 } });
        this->Apex(chord, t[k]) = t[k];
      }
    }
  }

  std::vector<Chord> Diagonals() const
  {
    std::vector<Chord> diagonals;
    for (const auto& entry : this->Apexes)
    {
      if (entry.second[0] >= 0 && entry.second[1] >= 0)
      {
        diagonals.push_back(entry.first);
      }
    }
    return diagonals;
  }

  bool Has(const Chord& chord) const { return this->Apexes.count(chord) != 0; }

  /// The diagonal that a flip would make.
  Chord Flipped(const Chord& chord) const
  {
    const auto& apexes = this->Apexes.at(chord);
    return MakeChord(apexes[0], apexes[1]);
  }

  void Flip(const Chord& chord)
  {
    const auto apexes = this->Apexes.at(chord);
    this->Apexes.erase(chord);
    for (int i = 0; i < 2; ++i)
    {
      const Chord first = MakeChord(chord.first, apexes[i]);
      const Chord second = MakeChord(chord.second, apexes[i]);
      this->Apex(first, chord.second) = apexes[1 - i];
      this->Apex(second, chord.first) = apexes[1 - i];
    }
    const Chord made = MakeChord(apexes[0], apexes[1]);
    this->Apexes.emplace(made, std::array<int, 2>{ { -1, -1 } });
    this->Apex(made, chord.first) = chord.first;
    this->Apex(made, chord.second) = chord.second;
  }

private:
  /// The third corner of a chord's triangle on the side where @a corner is.
  int& Apex(const Chord& chord, int corner)
  {
    return this->Apexes.at(chord)[IsBetween(corner, chord) ? 0 : 1];
  }

  std::map<Chord, std::array<int, 2>> Apexes;
};

int CrossingsOf(const Chord& chord, const std::vector<Chord>& others)
{
  int count = 0;
  for (const Chord& other : others)
  {
    count += Cross(chord, other) ? 1 : 0;
  }
  return count;
}

/// Whether a triangle is thick enough for added points on its edges, whose rounding could flip
/// needles.
bool IsThick(const Vector2& a, const Vector2& b, const Vector2& c)
{
  const double longest = std::max({ Dot(b - a, b - a), Dot(c - b, c - b), Dot(a - c, a - c) });
  return homeomorphism::Cross(b - a, c - a) > 1e-9 * longest;
}

/// Flips diagonals of both triangulations as long as one lowers the number of crossings.
void LowerCrossings(const PolygonPair& polygons, std::array<ChordTriangulation, 2>& chords)
{
  for (bool changed = true; changed;)
  {
    changed = false;
    for (int d = 0; d < 2; ++d)
    {
      const std::vector<Chord> others = chords[1 - d].Diagonals();
      const auto& points = polygons[d];
      for (const Chord& chord : chords[d].Diagonals())
      {
        const int before = CrossingsOf(chord, others);
        if (before == 0)
        {
          continue;
        }
        const Chord flipped = chords[d].Flipped(chord);
        // Counterclockwise: first, between, second, outside.
        const bool firstIsBetween = IsBetween(flipped.first, chord);
        const int between = firstIsBetween ? flipped.first : flipped.second;
        const int outside = firstIsBetween ? flipped.second : flipped.first;
        if (IsThick(points[outside], points[chord.first], points[between]) &&
          IsThick(points[between], points[chord.second], points[outside]) &&
          CrossingsOf(flipped, others) < before)
        {
          chords[d].Flip(chord);
          changed = true;
        }
      }
    }
  }
}

/// The rotation system of a planar map: the neighbors of each node, counterclockwise.
using Rotations = std::vector<std::vector<int>>;

/// The closed walks along the boundaries of the faces, with the face on the left.
std::vector<std::vector<int>> Walks(const Rotations& rotations)
{
  std::map<std::pair<int, int>, bool> walked;
  for (int node = 0; node < static_cast<int>(rotations.size()); ++node)
  {
    for (const int neighbor : rotations[node])
    {
      walked[{ node, neighbor }] = false;
    }
  }
  std::vector<std::vector<int>> walks;
  for (auto& entry : walked)
  {
    if (entry.second)
    {
      continue;
    }
    std::vector<int> walk;
    std::pair<int, int> edge = entry.first;
    do
    {
      walked[edge] = true;
      walk.push_back(edge.first);
      const auto& around = rotations[edge.second];
      const auto at = std::find(around.begin(), around.end(), edge.first);
      const int next = at == around.begin() ? around.back() : *(at - 1);
      edge = { edge.second, next };
    } while (edge != entry.first);
    walks.push_back(std::move(walk));
  }
  return walks;
}

/// Computes the centroid of the region of points whose triangle with each edge of the polygon has
/// angles at the edge with at least this tangent. For 0, the region is the kernel of the polygon.
/// The region is found by clipping a box. Returns false if it is empty or if, by rounding, not the
/// whole polygon is visible from the centroid.
bool CenterAtSlope(const std::vector<Vector2>& polygon, double slope, Vector2& center)
{
  const std::size_t m = polygon.size();
  const Vector2 origin = polygon[0];
  Vector2 low;
  Vector2 high;
  for (const Vector2& p : polygon)
  {
    low = { std::min(low.x, p.x - origin.x), std::min(low.y, p.y - origin.y) };
    high = { std::max(high.x, p.x - origin.x), std::max(high.y, p.y - origin.y) };
  }
  std::vector<Vector2> region{ low, { high.x, low.y }, high, { low.x, high.y } };
  std::vector<Vector2> clipped;
  const auto cut = [&](const Vector2& from, const Vector2& direction) {
    clipped.clear();
    for (std::size_t k = 0; k < region.size(); ++k)
    {
      const Vector2& p = region[k];
      const Vector2& q = region[k + 1 < region.size() ? k + 1 : 0];
      const double here = Cross(direction, p - from);
      const double there = Cross(direction, q - from);
      if (here >= 0.0)
      {
        clipped.push_back(p);
      }
      if ((here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0))
      {
        clipped.push_back(p + (here / (here - there)) * (q - p));
      }
    }
    region.swap(clipped);
  };
  for (std::size_t i = 0; i < m && !region.empty(); ++i)
  {
    const Vector2 start = polygon[i] - origin;
    const Vector2 end = polygon[i + 1 < m ? i + 1 : 0] - origin;
    const Vector2 edge = end - start;
    const Vector2 rise = slope * Vector2{ -edge.y, edge.x };
    cut(start, edge + rise);
    if (slope > 0.0)
    {
      cut(end, edge - rise);
    }
  }
  double area = 0.0;
  Vector2 sum;
  for (std::size_t k = 1; k + 1 < region.size(); ++k)
  {
    const Vector2 u = region[k] - region[0];
    const Vector2 v = region[k + 1] - region[0];
    const double part = Cross(u, v);
    area += part;
    sum = sum + (part / 3.0) * (u + v);
  }
  if (!(area > 0.0))
  {
    return false;
  }
  const Vector2 centroid = origin + (region[0] + (1.0 / area) * sum);
  for (std::size_t i = 0; i < m; ++i)
  {
    if (Orientation(centroid, polygon[i], polygon[i + 1 < m ? i + 1 : 0]) <= 0)
    {
      return false;
    }
  }
  center = centroid;
  return true;
}

} // namespace

bool FillByDiagonals(
  const PolygonPair& polygons, const QualityMeasure& quality, CornerTriangles& triangles)
{
  const int m = static_cast<int>(polygons[0].size());
  if (m < 3)
  {
    return false;
  }
  const auto& source = polygons[0];
  const auto& target = polygons[1];
  // The best quality of the part between corner i and corner j, and the third corner of the
  // triangle at the diagonal between them.
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::size_t size = static_cast<std::size_t>(m);
  std::vector<double> best(size * size, -1.0);
  std::vector<int> third(size * size, -1);
  for (int i = 0; i + 1 < m; ++i)
  {
    best[static_cast<std::size_t>(i) * size + i + 1] = infinity;
  }
  for (int length = 2; length < m; ++length)
  {
    for (int i = 0; i + length < m; ++i)
    {
      const int j = i + length;
      double found = -1.0;
      int corner = -1;
      for (int k = i + 1; k < j; ++k)
      {
        const double parts = std::min(best[static_cast<std::size_t>(i) * size + k],
          best[static_cast<std::size_t>(k) * size + j]);
        if (parts > found)
        {
          const double own = QualityOf(
            quality, { source[i], source[k], source[j] }, { target[i], target[k], target[j] });
          if (std::min(parts, own) > found)
          {
            found = std::min(parts, own);
            corner = k;
          }
        }
      }
      best[static_cast<std::size_t>(i) * size + j] = found;
      third[static_cast<std::size_t>(i) * size + j] = corner;
    }
  }
  if (third[size - 1] < 0)
  {
    return false;
  }
  std::vector<std::pair<int, int>> open{ { 0, m - 1 } };
  while (!open.empty())
  {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i > 1)
    {
      const int k = third[static_cast<std::size_t>(i) * size + j];
      triangles.push_back({ i, k, j });
      open.emplace_back(i, k);
      open.emplace_back(k, j);
    }
  }
  return true;
}

bool FillWithFewPoints(const PolygonPair& polygons, const QualityMeasure& quality, int most,
  std::array<std::vector<Vector2>, 2>& added, CornerTriangles& triangles)
{
  const int m = static_cast<int>(polygons[0].size());
  if (m < 3)
  {
    return false;
  }
  // The best filling of the part that a chord cuts off. Between contains the other corners of the
  // cell at the chord, which is a triangle or a polygon with a point in the middle.
  struct Part
  {
    int Points = 0;
    double Quality = std::numeric_limits<double>::infinity();
    std::vector<int> Between;
  };
  const std::size_t size = static_cast<std::size_t>(m);
  std::vector<Part> parts(size * size);
  const auto part = [&](int i, int j) -> Part& {
    return parts[static_cast<std::size_t>(i) * size + static_cast<std::size_t>(j)];
  };
  const auto isLeft = [&](int domain, int a, int b, int c) {
    const auto& points = polygons[domain];
    return Orientation(points[a], points[b], points[c]) > 0;
  };
  // A quadrilateral is simple if a diagonal divides it into two counterclockwise triangles.
  const auto isSimple = [&](int d, int i, int k, int l, int j) {
    return (isLeft(d, i, k, l) && isLeft(d, i, l, j)) || (isLeft(d, i, k, j) && isLeft(d, k, l, j));
  };
  std::array<Vector2, 2> center;
  const auto findCenter = [&](int i, const std::vector<int>& between, int j) {
    PolygonPair star;
    for (int d = 0; d < 2; ++d)
    {
      star[d].push_back(polygons[d][i]);
      for (const int k : between)
      {
        star[d].push_back(polygons[d][k]);
      }
      star[d].push_back(polygons[d][j]);
    }
    return FindStarCenter(star, center);
  };
  for (int length = 2; length < m; ++length)
  {
    for (int i = 0; i + length < m; ++i)
    {
      const int j = i + length;
      Part best{ most + 1, -1.0, {} };
      for (int k = i + 1; k < j; ++k)
      {
        const int points = part(i, k).Points + part(k, j).Points;
        const double least = std::min(part(i, k).Quality, part(k, j).Quality);
        if (points < best.Points || (points == best.Points && least > best.Quality))
        {
          const double own = std::min(least,
            QualityOf(quality, { polygons[0][i], polygons[0][k], polygons[0][j] },
              { polygons[1][i], polygons[1][k], polygons[1][j] }));
          if (own >= 0.0 && (points < best.Points || own > best.Quality))
          {
            best = { points, own, { k } };
          }
        }
      }
      for (int k = i + 1; k < j && best.Points > 1; ++k)
      {
        const int before = 1 + part(i, k).Points;
        for (int l = k + 1; l < j && before < best.Points; ++l)
        {
          const int points = before + part(k, l).Points + part(l, j).Points;
          if (points < best.Points && isSimple(0, i, k, l, j) && isSimple(1, i, k, l, j))
          {
            best = { points, 0.0, { k, l } };
          }
        }
      }
      if (best.Points > 1 && most > 0)
      {
        std::vector<int> between(static_cast<std::size_t>(length - 1));
        std::iota(between.begin(), between.end(), i + 1);
        if (findCenter(i, between, j))
        {
          best = { 1, 0.0, std::move(between) };
        }
      }
      part(i, j) = std::move(best);
    }
  }
  if (part(0, m - 1).Points > most)
  {
    return false;
  }
  std::vector<std::pair<int, int>> open{ { 0, m - 1 } };
  while (!open.empty())
  {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2)
    {
      continue;
    }
    const Part& found = part(i, j);
    std::vector<int> corners{ i };
    corners.insert(corners.end(), found.Between.begin(), found.Between.end());
    corners.push_back(j);
    if (corners.size() == 3)
    {
      triangles.push_back({ corners[0], corners[1], corners[2] });
    }
    else
    {
      if (!findCenter(i, found.Between, j))
      {
        // The kernel is too small for double precision.
        return false;
      }
      const int point = m + static_cast<int>(added[0].size());
      for (int d = 0; d < 2; ++d)
      {
        added[d].push_back(center[d]);
      }
      for (std::size_t k = 0; k < corners.size(); ++k)
      {
        triangles.push_back({ point, corners[k], corners[(k + 1) % corners.size()] });
      }
    }
    for (std::size_t k = 0; k + 1 < corners.size(); ++k)
    {
      open.emplace_back(corners[k], corners[k + 1]);
    }
  }
  return true;
}

bool FindStarCenter(const PolygonPair& polygons, std::array<Vector2, 2>& center)
{
  return CenterAtSlope(polygons[0], 0.0, center[0]) && CenterAtSlope(polygons[1], 0.0, center[1]);
}

bool FindBestStarCenter(const std::vector<Vector2>& polygon, Vector2& center)
{
  if (!CenterAtSlope(polygon, 0.0, center))
  {
    return false;
  }
  // The largest slope for which such points exist, to within a few percent.
  double slope = 1.0;
  for (int i = 0; i < 60 && !CenterAtSlope(polygon, slope, center); ++i)
  {
    slope *= 0.5;
  }
  for (int i = 1; i <= 5; ++i)
  {
    const double share = std::ldexp(1.0, -i);
    slope *= CenterAtSlope(polygon, slope * (1.0 + share), center) ? 1.0 + share : 1.0;
  }
  return true;
}

int CountCrossings(const std::array<CornerTriangles, 2>& triangulations)
{
  const ChordTriangulation source(triangulations[0]);
  const std::vector<Chord> others = ChordTriangulation(triangulations[1]).Diagonals();
  int count = 0;
  for (const Chord& chord : source.Diagonals())
  {
    count += CrossingsOf(chord, others);
  }
  return count;
}

bool FillByOverlay(const PolygonPair& polygons, const std::array<CornerTriangles, 2>& own,
  const QualityMeasure& quality, std::array<std::vector<Vector2>, 2>& added,
  CornerTriangles& triangles)
{
  const int m = static_cast<int>(polygons[0].size());
  std::array<ChordTriangulation, 2> chords{ { ChordTriangulation(own[0]),
    ChordTriangulation(own[1]) } };
  LowerCrossings(polygons, chords);
  const std::array<std::vector<Chord>, 2> diagonals{ { chords[0].Diagonals(),
    chords[1].Diagonals() } };

  // Every crossing is a node. The order of the crossings along a diagonal follows from the numbers
  // of the corners.
  std::map<std::pair<Chord, Chord>, int> nodes;
  std::array<std::map<Chord, std::vector<Chord>>, 2> crossed;
  const int firstAdded = m + static_cast<int>(added[0].size());
  int count = firstAdded;
  for (const Chord& s : diagonals[0])
  {
    for (const Chord& t : diagonals[1])
    {
      if (Cross(s, t))
      {
        nodes[{ s, t }] = count++;
        crossed[0][s].push_back(t);
        crossed[1][t].push_back(s);
      }
    }
  }
  for (int d = 0; d < 2; ++d)
  {
    added[d].resize(static_cast<std::size_t>(count - m));
    for (const Chord& chord : diagonals[d])
    {
      auto& others = crossed[d][chord];
      const auto key = [&](const Chord& other) {
        const bool first = IsBetween(other.first, chord);
        const int between = first ? other.first : other.second;
        const int outside = first ? other.second : other.first;
        return std::make_pair(between, (chord.first - outside + m) % m);
      };
      std::sort(others.begin(), others.end(),
        [&](const Chord& a, const Chord& b) { return key(a) < key(b); });
      const Vector2 start = polygons[d][chord.first];
      const Vector2 edge = polygons[d][chord.second] - start;
      for (std::size_t i = 0; i < others.size(); ++i)
      {
        const int node = d == 0 ? nodes[{ chord, others[i] }] : nodes[{ others[i], chord }];
        const double share = static_cast<double>(i + 1) / static_cast<double>(others.size() + 1);
        added[d][node - m] = start + share * edge;
      }
    }
  }

  // The rotation system of the overlay. Its edges are the sides of the polygon and the pieces of
  // diagonals between nodes.
  Rotations rotations(static_cast<std::size_t>(count));
  std::vector<std::vector<std::pair<int, int>>> spokes(static_cast<std::size_t>(m));
  for (int i = 0; i < m; ++i)
  {
    const int next = (i + 1) % m;
    spokes[i].emplace_back(1, next);
    spokes[i].emplace_back(m - 1, (i + m - 1) % m);
  }
  for (int node = firstAdded; node < count; ++node)
  {
    rotations[node].resize(4);
  }
  for (int d = 0; d < 2; ++d)
  {
    for (const Chord& chord : diagonals[d])
    {
      if (d == 1 && chords[0].Has(chord))
      {
        continue;
      }
      int previous = chord.first;
      const auto& others = crossed[d][chord];
      for (std::size_t i = 0; i <= others.size(); ++i)
      {
        const bool last = i == others.size();
        const int node = last
          ? chord.second
          : (d == 0 ? nodes[{ chord, others[i] }] : nodes[{ others[i], chord }]);
        // The neighbors of a crossing, counterclockwise: toward the first corner of the source
        // diagonal, the corner of the target diagonal that is between the ends of the source
        // diagonal, the second corner of the source diagonal, and the other one of the target
        // diagonal.
        const auto slot = [&](const Chord& other, bool forward) {
          if (d == 0)
          {
            return forward ? 2 : 0;
          }
          const bool secondIsBetween = IsBetween(chord.second, other);
          return forward == secondIsBetween ? 1 : 3;
        };
        if (i == 0)
        {
          spokes[chord.first].emplace_back((chord.second - chord.first + m) % m, node);
        }
        else
        {
          rotations[previous][slot(others[i - 1], true)] = node;
        }
        if (last)
        {
          spokes[chord.second].emplace_back((chord.first - chord.second + m) % m, previous);
        }
        else
        {
          rotations[node][slot(others[i], false)] = previous;
        }
        previous = node;
      }
    }
  }
  for (int i = 0; i < m; ++i)
  {
    std::sort(spokes[i].begin(), spokes[i].end());
    for (const auto& spoke : spokes[i])
    {
      rotations[i].push_back(spoke.second);
    }
  }
  for (const std::vector<int>& walk : Walks(rotations))
  {
    // The walk around the outer face traverses the polygon clockwise.
    const std::size_t n = walk.size();
    bool outer = static_cast<int>(n) == m;
    for (std::size_t i = 0; i < n && outer; ++i)
    {
      outer = walk[i] < m && walk[(i + 1) % n] == (walk[i] + m - 1) % m;
    }
    if (outer)
    {
      continue;
    }
    PolygonPair cell;
    for (int d = 0; d < 2; ++d)
    {
      for (const int node : walk)
      {
        cell[d].push_back(node < m ? polygons[d][node] : added[d][node - m]);
      }
    }
    CornerTriangles inCell;
    if (!FillByDiagonals(cell, quality, inCell))
    {
      return false;
    }
    for (const auto& t : inCell)
    {
      triangles.push_back({ walk[t[0]], walk[t[1]], walk[t[2]] });
    }
  }
  return true;
}

} // namespace homeomorphism
