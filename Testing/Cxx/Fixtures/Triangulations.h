// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Triangulations.h
/// Meshes as the library's triangulations, and meshes of integer coordinates, for comparison with
/// exact arithmetic.

#ifndef fixtures_Triangulations_h
#define fixtures_Triangulations_h

#include "Meshes.h"

#include "Mesh/Triangulation.h"

namespace fixtures
{

/// The triangles of a mesh with their adjacency; some may be masked.
inline homeomorphism::Triangulation TriangulationOf(
  vtkPolyData* mesh, const std::vector<bool>& masked = {})
{
  std::vector<homeomorphism::Triangulation::Corners> narrow;
  for (const Triangle& t : TrianglesOf(mesh))
  {
    narrow.push_back({ static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
      static_cast<std::int32_t>(t[2]) });
  }
  homeomorphism::Triangulation triangulation;
  triangulation.SetTriangles(narrow, 0);
  for (std::size_t t = 0; t < masked.size(); ++t)
  {
    if (masked[t])
    {
      triangulation.Mask(static_cast<homeomorphism::TriangleIndex>(t));
    }
  }
  triangulation.FindAdjacency(mesh->GetNumberOfPoints());
  return triangulation;
}

struct IntegerPoint
{
  std::int64_t X;
  std::int64_t Y;
};

/// Positive, zero or negative, as the turn at @a b is to the left, none or to the right.
inline std::int64_t Turn(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c)
{
  return (b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X);
}

/// Triangles over points of the integer grid.
struct IntegerMesh
{
  std::vector<IntegerPoint> Points;
  std::vector<Triangle> Triangles;

  IntegerMesh() = default;
  /// A grid of squares of a size, with interior points moved by up to @a jitter.
  IntegerMesh(Random& random, int squares, int size, int jitter, const IntegerPoint& corner = {})
    : Triangles(GridTriangles(squares))
  {
    for (int j = 0; j <= squares; ++j)
    {
      for (int i = 0; i <= squares; ++i)
      {
        const bool inside = i > 0 && j > 0 && i < squares && j < squares;
        const int by = inside ? jitter : 0;
        this->Points.push_back({ corner.X + i * size + random.Integer(-by, by),
          corner.Y + j * size + random.Integer(-by, by) });
      }
    }
  }

  template <typename Predicate>
  void Remove(Predicate&& predicate)
  {
    this->Triangles.erase(std::remove_if(this->Triangles.begin(), this->Triangles.end(), predicate),
      this->Triangles.end());
  }

  /// Removes triangles: holes, islands, and vertices at which only corners meet.
  void Pierce(Random& random, double probability)
  {
    this->Remove([&](const Triangle&) { return random.Chance(probability); });
  }

  /// Numbers and orients the triangles at random.
  void Shuffle(Random& random)
  {
    for (Triangle& t : this->Triangles)
    {
      std::shuffle(t.begin(), t.end(), random.Engine);
    }
    std::shuffle(this->Triangles.begin(), this->Triangles.end(), random.Engine);
  }

  /// A point with the given unit, in the plane of two of the axes.
  static Point InSpace(const IntegerPoint& p, double unit, int normalAxis)
  {
    Point point{};
    point[(normalAxis + 1) % 3] = static_cast<double>(p.X) * unit;
    point[(normalAxis + 2) % 3] = static_cast<double>(p.Y) * unit;
    return point;
  }

  vtkSmartPointer<vtkPolyData> ToMesh(double unit, int normalAxis = 2) const
  {
    std::vector<Point> points;
    for (const IntegerPoint& p : this->Points)
    {
      points.push_back(InSpace(p, unit, normalAxis));
    }
    return MakeMesh(points, this->Triangles);
  }
};

} // namespace fixtures

#endif
