# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Landmarks in two squares, and the image of a grid under the Linear and the Cubic map that they define."""

import numpy
from drawing import CENTER, CONTOUR, INK, Page, dot, draw_edges, fill, strokes

from vtkhomeomorphism import Homeomorphism
from vtkhomeomorphism.isomorphic import isomorphic_triangulation

# Landmarks around a center that rotates, and a few that are fixed.
SOURCE = numpy.array([(0.5, 0.5), (0.3, 0.35), (0.62, 0.3), (0.72, 0.58), (0.45, 0.72), (0.25, 0.6), (0.14, 0.15),
                      (0.86, 0.16), (0.88, 0.85), (0.13, 0.87)])
middle = SOURCE - (0.48, 0.5)
angle = 0.95 * numpy.exp(-6 * (middle**2).sum(axis=1))
TARGET = numpy.column_stack((numpy.cos(angle) * middle[:, 0] - numpy.sin(angle) * middle[:, 1],
                             numpy.sin(angle) * middle[:, 0] + numpy.cos(angle) * middle[:, 1])) + (0.5, 0.5)
SQUARE = (0, 1, 0, 1)
LINES = 33

pair = isomorphic_triangulation(SOURCE, TARGET, frame=(SQUARE, SQUARE))
t = numpy.linspace(1e-9, 1 - 1e-9, 1201)
grid = [numpy.column_stack((numpy.full_like(t, x), t)) for x in t[:: 1200 // (LINES - 1)]]
grid += [line[:, ::-1] for line in grid]
print(f"{len(SOURCE)} landmarks, {len(pair.triangles)} triangles")

page = Page(1240, 455)
for column, title in enumerate(("Landmarks", "Linear", "Cubic")):
    page.label(210 + 410 * column, 435, title, 22)
    axes = page.panel(10 + 410 * column, 10, 400, 400, (-0.01, -0.01, 1.02, 1.02))
    fill(axes, [[(0, 0), (1, 0), (1, 1), (0, 1)]], "#f6f7fa")
    if column == 0:
        draw_edges(axes, pair.source, pair.triangles, "#c3c9d4", 1.0)
        for start, end in zip(SOURCE, TARGET):
            axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": CENTER, "lw": 1.4}, zorder=5)
            dot(axes, start, 4, CONTOUR)
    else:
        f = Homeomorphism(pair.source, pair.target, pair.triangles, title.lower(), fairness_refinement=2)
        strokes(axes, [f(line) for line in grid], CONTOUR if column == 2 else INK, 1.1)
        for point in TARGET:
            dot(axes, point, 4, CENTER)
page.save("figure-9-landmarks.png")
