// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Coordinates, mapped points and derivatives agree with values computed to 50 digits by
// Testing/Reference/reference_values.py, which shares no code with the library.

#include "Fixtures/Triangles.h"

#include "Kernel/ContourChart.h"
#include "Kernel/LinearChart.h"
#include "Kernel/SmoothChart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace
{

using namespace homeomorphism_test;

using Row = std::map<std::string, double>;

std::vector<Row> ReadTable(const std::string& name)
{
  std::ifstream file(REFERENCE_DATA_DIR "/" + name);
  std::vector<Row> rows;
  std::vector<std::string> header;
  std::string line;
  while (std::getline(file, line))
  {
    if (line.empty() || line[0] == '#')
    {
      continue;
    }
    std::istringstream cells(line);
    std::string cell;
    std::vector<std::string> values;
    while (std::getline(cells, cell, ','))
    {
      values.push_back(cell);
    }
    if (header.empty())
    {
      header = values;
      continue;
    }
    EXPECT_EQ(values.size(), header.size()) << name << ": " << line;
    Row row;
    for (std::size_t i = 0; i < header.size(); ++i)
    {
      row[header[i]] = std::strtod(values[i].c_str(), nullptr);
    }
    rows.push_back(row);
  }
  return rows;
}

PlaneTriangle Triangle(const Row& row, const std::string& side)
{
  std::array<Vector2, 3> corners;
  for (int k = 0; k < 3; ++k)
  {
    const std::string number = std::to_string(k + 1);
    corners[k] = { row.at(side + "x" + number), row.at(side + "y" + number) };
  }
  return PlaneTriangle(corners);
}

std::array<Neighbor, 3> Neighbors(
  const Row& row, const std::string& side, const PlaneTriangle& triangle)
{
  std::array<Neighbor, 3> neighbors;
  for (int k = 0; k < 3; ++k)
  {
    const std::string number = std::to_string(k + 1);
    neighbors[k] =
      triangle.NeighborWithApex(k, { row.at(side + "nx" + number), row.at(side + "ny" + number) });
  }
  return neighbors;
}

/// Condition number of the change of frame that the derivative passes through: the larger ratio of
/// base to height of the two triangles. It magnifies the rounding of the corners.
double Aspect(const PlaneTriangle& p)
{
  return p.Shape.Base / p.Shape.Height;
}

constexpr double ulp = std::numeric_limits<double>::epsilon();

struct Worst
{
  double Coordinates = 0.0;
  double Point = 0.0;
  double Derivative = 0.0;
};

template <typename MakeChart>
void CompareTable(const std::string& name, std::size_t least, MakeChart makeChart)
{
  const std::vector<Row> rows = ReadTable(name);
  ASSERT_GE(rows.size(), least) << "cannot read " << name;
  Worst worst;
  int number = 0;
  for (const Row& row : rows)
  {
    SCOPED_TRACE(name + " row " + std::to_string(++number));
    const PlaneTriangle p = Triangle(row, "p");
    const PlaneTriangle q = Triangle(row, "q");
    const auto chartP = makeChart(row, "p", p);
    const auto chartQ = makeChart(row, "q", q);

    // Coordinates are compared by the distance of the points that have them, in units of the
    // longest edge of the triangle.
    const Vector2 point{ row.at("x"), row.at("y") };
    const auto reference = chartP.ToReference(p.ToFrame(point));
    const TriangularCoordinates found = chartP.ToCoordinates(reference);
    const TriangularCoordinates expected{ static_cast<int>(row.at("e")), row.at("p"), row.at("c") };
    EXPECT_EQ(found.Edge, expected.Edge);
    const double distance =
      std::hypot((found.EdgeParameter - expected.EdgeParameter) * expected.ContourParameter,
        found.ContourParameter - expected.ContourParameter);
    worst.Coordinates = std::max(worst.Coordinates, distance / Aspect(p));

    const Vector2 expectedImage{ row.at("u"), row.at("v") };
    const Vector2 image = q.FromFrame(chartQ.ToPoint(reference));
    const Matrix2 expectedDerivative{ { row.at("J11"), row.at("J21") },
      { row.at("J12"), row.at("J22") } };
    // The point is known to an ulp of the coordinates of its triangle. The map transforms this
    // error.
    double extent = 0.0;
    double imageExtent = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      extent = std::max(extent, Norm(p.Corners[k]));
      imageExtent = std::max(imageExtent, Norm(q.Corners[k]));
    }
    const double mapped = extent * Norm(expectedDerivative) + imageExtent;
    worst.Point = std::max(worst.Point, Norm(image - expectedImage) / mapped);

    const Matrix2 derivative = InPlane(p, q, MapDerivative(chartP, chartQ, reference));
    // Near the center of a Contour triangle and near the vertices, the derivative depends on the
    // direction from there and thus on the last bit of the point. The expected error is the change
    // of the derivative when the point moves by that much.
    double unavoidable = 0.0;
    for (const double dx : { -ulp, 0.0, ulp })
    {
      for (const double dy : { -ulp, 0.0, ulp })
      {
        const Vector2 moved = p.ToFrame(point + Vector2{ dx * extent, dy * extent });
        const Matrix2 there =
          InPlane(p, q, MapDerivative(chartP, chartQ, chartP.ToReference(moved)));
        unavoidable = std::max(unavoidable, Norm(there - derivative));
      }
    }
    const double allowed =
      unavoidable + ulp * std::max(Aspect(p), Aspect(q)) * Norm(expectedDerivative);
    worst.Derivative = std::max(worst.Derivative, Norm(derivative - expectedDerivative) / allowed);
  }
  EXPECT_LT(worst.Coordinates, 1e-14);
  EXPECT_LT(worst.Point, 2e-15);
  EXPECT_LT(worst.Derivative, 8.0);
}

TEST(ReferenceValues, Linear)
{
  CompareTable("ReferenceLinear.csv", 1000,
    [](const Row&, const char*, const PlaneTriangle& t) { return LinearChart(t.Shape); });
}

TEST(ReferenceValues, Contour)
{
  CompareTable("ReferenceContour.csv", 1000, [](const Row&, const char*, const PlaneTriangle& t) {
    return ContourChart(t.Shape, t.Views());
  });
}

TEST(ReferenceValues, ContourFromIncenter)
{
  CompareTable(
    "ReferenceContourIncenter.csv", 300, [](const Row&, const char*, const PlaneTriangle& t) {
      return ContourChart(t.Shape, t.Views(), CenterPoint::Incenter);
    });
}

TEST(ReferenceValues, Smooth)
{
  CompareTable(
    "ReferenceSmooth.csv", 1000, [](const Row& row, const char* side, const PlaneTriangle& t) {
      return SmoothChart(t.Shape, t.Views(), Neighbors(row, side, t));
    });
}

} // namespace
