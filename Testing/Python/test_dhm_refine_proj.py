# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""A refined pair in PROJ: its piecewise linear map, evaluated by cct, is within the maximum error of Smooth."""

import json
import os
import pathlib
import shutil
import subprocess

import numpy
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

import vtkhomeomorphism
from vtkhomeomorphism.vtkFiltersHomeomorphism import vtkRefinedTriangulationPair

FINLAND = pathlib.Path(
    os.environ.get("DHM_SHARED_DATA", pathlib.Path(__file__).parents[3] / "shared" / "data")
) / "fi_nls_ykj_etrs35fin.json"


def make_mesh(points, triangles):
    """The points' first two columns as a mesh."""
    mesh, positions, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    positions.SetDataTypeToDouble()
    for x, y in points:
        positions.InsertNextPoint(x, y, 0.0)
    for triangle in triangles:
        cells.InsertNextCell(3)
        for point in triangle:
            cells.InsertCellPoint(int(point))
    mesh.SetPoints(positions)
    mesh.SetPolys(cells)
    return mesh


def small_shift():
    """A grid of 5 x 5 points with 2 m of noise in the target."""
    generator = numpy.random.default_rng(5)
    x, y = (grid.ravel() for grid in numpy.meshgrid(numpy.arange(5) * 100.0, numpy.arange(5) * 100.0))
    source = numpy.stack((3400000 + x, 6700000 + y), axis=1)
    target = source + (-2999000, -2500) + generator.uniform(-2, 2, source.shape)
    corners = [(5 * j + i, 5 * j + i + 1, 5 * j + i + 5, 5 * j + i + 6) for j in range(4) for i in range(4)]
    return source, target, [t for a, b, c, d in corners for t in ((a, b, d), (a, d, c))]


def finland():
    if not FINLAND.exists():
        pytest.skip(f"{FINLAND} is absent")
    shift = json.loads(FINLAND.read_text())
    vertices = numpy.array(shift["vertices"])
    return vertices[:, :2], vertices[:, 2:4], shift["triangles"]


@pytest.mark.skipif(not shutil.which("cct"), reason="PROJ's cct is missing")
@pytest.mark.parametrize("shift, maximum_error", [(small_shift, 0.01), (finland, 0.02)])
def test_proj_is_within_the_maximum_error_of_smooth(shift, maximum_error, tmp_path):
    source, target, triangles = shift()
    refine = vtkRefinedTriangulationPair()
    refine.SetSourceData(make_mesh(source, triangles))
    refine.SetTargetData(make_mesh(target, triangles))
    refine.SetMaximumError(maximum_error)
    refine.Update()
    assert refine.GetResult() == refine.REFINED
    finer = [vtk_to_numpy(mesh.GetPoints().GetData())[:, :2] for mesh in (refine.GetOutput(), refine.GetOutput(1))]
    cells = vtk_to_numpy(refine.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
    assert len(cells) > len(triangles)
    file = tmp_path / "shift.json"
    file.write_text(json.dumps({
        "file_type": "triangulation_file",
        "format_version": "1.0",
        "transformed_components": ["horizontal"],
        "vertices_columns": ["source_x", "source_y", "target_x", "target_y"],
        "triangles_columns": ["idx_vertex1", "idx_vertex2", "idx_vertex3"],
        "vertices": numpy.hstack(finer).tolist(),
        "triangles": cells.tolist(),
    }))
    weights = numpy.random.default_rng(7).dirichlet((1, 1, 1), 5000)
    chosen = numpy.array(triangles)[numpy.random.default_rng(8).integers(len(triangles), size=5000)]
    points = numpy.einsum("nk,nkd->nd", weights, numpy.asarray(source)[chosen])

    lines = "".join(f"{x!r} {y!r} 0\n" for x, y in points.tolist())
    output = subprocess.run(
        ["cct", "-d", "6", "+proj=tinshift", f"+file={file}"],
        input=lines, capture_output=True, text=True, check=True,
    ).stdout
    mapped = numpy.array([line.split()[:2] for line in output.splitlines()], dtype=float)
    smooth = vtkhomeomorphism.Homeomorphism(source, target, triangles)(points)
    errors = numpy.linalg.norm(mapped - smooth, axis=1)
    linear = vtkhomeomorphism.Homeomorphism(source, target, triangles, system="linear")(points)
    assert errors.max() <= 1.05 * maximum_error + 1e-6
    # The test has something to find.
    assert numpy.linalg.norm(linear - smooth, axis=1).max() > 1.5 * maximum_error
