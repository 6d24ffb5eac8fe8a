// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTriangularCoordinates
 * @brief   attach triangular coordinates (e, p, c) to points
 *
 * The filter computes the triangle and the triangular coordinates of each point of the data (input
 * port 1; the triangulation if there is none). *Contours* run from the center of a triangle to its
 * edges. e is the edge at which the contour through the point ends, p the position of that end on
 * the edge, and c the position of the point on the contour. In the LINEAR, CONTOUR and SMOOTH
 * systems, vtkDifferentiableHomeomorphism maps a point to the point with the same triangle and
 * coordinates, if both meshes list the points of the triangle in the same order. The CUBIC system
 * has no triangular coordinates; using it is an error.
 *
 * Output port 0 is the data with these point arrays added (an array of the same name is replaced):
 *
 * - `TriangleId` (vtkIdType): cell id of the triangle in input 0, -1 outside;
 * - `EdgeLabel` (int): e, 1 to 3, 0 outside. Edge k is opposite the k-th point of the triangle;
 * - `EdgeParameter` (double): p in [0, 1], 0 at the point that follows the k-th point in cyclic
 *   order; NaN outside;
 * - `ContourParameter` (double): c in [0, 1], 0 at the center, 1 on the edge; NaN outside;
 * - `vtkValidPointMask` (unsigned char): 1 inside, 0 outside.
 *
 * Output port 1 has polylines: the center and wing segments of each triangle, contours at evenly
 * spaced p, and rings (lines of constant c) at evenly spaced c. The cell arrays are `LineType` (see
 * LineTypes), `TriangleId`, `EdgeLabel`, `EdgeParameter` (of contours) and `ContourParameter` (of
 * rings); they are 0 or NaN where they do not apply. In the LINEAR and SMOOTH systems, the segments
 * are the images of those of the equilateral triangle.
 *
 * Output port 2 is the triangulation with these cell arrays:
 *
 * - `Concordant` (unsigned char): 1 if the triangle is concordant: the feet of the perpendiculars
 *   from its centroid lie strictly inside the edges; decided exactly;
 * - `ConcordanceMargin` (double): the smallest distance of a foot from an end of its edge, relative
 *   to the length of the edge; negative if discordant;
 * - `UsedCoordinateSystem` (int): LINEAR, CONTOUR or SMOOTH, -1 where the triangle is masked;
 * - `SmallestAngle` (double): the smallest angle, in degrees;
 * - `StripWidth` (double, 3 components): the width tau, in (0, 1], of the strip along each edge
 *   outside of which the chart of the SMOOTH system is affine; 0 on the boundary;
 * - `DeterminantBound` (double): a lower bound, in closed form, of the determinant of the chart of
 *   the SMOOTH system, divided by that of the affine chart. It is small if a neighbor is much
 *   smaller.
 *
 * If there is no data, output 0 has these cell arrays, too. The triangulation is the source (input
 * port 0); there is no target. If it is planar, distances of the data from its plane are ignored.
 *
 * @sa vtkHomeomorphismAlgorithm, vtkDifferentiableHomeomorphism
 */

#ifndef vtkTriangularCoordinates_h
#define vtkTriangularCoordinates_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkHomeomorphismAlgorithm.h"

class vtkPolyData;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkTriangularCoordinates : public vtkHomeomorphismAlgorithm
{
public:
  static vtkTriangularCoordinates* New();
  vtkTypeMacro(vtkTriangularCoordinates, vtkHomeomorphismAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The kinds of lines of output 1.
  enum LineTypes
  {
    CENTER_SEGMENT = 0,
    WING_SEGMENT = 1,
    CONTOUR_LINE = 2,
    RING_LINE = 3
  };

  ///@{
  /// GenerateLines: whether output 1 is generated (on by default; about 27 kB per triangle).
  /// NumberOfContours: the number of intervals into which contours divide each edge (4 by default,
  /// 1 to 100; with 1, there are only the contours to the vertices). NumberOfRings: the number of
  /// intervals into which rings divide each contour (4 by default, 1 to 100; with 1, there are no
  /// rings). LineResolution: the number of straight pieces of a contour, and of a ring along an
  /// edge (16 by default, 1 to 1000).
  vtkHomeomorphismSwitchMacro(GenerateLines, true);
  vtkHomeomorphismOptionMacro(NumberOfContours, int, 4, 1, 100);
  vtkHomeomorphismOptionMacro(NumberOfRings, int, 4, 1, 100);
  vtkHomeomorphismOptionMacro(LineResolution, int, 16, 1, 1000);
  ///@}

  /// The polylines and the triangulation of the last update.
  vtkPolyData* GetLines();
  vtkPolyData* GetTriangulation();

protected:
  vtkTriangularCoordinates();
  ~vtkTriangularCoordinates() override;

  int Execute(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkTriangularCoordinates(const vtkTriangularCoordinates&) = delete;
  void operator=(const vtkTriangularCoordinates&) = delete;
};

#endif
