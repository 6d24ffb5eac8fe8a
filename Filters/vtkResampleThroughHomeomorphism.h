// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkResampleThroughHomeomorphism
 * @brief   see data of one triangulated domain on a grid over the other
 *
 * vtkDifferentiableHomeomorphism moves the points of data. This filter keeps a grid in place and
 * finds for each of its points the preimage in the source's domain, by the exact inverse of the
 * map, and the data's values there. It warps images and resamples any data set on regular grids.
 *
 * The data (input port 2, a vtkDataSet or a composite of them; the source mesh if there is none)
 * lies over the source's domain and is requested whole. The grid (port 3, any vtkDataSet) lies over
 * the target's domain. Without a grid, it is a vtkImageData of SamplingDimensions over the bounds
 * of the target (or SamplingBounds), which must be parallel to the xy plane.
 *
 * The output is the grid with the data's arrays as point data (cell data as the value of the cell
 * in which the preimage lies), and with the point array `vtkValidPointMask` (unsigned char): 1
 * where there are values, 0 outside the target's domain and where the data has none. There,
 * floating-point arrays are NaN, others 0, and NumberOfOutsidePoints counts the points. Of the
 * grid's own arrays, only vtkGhostType is passed.
 *
 * Values of an image are interpolated linearly in each direction, others as VTK's cells do. An
 * image without active vectors, normals or tensors is resampled many times faster than other data.
 *
 * @sa vtkHomeomorphismAlgorithm, vtkDifferentiableHomeomorphism
 */

#ifndef vtkResampleThroughHomeomorphism_h
#define vtkResampleThroughHomeomorphism_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkHomeomorphismAlgorithm.h"

class vtkDataSet;
class vtkImageData;
class vtkUnsignedCharArray;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkResampleThroughHomeomorphism
  : public vtkHomeomorphismAlgorithm
{
public:
  static vtkResampleThroughHomeomorphism* New();
  vtkTypeMacro(vtkResampleThroughHomeomorphism, vtkHomeomorphismAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkHomeomorphismMappingMacro();

  ///@{
  /// The grid, input port 3, which is optional, and the grid with the values, output port 0.
  void SetGridConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(3, output); }
  void SetGridData(vtkDataSet* grid);
  vtkDataSet* GetOutput();
  ///@}

  ///@{
  /// The image that is made if there is no grid: the numbers of points in x and y, at least 1 (256
  /// x 256 by default), and the rectangle (xmin, xmax, ymin, ymax) from its first to its last
  /// points. By default (xmin > xmax), it has the bounds of the mesh.
  vtkSetVector2Macro(SamplingDimensions, int);
  vtkGetVector2Macro(SamplingDimensions, int);
  vtkSetVector4Macro(SamplingBounds, double);
  vtkGetVector4Macro(SamplingBounds, double);
  ///@}

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
  int Execute(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  int SamplingDimensions[2] = { 256, 256 };
  double SamplingBounds[4] = { 1.0, -1.0, 1.0, -1.0 };

private:
  vtkResampleThroughHomeomorphism(const vtkResampleThroughHomeomorphism&) = delete;
  void operator=(const vtkResampleThroughHomeomorphism&) = delete;

  /// Makes the image if there is no grid.
  bool MakeImage(vtkPolyData* mesh, const int extent[6], vtkImageData* image);
  void SampleImage(const homeomorphism::Homeomorphism& map, vtkImageData* image, vtkDataSet* grid,
    vtkDataSet* output, vtkUnsignedCharArray* mask);
  bool Probe(const homeomorphism::Homeomorphism& map, vtkPolyData* mesh, vtkDataObject* data,
    vtkDataSet* output, vtkUnsignedCharArray* mask);
};

#endif
