// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeshGeometry.h
/// The geometric half of a mesh: where the points are, and each triangle's own frame.

#ifndef homeomorphism_MeshGeometry_h
#define homeomorphism_MeshGeometry_h

#include "Box.h"
#include "LargeArray.h"
#include "Triangulation.h"
#include "Vector3.h"

#include "Kernel/Geometry.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

class vtkPoints;

namespace homeomorphism
{

/// A point of a triangle's own frame: in its plane, and the distance from the plane.
struct FramePoint
{
  Vector2 InPlane;
  double Offset = 0.0;
};

/// Frame and shape of a triangle in the plane: all that locating and mapping a point need to know
/// of it.
struct alignas(64) PlaneFrame
{
  Vector2 Origin;
  Vector2 Tangent;
  double Base = 1.0;
  double ApexX = 0.5;
  double Height = 1.0;
  std::int32_t Apex = 2;
  /// 1 if the apex is to the left of the tangent, -1 if to the right.
  std::int32_t Orientation = 1;

  TriangleShape Shape() const { return { this->Base, this->ApexX, this->Height, this->Apex }; }

  Vector2 ToFrame(const Vector2& point) const
  {
    const Vector2 d = point - this->Origin;
    return { Dot(d, this->Tangent), this->Orientation * Cross(this->Tangent, d) };
  }

  Vector2 FromFrame(const Vector2& point) const
  {
    const double y = this->Orientation * point.y;
    return { this->Origin.x + (point.x * this->Tangent.x - y * this->Tangent.y),
      this->Origin.y + (point.x * this->Tangent.y + y * this->Tangent.x) };
  }
};
static_assert(sizeof(PlaneFrame) == 64, "One line of a processor's cache");

/// Positions of a triangulation's points, in a plane or as a surface in 3-space.
///
/// Everything is computed in *normalized coordinates*: those of the input times a power of two,
/// Scale, which brings the largest of them near 1 without rounding, so that meshes the size of an
/// atom or of a galaxy are the same to the arithmetic. In a plane, any plane, normalized
/// coordinates are two coordinates within it and the distance from it; if the plane is parallel to
/// two of the axes they are the input's own coordinates, unrounded.
class MeshGeometry
{
public:
  /// Reads the points that @a triangulation's triangles use. The triangles' corners must exist. If
  /// the points are planar, the plane's normal is the one that points along the axis it is closest
  /// to (the last of equally close ones), or, if @a companion is given and planar, the one that is
  /// less than a right angle from the companion's.
  MeshGeometry(
    vtkPoints* points, const Triangulation& triangulation, const MeshGeometry* companion = nullptr);

  /// Computes the triangles' frames. All triangles that are not masked must have an area.
  void ComputeFrames(const Triangulation& triangulation);

  /// Whether the coordinates of all corners are finite, of triangles that are not masked.
  bool IsFinite() const { return this->Finite; }
  /// Whether all points lie in one plane (to the rounding of their coordinates).
  bool IsPlanar() const { return this->Planar; }
  /// Whether distances from the plane are unlimited and measured along the plane's normal, as in
  /// both meshes of a planar pair. Otherwise each triangle has its own normal, given by its
  /// winding.
  bool IsColumnar() const { return this->Columnar; }
  void SetColumnar(bool columnar) { this->Columnar = columnar; }

  /// Working coordinates over input coordinates, a power of two.
  double GetScale() const { return this->Scale; }
  double GetInverseScale() const { return this->InverseScale; }
  /// Largest absolute normalized coordinate of a point, about 1.
  double GetLargestCoordinate() const { return this->LargestCoordinate; }
  /// The box around the points of a planar mesh that triangles use, in its plane.
  const Box<2>& GetPlaneBounds() const { return this->PlaneBounds; }
  /// Of a surface whose points lie almost in a plane, within a millionth of its diagonal: the
  /// largest distance of a point from that plane, in normalized coordinates, if the plane is one of
  /// those between the points. 0 for all other meshes.
  double GetThickness() const { return this->Thickness; }
  /// Length of the diagonal of the box around the points, in normalized coordinates.
  double GetDiagonal() const { return this->Diagonal; }
  /// Relative rounding error of the coordinates as they were stored: half an ulp of float or
  /// double.
  double GetCoordinatePrecision() const { return this->CoordinatePrecision; }

  /// How far, in normalized coordinates, a point that should lie on an edge may be from it because
  /// coordinates are rounded: 8 u L + 16 v L, with L the largest coordinate, u the precision of the
  /// stored coordinates, and v that of double.
  ///
  /// A point a + t (b - a) of an edge from a to b, computed in the precision of the coordinates,
  /// has rounding errors of at most 2 u L (difference), 2 u L (product) and u L (sum) in each
  /// coordinate, together less than 8 u L in any direction of the plane. If a, b and the point have
  /// each been rounded instead, their distances add up to less than 4 u L. In a plane that is not
  /// parallel to two axes, the two coordinates in the plane are sums of three products, with errors
  /// of less than 6 v L each, in the point and in the edge. Distances are computed as doubles.
  ///
  /// It is also the distance at which a point with coordinates of this precision may be found from
  /// the mesh. @a precision counts if it is coarser than that of the mesh.
  double GetRounding(double precision = 0.0) const
  {
    return (8.0 * std::max(precision, this->CoordinatePrecision) +
             8.0 * std::numeric_limits<double>::epsilon()) *
      this->LargestCoordinate;
  }

  Vector3 ToNormalized(const double point[3]) const
  {
    if (this->AxisParallel)
    {
      return { point[this->AxisOrder[0]] * this->Scale, point[this->AxisOrder[1]] * this->Scale,
        this->NormalSign * (point[this->AxisOrder[2]] * this->Scale) - this->PlaneDistance };
    }
    const Vector3 p{ point[0] * this->Scale, point[1] * this->Scale, point[2] * this->Scale };
    return this->Planar ? this->ToTiltedPlane(p) : p;
  }

  /// The same for many points, whose normalized coordinates are in arrays of their own.
  void FromNormalized(
    const double* x, const double* y, const double* z, int count, double (*points)[3]) const
  {
    if (!this->AxisParallel || this->AxisOrder[0] != 0 || this->AxisOrder[1] != 1)
    {
      for (int i = 0; i < count; ++i)
      {
        this->FromNormalized({ x[i], y[i], z[i] }, points[i]);
      }
      return;
    }
    // A plane parallel to x and y, not turned over.
    const double scale = this->InverseScale;
    const double distance = this->PlaneDistance;
    for (int i = 0; i < count; ++i)
    {
      points[i][0] = x[i] * scale;
      points[i][1] = y[i] * scale;
      points[i][2] = (z[i] + distance) * scale;
    }
  }

  void FromNormalized(const Vector3& normalized, double point[3]) const
  {
    if (this->AxisParallel)
    {
      const double height = this->NormalSign * (normalized[2] + this->PlaneDistance);
      point[this->AxisOrder[0]] = normalized[0] * this->InverseScale;
      point[this->AxisOrder[1]] = normalized[1] * this->InverseScale;
      point[this->AxisOrder[2]] = height * this->InverseScale;
      return;
    }
    const Vector3 p = this->Planar ? this->FromTiltedPlane(normalized) : normalized;
    for (int axis = 0; axis < 3; ++axis)
    {
      point[axis] = p[axis] * this->InverseScale;
    }
  }

  /// Whether a point equals a point of the mesh, bit for bit.
  bool IsMeshPoint(std::int32_t meshPoint, const double point[3]) const;

  /// The point at a distance from a point of the mesh, along the plane's normal; the mesh's own
  /// point, unrounded, if the distance is 0.
  void FromMeshPoint(std::int32_t meshPoint, double offset, double point[3]) const;

  /// Normalized coordinates of a point of the mesh; in the plane the third is the distance from it.
  Vector3 GetPoint(std::int32_t point) const
  {
    if (this->Planar)
    {
      const Vector2& p = this->PlanePoints[point];
      return { p.x, p.y, 0.0 };
    }
    return this->SpacePoints[point];
  }
  /// The vector from one point of the mesh to another, in the input's coordinates. It is the
  /// difference of nearby numbers, so that points close to each other have an accurate one however
  /// far from the origin they are.
  Vector3 GetVector(std::int32_t from, std::int32_t to) const;
  /// The same for a planar mesh.
  const Vector2& GetPlanePoint(std::int32_t point) const { return this->PlanePoints[point]; }

  /// Orientation of a triangle of a planar mesh with respect to the plane's normal, exactly: 1 if
  /// its corners run counterclockwise, -1 if clockwise, 0 if it has no area.
  int GetOrientation(const Triangulation::Corners& corners) const;
  /// The same, looked up, of a triangle that is not masked and whose corners are finite.
  int GetOrientation(TriangleIndex triangle) const
  {
    return this->Orientations.empty() ? this->PlaneFrames[triangle].Orientation
                                      : this->Orientations[triangle];
  }
  /// Whether the triangle has no area: exactly none in a plane parallel to two axes, none to the
  /// rounding of coordinates as doubles otherwise.
  bool IsDegenerate(const Triangulation& triangulation, TriangleIndex triangle) const;
  /// Whether the coordinates of all corners are finite.
  bool IsFinite(const Triangulation::Corners& corners) const;
  /// Whether the triangle is concordant (see IsConcordant), exactly.
  bool IsConcordant(const Triangulation::Corners& corners) const;
  /// What each edge sees of the triangle.
  EdgeViews GetViews(const Triangulation::Corners& corners) const;
  /// What the edge opposite one of the corners sees, to the same bits.
  EdgeView GetView(const Triangulation::Corners& corners, int edge) const;

  TriangleShape GetShape(TriangleIndex triangle) const
  {
    return this->Planar ? this->PlaneFrames[triangle].Shape() : this->SpaceFrames[triangle].Shape;
  }

  /// The corner opposite a triangle's longest edge.
  int GetApex(TriangleIndex triangle) const
  {
    return this->Planar ? this->PlaneFrames[triangle].Apex : this->SpaceFrames[triangle].Shape.Apex;
  }

  /// The frame of a triangle of a planar mesh.
  const PlaneFrame& GetPlaneFrame(TriangleIndex triangle) const
  {
    return this->PlaneFrames[triangle];
  }

  /// Prefetches a triangle's frame.
  void PrefetchFrame(TriangleIndex triangle) const
  {
    if (this->Planar)
    {
      Prefetch(&this->PlaneFrames[triangle]);
    }
    else
    {
      Prefetch(&this->SpaceFrames[triangle]);
    }
  }

  FramePoint ToFrame(TriangleIndex triangle, const Vector3& normalized) const;
  Vector3 FromFrame(TriangleIndex triangle, const FramePoint& point) const;

  /// The frame's axes as unit vectors of the input's space: along the triangle's longest edge, from
  /// it towards the apex, and the normal along which offsets are measured.
  std::array<Vector3, 3> GetAxes(TriangleIndex triangle) const;

  /// 1 if the frame's axes are right-handed, -1 if left-handed.
  double GetHandedness(TriangleIndex triangle) const
  {
    return this->Columnar ? this->PlaneFrames[triangle].Orientation : 1.0;
  }

private:
  /// Frame of a triangle in 3-space.
  struct SpaceFrame
  {
    Vector3 Origin;
    Vector3 Tangent;
    Vector3 Inward;
    Vector3 Normal;
    TriangleShape Shape;
  };

  Vector3 ToTiltedPlane(const Vector3& scaled) const;
  Vector3 FromTiltedPlane(const Vector3& normalized) const;
  /// The corner opposite the longest edge; the first of equals.
  int FindApex(const Triangulation::Corners& corners) const;
  class MeshPoints;
  void FindPlane(
    const MeshPoints& points, const std::vector<std::uint8_t>& used, const MeshGeometry* companion);
  void FindThickness(
    const MeshPoints& points, const std::vector<std::uint8_t>& used, const Vector3& normal);
  void FindOrientations(const Triangulation& triangulation);
  void ComputePlaneFrames(
    const Triangulation& triangulation, TriangleIndex begin, TriangleIndex end);
  void ComputeSpaceFrame(TriangleIndex triangle, const Triangulation::Corners& corners);

  bool Finite = true;
  bool Planar = false;
  bool Columnar = false;
  /// Whether the plane is parallel to two axes: no rounding on the way to normalized coordinates.
  bool AxisParallel = false;
  double Scale = 1.0;
  double InverseScale = 1.0;
  double LargestCoordinate = 0.0;
  double Diagonal = 0.0;
  double Thickness = 0.0;
  double CoordinatePrecision = 0.0;

  // The plane: axes U, V within it and the normal N, right-handed, and its distance from the
  // origin.
  std::array<Vector3, 3> PlaneAxes{};
  std::array<int, 3> AxisOrder{ 0, 1, 2 };
  double NormalSign = 1.0;
  double PlaneDistance = 0.0;

  LargeArray<Vector2> PlanePoints;
  Box<2> PlaneBounds;
  // Of a surface, and of a plane that is not parallel to two axes: the input's coordinates times
  // Scale.
  LargeArray<Vector3> SpacePoints;
  // Of a planar mesh, until it has frames.
  LargeArray<std::int8_t> Orientations;
  LargeArray<PlaneFrame> PlaneFrames;
  LargeArray<SpaceFrame> SpaceFrames;
};

} // namespace homeomorphism

#endif
