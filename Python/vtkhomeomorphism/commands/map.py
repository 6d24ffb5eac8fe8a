# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm map"""

import click

from .. import options
from ..data import Data, data_options
from ..mapping import PointMap, choose_system


@click.command("map")
@data_options
@options.map_settings("smooth; for a PROJ triangulation file linear, which is its official meaning")
@options.inverse
@options.crs
@click.option("--densify", type=options.POSITIVE, metavar="LENGTH", help="Divide longer segments of vector data first.")
@click.option("-j", "--jacobian", is_flag=True, help="Add the array Jacobian: the derivative, 9 numbers row by row.")
@click.option("--determinant", is_flag=True, help="Add the array JacobianDeterminant: the ratio of areas.")
@click.option("--triangle-id", is_flag=True, help="Add the array TriangleId: the cell id of each point's triangle.")
@click.option("--vectors", type=click.Choice(["active", "all", "none"]), default="active",
              help="Vectors, normals and tensors to transform with the points.")
@options.pair_files("SOURCE [TARGET] DATA")
def command(inputs, output, columns, require_inside, settings, inverse, crs, densify, jacobian, determinant,
            triangle_id, vectors):
    """Map data from the source's domain to the target's.

    DATA is a table of points (.csv .txt .xyz), vector data (.gpkg .geojson .shp .fgb), a mesh (.obj .off .ply .stl),
    or a VTK file (.vtp .vtu .vts .vtr .vti .vtm .vtk).

    Points outside the domain become nan and have the value 0 in vtkValidPointMask; features outside become empty. For a
    PROJ triangulation file, heights (a third coordinate) and the fallback strategy are handled as in PROJ."""
    inputs.crs = None if inverse else crs
    pair = options.read_pair(inputs)
    work = PointMap(pair, choose_system(settings, pair), inverse)
    work.filter.SetComputeJacobian(jacobian)
    work.filter.SetComputeJacobianDeterminant(determinant)
    work.filter.SetComputeTriangleId(triangle_id)
    work.filter.SetTransformActiveAttributes(vectors != "none")
    work.filter.SetTransformAllInputVectors(vectors == "all")
    source, target = pair.crs(inverse)
    Data(work, output, columns, require_inside, densify, (source, target if crs is None else crs), pair.shift).process(
        inputs.other, inputs.format)
