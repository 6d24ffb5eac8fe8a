# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm convert"""

import click

from .. import meshes, options, pair, report
from ..files import USAGE, Failure, Output


def crs_options(command):
    """Names of coordinate reference systems in triangulation files, and of the array in others."""
    return options.add(
        click.option("--output-array", default="Target", metavar="NAME", show_default=True,
                     help="Name of the point array with the target's positions."),
        click.option("--input-crs", metavar="CRS", help="Name of the source's coordinate reference system (.json)."),
        click.option("--output-crs", metavar="CRS", help="Name of the target's coordinate reference system (.json)."),
    )(command)


def describe(metadata, input_crs, output_crs):
    metadata.update({k: v for k, v in (("input_crs", input_crs), ("output_crs", output_crs)) if v})


@click.command("convert")
@options.output("The pair: .json (PROJ triangulation file), .vtp or .vtk with the target's positions as a point "
                "array; with --target-output, the source only: .vtp .vtk .obj .off .ply.", "json")
@click.option("--target-output", default="", metavar="FILE", help="Write the target to a separate file.")
@crs_options
@options.mask_option
@options.pair_files("SOURCE [TARGET]")
@options.quiet
def command(inputs, output, force, output_format, target_output, output_array, input_crs, output_crs, mask_invalid):
    """Write a pair in another format."""
    if target_output == output:
        raise Failure(f"Source and target cannot both be written to {output} (--target-output).", USAGE)
    both = options.read_pair(inputs)
    describe(both.metadata, input_crs, output_crs)
    if target_output:
        outputs = [Output(name, output_format, force, meshes.WRITE, "a mesh") for name in (output, target_output)]
        with outputs[0] as first, outputs[1] as second:
            meshes.write(both.source, first)
            meshes.write(both.target, second)
        return
    what = "a pair (with --target-output also .obj, .off and .ply)"
    with Output(output, output_format, force, pair.FORMATS, what) as place:
        # PROJ does not check triangulation files.
        pair.write(report.require_map(both, mask_invalid) if place.format == "json" else both, place, output_array)
