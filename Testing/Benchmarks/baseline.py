# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Times the rows of this build and of another one in turn, and prints the ratios."""

import contextlib
import os
import statistics

from rows import DIRECTIONS, Program, ProgramRow, measure
from workloads import Workload, grid_in_scan_order, picture, random_points

SYSTEMS = ("Linear", "Contour", "Smooth", "CubicLocal", "CubicLeast")
PARTS = ("small", "large", "image", "construction")
# The largest allowed ratio of medians, unless two runs of the other build differ by more.
ALLOWED = 1.03


def row_names(part):
    """The rows of a part. This build must have all of them, see other_name."""
    if part == "image":
        return [f"{way}/{system}" for way in ("reslice", "resample") for system in SYSTEMS]
    if part == "construction":
        return [f"construct/{system}" for system in SYSTEMS[:4]]
    ways = ("transform", "pointwise", "filter", "jacobian") if part == "small" else ("transform",)
    return [f"{way}/{system}/{d}" for way in ways for system in SYSTEMS for d in DIRECTIONS]


def other_name(name, part, known):
    """The row of another build to compare a row with; None if there is none. A build without the Cubic system has Smooth,
    the goal of Cubic's arrays of points."""
    if part == "small" and name in ("transform/CubicLocal/forward", "transform/CubicLeast/forward") and name not in known:
        name = "transform/Smooth/forward"
    return name if name in known else None


def make_workloads(part, settings, folder):
    """Workloads of a part with the points of each, by a title."""
    if part == "image":
        size = settings["image"]
        workload = Workload(folder / part, settings["small"], (size - 1) / settings["small"])
        workload.set_image(picture(size))
        workload.add_points("image", workload.source[:1])
        return workload, {"image": ("image", size * size)}
    workload = Workload(folder / part, settings["small" if part == "small" else "large"])
    if part == "construction":
        workload.add_points("few", workload.source[:1])
        return workload, {"construction": ("few", len(workload.triangles))}
    side = settings["side"]
    orders = {"scan": grid_in_scan_order(workload.width, side, side),
              "random": random_points(workload.width, side * side)}
    if part == "large":
        orders["dense"] = grid_in_scan_order(workload.width, *settings["dense"])
    for order, points in orders.items():
        workload.add_points(order, points)
    return workload, {f"{part}, {order}": (order, len(points)) for order, points in orders.items()}


def compare(program, other, settings, folder, parts):
    """Prints a table of nanoseconds an item and ratios. Returns the rows that are too slow."""
    slow = []
    # Run all programs on one processor: those of a virtual machine can differ in speed by a third for minutes.
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    print("| | row | other build, ns | this build, ns | ratio | other against itself |")
    print("|---|---|---:|---:|---:|---:|")
    for part in (p for p in parts if p in PARTS):
        workload, orders = make_workloads(part, settings, folder)
        with contextlib.ExitStack() as stack:
            # Time the other build twice, to know how much its own medians differ.
            builds = [stack.enter_context(Program(p, workload)) for p in (other, program, other)]
            known = set(builds[0].names())
            for title, (points, count) in orders.items():
                for name in row_names(part):
                    beside = other_name(name, part, known)
                    if not beside:
                        continue
                    rows = [ProgramRow(build, n) for build, n in zip(builds, (beside, name, beside))]
                    measured = measure(rows, {points: count}, settings["repetitions"], points, keep=False, quiet=True)
                    before, now, again = (1e9 * statistics.median(m.seconds) / count for m in measured)
                    spread = max(before / again, again / before)
                    ratio = 2.0 * now / (before + again)
                    too_slow = ratio > max(ALLOWED, spread)
                    mark = "**" if too_slow else ""
                    words = name if name == beside else f"{name} / {beside}"
                    print(f"| {title} | {words} | {before:.4g} | {now:.4g} | {mark}{ratio:.3f}{mark} | {spread:.3f} |", flush=True)
                    if too_slow:
                        slow.append(f"{title}: {words}")
    return slow
