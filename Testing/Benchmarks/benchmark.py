#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Times this module and comparable software in one run, in turn, on the same meshes and points.

    benchmark.py PROGRAM FOLDER [--quick] [--only PART ...] [--baseline DIR]

PROGRAM is HomeomorphismBenchmark. Writes benchmark.md, benchmark.png and, with all times,
benchmark.json to FOLDER. With --quick, everything is smaller and repeated less often, to check the program;
its numbers are not reliable. With --baseline, only the rows of this program are timed, in turn with those of the
HomeomorphismBenchmark in another build folder, and their ratios are printed. Started by Testing/benchmark.
"""

import argparse
import contextlib
import json
import pathlib
import tempfile

import numpy

import baseline
import report
from rows import DIRECTIONS, Program, ProgramRow, image_row, measure, python_rows
from workloads import (Workload, displaced_mesh, fan_mesh, few_lines, grid_in_scan_order, grid_mesh, picture,
                       random_points, sliver_mesh)

SYSTEMS = ("Linear", "Contour", "Smooth")
# The two maps of the Cubic system, on small meshes only: random pairs take many rounds of minimization.
CUBIC = ("CubicLocal", "CubicLeast")
PARTS = ("small", "large", "thin", "threads", "image", "construction", "cubic")

FULL = {"small": 21, "large": 1000, "thin": 224, "side": 800, "many": (4000, 2500), "dense": (4000, 2500), "image": 4096,
        "construction": (100, 316, 1000), "cubic": (316, 1000, 1414), "repetitions": (5, 15)}
QUICK = {"small": 21, "large": 300, "thin": 50, "side": 400, "many": (1000, 1000), "dense": (1000, 1000), "image": 512,
         "construction": (30, 95, 300), "cubic": (95, 300, 424), "repetitions": (3, 5)}
# Some tens of rounding errors at the width of the domain.
TOLERANCE = 1e-13


class Benchmark:
    def __init__(self, program, settings, folder):
        self.program, self.settings, self.folder = program, settings, folder
        self.repetitions = settings["repetitions"]
        self.results = {"settings": settings, "measurements": {}, "checks": [], "preparation": {}}

    def record(self, part, measurements):
        self.results["measurements"][part] = [m.record() for m in measurements]

    def check(self, part, what, error, tolerance):
        self.results["checks"].append(
            {"part": part, "what": what, "error": float(error), "tolerance": tolerance, "good": bool(error <= tolerance)})

    def compare(self, part, measurements, first, second, tolerance):
        """The largest difference of the results of two rows, if both exist. Infinite if a result is not finite."""
        found = {m.row.name: m for m in measurements}
        if first in found and second in found and found[first].count == found[second].count:
            a, b = found[first].result, found[second].result
            difference = numpy.abs(a - b).max() if a.shape == b.shape else numpy.inf
            self.check(part, f"{first} = {second}", numpy.nan_to_num(difference, nan=numpy.inf), tolerance)

    def points(self, part, workload, program, names, whole=(), points="all", few="few", others=True):
        """Measures the rows of a workload, and checks that they agree."""
        print(f"{part}: {len(workload.triangles)} triangles, {len(workload.points[points])} points", flush=True)
        counts = {name: len(array) for name, array in workload.points.items()}
        rows = [ProgramRow(program, name, threads) for name, threads in names]
        if others:
            rows += self.python(workload)
        measurements = measure(rows, counts, self.repetitions, points, few, whole)
        self.record(part, measurements)
        single = [m for m in measurements if m.row.threads == 1]
        tolerance = TOLERANCE * workload.width
        for direction in DIRECTIONS:
            linear = f"transform/Linear/{direction}"
            for peer in ("tinshift", "FindCell", "vtkProbeFilter", "affine"):
                self.compare(part, single, linear, f"{peer}/{direction}", tolerance)
            for system in (*SYSTEMS, *CUBIC):
                for way in ("pointwise", "jacobian", "filter"):
                    self.compare(part, single, f"transform/{system}/{direction}", f"{way}/{system}/{direction}", 0.0)
        # In the inverse direction these peers use another triangulation.
        for peer in ("LinearNDInterpolator", "PiecewiseAffineTransform"):
            self.compare(part, single, "transform/Linear/forward", f"{peer}/forward", tolerance)
        for system in (*SYSTEMS, *CUBIC):
            ways = [f"transform/{system}/{direction}" for direction in DIRECTIONS]
            if {way for way in ways} <= {m.row.name for m in single}:
                self.check(part, f"round trip, {system}", program.ask("roundtrip", *ways, points)[0], 10 * tolerance)
        return measurements

    def python(self, workload):
        """Made once per workload, because triangulating takes long."""
        if not hasattr(workload, "python_rows"):
            workload.python_rows = python_rows(workload, len(workload.triangles))
        return workload.python_rows

    def small(self):
        workload = Workload(self.folder / "small", self.settings["small"])
        self.check_delaunay("small", workload)
        side = self.settings["side"]
        workload.add_points("all", grid_in_scan_order(workload.width, side, side))
        workload.add_points("few", few_lines(workload.points["all"], side, 25))
        names = [("copy", 1)]
        for direction in DIRECTIONS:
            names += [(f"{way}/{system}/{direction}", 1)
                      for way in ("transform", "pointwise", "jacobian", "filter") for system in (*SYSTEMS, *CUBIC)]
            names += [(f"{peer}/{direction}", 1)
                      for peer in ("affine", "tinshift", "FindCell", "vtkProbeFilter", "vtkThinPlateSplineTransform")]
            names += [(f"vtkProbeFilter/{direction}", 2), (f"transform/Smooth/{direction}", 2)]
        with Program(self.program, workload) as program:
            self.points("small", workload, program, names)

    def large(self):
        workload = Workload(self.folder / "large", self.settings["large"])
        self.check_delaunay("large", workload)
        side = self.settings["side"]
        workload.add_points("scan", grid_in_scan_order(workload.width, side, side))
        workload.add_points("scan-few", few_lines(workload.points["scan"], side, 25))
        workload.add_points("random", random_points(workload.width, side * side))
        workload.add_points("random-few", workload.points["random"][: side * side // 32])
        columns, lines = self.settings["dense"]
        workload.add_points("dense", grid_in_scan_order(workload.width, columns, lines))
        names = [("copy", 1)]
        for direction in DIRECTIONS:
            names += [(f"transform/{system}/{direction}", 1) for system in SYSTEMS]
            names += [(f"{way}/Smooth/{direction}", 1) for way in ("pointwise", "filter")]
            names += [(f"{peer}/{direction}", 1) for peer in ("affine", "FindCell", "vtkProbeFilter")]
            names += [(f"vtkProbeFilter/{direction}", 2), (f"transform/Smooth/{direction}", 2)]
        with Program(self.program, workload) as program:
            for order in ("scan", "random"):
                self.points(f"large, {order}", workload, program, names, ("vtkProbeFilter",), order, f"{order}-few")
            dense = [("affine/forward", 1)] + [(f"transform/{s}/{d}", 1) for d in DIRECTIONS for s in SYSTEMS]
            self.points("large, dense", workload, program, dense, (), "dense", None, others=False)
        self.results["preparation"] = {row.name: row.preparation for row in workload.python_rows}

    def thin(self):
        n = self.settings["thin"]
        for name, mesh in (("grid", grid_mesh), ("fan", fan_mesh), ("slivers", sliver_mesh)):
            workload = Workload(self.folder / f"thin-{name}", n, mesh=mesh)
            workload.add_points("all", random_points(workload.width, 2 * n * n))
            names = [(f"{way}/{system}/{d}", 1)
                     for way in ("transform", "pointwise") for system in ("Linear", "Smooth") for d in DIRECTIONS]
            with Program(self.program, workload) as program:
                self.points(f"thin, {name}", workload, program, names, points="all", few=None, others=False)

    def threads(self):
        workload = Workload(self.folder / "threads", self.settings["small"])
        columns, lines = self.settings["many"]
        workload.add_points("all", grid_in_scan_order(workload.width, columns, lines))
        print(f"threads: {columns * lines} points", flush=True)
        with Program(self.program, workload) as program:
            rows = [ProgramRow(program, f"transform/{system}/{direction}", threads)
                    for system in SYSTEMS for direction in DIRECTIONS for threads in (1, 2)]
            measurements = measure(rows, {"all": columns * lines}, self.repetitions)
        self.record("threads", measurements)
        for one, two in zip(measurements[::2], measurements[1::2]):
            same = numpy.array_equal(one.result.view(numpy.uint64), two.result.view(numpy.uint64))
            self.check("threads", f"{one.row.name}, one thread = two threads", 0.0 if same else numpy.inf, 0.0)

    def image(self):
        size = self.settings["image"]
        workload = Workload(self.folder / "image", self.settings["small"], (size - 1) / self.settings["small"])
        workload.set_image(picture(size))
        # One row of pixels, because the program needs points; images have their own.
        workload.add_points("image", workload.source[:1])
        print(f"image: {size} x {size}", flush=True)
        with Program(self.program, workload) as program:
            rows = [ProgramRow(program, f"{way}/{system}", threads, numpy.uint8)
                    for threads in (1, 2) for way in ("reslice", "resample") for system in (*SYSTEMS, CUBIC[1])]
            rows += [ProgramRow(program, "reslice/ThinPlateSpline", threads, numpy.uint8) for threads in (1, 2)]
            rows.append(image_row(workload))
            measurements = measure(rows, {"image": size * size}, self.repetitions, "image")
        self.record("image", measurements)
        single = {m.row.name: m for m in measurements if m.row.threads == 1}
        # The peer's pixels at the border are black where rounding moves them outside.
        inside = (slice(2, -2), slice(2, -2))
        images = {name: m.result.reshape(size, size, 3)[inside].astype(float) for name, m in single.items()}
        images["warp/PiecewiseAffineTransform"] *= 255.0
        for system in (*SYSTEMS, CUBIC[1]):
            self.compare_images(images, f"reslice/{system}", f"resample/{system}")
        self.compare_images(images, "reslice/Linear", "warp/PiecewiseAffineTransform")

    def compare_images(self, images, first, second):
        self.check("image", f"{first} = {second}, in gray levels", numpy.abs(images[first] - images[second]).max(), 1.0)

    def construction(self):
        self.results["memory"] = {}
        with contextlib.ExitStack() as stack:
            rows = []
            counts = {}
            for n in self.settings["construction"]:
                workload = Workload(self.folder / f"construction-{n}", n)
                triangles = len(workload.triangles)
                workload.add_points(str(triangles), workload.source[:1])
                counts[str(triangles)] = triangles
                program = stack.enter_context(Program(self.program, workload))
                print(f"construction: {triangles} triangles", flush=True)
                for system in SYSTEMS:
                    kept, peak = program.ask("memory", f"construct/{system}")
                    self.results["memory"][f"{system}/{triangles}"] = [kept / triangles, peak / triangles]
                names = [*(f"construct/{system}" for system in SYSTEMS), "construct/vtkStaticCellLocator"]
                rows += [(str(triangles), ProgramRow(program, name, threads)) for name in names for threads in (1, 2)]
            measurements = []
            # Each size separately, since rows take turns; the largest alone takes minutes.
            for size in counts:
                measurements += measure([row for s, row in rows if s == size], counts, self.repetitions, size, keep=False)
        self.record("construction", measurements)

    def cubic(self):
        """Preparation of Smooth and of both maps of the Cubic system, for a smooth displacement."""
        self.results["cubic memory"] = {}
        measurements = []
        for n in self.settings["cubic"]:
            workload = Workload(self.folder / f"cubic-{n}", n, mesh=displaced_mesh)
            triangles = len(workload.triangles)
            workload.add_points(str(triangles), workload.source[:1])
            print(f"cubic: {triangles} triangles", flush=True)
            with Program(self.program, workload) as program:
                rows = [ProgramRow(program, f"construct/{system}") for system in ("Smooth", *CUBIC)]
                for row in rows:
                    kept, peak = program.ask("memory", row.name)
                    self.results["cubic memory"][f"{row.name}/{triangles}"] = [kept / triangles, peak / triangles]
                measurements += measure(rows, {str(triangles): triangles}, self.repetitions, str(triangles), keep=False)
        self.record("cubic", measurements)

    def check_delaunay(self, part, workload):
        from scipy.spatial import Delaunay

        def sorted_rows(triangles):
            rows = numpy.sort(triangles, axis=1)
            return rows[numpy.lexsort(rows.T[::-1])]

        own, others = sorted_rows(workload.triangles), sorted_rows(Delaunay(workload.source).simplices)
        same = own.shape == others.shape and (own == others).all()
        self.check(part, "the mesh = Delaunay's triangulation of its points", 0.0 if same else numpy.inf, 0.0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="smaller, and repeated less often")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS, help="these parts only")
    parser.add_argument("--baseline", type=pathlib.Path, metavar="DIR", help="another build folder to compare with")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    if arguments.baseline:
        with tempfile.TemporaryDirectory() as folder:
            slow = baseline.compare(arguments.program, arguments.baseline / "bin" / "HomeomorphismBenchmark",
                                    QUICK if arguments.quick else FULL, pathlib.Path(folder), arguments.only)
        raise SystemExit("Slower than the other build: " + "; ".join(slow) if slow else 0)
    with tempfile.TemporaryDirectory() as folder:
        benchmark = Benchmark(arguments.program, QUICK if arguments.quick else FULL, pathlib.Path(folder))
        benchmark.results["quick"] = arguments.quick
        for part in arguments.only:
            getattr(benchmark, part)()
    (arguments.folder / "benchmark.json").write_text(json.dumps(benchmark.results))
    report.write(benchmark.results, arguments.folder)
    if not all(check["good"] for check in benchmark.results["checks"]):
        raise SystemExit("Some rows do not compute the same: see the end of the report.")


if __name__ == "__main__":
    main()
