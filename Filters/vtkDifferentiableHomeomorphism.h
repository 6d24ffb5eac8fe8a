// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDifferentiableHomeomorphism
 * @brief   carry data from one triangulated domain onto another, one to one
 *
 * Given two isomorphic triangulations, a source P (input port 0) and a target Q (port 1) with the
 * same triangles and different point coordinates, in a plane or as surfaces in 3-space,
 * vtkDifferentiableHomeomorphism moves every point of some data (port 2; P itself if there is none)
 * from P's domain to Q's. A point goes to the point of the corresponding triangle that has the same
 * coordinates, in one of three coordinate systems:
 *
 * - LINEAR: barycentric coordinates; the piecewise linear map, kinked at every edge;
 * - CONTOUR: the construction published as "Constructing Differentiable Homeomorphisms between
 *   Isomorphic Triangulations". It needs concordant triangles, and is kinked at most edges too;
 * - SMOOTH (default): barycentric coordinates in a chart of each triangle that continues its
 *   neighbors'. The map is twice continuously differentiable, and so is its inverse, everywhere
 * but at the vertices (across edges of surfaces: after unfolding); it is one to one for any
 * triangles that have an area.
 *
 * In all three, edges are mapped linearly onto edges, P = Q gives the identity, maps compose, and
 * Inverse is exactly the map with P and Q exchanged: round trips close to a few units in the last
 * place.
 *
 * The output is the data with its points moved: vtkPointSets keep their type, images and
 * rectilinear grids become vtkStructuredGrids, trees of data sets (vtkMultiBlockDataSet,
 * vtkPartitionedDataSetCollection, ...) keep their structure. Point, cell and field data pass. The
 * active vectors, normals and tensors are carried by the Jacobian J, point data with J at the
 * point, cell data with J at the mean of the cell's points (where that is outside, the result is
 * NaN):
 *
 * - vectors as tangent vectors (velocities, displacements), J v, with their length changed;
 * - normals by the inverse transpose, J^-T n, made unit vectors again;
 * - tensors of 9 (row-major) and 6 components (XX, YY, ZZ, XY, YZ, XZ) as J T J^T;
 * - arrays named with SetAttributeTransformation and GRADIENT_TRANSFORMATION as gradients: vectors
 * J^-T g, tensors J^-T T J^-1, so that the gradient of a scalar stays its gradient.
 *
 * See TransformActiveAttributes, TransformAllInputVectors and SetAttributeTransformation to change
 * what is carried.
 *
 * These arrays are added (an array of the same name is replaced):
 *
 * - point array `vtkValidPointMask` (unsigned char): 1 inside, 0 outside P's domain;
 * - where the Linear system carries discordant triangles (see DiscordantTriangles), point array
 *   `UsedCoordinateSystem` (int): LINEAR or CONTOUR, -1 outside;
 * - with ComputeTriangleId, point array `TriangleId` (vtkIdType): cell id in P, -1 outside;
 * - with ComputeJacobian, point array `Jacobian` (double, 9 components): row-major, NaN outside. On
 *   an edge it is the limit from the triangle TriangleId;
 * - with ComputeJacobianDeterminant, point array `JacobianDeterminant` (double): the ratio of
 * areas, negative where a planar map reverses orientation; NaN outside. Orientation is with respect
 * to the planes' normals: the source's is the one that points along the axis it is closest to, the
 * target's is less than a right angle from it. On surfaces the ratio is positive.
 *
 * With MeasureContinuity, output port 1 tells at each interior edge of the mesh that is mapped from
 * whether the Jacobian is the same on both sides, as measured from the map's values: polylines with
 * the arrays of vtkJacobianContinuity (`JacobianJump`, `Verdict`, ...). What else is measured, and
 * how finely, is set with GetJacobianContinuity(). Without, output port 1 is empty.
 *
 * Outside points are given no image. They stay where they are, marked by vtkValidPointMask, with
 * NaN in arrays that would have been carried; GetNumberOfOutsidePoints counts them; and they, with
 * the cells that use them, are blanked (vtkGhostType), so that no later filter or view takes them
 * for mapped ones; see BlankOutside. Points that are blanked in the input count as outside, so that
 * a map back does not take them for mapped ones either.
 *
 * If both meshes are planar (in any planes), points off P's plane are mapped along with their foot,
 * and their distance from the plane is kept, so that heights pass through a map of the plane. The
 * Jacobian takes the plane's normal to the other plane's. On surfaces, points must lie on the
 * surface to the rounding of their coordinates, or within Tolerance; their images lie on the other
 * surface, and the Jacobian takes normal to normal.
 *
 * The meshes are validated, and refused with a message that names the kind of defect, how many
 * triangles have it and the first of their ids; see MaskInvalidTriangles. Empty meshes leave all
 * points outside. What is computed from the meshes is kept until their points or cells change. If
 * the output is asked for in pieces, the meshes are asked for whole, and what is made from them is
 * part of piece 0: the mesh if it is its own data, and data that is made upstream from what a mesh
 * is made from.
 *
 * Points are processed in parallel (vtkSMPTools); results do not depend on the number of threads.
 *
 * @sa vtkTriangularCoordinates, vtkHomeomorphismTransform, vtkJacobianContinuity
 */

#ifndef vtkDifferentiableHomeomorphism_h
#define vtkDifferentiableHomeomorphism_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkFiltersHomeomorphismModule.h" // for the export macro

#include <memory> // for the internals

class vtkJacobianContinuity;
class vtkMultiProcessController;
class vtkPolyData;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkDifferentiableHomeomorphism : public vtkDataObjectAlgorithm
{
public:
  static vtkDifferentiableHomeomorphism* New();
  vtkTypeMacro(vtkDifferentiableHomeomorphism, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The coordinate systems.
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
    REFUSE = 0,    ///< an error that names them
    USE_LINEAR = 1 ///< the Linear system carries them; the map stays continuous
  };

  /// How an array is carried.
  enum AttributeTransformations
  {
    NO_TRANSFORMATION = 0,       ///< passed as it is
    TANGENT_TRANSFORMATION = 1,  ///< J v, J T J^T
    GRADIENT_TRANSFORMATION = 2, ///< J^-T g, J^-T T J^-1
    NORMAL_TRANSFORMATION = 3    ///< J^-T n, made a unit vector (3 components only)
  };

  ///@{
  /// The source mesh P, input port 0, a vtkPolyData.
  void SetSourceConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(0, output); }
  void SetSourceData(vtkPolyData* source);
  ///@}

  ///@{
  /// The target mesh Q, input port 1, a vtkPolyData with the source's cells.
  void SetTargetConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetTargetData(vtkPolyData* target);
  ///@}

  ///@{
  /// The data to map, input port 2, a vtkDataSet or a vtkDataObjectTree. If there is none, the mesh
  /// that is mapped from is the data.
  void SetDataConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(2, output); }
  void SetDataObject(vtkDataObject* data) { this->SetInputData(2, data); }
  ///@}

  ///@{
  /// The coordinate system: LINEAR, CONTOUR or SMOOTH (default).
  vtkSetClampMacro(CoordinateSystem, int, LINEAR, SMOOTH);
  vtkGetMacro(CoordinateSystem, int);
  void SetCoordinateSystemToLinear() { this->SetCoordinateSystem(LINEAR); }
  void SetCoordinateSystemToContour() { this->SetCoordinateSystem(CONTOUR); }
  void SetCoordinateSystemToSmooth() { this->SetCoordinateSystem(SMOOTH); }
  ///@}

  ///@{
  /// Whether the data is mapped from Q's domain to P's instead. Off by default.
  vtkSetMacro(Inverse, bool);
  vtkGetMacro(Inverse, bool);
  vtkBooleanMacro(Inverse, bool);
  ///@}

  ///@{
  /// The point where the contours of the Contour system start: CENTROID (default), or INCENTER,
  /// with which every triangle is concordant.
  vtkSetClampMacro(CenterPoint, int, CENTROID, INCENTER);
  vtkGetMacro(CenterPoint, int);
  ///@}

  ///@{
  /// In the Contour system, whether triangles that are discordant in P or Q are an error (REFUSE,
  /// default) or are carried by the Linear system (USE_LINEAR).
  vtkSetClampMacro(DiscordantTriangles, int, REFUSE, USE_LINEAR);
  vtkGetMacro(DiscordantTriangles, int);
  ///@}

  ///@{
  /// Whether triangles that are invalid by themselves (no area, not finite, flipped, overlapping,
  /// at an edge of more than two) are left out with a warning, as if there were holes, instead of
  /// refusing the meshes. Of triangles that overlap each other, all are. Off by default.
  vtkSetMacro(MaskInvalidTriangles, bool);
  vtkGetMacro(MaskInvalidTriangles, bool);
  vtkBooleanMacro(MaskInvalidTriangles, bool);
  ///@}

  ///@{
  /// How far outside the domain a point may be and still be taken to the nearest point of it, as a
  /// proportion of the diagonal of the domain's bounding box. 0 (default) allows only for the
  /// rounding of coordinates. Not negative.
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// Whether to add the point arrays `TriangleId`, `Jacobian`, `JacobianDeterminant`. Off by
  /// default.
  vtkSetMacro(ComputeTriangleId, bool);
  vtkGetMacro(ComputeTriangleId, bool);
  vtkBooleanMacro(ComputeTriangleId, bool);
  vtkSetMacro(ComputeJacobian, bool);
  vtkGetMacro(ComputeJacobian, bool);
  vtkBooleanMacro(ComputeJacobian, bool);
  vtkSetMacro(ComputeJacobianDeterminant, bool);
  vtkGetMacro(ComputeJacobianDeterminant, bool);
  vtkBooleanMacro(ComputeJacobianDeterminant, bool);
  ///@}

  ///@{
  /// Whether the active vectors, normals and tensors are carried by the Jacobian (default on) or
  /// left alone, arrays named with SetAttributeTransformation excepted.
  vtkSetMacro(TransformActiveAttributes, bool);
  vtkGetMacro(TransformActiveAttributes, bool);
  vtkBooleanMacro(TransformActiveAttributes, bool);
  ///@}

  ///@{
  /// Whether all other floating-point arrays of 3, 6 and 9 components are carried too, as tangent
  /// vectors and tensors; texture coordinates, active scalars and arrays named `Jacobian` are not.
  /// Off by default.
  vtkSetMacro(TransformAllInputVectors, bool);
  vtkGetMacro(TransformAllInputVectors, bool);
  vtkBooleanMacro(TransformAllInputVectors, bool);
  ///@}

  ///@{
  /// How the point and cell arrays of a name are carried (see AttributeTransformations), whatever
  /// the other settings say. Arrays that do not have 3, 6 or 9 components pass as they are.
  void SetAttributeTransformation(const char* name, int transformation);
  /// The transformation set for a name, -1 if none is.
  int GetAttributeTransformation(const char* name);
  void ClearAttributeTransformations();
  ///@}

  ///@{
  /// Whether outside points and the cells that use them are blanked in the output. On by default.
  vtkSetMacro(BlankOutside, bool);
  vtkGetMacro(BlankOutside, bool);
  vtkBooleanMacro(BlankOutside, bool);
  ///@}

  ///@{
  /// Whether output port 1 tells where the map is differentiable. Off by default: it takes about as
  /// long as mapping 500 points for each edge.
  vtkSetMacro(MeasureContinuity, bool);
  vtkGetMacro(MeasureContinuity, bool);
  vtkBooleanMacro(MeasureContinuity, bool);
  ///@}

  /// The filter that measures, for its settings (SamplesPerEdge, Resolution, the kinds of places)
  /// and, after an update, its counts. Its meshes and coordinate system are set by this filter.
  vtkJacobianContinuity* GetJacobianContinuity();

  ///@{
  /// Precision of the output's points, vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION, or
  /// DEFAULT_PRECISION (default): that of the data's points, double for images.
  vtkSetMacro(OutputPointsPrecision, int);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  /// Number of points of the data, or of the piece of it that was asked for, that the last
  /// execution found outside, without those that vtkGhostType says are another piece's; -1 if the
  /// meshes or the data were refused, in which case GetErrorCode() is not 0 either. See
  /// ReduceStatistics.
  vtkGetMacro(NumberOfOutsidePoints, vtkIdType);

  /// Number of triangles that are discordant in P or Q and are carried by the Linear system.
  vtkGetMacro(NumberOfDiscordantTriangles, vtkIdType);

  /// Makes the numbers that this filter counts (NumberOfOutsidePoints,
  /// NumberOfDiscordantTriangles, and those of GetJacobianContinuity) the same in all processes
  /// that have pieces of the data: counts of points become sums, -1 if one of the processes has -1,
  /// numbers of triangles the largest. Each process of @a controller (null: the global controller;
  /// if there is none, nothing happens) must call this after its update, also one that had nothing
  /// to update or had an error: executing the filter never waits for other processes, this does.
  /// They are one process's own again after the next execution. In ParaView the plugin does it.
  void ReduceStatistics(vtkMultiProcessController* controller);

  /// How often the meshes have been read and validated since this filter was made.
  vtkIdType GetNumberOfMeshBuilds();

  /// Includes that of the filter that measures.
  vtkMTimeType GetMTime() override;

protected:
  vtkDifferentiableHomeomorphism();
  ~vtkDifferentiableHomeomorphism() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestInformation(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  int CoordinateSystem = SMOOTH;
  bool Inverse = false;
  int CenterPoint = CENTROID;
  int DiscordantTriangles = REFUSE;
  bool MaskInvalidTriangles = false;
  double Tolerance = 0.0;
  bool ComputeTriangleId = false;
  bool ComputeJacobian = false;
  bool ComputeJacobianDeterminant = false;
  bool TransformActiveAttributes = true;
  bool TransformAllInputVectors = false;
  bool BlankOutside = true;
  bool MeasureContinuity = false;
  int OutputPointsPrecision = DEFAULT_PRECISION;
  vtkIdType NumberOfOutsidePoints = 0;
  vtkIdType NumberOfDiscordantTriangles = 0;

private:
  vtkDifferentiableHomeomorphism(const vtkDifferentiableHomeomorphism&) = delete;
  void operator=(const vtkDifferentiableHomeomorphism&) = delete;

  int MapData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs);

  class Internals;
  class Mapping;
  std::unique_ptr<Internals> Internal;
};

#endif
