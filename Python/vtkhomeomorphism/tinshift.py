# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""PROJ's triangulation files ("tinshift"), in which national coordinate shifts are published:
https://proj.org/en/stable/specifications/triangulation.html"""

import json
from dataclasses import dataclass, field
from typing import Optional

import numpy

from .files import quote

STRATEGIES = ("none", "nearest_side", "nearest_centroid")
DEEPEST = 100


class Invalid(Exception):
    """A defect of a file."""


@dataclass
class Shift:
    """The contents of a triangulation file."""

    source: numpy.ndarray
    """Vertices in the source, of shape (n, 2)."""
    target: numpy.ndarray
    """The same in the target; the source's own of a file that shifts heights only."""
    triangles: numpy.ndarray
    offsets: Optional[numpy.ndarray] = None
    """What is added to heights, of shape (n,), if the file shifts them."""
    horizontal: bool = True
    fallback: str = "none"
    metadata: dict = field(default_factory=dict)
    """The file without its vertices and triangles, members in the file's order."""
    columns: dict = field(default_factory=dict)
    """The heights in the file's own columns: offset_z, or source_z and target_z."""

    def weights(self, points, cells, inverse=False):
        """Barycentric coordinates of points in triangles, as PROJ computes them: shape (n, 3)."""
        corners = (self.target if inverse else self.source)[self.triangles[cells]]
        (x1, y1), (x2, y2), (x3, y3) = (corners[:, k].T for k in range(3))
        x, y = points[:, 0], points[:, 1]
        determinant = (y2 - y3) * (x1 - x3) + (x3 - x2) * (y1 - y3)
        first = ((y2 - y3) * (x - x3) + (x3 - x2) * (y - y3)) / determinant
        second = ((y3 - y1) * (x - x3) + (x1 - x3) * (y - y3)) / determinant
        return numpy.column_stack((first, second, 1 - first - second))

    def interpolate(self, values, weights, cells):
        """Values at the vertices, interpolated linearly."""
        corners = values[self.triangles[cells]]
        return numpy.einsum("ij,ij...->i...", weights, corners)

    def nearest(self, points, inverse=False):
        """For each point outside, the triangle that the fallback strategy of the file selects; -1 if there is
        none. Degenerate triangles are skipped, as in PROJ."""
        corners = (self.target if inverse else self.source)[self.triangles]
        squared = ((corners - numpy.roll(corners, -1, axis=1)) ** 2).sum(axis=2)
        usable = (squared >= 1e-10).all(axis=1)
        result = numpy.full(len(points), -1)
        block = max(1, int(2e6 / max(1, len(corners))))
        for begin in range(0, len(points), block):
            some = points[begin : begin + block, None, :]
            if self.fallback == "nearest_centroid":
                distance = ((some - corners.mean(axis=1)) ** 2).sum(axis=2)
            else:
                distance = numpy.full((len(some), len(corners)), numpy.inf)
                for k in range(3):
                    a, b = corners[:, k], corners[:, (k + 1) % 3]
                    with numpy.errstate(divide="ignore", invalid="ignore"):
                        t = ((some - a) * (b - a)).sum(axis=2) / squared[:, k]
                        foot = a + t.clip(0, 1)[..., None] * (b - a)
                    # Exactly the vertex at the ends, so that triangles that share it are equally far.
                    foot = numpy.where((t >= 1)[..., None], b, foot)
                    distance = numpy.fmin(distance, ((some - foot) ** 2).sum(axis=2))
            distance[:, ~usable] = numpy.inf
            distance[numpy.isnan(distance)] = numpy.inf
            found = distance.argmin(axis=1)
            good = numpy.isfinite(distance[numpy.arange(len(found)), found])
            result[begin : begin + block] = numpy.where(good, found, -1)
        return result

    def crs(self, inverse=False, output=True):
        """The coordinate reference system of the domain that is mapped to (or from), or None."""
        return self.metadata.get("output_crs" if output != inverse else "input_crs") or None


def _depth_of(text):
    """The nesting depth of the brackets of a JSON text, outside strings."""
    import re

    depth = deepest = 0
    for match in re.finditer(r'"(?:[^"\\]|\\.)*"|[\[{]|[\]}]', text):
        c = match[0]
        depth += (c in "[{") - (c in "]}")
        deepest = max(deepest, depth)
        if deepest > DEEPEST:
            break
    return deepest


def _table(document, member, names, file_columns):
    """Columns of an array of rows, as a float array of shape (rows, names)."""
    rows = document.get(member)
    if not isinstance(rows, list):
        raise Invalid(f'there is no array "{member}": this is not a triangulation file.')
    for name in names:
        if name not in file_columns:
            raise Invalid(f'"{member}_columns" has no column "{name}".')
    places = [file_columns.index(name) for name in names]
    values = numpy.empty((len(rows), len(names)))
    width = len(file_columns)
    for i, row in enumerate(rows):
        if not isinstance(row, list) or len(row) != width:
            raise Invalid(f"{member}[{i}]: expected {width} values, found {quote(row)}.")
        for k, place in enumerate(places):
            value = row[place]
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise Invalid(f'{member}[{i}]: expected a number as "{names[k]}", found {quote(value)}.')
            try:
                values[i, k] = value
            except OverflowError:
                raise Invalid(f'{member}[{i}]: "{names[k]}" is too large.') from None
    return values


def read(path):
    """Reads a file of format 1.x. Raises Invalid, naming the line or the member."""
    with open(path, "rb") as file:
        text = file.read().decode("utf-8-sig", "replace")
    depth = _depth_of(text)
    if depth > DEEPEST:
        raise Invalid(f"arrays are nested more than {DEEPEST} deep: this is not a triangulation file.")
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        raise Invalid(f"line {error.lineno}, column {error.colno}: {error.msg}.") from None
    except (ValueError, RecursionError) as error:
        raise Invalid(f"{quote(error)}.") from None
    if not isinstance(document, dict) or document.get("file_type") != "triangulation_file":
        kind = document.get("file_type") if isinstance(document, dict) else None
        raise Invalid(
            f'this is not a triangulation file: its "file_type" is {quote(json.dumps(kind))}, '
            'not "triangulation_file".'
        )
    version = document.get("format_version")
    if not isinstance(version, str) or not version.startswith("1."):
        raise Invalid('expected "format_version" 1.x.')
    components = document.get("transformed_components")
    known = ("horizontal", "vertical")
    if not isinstance(components, list) or not components or any(c not in known for c in components):
        raise Invalid('expected "horizontal", "vertical" or both as "transformed_components".')
    fallback = document.get("fallback_strategy", "none")
    if fallback not in STRATEGIES:
        raise Invalid(f'"fallback_strategy" is {quote(json.dumps(fallback))}, not one of {", ".join(STRATEGIES)}.')
    columns = {}
    for member in ("vertices_columns", "triangles_columns"):
        columns[member] = document.get(member)
        if not isinstance(columns[member], list):
            raise Invalid(f'there is no array "{member}": this is not a triangulation file.')
    vertex_columns = columns["vertices_columns"]
    horizontal, vertical = (name in components for name in known)
    names = ["source_x", "source_y"] + ["target_x", "target_y"] * horizontal
    heights = []
    if vertical:
        heights = ["offset_z"] if "offset_z" in vertex_columns else ["source_z", "target_z"]
    values = _table(document, "vertices", names + heights, vertex_columns)
    corners = ["idx_vertex1", "idx_vertex2", "idx_vertex3"]
    triangles = _table(document, "triangles", corners, columns["triangles_columns"])
    wrong = ((triangles != numpy.floor(triangles)) | (triangles < 0) | (triangles >= len(values))).any(axis=1)
    if wrong.any():
        i = int(wrong.argmax())
        raise Invalid(
            f"triangles[{i}]: expected vertex numbers from 0 to {len(values) - 1}, "
            f"found {quote(document['triangles'][i])}."
        )
    source = values[:, :2]
    file_heights = {name: values[:, len(names) + k] for k, name in enumerate(heights)}
    offsets = None
    if vertical:
        offsets = file_heights.get("offset_z")
        if offsets is None:
            offsets = file_heights["target_z"] - file_heights["source_z"]
    for member in ("vertices", "vertices_columns", "triangles", "triangles_columns"):
        del document[member]
    return Shift(
        source=source,
        target=values[:, 2:4] if horizontal else source,
        triangles=triangles.astype(numpy.int64),
        offsets=offsets,
        horizontal=horizontal,
        fallback=fallback,
        metadata=document,
        columns=file_heights,
    )


def text_of(shift):
    """The text of the file, with one vertex or triangle per line and all digits of numbers."""
    document = {"file_type": "triangulation_file", "format_version": "1.0", **shift.metadata}
    document["transformed_components"] = ["horizontal"] * shift.horizontal + ["vertical"] * bool(shift.columns)
    names, values = ["source_x", "source_y"], [shift.source]
    if shift.horizontal:
        names += ["target_x", "target_y"]
        values.append(shift.target)
    for name, column in shift.columns.items():
        names.append(name)
        values.append(column[:, None])
    document["vertices_columns"] = names
    document["triangles_columns"] = ["idx_vertex1", "idx_vertex2", "idx_vertex3"]
    head = json.dumps(document, indent=2, ensure_ascii=False)
    rows = [
        ",\n    ".join(json.dumps(row) for row in array.tolist())
        for array in (numpy.hstack(values), shift.triangles)
    ]
    return f'{head[:-2]},\n  "vertices": [\n    {rows[0]}\n  ],\n  "triangles": [\n    {rows[1]}\n  ]\n}}\n'
