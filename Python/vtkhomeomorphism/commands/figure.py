# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm figure"""

import math
from dataclasses import replace

import click
import numpy

from .. import images, options, pair, plots, report
from ..arrays import SYSTEMS, points_of
from ..files import USAGE, Failure, Input
from ..mapping import PointMap

PIECES = 2000
"""Points along a grid line."""


def grid_lines(points, count):
    """Lines of a square grid over points, of shape (lines, PIECES, 2), with `count` squares along the longer side."""
    low, high = points.min(axis=0), points.max(axis=0)
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


def read_close_up(context, param, text):
    try:
        x, y, r = map(float, text.split(",")) if text else (0, 0, 1)
        if math.isfinite(x + y + r) and r > 0:
            return (x, y, r) if text else None
    except ValueError:
        pass
    raise Failure("--close-up is X,Y,R: the center and half the side of a square in the target.", USAGE)


@click.command("figure")
@options.output("The figure: .png .svg .pdf, or - for standard output.", "png", plots.FORMATS, "a figure")
@options.map_settings("smooth; for a PROJ triangulation file linear")
@click.option("--all-systems", is_flag=True, help="Draw one panel for each coordinate system.")
@click.option("--grid", type=click.IntRange(1, 500), default=16, metavar="NUMBER", show_default=True,
              help="Number of grid squares along the longer side.")
@click.option("--image", default="", metavar="FILE", help="Image over the source, drawn below the grid and warped with it.")
@click.option("--close-up", default="", metavar="X,Y,R", callback=read_close_up,
              help="Add close-ups of a square in the target: its center and half its side.")
@click.option("--width", type=options.Number(50, 5000), default=420.0, metavar="NUMBER", show_default=True,
              help="Width of a panel in pixels.")
@options.pair_files("SOURCE [TARGET]")
@options.quiet
def command(inputs, output, settings, all_systems, grid, image, close_up, width):
    """Draw a grid over the source and its image over the target. Meshes must be planar."""
    raster = None
    if image:
        with Input(image) as file:
            raster = images.read(file)
        inputs.grids = lambda marks: (raster.grid, None if marks.crs else options.scan_grids(inputs)[1] or raster.grid)
    both = report.require_map(options.read_pair(inputs), settings.mask_invalid)
    if raster:
        raster.grid = raster.grid.hanging() if both.landmarks else raster.grid
        pair.fit_to_pictures(both, (raster.grid, raster.grid))
        images.require_overlap(raster.grid, image, both.source, both.name_of(0))
    both.require_flat()
    if all_systems:
        settings.options["discordant_by_linear"] = True
    systems = list(SYSTEMS) if all_systems else [settings.choose(both).system]
    # Heights and fallback are not drawn.
    both = replace(both, shift=None)
    points = [points_of(mesh)[:, :2] for mesh in both.meshes]
    lines = grid_lines(points[0], grid)
    panels = []
    for system in systems:
        own = replace(settings, system=system)
        mapped = PointMap(both, own).map_points(lines.reshape(-1, 2))[0].reshape(lines.shape)
        panels.append((system.capitalize(), 1, own, mapped))
    # Lines of the source end at the boundary of the domain.
    panels.insert(0, ("Source", 0, panels[-1][2], numpy.where(numpy.isnan(panels[0][3]), numpy.nan, lines)))
    limits = [plots.bounds_of(points[side]) for _, side, _, _ in panels]
    figure, axes = plots.new_figure(width, [title for title, _, _, _ in panels], limits, 2 if close_up else 1)
    dark = raster and raster.all()[:, :, : max(1, raster.bands - raster.has_alpha)].mean() < 0.5 * images.brightest(raster.dtype)
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
                    x, y = PointMap(both, panels[1][2], inverse=True).map_points(numpy.array([[x, y]]))[0][0]
                panel.set(xlim=(x - r, x + r), ylim=(y - r, y + r))
            plots.draw_polygons(panel, plots.polygons_of(both.meshes[side], points[side]), facecolors="none",
                                edgecolors=mesh_color, linewidths=0.7 * (1 + row))
            for line in drawn:
                panel.plot(*line.T, color=line_color, linewidth=0.8 * (1 + row))
    plots.save(figure, output)


def _picture(raster, both, settings, side):
    """The image, or the warped one with three pixels for one, so that close-ups show lines, and its extent."""
    grid, pixels = raster.grid, raster.all()
    if side == 1:
        warp = images.Warp(both, settings)
        if both.landmarks and both.landmarks.crs:
            grid = warp.fit_grid(raster, grid.size)
        grid = replace(grid, width=3 * grid.width - 2, height=3 * grid.height - 2, steps=grid.steps / 3)
        pixels = images.finish(*warp.warp(raster, grid, ""), raster.has_alpha, None)
        if pixels.shape[2] == 2:
            pixels = pixels[:, :, [0, 0, 0, 1]]
    extent = grid.bounds + numpy.repeat(numpy.abs(grid.steps).sum(axis=1) / 2, 2) * [-1, 1, -1, 1]
    return (pixels[:, :, 0] if pixels.shape[2] < 3 else pixels), extent
