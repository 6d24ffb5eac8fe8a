# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes in files: by VTK's readers, by meshio, and Wavefront's OBJ (whose numbers are read here in double precision,
with its texture coordinates)."""

import contextlib
import io
import re

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid

from . import vtkfiles
from .arrays import as_cells
from .files import USAGE, Failure, dotted, import_extra, inform, quote

MESHIO = ("off", "ply", "msh", "inp", "nas", "bdf", "xdmf", "med")
READ = ("vtp", "vtk", "vtu", "obj", "stl") + MESHIO
FLAT_WRITE = ("obj", "off", "ply")
"""Formats that hold points and polygons only."""
WRITE = ("vtp", "vtk") + FLAT_WRITE


def points_of(data):
    """The points of a point set, of shape (n, 3), float64."""
    if data.GetPoints() is None:
        return numpy.empty((0, 3))
    return numpy.asarray(vtk_to_numpy(data.GetPoints().GetData()), numpy.float64)


def as_points(array):
    """vtkPoints in double precision of an array of shape (n, 2) or (n, 3)."""
    padded = numpy.zeros((len(array), 3))
    padded[:, : array.shape[1]] = array
    points = vtkPoints()
    points.SetData(numpy_to_vtk(padded, deep=True))
    return points


def make_mesh(points, polygons):
    mesh = vtkPolyData()
    mesh.SetPoints(as_points(points))
    mesh.SetPolys(polygons if isinstance(polygons, vtkCellArray) else as_cells(polygons))
    return mesh


def polygons_of(mesh):
    """The polygons' point ids one after the other, and where each begins, of shape (m + 1,)."""
    cells = mesh.GetPolys()
    return vtk_to_numpy(cells.GetConnectivityArray()), vtk_to_numpy(cells.GetOffsetsArray())


def triangles_of(mesh):
    """The triangles' point ids, of shape (m, 3). Raises Failure if the mesh has other cells."""
    ids, offsets = polygons_of(mesh)
    wrong = numpy.diff(offsets) != 3
    if wrong.any():
        raise Failure(f"Cell {wrong.argmax()} is not a triangle.")
    return ids.reshape(-1, 3)


def _read_obj(input):
    """Points, polygons, texture coordinates, and the polygons' texture ids (-1: none)."""
    points, texture, polygons, texture_ids = [], [], [], []
    with open(input.path, encoding="utf-8-sig", errors="replace") as file:
        for number, line in enumerate(file, 1):
            words = line.split("#", 1)[0].split() or [""]
            try:
                if words[0] in ("v", "vt"):
                    size = 3 if words[0] == "v" else 2
                    numbers = [float(word) for word in words[1 : 1 + size]]
                    if len(numbers) != size:
                        raise ValueError
                    (points if words[0] == "v" else texture).append(numbers)
                elif words[0] == "f":
                    corners = [[int(i or 0) for i in (word + "/").split("/")[:2]] for word in words[1:]]
                    ids = [[i - 1 if i >= 0 else i + len(known) for i in column]
                           for column, known in zip(zip(*corners), (points, texture))]
                    if len(corners) < 3 or min(ids[0]) < 0:
                        raise ValueError
                    polygons.append(ids[0])
                    texture_ids.append(ids[1])
                elif not words[0].isprintable() or "\ufffd" in words[0]:
                    raise ValueError
            except ValueError:
                input.fail(f"line {number}: expected coordinates or a face of 3 points, found {quote(line)}.")
    return numpy.array(points).reshape(-1, 3), polygons, numpy.array(texture).reshape(-1, 2), texture_ids


def _read_meshio(input):
    meshio = import_extra("meshio", f"Reading {input.name}")
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            if input.format == "ply":
                with open(input.path, "rb") as file:
                    # Both names of the list are common.
                    data = file.read().replace(b" vertex_index\n", b" vertex_indices\n", 1)
                mesh = meshio.ply._ply.read_buffer(io.BytesIO(data))
                # Binary files that have been cut off are read without an error.
                counts = [int(n) for n in re.findall(rb"element (?:vertex|face) (\d+)", data[:10000])]
                if counts != [len(mesh.points), sum(len(block.data) for block in mesh.cells)]:
                    raise ValueError("points or faces are missing")
            else:
                mesh = meshio.read(input.path)
    except (Exception, SystemExit) as error:
        input.fail_by(said.getvalue() if isinstance(error, SystemExit) else error)
    points = numpy.asarray(mesh.points, numpy.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3) or (input.format == "ply" and points.shape[1] != 3):
        input.fail("its points do not have the coordinates x, y and z one after the other.")
    blocks = [block.data for block in mesh.cells if block.type in ("triangle", "quad", "polygon")]
    return points, [polygon for block in blocks for polygon in numpy.asarray(block).tolist()]


def read(input):
    """The mesh in a file, vtkPolyData. Raises Failure."""
    if input.format not in READ:
        formats = dotted(("json", "mesh") + READ)
        raise Failure(f"Cannot read {input.name} as a mesh: the formats are {formats}.", USAGE)
    if input.format == "obj" or input.format in MESHIO:
        points, polygons = _read_obj(input)[:2] if input.format == "obj" else _read_meshio(input)
        for cell, polygon in enumerate(polygons):
            if not 0 <= min(polygon) <= max(polygon) < len(points):
                input.fail(f"cell {cell} has the points {quote(polygon)}, but there are {len(points)}, counted from 0.")
        mesh = make_mesh(points, polygons)
    else:
        mesh = vtkfiles.read(input)
    if isinstance(mesh, vtkUnstructuredGrid):
        mesh = _to_polygons(mesh, input)
    if not isinstance(mesh, vtkPolyData):
        input.fail(f"it holds a {mesh.GetClassName()}, not a mesh of triangles.")
    if mesh.GetNumberOfPolys() == 0 and mesh.GetNumberOfStrips() == 0:
        input.fail("it has no triangles.")
    return mesh


def read_data(input):
    """The data object in a file."""
    return vtkfiles.read(input) if input.format in vtkfiles.FORMATS else read(input)


def read_uv(input):
    """The texture coordinates of an OBJ file as a mesh with the same triangles and points."""
    points, polygons, texture, ids = _read_obj(input)
    corners, uv = (numpy.concatenate(lists).astype(int) for lists in (polygons, ids))
    if uv.min() < 0 or uv.max() >= len(texture):
        input.fail("faces have no texture coordinates (vt).")
    positions = numpy.zeros((len(points), 2))
    positions[corners] = texture[uv]
    seams = corners[(positions[corners] != texture[uv]).any(axis=1)]
    if len(seams):
        input.fail(f"point {seams[0]} has several texture coordinates: the texture has a seam there. Cut the mesh along "
                   "its seams first.")
    return make_mesh(positions, polygons)


def _to_polygons(grid, input):
    wrong = ~numpy.isin(vtk_to_numpy(grid.GetCellTypesArray()), (5, 7, 9))
    if wrong.any():
        input.fail(f"cell {wrong.argmax()} is not a polygon: a mesh consists of triangles only.")
    mesh = make_mesh(points_of(grid), grid.GetCells())
    mesh.GetPointData().ShallowCopy(grid.GetPointData())
    mesh.GetCellData().ShallowCopy(grid.GetCellData())
    return mesh


def write(mesh, output):
    """Writes vtkPolyData, and other data to VTK's files."""
    if output.format not in FLAT_WRITE:
        vtkfiles.write(mesh, output)
        return
    if not isinstance(mesh, vtkPolyData):
        raise Failure(f"A .{output.format} file cannot hold a {mesh.GetClassName()}: write a .vtp or .vtk.", USAGE)
    arrays = [a.GetArrayName(i) or "" for a in (mesh.GetPointData(), mesh.GetCellData()) for i in range(a.GetNumberOfArrays())]
    lost = [name for name in arrays if not name.endswith("vtkValidPointMask") and name != "vtkGhostType"]
    if lost:
        inform(f"{output.name} holds points and polygons only, not the arrays {quote(', '.join(lost))}.")
    ids, offsets = polygons_of(mesh)
    sizes = numpy.diff(offsets)
    if output.format == "off" and (sizes != 3).any():
        raise Failure(f"A .{output.format} file holds triangles only: write a .obj.")
    starts = numpy.flatnonzero(numpy.diff(sizes, prepend=-1, append=-1))
    blocks = [
        ({3: "triangle", 4: "quad"}.get(sizes[begin], "polygon"), ids[offsets[begin] : offsets[end]].reshape(end - begin, -1))
        for begin, end in zip(starts, starts[1:])
    ]
    meshio = import_extra("meshio", f"Writing {output.name}")
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        meshio.write_points_cells(output.path, points_of(mesh), blocks)
