# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The report of vtkTriangulationPairReport in words, and validation of pairs."""

import re
from dataclasses import replace

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from . import meshes
from .arrays import SYSTEMS, make_mesh, points_of
from .files import Failure, count as number
from .vtkFiltersHomeomorphism import vtkTriangulationPairReport
from .vtkfiles import take_messages

ADVICE = {
    "UseSameMesh": "give the same mesh twice, with different coordinates",
    "SplitMeshes": "split the meshes",
    "Triangulate": "ParaView's Triangulate makes triangles of them",
    "ReadAgain": "the file is corrupt",
    "UseSourceCells": "give the target the source's cells",
    "RepairOrMask": "repair them, or leave them out with --mask-invalid",
    "CutOpen": "cut the surface open along edges, in both meshes alike",
    "MovePointsOrMask": "move points, or leave them out with --mask-invalid",
    "UseOtherSystem": "use another --system, or --linear-where-discordant",
    "UseSmoothSystem": "use --system smooth",
    "RefineLess": "use less --fairness-refinement, or --cubic-bending local",
    "FlattenOrUseTolerance": "project the mesh onto its plane, or use --tolerance",
}
"""What to do, by the remedies of the table of defects."""


def in_words(name, separator=" "):
    """NonManifoldEdge becomes non manifold edge."""
    return re.sub(r"(?<=[a-z])(?=[A-Z0-9])|(?<=[0-9])(?=[A-Z])", separator, name).lower()


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
        self.valid = bool(self.filter.GetValid())
        self.measured = bool(self["Measured"])

    def __getitem__(self, column):
        return self.filter.GetStatistic(column)

    def cells_where(self, side, name, value=1):
        """Ids of the polygons of the source (0) or the target (1) whose cell array has a value."""
        array = self.filter.GetOutput(side).GetCellData().GetArray(name)
        return [] if array is None else numpy.flatnonzero(vtk_to_numpy(array) == value).tolist()

    def problems(self):
        """The defects, a dict for each kind and mesh, with all cell ids and a message."""
        table = self.filter.GetDefects()
        ids = table.GetFieldData().GetAbstractArray("Ids")
        result = []
        for i in range(table.GetNumberOfRows()):
            kind, domain, remedy, outcome, count, first = (
                table.GetValueByName(i, name).ToString() for name in ("Kind", "Domain", "Remedy", "Outcome", "Count", "FirstId")
            )
            cells = [int(ids.GetValue(k)) for k in range(int(first), int(first) + int(count))] if ids else []
            where = f"in the {domain}: " if domain in ("source", "target") else ""
            which = f" ({number(len(cells), 'cell')}: {', '.join(map(str, cells[:10]))}{', ...' if len(cells) > 10 else ''})"
            message = f"{where}{in_words(kind)}{which if cells else ''}: {ADVICE.get(remedy, in_words(remedy))}"
            if outcome != "accepted":
                result.append({"kind": kind, "mesh": domain, "count": len(cells), "cells": cells, "message": message})
        return result

    def statistics(self):
        """The filter's statistics for JSON: a dict, with one each of the source, the target and the systems, in it.
        Values that occur in a cell are dicts with value and cell; what was not measured is left out."""
        table = self.filter.GetStatistics()
        values = {table.GetColumnName(i): self[table.GetColumnName(i)] for i in range(table.GetNumberOfColumns())}
        values = {name: value for name, value in values.items() if numpy.isfinite(value) and value != -1}
        groups = {"Source": "source", "Target": "target", **{name.capitalize(): name for name in SYSTEMS}}
        result = {}
        for name, value in values.items():
            if name.endswith("Cell") and name[:-4] in values:
                continue
            group = next((g for g in groups if name.startswith(g) and name != g), "")
            member = int(value) if value.is_integer() else value
            member = bool(value) if table.GetColumnByName(name).IsA("vtkIntArray") else member
            if name + "Cell" in values:
                member = {"value": value, "cell": int(values[name + "Cell"])}
            into = result.setdefault(groups[group], {}) if group else result
            into[in_words(name[len(group) :], "_")] = member
        return result


def require_map(pair, mask_invalid=False):
    """The pair, without its invalid triangles on request. Raises Failure, with all defects, if it does not define a
    map."""
    report = Report(pair)
    if report.valid:
        return pair
    if not mask_invalid or not report.measured:
        raise Failure(f"{pair.name}: not a valid pair: {'; '.join(p['message'] for p in report.problems())}.")
    kept = numpy.setdiff1d(numpy.arange(pair.source.GetNumberOfPolys()), report.cells_where(0, "Invalid"))
    triangles = meshes.triangles_of(pair.source)[kept]
    shift = pair.shift and replace(pair.shift, triangles=triangles)
    return replace(pair, meshes=[make_mesh(points_of(mesh), triangles) for mesh in pair.meshes], shift=shift)
