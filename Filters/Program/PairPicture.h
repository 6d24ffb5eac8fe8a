// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PairPicture.h
/// The picture that `check` draws, and what `figure` shares with it.

#ifndef dhm_PairPicture_h
#define dhm_PairPicture_h

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <array>

namespace dhm
{

class OutputFile;
struct MeshPair;
struct PairReport;

/// A mesh, however broken, as it can be drawn: seen along the axis in which it is thinnest, with
/// cells that have points that do not exist or are not finite as cells without points.
vtkSmartPointer<vtkPolyData> Flatten(vtkPolyData* mesh);

/// The rectangle around a flattened mesh, with a margin.
std::array<double, 4> BoundsOf(vtkPolyData* flat);

/// Both meshes side by side; triangles that are invalid and discordant ones, and duplicate points,
/// marked.
void DrawPair(const MeshPair& pair, const PairReport& report, const OutputFile& file);

} // namespace dhm

#endif
