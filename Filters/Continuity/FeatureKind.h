// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FeatureKind.h
/// The features of a triangulation at which a map may not be differentiable.

#ifndef homeomorphism_FeatureKind_h
#define homeomorphism_FeatureKind_h

namespace homeomorphism
{

/// Kinds of features, numbered as in vtkJacobianContinuity. A triangle has six wing segments, three
/// lines of each other kind, and one centroid.
enum class FeatureKind
{
  /// An edge of two triangles.
  Edge = 0,
  BoundaryEdge = 1,
  /// From the center of a triangle to corner k.
  Spoke = 2,
  /// From the middle of the center segment of edge k / 2 to an end of that edge: the next corner in
  /// cyclic order if k is even, the one after if it is odd.
  WingSegment = 3,
  /// From the center to its foot on edge k.
  CenterSegment = 4,
  /// The border of the strip along edge k within which the Smooth chart is not affine.
  StripBorder = 5,
  Centroid = 6,
  Vertex = 7
};

constexpr int NumberOfFeatureKinds = 8;

} // namespace homeomorphism

#endif
