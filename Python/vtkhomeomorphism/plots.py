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


def new_figure(width, titles, limits, rows=1):
    """A figure with a panel of a width in pixels for each title, its axes with the limits (x0, x1, y0, y1); in further
    rows squares. Returns the figure and axes of shape (rows, panels)."""
    import_extra("matplotlib", "Drawing")
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    matplotlib.rcParams.update({"svg.fonttype": "none", "pdf.fonttype": 42})
    ratio = min(max(max((b[3] - b[2]) / (b[1] - b[0]) for b in limits), 0.2), 3.0)
    size = numpy.array([len(titles) * width, ratio * width + (rows - 1) * width + 40])
    figure = Figure(figsize=size / DPI, dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, len(titles), squeeze=False, height_ratios=[ratio] + [1] * (rows - 1))
    for panel, title, bounds in zip(axes[0], titles, limits):
        panel.set_title(title, fontsize=12)
        panel.set(xlim=bounds[:2], ylim=bounds[2:])
    for panel in axes.flat:
        panel.set(aspect="equal", xticks=[], yticks=[])
        panel.spines[:].set_color("#cccccc")
    return figure, axes


def flatten(points):
    """The two coordinates with the largest extent."""
    extent = numpy.nanmax(points, axis=0) - numpy.nanmin(points, axis=0)
    return points[:, sorted(numpy.argsort(-extent, kind="stable")[:2]) if extent[2] > 0 else [0, 1]]


def bounds_of(points, margin=0.03):
    low, high = numpy.nanmin(points, axis=0), numpy.nanmax(points, axis=0)
    pad = margin * (high - low).max() or 1.0
    return low[0] - pad, high[0] + pad, low[1] - pad, high[1] + pad


def polygons_of(mesh, points):
    """The polygons' corners, as arrays of shape (k, 2), by cell."""
    return [points[ids] for ids in meshes.lists_of(mesh.GetPolys())]


def draw_polygons(axes, polygons, marker=0.0, **style):
    """Draws the polygons with finite corners. Each also gets a marker of that size, so that degenerate ones are seen."""
    from matplotlib.collections import PolyCollection

    shown = [polygon for polygon in polygons if numpy.isfinite(polygon).all()]
    axes.add_collection(PolyCollection(shown, **style))
    if marker and shown:
        centers = numpy.array([polygon.mean(axis=0) for polygon in shown])
        axes.plot(*centers.T, "o", markersize=marker, markerfacecolor="none", markeredgecolor=style["edgecolors"])


def draw_pair(pair, invalid, discordant, duplicates):
    """The pair, with invalid triangles, discordant triangles of each mesh and duplicate points of each mesh marked."""
    flat = [flatten(points_of(mesh)) for mesh in pair.meshes]
    figure, axes = new_figure(620, ("Source", "Target"), list(map(bounds_of, flat)))
    for side, points in enumerate(flat):
        panel, polygons = axes[0][side], polygons_of(pair.meshes[side], points)
        draw_polygons(panel, [polygons[i] for i in discordant[side]], facecolors=DISCORDANT, edgecolors=DISCORDANT)
        draw_polygons(panel, polygons, facecolors="none", edgecolors=EDGE, linewidths=0.7)
        draw_polygons(panel, [polygons[i] for i in invalid], 9, facecolors=INVALID, edgecolors=INVALID, alpha=0.85)
        panel.plot(*points[duplicates[side]].T, ".", color=DUPLICATE, markersize=7)
    names = ((INVALID, "invalid"), (DISCORDANT, "discordant (no Contour there)"), (DUPLICATE, "duplicate points"))
    marks = [axes[0][0].plot([], [], "o", color=color, label=name)[0] for color, name in names]
    axes[0][0].legend(handles=marks, loc="upper left", bbox_to_anchor=(0, 0), ncol=3, frameon=False, fontsize=10)
    return figure


def save(figure, output):
    with output:
        buffer = io.BytesIO()
        metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(output.format)
        figure.savefig(buffer, format=output.format, dpi=DPI, metadata=metadata)
        output.write_bytes(buffer.getbuffer())
