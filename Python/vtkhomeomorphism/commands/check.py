# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm check"""

import json
import math

import click
import numpy

from .. import options, plots
from ..arrays import SYSTEMS, make_mesh, points_of
from ..files import Failure, Output, inform
from ..mapping import PointMap, Settings, ground_distances
from ..report import Report


def find_duplicates(mesh):
    """Ids of points with the coordinates of a previous point."""
    points = points_of(mesh)
    _, first = numpy.unique(points, axis=0, return_index=True)
    return numpy.setdiff1d(numpy.arange(len(points)), first).tolist()


def describe(report, pair):
    """The report as a dict, for JSON."""
    found = report.statistics()
    found["valid"], found["problems"] = report.valid, report.problems()
    found["invalid_triangles"] = report.cells_where(0, "Invalid")
    for side, name in enumerate(("source", "target")):
        found[name].update(file=pair.names[side], duplicate_points=find_duplicates(pair.meshes[side]))
        if report.measured:
            wrong = set(report.cells_where(side, "Concordant", 0)) - set(found["invalid_triangles"])
            found[name]["discordant_triangles"] = sorted(wrong)
    crs = pair.shift and pair.shift.crs()
    for name in SYSTEMS:
        if "smallest_determinant" not in found.get(name, ()):
            found.pop(name, None)
        elif crs:
            point = make_mesh(numpy.array([[found[name][f"deviation_from_linear_{axis}"] for axis in "xy"]]))
            both = [Settings(system, True, {"discordant_by_linear": True}) for system in (name, "linear")]
            images = [points_of(PointMap(pair, settings).map_data(point))[:, :2] for settings in both]
            distances, unit = ground_distances(*images, crs)
            if unit == "meters":
                found[name]["deviation_in_meters"] = distances[0]
    return found


def show(value):
    """A value of the report as text."""
    if isinstance(value, dict):
        return f"{show(value['value'])} (cell {value['cell']})"
    if isinstance(value, list):
        return str(len(value))
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def print_table(columns):
    """A table of dicts side by side, with a row for each member."""
    rows = dict.fromkeys(name for column in columns.values() for name in column
                         if name not in ("file", "valid", "measured", "problems") and name[-2:] not in ("_x", "_y", "_z"))
    if rows:
        click.echo(("\n  " + " " * 36 + "".join(f"{title:23}" for title in columns)).rstrip())
    for name in rows:
        cells = [show(column[name]) if name in column else "" for column in columns.values()]
        click.echo(f"  {name.replace('_', ' '):36}{''.join(f'{cell:23}' for cell in cells)}".rstrip())


@click.command("check")
@click.option("--json", "as_json", is_flag=True, help="Write the report as JSON, with all cell ids.")
@click.option("--quick", is_flag=True, help="Validate the meshes only; do not measure determinants and continuity.")
@click.option("--plot", default="", metavar="FILE", help="Plot the pair and mark invalid triangles: .png .svg .pdf.")
@options.force
@options.pair_files("SOURCE [TARGET]")
@options.quiet
def command(inputs, as_json, quick, plot, force):
    """Validate a pair of meshes and measure its maps.

    The exit status is 0 if the pair is valid, otherwise 1. Invalid triangles are not measured. A crease is an interior
    edge at which the derivatives on the two sides differ, as measured from values of the map. Lengths and areas are in
    the meshes' units."""
    output = Output(plot, "", force, plots.FORMATS, "a plot") if plot else None
    pair = options.read_pair(inputs)
    report = Report(pair, maps=not quick, continuity=not quick)
    found = describe(report, pair)
    if as_json:
        click.echo(json.dumps(found, indent=2, ensure_ascii=False))
    else:
        click.echo(f"{pair.name}: {'a valid pair' if report.valid else 'NOT a valid pair'}")
        for problem in found["problems"]:
            click.echo(f"  - {problem['message']}")
        print_table({name: found[name] for name in ("source", "target")})
        print_table({"": {name: found[name] for name in found if not isinstance(found[name], dict) or "cell" in found[name]}})
        print_table({name: found[name] for name in SYSTEMS if name in found})
    duplicates = [found[side]["duplicate_points"] for side in ("source", "target")]
    if min(map(len, duplicates)) > found.get("interior_edges", math.inf):
        inform(f"the triangles share hardly any points: {len(duplicates[0])} points of the source coincide with others, and "
               f"{found['interior_edges']} edges join two triangles. If they are to be one mesh, join such points, in both "
               "meshes alike (dhm convert -o both.vtp, then ParaView's Clean).")
    if output:
        discordant = [found[side].get("discordant_triangles", []) for side in ("source", "target")]
        plots.save(plots.draw_pair(pair, found["invalid_triangles"], discordant, duplicates), output)
    if not report.valid:
        raise Failure(f"{pair.name}: not a valid pair.")
