# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""PROJ's triangulation files ("tinshift"), a format of published coordinate shifts:
https://proj.org/en/stable/specifications/triangulation.html"""

import json
import re
from dataclasses import dataclass, field
from typing import Optional

import numpy

from .files import quote

DEEPEST = 100  # the depth to which arrays and objects may be nested
STRATEGIES = ("none", "nearest_side", "nearest_centroid")
CORNERS = ["idx_vertex1", "idx_vertex2", "idx_vertex3"]


@dataclass
class Shift:
    """The contents of a triangulation file."""

    source: numpy.ndarray  # vertices in the source, of shape (n, 2)
    target: numpy.ndarray  # vertices in the target; equal to the source if the file shifts only heights
    triangles: numpy.ndarray
    heights: dict = field(default_factory=dict)
    """The columns of heights: offset_z, or source_z and target_z."""
    horizontal: bool = True
    fallback: str = "none"
    metadata: dict = field(default_factory=dict)
    """The members of the file in its order, without vertices and triangles."""

    @property
    def offsets(self) -> Optional[numpy.ndarray]:
        """The changes of heights at the vertices, of shape (n,); None if the file does not shift heights."""
        if "target_z" in self.heights:
            return self.heights["target_z"] - self.heights["source_z"]
        return self.heights.get("offset_z")

    def interpolate(self, values, points, cells, inverse=False):
        """Values at the vertices, interpolated linearly at points in triangles, with the formula of PROJ."""
        corners = (self.target if inverse else self.source)[self.triangles[cells]]
        (x1, y1), (x2, y2), (x3, y3) = (corners[:, k].T for k in range(3))
        x, y = points[:, 0] - x3, points[:, 1] - y3
        determinant = (y2 - y3) * (x1 - x3) + (x3 - x2) * (y1 - y3)
        first = ((y2 - y3) * x + (x3 - x2) * y) / determinant
        second = ((y3 - y1) * x + (x1 - x3) * y) / determinant
        weights = numpy.column_stack((first, second, 1 - first - second))
        return numpy.einsum("ij,ij...->i...", weights, values[self.triangles[cells]])

    def nearest(self, points, inverse=False):
        """For each point outside, the triangle that the fallback strategy of the file selects; -1 if there is none.
        Degenerate triangles are skipped, as in PROJ."""
        corners = (self.target if inverse else self.source)[self.triangles]
        ends, centroids = numpy.roll(corners, -1, axis=1), corners.mean(axis=1)
        squared = ((ends - corners) ** 2).sum(axis=2)
        usable = (squared >= 1e-10).all(axis=1)
        result = numpy.full(len(points), -1)
        for i, point in enumerate(points if usable.any() else ()):
            if self.fallback == "nearest_centroid":
                distances = ((point - centroids) ** 2).sum(axis=1)
            else:
                t = ((point - corners) * (ends - corners)).sum(axis=2) / numpy.maximum(squared, 1e-10)
                foot = corners + t.clip(0, 1)[..., None] * (ends - corners)
                # Use exactly the vertex at the ends, so that triangles that share it have equal distances.
                foot = numpy.where((t >= 1)[..., None], ends, foot)
                distances = ((point - foot) ** 2).sum(axis=2).min(axis=1)
            result[i] = numpy.where(usable, distances, numpy.inf).argmin()
        return result

    def complete(self, points, images, cells, inverse=False):
        """Changes the images, of shape (n, 3), of points in triangles `cells` (-1: outside) as PROJ does: shifts
        heights, and maps points outside by the fallback strategy. Returns a mask of these points if there is one."""
        flat, fallback = points[:, :2], None
        if self.fallback != "none":
            outside = numpy.flatnonzero((cells < 0) & numpy.isfinite(flat).all(axis=1))
            cells[outside] = self.nearest(flat[outside], inverse)
            outside = outside[cells[outside] >= 0]
            values = self.source if inverse else self.target
            images[outside, :2] = self.interpolate(values, flat[outside], cells[outside], inverse)
            fallback = numpy.isin(numpy.arange(len(points)), outside).astype(numpy.uint8)
        inside = cells >= 0
        if not self.horizontal:
            images[inside, :2] = flat[inside]
        images[:, 2] = points[:, 2]
        if self.offsets is not None:
            # In both directions, the change depends on the position in the source.
            change = self.interpolate(self.offsets, (images if inverse else points)[inside, :2], cells[inside])
            images[inside, 2] += -change if inverse else change
        return fallback


def _take_columns(file, document, member, names):
    """Columns of an array of rows, as an array of float of shape (rows, names)."""
    rows, columns = (document.pop(name, None) for name in (member, member + "_columns"))
    if not (isinstance(rows, list) and isinstance(columns, list)):
        file.fail(f'it has no arrays "{member}" and "{member}_columns": this is not a triangulation file.')
    missing = [name for name in names if name not in columns]
    if missing:
        file.fail(f'"{member}_columns" has no column "{missing[0]}".')
    chosen = [columns.index(name) for name in names]
    values = []
    try:
        for i, row in enumerate(rows):
            if len(row) != len(columns) or not {type(row[k]) for k in chosen} <= {int, float}:
                raise TypeError
            values.append([float(row[k]) for k in chosen])
    except (TypeError, KeyError, OverflowError):
        file.fail(f"{member}[{i}]: expected {len(columns)} values, numbers as {', '.join(names)}; found {quote(row)}.")
    return numpy.array(values, float).reshape(-1, len(names))


def read(file):
    """The contents of a file of format 1.x. Raises Failure with the line or the member."""
    with open(file.path, encoding="utf-8-sig", errors="replace") as opened:
        text = opened.read()
    # Count brackets outside strings: the depth that Python's parser accepts depends on its version.
    signs = numpy.frombuffer(re.sub(r'"(?:[^"\\]|\\.)*"', "", text).encode(), numpy.uint8)
    steps = numpy.isin(signs, list(b"[{")).astype(int) - numpy.isin(signs, list(b"]}"))
    if numpy.cumsum(steps).max(initial=0) > DEEPEST:
        file.fail("its arrays are nested too deeply for a triangulation file.")
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        file.fail(f"line {error.lineno}, column {error.colno}: {error.msg}.")
    except ValueError as error:
        file.fail(f"{quote(error)}.")
    document = document if isinstance(document, dict) else {}
    fallback = document.get("fallback_strategy", "none")
    components = document.get("transformed_components")
    for member, is_right, expected in (
        ("file_type", document.get("file_type") == "triangulation_file", '"triangulation_file"'),
        ("format_version", str(document.get("format_version")).startswith("1."), "1.x"),
        ("transformed_components", components in (["horizontal"], ["vertical"], ["horizontal", "vertical"],
                                                  ["vertical", "horizontal"]), '"horizontal", "vertical" or both'),
        ("fallback_strategy", fallback in STRATEGIES, f"one of {', '.join(STRATEGIES)}"),
    ):
        if not is_right:
            file.fail(f'this is not a triangulation file: expected {expected} as "{member}", found '
                      f"{quote(json.dumps(document.get(member)))}.")
    horizontal, vertical = (name in components for name in ("horizontal", "vertical"))
    names = ["source_x", "source_y"] + ["target_x", "target_y"] * horizontal
    if vertical:
        has_offset = '"offset_z"' in json.dumps(document.get("vertices_columns"))
        names += ["offset_z"] if has_offset else ["source_z", "target_z"]
    values = _take_columns(file, document, "vertices", names)
    triangles = _take_columns(file, document, "triangles", CORNERS)
    if not len(triangles):
        file.fail("it has no triangles.")
    wrong = ((triangles != numpy.floor(triangles)) | (triangles < 0) | (triangles >= len(values))).any(axis=1)
    if wrong.any():
        file.fail(f"triangles[{wrong.argmax()}]: expected vertex numbers from 0 to {len(values) - 1}, found "
                  f"{triangles[wrong.argmax()].tolist()}.")
    end = 4 if horizontal else 2
    return Shift(values[:, :2], values[:, end - 2 : end], triangles.astype(numpy.int64),
                 dict(zip(names[end:], values[:, end:].T)), horizontal, fallback, document)


def text_of(shift):
    """The text of the file, with one vertex or triangle per line, and with all digits of numbers."""
    columns = dict(zip(("source_x", "source_y"), shift.source.T))
    if shift.horizontal:
        columns.update(zip(("target_x", "target_y"), shift.target.T))
    columns.update(shift.heights)
    document = {"file_type": "triangulation_file", "format_version": "1.0", **shift.metadata}
    document["transformed_components"] = ["horizontal"] * shift.horizontal + ["vertical"] * bool(shift.heights)
    document.update(vertices_columns=list(columns), triangles_columns=CORNERS)
    head = json.dumps(document, indent=2, ensure_ascii=False)
    vertices, triangles = (
        ",\n    ".join(map(json.dumps, array.tolist()))
        for array in (numpy.column_stack(list(columns.values())), shift.triangles)
    )
    return f'{head[:-2]},\n  "vertices": [\n    {vertices}\n  ],\n  "triangles": [\n    {triangles}\n  ]\n}}\n'
