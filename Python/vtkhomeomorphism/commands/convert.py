# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm convert"""

import click

from .. import meshes, options, pair, report
from ..files import USAGE, Failure, Output, dotted


@click.command("convert")
@options.output("The pair: .json (PROJ triangulation file), .vtp or .vtk with the target's positions as the "
                "point array Target; with --target-output, the source only: .vtp .vtk .obj .off .ply.", "json",
                ("json",) + meshes.WRITE, "a pair")
@click.option("--target-output", default="", metavar="FILE", help="Write the target to a separate file.")
@options.mask_option
@options.pair_files("SOURCE [TARGET]")
def command(inputs, output, target_output, mask_invalid):
    """Write a pair in another format."""
    if target_output == output.name:
        raise Failure(f"Source and target cannot both be written to {output.name} (--target-output).", USAGE)
    if (output.format in meshes.FLAT_WRITE) > bool(target_output) or target_output and output.format == "json":
        raise Failure(f"Cannot write {'the source' if target_output else 'both meshes'} to {output.name}: one file of "
                      f"both is {dotted(pair.FORMATS)}, two (--target-output) are {dotted(meshes.WRITE)}.", USAGE)
    both = options.read_pair(inputs)
    if target_output:
        second = Output(target_output, output.format, output.force, meshes.WRITE, "a mesh")
        with output.writing(), second.writing():
            meshes.write(both.source, output)
            meshes.write(both.target, second)
        return
    with output.writing():
        # PROJ does not check triangulation files.
        pair.write(report.require_map(both, mask_invalid) if output.format == "json" else both, output)
