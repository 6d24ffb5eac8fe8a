# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Isomorphic triangulations from landmarks, outlines and constraint segments, for numpy arrays."""

from __future__ import annotations

import contextlib
import functools
from typing import NamedTuple, Optional, Sequence, Tuple

import numpy
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .arrays import arrays_of, as_array, as_cells, choose, make_mesh, points_of, triangles_of, update, values_of
from .vtkFiltersHomeomorphism import vtkIsomorphicTriangulation

QUALITIES = values_of(vtkIsomorphicTriangulation, "minimum_angle", "concordance", "distortion", "non_obtuse")
DOMAINS = values_of(vtkIsomorphicTriangulation, "automatic", "outline", "frame", "convex_hull")


class IsomorphicTriangulation(NamedTuple):
    """A pair of triangulations with the same triangles."""

    source: numpy.ndarray
    """Shape (n, 2) or (n, 3): the landmarks, unchanged and in their order, then points of a frame and added points."""
    target: numpy.ndarray
    triangles: numpy.ndarray
    """Shape (m, 3), int64."""
    residuals: numpy.ndarray
    """For each landmark, the distance in the target from its prediction by a smooth map through its neighbors. Near the
    border of the landmarks, where predictions are less certain, it is reduced accordingly."""
    added_points: int
    """The number of added points, without those of a frame."""
    left_out: list
    """Tuples (number, reason) of the segments that were left out because they conflict with others."""
    report: dict
    """Statistics: smallest_angles (of source and target, in degrees), shares_of_angles_below_10_15_20 (fractions in the
    worse domain), obtuse_share and discordant_share (fractions of triangles that are obtuse, or discordant, in at least
    one domain), largest_distortion and largest_distortion_triangle."""

    def suspicious(self) -> numpy.ndarray:
        """The indices of at most ten landmarks whose residuals exceed usual_residual(), the worst first."""
        worst = numpy.argsort(-self.residuals, kind="stable")[:10]
        return worst[self.residuals[worst] > self.usual_residual()]

    def usual_residual(self) -> float:
        """The limit of usual residuals: six times their 80 % quantile, but at least 1e-5 of the spacing."""
        landmarks = self.target[: len(self.residuals)]
        spacing = numpy.linalg.norm(numpy.ptp(landmarks, axis=0)) / len(landmarks) ** 0.5
        usual = numpy.sort(self.residuals)[4 * (len(landmarks) - 1) // 5]
        return max(6 * usual, 1e-5 * spacing)


def rectangle(low, high, count):
    """Points along the boundary of a rectangle, `count` on each side."""
    t = numpy.arange(count)[:, None] / count
    corners = numpy.array([low, [high[0], low[1]], high, [low[0], high[1]]])
    return numpy.vstack([a * (1 - t) + b * t for a, b in zip(corners, numpy.roll(corners, -1, axis=0))])


def within(source, target, rims, make):
    """The pair whose domain is bounded by additional points, the rims of source and target."""
    points = [numpy.vstack(both) for both in zip((source, target), rims)]
    return make(*points, outlines=[range(len(source), len(points[0]))], domain="outline")


def _smooth_frame(source, target, frame, trusted, smooth):
    """Points along the boundary of a rectangle, which is enlarged to include all landmarks and then by 1 %, and their
    images: under the quadratic polynomial that fits trusted landmarks best, corrected by a thin-plate spline, if
    `smooth`, otherwise under the best affine map."""
    low = numpy.minimum(frame[::2], source.min(axis=0))
    high = numpy.maximum(frame[1::2], source.max(axis=0))
    low, high = low - 0.01 * (high - low), high + 0.01 * (high - low)
    rim = rectangle(low, high, 8)
    trusted = trusted[:: 1 + len(trusted) // 1000]
    middle, size = (low + high) / 2, numpy.hypot(*(high - low))
    a, b = (source[trusted] - middle) / size, (rim - middle) / size
    values = target[trusted] - target[trusted[0]]

    def columns(points, bends):
        x, y = points.T
        return numpy.column_stack((numpy.ones(len(x)), x, y) + ((x * x, x * y, y * y) if bends else ()))

    def bending(points):
        squares = numpy.maximum(((points[:, None] - a) ** 2).sum(axis=2), 1e-300)
        return numpy.hstack((squares * numpy.log(squares), columns(points, False)))

    # The quadratic part describes bending of the whole figure, which continues beyond the landmarks.
    bends = smooth and len(a) >= 12
    weights = numpy.linalg.lstsq(columns(a, bends), values, rcond=None)[0]
    images = columns(b, bends) @ weights + target[trusted[0]]
    if smooth:
        system = numpy.vstack((bending(a), numpy.hstack((columns(a, False).T, numpy.zeros((3, 3))))))
        rest = numpy.vstack((values - columns(a, bends) @ weights, numpy.zeros((3, 2))))
        images += bending(b) @ numpy.linalg.lstsq(system, rest, rcond=None)[0]
    return rim, images


def _with_frame(source, target, frame, make):
    """The pair with the predicted image of the source's frame, or with automatic frames if that is not possible."""
    source, target = (numpy.asarray(as_array(points), float) for points in (source, target))
    first = make(source, target)
    trusted = numpy.flatnonzero(first.residuals <= first.usual_residual())
    for smooth in (True, False):
        frames = _smooth_frame(source, target, numpy.asarray(frame, float), trusted, smooth)
        with contextlib.suppress(ValueError):
            return within(source, target, frames, make)._replace(residuals=first.residuals)
    return first


def _figure(points, outlines, segments, names, what: str) -> vtkPolyData:
    figure = vtkPolyData()
    if isinstance(points, vtkPolyData):
        figure.ShallowCopy(points)
    else:
        # Copy the points, so that they cannot change.
        figure.ShallowCopy(make_mesh(as_array(points).copy(), outlines, what))
        figure.SetLines(as_cells(segments))
    called = vtkStringArray()
    for name in names:
        called.InsertNextValue(name)
    figure.GetPointData().SetPedigreeIds(called)
    return figure


def isomorphic_triangulation(
    source,
    target,
    *,
    outlines: Sequence[Sequence[int]] = (),
    segments: Sequence[Sequence[int]] = (),
    frame: Optional[Tuple[Sequence[float], Optional[Sequence[float]]]] = None,
    domain: str = "automatic",
    quality: str = "minimum_angle",
    target_minimum_angle: float = 0.0,
    maximum_added_points: Optional[int] = None,
    maximum_triangle_size: float = 0.0,
    leave_out_conflicting_segments: bool = False,
    names: Sequence[str] = (),
) -> IsomorphicTriangulation:
    """Triangulates two drawings of a figure (source and target) with the same triangles.

    Parameters
    ----------
    source, target : array of shape (n, 2) or (n, 3)
        Corresponding points. In 3-space, the points of each drawing must lie in a plane. Or two vtkPolyData with the
        same cells: polygons and closed lines are outlines, and other lines are segments.
    outlines : sequence of sequences of int
        Closed polygons of point ids: outlines, holes, islands in holes. The first point may be repeated at the end.
        Default: the domain is a frame around the points.
    segments : sequence of sequences of int
        Polygonal lines of point ids that must become edges.
    frame : pair of (smallest x, largest x, smallest y, largest y)
        Rectangles around source and target, for example those of images. If that of the target is None, it is the image
        of the source's, enlarged by 1 %, under a smooth map through landmarks that are not suspicious (only in the
        plane, and without outlines). Default: automatic frames.
    domain : {"automatic", "outline", "frame", "convex_hull"}
        "automatic": the interior of the outlines if there are any, otherwise a frame.
    quality : {"minimum_angle", "concordance", "distortion", "non_obtuse"}
        The quality measure that is optimized, see vtkIsomorphicTriangulation.
    target_minimum_angle : float
        Points are added until no angle is smaller than this, in degrees, 0 to 60. 0 (default): only necessary points
        are added.
    maximum_added_points : int, optional
        The largest number of added points. None: as many as necessary, and up to 100 more for target_minimum_angle.
    maximum_triangle_size : float
        Triangles with more than this fraction of the area of their domain are divided, 0 to 1. 0 (default): triangles
        are not divided.
    leave_out_conflicting_segments : bool
        Leave out segments that conflict with others, as few as possible, instead of raising ValueError. Default: False.
    names : sequence of str
        The names of the first points in messages; the other points are identified by their numbers.

    Returns an IsomorphicTriangulation. Raises ValueError, with a message that names the points, if the figure has no
    isomorphic triangulations.
    """
    for name, value, largest in (("target_minimum_angle", target_minimum_angle, 60),
                                 ("maximum_triangle_size", maximum_triangle_size, 1),
                                 ("maximum_added_points", maximum_added_points or 0, numpy.inf)):
        if not 0 <= value <= largest:
            raise ValueError(f"{name} must be a number from 0 to {largest}, not {value}")
    for box in frame or ():
        if box is not None and not (box[0] < box[1] and box[2] < box[3]):
            raise ValueError(f"frame must be (smallest x, largest x, smallest y, largest y), not {box}")
    if frame is not None and frame[1] is None:
        return _with_frame(source, target, frame[0], functools.partial(
            isomorphic_triangulation, segments=segments, quality=quality,
            target_minimum_angle=target_minimum_angle, maximum_added_points=maximum_added_points,
            maximum_triangle_size=maximum_triangle_size,
            leave_out_conflicting_segments=leave_out_conflicting_segments, names=names))
    # Rings may name their first point again at the end.
    outlines = [ring[:-1] if len(ring) > 3 and ring[0] == ring[-1] else ring for ring in map(list, outlines)]
    if domain == "automatic" and not isinstance(source, vtkPolyData):
        domain = "outline" if len(outlines) else "frame"
    algorithm = vtkIsomorphicTriangulation()
    algorithm.SetSourceData(_figure(source, outlines, segments, names, "source"))
    algorithm.SetTargetData(_figure(target, outlines, segments, names, "target"))
    if frame is not None:
        algorithm.SetSourceFrame(*frame[0])
        algorithm.SetTargetFrame(*frame[1])
    algorithm.SetDomain(choose(DOMAINS, domain, "domain"))
    algorithm.SetQuality(choose(QUALITIES, quality, "quality"))
    algorithm.SetTargetMinimumAngle(target_minimum_angle)
    algorithm.SetMaximumNumberOfAddedPoints(-1 if maximum_added_points is None else maximum_added_points)
    algorithm.SetMaximumTriangleSize(maximum_triangle_size)
    algorithm.SetLeaveOutConflictingSegments(leave_out_conflicting_segments)
    update(algorithm)
    outputs = [algorithm.GetOutput(0), algorithm.GetOutput(1)]
    dimension = max(2 if numpy.shape(points)[1:] == (2,) else 3 for points in (source, target))
    arrays = arrays_of(outputs[0].GetPointData())
    left_out = [(algorithm.GetLeftOutCell(i), algorithm.GetLeftOutMessage(i))
                for i in range(algorithm.GetNumberOfLeftOutSegments())]
    return IsomorphicTriangulation(
        *(points_of(mesh)[:, :dimension].copy() for mesh in outputs), triangles_of(outputs[0]),
        arrays["LandmarkResidual"][arrays["OriginalPointId"] >= 0], algorithm.GetNumberOfAddedPoints(), left_out,
        {
            "smallest_angles": algorithm.GetSmallestAngles(),
            "shares_of_angles_below_10_15_20": algorithm.GetSharesOfSmallAngles(),
            "obtuse_share": algorithm.GetObtuseShare(),
            "discordant_share": algorithm.GetDiscordantShare(),
            "largest_distortion": algorithm.GetLargestDistortion(),
            "largest_distortion_triangle": algorithm.GetLargestDistortionCell(),
        },
    )
