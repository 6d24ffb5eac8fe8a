# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Applies the filters to distributed data: run_filters.py MESHES RESULTS."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import session
from paraview import simple

meshes, results = sys.argv[1:3]
session.load_plugin()
source = session.read(meshes, "source")
target = session.read(meshes, "target")
pieces = {"Source": session.read(meshes, "source", in_pieces=True),
          "Target": session.read(meshes, "target", in_pieces=True)}


def save(name, proxy, port=0):
    """Saves a result with one piece per process."""
    merged = simple.MergeBlocks(Input=simple.OutputPort(proxy, port), MergePoints=0)
    # VTK cannot read appended data back with every version of expat.
    writer = simple.servermanager.writers.XMLPUnstructuredGridWriter(
        Input=merged, FileName=os.path.join(results, name + ".pvtu"), DataMode="Binary")
    writer.UpdatePipeline()


def with_arrays(proxy):
    """Adds the original coordinates, and vectors that the map transforms."""
    origin = simple.Calculator(Input=proxy, ResultArrayName="Origin", Function="coords")
    return simple.Calculator(Input=origin, ResultArrayName="Velocity",
                             Function="(1 + coordsX*coordsY)*iHat + coordsX*jHat")


def make_data():
    """An image and a surface in pieces, and data of the first process alone."""
    image = with_arrays(simple.Wavelet(WholeExtent=[-10, 10, -9, 9, -1, 1]))
    surface = simple.Contour(Input=image, ContourBy=["POINTS", "RTData"], Isosurfaces=[180.0],
                             ComputeNormals=0)
    plane = with_arrays(simple.Plane(Origin=[-7, -7, 0], Point1=[7, -7, 0], Point2=[-7, 7, 0],
                                     XResolution=30, YResolution=30))
    # Has outside points, so that both blocks have vtkGhostType: only arrays of all blocks are saved.
    other_image = with_arrays(simple.Wavelet(WholeExtent=[-9, 5, -9, 9, 3, 6]))
    return image, surface, plane, simple.GroupDatasets(Input=[image, other_image])


image, surface, plane, group = make_data()
# Separate sources for filters that read their data whole: sources that cannot read pieces would continue to
# give the whole to all processes.
whole_image, whole_surface, whole_plane, whole_group = make_data()
elevation = simple.Elevation(Input=source)

for system in "Linear", "Contour", "Smooth":
    settings = {"Source": source, "Target": target, "CoordinateSystem": system,
                "DiscordantTriangles": "Use Linear"}
    for name, data in (("image", image), ("surface", surface), ("plane", plane), ("group", group),
                       ("mesh", None), ("source", source), ("elevation", elevation)):
        mapped = simple.DifferentiableHomeomorphism(
            Data=data, ComputeJacobian=1, ComputeJacobianDeterminant=1, ComputeTriangleId=1,
            MeasureContinuity=1, **settings)
        save("mapped-%s-%s" % (name, system), mapped)
        if name in ("image", "mesh"):
            save("measured-%s-%s" % (name, system), mapped, 1)
        back = simple.DifferentiableHomeomorphism(Data=mapped, Inverse=1, **settings)
        save("back-%s-%s" % (name, system), back)
    continuity = simple.JacobianContinuity(Spokes=1, Vertices=1, **settings)
    save("edges-" + system, continuity, 0)
    save("triangles-" + system, continuity, 1)
    settings.update(pieces)
    mapped = simple.DifferentiableHomeomorphism(Data=image, **settings)
    save("pieces-image-" + system, mapped)
    save("pieces-mesh-" + system, simple.DifferentiableHomeomorphism(**settings))
    save("pieces-edges-" + system, simple.JacobianContinuity(**settings))
    settings.update({"Source": source, "Target": target})
    # The first process measures.
    counts = [getattr(continuity, "NumberOf" + what)
              for what in ("DifferentiableEdges", "Creases", "UndecidedEdges")]
    if sum(counts) != 96 or (counts[1] == 0) != (system == "Smooth"):
        sys.exit("%s: %d edges are differentiable, %d are not, %d are undecided" % (system, *counts))
    for name, data, grid in (("image", whole_image, None), ("grid", whole_surface, image),
                             ("group", whole_group, None), ("mesh", None, plane),
                             ("elevation", elevation, target)):
        resampled = simple.ResampleThroughHomeomorphism(
            Data=data, Grid=grid, SamplingDimensions=[40, 30], **settings)
        save("resampled-%s-%s" % (name, system), resampled)
    del settings["Target"]
    for name, data in ("image", image), ("surface", surface), ("plane", plane), ("mesh", None), \
            ("elevation", elevation):
        coordinates = simple.TriangularCoordinates(Data=data, **settings)
        save("coordinates-%s-%s" % (name, system), coordinates)
    coordinates = simple.TriangularCoordinates(**settings)
    save("lines-" + system, coordinates, 1)
    save("described-" + system, coordinates, 2)
