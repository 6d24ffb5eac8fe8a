// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "InBetween.h"

#include "MeshParts.h"

#include "vtkPoints.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dhm
{
namespace
{

/// Twice the area of a triangle on its way: a (1 - t)^2 + b t (1 - t) + c t^2, positive at the
/// start.
struct AreaOnTheWay
{
  double Start;
  double Middle;
  double End;

  double At(double t) const
  {
    return this->Start * (1.0 - t) * (1.0 - t) + this->Middle * t * (1.0 - t) + this->End * t * t;
  }
};

using Vector = std::array<double, 2>;

double Cross(const Vector& a, const Vector& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

Vector Side(vtkPolyData* mesh, vtkIdType from, vtkIdType to)
{
  double a[3];
  double b[3];
  mesh->GetPoint(from, a);
  mesh->GetPoint(to, b);
  return { b[0] - a[0], b[1] - a[1] };
}

/// Calls work(cell, area) for each triangle.
template <typename Work>
void ForEachTriangle(vtkPolyData* source, vtkPolyData* target, Work&& work)
{
  const vtkIdType first = FirstPolygon(source);
  ForEachCell(source->GetPolys(), [&](vtkIdType number, vtkIdType, const vtkIdType* corners) {
    const Vector u[2] = { Side(source, corners[0], corners[1]),
      Side(target, corners[0], corners[1]) };
    const Vector v[2] = { Side(source, corners[0], corners[2]),
      Side(target, corners[0], corners[2]) };
    AreaOnTheWay area{ Cross(u[0], v[0]), Cross(u[0], v[1]) + Cross(u[1], v[0]),
      Cross(u[1], v[1]) };
    // Files mix their winding.
    if (area.Start < 0.0)
    {
      area = { -area.Start, -area.Middle, -area.End };
    }
    work(first + number, area);
  });
}

} // namespace

vtkSmartPointer<vtkPolyData> InBetween(vtkPolyData* source, vtkPolyData* target, double t)
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->ShallowCopy(source);
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(source->GetNumberOfPoints());
  for (vtkIdType i = 0; i < source->GetNumberOfPoints(); ++i)
  {
    double from[3];
    double to[3];
    source->GetPoint(i, from);
    target->GetPoint(i, to);
    for (int axis = 0; axis < 3; ++axis)
    {
      from[axis] = (1.0 - t) * from[axis] + t * to[axis];
    }
    points->SetPoint(i, from);
  }
  mesh->SetPoints(points);
  return mesh;
}

Folds FindFolds(vtkPolyData* source, vtkPolyData* target)
{
  Folds folds;
  if (!IsFlat(source) || !IsFlat(target))
  {
    return folds;
  }
  vtkIdType mirrored = 0;
  vtkIdType triangles = 0;
  ForEachTriangle(source, target, [&](vtkIdType cell, const AreaOnTheWay& area) {
    ++triangles;
    if (area.End <= 0.0)
    {
      ++mirrored;
      return;
    }
    // The quadratic's least value is between the ends only if Middle is negative and large; with
    // both ends positive, its discriminant then tells whether there are roots between.
    const double root = std::sqrt(area.Start) * std::sqrt(area.End);
    if (area.Middle > -2.0 * root)
    {
      return;
    }
    // In s = t / (1 - t): End s^2 + Middle s + Start = 0.
    const double difference =
      std::sqrt(std::max(0.0, (-area.Middle - 2.0 * root) * (-area.Middle + 2.0 * root)));
    const double larger = (-area.Middle + difference) / (2.0 * area.End);
    const double smaller = 2.0 * area.Start / (-area.Middle + difference);
    const double begin = smaller / (1.0 + smaller);
    ++folds.Triangles;
    if (begin < folds.Begin)
    {
      folds.Begin = begin;
      folds.FirstCell = cell;
    }
    folds.End = std::max(folds.End, larger / (1.0 + larger));
  });
  folds.Mirrored = triangles > 0 && mirrored == triangles;
  return folds;
}

bool IsFolded(vtkPolyData* source, vtkPolyData* target, double t)
{
  bool folded = false;
  if (IsFlat(source) && IsFlat(target))
  {
    ForEachTriangle(source, target,
      [&](vtkIdType, const AreaOnTheWay& area) { folded = folded || area.At(t) <= 0.0; });
  }
  return folded;
}

} // namespace dhm
