// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Streams an image that never exists as a whole through vtkDifferentiableHomeomorphism, piece by
// piece, and prints the memory used (Linux only).
//
//   StreamedPoints [POINTS [PIECES [MEGABYTES]]]
//
// The default is 100,000,000 points in 100 pieces. Fails if the peak exceeds the memory used before
// plus that of one piece by more than MEGABYTES (1000), if points are missing or outside, or if the
// determinants do not have the correct mean.

#include "Fixtures/FilterRuns.h"

#include "vtkRTAnalyticSource.h"
#include "vtkSMPTools.h"
#include "vtkStructuredGrid.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace
{

using namespace fixtures;

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
  return std::numeric_limits<double>::quiet_NaN();
}

double MemoryOf(vtkDataObject* data)
{
  return static_cast<double>(data->GetActualMemorySize()) * 1.024e-3;
}

} // namespace

int main(int argc, char* argv[])
{
  const double points = argc > 1 ? std::atof(argv[1]) : 1e8;
  const int pieces = argc > 2 ? std::atoi(argv[2]) : 100;
  const double limit = argc > 3 ? std::atof(argv[3]) : 1000.0;
  const int side = static_cast<int>(std::ceil(std::sqrt(points)));
  if (side < 2 || pieces < 1 || side > 1000000)
  {
    std::fprintf(stderr, "StreamedPoints [POINTS [PIECES [MEGABYTES]]]\n");
    return EXIT_FAILURE;
  }

  constexpr int divisions = 70;
  MeshPair pair = MakePlanarPair(divisions, 950);
  const double scale = static_cast<double>(side - 1) / divisions;
  for (vtkSmartPointer<vtkPolyData>* mesh : { &pair.Source, &pair.Target })
  {
    *mesh = Moved(*mesh, [scale](const Point& p) { return scale * p; });
  }
  vtkNew<vtkRTAnalyticSource> image;
  image->SetWholeExtent(0, side - 1, 0, side - 1, 0, 0);
  const auto map = MakeFilter(Smooth, pair);
  map->SetDataConnection(image->GetOutputPort());
  map->ComputeJacobianDeterminantOn();

  const double before = ProcessMemory("VmRSS");
  double piece = 0.0;
  double passed = 0.0;
  double outside = 0.0;
  double sum = 0.0;
  for (int i = 0; i < pieces; ++i)
  {
    map->UpdatePiece(i, pieces, 0);
    auto* output = vtkStructuredGrid::SafeDownCast(map->GetOutputDataObject(0));
    // Includes the image's values, which pass through.
    piece = std::max(piece, MemoryOf(output));
    passed += static_cast<double>(output->GetNumberOfPoints());
    outside += static_cast<double>(map->GetNumberOfOutsidePoints());
    // Points on the borders of pieces occur several times, so each is weighted by its share of the
    // plane.
    vtkDataArray* determinants = PointArray(output, "JacobianDeterminant");
    int extent[6];
    output->GetExtent(extent);
    vtkIdType id = 0;
    for (int y = extent[2]; y <= extent[3]; ++y)
    {
      const double height = (y > extent[2] ? 0.5 : 0.0) + (y < extent[3] ? 0.5 : 0.0);
      for (int x = extent[0]; x <= extent[1]; ++x)
      {
        const double width = (x > extent[0] ? 0.5 : 0.0) + (x < extent[1] ? 0.5 : 0.0);
        sum += width * height * determinants->GetTuple1(id++);
      }
    }
  }
  const double peak = ProcessMemory("VmHWM");
  const double beyond = peak - before - piece;
  // Both meshes cover the same square.
  const double mean = sum / ((side - 1.0) * (side - 1.0));
  std::printf("%.0f points (%.0f with the common borders) in %d pieces, %d triangles, %d threads\n",
    1.0 * side * side, passed, pieces, int(pair.Source->GetNumberOfCells()),
    vtkSMPTools::GetEstimatedNumberOfThreads());
  std::printf("before %.0f MB, the largest piece %.0f MB, peak %.0f MB: %.0f MB beyond one piece\n",
    before, piece, peak, beyond);
  std::printf("mean determinant %.8f, %.0f points outside\n", mean, outside);
  // The sum over a grid only approximates the integral, because the determinant varies within
  // triangles.
  const double coarseness = 50.0 / scale / scale;
  const bool good = map->GetNumberOfMeshBuilds() == 1 && passed >= 1.0 * side * side &&
    outside == 0.0 && std::abs(mean - 1.0) < coarseness && !(beyond > limit);
  if (!good)
  {
    std::printf("That is not as it should be.\n");
  }
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
