// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Figures.h"

#include "Construction/CommonMap.h"
#include "Construction/FaceFilling.h"

#include <gtest/gtest.h>

using namespace figures;
using namespace homeomorphism;

namespace
{

/// Fills two polygons by their overlay alone and checks the pair.
std::string Overlay(const FigurePair& figure)
{
  const int m = static_cast<int>(figure.Points[0].size());
  CommonMap map(figure.Points);
  std::vector<std::array<int, 2>> edges;
  for (int i = 0; i < m; ++i)
  {
    edges.push_back({ i + ConstrainedTriangulation::BoxCorners,
      (i + 1) % m + ConstrainedTriangulation::BoxCorners });
    if (map.Add(edges.back()[0], edges.back()[1]).Why != CommonMap::Refusal::None)
    {
      return "the polygons are not simple";
    }
  }
  map.MarkOutside(edges);
  CornerTriangles closed;
  std::vector<CommonMap::Face> faces;
  map.Faces(closed, faces);
  if (faces.size() != 1 || faces[0].Walks.size() != 1)
  {
    return "there is not one face";
  }
  PolygonPair polygons;
  for (int d = 0; d < 2; ++d)
  {
    for (const int v : faces[0].Walks[0])
    {
      polygons[d].push_back(map.GetPoints(d)[v]);
    }
  }
  std::array<std::vector<Vector2>, 2> points;
  IsomorphicTriangulationResult result;
  if (!FillByOverlay(
        polygons, faces[0].Triangles, PairQuality::MinimumAngle, points, result.Triangles))
  {
    return "double precision does not suffice";
  }
  const int added = static_cast<int>(points[0].size());
  EXPECT_LE(added, CountCrossings(faces[0].Triangles, m));
  FigurePair walked;
  walked.Points = polygons;
  result.Points = polygons;
  result.OriginalIds = Range(0, m);
  for (int i = 0; i < m; ++i)
  {
    result.LoopEdges.push_back({ i, (i + 1) % m });
  }
  for (int i = 0; i < added; ++i)
  {
    result.OriginalIds.push_back(-1);
    result.Points[0].push_back(points[0][i]);
    result.Points[1].push_back(points[1][i]);
  }
  return Check(walked, result);
}

TEST(FaceFilling, OverlaysOfRandomPolygonsAndSnakes)
{
  Random random(1);
  for (int i = 0; i < 200; ++i)
  {
    const int corners = 5 + i % 40;
    ASSERT_EQ("", Overlay(Outline(RandomStar(corners, random), RandomStar(corners, random)))) << i;
  }
  for (const int corners : { 16, 32, 64, 128 })
  {
    ASSERT_EQ("", Overlay(Outline(Snake(corners, false), Snake(corners, true)))) << corners;
  }
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
  const auto quality = [&](int i, int k, int j) {
    return QualityOf(PairQuality::MinimumAngle, { polygons[0][i], polygons[0][k], polygons[0][j] },
      { polygons[1][i], polygons[1][k], polygons[1][j] });
  };
  std::function<double(int, int)> best = [&](int i, int j) {
    double found = j - i < 2 ? 180.0 : -1.0;
    for (int k = i + 1; k < j; ++k)
    {
      found = std::max(found, std::min({ best(i, k), best(k, j), quality(i, k, j) }));
    }
    return found;
  };
  CornerTriangles triangles;
  ASSERT_TRUE(FillByDiagonals(polygons, PairQuality::MinimumAngle, triangles));
  double worst = 180.0;
  for (const auto& t : triangles)
  {
    worst = std::min(worst, quality(t[0], t[1], t[2]));
  }
  EXPECT_EQ(4u, triangles.size());
  EXPECT_DOUBLE_EQ(best(0, 5), worst);
}

TEST(FaceFilling, StarCentersSeeAllCorners)
{
  Random random(3);
  std::array<Vector2, 2> center;
  EXPECT_TRUE(FindStarCenter({ { RandomStar(9, random), Circle(9) } }, center));
  EXPECT_FALSE(FindStarCenter({ { Spiral(20, 2.0), Circle(20) } }, center));
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
