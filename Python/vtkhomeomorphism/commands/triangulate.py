# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm triangulate"""

import click
import numpy

from .. import landmarks, meshes, options, pair, vtkfiles
from ..arrays import points_of
from ..files import FILE, USAGE, Failure, Input, inform
from ..isomorphic import DOMAINS, QUALITIES
from ..landmarks import LandmarkFileError, Landmarks, is_landmark_file, read_lines


def read_figures(names):
    """Landmarks, polygons and lines of two VTK files with the same cells."""
    figures = []
    for name in names:
        with Input(name) as file:
            if file.format not in ("vtp", "vtk"):
                raise Failure(f"{name} is not a figure: landmarks are one file, figures two of .vtp or .vtk.", USAGE)
            data = vtkfiles.read(file)
            if data.GetClassName() != "vtkPolyData":
                file.fail(f"it holds a {data.GetClassName()}, not points, lines and polygons.")
            figures.append(data)
    cells, others = ([[ids.tolist() for ids in meshes.lists_of(cells)] for cells in (figure.GetPolys(), figure.GetLines())]
                     for figure in figures)
    points = [points_of(figure) for figure in figures]
    if cells != others or len(points[0]) != len(points[1]):
        raise Failure(f"{names[0]} and {names[1]} have different cells or numbers of points: a figure is drawn twice.")
    flat = [p[:, :2] if numpy.ptp(p[:, 2]) == 0 else p for p in points]
    return Landmarks(*flat, [str(i) for i in range(len(points[0]))]), *cells


def are_loops(lines):
    """Whether each point of the lines has two segments."""
    ends = [i for line in lines for pair in zip(line, line[1:]) for i in pair]
    return bool(ends) and set(numpy.unique(ends, return_counts=True)[1]) == {2}


def print_report(made, marks):
    found = made.report
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
    suspicious = set(made.suspicious().tolist())
    click.echo("largest residuals, target's units")
    for i in numpy.argsort(-made.residuals, kind="stable")[:10].tolist():
        click.echo(f"  {marks.names[i]:31}{made.residuals[i]:.4g}{'  suspicious' if i in suspicious else ''}")


@click.command("triangulate")
@options.output("The pair in one file: .json (PROJ triangulation file), .vtp or .vtk (with the target as the point array "
                "Target).", "json", pair.FORMATS, "a pair")
@click.option("--lines", default="", metavar="FILE", help="Constraint lines: names of landmarks, one line per row.")
@click.option("--outlines", default="", metavar="FILE", help="Outlines and holes: names of landmarks, one loop per row.")
@click.option("--domain", type=click.Choice(list(DOMAINS)), default="automatic", show_default=True,
              help="The inside of the outlines, a frame around the landmarks, or their convex hulls; automatic: "
                   "outline if there are outlines, else frame.")
@click.option("--quality", type=click.Choice(list(QUALITIES)), default="minimum_angle", show_default=True,
              help="Quality measure for which triangles are optimized.")
@click.option("--target-angle", type=options.Number(0, 60), default=0.0, metavar="DEGREES",
              help="Add points until no angle is smaller than this (default: necessary points only).")
@click.option("--maximum-added-points", type=click.IntRange(0), metavar="NUMBER",
              help="Greatest number of added points (default: the necessary ones, and up to 100 for --target-angle).")
@click.option("--maximum-size", type=options.Number(0, 1), default=0.0, metavar="SHARE",
              help="Divide triangles with more than this share of the domain's area.")
@click.option("--leave-out-conflicts", is_flag=True, help="Leave out and list lines that conflict with others.")
@click.option("--report", is_flag=True, help="Print angles, distortion and the landmarks with the largest residuals.")
@options.pair_files("LANDMARKS | SOURCE TARGET")
def command(inputs, output, lines, outlines, domain, quality, target_angle, maximum_added_points,
            maximum_size, leave_out_conflicts, report):
    """Make a pair of meshes with the same triangles from landmarks.

    LANDMARKS is a .csv file (source_x, source_y, target_x, target_y, optionally id; or BigWarp's format), a QGIS .points
    file, or an IIIF georeference annotation (.json). SOURCE and TARGET are VTK files of points, closed loops (polygons or
    lines) and constraint lines, with the same cells. Triangles do not fold in either domain; points are added where
    necessary."""
    segments, loops = [], []
    if len(inputs.pair) == 2:
        marks, loops, segments = read_figures(inputs.pair)
        domain = "outline" if domain == "automatic" and are_loops(segments) else domain
    else:
        name = inputs.pair[0]
        with Input(name, inputs.format or "csv") as file:
            if not is_landmark_file(file.path):
                raise Failure(f"{file.name} is not a file of landmarks: the formats are .csv (source_x, source_y, target_x, "
                              "target_y), .points and IIIF's .json.", USAGE)
            marks = landmarks.read(file, inputs)
        try:
            segments, loops = (read_lines(file, marks.names) if file else [] for file in (lines, outlines))
        except (LandmarkFileError, OSError) as error:
            raise Failure(f"{error}.", FILE) from None
    if domain == "outline" and not loops and not are_loops(segments):
        raise Failure("There are no outlines for --domain outline (--outlines).", USAGE)
    both, made = pair.from_landmarks(
        marks, " and ".join(inputs.pair), inputs, outlines=loops, segments=segments, domain=domain, quality=quality,
        target_minimum_angle=target_angle, maximum_added_points=maximum_added_points,
        maximum_triangle_size=maximum_size, leave_out_conflicting_segments=leave_out_conflicts)
    smallest = min(made.report["smallest_angles"])
    if smallest < target_angle:
        inform(f"the smallest angle is {smallest:.3g} degrees and misses --target-angle {target_angle:g}: allow more points "
               "(--maximum-added-points); angles between landmarks and lines cannot be enlarged.")
    with output.writing():
        pair.write(both, output)
    if report:
        print_report(made, marks)
