# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of triangulations from landmarks."""

import numpy
import pytest

from vtkhomeomorphism import Homeomorphism, isomorphic_triangulation


def _landmarks(count=60):
    random = numpy.random.default_rng(1)
    source = random.random((count, 2))
    return source, source + 0.04 * numpy.sin(6 * source[:, ::-1])


def _doubled_areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return numpy.cross(b - a, c - a)


def test_landmarks_go_to_landmarks_and_back():
    source, target = _landmarks()
    f = Homeomorphism.from_landmarks(source, target)
    assert numpy.allclose(f(source), target, atol=1e-13)
    assert numpy.allclose(f.inverse(target), source, atol=1e-13)


def test_triangles_are_valid_in_both_domains():
    source, target = _landmarks()
    pair = isomorphic_triangulation(source, target)
    assert numpy.array_equal(pair.source[:60], source)
    assert numpy.array_equal(pair.target[:60], target)
    # Then come the points of the frame.
    assert pair.added_points == 0 and len(pair.source) > 64
    for points in (pair.source, pair.target):
        assert (_doubled_areas(points, pair.triangles) > 0).all()


def test_the_mistyped_landmark_is_the_most_suspicious():
    source, target = _landmarks()
    target[17] += 0.05
    assert isomorphic_triangulation(source, target).residuals.argmax() == 17
    with pytest.warns(UserWarning, match=r": \[17\b"):
        Homeomorphism.from_landmarks(source, target)


def test_what_is_not_certified_is_said_and_nan():
    x, y = (c.ravel() for c in numpy.meshgrid(numpy.arange(9.0), numpy.arange(9.0)))
    target = numpy.column_stack((x, y))
    source = target.copy()
    source[41, 0] = numpy.nextafter(source[40, 0], 9)
    corners = numpy.array([9 * j + i for j in range(8) for i in range(8)])[:, None]
    triangles = numpy.vstack((corners + [0, 1, 10], corners + [0, 10, 9]))
    points = numpy.random.default_rng(2).uniform(0.1, 7.9, (2000, 2))
    with pytest.warns(UserWarning, match="not certified in"):
        f = Homeomorphism(source, target, triangles, "cubic")
        images, jacobians = f(points), f.jacobian(points)
    inside = ~numpy.isnan(images[:, 0])
    assert 1000 < inside.sum() < 2000
    assert (numpy.abs(images[inside] - 4) <= 4).all()
    assert (numpy.linalg.det(jacobians[inside]) > 0).all() and numpy.isnan(jacobians[~inside]).all()
    assert numpy.array_equal(f.source, source) and numpy.array_equal(f.triangles, triangles)


def test_messages_name_options_of_python():
    source = numpy.array([[0, 0], [1, 0], [0, 1], [1, 1]], float)
    target = source.copy()
    target[3] = -1, -1
    with pytest.raises(ValueError, match="mask_invalid"):
        Homeomorphism(source, target, [[0, 1, 2], [1, 3, 2]])
    source[3] = 0.6, 0.45
    with pytest.raises(ValueError, match="discordant_by_linear"):
        Homeomorphism(source, source, [[0, 1, 2], [1, 3, 2]], "contour")


def test_outlines_and_added_points():
    outline = numpy.array([[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [0, 1]], float)
    other = numpy.roll(outline, -3, axis=0)
    pair = isomorphic_triangulation(outline, other, outlines=[range(6)], maximum_added_points=0)
    assert pair.added_points == 0
    for points in (pair.source, pair.target):
        assert numpy.isclose(_doubled_areas(points, pair.triangles).sum() / 2, 5)
    closed = isomorphic_triangulation(outline, other, outlines=[[*range(6), 0]], maximum_added_points=0)
    assert numpy.array_equal(closed.triangles, pair.triangles)


def test_conflicting_segments_are_named_or_left_out():
    points = numpy.array([[0, 0], [1, 0], [0.4, 1], [0.5, -1]], float)
    moved = points.copy()
    moved[3] = 2, 1
    segments = [[0, 1], [2, 3]]
    with pytest.raises(ValueError, match="cross"):
        isomorphic_triangulation(points, moved, segments=segments)
    pair = isomorphic_triangulation(
        points, moved, segments=segments, leave_out_conflicting_segments=True
    )
    assert len(pair.left_out) == 1


def test_points_that_do_not_exist_are_refused():
    source, target = _landmarks(5)
    with pytest.raises(ValueError, match="refers to a point that does not exist"):
        isomorphic_triangulation(source, target, segments=[[0, 99]])


@pytest.mark.parametrize("wrong", [
    {"maximum_added_points": -1}, {"target_minimum_angle": float("nan")}, {"target_minimum_angle": 61},
    {"maximum_triangle_size": -0.1}, {"frame": ((1, 0, 1, 0), (1, 0, 1, 0))}, {"frame": ((1, 0, 0, 1), None)},
])
def test_wrong_options_are_refused(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        isomorphic_triangulation(*_landmarks(5), **wrong)


def test_necessary_points_are_refused_beyond_the_limit():
    random = numpy.random.default_rng(4)
    source, target = random.random((20, 2)), random.random((20, 2))
    needed = isomorphic_triangulation(source, target).added_points
    assert needed > 1
    with pytest.raises(ValueError, match="points"):
        isomorphic_triangulation(source, target, maximum_added_points=1)
    assert isomorphic_triangulation(source, target, maximum_added_points=10000).added_points >= needed


def test_the_frame_of_an_image_is_predicted():
    """A quadratic map goes on beyond the landmarks, a wrong landmark notwithstanding."""
    source = numpy.random.default_rng(6).uniform(0.1, 0.9, (80, 2))

    def bend(points):
        return points + 0.1 * points[:, ::-1] ** 2

    target = bend(source)
    target[3] += 0.05
    pair = isomorphic_triangulation(source, target, frame=((0, 1, 0, 1), None))
    assert pair.suspicious()[0] == 3 and pair.added_points == 0
    rim = pair.source[80:]
    assert numpy.allclose(rim.min(axis=0), -0.01) and numpy.allclose(rim.max(axis=0), 1.01)
    assert numpy.allclose(pair.target[80:], bend(rim), atol=1e-9)


@pytest.mark.parametrize("count", [6, 9, 15, 40])
def test_gross_errors_among_few_landmarks_are_found(count):
    """Those of typing: a factor of ten, a sign, coordinates or landmarks exchanged, in the source or in the target."""
    missed = false = trials = 0
    for seed in range(5):
        random = numpy.random.default_rng(100 * count + seed)
        source = 1000 * random.random((count, 2))
        turn = numpy.array([[0.8, 0.7], [-0.6, 0.9]])
        target = source @ turn + [5000, 7000] + 10 * numpy.sin(source[:, ::-1] / 300)
        target += random.normal(0, 0.5, target.shape)
        false += len(isomorphic_triangulation(source, target).suspicious()) > 0
        i, k = random.choice(count, 2, replace=False)
        for error in ("ten", "sign", "coordinates", "landmarks"):
            for side in (0, 1):
                points = [source.copy(), target.copy()]
                wrong = points[side]
                if error == "ten":
                    wrong[i, 0] *= 10
                elif error == "sign":
                    wrong[i, 1] *= -1
                elif error == "coordinates":
                    wrong[i] = wrong[i, ::-1]
                else:
                    wrong[[i, k]] = wrong[[k, i]]
                if numpy.abs(points[side] - (source, target)[side]).max() < 150 or error == "landmarks" and count < 8:
                    continue
                trials += 1
                missed += not {i, *([k] if error == "landmarks" else [])} <= set(
                    isomorphic_triangulation(*points).suspicious().tolist())
    assert missed <= 0.05 * trials and false <= 1


def test_mistyped_landmarks_at_the_border_come_before_their_neighbors():
    """The fits of these are one-sided, and follow a wrong landmark."""
    for seed in range(80):
        random = numpy.random.default_rng(seed)
        source = random.random((60, 2))
        target = source + 0.04 * numpy.sin(6 * source[:, ::-1]) + random.normal(0, 0.001, source.shape)
        wrong = numpy.minimum(source, 1 - source).min(axis=1).argsort()[seed % 6]
        angle = 2 * numpy.pi * random.random()
        target[wrong] += 0.08 * numpy.array([numpy.cos(angle), numpy.sin(angle)])
        assert isomorphic_triangulation(source, target).suspicious()[0] == wrong


@pytest.mark.parametrize("seed", range(20))
def test_landmarks_without_error_are_not_suspicious(seed):
    """Not at the border either, where a map through their neighbors is extrapolated, also beside a wrong one."""
    random = numpy.random.default_rng(seed)
    source = random.random((60, 2))
    exact = source + 0.1 * source[:, ::-1] ** 2
    noisy = source + 0.1 * source[:, ::-1] ** 3 + random.normal(0, 0.001, source.shape)
    wrong = numpy.minimum(source, 1 - source).min(axis=1).argsort()[seed % 6]
    for target in (exact, noisy):
        assert len(isomorphic_triangulation(source, target).suspicious()) == 0
        target[wrong] += 0.06 * random.choice([-1, 1], 2)
        assert isomorphic_triangulation(source, target).suspicious().tolist() == [wrong]
