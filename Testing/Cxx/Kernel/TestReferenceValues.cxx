// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Coordinates, mapped points and derivatives agree with values computed to 50 digits by
// Testing/Reference/reference_values.py, which shares no code with the library.

#include "Fixtures/Tables.h"
#include "Fixtures/Triangles.h"

namespace
{

using namespace homeomorphism_test;
using fixtures::Row;

PlaneTriangle Triangle(const Row& row, const std::string& side)
{
  Corners corners;
  for (int k = 0; k < 3; ++k)
  {
    const std::string number = std::to_string(k + 1);
    corners[k] = { row.at(side + "x" + number), row.at(side + "y" + number) };
  }
  return PlaneTriangle(corners);
}

/// The neighbors across the edges, where the table has their apexes.
std::array<Neighbor, 3> Neighbors(
  const Row& row, const std::string& side, const PlaneTriangle& triangle)
{
  std::array<Neighbor, 3> neighbors;
  for (int k = 0; k < 3; ++k)
  {
    const std::string number = std::to_string(k + 1);
    const Vector2 apex{ row.at(side + "nx" + number), row.at(side + "ny" + number) };
    if (!std::isnan(apex.x))
    {
      neighbors[k] = { true,
        ViewFromEdge(triangle.Corners[NextCorner(k)], triangle.Corners[PreviousCorner(k)], apex) };
    }
  }
  return neighbors;
}

template <typename MakeChart>
void CompareTable(const std::string& name, std::size_t least, MakeChart makeChart)
{
  const std::vector<Row> rows = fixtures::ReadTable(REFERENCE_DATA_DIR "/" + name);
  ASSERT_GE(rows.size(), least) << "cannot read " << name;
  for (const Row& row : rows)
  {
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
    EXPECT_LT(distance, 1e-14 * p.Aspect()) << Description(p, point);

    const Vector2 expectedImage{ row.at("u"), row.at("v") };
    const Vector2 image = q.FromFrame(chartQ.ToPoint(reference));
    const Matrix2 expectedDerivative{ { row.at("J11"), row.at("J21") },
      { row.at("J12"), row.at("J22") } };
    // The point is known to an ulp of the coordinates of its triangle. The map transforms this
    // error.
    const auto extentOf = [](const PlaneTriangle& t) {
      return std::max({ Norm(t.Corners[0]), Norm(t.Corners[1]), Norm(t.Corners[2]) });
    };
    const double extent = extentOf(p);
    const double mapped = extent * Norm(expectedDerivative) + extentOf(q);
    EXPECT_LT(Norm(image - expectedImage), 2e-15 * mapped) << Description(p, point);

    const Matrix2 derivative = InPlane(p, q, MapDerivative(chartP, chartQ, reference));
    // Near the center of a Contour triangle and near the vertices, the derivative depends on the
    // direction from there and thus on the last bit of the point. The expected error is the change
    // of the derivative when the point moves by that much.
    double unavoidable = 0.0;
    for (const double dx : { -Ulp, 0.0, Ulp })
    {
      for (const double dy : { -Ulp, 0.0, Ulp })
      {
        const Vector2 moved = p.ToFrame(point + Vector2{ dx * extent, dy * extent });
        const Matrix2 there =
          InPlane(p, q, MapDerivative(chartP, chartQ, chartP.ToReference(moved)));
        unavoidable = std::max(unavoidable, Norm(there - derivative));
      }
    }
    const double allowed =
      unavoidable + Ulp * std::max(p.Aspect(), q.Aspect()) * Norm(expectedDerivative);
    EXPECT_LT(Norm(derivative - expectedDerivative), 8.0 * allowed) << Description(p, point);
  }
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
