// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Streams an image that never exists as a whole through vtkDifferentiableHomeomorphism, piece by
// piece, and prints the memory used (Linux only).
//
//   StreamedPoints MEGABYTES
//
// Fails if the peak exceeds the memory used before plus that of one piece by more than MEGABYTES,
// or if points are missing or outside.

#include "Fixtures/FilterRuns.h"

#include "vtkRTAnalyticSource.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace
{

/// A size from /proc/self/status in MB (10^6 bytes); NaN if it is missing.
double ProcessMemory(const std::string& key)
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    if (line.compare(0, key.size() + 1, key + ":") == 0)
    {
      return std::stod(line.substr(key.size() + 1)) * 1.024e-3;
    }
  }
  return fixtures::NotANumber;
}

} // namespace

int main(int argc, char* argv[])
{
  using namespace fixtures;
  constexpr int side = 2000;
  constexpr int pieces = 16;
  constexpr int divisions = 70;
  vtkNew<vtkRTAnalyticSource> image;
  image->SetWholeExtent(0, side - 1, 0, side - 1, 0, 0);
  const double scale = static_cast<double>(side - 1) / divisions;
  const auto map = MakeFilter(Smooth, Resized(MakePlanarPair(divisions, 950), scale));
  map->SetDataConnection(image->GetOutputPort());
  map->ComputeJacobianDeterminantOn();

  const double before = ProcessMemory("VmRSS");
  double piece = 0.0;
  vtkIdType passed = 0;
  vtkIdType outside = 0;
  for (int i = 0; i < pieces; ++i)
  {
    map->UpdatePiece(i, pieces, 0);
    auto* output = vtkPointSet::SafeDownCast(map->GetOutputDataObject(0));
    // Includes the image's values, which pass through.
    piece = std::max(piece, static_cast<double>(output->GetActualMemorySize()) * 1.024e-3);
    passed += output->GetNumberOfPoints();
    outside += map->GetNumberOfOutsidePoints();
  }
  const double peak = ProcessMemory("VmHWM");
  // Points on the borders of pieces occur several times.
  std::printf("%lld points in %d pieces: before %.0f MB, the largest piece %.0f MB, peak %.0f MB; "
              "%lld points outside\n",
    static_cast<long long>(passed), pieces, before, piece, peak, static_cast<long long>(outside));
  const bool good = map->GetNumberOfMeshBuilds() == 1 && passed >= vtkIdType(side) * side &&
    outside == 0 && argc == 2 && !(peak - before - piece > std::atof(argv[1]));
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
