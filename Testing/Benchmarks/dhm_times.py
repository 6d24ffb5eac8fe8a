#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Times dhm on a large table and a large image, in a temporary folder:

    dhm_times.py [ROWS] [WIDTHxHEIGHT]        default: 1000000 rows, 10000x10000 pixels (RGB, GeoTIFF)

Prints the elapsed time, the processor time and the peak memory of each run, including the start of Python and the
reading and writing of files."""

import json
import os
import subprocess
import sys
import tempfile
import time

import numpy
import rasterio


def write_shift(path, width, height):
    """A moved grid over the image."""
    x, y = (a.ravel() for a in numpy.meshgrid(numpy.linspace(0, width, 21), numpy.linspace(0, height, 21)))
    moved = [c + 0.006 * width * numpy.sin(9 * d / width) for c, d in ((x, y), (y, x))]
    a = (21 * numpy.arange(20)[:, None] + numpy.arange(20)).ravel()
    triangles = numpy.vstack((numpy.column_stack((a, a + 1, a + 22)), numpy.column_stack((a, a + 22, a + 21))))
    path.write(json.dumps({
        "file_type": "triangulation_file", "format_version": "1.0", "transformed_components": ["horizontal"],
        "vertices_columns": ["source_x", "source_y", "target_x", "target_y"],
        "triangles_columns": ["idx_vertex1", "idx_vertex2", "idx_vertex3"],
        "vertices": numpy.column_stack((x, y, *moved)).tolist(), "triangles": triangles.tolist()}))


def measure(what, *arguments):
    begin = time.perf_counter()
    child = subprocess.Popen([sys.executable, "-m", "vtkhomeomorphism", "-q", *arguments])
    _, status, usage = os.wait4(child.pid, 0)
    if status:
        sys.exit(f"dhm {' '.join(arguments)} failed")
    print(f"{what}: {time.perf_counter() - begin:.1f} s elapsed, {usage.ru_utime + usage.ru_stime:.1f} s of processors, "
          f"at most {usage.ru_maxrss / 1e6:.2f} GB", flush=True)


def main(rows="1000000", size="10000x10000"):
    rows, (width, height) = int(rows), map(int, size.split("x"))
    random = numpy.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("shift.json", "w", encoding="ascii") as file:
            write_shift(file, width, height)
        numpy.savetxt("points.csv", random.uniform(0.1, 0.9, (rows, 2)) * [width, height], "%.6f", ",", header="x,y",
                      comments="")
        measure(f"map, Smooth, {rows} rows", "map", "shift.json", "points.csv", "-s", "smooth", "-o", "mapped.csv")
        with rasterio.open("image.tif", "w", driver="GTiff", width=width, height=height, count=3, dtype="uint8",
                           crs="EPSG:3067", transform=rasterio.Affine(1, 0, 0, 0, -1, height), tiled=True) as file:
            columns = numpy.arange(width)
            for row in range(0, height, 256):
                y = numpy.arange(row, min(row + 256, height))[:, None]
                bands = [columns + y + 7 * numpy.sin(columns / 50), columns - y, columns * y / 999]
                file.write(numpy.array(bands).astype(numpy.int64).astype(numpy.uint8),
                           window=rasterio.windows.Window(0, row, width, len(y)))
        measure(f"warp, Smooth, {size} pixels", "warp", "shift.json", "image.tif", "-s", "smooth", "-o", "warped.tif")


if __name__ == "__main__":
    main(*sys.argv[1:])
