# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Workloads: pairs of meshes, points and an image, the same in every run."""

import numpy

# Interior points are displaced by up to this fraction of a square. Then all triangles of any pair are concordant.
JITTER = 0.15


def grid_points(n, seed):
    """The points of n x n unit squares, row by row, with interior points displaced at random."""
    points = numpy.stack(numpy.meshgrid(range(n + 1), range(n + 1)), -1).astype(float)
    offsets = numpy.random.default_rng(seed).uniform(-JITTER, JITTER, points.shape)
    points[1:-1, 1:-1] += offsets[1:-1, 1:-1]
    return points.reshape(-1, 2)


def displaced(points, width):
    """Points of [0, width]^2, moved by up to 3 % of the width, and along the boundary on it."""
    x, y = numpy.pi * points.T / width
    moves = numpy.column_stack([numpy.sin(x) * numpy.sin(2.0 * y), numpy.sin(2.0 * x) * numpy.sin(y)])
    # Sines of multiples of pi are not exactly 0.
    inside = (points > 0.0) & (points < width)
    return points + 0.03 * width * moves * inside.all(axis=1)[:, None]


def delaunay_triangles(points, n):
    """The squares of the grid, each divided along its Delaunay diagonal.

    Peers that triangulate by themselves obtain the same triangles (which is checked). These triangles are
    numbered along the rows, as usual for meshes."""
    corner = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)).ravel()
    a, b, c, d = corner, corner + 1, corner + n + 2, corner + n + 1

    def lifted(i):
        difference = points[i] - points[d]
        return numpy.column_stack([difference, (difference**2).sum(axis=1)])

    d_in_circle_of_abc = numpy.linalg.det(numpy.stack([lifted(a), lifted(b), lifted(c)], axis=1)) > 0
    first = numpy.where(d_in_circle_of_abc[:, None], numpy.column_stack([a, b, d]), numpy.column_stack([a, b, c]))
    second = numpy.where(d_in_circle_of_abc[:, None], numpy.column_stack([b, c, d]), numpy.column_stack([a, c, d]))
    return numpy.stack([first, second], axis=1).reshape(-1, 3)


def grid_mesh(n):
    """n x n squares: source points, target points and triangles."""
    source = grid_points(n, 1)
    return source, grid_points(n, 2), delaunay_triangles(source, n)


def displaced_mesh(n):
    """A grid whose points are moved at random, and the same displaced smoothly."""
    source = grid_points(n, 1)
    return source, displaced(source, n), delaunay_triangles(source, n)


def moved_numbers(count, seed):
    """The numbers from 0 to count, in order, those between moved at random."""
    numbers = numpy.arange(count + 1.0)
    numbers[1:-1] += numpy.random.default_rng(seed).uniform(-JITTER, JITTER, count - 1)
    return numbers


def fan_mesh(n):
    """As many triangles around a point of the square as the grid has."""
    quarter = n * n // 2

    def points(seed, center):
        along = numpy.concatenate([moved_numbers(quarter, seed + k)[:-1] / quarter for k in range(4)])
        side = numpy.arange(4).repeat(quarter)
        rising, falling = along, 1.0 - along
        x = numpy.choose(side, [rising, numpy.ones_like(along), falling, numpy.zeros_like(along)])
        y = numpy.choose(side, [numpy.zeros_like(along), rising, numpy.ones_like(along), falling])
        return n * numpy.column_stack([numpy.append(x, center[0]), numpy.append(y, center[1])])

    i = numpy.arange(4 * quarter)
    triangles = numpy.column_stack([i, numpy.roll(i, -1), numpy.full_like(i, 4 * quarter)])
    return points(1, (0.5, 0.5)), points(11, (0.52, 0.49)), triangles


def sliver_mesh(n):
    """As many triangles as the grid has, each as long as the square is wide."""

    def points(seed):
        y = moved_numbers(n * n, seed) / n
        return numpy.concatenate([numpy.column_stack([numpy.full_like(y, x), y]) for x in (0.0, n)])

    left = numpy.arange(n * n)
    right = left + n * n + 1
    triangles = numpy.concatenate(
        [numpy.column_stack([left, right, right + 1]), numpy.column_stack([left, right + 1, left + 1])])
    return points(1), points(2), triangles


def grid_in_scan_order(n, columns, rows):
    """The centers of the pixels of an image of [0, n] x [0, n]."""
    x, y = numpy.meshgrid((numpy.arange(columns) + 0.5) * n / columns, (numpy.arange(rows) + 0.5) * n / rows)
    return numpy.column_stack([x.ravel(), y.ravel()])


def few_lines(points, columns, lines):
    """Some rows of such a grid, for slow peers."""
    grid = points.reshape(-1, columns, 2)
    return grid[:: max(1, len(grid) // lines)].reshape(-1, 2)


def random_points(n, count):
    return numpy.random.default_rng(11).uniform(0.0, n, (count, 2))


def picture(size):
    """An RGB image of smooth waves."""
    y, x = numpy.mgrid[0:size, 0:size] / size
    channels = []
    for k in range(3):
        waves = numpy.sin(40.0 * x + 9.0 * k) * numpy.cos(31.0 * y - 5.0 * k) + numpy.sin(60.0 * x * y + k)
        channels.append(numpy.uint8(numpy.clip(127.5 + 60.0 * waves, 0, 255)))
    return numpy.stack(channels, axis=-1)


class Workload:
    """A pair of meshes of the square [0, n] x [0, n], scaled, in a folder for the C++ program.

    The meshes are those of mesh(n); see grid_mesh."""

    def __init__(self, folder, n, scale=1.0, mesh=grid_mesh):
        self.folder = folder
        self.width = n * scale
        source, target, self.triangles = mesh(n)
        self.source, self.target = source * scale, target * scale
        self.points = {}
        self.image = None
        folder.mkdir()
        self._write("source.f64", self._in_space(self.source))
        self._write("target.f64", self._in_space(self.target))
        self._write("triangles.i64", self.triangles.astype(numpy.int64))

    def add_points(self, name, points):
        self.points[name] = numpy.ascontiguousarray(points)
        self._write(f"points-{name}.f64", self._in_space(points))

    def set_image(self, image):
        self.image = image
        self._write("image.u8", image)

    def meshes(self, inverse):
        """The points of the mesh that is mapped from and of the mesh that is mapped to."""
        return (self.target, self.source) if inverse else (self.source, self.target)

    @staticmethod
    def _in_space(points):
        return numpy.column_stack([points, numpy.zeros(len(points))])

    def _write(self, name, array):
        array.tofile(self.folder / name)
