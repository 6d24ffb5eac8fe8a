# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Use of the filters by the commands: settings, errors, and the parts of PROJ's triangulation files that the filters do
not support (heights, the fallback strategy, the distance from the piecewise linear map in meters)."""

from dataclasses import replace

import numpy
from vtkmodules.util.vtkConstants import VTK_DOUBLE, VTK_FLOAT
from vtkmodules.vtkCommonDataModel import vtkPointSet

from . import report
from .arrays import MASK, add_array, arrays_of, as_points, configure, make_mesh, points_of, update
from .files import Failure, inform, inform_once
from .vtkfiles import leaves_of, take_messages
from .vtkFiltersHomeomorphism import vtkDifferentiableHomeomorphism


def choose_system(settings, pair, default="smooth"):
    """The options of the map, with a system. If none was chosen, it is Linear for triangulation files, which is their
    official meaning, otherwise the default; then it is printed."""
    if settings["system"]:
        return settings
    system, why = ("linear", ", the official meaning of a triangulation file") if pair.shift else (default, "")
    inform(f"The coordinate system is {system}{why} (--system).")
    return {**settings, "system": system}


def set_up(algorithm, settings, pair=None):
    """The filter, with the options of the map, and with the pair if there is one."""
    configure(algorithm, **{**settings, "system": settings["system"] or "smooth"})
    if pair:
        algorithm.SetSourceData(pair.source)
        algorithm.SetTargetData(pair.target)
    return algorithm


def run(algorithm, name):
    """Updates a filter. Raises Failure with its errors, and prints its warnings."""
    take_messages()
    warned = []
    try:
        result = update(algorithm, report.OPTIONS, warned.append)
    except ValueError as error:
        raise Failure(f"{name}: {error}") from None
    for text in filter(None, (*warned, take_messages())):
        # Tiles and frames are mapped by the same map, or by similar ones.
        inform_once(f"{name}: {text}")
    return result


def find_inactive_vectors(data):
    """Names of floating-point arrays of 3 components that are not active attributes."""
    return list(dict.fromkeys(
        array.GetName() for leaf in leaves_of(data) for attributes in (leaf.GetPointData(), leaf.GetCellData())
        for i, array in enumerate(map(attributes.GetArray, range(attributes.GetNumberOfArrays())))
        if array and array.GetNumberOfComponents() == 3 and array.GetDataType() in (VTK_FLOAT, VTK_DOUBLE)
        and attributes.IsArrayAnAttribute(i) < 0))


class PointMap:
    """The map of a pair, for points and data."""

    moves = True  # whether points are moved, or only arrays are added

    def __init__(self, pair, settings, inverse=False):
        self.pair, self.settings, self.inverse, self.outside = pair, settings, inverse, 0
        self.domain, self.name, self.shift = pair.meshes[inverse], pair.names[inverse], pair.shift
        self.filter = set_up(vtkDifferentiableHomeomorphism(), settings, pair)
        self.filter.SetInverse(inverse)
        self.filter.SetOutputPointsPrecision(self.filter.DOUBLE_PRECISION)

    def map_data(self, data):
        """A data object with moved points. Its point arrays include the mask and the arrays requested from the filter.
        For a triangulation file, the third coordinate is a height, and points mapped by the fallback strategy have 1 in
        the array Fallback."""
        kept = find_inactive_vectors(data)
        if kept and self.filter.GetTransformActiveAttributes() and not self.filter.GetTransformAllInputVectors():
            inform(f"Inactive arrays are not transformed: {', '.join(kept)} (--vectors all transforms them).")
        shift = self.shift if isinstance(data, vtkPointSet) else None
        requested = self.filter.GetComputeTriangleId()
        if shift:
            points = points_of(data)
            flat = data.NewInstance()
            flat.ShallowCopy(data)
            flat.SetPoints(as_points(points[:, :2])[0])
        self.filter.SetComputeTriangleId(requested or shift is not None)
        self.filter.SetDataObject(flat if shift else data)
        try:
            result = run(self.filter, self.pair.name)
        except Failure:
            # Report all kinds of defects; the filter reports only the first.
            report.require_map(self.pair)
            raise
        self.filter.SetComputeTriangleId(requested)
        self.outside = self.filter.GetNumberOfOutsidePoints()
        if shift:
            self._complete(result, points)
            if not requested:
                result.GetPointData().RemoveArray("TriangleId")
        return result

    def _complete(self, result, points):
        """Adds heights and the fallback of a triangulation file, and prints the largest distance from Linear, its
        official meaning, in meters if the coordinate reference system is known."""
        images = points_of(result).copy()
        cells = arrays_of(result.GetPointData())["TriangleId"].astype(numpy.int64)
        fallback = self.shift.complete(points, images, cells, self.inverse)
        result.SetPoints(as_points(images)[0])
        if fallback is not None:
            add_array(result, "Fallback", fallback)
        if self.settings["system"] == "linear" or not len(points):
            return
        linear = PointMap(replace(self.pair, shift=None), {**self.settings, "system": "linear"}, self.inverse)
        official = linear.map_points(points[:, :2])[0]
        distances, unit = ground_distances(images[:, :2], official, self.pair.crs(self.inverse)[1])
        if numpy.isfinite(distances).any():
            worst = numpy.nanargmax(distances)
            inform(f"{self.settings['system'].capitalize()} is farthest from Linear, the official meaning of "
                   f"{self.pair.names[0]}, at point {worst}: {distances[worst]:.4g} {unit}.")

    def map_points(self, points):
        """Images of points of shape (n, 2) or (n, 3), NaN outside, and the arrays of map_data by name (with an array z
        if points of two coordinates have images of three)."""
        dimension = points.shape[1]
        if dimension == 2 and numpy.ptp(points_of(self.domain)[:, 2]) > 0:
            inform(f"{self.name} is not parallel to the x and y axes, but the points have no z; 0 is used.")
        result = self.map_data(make_mesh(points))
        arrays, images = arrays_of(result.GetPointData()), points_of(result).copy()
        images[(arrays[MASK] == 0) & (arrays.get("Fallback", 0) == 0)] = numpy.nan
        if dimension == 2 and numpy.nan_to_num(images[:, 2]).any():
            arrays = {"z": images[:, 2], **arrays}
        return images[:, :dimension], arrays


def ground_distances(a, b, crs):
    """Distances between points, and their unit: meters, if pyproj knows the coordinate reference system."""
    try:
        import pyproj

        crs = pyproj.CRS(crs)
        if crs.is_geographic:
            return crs.get_geod().inv(*a.T, *b.T)[2], "meters"
        return numpy.hypot(*(a - b).T) * crs.axis_info[0].unit_conversion_factor, "meters"
    except Exception:
        return numpy.hypot(*(a - b).T), "units of the target"
