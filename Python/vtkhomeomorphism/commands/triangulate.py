# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm triangulate"""

import click
import numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .. import landmarks, options, pair, vtkfiles
from ..files import FILE, USAGE, Failure, Input, inform
from ..isomorphic import DOMAINS, QUALITIES
from ..landmarks import LandmarkFileError, Landmarks, is_landmark_file, read_lines


def read_figure(name):
    with Input(name) as file:
        if file.format not in ("vtp", "vtk"):
            raise Failure(f"{name} is not a figure: give one file of landmarks, or two figures (.vtp or .vtk).", USAGE)
        data = vtkfiles.read(file)
        if isinstance(data, vtkPolyData):
            return data
        file.fail(f"it contains a {data.GetClassName()}, not points, lines and polygons.")


def print_report(made, marks):
    found, suspicious = made.report, set(made.suspicious().tolist())
    below = found["shares_of_angles_below_10_15_20"]
    for name, value in (
            ("landmarks", len(marks.names)), ("added points", made.added_points), ("triangles", len(made.triangles)),
            ("smallest angles, degrees", "{:.4g} (source), {:.4g} (target)".format(*found["smallest_angles"])),
            ("angles below 10, 15, 20 degrees", ", ".join(f"{100 * share:.1f} %" for share in below)),
            ("obtuse triangles", f"{100 * found['obtuse_share']:.1f} %"),
            ("discordant triangles", f"{100 * found['discordant_share']:.1f} %"),
            ("largest distortion", f"{found['largest_distortion']:.4g} (cell {found['largest_distortion_triangle']})"),
            ("median residual", f"{numpy.median(made.residuals):.4g}")):
        click.echo(f"{name:33}{value}")
    click.echo("largest residuals, target's units")
    for i in numpy.argsort(-made.residuals, kind="stable")[:10].tolist():
        click.echo(f"  {marks.names[i]:31}{made.residuals[i]:.4g}{'  suspicious' if i in suspicious else ''}")


@click.command("triangulate")
@options.output("The pair: .json (PROJ triangulation file), .vtp or .vtk (the target is the point array Target).",
                "json", pair.FORMATS, "a pair")
@click.option("--lines", default="", metavar="FILE", help="Constraint lines: ids of landmarks, one line per row.")
@click.option("--outlines", default="", metavar="FILE", help="Outlines and holes: ids of landmarks, one loop per row.")
@click.option("--domain", type=click.Choice(list(DOMAINS)), default="automatic",
              help="The interior of outlines, a frame, or the convex hulls; automatic: outline if there are outlines, "
              "otherwise frame.")
@click.option("--quality", type=click.Choice(list(QUALITIES)), default="minimum_angle",
              help="The quality measure that is optimized.")
@click.option("--target-angle", "target_minimum_angle", type=options.Number(0, 60), default=0.0, metavar="DEGREES",
              help="Add points until no angle is smaller than this (default: only necessary points).")
@click.option("--maximum-added-points", type=click.IntRange(0), metavar="NUMBER",
              help="Largest number of added points (default: the necessary ones, and up to 100 for --target-angle).")
@click.option("--maximum-size", "maximum_triangle_size", type=options.Number(0, 1), default=0.0, metavar="SHARE",
              help="Divide triangles with more than this fraction of the domain's area.")
@click.option("--leave-out-conflicts", "leave_out_conflicting_segments", is_flag=True,
              help="Leave out constraint lines that conflict with others, and list them.")
@click.option("--report", is_flag=True, help="Print angles, distortion and the landmarks with the largest residuals.")
@options.pair_files("LANDMARKS | SOURCE TARGET")
def command(inputs, output, lines, outlines, report, **settings):
    """Make a pair of meshes with the same triangles from landmarks.

    LANDMARKS is a .csv file (source_x, source_y, target_x, target_y, optionally id; or BigWarp's format), a QGIS
    .points file, or an IIIF georeference annotation (.json). SOURCE and TARGET are VTK files of points, closed loops
    (polygons or lines) and constraint lines, with the same cells. No triangle folds in either domain; points are added
    where necessary."""
    figure = {}
    if len(inputs.pair) == 2:
        figures = [read_figure(name) for name in inputs.pair]
        marks = Landmarks(*figures, list(map(str, range(figures[0].GetNumberOfPoints()))))
        inputs.grids = [None, None]
    else:
        with Input(inputs.pair[0], inputs.format or "csv") as file:
            if not is_landmark_file(file.path):
                raise Failure(f"{file.name} is not a file of landmarks: the formats are .csv (source_x, source_y, "
                              "target_x, target_y), .points and IIIF's .json.", USAGE)
            marks = landmarks.read(file, inputs)
        try:
            figure = {name: read_lines(file, marks.names)
                      for name, file in (("segments", lines), ("outlines", outlines)) if file}
        except (LandmarkFileError, OSError) as error:
            raise Failure(f"{error}.", FILE) from None
        if settings["domain"] == "outline" and not outlines:
            raise Failure("There are no outlines for --domain outline (--outlines).", USAGE)
    both, made = pair.from_landmarks(marks, " and ".join(inputs.pair), inputs, **figure, **settings)
    smallest, target = min(made.report["smallest_angles"]), settings["target_minimum_angle"]
    if smallest < target:
        inform(f"the smallest angle is {smallest:.3g} degrees, less than --target-angle {target:g}: allow more points "
               "(--maximum-added-points). Angles between landmarks and lines cannot be enlarged.")
    with output.writing():
        pair.write(both, output)
    if report:
        print_report(made, marks)
