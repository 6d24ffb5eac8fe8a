# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parallel lines over the publication's pair of polygons, in the four systems."""

import numpy
from drawing import INK, SYSTEMS, Coordinates, Page, close_up, cross, draw_edges, edges_of, fill, map_between, stroke, \
    strokes
from matplotlib.colors import LinearSegmentedColormap

COLORS = LinearSegmentedColormap.from_list("lines", ["#1a4d9e", "#9e2975", "#e6751a"])
SOURCE = numpy.array([
    (1.07, 0.0), (2.11, 1.03), (2.56, 2.31), (2.57, 3.79), (2.14, 4.87), (1.24, 6.02), (0.0, 0.53), (0.82, 1.21),
    (1.37, 2.04), (1.37, 3.25), (1.46, 4.12), (0.8, 4.87), (0.22, 5.54), (0.17, 1.6), (0.39, 1.98), (0.76, 2.88),
    (0.86, 3.31), (0.33, 4.32), (0.11, 4.79)])
TARGET = numpy.array([
    (1.73, 0.76), (1.66, 1.26), (1.48, 2.23), (1.88, 2.82), (2.33, 3.66), (2.94, 4.28), (1.43, 0.19), (1.19, 0.76),
    (0.91, 1.83), (1.1, 2.78), (1.3, 3.64), (1.76, 4.43), (2.76, 5.38), (0.44, 0.0), (0.19, 1.09), (0.09, 2.12),
    (0.0, 3.66), (0.59, 4.64), (1.73, 5.73)])
TRIANGLES = numpy.array([
    (6, 0, 7), (6, 7, 13), (0, 1, 7), (7, 14, 13), (7, 1, 8), (7, 8, 14), (1, 2, 8), (8, 15, 14), (8, 2, 9), (8, 9, 15),
    (2, 3, 9), (9, 16, 15), (9, 3, 10), (9, 10, 16), (3, 4, 10), (10, 17, 16), (10, 4, 11), (10, 11, 17), (4, 5, 11),
    (11, 18, 17), (11, 5, 12), (11, 12, 18)])
COUNT = 44

for mesh in (SOURCE, TARGET):
    assert Coordinates(mesh, TRIANGLES).concordant.all()
lines, t = [], numpy.linspace(1e-12, 1 - 1e-12, 1501)[:, None]
for share in (numpy.arange(COUNT) + 0.5) / COUNT:
    for piece in cross(SOURCE, TRIANGLES, (-1, 7 * share - 0.9), (4, 7 * share + 0.1)):
        lines.append((piece[0] + t * (piece[-1] - piece[0]), COLORS(share)))
print(f"{len(TRIANGLES)} triangles, all concordant in both; {len(lines)} pieces of lines")

edges, counts = edges_of(TRIANGLES)
rim = edges[counts == 1]
page = Page(1550, 900)
for column, system in enumerate((None, *SYSTEMS, "cubic")):
    mesh = TARGET if system else SOURCE
    f = map_between(SOURCE, TARGET, TRIANGLES, system) if system else lambda points: points
    page.label(155 + 310 * column, 874, system.capitalize() if system else "Source", 22)
    axes = page.panel(10 + 310 * column, 302, 290, 545, (-0.05, -0.05, 3.1, 6.13))
    # The middle of an interior edge.
    center = mesh[9] + 0.45 * (mesh[2] - mesh[9])
    detail = close_up(axes, page, (15 + 310 * column, 10, 280, 280), center, 0.42, 0.42)
    drawn = [(f(line), color) for line, color in lines]
    for panel, width in ((axes, 1.5), (detail, 3.0)):
        fill(panel, mesh[TRIANGLES], "#f6f7fa")
        draw_edges(panel, mesh, TRIANGLES, "#99a1b0", 0.7 * width)
        for line, color in drawn:
            stroke(panel, line, color, width)
        strokes(panel, mesh[rim], INK, 1.5 * width)
page.save("figure-6-parallel-lines.png")
