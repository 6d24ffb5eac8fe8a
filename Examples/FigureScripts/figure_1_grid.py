# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The grid of triangular coordinates over adjacent triangles, in the three coordinate systems. The second patch has
the same triangles and other points, so that two triangles are discordant."""

import numpy
from drawing import CONTOUR, INK, RING, SYSTEMS, Coordinates, Page, draw_edges, fill, label, strokes

PATCHES = numpy.array([
    [(0.12, 0.02), (1.08, -0.25), (0.62, 0.82), (-0.42, 0.95), (-0.98, 0.08), (-0.42, -0.78), (0.55, -0.95),
     (1.48, 0.72)],
    [(0.3, 0.56), (1.15, -0.6), (0.8, 0.92), (-1.0, 0.95), (-0.98, -0.1), (-0.5, -0.88), (0.5, -0.95), (1.24, 0.62)]])
TRIANGLES = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 6), (0, 6, 1), (1, 7, 2)]

page = Page(1240, 702)
for row, points in enumerate(PATCHES):
    concordant = Coordinates(points, TRIANGLES).concordant
    print(f"row {row + 1}: {(~concordant).sum()} of {len(TRIANGLES)} triangles discordant")
    for k, system in enumerate(SYSTEMS):
        left = 10 + 410 * k
        axes = page.panel(left, 8 if row else 336, 400, 315, (-1.02, -0.98, 2.54, 1.96))
        coordinates = Coordinates(points, TRIANGLES, system, 8, 5)
        for i, triangle in enumerate(TRIANGLES):
            corners = points[list(triangle)]
            if system == "contour" and not concordant[i]:
                fill(axes, [corners], "#ebebed", "#b8b8bf", hatch="///", linewidth=0)
                sides = numpy.roll(corners, -1, axis=0) - corners
                longest = sides[numpy.hypot(*sides.T).argmax()]
                angle = numpy.degrees(numpy.arctan(longest[1] / longest[0]))
                label(axes, corners.mean(axis=0), "discordant", 15, rotation=angle, zorder=5)
                continue
            strokes(axes, coordinates.lines("RING_LINE", i), RING, 1.0)
            strokes(axes, coordinates.lines("CONTOUR_LINE", i), CONTOUR, 1.1)
        draw_edges(axes, points, TRIANGLES, INK, 2.4)
        if row == 0:
            page.label(left + 200, 676, system.capitalize(), 22)
page.save("figure-1-grid.png")
