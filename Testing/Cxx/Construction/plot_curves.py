#SPDX - FileCopyrightText : Copyright(c) The Differentiable Homeomorphism authors
#SPDX - License - Identifier : BSD - 3 - Clause
"""Draws the curves that StressPairs --curve measures: plot_curves.py FOLDER IMAGE."""

import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

#Smallest angles of source and target with a number of added points : Surazhsky and Gotsman,
#"High quality compatible triangulations"(2004).
PUBLISHED = {"letters-U-S": (7, 17.1, 17.6), "outlines-37": (None, 15.9, 15.3)}
QUALITIES = ("smallest angle", "concordance", "no obtuse angles")

folder, image = sys.argv[1:3]
names = [name for name in PUBLISHED if os.path.getsize(os.path.join(folder, name + ".csv")) > 100]
if not names:
    sys.exit("There is nothing to draw: the shared data is absent.")
figure, axes = plt.subplots(2, len(names), figsize=(5.5 * len(names), 7), squeeze=False)
for column, name in enumerate(names):
    with open(os.path.join(folder, name + ".csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    upper, lower = axes[:, column]
    own = [row for row in rows if row["quality"] == "0"]
    points = [int(row["points"]) for row in own]
    for key, label in (("source_angle", "source"), ("target_angle", "target")):
        upper.plot(points, [float(row[key]) for row in own], ".-", label=label)
    count, *angles = PUBLISHED[name]
    for angle, color in zip(angles, ("C0", "C1")):
        if count is None:
            upper.axhline(angle, color=color, ls=":", lw=1)
        else:
            upper.plot([count], [angle], "x", color=color)
    upper.set(title=name, xlabel="added points", ylabel="smallest angle (degrees)", ylim=(0, None))
    upper.legend(title="cross, dotted: published", fontsize=8)
    for quality, color in ((1, "C2"), (3, "C3")):
        own = [row for row in rows if row["quality"] == str(quality)]
        points = [int(row["points"]) for row in own]
        for key, style in (("discordant", "-"), ("obtuse", "--")):
            lower.plot(points, [100 * float(row[key]) for row in own], style, color=color,
                       label=f"{key}, for {QUALITIES[min(quality, 2)]}")
    if not lower.lines or not any(len(line.get_xdata()) for line in lower.lines):
        lower.set_axis_off()
        continue
    lower.set(xlabel="added points", ylabel="share of triangles (%)", ylim=(-2, 102))
    lower.legend(fontsize=8)
figure.tight_layout()
figure.savefig(image, dpi=110)
