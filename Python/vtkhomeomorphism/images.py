# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Images by Pillow and rasters by rasterio: read in windows and warped in tiles, so that only parts of large GeoTIFF
files are in memory."""

import logging
import math
import warnings
from dataclasses import dataclass, field, replace

import numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

from . import report
from .arrays import MASK, add_array, arrays_of, points_of, triangles_of
from .files import FILE, PICTURES, USAGE, Failure, Input, dotted, inform, progress, quote
from .mapping import PointMap, run, set_up
from .vtkFiltersHomeomorphism import vtkResampleThroughHomeomorphism

TILE = 2048
LARGEST = 2**32  # pixels of a result
PILLOW_FORMATS = {"jpg": "JPEG", "jpeg": "JPEG", "png": "PNG", "bmp": "BMP", "webp": "WEBP"}
OPAQUE = ("jpg", "jpeg", "ppm", "pgm", "pnm", "bmp")


@dataclass
class Grid:
    """The position of pixels: that of (column, row) has its center at first + steps @ (column, row). By default, the
    center of the lower left pixel is (0, 0), and y points upwards."""

    width: int
    height: int
    first: numpy.ndarray = None
    steps: numpy.ndarray = field(default_factory=lambda: numpy.diag([1.0, -1.0]))
    crs: object = None
    placed: bool = False  # whether the file is georeferenced

    def __post_init__(self):
        if self.first is None:
            self.first = numpy.array([0.0, self.height - 1.0])

    def at(self, pixels):
        """The points of pixels (column, row)."""
        return self.first + pixels @ self.steps.T

    def pixels(self, points):
        """The pixels (column, row) of points, as real numbers."""
        return (points - self.first) @ numpy.linalg.inv(self.steps).T

    def outline(self):
        """Points of pixels along the border, all around: all of them up to 4000 on a side."""
        x, y = (numpy.linspace(0, n - 1, min(n, 4000)) for n in self.size)
        sides = (x, 0), (self.width - 1, y), (x[::-1], self.height - 1), (0, y[::-1])
        return self.at(numpy.vstack([numpy.column_stack(numpy.broadcast_arrays(*side)) for side in sides]))

    @property
    def bounds(self):
        """Lowest and highest x and y of the pixels' centers."""
        corners = self.at(numpy.array([[x, y] for x in (0, self.width - 1) for y in (0, self.height - 1)]))
        return numpy.column_stack((corners.min(axis=0), corners.max(axis=0))).ravel()

    @property
    def size(self):
        return self.width, self.height

    @property
    def pixel(self):
        """The width of a pixel, if it is square."""
        return math.sqrt(abs(numpy.linalg.det(self.steps)))

    def hanging(self):
        """The same pixels with the upper left corner at (0, 0), as QGIS shows images that are not georeferenced."""
        return self if self.placed else Grid(*self.size, numpy.array([0.5, -0.5]))

    def part(self, column, row, width, height):
        return replace(self, width=width, height=height, first=self.at(numpy.array([column, row])))

    def to_vtk(self, values=None):
        """An image, with values of shape (height, width, components), whose first row is the lowest."""
        image = vtkImageData()
        image.SetDimensions(self.width, self.height, 1)
        steps = self.steps * [1, -1]
        spacing = numpy.hypot(*steps)
        image.SetSpacing(*spacing, 1.0)
        image.SetOrigin(*self.at(numpy.array([0, self.height - 1])), 0.0)
        (a, b), (c, d) = steps / spacing
        image.SetDirectionMatrix(a, b, 0, c, d, 0, 0, 0, 1)
        if values is not None:
            add_array(image, "Pixels", values[::-1].reshape(-1, values.shape[2]))
            image.GetPointData().SetActiveScalars("Pixels")
        return image


class Raster:
    """An image in memory, an array of shape (rows, columns, bands)."""

    nodata = None

    def __init__(self, pixels):
        self.pixels = numpy.atleast_3d(pixels)
        self.grid = Grid(self.pixels.shape[1], self.pixels.shape[0])
        self.bands, self.dtype = self.pixels.shape[2], self.pixels.dtype
        self.has_alpha = self.bands in (2, 4)

    def window(self, columns, rows):
        return self.pixels[slice(*rows), slice(*columns)]

    def reduce(self, factor):
        """The raster of the means of squares of `factor` by `factor` pixels; no data where one of them is none. Less
        than a square at the end repeats the last one."""
        (columns, rows), rest = (n.tolist() for n in numpy.divmod(self.grid.size, factor))
        means = numpy.empty((rows, columns, self.bands), self.dtype)
        for row in range(rows):
            pixels = self.window((0, columns * factor), (row * factor, (row + 1) * factor))
            sums = pixels.sum(axis=0, dtype=float).reshape(columns, factor, self.bands).sum(axis=1)
            means[row] = round_to(self.dtype, sums / factor**2)
            if self.nodata is not None:
                unknown = (pixels == self.nodata).any(axis=0).reshape(columns, factor, self.bands).any(axis=1)
                means[row, unknown] = self.nodata
        result = Raster(numpy.pad(means, [(0, int(n > 0)) for n in (*rest[::-1], 0)], "edge"))
        result.nodata, result.has_alpha = self.nodata, self.has_alpha
        width, height = result.grid.size
        result.grid = replace(self.grid, width=width, height=height, steps=factor * self.grid.steps,
                              first=self.grid.at(numpy.full(2, (factor - 1) / 2)))
        return result

    def all(self):
        return self.window((0, self.grid.width), (0, self.grid.height))


class GdalRaster(Raster):
    """A raster that rasterio reads piece by piece."""

    def __init__(self, input):
        import rasterio

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
        self.grid, t = Grid(self.file.width, self.file.height), self.file.transform
        if self.file.crs or not t.is_identity:
            steps = numpy.array([[t.a, t.b], [t.d, t.e]])
            self.grid = Grid(*self.grid.size, numpy.array([t.c, t.f]) + steps @ [0.5, 0.5], steps, self.file.crs, True)

    def window(self, columns, rows):
        pixels = self.file.read(window=(rows, columns))
        return numpy.moveaxis(pixels, 0, 2) if self.palette is None else self.palette[pixels[0]]


def read(name, standard_format="png"):
    """The image in a file. Raises Failure."""
    input = Input(name, standard_format)
    if input.format not in PICTURES:
        raise Failure(f"Cannot read {input.name} as an image: the formats are {dotted(PICTURES)}.", USAGE)
    with input:
        try:
            raster = GdalRaster(input) if input.format in ("tif", "tiff") else _read_picture(input)
            # Read the end, to detect truncated files.
            width, height = raster.grid.size
            raster.window((width - 1, width), (height - 1, height))
        except (ImportError, MemoryError):
            raise
        except Exception as error:
            input.fail_by(error)
    raster.name = input.name
    return raster


def _read_picture(input):
    from PIL import Image, ImageOps

    # Images of twice as many pixels are refused.
    Image.MAX_IMAGE_PIXELS = 2**30
    with Image.open(input.path, formats=[PILLOW_FORMATS.get(input.format, "PPM")]) as image:
        if "16B" in str(image.tile) and image.mode not in ("I", "I;16"):
            # Pillow would reduce 16 bits to 8.
            return Raster(GdalRaster(input).all())
        if image.mode not in ("L", "LA", "RGB", "RGBA", "I", "I;16", "F"):
            kinds = {"P": "RGBA" if "transparency" in image.info else "RGB", "1": "L", "PA": "RGBA"}
            image = image.convert(kinds.get(image.mode, "RGB"))
        pixels = numpy.asarray(ImageOps.exif_transpose(image))
    return Raster(pixels.astype(numpy.uint16) if pixels.dtype == numpy.int32 else pixels)


def read_background(text, format):
    """A color as three numbers from 0 to 1, or None: transparent."""
    from PIL import ImageColor

    text = text or ("white" if format in OPAQUE else "transparent")
    if text == "transparent":
        if format in OPAQUE:
            raise Failure(f"A .{format} image cannot be transparent: use another --background, or write a .png.", USAGE)
        return None
    try:
        return [value / 255 for value in ImageColor.getrgb(text)[:3]]
    except ValueError:
        raise Failure(f'"{text}" is an invalid color: transparent, a name such as white, or #rrggbb.', USAGE) from None


def require_overlap(grid, name, mesh, mesh_name):
    """Raises Failure if no pixel of an image is within the mesh's box; warns if hardly any is."""
    points = points_of(mesh)[:, :2]
    a, b = grid.bounds.reshape(2, 2).T, numpy.array([points.min(axis=0), points.max(axis=0)])
    sizes = numpy.minimum(a[1], b[1]) - numpy.maximum(a[0], b[0])
    boxes = ", ".join(f"{who} (x from {low[0]:.10g} to {high[0]:.10g}, y from {low[1]:.10g} to {high[1]:.10g})"
                      for who, (low, high) in ((name, a), (mesh_name, b)))
    if sizes.min() < 0:
        raise Failure(f"{boxes} do not overlap: meshes must be in the image's coordinates (pixels, y upwards).")
    if sizes.prod() < 0.01 * numpy.ptp(a, axis=0).prod():
        inform(f"{boxes} overlap in less than a hundredth of the image: meshes must be in its coordinates.")


class Warp:
    """Warps images from one domain of a pair to the other, sampling at exact preimages, tile by tile."""

    def __init__(self, pair, settings, inverse=False):
        pair.require_flat()
        pair = replace(report.require_map(pair, settings.get("mask_invalid")), shift=None)
        self.pair, self.inverse = pair, inverse
        self.map = PointMap(pair, settings, inverse)
        self.filter = set_up(vtkResampleThroughHomeomorphism(), settings, pair)
        self.filter.SetInverse(inverse)
        self.filter.BlankOutsideOff()
        triangles = triangles_of(pair.source)
        corners = [points_of(pair.meshes[side])[triangles, :2] for side in (inverse, not inverse)]
        areas = [numpy.abs(numpy.linalg.det(c[:, 1:] - c[:, :1])).sum() for c in corners]
        self.scale = math.sqrt(areas[1] / areas[0])  # the mean factor of lengths
        # The boundary of the domain, in small pieces, in the image and in the result.
        edges = numpy.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, counts = numpy.unique(edges, axis=0, return_counts=True)
        ends = points_of(pair.meshes[inverse])[edges[counts == 1], :2]
        t = numpy.linspace(0, 1, 2 + 8192 // len(ends))[:, None, None]
        rim = (1 - t) * ends[:, 0] + t * ends[:, 1]
        self.rims = [rim, self._map(rim.reshape(-1, 2), True).reshape(rim.shape)]

    def _map(self, points, forward):
        self.map.filter.SetInverse(self.inverse == forward)
        return self.map.map_points(points)[0]

    def image_of(self, grid, forward):
        """Points around the image (or the preimage) of a grid's rectangle, and the largest distance of neighbors; None
        if it is not within the domain. The image is as large as that of its boundary: the rectangle's, and the part of
        the domain's that is inside."""
        line = self._map(grid.outline(), forward)
        here, there = self.rims if forward else self.rims[::-1]
        pixels = grid.pixels(here)
        inside = ((pixels >= -0.5) & (pixels <= numpy.array(grid.size) - 0.5)).all(axis=2)
        points = numpy.vstack((line, there[inside]))
        if numpy.isnan(points).all():
            return None
        steps = [numpy.diff(points, axis=0).reshape(-1, 2) for points in (line, there)] + [numpy.zeros((1, 2))]
        return points[numpy.isfinite(points[:, 0])], numpy.nanmax(numpy.abs(numpy.vstack(steps)), axis=0)

    def fit_grid(self, raster, size=None, resolution=0.0, crs=None):
        """A grid over the image of a placed raster, with square pixels of its size unless that changes by 1 %."""
        found = self.image_of(raster.grid, True)
        if found is None:
            raise Failure("No pixel of the image is within the mesh.")
        low, high = found[0].min(axis=0), found[0].max(axis=0)
        if size:
            spacing = (high - low) / numpy.maximum(numpy.array(size) - 1, 1)
        else:
            factor = self.scale if abs(self.scale - 1) >= 0.01 else 1.0
            spacing = numpy.full(2, resolution or factor * raster.grid.pixel)
            numbers = [length / step for length, step in zip((high - low).tolist(), spacing.tolist())]
            if math.prod(numbers) > LARGEST:
                raise Failure("The result would have {:.6g} x {:.6g} pixels, more than 2^32: use a larger "
                              "--resolution, or --size.".format(*numbers), USAGE)
            # A rounding error must not add a pixel.
            size = [int(math.ceil(n - 1e-6)) + 1 for n in numbers]
        return Grid(*size, numpy.array([low[0], high[1]]), numpy.diag(spacing * [1, -1]), crs, True)

    def tiles(self, raster, grid, text="Warping"):
        """Yields (column, row, pixels, mask) of the tiles of a grid; pixels of shape (rows, columns, bands)."""
        # How many pixels of the raster are as wide as one of the grid.
        factor = int(min(grid.pixel / self.scale / raster.grid.pixel + 0.01, *raster.grid.size))
        raster = raster.reduce(factor) if factor > 1 else raster
        tiles = [(c, r) for r in range(0, grid.height, TILE) for c in range(0, grid.width, TILE)]
        for column, row in progress(tiles, text) if text else tiles:
            tile = grid.part(column, row, min(TILE, grid.width - column), min(TILE, grid.height - row))
            yield (column, row, *self.warp_tile(raster, tile))

    def warp_tile(self, raster, tile):
        shape = (tile.height, tile.width)
        begin, end = self._find_window(raster.grid, tile)
        if (begin >= end).any():
            return numpy.zeros((*shape, raster.bands), raster.dtype), numpy.zeros(shape, bool)
        # At the raster's border, one more pixel of the same value, because pixels are areas and VTK's are points.
        added = numpy.array([begin == 0, end == raster.grid.size]).astype(int)
        window = raster.window(*numpy.array([begin, end]).T.tolist())
        window = numpy.pad(window, (*added.T[::-1], (0, 0)), "edge")
        rows, columns = window.shape[:2]
        data = raster.grid.part(*(begin - added[0]), columns, rows).to_vtk(window)
        if added.any():
            # In each direction, from 1 in the middle to 0 at added pixels, and rounded: the area ends at a half.
            x, y = (numpy.pad(numpy.ones(n - sum(pad), numpy.uint8), pad) for n, pad in zip((columns, rows), added.T))
            add_array(data, "Inside", numpy.stack(numpy.meshgrid(x, y[::-1]), axis=2).reshape(-1, 2))
        if raster.nodata is not None:
            unknown = numpy.isnan(window) if numpy.isnan(raster.nodata) else window == raster.nodata
            add_array(data, "Known", (~unknown.any(axis=2)[::-1]).ravel().astype(float))
        self.filter.SetDataObject(data)
        self.filter.SetGridData(tile.to_vtk())
        arrays = arrays_of(run(self.filter, self.pair.name).GetPointData())
        arrays = {name: values.reshape(*shape, -1)[::-1] for name, values in arrays.items()}
        mask = (arrays[MASK] != 0).all(axis=2) & arrays.get("Inside", numpy.ones(1)).all(axis=-1)
        if raster.nodata is not None:
            mask &= arrays["Known"][:, :, 0] > 1 - 1e-9
        return arrays["Pixels"], mask

    def _find_window(self, grid, tile):
        """The first pixel (column, row) that a tile needs of a raster, and the end."""
        found = self.image_of(tile, False)
        if found is None:
            return numpy.zeros((2, 2), int)
        pixels, margin = grid.pixels(found[0]), found[1] @ numpy.abs(numpy.linalg.inv(grid.steps)).T + 2
        ends = numpy.array([pixels.min(axis=0) - margin, pixels.max(axis=0) + margin + 1])
        return numpy.clip(numpy.floor(ends), 0, grid.size).astype(int)

    def warp(self, raster, grid, text="Warping"):
        """Pixels and mask of the whole grid."""
        pixels = numpy.zeros((grid.height, grid.width, raster.bands), raster.dtype)
        mask = numpy.zeros(pixels.shape[:2], bool)
        for column, row, part, inside in self.tiles(raster, grid, text):
            where = (slice(row, row + part.shape[0]), slice(column, column + part.shape[1]))
            pixels[where], mask[where] = part, inside
        return pixels, mask


def round_to(dtype, values):
    return (numpy.rint(values) if dtype.kind in "iu" else values).astype(dtype)


def brightest(dtype):
    return numpy.iinfo(dtype).max if dtype.kind in "iu" else 1.0


def add_alpha(pixels, mask=True):
    """The pixels with an alpha band: opaque, or transparent where the mask is 0."""
    alpha = numpy.where(mask, brightest(pixels.dtype), 0).astype(pixels.dtype)
    return numpy.dstack((pixels, numpy.broadcast_to(alpha, pixels.shape[:2])))


def finish(pixels, mask, has_alpha, background, nodata=None):
    """Sets pixels outside to the background: a color, no data, or transparency (adding an alpha band if needed)."""
    full, colors = brightest(pixels.dtype), pixels.shape[2] - has_alpha
    fill = numpy.full(pixels.shape[2], 0.0 if nodata is None else nodata)
    if nodata is None and background is not None:
        fill[:colors] = numpy.multiply(background if colors == 3 else numpy.mean(background), full)
        fill[colors:] = full
    pixels = pixels if mask.all() else numpy.where(mask[:, :, None], pixels, round_to(pixels.dtype, fill))
    if background is None and nodata is None and not has_alpha and colors <= 3:
        pixels = add_alpha(pixels, mask)
    return pixels


def write(pixels, output, grid):
    """Writes an array of shape (rows, columns, bands) as an image."""
    bands, kind, format = pixels.shape[2], pixels.dtype, output.format
    if format in ("tif", "tiff") or kind == numpy.uint16 and format == "png":
        _write_raster(output, grid, bands, kind, bands in (2, 4), None, [(0, 0, pixels)])
    elif bands > (3 if format in OPAQUE else 4) or kind != numpy.uint8 or bands == 2 and format in OPAQUE:
        raise Failure(f"A .{format} image cannot hold {bands} bands of {kind}: write a .tif.")
    else:
        from PIL import Image

        options = {"jpg": {"quality": 95}, "jpeg": {"quality": 95}, "png": {"compress_level": 3}}.get(format, {})
        image = Image.fromarray(pixels[:, :, 0] if bands == 1 else pixels)
        image.save(output.path, PILLOW_FORMATS.get(format, "PPM"), **options)


def _write_raster(output, grid, bands, dtype, has_alpha, nodata, tiles):
    """Writes tiles (column, row, pixels) to a TIFF, a GeoTIFF on a georeferenced grid."""
    import rasterio

    warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
    x, y = grid.at(numpy.array([-0.5, -0.5]))
    place = {"crs": grid.crs, "transform": rasterio.Affine(*grid.steps[0], x, *grid.steps[1], y)} if grid.placed else {}
    profile = {"driver": "PNG" if output.format == "png" else "GTiff", "width": grid.width, "height": grid.height,
               "count": bands, "dtype": dtype, "nodata": nodata, "tiled": True, "blockxsize": 512, "blockysize": 512,
               "compress": "deflate", "zlevel": 1, "BIGTIFF": "IF_SAFER", "num_threads": "ALL_CPUS", **place}
    try:
        with rasterio.open(output.path, "w", **profile) as file:
            if bands - has_alpha in (1, 3):
                colors = ["gray"] if bands < 3 else ["red", "green", "blue"]
                file.colorinterp = [rasterio.enums.ColorInterp[name] for name in colors + ["alpha"] * has_alpha]
            for column, row, pixels in tiles:
                window = rasterio.windows.Window(column, row, *pixels.shape[1::-1])
                file.write(numpy.moveaxis(pixels, 2, 0), window=window)
    except rasterio.errors.CRSError:
        raise Failure(f"The coordinate reference system {quote(grid.crs)} is not known: give another (--crs).",
                      USAGE) from None
    except rasterio.errors.RasterioError as error:
        raise Failure(f"Cannot write {output.name}: {error}", FILE) from None


def write_warped(warp, raster, grid, output, background):
    """Warps a raster and writes it. Outside are the background, the raster's value for no data, transparency, or else a
    value for no data."""
    if output.format not in ("tif", "tiff"):
        write(finish(*warp.warp(raster, grid), raster.has_alpha, background), output, grid)
        return
    nodata, adds_alpha = raster.nodata, False
    if background is None and nodata is None and not raster.has_alpha:
        adds_alpha = raster.dtype in (numpy.uint8, numpy.uint16) and raster.bands in (1, 3)
        nodata = None if adds_alpha else numpy.nan if raster.dtype.kind == "f" else 0
        if nodata == 0:
            inform(f"{output.name}: pixels outside are 0, and 0 is marked as no data.")
    tiles = ((column, row, finish(pixels, mask, raster.has_alpha, background, nodata))
             for column, row, pixels, mask in warp.tiles(raster, grid))
    _write_raster(output, grid, raster.bands + adds_alpha, raster.dtype, raster.has_alpha or adds_alpha, nodata, tiles)
