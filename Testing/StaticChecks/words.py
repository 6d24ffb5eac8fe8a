#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Finds words that must not be used in names, code and texts: words.py LIST FOLDER.

Each line of the list has a file pattern (for names relative to the folder; `*` stands for all files), a regular
expression, and the replacement, separated by tabs. Lines that begin with # are comments."""

import fnmatch
import os
import pathlib
import re
import sys

SUFFIXES = {".h", ".cxx", ".py", ".md", ".cmake", ".txt", ".xml", ".in", ".json", ".sh", ".cff", ".toml", ""}
SKIPPED = {"build", "Output", "Corpus", "Data", "__pycache__", ".git"}


def text_files(folder):
    for directory, subdirectories, names in os.walk(folder):
        subdirectories[:] = sorted(d for d in subdirectories if d not in SKIPPED)
        for name in sorted(names):
            path = pathlib.Path(directory, name)
            if path.suffix in SUFFIXES and name not in ("LICENSE", ".git"):
                yield path


def main():
    words, folder = map(pathlib.Path, sys.argv[1:])
    rules = []
    for line in words.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            pattern, expression, advice = line.split("\t")
            rules.append((pattern.split(","), re.compile(expression), advice))
    found = 0
    for path in text_files(folder):
        name = path.relative_to(folder).as_posix()
        if path.resolve() == words.resolve():
            continue
        try:
            lines = path.read_text(encoding="utf-8").splitlines()
        except UnicodeDecodeError:
            continue
        for patterns, expression, advice in rules:
            if any(fnmatch.fnmatch(name, pattern) for pattern in patterns):
                for number, line in enumerate(lines, 1):
                    for match in expression.finditer(line):
                        print(f"{name}:{number}: {match.group()}: {advice}")
                        found += 1
    sys.exit(f"{found} words to replace" if found else 0)


if __name__ == "__main__":
    main()
