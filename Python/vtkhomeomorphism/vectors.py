# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Vector data (GeoPackage, GeoJSON, Shapefile, FlatGeobuf), read and written by geopandas. Geometries are mapped vertex
by vertex; attributes and layers are kept."""

import contextlib
import copy
import io

import numpy

from .files import FILE, USAGE, Failure, inform, quote, quote_message

DRIVERS = {"gpkg": "GPKG", "geojson": "GeoJSON", "shp": "ESRI Shapefile", "fgb": "FlatGeobuf"}
MARK = "outside"  # the column of features that are not within the domain; their geometries are empty


def read(input):
    """The layers of a file, a dict from names to GeoDataFrames; tables without geometry may be DataFrames. With
    geopandas before 1.0, their attrs have the schema, which has more information about the types of columns."""
    import geopandas

    try:
        if hasattr(geopandas, "list_layers"):
            return {name: geopandas.read_file(input.path, layer=name)
                    for name in geopandas.list_layers(input.path)["name"]}
        import fiona

        layers = {}
        for name in fiona.listlayers(input.path):
            layers[name] = geopandas.read_file(input.path, layer=name)
            with fiona.open(input.path, layer=name) as file:
                layers[name].attrs["schema"] = file.schema
        return layers
    except Exception as error:
        input.fail_by(error)


def is_table(layer):
    """Whether a layer has no geometry, like the styles that QGIS adds to a GeoPackage."""
    return not hasattr(layer, "geometry") or layer.attrs.get("schema", {}).get("geometry") == "None"


def _write_layer(frame, path, driver, **options):
    if not hasattr(frame, "geometry"):
        import pyogrio

        pyogrio.write_dataframe(frame, path, driver=driver, **options)
        return
    if "schema" in frame.attrs:
        from geopandas.io.file import infer_schema

        schema = frame.attrs["schema"]
        is_empty = all(shape is None for shape in frame.geometry)
        found = infer_schema(frame)
        # Fiona reads some switches as integers.
        switches = {name: kind for name, kind in found["properties"].items() if kind == "bool"}
        options["schema"] = {"geometry": schema["geometry"] if is_empty else found["geometry"],
                             "properties": {**schema["properties"], **switches}}
    frame.to_file(path, driver=driver, index=False, **options)


def write(layers, output):
    """Writes layers to one file; only GeoPackage can contain several."""
    tables = [name for name in layers if is_table(layers[name])]
    if tables and output.format != "gpkg":
        inform(f"{output.name} cannot contain tables without geometry: {', '.join(tables)} is left out.")
        layers = {name: layer for name, layer in layers.items() if name not in tables}
    if len(layers) > 1 and output.format != "gpkg":
        raise Failure(f"{output.name} can contain one layer, not {len(layers)} ({', '.join(layers)}): write a .gpkg.")
    try:
        # GDAL's messages are in the exceptions.
        with contextlib.redirect_stderr(io.StringIO()):
            for name, layer in layers.items():
                options = {"layer": name} if output.format == "gpkg" else {}
                _write_layer(layer, output.path, DRIVERS[output.format], **options)
    except OSError:
        raise
    except Exception as error:
        raise Failure(f"Cannot write {output.name}: {quote_message(error, output)}", FILE) from None


def divide(points, step):
    """A polygonal line of shape (n, 2) or (n, 3), with points added so that no segment is longer than `step`."""
    parts = numpy.maximum(1, numpy.ceil(numpy.hypot(*numpy.diff(points[:, :2], axis=0).T) / step)).astype(int)
    ends = numpy.concatenate(([0], numpy.cumsum(parts)))
    return numpy.column_stack([numpy.interp(numpy.arange(ends[-1] + 1), ends, column) for column in points.T])


def map_layers(layers, map_points, densify=0.0, source_crs=None, target_crs=None):
    """Maps the vertices of layers, all in one call: `map_points` maps an array of shape (n, 3) to the images, NaN
    outside. The coordinate reference system becomes `target_crs`; None keeps it, and "" removes it. Returns the layers,
    and the number of features that are not entirely inside the domain."""
    from shapely.ops import transform

    collected, lost = [], []

    def change(function, shape):
        return shape if shape is None or shape.is_empty else transform(function, shape)

    def collect(*coordinates):
        points = numpy.column_stack(coordinates)
        points = divide(points, densify) if densify and len(points) > 1 else points
        collected.append(numpy.pad(points, ((0, 0), (0, 3 - points.shape[1]))))
        return tuple(points.T)

    def place(*coordinates):
        part = next(parts)
        lost.append(numpy.isnan(part[:, :2]).any())
        return tuple((numpy.zeros_like(part) if lost[-1] else part).T[: len(coordinates)])

    def map_shape(shape):
        """The mapped shape, and whether a part of it is outside; if so, the shape is empty."""
        lost.clear()
        mapped = change(place, shape)
        return (type(shape)() if any(lost) else mapped), any(lost)

    divided = {name: [change(collect, shape) for shape in layer.geometry]
               for name, layer in layers.items() if not is_table(layer)}
    images = map_points(numpy.vstack([numpy.empty((0, 3)), *collected]))
    parts = iter(numpy.split(images, numpy.cumsum([len(points) for points in collected])))
    result, outside = {}, 0
    for name, layer in layers.items():
        if is_table(layer):
            result[name] = layer
            continue
        if source_crs and layer.crs and layer.crs != source_crs:
            inform(f"Layer {name}: its coordinate reference system is {layer.crs.to_string()}, but that of the map's "
                   f"domain is {source_crs}.")
        shapes, marks = zip(*map(map_shape, divided[name])) if divided[name] else ((), ())
        result[name] = layer.set_geometry(list(shapes), crs=layer.crs)
        result[name].attrs = copy.deepcopy(layer.attrs)
        if target_crs is not None:
            result[name].crs = None
            try:
                result[name].crs = target_crs or None
            except Exception:
                raise Failure(f"Unknown coordinate reference system {quote(target_crs)}: give another one (--crs).",
                              USAGE) from None
        if any(marks):
            if MARK in layer.columns:
                inform(f"Layer {name}: the column {MARK} is replaced.")
            result[name][MARK] = numpy.array(marks, int)
            result[name].attrs.get("schema", {"properties": {}})["properties"][MARK] = "int"
            outside += sum(marks)
    return result, outside
