# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a pair of meshes for the tests: python pair.py FOLDER"""

import random
import sys

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter


def make_mesh(n, seed):
    """A grid of n x n squares over [-10, 10]^2, each cut in two, points inside moved at random."""
    generator = random.Random(seed)
    points = vtkPoints()
    points.SetDataTypeToDouble()
    for j in range(n + 1):
        for i in range(n + 1):
            inside = 0 < i < n and 0 < j < n
            dx, dy = (generator.uniform(-0.25, 0.25) if inside else 0.0 for _ in range(2))
            points.InsertNextPoint(-10 + 20 * (i + dx) / n, -10 + 20 * (j + dy) / n, 0.0)
    triangles = vtkCellArray()
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i
            triangles.InsertNextCell(3, [a, a + 1, a + n + 2])
            triangles.InsertNextCell(3, [a, a + n + 2, a + n + 1])
    mesh = vtkPolyData()
    mesh.SetPoints(points)
    mesh.SetPolys(triangles)
    return mesh


def write(mesh, name):
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(mesh)
    writer.SetFileName(name)
    if not writer.Write():
        raise RuntimeError("cannot write " + name)


if __name__ == "__main__":
    folder = sys.argv[1]
    write(make_mesh(12, 1), folder + "/source.vtp")
    write(make_mesh(12, 2), folder + "/target.vtp")
    write(make_mesh(5, 3), folder + "/mismatched.vtp")
