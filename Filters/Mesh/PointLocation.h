// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PointLocation.h
/// Which triangle is a point in?

#ifndef homeomorphism_PointLocation_h
#define homeomorphism_PointLocation_h

#include "BoxTree.h"
#include "Embedding.h"
#include "Triangulation.h"

namespace homeomorphism
{

/// Where a point was found.
struct Location
{
  /// -1 if the point is outside.
  TriangleIndex Triangle = -1;
  /// The point in the triangle's frame, taken to the nearest point of the closed triangle.
  FramePoint Point;
  /// The triangle's corner (0 to 2) that the point is equal to, bit for bit, or -1.
  int Corner = -1;
};

/// Finds the triangle of a point. The answer is a function of the point alone: it depends neither on
/// the hint nor on earlier points or other threads.
///
/// In a plane every point of the closed domain is found, edges and vertices included, by exact
/// predicates; of several triangles that share the point the one with the lowest number counts. In
/// 3-space the nearest triangle counts, the lowest number of equally near ones. A point outside by no
/// more than the tolerance is taken to the nearest point of the domain.
class PointLocation
{
public:
  /// Refers to the two, which must outlive it. Masked triangles are not found.
  PointLocation(const Triangulation& triangulation, const Embedding& embedding);

  /// @a working is the point in the embedding's working coordinates, @a tolerance a distance in
  /// them, @a hint the triangle where the point probably is, or -1.
  Location Find(const Vector3& working, double tolerance, TriangleIndex hint) const;

  /// Calls visit(triangle) for the triangles of a planar domain whose boxes may meet a box, until it
  /// returns false.
  template <typename Visit>
  void VisitNear(const Box<2>& box, Visit&& visit) const
  {
    this->PlaneTree.Search(box, visit);
  }

private:
  Box<2> PlaneBox(TriangleIndex triangle) const;
  Location Place(TriangleIndex triangle, const Vector3& working) const;
  Location FindInPlane(const Vector3& working, double tolerance, TriangleIndex hint) const;
  Location FindNearest(const Vector3& working, double tolerance) const;

  const Triangulation& Topology;
  const Embedding& Geometry;
  BoxTree<2> PlaneTree;
  BoxTree<3> SpaceTree;
};

} // namespace homeomorphism

#endif
