// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TestExtremeScales.cxx
/// Extreme sizes and counts: coordinates near the ends of the range of doubles, overlaps hidden
/// behind other overlaps, and meshes that could take quadratic time.

#include "TestMeshes.h"

#include "vtkDifferentiableHomeomorphism.h"
#include "vtkTriangularCoordinates.h"

#include "vtkDataArray.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <string>

namespace
{

using namespace test_meshes;

constexpr double Epsilon = std::numeric_limits<double>::epsilon();
constexpr int Systems[] = { vtkDifferentiableHomeomorphism::LINEAR,
  vtkDifferentiableHomeomorphism::CONTOUR, vtkDifferentiableHomeomorphism::SMOOTH };

Point PointOf(vtkDataSet* data, vtkIdType i)
{
  Point p;
  data->GetPoint(i, p.data());
  return p;
}

Point Times(const Point& p, double factor)
{
  return { p[0] * factor, p[1] * factor, p[2] * factor };
}

vtkSmartPointer<vtkPolyData> Scaled(vtkPolyData* mesh, double factor)
{
  const auto result = vtkSmartPointer<vtkPolyData>::New();
  result->DeepCopy(mesh);
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    result->GetPoints()->SetPoint(i, Times(PointOf(mesh, i), factor).data());
  }
  return result;
}

/// Random points of all triangles of a mesh.
std::vector<Point> RandomPointsOf(vtkPolyData* mesh, int perTriangle, std::uint64_t seed)
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> random(0.01, 1.0);
  std::vector<Point> result;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    mesh->GetCellPoints(cell, ids);
    for (int i = 0; i < perTriangle; ++i)
    {
      const Point w{ random(generator), random(generator), random(generator) };
      Point p{};
      for (int k = 0; k < 3; ++k)
      {
        const Point corner = PointOf(mesh, ids->GetId(k));
        for (int axis = 0; axis < 3; ++axis)
        {
          p[axis] += w[k] / (w[0] + w[1] + w[2]) * corner[axis];
        }
      }
      result.push_back(p);
    }
  }
  return result;
}

struct Mapped
{
  std::vector<Point> Points;
  std::vector<bool> Valid;
  std::vector<vtkIdType> Triangles;
  std::string Error;
  std::string Warning;

  bool AllValid() const
  {
    return !this->Valid.empty() &&
      std::all_of(this->Valid.begin(), this->Valid.end(), [](bool valid) { return valid; });
  }
};

struct Options
{
  int System = vtkDifferentiableHomeomorphism::LINEAR;
  bool Mask = false;
  bool Inverse = false;
  int CenterPoint = vtkDifferentiableHomeomorphism::INCENTER;
};

Mapped MapPoints(
  const MeshPair& pair, const std::vector<Point>& points, const Options& options = {})
{
  const vtkNew<vtkDifferentiableHomeomorphism> filter;
  Messages messages(filter);
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->SetDataObject(MakeMesh(points, {}));
  filter->SetCoordinateSystem(options.System);
  filter->SetCenterPoint(options.CenterPoint);
  filter->SetMaskInvalidTriangles(options.Mask);
  filter->SetInverse(options.Inverse);
  filter->ComputeTriangleIdOn();
  filter->Update();
  Mapped result;
  result.Error = messages.Error();
  result.Warning = messages.Warning();
  auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  if (messages.HasError() || !output)
  {
    return result;
  }
  auto* mask = output->GetPointData()->GetArray("vtkValidPointMask");
  auto* triangles = output->GetPointData()->GetArray("TriangleId");
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    result.Points.push_back(PointOf(output, i));
    result.Valid.push_back(mask->GetTuple1(i) != 0.0);
    result.Triangles.push_back(static_cast<vtkIdType>(triangles->GetTuple1(i)));
  }
  return result;
}

//------------------------------------------------------------------------------------------------
// Sizes.

/// Maps a pair and the same pair scaled by powers of two, which is exact. The results must agree up
/// to the factor, bit for bit.
void ExpectSameAtAnyScale(const MeshPair& pair, int sourceExponent, int targetExponent)
{
  const double sourceScale = std::ldexp(1.0, sourceExponent);
  const double targetScale = std::ldexp(1.0, targetExponent);
  const MeshPair scaled{ Scaled(pair.Source, sourceScale), Scaled(pair.Target, targetScale) };
  for (const int system : Systems)
  {
    for (const bool inverse : { false, true })
    {
      SCOPED_TRACE("system " + std::to_string(system) + (inverse ? ", inverse" : ""));
      const std::vector<Point> samples = RandomPointsOf(inverse ? pair.Target : pair.Source, 3, 99);
      std::vector<Point> scaledSamples = samples;
      for (Point& p : scaledSamples)
      {
        p = Times(p, inverse ? targetScale : sourceScale);
      }
      const Options options{ system, false, inverse };
      const Mapped expected = MapPoints(pair, samples, options);
      const Mapped mapped = MapPoints(scaled, scaledSamples, options);
      ASSERT_EQ(expected.Error, "");
      ASSERT_EQ(mapped.Error, "");
      ASSERT_TRUE(expected.AllValid());
      ASSERT_TRUE(mapped.AllValid());
      for (std::size_t i = 0; i < samples.size(); ++i)
      {
        ASSERT_EQ(mapped.Points[i], Times(expected.Points[i], inverse ? sourceScale : targetScale));
      }
    }
  }
}

// 2^664 is about 8e199, 2^-664 about 1e-200.
TEST(ExtremeScales, PlanesOfVeryDifferentSizes)
{
  ExpectSameAtAnyScale(MakePlanarPair(4, 61), 664, -664);
  ExpectSameAtAnyScale(MakePlanarPair(4, 62), -664, 664);
  ExpectSameAtAnyScale(MakePlanarPair(4, 63), 1000, -1000);
  ExpectSameAtAnyScale(MakePlanarPair(4, 64), 1000, 1000);
  ExpectSameAtAnyScale(MakePlanarPair(4, 65), -1000, -1000);
}

TEST(ExtremeScales, SurfacesOfVeryDifferentSizes)
{
  const MeshPair sheets{ MakeSheet(4, 66, 0.5), MakeSheet(4, 67, 0.9) };
  ExpectSameAtAnyScale(sheets, 664, -664);
  ExpectSameAtAnyScale(sheets, -664, 664);
  ExpectSameAtAnyScale(MakeClosedPair(2, 68), 664, -664);
}

TEST(ExtremeScales, APlaneAndASurfaceOfVeryDifferentSizes)
{
  const MeshPair pair{ MakePlanarPair(4, 69).Source, MakeSheet(4, 70, 0.9) };
  ExpectSameAtAnyScale(pair, 664, -664);
  ExpectSameAtAnyScale(pair, -664, 664);
  ExpectSameAtAnyScale({ pair.Target, pair.Source }, 664, -664);
}

TEST(ExtremeScales, ScalesFromTenToTheTwoHundredToItsReciprocal)
{
  // Decimal scales. The meshes are similar, so the map is the similarity, whose factor is not a
  // double.
  const MeshPair flat = MakePlanarPair(3, 71);
  const auto sheet = MakeSheet(3, 72, 0.7);
  for (const auto& mesh : { flat.Source, sheet })
  {
    const MeshPair pair{ Scaled(mesh, 1e200), Scaled(mesh, 1e-200) };
    const std::vector<Point> samples = RandomPointsOf(mesh, 4, 73);
    std::vector<Point> large = samples;
    for (Point& p : large)
    {
      p = Times(p, 1e200);
    }
    for (const int system : Systems)
    {
      const Mapped mapped = MapPoints(pair, large, { system });
      ASSERT_EQ(mapped.Error, "");
      ASSERT_TRUE(mapped.AllValid());
      for (std::size_t i = 0; i < samples.size(); ++i)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          // Relative to the size of the mesh, 3.
          EXPECT_NEAR(mapped.Points[i][axis] * 1e200, samples[i][axis], 100.0 * Epsilon);
        }
        if (mesh == flat.Source)
        {
          EXPECT_EQ(mapped.Points[i][2], 0.0);
        }
      }
    }
  }
}

TEST(ExtremeScales, HeightsAreExactWhateverTheScales)
{
  // Heights above a plane are lengths of the ambient space. They do not depend on the sizes of the
  // meshes.
  const MeshPair flat = MakePlanarPair(3, 74);
  for (const auto& scales : std::vector<std::array<double, 2>>{ { 1e200, 1e-200 },
         { 1e-200, 1e200 }, { 1e200, 1e200 }, { 1e-200, 1e-200 }, { 1.0, 1e-200 } })
  {
    const MeshPair pair{ Scaled(flat.Source, scales[0]), Scaled(flat.Target, scales[1]) };
    std::vector<Point> samples = RandomPointsOf(pair.Source, 5, 75);
    // A corner, which is mapped by a separate rule.
    samples.push_back(PointOf(pair.Source, 5));
    // Relative to the size of either mesh these are normal numbers.
    for (const double height : { 0.0, 1.0, -0.3, 5.0, 1e-90, -1e80 })
    {
      SCOPED_TRACE(
        ::testing::Message() << scales[0] << " to " << scales[1] << ", height " << height);
      std::vector<Point> raised = samples;
      for (Point& p : raised)
      {
        p[2] = height;
      }
      for (const int system : Systems)
      {
        const Mapped mapped = MapPoints(pair, raised, { system });
        ASSERT_EQ(mapped.Error, "");
        ASSERT_TRUE(mapped.AllValid());
        for (std::size_t i = 0; i < raised.size(); ++i)
        {
          ASSERT_EQ(mapped.Points[i][2], height);
          ASSERT_TRUE(mapped.Points[i][0] >= 0.0 && mapped.Points[i][0] <= 3.1 * scales[1]);
          ASSERT_TRUE(mapped.Points[i][1] >= 0.0 && mapped.Points[i][1] <= 3.1 * scales[1]);
        }
      }
    }
  }
}

/// A square whose corner at the origin is a triangle of the size @a tiny.
MeshPair MakePairWithTinyTriangle(double tiny, double targetStretch)
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 1, 3, 5 }, { 1, 5, 2 }, { 2, 5, 4 } };
  const std::vector<Point> source{ { 0, 0, 0 }, { tiny, 0, 0 }, { 0, tiny, 0 }, { 1, 0, 0 },
    { 0, 1, 0 }, { 1, 1, 0 } };
  std::vector<Point> target = source;
  for (Point& p : target)
  {
    p[0] *= targetStretch;
  }
  target[5][1] = 1.5;
  return { MakeMesh(source, triangles), MakeMesh(target, triangles) };
}

/// Maps points of a tiny triangle of a unit mesh and of its neighbors and back.
void ExpectTinyTriangleMapped(double tiny, int system)
{
  SCOPED_TRACE(tiny);
  const MeshPair pair = MakePairWithTinyTriangle(tiny, 2.0);
  std::vector<Point> inTiny;
  for (const Point& p :
    RandomPointsOf(MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } }), 20, 77))
  {
    inTiny.push_back(Times(p, tiny));
  }
  const Mapped inside = MapPoints(pair, inTiny, { system });
  ASSERT_EQ(inside.Error, "");
  ASSERT_TRUE(inside.AllValid());
  for (std::size_t i = 0; i < inTiny.size(); ++i)
  {
    EXPECT_EQ(inside.Triangles[i], 0);
    for (int axis = 0; axis < 2; ++axis)
    {
      const double stretch = axis == 0 ? 2.0 : 1.0;
      const double image = inside.Points[i][axis] / tiny;
      ASSERT_TRUE(std::isfinite(image));
      ASSERT_GE(image, -10.0 * Epsilon);
      ASSERT_LE(image, stretch * (1.0 + 10.0 * Epsilon));
      if (system == vtkDifferentiableHomeomorphism::LINEAR)
      {
        ASSERT_NEAR(image, stretch * (inTiny[i][axis] / tiny), 20.0 * Epsilon);
      }
    }
  }
  const Mapped back = MapPoints(pair, inside.Points, { system, false, true });
  ASSERT_TRUE(back.AllValid());
  for (std::size_t i = 0; i < inTiny.size(); ++i)
  {
    for (int axis = 0; axis < 2; ++axis)
    {
      ASSERT_NEAR(back.Points[i][axis] / tiny, inTiny[i][axis] / tiny, 1e-12);
    }
  }

  const std::vector<Point> elsewhere{ { 0.5, 0.25, 0 }, { 0.25, 0.5, 0 }, { 0.75, 0.8, 0 } };
  const Mapped others = MapPoints(pair, elsewhere, { system });
  ASSERT_TRUE(others.AllValid());
  const Mapped othersBack = MapPoints(pair, others.Points, { system, false, true });
  ASSERT_TRUE(othersBack.AllValid());
  for (std::size_t i = 0; i < elsewhere.size(); ++i)
  {
    ASSERT_NEAR(othersBack.Points[i][0], elsewhere[i][0], 1e-12);
    ASSERT_NEAR(othersBack.Points[i][1], elsewhere[i][1], 1e-12);
  }
}

TEST(ExtremeScales, ANeedleWhoseHeightIsLostInRounding)
{
  // The far corners are so far away that the others coincide in their frame, but the triangles are
  // not degenerate.
  const std::vector<Triangle> triangles{ { 0, 1, 3 }, { 0, 3, 2 } };
  const MeshPair pair{ MakeMesh({ { 1.25, 0.125, 0.0 }, { -2.25, 4.9375, 0.0 },
                                  { 5.875, 4.75, 0.0 }, { -7.5, 0x1p74, 0.0 } },
                         triangles),
    MakeMesh({ { -7.5, -7.5, 0.0 }, { -7.5, -3.5625, 0.0 }, { 0.0625, 0.0625, 0.0 },
               { 0.0625, -0x1p57, 0.0 } },
      triangles) };
  for (const int system : Systems)
  {
    for (const bool inverse : { false, true })
    {
      SCOPED_TRACE("system " + std::to_string(system) + (inverse ? ", inverse" : ""));
      std::vector<Point> points = RandomPointsOf(inverse ? pair.Target : pair.Source, 100, 5);
      points.push_back({ -7.5, -7.5, 0.0 });
      const Mapped mapped = MapPoints(pair, points, { system, true, inverse });
      ASSERT_EQ(mapped.Error, "");
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        if (mapped.Valid[i])
        {
          EXPECT_TRUE(std::isfinite(mapped.Points[i][0]) && std::isfinite(mapped.Points[i][1]))
            << i;
        }
      }
    }
  }
}

// Products of such lengths underflow, but the triangle has an area and an orientation.
constexpr double TinySizes[] = { 1e-20, 1e-100, 1e-150, 1e-160, 1e-170, 1e-250 };

TEST(ExtremeScales, ATinyTriangleInAUnitMeshLinear)
{
  for (const double tiny : TinySizes)
  {
    ExpectTinyTriangleMapped(tiny, vtkDifferentiableHomeomorphism::LINEAR);
  }
}

TEST(ExtremeScales, ATinyTriangleInAUnitMeshContour)
{
  for (const double tiny : TinySizes)
  {
    ExpectTinyTriangleMapped(tiny, vtkDifferentiableHomeomorphism::CONTOUR);
  }
}

TEST(ExtremeScales, ATinyTriangleInAUnitMeshSmooth)
{
  for (const double tiny : TinySizes)
  {
    ExpectTinyTriangleMapped(tiny, vtkDifferentiableHomeomorphism::SMOOTH);
  }
}

TEST(ExtremeScales, ATinyTriangleHasCoordinates)
{
  const vtkNew<vtkTriangularCoordinates> filter;
  Messages messages(filter);
  const MeshPair pair = MakePairWithTinyTriangle(1e-170, 2.0);
  filter->SetInputData(0, pair.Source);
  filter->SetDataObject(MakeMesh({ { 3e-171, 3e-171, 0.0 } }, {}));
  filter->SetCoordinateSystem(vtkTriangularCoordinates::LINEAR);
  filter->Update();
  ASSERT_FALSE(messages.HasError()) << messages.Error();
  auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(output->GetPointData()->GetArray("TriangleId")->GetTuple1(0), 0.0);
  EXPECT_EQ(output->GetPointData()->GetArray("vtkValidPointMask")->GetTuple1(0), 1.0);
}

TEST(ExtremeScales, ATinyDegenerateTriangleIsRefused)
{
  // Three collinear points, exactly representable.
  const MeshPair pair = MakePairWithTinyTriangle(1e-170, 1.0);
  pair.Source->GetPoints()->SetPoint(2, 0.5e-170, 0.0, 0.0);
  const Mapped mapped = MapPoints(pair, { { 0.5, 0.25, 0 } });
  EXPECT_NE(mapped.Error.find("1 triangle of the source (cell 0) is degenerate"), std::string::npos)
    << mapped.Error;
}

//------------------------------------------------------------------------------------------------
// Overlaps behind overlaps.

double Cross2(const Point& a, const Point& b, const Point& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool IsStrictlyInside(vtkPolyData* mesh, vtkIdType cell, const Point& p)
{
  vtkNew<vtkIdList> ids;
  mesh->GetCellPoints(cell, ids);
  const Point a = PointOf(mesh, ids->GetId(0));
  const Point b = PointOf(mesh, ids->GetId(1));
  const Point c = PointOf(mesh, ids->GetId(2));
  const double area = Cross2(a, b, c);
  const double least = 1e-9;
  return Cross2(a, b, p) / area > least && Cross2(b, c, p) / area > least &&
    Cross2(c, a, p) / area > least;
}

struct WoundStrip
{
  MeshPair Pair;
  /// Number of triangles of the strip. The small triangles follow them.
  vtkIdType StripTriangles = 0;
  vtkIdType BoundaryTriangles = 0;
};

/// The source is a straight strip with a small triangle on top of each of its boundary triangles.
/// In the target the small triangles are elsewhere, but the strip is wound by more than a turn, so
/// that its end overlaps its beginning.
WoundStrip MakeWoundStrip(double turns)
{
  const int length = 60;
  const int width = 5;
  WoundStrip strip;
  std::vector<Triangle> triangles;
  std::vector<Point> source;
  std::vector<Point> target;
  for (int j = 0; j <= width; ++j)
  {
    for (int i = 0; i <= length; ++i)
    {
      source.push_back({ double(i), double(j), 0.0 });
      const double angle = -2.0 * vtkMath::Pi() * turns * i / length;
      target.push_back({ (8.0 + j) * std::cos(angle), (8.0 + j) * std::sin(angle), 0.0 });
    }
  }
  const auto id = [](int i, int j) { return static_cast<vtkIdType>(j) * (length + 1) + i; };
  std::vector<Triangle> atBoundary;
  for (int j = 0; j < width; ++j)
  {
    for (int i = 0; i < length; ++i)
    {
      triangles.push_back({ id(i, j), id(i + 1, j), id(i + 1, j + 1) });
      if (j == 0 || i == length - 1)
      {
        atBoundary.push_back(triangles.back());
      }
      triangles.push_back({ id(i, j), id(i + 1, j + 1), id(i, j + 1) });
      if (j == width - 1 || i == 0)
      {
        atBoundary.push_back(triangles.back());
      }
    }
  }
  strip.StripTriangles = static_cast<vtkIdType>(triangles.size());
  strip.BoundaryTriangles = static_cast<vtkIdType>(atBoundary.size());
  for (std::size_t n = 0; n < atBoundary.size(); ++n)
  {
    const vtkIdType first = static_cast<vtkIdType>(source.size());
    triangles.push_back({ first, first + 1, first + 2 });
    for (int k = 0; k < 3; ++k)
    {
      Point p{};
      for (int other = 0; other < 3; ++other)
      {
        for (int axis = 0; axis < 2; ++axis)
        {
          p[axis] += (other == k ? 0.6 : 0.2) * source[atBoundary[n][other]][axis];
        }
      }
      source.push_back(p);
    }
    const double x = 100.0 + 2.0 * static_cast<double>(n);
    target.insert(target.end(), { { x, 0, 0 }, { x + 1, 0, 0 }, { x + 1, 1, 0 } });
  }
  strip.Pair = { MakeMesh(source, triangles), MakeMesh(target, triangles) };
  return strip;
}

TEST(ExtremeScales, OverlapsHiddenBehindOtherOverlapsAreFound)
{
  // The triangles that overlap in the source are masked: exactly the boundary of the strip, where
  // an overlap in the target would be searched. The new boundary must be searched too.
  const WoundStrip strip = MakeWoundStrip(1.3);
  for (const MeshPair& pair : { strip.Pair, MeshPair{ strip.Pair.Target, strip.Pair.Source } })
  {
    const bool exchanged = pair.Source == strip.Pair.Target;
    SCOPED_TRACE(exchanged ? "exchanged" : "as described");
    const int perTriangle = 4;
    const std::vector<Point> samples = RandomPointsOf(pair.Source, perTriangle, 81);
    const Mapped mapped = MapPoints(pair, samples, { Systems[0], true });
    ASSERT_EQ(mapped.Error, "");
    EXPECT_NE(mapped.Warning.find("triangles of the source"), std::string::npos);

    // The middle of the strip does not overlap.
    std::vector<bool> used(pair.Source->GetNumberOfCells(), false);
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      if (mapped.Valid[i])
      {
        used[mapped.Triangles[i]] = true;
      }
    }
    const auto numberUsed = std::count(used.begin(), used.begin() + strip.StripTriangles, true);
    EXPECT_GT(numberUsed, 100);
    if (!exchanged)
    {
      // About 0.3 of 1.3 turns overlap. These triangles are listed in addition to the 2 x
      // BoundaryTriangles.
      EXPECT_NE(mapped.Warning.find(
                  std::to_string(2 * strip.BoundaryTriangles) + " triangles of the source"),
        std::string::npos)
        << mapped.Warning;
      EXPECT_NE(mapped.Warning.find("triangles of the target"), std::string::npos)
        << mapped.Warning;
      EXPECT_LT(numberUsed, 300);
    }

    // Injectivity: no image lies inside a second unmasked triangle, in either mesh.
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      if (!mapped.Valid[i])
      {
        continue;
      }
      for (vtkIdType t = 0; t < pair.Source->GetNumberOfCells(); ++t)
      {
        if (used[t] && t != mapped.Triangles[i])
        {
          ASSERT_FALSE(IsStrictlyInside(pair.Target, t, mapped.Points[i])) << t;
          ASSERT_FALSE(IsStrictlyInside(pair.Source, t, samples[i])) << t;
        }
      }
    }

    // Hence the inverse returns to the start.
    std::vector<Point> images;
    std::vector<Point> origins;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      if (mapped.Valid[i])
      {
        images.push_back(mapped.Points[i]);
        origins.push_back(samples[i]);
      }
    }
    const Mapped back = MapPoints(pair, images, { Systems[0], true, true });
    ASSERT_TRUE(back.AllValid());
    for (std::size_t i = 0; i < origins.size(); ++i)
    {
      EXPECT_NEAR(back.Points[i][0], origins[i][0], 1e-11);
      EXPECT_NEAR(back.Points[i][1], origins[i][1], 1e-11);
    }
  }
}

TEST(ExtremeScales, AStripWoundLessThanATurnOverlapsNothing)
{
  // Less than a full turn: only the overlaps of the source are masked.
  const WoundStrip strip = MakeWoundStrip(0.95);
  const Mapped mapped =
    MapPoints(strip.Pair, RandomPointsOf(strip.Pair.Source, 1, 82), { Systems[0], true });
  ASSERT_EQ(mapped.Error, "");
  EXPECT_EQ(mapped.Warning.find("of the target"), std::string::npos) << mapped.Warning;
  const auto valid =
    std::count(mapped.Valid.begin(), mapped.Valid.begin() + strip.StripTriangles, true);
  EXPECT_EQ(valid, strip.StripTriangles - strip.BoundaryTriangles);
}

//------------------------------------------------------------------------------------------------
// Time.

/// Processor time of a run in seconds, of all its threads. Other processes do not count; sanitizers
/// slow everything down.
template <typename Run>
double SecondsOf(Run&& run)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  const double slowness = 20.0;
#else
  const double slowness = 1.0;
#endif
  const std::clock_t begin = std::clock();
  run();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / slowness;
}

constexpr int Many = 20000;

/// Triangles around the point (0, 0), where all their boxes overlap.
vtkSmartPointer<vtkPolyData> MakeFan(int count, double phase)
{
  std::vector<Point> points{ { 0, 0, 0 } };
  std::vector<Triangle> triangles;
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double angle = 2.0 * vtkMath::Pi() * (static_cast<double>(i) + phase) / count;
    points.push_back({ std::cos(angle), std::sin(angle), 0.0 });
    triangles.push_back({ 0, i + 1, (i + 1) % count + 1 });
  }
  return MakeMesh(points, triangles);
}

TEST(ExtremeScales, AFanOfManyTriangles)
{
  const MeshPair pair{ MakeFan(Many, 0.0), MakeFan(Many, 0.3) };
  Mapped mapped;
  EXPECT_LT(SecondsOf([&] { mapped = MapPoints(pair, { { 0.5, 0.25, 0 }, { 0, 0, 0 } }); }), 2.0);
  EXPECT_EQ(mapped.Error, "");
  EXPECT_TRUE(mapped.AllValid());
}

TEST(ExtremeScales, AFanThatGoesRoundTwiceIsRefused)
{
  // Speed must not hide the overlap of a fan with itself. (Fewer triangles: listing the overlaps of
  // a fan takes quadratic time.)
  const int count = 1000;
  const auto mesh = MakeFan(count, 0.0);
  for (vtkIdType i = 0; i < count; ++i)
  {
    // The points of the second turn lie between those of the first.
    const double step = static_cast<double>(i) + (2 * i >= count ? 0.5 : 0.0);
    const double angle = 4.0 * vtkMath::Pi() * step / count;
    mesh->GetPoints()->SetPoint(i + 1, std::cos(angle), std::sin(angle), 0.0);
  }
  const Mapped mapped = MapPoints({ mesh, MakeFan(count, 0.0) }, { { 0.5, 0.25, 0 } });
  EXPECT_NE(mapped.Error.find("1000 triangles of the source (cells 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, "
                              "...) overlap other triangles"),
    std::string::npos)
    << mapped.Error;
}

TEST(ExtremeScales, AStackOfManyTriangles)
{
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  for (vtkIdType i = 0; i < Many; ++i)
  {
    points.insert(points.end(), { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } });
    triangles.push_back({ 3 * i, 3 * i + 1, 3 * i + 2 });
  }
  const auto mesh = MakeMesh(points, triangles);
  Mapped mapped;
  EXPECT_LT(SecondsOf([&] { mapped = MapPoints({ mesh, mesh }, { { 0.25, 0.25, 0 } }); }), 2.0);
  EXPECT_NE(mapped.Error.find("20000 triangles of the source (cells 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, "
                              "...) overlap other triangles"),
    std::string::npos)
    << mapped.Error;
}

} // namespace
