// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDifferentiableHomeomorphism
 * @brief   map data from one triangulated domain to another with the same triangles
 *
 * The filter maps the points of the data (input port 2) from the domain of the source P to the
 * domain of the target Q, or, with Inverse, from Q to P. If there is no data, the mesh P (with
 * Inverse, Q) is the data. Except in the CUBIC system, the image is the point of the corresponding
 * triangle with the same triangular coordinates, and the inverse is the map with P and Q exchanged.
 * See Documentation/differentiability.md and Documentation/cubic.md.
 *
 * Images and rectilinear grids become structured grids. Other data sets keep their type, and trees
 * of data sets keep their structure. All arrays are passed. Active vectors, normals and tensors of
 * points and cells are transformed by the Jacobian J of the map at the point, or at the mean of the
 * cell's points, as follows (NaN outside the domain):
 *
 * - vectors as tangent vectors, v becomes J v;
 * - normals by the inverse transpose, n becomes J^-T n, normalized;
 * - tensors of 9 components (row-major) or 6 (XX, YY, ZZ, XY, YZ, XZ), T becomes J T J^T;
 * - arrays with GRADIENT_TRANSFORMATION as gradients, g becomes J^-T g and T becomes J^-T T J^-1.
 *
 * Point arrays are added to output port 0, replacing arrays of the same name:
 *
 * - `vtkValidPointMask` (unsigned char): 1 inside the domain, 0 outside;
 * - `UsedCoordinateSystem` (int): LINEAR or CONTOUR, -1 outside; only if the LINEAR system maps
 *   discordant triangles (USE_LINEAR);
 * - `TriangleId` (vtkIdType): cell id in P, -1 outside; with ComputeTriangleId;
 * - `Jacobian` (double, 9 components, row-major): NaN outside; on an edge, the limit from the
 *   triangle `TriangleId`; with ComputeJacobian;
 * - `JacobianDeterminant` (double): the ratio of areas, NaN outside; negative where a planar map
 *   reverses orientation with respect to the planes' normals; with ComputeJacobianDeterminant.
 *
 * In the CUBIC system, if there is no data, the mapped mesh also has the cell array `Certificate`
 * (double) and the point array `ExceptionalVertex` (unsigned char: 1 where the map has no
 * derivative, otherwise 0). `Certificate` is a lower bound of the determinant of J in the triangle,
 * divided by the determinant of the piecewise linear map; if it is positive, the map is certified
 * to be one to one in the triangle.
 *
 * With MeasureContinuity, output port 1 is that of vtkJacobianContinuity; otherwise it is empty.
 *
 * Points outside keep their coordinates and are blanked (see BlankOutside). Points that are blanked
 * in the input are treated as outside, so that an inverse map does not treat them as images.
 *
 * If both meshes are planar, a point off the plane of the mesh that is mapped from is mapped like
 * its projection onto the plane, and keeps its distance from the plane. The normal of P points
 * along the axis to which it is closest; the normal of Q forms an acute angle with it. J maps one
 * unit normal to the other.
 *
 * @sa vtkHomeomorphismAlgorithm, vtkHomeomorphismTransform, vtkJacobianContinuity
 */

#ifndef vtkDifferentiableHomeomorphism_h
#define vtkDifferentiableHomeomorphism_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkHomeomorphismAlgorithm.h"

#include <memory> // for the internals

class vtkJacobianContinuity;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkDifferentiableHomeomorphism
  : public vtkHomeomorphismAlgorithm
{
public:
  static vtkDifferentiableHomeomorphism* New();
  vtkTypeMacro(vtkDifferentiableHomeomorphism, vtkHomeomorphismAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkHomeomorphismMappingMacro();

  /// How an array is transformed.
  enum AttributeTransformations
  {
    NO_TRANSFORMATION = 0,       ///< passed unchanged
    TANGENT_TRANSFORMATION = 1,  ///< J v, J T J^T
    GRADIENT_TRANSFORMATION = 2, ///< J^-T g, J^-T T J^-1
    NORMAL_TRANSFORMATION = 3    ///< J^-T n, normalized (3 components only)
  };

  ///@{
  /// Whether the point arrays of these names are added to output port 0. Off by default.
  vtkHomeomorphismSwitchMacro(ComputeTriangleId, false);
  vtkHomeomorphismSwitchMacro(ComputeJacobian, false);
  vtkHomeomorphismSwitchMacro(ComputeJacobianDeterminant, false);
  ///@}

  ///@{
  /// These options supplement TransformActiveAttributes. TransformAllInputVectors (off by default)
  /// transforms all other floating-point arrays of 3, 6 and 9 components as tangent vectors and
  /// tensors, except texture coordinates, active scalars and arrays named `Jacobian`.
  /// SetAttributeTransformation sets the transformation of the point and cell arrays of a name (see
  /// AttributeTransformations) and overrides the other options; a null name or another value is an
  /// error and has no effect. Arrays that do not have 3, 6 or 9 components are passed unchanged.
  /// GetAttributeTransformation returns -1 for a name that was not set.
  vtkHomeomorphismSwitchMacro(TransformAllInputVectors, false);
  void SetAttributeTransformation(const char* name, int transformation);
  int GetAttributeTransformation(const char* name);
  void ClearAttributeTransformations();
  ///@}

  ///@{
  /// Whether the continuity of the Jacobian is measured (output port 1). Off by default. The
  /// measurement takes about as long as mapping 500 points for each edge. GetJacobianContinuity()
  /// returns a filter that has the settings (SamplesPerEdge, Resolution, features) and, after an
  /// update, the statistics. Its meshes and map options are not used.
  vtkHomeomorphismSwitchMacro(MeasureContinuity, false);
  vtkJacobianContinuity* GetJacobianContinuity();
  ///@}

  ///@{
  /// Precision of the output's points: vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION, or
  /// DEFAULT_PRECISION (default), which is that of the data's points, and double for images.
  vtkSetMacro(OutputPointsPrecision, int);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  void ReduceStatistics(vtkMultiProcessController* controller) override;
  vtkMTimeType GetMTime() override;

protected:
  vtkDifferentiableHomeomorphism();
  ~vtkDifferentiableHomeomorphism() override;

  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int Execute(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  int OutputPointsPrecision = DEFAULT_PRECISION;

private:
  vtkDifferentiableHomeomorphism(const vtkDifferentiableHomeomorphism&) = delete;
  void operator=(const vtkDifferentiableHomeomorphism&) = delete;

  class Internals;
  class Mapping;
  std::unique_ptr<Internals> Internal;
};

#endif
