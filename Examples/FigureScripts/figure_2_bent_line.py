# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The image of a straight line: the piecewise linear map bends it at every edge, Smooth at none."""

import numpy
from drawing import Page, close_up, cross, dot, draw_edges, fill, label, map_between, stroke

LINE = "#c71f33"
TRIANGLES = numpy.array([(0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 6, 5), (2, 3, 6), (4, 5, 7), (5, 8, 7), (5, 6, 8),
                         (6, 9, 8), (3, 9, 6)])
SOURCE = numpy.array([(0.0, 0.1), (1.0, -0.1), (2.1, 0.0), (3.2, 0.2), (0.35, 1.1), (1.5, 0.55), (2.6, 1.0),
                      (0.8, 2.05), (2.0, 2.0), (3.15, 1.95)])
TARGET = numpy.array([(0.0, 0.3), (0.85, -0.1), (2.3, 0.1), (3.2, -0.05), (0.15, 1.45), (1.25, 0.55), (2.5, 0.8),
                      (1.15, 1.75), (1.95, 2.2), (3.2, 1.7)])
# Angles in degrees.
bends = lambda before, after: numpy.degrees(
    numpy.abs(numpy.arctan2(numpy.cross(before, after), (before * after).sum(axis=1))))
line = cross(SOURCE, TRIANGLES, (-0.5, 0.35), (3.6, 1.75))[0]
along = line[-1] - line[0]
linear = map_between(SOURCE, TARGET, TRIANGLES, "linear")(line)
smooth_map = map_between(SOURCE, TARGET, TRIANGLES, "smooth")
smooth = smooth_map(line[0] + numpy.linspace(1e-12, 1 - 1e-12, 4001)[:, None] * along)
angles = bends(numpy.diff(linear, axis=0)[:-1], numpy.diff(linear, axis=0)[1:])
sharpest = 1 + angles.argmax()
print(f"Linear: {len(angles)} bends, the largest {angles.max():.1f} degrees")
directions = [smooth_map.jacobian(line[1:-1] + step * along) @ along for step in (-1e-9, 1e-9)]
print(f"Smooth: largest bend at an edge {bends(*directions).max():.6g} degrees")

page = Page(1240, 610)
panels = (("A straight line", SOURCE, line, line[sharpest], []),
          ("Linear", TARGET, linear, linear[sharpest], linear[1:-1]),
          ("Smooth", TARGET, smooth, linear[sharpest], smooth_map(line[1:-1])))
for k, (title, mesh, curve, center, rings) in enumerate(panels):
    page.label(210 + 410 * k, 584, title, 22)
    axes = page.panel(10 + 410 * k, 275, 400, 285, (-0.06, -0.2, 3.32, 2.4))
    detail = close_up(axes, page, (15 + 410 * k, 12, 390, 229), center, 0.46, 0.27)
    for panel, width in ((axes, 2.6), (detail, 4.0)):
        fill(panel, mesh[TRIANGLES], "#f4f5f9")
        draw_edges(panel, mesh, TRIANGLES, "#737d8f", 1.6)
        stroke(panel, curve, LINE, width)
    for point in rings:
        dot(axes, point, 4.5, "white", LINE, 1.8)
    if title == "Linear":
        steps = numpy.diff(linear, axis=0)
        steps /= numpy.hypot(*steps.T)[:, None]
        outwards = steps[:-1] - steps[1:]
        for point, angle, way in zip(linear[1:-1], angles, 17 * outwards / numpy.hypot(*outwards.T)[:, None]):
            label(axes, point, f"{angle:.1f}°", 15, way)
page.save("figure-2-bent-line.png")
