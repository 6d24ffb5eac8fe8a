# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm refine"""

import os
from dataclasses import replace

import click

from .. import options, pair, report, tinshift
from ..arrays import add_array, arrays_of, points_of, triangles_of
from ..files import Failure, inform
from ..mapping import run, set_up
from ..vtkFiltersHomeomorphism import vtkRefinedTriangulationPair

PROJ_LIMIT = 10 * 1024 * 1024  # the largest file that PROJ reads, in bytes


@click.command("refine")
@options.output("The refined pair: .json (PROJ triangulation file), .vtp, .vtk, or - for standard output.", "json",
                pair.FORMATS, "a pair")
@click.option("-t", "--max-error", type=options.POSITIVE, required=True, metavar="DISTANCE",
              help="Largest distance of the refined pair's piecewise linear map from the map, in units of the target.")
@click.option("--max-triangles", type=click.IntRange(1), default=2000000, metavar="NUMBER",
              help="Largest number of triangles.")
@options.map_settings("smooth")
@options.pair_files("SOURCE [TARGET]")
def command(inputs, output, max_error, max_triangles, **settings):
    """Refine a pair until its piecewise linear map is close to the map.

    PROJ can then use the refined pair instead of the map. The pair must be planar. Refinement does not change the
    heights of a triangulation file."""
    both = report.require_map(options.read_pair(inputs), settings["mask_invalid"])
    both.require_flat()
    if both.shift and not both.shift.horizontal:
        raise Failure(f"{both.name} shifts only heights, which are piecewise linear: there is nothing to refine.")
    heights = both.shift.heights if both.shift else {}
    for name, values in heights.items():
        add_array(both.source, name, values)
    refining = set_up(vtkRefinedTriangulationPair(), settings, both)
    refining.SetMaximumError(max_error)
    refining.SetMaximumNumberOfTriangles(max_triangles)
    try:
        run(refining, both.name)
    except Failure:
        if refining.GetResult() != refining.TOO_MANY_TRIANGLES:
            raise
        if both.source.GetNumberOfPolys() > max_triangles:
            raise Failure(f"{both.name} has {both.source.GetNumberOfPolys()} triangles, more than {max_triangles} "
                          "(--max-triangles).") from None
        raise Failure(f"{both.name}: an error of {max_error:g} requires more than {max_triangles} triangles "
                      f"(--max-triangles); with that number, the error is {refining.GetLargestError():.3g}: allow a "
                      "larger --max-error.") from None
    system = (settings["system"] or "smooth").capitalize()
    finer = replace(both, meshes=[refining.GetOutput(0), refining.GetOutput(1)], shift=None)
    inform(f"{both.source.GetNumberOfPolys()} triangles became {finer.source.GetNumberOfPolys()}; largest distance "
           f"from {system}: {refining.GetLargestError():.4g}, at {refining.GetNumberOfSamples()} points.")
    # Mark the file as different from the published one.
    published = f"{finer.metadata['description']}. " if "description" in finer.metadata else ""
    finer.metadata["description"] = f"{published}Refined by dhm: within {max_error:g} of the original's {system} map"
    if both.shift:
        arrays = arrays_of(finer.source.GetPointData())
        points = [points_of(mesh)[:, :2] for mesh in finer.meshes]
        heights = {name: arrays[name] for name in heights}
        finer.shift = tinshift.Shift(*points, triangles_of(finer.source), heights)
    with output.writing():
        pair.write(finer, output)
        if output.format == "json" and os.path.getsize(output.path) > PROJ_LIMIT:
            inform(f"PROJ does not read files of more than 10 MiB such as {output.name}: allow a larger --max-error.")
