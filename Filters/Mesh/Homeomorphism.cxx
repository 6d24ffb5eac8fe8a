// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Homeomorphism.h"

#include "CubicHomeomorphism.h"
#include "MeshValidation.h"

#include "Kernel/Simd/Vectorize.h"

#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace homeomorphism
{
namespace
{

/// The runs of a block: consecutive points in the same triangle that are not its corners.
class PointRuns
{
public:
  explicit PointRuns(const PointBlock& block)
  {
    TriangleIndex last = -1;
    for (int i = 0; i < block.Count; ++i)
    {
      const TriangleIndex t = block.Corners[i] < 0 ? block.Triangles[i] : -1;
      if (t < 0 || t != last)
      {
        this->Runs[this->Count++] = { i, t };
        last = t;
      }
    }
    this->Runs[this->Count].Begin = block.Count;
  }

  /// Calls use(begin, end, triangle) for each run, and useOther(i) for each of the other points.
  template <typename Use, typename UseOther>
  void ForEach(Use&& use, UseOther&& useOther) const
  {
    for (int n = 0; n < this->Count; ++n)
    {
      const Run& run = this->Runs[n];
      if (run.Triangle < 0)
      {
        useOther(run.Begin);
      }
      else
      {
        use(run.Begin, this->Runs[n + 1].Begin, run.Triangle);
      }
    }
  }

  /// Also calls prefetch(begin, triangle) for each run in advance, to hide memory latency.
  template <typename Prefetch, typename Use, typename UseOther>
  void ForEach(Prefetch&& prefetch, Use&& use, UseOther&& useOther) const
  {
    int ahead = 0;
    const auto prefetchUpTo = [&](int end) {
      for (; ahead < this->Count && this->Runs[ahead].Begin < end; ++ahead)
      {
        if (this->Runs[ahead].Triangle >= 0)
        {
          prefetch(this->Runs[ahead].Begin, this->Runs[ahead].Triangle);
        }
      }
    };
    prefetchUpTo(PrefetchDistance);
    this->ForEach(
      [&](int begin, int end, TriangleIndex t) {
        prefetchUpTo(end + PrefetchDistance);
        use(begin, end, t);
      },
      useOther);
  }

private:
  struct Run
  {
    int Begin;
    /// -1 if the point is outside or a corner.
    TriangleIndex Triangle;
  };

  // The end of the last run is the beginning of one more.
  Run Runs[PointBlock::Capacity + 1];
  int Count = 0;
};

/// Barycentric coordinates of the points of a run, for two corners: the apex of the frame in which
/// the images are, and the corner before it.
struct BlockCoordinates
{
  const double* Apex;
  const double* Second;

  std::pair<double, double> Get(int i) const { return { this->Apex[i], this->Second[i] }; }
};

/// The coordinates, as in BlockCoordinates, of points that the Smooth system has mapped.
struct SmoothCoordinates
{
  const SmoothBatch& Batch;
  int Apex;

  HOMEOMORPHISM_ALWAYS_INLINE std::pair<double, double> Get(int i) const
  {
    // L has the coordinates of the point's corner, the one after it and the one before it. Reading
    // all of them is faster than a branch.
    const bool isApex = this->Batch.Corner[i] == this->Apex;
    const bool isSecond = this->Batch.Corner[i] == PreviousCorner(this->Apex);
    const double own = this->Batch.L[0][i];
    const double next = this->Batch.L[1][i];
    const double previous = this->Batch.L[2][i];
    return { isApex ? own : (isSecond ? next : previous),
      isSecond ? own : (isApex ? previous : next) };
  }
};

/// Converts barycentric coordinates to the plane of a triangle's frame, as
/// TriangleShape::FromBarycentric and PlaneFrame::FromFrame.
HOMEOMORPHISM_ALWAYS_INLINE Vector2 ToPlane(const PlaneFrame& frame, double apex, double second)
{
  return frame.FromFrame({ frame.Base * second + frame.ApexX * apex, frame.Height * apex });
}

/// Converts barycentric coordinates of a run to its images, in a plane parallel to the x and y axes
/// at a distance from the origin. Offsets times @a slope are in the units of the input, as the
/// images are. Overwrites up to WidestVector - 1 images after the last.
template <typename Coordinates>
HOMEOMORPHISM_FOR_WIDE_VECTORS void ToHorizontalPlane(const PlaneFrame& frame, double slope,
  double distance, double scale, double inverseScale, int begin, int end,
  const Coordinates& coordinates, const double* offsets, double (*images)[3])
{
  const PlaneFrame f = frame;
  const Coordinates from = coordinates;
  const int stop = begin + InWholeVectors(end - begin);
  HOMEOMORPHISM_SIMD
  for (int i = begin; i < stop; ++i)
  {
    const auto [apex, second] = from.Get(i);
    const Vector2 p = ToPlane(f, apex, second);
    images[i][0] = p.x * inverseScale;
    images[i][1] = p.y * inverseScale;
    images[i][2] = (slope * offsets[i] * scale + distance) * inverseScale;
  }
}

/// The image of a point that the Smooth system has mapped, in the frame of a triangle.
Vector2 ToFrame(const TriangleShape& shape, const SmoothPoint& point)
{
  const CornerCoordinates l = point.Image.Turned(CornersBetween(point.Corner, shape.Apex));
  return shape.ToFrame(l.Own, l.Previous);
}

/// Sets the matrix of a map between two horizontal planes. Such meshes are columnar, so heights are
/// measured along the normals of the planes.
void SetHorizontal(const Matrix2& matrix, Jacobian& jacobian)
{
  jacobian.Matrix = { matrix.ImageOfX.x, matrix.ImageOfY.x, 0.0, matrix.ImageOfX.y,
    matrix.ImageOfY.y, 0.0, 0.0, 0.0, 1.0 };
}

} // namespace

std::shared_ptr<const Homeomorphism> Homeomorphism::Make(vtkPolyData* source, vtkPolyData* target,
  const HomeomorphismOptions& options, MeshDiagnostics& diagnostics)
{
  std::unique_ptr<Homeomorphism> result(new Homeomorphism);
  result->Pair = TriangulationPair::Read(source, target, options.MaskInvalidTriangles, diagnostics);
  if (!result->Pair)
  {
    return nullptr;
  }
  const Triangulation& topology = result->Pair->GetTriangulation();
  std::vector<Domain> domains{ Domain::Source };
  if (target)
  {
    domains.push_back(Domain::Target);
  }

  std::vector<std::uint8_t> mappedByLinear;
  // If the center is the incenter, every triangle is concordant.
  if (options.System == CoordinateSystem::Contour && options.Center == CenterPoint::Centroid)
  {
    for (const Domain domain : domains)
    {
      const std::vector<TriangleIndex> discordant =
        FindDiscordant(topology, result->Pair->GetGeometry(domain));
      if (discordant.empty())
      {
        continue;
      }
      mappedByLinear.resize(topology.GetNumberOfTriangles(), 0);
      vtkPolyData* mesh = domain == Domain::Source ? source : target;
      MeshDiagnostic diagnostic;
      diagnostic.What = MeshDiagnostic::Kind::Discordant;
      diagnostic.Where = !target   ? MeshDiagnostic::Mesh::Triangulation
        : domain == Domain::Source ? MeshDiagnostic::Mesh::Source
                                   : MeshDiagnostic::Mesh::Target;
      diagnostic.Result = options.DiscordantByLinear ? MeshDiagnostic::Outcome::MappedByLinear
                                                     : MeshDiagnostic::Outcome::Refused;
      diagnostic.Ids.reserve(discordant.size());
      for (const TriangleIndex t : discordant)
      {
        mappedByLinear[t] = 1;
        diagnostic.Ids.push_back(FirstPolygon(mesh) + t);
      }
      mesh->GetPoint(topology.GetCorners(discordant.front())[0], diagnostic.Position.data());
      diagnostics.push_back(std::move(diagnostic));
    }
    if (IsRefused(diagnostics))
    {
      return nullptr;
    }
  }
  if (options.System == CoordinateSystem::Cubic)
  {
    for (const Domain domain : domains)
    {
      if (!result->Pair->GetGeometry(domain).IsPlanar())
      {
        MeshDiagnostic diagnostic;
        diagnostic.What = MeshDiagnostic::Kind::NotPlanar;
        diagnostic.Where =
          domain == Domain::Source ? MeshDiagnostic::Mesh::Source : MeshDiagnostic::Mesh::Target;
        diagnostics.push_back(diagnostic);
      }
    }
    const TriangleIndex count = topology.GetNumberOfTriangles();
    if (target && !options.Cubic.IsPossible(count))
    {
      MeshDiagnostic diagnostic;
      diagnostic.What = MeshDiagnostic::Kind::TooManyRefined;
      diagnostic.Counts = { count, options.Cubic.GetNumberOfRefined(count) };
      diagnostics.push_back(diagnostic);
    }
    if (IsRefused(diagnostics))
    {
      return nullptr;
    }
    if (target)
    {
      result->Cubic = std::make_shared<const CubicHomeomorphism>(*result->Pair, options.Cubic);
    }
  }
  std::shared_ptr<StripArray> strips;
  if (options.System == CoordinateSystem::Smooth)
  {
    strips = std::make_shared<StripArray>(topology.GetNumberOfTriangles(), int(domains.size()));
  }
  std::array<std::shared_ptr<ChartedTriangulation>, 2> charts;
  for (const Domain domain : domains)
  {
    charts[int(domain)] =
      std::make_shared<ChartedTriangulation>(topology, result->Pair->GetGeometry(domain),
        options.System, options.Center, mappedByLinear, strips, int(domain));
  }
  if (target && options.Cubic.MaximumDeviation < std::numeric_limits<double>::max())
  {
    ChartedTriangulation::LimitDeviation(topology.GetNumberOfTriangles(), *charts[0], *charts[1],
      options.Cubic.MaximumDeviation * result->Pair->GetGeometry(Domain::Target).GetScale());
  }
  result->Charts = { charts[0], charts[1] };
  return std::shared_ptr<const Homeomorphism>(std::move(result));
}

std::shared_ptr<const Homeomorphism> Homeomorphism::Inverted() const
{
  std::shared_ptr<Homeomorphism> result(new Homeomorphism);
  result->Pair = this->Pair->Inverted();
  result->Charts = { this->Charts[1], this->Charts[0] };
  if (this->Cubic)
  {
    result->Cubic = this->Cubic;
    result->CubicPair = this->CubicPair ? this->CubicPair : this->Pair;
    result->IsCubicInverted = !this->IsCubicInverted;
  }
  return result;
}

double Homeomorphism::GetAbsoluteTolerance(Domain domain, double tolerance, double precision) const
{
  const MeshGeometry& geometry = this->Pair->GetGeometry(domain);
  const double rounding = geometry.GetRounding(precision);
  return std::max(rounding, tolerance * geometry.GetDiagonal());
}

int Homeomorphism::MapBlock(Domain from, PointBlock& block) const
{
  int missing = 0;
  switch (this->GetCharts(from).GetSystem())
  {
    case CoordinateSystem::Cubic:
      missing = this->MapByCubics(from, block);
      break;
    case CoordinateSystem::Smooth:
      this->MapByStrips(from, block);
      break;
    case CoordinateSystem::Contour:
      this->MapByContours(from, block);
      break;
    case CoordinateSystem::Linear:
    {
      const MeshGeometry& target = this->Pair->GetGeometry(Opposite(from));
      PointRuns(block).ForEach([&](int, TriangleIndex t) { target.PrefetchFrame(t); },
        [&](int begin, int end, TriangleIndex t) { this->MapLinearly(from, t, begin, end, block); },
        [](int) {});
    }
  }
  int others = 0;
  for (int i = 0; i < block.Count; ++i)
  {
    others += block.Triangles[i] < 0 || block.Corners[i] >= 0 ? 1 : 0;
  }
  for (int i = 0; i < block.Count && others > 0; ++i)
  {
    if (block.Triangles[i] < 0)
    {
      std::copy_n(block.Points[i], 3, block.Images[i]);
    }
    else if (block.Corners[i] >= 0)
    {
      this->MapPoint(from, block.GetSurfacePoint(i), block.Images[i]);
    }
  }
  return missing;
}

/// Maps a run of points by the affine map of their triangle.
void Homeomorphism::MapLinearly(
  Domain from, TriangleIndex triangle, int begin, int end, PointBlock& block) const
{
  const std::array<const double*, 3> coordinates = this->ByCorner(from, triangle, block);
  const int apex = this->Pair->GetGeometry(Opposite(from)).GetApex(triangle);
  this->LeaveTriangle(from, triangle, begin, end,
    BlockCoordinates{ coordinates[apex], coordinates[PreviousCorner(apex)] }, block);
}

/// Maps the points by the Smooth system.
void Homeomorphism::MapByStrips(Domain from, PointBlock& block) const
{
  const ChartedTriangulation& charts = this->GetCharts(from);
  const ChartedTriangulation& otherCharts = this->GetCharts(Opposite(from));
  const MeshGeometry& target = this->Pair->GetGeometry(Opposite(from));
  const PointRuns runs(block);
  SmoothBatch batch;
  runs.ForEach(
    [&](int begin, TriangleIndex t) {
      const std::array<const double*, 3> l = this->ByCorner(from, t, block);
      const int corner = LeastCorner(l[0][begin], l[1][begin], l[2][begin]);
      Prefetch(&charts.GetStrips(t)[corner]);
      target.PrefetchFrame(t);
    },
    [&](int begin, int end, TriangleIndex t) {
      SetSmoothBatch(batch, begin, end, this->ByCorner(from, t, block).data(), charts.GetStrips(t),
        otherCharts.GetStrips(t));
    },
    [&](int other) { FillSmoothBatch(batch, other, other + 1); });
  MapSmoothBatch(batch, block.Count, block.KeepsReferences ? block.References : nullptr);
  for (int i = 0; i < block.Count && block.KeepsReferences; ++i)
  {
    block.ReferencePlaces[i] = static_cast<int>(batch.Corner[i]);
  }
  runs.ForEach(
    [&](int begin, int end, TriangleIndex t) {
      this->LeaveTriangle(
        from, t, begin, end, SmoothCoordinates{ batch, target.GetApex(t) }, block);
    },
    [](int) {});
}

/// Maps the points whose triangles have contours.
void Homeomorphism::MapByContours(Domain from, PointBlock& block) const
{
  const ChartedTriangulation& charts = this->GetCharts(from);
  const ChartedTriangulation& otherCharts = this->GetCharts(Opposite(from));
  const MeshGeometry& target = this->Pair->GetGeometry(Opposite(from));
  struct ChartPair
  {
    ContourChart From;
    ContourChart To;
  };
  // The charts of each run, at the index of its first point; and for each point, its charts.
  LargeArray<ChartPair> made(block.Count);
  std::array<const ContourChart*, PointBlock::Capacity> froms{};
  std::array<const ContourChart*, PointBlock::Capacity> tos{};
  Vector2 points[PointBlock::Capacity];
  int numbers[PointBlock::Capacity];
  int count = 0;
  PointRuns(block).ForEach(
    [&](int, TriangleIndex t) {
      charts.PrefetchContourViews(t);
      otherCharts.PrefetchContourViews(t);
      target.PrefetchFrame(t);
    },
    [&](int begin, int end, TriangleIndex t) {
      if (charts.GetSystemOf(t) != CoordinateSystem::Contour)
      {
        this->MapLinearly(from, t, begin, end, block);
        return;
      }
      made[begin] = { charts.GetContourChart(t), otherCharts.GetContourChart(t) };
      for (int i = begin; i < end; ++i)
      {
        froms[count] = &made[begin].From;
        tos[count] = &made[begin].To;
        points[count] = { block.InPlane[0][i], block.InPlane[1][i] };
        numbers[count++] = i;
      }
    },
    [](int) {});
  ContourChart::MapPoints(froms.data(), tos.data(), points, count);
  for (int n = 0; n < count; ++n)
  {
    const int i = numbers[n];
    const double offset = this->OffsetOfImage(from, block.Offsets[i]);
    target.FromNormalized(
      target.FromFrame(block.Triangles[i], { points[n], offset }), block.Images[i]);
  }
}

/// Maps the points by the Cubic system.
int Homeomorphism::MapByCubics(Domain from, PointBlock& block) const
{
  const MeshGeometry& target = this->Pair->GetGeometry(Opposite(from));
  static_assert(CubicBatch::Capacity == PointBlock::Capacity, "A batch is a block");
  CubicBatch batch;
  batch.Count = block.Count;
  const double* const inFrame[2] = { block.InPlane[0], block.InPlane[1] };
  double heights[PointBlock::Capacity];
  PointRuns(block).ForEach([&](int, TriangleIndex t) { this->Cubic->PrefetchTriangle(from, t); },
    [&](int begin, int end, TriangleIndex t) {
      this->Cubic->SetPoints(
        this->ToCubic(from), t, begin, end, this->ByCorner(from, t, block).data(), inFrame, batch);
      for (int i = begin; i < end; ++i)
      {
        heights[i] = this->OffsetOfImage(from, block.Offsets[i]);
      }
    },
    [&](int other) {
      batch.Triangles[other] = -1;
      batch.ImageX[other] = batch.ImageY[other] = heights[other] = 0.0;
    });
  if (block.Cubic != this->Cubic)
  {
    block.Cubic = this->Cubic;
    block.PreparedCubics =
      std::make_shared<CubicTriangle>(this->Cubic->GetMap().Prepare(CubicTriangle::ManyTriangles));
  }
  this->Cubic->MapPoints(this->ToCubic(from), batch, *block.PreparedCubics);
  if (block.KeepsReferences)
  {
    this->Cubic->GetSourcePoints(this->ToCubic(from), block.Triangles, batch, block.References[0],
      block.References[1], block.ReferencePlaces);
  }
  target.FromNormalized(batch.ImageX, batch.ImageY, heights, block.Count, block.Images);
  int missing = 0;
  for (int i = 0; i < block.Count; ++i)
  {
    if (batch.Triangles[i] < 0 && block.Triangles[i] >= 0 && block.Corners[i] < 0)
    {
      block.Triangles[i] = -1;
      ++missing;
    }
  }
  return missing;
}

/// Converts barycentric coordinates in the target's affine chart of a triangle to its points.
template <typename Coordinates>
void Homeomorphism::LeaveTriangle(Domain from, TriangleIndex triangle, int begin, int end,
  const Coordinates& coordinates, PointBlock& block) const
{
  const MeshGeometry& target = this->Pair->GetGeometry(Opposite(from));
  if (!target.IsPlanar())
  {
    const TriangleShape shape = target.GetShape(triangle);
    for (int i = begin; i < end; ++i)
    {
      const auto [apex, second] = coordinates.Get(i);
      const FramePoint point{ { shape.Base * second + shape.ApexX * apex, shape.Height * apex },
        this->OffsetOfImage(from, block.Offsets[i]) };
      target.FromNormalized(target.FromFrame(triangle, point), block.Images[i]);
    }
    return;
  }
  const PlaneFrame& frame = target.GetPlaneFrame(triangle);
  const double sense = target.IsColumnar() ? 1.0 : frame.Orientation;
  if (target.IsHorizontal() && end - begin >= LeastVector)
  {
    ToHorizontalPlane(frame, sense * this->Pair->GetGeometry(from).GetInverseScale(),
      target.GetPlaneDistance(), target.GetScale(), target.GetInverseScale(), begin, end,
      coordinates, block.Offsets, block.Images);
    return;
  }
  for (int i = begin; i < end; ++i)
  {
    const auto [apex, second] = coordinates.Get(i);
    const Vector2 p = ToPlane(frame, apex, second);
    target.FromNormalized(
      { p.x, p.y, sense * this->OffsetOfImage(from, block.Offsets[i]) }, block.Images[i]);
  }
}

template <typename Use>
auto Homeomorphism::VisitCharts(Domain from, TriangleIndex triangle, Use&& use) const
{
  return this->GetCharts(from).VisitCharts(
    this->GetCharts(Opposite(from)), triangle, std::forward<Use>(use));
}

bool Homeomorphism::MapPoint(
  Domain from, const SurfacePoint& surfacePoint, double image[3], Jacobian* jacobian) const
{
  const TriangleIndex triangle = surfacePoint.Triangle;
  const MeshGeometry& target = this->Pair->GetGeometry(Opposite(from));
  FramePoint point;
  point.Offset = this->OffsetOfImage(from, surfacePoint.Point.Offset);
  if (surfacePoint.Corner >= 0)
  {
    if (jacobian)
    {
      *jacobian = this->GetJacobian(from, surfacePoint);
    }
    target.FromMeshPoint(this->Pair->GetTriangulation().GetCorners(triangle)[surfacePoint.Corner],
      point.Offset, image);
    return true;
  }
  if (this->Cubic)
  {
    return this->MapByCubic(from, surfacePoint, image, jacobian);
  }
  if (this->GetCharts(from).GetSystem() == CoordinateSystem::Smooth)
  {
    // Only one strip is needed, so no charts are constructed.
    const SmoothPoint mapped = this->MapByStrip(from, surfacePoint);
    point.InPlane = ToFrame(target.GetShape(triangle), mapped);
    if (jacobian)
    {
      this->DeriveByStrip(from, triangle, mapped.Corner, mapped.Reference, *jacobian);
    }
  }
  else
  {
    this->VisitCharts(from, triangle, [&](const auto& chart, const auto& other) {
      if (!jacobian)
      {
        point.InPlane = homeomorphism::MapPoint(chart, other, surfacePoint.Point.InPlane);
        return;
      }
      const auto mapped = MapWithDerivatives(chart, other, surfacePoint.Point.InPlane);
      point.InPlane = mapped.Image;
      this->Derive(from, triangle, mapped.From, mapped.To, *jacobian);
    });
  }
  target.FromNormalized(target.FromFrame(triangle, point), image);
  return true;
}

Vector2 Homeomorphism::MapInFrame(Domain from, TriangleIndex triangle, const Vector2& point) const
{
  if (this->Cubic)
  {
    const Barycentric l = this->Pair->GetGeometry(from).GetShape(triangle).ToBarycentric(point);
    CubicTriangle prepared = this->Cubic->GetMap().Prepare();
    const CubicPoint mapped =
      this->Cubic->MapPoint(this->ToCubic(from), triangle, l, point, prepared);
    if (!mapped.Exists())
    {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      return { none, none };
    }
    return this->Pair->GetGeometry(Opposite(from)).GetPlaneFrame(triangle).ToFrame(mapped.Image);
  }
  return this->VisitCharts(from, triangle, [&point](const auto& chart, const auto& other) {
    return homeomorphism::MapPoint(chart, other, point);
  });
}

template <typename Differential>
HOMEOMORPHISM_ALWAYS_INLINE void Homeomorphism::Derive(Domain from, TriangleIndex triangle,
  const Differential& differential, const Differential& other, Jacobian& jacobian) const
{
  const Matrix2 matrix = MapDerivative(differential, other);
  this->FromFrames(from, triangle, matrix, MapDeterminant(differential, other, matrix), jacobian);
}

/// The derivative of the Smooth map. Only one strip is needed, so no charts are constructed.
void Homeomorphism::DeriveByStrip(Domain from, TriangleIndex triangle, int corner,
  const CornerCoordinates& reference, Jacobian& jacobian) const
{
  const auto at = [&](Domain domain) {
    return SmoothChart::Differential(this->Pair->GetGeometry(domain).GetShape(triangle),
      this->GetCharts(domain).GetStrips(triangle), corner, reference);
  };
  this->Derive(from, triangle, at(from), at(Opposite(from)), jacobian);
}

Jacobian Homeomorphism::GetJacobian(Domain from, const SurfacePoint& surfacePoint) const
{
  // At a corner, MapPoint would not compute the image.
  const SurfacePoint point{ surfacePoint.Triangle, surfacePoint.Point, -1 };
  double image[3];
  Jacobian jacobian;
  this->MapPoint(from, point, image, jacobian);
  return jacobian;
}

/// Maps a point by the Cubic system. @a jacobian may be null.
bool Homeomorphism::MapByCubic(
  Domain from, const SurfacePoint& surfacePoint, double image[3], Jacobian* jacobian) const
{
  const TriangleIndex triangle = surfacePoint.Triangle;
  const MeshGeometry& target = this->Pair->GetGeometry(Opposite(from));
  const Vector2& point = surfacePoint.Point.InPlane;
  const Barycentric l = this->Pair->GetGeometry(from).GetShape(triangle).ToBarycentric(point);
  CubicTriangle prepared = this->Cubic->GetMap().Prepare();
  const CubicPoint mapped =
    this->Cubic->MapPoint(this->ToCubic(from), triangle, l, point, prepared);
  if (jacobian)
  {
    this->FromPlanes(from, triangle,
      this->Cubic->Derive(this->ToCubic(from), mapped.Number, mapped.InSource, prepared),
      *jacobian);
  }
  target.FromNormalized(
    { mapped.Image.x, mapped.Image.y, this->OffsetOfImage(from, surfacePoint.Point.Offset) },
    image);
  return mapped.Exists();
}

/// Maps a point by the Smooth system.
SmoothPoint Homeomorphism::MapByStrip(Domain from, const SurfacePoint& surfacePoint) const
{
  const TriangleIndex t = surfacePoint.Triangle;
  const TriangleShape shape = this->Pair->GetGeometry(from).GetShape(t);
  return MapSmoothPoint(shape.Apex, shape.ToCornerCoordinates(surfacePoint.Point.InPlane),
    this->GetCharts(from).GetStrips(t), this->GetCharts(Opposite(from)).GetStrips(t));
}

Jacobian Homeomorphism::GetJacobian(Domain from, const PointBlock& block, int i) const
{
  const TriangleIndex triangle = block.Triangles[i];
  const CoordinateSystem system = this->GetCharts(from).GetSystem();
  if (!block.KeepsReferences || block.Corners[i] >= 0 ||
    (system != CoordinateSystem::Smooth && system != CoordinateSystem::Cubic))
  {
    return this->GetJacobian(from, block.GetSurfacePoint(i));
  }
  Jacobian jacobian;
  if (this->Cubic)
  {
    const Vector2 point{ block.References[0][i], block.References[1][i] };
    this->FromPlanes(from, triangle,
      this->Cubic->Derive(
        this->ToCubic(from), block.ReferencePlaces[i], point, *block.PreparedCubics),
      jacobian);
    return jacobian;
  }
  this->DeriveByStrip(from, triangle, block.ReferencePlaces[i],
    { block.References[0][i], block.References[1][i], block.References[2][i] }, jacobian);
  return jacobian;
}

Jacobian Homeomorphism::GetJacobian(
  Domain from, TriangleIndex triangle, const TriangularCoordinates& coordinates) const
{
  if (this->Cubic)
  {
    const Vector2 point = this->GetCharts(from).FromCoordinates(triangle, coordinates);
    return this->GetJacobian(from, SurfacePoint{ triangle, { point, 0.0 }, -1 });
  }
  Jacobian jacobian;
  this->VisitCharts(from, triangle, [&](const auto& chart, const auto& other) {
    const auto reference = chart.FromCoordinates(coordinates);
    this->Derive(
      from, triangle, chart.DifferentialAt(reference), other.DifferentialAt(reference), jacobian);
  });
  return jacobian;
}

void Homeomorphism::FromPlanes(
  Domain from, TriangleIndex triangle, const Matrix2& inPlanes, Jacobian& jacobian) const
{
  const MeshGeometry& source = this->Pair->GetGeometry(from);
  const MeshGeometry& target = this->Pair->GetGeometry(Opposite(from));
  const PlaneFrame& frame = source.GetPlaneFrame(triangle);
  const PlaneFrame& other = target.GetPlaneFrame(triangle);
  if (!source.IsHorizontal() || !target.IsHorizontal())
  {
    const Matrix2 inFrames{ other.VectorToFrame(inPlanes * frame.Tangent),
      other.VectorToFrame(inPlanes * frame.GetInward()) };
    this->FromFrames(from, triangle, inFrames, inFrames.Determinant(), jacobian);
    return;
  }
  // The scales are powers of two, so nothing is rounded.
  const Matrix2 matrix = (source.GetScale() * target.GetInverseScale()) * inPlanes;
  jacobian.Determinant = matrix.Determinant();
  SetHorizontal(matrix, jacobian);
}

void Homeomorphism::FromFrames(Domain from, TriangleIndex triangle, const Matrix2& inFrames,
  double determinant, Jacobian& jacobian) const
{
  const MeshGeometry& source = this->Pair->GetGeometry(from);
  const MeshGeometry& target = this->Pair->GetGeometry(Opposite(from));
  // The scales are powers of two, so nothing is rounded.
  const double rescale = source.GetScale() * target.GetInverseScale();
  jacobian.Determinant = determinant * rescale * rescale * source.GetHandedness(triangle) *
    target.GetHandedness(triangle);
  if (source.IsHorizontal() && target.IsHorizontal())
  {
    // The product below, without the components of the axes that are zero.
    const PlaneFrame& frame = source.GetPlaneFrame(triangle);
    const PlaneFrame& other = target.GetPlaneFrame(triangle);
    const Matrix2 axes{ other.Tangent, other.GetInward() };
    SetHorizontal(OuterProduct(rescale * (axes * inFrames.ImageOfX), frame.Tangent) +
        OuterProduct(rescale * (axes * inFrames.ImageOfY), frame.GetInward()),
      jacobian);
    return;
  }
  const std::array<Vector3, 3> from3 = source.GetAxes(triangle);
  const std::array<Vector3, 3> to3 = target.GetAxes(triangle);
  for (int row = 0; row < 3; ++row)
  {
    const double alongTangent =
      rescale * (to3[0][row] * inFrames.ImageOfX.x + to3[1][row] * inFrames.ImageOfX.y);
    const double alongInward =
      rescale * (to3[0][row] * inFrames.ImageOfY.x + to3[1][row] * inFrames.ImageOfY.y);
    for (int column = 0; column < 3; ++column)
    {
      jacobian.Matrix[3 * row + column] = alongTangent * from3[0][column] +
        alongInward * from3[1][column] + to3[2][row] * from3[2][column];
    }
  }
}

} // namespace homeomorphism
