// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkResampleThroughHomeomorphism
 * @brief   see data of one triangulated domain on a grid over the other
 *
 * vtkDifferentiableHomeomorphism moves the points of data. vtkResampleThroughHomeomorphism leaves a
 * grid where it is and asks, for each of its points, where in the source's domain it comes from,
 * and what the data has there: the way to warp an image, or to bring any data set onto a regular
 * grid of the other domain. Points are pulled back by the map's exact inverse, and no data is
 * interpolated twice.
 *
 * The meshes are the source (input port 0) and the target (port 1), as in
 * vtkDifferentiableHomeomorphism; the data (port 2, a vtkDataSet or a composite of them; the source
 * mesh itself if there is none) lies over the source's domain. The grid (port 3, any vtkDataSet)
 * lies over the target's domain; if there is none, it is a vtkImageData of SamplingDimensions over
 * the target's bounds (or SamplingBounds) in the target's plane, which must then be parallel to the
 * xy plane.
 *
 * The output is the grid with the data's arrays as point data (cell data as the value of the cell
 * that the point falls into), and with the point array `vtkValidPointMask` (unsigned char): 1 where
 * there are values, 0 outside the target's domain and where the data has none. There,
 * floating-point arrays are NaN, others 0, and points and the cells that use them are blanked
 * (vtkGhostType); see BlankOutside. The grid's own arrays are not passed, except vtkGhostType.
 *
 * Values of an image are interpolated linearly in each direction, others as VTK's cells do. An
 * image without active vectors, normals or tensors is resampled many times faster than other data.
 *
 * Active vectors, normals and tensors are carried by the Jacobian, as
 * vtkDifferentiableHomeomorphism does; see TransformActiveAttributes.
 *
 * The meshes and the data are asked for whole, the grid in the pieces that the output is asked for
 * in; a grid that is made upstream from what one of the others is made from is whole in piece 0.
 * Points are processed in parallel (vtkSMPTools); results do not depend on the number of threads or
 * pieces.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkHomeomorphismTransform
 */

#ifndef vtkResampleThroughHomeomorphism_h
#define vtkResampleThroughHomeomorphism_h

#include "vtkDataSetAlgorithm.h"
#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkNew.h"                        // for the filter that maps

#include <memory> // for its internals

class vtkDifferentiableHomeomorphism;
class vtkImageData;
class vtkMultiProcessController;
class vtkPolyData;
class vtkUnsignedCharArray;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkResampleThroughHomeomorphism : public vtkDataSetAlgorithm
{
public:
  static vtkResampleThroughHomeomorphism* New();
  vtkTypeMacro(vtkResampleThroughHomeomorphism, vtkDataSetAlgorithm);
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
  /// The meshes, the data and the grid: input ports 0 to 3. The last two are optional.
  void SetSourceConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(0, output); }
  void SetSourceData(vtkPolyData* source);
  void SetTargetConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetTargetData(vtkPolyData* target);
  void SetDataConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(2, output); }
  void SetDataObject(vtkDataObject* data) { this->SetInputData(2, data); }
  void SetGridConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(3, output); }
  void SetGridData(vtkDataSet* grid);
  ///@}

  ///@{
  /// The coordinate system: LINEAR, CONTOUR or SMOOTH (default), and how Contour is to be
  /// understood. See vtkDifferentiableHomeomorphism.
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
  /// Whether the data lies over the target's domain and the grid over the source's instead. Off by
  /// default.
  vtkSetMacro(Inverse, bool);
  vtkGetMacro(Inverse, bool);
  vtkBooleanMacro(Inverse, bool);
  ///@}

  ///@{
  /// Number of points in x and y of the image that is made if there is no grid, at least 1. 256 x
  /// 256 by default.
  vtkSetVector2Macro(SamplingDimensions, int);
  vtkGetVector2Macro(SamplingDimensions, int);
  ///@}

  ///@{
  /// The rectangle (xmin, xmax, ymin, ymax) that the image covers from its first to its last
  /// points. By default (xmin > xmax) the bounds of the mesh that it lies over.
  vtkSetVector4Macro(SamplingBounds, double);
  vtkGetVector4Macro(SamplingBounds, double);
  ///@}

  ///@{
  /// How far outside the domain a point may be; see vtkDifferentiableHomeomorphism.
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// Whether active vectors, normals and tensors are carried by the Jacobian (default on) or keep
  /// their components.
  vtkSetMacro(TransformActiveAttributes, bool);
  vtkGetMacro(TransformActiveAttributes, bool);
  vtkBooleanMacro(TransformActiveAttributes, bool);
  ///@}

  ///@{
  /// Whether points without values, and the cells that use them, are blanked. On by default.
  vtkSetMacro(BlankOutside, bool);
  vtkGetMacro(BlankOutside, bool);
  vtkBooleanMacro(BlankOutside, bool);
  ///@}

  /// Number of points of the grid, or of the piece of it that was asked for, that the last
  /// execution found without values, those excepted that vtkGhostType says are another piece's; -1
  /// if the meshes or the data were refused, in which case GetErrorCode() is not 0 either. See
  /// ReduceStatistics.
  vtkGetMacro(NumberOfOutsidePoints, vtkIdType);

  /// Makes the numbers that this filter counts (NumberOfOutsidePoints) the same in all processes
  /// that have pieces of the data: the sum, -1 if one of the processes has -1. Each process of @a
  /// controller (null: the global controller; if there is none, nothing happens) must call this
  /// after its update, also one that had nothing to update or had an error: executing the filter
  /// never waits for other processes, this does. They are one process's own again after the next
  /// execution. In ParaView the plugin does it.
  void ReduceStatistics(vtkMultiProcessController* controller);

  /// How often the meshes have been read and validated since this filter was made.
  vtkIdType GetNumberOfMeshBuilds();

protected:
  vtkResampleThroughHomeomorphism();
  ~vtkResampleThroughHomeomorphism() override;

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
  int CenterPoint = CENTROID;
  int DiscordantTriangles = REFUSE;
  bool MaskInvalidTriangles = false;
  bool Inverse = false;
  int SamplingDimensions[2] = { 256, 256 };
  double SamplingBounds[4] = { 1.0, -1.0, 1.0, -1.0 };
  double Tolerance = 0.0;
  bool TransformActiveAttributes = true;
  bool BlankOutside = true;
  vtkIdType NumberOfOutsidePoints = 0;

private:
  class Internals;

  int ResampleImage(vtkPolyData* source, vtkPolyData* target, vtkImageData* image, vtkDataSet* grid,
    vtkDataSet* output);
  void Mark(vtkDataSet* grid, vtkUnsignedCharArray* mask, vtkDataSet* output);

  vtkResampleThroughHomeomorphism(const vtkResampleThroughHomeomorphism&) = delete;
  void operator=(const vtkResampleThroughHomeomorphism&) = delete;

  int Resample(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs);

  /// Lets the filter that maps map the data in a direction. Returns null, and reports, if it is
  /// refused.
  vtkDataSet* Map(vtkDataSet* data, bool inverse, bool carryVectors);

  vtkNew<vtkDifferentiableHomeomorphism> Mapping;
  std::unique_ptr<Internals> Internal;
  /// In this process alone.
  vtkIdType OwnOutsidePoints = 0;
};

#endif
