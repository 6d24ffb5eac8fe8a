# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of meshes for tests, computations on them by numpy, and their files, written here or by other libraries."""

import collections
import csv
import io
import json
import os
import pathlib

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARED_DATA = pathlib.Path(os.environ.get("DHM_SHARED_DATA", ROOT.parent / "shared" / "data"))
COLUMNS = ["source_x", "source_y", "target_x", "target_y"]
MASK = "vtkValidPointMask"

Pair = collections.namedtuple("Pair", "source target triangles")


def make_grid(columns, rows, width=1.0, height=1.0):
    """Points of a grid over a rectangle, row by row, and its triangles, counterclockwise."""
    x, y = numpy.meshgrid(numpy.linspace(0, width, columns + 1), numpy.linspace(0, height, rows + 1))
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b, d = a + 1, a + columns + 1
            triangles += [(a, b, d + 1), (a, d + 1, d)]
    return numpy.column_stack((x.ravel(), y.ravel())), numpy.array(triangles)


def make_pair(columns=5, rows=4, move=0.3, seed=1, width=1.0, height=1.0):
    """A grid, and the same with its inner points moved by less than a cell's half."""
    source, triangles = make_grid(columns, rows, width, height)
    cell = numpy.array([width / columns, height / rows])
    inner = ((source > 0) & (source < [width, height])).all(axis=1)
    step = numpy.random.default_rng(seed).uniform(-move, move, source.shape) * cell
    return Pair(source, source + step * inner[:, None], triangles)


def doubled_areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def barycentric(points, mesh, triangles):
    """For each point, a triangle that it is in, and its barycentric coordinates there."""
    a, b, c = (mesh[triangles[:, k]] for k in range(3))
    found = numpy.full(len(points), -1)
    weights = numpy.full((len(points), 3), -numpy.inf)
    for k in range(len(triangles)):
        matrix = numpy.column_stack((b[k] - a[k], c[k] - a[k]))
        uv = numpy.linalg.solve(matrix, (points - a[k]).T).T
        own = numpy.column_stack((1 - uv.sum(axis=1), uv))
        better = own.min(axis=1) > weights.min(axis=1)
        found[better], weights[better] = k, own[better]
    return found, weights


def interpolate(points, pair):
    """The piecewise linear map."""
    found, weights = barycentric(points, pair.source, pair.triangles)
    return (weights[:, :, None] * pair.target[pair.triangles[found]]).sum(axis=1)


def inside_points(pair, count, seed=2):
    """Random points in random triangles of the source."""
    random = numpy.random.default_rng(seed)
    weights = random.dirichlet((1, 1, 1), count)
    corners = pair.source[pair.triangles[random.integers(len(pair.triangles), size=count)]]
    return (weights[:, :, None] * corners).sum(axis=1)


def edges_of(triangles):
    """How many triangles each edge has."""
    return collections.Counter(
        tuple(sorted((t[k], t[(k + 1) % 3]))) for t in numpy.asarray(triangles).tolist() for k in range(3)
    )


def write_json(path, pair, **more):
    document = {
        "file_type": "triangulation_file", "format_version": "1.0",
        "transformed_components": ["horizontal"], "vertices_columns": COLUMNS,
        "triangles_columns": ["idx_vertex1", "idx_vertex2", "idx_vertex3"],
        "vertices": numpy.hstack((pair.source, pair.target)).tolist(), "triangles": pair.triangles.tolist(), **more,
    }
    path.write_text(json.dumps(document, indent=1))


def read_json(path):
    document = json.loads(path.read_text())
    vertices = numpy.array([[v[document["vertices_columns"].index(c)] for c in COLUMNS] for v in document["vertices"]])
    return Pair(vertices[:, :2], vertices[:, 2:], numpy.array(document["triangles"])), document


def in_space(points):
    points = numpy.asarray(points, float)
    return numpy.column_stack((points, numpy.zeros(len(points)))) if points.shape[1] == 2 else points


def write_mesh(path, points, triangles):
    """By meshio, which has nothing to do with VTK's readers and writers."""
    import meshio

    meshio.write_points_cells(path, in_space(points), [("triangle", numpy.asarray(triangles))])


def write_obj(path, points, triangles):
    lines = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in in_space(points).tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in t) + "\n" for t in numpy.asarray(triangles).tolist()]
    path.write_text("# a comment\n" + "".join(lines))


def write_vtk(path, points, triangles, target=None):
    """A legacy file as text."""
    text = f"# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\nPOINTS {len(points)} double\n"
    row = lambda array: "".join(" ".join(map(repr, r)) + "\n" for r in array.tolist())
    text += row(in_space(points)) + f"POLYGONS {len(triangles)} {4 * len(triangles)}\n"
    text += "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles)
    if target is not None:
        text += f"POINT_DATA {len(points)}\nVECTORS Moved double\n" + row(in_space(target))
    path.write_text(text)


def write_csv(path, points, names="x,y"):
    path.write_text(names + "\n" + "".join(",".join(map(repr, p)) + "\n" for p in numpy.asarray(points).tolist()))


def read_csv(text):
    """Columns by name, as numbers."""
    rows = list(csv.DictReader(io.StringIO(text.decode() if isinstance(text, bytes) else text)))
    return {name: numpy.array([float(row[name]) for row in rows]) for name in rows[0]}


def xy(table):
    return numpy.column_stack((table["x"], table["y"]))


def map_points(dhm, files, points, *options):
    """The table that dhm map writes."""
    write_csv(dhm.path("mapped-points.csv"), points, "x,y,z"[: 2 * numpy.shape(points)[1] - 1])
    return read_csv(dhm("map", *options, *files, "mapped-points.csv", "-o", "-").out)
