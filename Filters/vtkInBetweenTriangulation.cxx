// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkInBetweenTriangulation.h"

#include "Construction/InBetweenPath.h"
#include "Kernel/ExactSign.h"
#include "Mesh/Homeomorphism.h"
#include "Pipeline/Requests.h"

#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

using namespace homeomorphism;

vtkStandardNewMacro(vtkInBetweenTriangulation);

namespace
{

/// The two axes of the planes of both meshes if both planes are parallel to the same two axes.
std::optional<std::array<int, 2>> FindPlaneAxes(vtkPolyData* source, vtkPolyData* target)
{
  double bounds[2][6];
  source->GetBounds(bounds[0]);
  target->GetBounds(bounds[1]);
  for (const int axis : { 2, 1, 0 })
  {
    if (bounds[0][2 * axis] == bounds[0][2 * axis + 1] &&
      bounds[1][2 * axis] == bounds[1][2 * axis + 1])
    {
      return axis == 2 ? std::array<int, 2>{ 0, 1 }
        : axis == 1    ? std::array<int, 2>{ 0, 2 }
                       : std::array<int, 2>{ 1, 2 };
    }
  }
  return std::nullopt;
}

/// A planar pair in coordinates of its plane, and its unmasked triangles.
struct PlanePair
{
  std::array<std::vector<Vector2>, 2> Points;
  /// The scale of the coordinates, a power of two, so that areas do not underflow.
  double Scale = 1.0;
  std::vector<std::array<std::int64_t, 3>> Triangles;
  std::vector<TriangleIndex> Numbers;

  PlanePair(const std::array<vtkPolyData*, 2>& meshes, const std::array<int, 2>& axes,
    const Triangulation& triangulation)
  {
    const vtkIdType count = meshes[0]->GetNumberOfPoints();
    std::vector<bool> used(static_cast<std::size_t>(count), false);
    for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
    {
      if (triangulation.IsMasked(t))
      {
        continue;
      }
      const Triangulation::Corners& corners = triangulation.GetCorners(t);
      this->Triangles.push_back({ corners[0], corners[1], corners[2] });
      this->Numbers.push_back(t);
      for (const std::int32_t corner : corners)
      {
        used[static_cast<std::size_t>(corner)] = true;
      }
    }
    double largest = 0.0;
    for (std::size_t side = 0; side < 2; ++side)
    {
      this->Points[side].assign(used.size(), Vector2{ 0.0, 0.0 });
      for (vtkIdType i = 0; i < count; ++i)
      {
        double p[3];
        meshes[side]->GetPoint(i, p);
        const Vector2 point{ p[axes[0]], p[axes[1]] };
        this->Points[side][static_cast<std::size_t>(i)] = point;
        if (used[static_cast<std::size_t>(i)])
        {
          largest = std::max({ largest, std::abs(point.x), std::abs(point.y) });
        }
      }
    }
    this->Scale = PowerOfTwoNear(largest);
    for (std::vector<Vector2>& points : this->Points)
    {
      for (Vector2& point : points)
      {
        point = (1.0 / this->Scale) * point;
      }
    }
    this->Used = std::move(used);
  }

  /// The path fitted to the points of triangles.
  InBetweenPath MakePath(bool rotating) const
  {
    std::array<std::vector<Vector2>, 2> used;
    for (std::size_t side = 0; side < 2; ++side)
    {
      for (std::size_t i = 0; i < this->Used.size(); ++i)
      {
        if (this->Used[i])
        {
          used[side].push_back(this->Points[side][i]);
        }
      }
    }
    return InBetweenPath(used[0], used[1], rotating);
  }

private:
  std::vector<bool> Used;
};

} // namespace

vtkInBetweenTriangulation::vtkInBetweenTriangulation()
{
  this->SetNumberOfInputPorts(2);
}

vtkInBetweenTriangulation::~vtkInBetweenTriangulation() = default;

vtkPolyData* vtkInBetweenTriangulation::GetOutput(int port)
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(port));
}

int vtkInBetweenTriangulation::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  return 1;
}

int vtkInBetweenTriangulation::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->CheckInputTypes(inputs);
  MakeOutput<vtkPolyData>(outputs->GetInformationObject(0));
  return 1;
}

int vtkInBetweenTriangulation::Execute(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* source = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* target = vtkPolyData::GetData(inputs[1]);
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  this->UsedPath = STRAIGHT;
  this->RotationAngle = 0.0;
  this->ScaleFactor = 1.0;
  this->Planar = false;
  this->Mirrored = false;
  this->NumberOfFoldingTriangles = 0;
  this->FirstFoldingTriangle = -1;
  this->FirstFoldTime = 1.0;
  this->LastFoldTime = 0.0;
  this->NumberOfFoldedTriangles = 0;

  const std::shared_ptr<const Homeomorphism> map = this->GetMap(source, target);
  if (!map)
  {
    return 0;
  }
  if (!IsFirstPiece(request, outputs))
  {
    return 1;
  }
  const Triangulation& triangulation = map->GetPair().GetTriangulation();
  const vtkIdType numberOfPoints = source->GetNumberOfPoints();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(numberOfPoints);
  const double time = this->Time;
  const auto moveStraight = [&](vtkIdType i, double between[3]) {
    double from[3];
    double to[3];
    source->GetPoint(i, from);
    target->GetPoint(i, to);
    for (int axis = 0; axis < 3; ++axis)
    {
      between[axis] = time <= 0.0 ? from[axis]
        : time >= 1.0             ? to[axis]
                                  : (1.0 - time) * from[axis] + time * to[axis];
    }
  };
  // The first call of GetPoint may change internal data, so call it before the threads do.
  double first[3];
  if (numberOfPoints > 0)
  {
    source->GetPoint(0, first);
    target->GetPoint(0, first);
  }
  vtkSMPTools::For(0, numberOfPoints, [&](vtkIdType begin, vtkIdType end) {
    for (vtkIdType i = begin; i < end; ++i)
    {
      double between[3];
      moveStraight(i, between);
      points->SetPoint(i, between);
    }
  });

  vtkNew<vtkUnsignedCharArray> folded;
  folded->SetName("Folded");
  folded->SetNumberOfTuples(source->GetNumberOfCells());
  folded->FillValue(0);
  const auto axes = FindPlaneAxes(source, target);
  if (axes && triangulation.GetNumberOfTriangles() > 0)
  {
    this->Planar = true;
    const PlanePair plane({ source, target }, *axes, triangulation);
    const auto orientation = [&plane](std::size_t side, std::size_t triangle) {
      const auto& corners = plane.Triangles[triangle];
      const std::vector<Vector2>& all = plane.Points[side];
      return Orientation(all[static_cast<std::size_t>(corners[0])],
        all[static_cast<std::size_t>(corners[1])], all[static_cast<std::size_t>(corners[2])]);
    };
    this->Mirrored = !plane.Triangles.empty() && orientation(0, 0) != orientation(1, 0);

    InBetweenPath path = plane.MakePath(this->Path == ROTATING);
    PathFolds folds = path.FindFolds(plane.Triangles, plane.Points[0], plane.Points[1]);
    this->UsedPath = this->Path == ROTATING ? ROTATING : STRAIGHT;
    if (this->Path == FEWEST_FOLDS && folds.Triangles > 0)
    {
      const InBetweenPath other = plane.MakePath(true);
      const PathFolds otherFolds =
        other.FindFolds(plane.Triangles, plane.Points[0], plane.Points[1]);
      if (otherFolds.Triangles < folds.Triangles)
      {
        path = other;
        folds = otherFolds;
        this->UsedPath = ROTATING;
      }
    }
    this->RotationAngle = vtkMath::DegreesFromRadians(path.GetAngle());
    this->ScaleFactor = path.GetFactor();
    this->NumberOfFoldingTriangles = folds.Triangles;
    this->FirstFoldTime = folds.Begin;
    this->LastFoldTime = folds.End;
    this->FirstFoldingTriangle = folds.FirstTriangle < 0
      ? -1
      : triangulation.GetCellId(plane.Numbers[static_cast<std::size_t>(folds.FirstTriangle)]);

    std::vector<Vector2> moved(plane.Points[0].size());
    vtkSMPTools::For(0, numberOfPoints, [&](vtkIdType begin, vtkIdType end) {
      for (vtkIdType i = begin; i < end; ++i)
      {
        double between[3];
        points->GetPoint(i, between);
        if (this->UsedPath == ROTATING && time > 0.0 && time < 1.0)
        {
          const auto n = static_cast<std::size_t>(i);
          const Vector2 p =
            plane.Scale * path.GetPosition(plane.Points[0][n], plane.Points[1][n], time);
          between[(*axes)[0]] = p.x;
          between[(*axes)[1]] = p.y;
          points->SetPoint(i, between);
        }
        moved[static_cast<std::size_t>(i)] =
          (1.0 / plane.Scale) * Vector2{ between[(*axes)[0]], between[(*axes)[1]] };
      }
    });
    for (std::size_t t = 0; t < plane.Triangles.size(); ++t)
    {
      const auto& corners = plane.Triangles[t];
      if (Orientation(moved[static_cast<std::size_t>(corners[0])],
            moved[static_cast<std::size_t>(corners[1])],
            moved[static_cast<std::size_t>(corners[2])]) != orientation(0, t))
      {
        folded->SetValue(triangulation.GetCellId(plane.Numbers[t]), 1);
        ++this->NumberOfFoldedTriangles;
      }
    }
  }

  output->ShallowCopy(source);
  output->SetPoints(points);
  output->GetCellData()->AddArray(folded);
  return 1;
}

void vtkInBetweenTriangulation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Time: " << this->Time << "\n";
  os << indent << "Path: " << this->Path << "\n";
  os << indent << "UsedPath: " << this->UsedPath << "\n";
  os << indent << "RotationAngle: " << this->RotationAngle << "\n";
  os << indent << "ScaleFactor: " << this->ScaleFactor << "\n";
  os << indent << "Planar: " << this->Planar << "\n";
  os << indent << "Mirrored: " << this->Mirrored << "\n";
  os << indent << "NumberOfFoldingTriangles: " << this->NumberOfFoldingTriangles << "\n";
  os << indent << "FirstFoldingTriangle: " << this->FirstFoldingTriangle << "\n";
  os << indent << "FirstFoldTime: " << this->FirstFoldTime << "\n";
  os << indent << "LastFoldTime: " << this->LastFoldTime << "\n";
  os << indent << "NumberOfFoldedTriangles: " << this->NumberOfFoldedTriangles << "\n";
}
