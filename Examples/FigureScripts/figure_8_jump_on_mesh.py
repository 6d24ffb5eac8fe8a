# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The jump of the Jacobian across the edges of a pair of meshes of two drawn faces, in the four systems."""

import numpy
from drawing import INK, SYSTEMS, Coordinates, Page, curves_of, draw_edges, edges_of, fill, map_between, \
    measure_continuity, stroke, strokes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.tri import Triangulation
from vtkmodules.util.numpy_support import vtk_to_numpy

COLORS = LinearSegmentedColormap.from_list(
    "jump", ["#fdf9db", "#f7d085", "#e88a63", "#bb4a6b", "#6e286e", "#25123b"])
NORM = LogNorm(1e-12, 1)

# Landmarks of the first face on the middle line and on the right, and the displacements of those of the second face.
MIDDLE = numpy.array([
    (0, 1.30, 0, 0), (0, -1.24, 0, -0.04), (0, 0.90, 0, 0.02), (0, 0.27, 0, 0), (0, -0.08, 0.05, 0.02),
    (0, -0.27, 0.04, 0.02), (0, -0.57, 0, -0.01), (0, -0.72, 0, -0.06), (0, -1.00, 0, -0.04)])
BESIDE = numpy.array([
    (0.40, 1.21, 0, 0), (0.74, 0.95, 0, 0), (0.94, 0.55, 0, 0), (0.98, 0.10, 0.02, 0), (0.91, -0.35, 0.05, 0),
    (0.74, -0.77, 0.05, 0.02), (0.45, -1.10, 0.02, 0), (0.38, 0.87, 0, 0.03), (0.19, 0.49, 0, 0.07),
    (0.43, 0.57, 0, 0.09), (0.68, 0.47, 0, 0.08), (0.22, 0.24, 0, 0), (0.41, 0.355, 0, 0), (0.61, 0.25, 0, 0.01),
    (0.41, 0.16, 0, 0.04), (0.17, -0.20, 0.03, 0.02), (0.62, -0.16, 0.02, 0.06), (0.58, -0.60, 0.05, 0.04),
    (0.34, -0.62, 0.08, 0.11), (0.14, -0.54, 0.05, 0), (0.15, -0.695, 0.06, -0.02)])


def turn(points):
    """Moves points like the projection of a rotating sphere, and then rotates them in the plane."""
    x, y = points.T
    depth = numpy.maximum(0, 1 - x * x / 1.1 - y * y / 1.9)
    x, y, tilt = x + 0.19 * depth, y + 0.05 * depth, -0.10
    return numpy.column_stack((numpy.cos(tilt) * x - numpy.sin(tilt) * y, numpy.sin(tilt) * x + numpy.cos(tilt) * y))


def curve(points, closed):
    """A smooth curve through points (Catmull-Rom spline)."""
    points = numpy.array(points)
    around = numpy.vstack((points[-1:], points, points[:2]) if closed else (points[:1], points, points[-1:]))
    t = numpy.arange(24)[:, None] / 24
    weights = 0.5 * numpy.hstack((-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, -t**2 + t**3))
    pieces = [weights @ around[i : i + 4] for i in range(len(around) - 3)]
    return numpy.vstack(pieces if closed else pieces + [points[-1:]])


def circle(x, y, radius):
    angle = numpy.linspace(0, 2 * numpy.pi, 49)
    return numpy.column_stack((x + radius * numpy.cos(angle), y + radius * numpy.sin(angle)))


def draw_face(axes, points, triangles, place):
    """The features of the first face, mapped by a function."""
    fill(axes, points[triangles], "#fbe2c9")
    line = "#5c3324"
    for side in (-1, 1):
        mirror = numpy.array([side, 1])
        eye = place(curve(BESIDE[[11, 12, 13, 14], :2] * mirror, True))
        for shape, color in ((place(circle(0.62 * side, -0.27, 0.14)), "#f7c2ad"), (eye, "white"),
                             (place(circle(0.41 * side, 0.258, 0.085)), "#38738c"),
                             (place(circle(0.41 * side, 0.258, 0.042)), "#14141a")):
            fill(axes, [shape], color)
        stroke(axes, numpy.vstack((eye, eye[:1])), line, 1.3)
        stroke(axes, place(curve(BESIDE[[8, 9, 10], :2] * mirror, False)), line, 4.0)
    nose = [(-0.16, -0.17), (-0.13, -0.25), (-0.05, -0.24), (0.0, -0.27), (0.05, -0.24), (0.13, -0.25), (0.16, -0.17)]
    stroke(axes, place(curve(nose, False)), line, 1.6)
    mouth = BESIDE[[18, 19], :2].tolist()
    mouth = [(-x, y) for x, y in mouth] + [(0.0, -0.57), *mouth[::-1], (0.15, -0.695), (0.0, -0.72), (-0.15, -0.695)]
    fill(axes, [place(curve(mouth, True))], "#d45c5c")
    lips = [(-0.34, -0.62), (-0.15, -0.62), (0.0, -0.63), (0.15, -0.62), (0.34, -0.62)]
    stroke(axes, place(curve(lips, False)), "#80242b", 1.3)


def view_of(points):
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.015 * (high - low)[1]
    return (*(low - margin), *(high - low + 2 * margin))


rows = numpy.vstack((MIDDLE, BESIDE, BESIDE * [-1, 1, -1, 1]))
faces = [rows[:, :2], turn(rows[:, :2] + rows[:, 2:])]
cells = Triangulation(*faces[0].T).triangles
smooth = map_between(*faces, cells, "smooth")
page = Page(1552, 505)
page.label(103, 481, "Source and target", 19)
for side, points in enumerate(faces):
    axes = page.panel(8, 8 if side else 236, 190, 222, view_of(points))
    draw_face(axes, points, cells, smooth if side else lambda points: points)
    draw_edges(axes, points, cells, (0.25, 0.35, 0.55, 0.75), 0.8)
edges, counts = edges_of(cells)
discordant = sum(~(Coordinates(faces[0], cells).concordant & Coordinates(faces[1], cells).concordant))
print(f"{'':8} {'triangles':>10} {'discordant':>10} {'least jump':>14} {'largest jump':>14}")
for k, system in enumerate((*SYSTEMS, "cubic")):
    continuity = measure_continuity(*faces, cells, system)
    lines, triangles = continuity.GetOutput(0), continuity.GetOutput(1)
    of_edges, of_triangles = (vtk_to_numpy(d.GetCellData().GetArray("JacobianJump")) for d in (lines, triangles))
    largest = continuity.GetLargestJump()
    print(f"{system.capitalize():8} {len(cells):10} {discordant if system == 'contour' else 0:10} "
          f"{of_edges.min():14.2g} {largest:14.2g}")
    colors = lambda jumps: COLORS(NORM(numpy.clip(numpy.nan_to_num(jumps), 1e-12, 1)))
    left = 212 + 312 * k
    axes = page.panel(left, 36, 304, 424, view_of(faces[0]))
    fill(axes, faces[0][cells], colors(of_triangles))
    # Colored edges between gray ones.
    draw_edges(axes, faces[0], cells, "#9e999e", 3.4)
    strokes(axes, [curve[[0, -1]] for curve in curves_of(lines)], colors(of_edges), 2.0)
    strokes(axes, faces[0][edges[counts == 1]], INK, 2.0)
    page.label(left + 152, 481, system.capitalize(), 22)
    digits, power = f"{largest:.1e}".split("e")
    text = f"{largest:.2f}" if largest >= 0.01 else f"${digits} \\times 10^{{{int(power)}}}$"
    page.label(left + 152, 16, "largest jump " + text, 16)
bar = page.figure.add_axes([1475 / 1552, 60 / 505, 16 / 1552, 380 / 505])
page.figure.colorbar(ScalarMappable(NORM, COLORS), cax=bar, ticks=10.0 ** numpy.arange(-12, 1, 3))
bar.minorticks_off()
page.save("figure-8-jump-on-mesh.png")
