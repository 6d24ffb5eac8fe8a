# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Use of the filters by the commands: settings, errors, and the additions of PROJ's triangulation files to the map
(heights, points outside, the distance from the piecewise linear map on the ground)."""

from dataclasses import dataclass, field, replace

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk

from .arrays import MASK, arrays_of, configure, make_mesh, points_of, update
from .files import Failure, inform
from .vtkfiles import take_messages
from .vtkFiltersHomeomorphism import vtkDifferentiableHomeomorphism


@dataclass
class Settings:
    """The options of the map."""

    system: str = ""
    """A key of SYSTEMS. If empty, the default of the command and the pair."""
    mask_invalid: bool = False
    options: dict = field(default_factory=dict)
    """Further options of arrays.configure."""

    def choose(self, pair, default="smooth"):
        """The settings with a system: for triangulation files Linear, which is their official meaning, otherwise the
        default, but Smooth where Cubic is the default of a surface. Informs of a system that the user did not choose."""
        if self.system:
            return self
        system, why = default, ""
        if pair.shift:
            system, why = "linear", ", the official meaning of a triangulation file"
        elif default == "cubic" and not pair.is_planar():
            system, why = "smooth", ", because cubic maps meshes in a plane only"
        inform(f"The coordinate system is {system}{why} (--system).")
        return replace(self, system=system)

    def set_up(self, algorithm, pair=None):
        """The filter, with the options of the map, and the pair if it takes one."""
        configure(algorithm, self.system or "smooth", **self.options)
        algorithm.SetMaskInvalidTriangles(self.mask_invalid)
        if pair:
            algorithm.SetSourceData(pair.source)
            algorithm.SetTargetData(pair.target)
        return algorithm


def run(algorithm, name):
    """Updates a filter. Raises Failure with its errors, and passes its warnings on."""
    take_messages()
    try:
        result = update(algorithm)
    except ValueError as error:
        raise Failure(f"{name}: {error}") from None
    warnings = take_messages()
    if algorithm.GetErrorCode() != 0:
        raise Failure(f"{name}: {warnings}")
    if warnings:
        inform(f"{name}: {warnings}")
    return result


def add_array(data, name, values):
    """Adds a point array."""
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    data.GetPointData().AddArray(array)


class PointMap:
    """The map of a pair, for points and data."""

    def __init__(self, pair, settings, inverse=False):
        self.pair, self.settings, self.inverse, self.outside = pair, settings, inverse, 0
        self.filter = settings.set_up(vtkDifferentiableHomeomorphism(), pair)
        self.filter.SetInverse(inverse)
        self.filter.SetOutputPointsPrecision(self.filter.DOUBLE_PRECISION)

    def map_data(self, data):
        """A data object with moved points, whose point arrays include the mask and others requested of the filter."""
        self.filter.SetDataObject(data)
        try:
            result = run(self.filter, self.pair.name)
        except Failure:
            from . import report

            # All kinds of defects; the filter reports the first only.
            report.require_map(self.pair)
            raise
        self.outside = self.filter.GetNumberOfOutsidePoints()
        return result

    def map_points(self, points):
        """Images of points of shape (n, 2) or (n, 3), NaN outside, and arrays with one element per point by name:
        vtkValidPointMask, those requested of the filter, and `Fallback` for a file with a fallback strategy. For a
        triangulation file, the third coordinate is a height."""
        shift, with_ids = self.pair.shift, self.filter.GetComputeTriangleId()
        self.filter.SetComputeTriangleId(with_ids or shift is not None)
        result = self.map_data(make_mesh(points[:, :2] if shift else points))
        self.filter.SetComputeTriangleId(with_ids)
        arrays = arrays_of(result.GetPointData())
        images = points_of(result)[:, : points.shape[1]].copy()
        images[arrays[MASK] == 0] = numpy.nan
        if shift:
            cells = arrays["TriangleId"] if with_ids else arrays.pop("TriangleId")
            outside = shift.complete(points, images, cells.astype(numpy.int64), self.inverse)
            if outside is not None:
                arrays["Fallback"] = outside
            if self.settings.system != "linear" and len(points):
                self._report_deviation(points, images)
        return images, arrays

    def _report_deviation(self, points, images):
        """Informs of the largest distance from Linear, the official meaning of a triangulation file, in meters if
        the coordinate reference system is known."""
        linear = PointMap(self.pair, replace(self.settings, system="linear"), self.inverse).map_points(points[:, :2])[0]
        distances, unit = ground_distances(images[:, :2], linear, self.pair.shift.crs(self.inverse))
        if numpy.isfinite(distances).any():
            worst = numpy.nanargmax(distances)
            inform(f"{self.settings.system.capitalize()} is farthest from Linear, the official meaning of "
                   f"{self.pair.names[0]}, at point {worst}: {distances[worst]:.4g} {unit}.")


def ground_distances(a, b, crs):
    """Distances of points, and their unit: meters, if pyproj knows the coordinate reference system."""
    try:
        import pyproj

        crs = pyproj.CRS(crs)
        if crs.is_geographic:
            return crs.get_geod().inv(*a.T, *b.T)[2], "meters"
        return numpy.hypot(*(a - b).T) * crs.axis_info[0].unit_conversion_factor, "meters"
    except Exception:
        return numpy.hypot(*(a - b).T), "units of the target"
