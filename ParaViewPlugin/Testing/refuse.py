# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sets meshes that are not isomorphic in each filter: refuse.py MESHES. Checks that the output is empty and that the
filters recover; the caller checks the messages."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import session
from paraview import simple

meshes = sys.argv[1]
session.load_plugin()
source = session.read(meshes, "source")
target = session.read(meshes, "target")
other = session.read(meshes, "other")
image = simple.Wavelet(WholeExtent=[-10, 10, -9, 9, -1, 1])


def points(proxy):
    proxy.UpdatePipeline()
    return proxy.GetDataInformation().GetNumberOfPoints()


for name, proxy in (
        ("homeomorphism", simple.DifferentiableHomeomorphism(Source=source, Target=other, Data=image)),
        ("homeomorphism of a mesh", simple.DifferentiableHomeomorphism(Source=source, Target=other)),
        ("continuity", simple.JacobianContinuity(Source=source, Target=other)),
        ("resampling", simple.ResampleThroughHomeomorphism(Source=source, Target=other, Data=image))):
    count = points(proxy)
    if count != 0:
        sys.exit("%s: %d points from meshes that do not go together" % (name, count))
    proxy.Target = target
    if points(proxy) == 0:
        sys.exit("%s: no points from meshes that go together" % name)
print("refused and recovered")
