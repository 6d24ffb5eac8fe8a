#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Exact reference values of the cubic element, in rational numbers.

The interpolant is computed here from its definition: thirty unknown Bernstein ordinates of three
cubics, and one linear equation for each value and derivative at a corner, for each condition of
continuous first derivatives inside, and for each edge's normal derivative to be linear. The
determinant is multiplied out as a polynomial. Writes Testing/Data/cubic_element.csv; with --check,
compares a sample with the file.
"""

import argparse
import pathlib
import random
from fractions import Fraction as F
from math import comb, factorial

PIECES = [(1, 2), (2, 0), (0, 1)]  # corners of piece k, then the centroid
INDICES = [(3 - e - c, e, c) for c in range(4) for e in range(4 - c)]


def solve(rows, right):
    """Gauss elimination in rational numbers."""
    n = len(rows[0])
    rows = [r + [b] for r, b in zip(rows, right)]
    pivots = []
    at = 0
    for column in range(n):
        pivot = next((i for i in range(at, len(rows)) if rows[i][column] != 0), None)
        if pivot is None:
            raise ValueError("singular")
        rows[at], rows[pivot] = rows[pivot], rows[at]
        scale = rows[at][column]
        rows[at] = [x / scale for x in rows[at]]
        for i, row in enumerate(rows):
            if i != at and row[column] != 0:
                factor = row[column]
                rows[i] = [x - factor * y for x, y in zip(row, rows[at])]
        pivots.append(column)
        at += 1
    if any(row[n] != 0 for row in rows[at:]):
        raise ValueError("contradiction")
    return [rows[i][n] for i in range(n)]


def corners_of(points, k):
    centroid = tuple((points[0][d] + points[1][d] + points[2][d]) / 3 for d in (0, 1))
    i, j = PIECES[k]
    return points[i], points[j], centroid


def gradients_of_barycentric(corners):
    (ax, ay), (bx, by), (cx, cy) = corners
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return [((by - cy) / area, (cx - bx) / area), ((cy - ay) / area, (ax - cx) / area),
            ((ay - by) / area, (bx - ax) / area)]


def bernstein(index, l):
    value = F(factorial(sum(index)))
    for i in range(3):
        value = value * l[i] ** index[i] / factorial(index[i])
    return value


def derivative_row(corners, l, direction):
    """Weights of the ten ordinates in the derivative along a direction at barycentric l."""
    slopes = [g[0] * direction[0] + g[1] * direction[1] for g in gradients_of_barycentric(corners)]
    row = []
    for index in INDICES:
        value = F(0)
        for i in range(3):
            if index[i] > 0:
                lower = list(index)
                lower[i] -= 1
                value += 3 * slopes[i] * bernstein(lower, l)
        row.append(value)
    return row


def interpolate(points, values, gradients):
    """Ordinates of the three cubics of one component."""
    rows, right = [], []

    def add(parts, b):
        row = [F(0)] * 30
        for piece, weights in parts:
            for n, w in enumerate(weights):
                row[10 * piece + n] += w
        rows.append(row)
        right.append(b)

    corner = [(F(1), F(0), F(0)), (F(0), F(1), F(0)), (F(0), F(0), F(1))]
    for k in range(3):
        corners = corners_of(points, k)
        for end in range(2):
            vertex = PIECES[k][end]
            add([(k, [bernstein(i, corner[end]) for i in INDICES])], values[vertex])
            for d in range(2):
                unit = (F(1), F(0)) if d == 0 else (F(0), F(1))
                add([(k, derivative_row(corners, corner[end], unit))], gradients[vertex][d])
        # The second difference of the normal derivative along the edge vanishes.
        (ax, ay), (bx, by) = corners[:2]
        normal = (ay - by, bx - ax)
        parts = [F(1), F(-2), F(1)]
        row = [F(0)] * 10
        for weight, s in zip(parts, (F(0), F(1, 2), F(1))):
            for n, w in enumerate(derivative_row(corners, (1 - s, s, F(0)), normal)):
                row[n] += weight * w
        add([(k, row)], F(0))
    # Values and first derivatives agree along the segments from the corners to the centroid.
    for vertex in range(3):
        pieces = [(k, PIECES[k].index(vertex)) for k in range(3) if vertex in PIECES[k]]
        for s in (F(0), F(1, 3), F(2, 3), F(1)):
            ls = []
            for k, end in pieces:
                l = [F(0), F(0), s]
                l[end] = 1 - s
                ls.append(l)
            a, b = pieces[0][0], pieces[1][0]
            add([(a, [bernstein(i, ls[0]) for i in INDICES]),
                 (b, [-bernstein(i, ls[1]) for i in INDICES])], F(0))
            if s < 1:
                for unit in ((F(1), F(0)), (F(0), F(1))):
                    add([(a, derivative_row(corners_of(points, a), ls[0], unit)),
                         (b, [-w for w in derivative_row(corners_of(points, b), ls[1], unit)])],
                        F(0))
    ordinates = solve(rows, right)
    return [ordinates[10 * k:10 * k + 10] for k in range(3)]


def quadratic(ordinates, slopes):
    """Bernstein ordinates of a derivative of a cubic."""
    by = dict(zip(INDICES, ordinates))
    result = {}
    for c in range(3):
        for e in range(3 - c):
            index = (2 - e - c, e, c)
            value = F(0)
            for i in range(3):
                upper = list(index)
                upper[i] += 1
                value += 3 * slopes[i] * by[tuple(upper)]
            result[index] = value
    return result


def multinomial(index):
    return F(factorial(sum(index)), factorial(index[0]) * factorial(index[1]) * factorial(index[2]))


def product(a, b):
    result = {}
    for i, x in a.items():
        for j, y in b.items():
            index = tuple(p + q for p, q in zip(i, j))
            result[index] = result.get(index, F(0)) + (
                multinomial(i) * multinomial(j) / multinomial(index) * x * y)
    return result


def determinant(element):
    """45 Bernstein coefficients, in the order of the C++ code."""
    points, affine, values, gradients = element
    pieces = [interpolate(points, [v[c] for v in values],
                          [(g[0][c], g[1][c]) for g in gradients]) for c in range(2)]
    coefficients = []
    for k in range(3):
        slopes = gradients_of_barycentric(corners_of(points, k))
        parts = {}
        for c in range(2):
            for d in range(2):
                q = quadratic(pieces[c][k], [s[d] for s in slopes])
                parts[c, d] = {i: x + affine[d][c] for i, x in q.items()}
        plus, minus = product(parts[0, 0], parts[1, 1]), product(parts[0, 1], parts[1, 0])
        for c in range(5):
            for e in range(5 - c):
                index = (4 - e - c, e, c)
                coefficients.append(plus[index] - minus[index])
    return coefficients


def value_at(element, k, l):
    points, _, values, gradients = element
    result = []
    for c in range(2):
        cubic = interpolate(points, [v[c] for v in values],
                            [(g[0][c], g[1][c]) for g in gradients])[k]
        result.append(sum(bernstein(i, l) * x for i, x in zip(INDICES, cubic)))
    return result


def exact(numbers):
    return [F(x) for x in numbers]


def make(generator, kind):
    """28 doubles: three points, the affine matrix by columns, three values, three gradients."""
    u = lambda: generator.uniform(-1.0, 1.0)
    size = 10.0 ** generator.uniform(-6, 3)
    flat = 10.0 ** generator.uniform(-4, 0)
    while True:
        points = [size * u(), size * flat * u(), size * u(), size * flat * u(), size * u(),
                  size * flat * u()]
        p = exact(points)
        area = (p[2] - p[0]) * (p[5] - p[1]) - (p[3] - p[1]) * (p[4] - p[0])
        if area > F(size * size * flat * 0.1):
            break
    affine = [u(), u(), u(), u()]
    values = [size * flat * u() * 0.1 for _ in range(6)]
    gradients = [0.3 * u() for _ in range(12)]
    if kind > 0:
        # The derivative at corner 0 has a determinant next to zero, of either sign, or zero: its
        # second column is a power of two times the first, and then is changed by a few units.
        ratio = 2.0 ** generator.randint(-2, 2)
        total = [affine[0] + gradients[0], affine[1] + gradients[1]]
        affine[0], affine[1] = total
        gradients[0] = gradients[1] = 0.0
        affine[2], affine[3] = ratio * total[0], ratio * total[1]
        gradients[2] = gradients[3] = 0.0
        if kind == 1:
            gradients[3] = generator.choice([-1, 1]) * 10.0 ** generator.uniform(-16, -11)
    return points + affine + values + gradients


def to_element(numbers):
    n = exact(numbers)
    return ([(n[0], n[1]), (n[2], n[3]), (n[4], n[5])], [(n[6], n[7]), (n[8], n[9])],
            [(n[10], n[11]), (n[12], n[13]), (n[14], n[15])],
            [((n[16 + 4 * i], n[17 + 4 * i]), (n[18 + 4 * i], n[19 + 4 * i])) for i in range(3)])


def rows():
    generator = random.Random(7)
    for n in range(45):
        numbers = make(generator, n % 3)
        element = to_element(numbers)
        l = [F(generator.randint(1, 60), 64), F(0), F(0)]
        l[1] = (1 - l[0]) * F(generator.randint(0, 8), 8)
        l[2] = 1 - l[0] - l[1]
        k = generator.randint(0, 2)
        yield numbers, [k] + [float(x) for x in l] + [
            float(x) for x in value_at(element, k, l)] + [float(c) for c in determinant(element)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parent.parent / "Data")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    path = arguments.output / "cubic_element.csv"
    lines = path.read_text().splitlines()[1:] if arguments.check else None
    if arguments.check:
        for line, (numbers, results) in zip(lines[:6], rows()):
            assert [float(x) for x in line.split(",")] == [float(x) for x in numbers + results], line
        return
    header = ("ax,ay,bx,by,cx,cy,xx,xy,yx,yy," + ",".join(f"v{i}" for i in range(6)) + "," +
              ",".join(f"g{i}" for i in range(12)) + ",piece,l0,l1,l2,fx,fy," +
              ",".join(f"c{i}" for i in range(45)))
    with path.open("w") as stream:
        print(header, file=stream)
        for numbers, results in rows():
            print(",".join(repr(x) for x in numbers + results), file=stream)


if __name__ == "__main__":
    main()
