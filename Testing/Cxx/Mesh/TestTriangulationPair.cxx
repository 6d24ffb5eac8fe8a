// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Defects of several triangles with MaskInvalidTriangles: masking some triangles may uncover or
// hide others. See TestMeshValidation for the defects of single triangles.

#include "Fixtures/Defects.h"

namespace
{

using namespace fixtures;

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
  EXPECT_EQ(reading.Masked(), Range(0, 223));
}

TEST(Masking, MaskedTrianglesAreNoPartOfTheDomain)
{
  // A fin perpendicular to a flat sheet: without it and the two triangles beside it, the pair is
  // planar, and heights are kept.
  const MeshPair finned = MakePlanarPair(3, 10, 0.2);
  // A collapsed triangle far away would enlarge the diagonal, to which the tolerance is relative.
  const MeshPair spread = MakePlanarPair(3, 12, 0.2);
  const auto add = [](vtkPolyData* mesh, const Point& point, vtkIdType second) {
    mesh->GetPoints()->InsertNextPoint(point.data());
    mesh->GetPolys()->InsertNextCell({ 0, second, 16 });
  };
  add(finned.Source, { 0.5, 0.5, 2.0 }, 5);
  add(finned.Target, { 0.5, 0.5, 2.0 }, 5);
  add(spread.Source, { 1000.0, 0.0, 0.0 }, 3);
  add(spread.Target, { 1000.0, 0.0, 0.0 }, 3);
  const MappedPoints high = MapPoints(finned, { { 2.0, 1.3, 0.5 } }, { Smooth, true });
  ASSERT_TRUE(high.IsInside(0));
  EXPECT_EQ(high.Images[0][2], 0.5);
  const MappedPoints near =
    MapPoints(spread, { { 1.5, 3.04, 0.0 }, { 1.5, 3.05, 0.0 } }, { Smooth, true, false, 0.01 });
  EXPECT_TRUE(near.IsInside(0));
  EXPECT_FALSE(near.IsInside(1));
}

TEST(Masking, DefectsOfTheWholeMeshAreRefused)
{
  const MeshPair pair = MakePlanarPair(4, 13);
  std::vector<Triangle> triangles = GridTriangles(4);
  triangles[3] = { 1, 2, 99 };
  const auto corrupt = WithTriangles(pair.Source, triangles);
  triangles[3] = { 1, 2, 6 };
  const auto other = WithTriangles(pair.Source, triangles);
  for (const MeshPair& one : { MeshPair{ corrupt, corrupt }, MeshPair{ other, pair.Target },
         MeshPair{ pair.Source, MakePlanarPair(3, 1).Source } })
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
  const MappedPoints mapped =
    MapPoints({ collapsed, collapsed }, { { 1, 1, 1 }, { 0, 0, 0 } }, { Smooth, true });
  EXPECT_EQ(mapped.Error, "");
  EXPECT_EQ(mapped.Triangles, (Ids{ -1, -1 }));
}

} // namespace
