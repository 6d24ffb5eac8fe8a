# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes in files, read by VTK, by meshio, and here (Wavefront's OBJ, in double precision)."""

import contextlib
import io
import itertools
import re

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid

from . import vtkfiles
from .arrays import MASK, arrays_of, make_mesh, points_of
from .files import USAGE, Failure, dotted, inform, quote

MESHIO = ("off", "ply", "msh", "inp", "nas", "bdf", "xdmf", "med")
READ = ("vtp", "vtk", "vtu", "obj", "stl") + MESHIO
FLAT_WRITE = ("obj", "off", "ply")  # formats that contain only points and polygons
WRITE = ("vtp", "vtk") + FLAT_WRITE


def lists_of(cells):
    """The point ids of the cells of a vtkCellArray, a list with one array per cell."""
    offsets = vtk_to_numpy(cells.GetOffsetsArray())
    return numpy.split(vtk_to_numpy(cells.GetConnectivityArray()), offsets[1:-1]) if cells.GetNumberOfCells() else []


def _read_obj(input):
    """Points, polygons, and the names of other contents."""
    points, polygons, others = [], [], {}
    with open(input.path, encoding="utf-8-sig", errors="replace") as file:
        for number, line in enumerate(file, 1):
            kind, *words = line.split("#", 1)[0].split() or [""]
            try:
                if kind == "v":
                    x, y, z = map(float, words[:3])
                    points.append((x, y, z))
                    others.update({"colors": None} if len(words) >= 6 else {})
                elif kind == "f":
                    ids = [int(word.partition("/")[0]) for word in words]
                    polygons.append([i - 1 if i >= 0 else i + len(points) for i in ids])
                    if len(ids) < 3 or min(polygons[-1]) < 0:
                        raise ValueError
                elif not kind.isprintable() or "\ufffd" in kind:
                    raise ValueError
                elif kind:
                    others[kind] = None
            except ValueError:
                input.fail(f"line {number}: expected coordinates or a face of 3 points, found {quote(line)}.")
    return numpy.array(points).reshape(-1, 3), polygons, list(others)


@contextlib.contextmanager
def _quiet_meshio():
    """The module meshio; its messages are not printed."""
    import meshio

    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            yield meshio
        except SystemExit:
            raise ValueError(said.getvalue()) from None


def _read_meshio(input):
    """Points, polygons, and the names of other contents."""
    try:
        with _quiet_meshio() as meshio, open(input.path, "rb") as file:
            if input.format != "ply":
                mesh = meshio.read(input.path)
            else:
                # Both names of the list are common. meshio reads truncated binary files without an error.
                data = file.read().replace(b" vertex_index\n", b" vertex_indices\n", 1)
                mesh = meshio.ply._ply.read_buffer(io.BytesIO(data))
                counts = [int(n) for n in re.findall(rb"element (?:vertex|face) (\d+)", data[:10000])]
                if counts != [len(mesh.points), sum(len(block.data) for block in mesh.cells)]:
                    raise ValueError("points or faces are missing")
            if mesh.points.shape[1:] != (3,) and (input.format == "ply" or mesh.points.shape[1:] != (2,)):
                raise ValueError("the coordinates of its points are not x, y and z, in this order")
    except ImportError:
        raise
    except Exception as error:
        input.fail_by(error)
    polygons, others = [], [*mesh.point_data, *mesh.cell_data]
    for block in mesh.cells:
        if block.type in ("triangle", "quad", "polygon"):
            polygons += numpy.asarray(block.data).tolist()
        else:
            others.append(block.type)
    return mesh.points, polygons, others


def read_data(input, tell=True):
    """The data object in a file in one of VTK's formats, or the mesh in another file. Unless `tell` is false, prints
    the contents that are not read."""
    if input.format in vtkfiles.FORMATS:
        return vtkfiles.read(input)
    points, polygons, others = _read_obj(input) if input.format == "obj" else _read_meshio(input)
    if others and tell:
        inform(f"{input.name}: points and polygons are read, but not {quote(', '.join(others))}.")
    for cell, polygon in enumerate(polygons):
        if not 0 <= min(polygon) <= max(polygon) < len(points):
            input.fail(f"cell {cell} has the point ids {quote(polygon)} (from 0), but there are {len(points)} points.")
    return make_mesh(points, polygons)


def read(input):
    """The mesh in a file, vtkPolyData. Raises Failure."""
    if input.format not in READ:
        raise Failure(f"Cannot read {input.name} as a mesh or landmarks: meshes are {dotted(('json', 'mesh') + READ)}; "
                      "landmarks .points, .json or .csv with columns source_x, source_y, target_x, target_y.", USAGE)
    mesh = read_data(input, False)
    if isinstance(mesh, vtkUnstructuredGrid):
        grid, mesh = mesh, vtkPolyData()
        are_polygons = numpy.isin(vtk_to_numpy(grid.GetCellTypesArray()), (5, 7, 9))
        if not are_polygons.all():
            input.fail(f"cell {are_polygons.argmin()} is not a polygon, but a mesh must consist of triangles.")
        mesh.SetPoints(grid.GetPoints())
        mesh.SetPolys(grid.GetCells())
        mesh.GetPointData().ShallowCopy(grid.GetPointData())
        mesh.GetCellData().ShallowCopy(grid.GetCellData())
    if not isinstance(mesh, vtkPolyData):
        input.fail(f"it contains a {mesh.GetClassName()}, not a mesh of triangles.")
    if mesh.GetNumberOfPolys() == 0 and mesh.GetNumberOfStrips() == 0:
        input.fail("it has no triangles.")
    return mesh


def write(mesh, output):
    """Writes a vtkPolyData, or other data to a file in one of VTK's formats."""
    if output.format not in FLAT_WRITE:
        vtkfiles.write(mesh, output)
        return
    if not isinstance(mesh, vtkPolyData):
        raise Failure(f"A .{output.format} file cannot contain a {mesh.GetClassName()}: write a .vtp or .vtk.", USAGE)
    lost = [name for data in (mesh.GetPointData(), mesh.GetCellData()) for name in arrays_of(data) if name != MASK]
    if lost:
        inform(f"{output.name} contains only points and polygons, not the arrays {quote(', '.join(map(str, lost)))}.")
    groups = itertools.groupby(lists_of(mesh.GetPolys()), len)
    blocks = [({3: "triangle", 4: "quad"}.get(size, "polygon"), numpy.array(list(group))) for size, group in groups]
    if output.format == "off" and any(kind != "triangle" for kind, _ in blocks):
        raise Failure("A .off file can contain only triangles: write a .obj.")
    with _quiet_meshio() as meshio:
        meshio.write_points_cells(output.path, points_of(mesh), blocks)
