# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Images by Pillow and rasters by rasterio: read in windows and warped in tiles, so that only parts of large GeoTIFF
files are in memory."""

import io
import logging
import math
import warnings
from dataclasses import dataclass, replace

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

from . import meshes, vtkfiles
from .files import FILE, PICTURES, USAGE, Failure, dotted, import_extra, inform, progress
from .mapping import MASK, PointMap, run
from .vtkFiltersHomeomorphism import vtkResampleThroughHomeomorphism

TILE = 2048
MOST_PIXELS = 2**31
"""Of images that are read as a whole."""
PILLOW_FORMATS = {"jpg": "JPEG", "jpeg": "JPEG", "png": "PNG", "bmp": "BMP", "webp": "WEBP"}
OPAQUE = ("jpg", "jpeg", "ppm", "pgm", "pnm", "bmp")
WRITE = PICTURES + ("vti",)


@dataclass
class Grid:
    """The position of pixels: (x, y) is the center of the left one of the upper row. Rows and columns are parallel to
    the axes, unless `turn` says how they lie: then pixel (column, row) is the point (column, -row) of the plane, and
    `turn` an affine map (rasterio.Affine) from there to the ground."""

    width: int
    height: int
    x: float = 0.0
    y: float = None
    dx: float = 1.0
    dy: float = 1.0
    crs: object = None
    placed: bool = False
    """Whether the file is georeferenced; otherwise the center of the lower left pixel is (0, 0)."""
    turn: object = None

    def __post_init__(self):
        if self.y is None:
            self.y = (self.height - 1) * self.dy

    @property
    def bounds(self):
        """Lowest and highest x and y of the pixels' centers."""
        return self.x, self.x + (self.width - 1) * self.dx, self.y - (self.height - 1) * self.dy, self.y

    def hanging(self):
        """The same pixels with the upper left corner at (0, 0), as QGIS shows images that are not georeferenced."""
        return replace(self, x=0.5, y=-0.5, dx=1.0, dy=1.0)

    def part(self, column, row, width, height):
        width, height = min(width, self.width - column), min(height, self.height - row)
        return replace(self, width=width, height=height, x=self.x + column * self.dx, y=self.y - row * self.dy)

    def to_vtk(self, values=None):
        """An image, with values of shape (height, width, components)."""
        image = vtkImageData()
        image.SetDimensions(self.width, self.height, 1)
        image.SetSpacing(self.dx, self.dy, 1.0)
        image.SetOrigin(self.x, self.bounds[2], 0.0)
        if values is not None:
            array = numpy_to_vtk(numpy.ascontiguousarray(values[::-1]).reshape(-1, values.shape[2]))
            array.SetName("Pixels")
            image.GetPointData().SetScalars(array)
        return image


class Raster:
    """An image in memory, an array of shape (rows, columns, bands)."""

    nodata = None

    def __init__(self, pixels, grid=None):
        self.pixels = pixels if pixels.ndim == 3 else pixels[:, :, None]
        self.grid = grid or Grid(self.pixels.shape[1], self.pixels.shape[0])
        self.bands, self.dtype = self.pixels.shape[2], self.pixels.dtype
        self.has_alpha = self.bands in (2, 4)

    def window(self, columns, rows):
        return self.pixels[slice(*rows), slice(*columns)]

    def all(self):
        return self.window((0, self.grid.width), (0, self.grid.height))


class GdalRaster(Raster):
    """A raster that rasterio reads piece by piece."""

    def __init__(self, input):
        rasterio = import_extra("rasterio", f"Reading {input.name}")
        logging.getLogger("rasterio").setLevel(logging.CRITICAL)
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        self.file = rasterio.open(input.path)
        self.nodata, self.bands, self.dtype = self.file.nodata, self.file.count, numpy.dtype(self.file.dtypes[0])
        self.palette = None
        if self.file.colorinterp[0].name == "palette" and self.bands == 1:
            self.palette, self.bands = numpy.zeros((256, 3), numpy.uint8), 3
            for value, color in self.file.colormap(1).items():
                self.palette[value % 256] = color[:3]
        self.has_alpha = self.file.colorinterp[-1].name == "alpha" or (not self.file.crs and self.bands in (2, 4))
        self.grid = Grid(self.file.width, self.file.height)
        t = self.file.transform
        if self.file.crs or not t.is_identity:
            self.grid.crs, self.grid.placed = self.file.crs, True
            if t.b or t.d or t.a <= 0 or t.e >= 0:
                self.grid.y, self.grid.turn = 0.0, t * t.translation(0.5, 0.5) * t.scale(1, -1)
            else:
                (self.grid.x, self.grid.y), self.grid.dx, self.grid.dy = t * (0.5, 0.5), t.a, -t.e

    def window(self, columns, rows):
        pixels = self.file.read(window=(rows, columns))
        return numpy.moveaxis(pixels, 0, 2) if self.palette is None else self.palette[pixels[0]]


def read(input):
    """The image in a file. Raises Failure."""
    if input.format in ("vti", "vtk"):
        image = vtkfiles.read(input)
        if not isinstance(image, vtkImageData) or image.GetPointData().GetScalars() is None:
            input.fail(f"it holds a {image.GetClassName()}, not an image with pixels.")
        (width, height, layers), (dx, dy, _) = image.GetDimensions(), image.GetSpacing()
        if layers != 1:
            raise Failure(f"{input.name} has {layers} layers, an image has one.")
        pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1]
        left, _, bottom, _, _, _ = image.GetBounds()
        return Raster(pixels, Grid(width, height, left, bottom + (height - 1) * dy, dx, dy))
    if input.format not in PICTURES:
        raise Failure(f"Cannot read {input.name} as an image: the formats are {dotted(WRITE)}.", USAGE)
    try:
        if input.format not in ("tif", "tiff"):
            return _read_picture(input)
        raster = GdalRaster(input)
        # Read the end, to detect truncated files.
        width, height = raster.grid.width, raster.grid.height
        raster.window((width - 1, width), (height - 1, height))
        return raster
    except (Failure, MemoryError):
        raise
    except Exception as error:
        input.fail_by(error)


def _read_picture(input):
    from PIL import Image

    Image.MAX_IMAGE_PIXELS = None
    with Image.open(input.path, formats=[PILLOW_FORMATS.get(input.format, "PPM")]) as image:
        if image.width * image.height > MOST_PIXELS:
            input.fail(f"an image of {image.width} x {image.height} pixels is too large for .{input.format}.")
        if "16B" in str(image.tile) and image.mode not in ("I", "I;16"):
            # Pillow would reduce 16 bits to 8.
            return Raster(GdalRaster(input).all())
        kinds = {"P": "RGBA" if "transparency" in image.info else "RGB", "1": "L", "PA": "RGBA"}
        if image.mode not in ("L", "LA", "RGB", "RGBA", "I", "I;16", "F"):
            image = image.convert(kinds.get(image.mode, "RGB"))
        pixels = numpy.asarray(image)
    return Raster(pixels.astype(numpy.uint16) if pixels.dtype == numpy.int32 else pixels)


def read_size(text):
    """(width, height) of WIDTHxHEIGHT; None of an empty text."""
    if not text:
        return None
    parts = text.split("x")
    if len(parts) == 2 and all(part.isdigit() and 1 <= int(part) <= 100000 for part in parts):
        return int(parts[0]), int(parts[1])
    raise Failure(f'"{text}" is not a size: WIDTHxHEIGHT in pixels, each from 1 to 100000, such as 640x480.', USAGE)


def read_background(text, format):
    """A color as three numbers from 0 to 1, or None: transparent."""
    text = text or ("white" if format in OPAQUE else "transparent")
    if text == "transparent":
        if format in OPAQUE:
            raise Failure(f"A .{format} image cannot be transparent: use another --background, or write a .png.", USAGE)
        return None
    try:
        digits = bytes.fromhex({"white": "#ffffff", "black": "#000000"}.get(text, text).removeprefix("#"))
    except ValueError:
        digits = b""
    if len(digits) != 3:
        raise Failure(f'"{text}" is an invalid color: transparent, white, black, or #rrggbb, such as #ff8000.', USAGE)
    return [digit / 255 for digit in digits]


def require_overlap(grid, name, mesh, mesh_name):
    """Raises Failure if no pixel of an image is within the mesh's box; warns if hardly any is."""
    x0, x1, y0, y1 = grid.bounds
    if grid.turn:
        corners = numpy.array([grid.turn * corner for corner in ((x0, y0), (x0, y1), (x1, y0), (x1, y1))])
        (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
    low, high = (getattr(meshes.points_of(mesh)[:, :2], end)(axis=0) for end in ("min", "max"))
    sizes = numpy.minimum((x1, y1), high) - numpy.maximum((x0, y0), low)
    boxes = ", ".join(f"{who} (x from {a[0]:.10g} to {b[0]:.10g}, y from {a[1]:.10g} to {b[1]:.10g})"
                      for who, a, b in ((name, (x0, y0), (x1, y1)), (mesh_name, low, high)))
    if sizes.min() < 0:
        raise Failure(f"{boxes} do not overlap: meshes must be in the image's coordinates (pixels, y upwards).")
    if sizes.prod() < 0.01 * (x1 - x0) * (y1 - y0):
        inform(f"{boxes} overlap in less than a hundredth of the image: meshes must be in its coordinates.")


class Warp:
    """Warps images from one domain of a pair to the other, sampling at exact preimages, tile by tile. `turns`: those
    of the grids of the image and of the result."""

    def __init__(self, pair, settings, inverse=False, turns=(None, None)):
        pair.require_flat()
        points = [meshes.points_of(mesh)[:, :2] for mesh in pair.meshes]
        for side, turn in enumerate(turns[::-1] if inverse else turns):
            if turn:
                points[side] = numpy.column_stack(~turn * points[side].T)
        triangles = meshes.triangles_of(pair.source)
        pair = replace(pair, meshes=[meshes.make_mesh(p, triangles) for p in points], shift=None)
        self.data_points, self.grid_points = points[::-1] if inverse else points
        self.to_data, self.from_data = PointMap(pair, settings, not inverse), PointMap(pair, settings, inverse)
        self.filter = vtkResampleThroughHomeomorphism()
        settings.apply(self.filter)
        self.filter.SetSourceData(pair.source)
        self.filter.SetTargetData(pair.target)
        self.filter.SetInverse(inverse)
        self.filter.BlankOutsideOff()
        edges = numpy.sort(numpy.vstack((triangles[:, :2], triangles[:, 1:], triangles[:, ::2])), axis=1)
        edges, counts = numpy.unique(edges, axis=0, return_counts=True)
        # Masked triangles have boundaries of their own.
        self.border = edges if settings.mask_invalid else edges[counts == 1]

    def image_of(self, grid, mapping, points):
        """Least and greatest coordinates of the image of a grid's rectangle, and the largest steps between the images
        of neighbors; None if nothing of it is in the domain. The image is as large as that of its border: the
        rectangle's, and the part of the mesh's, which has these points, that is inside."""
        x0, x1, y0, y1 = grid.bounds
        x, y = numpy.linspace(x0, x1, grid.width), numpy.linspace(y0, y1, grid.height)
        sides = [numpy.column_stack(numpy.broadcast_arrays(*side)) for side in ((x, y0), (x, y1), (x0, y), (x1, y))]
        a, b = points[self.border[:, 0]], points[self.border[:, 1]]
        low, high = numpy.zeros(len(a)), numpy.ones(len(a))
        for axis, limits in enumerate(((x0, x1), (y0, y1))):
            with numpy.errstate(divide="ignore", invalid="ignore"):
                t = [(limit - a[:, axis]) / (b - a)[:, axis] for limit in limits]
            # Edges on a limit are within it.
            t = [numpy.where(numpy.isnan(values), end, values) for values, end in zip(t, (-numpy.inf, numpy.inf))]
            low, high = numpy.maximum(low, numpy.minimum(*t)), numpy.minimum(high, numpy.maximum(*t))
        meets = low <= high
        ends = [a[meets] + t[meets, None] * (b - a)[meets] for t in (low, high)]
        found = mapping.map_points(numpy.vstack(sides + ends))[0]
        if numpy.isnan(found).all():
            return None
        sides = numpy.split(found, numpy.cumsum([len(side) for side in sides]))[:4]
        steps = numpy.vstack([numpy.abs(numpy.diff(side, axis=0)) for side in sides] + [[[0, 0]]])
        return numpy.nanmin(found, axis=0), numpy.nanmax(found, axis=0), numpy.nanmax(steps, axis=0)

    def fit_grid(self, raster, size=None, resolution=0.0, crs=None):
        """A grid over the image of a placed raster, with pixels of its size unless that changes by more than 1 %."""
        grid = raster.grid
        x0, x1, y0, y1 = grid.bounds
        width, height = min(grid.width, 4000), min(grid.height, 4000)
        coarse = replace(grid, width=width, height=height, dx=(x1 - x0) / max(1, width - 1), dy=(y1 - y0) / max(1, height - 1))
        found = self.image_of(coarse, self.from_data, self.data_points)
        if found is None:
            raise Failure("No pixel of the image is within the mesh.")
        low, high, _ = found
        if size:
            dx, dy = (high - low) / numpy.maximum(numpy.array(size) - 1, 1)
        else:
            own = numpy.hypot(grid.width * grid.dx, grid.height * grid.dy) / numpy.hypot(grid.width, grid.height)
            extent = [numpy.hypot(*numpy.ptp(p, axis=0)) for p in (self.data_points, self.grid_points)]
            factor = extent[1] / extent[0]
            dx, dy = (grid.dx, grid.dy) if abs(factor - 1) < 0.01 else (own * factor, own * factor)
            dx, dy = (resolution, resolution) if resolution else (dx, dy)
            # A rounding error must not add a pixel.
            size = [int(math.ceil(span / d - 1e-6)) + 1 for span, d in zip(high - low, (dx, dy))]
        return Grid(*size, low[0], high[1], dx, dy, crs, True)

    def tiles(self, raster, grid, text="Warping"):
        """Yields (column, row, pixels, mask) of the tiles of a grid; pixels of shape (rows, columns, bands)."""
        tiles = [(c, r) for r in range(0, grid.height, TILE) for c in range(0, grid.width, TILE)]
        for column, row in progress(tiles, text) if text else tiles:
            yield (column, row, *self.warp_tile(raster, grid.part(column, row, TILE, TILE)))

    def warp_tile(self, raster, tile):
        shape = (tile.height, tile.width)
        nothing = numpy.zeros((*shape, raster.bands), raster.dtype), numpy.zeros(shape, bool)
        found = self.image_of(tile, self.to_data, self.grid_points)
        if found is None:
            return nothing
        (x0, y0), (x1, y1) = found[0] - found[2], found[1] + found[2]
        g = raster.grid
        ends = ((x0 - g.x) / g.dx - 2, (x1 - g.x) / g.dx + 3, (g.y - y1) / g.dy - 2, (g.y - y0) / g.dy + 3)
        limits = (g.width, g.width, g.height, g.height)
        c0, c1, r0, r1 = (int(min(max(math.floor(end), 0), limit)) for end, limit in zip(ends, limits))
        if c0 >= c1 or r0 >= r1:
            return nothing
        window = raster.window((c0, c1), (r0, r1))
        data = g.part(c0, r0, c1 - c0, r1 - r0).to_vtk(window)
        if raster.nodata is not None:
            unknown = numpy.isnan(window) if numpy.isnan(raster.nodata) else window == raster.nodata
            known = numpy_to_vtk((~unknown.any(axis=2)[::-1]).ravel().astype(float), deep=True)
            known.SetName("Known")
            data.GetPointData().AddArray(known)
        self.filter.SetDataObject(data)
        self.filter.SetGridData(tile.to_vtk())
        result = run(self.filter, self.to_data.pair.name).GetPointData()
        pixels, mask = (vtk_to_numpy(result.GetArray(name)).reshape(*shape, -1)[::-1] for name in ("Pixels", MASK))
        mask = mask[:, :, 0] != 0
        if raster.nodata is not None:
            mask &= vtk_to_numpy(result.GetArray("Known")).reshape(shape)[::-1] > 1 - 1e-9
        return pixels, mask

    def warp(self, raster, grid, text="Warping"):
        """Pixels and mask of the whole grid."""
        pixels = numpy.zeros((grid.height, grid.width, raster.bands), raster.dtype)
        mask = numpy.zeros(pixels.shape[:2], bool)
        for column, row, part, inside in self.tiles(raster, grid, text):
            where = (slice(row, row + part.shape[0]), slice(column, column + part.shape[1]))
            pixels[where], mask[where] = part, inside
        return pixels, mask


def brightest(dtype):
    return numpy.iinfo(dtype).max if dtype.kind in "iu" else 1.0


def finish(pixels, mask, has_alpha, background, nodata=None):
    """Sets pixels outside to the background: a color, no data, or transparency (adding an alpha band if needed)."""
    full = brightest(pixels.dtype)
    colors = pixels.shape[2] - has_alpha
    fill = numpy.zeros(pixels.shape[2])
    if nodata is not None:
        fill[:] = nodata
    elif background is not None:
        fill[:colors] = numpy.multiply(background if colors == 3 else numpy.mean(background), full)
        fill[colors:] = full
    fill = (numpy.rint(fill) if pixels.dtype.kind in "iu" else fill).astype(pixels.dtype)
    if not mask.all():
        pixels = numpy.where(mask[:, :, None], pixels, fill)
    if background is None and nodata is None and not has_alpha and colors <= 3:
        pixels = numpy.dstack((pixels, numpy.where(mask, full, 0).astype(pixels.dtype)))
    return pixels


def write(pixels, output, grid):
    """Writes an array of shape (rows, columns, bands) as an image."""
    bands, kind, format = pixels.shape[2], pixels.dtype, output.format
    deep = kind == numpy.uint16 and format == "png"
    if format == "vti":
        vtkfiles.write(grid.to_vtk(pixels), output)
    elif deep or format in ("tif", "tiff"):
        writer = TiffWriter(output, grid, bands, kind, bands in (2, 4))
        writer.write(0, 0, pixels)
        writer.close()
    elif bands > (3 if format in OPAQUE else 4) or not (kind == numpy.uint8 or deep) or bands == 2 and format in OPAQUE:
        raise Failure(f"A .{format} image cannot hold {bands} bands of {kind}: write a .tif or .vti.")
    else:
        from PIL import Image

        options = {"quality": 95} if format in ("jpg", "jpeg") else {"compress_level": 3} if format == "png" else {}
        # Written here, because Pillow does not notice full disks.
        buffer = io.BytesIO()
        Image.fromarray(pixels[:, :, 0] if bands == 1 else pixels).save(buffer, PILLOW_FORMATS.get(format, "PPM"), **options)
        output.write_bytes(buffer.getbuffer())


class TiffWriter:
    """A TIFF, a GeoTIFF on a georeferenced grid, that is written tile by tile."""

    def __init__(self, output, grid, bands, dtype, has_alpha, nodata=None):
        rasterio = import_extra("rasterio", f"Writing {output.name}")
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        self.rasterio, self.output = rasterio, output
        to_ground = grid.turn or rasterio.Affine(grid.dx, 0, grid.x, 0, grid.dy, grid.y)
        place = {"crs": grid.crs, "transform": to_ground * rasterio.Affine(1, 0, -0.5, 0, -1, 0.5)}
        self.file = rasterio.open(
            output.path, "w", driver="PNG" if output.format == "png" else "GTiff", width=grid.width, height=grid.height, count=bands, dtype=dtype,
            nodata=nodata, tiled=True, blockxsize=512, blockysize=512, compress="deflate", zlevel=1,
            BIGTIFF="IF_SAFER", num_threads="ALL_CPUS", **(place if grid.placed else {}),
        )
        if bands - has_alpha in (1, 3):
            colors = ["gray"] if bands < 3 else ["red", "green", "blue"]
            self.file.colorinterp = [rasterio.enums.ColorInterp[name] for name in colors + ["alpha"] * has_alpha]

    def write(self, column, row, pixels):
        window = self.rasterio.windows.Window(column, row, *pixels.shape[1::-1])
        self.file.write(numpy.moveaxis(pixels, 2, 0), window=window)

    def close(self):
        try:
            self.file.close()
        except self.rasterio.errors.RasterioError as error:
            raise Failure(f"Cannot write {self.output.name}: {error}", FILE) from None


def write_tiff(output, grid, raster, tiles, background):
    """Writes the tiles of a warped raster. Outside are the background, the raster's value for no data, transparency,
    or else a value for no data."""
    nodata, adds_alpha = raster.nodata, False
    if background is None and nodata is None and not raster.has_alpha:
        adds_alpha = raster.dtype in (numpy.uint8, numpy.uint16) and raster.bands in (1, 3)
        nodata = None if adds_alpha else numpy.nan if raster.dtype.kind == "f" else 0
        if nodata == 0:
            inform(f"{output.name}: pixels outside are 0, and 0 is marked as no data.")
    has_alpha = raster.has_alpha or adds_alpha
    writer = TiffWriter(output, grid, raster.bands + adds_alpha, raster.dtype, has_alpha, nodata)
    for column, row, pixels, mask in tiles:
        writer.write(column, row, finish(pixels, mask, raster.has_alpha, background, nodata))
    writer.close()
