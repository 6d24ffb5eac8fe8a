// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkHomeomorphismAlgorithm
 * @brief   superclass of the filters that use a homeomorphism between two triangulations
 *
 * The meshes are the source P (input port 0) and the target Q (input port 1): two vtkPolyData with
 * the same triangles and different point coordinates. Triangle i of P and triangle i of Q have the
 * same three point ids, in any order. Each mesh lies in any plane or is a surface in 3-space,
 * closed or not. For every piece of the output, the filters request the meshes as a whole. Output
 * that depends only on the meshes is part of piece 0. The same applies to data that depends
 * upstream on the same algorithms as a mesh.
 *
 * The meshes are validated. Defects are reported with their kind, the number of triangles, and the
 * first cell ids. They are errors unless MaskInvalidTriangles excludes the triangles. Empty meshes
 * are valid; all points are then outside. The prepared map is cached until the meshes or the
 * options change. If coordinates are overwritten in place, call Modified() on the points or on the
 * mesh.
 *
 * The options are described in vtkHomeomorphismOptions.h.
 *
 * GetErrorCode() returns 0, or one of ErrorCodes after an update that failed or was aborted.
 * Filters do not communicate with other processes while they execute; see ReduceStatistics.
 *
 * Points are processed in parallel (vtkSMPTools); results do not depend on the number of threads.
 * A filter must not be used by several threads at the same time. Different filters may use the same
 * meshes in different threads.
 *
 * @sa vtkDifferentiableHomeomorphism, vtkHomeomorphismTransform, vtkJacobianContinuity,
 * vtkResampleThroughHomeomorphism, vtkTriangularCoordinates
 */

#ifndef vtkHomeomorphismAlgorithm_h
#define vtkHomeomorphismAlgorithm_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkFiltersHomeomorphismModule.h" // for the export macro
#include "vtkHomeomorphismOptions.h"       // for the options

#include <memory> // for the cached map

class vtkMultiProcessController;
class vtkPolyData;
class vtkTable;

namespace homeomorphism
{
class Homeomorphism;
}

class VTKFILTERSHOMEOMORPHISM_EXPORT vtkHomeomorphismAlgorithm : public vtkDataObjectAlgorithm
{
public:
  vtkTypeMacro(vtkHomeomorphismAlgorithm, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkHomeomorphismOptionsMacro();

  /// Values of GetErrorCode() after an update.
  enum ErrorCodes
  {
    MESHES_REFUSED = 40000, ///< the meshes are invalid or missing (vtkErrorCode::UserError)
    DATA_REFUSED = 40001,   ///< the type or the contents of the data cannot be processed
    UPDATE_ABORTED = 40002  ///< the update was aborted; outputs are incomplete or empty
  };

  ///@{
  /// The source mesh, input port 0.
  void SetSourceConnection(vtkAlgorithmOutput* output);
  void SetSourceData(vtkPolyData* source);
  ///@}

  ///@{
  /// The target mesh, input port 1. vtkTriangularCoordinates has no target; setting one is an
  /// error.
  void SetTargetConnection(vtkAlgorithmOutput* output);
  void SetTargetData(vtkPolyData* target);
  ///@}

  ///@{
  /// The data, on the input port after the meshes (2, or 1 in vtkTriangularCoordinates): a
  /// vtkDataSet or a vtkDataObjectTree. Optional. Only filters that map or describe data have it.
  void SetDataConnection(vtkAlgorithmOutput* output);
  void SetDataObject(vtkDataObject* data);
  ///@}

  /// Number of points of the data, or of its requested piece, that were outside the domain in the
  /// last update. Points that belong to another piece (vtkGhostType) are not counted. -1 if the
  /// meshes or the data were refused. See ReduceStatistics.
  vtkGetMacro(NumberOfOutsidePoints, vtkIdType);

  /// Number of valid triangles that are discordant in P or Q, in the CONTOUR system with
  /// USE_LINEAR; otherwise 0. vtkTriangularCoordinates counts them in all systems.
  vtkGetMacro(NumberOfDiscordantTriangles, vtkIdType);

  ///@{
  /// Statistics of the last map of the CUBIC system; 0 in other systems. In this order: the numbers
  /// of cubic elements (of the infinitely many similar ones at an exceptional vertex, one ring is
  /// counted), of triangles cut into 19 elements, of rings of elements around vertices, and of
  /// linear systems solved; the integral of the squared second derivatives, in (units of the target
  /// / units of the source)^2; the numbers of interior and boundary points at which the map has no
  /// derivative; and the number of triangles in which the determinant is not certified to be
  /// positive. Points in such triangles are treated as outside.
  vtkGetMacro(NumberOfCubicElements, vtkIdType);
  vtkGetMacro(NumberOfCutTriangles, vtkIdType);
  vtkGetMacro(NumberOfVertexRings, vtkIdType);
  vtkGetMacro(NumberOfBendingRounds, vtkIdType);
  vtkGetMacro(BendingEnergy, double);
  vtkGetMacro(NumberOfExceptionalInteriorVertices, vtkIdType);
  vtkGetMacro(NumberOfExceptionalBoundaryVertices, vtkIdType);
  vtkGetMacro(NumberOfUncertifiedTriangles, vtkIdType);
  ///@}

  /// Combines the statistics of the last update over all processes of @a controller (null: the
  /// global controller; if there is none, nothing happens). Numbers of points and of continuity
  /// features become sums, or -1 if a process has -1. Numbers of triangles and jumps become maxima.
  /// Every process must call this after its update, even after an error. After the next update, the
  /// statistics are again those of the own process. The ParaView plugin calls this.
  virtual void ReduceStatistics(vtkMultiProcessController* controller);

  /// The defects of the meshes found in the last update, one row for each kind and mesh. The
  /// columns are described in Documentation/diagnostics.md. The field data array `Ids` has all cell
  /// ids.
  vtkTable* GetDiagnostics();

  /// The number of times that the meshes have been read and validated since the filter was
  /// created.
  vtkIdType GetNumberOfMeshBuilds();

protected:
  vtkHomeomorphismAlgorithm();
  ~vtkHomeomorphismAlgorithm() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  /// Creates output 0 with the data's type (vtkPolyData without data), and vtkPolyData for others.
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestInformation(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  /// Resets statistics and error code and calls Execute.
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /// Generates the outputs. Returns 0 after an error, which was reported with Fail.
  virtual int Execute(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) = 0;

  /// The map between the meshes, or only the triangular coordinates of @a source if @a target is
  /// null. Reports defects. Returns null if the meshes were refused.
  std::shared_ptr<const homeomorphism::Homeomorphism> GetMap(
    vtkPolyData* source, vtkPolyData* target);

  /// Sets the error code if an input has a type that its port does not accept. RequestDataObject
  /// must call this, because in this case the pipeline executes no further request.
  void CheckInputTypes(vtkInformationVector** inputs);

  /// Sets the error code and the statistics of a failed update. Returns 0.
  int Fail(int errorCode);

  /// Whether a request is for piece 0, which has the output that depends only on the meshes.
  static bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs);
  /// Whether the input of a port depends upstream on the same algorithms as an input of the ports
  /// before it. It is then also requested as a whole, and its results are part of piece 0.
  bool DependsOnPortsBefore(int port);

  vtkIdType NumberOfOutsidePoints = 0;
  vtkIdType NumberOfDiscordantTriangles = 0;
  vtkIdType NumberOfCubicElements = 0;
  vtkIdType NumberOfCutTriangles = 0;
  vtkIdType NumberOfVertexRings = 0;
  vtkIdType NumberOfBendingRounds = 0;
  double BendingEnergy = 0.0;
  vtkIdType NumberOfExceptionalInteriorVertices = 0;
  vtkIdType NumberOfExceptionalBoundaryVertices = 0;
  vtkIdType NumberOfUncertifiedTriangles = 0;
  /// The number of input ports with meshes, which come first.
  int NumberOfMeshPorts = 2;
  /// The first input port that is requested in pieces.
  int FirstPortInPieces = 2;

private:
  vtkHomeomorphismAlgorithm(const vtkHomeomorphismAlgorithm&) = delete;
  void operator=(const vtkHomeomorphismAlgorithm&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
