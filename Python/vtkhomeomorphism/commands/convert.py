# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm convert"""

import click

from .. import meshes, options, pair, report
from ..files import USAGE, Failure, Output

crs_options = options.add(
    click.option("--output-array", default="Target", metavar="NAME", show_default=True,
                 help="Name of the point array with the target's positions."),
    click.option("--input-crs", metavar="CRS", help="Name of the source's coordinate reference system (.json)."),
    click.option("--output-crs", metavar="CRS", help="Name of the target's coordinate reference system (.json)."),
    options.replacing(lambda source, target: {name: crs for name, crs in (("input_crs", source), ("output_crs", target))
                                              if crs}, ("input_crs", "output_crs"), "systems"),
)
"""Names of coordinate reference systems in triangulation files (`systems`), and of the array in others."""


@click.command("convert")
@options.output("The pair: .json (PROJ triangulation file), .vtp or .vtk with the target's positions as a point "
                "array; with --target-output, the source only: .vtp .vtk .obj .off .ply.", "json",
                ("json",) + meshes.WRITE, "a pair")
@click.option("--target-output", default="", metavar="FILE", help="Write the target to a separate file.")
@crs_options
@options.mask_option
@options.pair_files("SOURCE [TARGET]")
@options.quiet
def command(inputs, output, target_output, output_array, systems, mask_invalid):
    """Write a pair in another format."""
    if target_output == output.name:
        raise Failure(f"Source and target cannot both be written to {output.name} (--target-output).", USAGE)
    if (output.format in meshes.FLAT_WRITE) > bool(target_output) or target_output and output.format == "json":
        raise Failure(f"Cannot write {'the source' if target_output else 'both meshes'} to {output.name}: one file of both is "
                      "a .json, .vtp or .vtk, two files (--target-output) are .vtp, .vtk, .obj, .off or .ply.", USAGE)
    both = options.read_pair(inputs)
    both.metadata.update(systems)
    if target_output:
        with output, Output(target_output, output.format, output.force, meshes.WRITE, "a mesh") as second:
            meshes.write(both.source, output)
            meshes.write(both.target, second)
        return
    with output:
        # PROJ does not check triangulation files.
        pair.write(report.require_map(both, mask_invalid) if output.format == "json" else both, output, output_array)
