# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Text tables of points. The text of all fields is kept, except that of changed coordinates."""

import csv
import re

import numpy

from .files import USAGE, Failure, inform, quote

USUAL_NAMES = [
    names.split()
    for names in (
        "x y z, x y, e n, easting northing, east north, x_coord y_coord z_coord, x_coord y_coord, xcoord ycoord, "
        "x_coordinate y_coordinate, point_x point_y, rechtswert hochwert, rechts hoch, ostwert nordwert, ost nord, "
        "longitude latitude, long lat, lon lat, lng lat"
    ).split(", ")
]
"""Usual names of coordinates. The first entry that a table has is used."""
HEIGHT_NAMES = ("z", "h", "height", "altitude", "alt", "elevation", "elev", "hoehe", "höhe")
ENCODING = {"errors": "surrogateescape", "newline": ""}


def records(lines, separator):
    """Yields the number of the first line (from 1) and the fields of each row that is not empty. Raises csv.Error."""
    if separator == " ":
        fields = ([field[1:-1].replace('""', '"') if field[0] == '"' else field
                   for field in re.findall(r'"(?:[^"]|"")*"|\S+', line)] for line in lines)
        yield from ((number, row) for number, row in enumerate(fields, 1) if row)
        return
    reader, begin = csv.reader(lines, delimiter=separator, strict=True), 0
    for row in reader:
        if any(map(str.strip, row)):
            yield begin + 1, row
        begin = reader.line_num


def number_of(text):
    """The number in a text, or None. Notations that only Python accepts are excluded."""
    try:
        value = float(text)
    except ValueError:
        return None
    return None if "_" in text or (abs(value) == numpy.inf and "inf" not in text.lower()) else value


class Table:
    """A table of points.

    columns : text
        Names or numbers (from 1) of the coordinate columns, separated by commas. Empty: columns with usual names.
    with_height : bool
        Whether a column with a usual name of heights may be the third coordinate.
    """

    def __init__(self, input, columns="", with_height=False):
        self.input, self.names = input, None
        with open(input.path, encoding="utf-8-sig", **ENCODING) as file:
            lines = file.readlines()
        begin = next((i for i, line in enumerate(lines) if line.strip() and not line.startswith("#")), len(lines))
        self.comments = [line for line in lines[:begin] if line.startswith("#")]
        first, rows = "".join(lines[begin : begin + 1]), []
        self.separator = max(",;\t", key=first.count) if re.search("[,;\t]", first) else " "
        try:
            rows.extend((begin + line, fields) for line, fields in records(lines[begin:], self.separator))
        except csv.Error as error:
            input.fail(f"line {rows[-1][0] + 1 if rows else begin + 1}: {error}.")
        if not rows:
            input.fail("it has no points.")
        self.first = rows[0][1]
        for line, fields in rows:
            if len(fields) > len(self.first):
                input.fail(f"line {line}: {len(fields)} fields, where {len(self.first)} are expected.")
            fields += [""] * (len(self.first) - len(fields))
        self.columns = self._choose_named(columns) if columns else self._choose(with_height)
        if self.names is None and all(number_of(self.first[column]) is None for column in self.columns):
            if not columns:
                input.fail(f"none of its columns ({self._list()}) has a usual name for coordinates, such as x and y: "
                           "name the columns (--columns).")
            self.names = self.first
        if len(rows) == (self.names is not None):
            input.fail("it has no points.")
        self.lines, rows = zip(*rows[self.names is not None :])
        self.fields = list(map(list, zip(*rows)))
        self.coordinates = numpy.column_stack([self._numbers(column) for column in self.columns])

    def _find(self, name):
        """The column with a name, otherwise one whose name differs only in case, otherwise None."""
        if name in self.first:
            return self.first.index(name)
        simple, name = [field.strip().lower() for field in self.first], name.strip().lower()
        return simple.index(name) if name in simple else None

    def _choose(self, with_height):
        for names in USUAL_NAMES:
            found = [self._find(name) for name in names]
            if None not in found:
                self.names = self.first
                heights = [self._find(name) for name in HEIGHT_NAMES] if with_height and len(found) == 2 else []
                return found + [column for column in heights if column is not None][:1]
        if len(self.first) < 2:
            self.input.fail("it has only one column, but points need two coordinates.")
        return [0, 1] + [2] * (with_height and len(self.first) > 2 and number_of(self.first[2]) is not None)

    def _choose_named(self, columns):
        chosen = []
        for name in columns.split(","):
            # A number is never a name: in a table without names, it may be a coordinate.
            is_number = re.fullmatch(r"\s*\d+\s*", name)
            column = int(name) - 1 if is_number else self._find(name)
            if column is None or not 0 <= column < len(self.first) or column in chosen:
                raise Failure(f'{self.input.name} has no other column "{name}" (--columns): its first line has '
                              f"{len(self.first)} columns, {self._list()}.", USAGE)
            chosen.append(column)
            self.names = self.names if is_number else self.first
        if len(chosen) not in (2, 3):
            raise Failure("Two or three coordinate columns are needed (--columns).", USAGE)
        return chosen

    def _list(self):
        return quote(", ".join(f'"{name}"' for name in self.first), 300)

    def _numbers(self, column):
        values = list(map(number_of, self.fields[column]))
        if None in values:
            row = values.index(None)
            text = self.fields[column][row]
            hint = "" if self.names else " (--columns names the columns of the coordinates)"
            hint = " (write decimal points, not commas)" if "," in text else hint
            self.input.fail(f'line {self.lines[row]}: expected a coordinate in column {column + 1}, found '
                            f'"{quote(text)}"{hint}.')
        return values

    def move(self, points):
        """Replaces the coordinates. The text of unchanged ones is kept."""
        for k, column in enumerate(self.columns):
            changed = points[:, k] != self.coordinates[:, k]
            for row in numpy.flatnonzero(changed).tolist():
                self.fields[column][row] = repr(float(points[row, k]))

    def add(self, name, values):
        """Adds columns from an array of shape (n,) or (n, k), replacing those with the same names."""
        for k, column in enumerate(numpy.atleast_2d(values.T)):
            own, place = name if values.ndim == 1 else f"{name}_{k}", len(self.fields)
            if self.names is not None:
                if own in self.names:
                    inform(f"{self.input.name}: the column {own} is replaced.")
                    place = self.names.index(own)
                self.names = self.names[:place] + [own] + self.names[place + 1 :]
            self.fields[place:] = [list(map(repr, column.tolist())), *self.fields[place + 1 :]]

    def write(self, output):
        """Writes the table with its original separator."""
        # Quote text that would be read as a comment or a byte order mark, and fields that are separated by blanks.
        quoted = (self.names or self.fields[0])[0][:1] in ("#", "\ufeff") or self.separator == " " and any(
            not text or "\t" in text for column in self.fields for text in column)
        with open(output.path, "w", encoding="utf-8", **ENCODING) as file:
            file.writelines(self.comments)
            writer = csv.writer(file, delimiter=self.separator, lineterminator="\n",
                                quoting=csv.QUOTE_ALL if quoted else csv.QUOTE_MINIMAL)
            writer.writerows([self.names] if self.names else [])
            writer.writerows(zip(*self.fields))
