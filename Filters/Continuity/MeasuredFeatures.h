// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeasuredFeatures.h
/// The features of a triangulation at which vtkJacobianContinuity measures a map.

#ifndef homeomorphism_MeasuredFeatures_h
#define homeomorphism_MeasuredFeatures_h

#include "EdgeCrossings.h"
#include "FeatureKind.h"
#include "InnerLines.h"
#include "RayFans.h"

#include "vtkType.h"

#include <array>
#include <optional>
#include <vector>

namespace homeomorphism
{

/// The kinds to be measured.
using FeatureSelection = std::array<bool, NumberOfFeatureKinds>;

struct MeasuredFeature
{
  FeatureKind Kind;
  /// The index of the edge, triangle or point.
  std::int32_t Item;
  /// The index of a line within its triangle.
  int Line = 0;
};

/// The features of a map's source: first points (centroids, vertices), then lines (edges, boundary
/// edges, spokes, wing segments, center segments, strip borders), which is the order of cells in a
/// vtkPolyData.
class MeasuredFeatures
{
public:
  /// Keeps a reference to the map. @a planar: whether source and image are planar, so that
  /// derivatives at vertices can be compared.
  MeasuredFeatures(const Homeomorphism& map, CenterPoint center, const FeatureSelection& selection,
    bool planar, int samples);

  vtkIdType GetNumberOfFeatures() const { return static_cast<vtkIdType>(this->Features.size()); }
  const MeasuredFeature& GetFeature(vtkIdType feature) const { return this->Features[feature]; }
  const EdgeCrossings& GetEdges() const { return this->Edges; }

  static bool IsPoint(FeatureKind kind)
  {
    return kind == FeatureKind::Centroid || kind == FeatureKind::Vertex;
  }

  /// Whether derivatives at a feature of this kind can be compared.
  bool IsMeasurable(FeatureKind kind) const
  {
    return kind != FeatureKind::BoundaryEdge && (kind != FeatureKind::Vertex || this->Planar);
  }

  /// The number of points at which a feature is measured.
  int GetNumberOfSamples(FeatureKind kind) const
  {
    return !this->IsMeasurable(kind) ? 0 : IsPoint(kind) ? 1 : this->Samples;
  }

  /// The number of points of a feature in the output: its samples, and the two ends of a line.
  int GetNumberOfPoints(FeatureKind kind) const
  {
    return IsPoint(kind) ? 1 : this->GetNumberOfSamples(kind) + 2;
  }

  /// Cell ids of the triangles on both sides of a feature, around it, or at it; -1 for none.
  std::array<vtkIdType, 2> GetCells(const MeasuredFeature& feature) const;

  /// The position of a point of the feature in the output.
  Vector3 GetPosition(const MeasuredFeature& feature, int point) const;

  /// The results at a sample (numbered from 0): the measured jump; that of the second derivative,
  /// if requested and if the feature is a line; and the closed form if there is one, otherwise NaN.
  struct Sample
  {
    JacobianJump First;
    JacobianJump Second;
    double Exact = JacobianJump::None;
  };
  Sample Measure(const MeasuredFeature& feature, int sample, const MapUnderTest& map,
    double resolution, bool secondDerivatives) const;

private:
  double GetProportion(int point) const { return point / (this->Samples + 1.0); }
  void AddInnerLines(FeatureKind kind);

  const Homeomorphism& Map;
  bool Planar;
  int Samples;
  EdgeCrossings Edges;
  InnerLines Lines;
  /// Empty if only lines are measured.
  std::optional<RayFans> Points;
  std::vector<MeasuredFeature> Features;
};

} // namespace homeomorphism

#endif
