# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm coordinates"""

import click

from .. import options, pair
from ..mapping import PointMap, run, set_up
from ..vtkFiltersHomeomorphism import vtkTriangularCoordinates
from .map import data_options, process


class Coordinates(PointMap):
    """Attaches triangular coordinates to points."""

    moves, shift = False, None

    def __init__(self, mesh, settings, name):
        self.domain, self.name = mesh, name
        self.filter = set_up(vtkTriangularCoordinates(), settings)
        self.filter.SetInputDataObject(0, mesh)
        self.filter.GenerateLinesOff()

    def map_data(self, data):
        self.filter.SetDataObject(data)
        result = run(self.filter, self.name)
        self.outside = self.filter.GetNumberOfOutsidePoints()
        return result


@click.command("coordinates")
@click.argument("files", nargs=2, metavar="MESH DATA")
@options.format_option
@data_options
@options.map_settings("smooth")
def command(files, input_format, output, columns, require_inside, **settings):
    """Attach triangular coordinates in a mesh to points.

    MESH is the triangulation (of a file with a pair, the source). DATA is as for dhm map. The arrays are TriangleId,
    EdgeLabel (e, 1 to 3), EdgeParameter (p, 0 to 1 along the edge), ContourParameter (c, 0 at the center, 1 on the
    edge) and vtkValidPointMask."""
    work = Coordinates(pair.read_mesh(files[0], input_format), settings, files[0])
    process(work, output, columns, require_inside, files[1], input_format)
