# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares two folders of results up to order: compare.py EXPECTED ACTUAL.

Duplicates of points on the borders of pieces are ignored."""

import glob
import os
import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader


def rows(columns):
    """The values of each point or cell as one string of bytes."""
    table = numpy.concatenate(
        [c.reshape(len(c), -1).astype(numpy.float64) + 0.0 for c in columns], axis=1)
    table[numpy.isnan(table)] = numpy.nan
    return [row.tobytes() for row in numpy.ascontiguousarray(table)]


DUPLICATE = 1


def read(path):
    """Point arrays, cell arrays, points and cells, without duplicates of other pieces."""
    reader = vtkXMLPUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    if grid.GetNumberOfPoints() == 0:
        return [], [], [], []
    point_names, points, foreign_points = arrays(grid.GetPointData(), grid.GetNumberOfPoints())
    points = rows([vtk_to_numpy(grid.GetPoints().GetData())] + points)
    cell_names, cells, foreign_cells = arrays(grid.GetCellData(), grid.GetNumberOfCells())
    values = rows(cells)
    # Cells are compared by their points, independently of ids, and by their values.
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    cells = [tuple(points[p] for p in connectivity[offsets[i]:offsets[i + 1]]) + (values[i],)
             for i in numpy.flatnonzero(~foreign_cells)]
    points = {points[i] for i in numpy.flatnonzero(~foreign_points)}
    return point_names, cell_names, sorted(points), sorted(cells)


def arrays(attributes, count):
    """Names, arrays, and flags of the tuples that are duplicates of other pieces."""
    found = {attributes.GetArrayName(i): vtk_to_numpy(attributes.GetArray(i))
             for i in range(attributes.GetNumberOfArrays())}
    ghosts = found.get("vtkGhostType", numpy.zeros(count, numpy.uint8))
    found["vtkGhostType"] = ghosts & ~numpy.uint8(DUPLICATE)
    return sorted(found), [found[name] for name in sorted(found)], (ghosts & DUPLICATE) != 0


expected, actual = sys.argv[1:3]
paths = sorted(glob.glob(os.path.join(expected, "*.pvtu")))
different = []
total = 0
for path in paths:
    name = os.path.basename(path)
    a, b = read(path), read(os.path.join(actual, name))
    total += len(a[2])
    if not a[2]:
        different.append(name + " (no points)")
    elif a != b:
        different.append("%s (arrays %s, %d and %d points, %d and %d cells)" % (
            name, "are the same" if a[:2] == b[:2] else "differ: %s %s" % (a[:2], b[:2]),
            len(a[2]), len(b[2]), len(a[3]), len(b[3])))
if not paths:
    sys.exit("There are no results in " + expected)
if different:
    sys.exit("These differ:\n  " + "\n  ".join(different))
print("%d results of %d points are the same" % (len(paths), total))
