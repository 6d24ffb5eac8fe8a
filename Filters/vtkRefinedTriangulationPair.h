// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkRefinedTriangulationPair
 * @brief   a finer pair whose piecewise linear map approximates a homeomorphism
 *
 * vtkRefinedTriangulationPair subdivides the triangles of a pair, the source (input port 0) and the
 * target (input port 1), until the piecewise linear map of the finer pair differs from the
 * homeomorphism of the original pair in the chosen CoordinateSystem by at most MaximumError.
 * Software that supports only piecewise linear maps, such as PROJ (tinshift), can then use the
 * homeomorphism with a known accuracy.
 *
 * Output port 0 is the finer source, port 1 the finer target. Both have the same triangles. The
 * first points are those of the inputs, unchanged and with their ids. In the source, added points
 * bisect edges; in the target, they are the images of those points. Points on the boundary stay on
 * its edges, up to the rounding of coordinates, and exactly on edges parallel to an axis. The finer
 * meshes are conforming: no vertex lies in the interior of an edge of another triangle. The finer
 * pair is validated like any pair.
 *
 * Point data of each mesh is interpolated at added points with their barycentric coordinates in the
 * original triangle. PROJ interpolates heights in the same way, so refinement does not change
 * heights. Cell data is copied from the original triangle. The cell array `OriginalCellIds`
 * (vtkIdType) has the cell id of the original triangle. Cells that are not triangles, and arrays
 * that do not have one tuple for each point or cell, are dropped.
 *
 * The error is measured at 595 points of each triangle, including its edges; it is not bounded
 * between these points. Triangles are measured in parallel (vtkSMPTools); results do not depend on
 * the number of threads. See vtkHomeomorphismAlgorithm for the meshes and the options of the
 * homeomorphism. Masked triangles are not part of the finer pair.
 *
 * If MaximumError cannot be reached, the outputs are empty, and an error is reported; see Results.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkTriangulationPairReport
 */

#ifndef vtkRefinedTriangulationPair_h
#define vtkRefinedTriangulationPair_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkHomeomorphismAlgorithm.h"

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkRefinedTriangulationPair : public vtkHomeomorphismAlgorithm
{
public:
  static vtkRefinedTriangulationPair* New();
  vtkTypeMacro(vtkRefinedTriangulationPair, vtkHomeomorphismAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The result of the last update.
  enum Results
  {
    REFINED = 0,            ///< the error is within MaximumError
    TOO_MANY_TRIANGLES = 1, ///< MaximumError requires more than MaximumNumberOfTriangles
    BELOW_ROUNDING = 2,     ///< MaximumError is below the rounding of the coordinates
    INVALID = 3,            ///< the meshes were refused, or the finer pair is invalid by rounding
    ABORTED = 4             ///< the update was aborted
  };

  ///@{
  /// The finer source and the finer target (output ports 0 and 1).
  vtkPolyData* GetOutput() { return this->GetOutput(0); }
  vtkPolyData* GetOutput(int port);
  vtkPolyData* GetTargetOutput() { return this->GetOutput(1); }
  ///@}

  ///@{
  /// The largest distance allowed between the image of a point by the finer pair's piecewise linear
  /// map and by the homeomorphism, in the target's units. 0 (default) stands for 1e-4 times the
  /// diagonal of the target's bounding box.
  vtkSetClampMacro(MaximumError, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumError, double);
  ///@}

  ///@{
  /// The largest allowed number of triangles. 2,000,000 by default, at least 1.
  vtkSetClampMacro(MaximumNumberOfTriangles, vtkIdType, 1, VTK_ID_MAX);
  vtkGetMacro(MaximumNumberOfTriangles, vtkIdType);
  ///@}

  /// See Results.
  vtkGetMacro(Result, int);

  /// The largest measured error, in the target's units. If the refinement failed, this is the
  /// largest error when it stopped, infinite if triangles were flipped.
  vtkGetMacro(LargestError, double);

  /// The number of points at which the final error was measured.
  vtkGetMacro(NumberOfSamples, vtkIdType);

protected:
  vtkRefinedTriangulationPair();
  ~vtkRefinedTriangulationPair() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int Execute(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  double MaximumError = 0.0;
  vtkIdType MaximumNumberOfTriangles = 2000000;
  int Result = REFINED;
  double LargestError = 0.0;
  vtkIdType NumberOfSamples = 0;

private:
  vtkRefinedTriangulationPair(const vtkRefinedTriangulationPair&) = delete;
  void operator=(const vtkRefinedTriangulationPair&) = delete;
};

#endif
