// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Adjacency, orientability and unfolding of neighbors.

#include "Fixtures/Triangulations.h"

#include "Mesh/ChartedTriangulation.h"
#include "Mesh/MeshGeometry.h"
#include "Mesh/Triangulation.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <string>

namespace
{

using namespace homeomorphism;
using namespace fixtures;

/// The start and end of an edge in the triangle's cyclic order.
std::pair<std::int32_t, std::int32_t> EdgeOf(const Triangulation::Corners& corners, int edge)
{
  return { corners[(edge + 1) % 3], corners[(edge + 2) % 3] };
}

/// Compares the adjacency with a map from pairs of points to triangles.
void ExpectAdjacency(Triangulation& triangulation, vtkIdType numberOfPoints)
{
  using Edges = std::vector<std::pair<TriangleIndex, int>>;
  std::map<std::pair<std::int32_t, std::int32_t>, Edges> edges;
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  for (TriangleIndex t = 0; t < count; ++t)
  {
    for (int k = 0; k < 3 && !triangulation.IsMasked(t); ++k)
    {
      const auto edge = EdgeOf(triangulation.GetCorners(t), k);
      edges[std::minmax(edge.first, edge.second)].emplace_back(t, k);
    }
  }
  std::set<TriangleIndex> crowded;
  for (const auto& [points, sharing] : edges)
  {
    for (std::size_t i = 0; i < sharing.size() && sharing.size() > 2; ++i)
    {
      crowded.insert(sharing[i].first);
    }
  }
  ASSERT_EQ(std::vector<TriangleIndex>(crowded.begin(), crowded.end()),
    triangulation.FindAdjacency(numberOfPoints));

  for (TriangleIndex t = 0; t < count; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Twin across = triangulation.GetTwin(t, k);
      const auto edge = EdgeOf(triangulation.GetCorners(t), k);
      const Edges& sharing = edges[std::minmax(edge.first, edge.second)];
      if (triangulation.IsMasked(t) || sharing.size() != 2)
      {
        ASSERT_EQ(-1, across.Triangle);
        continue;
      }
      const auto& other = sharing[0] == std::make_pair(t, k) ? sharing[1] : sharing[0];
      ASSERT_EQ(other.first, across.Triangle);
      ASSERT_EQ(other.second, across.Edge);
      const auto otherEdge = EdgeOf(triangulation.GetCorners(other.first), other.second);
      ASSERT_EQ(edge == otherEdge, across.SameDirection);
    }
  }
}

/// Three different ones of some points.
Triangulation::Corners AnyCorners(Random& random, int points)
{
  Triangulation::Corners t;
  do
  {
    t = { random.Below(points), random.Below(points), random.Below(points) };
  } while (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]);
  return t;
}

TEST(Triangulation, AdjacencyOfRandomTriangles)
{
  Random random(1);
  for (int n = 0; n < 3000; ++n)
  {
    const int points = 3 + n % 12;
    std::vector<Triangulation::Corners> triangles(n % 25);
    std::generate(triangles.begin(), triangles.end(), [&]() { return AnyCorners(random, points); });
    Triangulation triangulation;
    triangulation.SetTriangles(triangles, 0);
    for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
    {
      if (n % 3 == 0 && random.Below(points) == 0)
      {
        triangulation.Mask(t);
      }
    }
    ExpectAdjacency(triangulation, points);
    if (triangulation.GetNumberOfTriangles() > 0)
    {
      // Recomputed after more triangles have been masked.
      triangulation.Mask(0);
      ExpectAdjacency(triangulation, points);
    }
    ASSERT_FALSE(HasFatalFailure()) << n;
  }
}

/// Whether the triangles can be oriented consistently: no triangle may be connected to its own
/// reverse through a chain of neighbors. Disjoint sets of (triangle, orientation).
bool IsOrientable(const Triangulation& triangulation)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  std::vector<TriangleIndex> parent(2 * count);
  std::iota(parent.begin(), parent.end(), 0);
  const std::function<TriangleIndex(TriangleIndex)> root = [&](TriangleIndex i) {
    return parent[i] == i ? i : parent[i] = root(parent[i]);
  };
  for (TriangleIndex t = 0; t < count; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Twin across = triangulation.GetTwin(t, k);
      for (int side = 0; side < 2 && across.Triangle >= 0; ++side)
      {
        const int otherSide = across.SameDirection ? 1 - side : side;
        parent[root(2 * t + side)] = root(2 * across.Triangle + otherSide);
      }
    }
  }
  bool isOrientable = true;
  for (TriangleIndex t = 0; t < count; ++t)
  {
    isOrientable = isOrientable && root(2 * t) != root(2 * t + 1);
  }
  return isOrientable;
}

TEST(Triangulation, OrientabilityOfRandomTriangles)
{
  Random random(3);
  int oneSided = 0;
  for (int n = 0; n < 4000; ++n)
  {
    const int points = 5 + n % 6;
    std::vector<Triangulation::Corners> triangles;
    Triangulation triangulation;
    // Grows a surface without non-manifold edges.
    for (int attempt = 0; attempt < 25; ++attempt)
    {
      triangles.push_back(AnyCorners(random, points));
      triangulation.SetTriangles(triangles, 0);
      if (!triangulation.FindAdjacency(points).empty())
      {
        triangles.pop_back();
      }
    }
    triangulation.SetTriangles(triangles, 0);
    triangulation.FindAdjacency(points);
    const bool orientable = IsOrientable(triangulation);
    ASSERT_EQ(orientable, triangulation.FindNonOrientable().empty()) << n;
    oneSided += !orientable;
  }
  EXPECT_GT(oneSided, 200);
  EXPECT_LT(oneSided, 3800);
}

TEST(Triangulation, UnfoldedNeighborsKeepTheirLengths)
{
  Random random(4);
  int neighborsSeen = 0;
  for (const std::string name : { "plane", "sheet", "closed", "steep" })
  {
    const auto mesh = name == "plane" ? MakePlanarPair(12, 4).Source
      : name == "closed"              ? MakeClosedPair(3, 4).Target
                                      : MakeSheet(12, 5, name == "steep" ? 8.0 : 0.5);
    std::vector<Triangle> triangles = TrianglesOf(mesh);
    for (Triangle& corners : triangles)
    {
      std::shuffle(corners.begin(), corners.end(), random.Engine);
    }
    SetTriangles(mesh, triangles);
    const Triangulation triangulation = TriangulationOf(mesh);
    MeshGeometry geometry(mesh->GetPoints(), triangulation);
    geometry.ComputeFrames(triangulation);
    EXPECT_EQ(name == "plane", geometry.IsPlanar());
    const std::vector<Point> points = PointsOf(mesh);
    const double scale = geometry.GetScale();
    for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
    {
      const std::array<Neighbor, 3> neighbors = UnfoldNeighbors(triangulation, geometry, t);
      for (int k = 0; k < 3; ++k)
      {
        const Twin across = triangulation.GetTwin(t, k);
        ASSERT_EQ(across.Triangle >= 0, neighbors[k].Exists);
        if (across.Triangle < 0)
        {
          continue;
        }
        ++neighborsSeen;
        // Along the edge of this triangle, from its start: the apex of the neighbor is on the other
        // side.
        const auto edge = EdgeOf(triangulation.GetCorners(t), k);
        const std::int32_t apex = triangulation.GetCorners(across.Triangle)[across.Edge];
        const EdgeView& view = neighbors[k].View;
        const double length = scale * Distance(points[edge.first], points[edge.second]);
        const double toStart = scale * Distance(points[edge.first], points[apex]);
        const double toEnd = scale * Distance(points[edge.second], points[apex]);
        EXPECT_GT(view.Height, 0.0);
        const double along = view.Foot * view.Length;
        EXPECT_NEAR(view.Length, length, 2e-15 * length);
        EXPECT_NEAR(std::hypot(along, view.Height), toStart, 2e-15 * toStart);
        EXPECT_NEAR(std::hypot(view.Length - along, view.Height), toEnd, 2e-15 * toEnd);
      }
    }
  }
  EXPECT_GT(neighborsSeen, 2000);
}

} // namespace
