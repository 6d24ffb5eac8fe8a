# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm check"""

import json
import math

import click
import numpy

from .. import meshes, options, plots
from ..files import Failure, Output, inform
from ..mapping import ground_distances
from ..report import Report

SYSTEMS = ("Linear", "Contour", "Smooth")


def value_at(report, column, cell=None):
    """A value and its cell for JSON; None if it was not measured."""
    value = report[column]
    return None if math.isnan(value) else {"value": value, "cell": int(report[cell or column + "Cell"])}


def number(report, column):
    value = report[column]
    return None if math.isnan(value) else int(value) if value == int(value) else value


def duplicates_of(mesh):
    """Ids of points with the coordinates of a previous point."""
    points = meshes.points_of(mesh)
    _, first = numpy.unique(points, axis=0, return_index=True)
    return numpy.setdiff1d(numpy.arange(len(points)), first)


def as_json(report, pair):
    result = {"valid": bool(report.valid)}
    result["problems"] = [dict(d, message=text) for d, text in zip(report.defects, report.sentences())]
    result["invalid_triangles"] = report.cells_where(0, "Invalid")
    invalid = set(result["invalid_triangles"])
    for side, name in enumerate(("Source", "Target")):
        mesh = {"file": pair.names[side], "points": number(report, name + "Points"),
                "triangles": number(report, name + "Triangles"), "unused_points": number(report, name + "UnusedPoints"),
                "duplicate_points": duplicates_of(pair.meshes[side]).tolist()}
        if report.measured:
            mesh.update(planar=bool(report[name + "Planar"]),
                        discordant_triangles=[c for c in report.cells_where(side, "Concordant", 0) if c not in invalid],
                        smallest_angle_degrees=value_at(report, name + "SmallestAngle"),
                        largest_area_ratio_across_an_edge=value_at(report, name + "LargestAreaRatio"))
        result[name.lower()] = mesh
    if not report.measured:
        return result
    result["mirrored"] = bool(report["Mirrored"])
    for name, column in (("opposite_windings", "OppositeWindings"), ("reordered_triangles", "ReorderedTriangles"),
                         ("components", "Components"), ("interior_edges", "InteriorEdges"),
                         ("boundary_edges", "BoundaryEdges"), ("boundary_loops", "BoundaryLoops")):
        result[name] = number(report, column)
    for name, column in (("largest_stretch", "LargestStretch"), ("smallest_stretch", "SmallestStretch"),
                         ("largest_distortion", "LargestDistortion")):
        result[name] = value_at(report, column)
    result["systems"] = {}
    for system in SYSTEMS:
        measures = {
            "samples": number(report, system + "Samples"), "not_positive": number(report, system + "NotPositive"),
            "smallest_determinant": value_at(report, system + "SmallestDeterminant"),
            "largest_determinant": value_at(report, system + "LargestDeterminant"),
            "deviation_from_linear": value_at(report, system + "DeviationFromLinear"),
            "second_difference": number(report, system + "SecondDifference"),
            "differentiable_edges": number(report, system + "DifferentiableEdges"),
            "creases": number(report, system + "Creases"), "undecided_edges": number(report, system + "UndecidedEdges"),
            "largest_jump": number(report, system + "LargestJump"),
        }
        if not measures["samples"]:
            measures["not_positive"] = None
        result["systems"][system] = {k: v for k, v in measures.items() if v is not None and v != -1}
    return result


def row(name, *cells):
    click.echo(f"  {name:38} {''.join(f'{cell!s:23}' for cell in cells)}".rstrip())


def at_cell(extreme, digits=6):
    return "none" if not extreme else f"{extreme['value']:.{digits}g} (cell {extreme['cell']})"


def print_report(found, pair, deviations):
    click.echo(f"{pair.name}: {'a valid pair' if found['valid'] else 'NOT a valid pair'}")
    for problem in found["problems"]:
        click.echo(f"  - {problem['message']}")
    if found["problems"]:
        click.echo("  dhm map, warp and others leave invalid triangles out with --mask-invalid.")
    sides = [found["source"], found["target"]]
    click.echo()
    row("", "source", "target")
    row("points", *(side["points"] for side in sides))
    row("triangles", *(side["triangles"] for side in sides))
    row("points that no triangle uses", *(side["unused_points"] for side in sides))
    row("duplicate points", *(len(side["duplicate_points"]) for side in sides))
    if "mirrored" not in found:
        return
    row("planar", *("yes" if side["planar"] else "no, a surface" for side in sides))
    row("concordant triangles", *(f"{100 * (1 - len(s['discordant_triangles']) / s['triangles']):.1f} %" for s in sides))
    row("smallest angle, degrees", *(at_cell(side["smallest_angle_degrees"], 3) for side in sides))
    row("largest area ratio across an edge", *(at_cell(side["largest_area_ratio_across_an_edge"], 4) for side in sides))
    click.echo()
    row("mirrored", "yes" if found["mirrored"] else "no")
    row("triangles of the opposite winding", found["opposite_windings"])
    row("triangles listed in another order", found["reordered_triangles"])
    row("components", found["components"])
    row("boundary loops", found["boundary_loops"])
    row("edges", f"{found['interior_edges']} interior, {found['boundary_edges']} on the boundary")
    row("lengths change by factors of", f"{at_cell(found['smallest_stretch'])} to {at_cell(found['largest_stretch'])}")
    row("largest distortion (ratio of the two)", at_cell(found["largest_distortion"]))
    systems = [found["systems"][name] for name in SYSTEMS]
    if not any(systems):
        return
    click.echo()
    row("", *SYSTEMS)
    for title, key, show in (
            ("det J, smallest", "smallest_determinant", at_cell), ("det J, largest", "largest_determinant", at_cell),
            ("samples with the wrong sign of det J", "not_positive", str),
            ("farthest from Linear, target's units", "deviation_from_linear", lambda e: at_cell(e, 4)),
            ("second difference (1/10 of an edge)", "second_difference", lambda v: f"{v:.3g}"),
            ("edges: differentiable", "differentiable_edges", str), ("edges: creases", "creases", str),
            ("edges: undecided", "undecided_edges", str), ("largest jump of J, relative", "largest_jump", lambda v: f"{v:.2g}")):
        if any(key in system for system in systems):
            row(title, *(show(system[key]) if key in system else "" for system in systems))
    if deviations:
        row("farthest from Linear, meters", *(f"{value:.4g}" for value in deviations))
    if any(side["discordant_triangles"] for side in sides):
        click.echo("\n  Discordant triangles are Linear's in the column Contour.")


def deviations_in_meters(report, pair):
    """The largest deviations of the systems from Linear on the ground, for a triangulation file that names the
    coordinate reference system of its target."""
    from ..mapping import PointMap, Settings

    if not pair.shift or not pair.shift.crs() or math.isnan(report["SmoothDeviationFromLinearX"]):
        return []
    result = []
    for system in SYSTEMS:
        point = numpy.array([[report[f"{system}DeviationFromLinear{axis}"] for axis in "XY"]])
        settings = [Settings(system=name, linear_where_discordant=True, mask_invalid=True) for name in (system.lower(), "linear")]
        flat = [PointMap(pair, s).map_data(_point(point)) for s in settings]
        images = [meshes.points_of(data)[:, :2] for data in flat]
        distances, unit = ground_distances(*images, pair.shift.crs())
        if unit != "meters":
            return []
        result.append(distances[0])
    return result


def _point(point):
    from ..mapping import as_data

    return as_data(numpy.nan_to_num(point))


@click.command("check")
@options.pair_files("SOURCE [TARGET]")
@click.option("--json", "as_text", is_flag=True, help="Write the report as JSON.")
@click.option("--quick", is_flag=True, help="Validate the meshes only, without measuring determinants and continuity.")
@click.option("--plot", default="", metavar="FILE", help="Draw the pair with invalid triangles marked: .png .svg .pdf.")
@click.option("-f", "--force", is_flag=True, help="Replace the plot if it exists.")
@options.quiet
def command(inputs, as_text, quick, plot, force):
    """Report whether two meshes define a map (exit status 0, otherwise 1), and the properties of the map.

    Measurements exclude invalid triangles. Continuity: whether the derivative of the map is the same on both sides of
    each interior edge, measured from values of the map."""
    output = Output(plot, "", force, plots.FORMATS, "a plot") if plot else None
    pair = options.read_pair(inputs)
    report = Report(pair, maps=not quick, continuity=not quick)
    found = as_json(report, pair)
    if as_text:
        click.echo(json.dumps(found, indent=2, ensure_ascii=False))
    else:
        print_report(found, pair, deviations_in_meters(report, pair))
    if min(len(found[side]["duplicate_points"]) for side in ("source", "target")) > found.get("interior_edges", math.inf):
        inform(f"the triangles share hardly any points: {len(found['source']['duplicate_points'])} points of the source "
               f"coincide with others, and {found['interior_edges']} edges join two triangles. If they are to be one mesh, "
               "join such points, in both meshes alike (dhm convert -o both.vtp, then ParaView's Clean).")
    if output:
        discordant = [found[side].get("discordant_triangles", []) for side in ("source", "target")]
        duplicates = [found[side]["duplicate_points"] for side in ("source", "target")]
        plots.save(plots.draw_pair(pair, found["invalid_triangles"], discordant, duplicates), output)
    if not report.valid:
        raise Failure(f"{pair.name}: not a valid pair.")
