# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots of pairs, drawn by matplotlib."""

import io

import numpy

from . import meshes
from .arrays import points_of

FORMATS = ("png", "svg", "pdf")
DPI = 100
INVALID, DISCORDANT, DUPLICATE, EDGE = "#d91a1a", "#fabf4d", "#990099", "#33496f"


def new_figure(width, titles, points, rows=1):
    """A figure, and axes of shape (rows, titles), each about `width` pixels wide. Those of the first row fit the
    points, of shape (n, 2); those of further rows are square."""
    import matplotlib.figure

    matplotlib.rcParams.update({"svg.fonttype": "none", "pdf.fonttype": 42})
    extents = numpy.nanmax(points, axis=0) - numpy.nanmin(points, axis=0) + 1e-300
    ratio = float((extents[1] / extents[0]).clip(0.2, 3.0))
    size = len(titles) * width / DPI, (ratio + rows - 1) * width / DPI
    figure = matplotlib.figure.Figure(size, dpi=DPI, layout="compressed")
    axes = figure.subplots(rows, len(titles), squeeze=False, height_ratios=[ratio] + [1] * (rows - 1))
    for panel, title in zip(axes[0], titles):
        panel.set_title(title, fontsize=12)
    for panel in axes.flat:
        panel.set(aspect="equal", xticks=[], yticks=[], xmargin=0.03, ymargin=0.03)
        panel.spines[:].set_color("#cccccc")
    return figure, axes


def flatten(points):
    """The two coordinates with the largest extent."""
    extents = numpy.nanmax(points, axis=0) - numpy.nanmin(points, axis=0)
    return points[:, sorted(numpy.argsort(-extents, kind="stable")[:2])]


def draw_polygons(axes, mesh, points, cells=None, **style):
    """Draws polygons of a mesh (all by default) with the given points, and returns their centers. Skips polygons with
    points that are not finite."""
    from matplotlib.collections import PolyCollection

    ids = meshes.lists_of(mesh.GetPolys())
    shown = [points[ids[cell]] for cell in (range(len(ids)) if cells is None else cells)]
    shown = [polygon for polygon in shown if numpy.isfinite(polygon).all()]
    axes.add_collection(PolyCollection(shown, **style))
    axes.autoscale_view()
    return numpy.array([polygon.mean(axis=0) for polygon in shown]).reshape(-1, 2)


def draw_pair(pair, invalid, discordant):
    """The pair, with invalid triangles, discordant triangles of each mesh and duplicate points of each mesh marked."""
    both = [flatten(points_of(mesh)) for mesh in pair.meshes]
    figure, axes = new_figure(620, ("Source", "Target"), both[1])
    for panel, mesh, flat, cells in zip(axes[0], pair.meshes, both, discordant):
        draw_polygons(panel, mesh, flat, cells, facecolors=DISCORDANT, edgecolors=DISCORDANT)
        draw_polygons(panel, mesh, flat, facecolors="none", edgecolors=EDGE, linewidths=0.7)
        centers = draw_polygons(panel, mesh, flat, invalid, facecolors=INVALID, edgecolors=INVALID, alpha=0.85)
        # Circles make degenerate triangles visible.
        panel.plot(*centers.T, "o", markersize=9, markerfacecolor="none", markeredgecolor=INVALID)
        _, first, counts = numpy.unique(points_of(mesh), axis=0, return_index=True, return_counts=True)
        panel.plot(*flat[first[counts > 1]].T, ".", color=DUPLICATE, markersize=7)
    names = ((INVALID, "invalid"), (DISCORDANT, "discordant (no Contour there)"), (DUPLICATE, "duplicate points"))
    marks = [axes[0][0].plot([], [], "o", color=color, label=name)[0] for color, name in names]
    axes[0][0].legend(handles=marks, loc="upper left", bbox_to_anchor=(0, 0), ncol=3, frameon=False, fontsize=10)
    return figure


def save(figure, output):
    with output.writing():
        metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(output.format)
        # Writing to memory first avoids the various failures of matplotlib on full disks.
        buffer = io.BytesIO()
        figure.savefig(buffer, format=output.format, dpi=DPI, metadata=metadata, bbox_inches="tight")
        output.write_bytes(buffer.getbuffer())
