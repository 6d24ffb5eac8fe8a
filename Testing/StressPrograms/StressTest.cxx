// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Maps the requested number of points in extreme meshes at extreme positions, and compares the
// errors with the bounds of Documentation/accuracy.md. The result depends on the seed and on the
// number of points, not on the number of threads.
//
//   StressTest [--points N] [--seed N] [--system NAME] [--family NAME] [--threads N]
//   StressTest --system NAME --family NAME --case N [--seed N]

#include "StressMeshes.h"

#include "Kernel/CubicElement.h"
#include "Kernel/ExactSign.h"
#include "Mesh/Homeomorphism.h"

#include "vtkSMPTools.h"

#include <atomic>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <thread>

namespace
{

using namespace homeomorphism_stress;
using fixtures::Infinity;

constexpr double HalfUlp = Ulp / 2.0;
constexpr int PointsPerCase = 256;

/// The measured values. Each is compared with 1: Measure() divides by the bounds.
enum Quantity
{
  LOCATION,
  INSIDE,
  ROUND_TRIP,
  DETERMINANT,
  ORIENTATION,
  LOST,
  NUMBER_OF_QUANTITIES
};

constexpr std::array<const char*, NUMBER_OF_QUANTITIES> QuantityNames{ "location", "image inside",
  "round trip", "det J", "orientation", "a point of the domain was not found" };

// The constants of the bounds, see Documentation/accuracy.md.
constexpr double LocationLimit = 16.0;
constexpr double InsideLimit = 8.0;
constexpr double RoundTripLimit = 128.0;

struct WorstCase
{
  double Value = 0.0;
  std::int64_t Case = -1;

  void Take(double value, std::int64_t number)
  {
    // NaN is the worst value.
    if (std::isnan(value))
    {
      value = Infinity;
    }
    if (this->Case < 0 || value > this->Value || (value == this->Value && number < this->Case))
    {
      *this = { value, number };
    }
  }
  void Take(const WorstCase& other)
  {
    if (other.Case >= 0)
    {
      this->Take(other.Value, other.Case);
    }
  }
};

struct Report
{
  std::array<WorstCase, NUMBER_OF_QUANTITIES> Worsts;
  std::int64_t Pairs = 0;
  std::int64_t Refused = 0;
  std::int64_t Points = 0;
  std::int64_t Oriented = 0;
  std::int64_t Lost = 0;

  void Take(const Report& other)
  {
    for (int q = 0; q < NUMBER_OF_QUANTITIES; ++q)
    {
      this->Worsts[q].Take(other.Worsts[q]);
    }
    this->Pairs += other.Pairs;
    this->Refused += other.Refused;
    this->Points += other.Points;
    this->Oriented += other.Oriented;
    this->Lost += other.Lost;
  }
};

vtkSmartPointer<vtkPolyData> MakeMesh(const std::vector<Vector2>& points, const Triangles& cells)
{
  std::vector<fixtures::Point> inSpace;
  for (const Vector2& p : points)
  {
    inSpace.push_back({ p.x, p.y, 0.0 });
  }
  return fixtures::MakeMesh(inSpace, cells);
}

/// One pair of meshes, its map, and test points.
class Case
{
public:
  /// With a log, the meshes and what is measured at each point are printed.
  Case(const TestedSystem& system, int family, std::uint64_t seed, std::int64_t number,
    bool log = false)
    : System(system)
    , Numbers(Mixed(seed, system, family, number))
    , Number(number)
    , Log(log)
  {
    // Half of the pairs of some families overlap or lose a triangle to rounding.
    for (int i = 0; i < 64 && !this->Map; ++i)
    {
      this->Pair = AnyPair(this->Numbers, family, system);
      const auto source = MakeMesh(this->Pair.Points[0], this->Pair.Cells);
      const auto target = MakeMesh(this->Pair.Points[1], this->Pair.Cells);
      HomeomorphismOptions options;
      options.System = system.System;
      options.Center = system.Center;
      MeshDiagnostics problems;
      this->Map = Homeomorphism::Make(source, target, options, problems);
      this->Result.Refused += !this->Map;
    }
  }

  /// Measures all points.
  const Report& Run()
  {
    if (this->Log)
    {
      this->PrintMeshes();
    }
    this->Result.Pairs = this->Map ? 1 : 0;
    for (int i = 0; i < PointsPerCase && this->Map; ++i)
    {
      const Domain from = this->Numbers.Chance(0.5) ? Domain::Source : Domain::Target;
      const auto triangle =
        static_cast<TriangleIndex>(this->Numbers.Below(static_cast<int>(this->Pair.Cells.size())));
      this->Measure(from, triangle, this->AnyPoint(from, triangle));
    }
    return this->Result;
  }

private:
  void PrintMeshes() const
  {
    for (int domain = 0; domain < 2; ++domain)
    {
      std::cout << (domain ? "target" : "source") << " points:\n";
      for (const Vector2& p : this->Pair.Points[domain])
      {
        std::cout << "  " << p.x << ", " << p.y << "\n";
      }
    }
    std::cout << "triangles:";
    for (const auto& cell : this->Pair.Cells)
    {
      std::cout << " (" << cell[0] << " " << cell[1] << " " << cell[2] << ")";
    }
    std::cout << "\n";
  }

  static std::uint64_t Mixed(
    std::uint64_t seed, const TestedSystem& system, int family, std::int64_t number)
  {
    std::uint64_t x = seed;
    for (const std::uint64_t part :
      { static_cast<std::uint64_t>(system.System), static_cast<std::uint64_t>(system.Center),
        static_cast<std::uint64_t>(family), static_cast<std::uint64_t>(number) })
    {
      // splitmix64
      x += 0x9e3779b97f4a7c15u * (part + 1);
      x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
      x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
      x ^= x >> 31;
    }
    return x;
  }

  const MeshGeometry& GeometryOf(Domain domain) const
  {
    return this->Map->GetPair().GetGeometry(domain);
  }

  /// The corners of a triangle in normalized coordinates.
  Corners CornersOf(Domain domain, TriangleIndex triangle) const
  {
    const auto& ids = this->Map->GetPair().GetTriangulation().GetCorners(triangle);
    const MeshGeometry& geometry = this->GeometryOf(domain);
    return { geometry.GetPlanePoint(ids[0]), geometry.GetPlanePoint(ids[1]),
      geometry.GetPlanePoint(ids[2]) };
  }

  static Vector2 Combined(const Corners& corners, const Barycentric& l)
  {
    return l[0] * corners[0] + l[1] * corners[1] + l[2] * corners[2];
  }

  /// A random point in coordinates of the input: anywhere, or on or within a few ulp of the lines
  /// at which formulas change.
  Vector3 AnyPoint(Domain domain, TriangleIndex triangle)
  {
    Random& random = this->Numbers;
    const MeshGeometry& geometry = this->GeometryOf(domain);
    const Corners corners = this->CornersOf(domain, triangle);
    const int kind = random.Below(10);
    const int k = random.Below(3);
    const double proportion = random.Proportion();
    Barycentric l{};
    switch (kind)
    {
      case 0:
      case 1:
        l = random.Weights();
        break;
      case 2:
        // Close to an edge or a vertex by any power of ten.
        l = LinearChart(geometry.GetShape(triangle))
              .FromCoordinates({ k + 1, proportion, 1.0 - random.PowerOfTen(-18.0, 0.0) });
        break;
      case 3:
        l[k] = 1.0;
        break;
      case 4:
      case 5:
        l[NextCorner(k)] = 1.0 - proportion;
        l[PreviousCorner(k)] = proportion;
        break;
      case 6:
        l.fill(1.0 / 3.0);
        break;
      default:
        // Between the centroid and a vertex.
        l.fill((1.0 - proportion) / 3.0);
        l[k] += proportion;
    }
    const Vector2 normalized = kind < 8
      ? Combined(corners, l)
      : this->OnLineOfTheSystem(domain, triangle, corners, k, proportion);
    Vector3 point;
    geometry.FromNormalized({ normalized.x, normalized.y, 0.0 }, point.data());
    if (random.Chance(0.5))
    {
      for (int axis = 0; axis < 2; ++axis)
      {
        point[axis] = MovedByUlps(point[axis], random.Integer(-4, 4));
      }
    }
    return point;
  }

  Vector2 OnLineOfTheSystem(
    Domain domain, TriangleIndex triangle, const Corners& corners, int k, double proportion) const
  {
    const ChartedTriangulation& charts = this->Map->GetCharts(domain);
    switch (this->System.System)
    {
      case homeomorphism::CoordinateSystem::Smooth:
        return Combined(
          corners, OnStripBorder(k, charts.GetSmoothChart(triangle).StripWidth(k), proportion));
      case homeomorphism::CoordinateSystem::Contour:
      {
        // A wing segment, in the frame of the triangle.
        const ContourChart& chart = charts.GetContourChart(triangle);
        const MeshGeometry& geometry = this->GeometryOf(domain);
        const Vector2 middle = 0.5 * (chart.Center() + chart.Foot(k + 1));
        const Vector2 end =
          geometry.GetShape(triangle).Corner(proportion < 0.3 ? NextCorner(k) : PreviousCorner(k));
        const Vector3 normalized =
          geometry.FromFrame(triangle, { (1.0 - proportion) * middle + proportion * end, 0.0 });
        return { normalized[0], normalized[1] };
      }
      default:
        return Combined(corners, { 0.5, 0.25, 0.25 });
    }
  }

  SurfacePoint Locate(Domain domain, const Vector3& point, TriangleIndex hint) const
  {
    return this->Map->Locate(
      domain, point.data(), this->Map->GetAbsoluteTolerance(domain, 0.0, HalfUlp), hint);
  }

  /// The norm and the determinant of the derivative in normalized coordinates.
  struct Derivative
  {
    double Norm;
    double Determinant;
  };

  Derivative DerivativeAt(Domain from, const SurfacePoint& surfacePoint) const
  {
    const Jacobian jacobian = this->Map->GetJacobian(from, surfacePoint);
    const double rescale =
      this->GeometryOf(Opposite(from)).GetScale() / this->GeometryOf(from).GetScale();
    const auto& m = jacobian.Matrix;
    return { Norm(
               Matrix2{ { rescale * m[0], rescale * m[3] }, { rescale * m[1], rescale * m[4] } }),
      jacobian.Determinant * rescale * rescale };
  }

  /// The magnitude S of a triangle: the largest coordinate of its corners, and at least the least
  /// normal number of the input, below which precision decreases.
  double SizeOf(Domain domain, TriangleIndex triangle) const
  {
    const Corners corners = this->CornersOf(domain, triangle);
    double size = std::numeric_limits<double>::min() * this->GeometryOf(domain).GetScale();
    for (const Vector2& p : corners)
    {
      size = std::max({ size, std::abs(p.x), std::abs(p.y) });
    }
    return size;
  }

  /// The stretch of the reference by the chart of a triangle, divided by its longest edge; at
  /// least 1.
  double StretchAt(Domain domain, const SurfacePoint& surfacePoint, const Barycentric& l) const
  {
    return Magnification(this->Map->GetCharts(domain).GetSmoothChart(surfacePoint.Triangle),
      this->GeometryOf(domain).GetShape(surfacePoint.Triangle), l)
      .Forward;
  }

  double DistanceFromDomain(Domain domain, const Vector3& point) const
  {
    const Vector3 w = this->GeometryOf(domain).ToNormalized(point.data());
    double nearest = Infinity;
    for (TriangleIndex t = 0; t < static_cast<TriangleIndex>(this->Pair.Cells.size()); ++t)
    {
      nearest = std::min(nearest, DistanceOutside(this->CornersOf(domain, t), { w[0], w[1] }));
    }
    return nearest;
  }

  Vector3 Image(Domain from, const SurfacePoint& surfacePoint) const
  {
    Vector3 image;
    this->Map->MapPoint(from, surfacePoint, image.data());
    return image;
  }

  Vector2 WorkingImage(Domain from, const SurfacePoint& surfacePoint) const
  {
    const Vector3 w =
      this->GeometryOf(Opposite(from)).ToNormalized(this->Image(from, surfacePoint).data());
    return { w[0], w[1] };
  }

  void Take(Quantity quantity, double value)
  {
    this->Result.Worsts[quantity].Take(value, this->Number);
    if (this->Log)
    {
      std::cout << QuantityNames[quantity] << ": " << value << " of its limit\n";
    }
  }

  void Lose()
  {
    ++this->Result.Lost;
    this->Take(LOST, Infinity);
  }

  void Measure(Domain from, TriangleIndex triangle, const Vector3& point)
  {
    const Domain to = Opposite(from);
    const MeshGeometry& source = this->GeometryOf(from);
    const MeshGeometry& target = this->GeometryOf(to);
    ++this->Result.Points;
    const SurfacePoint surfacePoint = this->Locate(from, point, triangle);
    if (this->Log)
    {
      std::cout << "point of the " << (from == Domain::Source ? "source" : "target") << ": "
                << point[0] << ", " << point[1] << ", in triangle " << surfacePoint.Triangle
                << "\n";
    }
    if (surfacePoint.Triangle < 0)
    {
      // A point a few ulp outside is outside if it is farther than the tolerance, which is itself
      // rounded.
      if (!(this->DistanceFromDomain(from, point) >
            0.25 * this->Map->GetAbsoluteTolerance(from, 0.0, HalfUlp)))
      {
        this->Lose();
      }
      return;
    }

    // The located position: points outside by rounding move to the nearest point of the domain.
    const Vector3 w = source.ToNormalized(point.data());
    const Vector3 p = source.FromFrame(surfacePoint.Triangle, surfacePoint.Point);
    const Vector2 start{ p[0], p[1] };
    this->Take(LOCATION,
      Norm(start - Vector2{ w[0], w[1] }) /
        (LocationLimit * HalfUlp * source.GetLargestCoordinate()));

    // The image lies in the counterpart of the triangle.
    const Vector3 image = this->Image(from, surfacePoint);
    const Vector3 imageWorking = target.ToNormalized(image.data());
    const Vector2 y{ imageWorking[0], imageWorking[1] };
    const Corners imageCorners = this->CornersOf(to, surfacePoint.Triangle);
    const double targetSize = this->SizeOf(to, surfacePoint.Triangle);
    this->Take(INSIDE, DistanceOutside(imageCorners, y) / (InsideLimit * HalfUlp * targetSize));

    // The determinant is positive, or negative in a mirrored pair, which rounding to millimeters
    // can produce.
    const Derivative derivative = this->DerivativeAt(from, surfacePoint);
    const Corners corners = this->CornersOf(from, surfacePoint.Triangle);
    const int sense = Orientation(corners[0], corners[1], corners[2]) *
      Orientation(imageCorners[0], imageCorners[1], imageCorners[2]);
    this->Take(DETERMINANT,
      sense * derivative.Determinant > 0.0 &&
          std::isfinite(derivative.Determinant + derivative.Norm)
        ? 0.0
        : Infinity);

    this->MeasureRoundTrip(from, surfacePoint, start, image, derivative);
    this->MeasureOrientation(from, surfacePoint, targetSize);
  }

  void MeasureRoundTrip(Domain from, const SurfacePoint& surfacePoint, const Vector2& start,
    const Vector3& image, const Derivative& derivative)
  {
    const Domain to = Opposite(from);
    const SurfacePoint there = this->Locate(to, image, -1);
    if (there.Triangle < 0)
    {
      this->Lose();
      return;
    }
    const Vector2 back = this->WorkingImage(to, there);
    double sourceStretch = 1.0;
    double targetStretch = 1.0;
    if (this->System.System == homeomorphism::CoordinateSystem::Smooth)
    {
      const Barycentric l = this->Map->GetCharts(from)
                              .GetSmoothChart(surfacePoint.Triangle)
                              .ToReference(surfacePoint.Point.InPlane);
      sourceStretch = this->StretchAt(from, surfacePoint, l);
      targetStretch = this->StretchAt(to, surfacePoint, l);
    }
    const double error = Norm(back - start);
    // Rounding may have moved the image into a neighbor.
    const auto sizeOf = [&](Domain domain) {
      return std::max(
        this->SizeOf(domain, surfacePoint.Triangle), this->SizeOf(domain, there.Triangle));
    };
    const double sourceSize = sizeOf(from) * sourceStretch;
    const double stretchedSize = sizeOf(to) * targetStretch;
    const double inverseNorm = derivative.Norm / std::abs(derivative.Determinant);
    double limit = RoundTripLimit * HalfUlp * (sourceSize + inverseNorm * stretchedSize);
    if (!(error <= limit))
    {
      // Where the derivative changes within the rounding of the image, the bound is the change of
      // the preimage under that rounding.
      limit += 4.0 * this->LargestShiftNear(to, image, 32.0 * HalfUlp * stretchedSize, back);
    }
    this->Take(ROUND_TRIP, error / limit);
  }

  /// The greatest distance from a position of the images of points within some distance of a point:
  /// the factor by which the map from the domain of @a from magnifies rounding, even if its
  /// derivative changes quickly.
  double LargestShiftNear(
    Domain from, const Vector3& point, double distance, const Vector2& image) const
  {
    const MeshGeometry& geometry = this->GeometryOf(from);
    const Vector3 normalized = geometry.ToNormalized(point.data());
    double largest = 0.0;
    for (TriangleIndex t = 0; t < static_cast<TriangleIndex>(this->Pair.Cells.size()); ++t)
    {
      if (DistanceOutside(this->CornersOf(from, t), { normalized[0], normalized[1] }) > distance)
      {
        continue;
      }
      const TriangleShape& shape = geometry.GetShape(t);
      const Vector2 center = geometry.ToFrame(t, normalized).InPlane;
      // A triangle may be thinner than the distance; then its whole thickness counts.
      for (int i = 0; i < 5; ++i)
      {
        const double x = std::min(shape.Base, std::max(0.0, center.x + 0.5 * (i - 2) * distance));
        const double thickness = x < shape.ApexX
          ? shape.Height * (x / shape.ApexX)
          : shape.Height * ((shape.Base - x) / (shape.Base - shape.ApexX));
        const double lower = std::max(0.0, center.y - distance);
        const double upper = std::min(thickness, center.y + distance);
        for (int j = 0; j < 33 && lower <= upper; ++j)
        {
          SurfacePoint nearby;
          nearby.Triangle = t;
          nearby.Point.InPlane = { x, lower + 0.03125 * j * (upper - lower) };
          largest = std::max(largest, Norm(this->WorkingImage(from, nearby) - image));
        }
      }
    }
    return largest;
  }

  /// The derivative between the frames of the triangles, in which needles are well-conditioned.
  Matrix2 FrameDerivativeAt(Domain from, const SurfacePoint& surfacePoint) const
  {
    return this->Map->GetCharts(from).VisitCharts(this->Map->GetCharts(Opposite(from)),
      surfacePoint.Triangle, [&](const auto& chart, const auto& other) {
        return MapDerivative(chart, other, chart.ToReference(surfacePoint.Point.InPlane));
      });
  }

  /// Maps a triangle around the point, so small that the map is almost affine on it and so large
  /// that rounding does not matter, and checks its orientation.
  void MeasureOrientation(Domain from, const SurfacePoint& surfacePoint, double targetSize)
  {
    const TriangleShape& shape = this->GeometryOf(from).GetShape(surfacePoint.Triangle);
    const Barycentric l = shape.ToBarycentric(surfacePoint.Point.InPlane);
    const double room = std::min({ l[0], l[1], l[2] });
    const int turn = this->Numbers.Below(2);
    // The orientation of the frame is that of the corners, whatever their order in the plane.
    const double handedness = this->GeometryOf(Opposite(from)).GetHandedness(surfacePoint.Triangle);
    const double rounding = 64.0 * HalfUlp * targetSize;
    constexpr int tries = 16;
    for (int attempt = 0; attempt < tries; ++attempt)
    {
      const double size = std::ldexp(room, -6 - 3 * attempt);
      if (size < 1e-13)
      {
        return;
      }
      // The corners, and the midpoints of the edges.
      constexpr int count = 6;
      std::array<SurfacePoint, count> samples;
      std::array<Matrix2, count> derivatives;
      std::array<int, count> edges{};
      for (int k = 0; k < count; ++k)
      {
        Barycentric moved = l;
        const double step = k < 3 ? size : -0.5 * size;
        moved[k % 3] += step;
        moved[(k % 3 + 1 + turn) % 3] -= step;
        samples[k].Triangle = surfacePoint.Triangle;
        samples[k].Point.InPlane = shape.FromBarycentric(moved);
        derivatives[k] = this->FrameDerivativeAt(from, samples[k]);
        if (this->System.System == homeomorphism::CoordinateSystem::Contour)
        {
          edges[k] = this->Map->GetCoordinates(from, samples[k]).Edge;
        }
      }
      if (std::count(edges.begin(), edges.end(), edges[0]) < count)
      {
        continue;
      }
      const Vector2& corner = samples[0].Point.InPlane;
      const Vector2 first = samples[1].Point.InPlane - corner;
      const Vector2 second = samples[2].Point.InPlane - corner;
      // The effect of rounding on the triangle itself. It does not depend on the shape of the
      // triangle except for Contour, whose frames are those of the edges.
      const double area = Cross(first, second);
      if (area < 1e-3 * size * size * shape.Base * shape.Height ||
        (this->System.System == homeomorphism::CoordinateSystem::Contour &&
          area < 64.0 * HalfUlp * shape.Base * Norm(first)))
      {
        return;
      }
      // The map is almost affine if the images under all derivatives are nearly the same.
      const double predicted = Cross(derivatives[0] * first, derivatives[0] * second);
      bool tame = predicted > 0.0;
      double longest = 0.0;
      for (int a = 0; a < count && tame; ++a)
      {
        longest =
          std::max({ longest, Norm(derivatives[a] * first), Norm(derivatives[a] * second) });
        for (int b = 0; b < count; ++b)
        {
          const double other = Cross(derivatives[a] * first, derivatives[b] * second);
          tame = tame && other > 0.8 * predicted && other < 1.25 * predicted;
        }
      }
      if (!tame)
      {
        continue;
      }
      // An image whose height is below rounding is not conclusive, and neither are smaller ones.
      if (predicted < rounding * (longest + rounding))
      {
        return;
      }
      std::array<Vector2, 3> images;
      for (int k = 0; k < 3; ++k)
      {
        images[k] = this->WorkingImage(from, samples[k]);
      }
      ++this->Result.Oriented;
      this->Take(ORIENTATION,
        handedness * Orientation(images[0], images[1], images[2]) > 0.0 ? 0.0 : Infinity);
      return;
    }
  }

  const TestedSystem& System;
  Random Numbers;
  std::int64_t Number;
  PlanePair Pair;
  std::shared_ptr<const Homeomorphism> Map;
  Report Result;
  const bool Log;
};

/// The options of the command line with their defaults. An empty name selects all.
std::map<std::string, std::string> Options{ { "--points", "0" }, { "--seed", "1" },
  { "--system", "" }, { "--family", "" }, { "--case", "-1" },
  { "--threads", std::to_string(std::max(1u, std::thread::hardware_concurrency())) } };

std::uint64_t Seed()
{
  return std::stoull(Options["--seed"]);
}

/// Runs the cases of one system and family until their points are used up.
Report RunCases(const TestedSystem& system, int family, double points)
{
  std::atomic<std::int64_t> next{ 0 };
  std::vector<Report> reports(std::stoul(Options["--threads"]));
  std::vector<std::thread> threads;
  threads.reserve(reports.size());
  for (Report& report : reports)
  {
    threads.emplace_back([&, seed = Seed()]() {
      for (;;)
      {
        const std::int64_t number = next++;
        if (static_cast<double>(number) * PointsPerCase >= points)
        {
          return;
        }
        report.Take(Case(system, family, seed, number).Run());
      }
    });
  }
  Report total;
  for (std::size_t i = 0; i < threads.size(); ++i)
  {
    threads[i].join();
    total.Take(reports[i]);
  }
  return total;
}

bool Print(const TestedSystem& system, int family, const Report& report)
{
  std::cout << "| " << system.Name << " | " << Families[family].Name << " | " << report.Pairs
            << " | " << report.Points << " | " << report.Lost;
  bool good = report.Pairs > 0;
  for (const int q : { LOCATION, INSIDE, ROUND_TRIP })
  {
    std::cout << " | " << report.Worsts[q].Value << " (" << report.Worsts[q].Case << ")";
  }
  std::cout << " | " << (report.Worsts[DETERMINANT].Value > 1.0 ? "NOT POSITIVE" : "positive")
            << " | " << report.Oriented
            << (report.Worsts[ORIENTATION].Value > 1.0 ? " NOT ALL KEPT" : "") << " |" << std::endl;
  for (int q = 0; q < NUMBER_OF_QUANTITIES; ++q)
  {
    if (report.Worsts[q].Value > 1.0)
    {
      std::cout << "LIMIT BROKEN: " << QuantityNames[q] << "; StressTest --system " << system.Name
                << " --family " << Families[family].Name << " --case " << report.Worsts[q].Case
                << "\n";
      good = false;
    }
  }
  if (report.Pairs == 0)
  {
    std::cout << "no valid pair was made\n";
  }
  return good;
}

int Usage()
{
  std::cerr << "StressTest [--points N] [--seed N] [--system NAME] [--family NAME] [--case N] "
               "[--threads N]\nSystems:";
  for (const TestedSystem& system : Systems)
  {
    std::cerr << " " << system.Name;
  }
  std::cerr << "\nFamilies:\n";
  for (const Family& family : Families)
  {
    std::cerr << "  " << family.Name << ": " << family.Description << "\n";
  }
  return EXIT_FAILURE;
}

} // namespace

int main(int argc, char* argv[])
{
  for (int i = 1; i < argc; i += 2)
  {
    if (Options.count(argv[i]) == 0 || i + 1 == argc)
    {
      return Usage();
    }
    Options[argv[i]] = argv[i + 1];
  }
  // The threads are std::threads with separate cases. VTK's threads must not be started by several
  // threads at once.
  vtkSMPTools::SetBackend("Sequential");
  std::vector<std::pair<const TestedSystem*, int>> chosen;
  const auto isChosen = [](const std::string& option, const char* name) {
    return Options[option].empty() || Options[option] == name;
  };
  for (const TestedSystem& system : Systems)
  {
    for (int family = 0; family < static_cast<int>(Families.size()); ++family)
    {
      if (isChosen("--system", system.Name) && isChosen("--family", Families[family].Name))
      {
        chosen.emplace_back(&system, family);
      }
    }
  }
  const double points = std::stod(Options["--points"]);
  const std::int64_t number = std::stoll(Options["--case"]);
  if (chosen.empty() || (points <= 0.0 && number < 0))
  {
    return Usage();
  }
  if (number >= 0)
  {
    const auto [system, family] = chosen.front();
    std::cout.precision(17);
    const Report report = Case(*system, family, Seed(), number, true).Run();
    return Print(*system, family, report) ? EXIT_SUCCESS : EXIT_FAILURE;
  }

  std::cout.precision(3);
  std::cout
    << "| system | family | pairs | points | lost | location (case) | image inside (case) | "
       "round trip (case) | det J | triangles whose orientation was kept |\n"
       "|---|---|--:|--:|--:|--:|--:|--:|---|--:|\n";
  const auto share = static_cast<double>(chosen.size());
  bool good = true;
  Report total;
  for (const auto& [system, family] : chosen)
  {
    const Report report = RunCases(*system, family, points / share);
    total.Take(report);
    good = Print(*system, family, report) && good;
  }
  std::cout << total.Points << " points in " << total.Pairs << " pairs of meshes, seed " << Seed()
            << ": " << (good ? "no limit broken" : "LIMITS BROKEN") << "\n";
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
