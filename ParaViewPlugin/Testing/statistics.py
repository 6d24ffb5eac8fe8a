# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the statistics of the filters: statistics.py MESHES RESULT writes the counts that must not depend on
the number of processes to RESULT (each process that runs the script appends its rank) and compares the other
counts with the data."""

import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import session
from paraview import servermanager, simple

meshes, result = sys.argv[1:3]
session.load_plugin()
source = session.read(meshes, "source")
target = session.read(meshes, "target")
other = session.read(meshes, "other")
# In pieces, and of the first process alone, so that the others have no points.
image = simple.Wavelet(WholeExtent=[-10, 10, -9, 9, -1, 1])
plane = simple.Plane(Origin=[-9, -9, 0], Point1=[9, -9, 0], Point2=[-9, 9, 0], XResolution=36,
                     YResolution=36)
counts = {}


def count(name, filter, *properties):
    filter.UpdatePipeline()
    for key in properties:
        counts[name + " " + key] = getattr(filter, key)
    return counts[name + " " + properties[0]]


def count_in_data(filter):
    """Outside points of all processes, counted by ParaView; of this process if each runs the script."""
    points = simple.MaskPoints(Input=filter, OnRatio=1, MaximumNumberofPoints=1000000,
                               GenerateVertices=1, SingleVertexPerCell=1)
    outside = simple.Threshold(Input=points, Scalars=["POINTS", "vtkValidPointMask"],
                               LowerThreshold=0, UpperThreshold=0)
    outside.UpdatePipeline()
    return outside.GetDataInformation().GetNumberOfCells()


outside = "NumberOfOutsidePoints"
for system in "Contour", "Smooth":
    settings = {"Source": source, "CoordinateSystem": system,
                "DiscordantTriangles": "Use Linear"}
    coordinates = simple.TriangularCoordinates(Data=plane, **settings)
    count("coordinates " + system, coordinates, outside, "NumberOfDiscordantTriangles")
    settings["Target"] = target
    mapped = simple.DifferentiableHomeomorphism(Data=plane, **settings)
    if count("mapped " + system, mapped, outside, "NumberOfDiscordantTriangles") <= 0:
        sys.exit("No points are outside")
    resampled = simple.ResampleThroughHomeomorphism(Data=image, Grid=plane, **settings)
    count("resampled " + system, resampled, outside)
    continuity = simple.JacobianContinuity(**settings)
    count("continuity " + system, continuity, "NumberOfCreases", "NumberOfDifferentiableEdges",
          "NumberOfUndecidedEdges", "LargestJump")
    # Requesting the counts again does not add them again.
    first = dict(counts)
    count("mapped " + system, mapped, outside)
    count("continuity " + system, continuity, "NumberOfDifferentiableEdges")
    if counts != first:
        sys.exit("The counts change: %s, %s" % (first, counts))

# Points of several processes are counted several times.
mapped = simple.DifferentiableHomeomorphism(Source=source, Target=target, Data=image, BlankOutside=0)
expected = count_in_data(mapped)
# A downstream filter made it execute.
actual = mapped.NumberOfOutsidePoints
module = servermanager.vtkProcessModule.GetProcessModule()
if actual != expected and not module.GetSymmetricMPIMode() or not 0 < expected <= actual:
    sys.exit("%d points of the image are outside, not %d" % (expected, actual))

# An error does not block other processes.
mapped = simple.DifferentiableHomeomorphism(Source=source, Target=other, Data=image)
if count("refused", mapped, outside) != -1:
    sys.exit("Points of refused meshes are counted")

with open("%s-%d" % (result, module.GetPartitionId()), "w") as file:
    json.dump(counts, file, indent=1, sort_keys=True)
