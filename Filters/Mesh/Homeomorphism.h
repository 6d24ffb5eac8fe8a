// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Homeomorphism.h
/// The map between the domains of two meshes: point, triangle, coordinates, corresponding triangle,
/// image.

#ifndef homeomorphism_Homeomorphism_h
#define homeomorphism_Homeomorphism_h

#include "ChartedTriangulation.h"
#include "CubicMapOptions.h"
#include "PointBlock.h"
#include "TriangulationPair.h"

#include <memory>
#include <tuple>

class vtkPolyData;

namespace homeomorphism
{

class CubicHomeomorphism;

/// The options of the map of a pair of meshes, or of the coordinates of one triangulation.
struct HomeomorphismOptions
{
  CoordinateSystem System = CoordinateSystem::Smooth;
  CenterPoint Center = CenterPoint::Centroid;
  /// Leave defective triangles out instead of refusing the meshes.
  bool MaskInvalidTriangles = false;
  /// Let the Linear system map discordant triangles instead of refusing the meshes.
  bool DiscordantByLinear = false;
  /// The options of the Cubic system. MaximumDeviation, in the target's units, also applies to the
  /// Smooth system.
  CubicMapOptions Cubic;

  bool operator==(const HomeomorphismOptions& other) const
  {
    const auto all = [](const HomeomorphismOptions& o) {
      return std::tie(o.System, o.Center, o.MaskInvalidTriangles, o.DiscordantByLinear, o.Cubic);
    };
    return all(*this) == all(other);
  }
};

/// The derivative of the map, in the coordinates of the input.
struct Jacobian
{
  /// Row-major.
  std::array<double, 9> Matrix;
  /// Ratio of areas, negative where orientation is reversed.
  double Determinant;

  Vector3 operator*(const Vector3& v) const
  {
    const std::array<double, 9>& j = this->Matrix;
    return { j[0] * v[0] + j[1] * v[1] + j[2] * v[2], j[3] * v[0] + j[4] * v[1] + j[5] * v[2],
      j[6] * v[0] + j[7] * v[1] + j[8] * v[2] };
  }
};

/// The homeomorphism of a pair of triangulations in one coordinate system, or the triangular
/// coordinates of a single triangulation. Immutable; any number of threads may use it.
class Homeomorphism
{
public:
  /// Reads, validates and prepares. If @a target is null, only coordinates are available. Defects
  /// are added to @a diagnostics. Returns null if the meshes are refused because of them.
  static std::shared_ptr<const Homeomorphism> Make(vtkPolyData* source, vtkPolyData* target,
    const HomeomorphismOptions& options, MeshDiagnostics& diagnostics);

  /// The map with source and target exchanged. It shares all data with this map, which must have a
  /// target.
  std::shared_ptr<const Homeomorphism> Inverted() const;

  const TriangulationPair& GetPair() const { return *this->Pair; }
  /// The map of the Cubic system, null in other systems.
  const CubicHomeomorphism* GetCubic() const { return this->Cubic.get(); }
  const ChartedTriangulation& GetCharts(Domain domain) const { return *this->Charts[int(domain)]; }

  /// The largest distance from the domain, in normalized coordinates, at which a point is replaced
  /// by the nearest point of the domain. It is the larger of two values: a bound on the rounding of
  /// the mesh's coordinates and of the point's, whose relative error is @a precision; and @a
  /// tolerance times the diagonal of the domain.
  double GetAbsoluteTolerance(Domain domain, double tolerance, double precision) const;

  /// Locates a point in a mesh's domain.
  SurfacePoint Locate(
    Domain domain, const double point[3], double tolerance, TriangleIndex hint) const
  {
    return this->Pair->GetLocation(domain).Find(point, tolerance, hint);
  }

  /// The image of a point of the domain @a from. Corners are mapped to corners exactly. Returns
  /// false if there is no image: if @a surfacePoint is not in the domain, or if a Cubic map is not
  /// certified in its triangle.
  bool MapPoint(Domain from, const SurfacePoint& surfacePoint, double image[3]) const
  {
    return this->MapPoint(from, surfacePoint, image, nullptr);
  }

  /// The image of a point, and the derivative there. The equations of the system are solved only
  /// once. Returns false if there is no image.
  bool MapPoint(
    Domain from, const SurfacePoint& surfacePoint, double image[3], Jacobian& jacobian) const
  {
    return this->MapPoint(from, surfacePoint, image, &jacobian);
  }

  /// The image of a point, from the frame of the triangle in @a from to its frame in the other
  /// domain; NaN if there is none.
  Vector2 MapInFrame(Domain from, TriangleIndex triangle, const Vector2& point) const;

  /// Locates the points of a block. The results are the same, bit for bit, as those of Locate.
  /// Returns the number of points outside.
  int LocateBlock(Domain domain, PointBlock& block, double tolerance, LocationHint& hint) const
  {
    return this->Pair->GetLocation(domain).FindBlock(block, tolerance, hint);
  }

  /// Maps the points of a block that LocateBlock has located. The results are the same, bit for
  /// bit, as those of MapPoint. Points without an image get the triangle -1; returns their number.
  /// Keeps references if the block has KeepsReferences.
  int MapBlock(Domain from, PointBlock& block) const;

  /// The derivative at a point; on an edge, the limit from the point's triangle.
  Jacobian GetJacobian(Domain from, const SurfacePoint& surfacePoint) const;

  /// The derivative at point @a i of a block that MapBlock has mapped; the same, bit for bit, as
  /// for the SurfacePoint. In the Smooth and Cubic systems, no equation is solved again if the
  /// block has KeepsReferences.
  Jacobian GetJacobian(Domain from, const PointBlock& block, int i) const;

  /// The derivative at the point of a triangle that has these coordinates. Where the coordinate
  /// system is not differentiable, it is the limit along the contour given by e and p.
  Jacobian GetJacobian(
    Domain from, TriangleIndex triangle, const TriangularCoordinates& coordinates) const;

  /// Triangular coordinates of a point of the domain.
  TriangularCoordinates GetCoordinates(Domain domain, const SurfacePoint& surfacePoint) const
  {
    return this->GetCharts(domain).ToCoordinates(surfacePoint.Triangle, surfacePoint.Point.InPlane);
  }

private:
  Homeomorphism() = default;

  /// Maps a point; @a jacobian may be null.
  bool MapPoint(
    Domain from, const SurfacePoint& surfacePoint, double image[3], Jacobian* jacobian) const;

  /// The distance of an image from the plane of its triangle. Distances from a plane are
  /// lengths of the input's space, not of either normalized space.
  double OffsetOfImage(Domain from, double offset) const
  {
    // The scales are powers of two, so nothing is rounded.
    return offset * this->Pair->GetGeometry(from).GetInverseScale() *
      this->Pair->GetGeometry(Opposite(from)).GetScale();
  }

  /// The block's barycentric coordinates, in the order of a triangle's corners.
  std::array<const double*, 3> ByCorner(
    Domain domain, TriangleIndex triangle, const PointBlock& block) const
  {
    return InOrder<const double*>(
      this->Pair->GetGeometry(domain).GetApex(triangle), block.Apex, block.First, block.Second);
  }
  void MapLinearly(
    Domain from, TriangleIndex triangle, int begin, int end, PointBlock& block) const;
  bool MapByCubic(
    Domain from, const SurfacePoint& surfacePoint, double image[3], Jacobian* jacobian) const;
  SmoothPoint MapByStrip(Domain from, const SurfacePoint& surfacePoint) const;
  void MapByStrips(Domain from, PointBlock& block) const;
  void MapByContours(Domain from, PointBlock& block) const;
  int MapByCubics(Domain from, PointBlock& block) const;
  Domain ToCubic(Domain domain) const { return this->IsCubicInverted ? Opposite(domain) : domain; }
  template <typename Coordinates>
  void LeaveTriangle(Domain from, TriangleIndex triangle, int begin, int end,
    const Coordinates& coordinates, PointBlock& block) const;

  template <typename Use>
  auto VisitCharts(Domain from, TriangleIndex triangle, Use&& use) const;

  // Jacobians are written in place, because copying one that has just been stored is slow.

  /// The derivative at a point of a triangle, from those of both charts there.
  template <typename Differential>
  void Derive(Domain from, TriangleIndex triangle, const Differential& differential,
    const Differential& other, Jacobian& jacobian) const;
  void DeriveByStrip(Domain from, TriangleIndex triangle, int corner,
    const CornerCoordinates& reference, Jacobian& jacobian) const;

  /// Converts a derivative from the triangle's frames to the input's coordinates. @a determinant is
  /// that of @a inFrames.
  void FromFrames(Domain from, TriangleIndex triangle, const Matrix2& inFrames, double determinant,
    Jacobian& jacobian) const;

  /// Converts a derivative from the planes of planar meshes to the input's coordinates.
  void FromPlanes(
    Domain from, TriangleIndex triangle, const Matrix2& inPlanes, Jacobian& jacobian) const;

  std::shared_ptr<const TriangulationPair> Pair;
  std::array<std::shared_ptr<const ChartedTriangulation>, 2> Charts;
  std::shared_ptr<const CubicHomeomorphism> Cubic;
  /// For an inverted map: the pair to which Cubic refers, and whether its domains are exchanged.
  std::shared_ptr<const TriangulationPair> CubicPair;
  bool IsCubicInverted = false;
};

} // namespace homeomorphism

#endif
