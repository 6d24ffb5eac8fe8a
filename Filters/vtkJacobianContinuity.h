// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkJacobianContinuity
 * @brief   measure whether a map is differentiable across the edges of a triangulation
 *
 * vtkJacobianContinuity takes a triangulation (input port 0) and a map of its domain, and tells for
 * each interior edge whether the map's Jacobian is the same on both sides. The map is either any
 * vtkAbstractTransform (SetTransform; the triangulation must then be planar), or the homeomorphism
 * onto a second triangulation with the same triangles (input port 1), planar or a surface in
 * 3-space; on surfaces the two sides are compared after unfolding them about the edge. On request
 * it tells the same for other places where a map made of pieces may fail; see PlaceTypes.
 *
 * The map is only evaluated, never looked into: derivatives are one-sided differences over halving
 * steps, extrapolated to step 0 (Richardson), with a bound on their error from how the
 * extrapolations disagree and from the rounding of the map's values. Steps are proportions of the
 * triangles, so nothing depends on the units.
 *
 * What is measured so has limits, and the error bounds and verdicts are estimates, not proofs.
 * Nothing is known between the samples, nor of what happens within distances where the change of
 * the map's values is lost in their rounding. So a second line along which the map is not smooth,
 * too close to tell apart, may leave a place undecided, rarely make it a crease; a derivative that
 * does have a limit but approaches it more slowly than the 0.1th power of the distance is taken for
 * a crease; and beside needles with an area below about 1e-4 of their neighbor's the Smooth system
 * turns within a layer too thin to see. Far from the origin less can be told than near it.
 *
 * Output port 0 has a polyline through the sample points of each interior edge, from one of its
 * vertices to the other, with these cell arrays (double unless it says otherwise):
 *
 * - `JacobianJump`: norm of the difference of the two Jacobians over the norm of the Jacobian, the
 *   largest over the edge's samples; the arrays below are for the sample where it is largest;
 * - `JacobianJumpError`: bound on the error of the estimate, the largest over the samples;
 * - `JacobianJumpExact`: the same jump in closed form, if the map is the homeomorphism onto the
 * target, or a vtkHomeomorphismTransform whose source has the triangulation's own vtkPoints; else
 * NaN, as at vertices;
 * - `NormalJump`, `TangentialJump`: the jump's parts across the line's image and along it;
 * - `AngleJump` (degrees) and `StretchJump`: the angle between the images of the direction across
 * the line on the two sides, and the ratio of the longer to the shorter, less 1;
 * - `ConvergenceOrder`: the exponent with which the difference of the plain quotients on the two
 * sides shrinks with the step, 1 for a differentiable map, 0 for a crease; NaN where it is all
 * rounding;
 * - `Verdict` (int): see Verdicts. A crease is a jump larger than Resolution that stands out from
 * its error bound; a map is called differentiable where the jump, its error bound added, is below
 *   Resolution;
 * - `EdgeTriangles` (vtkIdType, 2 components): cell ids of the two triangles; the same one twice
 * for places within a triangle; the second is -1 for boundary edges and vertices;
 * - `PlaceType` (int): see PlaceTypes;
 * - with SecondDerivatives, `SecondDerivativeJump`, `SecondDerivativeJumpError` (times the reach of
 * the steps over the norm of the Jacobian) and `SecondDerivativeVerdict` (int): the same for the
 * second derivative across the line.
 *
 * The point arrays `JacobianJump`, `JacobianJumpError` and `JacobianJumpExact` have the values at
 * the samples (NaN at the ends of lines).
 *
 * Centroids and vertices are vertex cells, which come first in the cell arrays. There the one-sided
 * derivatives in directions all around are compared with those of the linear map that fits them
 * best (by least squares); the jump is the largest deviation, over the norm. Its parts, angle and
 * stretch have no meaning and are NaN. Where there is nothing to compare, at boundary edges and at
 * the vertices of surfaces, which have no tangent plane, all numbers are NaN and the verdict is
 * NOTHING_TO_COMPARE.
 *
 * Output port 1 is the triangulation with a cell array and a point array `JacobianJump`: the
 * largest of the triangle's interior edges, and of the edges at the point; NaN where there is none.
 *
 * The meshes are asked for whole, and if the outputs are asked for in pieces, all is part of piece
 * 0.
 *
 * Points are processed in parallel (vtkSMPTools); results do not depend on the number of threads.
 * The transform must allow concurrent calls once updated, as VTK's do.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkHomeomorphismTransform
 */

#ifndef vtkJacobianContinuity_h
#define vtkJacobianContinuity_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

#include <memory> // for the internals

class vtkAbstractTransform;
class vtkMultiProcessController;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkJacobianContinuity : public vtkPolyDataAlgorithm
{
public:
  static vtkJacobianContinuity* New();
  vtkTypeMacro(vtkJacobianContinuity, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What is concluded about a place.
  enum Verdicts
  {
    NOTHING_TO_COMPARE = -1,
    DIFFERENTIABLE = 0,
    CREASE = 1,
    UNDECIDED = 2
  };

  /// The kinds of places. All but the first are measured on request only. Those within triangles
  /// are where one of the coordinate systems is made of pieces; they follow from the triangulation
  /// alone and can be asked for whatever the map is. The center of a triangle is its centroid, or
  /// in the Contour system the point that CenterPoint says.
  enum PlaceTypes
  {
    EDGE = 0,          ///< interior edge
    BOUNDARY_EDGE = 1, ///< has one side only, and no jump
    SPOKE = 2,         ///< from a triangle's center to a corner
    WING_SEGMENT = 3,  ///< from the middle of a center segment to an end of its edge
    CENTER_SEGMENT =
      4, ///< from a triangle's center to its foot on an edge; where the foot is outside
         ///< the edge, neither this nor the edge's wing segments are measured
    STRIP_BORDER =
      5, ///< of the strip along an interior edge in which the Smooth chart is not affine
    TRIANGLE_CENTER = 6, ///< a triangle's center; asked for as Centroids
    VERTEX = 7           ///< a point of the triangulation, on the boundary too
  };

  /// The coordinate systems; see vtkDifferentiableHomeomorphism.
  enum CoordinateSystems
  {
    LINEAR = 0,
    CONTOUR = 1,
    SMOOTH = 2
  };

  /// Where the contours of the Contour system start.
  enum CenterPoints
  {
    CENTROID = 0,
    INCENTER = 1
  };

  /// What becomes of discordant triangles in the Contour system.
  enum DiscordantTrianglesModes
  {
    REFUSE = 0,
    USE_LINEAR = 1
  };

  ///@{
  /// The triangulation, input port 0.
  void SetSourceConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(0, output); }
  void SetSourceData(vtkPolyData* source);
  ///@}

  ///@{
  /// The target of the homeomorphism to be measured, input port 1; not used if there is a
  /// transform.
  void SetTargetConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetTargetData(vtkPolyData* target);
  ///@}

  ///@{
  /// The map to be measured, if it is not the homeomorphism onto the target.
  virtual void SetTransform(vtkAbstractTransform* transform);
  vtkGetObjectMacro(Transform, vtkAbstractTransform);
  ///@}

  ///@{
  /// Of the homeomorphism onto the target: LINEAR, CONTOUR or SMOOTH (default), and how Contour is
  /// to be understood. See vtkDifferentiableHomeomorphism.
  vtkSetClampMacro(CoordinateSystem, int, LINEAR, SMOOTH);
  vtkGetMacro(CoordinateSystem, int);
  vtkSetClampMacro(CenterPoint, int, CENTROID, INCENTER);
  vtkGetMacro(CenterPoint, int);
  vtkSetClampMacro(DiscordantTriangles, int, REFUSE, USE_LINEAR);
  vtkGetMacro(DiscordantTriangles, int);
  vtkSetMacro(MaskInvalidTriangles, bool);
  vtkGetMacro(MaskInvalidTriangles, bool);
  vtkBooleanMacro(MaskInvalidTriangles, bool);
  ///@}

  ///@{
  /// Which places are measured besides the interior edges. None by default.
  vtkSetMacro(BoundaryEdges, bool);
  vtkGetMacro(BoundaryEdges, bool);
  vtkBooleanMacro(BoundaryEdges, bool);
  vtkSetMacro(Spokes, bool);
  vtkGetMacro(Spokes, bool);
  vtkBooleanMacro(Spokes, bool);
  vtkSetMacro(WingSegments, bool);
  vtkGetMacro(WingSegments, bool);
  vtkBooleanMacro(WingSegments, bool);
  vtkSetMacro(CenterSegments, bool);
  vtkGetMacro(CenterSegments, bool);
  vtkBooleanMacro(CenterSegments, bool);
  vtkSetMacro(StripBorders, bool);
  vtkGetMacro(StripBorders, bool);
  vtkBooleanMacro(StripBorders, bool);
  vtkSetMacro(Centroids, bool);
  vtkGetMacro(Centroids, bool);
  vtkBooleanMacro(Centroids, bool);
  vtkSetMacro(Vertices, bool);
  vtkGetMacro(Vertices, bool);
  vtkBooleanMacro(Vertices, bool);
  ///@}

  ///@{
  /// Number of points of a line at which the jump is estimated, evenly spaced, and of directions in
  /// each sector at a centroid or vertex, besides those that bound it. 5 by default, from 1.
  vtkSetClampMacro(SamplesPerEdge, int, 1, 1000);
  vtkGetMacro(SamplesPerEdge, int);
  ///@}

  ///@{
  /// The relative jump up to which a map counts as differentiable; a thousand times that for second
  /// derivatives. 1e-7 by default; estimates are good to 1e-9 as a rule.
  vtkSetClampMacro(Resolution, double, 0.0, 1.0);
  vtkGetMacro(Resolution, double);
  ///@}

  ///@{
  /// Whether second derivatives across the edges are compared, too. Off by default.
  vtkSetMacro(SecondDerivatives, bool);
  vtkGetMacro(SecondDerivatives, bool);
  vtkBooleanMacro(SecondDerivatives, bool);
  ///@}

  ///@{
  /// What the last execution found at the interior edges, in piece 0. See ReduceStatistics.
  vtkGetMacro(NumberOfBoundaryEdges, vtkIdType);
  vtkIdType GetNumberOfDifferentiableEdges() { return this->Counts[EDGE][DIFFERENTIABLE]; }
  vtkIdType GetNumberOfCreases() { return this->Counts[EDGE][CREASE]; }
  vtkIdType GetNumberOfUndecidedEdges() { return this->Counts[EDGE][UNDECIDED]; }
  vtkGetMacro(LargestJump, double);
  ///@}

  /// The number of places of a type (see PlaceTypes) about which the last execution concluded @a
  /// verdict (DIFFERENTIABLE, CREASE or UNDECIDED).
  vtkIdType GetNumberOfFeatures(int placeType, int verdict);

  /// Makes the numbers that this filter counts (NumberOfCreases, LargestJump and
  /// the like, GetNumberOfFeatures) the same in all processes that
  /// have pieces of the data: counts become sums, LargestJump the largest; all is measured by the
  /// process that has piece 0. Each process of @a controller (null: the global controller; if there
  /// is none, nothing happens) must call this after its update, also one that had nothing to update
  /// or had an error: executing the filter never waits for other processes, this does. They are one
  /// process's own again after the next execution. In ParaView the plugin does it.
  void ReduceStatistics(vtkMultiProcessController* controller);

  /// Includes the transform's.
  vtkMTimeType GetMTime() override;

protected:
  vtkJacobianContinuity();
  ~vtkJacobianContinuity() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  vtkAbstractTransform* Transform = nullptr;
  int CoordinateSystem = SMOOTH;
  int CenterPoint = CENTROID;
  int DiscordantTriangles = REFUSE;
  bool MaskInvalidTriangles = false;
  int SamplesPerEdge = 5;
  double Resolution = 1e-7;
  bool SecondDerivatives = false;
  bool BoundaryEdges = false;
  bool Spokes = false;
  bool WingSegments = false;
  bool CenterSegments = false;
  bool StripBorders = false;
  bool Centroids = false;
  bool Vertices = false;
  vtkIdType NumberOfBoundaryEdges = 0;
  double LargestJump = 0.0;

private:
  vtkJacobianContinuity(const vtkJacobianContinuity&) = delete;
  void operator=(const vtkJacobianContinuity&) = delete;

  int Measure(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs);

  class Internals;
  std::unique_ptr<Internals> Internal;
  vtkIdType Counts[VERTEX + 1][UNDECIDED + 1] = {};
};

#endif
