# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots of pairs by matplotlib."""

import io

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from . import meshes
from .files import import_extra

FORMATS = ("png", "svg", "pdf")
DPI = 100
INVALID, DISCORDANT, DUPLICATE, EDGE = "#d91a1a", "#fabf4d", "#990099", "#33496f"


def new_figure(width, height):
    """A figure of a size in pixels, with text stored as text."""
    import_extra("matplotlib", "python3-matplotlib", "Drawing")
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    matplotlib.rcParams.update({"svg.fonttype": "none", "pdf.fonttype": 42})
    figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI)
    FigureCanvasAgg(figure)
    return figure


def add_panel(figure, box, title, bounds):
    """Axes at a box (left, bottom, width, height in pixels) that show bounds (x0, x1, y0, y1)."""
    width, height = figure.get_size_inches() * DPI
    axes = figure.add_axes([box[0] / width, box[1] / height, box[2] / width, box[3] / height])
    axes.set_aspect("equal")
    axes.set(xlim=bounds[:2], ylim=bounds[2:], xticks=[], yticks=[])
    axes.set_title(title, fontsize=12, pad=5)
    for spine in axes.spines.values():
        spine.set_edgecolor("#cccccc")
    return axes


def flatten(points):
    """The two coordinates with the largest extent. Non-finite points are moved to the middle."""
    finite = numpy.isfinite(points).all(axis=1)
    low, high = points[finite].min(axis=0), points[finite].max(axis=0)
    extent = high - low
    kept = sorted(numpy.argsort(-extent, kind="stable")[:2]) if extent[2] > 0 else [0, 1]
    flat = numpy.where(finite[:, None], points, (low + high) / 2)
    return flat[:, kept], finite


def bounds_of(points, margin=0.03):
    low, high = points.min(axis=0), points.max(axis=0)
    pad = margin * (high - low).max() or 1.0
    return low[0] - pad, high[0] + pad, low[1] - pad, high[1] + pad


def polygons_of(mesh, points, finite=None):
    """The polygons' corners, as arrays of shape (k, 2), by cell."""
    cells = mesh.GetPolys()
    offsets, ids = (vtk_to_numpy(a) for a in (cells.GetOffsetsArray(), cells.GetConnectivityArray()))
    result = numpy.split(points[ids], offsets[1:-1])
    if finite is not None and not finite.all():
        shown = [good.all() for good in numpy.split(finite[ids], offsets[1:-1])]
        result = [polygon if show else polygon[:0] for polygon, show in zip(result, shown)]
    return result


def draw_edges(axes, polygons, color=EDGE, width=0.7, **options):
    from matplotlib.collections import PolyCollection

    axes.add_collection(
        PolyCollection([p for p in polygons if len(p)], facecolors="none", edgecolors=color, linewidths=width, **options)
    )


def draw_cells(axes, polygons, ids, color, marker=0.0):
    """Fills polygons. Each also gets a marker of that size, so that degenerate polygons are visible."""
    from matplotlib.collections import PolyCollection

    chosen = [polygons[i] for i in ids if i < len(polygons) and len(polygons[i])]
    axes.add_collection(PolyCollection(chosen, facecolors=color, edgecolors=color, linewidths=0.8, alpha=0.85))
    if marker and chosen:
        centers = numpy.array([polygon.mean(axis=0) for polygon in chosen])
        axes.plot(*centers.T, "o", markersize=marker, markerfacecolor="none", markeredgecolor=color, linestyle="none")


def draw_pair(pair, invalid, discordant, duplicates):
    """The pair, with invalid triangles, discordant triangles of each mesh and duplicate points of each mesh marked."""
    panel, gap, title, legend = 620, 10, 34, 34
    flat = [flatten(meshes.points_of(mesh)) for mesh in pair.meshes]
    bounds = [bounds_of(points) for points, _ in flat]
    height = panel * min(max(max((b[3] - b[2]) / (b[1] - b[0]) for b in bounds), 0.3), 2.0)
    figure = new_figure(2 * panel + 3 * gap, title + height + legend)
    for side, (points, finite) in enumerate(flat):
        box = (gap + side * (panel + gap), legend, panel, height)
        axes = add_panel(figure, box, ("Source", "Target")[side], bounds[side])
        polygons = polygons_of(pair.meshes[side], points, finite)
        draw_cells(axes, polygons, discordant[side], DISCORDANT)
        draw_edges(axes, polygons)
        draw_cells(axes, polygons, invalid, INVALID, marker=9)
        axes.plot(*points[duplicates[side]].T, ".", color=DUPLICATE, markersize=7, linestyle="none")
    from matplotlib.lines import Line2D

    names = (("invalid", INVALID), ("discordant (no Contour there)", DISCORDANT), ("duplicate points", DUPLICATE))
    marks = [Line2D([], [], marker="o", linestyle="none", color=color, label=name) for name, color in names]
    figure.legend(handles=marks, loc="lower left", ncol=3, frameon=False, fontsize=10)
    return figure


def save(figure, output):
    with output as place:
        metadata = {"Date": None} if place.format == "svg" else {"CreationDate": None} if place.format == "pdf" else None
        buffer = io.BytesIO()
        figure.savefig(buffer, format=place.format, dpi=DPI, metadata=metadata)
        place.write_bytes(buffer.getbuffer())
