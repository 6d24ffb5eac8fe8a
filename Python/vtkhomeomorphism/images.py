# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Images and rasters: read in windows, warped in tiles, so that only parts of large GeoTIFF files are in memory."""

import io
import math
from dataclasses import dataclass, replace

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

from . import meshes, vtkfiles
from .files import FILE, PICTURES, USAGE, Failure, import_extra, inform, progress, replace_path
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
    """The position of pixels: x of the centers of the first column, y of those of the upper row, and spacing."""

    width: int
    height: int
    x: float = 0.0
    y: float = None
    dx: float = 1.0
    dy: float = 1.0
    crs: object = None
    placed: bool = False
    """Whether the file is georeferenced; otherwise the center of the lower left pixel is (0, 0)."""

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

    def to_vtk(self, values=None, name="Pixels"):
        """An image, with values of shape (height, width, components)."""
        image = vtkImageData()
        image.SetDimensions(self.width, self.height, 1)
        image.SetSpacing(self.dx, self.dy, 1.0)
        image.SetOrigin(self.x, self.bounds[2], 0.0)
        if values is not None:
            flat = numpy.ascontiguousarray(values[::-1]).reshape(-1, values.shape[2])
            array = numpy_to_vtk(flat)
            array.SetName(name)
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


class GdalRaster:
    """A raster that rasterio reads piece by piece."""

    def __init__(self, input, rasterio):
        self.file = rasterio.open(input.path)
        t = self.file.transform
        self.nodata = self.file.nodata
        self.palette = None
        if self.file.colorinterp[0].name == "palette" and self.file.count == 1:
            self.palette = numpy.zeros((256, 3), numpy.uint8)
            for value, color in self.file.colormap(1).items():
                self.palette[value % 256] = color[:3]
        self.bands = 3 if self.palette is not None else self.file.count
        self.dtype = numpy.dtype(self.file.dtypes[0])
        self.has_alpha = self.file.colorinterp[-1].name == "alpha" or (not self.file.crs and self.bands in (2, 4))
        self.grid = Grid(self.file.width, self.file.height)
        if self.file.crs or not t.is_identity:
            if t.b or t.d or t.a <= 0 or t.e >= 0:
                input.fail("its rows and columns do not run east and south: gdalwarp makes such a file.")
            x, y = t * (0.5, 0.5)
            self.grid = Grid(self.file.width, self.file.height, x, y, t.a, -t.e, self.file.crs, True)

    def window(self, columns, rows):
        pixels = self.file.read(window=(rows, columns))
        if self.palette is not None:
            return self.palette[pixels[0]]
        return numpy.moveaxis(pixels, 0, 2)


def read(input):
    """The image in a file. Raises Failure."""
    if input.format in ("vti", "vtk"):
        image = vtkfiles.read(input)
        if not isinstance(image, vtkImageData) or image.GetPointData().GetScalars() is None:
            input.fail(f"it holds a {image.GetClassName()}, not an image with pixels.")
        if image.GetDimensions()[2] != 1:
            raise Failure(f"{input.name} has {image.GetDimensions()[2]} layers, an image has one.")
        return from_vtk(image)
    if input.format not in PICTURES:
        formats = ", ".join("." + name for name in WRITE)
        raise Failure(f"Cannot read {input.name} as an image: the formats are {formats}.", USAGE)
    try:
        if input.format in ("tif", "tiff"):
            return _read_tiff(input)
        return Raster(_read_picture(input))
    except (Failure, MemoryError):
        raise
    except Exception as error:
        input.fail(f"it cannot be read as .{input.format}: {replace_path(error, input)}")


def from_vtk(image):
    width, height, _ = image.GetDimensions()
    scalars = image.GetPointData().GetScalars()
    pixels = vtk_to_numpy(scalars).reshape(height, width, -1)[::-1]
    (dx, dy, _), origin, extent = image.GetSpacing(), image.GetOrigin(), image.GetExtent()
    x, y = origin[0] + extent[0] * dx, origin[1] + extent[3] * dy
    return Raster(pixels, Grid(width, height, x, y, dx, dy))


def _read_tiff(input):
    try:
        import rasterio
    except ImportError:
        tifffile = import_extra("tifffile", "python3-tifffile", f"Reading {input.name}")
        with tifffile.TiffFile(input.path) as file:
            if 33550 in file.pages[0].tags:
                import_extra("rasterio", "python3-rasterio", f"Reading the georeferenced {input.name}")
            return Raster(file.asarray(key=0))
    import logging
    import warnings

    logging.getLogger("rasterio").setLevel(logging.CRITICAL)
    warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
    raster = GdalRaster(input, rasterio)
    # Read to the end, to detect truncated files.
    width, height = raster.grid.width, raster.grid.height
    raster.window((0, 1), (0, 1))
    raster.window((width - 1, width), (height - 1, height))
    return raster


def _read_picture(input):
    from PIL import Image

    Image.MAX_IMAGE_PIXELS = None
    with Image.open(input.path, formats=[PILLOW_FORMATS.get(input.format, "PPM")]) as image:
        if image.width * image.height > MOST_PIXELS:
            input.fail(f"an image of {image.width} x {image.height} pixels is too large for .{input.format}.")
        raw = image.tile[0][3] if image.tile else ""
        raw = raw[0] if isinstance(raw, tuple) else raw
        if input.format == "png" and str(raw).endswith("16B") and image.mode not in ("I", "I;16"):
            return _read_deep_png(input)
        image.load()
        if image.mode == "P":
            image = image.convert("RGBA" if "transparency" in image.info else "RGB")
        elif image.mode in ("1", "CMYK", "YCbCr", "PA", "HSV", "LAB"):
            image = image.convert({"1": "L", "PA": "RGBA"}.get(image.mode, "RGB"))
        pixels = numpy.asarray(image)
    return pixels.astype(numpy.uint16) if pixels.dtype == numpy.int32 else pixels


def _read_deep_png(input):
    # Pillow would reduce 16 bits to 8.
    from vtkmodules.vtkIOImage import vtkPNGReader

    reader = vtkPNGReader()
    reader.SetFileName(input.path)
    reader.Update()
    if vtkfiles.take_messages() or reader.GetOutput().GetNumberOfPoints() == 0:
        input.fail("it cannot be read as .png.")
    return from_vtk(reader.GetOutput()).pixels


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
    digits = {"white": "ffffff", "black": "000000"}.get(text, text[1:] if text.startswith("#") else "")
    if len(digits) == 6 and all(c in "0123456789abcdefABCDEF" for c in digits):
        return [int(digits[k : k + 2], 16) / 255 for k in (0, 2, 4)]
    raise Failure(f'"{text}" is an invalid color: transparent, white, black, or #rrggbb, such as #ff8000.', USAGE)


def require_overlap(grid, name, mesh, mesh_name):
    """Raises Failure if no pixel of an image is within the mesh's box; warns if hardly any is."""
    points = meshes.points_of(mesh)
    box = (points[:, 0].min(), points[:, 0].max(), points[:, 1].min(), points[:, 1].max())
    sizes = [
        min(a, b) - max(c, d) for a, b, c, d in zip(grid.bounds[1::2], box[1::2], grid.bounds[::2], box[::2])
    ]
    boxes = ", ".join(
        f"{who} (x from {b[0]:.10g} to {b[1]:.10g}, y from {b[2]:.10g} to {b[3]:.10g})"
        for who, b in ((name, grid.bounds), (mesh_name, box))
    )
    if min(sizes) < 0:
        raise Failure(f"{boxes} do not overlap: meshes must be in the image's coordinates (pixels, y upwards).")
    if sizes[0] * sizes[1] < 0.01 * (grid.width - 1) * grid.dx * (grid.height - 1) * grid.dy:
        inform(f"{boxes} overlap in less than a hundredth of the image: meshes must be in its coordinates.")


class Warp:
    """Warps images from one domain of a pair to the other, sampling at exact preimages, tile by tile."""

    def __init__(self, pair, settings, inverse=False):
        flat = [meshes.make_mesh(meshes.points_of(mesh)[:, :2], mesh.GetPolys()) for mesh in pair.meshes]
        pair.require_flat()
        pair = replace(pair, meshes=flat, shift=None)
        self.to_data = PointMap(pair, settings, not inverse)
        self.from_data = PointMap(pair, settings, inverse)
        self.filter = vtkResampleThroughHomeomorphism()
        settings.apply(self.filter)
        self.filter.SetSourceData(flat[0])
        self.filter.SetTargetData(flat[1])
        self.filter.SetInverse(inverse)
        self.filter.BlankOutsideOff()
        points = [meshes.points_of(mesh)[:, :2] for mesh in flat]
        self.data_points, self.grid_points = points[::-1] if inverse else points
        triangles = meshes.triangles_of(flat[0])
        edges = numpy.sort(numpy.vstack((triangles[:, :2], triangles[:, 1:], triangles[:, ::2])), axis=1)
        edges, counts = numpy.unique(edges, axis=0, return_counts=True)
        # Masked triangles have boundaries of their own.
        self.rims = edges if settings.mask_invalid else edges[counts == 1]

    def image_bounds(self, grid, mapping, here, there):
        """Least and greatest coordinates of the image of a grid's rectangle, and the largest steps between the images
        of neighbors; None if nothing of it is in the domain. The image is as large as that of its border: the
        rectangle's, and the part of the mesh's that is inside."""
        columns, rows = numpy.arange(grid.width), numpy.arange(grid.height)
        x0, x1, y0, y1 = grid.bounds
        rim = numpy.vstack([
            numpy.column_stack(numpy.broadcast_arrays(grid.x + columns * grid.dx, y)) for y in (y0, y1)
        ] + [numpy.column_stack(numpy.broadcast_arrays(x, grid.y - rows * grid.dy)) for x in (x0, x1)])
        images = mapping.map_points(rim)[0]
        steps = numpy.abs(numpy.diff(images, axis=0))
        # Differences between nonadjacent lines are not steps.
        steps[[grid.width - 1, 2 * grid.width - 1, 2 * grid.width + grid.height - 1]] = numpy.nan
        a, b = here[self.rims[:, 0]], here[self.rims[:, 1]]
        low, high = numpy.zeros(len(a)), numpy.ones(len(a))
        for axis, (least, most) in enumerate(((x0, x1), (y0, y1))):
            with numpy.errstate(divide="ignore", invalid="ignore"):
                t = numpy.array([(least - a[:, axis]), (most - a[:, axis])]) / (b - a)[:, axis]
            inside = (a[:, axis] >= least) & (a[:, axis] <= most)
            still = b[:, axis] == a[:, axis]
            low = numpy.where(still, numpy.where(inside, low, 2), numpy.fmax(low, t.min(axis=0)))
            high = numpy.where(still, high, numpy.fmin(high, t.max(axis=0)))
        meets = low <= high
        ends = [
            there[self.rims[meets, 0]] * (1 - t[meets, None]) + there[self.rims[meets, 1]] * t[meets, None]
            for t in (low, high)
        ]
        found = numpy.vstack([images[numpy.isfinite(images).all(axis=1)]] + ends)
        if not len(found):
            return None
        steps = steps[numpy.isfinite(steps).all(axis=1)]
        step = steps.max(axis=0) if len(steps) else numpy.zeros(2)
        return found.min(axis=0), found.max(axis=0), step

    def fit_grid(self, raster, size=None, resolution=0.0, crs=None):
        """A grid over the image of a placed raster, with pixels of its size unless that changes by more than 1 %."""
        coarse = max(1, max(raster.grid.width, raster.grid.height) // 4000)
        grid = raster.grid
        rim = replace(grid, width=(grid.width - 1) // coarse + 1, height=(grid.height - 1) // coarse + 1)
        rim.dx *= (grid.width - 1) / max(1, rim.width - 1)
        rim.dy *= (grid.height - 1) / max(1, rim.height - 1)
        bounds = self.image_bounds(rim, self.from_data, self.data_points, self.grid_points)
        if bounds is None:
            raise Failure("No pixel of the image is within the mesh.")
        low, high, _ = bounds
        own = numpy.hypot(grid.width * grid.dx, grid.height * grid.dy) / numpy.hypot(grid.width, grid.height)
        if size:
            dx, dy = (high - low) / numpy.maximum(numpy.array(size) - 1, 1)
        else:
            extent = numpy.array([numpy.ptp(p, axis=0) for p in (self.data_points, self.grid_points)])
            factor = numpy.hypot(*extent[1]) / numpy.hypot(*extent[0])
            kept = abs(factor - 1) < 0.01
            dx, dy = (grid.dx, grid.dy) if kept else (own * factor, own * factor)
            if resolution:
                dx = dy = resolution
            # A rounding error must not add a pixel.
            size = [int(math.ceil(span / d - 1e-6)) + 1 for span, d in zip(high - low, (dx, dy))]
        return Grid(*size, low[0], high[1], dx, dy, crs, True)

    def tiles(self, raster, grid, text="Warping"):
        """Yields (column, row, pixels, mask) of the tiles of a grid; pixels of shape (rows, columns, bands)."""
        places = [(c, r) for r in range(0, grid.height, TILE) for c in range(0, grid.width, TILE)]
        for column, row in progress(places, text) if text else places:
            tile = grid.part(column, row, TILE, TILE)
            yield (column, row, *self.warp_tile(raster, tile))

    def warp_tile(self, raster, tile):
        pixels = numpy.zeros((tile.height, tile.width, raster.bands), raster.dtype)
        mask = numpy.zeros(pixels.shape[:2], bool)
        bounds = self.image_bounds(tile, self.to_data, self.grid_points, self.data_points)
        if bounds is None:
            return pixels, mask
        low, high, step = bounds
        (x0, y0), (x1, y1) = low - step, high + step
        g = raster.grid
        places = ((x0 - g.x) / g.dx - 2, (x1 - g.x) / g.dx + 3, (g.y - y1) / g.dy - 2, (g.y - y0) / g.dy + 3)
        limits = (g.width, g.width, g.height, g.height)
        c0, c1, r0, r1 = (int(min(max(math.floor(p), 0), limit)) for p, limit in zip(places, limits))
        if c0 >= c1 or r0 >= r1:
            return pixels, mask
        window = raster.window((c0, c1), (r0, r1))
        data = g.part(c0, r0, c1 - c0, r1 - r0).to_vtk(window)
        known = None
        if raster.nodata is not None:
            bad = (numpy.isnan(window) if raster.nodata != raster.nodata else window == raster.nodata).any(axis=2)
            known = numpy_to_vtk(numpy.ascontiguousarray(~bad[::-1], numpy.float64).ravel(), deep=True)
            known.SetName("Known")
            data.GetPointData().AddArray(known)
        self.filter.SetDataObject(data)
        self.filter.SetGridData(tile.to_vtk())
        result = run(self.filter, self.to_data.pair.name).GetPointData()
        shape = (tile.height, tile.width)
        pixels = vtk_to_numpy(result.GetArray("Pixels")).reshape(*shape, -1)[::-1]
        mask = vtk_to_numpy(result.GetArray(MASK)).reshape(shape)[::-1] != 0
        if known is not None:
            mask = mask & (vtk_to_numpy(result.GetArray("Known")).reshape(shape)[::-1] > 1 - 1e-9)
        return pixels, mask

    def warp(self, raster, grid, text="Warping"):
        """Pixels and mask of the whole grid."""
        pixels = numpy.zeros((grid.height, grid.width, raster.bands), raster.dtype)
        mask = numpy.zeros(pixels.shape[:2], bool)
        for column, row, part, inside in self.tiles(raster, grid, text):
            place = (slice(row, row + part.shape[0]), slice(column, column + part.shape[1]))
            pixels[place], mask[place] = part, inside
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
        fill[:colors] = background if colors == 3 else numpy.mean(background)
        fill[colors:] = 1
        fill *= full
    fill = (numpy.rint(fill) if pixels.dtype.kind in "iu" else fill).astype(pixels.dtype)
    if not mask.all():
        pixels = numpy.where(mask[:, :, None], pixels, fill)
    if background is None and nodata is None and not has_alpha and pixels.shape[2] <= 3:
        pixels = numpy.dstack((pixels, numpy.where(mask, full, 0).astype(pixels.dtype)))
    return pixels


def write(pixels, output, grid=None):
    """Writes an array of shape (rows, columns, bands) as an image."""
    bands, kind, format = pixels.shape[2], pixels.dtype, output.format
    if format == "vti":
        vtkfiles.write((grid or Grid(*pixels.shape[1::-1])).to_vtk(pixels), output)
        return
    flat = pixels[:, :, 0] if bands == 1 else pixels
    if format in ("tif", "tiff"):
        tifffile = import_extra("tifffile", "python3-tifffile", f"Writing {output.name}")
        buffer = io.BytesIO()
        tifffile.imwrite(buffer, flat, photometric="rgb" if bands in (3, 4) else "minisblack")
        output.write_bytes(buffer.getbuffer())
        return
    deep = kind == numpy.uint16 and format == "png"
    if bands > (3 if format in OPAQUE else 4) or not (kind == numpy.uint8 or deep) or bands == 2 and format in OPAQUE:
        raise Failure(f"A .{format} image cannot hold {bands} bands of {kind}: write a .tif or .vti.")
    if deep:
        from vtkmodules.vtkIOImage import vtkPNGWriter

        writer = vtkPNGWriter()
        writer.WriteToMemoryOn()
        writer.SetInputData(Grid(*pixels.shape[1::-1]).to_vtk(pixels))
        writer.Write()
        output.write_bytes(vtk_to_numpy(writer.GetResult()).tobytes())
        return
    from PIL import Image

    options = {"quality": 95} if format in ("jpg", "jpeg") else {"compress_level": 3} if format == "png" else {}
    # Written here, because Pillow does not notice full disks.
    buffer = io.BytesIO()
    Image.fromarray(flat).save(buffer, PILLOW_FORMATS.get(format, "PPM"), **options)
    output.write_bytes(buffer.getbuffer())


class TiffWriter:
    """A GeoTIFF that is written tile by tile."""

    def __init__(self, output, grid, raster, background):
        rasterio = import_extra("rasterio", "python3-rasterio", f"Writing the georeferenced {output.name}")
        self.output, self.background, self.nodata = output, background, raster.nodata
        self.has_alpha = raster.has_alpha
        adds_alpha = False
        if background is None and self.nodata is None and not self.has_alpha:
            if raster.dtype.kind == "f":
                self.nodata = numpy.nan
            elif raster.dtype in (numpy.uint8, numpy.uint16) and raster.bands in (1, 3):
                adds_alpha = True
            else:
                self.nodata = 0
                inform(f"{output.name}: pixels outside are 0, and 0 is marked as no data.")
        bands = raster.bands + adds_alpha
        left, top = grid.x - grid.dx / 2, grid.y + grid.dy / 2
        self.window = rasterio.windows.Window
        self.file = rasterio.open(
            output.path, "w", driver="GTiff", width=grid.width, height=grid.height, count=bands, dtype=raster.dtype,
            crs=grid.crs, transform=rasterio.Affine(grid.dx, 0, left, 0, -grid.dy, top), nodata=self.nodata,
            tiled=True, blockxsize=512, blockysize=512, compress="deflate", zlevel=1, BIGTIFF="IF_SAFER",
            num_threads="ALL_CPUS",
        )
        interpretation = rasterio.enums.ColorInterp
        if bands - (adds_alpha or self.has_alpha) in (1, 3):
            names = ["red", "green", "blue"] if bands >= 3 else ["gray"]
            names += ["alpha"] * (adds_alpha or self.has_alpha)
            self.file.colorinterp = [interpretation[name] for name in names]
        self.last = self.window(grid.width - 1, grid.height - 1, 1, 1)

    def write(self, column, row, pixels, mask):
        pixels = finish(pixels, mask, self.has_alpha, self.background, self.nodata)
        window = self.window(column, row, pixels.shape[1], pixels.shape[0])
        self.file.write(numpy.moveaxis(pixels, 2, 0), window=window)

    def close(self):
        """Reads the file again, because GDAL does not report a full disk at the end."""
        import rasterio

        try:
            self.file.close()
            with rasterio.open(self.output.path) as file:
                file.read(window=self.last)
        except rasterio.errors.RasterioError as error:
            raise Failure(f"Cannot write {self.output.name}: {error}", FILE) from None
