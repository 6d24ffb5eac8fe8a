// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// vtkTriangularCoordinates: the coordinates, their lines, and the properties of the triangles.

#include "Fixtures/FilterRuns.h"

#include "vtkTriangularCoordinates.h"

namespace
{

using namespace fixtures;

vtkSmartPointer<vtkTriangularCoordinates> MakeCoordinates(
  const System& system, vtkPolyData* triangulation, vtkDataObject* data = nullptr)
{
  auto filter = vtkSmartPointer<vtkTriangularCoordinates>::New();
  SetSystem(filter.Get(), system);
  filter->SetInputData(0, triangulation);
  if (data)
  {
    filter->SetDataObject(data);
  }
  filter->GenerateLinesOff();
  return filter;
}

vtkDataSet* Output(vtkTriangularCoordinates* filter)
{
  filter->Update();
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
}

vtkDataArray* CellArray(vtkTriangularCoordinates* filter, const char* name)
{
  filter->Update();
  return filter->GetTriangulation()->GetCellData()->GetArray(name);
}

/// The arrays that the filter adds, with access by point.
class Coordinates
{
public:
  explicit Coordinates(vtkDataSet* data)
    : Data(data)
  {
  }
  vtkIdType T(vtkIdType i) const { return static_cast<vtkIdType>(this->Get("TriangleId", i)); }
  int E(vtkIdType i) const { return static_cast<int>(this->Get("EdgeLabel", i)); }
  double P(vtkIdType i) const { return this->Get("EdgeParameter", i); }
  double C(vtkIdType i) const { return this->Get("ContourParameter", i); }
  bool IsValid(vtkIdType i) const { return this->Get("vtkValidPointMask", i) != 0.0; }

private:
  double Get(const char* name, vtkIdType i) const
  {
    return PointArray(this->Data, name)->GetComponent(i, 0);
  }
  vtkDataSet* Data;
};

/// Single meshes of every kind.
std::vector<std::pair<const char*, vtkSmartPointer<vtkPolyData>>> AllMeshes(std::uint64_t seed)
{
  std::vector<std::pair<const char*, vtkSmartPointer<vtkPolyData>>> meshes;
  for (const Pairing& pairing : AllPairings(8, 2, seed))
  {
    meshes.emplace_back(pairing.Name, pairing.Meshes.Target);
  }
  return meshes;
}

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

class CoordinatesInEverySystem : public ::testing::TestWithParam<System>
{
};

INSTANTIATE_TEST_SUITE_P(
  All, CoordinatesInEverySystem, ::testing::ValuesIn(AllSystems()), NameOfSystem);

// --- Output 0: the coordinates -------------------------------------------------------------------

TEST_P(CoordinatesInEverySystem, ArraysHaveTheirTypesAndRanges)
{
  for (const auto& [name, mesh] : AllMeshes(700))
  {
    const auto filter =
      MakeCoordinates(GetParam(), mesh, MakeCloud(mesh, RandomSamples(mesh, 5000, 60)));
    vtkDataSet* output = Output(filter);
    ASSERT_TRUE(vtkIdTypeArray::SafeDownCast(PointArray(output, "TriangleId")));
    ASSERT_TRUE(vtkIntArray::SafeDownCast(PointArray(output, "EdgeLabel")));
    ASSERT_TRUE(vtkDoubleArray::SafeDownCast(PointArray(output, "EdgeParameter")));
    ASSERT_TRUE(vtkDoubleArray::SafeDownCast(PointArray(output, "ContourParameter")));
    ASSERT_TRUE(vtkUnsignedCharArray::SafeDownCast(PointArray(output, "vtkValidPointMask")));
    EXPECT_EQ(output->GetPointData()->GetNumberOfArrays(), 5);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0) << name;
    const Coordinates found(output);
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      ASSERT_TRUE(found.T(i) >= 0 && found.T(i) < mesh->GetNumberOfCells());
      ASSERT_TRUE(found.E(i) >= 1 && found.E(i) <= 3);
      ASSERT_TRUE(found.P(i) >= 0.0 && found.P(i) <= 1.0);
      ASSERT_TRUE(found.C(i) >= 0.0 && found.C(i) <= 1.0);
      ASSERT_TRUE(found.IsValid(i));
    }
  }
}

TEST(TriangularCoordinates, LinearCoordinatesFollowTheirDefinition)
{
  for (const auto& [name, mesh] : AllMeshes(710))
  {
    const std::vector<MeshPoint> samples = InnerSamples(mesh, 5000, 61, 1e-4);
    const auto filter = MakeCoordinates(Linear, mesh, MakeCloud(mesh, samples));
    const Coordinates found(Output(filter));
    vtkIdType wrong = 0;
    Worst worst;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      const auto id = static_cast<vtkIdType>(i);
      const Point& l = samples[i].Weights;
      wrong += found.T(id) != samples[i].Triangle;
      // The edge opposite the corner with the least weight.
      const auto least = static_cast<std::size_t>(std::min_element(l.begin(), l.end()) - l.begin());
      const double next = l[(least + 1) % 3] - l[least];
      const double previous = l[(least + 2) % 3] - l[least];
      if (next < 1e-9 || previous < 1e-9)
      {
        continue;
      }
      wrong += found.E(id) != static_cast<int>(least) + 1;
      worst.Take(std::abs(found.C(id) - (1.0 - 3.0 * l[least])), 1e-13);
      worst.Take(
        std::abs(found.P(id) - previous / (next + previous)) * (1.0 - 3.0 * l[least]), 1e-13);
    }
    EXPECT_EQ(wrong, 0) << name;
    EXPECT_LE(worst.OverBound, 1.0) << name;
  }
}

TEST_P(CoordinatesInEverySystem, CorrespondingPointsHaveEqualCoordinates)
{
  // By definition of the homeomorphism. In the Contour system discordant triangles of P alone or of
  // Q alone would be mapped by Linear.
  const MeshPair planar = MakePlanarPair(10, 730, 0.06);
  std::vector<Pairing> pairings{ { "planar", planar },
    { "tilted", { planar.Source, Tilted(planar.Target, Tilt(), { 1.0, 0.0, 2.0 }) } } };
  if (std::string(GetParam().Name) != Contour.Name)
  {
    for (const Pairing& pairing : AllPairings(8, 2, 731))
    {
      pairings.push_back(pairing);
    }
  }
  for (const Pairing& pairing : pairings)
  {
    const MeshPair& pair = pairing.Meshes;
    const std::vector<MeshPoint> samples = InnerSamples(pair.Source, 5000, 63, 1e-3);
    const auto cloud = MakeCloud(pair.Source, samples);
    const auto onSource = MakeCoordinates(GetParam(), pair.Source, cloud);
    const auto map = MakeFilter(GetParam(), pair, cloud);
    const auto onTarget = MakeCoordinates(GetParam(), pair.Target);
    onTarget->SetDataConnection(map->GetOutputPort());
    const Coordinates before(Output(onSource));
    const Coordinates after(Output(onTarget));
    vtkIdType wrong = 0;
    Worst worst;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      wrong +=
        before.T(i) != after.T(i) || before.T(i) != samples[static_cast<std::size_t>(i)].Triangle;
      worst.Take(std::abs(before.C(i) - after.C(i)), 1e-12);
      if (before.E(i) != after.E(i))
      {
        // Only on a spoke, whose contours belong to two edges.
        const double toEnd = std::min(before.P(i), 1.0 - before.P(i));
        wrong += toEnd * before.C(i) > 1e-12;
        continue;
      }
      // The accuracy of p grows with the distance from the center and decreases with the curvature
      // of contours towards a vertex.
      worst.Take(std::abs(before.P(i) - after.P(i)) * before.C(i), 1e-11);
    }
    EXPECT_EQ(wrong, 0) << pairing.Name;
    EXPECT_LE(worst.OverBound, 1.0) << pairing.Name;
  }
}

TEST_P(CoordinatesInEverySystem, OutsideAndNonFinitePointsAreMarked)
{
  const auto mesh = MakePlanarPair(6, 740).Source;
  const auto filter = MakeCoordinates(GetParam(), mesh,
    MakeCloud({ { 1.5, 2.5, 0.0 }, { -0.01, 2.0, 0.0 }, { 7.0, 7.0, 7.0 }, { NotANumber, 1.0, 0.0 },
      { 1.5, 2.5, 1e9 } }));
  const Coordinates found(Output(filter));
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 3);
  for (const vtkIdType i : { 1, 2, 3 })
  {
    EXPECT_EQ(found.T(i), -1);
    EXPECT_EQ(found.E(i), 0);
    EXPECT_TRUE(std::isnan(found.P(i)));
    EXPECT_TRUE(std::isnan(found.C(i)));
    EXPECT_FALSE(found.IsValid(i));
  }
  // The distance from the plane is ignored.
  EXPECT_EQ(found.T(0), found.T(4));
  EXPECT_EQ(found.P(0), found.P(4));
  EXPECT_EQ(found.C(0), found.C(4));
  filter->SetTolerance(0.01);
  EXPECT_GE(Coordinates(Output(filter)).C(1), 1.0 - 1e-13);
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
    EXPECT_TRUE(output->GetCellData()->GetArray(name)) << name;
    EXPECT_TRUE(CellArray(filter, name)) << name;
  }
  EXPECT_FALSE(PointArray(filter->GetTriangulation(), "EdgeLabel"));
  EXPECT_FALSE(mesh->GetCellData()->GetArray("Concordant"));
  // If there is data, the arrays of the triangulation are on output 2 only.
  filter->SetDataObject(MakeCloud(mesh, RandomSamples(mesh, 10, 69)));
  EXPECT_FALSE(Output(filter)->GetCellData()->GetArray("Concordant"));
}

// --- Output 1: the lines -------------------------------------------------------------------------

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
  vtkCellData* cellData = lines->GetCellData();
  EXPECT_EQ(cellData->GetScalars(), cellData->GetArray("LineType"));
  EXPECT_EQ(lines->GetNumberOfCells(), lines->GetNumberOfLines());
  std::vector<Line> result;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < lines->GetNumberOfCells(); ++i)
  {
    Line line{ static_cast<int>(cellData->GetArray("LineType")->GetComponent(i, 0)),
      static_cast<vtkIdType>(cellData->GetArray("TriangleId")->GetComponent(i, 0)),
      static_cast<int>(cellData->GetArray("EdgeLabel")->GetComponent(i, 0)),
      cellData->GetArray("EdgeParameter")->GetComponent(i, 0),
      cellData->GetArray("ContourParameter")->GetComponent(i, 0), {} };
    lines->GetCellPoints(i, ids);
    for (const vtkIdType id : *ids)
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

TEST_P(CoordinatesInEverySystem, AllLinesExist)
{
  const auto mesh = MakePlanarPair(4, 770, 0.05).Source;
  AddVerticesAndLines(mesh, 1, 0); // shifts the cell ids by one
  for (const int contours : { 1, 4, 7 })
  {
    for (const int rings : { 1, 5 })
    {
      const auto filter = MakeCoordinates(GetParam(), mesh);
      filter->SetNumberOfContours(contours);
      filter->SetNumberOfRings(rings);
      filter->SetLineResolution(3);
      std::map<std::pair<vtkIdType, int>, int> counts;
      std::set<std::pair<double, int>> contoursSeen;
      for (const Line& line : ReadLines(filter))
      {
        ++counts[{ line.Triangle, line.Type }];
        EXPECT_EQ(line.Edge == 0, line.Type == RingLine);
        EXPECT_EQ(std::isnan(line.P), line.Type != ContourLine);
        EXPECT_EQ(std::isnan(line.C), line.Type != RingLine);
        if (line.Type == ContourLine)
        {
          EXPECT_EQ(line.Points.size(), 4u);
          contoursSeen.insert({ line.P, line.Edge });
        }
        else if (line.Type == RingLine)
        {
          EXPECT_EQ(line.Points.size(), 10u);
          EXPECT_NEAR(line.C * rings, std::round(line.C * rings), 1e-12);
        }
      }
      EXPECT_EQ(contoursSeen.size(), static_cast<std::size_t>(3 * contours));
      for (vtkIdType t = 1; t <= 32; ++t)
      {
        EXPECT_EQ((counts[{ t, CenterSegment }]), 3);
        EXPECT_EQ((counts[{ t, WingSegment }]), 6);
        EXPECT_EQ((counts[{ t, ContourLine }]), 3 * contours);
        EXPECT_EQ((counts[{ t, RingLine }]), rings - 1);
      }
      filter->GenerateLinesOff();
      filter->Update();
      EXPECT_EQ(filter->GetLines()->GetNumberOfCells(), 0);
      EXPECT_EQ(filter->GetLines()->GetNumberOfPoints(), 0);
    }
  }
}

TEST_P(CoordinatesInEverySystem, LinesHaveTheirCoordinates)
{
  constexpr int resolution = 12;
  for (const auto& [name, mesh] : AllMeshes(780))
  {
    const auto filter = MakeCoordinates(GetParam(), mesh);
    filter->SetNumberOfContours(5);
    filter->SetNumberOfRings(4);
    filter->SetLineResolution(resolution);
    const std::vector<Line> lines = ReadLines(filter);
    const double size = SizeOf(mesh);
    // All points of the lines are input to the filter again.
    vtkNew<vtkPolyData> points;
    points->SetPoints(filter->GetLines()->GetPoints());
    const auto check = MakeCoordinates(GetParam(), mesh, points);
    const Coordinates found(Output(check));
    EXPECT_EQ(check->GetNumberOfOutsidePoints(), 0) << name;
    Worst worst;
    vtkIdType first = 0;
    vtkIdType wrong = 0;
    for (const Line& line : lines)
    {
      const auto last = static_cast<vtkIdType>(line.Points.size()) - 1;
      // The closed line of a ring passes all three edges in order, with p from 0 to 1 on each.
      for (vtkIdType k = 0; k <= last && line.Type == RingLine; ++k)
      {
        wrong += found.T(first + k) != line.Triangle;
        worst.Take(std::abs(found.C(first + k) - line.C), 1e-12);
        if (k % resolution != 0)
        {
          const double p = static_cast<double>(k % resolution) / resolution;
          wrong += found.E(first + k) != static_cast<int>(k / resolution) + 1;
          worst.Take(std::abs(found.P(first + k) - p) * line.C, 1e-11);
        }
      }
      if (line.Type == RingLine)
      {
        worst.Take(Distance(line.Points.front(), line.Points.back()), 1e-14 * size);
      }
      // A contour runs from the center to the edge at p.
      for (vtkIdType k = 1; k < last && line.Type == ContourLine; ++k)
      {
        const double c = static_cast<double>(k) / static_cast<double>(last);
        wrong += found.T(first + k) != line.Triangle;
        worst.Take(std::abs(found.C(first + k) - c), 1e-12);
        if (line.P > 0.0)
        {
          wrong += found.E(first + k) != line.Edge;
          worst.Take(std::abs(found.P(first + k) - line.P) * c, 1e-11);
        }
      }
      if (line.Type == ContourLine)
      {
        const std::array<Point, 3> c = CornersOf(mesh, line.Triangle);
        const Point end = (1.0 - line.P) * c[line.Edge % 3] + line.P * c[(line.Edge + 1) % 3];
        worst.Take(
          Distance(line.Points.front(), CenterOf(GetParam(), mesh, line.Triangle)), 1e-14 * size);
        worst.Take(Distance(line.Points.back(), end), 2e-14 * size);
      }
      first += last + 1;
    }
    EXPECT_EQ(first, points->GetNumberOfPoints());
    EXPECT_EQ(wrong, 0) << name;
    EXPECT_LE(worst.OverBound, 1.0) << name;
  }
}

TEST(TriangularCoordinates, SegmentsAreThePublishedConstruction)
{
  // Center segments are perpendicular to the edges, wing segments join the vertices to their
  // midpoints.
  for (const System& system : { Contour, Incenter })
  {
    for (const auto& [name, mesh] : AllMeshes(790))
    {
      const auto filter = MakeCoordinates(system, mesh);
      const std::vector<Line> lines = ReadLines(filter);
      vtkDataArray* used = CellArray(filter, "UsedCoordinateSystem");
      Worst worst;
      std::map<std::pair<vtkIdType, int>, Point> feet;
      for (const Line& line : lines)
      {
        if (used->GetComponent(line.Triangle, 0) != vtkTriangularCoordinates::CONTOUR ||
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
          worst.Take(Distance(p.front(), center), rounding);
          worst.Take(std::abs(Dot(foot - center, along)), rounding);
          worst.Take(Norm(Cross(foot - start, along)), rounding);
          EXPECT_GT(Dot(foot - start, along), 0.0);
          EXPECT_LT(Dot(foot - end, along), 0.0);
        }
        else
        {
          // Its center segment precedes it.
          const Point middle = 0.5 * (center + feet.at({ line.Triangle, line.Edge }));
          worst.Take(std::min(Distance(p.front(), start), Distance(p.front(), end)), rounding);
          worst.Take(Distance(p.back(), middle), rounding);
        }
      }
      EXPECT_GT(feet.size(), 100u) << system.Name << name;
      EXPECT_LE(worst.OverBound, 1.0) << system.Name << name;
    }
  }
}

// --- Output 2: the triangles ---------------------------------------------------------------------

TEST(TriangularCoordinates, TrianglesAreDescribed)
{
  vtkIdType discordantInAll = 0;
  for (const auto& [name, mesh] : AllMeshes(800))
  {
    const auto filter = MakeCoordinates(Contour, mesh);
    vtkDataArray* concordant = CellArray(filter, "Concordant");
    vtkDataArray* margin = CellArray(filter, "ConcordanceMargin");
    vtkDataArray* used = CellArray(filter, "UsedCoordinateSystem");
    vtkDataArray* angle = CellArray(filter, "SmallestAngle");
    vtkDataArray* width = CellArray(filter, "StripWidth");
    vtkDataArray* bound = CellArray(filter, "DeterminantBound");
    ASSERT_EQ(width->GetNumberOfComponents(), 3);
    // Number of triangles at each edge.
    std::map<std::pair<vtkIdType, vtkIdType>, int> uses;
    const std::vector<Triangle> triangles = TrianglesOf(mesh);
    const auto edge = [](const Triangle& t, int k) {
      return std::minmax(t[(k + 1) % 3], t[(k + 2) % 3]);
    };
    for (const Triangle& t : triangles)
    {
      for (const int k : { 0, 1, 2 })
      {
        ++uses[edge(t, k)];
      }
    }
    vtkIdType discordant = 0;
    Worst worst;
    for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
    {
      const std::array<Point, 3> c = CornersOf(mesh, t);
      // The least distance of a foot of the centroid from an end of its edge.
      const Point centroid = (1.0 / 3.0) * (c[0] + c[1] + c[2]);
      double least = 1.0;
      double smallest = 180.0;
      for (std::size_t k = 0; k < 3; ++k)
      {
        const Point along = c[(k + 1) % 3] - c[k];
        const double foot = Dot(centroid - c[k], along) / Dot(along, along);
        least = std::min({ least, foot, 1.0 - foot });
        const double cosine = Dot(Unit(along), Unit(c[(k + 2) % 3] - c[k]));
        smallest = std::min(smallest, vtkMath::DegreesFromRadians(std::acos(cosine)));
      }
      worst.Take(std::abs(margin->GetComponent(t, 0) - least), 1e-13);
      worst.Take(std::abs(angle->GetComponent(t, 0) - smallest), 1e-10);
      ASSERT_GT(std::abs(least), 1e-12);
      discordant += least < 0.0;
      ASSERT_EQ(concordant->GetComponent(t, 0), least > 0.0 ? 1.0 : 0.0);
      ASSERT_EQ(used->GetComponent(t, 0),
        least > 0.0 ? vtkTriangularCoordinates::CONTOUR : vtkTriangularCoordinates::LINEAR);
      bool isBesideNone = true;
      for (int k = 0; k < 3; ++k)
      {
        const bool isBoundary = uses[edge(triangles[static_cast<std::size_t>(t)], k)] == 1;
        isBesideNone = isBesideNone && isBoundary;
        ASSERT_EQ(width->GetComponent(t, k) == 0.0, isBoundary);
        ASSERT_TRUE(width->GetComponent(t, k) >= 0.0 && width->GetComponent(t, k) <= 1.0);
      }
      ASSERT_GT(bound->GetComponent(t, 0), 0.0);
      ASSERT_LE(bound->GetComponent(t, 0), isBesideNone ? 1.0 : 0.28);
    }
    EXPECT_LE(worst.OverBound, 1.0) << name;
    EXPECT_EQ(filter->GetNumberOfDiscordantTriangles(), discordant);
    discordantInAll += discordant;
    // In the other systems every triangle has coordinates of that system.
    for (const System& system : { Linear, Smooth, Incenter })
    {
      const auto other = MakeCoordinates(system, mesh);
      vtkDataArray* usedThere = CellArray(other, "UsedCoordinateSystem");
      EXPECT_EQ(usedThere->GetRange()[0], system.CoordinateSystem);
      EXPECT_EQ(usedThere->GetRange()[1], system.CoordinateSystem);
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
  const Coordinates mixed(Output(contour));
  const Coordinates all(Output(linear));
  vtkDataArray* used = CellArray(contour, "UsedCoordinateSystem");
  vtkIdType mapped = 0;
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    if (used->GetComponent(mixed.T(i), 0) == vtkTriangularCoordinates::LINEAR)
    {
      ++mapped;
      ASSERT_TRUE(mixed.E(i) == all.E(i) && mixed.P(i) == all.P(i) && mixed.C(i) == all.C(i));
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
    const double system = CellArray(filter, "UsedCoordinateSystem")->GetComponent(t, 0);
    EXPECT_EQ(system, t < 2 ? -1.0 : double(vtkTriangularCoordinates::SMOOTH));
  }
  for (const Line& line : ReadLines(filter))
  {
    ASSERT_GE(line.Triangle, 2);
  }
}

} // namespace
