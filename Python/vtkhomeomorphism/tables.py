# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of points as text. All fields keep their text, to the last digit, except changed coordinates."""

import csv
import itertools
import math
import re

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkStringArray

from .files import USAGE, Failure, quote

USUAL_NAMES = [
    names.split()
    for names in (
        "x y z, x y, e n, easting northing, east north, x_coord y_coord z_coord, x_coord y_coord, xcoord ycoord, "
        "x_coordinate y_coordinate, point_x point_y, rechtswert hochwert, rechts hoch, ostwert nordwert, ost nord, "
        "longitude latitude, long lat, lon lat, lng lat"
    ).split(", ")
]
"""What coordinates are called; the first that a table has are taken."""
HEIGHT_NAMES = ("z", "h", "height", "altitude", "alt", "elevation", "elev", "hoehe", "höhe")
_QUOTED_OR_TAB = re.compile(r'("(?:[^"]|"")*")|\t')


def _number(text):
    """A number, or None. Excludes notations that only Python accepts."""
    try:
        value = float(text)
    except ValueError:
        return None
    if "_" in text or (math.isinf(value) and "inf" not in text.lower()):
        return None
    return value


def _simple(name):
    return name.strip().lower()


class Table:
    """A table of points.

    columns : text
        Names or numbers (from 1) of the coordinate columns, separated by commas; empty: those with usual names.
    with_height : bool
        Whether a third coordinate may be a column with the usual name of a height.
    """

    def __init__(self, input, columns="", with_height=False):
        self._input = input
        with open(input.path, encoding="utf-8-sig", errors="surrogateescape", newline="") as file:
            lines = iter(file)
            self.comments = []
            skipped = 0
            first = ""
            for first in lines:
                skipped += 1
                if first.startswith("#"):
                    self.comments.append(first.rstrip("\r\n"))
                elif first.strip():
                    break
                first = ""
            counts = {c: first.count(c) for c in ",;\t"}
            self.separator = max(counts, key=counts.get) if any(counts.values()) else " "
            lines = itertools.chain([first] if first else [], lines)
            if self.separator == " ":
                # Tabs are separators too, except within quotes.
                lines = (_QUOTED_OR_TAB.sub(lambda m: m[1] or " ", line).strip() + "\n" for line in lines)
            reader = csv.reader(lines, delimiter=self.separator, skipinitialspace=self.separator == " ", strict=True)
            self.rows, numbers = [], []
            begin = skipped
            try:
                for row in reader:
                    if row and (len(row) > 1 or row[0].strip()):
                        self.rows.append(row)
                        numbers.append(begin)
                    begin = skipped + reader.line_num
            except csv.Error as error:
                input.fail(f"line {begin}: {error}.")
        if not self.rows:
            input.fail("it has no points.")
        width = len(self.rows[0])
        for row, number in zip(self.rows, numbers):
            if len(row) != width:
                input.fail(f"line {number}: {len(row)} columns, but the first line has {width}.")
        self._choose(columns, with_height)
        self._header(numbers, bool(columns))
        if not self.rows:
            input.fail("it has no points.")
        self.coordinates = numpy.empty((len(self.rows), len(self.columns)))
        for k, column in enumerate(self.columns):
            texts = [row[column] for row in self.rows]
            try:
                values = numpy.array(list(map(float, texts)))
                suspicious = numpy.isinf(values).any() or any("_" in text for text in texts)
            except ValueError:
                suspicious = True
            if suspicious:
                values = [_number(text) for text in texts]
                if None in values:
                    self._fail_at(values.index(None), numbers, column)
            self.coordinates[:, k] = values

    def _choose(self, columns, with_height):
        first = self.rows[0]
        self.names = None
        if columns:
            self._choose_named(columns)
            return
        for names in USUAL_NAMES:
            found = [self._find(name) for name in names]
            if None not in found:
                self.columns, self.names = found, first
                break
        else:
            if len(first) < 2:
                self._input.fail("it has only one column: points need two coordinates.")
            self.columns = [0, 1] + [2] * (with_height and len(first) > 2 and _number(first[2]) is not None)
        if with_height and self.names and len(self.columns) == 2:
            self.columns += [place for place in map(self._find, HEIGHT_NAMES) if place is not None][:1]

    def _find(self, name):
        """The column with a name. Names may differ in case only."""
        first = self.rows[0]
        if name in first:
            return first.index(name)
        simple = [_simple(field) for field in first]
        return simple.index(_simple(name)) if _simple(name) in simple else None

    def _choose_named(self, columns):
        first, self.columns = self.rows[0], []
        for name in columns.split(","):
            # A number is not a name: in a table without names it may be a coordinate.
            is_number = re.fullmatch(r"\s*\d+\s*", name)
            place = int(name) - 1 if is_number else self._find(name)
            if place is None or not 0 <= place < len(first):
                raise Failure(
                    f'{self._input.name} has no column "{name}" (--columns): its first line has '
                    f"{len(first)} columns, {self._list()}.",
                    USAGE,
                )
            if place in self.columns:
                raise Failure(f'Two coordinates cannot come from the same column, "{name}" (--columns).', USAGE)
            self.columns.append(place)
            if not is_number:
                self.names = first
        if len(self.columns) not in (2, 3):
            raise Failure("Two or three coordinate columns are needed (--columns).", USAGE)

    def _header(self, numbers, chosen):
        first = self.rows[0]
        if self.names is None and None in [_number(first[column]) for column in self.columns[:2]]:
            if self._has_decimal_commas(first):
                self._fail_at(0, numbers, self.columns[0])
            if all(_number(first[column]) is None for column in self.columns):
                if not chosen:
                    self._input.fail(
                        f"none of its columns ({self._list()}) has a name that is usual for coordinates, such as x "
                        "and y: name them (--columns)."
                    )
                self.names = first
        if self.names is not None:
            del self.rows[0], numbers[0]

    def _list(self):
        first = self.rows[0]
        return quote(", ".join(f'"{name}"' for name in first[:20]) + (", ..." if len(first) > 20 else ""), 300)

    def _has_decimal_commas(self, row):
        if self.separator != ",":
            return any("," in field and _number(field.replace(",", ".", 1)) is not None for field in row)
        # If the separator was guessed wrong, one field contains two numbers.
        parts = [re.split("[; \t]", field.strip("; \t"), 1) for field in row]
        return any(len(part) == 2 and None not in map(_number, part) for part in parts)

    def _fail_at(self, row, numbers, column):
        if self._has_decimal_commas(self.rows[row]):
            self._input.fail(
                f"line {numbers[row]}: its numbers have decimal commas: write them with points, such as 0.5."
            )
        hint = "" if self.names else " (--columns names the columns of the coordinates)"
        self._input.fail(
            f"line {numbers[row]}: expected a coordinate in column {column + 1}, "
            f'found "{quote(self.rows[row][column])}"{hint}.'
        )

    def move(self, points):
        """Replaces the coordinates. Unchanged ones keep their text."""
        for k, column in enumerate(self.columns):
            changed = numpy.flatnonzero(points[:, k] != self.coordinates[:, k])
            for i, value in zip(changed.tolist(), points[changed, k].tolist()):
                self.rows[i][column] = repr(value)
        self.coordinates = points

    def add(self, name, values):
        """Adds columns from an array of shape (n,) or (n, k), replacing those with the same names."""
        values = numpy.asarray(values)
        if values.ndim == 2:
            for k in range(values.shape[1]):
                self.add(f"{name}_{k}", values[:, k])
            return
        texts = map(repr, values.tolist())
        if self.names is not None and name in self.names:
            place = self.names.index(name)
            for row, text in zip(self.rows, texts):
                row[place] = text
            return
        if self.names is not None:
            self.names = self.names + [name]
        for row, text in zip(self.rows, texts):
            row.append(text)

    def add_columns_to(self, data):
        """Adds the columns that are not coordinates to the point arrays of a data set, as numbers if all values are."""
        arrays = data.GetPointData()
        for column in range(len(self.rows[0])):
            if column in self.columns:
                continue
            name = self.names[column] if self.names else ""
            name = name if name.strip() else f"Column{column + 1}"
            while arrays.HasArray(name):
                name += f"_{column + 1}"
            texts = [row[column] for row in self.rows]
            values = [_number(text) if text.strip() else math.nan for text in texts]
            if None not in values:
                array = numpy_to_vtk(numpy.array(values), deep=True)
            else:
                array = vtkStringArray()
                for text in texts:
                    array.InsertNextValue(text)
            array.SetName(name)
            arrays.AddArray(array)

    def write(self, output):
        """Writes the table with its original separator."""
        rows = itertools.chain([self.names] if self.names is not None else [], self.rows)
        with open(output.path, "w", encoding="utf-8", errors="surrogateescape", newline="") as file:
            file.writelines(comment + "\n" for comment in self.comments)
            options = {"delimiter": self.separator, "lineterminator": "\n"}
            plain, quoted = csv.writer(file, **options), csv.writer(file, quoting=csv.QUOTE_ALL, **options)
            first = next(rows)
            # What would be taken for a comment or a byte order mark is quoted, and what would not be taken for a
            # field between blanks.
            (quoted if first[0][:1] in ("#", "\ufeff") else plain).writerow(first)
            if self.separator != " ":
                plain.writerows(rows)
                return
            for row in rows:
                (quoted if any(not field or "\t" in field for field in row) else plain).writerow(row)
