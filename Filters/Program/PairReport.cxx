// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PairReport.h"

#include "Pipeline/DiagnosticMessages.h"

#include "Command.h"
#include "Failure.h"
#include "MeshParts.h"

#include "Mesh/TriangulationPair.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDifferentiableHomeomorphism.h"
#include "vtkJacobianContinuity.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkTriangularCoordinates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace dhm
{
namespace
{

using homeomorphism::Domain;
using homeomorphism::MeshDiagnostic;
using homeomorphism::MeshDiagnostics;
using homeomorphism::Triangulation;
using homeomorphism::TriangulationPair;
using homeomorphism::Twin;
using TriangleIndex = homeomorphism::TriangleIndex;

void TakeLarger(Extreme& extreme, double value, vtkIdType cell)
{
  if (extreme.Cell < 0 || value > extreme.Value)
  {
    extreme = { value, cell };
  }
}

void TakeSmaller(Extreme& extreme, double value, vtkIdType cell)
{
  if (extreme.Cell < 0 || value < extreme.Value)
  {
    extreme = { value, cell };
  }
}

void CountPoints(vtkPolyData* mesh, MeshReport& report)
{
  report.Points = mesh->GetNumberOfPoints();
  report.Triangles = mesh->GetNumberOfPolys();

  std::vector<bool> used(static_cast<std::size_t>(report.Points), false);
  ForEachCell(mesh->GetPolys(), [&used](vtkIdType, vtkIdType count, const vtkIdType* points) {
    std::for_each(points, points + count, [&used](vtkIdType point) {
      if (point >= 0 && point < static_cast<vtkIdType>(used.size()))
      {
        used[static_cast<std::size_t>(point)] = true;
      }
    });
  });
  report.UnusedPoints = std::count(used.begin(), used.end(), false);

  std::vector<vtkIdType> order(static_cast<std::size_t>(report.Points));
  std::iota(order.begin(), order.end(), vtkIdType(0));
  std::vector<std::array<double, 3>> places(order.size());
  for (const vtkIdType point : order)
  {
    mesh->GetPoint(point, places[static_cast<std::size_t>(point)].data());
  }
  const auto place = [&places](vtkIdType point) { return places[static_cast<std::size_t>(point)]; };
  // What is no number would leave the order undefined, and is reported otherwise.
  order.erase(std::remove_if(order.begin(), order.end(),
                [&place](vtkIdType point) {
                  const auto p = place(point);
                  return std::any_of(p.begin(), p.end(), [](double x) { return std::isnan(x); });
                }),
    order.end());
  std::stable_sort(
    order.begin(), order.end(), [&place](vtkIdType a, vtkIdType b) { return place(a) < place(b); });
  std::vector<vtkIdType> duplicates;
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    if (place(order[i]) == place(order[i - 1]))
    {
      duplicates.push_back(order[i]);
    }
  }
  std::sort(duplicates.begin(), duplicates.end());
  report.DuplicatePoints = static_cast<vtkIdType>(duplicates.size());
  duplicates.resize(std::min<std::size_t>(duplicates.size(), 10));
  report.FirstDuplicates = duplicates;
}

/// Cells whose points come in another order in the target.
vtkIdType CountReordered(vtkPolyData* source, vtkPolyData* target)
{
  const auto a = vtk::TakeSmartPointer(source->GetPolys()->NewIterator());
  const auto b = vtk::TakeSmartPointer(target->GetPolys()->NewIterator());
  vtkIdType reordered = 0;
  for (a->GoToFirstCell(), b->GoToFirstCell();
       !a->IsDoneWithTraversal() && !b->IsDoneWithTraversal(); a->GoToNextCell(), b->GoToNextCell())
  {
    vtkIdType counts[2];
    const vtkIdType* points[2];
    a->GetCurrentCell(counts[0], points[0]);
    b->GetCurrentCell(counts[1], points[1]);
    reordered += !std::equal(points[0], points[0] + counts[0], points[1], points[1] + counts[1]);
  }
  return reordered;
}

/// Components, edges, and windings that contradict most of their component.
void CountConnections(const Triangulation& triangulation, PairReport& report)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  // 0: not reached yet; 1 and -1: wound as the component's first triangle, or otherwise.
  std::vector<signed char> winding(static_cast<std::size_t>(count), 0);
  for (TriangleIndex first = 0; first < count; ++first)
  {
    if (winding[static_cast<std::size_t>(first)] != 0 || triangulation.IsMasked(first))
    {
      continue;
    }
    ++report.Components;
    std::vector<TriangleIndex> reached{ first };
    winding[static_cast<std::size_t>(first)] = 1;
    vtkIdType otherwise = 0;
    for (std::size_t i = 0; i < reached.size(); ++i)
    {
      const TriangleIndex triangle = reached[i];
      const signed char own = winding[static_cast<std::size_t>(triangle)];
      otherwise += own < 0;
      for (int edge = 0; edge < 3; ++edge)
      {
        const Twin across = triangulation.GetTwin(triangle, edge);
        if (across.Triangle < 0)
        {
          ++report.BoundaryEdges;
          continue;
        }
        report.InteriorEdges += across.Triangle > triangle;
        auto& neighbor = winding[static_cast<std::size_t>(across.Triangle)];
        if (neighbor == 0)
        {
          neighbor = static_cast<signed char>(across.SameDirection ? -own : own);
          reached.push_back(across.Triangle);
        }
      }
    }
    report.MendedWindings +=
      std::min(otherwise, static_cast<vtkIdType>(reached.size()) - otherwise);
  }
}

/// From a boundary edge of a triangle and one of its ends, the next boundary edge around that end.
void StepAlongBoundary(
  const Triangulation& triangulation, TriangleIndex& triangle, int& edge, std::int32_t& end)
{
  // Edge k is opposite corner k: of the two edges at a corner, the other one.
  const auto other = [&triangulation](TriangleIndex t, int e, std::int32_t corner) {
    const auto& corners = triangulation.GetCorners(t);
    for (int k = 0; k < 3; ++k)
    {
      if (k != e && corners[static_cast<std::size_t>(k)] != corner)
      {
        return k;
      }
    }
    return e;
  };
  edge = other(triangle, edge, end);
  for (Twin across = triangulation.GetTwin(triangle, edge); across.Triangle >= 0;
       across = triangulation.GetTwin(triangle, edge))
  {
    triangle = across.Triangle;
    edge = other(triangle, across.Edge, end);
  }
  for (int k = 0; k < 3; ++k)
  {
    const std::int32_t corner = triangulation.GetCorners(triangle)[static_cast<std::size_t>(k)];
    if (k != edge && corner != end)
    {
      end = corner;
      return;
    }
  }
}

vtkIdType CountBoundaryLoops(const Triangulation& triangulation)
{
  const TriangleIndex count = triangulation.GetNumberOfTriangles();
  std::vector<std::array<bool, 3>> seen(static_cast<std::size_t>(count), { false, false, false });
  vtkIdType loops = 0;
  for (TriangleIndex first = 0; first < count; ++first)
  {
    for (int edge = 0; edge < 3; ++edge)
    {
      if (triangulation.IsMasked(first) || triangulation.GetTwin(first, edge).Triangle >= 0 ||
        seen[static_cast<std::size_t>(first)][static_cast<std::size_t>(edge)])
      {
        continue;
      }
      ++loops;
      TriangleIndex triangle = first;
      int current = edge;
      std::int32_t end = triangulation.GetCorners(first)[static_cast<std::size_t>((edge + 1) % 3)];
      do
      {
        seen[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(current)] = true;
        StepAlongBoundary(triangulation, triangle, current, end);
      } while (!seen[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(current)]);
    }
  }
  return loops;
}

using Vector = std::array<double, 3>;

Vector SideOf(vtkPolyData* mesh, std::int32_t from, std::int32_t to)
{
  Vector a;
  Vector b;
  mesh->GetPoint(from, a.data());
  mesh->GetPoint(to, b.data());
  return { b[0] - a[0], b[1] - a[1], b[2] - a[2] };
}

/// A triangle as two sides in its own plane: the first along x.
struct FlatTriangle
{
  double Length;
  double X;
  double Y;
};

FlatTriangle Flatten(vtkPolyData* mesh, const Triangulation::Corners& corners)
{
  const Vector u = SideOf(mesh, corners[0], corners[1]);
  const Vector v = SideOf(mesh, corners[0], corners[2]);
  Vector normal;
  vtkMath::Cross(u.data(), v.data(), normal.data());
  const double length = vtkMath::Norm(u.data());
  return { length, vtkMath::Dot(u.data(), v.data()) / length,
    vtkMath::Norm(normal.data()) / length };
}

void MeasureShapes(const MeshPair& pair, const Triangulation& triangulation, PairReport& report)
{
  for (TriangleIndex triangle = 0; triangle < triangulation.GetNumberOfTriangles(); ++triangle)
  {
    if (triangulation.IsMasked(triangle))
    {
      continue;
    }
    const vtkIdType cell = triangulation.GetCellId(triangle);
    FlatTriangle flat[2];
    for (int side = 0; side < 2; ++side)
    {
      vtkPolyData* mesh = pair.Meshes[static_cast<std::size_t>(side)];
      flat[side] = Flatten(mesh, triangulation.GetCorners(triangle));
      for (int edge = 0; edge < 3; ++edge)
      {
        const TriangleIndex neighbor = triangulation.GetTwin(triangle, edge).Triangle;
        if (neighbor > triangle)
        {
          const FlatTriangle other = Flatten(mesh, triangulation.GetCorners(neighbor));
          const double ratio = flat[side].Length * flat[side].Y / (other.Length * other.Y);
          TakeLarger(report.Meshes[static_cast<std::size_t>(side)].LargestAreaRatio,
            std::max(ratio, 1.0 / ratio), cell);
        }
      }
    }
    // The linear map is upper triangular in the two frames; its singular values.
    const double a = flat[1].Length / flat[0].Length;
    const double d = flat[1].Y / flat[0].Y;
    const double b = (flat[1].X - a * flat[0].X) / flat[0].Y;
    const double sum = std::hypot(a + d, b);
    const double difference = std::hypot(a - d, b);
    const double largest = 0.5 * (sum + difference);
    // Their product is the determinant, which loses nothing where the difference would.
    const double smallest = a * d / largest;
    TakeLarger(report.LargestStretch, largest, cell);
    TakeSmaller(report.SmallestStretch, smallest, cell);
    TakeLarger(report.WorstDistortion, largest / smallest, cell);
  }
}

/// Concordance and angles, of the triangles that are valid in the pair. Those that are not have no
/// part in it: in one mesh alone, such a triangle may cover others, which would then be left out.
void MeasureTriangles(vtkPolyData* mesh, const Triangulation& triangulation, MeshReport& report)
{
  vtkNew<vtkCellArray> polygons;
  std::vector<vtkIdType> cells;
  for (TriangleIndex triangle = 0; triangle < triangulation.GetNumberOfTriangles(); ++triangle)
  {
    if (!triangulation.IsMasked(triangle))
    {
      const auto& corners = triangulation.GetCorners(triangle);
      polygons->InsertNextCell({ corners[0], corners[1], corners[2] });
      cells.push_back(triangulation.GetCellId(triangle));
    }
  }
  if (cells.empty())
  {
    return;
  }
  vtkNew<vtkPolyData> valid;
  valid->SetPoints(mesh->GetPoints());
  valid->SetPolys(polygons);
  vtkNew<vtkTriangularCoordinates> coordinates;
  coordinates->SetInputDataObject(0, valid);
  coordinates->MaskInvalidTrianglesOn();
  coordinates->GenerateLinesOff();
  Run(coordinates, "Measuring triangles", false);
  vtkPolyData* measured = coordinates->GetTriangulation();
  vtkDataArray* concordant = measured->GetCellData()->GetArray("Concordant");
  vtkDataArray* angles = measured->GetCellData()->GetArray("SmallestAngle");
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    const auto triangle = static_cast<vtkIdType>(i);
    if (concordant->GetTuple1(triangle) == 0.0)
    {
      report.DiscordantTriangles.push_back(cells[i]);
    }
    TakeSmaller(report.SmallestAngle, angles->GetTuple1(triangle), cells[i]);
  }
}

/// Points evenly spread within the triangles, a number of them for each, and never more than about
/// two million.
struct Samples
{
  vtkNew<vtkPolyData> Points;
  std::vector<vtkIdType> Cells;
};

void MakeSamples(vtkPolyData* mesh, const Triangulation& triangulation, Samples& samples)
{
  constexpr double most = 2e6;
  int divisions = 16;
  const auto perTriangle = [](int n) { return (n - 1) * (n - 2) / 2; };
  while (divisions > 3 &&
    perTriangle(divisions) * static_cast<double>(triangulation.GetNumberOfTriangles()) > most)
  {
    --divisions;
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (TriangleIndex triangle = 0; triangle < triangulation.GetNumberOfTriangles(); ++triangle)
  {
    if (triangulation.IsMasked(triangle))
    {
      continue;
    }
    const auto& corners = triangulation.GetCorners(triangle);
    Vector p[3];
    for (std::size_t k = 0; k < 3; ++k)
    {
      mesh->GetPoint(corners[k], p[k].data());
    }
    for (int i = 1; i < divisions - 1; ++i)
    {
      for (int j = 1; j < divisions - i; ++j)
      {
        const double u = static_cast<double>(i) / divisions;
        const double v = static_cast<double>(j) / divisions;
        Vector point;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          point[axis] = (1.0 - u - v) * p[0][axis] + u * p[1][axis] + v * p[2][axis];
        }
        points->InsertNextPoint(point.data());
        samples.Cells.push_back(triangulation.GetCellId(triangle));
      }
    }
  }
  samples.Points->SetPoints(points);
}

/// How the map is measured in each system: what Contour lacks is Linear's, invalid triangles are
/// holes.
MapOptions MeasuredMap()
{
  MapOptions options;
  options.LinearWhereDiscordant = true;
  options.MaskInvalid = true;
  // On surfaces, points between the corners are off the surface by rounding.
  options.Tolerance = 1e-12;
  return options;
}

void MeasureDeterminants(
  const MeshPair& pair, const Triangulation& triangulation, PairReport& report)
{
  Samples samples;
  MakeSamples(pair.Source(), triangulation, samples);
  // One filter for all systems: it reads the meshes once.
  vtkNew<vtkDifferentiableHomeomorphism> map;
  MeasuredMap().ApplyTo(map.Get());
  map->SetSourceData(pair.Source());
  map->SetTargetData(pair.Target());
  map->SetDataObject(samples.Points);
  map->ComputeJacobianDeterminantOn();
  vtkSmartPointer<vtkPoints> linear;
  for (int system = 0; system < 3; ++system)
  {
    SystemReport& result = report.Systems[static_cast<std::size_t>(system)];
    map->SetCoordinateSystem(system);
    Run(map, std::string("Mapping with ") + SystemNames[system], false);
    auto* output = vtkPointSet::SafeDownCast(map->GetOutputDataObject(0));
    vtkDataArray* determinants = output->GetPointData()->GetArray("JacobianDeterminant");
    if (!linear)
    {
      linear = output->GetPoints();
    }
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      const double determinant = determinants->GetTuple1(i);
      if (std::isnan(determinant))
      {
        continue;
      }
      const vtkIdType cell = samples.Cells[static_cast<std::size_t>(i)];
      ++result.Samples;
      result.NotPositive += !(report.Mirrored ? determinant < 0.0 : determinant > 0.0);
      TakeSmaller(result.SmallestDeterminant, std::abs(determinant), cell);
      TakeLarger(result.LargestDeterminant, std::abs(determinant), cell);
      double a[3];
      double b[3];
      output->GetPoint(i, a);
      linear->GetPoint(i, b);
      TakeLarger(result.DistanceFromLinear, std::sqrt(vtkMath::Distance2BetweenPoints(a, b)), cell);
    }
  }
}

void MeasureContinuity(const MeshPair& pair, PairReport& report)
{
  vtkNew<vtkJacobianContinuity> continuity;
  continuity->SetDiscordantTriangles(vtkJacobianContinuity::USE_LINEAR);
  continuity->MaskInvalidTrianglesOn();
  continuity->SetSourceData(pair.Source());
  continuity->SetTargetData(pair.Target());
  for (int system = 0; system < 3; ++system)
  {
    SystemReport& result = report.Systems[static_cast<std::size_t>(system)];
    continuity->SetCoordinateSystem(system);
    Run(continuity, std::string("Measuring the continuity of ") + SystemNames[system], false);
    result.ContinuityMeasured = true;
    result.DifferentiableEdges = continuity->GetNumberOfDifferentiableEdges();
    result.Creases = continuity->GetNumberOfCreases();
    result.UndecidedEdges = continuity->GetNumberOfUndecidedEdges();
    result.LargestJump = continuity->GetLargestJump();
  }
}

void RequireMap(const MeshPair& pair, bool maskInvalid, const std::string& advice)
{
  MeshDiagnostics problems;
  if (!TriangulationPair::Read(pair.Source(), pair.Target(), maskInvalid, problems))
  {
    std::string text;
    for (const MeshDiagnostic& problem : problems)
    {
      if (problem.Result == MeshDiagnostic::Outcome::Refused)
      {
        text += (text.empty() ? "" : "\n") + Describe(problem, advice);
      }
    }
    throw Failure(REFUSED, pair.GetName() + ": " + text);
  }
}

/// What there is to know about the meshes of a pair, some of whose triangles may be left out.
void DescribePair(const MeshPair& pair, const TriangulationPair& read, PairReport& report)
{
  const Triangulation& triangulation = read.GetTriangulation();
  for (std::size_t side = 0; side < 2; ++side)
  {
    report.Meshes[side].Planar = read.GetGeometry(static_cast<Domain>(side)).IsPlanar();
    MeasureTriangles(pair.Meshes[side], triangulation, report.Meshes[side]);
  }
  for (TriangleIndex triangle = 0; triangle < triangulation.GetNumberOfTriangles(); ++triangle)
  {
    if (triangulation.IsMasked(triangle))
    {
      report.InvalidTriangles.push_back(triangulation.GetCellId(triangle));
    }
  }
  report.ReorderedTriangles = CountReordered(pair.Source(), pair.Target());
  CountConnections(triangulation, report);
  report.BoundaryLoops = CountBoundaryLoops(triangulation);
  if (report.Components == 0)
  {
    return;
  }
  if (report.Meshes[0].Planar && report.Meshes[1].Planar)
  {
    TriangleIndex first = 0;
    while (triangulation.IsMasked(first))
    {
      ++first;
    }
    const auto& corners = triangulation.GetCorners(first);
    report.Mirrored = read.GetGeometry(Domain::Source).GetOrientation(corners) !=
      read.GetGeometry(Domain::Target).GetOrientation(corners);
  }
  MeasureShapes(pair, triangulation, report);
  report.Measured = true;
}

} // namespace

PairReport CheckPair(const MeshPair& pair, const CheckExtent& extent,
  const std::function<void(const PairReport& report)>& onMeshes)
{
  PairReport report;
  for (std::size_t side = 0; side < 2; ++side)
  {
    CountPoints(pair.Meshes[side], report.Meshes[side]);
  }
  // Leaving defective triangles out finds all kinds of defects, and lets the rest be measured.
  const auto read = TriangulationPair::Read(pair.Source(), pair.Target(), true, report.Problems);
  report.Valid = report.Problems.empty() && read;
  if (read)
  {
    DescribePair(pair, *read, report);
  }
  else
  {
    for (const MeshDiagnostic& problem : report.Problems)
    {
      report.InvalidTriangles.insert(
        report.InvalidTriangles.end(), problem.Ids.begin(), problem.Ids.end());
    }
    std::sort(report.InvalidTriangles.begin(), report.InvalidTriangles.end());
  }
  onMeshes(report);
  if (report.Measured && extent.Determinants)
  {
    MeasureDeterminants(pair, read->GetTriangulation(), report);
  }
  if (report.Measured && extent.Continuity)
  {
    MeasureContinuity(pair, report);
  }
  return report;
}

bool IsUnwelded(const PairReport& report)
{
  // A mesh has about three edges for two triangles, and even a strip has one for each.
  return report.Measured && report.Meshes[0].DuplicatePoints > 0 &&
    report.Meshes[1].DuplicatePoints > 0 && 2 * report.InteriorEdges < report.Meshes[0].Triangles;
}

void RequireMap(const MeshPair& pair, const MapOptions& map)
{
  RequireMap(pair, map.MaskInvalid, ", or use --mask-invalid to leave them out");
}

void RequireMap(const MeshPair& pair)
{
  RequireMap(pair, false, "");
}

std::string Describe(const MeshDiagnostic& problem, const std::string& advice)
{
  MeshDiagnostic refused = problem;
  refused.Result = MeshDiagnostic::Outcome::Refused;
  std::string message = homeomorphism::Describe(refused);
  const std::string setter = ", or turn MaskInvalidTriangles on to leave them out";
  const std::size_t at = message.find(setter);
  if (at != std::string::npos)
  {
    message.replace(at, setter.size(), advice);
  }
  return NameOptions(message);
}

} // namespace dhm
