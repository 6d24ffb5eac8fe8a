# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""The rows of the table, in the C++ program and in Python, and their timing."""

import functools
import statistics
import subprocess
import sys
import time

import numpy

DIRECTIONS = ("forward", "inverse")
# Rows that would take more seconds than this for all points are timed with fewer points.
PATIENCE = 6.0


class Program:
    """The C++ program (Benchmark.cxx) with a workload, waiting for commands."""

    def __init__(self, executable, workload):
        self.workload = workload
        self.process = subprocess.Popen(
            [executable, workload.folder], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.process.stdin.close()
        self.process.wait()

    def ask(self, *words):
        print(*words, file=self.process.stdin, flush=True)
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit(f"The program ended instead of answering: {' '.join(map(str, words))}")
        return [float(word) for word in answer.split()]

    def names(self):
        """The rows that the program has."""
        print("rows", file=self.process.stdin, flush=True)
        return self.process.stdout.readline().split()

    def saved(self, dtype):
        path = self.workload.folder / "result"
        self.ask("save", path)
        return numpy.fromfile(path, dtype)


class ProgramRow:
    def __init__(self, program, name, threads=1, dtype=float):
        self.name, self.threads = name, threads
        self._program, self._dtype = program, dtype

    def run(self, points):
        return self._program.ask("run", self.name, points, self.threads)

    def result(self):
        values = self._program.saved(self._dtype)
        return values.reshape(-1, 3)[:, :2] if self._dtype is float else values


class PythonRow:
    threads = 1

    def __init__(self, workload, name, make):
        """make() returns a function of points, or of the workload's data of that name."""
        self.name = name
        self._workload, self._make = workload, make
        self._result = None
        self.preparation = None

    @functools.cached_property
    def _map(self):
        start = time.perf_counter()
        made = self._make()
        self.preparation = time.perf_counter() - start
        return made

    def run(self, points):
        function, argument = self._map, self._workload.points[points]
        processors, clock = time.process_time(), time.perf_counter()
        self._result = function(argument)
        return time.perf_counter() - clock, time.process_time() - processors

    def result(self):
        return self._result


def python_rows(workload, triangles):
    """The rows of SciPy and, for small meshes, of scikit-image."""
    from scipy.interpolate import CloughTocher2DInterpolator, LinearNDInterpolator
    from scipy.spatial import Delaunay
    from skimage.transform import PiecewiseAffineTransform

    rows = []
    for direction in DIRECTIONS:
        start, end = workload.meshes(direction == "inverse")
        delaunay = functools.cache(functools.partial(Delaunay, start))

        def add(name, make, direction=direction):
            rows.append(PythonRow(workload, f"{name}/{direction}", make))

        add("LinearNDInterpolator", lambda t=delaunay, end=end: LinearNDInterpolator(t(), end))
        add("CloughTocher2DInterpolator", lambda t=delaunay, end=end: CloughTocher2DInterpolator(t(), end))
        if triangles <= 10000:

            def piecewise(start=start, end=end):
                transform = PiecewiseAffineTransform()
                transform.estimate(start, end)
                return transform

            add("PiecewiseAffineTransform", piecewise)
    return rows


def image_row(workload):
    from skimage.transform import PiecewiseAffineTransform, warp

    def make():
        transform = PiecewiseAffineTransform()
        transform.estimate(workload.source, workload.target)
        return lambda image: warp(image, transform, order=1)

    workload.points["image"] = workload.image
    return PythonRow(workload, "warp/PiecewiseAffineTransform", make)


class Measurement:
    """The times of a row."""

    def __init__(self, row, points, count):
        self.row, self.points, self.count = row, points, count
        self.seconds, self.processors = [], []
        self.result = None

    def run(self):
        clock, processors = self.row.run(self.points)
        self.seconds.append(clock)
        self.processors.append(processors)
        return clock

    def record(self):
        """Plain data for the report."""
        return {"name": self.row.name, "threads": self.row.threads, "points": self.count,
                "seconds": self.seconds, "processors": self.processors}


def measure(rows, counts, repetitions, points="all", few=None, whole=(), keep=True, quiet=False):
    """Times rows in turn, so that disturbances by other processes affect all of them.

    The first run of each is not counted unless it takes long; its result is kept. Fast rows are
    repeated more often than the minimum."""
    least, most = repetitions
    measurements = []
    for row in rows:
        name = points
        if few and row.name.split("/")[0] not in whole:
            row.run(few)  # prepares
            if row.run(few)[0] * counts[points] / counts[few] > PATIENCE:
                name = few
        measurement = Measurement(row, name, counts[name])
        first = measurement.run()
        if keep:
            measurement.result = row.result()
        if first < PATIENCE:
            measurement.seconds.clear()
            measurement.processors.clear()
        if not quiet:
            print(f"  {row.name}, {row.threads} thread(s): {1e9 * first / measurement.count:.1f} ns a point", flush=True)
        measurements.append(measurement)
    for turn in range(most):
        # In alternating order, so that a row does not always follow the same one.
        for measurement in measurements[:: 1 if turn % 2 else -1]:
            done = len(measurement.seconds)
            if done < least or (done < most and statistics.median(measurement.seconds) < 0.5):
                measurement.run()
    return measurements
