# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm morph"""

import re
from dataclasses import replace

import click
import numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .. import images, meshes, options, pair, vtkfiles
from ..files import PICTURES, TABLES, USAGE, Failure, Input, Output, count, format_of, inform, progress
from ..mapping import PointMap, run
from ..vtkFiltersHomeomorphism import vtkInBetweenTriangulation
from .warp import background_option

PATHS = {"straight": vtkInBetweenTriangulation.STRAIGHT, "rotating": vtkInBetweenTriangulation.ROTATING,
         "best": vtkInBetweenTriangulation.FEWEST_FOLDS}


def frame_names(pattern, number):
    """File names, with %d or %03d replaced by the number of the frame."""
    parts = re.split(r"(%0?[1-9]?d)", pattern)
    if len(parts) != 3:
        raise Failure(f"The output's name must have one place for the frame's number, such as frame-%03d.png: {pattern}.",
                      USAGE)
    return [parts[0] + parts[1] % k + parts[2] for k in range(number)]


def make_meshes(both, mask_invalid, path, times):
    """The intermediate meshes. Raises Failure if a triangle is folded in one of them."""
    filter = vtkInBetweenTriangulation()
    filter.SetSourceData(both.source)
    filter.SetTargetData(both.target)
    filter.SetMaskInvalidTriangles(mask_invalid)
    filter.SetPath(PATHS[path])
    result, folded = [], []
    for time in times:
        filter.SetTime(time)
        # The next output of the filter must be a separate object.
        mesh = vtkPolyData()
        mesh.ShallowCopy(run(filter, both.name))
        mesh.GetCellData().RemoveArray("Folded")
        result.append(mesh)
        folded += [time] * (filter.GetNumberOfFoldedTriangles() > 0)
    if filter.GetMirrored():
        raise Failure(f"{both.name}: the target is a mirror image of the source: all triangles fold on the way.")
    number = filter.GetNumberOfFoldingTriangles()
    if number:
        where = (f"{both.name}: {count(number, 'triangle folds', 'triangles fold')} on the way (cell "
                 f"{filter.GetFirstFoldingTriangle()} first, from {filter.GetFirstFoldTime():.4g} on; the last until "
                 f"{filter.GetLastFoldTime():.4g})")
        if folded:
            raise Failure(f"{where}, and frame {times.index(folded[0])} (at {folded[0]:.4g}) has folded triangles. Put a "
                          "mesh in between and morph in two steps.")
        inform(where + ", but in none of the frames.")
    return result


def blend(first, second, t):
    if first.dtype != second.dtype or first.shape != second.shape:
        raise Failure(f"The two images are not of the same kind: {first.shape[2]} bands of {first.dtype}, and "
                      f"{second.shape[2]} of {second.dtype}.")
    mixed = (1 - t) * first.astype(float) + t * second.astype(float)
    return (numpy.rint(mixed) if first.dtype.kind in "iu" else mixed).astype(first.dtype)


@click.command("morph")
@click.option("-o", "--output", required=True, metavar="FILES", help="Names of the frames, with %d or %03d for the "
              "number, such as frame-%03d.png.")
@options.force
@click.option("--source-image", default="", metavar="FILE", help="Image over the source.")
@click.option("--target-image", default="", metavar="FILE", help="Image over the target. With both images, the first fades "
              "into the second.")
@click.option("--data", default="", metavar="FILE", help="Data over the source, instead of images (default: the source "
              "mesh).")
@click.option("-n", "--frames", type=click.IntRange(2), default=11, metavar="NUMBER", show_default=True,
              help="Number of frames, including the first and the last.")
@click.option("--path", type=click.Choice(list(PATHS)), default="best", show_default=True,
              help="Paths of the points: straight, rotating with the mesh as a whole, or the one with fewer folds.")
@click.option("--size", type=options.Size(), metavar="WIDTHxHEIGHT",
              help="Size of the frames (default: the source image's).")
@background_option
@options.map_settings("cubic; on surfaces smooth; for a PROJ triangulation file linear")
@options.pair_files("SOURCE [TARGET]")
@options.quiet
def command(inputs, output, force, source_image, target_image, data, frames, path, size, background, settings):
    """Morph images or data from the source to the target, in frames.

    If a triangle is folded in a frame, nothing is written (status 1)."""
    names, format = (source_image, target_image), format_of(output)
    for wrong, message in (
            (any(names) and data, "Morph either images or data (--data), not both."),
            (not any(names) and format in PICTURES, f"Meshes and data are not images (.{format}): give --source-image or "
             "--target-image, or write .vtp."),
            (format_of(data) in TABLES, f"{data} is a table, which has to become a .vtp first: dhm coordinates SOURCE {data} "
             "-o points.vtp.")):
        if wrong:
            raise Failure(message, USAGE)
    known = images.WRITE if any(names) else vtkfiles.FORMATS[:-1] + meshes.FLAT_WRITE
    outputs = [Output(name, "", force, known, "frames") for name in frame_names(output, frames)]
    color = images.read_background(background, format) if any(names) else None
    rasters = {}
    for side, name in enumerate(names):
        if name:
            with Input(name) as file:
                rasters[side] = images.read(file)
    if rasters:
        first = rasters.get(0, rasters.get(1))
        inputs.grids = lambda marks: [rasters.get(side, first).grid for side in (0, 1)]
    both = options.read_pair(inputs)
    settings = settings.choose(both, "cubic")
    things = both.source
    if data:
        with Input(data) as file:
            things = meshes.read_data(file)
    if rasters:
        grid = images.Grid(*size) if size else first.grid
        pair.fit_to_pictures(both, [rasters[side].grid if side in rasters else grid for side in (0, 1)])
        for side, raster in rasters.items():
            raster.grid = raster.grid.hanging() if both.landmarks else raster.grid
            images.require_overlap(raster.grid, names[side], both.meshes[side], both.name_of(side))
        grid = grid.hanging() if both.landmarks else grid
    times = [k / (frames - 1) for k in range(frames)]
    steps = zip(times, outputs, make_meshes(both, settings.mask_invalid, path, times))
    for t, frame, mesh in progress(list(steps), "Morphing"):
        moving = {side: replace(both, meshes=[both.meshes[side], mesh], shift=None) for side in (0, 1)}
        with frame:
            if not rasters:
                meshes.write(PointMap(moving[0], settings).map_data(things), frame)
                continue
            warped = [images.Warp(moving[side], settings).warp(raster, grid, "") for side, raster in rasters.items()]
            pixels, mask = warped[0]
            if len(warped) == 2:
                pixels, mask = blend(pixels, warped[1][0], t), mask & warped[1][1]
            has_alpha = all(raster.has_alpha for raster in rasters.values())
            images.write(images.finish(pixels, mask, has_alpha, color), frame, grid)
