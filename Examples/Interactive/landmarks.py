#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Drag landmarks of a source (left) or a target (right). The triangulations, the grid and the image are updated.

Landmarks that do not agree with their neighbors are red, and so are the triangles that would fold if the source's
Delaunay triangulation were reused for the target. There are 300 landmarks on a generated image."""

import time

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from vtkhomeomorphism import vtkDifferentiableHomeomorphism, vtkIsomorphicTriangulation
from vtkhomeomorphism.images import Grid
from vtkhomeomorphism.arrays import as_cells, as_points, make_mesh, points_of


def generated():
    """Landmarks on an image of 400 x 300 pixels (y upwards), and the image."""
    source = numpy.random.default_rng(1).uniform(0.03, 0.97, (300, 2)) * [400, 300]
    x, y = numpy.meshgrid(numpy.arange(400), numpy.arange(300))
    rings = 0.5 + 0.5 * numpy.cos(numpy.hypot(x - 200, y - 150) / 6)
    pixels = numpy.stack([250 - 75 * rings, 247 - 37 * rings, 238 - 18 * rings], axis=-1).astype(numpy.uint8)
    return source, source + 14 * numpy.sin(source[:, ::-1] / 25), Grid(400, 300).to_vtk(pixels)


def set_up(thing, **values):
    """Calls the setters of a VTK object with tuples of values."""
    for name, value in values.items():
        getattr(thing, "Set" + name)(*value)
    return thing


class Session:
    def __init__(self, source, target, image):
        width, height, _ = image.GetDimensions()
        frame = (-0.1 * width, 1.1 * width, -0.1 * height, 1.1 * height)
        self.figures = [make_mesh(points) for points in (source, target)]
        self.pair = [vtk.vtkPolyData(), vtk.vtkPolyData()]
        self.maker, self.delaunay = vtkIsomorphicTriangulation(), vtk.vtkDelaunay2D()
        for sender in (self.maker, self.maker.GetExecutive()):
            sender.AddObserver("ErrorEvent", lambda *_: None)
        for side, figure in enumerate(self.figures):
            self.maker.SetInputData(side, figure)
        set_up(self.maker, SourceFrame=frame, TargetFrame=frame)
        self.delaunay.SetInputData(self.figures[0])
        plane = set_up(vtk.vtkPlaneSource(), Origin=(0, 0, 0), Point1=(width - 1, 0, 0), Point2=(0, height - 1, 0),
                       Resolution=(80, 60))
        plane.Update()
        t = numpy.linspace(0, 1, 81)
        across = [numpy.column_stack(p) for k in range(17) for p in (
            (numpy.full(81, width * k / 16), height * t), (width * t, numpy.full(81, height * k / 16)))]
        lines = make_mesh(numpy.vstack(across))
        lines.SetLines(as_cells(numpy.arange(len(across) * 81).reshape(-1, 81)))
        self.window = set_up(vtk.vtkRenderWindow(), Size=(1000, 420), MultiSamples=(0,))
        self.interactor = set_up(vtk.vtkRenderWindowInteractor(), RenderWindow=(self.window,),
                                 InteractorStyle=(vtk.vtkInteractorStyleUser(),))
        self.texture = set_up(vtk.vtkTexture(), InputData=(image,))
        self.maps, self.renderers, self.widgets, self.dots, self.active = [], [], [], [], [0, 0]
        for side in (0, 1):
            viewport = (0.5 * side, 0, 0.5 + 0.5 * side, 1)
            self.renderers.append(set_up(vtk.vtkRenderer(), Viewport=viewport, Background=(1, 1, 1)))
            self.window.AddRenderer(self.renderers[side])
            for data, color, depth in ((plane.GetOutput(), None, -1), (lines, (0.2, 0.4, 0.2), 0)):
                if side:
                    self.maps.append(set_up(vtkDifferentiableHomeomorphism(), SourceData=(self.pair[0],),
                                            TargetData=(self.pair[1],), DataObject=(data,)))
                self.show(side, None if side else data, color, depth)
            self.show(side, self.pair[side], (0.3, 0.4, 0.8), 1).GetProperty().SetRepresentationToWireframe()
            self.dots.append(self.show(side, vtk.vtkPolyData(), None, 3))
            self.dots[side].GetProperty().SetPointSize(6)
            self.renderers[side].GetActiveCamera().ParallelProjectionOn()
            self.renderers[side].ResetCamera(*frame, -1, 1)
            widget = set_up(vtk.vtkHandleWidget(), Representation=(vtk.vtkPointHandleRepresentation2D(),),
                            Interactor=(self.interactor,), DefaultRenderer=(self.renderers[side],),
                            CurrentRenderer=(self.renderers[side],))
            # While dragging, use the first pair found, with as many points as it needs. Afterwards, find one with few.
            widget.AddObserver("InteractionEvent", lambda *_, side=side: self.drag(side, 1000))
            widget.AddObserver("EndInteractionEvent", lambda *_, side=side: self.drag(side, -1))
            self.widgets.append(widget)
        self.folds, self.text = self.show(1, vtk.vtkPolyData(), (0.9, 0.1, 0.1), 2), vtk.vtkTextActor()
        self.folds.GetProperty().SetOpacity(0.6)
        self.text.GetTextProperty().SetColor(0, 0, 0)
        self.renderers[0].AddActor2D(self.text)
        self.interactor.AddObserver("MouseMoveEvent", self.hover, 1.0)
        self.update()

    def show(self, side, data, color, depth):
        actor, mapper = vtk.vtkActor(), set_up(vtk.vtkPolyDataMapper(), ScalarVisibility=(depth == 3,))
        mapper.SetInputConnection(self.maps[-1].GetOutputPort()) if data is None else mapper.SetInputData(data)
        set_up(actor, Mapper=(mapper,), Position=(0, 0, depth), Texture=(self.texture if depth == -1 else None,))
        set_up(actor.GetProperty(), Color=color or (1, 1, 1), Lighting=(False,))
        self.renderers[side].AddActor(actor)
        return actor

    def to_display(self, side, point):
        self.renderers[side].SetWorldPoint(*point, 1)
        self.renderers[side].WorldToDisplay()
        return self.renderers[side].GetDisplayPoint()[:2]

    def hover(self, *_):
        """The handle of the side below the mouse waits at the nearest landmark."""
        side = int(self.interactor.GetEventPosition()[0] >= self.window.GetSize()[0] / 2)
        if not any(widget.GetWidgetState() for widget in self.widgets):
            shown = [self.to_display(side, point) for point in points_of(self.figures[side])]
            self.active[side] = int(numpy.hypot(*numpy.subtract(shown, self.interactor.GetEventPosition()).T).argmin())
            self.widgets[side].GetRepresentation().SetDisplayPosition((*shown[self.active[side]], 0))

    def drag(self, side, limit):
        self.maker.SetMaximumNumberOfAddedPoints(limit)
        self.maker.SetOptimizeAddedPoints(limit < 0)
        points = points_of(self.figures[side]).copy()
        points[self.active[side], :2] = self.widgets[side].GetRepresentation().GetWorldPosition()[:2]
        self.figures[side].SetPoints(as_points(points)[0])
        self.update()

    def update(self):
        start = time.perf_counter()
        points = [points_of(figure)[:, :2] for figure in self.figures]
        self.maker.Update()
        self.delaunay.Update()
        cells = vtk_to_numpy(self.delaunay.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
        areas = [numpy.cross(p[cells[:, 1]] - p[cells[:, 0]], p[cells[:, 2]] - p[cells[:, 0]]) for p in points]
        self.folded = cells[areas[0] * areas[1] <= 0]
        self.folds.GetMapper().SetInputData(make_mesh(points[1], self.folded))
        # If landmarks are outside of the frame or coincide, keep the last pair.
        valid = self.maker.GetNumberOfProblems() == 0
        for side in (0, 1) if valid else ():
            self.pair[side].ShallowCopy(self.maker.GetOutput(side))
            residuals = vtk_to_numpy(self.pair[0].GetPointData().GetArray("LandmarkResidual"))[: len(points[0])]
            self.suspicious = residuals > 6 * numpy.quantile(residuals, 0.8)
            colors = numpy.where(self.suspicious[:, None], [230, 0, 0], [0, 90, 30]).astype(numpy.uint8)
            dots = make_mesh(points[side])
            dots.SetVerts(as_cells(numpy.arange(len(points[0]))[:, None]))
            dots.GetPointData().SetScalars(numpy_to_vtk(colors, deep=True))
            self.dots[side].GetMapper().SetInputData(dots)
        made = f"{self.maker.GetNumberOfAddedPoints()} points added" if valid else self.maker.GetProblemMessage(0)
        self.text.SetInput(f" Delaunay reused: {len(self.folded)} triangles fold. Made for both: 0 fold, {made}. "
                           f"{1000 * (time.perf_counter() - start):.0f} ms")


if __name__ == "__main__":
    session = Session(*generated())
    session.window.Render()
    for widget in session.widgets:
        widget.On()
    session.interactor.Start()
