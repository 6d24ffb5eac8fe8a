#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Makes a test chart (chart.ppm), and landmarks on it that are displaced at random (landmarks.csv).

    chart.py FOLDER
"""

import math
import os
import random
import sys

SIZE = 360
CELLS = 6


def chart():
    """Rings and squares in pale colors, row by row from the top."""
    pixels = bytearray()
    for row in range(SIZE):
        y = SIZE - 1 - row
        for x in range(SIZE):
            ring = 0.5 + 0.5 * math.cos(50.0 * math.hypot(x / SIZE - 0.5, y / SIZE - 0.5))
            shade = 0.96 if (x * 10 // SIZE + y * 10 // SIZE) % 2 == 0 else 1.0
            pixels += bytes(int(shade * value) for value in
                            (250 - 75 * ring, 247 - 37 * ring, 238 - 18 * ring))
    return b"P6\n%d %d\n255\n" % (SIZE, SIZE) + bytes(pixels)


def points(generator):
    """A grid over the chart whose points are displaced at random, those on the border along it."""
    unit = (SIZE - 1) / CELLS
    return [[unit * (k + (generator.uniform(-0.3, 0.3) if 0 < k < CELLS else 0.0)) for k in (column, row)]
            for row in range(CELLS + 1) for column in range(CELLS + 1)]


def write_landmarks(name, source, target):
    """Writes landmarks in pixels from the upper left corner of the image, y downwards."""
    with open(name, "w", encoding="ascii") as file:
        file.write("source_x,source_y,target_x,target_y\n")
        for pair in zip(source, target):
            file.write(",".join(repr(c) for x, y in pair for c in (x + 0.5, SIZE - 0.5 - y)) + "\n")


def main():
    folder = sys.argv[1]
    generator = random.Random(12)
    source, target = points(generator), points(generator)
    write_landmarks(os.path.join(folder, "landmarks.csv"), source, target)
    with open(os.path.join(folder, "chart.ppm"), "wb") as file:
        file.write(chart())


if __name__ == "__main__":
    main()
