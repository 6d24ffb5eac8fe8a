# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Differentiability of the map between two triangulations, for the three coordinate systems side by side: a
grid mapped from one triangulation to another, over the images of the edges, colored by the jump of the Jacobian.

In ParaView: load the plugin, then File > Run Script... In a shell, with the plugin's folder in PV_PLUGIN_PATH
or the plugin's file as the second argument:

    pvbatch continuity.py FOLDER [DifferentiableHomeomorphism.so]

The folder (default: Output) gets continuity.png, and for each system grid-SYSTEM.vtp and edges-SYSTEM.vtp.
"""

import math
import os
import random
import sys

from paraview.simple import *

INTERVALS = 5
SYSTEMS = "Linear", "Contour", "Smooth"


def write(path, points, triangles=(), lines=()):
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    data.GetPoints().SetDataTypeToDouble()
    for x, y in points:
        data.GetPoints().InsertNextPoint(x, y, 0.0)
    for cells, put in (triangles, data.SetPolys), (lines, data.SetLines):
        array = vtkCellArray()
        for cell in cells:
            array.InsertNextCell(len(cell), list(cell))
        put(array)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(data)
    # VTK before 9.4 cannot read appended data with every version of expat.
    writer.SetDataModeToBinary()
    writer.Write()


def mesh_points(seed):
    """The points of a triangulated square, with interior points moved at random."""
    chance = random.Random(seed)
    points = []
    for j in range(INTERVALS + 1):
        for i in range(INTERVALS + 1):
            radius, angle = 0.3 * math.sqrt(chance.random()), 2.0 * math.pi * chance.random()
            if not (0 < i < INTERVALS and 0 < j < INTERVALS):
                radius = 0.0
            points.append(((i + radius * math.cos(angle)) / INTERVALS,
                           (j + radius * math.sin(angle)) / INTERVALS))
    return points


def mesh_triangles():
    triangles = []
    for j in range(INTERVALS):
        for i in range(INTERVALS):
            a = j * (INTERVALS + 1) + i
            b, c, d = a + 1, a + INTERVALS + 2, a + INTERVALS + 1
            triangles += ((a, b, c), (a, c, d)) if (i + j) % 2 else ((a, b, d), (b, c, d))
    return triangles


def write_grid(path, lines=20, pieces=1000):
    """Grid lines in both directions, subdivided finely enough to show curvature and creases."""
    points = []
    for k in range(lines + 1):
        points += [(k / lines, i / pieces) for i in range(pieces + 1)]
        points += [(i / pieces, k / lines) for i in range(pieces + 1)]
    write(path, points, lines=[range(first, first + pieces + 1)
                               for first in range(0, len(points), pieces + 1)])


def color_by_jump(display):
    ColorBy(display, ("CELLS", "JacobianJump"))
    colors = GetColorTransferFunction("JacobianJump")
    colors.AutomaticRescaleRangeMode = "Never"
    # On a logarithmic scale: rounding errors at one end, creases at the other.
    colors.RGBPoints = [1e-9, 0.10, 0.35, 0.75,
                        1e-6, 0.45, 0.75, 0.85,
                        1e-3, 0.98, 0.80, 0.35,
                        1e0, 0.80, 0.05, 0.10]
    colors.ColorSpace = "Lab"
    colors.UseLogScale = 1
    colors.NanColor = [0.6, 0.6, 0.6]
    return colors


def show_system(system, source, target, grid, view):
    """Shows the mapped grid over the images of the edges; returns the proxies to be saved."""
    settings = {"Source": source, "Target": target, "CoordinateSystem": system,
                "DiscordantTriangles": "Use Linear"}
    carried = DifferentiableHomeomorphism(registrationName="Grid " + system, Data=grid, **settings)
    display = Show(carried, view)
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = [0.45, 0.45, 0.5]
    display.LineWidth = 2.0
    display.RenderLinesAsTubes = 1
    # Called Position before ParaView 5.13.
    name = "Translation" if "Translation" in display.ListProperties() else "Position"
    setattr(display, name, [0.0, 0.0, 0.01])

    measured = JacobianContinuity(registrationName="Measured " + system, **settings)
    # The edges are those of the source; the map moves them to the target.
    edges = DifferentiableHomeomorphism(registrationName="Edges " + system, Data=measured, **settings)
    display = Show(edges, view)
    display.LineWidth = 6.0
    # Plain wide lines may have gaps and be thinner where they are oblique. Unshaded, like the color scale.
    display.RenderLinesAsTubes = 1
    display.Ambient = 1.0
    display.Diffuse = 0.0
    colors = color_by_jump(display)

    title = Text(registrationName="Title " + system, Text=system)
    display = Show(title, view)
    display.WindowLocation = "Upper Center"
    display.FontSize = 24
    display.Color = [0.0, 0.0, 0.0]
    return carried, edges, colors


if __name__ == "__main__":
    folder = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "Output")
    if len(sys.argv) > 2:
        LoadPlugin(sys.argv[2], remote=False, ns=globals())
    if "JacobianContinuity" not in globals():
        sys.exit("The plugin DifferentiableHomeomorphism is not loaded.")
    os.makedirs(folder, exist_ok=True)

    write_grid(os.path.join(folder, "grid.vtp"))
    for name, seed in ("source", 3), ("target", 8):
        write(os.path.join(folder, name + ".vtp"), mesh_points(seed), mesh_triangles())
    source, target, grid = [
        XMLPolyDataReader(registrationName=name, FileName=[os.path.join(folder, name + ".vtp")])
        for name in ("source", "target", "grid")]

    layout = CreateLayout("Where is the map differentiable?")
    layout.SetSize(1920, 800)
    left = CreateView("RenderView")
    AssignViewToLayout(view=left, layout=layout, hint=0)
    layout.SplitHorizontal(0, 1.0 / 3.0)
    middle = CreateView("RenderView")
    AssignViewToLayout(view=middle, layout=layout, hint=2)
    layout.SplitHorizontal(2, 0.5)
    right = CreateView("RenderView")
    AssignViewToLayout(view=right, layout=layout, hint=6)

    for system, view in zip(SYSTEMS, (left, middle, right)):
        view.UseColorPaletteForBackground = 0
        view.Background = [1.0, 1.0, 1.0]
        view.OrientationAxesVisibility = 0
        view.InteractionMode = "2D"
        carried, edges, colors = show_system(system, source, target, grid, view)
        for name, result in ("grid", carried), ("edges", edges):
            SaveData(os.path.join(folder, "%s-%s.vtp" % (name, system)), proxy=result,
                     DataMode="Binary")

    bar = GetScalarBar(colors, middle)
    bar.Visibility = 1
    bar.Title = "jump of the Jacobian across the edge, relative"
    bar.ComponentTitle = ""
    bar.Orientation = "Horizontal"
    bar.WindowLocation = "Any Location"
    bar.Position = [0.1, 0.02]
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.TitleFontSize = bar.LabelFontSize = 18
    bar.ScalarBarLength = 0.8
    bar.ScalarBarThickness = 16
    bar.AddRangeLabels = 0
    bar.DrawTickMarks = 0
    bar.UseCustomLabels = 1
    bar.CustomLabels = [1e-9, 1e-6, 1e-3, 1.0]

    # The first screenshot of a view moves its camera.
    RenderAllViews()
    for view in left, middle, right:
        view.CameraParallelProjection = 1
        view.CameraPosition = [0.5, 0.45, 3.0]
        view.CameraFocalPoint = [0.5, 0.45, 0.0]
        view.CameraViewUp = [0.0, 1.0, 0.0]
        view.CameraParallelScale = 0.65
    RenderAllViews()
    SaveScreenshot(os.path.join(folder, "continuity.png"), layout, ImageResolution=[1920, 800],
                   SeparatorWidth=0, FontScaling="Do not scale fonts")
    # Views in a window have other aspect ratios.
    for view in left, middle, right:
        ResetCamera(view)
        view.CameraParallelScale *= 0.75
    RenderAllViews()
    SetActiveSource(FindSource("Measured Contour"))
    print("Wrote continuity.png, grid-*.vtp and edges-*.vtp to", folder)
