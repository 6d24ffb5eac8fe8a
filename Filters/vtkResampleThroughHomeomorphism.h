// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkResampleThroughHomeomorphism
 * @brief   resample data over one triangulated domain on a grid over the other
 *
 * vtkDifferentiableHomeomorphism moves the points of data. This filter does not move the points of
 * a grid: it computes the preimage of each grid point in the source's domain by the inverse of the
 * map, and interpolates the data there. It warps images and resamples data sets on regular grids.
 *
 * The data (input port 2, a vtkDataSet or vtkDataObjectTree; the source mesh if there is none) lies
 * over the source's domain and is requested as a whole. The grid (port 3, any vtkDataSet) lies over
 * the target's domain. The default grid is a vtkImageData of SamplingDimensions over the bounds of
 * the target (or SamplingBounds); the target must then be parallel to the xy plane. With Inverse,
 * the data lies over the target's domain, and the grid over the source's.
 *
 * The output is the grid with the data's arrays as point arrays (cell arrays have the value of the
 * cell that contains the preimage) and the point array `vtkValidPointMask` (unsigned char): 1 where
 * there are values, 0 outside the domain and where the data has no values. At points with 0,
 * floating-point arrays are NaN, and others are 0; NumberOfOutsidePoints is the number of these
 * points. Of the grid's own arrays, only vtkGhostType is passed.
 *
 * Images are interpolated linearly in each direction, other data with the interpolation functions
 * of VTK's cells. An image without active vectors, normals or tensors is resampled many times
 * faster than other data.
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
  /// The grid (input port 3, optional) and the grid with the values (output port 0).
  void SetGridConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(3, output); }
  void SetGridData(vtkDataSet* grid);
  vtkDataSet* GetOutput();
  ///@}

  ///@{
  /// The default grid: the numbers of points in x and y, at least 1 (256 x 256 by default), and the
  /// rectangle (xmin, xmax, ymin, ymax) from the first to the last points. If xmin > xmax or ymin >
  /// ymax (default), the rectangle is that of the bounds of the mesh.
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
