# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Warps points and an image with numpy: python3 warp.py [FILE.png]

Writes the image before and after, side by side."""

import sys

import numpy
from vtkhomeomorphism import Homeomorphism
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

# A square of 300 x 300 pixels, triangulated by a grid of 6 x 6 points, whose inner points are moved.
size, count = 300, 6
random = numpy.random.default_rng(4)
x, y = numpy.meshgrid(*2 * [numpy.linspace(0, size - 1, count)])
source = numpy.column_stack((x.ravel(), y.ravel()))
inner = (source > 0).all(axis=1) & (source < size - 1).all(axis=1)
target = source + 20 * random.uniform(-1, 1, source.shape) * inner[:, None]
first = numpy.arange(count * (count - 1)).reshape(count - 1, count)[:, :-1].ravel()
triangles = numpy.vstack(
    [numpy.column_stack((first, first + 1, first + count + 1)),
     numpy.column_stack((first, first + count + 1, first + count))]
)
f = Homeomorphism(source, target, triangles)

points = random.uniform(0, size - 1, (100000, 2))
error = numpy.abs(f.inverse(f(points)) - points).max()
determinants = numpy.linalg.det(f.jacobian(points))
print(f"round trip of {len(points)} points: errors of at most {error:.1e} pixels")
print(f"areas change by factors between {determinants.min():.2f} and {determinants.max():.2f}")

# A checkerboard of two grays, with lines.
row, column = numpy.mgrid[0:size, 0:size]
image = numpy.where((row // 25 + column // 25) % 2, 225, 250).astype(numpy.uint8)
image[(row % 25 < 2) | (column % 25 < 2)] = 90
warped = f.warp_image(image, background=255)

pixels = numpy.hstack((image, numpy.full((size, 10), 255, numpy.uint8), warped))
picture = vtkImageData()
picture.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
picture.GetPointData().SetScalars(numpy_to_vtk(pixels.ravel(), deep=1))
writer = vtkPNGWriter()
writer.SetInputData(picture)
writer.SetFileName(sys.argv[1] if len(sys.argv) > 1 else "warped.png")
writer.Write()
if writer.GetErrorCode():
    sys.exit("Cannot write " + writer.GetFileName())
print("wrote", writer.GetFileName())
