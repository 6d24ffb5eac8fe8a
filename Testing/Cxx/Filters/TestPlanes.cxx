// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// For pairs of planes anywhere in space, the map preserves distances from the planes, with
// consistent normals; points near a surface are mapped onto the other surface.

#include "Fixtures/FilterRuns.h"

namespace
{

using namespace fixtures;

/// The origin of a plane and right-handed axes: two in the plane, and the normal.
struct Plane
{
  Point Origin;
  Matrix Axes;

  Point At(double x, double y) const
  {
    return this->Origin + Transposed(this->Axes) * Point{ x, y };
  }
  const Point& Normal() const { return this->Axes[2]; }
};

Plane PlaneWithNormal(const Point& origin, const Point& normal, const Point& helper)
{
  const Point n = Unit(normal);
  const Point v = Unit(Cross(n, helper));
  return { origin, { Cross(v, n), v, n } };
}

/// The plane in which the coordinate of an axis is constant.
Plane AxisPlane(int normalAxis, double distance, double sign)
{
  Plane plane{};
  plane.Origin[normalAxis] = distance;
  plane.Axes[0][(normalAxis + 1) % 3] = 1.0;
  plane.Axes[1][(normalAxis + 2) % 3] = sign;
  plane.Axes[2][normalAxis] = sign;
  return plane;
}

/// Another origin, and axes turned about a random axis.
Plane Turned(const Plane& plane, Random& random, double degrees)
{
  const Matrix turn = Rotation(random.Vector(), vtkMath::RadiansFromDegrees(degrees));
  return { random.Vector(), plane.Axes * Transposed(turn) };
}

/// A pair of planes, each mesh rotated, scaled and moved at random in its plane, so that the points
/// that determine the plane differ. All triangles keep their orientation.
MeshPair MakePair(int n, Random& random, const Plane& source, const Plane& target)
{
  const MeshPair pair = MakePlanarPair(n, static_cast<std::uint64_t>(random.Below(1 << 20)));
  const auto place = [&random](vtkPolyData* mesh, const Plane& plane) {
    const double angle = random.Uniform(-3.0, 3.0);
    const double scale = random.Uniform(0.25, 0.75);
    const double c = scale * std::cos(angle);
    const double s = scale * std::sin(angle);
    const Point shift = random.Vector();
    return Moved(mesh, [&](const Point& p) {
      return plane.At(c * p[0] - s * p[1] + shift[0], s * p[0] + c * p[1] + shift[1]);
    });
  };
  return { place(pair.Source, source), place(pair.Target, target) };
}

/// Points at heights above one plane are mapped to the same heights above the other, by the filter
/// in both directions and by the transform.
void ExpectHeightsKept(
  const MeshPair& pair, const Plane& source, const Plane& target, const System& system)
{
  const std::vector<double> heights{ 0.0, 0.25, -0.25, 3.0, -7.5 };
  const double rounding = 1000.0 * Ulp;
  const auto transform = MakeTransform(system, pair);
  transform->Update();
  for (const bool inverse : { false, true })
  {
    const Plane& from = inverse ? target : source;
    const Plane& to = inverse ? source : target;
    vtkPolyData* mesh = inverse ? pair.Target : pair.Source;
    vtkAbstractTransform* same = inverse ? transform->GetInverse() : transform.Get();
    std::vector<Point> feet = SamplePoints(mesh, TrianglesOf(mesh), 3, 1);
    // A corner inside the grid, which is mapped by a separate rule.
    feet.push_back(PointOf(mesh, std::lround(std::sqrt(mesh->GetNumberOfPoints())) + 1));
    std::vector<Point> samples;
    for (const Point& foot : feet)
    {
      for (const double height : heights)
      {
        samples.push_back(foot + height * from.Normal());
      }
    }
    const auto filter = MakeFilter(system, pair, MakeCloud(samples));
    filter->SetInverse(inverse);
    ComputeEverything(filter);
    vtkPointSet* output = Output(filter);
    ASSERT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      const auto id = static_cast<vtkIdType>(i);
      const double height = heights[i % heights.size()];
      const Point image = PointOf(output, id);
      ASSERT_NEAR(Dot(image - to.Origin, to.Normal()), height, rounding);
      // The image lies above the image of its foot, which is the first of these heights.
      const Point foot = PointOf(output, id - static_cast<vtkIdType>(i % heights.size()));
      ASSERT_LT(Distance(image, foot + height * to.Normal()), 1e3 * rounding);
      ASSERT_GT(PointValue(output, "JacobianDeterminant", id), 0.0);
      ASSERT_LT(Distance(JacobianOf(output, id) * from.Normal(), to.Normal()), 1e-11);
      ASSERT_EQ(Transformed(same, samples[i]), image);
    }
  }
}

using Planes = TestInEverySystem;

INSTANTIATE_TEST_SUITE_P(All, Planes, ::testing::Values(Linear, Incenter, Smooth), NameOfSystem);

TEST_P(Planes, NormalsAgreeUpToARightAngle)
{
  // The two or three largest components of these normals are equal, so that rounding, which differs
  // between the two meshes, would decide their orientation.
  const std::vector<Point> ties{ { 1, -1, 0 }, { 1, 1, 0 }, { 0, 1, -1 }, { 0, -1, -1 },
    { 1, 0, -1 }, { -1, 0, -1 }, { 1, 1, -1 }, { -1, 1, 1 }, { 2, -2, 1 } };
  Random random(19);
  std::vector<std::pair<Plane, Plane>> planes;
  // At right angles neither orientation is closer, and the normal of each plane points along its
  // axis.
  for (int k = 0; k < 9; ++k)
  {
    planes.emplace_back(AxisPlane(k / 3, -2.25, 1.0), AxisPlane(k % 3, 1.75, 1.0));
  }
  for (int round = 0; round < 60; ++round)
  {
    // A tie, any plane, or one parallel to two axes with either normal; and the same plane, or one
    // turned by less than a right angle.
    const Point tie = ties[static_cast<std::size_t>(round) / 3 % ties.size()];
    const Plane source = round % 3 == 2
      ? AxisPlane(round / 3 % 3, 0.7, round % 2 == 0 ? 1.0 : -1.0)
      : PlaneWithNormal({ 0.0, 0.3, 0.0 }, round % 3 == 0 ? tie : random.Vector(), random.Vector());
    const bool isTurned = round % 3 > 0 || round % 2 > 0;
    const Plane target = isTurned ? Turned(source, random, random.Uniform(5.0, 89.0)) : source;
    planes.emplace_back(source, target);
    planes.emplace_back(target, source);
  }
  for (std::size_t i = 0; i < planes.size(); ++i)
  {
    SCOPED_TRACE(i);
    const auto& [source, target] = planes[i];
    ExpectHeightsKept(MakePair(2, random, source, target), source, target, GetParam());
  }
}

TEST_P(Planes, PointsWithinTheToleranceOfASurfaceMapOntoTheOther)
{
  const auto sheet = MakeSheet(4, 42, 0.9);
  const auto plane = MakePlanarPair(4, 43).Source;
  const MeshPair sheets{ MakeSheet(4, 41, 0.5), sheet };
  for (const MeshPair& pair : { sheets, MeshPair{ plane, sheet }, MeshPair{ sheet, plane } })
  {
    std::vector<Point> samples;
    for (const Point& p : SamplePoints(pair.Source, TrianglesOf(pair.Source), 3, 1))
    {
      samples.insert(samples.end(), { p + Point{ 0, 0, 0.05 }, p - Point{ 0, 0, 0.05 } });
    }
    // Near the boundary of the plane the nearest point is on an edge or a corner.
    for (const double t : { 0.3, 1.7, 3.9 })
    {
      if (pair.Source == plane)
      {
        samples.insert(samples.end(),
          { { t, -0.04, 0 }, { t, 4.04, 0.03 }, { -0.04, t, 0.03 }, { 4.04, t, 0 },
            { -0.02, -0.03, 0.03 } });
      }
    }
    const auto filter = MakeFilter(GetParam(), pair, MakeCloud(samples));
    filter->SetTolerance(0.1);
    EXPECT_LT(LargestDistanceFrom(pair.Target, PointsOf(Output(filter))), 1e-13);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);

    // Corners are mapped by a separate rule, which must agree with the map around them.
    const double step = 1e-9;
    std::vector<Point> offsets{ {}, { step, 0, 0 }, { -step, 0, 0 }, { 0, step, 0 },
      { 0, -step, 0 }, { 0, 0, step } };
    if (pair.Source == plane)
    {
      offsets.insert(offsets.end(), { { 0, 0, 0.05 }, { step, 0, -0.05 } });
    }
    for (const Point& offset : offsets)
    {
      filter->SetDataObject(Moved(pair.Source, [&](const Point& p) { return p + offset; }));
      EXPECT_LT(LargestDistance(Output(filter), pair.Target), 100.0 * step);
      EXPECT_EQ(filter->GetNumberOfOutsidePoints(), 0);
    }
    filter->SetTolerance(0.0);
    filter->SetDataObject(MakeCloud(samples));
    filter->Update();
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), static_cast<vtkIdType>(samples.size()));
  }
}

} // namespace
