# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of triangulations, read from files, made from landmarks, and written to files."""

from dataclasses import dataclass, field, replace
from typing import Optional

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from . import landmarks, meshes, tinshift, xmorph
from .arrays import as_points, make_mesh, points_of
from .files import FILE, USAGE, Failure, Input, format_of
from .landmarks import Landmarks
from .mapping import add_array

FORMATS = ("json", "vtp", "vtk")
"""Formats that hold both meshes."""


@dataclass
class Pair:
    """Two meshes with the same triangles."""

    meshes: list
    """Source and target, vtkPolyData."""
    names: list
    """Their files."""
    shift: Optional[tinshift.Shift] = None
    """The shift, for a pair from a triangulation file."""
    extents: Optional[list] = None
    """For xmorph meshes: the largest x and y of their images, or None if unknown."""
    metadata: dict = field(default_factory=dict)
    """Metadata for writing a triangulation file."""
    landmarks: Optional[Landmarks] = None
    """The landmarks that the pair was made from."""

    @property
    def source(self):
        return self.meshes[0]

    @property
    def target(self):
        return self.meshes[1]

    @property
    def name(self):
        return " and ".join(dict.fromkeys(self.names))

    def name_of(self, side):
        return self.names[side] if self.names[0] != self.names[1] else f"the {('source', 'target')[side]} of {self.names[0]}"

    def is_planar(self):
        """Whether the meshes are in planes, to the rounding of their coordinates."""
        from .report import Report

        report = Report(self)
        return bool(report["SourcePlanar"] == report["TargetPlanar"] == 1)

    def require_flat(self):
        for mesh, name in zip(self.meshes, self.names):
            if numpy.ptp(points_of(mesh)[:, 2]) != 0:
                raise Failure(f"{name} is not in a plane parallel to x and y.")


def read(files, options):
    """The pair in one file or two. `options` has target_array, target_uv, format and working_size."""
    if len(files) == 1:
        return _read_one(files[0], options)
    formats = [options.format or "json" if name == "-" else format_of(name) for name in files]
    if "json" in formats:
        name = files[formats.index("json")]
        raise Failure(f"{name} is a triangulation file, which has both source and target: give it alone.", USAGE)
    if formats.count("mesh") == 1:
        raise Failure("Either both files are meshes of xmorph (.mesh) or neither: they are triangulated together.", USAGE)
    if "mesh" in formats:
        return _read_xmorph(files, options)
    pair = Pair([read_mesh(name, options.format) for name in files], list(files))
    if formats == ["stl", "stl"]:
        _join_points(pair)
    return pair


def _read_one(name, options):
    with Input(name, options.format or "json") as file:
        names = [file.name, file.name]
        if landmarks.is_landmark_file(file.path):
            return from_landmarks(landmarks.read(file, options), file.name, options)[0]
        if file.format == "json":
            shift = _read_by(tinshift.read, file)
            both = [make_mesh(points, shift.triangles) for points in (shift.source, shift.target)]
            return Pair(both, names, shift=shift, metadata=shift.metadata)
        if options.target_uv:
            if file.format != "obj":
                raise Failure(f"--target-uv: only .obj files have texture coordinates, {file.name} does not.", USAGE)
            return Pair([meshes.read(file), meshes.read_uv(file)], names)
        source = meshes.read(file)
    positions = source.GetPointData().GetArray(options.target_array)
    if positions is None or positions.GetNumberOfComponents() not in (2, 3):
        more = " or take its texture coordinates (--target-uv)" if format_of(name) == "obj" else ""
        raise Failure(f'{names[0]} has no point array "{options.target_array}" of 2 or 3 components with the target\'s '
                      f"positions: give the target's file, too, or name the array (--target-array){more}.", USAGE)
    target = vtkPolyData()
    target.CopyStructure(source)
    target.SetPoints(as_points(vtk_to_numpy(positions).astype(float))[0])
    return Pair([source, target], names)


def from_landmarks(marks, name, options, **more):
    """The pair made of landmarks, and the IsomorphicTriangulation. Landmarks of images are in pixels, y down, and become
    those of images.Grid.hanging(). Says what was made."""
    made = landmarks.triangulate(marks, name, options.grids(marks), **more)
    metadata = {"output_crs": marks.crs} if marks.crs else {}
    return Pair([make_mesh(p, made.triangles) for p in made[:2]], [name, name], None, None, metadata, marks), made


def read_mesh(name, format=""):
    """A single mesh; for a triangulation file, the source."""
    with Input(name, format or "json") as file:
        if file.format == "json":
            shift = _read_by(tinshift.read, file)
            return make_mesh(shift.source, shift.triangles)
        if file.format == "mesh":
            grid = _upright(_read_by(xmorph.read, file))
            return make_mesh(grid.reshape(-1, 2), xmorph.triangulate(grid, grid))
        return meshes.read(file)


def _read_by(reader, file):
    try:
        return reader(file.path)
    except ValueError as error:
        file.fail(str(error))


def _upright(grid, bottom=None):
    """Converts to y upwards."""
    bottom = xmorph.extent(grid)[1] if bottom is None else bottom
    return numpy.stack((grid[..., 0], bottom - grid[..., 1]), axis=-1)


def _read_xmorph(files, options):
    grids, extents = [], []
    for name in files:
        with Input(name, options.format) as file:
            grid = _read_by(xmorph.read, file)
        end = xmorph.extent(grid) if xmorph.fills_picture(grid) else None
        if options.working_size:
            # Tenths of pixels.
            end = 10.0 * (numpy.array(options.working_size) - 1)
        grids.append(_upright(grid, None if end is None else end[1]))
        extents.append(end)
    try:
        triangles = xmorph.triangulate(*grids)
    except ValueError as error:
        raise Failure(f"{' and '.join(files)}: {error}", FILE) from None
    return Pair([make_mesh(grid.reshape(-1, 2), triangles) for grid in grids], list(files), extents=extents)


def _join_points(pair):
    """Merges points that coincide in both meshes, for meshes whose triangles do not share points."""
    points = [points_of(mesh) for mesh in pair.meshes]
    triangles = [meshes.triangles_of(mesh) for mesh in pair.meshes]
    if points[0].shape == points[1].shape and numpy.array_equal(*triangles):
        _, kept, joined = numpy.unique(numpy.hstack(points), axis=0, return_index=True, return_inverse=True)
        pair.meshes = [make_mesh(p[kept], joined.ravel()[triangles[0]]) for p in points]


def fit_to_pictures(pair, grids):
    """Scales xmorph meshes to their images."""
    for side, (grid, end) in enumerate(zip(grids, pair.extents or ())):
        if end is None or not (numpy.asarray(end) > 0).all():
            raise Failure(f"{pair.names[side]} does not fill its picture, and does not say how large that is: give the size "
                          "of xmorph's working picture (--working-size; in a session's file, resulting_size).", USAGE)
        # Xmorph's units end at the last pixel.
        points = points_of(pair.meshes[side])[:, :2] * ((numpy.array(grid.size) - 1) / end)
        pair.meshes[side] = make_mesh(points, pair.meshes[side].GetPolys())


def write(pair, output, target_array="Target"):
    """Writes both meshes to one file of one of FORMATS."""
    points = [points_of(mesh) for mesh in pair.meshes]
    if output.format != "json":
        both = vtkPolyData()
        both.ShallowCopy(pair.source)
        add_array(both, target_array, points[1])
        meshes.write(both, output)
        return
    for name, array in zip(pair.names, points):
        if array[:, 2].any():
            raise Failure(f"A triangulation file (.json) holds x and y only, but z is not 0 everywhere in {name}.")
    shift = pair.shift or tinshift.Shift(*(array[:, :2] for array in points), meshes.triangles_of(pair.source))
    output.write_bytes(tinshift.text_of(replace(shift, metadata=pair.metadata)).encode("utf-8", "surrogateescape"))
