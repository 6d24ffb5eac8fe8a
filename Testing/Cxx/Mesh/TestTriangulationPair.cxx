// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// With MaskInvalidTriangles exactly the defective triangles are masked, and the rest is mapped as
// if they had been removed from the meshes.

#include "Fixtures/Defects.h"
#include "Fixtures/FilterRuns.h"

namespace
{

using namespace fixtures;

Reading ReadMasked(const MeshPair& pair)
{
  homeomorphism::HomeomorphismOptions options;
  options.MaskInvalidTriangles = true;
  return Read(pair, options);
}

/// Whether points can be inside a triangle and not in a neighbor across an edge.
bool HasInterior(vtkPolyData* mesh, const Triangle& t)
{
  const Point a = PointOf(mesh, t[0]);
  const double area = Norm(Cross(PointOf(mesh, t[1]) - a, PointOf(mesh, t[2]) - a));
  return std::isfinite(area) && area > 1e-6;
}

/// The defects are found, and all their cells are masked. Of @a forwardOnly pairs the inverse map
/// is not compared.
void ExpectMasked(
  const MeshPair& pair, const std::vector<Defect>& defects, bool forwardOnly = false)
{
  const Reading reading = ReadMasked(pair);
  ASSERT_TRUE(reading.Map);
  EXPECT_EQ(reading.Defects(), defects);
  const std::vector<Triangle> triangles = TrianglesOf(pair.Source);
  std::vector<bool> masked(triangles.size(), false);
  for (const MeshDiagnostic& one : reading.Diagnostics)
  {
    EXPECT_EQ(one.Result, Outcome::Masked);
    for (const vtkIdType cell : one.Ids)
    {
      masked[static_cast<std::size_t>(cell)] = true;
    }
  }
  std::vector<Triangle> rest;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    EXPECT_EQ(reading.Map->GetPair().GetTriangulation().IsMasked(static_cast<int>(t)), masked[t]);
    if (!masked[t])
    {
      rest.push_back(triangles[t]);
    }
  }
  const MeshPair pierced = WithTriangles(pair, rest);
  for (const bool inverse : { false, true })
  {
    if (inverse && forwardOnly)
    {
      continue;
    }
    vtkPolyData* from = inverse ? pair.Target : pair.Source;
    std::vector<Point> points;
    Ids expectedTriangles;
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      if (HasInterior(from, triangles[t]))
      {
        const std::vector<Point> inside = SamplePoints(from, { triangles[t] }, 4, t);
        points.insert(points.end(), inside.begin(), inside.end());
        expectedTriangles.insert(
          expectedTriangles.end(), 4, masked[t] ? -1 : static_cast<vtkIdType>(t));
      }
    }
    for (const System& system : { Linear, Contour, Smooth })
    {
      MapOptions options;
      options.Inverse = inverse;
      options.CoordinateSystem = system.CoordinateSystem;
      options.DiscordantTriangles = vtkDifferentiableHomeomorphism::USE_LINEAR;
      const MappedPoints expected = MapPoints(pierced, points, options);
      options.Mask = true;
      const MappedPoints mapped = MapPoints(pair, points, options);
      ASSERT_EQ(expected.Error + expected.Warning + mapped.Error, "");
      EXPECT_NE(mapped.Warning, "");
      EXPECT_EQ(mapped.Triangles, expectedTriangles);
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        EXPECT_EQ(expected.IsInside(i), mapped.IsInside(i));
        EXPECT_LE(Distance(expected.Images[i], mapped.Images[i]), 1e-14) << system.Name;
      }
    }
  }
}

TEST(Masking, DefectsOfSingleTriangles)
{
  std::vector<Triangle> repeated = GridTriangles(4);
  repeated[9] = { 6, 12, 12 };
  ExpectMasked(WithTriangles(MakePlanarPair(4, 1), repeated),
    { { Kind::RepeatedCorner, Where::Source, { 9 } } });
  for (const bool inSource : { true, false })
  {
    const Where where = inSource ? Where::Source : Where::Target;
    for (const Point& bad : { Point{ NotANumber, 2, 0 }, { 2, Infinity, 0 }, { 2, 2, -Infinity } })
    {
      const MeshPair pair = MakePlanarPair(4, 2);
      MovePoint(inSource ? pair.Source : pair.Target, 12, bad);
      ExpectMasked(pair, { { Kind::NotFinite, where, { 10, 11, 13, 18, 20, 21 } } });
    }
    // On the line from point 18 to point 23, so that only one of its two triangles collapses.
    const MeshPair pair = MakePlanarPair(4, 4, 0.0);
    MovePoint(inSource ? pair.Source : pair.Target, 24, { 3.0, 3.5, 0.0 });
    ExpectMasked(pair, { { Kind::DegenerateTriangle, where, { 31 } } });
  }
  // On a surface the inverse map finds its neighbors instead of the collapsed triangle.
  const MeshPair sheets{ MakeSheet(4, 5, 0.3), MakeSheet(4, 6, 0.4) };
  MovePoint(sheets.Target, 24, PointIn(sheets.Target, { 18, 23, 24 }, { 0.6, 0.4, 0.0 }));
  ExpectMasked(sheets, { { Kind::DegenerateTriangle, Where::Target, { 31 } } }, true);
}

TEST(Masking, DifferentDefectsInBothMeshes)
{
  const MeshPair pair = MakePlanarPair(4, 3, 0.0);
  MovePoint(pair.Source, 0, { 1.0, 1.0, 0.0 });
  MovePoint(pair.Target, 24, { 3.0, 3.5, NotANumber });
  ExpectMasked(pair,
    { { Kind::DegenerateTriangle, Where::Source, { 0, 1 } },
      { Kind::NotFinite, Where::Target, { 30, 31 } } });
}

TEST(Masking, NonManifoldEdges)
{
  // A fin on the edge of triangles 0 and 1, and a second one on the edge of the last two.
  std::vector<Triangle> triangles = GridTriangles(3);
  triangles.push_back({ 0, 5, 16 });
  triangles.push_back({ 10, 15, 16 });
  const MeshPair pair{ MakeSheet(3, 7, 0.4), MakeSheet(3, 8, 0.4) };
  for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
  {
    mesh->GetPoints()->InsertNextPoint(0.5, 0.5, 2.0);
    SetTriangles(mesh, triangles);
  }
  ExpectMasked(pair, { { Kind::NonManifoldEdge, Where::Source, { 0, 1, 16, 17, 18, 19 } } });
}

TEST(Masking, FlippedTriangles)
{
  const std::vector<Point> points{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 2, 0, 0 }, { 3, 0, 0 },
    { 2, 1, 0 }, { 4, 0, 0 }, { 5, 0, 0 }, { 4, 1, 0 } };
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 3, 4, 5 }, { 6, 7, 8 } };
  const MeshPair alone{ MakeMesh(points, triangles), MakeMesh(points, triangles) };
  MovePoint(alone.Target, 5, { 2, -1, 0 });
  ExpectMasked(alone, { { Kind::Flipped, Where::Pair, { 1 } } });
  // Cell 31 is flipped in the target. Its neighbor across the edge to the moved point, cell 30,
  // then lies on cell 28.
  const MeshPair pair = MakePlanarPair(4, 9, 0.0);
  MovePoint(pair.Target, 24, { 2.9, 3.5, 0.0 });
  ExpectMasked(pair,
    { { Kind::Flipped, Where::Pair, { 31 } }, { Kind::Overlapping, Where::Target, { 28, 30 } } });
}

/// Grids at some places, whole or only their outermost squares, as one mesh.
struct Sheet
{
  Point Corner;
  int Squares;
  bool FrameOnly;
};
vtkSmartPointer<vtkPolyData> MakeSheets(const std::vector<Sheet>& sheets)
{
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  for (const Sheet& sheet : sheets)
  {
    const int n = sheet.Squares;
    const auto first = static_cast<vtkIdType>(points.size());
    for (const Point& p : GridPoints(n, 0, 0.0))
    {
      points.push_back(p + sheet.Corner);
    }
    const std::vector<Triangle> grid = GridTriangles(n);
    for (std::size_t t = 0; t < grid.size(); ++t)
    {
      const int i = static_cast<int>(t) / 2 % n;
      const int j = static_cast<int>(t) / 2 / n;
      if (!sheet.FrameOnly || i == 0 || j == 0 || i == n - 1 || j == n - 1)
      {
        triangles.push_back({ grid[t][0] + first, grid[t][1] + first, grid[t][2] + first });
      }
    }
  }
  return MakeMesh(points, triangles);
}

TEST(Masking, OverlappingSheets)
{
  // They share the square from (2.5, 2.5) to (4, 4): the four squares in the corner of the first
  // sheet and of the second.
  const auto overlapping = MakeSheets({ { { 0, 0, 0 }, 4, false }, { { 2.5, 2.5, 0 }, 4, false } });
  const auto apart = MakeSheets({ { { 0, 0, 0 }, 4, false }, { { 4, 0, 0 }, 4, false } });
  const Ids cells{ 20, 21, 22, 23, 28, 29, 30, 31, 32, 33, 34, 35, 40, 41, 42, 43 };
  ExpectMasked({ overlapping, apart }, { { Kind::Overlapping, Where::Source, cells } });
  ExpectMasked({ apart, overlapping }, { { Kind::Overlapping, Where::Target, cells } });
  // After masking them because of the source, the target has no overlap.
  ExpectMasked({ overlapping, overlapping }, { { Kind::Overlapping, Where::Source, cells } });
}

TEST(Masking, OverlapInTheTargetBehindOneInTheSource)
{
  // Sheets A and B coincide in the target. In the source two frames cover the outermost triangles
  // of A and B, so these are already masked when the target is checked. Only therefore do the rests
  // of A and B have a boundary.
  const MeshPair pair{ MakeSheets({ { { 0, 0, 0 }, 6, false }, { { 20, 0, 0 }, 6, false },
                         { { 0, 0, 0 }, 6, true }, { { 20, 0, 0 }, 6, true } }),
    MakeSheets({ { { 0, 0, 0 }, 6, false }, { { 0, 0, 0 }, 6, false }, { { 20, 0, 0 }, 6, true },
      { { 30, 0, 0 }, 6, true } }) };
  const Reading reading = ReadMasked(pair);
  ASSERT_EQ(reading.Diagnostics.size(), 2u);
  EXPECT_EQ(reading.Diagnostics[0].Ids.size(), 160u);
  EXPECT_EQ(reading.Diagnostics[1].Ids.size(), 64u);
  ExpectMasked(pair,
    { { Kind::Overlapping, Where::Source, reading.Diagnostics[0].Ids },
      { Kind::Overlapping, Where::Target, reading.Diagnostics[1].Ids } });
  for (int t = 0; t < 224; ++t)
  {
    EXPECT_TRUE(reading.Map->GetPair().GetTriangulation().IsMasked(t));
  }
}

TEST(Masking, MaskedTrianglesAreNoPartOfTheDomain)
{
  // A fin perpendicular to a flat sheet: without it and the two triangles beside it, the pair is
  // planar, and heights are kept.
  const MeshPair finned = MakePlanarPair(3, 10, 0.2);
  // A collapsed triangle far away would enlarge the diagonal, to which the tolerance is relative.
  const MeshPair spread = MakePlanarPair(3, 12, 0.2);
  for (vtkPolyData* mesh : { finned.Source.Get(), finned.Target.Get() })
  {
    mesh->GetPoints()->InsertNextPoint(0.5, 0.5, 2.0);
    mesh->GetPolys()->InsertNextCell({ 0, 5, 16 });
  }
  for (vtkPolyData* mesh : { spread.Source.Get(), spread.Target.Get() })
  {
    mesh->GetPoints()->InsertNextPoint(1000.0, 0.0, 0.0);
    mesh->GetPolys()->InsertNextCell({ 0, 3, 16 });
  }
  MapOptions options;
  options.Mask = true;
  const MappedPoints high = MapPoints(finned, { { 2.0, 1.3, 0.5 } }, options);
  ASSERT_TRUE(high.IsInside(0));
  EXPECT_EQ(high.Images[0][2], 0.5);
  options.Tolerance = 0.01;
  const MappedPoints near = MapPoints(spread, { { 1.5, 3.04, 0.0 }, { 1.5, 3.05, 0.0 } }, options);
  EXPECT_TRUE(near.IsInside(0));
  EXPECT_FALSE(near.IsInside(1));
}

TEST(Masking, DefectsOfTheWholeMeshAreRefused)
{
  // Five points, five triangles: the smallest Moebius strip.
  const auto strip = MakeMesh(
    { { 1, 0, 0.1 }, { 0.3, 1, -0.2 }, { -0.8, 0.6, 0.3 }, { -0.8, -0.6, -0.1 }, { 0.3, -1, 0.4 } },
    { { 0, 1, 2 }, { 1, 3, 2 }, { 2, 3, 4 }, { 3, 0, 4 }, { 4, 0, 1 } });
  const MeshPair pair = MakePlanarPair(4, 13);
  std::vector<Triangle> triangles = GridTriangles(4);
  triangles[3] = { 1, 2, 99 };
  const auto corrupt = WithTriangles(pair.Source, triangles);
  triangles[3] = { 1, 2, 6 };
  const auto other = WithTriangles(pair.Source, triangles);
  for (const MeshPair& one : { MeshPair{ strip, strip }, MeshPair{ corrupt, corrupt },
         MeshPair{ other, pair.Target }, MeshPair{ pair.Source, MakePlanarPair(3, 1).Source } })
  {
    const Reading reading = ReadMasked(one);
    EXPECT_FALSE(reading.Map);
    ASSERT_FALSE(reading.Diagnostics.empty());
    EXPECT_EQ(reading.Diagnostics[0].Result, Outcome::Refused);
  }
}

TEST(Masking, NoneOrAllOfTheTriangles)
{
  ExpectAccepted(ReadMasked(MakePlanarPair(4, 14)));
  const auto collapsed = MakeMesh(std::vector<Point>(4, { 1, 1, 1 }), GridTriangles(1));
  MapOptions options;
  options.Mask = true;
  const MappedPoints mapped =
    MapPoints({ collapsed, collapsed }, { { 1, 1, 1 }, { 0, 0, 0 } }, options);
  EXPECT_EQ(mapped.Error, "");
  EXPECT_EQ(mapped.Triangles, (Ids{ -1, -1 }));
}

} // namespace
