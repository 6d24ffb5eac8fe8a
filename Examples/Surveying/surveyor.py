#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Points for Examples/surveyor, and the evaluation of the results.

    surveyor.py points FILE.json POINTS.csv     a grid over the triangulation, random points, and a line
    surveyor.py compare FOLDER                  numbers, and the picture scale.png
"""

import json
import os
import sys

import numpy

GRID = 400
RANDOM_POINTS = 100000
LINE_POINTS = 6000


def make_points(file_name, output):
    """A grid over the source's bounding box (kind 0), points that are distributed uniformly over the triangles (1), and
    a line from west to east through the middle (2)."""
    with open(file_name, encoding="utf-8") as file:
        document = json.load(file)
    columns = document["vertices_columns"]
    vertices = numpy.array(document["vertices"], float)
    vertices = vertices[:, [columns.index("source_x"), columns.index("source_y")]]
    corners = document["triangles_columns"]
    triangles = numpy.array(document["triangles"])
    triangles = triangles[:, [corners.index(f"idx_vertex{k}") for k in (1, 2, 3)]]

    low, high = vertices.min(axis=0), vertices.max(axis=0)
    spacing = (high - low).max() / GRID
    x, y = numpy.meshgrid(*[numpy.arange(low[k] + spacing / 2, high[k], spacing) for k in (0, 1)])
    grid = numpy.column_stack([x.ravel(), y.ravel()])

    generator = numpy.random.default_rng(1)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    areas = numpy.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    chosen = generator.choice(len(triangles), RANDOM_POINTS, p=areas / areas.sum())
    s, t = numpy.sort(generator.random((2, RANDOM_POINTS)), axis=0)[:, :, None]
    spread = s * a[chosen] + (t - s) * b[chosen] + (1 - t) * c[chosen]
    line = numpy.column_stack([numpy.linspace(low[0], high[0], LINE_POINTS),
                               numpy.full(LINE_POINTS, (low[1] + high[1]) / 2)])
    kind = numpy.repeat([0, 1, 2], [len(grid), len(spread), len(line)])
    numpy.savetxt(output, numpy.column_stack([numpy.concatenate([grid, spread, line]), kind]), delimiter=",",
                  fmt=["%.4f", "%.4f", "%d"], header="E,N,kind", comments="")


def read(name):
    return numpy.genfromtxt(name, delimiter=",", names=True)


def places(table):
    return numpy.column_stack([table["E"], table["N"]])


def largest(difference):
    return numpy.hypot(difference[:, 0], difference[:, 1]).max()


def compare(folder):
    """Prints the table, and draws the change of areas."""
    os.chdir(folder)
    points, linear, smooth, back = (read(name + ".csv") for name in ("points", "linear", "smooth", "back"))
    scattered = points["kind"] == 1
    assert (linear["vtkValidPointMask"][scattered] == 1).all()
    difference = (places(smooth) - places(linear))[scattered]
    proj, refined = (numpy.loadtxt(name, usecols=(0, 1)) for name in ("proj.txt", "proj-refined.txt"))
    rows = [
        ("Linear and PROJ differ by at most", numpy.abs(places(linear)[scattered] - proj).max()),
        ("Smooth and Linear differ by at most", largest(difference)),
        ("... on average", numpy.hypot(difference[:, 0], difference[:, 1]).mean()),
        ("Smooth there and back", largest((places(back) - places(points))[scattered])),
        ("PROJ with the refined file and Smooth", largest(refined - places(smooth)[scattered])),
    ]
    print(f"\nAt {scattered.sum()} points, meters:")
    for name, value in rows:
        print(f"  {name:40s} {value:.2g}")

    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    def parts_per_million(table, chosen):
        valid = table["vtkValidPointMask"][chosen] == 1
        return numpy.where(valid, 1e6 * (table["JacobianDeterminant"][chosen] - middle), numpy.nan)

    grid, line = points["kind"] == 0, points["kind"] == 2
    middle = numpy.nanmedian(linear["JacobianDeterminant"])
    x, y = numpy.unique(points["E"][grid]), numpy.unique(points["N"][grid])
    bound = numpy.nanpercentile(numpy.abs(parts_per_million(smooth, grid)), 99)
    figure = pyplot.figure(figsize=(9, 9.6), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[2.2, 1])
    axes = above.subplots(1, 2, sharey=True)
    profile = below.subplots()
    tables = (("Linear (PROJ)", linear), ("Smooth", smooth))
    for axis, (name, table), color in zip(axes, tables, ("tab:red", "tab:blue")):
        picture = axis.pcolormesh(x / 1000, y / 1000, parts_per_million(table, grid).reshape(len(y), len(x)),
                                  cmap="RdBu_r", vmin=-bound, vmax=bound, shading="nearest", rasterized=True)
        axis.axhline(points["N"][line][0] / 1000, color=color, linewidth=1)
        axis.set_aspect("equal")
        axis.set_title(name)
        axis.set_xlabel("easting, km")
        profile.plot(points["E"][line] / 1000, parts_per_million(table, line), color=color, linewidth=1,
                     label=name)
    axes[0].set_ylabel("northing, km")
    above.colorbar(picture, ax=axes, shrink=0.7, label="change of areas, relative to the median, ppm")
    profile.set_xlabel("easting along the line, km")
    profile.set_ylabel("ppm")
    profile.legend()
    figure.savefig("scale.png", dpi=100)


if __name__ == "__main__":
    if sys.argv[1] == "points":
        make_points(sys.argv[2], sys.argv[3])
    else:
        compare(sys.argv[2])
