// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The map of whole meshes is bijective: the images of small triangles have the same orientation,
// and their areas add up to that of the other domain. This includes ill-conditioned maps.

#include "Fixtures/FilterRuns.h"

#include "Kernel/ExactSign.h"

namespace
{

using namespace fixtures;
using homeomorphism::Orientation;

/// The mesh with its triangles divided into 24^2 parts each.
vtkSmartPointer<vtkPolyData> Divided(vtkPolyData* mesh)
{
  constexpr vtkIdType n = 24;
  std::vector<Point> points;
  std::vector<Triangle> parts;
  for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
  {
    // Row i has n + 1 - i points.
    const auto at = [first = static_cast<vtkIdType>(points.size())](vtkIdType i, vtkIdType j) {
      return first + i * (n + 1) - i * (i - 1) / 2 + j;
    };
    for (vtkIdType i = 0; i <= n; ++i)
    {
      for (vtkIdType j = 0; i + j <= n; ++j)
      {
        points.push_back(
          PositionOf(mesh, { t, { double(i) / n, double(j) / n, double(n - i - j) / n } }));
        if (i + j < n)
        {
          parts.push_back({ at(i, j), at(i + 1, j), at(i, j + 1) });
        }
        if (i > 0 && j > 0)
        {
          parts.push_back({ at(i, j), at(i - 1, j), at(i, j - 1) });
        }
      }
    }
  }
  return MakeMesh(points, parts);
}

/// The sum of the areas of triangles, all of which are wound counterclockwise.
double AreaOf(vtkPolyData* mesh)
{
  double area = 0.0;
  for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
  {
    const auto [a, b, c] = CornersOf(mesh, t);
    EXPECT_GT(Orientation({ a[0], a[1] }, { b[0], b[1] }, { c[0], c[1] }), 0) << t;
    area += 0.5 * Cross(b - a, c - a)[2];
  }
  return area;
}

/// The points of a mesh of almost equilateral triangles, all of which are concordant.
MeshPair MakeConcordantPair(int n, std::uint64_t seed)
{
  // The diagonals of the grid run from the lower left to the upper right, so they must be the short
  // ones.
  const Matrix slant{ { { 1.0, -0.5, 0.0 }, { 0.0, 0.866, 0.0 }, { 0.0, 0.0, 1.0 } } };
  return Moved(MakePlanarPair(n, seed, 0.1), [&](const Point& p) { return slant * p; });
}

void ExpectBijective(const System& system, const MeshPair& pair)
{
  const auto filter = MakeFilter(system, pair, Divided(pair.Source));
  filter->SetDiscordantTriangles(vtkDifferentiableHomeomorphism::REFUSE);
  const double area = AreaOf(pair.Target);
  EXPECT_NEAR(AreaOf(vtkPolyData::SafeDownCast(Output(filter))), area, 1e-12 * area);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
}

using Bijectivity = TestInEverySystem;

INSTANTIATE_TEST_SUITE_P(AllSystems, Bijectivity, testing::ValuesIn(AllSystems()), NameOfSystem);

TEST_P(Bijectivity, ImagesOfSmallTrianglesTileTheTarget)
{
  for (const std::uint64_t seed : { 31u, 57u })
  {
    SCOPED_TRACE(seed);
    ExpectBijective(
      GetParam(), GetParam().IsChoosy() ? MakeConcordantPair(4, seed) : MakePlanarPair(4, seed));
  }
}

/// Smooth accepts triangles of any shape: here the target is sheared, and one vertex is close to an
/// edge.
TEST(BijectivityOfSmooth, HoldsForNeedles)
{
  const MeshPair pair = MakePlanarPair(4, 91);
  const auto target = Sheared(pair.Target);
  const Point middle = 0.5 * (PointOf(target, 13) + PointOf(target, 7));
  MovePoint(target, 12, middle + 1e-3 * (PointOf(target, 12) - middle));
  ExpectBijective(Smooth, { pair.Source, target });
}

/// Beside a far smaller neighbor the columns of the Jacobian are almost parallel.
TEST(IllConditioned, DeterminantsBesideFarSmallerTriangles)
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
  const auto cloud = MakeCloud(pair.Source, RandomSamples(pair.Source, 20000, 5));
  cloud->GetPoints()->InsertNextPoint(-0.0010156480399538691, -0.0014540839480793751, 0.0);
  const auto filter = MakeFilter(Smooth, pair, cloud);
  filter->ComputeJacobianDeterminantOn();
  EXPECT_GT(PointArray(Output(filter), "JacobianDeterminant")->GetRange()[0], 0.0);
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
}

/// Two needles on an edge, 1e11 times as long as it: components of an offset cancel.
TEST(IllConditioned, RoundTripInNeedlesOnAShortEdge)
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
  const Point start{ 476509391827976.56, 488005853748351.94, 0.0 };
  const auto filter = MakeFilter(Smooth, pair, MakeCloud({ start }));
  const auto back = MakeFilter(Smooth, pair, Output(filter));
  back->InverseOn();
  // The rounding of coordinates of 5e14, and that of the image, along needles of 2e11.
  EXPECT_LT(Distance(PointOf(Output(back), 0), start), 64.0 * Ulp * 5e14);
  EXPECT_EQ(back->GetNumberOfOutsidePoints(), 0);
}

/// Up to two ulp beside the corners of triangles whose edges are longer than their coordinates.
TEST(IllConditioned, DistancesAreRoundedToo)
{
  const std::vector<Triangle> triangles{ { 0, 1, 2 }, { 1, 0, 3 } };
  const auto mesh = MakeMesh({ { 0, 0, 0 }, { 1.0335040411931204, 0.64456407854183768, 0 },
                               { -0.99287494773428980, 1.0514803639231405, 0 },
                               { 0.40642868698839383, -1.1440443921782702, 0 } },
    triangles);
  std::vector<Point> points;
  for (int i = 0; i < 4 * 81; ++i)
  {
    const Point offset{ i / 4 % 9 - 4.0, i / 36 - 4.0, 0.0 };
    points.push_back(PointOf(mesh, i % 4) + 0.35 * Ulp * offset);
  }
  const auto filter = MakeFilter(Linear, { mesh, mesh }, MakeCloud(points));
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
}

} // namespace
