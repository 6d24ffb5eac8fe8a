# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the curves that StressPairs --curve prints: plot_curves.py FOLDER IMAGE."""

import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import MaxNLocator

# Smallest angles of source and target with a number of added points: Surazhsky and Gotsman,
# "High quality compatible triangulations" (2004).
PUBLISHED = {"letters-U-S": (7, 17.1, 17.6), "outlines-37": (None, 15.9, 15.3)}
NAMES = (*PUBLISHED, "nobeoka-inset", "nobeoka", "fushimi-castle", "tatebayashi-town", "uno-bus", "uno-bus-bent")
SHARES = (("discordant", "1", "-", "discordant, for concordance"), ("obtuse", "1", "--", "obtuse, for concordance"),
          ("obtuse", "3", ":", "obtuse, for no obtuse angles"))


def read(path):
    if not os.path.exists(path):
        return []
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


folder, image = sys.argv[1:3]
curves = {name: read(os.path.join(folder, name + ".csv")) for name in NAMES}
curves = {name: rows for name, rows in curves.items() if rows}
if not curves:
    sys.exit("There is nothing to draw: the shared data is absent.")
columns = (len(curves) + 1) // 2
figure, axes = plt.subplots(4, columns, figsize=(3.6 * columns, 11), squeeze=False, layout="constrained")
for number, (name, rows) in enumerate(curves.items()):
    upper, lower = axes[2 * (number // columns):, number % columns][:2]
    own = [row for row in rows if row["quality"] == "0"]
    points = [int(row["points"]) for row in own]
    for key, label in (("source_angle", "source"), ("target_angle", "target")):
        upper.plot(points, [float(row[key]) for row in own], ".-", ms=4, label=label)
    count, *angles = PUBLISHED.get(name, (None,))
    for angle, color in zip(angles, ("C0", "C1")):
        if count is None:
            upper.axhline(angle, color=color, ls=":", lw=1)
        else:
            upper.plot([count], [angle], "x", color=color)
    upper.set(title=name, ylabel="smallest angle (degrees)", ylim=(0, None))
    for (key, quality, style, label), color in zip(SHARES, ("C2", "C2", "C3")):
        own = [row for row in rows if row["quality"] == quality]
        lower.plot([int(row["points"]) for row in own], [100 * float(row[key]) for row in own], style, marker=".", ms=4,
                   color=color, label=label)
    lower.set(xlabel="added points, at most", ylabel="share of triangles (%)", ylim=(-2, 102))
    for axis in (upper, lower):
        axis.set_xlim(left=0)
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
for axis in axes.flat[len(curves):]:
    if not axis.lines:
        axis.set_axis_off()
axes[0, 0].legend(title="cross, dotted: published", fontsize=7, title_fontsize=7)
axes[1, 0].legend(fontsize=7)
figure.savefig(image, dpi=100)
