// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TestPlanes.cxx
/// Planarity, the orientation of normals, and the images of points near a plane or surface.

#include "TestMeshes.h"

#include "vtkDifferentiableHomeomorphism.h"
#include "vtkHomeomorphismTransform.h"

#include "vtkDataArray.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace
{

using namespace test_meshes;

constexpr double Epsilon = std::numeric_limits<double>::epsilon();
constexpr int Systems[] = { vtkDifferentiableHomeomorphism::LINEAR,
  vtkDifferentiableHomeomorphism::CONTOUR, vtkDifferentiableHomeomorphism::SMOOTH };

Point Combine(
  const Point& origin, double x, const Point& along, double y = 0.0, const Point& across = {})
{
  Point result;
  for (int k = 0; k < 3; ++k)
  {
    result[k] = origin[k] + (x * along[k] + y * across[k]);
  }
  return result;
}

double Dot(const Point& a, const Point& b)
{
  return vtkMath::Dot(a.data(), b.data());
}

Point Cross(const Point& a, const Point& b)
{
  Point c;
  vtkMath::Cross(a.data(), b.data(), c.data());
  return c;
}

/// Not a parameter by value modified through a pointer: GCC 12's -fipa-modref may drop the caller's
/// writes to it, and did so in the build with the thread sanitizer.
Point Unit(const Point& a)
{
  const double length = vtkMath::Norm(a.data());
  return { a[0] / length, a[1] / length, a[2] / length };
}

double Distance(const Point& a, const Point& b)
{
  return std::sqrt(vtkMath::Distance2BetweenPoints(a.data(), b.data()));
}

Point PointOf(vtkDataSet* data, vtkIdType i)
{
  Point p;
  data->GetPoint(i, p.data());
  return p;
}

std::vector<Point> PointsOf(vtkDataSet* data)
{
  std::vector<Point> points;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    points.push_back(PointOf(data, i));
  }
  return points;
}

/// The origin of a plane and right-handed axes: two in the plane, and the normal.
struct Plane
{
  Point Origin;
  Point U;
  Point V;
  Point Normal;
};

Plane PlaneWithNormal(const Point& origin, const Point& normal, const Point& helper)
{
  const Point n = Unit(normal);
  const Point v = Unit(Cross(n, helper));
  return { origin, Cross(v, n), v, n };
}

/// Rotates vectors by an angle about an axis.
Point Turned(const Point& a, const Point& axis, double angle)
{
  return Combine(Combine({}, std::cos(angle), a, std::sin(angle), Cross(axis, a)),
    (1.0 - std::cos(angle)) * Dot(axis, a), axis);
}

/// A mesh of the xy plane, moved into another plane.
vtkSmartPointer<vtkPolyData> InPlane(vtkPolyData* mesh, const Plane& plane)
{
  const auto result = vtkSmartPointer<vtkPolyData>::New();
  result->DeepCopy(mesh);
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    const Point p = PointOf(mesh, i);
    result->GetPoints()->SetPoint(i, Combine(plane.Origin, p[0], plane.U, p[1], plane.V).data());
  }
  return result;
}

Point RandomUnit(std::mt19937_64& generator)
{
  std::normal_distribution<double> normal;
  return Unit({ normal(generator), normal(generator), normal(generator) });
}

vtkSmartPointer<vtkPolyData> AsFloats(vtkPolyData* mesh)
{
  const auto result = vtkSmartPointer<vtkPolyData>::New();
  result->DeepCopy(mesh);
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->DeepCopy(mesh->GetPoints());
  result->SetPoints(points);
  return result;
}

/// The points with these weights in each triangle.
std::vector<Point> PointsInTriangles(vtkPolyData* mesh, const std::vector<Point>& weights)
{
  std::vector<Point> result;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    mesh->GetCellPoints(cell, ids);
    for (const Point& w : weights)
    {
      Point p{};
      for (int k = 0; k < 3; ++k)
      {
        p = Combine(p, w[k], PointOf(mesh, ids->GetId(k)));
      }
      result.push_back(p);
    }
  }
  return result;
}

const std::vector<Point> InsideWeights{ { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 }, { 0.5, 0.4, 0.1 },
  { 0.02, 0.08, 0.9 }, { 0.25, 0.7, 0.05 } };

/// The output of the filter for some points.
struct Mapped
{
  std::vector<Point> Points;
  std::vector<bool> Valid;
  std::vector<double> Determinants;
  std::vector<std::array<double, 9>> Jacobians;

  bool AllValid() const
  {
    return !this->Valid.empty() &&
      std::all_of(this->Valid.begin(), this->Valid.end(), [](bool valid) { return valid; });
  }
};

struct Options
{
  int System = vtkDifferentiableHomeomorphism::SMOOTH;
  double Tolerance = 0.0;
  bool Inverse = false;
};

Mapped MapData(const MeshPair& pair, vtkDataObject* data, const Options& options = {})
{
  const vtkNew<vtkDifferentiableHomeomorphism> filter;
  Messages messages(filter);
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->SetDataObject(data);
  filter->SetCoordinateSystem(options.System);
  filter->SetCenterPoint(vtkDifferentiableHomeomorphism::INCENTER);
  filter->SetTolerance(options.Tolerance);
  filter->SetInverse(options.Inverse);
  filter->ComputeJacobianOn();
  filter->ComputeJacobianDeterminantOn();
  filter->Update();
  EXPECT_FALSE(messages.HasError()) << messages.Error();
  Mapped result;
  auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  if (messages.HasError() || !output)
  {
    return result;
  }
  result.Points = PointsOf(output);
  auto* mask = output->GetPointData()->GetArray("vtkValidPointMask");
  auto* determinants = output->GetPointData()->GetArray("JacobianDeterminant");
  auto* jacobians = output->GetPointData()->GetArray("Jacobian");
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    result.Valid.push_back(mask->GetTuple1(i) != 0.0);
    result.Determinants.push_back(determinants->GetTuple1(i));
    result.Jacobians.emplace_back();
    jacobians->GetTuple(i, result.Jacobians.back().data());
  }
  return result;
}

Mapped MapPoints(
  const MeshPair& pair, const std::vector<Point>& points, const Options& options = {})
{
  return MapData(pair, MakeMesh(points, {}), options);
}

//------------------------------------------------------------------------------------------------
// Thin surfaces.

/// Half a tube along the x axis, of length 1, convex upwards.
vtkSmartPointer<vtkPolyData> MakeHalfTube(double radius)
{
  const int n = 8;
  std::vector<Point> points = GridPoints(n, 1, 0.0);
  for (Point& p : points)
  {
    const double angle = vtkMath::Pi() * p[1] / n;
    p = { p[0] / n, -radius * std::cos(angle), radius * std::sin(angle) };
  }
  return AsFloats(MakeMesh(points, GridTriangles(n)));
}

TEST(ThinSurfaces, AHalfTubeIsNotPlanar)
{
  // If it were flattened, heights would pass unchanged, and the ratio of areas would be about 2
  // only where it is steep. The tolerance is a float ulp relative to the shortest edge.
  for (const double radius : { 2e-4, 3e-4, 4.5e-4, 6e-4 })
  {
    const MeshPair pair{ MakeHalfTube(radius), MakeHalfTube(2.0 * radius) };
    for (const int system :
      { vtkDifferentiableHomeomorphism::LINEAR, vtkDifferentiableHomeomorphism::SMOOTH })
    {
      std::vector<Point> samples = PointsOf(pair.Source);
      const std::vector<Point> inside = PointsInTriangles(pair.Source, InsideWeights);
      samples.insert(samples.end(), inside.begin(), inside.end());
      const Mapped mapped = MapData(pair, AsFloats(MakeMesh(samples, {})), { system });
      ASSERT_TRUE(mapped.AllValid()) << "radius " << radius;
      for (std::size_t i = 0; i < samples.size(); ++i)
      {
        EXPECT_NEAR(mapped.Determinants[i], 2.0, 2e-2) << "radius " << radius;
        // A float near 1 is accurate to 6e-8, which moves a point by as much across the tube.
        const Point expected{ samples[i][0], 2.0 * samples[i][1], 2.0 * samples[i][2] };
        EXPECT_LT(Distance(mapped.Points[i], expected), 1e-6) << "radius " << radius;
      }
    }
  }
}

TEST(ThinSurfaces, RoundedPlanesArePlanar)
{
  // The converse: a tilted plane rounded to float is still a plane.
  std::mt19937_64 generator(5);
  for (int round = 0; round < 100; ++round)
  {
    const MeshPair flat = MakePlanarPair(3, 100 + round);
    const Plane plane =
      PlaneWithNormal({ 0.4, -0.8, 0.3 }, RandomUnit(generator), RandomUnit(generator));
    const MeshPair pair{ AsFloats(InPlane(flat.Source, plane)),
      AsFloats(InPlane(flat.Target, plane)) };
    // Only in a plane are points far above it inside.
    std::vector<Point> raised = PointsInTriangles(pair.Source, InsideWeights);
    for (Point& p : raised)
    {
      p = Combine(p, 0.7, plane.Normal);
    }
    ASSERT_TRUE(MapPoints(pair, raised).AllValid()) << round;
  }
}

//------------------------------------------------------------------------------------------------
// Orientation of normals.

/// Maps points at heights above one plane, and expects them at the same heights above the other.
void ExpectHeightsKept(
  const MeshPair& pair, const Plane& from, const Plane& to, int system, bool inverse)
{
  const std::vector<double> heights{ 0.0, 0.25, -0.25, 3.0, -7.5 };
  std::vector<Point> samples;
  for (const Point& foot : PointsInTriangles(inverse ? pair.Target : pair.Source, InsideWeights))
  {
    for (const double height : heights)
    {
      samples.push_back(Combine(foot, height, from.Normal));
    }
  }
  const Mapped mapped = MapPoints(pair, samples, { system, 0.0, inverse });
  ASSERT_TRUE(mapped.AllValid());
  // A few ulp of the coordinates of the meshes and of the heights.
  const double rounding = 1000.0 * Epsilon;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const double height = heights[i % heights.size()];
    ASSERT_NEAR(Dot(Combine(mapped.Points[i], -1.0, to.Origin), to.Normal), height, rounding);
    // The image lies above the image of its foot, which is the first of these heights. The foot is
    // known up to rounding, which the map magnifies.
    const Point& foot = mapped.Points[i - i % heights.size()];
    ASSERT_LT(Distance(mapped.Points[i], Combine(foot, height, to.Normal)), 1e3 * rounding);
    ASSERT_GT(mapped.Determinants[i], 0.0);
    Point normal;
    for (int row = 0; row < 3; ++row)
    {
      const auto* j = &mapped.Jacobians[i][3 * row];
      normal[row] = Dot({ j[0], j[1], j[2] }, from.Normal);
    }
    ASSERT_LT(Distance(normal, to.Normal), 1e-11);
  }
}

void ExpectHeightsKept(const MeshPair& pair, const Plane& source, const Plane& target, int system)
{
  ExpectHeightsKept(pair, source, target, system, false);
  ExpectHeightsKept(pair, target, source, system, true);
}

/// A pair in the xy plane, each mesh rotated, scaled and moved at random, so that the points that
/// determine the plane differ. All triangles keep their orientation.
MeshPair MakeScatteredPair(int n, std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> random(-1.0, 1.0);
  const MeshPair pair = MakePlanarPair(n, generator());
  for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
  {
    const double angle = vtkMath::Pi() * random(generator);
    const double scale = 0.5 + 0.25 * random(generator);
    const Point u{ scale * std::cos(angle), scale * std::sin(angle), 0.0 };
    const Point v{ -u[1], u[0], 0.0 };
    const Point origin{ random(generator), random(generator), 0.0 };
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
    {
      const Point p = PointOf(mesh, i);
      mesh->GetPoints()->SetPoint(i, Combine(origin, p[0], u, p[1], v).data());
    }
  }
  return pair;
}

TEST(TiltedPlanes, TiesBetweenAxesDoNotFlipHeights)
{
  // The two or three largest components of these normals are equal, so that rounding, which differs
  // between the two meshes, would decide their orientation.
  const std::vector<Point> normals{ { 1, -1, 0 }, { 1, 1, 0 }, { 0, 1, -1 }, { 0, -1, -1 },
    { 1, 0, -1 }, { -1, 0, -1 }, { 1, 1, -1 }, { -1, 1, 1 }, { 2, -2, 1 } };
  std::mt19937_64 generator(17);
  std::uniform_real_distribution<double> random(-0.5, 0.5);
  for (int round = 0; round < 200; ++round)
  {
    SCOPED_TRACE(round);
    // The plane y = x + 0.3 every other time.
    const Point normal = round % 2 == 0 ? normals[0] : normals[round / 2 % normals.size()];
    const Plane plane = PlaneWithNormal(
      { 0.0, 0.3, 0.0 }, normal, { random(generator), random(generator), random(generator) });
    const MeshPair flat = MakeScatteredPair(2, generator);
    const MeshPair pair{ InPlane(flat.Source, plane), InPlane(flat.Target, plane) };
    ExpectHeightsKept(pair, plane, plane, Systems[round % 3]);
    if (HasFatalFailure())
    {
      return;
    }
  }
}

TEST(TiltedPlanes, APlaneWithInexactCoordinatesKeepsHeights)
{
  // As a user would write it, with y computed from x.
  std::mt19937_64 generator(18);
  std::uniform_real_distribution<double> height(-2.0, 2.0);
  const Point normal = Unit({ -1, 1, 0 });
  for (int round = 0; round < 200; ++round)
  {
    const MeshPair pair = MakeScatteredPair(3, generator);
    for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
    {
      for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
      {
        const Point p = PointOf(mesh, i);
        mesh->GetPoints()->SetPoint(i, p[0], p[0] + 0.3, p[1]);
      }
    }
    std::vector<Point> samples = PointsInTriangles(pair.Source, InsideWeights);
    std::vector<double> heights;
    for (Point& p : samples)
    {
      heights.push_back(height(generator));
      p = Combine(p, heights.back(), normal);
    }
    const Mapped mapped = MapPoints(pair, samples);
    ASSERT_TRUE(mapped.AllValid()) << round;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      ASSERT_NEAR(
        Dot(Combine(mapped.Points[i], -1.0, { 0.0, 0.3, 0.0 }), normal), heights[i], 64.0 * Epsilon)
        << round;
      ASSERT_GT(mapped.Determinants[i], 0.0) << round;
    }

    // P = Q, in separate arrays, gives the identity, off the plane as well.
    const auto copy = vtkSmartPointer<vtkPolyData>::New();
    copy->DeepCopy(pair.Source);
    const Mapped same = MapPoints({ pair.Source, copy }, samples);
    ASSERT_TRUE(same.AllValid()) << round;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      ASSERT_LT(Distance(same.Points[i], samples[i]), 64.0 * Epsilon) << round;
      ASSERT_NEAR(same.Determinants[i], 1.0, 64.0 * Epsilon) << round;
    }
  }
}

TEST(TiltedPlanes, NormalsAgreeUpToARightAngle)
{
  // The largest component of the rotated normal often has another sign or axis. The orientation of
  // the target must follow from the source.
  std::mt19937_64 generator(19);
  std::uniform_real_distribution<double> angle(0.0, vtkMath::RadiansFromDegrees(89.0));
  for (int round = 0; round < 200; ++round)
  {
    SCOPED_TRACE(round);
    const MeshPair flat = MakeScatteredPair(2, generator);
    const Plane source =
      PlaneWithNormal({ 0.1, 0.2, -0.3 }, RandomUnit(generator), RandomUnit(generator));
    const Point axis = RandomUnit(generator);
    const double turn = angle(generator);
    const Plane target{ { 1.0, 0.0, 0.5 }, Turned(source.U, axis, turn),
      Turned(source.V, axis, turn), Turned(source.Normal, axis, turn) };
    const MeshPair pair{ InPlane(flat.Source, source), InPlane(flat.Target, target) };
    ExpectHeightsKept(pair, source, target, Systems[round % 3]);
    if (HasFatalFailure())
    {
      return;
    }
  }
}

Plane AxisPlane(int normalAxis, double distance, double sign)
{
  Plane plane{};
  plane.Origin[normalAxis] = distance;
  plane.U[(normalAxis + 1) % 3] = 1.0;
  plane.V[(normalAxis + 2) % 3] = sign;
  plane.Normal[normalAxis] = sign;
  return plane;
}

TEST(TiltedPlanes, ATargetParallelToAxesFollowsATiltedSource)
{
  // The planes x, y or z = constant have exact coordinates, and a normal of either sign.
  std::mt19937_64 generator(20);
  std::uniform_real_distribution<double> angle(
    vtkMath::RadiansFromDegrees(5.0), vtkMath::RadiansFromDegrees(85.0));
  for (int round = 0; round < 120; ++round)
  {
    SCOPED_TRACE(round);
    const MeshPair flat = MakeScatteredPair(2, generator);
    const Plane axisPlane = AxisPlane(round % 3, 0.7, round % 2 == 0 ? 1.0 : -1.0);
    const Point axis = RandomUnit(generator);
    const double turn = angle(generator);
    const Plane tilted{ { 1.0, 0.0, 0.5 }, Turned(axisPlane.U, axis, turn),
      Turned(axisPlane.V, axis, turn), Turned(axisPlane.Normal, axis, turn) };
    const MeshPair fromTilted{ InPlane(flat.Source, tilted), InPlane(flat.Target, axisPlane) };
    ExpectHeightsKept(fromTilted, tilted, axisPlane, Systems[round / 6 % 3]);
    const MeshPair toTilted{ InPlane(flat.Source, axisPlane), InPlane(flat.Target, tilted) };
    ExpectHeightsKept(toTilted, axisPlane, tilted, Systems[round / 6 % 3]);
    if (HasFatalFailure())
    {
      return;
    }
  }
}

TEST(TiltedPlanes, PlanesParallelToAxesInAllCombinations)
{
  // At right angles neither orientation is closer, and the normal of each plane points along its
  // axis.
  std::mt19937_64 generator(27);
  for (int from = 0; from < 3; ++from)
  {
    for (int to = 0; to < 3; ++to)
    {
      for (const int system : Systems)
      {
        SCOPED_TRACE(std::to_string(from) + " to " + std::to_string(to));
        const MeshPair flat = MakeScatteredPair(3, generator);
        const Plane source = AxisPlane(from, -2.25, 1.0);
        const Plane target = AxisPlane(to, 1.75, 1.0);
        const MeshPair pair{ InPlane(flat.Source, source), InPlane(flat.Target, target) };
        ExpectHeightsKept(pair, source, target, system);
        // Coordinates at dyadic heights are exact there.
        std::vector<Point> raised = PointsInTriangles(pair.Source, InsideWeights);
        for (Point& p : raised)
        {
          p[from] += 0.375;
        }
        const Mapped mapped = MapPoints(pair, raised, { system });
        for (const Point& image : mapped.Points)
        {
          ASSERT_EQ(image[to], 1.75 + 0.375);
        }
      }
    }
  }
}

TEST(TiltedPlanes, TheTransformAgreesOnNormals)
{
  std::mt19937_64 generator(21);
  std::uniform_real_distribution<double> angle(0.0, vtkMath::RadiansFromDegrees(89.0));
  for (int round = 0; round < 100; ++round)
  {
    SCOPED_TRACE(round);
    const MeshPair flat = MakeScatteredPair(2, generator);
    const Plane source = round % 2 == 0
      ? PlaneWithNormal({ 0.0, 0.3, 0.0 }, { -1, 1, 0 }, RandomUnit(generator))
      : PlaneWithNormal({ 0.1, 0.2, -0.3 }, RandomUnit(generator), RandomUnit(generator));
    const Point axis = RandomUnit(generator);
    const double turn = round % 2 == 0 ? 0.0 : angle(generator);
    const Plane target{ source.Origin, Turned(source.U, axis, turn), Turned(source.V, axis, turn),
      Turned(source.Normal, axis, turn) };
    const auto sourceMesh = InPlane(flat.Source, source);
    const auto targetMesh = InPlane(flat.Target, target);
    const vtkNew<vtkHomeomorphismTransform> transform;
    transform->SetSource(sourceMesh);
    transform->SetTarget(targetMesh);
    for (const Point& foot : PointsInTriangles(sourceMesh, InsideWeights))
    {
      for (const double height : { 0.5, -2.0 })
      {
        const Point surfacePoint = Combine(foot, height, source.Normal);
        Point image;
        double derivative[3][3];
        transform->Update();
        transform->InternalTransformDerivative(surfacePoint.data(), image.data(), derivative);
        ASSERT_NEAR(
          Dot(Combine(image, -1.0, target.Origin), target.Normal), height, 200.0 * Epsilon);
        ASSERT_GT(vtkMath::Determinant3x3(derivative), 0.0);
        Point back;
        transform->GetInverse()->TransformPoint(image.data(), back.data());
        ASSERT_LT(Distance(surfacePoint, back), 1e-12);
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
// Corners.

/// Counts the points that are not equal bit for bit.
int CountDifferent(const std::vector<Point>& a, const std::vector<Point>& b)
{
  int different = a.size() == b.size() ? 0 : -1;
  for (std::size_t i = 0; i < a.size() && different >= 0; ++i)
  {
    different += a[i] != b[i];
  }
  return different;
}

TEST(TiltedPlanes, CornersMapToTheStoredCorners)
{
  std::mt19937_64 generator(23);
  for (int round = 0; round < 60; ++round)
  {
    SCOPED_TRACE(round);
    const MeshPair flat = MakePlanarPair(4, 19 * round + 4);
    const Plane source = round % 3 == 0
      ? AxisPlane(2, 0.1, 1.0)
      : PlaneWithNormal({ 0.1, 0.2, -0.3 }, RandomUnit(generator), RandomUnit(generator));
    const Plane target = round % 3 == 1
      ? AxisPlane(round / 3 % 3, 0.1, 1.0)
      : PlaneWithNormal({ 3.1, 0.7, 0.9 }, RandomUnit(generator), RandomUnit(generator));
    const MeshPair pair{ InPlane(flat.Source, source), InPlane(flat.Target, target) };
    const Options forward{ Systems[round % 3] };
    const Options backward{ Systems[round % 3], 0.0, true };
    ASSERT_EQ(CountDifferent(MapData(pair, pair.Source, forward).Points, PointsOf(pair.Target)), 0);
    ASSERT_EQ(
      CountDifferent(MapData(pair, pair.Target, backward).Points, PointsOf(pair.Source)), 0);
  }
}

TEST(TiltedPlanes, CornersOfFloatMeshesMapToTheStoredCorners)
{
  // Corners in float lie off the plane by individual rounding errors.
  std::mt19937_64 generator(24);
  for (int round = 0; round < 40; ++round)
  {
    SCOPED_TRACE(round);
    const MeshPair flat = MakePlanarPair(4, 23 * round + 5);
    const Plane source =
      PlaneWithNormal({ 0.1, 0.2, -0.3 }, RandomUnit(generator), RandomUnit(generator));
    const Plane target =
      PlaneWithNormal({ 3.1, 0.7, 0.9 }, RandomUnit(generator), RandomUnit(generator));
    const MeshPair pair{ AsFloats(InPlane(flat.Source, source)),
      AsFloats(InPlane(flat.Target, target)) };
    ASSERT_EQ(CountDifferent(MapData(pair, pair.Source).Points, PointsOf(pair.Target)), 0);
  }
}

TEST(TiltedPlanes, CornersOfPlanesMapToTheStoredCornersOfSurfaces)
{
  std::mt19937_64 generator(25);
  for (int round = 0; round < 20; ++round)
  {
    SCOPED_TRACE(round);
    const Plane plane =
      PlaneWithNormal({ 0.1, 0.2, -0.3 }, RandomUnit(generator), RandomUnit(generator));
    const MeshPair pair{ InPlane(MakePlanarPair(4, 29 * round + 6).Source, plane),
      MakeSheet(4, 31 * round + 7, 0.8) };
    ASSERT_EQ(CountDifferent(MapData(pair, pair.Source).Points, PointsOf(pair.Target)), 0);
    ASSERT_EQ(CountDifferent(MapData(pair, pair.Target, { Systems[2], 0.0, true }).Points,
                PointsOf(pair.Source)),
      0);
  }
}

//------------------------------------------------------------------------------------------------
// Points near a surface.

/// Distance of a point from the nearest triangle of a mesh.
double DistanceFromMesh(vtkPolyData* mesh, const Point& p)
{
  double least = std::numeric_limits<double>::infinity();
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    mesh->GetCellPoints(cell, ids);
    const Point a = PointOf(mesh, ids->GetId(0));
    const Point ab = Combine(PointOf(mesh, ids->GetId(1)), -1.0, a);
    const Point ac = Combine(PointOf(mesh, ids->GetId(2)), -1.0, a);
    const Point ap = Combine(p, -1.0, a);
    const Point normal = Cross(ab, ac);
    const double area = Dot(normal, normal);
    const double u = Dot(Cross(ap, ac), normal) / area;
    const double v = Dot(Cross(ab, ap), normal) / area;
    // Images are inside a triangle or on its edge, so edges need no separate distance.
    if (u > -1e-12 && v > -1e-12 && u + v < 1.0 + 1e-12)
    {
      least = std::min(least, std::abs(Dot(ap, normal)) / std::sqrt(area));
    }
  }
  return least;
}

void ExpectLandingOn(
  const MeshPair& pair, const std::vector<Point>& samples, double tolerance, bool inverse = false)
{
  vtkPolyData* goal = inverse ? pair.Source : pair.Target;
  for (const int system : Systems)
  {
    const Mapped mapped = MapPoints(pair, samples, { system, tolerance, inverse });
    ASSERT_TRUE(mapped.AllValid());
    for (const Point& image : mapped.Points)
    {
      EXPECT_LT(DistanceFromMesh(goal, image), 1e-13);
    }
    // Without the tolerance they are outside.
    const Mapped strict = MapPoints(pair, samples, { system, 0.0, inverse });
    EXPECT_EQ(std::count(strict.Valid.begin(), strict.Valid.end(), true), 0);
  }
}

std::vector<Point> Raised(std::vector<Point> points, double height)
{
  for (Point& p : points)
  {
    p[2] += height;
  }
  return points;
}

TEST(PointsNearSurfaces, PointsWithinTheToleranceMapOntoTheOtherSurface)
{
  const MeshPair pair{ MakeSheet(4, 41, 0.5), MakeSheet(4, 42, 0.9) };
  for (const double height : { 0.05, -0.05 })
  {
    ExpectLandingOn(pair, Raised(PointsInTriangles(pair.Source, InsideWeights), height), 0.1);
    ExpectLandingOn(pair, Raised(PointsInTriangles(pair.Target, InsideWeights), height), 0.1, true);
  }
}

TEST(PointsNearSurfaces, PointsNearAPlaneMapOntoTheSurface)
{
  // A pair of a plane and a surface is a pair of surfaces: heights above the plane are not kept.
  const MeshPair pair{ MakePlanarPair(4, 43).Source, MakeSheet(4, 44, 0.9) };
  for (const double height : { 0.05, -0.05 })
  {
    ExpectLandingOn(pair, Raised(PointsInTriangles(pair.Source, InsideWeights), height), 0.1);
    ExpectLandingOn(pair, Raised(PointsInTriangles(pair.Target, InsideWeights), height), 0.1, true);
  }
}

TEST(PointsNearSurfaces, PointsNearTheBoundaryMapOntoTheOtherSurface)
{
  // Near the boundary the nearest point is on an edge or corner.
  const MeshPair pair{ MakePlanarPair(4, 45).Source, MakeSheet(4, 46, 0.9) };
  std::vector<Point> samples;
  for (const double t : { 0.3, 1.7, 3.9 })
  {
    for (const double z : { 0.0, 0.03 })
    {
      samples.insert(samples.end(),
        { { t, -0.04, z }, { t, 4.04, z }, { -0.04, t, z }, { 4.04, t, z }, { -0.02, -0.03, z } });
    }
  }
  ExpectLandingOn(pair, samples, 0.1);
}

TEST(PointsNearSurfaces, TheMapIsContinuousAtCorners)
{
  // Corners are mapped by a separate rule, which must agree with the map around them.
  const MeshPair sheets{ MakeSheet(3, 47, 0.5), MakeSheet(3, 48, 0.9) };
  const MeshPair lifted{ MakePlanarPair(3, 49).Source, sheets.Target };
  const double step = 1e-9;
  for (const MeshPair& pair : { sheets, lifted, MeshPair{ lifted.Target, lifted.Source } })
  {
    const std::vector<Point> corners = PointsOf(pair.Source);
    const std::vector<Point> images = PointsOf(pair.Target);
    // Straight above a corner of a plane, and close to any corner, the corner is the nearest point.
    const std::vector<double> heights = pair.Source == lifted.Source
      ? std::vector<double>{ 0.0, step, 0.05, -0.05 }
      : std::vector<double>{ 0.0, step };
    for (const int system : Systems)
    {
      for (const double height : heights)
      {
        for (const Point& offset : std::vector<Point>{ {}, { step, 0, 0 }, { -step, 0, 0 },
               { 0, step, 0 }, { 0, -step, 0 }, { 0, 0, step } })
        {
          std::vector<Point> samples = Raised(corners, height);
          for (Point& p : samples)
          {
            p = Combine(p, 1.0, offset);
          }
          const Mapped mapped = MapPoints(pair, samples, { system, 0.1 });
          ASSERT_TRUE(mapped.AllValid());
          for (std::size_t i = 0; i < corners.size(); ++i)
          {
            EXPECT_LT(Distance(mapped.Points[i], images[i]), 100.0 * step);
          }
        }
      }
    }
  }
}

} // namespace
