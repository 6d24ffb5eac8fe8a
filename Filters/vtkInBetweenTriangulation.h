// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkInBetweenTriangulation
 * @brief   triangulations between a source and a target, for morphs
 *
 * vtkInBetweenTriangulation moves the points of a triangulation (input port 0, the source) to those
 * of another with the same triangles (input port 1, the target). At Time 0, the points are exactly
 * those of the source, at Time 1 exactly those of the target. For a morph, map data from the source
 * to the output with vtkDifferentiableHomeomorphism, for a sequence of times; for a morph of two
 * images, also map data from the target to the output.
 *
 * A triangle may fold: its orientation may be reversed at some times, even if it is not at the
 * ends. The output at these times is not a valid target of a map. The times are computed from the
 * zeros of a quadratic polynomial, so they are known for the whole path, not only for Time. Path
 * selects how folds are avoided. Folds that cannot be avoided are not an error; see
 * NumberOfFoldingTriangles and related methods.
 *
 * The output has the source's cells, point data and cell data, points of double precision, and the
 * cell array `Folded` (unsigned char): 1 if the triangle's orientation at Time differs from that in
 * the source, or its area is zero, decided exactly from the output's coordinates.
 *
 * Folds are defined if both meshes are planar, in planes parallel to the same two axes
 * (GetPlanar). Other meshes move along straight lines, and no folds are reported.
 *
 * See vtkHomeomorphismAlgorithm for the meshes and for MaskInvalidTriangles, the only one of its
 * options that has an effect: masked triangles are ignored when the path is chosen and when folds
 * are counted.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkTriangulationPairReport
 */

#ifndef vtkInBetweenTriangulation_h
#define vtkInBetweenTriangulation_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkHomeomorphismAlgorithm.h"

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkInBetweenTriangulation : public vtkHomeomorphismAlgorithm
{
public:
  static vtkInBetweenTriangulation* New();
  vtkTypeMacro(vtkInBetweenTriangulation, vtkHomeomorphismAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The paths of the points.
  enum Paths
  {
    /// Straight lines, at constant speed.
    STRAIGHT = 0,
    /// The mesh as a whole rotates and scales at a constant rate, according to the similarity that
    /// best maps the source to the target (least squares over the points). Points move along
    /// straight lines relative to it.
    ROTATING = 1,
    /// ROTATING if fewer triangles fold on that path, otherwise STRAIGHT.
    FEWEST_FOLDS = 2
  };

  ///@{
  /// The position on the path, from 0 (the source) to 1 (the target). 0.5 by default.
  vtkSetClampMacro(Time, double, 0.0, 1.0);
  vtkGetMacro(Time, double);
  ///@}

  ///@{
  /// See Paths. FEWEST_FOLDS by default. The path does not depend on Time.
  vtkSetClampMacro(Path, int, STRAIGHT, FEWEST_FOLDS);
  vtkGetMacro(Path, int);
  ///@}

  /// The path of the last update, STRAIGHT or ROTATING.
  vtkGetMacro(UsedPath, int);

  ///@{
  /// For a rotating path, the angle by which the mesh rotates from source to target, in degrees in
  /// [-180, 180], counterclockwise with respect to the plane's axes in their order, and the factor
  /// by which lengths scale. 0 and 1 for a straight path.
  vtkGetMacro(RotationAngle, double);
  vtkGetMacro(ScaleFactor, double);
  ///@}

  /// Whether both meshes are planar, in planes parallel to the same two axes.
  vtkGetMacro(Planar, bool);

  /// Whether source and target are mirror images of each other. All triangles then fold.
  vtkGetMacro(Mirrored, bool);

  ///@{
  /// The number of triangles that fold at some time on the path, the cell id of the first triangle
  /// that folds (-1 if there is none), the time at which it folds, and the time at which the last
  /// one unfolds. Without folds, the times are 1 and 0.
  vtkGetMacro(NumberOfFoldingTriangles, vtkIdType);
  vtkGetMacro(FirstFoldingTriangle, vtkIdType);
  vtkGetMacro(FirstFoldTime, double);
  vtkGetMacro(LastFoldTime, double);
  ///@}

  ///@{
  /// The mesh at Time.
  vtkPolyData* GetOutput() { return this->GetOutput(0); }
  vtkPolyData* GetOutput(int port);
  ///@}

  /// The number of triangles that are folded at Time: the sum of the array `Folded`.
  vtkGetMacro(NumberOfFoldedTriangles, vtkIdType);

protected:
  vtkInBetweenTriangulation();
  ~vtkInBetweenTriangulation() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int Execute(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  double Time = 0.5;
  int Path = FEWEST_FOLDS;
  int UsedPath = STRAIGHT;
  double RotationAngle = 0.0;
  double ScaleFactor = 1.0;
  bool Planar = false;
  bool Mirrored = false;
  vtkIdType NumberOfFoldingTriangles = 0;
  vtkIdType FirstFoldingTriangle = -1;
  double FirstFoldTime = 1.0;
  double LastFoldTime = 0.0;
  vtkIdType NumberOfFoldedTriangles = 0;

private:
  vtkInBetweenTriangulation(const vtkInBetweenTriangulation&) = delete;
  void operator=(const vtkInBetweenTriangulation&) = delete;
};

#endif
