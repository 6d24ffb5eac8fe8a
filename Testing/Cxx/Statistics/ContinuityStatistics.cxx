// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares the verdicts of vtkJacobianContinuity with the theorems, on more than 10,000 edges of
// each of eight maps and on all other kinds of features, and measures its time.
//
//   ContinuityStatistics [TRIANGLES]
//
// Fails if a verdict is wrong, if an estimate is farther from the closed form than its own bound,
// or if more than one verdict in a hundred is undecided (one in twenty at wing segments). The last
// line is the time for a pair of TRIANGLES triangles (100,000 by default).

#include "Fixtures/MeasuredMaps.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkJacobianContinuity.h"
#include "vtkPointData.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace
{

using namespace fixtures;
using Continuity = vtkJacobianContinuity;

constexpr int featureTypes = Continuity::VERTEX + 1;
const std::array<const char*, featureTypes> featureNames{ "edges", "boundary edges", "spokes",
  "wing segments", "center segments", "strip borders", "centroids", "vertices" };

/// The verdict that the theorems give for a cell of the filter's output.
using Expectation = std::function<int(Continuity* filter, vtkIdType cell, int featureType)>;

struct Tally
{
  vtkIdType Count = 0;
  vtkIdType Verdicts[3] = {};
  vtkIdType Wrong = 0;
  vtkIdType BeyondBound = 0;
  std::vector<double> BoundOverJump;
};

double Value(vtkDataSetAttributes* attributes, const char* name, vtkIdType i)
{
  return attributes->GetArray(name)->GetTuple1(i);
}

/// Compares the estimates at the points of a cell with the closed form.
void CompareWithClosedForm(vtkPolyData* output, vtkIdType cell, Tally& tally)
{
  vtkNew<vtkIdList> ids;
  output->GetCellPoints(cell, ids);
  for (const vtkIdType point : *ids)
  {
    const double jump = Value(output->GetPointData(), "JacobianJump", point);
    const double exact = Value(output->GetPointData(), "JacobianJumpExact", point);
    const double bound = Value(output->GetPointData(), "JacobianJumpError", point);
    if (std::isnan(jump) || std::isnan(exact))
    {
      continue;
    }
    tally.BeyondBound += !(std::abs(jump - exact) <= bound);
    if (exact > 1e-3)
    {
      tally.BoundOverJump.push_back(bound / exact);
    }
  }
}

/// Runs the filter, adds a row to the table for each kind of feature, and returns whether all
/// values are acceptable.
bool Evaluate(const char* name, Continuity* filter, const Expectation& expected)
{
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  std::array<Tally, featureTypes> tallies;
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    const auto type = static_cast<int>(Value(output->GetCellData(), "FeatureType", cell));
    const auto verdict = static_cast<int>(Value(output->GetCellData(), "Verdict", cell));
    Tally& tally = tallies[type];
    ++tally.Count;
    ++tally.Verdicts[verdict];
    tally.Wrong += verdict != Continuity::UNDECIDED && verdict != expected(filter, cell, type);
    CompareWithClosedForm(output, cell, tally);
  }
  bool good = true;
  for (int type = 0; type < featureTypes; ++type)
  {
    Tally& tally = tallies[type];
    if (tally.Count == 0)
    {
      continue;
    }
    std::string median = "-";
    if (!tally.BoundOverJump.empty())
    {
      const auto middle =
        tally.BoundOverJump.begin() + static_cast<long>(tally.BoundOverJump.size() / 2);
      std::nth_element(tally.BoundOverJump.begin(), middle, tally.BoundOverJump.end());
      char text[16];
      std::snprintf(text, sizeof(text), "%.1e", *middle);
      median = text;
      good = good && *middle < 1e-6;
    }
    std::printf("%-22s %-16s %8lld %8lld %8lld %8lld (%.3f %%) %6lld %8lld %10s\n", name,
      featureNames[type], static_cast<long long>(tally.Count),
      static_cast<long long>(tally.Verdicts[Continuity::CREASE]),
      static_cast<long long>(tally.Verdicts[Continuity::DIFFERENTIABLE]),
      static_cast<long long>(tally.Verdicts[Continuity::UNDECIDED]),
      100.0 * static_cast<double>(tally.Verdicts[Continuity::UNDECIDED]) /
        static_cast<double>(tally.Count),
      static_cast<long long>(tally.Wrong), static_cast<long long>(tally.BeyondBound),
      median.c_str());
    // Beside a wing segment the Contour map often consists of further pieces that are too close to
    // be separated: the wing segments of the target are not the images of those of the source.
    const vtkIdType rarely = type == Continuity::WING_SEGMENT ? 20 : 100;
    good = good && tally.Wrong == 0 && tally.BeyondBound == 0 &&
      rarely * tally.Verdicts[Continuity::UNDECIDED] <= tally.Count;
  }
  std::fflush(stdout);
  return good;
}

/// The features with a crease in a random pair, by the theorems of
/// Documentation/differentiability.md. The triangles at two corners of the grid, all of whose
/// points are on its boundary, are the same in both meshes and mapped by the identity.
int ExpectedOfSystem(Continuity* filter, vtkIdType cell, int featureType, vtkPolyData* source)
{
  bool crease = false;
  switch (featureType)
  {
    case Continuity::EDGE:
    case Continuity::SPOKE:
    case Continuity::TRIANGLE_CENTER:
      crease = Value(filter->GetOutput()->GetCellData(), "JacobianJumpExact", cell) >
        filter->GetResolution();
      break;
    case Continuity::VERTEX:
    {
      double point[3];
      vtkNew<vtkIdList> cells;
      filter->GetOutput()->GetPoint(filter->GetOutput()->GetCell(cell)->GetPointId(0), point);
      source->GetPointCells(source->FindPoint(point), cells);
      crease = cells->GetNumberOfIds() > 1;
      break;
    }
    default:
      break;
  }
  return crease ? Continuity::CREASE : Continuity::DIFFERENTIABLE;
}

bool EvaluateSystems(const MeshPair& pair, bool allFeatures)
{
  bool good = true;
  const std::array<const char*, 4> names{ "Linear", "Contour", "Smooth", "Cubic" };
  for (int system = Continuity::LINEAR; system <= Continuity::CUBIC; ++system)
  {
    vtkNew<Continuity> filter;
    filter->SetSourceData(pair.Source);
    filter->SetTargetData(pair.Target);
    filter->SetCoordinateSystem(system);
    filter->SetSpokes(allFeatures);
    filter->SetWingSegments(allFeatures);
    filter->SetCenterSegments(allFeatures);
    filter->SetStripBorders(allFeatures);
    filter->SetCentroids(allFeatures);
    filter->SetVertices(allFeatures);
    good = Evaluate(names[system], filter,
             [&pair, system](Continuity* f, vtkIdType cell, int type) {
               return system == Continuity::CUBIC ? static_cast<int>(Continuity::DIFFERENTIABLE)
                                                  : ExpectedOfSystem(f, cell, type, pair.Source);
             }) &&
      good;
  }
  return good;
}

bool EvaluateTransform(const char* name, vtkPolyData* source, vtkAbstractTransform* transform,
  const Expectation& expected)
{
  vtkNew<Continuity> filter;
  filter->SetSourceData(source);
  filter->SetTransform(transform);
  return Evaluate(name, filter, expected);
}

int AlwaysDifferentiable(Continuity*, vtkIdType, int)
{
  return Continuity::DIFFERENTIABLE;
}

/// On the lines of integer x, which contain the vertical edges of the grid.
int CreaseOnVerticalLines(Continuity* filter, vtkIdType cell, int)
{
  double bounds[6];
  filter->GetOutput()->GetCellBounds(cell, bounds);
  return bounds[0] == bounds[1] ? Continuity::CREASE : Continuity::DIFFERENTIABLE;
}

void PrintTime(vtkIdType triangles)
{
  const int n = static_cast<int>(std::ceil(std::sqrt(0.5 * static_cast<double>(triangles))));
  const MeshPair pair = MakePlanarPair(n, 5, 0.15);
  for (int system = Continuity::LINEAR; system <= Continuity::SMOOTH; ++system)
  {
    vtkNew<Continuity> filter;
    filter->SetSourceData(pair.Source);
    filter->SetTargetData(pair.Target);
    filter->SetCoordinateSystem(system);
    std::printf("system %d, %lld triangles, %d samples an edge, %d threads", system,
      static_cast<long long>(pair.Source->GetNumberOfCells()), filter->GetSamplesPerEdge(),
      vtkSMPTools::GetEstimatedNumberOfThreads());
    const auto start = std::chrono::steady_clock::now();
    filter->Update();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    std::printf(", %.1f s for %lld edges\n", time.count(),
      static_cast<long long>(filter->GetOutput()->GetNumberOfCells()));
  }
}

} // namespace

int main(int argc, char* argv[])
{
  char* end = nullptr;
  const vtkIdType triangles = argc > 1 ? std::strtoll(argv[1], &end, 10) : 100000;
  if (argc > 2 || triangles < 2 || (end && *end))
  {
    std::fprintf(stderr, "Usage: ContinuityStatistics [TRIANGLES]\n");
    return EXIT_FAILURE;
  }
  std::printf("%-22s %-16s %8s %8s %8s %18s %6s %8s %10s\n", "map", "places", "count", "crease",
    "smooth", "undecided", "wrong", "(1)", "(2)");
  // With displacements this small, every triangle of a grid is concordant.
  const MeshPair large = MakePlanarPair(60, 3, 0.15);
  bool good = EvaluateSystems(large, false);
  const std::vector<Point> points = GridPoints(60, 4, 0.15);
  const auto turned = [](const Point& p) -> Point {
    return { 3.0 * p[0] - 4.0 * p[1] + 1.0, 4.0 * p[0] + 3.0 * p[1], 0.0 };
  };
  std::vector<Point> image;
  std::transform(points.begin(), points.end(), std::back_inserter(image), turned);
  vtkNew<Continuity> similar;
  similar->SetSourceData(MakeMesh(points, GridTriangles(60)));
  similar->SetTargetData(MakeMesh(image, GridTriangles(60)));
  similar->SetCoordinateSystem(Continuity::CONTOUR);
  good = Evaluate("Contour, similar pair", similar, AlwaysDifferentiable) && good;

  good = EvaluateTransform("thin plate spline", large.Source, MakeThinPlateSpline(large, 97),
           AlwaysDifferentiable) &&
    good;
  vtkNew<PiecewiseMap> pieces;
  pieces->EveryLine = true;
  pieces->Amount = 0.1;
  pieces->Exponent = 2;
  good = EvaluateTransform("C1, not C2", RegularGrid(60), pieces, AlwaysDifferentiable) && good;
  pieces->Exponent = 1;
  pieces->Amount = 1e-6;
  pieces->Modified();
  good =
    EvaluateTransform("crease of 1e-6", RegularGrid(60), pieces, CreaseOnVerticalLines) && good;

  good = EvaluateSystems(MakePlanarPair(20, 7, 0.15), true) && good;
  std::printf("\n(1) estimates farther from the closed form than their own error bound\n"
              "(2) median of error bound over jump, where the jump is more than 1e-3\n\n");
  PrintTime(triangles);
  std::printf(good ? "No verdict is wrong.\n" : "FAILED\n");
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
