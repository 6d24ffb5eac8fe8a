# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Images, read by Pillow, and rasters, read by rasterio. Rasters are read in windows and warped in tiles, so that only
parts of large GeoTIFF files are in memory."""

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
    """The positions of pixels: the center of pixel (column, row) is first + steps @ (column, row). By default, the
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
        """The points of the pixels along the border, at most 4000 on each side."""
        x, y = (numpy.linspace(0, n - 1, min(n, 4000)) for n in self.size)
        sides = (x, 0), (self.width - 1, y), (x[::-1], self.height - 1), (0, y[::-1])
        return self.at(numpy.vstack([numpy.column_stack(numpy.broadcast_arrays(*side)) for side in sides]))

    @property
    def bounds(self):
        """The smallest and largest x and y of the pixels' centers."""
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
        """The same pixels with the upper left corner at (0, 0), as in QGIS for images that are not georeferenced."""
        return self if self.placed else Grid(*self.size, numpy.array([0.5, -0.5]))

    def part(self, column, row, width, height):
        return replace(self, width=width, height=height, first=self.at(numpy.array([column, row])))

    def to_vtk(self, values=None, as_cells=False):
        """A vtkImageData whose first row is the lowest, with values of shape (height, width, components) as point or
        cell data."""
        if as_cells:
            image = self.part(-0.5, -0.5, self.width + 1, self.height + 1).to_vtk()
            add_array(image, "Pixels", values[::-1].reshape(-1, values.shape[2]), True)
            return image
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
    source = None  # the file whose metadata is copied to the result
    profile = None  # the ICC profile of the colors
    is_classes = False  # whether the values are indices of the colors of a palette

    def __init__(self, pixels, mask=None):
        self.pixels, self.mask = numpy.atleast_3d(pixels), mask
        self.grid = Grid(self.pixels.shape[1], self.pixels.shape[0])
        self.bands, self.dtype = self.pixels.shape[2], self.pixels.dtype
        self.has_alpha = self.bands in (2, 4)

    def window(self, columns, rows):
        return self.pixels[slice(*rows), slice(*columns)]

    def known(self, pixels, columns, rows):
        """Whether the pixels of a window, or their bands, have data: an array of shape (rows, columns, 1 or bands), or
        None if all of them have."""
        known = self.read_mask(columns, rows)
        if self.nodata is not None:
            colors = pixels[:, :, : self.bands - self.has_alpha]
            have = ~numpy.isnan(colors) if numpy.isnan(self.nodata) else colors != self.nodata
            # A single component of a color may have the value for no data; other bands are independent.
            have = have.any(axis=2, keepdims=True) if self.is_color else have
            known = have if known is None else have & known
        return known

    def read_mask(self, columns, rows):
        return None if self.mask is None else self.mask[slice(*rows), slice(*columns)]

    @property
    def is_color(self):
        return self.has_alpha or self.bands == 3 and self.dtype in (numpy.uint8, numpy.uint16)

    def reduce(self, factor):
        """The raster of the means of squares of `factor` by `factor` pixels; no data where one of the pixels has none.
        An incomplete square at the end has the value of the one before it."""
        (columns, rows), rest = (n.tolist() for n in numpy.divmod(self.grid.size, factor))
        means, mask = numpy.empty((rows, columns, self.bands), self.dtype), None

        def over_squares(function, values):
            return function(function(values, axis=0).reshape(columns, factor, -1), axis=1)

        for row in range(rows):
            ranges = (0, columns * factor), (row * factor, (row + 1) * factor)
            pixels = self.window(*ranges)
            means[row] = round_to(self.dtype, over_squares(numpy.sum, pixels.astype(float)) / factor**2)
            if self.has_alpha:
                put_colors(means[row], over_squares(numpy.sum, weigh(pixels.astype(float))))
            known = self.known(pixels, *ranges)
            if known is not None:
                mask = numpy.empty((rows, columns, known.shape[2]), bool) if mask is None else mask
                mask[row] = over_squares(numpy.all, known)
        padding = [(0, int(n > 0)) for n in (*rest[::-1], 0)]
        result = Raster(numpy.pad(means, padding, "edge"), mask if mask is None else numpy.pad(mask, padding, "edge"))
        result.has_alpha = self.has_alpha
        width, height = result.grid.size
        result.grid = replace(self.grid, width=width, height=height, steps=factor * self.grid.steps,
                              first=self.grid.at(numpy.full(2, (factor - 1) / 2)))
        return result

    def all(self):
        return self.window((0, self.grid.width), (0, self.grid.height))


class GdalRaster(Raster):
    """A raster that rasterio reads in windows."""

    def __init__(self, input, keep_palette=False):
        import rasterio

        logging.getLogger("rasterio").setLevel(logging.CRITICAL)
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        self.file = rasterio.open(input.path)
        self.bands, self.dtype, self.nodata = self.file.count, numpy.dtype(self.file.dtypes[0]), self.file.nodata
        if self.dtype.kind == "c":
            raise ValueError("its pixels are complex numbers")
        if not (self.nodata is None or can_hold(self.dtype, self.nodata)):
            self.nodata = None
        self.palette, kinds = None, [kind.name for kind in self.file.colorinterp]
        # An additional band of unknown meaning is usually transparency if the other bands are colors.
        self.has_alpha = kinds[-1] == "alpha" or (
            not self.file.crs and kinds[:-1] in (["gray"], ["red", "green", "blue"]) and self.dtype.kind == "u")
        self.source = self.file
        self.is_classes = kinds == ["palette"] and keep_palette
        if kinds == ["palette"] and not keep_palette:
            self._read_palette()
        flags = self.file.mask_flag_enums[0]
        self.has_mask = rasterio.enums.MaskFlags.per_dataset in flags and rasterio.enums.MaskFlags.alpha not in flags
        self.grid, t = Grid(self.file.width, self.file.height), self.file.transform
        if self.file.crs or not t.is_identity:
            steps = numpy.array([[t.a, t.b], [t.d, t.e]])
            self.grid = Grid(*self.grid.size, numpy.array([t.c, t.f]) + steps @ [0.5, 0.5], steps, self.file.crs, True)

    def _read_palette(self):
        """The colors of values. The color of the value for no data is transparent."""
        colors = numpy.zeros((2 ** (8 * self.dtype.itemsize), 4), numpy.uint8)
        for value, color in self.file.colormap(1).items():
            colors[value] = color
        used = list(self.file.colormap(1))
        if self.nodata is not None:
            colors[int(self.nodata), 3] = 0
        self.has_alpha, self.nodata = bool((colors[used, 3] < 255).any()), None
        self.palette, self.bands, self.dtype = colors[:, : 3 + self.has_alpha], 3 + self.has_alpha, colors.dtype
        self.source = None

    def window(self, columns, rows):
        pixels = self.file.read(window=(rows, columns))
        return numpy.moveaxis(pixels, 0, 2) if self.palette is None else self.palette[pixels[0]]

    def read_mask(self, columns, rows):
        return self.file.read_masks(1, window=(rows, columns))[:, :, None] > 0 if self.has_mask else None


def read(name, standard_format="png", keep_palette=False):
    """The image in a file. The values of a GeoTIFF with a palette are replaced by its colors unless the palette is
    kept. Raises Failure."""
    input = Input(name, standard_format)
    if input.format not in PICTURES:
        raise Failure(f"Cannot read {input.name} as an image: the formats are {dotted(PICTURES)}.", USAGE)
    with input:
        try:
            raster = GdalRaster(input, keep_palette) if input.format in ("tif", "tiff") else _read_picture(input)
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

    # Pillow refuses images with twice as many pixels.
    Image.MAX_IMAGE_PIXELS = 2**30
    with Image.open(input.path, formats=[PILLOW_FORMATS.get(input.format, "PPM")]) as image:
        if "16B" in str(image.tile) and image.mode not in ("I", "I;16"):
            # Pillow would reduce 16 bits to 8.
            return Raster(GdalRaster(input).all())
        # The profile of CMYK colors does not apply to the RGB colors to which they are converted.
        profile = image.info.get("icc_profile") if image.mode != "CMYK" else None
        if image.mode not in ("L", "LA", "RGB", "RGBA", "I", "I;16", "F"):
            kinds = {"P": "RGBA" if "transparency" in image.info else "RGB", "1": "L", "PA": "RGBA"}
            image = image.convert(kinds.get(image.mode, "RGB"))
        elif image.mode in ("L", "RGB") and "transparency" in image.info:
            image = image.convert("RGBA")
        pixels = numpy.asarray(ImageOps.exif_transpose(image))
    raster = Raster(pixels.astype(numpy.uint16) if pixels.dtype == numpy.int32 else pixels)
    raster.profile = profile
    return raster


def read_background(text, format):
    """The color as three numbers from 0 to 1, or None if it is transparent."""
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
    """Raises Failure if no pixel of an image is within the bounding box of the mesh; warns if only few are."""
    points = points_of(mesh)[:, :2]
    a, b = grid.bounds.reshape(2, 2).T, numpy.array([points.min(axis=0), points.max(axis=0)])
    sizes = numpy.minimum(a[1], b[1]) - numpy.maximum(a[0], b[0])
    boxes = ", ".join(f"{who} (x from {low[0]:.10g} to {high[0]:.10g}, y from {low[1]:.10g} to {high[1]:.10g})"
                      for who, (low, high) in ((name, a), (mesh_name, b)))
    if sizes.min() < 0:
        raise Failure(f"{boxes} do not overlap: meshes must be in the image's coordinates (pixels, y upwards).")
    if sizes.prod() < 0.01 * numpy.ptp(a, axis=0).prod():
        inform(f"{boxes} overlap in less than 1 % of the image: meshes must be in the coordinates of the image.")


class Warp:
    """Warps images from one domain of a pair to the other, sampling at preimages, tile by tile. Interpolates, or, if
    `nearest`, uses the value of the pixel whose area contains the preimage."""

    def __init__(self, pair, settings, inverse=False, nearest=False):
        pair.require_flat()
        pair = replace(report.require_map(pair, settings.get("mask_invalid")), shift=None)
        self.pair, self.inverse, self.nearest = pair, inverse, nearest
        self.map = PointMap(pair, settings, inverse)
        self.filter = set_up(vtkResampleThroughHomeomorphism(), settings, pair)
        self.filter.SetInverse(inverse)
        self.filter.BlankOutsideOff()
        triangles = triangles_of(pair.source)
        corners = [points_of(pair.meshes[side])[triangles, :2] for side in (inverse, not inverse)]
        areas = [numpy.abs(numpy.linalg.det(c[:, 1:] - c[:, :1])).sum() for c in corners]
        self.scale = math.sqrt(areas[1] / areas[0])  # the mean factor of lengths
        # The boundary of the domain, divided into small pieces, in the image and in the result.
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
        """Points whose bounding box is that of the image (or the preimage) of a grid's rectangle, and the largest
        distance of neighbors; None if the rectangle is outside the domain. The points are the images of the rectangle's
        boundary and of the part of the domain's boundary that is inside the rectangle."""
        line = self._map(grid.outline(), forward)
        here, there = self.rims if forward else self.rims[::-1]
        pixels = grid.pixels(here)
        # The domain may end at the border of the image, so points beyond the centers of pixels there are not available.
        inside = ((pixels >= -1e-6) & (pixels <= numpy.array(grid.size) - 1 + 1e-6)).all(axis=2)
        points = numpy.vstack((line, there[inside]))
        if numpy.isnan(points).all():
            return None
        steps = [numpy.diff(points, axis=0).reshape(-1, 2) for points in (line, there)] + [numpy.zeros((1, 2))]
        return points[numpy.isfinite(points[:, 0])], numpy.nanmax(numpy.abs(numpy.vstack(steps)), axis=0)

    def fit_grid(self, raster, size=None, resolution=0.0, crs=None):
        """A grid over the image of a georeferenced raster, with square pixels. They have the size of the raster's
        pixels unless the map changes lengths by at least 1 %."""
        found = self.image_of(raster.grid, True)
        if found is None:
            raise Failure("No pixel of the image is within the mesh.")
        low, high = found[0].min(axis=0), found[0].max(axis=0)
        factor = self.scale if abs(self.scale - 1) >= 0.01 else 1.0
        spacing = numpy.full(2, resolution or factor * raster.grid.pixel)
        if size:
            # A single row or column has no height or width.
            spacing = numpy.where(high > low, (high - low) / numpy.maximum(numpy.array(size) - 1, 1), spacing)
        else:
            numbers = [length / step for length, step in zip((high - low).tolist(), spacing.tolist())]
            if math.prod(numbers) > LARGEST:
                raise Failure("The result would have {:.6g} x {:.6g} pixels, more than 2^32: use a larger "
                              "--resolution, or --size.".format(*numbers), USAGE)
            # Rounding errors must not add a pixel.
            size = [int(math.ceil(n - 1e-6)) + 1 for n in numbers]
        return Grid(*size, numpy.array([low[0], high[1]]), numpy.diag(spacing * [1, -1]), crs, True)

    def tiles(self, raster, grid, text="Warping"):
        """Yields (column, row, pixels, mask) for the tiles of a grid; pixels have the shape (rows, columns, bands)."""
        # The number of pixels of the raster that are as wide as one of the grid.
        factor = int(min(grid.pixel / self.scale / raster.grid.pixel + 0.01, *raster.grid.size))
        raster = raster.reduce(factor) if factor > 1 and not self.nearest else raster
        tiles = [(c, r) for r in range(0, grid.height, TILE) for c in range(0, grid.width, TILE)]
        for column, row in progress(tiles, text) if text else tiles:
            tile = grid.part(column, row, min(TILE, grid.width - column), min(TILE, grid.height - row))
            yield (column, row, *self.warp_tile(raster, tile))

    def warp_tile(self, raster, tile):
        shape = (tile.height, tile.width)
        begin, end = self._find_window(raster.grid, tile)
        if (begin >= end).any():
            return numpy.zeros((*shape, raster.bands), raster.dtype), numpy.zeros(shape, bool)
        # Repeat the pixels at the raster's border, because pixels are areas here and points in VTK.
        added = numpy.array([begin == 0, end == raster.grid.size]).astype(int) * (not self.nearest)
        ranges = numpy.array([begin, end]).T.tolist()
        window = raster.window(*ranges)
        known = raster.known(window, *ranges)
        if known is not None:
            # Values for no data can be so large that their rounding errors would be large.
            window = numpy.where(known, window, window.dtype.type(0))
        window = numpy.pad(window, (*added.T[::-1], (0, 0)), "edge")
        rows, columns = window.shape[:2]
        data = raster.grid.part(*(begin - added[0]), columns, rows).to_vtk(window, self.nearest)
        if added.any():
            # In each direction, 1 inside and 0 at added pixels. After rounding, the area ends halfway between them.
            x, y = (numpy.pad(numpy.ones(n - sum(pad), numpy.uint8), pad) for n, pad in zip((columns, rows), added.T))
            add_array(data, "Inside", numpy.stack(numpy.meshgrid(x, y[::-1]), axis=2).reshape(-1, 2))
        # Colors of equal transparency are mixed as they are.
        mixes_colors = raster.has_alpha and not self.nearest and numpy.ptp(window[:, :, -1]) > 0
        if mixes_colors:
            add_array(data, "Weighted", weigh(window)[::-1].reshape(-1, raster.bands))
        if known is not None:
            known = numpy.pad(known, (*added.T[::-1], (0, 0)), "edge")
            add_array(data, "Known", known[::-1].reshape(-1, known.shape[2]).astype(float), self.nearest)
        self.filter.SetDataObject(data)
        self.filter.SetGridData(tile.to_vtk())
        arrays = arrays_of(run(self.filter, self.pair.name).GetPointData())
        arrays = {name: values.reshape(*shape, -1)[::-1] for name, values in arrays.items()}
        mask = (arrays[MASK] != 0).all(axis=2) & arrays.get("Inside", numpy.ones(1)).all(axis=-1)
        if mixes_colors:
            put_colors(arrays["Pixels"], arrays["Weighted"])
        if known is not None:
            known = arrays["Known"] > 1 - 1e-9
            mask = mask & known[:, :, 0] if known.shape[2] == 1 else mask[:, :, None] & known
        return arrays["Pixels"], mask

    def _find_window(self, grid, tile):
        """The first pixel (column, row) of a raster that a tile needs, and the end."""
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
            pixels[where], mask[where] = part, inside if inside.ndim == 2 else inside.all(axis=2)
        return pixels, mask


def can_hold(dtype, value):
    """Whether a type of pixels can represent a value."""
    if dtype.kind in "iu":
        return numpy.iinfo(dtype).min <= value <= numpy.iinfo(dtype).max and value == int(value)
    return not abs(value) > numpy.finfo(dtype).max or math.isinf(value)


def unusual_value(raster):
    """A value for no data that pixels are unlikely to have."""
    if raster.dtype.kind not in "iu":
        return numpy.nan
    limits = numpy.iinfo(raster.dtype)
    return limits.max if raster.is_classes else limits.min


def round_to(dtype, values):
    return (numpy.rint(values) if dtype.kind in "iu" else values).astype(dtype)


def weigh(pixels):
    """Pixels whose colors are multiplied by the alpha values in their last band (premultiplied alpha). Pixels are mixed
    in this form, so that the color of transparent ones has no effect."""
    weighted = pixels.astype(numpy.float32 if pixels.dtype.itemsize < 4 else float)
    weighted[..., :-1] *= weighted[..., -1:]
    return weighted


def put_colors(pixels, weighted):
    """Sets the colors to those of mixed premultiplied pixels, except where the result is transparent."""
    opaque = weighted[..., -1] > 0
    pixels[opaque, :-1] = round_to(pixels.dtype, weighted[opaque, :-1] / weighted[opaque, -1:])


def brightest(dtype):
    return numpy.iinfo(dtype).max if dtype.kind in "iu" else 1.0


def add_alpha(pixels, mask=True):
    """The pixels with an added alpha band: opaque, but transparent where the mask is 0."""
    alpha = numpy.where(mask, brightest(pixels.dtype), 0).astype(pixels.dtype)
    return numpy.dstack((pixels, numpy.broadcast_to(alpha, pixels.shape[:2])))


def finish(pixels, mask, has_alpha, background, nodata=None):
    """Sets pixels outside to the background: a color, no data, or transparency (adding an alpha band if needed). The
    mask has the shape (rows, columns), or that of the pixels."""
    full, colors = brightest(pixels.dtype), pixels.shape[2] - has_alpha
    fill = numpy.full(pixels.shape[2], 0.0 if nodata is None else nodata)
    if nodata is None and background is not None:
        fill[:colors] = numpy.multiply(background if colors == 3 else numpy.mean(background), full)
        fill[colors:] = full
    inside = mask.reshape(*mask.shape[:2], -1)
    pixels = pixels if mask.all() else numpy.where(inside, pixels, round_to(pixels.dtype, fill))
    if background is None and nodata is None and not has_alpha and colors <= 3:
        pixels = add_alpha(pixels, mask)
    return pixels


def write(pixels, output, grid, profile=None):
    """Writes an array of shape (rows, columns, bands) as an image, with an ICC profile of its colors."""
    bands, kind, format = pixels.shape[2], pixels.dtype, output.format
    if format in ("tif", "tiff") or kind == numpy.uint16 and format == "png":
        _write_raster(output, grid, bands, kind, bands in (2, 4), None, [(0, 0, pixels)])
    elif bands > (3 if format in OPAQUE else 4) or kind != numpy.uint8 or bands == 2 and format in OPAQUE:
        raise Failure(f"A .{format} image cannot contain {bands} bands of {kind}: write a .tif.")
    else:
        from PIL import Image

        options = {"jpg": {"quality": 95}, "jpeg": {"quality": 95}, "png": {"compress_level": 3}}.get(format, {})
        image = Image.fromarray(pixels[:, :, 0] if bands == 1 else pixels)
        image.save(output.path, PILLOW_FORMATS.get(format, "PPM"), icc_profile=profile, **options)


def _copy_metadata(source, result):
    """Copies the metadata of a file and of its bands (names, units, scales)."""
    for name in ("descriptions", "units", "scales", "offsets"):
        known, own = getattr(source, name), getattr(result, name)
        setattr(result, name, known[: result.count] + own[source.count :])
    if source.colorinterp[0].name == "palette":
        result.write_colormap(1, source.colormap(1))
    for band in (0, *range(1, 1 + min(source.count, result.count))):
        tags = {name: value for name, value in source.tags(band).items()
                if name != "AREA_OR_POINT" and not name.startswith("STATISTICS_")}
        result.update_tags(band, **tags)


def _write_raster(output, grid, bands, dtype, has_alpha, nodata, tiles, source=None):
    """Writes tiles (column, row, pixels) to a TIFF file, or to a GeoTIFF file if the grid is georeferenced, with the
    metadata of `source`, an open file with the same or fewer bands."""
    import rasterio

    warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
    x, y = grid.at(numpy.array([-0.5, -0.5]))
    place = {"crs": grid.crs, "transform": rasterio.Affine(*grid.steps[0], x, *grid.steps[1], y)} if grid.placed else {}
    profile = {"driver": "PNG" if output.format == "png" else "GTiff", "width": grid.width, "height": grid.height,
               "count": bands, "dtype": dtype, "nodata": nodata, "tiled": True, "blockxsize": 512, "blockysize": 512,
               "compress": "deflate", "zlevel": 1, "BIGTIFF": "IF_SAFER", "num_threads": "ALL_CPUS", **place}
    try:
        with rasterio.open(output.path, "w", **profile) as file:
            if bands - has_alpha in (1, 3) and not (source and source.colorinterp[0].name == "palette"):
                colors = ["gray"] if bands < 3 else ["red", "green", "blue"]
                file.colorinterp = [rasterio.enums.ColorInterp[name] for name in colors + ["alpha"] * has_alpha]
            if source:
                _copy_metadata(source, file)
            for column, row, pixels in tiles:
                window = rasterio.windows.Window(column, row, *pixels.shape[1::-1])
                file.write(numpy.moveaxis(pixels, 2, 0), window=window)
    except rasterio.errors.CRSError:
        raise Failure(f"Unknown coordinate reference system {quote(grid.crs)}: give another one (--crs).",
                      USAGE) from None
    except rasterio.errors.RasterioError as error:
        raise Failure(f"Cannot write {output.name}: {error}", FILE) from None


def write_warped(warp, raster, grid, output, background):
    """Warps a raster and writes it. Pixels outside have the background, the raster's value for no data, transparency,
    or, if none of these is available, a new value for no data."""
    if output.format not in ("tif", "tiff"):
        write(finish(*warp.warp(raster, grid), raster.has_alpha, background), output, grid, raster.profile)
        return
    nodata, adds_alpha = raster.nodata, False
    if background is None and nodata is None and not raster.has_alpha:
        adds_alpha = raster.dtype in (numpy.uint8, numpy.uint16) and raster.bands in (1, 3) and not raster.is_classes
        nodata = None if adds_alpha else unusual_value(raster)
        if nodata is not None and raster.dtype.kind != "f":
            inform(f"{output.name}: pixels outside are {nodata}, and {nodata} is marked as no data.")
    tiles = ((column, row, finish(pixels, mask, raster.has_alpha, background, nodata))
             for column, row, pixels, mask in warp.tiles(raster, grid))
    _write_raster(output, grid, raster.bands + adds_alpha, raster.dtype, raster.has_alpha or adds_alpha, nodata, tiles,
                  raster.source)
