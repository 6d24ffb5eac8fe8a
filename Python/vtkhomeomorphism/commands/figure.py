# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm figure"""

from dataclasses import replace

import click
import numpy

from .. import images, options, plots, report
from ..arrays import SYSTEMS, points_of
from ..files import Failure
from ..mapping import PointMap, choose_system

PIECES = 2000  # points along a grid line


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


@click.command("figure")
@options.output("The figure: .png .svg .pdf, or - for standard output.", "png", plots.FORMATS, "a figure")
@options.map_settings("smooth; for a PROJ triangulation file linear")
@click.option("--all-systems", is_flag=True, help="Draw one panel for each coordinate system.")
@click.option("--grid", type=click.IntRange(1, 500), default=16, metavar="NUMBER",
              help="Number of grid squares along the longer side.")
@click.option("--image", default="", metavar="FILE", help="Draw an image over the source, and warped over the target.")
@click.option("--close-up", type=(options.Number(), options.Number(), options.POSITIVE), metavar="X Y R",
              help="Add close-ups of a square in the target: its center and half its side.")
@options.pair_files("SOURCE [TARGET]")
def command(inputs, output, all_systems, grid, image, close_up, **settings):
    """Draw a grid over the source and its image over the target. Meshes must be planar."""
    raster = images.read(image) if image else None
    if raster:
        inputs.grids = [raster.grid, inputs.grids[1] or raster.grid]
    both = report.require_map(options.read_pair(inputs), settings["mask_invalid"])
    if raster:
        both.fit((raster.grid, raster.grid), {0: raster})
    both.require_flat()
    settings = {**settings, "discordant_by_linear": True} if all_systems else choose_system(settings, both)
    # Heights and the fallback strategy do not matter for figures.
    both = replace(both, shift=None)
    points = [points_of(mesh)[:, :2] for mesh in both.meshes]
    lines = grid_lines(points[0], grid)
    panels = []
    for system in SYSTEMS if all_systems else [settings["system"]]:
        own = {**settings, "system": system}
        mapped = PointMap(both, own).map_points(lines.reshape(-1, 2))[0].reshape(lines.shape)
        panels.append((system.capitalize(), 1, own, mapped))
    # Lines of the source end at the boundary of the domain.
    panels.insert(0, ("Source", 0, panels[-1][2], numpy.where(numpy.isnan(panels[0][3]), numpy.nan, lines)))
    if close_up:
        center = numpy.array(close_up[:2])
        centers = [PointMap(both, panels[1][2], inverse=True).map_points(center[None])[0][0], center]
        if numpy.isnan(centers[0]).any():
            raise Failure(f"The point {close_up[:2]} is outside the target (--close-up).")
    figure, axes = plots.new_figure(420, [panel[0] for panel in panels], points[1], 2 if close_up else 1)
    colors = raster and raster.all()[:, :, : raster.bands - raster.has_alpha]
    dark = raster and colors.mean() < 0.5 * images.brightest(raster.dtype)
    line_color, mesh_color = ("#ffd91a", "#1a339980") if dark else ("#bf1a26", "#334d7373")
    for column, (_, side, own, drawn) in enumerate(panels):
        picture = raster and _picture(raster, both, own, side)
        for row, panel in enumerate(axes[:, column]):
            plots.draw_polygons(panel, both.meshes[side], points[side], facecolors="none", edgecolors=mesh_color,
                                linewidths=0.7 * (1 + row))
            panel.autoscale(False)
            panel.plot(*drawn.T, color=line_color, linewidth=0.8 * (1 + row))
            if picture:
                largest = images.brightest(picture[0].dtype)
                panel.imshow(picture[0], extent=picture[1], cmap="gray", vmin=0, vmax=largest)
            if row:
                (x, y), r = centers[side], close_up[2]
                panel.set(xlim=(x - r, x + r), ylim=(y - r, y + r))
    plots.save(figure, output)


def _picture(raster, both, settings, side):
    """The image and its extent. On side 1, it is warped, with three times as many pixels in each direction, so that
    close-ups show lines."""
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
