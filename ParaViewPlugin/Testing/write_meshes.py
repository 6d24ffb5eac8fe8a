# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the meshes of the tests: source.vtp and target.vtp, the same in three pieces (source.pvtp, target.pvtp),
other.vtp, which is not isomorphic to them, and moving.pvd, the target at three times."""

import math
import os
import sys

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter


def write_mesh(path, intervals, move, rows=None):
    """A triangulated square of side 16 around the origin with moved interior points, or some of its rows."""
    rows = rows or range(intervals)
    points = vtkPoints()
    points.SetDataTypeToDouble()
    width = 16.0 / intervals
    for j in range(rows[0], rows[-1] + 2):
        for i in range(intervals + 1):
            x, y = i * width - 8.0, j * width - 8.0
            if 0 < i < intervals and 0 < j < intervals:
                dx, dy = move(i, j)
                x, y = x + width * dx, y + width * dy
            points.InsertNextPoint(x, y, 0.0)
    triangles = vtkCellArray()
    for j in rows:
        for i in range(intervals):
            a = (j - rows[0]) * (intervals + 1) + i
            b, c, d = a + 1, a + intervals + 2, a + intervals + 1
            for corners in ((a, b, c), (a, c, d)) if (i + j) % 2 else ((a, b, d), (b, c, d)):
                triangles.InsertNextCell(3, corners)
    mesh = vtkPolyData()
    mesh.SetPoints(points)
    mesh.SetPolys(triangles)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(mesh)
    if writer.Write() != 1:
        sys.exit("Cannot write " + path)


def write_mesh_in_pieces(path, intervals, move):
    pieces = ""
    for piece in range(3):
        name = "%s-%d.vtp" % (os.path.basename(path), piece)
        rows = range(intervals * piece // 3, intervals * (piece + 1) // 3)
        write_mesh(os.path.join(os.path.dirname(path), name), intervals, move, rows)
        pieces += '<Piece Source="%s"/>' % name
    with open(path, "w") as file:
        file.write('<VTKFile type="PPolyData" version="0.1" byte_order="LittleEndian"><PPolyData><PPoints>'
                   '<PDataArray type="Float64" Name="Points" NumberOfComponents="3"/></PPoints>'
                   + pieces + '</PPolyData></VTKFile>')


folder = sys.argv[1]
for name, move in (
        ("source", lambda i, j: (0.2 * math.sin(5 * i + 3 * j), 0.2 * math.cos(7 * i + 2 * j))),
        ("target", lambda i, j: (0.2 * math.cos(4 * i + j), 0.2 * math.sin(3 * i + 8 * j)))):
    write_mesh(os.path.join(folder, name + ".vtp"), 6, move)
    write_mesh_in_pieces(os.path.join(folder, name + ".pvtp"), 6, move)
with open(os.path.join(folder, "moving.pvd"), "w") as series:
    series.write('<VTKFile type="Collection" version="0.1"><Collection>')
    for time in range(3):
        name = "moving-%d.vtp" % time
        write_mesh(os.path.join(folder, name), 6,
                   lambda i, j: (0.2 * math.cos(4 * i + j + time), 0.2 * math.sin(3 * i + 8 * j)))
        series.write('<DataSet timestep="%d" file="%s"/>' % (time, name))
    series.write('</Collection></VTKFile>')
write_mesh(os.path.join(folder, "other.vtp"), 5, lambda i, j: (0.0, 0.0))
