// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTriangularCoordinates
 * @brief   attach triangular coordinates (e, p, c) to points
 *
 * Given a triangulation (input port 0) and any data set or tree of data sets (input port 1; if
 * there is none, the triangulation itself), vtkTriangularCoordinates finds the triangle of each
 * point and the point's triangular coordinates in it. *Contours* run from the triangle's center to
 * its edges; e tells the edge at which the point's contour ends, p where on the edge it ends, and c
 * how far along the contour the point is. Two points of two isomorphic triangulations that have the
 * same triangle and the same coordinates (the triangle's points being listed in the same order)
 * correspond: that is the homeomorphism of vtkDifferentiableHomeomorphism.
 *
 * Output port 0 is the data with these point arrays added (an array of the same name is replaced):
 *
 * - `TriangleId` (vtkIdType): cell id of the triangle in input 0, -1 outside;
 * - `EdgeLabel` (int): e, 1 to 3, 0 outside. Edge k is opposite the k-th point of the triangle;
 * - `EdgeParameter` (double): p in [0, 1], the proportion of the edge's length from the next point
 * in cyclic order towards the one after; NaN outside;
 * - `ContourParameter` (double): c in [0, 1], 0 at the center, 1 on the edge; NaN outside;
 * - `vtkValidPointMask` (unsigned char): 1 inside, 0 outside.
 *
 * Output port 1 shows the coordinates as polylines: the guides of the construction (center and wing
 * segments) and grid lines (contours at evenly spaced p, rings at evenly spaced c) of every
 * triangle, with the cell arrays `LineType` (see LineTypes), `TriangleId`, `EdgeLabel`,
 * `EdgeParameter` (of a contour) and `ContourParameter` (of a ring); what does not apply is 0 or
 * NaN. In the Linear and Smooth systems the guides are those of the equilateral triangle, carried
 * over.
 *
 * Output port 2 is the triangulation with these cell arrays:
 *
 * - `Concordant` (unsigned char): 1 if the Contour system exists in the triangle, that is, if the
 *   feet of the perpendiculars from the centroid lie strictly inside the edges; decided exactly;
 * - `ConcordanceMargin` (double): the least distance of a foot from an end of its edge, as a
 *   proportion of the edge's length; negative if discordant;
 * - `UsedCoordinateSystem` (int): LINEAR, CONTOUR or SMOOTH, -1 where the triangle is masked;
 * - `SmallestAngle` (double): degrees;
 * - `StripWidth` (double, 3 components): tau of the strip along each edge outside which the Smooth
 *   chart is affine, in (0, 1]; 0 on the boundary;
 * - `DeterminantBound` (double): a lower bound, in closed form, of the Smooth chart's determinant
 *   over that of the affine chart. Small beside a far smaller neighbor.
 *
 * If there is no data on port 1, output 0 has these cell arrays too. If the
 * outputs are asked for in pieces, the triangulation is asked for whole, and what is made from it
 * is part of piece 0, as is data that is made upstream from what the triangulation is made from.
 *
 * The triangulation may lie in any plane, where its points' distance from the plane is ignored, or
 * be a surface in 3-space, closed or not. It is validated, and refused with a message that names
 * the kind of defect, how many triangles have it and the first of their ids; see
 * MaskInvalidTriangles. An empty triangulation leaves every point outside.
 *
 * Coordinates are computed to a few units in the last place, in needles as well. The points are
 * processed in parallel (vtkSMPTools); results do not depend on the number of threads.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkHomeomorphismTransform
 */

#ifndef vtkTriangularCoordinates_h
#define vtkTriangularCoordinates_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkFiltersHomeomorphismModule.h" // for the export macro

#include <memory> // for the internals

class vtkDataSet;
class vtkMultiProcessController;
class vtkPolyData;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkTriangularCoordinates : public vtkDataObjectAlgorithm
{
public:
  static vtkTriangularCoordinates* New();
  vtkTypeMacro(vtkTriangularCoordinates, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The coordinate systems.
  enum CoordinateSystems
  {
    LINEAR = 0,  ///< straight contours
    CONTOUR = 1, ///< the published construction: a straight piece, then an arc at right angles to
                 ///< the edge; concordant triangles only
    SMOOTH = 2   ///< twice continuously differentiable across edges, any triangle
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
    REFUSE = 0,    ///< an error that names them
    USE_LINEAR = 1 ///< the Linear system stands in for them (`UsedCoordinateSystem` tells where)
  };

  /// What a line of output 1 is.
  enum LineTypes
  {
    CENTER_SEGMENT = 0,
    WING_SEGMENT = 1,
    CONTOUR_LINE = 2,
    RING_LINE = 3
  };

  /// The data whose points get coordinates (input port 1), a vtkDataSet or a vtkDataObjectTree.
  void SetDataConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetDataObject(vtkDataObject* data) { this->SetInputData(1, data); }

  ///@{
  /// The coordinate system: LINEAR, CONTOUR or SMOOTH (default).
  vtkSetClampMacro(CoordinateSystem, int, LINEAR, SMOOTH);
  vtkGetMacro(CoordinateSystem, int);
  void SetCoordinateSystemToLinear() { this->SetCoordinateSystem(LINEAR); }
  void SetCoordinateSystemToContour() { this->SetCoordinateSystem(CONTOUR); }
  void SetCoordinateSystemToSmooth() { this->SetCoordinateSystem(SMOOTH); }
  ///@}

  ///@{
  /// The point where the contours of the Contour system start: CENTROID (default), or INCENTER,
  /// with which every triangle is concordant.
  vtkSetClampMacro(CenterPoint, int, CENTROID, INCENTER);
  vtkGetMacro(CenterPoint, int);
  ///@}

  ///@{
  /// In the Contour system, whether discordant triangles are an error (REFUSE, default) or have the
  /// coordinates of the Linear system (USE_LINEAR).
  vtkSetClampMacro(DiscordantTriangles, int, REFUSE, USE_LINEAR);
  vtkGetMacro(DiscordantTriangles, int);
  ///@}

  ///@{
  /// Whether triangles that are invalid by themselves (no area, not finite, overlapping, at an edge
  /// of more than two) are left out with a warning, as if there were holes, instead of refusing the
  /// mesh. Off by default.
  vtkSetMacro(MaskInvalidTriangles, bool);
  vtkGetMacro(MaskInvalidTriangles, bool);
  vtkBooleanMacro(MaskInvalidTriangles, bool);
  ///@}

  ///@{
  /// How far outside the domain a point may be and still be taken to the nearest point of it, as a
  /// proportion of the diagonal of the triangulation's bounding box. 0 (default) allows only for
  /// the rounding of coordinates. Not negative.
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// Whether output 1 is made (default on). At the default resolution its lines take about 27 kB
  /// for every triangle: turn it off for large meshes if only the coordinates are wanted.
  vtkSetMacro(GenerateLines, bool);
  vtkGetMacro(GenerateLines, bool);
  vtkBooleanMacro(GenerateLines, bool);
  ///@}

  ///@{
  /// Number of intervals into which the contours drawn divide an edge, and into which the rings
  /// drawn divide a contour; 1 draws only the contours to the vertices, or no rings. 4 by default,
  /// 1 to 100.
  vtkSetClampMacro(NumberOfContours, int, 1, 100);
  vtkGetMacro(NumberOfContours, int);
  vtkSetClampMacro(NumberOfRings, int, 1, 100);
  vtkGetMacro(NumberOfRings, int);
  ///@}

  ///@{
  /// Number of straight pieces of a contour, and of a ring along one edge, in output 1. 16 by
  /// default, 1 to 1000.
  vtkSetClampMacro(LineResolution, int, 1, 1000);
  vtkGetMacro(LineResolution, int);
  ///@}

  /// Number of points of the data, or of the piece of it that was asked for, that the last
  /// execution found outside, without those that vtkGhostType says are another piece's; -1 if the
  /// triangulation was refused, in which case GetErrorCode() is not 0 either. See ReduceStatistics.
  vtkGetMacro(NumberOfOutsidePoints, vtkIdType);

  /// Number of triangles that the last execution found discordant, masked ones excepted.
  vtkGetMacro(NumberOfDiscordantTriangles, vtkIdType);

  /// Makes the numbers that this filter counts (NumberOfOutsidePoints and
  /// NumberOfDiscordantTriangles) the same in all processes that
  /// have pieces of the data: counts of points become sums, -1 if one of the processes has -1,
  /// numbers of triangles the largest. Each process of @a controller (null: the global controller;
  /// if there is none, nothing happens) must call this after its update, also one that had nothing
  /// to update or had an error: executing the filter never waits for other processes, this does.
  /// They are one process's own again after the next execution. In ParaView the plugin does it.
  void ReduceStatistics(vtkMultiProcessController* controller);

  /// The polylines and the triangulation of the last execution.
  vtkPolyData* GetLines();
  vtkPolyData* GetTriangulation();

protected:
  vtkTriangularCoordinates();
  ~vtkTriangularCoordinates() override;

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
  double Tolerance = 0.0;
  bool GenerateLines = true;
  int NumberOfContours = 4;
  int NumberOfRings = 4;
  int LineResolution = 16;
  vtkIdType NumberOfOutsidePoints = 0;
  vtkIdType NumberOfDiscordantTriangles = 0;

private:
  vtkTriangularCoordinates(const vtkTriangularCoordinates&) = delete;
  void operator=(const vtkTriangularCoordinates&) = delete;

  int AttachCoordinates(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs);

  class Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
