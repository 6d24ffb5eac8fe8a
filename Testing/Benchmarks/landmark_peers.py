#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares maps from landmarks: those of scikit-image's PiecewiseAffineTransform, which reuses the Delaunay
triangulation of one domain, and those of this module, for the same landmarks and points in one run. Prints a table in Markdown.
Started by Testing/stress peers."""

import os
import sys
import time
import warnings

import numpy
from scipy.spatial import Delaunay
from skimage.transform import PiecewiseAffineTransform
from vtkhomeomorphism import Homeomorphism, isomorphic_triangulation
from vtkhomeomorphism.landmarks import read_landmarks

POINTS = 20000


def data(folder):
    for name in ("nobeoka", "nobeoka-inset", "fushimi-castle", "tatebayashi-town", "uno-bus"):
        path = os.path.join(folder, "landmarks", name + ".csv")
        if os.path.isfile(path):
            marks = read_landmarks(path)
            yield name, marks.source * [1, -1], marks.target
    source = numpy.random.default_rng(1).random((1000, 2))
    spacing = 1000**-0.5
    yield "smooth", source, source + 0.03 * numpy.sin(7 * source[:, ::-1])
    for share in (0.25, 0.5):
        noise = numpy.random.default_rng(2).normal(0, share * spacing, source.shape)
        yield f"noise of {share:g} spacings", source, source + noise


def inside_points(source):
    """Random points in the hull of the landmarks."""
    triangulation = Delaunay(source)
    random = numpy.random.default_rng(3)
    corners = source[triangulation.simplices[random.integers(len(triangulation.simplices), size=POINTS)]]
    return (random.dirichlet((1, 1, 1), POINTS)[:, :, None] * corners).sum(axis=1)


def folds(triangles, first, second):
    def areas(p):
        a, b, c = (p[triangles[:, k]] for k in range(3))
        return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]

    signs = areas(first) * areas(second)
    # The target may be a mirror image.
    return min(int((signs <= 0).sum()), int((signs >= 0).sum()))


def timed(function):
    start = time.process_time()
    result = function()
    return result, time.process_time() - start


def round_trip(points, back):
    """The share of points that do not come back to 1e-6 of the extent, and the largest distance of those that are
    anywhere, as a share of the extent."""
    distances = numpy.hypot(*(back - points).T) / numpy.ptp(points, axis=0).max()
    return (~(distances <= 1e-6)).mean(), numpy.nanmax(distances)


def main():
    warnings.simplefilter("ignore")
    print("| landmarks | | folded triangles, forward and inverse | points that do not return | largest distance | "
          "triangulation, s | round trip, s |\n| --- | --- | ---: | ---: | ---: | ---: | ---: |")
    for name, source, target in data(sys.argv[1]):
        points = inside_points(source)
        peer = PiecewiseAffineTransform()
        _, making = timed(lambda: peer.estimate(source, target))

        def there_and_back(forward, inverse):
            back = inverse(forward(points))
            # scikit-image returns -1 outside.
            return numpy.where((back == -1).all(axis=1)[:, None], numpy.nan, back)

        back, mapping = timed(lambda: there_and_back(peer, peer.inverse))
        lost, largest = round_trip(points, back)
        both = [folds(Delaunay(a).simplices, a, b) for a, b in ((source, target), (target, source))]
        print(f"| {name}, {len(source)} | scikit-image | {both[0]}, {both[1]} | {100 * lost:.1f} % | {largest:.1g} | "
              f"{making:.2f} | {mapping:.2f} |")
        pair, making = timed(lambda: isomorphic_triangulation(source, target))
        ours = Homeomorphism(pair.source, pair.target, pair.triangles, "linear")
        back, mapping = timed(lambda: there_and_back(ours, ours.inverse))
        lost, largest = round_trip(points, back)
        bad = folds(pair.triangles, pair.source, pair.target)
        print(f"| | this module | {bad}, {bad} | {100 * lost:.1f} % | {largest:.1g} | {making:.2f} | {mapping:.2f} |",
              flush=True)


if __name__ == "__main__":
    main()
