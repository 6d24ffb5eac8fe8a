# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Uses every proxy of the plugin and writes what they make, for comparison between numbers of ranks and
ways to run ParaView.

    pvpython check_plugin.py PLUGIN FOLDER RESULT [HOST:PORT]
"""

import sys

from paraview import servermanager
from paraview.simple import *

plugin, folder, result = sys.argv[1:4]
if len(sys.argv) > 4:
    host, port = sys.argv[4].split(":")
    Connect(host, int(port))
LoadPlugin(plugin, remote=len(sys.argv) > 4, ns=globals())

source = XMLPolyDataReader(FileName=[folder + "/source.vtp"])
target = XMLPolyDataReader(FileName=[folder + "/target.vtp"])
# Comes in one piece for each rank.
data = Wavelet(WholeExtent=[-10, 10, -10, 10, 0, 0])


def lines_of(proxy, arrays, port=0):
    """Every point with its values, whatever rank it came from, sorted; the same point may come from
    two ranks."""
    # Fetch takes the first output only, and all ranks' parts of unstructured grids only.
    fetched = servermanager.Fetch(AppendDatasets(Input=OutputPort(proxy, port)))
    lines = set()

    def collect(dataset):
        mask = dataset.GetPointData().GetArray("ValidPointMask")
        for i in range(dataset.GetNumberOfPoints()):
            values = list(dataset.GetPoint(i))
            for name in arrays:
                array = dataset.GetPointData().GetArray(name)
                values += array.GetTuple(i) if array else ["none"]
            values.append(mask.GetTuple1(i) if mask else "none")
            lines.add(" ".join(float(v).hex() if v != "none" else v for v in values))

    if fetched.IsA("vtkCompositeDataSet"):
        iterator = fetched.NewIterator()
        while not iterator.IsDoneWithTraversal():
            collect(iterator.GetCurrentDataObject())
            iterator.GoToNextItem()
    else:
        collect(fetched)
    return sorted(lines)


output = []


def add(title, lines):
    assert lines, title + ": nothing came out"
    output.append("# %s: %d" % (title, len(lines)))
    output.extend(lines)


for system in ("Linear", "Contour", "Smooth"):
    homeomorphism = DifferentiableHomeomorphism(Source=source, Target=target, Data=data)
    homeomorphism.CoordinateSystem = system
    homeomorphism.DiscordantTriangles = "Carry by Linear"
    homeomorphism.ComputeJacobianDeterminant = 1
    homeomorphism.MeasureContinuity = 1
    add(system + ", mapped", lines_of(homeomorphism, ["RTData", "JacobianDeterminant"]))
    add(system + ", continuity", lines_of(homeomorphism, ["JacobianJumpExact"], 1))

coordinates = TriangularCoordinates(Source=source, Data=data)
add("coordinates", lines_of(coordinates, ["TriangleId", "EdgeLabel", "EdgeParameter"]))
add("coordinate lines", lines_of(coordinates, [], 1))
add("triangles", lines_of(coordinates, [], 2))

continuity = JacobianContinuity(Source=source, Target=target)
continuity.Vertices = 1
add("edges", lines_of(continuity, ["JacobianJump"]))
add("coloured triangles", lines_of(continuity, ["JacobianJump"], 1))

resample = ResampleThroughHomeomorphism(Source=source, Target=target, Data=data)
resample.SamplingDimensions = [33, 21]
add("resampled", lines_of(resample, ["RTData"]))

resample.Grid = Wavelet(WholeExtent=[-12, 12, -12, 12, 0, 0])
add("resampled on a grid", lines_of(resample, ["RTData"]))

if servermanager.vtkProcessModule.GetProcessModule().GetPartitionId() == 0:
    with open(result, "w") as file:
        file.write("\n".join(output) + "\n")
