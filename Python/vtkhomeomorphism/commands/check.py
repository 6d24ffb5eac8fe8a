# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm check"""

import json
import re

import click

from .. import options, plots
from ..arrays import SYSTEMS
from ..files import Failure, Output, count, inform
from ..report import Report


def show(value):
    """A value of the report as text."""
    if isinstance(value, dict):
        return f"{show(value['value'])} (cell {value['cell']})"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(len(value) if isinstance(value, list) else value)


def print_table(columns):
    """Prints dicts as the columns of a table, with a row for each key."""
    hidden = re.compile("file|valid|measured|problems|.*_[xyz]")
    rows = dict.fromkeys(name for column in columns.values() for name in column if not hidden.fullmatch(name))
    if rows:
        click.echo(("\n  " + " " * 36 + "".join(f"{title:23}" for title in columns)).rstrip())
    for name in rows:
        cells = [show(column[name]) if name in column else "" for column in columns.values()]
        click.echo(f"  {name.replace('_', ' '):36}{''.join(f'{cell:23}' for cell in cells)}".rstrip())


@click.command("check")
@click.option("--json", "as_json", is_flag=True, help="Write the report as JSON, with all cell ids.")
@click.option("--quick", is_flag=True, help="Only validate the meshes; do not measure the maps.")
@click.option("--plot", default="", metavar="FILE", help="Plot the pair and mark invalid triangles: .png .svg .pdf.")
@options.force
@options.pair_files("SOURCE [TARGET]")
def command(inputs, as_json, quick, plot, force):
    """Validate a pair of meshes and measure its maps.

    The exit status is 0 if the pair is valid, otherwise 1. Invalid triangles are not measured. A crease is an interior
    edge at which the derivatives on the two sides differ, measured from values of the map. Lengths and areas are in the
    units of the meshes."""
    output = Output(plot, "", force, plots.FORMATS, "a plot") if plot else None
    pair = options.read_pair(inputs)
    report = Report(pair, not quick)
    found = {**report.statistics(), "valid": report.valid, "problems": report.problems(),
             "invalid_triangles": report.cells_where(0, "Invalid")}
    for side, name in enumerate(("source", "target")):
        found[name]["file"] = pair.names[side]
        if report.measured:
            wrong = set(report.cells_where(side, "Concordant", 0)) - set(found["invalid_triangles"])
            found[name]["discordant_triangles"] = sorted(wrong)
    if as_json:
        click.echo(json.dumps(found, indent=2, ensure_ascii=False))
    else:
        uncertified = found.get("cubic", {}).get("uncertified_triangles", 0)
        but = f", but its Cubic map is not certified in {count(uncertified, 'triangle')}" if uncertified else ""
        click.echo(f"{pair.name}: {'a valid pair' if report.valid else 'NOT a valid pair'}{but}")
        for problem in found["problems"]:
            click.echo(f"  - {problem['message']}")
        print_table({name: found[name] for name in ("source", "target")})
        print_table({"": {name: found[name] for name in found if name not in ("source", "target", *SYSTEMS)}})
        print_table({name: found[name] for name in SYSTEMS if name in found})
    duplicates = min(found[side]["duplicate_points"] for side in ("source", "target"))
    if duplicates > found.get("interior_edges", duplicates):
        inform(f"few triangles share points: {duplicates} points coincide with others, and "
               f"{found['interior_edges']} edges join two triangles. If they are to be one mesh, merge such points in "
               "both meshes alike (dhm convert -o both.vtp, then ParaView's Clean).")
    if output:
        discordant = [found[side].get("discordant_triangles", []) for side in ("source", "target")]
        plots.save(plots.draw_pair(pair, found["invalid_triangles"], discordant), output)
    if not report.valid:
        raise Failure(f"{pair.name}: not a valid pair.")
