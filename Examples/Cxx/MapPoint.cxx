// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Maps a point and maps its image back, with the Jacobian of the map.

#include <vtkCellArray.h>
#include <vtkHomeomorphismTransform.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <iostream>

int main()
{
  // A square of two triangles, one of whose corners has the given height: 1 in the source, 1.5 in
  // the target.
  vtkNew<vtkPolyData> source;
  vtkNew<vtkPolyData> target;
  const auto makeMesh = [](vtkPolyData* mesh, double height) {
    vtkNew<vtkPoints> points;
    points->InsertNextPoint(0.0, 0.0, 0.0);
    points->InsertNextPoint(1.0, 0.0, 0.0);
    points->InsertNextPoint(1.0, 1.0, 0.0);
    points->InsertNextPoint(0.0, height, 0.0);
    vtkNew<vtkCellArray> triangles;
    triangles->InsertNextCell({ 0, 1, 2 });
    triangles->InsertNextCell({ 0, 2, 3 });
    mesh->SetPoints(points);
    mesh->SetPolys(triangles);
  };
  makeMesh(source, 1.0);
  makeMesh(target, 1.5);

  vtkNew<vtkHomeomorphismTransform> map;
  map->SetSource(source);
  map->SetTarget(target);
  map->Update();
  const double point[3] = { 0.4, 0.5, 0.0 };
  double image[3];
  double back[3];
  double jacobian[3][3];
  map->InternalTransformDerivative(point, image, jacobian);
  map->GetInverse()->TransformPoint(image, back);
  std::cout << "(" << point[0] << ", " << point[1] << ") is mapped to (" << image[0] << ", "
            << image[1] << ") and back to (" << back[0] << ", " << back[1]
            << ").\ndx/dx = " << jacobian[0][0] << ", dy/dy = " << jacobian[1][1] << "\n";
}
