# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""A pair of triangulations made from landmarks with an outline and a hole, and a grid mapped by it.

In ParaView: load the plugin, then File > Run Script... In a shell, with the plugin's folder in PV_PLUGIN_PATH
or the plugin's file as the second argument:

    pvbatch landmarks.py FOLDER [DifferentiableHomeomorphism.so]

The folder (default: Output) gets landmarks.png, source-triangulation.vtp, target-triangulation.vtp and mapped-grid.vtp.
"""

import math
import os
import random
import sys

from paraview.simple import *


def circle(radius, count):
    angles = [2 * math.pi * k / count for k in range(count)]
    return [(radius * math.cos(a), radius * math.sin(a)) for a in angles]


def bend(x, y):
    """Turns inner points by a right angle, outer ones less, and stretches the whole."""
    angle = 1.5 * math.exp(-(x * x + y * y))
    return 1.4 * (math.cos(angle) * x - math.sin(angle) * y), math.sin(angle) * x + math.cos(angle) * y


def write(path, points, polygons=(), lines=()):
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    data, coordinates = vtkPolyData(), vtkPoints()
    coordinates.SetDataTypeToDouble()
    for x, y in points:
        coordinates.InsertNextPoint(x, y, 0.0)
    data.SetPoints(coordinates)
    for cells, put in ((polygons, data.SetPolys), (lines, data.SetLines)):
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
    return XMLPolyDataReader(registrationName=os.path.basename(path)[:-4], FileName=[path])


def show(proxy, view, color, width, representation="Surface"):
    display = Show(proxy, view)
    display.Representation = representation
    if color:
        ColorBy(display, color)
    else:
        display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = [0.15, 0.2, 0.35]
    display.LineWidth = width
    return display


if __name__ == "__main__":
    folder = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "Output")
    if len(sys.argv) > 2:
        LoadPlugin(sys.argv[2], remote=False, ns=globals())
    if "IsomorphicTriangulation" not in globals():
        sys.exit("The plugin DifferentiableHomeomorphism is not loaded.")
    os.makedirs(folder, exist_ok=True)

    # An outline, a hole, and landmarks between them.
    chance = random.Random(5)
    points = circle(2.0, 24) + circle(0.5, 12)
    while len(points) < 76:
        x, y = chance.uniform(-2, 2), chance.uniform(-2, 2)
        if 0.6 < math.hypot(x, y) < 1.85:
            points.append((x, y))
    loops = [range(24), range(24, 36)]
    figures = [write(os.path.join(folder, "source-figure.vtp"), points, loops),
               write(os.path.join(folder, "target-figure.vtp"), [bend(*p) for p in points], loops)]
    steps = [k / 100 for k in range(-200, 201)]
    rows = [[(x, y) if across else (y, x) for x in steps] for y in steps[::25] for across in (True, False)]
    grid = write(os.path.join(folder, "grid.vtp"), sum(rows, []),
                 lines=[(k, k + 1) for k in range(len(rows) * len(steps) - 1) if (k + 1) % len(steps)])

    pair = IsomorphicTriangulation(Source=figures[0], Target=figures[1], TargetMinimumAngle=20.0,
                                   MaximumNumberOfAddedPoints=40)
    pair.UpdatePipeline()
    source, target = OutputPort(pair, 0), OutputPort(pair, 1)
    mapped = DifferentiableHomeomorphism(Source=source, Target=target, Data=grid)
    pair.UpdatePropertyInformation()
    print("Points added:", pair.NumberOfAddedPoints)

    layout = CreateLayout("A pair made from landmarks")
    layout.SetSize(1500, 700)
    views = [CreateView("RenderView"), CreateView("RenderView")]
    AssignViewToLayout(view=views[0], layout=layout, hint=0)
    layout.SplitHorizontal(0, 0.45)
    AssignViewToLayout(view=views[1], layout=layout, hint=2)
    for view, mesh, lines in zip(views, (source, target), (grid, mapped)):
        view.UseColorPaletteForBackground = 0
        view.Background = [1.0, 1.0, 1.0]
        view.OrientationAxesVisibility = 0
        view.InteractionMode = "2D"
        display = show(mesh, view, ("CELLS", "MinimumAngle"), 1.0, "Surface With Edges")
        display.EdgeColor = [0.3, 0.4, 0.8]
        colors = GetColorTransferFunction("MinimumAngle")
        colors.RescaleTransferFunction(0.0, 60.0)
        colors.ApplyPreset("Viridis (matplotlib)", True)
        show(lines, view, None, 2.0)
        ResetCamera(view)
        view.CameraParallelProjection = 1
    bar = GetScalarBar(colors, views[1])
    bar.Visibility = 1
    bar.Title, bar.ComponentTitle = "smallest angle of both", ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.TitleFontSize = bar.LabelFontSize = 8
    RenderAllViews()
    for name, port in (("source", source), ("target", target)):
        SaveData(os.path.join(folder, name + "-triangulation.vtp"), proxy=port, DataMode="Binary")
    SaveData(os.path.join(folder, "mapped-grid.vtp"), proxy=mapped, DataMode="Binary")
    SaveScreenshot(os.path.join(folder, "landmarks.png"), layout, ImageResolution=[1500, 700], SeparatorWidth=0)
    print("Wrote landmarks.png and the meshes to", folder)
