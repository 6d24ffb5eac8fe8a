// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkRefinedTriangulationPair
 * @brief   a finer pair whose piecewise linear map approximates a homeomorphism
 *
 * vtkRefinedTriangulationPair takes a pair of triangulations, the source (input port 0) and the
 * target (input port 1), and subdivides their triangles until the piecewise linear map of the finer
 * pair differs from the homeomorphism of the pair in the given coordinate system by at most
 * MaximumError. Software that supports only piecewise linear maps, such as PROJ (tinshift), can
 * then use the homeomorphism with a known accuracy.
 *
 * Output port 0 is the finer source, port 1 the finer target. Both have the same triangles. The
 * first points are those of the inputs, unchanged and with their ids. Added points bisect edges of
 * the source. In the target they are the images of those points or, on the boundary, which every
 * system maps linearly, the midpoints of edges. The finer meshes are conforming: no vertex lies
 * inside an edge of another triangle. The finer pair is validated like any pair.
 *
 * Point data of each mesh is interpolated at added points with their barycentric coordinates in the
 * original triangle. PROJ interpolates heights in the same way, so heights of the finer pair are
 * the same functions of the point. Cell data is that of the original triangle. The cell array
 * `OriginalCellIds` (vtkIdType) has the cell id of the original triangle. Cells that are not
 * triangles are dropped.
 *
 * The error is measured at 595 points of each triangle, including its edges; it is not bounded in
 * between. Triangles are measured in parallel (vtkSMPTools); results do not depend on the number of
 * threads. The meshes are requested whole; the outputs are part of piece 0.
 *
 * If MaximumError cannot be reached, the outputs are empty and an error is reported; see Results.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkTriangulationPairReport
 */

#ifndef vtkRefinedTriangulationPair_h
#define vtkRefinedTriangulationPair_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

#include <memory> // for the internals

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkRefinedTriangulationPair : public vtkPolyDataAlgorithm
{
public:
  static vtkRefinedTriangulationPair* New();
  vtkTypeMacro(vtkRefinedTriangulationPair, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The result of the last update.
  enum Results
  {
    REFINED = 0,            ///< the error is within MaximumError
    TOO_MANY_TRIANGLES = 1, ///< MaximumError needs more than MaximumNumberOfTriangles
    BELOW_ROUNDING = 2,     ///< MaximumError needs edges shorter than the rounding of coordinates
    INVALID = 3,            ///< the meshes were refused, or rounding makes the finer pair invalid
    ABORTED = 4             ///< the update was aborted
  };

  /// The coordinate systems; see vtkDifferentiableHomeomorphism.
  enum CoordinateSystems
  {
    LINEAR = 0,
    CONTOUR = 1,
    SMOOTH = 2
  };

  /// The start of the contours of the Contour system.
  enum CenterPoints
  {
    CENTROID = 0,
    INCENTER = 1
  };

  /// The treatment of discordant triangles in the Contour system.
  enum DiscordantTrianglesModes
  {
    REFUSE = 0,
    USE_LINEAR = 1
  };

  ///@{
  /// The source mesh, input port 0.
  void SetSourceConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(0, output); }
  void SetSourceData(vtkPolyData* source);
  ///@}

  ///@{
  /// The target mesh, input port 1.
  void SetTargetConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetTargetData(vtkPolyData* target);
  ///@}

  ///@{
  /// The finer target, output port 1. The finer source is GetOutput().
  vtkPolyData* GetTargetOutput() { return this->GetOutput(1); }
  ///@}

  ///@{
  /// The options of the homeomorphism: LINEAR, CONTOUR or SMOOTH (default), and others. See
  /// vtkDifferentiableHomeomorphism. Masked triangles are not part of the finer pair.
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
  /// The greatest distance between the images of a point under the piecewise linear map of the
  /// finer pair and under the homeomorphism, in units of the target. 0 (default) stands for 1e-4
  /// times the diagonal of the target's bounding box.
  vtkSetClampMacro(MaximumError, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumError, double);
  ///@}

  ///@{
  /// The greatest number of triangles. 2,000,000 by default, at least 1.
  vtkSetClampMacro(MaximumNumberOfTriangles, vtkIdType, 1, VTK_ID_MAX);
  vtkGetMacro(MaximumNumberOfTriangles, vtkIdType);
  ///@}

  /// See Results.
  vtkGetMacro(Result, int);

  /// The largest measured error, in units of the target. If the refinement failed, the largest
  /// error when it stopped, infinite if triangles are flipped.
  vtkGetMacro(LargestError, double);

  /// The number of points at which the final error was measured.
  vtkGetMacro(NumberOfSamples, vtkIdType);

protected:
  vtkRefinedTriangulationPair();
  ~vtkRefinedTriangulationPair() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  int CoordinateSystem = SMOOTH;
  int CenterPoint = CENTROID;
  int DiscordantTriangles = REFUSE;
  bool MaskInvalidTriangles = false;
  double MaximumError = 0.0;
  vtkIdType MaximumNumberOfTriangles = 2000000;
  int Result = REFINED;
  double LargestError = 0.0;
  vtkIdType NumberOfSamples = 0;

private:
  vtkRefinedTriangulationPair(const vtkRefinedTriangulationPair&) = delete;
  void operator=(const vtkRefinedTriangulationPair&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
