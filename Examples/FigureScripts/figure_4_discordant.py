# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""A discordant triangle: not all feet of the centroid are inside the edges. Those of the incenter are, and Smooth does
not use feet."""

import numpy
from drawing import CENTER, CONTOUR, INK, RING, Coordinates, Page, dot, draw_edges, fill, label, right_angle, \
    stroke, strokes

CORNERS, TRIANGLES, OUTSIDE = numpy.array([(0.0, 0.0), (1.0, 0.0), (-1.6, 1.7)]), [(0, 1, 2)], "#d11429"


def draw_feet(axes):
    center = CORNERS.mean(axis=0)
    fill(axes, [CORNERS], "#f4f5f9")
    draw_edges(axes, CORNERS, TRIANGLES, INK, 2.6)
    for a, b in zip(CORNERS, numpy.roll(CORNERS, -1, axis=0)):
        edge = b - a
        share = (center - a) @ edge / (edge @ edge)
        foot = a + share * edge
        inside = 0 < share < 1
        color = CENTER if inside else OUTSIDE
        if not inside:
            print(f"the foot is at {share:.6g} of the edge")
            stroke(axes, [a if share < 0 else b, foot + (-0.25 if share < 0 else 0.25) * edge], INK, 1.8,
                   linestyle=(0, (5, 4)))
        stroke(axes, [center, foot], color, 2.2)
        right_angle(axes, foot, center, b if share < 0.5 else a, 0.07, color, 1.4)
        dot(axes, foot, 3.8 if inside else 5.6, color)
    dot(axes, center, 4.6, INK)
    label(axes, center, "$G$", 20, (17, -9))


assert not Coordinates(CORNERS, TRIANGLES).concordant.any()
page = Page(1240, 330)
panels = (("From the centroid: discordant", None, ""), ("From the incenter", "contour", "incenter"),
          ("Smooth", "smooth", "centroid"))
for k, (title, system, start) in enumerate(panels):
    axes = page.panel(10 + 410 * k, 8, 400, 270, (-1.66, -0.09, 2.72, 1.86))
    page.label(210 + 410 * k, 304, title, 20)
    if system is None:
        draw_feet(axes)
        continue
    coordinates = Coordinates(CORNERS, TRIANGLES, system, 6, 5, start)
    strokes(axes, coordinates.lines("RING_LINE"), RING, 1.0)
    strokes(axes, coordinates.lines("CONTOUR_LINE"), CONTOUR, 1.1)
    draw_edges(axes, CORNERS, TRIANGLES, INK, 2.6)
page.save("figure-4-discordant.png")
