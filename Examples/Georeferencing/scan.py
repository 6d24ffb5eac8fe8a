#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""A generated scan with control points whose truth is known, for Examples/georeference.

    scan.py write FOLDER [WIDTH HEIGHT]     scan.tif, positions.tif, control.points, control-2.points, roads.gpkg
    scan.py compare FOLDER RECTIFIED.tif    how far a rectified positions.tif is from the truth
    scan.py layers BEFORE.gpkg AFTER.gpkg   the largest difference, relative to the extent
    scan.py draw FOLDER                     scan.png: the scan and all-points.tif, rectified.tif, with the true streets

The sheet is bent by a known map, by 22 pixels beyond the best affine map at most. The control points are exact
except for two, which are mistyped by 30 pixels; four rows are disabled. The bands of positions.tif are each pixel's own
coordinates: a rectified one shows where each pixel came from.
"""

import os
import sys
import warnings

import numpy

CRS = "EPSG:3857"
ORIGIN, METERS, ANGLE = numpy.array([1490000.0, 6890000.0]), 2.5, 0.12
BENDS = 0.004, 0.0075
"""The displacement of the middle of a vertical and of a horizontal edge, as a fraction of the image's width."""
MISTYPED = {17: (30.0, 0.0), 41: (-18.0, 24.0)}
"""Errors in pixels, by the number of the control point."""
DISABLED = (5, 23, 38, 50)
"""The rows before which a disabled control point is inserted."""


class Sheet:
    """The map from the scan's pixels (from the upper left corner, y downwards) to the ground: each row is displaced by
    a parabola, then each column, and the result is rotated and scaled."""

    def __init__(self, width=4000, height=3000):
        self.size = numpy.array([width, height], float)
        self.width, self.height, self.bends = width, height, numpy.array(BENDS) * width

    def to_ground(self, pixels):
        u, v = numpy.asarray(pixels, float).T
        u = u + 4 * self.bends[0] * (v / self.height - 0.5) ** 2
        v = v + 4 * self.bends[1] * (u / self.width - 0.5) ** 2
        cos, sin = METERS * numpy.cos(ANGLE), METERS * numpy.sin(ANGLE)
        return ORIGIN + numpy.column_stack((cos * u + sin * v, sin * u - cos * v))

    def to_pixels(self, ground):
        x, y = (numpy.asarray(ground, float) - ORIGIN).T / METERS
        cos, sin = numpy.cos(ANGLE), numpy.sin(ANGLE)
        u, v = cos * x + sin * y, sin * x - cos * y
        v = v - 4 * self.bends[1] * (u / self.width - 0.5) ** 2
        return numpy.column_stack((u - 4 * self.bends[0] * (v / self.height - 0.5) ** 2, v))

    def pixel_centers(self):
        x, y = numpy.meshgrid(numpy.arange(self.width) + 0.5, numpy.arange(self.height) + 0.5)
        return numpy.column_stack((x.ravel(), y.ravel()))

    def control_points(self):
        """60 pixels, on a perturbed grid, and their positions on the ground, two of them wrong."""
        i, j = numpy.meshgrid(numpy.arange(10), numpy.arange(6))
        own = numpy.column_stack(((i.ravel() + 0.5) / 10, (j.ravel() + 0.5) / 6))
        own = (own + numpy.random.default_rng(3).uniform(-0.02, 0.02, own.shape)) * self.size
        pixels = numpy.round(own, 2)
        ground = self.to_ground(pixels)
        for k, error in MISTYPED.items():
            ground[k] = self.to_ground(pixels[k : k + 1] + error)[0]
        return pixels, ground

    def bend_beyond_affine(self):
        """The largest distance, in pixels, from the affine map that fits the whole sheet best."""
        t = numpy.linspace(0, 1, 41)
        pixels = numpy.stack(numpy.meshgrid(t, t), axis=-1).reshape(-1, 2) * self.size
        ground = self.to_ground(pixels)
        columns = numpy.column_stack((pixels, numpy.ones(len(pixels))))
        fitted = columns @ numpy.linalg.lstsq(columns, ground - ORIGIN, rcond=None)[0] + ORIGIN
        return numpy.hypot(*(ground - fitted).T).max() / METERS

    def draw(self):
        """An old map in three colors, of shape (height, width, 3): relief, a river, streets and a graticule."""
        u, v = (self.pixel_centers() / self.width).T.reshape(2, self.height, self.width)
        relief = numpy.sin(9 * u + 2 * numpy.sin(7 * v)) + numpy.cos(8 * v - 3 * u)
        shade = numpy.gradient(relief, axis=1) - numpy.gradient(relief, axis=0)
        paper = 225 + 12 * shade / numpy.abs(shade).max()
        paint = numpy.stack([paper, paper - 9, paper - 38], axis=-1)

        def line(distance, width, color):
            t = numpy.clip((width - numpy.abs(distance)) * self.width / 2 + 0.5, 0, 1)[..., None]
            paint[:] = (1 - t) * paint + t * numpy.array(color)

        step = (relief * 3) % 1
        line(numpy.minimum(step, 1 - step) / 30, 0.0005, (172, 133, 92))
        line(v - 0.36 - 0.1 * numpy.sin(6 * u) - 0.02 * numpy.sin(25 * u), 0.009, (96, 140, 176))
        for a, b, c in ((0.2, 1, 0.45), (1, -0.35, 0.32), (1, 0.25, 0.75), (-0.5, 1, 0.1)):
            line((a * u + b * v - c) / numpy.hypot(a, b), 0.0022, (120, 40, 36))
        for k in range(1, 10):
            line(u - k / 10, 0.0004, (60, 60, 60)), line(v - k / 10, 0.0004, (60, 60, 60))
        edge = numpy.minimum(numpy.minimum(u, 1 - u), numpy.minimum(v, self.height / self.width - v))
        line(edge - 0.012, 0.0012, (40, 40, 40))
        return numpy.clip(paint, 0, 255).astype(numpy.uint8)


def write_points(path, pixels, ground, version):
    """Control points as QGIS 2 and 3 save them. The y axis points upwards, from 0 at the upper edge of the image."""
    rows = [(*p, *g, 1) for p, g in zip(pixels, ground)]
    for k in reversed(DISABLED):
        rows.insert(k, (*(pixels[k] + 3), *(ground[k] + 500), 0))
    with open(path, "w", encoding="utf-8") as file:
        if version == 3:
            file.write(f"#CRS: {CRS}\n")
        names, rest = ("source", ",0,0,0") if version == 3 else ("pixel", "")
        file.write(f"mapX,mapY,{names}X,{names}Y,enable{',dX,dY,residual' if rest else ''}\n")
        for u, v, x, y, used in rows:
            file.write(f"{x:.4f},{y:.4f},{u:.2f},{-v:.2f},{used}{rest}\n")


def names_of_mistyped(version=3):
    """The names of the wrong control points in dhm: their line numbers in the file, which has a header."""
    return [str(k + version + sum(row <= k for row in DISABLED)) for k in MISTYPED]


def write_tiff(path, pixels):
    import rasterio

    warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
    bands = numpy.moveaxis(pixels, 2, 0)
    with rasterio.open(path, "w", driver="GTiff", width=pixels.shape[1], height=pixels.shape[0], count=len(bands),
                       dtype=pixels.dtype, tiled=True, compress="deflate") as file:
        file.write(bands)


def write_roads(path, sheet):
    """A layer of lines on the ground, which agree with the map of the sheet."""
    import geopandas
    from shapely.geometry import LineString

    t = numpy.linspace(0.05, 0.95, 50)
    shapes = []
    for a, b, c in ((0.2, 1, 0.45), (-0.5, 1, 0.1)):
        v = (c - a * t) / b * sheet.width
        inside = (v > 0.03 * sheet.height) & (v < 0.97 * sheet.height)
        shapes.append(LineString(sheet.to_ground(numpy.column_stack((t * sheet.width, v)))[inside]))
    geopandas.GeoDataFrame({"name": ["first", "second"]}, geometry=shapes, crs=CRS).to_file(path, driver="GPKG")


def write(folder, width=4000, height=3000):
    sheet = Sheet(width, height)
    os.makedirs(folder, exist_ok=True)
    write_tiff(os.path.join(folder, "scan.tif"), sheet.draw())
    # In an image with two bands, the second is transparency.
    positions = numpy.column_stack((sheet.pixel_centers(), numpy.zeros(width * height)))
    write_tiff(os.path.join(folder, "positions.tif"), positions.reshape(height, width, 3).astype(numpy.float32))
    points = sheet.control_points()
    write_points(os.path.join(folder, "control.points"), *points, 3)
    write_points(os.path.join(folder, "control-2.points"), *points, 2)
    write_roads(os.path.join(folder, "roads.gpkg"), sheet)
    print(f"{width} x {height} pixels, bent by {sheet.bend_beyond_affine():.1f} pixels beyond the best affine map; "
          f"mistyped control points: {', '.join(names_of_mistyped())}")


def errors(sheet, rectified):
    """The distances, in pixels of the scan, between the positions from which the pixels of a rectified positions.tif
    were taken and the true ones, for all pixels whose true position is on the scan; infinite where the result is
    empty."""
    import rasterio

    with rasterio.open(rectified) as file:
        found = file.read().astype(float)
        column, row = numpy.meshgrid(numpy.arange(file.width) + 0.5, numpy.arange(file.height) + 0.5)
        ground = numpy.column_stack(file.transform * (column.ravel(), row.ravel()))
    truth = sheet.to_pixels(ground)
    # Values at the border would require pixels beyond it.
    inside = ((truth > 1) & (truth < sheet.size - 1)).all(axis=1)
    distances = numpy.hypot(*(found.reshape(len(found), -1)[:2].T[inside] - truth[inside]).T)
    return numpy.where(numpy.isfinite(distances), distances, numpy.inf)


def compare(folder, rectified):
    import rasterio

    warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
    with rasterio.open(os.path.join(folder, "positions.tif")) as file:
        sheet = Sheet(file.width, file.height)
    found = errors(sheet, rectified)
    print(f"{100 * (found <= 1).mean():.2f} % of the pixels are within a pixel of the truth; median "
          f"{numpy.median(found):.3f}, 95 %: {numpy.quantile(found, 0.95):.3f}, largest {found.max():.2f}")


def layers(before, after):
    import geopandas

    first, second = (geopandas.read_file(name) for name in (before, after))
    extent = numpy.ptp(numpy.reshape(first.total_bounds, (2, 2)), axis=0).max()
    largest = max(numpy.abs(numpy.subtract(a.coords, b.coords)).max() for a, b in zip(first.geometry, second.geometry))
    print(f"{after} differs from {before} by {largest:.2g} m, {largest / extent:.2g} of the extent")


def draw(folder):
    import geopandas
    import matplotlib
    import rasterio

    matplotlib.use("Agg")
    from matplotlib import pyplot

    warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
    figure, axes = pyplot.subplots(1, 3, figsize=(15, 4.3), layout="constrained")
    roads = geopandas.read_file(os.path.join(folder, "roads.gpkg"))
    titles = ("the scan and its control points", "rectified with all points", "rectified without the suspicious two")
    for panel, title, name in zip(axes, titles, ("scan.tif", "all-points.tif", "rectified.tif")):
        with rasterio.open(os.path.join(folder, name)) as file:
            shape = (file.height * 1000 // file.width, 1000)
            picture = numpy.moveaxis(file.read(out_shape=(file.count, *shape)), 0, 2)
            corners = [file.transform * p for p in ((0, file.height), (file.width, 0))]
            sheet = Sheet(file.width, file.height) if name == "scan.tif" else sheet
        panel.imshow(picture, extent=(corners[0][0], corners[1][0], corners[0][1], corners[1][1]))
        panel.set(title=title, xticks=[], yticks=[])
        pixels, ground = sheet.control_points()
        points = pixels if name == "scan.tif" else ground
        wrong = list(MISTYPED)
        panel.plot(*numpy.delete(points, wrong, axis=0).T, "+", color="#0b5d1e", markersize=7)
        if name != "rectified.tif":
            panel.plot(*points[wrong].T, "o", color="none", markeredgecolor="red", markersize=13, markeredgewidth=2)
        if name != "scan.tif":
            roads.plot(ax=panel, color="#00e5ff", linewidth=1.2)
    figure.savefig(os.path.join(folder, "scan.png"), dpi=80)


if __name__ == "__main__":
    if len(sys.argv) in (3, 5) and sys.argv[1] == "write":
        write(sys.argv[2], *map(int, sys.argv[3:]))
    elif len(sys.argv) == 4 and sys.argv[1] == "compare":
        compare(*sys.argv[2:])
    elif len(sys.argv) == 4 and sys.argv[1] == "layers":
        layers(*sys.argv[2:])
    elif len(sys.argv) == 3 and sys.argv[1] == "draw":
        draw(sys.argv[2])
    else:
        sys.exit(__doc__)
