# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shows where the map between two triangulations is differentiable, for the systems Linear, Contour and Smooth side by
side: the image of a grid, and the images of the edges, colored by the jump of the Jacobian.

In ParaView: load the plugin, then File > Run Script... In a shell, with the plugin's folder in PV_PLUGIN_PATH
or the plugin's file as the second argument:

    pvbatch continuity.py FOLDER [DifferentiableHomeomorphism.so]

Writes continuity.png, and grid-SYSTEM.vtp and edges-SYSTEM.vtp for each system, to the folder (default: Output).
"""

import os
import sys

from paraview.simple import *

INTERVALS = 5
SYSTEMS = "Linear", "Contour", "Smooth"


def moved(mesh, name, x, y):
    """The triangles, with displaced interior points."""
    fade = "1.3*coordsX*(1 - coordsX)*coordsY*(1 - coordsY)"
    return Calculator(registrationName=name, Input=mesh, CoordinateResults=1,
                      Function=f"coords + {fade}*(iHat*sin({x}) + jHat*sin({y}))")


def grid_lines(name, lines=20, pieces=400):
    """Grid lines in both directions, subdivided finely enough to show curvature and creases."""
    plane = Plane(Origin=[0, 0, 0], Point1=[1, 0, 0], Point2=[0, 1, 0], XResolution=pieces, YResolution=pieces)
    parts = [FeatureEdges(Input=plane, FeatureEdges=0, NonManifoldEdges=0)]
    for axis in "XY":
        coordinate = Calculator(Input=plane, ResultArrayName=axis, Function="coords" + axis)
        parts.append(Contour(Input=coordinate, ContourBy=["POINTS", axis], ComputeNormals=0,
                             Isosurfaces=[k / lines for k in range(1, lines)]))
    return AppendGeometry(registrationName=name, Input=parts)


def color_by_jump(display):
    ColorBy(display, ("CELLS", "JacobianJump"))
    colors = GetColorTransferFunction("JacobianJump")
    colors.AutomaticRescaleRangeMode = "Never"
    # A logarithmic scale, with rounding errors at one end and creases at the other.
    colors.RGBPoints = [1e-9, 0.10, 0.35, 0.75,
                        1e-6, 0.45, 0.75, 0.85,
                        1e-3, 0.98, 0.80, 0.35,
                        1e0, 0.80, 0.05, 0.10]
    colors.ColorSpace = "Lab"
    colors.UseLogScale = 1
    colors.NanColor = [0.6, 0.6, 0.6]
    return colors


def show_system(system, source, target, grid, view):
    """Shows the mapped grid over the images of the edges. Returns the proxies to be saved, and the colors."""
    settings = {"Source": source, "Target": target, "CoordinateSystem": system,
                "DiscordantTriangles": "Use Linear"}
    mapped = DifferentiableHomeomorphism(registrationName="Grid " + system, Data=grid, **settings)
    display = Show(mapped, view)
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = [0.45, 0.45, 0.5]
    display.LineWidth = 2.0
    display.RenderLinesAsTubes = 1
    # The property was called Position before ParaView 5.13.
    name = "Translation" if "Translation" in display.ListProperties() else "Position"
    setattr(display, name, [0.0, 0.0, 0.01])

    measured = JacobianContinuity(registrationName="Measured " + system, **settings)
    # The edges are those of the source; the map moves them to the target.
    edges = DifferentiableHomeomorphism(registrationName="Edges " + system, Data=measured, **settings)
    display = Show(edges, view)
    display.LineWidth = 6.0
    # Wide lines that are not tubes may have gaps. Do not shade them, so that colors match the color scale.
    display.RenderLinesAsTubes = 1
    display.Ambient = 1.0
    display.Diffuse = 0.0
    colors = color_by_jump(display)

    title = Text(registrationName="Title " + system, Text=system)
    display = Show(title, view)
    display.WindowLocation = "Upper Center"
    display.FontSize = 24
    display.Color = [0.0, 0.0, 0.0]
    return mapped, edges, colors


if __name__ == "__main__":
    folder = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "Output")
    if len(sys.argv) > 2:
        LoadPlugin(sys.argv[2], remote=False, ns=globals())
    if "JacobianContinuity" not in globals():
        sys.exit("The plugin DifferentiableHomeomorphism is not loaded.")
    os.makedirs(folder, exist_ok=True)

    triangles = Triangulate(Input=Plane(
        Origin=[0, 0, 0], Point1=[1, 0, 0], Point2=[0, 1, 0], XResolution=INTERVALS, YResolution=INTERVALS))
    source = moved(triangles, "source", "19*coordsX + 31*coordsY", "37*coordsX - 17*coordsY")
    target = moved(triangles, "target", "29*coordsX - 41*coordsY", "23*coordsX + 13*coordsY + 1")
    grid = grid_lines("grid")

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
        mapped, edges, colors = show_system(system, source, target, grid, view)
        for name, result in ("grid", mapped), ("edges", edges):
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

    # Render once first, because the first rendering of a view resets its camera.
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
    # In a window, views have different aspect ratios.
    for view in left, middle, right:
        ResetCamera(view)
        view.CameraParallelScale *= 0.75
    RenderAllViews()
    SetActiveSource(FindSource("Measured Contour"))
    print("Wrote continuity.png, grid-*.vtp and edges-*.vtp to", folder)
