# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of xmorph and gtkmorph: grids of quadrilaterals, placed on two photographs by hand. The first row is at the
top, and y points downwards."""

import re

import numpy


def read(path):
    """The points of the grid, of shape (rows, columns, 2). Raises ValueError with the number of the line."""
    with open(path, encoding="utf-8", errors="replace") as text:
        header = re.fullmatch(r"M2\s*\n\s*([1-9]\d{0,3})\s+([1-9]\d{0,3})\b.*\n?", text.readline() + text.readline())
        if not header or "1" in header.groups():
            raise ValueError("expected M2 in line 1, and the numbers of columns and rows, 2 to 9999, in line 2.")
        columns, rows = map(int, header.groups())
        lines = text.readlines()[: columns * rows]
    points = []
    try:
        for line in lines + [""] * (columns * rows - len(lines)):
            x, y = map(float, line.split()[:2])
            points.append((x, y))
    except ValueError:
        raise ValueError(f"line {3 + len(points)}: expected x and y of {columns * rows} points.") from None
    return numpy.array(points).reshape(rows, columns, 2)


def extent(grid):
    """The largest x and y."""
    return grid.reshape(-1, 2).max(axis=0).clip(0)


def fills_picture(grid):
    """Whether the boundary is the rectangle from the origin to the largest x and y, up to one pixel. If so, moves it
    onto that rectangle."""
    end = extent(grid)
    rims = ((grid[0, :, 1], 0), (grid[-1, :, 1], end[1]), (grid[:, 0, 0], 0), (grid[:, -1, 0], end[0]))
    fills = all((numpy.abs(rim - value) <= 0.005 * end.max()).all() for rim, value in rims)
    for rim, value in rims if fills else ():
        rim[:] = value
    return fills


def _smallest_angle(grid, triangles):
    """The smallest angle of each triangle (..., 3) in the grid; negative if it is flipped."""
    corners = grid.reshape(-1, 2)[triangles]
    u, v = numpy.roll(corners, -1, axis=-2) - corners, numpy.roll(corners, -2, axis=-2) - corners
    cross = v[..., 0] * u[..., 1] - v[..., 1] * u[..., 0]
    return numpy.arctan2(cross, (u * v).sum(axis=-1)).min(axis=-1)


def triangulate(first, second):
    """Divides each quadrilateral along the diagonal that gives the larger minimum angle in both grids (y upwards)."""
    if first.shape != second.shape:
        raise ValueError("the two meshes do not have the same numbers of columns and rows.")
    ids = numpy.arange(first[..., 0].size).reshape(first.shape[:2])
    # The corners are a and b, and below them d and c.
    a, b, c, d = (part.ravel() for part in (ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]))
    cuts = [numpy.stack(corners, axis=1).reshape(-1, 2, 3) for corners in ((a, b, c, a, c, d), (a, b, d, b, c, d))]
    along_ac, along_bd = (
        numpy.minimum(_smallest_angle(first, cut), _smallest_angle(second, cut)).min(axis=1) for cut in cuts)
    return numpy.where((along_ac >= along_bd)[:, None, None], *cuts).reshape(-1, 3)
