#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reference values of the three coordinate systems Linear, Contour and Smooth, to 25 significant digits.

Every value is computed with 100 decimal digits and, where possible, from the definition rather than from a closed form:

* contours are constructed (wing point, line perpendicular to the straight piece, circle about its intersection with the
  edge), and the contour through a point or to an edge point is found by a bracketing root finder;
* charts are inverted by a bracketing root finder;
* Jacobians are central differences of the map, with a step of 1e-30 of the triangle's smallest height.

The closed forms are used only for the checks that run while the values are computed (see the functions check_...).

Conventions: corners 1, 2, 3, counterclockwise. Edge k is opposite corner k, directed from the next corner in cyclic
order to the one after. The triangular coordinates are (e, p, c): e the edge, p the position along it as a proportion of
its length, c how far along the contour, 0 at the center and 1 on the edge.

Usage:
    reference_values.py --output DIR             write the files
    reference_values.py --output DIR --check     recompute a random subset of the files' rows and compare
"""

import argparse
import math
import multiprocessing
import os
import random
import sys
from fractions import Fraction

from mpmath import mp, mpf

mp.dps = 100

SEED = 20020612
STEP = mpf(10) ** -30
OUTPUT_DIGITS = 25
BACK_TOLERANCE = mpf(10) ** -40
CLOSED_FORM_TOLERANCE = mpf(10) ** -55
CHECK_TOLERANCE = mpf(10) ** -23


class Unsuitable(Exception):
    """The input is no test case: not strictly inside, or on a line where the map or its derivative is ambiguous."""


def require(condition, message):
    """A self-check that python -O doesn't remove."""
    if not condition:
        raise AssertionError(message)


# ------------------------------------------------------------------------------------------------- vectors and triangles


def add(a, b):
    return (a[0] + b[0], a[1] + b[1])


def subtract(a, b):
    return (a[0] - b[0], a[1] - b[1])


def scaled(a, t):
    return (a[0] * t, a[1] * t)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def length(a):
    return mp.sqrt(dot(a, a))


def between(a, b, t):
    """The point at proportion t of the way from a to b."""
    return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t)


def twice_area(a, b, c):
    """Twice the signed area of a, b, c. Exact for Fractions."""
    return cross(subtract(b, a), subtract(c, a))


def edge_ends(k):
    """The corners (indices 0, 1, 2) at which edge k starts and ends."""
    return (k + 1) % 3, (k + 2) % 3


def barycentric(corners, point):
    """Barycentric coordinates of a point."""
    whole = twice_area(*corners)
    return tuple(twice_area(corners[i], corners[j], point) / whole for i, j in map(edge_ends, range(3)))


def affine(corners, l):
    """The point with barycentric coordinates l."""
    return tuple(sum(l[k] * corners[k][axis] for k in range(3)) for axis in range(2))


def centroid(corners):
    return tuple(sum(corner[axis] for corner in corners) / 3 for axis in range(2))


def incenter(corners):
    """Where the bisectors of the angles at corners 1 and 2 intersect."""

    def bisector(k):
        to_next = subtract(corners[(k + 1) % 3], corners[k])
        to_last = subtract(corners[(k + 2) % 3], corners[k])
        return add(scaled(to_next, 1 / length(to_next)), scaled(to_last, 1 / length(to_last)))

    first, second = bisector(0), bisector(1)
    t = cross(subtract(corners[1], corners[0]), second) / cross(first, second)
    return add(corners[0], scaled(first, t))


def smallest_height(corners):
    longest = max(length(subtract(corners[j], corners[i])) for i, j in map(edge_ends, range(3)))
    return twice_area(*corners) / longest


def exact(points):
    return [None if point is None else tuple(Fraction(value) for value in point) for point in points]


def high_precision(points):
    return [None if point is None else tuple(mpf(value) for value in point) for point in points]


def is_counterclockwise(corners):
    """Exact."""
    return twice_area(*exact(corners)) > 0


def is_strictly_inside(corners, point):
    """Exact."""
    corners, (point,) = exact(corners), exact([point])
    return all(twice_area(corners[i], corners[j], point) > 0 for i, j in map(edge_ends, range(3)))


def foot_proportions(corners):
    """For each edge, the position of the foot of the centroid's perpendicular, as a proportion of its length. Exact."""
    corners = exact(corners)
    g = centroid(corners)
    result = []
    for i, j in map(edge_ends, range(3)):
        edge = subtract(corners[j], corners[i])
        result.append(dot(subtract(g, corners[i]), edge) / dot(edge, edge))
    return result


def concordance_margin(corners):
    """How far (as a proportion of the edge) the feet stay from the ends of their edges; negative when discordant. Exact."""
    return min(min(t, 1 - t) for t in foot_proportions(corners))


def is_concordant(corners):
    return concordance_margin(corners) > 0


# ------------------------------------------------------------------------------------------------- root finder


def bracketed_root(function, a, b, fa, fb):
    """The root in [a, b] of a function with one change of sign (Chandrupatla: bisection, inverse quadratic when safe)."""
    if fa == 0:
        return a
    if fb == 0:
        return b
    require((fa < 0) != (fb < 0), "the root is not bracketed")
    relative = mpf(2) ** (6 - mp.prec)
    t = mpf(1) / 2
    for _ in range(4 * mp.prec):
        x = a + t * (b - a)
        fx = function(x)
        if (fx < 0) == (fa < 0):
            c, fc = a, fa
        else:
            c, fc = b, fb
            b, fb = a, fa
        a, fa = x, fx
        best = a if abs(fa) < abs(fb) else b
        width = abs(b - a)
        if fa == 0 or width <= 2 * relative * abs(best):
            return best
        smallest_step = relative * abs(best) / width
        xi = (a - b) / (c - b)
        phi = (fa - fb) / (fc - fb)
        if phi * phi < xi and (1 - phi) * (1 - phi) < 1 - xi:
            t = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        else:
            t = mpf(1) / 2
        t = min(1 - smallest_step, max(smallest_step, t))
    raise AssertionError("the root finder does not converge")


# ------------------------------------------------------------------------------------------------- Linear


class LinearSystem:
    """Straight contours from the centroid to the edges."""

    def __init__(self, corners):
        self.corners = corners
        self.center = centroid(corners)

    def triangular(self, point):
        """(e, p, c) of a point, and the piece of the system it lies in."""
        l = barycentric(self.corners, point)
        e = min(range(3), key=lambda k: l[k])
        if sum(value == l[e] for value in l) > 1:
            raise Unsuitable("on a spoke")
        i, j = edge_ends(e)
        start, edge = self.corners[i], subtract(self.corners[j], self.corners[i])
        ray = subtract(point, self.center)
        p = cross(subtract(self.center, start), ray) / cross(edge, ray)
        c = length(ray) / length(subtract(between(start, self.corners[j], p), self.center))
        return (e, p, c), (e,)

    def cartesian(self, coordinates):
        """The point with coordinates (e, p, c), and the piece of the system it lies in."""
        e, p, c = coordinates
        i, j = edge_ends(e)
        return between(self.center, between(self.corners[i], self.corners[j], p), c), (e,)


# ------------------------------------------------------------------------------------------------- Contour


class Contour:
    """One contour of a half edge, constructed in the half edge's frame: foot (0,0), vertex (b,0), center (0,h)."""

    def __init__(self, b, h, s):
        # The wing segment joins the midpoint of the center segment to the vertex; s parametrizes its points.
        self.center = (mpf(0), h)
        self.wing_point = between((mpf(0), h / 2), (b, mpf(0)), s)
        straight = subtract(self.wing_point, self.center)
        # The center of the arc is the intersection of the perpendicular to the straight piece at the wing
        # point with the line of the edge: (arc_center - wing_point) . straight = 0 with arc_center = (o, 0).
        wx, wy = self.wing_point
        self.o = wx + wy * straight[1] / straight[0]
        self.r = length((wx - self.o, wy))
        self.straight = straight

    def position_at_level(self, y):
        """Where the contour crosses the parallel to the edge at height y."""
        if y >= self.wing_point[1]:
            return between(self.center, self.wing_point, (self.center[1] - y) / -self.straight[1])[0]
        return self.o + mp.sqrt(self.r * self.r - y * y)

    def edge_point(self):
        return self.o + self.r

    def straight_length(self):
        return length(self.straight)

    def arc_angle(self, point):
        """The angle at the arc's center between the wing point and a point."""
        to_wing_point = (self.wing_point[0] - self.o, self.wing_point[1])
        to_point = (point[0] - self.o, point[1])
        return mp.atan2(cross(to_point, to_wing_point), dot(to_point, to_wing_point))

    def turning_angle(self):
        return self.arc_angle((self.edge_point(), mpf(0)))

    def total_length(self):
        return self.straight_length() + self.r * self.turning_angle()

    def is_straight_at(self, point):
        return point[1] >= self.wing_point[1]

    def length_to(self, point):
        """Arc length from the center to a point of the contour."""
        if self.is_straight_at(point):
            return length(subtract(point, self.center))
        return self.straight_length() + self.r * self.arc_angle(point)

    def point_at(self, arc_length):
        """The point at an arc length from the center, and whether it lies on the straight piece."""
        rest = arc_length - self.straight_length()
        if rest <= 0:
            return between(self.center, self.wing_point, arc_length / self.straight_length()), True
        # Rotate the wing point about the center of the arc, clockwise (towards the edge).
        angle = rest / self.r
        cosine, sine = mp.cos(angle), mp.sin(angle)
        x, y = self.wing_point[0] - self.o, self.wing_point[1]
        return (self.o + cosine * x + sine * y, cosine * y - sine * x), False


class HalfEdge:
    """The part of a triangle between a center segment and a spoke: the triangle center, foot, vertex."""

    def __init__(self, center, foot, vertex):
        along, up = subtract(vertex, foot), subtract(center, foot)
        self.foot = foot
        self.b, self.h = length(along), length(up)
        self.x_axis, self.y_axis = scaled(along, 1 / self.b), scaled(up, 1 / self.h)

    def to_frame(self, point):
        d = subtract(point, self.foot)
        return dot(d, self.x_axis), dot(d, self.y_axis)

    def from_frame(self, point):
        return add(self.foot, add(scaled(self.x_axis, point[0]), scaled(self.y_axis, point[1])))

    def number_of_contour_through(self, x, y):
        """The number s of the contour that passes through (x, y): its position at level y is x."""

        def excess(s):
            return Contour(self.b, self.h, s).position_at_level(y) - x

        return bracketed_root(excess, mpf(0), mpf(1), -x, self.b * (1 - y / self.h) - x)

    def contour_through(self, x, y):
        return Contour(self.b, self.h, self.number_of_contour_through(x, y))


class ContourSystem:
    """Contours that are a straight piece and a circular arc, about a center."""

    def __init__(self, corners, center_of=centroid):
        self.corners = corners
        self.center = center_of(corners)
        self.feet, self.half_edges = [], []
        for i, j in map(edge_ends, range(3)):
            edge = subtract(corners[j], corners[i])
            t = dot(subtract(self.center, corners[i]), edge) / dot(edge, edge)
            if not 0 < t < 1:
                raise Unsuitable("discordant")
            foot = between(corners[i], corners[j], t)
            self.feet.append(foot)
            self.half_edges.append([HalfEdge(self.center, foot, corners[n]) for n in (i, j)])

    def half_edge_of(self, point):
        """The edge and the half of it (0: at its start, 1: at its end) whose triangle center, foot, vertex has the point."""
        for e in range(3):
            i, j = edge_ends(e)
            sides = [twice_area(self.center, end, point) for end in (self.corners[i], self.feet[e], self.corners[j])]
            if sides[0] > 0 > sides[2]:
                if sides[1] == 0:
                    raise Unsuitable("on a center segment")
                return e, (0 if sides[1] < 0 else 1)
        raise Unsuitable("on a spoke")

    def triangular(self, point):
        """(e, p, c) of a point, and the piece of the system it lies in."""
        e, half = self.half_edge_of(point)
        half_edge = self.half_edges[e][half]
        x, y = half_edge.to_frame(point)
        contour = half_edge.contour_through(x, y)
        i, j = edge_ends(e)
        end = half_edge.from_frame((contour.edge_point(), mpf(0)))
        p = length(subtract(end, self.corners[i])) / length(subtract(self.corners[j], self.corners[i]))
        c = contour.length_to((x, y)) / contour.total_length()
        return (e, p, c), (e, half, contour.is_straight_at((x, y)))

    def cartesian(self, coordinates):
        """The point with coordinates (e, p, c), and the piece of the system it lies in."""
        e, p, c = coordinates
        i, j = edge_ends(e)
        end = between(self.corners[i], self.corners[j], p)
        side = dot(subtract(end, self.feet[e]), subtract(self.corners[j], self.corners[i]))
        if side == 0:
            raise Unsuitable("on a center segment")
        half = 0 if side < 0 else 1
        half_edge = self.half_edges[e][half]
        x, _ = half_edge.to_frame(end)
        contour = half_edge.contour_through(x, mpf(0))
        point, is_straight = contour.point_at(c * contour.total_length())
        return half_edge.from_frame(point), (e, half, is_straight)


# ------------------------------------------------------------------------------------------------- Smooth

EQUILATERAL = ((mpf(0), mpf(0)), (mpf(1), mpf(0)), (mpf(1) / 2, mp.sqrt(3) / 2))
EQUILATERAL_SYSTEM = ContourSystem(EQUILATERAL)


class Chart:
    """The chart Phi of a triangle with its three neighbors: reference coordinates l to the plane."""

    def __init__(self, corners, apexes):
        self.corners, self.apexes = corners, apexes
        self.shift, self.shift_barycentric, self.tau, self.kappa = [], [], [], []
        zero = (mpf(0), mpf(0))
        for k, apex in enumerate(apexes):
            i, j = edge_ends(k)
            if apex is None:
                shift, kappa = zero, mpf(1)
            else:
                # The common derivative V across the edge weights the medians m and m* by the area of the
                # other triangle.
                middle = between(corners[i], corners[j], mpf(1) / 2)
                m, m_star = subtract(corners[k], middle), subtract(apex, middle)
                a, a_star = twice_area(*corners), twice_area(corners[j], corners[i], apex)
                v = scaled(subtract(scaled(m, a_star), scaled(m_star, a)), 1 / (a + a_star))
                shift, kappa = subtract(v, m), 2 * a_star / (a + a_star)
            d = [
                value - origin
                for value, origin in zip(barycentric(corners, add(corners[0], shift)), (mpf(1), mpf(0), mpf(0)))
            ]
            g = min(mpf(0), d[i], d[j])
            self.shift.append(shift)
            self.shift_barycentric.append(d)
            self.tau.append(mpf(1) if g == 0 else min(mpf(1), 1 / (2 * abs(g))))
            self.kappa.append(kappa)

    def strip_coordinate(self, k, l):
        """u: 0 on edge k, 1 on the border of its strip; infinite at the other two edges."""
        i, j = edge_ends(k)
        if l[i] <= 0 or l[j] <= 0:
            return mp.inf
        return l[k] * (l[i] + l[j]) / (self.tau[k] * l[i] * l[j])

    def bump(self, k, l):
        """B_k(l) = l_k W(u)."""
        u = self.strip_coordinate(k, l)
        return l[k] * (1 - u) ** 3 * (1 + 3 * u) if u < 1 else mpf(0)

    def strip_of(self, l):
        """The edge whose strip contains l, or None."""
        strips = []
        for k in range(3):
            u = self.strip_coordinate(k, l)
            if u == 1:
                raise Unsuitable("on a strip border")
            if u < 1:
                strips.append(k)
        require(len(strips) <= 1, "strips overlap")
        return strips[0] if strips else None

    def point(self, l):
        """Phi(l)."""
        result = affine(self.corners, l)
        for k in range(3):
            result = add(result, scaled(self.shift[k], self.bump(k, l)))
        return result

    def reference(self, point):
        """l = Phi^-1(point), and the strip."""
        l0 = barycentric(self.corners, point)
        k = self.strip_of(l0)
        if k is None or self.apexes[k] is None:
            return l0, k
        d = self.shift_barycentric[k]

        def on_chord(beta):
            return tuple(l0[n] - d[n] * beta for n in range(3))

        def excess(beta):
            return beta - self.bump(k, on_chord(beta))

        # B_k <= l_k <= 1, and B_k = 0 at the ends of the chord.
        largest = min([mpf(1)] + [l0[n] / d[n] for n in range(3) if d[n] > 0])
        beta = bracketed_root(excess, mpf(0), largest, -self.bump(k, l0), excess(largest))
        l = on_chord(beta)
        require(self.strip_of(l) == k, "the reference point left the strip")
        return l, k


def smooth_map(chart_p, chart_q, point):
    """The mapped point, the reference coordinates and the piece."""
    l, strip_p = chart_p.reference(point)
    return chart_q.point(l), l, (strip_p, chart_q.strip_of(l))


# ------------------------------------------------------------------------------------------------- values of one row


class Values:
    """Outputs of one row."""

    def __init__(self, coordinates, image, jacobian, l=None):
        self.coordinates, self.image, self.jacobian, self.l = coordinates, image, jacobian, l


def differences(function, point, height):
    """The Jacobian (row-major) of a map by central differences. All points used must lie in the same piece."""
    step = height * STEP
    _, piece = function(point)
    columns = []
    for direction in ((step, mpf(0)), (mpf(0), step)):
        forward, forward_piece = function(add(point, direction))
        backward, backward_piece = function(subtract(point, direction))
        if not piece == forward_piece == backward_piece:
            raise Unsuitable("on a line where pieces meet")
        columns.append(scaled(subtract(forward, backward), 1 / (2 * step)))
    (j11, j21), (j12, j22) = columns
    return j11, j12, j21, j22


def close(a, b, tolerance, size=1):
    return all(abs(x - y) <= tolerance * size for x, y in zip(a, b))


def check_affine(corners_p, corners_q, point, values):
    """The Linear system's map is the affine map of the corners."""
    image = affine(corners_q, barycentric(corners_p, point))
    size = max(length(corner) for corner in corners_q)
    require(close(image, values.image, BACK_TOLERANCE, size), "Linear is not affine")
    e, _, c = values.coordinates
    require(abs(c - (1 - 3 * barycentric(corners_p, point)[e])) < BACK_TOLERANCE, "Linear: c is not 1 - 3 l")


def check_contour_closed_forms(system, point):
    """The closed forms of R, phi, r, o, E, L and the smallest root of the cubic agree with the construction."""
    e, half = system.half_edge_of(point)
    half_edge = system.half_edges[e][half]
    b, h = half_edge.b, half_edge.h
    x, y = half_edge.to_frame(point)
    s = half_edge.number_of_contour_through(x, y)
    contour = Contour(b, h, s)
    big_r = mp.sqrt(h**2 * (1 + s) ** 2 + 4 * b**2 * s**2)
    phi = mp.atan2(2 * b * s, h * (1 + s))
    r = h * (1 - s) * big_r / (4 * b * s)
    o = b * s - h**2 * (1 - s**2) / (4 * b * s)
    edge_point = b * s * (1 + h * (1 - s) / (big_r + h * (1 + s)))
    pairs = {
        "R": (big_r / 2, contour.straight_length()),
        "phi": (phi, contour.turning_angle()),
        "r": (r, contour.r),
        "o": (o, contour.o),
        "E": (edge_point, contour.edge_point()),
        "L": (big_r / 2 + r * phi, contour.total_length()),
    }
    for name, (closed, constructed) in pairs.items():
        require(abs(closed - constructed) <= CLOSED_FORM_TOLERANCE * max(abs(closed), b, h), "closed form of " + name)
    if contour.is_straight_at((x, y)):
        m = x / (h - y)
        require(abs(m * h / (2 * b - m * h) - s) < CLOSED_FORM_TOLERANCE, "closed form of s on the straight piece")
        return
    c3 = b**3 + h**2 * b / 4
    c2 = h**2 * b / 2 - 2 * x * b**2 - x * h**2 / 2
    c1 = b * (x**2 + y**2) - 3 * h**2 * b / 4
    c0 = x * h**2 / 2
    terms = (c3 * s**3, c2 * s**2, c1 * s, c0)
    require(abs(sum(terms)) <= CLOSED_FORM_TOLERANCE * max(map(abs, terms)), "s is no root of the cubic")
    # The other roots: those of c3 t^2 + (c2 + c3 s) t + (c1 + s (c2 + c3 s)).
    q1 = c2 + c3 * s
    q0 = c1 + s * q1
    discriminant = q1 * q1 - 4 * c3 * q0
    if discriminant >= 0:
        for sign in (-1, 1):
            other = (-q1 + sign * mp.sqrt(discriminant)) / (2 * c3)
            require(not 0 <= other < s * (1 - CLOSED_FORM_TOLERANCE), "s is not the cubic's smallest root")
    residue = edge_point - y**2 / (r + mp.sqrt(r**2 - y**2)) - x
    require(abs(residue) <= CLOSED_FORM_TOLERANCE * max(b, h), "increasing function for s")


def determinant_ratio(chart, l):
    """Closed form of det DPhi / det affine, and its claimed lower bound."""
    k = chart.strip_of(l)
    if k is None:
        return mpf(1), mpf(1)
    i, j = edge_ends(k)
    u, d, tau = chart.strip_coordinate(k, l), chart.shift_barycentric[k], chart.tau[k]
    slope = (1 - u) ** 2 * (1 - 3 * u) * (1 + 5 * u)
    w_i, w_j = l[i] / (l[i] + l[j]), l[j] / (l[i] + l[j])
    ratio = 1 + d[k] * slope + 12 * tau * u**3 * (1 - u) ** 2 * (d[i] * w_j**2 + d[j] * w_i**2)
    return ratio, min(chart.kappa[k], mpf("0.28"))


def check_smooth_closed_forms(chart_p, chart_q, l, jacobian):
    """D_k, kappa and the determinant ratio."""
    for chart in (chart_p, chart_q):
        corners = chart.corners
        for k, apex in enumerate(chart.apexes):
            if apex is None:
                continue
            i, j = edge_ends(k)
            a, a_star = twice_area(*corners), twice_area(corners[j], corners[i], apex)
            closed = scaled(
                subtract(add(corners[k], apex), add(corners[i], corners[j])),
                -a / (a + a_star),
            )
            size = length(closed) + smallest_height(corners)
            require(close(closed, chart.shift[k], CLOSED_FORM_TOLERANCE, size), "closed form of D")
            d = chart.shift_barycentric[k]
            require(abs(sum(d)) <= CLOSED_FORM_TOLERANCE * max(map(abs, d)), "components of D don't sum to 0")
            require(abs(d[k] - (chart.kappa[k] - 1)) <= CLOSED_FORM_TOLERANCE * max(map(abs, d)), "d_k = kappa - 1")
    ratio_p, bound_p = determinant_ratio(chart_p, l)
    ratio_q, bound_q = determinant_ratio(chart_q, l)
    require(ratio_p >= bound_p and ratio_q >= bound_q, "the determinant ratio falls below its bound")
    expected = ratio_q / ratio_p * twice_area(*chart_q.corners) / twice_area(*chart_p.corners)
    determinant = jacobian[0] * jacobian[3] - jacobian[1] * jacobian[2]
    scale = abs(jacobian[0] * jacobian[3]) + abs(jacobian[1] * jacobian[2])
    require(abs(determinant - expected) <= mpf(10) ** -25 * scale, "closed form of the determinant ratio")


def evaluate(system, case, thorough):
    """The outputs of a case, with checks: the way back always, the closed forms and P = Q when thorough."""
    corners_p, corners_q = high_precision(case["p"]), high_precision(case["q"])
    (point,) = high_precision([case["x"]])
    if not (is_counterclockwise(case["p"]) and is_counterclockwise(case["q"])):
        raise Unsuitable("orientation")
    if not is_strictly_inside(case["p"], case["x"]):
        raise Unsuitable("outside")
    if system == "Contour" and not (is_concordant(case["p"]) and is_concordant(case["q"])):
        raise Unsuitable("discordant")
    l = None
    if system == "Smooth":
        for name in ("p", "q"):
            for k, (i, j) in enumerate(map(edge_ends, range(3))):
                apex = case[name + "_apexes"][k]
                if apex is not None and not is_counterclockwise((case[name][j], case[name][i], apex)):
                    raise Unsuitable("an apex is not across its edge")
        chart_p = Chart(corners_p, high_precision(case["p_apexes"]))
        chart_q = Chart(corners_q, high_precision(case["q_apexes"]))

        def forward(x):
            image, _, piece = smooth_map(chart_p, chart_q, x)
            return image, piece

        def backward(x):
            return smooth_map(chart_q, chart_p, x)[0]

        def identity(x):
            return smooth_map(chart_p, chart_p, x)[0]

        image, l, _ = smooth_map(chart_p, chart_q, point)
        coordinates, _ = EQUILATERAL_SYSTEM.triangular(affine(EQUILATERAL, l))
        require(min(l) == l[coordinates[0]], "Smooth: the edge is not the one of the smallest l")
        require(abs(sum(l) - 1) < BACK_TOLERANCE, "Smooth: l does not sum to 1")
    else:
        if system == "Linear":
            system_p, system_q = LinearSystem(corners_p), LinearSystem(corners_q)
        else:
            center_of = incenter if system == "ContourIncenter" else centroid
            system_p, system_q = ContourSystem(corners_p, center_of), ContourSystem(corners_q, center_of)

        def forward(x):
            coordinates, piece_p = system_p.triangular(x)
            image, piece_q = system_q.cartesian(coordinates)
            return image, piece_p + piece_q

        def backward(x):
            return system_p.cartesian(system_q.triangular(x)[0])[0]

        def identity(x):
            return system_p.cartesian(system_p.triangular(x)[0])[0]

        coordinates, _ = system_p.triangular(point)
        image, _ = system_q.cartesian(coordinates)
    jacobian = differences(forward, point, smallest_height(corners_p))

    _, p, c = coordinates
    require(0 < p < 1 and 0 < c < 1, "p or c is outside (0, 1)")
    require(jacobian[0] * jacobian[3] > jacobian[1] * jacobian[2], "the Jacobian's determinant is not positive")
    require(min(barycentric(corners_q, image)) > 0, "the image is outside")
    size = max(map(length, corners_p)) + length(point)
    require(close(backward(image), point, BACK_TOLERANCE, size), "there and back is not the identity")
    values = Values(coordinates, image, jacobian, l)
    if system == "Linear":
        check_affine(corners_p, corners_q, point, values)
    if system == "Smooth":
        check_smooth_closed_forms(chart_p, chart_q, l, jacobian)
    if thorough:
        require(close(identity(point), point, BACK_TOLERANCE, size), "P = Q is not the identity")
        if system.startswith("Contour"):
            check_contour_closed_forms(system_p, point)
            check_contour_closed_forms(system_q, image)
    return values


# ------------------------------------------------------------------------------------------------- random inputs


def snap(value, step):
    """The nearest multiple of a power of two."""
    return float(round(value / step) * step)


def power_of_two_below(value):
    return 2.0 ** math.floor(math.log2(value))


def decade(rng, lowest, highest):
    """10 to a uniformly random exponent."""
    return 10.0 ** rng.uniform(lowest, highest)


def float_height(corners):
    return float(smallest_height(high_precision(corners)))


def placed(rng, corners):
    """Integer corners, turned and enlarged by a random Gaussian integer, scaled, numbered from a random corner.

    All exact, so an isosceles triangle stays isosceles. Sometimes moved (by integers), too.
    """
    while True:
        m, n = rng.randint(-4, 4), rng.randint(-4, 4)
        if m or n:
            break
    corners = [(m * x - n * y, m * y + n * x) for x, y in corners]
    if twice_area(*corners) < 0:
        corners.reverse()
    size = max(max(abs(x), abs(y)) for x, y in corners)
    scale = 2.0 ** (rng.choice((3, 3, 3, 0, 6, 10)) - math.ceil(math.log2(size)))
    dx, dy = (rng.randint(-9, 9), rng.randint(-9, 9)) if rng.random() < 0.4 else (0, 0)
    corners = [(x * scale + dx, y * scale + dy) for x, y in corners]
    first = rng.randrange(3)
    return [corners[(first + n) % 3] for n in range(3)]


def random_corners(rng):
    """Integer corners with aspect at most 30."""
    while True:
        corners = [(rng.randint(-256, 256), rng.randint(-256, 256)) for _ in range(3)]
        if twice_area(*corners) < 0:
            corners.reverse()
        longest = max(math.dist(corners[i], corners[j]) for i, j in map(edge_ends, range(3)))
        if twice_area(*corners) * 30 > longest * longest:
            return corners


def needle_corners(rng, largest_aspect):
    """A tall or a flat needle, sheared."""
    aspect = decade(rng, 1, math.log10(largest_aspect))
    if rng.random() < 0.5:
        w = rng.randint(16, 64)
        return [(0, 0), (w, 0), (round(w * rng.uniform(-2, 3)), round(w * aspect))]
    h = rng.randint(4, 16)
    w = round(h * aspect)
    return [(0, 0), (w, 0), (round(w * rng.uniform(0.02, 0.98)), h)]


def is_obtuse(corners):
    return any(
        dot(subtract(corners[i], corners[k]), subtract(corners[j], corners[k])) < 0
        for k, (i, j) in enumerate(map(edge_ends, range(3)))
    )


def any_triangle(rng):
    """Any triangle with aspect up to 1e3."""
    corners = random_corners(rng) if rng.random() < 0.6 else needle_corners(rng, 1e3)
    return placed(rng, corners)


def nearly_discordant(rng):
    """A concordant triangle in which a foot is within a proportion 1e-8 ... 1e-2 of the end of its edge."""
    while True:
        start, end = random_corners(rng), random_corners(rng)
        end = [start[0], start[1], end[2]]
        if not is_concordant(start) or twice_area(*end) <= 0 or is_concordant(end):
            continue
        margin = decade(rng, -8, -2)
        low, high = 0.0, 1.0
        corners = start
        for _ in range(60):
            middle = (low + high) / 2
            apex = tuple(snap((1 - middle) * start[2][n] + middle * end[2][n], 2.0**-36) for n in range(2))
            corners = [start[0], start[1], apex]
            if concordance_margin(corners) > margin:
                low = middle
            else:
                high = middle
        if 0 < concordance_margin(corners) < 10 * margin and is_counterclockwise(corners):
            scale = 2.0 ** rng.choice((-8, -5, 0))
            return [(x * scale, y * scale) for x, y in corners]


def concordant_triangle(rng):
    """A concordant triangle of one of the kinds: acute, obtuse, isosceles obtuse, needles, nearly discordant."""
    while True:
        kind = rng.choice(
            ("acute", "acute", "obtuse", "obtuse", "isosceles obtuse", "tall", "tall scalene", "flat", "nearly discordant")
        )
        if kind == "acute" or kind == "obtuse":
            corners = random_corners(rng)
            if is_obtuse(corners) != (kind == "obtuse"):
                continue
        elif kind == "isosceles obtuse":
            w = rng.randint(64, 512)
            corners = [(-w, 0), (w, 0), (0, rng.randint(w // 16, w - 1))]
        elif kind == "tall":
            w = rng.randint(8, 64)
            corners = [(-w, 0), (w, 0), (0, round(2 * w * decade(rng, 0.3, 4)))]
        elif kind == "tall scalene":
            w = rng.randint(64, 256)
            corners = [(-w, 0), (w, 0), (round(w * rng.uniform(-2.9, 2.9)), round(2 * w * decade(rng, 0.3, 4)))]
        elif kind == "flat":
            h = rng.randint(2, 16)
            corners = [(-round(h / 2 * decade(rng, 1, 4)), 0), (0, 0), (0, h)]
            corners[1] = (-corners[0][0], 0)
        else:
            return nearly_discordant(rng)
        if is_concordant(corners):
            corners = placed(rng, corners)
            if is_counterclockwise(corners) and is_concordant(corners):
                return corners


def random_apexes(rng, corners, has_neighbor):
    """Apexes across the edges: usual ones, very high or low ones, sheared ones."""
    apexes = []
    for k in range(3):
        i, j = edge_ends(k)
        if not has_neighbor[k]:
            apexes.append(None)
            continue
        edge = subtract(corners[j], corners[i])
        ratio = decade(rng, -4, 4) if rng.random() < 0.4 else decade(rng, -0.5, 0.5)
        position = rng.uniform(-6, 7) if rng.random() < 0.35 else rng.uniform(-0.2, 1.2)
        down = ratio * twice_area(*corners) / dot(edge, edge)
        target = (corners[i][0] + position * edge[0] + down * edge[1], corners[i][1] + position * edge[1] - down * edge[0])
        step = power_of_two_below(down * math.hypot(*edge)) / 16
        while True:
            apex = tuple(snap(value, step) for value in target)
            if is_counterclockwise((corners[j], corners[i], apex)):
                break
            step /= 4
        apexes.append(apex)
    return apexes


def uniform_point(rng, corners):
    """A uniformly random point, on a dyadic grid."""
    step = power_of_two_below(float_height(corners)) / 128
    while True:
        a, b = rng.random(), rng.random()
        if a + b > 1:
            a, b = 1 - a, 1 - b
        point = tuple(snap(value, step) for value in affine(corners, (a, b, 1 - a - b)))
        if is_strictly_inside(corners, point):
            return point


def near_segment(rng, start, end, size):
    """Close to a random point of a segment, on a random side of it."""
    t = mpf(rng.uniform(0.02, 0.98))
    direction = subtract(end, start)
    offset = size * decade(rng, -10, -9) * rng.choice((-1, 1)) / length(direction)
    point = between(start, end, t)
    return (point[0] - offset * direction[1], point[1] + offset * direction[0])


def special_point(rng, corners, place, center_of=centroid):
    """A point close to a special place of a triangle."""
    size = smallest_height(corners)
    if place == "vertex":
        k = rng.randrange(3)
        direction = subtract(affine(corners, barycentric_direction(rng)), corners[k])
        return add(corners[k], scaled(direction, mpf(decade(rng, -9, -3))))
    if place == "edge":
        k = rng.randrange(3)
        i, j = edge_ends(k)
        l = [mpf(0)] * 3
        l[k] = mpf(decade(rng, -10, -9))
        l[i] = (1 - l[k]) * rng.uniform(0.001, 0.999)
        l[j] = 1 - l[k] - l[i]
        return affine(corners, l)
    if place == "center":
        direction = subtract(affine(corners, barycentric_direction(rng)), center_of(corners))
        return add(center_of(corners), scaled(direction, mpf(decade(rng, -9, -3))))
    if place == "spoke":
        return near_segment(rng, center_of(corners), rng.choice(corners), size)
    system = ContourSystem(corners, center_of)
    e = rng.randrange(3)
    if place == "center segment":
        return near_segment(rng, system.center, system.feet[e], size)
    require(place == "wing segment", "unknown place")
    middle = between(system.center, system.feet[e], mpf(1) / 2)
    return near_segment(rng, middle, corners[rng.choice(edge_ends(e))], size)


def barycentric_direction(rng):
    """Random barycentric coordinates."""
    a, b = rng.random(), rng.random()
    if a + b > 1:
        a, b = 1 - a, 1 - b
    return mpf(a), mpf(b), 1 - mpf(a) - mpf(b)


def strip_point(rng, chart, u):
    """Reference coordinates with strip coordinate u in the strip of an edge that has a neighbor (if any has)."""
    candidates = [k for k in range(3) if chart.apexes[k] is not None] or [0, 1, 2]
    k = rng.choice(candidates)
    i, j = edge_ends(k)
    w = mpf(rng.uniform(0.02, 0.98))
    t = u * chart.tau[k] * w * (1 - w)
    l = [mpf(0)] * 3
    l[k] = t / (1 + t)
    l[i], l[j] = (1 - w) / (1 + t), w / (1 + t)
    return l


CONTOUR_PLACES = ("edge", "vertex", "center", "wing segment", "center segment", "spoke")
PLACES = {
    "Linear": ("edge", "vertex", "center", "spoke"),
    "Contour": CONTOUR_PLACES,
    "ContourIncenter": CONTOUR_PLACES,
    "Smooth": CONTOUR_PLACES + ("strip border", "strip border", "strip", "strip"),
}


def special_point_of_pair(rng, system, case):
    """A point of P close to a special place of P or to where a special place of Q comes from, as doubles."""
    place = rng.choice(PLACES[system])
    of_q = rng.random() < 0.3
    corners_p, corners_q = high_precision(case["p"]), high_precision(case["q"])
    if system == "Smooth":
        chart_p = Chart(corners_p, high_precision(case["p_apexes"]))
        chart_q = Chart(corners_q, high_precision(case["q_apexes"]))
        if place == "strip border":
            u = 1 + mpf(rng.choice((-1, 1)) * decade(rng, -10, -9))
            l = strip_point(rng, chart_q if of_q else chart_p, u)
        elif place == "strip":
            l = strip_point(rng, chart_q if of_q else chart_p, mpf(rng.uniform(0.1, 0.6)))
        else:
            l = barycentric(EQUILATERAL, special_point(rng, EQUILATERAL, place))
        if min(l) <= 0:
            raise Unsuitable("outside")
        point = chart_p.point(l)
    else:
        center_of = incenter if system == "ContourIncenter" else centroid
        corners = corners_q if of_q else corners_p
        point = special_point(rng, corners, place, center_of)
        if min(barycentric(corners, point)) <= 0:
            raise Unsuitable("outside")
        if of_q and system == "Linear":
            point = affine(corners_p, barycentric(corners_q, point))
        elif of_q:
            coordinates, _ = ContourSystem(corners_q, center_of).triangular(point)
            point, _ = ContourSystem(corners_p, center_of).cartesian(coordinates)
    return tuple(float(value) for value in point)


def random_case(rng, system):
    """The inputs of a row."""
    triangle = concordant_triangle if system == "Contour" else any_triangle
    case = {"p": triangle(rng), "q": triangle(rng)}
    if system == "Smooth":
        has_neighbor = [rng.random() < 0.9 for _ in range(3)]
        case["p_apexes"] = random_apexes(rng, case["p"], has_neighbor)
        case["q_apexes"] = random_apexes(rng, case["q"], has_neighbor)
    if rng.random() < 0.6:
        case["x"] = uniform_point(rng, case["p"])
    else:
        case["x"] = special_point_of_pair(rng, system, case)
    return case


# ------------------------------------------------------------------------------------------------- files

ROWS = {"Linear": 1000, "Contour": 1000, "ContourIncenter": 300, "Smooth": 1500}

DESCRIPTIONS = {
    "Linear": "the Linear coordinate system (any triangles)",
    "Contour": "the Contour coordinate system with the centroid as center (concordant triangles)",
    "ContourIncenter": "the Contour coordinate system with the incenter as center (any triangles)",
    "Smooth": "the Smooth coordinate system (any triangles, with the apexes of the neighbors)",
}


def columns_of(system):
    """Names of the input columns and of the output columns."""
    inputs = []
    for name in ("p", "q"):
        inputs += ["%s%s%d" % (name, axis, n) for n in (1, 2, 3) for axis in "xy"]
        if system == "Smooth":
            inputs += ["%sn%s%d" % (name, axis, n) for n in (1, 2, 3) for axis in "xy"]
    inputs += ["x", "y"]
    outputs = ["e", "p", "c", "u", "v", "J11", "J12", "J21", "J22"]
    if system == "Smooth":
        outputs += ["l1", "l2", "l3"]
    return inputs, outputs


def comments_of(system):
    lines = [
        "SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors",
        "SPDX-License-Identifier: BSD-3-Clause",
        "",
        "Reference values of " + DESCRIPTIONS[system] + ".",
        "Made by: Testing/Reference/reference_values.py --output Testing/Data",
        "Inputs are doubles (each decimal parses to exactly the double used), outputs have 25 significant digits.",
        "px1..py3, qx1..qy3: the corners of the triangles P and Q, counterclockwise.",
    ]
    if system == "Smooth":
        lines += [
            "pnx1..pny3, qnx1..qny3: the apexes of the neighbors across the edges opposite corners 1, 2, 3; nan on the boundary.",
        ]
    lines += [
        "x, y: a point strictly inside P.",
        "e, p, c: its triangular coordinates. Edge e (1, 2, 3) is opposite corner e; p runs from 0 at the next corner in cyclic",
        "order to 1 at the one after; c is 0 at the center and 1 on the edge.",
        "u, v: the point of Q it is mapped to. J11, J12, J21, J22: the map's Jacobian, du/dx, du/dy, dv/dx, dv/dy.",
    ]
    if system == "Smooth":
        lines += ["l1, l2, l3: the point's reference coordinates (of which e, p, c are the Contour coordinates in an equilateral triangle)."]
    return ["# " + line if line else "#" for line in lines]


def format_input(value):
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def format_outputs(system, case, values):
    """Texts of the outputs. Differences far below the last digit of the largest entry are zero."""
    e, p, c = values.coordinates
    largest = max(map(abs, values.jacobian))
    jacobian = [mpf(0) if abs(value) < largest * mpf(10) ** -50 else value for value in values.jacobian]
    size = max(abs(value) for corner in case["q"] for value in corner)
    image = [mpf(0) if abs(value) < size * mpf(10) ** -70 else value for value in values.image]
    numbers = [p, c] + image + jacobian + (list(values.l) if system == "Smooth" else [])
    return [str(e + 1)] + ["0" if value == 0 else mp.nstr(value, OUTPUT_DIGITS) for value in numbers]


def format_inputs(system, case):
    texts = []
    for name in ("p", "q"):
        for corner in case[name]:
            texts += map(format_input, corner)
        if system == "Smooth":
            for apex in case[name + "_apexes"]:
                texts += ["nan", "nan"] if apex is None else map(format_input, apex)
    texts += map(format_input, case["x"])
    return texts


def parse_inputs(system, texts):
    """The case of a row's input columns."""
    values = [float(text) for text in texts]
    points = list(zip(values[0::2], values[1::2]))
    points = [None if math.isnan(point[0]) else point for point in points]
    if system == "Smooth":
        return {"p": points[0:3], "p_apexes": points[3:6], "q": points[6:9], "q_apexes": points[9:12], "x": points[12]}
    return {"p": points[0:3], "q": points[3:6], "x": points[6]}


def make_row(task):
    """One row of a file. Each row has its own random numbers."""
    system, index = task
    rng = random.Random("%d %s %d" % (SEED, system, index))
    while True:
        try:
            case = random_case(rng, system)
            values = evaluate(system, case, thorough=index % 4 == 0)
        except Unsuitable:
            continue
        inputs = format_inputs(system, case)
        require(parse_inputs(system, inputs) == case, "inputs don't parse to the doubles used")
        return ",".join(inputs + format_outputs(system, case, values))


def compare_row(task):
    """Recomputes a row. Returns the differences found."""
    system, number, line = task
    inputs, outputs = columns_of(system)
    texts = line.split(",")
    where = "%s, row %d" % (system, number)
    if len(texts) != len(inputs) + len(outputs):
        return ["%s: %d columns" % (where, len(texts))]
    case = parse_inputs(system, texts[: len(inputs)])
    try:
        expected = format_outputs(system, case, evaluate(system, case, thorough=True))
    except Unsuitable as reason:
        return ["%s: no test case: %s" % (where, reason)]
    differing = []
    for name, found, wanted in zip(outputs, texts[len(inputs) :], expected):
        try:
            a, b = mpf(found), mpf(wanted)
            same = abs(a - b) <= CHECK_TOLERANCE * abs(b)
        except ValueError:
            same = False
        if not same:
            differing.append("%s: %s is %s, not %s" % (where, name, found, wanted))
    return differing


def file_of(directory, system):
    return os.path.join(directory, "Reference%s.csv" % system)


def write_files(directory, pool):
    os.makedirs(directory, exist_ok=True)
    for system, count in ROWS.items():
        rows = pool.map(make_row, [(system, index) for index in range(count)], chunksize=10)
        inputs, outputs = columns_of(system)
        with open(file_of(directory, system), "w", encoding="ascii", newline="\n") as file:
            file.write("\n".join(comments_of(system) + [",".join(inputs + outputs)] + rows) + "\n")
        print("%s: %d rows" % (os.path.basename(file_of(directory, system)), count), flush=True)


def check_files(directory, pool, rows_per_file, seed):
    """Compares a random subset of the rows. Returns the number of differences."""
    rng = random.Random(seed)
    print("seed %d" % seed)
    differing = []
    for system, count in ROWS.items():
        with open(file_of(directory, system), encoding="ascii") as file:
            lines = [line.rstrip("\n") for line in file if not line.startswith("#")]
        inputs, outputs = columns_of(system)
        if not lines or lines[0] != ",".join(inputs + outputs):
            differing.append("%s: unexpected header" % system)
            continue
        rows = lines[1:]
        if len(rows) != count:
            differing.append("%s: %d rows, not %d" % (system, len(rows), count))
        chosen = sorted(rng.sample(range(len(rows)), min(rows_per_file, len(rows))))
        for found in pool.imap(compare_row, [(system, index + 1, rows[index]) for index in chosen]):
            differing += found
        print("%s: %d of %d rows compared" % (os.path.basename(file_of(directory, system)), len(chosen), len(rows)))
    for text in differing:
        print(text, file=sys.stderr)
    return len(differing)


def main():
    parser = argparse.ArgumentParser(description="Reference values of the coordinate systems Linear, Contour and Smooth.")
    parser.add_argument("--output", metavar="DIR", required=True, help="directory of the files")
    parser.add_argument("--check", action="store_true", help="compare the files with recomputed values")
    parser.add_argument("--rows", type=int, default=50, help="rows per file to compare (default: 50)")
    parser.add_argument("--seed", type=int, help="choice of the rows to compare (default: random)")
    arguments = parser.parse_args()
    with multiprocessing.Pool() as pool:
        if arguments.check:
            seed = random.randrange(10**9) if arguments.seed is None else arguments.seed
            return 1 if check_files(arguments.output, pool, arguments.rows, seed) else 0
        write_files(arguments.output, pool)
    return 0


if __name__ == "__main__":
    sys.exit(main())
