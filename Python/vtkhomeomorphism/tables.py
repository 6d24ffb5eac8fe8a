# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of points as text, by pandas. All fields keep their text, to the last digit, except changed coordinates."""

import csv
import re

import numpy

from .files import USAGE, Failure, import_extra, inform, quote

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
ENCODING = {"encoding": "utf-8-sig", "errors": "surrogateescape"}


def _number(text):
    """A number, or None. Excludes notations that only Python accepts."""
    try:
        value = float(text)
    except ValueError:
        return None
    return None if "_" in text or (abs(value) == numpy.inf and "inf" not in text.lower()) else value


class Table:
    """A table of points.

    columns : text
        Names or numbers (from 1) of the coordinate columns, separated by commas; empty: those with usual names.
    with_height : bool
        Whether a third coordinate may be a column with the usual name of a height.
    """

    def __init__(self, input, columns="", with_height=False):
        self.input, self.comments, self.names = input, [], None
        pandas = import_extra("pandas", f"Reading {input.name}")
        with open(input.path, **ENCODING) as file:
            for self.skipped, first in enumerate(file):
                if first.startswith("#"):
                    self.comments.append(first)
                elif first.strip():
                    break
            else:
                input.fail("it has no points.")
        self.separator = max(",;\t", key=first.count) if re.search("[,;\t]", first) else " "
        try:
            self.frame = pandas.read_csv(
                input.path, sep=self.separator if self.separator != " " else r"\s+", header=None, dtype=str,
                na_filter=False, skiprows=self.skipped, encoding="utf-8-sig", encoding_errors="surrogateescape",
            )
        except pandas.errors.ParserError as error:
            unfinished = re.search(r"starting at row (\d+)", str(error))
            input.fail((f"line {self._line(int(unfinished[1]))}: " if unfinished else "") + quote(error) + ".")
        self.first = self.frame.iloc[0].tolist()
        self.columns = self._choose_named(columns) if columns else self._choose(with_height)
        texts = [self.first[column] for column in self.columns]
        if self.names is None and all(_number(text) is None for text in texts):
            if not columns:
                input.fail(f"none of its columns ({self._list()}) has a name that is usual for coordinates, such as x "
                           "and y: name them (--columns).")
            self.names = self.first
        if self.names is not None:
            self.frame = self.frame.iloc[1:].reset_index(drop=True)
        if not len(self.frame):
            input.fail("it has no points.")
        self.coordinates = numpy.column_stack([self._numbers(column) for column in self.columns])

    def _find(self, name):
        """The column with a name. Names may differ in case only."""
        simple = [field.strip().lower() for field in self.first]
        for fields, wanted in ((self.first, name), (simple, name.strip().lower())):
            if wanted in fields:
                return fields.index(wanted)
        return None

    def _choose(self, with_height):
        for names in USUAL_NAMES:
            found = [self._find(name) for name in names]
            if None not in found:
                self.names = self.first
                heights = [self._find(name) for name in HEIGHT_NAMES] if with_height and len(found) == 2 else []
                return found + [column for column in heights if column is not None][:1]
        if len(self.first) < 2:
            self.input.fail("it has only one column: points need two coordinates.")
        return [0, 1] + [2] * (with_height and len(self.first) > 2 and _number(self.first[2]) is not None)

    def _choose_named(self, columns):
        chosen = []
        for name in columns.split(","):
            # A number is not a name: in a table without names it may be a coordinate.
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
        texts = self.frame[column]
        try:
            values = texts.to_numpy().astype(float)
            suspicious = numpy.isinf(values).any() or texts.str.contains("_", regex=False).any()
        except ValueError:
            suspicious = True
        if suspicious:
            values = list(map(_number, texts))
            if None in values:
                self._fail_at(values.index(None), column)
        return values

    def _line(self, row):
        """The line of the file where a row of the frame begins, header included."""
        with open(self.input.path, newline="", **ENCODING) as file:
            lines = file.read().splitlines(keepends=True)[self.skipped :]
        reader = csv.reader(lines, delimiter=self.separator)
        begins = [0] + [reader.line_num for fields in reader if any(field.strip() for field in fields)]
        return self.skipped + begins[min(row, len(begins) - 1)] + 1

    def _fail_at(self, row, column):
        line, text = self._line(row + (self.names is not None)), self.frame.iloc[row][column]
        hint = "" if self.names else " (--columns names the columns of the coordinates)"
        hint = " (write decimal points, not commas)" if "," in text else hint
        self.input.fail(f'line {line}: expected a coordinate in column {column + 1}, found "{quote(text)}"{hint}.')

    def move(self, points):
        """Replaces the coordinates. Unchanged ones keep their text."""
        for k, column in enumerate(self.columns):
            texts = self.frame[column].to_numpy(copy=True)
            changed = points[:, k] != self.coordinates[:, k]
            texts[changed] = list(map(repr, points[changed, k].tolist()))
            self.frame[column] = texts

    def add(self, name, values):
        """Adds columns from an array of shape (n,) or (n, k), replacing those with the same names."""
        for k, column in enumerate(numpy.atleast_2d(values.T)):
            own = name if values.ndim == 1 else f"{name}_{k}"
            place = self.frame.shape[1]
            if self.names is not None:
                if own in self.names:
                    inform(f"{self.input.name}: the column {own} is replaced.")
                place = self.names.index(own) if own in self.names else place
                self.names = self.names[:place] + [own] + self.names[place + 1 :]
            self.frame[place] = list(map(repr, column.tolist()))

    def write(self, output):
        """Writes the table with its original separator."""
        with open(output.path, "w", encoding="utf-8", errors="surrogateescape", newline="") as file:
            file.writelines(self.comments)
            # What would be taken for a comment or a byte order mark is quoted, and fields between blanks.
            quoted = (self.names or self.frame.iloc[0])[0][:1] in ("#", "\ufeff")
            if self.separator == " ":
                quoted |= self.frame.apply(lambda texts: texts.str.contains("^$|\t")).any(axis=None)
            style = {"quoting": csv.QUOTE_ALL if quoted else csv.QUOTE_MINIMAL}
            if self.names:
                csv.writer(file, delimiter=self.separator, lineterminator="\n", **style).writerow(self.names)
            self.frame.to_csv(file, sep=self.separator, header=False, index=False, **style)
