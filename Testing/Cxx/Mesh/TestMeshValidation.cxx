// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Every defect for which meshes are refused: its kind, its mesh, and all its cells; and valid
// meshes that resemble defective ones.

#include "Fixtures/Defects.h"

#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedShortArray.h"

namespace
{

using namespace fixtures;

/// The two pairs give the same map, up to a distance.
void ExpectSameMap(const MeshPair& first, const MeshPair& second, double tolerance)
{
  const std::vector<Point> points = SamplePoints(first.Source, TrianglesOf(first.Source), 5, 2);
  for (const System& system : AllSystems())
  {
    const MappedPoints a = MapPoints(first, points, { system });
    const MappedPoints b = MapPoints(second, points, { system });
    ASSERT_EQ(a.Error + b.Error, "");
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      ASSERT_TRUE(a.IsInside(i) && b.IsInside(i));
      ASSERT_LE(Distance(a.Images[i], b.Images[i]), tolerance) << system.Name;
    }
  }
}

// --- Meshes that are not isomorphic --------------------------------------------------------------

TEST(MeshValidation, CountsDiffer)
{
  MeshPair pair = MakePlanarPair(4, 11);
  std::vector<Triangle> fewer = GridTriangles(4);
  fewer.pop_back();
  pair.Target = WithTriangles(pair.Target, fewer);
  pair.Target->GetPoints()->InsertNextPoint(9.0, 9.0, 0.0);
  const Reading reading = Read(pair);
  ExpectRefused(reading,
    { { Kind::PointCountsDiffer, Where::Pair, {} }, { Kind::CellCountsDiffer, Where::Pair, {} } },
    Remedy::UseSameMesh);
  EXPECT_EQ(reading.Diagnostics[0].Counts, (std::array<vtkIdType, 2>{ 25, 26 }));
  EXPECT_EQ(reading.Diagnostics[1].Counts, (std::array<vtkIdType, 2>{ 32, 31 }));
}

TEST(MeshValidation, ConnectivityDiffers)
{
  const MeshPair pair = MakePlanarPair(4, 13);
  const auto expect = [&pair](const std::vector<Triangle>& triangles, const Ids& cells) {
    const auto other = WithTriangles(pair.Target, triangles);
    for (const Reading& reading : { Read(pair.Source, other), Read(other, pair.Source) })
    {
      ExpectRefused(
        reading, { { Kind::ConnectivityDiffers, Where::Pair, cells } }, Remedy::UseSourceCells);
    }
  };
  // The other diagonal of the second square.
  std::vector<Triangle> triangles = GridTriangles(4);
  triangles[2] = { 1, 2, 6 };
  triangles[3] = { 2, 7, 6 };
  expect(triangles, { 2, 3 });
  // Another order of the triangles.
  triangles = GridTriangles(4);
  std::rotate(triangles.begin(), triangles.begin() + 1, triangles.end());
  expect(triangles, Range(0, 31));
  // {0, 1, 6} and {0, 0, 6} are equal as sets of points only.
  triangles = GridTriangles(4);
  triangles[0] = { 0, 0, 6 };
  expect(triangles, { 0 });
}

TEST(MeshValidation, TheOrderOfCornersIsFree)
{
  std::vector<Triangle> mixed = GridTriangles(5);
  std::vector<Triangle> reversed = GridTriangles(5);
  std::mt19937_64 generator(34);
  for (std::size_t t = 0; t < mixed.size(); ++t)
  {
    std::shuffle(mixed[t].begin(), mixed[t].end(), generator);
    std::swap(reversed[t][0], reversed[t][2]);
  }
  const MeshPair sheets{ MakeSheet(5, 35, 0.3), MakeSheet(5, 36, 0.4) };
  for (const MeshPair& pair : { MakePlanarPair(5, 34), sheets })
  {
    // That of the target changes nothing at all.
    ExpectSameMap(pair, { pair.Source, WithTriangles(pair.Target, mixed) }, 0.0);
    ExpectSameMap(pair, WithTriangles(pair, mixed), 2e-14);
    ExpectSameMap(pair, { WithTriangles(pair.Source, reversed), pair.Target }, 2e-14);
  }
}

// --- Cells that are not triangles, and corrupt cells ---------------------------------------------

TEST(MeshValidation, PolygonsWithOtherNumbersOfCornersAndStrips)
{
  const auto mesh = MakeCloud(GridPoints(2, 15, 0.2));
  mesh->SetPolys(MakePolygons(
    { { 0, 1, 4, 3 }, { 1, 2, 5 }, { 1, 5, 4 }, { 3, 4, 7, 6 }, { 4, 5, 8, 7, 4 }, { 4, 5 }, {} }));
  const Ids cells{ 0, 3, 4, 5, 6 };
  ExpectRefused(Read(mesh, mesh),
    { { Kind::NotTriangles, Where::Source, cells }, { Kind::NotTriangles, Where::Target, cells } },
    Remedy::Triangulate);
  ExpectRefused(
    Read(mesh), { { Kind::NotTriangles, Where::Triangulation, cells } }, Remedy::Triangulate);
  const auto addStrips = [](vtkPolyData* strips) {
    strips->SetStrips(MakePolygons({ { 0, 3, 1, 4, 2, 5 }, { 0, 3, 1, 4 } }));
  };
  // Strips follow the eight polygons.
  ExpectFoundInEachMesh(
    MakePlanarPair(2, 16), addStrips, Kind::TriangleStrips, { 8, 9 }, Remedy::Triangulate);
}

TEST(MeshValidation, PointsThatDoNotExist)
{
  for (const vtkIdType wrong :
    { vtkIdType(-1), vtkIdType(25), vtkIdType(1) << 31, (vtkIdType(1) << 32) + 1,
      std::numeric_limits<vtkIdType>::min(), std::numeric_limits<vtkIdType>::max() })
  {
    SCOPED_TRACE(wrong);
    for (int corner = 0; corner < 3; ++corner)
    {
      const auto damage = [&](vtkPolyData* mesh) {
        std::vector<Triangle> triangles = GridTriangles(4);
        triangles[7][corner] = wrong;
        triangles[31][corner] = wrong;
        SetTriangles(mesh, triangles);
      };
      ExpectFoundInEachMesh(
        MakePlanarPair(4, 17), damage, Kind::BadConnectivity, { 7, 31 }, Remedy::ReadAgain);
    }
  }
  vtkNew<vtkPolyData> noPoints;
  SetTriangles(noPoints, GridTriangles(1));
  ExpectRefused(Read(noPoints), { { Kind::BadConnectivity, Where::Triangulation, { 0, 1 } } },
    Remedy::ReadAgain);
}

/// Ids as an array of a type, and cells of three points each of which VTK knows the size alone, so
/// that it may store no offsets or an implicit array of them. Null if VTK does not take such ids.
template <typename ArrayType, typename Values>
vtkSmartPointer<ArrayType> MakeIds(const Values& values)
{
  const auto array = vtkSmartPointer<ArrayType>::New();
  for (const auto value : values)
  {
    array->InsertNextValue(static_cast<typename ArrayType::ValueType>(value));
  }
  return array;
}
template <typename ArrayType>
vtkSmartPointer<vtkPolyData> WithCellsOfThree(vtkPolyData* mesh)
{
  std::vector<vtkIdType> ids;
  for (const Triangle& triangle : TrianglesOf(mesh))
  {
    ids.insert(ids.end(), triangle.begin(), triangle.end());
  }
  vtkNew<vtkCellArray> cells;
  if (!cells->SetData(3, MakeIds<ArrayType>(ids)))
  {
    return nullptr;
  }
  auto copy = CopyOf(mesh);
  copy->SetPolys(cells);
  return copy;
}

TEST(MeshValidation, MalformedOffsets)
{
  struct Case
  {
    std::vector<int> Offsets;
    Ids NotTriangles;
    Ids BadConnectivity;
  };
  const std::vector<Case> cases{ { { 0, 3, 6, 9, 99 }, {}, { 3 } },
    { { 0, 3, 6, 9, 13 }, {}, { 3 } }, { { 0, 3, 6, -9, 12 }, {}, { 2, 3 } },
    { { -3, 0, 3, 6, 9 }, {}, { 0 } }, { { 0, 6, 3, 9, 12 }, { 0, 2 }, { 1 } },
    { { 2147483645, 2147483647, 3, 6, 9 }, {}, { 0, 1 } },
    { { 0, 0, 0, 0, 0 }, { 0, 1, 2, 3 }, {} } };
  const std::vector<int> connectivity{ 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4 };
  for (const Case& one : cases)
  {
    SCOPED_TRACE(::testing::PrintToString(one.Offsets));
    for (const bool wide : { true, false })
    {
      vtkNew<vtkCellArray> polygons;
      polygons->SetData(MakeIds<vtkTypeInt64Array>(one.Offsets).Get(),
        MakeIds<vtkTypeInt64Array>(connectivity).Get());
      if (!wide)
      {
        polygons->ConvertTo32BitStorage();
      }
      const auto mesh = MakeMesh(GridPoints(2, 0, 0.0), {});
      mesh->SetPolys(polygons);
      std::vector<Defect> expected{ { Kind::NotTriangles, Where::Triangulation, one.NotTriangles },
        { Kind::BadConnectivity, Where::Triangulation, one.BadConnectivity } };
      expected.erase(std::remove_if(expected.begin(), expected.end(),
                       [](const Defect& defect) { return defect.Cells.empty(); }),
        expected.end());
      const Reading reading = Read(mesh);
      EXPECT_FALSE(reading.Map);
      EXPECT_EQ(reading.Defects(), expected);
    }
  }
}

TEST(MeshValidation, EveryStorageOfCellsIsRead)
{
  const MeshPair pair = MakePlanarPair(4, 18);
  MeshPair narrow = WithTriangles(pair, GridTriangles(4));
  narrow.Source->GetPolys()->ConvertTo32BitStorage();
  narrow.Target->GetPolys()->ConvertTo64BitStorage();
  ASSERT_FALSE(narrow.Source->GetPolys()->IsStorage64Bit());
  ExpectSameMap(pair, narrow, 0.0);
  ExpectSameMap(pair,
    { WithCellsOfThree<vtkTypeInt64Array>(pair.Source),
      WithCellsOfThree<vtkTypeInt32Array>(pair.Target) },
    0.0);
  // Only newer versions of VTK take other integers.
  if (const auto short16 = WithCellsOfThree<vtkUnsignedShortArray>(pair.Target))
  {
    ExpectSameMap(pair, { WithCellsOfThree<vtkIdTypeArray>(pair.Source), short16 }, 0.0);
  }
}

// --- Defects of single triangles -----------------------------------------------------------------

TEST(MeshValidation, RepeatedCorner)
{
  for (int corner = 0; corner < 3; ++corner)
  {
    std::vector<Triangle> triangles = GridTriangles(4);
    triangles[9][corner] = triangles[9][(corner + 1) % 3];
    triangles[10] = { 7, 7, 7 };
    const MeshPair pair = WithTriangles(MakePlanarPair(4, 19), triangles);
    const std::vector<Defect> defects{ { Kind::RepeatedCorner, Where::Source, { 9, 10 } } };
    ExpectRefused(Read(pair), defects);
    ExpectRefused(Read(pair.Target), { { Kind::RepeatedCorner, Where::Triangulation, { 9, 10 } } });
    ExpectMasked(pair, defects);
  }
}

TEST(MeshValidation, NotFinite)
{
  for (const double bad : { NotANumber, Infinity, -Infinity })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      // Point 0 has two triangles, point 1 three, point 24 two.
      const auto spoil = [&](vtkPolyData* mesh) {
        for (const vtkIdType id : { 0, 1, 24 })
        {
          Point p = PointOf(mesh, id);
          p[axis] = bad;
          MovePoint(mesh, id, p);
        }
      };
      for (const MeshPair& pair :
        { MakePlanarPair(4, 20), MeshPair{ MakeSheet(4, 21, 0.3), MakeSheet(4, 22, 0.4) } })
      {
        ExpectFoundInEachMesh(pair, spoil, Kind::NotFinite, { 0, 1, 2, 3, 30, 31 });
      }
    }
  }
  const auto nowhere =
    MakeMesh(std::vector<Point>(4, { NotANumber, Infinity, 0.0 }), GridTriangles(1));
  ExpectRefused(Read(nowhere), { { Kind::NotFinite, Where::Triangulation, { 0, 1 } } });
}

TEST(MeshValidation, UnusedPointsMayBeAnywhere)
{
  const MeshPair pair = MakePlanarPair(4, 23);
  const auto with = [](vtkPolyData* mesh, const Point& p) {
    const auto copy = CopyOf(mesh);
    copy->GetPoints()->InsertNextPoint(p.data());
    return copy;
  };
  const auto target = with(pair.Target, { 2.0, 2.0, 0.0 });
  for (const Point& odd : { Point{ NotANumber, 1.0, 0.0 }, Point{ 1.0, Infinity, 0.0 },
         Point{ 1.0, 1.0, NotANumber }, Point{ 0.3, 0.4, 5.0 }, Point{ 1e300, -1e300, 0.0 } })
  {
    const auto source = with(pair.Source, odd);
    ExpectSameMap(pair, { source, target }, 0.0);
    ExpectSameMap({ pair.Target, pair.Source }, { target, source }, 0.0);
  }
}

TEST(MeshValidation, DegenerateTrianglesInThePlane)
{
  const MeshPair pair = MakePlanarPair(4, 24, 0.0);
  // Exactly collinear, with a middle point that is not the midpoint.
  ExpectFoundInEachMesh(pair,
    [](vtkPolyData* mesh) {
      MovePoint(mesh, 23, { 2.5, 4.0, 0.0 });
      MovePoint(mesh, 24, { 2.875, 3.25, 0.0 });
    },
    Kind::DegenerateTriangle, { 31 });
  // Two points coincide.
  ExpectFoundInEachMesh(pair,
    [](vtkPolyData* mesh) {
      MovePoint(mesh, 0, { 1.0, 1.0, 0.0 });
    },
    Kind::DegenerateTriangle, { 0, 1 });
}

TEST(MeshValidation, DegenerateTrianglesInSpace)
{
  const MeshPair pair{ MakeSheet(4, 25, 0.3), MakeSheet(4, 26, 0.4) };
  // Collinear up to the rounding of the coordinates.
  ExpectFoundInEachMesh(pair,
    [](vtkPolyData* mesh) {
      MovePoint(mesh, 24, PointIn(mesh, { 23, 18, 24 }, { 0.7, 0.3, 0.0 }));
    },
    Kind::DegenerateTriangle, { 31 });
  // Exactly collinear in float, as midpoints of short numbers are.
  ExpectFoundInEachMesh(pair,
    [](vtkPolyData* mesh) {
      mesh->SetPoints(MakeCloud(PointsOf(mesh), VTK_FLOAT)->GetPoints());
      MovePoint(mesh, 18, { 3.0, 3.0, 0.25 });
      MovePoint(mesh, 23, { 3.0, 4.0, 0.75 });
      MovePoint(mesh, 24, { 3.0, 3.5, 0.5 });
    },
    Kind::DegenerateTriangle, { 31 });
  for (const std::vector<Point>& points :
    { std::vector<Point>{ { 0, 0, 0 }, { 1, 2, 3 }, { 2, 4, 6 } },
      std::vector<Point>(3, { 1, 2, 3 }), std::vector<Point>(3, { 0, 0, 0 }) })
  {
    ExpectRefused(Read(MakeMesh(points, { { 0, 1, 2 } })),
      { { Kind::DegenerateTriangle, Where::Triangulation, { 0 } } });
  }
}

TEST(MeshValidation, DefectsOfBothMeshesAreReportedWithTheirPositions)
{
  const MeshPair pair = MakePlanarPair(4, 27, 0.0);
  MovePoint(pair.Source, 0, { 1.0, 1.0, 0.0 });
  MovePoint(pair.Target, 24, { 3.0, 3.0, 0.0 });
  ExpectMasked(pair,
    { { Kind::DegenerateTriangle, Where::Source, { 0, 1 } },
      { Kind::DegenerateTriangle, Where::Target, { 30, 31 } } });
  // Cell ids count vertices and lines, which may differ.
  AddVerticesAndLines(pair.Source, 3, 2);
  AddVerticesAndLines(pair.Target, 1, 0);
  const Reading reading = Read(pair);
  ExpectRefused(reading,
    { { Kind::DegenerateTriangle, Where::Source, { 5, 6 } },
      { Kind::DegenerateTriangle, Where::Target, { 31, 32 } } });
  // The first corner of the first triangle.
  EXPECT_EQ(reading.Diagnostics[0].Position, (Point{ 1.0, 1.0, 0.0 }));
  EXPECT_EQ(reading.Diagnostics[1].Position, PointOf(pair.Target, GridTriangles(4)[30][0]));
}

// --- Non-manifold and non-orientable surfaces ----------------------------------------------------

TEST(MeshValidation, NonManifoldEdges)
{
  // A fin on the edge of triangles 0 and 1, and a second one on the edge of the last two.
  std::vector<Triangle> triangles = GridTriangles(3);
  triangles.push_back({ 0, 5, 16 });
  triangles.push_back({ 10, 15, 16 });
  const MeshPair pair{ MakeSheet(3, 29, 0.3), MakeSheet(3, 30, 0.4) };
  for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
  {
    mesh->GetPoints()->InsertNextPoint(0.5, 0.5, 2.0);
    SetTriangles(mesh, triangles);
  }
  const Ids cells{ 0, 1, 16, 17, 18, 19 };
  ExpectRefused(Read(pair), { { Kind::NonManifoldEdge, Where::Source, cells } });
  ExpectRefused(Read(pair.Target), { { Kind::NonManifoldEdge, Where::Triangulation, cells } });
  ExpectMasked(pair, { { Kind::NonManifoldEdge, Where::Source, cells } });
}

TEST(MeshValidation, NonOrientable)
{
  // Five points, five triangles: the smallest Moebius strip. Without the last one it can be
  // oriented.
  const auto strip = MakeMesh(
    { { 1, 0, 0.1 }, { 0.3, 1, -0.2 }, { -0.8, 0.6, 0.3 }, { -0.8, -0.6, -0.1 }, { 0.3, -1, 0.4 } },
    { { 0, 1, 2 }, { 1, 3, 2 }, { 2, 3, 4 }, { 3, 0, 4 }, { 4, 0, 1 } });
  // The two triangles at one edge.
  const Reading reading = Read(strip, strip);
  ASSERT_EQ(reading.Diagnostics.size(), 1u);
  EXPECT_EQ(reading.Diagnostics[0].Ids.size(), 2u);
  ExpectRefused(reading, { { Kind::NonOrientable, Where::Source, reading.Diagnostics[0].Ids } },
    Remedy::CutOpen);
  // Masking is no remedy.
  EXPECT_FALSE(ReadMasked({ strip, strip }).Map);
  std::vector<Triangle> open = TrianglesOf(strip);
  open.pop_back();
  const auto opened = WithTriangles(strip, open);
  ExpectAccepted(Read(opened, opened));
}

// --- Orientation ---------------------------------------------------------------------------------

TEST(MeshValidation, FlippedTriangles)
{
  // Cells 30 and 31 share point 24. Moving it across the edge from 18 to 23 flips only cell 31.
  const MeshPair pair = MakePlanarPair(4, 31, 0.0);
  MovePoint(pair.Target, 24, { 2.9, 3.5, 0.0 });
  const auto mirrored = Mirrored(pair.Target);
  for (const MeshPair& one : { pair, MeshPair{ pair.Target, pair.Source },
         MeshPair{ pair.Source, mirrored }, MeshPair{ mirrored, pair.Source } })
  {
    ExpectRefused(Read(one), { { Kind::Flipped, Where::Pair, { 31 } } }, Remedy::MovePointsOrMask);
  }
  // Its neighbor across the edge to the moved point, cell 30, then lies on cell 28.
  ExpectMasked(pair,
    { { Kind::Flipped, Where::Pair, { 31 } }, { Kind::Overlapping, Where::Target, { 28, 30 } } });
  // An interior vertex is moved far across the grid.
  MovePoint(pair.Target, 24, { 4.0, 4.0, 0.0 });
  MovePoint(pair.Target, 6, { 3.6, 3.7, 0.0 });
  ExpectRefused(
    Read(pair), { { Kind::Flipped, Where::Pair, { 10, 11 } } }, Remedy::MovePointsOrMask);
}

// --- Overlaps, see also TestBoundarySweep --------------------------------------------------------

TEST(MeshValidation, Overlaps)
{
  // The triangle at the corner is folded over its neighbor in both meshes, so that no triangle is
  // flipped between them.
  const MeshPair folded = MakePlanarPair(4, 38, 0.0);
  MovePoint(folded.Source, 24, { 2.9, 3.5, 0.0 });
  MovePoint(folded.Target, 24, { 2.9, 3.5, 0.0 });
  ExpectRefused(Read(folded),
    { { Kind::Overlapping, Where::Source, { 28, 30, 31 } },
      { Kind::Overlapping, Where::Target, { 28, 30, 31 } } });

  // Two single triangles that touch, and that overlap.
  const auto apart =
    MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } },
      { { 0, 1, 2 }, { 3, 4, 5 } });
  ExpectAccepted(Read(apart, apart));
  ExpectFoundInEachMesh({ apart, apart },
    [](vtkPolyData* mesh) {
      MovePoint(mesh, 3, { 0.75, 0, 0 });
    },
    Kind::Overlapping, { 0, 1 });

  const auto twice =
    MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 }, { 2, 0, 1 } });
  ExpectRefused(Read(twice), { { Kind::Overlapping, Where::Triangulation, { 0, 1 } } });
}

TEST(MeshValidation, SurfacesMayPassThroughThemselves)
{
  // In space only single triangles are checked.
  const auto mesh = MakeMesh(
    { { -1, -1, 0 }, { 1, -1, 0 }, { 0, 1, 0 }, { 0, 0, -1 }, { 0, 0.5, 1 }, { 0, -0.5, 1 } },
    { { 0, 1, 2 }, { 3, 4, 5 } });
  ExpectAccepted(Read(mesh, mesh));
}

// --- Requirements of the coordinate systems ------------------------------------------------------

TEST(MeshValidation, DiscordantTriangles)
{
  // The corner of the target is so close to its neighbor on the diagonal that cells 0 and 1 have an
  // obtuse angle beside a short edge.
  const MeshPair pair = MakePlanarPair(4, 39, 0.05);
  MovePoint(pair.Source, 6, { 1.0, 1.0, 0.0 });
  MovePoint(pair.Target, 6, { 1.0, 1.0, 0.0 });
  MovePoint(pair.Target, 0, { 0.8, 0.8, 0.0 });
  homeomorphism::HomeomorphismOptions options;
  options.System = homeomorphism::CoordinateSystem::Contour;
  const std::vector<Defect> inTarget{ { Kind::Discordant, Where::Target, { 0, 1 } } };
  ExpectRefused(Read(pair, options), inTarget, Remedy::UseOtherSystem);
  ExpectRefused(Read(pair.Target, pair.Source, options),
    { { Kind::Discordant, Where::Source, { 0, 1 } } }, Remedy::UseOtherSystem);
  ExpectRefused(Read(pair.Target, nullptr, options),
    { { Kind::Discordant, Where::Triangulation, { 0, 1 } } }, Remedy::UseOtherSystem);

  options.DiscordantByLinear = true;
  const Reading byLinear = Read(pair, options);
  EXPECT_TRUE(byLinear.Map);
  EXPECT_EQ(byLinear.Defects(), inTarget);
  EXPECT_EQ(byLinear.Diagnostics[0].Result, Outcome::MappedByLinear);

  options.Center = homeomorphism::CenterPoint::Incenter;
  ExpectAccepted(Read(pair, options));
  options.System = homeomorphism::CoordinateSystem::Smooth;
  ExpectAccepted(Read(pair, options));
}

TEST(MeshValidation, NearlyPlanarMeshesAreNamed)
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 0, 2, 3 } };
  const auto flat = MakeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1.5, 0 } }, triangles);
  const std::vector<Point> probes{ { 0.3, 0.2, 0 }, { 0.6, 0.9, 0 } };
  for (const double noise : { 1e-9, 1e-12, 1e-7 })
  {
    const auto noisy =
      MakeMesh({ { 0, 0, noise }, { 1, 0, -noise }, { 1, 1, noise }, { 0, 1, 0 } }, triangles);
    const Reading reading = Read(noisy, flat);
    EXPECT_TRUE(reading.Map);
    ASSERT_EQ(
      reading.Defects(), (std::vector<Defect>{ { Kind::NearlyPlanar, Where::Source, {} } }));
    const MeshDiagnostic& found = reading.Diagnostics[0];
    EXPECT_EQ(found.Result, Outcome::Accepted);
    EXPECT_NEAR(found.Size, 2.0 * noise, 1e-15);
    EXPECT_LT(found.Tolerance, 100.0 * noise);
    // The tolerance that is named finds the points of the plane.
    const MapOptions tolerant{ Smooth, false, false, found.Tolerance };
    EXPECT_EQ(MapPoints({ noisy, flat }, probes).Triangles, (Ids{ -1, -1 }));
    EXPECT_EQ(MapPoints({ noisy, flat }, probes, tolerant).Triangles, (Ids{ 0, 1 }));
  }
  ExpectAccepted(Read(flat, flat));
  const auto bent = MakeMesh({ { 0, 0, 0 }, { 1, 0, 1e-3 }, { 1, 1, 0 }, { 0, 1, 0 } }, triangles);
  ExpectAccepted(Read(bent, bent));
}

// --- Blanked cells -------------------------------------------------------------------------------

/// Exactly these triangles are masked.
void ExpectHoles(const MeshPair& pair, const Ids& holes)
{
  const Reading reading = Read(pair);
  ExpectAccepted(reading);
  EXPECT_EQ(reading.Masked(), holes);
}

TEST(MeshValidation, HiddenCellsAndPointsAreHoles)
{
  using Attributes = vtkDataSetAttributes;
  // The array covers all cells; vertices and lines, which come first, may differ.
  for (const auto& cells : std::vector<std::array<int, 4>>{
         { 0, 0, 0, 0 }, { 3, 2, 3, 2 }, { 0, 0, 4, 1 }, { 4, 3, 0, 0 }, { 0, 2, 0, 0 } })
  {
    for (const bool inSource : { true, false })
    {
      const MeshPair pair = MakePlanarPair(4, 45);
      AddVerticesAndLines(pair.Source, cells[0], cells[1]);
      AddVerticesAndLines(pair.Target, cells[2], cells[3]);
      vtkPolyData* mesh = inSource ? pair.Source : pair.Target;
      const vtkIdType first = mesh->GetNumberOfCells() - 32;
      mesh->GetCellData()->AddArray(
        MakeGhosts(32 + first, { first + 3, first + 17, first + 31 }, Attributes::HIDDENCELL));
      ExpectHoles(pair, { 3, 17, 31 });
      mesh->GetCellData()->AddArray(
        MakeGhosts(32 + first, { first + 3 }, Attributes::DUPLICATECELL));
      ExpectHoles(pair, {});
      mesh->GetPointData()->AddArray(MakeGhosts(25, { 0, 24 }, Attributes::HIDDENPOINT));
      ExpectHoles(pair, { 0, 1, 30, 31 });
      mesh->GetPointData()->AddArray(MakeGhosts(25, { 3 }, Attributes::DUPLICATEPOINT));
      ExpectHoles(pair, {});
      // Arrays of another length hide nothing.
      mesh->GetCellData()->AddArray(MakeGhosts(2, { 1 }, Attributes::HIDDENCELL));
      mesh->GetPointData()->AddArray(MakeGhosts(3, { 1 }, Attributes::HIDDENPOINT));
      ExpectHoles(pair, {});
    }
  }
}

TEST(MeshValidation, HiddenDefectsAreIgnored)
{
  const MeshPair pair = MakePlanarPair(4, 48, 0.0);
  MovePoint(pair.Source, 0, { NotANumber, 0.0, 7.0 });
  MovePoint(pair.Target, 24, { 3.0, 3.0, -1e5 });
  pair.Source->GetCellData()->AddArray(MakeGhosts(32, { 0, 1 }, vtkDataSetAttributes::HIDDENCELL));
  pair.Target->GetPointData()->AddArray(MakeGhosts(25, { 24 }, vtkDataSetAttributes::HIDDENPOINT));
  ExpectHoles(pair, { 0, 1, 30, 31 });
  // Nor do they make a plane a surface.
  EXPECT_TRUE(Read(pair).Map->GetPair().GetGeometry(homeomorphism::Domain::Target).IsColumnar());
}

} // namespace
