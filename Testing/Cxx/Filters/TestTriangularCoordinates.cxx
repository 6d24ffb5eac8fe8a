// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkTriangularCoordinates: the coordinates, their lines, and the properties of the triangles.

#include "Fixtures/FilterRuns.h"

namespace
{

using namespace fixtures;

vtkPolyData* Described(vtkTriangularCoordinates* filter)
{
  filter->Update();
  return filter->GetTriangulation();
}

/// The coordinates of a point in the output.
struct Coordinates
{
  Coordinates(vtkDataSet* data, vtkIdType i)
    : T(static_cast<vtkIdType>(PointValue(data, "TriangleId", i)))
    , E(static_cast<int>(PointValue(data, "EdgeLabel", i)))
    , P(PointValue(data, "EdgeParameter", i))
    , C(PointValue(data, "ContourParameter", i))
  {
  }
  vtkIdType T;
  int E;
  double P;
  double C;
};

/// The center of a triangle in a system: the start of its contours.
Point CenterOf(const System& system, vtkPolyData* mesh, vtkIdType triangle)
{
  const std::array<Point, 3> c = CornersOf(mesh, triangle);
  Point weights{ 1.0, 1.0, 1.0 };
  if (system.CenterPoint == vtkDifferentiableHomeomorphism::INCENTER)
  {
    weights = { Distance(c[1], c[2]), Distance(c[2], c[0]), Distance(c[0], c[1]) };
  }
  return (1.0 / (weights[0] + weights[1] + weights[2])) *
    (weights[0] * c[0] + weights[1] * c[1] + weights[2] * c[2]);
}

using CoordinatesInEverySystem = TestInEverySystem;

INSTANTIATE_TEST_SUITE_P(
  All, CoordinatesInEverySystem, ::testing::ValuesIn(AllSystems()), NameOfSystem);

TEST_P(CoordinatesInEverySystem, ArraysHaveTheirTypesAndRanges)
{
  for (const auto& [kind, pair] : AllPairings(8, 2, 700))
  {
    const auto filter = MakeCoordinates(
      GetParam(), pair.Target, MakeCloud(pair.Target, RandomSamples(pair.Target, 5000, 60)));
    EXPECT_EQ(Output(filter)->GetPointData()->GetNumberOfArrays(), 5);
    const auto triangles = static_cast<double>(pair.Target->GetNumberOfCells());
    for (const auto& [name, type, least, greatest] :
      std::vector<std::tuple<const char*, int, double, double>>{
        { "TriangleId", VTK_ID_TYPE, 0.0, triangles - 1.0 }, { "EdgeLabel", VTK_INT, 1.0, 3.0 },
        { "EdgeParameter", VTK_DOUBLE, 0.0, 1.0 }, { "ContourParameter", VTK_DOUBLE, 0.0, 1.0 },
        { "vtkValidPointMask", VTK_UNSIGNED_CHAR, 1.0, 1.0 } })
    {
      SCOPED_TRACE(std::string(kind) + name);
      vtkDataArray* array = PointArray(Output(filter), name);
      EXPECT_EQ(array->GetDataType(), type);
      for (const double value : ValuesOf(array))
      {
        ASSERT_TRUE(value >= least && value <= greatest) << value;
      }
    }
  }
}

/// In the Linear system, from the barycentric coordinates of the point.
void ExpectLinearCoordinates(const Coordinates& found, const Point& l)
{
  // The edge opposite the corner with the least weight.
  const auto least = static_cast<std::size_t>(std::min_element(l.begin(), l.end()) - l.begin());
  const double next = l[(least + 1) % 3] - l[least];
  const double previous = l[(least + 2) % 3] - l[least];
  if (std::min(next, previous) > 1e-9)
  {
    ASSERT_EQ(found.E, static_cast<int>(least) + 1);
    ASSERT_NEAR(found.C, 1.0 - 3.0 * l[least], 1e-13);
    ASSERT_NEAR(found.P, previous / (next + previous), 1e-13 / (1.0 - 3.0 * l[least]));
  }
}

TEST_P(CoordinatesInEverySystem, CorrespondingPointsHaveEqualCoordinates)
{
  // By definition of the homeomorphism. In the Contour system discordant triangles of P alone or of
  // Q alone would be mapped by Linear.
  const MeshPair planar = MakePlanarPair(10, 730, 0.06);
  std::vector<Pairing> pairings{ { "planar", planar },
    { "tilted", { planar.Source, Tilted(planar.Target, Tilt(), { 1.0, 0.0, 2.0 }) } } };
  if (!GetParam().IsChoosy())
  {
    pairings = AllPairings(8, 2, 731);
  }
  for (const auto& [kind, pair] : pairings)
  {
    SCOPED_TRACE(kind);
    const std::vector<MeshPoint> samples = InnerSamples(pair.Source, 5000, 63, 1e-3);
    const auto cloud = MakeCloud(pair.Source, samples);
    const auto onSource = MakeCoordinates(GetParam(), pair.Source, cloud);
    const auto map = MakeFilter(GetParam(), pair, cloud);
    const auto onTarget = MakeCoordinates(GetParam(), pair.Target);
    onTarget->SetDataConnection(map->GetOutputPort());
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      const Coordinates before(Output(onSource), static_cast<vtkIdType>(i));
      const Coordinates after(Output(onTarget), static_cast<vtkIdType>(i));
      ASSERT_EQ(before.T, samples[i].Triangle);
      ASSERT_EQ(after.T, samples[i].Triangle);
      ASSERT_NEAR(before.C, after.C, 1e-12);
      if (GetParam().CoordinateSystem == Linear.CoordinateSystem)
      {
        ExpectLinearCoordinates(before, samples[i].Weights);
      }
      if (before.E != after.E)
      {
        // Only on a spoke, whose contours belong to two edges.
        ASSERT_LE(std::min(before.P, 1.0 - before.P) * before.C, 1e-12);
        continue;
      }
      // The accuracy of p grows with the distance from the center and decreases with the curvature
      // of contours towards a vertex.
      ASSERT_NEAR(before.P, after.P, 1e-11 / before.C);
    }
  }
}

TEST_P(CoordinatesInEverySystem, OutsideAndNonFinitePointsAreMarked)
{
  const auto mesh = MakePlanarPair(6, 740).Source;
  const auto filter = MakeCoordinates(GetParam(), mesh,
    MakeCloud({ { 1.5, 2.5, 0.0 }, { -0.01, 2.0, 0.0 }, { 7.0, 7.0, 7.0 }, { NotANumber, 1.0, 0.0 },
      { 1.5, 2.5, 1e9 } }));
  vtkDataSet* output = Output(filter);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 3);
  for (const vtkIdType i : { 1, 2, 3 })
  {
    const Coordinates found(output, i);
    EXPECT_TRUE(found.T == -1 && found.E == 0 && std::isnan(found.P) && std::isnan(found.C));
    EXPECT_FALSE(IsValid(output, i));
  }
  // The distance from the plane is ignored.
  const Coordinates on(output, 0);
  const Coordinates above(output, 4);
  EXPECT_TRUE(on.T == above.T && on.E == above.E && on.P == above.P && on.C == above.C);
  filter->SetTolerance(0.01);
  EXPECT_GE(Coordinates(Output(filter), 1).C, 1.0 - 1e-13);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 2);
}

TEST(TriangularCoordinates, WithoutDataTheTriangulationIsTheData)
{
  const auto mesh = MakeClosedPair(2, 755).Target;
  mesh->GetCellData()->AddArray(RandomArray("Own", 1, mesh->GetNumberOfCells(), 68));
  const auto filter = MakeCoordinates(Smooth, mesh);
  vtkDataSet* output = Output(filter);
  EXPECT_EQ(CountDifferentPoints(output, mesh), 0);
  EXPECT_TRUE(PointArray(output, "EdgeLabel"));
  for (const char* name : { "Own", "Concordant", "ConcordanceMargin", "UsedCoordinateSystem",
         "SmallestAngle", "StripWidth", "DeterminantBound" })
  {
    EXPECT_TRUE(CellArray(output, name)) << name;
    EXPECT_TRUE(CellArray(Described(filter), name)) << name;
  }
  EXPECT_FALSE(PointArray(filter->GetTriangulation(), "EdgeLabel"));
  EXPECT_FALSE(CellArray(mesh, "Concordant"));
  // If there is data, the arrays of the triangulation are on output 2 only.
  filter->SetDataObject(MakeCloud(mesh, RandomSamples(mesh, 10, 69)));
  EXPECT_FALSE(CellArray(Output(filter), "Concordant"));
}

/// Points and arrays of one line.
struct Line
{
  int Type;
  vtkIdType Triangle;
  int Edge;
  double P;
  double C;
  std::vector<Point> Points;
};

std::vector<Line> ReadLines(vtkTriangularCoordinates* filter)
{
  filter->GenerateLinesOn();
  filter->Update();
  vtkPolyData* lines = filter->GetLines();
  EXPECT_EQ(lines->GetCellData()->GetScalars(), CellArray(lines, "LineType"));
  EXPECT_EQ(lines->GetNumberOfCells(), lines->GetNumberOfLines());
  std::vector<Line> result;
  for (vtkIdType i = 0; i < lines->GetNumberOfCells(); ++i)
  {
    Line line{ static_cast<int>(CellValue(lines, "LineType", i)),
      static_cast<vtkIdType>(CellValue(lines, "TriangleId", i)),
      static_cast<int>(CellValue(lines, "EdgeLabel", i)), CellValue(lines, "EdgeParameter", i),
      CellValue(lines, "ContourParameter", i), {} };
    for (const vtkIdType id : IdsOf(lines, i))
    {
      line.Points.push_back(PointOf(lines, id));
    }
    result.push_back(line);
  }
  return result;
}

constexpr int CenterSegment = vtkTriangularCoordinates::CENTER_SEGMENT;
constexpr int WingSegment = vtkTriangularCoordinates::WING_SEGMENT;
constexpr int ContourLine = vtkTriangularCoordinates::CONTOUR_LINE;
constexpr int RingLine = vtkTriangularCoordinates::RING_LINE;

void ExpectLines(
  const System& system, vtkPolyData* mesh, int contours, int rings, bool isConcordant)
{
  constexpr int resolution = 12;
  const auto filter = MakeCoordinates(system, mesh);
  filter->SetNumberOfContours(contours);
  filter->SetNumberOfRings(rings);
  filter->SetLineResolution(resolution);
  const std::vector<Line> lines = ReadLines(filter);
  const double size = mesh->GetLength();
  std::map<std::pair<vtkIdType, int>, int> counts;
  std::set<std::pair<double, int>> contoursSeen;
  // All points of the lines are input to the filter again.
  const auto check = MakeCoordinates(system, mesh, MakeCloud(PointsOf(filter->GetLines())));
  vtkDataSet* output = Output(check);
  EXPECT_EQ(check->GetNumberOfOutsidePoints(), 0);
  vtkIdType first = 0;
  for (const Line& line : lines)
  {
    const auto last = static_cast<vtkIdType>(line.Points.size()) - 1;
    const bool isRing = line.Type == RingLine;
    const bool isContour = line.Type == ContourLine;
    ++counts[{ line.Triangle, line.Type }];
    EXPECT_EQ(line.Edge == 0, isRing);
    EXPECT_EQ(std::isnan(line.P), !isContour);
    EXPECT_EQ(std::isnan(line.C), !isRing);
    // The closed line of a ring passes all three edges in order, with p from 0 to 1 on each. A
    // contour runs from the center to the edge at p.
    for (vtkIdType k = 1; k < last && (isRing || isContour); ++k)
    {
      const Coordinates found(output, first + k);
      const double c = isRing ? line.C : static_cast<double>(k) / resolution;
      const double p = isRing ? static_cast<double>(k % resolution) / resolution : line.P;
      ASSERT_EQ(found.T, line.Triangle);
      ASSERT_NEAR(found.C, c, 1e-12);
      // On a spoke contours belong to two edges.
      if (p > 0.0)
      {
        ASSERT_EQ(found.E, isRing ? k / resolution + 1 : line.Edge);
        ASSERT_NEAR(found.P, p, 1e-11 / c);
      }
    }
    const Point& start = line.Points.front();
    if (isRing)
    {
      EXPECT_EQ(last, 3 * resolution);
      EXPECT_NEAR(line.C * rings, std::round(line.C * rings), 1e-12);
      ASSERT_LE(Distance(start, line.Points.back()), 1e-14 * size);
    }
    else if (isContour)
    {
      contoursSeen.insert({ line.P, line.Edge });
      const std::array<Point, 3> c = CornersOf(mesh, line.Triangle);
      const Point end = (1.0 - line.P) * c[line.Edge % 3] + line.P * c[(line.Edge + 1) % 3];
      EXPECT_EQ(last, resolution);
      ASSERT_LE(Distance(start, CenterOf(system, mesh, line.Triangle)), 1e-14 * size);
      ASSERT_LE(Distance(line.Points.back(), end), 2e-14 * size);
    }
    first += last + 1;
  }
  EXPECT_EQ(first, output->GetNumberOfPoints());
  EXPECT_EQ(contoursSeen.size(), static_cast<std::size_t>(3 * contours));
  for (vtkIdType t = 1; t < mesh->GetNumberOfCells() && isConcordant; ++t)
  {
    EXPECT_EQ((counts[{ t, CenterSegment }]), 3);
    EXPECT_EQ((counts[{ t, WingSegment }]), 6);
    EXPECT_EQ((counts[{ t, ContourLine }]), 3 * contours);
    EXPECT_EQ((counts[{ t, RingLine }]), rings - 1);
  }
  filter->GenerateLinesOff();
  filter->Update();
  EXPECT_EQ(filter->GetLines()->GetNumberOfCells() + filter->GetLines()->GetNumberOfPoints(), 0);
}

TEST_P(CoordinatesInEverySystem, LinesExistAndHaveTheirCoordinates)
{
  const auto concordant = MakePlanarPair(4, 770, 0.05).Source;
  AddVerticesAndLines(concordant, 1, 0); // shifts the cell ids by one
  ExpectLines(GetParam(), concordant, 1, 1, true);
  ExpectLines(GetParam(), concordant, 7, 5, true);
  for (const auto& [kind, pair] : AllPairings(8, 2, 780))
  {
    SCOPED_TRACE(kind);
    ExpectLines(GetParam(), pair.Target, 5, 4, false);
  }
}

TEST(TriangularCoordinates, SegmentsAreThePublishedConstruction)
{
  // Center segments are perpendicular to the edges, wing segments join the vertices to their
  // midpoints.
  for (const System& system : { Contour, Incenter })
  {
    for (const auto& [kind, pair] : AllPairings(8, 2, 790))
    {
      vtkPolyData* mesh = pair.Target;
      const auto filter = MakeCoordinates(system, mesh);
      const std::vector<Line> lines = ReadLines(filter);
      std::map<std::pair<vtkIdType, int>, Point> feet;
      for (const Line& line : lines)
      {
        if (CellValue(Described(filter), "UsedCoordinateSystem", line.Triangle) !=
            vtkTriangularCoordinates::CONTOUR ||
          (line.Type != CenterSegment && line.Type != WingSegment))
        {
          continue;
        }
        const std::vector<Point>& p = line.Points;
        const std::array<Point, 3> c = CornersOf(mesh, line.Triangle);
        const Point center = CenterOf(system, mesh, line.Triangle);
        const Point start = c[line.Edge % 3];
        const Point end = c[(line.Edge + 1) % 3];
        const Point along = Unit(end - start);
        const double rounding =
          4e-14 * std::max({ Distance(c[0], c[1]), Distance(c[1], c[2]), Distance(c[2], c[0]) });
        if (line.Type == CenterSegment)
        {
          const Point foot = p.back();
          feet[{ line.Triangle, line.Edge }] = foot;
          ASSERT_LE(Distance(p.front(), center), rounding);
          ASSERT_LE(std::abs(Dot(foot - center, along)), rounding);
          ASSERT_LE(Norm(Cross(foot - start, along)), rounding);
          EXPECT_GT(Dot(foot - start, along), 0.0);
          EXPECT_LT(Dot(foot - end, along), 0.0);
        }
        else
        {
          // Its center segment precedes it.
          const Point middle = 0.5 * (center + feet.at({ line.Triangle, line.Edge }));
          ASSERT_LE(std::min(Distance(p.front(), start), Distance(p.front(), end)), rounding);
          ASSERT_LE(Distance(p.back(), middle), rounding);
        }
      }
      EXPECT_GT(feet.size(), 100u) << system.Name << kind;
    }
  }
}

TEST(TriangularCoordinates, TrianglesAreDescribed)
{
  vtkIdType discordantInAll = 0;
  for (const auto& [kind, pair] : AllPairings(8, 2, 800))
  {
    SCOPED_TRACE(kind);
    vtkPolyData* mesh = pair.Target;
    const auto filter = MakeCoordinates(Contour, mesh);
    vtkPolyData* described = Described(filter);
    vtkDataArray* width = CellArray(described, "StripWidth");
    ASSERT_EQ(width->GetNumberOfComponents(), 3);
    vtkIdType discordant = 0;
    mesh->BuildLinks();
    for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
    {
      const std::array<Point, 3> c = CornersOf(mesh, t);
      const Triangle ids = TrianglesOf(mesh)[static_cast<std::size_t>(t)];
      // The least distance of a foot of the centroid from an end of its edge.
      const Point centroid = (1.0 / 3.0) * (c[0] + c[1] + c[2]);
      double least = 1.0;
      double smallest = 180.0;
      bool isBesideNone = true;
      for (int k = 0; k < 3; ++k)
      {
        const Point along = c[(k + 1) % 3] - c[k];
        const double foot = Dot(centroid - c[k], along) / Dot(along, along);
        least = std::min({ least, foot, 1.0 - foot });
        const double cosine = Dot(Unit(along), Unit(c[(k + 2) % 3] - c[k]));
        smallest = std::min(smallest, vtkMath::DegreesFromRadians(std::acos(cosine)));
        vtkNew<vtkIdList> neighbors;
        mesh->GetCellEdgeNeighbors(t, ids[(k + 1) % 3], ids[(k + 2) % 3], neighbors);
        const bool isBoundary = neighbors->GetNumberOfIds() == 0;
        isBesideNone = isBesideNone && isBoundary;
        ASSERT_EQ(width->GetComponent(t, k) == 0.0, isBoundary);
        ASSERT_TRUE(width->GetComponent(t, k) >= 0.0 && width->GetComponent(t, k) <= 1.0);
      }
      ASSERT_NEAR(CellValue(described, "ConcordanceMargin", t), least, 1e-13);
      ASSERT_NEAR(CellValue(described, "SmallestAngle", t), smallest, 1e-10);
      ASSERT_GT(std::abs(least), 1e-12);
      discordant += least < 0.0;
      ASSERT_EQ(CellValue(described, "Concordant", t), least > 0.0 ? 1.0 : 0.0);
      ASSERT_EQ(CellValue(described, "UsedCoordinateSystem", t),
        least > 0.0 ? vtkTriangularCoordinates::CONTOUR : vtkTriangularCoordinates::LINEAR);
      ASSERT_GT(CellValue(described, "DeterminantBound", t), 0.0);
      ASSERT_LE(CellValue(described, "DeterminantBound", t), isBesideNone ? 1.0 : 0.28);
    }
    EXPECT_EQ(filter->GetNumberOfDiscordantTriangles(), discordant);
    discordantInAll += discordant;
    // In the other systems every triangle has coordinates of that system.
    for (const System& system : { Linear, Smooth, Incenter })
    {
      const auto other = MakeCoordinates(system, mesh);
      vtkDataArray* used = CellArray(Described(other), "UsedCoordinateSystem");
      EXPECT_EQ(used->GetRange()[0], system.CoordinateSystem);
      EXPECT_EQ(used->GetRange()[1], system.CoordinateSystem);
      EXPECT_EQ(other->GetNumberOfDiscordantTriangles(), discordant);
    }
  }
  EXPECT_GT(discordantInAll, 20);
}

TEST(TriangularCoordinates, TrianglesMappedByLinearHaveItsCoordinates)
{
  const auto mesh = Sheared(MakePlanarPair(10, 810).Source);
  const auto cloud = MakeCloud(mesh, InnerSamples(mesh, 2000, 71, 1e-3));
  const auto contour = MakeCoordinates(Contour, mesh, cloud);
  const auto linear = MakeCoordinates(Linear, mesh, cloud);
  vtkIdType mapped = 0;
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    const Coordinates mixed(Output(contour), i);
    const Coordinates all(Output(linear), i);
    if (CellValue(Described(contour), "UsedCoordinateSystem", mixed.T) ==
      vtkTriangularCoordinates::LINEAR)
    {
      ++mapped;
      ASSERT_TRUE(mixed.E == all.E && mixed.P == all.P && mixed.C == all.C);
    }
  }
  EXPECT_GT(mapped, 10);
}

TEST(TriangularCoordinates, MaskedTrianglesAreDescribedAsNone)
{
  const auto mesh = MakePlanarPair(4, 15, 0.0).Source;
  MovePoint(mesh, 0, { 1.0, 1.0, 0.0 });
  const auto filter = MakeCoordinates(Smooth, mesh);
  filter->MaskInvalidTrianglesOn();
  for (vtkIdType t = 0; t < 32; ++t)
  {
    EXPECT_EQ(CellValue(Described(filter), "UsedCoordinateSystem", t),
      t < 2 ? -1.0 : double(vtkTriangularCoordinates::SMOOTH));
  }
  for (const Line& line : ReadLines(filter))
  {
    ASSERT_GE(line.Triangle, 2);
  }
}

} // namespace
