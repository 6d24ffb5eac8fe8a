# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The results of vtkTriangulationPairReport for dhm check, and validation of pairs."""

import re
from dataclasses import replace

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from .arrays import SYSTEMS, make_mesh, points_of, rename, triangles_of
from .files import Failure
from .vtkFiltersHomeomorphism import vtkTriangulationPairReport
from .vtkfiles import take_messages

OPTIONS = {"MaskInvalidTriangles": "--mask-invalid", "DiscordantTriangles": "--linear-where-discordant",
           "FairnessRefinement": "--fairness", "CubicBending": "--bending", "Tolerance": "--tolerance"}
"""The names of options in messages of filters, and those of dhm."""
ADVICE = {
    "Triangulate": "Write both meshes to one file (dhm convert -o both.vtp), and triangulate that (ParaView's "
                   "Triangulate), so that both are cut along the same diagonals.",
    "RepairOrMask": "Repair them in both meshes, or leave them out (--mask-invalid).",
    "MovePointsOrMask": "Move points, or leave them out (--mask-invalid).",
}
"""Remedies whose text in the filters is for programs, and the text for users of dhm."""


def in_words(name):
    """LargestAreaRatio becomes largest_area_ratio."""
    return re.sub(r"(?<=[a-z])(?=[A-Z0-9])|(?<=[0-9])(?=[A-Z])", "_", name).lower()


class Report:
    """The filter's report on a pair."""

    def __init__(self, pair, measure=False):
        self.filter = vtkTriangulationPairReport()
        self.filter.SetSourceData(pair.source)
        self.filter.SetTargetData(pair.target)
        self.filter.SetMeasureMaps(measure)
        self.filter.SetMeasureContinuity(measure)
        self.filter.Update()
        take_messages()
        self.valid, self.measured = (bool(self.filter.GetStatistic(name)) for name in ("Valid", "Measured"))

    def cells_where(self, side, name, value=1):
        """Ids of the polygons of the source (0) or the target (1) whose cell array has a value."""
        array = self.filter.GetOutput(side).GetCellData().GetArray(name)
        return [] if array is None else numpy.flatnonzero(vtk_to_numpy(array) == value).tolist()

    def problems(self):
        """The defects, one dict for each kind and mesh, with all cell ids and a message."""
        table, result = self.filter.GetDefects(), []
        ids = table.GetFieldData().GetAbstractArray("Ids")
        for i in range(table.GetNumberOfRows()):
            row = {table.GetColumnName(k): table.GetValue(i, k).ToString() for k in range(table.GetNumberOfColumns())}
            if row["Outcome"] == "accepted":
                continue
            first, advice = int(row["FirstId"]), ADVICE.get(row["Remedy"])
            cells = [int(ids.GetValue(k)) for k in range(first, first + int(row["Count"]))] if ids else []
            message = f"{row['Defect']}. {advice}" if advice else rename(row["Message"], OPTIONS)
            result.append({"kind": row["Kind"], "mesh": row["Domain"], "count": len(cells), "cells": cells,
                           "message": message})
        return result

    def statistics(self):
        """The filter's statistics for JSON: a dict that contains one dict each for the source, the target and the
        systems. Values that occur in a cell are dicts with value and cell; values not measured are left out."""
        table, groups = self.filter.GetStatistics(), ("source", "target", *SYSTEMS)
        columns = {table.GetColumnName(k): table.GetColumn(k) for k in range(table.GetNumberOfColumns())}
        result = {name: {} for name in groups}
        kinds = {"vtkIntArray": bool, "vtkIdTypeArray": int}
        for name, column in columns.items():
            kind, value = kinds.get(column.GetClassName(), float), column.GetTuple1(0)
            is_cell_of_another = name.endswith("Cell") and name[:-4] in columns
            if is_cell_of_another or not numpy.isfinite(value) or (kind, value) == (int, -1):
                continue
            group = next((g for g in groups if name.lower().startswith(g) and name.lower() != g), "")
            cell = columns.get(name + "Cell")
            value = {"value": kind(value), "cell": int(cell.GetTuple1(0))} if cell else kind(value)
            (result[group] if group else result)[in_words(name[len(group) :])] = value
        return {name: value for name, value in result.items()
                if name not in SYSTEMS or "smallest_determinant" in value}


def require_map(pair, mask_invalid=False):
    """The pair, on request without its invalid triangles. Raises Failure, with all defects, if it does not define a
    map."""
    report = Report(pair)
    if report.valid:
        return pair
    if not mask_invalid or not report.measured:
        raise Failure(f"{pair.name}: not a valid pair: {' '.join(p['message'] for p in report.problems())}")
    kept = numpy.setdiff1d(numpy.arange(pair.source.GetNumberOfPolys()), report.cells_where(0, "Invalid"))
    triangles = triangles_of(pair.source)[kept]
    shift = pair.shift and replace(pair.shift, triangles=triangles)
    return replace(pair, meshes=[make_mesh(points_of(mesh), triangles) for mesh in pair.meshes], shift=shift)
