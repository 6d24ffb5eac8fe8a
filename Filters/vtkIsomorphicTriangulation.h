// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIsomorphicTriangulation
 * @brief   a pair of isomorphic triangulations from landmarks, outlines and constraint segments
 *
 * The inputs are two drawings of the same figure, the source (input port 0) and the target (input
 * port 1): vtkPolyData with the same cells and different point coordinates. All points are
 * landmarks. Polygons and closed lines are loops (outlines, holes, and islands in holes): a point
 * belongs to the domain if an odd number of loops surrounds it. Other lines are constraint
 * segments. Each drawing is planar, in any plane. The target may be a mirror image.
 *
 * Output ports 0 and 1 are triangulations of the two drawings with the same triangles, which are
 * counterclockwise in the source's plane. They are valid inputs of all other filters of the module.
 * Points have double precision. The first points are those of the input, unchanged. Points are
 * added where no isomorphic triangulations exist without them, and on request for better triangles.
 * Output ports 2 and 3 are the constraint segments as lines between points of ports 0 and 1.
 *
 * Point arrays:
 *
 * - `OriginalPointId` (vtkIdType): the id of the point in the inputs, -1 for points of a frame and
 *   added points;
 * - `LandmarkResidual` (double): the distance of a landmark, in the target's units, from its
 *   prediction by a smooth map through its neighbors; near the border of the landmarks, where
 *   predictions are less certain, it is reduced accordingly; NaN for other points.
 *
 * Cell arrays (double):
 *
 * - `MinimumAngle`: the smallest angle of the triangle in both domains, in degrees;
 * - `Distortion`: the ratio of the larger to the smaller singular value of the linear map between
 *   the triangles in the two domains, at least 1.
 *
 * With several landmarks or holes, an edge may pass a landmark or hole on either side. Short edges
 * are preferred; constraint segments override this choice. The result does not depend on the order
 * of the points (except for edges of the same length) or, if both frames are set, on which drawing
 * is the source.
 *
 * A figure that has no isomorphic triangulations is refused: the outputs are empty, an error is
 * reported, and GetProblemKind() and related methods describe the problem and its location. The
 * result passes the validation of vtkDifferentiableHomeomorphism. Input attributes are not passed.
 *
 * A filter must not be used by several threads at the same time. The result does not depend on the
 * number of threads.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkTriangulationPairReport
 */

#ifndef vtkIsomorphicTriangulation_h
#define vtkIsomorphicTriangulation_h

#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

#include <memory> // for the internals
#include <string> // for messages

class vtkIdList;

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkIsomorphicTriangulation : public vtkPolyDataAlgorithm
{
public:
  static vtkIsomorphicTriangulation* New();
  vtkTypeMacro(vtkIsomorphicTriangulation, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The domain that is triangulated.
  enum Domains
  {
    AUTOMATIC = 0,  ///< OUTLINE if there are loops, else FRAME
    OUTLINE = 1,    ///< the interior of the loops
    FRAME = 2,      ///< a frame around the points; loops are constraint segments
    CONVEX_HULL = 3 ///< the convex hulls, which must have the same points in the same order
  };

  /// The quality measures. The quality of the worst triangle is optimized.
  enum Qualities
  {
    MINIMUM_ANGLE = 0, ///< the smallest angle of both domains
    CONCORDANCE = 1,   ///< the margin by which triangles are concordant
    DISTORTION = 2,    ///< the ratio of the singular values of the linear map
    NON_OBTUSE = 3     ///< the largest angle of both domains
  };

  /// The kinds of problems for which a figure is refused.
  enum ProblemKinds
  {
    EMPTY = 0,                 ///< fewer than three points
    POINT_COUNTS_DIFFER = 1,   ///< the inputs have different numbers of points
    BAD_CELL = 2,              ///< a loop or line repeats a point or is too short
    CELLS_DIFFER = 3,          ///< the inputs have different cells
    NOT_FINITE = 4,            ///< coordinates are NaN or infinite
    NOT_PLANAR = 5,            ///< a figure does not lie in a plane
    COLLINEAR = 6,             ///< all points lie on a line
    COINCIDENT = 7,            ///< points have the same position
    CROSSING = 8,              ///< segments cross
    POINT_ON_SEGMENT = 9,      ///< a point lies on a segment in one domain only
    CYCLIC_ORDER = 10,         ///< segments at a point have different cyclic orders
    OTHER_FACE = 11,           ///< segments enclose points in one domain only
    OUTLINE_AGAINST_HOLE = 12, ///< a loop is inside another one in one domain only
    LOOP_SENSE = 13,           ///< some loops are mirrored, others are not
    OUTSIDE_DOMAIN = 14,       ///< points are outside the loops or the frame
    HULLS_DIFFER = 15,         ///< the convex hulls differ
    BAD_FRAME = 16,            ///< a frame is empty, or only one was given
    POINT_LIMIT = 17,          ///< more points are necessary than allowed
    PRECISION = 18,            ///< a part of the domain is too narrow for double precision
    ABORTED = 19               ///< the update was aborted
  };

  ///@{
  /// The source figure, input port 0.
  void SetSourceConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(0, output); }
  void SetSourceData(vtkPolyData* source);
  ///@}

  ///@{
  /// The target figure, input port 1.
  void SetTargetConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetTargetData(vtkPolyData* target);
  ///@}

  ///@{
  /// Outputs 1 to 3. Output 0, the source's triangulation, is GetOutput().
  vtkPolyData* GetTargetOutput() { return this->GetOutput(1); }
  vtkPolyData* GetSourceSegments() { return this->GetOutput(2); }
  vtkPolyData* GetTargetSegments() { return this->GetOutput(3); }
  ///@}

  ///@{
  /// See Domains. AUTOMATIC by default.
  vtkSetClampMacro(Domain, int, AUTOMATIC, CONVEX_HULL);
  vtkGetMacro(Domain, int);
  ///@}

  ///@{
  /// Frames: smallest x, largest x, smallest y, largest y, in the coordinates of the drawing's
  /// plane (x and y if z is constant), for example the rectangles of images. Their corners are
  /// matched so that they fit the landmarks best. The default of both, (0, -1, 0, -1), selects
  /// automatic frames. That of the source extends beyond the bounds of the landmarks by half the
  /// mean distance of neighboring landmarks, or more if this requires fewer added points, and has
  /// points on its edges so that triangles at the frame are not thin. That of the target is its
  /// affine image. Either both frames are set or neither.
  vtkSetVector4Macro(SourceFrame, double);
  vtkGetVector4Macro(SourceFrame, double);
  vtkSetVector4Macro(TargetFrame, double);
  vtkGetVector4Macro(TargetFrame, double);
  ///@}

  ///@{
  /// See Qualities. MINIMUM_ANGLE by default.
  vtkSetClampMacro(Quality, int, MINIMUM_ANGLE, NON_OBTUSE);
  vtkGetMacro(Quality, int);
  ///@}

  ///@{
  /// The largest number of points that may be added, at least -1. With 0, the update fails if no
  /// pair without added points is found. Without TargetMinimumAngle, the first pair within the
  /// limit is the result, so a large limit is fast. -1 (default): the smallest number found in
  /// several attempts, and up to 100 more for TargetMinimumAngle.
  vtkSetClampMacro(MaximumNumberOfAddedPoints, int, -1, VTK_INT_MAX);
  vtkGetMacro(MaximumNumberOfAddedPoints, int);
  ///@}

  ///@{
  /// The quality at which no more points are added, 0 to 90. 0 (default): only necessary points
  /// are added. With MINIMUM_ANGLE, it is the smallest angle of both domains in degrees, up to 60.
  /// With CONCORDANCE and NON_OBTUSE, 90 means that no triangle is discordant or obtuse; no angle
  /// becomes smaller than half the smallest angle of the pair with only the necessary points, or
  /// than 2.5 degrees if that is less; if that pair has an angle below 1 degree, half of the points
  /// are first added for MINIMUM_ANGLE. With DISTORTION, 60 means similar triangles.
  vtkSetClampMacro(TargetMinimumAngle, double, 0.0, 90.0);
  vtkGetMacro(TargetMinimumAngle, double);
  ///@}

  ///@{
  /// Triangles with more than this fraction of the area of their domain, in either domain, are
  /// divided; 0 to 1. 0 (default): triangles are not divided.
  vtkSetClampMacro(MaximumTriangleSize, double, 0.0, 1.0);
  vtkGetMacro(MaximumTriangleSize, double);
  ///@}

  ///@{
  /// Whether added points are merged until few are left, and moved to where the triangles are best.
  /// On by default. Off is several times faster if there are many, for interactive use.
  vtkSetMacro(OptimizeAddedPoints, bool);
  vtkGetMacro(OptimizeAddedPoints, bool);
  vtkBooleanMacro(OptimizeAddedPoints, bool);
  ///@}

  ///@{
  /// Whether constraint segments that conflict with others are left out, instead of refusing the
  /// figure: as few as possible, and rather short ones. GetNumberOfLeftOutSegments() and related
  /// methods list them. Off by default.
  vtkSetMacro(LeaveOutConflictingSegments, bool);
  vtkGetMacro(LeaveOutConflictingSegments, bool);
  vtkBooleanMacro(LeaveOutConflictingSegments, bool);
  ///@}

  ///@{
  /// The problems of an update without a result: their number and, for each (from 0), the kind
  /// (see ProblemKinds), the domain (0 source, 1 target, -1 if the two disagree), the points
  /// concerned (at most 10; the ends of two crossing segments, or a point and the ends of the
  /// segment on which it lies), the id of the cell that could not be drawn (-1 if there is none),
  /// the number of occurrences, and a message. Messages identify points by the source's pedigree
  /// ids, if it has any, otherwise by their point ids. For a number that is out of range, an error
  /// is reported, and the results are -1, no points, 0 and an empty message.
  int GetNumberOfProblems();
  int GetProblemKind(int problem);
  int GetProblemDomain(int problem);
  void GetProblemPoints(int problem, vtkIdList* points);
  vtkIdType GetProblemCell(int problem);
  int GetProblemCount(int problem);
  std::string GetProblemMessage(int problem);
  ///@}

  ///@{
  /// The segments that were left out: their number and, for each (from 0), the id of its cell and
  /// the reason. For a number that is out of range, an error is reported, and the results are -1
  /// and an empty message.
  int GetNumberOfLeftOutSegments();
  vtkIdType GetLeftOutCell(int segment);
  std::string GetLeftOutMessage(int segment);
  ///@}

  ///@{
  /// Statistics of the last update, in this order: the number of added points (without those of
  /// a frame); the smallest angles of source and target, in degrees; the fractions, from 0 to 1, of
  /// angles below 10, 15 and 20 degrees in the worse domain; the fractions of triangles that are
  /// obtuse, and discordant, in at least one domain; the largest distortion and its cell id;
  /// whether the drawings are mirror images.
  vtkGetMacro(NumberOfAddedPoints, int);
  vtkGetVector2Macro(SmallestAngles, double);
  vtkGetVector3Macro(SharesOfSmallAngles, double);
  vtkGetMacro(ObtuseShare, double);
  vtkGetMacro(DiscordantShare, double);
  vtkGetMacro(LargestDistortion, double);
  vtkGetMacro(LargestDistortionCell, vtkIdType);
  vtkGetMacro(Mirrored, bool);
  ///@}

  /// The ids of the ten landmarks with the largest LandmarkResidual, in descending order.
  void GetSuspiciousLandmarks(vtkIdList* points);

protected:
  vtkIsomorphicTriangulation();
  ~vtkIsomorphicTriangulation() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  int Domain = AUTOMATIC;
  double SourceFrame[4] = { 0.0, -1.0, 0.0, -1.0 };
  double TargetFrame[4] = { 0.0, -1.0, 0.0, -1.0 };
  int Quality = MINIMUM_ANGLE;
  int MaximumNumberOfAddedPoints = -1;
  double TargetMinimumAngle = 0.0;
  double MaximumTriangleSize = 0.0;
  bool OptimizeAddedPoints = true;
  bool LeaveOutConflictingSegments = false;
  int NumberOfAddedPoints = 0;
  double SmallestAngles[2] = { 0.0, 0.0 };
  double SharesOfSmallAngles[3] = { 0.0, 0.0, 0.0 };
  double ObtuseShare = 0.0;
  double DiscordantShare = 0.0;
  double LargestDistortion = 1.0;
  vtkIdType LargestDistortionCell = -1;
  bool Mirrored = false;

private:
  vtkIsomorphicTriangulation(const vtkIsomorphicTriangulation&) = delete;
  void operator=(const vtkIsomorphicTriangulation&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
