# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Updates through time steps: series.py MESHES. The meshes are read and validated once if only the data
changes, and once per time step if they change."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import session
from paraview import simple

SCRIPT = """
time = self.GetInputDataObject(0, 0).GetInformation().Get(vtk.vtkDataObject.DATA_TIME_STEP())
output.ShallowCopy(self.GetInputDataObject(0, 0))
values = vtk.vtkDoubleArray()
values.SetName("Time")
values.SetNumberOfTuples(output.GetNumberOfPoints())
values.Fill(time)
output.GetPointData().AddArray(values)
"""


def expect(actual, expected, what):
    if actual != expected:
        sys.exit("%s: %s, not %s" % (what, actual, expected))


# In a function, because ParaView runs the script above in the namespace of this module.
def main(meshes):
    session.load_plugin()
    source = session.read(meshes, "source")
    target = session.read(meshes, "target")
    moving = simple.PVDReader(FileName=os.path.join(meshes, "moving.pvd"))
    moving.UpdatePipelineInformation()
    times = list(moving.TimestepValues)
    if times != [0.0, 1.0, 2.0]:
        sys.exit("The series has the time steps %s" % times)
    image = simple.Wavelet(WholeExtent=[-6, 6, -6, 6, 0, 0])
    # Time-dependent data: the value at each point is the time, and the points move.
    changing = simple.ProgrammableFilter(
        Input=simple.PVDReader(FileName=os.path.join(meshes, "moving.pvd")), Script=SCRIPT)

    for kind in "DifferentiableHomeomorphism", "ResampleThroughHomeomorphism":
        make = getattr(simple, kind)
        # Also as parts of a tree.
        for data in [changing] + [simple.GroupDatasets(Input=[image, changing], OutputType=type) for type in (
                "vtkMultiBlockDataSet", "vtkPartitionedDataSetCollection")]:
            constant = make(Source=source, Target=target, Data=data)
            for time in times:
                constant.UpdatePipeline(time)
                array = constant.PointData["Time"]
                if kind == "DifferentiableHomeomorphism" and data is changing:
                    expect(array.GetRange(0), (time, time), kind + "'s data")
                expect(constant.NumberOfMeshBuilds, 1, kind + ", meshes that stand still")

        # Only the target has time steps.
        changed = make(Source=source, Target=moving, Data=image)
        seen = set()
        for count, time in enumerate(times + [1.0], 1):
            changed.UpdatePipeline(time)
            changed.UpdatePipeline(time)
            expect(changed.NumberOfMeshBuilds, count, kind + ", meshes that change")
            seen.add(tuple(changed.GetDataInformation().GetBounds()) if kind[0] == "D" else
                     changed.PointData["RTData"].GetRange(0))
        expect(len(seen), 3, kind + "'s different results")

    edges = simple.JacobianContinuity(Source=source, Target=moving, CoordinateSystem="Linear")
    jumps = set()
    for time in times:
        edges.UpdatePipeline(time)
        jumps.add(edges.LargestJump)
    expect(len(jumps), 3, "JacobianContinuity's different results")
    print("The meshes are built when they change")


main(sys.argv[1])
