# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes in files: by VTK's readers, by meshio, and Wavefront's OBJ (whose numbers are read here in double precision,
with its texture coordinates)."""

import contextlib
import io
import os
import re

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid

from . import vtkfiles
from .files import FILE, USAGE, Failure, import_extra, inform, quote, replace_path

MESHIO = ("off", "ply", "msh", "inp", "nas", "bdf", "xdmf", "med")
READ = ("vtp", "vtk", "vtu", "obj", "stl") + MESHIO
WRITE = ("vtp", "vtk", "obj", "off", "ply")
FLAT_WRITE = ("obj", "off", "ply")
"""Formats that hold points and polygons only."""


def points_of(data):
    """The points of a point set, of shape (n, 3), float64."""
    if data.GetPoints() is None:
        return numpy.empty((0, 3))
    return numpy.asarray(vtk_to_numpy(data.GetPoints().GetData()), numpy.float64)


def as_points(array):
    """vtkPoints in double precision of an array of shape (n, 2) or (n, 3)."""
    array = numpy.asarray(array, numpy.float64)
    if array.shape[1] == 2:
        array = numpy.column_stack((array, numpy.zeros(len(array))))
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(array), deep=True))
    return points


def as_cells(polygons):
    """vtkCellArray of an array of shape (m, k), or of a list of polygons."""
    if isinstance(polygons, numpy.ndarray):
        sizes, ids = numpy.full(len(polygons), polygons.shape[1]), polygons.ravel()
    else:
        sizes = [len(polygon) for polygon in polygons]
        ids = [point for polygon in polygons for point in polygon]
    offsets = numpy.concatenate(([0], numpy.cumsum(sizes))).astype(numpy.int64)
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtkIdTypeArray(offsets, deep=True),
        numpy_to_vtkIdTypeArray(numpy.ascontiguousarray(ids, numpy.int64), deep=True),
    )
    return cells


def make_mesh(points, polygons):
    mesh = vtkPolyData()
    mesh.SetPoints(as_points(points))
    mesh.SetPolys(as_cells(polygons) if not isinstance(polygons, vtkCellArray) else polygons)
    return mesh


def triangles_of(mesh):
    """The triangles' point ids, of shape (m, 3). Raises Failure if the mesh has other cells."""
    cells = mesh.GetPolys()
    sizes = numpy.diff(vtk_to_numpy(cells.GetOffsetsArray()))
    if (sizes != 3).any():
        raise Failure(f"Cell {int((sizes != 3).argmax())} is not a triangle.")
    return vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 3)


def _read_obj(path, fail):
    """Points, polygons, texture coordinates, and the polygons' texture ids (-1: none)."""
    points, texture, polygons, texture_ids = [], [], [], []
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        for number, line in enumerate(file, 1):
            words = line.split("#", 1)[0].split()
            try:
                if not words:
                    continue
                if words[0] == "v":
                    points.append([float(word) for word in words[1:4]])
                    if len(points[-1]) != 3:
                        raise ValueError
                elif words[0] == "vt":
                    texture.append([float(word) for word in words[1:3]])
                    if len(texture[-1]) != 2:
                        raise ValueError
                elif words[0] == "f":
                    corners = [(word + "/").split("/")[:2] for word in words[1:]]
                    ids = [int(point) for point, _ in corners]
                    ids = [i - 1 if i > 0 else i + len(points) for i in ids]
                    if len(ids) < 3 or min(ids) < 0:
                        raise ValueError
                    polygons.append(ids)
                    uv = [int(t) if t else 0 for _, t in corners]
                    texture_ids.append([t - 1 if t > 0 else t + len(texture) if t else -1 for t in uv])
                elif "\ufffd" in words[0] or not words[0].isprintable():
                    raise ValueError
            except ValueError:
                fail(f"line {number}: expected coordinates or a face of 3 points, found {quote(line)}.")
    points = numpy.array(points, float).reshape(-1, 3)
    for number, polygon in enumerate(polygons):
        if max(polygon) >= len(points):
            fail(f"face {number} has the point {max(polygon) + 1}, but there are only {len(points)}.")
    return points, polygons, numpy.array(texture, float).reshape(-1, 2), texture_ids


def _read_meshio(input):
    meshio = import_extra("meshio", "python3-meshio", f"Reading {input.name}")
    path = input.path
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            if input.format == "ply":
                with open(path, "rb") as file:
                    data = file.read()
                # Both names of the list are common.
                data = data.replace(b" vertex_index\n", b" vertex_indices\n", 1)
                mesh = meshio.ply._ply.read_buffer(io.BytesIO(data))
                # Binary files that have been cut off are read without an error.
                counts = [int(n) for n in re.findall(rb"element (?:vertex|face) (\d+)", data[:10000])]
                if counts != [len(mesh.points), sum(len(block.data) for block in mesh.cells)]:
                    raise ValueError("points or faces are missing")
            else:
                mesh = meshio.read(path)
    except (Exception, SystemExit) as error:
        why = quote(said.getvalue(), 200) if isinstance(error, SystemExit) else replace_path(error, input)
        input.fail(f"it cannot be read as .{input.format}: {why or type(error).__name__}")
    points = numpy.asarray(mesh.points, numpy.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3) or (input.format == "ply" and points.shape[1] != 3):
        input.fail("its points do not have the coordinates x, y and z one after the other.")
    polygons = []
    for block in mesh.cells:
        if block.type in ("triangle", "quad", "polygon"):
            polygons += numpy.asarray(block.data).tolist()
    ids = [min(polygon) for polygon in polygons] + [max(polygon) for polygon in polygons]
    if ids and not 0 <= min(ids) <= max(ids) < len(points):
        input.fail(f"its cells have points from {min(ids)} to {max(ids)}, but there are {len(points)}.")
    return make_mesh(points, polygons)


def read(input):
    """The mesh in a file, vtkPolyData. Raises Failure."""
    if input.format not in READ:
        formats = ", ".join("." + name for name in ("json", "mesh") + READ)
        raise Failure(f"Cannot read {input.name} as a mesh: the formats are {formats}.", USAGE)
    if input.format == "obj":
        mesh = make_mesh(*_read_obj(input.path, input.fail)[:2])
    elif input.format in MESHIO:
        mesh = _read_meshio(input)
    else:
        mesh = vtkfiles.read(input)
    if isinstance(mesh, vtkUnstructuredGrid):
        mesh = _to_polygons(mesh, input)
    if not isinstance(mesh, vtkPolyData):
        input.fail(f"it holds a {mesh.GetClassName()}, not a mesh of triangles.")
    if mesh.GetNumberOfPolys() == 0 and mesh.GetNumberOfStrips() == 0:
        input.fail("it has no triangles.")
    return mesh


def read_uv(input):
    """The texture coordinates of an OBJ file as a mesh with the same triangles and points."""
    points, polygons, texture, ids = _read_obj(input.path, input.fail)
    positions = numpy.full((len(points), 2), numpy.nan)
    for number, (polygon, uv) in enumerate(zip(polygons, ids)):
        for point, t in zip(polygon, uv):
            if not 0 <= t < len(texture):
                input.fail(f"face {number} has no texture coordinates (vt).")
            if not numpy.isnan(positions[point, 0]) and (positions[point] != texture[t]).any():
                input.fail(
                    f"point {point} has several texture coordinates: the texture has a seam there. "
                    "Cut the mesh along its seams first."
                )
            positions[point] = texture[t]
    return make_mesh(numpy.nan_to_num(positions), polygons)


def _to_polygons(grid, input):
    types = vtk_to_numpy(grid.GetCellTypesArray())
    wrong = ~numpy.isin(types, (5, 7, 9))
    if wrong.any():
        cell = int(wrong.argmax())
        input.fail(f"cell {cell} is not a polygon (type {types[cell]}): a mesh consists of triangles only.")
    mesh = make_mesh(points_of(grid), grid.GetCells())
    mesh.GetPointData().ShallowCopy(grid.GetPointData())
    mesh.GetCellData().ShallowCopy(grid.GetCellData())
    return mesh


def write(mesh, output):
    """Writes vtkPolyData."""
    if output.format not in FLAT_WRITE:
        vtkfiles.write(mesh, output)
        return
    if not isinstance(mesh, vtkPolyData):
        raise Failure(f"A .{output.format} file cannot hold a {mesh.GetClassName()}: write a .vtp or .vtk.", USAGE)
    lost = []
    for attributes in (mesh.GetPointData(), mesh.GetCellData()):
        lost += [attributes.GetArrayName(i) or "" for i in range(attributes.GetNumberOfArrays())]
    lost = [name for name in lost if not name.endswith("vtkValidPointMask") and name != "vtkGhostType"]
    if lost:
        inform(f"{output.name} holds points and polygons only, not the arrays {quote(', '.join(lost))}.")
    cells = mesh.GetPolys()
    offsets, ids = (vtk_to_numpy(a) for a in (cells.GetOffsetsArray(), cells.GetConnectivityArray()))
    sizes = numpy.diff(offsets)
    if output.format == "off" and (sizes != 3).any():
        raise Failure(f"A .{output.format} file holds triangles only: write a .obj.")
    blocks = []
    starts = numpy.flatnonzero(numpy.diff(sizes, prepend=-1))
    for begin, end in zip(starts, [*starts[1:], len(sizes)]):
        size = int(sizes[begin])
        kind = {3: "triangle", 4: "quad"}.get(size, "polygon")
        blocks.append((kind, ids[offsets[begin] : offsets[end]].reshape(-1, size)))
    meshio = import_extra("meshio", "python3-meshio", f"Writing {output.name}")
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        meshio.write_points_cells(output.path, points_of(mesh), blocks)
    if not os.path.exists(output.path):
        raise Failure(f"Cannot write {output.name}.", FILE)
