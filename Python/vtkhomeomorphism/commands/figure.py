# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm figure"""

import math
from dataclasses import replace

import click
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from .. import images, meshes, options, pair, plots, report
from ..files import USAGE, Failure, Input, Output
from ..mapping import PointMap, run
from ..vtkFiltersHomeomorphism import vtkTriangularCoordinates

PIECES = 2000
"""Points along a grid line."""


def grid_lines(bounds, count):
    """Lines of a square grid, of shape (lines, PIECES, 2), with `count` squares along the longer side."""
    x0, x1, y0, y1 = bounds
    spacing = max(x1 - x0, y1 - y0) / count
    t = numpy.linspace(0, 1, PIECES)
    lines = []
    for begin, size, along in ((x0, x1 - x0, 1), (y0, y1 - y0, 0)):
        number = int(size / spacing + 1e-9)
        for k in range(number + 1):
            across = numpy.full(PIECES, begin + 0.5 * (size - number * spacing) + k * spacing)
            other = (y0 + t * (y1 - y0)) if along else (x0 + t * (x1 - x0))
            lines.append(numpy.column_stack((across, other) if along else (other, across)))
    return numpy.array(lines)


def coordinate_lines(mesh, settings, system):
    """A mesh's contours and rings, as a list of arrays of points."""
    coordinates = vtkTriangularCoordinates()
    settings.apply(coordinates, system)
    coordinates.SetInputDataObject(0, mesh)
    run(coordinates)
    lines = coordinates.GetLines()
    cells = lines.GetLines()
    ids, offsets = (vtk_to_numpy(a) for a in (cells.GetConnectivityArray(), cells.GetOffsetsArray()))
    return numpy.split(meshes.points_of(lines)[ids, :2], offsets[1:-1])


def read_close_up(text):
    try:
        values = [float(word) for word in text.split(",")] if text else None
    except ValueError:
        values = ()
    if values is not None and (len(values) != 3 or not all(map(math.isfinite, values)) or values[2] <= 0):
        raise Failure("--close-up is X,Y,R: the center and half the side of a square in the target.", USAGE)
    return values


@click.command("figure")
@options.pair_files("SOURCE [TARGET]")
@options.output("The figure: .png .svg .pdf, or - for standard output.", "png")
@options.map_settings("smooth")
@click.option("--all-systems", is_flag=True, help="Draw one panel per coordinate system.")
@click.option("--grid", type=options.Number(1, most=500, whole=True), default=16, metavar="NUMBER", show_default=True,
              help="Squares of the grid along the longer side.")
@click.option("--contours", is_flag=True, help="Draw each mesh's own triangular coordinates (contours and rings) "
              "instead of a grid.")
@click.option("--image", default="", metavar="FILE", help="Image over the source, drawn and warped below.")
@click.option("--close-up", default="", metavar="X,Y,R", help="Add close-ups: the center and half the side of a square "
              "in the target.")
@click.option("--width", type=options.Number(50, most=5000), default=420.0, metavar="NUMBER", show_default=True,
              help="Width of a panel in pixels.")
@options.quiet
def command(inputs, output, force, output_format, settings, all_systems, grid, contours, image, close_up, width):
    """Draw a grid, or the contours, on the source and mapped onto the target. The meshes are in a plane."""
    close_up = read_close_up(close_up)
    target = Output(output, output_format, force, plots.FORMATS, "a figure")
    raster = None
    if image:
        with Input(image) as file:
            raster = images.read(file)
        inputs.grids = lambda marks: (raster.grid, None if marks.crs else options.scan_grids(inputs)[1] or raster.grid)
    both = report.require_map(options.read_pair(inputs), settings.mask_invalid)
    if image:
        if both.landmarks:
            raster.grid = raster.grid.hanging()
        size = (raster.grid.width, raster.grid.height)
        pair.fit_to_pictures(both, [size, size])
        images.require_overlap(raster.grid, image, both.source, both.name_of(0))
    both.require_flat()
    settings = replace(settings, linear_where_discordant=settings.linear_where_discordant or all_systems)
    systems = ["linear", "contour", "smooth"] if all_systems else [settings.system or "smooth"]
    points = [meshes.points_of(mesh)[:, :2] for mesh in both.meshes]
    bounds = [plots.bounds_of(p) for p in points]
    lines = grid_lines(plots.bounds_of(points[0], 0.0), grid)
    maps = [PointMap(replace(both, shift=None), replace(settings, system=name)) for name in systems]
    mapped = [m.map_points(lines.reshape(-1, 2))[0].reshape(lines.shape) for m in maps]
    # Lines of the source end at the boundary of the domain.
    shown = numpy.where(numpy.isnan(mapped[0]), numpy.nan, lines)
    panels = [("Source", 0, systems[-1], shown)]
    panels += [(name.capitalize(), 1, name, drawn) for name, drawn in zip(systems, mapped)]
    if close_up:
        back = PointMap(replace(both, shift=None), replace(settings, system=systems[0]), inverse=True)
        centers = [back.map_points(numpy.array([close_up[:2]]))[0][0], close_up[:2]]
    gap, title = 6, 30
    height = width * min(max(max((b[3] - b[2]) / (b[1] - b[0]) for b in bounds), 0.2), 3.0)
    below = (width + gap) if close_up else 0
    figure = plots.new_figure(len(panels) * (width + gap) + gap, title + height + gap + below)
    dark = False
    if raster:
        pixels = raster.window((0, raster.grid.width), (0, raster.grid.height))
        dark = pixels[:, :, : max(1, raster.bands - raster.has_alpha)].mean() < 0.5 * images.brightest(pixels.dtype)
    line_color, mesh_color = ("#ffd91a", "#1a339980") if dark else ("#bf1a26", "#334d7373")
    for k, (name, side, system, drawn) in enumerate(panels):
        rows = [(gap + below, height, bounds[side], 1.0)]
        if close_up:
            (x, y), r = centers[side], close_up[2]
            rows.append((gap, width, (x - r, x + r, y - r, y + r), 2.0))
        picture = None
        if raster:
            picture = _picture(raster, both, replace(settings, system=system), side)
        for row, (bottom, tall, limits, thick) in enumerate(rows):
            axes = plots.add_panel(figure, (gap + k * (width + gap), bottom, width, tall), "" if row else name, limits)
            if picture is not None:
                axes.imshow(picture[0], extent=picture[1], interpolation="nearest", aspect="equal", zorder=0,
                            cmap="gray", vmin=0, vmax=images.brightest(picture[0].dtype))
                axes.set(xlim=limits[:2], ylim=limits[2:])
            polygons = plots.polygons_of(both.meshes[side], points[side])
            plots.draw_edges(axes, polygons, mesh_color, 0.7 * thick)
            if contours:
                for line in coordinate_lines(both.meshes[side], settings, system):
                    axes.plot(*line.T, color=line_color, linewidth=0.6 * thick)
            else:
                for line in drawn:
                    axes.plot(*line.T, color=line_color, linewidth=0.8 * thick)
    plots.save(figure, target)


def _picture(raster, both, settings, side):
    """The image, or the warped one with three pixels for one, so that close-ups show lines, and its extent."""
    grid = raster.grid
    if side == 0:
        pixels = raster.window((0, grid.width), (0, grid.height))
    else:
        if both.landmarks and both.landmarks.crs:
            grid = images.Warp(both, settings).fit_grid(raster, (grid.width, grid.height))
        fine = replace(grid, width=3 * grid.width - 2, height=3 * grid.height - 2, dx=grid.dx / 3, dy=grid.dy / 3)
        pixels, mask = images.Warp(both, settings).warp(raster, fine, "")
        pixels, grid = images.finish(pixels, mask, raster.has_alpha, None), fine
        if pixels.shape[2] == 2:
            pixels = numpy.dstack((pixels[:, :, [0, 0, 0]], pixels[:, :, 1]))
    x0, x1, y0, y1 = grid.bounds
    extent = (x0 - grid.dx / 2, x1 + grid.dx / 2, y0 - grid.dy / 2, y1 + grid.dy / 2)
    return (pixels[:, :, 0] if pixels.shape[2] < 3 else pixels), extent
