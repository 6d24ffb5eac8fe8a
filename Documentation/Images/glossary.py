#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Draws glossary.png for Documentation/glossary.md.

    glossary.py [FILE]
"""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

BLACK, ORANGE, GREEN, BLUE, GRAY = "#222222", "#c8601a", "#2e8540", "#1b6ca8", "#888888"


def contour(h, b, s, samples=40):
    """Contour s of a half edge: foot of the center segment (0, 0), center (0, h), corner (b, 0)."""
    wing = numpy.array([b * s, 0.5 * h * (1 - s)])
    straight = numpy.array([[0.0, h], wing])
    if s in (0.0, 1.0):
        return numpy.vstack([straight[:1], [[b * s, 0.0]]])
    o = b * s - h * h * (1 - s * s) / (4 * b * s)
    r = numpy.hypot(*(wing - [o, 0.0]))
    angles = numpy.linspace(numpy.arctan2(wing[1], wing[0] - o), 0.0, samples)
    return numpy.vstack([straight, numpy.c_[o + r * numpy.cos(angles), r * numpy.sin(angles)]])


def triangle_with_guides(axis, corners, contours):
    """The center segments of a triangle and, if it is concordant, its wing segments and contours."""
    center = corners.mean(axis=0)
    axis.fill(*corners.T, facecolor="#fbfbf7", edgecolor=BLACK, linewidth=1.8)
    for k in range(3):
        start, end = corners[(k + 1) % 3], corners[(k + 2) % 3]
        length = numpy.hypot(*(end - start))
        tangent = (end - start) / length
        along = (center - start) @ tangent
        foot = start + along * tangent
        h = numpy.hypot(*(center - foot))
        normal = (center - foot) / h
        outside = not 0.0 < along < length
        if outside:
            nearer = start if along <= 0.0 else end
            axis.plot(*numpy.array([nearer, foot]).T, ":", color=GRAY, linewidth=1.2)
        axis.plot(*numpy.array([center, foot]).T, color=ORANGE, linewidth=1.6, linestyle="--" if outside else "-")
        axis.plot(*foot, "o", color=ORANGE, markersize=4)
        if not contours:
            continue
        for side, b in ((1.0, length - along), (-1.0, along)):
            for s in numpy.linspace(0.0, 1.0, 6)[1:-1]:
                curve = contour(h, b, s)
                curve = foot + side * curve[:, :1] * tangent + curve[:, 1:] * normal
                axis.plot(*curve.T, color=BLUE, linewidth=1.0)
            corner = foot + side * b * tangent
            axis.plot(*numpy.array([0.5 * (center + foot), corner]).T, color=GREEN, linewidth=1.4)
    axis.plot(*center, "o", color=BLACK, markersize=5)


def strip(corners, samples=60):
    """Outline of the strip of the edge opposite corner 0, for the width tau = 1."""
    t = numpy.linspace(0.0, 1.0, samples)
    # l0 = q = l1 l2 / (l1 + l2) with l1 + l2 = 1 - l0 and l1 = t (l1 + l2).
    q = t * (1 - t) / (1 + t * (1 - t))
    l1, l2 = t * (1 - q), (1 - t) * (1 - q)
    return q[:, None] * corners[0] + l1[:, None] * corners[1] + l2[:, None] * corners[2]


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).with_name("glossary.png")
    figure, axes = plt.subplots(1, 3, figsize=(12.6, 4.3))
    for axis in axes:
        axis.set_aspect("equal")
        axis.axis("off")

    axes[0].set_title("concordant triangle", fontsize=11)
    triangle_with_guides(axes[0], numpy.array([[0.0, 0.0], [4.0, 0.3], [1.6, 3.4]]), True)
    for label, color, point, text in (("center segment", ORANGE, (2.52, 1.74), (2.6, 3.1)),
                                      ("wing segment", GREEN, (2.95, 1.09), (3.15, 2.35)),
                                      ("contour", BLUE, (1.2, 2.05), (-0.75, 2.6))):
        axes[0].annotate(label, point, text, color=color, fontsize=10,
                         arrowprops={"arrowstyle": "-", "color": color, "linewidth": 0.8})

    axes[1].set_title("discordant triangle", fontsize=11)
    triangle_with_guides(axes[1], numpy.array([[0.0, 0.0], [2.0, 0.0], [4.4, 2.1]]), False)
    axes[1].annotate("foot outside the edge", (2.15, 0.0), (2.5, -0.5), color=ORANGE, fontsize=10,
                     arrowprops={"arrowstyle": "-", "color": ORANGE, "linewidth": 0.8})

    axes[2].set_title("twin triangles and the strip of their edge", fontsize=11)
    upper = numpy.array([[1.3, 2.2], [0.0, 0.0], [4.0, 0.0]])
    lower = numpy.array([[2.6, -1.5], [0.0, 0.0], [4.0, 0.0]])
    for corners in (upper, lower):
        axes[2].fill(*corners.T, facecolor="#fbfbf7", edgecolor=BLACK, linewidth=1.8)
        axes[2].fill(*strip(corners).T, facecolor="#cfe3f1", edgecolor=BLUE, linewidth=1.0)
    axes[2].plot([0.0, 4.0], [0.0, 0.0], color=BLACK, linewidth=1.8)
    axes[2].text(1.45, 1.25, "triangle", fontsize=10, ha="center")
    axes[2].text(2.55, -1.05, "twin", fontsize=10, ha="center")
    axes[2].text(2.0, 0.2, "strip", fontsize=10, color=BLUE, ha="center")

    figure.tight_layout()
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
