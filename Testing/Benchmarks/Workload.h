// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Workload.h
/// A pair of meshes and sets of points, as written to a folder by benchmark.py.

#ifndef Workload_h
#define Workload_h

#include "vtkImageData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <map>
#include <string>
#include <vector>

struct Workload
{
  /// Reads the files of a folder: source.f64 and target.f64 (three doubles per point),
  /// triangles.i64 (three point ids per triangle), any number of points-NAME.f64, and image.u8
  /// (square, RGB) if it exists.
  explicit Workload(const std::string& folder);

  /// The mesh that is mapped from and the mesh that is mapped to.
  vtkPolyData* GetFrom(bool inverse) const { return inverse ? this->Target : this->Source; }
  vtkPolyData* GetTo(bool inverse) const { return inverse ? this->Source : this->Target; }

  std::string Folder;
  vtkSmartPointer<vtkPolyData> Source;
  vtkSmartPointer<vtkPolyData> Target;
  std::map<std::string, vtkSmartPointer<vtkPoints>> Points;
  vtkSmartPointer<vtkImageData> Image;
};

/// An affine map of the plane: x' = [0] x + [1] y + [2], y' = [3] x + [4] y + [5].
using Affine = std::array<double, 6>;

/// For each triangle of a mesh, the affine map to the corresponding triangle of another one.
std::vector<Affine> TriangleMaps(vtkPolyData* from, vtkPolyData* to);

inline void Apply(const Affine& map, const double in[3], double out[3])
{
  out[0] = map[0] * in[0] + map[1] * in[1] + map[2];
  out[1] = map[3] * in[0] + map[4] * in[1] + map[5];
  out[2] = in[2];
}

#endif
