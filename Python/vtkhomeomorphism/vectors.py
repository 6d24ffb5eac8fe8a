# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Vector data (GeoPackage, GeoJSON, Shapefile, FlatGeobuf) by geopandas: geometries are mapped vertex by vertex,
attributes and layers are kept."""

import contextlib
import io

import numpy

from .files import FILE, Failure, import_extra, quote_message

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
    import_extra("geopandas", f"Reading {input.name}")
    try:
        return _read(input.path)
    except Exception as error:
        input.fail_by(error)


def write(layers, output):
    """Writes layers to one file; only GeoPackage holds several."""
    if len(layers) > 1 and output.format != "gpkg":
        raise Failure(f"{output.name} can hold one layer, not {len(layers)} ({', '.join(layers)}): write a .gpkg.")
    try:
        # GDAL's messages are in the exceptions.
        with contextlib.redirect_stderr(io.StringIO()):
            for name, layer in layers.items():
                options = {"layer": name} if output.format == "gpkg" else {}
                layer.to_file(output.path, driver=DRIVERS[output.format], index=False, **options)
        # Read again, because GDAL does not tell when a disk is full at the end.
        written = [len(layer) for layer in _read(output.path).values()]
    except OSError:
        raise
    except Exception as error:
        raise Failure(f"Cannot write {output.name}: {quote_message(error, output)}", FILE) from None
    if written != [len(layer) for layer in layers.values()]:
        raise Failure(f"Cannot write {output.name}: features are missing in what was written.", FILE)


def divide(points, step):
    """A polygonal line of shape (n, 2) or (n, 3), with points added so that no segment is longer than a step."""
    lengths = numpy.hypot(*numpy.diff(points[:, :2], axis=0).T)
    parts = numpy.maximum(1, numpy.ceil(lengths / step)).astype(int)
    begins = numpy.repeat(numpy.arange(len(parts)), parts)
    t = (numpy.arange(len(begins)) - numpy.repeat(numpy.cumsum(parts) - parts, parts)) / parts[begins]
    between = points[begins] + t[:, None] * (points[begins + 1] - points[begins])
    return numpy.vstack((between, points[-1:]))


def map_layers(layers, map_points, densify=0.0):
    """The layers with each vertex mapped, once for all of them: `map_points` takes an array of shape (n, 3) and returns
    images, NaN outside. Returns the layers, and the number of features that are not entirely inside the domain."""
    from shapely.ops import transform

    collected, begin, outside = [], 0, 0

    def collect(*coordinates):
        points = numpy.column_stack(coordinates)
        points = divide(points, densify) if densify and len(points) > 1 else points
        collected.append(numpy.column_stack((points, numpy.zeros((len(points), 3 - points.shape[1])))))
        return tuple(points.T)

    def replace(*coordinates):
        nonlocal begin
        begin, end = begin + len(coordinates[0]), begin
        return tuple(images[end:begin, : len(coordinates)].T)

    divided = {name: [s if s is None or s.is_empty else transform(collect, s) for s in layer.geometry]
               for name, layer in layers.items()}
    images = map_points(numpy.vstack(collected) if collected else numpy.empty((0, 3)))
    lost = numpy.isnan(images[:, :2]).any(axis=1)
    images[lost] = 0.0
    result = {}
    for name, layer in layers.items():
        shapes, marks = [], []
        for shape in divided[name]:
            first = begin
            mapped = shape if shape is None or shape.is_empty else transform(replace, shape)
            marks.append(int(lost[first:begin].any()))
            shapes.append(type(shape)() if marks[-1] else mapped)
        outside += sum(marks)
        result[name] = layer.set_geometry(shapes, crs=layer.crs)
        if any(marks):
            result[name][MARK] = marks
    return result, outside
