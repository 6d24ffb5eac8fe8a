# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Common code of the figures: pages in pixels, triangulations as arrays, coordinate lines and maps."""

import os
import sys

import numpy
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from vtkmodules.util.numpy_support import vtk_to_numpy

from vtkhomeomorphism import Homeomorphism, vtkJacobianContinuity, vtkTriangularCoordinates
from vtkhomeomorphism.arrays import configure, make_mesh, points_of, update
from vtkhomeomorphism.meshes import lists_of

INK = "#212329"
SYSTEMS = ("linear", "contour", "smooth")
CONTOUR, RING, CENTER, WING = "#2166ab", "#d97321", "#cc5c14", "#29854d"


class Page:
    """A figure with a size in pixels, y upwards."""

    def __init__(self, width, height):
        self.figure = Figure(figsize=(width / 100, height / 100), dpi=100)
        FigureCanvasAgg(self.figure)
        self.width, self.height = width, height

    def panel(self, left, bottom, width, height, view, stretch=False):
        """Axes without ticks that show a view (left, bottom, width, height)."""
        axes = self.figure.add_axes([left / self.width, bottom / self.height, width / self.width, height / self.height])
        axes.set(xlim=(view[0], view[0] + view[2]), ylim=(view[1], view[1] + view[3]))
        axes.set_aspect("auto" if stretch else "equal")
        axes.axis("off")
        return axes

    def label(self, x, y, text, size, **options):
        """Draws text centered at a point of the page; sizes are in pixels."""
        options = {"ha": "center", "va": "center", "color": INK, **options}
        self.figure.text(x / self.width, y / self.height, text, fontsize=0.72 * size, **options)

    def save(self, name):
        folder = sys.argv[1] if len(sys.argv) > 1 else "."
        os.makedirs(folder, exist_ok=True)
        self.figure.savefig(os.path.join(folder, name), dpi=100, metadata={"Software": None})


def label(axes, point, text, size, offset=(0, 0), **options):
    """Draws text beside a point of a panel; `size` and `offset` are in pixels."""
    options = {"ha": "center", "va": "center", "color": INK, **options}
    axes.annotate(text, point, xytext=0.72 * numpy.array(offset, float), textcoords="offset points",
                  fontsize=0.72 * size, annotation_clip=False, **options)


def stroke(axes, points, color, width, **options):
    axes.plot(*numpy.transpose(points), color=color, linewidth=0.72 * width, solid_capstyle="round", **options)


def strokes(axes, curves, color, width):
    axes.add_collection(LineCollection(curves, colors=color, linewidths=0.72 * width, capstyle="round", zorder=2))


def fill(axes, polygons, color, edge="none", **options):
    axes.add_collection(PolyCollection(polygons, facecolors=color, edgecolors=edge, zorder=1, **options))


def dot(axes, point, radius, color, edge=None, width=0.0):
    axes.plot(*point, "o", markersize=1.44 * radius, markerfacecolor=color, markeredgecolor=edge or color,
              markeredgewidth=0.72 * width, zorder=4, clip_on=True)


def right_angle(axes, corner, first, second, size, color, width):
    """Draws the symbol of a right angle at a corner, between the directions to two points; `size` is in units of the
    panel."""
    corner, first, second = (numpy.asarray(p, float) for p in (corner, first, second))
    u, v = ((p - corner) * size / numpy.linalg.norm(p - corner) for p in (first, second))
    stroke(axes, [corner + u, corner + u + v, corner + v], color, width)


def edges_of(triangles):
    """The edges, each one once, and the numbers of their triangles."""
    edges = numpy.sort(numpy.vstack([numpy.take(triangles, [k, (k + 1) % 3], axis=1) for k in range(3)]), axis=1)
    return numpy.unique(edges, axis=0, return_counts=True)


def draw_edges(axes, points, triangles, color, width):
    strokes(axes, numpy.asarray(points, float)[edges_of(triangles)[0]], color, width)


def close_up(axes, page, box, center, half_width, half_height):
    """A panel that shows a part of another panel, in which this part is marked."""
    x, y = center
    corners = numpy.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]) * (half_width, half_height)
    stroke(axes, corners + center, INK, 1.2, linestyle=(0, (4, 3)))
    result = page.panel(*box, (x - half_width, y - half_height, 2 * half_width, 2 * half_height))
    result.plot([0, 1, 1, 0, 0], [0, 0, 1, 1, 0], color=INK, linewidth=0.9, clip_on=False, transform=result.transAxes)
    return result


def curves_of(data, values=None):
    """The polylines of a data set, as arrays of points, or of other values at the points."""
    values = points_of(data)[:, :2] if values is None else values
    return [values[ids] for ids in lists_of(data.GetLines())]


class Coordinates:
    """The triangular coordinates of a triangulation: lines by type and triangle, and the concordant triangles."""

    def __init__(self, points, triangles, system="contour", contours=1, rings=1, center="centroid"):
        self.filter = vtkTriangularCoordinates()
        self.filter.SetInputData(make_mesh(numpy.asarray(points, float), numpy.asarray(triangles)))
        configure(self.filter, system, center=center, discordant_by_linear=True)
        self.filter.SetNumberOfContours(contours)
        self.filter.SetNumberOfRings(rings)
        self.filter.SetLineResolution(64)
        update(self.filter)
        self.concordant = vtk_to_numpy(self.filter.GetTriangulation().GetCellData().GetArray("Concordant")) != 0
        lines = self.filter.GetLines()
        self.types = vtk_to_numpy(lines.GetCellData().GetArray("LineType"))
        self.triangles = vtk_to_numpy(lines.GetCellData().GetArray("TriangleId"))
        self.curves = numpy.array([*curves_of(lines), None], object)[:-1]

    def lines(self, kind, triangle=None):
        """Curves of a type, such as "RING_LINE"."""
        chosen = self.types == getattr(vtkTriangularCoordinates, kind)
        return list(self.curves[chosen if triangle is None else chosen & (self.triangles == triangle)])


def measure_continuity(source, target, triangles, system, samples=5):
    """An updated vtkJacobianContinuity of a map."""
    continuity = vtkJacobianContinuity()
    continuity.SetSourceData(make_mesh(source, triangles))
    continuity.SetTargetData(make_mesh(target, triangles))
    configure(continuity, system, discordant_by_linear=True)
    continuity.SetSamplesPerEdge(samples)
    update(continuity)
    return continuity


def map_between(source, target, triangles, system):
    return Homeomorphism(source, target, numpy.asarray(triangles), system, discordant_by_linear=True)


def cross(points, triangles, start, end):
    """The points where a segment crosses the edges of a triangulation, in order: an array for each piece of the segment
    that is inside."""
    edges, counts = edges_of(triangles)
    along = numpy.subtract(end, start)
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    p, q = (along[0] * y - along[1] * x for x, y in ((a - start).T, (b - start).T))
    hit = numpy.flatnonzero((p > 0) != (q > 0))
    where = a[hit] + (p[hit] / (p[hit] - q[hit]))[:, None] * (b[hit] - a[hit])
    t = (where - start) @ along / (along @ along)
    pieces, piece = [], []
    for i in numpy.argsort(t)[((t < 0).sum()) : (t <= 1).sum()]:
        piece.append(where[i])
        if counts[hit[i]] == 1 and len(piece) > 1:
            pieces.append(numpy.array(piece))
            piece = []
    return pieces
