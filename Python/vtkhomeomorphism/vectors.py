# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Vector data (GeoPackage, GeoJSON, Shapefile, FlatGeobuf) by geopandas: geometries are mapped vertex by vertex,
attributes and layers are kept."""

import math

import numpy

from .files import FILE, Failure, import_extra, replace_path

DRIVERS = {"gpkg": "GPKG", "geojson": "GeoJSON", "shp": "ESRI Shapefile", "fgb": "FlatGeobuf"}
MARK = "outside"
"""The column of features that are not within the domain; their geometries are empty."""


def _read(path):
    import geopandas

    if hasattr(geopandas, "list_layers"):
        names = geopandas.list_layers(path)["name"]
    else:
        # Before geopandas 1.0.
        import fiona

        names = fiona.listlayers(path)
    return {name: geopandas.read_file(path, layer=name) for name in names}


def read(input):
    """The layers of a file by name, GeoDataFrames."""
    import_extra("geopandas", "python3-geopandas", f"Reading {input.name}")
    try:
        return _read(input.path)
    except Exception as error:
        input.fail(f"it cannot be read as .{input.format}: {replace_path(error, input)}")


def write(layers, output):
    """Writes layers to one file; only GeoPackage holds several."""
    if len(layers) > 1 and output.format != "gpkg":
        raise Failure(f"{output.name} can hold one layer, not {len(layers)} ({', '.join(layers)}): write a .gpkg.")
    try:
        for name, layer in layers.items():
            options = {"layer": name} if output.format == "gpkg" else {}
            layer.to_file(output.path, driver=DRIVERS[output.format], index=False, **options)
        # Read again, because GDAL does not tell when a disk is full at the end.
        complete = list(map(len, _read(output.path).values())) == list(map(len, layers.values()))
    except OSError:
        raise
    except Exception as error:
        raise Failure(f"Cannot write {output.name}: {replace_path(error, output)}", FILE) from None
    if not complete:
        raise Failure(f"Cannot write {output.name}: features are missing in what was written.", FILE)


def _densify(step):
    """Divides segments so that none is longer than a step."""

    def divide(x, y, z=None):
        points = numpy.column_stack((x, y) if z is None else (x, y, z))
        if len(points) < 2:
            return (x, y) if z is None else (x, y, z)
        pieces = []
        for a, b in zip(points[:-1], points[1:]):
            parts = max(1, math.ceil(math.hypot(*(b - a)[:2]) / step))
            t = numpy.arange(parts)[:, None] / parts
            pieces.append(a + t * (b - a))
        return tuple(numpy.vstack(pieces + [points[-1:]]).T)

    return divide


def map_layers(layers, map_points, densify=0.0):
    """The layers with each vertex mapped, once for all of them: `map_points` takes an array of shape (n, 3) and returns
    images, NaN outside. Returns the layers, and the number of features that are not entirely inside the domain."""
    from shapely.ops import transform

    divided, chunks = {}, []

    def collect(x, y, z=None):
        chunks.append(numpy.column_stack((x, y, numpy.zeros(len(x)) if z is None else z)))
        return (x, y) if z is None else (x, y, z)

    for name, layer in layers.items():
        shapes = [s if s is None or not densify else transform(_densify(densify), s) for s in layer.geometry]
        divided[name] = shapes
        for shape in shapes:
            if shape is not None and not shape.is_empty:
                transform(collect, shape)
    images = map_points(numpy.vstack(chunks) if chunks else numpy.empty((0, 3)))
    begin, outside = 0, 0

    def replace(x, y, z=None):
        nonlocal begin
        part = images[begin : begin + len(x)]
        begin += len(x)
        if numpy.isnan(part[:, :2]).any():
            lost.append(True)
            part = numpy.nan_to_num(part)
        return tuple(part[:, : 2 if z is None else 3].T)

    result = {}
    for name, layer in layers.items():
        shapes, marks = [], []
        for shape in divided[name]:
            lost = []
            if shape is not None and not shape.is_empty:
                mapped = transform(replace, shape)
                shape = type(shape)() if lost else mapped
            shapes.append(shape)
            marks.append(int(bool(lost)))
        outside += sum(marks)
        result[name] = layer.set_geometry(shapes, crs=layer.crs)
        if any(marks):
            result[name][MARK] = marks
    return result, outside
