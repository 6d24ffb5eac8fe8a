// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The map of whole meshes is bijective: the images of small triangles have one orientation, their
// boundary is that of the other domain, and their areas add up to its area, so they tile it.

#include "Fixtures/FilterRuns.h"

#include "Kernel/ExactSign.h"

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

void ExpectBijective(const System& system, const MeshPair& pair)
{
  const Subdivision pieces = Subdivide(pair.Source);
  const auto filter = MakeFilter(system, pair, MakeCloud(pieces.Points));
  filter->SetDiscordantTriangles(vtkDifferentiableHomeomorphism::REFUSE);
  vtkPointSet* mapped = Output(filter);
  ASSERT_EQ(mapped->GetNumberOfPoints(), static_cast<vtkIdType>(pieces.Points.size()));
  ASSERT_EQ(filter->GetNumberOfOutsidePoints(), 0);

  double area = 0.0;
  for (vtkIdType t = 0; t < pair.Target->GetNumberOfCells(); ++t)
  {
    const std::array<Point, 3> corners = CornersOf(pair.Target, t);
    area += SignedArea(InPlane(corners[0]), InPlane(corners[1]), InPlane(corners[2]));
  }
  double sum = 0.0;
  for (const Piece& piece : pieces.Pieces)
  {
    std::array<Vector2, 3> image;
    for (std::size_t k = 0; k < 3; ++k)
    {
      image[k] = InPlane(PointOf(mapped, static_cast<vtkIdType>(piece.Points[k])));
    }
    ASSERT_GT(homeomorphism::Orientation(image[0], image[1], image[2]), 0) << piece.Triangle;
    sum += SignedArea(image[0], image[1], image[2]);
  }
  EXPECT_NEAR(sum, area, 1e-12 * area);
}

class Bijectivity : public testing::TestWithParam<System>
{
};

INSTANTIATE_TEST_SUITE_P(AllSystems, Bijectivity, testing::ValuesIn(AllSystems()), NameOfSystem);

TEST_P(Bijectivity, ImagesOfSmallTrianglesTileTheTarget)
{
  for (const std::uint64_t seed : { 31u, 57u })
  {
    SCOPED_TRACE(seed);
    const bool choosy =
      GetParam().IsContour() && GetParam().CenterPoint == vtkDifferentiableHomeomorphism::CENTROID;
    ExpectBijective(GetParam(), choosy ? MakeConcordantPair(4, seed) : MakePlanarPair(4, seed));
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
  ExpectBijective(Smooth, { pair.Source, target });
}

} // namespace
