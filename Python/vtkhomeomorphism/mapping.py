# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Use of the filters by the commands: settings, errors, and the additions of PROJ's triangulation files to the map
(heights, points outside, the distance from the piecewise linear map on the ground)."""

from dataclasses import dataclass, replace

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from . import meshes
from .arrays import CENTERS, SYSTEMS, configure
from .files import REFUSED, Failure, inform
from .vtkfiles import take_messages
from .vtkFiltersHomeomorphism import vtkDifferentiableHomeomorphism

MASK = "vtkValidPointMask"


@dataclass
class Settings:
    """The options of the map."""

    system: str = ""
    """A key of SYSTEMS. If empty, Smooth; for triangulation files Linear, which is their official meaning."""
    incenter: bool = False
    linear_where_discordant: bool = False
    mask_invalid: bool = False
    tolerance: float = 0.0

    def system_for(self, pair):
        return self.system or ("linear" if pair.shift else "smooth")

    def apply(self, algorithm, system=""):
        center = CENTERS["incenter" if self.incenter else "centroid"]
        configure(algorithm, SYSTEMS[system or self.system or "smooth"], center, self.linear_where_discordant)
        algorithm.SetMaskInvalidTriangles(self.mask_invalid)
        if hasattr(algorithm, "SetTolerance"):
            algorithm.SetTolerance(self.tolerance)


def run(algorithm, name=""):
    """Updates a filter. Raises Failure with its errors, and passes its warnings on."""
    take_messages()
    errors = []

    def collect(caller, event, text=""):
        errors.append(text.split("): ", 1)[-1].strip())

    collect.CallDataType = "string0"
    tags = [
        (algorithm, algorithm.AddObserver("ErrorEvent", collect)),
        (algorithm.GetExecutive(), algorithm.GetExecutive().AddObserver("ErrorEvent", lambda *_: None)),
    ]
    algorithm.Update()
    for item, tag in tags:
        item.RemoveObserver(tag)
    prefix = name + ": " if name else ""
    if errors or algorithm.GetErrorCode() != 0:
        raise Failure(prefix + "\n".join(errors or [take_messages()]), REFUSED)
    warnings = take_messages()
    if warnings:
        inform(prefix + warnings)
    return algorithm.GetOutputDataObject(0)


def as_data(points):
    """Points as vtkPolyData."""
    data = vtkPolyData()
    data.SetPoints(meshes.as_points(points))
    return data


def arrays_of(data):
    """Numeric point arrays by name, without vtkGhostType."""
    attributes = data.GetPointData()
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
    return {a.GetName(): vtk_to_numpy(a) for a in arrays if a is not None and a.GetName() != "vtkGhostType"}


class PointMap:
    """The map of a pair, for points and data."""

    def __init__(self, pair, settings, inverse=False):
        self.pair, self.settings, self.inverse = pair, settings, inverse
        self.system = settings.system_for(pair)
        self.outside = 0
        self.filter = self._make(self.system)

    def _make(self, system):
        algorithm = vtkDifferentiableHomeomorphism()
        self.settings.apply(algorithm, system)
        algorithm.SetSourceData(self.pair.source)
        algorithm.SetTargetData(self.pair.target)
        algorithm.SetInverse(self.inverse)
        algorithm.SetOutputPointsPrecision(algorithm.DOUBLE_PRECISION)
        return algorithm

    def map_data(self, data):
        """A data object with moved points, whose point arrays include the mask and others requested of the filter."""
        self.filter.SetDataObject(data)
        try:
            result = run(self.filter, self.pair.name)
        except Failure:
            from . import report

            # All kinds of defects; the filter reports the first only.
            report.refuse(self.pair)
            raise
        self.outside = self.filter.GetNumberOfOutsidePoints()
        return result

    def map_points(self, points):
        """Images of points of shape (n, 2) or (n, 3), NaN outside, and arrays with one element per point by name:
        vtkValidPointMask, those requested of the filter, and `Fallback` for a file with a fallback strategy. For a
        triangulation file, the third coordinate is a height."""
        shift = self.pair.shift
        with_ids = self.filter.GetComputeTriangleId()
        if shift:
            self.filter.ComputeTriangleIdOn()
        result = self.map_data(as_data(points[:, :2] if shift else points))
        arrays = arrays_of(result)
        mask = arrays[MASK] != 0
        images = meshes.points_of(result)[:, : points.shape[1]].copy()
        images[~mask] = numpy.nan
        if shift:
            self._shift(points, images, mask, arrays)
            self.filter.SetComputeTriangleId(with_ids)
            if not with_ids:
                del arrays["TriangleId"]
            self._report_deviation(points, images)
        return images, arrays

    def _shift(self, points, images, mask, arrays):
        """Maps heights and points outside like PROJ."""
        shift, cells = self.pair.shift, arrays["TriangleId"].astype(numpy.int64)
        flat = points[:, :2]
        if shift.fallback != "none":
            outside = numpy.flatnonzero(~mask & numpy.isfinite(flat).all(axis=1))
            nearest = shift.nearest(flat[outside], self.inverse)
            outside, nearest = outside[nearest >= 0], nearest[nearest >= 0]
            cells[outside] = nearest
            weights = shift.weights(flat[outside], nearest, self.inverse)
            images[outside, :2] = shift.interpolate(
                shift.source if self.inverse else shift.target, weights, nearest
            )
            arrays["Fallback"] = numpy.zeros(len(points), numpy.uint8)
            arrays["Fallback"][outside] = 1
        if not shift.horizontal:
            images[cells >= 0, :2] = flat[cells >= 0]
        if points.shape[1] == 3:
            images[:, 2] = numpy.where(cells >= 0, points[:, 2], numpy.nan)
            if shift.offsets is not None:
                inside = numpy.flatnonzero(cells >= 0)
                # By the position in the source, in both directions.
                places = images if self.inverse else points
                weights = shift.weights(places[inside, :2], cells[inside])
                change = shift.interpolate(shift.offsets, weights, cells[inside])
                images[inside, 2] += -change if self.inverse else change

    def _report_deviation(self, points, images):
        """Informs of the largest distance from Linear, the official meaning of a triangulation file, in meters if
        the coordinate reference system is known."""
        if not self.pair.shift or self.system == "linear" or not len(points):
            return
        linear = PointMap(self.pair, replace(self.settings, system="linear"), self.inverse).map_points(points[:, :2])[0]
        distances, unit = ground_distances(images[:, :2], linear, self.pair.shift.crs(self.inverse))
        if numpy.isfinite(distances).any():
            worst = int(numpy.nanargmax(distances))
            inform(
                f"{self.system.capitalize()} is farthest from Linear, the official meaning of {self.pair.names[0]}, at "
                f"point {worst}: {distances[worst]:.4g} {unit}."
            )


def ground_distances(a, b, crs):
    """Distances of points, and their unit: meters, if the coordinate reference system can be looked up by pyproj or
    is one of the usual geographic codes."""
    difference = a - b
    geographic, factor = False, None
    if crs:
        try:
            import pyproj

            axis = pyproj.CRS(crs).axis_info[0]
            geographic = pyproj.CRS(crs).is_geographic
            factor = axis.unit_conversion_factor
        except Exception:
            geographic = str(crs).upper().startswith(("EPSG:4", "OGC:CRS84")) and numpy.nanmax(numpy.abs(b)) <= 360
    if geographic:
        # Degrees on a sphere of the earth's mean radius.
        difference = numpy.radians(difference) * 6371008.8
        difference[:, 0] *= numpy.cos(numpy.radians(b[:, 1]))
        return numpy.hypot(*difference.T), "meters"
    distances = numpy.hypot(*difference.T)
    return (distances, "units of the target") if factor is None else (distances * factor, "meters")


def flat_copy(data, z=None):
    """A copy of a point set with z = 0, or with the given z."""
    result = data.NewInstance()
    result.ShallowCopy(data)
    points = meshes.points_of(data).copy()
    points[:, 2] = 0 if z is None else z
    result.SetPoints(meshes.as_points(points))
    return result


def named_array(values, name):
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    return array
