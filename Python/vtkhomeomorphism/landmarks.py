# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Landmarks, that is, corresponding points of a source and a target domain: their files, and pairs of meshes made from
them.

Formats, recognized by their content:

- CSV with the columns source_x, source_y, target_x, target_y and optionally id, or with four unnamed columns of numbers
  in this order (with five, the first one is an id);
- control points of QGIS's Georeferencer (``.points``), whose y axis points upwards from 0 at the upper edge of an
  image. They are returned in pixels from the upper left corner, with y downwards. Disabled points are left out;
- IIIF Georeference Annotations (JSON): pixels from the upper left corner, longitude and latitude;
- 2-D landmarks of BigWarp (CSV without a header): moving points are the source. Inactive points, and points that are
  set on only one side, are left out.
"""

from __future__ import annotations

import collections
import contextlib
import csv
import functools
import io
import json
import os
import re
from dataclasses import dataclass, field, replace
from typing import List, Optional, Sequence, Tuple

import numpy

from .files import FILE, Failure, count, inform, join, quote, quote_message
from .isomorphic import isomorphic_triangulation, rectangle, within
from .tables import number_of, records

_COLUMNS = ("source_x", "source_y", "target_x", "target_y")


class LandmarkFileError(ValueError):
    """A file of landmarks is invalid. The message names the file, the line and the remedy."""


@dataclass
class Landmarks:
    """Corresponding points, of shape (n, 2)."""

    source: numpy.ndarray
    target: numpy.ndarray
    names: List[str]  # ids of the file; without ids, the number of the line (of the feature in JSON), from 1
    left_out: List[Tuple[str, str]] = field(default_factory=list)  # name and reason of landmarks that are not used
    image_coordinates: bool = False  # whether the source is in pixels with y downwards
    crs: Optional[str] = None  # the target's coordinate reference system, as stated by the file
    origin: float = 0.0  # the number to add to coordinates in pixels so that 0 is at the edge of an image

    def without(self, names: Sequence[str]) -> Landmarks:
        """The landmarks without those of the given names. Raises LandmarkFileError for unknown names."""
        unknown = set(names) - {*self.names, *(name for name, _ in self.left_out)}
        if unknown:
            raise LandmarkFileError(f"there is no landmark {', '.join(sorted(unknown)[:5])} to leave out")
        kept = [i for i, name in enumerate(self.names) if name not in names]
        left_out = self.left_out + [(name, "on request") for name in self.names if name in names]
        return replace(self, source=self.source[kept], target=self.target[kept], names=[self.names[i] for i in kept],
                       left_out=left_out)


def _collect(rows, path: str, **facts) -> Landmarks:
    """The landmarks of `rows`: name, four numbers, and the reason to leave the landmark out, or None."""
    used, left_out = [], []
    for name, row, reason in rows:
        missing = [side for side, k in (("source", 0), ("target", 2)) if not numpy.isfinite(row[k : k + 2]).all()]
        reason = f"no position in the {' and the '.join(missing)}" if missing else reason
        (left_out if reason else used).append((name, reason or row))
    if len(used) < 3:
        raise LandmarkFileError(f"{path}: {count(len(used), 'usable landmark')}; at least 3 are needed")
    values = numpy.array([row for _, row in used], float)
    return Landmarks(values[:, :2].copy(), values[:, 2:].copy(), [name for name, _ in used], left_out, **facts)


def _read_table(lines: List[str], path: str, columns: Sequence[str], header: Sequence[str] = ()):
    """The rows of a table, for _collect. If no header is given, it is the first row."""
    first, result = next((line for line in lines if line.strip()), ""), []
    try:
        for line, record in records(lines, next((s for s in ";\t" if first.count(s) >= 3), ",")):
            where, record = f"{path}, line {line}", list(map(str.strip, record))
            if not header:
                header = record
                missing = [name for name in columns if name not in header]
                if missing:
                    raise LandmarkFileError(f"{where}: the column {missing[0]} is missing")
                continue
            if len(record) != len(header):
                raise LandmarkFileError(f"{where}: {len(record)} fields, where {len(header)} are expected")
            fields = dict(zip(header, record))
            values = [number_of(fields[name] or "nan") for name in columns]
            if None in values:
                name = columns[values.index(None)]
                hint = " (write 0.5, not 0,5)" if "," in fields[name] else ""
                raise LandmarkFileError(f"{where}: {name} is {fields[name][:40]!r}, not a number{hint}")
            reason = None if fields.get("enable", "1").lower() in ("1", "true") else "disabled"
            result.append((fields.get("id", str(line)), values, reason))
    except csv.Error as error:
        raise LandmarkFileError(f"{path}: {error}") from None
    return result


def _read_qgis(lines: List[str], path: str) -> Landmarks:
    crs = [line[5:].strip() for line in lines if line.upper().startswith("#CRS:")]
    lines = ["" if line.startswith("#") else line for line in lines]
    # In QGIS 2, the columns are pixelX and pixelY.
    names = ("sourceX", "sourceY") if any("sourceX" in line for line in lines) else ("pixelX", "pixelY")
    rows = [(name, [u, -v, x, y], reason)
            for name, (u, v, x, y), reason in _read_table(lines, path, (*names, "mapX", "mapY"))]
    return _collect(rows, path, image_coordinates=True, crs=crs[0] if crs and crs[0] else None)


def _read_iiif(text: str, path: str) -> Landmarks:
    def find(document):
        document = document if isinstance(document, dict) else {}
        if document.get("type") == "AnnotationPage":
            return [found for item in document.get("items", []) for found in find(item)]
        body = document.get("body")
        return [body] if isinstance(body, dict) and body.get("type") == "FeatureCollection" else []

    try:
        maps = find(json.loads(text))
    except (ValueError, RecursionError) as error:
        raise LandmarkFileError(f"{path}: not valid JSON ({str(error)[:80]})") from None
    if len(maps) != 1:
        raise LandmarkFileError(f"{path}: {len(maps)} georeference annotations; a file with exactly one is needed")
    rows = []
    for number, feature in enumerate(maps[0].get("features", []), 1):
        try:
            pixel = feature["properties"].get("resourceCoords") or feature["properties"]["pixelCoords"]
            u, v, x, y = (float(c) for c in (*pixel[:2], *feature["geometry"]["coordinates"][:2]))
        except (KeyError, TypeError, ValueError, AttributeError):
            needed = "resourceCoords and a Point of two coordinates are needed"
            raise LandmarkFileError(f"{path}, feature {number}: {needed}") from None
        rows.append((str(feature.get("id", number)), [u, v, x, y], None))
    return _collect(rows, path, image_coordinates=True, crs="EPSG:4326")


def _read_csv(lines: List[str], path: str) -> Landmarks:
    lines = ["\n" if line.startswith("#") else line for line in lines]
    start = next(i for i, line in enumerate(lines) if line.strip())
    first = [name.strip().lower() for name in re.split("[,;\t]", lines[start].replace('"', ""))]
    if len(first) == 6 and first[1] in ("true", "false"):
        # The format of BigWarp, where pixels have their centers at integers.
        return _collect(_read_table(lines, path, _COLUMNS, ("id", "enable", *_COLUMNS)), path, origin=0.5)
    if all(column in first for column in _COLUMNS):
        header, lines = first, lines[:start] + [""] + lines[start + 1 :]
    elif len(first) in (4, 5) and all(number_of(name) is not None for name in first[-4:]):
        header = ("id", *_COLUMNS)[-len(first) :]
    else:
        found = f"{count(len(first), 'column')} ({', '.join(first)[:80]})"
        raise LandmarkFileError(f"{path}, line {start + 1}: {found}; landmarks need the columns {', '.join(_COLUMNS)}")
    return _collect(_read_table(lines, path, _COLUMNS, header), path)


def _read_text(path) -> str:
    """The text of a file in UTF-8, otherwise in Latin-1, which older programs use."""
    with open(path, "rb") as file:
        data = file.read()
    if b"\0" in data:
        raise LandmarkFileError(f"{path}: not a text file in UTF-8 (byte {data.index(bytes(1))})")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return io.StringIO(text, newline=None).read()


def read_landmarks(path) -> Landmarks:
    """Reads a file of landmarks. Raises LandmarkFileError if the file does not have one of the formats above or has
    fewer than three usable landmarks, and OSError if it cannot be read."""
    text = _read_text(path)
    content = next((line for line in text.splitlines() if line.strip() and not line.startswith("#")), "")
    if not content:
        raise LandmarkFileError(f"{path}: no landmarks")
    if content.lstrip().startswith(("{", "[")):
        return _read_iiif(text, path)
    reader = _read_qgis if "mapX" in content and "mapY" in content else _read_csv
    return reader(text.splitlines(keepends=True), path)


def read_lines(path, names: Sequence[str]) -> List[List[int]]:
    """Reads constraint lines: one polygonal line per row, as ids of landmarks separated by blanks or commas. Returns
    indices into names."""
    index, lines = {name: i for i, name in enumerate(names)}, []
    for number, text in enumerate(_read_text(path).splitlines(), 1):
        ids = text.replace(",", " ").split()
        if not ids or ids[0].startswith("#"):
            continue
        unknown = [i for i in ids if i not in index]
        if unknown or len(ids) < 2:
            what = f"there is no landmark {', '.join(unknown[:5])}" if unknown else "a line needs two landmarks"
            raise LandmarkFileError(f"{path}, line {number}: {what}")
        lines.append([index[i] for i in ids])
    return lines


def is_landmark_file(path) -> bool:
    """Whether a file is one of landmarks: `.points`, `.csv` with at least four columns, or JSON with a georeference
    annotation."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in (".csv", ".json", ".geojson") or not os.path.isfile(path):
        return suffix == ".points"
    with open(path, "rb") as file:
        start = file.read(1 << 20)
    if suffix == ".csv":
        lines = start.lstrip(b"\xef\xbb\xbf").splitlines()
        first = next((line for line in lines if line.strip() and not line.startswith(b"#")), b"")
        return max(map(first.count, (b",", b";", b"\t"))) >= 3
    words = (b"resourceCoords", b"pixelCoords", b"AnnotationPage")
    return b"FeatureCollection" in start and any(word in start for word in words)


def read(file, options) -> Landmarks:
    """The landmarks of an input of dhm, without those of --without, in the coordinate reference system of --crs."""
    try:
        marks = read_landmarks(file.path).without([name for name in options.without.split(",") if name])
    except LandmarkFileError as error:
        raise Failure(f"{quote_message(error, file)}.", FILE) from None
    twice = [name for name, number in collections.Counter(marks.names).items() if number > 1]
    if twice:
        inform(f"{file.name}: several landmarks have the same id: {join(twice)}.")
    if marks.left_out:
        names = join([f"{name} ({reason})" for name, reason in marks.left_out])
        inform(f"{file.name}: {count(len(marks.left_out), 'landmark')} left out: {names}.")
    if options.crs and marks.crs and options.crs != marks.crs:
        import rasterio.warp

        try:
            known = rasterio.CRS.from_user_input(marks.crs)
        except ValueError:
            inform(f"{file.name}: the coordinate reference system in the line #CRS: {quote(marks.crs)} is not known; "
                   f"{options.crs} (--crs) is used instead.")
            return replace(marks, crs=options.crs)
        try:
            target = rasterio.warp.transform(known, options.crs, *marks.target.T)
        except Exception as error:
            raise Failure(f"Cannot transform the landmarks from {marks.crs} to {options.crs}: {error}", FILE) from None
        marks = replace(marks, target=numpy.column_stack(target))
    return replace(marks, crs=options.crs or marks.crs)


def _frame(grid, points):
    """The smallest and largest coordinates of the centers of pixels, so that borders are mapped to borders, and of
    landmarks outside them."""
    points = numpy.vstack((points, numpy.reshape(grid.hanging().bounds, (2, 2)).T))
    return points.min(axis=0), points.max(axis=0)


def _between_images(points, grids, more):
    """The pair whose domains are the rectangles of the images. Landmarks within a pixel of the same border in both
    images are moved onto it. Other landmarks close to a border would make thin triangles there. In this case, the
    domains extend beyond the borders by half the landmarks' spacing, and have points along their boundaries."""
    frames = [_frame(grid, p) for grid, p in zip(grids, points)]
    snapped = points
    for end in (0, 1):
        near = numpy.all([numpy.abs(p - frame[end]) <= numpy.abs(grid.steps).sum(axis=1)
                          for p, frame, grid in zip(points, frames, grids)], axis=0)
        snapped = [numpy.where(near, frame[end], p) for p, frame in zip(snapped, frames)]
    spacings = [numpy.sqrt((high - low).prod() / len(points[0])) for low, high in frames]
    gaps = [numpy.minimum(p - low, high - p).min(axis=1) for p, (low, high) in zip(snapped, frames)]
    close = (gaps[0] < 0.1 * spacings[0]) | (gaps[1] < 0.1 * spacings[1])
    wider = [(low - 0.5 * s, high + 0.5 * s) for s, (low, high) in zip(spacings, frames)]
    if not close[(gaps[0] != 0) | (gaps[1] != 0)].any():
        # This fails if landmarks are on different borders in the two images.
        with contextlib.suppress(ValueError):
            return isomorphic_triangulation(*snapped, frame=[numpy.column_stack(f).ravel() for f in frames], **more)
    make = functools.partial(isomorphic_triangulation, **more)
    residuals = make(*points, frame=[numpy.column_stack(f).ravel() for f in wider]).residuals
    rims = [rectangle(*frame, 1 + int(0.5 * len(points[0]) ** 0.5)) for frame in wider]
    return within(*points, rims, make)._replace(residuals=residuals)


def triangulate(marks, name, grids, **more):
    """The IsomorphicTriangulation of landmarks in images with given pixel grids (None: not in an image). Prints a
    summary."""
    points = [marks.source, marks.target]
    for side, grid in enumerate(grids):
        if grid or (side == 0 and marks.image_coordinates):
            points[side] = (points[side] + (marks.origin if grid else 0)) * [1, -1]
    try:
        more["names"] = marks.names
        if not grids[0] or more.get("outlines") or more.get("domain") not in (None, "automatic", "frame"):
            made = isomorphic_triangulation(*points, **more)
        elif grids[1]:
            made = _between_images(points, grids, more)
        else:
            frame = numpy.column_stack(_frame(grids[0], points[0])).ravel()
            made = isomorphic_triangulation(*points, frame=(frame, None), **more)
    except ValueError as error:
        raise Failure(f"{name}: {error}") from None
    angles, worst = made.report["smallest_angles"], made.suspicious()
    inform(f"{name}: made {count(len(made.triangles), 'triangle')} from {count(len(marks.names), 'landmark')}, "
           f"with {count(made.added_points, 'added point')}; the smallest angles are {angles[0]:.3g} and "
           f"{angles[1]:.3g} degrees.")
    if min(angles) < 1e-3:
        inform(f"{name}: with such thin triangles, Cubic takes minutes; --system smooth (check: --quick) is fast.")
    if len(worst):
        listed = ", ".join(f"{marks.names[i]} ({made.residuals[i]:.4g})" for i in worst)
        inform(f"{name}: suspicious landmarks, and their distances in the target from the predictions by their "
               f"neighbors: {listed}; the median is {numpy.median(made.residuals):.3g}. Leave out wrong landmarks by "
               "--without and their ids (line numbers in a file without ids).")
    for cell, reason in made.left_out:
        inform(f"{name}: line {cell} is left out: {reason}")
    return made
