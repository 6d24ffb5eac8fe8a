// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshPair.h
/// Reads and writes two meshes with the same triangles, in whatever files they come.

#ifndef dhm_MeshPair_h
#define dhm_MeshPair_h

#include "Failure.h"

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <nlohmann/json.hpp>

#include <array>
#include <string>
#include <vector>

namespace dhm
{

class OutputFile;

/// A source and a target. That they define a map is not known yet.
struct MeshPair
{
  std::array<vtkSmartPointer<vtkPolyData>, 2> Meshes;
  /// The files' names, for messages; the same one twice if it has both.
  std::array<std::string, 2> Names;
  /// What a triangulation file (PROJ) said besides; null for other files.
  nlohmann::ordered_json Metadata;
  /// Whether the meshes came from xmorph, whose units are those of no picture in particular; see
  /// FitToPictures.
  bool FromXmorph = false;
  /// In these units, where the picture ends on the right and at the top, for each mesh; zeros if
  /// that is not known.
  std::array<std::array<double, 2>, 2> XmorphExtents{};

  /// What to call the pair in messages: its files.
  std::string GetName() const
  {
    return this->Names[0] == this->Names[1] ? this->Names[0]
                                            : this->Names[0] + " and " + this->Names[1];
  }

  /// What to call one of the meshes in messages.
  std::string GetNameOf(std::size_t side) const
  {
    return this->Names[0] != this->Names[1] ? this->Names[side]
      : side == 0                           ? "the source of " + this->Names[0]
                                            : "the target of " + this->Names[0];
  }

  vtkPolyData* Source() const { return this->Meshes[0]; }
  vtkPolyData* Target() const { return this->Meshes[1]; }
};

/// Does work with a pair. Of what is refused meanwhile, the message gets the names of the files.
template <typename Work>
auto WorkWith(const MeshPair& pair, Work&& work)
{
  try
  {
    return work();
  }
  catch (const Failure& failure)
  {
    if (failure.GetStatus() != REFUSED)
    {
      throw;
    }
    throw Failure(REFUSED, pair.GetName() + ": " + failure.what());
  }
}

/// How pairs are read.
struct MeshPairOptions
{
  /// Of a mesh file that is alone: the point array that has the target's positions.
  std::string TargetArray = "Target";
  /// The extension that says what standard input ("-") holds.
  std::string InputFormat = "json";
  /// Of xmorph's meshes: the size of the working picture on which they were laid, as the session's
  /// file says it (resulting_size); zeros if the meshes fill it.
  std::array<int, 2> WorkingSize{ 0, 0 };
};

/// Reads a pair from one or two files. One file: a triangulation file (.json), or a mesh with a
/// point array. Two: .vtp, .vtk, .vtu, .obj, .off, .ply, .stl, or both xmorph's .mesh. Throws
/// Failure.
MeshPair ReadMeshPair(const std::vector<std::string>& files, const MeshPairOptions& options);

/// Reads one mesh. Throws Failure.
vtkSmartPointer<vtkPolyData> ReadMesh(const std::string& fileName, const std::string& inputFormat);

/// Moves meshes that came from xmorph from their own units to the pixels of pictures of these
/// sizes, as VTK counts them (y upwards, the first pixel's center is at 0); others stay. Throws
/// Failure if the extent of the meshes' pictures is not known.
void FitToPictures(
  MeshPair& pair, const std::array<int, 2>& sourceSize, const std::array<int, 2>& targetSize);

/// Throws Failure if WritePair does not know the format.
void CheckPairFormat(const std::string& format);

/// Writes a pair: json (a triangulation file; planar meshes only), or vtp, vtk and vtu with the
/// target's positions as the point array @a targetArray. Throws Failure.
void WritePair(const MeshPair& pair, const std::string& targetArray, const OutputFile& file);

/// Writes one mesh: obj, off, or one of VTK's formats. Throws Failure.
void WriteMesh(vtkPolyData* mesh, const OutputFile& file);

} // namespace dhm

#endif
