// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIsomorphicTriangulation
 * @brief   a pair of isomorphic triangulations from landmarks, outlines and constraint segments
 *
 * vtkIsomorphicTriangulation takes two drawings of one figure, the source (input port 0) and the
 * target (input port 1): vtkPolyData with the same cells and other positions of the points. All
 * points are landmarks. Polygons and closed loops of line cells are outlines, holes and islands:
 * what an odd number of them surrounds belongs to the domain. Other lines are constraint segments.
 * Each figure is planar, in any plane. The target may be a mirror image.
 *
 * Output ports 0 and 1 are triangulations of the two figures with the same triangles, valid for
 * every other filter of the module: points of double precision, the first of them those of the
 * input, unchanged; triangles counterclockwise in the source's plane. Points are added only where
 * the figures have no isomorphic triangulations otherwise, and on request for better triangles.
 * Output ports 2 and 3 are the constraint segments as lines on the points of ports 0 and 1.
 *
 * Point arrays: `OriginalPointId` (vtkIdType), the id of the point in the inputs, -1 for a frame's
 * corners and added points; `LandmarkResidual` (double), the distance in the target's units of a
 * landmark from where a smooth map through its neighbors puts it without it, NaN for points that
 * were added. Cell arrays (double): `MinimumAngle`, the smallest angle of a triangle in both
 * domains in degrees; `Distortion`, the ratio of the singular values of the linear map between its
 * two triangles, from 1.
 *
 * With several landmarks or holes, the way in which regions pass each other is a choice: short
 * edges decide. Constraint segments decide it otherwise. Neither the order of the points (up to
 * edges of the same length) nor, with both frames given, the exchange of source and target change
 * the result.
 *
 * A figure that has no isomorphic triangulations is refused: the outputs are empty, an error is
 * reported, and GetProblemKind() and the following say what is wrong and where. The result passes
 * the validation of vtkDifferentiableHomeomorphism. Input attributes are not passed on.
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

  /// What is triangulated.
  enum Domains
  {
    AUTOMATIC = 0,  ///< OUTLINE if there are loops, else FRAME
    OUTLINE = 1,    ///< the inside of the loops
    FRAME = 2,      ///< a frame around the points; loops are constraint segments
    CONVEX_HULL = 3 ///< the convex hulls, if they have the same points in the same order
  };

  /// What triangles are optimized for; the worst triangle counts.
  enum Qualities
  {
    MINIMUM_ANGLE = 0, ///< the smallest angle of both domains
    CONCORDANCE = 1,   ///< how far inside the edges the feet of the centroid are
    DISTORTION = 2,    ///< the ratio of singular values of the linear maps
    NON_OBTUSE = 3     ///< the largest angle of both domains
  };

  /// Kinds of problems.
  enum ProblemKinds
  {
    EMPTY = 0,                 ///< fewer than three points
    POINT_COUNTS_DIFFER = 1,   ///< the inputs have different numbers of points
    BAD_CELL = 2,              ///< a loop or line repeats a point or is too short
    CELLS_DIFFER = 3,          ///< the inputs have different cells
    NOT_FINITE = 4,            ///< coordinates are NaN, infinite or beyond 1e150
    NOT_PLANAR = 5,            ///< a figure does not lie in a plane
    COLLINEAR = 6,             ///< all points lie on a line
    COINCIDENT = 7,            ///< points have the same position
    CROSSING = 8,              ///< segments cross
    POINT_ON_SEGMENT = 9,      ///< a point lies on a segment in one domain only
    CYCLIC_ORDER = 10,         ///< segments at a point follow each other differently
    OTHER_FACE = 11,           ///< segments surround points in one domain only
    OUTLINE_AGAINST_HOLE = 12, ///< a loop is inside another one in one domain only
    LOOP_SENSE = 13,           ///< a loop is mirrored and the first one is not, or vice versa
    OUTSIDE_DOMAIN = 14,       ///< points are outside the loops or the frame
    HULLS_DIFFER = 15,         ///< the convex hulls differ
    BAD_FRAME = 16,            ///< a frame is empty, or only one was given
    POINT_LIMIT = 17,          ///< more points are necessary than allowed
    PRECISION = 18,            ///< a face is too narrow for double precision
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
  /// Frames: least x, largest x, least y, largest y in the coordinates of the figure's plane (x, y
  /// of a figure of constant z), for example images' rectangles. Corners correspond as fits the
  /// landmarks best. (0, -1, 0, -1), the default of both, stands for a frame 5 percent larger than
  /// the source and its affine image, and larger ones if that saves added points.
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
  /// How many points may be added. With 0 the filter says whether it found a way without. The first
  /// pair found that keeps to the limit is taken, unless there is a TargetMinimumAngle: a generous
  /// limit is fast. -1 (default): as many as necessary after several attempts, and up to 100 more
  /// for TargetMinimumAngle.
  vtkSetClampMacro(MaximumNumberOfAddedPoints, int, -1, VTK_INT_MAX);
  vtkGetMacro(MaximumNumberOfAddedPoints, int);
  ///@}

  ///@{
  /// Points are added until no angle of either domain is smaller, in degrees, 0 to 60. 0 (default):
  /// only necessary points are added. For CONCORDANCE and NON_OBTUSE, 90 stands for no discordant
  /// or obtuse triangle; for DISTORTION, 60 for similar triangles.
  vtkSetClampMacro(TargetMinimumAngle, double, 0.0, 90.0);
  vtkGetMacro(TargetMinimumAngle, double);
  ///@}

  ///@{
  /// Triangles whose share of their domain's area is larger, in either domain, are divided. 0
  /// (default): none is.
  vtkSetClampMacro(MaximumTriangleSize, double, 0.0, 1.0);
  vtkGetMacro(MaximumTriangleSize, double);
  ///@}

  ///@{
  /// Leave out constraint segments that do not agree with shorter ones instead of refusing. They
  /// are listed, see GetNumberOfLeftOutSegments(). Off by default.
  vtkSetMacro(LeaveOutConflictingSegments, bool);
  vtkGetMacro(LeaveOutConflictingSegments, bool);
  vtkBooleanMacro(LeaveOutConflictingSegments, bool);
  ///@}

  ///@{
  /// What is wrong, after an update without a result: how many problems, and of each the kind (see
  /// ProblemKinds), the domain (0 source, 1 target, -1 where the two disagree), the points
  /// concerned (at most 10; two ends of each of two crossing segments, a point and the ends of its
  /// segment), the id of the cell that could not be drawn (-1 if none), how often the problem
  /// occurs, and a message.
  int GetNumberOfProblems();
  int GetProblemKind(int problem);
  int GetProblemDomain(int problem);
  void GetProblemPoints(int problem, vtkIdList* points);
  vtkIdType GetProblemCell(int problem);
  int GetProblemCount(int problem);
  std::string GetProblemMessage(int problem);
  ///@}

  ///@{
  /// Segments that were left out: their number, ids of their cells, and why.
  int GetNumberOfLeftOutSegments();
  vtkIdType GetLeftOutCell(int segment);
  std::string GetLeftOutMessage(int segment);
  ///@}

  ///@{
  /// Of the last update: points added (a frame's corners are not counted); the smallest angle of
  /// source and target in degrees; the share of angles below 10, 15 and 20 degrees in the worse of
  /// the two; the share of triangles that are obtuse, or discordant, in at least one domain; the
  /// largest distortion, and the triangle where it is; whether the figures are mirror images.
  vtkGetMacro(NumberOfAddedPoints, int);
  vtkGetVector2Macro(SmallestAngles, double);
  vtkGetVector3Macro(SharesOfSmallAngles, double);
  vtkGetMacro(ObtuseShare, double);
  vtkGetMacro(DiscordantShare, double);
  vtkGetMacro(LargestDistortion, double);
  vtkGetMacro(LargestDistortionCell, vtkIdType);
  vtkGetMacro(Mirrored, bool);
  ///@}

  /// The ten landmarks with the largest LandmarkResidual, the worst first.
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
