# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of landmark pairs: corresponding points of a source and a target domain.

Formats, recognized by their content:

- CSV with the columns source_x, source_y, target_x, target_y and optionally id, or with four
  unnamed columns of numbers in this order (five: an id first);
- control points of QGIS's Georeferencer (``.points``). Its source coordinates have a y axis that
  points up, with 0 at the upper edge of an image; they are returned with y down, in pixels from the
  image's upper left corner. Disabled points are left out;
- IIIF Georeference Annotations (JSON): pixels from the upper left corner, longitude and latitude;
- 2-D landmarks of BigWarp (CSV without a header): moving points are the source. Inactive points and
  points that are set on one side only are left out.
"""

from __future__ import annotations

import csv
import io
import json
import math
import os
from dataclasses import dataclass, field, replace
from typing import List, Optional, Sequence, Tuple

import numpy

_COLUMNS = ("source_x", "source_y", "target_x", "target_y")


class LandmarkFileError(ValueError):
    """A file of landmarks that cannot be understood. The message names file, line and remedy."""


@dataclass
class Landmarks:
    """Corresponding points.

    source, target : array of float64 of shape (n, 2)
    names : the landmarks' identifiers as the file has them (the row's number where it has none)
    left_out : (name, reason) of each landmark that the file lists but that is not used
    image_coordinates : whether source is in pixels with y down
    crs : coordinate reference system of the target as the file states it, or None
    origin : what to add to coordinates in pixels so that 0 is at the edge of an image
    """

    source: numpy.ndarray
    target: numpy.ndarray
    names: List[str]
    left_out: List[Tuple[str, str]] = field(default_factory=list)
    image_coordinates: bool = False
    crs: Optional[str] = None
    origin: float = 0.0

    def without(self, names: Sequence[str]) -> Landmarks:
        """The landmarks except those of the given names, which are left out."""
        unknown = [name for name in names if name not in self.names]
        if unknown:
            raise LandmarkFileError(f"there is no landmark {', '.join(unknown[:5])} to leave out")
        kept = [i for i, name in enumerate(self.names) if name not in names]
        left_out = self.left_out + [(name, "on request") for name in self.names if name in names]
        chosen = [self.names[i] for i in kept]
        return replace(self, source=self.source[kept], target=self.target[kept], names=chosen, left_out=left_out)


def _number(text: str, path: str, line: int, column: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise LandmarkFileError(
            f"{path}, line {line}: {column} is {text.strip()[:40]!r}, not a number"
        ) from None


def _collect(rows, path: str, **facts) -> Landmarks:
    """rows: (name, four numbers, reason to leave the landmark out or None)."""
    used = [(name, values) for name, values, reason in rows if reason is None]
    values = numpy.array([values for _, values in used], float).reshape(-1, 4)
    if len(values) < 3:
        raise LandmarkFileError(f"{path}: {len(values)} usable landmarks; at least 3 are needed")
    return Landmarks(
        values[:, :2].copy(),
        values[:, 2:].copy(),
        [name for name, _ in used],
        [(name, reason) for name, _, reason in rows if reason is not None],
        **facts,
    )


def _finite_or_reason(values: Sequence[float]) -> Optional[str]:
    sides = [all(math.isfinite(v) for v in values[i : i + 2]) for i in (0, 2)]
    if all(sides):
        return None
    return "no position on either side" if not any(sides) else (
        "no position in the source" if not sides[0] else "no position in the target"
    )


def _read_qgis(lines: List[str], path: str) -> Landmarks:
    crs = None
    first = 0
    while first < len(lines) and lines[first].startswith("#"):
        if lines[first].upper().startswith("#CRS:"):
            crs = lines[first][5:].strip() or None
        first += 1
    reader = csv.DictReader(lines[first:])
    names = [name.strip() for name in reader.fieldnames or []]
    reader.fieldnames = names
    # QGIS 2 writes pixelX and pixelY.
    x, y = ("sourceX", "sourceY") if "sourceX" in names else ("pixelX", "pixelY")
    for column in ("mapX", "mapY", x, y):
        if column not in names:
            raise LandmarkFileError(f"{path}, line {first + 1}: the column {column} is missing")
    rows = []
    for record in reader:
        line = first + reader.line_num
        if None in record.values():
            raise LandmarkFileError(f"{path}, line {line}: fewer fields than the header names")
        values = [_number(record[c], path, line, c) for c in (x, y, "mapX", "mapY")]
        values[1] = -values[1]
        disabled = record.get("enable", "1").strip() in ("0", "false")
        reason = "disabled" if disabled else _finite_or_reason(values)
        rows.append((str(len(rows)), values, reason))
    return _collect(rows, path, image_coordinates=True, crs=crs)


def _annotations(document) -> list:
    if isinstance(document, dict):
        if document.get("type") == "AnnotationPage":
            return [a for item in document.get("items", []) for a in _annotations(item)]
        body = document.get("body")
        if isinstance(body, dict) and body.get("type") == "FeatureCollection":
            return [body]
    return []


def _read_iiif(text: str, path: str) -> Landmarks:
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise LandmarkFileError(f"{path}: not valid JSON ({str(error)[:80]})") from None
    maps = _annotations(document)
    if len(maps) != 1:
        raise LandmarkFileError(
            f"{path}: {len(maps)} georeference annotations; a file with exactly one is needed"
        )
    rows = []
    for number, feature in enumerate(maps[0].get("features", [])):
        try:
            properties = feature["properties"]
            pixel = properties.get("resourceCoords", properties.get("pixelCoords"))
            values = [float(v) for v in (*pixel[:2], *feature["geometry"]["coordinates"][:2])]
            if len(values) != 4:
                raise ValueError
        except (KeyError, TypeError, ValueError, AttributeError):
            raise LandmarkFileError(
                f"{path}, feature {number}: resourceCoords and a Point of two coordinates are needed"
            ) from None
        rows.append((str(feature.get("id", number)), values, _finite_or_reason(values)))
    return _collect(rows, path, image_coordinates=True, crs="EPSG:4326")


def _read_bigwarp(lines: List[str], path: str) -> Landmarks:
    rows = []
    reader = csv.reader(lines)
    for record in reader:
        if not record:
            continue
        if len(record) != 6:
            raise LandmarkFileError(
                f"{path}, line {reader.line_num}: {len(record)} fields; 2-D landmarks of BigWarp have 6"
            )
        values = [_number(f, path, reader.line_num, "a coordinate") for f in record[2:]]
        inactive = record[1].strip().lower() != "true"
        # A side that is not set decides first: an inactive point is usually a deliberate choice.
        rows.append((record[0], values, _finite_or_reason(values) or ("inactive" if inactive else None)))
    # Its pixels have their centers at whole numbers.
    return _collect(rows, path, origin=0.5)


def _read_csv(lines: List[str], path: str) -> Landmarks:
    reader = csv.reader(lines)
    records = [(reader.line_num, record) for record in reader if any(f.strip() for f in record)]
    if not records:
        raise LandmarkFileError(f"{path}: no landmarks")
    header = [f.strip().lower() for f in records[0][1]]
    if all(column in header for column in _COLUMNS):
        order = [header.index(column) for column in _COLUMNS]
        name = header.index("id") if "id" in header else None
        records = records[1:]
    elif len(header) in (4, 5):
        order = list(range(len(header) - 4, len(header)))
        name = 0 if len(header) == 5 else None
        try:
            [float(header[i]) for i in order]
        except ValueError:
            raise LandmarkFileError(
                f"{path}, line {records[0][0]}: the columns are {', '.join(header)[:80]}; name them "
                f"{', '.join(_COLUMNS)}"
            ) from None
    else:
        raise LandmarkFileError(
            f"{path}: {len(header)} columns; landmarks need the columns {', '.join(_COLUMNS)}"
        )
    rows = []
    for line, record in records:
        if len(record) != len(header):
            raise LandmarkFileError(
                f"{path}, line {line}: {len(record)} fields where the first line has {len(header)}"
            )
        values = [_number(record[i], path, line, c) for i, c in zip(order, _COLUMNS)]
        label = record[name].strip() if name is not None else str(len(rows))
        rows.append((label, values, _finite_or_reason(values)))
    return _collect(rows, path)


def read_landmarks(path) -> Landmarks:
    """Reads a file of landmark pairs.

    Raises LandmarkFileError where the file is not one of the formats above or has fewer than three
    usable landmarks, and OSError where it cannot be read.
    """
    path = os.fspath(path)
    with open(path, "rb") as file:
        data = file.read()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise LandmarkFileError(f"{path}: not a text file (byte {error.start})") from None
    lines = text.splitlines()
    content = next((line for line in lines if line.strip() and not line.startswith("#")), "")
    if content.lstrip().startswith(("{", "[")):
        return _read_iiif(text, path)
    if "mapX" in content and "mapY" in content:
        return _read_qgis(lines, path)
    first = next(csv.reader(io.StringIO(content)), [])
    if len(first) == 6 and first[1].strip().lower() in ("true", "false"):
        return _read_bigwarp(lines, path)
    return _read_csv(lines, path)


def read_lines(path, names: Sequence[str]) -> List[List[int]]:
    """Reads constraint lines: one polyline a line, as identifiers of landmarks separated by blanks or
    commas. Returns indices into names."""
    path = os.fspath(path)
    index = {name: i for i, name in enumerate(names)}
    lines = []
    with open(path, encoding="utf-8-sig") as file:
        for number, text in enumerate(file, 1):
            ids = text.replace(",", " ").split()
            if not ids or ids[0].startswith("#"):
                continue
            unknown = [i for i in ids if i not in index]
            if unknown:
                raise LandmarkFileError(
                    f"{path}, line {number}: there is no landmark {', '.join(unknown[:5])}"
                )
            if len(ids) < 2:
                raise LandmarkFileError(f"{path}, line {number}: a line needs at least two landmarks")
            lines.append([index[i] for i in ids])
    return lines


def is_landmark_file(path) -> bool:
    """Whether a file name and content are those of landmarks: `.points`, `.csv` with at least four columns, or JSON
    with a georeference annotation."""
    path = os.fspath(path)
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in (".csv", ".json", ".geojson") or not os.path.isfile(path):
        return suffix == ".points"
    with open(path, "rb") as file:
        start = file.read(1 << 20)
    if suffix == ".csv":
        return start.split(b"\n", 1)[0].count(b",") >= 3
    return b"FeatureCollection" in start and any(
        word in start for word in (b"resourceCoords", b"pixelCoords", b"AnnotationPage")
    )
