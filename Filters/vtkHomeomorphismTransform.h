// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkHomeomorphismTransform
 * @brief   the homeomorphism between two planar triangulations as a VTK transform
 *
 * This transform is the map of vtkDifferentiableHomeomorphism for classes that use a transform,
 * such as vtkTransformFilter, vtkGeneralTransform or vtkImageReslice. vtkImageReslice needs the map
 * from the output to the input: use GetInverse(), or, except in the CUBIC system, exchange source
 * and target. The options are described in vtkHomeomorphismOptions.h. Inverse and derivative are
 * accurate to a few rounding errors; InverseTolerance and InverseIterations have no effect.
 *
 * Both meshes must be planar, in any planes. The distance of a point from the plane of the source
 * becomes the distance of its image from the plane of the target.
 *
 * A point outside the domain is mapped to a point far outside both meshes. Its three coordinates
 * are GetOutsideCoordinate(): 1e30 or, if that is larger, a thousand times the largest coordinate
 * of the meshes. vtkImageReslice then uses its background color (except in its Wrap and Mirror
 * modes). The derivative is NaN. If a mesh is missing or refused, an error is reported, and all
 * points are treated as outside.
 *
 * After an update, any number of threads may use the transform at the same time. Methods for arrays
 * use vtkSMPTools. Copies and inverses of an updated transform share the map. Different transforms
 * may use the same meshes in different threads.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkTriangularCoordinates
 */

#ifndef vtkHomeomorphismTransform_h
#define vtkHomeomorphismTransform_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkHomeomorphismOptions.h"       // for the options
#include "vtkWarpTransform.h"

#include <memory> // for the internals

class vtkPolyData;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkHomeomorphismTransform : public vtkWarpTransform
{
public:
  static vtkHomeomorphismTransform* New();
  vtkTypeMacro(vtkHomeomorphismTransform, vtkWarpTransform);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkHomeomorphismOptionsMacro();

  ///@{
  /// The source and target meshes, two vtkPolyData with the same triangles (see
  /// vtkHomeomorphismAlgorithm). They are kept by reference; modifications take effect at the next
  /// update.
  virtual void SetSource(vtkPolyData* source);
  vtkGetObjectMacro(Source, vtkPolyData);
  virtual void SetTarget(vtkPolyData* target);
  vtkGetObjectMacro(Target, vtkPolyData);
  ///@}

  ///@{
  /// IsInside: whether a point is in the domain of the map (the target's if the transform is
  /// inverted). GetOutsideCoordinate: the value of all three coordinates of the image of a point
  /// that is not. Both methods update the transform.
  bool IsInside(const double point[3]);
  double GetOutsideCoordinate();
  ///@}

  void TransformPoints(vtkPoints* inPts, vtkPoints* outPts) override;
  void TransformPointsNormalsVectors(vtkPoints* inPts, vtkPoints* outPts, vtkDataArray* inNms,
    vtkDataArray* outNms, vtkDataArray* inVrs, vtkDataArray* outVrs, int nOptionalVectors = 0,
    vtkDataArray** inVrsArr = nullptr, vtkDataArray** outVrsArr = nullptr) override;
  vtkAbstractTransform* MakeTransform() override;
  vtkMTimeType GetMTime() override;

protected:
  vtkHomeomorphismTransform();
  ~vtkHomeomorphismTransform() override;

  void InternalUpdate() override;
  void InternalDeepCopy(vtkAbstractTransform* transform) override;

  void ForwardTransformPoint(const float in[3], float out[3]) override;
  void ForwardTransformPoint(const double in[3], double out[3]) override;
  void ForwardTransformDerivative(const float in[3], float out[3], float derivative[3][3]) override;
  void ForwardTransformDerivative(
    const double in[3], double out[3], double derivative[3][3]) override;
  void InverseTransformPoint(const float in[3], float out[3]) override;
  void InverseTransformPoint(const double in[3], double out[3]) override;
  void InverseTransformDerivative(const float in[3], float out[3], float derivative[3][3]) override;
  void InverseTransformDerivative(
    const double in[3], double out[3], double derivative[3][3]) override;

  vtkPolyData* Source = nullptr;
  vtkPolyData* Target = nullptr;

private:
  vtkHomeomorphismTransform(const vtkHomeomorphismTransform&) = delete;
  void operator=(const vtkHomeomorphismTransform&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
