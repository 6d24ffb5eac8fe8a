# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm check, morph, figure and refine."""

import json
import shutil
import subprocess
import xml.etree.ElementTree

import numpy
import pytest
from conftest import REFUSED, USAGE
from pairs import Pair, doubled_areas, edges_of, inside_points, make_grid, make_pair, map_points, read_json, \
    write_csv, write_json, write_mesh, xy

Image = pytest.importorskip("PIL.Image")
meshio = pytest.importorskip("meshio")


def check(dhm, pair, *options, status=0):
    write_json(dhm.path("pair.json"), pair)
    return json.loads(dhm("check", "--json", *options, "pair.json", status=status).out)


def test_a_valid_pair(dhm):
    pair = make_pair(6, 5)
    report = check(dhm, pair)
    assert report["valid"] and report["problems"] == [] and report["invalid_triangles"] == []
    counts = list(edges_of(pair.triangles).values())
    assert (report["interior_edges"], report["boundary_edges"]) == (counts.count(2), counts.count(1))
    assert (report["components"], report["boundary_loops"], report["mirrored"]) == (1, 1, False)
    corners = pair.target[pair.triangles]
    u, v = (numpy.roll(corners, -k, axis=1) - corners for k in (1, 2))
    lengths = [numpy.linalg.norm(sides, axis=2) for sides in (u, v)]
    angles = numpy.degrees(numpy.arccos((u * v).sum(axis=2) / lengths[0] / lengths[1]))
    assert report["target"]["smallest_angle"]["value"] == pytest.approx(angles.min())
    assert report["target"]["smallest_angle"]["cell"] == angles.min(axis=1).argmin()
    edges = [numpy.stack([p[pair.triangles[:, k]] - p[pair.triangles[:, 0]] for k in (1, 2)], axis=2)
             for p in pair[:2]]
    maps = edges[1] @ numpy.linalg.inv(edges[0])
    values = numpy.linalg.svd(maps, compute_uv=False)
    assert report["largest_stretch"]["value"] == pytest.approx(values[:, 0].max())
    assert report["largest_distortion"]["value"] == pytest.approx((values[:, 0] / values[:, 1]).max())
    assert report["linear"]["smallest_determinant"]["value"] == pytest.approx(numpy.linalg.det(maps).min())
    assert report["smooth"]["not_positive"] == 0 and report["smooth"]["creases"] == 0
    assert report["linear"]["creases"] > 0.9 * report["interior_edges"]
    points = inside_points(pair, 3000)
    smooth, linear = (xy(map_points(dhm, ["pair.json"], points, "-s", s)) for s in ("smooth", "linear"))
    found = numpy.linalg.norm(smooth - linear, axis=1).max()
    assert report["smooth"]["deviation_from_linear"]["value"] == pytest.approx(found, rel=0.3)


def test_defects_of_every_kind_are_named_by_all_refusals(dhm):
    pair = make_pair(3, 3, move=0)
    target = pair.target.copy()
    target[5] = [0.95, 0.5]
    target[10] = [0.01, 0.02]
    bad = pair._replace(target=target)
    report = check(dhm, bad, "--quick", status=REFUSED)
    wrong = numpy.flatnonzero(doubled_areas(target, bad.triangles) <= 0)
    assert set(wrong) <= set(report["invalid_triangles"])
    kinds = {problem["kind"] for problem in report["problems"]}
    assert "Flipped" in kinds and all(problem["message"] for problem in report["problems"])
    write_csv(dhm.path("p.csv"), [[0.5, 0.1]])
    for command in (["map", "bad.json", "p.csv", "-o", "new.csv"], ["figure", "bad.json", "-o", "new.png"],
                    ["refine", "bad.json", "--max-error", "1", "-o", "new.json"],
                    ["convert", "bad.json", "-o", "new.json"]):
        write_json(dhm.path("bad.json"), bad)
        result = dhm.refuse(REFUSED, *command, says=("bad.json", "flipped", "--mask-invalid"))
        for problem in report["problems"]:
            assert problem["message"] in result.err
    dhm("convert", "bad.json", "--mask-invalid", "-o", "good.json")
    good, _ = read_json(dhm.path("good.json"))
    assert len(good.triangles) == len(bad.triangles) - len(report["invalid_triangles"])
    assert check(dhm, good, "--quick")["valid"]


def test_meshes_that_do_not_match(dhm):
    pair = make_pair(3, 3)
    write_mesh(dhm.path("a.off"), pair.source, pair.triangles)
    write_mesh(dhm.path("fewer.off"), pair.source[:15], pair.triangles[:2])
    other = pair.triangles.copy()
    other[4] = other[5]
    write_mesh(dhm.path("other.off"), pair.target, other)
    for name, kinds in (("fewer.off", {"PointCountsDiffer", "CellCountsDiffer"}),
                        ("other.off", {"ConnectivityDiffers"})):
        report = json.loads(dhm("check", "--json", "a.off", name, status=REFUSED).out)
        assert kinds & {problem["kind"] for problem in report["problems"]}
        for command in (["refine", "--max-error", "0.1", "a.off", name, "-o", "new.json"],
                        ["convert", "a.off", name, "-o", "new.json"], ["figure", "a.off", name, "-o", "new.png"],
                        ["morph", "a.off", name, "-o", "new%d.vtp"]):
            dhm.refuse(REFUSED, *command, says=name)


def test_remedies_are_those_of_dhm(dhm):
    """Quadrilaterals are cut in both meshes alike; options have the names that can be typed."""
    points, _ = make_grid(1, 1)
    for name in ("a.obj", "b.obj"):
        dhm.path(name).write_text("".join(f"v {x} {y} 0\n" for x, y in points) + "f 1 2 4 3\n")
    write_csv(dhm.path("p.csv"), [[0.5, 0.1]])
    for command in (["check", "--quick", "a.obj", "b.obj"], ["map", "a.obj", "b.obj", "p.csv", "-o", "new.csv"]):
        result = dhm(*command, status=REFUSED)
        said = result.out.decode() + result.err
        assert "cell 0" in said and "dhm convert -o both.vtp" in said and "same diagonals" in said
        assert "vtkTriangleFilter" not in said
    dhm("convert", "a.obj", "b.obj", "-o", "both.vtp")
    obtuse = numpy.array([[0, 0], [1, 0], [0, 1], [0.6, 0.45]])
    write_json(dhm.path("pair.json"), Pair(obtuse, obtuse, numpy.array([[0, 1, 2], [1, 3, 2]])))
    said = dhm("map", "-s", "contour", "pair.json", "p.csv", "-o", "new.csv", status=REFUSED).err
    assert "--linear-where-discordant" in said and "DiscordantTriangles" not in said


def test_maps_that_are_not_certified_are_named(dhm):
    pair = make_pair(8, 8, move=0.0, width=8.0, height=8.0)
    # Two neighbors are a rounding unit apart in the source.
    pair.source[41, 0] = numpy.nextafter(pair.source[40, 0], 9)
    write_json(dhm.path("mixed.json"), pair)
    number = json.loads(dhm("check", "--json", "mixed.json").out)["cubic"]["uncertified_triangles"]
    assert number > 1
    words = f"mixed.json: a valid pair, but its Cubic map is not certified in {number} triangles\n"
    assert dhm("check", "mixed.json").out.decode().startswith(words)
    # Once, however many filters and tiles there are.
    Image = pytest.importorskip("PIL.Image")
    Image.fromarray(numpy.zeros((9, 9), "u1")).save(dhm.path("i.png"))
    for _ in range(2):
        said = dhm("warp", "mixed.json", "i.png", "--system", "cubic", "-o", "w.png", "--force").err
        assert said.count("not certified") == 1


def test_reports_and_plots(dhm):
    write_json(dhm.path("pair.json"), make_pair())
    out = dhm("check", "pair.json").out.decode()
    assert "pair.json: a valid pair" in out and "boundary loops" in out and "creases" in out
    dhm("check", "--quick", "pair.json", "--plot", "pair.png")
    # A triangle without area is seen in the plot of an invalid pair, by a marker.
    source, triangles = make_grid(1, 1)
    source = numpy.vstack((source, [[1, 0.4]]))
    triangles = numpy.vstack((triangles, [[1, 4, 3]]))
    write_json(dhm.path("bad.json"), Pair(source, source, triangles))
    result = dhm("check", "--quick", "bad.json", "--plot", "bad.png", status=REFUSED)
    assert b"NOT a valid pair" in result.out and "not a valid pair" in result.err
    pixels = numpy.asarray(Image.open(dhm.path("bad.png")).convert("RGB")).astype(int)
    red = (pixels[:, :, 0] > 180) & (pixels[:, :, 1] < 90) & (pixels[:, :, 2] < 90)
    assert red.sum() > 150
    dhm.refuse(USAGE, "check", "pair.json", "--plot", "pair.gif", says=("pair.gif", ".png"))


def test_triangles_that_share_no_points(dhm):
    pair = make_pair(4, 4)
    separate = numpy.arange(pair.triangles.size).reshape(-1, 3)
    for side in (0, 1):
        write_mesh(dhm.path(f"{side}.off"), pair[side][pair.triangles].reshape(-1, 2), separate)
    result = dhm("check", "--quick", "--json", "0.off", "1.off")
    assert json.loads(result.out)["components"] == 32
    assert f"{96 - 25} points" in result.err and "0 edges join" in result.err


# --- Morphs and figures


@pytest.fixture
def faces(dhm):
    pair = make_pair(4, 3, width=23, height=17)
    pixels = numpy.random.default_rng(6).integers(0, 256, (2, 18, 24, 3)).astype("u1")
    for side in (0, 1):
        Image.fromarray(pixels[side]).save(dhm.path(f"{side}.ppm"))
    write_json(dhm.path("pair.json"), pair)
    return pair, pixels


def test_frames_begin_and_end_with_the_images(dhm, faces):
    pair, pixels = faces
    dhm("morph", "pair.json", "--source-image", "0.ppm", "--target-image", "1.ppm", "-s", "smooth", "-n", "3",
        "-o", "f-%03d.ppm")
    frames = [numpy.asarray(Image.open(dhm.path(f"f-00{k}.ppm"))) for k in range(3)]
    numpy.testing.assert_array_equal(frames[0], pixels[0])
    numpy.testing.assert_array_equal(frames[2], pixels[1])
    halves = []
    for side in (0, 1):
        write_json(dhm.path("half.json"), Pair(pair[side], (pair.source + pair.target) / 2, pair.triangles))
        dhm("warp", "half.json", f"{side}.ppm", "-s", "smooth", "-f", "-o", "half.ppm")
        halves.append(numpy.asarray(Image.open(dhm.path("half.ppm"))).astype(float))
    assert numpy.abs(frames[1] - (halves[0] + halves[1]) / 2).max() <= 1.001


def test_opaque_and_transparent_images_are_mixed(dhm, faces):
    pair, pixels = faces
    Image.fromarray(numpy.dstack((pixels[1], pixels[0, :, :, 0]))).save(dhm.path("1.png"))
    dhm("morph", "pair.json", "--source-image", "0.ppm", "--target-image", "1.png", "-n", "2", "-o", "f%d.png")
    frames = [numpy.asarray(Image.open(dhm.path(f"f{k}.png"))) for k in range(2)]
    numpy.testing.assert_array_equal(frames[0][:, :, :3], pixels[0])
    numpy.testing.assert_array_equal(frames[1], numpy.asarray(Image.open(dhm.path("1.png"))))
    assert (frames[0][:, :, 3] == 255).all()


def test_meshes_move_and_folds_are_avoided_or_refused(dhm, faces):
    pair, _ = faces
    dhm("morph", "pair.json", "-n", "3", "-o", "m%d.obj", "-q")
    for k in range(3):
        points = meshio.read(dhm.path(f"m{k}.obj")).points[:, :2]
        numpy.testing.assert_allclose(points, pair.source + k / 2 * (pair.target - pair.source), rtol=0, atol=1e-12)
    # Turned by a half: on straight paths all points meet half-way.
    write_json(dhm.path("turned.json"), pair._replace(target=[23, 17] - pair.source))
    dhm.refuse(REFUSED, "morph", "turned.json", "--path", "straight", "-n", "3", "-o", "new%d.vtp", says="frame 1")
    dhm("morph", "turned.json", "-n", "3", "-o", "t%d.obj", "-q")
    middle = meshio.read(dhm.path("t1.obj")).points[:, :2]
    assert (doubled_areas(middle, pair.triangles) > 0).all()
    write_json(dhm.path("mirrored.json"), pair._replace(target=pair.source * [-1, 1]))
    dhm.refuse(REFUSED, "morph", "mirrored.json", "-o", "new%d.vtp", says="mirror image")


def test_morph_refusals(dhm, faces):
    images = ("--source-image", "0.ppm", "--target-image", "1.ppm")
    for options, output, says in (
            (images, "new.png", "%03d"), (images, "new%d.gif", ".png"), ((), "new%d.png", "--source-image"),
            ((), "new%d-%d.vtp", "one place"), ((*images, "--frames", "1"), "new%d.png", "--frames")):
        dhm.refuse(USAGE, "morph", "pair.json", *options, "-o", output, says=says)
    Image.fromarray(numpy.zeros((18, 24), "u1")).save(dhm.path("gray.pgm"))
    dhm.refuse(REFUSED, "morph", "pair.json", "--source-image", "0.ppm", "--target-image", "gray.pgm",
               "-o", "new%d.png", says="same kind")
    dhm.path("new1.png").write_text("mine")
    dhm.refuse(3, "morph", "pair.json", *images, "-n", "2", "-o", "new%d.png", says=("new1.png", "--force"))


def test_figures(dhm, faces):
    for name, options in (("a.png", ["--all-systems"]), ("b.png", ["--close-up", "10", "8", "2", "--image", "0.ppm"]),
                          ("c.svg", []), ("d.pdf", [])):
        dhm("figure", "pair.json", "--grid", "4", *options, "-o", name)
    width, height = Image.open(dhm.path("a.png")).size
    assert 1500 < width <= 5 * 430 and height < width / 3
    pixels = numpy.asarray(Image.open(dhm.path("b.png")).convert("RGB"))
    assert len(numpy.unique(pixels.reshape(-1, 3), axis=0)) > 200
    assert xml.etree.ElementTree.parse(dhm.path("c.svg")).getroot().tag.endswith("svg")
    assert dhm.path("d.pdf").read_bytes().startswith(b"%PDF-")
    for values in ("a b c", "0 0 -1", "nan 0 1"):
        dhm.refuse(USAGE, "figure", "pair.json", "--close-up", *values.split(), "-o", "new.png", says="--close-up")
    dhm.refuse(REFUSED, "figure", "pair.json", "--close-up", "99", "8", "2", "-o", "new.png", says="outside the target")
    for option in ("--grid=0", "--grid=1.5"):
        dhm.refuse(USAGE, "figure", "pair.json", option, "-o", "new.png", says="--grid")
    dhm.refuse(USAGE, "figure", "pair.json", "-o", "new.jpg", says=".png")


# --- Refinement


def test_refinement_keeps_its_tolerance_also_in_proj(dhm):
    pair = make_pair(3, 3)
    offsets = numpy.random.default_rng(3).random(16)
    write_json(dhm.path("pair.json"), pair, name="A shift", description="As published", input_crs="EPSG:2393",
               transformed_components=["horizontal", "vertical"],
               vertices_columns=["source_x", "source_y", "target_x", "target_y", "offset_z"],
               vertices=numpy.hstack((pair.source, pair.target, offsets[:, None])).tolist())
    points = numpy.random.default_rng(7).random((20000, 2)) * 0.999 + 0.0005
    smooth = xy(map_points(dhm, ["pair.json"], points, "-s", "smooth"))
    result = dhm("refine", "pair.json", "--max-error", "0.004", "-o", "fine.json")
    fine, document = read_json(dhm.path("fine.json"))
    assert f"18 triangles became {len(fine.triangles)}" in result.err
    assert document["name"] == "A shift" and document["description"].startswith("As published. Refined by dhm")
    numpy.testing.assert_array_equal(fine.source[:16], pair.source)
    assert max(edges_of(fine.triangles).values()) == 2
    for side in fine[:2]:
        assert doubled_areas(side, fine.triangles).min() > 0
    table = map_points(dhm, ["fine.json"], numpy.column_stack((points, 0 * points[:, 0])))
    distances = numpy.linalg.norm(xy(table) - smooth, axis=1)
    assert 0.3 * 0.004 < distances.max() <= 0.004
    heights = map_points(dhm, ["pair.json"], numpy.column_stack((points, 0 * points[:, 0])))["z"]
    numpy.testing.assert_allclose(table["z"], heights, rtol=0, atol=1e-12)
    if shutil.which("cct"):
        lines = "".join(f"{x!r} {y!r} 0 0\n" for x, y in points.tolist())
        ran = subprocess.run(["cct", "-d", "12", "+proj=tinshift", "+file=./fine.json"], input=lines.encode(),
                             stdout=subprocess.PIPE, cwd=dhm.folder, check=True)
        proj = numpy.array([line.split()[:3] for line in ran.stdout.decode().splitlines()], float)
        numpy.testing.assert_allclose(proj[:, :2], xy(table), rtol=0, atol=1e-10)
        numpy.testing.assert_allclose(proj[:, 2], heights, rtol=0, atol=1e-10)
        assert numpy.linalg.norm(proj[:, :2] - smooth, axis=1).max() <= 0.004


def test_refine_refusals(dhm):
    write_json(dhm.path("pair.json"), make_pair(3, 3))
    dhm.refuse(REFUSED, "refine", "pair.json", "--max-error", "1e-6", "--max-triangles", "500", "-o", "new.json",
               says=("500", "--max-triangles"))
    dhm.refuse(REFUSED, "refine", "pair.json", "--max-error", "1e9", "--max-triangles", "5", "-o", "new.json",
               says=("has 18 triangles", "5 (--max-triangles)"))
    for value in ("0", "-1", "nan", "inf", "x"):
        dhm.refuse(USAGE, "refine", "pair.json", "--max-error=" + value, "-o", "new.json", says=("--max-error", value))
    dhm.refuse(USAGE, "refine", "pair.json", "--max-error", "1", "-o", "new.obj", says=(".obj", ".json"))
    points, triangles = make_grid(2, 2)
    write_mesh(dhm.path("bent.off"), numpy.column_stack((points, points[:, 0] ** 2)), triangles)
    for command in (["refine", "--max-error", "1"], ["convert"], ["figure"]):
        name = "new.png" if command == ["figure"] else "new.json"
        dhm.refuse(REFUSED, *command, "bent.off", "bent.off", "-o", name, says="bent.off")
