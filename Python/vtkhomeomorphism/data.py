# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Data that commands process point by point: tables, vector data, meshes, VTK files, images."""

from dataclasses import dataclass

import click
import numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from . import images, meshes, options, tables, vectors, vtkfiles
from .arrays import MASK, as_cells, as_points, make_mesh, points_of
from .files import PICTURES, TABLES, USAGE, VECTORS, Failure, Input, Output, count, dotted, inform
from .mapping import add_array

READ = tuple(dict.fromkeys(TABLES + VECTORS + meshes.READ + vtkfiles.FORMATS + PICTURES))
WRITE = TABLES + VECTORS + vtkfiles.FORMATS[:-1] + meshes.FLAT_WRITE

data_options = options.add(
    options.output("The result: of the data's kind (images become .vts), or - for standard output.", "csv", WRITE, "data"),
    click.option("--columns", default="", metavar="LIST",
                 help="Names or numbers (from 1) of a table's coordinate columns, separated by commas (default: usual names, "
                      "such as x,y,z, E,N or lon,lat; of a table without names, the first two)."),
    click.option("--require-inside", is_flag=True,
                 help="Write nothing and fail (status 1) if a point is outside the domain."),
)


@dataclass
class Data:
    """Data that is read, processed and written."""

    output: Output
    columns: str
    require_inside: bool
    crs: str = None
    shift: object = None
    """That of a triangulation file, whose map uses heights as the third coordinate."""

    def process(self, name, format, work, moves, densify=0.0, known_crs=(None, None)):
        """Reads the data, processes it and writes it.

        work : object with map_points(points) -> images, arrays and map_data(data) -> data, and the count `outside`
        moves : whether points move
        """
        input = Input(name, format or "csv")
        kind, target = input.format, self.output.format
        if kind not in READ:
            raise Failure(f"Cannot read {input.name} as data: the formats are {dotted(READ)}.", USAGE)
        if (target in TABLES) > (kind in TABLES):
            raise Failure(f"Only points of a table can be written as one (.{target}), {input.name} is a .{kind}.", USAGE)
        if (target in VECTORS) != (kind in VECTORS):
            raise Failure(f"Vector data stays vector data: .{kind} cannot be written as .{target}; the formats are "
                          f"{dotted(VECTORS)}.", USAGE)
        if target in meshes.FLAT_WRITE and not moves:
            raise Failure(f"Coordinates are arrays of points, which a .{target} file does not have: write a .vtp.", USAGE)
        with input:
            if kind in VECTORS:
                self._process_vectors(input, work, densify, known_crs)
            elif kind in TABLES:
                self._process_table(input, work, moves)
            else:
                raster = images.read(input) if kind in PICTURES else None
                self._write_mapped(work, raster.grid.to_vtk(raster.all()) if raster else meshes.read_data(input))

    def _report(self, outside, noun="point", extra="", mark=f"marked 0 in {MASK}"):
        if outside:
            message = f"{count(outside, noun)} {'is' if outside == 1 else 'are'} outside the domain{extra}"
            if self.require_inside:
                raise Failure(message + ".")
            inform(f"{message}: {mark}.")

    def _process_table(self, input, work, moves):
        table = tables.Table(input, self.columns, with_height=bool(self.shift and self.shift.heights))
        wrong = ~numpy.isfinite(table.coordinates).all(axis=1)
        extra = f" (of {wrong.sum()}, the coordinates are not finite numbers; the first is point {wrong.argmax()}, counted " \
                "from 0)" if wrong.any() else ""
        if self.output.format not in TABLES:
            data = make_mesh(table.coordinates)
            data.SetVerts(as_cells(numpy.arange(len(wrong))[:, None]))
            table.add_columns_to(data)
            self._write_mapped(work, data, extra)
            return
        moved, arrays = work.map_points(table.coordinates)
        mark = f"marked 0 in {MASK}"
        if "Fallback" in arrays:
            mark += f"; {arrays['Fallback'].sum()} of them are mapped by the file's fallback strategy " \
                    f"\"{self.shift.fallback}\", marked 1 in Fallback"
        self._report(work.outside, extra=extra, mark=mark)
        if moves:
            table.move(moved)
        for name, values in arrays.items():
            table.add(name, values)
        with self.output as output:
            table.write(output)

    def _write_mapped(self, work, data, extra=""):
        """Maps and writes VTK data; for a triangulation file, with heights as the third coordinate."""
        if self.shift is None or not isinstance(data, vtkPolyData):
            result = work.map_data(data)
        else:
            points = points_of(data)
            moved, arrays = work.map_points(points)
            flat = vtkPolyData()
            flat.ShallowCopy(data)
            flat.SetPoints(as_points(points[:, :2])[0])
            result = work.map_data(flat)
            # Points outside keep their coordinates.
            result.SetPoints(as_points(numpy.where(numpy.isnan(moved), points, moved))[0])
            if "Fallback" in arrays:
                add_array(result, "Fallback", arrays["Fallback"])
        self._report(work.outside, extra=extra)
        if work.outside and self.output.format in meshes.FLAT_WRITE:
            raise Failure(f"Points are outside the domain, which a .{self.output.format} file cannot mark: write a .vtp.")
        with self.output as output:
            meshes.write(result, output)

    def _process_vectors(self, input, work, densify, known_crs):
        layers = vectors.read(input)
        for name, layer in layers.items():
            if known_crs[0] and layer.crs and layer.crs != known_crs[0]:
                inform(f"{input.name}, layer {name}: its coordinate reference system is {layer.crs.to_string()}, but "
                       f"the map is from {known_crs[0]}.")
        result, outside = vectors.map_layers(layers, lambda points: work.map_points(points)[0], densify)
        self._report(outside, "feature", mark=f"its geometry is empty, and it is marked 1 in {vectors.MARK}")
        crs = known_crs[1] if self.crs is None else self.crs
        if crs is not None:
            try:
                for layer in result.values():
                    # None for pixels.
                    layer.crs = None
                    layer.crs = crs or None
            except Exception as error:
                raise Failure(f"The coordinate reference system {crs} is not known: {error}", USAGE) from None
        with self.output as output:
            vectors.write(result, output)
