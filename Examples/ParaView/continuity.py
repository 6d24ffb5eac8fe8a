# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Carries a grid from one triangulation onto another, and colours the edges by how much the map's Jacobian
jumps there, for Linear and Smooth side by side.

In pvpython or pvbatch:   pvpython continuity.py PLUGIN [FOLDER]
In ParaView: load the plugin (Tools, Manage Plugins), then run this script (Macros, or the Python shell)

Writes continuity.png and the mapped data, mapped-Linear.vtp and mapped-Smooth.vtp, to FOLDER (the current
one by default)."""

import os
import sys

from paraview import simple

arguments = [a for a in sys.argv[1:] if a]
if arguments:
    simple.LoadPlugin(arguments[0], remote=False, ns=vars(simple))
folder = arguments[1] if len(arguments) > 1 else os.getcwd()
os.makedirs(folder, exist_ok=True)

# A square of triangles. Instead of these two sources, read your own meshes:
#   source_mesh = simple.XMLPolyDataReader(FileName=["source.vtp"])
mesh = """
import math
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray
n, moved = 5, {moved}
points, triangles = vtkPoints(), vtkCellArray()
points.SetDataTypeToDouble()
for j in range(n + 1):
    for i in range(n + 1):
        inside = moved and 0 < i < n and 0 < j < n
        dx = 0.25 * math.sin(5 * i + 3 * j) if inside else 0.0
        dy = 0.25 * math.cos(7 * i + 2 * j) if inside else 0.0
        points.InsertNextPoint(i + dx, j + dy, 0.0)
for j in range(n):
    for i in range(n):
        a = j * (n + 1) + i
        b, c, d = a + 1, a + n + 2, a + n + 1
        for corners in ((a, b, c), (a, c, d)) if (i + j) % 2 else ((a, b, d), (b, c, d)):
            triangles.InsertNextCell(3, corners)
self.GetPolyDataOutput().SetPoints(points)
self.GetPolyDataOutput().SetPolys(triangles)
"""
source_mesh = simple.ProgrammableSource(
    registrationName="Source", OutputDataSetType="vtkPolyData", Script=mesh.format(moved=False))
target_mesh = simple.ProgrammableSource(
    registrationName="Target", OutputDataSetType="vtkPolyData", Script=mesh.format(moved=True))
plane = simple.Plane(registrationName="Plane", Origin=[0, 0, 0], Point1=[5, 0, 0], Point2=[0, 5, 0],
                     XResolution=400, YResolution=400)
# Lines to see the map by.
grid = simple.Calculator(
    registrationName="Grid", Input=plane, ResultArrayName="Grid",
    Function="max(cos(6.283185307*5*coordsX), cos(6.283185307*5*coordsY))")

layout = simple.CreateLayout(name="Continuity")
layout.SplitHorizontal(0, 0.5)
for number, system in enumerate(("Linear", "Smooth")):
    view = simple.CreateView("RenderView")
    # The halves of the first cell.
    layout.AssignView(number + 1, view)
    settings = {"Source": source_mesh, "Target": target_mesh, "CoordinateSystem": system}
    mapped = simple.DifferentiableHomeomorphism(
        registrationName="Mapped by " + system, Data=grid, MeasureContinuity=1, **settings)
    # The edges lie over the source; seen over the target, they are mapped as well.
    edges = simple.DifferentiableHomeomorphism(
        registrationName="Edges in " + system, Data=simple.OutputPort(mapped, 1), **settings)
    simple.SaveData(os.path.join(folder, "mapped-%s.vtp" % system), proxy=mapped,
                    DataMode="Binary")

    simple.SetActiveView(view)
    surface = simple.Show(mapped, view)
    simple.ColorBy(surface, ("POINTS", "Grid"))
    colors = simple.GetColorTransferFunction("Grid")
    colors.RGBPoints = [-1.0, 1.0, 1.0, 1.0, 0.9, 1.0, 1.0, 1.0, 0.97, 0.35, 0.45, 0.6, 1.0, 0.3, 0.4, 0.55]
    surface.SetScalarBarVisibility(view, False)
    surface.Ambient, surface.Diffuse = 1.0, 0.0
    lines = simple.Show(edges, view)
    simple.ColorBy(lines, ("CELLS", "JacobianJump"))
    lines.LineWidth = 4
    lines.Position = [0, 0, 0.01]
    lines.Ambient, lines.Diffuse = 1.0, 0.0
    jump = simple.GetColorTransferFunction("JacobianJump")
    lines.SetScalarBarVisibility(view, True)
    bar = simple.GetScalarBar(jump, view)
    bar.Title, bar.ComponentTitle = "Jump of the Jacobian", ""
    bar.Orientation, bar.WindowLocation = "Horizontal", "Lower Center"
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.6, 10
    bar.TitleFontSize = bar.LabelFontSize = 14
    bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]
    bar.AutomaticLabelFormat, bar.LabelFormat = 0, "%.0e"
    bar.AddRangeLabels, bar.UseCustomLabels = 0, 1
    bar.CustomLabels = [1e-12, 1e-9, 1e-6, 1e-3, 1.0]
    title = simple.Show(simple.Text(Text=system), view)
    title.Color, title.FontSize = [0.1, 0.1, 0.1], 20
    title.WindowLocation = "Upper Center"
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    view.InteractionMode = "2D"
    view.CameraPosition, view.CameraFocalPoint = [2.5, 2.2, 10], [2.5, 2.2, 0]
    view.CameraParallelProjection, view.CameraParallelScale = 1, 3.35
# One scale for both, after both have had their say about its range.
jump = simple.GetColorTransferFunction("JacobianJump")
jump.AutomaticRescaleRangeMode = "Never"
jump.UseLogScale = 1
jump.RGBPoints = [1e-12, 1.0, 0.93, 0.6, 1e-8, 0.96, 0.6, 0.3, 1e-4, 0.75, 0.2, 0.4, 1.0, 0.2, 0.05, 0.3]
simple.SaveScreenshot(os.path.join(folder, "continuity.png"), layout, ImageResolution=[1200, 640])
simple.RenderAllViews()
