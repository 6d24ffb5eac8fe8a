# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm with real data: Finland's published shift compared with PROJ's tinshift, photographs, and inputs that revealed
defects. The tests are skipped without the files (in the folder DHM_SHARED_DATA, by default ../shared/data)."""

import json
import pathlib
import shutil
import subprocess

import numpy
import pytest
from conftest import DONE, FILE, USAGE
from pairs import SHARED_DATA, Pair, inside_points, map_points, read_csv, read_json, write_csv, xy

FINLAND = SHARED_DATA / "fi_nls_ykj_etrs35fin.json"
CASES = SHARED_DATA / "cases"
XMORPH = pathlib.Path("/usr/share/xmorph/example")
finland = pytest.mark.skipif(not FINLAND.is_file(), reason=f"{FINLAND} is not there")
cases = pytest.mark.skipif(not CASES.is_dir(), reason=f"{CASES} is not there")


def cct(file, points, folder="."):
    columns = numpy.column_stack((points, numpy.zeros((len(points), 4 - points.shape[1]))))
    lines = "".join(" ".join(map(repr, row)) + "\n" for row in columns.tolist())
    ran = subprocess.run(["cct", "-d", "9", "+proj=tinshift", f"+file={file}"], input=lines.encode(), cwd=folder,
                         stdout=subprocess.PIPE, check=True)
    return numpy.array([line.split()[:3] for line in ran.stdout.decode().splitlines()], float)


def read_finland():
    document = json.loads(FINLAND.read_text())
    names = ["source_x", "source_y", "target_x", "target_y"]
    columns = [document["vertices_columns"].index(name) for name in names]
    vertices = numpy.array([[vertex[k] for k in columns] for vertex in document["vertices"]])
    corners = [document["triangles_columns"].index(f"idx_vertex{k}") for k in (1, 2, 3)]
    triangles = numpy.array([[triangle[k] for k in corners] for triangle in document["triangles"]])
    return Pair(vertices[:, :2], vertices[:, 2:], triangles)


@finland
@pytest.mark.skipif(not shutil.which("cct"), reason="PROJ's cct (proj-bin) is not there")
def test_finland_is_mapped_as_by_proj(dhm):
    points = inside_points(read_finland(), 100000)
    linear = xy(map_points(dhm, [FINLAND], points))
    assert numpy.abs(cct(FINLAND, points)[:, :2] - linear).max() < 1e-6
    result = dhm("refine", FINLAND, "--max-error", "0.01", "-o", "fine.json")
    assert "1450 triangles became" in result.err
    smooth = xy(map_points(dhm, [FINLAND], points, "-s", "smooth"))
    assert numpy.linalg.norm(cct("./fine.json", points, dhm.folder)[:, :2] - smooth, axis=1).max() <= 0.01
    fine, _ = read_json(dhm.path("fine.json"))
    numpy.testing.assert_array_equal(fine.source[:767], read_finland().source)


@finland
def test_finland_is_checked(dhm):
    report = json.loads(dhm("check", "--json", FINLAND).out)
    assert report["valid"] and report["opposite_windings"] == 148
    assert (report["source"]["points"], report["source"]["triangles"]) == (767, 1450)
    assert report["smooth"]["creases"] == report["smooth"]["not_positive"] == 0


@cases
@pytest.mark.skipif(not shutil.which("cct"), reason="PROJ's cct (proj-bin) is not there")
def test_heights_and_fallback_as_by_proj(dhm):
    points = numpy.array([[5, 2, 50], [2, 7, 60.0]])
    for name in ("hv.json", "hvz.json"):
        table = read_csv(dhm("map", CASES / name, CASES / "hv.csv", "-o", "-").out)
        found = numpy.column_stack([table[c] for c in "ENH"])
        numpy.testing.assert_allclose(found, cct(CASES / name, points), rtol=0, atol=1e-8)
        for command in (["convert"], ["refine", "--max-error", "1"]):
            dhm(*command, CASES / name, "-f", "-o", "kept.json")
            kept = read_csv(dhm("map", "kept.json", CASES / "hv.csv", "-o", "-").out)
            numpy.testing.assert_allclose(kept["H"], table["H"], rtol=0, atol=1e-12)
    table = read_csv(dhm("map", CASES / "fallback.json", CASES / "fb.csv", "-o", "-").out)
    given = numpy.array([[0.2, 0.2], [-0.5, 0.5], [2, 2], [1.5, 0.5]])
    numpy.testing.assert_allclose(xy(table), cct(CASES / "fallback.json", given)[:, :2], rtol=0, atol=1e-8)
    assert table["Fallback"].tolist() == [0, 1, 0, 0]


@cases
@pytest.mark.parametrize("name, rows", [("inch_marks.csv", 3), ("cr_only.csv", 2), ("tab_in_quotes.csv", 2)])
def test_tables_that_lost_rows(dhm, name, rows):
    dhm("map", CASES / "square.json", CASES / name, "-o", name)
    again = dhm("map", CASES / "square.json", name, "-o", "-").out
    assert len(again.splitlines()) == rows + 1


@cases
@pytest.mark.parametrize("arguments, status, says", [
    (["map", "square.json", "column_names.csv", "-o", "new.vtp"], USAGE, ["column_names.csv", ".csv"]),
    (["map", "square.json", "polygon_of_2_points.vtp", "-o", "new.vtp"], FILE, ["polygon_of_2_points.vtp", "2 points"]),
    (["convert", "badid.vtu", "badid.vtu", "-o", "new.json"], FILE, ["badid.vtu", "cell 0", "1000000000000"]),
    (["map", "square.json", "short_string_array.vtp", "-o", "new.vtp"], FILE, ["short_string_array.vtp"]),
    (["map", "square.json", "damaged_crash.vts", "-o", "new.vts"], FILE, ["damaged_crash.vts"]),
    (["map", "square.json", "hang.vtk", "-o", "new.vtk"], FILE, ["hang.vtk", "seconds"]),
    (["convert", "uv/tube_seam.obj", "-o", "new.vtp"], USAGE, ["tube_seam.obj", "--target-array"]),
    (["convert", "bom.obj", "bom.obj", "-o", "new.vtp"], DONE, []),
    (["convert", "uv/sheet_vt.obj", "uv/sheet_vt.obj", "-o", "new.vtp"], DONE, []),
])
def test_inputs_that_crashed_or_were_misread(dhm, arguments, status, says):
    arguments = [CASES / word if (CASES / word).is_file() else word for word in arguments]
    if status == DONE:
        dhm(*arguments)
    else:
        dhm.refuse(status, *arguments, says=says)


@cases
def test_deviations_are_named(dhm):
    """A mark that is wrong by 18 cm, in a needle: the report names what Smooth makes of it."""
    report = json.loads(dhm("check", "--json", CASES / "needle_shift.json").out)
    largest = report["smooth"]["deviation_from_linear"]["value"]
    assert largest > 0.05
    vertices = numpy.array(json.loads((CASES / "needle_shift.json").read_text())["vertices"])
    triangles = numpy.array(json.loads((CASES / "needle_shift.json").read_text())["triangles"])
    write_csv(dhm.path("p.csv"), inside_points(Pair(vertices[:, :2], vertices[:, 2:4], triangles), 2000))
    result = dhm("map", CASES / "needle_shift.json", "p.csv", "-s", "smooth", "-o", "-")
    assert "farthest from Linear" in result.err


@pytest.mark.skipif(not XMORPH.is_dir(), reason=f"{XMORPH} (Debian's gtkmorph-example) is not there")
@pytest.mark.parametrize("name, options", [("AD", ()), ("AD2", ("--working-size", "300x400")),
                                           ("AD_freeborder", ("--working-size", "300x400"))])
def test_photographs(dhm, name, options):
    Image = pytest.importorskip("PIL.Image")
    meshes = [XMORPH / name / f"image{k}.png.mesh" for k in (1, 2)]
    images = [XMORPH / name / f"image{k}.png" for k in (1, 2)]
    report = json.loads(dhm("check", "--json", "--quick", *options, *meshes).out)
    columns, rows = map(int, meshes[0].read_text().split()[1:3])
    assert report["valid"] and report["source"]["points"] == columns * rows
    dhm("warp", *options, *meshes, images[0], "-o", "warped.png")
    assert Image.open(dhm.path("warped.png")).size == Image.open(images[0]).size
    dhm("morph", *options, *meshes, "--source-image", images[0], "--target-image", images[1], "-n", "3",
        "--size", "60x80", "-o", "m-%02d.png")
    assert [Image.open(path).size for path in sorted(dhm.folder.glob("m-*.png"))] == 3 * [(60, 80)]
