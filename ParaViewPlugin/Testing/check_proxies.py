# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the proxies: documentation, names of outputs, and defaults, which must equal those of the classes:
check_proxies.py MESHES."""

import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import session
from paraview import simple

session.load_plugin()
source = session.read(sys.argv[1], "source")
target = session.read(sys.argv[1], "target")
problems = []
compared = 0


def same(text, values):
    """Whether a class prints the value of the proxy."""
    return [float(x) for x in re.findall(r"[^ (),]+", text)] == [float(x) for x in values]


for name, outputs in (("DifferentiableHomeomorphism", ["Mapped data", "Continuity"]),
                      ("JacobianContinuity", ["Edges", "Triangulation"]),
                      ("ResampleThroughHomeomorphism", ["Resampled data"]),
                      ("TriangularCoordinates", ["Points", "Lines", "Triangulation"]),
                      ("InBetweenTriangulation", ["Triangulation"]),
                      ("IsomorphicTriangulation",
                       ["Source", "Target", "Source segments", "Target segments"]),
                      ("RefinedTriangulationPair", ["Source", "Target"]),
                      ("TriangulationPairReport", ["Source", "Target", "Statistics", "Defects"])):
    arguments = {"Source": source} if name == "TriangularCoordinates" else \
        {"Source": source, "Target": target}
    filter = getattr(simple, name)(**arguments)
    proxy = filter.SMProxy
    if [proxy.GetOutputPortName(i) for i in range(len(outputs))] != outputs:
        problems.append(name + ": other outputs than " + ", ".join(outputs))
    if not proxy.GetDocumentation().GetShortHelp() or not proxy.GetDocumentation().GetDescription():
        problems.append(name + " is not documented")
    printed = dict(re.findall(r"^ *(\w+): (.+)$", str(filter.GetClientSideObject()), re.MULTILINE))
    iterator = proxy.NewPropertyIterator()
    iterator.UnRegister(None)
    while not iterator.IsAtEnd():
        key, setting = iterator.GetKey(), iterator.GetProperty()
        if not setting.GetDocumentation() or not setting.GetDocumentation().GetDescription().strip():
            problems.append("%s.%s is not documented" % (name, key))
        if key in printed and not setting.GetInformationOnly():
            compared += 1
            values = [setting.GetElement(i) for i in range(setting.GetNumberOfElements())]
            if not same(printed[key], values):
                problems.append("%s.%s is %s, in the class %s" % (name, key, values, printed[key]))
        iterator.Next()
if compared < 40:
    problems.append("only %d defaults could be compared" % compared)
if problems:
    sys.exit("\n".join(problems))

# Arrays for coloring are selected automatically.
edges = simple.JacobianContinuity(Source=source, Target=target, CoordinateSystem="Contour",
                                  CenterPoint="Incenter")
edges.UpdatePipeline()
for port, what in (0, "edges"), (1, "triangles"):
    scalars = edges.GetClientSideObject().GetOutputDataObject(port).GetCellData().GetScalars()
    if not scalars or scalars.GetName() != "JacobianJump":
        sys.exit("JacobianJump is not the active array of the " + what)

# The transformation of each array can be chosen.
wavelet = simple.Wavelet(WholeExtent=[-5, 5, -5, 5, 0, 0])
data = simple.Calculator(Input=wavelet, ResultArrayName="Tangent", Function="coordsX*iHat+2*jHat")
mapped = simple.DifferentiableHomeomorphism(Source=source, Target=target, Data=data)
ranges = []
for transformation in "0", "1", "2":
    mapped.AttributeTransformations = ["Tangent", transformation]
    mapped.UpdatePipeline()
    ranges.append(mapped.PointData["Tangent"].GetRange(0))
if len(set(ranges)) != 3:
    sys.exit("Attribute Transformations does nothing: " + str(ranges))
print("%d defaults are the classes' own" % compared)
