// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Figures.h"

#include "Construction/LandmarkResiduals.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

using namespace figures;
using namespace homeomorphism;
using Kind = FigureProblem::Kind;

namespace
{

/// A square with a landmark in it; the target is given by changing the source.
FigurePair Square()
{
  FigurePair figure =
    Outline({ { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 } }, { { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 } });
  Add(figure, { 1, 1 }, { 1, 1 });
  Add(figure, { 3, 1 }, { 3, 1 });
  Add(figure, { 2, 3 }, { 2, 3 });
  return figure;
}

using Ids = std::vector<int>;
using Options = IsomorphicTriangulationOptions;

/// A frame around the unit square.
Options WithFrames()
{
  Options options;
  options.Frames.fill({ { -1, -1 }, { 2, -1 }, { 2, 2 }, { -1, 2 } });
  return options;
}

/// The result, which must be a pair of triangulations of the figure.
IsomorphicTriangulationResult Triangulated(const FigurePair& figure, const Options& options = {})
{
  const auto result = MakeIsomorphicTriangulation(figure, options);
  EXPECT_EQ("", Check(figure, result));
  return result;
}

/// The triangles of a result by the positions of their corners, in both domains.
std::set<std::set<std::array<double, 4>>> ByPosition(
  const IsomorphicTriangulationResult& result, int first)
{
  std::set<std::set<std::array<double, 4>>> triangles;
  for (const auto& t : result.Triangles)
  {
    std::set<std::array<double, 4>> corners;
    for (const int v : t)
    {
      const Vector2& p = result.Points[first][v];
      const Vector2& q = result.Points[1 - first][v];
      corners.insert({ p.x, p.y, q.x, q.y });
    }
    triangles.insert(corners);
  }
  return triangles;
}

/// A change of the square or of the options of which the first problem follows; domain, line and
/// loop are -1 where they do not matter.
struct RefusalCase
{
  Kind What;
  int Domain;
  Ids Points;
  int Line;
  int Loop;
  std::function<void(FigurePair&, Options&)> Change;
};

TEST(FigureRefusals, NameWhatIsWrong)
{
  const std::vector<RefusalCase> cases{
    { Kind::Empty, -1, {}, -1, -1, [](FigurePair& f, Options&) { f = {}; } },
    { Kind::PointCountsDiffer, -1, {}, -1, -1,
      [](FigurePair& f, Options&) { f.Points[1].pop_back(); } },
    { Kind::NotFinite, 1, { 5 }, -1, -1,
      [](FigurePair& f, Options&) { f.Points[1][5].x = std::nan(""); } },
    { Kind::Coincident, 0, { 4, 6 }, -1, -1,
      [](FigurePair& f, Options&) { f.Points[0][6] = f.Points[0][4]; } },
    // In the target the second line passes between the first one's ends.
    { Kind::Crossing, 1, { 0, 6, 4, 5 }, 1, -1,
      [](FigurePair& f, Options&) {
        f.Lines = { { 4, 5 }, { 6, 0 } };
        f.Points[1][6] = { 3, 2.5 };
        f.Points[0][6] = { 0.5, 3 };
      } },
    { Kind::PointOnSegment, 1, { 6, 4, 5 }, -1, -1,
      [](FigurePair& f, Options&) {
        f.Lines = { { 4, 5 } };
        f.Points[1][6] = { 2, 1 };
      } },
    { Kind::CyclicOrder, -1, { 7 }, -1, -1,
      [](FigurePair& f, Options&) {
        Add(f, { 2, 1.5 }, { 2, 1.5 });
        f.Lines = { { 7, 4 }, { 7, 5 }, { 7, 6 } };
        std::swap(f.Points[1][4], f.Points[1][5]);
      } },
    { Kind::OtherFace, -1, {}, -1, -1,
      [](FigurePair& f, Options&) {
        Add(f, { 2, 2 }, { 0.5, 3 });
        f.Lines = { { 4, 5, 6, 4 } };
      } },
    { Kind::OutlineAgainstHole, -1, {}, -1, 0,
      [](FigurePair& f, Options&) {
        f.Loops.push_back({ 4, 5, 6 });
        std::for_each(f.Points[1].begin() + 4, f.Points[1].end(), [](Vector2& p) { p.x += 10.0; });
      } },
    { Kind::LoopSense, -1, {}, -1, 1,
      [](FigurePair& f, Options&) {
        f.Loops.push_back({ 4, 5, 6 });
        std::swap(f.Points[1][4], f.Points[1][5]);
      } },
    { Kind::OutsideDomain, -1, { 7 }, -1, -1,
      [](FigurePair& f, Options&) {
        Add(f, { 9, 9 }, { 9, 9 });
      } },
    { Kind::BadCell, -1, {}, 0, -1,
      [](FigurePair& f, Options&) {
        f.Lines = { { 4, 99 } };
      } },
    { Kind::Collinear, 0, {}, -1, -1,
      [](FigurePair& f, Options&) {
        f = {};
        f.Points = { { { { 0, 0 }, { 1, 1 }, { 3, 3 } }, { { 0, 0 }, { 1, 0 }, { 0, 1 } } } };
      } },
    { Kind::HullsDiffer, -1, { 6 }, -1, -1,
      [](FigurePair& f, Options& options) {
        options.Domain = FigureDomain::ConvexHull;
        f.Loops.clear();
        f.Points[1][6] = { 2, 5 };
      } },
    { Kind::PointOnSegment, 0, { 7 }, -1, -1,
      [](FigurePair& f, Options& options) {
        f.Loops.clear();
        options.Frames.fill({ { 0, 0 }, { 4, 0 }, { 4, 6 }, { 0, 6 } });
        Add(f, { 2, 0 }, { 1, 0.25 });
      } },
    { Kind::OutsideDomain, 1, { 7 }, -1, -1,
      [](FigurePair& f, Options& options) {
        f.Loops.clear();
        options.Frames.fill({ { -1, -1 }, { 5, -1 }, { 5, 5 }, { -1, 5 } });
        Add(f, { 2, 2 }, { 2, 6 });
      } },
    { Kind::OutsideDomain, -1, { 1, 3 }, 0, -1,
      [](FigurePair& f, Options&) {
        const std::vector<Vector2> dart{ { 0, 0 }, { 4, 0 }, { 1, 1 }, { 0, 4 } };
        f = Outline(dart, dart);
        f.Lines = { { 1, 3 } };
      } },
    { Kind::BadFrame, 1, {}, -1, -1,
      [](FigurePair& f, Options& options) {
        f.Loops.clear();
        options.Frames = { { { { -1, -1 }, { 9, -1 }, { 9, 9 }, { -1, 9 } },
          { { -1, -1 }, { 9, -1 }, { -1, 9 }, { 9, 9 } } } };
      } },
    { Kind::BadCell, -1, {}, -1, -1,
      [](FigurePair& f, Options& options) {
        f.Loops.clear();
        options.Domain = FigureDomain::Outline;
      } },
    { Kind::Precision, -1, { 0, 1, 2, 3 }, -1, -1,
      [](FigurePair& f, Options&) {
        // No common diagonal, and in the source no double inside that sees all corners.
        constexpr double one = 1.0 + 0x1p-52;
        constexpr double four = 1.0 + 0x1p-50;
        f = Outline({ { 1, 1 }, { four, 1 }, { one, one }, { 1, four } },
          { { 4, 0 }, { 1, 1 }, { 0, 4 }, { 0, 0 } });
      } },
    { Kind::PointLimit, -1, { 0, 1, 2, 3 }, -1, -1,
      [](FigurePair& f, Options& options) {
        // No common diagonal.
        f = Outline(
          { { 0, 0 }, { 4, 0 }, { 1, 1 }, { 0, 4 } }, { { 4, 0 }, { 1, 1 }, { 0, 4 }, { 0, 0 } });
        options.MaximumNumberOfAddedPoints = 0;
      } },
    { Kind::Aborted, -1, {}, -1, -1,
      [](FigurePair&, Options& options) { options.Progress = [](double) { return false; }; } },
  };
  for (const RefusalCase& one : cases)
  {
    SCOPED_TRACE(static_cast<int>(one.What));
    FigurePair figure = Square();
    Options options;
    one.Change(figure, options);
    const auto result = MakeIsomorphicTriangulation(figure, options);
    ASSERT_FALSE(result.Problems.empty());
    EXPECT_TRUE(result.Triangles.empty());
    const FigureProblem& problem = result.Problems[0];
    EXPECT_FALSE(problem.Message().empty());
    EXPECT_EQ(one.What, problem.What);
    EXPECT_TRUE(one.Domain < 0 || one.Domain == problem.Domain);
    EXPECT_TRUE(one.Points.empty() || one.Points == problem.Points);
    EXPECT_TRUE(one.Line < 0 || one.Line == problem.Line);
    EXPECT_TRUE(one.Loop < 0 || one.Loop <= problem.Loop);
    EXPECT_TRUE(one.What != Kind::PointLimit || problem.Count == 1);
  }
}

TEST(IsomorphicTriangulation, LeavesOutAsFewSegmentsAsPossible)
{
  // In the target, the point in the middle of a short segment lies beyond three longer ones that
  // end around it in the source: one segment fewer.
  FigurePair figure;
  for (const Vector2& p : { Vector2{ 0, 0 }, { 10, 0 }, { 10, 10 }, { 0, 10 } })
  {
    Add(figure, p, p);
  }
  figure.Loops.push_back(Range(0, 4));
  Add(figure, { 2, 1 }, { 2, 5 });
  Add(figure, { 8, 1 }, { 8, 5 });
  figure.Lines.push_back({ 4, 5 });
  for (const double x : { 3.0, 5.0, 7.0 })
  {
    const int first = static_cast<int>(figure.Points[0].size());
    Add(figure, { x, 1.5 }, { x, 1.5 });
    Add(figure, { x, 9 }, { x, 9 });
    figure.Lines.push_back({ first, first + 1 });
  }
  Options options;
  options.LeaveOutConflictingSegments = true;
  const auto result = Triangulated(figure, options);
  ASSERT_EQ(1u, result.LeftOut.size());
  EXPECT_EQ(0, result.LeftOut[0].Line);
  EXPECT_EQ(3u, result.Segments.size());
}

TEST(IsomorphicTriangulation, SegmentsThroughPointsSoNearThatProductsUnderflow)
{
  for (const double unit : { 1e-150, 1e-170, 1e-300 })
  {
    for (const Vector2& along :
      { Vector2{ unit, 0.0 }, Vector2{ 0.0, unit }, Vector2{ unit, unit } })
    {
      FigurePair figure;
      for (const Vector2& p : { Vector2{}, along, 2.0 * along, Vector2{ 1.0, 0.0 },
             Vector2{ 1.0, 1.0 }, Vector2{ 0.0, 1.0 } })
      {
        Add(figure, p, p);
      }
      figure.Lines = { { 0, 2 } };
      const auto result = MakeIsomorphicTriangulation(figure, {});
      EXPECT_TRUE(result.IsComplete()) << unit << " " << along.x << " " << along.y;
      EXPECT_EQ(0, result.NumberOfAddedPoints);
    }
  }
}

TEST(IsomorphicTriangulation, PointsOnFramesAndOutlines)
{
  // A landmark in the middle of the outline's edge, and others on edges and corners of a frame.
  FigurePair figure = Square();
  Add(figure, { 2, 0 }, { 1, 0 });
  Triangulated(figure);
  figure.Loops.clear();
  Options options;
  options.Frames.fill({ { 0, 0 }, { 4, 0 }, { 4, 6 }, { 0, 6 } });
  EXPECT_EQ(2, Triangulated(figure, options).NumberOfFramePoints);
}

TEST(IsomorphicTriangulation, AutomaticFramesMakeNoThinTriangles)
{
  // Landmarks on a grid of triangles with angles of 45 degrees, under an affine map.
  FigurePair figure;
  for (int i = 0; i < 100; ++i)
  {
    const Vector2 p{ static_cast<double>(i % 10), static_cast<double>(i / 10) };
    Add(figure, p, { 5.0 + p.y, 2.0 - p.x });
  }
  const auto result = Triangulated(figure);
  EXPECT_EQ(0, result.NumberOfAddedPoints);
  EXPECT_EQ(figure.Points[0].size() + result.NumberOfFramePoints, result.Points[0].size());
  EXPECT_LT(4, result.NumberOfFramePoints);
  EXPECT_LT(20.0, SmallestAngle(result));
  for (std::size_t i = 100; i < result.Points[0].size(); ++i)
  {
    const Vector2& p = result.Points[0][i];
    EXPECT_NEAR(0.45, std::max({ -p.x, -p.y, p.x - 9.0, p.y - 9.0 }), 1e-12);
  }
}

TEST(IsomorphicTriangulation, ConvexHullOfMirroredPoints)
{
  FigurePair figure = Smooth(100, 5);
  for (int d = 0; d < 2; ++d)
  {
    const auto circle = Circle(12, 2.0, { 0.5, 0.5 });
    figure.Points[d].insert(figure.Points[d].end(), circle.begin(), circle.end());
  }
  for (Vector2& p : figure.Points[1])
  {
    p.x = 15e6 - 1000.0 * p.x;
    p.y = 4e6 + 1000.0 * p.y;
  }
  Options options;
  options.Domain = FigureDomain::ConvexHull;
  const auto result = Triangulated(figure, options);
  EXPECT_TRUE(result.Mirrored);
  EXPECT_EQ(0, result.NumberOfAddedPoints);
}

TEST(IsomorphicTriangulation, OrderOfLandmarksDoesNotMatter)
{
  const FigurePair figure = Noise(200, 0.3, 3);
  FigurePair shuffled = figure;
  Random random(4);
  for (std::size_t i = figure.Points[0].size(); i-- > 1;)
  {
    const std::size_t k = static_cast<std::size_t>(random() * static_cast<double>(i + 1));
    std::swap(shuffled.Points[0][i], shuffled.Points[0][k]);
    std::swap(shuffled.Points[1][i], shuffled.Points[1][k]);
  }
  EXPECT_EQ(ByPosition(Triangulated(figure, WithFrames()), 0),
    ByPosition(Triangulated(shuffled, WithFrames()), 0));
}

TEST(IsomorphicTriangulation, SwappingSourceAndTargetSwapsThePair)
{
  FigurePair figure = Noise(200, 0.3, 8);
  for (const bool mirrored : { false, true })
  {
    Options options = WithFrames();
    if (mirrored)
    {
      for (auto* points : { &figure.Points[1], &options.Frames[1] })
      {
        for (Vector2& p : *points)
        {
          p.y = -p.y;
        }
      }
    }
    FigurePair swapped = figure;
    std::swap(swapped.Points[0], swapped.Points[1]);
    Options swappedOptions = options;
    std::swap(swappedOptions.Frames[0], swappedOptions.Frames[1]);
    const auto result = Triangulated(figure, options);
    EXPECT_EQ(mirrored, result.Mirrored);
    EXPECT_EQ(ByPosition(result, 0), ByPosition(Triangulated(swapped, swappedOptions), 1));
  }
}

TEST(IsomorphicTriangulation, FiguresOfAllKinds)
{
  FigurePair island = Annulus(24, 1.0, true);
  Add(island, { 3.0, 0.5 }, { 3.0, 0.5 });
  Add(island, { 0.5, 0.5 }, { 0.5, 0.5 });
  FigurePair inFloat = Smooth(300, 13);
  for (auto& points : inFloat.Points)
  {
    for (Vector2& p : points)
    {
      p = { static_cast<float>(1.5e7 + 1e4 * p.x), static_cast<float>(-4e6 - 1e4 * p.y) };
    }
  }
  for (const auto& [name, figure] :
    { std::pair{ "holes and islands", island }, { "noise", Noise(150, 0.1, 11) },
      { "more noise", Noise(150, 0.5, 11) }, { "much noise", Noise(150, 1.0, 11) },
      { "unrelated", Unrelated(25, 12) }, { "float coordinates of a map", inFloat } })
  {
    SCOPED_TRACE(name);
    Triangulated(figure);
  }
}

TEST(IsomorphicTriangulation, UnrelatedPointsTakeAGridThatIsOptimizedOnRequest)
{
  const FigurePair figure = Unrelated(100, 12);
  Options options;
  options.OptimizeAddedPoints = false;
  const int many = Triangulated(figure, options).NumberOfAddedPoints;
  EXPECT_LT(Triangulated(figure).NumberOfAddedPoints, many);
  // Less than half of a grid's points, of which the needless ones were removed.
  EXPECT_GT(102 * 102, 2 * many);
}

TEST(IsomorphicTriangulation, LoopsAreConstraintsBesideOtherDomains)
{
  FigurePair figure = Square();
  for (const double y : { -1.0, 5.0 })
  {
    Add(figure, { -1, y }, { -1, y });
    Add(figure, { 5, y }, { 5, y });
  }
  for (const FigureDomain domain : { FigureDomain::ConvexHull, FigureDomain::Frame })
  {
    Options options;
    options.Domain = domain;
    const auto result = Triangulated(figure, options);
    EXPECT_EQ(4u, result.Segments.size());
    EXPECT_LT(10u, result.Triangles.size());
  }
}

TEST(IsomorphicTriangulation, OutlinesKeepTheirEdgesBesideNearPoints)
{
  // The Delaunay triangulation in a box joins points so near to an edge to the box instead.
  FigurePair figure = Outline(Circle(4), Circle(4));
  for (std::size_t i = 0; i < 64; ++i)
  {
    const Vector2 a = figure.Points[0][i % 4];
    const Vector2 b = figure.Points[0][(i + 1) % 4];
    const Vector2 p = (1.0 - 1e-9) * (a + (static_cast<double>(i + 1) / 66.0) * (b - a));
    Add(figure, p, p);
  }
  for (int sense = 0; sense < 2; ++sense)
  {
    Triangulated(figure);
    std::reverse(figure.Loops[0].begin(), figure.Loops[0].end());
  }
}

TEST(IsomorphicTriangulation, StopsWhenAsked)
{
  // At each of its questions, or never.
  const FigurePair figure = Noise(60, 0.5, 4);
  bool stopped = true;
  for (int limit = 0; stopped; limit += 1 + limit / 4)
  {
    stopped = false;
    int questions = limit;
    Options options;
    options.TargetQuality = 10.0;
    options.Progress = [&](double) {
      stopped = stopped || questions-- == 0;
      return !stopped;
    };
    const auto result = MakeIsomorphicTriangulation(figure, options);
    EXPECT_EQ(stopped ? "Stopped on request." : "", Check(figure, result));
    EXPECT_EQ(stopped, result.Triangles.empty());
  }
}

TEST(IsomorphicTriangulation, LargeTrianglesAreDivided)
{
  const FigurePair figure = Square();
  Options options;
  options.MaximumTriangleSize = 0.002;
  const auto result = Triangulated(figure, options);
  for (const auto& t : result.Triangles)
  {
    for (const auto& p : result.Points)
    {
      EXPECT_GE(16.0 * 0.002, 0.5 * Cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
    }
  }
}

TEST(IsomorphicTriangulation, AddedPointsImproveAngles)
{
  Random random(17);
  const FigurePair figure = Outline(RandomStar(12, random), RandomStar(12, random));
  double before = 0.0;
  for (const int count : { 2, 6 })
  {
    Options options;
    options.MaximumNumberOfAddedPoints = count;
    options.TargetQuality = 60.0;
    const auto result = Triangulated(figure, options);
    EXPECT_GE(count, result.NumberOfAddedPoints);
    const double now = SmallestAngle(result);
    EXPECT_LT(before, now);
    before = now;
  }
}

TEST(IsomorphicTriangulation, OtherQualitiesKeepTheAngles)
{
  const FigurePair figure = Smooth(30, 5);
  Options options;
  options.MaximumNumberOfAddedPoints = 0;
  const auto start = MakeIsomorphicTriangulation(figure, options);
  const auto before = MeasureQualities(start.Points, start.Triangles);
  for (const PairQuality quality : { PairQuality::Concordance, PairQuality::NonObtuse })
  {
    options.MaximumNumberOfAddedPoints = 6;
    options.TargetQuality = 90.0;
    options.Quality = quality;
    const auto result = Triangulated(figure, options);
    const auto after = MeasureQualities(result.Points, result.Triangles);
    EXPECT_LE(0.5 * std::min(SmallestAngle(start), 5.0), SmallestAngle(result));
    if (quality == PairQuality::Concordance)
    {
      EXPECT_GT(before.DiscordantShare, after.DiscordantShare);
    }
  }
}

TEST(LandmarkResiduals, WrongLandmarksComeFirstAndDisturbNoOthers)
{
  FigurePair figure = Noise(200, 0.05, 1);
  Random random(101);
  std::set<int> wrong;
  while (wrong.size() < 10)
  {
    const int i = static_cast<int>(200.0 * random());
    wrong.insert(i);
    figure.Points[1][i].x += 0.1;
    figure.Points[1][i].y += random(-0.1, 0.1);
  }
  const std::vector<double> residuals = LandmarkResiduals(figure.Points);
  for (int i = 0; i < 200; ++i)
  {
    // The others are wrong by up to 0.005, and so are their neighbors.
    EXPECT_EQ(wrong.count(i) > 0, residuals[i] > 0.02) << i;
  }
}

TEST(LandmarkResiduals, DoNotDependOnTheNumbering)
{
  // Two wrong landmarks that are mirror images of each other among landmarks on a grid: rejecting
  // the first one or the second gains the same.
  FigurePair figure;
  for (int i = 0; i < 100; ++i)
  {
    const Vector2 p{ static_cast<double>(i % 10), static_cast<double>(i / 10) };
    Add(figure, p, p);
  }
  figure.Points[1][44].x += 0.5;
  figure.Points[1][45].x -= 0.5;
  FigurePair renumbered = figure;
  std::reverse(renumbered.Points[0].begin(), renumbered.Points[0].end());
  std::reverse(renumbered.Points[1].begin(), renumbered.Points[1].end());
  const auto residuals = LandmarkResiduals(figure.Points);
  const auto others = LandmarkResiduals(renumbered.Points);
  for (const std::size_t wrong : { 44, 45 })
  {
    EXPECT_NEAR(0.5, residuals[wrong], 1e-6);
    EXPECT_NEAR(residuals[wrong], others[99 - wrong], 1e-9);
  }
}

TEST(LandmarkResiduals, QuadraticMapsLeaveNone)
{
  FigurePair figure = Mapped(50, 23, [](const Vector2& p, Random&) {
    return Vector2{ 3.0 + p.x + 2.0 * p.y * p.y, p.y - p.x * p.y };
  });
  for (const double residual : LandmarkResiduals(figure.Points))
  {
    // The preference for small coefficients is felt where neighbors lie to one side only.
    EXPECT_NEAR(0.0, residual, 3e-6);
  }
}

TEST(RealFigures, HistoricalMapsNeedNoAddedPoints)
{
  for (const char* name : { "nobeoka", "nobeoka-inset", "fushimi-castle", "tatebayashi-town" })
  {
    FigurePair figure;
    if (!Read(name, figure, true))
    {
      GTEST_SKIP() << "The shared data is absent.";
    }
    Options options;
    options.MaximumNumberOfAddedPoints = 0;
    SCOPED_TRACE(name);
    Triangulated(figure, options);
  }
}

TEST(RealFigures, SchematicMap)
{
  for (const char* name : { "uno-bus", "uno-bus-bent" })
  {
    FigurePair figure;
    if (!Read(name, figure, true))
    {
      GTEST_SKIP() << "The shared data is absent.";
    }
    Options options;
    options.LeaveOutConflictingSegments = true;
    SCOPED_TRACE(name);
    const auto result = Triangulated(figure, options);
    EXPECT_GE(figure.Points[0].size() < 400 ? 1u : 6u, result.LeftOut.size());
    EXPECT_FALSE(result.LeftOut.empty());
    EXPECT_GE(figure.Points[0].size() < 400 ? 8 : 25, result.NumberOfAddedPoints);
  }
}

TEST(RealFigures, PublishedOutlines)
{
  // The best that there is without added points, and the angles that were published.
  struct Expected
  {
    const char* Name;
    int Points;
    double Angle;
  };
  for (const Expected& expected : { Expected{ "letters-U-S", 0, 3.40 }, { "letters-U-S", 5, 20.0 },
         { "letters-U-S", 7, 20.0 }, { "outlines-37", 12, 15.9 } })
  {
    FigurePair figure;
    if (!Read(expected.Name, figure, false))
    {
      GTEST_SKIP() << "The shared data is absent.";
    }
    figure.Loops.push_back(Range(0, static_cast<int>(figure.Points[0].size())));
    Options options;
    options.MaximumNumberOfAddedPoints = expected.Points;
    options.TargetQuality = 60.0;
    const auto result = Triangulated(figure, options);
    EXPECT_LE(expected.Angle, SmallestAngle(result))
      << expected.Name << " with " << expected.Points << " points";
  }
}

} // namespace
