// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Measure.h"

#include "vtkDataArray.h"
#include "vtkDifferentiableHomeomorphism.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

namespace
{

using Homeomorphism = vtkSmartPointer<vtkDifferentiableHomeomorphism>;

Homeomorphism MakeHomeomorphism(vtkPolyData* source, vtkPolyData* target, int coordinateSystem)
{
  const auto map = Homeomorphism::New();
  map->SetSourceData(source);
  map->SetTargetData(target);
  map->SetCoordinateSystem(coordinateSystem);
  map->SetDiscordantTriangles(vtkDifferentiableHomeomorphism::CARRY_BY_LINEAR);
  return map;
}

vtkPointSet* GetOutput(vtkDifferentiableHomeomorphism* map)
{
  map->Update();
  return vtkPointSet::SafeDownCast(map->GetOutputDataObject(0));
}

/// A grid of points over the mesh's bounding box.
vtkSmartPointer<vtkImageData> GridOver(vtkPolyData* mesh, int size)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  auto grid = vtkSmartPointer<vtkImageData>::New();
  grid->SetDimensions(size, size, 1);
  grid->SetOrigin(bounds[0], bounds[2], 0.0);
  grid->SetSpacing((bounds[1] - bounds[0]) / (size - 1), (bounds[3] - bounds[2]) / (size - 1), 1.0);
  return grid;
}

/// Points on either side of the interior edges: for each of 3 points of an edge, two at a small
/// distance to its left, the second twice as far away, and two to its right.
vtkSmartPointer<vtkPolyData> PointsBesideEdges(vtkPolyData* mesh)
{
  mesh->BuildLinks();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdList> corners;
  vtkNew<vtkIdList> neighbors;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    mesh->GetCellPoints(cell, corners);
    for (int k = 0; k < 3; ++k)
    {
      const vtkIdType start = corners->GetId(k);
      const vtkIdType end = corners->GetId((k + 1) % 3);
      mesh->GetCellEdgeNeighbors(cell, start, end, neighbors);
      if (neighbors->GetNumberOfIds() != 1 || neighbors->GetId(0) < cell)
      {
        continue;
      }
      double a[3];
      double b[3];
      mesh->GetPoint(start, a);
      mesh->GetPoint(end, b);
      for (const double t : { 0.25, 0.5, 0.75 })
      {
        for (const double distance : { 1e-5, 2e-5, -1e-5, -2e-5 })
        {
          points->InsertNextPoint(a[0] + t * (b[0] - a[0]) - distance * (b[1] - a[1]),
            a[1] + t * (b[1] - a[1]) + distance * (b[0] - a[0]), 0.0);
        }
      }
    }
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(points);
  return result;
}

double LargestJump(vtkPolyData* source, vtkPolyData* target, int coordinateSystem)
{
  const Homeomorphism map = MakeHomeomorphism(source, target, coordinateSystem);
  map->SetDataObject(PointsBesideEdges(source));
  map->ComputeJacobianOn();
  vtkDataArray* jacobians = GetOutput(map)->GetPointData()->GetArray("Jacobian");
  double largest = 0.0;
  for (vtkIdType i = 0; i < jacobians->GetNumberOfTuples(); i += 4)
  {
    std::array<std::array<double, 9>, 4> beside;
    for (int k = 0; k < 4; ++k)
    {
      jacobians->GetTuple(i + k, beside[k].data());
    }
    double difference = 0.0;
    double size = 0.0;
    for (const int entry : { 0, 1, 3, 4 })
    {
      // The limits at the edge, extrapolated from the two distances.
      const double left = 2.0 * beside[0][entry] - beside[1][entry];
      const double right = 2.0 * beside[2][entry] - beside[3][entry];
      difference = std::hypot(difference, left - right);
      size = std::hypot(size, 0.5 * (left + right));
    }
    largest = std::max(largest, difference / size);
  }
  return largest;
}

} // namespace

Measurements Measure(vtkPolyData* source, vtkPolyData* target, int coordinateSystem)
{
  Measurements result;
  result.LargestJump = LargestJump(source, target, coordinateSystem);

  const auto grid = GridOver(source, 1001);
  const Homeomorphism forward = MakeHomeomorphism(source, target, coordinateSystem);
  forward->SetDataObject(grid);
  forward->ComputeJacobianDeterminantOn();
  const Homeomorphism backward = MakeHomeomorphism(source, target, coordinateSystem);
  backward->SetDataConnection(forward->GetOutputPort());
  backward->InverseOn();
  vtkPointSet* returned = GetOutput(backward);
  result.TrianglesRefused = forward->GetNumberOfDiscordantTriangles();
  result.PointsOutside = forward->GetNumberOfOutsidePoints();
  result.PointsMapped = grid->GetNumberOfPoints() - result.PointsOutside;

  vtkDataArray* mask = returned->GetPointData()->GetArray("ValidPointMask");
  vtkDataArray* determinants = returned->GetPointData()->GetArray("JacobianDeterminant");
  result.RoundTripError = 0.0;
  result.SmallestDeterminant = VTK_DOUBLE_MAX;
  for (vtkIdType i = 0; i < returned->GetNumberOfPoints(); ++i)
  {
    if (mask->GetTuple1(i) == 0.0)
    {
      continue;
    }
    double before[3];
    double after[3];
    grid->GetPoint(i, before);
    returned->GetPoint(i, after);
    result.RoundTripError =
      std::max(result.RoundTripError, std::sqrt(vtkMath::Distance2BetweenPoints(before, after)));
    result.SmallestDeterminant = std::min(result.SmallestDeterminant, determinants->GetTuple1(i));
  }

  // The meshes have been read by then, so that only the mapping is timed.
  forward->ComputeJacobianDeterminantOff();
  std::vector<double> times;
  for (int run = 0; run < 5; ++run)
  {
    forward->Modified();
    const auto begin = std::chrono::steady_clock::now();
    forward->Update();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    times.push_back(1e9 * seconds.count() / static_cast<double>(grid->GetNumberOfPoints()));
  }
  std::sort(times.begin(), times.end());
  result.NanosecondsPerPoint = times[times.size() / 2];
  return result;
}
