# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm map, and the reading and writing of tables, vector data, meshes and VTK files that dhm coordinates also uses"""

import click

from .. import meshes, options, tables, vectors, vtkfiles
from ..arrays import MASK
from ..files import TABLES, USAGE, VECTORS, Failure, Input, count, dotted, inform
from ..mapping import PointMap, choose_system

MESHES = tuple(dict.fromkeys(meshes.READ + vtkfiles.FORMATS))
FAMILIES = {TABLES: TABLES, VECTORS: VECTORS, MESHES: vtkfiles.FORMATS[:-1] + meshes.FLAT_WRITE}
"""Formats that can be read, and for each the formats in which the result can be written."""

data_options = options.add(
    options.output("The result, of the same kind as the data (images become .vts), or - for standard output.", "csv",
                   sum(FAMILIES.values(), ()), "data"),
    click.option("--columns", default="", metavar="LIST",
                 help="Names or numbers (from 1) of the coordinate columns of a table, separated by commas (default: "
                      "columns with usual names, such as x,y,z, E,N or lon,lat; without names, the first two)."),
    click.option("--require-inside", is_flag=True, help="Write nothing and fail (status 1) if a point is outside."),
)


def process(work, output, columns, require_inside, name, format, densify=0.0, crs=(None, None)):
    """Reads data from a file (or from standard input, in the given format), processes it by a PointMap, and writes it.
    `crs` are the coordinate reference systems of source and target for vectors.map_layers."""
    input = Input(name, format or "csv")
    kind, known = input.format, sum(FAMILIES, ())
    if kind not in known:
        raise Failure(f"Cannot read {input.name} as data: the formats are {dotted(known)}.", USAGE)
    known = next(FAMILIES[family] for family in FAMILIES if kind in family)
    if output.format not in known:
        raise Failure(f"{input.name}, a .{kind}, can be written as {dotted(known)}, not as .{output.format}.", USAGE)
    cannot_mark = output.format in meshes.FLAT_WRITE
    if cannot_mark and not work.moves:
        raise Failure(f"Coordinates are arrays of points, which a .{output.format} does not have: write a .vtp.", USAGE)
    noun, mark, write = "point", f"marked 0 in {MASK}", meshes.write
    with input:
        if kind in VECTORS:
            noun, mark, write = "feature", f"empty in the result, and marked 1 in {vectors.MARK}", vectors.write
            result, outside = vectors.map_layers(
                vectors.read(input), lambda points: work.map_points(points)[0], densify, *crs)
        elif kind in TABLES:
            result, write = tables.Table(input, columns, bool(work.shift and work.shift.heights)), tables.Table.write
            moved, arrays = work.map_points(result.coordinates)
            if work.moves:
                result.move(moved)
            for array in arrays:
                result.add(array, arrays[array])
            if "Fallback" in arrays:
                mark += (f"; {arrays['Fallback'].sum()} of them are mapped by the file's fallback strategy "
                         f"\"{work.shift.fallback}\", marked 1 in Fallback")
            outside = work.outside
        else:
            result, outside = work.map_data(meshes.read_data(input)), work.outside
            if outside and cannot_mark:
                raise Failure(f"Points are outside the domain, which a .{output.format} cannot mark: write a .vtp.")
    if outside:
        message = f"{count(outside, noun)} {'is' if outside == 1 else 'are'} outside the domain"
        if require_inside:
            raise Failure(message + ".")
        inform(f"{message}: {mark}.")
    with output.writing():
        write(result, output)


@click.command("map")
@data_options
@options.map_settings("smooth; for a PROJ triangulation file linear, which is its official meaning")
@options.inverse
@options.crs
@click.option("--densify", type=options.POSITIVE, metavar="LENGTH",
              help="First divide segments of vector data that are longer than this.")
@click.option("-j", "--jacobian", is_flag=True, help="Add the array Jacobian: the derivative, 9 numbers, row-major.")
@click.option("--determinant", is_flag=True, help="Add the array JacobianDeterminant: the ratio of areas.")
@click.option("--triangle-id", is_flag=True,
              help="Add the array TriangleId: the cell id of the triangle that contains the point.")
@click.option("--vectors", type=click.Choice(["active", "all", "none"]), default="active",
              help="Vectors, normals and tensors to transform with the points.")
@options.pair_files("SOURCE [TARGET] DATA")
def command(inputs, output, columns, require_inside, inverse, crs, densify, jacobian, determinant, triangle_id,
            vectors, **settings):
    """Map data from the source's domain to the target's.

    DATA is a table of points (.csv .txt .xyz), vector data (.gpkg .geojson .shp .fgb), a mesh (.obj .off .ply .stl),
    or a VTK file (.vtp .vtu .vts .vtr .vti .vtm .vtk).

    Points of tables that are outside the domain become nan. All points outside have the value 0 in vtkValidPointMask.
    Features outside become empty. For a PROJ triangulation file, heights (a third coordinate) and the fallback strategy
    are treated as in PROJ."""
    inputs.crs = None if inverse else crs
    pair = options.read_pair(inputs)
    work = PointMap(pair, choose_system(settings, pair), inverse)
    work.filter.SetComputeJacobian(jacobian)
    work.filter.SetComputeJacobianDeterminant(determinant)
    work.filter.SetComputeTriangleId(triangle_id)
    work.filter.SetTransformActiveAttributes(vectors != "none")
    work.filter.SetTransformAllInputVectors(vectors == "all")
    pair.compare_crs(crs, inverse)
    source, target = pair.crs(inverse)
    process(work, output, columns, require_inside, inputs.other, inputs.format, densify,
            (source, target if crs is None else crs))
