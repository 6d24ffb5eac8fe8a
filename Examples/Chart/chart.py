#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Makes a test chart (chart.ppm) and a random pair of meshes over it (source.off, target.off).

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
    """A grid over the chart whose points are moved at random, those of the border along it."""
    unit = (SIZE - 1) / CELLS
    return [[unit * (k + (generator.uniform(-0.3, 0.3) if 0 < k < CELLS else 0.0)) for k in (column, row)]
            for row in range(CELLS + 1) for column in range(CELLS + 1)]


def smallest_angle(triangle):
    """Negative for a triangle that is turned over."""
    angles = []
    for k in range(3):
        (ax, ay), (bx, by), (cx, cy) = (triangle[(k + i) % 3] for i in range(3))
        ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
        angles.append(math.atan2(ux * vy - uy * vx, ux * vx + uy * vy))
    return min(angles)


def triangles(*meshes):
    """Each cell of the grid, cut so that the smallest angle in all meshes is largest."""
    result = []
    for row in range(CELLS):
        for column in range(CELLS):
            a = row * (CELLS + 1) + column
            b, c, d = a + 1, a + CELLS + 2, a + CELLS + 1
            cuts = [[(a, b, c), (a, c, d)], [(a, b, d), (b, c, d)]]
            result += max(cuts, key=lambda cut: min(
                smallest_angle([mesh[i] for i in triangle]) for mesh in meshes for triangle in cut))
    return result


def write_off(name, mesh, cells):
    with open(name, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(mesh)} {len(cells)} 0\n")
        file.writelines(f"{x!r} {y!r} 0\n" for x, y in mesh)
        file.writelines("3 %d %d %d\n" % cell for cell in cells)


def main():
    folder = sys.argv[1]
    generator = random.Random(12)
    source, target = points(generator), points(generator)
    cells = triangles(source, target)
    write_off(os.path.join(folder, "source.off"), source, cells)
    write_off(os.path.join(folder, "target.off"), target, cells)
    with open(os.path.join(folder, "chart.ppm"), "wb") as file:
        file.write(chart())


if __name__ == "__main__":
    main()
