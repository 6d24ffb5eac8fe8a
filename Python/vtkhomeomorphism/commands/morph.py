# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm morph"""

from dataclasses import replace

import click
import numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .. import images, meshes, options, vtkfiles
from ..files import PICTURES, USAGE, Failure, Output, format_of, inform, progress
from ..mapping import choose_system, run
from ..vtkFiltersHomeomorphism import vtkInBetweenTriangulation

PATHS = {"straight": vtkInBetweenTriangulation.STRAIGHT, "rotating": vtkInBetweenTriangulation.ROTATING,
         "best": vtkInBetweenTriangulation.FEWEST_FOLDS}


def make_meshes(both, mask_invalid, path, times):
    """The intermediate meshes. Raises Failure if a triangle is folded in one of them."""
    filter = vtkInBetweenTriangulation()
    filter.SetSourceData(both.source)
    filter.SetTargetData(both.target)
    filter.SetMaskInvalidTriangles(mask_invalid)
    filter.SetPath(PATHS[path])
    result, folded = [], []
    for frame, time in enumerate(times):
        filter.SetTime(time)
        # The next output of the filter must be a separate object.
        mesh = vtkPolyData()
        mesh.ShallowCopy(run(filter, both.name))
        mesh.GetCellData().RemoveArray("Folded")
        result.append(mesh)
        folded += [f"frame {frame} (at {time:.4g})"] * (filter.GetNumberOfFoldedTriangles() > 0)
    if filter.GetMirrored():
        raise Failure(f"{both.name}: the target is a mirror image of the source, so all triangles fold.")
    if filter.GetNumberOfFoldingTriangles():
        where = (f"{both.name}: triangle {filter.GetFirstFoldingTriangle()} folds first, at "
                 f"{filter.GetFirstFoldTime():.4g} of the way; {filter.GetNumberOfFoldingTriangles()} fold before "
                 f"{filter.GetLastFoldTime():.4g}")
        if folded:
            raise Failure(f"{where}: {folded[0]} has folded triangles. Morph in two steps, with a mesh in between.")
        inform(where + ", but in none of the frames.")
    return result


def grid_between(grids, size, t):
    """The pixels of a frame, over the rectangle between those of two images, whose borders are mapped to its border."""
    steps = [grid.steps * numpy.maximum(numpy.subtract(grid.size, 1), 1) / numpy.maximum(numpy.subtract(size, 1), 1)
             for grid in grids]
    first = grids[0].first + t * (grids[1].first - grids[0].first)
    return replace(grids[0], width=size[0], height=size[1], first=first, steps=steps[0] + t * (steps[1] - steps[0]))


def blend(first, second, masks, t, has_alpha):
    """Pixels and mask. Where only one image has pixels, it is shown alone, except in the first and the last frame."""
    if first.dtype != second.dtype or first.shape != second.shape:
        raise Failure(f"The two images are not of the same kind: {first.shape[2]} bands of {first.dtype}, and "
                      f"{second.shape[2]} of {second.dtype}.")
    total = (1 - t) * masks[0] + t * masks[1]
    weight = (t * masks[1] / numpy.where(total > 0, total, 1))[:, :, None]
    mixed = images.round_to(first.dtype, (1 - weight) * first.astype(float) + weight * second.astype(float))
    if has_alpha:
        images.put_colors(mixed, (1 - weight) * images.weigh(first) + weight * images.weigh(second))
    return mixed, total > 0


@click.command("morph")
@click.option("-o", "--output", required=True, metavar="FILES", help="Names of the frames, with %d or %03d for the "
              "number, such as frame-%03d.png.")
@options.force
@click.option("--source-image", default="", metavar="FILE", help="Image over the source.")
@click.option("--target-image", default="", metavar="FILE",
              help="Image over the target, into which the source image fades.")
@click.option("-n", "--frames", type=click.IntRange(2), default=11, metavar="NUMBER", help="Number of frames.")
@click.option("--path", type=click.Choice(list(PATHS)), default="best",
              help="Paths of the points: straight, rotating with the mesh as a whole, or the better of the two, "
              "with fewer folds.")
@click.option("--size", type=options.Size(), metavar="WIDTHxHEIGHT",
              help="Size of the frames (default: that of the source image).")
@options.background
@options.map_settings("cubic; for a PROJ triangulation file linear")
@options.pair_files("SOURCE [TARGET]")
def command(inputs, output, force, source_image, target_image, frames, path, size, background, **settings):
    """Morph images, or the mesh, from the source to the target, in frames.

    If a triangle is folded in a frame, nothing is written, and the exit status is 1."""
    names, format = (source_image, target_image), format_of(output)
    if not any(names) and format in PICTURES:
        raise Failure(f"Meshes are not images (.{format}): write .vtp, or give --source-image.", USAGE)
    known = PICTURES if any(names) else vtkfiles.FORMATS[:-1] + meshes.FLAT_WRITE
    try:
        outputs = [Output(output % k, "", force, known, "frames") for k in range(frames)]
    except (TypeError, ValueError):
        raise Failure(f"{output} must have one placeholder for the frame's number, such as frame-%03d.png.",
                      USAGE) from None
    color = images.read_background(background, format) if any(names) else None
    rasters = {side: images.read(name) for side, name in enumerate(names) if name}
    if rasters:
        first = rasters.get(0, rasters.get(1))
        inputs.grids = [rasters.get(side, first).grid for side in (0, 1)]
    both = options.read_pair(inputs)
    if rasters:
        settings = choose_system(settings, both, "cubic")
        both.fit(inputs.grids, rasters)
        ends = [images.Grid(*size) if size and not both.extents else grid for grid in inputs.grids]
        ends = [grid.hanging() if both.landmarks else grid for grid in ends]
    times = [k / (frames - 1) for k in range(frames)]
    has_alpha = any(raster.has_alpha for raster in rasters.values())
    steps = zip(times, outputs, make_meshes(both, settings["mask_invalid"], path, times))
    for t, frame, mesh in progress(list(steps), "Morphing"):
        with frame.writing():
            if not rasters:
                meshes.write(mesh, frame)
                continue
            grid = grid_between(ends, size or ends[0].size, t)
            warped = [images.Warp(replace(both, meshes=[both.meshes[side], mesh]), settings).warp(raster, grid, "")
                      for side, raster in rasters.items()]
            warped = [(pixels if raster.has_alpha or not has_alpha else images.add_alpha(pixels), mask)
                      for (pixels, mask), raster in zip(warped, rasters.values())]
            pixels, mask = warped[0]
            if len(warped) == 2:
                pixels, mask = blend(pixels, warped[1][0], (mask, warped[1][1]), t, has_alpha)
            images.write(images.finish(pixels, mask, has_alpha, color), frame, grid, first.profile)
