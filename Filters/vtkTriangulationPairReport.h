// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTriangulationPairReport
 * @brief   statistics of a pair of triangulations and of the maps that it defines
 *
 * vtkTriangulationPairReport measures a pair, the source (input port 0) and the target (input port
 * 1), and the homeomorphisms that the pair defines in all coordinate systems. Defects of the meshes
 * are results, not errors. Invalid triangles are left out of the measurements. If the remaining
 * triangles do not form a valid pair, only points and defects are counted. Documentation/report.md
 * explains the numbers.
 *
 * Output ports 0 and 1 are source and target with these cell arrays (double unless stated
 * otherwise; NaN for invalid triangles and other cells):
 *
 * - `SmallestAngle`: the triangle's smallest angle in this mesh, in degrees;
 * - `AreaRatio`: the largest ratio of areas between the triangle and a neighbor in this mesh, at
 *   least 1; NaN without neighbors;
 * - `Concordant` (unsigned char): 1 where the triangle is concordant in this mesh;
 * - `Determinant`: the ratio of the triangle's area in the target to that in the source;
 * - `Distortion`: the condition number of the triangle's linear map, that is, the ratio of the
 *   largest to the smallest factor by which it changes lengths, at least 1;
 * - `SmallestDeterminant`, `LargestDeterminant`: extremes of the Jacobian determinant in the chosen
 *   CoordinateSystem over samples of the triangle, relative to the pair's orientation, so that they
 *   are positive for mirrored pairs too;
 * - `DeviationFromLinear`: the largest distance, over the samples, between the images in the chosen
 *   system and in LINEAR, in the target's units;
 * - `Invalid` (unsigned char): 1 for triangles that were left out.
 *
 * Output port 2 is a vtkTable of one row. Its columns begin with `Source` or `Target` (a mesh),
 * with `Linear`, `Contour`, `Smooth` or `Cubic` (a map), or with neither (the pair). Counts are
 * vtkIdType, flags int (0 or 1), all others double. If a value cannot be measured, cell ids and
 * counts of edges and triangles are -1, and values of type double are NaN.
 *
 * - `Valid`: whether the whole pair defines a map. `Measured`: whether the pair without its invalid
 *   triangles does; if not, only the columns up to `TargetDuplicatePoints` and `InvalidTriangles`
 *   have values.
 * - `SourcePoints`, `SourceTriangles` (polygons), `SourceUnusedPoints`, `SourceDuplicatePoints`,
 *   and the same columns for the target. A duplicate point has exactly the coordinates of a point
 *   with a smaller id.
 * - `InvalidTriangles`; `Mirrored`; `Components`, `InteriorEdges`, `BoundaryEdges`,
 *   `BoundaryLoops`; `OppositeWindings` (triangles whose winding differs from that of most
 *   triangles of their component); `ReorderedTriangles` (triangles whose points are in a different
 *   order in the target).
 * - `SourcePlanar`, `SourceArea`, `SourceMeanEdgeLength`; `SourceSmallestAngle` in degrees and
 *   `SourceSmallestAngleCell`; `SourceShareOfTrianglesBelow10Degrees` (and 15, 20): the fraction,
 *   from 0 to 1, of triangles whose smallest angle is below that number of degrees;
 *   `SourceLargestAreaRatio` and `SourceLargestAreaRatioCell`; `SourceDiscordantTriangles`; the
 *   same columns for the target.
 * - `LargestStretch`, `SmallestStretch`, `LargestDistortion`, each with `-Cell`: extremes over the
 *   linear maps of the triangles.
 * - `SmoothSmallestDeterminant`, `SmoothLargestDeterminant`, each with `-Cell`; `SmoothSamples` and
 *   `SmoothNotPositive`, the number of samples and of those with a determinant that is not
 *   positive; the same columns, and those below, for the other systems.
 * - `SmoothDeviationFromLinear`, the largest distance between images in SMOOTH and in LINEAR, in
 *   the target's units, `-Cell`, and `-X`, `-Y`, `-Z`, the point of the source where it occurs.
 * - `SmoothSecondDifference` and `SmoothSecondDifferenceSamples`: a measure of bending at the scale
 *   of a tenth of an edge, the root mean square over the domain of second differences
 *   |f(x + h) + f(x - h) - 2 f(x)| / h^2, combined as the norm of a Hessian matrix, with lengths in
 *   mean edge lengths of source and target. 0 for affine maps. Planar pairs only.
 * - `SmoothDifferentiableEdges`, `SmoothCreases`, `SmoothUndecidedEdges`, `SmoothLargestJump`: the
 *   results of vtkJacobianContinuity at the interior edges. NaN and -1 without MeasureContinuity.
 * - `CubicCertificate` and `-Cell`, the smallest certificate of a triangle (certified if positive);
 *   `CubicBendingEnergy`, the integral of the squared second derivatives, in (units of the target /
 *   units of the source)^2, NaN with CubicBending LOCAL, which does not minimize it (the integral
 *   is infinite for maps with creases); `CubicUncertifiedTriangles`;
 *   `CubicExceptionalInteriorVertices` and `CubicExceptionalBoundaryVertices`, the numbers of
 *   points without a derivative. All columns of Cubic are NaN or -1 for pairs that are not planar
 *   or have more than 2^26 triangles after FairnessRefinement.
 *
 * Output port 3 is a vtkTable with one row for each kind of defect. Its columns, and the field data
 * array `Ids` with all cell ids, are described in Documentation/diagnostics.md.
 *
 * CONTOUR is measured with USE_LINEAR for discordant triangles. The samples are the same points in
 * every run. They are processed in parallel (vtkSMPTools); results do not depend on the number of
 * threads.
 *
 * See vtkHomeomorphismAlgorithm for the meshes and the options. CoordinateSystem selects the system
 * of the cell arrays; the table has all systems. CenterPoint applies to CONTOUR; CubicBending,
 * CertificateMargin and FairnessRefinement apply to CUBIC; MaximumDeviation applies to SMOOTH and
 * CUBIC. The other options have no effect.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkJacobianContinuity
 */

#ifndef vtkTriangulationPairReport_h
#define vtkTriangulationPairReport_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkHomeomorphismAlgorithm.h"

class vtkTable;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkTriangulationPairReport : public vtkHomeomorphismAlgorithm
{
public:
  static vtkTriangulationPairReport* New();
  vtkTypeMacro(vtkTriangulationPairReport, vtkHomeomorphismAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Whether the maps are sampled: determinants, deviations and second differences. On by default.
  vtkSetMacro(MeasureMaps, bool);
  vtkGetMacro(MeasureMaps, bool);
  vtkBooleanMacro(MeasureMaps, bool);
  ///@}

  ///@{
  /// Whether continuity is measured at the interior edges. This takes most of the time. On by
  /// default.
  vtkSetMacro(MeasureContinuity, bool);
  vtkGetMacro(MeasureContinuity, bool);
  vtkBooleanMacro(MeasureContinuity, bool);
  ///@}

  ///@{
  /// The outputs, after an update: source and target with their arrays (ports 0 and 1), the
  /// statistics (port 2) and the defects (port 3).
  vtkPolyData* GetOutput() { return this->GetOutput(0); }
  vtkPolyData* GetOutput(int port);
  vtkPolyData* GetTargetOutput() { return this->GetOutput(1); }
  vtkTable* GetStatistics();
  vtkTable* GetDefects();
  ///@}

  /// The value of a column of the statistics after an update; NaN if there is no such column.
  double GetStatistic(const char* column);

  /// Whether the whole pair defines a map, after an update.
  vtkGetMacro(Valid, bool);

protected:
  vtkTriangulationPairReport();
  ~vtkTriangulationPairReport() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int Execute(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  bool MeasureMaps = true;
  bool MeasureContinuity = true;
  bool Valid = false;

private:
  vtkTriangulationPairReport(const vtkTriangulationPairReport&) = delete;
  void operator=(const vtkTriangulationPairReport&) = delete;
};

#endif
