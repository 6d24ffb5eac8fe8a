# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots of pairs by matplotlib."""

import io

import numpy

from . import meshes
from .arrays import points_of
from .files import import_extra

FORMATS = ("png", "svg", "pdf")
DPI = 100
INVALID, DISCORDANT, DUPLICATE, EDGE = "#d91a1a", "#fabf4d", "#990099", "#33496f"


def new_figure(width, titles, points, rows=1):
    """A figure with a panel of a width in pixels for each title, whose axes include its points; in further rows
    squares. Returns the figure and axes of shape (rows, panels)."""
    import_extra("matplotlib", "Drawing")
    import matplotlib
    from matplotlib.figure import Figure

    matplotlib.rcParams.update({"svg.fonttype": "none", "pdf.fonttype": 42})
    low, high = (numpy.array([limit(p, axis=0) for p in points]) for limit in (numpy.nanmin, numpy.nanmax))
    margin = 0.03 * (high - low).max(axis=1, keepdims=True)
    low, high = low - margin, high + margin + (margin == 0)
    ratio = ((high - low)[:, 1] / (high - low)[:, 0]).max().clip(0.2, 3.0)
    size = numpy.array([len(titles) * width, ratio * width + (rows - 1) * width + 40])
    figure = Figure(figsize=size / DPI, dpi=DPI, layout="constrained")
    axes = figure.subplots(rows, len(titles), squeeze=False, height_ratios=[ratio] + [1] * (rows - 1))
    for panel, title, (x0, y0), (x1, y1) in zip(axes[0], titles, low, high):
        panel.set_title(title, fontsize=12)
        panel.set(xlim=(x0, x1), ylim=(y0, y1))
    for panel in axes.flat:
        panel.set(aspect="equal", xticks=[], yticks=[])
        panel.spines[:].set_color("#cccccc")
    return figure, axes


def flatten(points):
    """The two coordinates with the largest extent."""
    extent = numpy.nanmax(points, axis=0) - numpy.nanmin(points, axis=0)
    return points[:, sorted(numpy.argsort(-extent, kind="stable")[:2])]


def draw_polygons(axes, mesh, points, cells=None, marker=0.0, **style):
    """Draws polygons of a mesh (all by default) with other, finite points. Each also gets a marker of that size, so
    that degenerate ones are seen."""
    from matplotlib.collections import PolyCollection

    ids = meshes.lists_of(mesh.GetPolys())
    shown = [points[ids[cell]] for cell in (range(len(ids)) if cells is None else cells)]
    shown = [polygon for polygon in shown if numpy.isfinite(polygon).all()]
    axes.add_collection(PolyCollection(shown, **style))
    if marker and shown:
        centers = numpy.array([polygon.mean(axis=0) for polygon in shown])
        axes.plot(*centers.T, "o", markersize=marker, markerfacecolor="none", markeredgecolor=style["edgecolors"])


def draw_pair(pair, invalid, discordant):
    """The pair, with invalid triangles, discordant triangles of each mesh and duplicate points of each mesh marked."""
    flat = [flatten(points_of(mesh)) for mesh in pair.meshes]
    figure, axes = new_figure(620, ("Source", "Target"), flat)
    for panel, mesh, points, cells in zip(axes[0], pair.meshes, flat, discordant):
        draw_polygons(panel, mesh, points, cells, facecolors=DISCORDANT, edgecolors=DISCORDANT)
        draw_polygons(panel, mesh, points, facecolors="none", edgecolors=EDGE, linewidths=0.7)
        draw_polygons(panel, mesh, points, invalid, 9, facecolors=INVALID, edgecolors=INVALID, alpha=0.85)
        _, first, counts = numpy.unique(points_of(mesh), axis=0, return_index=True, return_counts=True)
        panel.plot(*points[first[counts > 1]].T, ".", color=DUPLICATE, markersize=7)
    names = ((INVALID, "invalid"), (DISCORDANT, "discordant (no Contour there)"), (DUPLICATE, "duplicate points"))
    marks = [axes[0][0].plot([], [], "o", color=color, label=name)[0] for color, name in names]
    axes[0][0].legend(handles=marks, loc="upper left", bbox_to_anchor=(0, 0), ncol=3, frameon=False, fontsize=10)
    return figure


def save(figure, output):
    with output.writing():
        metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(output.format)
        # Matplotlib prints tracebacks on full disks.
        buffer = io.BytesIO()
        figure.savefig(buffer, format=output.format, dpi=DPI, metadata=metadata)
        output.write_bytes(buffer.getbuffer())
