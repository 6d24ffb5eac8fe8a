# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm morph"""

import re
from dataclasses import replace

import click
import numpy

from .. import images, meshes, options, pair, vtkfiles
from ..files import PICTURES, REFUSED, TABLES, USAGE, Failure, Input, Output, count, format_of, inform, progress
from ..mapping import PointMap, run
from ..vtkFiltersHomeomorphism import vtkInBetweenTriangulation
from .warp import background_option

PATHS = {"straight": vtkInBetweenTriangulation.STRAIGHT, "rotating": vtkInBetweenTriangulation.ROTATING,
         "best": vtkInBetweenTriangulation.FEWEST_FOLDS}


def frame_names(pattern, number):
    """File names, with %d or %03d replaced by the number of the frame."""
    places = re.findall(r"%0?[1-9]?d", pattern)
    if len(places) != 1:
        raise Failure(f"The output's name must have one place for the frame's number, such as frame-%03d.png: {pattern}.",
                      USAGE)
    before, after = pattern.split(places[0])
    return [before + places[0] % k + after for k in range(number)]


class InBetween:
    """The intermediate meshes. Raises Failure if a triangle is folded in one of the frames."""

    def __init__(self, both, settings, path, times):
        self.name = both.name
        self.filter = vtkInBetweenTriangulation()
        self.filter.SetSourceData(both.source)
        self.filter.SetTargetData(both.target)
        self.filter.SetMaskInvalidTriangles(settings.mask_invalid)
        self.filter.SetPath(PATHS[path])
        folded = [k for k, t in enumerate(times) if self.at(t) is not None and self.filter.GetNumberOfFoldedTriangles()]
        found = self.filter
        if found.GetMirrored():
            raise Failure(f"{both.name}: the target is a mirror image of the source: all triangles fold on the way.")
        number = found.GetNumberOfFoldingTriangles()
        if not number:
            return
        where = (f"{both.name}: {count(number, 'triangle folds', 'triangles fold')} on the way (cell "
                 f"{found.GetFirstFoldingTriangle()} first, from {found.GetFirstFoldTime():.4g} on; the last until "
                 f"{found.GetLastFoldTime():.4g})")
        if folded:
            raise Failure(f"{where}, and frame {folded[0]} (at {times[folded[0]]:.4g}) has folded triangles. Put a mesh "
                          "in between and morph in two steps.", REFUSED)
        inform(where + ", but in none of the frames.")

    def at(self, time):
        self.filter.SetTime(time)
        result = run(self.filter, self.name)
        # The next output of the filter must be a separate object.
        copy = result.NewInstance()
        copy.ShallowCopy(result)
        copy.GetCellData().RemoveArray("Folded")
        return copy


def blend(first, second, t):
    if first.dtype != second.dtype or first.shape != second.shape:
        raise Failure(f"The two images are not of the same kind: {first.shape[2]} bands of {first.dtype}, and "
                      f"{second.shape[2]} of {second.dtype}.")
    mixed = (1 - t) * first.astype(float) + t * second.astype(float)
    return (numpy.rint(mixed) if first.dtype.kind in "iu" else mixed).astype(first.dtype)


@click.command("morph")
@options.pair_files("SOURCE [TARGET]")
@click.option("-o", "--output", required=True, metavar="FILES", help="Name of the frames, with %d or %03d for the "
              "number: frame-%03d.png.")
@click.option("-f", "--force", is_flag=True, help="Replace files that exist.")
@click.option("--source-image", default="", metavar="FILE", help="Image over the source.")
@click.option("--target-image", default="", metavar="FILE", help="Image over the target; with both, one fades into the "
              "other.")
@click.option("--data", default="", metavar="FILE", help="Data over the source, instead of images (default: the source "
              "mesh).")
@click.option("-n", "--frames", type=options.Number(2, most=100000, whole=True), default=11, metavar="NUMBER",
              show_default=True, help="Number of frames, the first and the last included.")
@click.option("--path", type=click.Choice(list(PATHS)), default="best", show_default=True,
              help="Paths of points: straight, rotating with the mesh as a whole, or the path with fewer folds.")
@click.option("--size", default="", metavar="WIDTHxHEIGHT", help="Size of the frames (default: the source image's).")
@background_option
@options.map_settings("smooth")
@options.quiet
def command(inputs, output, force, source_image, target_image, data, frames, path, size, background, settings):
    """Make intermediate frames of images or data between the source and the target.

    If a triangle would be folded in a frame, nothing is written (status 1)."""
    names = (source_image, target_image)
    with_images = any(names)
    if with_images and data:
        raise Failure("Morph either images or data (--data), not both.", USAGE)
    format = format_of(output)
    if not with_images and format in PICTURES:
        raise Failure(f"Meshes and data are not images (.{format}): give --source-image or --target-image, or write .vtp.",
                      USAGE)
    if format_of(data) in TABLES:
        raise Failure(f"{data} is a table, which has to become a .vtp first: dhm coordinates SOURCE {data} -o points.vtp.",
                      USAGE)
    known = images.WRITE if with_images else vtkfiles.FORMATS[:-1] + meshes.FLAT_WRITE
    what = "an image" if with_images else "data"
    outputs = [Output(name, "", force, known, what) for name in frame_names(output, frames)]
    color = images.read_background(background, format) if with_images else None
    size = images.read_size(size)
    rasters = [None, None]
    for side, name in enumerate(names):
        if name:
            with Input(name) as file:
                rasters[side] = images.read(file)
    first = rasters[0] or rasters[1]
    if first:
        inputs.grids = lambda marks: [(raster or first).grid for raster in rasters]
    both = options.read_pair(inputs)
    if with_images:
        for raster in rasters if both.landmarks else ():
            if raster:
                raster.grid = raster.grid.hanging()
        grid = images.Grid(*size) if size else first.grid
        grid = grid.hanging() if both.landmarks else grid
        grids = [(raster or first).grid if raster else grid for raster in rasters]
        pair.fit_to_pictures(both, [(g.width, g.height) for g in grids])
        for side, raster in enumerate(rasters):
            if raster:
                images.require_overlap(raster.grid, names[side], both.meshes[side], both.name_of(side))
    elif data:
        with Input(data) as file:
            things = vtkfiles.read(file) if file.format in vtkfiles.FORMATS else meshes.read(file)
    else:
        things = both.source
    times = [k / (frames - 1) for k in range(frames)]
    between = InBetween(both, settings, path, times)
    for t, frame in progress(list(zip(times, outputs)), "Morphing"):
        mesh = between.at(t)
        if not with_images:
            result = PointMap(replace(both, meshes=[both.source, mesh], shift=None), settings).map_data(things)
            with frame as place:
                meshes.write(result, place)
            continue
        warped, mask, has_alpha = None, True, False
        for side, raster in enumerate(rasters):
            if raster:
                moving = replace(both, meshes=[both.meshes[side], mesh], shift=None)
                pixels, inside = images.Warp(moving, settings).warp(raster, grid, "")
                warped = pixels if warped is None else blend(warped, pixels, t)
                mask, has_alpha = mask & inside, raster.has_alpha
        with frame as place:
            images.write(images.finish(warped, mask, has_alpha, color), place, grid)
