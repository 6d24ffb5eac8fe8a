// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The map of whole meshes is bijective: the images of small triangles tile the other domain, and
// every point of it lies in exactly one of them and maps back into its preimage.

#include "Fixtures/FilterRuns.h"

#include "Kernel/ExactSign.h"

#include "vtkCellData.h"
#include "vtkIntArray.h"

#include <gtest/gtest.h>

namespace
{

using namespace fixtures;
using homeomorphism::Vector2;

/// Number of subdivisions of each edge.
constexpr int Divisions = 24;

/// A piece of a triangle of a mesh, and three points of the subdivided mesh.
struct Piece
{
  vtkIdType Triangle;
  std::array<std::size_t, 3> Points;
};

struct Subdivision
{
  std::vector<Point> Points;
  std::vector<Piece> Pieces;
};

Subdivision Subdivide(vtkPolyData* mesh)
{
  Subdivision result;
  for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
  {
    std::array<std::array<std::size_t, Divisions + 1>, Divisions + 1> at{};
    for (int i = 0; i <= Divisions; ++i)
    {
      for (int j = 0; i + j <= Divisions; ++j)
      {
        const int k = Divisions - i - j;
        at[i][j] = result.Points.size();
        result.Points.push_back(PositionOf(
          mesh, { t, { double(i) / Divisions, double(j) / Divisions, double(k) / Divisions } }));
      }
    }
    for (int i = 0; i < Divisions; ++i)
    {
      for (int j = 0; i + j < Divisions; ++j)
      {
        result.Pieces.push_back({ t, { at[i][j], at[i + 1][j], at[i][j + 1] } });
        if (i + j + 1 < Divisions)
        {
          result.Pieces.push_back({ t, { at[i + 1][j + 1], at[i][j + 1], at[i + 1][j] } });
        }
      }
    }
  }
  return result;
}

Vector2 InPlane(const Point& p)
{
  return { p[0], p[1] };
}

double SignedArea(const Vector2& a, const Vector2& b, const Vector2& c)
{
  return 0.5 * homeomorphism::Cross(b - a, c - a);
}

/// For corners in counterclockwise order: 1 if the point is inside, 0 if it is on the boundary, -1
/// outside.
int Containment(const std::array<Vector2, 3>& corners, const Vector2& point)
{
  int least = 1;
  for (int k = 0; k < 3; ++k)
  {
    least = std::min(least, homeomorphism::Orientation(corners[k], corners[(k + 1) % 3], point));
  }
  return least;
}

/// The points of a mesh of almost equilateral triangles, all of which are concordant.
MeshPair MakeConcordantPair(int n, std::uint64_t seed)
{
  const auto slant = [](vtkPolyData* mesh) {
    // The diagonals of the grid run from the lower left to the upper right, so they must be the
    // short ones.
    return Moved(mesh, [](const Point& p) -> Point {
      return { p[0] - 0.5 * p[1], 0.866 * p[1], 0.0 };
    });
  };
  const MeshPair square = MakePlanarPair(n, seed, 0.1);
  return { slant(square.Source), slant(square.Target) };
}

void ExpectBijective(const System& system, const MeshPair& pair, std::uint64_t seed)
{
  const Subdivision pieces = Subdivide(pair.Source);
  const auto filter = MakeFilter(system, pair, MakeCloud(pieces.Points));
  filter->SetDiscordantTriangles(vtkDifferentiableHomeomorphism::REFUSE);
  vtkPointSet* mapped = Output(filter);
  ASSERT_EQ(mapped->GetNumberOfPoints(), static_cast<vtkIdType>(pieces.Points.size()));
  ASSERT_EQ(filter->GetNumberOfOutsidePoints(), 0);

  // No image is flipped, and the areas of the images sum to that of the domain.
  double area = 0.0;
  for (vtkIdType t = 0; t < pair.Target->GetNumberOfCells(); ++t)
  {
    const std::array<Point, 3> corners = CornersOf(pair.Target, t);
    area += SignedArea(InPlane(corners[0]), InPlane(corners[1]), InPlane(corners[2]));
  }
  std::vector<std::array<Vector2, 3>> images(pieces.Pieces.size());
  double sum = 0.0;
  vtkIdType turnedOver = 0;
  for (std::size_t i = 0; i < images.size(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      images[i][k] = InPlane(PointOf(mapped, static_cast<vtkIdType>(pieces.Pieces[i].Points[k])));
    }
    turnedOver += homeomorphism::Orientation(images[i][0], images[i][1], images[i][2]) <= 0;
    sum += SignedArea(images[i][0], images[i][1], images[i][2]);
  }
  EXPECT_EQ(turnedOver, 0);
  EXPECT_NEAR(sum, area, 1e-12 * area);

  // A fine grid over the target, shifted so that none of its points is on a line of the mesh.
  double bounds[6];
  pair.Target->GetBounds(bounds);
  constexpr int gridSize = 220;
  Random random(seed);
  const Vector2 shift{ random.Uniform(), random.Uniform() };
  const Vector2 spacing{ (bounds[1] - bounds[0]) / gridSize, (bounds[3] - bounds[2]) / gridSize };
  const auto gridPoint = [&](int i, int j) -> Vector2 {
    return { bounds[0] + (i + shift.x) * spacing.x, bounds[2] + (j + shift.y) * spacing.y };
  };
  std::vector<int> hits(gridSize * gridSize, 0);
  std::vector<std::size_t> owner(gridSize * gridSize, 0);
  for (std::size_t n = 0; n < images.size(); ++n)
  {
    Vector2 least = images[n][0];
    Vector2 greatest = least;
    for (const Vector2& p : images[n])
    {
      least = { std::min(least.x, p.x), std::min(least.y, p.y) };
      greatest = { std::max(greatest.x, p.x), std::max(greatest.y, p.y) };
    }
    const auto column = [&](double x) {
      return std::clamp(static_cast<int>((x - bounds[0]) / spacing.x), 0, gridSize - 1);
    };
    const auto row = [&](double y) {
      return std::clamp(static_cast<int>((y - bounds[2]) / spacing.y), 0, gridSize - 1);
    };
    for (int i = std::max(0, column(least.x) - 1); i <= column(greatest.x); ++i)
    {
      for (int j = std::max(0, row(least.y) - 1); j <= row(greatest.y); ++j)
      {
        const int inside = Containment(images[n], gridPoint(i, j));
        ASSERT_NE(inside, 0) << "the grid is not in general position";
        if (inside > 0)
        {
          ++hits[i * gridSize + j];
          owner[i * gridSize + j] = n;
        }
      }
    }
  }
  std::vector<Point> inside;
  std::vector<std::size_t> owners;
  vtkIdType notOnce = 0;
  for (int i = 0; i < gridSize; ++i)
  {
    for (int j = 0; j < gridSize; ++j)
    {
      const Vector2 p = gridPoint(i, j);
      int triangles = 0;
      for (vtkIdType t = 0; t < pair.Target->GetNumberOfCells(); ++t)
      {
        const std::array<Point, 3> corners = CornersOf(pair.Target, t);
        triangles +=
          Containment({ InPlane(corners[0]), InPlane(corners[1]), InPlane(corners[2]) }, p) > 0;
      }
      ASSERT_LE(triangles, 1);
      const int count = hits[i * gridSize + j];
      notOnce += count != triangles;
      if (count == 1)
      {
        inside.push_back({ p.x, p.y, 0.0 });
        owners.push_back(owner[i * gridSize + j]);
      }
    }
  }
  EXPECT_EQ(notOnce, 0);
  EXPECT_GT(inside.size(), std::size_t(gridSize * gridSize / 3));

  // The preimage lies in the piece whose image contains the point, up to the difference between the
  // image and its straight-sided approximation.
  const auto inverse = MakeFilter(system, pair, MakeCloud(inside));
  inverse->InverseOn();
  vtkPointSet* back = Output(inverse);
  ASSERT_EQ(inverse->GetNumberOfOutsidePoints(), 0);
  const auto again = MakeFilter(system, pair, back);
  vtkPointSet* there = Output(again);
  double worstReturn = 0.0;
  double farthest = 0.0;
  for (std::size_t i = 0; i < inside.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    worstReturn = std::max(worstReturn, Distance(PointOf(there, id), inside[i]));
    const Piece& piece = pieces.Pieces[owners[i]];
    const Point preimage = PointOf(back, id);
    double nearest = std::numeric_limits<double>::infinity();
    double size = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      const Point& corner = pieces.Points[piece.Points[k]];
      nearest = std::min(nearest, Distance(corner, preimage));
      size = std::max(size, Distance(corner, pieces.Points[piece.Points[(k + 1) % 3]]));
    }
    farthest = std::max(farthest, nearest / size);
  }
  EXPECT_LT(worstReturn, 1e-13 * SizeOf(pair.Target));
  EXPECT_LT(farthest, 1.0);
}

class Bijectivity : public testing::TestWithParam<System>
{
};

INSTANTIATE_TEST_SUITE_P(AllSystems, Bijectivity, testing::ValuesIn(AllSystems()), NameOfSystem);

TEST_P(Bijectivity, EveryTargetPointHasOnePreimage)
{
  for (const std::uint64_t seed : { 31u, 57u })
  {
    SCOPED_TRACE(seed);
    const bool choosy =
      GetParam().IsContour() && GetParam().CenterPoint == vtkDifferentiableHomeomorphism::CENTROID;
    ExpectBijective(
      GetParam(), choosy ? MakeConcordantPair(4, seed) : MakePlanarPair(4, seed), seed);
  }
}

/// Smooth accepts triangles of any shape: here the target is sheared, and one vertex is close to an
/// edge.
TEST(BijectivityOfSmooth, HoldsForNeedles)
{
  const MeshPair pair = MakePlanarPair(4, 91);
  const auto target = Sheared(pair.Target);
  Point p = PointOf(target, 12);
  const Point right = PointOf(target, 13);
  const Point below = PointOf(target, 7);
  p = 0.5 * (right + below) + 1e-3 * (p - 0.5 * (right + below));
  target->GetPoints()->SetPoint(12, p.data());
  ExpectBijective(Smooth, { pair.Source, target }, 91);
}

// --- Ill-conditioned cases -----------------------------------------------------------------------

/// Beside a far smaller neighbor the columns of the Jacobian are almost parallel, and the
/// difference of their products would be inaccurate.
TEST(Determinant, IsAccurateBesideFarSmallerTriangles)
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 2, 1, 3 }, { 0, 2, 4 }, { 1, 0, 5 } };
  const MeshPair pair{ MakeMesh({ { 0, 0, 0 }, { -0.002454802733636777, -0.0035144943034052731, 0 },
                                  { 149.59907385978013, -104.49306798784818, 0 },
                                  { 101.27614104114896, -70.741797421224831, 0 },
                                  { 125.92354572417675, -87.934608160010455, 0 },
                                  { -0.00072654985430002487, -0.0010401874989684474, 0 } },
                         triangles),
    MakeMesh({ { 0, 0, 0 }, { 15.891333793624549, 7.6149123705193915, 0 },
               { -1685.4936190774181, 3555.4096479727887, 0 },
               { -1149.9578624168741, 2438.6894519073048, 0 },
               { -499.35351658059602, 443.69401902183745, 0 },
               { 15.042583642223518, 7.2082027694053439, 0 } },
      triangles) };
  std::vector<Point> points{ { -0.0010156480399538691, -0.0014540839480793751, 0.0 } };
  for (const MeshPoint& surfacePoint : RandomSamples(pair.Source, 20000, 5))
  {
    points.push_back(PositionOf(pair.Source, surfacePoint));
  }
  const auto filter = MakeFilter(Smooth, pair, MakeCloud(points));
  filter->ComputeJacobianDeterminantOn();
  vtkPointSet* output = Output(filter);
  ASSERT_EQ(filter->GetNumberOfOutsidePoints(), 0);
  vtkDataArray* determinant = PointArray(output, "JacobianDeterminant");
  ASSERT_TRUE(determinant);
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    ASSERT_GT(determinant->GetComponent(i, 0), 0.0) << "point " << i;
  }
}

/// Two needles on a short edge, both 1e11 times as long as the edge: the components of the Smooth
/// chart's offset cancel and must sum to 0 nevertheless.
TEST(RoundTrip, HoldsForNeedlesOnAShortEdge)
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 1, 0, 3 } };
  const MeshPair pair{ MakeMesh({ { 476514376170425.75, 487995329171615.19, 0 },
                                  { 476514376170426.62, 487995329171615.62, 0 },
                                  { 476424604967477.62, 488184883545877.62, 0 },
                                  { 511738598038534.19, 413618411899735.5, 0 } },
                         triangles),
    MakeMesh({ { -1080.6706916666099, 1259.1673662958972, 0 },
               { -1079.6706916666099, 1259.1673662958972, 0 },
               { -1079.934357594829, 1260.2940985012667, 0 },
               { -1080.3772553135082, 1259.1625654312259, 0 } },
      triangles) };
  const auto start = MakeCloud({ { 476509391827976.56, 488005853748351.94, 0.0 } });
  const auto filter = MakeFilter(Smooth, pair, start);
  const auto back = MakeFilter(Smooth, pair, Output(filter));
  back->InverseOn();
  const double error = Distance(PointOf(Output(back), 0), PointOf(start, 0));
  EXPECT_EQ(back->GetNumberOfOutsidePoints(), 0);
  // The rounding of coordinates of 5e14, and that of the image, along needles of 2e11.
  EXPECT_LT(error, 64.0 * Ulp * 5e14);
}

/// Two ulp beside the corner of a triangle whose edges are longer than its coordinates.
TEST(Tolerance, IncludesRoundingOfTheDistance)
{
  const MeshPair pair{ MakeMesh({ { 0, 0, 0 }, { 1.0335040411931204, 0.64456407854183768, 0 },
                                  { -0.99287494773428980, 1.0514803639231405, 0 },
                                  { 0.40642868698839383, -1.1440443921782702, 0 } },
                         { { 0, 1, 2 }, { 1, 0, 3 } }),
    MakeMesh(
      { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 } }, { { 0, 1, 2 }, { 1, 0, 3 } }) };
  // All around the corners, up to two ulp of the largest coordinate away.
  std::vector<Point> points;
  for (vtkIdType corner = 0; corner < 4; ++corner)
  {
    for (int i = -4; i <= 4; ++i)
    {
      for (int j = -4; j <= 4; ++j)
      {
        const Point p = PointOf(pair.Source, corner);
        points.push_back({ p[0] + 0.35 * i * Ulp, p[1] + 0.35 * j * Ulp, 0.0 });
      }
    }
  }
  const auto filter = MakeFilter(Linear, pair, MakeCloud(points));
  Output(filter);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
}

} // namespace
