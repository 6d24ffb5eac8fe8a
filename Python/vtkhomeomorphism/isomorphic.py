# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Isomorphic triangulations from landmarks, outlines and constraint segments, for numpy arrays."""

from __future__ import annotations

from typing import NamedTuple, Optional, Sequence, Tuple

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

from .arrays import _as_points, _choose, _Messages
from .vtkFiltersHomeomorphism import vtkIsomorphicTriangulation

QUALITIES = {
    "minimum_angle": vtkIsomorphicTriangulation.MINIMUM_ANGLE,
    "concordance": vtkIsomorphicTriangulation.CONCORDANCE,
    "distortion": vtkIsomorphicTriangulation.DISTORTION,
    "non_obtuse": vtkIsomorphicTriangulation.NON_OBTUSE,
}
DOMAINS = {
    "automatic": vtkIsomorphicTriangulation.AUTOMATIC,
    "outline": vtkIsomorphicTriangulation.OUTLINE,
    "frame": vtkIsomorphicTriangulation.FRAME,
    "convex_hull": vtkIsomorphicTriangulation.CONVEX_HULL,
}


class IsomorphicTriangulation(NamedTuple):
    """A pair of triangulations with the same triangles.

    source, target : array of float64 of shape (n, 2) or (n, 3)
        The landmarks, unchanged and in their order, then the corners of a frame and added points.
    triangles : array of int64 of shape (m, 3)
    residuals : array of float64
        For each landmark, the distance in the target from where a smooth map through its neighbors
        puts it without it: the largest ones are suspicious.
    added_points : int
        Number of points added, corners of a frame not counted.
    left_out : list of (int, str)
        Segments that conflict with others and why, if they were to be left out.
    """

    source: numpy.ndarray
    target: numpy.ndarray
    triangles: numpy.ndarray
    residuals: numpy.ndarray
    added_points: int
    left_out: list


def _cells(lists: Sequence[Sequence[int]], points: int, what: str) -> vtkCellArray:
    cells = vtkCellArray()
    for number, ids in enumerate(lists):
        ids = [int(i) for i in ids]
        if any(not 0 <= i < points for i in ids):
            raise ValueError(f"{what}[{number}] names a point that does not exist")
        cells.InsertNextCell(len(ids))
        for i in ids:
            cells.InsertCellPoint(i)
    return cells


def isomorphic_triangulation(
    source,
    target,
    *,
    outlines: Sequence[Sequence[int]] = (),
    segments: Sequence[Sequence[int]] = (),
    frame: Optional[Tuple[Sequence[float], Sequence[float]]] = None,
    domain: str = "automatic",
    quality: str = "minimum_angle",
    target_minimum_angle: float = 0.0,
    maximum_added_points: Optional[int] = None,
    maximum_triangle_size: float = 0.0,
    leave_out_conflicting_segments: bool = False,
) -> IsomorphicTriangulation:
    """Triangulates two drawings of a figure with the same triangles.

    Parameters
    ----------
    source, target : array of shape (n, 2) or (n, 3)
        Corresponding points; in 3-space those of each in a plane.
    outlines : sequence of sequences of int
        Closed polygons of point ids: outlines, holes, islands in holes. Without, a frame around the
        points is the domain.
    segments : sequence of sequences of int
        Polygonal lines of point ids that must become edges.
    frame : pair of (least x, largest x, least y, largest y)
        Rectangles around source and target, for example those of images.
    domain : {"automatic", "outline", "frame", "convex_hull"}
    quality : {"minimum_angle", "concordance", "distortion", "non_obtuse"}
    target_minimum_angle : float
        Points are added until no angle is smaller, in degrees. 0: only necessary points are added.
    maximum_added_points : int, optional
        How many points may be added. None: as many as necessary, and up to 100 more for
        target_minimum_angle.
    maximum_triangle_size : float
        Triangles that are larger, as a share of their domain, are divided. 0: none is.
    leave_out_conflicting_segments : bool
        Leave out segments that do not agree with shorter ones instead of raising ValueError.

    Raises ValueError with a message that names the points if the figures have no such triangulations.
    """
    algorithm = vtkIsomorphicTriangulation()
    figures = []
    dimension = 2
    for points, what in ((source, "source"), (target, "target")):
        figure = vtkPolyData()
        # A copy, so that the points cannot change.
        vtk_points, own = _as_points(numpy.array(points), what)
        dimension = max(dimension, own)
        figure.SetPoints(vtk_points)
        figures.append(figure)
    count = figures[0].GetNumberOfPoints()
    lines = _cells(segments, count, "segments")
    polygons = _cells(outlines, count, "outlines")
    for figure in figures:
        figure.SetLines(lines)
        figure.SetPolys(polygons)
    algorithm.SetSourceData(figures[0])
    algorithm.SetTargetData(figures[1])
    if frame is not None:
        algorithm.SetSourceFrame(*frame[0])
        algorithm.SetTargetFrame(*frame[1])
    algorithm.SetDomain(_choose(DOMAINS, domain, "domain"))
    algorithm.SetQuality(_choose(QUALITIES, quality, "quality"))
    algorithm.SetTargetMinimumAngle(target_minimum_angle)
    if maximum_added_points is not None:
        algorithm.SetMaximumNumberOfAddedPoints(maximum_added_points)
    algorithm.SetMaximumTriangleSize(maximum_triangle_size)
    algorithm.SetLeaveOutConflictingSegments(leave_out_conflicting_segments)
    messages = _Messages(algorithm)
    algorithm.Update()
    messages.raise_if_any()
    outputs = [algorithm.GetOutput(0), algorithm.GetOutput(1)]
    arrays = [
        numpy.array(vtk_to_numpy(mesh.GetPoints().GetData())[:, :dimension]) for mesh in outputs
    ]
    triangles = vtk_to_numpy(outputs[0].GetPolys().GetConnectivityArray()).reshape(-1, 3)
    residuals = vtk_to_numpy(outputs[0].GetPointData().GetArray("LandmarkResidual"))
    left_out = [
        (algorithm.GetLeftOutCell(i), algorithm.GetLeftOutMessage(i))
        for i in range(algorithm.GetNumberOfLeftOutSegments())
    ]
    return IsomorphicTriangulation(
        *arrays,
        numpy.array(triangles, numpy.int64),
        numpy.array(residuals[:count]),
        algorithm.GetNumberOfAddedPoints(),
        left_out,
    )
