# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm warp, with Pillow, tifffile and rasterio as independent readers and writers."""

import json
import shutil
import subprocess

import numpy
import pytest
from conftest import FILE, REFUSED, USAGE
from pairs import Pair, make_grid, make_pair, map_points, write_json, write_mesh, xy

Image = pytest.importorskip("PIL.Image")
WIDTH, HEIGHT = 24, 18


@pytest.fixture
def pair():
    return make_pair(4, 3, width=WIDTH - 1, height=HEIGHT - 1)


@pytest.fixture
def image(dhm):
    pixels = numpy.random.default_rng(4).integers(0, 256, (HEIGHT, WIDTH, 3)).astype(numpy.uint8)
    Image.fromarray(pixels).save(dhm.path("image.png"))
    return pixels


def warp(dhm, pair, *options, image="image.png", output="out.png"):
    write_json(dhm.path("pair.json"), pair)
    dhm("warp", "--force", "-s", "smooth", *options, "pair.json", image, "-o", output)
    return dhm.path(output)


def read(path):
    return numpy.asarray(Image.open(path))


def test_identity_keeps_all_pixels(dhm, pair, image):
    same = pair._replace(target=pair.source)
    for name in ("out.png", "out.ppm", "out.tif"):
        path = warp(dhm, same, output=name)
        pixels = read(path)
        numpy.testing.assert_array_equal(pixels[:, :, :3], image)
        assert pixels.shape[2] == 3 or (pixels[:, :, 3] == 255).all()


def test_photographs_are_upright(dhm, pair, image):
    exif = Image.Exif()
    exif[0x112] = 6  # to be turned clockwise by a quarter
    Image.fromarray(numpy.rot90(image)).save(dhm.path("turned.png"), exif=exif)
    same = pair._replace(target=pair.source)
    numpy.testing.assert_array_equal(read(warp(dhm, same, image="turned.png", output="out.ppm")), image)


def test_the_image_may_come_first(dhm, pair, image):
    for name, points in (("a.off", pair.source), ("b.off", pair.target)):
        write_mesh(dhm.path(name), points, pair.triangles)
    dhm("warp", "a.off", "b.off", "image.png", "-o", "last.png")
    dhm("warp", "image.png", "a.off", "b.off", "-o", "first.png")
    assert dhm.path("first.png").read_bytes() == dhm.path("last.png").read_bytes()


def test_shift_alpha_and_background(dhm, pair, image):
    # Four pixels to the right and three up; rows are counted from above.
    moved = pair._replace(target=pair.source + [4, 3])
    rgba = read(warp(dhm, moved))
    numpy.testing.assert_array_equal(rgba[:-3, 4:, :3], image[3:, :-4])
    alpha = numpy.zeros((HEIGHT, WIDTH))
    alpha[:-3, 4:] = 255
    numpy.testing.assert_array_equal(rgba[:, :, 3], alpha)
    assert (rgba[alpha == 0] == 0).all()
    back = read(warp(dhm, moved, "--inverse"))
    numpy.testing.assert_array_equal(back[3:, :-4, :3], image[:-3, 4:])
    assert (read(warp(dhm, moved, output="out.ppm"))[alpha == 0] == 255).all()
    orange = read(warp(dhm, moved, "--background", "#ff8001"))
    assert orange.shape[2] == 3 and (orange[alpha == 0] == [255, 128, 1]).all()
    black = read(warp(dhm, moved, "--background", "black", "--size", "40x30"))
    numpy.testing.assert_array_equal(black[30 - 18 - 3 : 30 - 3, 4:28], image)
    assert black.astype(int).sum() == image.astype(int).sum()


def test_pixels_are_looked_up_by_the_inverse(dhm, pair, image):
    row, column = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    points = numpy.column_stack((column.ravel(), HEIGHT - 1 - row.ravel()))
    out = read(warp(dhm, pair, "--background", "black")).astype(float)
    origins = xy(map_points(dhm, ["pair.json"], points, "--inverse", "-s", "smooth"))
    x, y = origins[:, 0].clip(0, WIDTH - 1), HEIGHT - 1 - origins[:, 1].clip(0, HEIGHT - 1)
    i, j = (numpy.minimum(v.astype(int), n - 2) for v, n in ((x, WIDTH), (y, HEIGHT)))
    u, v = (x - i)[:, None], (y - j)[:, None]
    real = image.astype(float)
    expected = (1 - v) * ((1 - u) * real[j, i] + u * real[j, i + 1]) + v * (
        (1 - u) * real[j + 1, i] + u * real[j + 1, i + 1])
    assert numpy.abs(out.reshape(-1, 3) - expected).max() <= 0.5 + 1e-6


def test_pixels_own_their_area(dhm, image):
    """Half a pixel beyond the center of a pixel at the border is its value; farther out is outside."""
    corners, triangles = make_grid(1, 1, WIDTH + 9, HEIGHT + 9)
    for shift in (0.4, 0.6):
        # Pixel (column, row) of the result shows the image at (column - shift, row - shift), y upwards.
        rgba = read(warp(dhm, Pair(corners - 5, corners - 5 + shift, triangles), "--size", f"{WIDTH + 2}x{HEIGHT + 2}"))
        x, y = numpy.arange(WIDTH + 2) - shift, numpy.arange(HEIGHT + 2)[::-1] - shift
        inside = numpy.logical_and(*numpy.meshgrid(*((-0.5 < v) & (v < n - 0.5)
                                                     for v, n in ((x, WIDTH), (y, HEIGHT)))))
        numpy.testing.assert_array_equal(rgba[:, :, 3] > 0, inside)
        assert inside[-1, 0] == (shift == 0.4) and inside.sum() == WIDTH * HEIGHT
        real = numpy.pad(image.astype(float), ((1, 2), (1, 2), (0, 0)), "edge")
        i, j = numpy.floor(x).astype(int), numpy.floor(HEIGHT - 1 - y).astype(int)
        u, v = (x - i)[:, None], (HEIGHT - 1 - y - j)[:, None, None]
        rows = (1 - u) * real[:, i + 1] + u * real[:, i + 2]
        expected = (1 - v) * rows[j + 1] + v * rows[j + 2]
        assert numpy.abs(rgba[:, :, :3] - expected)[inside].max() <= 0.5 + 1e-6


@pytest.mark.parametrize("name", ["image.png", "image.tif"])
def test_smaller_images_have_means(dhm, pair, image, name):
    Image.fromarray(image).save(dhm.path("image.tif"))
    smaller = pair._replace(target=(pair.source - 1) / 3)
    out = read(warp(dhm, smaller, "--size", "8x6", image=name, output="out.ppm"))
    numpy.testing.assert_allclose(out, image.reshape(6, 3, 8, 3, 3).mean(axis=(1, 3)), rtol=0, atol=1)
    # Parts of squares at the end.
    smaller = pair._replace(target=(pair.source - [2, 0]) / 5)
    out = read(warp(dhm, smaller, "--size", "5x4", image=name, output="out.png"))
    assert out.shape == (4, 5, 4)
    numpy.testing.assert_allclose(out[:3, :4, :3].astype(float),
                                  image[:15, :20].reshape(3, 5, 4, 5, 3).mean(axis=(1, 3)), rtol=0, atol=1)


def test_transparent_pixels_have_no_color(dhm):
    """Where a picture ends, its colors are not mixed with what is stored in transparent pixels."""
    corners, triangles = make_grid(1, 1, 80, 80)
    orange = [200, 100, 50]
    pixels = numpy.zeros((41, 41, 4), "u1")
    pixels[:, :20], pixels[:, 20:, :3], pixels[:, 20:, 3] = [0, 255, 0, 0], orange, 255
    for bands, name in ((4, "rgba.png"), (4, "rgba.tif"), (2, "la.png")):
        some = pixels[:, :, [0, 3]] if bands == 2 else pixels
        Image.fromarray(some).save(dhm.path(name))
        for shift, factor in ((0.5, 1), (0.25, 1), (0, 1 / 2.5)):
            out = read(warp(dhm, Pair(corners - 20, factor * (corners - 20) + shift, triangles), image=name))
            assert {0, 255} < set(numpy.unique(out[..., -1]))
            seen = out[out[..., -1] > 0]
            assert (seen[:, :-1] == (orange if bands == 4 else orange[:1])).all()
    # One picture ends within the other.
    whole = numpy.zeros((41, 41, 4), "u1") + numpy.array([*orange, 255], "u1")
    Image.fromarray(whole).save(dhm.path("whole.png"))
    write_json(dhm.path("same.json"), Pair(corners - 20, corners - 20, triangles))
    dhm("morph", "same.json", "--source-image", "rgba.png", "--target-image", "whole.png", "-n", "3", "-o", "f%d.png")
    frame = read(dhm.path("f1.png"))
    assert (frame[:, :, :3] == orange).all() and set(numpy.unique(frame[:, :, 3])) == {128, 255}


def test_profiles_and_transparent_colors_stay(dhm, pair, image):
    same = pair._replace(target=pair.source)
    for name in ("p.jpg", "p.png", "p.webp"):
        Image.fromarray(image).save(dhm.path(name), icc_profile=b"profile" * 20)
        out = warp(dhm, same, image=name, output="out-" + name)
        assert Image.open(out).info["icc_profile"] == b"profile" * 20
        dhm("morph", "pair.json", "--source-image", name, "-n", "2", "-o", "frame%d-" + name)
        assert Image.open(dhm.path("frame1-" + name)).info["icc_profile"] == b"profile" * 20
    image[2:5, 3:9] = [255, 0, 255]
    Image.fromarray(image).save(dhm.path("t.png"), transparency=(255, 0, 255))
    out = read(warp(dhm, same, image="t.png"))
    clear = (image == [255, 0, 255]).all(axis=2)
    numpy.testing.assert_array_equal(out[..., 3], numpy.where(clear, 0, 255))
    numpy.testing.assert_array_equal(out[~clear, :3], image[~clear])


def test_tiles_are_seamless(dhm, monkeypatch):
    """A warp in small tiles, each from its own window of the image, is that of the whole image."""
    from vtkhomeomorphism import images, meshes, pair as pairs

    for turn in (0.0, 0.7):
        own = make_pair(7, 6, width=180, height=140, seed=5)
        c, s = numpy.cos(turn), numpy.sin(turn)
        target = 0.6 * (own.target - [90, 70]) @ [[c, -s], [s, c]] + [90, 70]
        both = pairs.Pair([meshes.make_mesh(p, own.triangles) for p in (own.source, target)], ["a", "b"])
        pixels = numpy.random.default_rng(6).integers(0, 256, (141, 181, 3)).astype(numpy.uint8)
        warp = images.Warp(both, {"system": "smooth"})
        raster = images.Raster(pixels)
        monkeypatch.setattr(images, "TILE", 1000)
        whole = warp.warp(raster, raster.grid)
        monkeypatch.setattr(images, "TILE", 23)
        read = []
        window = raster.window
        monkeypatch.setattr(raster, "window", lambda *w: read.append(w) or window(*w))
        tiled = warp.warp(raster, raster.grid)
        numpy.testing.assert_array_equal(tiled[1], whole[1])
        assert numpy.abs(tiled[0].astype(int) - whole[0]).max() <= 1
        # Points that rounding puts on another place: hardly any.
        assert (tiled[0] != whole[0]).mean() < 1e-3
        assert max((c[1] - c[0]) * (r[1] - r[0]) for c, r in read) < 0.2 * pixels[:, :, 0].size


@pytest.mark.parametrize("mode, dtype", [("L", "u1"), ("LA", "u1"), ("RGBA", "u1"), ("I;16", "u2"), ("P", "u1"),
                                         ("1", "u1")])
def test_kinds_of_pixels(dhm, pair, mode, dtype):
    same = pair._replace(target=pair.source)
    bands = {"LA": 2, "RGBA": 4}.get(mode, 1)
    pixels = numpy.random.default_rng(7).integers(0, 2 ** (8 * int(dtype[1])), (HEIGHT, WIDTH, bands)).astype(dtype)
    flat = pixels[:, :, 0] if bands == 1 else pixels
    picture = Image.fromarray(flat if mode != "1" else flat > 127)
    if mode == "P":
        picture.putpalette(numpy.random.default_rng(8).integers(0, 256, 768).astype("u1").tobytes())
    picture.save(dhm.path("kind.png"))
    expected = numpy.asarray(picture.convert("RGB") if mode == "P" else picture)
    out = read(warp(dhm, same, "--background", "white", image="kind.png", output="kind-out.png"))
    if mode == "1":
        expected = expected * 255
    numpy.testing.assert_array_equal(out, expected)


def test_sixteen_bits_a_color_stay(dhm, pair):
    tifffile = pytest.importorskip("tifffile")
    same = pair._replace(target=pair.source)
    deep = numpy.random.default_rng(9).integers(0, 65536, (HEIGHT, WIDTH, 3)).astype("u2")
    tifffile.imwrite(dhm.path("deep.tif"), deep, photometric="rgb")
    options = ("--background", "white")
    warp(dhm, same, *options, image="deep.tif", output="deep.png")
    again = tifffile.imread(warp(dhm, same, *options, image="deep.png", output="again.tif"))
    numpy.testing.assert_array_equal(again, deep)
    write_json(dhm.path("pair.json"), same)
    dhm.refuse(REFUSED, "warp", "pair.json", "deep.tif", "-o", "new.jpg", says=(".jpg", "uint16"))
    heights = numpy.random.default_rng(10).random((HEIGHT, WIDTH)).astype("f4")
    tifffile.imwrite(dhm.path("heights.tif"), heights)
    again = tifffile.imread(warp(dhm, same, "--background", "black", image="heights.tif", output="again.tif"))
    numpy.testing.assert_allclose(again, heights, rtol=1e-6)
    dhm.refuse(REFUSED, "warp", "pair.json", "heights.tif", "-o", "new.png", says=(".png", "float32"))


def test_wrong_colors_sizes_and_names(dhm, pair, image):
    write_json(dhm.path("pair.json"), pair)

    def refuse(*options, output="new.png", says):
        dhm.refuse(USAGE, "warp", "pair.json", "image.png", *options, "-o", output, says=says)

    for color in ("reddish", "#12345", "#12345g", "#1234567"):
        refuse("--background", color, says=(color, "#rrggbb"))
    for size in ("0x5", "5", "x", "5x", "-3x4", "3x4x5", "1e3x2", "200000x2", "4.5x3"):
        refuse("--size=" + size, says=(size, "WIDTHxHEIGHT"))
    refuse("--background", "transparent", output="new.jpg", says=("transparent", ".jpg"))
    for name in ("new", "new.gif", "new.csv", "new.vtp"):
        refuse(output=name, says=".png")
    refuse("--crs", "EPSG:3067", says=("--crs", "georeferenced"))


def test_meshes_beside_the_image(dhm, pair, image):
    small = make_pair(2, 2)
    write_json(dhm.path("beside.json"), Pair(small.source + [1000, 0], small.target + [1000, 0], small.triangles))
    for options in ((), ("-i",)):
        dhm.refuse(REFUSED, "warp", *options, "beside.json", "image.png", "-o", "new.png",
                   says=("image.png", "beside.json", "x from 1000 to 1001", "do not overlap"))
    write_json(dhm.path("unit.json"), small)
    assert "less than 1 %" in dhm("warp", "unit.json", "image.png", "-o", "unit.png").err
    write_json(dhm.path("pair.json"), pair)
    assert dhm("warp", "-s", "smooth", "pair.json", "image.png", "-o", "pair.png").err == ""


def write_xmorph(path, columns, points):
    lines = [f"{x!r} {y!r} 0\n" for x, y in points.tolist()]
    path.write_text(f"M2\n{columns} {len(points) // columns}\n" + "".join(lines))


def test_xmorph_meshes(dhm, image):
    # In xmorph's own units, ten to a pixel of its working image; rows from the top.
    points, _ = make_grid(3, 2, 10 * (WIDTH - 1), 10 * (HEIGHT - 1))
    write_xmorph(dhm.path("a.mesh"), 4, points)
    dhm("warp", "a.mesh", "a.mesh", "image.png", "-o", "out.ppm")
    numpy.testing.assert_array_equal(read(dhm.path("out.ppm")), image)
    # The second image has another size, and the first mesh ends a little before its image does.
    rim = points.copy()
    rim[1, 1] += 1
    write_xmorph(dhm.path("rim.mesh"), 4, rim)
    Image.fromarray(image[:-4, :-3]).save(dhm.path("small.png"))
    dhm("morph", "rim.mesh", "a.mesh", "--source-image", "image.png", "--target-image", "small.png", "-n", "3",
        "-o", "f%d.png")
    assert all((read(dhm.path(f"f{k}.png"))[:, :, 3] == 255).all() for k in range(3))
    inner = points.copy()
    inner[:4, 1] += 30
    write_xmorph(dhm.path("b.mesh"), 4, inner)
    dhm.refuse(USAGE, "warp", "b.mesh", "b.mesh", "image.png", "-o", "new.ppm", says=("b.mesh", "--working-size"))
    dhm("warp", "b.mesh", "b.mesh", "image.png", "-f", "-o", "out.ppm", "--working-size", f"{WIDTH}x{HEIGHT}")
    out = read(dhm.path("out.ppm"))
    numpy.testing.assert_array_equal(out[3:], image[3:])
    assert (out[:3] == 255).all()
    write_xmorph(dhm.path("c.mesh"), 3, points)
    dhm.refuse(FILE, "warp", "a.mesh", "c.mesh", "image.png", "-o", "new.ppm", says="columns and rows")
    write_mesh(dhm.path("a.off"), points, make_grid(3, 2)[1])
    dhm.refuse(FILE, "warp", "a.mesh", "a.off", "image.png", "-o", "new.ppm", says=("a.off", "M2"))
    for text in ("", "M3\n", "M2\n1 5\n", "M2\nx y\n", "M2\n2 2\n0 0 0\n1 0 0\n0 q 0\n", "M2\n2 2\n0 0 0\n"):
        dhm.path("bad.mesh").write_text(text)
        dhm.refuse(FILE, "warp", "bad.mesh", "a.mesh", "image.png", "-o", "new.ppm", says=("bad.mesh", "line"))


def test_damaged_images(dhm, pair, image):
    write_json(dhm.path("pair.json"), pair)
    for name in ("good.jpg", "good.ppm", "good.tif"):
        warp(dhm, pair, output=name)
    (dhm.path("image.png")).rename(dhm.path("good.png"))
    for name in ("good.png", "good.jpg", "good.ppm", "good.tif"):
        data = dhm.path(name).read_bytes()
        for bad in (b"", data[:20], data[: len(data) // 2], numpy.random.default_rng(8).bytes(700)):
            bad_name = "bad" + name[-4:]
            dhm.path(bad_name).write_bytes(bad)
            dhm.refuse(FILE, "warp", "pair.json", bad_name, "-o", "new.png", says=bad_name)
    # Another kind than the name says.
    dhm.path("jpeg.png").write_bytes(dhm.path("good.jpg").read_bytes())
    dhm.refuse(FILE, "warp", "pair.json", "jpeg.png", "-o", "new.png", says="jpeg.png")
    dhm.path("huge.ppm").write_bytes(b"P6 1000000 1000000 255\n" + bytes(100))
    dhm.refuse(FILE, "warp", "pair.json", "huge.ppm", "-o", "new.png")


# --- GeoTIFF

rasterio = pytest.importorskip("rasterio")


@pytest.fixture
def shift(dhm):
    """Between two grids on the ground, both far from their origins."""
    own = make_pair(5, 4, width=2000, height=1600, seed=11)
    result = Pair(own.source + [3384000, 6672000], own.target + [384000, 6669000], own.triangles)
    write_json(dhm.path("shift.json"), result, input_crs="EPSG:2393", output_crs="EPSG:3067")
    return result


def write_geotiff(path, pixels, x, y, size, crs="EPSG:2393", **options):
    with rasterio.open(path, "w", driver="GTiff", width=pixels.shape[1], height=pixels.shape[0], count=pixels.shape[2],
                       dtype=pixels.dtype, crs=crs, transform=rasterio.transform.from_origin(x, y, size, size),
                       **options) as file:
        file.write(numpy.moveaxis(pixels, 2, 0))


def test_geotiff_pixels_are_where_the_inverse_says(dhm, shift):
    x = numpy.arange(120) * 10 + 3384405.0
    y = 6673195.0 - numpy.arange(90) * 10
    pixels = numpy.stack(numpy.broadcast_arrays(x - 3384000, (y - 6672000)[:, None]), axis=2).astype("f4")
    write_geotiff(dhm.path("in.tif"), pixels, 3384400, 6673200, 10)
    dhm("warp", "shift.json", "in.tif", "-o", "out.tif")
    with rasterio.open(dhm.path("out.tif")) as file:
        assert file.crs == "EPSG:3067" and numpy.isnan(file.nodata)
        assert file.transform.a == pytest.approx(10) and file.transform.e == pytest.approx(-10)
        values = file.read()
        rows, columns = numpy.nonzero(numpy.isfinite(values[0]))
        places = numpy.column_stack(rasterio.transform.xy(file.transform, rows, columns))
    assert len(rows) > 0.9 * 120 * 90
    if shutil.which("gdalinfo"):
        ran = subprocess.run(["gdalinfo", "-json", dhm.path("out.tif")], stdout=subprocess.PIPE, check=True)
        said = json.loads(ran.stdout)
        assert 'ID["EPSG",3067]]' in said["coordinateSystem"]["wkt"] and said["bands"][0]["noDataValue"] == "NaN"
        corners = numpy.array([said["cornerCoordinates"][name] for name in ("lowerLeft", "upperRight")])
        # The raster covers what the image of the first one covers, of its mesh's 2000 by 1600.
        low, high = shift.target.min(axis=0), shift.target.max(axis=0)
        assert (corners[0] > low).all() and (corners[1] < high).all()
        assert numpy.ptp(corners, axis=0) == pytest.approx([1200, 900], rel=0.2)
    some = numpy.random.default_rng(12).choice(len(rows), 300, replace=False)
    origins = xy(map_points(dhm, ["shift.json"], places[some], "--inverse"))
    found = values[:, rows[some], columns[some]].T + [3384000, 6672000]
    # Up to half a pixel beyond the centers of the border's pixels, these are the values.
    numpy.testing.assert_allclose(found, origins.clip([x[0], y[-1]], [x[-1], y[0]]), atol=2e-3)
    # And back, on the first file's pixels.
    dhm("warp", "--inverse", "shift.json", "out.tif", "-o", "back.tif", "--like", "in.tif")
    with rasterio.open(dhm.path("back.tif")) as file:
        assert file.crs == "EPSG:2393" and file.shape == (90, 120)
        back = numpy.moveaxis(file.read(), 0, 2)
    known = numpy.isfinite(back).all(axis=2)
    assert known.mean() > 0.9
    # Interpolated across the edges of triangles, where the piecewise linear map bends.
    difference = numpy.abs(back[known] - pixels[known])
    assert difference.max() < 10 and numpy.median(difference) < 1e-2


def test_turned_geotiff(dhm, shift):
    """Rows and columns that do not run east and south, in the image or in the result."""
    turned = rasterio.Affine.translation(3384800, 6672700) * rasterio.Affine.rotation(30) * rasterio.Affine.scale(8, -8)
    rows, columns = numpy.mgrid[0:90, 0:110]
    x, y = turned * (columns + 0.5, rows + 0.5)
    pixels = numpy.stack((x - 3384000, y - 6672000)).astype("f4")
    with rasterio.open(dhm.path("in.tif"), "w", driver="GTiff", width=110, height=90, count=2, dtype="float32",
                       crs="EPSG:2393", transform=turned) as file:
        file.write(pixels)
    dhm("warp", "shift.json", "in.tif", "-o", "out.tif")
    with rasterio.open(dhm.path("out.tif")) as file:
        assert file.crs == "EPSG:3067" and file.transform.b == file.transform.d == 0
        values = file.read()
        rows, columns = numpy.nonzero(numpy.isfinite(values[0]))
        places = numpy.column_stack(rasterio.transform.xy(file.transform, rows, columns))
        assert len(rows) * file.transform.a**2 > 0.9 * 110 * 90 * 64
    origins = xy(map_points(dhm, ["shift.json"], places, "--inverse"))
    found = values[:, rows, columns].T + [3384000, 6672000]
    clamped = numpy.clip((~turned * origins.T), [[0.5], [0.5]], [[109.5], [89.5]])
    numpy.testing.assert_allclose(found, numpy.column_stack(turned * clamped), atol=5e-3)
    dhm("warp", "--inverse", "shift.json", "out.tif", "-o", "back.tif", "--like", "in.tif")
    with rasterio.open(dhm.path("back.tif")) as file:
        assert file.crs == "EPSG:2393" and file.transform.almost_equals(turned)
        back = file.read()
    known = numpy.isfinite(back).all(axis=0)
    assert known.mean() > 0.9 and numpy.median(numpy.abs(back - pixels)[:, known]) < 1e-2


def test_turned_domains_keep_the_size_of_pixels(dhm, shift):
    c, s = numpy.cos(0.7), numpy.sin(0.7)
    for factor, expected in ((1.0, 10), (2.0, 20)):
        turned = shift._replace(target=factor * (shift.source - shift.source[0]) @ [[c, s], [-s, c]])
        write_json(dhm.path("turned.json"), turned)
        write_geotiff(dhm.path("in.tif"), numpy.zeros((90, 120, 1), "u1"), 3384400, 6673200, 10, crs=None)
        dhm("warp", "turned.json", "in.tif", "-o", "out.tif", "--force")
        with rasterio.open(dhm.path("out.tif")) as file:
            assert file.transform.a == pytest.approx(expected)


def test_geotiff_alpha_nodata_and_palette(dhm, shift):
    rgb = numpy.random.default_rng(13).integers(1, 256, (60, 80, 3)).astype("u1")
    write_geotiff(dhm.path("rgb.tif"), rgb, 3383500, 6673500, 20)
    dhm("warp", "shift.json", "rgb.tif", "-o", "alpha.tif")
    with rasterio.open(dhm.path("alpha.tif")) as file:
        assert [c.name for c in file.colorinterp] == ["red", "green", "blue", "alpha"]
        assert set(numpy.unique(file.read(4))) == {0, 255}
    dhm("warp", "shift.json", "rgb.tif", "-o", "red.tif", "--background", "#ff0000", "--crs", "EPSG:32635")
    with rasterio.open(dhm.path("red.tif")) as file:
        assert file.count == 3 and file.crs == "EPSG:32635"
    heights = numpy.full((60, 80, 1), 100, "i2")
    heights[20:25, 30:40] = -9999
    write_geotiff(dhm.path("nodata.tif"), heights, 3384100, 6673300, 10, nodata=-9999)
    # Means of several pixels are known if all of them are.
    for options in ((), ("--resolution", "30")):
        dhm("warp", "shift.json", "nodata.tif", "-o", "nodata-out.tif", "--force", *options)
        with rasterio.open(dhm.path("nodata-out.tif")) as file:
            assert file.nodata == -9999 and set(numpy.unique(file.read(1))) == {-9999, 100}
    index = (numpy.arange(4800).reshape(60, 80, 1) % 2).astype("u1")
    write_geotiff(dhm.path("palette.tif"), index, 3384100, 6673300, 10, photometric="palette")
    with rasterio.open(dhm.path("palette.tif"), "r+") as file:
        file.write_colormap(1, {0: (250, 0, 0), 1: (250, 200, 0)})
    dhm("warp", "shift.json", "palette.tif", "-o", "palette-out.tif")
    with rasterio.open(dhm.path("palette-out.tif")) as file:
        r, g, b, a = file.read()
        assert (r[a > 0] == 250).all() and (b == 0).all()


@pytest.fixture
def same(dhm):
    """The identity of 800 by 600 m, for rasters of 80 by 60 pixels."""
    corners, triangles = make_grid(1, 1, 800, 600)
    points = corners + [3384100, 6672700]
    write_json(dhm.path("same.json"), Pair(points, points, triangles), input_crs="EPSG:2393", output_crs="EPSG:2393")
    return lambda pixels, **options: write_geotiff(dhm.path("in.tif"), pixels, 3384100, 6673300, 10, **options)


def test_no_data_of_colors_and_of_bands(dhm, same):
    """A color is no data if all of its parts are; other bands have gaps of their own."""
    pixels = numpy.random.default_rng(3).integers(1, 256, (60, 80, 3)).astype("u1")
    pixels[10, 20], pixels[30:33, 40:44] = [255, 0, 0], 0
    for kind, options in (("u1", {"photometric": "rgb"}), ("i2", {}), ("f4", {})):
        same(pixels.astype(kind), nodata=0, **options)
        dhm("warp", "same.json", "in.tif", "-o", "out.tif", "--force")
        with rasterio.open(dhm.path("out.tif")) as file:
            assert file.nodata == 0
            numpy.testing.assert_array_equal(numpy.moveaxis(file.read(), 0, 2), pixels)
        # Means of 3 by 3 pixels.
        dhm("warp", "same.json", "in.tif", "-o", "out.tif", "--force", "--resolution", "30")
        with rasterio.open(dhm.path("out.tif")) as file:
            missing = (file.read() == 0).sum(axis=(1, 2))
        whole = (missing == missing[0]).all()
        assert missing.min() >= 2 and whole == (kind == "u1")


def test_no_data_leaves_no_trace(dhm, shift):
    """However large its value is, and if pixels fall on pixels, up to rounding."""
    values = numpy.random.default_rng(3).random((60, 80, 1)).astype("f4")
    for nodata in (-3.4028234663852886e38, numpy.nan, numpy.inf):
        values[20:30, 20:30] = values[40, ::2] = nodata
        write_geotiff(dhm.path("in.tif"), values, 3384100.3, 6673300.7, 3, nodata=nodata)
        corners, triangles = make_grid(1, 1, 3000, 3000)
        source = corners + [3383000, 6672100]
        for move in ([-3000000, -14.1], [0, 0]):
            write_json(dhm.path("moved.json"), Pair(source, source + move, triangles))
            dhm("warp", "moved.json", "in.tif", "-o", "out.tif", "--force")
            with rasterio.open(dhm.path("out.tif")) as file:
                found, known = file.read(1), file.dataset_mask() > 0
            assert known.sum() > 4000 and (0 <= found[known]).all() and (found[known] <= 1).all()


@pytest.mark.parametrize("shape", [(1, 1, 1), (1, 9, 1), (9, 1, 1)])
def test_single_rows_and_columns(dhm, shift, shape):
    write_geotiff(dhm.path("in.tif"), numpy.full(shape, 7, "u1"), 3384800, 6672900, 10)
    for options in ((), ("--size", "8x6"), ("--size", "1x1"), ("--resolution", "3"), ("--resolution", "90")):
        for more in ((), ("--nearest",)):
            dhm("warp", "shift.json", "in.tif", "-o", "out.tif", "--force", *options, *more)
            with rasterio.open(dhm.path("out.tif")) as file:
                values, alpha = file.read()
            assert (values[alpha > 0] == 7).all() and ((alpha > 0).any() or options[-1:] == ("1x1",))
            assert options[:1] != ("--size",) or f"{file.width}x{file.height}" == options[1]


def test_no_data_that_pixels_cannot_have(dhm, same):
    pixels = numpy.random.default_rng(3).integers(1, 256, (60, 80, 1)).astype("u1")
    tifffile = pytest.importorskip("tifffile")
    for value in ("-9999", "256", "0.5", "nan", "inf"):
        tifffile.imwrite(dhm.path("odd.tif"), pixels[:, :, 0], extratags=[
            (42113, "s", 0, value, True), (33550, "d", 3, (10.0, 10.0, 0.0), True),
            (33922, "d", 6, (0.0, 0.0, 0.0, 3384100.0, 6673300.0, 0.0), True)])
        dhm("warp", "same.json", "odd.tif", "-o", "out.tif", "--force")
        with rasterio.open(dhm.path("out.tif")) as file:
            numpy.testing.assert_array_equal(file.read(1), pixels[:, :, 0])


def test_masks_of_geotiff(dhm, same):
    pixels = numpy.random.default_rng(3).integers(0, 256, (60, 80, 3)).astype("u1")
    mask = numpy.random.default_rng(4).random((60, 80)) > 0.3
    for kind in ("u1", "f4"):
        with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=True):
            same(pixels.astype(kind))
            with rasterio.open(dhm.path("in.tif"), "r+") as file:
                file.write_mask(mask)
        dhm("warp", "same.json", "in.tif", "-o", "out.tif", "--force")
        with rasterio.open(dhm.path("out.tif")) as file:
            values, found = numpy.moveaxis(file.read(), 0, 2), file.dataset_mask() > 0
        numpy.testing.assert_array_equal(found, mask)
        numpy.testing.assert_array_equal(values[mask][:, :3], pixels[mask])
        dhm("warp", "same.json", "in.tif", "-o", "out.tif", "--force", "--resolution", "30")
        with rasterio.open(dhm.path("out.tif")) as file:
            few = file.dataset_mask() > 0
        squares = mask[:60, :78].reshape(20, 3, 26, 3).all(axis=(1, 3))
        assert abs(few.mean() - squares.mean()) < 0.05


def test_metadata_of_bands_stays(dhm, same):
    heights = numpy.random.default_rng(5).integers(0, 3000, (60, 80, 2)).astype("i2")
    same(heights, nodata=-1)
    with rasterio.open(dhm.path("in.tif"), "r+") as file:
        file.scales, file.offsets, file.units = (0.1, 2.0), (50.0, 0.0), ("m", "K")
        file.descriptions = ("height", "temperature")
        file.update_tags(AUTHOR="Ä. Surveyor")
        file.update_tags(1, NOTE="of the roofs", STATISTICS_MEAN="7")
    dhm("warp", "same.json", "in.tif", "-o", "out.tif", "--resolution", "30")
    with rasterio.open(dhm.path("out.tif")) as file:
        assert file.scales == (0.1, 2.0) and file.offsets == (50.0, 0.0) and file.units == ("m", "K")
        assert file.descriptions == ("height", "temperature")
        # Statistics are not those of other pixels.
        assert file.tags()["AUTHOR"] == "Ä. Surveyor" and file.tags(1) == {"NOTE": "of the roofs"}


def test_classes_are_not_mixed(dhm, shift):
    """With --nearest, each value is that of the pixel in whose area the preimage is."""
    index = numpy.random.default_rng(6).choice(numpy.array([1, 7, 200], "u1"), (90, 120, 1))
    colors = {1: (0, 0, 200, 255), 7: (250, 0, 0, 255), 200: (0, 99, 0, 255)}
    for name, options in (("palette.tif", {"photometric": "palette"}), ("gray.tif", {}), ("gaps.tif", {"nodata": 7})):
        write_geotiff(dhm.path(name), index, 3384400, 6673200, 10, **options)
        if name == "palette.tif":
            with rasterio.open(dhm.path(name), "r+") as file:
                file.write_colormap(1, colors)
        for resolution in ("7", "35"):
            dhm("warp", "--nearest", "shift.json", name, "-o", "out.tif", "-f", "--resolution", resolution)
            with rasterio.open(dhm.path("out.tif")) as file:
                values, known = file.read(1), file.dataset_mask() > 0
                places = numpy.column_stack(rasterio.transform.xy(file.transform, *numpy.nonzero(known)))
                assert file.count == (2 if name == "gray.tif" else 1)
                assert name != "palette.tif" or {k: file.colormap(1)[k] for k in colors} == colors
            origins = xy(map_points(dhm, ["shift.json"], places, "--inverse"))
            columns, rows = ((origins - [3384400, 6673200]) / [10, -10]).T
            # Not where rounding decides.
            clear = (numpy.abs((columns % 1) - 0.5) < 0.499) & (numpy.abs((rows % 1) - 0.5) < 0.499)
            expected = index[rows[clear].astype(int), columns[clear].astype(int), 0]
            numpy.testing.assert_array_equal(values[known][clear], expected)
            assert clear.sum() > 0.5 * 120 * 90 * (10 / float(resolution)) ** 2 and 1 in expected
            assert (7 in expected) == (name != "gaps.tif")
    dhm("warp", "--nearest", "shift.json", "palette.tif", "-o", "rgb.tif", "--background", "white")
    with rasterio.open(dhm.path("rgb.tif")) as file:
        found = set(map(tuple, file.read().reshape(3, -1).T.tolist()))
    assert file.count == 3 and found == {(255, 255, 255), *(color[:3] for color in colors.values())}


def test_palettes_with_no_data_become_transparent(dhm, same):
    index = numpy.random.default_rng(6).integers(0, 3, (60, 80, 1)).astype("u1")
    same(index, photometric="palette", nodata=1)
    colors = numpy.array([[0, 0, 0], [255, 0, 0], [250, 200, 0]])
    with rasterio.open(dhm.path("in.tif"), "r+") as file:
        file.write_colormap(1, {k: tuple(color) for k, color in enumerate(colors.tolist())})
    dhm("warp", "same.json", "in.tif", "-o", "out.tif")
    with rasterio.open(dhm.path("out.tif")) as file:
        assert [kind.name for kind in file.colorinterp] == ["red", "green", "blue", "alpha"] and file.nodata is None
        out, known = numpy.moveaxis(file.read(), 0, 2), index[:, :, 0] != 1
    numpy.testing.assert_array_equal(out[:, :, 3], numpy.where(known, 255, 0))
    numpy.testing.assert_array_equal(out[known, :3], colors[index[:, :, 0]][known])


def test_other_coordinate_reference_systems(dhm, shift):
    rgb = numpy.zeros((20, 20, 3), "u1")
    write_geotiff(dhm.path("rgb.tif"), rgb, 3384500, 6673000, 10)
    words = ("warp", "shift.json", "rgb.tif", "-o")
    write_geotiff(dhm.path("like.tif"), rgb, 384500, 6670000, 10, crs="EPSG:32635")
    dhm.refuse(REFUSED, *words, "new.tif", "--like", "like.tif", says=("like.tif", "EPSG:32635", "EPSG:3067"))
    dhm(*words, "like-out.tif", "--like", "like.tif", "--crs", "EPSG:32635")
    Image.fromarray(rgb).save(dhm.path("plain.tif"))
    dhm.refuse(USAGE, *words, "new.tif", "--like", "plain.tif", says=("plain.tif", "--like"))
    assert "not converted" in dhm(*words, "other.tif", "--crs", "EPSG:4326").err
    assert "not converted" not in dhm(*words, "own.tif", "--crs", "epsg:3067").err


def test_geotiff_refusals(dhm, shift):
    rgb = numpy.zeros((20, 20, 3), "u1")
    write_geotiff(dhm.path("rgb.tif"), rgb, 3384500, 6673000, 10)
    dhm.refuse(USAGE, "warp", "shift.json", "rgb.tif", "-o", "new.png", says=".tif")
    dhm.refuse(USAGE, "warp", "shift.json", "rgb.tif", "-o", "new.tif", "--crs", "EPSG:0", says="EPSG:0")
    dhm.refuse(USAGE, "warp", "shift.json", "rgb.tif", "-o", "new.tif", "--size", "70000x70000", says="2^32")
    for tiny in ("1e-3", "1e-9", "1e-320"):
        dhm.refuse(USAGE, "warp", "shift.json", "rgb.tif", "-o", "new.tif", "--resolution", tiny, says="--resolution")
    write_geotiff(dhm.path("other.tif"), rgb, 3384500, 6673000, 10, crs="EPSG:3067")
    dhm.refuse(REFUSED, "warp", "shift.json", "other.tif", "-o", "new.tif", says=("EPSG:3067", "EPSG:2393"))
    write_geotiff(dhm.path("complex.tif"), rgb.astype("c8"), 3384500, 6673000, 10)
    dhm.refuse(FILE, "warp", "shift.json", "complex.tif", "-o", "new.tif", says=("complex.tif", "complex numbers"))
    write_geotiff(dhm.path("away.tif"), rgb, 0, 0, 10)
    dhm.refuse(REFUSED, "warp", "shift.json", "away.tif", "-o", "new.tif", says="do not overlap")
