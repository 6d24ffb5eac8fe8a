// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The map does not depend on the sizes of the meshes, up to the ends of the range of doubles.

#include "Fixtures/Defects.h"

namespace
{

using namespace fixtures;

using Scales = TestInEverySystem;

INSTANTIATE_TEST_SUITE_P(All, Scales, ::testing::ValuesIn(AllSystems()), NameOfSystem);

/// Images of points of the source, which are scaled with it, divided by the scale of the target.
std::vector<Point> MapScaled(const System& system, const MeshPair& pair,
  const std::vector<Point>& points, double source, double target, bool inverse = false)
{
  const auto filter =
    MakeFilter(system, { Resized(pair.Source, source), Resized(pair.Target, target) },
      Resized(MakeCloud(points), inverse ? target : source));
  filter->SetInverse(inverse);
  vtkPointSet* images = Output(filter);
  EXPECT_EQ(filter->GetErrorCode(), 0u);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
  return PointsOf(Resized(MakeCloud(PointsOf(images)), 1.0 / (inverse ? source : target)));
}

TEST_P(Scales, PowersOfTwoAreExact)
{
  // 2^664 is about 8e199, 2^-664 about 1e-200.
  const auto plane = MakePlanarPair(4, 61);
  const auto sheet = MakeSheet(4, 67, 0.9);
  for (const Pairing& pairing :
    std::vector<Pairing>{ { "planes", plane }, { "sheets", { MakeSheet(4, 66, 0.5), sheet } },
      { "plane to sheet", { plane.Source, sheet } }, { "sheet to plane", { sheet, plane.Source } },
      { "closed", MakeClosedPair(2, 68) } })
  {
    for (const auto& exponents : std::vector<std::array<int, 2>>{ { 664, -664 }, { -664, 664 },
           { 1000, -1000 }, { 1000, 1000 }, { -1000, -1000 }, { 20, -20 } })
    {
      for (const bool inverse : { false, true })
      {
        vtkPolyData* from = inverse ? pairing.Meshes.Target : pairing.Meshes.Source;
        const std::vector<Point> points = SamplePoints(from, TrianglesOf(from), 3, 99);
        EXPECT_EQ(MapScaled(GetParam(), pairing.Meshes, points, std::ldexp(1.0, exponents[0]),
                    std::ldexp(1.0, exponents[1]), inverse),
          MapScaled(GetParam(), pairing.Meshes, points, 1.0, 1.0, inverse))
          << pairing.Name << exponents[0];
      }
    }
  }
}

TEST_P(Scales, HeightsAreExactWhateverTheScales)
{
  // Heights above a plane are lengths of the ambient space.
  const MeshPair flat = MakePlanarPair(3, 74);
  for (const auto& sizes : std::vector<std::array<double, 2>>{ { 1e200, 1e-200 }, { 1e-200, 1e200 },
         { 1e200, 1e200 }, { 1e-200, 1e-200 }, { 1.0, 1e-200 } })
  {
    const MeshPair pair{ Resized(flat.Source, sizes[0]), Resized(flat.Target, sizes[1]) };
    for (const double height : { 0.0, 1.0, -0.3, 5.0, 1e-90, -1e80 })
    {
      std::vector<Point> raised = SamplePoints(pair.Source, TrianglesOf(pair.Source), 5, 75);
      // A corner, which is mapped by a separate rule.
      raised.push_back(PointOf(pair.Source, 5));
      for (Point& p : raised)
      {
        p[2] = height;
      }
      const auto filter = MakeFilter(GetParam(), pair, MakeCloud(raised));
      for (const Point& image : PointsOf(Output(filter)))
      {
        ASSERT_EQ(image[2], height);
        ASSERT_GE(std::min(image[0], image[1]), 0.0);
        ASSERT_LE(std::max(image[0], image[1]), 3.1 * sizes[1]);
      }
      ASSERT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    }
  }
}

/// A square whose corner at the origin is a triangle of the size @a tiny.
MeshPair MakePairWithTinyTriangle(double tiny)
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 1, 3, 5 }, { 1, 5, 2 }, { 2, 5, 4 } };
  return { MakeMesh(
             { { 0, 0, 0 }, { tiny, 0, 0 }, { 0, tiny, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } },
             triangles),
    MakeMesh({ { 0, 0, 0 }, { 2.0 * tiny, 0, 0 }, { 0, tiny, 0 }, { 2, 0, 0 }, { 0, 1, 0 },
               { 2, 1.5, 0 } },
      triangles) };
}

TEST_P(Scales, ATinyTriangleInAUnitMesh)
{
  // Products of such lengths underflow, but the triangle has an area and an orientation.
  for (const double tiny : { 1e-20, 1e-100, 1e-150, 1e-160, 1e-170, 1e-250 })
  {
    SCOPED_TRACE(tiny);
    const MeshPair pair = MakePairWithTinyTriangle(tiny);
    std::vector<Point> points = SamplePoints(pair.Source, { { 0, 1, 2 } }, 20, 77);
    points.insert(points.end(), { { 0.5, 0.25, 0 }, { 0.25, 0.5, 0 }, { 0.75, 0.8, 0 } });
    const MappedPoints mapped = MapPoints(pair, points, { GetParam() });
    const MappedPoints back = MapPoints(pair, mapped.Images, { GetParam(), false, true });
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const bool inTiny = i < 20;
      const double size = inTiny ? tiny : 1.0;
      ASSERT_EQ(mapped.Triangles[i] == 0, inTiny);
      for (int axis = 0; axis < 2; ++axis)
      {
        const double stretch = axis == 0 ? 2.0 : 1.0;
        const double image = mapped.Images[i][axis] / size;
        ASSERT_GE(image, -10.0 * Ulp);
        ASSERT_LE(image, stretch * 1.5);
        if (inTiny && GetParam().CoordinateSystem == Linear.CoordinateSystem)
        {
          ASSERT_NEAR(image, stretch * (points[i][axis] / tiny), 20.0 * Ulp);
        }
        ASSERT_NEAR(back.Images[i][axis] / size, points[i][axis] / size, 1e-12);
      }
    }
  }
  // Three collinear points of that size are found, too.
  const MeshPair pair = MakePairWithTinyTriangle(1e-170);
  MovePoint(pair.Source, 2, { 0.5e-170, 0.0, 0.0 });
  ExpectRefused(Read(pair), { { Kind::DegenerateTriangle, Where::Source, { 0 } } });
}

} // namespace
