# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Homeomorphisms between two triangulations for numpy arrays."""

from __future__ import annotations

import inspect
import itertools
import math
import operator
from typing import Optional, Tuple

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData

from .vtkFiltersHomeomorphism import (
    vtkDifferentiableHomeomorphism,
    vtkJacobianContinuity,
    vtkResampleThroughHomeomorphism,
    vtkTriangularCoordinates,
)


def _values(*names: str) -> dict:
    return {name: getattr(vtkDifferentiableHomeomorphism, name.upper()) for name in names}


SYSTEMS = _values("linear", "contour", "smooth", "cubic")
BENDINGS = _values("local", "least")
CENTERS = _values("centroid", "incenter")


def _choose(names: dict, value: str, what: str) -> int:
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
):
    """Sets the options of the map, those of Homeomorphism, in a filter of the module."""
    algorithm.SetCoordinateSystem(_choose(SYSTEMS, system, "system"))
    algorithm.SetCenterPoint(_choose(CENTERS, center, "center"))
    algorithm.SetDiscordantTriangles(
        algorithm.USE_LINEAR if discordant_by_linear else algorithm.REFUSE
    )
    algorithm.SetTolerance(tolerance)
    algorithm.SetCubicBending(_choose(BENDINGS, cubic_bending, "cubic_bending"))
    if maximum_deviation is not None:
        if not maximum_deviation > 0:
            raise ValueError(f"maximum_deviation must be positive, not {maximum_deviation!r}")
        algorithm.SetMaximumDeviation(maximum_deviation)
    algorithm.SetFairnessRefinement(fairness_refinement)


def _as_points(points, what: str) -> Tuple[vtkPoints, int]:
    """Returns vtkPoints and the number of coordinates per point. Shares the memory of contiguous (n, 3)
    arrays of float32 and float64."""
    array = numpy.asarray(points)
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
    result.SetDataType(10 if array.dtype == numpy.float32 else 11)
    # numpy_to_vtk keeps a reference to the shared array.
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


def _as_triangles(triangles, points: int) -> vtkCellArray:
    array = numpy.asarray(triangles)
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "iu":
        raise ValueError(
            "triangles must be an array of integers with the shape (m, 3), "
            f"not {array.dtype} with {array.shape}"
        )
    if array.size and (array.min() < 0 or array.max() >= points):
        raise ValueError(
            f"triangles must have point numbers from 0 to {points - 1}; "
            f"they go from {array.min()} to {array.max()}"
        )
    return as_cells(array)


def _rebuild(source, target, triangles, system, options):
    return Homeomorphism(source, target, triangles, system, **options)


def _cast(values: numpy.ndarray, dtype) -> numpy.ndarray:
    """Float64 values as another type: rounded to integers and clipped to their limits; half and more is True."""
    if dtype.kind == "b":
        return values >= 0.5
    if dtype.kind not in "iu":
        return values.astype(dtype)
    limits = numpy.iinfo(dtype)
    rounded = numpy.rint(numpy.nan_to_num(values))
    # The largest 64-bit integers are not exact in float64, so compare them without conversion.
    low, high = rounded <= limits.min, rounded >= limits.max
    result = numpy.where(low | high, 0, rounded).astype(dtype)
    result[low], result[high] = limits.min, limits.max
    return result


def update(algorithm):
    """Updates a filter and returns its output. Raises ValueError with its errors instead of printing them."""
    errors = []

    def collect(caller, event, text=""):
        # Without VTK's prefix, the position in the C++ source.
        errors.append(text.split("): ", 1)[-1].strip())

    collect.CallDataType = "string0"
    # Skip the executive's message that the algorithm failed.
    observers = ((algorithm, collect), (algorithm.GetExecutive(), lambda *_: None))
    tags = [(sender, sender.AddObserver("ErrorEvent", observer)) for sender, observer in observers]
    algorithm.Update()
    for sender, tag in tags:
        sender.RemoveObserver(tag)
    if errors:
        raise ValueError("\n".join(errors))
    return algorithm.GetOutputDataObject(0)


class Homeomorphism:
    """The homeomorphism between the domains of two isomorphic triangulations, and its inverse.

    Parameters
    ----------
    source, target : array of shape (n, 2) or (n, 3)
        Points of the two triangulations, in the plane or on surfaces in 3-space. In the plane, z is the
        distance from it and is preserved.
    triangles : array of int of shape (m, 3)
        Point ids of the triangles, the same in both.
    system : {"smooth", "linear", "contour", "cubic"}
        The coordinate system. See vtkDifferentiableHomeomorphism.
    center : {"centroid", "incenter"}
        Start of the contours of the Contour system.
    discordant_by_linear : bool
        Map discordant triangles by the Linear system instead of raising an error (Contour only).
    tolerance : float
        Greatest distance of a mapped point from the domain, relative to the diagonal of the domain.
        0 allows for rounding only.
    cubic_bending : str
        Of the Cubic system: "least", which bends least, or "local", in closed form.
    maximum_deviation : float, optional
        Of the Smooth and the Cubic system: the greatest distance of images from those of the Linear
        system, in the target's units.
    fairness_refinement : int
        Of the Cubic system with least bending: how often triangles are cut into four first.

    The Cubic system maps meshes in a plane only.

    Points outside the domain become NaN. Invalid meshes raise ValueError with a message that lists the
    triangles. An object must not be used by several threads at a time; each call is itself parallel.
    """

    def __init__(self, source, target, triangles, system: str = "smooth", **options):
        self._meshes, self._dimensions = [], []
        for points, what in ((source, "source"), (target, "target")):
            # A copy, so that validated points cannot change.
            vtk_points, dimension = _as_points(numpy.array(points), what)
            mesh = vtkPolyData()
            mesh.SetPoints(vtk_points)
            self._dimensions.append(dimension)
            self._meshes.append(mesh)
        sizes = [mesh.GetNumberOfPoints() for mesh in self._meshes]
        if sizes[0] != sizes[1]:
            raise ValueError(
                f"source has {sizes[0]} points, target {sizes[1]}: they must correspond one to one"
            )
        cells = _as_triangles(triangles, sizes[0])
        for mesh in self._meshes:
            mesh.SetPolys(cells)
        self._system, self._options = system, options
        self._filter = self._set_up(vtkDifferentiableHomeomorphism())
        self._filter.TransformActiveAttributesOff()
        self._filter.BlankOutsideOff()
        self._filter.SetOutputPointsPrecision(self._filter.DOUBLE_PRECISION)
        # Report invalid meshes at once.
        self._run(numpy.empty((0, 3)), False)

    @classmethod
    def from_landmarks(cls, source, target, system: str = "smooth", **options):
        """The homeomorphism that takes landmarks to landmarks, through isomorphic triangulations made
        for them. Options of `isomorphic_triangulation` and of this class are understood."""
        from .isomorphic import isomorphic_triangulation

        names = inspect.signature(configure).parameters
        own = {name: options.pop(name) for name in list(options) if name in names}
        pair = isomorphic_triangulation(source, target, **options)
        return cls(pair.source, pair.target, pair.triangles, system, **own)

    def _set_up(self, algorithm):
        algorithm.SetSourceData(self._meshes[0])
        algorithm.SetTargetData(self._meshes[1])
        configure(algorithm, self._system, **self._options)
        return algorithm

    def __reduce__(self):
        arrays = [
            vtk_to_numpy(mesh.GetPoints().GetData())[:, :dimension]
            for mesh, dimension in zip(self._meshes, self._dimensions)
        ]
        triangles = vtk_to_numpy(self._meshes[0].GetPolys().GetConnectivityArray()).reshape(-1, 3)
        return _rebuild, (*arrays, triangles, self._system, self._options)

    def _run(self, points, inverse: bool):
        vtk_points, dimension = _as_points(points, "points")
        data = vtkPolyData()
        data.SetPoints(vtk_points)
        self._filter.SetDataObject(data)
        self._filter.SetInverse(inverse)
        return update(self._filter), dimension

    def _map(self, points, inverse: bool) -> numpy.ndarray:
        output, dimension = self._run(points, inverse)
        dimension = self._image_dimension(dimension, inverse)
        result = numpy.array(vtk_to_numpy(output.GetPoints().GetData())[:, :dimension])
        mask = vtk_to_numpy(output.GetPointData().GetArray("vtkValidPointMask"))
        result[mask == 0] = numpy.nan
        return result

    def __call__(self, points) -> numpy.ndarray:
        """Images of points of the source's domain: float64, of shape (n, 2) or (n, 3); NaN outside."""
        return self._map(points, False)

    def inverse(self, points) -> numpy.ndarray:
        """Preimages of points of the target's domain; NaN outside."""
        return self._map(points, True)

    def jacobian(self, points, inverse: bool = False) -> numpy.ndarray:
        """The derivative of the map at points of the source's domain, or of the inverse at points of the
        target's: float64 of shape (n, k, d) for points of d coordinates whose images have k. Element
        [i, j, l] is the partial derivative of coordinate j of the image of point i with respect to
        coordinate l. NaN outside."""
        self._filter.ComputeJacobianOn()
        try:
            output, dimension = self._run(points, inverse)
        finally:
            self._filter.ComputeJacobianOff()
        jacobian = vtk_to_numpy(output.GetPointData().GetArray("Jacobian"))
        rows = self._image_dimension(dimension, inverse)
        return numpy.array(jacobian.reshape(-1, 3, 3)[:, :rows, :dimension])

    def _image_dimension(self, dimension: int, inverse: bool) -> int:
        return self._dimensions[0 if inverse else 1] if dimension == 2 else dimension

    def coordinates(self, points):
        """Triangular coordinates of points of the source's domain: triangle (-1 outside), e (1 to 3; 0
        outside), p and c (NaN outside); four arrays of shape (n,)."""
        algorithm = vtkTriangularCoordinates()
        algorithm.SetSourceData(self._meshes[0])
        configure(algorithm, self._system, **self._options)
        algorithm.GenerateLinesOff()
        data = vtkPolyData()
        data.SetPoints(_as_points(points, "points")[0])
        algorithm.SetDataObject(data)
        arrays = update(algorithm).GetPointData()
        return tuple(
            numpy.array(vtk_to_numpy(arrays.GetArray(name)))
            for name in ("TriangleId", "EdgeLabel", "EdgeParameter", "ContourParameter")
        )

    def continuity(self, samples: int = 5):
        """Measures whether the map is differentiable across the interior edges, from its values. Returns a dict
        of arrays with one element per edge (`JacobianJump`, `JacobianJumpError`, `Verdict`,
        `EdgeTriangles`, ...; see vtkJacobianContinuity)."""
        algorithm = self._set_up(vtkJacobianContinuity())
        algorithm.SetSamplesPerEdge(samples)
        arrays = update(algorithm).GetCellData()
        return {
            arrays.GetArrayName(i): numpy.array(vtk_to_numpy(arrays.GetArray(i)))
            for i in range(arrays.GetNumberOfArrays())
        }

    def warp_image(
        self,
        image,
        shape: Optional[Tuple[int, int]] = None,
        *,
        spacing: float = 1.0,
        background: float = 0.0,
        inverse: bool = False,
    ) -> numpy.ndarray:
        """Warps an image of the source's domain to the target's: samples it at the exact preimages of the
        pixels, with linear interpolation.

        Parameters
        ----------
        image : array of shape (rows, columns) or (rows, columns, channels)
            Pixel [row, column] is the point (column, row) times `spacing` of the source's plane.
        shape : (rows, columns)
            Shape of the result; that of the image by default. Its pixels are points of the target's plane in
            the same way.
        background : float
            Value of pixels outside.
        inverse : bool
            The image covers the target's domain instead, and the result the source's.

        Returns an array of the type of the image. Integers are rounded, values of a mask of at least 0.5
        become True, and the parts of complex numbers are interpolated separately.
        """
        array = numpy.asarray(image)
        if array.ndim not in (2, 3):
            raise ValueError(
                f"image must have the shape (rows, columns) or (rows, columns, channels), "
                f"not {array.shape}"
            )
        if array.dtype.kind not in "biufc":
            raise TypeError(f"image must be an array of numbers, not of {array.dtype}")
        if array.dtype.kind == "c":
            options = {"shape": shape, "spacing": spacing, "inverse": inverse}
            background = complex(background)
            return (
                self.warp_image(array.real, background=background.real, **options)
                + 1j * self.warp_image(array.imag, background=background.imag, **options)
            ).astype(array.dtype)
        rows, columns = array.shape[:2]
        channels = array.shape[2] if array.ndim == 3 else 1
        out_rows, out_columns = (operator.index(n) for n in (shape if shape else (rows, columns)))
        if min(rows, columns, channels, out_rows, out_columns) < 1:
            raise ValueError(f"there are no pixels in {array.shape}, or in the shape {shape}")
        if not (spacing > 0 and math.isfinite(spacing)):
            raise ValueError(f"spacing must be a number greater than 0, not {spacing}")
        if max(out_rows, out_columns) > numpy.iinfo(numpy.int32).max:
            raise MemoryError(f"an image of {out_rows} x {out_columns} pixels is too large")
        # VTK aborts if there is not enough memory for values, mask and points.
        numpy.empty((out_rows, out_columns, channels + 4))
        vtk_image = vtkImageData()
        vtk_image.SetDimensions(columns, rows, 1)
        vtk_image.SetSpacing(spacing, spacing, 1.0)
        # Interpolate as float64, so that small integers are rounded only once.
        values = numpy_to_vtk(
            numpy.ascontiguousarray(array, numpy.float64).reshape(-1, channels), deep=1
        )
        values.SetName("Values")
        vtk_image.GetPointData().SetScalars(values)
        algorithm = self._set_up(vtkResampleThroughHomeomorphism())
        algorithm.SetDataObject(vtk_image)
        algorithm.SetInverse(inverse)
        algorithm.BlankOutsideOff()
        algorithm.TransformActiveAttributesOff()
        algorithm.SetSamplingDimensions(out_columns, out_rows)
        algorithm.SetSamplingBounds(
            0.0, spacing * (out_columns - 1), 0.0, spacing * (out_rows - 1)
        )
        output = update(algorithm).GetPointData()
        warped = numpy.array(vtk_to_numpy(output.GetArray("Values"))).reshape(
            (out_rows, out_columns) + array.shape[2:]
        )
        mask = vtk_to_numpy(output.GetArray("vtkValidPointMask")).reshape(out_rows, out_columns)
        warped[mask == 0] = background
        return _cast(warped, array.dtype)
