# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of xmorph and gtkmorph: grids of quadrilaterals placed on two photographs by hand. Rows run from the top,
y downwards."""

import numpy

LARGEST = 10000
"""The most columns or rows."""


def read(path):
    """The grid's points, of shape (rows, columns, 2). Raises ValueError, naming the line."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = [line.split()[:2] for line in file.read().split("\n")]

    def numbers(line, kind, expected):
        try:
            first, second = map(kind, lines[line])
            return first, second
        except (ValueError, IndexError):
            raise ValueError(f"line {line + 1}: expected {expected}.") from None

    if lines[0][:1] != ["M2"]:
        raise ValueError("line 1: expected M2, the first line of an xmorph mesh.")
    columns, rows = numbers(1, int, "the numbers of columns and rows")
    if not (2 <= columns <= LARGEST and 2 <= rows <= LARGEST):
        raise ValueError(f"line 2: expected the numbers of columns and rows, 2 to {LARGEST}.")
    points = [numbers(i, float, f"x and y of point {i - 2}") for i in range(2, 2 + columns * rows)]
    return numpy.array(points).reshape(rows, columns, 2)


def extent(grid):
    """The largest x and y."""
    return grid.reshape(-1, 2).max(axis=0).clip(0)


def fills_picture(grid):
    """Whether the boundary is the rectangle from the origin to the largest x and y, up to one pixel."""
    end = extent(grid)
    rims = ((grid[0, :, 1], 0), (grid[-1, :, 1], end[1]), (grid[:, 0, 0], 0), (grid[:, -1, 0], end[0]))
    return all((numpy.abs(rim - value) <= 0.005 * end.max()).all() for rim, value in rims)


def _smallest_angle(grid, triangles):
    """The smallest angle of each triangle (..., 3) in the grid; negative if it is flipped."""
    corners = grid.reshape(-1, 2)[triangles]
    u = numpy.roll(corners, -1, axis=-2) - corners
    v = numpy.roll(corners, -2, axis=-2) - corners
    cross = v[..., 0] * u[..., 1] - v[..., 1] * u[..., 0]
    return numpy.arctan2(cross, (u * v).sum(axis=-1)).min(axis=-1)


def triangulate(first, second):
    """Divides each quadrilateral along the diagonal with the larger smallest angle in both grids (y upwards)."""
    if first.shape != second.shape:
        raise ValueError("the two meshes do not have the same numbers of columns and rows.")
    columns = first.shape[1]
    # The corners a, b and below them d, c.
    a = numpy.arange(first[..., 0].size).reshape(first.shape[:2])[:-1, :-1].ravel()
    b, c, d = a + 1, a + columns + 1, a + columns
    cuts = [numpy.stack(corners, axis=1).reshape(-1, 2, 3) for corners in ((a, b, c, a, c, d), (a, b, d, b, c, d))]
    along_ac, along_bd = (
        numpy.minimum(_smallest_angle(first, cut), _smallest_angle(second, cut)).min(axis=1) for cut in cuts
    )
    return numpy.where((along_ac >= along_bd)[:, None, None], *cuts).reshape(-1, 3)
