# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Homeomorphisms between the domains of isomorphic triangulations: the class `Homeomorphism` for numpy arrays, VTK
classes for pipelines, and the command `dhm` (`python3 -m vtkhomeomorphism`) for files.

>>> import numpy, vtkhomeomorphism
>>> source = numpy.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
>>> target = source.copy(); target[3] = 0.0, 1.5
>>> f = vtkhomeomorphism.Homeomorphism(source, target, [[0, 1, 2], [0, 2, 3]])
>>> bool(numpy.allclose(f.inverse(f([[0.4, 0.5]])), [[0.4, 0.5]], atol=1e-15))
True
"""

from .arrays import Homeomorphism
from .isomorphic import IsomorphicTriangulation, isomorphic_triangulation
from .vtkFiltersHomeomorphism import (
    vtkDifferentiableHomeomorphism, vtkHomeomorphismTransform, vtkIsomorphicTriangulation, vtkJacobianContinuity,
    vtkResampleThroughHomeomorphism, vtkTriangularCoordinates,
)

__version__ = "1.0.0"
__all__ = [
    "Homeomorphism", "IsomorphicTriangulation", "isomorphic_triangulation", "vtkDifferentiableHomeomorphism",
    "vtkHomeomorphismTransform", "vtkIsomorphicTriangulation", "vtkJacobianContinuity",
    "vtkResampleThroughHomeomorphism", "vtkTriangularCoordinates",
]
