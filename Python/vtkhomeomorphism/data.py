# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Data that commands process point by point: tables, vector data, meshes, VTK files."""

from dataclasses import dataclass

import click

from . import meshes, options, tables, vectors, vtkfiles
from .arrays import MASK
from .files import TABLES, USAGE, VECTORS, Failure, Input, Output, count, dotted, inform
from .mapping import PointMap

MESHES = tuple(dict.fromkeys(meshes.READ + vtkfiles.FORMATS))
FAMILIES = {TABLES: TABLES, VECTORS: VECTORS, MESHES: vtkfiles.FORMATS[:-1] + meshes.FLAT_WRITE}
"""Formats that can be read, and those that each can be written as."""

data_options = options.add(
    options.output("The result: of the data's kind (images become .vts), or - for standard output.", "csv",
                   sum(FAMILIES.values(), ()), "data"),
    click.option("--columns", default="", metavar="LIST",
                 help="Names or numbers (from 1) of a table's coordinate columns, separated by commas (default: usual "
                      "names, such as x,y,z, E,N or lon,lat; of a table without names, the first two)."),
    click.option("--require-inside", is_flag=True, help="Write nothing and fail (status 1) if a point is outside."),
)


@dataclass
class Data:
    """Data that is read, processed by a PointMap (or a class like it), and written."""

    work: PointMap
    output: Output
    columns: str
    require_inside: bool
    densify: float = 0.0
    crs: tuple = (None, None)  # the source's and the target's coordinate reference systems, for vectors.map_layers
    shift: object = None  # that of a triangulation file, whose map uses heights as the third coordinate

    def process(self, name, format):
        """Reads the data of a file (or standard input, in a format), processes it and writes it."""
        input = Input(name, format or "csv")
        kind, target = input.format, self.output.format
        if kind not in sum(FAMILIES, ()):
            raise Failure(f"Cannot read {input.name} as data: the formats are {dotted(sum(FAMILIES, ()))}.", USAGE)
        known = next(FAMILIES[family] for family in FAMILIES if kind in family)
        if target not in known:
            raise Failure(f"{input.name}, a .{kind}, can be written as {dotted(known)}, not as .{target}.", USAGE)
        if target in meshes.FLAT_WRITE and not self.work.moves:
            raise Failure(f"Coordinates are arrays of points, which a .{target} does not have: write a .vtp.", USAGE)
        with input:
            if kind in VECTORS:
                layers, outside = vectors.map_layers(
                    vectors.read(input), lambda points: self.work.map_points(points)[0], self.densify, *self.crs)
                self._write(layers, vectors.write, outside, "feature",
                            f"without a geometry in the result, and marked 1 in {vectors.MARK}")
            elif kind in TABLES:
                self._process_table(tables.Table(input, self.columns, bool(self.shift and self.shift.heights)))
            else:
                result = self.work.map_data(meshes.read_data(input))
                if self.work.outside and target in meshes.FLAT_WRITE:
                    raise Failure(f"Points are outside the domain, which a .{target} cannot mark: write a .vtp.")
                self._write(result, meshes.write, self.work.outside)

    def _process_table(self, table):
        moved, arrays = self.work.map_points(table.coordinates)
        if self.work.moves:
            table.move(moved)
        for name, values in arrays.items():
            table.add(name, values)
        mark = f"marked 0 in {MASK}"
        if "Fallback" in arrays:
            mark += f"; {arrays['Fallback'].sum()} of them are mapped by the file's fallback strategy " \
                    f"\"{self.shift.fallback}\", marked 1 in Fallback"
        self._write(table, tables.Table.write, self.work.outside, mark=mark)

    def _write(self, result, write, outside, noun="point", mark=f"marked 0 in {MASK}"):
        """Writes the result and reports how many points are outside."""
        if outside:
            message = f"{count(outside, noun)} {'is' if outside == 1 else 'are'} outside the domain"
            if self.require_inside:
                raise Failure(message + ".")
            inform(f"{message}: {mark}.")
        with self.output.writing():
            write(result, self.output)
