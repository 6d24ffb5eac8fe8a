#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Finds duplicate lines in C++ files: duplicates.py FOLDER [LENGTH]. Fails if LENGTH (default: 12) or more consecutive
lines are equal, not counting blank lines, lines without a letter, includes and the license."""

import collections
import pathlib
import sys


def significant_lines(path):
    """The stripped lines that are compared, with their numbers."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        text = line.strip()
        if any(c.isalpha() for c in text) and not text.startswith(("#include", "// SPDX")):
            yield number, text


def find_duplicates(files, length):
    """Pairs of ((file, first line), (file, first line), number of lines), each as long as possible."""
    seen = collections.defaultdict(list)
    for f, lines in enumerate(files):
        for i in range(len(lines) - length + 1):
            seen["\n".join(text for _, text in lines[i : i + length])].append((f, i))
    covered = set()
    for spots in seen.values():
        for first, second in zip(spots, spots[1:]):
            # Only where two runs of equal lines begin.
            (f, i), (g, j) = first, second
            if (f, i - 1, g, j - 1) not in covered:
                count = length
                while (i + count < len(files[f]) and j + count < len(files[g])
                       and files[f][i + count][1] == files[g][j + count][1]):
                    count += 1
                yield first, second, count
            covered.add((f, i, g, j))


def main():
    folder = pathlib.Path(sys.argv[1])
    length = int(sys.argv[2]) if len(sys.argv) > 2 else 12
    paths = sorted(p for p in folder.rglob("*") if p.suffix in (".h", ".cxx"))
    files = [list(significant_lines(path)) for path in paths]
    duplicates = list(find_duplicates(files, length))
    for (f, i), (g, j), count in duplicates:
        print(f"{paths[f]}:{files[f][i][0]} and {paths[g]}:{files[g][j][0]}: {count} equal lines")
    sys.exit(bool(duplicates))


if __name__ == "__main__":
    main()
