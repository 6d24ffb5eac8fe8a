# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The class Homeomorphism, for numpy arrays, and conversions between numpy and VTK."""

from __future__ import annotations

import functools
import inspect
import itertools
import math
import operator
import re
import threading
import warnings
from typing import Optional, Tuple

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData

from .vtkFiltersHomeomorphism import (
    vtkDifferentiableHomeomorphism, vtkJacobianContinuity, vtkResampleThroughHomeomorphism, vtkTriangularCoordinates,
)

MASK = "vtkValidPointMask"
OPTIONS = {"MaskInvalidTriangles": "mask_invalid", "DiscordantTriangles": "discordant_by_linear",
           "FairnessRefinement": "fairness_refinement", "CubicBending": "cubic_bending", "Tolerance": "tolerance"}
"""The names of options in messages of filters, and those of this module."""


def values_of(kind, *names: str) -> dict:
    """The values of constants of a VTK class, by their names in lower case."""
    return {name: getattr(kind, name.upper()) for name in names}


SYSTEMS = values_of(vtkDifferentiableHomeomorphism, "linear", "contour", "smooth", "cubic")
BENDINGS = values_of(vtkDifferentiableHomeomorphism, "local", "least")
CENTERS = values_of(vtkDifferentiableHomeomorphism, "centroid", "incenter")


def choose(names: dict, value: str, what: str) -> int:
    """The value of a name, in upper or lower case. Raises ValueError."""
    try:
        return names[value.lower()]
    except (KeyError, AttributeError):
        raise ValueError(f"{what} must be one of {', '.join(names)}, not {value!r}") from None


def configure(
    algorithm,
    system: str = "smooth",
    *,
    center: str = "centroid",
    discordant_by_linear: bool = False,
    tolerance: float = 0.0,
    cubic_bending: str = "least",
    maximum_deviation: Optional[float] = None,
    fairness_refinement: int = 0,
    mask_invalid: bool = False,
):
    """Sets the options of the map in a filter of the module. See Homeomorphism for the options."""
    if maximum_deviation is not None and not maximum_deviation > 0:
        raise ValueError(f"maximum_deviation must be positive, not {maximum_deviation!r}")
    algorithm.SetCoordinateSystem(choose(SYSTEMS, system, "system"))
    algorithm.SetCenterPoint(choose(CENTERS, center, "center"))
    algorithm.SetDiscordantTriangles(algorithm.USE_LINEAR if discordant_by_linear else algorithm.REFUSE)
    algorithm.SetTolerance(tolerance)
    algorithm.SetCubicBending(choose(BENDINGS, cubic_bending, "cubic_bending"))
    algorithm.SetMaximumDeviation(math.inf if maximum_deviation is None else maximum_deviation)
    algorithm.SetFairnessRefinement(fairness_refinement)
    algorithm.SetMaskInvalidTriangles(mask_invalid)


def as_array(values) -> numpy.ndarray:
    """The values as an array. Masked values become NaN."""
    if numpy.ma.is_masked(values):
        return values.astype(numpy.result_type(values, numpy.float32)).filled(numpy.nan)
    return numpy.asarray(values)


def as_points(points, what: str = "points") -> Tuple[vtkPoints, int]:
    """vtkPoints and the number of coordinates per point. Contiguous arrays of shape (n, 3) are not copied."""
    array = as_array(points)
    if array.dtype not in (numpy.float32, numpy.float64):
        if array.dtype.kind not in "biuf":
            raise TypeError(f"{what} must be an array of numbers, not of {array.dtype}")
        array = array.astype(numpy.float64)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise ValueError(f"{what} must have the shape (n, 2) or (n, 3), not {array.shape}")
    dimension = array.shape[1]
    if dimension == 2:
        array = numpy.column_stack((array, numpy.zeros(len(array), array.dtype)))
    result = vtkPoints()
    # vtkPoints adopts the type of the array, and numpy_to_vtk keeps a reference to shared memory.
    result.SetData(numpy_to_vtk(numpy.ascontiguousarray(array)))
    return result, dimension


def as_cells(polygons) -> vtkCellArray:
    """The cells of an array of point ids of shape (m, k), or of a list of polygons."""
    if isinstance(polygons, numpy.ndarray):
        sizes, ids = numpy.full(len(polygons), polygons.shape[1]), polygons.ravel()
    else:
        sizes, ids = list(map(len, polygons)), list(itertools.chain(*polygons))
    arrays = (numpy.concatenate(([0], numpy.cumsum(sizes))), ids)
    cells = vtkCellArray()
    cells.SetData(*(numpy_to_vtkIdTypeArray(numpy.array(a, numpy.int64), deep=True) for a in arrays))
    return cells


def make_mesh(points, polygons=(), what: str = "points") -> vtkPolyData:
    """A mesh of points, of shape (n, 2) or (n, 3), and polygons."""
    mesh = vtkPolyData()
    mesh.SetPoints(as_points(points, what)[0])
    mesh.SetPolys(polygons if isinstance(polygons, vtkCellArray) else as_cells(polygons))
    return mesh


def points_of(data) -> numpy.ndarray:
    """The points of a point set, of shape (n, 3), float64."""
    points = data.GetPoints()
    return numpy.empty((0, 3)) if points is None else numpy.asarray(vtk_to_numpy(points.GetData()), numpy.float64)


def triangles_of(mesh) -> numpy.ndarray:
    """The point ids of a mesh of triangles, a copy of shape (m, 3)."""
    return vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(numpy.int64)


def add_array(data, name: str, values, of_cells: bool = False):
    """Adds a point or a cell array. Contiguous values are not copied."""
    # numpy_to_vtk ignores the byte order.
    array = numpy_to_vtk(numpy.ascontiguousarray(values, values.dtype.newbyteorder("=")))
    array.SetName(name)
    (data.GetCellData() if of_cells else data.GetPointData()).AddArray(array)


def arrays_of(attributes) -> dict:
    """Numeric arrays of point or cell data by name, without vtkGhostType."""
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
    return {a.GetName(): vtk_to_numpy(a) for a in arrays if a is not None and a.GetName() != "vtkGhostType"}


def rename(text, options) -> str:
    """The text with options renamed."""
    return re.sub("|".join(options), lambda name: options[name[0]], text)


def update(algorithm, options=OPTIONS, warn=functools.partial(warnings.warn, stacklevel=2)):
    """Updates a filter and returns its output. Raises ValueError with its errors instead of printing them, and calls
    `warn` with its warnings. In both, options are renamed."""
    own, others, warned = [], [], []

    def collect(caller, event, text):
        # Remove VTK's prefix, the position in the C++ source.
        texts = warned if event == "WarningEvent" else own if caller is algorithm else others
        texts.append(rename(text.split("): ", 1)[-1].strip(), options))

    collect.CallDataType = "string0"
    tags = [(sender, sender.AddObserver(event, collect)) for sender in (algorithm, algorithm.GetExecutive())
            for event in ("ErrorEvent", "WarningEvent")]
    algorithm.Update()
    for sender, tag in tags:
        sender.RemoveObserver(tag)
    if own or others:
        # The executive also reports that the algorithm failed.
        raise ValueError("\n".join(own or others))
    for text in warned:
        warn(text)
    return algorithm.GetOutputDataObject(0)


class Homeomorphism:
    """The homeomorphism between the domains of two isomorphic triangulations, and its inverse.

    Parameters
    ----------
    source, target : array of shape (n, 2) or (n, 3)
        Points of the two triangulations, in a plane or on surfaces in 3-space. The distance of a point from the plane
        is preserved by the map.
    triangles : array of int of shape (m, 3)
        Point ids of the triangles, the same in both triangulations.
    system : {"smooth", "linear", "contour", "cubic"}
        The coordinate system, see vtkDifferentiableHomeomorphism. "cubic" maps only planar meshes.
    center : {"centroid", "incenter"}
        The point where contours start. "contour" only.
    discordant_by_linear : bool
        Map discordant triangles by the Linear system instead of raising an error. "contour" only. Default: False.
    tolerance : float
        The largest distance from the domain at which points are mapped, relative to the diagonal of the domain. 0
        (default) allows only for rounding.
    cubic_bending : {"least", "local"}
        The map of least bending, or one in closed form. "cubic" only.
    maximum_deviation : float, optional
        The largest distance of images from those in the Linear system, in the target's units. "smooth" and "cubic"
        only. Default: unlimited.
    fairness_refinement : int
        The number of times that triangles are first divided into four, 0 (default) to 4. "cubic" with "least" only.
    mask_invalid : bool
        Leave out invalid triangles instead of raising an error. Default: False.

    Attributes
    ----------
    source, target : array of shape (n, 2) or (n, 3)
    triangles : array of int of shape (m, 3)

    The images of points outside the domain are NaN, and so are those of points in triangles in which a Cubic map is not
    certified (a warning states the number of these triangles). Invalid meshes raise ValueError with a message that
    lists the triangles. Masked elements of arrays are treated as NaN. Several threads may use an object at the same
    time; their calls are executed one after the other, and each call is itself parallel.
    """

    def __init__(self, source, target, triangles, system: str = "smooth", **options):
        cells = numpy.asarray(triangles)
        if cells.ndim != 2 or cells.shape[1] != 3 or cells.dtype.kind not in "iu":
            raise ValueError(f"triangles must be integers with the shape (m, 3), not {cells.dtype} with {cells.shape}")
        # Copy the points, so that they cannot change after validation.
        self._meshes = [make_mesh(as_array(points).copy(), cells, what)
                        for points, what in ((source, "source"), (target, "target"))]
        self._dimensions = [numpy.shape(points)[1] for points in (source, target)]
        self._system, self._options, self._lock = system, options, threading.RLock()
        self._filter = self._set_up(vtkDifferentiableHomeomorphism())
        self._filter.TransformActiveAttributesOff()
        self._filter.BlankOutsideOff()
        self._filter.SetOutputPointsPrecision(self._filter.DOUBLE_PRECISION)
        # Report invalid meshes now.
        self._run(numpy.empty((0, 3)), False)

    @classmethod
    def from_landmarks(cls, source, target, system: str = "smooth", **options):
        """The homeomorphism of isomorphic triangulations made from landmarks, arrays of shape (n, 2) or (n, 3). It maps
        the landmarks of the source to those of the target. `options` are those of `isomorphic_triangulation` and of
        this class. Warns of landmarks that are probably wrong. By default, the domain extends beyond the landmarks by
        half their spacing."""
        from .isomorphic import isomorphic_triangulation

        own = {name: options.pop(name) for name in list(options) if name in inspect.signature(configure).parameters}
        pair = isomorphic_triangulation(source, target, **options)
        suspicious = pair.suspicious().tolist()
        if suspicious:
            warnings.warn(f"landmarks that are probably wrong, the worst first: {suspicious}", stacklevel=2)
        return cls(pair.source, pair.target, pair.triangles, system, **own)

    def _set_up(self, algorithm):
        algorithm.SetSourceData(self._meshes[0])
        if not isinstance(algorithm, vtkTriangularCoordinates):
            algorithm.SetTargetData(self._meshes[1])
        configure(algorithm, self._system, **self._options)
        return algorithm

    def _points(self, side: int) -> numpy.ndarray:
        """A copy in its own precision, on which the rounding that is allowed depends."""
        return vtk_to_numpy(self._meshes[side].GetPoints().GetData())[:, :self._dimensions[side]].copy()

    @property
    def source(self) -> numpy.ndarray:
        return self._points(0)

    @property
    def target(self) -> numpy.ndarray:
        return self._points(1)

    @property
    def triangles(self) -> numpy.ndarray:
        return triangles_of(self._meshes[0])

    def __reduce__(self):
        make = functools.partial(Homeomorphism, system=self._system, **self._options)
        return make, (self.source, self.target, self.triangles)

    def _run(self, points, inverse: bool):
        """The filter's output, and the dimensions of points and images."""
        self._filter.SetDataObject(make_mesh(points))
        self._filter.SetInverse(inverse)
        dimension = numpy.shape(points)[1]
        return update(self._filter), dimension, self._dimensions[0 if inverse else 1] if dimension == 2 else dimension

    def _map(self, points, inverse: bool) -> numpy.ndarray:
        with self._lock:
            output, _, dimension = self._run(points, inverse)
            result = points_of(output)[:, :dimension].copy()
            result[vtk_to_numpy(output.GetPointData().GetArray(MASK)) == 0] = numpy.nan
        return result

    def __call__(self, points) -> numpy.ndarray:
        """The images of points of the source's domain, of shape (n, 2) or (n, 3): float64 of the same shape (of shape
        (n, 3) if the target is in 3-space); NaN outside."""
        return self._map(points, False)

    def inverse(self, points) -> numpy.ndarray:
        """The preimages of points of the target's domain, as __call__; NaN outside."""
        return self._map(points, True)

    def jacobian(self, points, inverse: bool = False) -> numpy.ndarray:
        """The derivative of the map at points of the source's domain, or of the inverse at points of the target's:
        float64 of shape (n, k, d), for points with d coordinates and images with k. Element [i, j, l] is the partial
        derivative of coordinate j of the image of point i with respect to coordinate l. NaN outside."""
        with self._lock:
            self._filter.ComputeJacobianOn()
            try:
                output, columns, rows = self._run(points, inverse)
            finally:
                self._filter.ComputeJacobianOff()
            jacobian = vtk_to_numpy(output.GetPointData().GetArray("Jacobian"))
            return numpy.array(jacobian.reshape(-1, 3, 3)[:, :rows, :columns])

    def coordinates(self, points):
        """The triangular coordinates of points of the source's domain, four arrays of shape (n,): triangle (-1
        outside), e (1 to 3; 0 outside), p and c (0 to 1; NaN outside). Not for the Cubic system."""
        algorithm = self._set_up(vtkTriangularCoordinates())
        algorithm.GenerateLinesOff()
        algorithm.SetDataObject(make_mesh(points))
        arrays = arrays_of(update(algorithm).GetPointData())
        return tuple(arrays[name].copy() for name in ("TriangleId", "EdgeLabel", "EdgeParameter", "ContourParameter"))

    def continuity(self, samples: int = 5):
        """Measures from values of the map whether it is differentiable across the interior edges, at `samples` points
        of each edge. Returns a dict of arrays with one element per edge (`JacobianJump`, `JacobianJumpError`,
        `Verdict`, `EdgeTriangles`, ...; see vtkJacobianContinuity)."""
        algorithm = self._set_up(vtkJacobianContinuity())
        algorithm.SetSamplesPerEdge(samples)
        return {name: array.copy() for name, array in arrays_of(update(algorithm).GetCellData()).items()}

    def warp_image(self, image, shape: Optional[Tuple[int, int]] = None, *, spacing: float = 1.0,
                   background: float = 0.0, inverse: bool = False) -> numpy.ndarray:
        """Warps an image from the source's domain to the target's: interpolates it linearly at the preimages of the
        pixels.

        Parameters
        ----------
        image : array of shape (rows, columns) or (rows, columns, channels)
            Pixel [row, column] is at the point (column, row) times `spacing` in the source's plane.
        shape : (rows, columns)
            Shape of the result; by default that of the image. Its pixels are at points of the target's plane likewise.
        spacing : float
            The distance of neighboring pixels, in units of the meshes.
        background : float
            Value of pixels outside.
        inverse : bool
            Whether the image covers the target's domain, and the result the source's.

        Returns an array of the image's type. Integers are rounded. In an image of bool, values of at least 0.5 become
        True.
        """
        if numpy.ma.is_masked(image) and image.dtype.kind != "f":
            raise TypeError(f"masked pixels of {image.dtype} have no value: fill them, or convert the image to float")
        array = as_array(image)
        if array.dtype.kind not in "biuf":
            raise TypeError(f"image must be an array of real numbers, not of {array.dtype}; warp complex ones in parts")
        if array.ndim not in (2, 3) or not array.size:
            raise ValueError(f"image must have the shape (rows, columns[, channels]), not {array.shape}")
        rows, columns, channels = numpy.atleast_3d(array).shape
        out_rows, out_columns = map(operator.index, shape or array.shape[:2])
        if min(out_rows, out_columns) < 1:
            raise ValueError(f"shape must be positive, not {shape}")
        if not (spacing > 0 and math.isfinite(spacing)):
            raise ValueError(f"spacing must be a positive number, not {spacing}")
        if max(out_rows, out_columns) > numpy.iinfo(numpy.int32).max:
            raise MemoryError(f"an image of {out_rows} x {out_columns} pixels is too large")
        # VTK aborts the process if there is not enough memory for values, mask and points.
        numpy.empty((out_rows, out_columns, channels + 4))
        # VTK supports integers, float32 and float64.
        known = array.dtype.kind in "iu" or array.dtype in (numpy.float32, numpy.float64)
        vtk_image = vtkImageData()
        vtk_image.SetDimensions(columns, rows, 1)
        vtk_image.SetSpacing(spacing, spacing, 1.0)
        add_array(vtk_image, "Values", (array if known else array.astype(numpy.float64)).reshape(-1, channels))
        algorithm = self._set_up(vtkResampleThroughHomeomorphism())
        algorithm.SetDataObject(vtk_image)
        algorithm.SetInverse(inverse)
        algorithm.BlankOutsideOff()
        algorithm.TransformActiveAttributesOff()
        algorithm.SetSamplingDimensions(out_columns, out_rows)
        algorithm.SetSamplingBounds(0.0, spacing * (out_columns - 1), 0.0, spacing * (out_rows - 1))
        output = arrays_of(update(algorithm).GetPointData())
        warped = output["Values"].copy()
        if array.dtype.kind in "iu":
            limits = numpy.iinfo(array.dtype)
            background = min(max(round(background), limits.min), limits.max)
        warped[output[MASK] == 0] = background
        warped = warped.reshape((out_rows, out_columns) + array.shape[2:])
        return warped >= 0.5 if array.dtype.kind == "b" else warped.astype(array.dtype)
