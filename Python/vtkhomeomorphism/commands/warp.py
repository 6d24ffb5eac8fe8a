# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm warp"""

from dataclasses import replace

import click

from .. import images, options, pair
from ..files import USAGE, Failure, Input, Output

background_option = click.option(
    "--background", default="", metavar="COLOR", help="Color outside the domain: transparent (default; white in .jpg "
    "and .ppm; the raster's own value for no data), white, black or #rrggbb.")


@click.command("warp")
@options.pair_files("SOURCE [TARGET] IMAGE", others=1)
@options.output("The warped image: .png .jpg .tif .ppm .vti, or - for standard output.", "png")
@click.option("--image-format", default="png", metavar="EXTENSION", show_default=True,
              help="Format of an image from standard input.")
@options.map_settings("smooth; for a PROJ triangulation file linear")
@options.inverse
@click.option("--size", default="", metavar="WIDTHxHEIGHT", help="Size of the result in pixels.")
@click.option("--resolution", type=options.Number(above=True), default=0.0, metavar="LENGTH",
              help="Size of the result's pixels on the ground (georeferenced rasters).")
@click.option("--like", default="", metavar="FILE", help="Write the result on the pixels of this GeoTIFF.")
@click.option("--crs", metavar="CRS", help="Coordinate reference system of the result, such as EPSG:3067 (default: what "
              "the triangulation file says, or the raster's own).")
@background_option
@options.quiet
def command(inputs, output, force, output_format, image_format, settings, inverse, size, resolution, like, crs,
            background):
    """Warp an image from the source's domain to the target's.

    IMAGE is a .png .jpg .tif .ppm or .vti. Meshes are in its pixels (the lower left pixel's center is (0, 0), y runs
    upwards), or, for xmorph's meshes, in their own units. A GeoTIFF is mapped in its coordinate reference system,
    piece by piece, and becomes a GeoTIFF.

    Each pixel of the result is interpolated linearly at its exact preimage."""
    size = options.read_size(size)
    target = Output(output, output_format, force, images.WRITE, "an image")
    color = images.read_background(background, target.format)
    inputs.crs = None if inverse else crs
    with Input(inputs.others[0], image_format, "--image-format") as file:
        opened = []

        def grids(marks):
            opened.append(images.read(file))
            own = opened[0].grid
            if own.placed:
                return options.scan_grids(inputs)[0] or (images.Grid(*size) if inverse and size else None), None
            if marks.crs and not inverse:
                return own, None
            if marks.image_coordinates and not inverse:
                raise Failure(f"{inputs.pair[0]} does not name the coordinate reference system of its target: give --crs.", USAGE)
            return (own, images.Grid(*size) if size else own)[:: -1 if inverse else 1]

        inputs.grids = grids
        both = options.read_pair(inputs)
        settings = replace(settings, system=settings.system_for(both))
        raster = opened[0] if opened else images.read(file)
        # A layer that goes back onto a scan becomes an image without georeference.
        marks = both.landmarks
        scan = marks and inverse and raster.grid.placed and grids(marks)[0]
        placed = not scan and (raster.grid.placed or bool(marks and marks.crs and not inverse))
        if not placed:
            for name, value in (("--resolution", resolution), ("--like", like), ("--crs", crs)):
                if value:
                    raise Failure(f"{name} is for georeferenced rasters, which {file.name} is not.", USAGE)
        if marks and not raster.grid.placed:
            raster.grid = raster.grid.hanging()
        grid = scan.hanging() if scan else raster.grid
        if not placed and not scan and size:
            grid = images.Grid(*size) if target.format != "vti" else replace(grid, width=size[0], height=size[1])
            grid = grid.hanging() if marks else grid
        sizes = [(g.width, g.height) for g in (raster.grid, grid)]
        pair.fit_to_pictures(both, sizes[::-1] if inverse else sizes)
        side = int(inverse)
        images.require_overlap(raster.grid, file.name, both.meshes[side], both.name_of(side))
        warp = images.Warp(both, settings, inverse)
        if placed:
            if target.format not in ("tif", "tiff"):
                raise Failure(f"A georeferenced raster becomes a .tif, not a .{target.format}.", USAGE)
            crs = crs or (both.shift and both.shift.crs(inverse)) or (marks and marks.crs) or grid.crs
            if like:
                with Input(like) as model:
                    grid = images.read(model).grid
            else:
                grid = warp.fit_grid(raster, size, resolution, crs)
        images.require_overlap(grid, "the result", both.meshes[1 - side], both.name_of(1 - side))
        if placed:
            with target as place:
                writer = images.TiffWriter(place, grid, raster, None if not background else color)
                for tile in warp.tiles(raster, grid):
                    writer.write(*tile)
                writer.close()
            return
        pixels, mask = warp.warp(raster, grid)
        pixels = images.finish(pixels, mask, raster.has_alpha, color)
        with target as place:
            images.write(pixels, place, grid)
