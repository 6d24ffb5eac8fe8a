// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Meshes.h
/// Triangulations and pairs of every kind, modifications of them, and random points in them.

#ifndef fixtures_Meshes_h
#define fixtures_Meshes_h

#include "LinearAlgebra.h"
#include "Random.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkLinearSubdivisionFilter.h"
#include "vtkNew.h"
#include "vtkPlatonicSolidSource.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace fixtures
{

using Triangle = std::array<vtkIdType, 3>;

struct MeshPair
{
  vtkSmartPointer<vtkPolyData> Source;
  vtkSmartPointer<vtkPolyData> Target;
};

/// Points without cells.
inline vtkSmartPointer<vtkPolyData> MakeCloud(
  const std::vector<Point>& positions, int dataType = VTK_DOUBLE)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(dataType);
  for (const Point& position : positions)
  {
    points->InsertNextPoint(position.data());
  }
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  cloud->SetPoints(points);
  return cloud;
}

/// Cells of any number of points.
template <typename Polygon = std::vector<vtkIdType>>
vtkSmartPointer<vtkCellArray> MakePolygons(const std::vector<Polygon>& polygons)
{
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (const Polygon& polygon : polygons)
  {
    cells->InsertNextCell(static_cast<vtkIdType>(polygon.size()), polygon.data());
  }
  return cells;
}

inline vtkSmartPointer<vtkPolyData> MakeMesh(
  const std::vector<Point>& points, const std::vector<Triangle>& triangles)
{
  const auto mesh = MakeCloud(points);
  mesh->SetPolys(MakePolygons(triangles));
  return mesh;
}

/// The triangles of a grid of n x n unit squares whose points are numbered row by row.
inline std::vector<Triangle> GridTriangles(int n)
{
  std::vector<Triangle> triangles;
  for (vtkIdType j = 0; j < n; ++j)
  {
    for (vtkIdType i = 0; i < n; ++i)
    {
      const vtkIdType a = j * (n + 1) + i;
      const vtkIdType c = a + n + 1;
      triangles.push_back({ a, a + 1, c + 1 });
      triangles.push_back({ a, c + 1, c });
    }
  }
  return triangles;
}

/// The points of that grid. Interior points are moved at random by up to jitter (at most 0.25 keeps
/// the orientation of all triangles). The boundary is the square [0, n] x [0, n].
inline std::vector<Point> GridPoints(int n, std::uint64_t seed, double jitter)
{
  Random random(seed);
  std::vector<Point> points;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      const bool inside = i > 0 && i < n && j > 0 && j < n;
      const double dx = random.Uniform(-jitter, jitter);
      const double dy = random.Uniform(-jitter, jitter);
      points.push_back({ i + (inside ? dx : 0.0), j + (inside ? dy : 0.0), 0.0 });
    }
  }
  return points;
}

/// That grid with unmoved points.
inline vtkSmartPointer<vtkPolyData> RegularGrid(int n)
{
  return MakeMesh(GridPoints(n, 0, 0.0), GridTriangles(n));
}

/// Two different triangulations of the square [0, n] x [0, n] with the same triangles.
inline MeshPair MakePlanarPair(int n, std::uint64_t seed, double jitter = 0.25)
{
  return { MakeMesh(GridPoints(n, seed, jitter), GridTriangles(n)),
    MakeMesh(GridPoints(n, seed + 1, jitter), GridTriangles(n)) };
}

/// A surface over that square with waves of height @a wave.
inline vtkSmartPointer<vtkPolyData> MakeSheet(int n, std::uint64_t seed, double wave)
{
  std::vector<Point> points = GridPoints(n, seed, 0.25);
  for (Point& p : points)
  {
    p[2] = wave * std::sin(0.7 * p[0] + 0.3) * std::cos(0.5 * p[1]);
  }
  return MakeMesh(points, GridTriangles(n));
}

inline Point PointOf(vtkDataSet* data, vtkIdType i)
{
  Point p;
  data->GetPoint(i, p.data());
  return p;
}

inline std::vector<Point> PointsOf(vtkDataSet* data)
{
  std::vector<Point> points;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    points.push_back(PointOf(data, i));
  }
  return points;
}

/// The points of a cell.
inline std::vector<vtkIdType> IdsOf(vtkDataSet* data, vtkIdType cell)
{
  vtkNew<vtkIdList> ids;
  data->GetCellPoints(cell, ids);
  return { ids->begin(), ids->end() };
}

inline std::vector<Triangle> TrianglesOf(vtkPolyData* mesh)
{
  std::vector<Triangle> triangles;
  vtkNew<vtkIdList> ids;
  for (vtkIdType t = 0; t < mesh->GetNumberOfPolys(); ++t)
  {
    mesh->GetPolys()->GetCellAtId(t, ids);
    triangles.push_back({ ids->GetId(0), ids->GetId(1), ids->GetId(2) });
  }
  return triangles;
}

/// Two different closed surfaces: an octahedron subdivided @a divisions times, with its points on
/// two ellipsoids and moved at random along them.
inline MeshPair MakeClosedPair(int divisions, std::uint64_t seed)
{
  vtkNew<vtkPlatonicSolidSource> octahedron;
  octahedron->SetSolidTypeToOctahedron();
  vtkNew<vtkLinearSubdivisionFilter> subdivision;
  subdivision->SetInputConnection(octahedron->GetOutputPort());
  subdivision->SetNumberOfSubdivisions(divisions);
  subdivision->Update();
  Random random(seed);
  const double spacing = std::pow(0.5, divisions);
  const auto surface = [&](const Point& axes) {
    std::vector<Point> points = PointsOf(subdivision->GetOutput());
    for (Point& p : points)
    {
      p = Unit(Unit(p) + 0.2 * spacing * random.Vector());
      p = { axes[0] * p[0], axes[1] * p[1], axes[2] * p[2] };
    }
    return MakeMesh(points, TrianglesOf(subdivision->GetOutput()));
  };
  const auto source = surface({ 1.0, 1.0, 1.0 });
  return { source, surface({ 2.0, 1.2, 0.7 }) };
}

// --- Changes to meshes ---------------------------------------------------------------------------

inline void MovePoint(vtkPolyData* mesh, vtkIdType id, const Point& to)
{
  mesh->GetPoints()->SetPoint(id, to.data());
  mesh->GetPoints()->Modified();
}

inline void SetTriangles(vtkPolyData* mesh, const std::vector<Triangle>& triangles)
{
  mesh->SetPolys(MakePolygons(triangles));
}

/// The mesh or the pair with other triangles and copies of its points.
inline vtkSmartPointer<vtkPolyData> WithTriangles(
  vtkPolyData* mesh, const std::vector<Triangle>& triangles)
{
  return MakeMesh(PointsOf(mesh), triangles);
}
inline MeshPair WithTriangles(const MeshPair& pair, const std::vector<Triangle>& triangles)
{
  return { WithTriangles(pair.Source, triangles), WithTriangles(pair.Target, triangles) };
}

/// Puts vertex and line cells before the triangles of a mesh, which shifts their cell ids.
inline void AddVerticesAndLines(vtkPolyData* mesh, int vertices, int lines)
{
  using Cells = std::vector<std::vector<vtkIdType>>;
  mesh->SetVerts(MakePolygons(Cells(static_cast<std::size_t>(vertices), { 0 })));
  mesh->SetLines(MakePolygons(Cells(static_cast<std::size_t>(lines), { 0, 1 })));
}

/// An array vtkGhostType in which some elements have a mark.
inline vtkSmartPointer<vtkUnsignedCharArray> MakeGhosts(
  vtkIdType tuples, const std::vector<vtkIdType>& ids, unsigned char mark)
{
  auto ghosts = vtkSmartPointer<vtkUnsignedCharArray>::New();
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(tuples);
  ghosts->FillValue(0);
  for (const vtkIdType id : ids)
  {
    ghosts->SetValue(id, mark);
  }
  return ghosts;
}

/// A mesh or a pair with every point moved by a function.
template <typename Move>
vtkSmartPointer<vtkPolyData> Moved(vtkPolyData* mesh, Move&& move)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(mesh->GetPoints()->GetDataType());
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    const Point moved = move(PointOf(mesh, i));
    points->InsertNextPoint(moved.data());
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(mesh);
  result->SetPoints(points);
  return result;
}
template <typename Move>
MeshPair Moved(const MeshPair& pair, Move&& move)
{
  return { Moved(pair.Source, move), Moved(pair.Target, move) };
}

/// All coordinates multiplied by a factor.
template <typename Mesh>
auto Resized(const Mesh& mesh, double factor)
{
  return Moved(mesh, [factor](const Point& p) { return factor * p; });
}

inline vtkSmartPointer<vtkPolyData> Mirrored(vtkPolyData* mesh)
{
  return Moved(mesh, [](const Point& p) -> Point { return { -p[0], p[1], p[2] }; });
}

/// A deep copy.
template <typename Data>
vtkSmartPointer<Data> CopyOf(Data* data)
{
  auto copy = vtkSmartPointer<Data>::Take(data->NewInstance());
  copy->DeepCopy(data);
  return copy;
}
inline MeshPair CopyOf(const MeshPair& pair)
{
  return { CopyOf(pair.Source.Get()), CopyOf(pair.Target.Get()) };
}

/// The kinds of pairs: planar (a square and another square, a sheared one with many discordant
/// triangles, one in a tilted plane, and both in planes of constant x and y), surfaces with
/// boundary, a plane and a surface, and closed surfaces.
struct Pairing
{
  const char* Name;
  MeshPair Meshes;
};

inline Matrix Tilt()
{
  return Rotation({ 1.0, -2.0, 0.7 }, 0.9);
}

inline vtkSmartPointer<vtkPolyData> Tilted(
  vtkPolyData* mesh, const Matrix& rotation, const Point& shift)
{
  return Moved(mesh, [&](const Point& p) { return rotation * p + shift; });
}

/// x and y become y and z.
inline vtkSmartPointer<vtkPolyData> Upright(vtkPolyData* mesh)
{
  return Moved(mesh, [](const Point& p) -> Point { return { p[2], p[0], p[1] }; });
}

inline vtkSmartPointer<vtkPolyData> Sheared(vtkPolyData* mesh)
{
  return Moved(mesh, [](const Point& p) -> Point { return { p[0] + 1.2 * p[1], p[1], p[2] }; });
}

inline std::vector<Pairing> AllPairings(int n, int divisions, std::uint64_t seed)
{
  const MeshPair planar = MakePlanarPair(n, seed);
  const MeshPair closed = MakeClosedPair(divisions, seed + 4);
  return { { "planar", planar }, { "sheared", { planar.Source, Sheared(planar.Target) } },
    { "tilted", { planar.Source, Tilted(planar.Target, Tilt(), { 1.0, 2.0, 3.0 }) } },
    { "upright", { Upright(planar.Source), Upright(Upright(planar.Target)) } },
    { "sheets", { MakeSheet(n, seed + 2, 0.5), MakeSheet(n, seed + 3, 1.2) } },
    { "plane to sheet", { planar.Source, MakeSheet(n, seed + 3, 1.2) } }, { "closed", closed } };
}

// --- Random points -------------------------------------------------------------------------------

/// A point of a mesh: a triangle and the weights of its three points.
struct MeshPoint
{
  vtkIdType Triangle;
  Point Weights;
};

/// Everywhere in the triangles; one in four on an edge, or close to an edge or a vertex at any
/// power of ten down to rounding.
inline std::vector<MeshPoint> RandomSamples(vtkPolyData* mesh, vtkIdType count, std::uint64_t seed)
{
  Random random(seed);
  std::vector<MeshPoint> samples(count);
  for (MeshPoint& surfacePoint : samples)
  {
    surfacePoint.Triangle = random.Below(mesh->GetNumberOfCells());
    surfacePoint.Weights = random.Weights();
    const vtkIdType kind = random.Below(12);
    if (kind < 3)
    {
      const auto k = static_cast<std::size_t>(random.Below(3));
      const double small = kind == 0
        ? 0.0
        : 0.5 * std::pow(10.0, random.Uniform(-17.0, 0.0)) * surfacePoint.Weights[k];
      const double t = random.Uniform();
      const double next = kind == 2 ? small * t : t * (1.0 - small);
      surfacePoint.Weights[k] = small;
      surfacePoint.Weights[(k + 1) % 3] = next;
      surfacePoint.Weights[(k + 2) % 3] = 1.0 - small - next;
    }
  }
  return samples;
}

/// Inside triangles, with all weights at least @a margin.
inline std::vector<MeshPoint> InnerSamples(
  vtkPolyData* mesh, vtkIdType count, std::uint64_t seed, double margin)
{
  Random random(seed);
  std::vector<MeshPoint> samples(count);
  for (MeshPoint& surfacePoint : samples)
  {
    surfacePoint = { random.Below(mesh->GetNumberOfCells()), random.Weights(margin) };
  }
  return samples;
}

inline std::array<Point, 3> CornersOf(vtkPolyData* mesh, vtkIdType triangle)
{
  const std::vector<vtkIdType> ids = IdsOf(mesh, triangle);
  return { PointOf(mesh, ids[0]), PointOf(mesh, ids[1]), PointOf(mesh, ids[2]) };
}

/// Perpendicular to a triangle, and as long as twice its area.
inline Point NormalOf(vtkPolyData* mesh, vtkIdType triangle)
{
  const auto [a, b, c] = CornersOf(mesh, triangle);
  return Cross(b - a, c - a);
}

inline Point PositionOf(vtkPolyData* mesh, const MeshPoint& surfacePoint)
{
  const auto& [triangle, w] = surfacePoint;
  const auto [a, b, c] = CornersOf(mesh, triangle);
  return w[0] * a + w[1] * b + w[2] * c;
}

/// The point with these barycentric weights in a triangle.
inline Point PointIn(vtkPolyData* mesh, const Triangle& triangle, const Point& weights)
{
  return weights[0] * PointOf(mesh, triangle[0]) + weights[1] * PointOf(mesh, triangle[1]) +
    weights[2] * PointOf(mesh, triangle[2]);
}

/// Some points in every triangle.
inline std::vector<Point> SamplePoints(
  vtkPolyData* mesh, const std::vector<Triangle>& triangles, int perTriangle, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Point> points;
  for (const Triangle& triangle : triangles)
  {
    for (int n = 0; n < perTriangle; ++n)
    {
      points.push_back(PointIn(mesh, triangle, random.Weights(1e-4)));
    }
  }
  return points;
}

inline vtkSmartPointer<vtkPolyData> MakeCloud(
  vtkPolyData* mesh, const std::vector<MeshPoint>& samples)
{
  std::vector<Point> positions;
  for (const MeshPoint& surfacePoint : samples)
  {
    positions.push_back(PositionOf(mesh, surfacePoint));
  }
  return MakeCloud(positions);
}

} // namespace fixtures

#endif
