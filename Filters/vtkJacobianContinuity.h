// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkJacobianContinuity
 * @brief   measure whether a map is differentiable across the edges of a triangulation
 *
 * For each interior edge of the source mesh, the filter compares the Jacobians of a map on the two
 * sides. The map is the homeomorphism onto the target (on surfaces, the two triangles are unfolded
 * about the edge) or any vtkAbstractTransform (SetTransform; the mesh must then be planar). Other
 * features are measured on request; see FeatureTypes.
 *
 * The filter uses only values of the map. One-sided difference quotients are extrapolated to step 0
 * (Richardson); the steps are halved repeatedly and are relative to the size of the triangles.
 * Error bounds and verdicts are estimates, not proofs; see Documentation/differentiability.md for
 * their limits.
 *
 * Output port 0 has a polyline through the samples of each edge or other line, and a vertex cell
 * for each center and vertex; vertex cells come first. Cell arrays (double unless stated
 * otherwise):
 *
 * - `JacobianJump`: the norm of the difference of the two Jacobians divided by the norm of the
 *   Jacobian, maximum over the samples. The following arrays are for the sample with the maximum,
 *   unless stated otherwise;
 * - `JacobianJumpError`: a bound on the error of the estimate, maximum over the samples;
 * - `JacobianJumpExact`: the jump in closed form if the map is the homeomorphism onto the target or
 *   a vtkHomeomorphismTransform whose source shares the mesh's vtkPoints; otherwise NaN;
 * - `NormalJump`, `TangentialJump`: the components of the jump across and along the image of the
 *   line;
 * - `AngleJump` (degrees), `StretchJump`: the angle between the images, on the two sides, of the
 *   direction across the line, and the ratio of their lengths, the longer to the shorter, minus 1;
 * - `ConvergenceOrder`: the power of the step with which the difference of the quotients on the two
 *   sides decreases: 1 if the map is differentiable, 0 at a crease, NaN if rounding dominates;
 * - `Verdict` (int): see Verdicts;
 * - `EdgeTriangles` (vtkIdType, 2 components): cell ids of the two triangles; equal for features
 *   within a triangle; the second is -1 at boundary edges and vertices;
 * - `FeatureType` (int): see FeatureTypes;
 * - `SecondDerivativeJump`, `SecondDerivativeJumpError` (relative to the norm of the Jacobian
 *   divided by the largest step), `SecondDerivativeVerdict` (int): the same for the second
 *   derivative across the line; with SecondDerivatives.
 *
 * The point arrays `JacobianJump`, `JacobianJumpError` and `JacobianJumpExact` have the values at
 * the samples (NaN at the ends of lines). At centers and vertices, the one-sided derivatives in all
 * directions are compared with those of the linear map that fits them best (least squares);
 * `NormalJump`, `TangentialJump`, `AngleJump` and `StretchJump` are NaN there. Boundary edges and
 * the vertices of surfaces have NaN and the verdict NOTHING_TO_COMPARE.
 *
 * Output port 1 is the mesh with a cell array and a point array `JacobianJump`: the largest jump at
 * the edges of the triangle or point, NaN if it has no interior edges. All output is part of piece
 * 0. After an update, the transform must support concurrent calls, as VTK's transforms do.
 *
 * @sa vtkHomeomorphismAlgorithm, vtkDifferentiableHomeomorphism, vtkHomeomorphismTransform
 */

#ifndef vtkJacobianContinuity_h
#define vtkJacobianContinuity_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkHomeomorphismAlgorithm.h"

#include <memory> // for the internals

class vtkAbstractTransform;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkJacobianContinuity : public vtkHomeomorphismAlgorithm
{
public:
  static vtkJacobianContinuity* New();
  vtkTypeMacro(vtkJacobianContinuity, vtkHomeomorphismAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The verdict on a feature.
  enum Verdicts
  {
    NOTHING_TO_COMPARE = -1, ///< boundary edges, and vertices of surfaces
    DIFFERENTIABLE = 0,      ///< the jump plus its error bound is below Resolution
    CREASE = 1,              ///< the jump exceeds Resolution and its error bound
    UNDECIDED = 2            ///< neither
  };

  /// The kinds of features. All but EDGE are measured only on request. Features within triangles
  /// separate the pieces of piecewise defined charts. They depend on the mesh, not on the map. The
  /// center of a triangle is its centroid, or CenterPoint in the CONTOUR system.
  enum FeatureTypes
  {
    EDGE = 0,            ///< interior edge
    BOUNDARY_EDGE = 1,   ///< edge of only one triangle; it has no jump
    SPOKE = 2,           ///< from a triangle's center to a corner
    WING_SEGMENT = 3,    ///< from the middle of a center segment to an end of its edge
    CENTER_SEGMENT = 4,  ///< from a triangle's center to its foot, if that is inside the edge
    STRIP_BORDER = 5,    ///< border of the strip of the SMOOTH system at an interior edge
    TRIANGLE_CENTER = 6, ///< a triangle's center, requested by Centroids
    VERTEX = 7           ///< a point of the mesh
  };

  ///@{
  /// The map that is measured instead of the homeomorphism onto the target. Null by default.
  virtual void SetTransform(vtkAbstractTransform* transform);
  vtkGetObjectMacro(Transform, vtkAbstractTransform);
  ///@}

  ///@{
  /// The features that are measured in addition to the interior edges. Off by default.
  vtkHomeomorphismSwitchMacro(BoundaryEdges, false);
  vtkHomeomorphismSwitchMacro(Spokes, false);
  vtkHomeomorphismSwitchMacro(WingSegments, false);
  vtkHomeomorphismSwitchMacro(CenterSegments, false);
  vtkHomeomorphismSwitchMacro(StripBorders, false);
  vtkHomeomorphismSwitchMacro(Centroids, false);
  vtkHomeomorphismSwitchMacro(Vertices, false);
  ///@}

  ///@{
  /// SamplesPerEdge: the number of evenly spaced samples of a line, and of directions within each
  /// sector at a center or vertex (5 by default, 1 to 1000). Resolution: the relative jump up to
  /// which a map is regarded as differentiable, times 1000 for second derivatives (1e-7 by default,
  /// 0 to 1). SecondDerivatives: whether second derivatives are also compared (off by default).
  vtkHomeomorphismOptionMacro(SamplesPerEdge, int, 5, 1, 1000);
  vtkHomeomorphismOptionMacro(Resolution, double, 1e-7, 0.0, 1.0);
  vtkHomeomorphismSwitchMacro(SecondDerivatives, false);
  ///@}

  ///@{
  /// Statistics of the last update (in piece 0): numbers of edges; the largest jump at interior
  /// edges; and the number of features of a type (see FeatureTypes) that have a verdict (see
  /// Verdicts) other than NOTHING_TO_COMPARE. See ReduceStatistics.
  vtkGetMacro(NumberOfBoundaryEdges, vtkIdType);
  vtkIdType GetNumberOfDifferentiableEdges() { return this->Counts[EDGE][DIFFERENTIABLE]; }
  vtkIdType GetNumberOfCreases() { return this->Counts[EDGE][CREASE]; }
  vtkIdType GetNumberOfUndecidedEdges() { return this->Counts[EDGE][UNDECIDED]; }
  vtkGetMacro(LargestJump, double);
  vtkIdType GetNumberOfFeatures(int featureType, int verdict);
  ///@}

  /// The measured lines and points, and the triangulation (output ports 0 and 1).
  vtkPolyData* GetOutput(int port = 0);

  void ReduceStatistics(vtkMultiProcessController* controller) override;
  vtkMTimeType GetMTime() override;

protected:
  vtkJacobianContinuity();
  ~vtkJacobianContinuity() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int Execute(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  vtkAbstractTransform* Transform = nullptr;
  vtkIdType NumberOfBoundaryEdges = 0;
  double LargestJump = 0.0;

private:
  vtkJacobianContinuity(const vtkJacobianContinuity&) = delete;
  void operator=(const vtkJacobianContinuity&) = delete;

  friend class vtkDifferentiableHomeomorphism;
  /// Measures a transform, or @a map if it is null, at the features of the source of @a map, which
  /// was read from @a mesh. Progress and abort requests are those of @a algorithm. Returns false
  /// and leaves the outputs unchanged if aborted.
  bool Measure(vtkAlgorithm* algorithm,
    const std::shared_ptr<const homeomorphism::Homeomorphism>& map, vtkAbstractTransform* transform,
    vtkPolyData* mesh, vtkPolyData* lines, vtkPolyData* colored);

  void ResetStatistics();
  void KeepStatistics();

  class Internals;
  std::unique_ptr<Internals> Internal;
  vtkIdType Counts[VERTEX + 1][UNDECIDED + 1] = {};
};

#endif
