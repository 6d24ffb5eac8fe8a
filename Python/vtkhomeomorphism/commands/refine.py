# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm refine"""

import os
from dataclasses import replace

import click
from vtkmodules.util.numpy_support import vtk_to_numpy

from .. import meshes, options, pair, report, tinshift
from ..files import Failure, Output, inform
from ..mapping import add_array, run
from ..vtkFiltersHomeomorphism import vtkRefinedTriangulationPair
from .convert import crs_options, describe

PROJ_LIMIT = 10 * 1024 * 1024
"""The largest file that PROJ reads, in bytes."""


@click.command("refine")
@options.output("The refined pair: .json (PROJ triangulation file), .vtp, .vtk, or - for standard output.", "json")
@click.option("-t", "--max-error", type=options.POSITIVE, required=True, metavar="DISTANCE",
              help="Greatest distance of the refined pair's piecewise linear map from the map, in units of the target.")
@click.option("--max-triangles", type=click.IntRange(1), default=2000000, metavar="NUMBER", show_default=True,
              help="Greatest number of triangles.")
@options.map_settings("smooth")
@crs_options
@options.pair_files("SOURCE [TARGET]")
@options.quiet
def command(inputs, output, force, output_format, max_error, max_triangles, settings, output_array, input_crs,
            output_crs):
    """Refine a pair until its piecewise linear map is close to the map.

    PROJ can then use the refined pair instead of the map. The pair must be planar. Heights of a triangulation file
    remain the same functions of the point."""
    target = Output(output, output_format, force, pair.FORMATS, "a pair")
    both = report.require_map(options.read_pair(inputs), settings.mask_invalid)
    both.require_flat()
    if both.shift and not both.shift.horizontal:
        raise Failure(f"{both.name} shifts heights only, which are piecewise linear already: there is nothing to refine.")
    settings = replace(settings, system=settings.system or "smooth")
    heights = both.shift.heights if both.shift else {}
    for name, values in heights.items():
        add_array(both.source, name, values)
    refining = vtkRefinedTriangulationPair()
    settings.apply(refining)
    refining.SetSourceData(both.source)
    refining.SetTargetData(both.target)
    refining.SetMaximumError(max_error)
    refining.SetMaximumNumberOfTriangles(max_triangles)
    try:
        run(refining, both.name)
    except Failure:
        if refining.GetResult() != refining.TOO_MANY_TRIANGLES:
            raise
        raise Failure(f"{both.name}: an error of {max_error:g} takes more than {max_triangles} triangles (--max-triangles); "
                      f"with as many the largest error is still {refining.GetLargestError():.3g}: allow a larger "
                      "--max-error.") from None
    system = settings.system.capitalize()
    finer = replace(both, meshes=[refining.GetOutput(0), refining.GetOutput(1)], shift=None)
    inform(f"{both.source.GetNumberOfPolys()} triangles became {finer.source.GetNumberOfPolys()}; farthest from {system}: "
           f"{refining.GetLargestError():.4g}, at {refining.GetNumberOfSamples()} points.")
    # Mark the file as different from the published one.
    published = finer.metadata.get("description")
    finer.metadata["description"] = (f"{published}. " if isinstance(published, str) else "") + (
        f"Refined by dhm: its piecewise linear map is within {max_error:g} of the {system} map of the original triangulation")
    describe(finer.metadata, input_crs, output_crs)
    if both.shift:
        heights = {name: vtk_to_numpy(finer.source.GetPointData().GetArray(name)) for name in heights}
        points = [meshes.points_of(mesh)[:, :2] for mesh in finer.meshes]
        finer.shift = tinshift.Shift(*points, meshes.triangles_of(finer.source), heights)
    with target as place:
        pair.write(finer, place, output_array)
        if target.format == "json" and os.path.getsize(place.path) > PROJ_LIMIT:
            inform(f"PROJ reads no triangulation files of more than 10 MiB, as {place.name} is: allow a larger --max-error.")
