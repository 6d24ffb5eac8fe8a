# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether a pair defines a map, and why not."""

import numpy

from .mapping import PointMap, Settings


def require_map(pair, mask_invalid=False, masks=False):
    """The pair. Raises Failure if it defines no map."""
    PointMap(pair, Settings(system="linear", mask_invalid=mask_invalid)).map_points(numpy.empty((0, 3)))
    return pair
