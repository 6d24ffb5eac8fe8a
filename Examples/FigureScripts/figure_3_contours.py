# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The contours of the published construction: those of a triangle, and the construction of one in a half edge."""

import numpy
from drawing import CENTER, CONTOUR, INK, WING, Coordinates, Page, dot, draw_edges, fill, label, right_angle, stroke, \
    strokes

FAINT, GRAY, GOLD, PALE = "#9ebdde", "#737885", "#fceec7", "#fbfcfe"


def draw_triangle(axes):
    corners = numpy.array([(0.0, 0.0), (4.4, 0.35), (1.55, 3.6)])
    coordinates = Coordinates(corners, [(0, 1, 2)], "contour", 8, 1)
    center = corners.mean(axis=0)
    edges = numpy.roll(corners, -1, axis=0) - corners
    share = ((center - corners) * edges).sum(axis=1) / (edges ** 2).sum(axis=1)
    feet = corners + share[:, None] * edges
    middles = (center + feet) / 2
    # A hexagon whose sides are the wing segments.
    hexagon = numpy.stack((middles, numpy.roll(corners, -1, axis=0)), axis=1).reshape(6, 2)
    fill(axes, [corners], PALE)
    fill(axes, [[center, hexagon[k], hexagon[(k + 1) % 6]] for k in range(6)], GOLD)
    strokes(axes, coordinates.lines("CONTOUR_LINE"), FAINT, 1.2)
    strokes(axes, coordinates.lines("WING_SEGMENT"), WING, 2.0)
    strokes(axes, coordinates.lines("CENTER_SEGMENT"), CENTER, 2.4)
    for k in range(3):
        right_angle(axes, feet[k], center, corners[k], 0.08, CENTER, 1.4)
        dot(axes, middles[k], 3.6, WING)
    draw_edges(axes, corners, [(0, 1, 2)], INK, 2.6)
    dot(axes, center, 4.8, INK)
    label(axes, center, "$G$", 20, (-15, 13))
    curves = numpy.vstack(coordinates.lines("CONTOUR_LINE"))
    nearest = curves[((curves - [3.5, 1.13]) ** 2).sum(axis=1).argmin()]
    for thing, place, text, color in (
            (center + 0.78 * (feet[1] - center), (3.05, 2.75), "center segment", CENTER),
            (hexagon[2] + 0.36 * (corners[1] - hexagon[2]), (3.4, 2.2), "wing segment", WING),
            (nearest, (3.75, 1.65), "contour", CONTOUR)):
        stroke(axes, [thing, place], color, 1.0)
        dot(axes, thing, 2.4, color)
        label(axes, place, text, 17, (6, 0), ha="left", color=color)


def draw_construction(axes):
    # The half edge from its foot, at the origin, to its end.
    h, b, s = 3.1, 4.4, 0.46
    phi = numpy.arctan2(2 * b * s, h * (1 + s))
    radius = h * (1 - s) * numpy.hypot(h * (1 + s), 2 * b * s) / (4 * b * s)
    foot, center, end, middle = (0.0, 0.0), (0.0, h), (b, 0.0), (0.0, h / 2)
    wing = numpy.array((b * s, 0.5 * h * (1 - s)))
    middle_of_arc = numpy.array((b * s - h * h * (1 - s * s) / (4 * b * s), 0.0))
    on_edge = middle_of_arc + [radius, 0]
    arc = lambda begin, stop, r=radius: middle_of_arc + r * numpy.column_stack(
        [g(numpy.linspace(begin, stop, 100)) for g in (numpy.cos, numpy.sin)])
    dashed = {"linestyle": (0, (5, 4))}
    fill(axes, [[foot, end, center]], PALE)
    fill(axes, [[center, middle, end]], GOLD)
    stroke(axes, [center, end], "#999eab", 1.4, **dashed)
    stroke(axes, [middle_of_arc, wing], GRAY, 1.5, **dashed)
    stroke(axes, arc(phi, numpy.pi), FAINT, 1.4, **dashed)
    stroke(axes, [middle, end], WING, 2.0)
    stroke(axes, [center, foot], CENTER, 2.4)
    stroke(axes, [(-0.3, 0.0), (b + 0.25, 0.0)], INK, 2.6)
    right_angle(axes, foot, center, end, 0.11, CENTER, 1.4)
    right_angle(axes, on_edge, end, on_edge + [0, 1], 0.11, CONTOUR, 1.4)
    right_angle(axes, wing, center, middle_of_arc, 0.1, GRAY, 1.3)
    stroke(axes, arc(0, phi, 0.34), INK, 1.3)
    stroke(axes, [center, wing], CONTOUR, 3.4)
    stroke(axes, arc(0, phi), CONTOUR, 3.4)
    for point in (foot, center, end, wing, middle_of_arc, on_edge):
        dot(axes, point, 4.4, INK)
    dot(axes, middle, 3.6, WING)
    for point, text, offset in ((center, "G", (-17, 6)), (foot, "F", (0, -19)), (wing, "W", (16, 13)),
                                (middle_of_arc, "O", (0, -19)), (on_edge, "E", (0, -19)),
                                (middle_of_arc + 0.58 * (wing - middle_of_arc), "r", (-10, 8)),
                                (arc(phi / 2, phi / 2, 0.34)[0], r"\varphi", (15, 5))):
        label(axes, point, f"${text}$", 20, offset)
    arrow = {"arrowstyle": "<->", "color": GRAY, "lw": 0.9, "shrinkA": 0, "shrinkB": 0}
    box = {"facecolor": "white", "edgecolor": "none", "pad": 1}
    for begin, stop, text in (((0, -0.52), (b, -0.52), "b"), ((-0.42, 0), (-0.42, h), "h")):
        axes.annotate("", begin, stop, arrowprops=arrow)
        label(axes, numpy.add(begin, stop) / 2, f"${text}$", 20, bbox=box)


page = Page(1240, 520)
draw_triangle(page.panel(10, 10, 600, 500, (-0.1, -0.1, 4.6, 3.8)))
draw_construction(page.panel(630, 10, 600, 500, (-0.65, -0.7, 5.4, 4.0)))
page.save("figure-3-contours.png")
