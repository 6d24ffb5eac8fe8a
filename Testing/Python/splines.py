# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the Cubic map with the least-bending Clough-Tocher interpolant (matplotlib's CubicTriInterpolator,
kind="min_E") of the same pairs. Prints the table of Documentation/cubic.md. Fails if a Cubic map is not certified."""

import pathlib
import sys
import time

import numpy
import scipy.sparse.linalg
from matplotlib.tri import CubicTriInterpolator, LinearTriInterpolator, Triangulation
from pairs import SHARED_DATA, Pair, doubled_areas, edges_of, make_grid
from vtkhomeomorphism import Homeomorphism, xmorph
from vtkhomeomorphism.isomorphic import isomorphic_triangulation

FACES = pathlib.Path("/usr/share/xmorph/example/AD")
SAMPLES = 20000


def random_pair(strength, cells=11, seed=1):
    """A jittered grid; the target's inner points are convex combinations of their neighbors, weights
    exp(strength * normal): an embedding (Tutte, Floater)."""
    random = numpy.random.default_rng(seed)
    source, triangles = make_grid(cells, cells)
    inner = ((source > 0) & (source < 1)).all(axis=1)
    source = source + inner[:, None] * random.uniform(-0.3, 0.3, source.shape) / cells
    edges = numpy.array(list(edges_of(triangles)))
    matrix = scipy.sparse.lil_matrix((len(source), len(source)))
    for i, j in numpy.vstack((edges, edges[:, ::-1])):
        if inner[i]:
            matrix[i, j] = numpy.exp(strength * random.normal())
    sums = numpy.asarray(matrix.sum(axis=1)).ravel()
    system = scipy.sparse.diags(numpy.where(inner, sums, 1)) - matrix
    right = numpy.where(inner[:, None], 0, source)
    return Pair(source, scipy.sparse.linalg.spsolve(system.tocsc(), right), triangles)


def faces():
    grids = [xmorph.read(FACES / f"image{k}.png.mesh") for k in (1, 2)]
    grids = [grid / xmorph.extent(grid) for grid in grids]
    return Pair(*(grid.reshape(-1, 2) for grid in grids), xmorph.triangulate(*grids))


def historical(name):
    table = numpy.genfromtxt(SHARED_DATA / "landmarks" / f"{name}.csv", delimiter=",", names=True)
    source = numpy.column_stack((table["source_x"], -table["source_y"]))
    made = isomorphic_triangulation(source, numpy.column_stack((table["target_x"], table["target_y"])))
    return Pair(made.source, made.target, made.triangles)


def normalized(pair):
    """Both meshes centered, with a mean edge length of 1; counterclockwise."""
    edges = numpy.array(list(edges_of(pair.triangles)))
    source, target = ((points - points.mean(axis=0)) / numpy.linalg.norm(
        points[edges[:, 0]] - points[edges[:, 1]], axis=1).mean() for points in (pair.source, pair.target))
    turned = doubled_areas(source, pair.triangles)[:, None] < 0
    triangles = numpy.where(turned, pair.triangles[:, ::-1], pair.triangles)
    return Pair(source, target, triangles)


def second_differences(f, pair, h=0.1):
    """Root mean square of the Hessian norm at a tenth of an edge, over the area of the source."""
    random = numpy.random.default_rng(3)
    areas = doubled_areas(pair.source, pair.triangles)
    corners = pair.source[pair.triangles[random.choice(len(areas), SAMPLES, p=areas / areas.sum())]]
    points = (random.dirichlet((1, 1, 1), SAMPLES)[:, :, None] * corners).sum(axis=1)
    middle = f(points)
    seconds = []
    for angle in (0, numpy.pi / 3, 2 * numpy.pi / 3):
        step = h * numpy.array([numpy.cos(angle), numpy.sin(angle)])
        seconds.append((f(points + step) + f(points - step) - 2 * middle) / h**2)
    xx, yy = seconds[0], (2 * (seconds[1] + seconds[2]) - seconds[0]) / 3
    xy = (seconds[1] - seconds[2]) / numpy.sqrt(3)
    return numpy.sqrt(numpy.nanmean((xx**2 + 2 * xy**2 + yy**2).sum(axis=1)))


def folded_share(interpolators, pair):
    """Of the source's area, where the spline's determinant has not the sign of the triangles'."""
    random = numpy.random.default_rng(4)
    areas = doubled_areas(pair.source, pair.triangles)
    corners = pair.source[pair.triangles[random.choice(len(areas), SAMPLES, p=areas / areas.sum())]]
    points = (random.dirichlet((1, 1, 1), SAMPLES)[:, :, None] * corners).sum(axis=1)
    rows = [interpolator.gradient(*points.T) for interpolator in interpolators]
    determinant = rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]
    return numpy.mean(numpy.sign(doubled_areas(pair.target, pair.triangles))[0] * determinant.filled(1) <= 0)


def spline_of(pair, kind):
    mesh = Triangulation(*pair.source.T, pair.triangles)
    if kind == "linear":
        interpolators = [LinearTriInterpolator(mesh, values) for values in pair.target.T]
    else:
        interpolators = [CubicTriInterpolator(mesh, values, kind="min_E") for values in pair.target.T]
    return interpolators, lambda p: numpy.column_stack([i(*p.T).filled(numpy.nan) for i in interpolators])


def cubic_of(pair, refinement):
    map = Homeomorphism(*pair, "cubic", fairness_refinement=refinement)
    certified = map._filter.GetNumberOfUncertifiedTriangles() == 0
    return map, certified, map._filter.GetNumberOfCutTriangles()


def main(names):
    pairs = {}
    if FACES.is_dir():
        pairs["faces"] = faces
    if (SHARED_DATA / "landmarks").is_dir():
        maps = ("fushimi-castle", "tatebayashi-town", "nobeoka")
        pairs |= {name: lambda name=name: historical(name) for name in maps}
    pairs |= {f"random, {s}": lambda s=s: random_pair(s) for s in (0.5, 1.2, 2.0, 3.0)}
    print("| pair | triangles | Linear | Smooth | spline | LEAST | LEAST, refined once | spline folds "
          "| LEAST / spline | refined / Linear | cut, of refined | seconds: spline, LEAST, refined |")
    print("|---" * 12 + "|")
    failed = False
    for name, make in pairs.items():
        if names and name.split(",")[0] not in names:
            continue
        pair = normalized(make())
        linear = second_differences(spline_of(pair, "linear")[1], pair)
        smooth = second_differences(Homeomorphism(*pair, "smooth"), pair)
        start = time.perf_counter()
        interpolators, f = spline_of(pair, "cubic")
        seconds = [time.perf_counter() - start]
        spline = second_differences(f, pair)
        bending, cut = [], 0
        for refinement in (0, 1):
            start = time.perf_counter()
            map, certified, cut = cubic_of(pair, refinement)
            seconds.append(time.perf_counter() - start)
            failed |= not certified
            bending.append(second_differences(map, pair))
        print(f"| {name} | {len(pair.triangles)} | {linear:.2f} | {smooth:.2f} | {spline:.2f} | {bending[0]:.2f} | "
              f"{bending[1]:.2f} | {100 * folded_share(interpolators, pair):.1f} % | {bending[0] / spline:.2f} | "
              f"{bending[1] / linear:.2f} | {cut} of {4 * len(pair.triangles)} | "
              f"{', '.join(f'{s:.2f}' for s in seconds)} |", flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
