// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkHomeomorphismTransform
 * @brief   the homeomorphism between two planar triangulations as a VTK transform
 *
 * A vtkWarpTransform that carries the domain of one triangulation onto that of another with the
 * same triangles, one to one; see vtkDifferentiableHomeomorphism for the map and its coordinate
 * systems. It goes wherever VTK takes a transform: vtkTransformFilter, vtkTransformPolyDataFilter,
 * vtkGeneralTransform, and vtkImageReslice, which wants the map from the output's grid to the
 * input, that is, GetInverse() (or source and target exchanged).
 *
 * Forward, inverse and derivative are in closed form or solved to the last few bits; the tolerance
 * and the number of iterations of vtkWarpTransform play no part.
 *
 * Both meshes must be planar, in any plane. A point's distance from the source's plane is kept as
 * its distance from the target's, in the direction of the planes' normals (the source's is the one
 * that points along the axis it is closest to, the target's is less than a right angle from it), so
 * a map of the xy plane leaves z alone, and the derivative takes normal to normal.
 *
 * A transform has no way to mark a point as outside. Points outside the domain go to a place that
 * is in no image or mesh: all three coordinates are GetOutsideCoordinate(), 1e30 or, if that is
 * more, a thousand times the meshes' largest coordinate. vtkImageReslice then gives such pixels its
 * background color (do not combine with its Wrap or Mirror modes). Derivatives there are NaN.
 * IsInside tells, too. Before both meshes are set, and if they are refused (an error says why),
 * every point is outside.
 *
 * Once updated, the transform may be used by any number of threads; TransformPoints and
 * TransformPointsNormalsVectors use vtkSMPTools themselves, with the same result for any number of
 * threads. Copies and inverses of an updated transform share what it has computed from the meshes.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkTriangularCoordinates
 */

#ifndef vtkHomeomorphismTransform_h
#define vtkHomeomorphismTransform_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkWarpTransform.h"

#include <memory> // for the internals

class vtkPolyData;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkHomeomorphismTransform : public vtkWarpTransform
{
public:
  static vtkHomeomorphismTransform* New();
  vtkTypeMacro(vtkHomeomorphismTransform, vtkWarpTransform);
  void PrintSelf(ostream& os, vtkIndent indent) override;

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
  /// The mesh that the transform maps from, and the one it maps to. Both are kept by reference: the
  /// transform follows their modifications at its next update.
  virtual void SetSource(vtkPolyData* source);
  vtkGetObjectMacro(Source, vtkPolyData);
  virtual void SetTarget(vtkPolyData* target);
  vtkGetObjectMacro(Target, vtkPolyData);
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
  /// The point where the contours of the Contour system start: CENTROID (default) or INCENTER.
  vtkSetClampMacro(CenterPoint, int, CENTROID, INCENTER);
  vtkGetMacro(CenterPoint, int);
  ///@}

  ///@{
  /// In the Contour system, whether discordant triangles are an error (REFUSE, default) or are
  /// carried by the Linear system (USE_LINEAR).
  vtkSetClampMacro(DiscordantTriangles, int, REFUSE, USE_LINEAR);
  vtkGetMacro(DiscordantTriangles, int);
  ///@}

  ///@{
  /// Whether invalid triangles are left out instead of refusing the meshes. Off by default.
  vtkSetMacro(MaskInvalidTriangles, bool);
  vtkGetMacro(MaskInvalidTriangles, bool);
  vtkBooleanMacro(MaskInvalidTriangles, bool);
  ///@}

  ///@{
  /// How far outside the domain a point may be and still be taken to the nearest point of it, as a
  /// proportion of the diagonal of the domain's bounding box. 0 (default) allows only for rounding.
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}

  /// Whether a point is in the domain that the transform maps from (the target's if it is
  /// inverted). Updates the transform.
  bool IsInside(const double point[3]);

  /// The value of all three coordinates of a point outside. Updates the transform.
  double GetOutsideCoordinate();

  ///@{
  /// Whole arrays at a time, in parallel.
  void TransformPoints(vtkPoints* inPts, vtkPoints* outPts) override;
  void TransformPointsNormalsVectors(vtkPoints* inPts, vtkPoints* outPts, vtkDataArray* inNms,
    vtkDataArray* outNms, vtkDataArray* inVrs, vtkDataArray* outVrs, int nOptionalVectors = 0,
    vtkDataArray** inVrsArr = nullptr, vtkDataArray** outVrsArr = nullptr) override;
  ///@}

  vtkAbstractTransform* MakeTransform() override;

  /// Includes the modification of the meshes.
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
  int CoordinateSystem = SMOOTH;
  int CenterPoint = CENTROID;
  int DiscordantTriangles = REFUSE;
  bool MaskInvalidTriangles = false;
  double Tolerance = 0.0;

private:
  vtkHomeomorphismTransform(const vtkHomeomorphismTransform&) = delete;
  void operator=(const vtkHomeomorphismTransform&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
