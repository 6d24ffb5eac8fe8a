# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Statistics of the filters on several processes: mpiexec -n N python3 test_processes.py. Every process must
get the totals, whether it has data, no data, or an error."""

from mpi4py import MPI
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.vtkParallelMPI import vtkMPIController

from vtkhomeomorphism import (
    vtkDifferentiableHomeomorphism,
    vtkJacobianContinuity,
    vtkResampleThroughHomeomorphism,
    vtkTriangularCoordinates,
)

# mpi4py has initialized MPI, and finalizes it.
controller = vtkMPIController()
controller.Initialize()
vtkMultiProcessController.SetGlobalController(controller)
rank = controller.GetLocalProcessId()
processes = controller.GetNumberOfProcesses()


def check_equal(actual, expected, what):
    """Ends all processes if two values differ."""
    if actual != expected:
        print(f"Process {rank} of {processes}: {what}: {actual}, not {expected}", flush=True)
        MPI.COMM_WORLD.Abort(1)


def mesh(corners, center):
    points = vtkPoints()
    for point in corners + [center]:
        points.InsertNextPoint(*point, 0.0)
    cells = vtkCellArray()
    for i in range(4):
        cells.InsertNextCell(3, (i, (i + 1) % 4, 4))
    result = vtkPolyData()
    result.SetPoints(points)
    result.SetPolys(cells)
    return result


square = [(-8, -8), (8, -8), (8, 8), (-8, 8)]
source = mesh(square, (0, 0))
target = mesh(square, (3, -2))
refused = mesh(square, (30, 0))


def set_meshes(algorithm, second=target):
    algorithm.SetInputData(0, source)
    if not isinstance(algorithm, vtkTriangularCoordinates):
        algorithm.SetInputData(1, second)
    return algorithm


def image():
    result = vtkRTAnalyticSource()
    result.SetWholeExtent(-10, 10, -9, 9, -1, 1)
    return result


def count(algorithm, piece, pieces, ghosts):
    """From the mask, without duplicates of other pieces."""
    algorithm.UpdatePiece(piece, pieces, ghosts)
    arrays = algorithm.GetOutputDataObject(0).GetPointData()
    outside = vtk_to_numpy(arrays.GetArray("vtkValidPointMask")) == 0
    ghost_types = arrays.GetArray("vtkGhostType")
    if ghost_types:
        outside &= (vtk_to_numpy(ghost_types) & 1) == 0
    return int(outside.sum())


def make(kind):
    algorithm = set_meshes(kind())
    # The port of the input that comes in pieces.
    port = algorithm.GetNumberOfInputPorts() - 1
    data = image()
    algorithm.SetInputConnection(port, data.GetOutputPort())
    if kind is vtkResampleThroughHomeomorphism:
        # Separate data, because it is requested whole.
        data = image()
        algorithm.SetInputConnection(2, data.GetOutputPort())
    return algorithm


for kind in vtkDifferentiableHomeomorphism, vtkTriangularCoordinates, vtkResampleThroughHomeomorphism:
    name = kind.__name__
    for ghosts in 0, 1:
        algorithm = make(kind)
        counts = [count(make(kind), piece, processes, ghosts) for piece in range(processes)]
        count(algorithm, rank, processes, ghosts)
        check_equal(algorithm.GetNumberOfOutsidePoints(), counts[rank], name + "'s own count")
        for controller_given in None, controller, None:
            algorithm.ReduceStatistics(controller_given)
            check_equal(algorithm.GetNumberOfOutsidePoints(), sum(counts), name + "'s total")
    # Only one process executes again.
    if rank == processes - 1:
        algorithm.Modified()
        algorithm.UpdatePiece(rank, processes, ghosts)
        check_equal(algorithm.GetNumberOfOutsidePoints(), counts[rank], name + "'s new count")
    algorithm.ReduceStatistics(None)
    check_equal(algorithm.GetNumberOfOutsidePoints(), sum(counts), name + "'s new total")

    # The last process has no data, unless it is the only one.
    algorithm = make(kind)
    idle = rank == processes - 1 > 0
    if not idle:
        algorithm.UpdatePiece(rank, processes, 0)
    algorithm.ReduceStatistics(None)
    counts = [count(make(kind), piece, processes, 0) for piece in range(processes)]
    check_equal(algorithm.GetNumberOfOutsidePoints(), sum(counts[:max(1, processes - 1)]),
                name + "'s total without an idle process")

# The first process has an error.
vtkObject.GlobalWarningDisplayOff()
for kind in vtkDifferentiableHomeomorphism, vtkResampleThroughHomeomorphism:
    algorithm = make(kind)
    set_meshes(algorithm, refused if rank == 0 else target)
    algorithm.UpdatePiece(rank, processes, 0)
    check_equal(algorithm.GetNumberOfOutsidePoints() == -1, rank == 0, "a refusal")
    algorithm.ReduceStatistics(None)
    check_equal(algorithm.GetNumberOfOutsidePoints(), -1, kind.__name__ + "'s total after an error")
vtkObject.GlobalWarningDisplayOn()


def measured(algorithm):
    return (algorithm.GetNumberOfBoundaryEdges(), algorithm.GetNumberOfDifferentiableEdges(),
            algorithm.GetNumberOfCreases(), algorithm.GetNumberOfUndecidedEdges(),
            algorithm.GetNumberOfFeatures(algorithm.SPOKE, algorithm.CREASE), algorithm.GetLargestJump())


def continuity():
    algorithm = set_meshes(vtkJacobianContinuity())
    algorithm.SetCoordinateSystem(algorithm.CONTOUR)
    algorithm.SetCenterPoint(algorithm.INCENTER)
    algorithm.SpokesOn()
    return algorithm


# Measurements are part of the first piece.
alone = continuity()
alone.Update()
check_equal(measured(alone)[:1] + measured(alone)[2:3], (4, 4), "what is measured by one process")
algorithm = continuity()
algorithm.UpdatePiece(rank, processes, 0)
check_equal(measured(algorithm) == measured(alone), rank == 0, "what is measured by each")
for _ in range(2):
    algorithm.ReduceStatistics(None)
    check_equal(measured(algorithm), measured(alone), "what is measured by all")
mapped = make(vtkDifferentiableHomeomorphism)
mapped.SetCoordinateSystem(mapped.CONTOUR)
mapped.SetCenterPoint(mapped.INCENTER)
mapped.GetJacobianContinuity().SpokesOn()
mapped.MeasureContinuityOn()
mapped.UpdatePiece(rank, processes, 0)
mapped.ReduceStatistics(None)
check_equal(measured(mapped.GetJacobianContinuity()), measured(alone), "what a map measures")

if rank == 0:
    print(f"The counts are the same in {processes} processes")
controller.Finalize(1)
