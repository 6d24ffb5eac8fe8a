# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm with landmarks: the pairs made from them, and the georeferencing of a generated scan with a known map, with
GDAL's programs as independent readers."""

import json
import os
import re
import shutil
import subprocess
import sys

import numpy
import pytest
from conftest import FILE, REFUSED, USAGE
from pairs import ROOT, doubled_areas, read_csv, read_json, write_csv, xy

sys.path.insert(0, str(ROOT / "Examples" / "Georeferencing"))
import scan as generated  # noqa: E402

# The full size, 4000x3000, takes minutes; lengths in pixels are those of the full size.
WIDTH, HEIGHT = map(int, os.environ.get("DHM_SCAN_SIZE", "1000x750").split("x"))


def landmarks(count=40, size=(40, 30), move=1.0, seed=5):
    """Points of an image in pixels, y down, and moved ones."""
    source = numpy.random.default_rng(seed).uniform(0.1, 0.9, (count, 2)) * size
    return source, source + move * numpy.sin(source[:, ::-1] / 6)


def write_landmarks(path, source, target, names=None):
    rows = [",".join([name, *map(repr, row)]) for name, row in
            zip(names or map(str, range(len(source))), numpy.hstack((source, target)).tolist())]
    path.write_text("id,source_x,source_y,target_x,target_y\n" + "\n".join(rows) + "\n")


def assert_valid(pair):
    assert (doubled_areas(pair.source, pair.triangles) > 0).all()
    areas = doubled_areas(pair.target, pair.triangles)
    # The figures may be mirror images.
    assert (areas > 0).all() or (areas < 0).all()


def test_a_pair_is_made_and_described(dhm):
    source, target = landmarks()
    inner = int(numpy.hypot(*(source - [20, 15]).T).argmin())
    target[inner] += [5, 4]
    write_landmarks(dhm.path("marks.csv"), source, target, [f"m{i}" for i in range(40)])
    result = dhm("triangulate", "marks.csv", "-o", "pair.json", "--report")
    pair, _ = read_json(dhm.path("pair.json"))
    numpy.testing.assert_array_equal(pair.source[:40], source)
    numpy.testing.assert_array_equal(pair.target[:40], target)
    assert_valid(pair)
    report = result.out.decode()
    assert re.search(rf"largest residuals, target's units\n +m{inner} .* suspicious", report)
    assert f"triangles                        {len(pair.triangles)}" in report
    assert "suspicious landmarks" in result.err and f"m{inner} (" in result.err
    assert "1 landmark left out: m7 (on request)" in dhm("check", "marks.csv", "--quick", "--without", "m7").err
    dhm.refuse(FILE, "check", "marks.csv", "--without", "m70", says="m70")


@pytest.mark.parametrize("rows, says", [
    ("source_x;source_y;target_x;target_y\n0;0;0;0\n1;0;1;0\n0;1;0;1\n", "3 landmarks"),
    ("source_x;source_y;target_x;target_y\n0;0;0,5;0\n", "'0,5', not a number (write 0.5"),
    ("Name;Rechtswert;Hochwert;x;y\na;1;2;3;4\n", "need the columns source_x"),
    ("id,source_x,source_y,target_x,target_y\na,0,0,0,0\nb,1,0,1,0\nc,0,1,0,1\nd,,,,\n", "left out: d (no position"),
    ("id,source_x,source_y,target_x,target_y\na,0,0,0,0\na,1,0,1,0\nc,0,1,0,1\nd,1,1,,\n", "same id: a."),
    ("source_x,source_y,target_x,target_y\n0,0,0,0\n", "1 usable landmark;"),
])
def test_tables_are_read_or_the_columns_named(dhm, rows, says):
    dhm.path("marks.csv").write_text(rows)
    without = ("--without", "d") if "\nd," in rows else ()
    assert says in dhm("check", "--quick", "marks.csv", *without, status={0, FILE}).err


def test_landmarks_are_called_by_their_lines_as_in_errors(dhm):
    source, target = landmarks()
    target[17] += [5, 4]
    rows = [",".join(map(repr, row)) for row in numpy.hstack((source, target)).tolist()]
    dhm.path("marks.csv").write_text("\n".join(["source_x,source_y,target_x,target_y", "", *rows]) + "\n")
    said = dhm("check", "marks.csv", "--quick").err
    assert re.search(r"neighbors: 20 \(.*ids \(line numbers", said)
    assert "left out: 20 (on request)" in dhm("check", "marks.csv", "--quick", "--without", "20").err
    dhm.path("marks.csv").write_text(dhm.path("marks.csv").read_text().replace(rows[17], rows[17] + ",7"))
    dhm.refuse(FILE, "check", "marks.csv", says="line 20")


def test_tables_of_two_columns_are_told_what_landmarks_need(dhm):
    dhm.path("two.csv").write_text("x,y\n1,2\n")
    write_csv(dhm.path("p.csv"), [[1, 2]])
    for command in (["check", "two.csv"], ["triangulate", "two.csv", "-o", "new.vtp"],
                    ["map", "two.csv", "p.csv", "-o", "new.csv"]):
        dhm.refuse(USAGE, *command, says=("two.csv", "source_x", "target_y"))


def test_landmarks_of_thin_triangles_name_the_system_that_is_fast(dhm):
    random = numpy.random.default_rng(30)
    write_landmarks(dhm.path("marks.csv"), random.random((100, 2)), random.random((100, 2)))
    assert "--system smooth" in dhm("triangulate", "marks.csv", "-o", "pair.vtp").err
    write_landmarks(dhm.path("marks.csv"), *landmarks())
    assert "--system smooth" not in dhm("triangulate", "marks.csv", "-o", "pair.vtp", "-f").err


def test_landmarks_are_a_pair_for_every_command(dhm):
    source, target = landmarks()
    write_landmarks(dhm.path("marks.csv"), source, target)
    write_csv(dhm.path("points.csv"), source)
    assert json.loads(dhm("check", "--json", "marks.csv").out)["valid"]
    dhm("map", "marks.csv", "points.csv", "-o", "there.csv")
    numpy.testing.assert_allclose(xy(read_csv(dhm.path("there.csv").read_text())), target, rtol=0, atol=1e-12)
    dhm("map", "--inverse", "marks.csv", "there.csv", "-o", "back.csv")
    numpy.testing.assert_allclose(xy(read_csv(dhm.path("back.csv").read_text())), source, rtol=0, atol=1e-12)
    dhm("figure", "marks.csv", "-o", "figure.png")
    dhm("morph", "marks.csv", "-n", "3", "-o", "frame-%d.vtp")
    dhm("convert", "marks.csv", "-o", "pair.vtp")
    said = dhm("check", "pair.vtp", "--quick").err
    assert "made" not in said


@pytest.mark.parametrize("form", ["csv", "bigwarp", "points"])
def test_landmarks_of_images_have_y_down(dhm, form):
    """A landmark's pixel arrives at its target; other formats put 0 at the edge of the image or half a pixel inside."""
    Image = pytest.importorskip("PIL.Image")
    pixels = numpy.zeros((30, 40), numpy.uint8)
    pixels[4, 30] = 200
    Image.fromarray(pixels).save(dhm.path("image.png"))
    # Centers of pixels, from the upper left corner of the image.
    centers = numpy.array([[30.5, 4.5], [5.5, 5.5], [20.5, 20.5], [8.5, 25.5]])
    moved = centers + [[-3, 2], [0, 0], [0, 0], [0, 0]]
    if form == "bigwarp":
        rows = numpy.hstack((centers, moved)) - 0.5
        text = "".join(f'"Pt-{k}","true",' + ",".join(f'"{v}"' for v in row) + "\n" for k, row in enumerate(rows))
        dhm.path("marks.csv").write_text(text)
    elif form == "points":
        text = "mapX,mapY,pixelX,pixelY,enable\n"
        text += "".join(f"{x},{y},{u},{-v},1\n" for (u, v), (x, y) in zip(centers, moved))
        dhm.path("marks.points").write_text(text)
        dhm.refuse(USAGE, "warp", "marks.points", "image.png", "-o", "out.png", says="--crs")
        pytest.importorskip("rasterio")
        dhm.path("marks.points").write_text('#CRS: PROJCRS["x\n' + text)
        refusal = dhm.refuse(USAGE, "warp", "marks.points", "image.png", "-o", "out.tif", says="PROJCRS")
        assert "was used as" not in refusal.err
        said = dhm("warp", "marks.points", "image.png", "-o", "out.tif", "--crs", "EPSG:3857").err
        assert "#CRS: PROJCRS" in said and "EPSG:3857 (--crs) is used" in said
        return
    else:
        write_landmarks(dhm.path("marks.csv"), centers, moved)
    dhm("warp", "marks.csv", "image.png", "-o", "out.png", "-s", "linear")
    out = numpy.asarray(Image.open(dhm.path("out.png")))
    assert out.shape == (30, 40, 2) and (out[:, :, 1] == 255).all()
    assert out[6, 27, 0] == 200
    dhm("warp", "--inverse", "marks.csv", "out.png", "-o", "back.png", "-s", "linear")
    assert numpy.asarray(Image.open(dhm.path("back.png")))[4, 30, 0] == 200
    dhm("morph", "marks.csv", "--source-image", "image.png", "-n", "3", "-s", "linear", "-o", "frame-%d.png")
    assert numpy.asarray(Image.open(dhm.path("frame-2.png")))[6, 27, 0] == 200
    dhm("figure", "marks.csv", "--image", "image.png", "-o", "figure.png")


def test_landmarks_close_to_a_border_make_no_slivers(dhm):
    """On a border of one image and beside it in the other; on both borders, they are the domain's."""
    Image = pytest.importorskip("PIL.Image")
    Image.fromarray(numpy.zeros((60, 80), numpy.uint8)).save(dhm.path("image.png"))
    source, target = landmarks(60, (80, 60))
    rim = numpy.array([[0.5, y] for y in numpy.arange(0.5, 60, 5.9)] + [[79.5, y] for y in numpy.arange(0.5, 60, 5.9)])
    smallest = []
    for gap in (0.0, 1.5):
        moved = rim + [gap, 0] * (rim[:, :1] < 1)
        write_landmarks(dhm.path("marks.csv"), numpy.vstack((source, rim)), numpy.vstack((target, moved)))
        dhm("triangulate", "marks.csv", "--scan", "image.png", "--scan", "image.png", "-o", "pair.json", "--force")
        pair, _ = read_json(dhm.path("pair.json"))
        assert_valid(pair)
        assert (numpy.ptp(pair.source, axis=0) == [79, 59]).all() == (gap == 0)
        corners = pair.target[pair.triangles]
        u, v = (numpy.roll(corners, -k, axis=1) - corners for k in (1, 2))
        angles = numpy.arccos((u * v).sum(axis=2) / numpy.hypot(*u.T).T / numpy.hypot(*v.T).T)
        smallest.append(angles.min())
    assert smallest[1] > 0.8 * smallest[0]


@pytest.mark.parametrize("gap", [0, 2])
def test_morphs_between_landmarks_on_corners_have_no_gaps(dhm, gap):
    Image = pytest.importorskip("PIL.Image")
    pixels = numpy.random.default_rng(2).integers(0, 256, (2, 60, 80, 3)).astype("u1")
    for side in (0, 1):
        Image.fromarray(pixels[side]).save(dhm.path(f"{side}.png"))
    source, target = landmarks(12, (80, 60), 3)
    corners = numpy.array([[gap, gap], [79 - gap, gap], [gap, 59 - gap], [79 - gap, 59 - gap]])
    write_landmarks(dhm.path("marks.csv"), numpy.vstack((source, corners)), numpy.vstack((target, corners)))
    dhm("morph", "marks.csv", "--scan", "0.png", "--scan", "1.png", "--source-image", "0.png",
        "--target-image", "1.png", "-n", "3", "-o", "f%d.png")
    frames = [numpy.asarray(Image.open(dhm.path(f"f{k}.png"))) for k in range(3)]
    for side in (0, 1):
        numpy.testing.assert_array_equal(frames[2 * side][:, :, :3], pixels[side])
    assert all((frame[:, :, 3] == 255).all() for frame in frames)


def test_outlines_lines_and_figures(dhm):
    square = numpy.array([[0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [3, 1], [2, 3]], float)
    write_landmarks(dhm.path("marks.csv"), square, square * [2, 1], list("abcdefg"))
    dhm.path("outline.txt").write_text("a b c d\n")
    dhm.path("lines.txt").write_text("e,f\nf g\n")
    dhm("triangulate", "marks.csv", "--outlines", "outline.txt", "--lines", "lines.txt", "-o", "pair.json")
    pair, _ = read_json(dhm.path("pair.json"))
    assert_valid(pair)
    assert doubled_areas(pair.target, pair.triangles).sum() == 64
    edges = {tuple(sorted(t[[k, (k + 1) % 3]])) for t in pair.triangles for k in range(3)}
    assert {(4, 5), (5, 6)} <= edges
    # The same as VTK's files.
    for name, points in (("s.vtk", square), ("t.vtk", square * [2, 1])):
        rows = "\n".join(" ".join(map(str, (*p, 0))) for p in points)
        dhm.path(name).write_text(
            f"# vtk DataFile Version 3.0\nfigure\nASCII\nDATASET POLYDATA\nPOINTS 7 double\n{rows}\n"
            "LINES 2 6\n2 4 5\n2 5 6\nPOLYGONS 1 5\n4 0 1 2 3\n"
        )
    dhm("triangulate", "s.vtk", "t.vtk", "-o", "figures.json")
    assert dhm.path("figures.json").read_text() == dhm.path("pair.json").read_text()
    # The loop as lines.
    for name in ("s.vtk", "t.vtk"):
        text = dhm.path(name).read_text()
        lines = text.replace("LINES 2 6\n2 4 5\n2 5 6\nPOLYGONS 1 5\n4 0 1 2 3", "LINES 2 8\n3 0 1 2\n3 2 3 0")
        dhm.path("lines-" + name).write_text(lines)
    dhm("triangulate", "lines-s.vtk", "lines-t.vtk", "-o", "lines.json")
    lines, _ = read_json(dhm.path("lines.json"))
    assert len(lines.source) == 7 and doubled_areas(lines.target, lines.triangles).sum() == 64
    dhm.path("t.vtk").write_text(dhm.path("t.vtk").read_text().replace("2 5 6", "2 4 6"))
    dhm.refuse(REFUSED, "triangulate", "s.vtk", "t.vtk", "-o", "other.json", says="same cells")


def test_conflicts_and_necessary_points_are_named(dhm):
    source = numpy.array([[0, 0], [1, 0], [0.4, 1], [0.5, -1]])
    target = numpy.array([[0, 0], [1, 0], [0.4, 1], [2, 1]])
    write_landmarks(dhm.path("marks.csv"), source, target)
    dhm.path("lines.txt").write_text("0 1\n2 3\n")
    words = ("triangulate", "marks.csv", "--lines", "lines.txt", "-o", "pair.json")
    dhm.refuse(REFUSED, *words, says=("marks.csv", "cross"))
    write_landmarks(dhm.path("twice.csv"), *2 * [source[[0, 1, 2, 3, 1]]], ["a", "b", "c", "d", "e"])
    dhm.refuse(REFUSED, "triangulate", "twice.csv", "--without", "a", "-o", "new.json", says=": b, e.")
    dhm.refuse(USAGE, "triangulate", "twice.csv", "--domain", "outline", "-o", "new.json", says="no outlines")
    dhm.refuse(USAGE, "triangulate", "twice.csv", "--target-angle", "61", "-o", "new.json", says="--target-angle")
    write_landmarks(dhm.path("narrow.csv"), *2 * [[[0, 0], [1, 0], [1, 0.01], [0, 1]]])
    narrow = dhm("triangulate", "narrow.csv", "--target-angle", "50", "--maximum-added-points", "1",
                 "-o", "narrow.json")
    assert "less than --target-angle 50" in narrow.err
    assert "line 1 is left out" in dhm(*words, "--leave-out-conflicts").err
    # Landmarks that change places on a line, between others: not without a point.
    random = numpy.random.default_rng(2)
    write_landmarks(dhm.path("mixed.csv"), random.random((8, 2)), random.random((8, 2)))
    dhm.refuse(REFUSED, "triangulate", "mixed.csv", "--maximum-added-points", "0", "-o", "mixed.json", says="mixed.csv")
    assert not re.search("with 0 added", dhm("triangulate", "mixed.csv", "-o", "mixed.json").err)
    assert_valid(read_json(dhm.path("mixed.json"))[0])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    pytest.importorskip("rasterio")
    pytest.importorskip("geopandas")
    folder = tmp_path_factory.mktemp("scan")
    generated.write(folder, WIDTH, HEIGHT)
    return folder


@pytest.fixture
def scan(dhm, folder):
    for file in folder.iterdir():
        shutil.copy(file, dhm.path(file.name))
    return generated.Sheet(WIDTH, HEIGHT)


def gdal(*words):
    return subprocess.run(words, stdout=subprocess.PIPE, check=True).stdout.decode()


def test_the_scan_is_bent_as_stated(scan):
    share = scan.bend_beyond_affine() / (WIDTH / 4000)
    assert 20 <= share <= 40
    pixels = scan.pixel_centers()[::97]
    numpy.testing.assert_allclose(scan.to_pixels(scan.to_ground(pixels)), pixels, rtol=0, atol=1e-6)


@pytest.mark.parametrize("points", ["control.points", "control-2.points"])
def test_mistyped_control_points_are_the_first_of_the_list(dhm, scan, points):
    version = 2 if points == "control-2.points" else 3
    wrong = generated.names_of_mistyped(version)
    said = dhm("check", points, "--quick").err
    # By their lines in the file, like errors.
    lines = dhm.path(points).read_text().splitlines()
    disabled = re.search(r"4 landmarks left out: (.*)\.", said)[1].split(", ")
    assert all(name.endswith(" (disabled)") and lines[int(name.split()[0]) - 1].split(",")[4] == "0"
               for name in disabled)
    listed = re.findall(r"(\d+) \([0-9.e+]+\)", said.split("neighbors:")[1])
    assert sorted(listed[:2]) == sorted(wrong)


@pytest.mark.parametrize("points, crs", [("control.points", ()), ("control-2.points", ("--crs", "EPSG:3857"))])
def test_a_scan_is_georeferenced(dhm, scan, points, crs):
    wrong = ",".join(generated.names_of_mistyped(2 if points == "control-2.points" else 3))
    words = ("warp", "positions.tif", points, *crs, "-o", "rectified.tif")
    dhm(*words, "--without", wrong)
    errors = generated.errors(scan, dhm.path("rectified.tif"))
    assert (errors <= WIDTH / 4000).mean() >= 0.95
    dhm(*words, "--force")
    assert (generated.errors(scan, dhm.path("rectified.tif")) <= WIDTH / 4000).mean() < 0.95
    if not shutil.which("gdalinfo"):
        return
    dhm("warp", "scan.tif", points, *crs, "--without", wrong, "--resolution", "8", "-o", "map.tif")
    found = json.loads(gdal("gdalinfo", "-json", str(dhm.path("map.tif"))))
    assert 'ID["EPSG",3857]]' in found["coordinateSystem"]["wkt"]
    transform = found["geoTransform"]
    assert transform[1] == 8 and transform[5] == -8 and transform[2] == transform[4] == 0
    u, v = numpy.linspace(0, WIDTH, 200), numpy.linspace(0, HEIGHT, 200)
    rim = numpy.vstack([numpy.column_stack(numpy.broadcast_arrays(u, y)) for y in (0, HEIGHT)] +
                       [numpy.column_stack(numpy.broadcast_arrays(x, v)) for x in (0, WIDTH)])
    ground = scan.to_ground(rim)
    corners = found["cornerCoordinates"]
    bounds = numpy.array([corners["lowerLeft"], corners["upperRight"]])
    assert numpy.abs(bounds - [ground.min(axis=0), ground.max(axis=0)]).max() < 16
    assert [band["colorInterpretation"] for band in found["bands"]] == ["Red", "Green", "Blue", "Alpha"]
    # Transparent outside of the sheet, which is turned, opaque in its middle.
    middle = gdal("gdallocationinfo", "-valonly", "-geoloc", "-b", "4", str(dhm.path("map.tif")),
                  *map(repr, scan.to_ground([scan.size / 2])[0].tolist()))
    corner = gdal("gdallocationinfo", "-valonly", "-b", "4", str(dhm.path("map.tif")), "0", "0")
    assert (middle.strip(), corner.strip()) == ("255", "0")


def test_layers_go_onto_the_scan_and_back(dhm, scan):
    geopandas = pytest.importorskip("geopandas")
    more = ("control.points", "--scan", "scan.tif", "--without", ",".join(generated.names_of_mistyped()))
    dhm("map", "--inverse", "roads.gpkg", *more, "-o", "on-scan.gpkg")
    dhm("map", "on-scan.gpkg", *more, "-o", "back.gpkg")
    roads, on_scan, back = (geopandas.read_file(dhm.path(n)) for n in ("roads.gpkg", "on-scan.gpkg", "back.gpkg"))
    assert back.crs == roads.crs and on_scan.crs != roads.crs
    extent = numpy.ptp(numpy.reshape(roads.total_bounds, (2, 2)), axis=0).max()
    for before, there, after in zip(roads.geometry, on_scan.geometry, back.geometry):
        coordinates = numpy.array(before.coords)
        numpy.testing.assert_allclose(after.coords, coordinates, rtol=0, atol=1e-9 * extent)
        # As QGIS shows the scan: y upwards from 0 at the upper edge.
        found = numpy.array(there.coords) * [1, -1]
        assert numpy.abs(found - scan.to_pixels(coordinates)).max() < 1
    if shutil.which("ogrinfo"):
        assert 'ID["EPSG",3857]]' in gdal("ogrinfo", "-so", str(dhm.path("back.gpkg")), "roads")
        assert "3857" not in gdal("ogrinfo", "-so", str(dhm.path("on-scan.gpkg")), "roads")


def test_rasters_go_back_onto_the_scan(dhm, scan):
    import rasterio

    more = ("control.points", "--without", ",".join(generated.names_of_mistyped()))
    dhm("warp", "positions.tif", *more, "-o", "map.tif")
    dhm("warp", "--inverse", "map.tif", *more, "--scan", "scan.tif", "-o", "back.tif", "--background", "black")
    with rasterio.open(dhm.path("back.tif")) as file:
        assert (file.width, file.height) == (WIDTH, HEIGHT) and not file.crs
        found = file.read()[:2].reshape(2, -1).T
    truth = scan.pixel_centers()
    inner = ((truth > 3) & (truth < scan.size - 3)).all(axis=1)
    assert numpy.abs(found[inner] - truth[inner]).max() < 0.01
    dhm.refuse(USAGE, "warp", "--inverse", "map.tif", *more, "--scan", "scan.tif", "--like", "map.tif", "-o", "no.tif",
               says="--like")


def test_annotations_are_taken_to_another_crs(dhm, folder, scan):
    """IIIF's longitudes and latitudes, for a result in Web Mercator."""
    pixels, ground = scan.control_points()
    radius = 6378137.0
    degrees = numpy.degrees(numpy.column_stack(
        (ground[:, 0] / radius, 2 * numpy.arctan(numpy.exp(ground[:, 1] / radius)) - numpy.pi / 2)))
    features = [{"type": "Feature", "id": str(k), "properties": {"resourceCoords": p.tolist()},
                 "geometry": {"type": "Point", "coordinates": d.tolist()}}
                for k, (p, d) in enumerate(zip(pixels, degrees)) if k not in generated.MISTYPED]
    annotation = {"type": "Annotation", "body": {"type": "FeatureCollection", "features": features}}
    dhm.path("map.json").write_text(json.dumps(annotation))
    dhm("warp", "positions.tif", "map.json", "--crs", "EPSG:3857", "-o", "rectified.tif")
    assert (generated.errors(scan, dhm.path("rectified.tif")) <= WIDTH / 4000).mean() >= 0.95
