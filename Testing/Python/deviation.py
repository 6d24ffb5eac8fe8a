# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the distance of the differentiable maps from the piecewise linear one if MaximumDeviation limits it. As a
program, prints the table of Documentation/cubic.md; test_deviation.py runs a part of it."""

import sys

import numpy
import scipy.spatial
from pairs import SHARED_DATA, Pair, doubled_areas, read_json
from vtkhomeomorphism import Homeomorphism

MAPS = {"SMOOTH": ("smooth", {}), "CUBIC, LOCAL": ("cubic", {"cubic_bending": "local"}),
        "CUBIC, LEAST": ("cubic", {"cubic_bending": "least"})}


def make_network(points=300, size=100e3, noise=0.05, seed=4):
    """A generated national network: coordinates of seven digits, a smooth shift of meters, noise of centimeters, and a
    point beside the middle of every tenth edge, which makes needles with aspect ratios of more than 1000:1."""
    random = numpy.random.default_rng(seed)
    source = random.uniform(0, size, (points, 2))
    edges = scipy.spatial.Delaunay(source).simplices[::10, :2]
    ends = source[edges]
    along = ends[:, 1] - ends[:, 0]
    source = numpy.vstack((source, ends.mean(axis=1) + 1e-3 * along @ [[0, 1], [-1, 0]]))
    triangles = scipy.spatial.Delaunay(source).simplices
    triangles = numpy.where(doubled_areas(source, triangles)[:, None] > 0, triangles, triangles[:, ::-1])
    wave = 2 * numpy.pi * source / size
    shift = 5 * numpy.column_stack((numpy.sin(wave[:, 1]), numpy.cos(wave[:, 0])))
    target = source + shift + random.uniform(-noise, noise, source.shape)
    edge = numpy.linalg.norm(source[triangles] - source[numpy.roll(triangles, 1, axis=1)], axis=2).max(axis=1)
    height = [doubled_areas(mesh, triangles) / edge for mesh in (source, target)]
    triangles = triangles[(numpy.minimum(*height) > 1e-5 * edge)]
    offset = numpy.array([3.2e6, 6.8e6])
    return Pair(source + offset, target + offset, triangles)


def sample(pair, count, seed=5):
    """Points in every triangle, many beside edges and vertices, and their images under the piecewise linear map."""
    random = numpy.random.default_rng(seed)
    found = numpy.arange(count) % len(pair.triangles)
    weights = numpy.vstack([random.dirichlet((a, a, a), len(part))
                            for a, part in zip((1, 0.3, 0.05), numpy.array_split(found, 3))])
    corners = pair.triangles[found]
    return [(weights[:, :, None] * points[corners]).sum(axis=1) for points in (pair.source, pair.target)]


def measure(pair, name, limit, count):
    """The map, and its greatest distance from the piecewise linear one."""
    system, options = MAPS[name]
    map = Homeomorphism(pair.source, pair.target, pair.triangles, system, maximum_deviation=limit, **options)
    points, linear = sample(pair, count)
    return map, numpy.linalg.norm(map(points) - linear, axis=1)


def rounding(pair):
    """Of a coordinate of the target, a few times."""
    return 4 * numpy.spacing(numpy.abs(pair.target).max())


def main(count):
    networks = [("generated network", make_network(), (0.01, 0.001))]
    files = [("needle_shift", SHARED_DATA / "cases" / "needle_shift.json", (0.05, 0.001)),
             ("Finland", SHARED_DATA / "fi_nls_ykj_etrs35fin.json", (0.01, 0.001))]
    for name, path, limits in files:
        if path.is_file():
            networks.append((name, read_json(path)[0], limits))
        else:
            print(f"{path} is not there", file=sys.stderr)
    print("| pair | triangles | map | without a limit | with a limit of | deviation |\n|---|---|---|---|---|---|")
    failed = False
    for name, pair, limits in networks:
        for map_name in MAPS:
            free = measure(pair, map_name, None, count)[1].max()
            for limit in limits:
                strays = measure(pair, map_name, limit, count)[1].max()
                failed |= not strays <= limit + rounding(pair)
                print(f"| {name} | {len(pair.triangles)} | {map_name} | {free:.3g} | {limit} | {strays:.3g} |",
                      flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main(int(float(sys.argv[1])) if len(sys.argv) > 1 else 10**6))
