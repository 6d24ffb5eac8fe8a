# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm warp"""

from dataclasses import replace

import click

from .. import images, options, pair
from ..files import USAGE, Failure, Input

background_option = click.option(
    "--background", default="", metavar="COLOR", help="Color outside the domain: transparent, white, black or "
    "#rrggbb (default: transparent, or the raster's no-data value; white in .jpg and .ppm).")


@click.command("warp")
@options.output("The warped image: .png .jpg .tif .ppm .vti, or - for standard output.", "png", images.WRITE, "an image")
@options.map_settings("cubic; for a PROJ triangulation file linear")
@options.inverse
@click.option("--size", type=options.Size(), metavar="WIDTHxHEIGHT", help="Size of the result in pixels.")
@click.option("--resolution", type=options.POSITIVE, metavar="LENGTH",
              help="Pixel size of the result on the ground (georeferenced rasters).")
@click.option("--like", default="", metavar="FILE", help="Use the pixel grid of this GeoTIFF for the result.")
@click.option("--crs", metavar="CRS", help="Coordinate reference system of the result, such as EPSG:3067 (default: that "
              "of the file of the pair, or of the raster).")
@background_option
@options.pair_files("SOURCE [TARGET] IMAGE")
@options.quiet
def command(inputs, output, settings, inverse, size, resolution, like, crs, background):
    """Warp an image from the source's domain to the target's.

    IMAGE is a .png .jpg .tif .ppm or .vti file. Meshes are in pixel coordinates (the center of the lower left pixel is
    (0, 0), y points upwards); xmorph meshes are in their own units. A GeoTIFF is warped in its coordinate reference
    system, in tiles, to a GeoTIFF.

    The value of each pixel is interpolated linearly at its exact preimage."""
    color = images.read_background(background, output.format)
    inputs.crs = None if inverse else crs
    with Input(inputs.other, inputs.format or "png") as file:
        raster = images.read(file)
        own = raster.grid

        def find_grids(marks):
            """Those of the source and the target in pixels, for landmarks."""
            if own.placed:
                return options.scan_grids(inputs)[0] or (images.Grid(*size) if inverse and size else None), None
            if marks.crs and not inverse:
                return own, None
            if marks.image_coordinates and not inverse:
                raise Failure(f"{inputs.pair[0]} does not name the coordinate reference system of its target: give --crs.", USAGE)
            return (own, images.Grid(*size) if size else own)[:: -1 if inverse else 1]

        inputs.grids = find_grids
        both = options.read_pair(inputs)
        settings = settings.choose(both, "cubic")
        marks = both.landmarks
        # A layer that goes back onto a scan becomes an image without georeference.
        scan = marks and inverse and own.placed and find_grids(marks)[0]
        placed = not scan and (own.placed or bool(marks and marks.crs and not inverse))
        for name, value in (("--resolution", resolution), ("--like", like), ("--crs", crs)):
            if value and not placed:
                raise Failure(f"{name} is for georeferenced rasters, which {file.name} is not.", USAGE)
        if placed and output.format not in ("tif", "tiff"):
            raise Failure(f"A georeferenced raster becomes a .tif, not a .{output.format}.", USAGE)
        grid = scan or own
        if like:
            with Input(like) as model:
                grid = images.read(model).grid
        elif size and not placed and not scan:
            grid = images.Grid(*size)
        pair.fit_to_pictures(both, (own, grid)[:: -1 if inverse else 1])
        if marks:
            raster.grid = own if own.placed else own.hanging()
            grid = grid if placed else grid.hanging()
        images.require_overlap(raster.grid, file.name, both.meshes[inverse], both.name_of(inverse))
        warp = images.Warp(both, settings, inverse)
        if placed:
            crs = crs or (both.shift and both.shift.crs(inverse)) or (marks and marks.crs) or own.crs
            grid = replace(grid, crs=crs) if like else warp.fit_grid(raster, size, resolution, crs)
        images.require_overlap(grid, "the result", both.meshes[not inverse], both.name_of(not inverse))
        with output:
            images.write_warped(warp, raster, grid, output, color)
