# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm figure"""

import math
from dataclasses import replace

import click
import numpy

from .. import images, meshes, options, pair, plots, report
from ..arrays import SYSTEMS
from ..files import USAGE, Failure, Input, Output
from ..mapping import PointMap

PIECES = 2000
"""Points along a grid line."""


def grid_lines(bounds, count):
    """Lines of a square grid, of shape (lines, PIECES, 2), with `count` squares along the longer side."""
    low, high = numpy.array(bounds).reshape(2, 2).T
    spacing = (high - low).max() / count
    numbers = ((high - low) / spacing + 1e-9).astype(int)
    lines = []
    for axis in (0, 1):
        margin = 0.5 * (high - low - numbers * spacing)[axis]
        for k in range(numbers[axis] + 1):
            line = numpy.linspace(low, high, PIECES)
            line[:, axis] = low[axis] + margin + k * spacing
            lines.append(line)
    return numpy.array(lines)


def read_close_up(text):
    try:
        x, y, r = map(float, text.split(","))
        if math.isfinite(x + y + r) and r > 0:
            return x, y, r
    except ValueError:
        pass
    raise Failure("--close-up is X,Y,R: the center and half the side of a square in the target.", USAGE)


@click.command("figure")
@options.output("The figure: .png .svg .pdf, or - for standard output.", "png")
@options.map_settings("smooth; for a PROJ triangulation file linear")
@click.option("--all-systems", is_flag=True, help="Draw one panel for each coordinate system.")
@click.option("--grid", type=click.IntRange(1, 500), default=16, metavar="NUMBER", show_default=True,
              help="Number of grid squares along the longer side.")
@click.option("--image", default="", metavar="FILE", help="Image over the source, drawn below the grid and warped with it.")
@click.option("--close-up", default="", metavar="X,Y,R",
              help="Add close-ups of a square in the target: its center and half its side.")
@click.option("--width", type=options.Number(50, 5000), default=420.0, metavar="NUMBER", show_default=True,
              help="Width of a panel in pixels.")
@options.pair_files("SOURCE [TARGET]")
@options.quiet
def command(inputs, output, force, output_format, settings, all_systems, grid, image, close_up, width):
    """Draw a grid over the source and its image over the target. Meshes must be planar."""
    close_up = read_close_up(close_up) if close_up else None
    target = Output(output, output_format, force, plots.FORMATS, "a figure")
    raster, dark = None, False
    if image:
        with Input(image) as file:
            raster = images.read(file)
        inputs.grids = lambda marks: (raster.grid, None if marks.crs else options.scan_grids(inputs)[1] or raster.grid)
    both = report.require_map(options.read_pair(inputs), settings.mask_invalid)
    if raster:
        raster.grid = raster.grid.hanging() if both.landmarks else raster.grid
        size = (raster.grid.width, raster.grid.height)
        pair.fit_to_pictures(both, [size, size])
        images.require_overlap(raster.grid, image, both.source, both.name_of(0))
        dark = raster.all()[:, :, : max(1, raster.bands - raster.has_alpha)].mean() < 0.5 * images.brightest(raster.dtype)
    both.require_flat()
    if all_systems:
        settings.options["discordant_by_linear"] = True
    systems = list(SYSTEMS) if all_systems else [settings.choose(both).system]
    # Heights and fallback are not drawn.
    both = replace(both, shift=None)
    settings = [replace(settings, system=system) for system in systems]
    points = [meshes.points_of(mesh)[:, :2] for mesh in both.meshes]
    bounds = [plots.bounds_of(p) for p in points]
    lines = grid_lines(plots.bounds_of(points[0], 0.0), grid)
    mapped = [PointMap(both, own).map_points(lines.reshape(-1, 2))[0].reshape(lines.shape) for own in settings]
    # Lines of the source end at the boundary of the domain.
    panels = [("Source", 0, settings[-1], numpy.where(numpy.isnan(mapped[0]), numpy.nan, lines))]
    panels += [(own.system.capitalize(), 1, own, drawn) for own, drawn in zip(settings, mapped)]
    limits = [bounds[side] for _, side, _, _ in panels]
    figure, axes = plots.new_figure(width, [title for title, _, _, _ in panels], limits, 2 if close_up else 1)
    line_color, mesh_color = ("#ffd91a", "#1a339980") if dark else ("#bf1a26", "#334d7373")
    for column, (_, side, own, drawn) in enumerate(panels):
        picture = raster and _picture(raster, both, own, side)
        for row, panel in enumerate(axes[:, column]):
            if picture:
                panel.imshow(picture[0], extent=picture[1], interpolation="nearest", cmap="gray", vmin=0,
                             vmax=images.brightest(picture[0].dtype))
                panel.set(xlim=limits[column][:2], ylim=limits[column][2:])
            if row:
                x, y, r = close_up
                if side == 0:
                    x, y = PointMap(both, settings[0], inverse=True).map_points(numpy.array([[x, y]]))[0][0]
                panel.set(xlim=(x - r, x + r), ylim=(y - r, y + r))
            plots.draw_polygons(panel, plots.polygons_of(both.meshes[side], points[side]), facecolors="none",
                                edgecolors=mesh_color, linewidths=0.7 * (1 + row))
            for line in drawn:
                panel.plot(*line.T, color=line_color, linewidth=0.8 * (1 + row))
    plots.save(figure, target)


def _picture(raster, both, settings, side):
    """The image, or the warped one with three pixels for one, so that close-ups show lines, and its extent."""
    grid, pixels = raster.grid, raster.all()
    if side == 1:
        if both.landmarks and both.landmarks.crs:
            grid = images.Warp(both, settings).fit_grid(raster, (grid.width, grid.height))
        grid = replace(grid, width=3 * grid.width - 2, height=3 * grid.height - 2, dx=grid.dx / 3, dy=grid.dy / 3)
        pixels, mask = images.Warp(both, settings).warp(raster, grid, "")
        pixels = images.finish(pixels, mask, raster.has_alpha, None)
        if pixels.shape[2] == 2:
            pixels = pixels[:, :, [0, 0, 0, 1]]
    x0, x1, y0, y1 = grid.bounds
    extent = (x0 - grid.dx / 2, x1 + grid.dx / 2, y0 - grid.dy / 2, y1 + grid.dy / 2)
    return (pixels[:, :, 0] if pixels.shape[2] < 3 else pixels), extent
