# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The report of vtkTriangulationPairReport in words, and validation of pairs."""

from dataclasses import replace

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from . import meshes
from .files import Failure
from .vtkFiltersHomeomorphism import vtkTriangulationPairReport
from .vtkfiles import take_messages

WORDS = {
    "PointCountsDiffer": "the meshes have different numbers of points",
    "CellCountsDiffer": "the meshes have different numbers of triangles",
    "TooManyTriangles": "there are more triangles than can be numbered",
    "NotTriangles": "not triangles ({}); ParaView's Triangulate makes triangles of them",
    "BadConnectivity": "points that do not exist ({})",
    "ConnectivityDiffers": "triangles with other points in the target than in the source ({})",
    "RepeatedCorner": "triangles with a point twice ({})",
    "NotFinite": "coordinates that are not finite numbers ({})",
    "DegenerateTriangle": "triangles without area ({})",
    "NonManifoldEdge": "non-manifold edges, with more than two triangles ({})",
    "NonOrientable": "a surface that is not orientable",
    "Flipped": "flipped triangles ({})",
    "Overlapping": "overlapping triangles ({})",
    "Discordant": "discordant triangles ({})",
}
"""Kinds of defects, and how many and where."""


class Report:
    """The filter's report on a pair."""

    def __init__(self, pair, maps=False, continuity=False):
        self.pair = pair
        self.filter = vtkTriangulationPairReport()
        self.filter.SetSourceData(pair.source)
        self.filter.SetTargetData(pair.target)
        self.filter.SetMeasureMaps(maps)
        self.filter.SetMeasureContinuity(continuity)
        self.filter.Update()
        take_messages()
        self.valid = self.filter.GetValid()
        self.measured = bool(self["Measured"])

    def __getitem__(self, column):
        return self.filter.GetStatistic(column)

    def cells(self, side, name):
        """A cell array of the source (0) or the target (1), or None."""
        array = self.filter.GetOutput(side).GetCellData().GetArray(name)
        return None if array is None else vtk_to_numpy(array)

    def cells_where(self, side, name, value=1):
        """Ids of the polygons whose cell array has a value. (Polygons follow vertices and lines in a mesh's cells.)"""
        array = self.cells(side, name)
        return [] if array is None else numpy.flatnonzero(array == value).tolist()

    @property
    def defects(self):
        """A dict for each kind of defect."""
        table = self.filter.GetDefects()
        columns = {table.GetColumnName(i): table.GetColumn(i) for i in range(table.GetNumberOfColumns())}
        return [
            {"kind": columns["Kind"].GetValue(i), "mesh": columns["Mesh"].GetValue(i),
             "count": int(columns["Count"].GetValue(i)), "first_cell": int(columns["FirstCell"].GetValue(i))}
            for i in range(table.GetNumberOfRows())
        ]

    def sentences(self):
        """The defects in words."""
        for defect in self.defects:
            first = f", the first is cell {defect['first_cell']}" if defect["first_cell"] >= 0 else ""
            text = WORDS.get(defect["kind"], defect["kind"]).format(f"{defect['count']}{first}")
            yield text if defect["mesh"] not in ("source", "target") else f"in the {defect['mesh']} {text}"


def refuse(pair, can_mask=True):
    """Raises Failure with all defects of a pair; returns if it has none."""
    report = Report(pair)
    if report.valid:
        return
    advice = " The option --mask-invalid leaves invalid triangles out." if can_mask and report.measured else ""
    raise Failure(f"{pair.name}: not a valid pair: {'; '.join(report.sentences())}.{advice}")


def require_map(pair, mask_invalid=False):
    """The pair, without its invalid triangles on request. Raises Failure if it does not define a map."""
    report = Report(pair)
    if report.valid:
        return pair
    if not mask_invalid or not report.measured:
        refuse(pair)
    kept = numpy.setdiff1d(numpy.arange(pair.source.GetNumberOfPolys()), report.cells_where(0, "Invalid"))
    triangles = meshes.triangles_of(pair.source)[kept]
    shift = pair.shift and replace(pair.shift, triangles=triangles)
    return replace(pair, meshes=[meshes.make_mesh(meshes.points_of(mesh), triangles) for mesh in pair.meshes], shift=shift)
