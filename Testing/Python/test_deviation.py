# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""MaximumDeviation of the Smooth and the Cubic map, on a generated network, and on real data if it is available."""

import deviation
import numpy
import pytest
from pairs import SHARED_DATA, make_pair, read_json
from vtkhomeomorphism import Homeomorphism


def expect_limits(pair, names, limits, count):
    for name in names:
        free = deviation.measure(pair, name, None, count)[1].max()
        for limit in limits:
            map, strays = deviation.measure(pair, name, limit, count)
            # The template is close to the piecewise linear map anyway.
            assert limit < free or name == "CUBIC, LOCAL"
            assert strays.max() <= limit + deviation.rounding(pair), (name, limit)
            points = deviation.sample(pair, 3000, seed=8)[0]
            back = map.inverse(map(points))
            assert numpy.abs(back - points).max() < 1e-13 * numpy.abs(pair.source).max() * 1e4, (name, limit)


def test_network_with_needles():
    pair = deviation.make_network(points=120)
    edges = numpy.linalg.norm(pair.source[pair.triangles] - pair.source[numpy.roll(pair.triangles, 1, axis=1)], axis=2)
    shape = edges.max(axis=1) ** 2 / deviation.doubled_areas(pair.source, pair.triangles)
    assert (shape > 500).any()
    expect_limits(pair, ["SMOOTH", "CUBIC, LOCAL"], [0.01, 0.001], 30000)


def test_smooth_strays_almost_as_far_as_allowed():
    strays = deviation.measure(make_pair(), "SMOOTH", 1e-4, 100000)[1].max()
    assert 0.9e-4 < strays <= 1e-4


def test_a_limit_that_is_not_reached_changes_nothing():
    pair = make_pair()
    points = deviation.sample(pair, 1000)[0]
    free, limited = (Homeomorphism(*pair, "smooth", maximum_deviation=limit) for limit in (None, 10.0))
    numpy.testing.assert_array_equal(free(points), limited(points))


def test_affine_pairs_are_affine_within_any_limit():
    pair = make_pair()
    target = pair.source @ [[2, 0.3], [-0.5, 1.5]] + 1
    points, _ = deviation.sample(pair, 1000)
    images = Homeomorphism(pair.source, target, pair.triangles, "smooth", maximum_deviation=1e-9)(points)
    numpy.testing.assert_allclose(images, points @ [[2, 0.3], [-0.5, 1.5]] + 1, atol=4e-15)


@pytest.mark.parametrize("name, limits", [("cases/needle_shift.json", [0.05, 0.001]),
                                          ("fi_nls_ykj_etrs35fin.json", [0.01, 0.001])])
def test_real_networks(name, limits):
    if not (SHARED_DATA / name).is_file():
        pytest.skip(f"{SHARED_DATA / name} is not there")
    names = deviation.MAPS if "needle" in name else ["SMOOTH", "CUBIC, LOCAL"]
    expect_limits(read_json(SHARED_DATA / name)[0], names, limits, 20000)
