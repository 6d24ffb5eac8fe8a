# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of triangulations, read from files, made from landmarks, and written to files."""

from dataclasses import dataclass, field, replace
from typing import Optional

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from . import images, landmarks, meshes, tinshift, xmorph
from .arrays import add_array, as_points, make_mesh, points_of, triangles_of
from .files import FILE, USAGE, Failure, Input, format_of, inform, quote
from .landmarks import Landmarks

FORMATS = ("json", "vtp", "vtk")  # formats for both meshes in one file


@dataclass
class Pair:
    """Two meshes with the same triangles."""

    meshes: list  # source and target, vtkPolyData
    names: list  # their files
    shift: Optional[tinshift.Shift] = None  # the contents of the triangulation file, for a pair from such a file
    extents: Optional[list] = None  # for xmorph meshes: the largest x and y of their images, or None if unknown
    metadata: dict = field(default_factory=dict)  # metadata for writing a triangulation file
    landmarks: Optional[Landmarks] = None  # the landmarks that the pair was made from

    source = property(lambda self: self.meshes[0])
    target = property(lambda self: self.meshes[1])

    @property
    def name(self):
        return " and ".join(dict.fromkeys(self.names))

    def name_of(self, side):
        return self.names[side] if len(set(self.names)) > 1 else f"the {('source', 'target')[side]} of {self.name}"

    def crs(self, inverse=False):
        """The coordinate reference systems of points and images: None if unknown, "" for pixels."""
        pixels = "" if self.landmarks and self.landmarks.crs else None
        both = self.metadata.get("input_crs") or pixels, self.metadata.get("output_crs") or None
        return both[::-1] if inverse else both

    def compare_crs(self, crs, inverse):
        """Prints a warning if the coordinate reference system of --crs is not that of the images."""
        known = self.crs(inverse)[1]
        if crs and known and not are_same_crs(crs, known):
            inform(f"{self.name} maps to {quote(known)}. The result gets {crs} (--crs), but its coordinates are not "
                   "converted.")

    def require_flat(self):
        for mesh, name in zip(self.meshes, self.names):
            if numpy.ptp(points_of(mesh)[:, 2]) != 0:
                raise Failure(f"{name} does not lie in a plane parallel to the x and y axes.")

    def fit(self, grids, rasters):
        """Scales xmorph meshes to the pixel grids of source and target, and moves the origin of rasters with landmarks
        to the upper left corner. `rasters` maps 0 (source) and 1 (target) to rasters. Raises Failure if they do not
        overlap their meshes."""
        for side, (grid, end) in enumerate(zip(grids, self.extents or ())):
            if end is None or not (numpy.asarray(end) > 0).all():
                raise Failure(f"{self.names[side]} does not cover its image, whose size is not known: give the size of "
                              "xmorph's working image (--working-size).", USAGE)
            # The largest coordinate of xmorph is that of the last pixel.
            points = points_of(self.meshes[side])[:, :2] * ((numpy.array(grid.size) - 1) / end)
            self.meshes[side] = make_mesh(points, self.meshes[side].GetPolys())
        for side, raster in rasters.items():
            raster.grid = raster.grid.hanging() if self.landmarks else raster.grid
            images.require_overlap(raster.grid, raster.name, self.meshes[side], self.name_of(side))


def are_same_crs(first, second):
    """Whether two coordinate reference systems are the same; by their names if pyproj does not know them."""
    try:
        import pyproj

        return pyproj.CRS(first) == pyproj.CRS(second)
    except Exception:
        return str(first).lower() == str(second).lower()


def read(files, options):
    """The pair in one file or two. `options` has the options of options.pair_files."""
    formats = [options.format or "json" if name == "-" else format_of(name) for name in files]
    if len(files) == 1:
        return _read_one(files[0], options)
    if "json" in formats:
        name = files[formats.index("json")]
        raise Failure(f"{name} is a triangulation file, which has both source and target: give no other mesh.", USAGE)
    if "mesh" in formats:
        return _read_xmorph(files, options)
    return Pair([read_mesh(name, options.format) for name in files], list(files))


def _read_one(name, options):
    with Input(name, options.format or "json") as file:
        names = [file.name, file.name]
        if landmarks.is_landmark_file(file.path):
            return from_landmarks(landmarks.read(file, options), file.name, options)[0]
        if file.format == "json":
            shift = tinshift.read(file)
            both = [make_mesh(points, shift.triangles) for points in (shift.source, shift.target)]
            return Pair(both, names, shift=shift, metadata=shift.metadata)
        source = meshes.read(file)
    positions = source.GetPointData().GetArray(options.target_array)
    if positions is None or positions.GetNumberOfComponents() not in (2, 3):
        raise Failure(f'{names[0]} has no point array "{options.target_array}" of 2 or 3 components with the target\'s '
                      "positions: give the target's file, too, or the array's name (--target-array).", USAGE)
    target = vtkPolyData()
    target.CopyStructure(source)
    target.SetPoints(as_points(vtk_to_numpy(positions).astype(float))[0])
    return Pair([source, target], names)


def from_landmarks(marks, name, options, **more):
    """The pair made from landmarks, and the IsomorphicTriangulation. Landmarks in images are in pixels, y downwards;
    they become coordinates of images.Grid.hanging(). Prints a summary."""
    grids = options.grids[0], None if marks.crs else options.grids[1]
    made = landmarks.triangulate(marks, name, grids, **more)
    metadata = {"output_crs": marks.crs} if marks.crs else {}
    return Pair([make_mesh(p, made.triangles) for p in made[:2]], [name, name], None, None, metadata, marks), made


def read_mesh(name, format=""):
    """A single mesh; for a triangulation file, the source."""
    with Input(name, format or "json") as file:
        if file.format != "json":
            return meshes.read(file)
        shift = tinshift.read(file)
        return make_mesh(shift.source, shift.triangles)


def _read_xmorph(files, options):
    grids, extents = [], []
    for name in files:
        with Input(name, options.format) as file:
            try:
                grid = xmorph.read(file.path)
            except ValueError as error:
                file.fail(str(error))
        end = xmorph.extent(grid) if xmorph.fills_picture(grid) else None
        if options.working_size:
            # Coordinates of meshes are in tenths of pixels.
            end = 10.0 * (numpy.array(options.working_size) - 1)
        extents.append(end)
        # Let y point upwards.
        bottom = (xmorph.extent(grid) if end is None else end)[1]
        grids.append(numpy.stack((grid[..., 0], bottom - grid[..., 1]), axis=-1))
    try:
        triangles = xmorph.triangulate(*grids)
    except ValueError as error:
        raise Failure(f"{' and '.join(files)}: {error}", FILE) from None
    return Pair([make_mesh(grid.reshape(-1, 2), triangles) for grid in grids], list(files), extents=extents)


def write(pair, output):
    """Writes both meshes to one file in one of FORMATS, the target as the point array Target."""
    points = [points_of(mesh) for mesh in pair.meshes]
    if output.format != "json":
        both = vtkPolyData()
        both.ShallowCopy(pair.source)
        add_array(both, "Target", points[1])
        meshes.write(both, output)
        return
    for name, array in zip(pair.names, points):
        if array[:, 2].any():
            raise Failure(f"A triangulation file (.json) has only x and y, but z is not 0 everywhere in {name}.")
    shift = pair.shift or tinshift.Shift(*(array[:, :2] for array in points), triangles_of(pair.source))
    output.write_bytes(tinshift.text_of(replace(shift, metadata=pair.metadata)).encode("utf-8", "surrogateescape"))
