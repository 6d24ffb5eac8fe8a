#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Landmarks for Examples/run, and the folds that result if a Delaunay triangulation is reused.

    landmarks.py extract FOLDER LANDMARKS.csv
        writes the points of gtkmorph's meshes image1.png.mesh and image2.png.mesh, in pixels
    landmarks.py folds LANDMARKS.csv PAIR.vtp SOURCE_IMAGE TARGET_IMAGE PICTURE.png
        counts the triangles that fold or degenerate if the Delaunay triangulation of one domain is reused in the other,
        and in the pair that dhm triangulate made; draws both in the domain with more folds, with folded triangles in
        red (y upwards from 0 at the image's upper edge)
"""

import os
import sys

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import image, pyplot, tri  # noqa: E402


def extract(folder, output):
    columns = []
    for name in ("image1.png", "image2.png"):
        rows, size = image.imread(os.path.join(folder, name)).shape[:2]
        # The file has M2, the numbers of columns and rows, x, y and label of each point, and further data.
        with open(os.path.join(folder, name + ".mesh"), encoding="ascii") as file:
            words = file.read().split()[1:]
        count = int(words[0]) * int(words[1])
        points = numpy.array(words[2 : 2 + 3 * count], float).reshape(count, 3)[:, :2]
        # The mesh ends at the centers of the last pixels.
        columns.append(points * (numpy.array([size, rows]) - 1) / points.max(axis=0) + 0.5)
    numpy.savetxt(output, numpy.hstack(columns), delimiter=",", fmt="%.3f", comments="",
                  header="source_x,source_y,target_x,target_y")


def doubled_areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def read_pair(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    mesh = reader.GetOutput()
    points = [vtk_to_numpy(a)[:, :2] for a in (mesh.GetPoints().GetData(), mesh.GetPointData().GetArray("Target"))]
    return points, vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def folds(landmarks, pair, source_image, target_image, output):
    values = numpy.genfromtxt(landmarks, delimiter=",", names=True)
    source, target = (numpy.column_stack((values[s + "_x"], -values[s + "_y"])) for s in ("source", "target"))
    reused = []
    for name, first, second in (("source", source, target), ("target", target, source)):
        triangles = tri.Triangulation(*first.T).triangles
        areas = doubled_areas(second, triangles)
        reused.append((triangles, areas))
        print(f"{landmarks}: of the {len(triangles)} Delaunay triangles of the {name}'s {len(first)} landmarks, "
              f"{(areas < 0).sum()} fold in the other domain, and {(areas == 0).sum()} have zero area there")
    ours, made = read_pair(pair)
    bad = [int((doubled_areas(points, made) * doubled_areas(ours[0], made) <= 0).sum()) for points in ours]
    print(f"{pair}: of {len(made)} triangles, {max(bad)} fold or have zero area")

    # Show the domain in which more triangles are bad.
    shown = 1 if (reused[0][1] <= 0).sum() > (reused[1][1] <= 0).sum() else 0
    triangles, areas = reused[1 - shown]
    folded = areas <= 0
    if not folded.any():
        print(f"{output} is not drawn, because no triangle folds")
        return
    points = (source, target)[shown]
    panels = ((f"Delaunay triangles of the {('target', 'source')[shown]}'s landmarks:\n{(areas < 0).sum()} folded, "
               f"{(areas == 0).sum()} of zero area", points, triangles, folded),
              (f"made for both domains:\n{max(bad)} folded or of zero area", ours[shown], made,
               numpy.zeros(len(made), bool)))
    pixels = image.imread((source_image, target_image)[shown])
    rows, columns = pixels.shape[:2]
    # Show the whole domain, and the region with the most folded triangles.
    centers = points[triangles[folded]].mean(axis=1)
    near = numpy.hypot(*(centers[:, None] - centers).transpose(2, 0, 1)) < 0.12 * rows
    r = 0.11 * rows
    x, y = numpy.clip(centers[near.sum(axis=1).argmax()], [r, 0.9 * r - rows], [columns - r, -0.9 * r])
    views = [(0, columns, -rows, 0), (x - r, x + r, y - r, y + r)]
    figure, axes = pyplot.subplots(2, 2, figsize=(9, 8.0 * rows / columns), squeeze=False, layout="constrained",
                                   gridspec_kw={"height_ratios": [rows / columns, 1]})
    for row, view in zip(axes, views):
        for panel, (title, points, cells, red) in zip(row, panels):
            panel.imshow(pixels, extent=views[0], cmap="gray", alpha=0.75)
            panel.triplot(*points.T, cells, color="#1b4f9c", linewidth=0.6 if view == views[0] else 1.2)
            if red.any():
                panel.tripcolor(*points.T, cells[red], facecolors=numpy.ones(red.sum()), cmap="autumn", vmin=1, vmax=2,
                                alpha=0.75, edgecolor="red", linewidth=1)
            panel.set(xlim=view[:2], ylim=view[2:], xticks=[], yticks=[])
            if view == views[0]:
                panel.set_title(title)
    figure.savefig(output, dpi=90)


if __name__ == "__main__":
    if len(sys.argv) == 4 and sys.argv[1] == "extract":
        extract(*sys.argv[2:])
    elif len(sys.argv) == 7 and sys.argv[1] == "folds":
        folds(*sys.argv[2:])
    else:
        sys.exit(__doc__)
