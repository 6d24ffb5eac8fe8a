# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Warps a photograph of 4096 x 4096 pixels, with straight lines drawn across it, onto another face by Linear, Smooth,
Cubic and a thin-plate spline (photographs of Debian's package gtkmorph-example). Writes an image for each map.

    photograph.py [FOLDER]"""

import sys

import numpy
from PIL import Image, ImageDraw
from scipy.interpolate import RBFInterpolator
from scipy.ndimage import map_coordinates, zoom
from vtkhomeomorphism import Homeomorphism, xmorph

SIZE, STRIP, COARSE = 4096, 256, 257
FILES = [f"/usr/share/xmorph/example/AD/image{k}.png" for k in (1, 2)]

photograph = Image.open(FILES[0]).convert("RGB").resize((SIZE, SIZE), Image.Resampling.BICUBIC)
pen = ImageDraw.Draw(photograph)
for k in range(1, 16):
    pen.line([(0, SIZE * k // 16), (SIZE, SIZE * (k + 1) // 16)], fill=(255, 230, 60), width=9)
pixels = numpy.asarray(photograph)
grids = [xmorph.read(name + ".mesh") for name in FILES]
triangles = xmorph.triangulate(*grids)
source, target = ((grid / xmorph.extent(grid)).reshape(-1, 2) for grid in grids)

coarse = numpy.stack(numpy.meshgrid(*[numpy.linspace(0, 1, COARSE)] * 2), -1)
spline = RBFInterpolator(target, source, kernel="thin_plate_spline")(coarse.reshape(-1, 2)).reshape(coarse.shape)
spline = numpy.stack([zoom(spline[..., k], SIZE / COARSE, order=3, grid_mode=True, mode="nearest") for k in (0, 1)], -1)
maps = {"linear": None, "smooth": None, "cubic": None, "spline": spline}
across = (numpy.arange(SIZE) + 0.5) / SIZE
for name, places in maps.items():
    f = Homeomorphism(source, target, triangles, name) if places is None else None
    warped = numpy.zeros_like(pixels)
    for row in range(0, SIZE, STRIP):
        if f:
            points = numpy.stack(numpy.meshgrid(across, across[row : row + STRIP]), -1)
            strip = f.inverse(points.reshape(-1, 2)).reshape(points.shape)
        else:
            strip = places[row : row + STRIP]
        at = numpy.nan_to_num(numpy.moveaxis(strip[..., ::-1], -1, 0) * SIZE - 0.5)
        for channel in range(3):
            warped[row : row + STRIP, :, channel] = map_coordinates(pixels[..., channel], at, order=1, mode="nearest")
    Image.fromarray(warped).save(f"{sys.argv[1] if len(sys.argv) > 1 else '.'}/photograph-{name}.png")
