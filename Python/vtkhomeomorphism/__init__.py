# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Homeomorphisms between the domains of isomorphic triangulations.

The package provides

- the class `Homeomorphism`, with numpy arrays in and out;
- the VTK classes `vtkDifferentiableHomeomorphism`, `vtkHomeomorphismTransform`,
  `vtkTriangularCoordinates`, `vtkJacobianContinuity` and `vtkResampleThroughHomeomorphism`, for VTK
  pipelines;
- the command `dhm` (`python3 -m vtkhomeomorphism`), for files.

>>> import numpy, vtkhomeomorphism
>>> source = numpy.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
>>> target = source.copy(); target[3] = 0.0, 1.5
>>> f = vtkhomeomorphism.Homeomorphism(source, target, [[0, 1, 2], [0, 2, 3]])
>>> bool(numpy.allclose(f.inverse(f([[0.4, 0.5]])), [[0.4, 0.5]], atol=1e-15))
True
"""

import importlib
from typing import TYPE_CHECKING

from .vtkFiltersHomeomorphism import (
    vtkDifferentiableHomeomorphism,
    vtkHomeomorphismTransform,
    vtkIsomorphicTriangulation,
    vtkJacobianContinuity,
    vtkResampleThroughHomeomorphism,
    vtkTriangularCoordinates,
)

if TYPE_CHECKING:
    from .arrays import Homeomorphism
    from .isomorphic import isomorphic_triangulation

__version__ = "1.0.0"
__all__ = [
    "Homeomorphism",
    "isomorphic_triangulation",
    "vtkDifferentiableHomeomorphism",
    "vtkHomeomorphismTransform",
    "vtkIsomorphicTriangulation",
    "vtkJacobianContinuity",
    "vtkResampleThroughHomeomorphism",
    "vtkTriangularCoordinates",
]


def __getattr__(name):
    # The VTK classes do not need numpy.
    modules = {"Homeomorphism": ".arrays", "isomorphic_triangulation": ".isomorphic"}
    if name in modules:
        return getattr(importlib.import_module(modules[name], __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
