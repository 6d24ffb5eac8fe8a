# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""A pair of triangulations made from landmarks, an outline and a hole, and the image of a grid under its map.

In ParaView: load the plugin, then File > Run Script... In a shell, with the plugin's folder in PV_PLUGIN_PATH
or the plugin's file as the second argument:

    pvbatch landmarks.py FOLDER [DifferentiableHomeomorphism.so]

Writes landmarks.png, source-triangulation.vtp, target-triangulation.vtp and mapped-grid.vtp to the folder (default:
Output).
"""

import os
import sys

from paraview.simple import *


# Rotates points by up to 1.5 radians at the center, less far from it, and stretches the figure in x.
ANGLE = "1.5*exp(-coordsX*coordsX - coordsY*coordsY)"
BEND = (f"iHat*1.4*(cos({ANGLE})*coordsX - sin({ANGLE})*coordsY)"
        f" + jHat*(sin({ANGLE})*coordsX + cos({ANGLE})*coordsY)")


def grid_lines(size, lines=16, pieces=400):
    """Grid lines in both directions across a square around the origin, finely subdivided."""
    plane = Plane(Origin=[-size, -size, 0], Point1=[size, -size, 0], Point2=[-size, size, 0],
                  XResolution=pieces, YResolution=pieces)
    families = []
    for axis in "XY":
        coordinate = Calculator(Input=plane, ResultArrayName=axis, Function="coords" + axis)
        families.append(Contour(Input=coordinate, ContourBy=["POINTS", axis], ComputeNormals=0,
                                Isosurfaces=[size * (2 * k / lines - 1) for k in range(1, lines)]))
    return AppendGeometry(Input=families)


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
    rings = Disk(InnerRadius=0.9, OuterRadius=1.6, RadialResolution=2, CircumferentialResolution=13)
    landmarks = MaskPoints(Input=rings, OnRatio=1, GenerateVertices=1, SingleVertexPerCell=1)
    ring = Disk(InnerRadius=0.5, OuterRadius=2.0, RadialResolution=1, CircumferentialResolution=24)
    loops = FeatureEdges(Input=ring, FeatureEdges=0, NonManifoldEdges=0)
    figure = AppendGeometry(Input=[loops, landmarks])
    figures = [figure, Calculator(Input=figure, CoordinateResults=1, Function=BEND)]
    grid = grid_lines(2.0)

    pair = IsomorphicTriangulation(Source=figures[0], Target=figures[1], TargetMinimumAngle=20.0,
                                   MaximumNumberOfAddedPoints=40)
    pair.UpdatePipeline()
    source, target = OutputPort(pair, 0), OutputPort(pair, 1)
    mapped = DifferentiableHomeomorphism(Source=source, Target=target, Data=grid)
    pair.UpdatePropertyInformation()
    print("Added points:", pair.NumberOfAddedPoints)

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
    bar.Title, bar.ComponentTitle = "smallest angle in both domains", ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.TitleFontSize = bar.LabelFontSize = 8
    RenderAllViews()
    for name, port in (("source", source), ("target", target)):
        SaveData(os.path.join(folder, name + "-triangulation.vtp"), proxy=port, DataMode="Binary")
    SaveData(os.path.join(folder, "mapped-grid.vtp"), proxy=mapped, DataMode="Binary")
    SaveScreenshot(os.path.join(folder, "landmarks.png"), layout, ImageResolution=[1500, 700], SeparatorWidth=0)
    print("Wrote landmarks.png and the meshes to", folder)
