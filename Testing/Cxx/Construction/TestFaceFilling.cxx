// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Figures.h"

#include "Construction/CommonMap.h"
#include "Construction/FaceDissection.h"
#include "Construction/FaceFilling.h"
#include "Construction/JointOptimization.h"
#include "Construction/RegionRefilling.h"

#include <gtest/gtest.h>

using namespace figures;
using namespace homeomorphism;

namespace
{

/// The faces of a map.
std::vector<CommonMap::Face> FacesOf(const CommonMap& map)
{
  CornerTriangles closed;
  std::vector<CommonMap::Face> faces;
  map.Faces(closed, faces);
  return faces;
}

/// Draws an outline through the first points.
void DrawOutline(CommonMap& map, int m)
{
  std::vector<std::array<int, 2>> edges;
  for (int i = 0; i < m; ++i)
  {
    edges.push_back({ i + ConstrainedTriangulation::BoxCorners,
      (i + 1) % m + ConstrainedTriangulation::BoxCorners });
    EXPECT_EQ(CommonMap::Refusal::None, map.Add(edges.back()[0], edges.back()[1]).Why);
  }
  map.MarkOutside(edges);
}

/// The only face of a map whose only edges are those of an outline.
struct OnlyFace
{
  std::array<CornerTriangles, 2> Triangles;
  PolygonPair Polygons;

  explicit OnlyFace(const FigurePair& figure)
  {
    CommonMap map(figure.Points);
    DrawOutline(map, static_cast<int>(figure.Points[0].size()));
    const std::vector<CommonMap::Face> faces = FacesOf(map);
    EXPECT_EQ(1u, faces.size());
    this->Triangles = faces.at(0).Triangles;
    for (int d = 0; d < 2; ++d)
    {
      for (const int v : faces[0].Walks[0])
      {
        this->Polygons[d].push_back(map.GetPoints(d)[v]);
      }
    }
  }
};

double Quality(const PolygonPair& polygons, int i, int k, int j)
{
  return QualityOf(PairQuality::MinimumAngle, { polygons[0][i], polygons[0][k], polygons[0][j] },
    { polygons[1][i], polygons[1][k], polygons[1][j] });
}

double WorstQuality(const PolygonPair& polygons, const CornerTriangles& triangles)
{
  double worst = 180.0;
  for (const auto& t : triangles)
  {
    worst = std::min(worst, Quality(polygons, t[0], t[1], t[2]));
  }
  return worst;
}

/// Checks triangles that fill two polygons, numbered as CornerTriangles are.
std::string CheckFilling(
  const PolygonPair& polygons, const PolygonPair& points, const CornerTriangles& triangles)
{
  const int m = static_cast<int>(polygons[0].size());
  FigurePair walked;
  walked.Points = polygons;
  IsomorphicTriangulationResult result;
  result.Triangles = triangles;
  result.Points = polygons;
  result.OriginalIds = Range(0, m);
  for (int i = 0; i < m; ++i)
  {
    result.LoopEdges.push_back({ i, (i + 1) % m });
  }
  for (std::size_t i = 0; i < points[0].size(); ++i)
  {
    result.OriginalIds.push_back(-1);
    result.Points[0].push_back(points[0][i]);
    result.Points[1].push_back(points[1][i]);
  }
  return Check(walked, result);
}

/// Two polygons that are filled by their overlay alone.
struct Overlay : OnlyFace
{
  PolygonPair AddedPoints;
  CornerTriangles Filling;

  explicit Overlay(const FigurePair& figure)
    : OnlyFace(figure)
  {
    EXPECT_TRUE(FillByOverlay(this->Polygons, this->Triangles, PairQuality::MinimumAngle,
      this->AddedPoints, this->Filling));
    EXPECT_LE(static_cast<int>(this->AddedPoints[0].size()), CountCrossings(this->Triangles));
    EXPECT_EQ("", CheckFilling(this->Polygons, this->AddedPoints, this->Filling));
  }
};

TEST(FaceFilling, OverlaysOfRandomPolygonsAndSnakes)
{
  Random random(1);
  for (int i = 0; i < 200; ++i)
  {
    const int corners = 5 + i % 40;
    SCOPED_TRACE(i);
    Overlay(Outline(RandomStar(corners, random), RandomStar(corners, random)));
  }
  for (const int corners : { 16, 32, 64, 128 })
  {
    SCOPED_TRACE(corners);
    Overlay(Outline(Snake(corners, false), Snake(corners, true)));
  }
}

TEST(FaceFilling, PartsOfLargeFacesHaveFewerCrossings)
{
  // Bands wound three times whose corners are a quarter of the way apart.
  std::vector<Vector2> band = Spiral(600, 3.0);
  std::vector<Vector2> moved = band;
  std::rotate(moved.begin(), moved.begin() + 150, moved.end());
  const FigurePair figure = Outline(band, moved);
  CommonMap map(figure.Points);
  DrawOutline(map, 600);
  const auto crossings = [&]() {
    int sum = 0;
    for (const CommonMap::Face& face : FacesOf(map))
    {
      sum += CountCrossings(face.Triangles);
    }
    return sum;
  };
  const int before = crossings();
  ASSERT_EQ(CommonMap::Drawn::Yes, map.Split(FacesOf(map)[0]));
  EXPECT_EQ(2u, FacesOf(map).size());
  EXPECT_LT(crossings(), before);
  // The construction divides such faces.
  IsomorphicTriangulationOptions options;
  options.OptimizeAddedPoints = false;
  options.MaximumNumberOfAddedPoints = before;
  const auto result = MakeIsomorphicTriangulation(figure, options);
  EXPECT_EQ("", Check(figure, result));
  EXPECT_GT(2000, result.NumberOfAddedPoints);
}

TEST(FaceFilling, DiagonalsAreTheBestOfAll)
{
  // All triangulations of a convex hexagon, by recursion.
  Random random(2);
  std::vector<Vector2> circle = Circle(6);
  for (Vector2& p : circle)
  {
    p = { p.x + random(-0.1, 0.1), 0.5 * p.y };
  }
  const PolygonPair polygons{ { circle, Circle(6) } };
  std::function<double(int, int)> best = [&](int i, int j) {
    double found = j - i < 2 ? 180.0 : -1.0;
    for (int k = i + 1; k < j; ++k)
    {
      found = std::max(found, std::min({ best(i, k), best(k, j), Quality(polygons, i, k, j) }));
    }
    return found;
  };
  CornerTriangles triangles;
  ASSERT_TRUE(FillByDiagonals(polygons, PairQuality::MinimumAngle, triangles));
  EXPECT_EQ(4u, triangles.size());
  EXPECT_DOUBLE_EQ(best(0, 5), WorstQuality(polygons, triangles));
}

/// The number of points with which two polygons are filled; -1 if @a most do not suffice.
int FewPoints(const PolygonPair& polygons, int most)
{
  PolygonPair points;
  CornerTriangles triangles;
  if (!FillWithFewPoints(polygons, PairQuality::MinimumAngle, most, points, triangles))
  {
    return -1;
  }
  EXPECT_EQ("", CheckFilling(polygons, points, triangles));
  return static_cast<int>(points[0].size());
}

TEST(FaceFilling, FewPointsAreNoMoreThanNecessary)
{
  EXPECT_EQ(0, FewPoints({ { Circle(9), Circle(9, 3.0, { 1, 2 }) } }, 3));
  // Quadrangles without a common diagonal, because their reflex corners differ.
  const PolygonPair darts{ { { { 0, 0 }, { 4, 0 }, { 1, 1 }, { 0, 4 } },
    { { 4, 0 }, { 1, 1 }, { 0, 4 }, { 0, 0 } } } };
  EXPECT_EQ(-1, FewPoints(darts, 0));
  EXPECT_EQ(1, FewPoints(darts, 3));
  // Stars need one point at most.
  Random random(4);
  int needed = 0;
  for (int i = 0; i < 60; ++i)
  {
    const PolygonPair polygons{ { RandomStar(12, random), RandomStar(12, random) } };
    CornerTriangles diagonals;
    const bool none = FillByDiagonals(polygons, PairQuality::MinimumAngle, diagonals);
    EXPECT_EQ(none ? 0 : 1, FewPoints(polygons, 4)) << i;
    needed += none ? 0 : 1;
  }
  EXPECT_LT(10, needed);
}

/// Whether a segment between corners leads through the inside of a polygon and meets no other
/// corner.
bool IsDiagonal(const std::vector<Vector2>& p, int i, int j)
{
  const int m = static_cast<int>(p.size());
  bool inside = false;
  const Vector2 middle = 0.5 * (p[i] + p[j]);
  for (int a = 0; a < m; ++a)
  {
    const int b = (a + 1) % m;
    const int fromA = Orientation(p[i], p[j], p[a]);
    if (a != i && a != j && fromA == 0 && Dot(p[a] - p[i], p[a] - p[j]) < 0.0)
    {
      return false;
    }
    if (fromA * Orientation(p[i], p[j], p[b]) < 0 &&
      Orientation(p[a], p[b], p[i]) * Orientation(p[a], p[b], p[j]) < 0)
    {
      return false;
    }
    const bool isAbove = p[a].y > middle.y;
    if (isAbove != (p[b].y > middle.y) && (Orientation(p[a], p[b], middle) > 0) != isAbove)
    {
      inside = !inside;
    }
  }
  return inside;
}

/// What the faces of a dissection cost between the ends of a chord: half as much as they have
/// corners beyond three.
double CostOfChords(const std::set<std::pair<int, int>>& chords, int i, int j)
{
  double cost = -1.0;
  for (int at = i; at != j; cost += 0.5)
  {
    int next = at == i ? j - 1 : j;
    while (next > at + 1 && chords.count({ at, next }) == 0)
    {
      --next;
    }
    cost += next > at + 1 ? CostOfChords(chords, at, next) : 0.0;
    at = next;
  }
  return cost;
}

/// The least that any dissection costs.
double LeastCost(const PolygonPair& polygons)
{
  const int m = static_cast<int>(polygons[0].size());
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> cheapest(m, std::vector<double>(m, none));
  for (int length = 1; length < m; ++length)
  {
    for (int i = 0; i + length < m; ++i)
    {
      const int j = i + length;
      if (length == 1)
      {
        cheapest[i][j] = 0.0;
        continue;
      }
      if (length + 1 < m && !(IsDiagonal(polygons[0], i, j) && IsDiagonal(polygons[1], i, j)))
      {
        continue;
      }
      // Walks of chords from i to the other corners. The chord from i to j still costs too much.
      std::vector<double> walks(m, none);
      walks[i] = -1.0;
      for (int b = i + 1; b <= j; ++b)
      {
        for (int a = i; a < b; ++a)
        {
          walks[b] = std::min(walks[b], walks[a] + cheapest[a][b] + 0.5);
        }
      }
      cheapest[i][j] = walks[j];
    }
  }
  return cheapest[0][m - 1];
}

TEST(FaceFilling, DissectionsLeaveTheLeastAndAreAsGoodAsDiagonals)
{
  Random random(6);
  int complete = 0;
  for (int number = 0; number < 300; ++number)
  {
    SCOPED_TRACE(number);
    const bool isComb = number % 3 == 0;
    const int corners = isComb ? 6 + number % 12 / 3 * 2 : 4 + number % 13;
    const OnlyFace face(Outline(
      RandomStar(corners, random), isComb ? Comb(corners, number) : RandomStar(corners, random)));
    const PolygonPair& polygons = face.Polygons;
    std::set<std::pair<int, int>> chords;
    for (const auto& chord : Dissect(polygons, face.Triangles, PairQuality::MinimumAngle))
    {
      chords.emplace(chord[0], chord[1]);
    }
    chords.erase({ 0, corners - 1 });
    for (const auto& [i, j] : chords)
    {
      EXPECT_TRUE(IsDiagonal(polygons[0], i, j) && IsDiagonal(polygons[1], i, j));
      for (const auto& [a, b] : chords)
      {
        EXPECT_FALSE(a < i && i < b && b < j);
      }
    }
    EXPECT_EQ(LeastCost(polygons), CostOfChords(chords, 0, corners - 1));
    CornerTriangles best;
    if (!FillByDiagonals(polygons, PairQuality::MinimumAngle, best))
    {
      EXPECT_GT(static_cast<std::size_t>(corners - 3), chords.size());
      continue;
    }
    ++complete;
    const auto has = [&](int a, int b) {
      return b == a + 1 || (a == 0 && b == corners - 1) || chords.count({ a, b }) != 0;
    };
    CornerTriangles made;
    for (int a = 0; a < corners; ++a)
    {
      for (int b = a + 1; b < corners; ++b)
      {
        for (int c = b + 1; c < corners; ++c)
        {
          if (has(a, b) && has(b, c) && has(a, c))
          {
            made.push_back({ a, b, c });
          }
        }
      }
    }
    EXPECT_EQ(best.size(), made.size());
    EXPECT_NEAR(WorstQuality(polygons, best), WorstQuality(polygons, made), 1e-4);
  }
  EXPECT_LT(50, complete);
  EXPECT_LT(50, 300 - complete);
}

/// A hexagon, its center, and six points between them, which may be displaced; points from a number
/// on are added ones.
PairMesh Rings(int firstAdded, const std::vector<std::array<int, 2>>& fixed, double displacement)
{
  Random random(8);
  PolygonPair points{ { Circle(6, 4.0), Circle(6, 4.0) } };
  for (auto& p : points)
  {
    std::vector<Vector2> inner = Circle(6, 2.0);
    inner.insert(inner.begin(), Vector2{});
    for (const Vector2& q : inner)
    {
      const double x = random(-displacement, displacement);
      p.push_back(q + Vector2{ x, random(-displacement, displacement) });
    }
  }
  CornerTriangles triangles;
  for (int i = 0; i < 6; ++i)
  {
    const int next = (i + 1) % 6;
    triangles.push_back({ 6, 7 + i, 7 + next });
    triangles.push_back({ i, next, 7 + i });
    triangles.push_back({ next, 7 + next, 7 + i });
  }
  return { points, triangles, fixed, firstAdded, PairQuality::MinimumAngle };
}

TEST(FaceFilling, RegionsAreFilledWithFewerPoints)
{
  for (const bool hasSegment : { false, true })
  {
    // The center is a landmark, alone or with a segment to another one.
    PairMesh mesh = hasSegment ? Rings(8, { { 6, 7 } }, 0.0) : Rings(7, {}, 0.0);
    for (int pass = 0; pass < 3; ++pass)
    {
      for (const int vertex : mesh.FreeVertices())
      {
        if (mesh.IsFree(vertex))
        {
          const std::size_t mark = mesh.Mark();
          const int before = mesh.CountAdded();
          if (RefillRegion(mesh, vertex, 18, pass))
          {
            const int after = mesh.CountAdded();
            EXPECT_GT(before, after);
            mesh.RollBack(mark);
            EXPECT_EQ(before, mesh.CountAdded());
            EXPECT_TRUE(RefillRegion(mesh, vertex, 18, pass));
            EXPECT_EQ(after, mesh.CountAdded());
          }
        }
      }
    }
    EXPECT_EQ(0, mesh.CountAdded());
    EXPECT_TRUE(mesh.IsUsed(6));
    int fixed = 0;
    for (const PairMesh::Triangle& t : mesh.GetTriangles())
    {
      for (int k = 0; k < 3 && t.Alive; ++k)
      {
        const std::pair<int, int> ends =
          std::minmax(t.Vertices[NextCorner(k)], t.Vertices[PreviousCorner(k)]);
        const bool isSegment = hasSegment && ends == std::make_pair(6, 7);
        EXPECT_EQ(t.Neighbors[k] < 0 || isSegment, t.Fixed[k]);
        fixed += isSegment ? 1 : 0;
      }
    }
    EXPECT_EQ(hasSegment ? 2 : 0, fixed);
    EXPECT_LT(0.0, mesh.WorstQuality());
  }
}

TEST(FaceFilling, StarCentersSeeAllCorners)
{
  Random random(3);
  std::array<Vector2, 2> center;
  EXPECT_TRUE(FindStarCenter({ { RandomStar(9, random), Circle(9) } }, center));
  EXPECT_FALSE(FindStarCenter({ { Spiral(20, 2.0), Circle(20) } }, center));
  // The best center of a triangle is its incenter.
  const std::vector<Vector2> triangle{ { 0, 0 }, { 1, 0 }, { 0, 1 } };
  ASSERT_TRUE(FindBestStarCenter(triangle, center[0]));
  double least = 90.0;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const auto angles = Angles({ center[0], triangle[i], triangle[(i + 1) % 3] });
    least = std::min({ least, angles[1], angles[2] });
  }
  EXPECT_NEAR(22.5, least, 1.0);
  EXPECT_FALSE(FindBestStarCenter(Spiral(20, 2.0), center[0]));
}

TEST(FaceFilling, BridgesAreStraightWherePossible)
{
  // The inner circle is turned so that some edges of the source would have to bend in the target.
  const FigurePair figure = Annulus(8, 0.8, false);
  CommonMap map(figure.Points);
  DrawOutline(map, 8);
  for (int i = 0; i < 8; ++i)
  {
    map.Add(12 + i, 12 + (i + 1) % 8);
  }
  for (const CommonMap::Face& face : FacesOf(map))
  {
    if (face.Walks.size() == 2)
    {
      EXPECT_EQ(CommonMap::Drawn::Yes, map.Bridge(face));
    }
  }
  EXPECT_EQ(1, map.GetNumberOfComponents());
  EXPECT_EQ(20u, map.GetPoints(0).size());
}

TEST(JointOptimization, MergingLeavesFewerPoints)
{
  // Overlays of stars, of which one point would be enough.
  Random random(6);
  std::array<int, 2> left{ { 0, 0 } };
  for (int i = 0; i < 20; ++i)
  {
    const Overlay overlay(Outline(RandomStar(12, random), RandomStar(12, random)));
    PolygonPair points = overlay.Polygons;
    for (int d = 0; d < 2; ++d)
    {
      const std::vector<Vector2>& added = overlay.AddedPoints[d];
      points[d].insert(points[d].end(), added.begin(), added.end());
    }
    for (const bool merge : { false, true })
    {
      PairMesh mesh(points, overlay.Filling, {}, 12, PairQuality::MinimumAngle);
      JointOptimization(mesh, []() { return true; }).RemovePoints(merge);
      EXPECT_LT(0.0, mesh.WorstQuality());
      left[merge] += mesh.CountAdded();
    }
  }
  EXPECT_LT(left[1], left[0]);
}

TEST(JointOptimization, PointsMoveToTheBestPlaces)
{
  std::array<double, 2> angles;
  for (const bool displaced : { false, true })
  {
    PairMesh mesh = Rings(6, {}, displaced ? 0.5 : 0.0);
    JointOptimization(mesh, []() { return true; }).AddPoints(0.0, mesh.CountAdded());
    EXPECT_EQ(7, mesh.CountAdded());
    angles[displaced] = mesh.SmallestAngle();
  }
  // Three angles share the 120 degrees of a corner, wherever the points start.
  EXPECT_LT(39.9, angles[0]);
  EXPECT_NEAR(angles[0], angles[1], 0.01);
}

TEST(PairQuality, GradientsAreDerivatives)
{
  const TrianglePoints triangle{ { { 0.1, 0.2 }, { 2.0, 0.3 }, { 0.7, 1.4 } } };
  const TrianglePoints other{ { { 0.0, 0.0 }, { 1.0, 0.5 }, { -0.4, 1.0 } } };
  for (const PairQuality quality : { PairQuality::MinimumAngle, PairQuality::Concordance,
         PairQuality::Distortion, PairQuality::NonObtuse })
  {
    std::array<QualityTerm, 9> terms;
    const int count = QualityTerms(quality, triangle, other, terms);
    ASSERT_LT(0, count);
    for (int corner = 0; corner < 3; ++corner)
    {
      for (int axis = 0; axis < 2; ++axis)
      {
        constexpr double h = 1e-6;
        std::array<std::array<QualityTerm, 9>, 2> moved;
        for (int i = 0; i < 2; ++i)
        {
          TrianglePoints p = triangle;
          (axis == 0 ? p[corner].x : p[corner].y) += i == 0 ? -h : h;
          QualityTerms(quality, p, other, moved[i]);
        }
        for (int i = 0; i < count; ++i)
        {
          const Vector2& gradient = terms[i].Gradient[corner];
          EXPECT_NEAR((moved[1][i].Value - moved[0][i].Value) / (2.0 * h),
            axis == 0 ? gradient.x : gradient.y, 1e-5);
        }
      }
    }
  }
}

TEST(PairQuality, DistortionIsTheRatioOfSingularValues)
{
  // Stretched by 3 along an axis, and turned.
  const TrianglePoints source{ { { 0, 0 }, { 1, 0 }, { 0.3, 0.8 } } };
  TrianglePoints target;
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 p{ 3.0 * source[k].x, source[k].y };
    target[k] = { 0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y };
  }
  EXPECT_NEAR(3.0, Distortion(source, target), 1e-12);
  EXPECT_NEAR(3.0, Distortion(target, source), 1e-12);
  EXPECT_NEAR(1.0, Distortion(source, source), 1e-7);
}

} // namespace
