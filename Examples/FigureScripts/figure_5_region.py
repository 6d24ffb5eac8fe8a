# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The region of third vertices C for which the triangle ABC with A = (0, 0) and B = (1, 0) is concordant, and the
results of the library for 100000 random triangles.

With G = (A + B + C) / 3 the condition 0 < (G - A).(B - A) < |B - A|^2 means -1 < x < 2. For the edge BC it means
(x - 1)(x - 2) + y^2 > 0 and (x - 1)(2x - 1) + 2 y^2 > 0: outside the circles about (3/2, 0) and (3/4, 0) with radius
1/2 and 1/4. The edge CA has their mirror images in x = 1/2."""

import numpy
from drawing import INK, Coordinates, Page, dot, fill, label, stroke
from matplotlib.patches import Circle

LEFT, RIGHT, TOP = -1.5, 2.5, 1.6
# Coordinates are multiples of 1 / UNIT, so that all that follows is exact.
UNIT = 2**20
COUNT = 100000

random = numpy.random.default_rng(2001)
x = random.integers(int(LEFT * UNIT), int(RIGHT * UNIT), COUNT)
y = random.integers(1, int(TOP * UNIT), COUNT) * random.choice([-1, 1], COUNT)
outside_circles = lambda x: (
    ((x - UNIT) * (x - 2 * UNIT) + y * y > 0) & ((x - UNIT) * (2 * x - UNIT) + 2 * y * y > 0))
expected = (x > -UNIT) & (x < 2 * UNIT) & outside_circles(x) & outside_circles(UNIT - x)
# Values at the integers, as a row.
points = numpy.zeros((COUNT, 3, 2))
points[:, 1, 0], points[:, 2] = 1, numpy.column_stack((x, y)) / UNIT
points[:, :, 0] += 5.0 * numpy.arange(COUNT)[:, None]
found = Coordinates(points.reshape(-1, 2), numpy.arange(3 * COUNT).reshape(-1, 3)).concordant
print(f"{COUNT} points, {(found != expected).sum()} disagreements")

page = Page(1190, 948)
axes = page.panel(45, 40, 1125, 900, (LEFT, -TOP, RIGHT - LEFT, 2 * TOP))
columns = lambda a, b: [[(a, -TOP), (b, -TOP), (b, TOP), (a, TOP)]]
fill(axes, columns(LEFT, RIGHT), "#feecdd")
fill(axes, columns(-1, 2), "#e2edf9")
circles = ((1.5, 0.5, "3/2", "1/2"), (0.75, 0.25, "3/4", "1/4"), (0.25, 0.25, "1/4", "1/4"),
           (-0.5, 0.5, "−1/2", "1/2"))
for center, radius, _, _ in circles:
    axes.add_patch(Circle((center, 0), radius, facecolor="#feecdd", edgecolor="none", zorder=1.5))
for inside, color in ((True, "#3878ba"), (False, "#d66b1f")):
    shown = numpy.flatnonzero(found[:4000] == inside)
    axes.plot(x[shown] / UNIT, y[shown] / UNIT, "o", markersize=2.4, color=color, markeredgewidth=0, zorder=2)
stroke(axes, [(LEFT, 0), (RIGHT, 0)], "#737885", 1.2)
for side, offset, text in ((-1, 40, "−1"), (2, -34, "2")):
    stroke(axes, [(side, -TOP), (side, TOP)], INK, 2.2)
    label(axes, (side, 1.35), f"$x$ = {text}", 18, (offset, 0))
for center, radius, center_text, radius_text in circles:
    axes.add_patch(Circle((center, 0), radius, fill=False, edgecolor=INK, linewidth=1.6, zorder=3))
    box = {"facecolor": "#feecdd", "edgecolor": "none", "pad": 1, "alpha": 0.8}
    label(axes, (center, 0.4 * radius), f"center ({center_text}, 0)", 14, bbox=box)
    label(axes, (center, -0.4 * radius), f"radius {radius_text}", 14, bbox=box)
    dot(axes, (center, 0), 3.0, INK)
for height in (1.1, -1.1):
    label(axes, (0.5, height), "$ABC$ concordant", 24, color="#1a528f",
          bbox={"facecolor": "#e2edf9", "edgecolor": "none"})
for place in (-1.25, 2.25):
    label(axes, (place, 0.75), "discordant", 18, color="#a84a0d", bbox={"facecolor": "#feecdd", "edgecolor": "none"})
for corner, name, offset in ((0, "A", 9), (1, "B", -9)):
    dot(axes, (corner, 0), 6.0, INK)
    label(axes, (corner, 0), f"${name}$", 24, (offset, 56))
axes.axis("on")
axes.set(xticks=[-1, 0, 1, 2], yticks=[-1, 0, 1])
axes.tick_params(labelsize=11.5)
page.save("figure-5-region.png")
if (found != expected).any():
    raise SystemExit("The library and the inequalities disagree.")
