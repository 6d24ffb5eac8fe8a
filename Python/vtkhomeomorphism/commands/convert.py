# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm convert"""

import contextlib

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
@options.pair_files("SOURCE [TARGET]")
@options.output("The pair: .json (PROJ's triangulation file), .vtp or .vtk with the target's positions as a point "
                "array; with --target-output the source alone: .vtp .vtk .obj .off .ply.", "json")
@click.option("--target-output", default="", metavar="FILE", help="Write the target to a separate file.")
@crs_options
@click.option("--mask-invalid", is_flag=True, help="Drop invalid triangles from a triangulation file.")
@options.quiet
def command(inputs, output, force, output_format, target_output, output_array, input_crs, output_crs, mask_invalid):
    """Write a pair in another format."""
    if target_output == output:
        raise Failure(f"Source and target cannot both be written to {output} (--target-output).", USAGE)
    formats = meshes.WRITE if target_output else pair.FORMATS
    hint = "" if target_output else " (with --target-output also .obj, .off and .ply)"
    first = Output(output, output_format, force, formats, "a pair" + hint)
    second = target_output and Output(target_output, output_format, force, meshes.WRITE, "a mesh")
    both = options.read_pair(inputs)
    describe(both.metadata, input_crs, output_crs)
    if first.format == "json" and not target_output:
        # PROJ does not check this.
        both = report.require_map(both, mask_invalid)
    with contextlib.ExitStack() as stack:
        path = stack.enter_context(first)
        if second:
            other = stack.enter_context(second)
            meshes.write(both.source, path)
            meshes.write(both.target, other)
        else:
            pair.write(both, path, output_array)
