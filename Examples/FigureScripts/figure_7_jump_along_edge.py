# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The jump of the Jacobian along an edge, measured from values of the map, and its closed form."""

import numpy
from drawing import CENTER, CONTOUR, SYSTEMS, WING, Page, curves_of, measure_continuity
from vtkmodules.util.numpy_support import vtk_to_numpy

TRIANGLES = numpy.array([(0, 1, 2), (1, 0, 3)])
SOURCE = numpy.array([(-2.0, 0.0), (2.0, 0.0), (0.0, 3.0), (0.0, -3.0)])
TARGET = numpy.array([(-2.0, 0.0), (2.0, 0.0), (0.6, 6.0), (0.0, -3.0)])
LOWEST = 1e-13

page = Page(1120, 640)
axes = page.panel(105, 70, 860, 550, (0, LOWEST, 1, 10 - LOWEST), stretch=True)
axes.axis("on")
axes.set(yscale="log", ylim=(LOWEST, 10), xticks=numpy.arange(5) / 4, yticks=10.0 ** numpy.arange(-12, 1, 2))
axes.set_yticks(10.0 ** numpy.arange(-13, 2), minor=True)
axes.grid(True, which="both", axis="y", color="#e8e9ec", linewidth=0.7)
axes.tick_params(which="major", labelsize=11.5)
axes.tick_params(which="minor", labelleft=False)
page.label(535, 20, "position along the edge", 17)
page.label(28, 345, "relative jump of the Jacobian", 17, rotation=90)
print(f"{'':8} {'largest |measured - exact|':>26} {'error bound':>14} {'least jump':>14} {'largest jump':>14}")
for system, color in zip(SYSTEMS, (CENTER, CONTOUR, WING)):
    edges = measure_continuity(SOURCE, TARGET, TRIANGLES, system, 99).GetOutput()
    # The ends are vertices, which have no jump.
    position = (curves_of(edges)[0][1:-1, 0] + 2) / 4
    measured, exact, bound = (curves_of(edges, vtk_to_numpy(edges.GetPointData().GetArray(name)))[0][1:-1]
                              for name in ("JacobianJump", "JacobianJumpExact", "JacobianJumpError"))
    print(f"{system.capitalize():8} {numpy.abs(measured - exact).max():26.2g} {bound.max():14.2g} "
          f"{measured.min():14.2g} {measured.max():14.2g}")
    smooth = system == "smooth"
    axes.plot(position, numpy.maximum(bound if smooth else exact, LOWEST), color=color,
              linewidth=0.9 if smooth else 1.5, linestyle=(0, (4, 3)) if smooth else "-")
    axes.plot(position[4::5], numpy.maximum(measured[4::5], LOWEST), "o", color=color, markersize=6.5,
              markerfacecolor="white", markeredgewidth=1.3)
    texts = [(10**-11.6, "Smooth", 18), (bound[-1], "bound on its error", 15)] if smooth else [
        (exact[-1], system.capitalize(), 18)]
    for height, text, size in texts:
        axes.annotate(text, (1, height), xytext=(9, 0), textcoords="offset points", fontsize=0.72 * size, color=color,
                      va="center", annotation_clip=False)
page.save("figure-7-jump-along-edge.png")
