# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm warp"""

from dataclasses import replace

import click

from .. import images, options
from ..files import PICTURES, USAGE, Failure, quote
from ..mapping import choose_system
from ..pair import are_same_crs


@click.command("warp")
@options.output("The warped image: .png .jpg .tif .ppm, or - for standard output.", "png", PICTURES, "an image")
@options.map_settings("cubic; for a PROJ triangulation file linear")
@options.inverse
@click.option("--size", type=options.Size(), metavar="WIDTHxHEIGHT", help="Size of the result in pixels.")
@click.option("--resolution", type=options.POSITIVE, metavar="LENGTH",
              help="Pixel size of the result, in units of its coordinate reference system.")
@click.option("--like", default="", metavar="FILE", help="Use the pixel grid of this GeoTIFF for the result.")
@click.option("--nearest", is_flag=True,
              help="Use the value of the nearest pixel instead of interpolating (for classes).")
@options.crs
@options.background
@options.pair_files("SOURCE [TARGET] IMAGE")
def command(inputs, output, inverse, size, resolution, like, nearest, crs, background, **settings):
    """Warp an image from the source's domain to the target's.

    IMAGE is a .png .jpg .tif or .ppm file. Meshes are in pixel coordinates (the center of the lower left pixel is
    (0, 0), y points upwards); xmorph meshes are in their own units. A GeoTIFF is warped in its coordinate reference
    system, in tiles, to a GeoTIFF.

    The value of each pixel is interpolated linearly at its preimage. In the outer half of the pixels at the border of
    the image, it is that of these pixels. If the result's pixels are at least twice as wide as the image's, the image
    is first reduced by averaging. With --nearest, the value is that of the pixel whose area contains the preimage, and
    a GeoTIFF keeps its palette unless there is a --background."""
    color = images.read_background(background, output.format)
    inputs.crs = None if inverse else crs
    order = slice(None, None, -1 if inverse else 1)
    raster = images.read(inputs.other, inputs.format or "png", nearest and not background)
    own, sized = raster.grid, images.Grid(*size) if size else None
    if own.placed:
        # On the ground there are no pixels of landmarks, but a scan has them.
        inputs.grids = [inputs.grids[0] or (sized if inverse else None), None]
    else:
        inputs.grids = [own, sized or own][order]
    both = options.read_pair(inputs)
    settings, marks = choose_system(settings, both, "cubic"), both.landmarks
    if marks and marks.image_coordinates and not (marks.crs or own.placed or inverse):
        raise Failure(f"{both.name} does not name the coordinate reference system of its target: use --crs.", USAGE)
    # A layer that goes back onto a scan becomes an image without georeference.
    scan = marks and inverse and own.placed and inputs.grids[0]
    placed = not scan and (own.placed or bool(marks and marks.crs and not inverse))
    for name, value in (("--resolution", resolution), ("--like", like), ("--crs", crs)):
        if value and not placed:
            raise Failure(f"{name} is for georeferenced rasters, but {raster.name} is not georeferenced.", USAGE)
    if placed and output.format not in ("tif", "tiff"):
        raise Failure(f"A georeferenced raster must be written as .tif, not as .{output.format}.", USAGE)
    grid = scan or (own if placed else sized or own)
    expected = both.crs(inverse)[0]
    if own.crs and expected and own.crs != expected:
        raise Failure(f"{raster.name} is in the coordinate reference system {own.crs.to_string()}, but the map is "
                      f"from {expected}: reproject it first.")
    if like:
        grid = images.read(like).grid
        if not grid.placed:
            raise Failure(f"{like} is not georeferenced (--like).", USAGE)
    both.fit((own, grid)[order], {int(inverse): raster})
    grid = grid.hanging() if marks and not placed else grid
    warp = images.Warp(both, settings, inverse, nearest)
    if placed:
        both.compare_crs(crs, inverse)
        known = both.crs(inverse)[1]
        crs = crs or (own.crs if known is None else known or None)
        if like and grid.crs and crs and not are_same_crs(grid.crs, crs):
            raise Failure(f"{like} (--like) is in the coordinate reference system {grid.crs.to_string()}, but the "
                          f"result is in {quote(crs)}.")
        grid = replace(grid, crs=crs or grid.crs) if like else warp.fit_grid(raster, size, resolution, crs)
    images.require_overlap(grid, "the result", both.meshes[not inverse], both.name_of(not inverse))
    with output.writing():
        images.write_warped(warp, raster, grid, output, color)
