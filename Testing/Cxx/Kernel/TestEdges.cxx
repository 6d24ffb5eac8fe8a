// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The maps of triangles form a homeomorphism of meshes: edges are mapped linearly and vertices to
// vertices, and maps compose, also to the identity. Errors are an ulp of the
// point in its triangle, magnified by the derivative of the map, plus an ulp of the image.

#include "RandomTriangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace
{

using namespace homeomorphism_test;

template <typename System>
struct Domain
{
  PlaneTriangle Triangle;
  typename System::Chart Chart;

  Domain(RandomNumbers& random, const Corners& corners)
    : Triangle(corners)
    , Chart(System::Make(random, this->Triangle, false))
  {
  }

  double Base() const { return this->Triangle.Shape.Base; }
};

template <typename System>
double DerivativeNorm(const Domain<System>& from, const Domain<System>& to,
  const typename System::Chart::Reference& reference)
{
  return Norm(MapDerivative(from.Chart, to.Chart, reference));
}

template <typename System>
class Edges : public testing::Test
{
};

using Systems = testing::Types<LinearSystem, ContourSystem, IncenterSystem, SmoothSystem>;

TYPED_TEST_SUITE(Edges, Systems, SystemName);

TYPED_TEST(Edges, VerticesMapToVertices)
{
  RandomNumbers random(31);
  Worst worst;
  for (int n = 0; n < 20000; ++n)
  {
    const Domain<TypeParam> p(random, TypeParam::Any(random));
    const Domain<TypeParam> q(random, TypeParam::Any(random));
    for (int k = 0; k < 3; ++k)
    {
      const Vector2 corner = p.Triangle.Shape.Corner(k);
      const Vector2 image = MapPoint(p.Chart, q.Chart, corner);
      // The derivative does not exist at a vertex, but this bounds the stretch near it: the frame
      // and the edge views agree on the triangle to an ulp of its longest edge.
      const double derivative = q.Base() / p.Triangle.Shape.Height;
      const double rounding = Ulp * (derivative * p.Base() + q.Base());
      worst.Take(Norm(image - q.Triangle.Shape.Corner(k)) / rounding, p.Triangle, corner);
    }
  }
  EXPECT_LT(worst.Value, 16.0) << worst.Where;
}

TYPED_TEST(Edges, PointOnAnEdgeHasItsCoordinates)
{
  RandomNumbers random(32);
  Worst worstP;
  Worst worstC;
  Worst worstPoint;
  int wrongEdges = 0;
  int notOnBase = 0;
  // Smooth computes its coordinates in the equilateral triangle, whose sides are not on the x axis.
  const bool isExact = std::string(TypeParam::Name) != SmoothSystem::Name;
  for (int n = 0; n < 20000; ++n)
  {
    const Domain<TypeParam> p(random, TypeParam::Any(random));
    const TriangleShape& shape = p.Triangle.Shape;
    for (int k = 0; k < 3; ++k)
    {
      const double t = random.Uniform(0.001, 0.999);
      const Vector2 start = shape.Corner(NextCorner(k));
      const Vector2 end = shape.Corner(PreviousCorner(k));
      const Vector2 point = (1.0 - t) * start + t * end;
      const auto reference = p.Chart.ToReference(point);
      const TriangularCoordinates found = p.Chart.ToCoordinates(reference);
      wrongEdges += found.Edge != k + 1;
      // The position of the point is known to an ulp of the longest edge.
      const double rounding =
        Ulp * p.Base() / Norm(end - start) * InverseMagnification(p.Chart, shape, reference);
      worstP.Take(std::abs(found.EdgeParameter - t) / rounding, p.Triangle, point);
      // The contour may be as short as the height of the triangle.
      const double roundingOfC =
        Ulp * p.Base() / shape.Height * InverseMagnification(p.Chart, shape, reference);
      worstC.Take((1.0 - found.ContourParameter) / roundingOfC, p.Triangle, point);
      if (k == shape.Apex)
      {
        // On the x axis coordinates are exact.
        notOnBase += found.ContourParameter != 1.0;
      }
    }
    // In coordinates all edges are exact: c = 1 is on the edge, at p.
    const int e = random.Integer(1, 3);
    const double t = random.Proportion();
    const Vector2 expected =
      (1.0 - t) * shape.Corner(NextCorner(e - 1)) + t * shape.Corner(PreviousCorner(e - 1));
    const auto reference = p.Chart.FromCoordinates({ e, t, 1.0 });
    const Vector2 found = p.Chart.ToPoint(reference);
    const double rounding = Ulp * p.Base() * Magnification(p.Chart, shape, reference);
    worstPoint.Take(Norm(found - expected) / rounding, p.Triangle, expected);
  }
  EXPECT_LT(worstP.Value, 16.0) << worstP.Where;
  EXPECT_LT(worstC.Value, 16.0) << worstC.Where;
  EXPECT_LT(worstPoint.Value, 16.0) << worstPoint.Where;
  EXPECT_EQ(wrongEdges, 0);
  if (isExact)
  {
    EXPECT_EQ(notOnBase, 0);
  }
}

TYPED_TEST(Edges, AreMappedLinearly)
{
  RandomNumbers random(33);
  Worst worst;
  for (int n = 0; n < 30000; ++n)
  {
    const Domain<TypeParam> p(random, TypeParam::Any(random));
    const Domain<TypeParam> q(random, TypeParam::Any(random));
    for (int k = 0; k < 3; ++k)
    {
      const double t = random.Uniform(0.0001, 0.9999);
      const auto at = [k, t](const TriangleShape& shape) {
        return (1.0 - t) * shape.Corner(NextCorner(k)) + t * shape.Corner(PreviousCorner(k));
      };
      const Vector2 point = at(p.Triangle.Shape);
      const auto reference = p.Chart.ToReference(point);
      const Vector2 image = q.Chart.ToPoint(reference);
      const double rounding = Ulp * (DerivativeNorm(p, q, reference) * p.Base() + q.Base());
      worst.Take(Norm(image - at(q.Triangle.Shape)) / rounding, p.Triangle, point);
    }
  }
  EXPECT_LT(worst.Value, 16.0) << worst.Where;
}

TYPED_TEST(Edges, MapsCompose)
{
  RandomNumbers random(36);
  Worst worst;
  for (int n = 0; n < 30000; ++n)
  {
    const Domain<TypeParam> p(random, TypeParam::Any(random));
    const Domain<TypeParam> q(random, TypeParam::Any(random));
    // Every other time back to the first, which is the inverse.
    const Domain<TypeParam> other(random, TypeParam::Any(random));
    const Domain<TypeParam>& r = n % 2 == 0 ? p : other;
    for (int i = 0; i < 5; ++i)
    {
      const Vector2 point = p.Triangle.Shape.FromBarycentric(AnyBarycentric(random));
      const auto reference = p.Chart.ToReference(point);
      const Vector2 direct = r.Chart.ToPoint(reference);
      const Vector2 viaQ = MapPoint(q.Chart, r.Chart, q.Chart.ToPoint(reference));
      const double rounding = Ulp * (DerivativeNorm(q, r, reference) * q.Base() + r.Base());
      worst.Take(Norm(viaQ - direct) / rounding, p.Triangle, point);
    }
  }
  EXPECT_LT(worst.Value, 16.0) << worst.Where;
}

} // namespace
