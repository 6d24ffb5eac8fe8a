# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Properties of all commands with respect to files: complete outputs or none, no overwriting, pipes, interrupts,
damaged files; and meshes in many formats, with meshio as an independent writer."""

import json
import os
import signal
import subprocess
import time

import numpy
import pytest
from conftest import FILE, REFUSED, USAGE
from pairs import Pair, inside_points, make_pair, read_json, write_csv, write_json, write_mesh, \
    write_obj, write_vtk

meshio = pytest.importorskip("meshio")
Image = pytest.importorskip("PIL.Image")


@pytest.fixture
def pair(dhm):
    result = make_pair(6, 6, width=39, height=29)
    write_json(dhm.path("pair.json"), result)
    write_csv(dhm.path("points.csv"), inside_points(result, 300))
    write_vtk(dhm.path("data.vtk"), inside_points(result, 300), [[0, 1, 2]])
    pixels = numpy.random.default_rng(11).integers(0, 256, (30, 40, 3)).astype("u1")
    Image.fromarray(pixels).save(dhm.path("image.png"))
    return result


COMMANDS = [
    ["map", "pair.json", "points.csv", "-o", "out.csv"],
    *[["map", "pair.json", "data.vtk", "-o", f"out.{e}"] for e in ("vtp", "vtk", "obj")],
    *[["warp", "pair.json", "image.png", "-o", f"out.{e}"] for e in ("png", "jpg", "tif", "ppm")],
    *[["figure", "pair.json", "--grid", "3", "-o", f"out.{e}"] for e in ("png", "svg", "pdf")],
    ["refine", "pair.json", "--max-error", "0.5", "-o", "out.json"],
    *[["convert", "pair.json", "-o", f"out.{e}"] for e in ("json", "vtp", "vtk")],
    ["convert", "pair.json", "--target-output", "target.off", "-o", "out.off"],
]


@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: f"{c[0]}-{c[-1]}")
def test_outputs_are_whole_or_absent_and_never_overwritten(dhm, pair, command):
    dhm(*command)
    output = dhm.path(command[-1])
    data = output.read_bytes()
    dhm.refuse(FILE, *command, says=(output.name, "exists", "--force"))
    output.write_text("mine")
    if dhm.path("target.off").exists():
        dhm.path("target.off").unlink()
    for limit in (len(data) // 2, len(data) - 1):
        dhm.refuse(FILE, *command, "--force", limit=limit)
        assert output.read_text() == "mine" and not dhm.path("target.off").exists()
    dhm(*command, "--force")
    assert output.stat().st_size == len(data)
    usual = dhm.path("usual")
    usual.touch()
    assert output.stat().st_mode == usual.stat().st_mode


def test_full_devices_and_readers_that_have_gone(dhm, pair):
    with open("/dev/full", "wb") as full:
        for command in (["map", "pair.json", "points.csv", "-o", "-"], ["convert", "pair.json", "-o", "-"],
                        ["warp", "pair.json", "image.png", "-o", "-"], ["check", "--quick", "pair.json"],
                        ["check", "--quick", "--json", "pair.json"], ["--help"], ["map", "--help"], ["--version"]):
            dhm.refuse(FILE, *command, stdout=full, says="standard output")
    dhm.refuse(FILE, "map", "pair.json", "points.csv", "-o", "/dev/full", says=("/dev/full", "No space left"))
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "wb") as gone:
        dhm.refuse(FILE, "map", "pair.json", "points.csv", "-o", "-", stdout=gone, says="standard output")


def test_folders_pipes_and_replacing_the_input(dhm, pair):
    command = ["map", "pair.json", "points.csv", "-o"]
    dhm.path("folder.csv").mkdir()
    dhm.refuse(FILE, *command, "folder.csv", says=("folder.csv", "is a folder"))
    dhm.refuse(FILE, *command, "nowhere/out.csv", says=("nowhere/out.csv", "No such file"))
    dhm.refuse(FILE, *command, "points.csv/out.csv", says="points.csv/out.csv")
    dhm(*command, "folder.csv/out.csv")
    expected = dhm.path("folder.csv/out.csv").read_bytes()
    os.mkfifo(dhm.path("pipe.csv"))
    reader = subprocess.Popen(["cat", "pipe.csv"], cwd=dhm.folder, stdout=subprocess.PIPE)
    dhm(*command, "pipe.csv")
    assert reader.communicate(timeout=60)[0] == expected
    assert dhm(*command, "/dev/stdout").out == expected
    dhm("convert", "pair.json", "-o", "pair.json", "--force")
    numpy.testing.assert_array_equal(read_json(dhm.path("pair.json"))[0].target, pair.target)


def test_standard_input(dhm, pair):
    text, points = dhm.path("pair.json").read_bytes(), dhm.path("points.csv").read_bytes()
    expected = dhm("map", "pair.json", "points.csv", "-o", "-").out
    assert dhm("map", "-", "points.csv", "-o", "-", input=text).out == expected
    assert dhm("map", "pair.json", "-", "-o", "-", input=points).out == expected
    dhm("convert", "-", "-o", "source.off", "--target-output", "target.off", input=text)
    off = dhm.path("target.off").read_bytes()
    out = dhm("map", "source.off", "-", "points.csv", "-s", "linear", "--input-format", "off", "-o", "-", input=off).out
    assert out == expected
    assert b"<VTKFile" in dhm("convert", "-", "-o", "-", "--output-format", "vtp", input=text).out
    dhm.refuse(FILE, "check", "-", input=off, says=("standard input", "--input-format"))
    dhm.refuse(FILE, "map", "pair.json", "-", "-o", "n.csv", input=off, says=("standard input", "--input-format"))
    dhm.refuse(FILE, "warp", "pair.json", "-", "-o", "n.png", input=off, says=("standard input", "--input-format"))
    dhm.refuse(FILE, "check", "-", input=text[:500], says=("standard input", "line"))
    dhm.refuse(FILE, "check", "-", says="standard input")
    dhm.refuse(USAGE, "map", "-", "-", "-o", "new.csv", says="standard input")


def wait_for(what):
    end = time.monotonic() + 60
    while not what():
        assert time.monotonic() < end
        time.sleep(0.01)


def interrupt(dhm, process, number):
    """One signal ends it, and another process removes what it leaves."""
    process.send_signal(number)
    assert process.wait(60) == -number
    wait_for(lambda: not [*dhm.temporary.iterdir(), *dhm.folder.glob(".dhm-unfinished-*")])


def test_interrupts_leave_nothing(dhm, pair):
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL):
        # While reading.
        process = dhm.start("check", "-", stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        process.stdin.write(b"{")
        process.stdin.flush()
        # Python's tempfile tries out the folder with a file of its own.
        wait_for(lambda: list(dhm.temporary.glob(".dhm-unfinished-*")))
        interrupt(dhm, process, number)
        process.stdin.close()
        # While writing, to a pipe that nobody reads.
        os.mkfifo(dhm.path("pipe.csv"))
        process = dhm.start("map", "pair.json", "points.csv", "-o", "pipe.csv", stderr=subprocess.DEVNULL)
        wait_for(lambda: any(p.is_dir() for p in dhm.temporary.iterdir()))
        interrupt(dhm, process, number)
        dhm.path("pipe.csv").unlink()


def test_interrupts_end_long_computations_at_once(dhm, pair):
    process = dhm.start("refine", "pair.json", "--max-error", "1e-7", "-o", "fine.json", stderr=subprocess.DEVNULL)
    time.sleep(4)
    assert process.poll() is None
    begin = time.monotonic()
    interrupt(dhm, process, signal.SIGINT)
    assert time.monotonic() - begin < 30
    assert not dhm.path("fine.json").exists()


def test_missing_files_and_folders(dhm, pair):
    dhm.path("folder.off").mkdir()
    for command in (["check", "{}"], ["map", "pair.json", "{}", "-o", "new.csv"],
                    ["warp", "pair.json", "{}", "-o", "n.png"],
                    ["morph", "pair.json", "--source-image", "{}", "-o", "new%d.png"],
                    ["figure", "pair.json", "--image", "{}", "-o", "new.png"],
                    ["coordinates", "{}", "points.csv", "-o", "new.csv"],
                    ["refine", "{}", "--max-error", "1", "-o", "new.json"], ["convert", "{}", "{}", "-o", "new.json"]):
        for name, says in (("none.off", "No such file"), ("folder.off", "is a folder")):
            result = dhm.refuse({FILE, USAGE}, *(word.format(name) for word in command))
            assert name in result.err


def damage(data, text=True):
    """The file cut off, and otherwise garbled."""
    for share in (0.0, 0.3, 0.6, 0.95):
        yield data[: int(share * len(data))]
    yield numpy.random.default_rng(8).bytes(700)
    if text:
        middle = len(data) // 2
        yield data[:middle] + b" \xff\x1b[31m?? " + data[middle + 8 :]


@pytest.mark.parametrize("name", ["a.off", "a.obj", "ascii.ply", "binary.ply", "a.vtu", "a.vtk", "ascii.stl", "a.vtp"])
def test_meshes_made_by_others_and_damaged_ones(dhm, name):
    pair = make_pair(4, 3)
    large = numpy.array([[1e6 / 3, 7e6 / 9]])
    pair = Pair(pair.source * large, pair.target * large, pair.triangles)
    extension = name.split(".")[1]
    names = [f"{side}.{extension}" for side in ("source", "target")]
    for file, points in zip(names, pair[:2]):
        if extension == "obj":
            write_obj(dhm.path(file), points, pair.triangles)
        elif name in ("ascii.ply", "ascii.stl"):
            meshio.Mesh(numpy.column_stack((points, 0 * points[:, 0])), [("triangle", pair.triangles)]).write(
                dhm.path(file), binary=False)
        elif extension in ("vtk", "vtp"):
            write_vtk(dhm.path("tmp.vtk"), points, pair.triangles)
            dhm("convert", "tmp.vtk", "tmp.vtk", "-f", "-o", file, "--target-output", f"unused.{extension}")
        else:
            write_mesh(dhm.path(file), points, pair.triangles)
    dhm("convert", *names, "-o", "again.json")
    again, _ = read_json(dhm.path("again.json"))
    if extension == "stl":
        # Single precision, and points are joined that coincide in both.
        assert len(again.source) == len(pair.source)
        numpy.testing.assert_allclose(again.target[again.triangles], pair.target[pair.triangles], rtol=1e-6)
    else:
        for mine, theirs in zip(again, pair):
            numpy.testing.assert_array_equal(mine, theirs)
    for bad in damage(dhm.path(names[0]).read_bytes(), extension in ("obj", "off")):
        dhm.path(f"bad.{extension}").write_bytes(bad)
        if extension in ("obj", "stl") and len(bad) > 100:
            # Whole lines of it can be one, too: but not the target's.
            dhm.refuse({FILE, REFUSED}, "convert", f"bad.{extension}", names[1], "-o", "new.json")
        else:
            dhm.refuse(FILE, "convert", f"bad.{extension}", names[1], "-o", "new.json", says=f"bad.{extension}")


def test_target_in_the_same_file(dhm):
    pair = make_pair(4, 3)
    write_vtk(dhm.path("both.vtk"), pair.source, pair.triangles, target=pair.target)
    dhm.refuse(USAGE, "convert", "both.vtk", "-o", "new.json", says=('"Target"', "--target-array"))
    dhm("convert", "both.vtk", "--target-array", "Moved", "-o", "again.json")
    numpy.testing.assert_array_equal(read_json(dhm.path("again.json"))[0].target, pair.target)


def test_byte_order_marks(dhm):
    pair = make_pair(2, 2)
    write_obj(dhm.path("a.obj"), pair.source, pair.triangles)
    text = dhm.path("a.obj").read_text().split("\n", 1)[1]
    dhm.path("bom.obj").write_text("\ufeff" + text, encoding="utf-8")
    dhm("convert", "bom.obj", "bom.obj", "-o", "bom.json")
    numpy.testing.assert_array_equal(read_json(dhm.path("bom.json"))[0].source, pair.source)
    write_json(dhm.path("b.json"), pair)
    dhm.path("b.json").write_text("\ufeff" + dhm.path("b.json").read_text(), encoding="utf-8")
    dhm("convert", "b.json", "-o", "again.json")


def test_wrong_triangulation_files(dhm, pair):
    good = json.loads(dhm.path("pair.json").read_text())

    def refuse(says, **changes):
        document = {key: value for key, value in {**good, **changes}.items() if value is not None}
        dhm.path("bad.json").write_text(json.dumps(document))
        result = dhm.refuse(FILE, "convert", "bad.json", "-o", "new.json", says=["bad.json", *says])
        assert len(result.err) < 400

    refuse(["file_type"], file_type="GeoJSON")
    refuse(["format_version"], format_version="2.0")
    refuse(["transformed_components"], transformed_components=["sideways"])
    refuse(["fallback_strategy"], fallback_strategy="far")
    refuse(["vertices"], vertices={"a": 1})
    refuse(["target_y"], vertices_columns=["source_x", "source_y", "target_x", "z"])
    refuse(["vertices[3]"], vertices=good["vertices"][:3] + [[1, 2, 3]] + good["vertices"][4:])
    refuse(["vertices[0]", "source_x"], vertices=[["1" * 5000, 2, 3, 4]] + good["vertices"][1:])
    refuse(["vertices[1]", "source_x"], vertices=good["vertices"][:1] + [[10**400, 2, 3, 4]] + good["vertices"][2:])
    for index in (-1, 49, 1.5, "1", None, 2**63, 1e300):
        refuse(["triangles[1]"], triangles=good["triangles"][:1] + [[0, 1, index]])
    for text in ("[]", "null", "{}", "", "[" * 100000, '{"a":' * 50000, "\x00" * 50):
        dhm.path("bad.json").write_text(text)
        dhm.refuse(FILE, "convert", "bad.json", "-o", "new.json", says="bad.json")
    for deep in ('"extra": ' + "[" * 30000 + "]" * 30000, '"vertices": [' + "[" * 200000 + "]" * 200000 + "]"):
        dhm.path("bad.json").write_text(dhm.path("pair.json").read_text().replace("{", "{" + deep + ",", 1))
        dhm.refuse(FILE, "convert", "bad.json", "-o", "new.json", says=("bad.json", "nested"))
    # Brackets in strings are no depth.
    write_json(dhm.path("text.json"), pair, description="[" * 500 + '\\"{')
    dhm("convert", "text.json", "-o", "again.json")


def test_damaged_cells(dhm, pair):
    """Point ids and offsets that VTK's readers pass on."""
    text = dhm.path("data.vtk").read_text()
    dhm.path("bad.vtk").write_text(text.replace("3 0 1 2", "3 0 1 999999999"))
    dhm.refuse(FILE, "map", "pair.json", "bad.vtk", "-o", "new.vtp", says=("bad.vtk", "cell 0", "999999999"))
    dhm.path("bad.vtk").write_text(text.replace("POLYGONS 1 4\n3 0 1 2", "POLYGONS 1 3\n2 0 1"))
    dhm.refuse(FILE, "map", "pair.json", "bad.vtk", "-o", "new.vtp", says=("bad.vtk", "2 points"))
    dhm.path("bad.vtk").write_text(text.replace("Version 3.0", "Version 5.1").replace(
        "POLYGONS 1 4\n3 0 1 2", "POLYGONS 2 3\nOFFSETS vtktypeint64\n0 1000000\nCONNECTIVITY vtktypeint64\n0 1 2"))
    dhm.refuse(FILE, "map", "pair.json", "bad.vtk", "-o", "new.vtp", says="bad.vtk")


def test_command_line(dhm, pair):
    out = dhm("--help").out.decode()
    for command in ("check", "map", "warp", "morph", "figure", "coordinates", "refine", "convert"):
        assert f"\n  {command} " in out
        text = dhm(command, "--help").out.decode()
        assert f"dhm {command}" in text and "--quiet" in text
        dhm.refuse(USAGE, command, says=f"dhm {command} --help")
        dhm.refuse(USAGE, command, "--no-such-option", "a.json", says=("--no-such-option", f"dhm {command} --help"))
    assert dhm("--version").out.decode().startswith("dhm ")
    dhm.refuse(USAGE, "chekc", "pair.json", says=("chekc", "--help"))
    dhm.refuse(USAGE, "check", "a.json", "b.json", "c.json", says="SOURCE [TARGET]")
    dhm.refuse(USAGE, "map", "pair.json", "points.csv", says="--output")
    dhm.refuse(USAGE, "map", "pair.json", "-o", "new.csv", says="SOURCE [TARGET] DATA")
    write_mesh(dhm.path("a.off"), pair.source, pair.triangles)
    dhm.refuse(USAGE, "map", "points.csv", "pair.json", "-o", "new.vtp", says="pair.json was used as DATA")
    dhm.refuse(USAGE, "check", "pair.json", "pair.json", says="no other mesh")
    arguments = ("map", "pair.json", "points.csv", "-o", "new.csv")
    dhm.refuse(USAGE, *arguments, "--system=bicubic", says=("--system", "smooth", "bicubic"))
    for tolerance in ("-1", "nan", "inf", "x"):
        dhm.refuse(USAGE, *arguments, "--tolerance=" + tolerance, says=("--tolerance", tolerance))
    # Options and files in any order.
    dhm("map", "--inverse", "pair.json", "-o", "mixed.csv", "points.csv", "-q")


def test_locale_does_not_matter(dhm, pair):
    dhm.environment["LC_ALL"] = "de_DE.UTF-8"
    write_csv(dhm.path("p.csv"), [[0.5, 0.25]])
    assert b"," in dhm("map", "pair.json", "p.csv", "-o", "-").out.split(b"\n")[1]
    assert dhm("map", "pair.json", "p.csv", "-o", "-").out.split(b"\n")[1].count(b".") == 2


def test_warnings_of_vtk_are_said_once(dhm):
    """Points beside a surface, in a process of its own."""
    pair = make_pair(4, 4)
    bent = numpy.column_stack((pair.source, pair.source[:, 0] ** 2))
    write_mesh(dhm.path("bent.off"), bent, pair.triangles)
    write_csv(dhm.path("beside.csv"), bent[pair.triangles[:1]].mean(axis=1) + [0, 0, 1e-4], "x,y,z")
    dhm.environment["LC_ALL"] = "C"
    said = dhm("map", "bent.off", "bent.off", "beside.csv", "-o", "out.csv").err.splitlines()
    assert all(line.startswith("dhm: ") for line in said) and sum("off the surface" in line for line in said) == 1
